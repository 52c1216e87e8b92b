//! What takes a path or a search of its own: limits, critical friction, the stages of a history.

use super::facts::Facts;
use super::value::{NoValue, Value, none};
use crate::model::quantity::{OfAnswer, OfLoad, Quantity};
use crate::path::limit::{self, Limit};
use crate::path::stages::{self, History};
use crate::path::start::PathError;
use crate::solve::Case;

/// The load history, followed where one of the quantities is of it; `None` where none is.
///
/// # Errors
/// As [`stages::follow`].
pub fn history_for(case: Case<'_>, quantities: &[Quantity]) -> Result<Option<History>, PathError> {
    quantities.iter().any(Quantity::is_of_history).then(|| stages::follow(case)).transpose()
}

impl<'a> Facts<'a> {
    /// The same, with a history for the quantities that are of it; the others stay what they are.
    pub fn beside(self, history: Option<&'a History>) -> Facts<'a> {
        Facts { history, ..self }
    }

    /// The limit of a load case, or of a parameter in which the loads are linear; `None` before anything is prepared.
    pub fn limit_of(&self, name: &str) -> Option<Result<Limit, PathError>> {
        let case = self.prepared?.case(self.scenario, self.values).watched(self.watch);
        Some(limit::limit(case, self.solved, name))
    }

    pub(super) fn of_load(&self, which: OfLoad, name: &str) -> Result<f64, NoValue> {
        let found = self.limit_of(name).ok_or_else(|| self.missing())?.map_err(|error| NoValue(error.to_string()))?;
        let value = match which {
            OfLoad::Limit => found.factor,
            OfLoad::Safety => found.safety,
        };
        value.ok_or_else(|| NoValue(format!("no limit: {}", found.end_sentence())))
    }

    pub(super) fn critical(&self, parameter: &str) -> Result<f64, NoValue> {
        let prepared = self.prepared.ok_or_else(|| self.missing())?;
        let found = prepared
            .critical_friction(self.values, parameter, self.rules, self.watch)
            .map_err(|error| NoValue(error.to_string()))?;
        found.value.ok_or_else(|| NoValue("no friction was found at which several answers are possible".into()))
    }

    pub(super) fn history(&self) -> Result<&'a History, NoValue> {
        self.history.ok_or_else(|| NoValue("of which history? `stages` follows that of the scenario first".to_owned()))
    }

    pub(super) fn of_stage(&self, stage: usize, inner: &Quantity) -> Result<Value, NoValue> {
        let history = self.history()?;
        // Stages count from 1.
        let Some(found) = history.stages.get(stage - 1) else {
            return none(format!("stage {stage} was not reached: {}", history.end_sentence()));
        };
        let is_of_end = !matches!(inner, Quantity::Answer(OfAnswer::Outcome));
        if is_of_end && !history.has_end_of(stage - 1) {
            return none(format!("`stage {stage}` is its end, which was not reached: {}", history.end_sentence()));
        }
        match inner {
            Quantity::Answer(OfAnswer::Dissipated) => Value::finite(found.dissipated),
            inner => self.at_stage(history, stage - 1).value(inner),
        }
    }
}
