//! Limits in space against their closed forms, on Coulomb's cone at every fineness of the polygon.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, Verdict};
use stickslip::path::edge::{Which, edge};
use stickslip::path::limit::{Limit, limit};

use crate::common::lines::{read, text};
use crate::common::{Case, scenario_text};

/// Feet of a rigid body: R = 0, whatever moves costs nothing. Each is pressed by `weight`, and pushed by 1 of the
/// load `push` along an angle of its own, in degrees.
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

/// Pushed at any angle each foot holds f times its weight: the limit of the cone, whatever the polygon allows between
/// its facets.
#[test]
fn a_push_at_any_angle_ends_at_its_friction() {
    for (angle, facets) in [(0.0, 8), (17.0, 8), (17.0, 4), (45.0, 6), (211.0, 16)] {
        let limit = found(&feet(&[angle; 4], 2.0, 0.3, facets), "F");
        let factor = limit.factor.unwrap_or_else(|| panic!("{angle} {facets}: {}", limit.end_sentence()));
        assert!((factor - 0.6).abs() <= 1e-7, "{angle} {facets}: {factor}");
        assert!(limit.confirmed && (limit.safety.expect("safety") - 6.0).abs() < 1e-6);
        let collapse = limit.collapse().expect("a collapse");
        assert_eq!(collapse.verdict, Some(Verdict::Certified));
        // Feet that slip do not open, though the motion of the proof parts them.
        let towards = if angle > 180.0 { angle - 360.0 } else { angle };
        let mode = &collapse.mode;
        assert!(mode.contains(&format!("towards {towards}°")) && !mode.contains("open"), "{angle} {facets}: {mode}");
        let [answer, none] = limit.bracket.expect("a bracket");
        assert!(answer < 0.6 * (1.0 + 1e-12) && none > 0.6 * (1.0 - 1e-12), "{answer} {none}");
    }
}

/// The loads of a load case without a parameter, feet pushed each its own way: the first foot that slips is not the
/// limit of a rigid body, but here each moves alone.
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

/// A beam of two equal spans on three feet, each at the end of a rigid arm h below its axis, slides along its axis: the
/// friction fᵢ Nᵢ of each foot turns the beam by h fᵢ Nᵢ there, and the forces Nᵢ follow from that turning, from w per
/// length and from the beam that stays straight over the middle foot:
///
/// ```text
/// l (N_a − N_c) = −2 h Σ fᵢ Nᵢ,   N_b l³/48 = 5 w l⁴/384 + (h f N_a − h f N_c) l²/16,   N_a + N_b + N_c = w l
/// ```
///
/// With f at the ends and f_b in the middle, k = (h/l)²: N_b = w l (5/8 − 6 k f²)/(1 + 6 k f (f_b − f)). Forces that only
/// balance may load the middle foot more, up to N_a = 0 and H = f N_c + f_b N_b, l N_c = 2 h H: nothing is proved before
/// H (1 + 2 (f_b − f) h/l) = f_b w l, some 4/3 of that. In between the friction polygon holds some pushes.
struct Beam {
    scenario: Value,
    /// The push at which it slides, and beyond which nothing balances it.
    slides: f64,
    balanced: f64,
}

fn beam_on_three_feet() -> Beam {
    let (w, l, h, [f, f_b]) = (4.0, 4.0, 0.3, [0.1, 0.5]);
    let k = (h / l) * (h / l);
    let middle = w * l * (0.625 - 6.0 * k * f * f) / (1.0 + 6.0 * k * f * (f_b - f));
    let slides = f * w * l + (f_b - f) * middle;
    let balanced = f_b * w * l / (1.0 + 2.0 * (f_b - f) * h / l);
    let foot = |at: &str, friction: f64| {
        json!({ "id": format!("c-{at}"), "node": format!("foot-{at}"), "against": "ground", "normal": [0, 0, 1],
            "friction": friction })
    };
    // From 2 the search over ever larger loads meets a proof at once.
    let scenario = json!({
        "dimension": 3,
        "parameters": { "H": 2 },
        "materials": { "m": { "E": 1, "nu": 0 } },
        "sections": { "s": { "area": 1e4, "inertia_y": 1e3, "inertia_z": 1e3, "torsion": 1e3 } },
        "nodes": { "a": [-l / 2.0, 0, 0], "b": [0, 0, 0], "c": [l / 2.0, 0, 0],
            "foot-a": [-l / 2.0, 0, -h], "foot-b": [0, 0, -h], "foot-c": [l / 2.0, 0, -h] },
        "bars": [{ "id": "beam", "polyline": ["a", "b", "c"], "material": "m", "section": "s" }],
        "rigid": [{ "id": "arm-a", "nodes": ["a", "foot-a"] }, { "id": "arm-b", "nodes": ["b", "foot-b"] },
            { "id": "arm-c", "nodes": ["c", "foot-c"] }],
        "supports": [{ "at": "b", "fixed": ["rx"] }],
        "contacts": [foot("a", f), foot("b", f_b), foot("c", f)],
        "loads": {
            "weight": { "items": [{ "line": { "bar": "beam", "value": [0, 0, -w] } }] },
            "push": { "factor": "H", "items": [{ "point": { "at": "b", "force": [1, 0, 0] } }] }
        }
    });
    Beam { scenario, slides, balanced }
}

