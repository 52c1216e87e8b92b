//! Solving from the last answer: warm where that works, cold otherwise.

use std::sync::{Arc, PoisonError};
use std::time::Instant;

use crate::answer::record::Start;
use crate::contact::lcp::contact_lcp_like;
use crate::contact::problem::ContactProblem;
use crate::lcp::outcome::Point;
use crate::model::rules::{Engine, Rules};
use crate::solve::case::Case;
use crate::solve::cold::Extent;
use crate::solve::error::SolveError;
use crate::solve::prepared::Prepared;
use crate::solve::problem::{contact_problem, factors};
use crate::solve::state::Solved;
use crate::solve::warm::WarmStart;
use crate::watch::Watch;

/// Below this number of pairs a cold start takes no noticeable time, and it has pivots to show.
pub const WARM_PAIRS: usize = 150;

impl Case<'_> {
    /// Solves from the last answer where the model has [`WARM_PAIRS`] pairs or more, the rules are the defaults and the
    /// last answer can be followed; otherwise as [`Case::solve`]. A warm answer passes the same fresh check; it has no
    /// pivots of Lemke's algorithm (`answer.start` says so).
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn solve_from(self, last: &Solved) -> Result<Solved, SolveError> {
        self.solve_to(last, Extent::Whole)
    }

    /// As [`Case::solve_from`], but an answer that is followed has only the states and forces of the pairs, with the
    /// check over the joints: what a slider shows first. [`Case::whole`] works out the rest.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn solve_joints_from(self, last: &Solved) -> Result<Solved, SolveError> {
        self.solve_to(last, Extent::Joints)
    }

    /// An answer with its displacements, members, reactions and the check of equilibrium. Where that check fails, the
    /// answer is found anew as after any check that fails.
    ///
    /// # Errors
    /// As [`Case::solve`].
    pub fn whole(self, solved: &Solved) -> Result<Solved, SolveError> {
        let whole = solved.completed();
        if solved.is_whole() || whole.answer.is_answer() {
            return Ok(whole);
        }
        let mut anew = self.solve_from(solved)?;
        anew.answer.redone = solved.answer.redone;
        Ok(anew)
    }

    fn solve_to(self, last: &Solved, extent: Extent) -> Result<Solved, SolveError> {
        let large = self.prepared.system().is_some_and(|system| system.pairs.len() >= WARM_PAIRS);
        let usual = self.rules.are_default() && self.rules.engine == Engine::Scheme;
        if large
            && usual
            && last.answer.is_answer()
            && self.scenario.law_refusal(self.values).is_none()
            && let Some(solved) = self.follow_to(last, extent)
        {
            return Ok(solved);
        }
        self.solve()
    }

    /// The answer reached from the last one, if it passes its check. Public for tests and measurements of the warm
    /// start alone: any number of pairs.
    pub fn follow(self, last: &Solved) -> Option<Solved> {
        self.follow_to(last, Extent::Whole)
    }

    fn follow_to(self, last: &Solved, extent: Extent) -> Option<Solved> {
        let Case { prepared, values, rules, watch, .. } = self;
        let system = prepared.system()?;
        let slot = last.warm.as_ref()?;
        let mut guard = slot.lock().unwrap_or_else(PoisonError::into_inner);
        // Taken out, so that nothing half-done stays behind where the path fails.
        let mut kept = guard.take()?;
        let start = Instant::now();
        let problem = contact_problem(system, &factors(prepared, values), values);
        let problem_seconds = start.elapsed().as_secs_f64();
        let (mut solved, mut seconds) = prepared.follow_kept(&mut kept, &problem, (rules, extent), watch)?;
        if !solved.answer.is_answer() {
            // The path was followed; only its end was not accurate enough.
            let way = solved.answer.start;
            kept.refine();
            let (refined, more) = prepared.follow_kept(&mut kept, &problem, (rules, extent), watch)?;
            solved = refined;
            solved.answer.start = way;
            seconds += more;
        }
        if !solved.answer.is_answer() {
            return None;
        }
        let answer = &mut solved.answer;
        *guard = Some(kept);
        drop(guard);
        answer.timings.factor = prepared.factor_seconds;
        answer.timings.condense = prepared.condense_seconds;
        answer.timings.lemke = problem_seconds + seconds;
        answer.timings.total = prepared.seconds + start.elapsed().as_secs_f64();
        solved.warm = Some(Arc::clone(slot));
        Some(solved)
    }
}

impl Prepared {
    /// The checked state at the numbers, followed in the kept dictionary, and the seconds that the following took.
    fn follow_kept(
        &self,
        kept: &mut WarmStart,
        problem: &ContactProblem,
        (rules, extent): (Rules, Extent),
        watch: &dyn Watch,
    ) -> Option<(Solved, f64)> {
        let start = Instant::now();
        let found = kept.follow(problem, watch)?;
        let contact = contact_lcp_like(Some(kept.contact()), problem, rules.covering).ok()?;
        let length = found.length_unit / contact.length_unit;
        let point =
            Point { z: found.point.z.iter().map(|z| z * length).collect(), w: vec![0.0; contact.rows.len()], p: 0.0 };
        let seconds = start.elapsed().as_secs_f64();
        let mut solved = self.answer_at(problem, contact, point, rules.into(), extent).ok()?;
        solved.answer.start = Start::Warm { changes: found.pivots };
        Some((solved, seconds))
    }
}
