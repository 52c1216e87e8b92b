//! One solved state: its answer, and the numbers behind every working scheme on the way to it.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

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
    /// What is still to be worked out for an answer; see [`Solved::completed`].
    pub(super) rest: Option<Arc<Rest>>,
    /// The pivot that was looked at last: pairs and displacements there come from one state.
    pub(super) looked_at: LookedAt,
}

/// A pivot and the joints after it.
type AtPivot = (usize, Arc<JointState>);

/// The joints after one pivot of a run; shared by the copies of an answer.
#[derive(Clone, Debug, Default)]
pub(super) struct LookedAt(Arc<Mutex<Option<AtPivot>>>);

/// What displacements, members, reactions and the check of equilibrium follow from.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    /// The geometry that was solved.
    pub(super) prepared: Prepared,
    /// Its joints.
    pub(super) joints: JointState,
}

impl Solved {
    /// The pivots of the run.
    pub fn pivots(&self) -> &PivotLog {
        let (RunData::Contact { pivots, .. } | RunData::Plain { pivots, .. }) = &self.run;
        pivots
    }

    /// Rows of a bare LCP whose z is basic: those of the last basis; for an answer without pivots, those with z > 0.
    pub(super) fn basic_rows(&self, pivots: &PivotLog) -> Vec<usize> {
        match &self.answer.solution {
            Some(solution) if self.answer.rules.engine.is_without_pivots() => {
                solution.z.iter().enumerate().filter(|(_, z)| **z > 0.0).map(|(row, _)| row).collect()
            }
            _ => pivots.basis().z,
        }
    }

    /// Whether displacements, members, reactions and the check of equilibrium are there, as far as there are such.
    pub fn is_whole(&self) -> bool {
        self.rest.is_none()
    }

    /// The same with what was left for later; it ceases to be an answer where the check of equilibrium fails.
    pub fn completed(&self) -> Solved {
        let mut whole = Solved { rest: None, ..self.clone() };
        if let (Some(rest), RunData::Contact { problem, .. }) = (&self.rest, &self.run) {
            let start = Instant::now();
            rest.prepared.complete_rest(&mut whole.answer, problem, &rest.joints);
            whole.answer.timings.total += start.elapsed().as_secs_f64();
        }
        whole
    }

    /// Whether it is an answer, in space one on Coulomb's cone where that is asked for.
    pub fn stands(&self, cone: bool) -> bool {
        self.answer.is_answer() && (!cone || self.answer.polygon.is_none_or(|polygon| polygon.cone))
    }

    /// Factors of the load cases, without a unit; none of a bare LCP.
    pub fn factors(&self) -> &[f64] {
        match &self.run {
            RunData::Contact { problem, .. } => &problem.factors,
            RunData::Plain { .. } => &[],
        }
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
    fn state_at(&self, step: usize) -> Option<Arc<JointState>> {
        let mut kept = self.looked_at.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, state)) = kept.as_ref().filter(|(at, _)| *at == step) {
            return Some(Arc::clone(state));
        }
        let state = Arc::new(self.find_state_at(step)?);
        *kept = Some((step, Arc::clone(&state)));
        Some(state)
    }

    fn find_state_at(&self, step: usize) -> Option<JointState> {
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
        let u = main.displacements(&problem.factors, &problem.dislocation(&state.z));
        Some(NodeDisplacement::of_state(main, structure, &u))
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