#[test]
fn answers_end_before_the_proofs_begin() {
    let Beam { scenario, slides, balanced } = beam_on_three_feet();
    let case = Case::json(scenario);
    let limit = found(&case, "H");
    let factor = limit.factor.unwrap_or_else(|| panic!("{}", limit.end_sentence()));
    assert!((factor / slides - 1.0).abs() < 1e-7, "{factor} {slides}");
    let proof = limit.proof.expect("a proof beyond");
    assert!(!limit.confirmed && balanced > 1.3 * slides, "{balanced} {slides}");
    assert!(proof > balanced && proof < balanced * (1.0 + 2e-4), "{proof} {balanced}");
    for said in [limit.end_sentence(), limit.confirmation()] {
        assert!(said.contains("friction polygon only") && said.contains("prove that there is none"), "{said}");
    }
}

/// Between the last answer on the cone and the first proof the friction polygon has answers: each command says whose they are.
#[test]
fn an_answer_of_the_polygon_is_called_so() {
    let Beam { scenario, slides, .. } = beam_on_three_feet();
    let case = Case::json(scenario.clone());
    let values = case.scenario.parameter_values();
    let solver = case.prepared.case(&case.scenario, &values).under(case.scenario.rules);
    let edge = edge(solver, "H", [0.0, 20.0], Which::Most).expect("an edge");
    assert!((edge.value / slides - 1.0).abs() < 1e-7, "{} {slides}", edge.value);
    assert!(edge.undecided.is_some() && edge.collapse.is_some_and(|run| run.is_proved()));
    let mut session = read(&scenario_text(scenario));
    text(&mut session, &format!("set H {}", slides * (1.0 + 1e-6)));
    assert!(text(&mut session, "status").contains("normal (on the polygon)"));
    assert!(text(&mut session, "trace H").contains("no answer on Coulomb's cone was found at the present load"));
}

/// A load of zeros has no limit, however far it is looked for.
#[test]
fn a_load_that_does_not_act_has_no_limit() {
    let case: Value = json!({ "parameters": { "F": 1.0 }, "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": vec![vec![0.0; 3]; 3], "friction": [0.2],
        "loads": { "weight": { "vector": [1, 0, 0] }, "idle": { "factor": "F", "vector": [0, 0, 0] } } } });
    let case = Case::json(case);
    let values = case.scenario.parameter_values();
    for name in ["idle", "F"] {
        let error = limit(case.prepared.case(&case.scenario, &values), None, name).expect_err("no limit");
        assert_eq!(error.brief(), "acts on no contact pair", "{error}");
    }
}

/// Below its limit a load has an answer that passed its check on the cone, beyond it a collapse that is certified.
fn sharp(case: &Case, limit: f64, what: &str) {
    let at = |share: f64| -> Answer { case.solve(&[("P", share * limit)]) };
    let below = at(1.0 - 1e-6);
    let on_cone = below.polygon.is_some_and(|polygon| polygon.cone);
    assert!(below.is_answer() && below.check.passed && on_cone, "{what}, below: {:?}", below.outcome);
    let beyond = at(1.0 + 1e-5).ray.unwrap_or_else(|| panic!("{what}: an answer beyond"));
    assert_eq!(beyond.verdict, Some(Verdict::Certified), "{what}, beyond");
}

