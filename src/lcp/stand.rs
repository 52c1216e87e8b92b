//! Where a run stands: the LCP, its dictionary, and the column of what grows. What Lemke's algorithm and the path
//! in a load have in common: natural sizes, zero tests, the ratio test with its ties, the watch over errors.

use std::sync::Arc;

use nalgebra::DVector;

use super::dictionary::{Dictionary, Local, Place};
use super::mirrored::MirroredLcp;
use super::outcome::{Point, RayDirection};
pub(crate) use super::problem::NOISE;
use super::ratio_test::TiedRow;
use super::variable::Variable;

/// A rate below this multiple of its natural size is confirmed from the data before it decides anything.
pub(crate) const SUSPICIOUS: f64 = 1e-7;
/// Relative error of the dictionary against the data above which it is built afresh.
const DRIFT: f64 = 1e-10;

/// A row that may block what grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    /// The variable whose row it is; for `hidden` the couple's visible one.
    pub(crate) variable: Local,
    pub(crate) hidden: bool,
    pub(crate) value: f64,
    /// Rate of decrease, > 0.
    pub(crate) fall: f64,
    /// Noise of the value.
    pub(crate) noise: f64,
}

/// Natural sizes of the load and of p, against which rounding is judged.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sizes {
    /// Of q, per primary row.
    pub(crate) q: Vec<f64>,
    /// Of d, per primary row.
    pub(crate) d: Vec<f64>,
    /// Of p for a response of size 1.
    pub(crate) p_per_force: f64,
    /// Of p itself.
    pub(crate) p: f64,
}

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct Stand {
    pub(crate) lcp: Arc<MirroredLcp>,
    pub(crate) dictionary: Dictionary,
    pub(crate) sizes: Sizes,
    /// Rates of the rows along the column fetched last.
    pub(crate) column: Vec<f64>,
    /// The dictionary is as built from the data.
    pub(crate) fresh: bool,
    /// How often it was built afresh.
    pub(crate) refreshes: usize,
}

impl Stand {
    pub(crate) fn new(lcp: Arc<MirroredLcp>, dictionary: Dictionary, sizes: Sizes) -> Stand {
        Stand {
            lcp,
            dictionary,
            sizes,
            column: Vec::new(),
            fresh: true,
            refreshes: 0,
        }
    }

    /// The variable of the whole LCP.
    pub(crate) fn variable(&self, local: Local, hidden: bool) -> Variable {
        let whole = |i: usize| match &self.lcp.mirrors[i] {
            Some(mirror) if self.dictionary.turned[i] != hidden => mirror.whole,
            _ => self.lcp.whole[i],
        };
        match local {
            Local::W(i) => Variable::W(whole(i)),
            Local::Z(i) => Variable::Z(whole(i)),
            Local::P => Variable::P,
        }
    }

    /// The name of a candidate.
    pub(crate) fn name(&self, candidate: &Candidate) -> Variable {
        self.variable(candidate.variable, candidate.hidden)
    }

    /// Column of a nonbasic variable.
    pub(crate) fn column_of(&self, local: Local) -> Option<usize> {
        match self.dictionary.place(local) {
            Place::Column(c) => Some(c),
            Place::Row(_) => None,
        }
    }

    /// Reads column c of the dictionary.
    pub(crate) fn fetch(&mut self, c: usize) {
        let mut column = std::mem::take(&mut self.column);
        self.dictionary.fetch_column(c, &mut column);
        self.column = column;
    }

    pub(crate) fn p(&self) -> f64 {
        self.dictionary.value_of(Local::P)
    }

    /// Σ column_k |z_k| over the basic z, with `values` per row.
    fn size_of(&self, values: &[f64]) -> f64 {
        self.dictionary
            .row
            .iter()
            .zip(values)
            .map(|(local, value)| match local {
                Local::Z(k) => self.lcp.scale.column[*k] * value.abs(),
                _ => 0.0,
            })
            .sum()
    }

    /// Σ column_k |Δz_k| along column c, the entering variable included.
    pub(crate) fn rate_total(&self, c: usize) -> f64 {
        let entering = match self.dictionary.column[c] {
            Local::Z(k) => self.lcp.scale.column[k],
            _ => 0.0,
        };
        self.size_of(&self.column) + entering
    }

    /// Natural size of the rate of a row, where Σ column_k |Δz_k| = `size` and Δp = `p_rate`.
    pub(crate) fn rate_size(&self, local: Local, size: f64, p_rate: f64) -> f64 {
        match local {
            Local::W(i) => self.lcp.scale.row[i] * size + self.sizes.d[i] * p_rate.abs(),
            Local::Z(k) => size / self.lcp.scale.column[k],
            Local::P => size * self.sizes.p_per_force,
        }
    }

