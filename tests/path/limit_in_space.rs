//! Limits in space against their closed forms, on Coulomb's cone at every fineness of the polygon.

use serde_json::{Value, json};
use stickslip::answer::record::Verdict;
use stickslip::path::limit::{Limit, limit};

use crate::common::Case;

/// Feet of a rigid body: R = 0, whatever moves costs nothing. Each is pressed by `weight`, and pushed by 1 of the load `push`
/// along an angle of its own, in degrees.
fn feet(angles: &[f64], weight: f64, friction: f64, facets: usize) -> Case {
    let m = angles.len();
    let normal: Vec<f64> = (0..3 * m).map(|row| if row < m { weight } else { 0.0 }).collect();
    let along = |angle: &f64| [-angle.to_radians().cos(), -angle.to_radians().sin()];
    let push: Vec<f64> = std::iter::repeat_n(0.0, m).chain(angles.iter().flat_map(along)).collect();
    Case::json(json!({
        "parameters": { "F": 0.1 },
        "solver": { "facets": facets },
        "contact_system": {
            "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "tangents": 2,
            "stiffness": vec![vec![0.0; 3 * m]; 3 * m], "friction": vec![friction; m],
            "loads": { "weight": { "vector": normal }, "push": { "factor": "F", "vector": push } } } }))
}

fn found(case: &Case, name: &str) -> Limit {
    let values = case.scenario.parameter_values();
    let case = case.prepared.case(&case.scenario, &values).under(case.scenario.rules);
    limit(case, None, name).expect("a limit")
}

/// Pushed at any angle each foot holds f times its weight: the limit of the cone, whatever the polygon allows between its
/// facets.
#[test]
fn a_push_at_any_angle_ends_at_its_friction() {
    for (angle, facets) in [(0.0, 8), (17.0, 8), (17.0, 4), (45.0, 6), (211.0, 16)] {
        let limit = found(&feet(&[angle; 4], 2.0, 0.3, facets), "F");
        let factor = limit.factor.unwrap_or_else(|| panic!("{angle} {facets}: {}", limit.end_sentence()));
        assert!((factor - 0.6).abs() <= 1e-7, "{angle} {facets}: {factor}");
        assert!(limit.confirmed && (limit.safety.expect("safety") - 6.0).abs() < 1e-6);
        let collapse = limit.collapse.as_ref().expect("a collapse");
        assert_eq!(collapse.verdict, Some(Verdict::Certified));
        // Feet that slip do not open, though the motion of the proof parts them.
        let towards = if angle > 180.0 { angle - 360.0 } else { angle };
        let mode = &collapse.mode;
        assert!(mode.contains(&format!("towards {towards}°")) && !mode.contains("open"), "{angle} {facets}: {mode}");
        let [answer, none] = limit.bracket.expect("a bracket");
        assert!(answer < 0.6 * (1.0 + 1e-12) && none > 0.6 * (1.0 - 1e-12), "{answer} {none}");
    }
}

/// The loads of a load case without a parameter, feet pushed each its own way: the first foot that slips is not the limit of
/// a rigid body, but here each moves alone.
#[test]
fn a_load_case_is_named_as_well_as_a_parameter() {
    let limit = found(&feet(&[10.0, 130.0, 250.0], 1.0, 0.5, 8), "push");
    assert!((limit.factor.expect("a limit") - 0.5).abs() <= 1e-7, "{}", limit.end_sentence());
}

/// On its own springs each foot slips and stands.
#[test]
fn what_stands_without_friction_has_no_limit() {
    let mut stiffness = vec![vec![0.0; 3]; 3];
    (0..3).for_each(|row| stiffness[row][row] = 2.0);
    let case: Value = json!({ "parameters": { "F": 1.0 }, "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": stiffness, "friction": [0.2],
        "loads": { "weight": { "vector": [1, 0, 0] }, "push": { "factor": "F", "vector": [0, -0.6, -0.8] } } } });
    let limit = found(&Case::json(case), "F");
    assert!(limit.factor.is_none() && limit.bracket.is_none() && limit.last > 1e8, "{}", limit.end_sentence());
    assert!(limit.end_sentence().contains("no collapse was found"), "{}", limit.end_sentence());
}
