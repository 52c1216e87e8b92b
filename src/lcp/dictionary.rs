//! The dictionary of a mirrored LCP: basic variables as affine functions of the nonbasic ones,
//!
//! ```text
//!   x_B = value + A x_N          N rows, N + 1 columns
//! ```
//! A pivot on (r, c) zeroes row r and column c and then adds u vᵀ with u_r = 1, v_c = 1/pivot: no cancellation
//! (method §5); [`super::updated_matrix`] says how such steps are collected and multiplied out.

use nalgebra::{DMatrix, DVector};

use super::mirrored::MirroredLcp;
use super::updated_matrix::{ColumnReader, UpdatedMatrix};
use super::waiting_steps::Combination;
use crate::lcp::basis::Basis;
use stickslip_numerics::decompositions::Factor;
use stickslip_numerics::products::add_product;

/// A variable of the dictionary. `W(i)` and `Z(i)` of a mirrored row stand for the member of the couple that
/// its orientation selects; the other w is known from [`Dictionary::hidden`], the other z is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Slot {
    W(usize),
    Z(usize),
    P,
}

/// Where a variable stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    Row(usize),
    Column(usize),
}

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct Dictionary {
    size: usize,
    entries: UpdatedMatrix,
    /// Values of the basic variables where all nonbasic ones are zero.
    pub(crate) value: Vec<f64>,
    /// Variable of each row.
    pub(crate) row: Vec<Slot>,
    /// Variable of each column.
    pub(crate) column: Vec<Slot>,
    place_w: Vec<Place>,
    place_z: Vec<Place>,
    place_p: Place,
    /// Whether row i stands for its mirror (x⁻ instead of x⁺).
    pub(crate) turned: Vec<bool>,
}

impl Dictionary {
    /// All w basic, all z and p nonbasic, no row turned.
    pub(crate) fn new(lcp: &MirroredLcp) -> Dictionary {
        let size = lcp.size();
        let mut entries = Vec::with_capacity(size * (size + 1));
        lcp.write_matrix(&mut entries);
        entries.extend_from_slice(lcp.covering.as_slice());
        let mut column: Vec<Slot> = (0..size).map(Slot::Z).collect();
        column.push(Slot::P);
        Dictionary {
            size,
            entries: UpdatedMatrix::new(size, size + 1, entries),
            value: lcp.q.as_slice().to_vec(),
            row: (0..size).map(Slot::W).collect(),
            column,
            place_w: (0..size).map(Place::Row).collect(),
            place_z: (0..size).map(Place::Column).collect(),
            place_p: Place::Column(size),
            turned: vec![false; size],
        }
    }

    /// The dictionary of a basis without p, built from the data; `None` where its equations are singular or both z
    /// of a mirrored couple are basic.
    pub(crate) fn at_basis(lcp: &MirroredLcp, basis: &Basis) -> Option<Dictionary> {
        if basis.p || basis.z != basis.active {
            return None;
        }
        let mut dictionary = Dictionary::new(lcp);
        let is_active = |whole: usize| basis.active.binary_search(&whole).is_ok();
        for i in 0..lcp.size() {
            let plain = is_active(lcp.whole[i]);
            let mirrored = lcp.mirrors[i].as_ref().is_some_and(|mirror| is_active(mirror.whole));
            if plain && mirrored {
                return None;
            }
            dictionary.turned[i] = mirrored;
            if plain || mirrored {
                dictionary.row[i] = Slot::Z(i);
                dictionary.column[i] = Slot::W(i);
                dictionary.place_z[i] = Place::Row(i);
                dictionary.place_w[i] = Place::Column(i);
            }
        }
        dictionary.rebuild(lcp).then_some(dictionary)
    }

    /// Multiplies the load increment by `factor`.
    pub(crate) fn rescale(&mut self, factor: f64) {
        let Place::Column(c) = self.place_p else {
            debug_assert!(false, "rescale needs p nonbasic");
            return;
        };
        self.entries.scale_column(c, factor);
    }

