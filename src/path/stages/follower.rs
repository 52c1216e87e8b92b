//! What every way of following a history shares: the stages one after the other, the record of each, and the parts with
//! interference that are put together first. How a single stage is gone through is the follower's own.

use nalgebra::DVector;

use super::Begin;
use super::course::Course;
use super::energy;
use super::integrals::Integrals;
use super::record::{History, HistoryEnd, Moment, StageResult};
use super::standing::Laws;
use crate::answer::pairs::JointState;
use crate::answer::record::{OutcomeKind, PairState, Ray, RayClass, State, Verdict};
use crate::contact::problem::ContactProblem;
use crate::explain::misfit::misfit;
use crate::path::change::{between, sentence, with_directions};
use crate::path::start::PathError;
use crate::solve::Prepared;
use crate::watch::Watch;

/// The place from which a history goes on.
pub(super) struct Place<'a> {
    pub(super) prepared: &'a Prepared,
    pub(super) laws: Laws<'a>,
    pub(super) watch: &'a dyn Watch,
    /// Factor of each load case.
    pub(super) factors: Vec<f64>,
    /// Gap of each pair; those below 0 only once the parts are put together.
    pub(super) gaps: Vec<f64>,
    /// What every pair did on the way here.
    pub(super) way: Vec<(State, Option<State>)>,
}

impl<'a> Place<'a> {
    /// Without loads, interfering parts apart.
    pub(super) fn unloaded(prepared: &'a Prepared, laws: Laws<'a>, watch: &'a dyn Watch) -> Place<'a> {
        let factors = vec![0.0; prepared.cases.len()];
        let gaps = laws.problem.gaps().map(|gap| gap.max(0.0)).collect();
        Place { prepared, laws, watch, factors, gaps, way: Vec::new() }
    }
}

/// The way through a stage.
pub(super) struct Way {
    pub(super) moments: Vec<Moment>,
    pub(super) pivots: usize,
    /// z_τ of its last stretch, over the joints.
    pub(super) last_slip: DVector<f64>,
    /// Where it rests, from place to place ([`super::resting`]).
    pub(super) rests: Vec<[f64; 2]>,
}

impl Way {
    /// From this moment on.
    pub(super) fn from(start: Moment) -> Way {
        let none = DVector::zeros(start.state.z.len());
        Way { moments: vec![start], pivots: 0, last_slip: none, rests: Vec::new() }
    }

    /// A rest, which may go on from another one.
    pub(super) fn rest(&mut self, [from, to]: [f64; 2]) {
        match self.rests.last_mut() {
            Some(last) if last[1] == from => last[1] = to,
            _ => self.rests.push([from, to]),
        }
    }
}

/// The factors of all load cases at the ends of the stages, and the question whether the stages followed are enough.
pub(super) type Targets<'t> = (&'t [Vec<f64>], &'t mut dyn FnMut(&[StageResult]) -> bool);

/// Where a stage ends in a limit: the place in it and the collapse.
pub(super) type Limit = Option<(f64, Ray)>;

/// What follows a history.
pub(super) trait Follower<'a> {
    /// Where it stands.
    fn place(&self) -> &Place<'a>;

    /// Displacements and forces of the joints there.
    fn state(&self) -> JointState;

    /// What belongs to the way there from the moment before, where that is not a straight line.
    fn integrals(&self) -> Option<Integrals> {
        None
    }

    /// What it may be wrong by there, as a share of the largest displacement, where the way is not a straight line.
    fn estimated_error(&self) -> Option<f64> {
        None
    }

    /// The pairs there.
    fn states(&self) -> Vec<PairState>;

    /// The problem under these factors and gaps.
    fn problem_at(&self, factors: &[f64], gaps: &[f64]) -> ContactProblem;

    /// Goes through one stage.
    fn along(&mut self, course: &Course, report: &dyn Fn(f64) -> f64) -> Result<(Way, Limit), PathError>;

    /// Stands under these factors, gaps closed, after slips over the joints that something before has left behind: the
    /// answer of eq. (8) in increments from them. How the run ended where there is none.
    fn stand_behind(&mut self, factors: &[f64], slips: DVector<f64>) -> Result<Option<&'static str>, PathError>;

    /// Goes to where a history begins.
    fn begin(&mut self, begin: &Begin, targets: &[Vec<f64>]) -> Result<(), PathError> {
        let (Begin::Slips(slips), Some(factors)) = (begin, targets.first()) else { return self.put_together() };
        let system = &*self.place().laws.problem.system;
        let slips = system.over_joints(slips.iter().map(|slip| (0.0, *slip)));
        match self.stand_behind(factors, slips)? {
            None => Ok(()),
            Some(how) => Err(PathError::Missing(format!(
                "the structure cannot stand under the first loads with these slips behind it: the run ended {how}"
            ))),
        }
    }

    /// Puts parts with interference (gaps below 0) together.
    fn put_together(&mut self) -> Result<(), PathError> {
        let Place { laws, factors, gaps, .. } = self.place();
        let own: Vec<f64> = laws.problem.gaps().collect();
        if own.iter().all(|gap| *gap >= 0.0) {
            return Ok(());
        }
        let course = Course { factors: [factors.clone(), factors.clone()], gaps: [gaps.clone(), own] };
        let there = "the share of the interference that is put in";
        if let (_, Some((at, collapse))) = self.along(&course, &|_| 0.0).map_err(|error| broken_at(error, there))? {
            let problem = self.place().laws.problem;
            let why = match misfit(problem) {
                Some(misfit) => format!(": {}", misfit.words(&problem.system)),
                None if collapse.class == RayClass::Mechanism => format!(" ({})", collapse.mode),
                None => String::new(),
            };
            let how = format!("in a limit: the parts cannot be put together{why}");
            return Err(PathError::NoStart { name: "interference".to_owned(), at, how });
        }
        Ok(())
    }

