//! What follows a run that ended badly: proofs, retries under other rules, and the words for both (theory §4).
//!
//! Under the default rules a run that is no answer and not certified to have none is tried again: exact arithmetic
//! first, then other coverings and ties, then, where they are few, all working schemes. An answer found this way is
//! an answer like any other: it passes the same fresh check. Rules that the user chose are run as chosen; the default
//! rules are then run silently, to name them if they succeed.

use std::sync::Arc;

use super::all_answers::plain_answer;
use super::judge::{EXACT_PAIRS, EXACT_ROWS};
use super::numbers::{contact_numbers, factors};
use super::plain_answers::all_plain_answers;
use super::prepared::{Geometry, Prepared};
use super::solved::{SolveError, Solved, attempt_plain};
use crate::answer::record::{Attempt, OutcomeKind, RayClass, Verdict};
use crate::contact::enumerate::Enumeration;
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::explain::ray::{self, Subject, add_remedies, all_answers, certify_ray};
use crate::lcp::mirrored::MirroredLcp;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Engine, Rules, TieBreak};
use crate::watch::Watch;

/// Contact pairs up to which an uncertified collapse is looked at under other rules, too.
const FEW_PAIRS: usize = 300;

/// The rules tried after the default ones, in order.
pub fn retries(exact: bool) -> Vec<Rules> {
    let with = |covering, tie_break, engine| Rules { covering, tie_break, engine };
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

fn rules_words(attempt: &Attempt) -> String {
    format!("covering {}, tie-break {}, engine {}", attempt.covering, attempt.tie_break, attempt.engine)
}

impl Prepared {
    pub(super) fn named_factors(&self, factors: &[f64]) -> Vec<(String, f64)> {
        self.cases.iter().map(|(name, _)| name.clone()).zip(factors.iter().copied()).collect()
    }

    pub(super) fn subject<'a>(
        &'a self,
        system: &'a ContactSystem,
        numbers: &'a ContactNumbers,
        cases: &'a [(String, f64)],
    ) -> Subject<'a> {
        Subject {
            system,
            numbers,
            cases,
            structure: match &self.geometry {
                Geometry::Structure { main, structure, .. } => Some((structure, main)),
                _ => None,
            },
        }
    }

    pub(super) fn solve_contact_judged(
        &self,
        system: &ContactSystem,
        values: &ParameterValues,
        rules: Rules,
        brief: bool,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let factors = factors(self, values);
        let numbers = contact_numbers(system, &factors, values);
        let job = Job { prepared: self, system, numbers: &numbers, factors: &factors, rules, watch };
        let mut solved = job.attempt(rules)?;
        if solved.answer.is_answer() {
            return Ok(solved);
        }
        let cases = self.named_factors(&factors);
        let subject = self.subject(system, &numbers, &cases);
        let certified = solved.ray.as_mut().is_some_and(|report| certify_ray(report, &subject));
        if !certified && rules.are_default() {
            solved = job.retry(solved, &subject)?;
        } else if !certified {
            job.compare_with_default(&mut solved, &subject)?;
        }
        if let Some(report) = solved.ray.as_mut().filter(|_| !brief) {
            let solves = |numbers: &ContactNumbers, changed: Option<(usize, f64)>| {
                let default = Rules { engine: Engine::Scheme, ..Rules::default() };
                let mut factors = factors.clone();
                if let Some((case, factor)) = changed {
                    factors[case] = factor;
                }
                self.attempt_contact(system, numbers, &factors, default, watch)
                    .is_ok_and(|solved| solved.answer.is_answer())
            };
            add_remedies(report, &subject, &solves, watch);
            if watch.stop() {
                return Err(SolveError::Interrupted);
            }
            let said = report.record(system, job.covering_of(&solved.answer.covering));
            let told = std::mem::take(&mut solved.told);
            solved.answer.ray = Some(said);
            if let Some(ray) = &mut solved.answer.ray {
                ray.explanation += &told;
            }
        }
        Ok(solved)
    }
}

struct Job<'a> {
    prepared: &'a Prepared,
    system: &'a ContactSystem,
    numbers: &'a ContactNumbers,
    factors: &'a [f64],
    rules: Rules,
    watch: &'a dyn Watch,
}

