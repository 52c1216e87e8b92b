//! Guarding against errors: comparing the numbers of a state with the data, refining them, rebuilding the dictionary.

use super::{Candidate, PivotState, SUSPICIOUS};
use crate::doubled::{Doubled, Real};
use crate::lcp::dictionary::{Place, Slot};
use crate::lcp::outcome::Point;
use stickslip_numerics::doubled::add_response;

/// Relative error of the dictionary against the data above which it is built afresh.
const DRIFT: f64 = 1e-10;

/// Relative error of a column against the data that building it afresh would not make smaller.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// A column is refined, and the dictionary not built afresh, up to this error relative to the small rate at stake.
const REFINED: f64 = 1e-5;

impl PivotState {
    /// Rate of decrease of a tied row along column c, relative to its natural size.
    pub(super) fn relative_fall(&self, c: usize, tied: &Candidate) -> f64 {
        let p_rate = self.dictionary.rate(Slot::P, c, &self.column);
        tied.fall / self.rate_size(tied.variable, self.rate_total(c), p_rate).max(f64::MIN_POSITIVE)
    }

    /// Whether the decision on column c depends on a rate so near the noise that the data must confirm it: a small
    /// residual of the column does not show that a small rate in it is right. One such row is enough: its rate may be
    /// nothing but noise.
    pub(crate) fn is_suspicious(&self, c: usize, tied: &[Candidate]) -> bool {
        !self.fresh && (tied.is_empty() || tied.iter().any(|tied| self.relative_fall(c, tied) <= SUSPICIOUS))
    }

    /// The values at the vertex beside those that the data give.
    fn values(&self) -> Numbers<'_> {
        Numbers::new(self, &self.dictionary.value, None, 1.0)
    }

    /// The rates along column c, which was fetched last, beside those that the data give.
    fn rates(&self, c: usize) -> Numbers<'_> {
        Numbers::new(self, &self.column, Some(c), 0.0)
    }

    /// By how much rounding may move a value, relative to the largest load: where the responses of single
    /// displacements are much larger than the load and cancel.
    pub(crate) fn blur(&self) -> f64 {
        self.blur_of(self.size_of(&self.dictionary.value)) / self.lcp.load_size().max(f64::MIN_POSITIVE)
    }

    /// By how much rounding may move a value where Σ column_k |z_k| = `size`.
    fn blur_of(&self, size: f64) -> f64 {
        ROUNDING * size * self.lcp.scale.row.iter().fold(0.0, |a: f64, b| a.max(*b))
    }

    /// Whether rows that hardly fall along column c block it only so far away that rounding of the displacements there
    /// would exceed `share` of the load, p included: nothing tells them from rows that do not fall.
    pub(crate) fn blocks_beyond_measure(&self, c: usize, tied: &[Candidate], step: f64, share: f64) -> bool {
        let load = self.sizes.q.iter().zip(&self.sizes.d).map(|(q, d)| q + d * self.p().abs()).fold(0.0, f64::max);
        tied.iter().all(|tied| self.relative_fall(c, tied) <= SUSPICIOUS)
            && load > 0.0
            && self.blur_of(self.rate_total(c) * step) > share * load
    }

    /// All variables at the vertex, as true to the data as solving its equations afresh would make them: one step of
    /// refinement with residuals in doubled precision squares the error of the dictionary, which is built afresh where
    /// it exceeds [`DRIFT`]. `None` where the result does not agree with the data to rounding.
    pub(crate) fn sharp_point(&self) -> Option<Point> {
        let held = Numbers::doubled(self, &self.dictionary.value).corrected();
        let error = Numbers::new(self, &held, None, 1.0).error(self.size_of(&held));
        (error <= ROUNDING).then(|| self.point_of(&held))
    }

    /// Refines the values.
    pub(crate) fn refine(&mut self) {
        self.dictionary.value = self.values().corrected();
    }

    /// Makes the column fetched last, on whose small rate in the `tied` rows a decision depends, as true to the data as
    /// it can be made: by refinement, or, where the dictionary is too far off for that, by building it afresh. `false`
    /// (and nothing changed): the equations of the scheme are singular.
    pub(crate) fn refine_if_doubtful(&mut self, c: usize, tied: &[Candidate]) -> bool {
        let surest = tied.iter().map(|tied| self.relative_fall(c, tied)).fold(0.0, f64::max);
        let bearable = REFINED * surest;
        let rates = self.rates(c);
        if rates.error(self.rate_total(c)) <= bearable {
            let refined = rates.corrected();
            self.set_column(refined);
            return true;
        }
        if !self.refresh() {
            return false;
        }
        self.fetch(c);
        self.refine_column(c);
        true
    }

    /// Refines the column fetched last.
    pub(crate) fn refine_column(&mut self, c: usize) {
        let refined = self.rates(c).corrected();
        self.set_column(refined);
    }

    /// Whether the dictionary's values still agree with the data.
    fn agrees(&self) -> bool {
        let size = self.size_of(&self.dictionary.value);
        self.values().error(size) <= DRIFT
    }

    /// Builds the dictionary afresh from the data; `false` where the equations of the scheme are singular.
    pub(crate) fn refresh(&mut self) -> bool {
        if self.dictionary.rebuild(&self.lcp) {
            self.fresh = true;
            self.refreshes += 1;
        }
        self.fresh
    }

    /// After each batch of steps the values are compared with the data. `false`: they are wrong and the equations are
    /// singular.
    pub(crate) fn check_drift(&mut self) -> bool {
        let batches = self.dictionary.batches();
        if std::mem::replace(&mut self.compared, batches) == batches {
            return true;
        }
        self.fresh || self.agrees() || self.refresh()
    }
}

