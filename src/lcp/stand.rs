//! Where a run stands: the LCP, its dictionary, and the column of what grows. What Lemke's algorithm and the path
//! in a load have in common: natural sizes, zero tests, the ratio test with its ties, the watch over errors.

use std::sync::Arc;

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

/// Relative error of a column against the data that building it afresh would not make smaller.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

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

impl Sizes {
    /// Natural size of the response of a variable where Σ column_k |Δz_k| = 1.
    fn response(&self, local: Local, lcp: &MirroredLcp) -> f64 {
        match local {
            Local::W(i) => lcp.scale.row[i],
            Local::Z(k) => 1.0 / lcp.scale.column[k],
            Local::P => self.p_per_force,
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
pub(crate) struct Stand {
    pub(crate) lcp: Arc<MirroredLcp>,
    pub(crate) dictionary: Dictionary,
    pub(crate) sizes: Sizes,
    row_sizes: RowSizes,
    /// Primary row of each row of the whole LCP.
    primary: Vec<usize>,
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
}

impl Stand {
    pub(crate) fn new(lcp: Arc<MirroredLcp>, dictionary: Dictionary, sizes: Sizes) -> Stand {
        let mut primary = vec![0; lcp.whole_size];
        for (i, mirror) in lcp.mirrors.iter().enumerate() {
            primary[lcp.whole[i]] = i;
            if let Some(mirror) = mirror {
                primary[mirror.whole] = i;
            }
        }
        let mut stand = Stand {
            lcp,
            dictionary,
            sizes,
            row_sizes: RowSizes::default(),
            primary,
            column: Vec::new(),
            column_size: 0.0,
            ratios: Vec::new(),
            fresh: true,
            refreshes: 0,
        };
        stand.measure_rows();
        stand
    }

    /// Takes another load.
    pub(crate) fn reload(&mut self, lcp: Arc<MirroredLcp>, sizes: Sizes) {
        self.lcp = lcp;
        self.sizes = sizes;
        self.measure_rows();
    }

    fn measure_rows(&mut self) {
        let size = self.dictionary.row.len();
        self.row_sizes = RowSizes {
            response: vec![0.0; size],
            covering: vec![0.0; size],
            displacement: vec![0.0; size],
        };
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
            Local::W(i) => (self.sizes.d[i], 0.0),
            Local::Z(k) => (0.0, scale.column[k]),
            Local::P => (0.0, 0.0),
        };
    }

    /// The variable of column c takes the place of that of row r.
    pub(crate) fn pivot(&mut self, r: usize, c: usize, step: f64) {
        self.dictionary.pivot(r, c, &self.column, step);
        self.measure_row(r);
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
        self.column_size = self.size_of(&column);
        self.column = column;
    }

    pub(crate) fn p(&self) -> f64 {
        self.dictionary.value_of(Local::P)
    }

    /// Σ column_k |z_k| over the basic z, with `values` per row.
    fn size_of(&self, values: &[f64]) -> f64 {
        let scales = self.row_sizes.displacement.iter();
        scales
            .zip(values)
            .map(|(scale, value)| scale * value.abs())
            .sum()
    }

    /// Σ column_k |Δz_k| along column c, which was fetched last, the entering variable included.
    pub(crate) fn rate_total(&self, c: usize) -> f64 {
        let entering = match self.dictionary.column[c] {
            Local::Z(k) => self.lcp.scale.column[k],
            _ => 0.0,
        };
        self.column_size + entering
    }

    /// Natural size of the rate of a row, where Σ column_k |Δz_k| = `size` and Δp = `p_rate`.
    pub(crate) fn rate_size(&self, local: Local, size: f64, p_rate: f64) -> f64 {
        let response = size * self.sizes.response(local, &self.lcp);
        match local {
            Local::W(i) => response + self.sizes.d[i] * p_rate.abs(),
            Local::Z(_) | Local::P => response,
        }
    }

    /// Natural size of the value of a row, where Σ column_k |z_k| = `size`.
    fn value_size(&self, local: Local, size: f64, p: f64) -> f64 {
        let response = size * self.sizes.response(local, &self.lcp);
        match local {
            Local::W(i) => response + self.sizes.q[i] + self.sizes.d[i] * p.abs(),
            Local::Z(_) => response,
            Local::P => self.sizes.p,
        }
    }

    /// The candidates at the smallest ratio, and that ratio: rows that fall when the variable of column c grows.
    /// `watch_slipping`: also the other reserve of a slipping couple where e ≤ 0 does not keep it ≥ 0 by
    /// construction; the textbook rules stumble over it.
    pub(crate) fn blocking(&mut self, c: usize, watch_slipping: bool) -> (Vec<Candidate>, f64) {
        let mut ratios = std::mem::take(&mut self.ratios);
        let mut smallest = self.ratios_of_rows(c, &mut ratios);
        let mut tied = self.falling_mirrors(c, watch_slipping);
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
                rows.push(Candidate {
                    variable,
                    hidden: false,
                    value,
                    fall,
                    noise,
                });
            }
        }
        rows.append(&mut tied);
        self.ratios = ratios;
        (rows, smallest)
    }