    /// The present place as a moment of the record.
    fn moment(&self, t: f64, jump: bool) -> Moment {
        let place = self.place();
        let mut pairs = self.states();
        for (pair, way) in pairs.iter_mut().zip(&place.way) {
            (pair.state, pair.held) = *way;
        }
        Moment {
            t,
            factors: place.factors.clone(),
            pairs,
            changes: Vec::new(),
            sentence: String::new(),
            jump,
            way: place.way.clone(),
            state: self.state(),
            curve: self.integrals(),
        }
    }

    /// Follows the stages one after the other, up to the first limit or until they are enough. The record is without energies:
    /// see [`recorded`].
    fn stages(&mut self, (targets, enough): Targets<'_>) -> Result<(Vec<StageResult>, HistoryEnd), PathError> {
        let mut stages = Vec::new();
        let mut met = DVector::zeros(self.place().laws.problem.system.joint_count());
        for (index, target) in targets.iter().enumerate() {
            let report = |t: f64| (index as f64 + t) / targets.len() as f64;
            let Place { factors, gaps, .. } = self.place();
            let course = Course { factors: [factors.clone(), target.clone()], gaps: [gaps.clone(), gaps.clone()] };
            let before = self.states();
            let (way, limit) = match self.along(&course, &report).map_err(|error| in_stage(error, index)) {
                // What was followed before it stands.
                Err(error @ PathError::Breakdown { .. }) if index > 0 => {
                    return Ok((stages, HistoryEnd::Broken(Box::new(error))));
                }
                followed => followed?,
            };
            for moment in &way.moments {
                met.zip_apply(&moment.state.z, |met: &mut f64, z| *met = met.max(z.abs()));
            }
            stages.push(self.result(way, (&before, &met), limit.as_ref()));
            if let Some((t, collapse)) = limit {
                return Ok((stages, HistoryEnd::Limit { stage: index, t, collapse: Box::new(collapse) }));
            }
            if enough(&stages) {
                break;
            }
        }
        Ok((stages, HistoryEnd::Complete))
    }

    /// A stage that has been followed, from the pairs `before` it; `met` are the largest |z| of all joints up to its end.
    fn result(
        &self,
        mut way: Way,
        (before, met): (&[PairState], &DVector<f64>),
        limit: Option<&(f64, Ray)>,
    ) -> StageResult {
        let Place { prepared, laws, factors, gaps, .. } = self.place();
        let system = &*laws.problem.system;
        tell_changes(&mut way.moments, || system.pairs.iter().map(|pair| pair.id.as_str()));
        let problem = self.problem_at(factors, gaps);
        let pairs = self.states();
        let slip = pairs.iter().zip(before).map(|(pair, before)| slip_since(pair, before)).collect();
        let mut end = prepared.history_answer(&problem, &self.state(), (&way.last_slip, met), pairs);
        // What is proved of a limit does not hang on the last digits of the state before it, whose check tells of them.
        let is_proof = |collapse: &Ray| collapse.verdict.is_some_and(Verdict::is_proof);
        if let Some((_, collapse)) = limit
            && (end.is_answer() || is_proof(collapse))
        {
            if let Some(failure) = end.failure.take() {
                end.notes.push(format!("where the history ends, {failure}; that it ends there is proved by itself"));
            }
            end.outcome = OutcomeKind::Ray;
            end.p = collapse.p;
            end.ray = Some(collapse.clone());
        }
        StageResult {
            dissipated: energy::dissipated(system, &way.moments),
            moments: way.moments,
            pivots: way.pivots,
            rests: way.rests,
            slip,
            energy: None,
            estimated_error: self.estimated_error(),
            end,
        }
    }
}

/// An error on the way, with what is followed there.
fn broken_at(error: PathError, name: &str) -> PathError {
    match error {
        PathError::Breakdown { at, why, .. } => PathError::Breakdown { name: name.to_owned(), at, why },
        other => other,
    }
}

/// An error on the way through a stage, by whose number.
fn in_stage(error: PathError, index: usize) -> PathError {
    broken_at(error, &format!("the place in stage {}", index + 1))
}

/// z_τ of a pair after another state: in space the length of a vector.
fn slip_since(pair: &PairState, before: &PairState) -> f64 {
    match (pair.space, before.space) {
        (Some(now), Some(then)) => (now.z_t[0] - then.z_t[0]).hypot(now.z_t[1] - then.z_t[1]),
        _ => pair.z_t - before.z_t,
    }
}

/// The record of followed stages with its energies.
pub(super) fn recorded(place: &Place<'_>, stages: Vec<StageResult>, end: HistoryEnd) -> History {
    let cases = place.prepared.cases.iter().map(|(name, _)| name.clone()).collect();
    let mut history = History { cases, stages, end };
    energy::balance(place.prepared, place.laws.problem, &mut history);
    history
}

/// What changes at each moment: what the pairs did on the way to it and do after it differs.
fn tell_changes<'i, I: Iterator<Item = &'i str>>(moments: &mut [Moment], ids: impl Fn() -> I) {
    for k in 0..moments.len().saturating_sub(1) {
        let mut changes = between(ids(), &moments[k].way, &moments[k + 1].way);
        with_directions(&mut changes, &moments[k + 1].pairs);
        moments[k].sentence = sentence(&changes);
        moments[k].changes = changes;
    }
}
