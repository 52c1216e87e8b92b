//! The dictionary of a mirrored LCP: basic variables as affine functions of the nonbasic ones,
//!
//! ```text
//!   x_B = value + (T + U Vᵀ) x_N          N rows, N + 1 columns
//! ```
//! Pivots are collected as rank-one terms u vᵀ and flushed into T by one matrix product (theory §5 (b)). A pivot
//! on (r, c) zeroes row r and column c and then adds u vᵀ with u_r = 1, v_c = 1/pivot: no cancellation.

use nalgebra::{DMatrix, DVector};

use super::dense::{Factor, add_product};
use super::mirrored::MirroredLcp;
use super::vertex::Basis;

/// A variable of the dictionary. `W(i)` and `Z(i)` of a mirrored row stand for the member of the couple that
/// its orientation selects; the other w is known from [`Dictionary::hidden`], the other z is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Local {
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

/// How many rank-one terms wait before they are multiplied out.
const PENDING: usize = 48;

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct Dictionary {
    size: usize,
    t: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
    pending: usize,
    /// Values of the basic variables where all nonbasic ones are zero.
    pub(crate) value: Vec<f64>,
    /// Variable of each row.
    pub(crate) row: Vec<Local>,
    /// Variable of each column.
    pub(crate) column: Vec<Local>,
    place_w: Vec<Place>,
    place_z: Vec<Place>,
    place_p: Place,
    /// Whether row i stands for its mirror (x⁻ instead of x⁺).
    pub(crate) turned: Vec<bool>,
}

/// An affine function of the nonbasic variables, evaluated along one column: value and rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Along {
    pub(crate) value: f64,
    pub(crate) rate: f64,
}

impl Dictionary {
    /// All w basic, all z and p nonbasic, no row turned.
    pub(crate) fn new(lcp: &MirroredLcp) -> Dictionary {
        let size = lcp.size();
        let mut t = Vec::with_capacity(size * (size + 1));
        t.extend_from_slice(lcp.matrix.as_slice());
        t.extend_from_slice(lcp.covering.as_slice());
        let mut column: Vec<Local> = (0..size).map(Local::Z).collect();
        column.push(Local::P);
        Dictionary {
            size,
            t,
            u: vec![0.0; size * PENDING],
            v: vec![0.0; (size + 1) * PENDING],
            pending: 0,
            value: lcp.q.as_slice().to_vec(),
            row: (0..size).map(Local::W).collect(),
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
            let mirrored = lcp.mirrors[i]
                .as_ref()
                .is_some_and(|mirror| is_active(mirror.whole));
            if plain && mirrored {
                return None;
            }
            dictionary.turned[i] = mirrored;
            if plain || mirrored {
                dictionary.row[i] = Local::Z(i);
                dictionary.column[i] = Local::W(i);
                dictionary.place_z[i] = Place::Row(i);
                dictionary.place_w[i] = Place::Column(i);
            }
        }
        dictionary.rebuild(lcp).then_some(dictionary)
    }

    /// Takes another load: the values and the column of p become those of the given q and d. M and the mirrors'
    /// friction must be the same, and p nonbasic; `false` (and no change) where it is not.
    pub(crate) fn reload(&mut self, lcp: &MirroredLcp) -> bool {
        let Place::Column(c) = self.place_p else {
            return false;
        };
        self.flush();
        let respond = |dictionary: &Dictionary, primary: &dyn Fn(usize) -> f64| -> Vec<f64> {
            // Of w = M z + r with the nonbasic w held at 0: a nonbasic w enters its column as w − r.
            let mut response = vec![0.0; dictionary.size];
            for (column, &local) in dictionary.column.iter().enumerate() {
                if let Local::W(i) = local {
                    let right = primary(i);
                    if right != 0.0 {
                        let t =
                            &dictionary.t[column * dictionary.size..(column + 1) * dictionary.size];
                        for (entry, t) in response.iter_mut().zip(t) {
                            *entry -= right * t;
                        }
                    }
                }
            }
            for (entry, &local) in response.iter_mut().zip(&dictionary.row) {
                if let Local::W(i) = local {
                    *entry += primary(i);
                }
            }
            response
        };
        let start = |i: usize| match &lcp.mirrors[i] {
            Some(mirror) if self.turned[i] => lcp.mirror_start(i, mirror),
            _ => (lcp.q[i], lcp.covering[i]),
        };
        let value = respond(self, &|i| start(i).0);
        let column = respond(self, &|i| start(i).1);
        self.value = value;
        self.t[c * self.size..(c + 1) * self.size].copy_from_slice(&column);
        true
    }