/// The numbers of all variables, values or rates, as the dictionary holds them, and w as the data give it, in f64 or in
/// doubled precision.
struct Numbers<'a, T: Real = f64> {
    stand: &'a PivotState,
    /// Numbers of the basic variables, row by row.
    held: &'a [f64],
    /// Column of the variable that grows; the others are zero.
    entering: Option<usize>,
    /// 1 for values, 0 for rates: whether the constants count.
    shift: f64,
    p: f64,
    /// M z + shift q + d p over the primary rows.
    w: Vec<T>,
}

impl<'a> Numbers<'a> {
    fn new(stand: &'a PivotState, held: &'a [f64], entering: Option<usize>, shift: f64) -> Numbers<'a> {
        let mut numbers = Numbers { stand, held, entering, shift, p: 0.0, w: Vec::new() };
        let z = numbers.take_unknowns();
        let lcp = &stand.lcp;
        numbers.w = (lcp.times(&z) + shift * &lcp.q + numbers.p * &lcp.covering).as_slice().to_vec();
        numbers
    }

    /// The largest difference between the dictionary and the data, relative to the natural sizes of the rows; `size`: Σ
    /// column_k |z_k|.
    fn error(&self, size: f64) -> f64 {
        let stand = self.stand;
        (0..stand.lcp.size())
            .map(|i| {
                let held = self.turned(i, |row| self.of(Slot::W(row)));
                let natural = stand.rate_size(Slot::W(i), size, self.p) + self.shift * stand.sizes.q[i];
                (self.w[i] - held).abs() / natural.max(f64::MIN_POSITIVE)
            })
            .fold(0.0, larger)
    }
}

impl<'a> Numbers<'a, Doubled> {
    /// Values.
    fn doubled(stand: &'a PivotState, held: &'a [f64]) -> Numbers<'a, Doubled> {
        let mut numbers = Numbers { stand, held, entering: None, shift: 1.0, p: 0.0, w: Vec::new() };
        let z = numbers.take_unknowns();
        let lcp = &stand.lcp;
        let (mut high, mut low) = (vec![0.0; lcp.size()], vec![0.0; lcp.size()]);
        add_response(&mut high, &mut low, lcp.base.as_slice(), &z);
        let own = |i: usize| Doubled::sum(high[i], low[i]);
        let w = |i: usize| {
            let coupled = lcp.coupling(i).map_or_else(Doubled::default, |(n, f)| Doubled::from(f) * own(n));
            own(i) + coupled + Doubled::from(lcp.q[i]) + Doubled::product(lcp.covering[i], numbers.p)
        };
        numbers.w = (0..lcp.size()).map(w).collect();
        numbers
    }
}

impl<T: Real> Numbers<'_, T> {
    /// Takes p over; z of the primary rows, z⁺ − z⁻ for couples.
    fn take_unknowns(&mut self) -> Vec<f64> {
        self.p = self.of(Slot::P);
        std::iter::zip(0.., &self.stand.dictionary.turned)
            .map(|(i, &turned)| {
                let z = self.of(Slot::Z(i));
                if turned { -z } else { z }
            })
            .collect()
    }

    fn nonbasic(&self, c: usize) -> f64 {
        f64::from(self.entering == Some(c))
    }

    /// As the dictionary holds it.
    fn of(&self, local: Slot) -> f64 {
        match self.stand.dictionary.place(local) {
            Place::Row(r) => self.held[r],
            Place::Column(c) => self.nonbasic(c),
        }
    }

    /// `w` of row i where it is turned round, from the w of the primary rows, and the other way.
    fn turned<N: Real>(&self, i: usize, w: impl Fn(usize) -> N) -> N {
        match &self.stand.lcp.mirrors[i] {
            Some(mirror) if self.stand.dictionary.turned[i] => mirror.reflect(i, w, self.p, self.shift),
            _ => w(i),
        }
    }

    /// w of row i as the data give it, in the orientation in which the dictionary holds it.
    fn of_data(&self, i: usize) -> f64 {
        self.turned(i, |row| self.w[row]).to_f64()
    }

    /// One step of iterative refinement: the equations of the scheme as the data give them, solved by the dictionary.
    fn corrected(&self) -> Vec<f64> {
        let d = &self.stand.dictionary;
        let wrong: Vec<(usize, f64)> = d
            .column
            .iter()
            .enumerate()
            .filter_map(|(c, &local)| match local {
                Slot::W(i) => Some((c, self.nonbasic(c) - self.of_data(i))),
                _ => None,
            })
            .collect();
        let change = d.combined_columns(&wrong);
        std::iter::zip(&d.row, std::iter::zip(self.held, change))
            .map(|(&local, (held, change))| match local {
                Slot::W(i) => self.of_data(i) + change,
                _ => held + change,
            })
            .collect()
    }
}

/// The larger one; NaN if one of them is.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}