    /// Of each row: how far the variable of column c can grow before the row is at zero, infinite where it does not
    /// fall. Returns the smallest.
    fn ratios_of_rows(&self, c: usize, ratios: &mut Vec<f64>) -> f64 {
        let d = &self.dictionary;
        let p_rate = d.along(Local::P, c, &self.column).rate.abs();
        let (size, sizes) = (NOISE * self.rate_total(c), &self.row_sizes);
        let p_rate = NOISE * p_rate;
        ratios.clear();
        ratios.extend(
            self.column
                .iter()
                .zip(&d.value)
                .zip(sizes.response.iter().zip(&sizes.covering))
                .map(|((rate, value), (response, covering))| {
                    let noise = response * size + covering * p_rate;
                    if *rate < -noise {
                        value.max(0.0) / -rate
                    } else {
                        f64::INFINITY
                    }
                }),
        );
        ratios.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The hidden members that fall when the variable of column c grows.
    fn falling_mirrors(&self, c: usize, watch_slipping: bool) -> Vec<Candidate> {
        let d = &self.dictionary;
        let p = d.along(Local::P, c, &self.column);
        let (size, value_size) = (self.rate_total(c), self.size_of(&d.value));
        let mut falling = Vec::new();
        for (i, mirror) in self.lcp.mirrors.iter().enumerate() {
            let Some(mirror) = mirror else { continue };
            let is_visible = |place: Place| match place {
                Place::Row(_) => true,
                Place::Column(j) => j == c,
            };
            let visible = is_visible(d.place(Local::W(i)));
            if !visible && (mirror.covering > 0.0 || !watch_slipping) {
                continue;
            }
            let rate = |local: Local| d.rate(local, c, &self.column);
            let normal_rate = mirror.normal.map_or(0.0, |n| rate(Local::W(n)));
            let own = rate(Local::W(i));
            if 2.0 * mirror.friction * normal_rate + mirror.covering * p.rate - own >= 0.0 {
                continue;
            }
            let along = d.hidden(&self.lcp, i, c, &self.column);
            // An open pair's x_n is an exact zero and no source of noise.
            let normal = mirror.normal.filter(|&n| is_visible(d.place(Local::W(n))));
            let sum = |of: &dyn Fn(Local) -> f64, p: f64| {
                let own = if visible { of(Local::W(i)) } else { 0.0 };
                let normal = normal.map_or(0.0, |n| of(Local::W(n)));
                own + 2.0 * mirror.friction * normal + (mirror.covering * p).abs()
            };
            let rate_size = sum(&|local| self.rate_size(local, size, p.rate), p.rate);
            if along.rate < -NOISE * rate_size {
                let natural = |local: Local| self.value_size(local, value_size, p.value);
                let noise = NOISE * (sum(&natural, p.value) + mirror.constant.abs());
                falling.push(Candidate {
                    variable: Local::W(i),
                    hidden: true,
                    value: along.value.max(0.0),
                    fall: -along.rate,
                    noise,
                });
            }
        }
        falling
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
        let bearable = (DRIFT * blocking.fall / size).max(ROUNDING);
        blocking.fall <= SUSPICIOUS * size && self.column_error(c) > bearable
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
            .fold(0.0, f64::max)
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
            .fold(0.0, f64::max)
    }

    /// By how much rounding may move a value, relative to the largest load: where the responses of single
    /// displacements are much larger than the load and cancel.
    pub(crate) fn blur(&self) -> f64 {
        let row = self.lcp.scale.row.iter().fold(0.0, |a: f64, b| a.max(*b));
        let load = self.sizes.q.iter().fold(0.0, |a: f64, b| a.max(*b));
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

    /// Makes the column fetched last as true to the data as it can be made: by refinement, or where that is not enough
    /// by a dictionary built afresh. `false`: the equations of the scheme are singular.
    pub(crate) fn confirm(&mut self, c: usize) -> bool {
        self.refine_column(c);
        if self.column_error(c) > ROUNDING {
            if !self.refresh() {
                return false;
            }
            self.fetch(c);
        }
        true
    }

    /// Refines the column fetched last.
    pub(crate) fn refine_column(&mut self, c: usize) {
        self.column = self.corrected(&self.column, Some(c), 0.0);
        self.column_size = self.size_of(&self.column);
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
        self.fresh || self.dictionary.waiting() > 0 || self.agrees() || self.refresh()
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
        match (
            leaving.variable,
            leaving.hidden,
            self.dictionary.place(leaving.variable),
        ) {
            (Local::W(i), true, Place::Row(r)) => {
                self.dictionary.turn(&self.lcp, i);
                self.fetch(c);
                self.pivot(r, c, step);
            }
            (Local::W(i), true, Place::Column(_)) => {
                self.dictionary
                    .pivot_hidden(&self.lcp, i, c, &self.column, step);
            }
            (_, _, Place::Row(r)) => self.pivot(r, c, step),
            (_, _, Place::Column(_)) => debug_assert!(false, "a blocking row is basic"),
        }
        let d = &mut self.dictionary;
        // What was tied with the leaving row is zero now, not noise.
        for tie in tied {
            if !tie.hidden
                && tie.variable != leaving.variable
                && let Place::Row(r) = d.place(tie.variable)
            {
                d.value[r] = 0.0;
            }
        }
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
        let i = self.primary[whole];
        if self.variable(Local::W(i), false) != Variable::W(whole) {
            return None;
        }
        self.column_of(Local::W(i))
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
