//! What follows a run that ended badly: proofs, retries under other rules, and the words for both (method §4).
//!
//! Under the default rules a run that is no answer and not certified to have none is tried again: exact arithmetic
//! first, then other coverings and ties, then, where they are few, all working schemes. An answer found this way is
//! an answer like any other: it passes the same fresh check. Rules that the user chose are run as chosen; the default
//! rules are then run silently, to name them if they succeed.

use std::sync::Arc;
use std::time::Duration;

use super::case::Case;
use super::cold::Extent;
use super::engines::EXACT_PAIRS;
use super::error::SolveError;
use super::from_zero_load::AlongLoad;
use super::known_collapses::KnownCollapses;
use super::ladder::{EXACT_BUDGET, Ladder, others};
use super::prepared::Prepared;
use super::problem::{contact_problem, factors};
use super::state::Solved;
use crate::answer::attempt::{AttemptCovering, AttemptEngine, AttemptRules};
use crate::answer::record::{RayClass, Verdict};
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::enumerate::Enumeration;
use crate::contact::system::ContactSystem;
use crate::explain::all_schemes::all_answers;
use crate::explain::ray::{certify_ray, explain};
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Engine, Rules, TieBreak};
use crate::watch::{Budget, Watch};

/// An exact attempt after a ray that is a mechanism is given up after this time: such a ray is seldom rounding, and the
/// rationals of an R with a large kernel have thousands of digits.
const MECHANISM_BUDGET: Duration = Duration::from_secs(3);
/// Contact pairs up to which an uncertified collapse is looked at under other rules, too.
const FEW_PAIRS: usize = 300;

/// The rules tried after the default ones, in order.
pub fn retries(exact: bool) -> Vec<Rules> {
    let with = |covering, tie_break, engine| Rules { covering, tie_break, engine, ..Rules::default() };
    let mut rules = Vec::new();
    if exact {
        rules.push(with(Covering::Cohesive, TieBreak::Lexicographic, Engine::Exact));
    }
    let scheme = |covering, tie_break| with(covering, tie_break, Engine::Scheme);
    rules.extend([
        scheme(Covering::Weight, TieBreak::Lexicographic),
        scheme(Covering::Ones, TieBreak::Lexicographic),
        scheme(Covering::Cohesive, TieBreak::Natural),
        scheme(Covering::Cohesive, TieBreak::Random(1)),
        scheme(Covering::Weight, TieBreak::Random(1)),
        scheme(Covering::Ones, TieBreak::Random(1)),
    ]);
    rules
}

impl Prepared {
    pub(super) fn solve_contact_judged(
        &self,
        system: &Arc<ContactSystem>,
        values: &ParameterValues,
        (rules, extent): (Rules, Extent),
        brief: bool,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let problem = contact_problem(system, &factors(self, values), values).under(rules);
        let job = Job { prepared: self, problem: &problem, rules, watch };
        let (mut solved, certified) = self.first_run(&problem, (rules, extent), watch)?;
        if solved.stands(rules.cone) {
            return Ok(solved);
        }
        if !certified && system.is_in_space() {
            if rules.are_default() {
                solved = self.retry_in_space(&problem, rules, solved, watch)?;
            } else {
                self.compare_in_space(&problem, rules, &mut solved, watch)?;
            }
        } else if !certified && rules.are_default() {
            solved = job.retry(solved)?;
        } else if !certified {
            job.compare_with_default(&mut solved)?;
        }
        solved.put_verdict();
        if let Some(report) = solved.ray.as_mut().filter(|_| !brief) {
            explain(report, &problem, self.built());
            if watch.stop() {
                return Err(SolveError::Interrupted);
            }
            let covering = match solved.answer.rules.covering {
                AttemptCovering::Contact(covering) => covering,
                AttemptCovering::Plain(_) => rules.covering,
            };
            let mut ray = report.record(system, covering);
            ray.explanation += &std::mem::take(&mut solved.retry_note);
            solved.answer.ray = Some(ray);
        }
        Ok(solved)
    }
}

impl Prepared {
    /// The first run, and whether it is certified that there is no answer.
    ///
    /// # Errors
    /// Those of the attempt.
    pub(super) fn first_run(
        &self,
        problem: &ContactProblem,
        (rules, extent): (Rules, Extent),
        watch: &dyn Watch,
    ) -> Result<(Solved, bool), SolveError> {
        let mut solved = self.attempt_contact(problem, (rules, extent), watch)?;
        if solved.stands(rules.cone) {
            return Ok((solved, false));
        }
        let certified = match solved.ray.as_mut() {
            Some(report) => certify_ray(report, problem, self.built()),
            // An answer on the polygon that Newton's method did not take to the cone, or dependent joints whose forces
            // grow without end, which end in a failed check.
            None => {
                (solved.answer.is_answer() || problem.system.yielding.is_some())
                    && self.collapses_on_cone(&mut solved, problem, rules.covering)
            }
        };
        Ok((solved, certified))
    }

    /// The first of the first run and the retries in f64 that is an answer, with its pairs alone; else the first run.
    /// Where it is certified that there is no answer, no retry is made, and the motion that proves it becomes a known
    /// one.
    ///
    /// # Errors
    /// Those of the attempts.
    pub(super) fn solve_in_f64(
        &self,
        problem: &ContactProblem,
        Case { rules, watch, .. }: Case<'_>,
        known: &KnownCollapses,
    ) -> Result<Solved, SolveError> {
        let attempt = |rules: Rules, watch: &dyn Watch| self.attempt_contact(problem, (rules, Extent::Counted), watch);
        let mut first = attempt(rules, watch)?;
        if first.stands(rules.cone) || !rules.are_default() {
            return Ok(first);
        }
        if let Some(report) = &mut first.ray
            && certify_ray(report, problem, self.built())
        {
            report.certificate.iter().for_each(|found| known.learn(problem, self.built(), found));
            return Ok(first);
        }
        let mut ladder = Ladder::new(first);
        if let Some(found) = ladder.climb(&retries(false), EXACT_BUDGET, watch, &attempt, &|_| false)? {
            return Ok(found);
        }
        let found = self.tried_at_rest(&mut ladder, problem, Extent::Counted, watch)?;
        Ok(found.unwrap_or_else(|| ladder.without_answer()))
    }
}

