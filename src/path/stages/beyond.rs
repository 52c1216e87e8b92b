//! Where no rates lead on: a limit, with its collapse, or a jump to another state.

use nalgebra::DVector;

use super::course::Course;
use super::follower::{Follower, Way};
use super::loose_scheme::without_loose_motion;
use super::walk::{LONGEST_LOOK, Walk};
use crate::answer::check::check_contact;
use crate::answer::pairs::{JointState, pair_states};
use crate::answer::record::{PairState, Ray, State, Verdict};
use crate::contact::lcp::contact_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::refine::refined;
use crate::contact::rows::RowKind;
use crate::explain::all_schemes::{all_answers, answers_as_stored};
use crate::explain::ray;
use crate::lcp::outcome::{Point, RayDirection};
use crate::lcp::variable::Variable;
use crate::model::rules::Covering;
use crate::path::start::{PathError, cold, state_of};
use crate::solve::engines::under_other_coverings;

/// The collapse is certified this part of a stage further on: at the limit itself the forces still balance.
const CERTIFIED_AT: f64 = 1e-6;
/// Where no rates lead on, states are looked for these parts of a stage further on: a stiffness near to singular, and
/// displacements far out, may hide the nearest in their rounding.
const BEYOND: [f64; 3] = [1e-9, 1e-8, LONGEST_LOOK];
/// A look this many times as far ahead …
const FARTHER: f64 = 16.0;
/// … shows less than this many times the motion where it is a jump.
const STAYS: f64 = 4.0;

/// What a collapse on the way says of the loads of its stage.
pub(super) fn explanation(collapse: &Ray) -> &'static str {
    match collapse.verdict {
        Some(Verdict::Certified) => {
            "The loads of this stage cannot be reached: beyond this place no contact forces within the laws' bounds balance \
             them, and nothing resists this motion."
        }
        Some(Verdict::Proved) => {
            "The loads of this stage cannot be reached from here: just beyond this place no state obeys the laws, with slips \
             that count from here. Every working scheme was tried."
        }
        _ => {
            "The loads of this stage could not be followed further: the rate problem has no answer that was found, and no \
             state just beyond was found that leads on. That the loads cannot be carried is not proved."
        }
    }
}

