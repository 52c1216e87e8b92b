//! The answer in space followed over a load or over friction, on Coulomb's cone.
//!
//! Directions of slip turn on the way, so that nothing is affine between two breakpoints: the way is taken in steps,
//! each an answer of its own that Newton's method finds from the one before. Where pairs do something else at the end
//! of a step the place is searched for between its ends. Every place of the path is freshly checked; that none was
//! overlooked between two of them is not proved.

mod over;
mod stand;
mod unseen;

use nalgebra::DVector;

use self::over::Path;
use self::stand::Stand;
use super::change::{Breakpoint, between, sentence, with_directions};
use super::cone_step::Stepper;
use super::end::PathEnd;
use super::load::LoadReach;
use super::load_parameter::LoadParameter;
use super::start::PathError;
use super::{friction, start};
use crate::answer::record::{PairState, State};
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::explain::certificate::{certify, certify_again};
use crate::explain::motions::FreeMotions;
use crate::explain::proof::Certificate;
use crate::explain::ray::{RayReport, explain};
use crate::lcp::exact::dyadic::nearest;
use crate::model::rules::{Covering, Rules};
use crate::solve::{Case, Prepared, Solved};
use crate::text::words::short;

pub use self::over::Over;
pub use self::stand::Place;

/// Steps to a target: between two of them a pair may do something and undo it unseen.
const STEPS: f64 = 64.0;
/// Without a target each step is longer than the one before by this factor …
const GROWTH: f64 = 1.5;
/// … up to this multiple of the size of the load at the start.
const MOST: f64 = 1e9;
/// A breakpoint is located to this share of the range, and so is the end: no answer near so close ahead is none at all.
const HERE: f64 = 1e-12;
/// Where none is near, another answer, or a certified collapse, is looked for this share of the range further on.
const BEYOND: f64 = 1e-7;
/// No path has more steps than this.
const MOST_STEPS: usize = 20_000;
/// Across a breakpoint displacements that change by more than this share of the largest have jumped.
const JUMP: f64 = 1e-5;

/// A path in space.
#[derive(Clone, Debug)]
pub struct ConePath {
    /// The load case or parameter.
    pub name: String,
    /// What it is followed over.
    pub over: Over,
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
    /// Whether it ends in a collapse that goes on at every value up to the target: followed over a load.
    pub for_good: bool,
}

impl ConePath {
    /// The value at its end, of what it is followed over.
    pub fn last(&self) -> f64 {
        self.places.last().map_or(self.start, |last| last.value)
    }

    /// The limit, a value of what it is followed over, where it ends in one.
    pub fn limit(&self) -> Option<f64> {
        matches!(self.end, PathEnd::Collapse(_)).then(|| self.last())
    }

    /// How it ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        self.end.sentence(&self.name, self.last())
    }

    /// Indices of the places in each scheme, in order.
    fn schemes(&self) -> Vec<std::ops::Range<usize>> {
        let ends = self.breakpoints.iter().map(|at| at.place + 1).chain([self.places.len()]);
        let starts = std::iter::once(0).chain(self.breakpoints.iter().map(|at| at.place + 1));
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }

    /// The values between which one scheme holds, in the order of the path.
    pub fn stretches(&self) -> Vec<[f64; 2]> {
        // A scheme ends where the next begins.
        let value = |place: usize| self.places[place.min(self.places.len() - 1)].value;
        self.schemes().into_iter().map(|scheme| [value(scheme.start), value(scheme.end)]).collect()
    }

    /// The pairs at a value within a scheme, from the neighbouring places; `None` where there is no answer near.
    pub(super) fn pairs_within(&self, case: Case<'_>, scheme: usize, value: f64) -> Option<Vec<PairState>> {
        let places = &self.places[self.schemes().get(scheme)?.clone()];
        let (first, last) = (places.first()?, places.last()?);
        let sign = if last.value < first.value { -1.0 } else { 1.0 };
        let after = places.partition_point(|place| (value - place.value) * sign > 0.0).min(places.len() - 1);
        let [before, after] = [&places[after.saturating_sub(1)], &places[after]];
        if (value - after.value) * sign >= 0.0 {
            return Some(after.pairs.clone());
        }
        let path = Path::new(case, &self.name, &self.over);
        let problem = path.problem(value).ok()?;
        let [from, to] = [before, after].map(|place| displacements(&problem, &place.pairs));
        let way = after.value - before.value;
        let share = if way == 0.0 { 0.0 } else { (value - before.value) / way };
        let stepper = Stepper::new(case.rules.facets, case.watch);
        let found = path.near(&stepper, value, &(&from + (to - &from) * share)).ok()??;
        Some(found.place.pairs)
    }
}