    /// Takes another load increment: the column of p becomes that of the given d. M and the mirrors' friction must
    /// be the same, and p nonbasic.
    pub(crate) fn reload(&mut self, lcp: &MirroredLcp) {
        let Place::Column(c) = self.place_p else {
            debug_assert!(false, "reload needs p nonbasic");
            return;
        };
        let increment = |i: usize| match &lcp.mirrors[i] {
            Some(mirror) if self.turned[i] => lcp.mirror_start(i, mirror).1,
            _ => lcp.covering[i],
        };
        // The column of w = M z + d p with the nonbasic w held at 0: p moves them by d p, which their own columns take
        // back.
        let held: Vec<(usize, f64)> = self
            .column
            .iter()
            .enumerate()
            .filter_map(|(column, &local)| match local {
                Slot::W(i) => Some((column, -increment(i))),
                _ => None,
            })
            .filter(|term| term.1 != 0.0)
            .collect();
        let mut rates = self.entries.combined(&held);
        for (rate, &local) in rates.iter_mut().zip(&self.row) {
            if let Slot::W(i) = local {
                *rate += increment(i);
            }
        }
        self.entries.exchange(None, c, &rates, &Combination::default(), 1.0);
    }

    /// How many batches of elimination steps were filled.
    pub(crate) fn batches(&self) -> usize {
        self.entries.filled()
    }

    pub(crate) fn place(&self, variable: Slot) -> Place {
        match variable {
            Slot::W(i) => self.place_w[i],
            Slot::Z(i) => self.place_z[i],
            Slot::P => self.place_p,
        }
    }

    fn set_place(&mut self, variable: Slot, place: Place) {
        match variable {
            Slot::W(i) => self.place_w[i] = place,
            Slot::Z(i) => self.place_z[i] = place,
            Slot::P => self.place_p = place,
        }
    }

