//! Lemke's algorithm with a load parameter: w = M z + q + t d followed in t from a known answer.
//!
//! t enters first and rises; where a variable reaches zero (a *knot*) it leaves, its complement enters, and t goes
//! on with it. Between knots every variable is affine in t. d is the increment of the load and has any sign, so the
//! mirrors must not cover (e ≥ 0 only where a bound grows with t). The rule for ties is the lexicographic one, so
//! that starts from zero load, where everything is degenerate, end as well (method §6).

mod friction;
mod path;

pub use path::{Breakpoint, End, Path, Reach};

use std::collections::{BTreeSet, HashSet};
use std::ops::ControlFlow;
use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::dictionary::{Dictionary, Place, Slot};
use super::mirrored::MirroredLcp;
use super::outcome::{Point, RayDirection};
use super::ratio_test::{TieRule, choose};
use super::variable::Variable;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::{direction, vertex};
use crate::lcp::pivot_state::{Candidate, NOISE, PivotState, SUSPICIOUS, Sizes};

/// A load increment counts as a multiple of another up to this, relative to the load.
const MULTIPLE: f64 = 16.0 * f64::EPSILON;

/// Values are refined at once where the bound of what rounding may do to them exceeds this, relative to the load. They
/// are better than that by a digit or two; the fresh check, which asks for 1e-9, finds the others.
const BLURRED: f64 = 3e-9;

/// The engine; see the module. It keeps its dictionary from one path to the next.
#[derive(Clone, Debug)]
pub struct Parametric {
    state: PivotState,
    rule: TieRule,
    /// Rows of the whole LCP whose z is basic.
    scheme: BTreeSet<usize>,
    /// What grows; p (that is t) at the start.
    driver: Slot,
}

/// Natural sizes of a path: the largest of all rows, because q may be zero and everything degenerate.
fn sizes(lcp: &MirroredLcp) -> Sizes {
    let mirrors = || lcp.mirrors.iter().flatten();
    let q = mirrors().fold(lcp.q.amax(), |a, m| a.max(m.constant.abs()));
    let d = mirrors().fold(lcp.covering.amax(), |a, m| a.max(m.covering.abs()));
    let row = lcp.scale.row.iter().fold(0.0, |a: f64, b| a.max(*b));
    Sizes {
        q: vec![q; lcp.size()],
        d: vec![d; lcp.size()],
        // The t that balances a response of natural size in the rows that the load increment moves most.
        p_per_force: if d > 0.0 { row / d } else { 1.0 },
        // t itself never blocks: it is watched by its target.
        p: 0.0,
    }
}

/// The factor by which the load increment of `new` is a multiple of that of `old`, up to rounding: a slider that moves
/// on. The increments are differences of loads, so rounding is judged against the loads too.
fn multiple(new: &MirroredLcp, old: &MirroredLcp) -> Option<f64> {
    if new.covering.is_empty() {
        return None;
    }
    let largest = new.covering.iamax();
    let factor = new.covering[largest] / old.covering[largest];
    if !factor.is_finite() || factor == 0.0 {
        return None;
    }
    let bearable = MULTIPLE * (new.q.amax() + new.covering.amax());
    // An increment hardly above the rounding of the load has no direction.
    if bearable > 1e-9 * new.covering.amax() {
        return None;
    }
    let same = |new: f64, old: f64| (new - factor * old).abs() <= bearable;
    let mut increments = new.covering.iter().zip(&old.covering);
    let mut mirrors = new.mirrors.iter().zip(&old.mirrors);
    let all = increments.all(|(new, old)| same(*new, *old))
        && mirrors.all(|pair| match pair {
            (Some(new), Some(old)) => same(new.covering, old.covering),
            _ => true,
        });
    all.then_some(factor)
}

