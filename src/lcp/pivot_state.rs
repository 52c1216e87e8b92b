//! Where a run stands: the LCP, its dictionary, and the column of what grows. What Lemke's algorithm and the path
//! in a load have in common: natural sizes, zero tests, the ratio test with its ties, the watch over errors.

mod accuracy;
mod inverse_row;

use std::sync::Arc;

use crate::lcp::dictionary::{Dictionary, Place, Slot};
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Point, RayDirection};
pub(crate) use crate::lcp::problem::NOISE;
use crate::lcp::variable::Variable;

/// A rate below this multiple of its natural size is confirmed from the data before it decides anything.
pub(crate) const SUSPICIOUS: f64 = 1e-7;
/// A row that may block what grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    /// The variable whose row it is; for `hidden` the couple's visible one.
    pub(crate) variable: Slot,
    pub(crate) mirror_row: bool,
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

impl Sizes {
    /// Natural size of the response of a variable where Σ column_k |Δz_k| = 1.
    fn response(&self, local: Slot, lcp: &MirroredLcp) -> f64 {
        match local {
            Slot::W(i) => lcp.scale.row[i],
            Slot::Z(k) => 1.0 / lcp.scale.column[k],
            Slot::P => self.p_per_force,
        }
    }
}

/// Natural sizes of the variables that the rows hold, side by side for the ratio test.
#[derive(Clone, Debug, Default)]
struct RowSizes {
    /// Of the response where Σ column_k |Δz_k| = 1.
    response: Vec<f64>,
    /// Of the response to Δp = 1 alone.
    covering: Vec<f64>,
    /// What a displacement in the row counts for; 0 for forces.
    displacement: Vec<f64>,
}

/// See the module.
#[derive(Clone, Debug)]
pub(crate) struct PivotState {
    pub(crate) lcp: Arc<MirroredLcp>,
    pub(crate) dictionary: Dictionary,
    pub(crate) sizes: Sizes,
    row_sizes: RowSizes,
    /// Primary row of each row of the whole LCP, and whether it is the mirror of that.
    primary: Vec<(usize, bool)>,
    /// Rates of the rows along the column fetched last.
    pub(crate) column: Vec<f64>,
    /// Σ column_k |Δz_k| over the basic z along it.
    column_size: f64,
    /// Room for the ratios of all rows.
    ratios: Vec<f64>,
    /// The dictionary is as built from the data.
    pub(crate) fresh: bool,
    /// How often it was built afresh.
    pub(crate) refreshes: usize,
    /// Number of the batch of steps after which the values were last compared with the data.
    compared: usize,
}

impl PivotState {
    pub(crate) fn new(lcp: Arc<MirroredLcp>, dictionary: Dictionary, sizes: Sizes) -> PivotState {
        let mut state = PivotState {
            primary: lcp.primary_rows(),
            lcp,
            dictionary,
            sizes,
            row_sizes: RowSizes::default(),
            column: Vec::new(),
            column_size: 0.0,
            ratios: Vec::new(),
            fresh: true,
            refreshes: 0,
            compared: 0,
        };
        state.measure_rows();
        state
    }

    /// Takes another load.
    pub(crate) fn reload(&mut self, lcp: Arc<MirroredLcp>, sizes: Sizes) {
        self.lcp = lcp;
        self.sizes = sizes;
        self.measure_rows();
    }

    fn measure_rows(&mut self) {
        let size = self.dictionary.row.len();
        self.row_sizes =
            RowSizes { response: vec![0.0; size], covering: vec![0.0; size], displacement: vec![0.0; size] };
        for r in 0..size {
            self.measure_row(r);
        }
    }

    /// Notes the natural sizes of the variable that row r holds now.
    fn measure_row(&mut self, r: usize) {
        let (local, scale) = (self.dictionary.row[r], &self.lcp.scale);
        let sizes = &mut self.row_sizes;
        sizes.response[r] = self.sizes.response(local, &self.lcp);
        (sizes.covering[r], sizes.displacement[r]) = match local {
            Slot::W(i) => (self.sizes.d[i], 0.0),
            Slot::Z(k) => (0.0, scale.column[k]),
            Slot::P => (0.0, 0.0),
        };
    }

