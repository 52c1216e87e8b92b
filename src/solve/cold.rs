//! Solving from z = 0.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use super::case::Case;
use super::cone;
use super::engines::{EXACT_PAIRS, keep_scheme, kind, run_exact_contact, run_tableau};
use super::error::SolveError;
use super::finish::empty_answer;
use super::ladder::{EXACT_BUDGET, within};
use super::plain::{PlainProblem, solve_plain_judged};
use super::prepared::{Geometry, Prepared};
use super::state::{LookedAt, Rest, RunData, Solved};
use super::warm::WarmStart;
use crate::answer::pairs::{JointState, joint_state, pair_states};
use crate::answer::record::{AttemptRules, OutcomeKind, PolygonRecord};
use crate::contact::kernel_correction::kernel_correction;
use crate::contact::lcp::contact_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::refine::refined;
use crate::contact::written::ContactLcp;
use crate::explain::{ray, sentence};
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::parametric::Parametric;
use crate::lcp::pivot::PivotLog;
use crate::model::rules::{Covering, Engine, Rules};
use crate::watch::{Quiet, Watch};

/// How much of an answer is worked out at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    /// All of it.
    Whole,
    /// States and forces of the joints with their check; [`Case::whole`] works out the rest.
    Joints,
    /// The same without descriptions of the pivots: for callers that check the equilibrium of many answers together.
    Counted,
}

impl Case<'_> {
    /// Solves.
    ///
    /// # Errors
    /// See [`SolveError`]. A run that ends in a ray or breaks down is not an error: the answer says so.
    pub fn solve(self) -> Result<Solved, SolveError> {
        self.solve_as(false, Extent::Whole)
    }

    /// As [`Case::solve`], without looking for what would stop a collapse: for sweeps, which only count.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn solve_briefly(self) -> Result<Solved, SolveError> {
        self.solve_as(true, Extent::Whole)
    }

    pub(super) fn solve_as(self, brief: bool, extent: Extent) -> Result<Solved, SolveError> {
        let Case { scenario, prepared, values, rules, watch } = self;
        if let Some(refusal) = scenario.law_refusal(values) {
            return Err(SolveError::Value(refusal));
        }
        let start = Instant::now();
        let mut solved = match &*prepared.geometry {
            Geometry::Plain { lcp, q, names, covering_given } => {
                if rules.covering != Covering::default() {
                    return Err(SolveError::CoveringOfPlain(rules.covering));
                }
                let problem = PlainProblem::new(lcp, q, values, names, *covering_given);
                solve_plain_judged(&problem, rules, watch)?
            }
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => {
                prepared.solve_contact_judged(system, values, (rules, extent), brief, watch)?
            }
        };
        if let Geometry::Contact { remarks, .. } = &*prepared.geometry {
            solved.answer.notes.extend(remarks.iter().cloned());
        }
        solved.answer.notes.extend(scenario.notes.iter().cloned());
        if !scenario.stages.is_empty() {
            solved.answer.notes.push(
                "every load case acts at once with its factor: the load history of the scenario was not followed \
                 (`stages` follows it)"
                    .to_owned(),
            );
        }
        let timings = &mut solved.answer.timings;
        timings.factor = prepared.factor_seconds;
        timings.condense = prepared.condense_seconds;
        timings.total = prepared.seconds + start.elapsed().as_secs_f64();
        Ok(solved)
    }
}

impl Prepared {
    /// One run under exactly these rules. A ray is classified; nothing is proved of it yet.
    ///
    /// A p that is small beside the load counts as zero only where the state passes its check without it; otherwise the
    /// run ends in a ray.
    pub(super) fn attempt_contact(
        &self,
        problem: &ContactProblem,
        (rules, extent): (Rules, Extent),
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let contact = contact_lcp(problem, rules.covering)?;
        let mut solved = self.run_contact(problem, contact.clone(), (rules, extent), watch)?;
        if !solved.answer.marginal {
            return Ok(solved);
        }
        solved = solved.completed();
        let mut strict = contact;
        Arc::make_mut(&mut strict.lcp).scale.load = Some(0.0);
        if !solved.answer.check.passed {
            return self.run_contact(problem, strict, (rules, extent), watch);
        }
        let system = &problem.system;
        if system.has_exact_data() && !system.is_in_space() && system.turning_pairs() <= EXACT_PAIRS {
            // Exact data may say that nothing of p is left after all; in space they are of the polygon only.
            let exact = Rules { engine: Engine::Exact, ..rules };
            let attempt = |watch: &dyn Watch| self.run_contact(problem, strict, (exact, extent), watch);
            if let Some(again) = within(EXACT_BUDGET, watch, attempt)?
                && again.answer.is_answer()
                && !again.answer.marginal
            {
                return Ok(again);
            }
        }
        Ok(solved)
    }

