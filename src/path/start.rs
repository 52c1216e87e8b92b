//! Where a path starts, and the LCP it runs in: loads of a contact problem as base + t · increment.

use std::sync::Arc;

use nalgebra::DVector;

use crate::answer::pairs::{JointState, joint_state};
use crate::contact::complementarity::{ContactLcp, contact_lcp, load_with_gaps};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point, RayDirection};
use crate::lcp::ratio_test::TieRule;
use crate::lcp::vertex::{Basis, vertex};
use crate::model::pair::Law;
use crate::model::rules::{Covering, TieBreak};
use crate::solve::attempt::run_scheme;
use crate::solve::{Solved, solved::Trace};
use crate::watch::Watch;

/// No path makes more pivots than this.
pub const PIVOTS: usize = 100_000;

/// Why a path cannot be followed. Its own end (turning point, limit) is no error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// A bare LCP.
    #[error("a bare LCP has no loads and no friction: `{0}` needs contact pairs")]
    Plain(&'static str),
    /// Neither a load case nor a parameter that can be followed.
    #[error("nothing to follow: `{name}` is no load case and no parameter of one; there are {known}")]
    Unknown {
        /// As given.
        name: String,
        /// What there is.
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
    /// A target that cannot be.
    #[error("{0}")]
    Target(String),
    /// The case does not act on any pair.
    #[error("load case {0} presses and pushes no contact pair: the state of the pairs does not depend on it")]
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

/// An answer found without a path.
#[derive(Clone, Debug)]
pub(crate) struct Cold {
    pub(crate) contact: ContactLcp,
    /// `None` where the run ended in no answer.
    pub(crate) basis: Option<Basis>,
    pub(crate) point: Point,
    pub(crate) outcome: Outcome,
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
            Outcome::PivotLimit | Outcome::Cycle => "at the limit of pivots",
            Outcome::Breakdown(_) | Outcome::Interrupted => "in a breakdown",
        }
    }
}

/// Solves under the default rules.
pub(crate) fn cold(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    watch: &dyn Watch,
) -> Result<Cold, PathError> {
    // The default covering fits all numbers.
    let contact = contact_lcp(system, numbers, Covering::Cohesive)
        .map_err(|error| PathError::Target(error.to_string()))?;
    let run = run_scheme(
        &contact.lcp,
        contact.tie_rule(TieBreak::Lexicographic),
        watch,
    );
    let basis = match run.outcome {
        Outcome::Interrupted => return Err(PathError::Interrupted),
        Outcome::Trivial | Outcome::Normal { marginal: false } => Some(Basis::after(&run.pivots)),
        _ => None,
    };
    Ok(Cold {
        contact,
        basis,
        point: run.point,
        outcome: run.outcome,
    })
}

/// The final scheme of a solved state; `None` where it is no answer, or one that only just is (marginal).
pub fn final_basis(solved: &Solved) -> Option<Basis> {
    match &solved.trace {
        Trace::Contact { pivots, .. } if solved.answer.is_answer() && !solved.answer.marginal => {
            let basis = Basis::after(pivots);
            (!basis.p && basis.z == basis.active).then_some(basis)
        }
        _ => None,
    }
}

/// Whether all variables of `basis` are ≥ 0 (up to rounding) in this LCP.
pub(crate) fn is_answer(lcp: &MirroredLcp, basis: &Basis) -> bool {
    let Some(point) = vertex(lcp, basis) else {
        return false;
    };
    let force = lcp.q.amax().max(point.w.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    let length = point.z.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    point.w.iter().all(|w| *w >= -1e-11 * force) && point.z.iter().all(|z| *z >= -1e-11 * length)
}

/// The dimensionless LCP of base + t · increment: q is that of `numbers`, the covering that of the increment of the
/// load (t in the user's units of the increment's factor).
pub(crate) fn path_lcp(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    increment: &DVector<f64>,
) -> ContactLcp {
    let mut reference = numbers.clone();
    if load_with_gaps(system, numbers).amax() == 0.0 {
        reference.load = increment.clone();
    }
    // `ones` covers everything; only the matrix, the units and the rows are taken from it.
    let mut contact = match contact_lcp(system, &reference, Covering::Ones) {
        Ok(contact) => contact,
        Err(_) => unreachable!("covering ones fits all numbers"),
    };
    let unit = contact.force_unit;
    let load = load_with_gaps(system, numbers);
    let mut lcp = MirroredLcp::clone(&contact.lcp);
    for (i, pair) in system.pairs.iter().enumerate() {
        if let Some(row) = contact.normal_row[i] {
            lcp.q[row] = load[i] / unit;
            lcp.covering[row] = increment[i] / unit;
        }
        if let (Some(row), Some(joint)) = (contact.plus_row[i], pair.tangential) {
            let f = numbers.friction[i];
            let extra = match pair.law {
                Law::Bound { .. } => numbers.bound[i],
                _ => numbers.cohesion[i],
            };
            lcp.q[row] = load[joint] / unit + f * (load[i] / unit) + extra / unit;
            lcp.covering[row] = increment[joint] / unit + f * (increment[i] / unit);
            if let Some(mirror) = &mut lcp.mirrors[row] {
                mirror.covering = 0.0;
            }
        }
    }
    contact.lcp = Arc::new(lcp);
    contact
}

/// The order of rows of the lexicographic rule.
pub(crate) fn order(contact: &ContactLcp) -> Vec<usize> {
    match contact.tie_rule(TieBreak::Lexicographic) {
        TieRule::Lexicographic(order) => order,
        // The rule asked for is this one.
        _ => (0..contact.rows.len()).collect(),
    }
}

/// A point of a path over the joints: t is no covering, so nothing of it is added to the forces.
pub(crate) fn state_of(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    contact: &ContactLcp,
    point: &Point,
) -> JointState {
    let point = Point {
        p: 0.0,
        ..point.clone()
    };
    joint_state(system, numbers, contact, &point)
}