impl Walk<'_> {
    /// What comes where the rate problem ends in a ray at place t: a jump, if it may, and the place it leads to, or the collapse.
    pub(super) fn beyond(
        &mut self,
        course: &Course,
        t: f64,
        (motion, p, may_jump): (&DVector<f64>, f64, bool),
        way: &mut Way,
    ) -> Result<Result<f64, Ray>, PathError> {
        let mut collapse = self.collapse(course, t, motion, p)?;
        if collapse.verdict == Some(Verdict::Certified) {
            collapse.explanation = explanation(&collapse).to_owned();
            return Ok(Err(collapse));
        }
        if may_jump && let Some(to) = self.jump(course, t, way)? {
            return Ok(Ok(to));
        }
        let at = t + CERTIFIED_AT;
        let problem = self.problem_behind(&self.slips(), &course.factors_at(at), &course.gaps_at(at));
        if all_answers(&problem, self.place.watch).is_some_and(|found| found.no_answer()) {
            collapse.verdict = Some(Verdict::Proved);
        }
        collapse.explanation = explanation(&collapse).to_owned();
        Ok(Err(collapse))
    }

    /// The motion as a ray, its class, and whether the equilibrium LP just beyond proves it.
    pub(super) fn collapse(&self, course: &Course, t: f64, motion: &DVector<f64>, p: f64) -> Result<Ray, PathError> {
        let system = &*self.place.laws.problem.system;
        let problem = {
            let at = t + CERTIFIED_AT;
            self.problem_at(&course.factors_at(at), &course.gaps_at(at))
        };
        let contact =
            contact_lcp(&problem, Covering::Cohesive).map_err(|error| PathError::Target(error.to_string()))?;
        let mut z = vec![0.0; contact.rows.len()];
        for (row, meaning) in contact.rows.iter().enumerate() {
            z[row] = match (meaning.couple, system.pairs[meaning.pair].plane_tangential()) {
                (RowKind::Normal, _) => motion[meaning.pair],
                (RowKind::PLUS, Some(joint)) => motion[joint].max(0.0),
                (RowKind::Facet(_), Some(joint)) => (-motion[joint]).max(0.0),
                (_, None) => 0.0,
            };
        }
        let w = vec![0.0; contact.rows.len()];
        let direction = RayDirection { entering: Variable::P, z, w, p: 0.0 };
        Ok(ray::report(&problem, self.place.prepared.built(), &contact, &direction, p))
    }

    /// The answer of eq. (8) just beyond, in increments from the present slip, where there is one; the place it is at.
    ///
    /// The motion of a jump does not get smaller with the step that leads to it. Where it does, a way goes on, and what
    /// the rate problem took for its end is rounding: then that way is taken, without a jump.
    fn jump(&mut self, course: &Course, t: f64, way: &mut Way) -> Result<Option<f64>, PathError> {
        let motion = |there: &Option<There>, from: &DVector<f64>| there.as_ref().map(|there| (&there.z - from).amax());
        let mut found = None;
        for step in BEYOND {
            let to = (t + step).min(1.0);
            let Some(near) = self.answer_at(course, to)? else { break };
            let far = self.answer_at(course, t + FARTHER * step)?;
            let from = &self.standing.z;
            let jump = motion(&far, from).is_some_and(|far| far < STAYS * (&near.z - from).amax());
            found = Some((to, near, jump));
            if jump {
                break;
            }
        }
        Ok(found.map(|(to, there, jump)| {
            self.stand_at(course, to, there.z, there.states);
            way.moments.push(self.moment(to, jump));
            to
        }))
    }

    /// The answer of eq. (8) at a place, in increments from the present slip.
    fn answer_at(&self, course: &Course, to: f64) -> Result<Option<There>, PathError> {
        Ok(self.answer_behind(self.slips(), &course.factors_at(to), &course.gaps_at(to))?.ok())
    }

    /// The present slips over the joints.
    fn slips(&self) -> DVector<f64> {
        let mut committed = self.standing.z.clone();
        committed.rows_mut(0, self.place.laws.problem.system.pair_count()).fill(0.0);
        committed
    }

    /// The problem of eq. (8) under these factors and gaps, in increments from committed slips over the joints.
    fn problem_behind(&self, committed: &DVector<f64>, factors: &[f64], gaps: &[f64]) -> ContactProblem {
        let mut problem = self.problem_at(factors, gaps);
        let shift = &problem.system.stiffness * committed;
        problem.add_load(1.0, &shift, &shift.abs());
        problem
    }

    /// The answer of eq. (8) under these factors and gaps, in increments from committed slips over the joints; how the run
    /// ended where there is none.
    pub(super) fn answer_behind(
        &self,
        committed: DVector<f64>,
        factors: &[f64],
        gaps: &[f64],
    ) -> Result<Result<There, &'static str>, PathError> {
        let problem = self.problem_behind(&committed, factors, gaps);
        let found = cold(&problem, self.place.watch)?;
        // Near a limit rounding can leave a basis that belongs to no state.
        let checked = |point: Point| {
            let state = state_of(&problem, &found.contact, &refined(&problem, &found.contact, point));
            let pairs = pair_states(&problem, &found.contact, &state);
            self.is_found(&problem, &state).then_some((state, pairs))
        };
        let first = found.basis.as_ref().and_then(|_| checked(found.point.clone()));
        let state = first
            .or_else(|| self.nearest_of_all(&problem, &committed))
            .or_else(|| under_other_coverings(&found.contact, self.place.watch, |run| checked(run.point.clone())));
        Ok(match state {
            Some((state, pairs)) => Ok(There::new(state, committed, &pairs)),
            None if found.basis.is_some() => Err("in a state that fails its check"),
            None => Err(found.how()),
        })
    }

    /// Whether a state obeys its laws, and not only by a motion that nothing but rounding resists.
    fn is_found(&self, problem: &ContactProblem, state: &JointState) -> bool {
        check_contact(problem, state, None).passed
            && without_loose_motion(problem, state).is_none_or(|rest| check_contact(problem, &rest, None).passed)
    }

    /// Of all answers, where there are few schemes, the one with the least motion from where it stands.
    fn nearest_of_all(
        &self,
        problem: &ContactProblem,
        committed: &DVector<f64>,
    ) -> Option<(JointState, Vec<PairState>)> {
        let found = answers_as_stored(problem, self.place.watch)?;
        let contact = contact_lcp(problem, Covering::Cohesive).ok()?;
        let motion = |state: &JointState| (&state.z + committed - &self.standing.z).amax();
        let states = found.answers.into_iter().map(|answer| JointState::at(problem, answer.state.z, 0.0));
        let nearest =
            states.filter(|state| self.is_found(problem, state)).min_by(|a, b| motion(a).total_cmp(&motion(b)))?;
        let pairs = pair_states(problem, &contact, &nearest);
        Some((nearest, pairs))
    }
}

/// A state that was not reached by rates.
pub(super) struct There {
    /// Total z over the joints.
    pub(super) z: DVector<f64>,
    /// What every pair does on the way to it.
    pub(super) states: Vec<(State, Option<State>)>,
}

impl There {
    /// From a state in increments from committed slips.
    fn new(increments: JointState, committed: DVector<f64>, pairs: &[PairState]) -> There {
        There { z: increments.z + committed, states: pairs.iter().map(|pair| (pair.state, pair.held)).collect() }
    }
}
