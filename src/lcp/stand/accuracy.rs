//! The watch over errors: the numbers of a stand against the data, their refinement, the dictionary built afresh.

use super::super::dictionary::{Local, Place};
use super::{Candidate, SUSPICIOUS, Stand};

/// Relative error of the dictionary against the data above which it is built afresh.
const DRIFT: f64 = 1e-10;

/// Relative error of a column against the data that building it afresh would not make smaller.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// A column is refined, and the dictionary not built afresh, up to this error relative to the small rate at stake.
const REFINED: f64 = 1e-5;

impl Stand {
    /// The largest rate of decrease of the tied rows along column c, relative to its natural size; 0 where none is tied.
    fn relative_fall(&self, c: usize, tied: &[Candidate]) -> f64 {
        let p_rate = self.dictionary.rate(Local::P, c, &self.column);
        tied.iter()
            .max_by(|a, b| a.fall.total_cmp(&b.fall))
            .map_or(0.0, |blocking| {
                blocking.fall / self.rate_size(blocking.variable, self.rate_total(c), p_rate)
            })
    }

    /// Whether the decision on column c hangs on a rate so near the noise that the data must confirm it: a small residual
    /// of the column does not show that a small rate in it is right.
    pub(crate) fn is_suspicious(&self, c: usize, tied: &[Candidate]) -> bool {
        !self.fresh && self.relative_fall(c, tied) <= SUSPICIOUS
    }

    /// z of the primary rows with the sign of their orientation (z⁺ − z⁻ for couples).
    fn signed(&self, z: impl Fn(usize) -> f64) -> Vec<f64> {
        let turned = self.dictionary.turned.iter().enumerate();
        turned
            .map(|(i, &turned)| if turned { -z(i) } else { z(i) })
            .collect()
    }

    /// Largest error of column c against M Δz + d Δp over all rows, relative to their natural sizes.
    fn column_error(&self, c: usize) -> f64 {
        let d = &self.dictionary;
        let along = |local: Local| d.along(local, c, &self.column).rate;
        let z = self.signed(|i| along(Local::Z(i)));
        let p = along(Local::P);
        let size = self.rate_total(c);
        let response = self.lcp.matrix.times(&z);
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
            .fold(0.0, larger)
    }

    /// Largest error of the dictionary's values against w = M z + q + d p, relative to their natural sizes.
    fn drift(&self) -> f64 {
        let d = &self.dictionary;
        let z = self.signed(|i| d.value_of(Local::Z(i)));
        let p = self.p();
        let size = self.size_of(&d.value);
        let response = self.lcp.matrix.times(&z);
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
            .fold(0.0, larger)
    }

    /// By how much rounding may move a value, relative to the largest load: where the responses of single
    /// displacements are much larger than the load and cancel.
    pub(crate) fn blur(&self) -> f64 {
        let row = self.lcp.scale.row.iter().fold(0.0, |a: f64, b| a.max(*b));
        let load = self.lcp.q.amax().max(f64::MIN_POSITIVE);
        ROUNDING * row * self.size_of(&self.dictionary.value) / load
    }

    /// One step of iterative refinement: the equations of the scheme evaluated from the data, solved by the dictionary.
    /// `held`: a number for each row, values (`shift` 1, no `entering`) or rates along the column `entering` (`shift`
    /// 0).
    fn corrected(&self, held: &[f64], entering: Option<usize>, shift: f64) -> Vec<f64> {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let nonbasic = |c: usize| f64::from(entering == Some(c));
        let number = |local: Local| match d.place(local) {
            Place::Row(r) => held[r],
            Place::Column(c) => nonbasic(c),
        };
        let p = number(Local::P);
        let w = lcp.matrix.times(&self.signed(|i| number(Local::Z(i))));
        let w = w + shift * &lcp.q + p * &lcp.covering;
        let oriented = |i: usize| match &lcp.mirrors[i] {
            Some(mirror) if d.turned[i] => {
                let normal = mirror.normal.map_or(0.0, |n| w[n]);
                let sum = 2.0 * mirror.friction * normal + mirror.covering * p;
                sum + shift * mirror.constant - w[i]
            }
            _ => w[i],
        };
        let wrong: Vec<(usize, f64)> = d
            .column
            .iter()
            .enumerate()
            .filter_map(|(c, &local)| match local {
                Local::W(i) => Some((c, nonbasic(c) - oriented(i))),
                _ => None,
            })
            .collect();
        let change = d.combined_columns(&wrong);
        std::iter::zip(&d.row, std::iter::zip(held, change))
            .map(|(&local, (held, change))| match local {
                Local::W(i) => oriented(i) + change,
                _ => held + change,
            })
            .collect()
    }

    /// Refines the values.
    pub(crate) fn refine(&mut self) {
        self.dictionary.value = self.corrected(&self.dictionary.value, None, 1.0);
    }

    /// Makes the column fetched last, on whose small rate in the `tied` rows a decision hangs, as true to the data as it
    /// can be made: by refinement, or where the dictionary is too far off, its row as well, by building it afresh.
    /// `false` (and nothing changed): the equations of the scheme are singular.
    pub(crate) fn confirm(&mut self, c: usize, tied: &[Candidate]) -> bool {
        let fall = self.relative_fall(c, tied);
        let error = self.column_error(c);
        if error > REFINED * fall {
            if !self.refresh() {
                return false;
            }
            self.fetch(c);
        }
        self.refine_column(c);
        true
    }

    /// Refines the column fetched last.
    pub(crate) fn refine_column(&mut self, c: usize) {
        self.column = self.corrected(&self.column, Some(c), 0.0);
        self.column_size = self.size_of(&self.column);
    }

    /// Whether the dictionary's values still agree with the data.
    fn agrees(&self) -> bool {
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

    /// After each flush the values are compared with the data. `false`: they are wrong and the equations are singular.
    pub(crate) fn keep_true(&mut self) -> bool {
        let flushes = self.dictionary.flushes();
        if std::mem::replace(&mut self.compared, flushes) == flushes {
            return true;
        }
        self.fresh || self.agrees() || self.refresh()
    }
}

/// The larger one; NaN if one of them is.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}
