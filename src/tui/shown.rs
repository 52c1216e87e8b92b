//! What the screen shows of a session: a copy that shares the large parts, so that it can leave the session's thread.

use std::sync::{Arc, OnceLock};

use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::model::scenario::{Scenario, Source, Stage};
use crate::model::structure::Structure;
use crate::session::language::complete::Vocabulary;
use crate::session::results::{Answer, NodeDisplacement, PairState, PlainSolution, RayClass, Start};
use crate::session::shared::is_same;
use crate::session::{DrawnMap, Glance, History, Prepared, Remedies, Session, Solved};
use crate::view::difference::{self, Change};
use crate::view::plot::scene::{Magnification, factor, nodal};
use crate::view::plot::skeleton::Skeleton;
use crate::view::projection::Viewpoint;

/// A session at one moment.
#[derive(Clone)]
pub struct Shown {
    /// The scenario.
    pub scenario: Arc<Scenario>,
    /// The scenario made ready to be solved, with its structure under the present values.
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
    /// From where a structure in space is seen.
    pub viewpoint: Viewpoint,
    /// The state there.
    pub moment: Arc<Moment>,
    /// How the structure moves there.
    pub motion: Arc<Motion>,
    /// Whether `motion` is still that of what was shown before: the states are drawn first.
    is_behind: bool,
    /// Whether the files of the scenario are watched.
    pub watches: bool,
    /// What would stop the collapse, once it was looked for.
    pub remedies: Option<Arc<Remedies>>,
    /// The last map, and under which other values than the present ones it was drawn, if it was.
    pub map: Option<(Arc<DrawnMap>, Option<String>)>,
    /// The place in the map whose answer is shown in the place of the session's.
    pub glance: Option<[f64; 2]>,
    /// Names for completion, gathered when the first letter asks for them.
    vocabulary: Arc<OnceLock<Vocabulary>>,
    /// What pictures of the structure share, gathered for the first of them.
    skeleton: Arc<OnceLock<Arc<Skeleton>>>,
}

/// The state at the place shown. It stays the same one until another answer or another pivot is shown, so that what is
/// drawn of it can be kept.
#[derive(Clone, Default, PartialEq)]
pub struct Moment {
    /// The pairs.
    pub pairs: Vec<PairState>,
    /// Pairs whose state differs from the answer before; empty at a pivot on the way.
    pub changes: Vec<Change>,
    /// For each pair, which of the changes is its own.
    change_of: Vec<Option<usize>>,
    /// z and w; bare LCP only.
    pub solution: Option<PlainSolution>,
    /// p.
    pub p: Option<f64>,
}

/// How the structure moves at the place shown; it takes a solution of the whole structure.
#[derive(Clone, Default)]
pub struct Motion {
    /// u_x, u_y and the rotation of every node, for a ray its mode; `None` where nothing is known to move.
    pub u: Option<Vec<[f64; 6]>>,
    /// Factors of the load cases that bend bars between their nodes, and those of the answer before; none for a mode.
    pub factors: [Vec<f64>; 2],
    /// Likewise for the answer before, where it is worth showing.
    pub before: Option<Vec<[f64; 6]>>,
    /// The automatic scale. It is that of the answer while its pivots are shown, so that pictures can be compared.
    pub automatic: f64,
}

impl Motion {
    fn of(session: &Session, shown: &Shown) -> Self {
        let there = match (shown.at_ray(), shown.position) {
            (true, _) => session.mode(),
            (false, Some(_)) => session.displacements(),
            (false, None) => None,
        };
        Motion::new(shown, there)
    }