    /// Natural size of the value of a row, where Σ column_k |z_k| = `size`.
    fn value_size(&self, local: Local, size: f64, p: f64) -> f64 {
        match local {
            Local::W(i) => {
                self.lcp.scale.row[i] * size + self.sizes.q[i] + self.sizes.d[i] * p.abs()
            }
            Local::Z(k) => size / self.lcp.scale.column[k],
            Local::P => self.sizes.p,
        }
    }

    /// Rows that fall when the variable of column c grows. `watch_slipping`: also the other reserve of a slipping
    /// couple where e ≤ 0 does not keep it ≥ 0 by construction; the textbook rules stumble over it.
    fn candidates(&self, c: usize, watch_slipping: bool) -> Vec<Candidate> {
        let d = &self.dictionary;
        let p = d.along(Local::P, c, &self.column);
        let size = self.rate_total(c);
        let value_size = self.size_of(&d.value);
        let mut candidates = Vec::new();
        let mut consider = |variable: Local, hidden: bool, value: f64, rate: f64, noise: f64| {
            candidates.push(Candidate {
                variable,
                hidden,
                value: value.max(0.0),
                fall: -rate,
                noise,
            });
        };
        for (r, (&local, &rate)) in d.row.iter().zip(&self.column).enumerate() {
            if rate < 0.0 && rate < -NOISE * self.rate_size(local, size, p.rate) {
                let noise = NOISE * self.value_size(local, value_size, p.value);
                consider(local, false, d.value[r], rate, noise);
            }
        }
        for (i, mirror) in self.lcp.mirrors.iter().enumerate() {
            let Some(mirror) = mirror else { continue };
            let visible = match d.place(Local::W(i)) {
                Place::Row(_) => true,
                Place::Column(j) => j == c,
            };
            if !visible && (mirror.covering > 0.0 || !watch_slipping) {
                continue;
            }
            let along = d.hidden(&self.lcp, i, c, &self.column);
            if along.rate >= 0.0 {
                continue;
            }
            // An open pair's x_n is an exact zero and no source of noise.
            let normal = mirror.normal.filter(|&n| match d.place(Local::W(n)) {
                Place::Row(_) => true,
                Place::Column(j) => j == c,
            });
            let sum = |of: &dyn Fn(Local) -> f64, p: f64| {
                let own = if visible { of(Local::W(i)) } else { 0.0 };
                let normal = normal.map_or(0.0, |n| of(Local::W(n)));
                own + 2.0 * mirror.friction * normal + (mirror.covering * p).abs()
            };
            let rate_size = sum(&|local| self.rate_size(local, size, p.rate), p.rate);
            if along.rate < -NOISE * rate_size {
                let value_size = sum(
                    &|local| self.value_size(local, value_size, p.value),
                    p.value,
                ) + mirror.constant.abs();
                consider(
                    Local::W(i),
                    true,
                    along.value,
                    along.rate,
                    NOISE * value_size,
                );
            }
        }
        candidates
    }

    /// The candidates at the smallest ratio, and that ratio.
    pub(crate) fn blocking(&self, c: usize, watch_slipping: bool) -> (Vec<Candidate>, f64) {
        let candidates = self.candidates(c, watch_slipping);
        let smallest = candidates
            .iter()
            .map(|row| row.value / row.fall)
            .fold(f64::INFINITY, f64::min);
        let tied = candidates
            .into_iter()
            .filter(|row| row.value - row.fall * smallest <= row.noise)
            .collect();
        (tied, smallest)
    }

    /// Whether the decision on column c hangs on a rate so near the noise that the data must confirm it, and they
    /// do not.
    pub(crate) fn is_suspicious(&self, c: usize, tied: &[Candidate]) -> bool {
        if self.fresh {
            return false;
        }
        let Some(blocking) = tied.iter().max_by(|a, b| a.fall.total_cmp(&b.fall)) else {
            return true;
        };
        let p_rate = self.dictionary.along(Local::P, c, &self.column).rate;
        let size = self.rate_size(blocking.variable, self.rate_total(c), p_rate);
        blocking.fall <= SUSPICIOUS * size && self.column_error(c) > DRIFT * blocking.fall / size
    }

    /// z of the primary rows with the sign of their orientation (z⁺ − z⁻ for couples).
    fn signed(&self, z: impl Fn(usize) -> f64) -> DVector<f64> {
        let turned = &self.dictionary.turned;
        DVector::from_fn(turned.len(), |i, _| if turned[i] { -z(i) } else { z(i) })
    }

