//! A place of a path in space with its answer.

use nalgebra::DVector;

use super::over::{Over, Path};
use crate::answer::pairs::pairs_in_space;
use crate::answer::record::PairState;
use crate::contact::problem::ContactProblem;
use crate::contact::sum::LAW_ROUNDING;
use crate::path::cone_step::{Step, Stepper};
use crate::path::start::PathError;

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

/// A place with its answer.
#[derive(Clone)]
pub(super) struct Stand {
    pub(super) step: Step,
    pub(super) place: Place,
}

impl Stand {
    pub(super) fn value(&self) -> f64 {
        self.place.value
    }
}

impl Path<'_> {
    /// The answer at a value that Newton's method finds near a guess of z; `None` where it finds none.
    pub(super) fn near(
        &self,
        stepper: &Stepper<'_>,
        value: f64,
        guess: &DVector<f64>,
    ) -> Result<Option<Stand>, PathError> {
        let none = DVector::zeros(guess.len());
        let found = stepper.near(self.problem(value)?, &none, guess)?;
        found.map(|step| self.stand(value, step)).transpose()
    }

    /// The answer at a value in which what moves at another place moves and the rest stands, near that place; `None`
    /// where the pairs would break their laws.
    pub(super) fn kept(&self, stepper: &Stepper<'_>, value: f64, other: &Stand) -> Result<Option<Stand>, PathError> {
        let found = stepper.kept(&self.problem(value)?, &other.step.z)?;
        found.filter(|step| step.scheme == other.step.scheme).map(|step| self.stand(value, step)).transpose()
    }

    /// Whether rounding hides in the forces of an answer, together, all that changes on the way to it from this value: of
    /// so far a motion it could as well be the answer to what stood before.
    pub(super) fn is_hidden(&self, from: f64, found: &Stand) -> Result<bool, PathError> {
        let way = (found.value() - from).abs();
        let change = match self.over {
            Over::Friction => way * found.place.pairs.iter().map(|pair| pair.x_n.max(0.0)).sum::<f64>(),
            Over::Load(parameter, _) => way * parameter.direction(&self.problem(from)?.system).lp_norm(1),
        };
        Ok(LAW_ROUNDING * found.step.increments.terms.sum() >= change)
    }

    /// An answer at a value as a place.
    pub(super) fn stand(&self, value: f64, step: Step) -> Result<Stand, PathError> {
        let problem = self.problem(value)?;
        let mut pairs = pairs_in_space(&problem, &step.increments);
        self.case.prepared.add_released_slips(&mut pairs, &problem, &step.z);
        Ok(Stand { step, place: Place { value, factors: self.told_factors(value), pairs } })
    }
}

/// z over the joints as pairs show it.
pub(super) fn displacements(problem: &ContactProblem, pairs: &[PairState]) -> DVector<f64> {
    problem.system.over_joints(pairs.iter().map(|shown| (shown.z_n, shown.slip())))
}
