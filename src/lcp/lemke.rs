//! Lemke's algorithm on a mirrored LCP: the working-scheme engine.
//!
//! w = M z + q + d p. p enters first, at the smallest value for which w ≥ 0 with z = 0; then the complement of
//! what left enters, until p leaves (normal end) or nothing blocks (ray). One dictionary of N rows carries the
//! run ([`super::dictionary`]); zero tests are scaled (theory §4, "Numerics that matter").

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::dictionary::{Dictionary, Local, Place};
use super::driver::{Engine, Step};
use super::mirrored::MirroredLcp;
use super::outcome::{Outcome, Point, RayDirection};
use super::ratio_test::{TieRule, TiedRow, choose};
use super::trace::Pivot;
use super::variable::Variable;

/// A value or rate counts as zero below this multiple of its natural size (theory: 64 … 256 ε).
const NOISE: f64 = 256.0 * f64::EPSILON;
/// p at a ray below this multiple of the largest |q| is a normal end, flagged.
pub const MARGINAL: f64 = 1e-12;
/// A rate below this multiple of its natural size is confirmed from the data before it decides anything.
const SUSPICIOUS: f64 = 1e-7;
/// Relative error of the dictionary's values against the data above which it is built afresh.
const DRIFT: f64 = 1e-10;

/// A row that may block the entering variable.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    /// The variable whose row it is; for `hidden` the couple's visible one.
    variable: Local,
    hidden: bool,
    value: f64,
    /// Rate of decrease, > 0.
    fall: f64,
    /// Noise of the value.
    noise: f64,
}

/// The engine; see the module.
#[derive(Clone, Debug)]
pub struct SchemeEngine {
    lcp: Arc<MirroredLcp>,
    rule: TieRule,
    random: ChaCha8Rng,
    dictionary: Dictionary,
    pivots: Vec<Pivot>,
    /// What enters next; `None` before the entry of p.
    entering: Option<Local>,
    ended: Option<Outcome>,
    /// p at step 0: the natural size of p.
    first_p: f64,
    /// Natural size of p for a response of size 1: mean row scale over mean covering.
    force_per_p: f64,
    /// Row of every basic variable in the whole tableau (see [`TieRule::FirstRow`]).
    table_row: HashMap<Variable, usize>,
    /// Bases met, where the rule may cycle.
    bases: HashSet<u64>,
    /// Set where the run stopped because z⁺ and z⁻ of a couple would both be basic: the vertex after that.
    artefact_point: Option<Point>,
    /// The dictionary is known to be fresh from the data.
    fresh: bool,
    /// How often the dictionary was built afresh.
    refreshes: usize,
    column: Vec<f64>,
}

impl SchemeEngine {
    /// A run that stands before the entry of p.
    pub fn new(lcp: Arc<MirroredLcp>, rule: TieRule) -> SchemeEngine {
        let dictionary = Dictionary::new(&lcp);
        let rows: f64 = lcp.scale.row.iter().sum();
        let covering: f64 = lcp.covering.iter().map(|d| d.abs()).sum();
        let seed = if let TieRule::Random(seed) = rule {
            seed
        } else {
            0
        };
        SchemeEngine {
            rule,
            random: ChaCha8Rng::seed_from_u64(seed),
            dictionary,
            pivots: Vec::new(),
            entering: None,
            ended: None,
            first_p: 0.0,
            force_per_p: if covering > 0.0 { rows / covering } else { 1.0 },
            table_row: (0..lcp.whole_size)
                .map(|row| (Variable::W(row), row))
                .collect(),
            bases: HashSet::new(),
            artefact_point: None,
            fresh: true,
            refreshes: 0,
            column: Vec::new(),
            lcp,
        }
    }

    /// The problem that is solved.
    pub fn lcp(&self) -> &MirroredLcp {
        &self.lcp
    }

    /// How often the dictionary was built afresh from the data.
    pub fn refreshes(&self) -> usize {
        self.refreshes
    }