    /// The variable of column c takes the place of that of row r.
    pub(crate) fn pivot(&mut self, r: usize, c: usize, step: f64) {
        self.dictionary.pivot(r, c, &self.column, step);
        self.measure_row(r);
    }

    /// The variable of the whole LCP.
    pub(crate) fn variable(&self, local: Slot, mirror_row: bool) -> Variable {
        let whole = |i: usize| match &self.lcp.mirrors[i] {
            Some(mirror) if self.dictionary.turned[i] != mirror_row => mirror.whole,
            _ => self.lcp.whole[i],
        };
        match local {
            Slot::W(i) => Variable::W(whole(i)),
            Slot::Z(i) => Variable::Z(whole(i)),
            Slot::P => Variable::P,
        }
    }

    /// The name of a candidate.
    pub(crate) fn name(&self, candidate: &Candidate) -> Variable {
        self.variable(candidate.variable, candidate.mirror_row)
    }

    /// Column of a nonbasic variable.
    pub(crate) fn column_of(&self, local: Slot) -> Option<usize> {
        match self.dictionary.place(local) {
            Place::Column(c) => Some(c),
            Place::Row(_) => None,
        }
    }

    /// Reads column c of the dictionary.
    pub(crate) fn fetch(&mut self, c: usize) {
        let mut column = std::mem::take(&mut self.column);
        self.dictionary.fetch_column(c, &mut column);
        self.set_column(column);
    }

    fn set_column(&mut self, column: Vec<f64>) {
        self.column_size = self.size_of(&column);
        self.column = column;
    }

    pub(crate) fn p(&self) -> f64 {
        self.dictionary.value_of(Slot::P)
    }

    /// Σ column_k |z_k| over the basic z, with `values` per row.
    fn size_of(&self, values: &[f64]) -> f64 {
        let scales = self.row_sizes.displacement.iter();
        scales.zip(values).map(|(scale, value)| scale * value.abs()).sum()
    }

    /// Σ column_k |Δz_k| along column c, which was fetched last, the entering variable included.
    pub(crate) fn rate_total(&self, c: usize) -> f64 {
        let entering = match self.dictionary.column[c] {
            Slot::Z(k) => self.lcp.scale.column[k],
            _ => 0.0,
        };
        self.column_size + entering
    }

    /// Natural size of the rate of a row, where Σ column_k |Δz_k| = `size` and Δp = `p_rate`.
    pub(crate) fn rate_size(&self, local: Slot, size: f64, p_rate: f64) -> f64 {
        let response = size * self.sizes.response(local, &self.lcp);
        match local {
            Slot::W(i) => response + self.sizes.d[i] * p_rate.abs(),
            Slot::Z(_) | Slot::P => response,
        }
    }

    /// |Δp| along column c, against which the noise of the rows is judged. Where Δp is noise itself, no part of what it
    /// gives to a row counts: otherwise a row that only p moves would seem to fall.
    fn p_rate_size(&self, c: usize) -> f64 {
        let rate = self.dictionary.rate(Slot::P, c, &self.column).abs();
        if rate <= NOISE * self.rate_size(Slot::P, self.rate_total(c), 0.0) { rate / NOISE } else { rate }
    }

    /// Natural size of the value of a row, where Σ column_k |z_k| = `size`.
    fn value_size(&self, local: Slot, size: f64, p: f64) -> f64 {
        let response = size * self.sizes.response(local, &self.lcp);
        match local {
            Slot::W(i) => response + self.sizes.q[i] + self.sizes.d[i] * p.abs(),
            Slot::Z(_) => response,
            Slot::P => self.sizes.p,
        }
    }

