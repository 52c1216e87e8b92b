//! The ladder of retries: what follows a first run that ended badly, of contact problems and bare LCPs alike.

use std::time::Duration;

use super::error::SolveError;
use super::state::Solved;
use crate::answer::attempt::{Attempt, AttemptCovering, AttemptEngine, AttemptRules};
use crate::answer::record::{OutcomeKind, RayClass};
use crate::model::rules::Engine;
use crate::watch::{Budget, Watch};

/// An exact attempt that nobody asked for is given up after this time …
pub(super) const EXACT_BUDGET: Duration = Duration::from_secs(30);
/// … or after this one where the run in f64 has failed for certain and only exact arithmetic is left.
pub(super) const LAST_RESORT: Duration = Duration::from_secs(120);

/// A first run without an answer, and the tries since.
pub(super) struct Ladder {
    first: Solved,
    tried: Vec<Attempt>,
    /// Coverings of f64 runs that met no tie: another tie-break would repeat them pivot by pivot.
    untied: Vec<AttemptCovering>,
}

impl Ladder {
    pub(super) fn new(first: Solved) -> Ladder {
        let mut ladder = Ladder { first, tried: Vec::new(), untied: Vec::new() };
        if !has_ties(&ladder.first) {
            ladder.untied.push(ladder.first.answer.rules.covering);
        }
        ladder
    }

    /// Tries the rungs in order, those in exact arithmetic within `budget` each. Ends with the first answer; or, where
    /// the first run broke down or failed its check, with the first try for which `proved` says that there is no
    /// answer.
    ///
    /// # Errors
    /// Those of the attempts; a covering that does not fit the numbers (weight without friction) does not count as a
    /// try.
    pub(super) fn climb<R: Copy + Into<AttemptRules>>(
        &mut self,
        rungs: &[R],
        budget: Duration,
        watch: &dyn Watch,
        attempt: &dyn Fn(R, &dyn Watch) -> Result<Solved, SolveError>,
        proved: &dyn Fn(&mut Solved) -> bool,
    ) -> Result<Option<Solved>, SolveError> {
        for &rung in rungs {
            let rules = rung.into();
            if self.would_repeat(rules) {
                continue;
            }
            let again = if rules.engine == AttemptEngine::Lemke(Engine::Exact) {
                within(budget, watch, |watch| attempt(rung, watch))
            } else {
                attempt(rung, watch).map(Some)
            };
            let again = match again {
                Ok(Some(again)) => again,
                Ok(None) => {
                    self.gave_up(rules, budget);
                    continue;
                }
                Err(SolveError::Covering(_)) => continue,
                Err(other) => return Err(other),
            };
            let mut again = match self.add(again) {
                Ok(answer) => return Ok(Some(answer)),
                Err(again) => again,
            };
            let has_ray = self.first.ray.is_some() || self.first.plain_ray.is_some();
            if !has_ray && proved(&mut again) {
                return Ok(Some(self.with_history(*again)));
            }
        }
        Ok(None)
    }

    /// The first of several states that passes its check, with what is to be said of it besides.
    ///
    /// # Errors
    /// Those of the states.
    pub(super) fn first_answer(
        &mut self,
        states: impl Iterator<Item = Result<Solved, SolveError>>,
        note: Option<String>,
    ) -> Result<Option<Solved>, SolveError> {
        for state in states {
            if let Ok(mut answer) = self.add(state?) {
                answer.answer.notes.extend(note);
                return Ok(Some(answer));
            }
        }
        Ok(None)
    }

    /// Whether a run in f64 under this covering and another tie-break would repeat one that was made.
    fn would_repeat(&self, rules: AttemptRules) -> bool {
        rules.engine == AttemptEngine::Lemke(Engine::Scheme)
            && rules.tie_break != self.first.answer.rules.tie_break
            && self.untied.contains(&rules.covering)
    }

    /// Adds a try: the answer with its history, or the try as it was where it is none.
    pub(super) fn add(&mut self, mut again: Solved) -> Result<Solved, Box<Solved>> {
        let rules = again.answer.rules;
        if rules.engine == AttemptEngine::Lemke(Engine::Scheme) && !has_ties(&again) {
            self.untied.push(rules.covering);
        }
        self.tried.append(&mut again.answer.attempts);
        if !again.answer.is_answer() {
            return Err(Box::new(again));
        }
        again.answer.notes.push(self.note());
        Ok(self.with_history(again))
    }

    /// Notes a try whatever it came to.
    pub(super) fn tried(&mut self, again: &mut Solved) {
        self.tried.append(&mut again.answer.attempts);
    }

    /// How many runs there were.
    pub(super) fn count(&self) -> usize {
        self.first.answer.attempts.len() + self.tried.len()
    }

    /// Notes an exact try that ran out of its time.
    pub(super) fn gave_up(&mut self, rules: AttemptRules, budget: Duration) {
        let why = Some(format!("given up after {} s of exact arithmetic", budget.as_secs()));
        self.tried.push(Attempt { why, ..Attempt::new(rules, OutcomeKind::PivotLimit) });
    }

