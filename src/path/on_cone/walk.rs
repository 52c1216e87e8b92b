//! The walk along a path in space, step by step.

use nalgebra::DVector;

use super::aim::{Aim, HERE};
use super::edge::Beyond;
use super::over::Path;
use super::stand::{Stand, displacements};
use super::{ConePath, JUMP};
use crate::answer::record::{PairState, State};
use crate::path::change::{Breakpoint, Change, between, sentence, with_directions};
use crate::path::cone_step::Stepper;
use crate::path::end::PathEnd;
use crate::path::load::LoadReach;
use crate::path::start::PathError;
use crate::solve::Solved;
use crate::text::words::short;

/// No path looks at more places than this, found or not.
const MOST_STEPS: usize = 20_000;
/// Within a scheme displacements have jumped where they miss by more than this share of the step where the path so far
/// leads to: to another branch, or so near to a turning point that shorter steps are asked for.
const MISS: f64 = 0.5;
/// Where no answer was found farther ahead, the first step in a scheme is longer than the one before it by this factor.
const AFRESH: f64 = 4.0;

/// A path on its way.
struct Walk<'p, 'a> {
    path: &'p Path<'a>,
    stepper: Stepper<'a>,
    aim: Aim,
    /// Whether it goes on with the load turned back.
    through: bool,
    /// What was found so far.
    told: ConePath,
    here: Stand,
    /// The place before this one in its scheme.
    before: Option<Stand>,
    /// Where the scheme before this one ended, unless the load turned back there.
    left: Option<Stand>,
    /// The nearest place ahead where none was found.
    lost: Option<f64>,
    /// The length of the next step.
    length: f64,
}

impl Path<'_> {
    /// Follows the answer from the one that is shown, or that of a polygon.
    pub(super) fn follow(&self, shown: Option<&Solved>, start: f64, reach: LoadReach) -> Result<ConePath, PathError> {
        let stepper = Stepper::new(self.case.rules.facets, self.case.watch);
        let aim = Aim::new(start, reach.to);
        let here = self.begin(&stepper, shown, start)?;
        let told = ConePath {
            name: self.name.to_owned(),
            over: self.over.clone(),
            start,
            from_zero: shown.is_none() && !self.over.is_friction(),
            is_present_off_paths: false,
            places: vec![here.place.clone()],
            breakpoints: Vec::new(),
            end: PathEnd::Target,
            for_good: false,
        };
        let (length, through) = (aim.step(), reach.through);
        let walk = Walk { path: self, stepper, aim, through, told, here, before: None, left: None, lost: None, length };
        walk.all()
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
        match stepper.anywhere(problem, &none, None)? {
            Ok(step) => self.stand(start, step),
            // An answer that no steps lead to is none that they lead on from.
            Err(_) if shown.is_some() => Err(PathError::OffPaths { name: self.name.to_owned(), at: start }),
            Err(_) => Err(PathError::NoStart {
                name: self.name.to_owned(),
                at: start,
                how: "without an answer on Coulomb's cone".to_owned(),
            }),
        }
    }
}

impl Walk<'_, '_> {
    /// All steps to the end.
    fn all(mut self) -> Result<ConePath, PathError> {
        for _ in 0..MOST_STEPS {
            if let Some(end) = self.aim.end_at(self.here.value()) {
                self.told.end = end;
                return Ok(self.told);
            }
            self.tell()?;
            if let Some((end, for_good)) = self.step()? {
                (self.told.end, self.told.for_good) = (end, for_good);
                return Ok(self.told);
            }
        }
        Err(PathError::Breakdown {
            name: self.path.name.to_owned(),
            at: self.here.value(),
            why: format!("the limit of {MOST_STEPS} steps was reached"),
        })
    }

    /// Reports how far it is; whether it may go on.
    fn tell(&self) -> Result<(), PathError> {
        let (aim, value) = (&self.aim, self.here.value());
        let fraction = if aim.target.is_some() { (value - aim.start).abs() / aim.size } else { 0.0 };
        let watch = self.path.case.watch;
        watch.progress(&format!("{} = {}", self.path.name, short(value)), fraction);
        if watch.stop() { Err(PathError::Interrupted) } else { Ok(()) }
    }

    /// Goes a step further, or tries a shorter one; the end of the path with [`ConePath::for_good`] where it is met.
    fn step(&mut self) -> Result<Option<(PathEnd, bool)>, PathError> {
        let to = self.aim.next(self.here.value(), self.length);
        let expected = match &self.before {
            Some(before) => Some(straight_on(before, &self.here, to)),
            None => self.path.ahead(&self.here, to)?,
        };
        let from = expected.as_ref().unwrap_or(&self.here.step.z);
        let found = self.path.near(&self.stepper, to, from)?;
        let is_away = found.as_ref().is_some_and(|found| is_away(&self.here, found, from));
        let found = match found {
            Some(found) if is_away && self.path.is_hidden(self.here.value(), &found)? => None,
            found => found,
        };
        let is_same = found.as_ref().is_some_and(|found| found.step.scheme == self.here.step.scheme);
        let misses = is_away && is_same && expected.is_some();
        if (found.is_none() || misses) && self.length > HERE * self.aim.size_at(self.here.value()) {
            self.lost = if misses { self.lost } else { Some(to) };
            self.length *= 0.5;
            return Ok(None);
        }
        let mut next = found.filter(|_| !misses);
        if let (Some(before), Some(found)) = (&self.before, &next)
            && [before, found].iter().all(|stand| stand.step.scheme == self.here.step.scheme)
            && let Some(dip) = self.path.unseen(&self.stepper, [before, &self.here, found])?
        {
            next = Some(dip.there);
            if dip.before {
                self.told.places.pop();
                self.here = before.clone();
            }
        }
        match next {
            Some(next) if next.step.scheme == self.here.step.scheme => {
                self.go_on(next);
                Ok(None)
            }
            next => self.leave(next),
        }
    }

