//! From the answer on the friction polygon to that on Coulomb's cone (method §7).

use super::error::SolveError;
use crate::answer::pairs::JointState;
use crate::answer::record::PolygonRecord;
use crate::contact::cone::ConeFailure;
use crate::contact::on_cone::OnCone;
use crate::contact::problem::ContactProblem;
use crate::watch::Watch;

/// An answer in space: on the cone, or on the polygon where that was asked for or where the cone was not reached.
pub(super) struct InSpace {
    pub(super) state: JointState,
    /// The problem that the state answers: friction is the polygon's where the cone was not reached.
    pub(super) problem: ContactProblem,
    pub(super) record: PolygonRecord,
    /// What is to be said of an answer that is none on the cone.
    pub(super) note: Option<String>,
}

/// Takes the answer of the polygon to the cone.
///
/// # Errors
/// Stopped from outside.
pub(super) fn taken(problem: &ContactProblem, polygon: JointState, watch: &dyn Watch) -> Result<InSpace, SolveError> {
    let mut record = PolygonRecord::of(problem.polygon);
    let own = |record, note| InSpace {
        state: polygon.clone(),
        problem: ContactProblem { cone: false, ..problem.clone() },
        record,
        note,
    };
    let circle = format!("a friction force can exceed its bound by up to {:.1} % between two facets", excess(problem));
    if !problem.cone {
        let facets = problem.polygon.facets();
        return Ok(own(
            record,
            Some(format!("this is the answer on the polygon of {facets} facets, not on the cone: {circle}")),
        ));
    }
    match OnCone::new(problem).answer(&polygon.z, watch) {
        Ok(found) => {
            record.cone = true;
            record.newton = Some(found.steps);
            record.distance = Some(found.distance);
            Ok(InSpace { state: JointState::on_cone(problem, found), problem: problem.clone(), record, note: None })
        }
        Err(ConeFailure::Stopped) => Err(SolveError::Interrupted),
        Err(failure) => {
            let facets = problem.polygon.facets();
            let note = format!("{failure}; this is the answer on the polygon of {facets} facets: {circle}");
            Ok(own(record, Some(note)))
        }
    }
}

/// How far the corners of the polygon lie outside of the circle, in percent.
fn excess(problem: &ContactProblem) -> f64 {
    100.0 * ((std::f64::consts::PI / problem.polygon.facets() as f64).cos().recip() - 1.0)
}