/// Why the answer of a system in space cannot be followed; `None` where it can.
fn refusal(system: &ContactSystem, rules: Rules) -> Option<String> {
    let polygon = "in space answers are followed on Coulomb's cone: `set cone on` (`solver.cone`: true) first";
    system.dependence_refusal("trace").or_else(|| (!rules.cone).then(|| polygon.to_owned()))
}

/// Whether the answer of a problem in space can be followed.
pub(super) fn leads(prepared: &Prepared, rules: Rules) -> bool {
    prepared.system().is_some_and(|system| refusal(system, rules).is_none())
}

fn refuse(prepared: &Prepared, rules: Rules) -> Result<&ContactSystem, PathError> {
    let system = prepared.system().ok_or(PathError::Plain("trace"))?;
    refusal(system, rules).map_or(Ok(system), |why| Err(PathError::Missing(why)))
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
    let system = refuse(grown.as_deref().unwrap_or(case.prepared), case.rules)?;
    if parameter.direction(system).amax() == 0.0 {
        return Err(PathError::Idle(parameter.name));
    }
    start::finite_target(name, reach.to)?;
    let shown = solved.filter(|solved| solved.stands(true));
    let start = if shown.is_some() { parameter.present } else { 0.0 };
    let over = Over::Load(parameter, grown);
    Path::new(case, name, &over).follow(shown, start, reach.to)
}

/// Follows the answer over a friction parameter from its present value.
///
/// # Errors
/// See [`PathError`].
pub fn trace_friction(case: Case<'_>, solved: Option<&Solved>, name: &str, to: f64) -> Result<ConePath, PathError> {
    refuse(case.prepared, case.rules)?;
    let start = friction::start_of(case, name, to)?;
    Path::new(case, name, &Over::Friction).follow(solved.filter(|solved| solved.stands(true)), start, Some(to))
}

/// What lies beyond the end of what Newton's method follows.
enum Beyond {
    Jump(Box<Stand>),
    /// With [`ConePath::for_good`].
    End(PathEnd, bool),
}

/// How a path goes on.
#[derive(Clone, Copy)]
struct Aim {
    start: f64,
    /// `None`: as far as it goes.
    target: Option<f64>,
    sign: f64,
    /// What steps are measured by.
    size: f64,
}

impl Aim {
    fn new(start: f64, to: Option<f64>) -> Aim {
        let (target, sign) = match to {
            Some(to) if to == f64::NEG_INFINITY => (None, -1.0),
            Some(to) => (Some(to), if to < start { -1.0 } else { 1.0 }),
            None => (None, 1.0),
        };
        let size = target.map_or(if start == 0.0 { 1.0 } else { start.abs() }, |to| (to - start).abs());
        Aim { start, target, sign, size }
    }

    /// A length at a value that tells it from its neighbours.
    fn size_at(&self, value: f64) -> f64 {
        self.size.max(value.abs())
    }

    /// How far it is from a value to one ahead.
    fn way(&self, from: f64, to: f64) -> f64 {
        (to - from) * self.sign
    }

    /// The way from a value halfway to one where no answer was found; all of it where it is so short that what was
    /// not found from afar is looked for once more.
    fn halfway(&self, from: f64, lost: f64) -> f64 {
        let way = self.way(from, lost);
        if 0.5 * way > HERE * self.size_at(from) { 0.5 * way } else { way }
    }

    fn next(&self, value: f64, length: f64) -> f64 {
        match self.target {
            Some(to) if (to - value).abs() <= length * (1.0 + 1e-9) => to,
            _ => value + self.sign * length,
        }
    }
}

