//! What is solved, followed and searched: a scenario made ready, at values of its parameters, under rules.

use std::sync::Arc;

use super::error::QuestionError;
use super::prepared::Prepared;
use super::state::Solved;
use crate::model::parameter::{Number, ParameterValues};
use crate::model::rules::Rules;
use crate::model::scenario::Scenario;
use crate::watch::{Quiet, Watch};

/// A scenario at values of its parameters, under rules.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    pub scenario: &'a Scenario,
    /// Made ready for `values`.
    pub prepared: &'a Prepared,
    pub values: &'a ParameterValues,
    pub rules: Rules,
    /// Sees progress and may ask to stop.
    pub watch: &'a dyn Watch,
}

/// The scenario with one parameter, or the factor of one load case, at another value.
pub struct There {
    /// Made ready for it.
    pub prepared: Arc<Prepared>,
    pub values: ParameterValues,
}

impl Prepared {
    /// The scenario, which this was made from, at `values`, under its own rules and with nobody watching.
    pub fn case<'a>(&'a self, scenario: &'a Scenario, values: &'a ParameterValues) -> Case<'a> {
        Case { scenario, prepared: self, values, rules: scenario.rules, watch: &Quiet }
    }
}

impl There {
    /// The case there.
    pub fn case<'a>(&'a self, here: Case<'a>) -> Case<'a> {
        Case { prepared: &self.prepared, values: &self.values, ..here }
    }
}

impl<'a> Case<'a> {
    /// The same under other rules.
    pub fn under(self, rules: Rules) -> Case<'a> {
        Case { rules, ..self }
    }

    /// The same with somebody watching.
    pub fn watched(self, watch: &'a dyn Watch) -> Case<'a> {
        Case { watch, ..self }
    }

    /// The value of a parameter, or the factor of a load case.
    pub fn present(self, name: &str) -> Option<f64> {
        match self.prepared.cases.iter().find(|(known, _)| known == name) {
            Some((_, factor)) => Some(factor.value(self.values)),
            None => self.values.get(name).copied(),
        }
    }

    /// The scenario with a parameter, or the factor of a load case, at another value.
    ///
    /// # Errors
    /// A value that it cannot take; stopped.
    pub fn at(self, name: &str, value: f64) -> Result<There, QuestionError> {
        self.at_all(&[(name, value)])
    }

    /// The same with several of them.
    ///
    /// # Errors
    /// As [`Case::at`].
    pub fn at_all(self, settings: &[(&str, f64)]) -> Result<There, QuestionError> {
        let Case { scenario, prepared, .. } = self;
        let mut values = self.values.clone();
        let mut fixed: Vec<(usize, f64)> = Vec::new();
        for &(name, value) in settings {
            if let Some(case) = prepared.cases.iter().position(|(known, _)| known == name) {
                fixed.push((case, value));
                continue;
            }
            if let Some(refusal) = scenario.refusal(name, value) {
                return Err(QuestionError::Refused(refusal));
            }
            values.insert(name.to_owned(), value);
        }
        if let Some(refusal) = scenario.law_refusal(&values) {
            return Err(QuestionError::Refused(refusal));
        }
        let renewed = prepared.renewed(scenario, &values, self.watch)?;
        let mut there = renewed.map_or_else(|| prepared.clone(), |(there, _)| there);
        for (case, value) in fixed {
            there.cases[case].1 = Number::Value(value);
        }
        Ok(There { prepared: Arc::new(there), values })
    }

    /// The answer with some of them at other values, solved independently; `None` where these values have no model.
    ///
    /// # Errors
    /// Stopped, or a run that could not be made.
    pub fn solved_at(self, settings: &[(&str, f64)]) -> Result<Option<(There, Solved)>, QuestionError> {
        let there = match self.at_all(settings) {
            Ok(there) => there,
            Err(QuestionError::Refused(_)) => return Ok(None),
            Err(error) => return Err(error),
        };
        let solved = there.case(self).solve_briefly()?;
        Ok(Some((there, solved)))
    }
}
