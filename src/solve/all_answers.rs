//! Every answer of a small problem as a solved state; critical friction; the exact check of an answer.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::engines::EXACT_PAIRS;
use super::ladder::{Deadline, EXACT_BUDGET};
use super::numbers::{contact_numbers, factors};
use super::plain_answers::{Effort, PlainCheck, check_plain_exactly, search_plain_answers};
use super::prepared::{Geometry, Prepared};
use super::solved::{SolveError, Solved, Trace, empty_answer};
use crate::answer::check::TOLERANCE;
use crate::answer::check_plain::{ROUNDING, check_plain};
use crate::answer::pairs::{JointState, pair_states};
use crate::answer::record::{Answer, OutcomeKind, PairDirection, PlainSolution, State};
use crate::contact;
use crate::contact::lcp::{RowKind, contact_lcp};
use crate::contact::numbers::ContactNumbers;
use crate::contact::schemes::critical::{CriticalFriction, critical_friction};
use crate::contact::schemes::enumerate::{EnumeratedAnswer, enumerate};
use crate::contact::schemes::exact_check::{ExactCheck, Finding, exact_check};
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::contact::system::{ContactPair, ContactSystem};
use nalgebra::DVector;

use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::pivot::PivotLog;
use crate::model::jet::Dependence;
use crate::model::pair::Law;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Rules};
use crate::watch::Watch;

/// The word for an answer found by going through all working schemes.
pub const ENUMERATION: &str = "enumeration";
/// Blocks drawn by `critical` where all of them are too many.
const SAMPLES: u64 = 20_000;
/// Most contact pairs that `enumerate` takes.
const MOST_PAIRS: usize = 60;
/// Most rows of a bare LCP that `enumerate` takes.
const MOST_ROWS: usize = 300;
/// Figures of a failed check up to which an exact proof is tried.
const EXCUSABLE: f64 = 1e-4;
/// Seed of the drawing.
const SEED: u64 = 1;

/// All answers of a problem.
#[derive(Clone, Debug)]
pub struct AllAnswers {
    /// Each as a solved state without pivots.
    pub answers: Vec<Solved>,
    /// For each: whether it was proved in exact arithmetic.
    pub exact: Vec<bool>,
    /// For each: whether others lie next to it.
    pub continuum: Vec<bool>,
    /// Sets of answers between and beyond them.
    pub continua: Vec<Continuum>,
    /// Whether the search came to its end.
    pub complete: bool,
    /// Schemes (of a bare LCP: bases) that were solved.
    pub visited: u64,
    /// Partial schemes that were cut off.
    pub cut: u64,
    /// All schemes there are.
    pub total: u64,
    /// Schemes that could not be decided.
    pub undecided: u64,
}

/// A set of answers with more than one element: the hull of its corners, and from there on along its directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Continuum {
    /// Its corners, as indices of the answers.
    pub corners: Vec<usize>,
    /// Directions in which it goes on without end, largest entry 1.
    pub directions: Vec<Moving>,
}

/// A direction in the set of answers.
#[derive(Clone, Debug, PartialEq)]
pub enum Moving {
    /// Of a contact problem.
    Pairs(Vec<PairDirection>),
    /// z of a bare LCP.
    Plain(Vec<f64>),
}

impl AllAnswers {
    /// There is none: proved.
    pub fn none(&self) -> bool {
        self.complete && self.undecided == 0 && self.answers.is_empty()
    }
}

/// Why a question has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuestionError {
    /// Says what does not fit.
    #[error("{0}")]
    Refused(String),
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl From<SolveError> for QuestionError {
    fn from(error: SolveError) -> Self {
        if error.is_interrupted() { QuestionError::Interrupted } else { QuestionError::Refused(error.to_string()) }
    }
}

