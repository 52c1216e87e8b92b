//! The ladder of retries: what a first run that ended badly and the tries after it have in common, of contact problems
//! and bare LCPs.

use std::time::{Duration, Instant};

use super::solved::{SolveError, Solved, Trace};
use crate::answer::record::{Attempt, OutcomeKind, RayClass};
use crate::model::rules::Engine;
use crate::watch::Watch;

/// An exact attempt that nobody asked for is given up after this time …
pub(super) const EXACT_BUDGET: Duration = Duration::from_secs(30);
/// … or after this one where the run in f64 has failed for certain and exact arithmetic is what is left.
pub(super) const LAST_RESORT: Duration = Duration::from_secs(120);

/// A first run without an answer, and the tries since.
pub(super) struct Ladder {
    first: Solved,
    tried: Vec<Attempt>,
    /// Coverings of f64 runs that met no tie: another tie-break would repeat them pivot by pivot.
    untied: Vec<String>,
}

impl Ladder {
    pub(super) fn new(first: Solved) -> Ladder {
        let mut ladder = Ladder { first, tried: Vec::new(), untied: Vec::new() };
        if !has_ties(&ladder.first) {
            ladder.untied.push(ladder.first.answer.covering.clone());
        }
        ladder
    }

    /// The first run.
    pub(super) fn first(&self) -> &Solved {
        &self.first
    }

    /// Whether a run in f64 under this covering and another tie-break would be one that was made.
    pub(super) fn would_repeat(&self, covering: &str, engine: Engine) -> bool {
        engine == Engine::Scheme && self.untied.iter().any(|known| known == covering)
    }

    /// Adds a try: the answer with its history, or the try as it was where it is none.
    pub(super) fn add(&mut self, mut again: Solved) -> Result<Solved, Box<Solved>> {
        if again.answer.engine == Engine::Scheme.to_string() && !has_ties(&again) {
            self.untied.push(again.answer.covering.clone());
        }
        self.tried.append(&mut again.answer.attempts);
        if !again.answer.is_answer() {
            return Err(Box::new(again));
        }
        again.answer.notes.push(self.told());
        Ok(self.with_history(again))
    }

    /// Notes an exact try that ran out of its time.
    pub(super) fn gave_up(&mut self, covering: &str, tie_break: &str, engine: &str, budget: Duration) {
        self.tried.push(Attempt {
            covering: covering.to_owned(),
            tie_break: tie_break.to_owned(),
            engine: engine.to_owned(),
            outcome: OutcomeKind::PivotLimit,
            pivots: None,
            why: Some(format!("given up after {} s of exact arithmetic", budget.as_secs())),
        });
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
    fn told(&self) -> String {
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
            (None, OutcomeKind::PivotLimit) => "reached the limit of pivots",
            (None, _) => "broke down",
        };
        let found = self.tried.last().map_or(String::new(), rules_of);
        let number = 1 + self.tried.len();
        format!("the run under the default rules {how}; the answer was found at attempt {number} ({found})")
    }

    /// The end without an answer: the first run is what is shown, told of the tries; its entry stands last among the
    /// attempts.
    pub(super) fn without_answer(mut self) -> Solved {
        if !self.tried.is_empty() {
            let tried: Vec<String> = self.tried.iter().map(rules_words).collect();
            let said = format!(" Tried besides, without an answer: {}.", tried.join("; "));
            self.first.say(&said);
        }
        let mut attempts = self.tried;
        attempts.append(&mut self.first.answer.attempts);
        self.first.answer.attempts = attempts;
        self.first
    }
}

/// `covering ones, tie-break lexicographic, engine exact`.
fn rules_of(attempt: &Attempt) -> String {
    format!("covering {}, tie-break {}, engine {}", attempt.covering, attempt.tie_break, attempt.engine)
}

/// `covering ones, tie-break lexicographic, engine exact (given up after 10 s of exact arithmetic)`.
fn rules_words(attempt: &Attempt) -> String {
    let why = attempt.why.as_ref().map(|why| why.trim_end_matches('.').to_owned());
    let cost = attempt.pivots.filter(|pivots| *pivots > 0).map(|pivots| format!("{pivots} pivots"));
    let told: Vec<String> = why.into_iter().chain(cost).collect();
    let told = if told.is_empty() { String::new() } else { format!(" ({})", told.join("; ")) };
    rules_of(attempt) + &told
}

fn has_ties(solved: &Solved) -> bool {
    let (Trace::Contact { pivots, .. } | Trace::Plain { pivots, .. }) = &solved.trace;
    !pivots.is_complete() || pivots.recorded().iter().any(|pivot| pivot.ties.len() > 1)
}

impl Solved {
    /// Adds a sentence to what is said of a run without an answer.
    pub(super) fn say(&mut self, sentence: &str) {
        match (&mut self.answer.failure, &mut self.answer.ray) {
            (Some(failure), _) => failure.push_str(sentence),
            // The explanation of a contact ray is written later.
            (None, _) if self.ray.is_some() => self.told.push_str(sentence),
            (None, Some(ray)) => ray.explanation.push_str(sentence),
            (None, None) => {}
        }
    }
}

/// A watch that also stops when a time has passed.
pub(super) struct Deadline<'a> {
    watch: &'a dyn Watch,
    until: Instant,
}

impl<'a> Deadline<'a> {
    pub(super) fn after(budget: Duration, watch: &'a dyn Watch) -> Deadline<'a> {
        Deadline { watch, until: Instant::now() + budget }
    }

    /// Whether the time ran out, and nobody else stopped the work.
    pub(super) fn passed(&self) -> bool {
        !self.watch.stop() && Instant::now() >= self.until
    }
}

impl Watch for Deadline<'_> {
    fn progress(&self, what: &str, fraction: f64) {
        self.watch.progress(what, fraction);
    }

    fn stop(&self) -> bool {
        self.watch.stop() || Instant::now() >= self.until
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
    let deadline = Deadline::after(budget, watch);
    match attempt(&deadline) {
        Err(SolveError::Interrupted) if deadline.passed() => Ok(None),
        other => other.map(Some),
    }
}

/// Runs `attempt`, within `budget` where `engine` is exact arithmetic.
///
/// # Errors
/// As [`within`].
pub(super) fn within_budget(
    engine: Engine,
    budget: Duration,
    watch: &dyn Watch,
    attempt: impl FnOnce(&dyn Watch) -> Result<Solved, SolveError>,
) -> Result<Option<Solved>, SolveError> {
    if engine == Engine::Exact { within(budget, watch, attempt) } else { attempt(watch).map(Some) }
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
        // Ctrl-C is no end of the time.
        assert_eq!(within(Duration::from_secs(600), &Stopped, endless), Err(SolveError::Interrupted));
    }
}
