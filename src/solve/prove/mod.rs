//! What stands, proved in rationals for somebody else to check: the numbers it is about and every sign.
//!
//! A proof is about the f64 numbers of the condensed system, each taken as the rational it is. How far these are from
//! the structure is a statement of its own (`check`).

mod answer;
mod collapse;
pub mod forms;
pub mod system;
pub mod tree;

use std::time::Duration;

use num_rational::BigRational;

use super::error::QuestionError;
use super::exact::final_scheme;
use super::plain_answers::{RayProof, prove_plain_ray};
use super::prepared::{Geometry, Prepared};
use super::state::{RunData, Solved};
use crate::answer::record::OutcomeKind;
use crate::contact::law::PairLaw;
use crate::contact::polygon::Polygon;
use crate::contact::schemes::scheme::PairScheme;
use crate::watch::{Budget, Watch};
use answer::answer_of;
pub use collapse::Collapse;
use forms::{Forms, Group};
use system::{ProvedContact, ProvedSystem};
use tree::{AllAnswers, MOST_NODES, NoTree, Tree, grow};

/// Most pairs of an answer whose proof is written.
pub const MOST_PAIRS: usize = 120;
/// Most rows of an LCP whose proof is written.
pub const MOST_ROWS: usize = 240;
/// Most motions without energy of a structure whose answer is proved.
pub const MOST_MOTIONS: usize = 48;
/// Most pairs for which the motion of a collapse is found by exact linear programming.
const MOST_PAIRS_OF_MOTION: usize = 60;
/// Most pairs whose answers are all proved.
pub const MOST_PAIRS_OF_ALL: usize = 12;
/// Most rows of an LCP whose answers are all proved.
pub const MOST_ROWS_OF_ALL: usize = 30;

/// Time for the tree of all answers: numbers with many digits make each of its branches slow.
const PATIENCE: Duration = Duration::from_secs(60);
/// What is possible where all answers are too many.
const ONE_ANSWER: &str = "`prove FILE.json` proves what stands";
/// What is possible where an answer is too large for a file.
const SIGNS: &str = "`check exact` tests its signs in rationals without writing them down";

/// What is proved.
#[derive(Clone, Debug, PartialEq)]
pub enum Claim {
    /// These unknowns are an answer.
    Answer(Vec<BigRational>),
    /// No contact forces balance the loads.
    Collapse(Collapse),
    /// These are all answers; where there are none, there is no answer.
    Answers(AllAnswers),
}

/// A proof and what it is about.
#[derive(Clone, Debug, PartialEq)]
pub struct Proof {
    /// The numbers.
    pub system: ProvedSystem,
    /// The forms that the claim speaks of.
    pub forms: Forms,
    /// The claim with all that proves it.
    pub claim: Claim,
}

impl Proof {
    /// The polygon that it is about; `None` in the plane, of an LCP and where it is about Coulomb's cone itself.
    pub fn polygon(&self) -> Option<Polygon> {
        match (&self.system, &self.claim) {
            (_, Claim::Collapse(Collapse { on_cone: true, .. })) => None,
            (ProvedSystem::Contact(contact), _) if contact.tangents > 1 => Some(contact.polygon),
            _ => None,
        }
    }
}

fn refused<T>(text: impl Into<String>) -> Result<T, QuestionError> {
    Err(QuestionError::Refused(text.into()))
}

/// `instead`: what is possible at this size.
fn too_many(what: &str, (found, most): (usize, usize), instead: &str) -> Result<(), QuestionError> {
    if found <= most {
        Ok(())
    } else {
        refused(format!("prove: {found} {what} are too many, at most {most}; {instead}"))
    }
}