    fn run_contact(
        &self,
        problem: &ContactProblem,
        contact: ContactLcp,
        (rules, extent): (Rules, Extent),
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let system = &*problem.system;
        let start = Instant::now();
        let (mut run, engine) = run_engine(problem, &contact, rules, watch)?;
        let basis = run.pivots.basis();
        match &run.outcome {
            Outcome::Ray(_) if rules.engine != Engine::Exact => {
                run.point = kernel_correction(problem, &contact, &basis, run.point);
            }
            Outcome::Normal { .. } => {
                run.point = refined(problem, &contact, run.point);
                // An answer must hold without the covering: that is how it is checked.
                run.point.p = 0.0;
            }
            _ => {}
        }
        let seconds = start.elapsed().as_secs_f64();
        let mut solved = self.state_of(problem, contact, run, (rules.into(), extent), watch)?;
        solved.answer.timings.lemke = seconds;
        solved.answer.ray = solved.ray.as_ref().map(|report| report.record(system, rules.covering));
        if let RunData::Contact { contact, pivots, .. } = &solved.run {
            if extent != Extent::Counted {
                solved.answer.pivots = sentence::pivot_records(pivots.recorded(), contact, system);
            }
            // A warm start can follow only slips along one line, + or −.
            if let Some(engine) = engine.filter(|_| solved.answer.is_answer() && !system.is_in_space()) {
                let warm = WarmStart::new(engine, contact.clone(), problem.clone());
                solved.warm = Some(Arc::new(Mutex::new(Some(warm))));
            }
        }
        if solved.answer.outcome == OutcomeKind::CheckFailed {
            self.prove_after_all(&mut solved, watch);
        }
        Ok(solved)
    }

    /// The state at a point found other than by pivots from z = 0, freshly checked.
    pub(super) fn answer_at(
        &self,
        problem: &ContactProblem,
        contact: ContactLcp,
        point: Point,
        rules: AttemptRules,
        extent: Extent,
    ) -> Result<Solved, SolveError> {
        let point = refined(problem, &contact, point);
        let run = Run { outcome: Outcome::Normal { marginal: false }, pivots: PivotLog::default(), point };
        self.state_of(problem, contact, run, (rules, extent), &Quiet)
    }

    /// What a run ended in: the pairs; for an answer the rest of that extent, with its check; for a ray its class.
    fn state_of(
        &self,
        problem: &ContactProblem,
        contact: ContactLcp,
        run: Run,
        (rules, extent): (AttemptRules, Extent),
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let system = &*problem.system;
        let mut state = joint_state(problem, &contact, &run.point);
        let mut problem = problem.clone();
        let (mut note, mut polygon) = (None, None);
        let is_answer = kind(&run.outcome).is_answer();
        if system.is_in_space() {
            polygon = Some(PolygonRecord::of(problem.polygon));
            if is_answer {
                let found = cone::taken(&problem, state, watch)?;
                (state, problem, note) = (found.state, found.problem, found.note);
                polygon = Some(found.record);
            }
        } else if is_answer {
            state = cone::with_repeated(&problem, state, watch)?;
        }
        let mut solved = self.solved_in(&problem, (contact, run), (state, polygon), (rules, extent));
        solved.answer.notes.extend(note);
        Ok(solved)
    }

    /// What is reported of a state of the joints, in space with what is known of its polygon.
    pub(super) fn solved_in(
        &self,
        problem: &ContactProblem,
        (contact, run): (ContactLcp, Run),
        (state, polygon): (JointState, Option<PolygonRecord>),
        (rules, extent): (AttemptRules, Extent),
    ) -> Solved {
        let mut answer = empty_answer(&run, contact.force_unit, rules, self.size(&problem.system, &contact));
        answer.polygon = polygon;
        for attempt in answer.attempts.iter_mut().filter(|_| polygon.is_some()) {
            attempt.facets = Some(problem.polygon.facets());
            attempt.turn = Some(problem.polygon.turn().to_degrees()).filter(|turn| *turn != 0.0);
        }
        answer.pairs = pair_states(problem, &contact, &state);
        self.add_released_slips(&mut answer.pairs, problem, &state.z);
        let mut ray = None;
        if let Outcome::Ray(direction) = &run.outcome {
            ray = Some(Box::new(ray::look(problem, &contact, direction, answer.p)));
        }
        let mut rest = None;
        match (extent, &*self.geometry) {
            _ if !answer.is_answer() => {}
            (Extent::Joints | Extent::Counted, Geometry::Structure { .. }) => {
                self.complete_joints(&mut answer, problem, &state);
                rest = Some(Arc::new(Rest { prepared: self.clone(), joints: state }));
            }
            _ => self.complete(&mut answer, problem, &state),
        }
        Solved {
            cycled: matches!(run.outcome, Outcome::Cycle(_)),
            run: RunData::Contact { contact, problem: problem.clone(), pivots: run.pivots, last: run.point },
            answer,
            ray,
            plain_ray: None,
            warm: None,
            rest,
            looked_at: LookedAt::default(),
            retry_note: String::new(),
        }
    }
}

/// Runs the engine that the rules name; the working-scheme engine also returns the dictionary it ends with.
fn run_engine(
    problem: &ContactProblem,
    contact: &ContactLcp,
    rules: Rules,
    watch: &dyn Watch,
) -> Result<(Run, Option<Parametric>), SolveError> {
    let system = &*problem.system;
    let tie_rule = contact.tie_rule(rules.tie_break);
    let (run, dictionary) = match rules.engine {
        Engine::Scheme => keep_scheme(&contact.lcp, tie_rule, watch),
        Engine::Tableau => (run_tableau(&contact.lcp, tie_rule, watch), None),
        Engine::Exact => {
            if let Some(refusal) =
                system.dependence_refusal("engine exact", "`set engine scheme` takes them as they are")
            {
                return Err(SolveError::Value(refusal));
            }
            let found = system.turning_pairs();
            if found > EXACT_PAIRS {
                return Err(SolveError::TooLargeForExact { what: "contact pairs", found, most: EXACT_PAIRS });
            }
            (run_exact_contact(problem, contact, rules.covering, tie_rule, watch), None)
        }
    };
    if run.outcome == Outcome::Interrupted { Err(SolveError::Interrupted) } else { Ok((run, dictionary)) }
}