    /// Largest error of column c against M Δz + d Δp over all rows, relative to their natural sizes.
    fn column_error(&self, c: usize) -> f64 {
        let d = &self.dictionary;
        let along = |local: Local| d.along(local, c, &self.column).rate;
        let z = self.signed(|i| along(Local::Z(i)));
        let p = along(Local::P);
        let size = self.rate_total(c);
        let response = &*self.lcp.matrix * z;
        (0..self.lcp.size())
            .map(|i| {
                let w = response[i] + self.lcp.covering[i] * p;
                let held = if d.turned[i] {
                    d.hidden(&self.lcp, i, c, &self.column).rate
                } else {
                    along(Local::W(i))
                };
                let own = self.rate_size(Local::W(i), size, p).max(f64::MIN_POSITIVE);
                (w - held).abs() / own
            })
            .fold(0.0, f64::max)
    }

    /// Largest error of the dictionary's values against w = M z + q + d p, relative to their natural sizes.
    fn drift(&self) -> f64 {
        let d = &self.dictionary;
        let z = self.signed(|i| d.value_of(Local::Z(i)));
        let p = self.p();
        let size = self.size_of(&d.value);
        let response = &*self.lcp.matrix * z;
        (0..self.lcp.size())
            .map(|i| {
                let w = response[i] + self.lcp.q[i] + self.lcp.covering[i] * p;
                let held = if d.turned[i] {
                    d.hidden_value(&self.lcp, i)
                } else {
                    d.value_of(Local::W(i))
                };
                (w - held).abs() / self.value_size(Local::W(i), size, p).max(f64::MIN_POSITIVE)
            })
            .fold(0.0, f64::max)
    }

    /// Whether the dictionary's values still agree with the data.
    pub(crate) fn agrees(&self) -> bool {
        self.drift() <= DRIFT
    }

    /// Builds the dictionary afresh from the data; `false` where the equations of the scheme are singular.
    pub(crate) fn refresh(&mut self) -> bool {
        if self.dictionary.rebuild(&self.lcp) {
            self.fresh = true;
            self.refreshes += 1;
        }
        self.fresh
    }

    /// At a flush, where that costs little: the values are compared with the data. `false`: they are wrong and the
    /// equations are singular.
    pub(crate) fn keep_true(&mut self) -> bool {
        self.fresh || self.dictionary.pending() > 0 || self.agrees() || self.refresh()
    }

    /// Exchanges the variable of column c with that of the leaving row; the entering variable takes the value `step`.
    /// Returns what grows next: the complement of what left (`None` after p).
    pub(crate) fn exchange(
        &mut self,
        leaving: &Candidate,
        c: usize,
        step: f64,
        tied: &[Candidate],
    ) -> Option<Local> {
        let mut column = std::mem::take(&mut self.column);
        let d = &mut self.dictionary;
        match (leaving.variable, leaving.hidden, d.place(leaving.variable)) {
            (Local::W(i), true, Place::Row(r)) => {
                d.turn(&self.lcp, i);
                d.fetch_column(c, &mut column);
                d.pivot(r, c, &column, step);
            }
            (Local::W(i), true, Place::Column(_)) => {
                d.pivot_hidden(&self.lcp, i, c, &column, step);
            }
            (_, _, Place::Row(r)) => d.pivot(r, c, &column, step),
            (_, _, Place::Column(_)) => debug_assert!(false, "a blocking row is basic"),
        }
        // What was tied with the leaving row is zero now, not noise.
        for tie in tied {
            if !tie.hidden
                && tie.variable != leaving.variable
                && let Place::Row(r) = d.place(tie.variable)
            {
                d.value[r] = 0.0;
            }
        }
        self.column = column;
        self.fresh = false;
        match leaving.variable {
            Local::W(i) => Some(Local::Z(i)),
            Local::Z(i) => Some(Local::W(i)),
            Local::P => None,
        }
    }

    /// All variables at the vertex, as the dictionary holds them.
    pub(crate) fn point(&self) -> Point {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let n = lcp.whole_size;
        let mut point = Point {
            z: vec![0.0; n],
            w: vec![0.0; n],
            p: 0.0,
        };
        for (&local, &value) in d.row.iter().zip(&d.value) {
            match self.variable(local, false) {
                Variable::W(k) => point.w[k] = value,
                Variable::Z(k) => point.z[k] = value,
                Variable::P => point.p = value,
            }
        }
        for i in 0..lcp.size() {
            if lcp.mirrors[i].is_some()
                && let Variable::W(k) = self.variable(Local::W(i), true)
            {
                point.w[k] = d.hidden_value(lcp, i);
            }
        }
        point
    }

