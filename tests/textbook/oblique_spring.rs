//! A bar on two feet that one oblique spring holds beside them.
//!
//! ```text
//!                        ↑ P, → H
//!     a ═══════════════ b     a: foot and spring along d
//!    ▔▔▔▔               ▔▔▔▔   b: foot with friction f, weight W
//! ```
//! Spring and foot at a have no moment about a, whatever they carry. At b, (x, y) away from a, x (N − W + P) = y (T + H)
//! with N ≥ 0, |T| ≤ f N and f |y| < x: x N − y T ≥ 0, and 0 only where N = 0. So P is at most W + y H / x, at which b
//! lifts off and the bar turns about a. Nothing resists that motion, but places and the direction of the spring are
//! rounded numbers, and so is what they make of the rest at a.

use serde_json::{Value, json};
use stickslip::answer::record::Verdict;
use stickslip::path::limit::limit;
use stickslip::path::stages::{Begin, HistoryEnd, follow_factors};

use crate::common::lines::{read, text};
use crate::common::*;

const WEIGHT: f64 = 3.1;
const PUSH: f64 = 0.37;

/// Places of a and b, direction of the spring.
const BARS: [[[f64; 2]; 3]; 5] = [
    [[0.1645, -0.01296], [2.946, 0.1447], [0.1124, -0.7651]],
    [[-0.1464, -0.06914], [2.765, 0.05648], [-0.0709, 1.594]],
    [[1000.3, 7.7], [1002.9, 7.61], [0.3, 0.7]],
    [[0.1, 0.2], [0.7, 0.3], [-0.9, 0.2]],
    [[-3.3, 0.7], [-1.1, 0.7], [1.0, 1e-9]],
];

fn bar(places: [[f64; 2]; 3]) -> Case {
    Case::json(raw(places))
}