    /// Column c, of which some entries will be read.
    pub(super) fn reader(&self, c: usize) -> ColumnReader<'_> {
        self.entries.reader(c)
    }

    /// Lets the columns of nonbasic w take over the waiting steps together, before entries of many of them are read.
    pub(crate) fn settle_w(&mut self) {
        let columns = self.column.iter().enumerate().filter(|column| matches!(column.1, Slot::W(_)));
        self.entries.settle(columns.map(|(c, _)| c));
    }

    /// The entries in the given rows and columns, column by column.
    pub(crate) fn block(&mut self, rows: &[usize], columns: &[usize]) -> Vec<f64> {
        self.entries.block(rows, columns)
    }

    /// Σ factor · column over the given (column, factor).
    pub(crate) fn combined_columns(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        self.entries.combined(terms)
    }

    /// Column c.
    pub(crate) fn fetch_column(&mut self, c: usize, into: &mut Vec<f64>) {
        self.entries.column(c, into);
    }

    /// Value of a variable at the vertex.
    pub(crate) fn value_of(&self, variable: Slot) -> f64 {
        match self.place(variable) {
            Place::Row(r) => self.value[r],
            Place::Column(_) => 0.0,
        }
    }

    /// Rate of a variable along the column `c`, whose entries are `rates`.
    #[inline]
    pub(crate) fn rate(&self, variable: Slot, c: usize, rates: &[f64]) -> f64 {
        match self.place(variable) {
            Place::Row(r) => rates[r],
            Place::Column(j) => f64::from(j == c),
        }
    }

    /// Value of the hidden member of the couple of row i; 0 where it has none.
    pub(crate) fn hidden_value(&self, lcp: &MirroredLcp, i: usize) -> f64 {
        let value = |row| self.value_of(Slot::W(row));
        lcp.mirrors[i].as_ref().map_or(0.0, |mirror| mirror.reflect(i, value, self.value_of(Slot::P), 1.0))
    }

    /// Rate of the hidden member of the couple of row i along the column `c`; 0 where it has none.
    pub(crate) fn hidden_rate(&self, lcp: &MirroredLcp, i: usize, c: usize, rates: &[f64]) -> f64 {
        let rate = |row| self.rate(Slot::W(row), c, rates);
        lcp.mirrors[i].as_ref().map_or(0.0, |mirror| mirror.reflect(i, rate, self.rate(Slot::P, c, rates), 0.0))
    }

    /// Adds `factor` times the row of `variable` (the unit row if it is nonbasic) to a combination.
    fn add_row(&self, variable: Slot, factor: f64, to: &mut Combination) {
        if factor == 0.0 {
            return;
        }
        match self.place(variable) {
            Place::Row(r) => to.rows.push((r, factor)),
            Place::Column(c) => to.units.push((c, factor)),
        }
    }

    /// `factor` times the row of the hidden member of the couple of row i.
    fn hidden_row(&self, lcp: &MirroredLcp, i: usize, factor: f64) -> Combination {
        let mut row = Combination::default();
        if let Some(mirror) = &lcp.mirrors[i] {
            if let Some(n) = mirror.normal {
                self.add_row(Slot::W(n), 2.0 * mirror.friction * factor, &mut row);
            }
            self.add_row(Slot::P, mirror.covering * factor, &mut row);
            self.add_row(Slot::W(i), -factor, &mut row);
        }
        row
    }

    /// Turns round a couple whose w is basic and whose z is nonbasic: the row becomes its mirror, the column of z
    /// changes sign.
    pub(crate) fn turn(&mut self, lcp: &MirroredLcp, i: usize) {
        let (Place::Row(r), Place::Column(c)) = (self.place_w[i], self.place_z[i]) else {
            debug_assert!(false, "turn needs w basic and z nonbasic");
            return;
        };
        let value = self.hidden_value(lcp, i);
        let row = self.hidden_row(lcp, i, 1.0);
        self.entries.replace_row(r, &row);
        self.entries.scale_column(c, -1.0);
        self.value[r] = value;
        self.turned[i] = !self.turned[i];
    }

    /// Exchanges the variable of row r with that of column c; `column` = fetched column c. The entering variable
    /// takes the value `step`; the values of all rows move along.
    pub(crate) fn pivot(&mut self, r: usize, c: usize, column: &[f64], step: f64) {
        let pivot = column[r];
        self.advance(column, step);
        self.value[r] = step;
        let combination = Combination { rows: vec![(r, -1.0 / pivot)], units: Vec::new() };
        self.entries.exchange(Some(r), c, column, &combination, 1.0 / pivot);
        let (leaving, entering) = (self.row[r], self.column[c]);
        self.row[r] = entering;
        self.column[c] = leaving;
        self.set_place(entering, Place::Row(r));
        self.set_place(leaving, Place::Column(c));
    }

    /// The entering w of column c is stopped by its own hidden mirror: the column now belongs to the mirror
    /// (w = 2 f w_n + b + e p − w'), which is zero.
    pub(crate) fn pivot_hidden(&mut self, lcp: &MirroredLcp, i: usize, c: usize, column: &[f64], step: f64) {
        let pivot = self.hidden_rate(lcp, i, c, column);
        let combination = self.hidden_row(lcp, i, -1.0 / pivot);
        self.advance(column, step);
        self.entries.exchange(None, c, column, &combination, 1.0 / pivot);
        if let Place::Column(z) = self.place_z[i] {
            self.entries.scale_column(z, -1.0);
        }
        self.turned[i] = !self.turned[i];
    }

    /// The values after the variable whose rates are given has grown by `step`.
    pub(crate) fn advance(&mut self, rates: &[f64], step: f64) {
        for (value, rate) in self.value.iter_mut().zip(rates) {
            *value += rate * step;
        }
    }

    /// q of the present orientations.
    fn oriented_load(&self, lcp: &MirroredLcp) -> Vec<f64> {
        let of_mirror = |i: usize| lcp.mirrors[i].as_ref().filter(|_| self.turned[i]);
        (0..self.size).map(|i| of_mirror(i).map_or(lcp.q[i], |mirror| lcp.mirror_start(i, mirror).0)).collect()
    }

    /// The coefficients of a variable in w = M z + d p over the primary rows of the present orientations.
    fn write_coefficients(&self, lcp: &MirroredLcp, variable: Slot, into: &mut [f64]) {
        match variable {
            Slot::W(_) => return into.fill(0.0),
            Slot::P => into.copy_from_slice(lcp.covering.as_slice()),
            Slot::Z(j) => lcp.write_column(j, into),
        }
        let p = f64::from(variable == Slot::P);
        for i in (0..self.size).filter(|&i| self.turned[i]) {
            if let Some(mirror) = &lcp.mirrors[i] {
                into[i] = mirror.reflect(i, |row| into[row], p, 0.0);
            }
        }
        if matches!(variable, Slot::Z(j) if self.turned[j]) {
            into.iter_mut().for_each(|entry| *entry = -*entry);
        }
    }

    /// The active system of the present basis: rows with w nonbasic, columns of the basic z and of p.
    fn active(&self) -> (Vec<usize>, Vec<usize>, bool) {
        let is_column = |place: &Place| matches!(place, Place::Column(_));
        let rows = (0..self.size).filter(|&i| is_column(&self.place_w[i])).collect();
        let columns = (0..self.size).filter(|&i| !is_column(&self.place_z[i])).collect();
        (rows, columns, !is_column(&self.place_p))
    }

    /// Builds T and the values afresh from the data for the present basis. `false` (and no change) where the
    /// active system is singular.
    pub(crate) fn rebuild(&mut self, lcp: &MirroredLcp) -> bool {
        let (rows, columns, with_p) = self.active();
        let (size, width, s) = (self.size, self.size + 1, rows.len());
        if columns.len() + usize::from(with_p) != s {
            return false;
        }
        let basic: Vec<(Slot, usize)> = columns
            .iter()
            .map(|&j| Slot::Z(j))
            .chain(with_p.then_some(Slot::P))
            .filter_map(|variable| match self.place(variable) {
                Place::Row(r) => Some((variable, r)),
                Place::Column(_) => None,
            })
            .collect();
        let inactive: Vec<(usize, usize)> = (0..size)
            .filter_map(|i| match self.place_w[i] {
                Place::Row(r) => Some((i, r)),
                Place::Column(_) => None,
            })
            .collect();
        // w = (basic) x_S + (nonbasic) x_N + q: in the active rows, where w is nonbasic, and row by row of the dictionary in
        // the others.
        let mut coefficients = vec![0.0; size];
        let mut system = DMatrix::zeros(s, s);
        let mut coupling = vec![0.0; size * s];
        for (b, &(variable, _)) in basic.iter().enumerate() {
            self.write_coefficients(lcp, variable, &mut coefficients);
            system.column_mut(b).iter_mut().zip(&rows).for_each(|(entry, &i)| *entry = coefficients[i]);
            inactive.iter().for_each(|&(i, r)| coupling[r + b * size] = coefficients[i]);
        }
        let mut right = DMatrix::zeros(s, width);
        let mut t = vec![0.0; size * width];
        for (c, (&variable, column)) in self.column.iter().zip(t.chunks_exact_mut(size.max(1))).enumerate() {
            let mut own = right.column_mut(c);
            if let Slot::W(i) = variable {
                own.iter_mut().zip(&rows).for_each(|(entry, &row)| *entry = f64::from(row == i));
                continue;
            }
            self.write_coefficients(lcp, variable, &mut coefficients);
            own.iter_mut().zip(&rows).for_each(|(entry, &row)| *entry = -coefficients[row]);
            inactive.iter().for_each(|&(i, r)| column[r] = coefficients[i]);
        }
        let q = self.oriented_load(lcp);
        let constant = DVector::from_fn(s, |a, _| -q[rows[a]]);
        let factor = Factor::new(system);
        let (Some(solution), Some(values)) = (factor.solve_many(&right), factor.solve(&constant)) else {
            return false;
        };
        let mut value = vec![0.0; size];
        inactive.iter().for_each(|&(i, r)| value[r] = q[i]);
        add_product(&mut value, &coupling, values.as_slice(), size, 1, s);
        add_product(&mut t, &coupling, solution.as_slice(), size, width, s);
        basic.iter().zip(values.iter()).for_each(|(&(_, r), own)| value[r] = *own);
        for (column, solution) in t.chunks_exact_mut(size.max(1)).zip(solution.column_iter()) {
            basic.iter().zip(solution.iter()).for_each(|(&(_, r), own)| column[r] = *own);
        }
        if !t.iter().chain(&value).all(|entry| entry.is_finite()) {
            return false;
        }
        self.entries.replace(t);
        self.value = value;
        true
    }
}

#[cfg(test)]
#[path = "dictionary_tests.rs"]
mod tests;