    /// The direction of column c: rates that did not block are ≥ 0 up to noise.
    pub(crate) fn ray(&self, c: usize) -> RayDirection {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let entering = self.variable(d.column[c], false);
        let n = lcp.whole_size;
        let mut ray = RayDirection {
            entering,
            z: vec![0.0; n],
            w: vec![0.0; n],
            p: 0.0,
        };
        let size = self.rate_total(c);
        let p_rate = d.along(Local::P, c, &self.column).rate;
        let mut put = |variable: Variable, rate: f64, noise: f64| {
            let rate = if rate.abs() <= noise { 0.0 } else { rate };
            match variable {
                Variable::W(k) => ray.w[k] = rate,
                Variable::Z(k) => ray.z[k] = rate,
                Variable::P => ray.p = rate,
            }
        };
        put(entering, 1.0, 0.0);
        for (&local, &rate) in d.row.iter().zip(&self.column) {
            put(
                self.variable(local, false),
                rate,
                NOISE * self.rate_size(local, size, p_rate),
            );
        }
        for i in 0..lcp.size() {
            if lcp.mirrors[i].is_some() {
                put(
                    self.variable(Local::W(i), true),
                    d.hidden(lcp, i, c, &self.column).rate,
                    4.0 * NOISE * self.rate_size(Local::W(i), size, p_rate),
                );
            }
        }
        ray
    }

    /// The rows of B⁻¹ of tied candidates, for the lexicographic rule.
    pub(crate) fn inverse_rows<'a>(
        &'a self,
        tied: &'a [Candidate],
        table_row: &'a dyn Fn(Variable) -> usize,
    ) -> Vec<InverseRow<'a>> {
        tied.iter()
            .map(|candidate| InverseRow {
                stand: self,
                candidate,
                table_row,
            })
            .collect()
    }

    /// Column of the nonbasic w that stands in row `whole` of the whole LCP.
    fn nonbasic_w(&self, whole: usize) -> Option<usize> {
        self.dictionary.column.iter().position(|&local| {
            matches!(local, Local::W(_)) && self.variable(local, false) == Variable::W(whole)
        })
    }

    /// Natural size of the entry of the row of B⁻¹ of `local` in the column of primary row `j`.
    fn inverse_size(&self, local: Local, j: usize) -> f64 {
        let scale = &self.lcp.scale;
        let column = scale.row[j].max(f64::MIN_POSITIVE);
        match local {
            Local::W(i) => scale.row[i] / column,
            Local::Z(k) => 1.0 / (scale.column[k] * column),
            Local::P => self.sizes.p_per_force / column,
        }
    }
}

/// The row of B⁻¹ of a tied candidate: what an ε added to a w does to its value.
pub(crate) struct InverseRow<'a> {
    stand: &'a Stand,
    candidate: &'a Candidate,
    table_row: &'a dyn Fn(Variable) -> usize,
}

impl TiedRow for InverseRow<'_> {
    fn table_row(&self) -> usize {
        (self.table_row)(self.stand.name(self.candidate))
    }

    fn entry(&self, row: usize) -> (f64, f64) {
        let stand = self.stand;
        let d = &stand.dictionary;
        let column = stand.nonbasic_w(row);
        let is = |local: Local| f64::from(stand.variable(local, false) == Variable::W(row));
        let visible = |local: Local| match d.place(local) {
            Place::Row(_) if is(local) == 1.0 => 1.0,
            // A nonbasic w stands in its column with the opposite sign of its ε.
            Place::Row(r) => column.map_or(0.0, |c| -d.entry(r, c)),
            Place::Column(_) => 0.0,
        };
        let natural = |local: Local| match column.map(|c| d.column[c]) {
            Some(Local::W(j) | Local::Z(j)) => stand.inverse_size(local, j),
            _ => 0.0,
        };
        let candidate = self.candidate;
        let mut size = natural(candidate.variable) + 1.0;
        let mut entry = visible(candidate.variable);
        if candidate.hidden
            && let Local::W(i) = candidate.variable
            && let Some(mirror) = &stand.lcp.mirrors[i]
        {
            let own = f64::from(stand.variable(Local::W(i), true) == Variable::W(row));
            entry = own + is(Local::W(i)) - entry + mirror.covering * visible(Local::P);
            if let Some(n) = mirror.normal {
                let double = 2.0 * mirror.friction;
                entry += double * (visible(Local::W(n)) - is(Local::W(n)));
                size += double * (1.0 + natural(Local::W(n)));
            }
        }
        (entry / candidate.fall, size / candidate.fall)
    }
}
