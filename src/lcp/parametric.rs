//! Lemke's algorithm with a load parameter: w = M z + q + t d followed in t from a known answer.
//!
//! t enters first and rises; where a variable reaches zero (a *knot*) it leaves, its complement enters, and t goes
//! on with it. Between knots every variable is affine in t. d is the increment of the load and has any sign, so the
//! mirrors must not cover (e ≥ 0 only where a bound grows with t). The rule for ties is the lexicographic one, so
//! that starts from zero load, where everything is degenerate, end as well (theory §6, "Load parameter").

use std::collections::{BTreeSet, HashSet};
use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::DVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::dictionary::{Along, Dictionary, Local, Place};
use super::mirrored::MirroredLcp;
use super::outcome::{Point, RayDirection};
use super::ratio_test::{TieRule, TiedRow, choose};
use super::variable::Variable;
use super::vertex::{Basis, direction, vertex};

/// A value or rate counts as zero below this multiple of its natural size (theory: 64 … 256 ε).
const NOISE: f64 = 256.0 * f64::EPSILON;
/// A rate below this multiple of its natural size is confirmed from the data before it decides anything.
const SUSPICIOUS: f64 = 1e-7;
/// Relative error of the dictionary's values against the data above which it is built afresh.
const DRIFT: f64 = 1e-10;

/// How far a path goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// t at which it ends; infinite: as far as it goes.
    pub target: f64,
    /// Whether it goes on where t has to fall.
    pub through: bool,
    /// No more pivots than this.
    pub pivots: usize,
}

/// Why a path ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// t reached the target.
    Target,
    /// t would have to fall: there is no answer on this path just beyond its last knot.
    Turning,
    /// Nothing blocks while t stays: the limit of the load, with the direction of collapse.
    Limit(RayDirection),
    /// The last scheme holds for every larger t.
    Unbounded,
    /// Going through turning points t fell back to 0.
    Returned,
    /// More pivots than allowed.
    PivotLimit,
    /// Stopped from outside.
    Interrupted,
    /// The numbers no longer belong together.
    Breakdown(String),
}

/// A breakpoint: where the scheme changes (the first: the start; the last: the end).
#[derive(Clone, Debug, PartialEq)]
pub struct Knot {
    /// t.
    pub t: f64,
    /// All variables there, computed afresh from the data; its `p` is t.
    pub point: Point,
    /// What reached zero here, one after the other.
    pub leaving: Vec<Variable>,
    /// The scheme beyond it: rows of the whole LCP whose z is basic, ascending.
    pub scheme: Vec<usize>,
}

/// A followed path: its knots; between two of them everything is affine.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The knots, start and end included. t rises along them except beyond turning points.
    pub knots: Vec<Knot>,
    /// Why it ended.
    pub end: End,
    /// Pivots made.
    pub pivots: usize,
}