    /// A place further on in the same scheme.
    fn go_on(&mut self, next: Stand) {
        self.told.places.push(next.place.clone());
        self.before = Some(std::mem::replace(&mut self.here, next));
        let (aim, here) = (&self.aim, self.here.value());
        self.length = aim.longer(self.length);
        self.lost = self.lost.filter(|lost| aim.way(here, *lost) > HERE * aim.size_at(here));
        if let Some(lost) = self.lost {
            self.length = self.length.min(aim.halfway(here, lost));
        }
    }

    /// The end of the scheme, `next` being the answer in the step beyond it, if any was found: into the next scheme,
    /// round a turn, in a jump, or to the end of the path.
    fn leave(&mut self, next: Option<Stand>) -> Result<Option<(PathEnd, bool)>, PathError> {
        let edge = self.path.edge(&self.stepper, self.here.clone(), next)?;
        let (mut last, mut next) = (edge.last, edge.next);
        let end = last.value();
        if self.told.places.last().is_some_and(|shown| shown.value != last.value()) {
            self.told.places.push(last.place.clone());
        }
        if !edge.jump
            && let Some(next) = next
        {
            self.change(&last, next, false);
            return Ok(None);
        }
        if let Some(left) = self.left.take()
            && self.path.presses_alike(&self.stepper, &left, &last)?
        {
            let began = self.told.breakpoints.pop().map_or(0, |at| at.place + 1);
            self.told.places.truncate(began);
            (last, next) = (left, None);
        }
        let ways = [self.aim.sign, -self.aim.sign];
        let ways = (&ways[..if self.through { 2 } else { 1 }], &self.aim);
        if let Some(found) = self.path.continued(&self.stepper, self.told.last_scheme(), &last, ways)? {
            self.turn(&last, found);
            return Ok(None);
        }
        let next = match next {
            Some(next) => next,
            None => match self.path.beyond(&self.stepper, end, &self.aim)? {
                Beyond::Jump(next) => *next,
                Beyond::End(end, for_good) => return Ok(Some((end, for_good))),
            },
        };
        self.change(&last, next, true);
        Ok(None)
    }

    /// Into the scheme of `next`.
    fn change(&mut self, last: &Stand, next: Stand, jump: bool) {
        let there = &next.place;
        let changes = changes(last, &next);
        let place = self.told.places.len() - 1;
        self.left = None;
        if !jump {
            let pairs = self.told.places[place].pairs.iter_mut();
            pairs.zip(&there.pairs).for_each(|(before, after)| settle(before, after));
        }
        if !changes.is_empty() || jump {
            let sentence = sentence(&changes);
            self.told.breakpoints.push(Breakpoint { value: there.value, place, changes, jump, sentence });
            self.left = Some(last.clone());
        }
        self.told.places.push(there.clone());
        // Near a limit schemes come closer and closer, and what is looked for beyond it is not found.
        let length = match self.lost {
            Some(_) => (AFRESH * self.length).min(self.aim.step()),
            None => self.aim.step(),
        };
        (self.here, self.before, self.lost, self.length) = (next, None, None, length);
    }

    /// Round a corner or a turning point to the first place behind it.
    fn turn(&mut self, last: &Stand, next: Stand) {
        let turns = self.aim.way(last.value(), next.value()) < 0.0;
        let changes = changes(last, &next);
        let changed = (!changes.is_empty()).then(|| sentence(&changes));
        let told: Vec<String> = changed.into_iter().chain(turns.then(|| "the load turns back".to_owned())).collect();
        let (value, place) = (last.value(), self.told.places.len() - 1);
        self.told.breakpoints.push(Breakpoint { value, place, changes, jump: false, sentence: told.join("; ") });
        self.told.places.push(next.place.clone());
        if turns {
            self.aim.turn();
        }
        self.length = (next.value() - last.value()).abs();
        (self.here, self.left, self.before, self.lost) = (next, None, None, None);
    }
}

/// Whether a place lies away from where the path so far leads to.
fn is_away(here: &Stand, next: &Stand, expected: &DVector<f64>) -> bool {
    let step = (expected - &here.step.z).amax();
    let size = next.step.z.amax().max(here.step.z.amax());
    (&next.step.z - expected).amax() > MISS * step + JUMP * size
}

/// z at a value: straight on from the place before through this one.
fn straight_on(before: &Stand, here: &Stand, to: f64) -> DVector<f64> {
    let share = (to - here.value()) / (here.value() - before.value());
    &here.step.z + (&here.step.z - &before.step.z) * share
}

fn changes(last: &Stand, next: &Stand) -> Vec<Change> {
    let pairs = &next.place.pairs;
    let ids = pairs.iter().map(|pair| pair.id.as_str());
    let mut changes = between(ids, &last.step.scheme, &next.step.scheme);
    with_directions(&mut changes, pairs);
    changes
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