impl Path<'_> {
    fn follow(&self, shown: Option<&Solved>, start: f64, to: Option<f64>) -> Result<ConePath, PathError> {
        let stepper = Stepper::new(self.case.rules.facets, self.case.watch);
        let aim = Aim::new(start, to);
        let mut here = self.begin(&stepper, shown, start)?;
        let mut path = ConePath {
            name: self.name.to_owned(),
            over: self.over.clone(),
            start,
            from_zero: shown.is_none() && !self.over.is_friction(),
            places: vec![here.place.clone()],
            breakpoints: Vec::new(),
            end: PathEnd::Target,
            for_good: false,
        };
        let mut length = aim.size / STEPS;
        // The place before this one in its scheme.
        let mut before: Option<Stand> = None;
        // The nearest place ahead where none was found.
        let mut lost: Option<f64> = None;
        while aim.target.is_none_or(|to| here.value() != to) {
            self.goes_on(&aim, &here, &path)?;
            if aim.target.is_none() && (here.value() - start).abs() > MOST * aim.size {
                path.end = PathEnd::Unbounded;
                break;
            }
            let to = aim.next(here.value(), length);
            let mut next = self.near(&stepper, to, &guess(before.as_ref(), &here, to))?;
            if next.is_none() && length > HERE * aim.size_at(here.value()) {
                lost = Some(to);
                length *= 0.5;
                continue;
            }
            if let (Some(before), Some(found)) = (&before, &next)
                && found.step.scheme == here.step.scheme
                && let Some(dip) = self.unseen(&stepper, [before, &here, found])?
            {
                next = Some(dip.there);
                if dip.before {
                    path.places.pop();
                    here = before.clone();
                }
            }
            if let Some(next) = next.as_ref().filter(|next| next.step.scheme == here.step.scheme) {
                path.places.push(next.place.clone());
                before = Some(std::mem::replace(&mut here, next.clone()));
                length = match aim.target {
                    Some(_) => (2.0 * length).min(aim.size / STEPS),
                    None => GROWTH * length,
                };
                lost = lost.filter(|lost| aim.way(here.value(), *lost) > HERE * aim.size_at(here.value()));
                if let Some(lost) = lost {
                    length = length.min(aim.halfway(here.value(), lost));
                }
                continue;
            }
            // The size of z within the whole step: next to the place where a slip begins or ends, only a remainder of
            // it is seen.
            let size = next.as_ref().map_or(0.0, |next| next.step.z.amax()).max(here.step.z.amax());
            let (last, next) = match next {
                Some(next) => self.narrowed(&stepper, here, next)?,
                None => (here, None),
            };
            if path.places.last().is_some_and(|shown| shown.value != last.value()) {
                path.places.push(last.place.clone());
            }
            let (next, jump) = match next {
                Some(next) => {
                    let moved = (&next.step.z - &last.step.z).amax();
                    (next, moved > JUMP * size)
                }
                None => match self.beyond(&stepper, &last, &aim)? {
                    Beyond::Jump(next) => (*next, true),
                    Beyond::End(end, for_good) => {
                        (path.end, path.for_good) = (end, for_good);
                        break;
                    }
                },
            };
            change(&mut path, &last, &next, jump);
            (here, before, lost, length) = (next, None, None, aim.size / STEPS);
        }
        Ok(path)
    }

    /// Reports how far it is; whether it may go on.
    fn goes_on(&self, aim: &Aim, here: &Stand, path: &ConePath) -> Result<(), PathError> {
        let value = here.value();
        let fraction = if aim.target.is_some() { (value - aim.start).abs() / aim.size } else { 0.0 };
        self.case.watch.progress(&format!("{} = {}", self.name, short(value)), fraction);
        if self.case.watch.stop() {
            return Err(PathError::Interrupted);
        }
        if path.places.len() > MOST_STEPS {
            return Err(self.breakdown(value, format!("the limit of {MOST_STEPS} steps was reached")));
        }
        Ok(())
    }

    /// The answer at the start: the one that is shown, or that of a polygon.
    fn begin(&self, stepper: &Stepper<'_>, shown: Option<&Solved>, start: f64) -> Result<Stand, PathError> {
        let problem = self.problem(start)?;
        if let Some(solved) = shown {
            let z = displacements(&problem, &solved.answer.pairs);
            if let Some(found) = self.near(stepper, start, &z)? {
                return Ok(found);
            }
        }
        let none = DVector::zeros(problem.system.joint_count());
        match stepper.anywhere(problem, &none)? {
            Ok(step) => self.stand(start, step),
            Err(_) => Err(PathError::NoStart {
                name: self.name.to_owned(),
                at: start,
                how: "without an answer on Coulomb's cone".to_owned(),
            }),
        }
    }

    /// The two places between which the scheme of the first ends. The second is missing where no answer was found
    /// near the first.
    fn narrowed(
        &self,
        stepper: &Stepper<'_>,
        before: Stand,
        after: Stand,
    ) -> Result<(Stand, Option<Stand>), PathError> {
        let digits = HERE * after.value().abs().max(before.value().abs());
        let (mut before, mut high, mut after) = (before, after.value(), Some(after));
        while (high - before.value()).abs() > digits {
            let middle = 0.5 * (before.value() + high);
            if middle == before.value() || middle == high {
                break;
            }
            let guess = match &after {
                Some(after) => (&before.step.z + &after.step.z) * 0.5,
                None => before.step.z.clone(),
            };
            match self.near(stepper, middle, &guess)? {
                Some(found) if found.step.scheme == before.step.scheme => before = found,
                found => (high, after) = (middle, found),
            }
        }
        Ok((before, after))
    }

    /// What lies beyond a value near which there is no further answer.
    fn beyond(&self, stepper: &Stepper<'_>, here: &Stand, aim: &Aim) -> Result<Beyond, PathError> {
        let value = here.value() + BEYOND * aim.sign * aim.size_at(here.value());
        let problem = self.problem(value)?;
        if let Ok(step) = stepper.anywhere(problem.clone(), &DVector::zeros(here.step.z.len()))? {
            return Ok(Beyond::Jump(Box::new(self.stand(value, step)?)));
        }
        let built = self.case.prepared.built();
        let motions = FreeMotions::new(&problem.system, built);
        let Some(certificate) = certify(&problem, &motions).certificate else {
            return Ok(Beyond::End(PathEnd::NoAnswer, false));
        };
        let for_good = !self.over.is_friction() && self.goes_on_to(aim, &certificate, &motions)?;
        let mut report = RayReport::of_certificate(&problem, certificate);
        explain(&mut report, &problem, built);
        let collapse = PathEnd::Collapse(Box::new(report.record(&problem.system, Covering::default())));
        Ok(Beyond::End(collapse, for_good))
    }

    /// Whether a collapse goes on from its place up to the target. The loads that forces can balance at all are a
    /// convex set, which a path leaves once. What is proved of one load only goes on where its motion proves it at
    /// the target as well: work, normal forces and what friction can take are straight lines between the two.
    fn goes_on_to(&self, aim: &Aim, certificate: &Certificate, motions: &FreeMotions) -> Result<bool, PathError> {
        let Some(target) = aim.target.filter(|_| certificate.of_this_load) else {
            return Ok(!certificate.of_this_load);
        };
        let amounts: Vec<f64> = certificate.amounts.iter().map(nearest).collect();
        Ok(certify_again(&self.problem(target)?, motions, &amounts).is_some())
    }

    fn breakdown(&self, at: f64, why: String) -> PathError {
        PathError::Breakdown { name: self.name.to_owned(), at, why }
    }
}

