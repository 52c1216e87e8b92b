//! A contact problem as [`super::cone`] takes it.

use nalgebra::DVector;

use super::cone::{
    ConeAnswer, ConeCheck, ConeFailure, ConePair, ConeProblem, MixedProblem, MixedState, answer_nearby, answer_on_cone,
    kept_on_cone,
};
use super::problem::ContactProblem;
use super::sum::Sum;
use super::sums::joint_forces;
use super::system::Yielding;
use crate::watch::Watch;

/// Largest number of answers in which the multipliers of joints that repeat one another must settle: each gains some
/// five digits, and only parts that do not fit press on for ever.
const MULTIPLIERS: usize = 12;

/// How Newton's method searches from a start.
type Search = fn(&ConeProblem<'_>, &DVector<f64>, &dyn Watch) -> Result<ConeAnswer, ConeFailure>;

/// What was found of joints that repeat one another.
enum Found {
    /// The answer.
    Last(ConeAnswer),
    /// The answer where the multipliers settle.
    OfMultipliers(ConeAnswer),
    /// One that yields, whose multipliers bring the next one nearer.
    OnTheWay(ConeAnswer),
}

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
        self.searched(start, answer_on_cone, watch)
    }

    /// The same where the answer is near the start, if there is one.
    ///
    /// # Errors
    /// [`ConeFailure`].
    pub fn nearby(&self, start: &DVector<f64>, watch: &dyn Watch) -> Result<ConeAnswer, ConeFailure> {
        self.searched(start, answer_nearby, watch)
    }

    fn searched(&self, start: &DVector<f64>, search: Search, watch: &dyn Watch) -> Result<ConeAnswer, ConeFailure> {
        let Some(yielding) = &self.problem.system.yielding else {
            return search(&self.problem(), start, watch);
        };
        let exact = yielding.exactly(self.problem);
        let exactly = |z: &DVector<f64>, forces: &[Sum], steps: usize| match &exact {
            None => Ok(None),
            Some(exact) => Ok(MixedProblem::new(exact, &self.pairs)
                .answer(z, forces, watch)?
                .map(|found| self.reached(found, start, steps))
                .filter(|found| found.check.passed)),
        };
        self.by_multipliers(yielding, start, |problem, from, steps| {
            let found = match search(problem, from, watch) {
                Err(failure @ ConeFailure::NotConverged { .. }) => {
                    return exactly(from, &problem.forces(from), steps)?.map(Found::Last).ok_or(failure);
                }
                found => found?,
            };
            Ok(match exactly(&found.z, &found.forces, steps + found.steps)? {
                Some(found) => Found::Last(found),
                None if exact.is_none() => Found::OfMultipliers(found),
                None => Found::OnTheWay(found),
            })
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
            Some(yielding) => self
                .by_multipliers(yielding, z, |problem, from, _| Ok(Found::OfMultipliers(kept_on_cone(problem, from)?))),
        }
    }

    /// Answers that `find` finds near the one before, after so many steps, each with the multipliers of the one before.
    fn by_multipliers<F>(&self, yielding: &Yielding, start: &DVector<f64>, find: F) -> Result<ConeAnswer, ConeFailure>
    where
        F: Fn(&ConeProblem<'_>, &DVector<f64>, usize) -> Result<Found, ConeFailure>,
    {
        let stiffness = &self.problem.system.stiffness;
        let (mut now, mut from, mut steps) = (self.clone(), start.clone(), 0);
        let mut before: Option<Vec<Sum>> = None;
        for _ in 0..MULTIPLIERS {
            let (found, may_settle) = match find(&now.problem(), &from, steps)? {
                Found::Last(found) => return Ok(found),
                Found::OfMultipliers(found) => (found, true),
                Found::OnTheWay(found) => (found, false),
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
    let yielded = match &problem.system.yielding {
        Some(yielding) => yielding.exactly(problem),
        None => problem.system.force_form.is_some().then(|| problem.clone()),
    };
    let pairs = cone_pairs(problem);
    yielded.map_or(Ok(None), |problem| MixedProblem::new(&problem, &pairs).answer(z, forces, watch))
}