    /// Number of rank-one terms that wait.
    pub(crate) fn pending(&self) -> usize {
        self.pending
    }

    pub(crate) fn place(&self, variable: Local) -> Place {
        match variable {
            Local::W(i) => self.place_w[i],
            Local::Z(i) => self.place_z[i],
            Local::P => self.place_p,
        }
    }

    fn set_place(&mut self, variable: Local, place: Place) {
        match variable {
            Local::W(i) => self.place_w[i] = place,
            Local::Z(i) => self.place_z[i] = place,
            Local::P => self.place_p = place,
        }
    }

    /// Entry (r, c) of T + U Vᵀ.
    pub(crate) fn entry(&self, r: usize, c: usize) -> f64 {
        let mut entry = self.t[r + c * self.size];
        for k in 0..self.pending {
            entry += self.u[r + k * self.size] * self.v[c + k * (self.size + 1)];
        }
        entry
    }

    /// Column c of T; all of it where nothing waits (after [`Dictionary::flush`]).
    pub(crate) fn stored_column(&self, c: usize) -> &[f64] {
        debug_assert_eq!(self.pending, 0);
        &self.t[c * self.size..(c + 1) * self.size]
    }

    /// Column c of T + U Vᵀ.
    pub(crate) fn fetch_column(&self, c: usize, into: &mut Vec<f64>) {
        into.clear();
        into.extend_from_slice(&self.t[c * self.size..(c + 1) * self.size]);
        for k in 0..self.pending {
            let factor = self.v[c + k * (self.size + 1)];
            if factor != 0.0 {
                let u = &self.u[k * self.size..(k + 1) * self.size];
                for (entry, u) in into.iter_mut().zip(u) {
                    *entry += u * factor;
                }
            }
        }
    }

    /// Row r of T + U Vᵀ.
    pub(crate) fn fetch_row(&self, r: usize, into: &mut Vec<f64>) {
        into.clear();
        into.extend(self.t[r..].iter().step_by(self.size).take(self.size + 1));
        for k in 0..self.pending {
            let factor = self.u[r + k * self.size];
            if factor != 0.0 {
                let v = &self.v[k * (self.size + 1)..(k + 1) * (self.size + 1)];
                for (entry, v) in into.iter_mut().zip(v) {
                    *entry += v * factor;
                }
            }
        }
    }

    /// Value of a variable at the vertex.
    pub(crate) fn value_of(&self, variable: Local) -> f64 {
        match self.place(variable) {
            Place::Row(r) => self.value[r],
            Place::Column(_) => 0.0,
        }
    }

    /// Value of the hidden member of the couple of row i.
    pub(crate) fn hidden_value(&self, lcp: &MirroredLcp, i: usize) -> f64 {
        let Some(mirror) = &lcp.mirrors[i] else {
            return 0.0;
        };
        let normal = mirror.normal.map_or(0.0, |n| self.value_of(Local::W(n)));
        2.0 * mirror.friction * normal + mirror.constant + mirror.covering * self.value_of(Local::P)
            - self.value_of(Local::W(i))
    }

    /// Value of a variable at the vertex and its rate along the column `c`, whose entries are `rates`.
    pub(crate) fn along(&self, variable: Local, c: usize, rates: &[f64]) -> Along {
        match self.place(variable) {
            Place::Row(r) => Along {
                value: self.value[r],
                rate: rates[r],
            },
            Place::Column(j) if j == c => Along {
                value: 0.0,
                rate: 1.0,
            },
            Place::Column(_) => Along::default(),
        }
    }

    /// Value and rate of the hidden member of the couple of row i, from 2 f w_n + b + e p − w.
    pub(crate) fn hidden(&self, lcp: &MirroredLcp, i: usize, c: usize, rates: &[f64]) -> Along {
        let Some(mirror) = &lcp.mirrors[i] else {
            return Along::default();
        };
        let own = self.along(Local::W(i), c, rates);
        let p = self.along(Local::P, c, rates);
        let normal = mirror
            .normal
            .map_or(Along::default(), |n| self.along(Local::W(n), c, rates));
        let double = 2.0 * mirror.friction;
        Along {
            value: double * normal.value + mirror.constant + mirror.covering * p.value - own.value,
            rate: double * normal.rate + mirror.covering * p.rate - own.rate,
        }
    }

    /// Adds `factor` times the row of `variable` (the unit row if it is nonbasic) to `into`.
    fn add_row(&self, variable: Local, factor: f64, into: &mut [f64], scratch: &mut Vec<f64>) {
        if factor == 0.0 {
            return;
        }
        match self.place(variable) {
            Place::Row(r) => {
                self.fetch_row(r, scratch);
                for (entry, row) in into.iter_mut().zip(scratch.iter()) {
                    *entry += factor * row;
                }
            }
            Place::Column(c) => into[c] += factor,
        }
    }

