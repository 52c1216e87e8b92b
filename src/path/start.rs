//! Where a path starts, and why it cannot.

use std::sync::Arc;

use crate::answer::pairs::{JointState, joint_state};
use crate::contact::lcp::contact_lcp;
use crate::contact::load_path::is_answer;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::outcome::{Outcome, Point, RayDirection};
use crate::model::rules::Covering;
use crate::solve::engines::run_past_cycles;
use crate::solve::error::{QuestionError, SolveError};
use crate::solve::prepared::Prepared;
use crate::solve::{Solved, state::RunData};
use crate::text::number::short;
use crate::watch::Watch;

/// A difference of values on a path below this share of them is rounding.
pub(super) const ROUNDING: f64 = 1e-12;
/// No path makes more pivots than this.
pub const PIVOTS: usize = 100_000;

/// The contact system, for a command that knows two senses of slip only; `instead` says what is possible in space.
///
/// # Errors
/// A bare LCP; in space.
pub(super) fn plane_system<'a>(
    prepared: &'a Prepared,
    command: &'static str,
    instead: &str,
) -> Result<&'a Arc<ContactSystem>, PathError> {
    let system = prepared.system().ok_or(PathError::Plain(command))?;
    match system.space_refusal(command) {
        None => Ok(system),
        Some(why) => Err(PathError::Missing(format!("{why}; {instead}"))),
    }
}

/// Refuses a target that is not a number; −∞ stands for as far down as it goes.
pub(super) fn finite_target(name: &str, to: Option<f64>) -> Result<(), PathError> {
    match to {
        Some(to) if !to.is_finite() && to != f64::NEG_INFINITY => {
            Err(PathError::Target(format!("cannot follow {name} to {to}")))
        }
        _ => Ok(()),
    }
}

/// Why a path cannot be followed. Its own end (turning point, limit) is not an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// A bare LCP.
    #[error("a bare LCP has no loads and no friction: `{0}` needs contact pairs")]
    Plain(&'static str),
    /// Neither a load case nor a parameter that can be followed.
    #[error("nothing to follow: `{name}` is neither a load case nor a parameter of one; there are {known}")]
    Unknown {
        /// As given.
        name: String,
        /// The load cases and parameters that can be followed.
        known: String,
    },
    /// A parameter that moves more than loads or more than friction.
    #[error("{name} cannot be followed: {why}")]
    Mixed {
        /// The parameter.
        name: String,
        /// What else it moves.
        why: String,
    },
    /// An impossible target.
    #[error("{0}")]
    Target(String),
    /// The case, or the parameter of loads, does not act on any pair.
    #[error("{0} presses and pushes no contact pair: the state of the pairs does not depend on it")]
    Idle(String),
    /// No answer to start from.
    #[error("there is no answer to start from: at {name} = {at} the run ended {how}")]
    NoStart {
        /// What is followed.
        name: String,
        /// Its value there.
        at: f64,
        /// `in a ray`, …
        how: String,
    },
    /// An answer to start from that no path leads on from.
    #[error(
        "no path leads on from the answer at {name} = {at}; `find {name} A..B where …` looks at answers of their own"
    )]
    OffPaths {
        /// What is followed.
        name: String,
        /// Its value there.
        at: f64,
    },
    /// A scenario without what is asked for.
    #[error("{0}")]
    Missing(String),
    /// The numbers no longer belonged together.
    #[error("the path broke down at {name} = {at}: {why}")]
    Breakdown {
        /// What is followed.
        name: String,
        /// Its value there.
        at: f64,
        /// What failed.
        why: String,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl PathError {
    /// In a few words, for a table that names what was followed.
    pub fn brief(&self) -> String {
        match self {
            PathError::Idle(_) => "acts on no contact pair".to_owned(),
            PathError::NoStart { at, .. } => format!("no answer at {} to start from", short(*at)),
            PathError::Mixed { why, .. } => format!("cannot be followed: {why}"),
            error => error.to_string(),
        }
    }
}

impl From<QuestionError> for PathError {
    fn from(error: QuestionError) -> PathError {
        match error {
            QuestionError::Refused(why) => PathError::Target(why),
            QuestionError::Interrupted => PathError::Interrupted,
        }
    }
}

impl From<SolveError> for PathError {
    fn from(error: SolveError) -> PathError {
        QuestionError::from(error).into()
    }
}

/// An answer found without a path.
#[derive(Clone, Debug)]
pub(crate) struct Cold {
    pub(crate) contact: ContactLcp,
    /// `None` where the run ended in no answer.
    pub(crate) basis: Option<Basis>,
    /// That of the end of the run, whatever it is.
    pub(crate) last: Basis,
    pub(crate) point: Point,
    pub(crate) outcome: Outcome,
    pub(crate) pivots: usize,
}

impl Cold {
    /// The ray it ended in.
    pub(crate) fn ray(&self) -> Option<&RayDirection> {
        match &self.outcome {
            Outcome::Ray(ray) => Some(ray),
            _ => None,
        }
    }

    /// How it ended, for a message.
    pub(crate) fn how(&self) -> &'static str {
        match self.outcome {
            Outcome::Trivial | Outcome::Normal { .. } => "with an answer",
            Outcome::Ray(_) => "in a ray",
            Outcome::PivotLimit | Outcome::Cycle(_) => "at the limit of pivots",
            Outcome::Breakdown(_) | Outcome::Interrupted => "in a breakdown",
        }
    }
}

