//! A contact problem as [`super::cone`] takes it.

use std::ops::ControlFlow;

use nalgebra::DVector;

use super::cone::{
    ConeAnswer, ConeCheck, ConeFailure, ConePair, ConeProblem, FROM_ANYWHERE, FROM_NEARBY, MixedProblem, MixedState,
    answer_after, kept_on_cone,
};
use super::problem::ContactProblem;
use super::sum::Sum;
use super::sums::joint_forces;
use super::system::Yielding;
use crate::watch::Watch;

/// Largest number of answers in which the multipliers of joints that repeat one another must settle: each gains some
/// five digits, and only parts that do not fit press on for ever.
const MULTIPLIERS: usize = 12;

/// The parts of a [`ConeProblem`] that are made for it.
#[derive(Clone, Debug)]
pub struct OnCone<'a> {
    problem: &'a ContactProblem,
    /// RF − R·(g, 0), and what it was summed from.
    load: DVector<f64>,
    load_terms: DVector<f64>,
    pairs: Vec<ConePair>,
}

impl<'a> OnCone<'a> {
    /// From a problem without joints in force form.
    pub fn new(problem: &'a ContactProblem) -> OnCone<'a> {
        let constants = joint_forces(problem, &DVector::zeros(problem.system.joint_count()));
        let read = |pick: fn(&Sum) -> f64| DVector::from_iterator(constants.len(), constants.iter().map(pick));
        OnCone {
            problem,
            load: read(|sum| sum.value),
            load_terms: read(|sum| sum.magnitude),
            pairs: cone_pairs(problem),
        }
    }

    fn problem(&self) -> ConeProblem<'_> {
        let system = &*self.problem.system;
        ConeProblem {
            stiffness: &system.stiffness,
            load: &self.load,
            load_terms: &self.load_terms,
            rounded: system.rounded,
            kernel: &system.kernel,
            pairs: &self.pairs,
        }
    }

    /// The answer on the cone that Newton's method finds from displacements `start`. Joints that yield bring it near, and
    /// those of the problem itself are put in their place; where that leads nowhere multipliers bring it nearer.
    ///
    /// # Errors
    /// [`ConeFailure`].
    pub fn answer(&self, start: &DVector<f64>, watch: &dyn Watch) -> Result<ConeAnswer, ConeFailure> {
        self.searched(start, FROM_ANYWHERE, watch)
    }

    /// The same where the answer is near the start, if there is one.
    ///
    /// # Errors
    /// [`ConeFailure`].
    pub fn nearby(&self, start: &DVector<f64>, watch: &dyn Watch) -> Result<ConeAnswer, ConeFailure> {
        self.searched(start, FROM_NEARBY, watch)
    }

    fn searched(&self, start: &DVector<f64>, sweeps: &[usize], watch: &dyn Watch) -> Result<ConeAnswer, ConeFailure> {
        let Some(yielding) = &self.problem.system.yielding else {
            return answer_after(&self.problem(), start, sweeps, watch);
        };
        let exact = yielding.exactly(self.problem);
        let exactly = |z: &DVector<f64>, forces: &[Sum], steps: usize| match &exact {
            None => Ok(None),
            Some(exact) => Ok(MixedProblem::new(exact, &self.pairs)
                .answer(z, &|joint| forces[joint].value, watch)?
                .map(|found| self.reached(found, start, steps))
                .filter(|found| found.check.passed)),
        };
        // Where the joints as they are can be asked for, what yields is only on the way to their answer.
        let may_settle = exact.is_none();
        self.by_multipliers(yielding, start, may_settle, |problem, from, steps| {
            let found = match answer_after(problem, from, sweeps, watch) {
                Err(failure @ ConeFailure::NotConverged { .. }) => {
                    return exactly(from, &problem.forces(from), steps)?.map(ControlFlow::Break).ok_or(failure);
                }
                found => found?,
            };
            let last = exactly(&found.z, &found.forces, steps + found.steps)?;
            Ok(last.map_or(ControlFlow::Continue(found), ControlFlow::Break))
        })
    }

    /// The answer on the cone in which just those joints move that move in z, near it; joints that repeat one another by
    /// multipliers alone.
    ///
    /// # Errors
    /// [`ConeFailure`].
    pub fn kept(&self, z: &DVector<f64>) -> Result<ConeAnswer, ConeFailure> {
        match &self.problem.system.yielding {
            None => kept_on_cone(&self.problem(), z),
            Some(yielding) => self.by_multipliers(yielding, z, true, |problem, from, _| {
                Ok(ControlFlow::Continue(kept_on_cone(problem, from)?))
            }),
        }
    }

