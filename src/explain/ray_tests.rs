//! What a ray is told as: artefacts in the words of their dimension, and the motion of a proof where no pair moves.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::*;
use crate::contact::full_lcp::tests::{coulomb, coulomb_in_space};
use crate::contact::law::PairLaw;

/// In space a pair has more than two reserves and no z+ and z-.
#[test]
fn an_artefact_is_told_in_the_words_of_its_dimension() {
    for (system, slips) in [
        (coulomb(DMatrix::identity(2, 2)), "slip in both directions"),
        (coulomb_in_space(DMatrix::identity(3, 3)), "slip along all of these facets"),
    ] {
        let none = DVector::zeros(system.joint_count());
        let report = RayReport { artefact: Some(0), ..RayReport::of_motion(RayClass::Artefact, none) };
        for covering in [Covering::Ones, Covering::Weight] {
            let ray = report.record(&system, covering);
            assert!(ray.explanation.contains(slips), "{}", ray.explanation);
            for word in ["z+ and z-", "both", "two"] {
                let of_plane = [&ray.mode, &ray.explanation].iter().any(|text| text.contains(word));
                assert!(!of_plane || system.tangents == 1, "{}: {}", ray.mode, ray.explanation);
            }
        }
    }
}

/// A loose foot pressed by 2 on f = 0.5 is pushed towards 30° by `push`: it holds up to 1. Just beyond that a run may end in
/// slips that cancel; the collapse is then the slip that the proof tells, without the opening that it needs.
#[test]
fn slips_that_cancel_leave_the_motion_of_the_proof() {
    let mut system = coulomb_in_space(DMatrix::zeros(3, 3));
    system.kernel = DMatrix::identity(3, 3);
    let system = Arc::new(system);
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let ended = |push: f64| {
        let load = DVector::from_vec(vec![2.0, -push * cos, -push * sin]);
        let problem = ContactProblem::exactly(&system, vec![PairLaw::rubbing(0.5, 0.0, 0.0)], load);
        let mut report = RayReport::of_motion(RayClass::NoEquilibrium, DVector::zeros(3));
        let certified = certify_ray(&mut report, &problem, None);
        (certified, report)
    };
    let (certified, report) = ended(1.0 + 1e-6);
    assert!(certified && report.of_proof && report.class == RayClass::Mechanism);
    let [open, along, across] = report.direction.as_slice() else { panic!("three joints") };
    // push·cos(δ) > 1 is what a proof by a slip δ away from the push needs
    let most = f64::acos(1.0 / (1.0 + 1e-6));
    assert!(*open == 0.0 && (across.atan2(*along) - 30_f64.to_radians()).abs() < most, "{}", report.direction);
    let ray = report.record(&system, Covering::default());
    assert_eq!(ray.mode, "pair c1 slips towards 30°");
    assert!(ray.explanation.starts_with("The run ended in slips that cancel"), "{}", ray.explanation);
    let (certified, report) = ended(1.0 - 1e-6);
    assert!(!certified && !report.of_proof && report.class == RayClass::NoEquilibrium);
}