impl Job<'_> {
    fn attempt(&self, rules: Rules) -> Result<Solved, SolveError> {
        self.prepared.attempt_contact(self.system, self.numbers, self.factors, rules, self.watch)
    }

    fn covering_of(&self, word: &str) -> Covering {
        word.parse().unwrap_or(self.rules.covering)
    }

    /// Other rules, then the path from zero load, then all working schemes; the first answer wins. Without one the run under the default rules is
    /// what is shown, with what was proved.
    fn retry(&self, first: Solved, subject: &Subject) -> Result<Solved, SolveError> {
        let m = self.system.pairs.len();
        let class = first.ray.as_ref().map(|report| report.class);
        let limit = first.answer.outcome == OutcomeKind::PivotLimit;
        let mut shown = first;
        // A proof that there is none saves all further attempts.
        let found = all_answers(subject, self.watch);
        if found.as_ref().is_some_and(Enumeration::no_answer)
            && let Some(report) = &mut shown.ray
            && report.verdict.is_some()
        {
            report.verdict = Some(Verdict::Proved);
            return Ok(shown);
        }
        let first = shown;
        let try_rules = !limit && (class != Some(RayClass::Mechanism) || m <= FEW_PAIRS);
        let mut attempts = first.answer.attempts.clone();
        if try_rules {
            let exact = m <= EXACT_PAIRS && self.rules.engine != Engine::Exact;
            for rules in retries(exact) {
                let mut again = match self.attempt(rules) {
                    Ok(again) => again,
                    // A covering that does not fit the numbers (weight without friction) is no try.
                    Err(SolveError::Covering(_)) => continue,
                    Err(other) => return Err(other),
                };
                attempts.append(&mut again.answer.attempts);
                if again.answer.is_answer() {
                    again.answer.notes.push(told(&first, &attempts));
                    again.answer.attempts = attempts;
                    return Ok(again);
                }
                if first.ray.is_some() {
                    continue;
                }
                // The first run broke down or failed its check: a ray that can be proved is better than that.
                if let Some(report) = &mut again.ray {
                    let mut proved = certify_ray(report, subject);
                    if !proved && report.verdict.is_some() && found.as_ref().is_some_and(Enumeration::no_answer) {
                        report.verdict = Some(Verdict::Proved);
                        proved = true;
                    }
                    if proved {
                        again.answer.attempts = attempts;
                        return Ok(again);
                    }
                }
            }
        }
        if try_rules
            && let Some(mut again) = self.prepared.along_load(self.system, self.numbers, self.factors, self.watch)?
        {
            attempts.append(&mut again.answer.attempts);
            if again.answer.is_answer() {
                again.answer.notes.push(told(&first, &attempts));
                again.answer.attempts = attempts;
                return Ok(again);
            }
        }
        let mut shown = first;
        if let Some(found) = found
            && let Some(mut again) = self.enumerated(&found)?
        {
            attempts.append(&mut again.answer.attempts);
            again.answer.notes.push(told(&shown, &attempts));
            again.answer.attempts = attempts;
            return Ok(again);
        }
        if attempts.len() > 1 {
            shown.told = format!(
                " Tried besides, without an answer: {}.",
                attempts[1..].iter().map(rules_words).collect::<Vec<_>>().join("; ")
            );
            if let Some(failure) = &mut shown.answer.failure {
                failure.push_str(&shown.told);
            }
            // What is shown is the run under the default rules once more.
            attempts.push(attempts[0].clone());
        }
        shown.answer.attempts = attempts;
        Ok(shown)
    }

    /// Rules that the user chose have failed: says whether the default ones do better.
    fn compare_with_default(&self, solved: &mut Solved, subject: &Subject) -> Result<(), SolveError> {
        let default = Rules::default();
        let other = self.attempt(default)?;
        let words = format!("covering {}, tie-break {}", default.covering, default.tie_break);
        let said = if other.answer.is_answer() {
            format!(" The default rules ({words}) find an answer in {} pivots.", other.pivot_count())
        } else {
            match all_answers(subject, self.watch) {
                Some(found) if found.no_answer() => {
                    if let Some(report) = &mut solved.ray
                        && report.verdict.is_some()
                    {
                        report.verdict = Some(Verdict::Proved);
                    }
                    String::new()
                }
                Some(found) if !found.answers.is_empty() => {
                    " An answer exists: going through all working schemes finds it (`enumerate`).".to_owned()
                }
                _ => format!(" The default rules ({words}) find no answer either."),
            }
        };
        match &mut solved.answer.failure {
            Some(failure) => failure.push_str(&said),
            None => solved.told = said,
        }
        Ok(())
    }

    /// The first enumerated answer that passes the fresh check.
    fn enumerated(&self, found: &Enumeration) -> Result<Option<Solved>, SolveError> {
        for candidate in &found.answers {
            let mut solved = self.prepared.enumerated_answer(self.system, self.numbers, self.factors, candidate)?;
            if solved.answer.is_answer() {
                if found.answers.len() > 1 {
                    solved.answer.notes.push(format!("there are {} answers; this is one of them", found.answers.len()));
                }
                return Ok(Some(solved));
            }
        }
        Ok(None)
    }
}

