//! The answer followed over a friction coefficient: the intervals in which one working scheme holds, their ends by
//! safeguarded root search on the exact dependence (method §6).
//!
//! Within a scheme every variable is a rational function of f. Its values and slopes at both ends of a step and its
//! value in the middle tell whether a cubic stands for it; then a zero inside the step shows, and is found on the
//! function itself. Beyond a zero the scheme is the one that the LCP of the rates takes, so ties need no rule of
//! their own; where it finds none, there is no continuous way on and the answer jumps.
//!
//! A variable may be zero all along, but for its rounding: a slip that symmetry forbids. Where it seems to end a scheme
//! that is the one beyond all the same, its rounding is seen, and it counts as zero up to that from there on.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::change::{Breakpoint, changes};
use super::end::PathEnd;
use super::rate::{place_beside_laws, problem_rates, rate_lcp};
use super::standstill::{Rounding, Standstill, further};
use super::start::{PathError, ROUNDING, cold, final_basis, is_off_paths, plane_system, state_of};
use crate::answer::pairs::pair_states;
use crate::answer::record::PairState;
use crate::contact::lcp::contact_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::RowKind;
use crate::contact::system::ContactSystem;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::{direction_of_p, factored_vertex, vertex};
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Parametric, Reach};
use crate::model::jet::Dependence;
use crate::model::pair::Law;
use crate::model::parameter::{Number, ParameterValues};
use crate::model::rules::{Covering, Rules};
use crate::solve::problem::{contact_problem, factors};
use crate::solve::{Case, Prepared, Solved};

/// A variable below minus this multiple of the largest of its kind has gone through zero.
pub(super) const ZERO: f64 = 1e-12;
/// Steps and breakpoints of one path.
pub(super) const STEPS: usize = 20_000;

/// An interval in which one scheme holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// End nearer to the start of the path.
    pub from: f64,
    /// The other end.
    pub to: f64,
    /// The pairs halfway.
    pub pairs: Vec<PairState>,
}

/// A part of the path in one working scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct Scheme {
    /// End nearer to the start of the path.
    pub from: f64,
    /// The other end.
    pub to: f64,
    basis: Basis,
}

/// A followed path over friction.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionPath {
    /// The parameter.
    pub name: String,
    /// Where it starts.
    pub start: f64,
    /// The intervals, in the order of the path.
    pub intervals: Vec<Interval>,
    /// The breakpoints between them.
    pub breakpoints: Vec<Breakpoint>,
    /// Why it ends.
    pub end: PathEnd,
    /// The schemes in which it runs, in the order of the path.
    pub schemes: Vec<Scheme>,
    /// Places of the path for plots: value of the parameter and the pairs there.
    pub samples: Vec<(f64, Vec<PairState>)>,
}

impl FrictionPath {
    /// The pairs in a scheme of the path under `values`; `None` where its equations are singular.
    pub fn pairs_within(&self, prepared: &Prepared, values: &ParameterValues, scheme: usize) -> Option<Vec<PairState>> {
        let system = prepared.system()?;
        let factors = factors(prepared, values);
        let problem = contact_problem(system, &factors, values);
        let contact = contact_lcp(&problem, Covering::Ones).ok()?;
        let point = vertex(&contact.lcp, &self.schemes.get(scheme)?.basis)?;
        Some(pairs_of(prepared, &problem, &contact, &point))
    }

    /// How the path ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        self.end.sentence(&self.name, self.intervals.last().map_or(self.start, |last| last.to))
    }
}

/// The pairs at a vertex. Where its scheme ends a variable is zero to rounding, as far as the forces that it makes tell: below zero it
/// would be a slip to the other side.
fn pairs_of(prepared: &Prepared, problem: &ContactProblem, contact: &ContactLcp, point: &Point) -> Vec<PairState> {
    let mut state = state_of(problem, contact, point);
    if point.z.iter().any(|z| *z < 0.0) {
        let z = point.z.iter().map(|z| z.max(0.0)).collect();
        let clean = state_of(problem, contact, &Point { z, ..point.clone() });
        let forces = &problem.system.stiffness * (&clean.z - &state.z);
        if forces.amax() <= ROUNDING * problem.load.amax() {
            state = clean;
        }
    }
    let mut pairs = pair_states(problem, contact, &state);
    prepared.add_released_slips(&mut pairs, problem, &state.z);
    pairs
}