struct Job<'a> {
    prepared: &'a Prepared,
    problem: &'a ContactProblem,
    rules: Rules,
    watch: &'a dyn Watch,
}

impl Job<'_> {
    fn attempt(&self, rules: Rules) -> Result<Solved, SolveError> {
        self.attempt_watched(rules, self.watch)
    }

    fn attempt_watched(&self, rules: Rules, watch: &dyn Watch) -> Result<Solved, SolveError> {
        self.prepared.attempt_contact(self.problem, (rules, Extent::Whole), watch)
    }

    /// Other rules, then the path from zero load, then all working schemes; the first answer wins. Without one the run
    /// under the default rules is shown, with what was proved.
    fn retry(&self, mut first: Solved) -> Result<Solved, SolveError> {
        let m = self.problem.system.turning_pairs();
        let class = first.ray.as_ref().map(|report| report.class);
        // A proof that there is none saves all further attempts.
        let budget = Budget::new(self.watch, EXACT_BUDGET);
        let found = all_answers(self.problem, &budget);
        let too_long = found.is_none() && budget.ran_out();
        let none = found.as_ref().is_some_and(Enumeration::no_answer);
        if none && mark_proved(&mut first) {
            return Ok(first);
        }
        let mut ladder = Ladder::new(first);
        if too_long {
            ladder.gave_up(AttemptRules::from(Rules::default()).by(AttemptEngine::Enumeration), EXACT_BUDGET);
        }
        if class != Some(RayClass::Mechanism) || m <= FEW_PAIRS {
            let exact =
                m <= EXACT_PAIRS && self.rules.engine != Engine::Exact && self.problem.system.force_form.is_none();
            let budget = if class == Some(RayClass::Mechanism) { MECHANISM_BUDGET } else { EXACT_BUDGET };
            let attempt = |rules: Rules, watch: &dyn Watch| self.attempt_watched(rules, watch);
            let proved = |again: &mut Solved| {
                let certified =
                    again.ray.as_mut().is_some_and(|report| certify_ray(report, self.problem, self.prepared.built()));
                certified || (none && mark_proved(again))
            };
            if let Some(solved) = ladder.climb(&retries(exact), budget, self.watch, &attempt, &proved)? {
                return Ok(solved);
            }
            match self.prepared.along_load(self.problem, self.watch)? {
                AlongLoad::Answer(again) => {
                    if let Ok(answer) = ladder.add(*again) {
                        return Ok(answer);
                    }
                }
                AlongLoad::Ended(attempt) => ladder.ended(attempt),
                AlongLoad::NotTried => {}
            }
        }
        if let Some(answer) = self.prepared.tried_at_rest(&mut ladder, self.problem, Extent::Whole, self.watch)? {
            return Ok(answer);
        }
        if let Some(found) = found {
            let state = |candidate| self.prepared.enumerated_answer(self.problem, candidate);
            let note = if found.within_rounding {
                Some(
                    "it holds within the rounding of the data; as they are stored no working scheme is an answer"
                        .to_owned(),
                )
            } else {
                others(found.answers.len(), !found.continua.is_empty(), true)
            };
            if let Some(answer) = ladder.first_answer(found.answers.iter().map(state), note)? {
                return Ok(answer);
            }
        }
        Ok(ladder.without_answer())
    }

    /// Whether one of the answers found passes its check.
    fn holds_any(&self, found: &Enumeration) -> Result<bool, SolveError> {
        for candidate in &found.answers {
            if self.prepared.enumerated_answer(self.problem, candidate)?.answer.is_answer() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Rules that the user chose have failed: says whether the default ones do better.
    fn compare_with_default(&self, solved: &mut Solved) -> Result<(), SolveError> {
        let default = Rules::default();
        let other = self.attempt(default)?;
        let words = format!("covering {}, tie-break {}", default.covering, default.tie_break);
        let said = if other.answer.is_answer() {
            format!(" The default rules ({words}) find an answer in {} pivots.", other.pivot_count())
        } else {
            let budget = Budget::new(self.watch, EXACT_BUDGET);
            match all_answers(self.problem, &budget) {
                None if budget.ran_out() => format!(
                    " The default rules ({words}) find no answer either; going through all working schemes was given up \
                     after {} s.",
                    EXACT_BUDGET.as_secs()
                ),
                Some(found) if found.no_answer() => {
                    mark_proved(solved);
                    String::new()
                }
                Some(found) if !found.within_rounding && self.holds_any(&found)? => {
                    " An answer exists: going through all working schemes finds it (`enumerate`).".to_owned()
                }
                _ => format!(" The default rules ({words}) find no answer either."),
            }
        };
        solved.say(&said);
        Ok(())
    }
}

/// Marks a ray whose verdict is open as proved by enumeration; `false` where there is none.
fn mark_proved(solved: &mut Solved) -> bool {
    let open = solved.ray.as_mut().map(|report| &mut report.verdict).filter(|verdict| verdict.is_some());
    open.is_some_and(|verdict| {
        *verdict = Some(Verdict::Proved);
        true
    })
}