/// A block of bricks of weight W is pushed by P at an angle: at its base it slides at P = f W, at the height h of its
/// top it overturns over the edge that it comes to first, at P = W/(2 h) · min(a/|cos|, b/|sin|). Near to sliding all
/// of it has slipped far, each foot almost the same way.
#[test]
fn a_block_of_bricks_is_sharp_at_its_limit_at_every_angle() {
    let sharp_block = |size: [f64; 3], divisions: [u32; 3], angle: f64, friction: f64| {
        let [a, b, h] = size;
        let (sin, cos) = angle.sin_cos();
        let weight = 25.0 * a * b * h;
        let block = |friction: f64, face: &str| {
            Case::json(json!({
                "dimension": 3,
                "parameters": { "P": 1 },
                "materials": { "m": { "E": 3e7, "nu": 0.2, "density": 25 } },
                "bricks": [{ "id": "b", "origin": [0, 0, 0], "size": size, "divisions": divisions, "material": "m" }],
                "contacts": [{ "id": "g", "face": "b.bottom", "against": "ground", "friction": friction }],
                "loads": {
                    "w": { "items": [{ "gravity": { "acceleration": [0, 0, -1] } }] },
                    "p": { "factor": "P", "items": [{ "point": { "at": format!("b.{face}"), "force": [cos, sin, 0] } }] }
                }
            }))
        };
        let what = format!("{size:?} at {angle}, f = {friction}");
        sharp(&block(friction, "bottom"), friction * weight, &what);
        let overturns = 0.5 * weight / h * (a / cos.abs()).min(b / sin.abs());
        sharp(&block(2.0 * overturns / weight + 1.0, "top"), overturns, &what);
    };
    // Where friction couples with the pressure most, the search for the answer has the longest way.
    for (size, divisions, angle, friction) in
        [([1.852, 0.546, 0.271], [1, 2, 1], 1.6734, 1.623), ([0.85, 0.785, 0.218], [2, 1, 2], 5.8393, 1.834)]
    {
        sharp_block(size, divisions, angle, friction);
    }
    let mut random = ChaCha8Rng::seed_from_u64(41);
    for _ in 0..12 {
        let size = [0.5, 0.5, 0.2].map(|least| random.random_range(least..2.0));
        let divisions = [(); 3].map(|()| random.random_range(1..3));
        sharp_block(size, divisions, random.random_range(0.0..TAU), random.random_range(0.1..2.0));
    }
}

/// Feet of a rigid body at 200 angles.
#[test]
fn feet_are_sharp_at_their_limit_at_every_angle() {
    let mut random = ChaCha8Rng::seed_from_u64(43);
    for _ in 0..200 {
        let (angle, friction) = (random.random_range(0.0..360.0), random.random_range(0.1..2.0));
        let weight = random.random_range(0.5..20.0);
        let facets = 2 * random.random_range(2..9);
        let case = feet(&[angle], weight, friction, facets);
        let at = |share: f64| case.solve(&[("F", share * friction * weight)]);
        assert!(at(1.0 - 1e-6).is_answer(), "{angle} {friction}");
        let beyond = at(1.0 + 1e-5).ray.unwrap_or_else(|| panic!("{angle} {friction}: an answer beyond"));
        assert_eq!(beyond.verdict, Some(Verdict::Certified), "{angle} {friction}");
    }
}

/// Pressed by W = 2 against a spring along the normal and free to slide, a foot slips away beyond f W in every
/// direction. What slips parts no pair, and by statics alone the spring might press it by any force; but no slip is
/// felt along the normal. That is said of this load: another may press harder.
#[test]
fn what_a_spring_presses_slides_away_at_the_friction_of_its_load() {
    let case: Value = json!({ "parameters": { "F": 0.1 }, "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": [[3, 0, 0], [0, 0, 0], [0, 0, 0]], "friction": [0.5],
        "loads": { "weight": { "vector": [2, 0, 0] }, "push": { "factor": "F", "vector": [0, -0.6, -0.8] } } } });
    let case = Case::json(case);
    let limit = found(&case, "F");
    assert!((limit.factor.expect("a limit") - 1.0).abs() <= 1e-8 && limit.confirmed, "{}", limit.end_sentence());
    let beyond = case.solve(&[("F", 1.0 + 1e-5)]).ray.expect("a collapse");
    assert_eq!(beyond.verdict, Some(Verdict::Certified));
    assert!(beyond.explanation.contains("no slip is felt along the normals"), "{}", beyond.explanation);
    assert!(limit.beyond_sentence().is_some_and(|words| words.contains("not proved")), "{:?}", limit.beyond_sentence());
}

/// Where slips press the pair, nothing is known of its force beforehand, and nothing is claimed: R has z_t2 in its
/// kernel, and along t1 it couples with the normal.
#[test]
fn what_slips_press_is_not_certified_by_the_load() {
    let case: Value = json!({ "parameters": { "F": 2.0 }, "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": [[1, 0.5, 0], [0.5, 1, 0], [0, 0, 0]], "friction": [0.5],
        "loads": { "weight": { "vector": [2, 0, 0] }, "push": { "factor": "F", "vector": [0, 0, -1] } } } });
    let ray = Case::json(case).solve(&[]).ray.expect("no answer");
    assert_eq!(ray.verdict, Some(Verdict::Undecided));
}
