//! What the screen shows of a session: a copy that shares the large parts, so that it can leave the session's thread.

use std::sync::{Arc, OnceLock};

use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::model::scenario::{Scenario, Source, Stage};
use crate::model::structure::Structure;
use crate::session::language::complete::Vocabulary;
use crate::session::results::{Answer, NodeDisplacement, PairState, PlainSolution, RayClass, Start};
use crate::session::{History, Prepared, Remedies, Session, Solved};
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
    /// The load history that was followed.
    pub history: Option<Arc<History>>,
    /// Its stage that is shown, from 0, in the place of the answer; `Some` while there is a history.
    pub stage: Option<usize>,
    /// The combination whose answer is shown.
    pub combination: Option<String>,
    /// The state there.
    pub moment: Arc<Moment>,
    /// Whether the files of the scenario are watched.
    pub watches: bool,
    /// What would stop the collapse, once it was looked for.
    pub remedies: Option<Arc<Remedies>>,
    /// Names for completion, gathered when the first letter asks for them.
    vocabulary: Arc<OnceLock<Vocabulary>>,
}

/// The state at the place shown. It stays the same one until another answer or another pivot is shown, so that what is
/// drawn of it can be kept.
#[derive(Clone, Default)]
pub struct Moment {
    /// The pairs.
    pub pairs: Vec<PairState>,
    /// Pairs whose state differs from the answer before; empty at a pivot on the way.
    pub changes: Vec<Change>,
    /// Of each pair, which of the changes is its own.
    change_of: Vec<Option<usize>>,
    /// z and w; bare LCP only.
    pub solution: Option<PlainSolution>,
    /// p.
    pub p: Option<f64>,
    /// Displacements at a pivot on the way, motion of a ray at its end.
    motion: Arc<Motion>,
    /// Whether `motion` is still that of what was shown before: the states are drawn first.
    is_behind: bool,
}

/// What moves; it takes a solution of the whole structure.
#[derive(Clone, Default)]
struct Motion {
    displacements: Option<Vec<NodeDisplacement>>,
    mode: Option<Vec<NodeDisplacement>>,
}

impl Motion {
    fn of(session: &Session) -> Self {
        Motion {
            // at the end they stand in the answer
            displacements: session.position().and_then(|_| session.displacements()),
            mode: session.mode(),
        }
    }
}

impl Shown {
    /// A picture of the session as it is.
    pub fn of(session: &Session) -> Self {
        Self::take(session, None)
    }

    /// A picture of the session as it is now, where `last` was shown before: what did not change is taken from there,
    /// and so is what takes long, until [`Shown::complete`].
    pub fn after(last: &Shown, session: &Session) -> Self {
        Self::take(session, Some(last))
    }

    fn take(session: &Session, last: Option<&Shown>) -> Self {
        let mut shown = Shown {
            scenario: session.shared_scenario(),
            prepared: session.prepared(),
            values: session.values().clone(),
            rules: session.rules(),
            solved: session.solved(),
            previous: session.previous(),
            position: session.position(),
            history: session.history_followed(),
            stage: None,
            combination: session.combination().map(str::to_owned),
            moment: Arc::default(),
            watches: session.watched().is_some(),
            remedies: session.remedies(),
            vocabulary: Arc::default(),
        };
        if let Some(history) = &shown.history {
            let kept = last.filter(|last| last.history.as_ref().is_some_and(|last| Arc::ptr_eq(last, history)));
            shown.stage = kept.and_then(|last| last.stage).or(history.stages.len().checked_sub(1));
            shown.position = None;
        }
        match last.filter(|last| last.is_same_moment(&shown)) {
            Some(last) => shown.moment = Arc::clone(&last.moment),
            None => {
                let mut moment = Moment::of(session, &shown);
                match last.filter(|last| Arc::ptr_eq(&last.scenario, &shown.scenario) && shown.needs_motion()) {
                    Some(last) => (moment.motion, moment.is_behind) = (Arc::clone(&last.moment.motion), true),
                    None => moment.motion = Arc::new(Motion::of(session)),
                }
                shown.moment = Arc::new(moment);
            }
        }
        if let Some(last) =
            last.filter(|last| Arc::ptr_eq(&last.scenario, &shown.scenario) && last.values == shown.values)
        {
            shown.vocabulary = Arc::clone(&last.vocabulary);
        }
        shown
    }