impl Path {
    /// The scheme at the end.
    pub fn last_scheme(&self) -> Basis {
        let z = self
            .knots
            .last()
            .map_or(Vec::new(), |knot| knot.scheme.clone());
        Basis {
            active: z.clone(),
            z,
            p: false,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    variable: Local,
    hidden: bool,
    value: f64,
    /// Rate of decrease, > 0.
    fall: f64,
    noise: f64,
}

/// The engine; see the module. It keeps its dictionary from one path to the next.
#[derive(Clone, Debug)]
pub struct Parametric {
    lcp: Arc<MirroredLcp>,
    rule: TieRule,
    dictionary: Dictionary,
    /// Rows of the whole LCP whose z is basic.
    scheme: BTreeSet<usize>,
    /// What grows; p (that is t) at the start.
    driver: Local,
    fresh: bool,
    column: Vec<f64>,
    largest_q: f64,
    largest_d: f64,
    largest_row: f64,
}

impl Parametric {
    /// Stands on the answer `basis` of the LCP at t = 0 (q), ready to follow `covering` as load increment; `order`
    /// is the order of rows of the lexicographic rule. `None` where the equations of the basis are singular.
    pub fn new(lcp: Arc<MirroredLcp>, basis: &Basis, order: Vec<usize>) -> Option<Parametric> {
        let dictionary = Dictionary::at_basis(&lcp, basis)?;
        let mut parametric = Parametric {
            rule: TieRule::Lexicographic(order),
            dictionary,
            scheme: basis.z.iter().copied().collect(),
            driver: Local::P,
            fresh: true,
            column: Vec::new(),
            largest_q: 0.0,
            largest_d: 0.0,
            largest_row: 0.0,
            lcp,
        };
        parametric.measure();
        Some(parametric)
    }

    /// Takes the next load increment after a path that ended at its target: only q, d and the constants of the
    /// mirrors may differ from the LCP so far. `false` where the dictionary cannot be carried over.
    pub fn reload(&mut self, lcp: Arc<MirroredLcp>) -> bool {
        if !self.dictionary.reload(&lcp) {
            return false;
        }
        self.lcp = lcp;
        self.driver = Local::P;
        self.fresh = false;
        self.measure();
        self.drift() <= DRIFT || self.refresh()
    }

    /// The scheme it stands on.
    pub fn basis(&self) -> Basis {
        let z: Vec<usize> = self.scheme.iter().copied().collect();
        Basis {
            active: z.clone(),
            z,
            p: false,
        }
    }

    fn measure(&mut self) {
        let mirrors = || self.lcp.mirrors.iter().flatten();
        self.largest_q = mirrors().fold(self.lcp.q.amax(), |a, m| a.max(m.constant.abs()));
        self.largest_d = mirrors().fold(self.lcp.covering.amax(), |a, m| a.max(m.covering.abs()));
        self.largest_row = self.lcp.scale.row.iter().fold(0.0, |a: f64, b| a.max(*b));
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

    fn rate_size(&self, local: Local, size: f64, t_rate: f64) -> f64 {
        match local {
            Local::W(i) => self.lcp.scale.row[i] * size + self.largest_d * t_rate.abs(),
            Local::Z(k) => size / self.lcp.scale.column[k],
            // t answers to a response of this size in the rows that the load increment moves most.
            Local::P if self.largest_d > 0.0 => size * self.largest_row / self.largest_d,
            Local::P => 1.0,
        }
    }

    fn value_size(&self, local: Local, size: f64, t: f64) -> f64 {
        match local {
            Local::W(i) => self.lcp.scale.row[i] * size + self.largest_q + self.largest_d * t.abs(),
            Local::Z(k) => size / self.lcp.scale.column[k],
            Local::P => t.abs(),
        }
    }

    /// Σ column_k |Δz_k| along column c.
    fn column_size(&self, c: usize) -> f64 {
        let mut size = self.size_of(&self.column);
        if let Local::Z(k) = self.dictionary.column[c] {
            size += self.lcp.scale.column[k];
        }
        size
    }

    /// Rows that fall when the variable of column c grows.
    fn candidates(&self, c: usize) -> Vec<Candidate> {
        let d = &self.dictionary;
        let t = d.along(Local::P, c, &self.column);
        let size = self.column_size(c);
        let value_size = self.size_of(&d.value);
        let mut candidates = Vec::new();
        let mut consider =
            |variable: Local, hidden: bool, along: Along, rate_size: f64, value_size: f64| {
                let noise = NOISE * value_size;
                if along.rate < -NOISE * rate_size {
                    candidates.push(Candidate {
                        variable,
                        hidden,
                        value: if along.value <= noise {
                            0.0
                        } else {
                            along.value
                        },
                        fall: -along.rate,
                        noise,
                    });
                }
            };
        for (r, &local) in d.row.iter().enumerate() {
            if local == Local::P {
                continue;
            }
            let along = Along {
                value: d.value[r],
                rate: self.column[r],
            };
            consider(
                local,
                false,
                along,
                self.rate_size(local, size, t.rate),
                self.value_size(local, value_size, t.value),
            );
        }
        for (i, mirror) in self.lcp.mirrors.iter().enumerate() {
            let Some(mirror) = mirror else { continue };
            // A slipping couple's other reserve is ≥ 0 by construction: 2 f w_n + b with w_n ≥ 0.
            let visible = match d.place(Local::W(i)) {
                Place::Row(_) => true,
                Place::Column(j) => j == c,
            };
            if !visible {
                continue;
            }
            let double = 2.0 * mirror.friction;
            let normal = mirror
                .normal
                .map_or((0.0, 0.0), |n| match d.place(Local::W(n)) {
                    // An open pair's x_n is an exact zero, not noise.
                    Place::Column(j) if j != c => (0.0, 0.0),
                    _ => (
                        self.rate_size(Local::W(n), size, t.rate),
                        self.value_size(Local::W(n), value_size, t.value),
                    ),
                });
            consider(
                Local::W(i),
                true,
                d.hidden(&self.lcp, i, c, &self.column),
                self.rate_size(Local::W(i), size, t.rate) + double * normal.0,
                self.value_size(Local::W(i), value_size, t.value) + double * normal.1,
            );
        }
        candidates
    }

    /// The candidates at the smallest ratio, and that ratio.
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

    fn refresh(&mut self) -> bool {
        self.fresh = self.dictionary.rebuild(&self.lcp);
        self.fresh
    }

    /// Largest error of the dictionary's values against w = M z + q + d t, relative to their natural sizes.
    fn drift(&self) -> f64 {
        let d = &self.dictionary;
        let (mut z, t) = d.solution();
        for (i, turned) in d.turned.iter().enumerate() {
            if *turned {
                z[i] = -z[i];
            }
        }
        let size = self.size_of(&d.value);
        let response: DVector<f64> = &self.lcp.matrix * &z;
        (0..self.lcp.size())
            .map(|i| {
                let w = response[i] + self.lcp.q[i] + self.lcp.covering[i] * t;
                let held = if d.turned[i] {
                    d.hidden_value(&self.lcp, i)
                } else {
                    d.value_of(Local::W(i))
                };
                let natural = self.value_size(Local::W(i), size, t);
                (w - held).abs() / natural.max(f64::MIN_POSITIVE)
            })
            .fold(0.0, f64::max)
    }

    fn fetch(&mut self) -> Option<usize> {
        let Place::Column(c) = self.dictionary.place(self.driver) else {
            return None;
        };
        let mut column = std::mem::take(&mut self.column);
        self.dictionary.fetch_column(c, &mut column);
        self.column = column;
        Some(c)
    }

    /// The vertex where `row` of the whole LCP has both its variables at zero; t is basic.
    fn knot_basis(&self, row: usize) -> Basis {
        let mut active = self.scheme.clone();
        active.insert(row);
        Basis {
            z: self.scheme.iter().copied().filter(|&k| k != row).collect(),
            active: active.into_iter().collect(),
            p: true,
        }
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

    /// The answer of the present scheme at t, from the data.
    fn point_at(&self, t: f64) -> Option<Point> {
        let mut lcp = MirroredLcp::clone(&self.lcp);
        lcp.q += t * &lcp.covering;
        for mirror in lcp.mirrors.iter_mut().flatten() {
            mirror.constant += t * mirror.covering;
        }
        let mut point = vertex(&lcp, &self.basis())?;
        point.p = t;
        Some(point)
    }

    /// Index of the tied candidate that leaves.
    fn choose(&self, tied: &[Candidate]) -> usize {
        let names: Vec<Variable> = tied
            .iter()
            .map(|row| self.variable(row.variable, row.hidden))
            .collect();
        let rows: Vec<_> = tied
            .iter()
            .map(|candidate| InverseRow {
                engine: self,
                candidate,
            })
            .collect();
        // The lexicographic rule draws nothing.
        let mut random = ChaCha8Rng::seed_from_u64(0);
        choose(&self.rule, &mut random, &names, &rows, false)
    }

    /// Makes the pivot; says what left.
    fn exchange(
        &mut self,
        leaving: Candidate,
        c: usize,
        step: f64,
        tied: &[Candidate],
    ) -> Variable {
        let lcp = Arc::clone(&self.lcp);
        let name = self.variable(leaving.variable, leaving.hidden);
        let mut column = std::mem::take(&mut self.column);
        let d = &mut self.dictionary;
        self.driver = match (leaving.variable, leaving.hidden) {
            (Local::W(i), true) => {
                if let Place::Row(r) = d.place(Local::W(i)) {
                    d.turn(&lcp, i);
                    d.fetch_column(c, &mut column);
                    d.pivot(r, c, &column, step);
                } else {
                    d.pivot_hidden(&lcp, i, c, &column, step);
                }
                Local::Z(i)
            }
            (local, _) => {
                if let Place::Row(r) = d.place(local) {
                    d.pivot(r, c, &column, step);
                }
                match local {
                    Local::W(i) => Local::Z(i),
                    Local::Z(i) => Local::W(i),
                    Local::P => Local::P,
                }
            }
        };
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
        match name {
            Variable::W(k) => {
                self.scheme.insert(k);
            }
            Variable::Z(k) => {
                self.scheme.remove(&k);
            }
            Variable::P => {}
        }
        name
    }

    /// t leaves: the path ends at the target, the dictionary stands on its answer and p is nonbasic again.
    fn settle(&mut self, c: usize, step: f64) {
        if let Place::Row(r) = self.dictionary.place(Local::P) {
            let column = std::mem::take(&mut self.column);
            self.dictionary.pivot(r, c, &column, step);
            self.column = column;
        } else {
            for (value, rate) in self.dictionary.value.iter_mut().zip(&self.column) {
                *value += rate * step;
            }
        }
        self.driver = Local::P;
        self.fresh = false;
    }

    /// The rate of t along the present column, zero where it is noise.
    fn t_rate(&self, c: usize) -> f64 {
        let raw = self.dictionary.along(Local::P, c, &self.column).rate;
        if self.driver == Local::P {
            return raw;
        }
        let size = self.rate_size(Local::P, self.column_size(c), 0.0);
        if raw.abs() > SUSPICIOUS * size {
            return raw;
        }
        // Near the noise the data decide: the direction at the last knot, its equations solved afresh.
        let row = match self.variable(self.driver, false) {
            Variable::W(k) | Variable::Z(k) => k,
            Variable::P => return raw,
        };
        let entering = self.variable(self.driver, false);
        let rate = direction(&self.lcp, &self.knot_basis(row), entering).map_or(raw, |d| d.p);
        if rate.abs() <= NOISE * size {
            0.0
        } else {
            rate
        }
    }

    fn ray(&self, c: usize) -> RayDirection {
        let (d, lcp) = (&self.dictionary, &self.lcp);
        let entering = self.variable(d.column[c], false);
        let size = self.column_size(c);
        let n = lcp.whole_size;
        let mut ray = RayDirection {
            entering,
            z: vec![0.0; n],
            w: vec![0.0; n],
            p: 0.0,
        };
        let mut put = |variable: Variable, rate: f64, noise: f64| {
            let rate = if rate <= noise { 0.0 } else { rate };
            match variable {
                Variable::W(k) => ray.w[k] = rate,
                Variable::Z(k) => ray.z[k] = rate,
                Variable::P => {}
            }
        };
        put(entering, 1.0, 0.0);
        for (&local, &rate) in d.row.iter().zip(&self.column) {
            put(
                self.variable(local, false),
                rate,
                NOISE * self.rate_size(local, size, 0.0),
            );
        }
        for i in 0..lcp.size() {
            if lcp.mirrors[i].is_some() {
                put(
                    self.variable(Local::W(i), true),
                    d.hidden(lcp, i, c, &self.column).rate,
                    4.0 * NOISE * self.rate_size(Local::W(i), size, 0.0),
                );
            }
        }
        let row = match entering {
            Variable::W(k) | Variable::Z(k) => k,
            Variable::P => return ray,
        };
        if let Some(fresh) = direction(lcp, &self.knot_basis(row), entering) {
            // The dictionary knows which entries are zero; the fresh solution knows their size.
            let keep = |mine: &mut [f64], fresh: &[f64]| {
                for (mine, fresh) in mine.iter_mut().zip(fresh) {
                    if *mine != 0.0 {
                        *mine = fresh.max(0.0);
                    }
                }
            };
            keep(&mut ray.z, &fresh.z);
            keep(&mut ray.w, &fresh.w);
        }
        ray
    }

    /// Follows the path; `observer` is called after every pivot with t and may break.
    pub fn follow(
        &mut self,
        reach: Reach,
        observer: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Path {
        let point = self.point_at(0.0).unwrap_or_else(|| self.read_point());
        let mut knots = Some(vec![Knot {
            t: 0.0,
            point,
            leaving: Vec::new(),
            scheme: self.scheme.iter().copied().collect(),
        }]);
        let (end, pivots) = self.run(reach, &mut knots, observer);
        Path {
            knots: knots.unwrap_or_default(),
            end,
            pivots,
        }
    }

    /// As [`Parametric::follow`], without a record of the way: only its end and the number of pivots.
    pub fn walk(
        &mut self,
        reach: Reach,
        observer: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> (End, usize) {
        self.run(reach, &mut None, observer)
    }

    fn run(
        &mut self,
        reach: Reach,
        knots: &mut Option<Vec<Knot>>,
        observer: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> (End, usize) {
        let mut met: HashSet<(Vec<usize>, Variable)> = HashSet::new();
        let mut pivots = 0;
        let end = loop {
            if pivots > reach.pivots {
                break End::PivotLimit;
            }
            match self.advance(reach, knots, &mut met) {
                ControlFlow::Break(end) => break end,
                ControlFlow::Continue(()) => pivots += 1,
            }
            if observer(self.dictionary.value_of(Local::P)).is_break() {
                break End::Interrupted;
            }
        };
        (end, pivots)
    }

    /// One pivot, or the end.
    fn advance(
        &mut self,
        reach: Reach,
        knots: &mut Option<Vec<Knot>>,
        met: &mut HashSet<(Vec<usize>, Variable)>,
    ) -> ControlFlow<End> {
        let lost =
            || ControlFlow::Break(End::Breakdown("the driving variable was lost".to_owned()));
        let singular = "the equations of the working scheme are singular";
        if self.dictionary.pending() == 0 && !self.fresh && self.drift() > DRIFT && !self.refresh()
        {
            return ControlFlow::Break(End::Breakdown(singular.to_owned()));
        }
        let Some(mut c) = self.fetch() else {
            return lost();
        };
        let (mut tied, mut step) = self.blocking(c);
        let mut t_rate = self.t_rate(c);
        let suspicious = !self.fresh
            && tied.iter().all(|row| {
                row.fall <= SUSPICIOUS * self.rate_size(row.variable, self.column_size(c), t_rate)
            });
        if suspicious && self.refresh() {
            let Some(again) = self.fetch() else {
                return lost();
            };
            c = again;
            (tied, step) = self.blocking(c);
            t_rate = self.t_rate(c);
        }
        let t = self.dictionary.value_of(Local::P);
        if t_rate < 0.0 && step > 0.0 {
            if !reach.through {
                return ControlFlow::Break(End::Turning);
            }
            let room = t.max(0.0) / -t_rate;
            if room <= step {
                self.finish(c, room, 0.0, knots);
                return ControlFlow::Break(End::Returned);
            }
        }
        if t_rate > 0.0 && reach.target.is_finite() {
            let room = (reach.target - t).max(0.0) / t_rate;
            if room <= step {
                self.finish(c, room, reach.target, knots);
                return ControlFlow::Break(End::Target);
            }
        }
        if tied.is_empty() {
            return ControlFlow::Break(if t_rate > 0.0 {
                End::Unbounded
            } else {
                End::Limit(self.ray(c))
            });
        }
        let leaving = tied[self.choose(&tied)];
        let name = self.exchange(leaving, c, step, &tied);
        let row = match name {
            Variable::W(k) | Variable::Z(k) => k,
            Variable::P => return lost(),
        };
        let scheme: Vec<usize> = self.scheme.iter().copied().collect();
        if step > 0.0 {
            met.clear();
            if let Some(knots) = knots {
                let point =
                    vertex(&self.lcp, &self.knot_basis(row)).unwrap_or_else(|| self.read_point());
                knots.push(Knot {
                    t: point.p,
                    point,
                    leaving: vec![name],
                    scheme,
                });
            }
        } else {
            if let Some(knot) = knots.as_mut().and_then(|knots| knots.last_mut()) {
                knot.leaving.push(name);
                knot.scheme.clone_from(&scheme);
            }
            if !met.insert((scheme, name)) {
                return ControlFlow::Break(End::Breakdown(
                    "a working scheme came back at the same load".to_owned(),
                ));
            }
        }
        ControlFlow::Continue(())
    }

    /// Ends at t = `end` after the last step.
    fn finish(&mut self, c: usize, step: f64, end: f64, knots: &mut Option<Vec<Knot>>) {
        self.settle(c, step);
        let Some(knots) = knots else {
            return;
        };
        let mut point = self.point_at(end).unwrap_or_else(|| self.read_point());
        point.p = end;
        knots.push(Knot {
            t: end,
            point,
            leaving: Vec::new(),
            scheme: self.scheme.iter().copied().collect(),
        });
    }
}

/// The row of B⁻¹ of a tied candidate: what an ε added to a w does to its value.
struct InverseRow<'a> {
    engine: &'a Parametric,
    candidate: &'a Candidate,
}

impl TiedRow for InverseRow<'_> {
    fn table_row(&self) -> usize {
        // Asked by another rule only.
        0
    }

    fn entry(&self, row: usize) -> (f64, f64) {
        let engine = self.engine;
        let (d, lcp) = (&engine.dictionary, &engine.lcp);
        let named = |local: Local| engine.variable(local, false) == Variable::W(row);
        let column = d
            .column
            .iter()
            .position(|&local| matches!(local, Local::W(_)) && named(local));
        let is = |local: Local| f64::from(named(local));
        let visible = |local: Local| match d.place(local) {
            Place::Row(_) if named(local) => 1.0,
            // A nonbasic w stands in its column with the opposite sign of its ε.
            Place::Row(r) => column.map_or(0.0, |c| -d.entry(r, c)),
            Place::Column(_) => 0.0,
        };
        let natural = |local: Local| {
            let Some(Local::W(j) | Local::Z(j)) = column.map(|c| d.column[c]) else {
                return 0.0;
            };
            let below = lcp.scale.row[j].max(f64::MIN_POSITIVE);
            match local {
                Local::W(i) => lcp.scale.row[i] / below,
                Local::Z(k) => 1.0 / (lcp.scale.column[k] * below),
                Local::P => 1.0 / engine.largest_d.max(f64::MIN_POSITIVE),
            }
        };
        let candidate = self.candidate;
        let mut size = natural(candidate.variable) + 1.0;
        let mut entry = visible(candidate.variable);
        if candidate.hidden
            && let Local::W(i) = candidate.variable
            && let Some(mirror) = &lcp.mirrors[i]
        {
            let own = f64::from(engine.variable(Local::W(i), true) == Variable::W(row));
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
