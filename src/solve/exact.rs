//! The exact check of an answer.

use super::engines::EXACT_PAIRS;
use super::error::QuestionError;
use super::finish::{excuse_hidden, pass_check};
use super::ladder::EXACT_BUDGET;
use super::plain_answers::{PlainCheck, check_plain_exactly};
use super::prepared::Prepared;
use super::state::{RunData, Solved};
use crate::answer::pairs::{JointState, pair_states};
use crate::answer::record::{OutcomeKind, PairState, State};
use crate::contact::schemes::exact_check::{ExactCheck, Finding, exact_check};
use crate::contact::schemes::scheme::{PairScheme, Tangential, schemes_of};
use crate::watch::{Budget, Watch};

/// Shares up to which the figures of a failed check are worth an exact proof.
const EXCUSABLE: f64 = 1e-4;

/// What the exact check says, of a contact problem or a bare LCP.
#[derive(Clone, Debug, PartialEq)]
pub enum Exactly {
    /// Of a working scheme.
    Contact(ExactCheck),
    /// Of a basis.
    Plain(PlainCheck),
}

impl Prepared {
    /// A state that failed its check has the right working scheme where that holds in exact arithmetic: with great
    /// stiffness contrasts no elimination in f64 gives its z. The exact z, rounded once, is then checked as any other.
    pub(super) fn prove_after_all(&self, solved: &mut Solved, watch: &dyn Watch) {
        // In space the scheme is the polygon's, not that of the answer on the cone.
        if self.is_in_space() {
            return;
        }
        // Only figures of the size of rounding are worth the proof; beside exact data it may have hidden the loads.
        let has_exact_data = self.system().is_some_and(|system| system.has_exact_data());
        let check = &solved.answer.check;
        let excusable = check.is_within(EXCUSABLE) || (has_exact_data && check.of_proved_state().is_within(EXCUSABLE));
        if self.system().is_none_or(|system| system.turning_pairs() > EXACT_PAIRS) || !excusable {
            return;
        }
        let budget = Budget::new(watch, EXACT_BUDGET);
        let Ok(Exactly::Contact(ExactCheck { finding: Finding::Proved { .. }, z: Some(z), .. })) =
            self.check_exactly(solved, &budget)
        else {
            if budget.ran_out() {
                solved.say(&format!(" Its exact check was given up after {} s.", EXACT_BUDGET.as_secs()));
            }
            return;
        };
        let RunData::Contact { contact, problem, .. } = &solved.run else {
            return;
        };
        let state = JointState::at(problem, z, 0.0);
        let answer = &mut solved.answer;
        pass_check(answer);
        answer.pairs = pair_states(problem, contact, &state);
        self.add_released_slips(&mut answer.pairs, problem, &state.z);
        self.complete(answer, problem, &state);
        if has_exact_data {
            excuse_hidden(answer);
        }
        if answer.is_answer() {
            answer.notes.push(
                "the displacements were computed in exact arithmetic: elimination in f64 loses them under great stiffness \
                 contrasts"
                    .to_owned(),
            );
        }
    }

    /// The final scheme of an answer in exact arithmetic from the f64 data.
    ///
    /// # Errors
    /// There is no answer, the bare LCP is too large, or it was stopped.
    pub fn check_exactly(&self, solved: &Solved, watch: &dyn Watch) -> Result<Exactly, QuestionError> {
        let no_answer = !solved.answer.is_answer() && solved.answer.outcome != OutcomeKind::CheckFailed;
        if no_answer {
            return Err(QuestionError::Refused("nothing to check: there is no answer".to_owned()));
        }
        match (&solved.run, self.system()) {
            (RunData::Plain { lcp, pivots }, _) => {
                check_plain_exactly(lcp, &solved.basic_rows(pivots), watch).map(Exactly::Plain).ok_or_else(|| {
                    if watch.stop() {
                        return QuestionError::Interrupted;
                    }
                    QuestionError::Refused(format!(
                        "{} rows are too many for the exact check of a bare LCP",
                        lcp.size()
                    ))
                })
            }
            (RunData::Contact { problem, .. }, Some(system)) => {
                if let Some(refusal) =
                    system.dependence_refusal("check exact", "`check` has what is left of their laws in f64")
                {
                    return Err(QuestionError::Refused(refusal));
                }
                let scheme = final_scheme(solved);
                let check = exact_check(problem, &scheme, &mut |share| {
                    watch.progress("exact check", share);
                    watch.go_on()
                });
                if watch.stop() {
                    return Err(QuestionError::Interrupted);
                }
                Ok(Exactly::Contact(check))
            }
            (RunData::Contact { .. }, None) => {
                Err(QuestionError::Refused("nothing to check: there are no contact pairs".to_owned()))
            }
        }
    }
}

/// The working scheme at the end: from the last basis, or from the states where there are no pivots. In space that of the
/// polygon, from which Newton's method goes on to the cone.
pub fn final_scheme(solved: &Solved) -> Vec<PairScheme> {
    let RunData::Contact { contact, problem, pivots, last } = &solved.run else {
        return solved.answer.pairs.iter().map(scheme_shown).collect();
    };
    let released = if !pivots.is_empty() {
        pivots.basis().z
    } else if problem.system.is_in_space() {
        (0..last.z.len()).filter(|&row| last.z[row] > 0.0).collect()
    } else {
        return solved.answer.pairs.iter().map(scheme_shown).collect();
    };
    schemes_of(released.into_iter().map(|row| contact.rows[row]), &problem.laws, problem.polygon)
}

/// The working scheme of a pair in the plane as its state is shown.
fn scheme_shown(pair: &PairState) -> PairScheme {
    let slip = |state: Option<State>| match state {
        Some(State::SlipPlus) => Tangential::PLUS,
        Some(State::SlipMinus) => Tangential::MINUS,
        _ => Tangential::Stick,
    };
    match (pair.state, pair.held) {
        (State::Open, None) => PairScheme::OPEN,
        (State::Open, held) => PairScheme { open: true, tangential: slip(held) },
        (state, _) => PairScheme { open: false, tangential: slip(Some(state)) },
    }
}