    /// `there`: displacements at a pivot on the way, or the mode of the ray shown.
    fn new(shown: &Shown, there: Option<Vec<NodeDisplacement>>) -> Self {
        let Some((structure, skeleton)) = shown.structure().zip(shown.skeleton()) else { return Motion::default() };
        let of_answer = |answer: &Answer| answer.displacements.as_deref().map(|u| nodal(structure, u));
        let end = shown.answer().and_then(of_answer);
        let u = match there {
            Some(there) => Some(nodal(structure, &there)),
            None if shown.at_ray() || shown.position.is_some() => None,
            None => end.clone(),
        };
        let before = shown.before().filter(|_| shown.has_before()).and_then(of_answer);
        let factors = if shown.at_ray() { Default::default() } else { shown.factors() };
        let moves = |u: &Vec<[f64; 6]>| u.iter().any(|u| u[..3] != [0.0; 3]);
        let measured = end.as_ref().filter(|end| moves(end) && !shown.at_ray()).or(u.as_ref());
        let automatic = measured.map_or(1.0, |u| factor((structure, skeleton), &factors[0], u, Magnification::Auto));
        Motion { before: before.filter(|before| u.as_ref() != Some(before)), u, factors, automatic }
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
            viewpoint: session.viewpoint(),
            moment: Arc::default(),
            motion: Arc::default(),
            is_behind: false,
            watches: session.watched().is_some(),
            remedies: session.remedies(),
            map: session.last_map(),
            glance: None,
            vocabulary: Arc::default(),
            skeleton: Arc::default(),
        };
        if let Some(last) = last.filter(|last| last.has_structure_of(&shown)) {
            shown.skeleton = Arc::clone(&last.skeleton);
        }
        if let Some(history) = &shown.history {
            let kept = last.filter(|last| last.history.as_ref().is_some_and(|last| Arc::ptr_eq(last, history)));
            shown.stage = kept.and_then(|last| last.stage).or(history.stages.len().checked_sub(1));
            shown.position = None;
        }
        match last.filter(|last| last.is_same_moment(&shown)) {
            Some(last) => {
                (shown.moment, shown.motion) = (Arc::clone(&last.moment), Arc::clone(&last.motion));
                shown.is_behind = last.is_behind;
            }
            None => {
                let moment = Moment::of(session, &shown);
                shown.moment = match last.filter(|last| last.is_completed_by(&shown) && *last.moment == moment) {
                    Some(last) => Arc::clone(&last.moment),
                    None => Arc::new(moment),
                };
                match last.filter(|last| Arc::ptr_eq(&last.scenario, &shown.scenario) && shown.needs_motion()) {
                    Some(last) => (shown.motion, shown.is_behind) = (Arc::clone(&last.motion), true),
                    None => shown.motion = Arc::new(Motion::of(session, &shown)),
                }
            }
        }
        if let Some(last) =
            last.filter(|last| Arc::ptr_eq(&last.scenario, &shown.scenario) && last.values == shown.values)
        {
            shown.vocabulary = Arc::clone(&last.vocabulary);
        }
        shown
    }

    /// The answer at a place of the map, beside the session, which `last` showed or another such answer.
    pub fn beside(last: &Shown, session: &Session, glance: Glance, at: [f64; 2]) -> Self {
        let mut shown = Shown {
            prepared: Some(glance.prepared),
            values: glance.values,
            solved: Some(glance.solved),
            previous: session.solved(),
            position: None,
            history: None,
            stage: None,
            combination: None,
            map: session.last_map(),
            remedies: None,
            is_behind: false,
            glance: Some(at),
            ..last.clone()
        };
        if !last.has_structure_of(&shown) {
            shown.skeleton = Arc::default();
        }
        shown.moment = Arc::new(Moment::of(session, &shown));
        shown.motion = Arc::new(Motion::new(&shown, glance.mode));
        shown
    }

    /// Whether the structure of both is one, with the same places of its nodes.
    fn has_structure_of(&self, other: &Shown) -> bool {
        let is_prepared = self.prepared.is_some();
        is_same(&self.prepared, &other.prepared) && (is_prepared || Arc::ptr_eq(&self.scenario, &other.scenario))
    }

    fn is_same_moment(&self, other: &Shown) -> bool {
        self.solved.is_some()
            && is_same(&self.solved, &other.solved)
            && is_same(&self.previous, &other.previous)
            && is_same(&self.history, &other.history)
            && (self.position, self.stage) == (other.position, other.stage)
            && self.glance == other.glance
    }

    /// Whether the other shows the same answer with what this one lacks.
    fn is_completed_by(&self, other: &Shown) -> bool {
        !self.is_whole()
            && other.is_whole()
            && Arc::ptr_eq(&self.scenario, &other.scenario)
            && self.values == other.values
            && (self.position, self.stage) == (other.position, other.stage)
    }

    /// Whether something moves that the answer does not contain.
    fn needs_motion(&self) -> bool {
        self.structure().is_some() && (self.position.is_some() || self.at_ray() || !self.is_whole())
    }

    /// The same at the end of another stage, from 0.
    pub fn at_stage(mut self, stage: usize, session: &Session) -> Shown {
        if self.stage.is_some() && self.stage != Some(stage) {
            self.stage = Some(stage);
            self.moment = Arc::new(Moment::of(session, &self));
            self.motion = Arc::new(Motion::of(session, &self));
        }
        self
    }

    /// Whether the answer has its displacements and the check of equilibrium.
    pub fn is_whole(&self) -> bool {
        self.solved.as_ref().is_none_or(|solved| solved.is_whole())
    }

    /// Whether displacements are still to come: see [`Shown::complete`].
    pub fn is_behind(&self) -> bool {
        self.is_behind
    }

    /// Computes what [`Shown::after`] left out, if the session still stands there.
    pub fn complete(&mut self, session: &Session) {
        if self.is_behind {
            (self.motion, self.is_behind) = (Arc::new(Motion::of(session, self)), false);
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

    /// Factors of the load cases in the answer, or at the end of the stage shown, and in the answer before.
    fn factors(&self) -> [Vec<f64>; 2] {
        let of = |solved: &Option<Arc<Solved>>| solved.as_ref().map_or(Vec::new(), |solved| solved.factors().to_vec());
        let Some(stage) = self.stage else { return [of(&self.solved), of(&self.previous)] };
        let at = |stage: usize| Some(self.history.as_ref()?.stages.get(stage)?.factors().to_vec());
        [at(stage), stage.checked_sub(1).and_then(at)].map(Option::unwrap_or_default)
    }

    /// What the factor of a load case is multiplied by in the loading shown.
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

    /// Whether the ray shown has a motion that can be drawn.
    pub fn has_mode(&self) -> bool {
        self.at_ray() && !self.is_behind && self.motion.u.is_some()
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

    /// What pictures of the structure share.
    pub fn skeleton(&self) -> Option<&Arc<Skeleton>> {
        let structure = self.structure()?;
        Some(self.skeleton.get_or_init(|| Arc::new(Skeleton::of(structure))))
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
        self.stage.is_none()
            && self.glance.is_none()
            && self.remedies.is_none()
            && ray.is_some_and(|ray| ray.class == RayClass::Mechanism)
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
        Arc::make_mut(&mut shown.motion).before = None;
        shown
    }
}

impl Moment {
    fn of(session: &Session, shown: &Shown) -> Self {
        let elsewhere = shown.answer().filter(|_| shown.stage.is_some() || shown.glance.is_some());
        let pairs = elsewhere.map_or_else(|| session.pairs(), |answer| answer.pairs.clone());
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
        let (solution, p) = match (shown.stage, elsewhere) {
            (Some(_), _) => (None, None),
            (None, Some(answer)) => (answer.solution.clone(), Some(answer.p)),
            (None, None) => (session.solution(), session.p()),
        };
        Moment { pairs, changes, change_of, solution, p }
    }
}
