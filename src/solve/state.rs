//! One solved state: its answer, and the numbers behind every working scheme on the way to it.

use std::sync::Arc;

use super::finish::named;
use super::prepared::{Geometry, Prepared};
use super::warm::WarmSlot;
use crate::answer::pairs::{JointState, joint_state, pair_states};
use crate::answer::record::{Answer, NodeDisplacement, PairState, PlainSolution};
use crate::contact::problem::ContactProblem;
use crate::contact::written::ContactLcp;
use crate::explain::plain_ray::PlainRay;
use crate::explain::ray::RayReport;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::lcp::pivot::PivotLog;

/// The numbers behind an answer: what is needed to look at any pivot of its run.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one for each solved state, never in lists")]
pub enum RunData {
    /// Of a contact problem.
    Contact {
        /// The LCP.
        contact: ContactLcp,
        /// The problem.
        problem: ContactProblem,
        /// The pivots.
        pivots: PivotLog,
        /// The last vertex, dimensionless.
        last: Point,
    },
    /// Of a bare LCP.
    Plain {
        /// The LCP.
        lcp: Arc<MirroredLcp>,
        /// The pivots.
        pivots: PivotLog,
    },
}

/// An answer with the run behind it.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The answer as reported.
    pub answer: Answer,
    /// How it came about.
    pub run: RunData,
    /// What is known of the ray it ended in; contact problems only.
    pub ray: Option<Box<RayReport>>,
    /// The same for a bare LCP.
    pub plain_ray: Option<Box<PlainRay>>,
    /// What retries or a comparison with the default rules add to the explanation.
    pub(super) retry_note: String,
    /// Whether the run came back to a basis it had met.
    pub cycled: bool,
    /// The dictionary of the answer, for the next change; contact problems under the default engine only.
    pub(super) warm: Option<WarmSlot>,
}

impl Solved {
    /// The pivots of the run.
    pub fn pivots(&self) -> &PivotLog {
        let (RunData::Contact { pivots, .. } | RunData::Plain { pivots, .. }) = &self.run;
        pivots
    }

    /// Number of pivots.
    pub fn pivot_count(&self) -> usize {
        self.pivots().count()
    }

    /// p after pivot `step`, in the user's units; `None` beyond the last.
    pub fn p_at(&self, step: usize) -> Option<f64> {
        self.answer.pivots.get(step).map(|pivot| pivot.p)
    }

    /// The vertex after pivot `step` over the joints; `None` beyond the last and for a bare LCP.
    fn state_at(&self, step: usize) -> Option<JointState> {
        let RunData::Contact { contact, problem, pivots, last, .. } = &self.run else {
            return None;
        };
        let point = if step + 1 == pivots.count() {
            last.clone()
        } else {
            vertex(&contact.lcp, &Basis::after(pivots.recorded().get(..=step)?))?
        };
        Some(joint_state(problem, contact, &point))
    }

    /// The pairs after pivot `step`: the working scheme on the way, under its p.
    pub fn pairs_at(&self, prepared: &Prepared, step: usize) -> Option<Vec<PairState>> {
        let RunData::Contact { contact, problem, .. } = &self.run else {
            return None;
        };
        let state = self.state_at(step)?;
        let mut pairs = pair_states(problem, contact, &state);
        prepared.add_released_slips(&mut pairs, problem, &state.z);
        Some(pairs)
    }

    /// The displacements after pivot `step`; structures only.
    pub fn displacements_at(&self, prepared: &Prepared, step: usize) -> Option<Vec<NodeDisplacement>> {
        let (RunData::Contact { problem, .. }, Geometry::Structure { main, structure, .. }) =
            (&self.run, &*prepared.geometry)
        else {
            return None;
        };
        let state = self.state_at(step)?;
        Some(named(structure, &main.displacements(&problem.factors, &problem.dislocation(&state.z))))
    }

    /// z and w of a bare LCP after pivot `step`.
    pub fn plain_at(&self, step: usize) -> Option<PlainSolution> {
        let RunData::Plain { lcp, pivots } = &self.run else {
            return None;
        };
        let point = vertex(lcp, &Basis::after(pivots.recorded().get(..=step)?))?;
        Some(PlainSolution { z: point.z, w: point.w })
    }
}