/// Records what changes between two places, and adds the second.
fn change(path: &mut ConePath, before: &Stand, after: &Stand, jump: bool) {
    let there = &after.place;
    let ids = there.pairs.iter().map(|pair| pair.id.as_str());
    let mut changes = between(ids, &before.step.scheme, &after.step.scheme);
    with_directions(&mut changes, &there.pairs);
    let place = path.places.len() - 1;
    if !jump {
        path.places[place].pairs.iter_mut().zip(&there.pairs).for_each(|(before, after)| settle(before, after));
    }
    if !changes.is_empty() || jump {
        let sentence = sentence(&changes);
        path.breakpoints.push(Breakpoint { value: there.value, place, changes, jump, sentence });
    }
    path.places.push(there.clone());
}

/// z at a value: straight on from the place before through this one.
fn guess(before: Option<&Stand>, here: &Stand, to: f64) -> DVector<f64> {
    let Some(before) = before else { return here.step.z.clone() };
    let share = (to - here.value()) / (here.value() - before.value());
    &here.step.z + (&here.step.z - &before.step.z) * share
}

/// At a breakpoint a pair that comes to rest has the slip that it keeps, and one that closes has no gap: what is found
/// just before differs only because the place is located to so many digits.
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
    problem.system.over_joints(pairs.iter().map(|shown| (shown.z_n, shown.slip())))
}
