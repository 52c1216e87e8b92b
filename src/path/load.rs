//! The answer followed over the factor of a load case: every breakpoint exact, the end a target, a turning point or
//! the limit load (method §6).

use std::sync::Arc;

use nalgebra::DVector;

use super::beside::{BESIDE, Beside, no_limit, search, size};
use super::change::{Breakpoint, changes};
use super::end::PathEnd;
use super::load_parameter::LoadParameter;
use super::start::{PIVOTS, PathError, cold, final_basis, finite_target, is_off_paths, plane_system, state_of};
use crate::answer::pairs::pair_states;
use crate::answer::record::PairState;
use crate::contact::load_path::{is_answer, path_lcp};
use crate::contact::problem::ContactProblem;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Parametric, Path, Reach};
use crate::lcp::problem::NOISE;
use crate::solve::problem::{contact_problem, factors};
use crate::solve::{Case, Prepared, Solved};
use crate::text::words::short;
use crate::watch::Watch;

/// A followed load path. Between two knots everything is affine in the factor.
#[derive(Clone, Debug)]
pub struct LoadPath {
    /// What was varied.
    pub parameter: LoadParameter,
    /// Factor where it starts.
    pub start: f64,
    /// Whether it starts from factor 0 because the present state is no answer, or one that no path starts from …
    pub from_zero: bool,
    /// … and whether it is the latter.
    pub is_present_off_paths: bool,
    /// Factors of the knots, in the order of the path.
    pub factors: Vec<f64>,
    /// The pairs at each knot.
    pub pairs: Vec<Vec<PairState>>,
    /// The breakpoints.
    pub breakpoints: Vec<Breakpoint>,
    /// Why it ends.
    pub end: PathEnd,
    /// Pivots made.
    pub pivots: usize,
    /// The knots and schemes, dimensionless.
    path: Path,
    /// The geometry with the cases that loads grow by, where the parameter stands in the loads themselves.
    grown: Option<Arc<Prepared>>,
    contact: ContactLcp,
    start_problem: ContactProblem,
    all_factors: Vec<f64>,
    direction: DVector<f64>,
    sign: f64,
    /// The run just beyond its end, where nothing resists the motion in which it ends.
    pub(super) beside_end: Option<Arc<Beside>>,
}

/// What to follow and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadReach {
    /// Factor to reach; `None`: as far as it goes, upwards; −∞: downwards.
    pub to: Option<f64>,
    /// Whether to go on at turning points.
    pub through: bool,
}

/// Follows the answer over a load.
///
/// Starts from `solved` where that is an answer, else from factor 0.
///
/// # Errors
/// See [`PathError`].
pub fn trace(case: Case<'_>, solved: Option<&Solved>, name: &str, reach: LoadReach) -> Result<LoadPath, PathError> {
    let (parameter, grown) = LoadParameter::find(case, name)?;
    let Case { values, watch, .. } = case;
    let prepared = grown.as_deref().unwrap_or(case.prepared);
    let system = plane_system(prepared, "trace", "at the prompt it follows Coulomb's cone")?;
    finite_target(name, reach.to)?;
    let mut all_factors = factors(prepared, values);
    let direction = parameter.direction(system);
    if direction.amax() == 0.0 {
        return Err(PathError::Idle(parameter.name));
    }
    let present = solved.and_then(final_basis);
    let from_zero = present.is_none();
    let start = if from_zero { 0.0 } else { parameter.present };
    if from_zero {
        parameter.drive(&mut all_factors, start);
    }
    let problem = contact_problem(system, &all_factors, values);
    let sign = match reach.to {
        Some(to) if to < start => -1.0,
        _ => 1.0,
    };
    // The matrices of many pairs take a second: of several loads that are followed, those after a stop do not begin.
    if watch.stop() {
        return Err(PathError::Interrupted);
    }
    let contact = path_lcp(&problem, &(sign * &direction));
    let (mut engine, from_zero) = match engine(&contact, present.as_ref()) {
        Some(engine) => (engine, from_zero),
        None => {
            let found = cold(&problem, watch)?;
            let engine = engine_of(&contact, found.basis.as_ref());
            let engine = engine.ok_or_else(|| PathError::NoStart {
                name: name.to_owned(),
                at: start,
                how: found.how().to_owned(),
            })?;
            (engine, from_zero)
        }
    };
    let target = reach.to.map_or(f64::INFINITY, |to| (to - start).abs());
    let path = engine.follow(Reach { target, through: reach.through, pivots: PIVOTS }, &mut |t| {
        let fraction = if target.is_finite() { t / target } else { 0.0 };
        watch.progress(&format!("{name} = {}", short(start + sign * t)), fraction);
        watch.go_on()
    });
    let at = start + sign * path.knots.last().map_or(0.0, |knot| knot.t);
    let end = match &path.end {
        End::Target => PathEnd::Target,
        End::Turning => PathEnd::Turning,
        End::Limit(ray) => PathEnd::Limit(ray.clone()),
        End::Unbounded => PathEnd::Unbounded,
        End::Returned => PathEnd::Returned,
        End::Interrupted => return Err(PathError::Interrupted),
        End::PivotLimit => {
            return Err(PathError::Breakdown {
                name: name.to_owned(),
                at,
                why: format!("the limit of {PIVOTS} pivots was reached"),
            });
        }
        End::Breakdown(why) => {
            return Err(PathError::Breakdown { name: name.to_owned(), at, why: why.clone() });
        }
    };
    let mut followed = LoadPath {
        parameter,
        start,
        from_zero,
        is_present_off_paths: solved.is_some_and(is_off_paths),
        factors: path.knots.iter().map(|knot| start + sign * knot.t).collect(),
        pairs: Vec::new(),
        breakpoints: Vec::new(),
        end,
        pivots: path.pivots,
        path,
        grown: grown.clone(),
        contact,
        start_problem: problem,
        all_factors,
        direction,
        sign,
        beside_end: None,
    };
    if followed.end == PathEnd::Target
        && let (Some(last), Some(to)) = (followed.factors.last_mut(), reach.to)
    {
        *last = to;
    }
    followed.look_beyond(case)?;
    followed.describe(prepared, watch)?;
    Ok(followed)
}

