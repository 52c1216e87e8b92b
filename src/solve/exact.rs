//! The exact check of an answer.

use super::engines::EXACT_PAIRS;
use super::error::QuestionError;
use super::ladder::EXACT_BUDGET;
use super::plain_answers::{PlainCheck, check_plain_exactly};
use super::prepared::Prepared;
use super::state::{RunData, Solved};
use crate::answer::attempt::AttemptEngine;
use crate::answer::pairs::{JointState, pair_states};
use crate::answer::record::{OutcomeKind, State};
use crate::contact::rows::RowKind;
use crate::contact::schemes::exact_check::{ExactCheck, Finding, exact_check};
use crate::contact::schemes::scheme::{PairScheme, Tangential};
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
        // Only figures of the size of rounding are worth the proof.
        if solved.answer.pairs.len() > EXACT_PAIRS || !solved.answer.check.is_within(EXCUSABLE) {
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
        answer.outcome = OutcomeKind::Normal;
        answer.failure = None;
        if let Some(last) = answer.attempts.last_mut() {
            last.outcome = OutcomeKind::Normal;
        }
        answer.pairs = pair_states(problem, contact, &state);
        self.add_released_slips(&mut answer.pairs, problem, &state.z);
        self.complete(answer, problem, &state);
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
                let basis = match &solved.answer.solution {
                    Some(solution) if solved.answer.rules.engine == AttemptEngine::Enumeration => {
                        solution.z.iter().enumerate().filter(|(_, z)| **z > 0.0).map(|(i, _)| i).collect()
                    }
                    _ => pivots.basis().z,
                };
                check_plain_exactly(lcp, &basis, watch).map(Exactly::Plain).ok_or_else(|| {
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
                if let Some(refusal) = system.refusal("check exact") {
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

/// The working scheme at the end: from the last basis, or from the states where there are no pivots.
pub fn final_scheme(solved: &Solved) -> Vec<PairScheme> {
    let mut schemes: Vec<PairScheme> = solved
        .answer
        .pairs
        .iter()
        .map(|pair| match (pair.state, pair.held) {
            (State::Open, None) => PairScheme::OPEN,
            (State::Open, Some(held)) => PairScheme {
                open: true,
                tangential: match held {
                    State::SlipPlus => Tangential::SlipPlus,
                    State::SlipMinus => Tangential::SlipMinus,
                    _ => Tangential::Stick,
                },
            },
            (State::SlipPlus, _) => PairScheme::SLIP_PLUS,
            (State::SlipMinus, _) => PairScheme::SLIP_MINUS,
            // A slip in space is none of these; who asks for schemes refuses it.
            (State::Stick | State::Closed | State::Slip, _) => PairScheme::STICK,
        })
        .collect();
    let RunData::Contact { contact, problem, pivots, .. } = &solved.run else {
        return schemes;
    };
    if pivots.is_empty() {
        return schemes;
    }
    schemes.fill(PairScheme::STICK);
    for row in pivots.basis().z {
        let meaning = contact.rows[row];
        let scheme = &mut schemes[meaning.pair];
        match meaning.couple {
            RowKind::Normal => scheme.open = true,
            RowKind::PLUS => scheme.tangential = Tangential::SlipPlus,
            RowKind::Facet(_) => scheme.tangential = Tangential::SlipMinus,
        }
    }
    for (i, scheme) in schemes.iter_mut().enumerate() {
        if scheme.open && problem.laws[i].fixed_bound() == 0.0 {
            *scheme = PairScheme::OPEN;
        }
    }
    schemes
}
