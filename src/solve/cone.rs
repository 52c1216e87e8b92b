//! From the answer on the friction polygon to that on Coulomb's cone (method §7).

use super::error::SolveError;
use super::prepared::Prepared;
use super::state::Solved;
use crate::answer::check::check_contact;
use crate::answer::pairs::JointState;
use crate::answer::record::{Check, OutcomeKind, PolygonRecord};
use crate::contact::cone::ConeFailure;
use crate::contact::on_cone::{OnCone, with_repeated_joints};
use crate::contact::problem::ContactProblem;
use crate::contact::sum::Sum;
use crate::explain::certificate::certify;
use crate::explain::misfit::misfit;
use crate::explain::motions::FreeMotions;
use crate::explain::ray::RayReport;
use crate::model::rules::Covering;
use crate::watch::Watch;

/// An answer in space: on the cone, or on the polygon where that was asked for or where the cone was not reached.
pub(super) struct InSpace {
    pub(super) state: JointState,
    /// The problem that the state answers: friction is the polygon's where the cone was not reached.
    pub(super) problem: ContactProblem,
    pub(super) record: PolygonRecord,
    /// What is to be said of an answer that is not on the cone.
    pub(super) note: Option<String>,
}

/// Takes the answer of the polygon to the cone.
///
/// # Errors
/// Stopped from outside.
pub(super) fn taken(problem: &ContactProblem, polygon: JointState, watch: &dyn Watch) -> Result<InSpace, SolveError> {
    let mut record = PolygonRecord::of(problem.polygon);
    let polygon = with_repeated(problem, polygon, watch)?;
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
            // where nothing slips, what the polygon's slips differ by is rounding
            let slips =
                problem.system.pairs.iter().any(|pair| pair.tangential.clone().any(|joint| found.z[joint] != 0.0));
            record.distance = slips.then_some(found.distance);
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

/// The answer on a polygon that is solved for its own sake, its joints that repeat one another as they are and not as
/// they yield; in the plane the answer where rounding spoiled what the pivots say of such joints.
pub(super) fn with_repeated(
    problem: &ContactProblem,
    state: JointState,
    watch: &dyn Watch,
) -> Result<JointState, SolveError> {
    let spoiled = match problem.system.yielding {
        Some(_) => !problem.cone,
        None => problem.system.force_form.is_some() && !check_contact(problem, &state, None).passed,
    };
    if !spoiled {
        return Ok(state);
    }
    let forces: Vec<Sum> = (0..state.z.len()).map(|joint| state.sum(joint)).collect();
    match with_repeated_joints(problem, (&state.z, &forces), watch) {
        Ok(found) => Ok(found.map_or(state, |found| JointState::of_mixed(problem, found))),
        Err(_) => Err(SolveError::Interrupted),
    }
}

impl Prepared {
    /// Whether it is proved that the cone has no answer where the polygon has one: then the result is that collapse.
    pub(super) fn collapses_on_cone(&self, solved: &mut Solved, problem: &ContactProblem, covering: Covering) -> bool {
        let facets = problem.polygon.facets();
        let motions = FreeMotions::new(&problem.system, self.built());
        let (report, why) = match certify(problem, &motions).certificate {
            Some(certificate) => (
                RayReport::of_certificate(problem, certificate),
                format!("those of the polygon of {facets} facets, which has an answer; Coulomb's cone has none"),
            ),
            None => match misfit(problem) {
                Some(misfit) => (
                    RayReport::of_misfit(problem, misfit),
                    "those that joints which repeat one another would have if they yielded".to_owned(),
                ),
                None => return false,
            },
        };
        let answer = &mut solved.answer;
        answer.outcome = OutcomeKind::Ray;
        answer.marginal = false;
        answer.ray = Some(report.record(&problem.system, covering));
        answer.check = Check::default();
        (answer.displacements, answer.members, answer.reactions) = (None, None, None);
        answer.notes = vec![format!("the states of the pairs are {why}")];
        answer.failure = None;
        if let Some(last) = answer.attempts.last_mut() {
            last.outcome = OutcomeKind::Ray;
            last.why = Some(match report.misfit {
                Some(_) => "an answer if joints yielded that repeat one another, parts that do not fit".to_owned(),
                None => "an answer on the polygon, a certified collapse on the cone".to_owned(),
            });
        }
        (solved.ray, solved.rest, solved.warm) = (Some(Box::new(report)), None, None);
        true
    }
}

/// How far the corners of the polygon lie outside of the circle, in percent.
fn excess(problem: &ContactProblem) -> f64 {
    100.0 * ((std::f64::consts::PI / problem.polygon.facets() as f64).cos().recip() - 1.0)
}
