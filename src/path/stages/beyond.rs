//! Where no rates lead on: a limit, with its collapse, or a jump to another state.

use nalgebra::DVector;

use super::course::Course;
use super::walk::{Walk, Way};
use crate::answer::pairs::pair_states;
use crate::answer::record::{Ray, State, Verdict};
use crate::contact::complementarity::{Couple, contact_lcp};
use crate::explain::ray;
use crate::lcp::outcome::RayDirection;
use crate::lcp::variable::Variable;
use crate::model::rules::Covering;
use crate::path::start::{PathError, cold, state_of};

/// The collapse is certified this part of a stage further on: at the limit itself the forces still balance.
const CERTIFIED_AT: f64 = 1e-6;
/// After a jump the path goes on this part of a stage further on.
const JUMPED_TO: f64 = 1e-9;

impl Walk<'_> {
    /// What comes where the rate problem ends in a ray at place t: a jump, and the place it leads to, or the collapse.
    pub(super) fn beyond(
        &mut self,
        course: &Course,
        t: f64,
        (motion, p): (&DVector<f64>, f64),
        way: &mut Way,
    ) -> Result<Result<f64, Ray>, PathError> {
        let mut collapse = self.collapse(course, t, motion, p)?;
        if collapse.verdict == Some(Verdict::Certified) {
            collapse.explanation =
                "The loads of this stage cannot be reached: beyond this place no contact forces within \
                                    the laws' bounds balance them, and nothing resists this motion."
                    .to_owned();
            return Ok(Err(collapse));
        }
        if let Some(to) = self.jump(course, t, way)? {
            return Ok(Ok(to));
        }
        collapse.explanation = "The loads of this stage could not be followed further: the rate problem has no answer that \
                                was found, and no state just beyond was found to jump to. That the loads cannot be carried is \
                                not proved."
            .to_owned();
        Ok(Err(collapse))
    }

    /// The motion as a ray, its class, and whether the equilibrium LP just beyond proves it.
    fn collapse(&self, course: &Course, t: f64, motion: &DVector<f64>, p: f64) -> Result<Ray, PathError> {
        let system = self.laws.system;
        let numbers = {
            let at = t + CERTIFIED_AT;
            self.numbers_at(&course.factors_at(at), &course.gaps_at(at))
        };
        let contact =
            contact_lcp(system, &numbers, Covering::Cohesive).map_err(|error| PathError::Target(error.to_string()))?;
        let mut z = vec![0.0; contact.rows.len()];
        for (row, meaning) in contact.rows.iter().enumerate() {
            z[row] = match (meaning.couple, system.pairs[meaning.pair].tangential) {
                (Couple::Normal, _) => motion[meaning.pair],
                (Couple::Plus, Some(joint)) => motion[joint].max(0.0),
                (Couple::Minus, Some(joint)) => (-motion[joint]).max(0.0),
                (_, None) => 0.0,
            };
        }
        let w = vec![0.0; contact.rows.len()];
        let direction = RayDirection { entering: Variable::P, z, w, p: 0.0 };
        Ok(ray::report(system, &numbers, &contact, &direction, p))
    }

    /// The answer of eq. (8) just beyond, in increments from the present slip, where there is one.
    fn jump(&mut self, course: &Course, t: f64, way: &mut Way) -> Result<Option<f64>, PathError> {
        let system = self.laws.system;
        let to = (t + JUMPED_TO).min(1.0);
        let mut committed = self.standing.z.clone();
        for i in 0..system.pair_count() {
            committed[i] = 0.0;
        }
        let mut numbers = self.numbers_at(&course.factors_at(to), &course.gaps_at(to));
        numbers.load += &system.stiffness * &committed;
        let found = cold(system, &numbers, self.watch)?;
        if found.basis.is_none() {
            return Ok(None);
        }
        let state = state_of(system, &numbers, &found.contact, &found.point);
        let states: Vec<(State, Option<State>)> =
            pair_states(system, &numbers, &found.contact, &state).iter().map(|pair| (pair.state, pair.held)).collect();
        self.stand_at(course, to, state.z + committed, states);
        way.moments.push(self.moment(to, true));
        Ok(Some(to))
    }
}
