//! What a path in space is followed over, and the problem at each of its values.

use std::sync::Arc;

use crate::contact::problem::ContactProblem;
use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::path::load_parameter::LoadParameter;
use crate::path::start::PathError;
use crate::solve::problem::{contact_problem, factors};
use crate::solve::{Case, Prepared};

/// What a path is followed over.
#[derive(Clone, Debug)]
pub enum Over {
    /// A friction coefficient.
    Friction,
    /// A load; where it stands in the loads themselves, with the geometry that has the cases they grow by.
    Load(LoadParameter, Option<Arc<Prepared>>),
}

impl Over {
    /// Whether it is a friction coefficient.
    pub fn is_friction(&self) -> bool {
        matches!(self, Over::Friction)
    }

    /// The geometry with the cases that loads grow by.
    pub fn ground<'p>(&'p self, prepared: &'p Prepared) -> &'p Prepared {
        match self {
            Over::Load(_, Some(grown)) => grown,
            _ => prepared,
        }
    }

    /// The factors of all cases of [`Over::ground`] at a value.
    pub fn factors(&self, prepared: &Prepared, values: &ParameterValues, value: f64) -> Vec<f64> {
        let mut all = factors(self.ground(prepared), values);
        if let Over::Load(parameter, _) = self {
            parameter.drive(&mut all, value);
        }
        all
    }
}

/// What is followed: the answer of this case over a parameter or load.
pub(super) struct Path<'a> {
    /// With the geometry that the loads grow in.
    pub(super) case: Case<'a>,
    pub(super) name: &'a str,
    pub(super) over: &'a Over,
    /// Load cases of the scenario.
    own: usize,
}

impl<'a> Path<'a> {
    pub(super) fn new(case: Case<'a>, name: &'a str, over: &'a Over) -> Path<'a> {
        let own = case.prepared.cases.len();
        Path { case: Case { prepared: over.ground(case.prepared), ..case }, name, over, own }
    }

    /// The values of all parameters where this one has a value.
    fn values(&self, value: f64) -> ParameterValues {
        let mut values = self.case.values.clone();
        if self.over.is_friction() {
            values.insert(self.name.to_owned(), value);
        }
        values
    }

    /// The problem at a value.
    ///
    /// # Errors
    /// A bare LCP.
    pub(super) fn problem(&self, value: f64) -> Result<ContactProblem, PathError> {
        let values = self.values(value);
        let factors = self.over.factors(self.case.prepared, &values, value);
        let system = self.case.prepared.system().ok_or(PathError::Plain("trace"))?;
        Ok(contact_problem(system, &factors, &values).under(self.case.rules))
    }

    /// Whether a run of its own, with all its retries, finds an answer on the cone at a value.
    ///
    /// # Errors
    /// Stopped from outside.
    pub(super) fn is_answer(&self, value: f64) -> Result<bool, PathError> {
        let values = self.values(value);
        let prepared = self.case.prepared.with_factors(&self.over.factors(self.case.prepared, &values, value));
        let there = Case { prepared: &prepared, values: &values, ..self.case };
        Ok(there.under(Rules::default()).solve_pairs()?.stands(true))
    }

    /// The factors that are recorded for a place; none on a path over friction.
    pub(super) fn told_factors(&self, value: f64) -> Vec<f64> {
        if self.over.is_friction() {
            return Vec::new();
        }
        let all = self.over.factors(self.case.prepared, self.case.values, value);
        all.into_iter().take(self.own).collect()
    }
}