/// The note that tells of the retries behind an answer.
fn told(first: &Solved, attempts: &[Attempt]) -> String {
    let how = match (&first.ray, first.answer.outcome) {
        (Some(report), _) => match report.class {
            RayClass::Artefact => "ended in an artefact ray",
            RayClass::Fault => "ended in a ray though an answer must exist",
            RayClass::Mechanism => "ended in a ray that looked like a mechanism",
            RayClass::NoEquilibrium => "ended in a ray",
        },
        (None, OutcomeKind::CheckFailed) => "found a state that failed its check",
        (None, _) => "broke down",
    };
    // The last attempt is the one that found it.
    let found = attempts.last().map_or(String::new(), rules_words);
    format!("the run under the default rules {how}; the answer was found at attempt {} ({found})", attempts.len())
}

/// Solves a bare LCP, with retries under the default tie-break.
pub(super) fn solve_plain_judged(
    lcp: &Arc<MirroredLcp>,
    names: &[String],
    covering_given: bool,
    rules: Rules,
    watch: &dyn Watch,
) -> Result<Solved, SolveError> {
    let attempt = |rules| attempt_plain(lcp, names, covering_given, rules, watch);
    let mut first = attempt(rules)?;
    if first.answer.is_answer() {
        return Ok(first);
    }
    if !rules.are_default() {
        let other = attempt(Rules::default())?;
        if other.answer.is_answer() {
            let said = format!(
                " The default tie-break ({}) finds an answer in {} pivots.",
                TieBreak::default(),
                other.pivot_count()
            );
            match (&mut first.answer.failure, &mut first.answer.ray) {
                (Some(text), _) => text.push_str(&said),
                (None, Some(ray)) => ray.explanation.push_str(&said),
                (None, None) => {}
            }
        }
        return Ok(first);
    }
    if first.answer.outcome == OutcomeKind::PivotLimit {
        return Ok(first);
    }
    let found = all_plain_answers(lcp, watch);
    let none = found.as_ref().is_some_and(|found| found.complete && found.answers.is_empty());
    if none && first.answer.ray.is_some() {
        first.answer.ray = Some(ray::plain_report(first.answer.p, Verdict::Proved));
        return Ok(first);
    }
    let mut attempts = first.answer.attempts.clone();
    let mut others = Vec::new();
    if lcp.size() <= EXACT_ROWS && rules.engine != Engine::Exact {
        others.push(Rules { engine: Engine::Exact, ..rules });
    }
    others.push(Rules { tie_break: TieBreak::Random(1), engine: Engine::Scheme, ..rules });
    for rules in others {
        let mut again = attempt(rules)?;
        attempts.append(&mut again.answer.attempts);
        if again.answer.is_answer() {
            again.answer.notes.push(told(&first, &attempts));
            again.answer.attempts = attempts;
            return Ok(again);
        }
    }
    if let Some(found) = found {
        for z in &found.answers {
            let mut solved = plain_answer(lcp, z, &first.answer);
            if !solved.answer.is_answer() {
                continue;
            }
            attempts.append(&mut solved.answer.attempts);
            solved.answer.notes.push(told(&first, &attempts));
            if found.answers.len() > 1 {
                solved.answer.notes.push(format!("there are {} answers; this is one of them", found.answers.len()));
            }
            solved.answer.attempts = attempts;
            return Ok(solved);
        }
    }
    let tried: Vec<String> = attempts[1..]
        .iter()
        .map(|attempt| format!("tie-break {}, engine {}", attempt.tie_break, attempt.engine))
        .collect();
    if !tried.is_empty() {
        let said = format!(" Tried besides, without an answer: {}.", tried.join("; "));
        match (&mut first.answer.failure, &mut first.answer.ray) {
            (Some(text), _) => text.push_str(&said),
            (None, Some(ray)) => ray.explanation.push_str(&said),
            (None, None) => {}
        }
        attempts.push(attempts[0].clone());
    }
    first.answer.attempts = attempts;
    Ok(first)
}
