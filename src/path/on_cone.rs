//! The answer in space followed over a load or over friction, on Coulomb's cone.
//!
//! Directions of slip turn on the way, so that nothing is affine between two breakpoints: the way is taken in steps, each
//! an answer of its own that Newton's method finds from the one before. Where pairs do something else at the end of a step the
//! place is searched for between its ends. Every place of the path is freshly checked; that none was overlooked between two of
//! them is not proved.

use std::sync::Arc;

use nalgebra::DVector;

use super::change::{Breakpoint, between, sentence, with_directions};
use super::cone_step::{Step, Stepper};
use super::end::PathEnd;
use super::load::LoadReach;
use super::load_parameter::LoadParameter;
use super::start::PathError;
use super::{friction, start};
use crate::answer::pairs::pairs_in_space;
use crate::answer::record::{PairState, State};
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::explain::certificate::certify;
use crate::explain::motions::FreeMotions;
use crate::explain::ray::{RayReport, explain};
use crate::model::rules::{Covering, Rules};
use crate::solve::problem::{contact_problem, factors};
use crate::solve::{Case, Prepared, Solved};
use crate::text::words::short;

/// Steps to a target: between two of them a pair may do something and undo it unseen.
const STEPS: f64 = 64.0;
/// Without a target each step is longer than the one before by this factor …
const GROWTH: f64 = 1.5;
/// … up to this multiple of the size of the load at the start.
const MOST: f64 = 1e9;
/// A breakpoint is located to this share of the range.
const HERE: f64 = 1e-12;
/// No answer near so close ahead is none at all.
const CLOSE: f64 = 1e-9;
/// Where none is near, another answer, or a certified collapse, is looked for this share of the range further on.
const BEYOND: f64 = 1e-7;
/// No path has more steps than this.
const MOST_STEPS: usize = 20_000;
/// Across a breakpoint displacements that change by more than this share of the largest have jumped.
const JUMP: f64 = 1e-5;

/// A place of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Of what is followed.
    pub value: f64,
    /// Factor of every load case; none on a path over friction.
    pub factors: Vec<f64>,
    /// The pairs.
    pub pairs: Vec<PairState>,
}

/// A path in space.
#[derive(Clone, Debug, PartialEq)]
pub struct ConePath {
    /// The load case or parameter.
    pub name: String,
    /// Whether it is followed over friction.
    pub over_friction: bool,
    /// Where it starts.
    pub start: f64,
    /// Whether it starts from factor 0 because the present state is no answer.
    pub from_zero: bool,
    /// The places, in order.
    pub places: Vec<Place>,
    /// The breakpoints: each at the place before the change.
    pub breakpoints: Vec<Breakpoint>,
    /// Why it ends.
    pub end: PathEnd,
}

impl ConePath {
    /// The value at its end.
    pub fn last(&self) -> f64 {
        self.places.last().map_or(self.start, |last| last.value)
    }

    /// The limit, where it ends in one.
    pub fn limit(&self) -> Option<f64> {
        matches!(self.end, PathEnd::Collapse(_)).then(|| self.last())
    }

    /// How it ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        self.end.sentence(&self.name, self.last())
    }
}

/// The contact system of a problem whose answer in space can be followed.
fn system_of(prepared: &Prepared, rules: Rules) -> Result<&Arc<ContactSystem>, PathError> {
    let system = prepared.system().ok_or(PathError::Plain("trace"))?;
    if let Some(refusal) = system.dependence_refusal("trace") {
        return Err(PathError::Missing(refusal));
    }
    match rules.cone {
        true => Ok(system),
        false => Err(PathError::Missing(
            "in space answers are followed on Coulomb's cone: `set cone on` (`solver.cone`: true) first".to_owned(),
        )),
    }
}

/// Follows the answer over a load.
///
/// # Errors
/// See [`PathError`].
pub fn trace_load(
    case: Case<'_>,
    solved: Option<&Solved>,
    name: &str,
    reach: LoadReach,
) -> Result<ConePath, PathError> {
    if reach.through {
        return Err(PathError::Target(
            "`--through` works in the plane only: in space a path ends where no answer is near".to_owned(),
        ));
    }
    let (parameter, grown) = LoadParameter::find(case, name)?;
    let prepared = grown.as_deref().unwrap_or(case.prepared);
    let system = system_of(prepared, case.rules)?;
    if parameter.direction(system).amax() == 0.0 {
        return Err(PathError::Idle(parameter.name));
    }
    start::finite_target(name, reach.to)?;
    let all = factors(prepared, case.values);
    let factors_at = |value: f64| {
        let mut all = all.clone();
        parameter.drive(&mut all, value);
        all
    };
    let shown = solved.filter(|solved| solved.stands(true));
    let start = if shown.is_some() { parameter.present } else { 0.0 };
    let own = case.prepared.cases.len();
    let path = Path {
        case: Case { prepared, ..case },
        name,
        over_friction: false,
        problem: &|value| contact_problem(system, &factors_at(value), case.values).under(case.rules),
        factors: &|value| factors_at(value).into_iter().take(own).collect(),
    };
    path.follow(shown, start, reach.to)
}