    /// The row of the hidden member of the couple of row i over the nonbasic variables.
    pub(crate) fn hidden_row(&self, lcp: &MirroredLcp, i: usize) -> Vec<f64> {
        let mut row = vec![0.0; self.size + 1];
        let mut scratch = Vec::new();
        if let Some(mirror) = &lcp.mirrors[i] {
            if let Some(n) = mirror.normal {
                self.add_row(Local::W(n), 2.0 * mirror.friction, &mut row, &mut scratch);
            }
            self.add_row(Local::P, mirror.covering, &mut row, &mut scratch);
            self.add_row(Local::W(i), -1.0, &mut row, &mut scratch);
        }
        row
    }

    /// Turns a couple round whose w is basic and whose z is nonbasic: the row becomes its mirror, the column of z
    /// changes sign.
    pub(crate) fn turn(&mut self, lcp: &MirroredLcp, i: usize) {
        let (Place::Row(r), Place::Column(c)) = (self.place_w[i], self.place_z[i]) else {
            debug_assert!(false, "turn needs w basic and z nonbasic");
            return;
        };
        let value = self.hidden_value(lcp, i);
        let row = self.hidden_row(lcp, i);
        // Replace row r by adding the unit rank-one term e_r · (new row) to a zeroed row.
        self.clear_row(r);
        self.push(|u, v| {
            u[r] = 1.0;
            v.copy_from_slice(&row);
        });
        self.negate_column(c);
        self.value[r] = value;
        self.turned[i] = !self.turned[i];
    }

    /// Exchanges the variable of row r with that of column c; `column` = fetched column c. The entering variable
    /// takes the value `step`; the values of all rows move along.
    pub(crate) fn pivot(&mut self, r: usize, c: usize, column: &[f64], step: f64) {
        let pivot = column[r];
        let mut row = Vec::new();
        self.fetch_row(r, &mut row);
        for (value, rate) in self.value.iter_mut().zip(column) {
            *value += rate * step;
        }
        self.value[r] = step;
        self.clear_row(r);
        self.clear_column(c);
        self.push(|u, v| {
            u.copy_from_slice(column);
            u[r] = 1.0;
            for (v, entry) in v.iter_mut().zip(&row) {
                *v = -entry / pivot;
            }
            v[c] = 1.0 / pivot;
        });
        let (leaving, entering) = (self.row[r], self.column[c]);
        self.row[r] = entering;
        self.column[c] = leaving;
        self.set_place(entering, Place::Row(r));
        self.set_place(leaving, Place::Column(c));
    }

    /// The entering w of column c is stopped by its own hidden mirror: the column now belongs to the mirror
    /// (w = 2 f w_n + b + e p − w'), which is zero.
    pub(crate) fn pivot_hidden(
        &mut self,
        lcp: &MirroredLcp,
        i: usize,
        c: usize,
        column: &[f64],
        step: f64,
    ) {
        let hidden = self.hidden_row(lcp, i);
        let pivot = hidden[c];
        for (value, rate) in self.value.iter_mut().zip(column) {
            *value += rate * step;
        }
        self.clear_column(c);
        self.push(|u, v| {
            u.copy_from_slice(column);
            for (v, entry) in v.iter_mut().zip(&hidden) {
                *v = -entry / pivot;
            }
            v[c] = 1.0 / pivot;
        });
        if let Place::Column(z) = self.place_z[i] {
            self.negate_column(z);
        }
        self.turned[i] = !self.turned[i];
    }

    fn clear_row(&mut self, r: usize) {
        let size = self.size;
        for entry in self.t[r..].iter_mut().step_by(size).take(size + 1) {
            *entry = 0.0;
        }
        for k in 0..self.pending {
            self.u[r + k * size] = 0.0;
        }
    }

    fn clear_column(&mut self, c: usize) {
        self.t[c * self.size..(c + 1) * self.size].fill(0.0);
        for k in 0..self.pending {
            self.v[c + k * (self.size + 1)] = 0.0;
        }
    }

    fn negate_column(&mut self, c: usize) {
        for entry in &mut self.t[c * self.size..(c + 1) * self.size] {
            *entry = -*entry;
        }
        for k in 0..self.pending {
            let v = &mut self.v[c + k * (self.size + 1)];
            *v = -*v;
        }
    }

    fn push(&mut self, fill: impl FnOnce(&mut [f64], &mut [f64])) {
        let (size, k) = (self.size, self.pending);
        let u = &mut self.u[k * size..(k + 1) * size];
        let v = &mut self.v[k * (size + 1)..(k + 1) * (size + 1)];
        u.fill(0.0);
        v.fill(0.0);
        fill(u, v);
        self.pending += 1;
        if self.pending == PENDING {
            self.flush();
        }
    }