    /// Notes a try that came to no state at all.
    pub(super) fn ended(&mut self, attempt: Attempt) {
        self.tried.push(attempt);
    }

    /// The last try as the result, with all before it.
    pub(super) fn with_history(&mut self, mut last: Solved) -> Solved {
        let mut attempts = std::mem::take(&mut self.first.answer.attempts);
        attempts.append(&mut self.tried);
        last.answer.attempts = attempts;
        last
    }

    /// The note that tells of the retries behind an answer.
    fn note(&self) -> String {
        let how = match (&self.first.ray, self.first.answer.outcome) {
            (Some(report), _) => match report.class {
                RayClass::Artefact => "ended in an artefact ray",
                RayClass::Fault => "ended in a ray though an answer must exist",
                RayClass::Mechanism => "ended in a ray that looked like a mechanism",
                RayClass::NoEquilibrium => "ended in a ray",
            },
            (None, OutcomeKind::Ray) => "ended in a ray",
            (None, OutcomeKind::CheckFailed) => "found a state that failed its check",
            (None, OutcomeKind::PivotLimit) if self.first.cycled => "cycled",
            (None, OutcomeKind::PivotLimit) => "came to no end in many pivots",
            (None, kind) if kind.is_answer() => "found an answer on its polygon and none on the cone",
            (None, _) => "broke down",
        };
        let found = self.tried.last().map_or(String::new(), |last| last.rules.to_string());
        let number = 1 + self.tried.len();
        format!("the run under the default rules {how}; the answer was found at attempt {number} ({found})")
    }

    /// The end without an answer: the first run is shown, with a note of the tries; its entry stands last among the
    /// attempts.
    pub(super) fn without_answer(mut self) -> Solved {
        if !self.tried.is_empty() {
            let tried: Vec<String> = self.tried.iter().map(in_words).collect();
            let said = format!(" Tried besides, without an answer: {}.", tried.join("; "));
            self.first.say(&said);
        }
        let mut attempts = self.tried;
        attempts.append(&mut self.first.answer.attempts);
        self.first.answer.attempts = attempts;
        self.first
    }
}

/// `covering ones, tie-break lexicographic, engine exact (given up after 10 s of exact arithmetic)`.
fn in_words(attempt: &Attempt) -> String {
    let why = attempt.why.as_ref().map(|why| why.trim_end_matches('.').to_owned());
    let cost = attempt.pivots.filter(|pivots| *pivots > 0).map(|pivots| format!("{pivots} pivots"));
    let remarks: Vec<String> = why.into_iter().chain(cost).collect();
    let remarks = if remarks.is_empty() { String::new() } else { format!(" ({})", remarks.join("; ")) };
    attempt.rules.to_string() + &remarks
}

fn has_ties(solved: &Solved) -> bool {
    let pivots = solved.pivots();
    !pivots.is_complete() || pivots.recorded().iter().any(|pivot| pivot.ties.len() > 1)
}

/// "there are 3 answers; this is one of them", where there are others.
pub(super) fn others(count: usize, infinite: bool, complete: bool) -> Option<String> {
    if infinite {
        return Some("there are infinitely many answers; this is one of them (`enumerate`)".to_owned());
    }
    let known = if complete { "" } else { "at least " };
    (count > 1).then(|| format!("there are {known}{count} answers; this is one of them"))
}

impl Solved {
    /// Adds a sentence to what is said of a run without an answer.
    pub(super) fn say(&mut self, sentence: &str) {
        match (&mut self.answer.failure, &mut self.answer.ray) {
            (Some(failure), _) => failure.push_str(sentence),
            // The explanation of a contact ray is written later.
            (None, _) if self.ray.is_some() => self.retry_note.push_str(sentence),
            (None, Some(ray)) => ray.explanation.push_str(sentence),
            (None, None) => {}
        }
    }
}

/// Runs `attempt` within `budget`; `None`: the time ran out.
///
/// # Errors
/// Those of the attempt; stopped from outside.
pub(super) fn within<T>(
    budget: Duration,
    watch: &dyn Watch,
    attempt: impl FnOnce(&dyn Watch) -> Result<T, SolveError>,
) -> Result<Option<T>, SolveError> {
    let budget = Budget::new(watch, budget);
    match attempt(&budget) {
        Err(SolveError::Interrupted) if budget.ran_out() => Ok(None),
        other => other.map(Some),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::watch::Quiet;

    #[test]
    fn work_ends_with_its_time_and_not_before() {
        let endless = |watch: &dyn Watch| -> Result<(), SolveError> {
            while !watch.stop() {
                std::thread::yield_now();
            }
            Err(SolveError::Interrupted)
        };
        assert_eq!(within(Duration::from_millis(5), &Quiet, endless), Ok(None));
        assert_eq!(within(Duration::from_secs(600), &Quiet, |_| Ok(7)), Ok(Some(7)));

        struct Stopped;
        impl Watch for Stopped {
            fn stop(&self) -> bool {
                true
            }
        }
        // Ctrl-C is not a timeout.
        assert_eq!(within(Duration::from_secs(600), &Stopped, endless), Err(SolveError::Interrupted));
    }
}