impl Prepared {
    /// The numbers that proofs of a solved state are about, as `command` asks for them.
    ///
    /// # Errors
    /// Joints that repeat one another, no contact pairs.
    pub fn proved_system(&self, solved: &Solved, command: &str) -> Result<ProvedSystem, QuestionError> {
        match (&solved.run, &*self.geometry) {
            (RunData::Plain { lcp, .. }, Geometry::Plain { names, .. }) => Ok(ProvedSystem::of_plain(lcp, names)),
            (RunData::Contact { problem, .. }, _) => {
                let instead = "`export lcp FILE.json` writes an LCP of which answers can be proved";
                if let Some(refusal) = problem.system.dependence_refusal(command, instead) {
                    return refused(refusal);
                }
                Ok(ProvedSystem::Contact(ProvedContact::of(problem, self.built())))
            }
            (RunData::Plain { .. }, _) => refused("nothing to prove: there are no contact pairs"),
        }
    }

    /// The proof of what stands: the answer, the collapse, or that there is no answer.
    ///
    /// # Errors
    /// Nothing is proved of it, it is too large, it was stopped.
    pub fn prove(&self, solved: &Solved, watch: &dyn Watch) -> Result<Proof, QuestionError> {
        let system = self.proved_system(solved, "prove")?;
        if solved.answer.is_answer() || solved.answer.outcome == OutcomeKind::CheckFailed {
            return prove_answer(system, solved, watch);
        }
        let ray = solved.answer.ray.as_ref().filter(|_| solved.answer.outcome == OutcomeKind::Ray);
        let Some(ray) = ray else {
            return refused("prove: the run was given up, which says nothing about answers");
        };
        if !ray.class.is_of_structure() {
            return refused("prove: this ray is one of the rules, not of the problem: `help ray` says what to try");
        }
        // A motion needs no form, and with many motions in the kernel the forms are long.
        let found = match (&system, &solved.run) {
            (ProvedSystem::Contact(contact), RunData::Contact { problem, .. }) => {
                let found = collapse::collapse(problem, self.built(), contact, watch);
                found.map(|found| (Claim::Collapse(found), Forms::unknowns_of(contact)))
            }
            (_, RunData::Plain { lcp, .. }) => match prove_plain_ray(lcp, watch) {
                Some(RayProof::Infeasible(farkas)) => {
                    let forms = Forms::of(&system);
                    let weights: Vec<_> = farkas.weights.into_iter().map(BigRational::from_integer).collect();
                    let tree = Tree::Cut(tree::of_farkas(&forms, &weights));
                    let all = AllAnswers { tree, answers: Vec::new(), sets: 0, nodes: 1 };
                    Some((Claim::Answers(all), forms))
                }
                _ => None,
            },
            _ => None,
        };
        if let Some((claim, forms)) = found {
            return Ok(Proof { system, forms, claim });
        }
        if watch.stop() {
            return Err(QuestionError::Interrupted);
        }
        match self.prove_all(solved, watch) {
            Err(QuestionError::Refused(why)) => {
                let why = why.trim_start_matches("prove: ");
                refused(format!("prove: no proof was found that there is no answer ({why})"))
            }
            Ok(Proof { claim: Claim::Answers(all), .. }) if !all.answers.is_empty() => refused(
                "prove: the run ended in a ray, but there is an answer: `enumerate` shows it, `prove all FILE` proves it",
            ),
            other => other,
        }
    }

    /// The proof of what all answers are.
    ///
    /// # Errors
    /// It is too large, or it was stopped.
    pub fn prove_all(&self, solved: &Solved, watch: &dyn Watch) -> Result<Proof, QuestionError> {
        let system = self.proved_system(solved, "prove")?;
        match &system {
            ProvedSystem::Contact(contact) => {
                let size = (contact.ids.len(), MOST_PAIRS_OF_ALL);
                too_many("contact pairs for a proof of all answers", size, ONE_ANSWER)?;
            }
            ProvedSystem::Plain { q, .. } => {
                too_many("rows for a proof of all answers", (q.len(), MOST_ROWS_OF_ALL), ONE_ANSWER)?;
            }
        }
        let forms = Forms::of(&system);
        let budget = Budget::new(watch, PATIENCE);
        let (mut steps, mut done) = (0_u64, (0, 0.0));
        let grown = grow(&forms, &mut |nodes, share| {
            steps += 1;
            done = (nodes, share);
            if steps.is_multiple_of(64) {
                watch.progress(&format!("{nodes} branches"), share);
            }
            !budget.stop()
        });
        match grown {
            Ok(all) => Ok(Proof { system, forms, claim: Claim::Answers(all) }),
            Err(NoTree::Stopped) if !budget.ran_out() => Err(QuestionError::Interrupted),
            Err(_) => refused(too_large(&forms, &system, done)),
        }
    }
}