    fn variable(&self, local: Local, hidden: bool) -> Variable {
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

    /// Natural size of the rate of a row, where Σ column_k |Δz_k| = `size` and Δp = `p_rate`.
    fn rate_size(&self, local: Local, size: f64, p_rate: f64) -> f64 {
        match local {
            Local::W(i) => self.lcp.scale.row[i] * size + self.lcp.covering[i] * p_rate.abs(),
            Local::Z(k) => size / self.lcp.scale.column[k],
            Local::P => size * self.force_per_p,
        }
    }

    fn value_size(&self, local: Local, size: f64, p: f64) -> f64 {
        match local {
            Local::W(i) => {
                self.lcp.scale.row[i] * size + self.lcp.q[i].abs() + self.lcp.covering[i] * p.abs()
            }
            Local::Z(k) => size / self.lcp.scale.column[k],
            Local::P => self.first_p,
        }
    }

    /// Σ column_k |Δz_k| along column c, the entering variable included.
    fn rate_total(&self, c: usize) -> f64 {
        let entering = match self.dictionary.column[c] {
            Local::Z(k) => self.lcp.scale.column[k],
            _ => 0.0,
        };
        self.size_of(&self.column) + entering
    }

    /// Rows that fall when the variable of column c grows.
    fn candidates(&self, c: usize) -> Vec<Candidate> {
        let d = &self.dictionary;
        let p = d.along(Local::P, c, &self.column);
        let size = self.rate_total(c);
        let value_size = self.size_of(&d.value);
        let mut candidates = Vec::new();
        for (r, (&local, &rate)) in d.row.iter().zip(&self.column).enumerate() {
            if rate < 0.0 && rate < -NOISE * self.rate_size(local, size, p.rate) {
                candidates.push(Candidate {
                    variable: local,
                    hidden: false,
                    value: d.value[r].max(0.0),
                    fall: -rate,
                    noise: NOISE * self.value_size(local, value_size, p.value),
                });
            }
        }
        for (i, mirror) in self.lcp.mirrors.iter().enumerate() {
            let Some(mirror) = mirror else { continue };
            // A slipping couple's other reserve cannot be used up where e > 0 keeps it ≥ 0 by construction; it is
            // watched for e ≤ 0, where the textbook rules stumble over it.
            let visible = match d.place(Local::W(i)) {
                Place::Row(_) => true,
                Place::Column(j) => j == c,
            };
            if !visible && mirror.covering > 0.0 {
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
            let sum = |of: &dyn Fn(Local) -> f64, covering: f64| {
                let own = if visible { of(Local::W(i)) } else { 0.0 };
                let normal = normal.map_or(0.0, |n| of(Local::W(n)));
                own + 2.0 * mirror.friction * normal + (mirror.covering * covering).abs()
            };
            let rate_size = sum(&|local| self.rate_size(local, size, p.rate), p.rate);
            if along.rate < -NOISE * rate_size {
                let value_size = sum(
                    &|local| self.value_size(local, value_size, p.value),
                    p.value,
                ) + mirror.constant;
                candidates.push(Candidate {
                    variable: Local::W(i),
                    hidden: true,
                    value: along.value.max(0.0),
                    fall: -along.rate,
                    noise: NOISE * value_size,
                });
            }
        }
        candidates
    }

    /// Whether the decision on column c hangs on a rate so near the noise that the data must confirm it.
    fn is_suspicious(&self, c: usize, tied: &[Candidate]) -> bool {
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

    /// Largest error of column c against M Δz + d Δp over all rows, relative to their natural sizes.
    fn column_error(&self, c: usize) -> f64 {
        let d = &self.dictionary;
        let along = |local: Local| d.along(local, c, &self.column).rate;
        let z = nalgebra::DVector::from_fn(self.lcp.size(), |i, _| {
            let rate = along(Local::Z(i));
            if d.turned[i] { -rate } else { rate }
        });
        let p = along(Local::P);
        let size = self.rate_total(c);
        let response = &self.lcp.matrix * z;
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

    /// Builds the dictionary from the data; says whether that worked.
    fn refresh(&mut self) -> bool {
        if self.dictionary.rebuild(&self.lcp) {
            self.fresh = true;
            self.refreshes += 1;
            true
        } else {
            false
        }
    }

    /// Largest error of the dictionary's values against w = M z + q + d p, relative to their natural sizes.
    fn drift(&self) -> f64 {
        let point = self.primary_point();
        let size = self.size_of(&self.dictionary.value);
        let (z, p) = point;
        let response = &self.lcp.matrix * &z;
        (0..self.lcp.size())
            .map(|i| {
                let w = response[i] + self.lcp.q[i] + self.lcp.covering[i] * p;
                let held = self.primary_w(i);
                (w - held).abs() / self.value_size(Local::W(i), size, p).max(f64::MIN_POSITIVE)
            })
            .fold(0.0, f64::max)
    }

    /// z of the primary rows with the sign of their orientation (z⁺ − z⁻ for couples), and p.
    fn primary_point(&self) -> (nalgebra::DVector<f64>, f64) {
        let (mut z, p) = self.dictionary.solution();
        for (i, turned) in self.dictionary.turned.iter().enumerate() {
            if *turned {
                z[i] = -z[i];
            }
        }
        (z, p)
    }

    /// w of the primary row i as the dictionary holds it.
    fn primary_w(&self, i: usize) -> f64 {
        let d = &self.dictionary;
        if d.turned[i] {
            d.hidden_value(&self.lcp, i)
        } else {
            d.value_of(Local::W(i))
        }
    }

    /// Column of a nonbasic variable.
    fn column_of(&self, local: Local) -> Option<usize> {
        match self.dictionary.place(local) {
            Place::Column(c) => Some(c),
            Place::Row(_) => None,
        }
    }

    fn end(&mut self, outcome: Outcome) -> Step<f64> {
        self.ended = Some(outcome.clone());
        Step::Ended(outcome)
    }

    /// The entry of p (pivot 0), or the trivial end.
    fn start(&mut self) -> Step<f64> {
        let lcp = Arc::clone(&self.lcp);
        // Ratios −q_i / d_i of all rows, mirrors included.
        let mut rows: Vec<(Local, bool, f64, f64)> = (0..lcp.size())
            .map(|i| (Local::W(i), false, lcp.q[i], lcp.covering[i]))
            .collect();
        for (i, mirror) in lcp.mirrors.iter().enumerate() {
            if let Some(mirror) = mirror {
                let (q, d) = lcp.mirror_start(i, mirror);
                rows.push((Local::W(i), true, q, d));
            }
        }
        let largest = rows.iter().map(|row| row.2.abs()).fold(0.0, f64::max);
        let negative: Vec<_> = rows.iter().filter(|row| row.2 < -NOISE * largest).collect();
        if negative.is_empty() {
            return self.end(Outcome::Trivial);
        }
        if negative.iter().any(|row| row.3 <= 0.0) {
            return self.end(Outcome::Breakdown(
                "the covering vector is zero in a row whose q is negative".to_owned(),
            ));
        }
        let needed = negative
            .iter()
            .map(|row| -row.2 / row.3)
            .fold(0.0, f64::max);
        self.first_p = needed;
        let tied: Vec<Candidate> = negative
            .iter()
            .filter(|row| row.2 + row.3 * needed <= NOISE * (row.2.abs() + row.3 * needed))
            .map(|row| Candidate {
                variable: row.0,
                hidden: row.1,
                value: -row.2,
                fall: row.3,
                noise: 0.0,
            })
            .collect();
        // Before p enters every row has only its own ε: the tie-break is settled by the order alone, and the row
        // with the *largest* (q + ε)/(−d) blocks, i.e. the one whose ε comes last.
        let c = lcp.size();
        self.dictionary.fetch_column(c, &mut self.column);
        let chosen = self.choose(&tied, true);
        self.exchange(tied[chosen], c, needed, &tied);
        Step::Pivoted
    }

    /// Index of the tied candidate that leaves.
    fn choose(&mut self, tied: &[Candidate], at_start: bool) -> usize {
        let names: Vec<Variable> = tied
            .iter()
            .map(|candidate| self.variable(candidate.variable, candidate.hidden))
            .collect();
        let rows: Vec<_> = tied
            .iter()
            .map(|candidate| InverseRow {
                engine: self,
                candidate,
            })
            .collect();
        let mut random = self.random.clone();
        let chosen = choose(&self.rule, &mut random, &names, &rows, at_start);
        self.random = random;
        chosen
    }

    /// Natural size of the entry of the row of B⁻¹ of `local` in the column of primary row `j`.
    fn inverse_size(&self, local: Local, j: usize) -> f64 {
        let scale = &self.lcp.scale;
        let column = scale.row[j].max(f64::MIN_POSITIVE);
        match local {
            Local::W(i) => scale.row[i] / column,
            Local::Z(k) => 1.0 / (scale.column[k] * column),
            Local::P => self.force_per_p / column,
        }
    }

    /// Column of the nonbasic w that stands in row `whole` of the whole LCP.
    fn nonbasic_w(&self, whole: usize) -> Option<usize> {
        self.dictionary.column.iter().position(|&local| {
            matches!(local, Local::W(_)) && self.variable(local, false) == Variable::W(whole)
        })
    }

    fn fetch(&mut self, c: usize) {
        let mut column = std::mem::take(&mut self.column);
        self.dictionary.fetch_column(c, &mut column);
        self.column = column;
    }

    /// Makes the pivot and its record.
    fn exchange(&mut self, leaving: Candidate, c: usize, step: f64, tied: &[Candidate]) {
        let lcp = Arc::clone(&self.lcp);
        let entering_local = self.dictionary.column[c];
        let entering = self.variable(entering_local, false);
        let name = self.variable(leaving.variable, leaving.hidden);
        let mut ties: Vec<Variable> = tied
            .iter()
            .map(|tie| self.variable(tie.variable, tie.hidden))
            .collect();
        ties.sort_unstable();
        let p_before = if self.pivots.is_empty() {
            step
        } else {
            self.dictionary.value_of(Local::P)
        };
        let mut next = None;
        match (leaving.variable, leaving.hidden) {
            (Local::W(i), true) => match self.dictionary.place(Local::W(i)) {
                Place::Row(_) => {
                    self.dictionary.turn(&lcp, i);
                    self.dictionary.fetch_column(c, &mut self.column);
                    self.exchange_visible(Local::W(i), c, step);
                    next = Some(Local::Z(i));
                }
                Place::Column(j) if j == c => {
                    self.dictionary.pivot_hidden(&lcp, i, c, &self.column, step);
                    next = Some(Local::Z(i));
                }
                Place::Column(_) => self.finish_artefact(i, c, step),
            },
            (local, _) => {
                self.exchange_visible(local, c, step);
                next = match local {
                    Local::W(i) => Some(Local::Z(i)),
                    Local::Z(i) => Some(Local::W(i)),
                    Local::P => None,
                };
            }
        }
        // What was tied with the leaving row is zero now, not noise.
        for tie in tied {
            if !tie.hidden
                && tie.variable != leaving.variable
                && let Place::Row(r) = self.dictionary.place(tie.variable)
            {
                self.dictionary.value[r] = 0.0;
            }
        }
        let p_after = match &self.artefact_point {
            Some(point) => point.p,
            None => self.dictionary.value_of(Local::P),
        };
        self.pivots.push(Pivot {
            step: self.pivots.len(),
            entering,
            leaving: name,
            p_before,
            p_after,
            ratio: step,
            ties,
        });
        if let Some(row) = self.table_row.remove(&name) {
            self.table_row.insert(entering, row);
        }
        self.fresh = false;
        self.entering = next;
        if name == Variable::P {
            self.ended = Some(Outcome::Normal { marginal: false });
        }
    }

    fn exchange_visible(&mut self, local: Local, c: usize, step: f64) {
        if let Place::Row(r) = self.dictionary.place(local) {
            self.dictionary.pivot(r, c, &self.column, step);
        } else {
            debug_assert!(false, "a blocking row is basic");
        }
    }

    /// The other reserve of a slipping couple is used up: its z would enter beside the one that is basic, and
    /// (z⁺, z⁻) = (1, 1) moves nothing else. The run ends in that ray at the vertex after this step.
    fn finish_artefact(&mut self, i: usize, c: usize, step: f64) {
        for (value, rate) in self.dictionary.value.iter_mut().zip(&self.column) {
            *value += rate * step;
        }
        let entering = self.dictionary.column[c];
        let mut point = self.read_point();
        match self.variable(entering, false) {
            Variable::W(k) => point.w[k] = step,
            Variable::Z(k) => point.z[k] = step,
            Variable::P => point.p = step,
        }
        let n = self.lcp.whole_size;
        let mut z = vec![0.0; n];
        let other = self.variable(Local::Z(i), true);
        for variable in [self.variable(Local::Z(i), false), other] {
            if let Variable::Z(k) = variable {
                z[k] = 1.0;
            }
        }
        self.artefact_point = Some(point);
        self.ended = Some(Outcome::Ray(RayDirection {
            entering: other,
            z,
            w: vec![0.0; n],
            p: 0.0,
        }));
    }

    fn read_point(&self) -> Point {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let mut point = Point {
            z: vec![0.0; lcp.whole_size],
            w: vec![0.0; lcp.whole_size],
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

    fn ray(&self, c: usize) -> Outcome {
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
            // Rates that did not block are ≥ 0 up to noise.
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
        Outcome::Ray(ray)
    }

    /// Whether this basis was met before (asked only where the rule may cycle).
    fn comes_back(&mut self) -> bool {
        if self.rule != TieRule::FirstRow {
            return false;
        }
        let mut basis: Vec<Variable> = self
            .dictionary
            .row
            .iter()
            .map(|&local| self.variable(local, false))
            .collect();
        basis.sort_unstable();
        let mut hasher = DefaultHasher::new();
        basis.hash(&mut hasher);
        self.entering
            .map(|local| self.variable(local, false))
            .hash(&mut hasher);
        !self.bases.insert(hasher.finish())
    }

    /// The blocking candidates at the smallest ratio, and that ratio.
    fn blocking(&self, c: usize) -> (Vec<Candidate>, f64) {
        let candidates = self.candidates(c);
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
}

impl Engine for SchemeEngine {
    type Number = f64;

    fn step(&mut self) -> Step<f64> {
        if let Some(outcome) = &self.ended {
            return Step::Ended(outcome.clone());
        }
        let Some(entering) = self.entering else {
            return self.start();
        };
        if self.comes_back() {
            return self.end(Outcome::Cycle);
        }
        if self.dictionary.pending() == 0 && !self.fresh && self.drift() > DRIFT && !self.refresh()
        {
            return self.end(Outcome::Breakdown(
                "the equations of the working scheme are singular".to_owned(),
            ));
        }
        let Some(c) = self.column_of(entering) else {
            return self.end(Outcome::Breakdown(
                "the entering variable is basic already".to_owned(),
            ));
        };
        self.fetch(c);
        let (mut tied, mut step) = self.blocking(c);
        if self.is_suspicious(c, &tied) && self.refresh() {
            self.fetch(c);
            (tied, step) = self.blocking(c);
        }
        if tied.is_empty() {
            let p = self.dictionary.value_of(Local::P);
            let largest = self.lcp.q.amax();
            if p <= MARGINAL * largest {
                return self.end(Outcome::Normal { marginal: true });
            }
            let ray = self.ray(c);
            return self.end(ray);
        }
        let chosen = self.choose(&tied, false);
        self.exchange(tied[chosen], c, step, &tied);
        Step::Pivoted
    }

    fn pivots(&self) -> &[Pivot] {
        &self.pivots
    }

    fn point(&self) -> Point {
        self.artefact_point
            .clone()
            .unwrap_or_else(|| self.read_point())
    }
}

/// The row of B⁻¹ of a tied candidate: what an ε added to a w does to its value.
struct InverseRow<'a> {
    engine: &'a SchemeEngine,
    candidate: &'a Candidate,
}

impl TiedRow for InverseRow<'_> {
    fn table_row(&self) -> usize {
        let name = self
            .engine
            .variable(self.candidate.variable, self.candidate.hidden);
        self.engine
            .table_row
            .get(&name)
            .copied()
            .unwrap_or(usize::MAX)
    }

    fn entry(&self, row: usize) -> (f64, f64) {
        let engine = self.engine;
        let d = &engine.dictionary;
        let column = engine.nonbasic_w(row);
        let is = |local: Local| f64::from(engine.variable(local, false) == Variable::W(row));
        let visible = |local: Local| match d.place(local) {
            Place::Row(_) if is(local) == 1.0 => 1.0,
            // A nonbasic w stands in its column with the opposite sign of its ε.
            Place::Row(r) => column.map_or(0.0, |c| -d.entry(r, c)),
            Place::Column(_) => 0.0,
        };
        let primary = column.map(|c| match d.column[c] {
            Local::W(i) | Local::Z(i) => i,
            Local::P => 0,
        });
        let candidate = self.candidate;
        let mut size = primary.map_or(0.0, |j| engine.inverse_size(candidate.variable, j)) + 1.0;
        let mut entry = visible(candidate.variable);
        if candidate.hidden
            && let Local::W(i) = candidate.variable
            && let Some(mirror) = &engine.lcp.mirrors[i]
        {
            let own = f64::from(engine.variable(Local::W(i), true) == Variable::W(row));
            entry = own + is(Local::W(i)) - entry + mirror.covering * visible(Local::P);
            if let Some(n) = mirror.normal {
                let double = 2.0 * mirror.friction;
                entry += double * (visible(Local::W(n)) - is(Local::W(n)));
                size +=
                    double * (1.0 + primary.map_or(0.0, |j| engine.inverse_size(Local::W(n), j)));
            }
        }
        (entry / candidate.fall, size / candidate.fall)
    }
}