/// Solves under the default rules.
pub(crate) fn cold(problem: &ContactProblem, watch: &dyn Watch) -> Result<Cold, PathError> {
    // The default covering fits all numbers.
    let contact = contact_lcp(problem, Covering::Cohesive).map_err(|error| PathError::Target(error.to_string()))?;
    let run = run_past_cycles(&contact, watch);
    let last = run.pivots.basis();
    let basis = match run.outcome {
        Outcome::Interrupted => return Err(PathError::Interrupted),
        Outcome::Trivial | Outcome::Normal { marginal: false } => Some(last.clone()),
        _ => None,
    };
    Ok(Cold { contact, basis, last, point: run.point, outcome: run.outcome, pivots: run.pivots.count() })
}

/// The final scheme of a solved state; `None` where it is no answer, or one that only just is (marginal).
///
/// It is read from the pivots of the run, or, where the answer was reached on another way (warm, enumerated), from
/// what is released at its vertex.
pub fn final_basis(solved: &Solved) -> Option<Basis> {
    let RunData::Contact { contact, pivots, last, .. } = &solved.run else {
        return None;
    };
    if !solved.answer.is_answer() || solved.answer.marginal {
        return None;
    }
    let released: Vec<usize> = (0..last.z.len()).filter(|&row| last.z[row] > 0.0).collect();
    let from_vertex = Basis { active: released.clone(), z: released, p: false };
    [pivots.basis(), from_vertex].into_iter().find(|basis| {
        !basis.p && basis.z == basis.active && is_answer(&contact.lcp, basis) && is_at(contact, basis, last)
    })
}

/// Whether it is an answer that no path starts from, for no scheme has it as its vertex.
pub(super) fn is_off_paths(solved: &Solved) -> bool {
    solved.answer.is_answer() && final_basis(solved).is_none()
}

/// Whether the vertex of the scheme is this point (where there are several answers it may be another one).
fn is_at(contact: &ContactLcp, basis: &Basis, point: &Point) -> bool {
    let largest = point.z.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    vertex(&contact.lcp, basis)
        .is_some_and(|found| found.z.iter().zip(&point.z).all(|(a, b)| (a - b).abs() <= 1e-6 * largest))
}

/// A point of a path over the joints: t is not a covering, so nothing of it is added to the forces.
pub(crate) fn state_of(problem: &ContactProblem, contact: &ContactLcp, point: &Point) -> JointState {
    let point = Point { p: 0.0, ..point.clone() };
    joint_state(problem, contact, &point)
}