fn engine(contact: &ContactLcp, basis: Option<&Basis>) -> Option<Parametric> {
    let basis = basis?;
    if !is_answer(&contact.lcp, basis) {
        return None;
    }
    engine_of(contact, Some(basis))
}

fn engine_of(contact: &ContactLcp, basis: Option<&Basis>) -> Option<Parametric> {
    Parametric::new(Arc::clone(&contact.lcp), basis?, contact.lexicographic_order())
}

/// a + s (b − a), exact at both ends; zero where both are.
fn between(a: &Point, b: &Point, s: f64) -> Point {
    let mix = |a: &[f64], b: &[f64]| -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| if s == 1.0 { *b } else { a + s * (b - a) }).collect()
    };
    Point { z: mix(&a.z, &b.z), w: mix(&a.w, &b.w), p: a.p + s * (b.p - a.p) }
}

impl LoadPath {
    /// The problem at a factor.
    pub fn problem_at(&self, factor: f64) -> ContactProblem {
        let mut problem = self.start_problem.clone();
        problem.add_load(factor - self.start, &self.direction, &self.direction.abs());
        problem.factors = self.case_factors(factor);
        problem
    }

    /// The factors of all cases at a factor of the followed one; after them those of what loads grow by.
    pub fn case_factors(&self, factor: f64) -> Vec<f64> {
        let mut all = self.all_factors.clone();
        self.parameter.drive(&mut all, factor);
        all
    }

    /// The limit factor, without a unit, where the path ends in one; one that is rounding beside the present value is 0.
    pub fn limit(&self) -> Option<f64> {
        let last = self.factors.last().copied().filter(|_| matches!(self.end, PathEnd::Limit(_)));
        last.map(|factor| if factor.abs() <= NOISE * self.parameter.present.abs() { 0.0 } else { factor })
    }

    /// A run of its own at a factor.
    pub(super) fn run_at(&self, case: Case<'_>, factor: f64) -> Result<Beside, PathError> {
        Beside::run(&self.parameter, self.moves_loads(), case, factor)
    }

    /// Looks just beyond a path in whose last motion nothing resists: where there is an answer all the same its end is no
    /// limit.
    fn look_beyond(&mut self, case: Case<'_>) -> Result<(), PathError> {
        let Some(factor) = self.limit() else { return Ok(()) };
        let outwards = self.last_rise() * BESIDE * size(factor, self.parameter.present);
        let beyond = self.run_at(case, factor + outwards)?;
        if beyond.is_plain_answer() {
            self.end = PathEnd::AnswerBeyond(beyond.value);
        }
        self.beside_end = Some(Arc::new(beyond));
        Ok(())
    }

    /// The sign of the last change of the factor, which falls beyond a turning point: from the last knot that is not only
    /// by rounding away from the end. The last events of a path often come at one place, told apart by rounding alone.
    fn last_rise(&self) -> f64 {
        let Some((&end, before)) = self.factors.split_last() else { return self.sign };
        let rounding = NOISE * size(end, self.parameter.present);
        let last = before.iter().rev().map(|factor| end - factor).find(|change| change.abs() > rounding);
        last.map_or(self.sign, f64::signum)
    }

    /// The LCP the path runs in and the row names of its points.
    pub fn contact(&self) -> &ContactLcp {
        &self.contact
    }

    fn pairs_of(&self, prepared: &Prepared, point: &Point) -> Vec<PairState> {
        let factor = self.start + self.sign * point.p;
        let problem = self.problem_at(factor);
        let state = state_of(&problem, &self.contact, point);
        let mut pairs = pair_states(&problem, &self.contact, &state);
        prepared.add_released_slips(&mut pairs, &problem, &state.z);
        pairs
    }

    /// The geometry in which the path runs: that given, or where the parameter stands in the loads themselves the one
    /// with the cases that those grow by.
    pub fn ground<'p>(&'p self, prepared: &'p Prepared) -> &'p Prepared {
        self.grown.as_deref().unwrap_or(prepared)
    }