fn raw([a, b, direction]: [[f64; 2]; 3]) -> Value {
    let foot = |node: &str, friction: f64, cohesion: f64| -> Value {
        json!({ "id": format!("foot-{node}"), "node": node, "against": "ground", "normal": [0, 1], "friction": friction, "cohesion": cohesion })
    };
    json!({
        "parameters": { "P": 1.0 },
        "materials": { "m": { "E": 3e7, "nu": 0.2 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
        "nodes": { "a": a, "b": b },
        "bars": [{ "id": "bar", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 2 }],
        "contacts": [foot("a", 1.0, 0.15), foot("b", 0.2, 0.0)],
        "springs": [{ "at": "a", "direction": direction, "stiffness": 3e4 }],
        "loads": {
            "own": { "items": [
                { "point": { "at": "b", "force": [PUSH, -WEIGHT] } },
                { "point": { "at": "a", "force": [0, -2.0 * WEIGHT] } }
            ] },
            "lift": { "factor": "P", "items": [{ "point": { "at": "b", "force": [0, 1] } }] }
        }
    })
}

fn most([a, b, _]: [[f64; 2]; 3]) -> f64 {
    WEIGHT + (b[1] - a[1]) / (b[0] - a[0]) * PUSH
}

#[test]
fn a_bar_that_turns_about_the_anchor_of_its_spring_is_a_proved_collapse() {
    for places in BARS {
        let (case, most) = (bar(places), most(places));
        is_answer(&case.solve(&[("P", most * (1.0 - 1e-6))]));
        for beyond in [1.0 + 1e-6, 1.1, 10.0] {
            let answer = case.solve(&[("P", most * beyond)]);
            assert_eq!(mechanism(&answer).verdict, Some(Verdict::Certified), "{places:?} {beyond}: {:?}", answer.ray);
        }
        let values = case.scenario.parameter_values();
        let case_at = case.prepared.case(&case.scenario, &values);
        let solved = case.solved(&[], case.scenario.rules);
        let found = limit(case_at, Some(&solved), "lift").expect("a limit");
        close("limit", found.factor.expect("a limit"), most, 1e-9);
        assert_eq!(found.collapse().expect("a collapse").verdict, Some(Verdict::Certified), "{places:?}");
    }
}

/// On the way to twice the weight, from the weight alone, and from a lift that the bar has carried before.
#[test]
fn a_history_ends_at_the_proved_limit() {
    for places in BARS {
        let (case, most) = (bar(places), most(places));
        let values = case.scenario.parameter_values();
        let targets: Vec<Vec<f64>> = [0.0, 0.5, 0.1, 2.0 * WEIGHT].iter().map(|lift| vec![1.0, *lift]).collect();
        let case = case.prepared.case(&case.scenario, &values);
        let found = follow_factors(case, &Begin::Unloaded, &targets).expect("a history");
        let HistoryEnd::Limit { stage, t, collapse } = &found.end else { panic!("{places:?}: {:?}", found.end) };
        assert_eq!((*stage, collapse.verdict), (3, Some(Verdict::Certified)), "{places:?}: {collapse:?}");
        close("limit", 0.1 + t * (2.0 * WEIGHT - 0.1), most, 1e-9);
    }
}

/// Blocks on one another, the middle one between smooth faces: whatever pushes it along them, however little, is not
/// carried, since contact has no force along smooth faces. Just beyond the start of the push the push is one part in 1e8
/// of the weights.
#[test]
fn a_push_between_smooth_faces_is_proved_to_be_too_much_from_its_start() {
    let block = |id: &str, x: f64, y: f64, width: f64| -> Value {
        json!({ "id": id, "origin": [x, y], "size": [width, 0.4], "divisions": [3, 1], "thickness": 1,
            "material": "m", "plane": "strain" })
    };
    let case = Case::json(json!({
        "parameters": { "P": 1.0 },
        "materials": { "m": { "E": 1e4, "nu": 0.2, "density": 2 } },
        "plates": [block("b0", 0.0, 0.0, 0.86), block("b1", -0.0079, 0.4, 0.7), block("b2", -0.1672, 0.8, 1.01)],
        "contacts": [
            { "id": "j0", "edge": "b0.bottom", "against": "ground", "friction": 0.2 },
            { "id": "j1", "edge": "b1.bottom", "against": "b0.top", "friction": 0 },
            { "id": "j2", "edge": "b2.bottom", "against": "b1.top", "friction": 0 }
        ],
        "springs": [{ "at": "b2.top", "direction": [1, -0.1935], "stiffness": 10 }],
        "loads": {
            "own": { "items": [{ "gravity": { "acceleration": [0, -10] } }] },
            "push": { "factor": "P", "items": [{ "point": { "at": "b1.right", "force": [0.05, 0] } }] }
        }
    }));
    let values = case.scenario.parameter_values();
    let targets = [vec![1.0, 0.0], vec![1.0, 1.0]];
    let found = follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &targets);
    let end = found.expect("a history").end;
    let HistoryEnd::Limit { stage: 1, t, collapse } = &end else { panic!("{end:?}") };
    assert_eq!((*t, collapse.verdict), (0.0, Some(Verdict::Certified)), "{collapse:?}");
}

/// Every working scheme goes to show it too: with b open, no numbers of the stiffness resist the rotation, and no answer of
/// 1e28 m is left of their rounding. The proof that is written for others is found in these numbers.
#[test]
fn no_scheme_is_an_answer_by_rounding() {
    for places in BARS {
        let mut session = read(&scenario_text(raw(places)));
        text(&mut session, &format!("set P {}", most(places) * 1.5));
        let found = text(&mut session, "enumerate");
        assert!(found.starts_with("no answer: proved"), "{places:?}: {found}");
        let folder = tempfile::tempdir().expect("a folder");
        let proved = text(&mut session, &format!("prove {}", folder.path().join("proof.json").display()));
        assert!(proved.starts_with("Proved: no contact forces balance the loads"), "{places:?}: {proved}");
    }
}