    /// The candidates at the smallest ratio, and that ratio: rows that fall when the variable of column c grows.
    /// `to_zero`: p is to fall to zero and blocks there, and so does the other reserve of a slipping couple whose e ≤
    /// 0, for then nothing keeps it ≥ 0 by construction; the textbook rules stumble over it.
    pub(crate) fn blocking(&mut self, c: usize, to_zero: bool) -> (Vec<Candidate>, f64) {
        let mut ratios = std::mem::take(&mut self.ratios);
        self.ratios_of_rows(c, &mut ratios);
        if let Place::Row(r) = self.dictionary.place(Slot::P)
            && !to_zero
        {
            ratios[r] = f64::INFINITY;
        }
        let mut smallest = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let mut tied = self.falling_mirrors(c, to_zero);
        for mirror in &tied {
            smallest = smallest.min(mirror.value / mirror.fall);
        }
        tied.retain(|mirror| mirror.value - mirror.fall * smallest <= mirror.noise);
        let d = &self.dictionary;
        let (p, value_size) = (self.p(), self.size_of(&d.value));
        let mut rows = Vec::new();
        for (r, _) in ratios.iter().enumerate().filter(|row| row.1.is_finite()) {
            let (variable, value, fall) = (d.row[r], d.value[r].max(0.0), -self.column[r]);
            let noise = NOISE * self.value_size(variable, value_size, p);
            if value - fall * smallest <= noise {
                rows.push(Candidate { variable, mirror_row: false, value, fall, noise });
            }
        }
        rows.append(&mut tied);
        self.ratios = ratios;
        (rows, smallest)
    }

    /// For each row, how far the variable of column c can grow before the row is at zero, infinite where it does not
    /// fall.
    fn ratios_of_rows(&self, c: usize, ratios: &mut Vec<f64>) {
        let d = &self.dictionary;
        let (size, sizes) = (NOISE * self.rate_total(c), &self.row_sizes);
        let p_rate = NOISE * self.p_rate_size(c);
        ratios.clear();
        ratios.extend(self.column.iter().zip(&d.value).zip(sizes.response.iter().zip(&sizes.covering)).map(
            |((rate, value), (response, covering))| {
                let noise = response * size + covering * p_rate;
                if *rate < -noise { value.max(0.0) / -rate } else { f64::INFINITY }
            },
        ));
    }

    /// The hidden members that fall when the variable of column c grows.
    fn falling_mirrors(&self, c: usize, watch_slipping: bool) -> Vec<Candidate> {
        let d = &self.dictionary;
        let (p, p_rate) = (self.p(), self.p_rate_size(c));
        let (size, value_size) = (self.rate_total(c), self.size_of(&d.value));
        let mut falling = Vec::new();
        for (i, mirror) in self.lcp.mirrors.iter().enumerate() {
            let Some(mirror) = mirror else { continue };
            let is_visible = |place: Place| match place {
                Place::Row(_) => true,
                Place::Column(j) => j == c,
            };
            let visible = is_visible(d.place(Slot::W(i)));
            if !visible && (mirror.covering > 0.0 || !watch_slipping) {
                continue;
            }
            let rate = d.hidden_rate(&self.lcp, i, c, &self.column);
            if rate >= 0.0 {
                continue;
            }
            // An open pair's x_n is an exact zero and no source of noise.
            let normal = mirror.normal.filter(|&n| is_visible(d.place(Slot::W(n))));
            let sum = |of: &dyn Fn(Slot) -> f64, p: f64| {
                let own = if visible { of(Slot::W(i)) } else { 0.0 };
                let normal = normal.map_or(0.0, |n| of(Slot::W(n)));
                own + 2.0 * mirror.friction * normal + (mirror.covering * p).abs()
            };
            let rate_size = sum(&|local| self.rate_size(local, size, p_rate), p_rate);
            if rate < -NOISE * rate_size {
                let natural = |local: Slot| self.value_size(local, value_size, p);
                let noise = NOISE * (sum(&natural, p) + mirror.constant.abs());
                falling.push(Candidate {
                    variable: Slot::W(i),
                    mirror_row: true,
                    value: d.hidden_value(&self.lcp, i).max(0.0),
                    fall: -rate,
                    noise,
                });
            }
        }
        falling
    }