/// Why the tree was given up after this many nodes, with this share of it done.
fn too_large(forms: &Forms, system: &ProvedSystem, (nodes, share): (usize, f64)) -> String {
    let unit = if matches!(system, ProvedSystem::Plain { .. }) { "rows" } else { "pairs" };
    let (count, branches) = (forms.groups.len(), forms.groups.iter().map(|group| group.branches.len()).max());
    let mut always = 0;
    let (mut level, mut all) = (1, 1);
    while all <= MOST_NODES {
        always += 1;
        level *= branches.unwrap_or(2);
        all += level;
    }
    let always = always - 1;
    format!(
        "prove: the tree of all schemes of {count} {unit} is too large: at most {MOST_NODES} branches and {} s, and after {nodes} \
         {:.0} % of it was done; {always} such {unit} always have few enough. {ONE_ANSWER}, `enumerate` goes through all schemes \
         without writing them down",
        PATIENCE.as_secs(),
        100.0 * share
    )
}

fn prove_answer(system: ProvedSystem, solved: &Solved, watch: &dyn Watch) -> Result<Proof, QuestionError> {
    match &system {
        ProvedSystem::Contact(contact) => {
            too_many("contact pairs", (contact.ids.len(), MOST_PAIRS), SIGNS)?;
            too_many("motions that only contact holds", (contact.kernel.len(), MOST_MOTIONS), SIGNS)?;
        }
        ProvedSystem::Plain { q, .. } => too_many("rows", (q.len(), MOST_ROWS), SIGNS)?,
    }
    let forms = Forms::of(&system);
    let scheme = match (&system, &solved.run) {
        (ProvedSystem::Contact(contact), _) => {
            let schemes = final_scheme(solved);
            let branch = |((group, law), scheme): ((&Group, &PairLaw), &PairScheme)| {
                branch_of(group, law, (*scheme, contact.polygon))
            };
            forms.groups.iter().zip(&contact.laws).zip(&schemes).map(branch).collect()
        }
        (ProvedSystem::Plain { .. }, run) => plain_scheme(forms.groups.len(), solved, run),
    };
    match answer_of(&forms, scheme, watch) {
        Some(z) => Ok(Proof { system, forms, claim: Claim::Answer(z) }),
        None if watch.stop() => Err(QuestionError::Interrupted),
        None => refused(
            "prove: the answer holds to rounding only, no scheme near it is an answer of the numbers as they are stored: \
             `check exact` says which sign fails",
        ),
    }
}

/// The branch that a working scheme means; 0 where it names none.
fn branch_of(group: &Group, law: &PairLaw, (scheme, polygon): (PairScheme, Polygon)) -> usize {
    let slips = scheme.tangential.word(polygon);
    let open = scheme.open && !law.is_bilateral();
    let word = match open {
        true => format!("open {slips}"),
        false => slips,
    };
    let named = |name: &str| group.branches.iter().position(|branch| branch.name == name);
    named(&word).or_else(|| named(if open { "open" } else { "closed" })).unwrap_or_default()
}

/// Branch `w` (w = 0) where z is basic.
fn plain_scheme(rows: usize, solved: &Solved, run: &RunData) -> Vec<usize> {
    let mut scheme = vec![0; rows];
    let RunData::Plain { pivots, .. } = run else { return scheme };
    solved.basic_rows(pivots).into_iter().for_each(|row| scheme[row] = 1);
    scheme
}