/// Whether a name is that of a parameter on which the friction of some pair depends, and not of a load case.
pub fn is_friction(Case { prepared, values, .. }: Case<'_>, name: &str) -> bool {
    let along = values.along(name);
    let is_case = prepared.cases.iter().any(|(case, _)| case == name);
    !is_case
        && prepared.system().is_some_and(|system| {
            let mut frictions = system.pairs.iter().filter_map(|pair| pair.law.friction());
            frictions.any(|friction| along.dependence(friction) != Dependence::Constant)
        })
}

pub(super) struct Follower<'a> {
    pub(super) case: Case<'a>,
    system: &'a Arc<ContactSystem>,
    pub(super) name: &'a str,
    factors: Vec<f64>,
    /// +1 upwards, −1 downwards.
    pub(super) sign: f64,
    rounding: Rounding,
}

/// The answer of a scheme at one value, with its slopes along the path.
pub(super) struct Place {
    pub(super) value: f64,
    problem: ContactProblem,
    contact: ContactLcp,
    point: Point,
    /// Signed distances from the limits, each relative to the largest of its kind; and their slopes per unit of
    /// path.
    pub(super) margins: Vec<f64>,
    pub(super) slopes: Vec<f64>,
    /// What each margin and slope is relative to.
    pub(super) sizes: Vec<f64>,
    /// The variables that end the scheme here, with a margin that was seen of each beyond.
    pub(super) fallen: Vec<(usize, f64)>,
}

impl Place {
    pub(super) fn ended_by(mut self, fallen: Vec<(usize, f64)>) -> Place {
        self.fallen = fallen;
        self
    }
}

/// Where the path goes on in another scheme, and whether it jumped there.
struct Onward {
    basis: Basis,
    place: Place,
    jump: bool,
}

/// Follows the answer over a friction parameter from its present value.
///
/// # Errors
/// See [`PathError`].
pub fn trace(case: Case<'_>, solved: Option<&Solved>, name: &str, to: f64) -> Result<FrictionPath, PathError> {
    let Case { prepared, values, .. } = case;
    let system = plane_system(prepared, "trace", "at the prompt it follows Coulomb's cone")?;
    let start = start_of(case, name, to)?;
    let sign = if to < start { -1.0 } else { 1.0 };
    let factors = factors(prepared, values);
    let mut follower = Follower { case, system, name, factors, sign, rounding: Rounding::default() };
    let mut path = FrictionPath {
        name: name.to_owned(),
        start,
        intervals: Vec::new(),
        breakpoints: Vec::new(),
        end: PathEnd::Target,
        schemes: Vec::new(),
        samples: Vec::new(),
    };
    let basis = match solved.and_then(final_basis) {
        Some(basis) => basis,
        None => {
            let found = cold(&follower.problem_at(start), case.watch)?;
            let (how, name) = (found.how().to_owned(), name.to_owned());
            found.basis.ok_or_else(|| match solved.is_some_and(is_off_paths) {
                true => PathError::OffPaths { name, at: start },
                false => PathError::NoStart { name, at: start, how },
            })?
        }
    };
    follower.follow(&mut path, basis, to)?;
    Ok(path)
}

/// The present value of a friction parameter that can be followed to another.
///
/// # Errors
/// It moves something else as well; a value that it cannot take.
pub(super) fn start_of(case: Case<'_>, name: &str, to: f64) -> Result<f64, PathError> {
    let Case { scenario, prepared, values, .. } = case;
    let system = prepared.system().ok_or(PathError::Plain("trace"))?;
    let mixed = |why: String| PathError::Mixed { name: name.to_owned(), why };
    if let Some(why) = place_beside_laws(scenario, name) {
        return Err(mixed(why));
    }
    let along = values.along(name);
    let moves = |number: &Number| along.dependence(number) != Dependence::Constant;
    let others = |law: &Law| law.numbers().into_iter().any(|(key, number)| key != "friction" && moves(number));
    if system.pairs.iter().any(|pair| others(&pair.law)) || prepared.cases.iter().any(|(_, factor)| moves(factor)) {
        return Err(mixed(
            "it is a friction coefficient and something else as well; give them parameters of their own".to_owned(),
        ));
    }
    let mut at_target = values.clone();
    at_target.insert(name.to_owned(), to);
    if let Some(refusal) = scenario.refusal(name, to).or_else(|| scenario.law_refusal(&at_target)) {
        return Err(PathError::Target(refusal));
    }
    // `is_friction` holds for a parameter of the scenario only.
    Ok(values.get(name).copied().unwrap_or_default())
}