    /// Multiplies the waiting rank-one terms out.
    pub(crate) fn flush(&mut self) {
        add_product(
            &mut self.t,
            &self.u,
            &self.v,
            self.size,
            self.size + 1,
            self.pending,
        );
        self.pending = 0;
    }

    /// M, q, d of the present orientations.
    fn oriented(&self, lcp: &MirroredLcp) -> (DMatrix<f64>, DVector<f64>, DVector<f64>) {
        let (mut matrix, mut q, mut d) = (
            DMatrix::clone(&lcp.matrix),
            lcp.q.clone(),
            lcp.covering.clone(),
        );
        for i in (0..self.size).filter(|&i| self.turned[i]) {
            let Some(mirror) = &lcp.mirrors[i] else {
                continue;
            };
            for j in 0..self.size {
                let normal = mirror.normal.map_or(0.0, |n| matrix[(n, j)]);
                matrix[(i, j)] = 2.0 * mirror.friction * normal - matrix[(i, j)];
            }
            (q[i], d[i]) = lcp.mirror_start(i, mirror);
        }
        for i in (0..self.size).filter(|&i| self.turned[i]) {
            matrix.column_mut(i).neg_mut();
        }
        (matrix, q, d)
    }

    /// The active system of the present basis: rows with w nonbasic, columns of the basic z and of p.
    fn active(&self) -> (Vec<usize>, Vec<usize>, bool) {
        let is_column = |place: &Place| matches!(place, Place::Column(_));
        let rows = (0..self.size)
            .filter(|&i| is_column(&self.place_w[i]))
            .collect();
        let columns = (0..self.size)
            .filter(|&i| !is_column(&self.place_z[i]))
            .collect();
        (rows, columns, !is_column(&self.place_p))
    }

    /// Builds T and the values afresh from the data for the present basis. `false` (and no change) where the
    /// active system is singular.
    pub(crate) fn rebuild(&mut self, lcp: &MirroredLcp) -> bool {
        let (matrix, q, d) = self.oriented(lcp);
        let (rows, columns, with_p) = self.active();
        let s = rows.len();
        if columns.len() + usize::from(with_p) != s {
            return false;
        }
        // All nonbasic columns of w = M z + d p + q, and q last.
        let coefficient = |i: usize, variable: Local| match variable {
            Local::Z(j) => matrix[(i, j)],
            Local::P => d[i],
            Local::W(_) => 0.0,
        };
        let basic: Vec<Local> = columns
            .iter()
            .map(|&j| Local::Z(j))
            .chain(with_p.then_some(Local::P))
            .collect();
        let system = DMatrix::from_fn(s, s, |a, b| coefficient(rows[a], basic[b]));
        let width = self.size + 1;
        // 0 = system x_S + (nonbasic) x_N + q − w_A
        let right = DMatrix::from_fn(s, width, |a, c| match self.column[c] {
            Local::W(i) => f64::from(i == rows[a]),
            other => -coefficient(rows[a], other),
        });
        let constant = DVector::from_fn(s, |a, _| -q[rows[a]]);
        let factor = Factor::new(system);
        let (Some(solution), Some(values)) = (factor.solve_many(&right), factor.solve(&constant))
        else {
            return false;
        };
        let mut t = vec![0.0; self.size * width];
        let mut value = vec![0.0; self.size];
        for (b, &variable) in basic.iter().enumerate() {
            let Place::Row(r) = self.place(variable) else {
                return false;
            };
            value[r] = values[b];
            for c in 0..width {
                t[r + c * self.size] = solution[(b, c)];
            }
        }
        let inactive: Vec<(usize, usize)> = (0..self.size)
            .filter_map(|i| match self.place_w[i] {
                Place::Row(r) => Some((i, r)),
                Place::Column(_) => None,
            })
            .collect();
        let coupling = DMatrix::from_fn(inactive.len(), s, |a, b| {
            coefficient(inactive[a].0, basic[b])
        });
        let response = &coupling * &solution;
        let shift = &coupling * &values;
        for (a, &(i, r)) in inactive.iter().enumerate() {
            value[r] = q[i] + shift[a];
            for c in 0..width {
                t[r + c * self.size] = response[(a, c)] + coefficient(i, self.column[c]);
            }
        }
        if !t.iter().chain(&value).all(|entry| entry.is_finite()) {
            return false;
        }
        self.t = t;
        self.value = value;
        self.pending = 0;
        true
    }
}
