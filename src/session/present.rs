//! The session as it stands: scenario, values, rules, and the answer at the pivot that is shown.

use std::sync::Arc;

use serde_json::{Value, json};

use super::results::{NodeDisplacement, PairState, PlainSolution};
use super::{Answer, CommandError, Prepared, Session, Solved};
use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Structure;
use crate::path::record::PathRecord;

impl Session {
    /// The scenario as loaded.
    pub fn scenario(&self) -> &Scenario {
        &self.now.scenario
    }

    /// The scenario, shared: equal pointers mean that nothing was loaded in between.
    pub fn shared_scenario(&self) -> Arc<Scenario> {
        Arc::clone(&self.now.scenario)
    }

    /// The present parameter values.
    pub fn values(&self) -> &ParameterValues {
        &self.now.values
    }

    /// The present rules.
    pub fn rules(&self) -> Rules {
        self.now.rules
    }

    /// Whether each change is solved at once.
    pub fn auto(&self) -> bool {
        self.auto
    }

    /// The present answer; `None` after a change with `auto` off.
    pub fn answer(&self) -> Option<&Answer> {
        self.solved.as_deref().map(|solved| &solved.answer)
    }

    /// The present solved state, shared.
    pub fn solved(&self) -> Option<Arc<Solved>> {
        self.solved.clone()
    }

    /// The prepared geometry, shared.
    pub fn prepared(&self) -> Option<Arc<Prepared>> {
        self.now.prepared.clone()
    }

    /// The structure under the parameter values of the present answer, if the scenario is one.
    pub fn structure(&self) -> Option<&Structure> {
        match (&self.now.prepared, &self.now.scenario.source) {
            (Some(prepared), _) => prepared.structure(),
            (None, Source::Structure(structure)) => Some(structure),
            (None, _) => None,
        }
    }

    /// The answer before the last change.
    pub fn previous_answer(&self) -> Option<&Answer> {
        self.previous.as_deref().map(|solved| &solved.answer)
    }

    /// The solved state before the last change, shared.
    pub fn previous(&self) -> Option<Arc<Solved>> {
        self.previous.clone()
    }

    /// The pivot chosen by `step`; `None` at the end.
    pub fn position(&self) -> Option<usize> {
        self.position
    }

    /// The step of the pivot shown; `None` where there are no pivots.
    pub fn shown_step(&self) -> Option<usize> {
        let last = self.answer()?.pivot_count.checked_sub(1)?;
        Some(self.position.unwrap_or(last))
    }

    /// The pairs at the pivot shown.
    pub fn pairs(&self) -> Vec<PairState> {
        let Some(solved) = &self.solved else {
            return Vec::new();
        };
        self.position
            .zip(self.now.prepared.as_ref())
            .and_then(|(step, prepared)| solved.pairs_at(prepared, step))
            .unwrap_or_else(|| solved.answer.pairs.clone())
    }

    /// p at the pivot shown, a force ≥ 0.
    pub fn p(&self) -> Option<f64> {
        let solved = self.solved.as_ref()?;
        match self.position {
            Some(step) => solved.p_at(step),
            None => Some(solved.answer.p),
        }
    }

    /// The displacements at the pivot shown; `None` where there are none.
    pub fn displacements(&self) -> Option<Vec<NodeDisplacement>> {
        let solved = self.solved.as_ref()?;
        match self.position.zip(self.now.prepared.as_ref()) {
            Some((step, prepared)) => solved.displacements_at(prepared, step),
            None => solved.answer.displacements.clone(),
        }
    }

    /// z and w of a bare LCP at the pivot shown; `None` for contact problems.
    pub fn solution(&self) -> Option<PlainSolution> {
        let solved = self.solved.as_ref()?;
        match self.position {
            Some(step) => solved.plain_at(step),
            None => solved.answer.solution.clone(),
        }
    }

    /// What the last `trace` or `stages` followed.
    pub fn path(&self) -> Option<Arc<PathRecord>> {
        self.path.clone()
    }

    /// The commands given so far.
    pub fn history(&self) -> &[String] {
        &self.history
    }

    /// How many changes can be taken back, and done again.
    pub fn undo_depths(&self) -> (usize, usize) {
        (self.undo.len(), self.redo.len())
    }

    /// The exit status a script or pipe has earned by a run without an answer; 0 without one.
    pub fn trouble_status(&self) -> u8 {
        if self.trouble { 4 } else { 0 }
    }

    /// The present answer.
    ///
    /// # Errors
    /// There is none because `auto` is off.
    pub(super) fn need_answer(&self) -> Result<&Answer, CommandError> {
        self.answer().ok_or_else(|| CommandError::Refused("not solved yet: `solve`, or `set auto on`".into()))
    }

    /// The error of a result that this answer or source does not have.
    pub(super) fn none(&self, what: &str, answer: &Answer) -> CommandError {
        CommandError::Refused(match self.now.scenario.source {
            Source::Structure(_) if !answer.is_answer() => {
                format!("no {what}: there is no answer ({})", answer.outcome.word())
            }
            Source::Structure(_) => format!("no {what} at this pivot: `step last`"),
            Source::ContactSystem(_) => {
                format!("no {what}: the scenario is a contact system, not a structure")
            }
            Source::Lcp(_) => format!("no {what}: the scenario is a bare LCP"),
        })
    }

    /// Outcome, pivots, parameters and rules.
    pub(super) fn status_json(&self) -> Value {
        let values = json!(self.now.values);
        match self.answer() {
            None => json!({"outcome": null, "parameters": values}),
            Some(answer) => {
                let mut report = json!({
                    "outcome": answer.outcome,
                    "marginal": answer.marginal,
                    "ray": answer.ray.as_ref().map(|ray| json!(ray.class)),
                    "p": answer.p,
                    "pivots": answer.pivot_count,
                    "parameters": values,
                    "covering": answer.rules.covering,
                    "tie_break": answer.rules.tie_break,
                    "engine": answer.rules.engine,
                });
                if let (Some(failure), Value::Object(map)) = (&answer.failure, &mut report) {
                    map.insert("failure".into(), json!(failure));
                }
                report
            }
        }
    }

    /// The geometry and the answer.
    pub(super) fn both(&self) -> Result<(Arc<Prepared>, Arc<Solved>), CommandError> {
        self.need_answer()?;
        match (&self.now.prepared, &self.solved) {
            (Some(prepared), Some(solved)) => Ok((Arc::clone(prepared), Arc::clone(solved))),
            _ => Err(CommandError::Refused("not solved yet: `solve`".into())),
        }
    }

    /// What only contact holds, in sentences.
    pub(super) fn loose(&self) -> Vec<String> {
        self.now.prepared.as_ref().map_or_else(Vec::new, |prepared| prepared.loose_sentences())
    }
}