/// Follows the answer over a friction parameter from its present value.
///
/// # Errors
/// See [`PathError`].
pub fn trace_friction(case: Case<'_>, solved: Option<&Solved>, name: &str, to: f64) -> Result<ConePath, PathError> {
    let system = system_of(case.prepared, case.rules)?;
    let start = friction::start_of(case, name, to)?;
    let path = Path {
        case,
        name,
        over_friction: true,
        problem: &|value| {
            let mut values = case.values.clone();
            values.insert(name.to_owned(), value);
            contact_problem(system, &factors(case.prepared, &values), &values).under(case.rules)
        },
        factors: &|_| Vec::new(),
    };
    path.follow(solved.filter(|solved| solved.stands(true)), start, Some(to))
}

/// What is followed.
struct Path<'a> {
    case: Case<'a>,
    name: &'a str,
    over_friction: bool,
    /// The problem at a value.
    problem: &'a dyn Fn(f64) -> ContactProblem,
    /// The factors that are told of a place.
    factors: &'a dyn Fn(f64) -> Vec<f64>,
}

/// A value with its answer.
struct Stand {
    value: f64,
    step: Step,
}

/// What lies behind the end of what Newton's method follows.
enum Beyond {
    Jump(Stand),
    End(PathEnd),
}

impl Path<'_> {
    fn follow(&self, shown: Option<&Solved>, start: f64, to: Option<f64>) -> Result<ConePath, PathError> {
        let stepper = Stepper::new(self.case.rules.facets, self.case.watch);
        let mut here = self.begin(&stepper, shown, start)?;
        let mut path = ConePath {
            name: self.name.to_owned(),
            over_friction: self.over_friction,
            start,
            from_zero: shown.is_none() && !self.over_friction,
            places: vec![self.place(&here)],
            breakpoints: Vec::new(),
            end: PathEnd::Target,
        };
        let (target, sign) = match to {
            Some(to) if to == f64::NEG_INFINITY => (None, -1.0),
            Some(to) => (Some(to), if to < start { -1.0 } else { 1.0 }),
            None => (None, 1.0),
        };
        let size = target.map_or(if start == 0.0 { 1.0 } else { start.abs() }, |to| (to - start).abs());
        let (mut length, mut steps) = (size / STEPS, 0);
        let mut slope: Option<DVector<f64>> = None;
        while target.is_none_or(|to| here.value != to) {
            let fraction = if target.is_some() { (here.value - start).abs() / size } else { 0.0 };
            self.case.watch.progress(&format!("{} = {}", self.name, short(here.value)), fraction);
            if self.case.watch.stop() {
                return Err(PathError::Interrupted);
            }
            steps += 1;
            if steps > MOST_STEPS {
                return Err(self.breakdown(here.value, format!("the limit of {MOST_STEPS} steps was reached")));
            }
            if target.is_none() && (here.value - start).abs() > MOST * size {
                path.end = PathEnd::Unbounded;
                break;
            }
            let to = match target {
                Some(to) if (to - here.value).abs() <= length * (1.0 + 1e-9) => to,
                _ => here.value + sign * length,
            };
            let guess = guess(&here, slope.as_ref(), to);
            let next = match self.near(&stepper, to, &guess)? {
                Some(next) => next,
                None if length > CLOSE * size.max(here.value.abs()) => {
                    length *= 0.5;
                    continue;
                }
                None => match self.beyond(&stepper, &here, sign * size.max(here.value.abs()))? {
                    Beyond::Jump(next) => {
                        self.change(&mut path, &here, &next, true);
                        (here, slope, length) = (next, None, size / STEPS);
                        continue;
                    }
                    Beyond::End(end) => {
                        path.end = end;
                        break;
                    }
                },
            };
            if next.step.scheme == here.step.scheme {
                slope = Some((&next.step.z - &here.step.z) / (next.value - here.value));
                here = next;
                path.places.push(self.place(&here));
            } else {
                let size = next.step.z.amax().max(here.step.z.amax());
                let [before, after] = self.narrowed(&stepper, here, next)?;
                if path.places.last().is_some_and(|last| last.value != before.value) {
                    path.places.push(self.place(&before));
                }
                let moved = (&after.step.z - &before.step.z).amax();
                self.change(&mut path, &before, &after, moved > JUMP * size);
                (here, slope) = (after, None);
            }
            length = match target {
                Some(_) => (2.0 * length).min(size / STEPS),
                None => GROWTH * length,
            };
        }
        Ok(path)
    }

    /// The answer at the start: the one that is shown, or that of a polygon.
    fn begin(&self, stepper: &Stepper<'_>, shown: Option<&Solved>, start: f64) -> Result<Stand, PathError> {
        let problem = (self.problem)(start);
        if let Some(solved) = shown {
            let z = displacements(&problem, &solved.answer.pairs);
            if let Some(found) = self.near(stepper, start, &z)? {
                return Ok(found);
            }
        }
        let none = DVector::zeros(problem.system.joint_count());
        match stepper.anywhere(problem, &none)? {
            Ok(step) => Ok(Stand { value: start, step }),
            Err(_) => Err(PathError::NoStart {
                name: self.name.to_owned(),
                at: start,
                how: "without an answer on Coulomb's cone".to_owned(),
            }),
        }
    }

    fn near(&self, stepper: &Stepper<'_>, value: f64, guess: &DVector<f64>) -> Result<Option<Stand>, PathError> {
        let none = DVector::zeros(guess.len());
        let found = stepper.near((self.problem)(value), &none, guess)?;
        Ok(found.map(|step| Stand { value, step }))
    }

    /// The two places between which the scheme of the first ends.
    fn narrowed(&self, stepper: &Stepper<'_>, before: Stand, after: Stand) -> Result<[Stand; 2], PathError> {
        let (mut before, mut after) = (before, after);
        let digits = HERE * after.value.abs().max(before.value.abs());
        while (after.value - before.value).abs() > digits {
            let middle = 0.5 * (before.value + after.value);
            if middle == before.value || middle == after.value {
                break;
            }
            let guess = (&before.step.z + &after.step.z) * 0.5;
            match self.near(stepper, middle, &guess)? {
                Some(found) if found.step.scheme == before.step.scheme => before = found,
                Some(found) => after = found,
                // No answer between two: the last of the first scheme is where the path breaks.
                None => break,
            }
        }
        Ok([before, after])
    }

    /// What lies beyond a value near which there is no further answer.
    fn beyond(&self, stepper: &Stepper<'_>, here: &Stand, size: f64) -> Result<Beyond, PathError> {
        let value = here.value + BEYOND * size;
        let problem = (self.problem)(value);
        if let Ok(step) = stepper.anywhere(problem.clone(), &DVector::zeros(here.step.z.len()))? {
            return Ok(Beyond::Jump(Stand { value, step }));
        }
        let built = self.case.prepared.built();
        let Some(certificate) = certify(&problem, &FreeMotions::new(&problem.system, built)).certificate else {
            return Ok(Beyond::End(PathEnd::NoAnswer));
        };
        let mut report = RayReport::of_certificate(&problem, certificate);
        explain(&mut report, &problem, built);
        Ok(Beyond::End(PathEnd::Collapse(Box::new(report.record(&problem.system, Covering::default())))))
    }

    fn place(&self, stand: &Stand) -> Place {
        let problem = (self.problem)(stand.value);
        let mut pairs = pairs_in_space(&problem, &stand.step.increments);
        self.case.prepared.add_released_slips(&mut pairs, &problem, &stand.step.z);
        Place { value: stand.value, factors: (self.factors)(stand.value), pairs }
    }

    /// Tells what changes between two places, and adds the second.
    fn change(&self, path: &mut ConePath, before: &Stand, after: &Stand, jump: bool) {
        let there = self.place(after);
        let ids = there.pairs.iter().map(|pair| pair.id.as_str());
        let mut changes = between(ids, &before.step.scheme, &after.step.scheme);
        with_directions(&mut changes, &there.pairs);
        let place = path.places.len() - 1;
        if !jump {
            path.places[place].pairs.iter_mut().zip(&there.pairs).for_each(|(before, after)| settle(before, after));
        }
        if !changes.is_empty() || jump {
            let sentence = sentence(&changes);
            path.breakpoints.push(Breakpoint { value: after.value, place, changes, jump, sentence });
        }
        path.places.push(there);
    }

    fn breakdown(&self, at: f64, why: String) -> PathError {
        PathError::Breakdown { name: self.name.to_owned(), at, why }
    }
}

fn guess(here: &Stand, slope: Option<&DVector<f64>>, to: f64) -> DVector<f64> {
    slope.map_or_else(|| here.step.z.clone(), |slope| &here.step.z + slope * (to - here.value))
}

/// A pair that comes to rest at a breakpoint has there the slip that it keeps, and one that closes no gap: what is found of
/// them just before it comes of the digits to which the place is located.
fn settle(before: &mut PairState, after: &PairState) {
    if (before.state, after.state) == (State::Slip, State::Stick) {
        before.z_t = after.z_t;
        if let (Some(before), Some(after)) = (&mut before.space, &after.space) {
            before.z_t = after.z_t;
        }
    }
    if before.state == State::Open && after.state != State::Open {
        before.z_n = after.z_n;
    }
}

/// z over the joints as pairs show it.
fn displacements(problem: &ContactProblem, pairs: &[PairState]) -> DVector<f64> {
    let mut z = DVector::zeros(problem.system.joint_count());
    for (i, (pair, shown)) in problem.system.pairs.iter().zip(pairs).enumerate() {
        z[i] = shown.z_n;
        pair.tangential.clone().zip(shown.slip()).for_each(|(joint, slip)| z[joint] = slip);
    }
    z
}