    fn is_same_moment(&self, other: &Shown) -> bool {
        fn same<T>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
            match (a, b) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                (None, None) => true,
                _ => false,
            }
        }
        self.solved.is_some()
            && same(&self.solved, &other.solved)
            && same(&self.previous, &other.previous)
            && same(&self.history, &other.history)
            && (self.position, self.stage) == (other.position, other.stage)
    }

    /// Whether something moves that the answer does not contain.
    fn needs_motion(&self) -> bool {
        self.structure().is_some() && (self.position.is_some() || self.at_ray())
    }

    /// The same at the end of another stage, from 0.
    pub fn at_stage(mut self, stage: usize, session: &Session) -> Shown {
        if self.stage.is_some() && self.stage != Some(stage) {
            self.stage = Some(stage);
            self.moment = Arc::new(Moment::of(session, &self));
        }
        self
    }

    /// Whether displacements are still to come: see [`Shown::complete`].
    pub fn is_behind(&self) -> bool {
        self.moment.is_behind
    }

    /// Computes what [`Shown::after`] left out, if the session still stands there.
    pub fn complete(&mut self, session: &Session) {
        if self.moment.is_behind {
            let mut moment = (*self.moment).clone();
            (moment.motion, moment.is_behind) = (Arc::new(Motion::of(session)), false);
            self.moment = Arc::new(moment);
        }
    }

    /// Names for completion.
    pub fn vocabulary(&self) -> &Vocabulary {
        self.vocabulary.get_or_init(|| Vocabulary::of(&self.scenario, &self.values))
    }

    /// The answer, or the end of the stage shown.
    pub fn answer(&self) -> Option<&Answer> {
        match self.stage {
            Some(stage) => self.stage_end(stage),
            None => self.solved.as_deref().map(|solved| &solved.answer),
        }
    }

    fn stage_end(&self, stage: usize) -> Option<&Answer> {
        Some(&self.history.as_ref()?.stages.get(stage)?.end)
    }

    /// The answer before the last change; before a stage the one ahead of it.
    pub fn before(&self) -> Option<&Answer> {
        match self.stage {
            Some(stage) => self.stage_end(stage.checked_sub(1)?),
            None => self.previous.as_deref().map(|solved| &solved.answer),
        }
    }

    /// By which the factor of a load case is multiplied in the loading shown.
    pub fn multiplier(&self, case: &str) -> f64 {
        let scenario = &self.scenario;
        let of = |name: &String| scenario.combinations.iter().find(|(known, _)| known == name);
        let shown = match (self.stage, &self.combination) {
            (Some(stage), _) => scenario.stages.get(stage),
            (None, Some(name)) => of(name).map(|(_, combination)| combination),
            (None, None) => None,
        };
        let named = |stage: &Stage| {
            let number = stage.multipliers.iter().find(|(known, _)| known == case);
            number.map_or(0.0, |(_, number)| number.value(&self.values))
        };
        shown.map_or(1.0, named)
    }

    /// Pairs at the pivot shown.
    pub fn pairs(&self) -> &[PairState] {
        &self.moment.pairs
    }

    /// Displacements at the pivot shown; while [`Shown::is_behind`] those of what was shown before.
    pub fn displacements(&self) -> Option<&[NodeDisplacement]> {
        match (self.position, self.answer()) {
            (None, Some(answer)) => answer.displacements.as_deref(),
            _ => self.moment.motion.displacements.as_deref(),
        }
    }

    /// Motion of the ray.
    pub fn mode(&self) -> Option<&[NodeDisplacement]> {
        self.moment.motion.mode.as_deref()
    }

    /// What the last change did to a pair.
    pub fn change(&self, pair: usize) -> Option<&Change> {
        let index = self.moment.change_of.get(pair).copied().flatten()?;
        self.moment.changes.get(index)
    }

    /// The structure, if the scenario is one.
    pub fn structure(&self) -> Option<&Structure> {
        match (&self.prepared, &self.scenario.source) {
            (Some(prepared), _) => prepared.structure(),
            (None, Source::Structure(structure)) => Some(structure),
            (None, _) => None,
        }
    }

    /// Step of the last pivot; a stage has none that led to its end alone.
    pub fn last_step(&self) -> Option<usize> {
        if self.stage.is_some() {
            return None;
        }
        self.answer()?.pivot_count.checked_sub(1)
    }

    /// Step of the pivot shown.
    pub fn step(&self) -> Option<usize> {
        let last = self.last_step()?;
        Some(self.position.unwrap_or(last))
    }

    /// Whether the ray itself is shown: its end, not a pivot on the way, not a stage that ended in one.
    pub fn at_ray(&self) -> bool {
        self.stage.is_none() && self.position.is_none() && self.answer().is_some_and(|answer| answer.ray.is_some())
    }

    /// Whether this is a collapse of which it is not known yet what would stop it.
    pub fn lacks_remedies(&self) -> bool {
        let ray = self.answer().and_then(|answer| answer.ray.as_ref());
        self.stage.is_none() && self.remedies.is_none() && ray.is_some_and(|ray| ray.class == RayClass::Mechanism)
    }

    /// Whether the answer was followed from the last one and has no pivots yet.
    pub fn is_warm(&self) -> bool {
        self.stage.is_none() && self.answer().is_some_and(|answer| answer.start != Start::Cold)
    }

    /// Whether the answer before is worth showing beside the present one.
    pub fn has_before(&self) -> bool {
        self.position.is_none()
            && self.before().is_some_and(|before| before.is_answer() && before.pairs.len() == self.pairs().len())
            && self.answer().is_some_and(Answer::is_answer)
    }

    /// The same with nothing before it.
    pub fn without_before(&self) -> Shown {
        let mut shown = self.clone();
        shown.previous = None;
        let moment = Arc::make_mut(&mut shown.moment);
        moment.changes.clear();
        moment.change_of.clear();
        shown
    }
}

impl Moment {
    fn of(session: &Session, shown: &Shown) -> Self {
        let pairs = match (shown.stage, shown.answer()) {
            (Some(_), Some(end)) => end.pairs.clone(),
            _ => session.pairs(),
        };
        let changes = match (shown.answer(), shown.before()) {
            (Some(now), Some(before)) if shown.position.is_none() => difference::changes(before, now),
            _ => Vec::new(),
        };
        // changes come in the order of the pairs
        let mut rest = changes.iter().enumerate().peekable();
        let change_of = pairs
            .iter()
            .map(|pair| rest.next_if(|(_, change)| change.pair == pair.id).map(|(index, _)| index))
            .collect();
        let (solution, p) = match shown.stage {
            Some(_) => (None, None),
            None => (session.solution(), session.p()),
        };
        Moment { pairs, changes, change_of, solution, p, ..Moment::default() }
    }
}
