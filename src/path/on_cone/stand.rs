//! A place of a path in space with its answer.

use nalgebra::DVector;

use super::over::Path;
use crate::answer::pairs::pairs_in_space;
use crate::answer::record::PairState;
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

    /// An answer at a value as a place.
    pub(super) fn stand(&self, value: f64, step: Step) -> Result<Stand, PathError> {
        let problem = self.problem(value)?;
        let mut pairs = pairs_in_space(&problem, &step.increments);
        self.case.prepared.add_released_slips(&mut pairs, &problem, &step.z);
        Ok(Stand { step, place: Place { value, factors: self.told_factors(value), pairs } })
    }
}