    /// The pairs at a factor between a knot and the next, in the geometry of [`LoadPath::ground`]; `None` where there is
    /// no such knot.
    pub fn pairs_within(&self, ground: &Prepared, knot: usize, factor: f64) -> Option<Vec<PairState>> {
        let ends = self.path.knots.get(knot..knot + 2)?;
        let t = self.sign * (factor - self.start);
        let length = ends[1].t - ends[0].t;
        let s = if length == 0.0 { 0.0 } else { ((t - ends[0].t) / length).clamp(0.0, 1.0) };
        Some(self.pairs_of(ground, &between(&ends[0].point, &ends[1].point, s)))
    }

    /// Whether the parameter stands in the loads themselves: other values of it need other load vectors.
    pub fn moves_loads(&self) -> bool {
        self.grown.is_some()
    }

    /// The pairs at a factor, where the path passes it first; `None` where it does not.
    pub fn pairs_at(&self, prepared: &Prepared, factor: f64) -> Option<Vec<PairState>> {
        let prepared = self.ground(prepared);
        let t = self.sign * (factor - self.start);
        let knots = &self.path.knots;
        let beyond = knots.last().is_some_and(|last| t > last.t);
        if beyond && self.end == PathEnd::Unbounded {
            let point = self.beyond(t)?;
            return Some(self.pairs_of(prepared, &point));
        }
        let segment = knots.windows(2).find(|ends| {
            let (low, high) = (ends[0].t.min(ends[1].t), ends[0].t.max(ends[1].t));
            (low..=high).contains(&t)
        });
        let point = match segment {
            Some([a, b]) => {
                let length = b.t - a.t;
                let s = if length == 0.0 { 0.0 } else { (t - a.t) / length };
                between(&a.point, &b.point, s)
            }
            _ => knots.first().filter(|only| only.t == t)?.point.clone(),
        };
        Some(self.pairs_of(prepared, &point))
    }

    /// The answer of the last scheme at t beyond the last knot.
    fn beyond(&self, t: f64) -> Option<Point> {
        let mut lcp = MirroredLcp::clone(&self.contact.lcp);
        lcp.q += t * &lcp.covering;
        let mut point = vertex(&lcp, &self.path.last_scheme())?;
        point.p = t;
        Some(point)
    }

    /// A point of the path just after its last knot, where it goes on.
    fn after_last(&self) -> Option<Point> {
        let last = self.path.knots.last()?;
        match &self.end {
            PathEnd::Limit(ray) => {
                let mut point = last.point.clone();
                let length = point.z.iter().fold(0.0, |a: f64, b| a.max(*b));
                let length = if length > 0.0 { length } else { 1.0 };
                for (z, rate) in point.z.iter_mut().zip(&ray.z) {
                    *z += length * rate;
                }
                for (w, rate) in point.w.iter_mut().zip(&ray.w) {
                    *w += length * rate;
                }
                Some(point)
            }
            PathEnd::Unbounded => self.beyond(2.0 * last.t.max(1.0)),
            _ => None,
        }
    }

    /// Pairs and breakpoints from the knots.
    fn describe(&mut self, prepared: &Prepared, watch: &dyn Watch) -> Result<(), PathError> {
        let knots = &self.path.knots;
        // Each is a product with R, and there are as many as pairs change their states.
        let read = |point: &Point| match watch.stop() {
            true => Err(PathError::Interrupted),
            false => Ok(self.pairs_of(prepared, point)),
        };
        let pairs: Vec<Vec<PairState>> = knots.iter().map(|knot| read(&knot.point)).collect::<Result<_, _>>()?;
        let between = knots.windows(2).map(|ends| between(&ends[0].point, &ends[1].point, 0.5));
        let halfway: Vec<Vec<PairState>> =
            between.chain(self.after_last()).map(|point| read(&point)).collect::<Result<_, _>>()?;
        self.pairs = pairs;
        for (k, after) in halfway.iter().enumerate() {
            let before = match k {
                0 => &self.pairs[0],
                _ => &halfway[k - 1],
            };
            let changes = changes(before, after);
            if changes.is_empty() {
                continue;
            }
            let at_constant_load = k > 0 && knots[k].t == knots[k - 1].t;
            self.breakpoints.push(Breakpoint::new(self.factors[k], k, changes, at_constant_load));
        }
        Ok(())
    }

    /// How the path ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        let name = &self.parameter.name;
        let sentence = self.end.sentence(name, self.factors.last().copied().unwrap_or(self.start));
        match self.end.answer_beyond() {
            Some(beyond) => no_limit(&sentence, &self.search(beyond)),
            None => sentence,
        }
    }

    /// The command that looks for answers further on.
    fn search(&self, beyond: f64) -> String {
        let name = &self.parameter.name;
        let is_way_of_limit = (self.sign < 0.0) == (self.parameter.present < 0.0);
        // Answers under another self-stress of joints that repeat one another are followed there.
        if self.start_problem.system.repeats_joints() && is_way_of_limit {
            return format!("`limit {name}`");
        }
        search(name, beyond, beyond - self.start)
    }
}