    /// Exchanges the variable of column c with that of the leaving row; the entering variable takes the value `step`.
    /// Returns what grows next: the complement of what left (`None` after p).
    pub(crate) fn exchange(&mut self, leaving: &Candidate, c: usize, step: f64, tied: &[Candidate]) -> Option<Slot> {
        match (leaving.variable, leaving.mirror_row, self.dictionary.place(leaving.variable)) {
            (Slot::W(i), true, Place::Row(r)) => {
                // Turning changes row r and the column of z_i, which is not the entering one.
                let rate = self.dictionary.hidden_rate(&self.lcp, i, c, &self.column);
                self.dictionary.turn(&self.lcp, i);
                self.column[r] = rate;
                self.pivot(r, c, step);
            }
            (Slot::W(i), true, Place::Column(_)) => {
                self.dictionary.pivot_hidden(&self.lcp, i, c, &self.column, step);
            }
            (_, _, Place::Row(r)) => self.pivot(r, c, step),
            (_, _, Place::Column(_)) => debug_assert!(false, "a blocking row is basic"),
        }
        let d = &mut self.dictionary;
        // What was tied with the leaving row is zero now, not noise.
        for tie in tied {
            if !tie.mirror_row
                && tie.variable != leaving.variable
                && let Place::Row(r) = d.place(tie.variable)
            {
                d.value[r] = 0.0;
            }
        }
        self.fresh = false;
        match leaving.variable {
            Slot::W(i) => Some(Slot::Z(i)),
            Slot::Z(i) => Some(Slot::W(i)),
            Slot::P => None,
        }
    }

    /// All variables at the vertex, as the dictionary holds them.
    pub(crate) fn point(&self) -> Point {
        self.point_of(&self.dictionary.value)
    }

    /// All variables where the basic ones have the given values, row by row.
    fn point_of(&self, values: &[f64]) -> Point {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let n = lcp.full_size;
        let mut point = Point { z: vec![0.0; n], w: vec![0.0; n], p: 0.0 };
        for (&local, &value) in d.row.iter().zip(values) {
            match self.variable(local, false) {
                Variable::W(k) => point.w[k] = value,
                Variable::Z(k) => point.z[k] = value,
                Variable::P => point.p = value,
            }
        }
        let w = |row: usize| match d.place(Slot::W(row)) {
            Place::Row(r) => values[r],
            Place::Column(_) => 0.0,
        };
        for (i, mirror) in lcp.mirrors.iter().enumerate() {
            if let (Some(mirror), Variable::W(k)) = (mirror, self.variable(Slot::W(i), true)) {
                // Of a couple turned round the dictionary holds the other member.
                point.w[k] = mirror.reflect(i, w, point.p, 1.0);
            }
        }
        point
    }

    /// The direction of column c: rates that did not block are ≥ 0 up to noise.
    pub(crate) fn ray(&self, c: usize) -> RayDirection {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let entering = self.variable(d.column[c], false);
        let n = lcp.full_size;
        let mut ray = RayDirection { entering, z: vec![0.0; n], w: vec![0.0; n], p: 0.0 };
        let size = self.rate_total(c);
        let p_rate = self.p_rate_size(c);
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
            put(self.variable(local, false), rate, NOISE * self.rate_size(local, size, p_rate));
        }
        for i in 0..lcp.size() {
            if lcp.mirrors[i].is_some() {
                put(
                    self.variable(Slot::W(i), true),
                    d.hidden_rate(lcp, i, c, &self.column),
                    4.0 * NOISE * self.rate_size(Slot::W(i), size, p_rate),
                );
            }
        }
        ray
    }
}