impl Parametric {
    /// Stands on the answer `basis` of the LCP at t = 0 (q), ready to follow `covering` as load increment; `order`
    /// is the order of rows of the lexicographic rule. `None` where the equations of the basis are singular.
    pub fn new(lcp: Arc<MirroredLcp>, basis: &Basis, order: Vec<usize>) -> Option<Parametric> {
        let dictionary = Dictionary::at_basis(&lcp, basis)?;
        let sizes = sizes(&lcp);
        Some(Parametric {
            state: PivotState::new(lcp, dictionary, sizes),
            rule: TieRule::Lexicographic(order),
            scheme: basis.z.iter().copied().collect(),
            driver: Slot::P,
        })
    }

    /// Stands where a run of Lemke's algorithm ended; `None` while p is basic.
    pub(crate) fn standing(state: PivotState, order: Vec<usize>) -> Option<Parametric> {
        state.column_of(Slot::P)?;
        let scheme = state
            .dictionary
            .row
            .iter()
            .filter_map(|&local| match state.variable(local, false) {
                Variable::Z(k) => Some(k),
                _ => None,
            })
            .collect();
        Some(Parametric { state, rule: TieRule::Lexicographic(order), scheme, driver: Slot::P })
    }

    /// Takes the next load increment after a path that ended at its target. q and the constants of the mirrors are
    /// those of that target, M and the mirrors' friction are the same; only the increment (d, e) is new. `false` where
    /// the dictionary cannot be carried over.
    pub fn reload(&mut self, lcp: Arc<MirroredLcp>) -> bool {
        if self.state.column_of(Slot::P).is_none() {
            return false;
        }
        match multiple(&lcp, &self.state.lcp) {
            Some(factor) => self.state.dictionary.rescale(factor),
            None => self.state.dictionary.reload(&lcp),
        }
        let sizes = sizes(&lcp);
        self.state.reload(lcp, sizes);
        self.state.fresh = false;
        self.driver = Slot::P;
        true
    }

    /// How often the dictionary was built afresh from the data.
    pub fn refreshes(&self) -> usize {
        self.state.refreshes
    }

    /// The scheme it stands on.
    pub fn basis(&self) -> Basis {
        let z: Vec<usize> = self.scheme.iter().copied().collect();
        Basis { active: z.clone(), z, p: false }
    }

    /// All variables where it stands, as the kept dictionary holds them, refined from the data where rounding shows.
    pub fn point(&mut self) -> Point {
        self.sharpen();
        self.state.point()
    }

    fn sharpen(&mut self) {
        if self.state.blur() > BLURRED {
            self.state.refine();
        }
    }

    /// Refines the values from the data.
    pub fn refine(&mut self) {
        self.state.refine();
    }

    fn fetch(&mut self) -> Option<usize> {
        let c = self.state.column_of(self.driver)?;
        self.state.fetch(c);
        Some(c)
    }