fn go_on(watch: &dyn Watch) -> ControlFlow<()> {
    if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// What the exact check says, of a contact problem or a bare LCP.
#[derive(Clone, Debug, PartialEq)]
pub enum Exactly {
    /// Of a working scheme.
    Contact(ExactCheck),
    /// Of a basis.
    Plain(PlainCheck),
}

impl Prepared {
    /// Every answer for these values.
    ///
    /// # Errors
    /// Too many pairs or rows; a covering that does not fit the numbers. Stopped, what was found until then is returned as incomplete.
    pub fn all_answers(&self, values: &ParameterValues, watch: &dyn Watch) -> Result<AllAnswers, QuestionError> {
        let system = match &*self.geometry {
            Geometry::Plain { lcp, q, .. } => {
                let mut lcp = lcp.clone();
                for (entry, number) in lcp.q.iter_mut().zip(q) {
                    *entry = number.value(values);
                }
                return all_of_plain(&lcp.into(), watch);
            }
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => system,
        };
        if let Some(refusal) = system.refusal("enumerate") {
            return Err(QuestionError::Refused(refusal));
        }
        too_many("contact pairs", system.pair_count(), MOST_PAIRS)?;
        let factors = factors(self, values);
        let numbers = contact_numbers(system, &factors, values);
        let mut steps = 0u64;
        let found = enumerate(system, &numbers, &mut |progress| {
            steps += 1;
            if steps.is_multiple_of(64) {
                watch.progress(&format!("{} schemes, {} answers", progress.nodes, progress.found), progress.share);
            }
            go_on(watch)
        });
        if found.no_answer() {
            // At a limit on paper the numbers as stored may be just beyond it.
            let near = self.attempt_contact(system, &numbers, &factors, Rules::default(), watch)?;
            if near.answer.is_answer() {
                return Ok(AllAnswers {
                    answers: vec![near],
                    exact: vec![false],
                    continuum: vec![false],
                    continua: Vec::new(),
                    complete: true,
                    visited: found.visited,
                    cut: found.cut,
                    total: found.total,
                    undecided: 0,
                });
            }
        }
        let answers = found
            .answers
            .iter()
            .map(|candidate| self.enumerated_answer(system, &numbers, &factors, candidate))
            .collect::<Result<Vec<_>, _>>()?;
        let count = answers.len();
        let pairs = |direction: &DVector<f64>| {
            let pair = |(i, pair): (usize, &ContactPair)| PairDirection {
                pair: pair.id.clone(),
                z_n: direction[i],
                z_t: pair.tangential.map_or(0.0, |joint| direction[joint]),
            };
            Moving::Pairs(system.pairs.iter().enumerate().map(pair).collect())
        };
        let continuum = |piece: &contact::schemes::enumerate::Continuum| Continuum {
            corners: piece.corners.clone(),
            directions: piece.directions.iter().map(pairs).collect(),
        };
        Ok(AllAnswers {
            answers,
            exact: vec![true; count],
            continuum: found.answers.iter().map(|answer| answer.continuum).collect(),
            continua: found.continua.iter().map(continuum).collect(),
            complete: found.complete,
            visited: found.visited,
            cut: found.cut,
            total: found.total,
            undecided: found.undecided,
        })
    }

    /// An enumerated answer as a solved state, freshly checked.
    pub(super) fn enumerated_answer(
        &self,
        system: &ContactSystem,
        numbers: &ContactNumbers,
        factors: &[f64],
        candidate: &EnumeratedAnswer,
    ) -> Result<Solved, SolveError> {
        let contact = contact_lcp(system, numbers, Covering::default())?;
        let mut z = vec![0.0; contact.rows.len()];
        for (value, row) in z.iter_mut().zip(&contact.rows) {
            let tangential = system.pairs[row.pair].tangential;
            let slip = tangential.map_or(0.0, |joint| candidate.state.z[joint]);
            // What the scheme holds is zero, not the rounding of a linear program.
            let scheme = candidate.schemes.first().map(|scheme| scheme[row.pair]);
            let free = |plus: bool| {
                scheme.is_none_or(|scheme| match scheme.tangential {
                    // Without cohesion an open pair slips either way.
                    _ if scheme == PairScheme::OPEN => true,
                    Tangential::Stick => false,
                    Tangential::SlipPlus => plus,
                    Tangential::SlipMinus => !plus,
                })
            };
            *value = match row.couple {
                RowKind::Normal if scheme.is_some_and(|scheme| !scheme.open) => 0.0,
                RowKind::Normal => candidate.state.z[row.pair].max(0.0),
                RowKind::Plus if free(true) => slip.max(0.0),
                RowKind::Minus if free(false) => (-slip).max(0.0),
                RowKind::Plus | RowKind::Minus => 0.0,
            } / contact.length_unit;
        }
        let point = Point { w: vec![0.0; z.len()], z, p: 0.0 };
        let default = Rules::default();
        let words = [default.covering.to_string(), default.tie_break.to_string(), ENUMERATION.to_owned()];
        Ok(self.answer_at(system, numbers, factors, contact, point, words))
    }

    /// The value of a friction parameter above which more than one answer is possible for some load.
    ///
    /// # Errors
    /// No contact pairs; no Coulomb pair has this friction; stopped.
    pub fn critical_friction(
        &self,
        values: &ParameterValues,
        parameter: &str,
        watch: &dyn Watch,
    ) -> Result<CriticalFriction, QuestionError> {
        let refused = |text: String| Err(QuestionError::Refused(text));
        let Some(system) = self.system() else {
            return refused("a bare LCP has no friction".to_owned());
        };
        if let Some(refusal) = system.refusal("critical") {
            return refused(refusal);
        }
        let along = values.along(parameter);
        let frictions = || {
            system.pairs.iter().filter_map(|pair| match &pair.law {
                Law::Coulomb { friction, .. } => Some((pair, friction)),
                Law::Frictionless { .. } | Law::Bound { .. } => None,
            })
        };
        if frictions().all(|(_, friction)| along.dependence(friction) == Dependence::Constant) {
            let names = values.formulas().free(frictions().flat_map(|(_, friction)| friction.names()));
            let names: Vec<String> = values.keys().filter(|name| names.contains(*name)).cloned().collect();
            return refused(if names.is_empty() {
                "no pair has a friction that is a parameter".to_owned()
            } else {
                format!("`{parameter}` is not the friction of any pair; expected {}", names.join(" or "))
            });
        }
        if let Some((pair, friction)) = frictions().find(|(_, f)| along.dependence(f) == Dependence::Nonlinear) {
            return refused(format!(
                "the friction of pair {}, {}, is no linear function of {parameter}: `critical` needs one",
                pair.id,
                friction.text()
            ));
        }
        let factors = factors(self, values);
        let friction = |value: f64| {
            let mut values = values.clone();
            values.insert(parameter.to_owned(), value);
            contact_numbers(system, &factors, &values).friction
        };
        if friction(0.0).iter().any(|f| *f < 0.0) {
            return refused(format!("at {parameter} = 0 a friction is negative: `critical` goes up from 0"));
        }
        let found = critical_friction(system, &friction, SAMPLES, SEED, &mut |examined| {
            if examined.is_multiple_of(1024) {
                watch.progress(&format!("block {examined}"), 0.0);
            }
            go_on(watch)
        });
        if found.complete { Ok(found) } else { Err(QuestionError::Interrupted) }
    }

    /// A state that failed its check has the right working scheme where that holds in exact arithmetic: with great
    /// stiffness contrasts no elimination in f64 gives its z. The exact z, rounded once, is then checked as any other.
    pub(super) fn prove_after_all(&self, solved: &mut Solved, watch: &dyn Watch) {
        let small = solved.answer.pairs.len() <= EXACT_PAIRS;
        let check = solved.answer.check;
        // Only figures of the size of rounding are worth the proof.
        let near = check.min_w >= -EXCUSABLE
            && check.min_z >= -EXCUSABLE
            && check.complementarity <= EXCUSABLE
            && check.equilibrium.is_none_or(|residual| residual <= TOLERANCE);
        if !small || !near {
            return;
        }
        let deadline = Deadline::after(EXACT_BUDGET, watch);
        let Ok(Exactly::Contact(ExactCheck { finding: Finding::Proved { .. }, z: Some(z), .. })) =
            self.check_exactly(solved, &deadline)
        else {
            if deadline.passed() {
                solved.say(&format!(" Its exact check was given up after {} s.", EXACT_BUDGET.as_secs()));
            }
            return;
        };
        let (Trace::Contact { contact, numbers, factors, .. }, Some(system)) = (&solved.trace, self.system()) else {
            return;
        };
        let state = JointState::at(system, numbers, z, 0.0);
        let answer = &mut solved.answer;
        answer.outcome = OutcomeKind::Normal;
        answer.failure = None;
        if let Some(last) = answer.attempts.last_mut() {
            last.outcome = OutcomeKind::Normal;
        }
        answer.pairs = pair_states(system, numbers, contact, &state);
        self.add_released_slips(&mut answer.pairs, numbers, factors, &state.z);
        self.complete(answer, system, numbers, factors, &state);
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
        match (&solved.trace, self.system()) {
            (Trace::Plain { lcp, pivots }, _) => {
                let basis = match &solved.answer.solution {
                    Some(solution) if solved.answer.engine == ENUMERATION => {
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
            (Trace::Contact { numbers, .. }, Some(system)) => {
                if let Some(refusal) = system.refusal("check exact") {
                    return Err(QuestionError::Refused(refusal));
                }
                let scheme = final_scheme(solved);
                let check = exact_check(system, numbers, &scheme, &mut |share| {
                    watch.progress("exact check", share);
                    go_on(watch)
                });
                if watch.stop() {
                    return Err(QuestionError::Interrupted);
                }
                Ok(Exactly::Contact(check))
            }
            (Trace::Contact { .. }, None) => {
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
            (State::Stick | State::Closed, _) => PairScheme::STICK,
        })
        .collect();
    let Trace::Contact { contact, numbers, pivots, .. } = &solved.trace else {
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
            RowKind::Plus => scheme.tangential = Tangential::SlipPlus,
            RowKind::Minus => scheme.tangential = Tangential::SlipMinus,
        }
    }
    for (i, scheme) in schemes.iter_mut().enumerate() {
        if scheme.open && numbers.cohesion[i] == 0.0 {
            *scheme = PairScheme::OPEN;
        }
    }
    schemes
}

/// "there are 3 answers; this is one of them", where there are others.
pub(super) fn others(count: usize, infinite: bool, complete: bool) -> Option<String> {
    if infinite {
        return Some("there are infinitely many answers; this is one of them (`enumerate`)".to_owned());
    }
    let known = if complete { "" } else { "at least " };
    (count > 1).then(|| format!("there are {known}{count} answers; this is one of them"))
}

/// Refuses what no search comes to an end of, and what its exact numbers would fill the memory with.
fn too_many(what: &str, found: usize, most: usize) -> Result<(), QuestionError> {
    if found <= most {
        return Ok(());
    }
    Err(QuestionError::Refused(format!("{found} {what} are too many to enumerate: at most {most}")))
}

fn all_of_plain(lcp: &Arc<MirroredLcp>, watch: &dyn Watch) -> Result<AllAnswers, QuestionError> {
    too_many("rows", lcp.size(), MOST_ROWS)?;
    let found = search_plain_answers(lcp, Effort::Full, watch).ok_or(QuestionError::Interrupted)?;
    let run = Run { outcome: Outcome::Trivial, pivots: PivotLog::default(), point: Point::default() };
    let words = ["ones", "lexicographic", ENUMERATION].map(str::to_owned);
    let like = empty_answer(&run, 1.0, words, crate::answer::record::Size { lcp: lcp.size(), ..Default::default() });
    let count = found.answers.len();
    let next_to = |answer: usize| found.continua.iter().any(|piece| piece.corners.contains(&answer));
    Ok(AllAnswers {
        answers: found.answers.iter().map(|z| plain_answer(lcp, z, &like)).collect(),
        exact: vec![true; count],
        continuum: (0..count).map(next_to).collect(),
        continua: found
            .continua
            .iter()
            .map(|piece| Continuum {
                corners: piece.corners.clone(),
                directions: piece.directions.iter().cloned().map(Moving::Plain).collect(),
            })
            .collect(),
        complete: found.complete,
        visited: found.visited,
        cut: found.cut,
        total: 1u64.checked_shl(lcp.size() as u32).unwrap_or(u64::MAX),
        undecided: found.undecided,
    })
}

/// An enumerated answer of a bare LCP as a solved state, freshly checked; rules and size as `like`.
pub(super) fn plain_answer(lcp: &Arc<MirroredLcp>, z: &[f64], like: &Answer) -> Solved {
    let w = lcp.times(z) + &lcp.q;
    let point = Point { w: w.iter().copied().collect(), z: z.to_vec(), p: 0.0 };
    let check = check_plain(lcp, &point.z, ROUNDING);
    let run = Run { outcome: Outcome::Normal { marginal: false }, pivots: PivotLog::default(), point };
    let words = [like.covering.clone(), like.tie_break.clone(), ENUMERATION.to_owned()];
    let mut answer = empty_answer(&run, 1.0, words, like.size);
    answer.check = check;
    answer.solution = Some(PlainSolution { z: run.point.z, w: run.point.w });
    if !answer.check.passed {
        answer.outcome = OutcomeKind::CheckFailed;
    }
    Solved {
        answer,
        trace: Trace::Plain { lcp: Arc::clone(lcp), pivots: PivotLog::default() },
        ray: None,
        plain_ray: None,
        cycled: false,
        kept: None,
        told: String::new(),
    }
}
