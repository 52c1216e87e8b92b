//! What the screen shows of a session: a copy that shares the large parts, so that it can leave the session's thread.

use std::sync::Arc;

use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Structure;
use crate::session::language::complete::Vocabulary;
use crate::session::results::{Answer, NodeDisplacement, PairState, PlainSolution, RayClass, Start};
use crate::session::{Prepared, Remedies, Session, Solved};
use crate::view::difference::{self, Change};

/// A session at one moment.
#[derive(Clone)]
pub struct Shown {
    /// The scenario.
    pub scenario: Arc<Scenario>,
    /// It made ready to be solved, with its structure under the present values.
    prepared: Option<Arc<Prepared>>,
    /// Present parameter values.
    pub values: ParameterValues,
    /// Present rules.
    pub rules: Rules,
    /// The answer; `None` while `auto` is off and something changed.
    pub solved: Option<Arc<Solved>>,
    /// The answer before the last change.
    pub previous: Option<Arc<Solved>>,
    /// The pivot chosen; `None` at the end.
    pub position: Option<usize>,
    /// Pairs at that pivot.
    pub pairs: Vec<PairState>,
    /// Displacements at that pivot.
    pub displacements: Option<Vec<NodeDisplacement>>,
    /// z and w at that pivot; bare LCP only.
    pub solution: Option<PlainSolution>,
    /// p at that pivot.
    pub p: Option<f64>,
    /// Motion of the ray.
    pub mode: Option<Vec<NodeDisplacement>>,
    /// What would stop the collapse, once it was looked for.
    pub remedies: Option<Arc<Remedies>>,
    /// Names for completion.
    pub vocabulary: Vocabulary,
    /// Pairs whose state differs from the answer before.
    pub changes: Vec<Change>,
}

impl Shown {
    /// A picture of the session as it is.
    pub fn of(session: &Session) -> Self {
        let changes = match (session.answer(), session.previous_answer()) {
            (Some(now), Some(before)) => difference::changes(before, now),
            _ => Vec::new(),
        };
        Shown {
            scenario: session.shared_scenario(),
            prepared: session.prepared(),
            values: session.values().clone(),
            rules: session.rules(),
            solved: session.solved(),
            previous: session.previous(),
            position: session.position(),
            pairs: session.pairs(),
            displacements: session.displacements(),
            solution: session.solution(),
            p: session.p(),
            mode: session.mode(),
            remedies: session.remedies(),
            vocabulary: session.vocabulary(),
            changes,
        }
    }

    /// The answer.
    pub fn answer(&self) -> Option<&Answer> {
        self.solved.as_deref().map(|solved| &solved.answer)
    }

    /// The answer before the last change.
    pub fn before(&self) -> Option<&Answer> {
        self.previous.as_deref().map(|solved| &solved.answer)
    }

    /// The structure, if the scenario is one.
    pub fn structure(&self) -> Option<&Structure> {
        match (&self.prepared, &self.scenario.source) {
            (Some(prepared), _) => prepared.structure(),
            (None, Source::Structure(structure)) => Some(structure),
            (None, _) => None,
        }
    }

    /// Step of the last pivot.
    pub fn last_step(&self) -> Option<usize> {
        self.answer()?.pivot_count.checked_sub(1)
    }

    /// Step of the pivot shown.
    pub fn step(&self) -> Option<usize> {
        let last = self.last_step()?;
        Some(self.position.unwrap_or(last))
    }

    /// Whether the ray itself is shown: its end, not a pivot on the way.
    pub fn at_ray(&self) -> bool {
        self.position.is_none() && self.answer().is_some_and(|answer| answer.ray.is_some())
    }

    /// Whether this is a collapse of which it is not known yet what would stop it.
    pub fn lacks_remedies(&self) -> bool {
        let ray = self.answer().and_then(|answer| answer.ray.as_ref());
        self.remedies.is_none() && ray.is_some_and(|ray| ray.class == RayClass::Mechanism)
    }

    /// Whether the answer was followed from the last one and has no pivots yet.
    pub fn is_warm(&self) -> bool {
        self.answer().is_some_and(|answer| answer.start != Start::Cold)
    }

    /// Whether the answer before is worth showing beside the present one.
    pub fn has_before(&self) -> bool {
        self.position.is_none()
            && self.before().is_some_and(|before| before.is_answer() && before.pairs.len() == self.pairs.len())
            && self.answer().is_some_and(Answer::is_answer)
    }
}