impl Follower<'_> {
    fn values(&self, value: f64) -> ParameterValues {
        let mut values = self.case.values.clone();
        values.insert(self.name.to_owned(), value);
        values
    }

    fn problem_at(&self, value: f64) -> ContactProblem {
        contact_problem(self.system, &self.factors, &self.values(value))
    }

    /// d(numbers)/dθ at a value: an expression has a different rate everywhere.
    fn rates(&self, value: f64) -> ContactProblem {
        problem_rates(self.case.prepared, self.system, &self.values(value), self.name, &[])
    }

    pub(super) fn place(&self, value: f64, basis: &Basis) -> Option<Place> {
        let problem = self.problem_at(value);
        let contact = contact_lcp(&problem, Covering::Ones).ok()?;
        let (point, factor) = factored_vertex(&contact.lcp, basis)?;
        let lcp = rate_lcp(&problem, &contact, &point, &self.rates(value), self.sign);
        let slope = direction_of_p(&lcp, basis, &factor)?;
        let (margins, slopes, sizes, fallen) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut place = Place { value, margins, slopes, sizes, fallen, problem, contact, point };
        let largest = |values: &[f64]| {
            let size = values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            if size > 0.0 { size } else { 1.0 }
        };
        let (force, length) = (largest(&place.point.w), largest(&place.point.z));
        for (row, meaning) in place.contact.rows.iter().enumerate() {
            let is_active = basis.active.binary_search(&row).is_ok();
            // In an open pair without cohesion both reserves stay zero and the slip is free in sign.
            let free = meaning.couple != RowKind::Normal
                && place.problem.laws[meaning.pair].fixed_bound() == 0.0
                && place.contact.normal_row[meaning.pair]
                    .is_some_and(|normal| basis.active.binary_search(&normal).is_ok() != place.contact.swapped[normal]);
            let (margin, slope, size) = match (free, is_active) {
                (true, _) => (1.0, 0.0, 1.0),
                (_, true) => (place.point.z[row], slope.z[row], length),
                _ => (place.point.w[row], slope.w[row], force),
            };
            let (margin, slope) = (margin / size, slope / size);
            let (margin, slope) = if self.rounding.hides(row, margin) { (0.0, 0.0) } else { (margin, slope) };
            place.margins.push(margin);
            place.slopes.push(slope);
            place.sizes.push(size);
        }
        (place.margins.iter().chain(&place.slopes)).all(|value| value.is_finite()).then_some(place)
    }

    pub(super) fn pairs(&self, place: &Place) -> Vec<PairState> {
        pairs_of(self.case.prepared, &place.problem, &place.contact, &place.point)
    }

    fn follow(&mut self, path: &mut FrictionPath, mut basis: Basis, to: f64) -> Result<(), PathError> {
        let mut here = self.place(path.start, &basis).ok_or_else(|| self.singular(path.start))?;
        // The start may stand exactly on a limit.
        if let Ok(next) = self.scheme_beyond(&here, &basis)
            && let Some(place) = self.place(here.value, &next)
        {
            basis = next;
            here = place;
        }
        let mut jump = false;
        let mut standstill = Standstill::default();
        for _ in 0..STEPS {
            let from = here.value;
            let reached = self.to_end_of_scheme(path, here, &basis, to, jump)?;
            if reached.value == to {
                return Ok(());
            }
            let Some(next) = self.beyond(&reached, &basis, to)? else {
                path.end = self.end_beside(self.beside(reached.value, to))?;
                return Ok(());
            };
            if standstill.is_met_again(std::mem::replace(&mut basis, next.basis), from, reached.value, &basis) {
                self.rounding.learn(&reached.fallen);
            }
            (here, jump) = (next.place, next.jump);
        }
        Err(PathError::Breakdown {
            name: self.name.to_owned(),
            at: path.intervals.last().map_or(path.start, |last| last.to),
            why: format!("more than {STEPS} breakpoints"),
        })
    }

    fn singular(&self, at: f64) -> PathError {
        let why = "the equations of the working scheme are singular".to_owned();
        PathError::Breakdown { name: self.name.to_owned(), at, why }
    }

    /// Goes on to where the scheme ends, or to the target, and puts that part of the path on record; `jump` says how it
    /// was entered.
    fn to_end_of_scheme(
        &self,
        path: &mut FrictionPath,
        here: Place,
        basis: &Basis,
        to: f64,
        jump: bool,
    ) -> Result<Place, PathError> {
        let from = here.value;
        let first = path.samples.len();
        path.samples.push((from, self.pairs(&here)));
        let reached = self.to_next_zero(here, basis, to, path)?;
        let middle = 0.5 * (from + reached.value);
        path.schemes.push(Scheme { from, to: reached.value, basis: basis.clone() });
        let halfway = self.place(middle, basis).ok_or_else(|| self.singular(middle))?;
        let pairs = self.pairs(&halfway);
        if path.samples.len() == first + 1 {
            path.samples.push((middle, pairs.clone()));
        }
        path.samples.push((reached.value, self.pairs(&reached)));
        if let Some(last) = path.intervals.last_mut() {
            let changes = changes(&last.pairs, &pairs);
            if !changes.is_empty() {
                // The scheme before ended at this value, too.
                let place = if first > 0 && path.samples[first - 1].0 == from { first - 1 } else { first };
                path.breakpoints.push(Breakpoint::new(from, place, changes, jump));
            } else if path.breakpoints.last().is_none_or(|last| last.value != from) {
                // Nothing that a pair shows changed here.
                last.to = reached.value;
                return Ok(reached);
            }
        }
        path.intervals.push(Interval { from, to: reached.value, pairs });
        Ok(reached)
    }

    /// The scheme beyond the end of one: that to which the rates lead, else that of a cold answer a little further on;
    /// `None` where there is no answer.
    fn beyond(&self, end: &Place, basis: &Basis, to: f64) -> Result<Option<Onward>, PathError> {
        let beside = self.beside(end.value, to);
        // A scheme that holds to first order may fail at once: then it is not the next one.
        let holds = |place: &Place| place.margins.iter().all(|margin| *margin >= -1e-7);
        let next = self.scheme_beyond(end, basis).ok().filter(|next| next != basis);
        if let Some(next) = next.filter(|next| self.place(beside, next).is_some_and(|place| holds(&place))) {
            let place = self.place(end.value, &next).ok_or_else(|| self.singular(end.value))?;
            return Ok(Some(Onward { basis: next, place, jump: false }));
        }
        let found = cold(&self.problem_at(beside), self.case.watch)?;
        let Some(next) = found.basis else { return Ok(None) };
        let place = self.place(beside, &next).ok_or_else(|| self.singular(beside))?;
        let jump = self.differs(end, &place);
        // The interval starts at the breakpoint where the new scheme holds there too.
        let place = self.place(end.value, &next).filter(holds).unwrap_or(place);
        Ok(Some(Onward { basis: next, place, jump }))
    }

    /// The end of a path beyond which no pivots lead to an answer: whether a run of its own, with all its retries, finds one.
    fn end_beside(&self, beside: f64) -> Result<PathEnd, PathError> {
        let there = self.case.at(self.name, beside)?;
        let found = there.case(self.case).under(Rules::default()).solve_pairs()?;
        Ok(if found.answer.is_answer() { PathEnd::AnswerBeyond(beside) } else { PathEnd::NoAnswer })
    }

    /// A value a little further on.
    fn beside(&self, value: f64, to: f64) -> f64 {
        let beyond = value + self.sign * further(value);
        if self.sign > 0.0 { beyond.min(to) } else { beyond.max(to) }
    }

    fn differs(&self, a: &Place, b: &Place) -> bool {
        let z = |place: &Place| state_of(&place.problem, &place.contact, &place.point).z;
        let (a, b) = (z(a), z(b));
        (&a - &b).amax() > 1e-6 * a.amax().max(b.amax())
    }

    /// The scheme just beyond a place, from the LCP of the rates there.
    fn scheme_beyond(&self, place: &Place, basis: &Basis) -> Result<Basis, ()> {
        let rates = self.rates(place.value);
        let lcp = rate_lcp(&place.problem, &place.contact, &place.point, &rates, self.sign);
        let order = place.contact.lexicographic_order();
        let mut engine = Parametric::new(Arc::new(lcp), basis, order).ok_or(())?;
        let reach = Reach {
            // Only the changes at the place itself: any step at all reaches this.
            target: 1e-13 * place.value.abs().max(1e-3),
            through: false,
            pivots: super::start::PIVOTS,
        };
        let path = engine.follow(reach, &mut |_| ControlFlow::Continue(()));
        match path.end {
            End::Target => Ok(path.last_scheme()),
            _ => Err(()),
        }
    }
}