    /// Answers that `find` finds near the one before, after so many steps, each with the multipliers of the one before: up
    /// to one that is the last, or where it `may_settle`, until the multipliers do.
    fn by_multipliers<F>(
        &self,
        yielding: &Yielding,
        start: &DVector<f64>,
        may_settle: bool,
        find: F,
    ) -> Result<ConeAnswer, ConeFailure>
    where
        F: Fn(&ConeProblem<'_>, &DVector<f64>, usize) -> Result<ControlFlow<ConeAnswer, ConeAnswer>, ConeFailure>,
    {
        let stiffness = &self.problem.system.stiffness;
        let (mut now, mut from, mut steps) = (self.clone(), start.clone(), 0);
        let mut before: Option<Vec<Sum>> = None;
        for _ in 0..MULTIPLIERS {
            let found = match find(&now.problem(), &from, steps)? {
                ControlFlow::Break(last) => return Ok(last),
                ControlFlow::Continue(found) => found,
            };
            steps += found.steps;
            if may_settle && before.is_some_and(|before| yielding.is_settled(&before, &found.forces)) {
                return Ok(ConeAnswer { steps, ..found });
            }
            let [held, terms] = yielding.held_by(stiffness, &found.forces);
            (now.load, now.load_terms) = (&self.load + held, &self.load_terms + terms);
            (from, before) = (found.z, Some(found.forces));
        }
        Err(ConeFailure::DoNotFit)
    }

    fn reached(&self, found: MixedState, start: &DVector<f64>, steps: usize) -> ConeAnswer {
        let MixedState { z, forces, steps: own, .. } = found;
        let problem = self.problem();
        ConeAnswer {
            states: problem.states(&z),
            check: ConeCheck::of(&problem, &z, &forces),
            steps: steps + own,
            distance: problem.slip_difference(&z, start),
            z,
            forces,
        }
    }

    /// An answer with as little as there can be, from displacements before, of motions that nothing resists.
    pub fn least_moved(&self, mut answer: ConeAnswer, before: &DVector<f64>) -> ConeAnswer {
        if let Some(z) = self.problem().least_moved((&answer.z, &answer.forces), before) {
            answer.z = z;
        }
        answer
    }

    /// The fresh check of displacements z and their forces.
    pub fn check(&self, z: &DVector<f64>, forces: &[Sum]) -> ConeCheck {
        ConeCheck::of(&self.problem(), z, forces)
    }
}

/// The pairs of a problem as they are on Coulomb's cone.
pub fn cone_pairs(problem: &ContactProblem) -> Vec<ConePair> {
    let pairs = problem.system.pairs.iter().zip(&problem.laws);
    pairs.map(|(pair, law)| ConePair { law: *law, tangents: pair.tangential.clone() }).collect()
}

/// The pairs on a cone that holds all that the friction of the problem admits: Coulomb's cone itself, or the one around
/// a polygon that is solved for its own sake, whose corners lie 1/cos(π/K) farther out.
pub fn widest_cone_pairs(problem: &ContactProblem) -> Vec<ConePair> {
    let mut pairs = cone_pairs(problem);
    if problem.system.is_in_space() && !problem.cone {
        let corner = (std::f64::consts::PI / problem.polygon.facets() as f64).cos().recip() * (1.0 + f64::EPSILON);
        for ConePair { law, .. } in &mut pairs {
            *law = law.with_friction(corner * law.friction()).with_fixed_bound(corner * law.fixed_bound());
        }
    }
    pairs
}

/// A problem whose joints repeat one another with these joints as they are, some in force form; `None` of any other.
pub fn as_they_are(problem: &ContactProblem) -> Option<ContactProblem> {
    match &problem.system.yielding {
        Some(yielding) => yielding.exactly(problem),
        None => problem.system.force_form.is_some().then(|| problem.clone()),
    }
}

/// What joints that repeat one another do in the plane, or on a polygon that is solved for its own sake, near this state
/// of all joints; `None` where they do not repeat one another, or where nothing is found.
///
/// # Errors
/// Stopped from outside.
pub fn with_repeated_joints(
    problem: &ContactProblem,
    (z, forces): (&DVector<f64>, &[Sum]),
    watch: &dyn Watch,
) -> Result<Option<MixedState>, ConeFailure> {
    let pairs = cone_pairs(problem);
    as_they_are(problem)
        .map_or(Ok(None), |problem| MixedProblem::new(&problem, &pairs).answer(z, &|joint| forces[joint].value, watch))
}