    /// The rows that block; t is watched by its target and does not.
    fn blocking(&mut self, c: usize) -> (Vec<Candidate>, f64) {
        self.state.blocking(c, false)
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

    /// The vertex where `row` of the whole LCP has both its variables at zero: as the dictionary holds it, refined from
    /// the data; solved afresh where that does not agree with them, or agrees only because displacements are so large
    /// that their rounding hides the load.
    fn knot(&self, row: usize) -> Point {
        let sharp = if self.state.blur() <= BLURRED { self.state.sharp_point() } else { None };
        let point = sharp.or_else(|| vertex(&self.state.lcp, &self.knot_basis(row)));
        point.unwrap_or_else(|| self.state.point())
    }

    /// The answer of the present scheme at t, from the data.
    fn point_at(&self, t: f64) -> Option<Point> {
        let mut lcp = MirroredLcp::clone(&self.state.lcp);
        lcp.q += t * &lcp.covering;
        for mirror in lcp.mirrors.iter_mut().flatten() {
            mirror.constant += t * mirror.covering;
        }
        let mut point = vertex(&lcp, &self.basis())?;
        point.p = t;
        Some(point)
    }

    /// Index of the candidate that leaves of those tied along column c.
    fn choose(&mut self, c: usize, tied: &[Candidate]) -> usize {
        if tied.len() > 1 {
            self.state.dictionary.settle_w();
        }
        let names: Vec<Variable> = tied.iter().map(|row| self.state.name(row)).collect();
        // The lexicographic rule asks for no rows of the tableau and draws nothing.
        let rows = self.state.inverse_rows(c, tied, &|_| 0);
        let mut random = ChaCha8Rng::seed_from_u64(0);
        choose(&self.rule, &mut random, &names, &rows, false)
    }

    /// Makes the pivot; says what left.
    fn exchange(&mut self, leaving: Candidate, c: usize, step: f64, tied: &[Candidate]) -> Variable {
        let name = self.state.name(&leaving);
        self.driver = self.state.exchange(&leaving, c, step, tied).unwrap_or(Slot::P);
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
        if let Place::Row(r) = self.state.dictionary.place(Slot::P) {
            self.state.pivot(r, c, step);
        } else {
            self.state.dictionary.advance(&self.state.column, step);
        }
        self.driver = Slot::P;
        self.state.fresh = false;
    }

    /// The rate of t along the present column and its natural size; `None`: so far above the noise that its last digits
    /// decide nothing.
    fn faint_t_rate(&self, c: usize) -> Option<(f64, f64)> {
        let state = &self.state;
        if self.driver == Slot::P {
            return None;
        }
        let rate = state.dictionary.rate(Slot::P, c, &state.column);
        let size = state.rate_size(Slot::P, state.rate_total(c), 0.0);
        (rate.abs() <= SUSPICIOUS * size).then_some((rate, size))
    }

    /// The rate of t along the present column, zero where it is noise. `recorded`: near the noise the direction at the
    /// last knot decides, its equations solved afresh; otherwise the column, which was refined before.
    fn t_rate(&self, c: usize, recorded: bool) -> f64 {
        let state = &self.state;
        let Some((faint, size)) = self.faint_t_rate(c) else {
            return state.dictionary.rate(Slot::P, c, &state.column);
        };
        let entering = state.variable(self.driver, false);
        let rate = match entering {
            Variable::W(k) | Variable::Z(k) if recorded => {
                direction(&state.lcp, &self.knot_basis(k), entering).map_or(faint, |d| d.p)
            }
            _ => faint,
        };
        if rate.abs() <= NOISE * size { 0.0 } else { rate }
    }

    fn ray(&self, c: usize) -> RayDirection {
        let mut ray = self.state.ray(c);
        let entering = ray.entering;
        ray.p = 0.0;
        let row = match entering {
            Variable::W(k) | Variable::Z(k) => k,
            Variable::P => return ray,
        };
        if let Some(fresh) = direction(&self.state.lcp, &self.knot_basis(row), entering) {
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

    /// Follows the path; `observer` is called after every pivot with t and may break. At the target it stands on the
    /// LCP of the target.
    pub fn follow(&mut self, reach: Reach, observer: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Path {
        let point = self.point_at(0.0).unwrap_or_else(|| self.state.point());
        let mut knots = Some(vec![Breakpoint {
            t: 0.0,
            point,
            leaving: Vec::new(),
            scheme: self.scheme.iter().copied().collect(),
        }]);
        let (end, pivots) = self.run(reach, &mut knots, observer);
        let mut knots = knots.unwrap_or_default();
        if !reach.through {
            // A path that ends at turning points never falls: events that come at one place are told apart by rounding.
            let mut reached: f64 = 0.0;
            for knot in &mut knots {
                reached = reached.max(knot.t);
                knot.t = reached;
            }
        }
        Path { knots, end, pivots }
    }

    /// As [`Parametric::follow`], without a record of the way: only its end and the number of pivots.
    pub fn walk(&mut self, reach: Reach, observer: &mut dyn FnMut(f64) -> ControlFlow<()>) -> (End, usize) {
        self.run(reach, &mut None, observer)
    }

    fn run(
        &mut self,
        reach: Reach,
        knots: &mut Option<Vec<Breakpoint>>,
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
            if observer(self.state.dictionary.value_of(Slot::P)).is_break() {
                break End::Interrupted;
            }
        };
        if end == End::Target {
            let lcp = Arc::make_mut(&mut self.state.lcp);
            lcp.q.axpy(reach.target, &lcp.covering, 1.0);
            for mirror in lcp.mirrors.iter_mut().flatten() {
                mirror.constant += reach.target * mirror.covering;
            }
        }
        (end, pivots)
    }

    /// One pivot, or the end.
    fn advance(
        &mut self,
        reach: Reach,
        knots: &mut Option<Vec<Breakpoint>>,
        met: &mut HashSet<(Vec<usize>, Variable)>,
    ) -> ControlFlow<End> {
        let lost = || ControlFlow::Break(End::Breakdown("the driving variable was lost".to_owned()));
        let singular = "the equations of the working scheme are singular";
        if !self.state.check_drift() {
            return ControlFlow::Break(End::Breakdown(singular.to_owned()));
        }
        let Some(c) = self.fetch() else {
            return lost();
        };
        if self.faint_t_rate(c).is_some() {
            // A dictionary that is off would let rows block that do not fall at all.
            if knots.is_some() && !self.state.fresh && self.state.refresh() {
                self.state.fetch(c);
            }
            self.state.refine_column(c);
        }
        let (mut tied, mut step) = self.blocking(c);
        // Where the target comes before any row that blocks, no rate near the noise decides anything.
        let raw = self.state.dictionary.rate(Slot::P, c, &self.state.column);
        let ends_here = reach.target.is_finite() && raw > 0.0 && (reach.target - self.state.p()).max(0.0) / raw <= step;
        if !ends_here && self.state.is_suspicious(c, &tied) && self.state.refine_if_doubtful(c, &tied) {
            (tied, step) = self.blocking(c);
        }
        let t_rate = self.t_rate(c, knots.is_some());
        let t = self.state.dictionary.value_of(Slot::P);
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
        if tied.is_empty() || t_rate == 0.0 && self.state.blocks_beyond_measure(c, &tied, step, BLURRED) {
            return ControlFlow::Break(if t_rate > 0.0 { End::Unbounded } else { End::Limit(self.ray(c)) });
        }
        let leaving = tied[self.choose(c, &tied)];
        let name = self.exchange(leaving, c, step, &tied);
        let row = match name {
            Variable::W(k) | Variable::Z(k) => k,
            Variable::P => return lost(),
        };
        let scheme = |engine: &Self| engine.scheme.iter().copied().collect::<Vec<usize>>();
        if step > 0.0 {
            met.clear();
            if let Some(knots) = knots {
                let point = self.knot(row);
                knots.push(Breakpoint { t: point.p, point, leaving: vec![name], scheme: scheme(self) });
            }
        } else {
            let scheme = scheme(self);
            if let Some(knot) = knots.as_mut().and_then(|knots| knots.last_mut()) {
                knot.leaving.push(name);
                knot.scheme.clone_from(&scheme);
            }
            if !met.insert((scheme, name)) {
                return ControlFlow::Break(End::Breakdown("a working scheme came back at the same load".to_owned()));
            }
        }
        ControlFlow::Continue(())
    }

    /// Ends at t = `end` after the last step.
    fn finish(&mut self, c: usize, step: f64, end: f64, knots: &mut Option<Vec<Breakpoint>>) {
        self.settle(c, step);
        let Some(knots) = knots else {
            return;
        };
        let mut point = self.point_at(end).unwrap_or_else(|| self.state.point());
        point.p = end;
        knots.push(Breakpoint { t: end, point, leaving: Vec::new(), scheme: self.scheme.iter().copied().collect() });
    }
}
