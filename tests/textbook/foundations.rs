//! Bars and edges on elastic foundations, bonded and tensionless.

use serde_json::{Value, json};
use stickslip::answer::record::State;

use crate::common::*;

/// A stiff bar of length 4 on a foundation k under a force F at its middle and a couple.
///
/// ```text
///                F ▼
///     ═══════════╪═══════════      v(x) = −F/(kL') + …
///     ⌇ ⌇ ⌇ ⌇ ⌇ ⌇ ⌇ ⌇ ⌇ ⌇ ⌇ ⌇
/// ```
fn rigid_bar(foundation: Value, force: [f64; 2], at: f64) -> Case {
    let mut foundation = foundation;
    foundation["id"] = "soil".into();
    foundation["on"] = "ab".into();
    foundation["stiffness"] = "k".into();
    Case::json(json!({
        "parameters": { "k": 50.0 },
        "materials": { "m": { "E": 1e9, "nu": 0.2 } },
        "sections": { "s": { "area": 1, "inertia": 1 } },
        "nodes": { "a": [0, 0], "b": [4, 0] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 16 }],
        "foundations": [foundation],
        "supports": [{ "at": "a", "fixed": ["x"] }],
        "loads": { "w": { "items": [{ "point": { "bar": "ab", "distance": at, "force": force } }] } }
    }))
}

/// Nodal springs k·h, half of it at the ends: their sum is kL, their second moment about the middle kL³/12 (1 + 2/n²)
/// for n elements (trapezoid rule). So v and the slope of a rigid bar are exact sums.
#[test]
fn a_rigid_bar_sinks_and_tilts() {
    let (k, l, n, f) = (50.0, 4.0, 16.0_f64, 3.0);
    let second = k * l * l * l / 12.0 * (1.0 + 2.0 / (n * n));
    for at in [2.0, 2.25, 2.5] {
        let arm = at - 2.0;
        for tensionless in [false, true] {
            let answer = rigid_bar(json!({ "tensionless": tensionless }), [0.0, -f], at).solve(&[]);
            is_answer(&answer);
            let v = |x: f64| -f / (k * l) - f * arm / second * (x - 2.0);
            for (node, x) in [("a", 0.0), ("b", 4.0), ("ab/8", 2.0)] {
                near("v", displacement(&answer, node)[1], v(x), 1e-6, f / (k * l));
            }
            if tensionless {
                let sum: f64 = answer.pairs.iter().map(|pair| pair.x_n).sum();
                near("sum", sum, f, 1e-9, f);
                close("x_n", answer.pairs[16].x_n, -k * l / n / 2.0 * v(4.0), 1e-5);
                assert!(answer.pairs.iter().all(|pair| pair.state == State::Closed));
                // What the pairs carry is not a reaction; the support along x has none.
                assert!(answer.reactions.as_ref().unwrap().iter().all(|r| r.fy == 0.0));
            } else {
                let sum: f64 = answer.reactions.as_ref().unwrap().iter().map(|r| r.fy).sum();
                near("sum", sum, f, 1e-9, f);
            }
        }
    }
}

/// Beyond the kern the far end lifts: contact on 3(L/2 − e) for continuous support; here node by node, so equilibrium
/// is what is asked: Σ x_n = F, Σ x_n x = F x_F, every closed spring at k h (−v), every open node above its ground.
#[test]
fn a_tensionless_foundation_lifts_off() {
    let (k, h, f, at) = (50.0, 0.25, 3.0, 3.4);
    let answer = rigid_bar(json!({ "tensionless": true }), [0.0, -f], at).solve(&[]);
    is_answer(&answer);
    let open = count(&answer, State::Open);
    // Continuous support would touch on the last 3·0.6 = 1.8.
    assert!((7..=10).contains(&open), "{open} open");
    let sum: f64 = answer.pairs.iter().map(|pair| pair.x_n).sum();
    let moment: f64 = answer.pairs.iter().map(|pair| pair.x_n * pair.position.unwrap()[0]).sum();
    near("sum", sum, f, 1e-9, f);
    near("moment", moment, f * at, 1e-9, f * at);
    let (a, b) = (displacement(&answer, "a")[1], displacement(&answer, "b")[1]);
    for pair in &answer.pairs {
        let x = pair.position.unwrap()[0];
        let v = a + (b - a) * x / 4.0;
        let share = if x == 0.0 || x == 4.0 { 0.5 } else { 1.0 };
        near("x_n", pair.x_n, k * h * share * (-v).max(0.0), 1e-5, f);
        near("z_n", pair.z_n, v.max(0.0), 1e-6, 1.0);
    }
}

/// Friction of a tensionless foundation: against the firm ground the bar stays up to f F; with a tangential stiffness
/// it first moves by H/(kt L) and slips beyond.
#[test]
fn friction_of_a_foundation() {
    for turn in [0.0_f64, 30.0, 90.0] {
        let (c, s) = (turn.to_radians().cos(), turn.to_radians().sin());
        let case = |tangential: Option<f64>| {
            let mut soil = json!({ "id": "soil", "on": "ab", "stiffness": 50, "tensionless": true, "friction": 0.5 });
            if let Some(tangential) = tangential {
                soil["tangential"] = tangential.into();
            }
            Case::json(json!({
                "parameters": { "H": 1.0 },
                "materials": { "m": { "E": 1e9, "nu": 0.2 } },
                "sections": { "s": { "area": 1, "inertia": 1 } },
                "nodes": { "a": [0, 0], "b": [4.0 * c, 4.0 * s] },
                "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 4 }],
                "foundations": [soil],
                "loads": { "w": { "items": [{ "point": { "bar": "ab", "distance": 2, "force": [3.0 * s, -3.0 * c] } }] },
                           "push": { "factor": "H", "items": [{ "point": { "bar": "ab", "distance": 2, "force": [c, s] } }] } }
            }))
        };
        let firm = case(None);
        let answer = firm.solve(&[]);
        is_answer(&answer);
        let u = displacement(&answer, "b");
        near("along", c * u[0] + s * u[1], 0.0, 1e-8, 1.0);
        near("sum", answer.pairs.iter().map(|pair| pair.x_t).sum(), -1.0, 1e-9, 1.0);
        mechanism(&firm.solve(&[("H", 1.501)]));
        is_answer(&firm.solve(&[("H", 1.499)]));
        let soft = case(Some(20.0)).solve(&[]);
        is_answer(&soft);
        let u = displacement(&soft, "b");
        close("along", c * u[0] + s * u[1], 1.0 / (20.0 * 4.0), 1e-6);
    }
}

/// An edge: the default direction is its inward normal, springs k × half of the adjacent lengths.
#[test]
fn an_edge_on_a_foundation() {
    let case = Case::json(json!({
        "materials": { "m": { "E": 1e9, "nu": 0.2 } },
        "plates": [{ "id": "block", "origin": [0, 0], "size": [2, 1], "divisions": [4, 2], "thickness": 1,
                     "material": "m", "plane": "stress" }],
        "foundations": [{ "id": "soil", "on": "block.bottom", "stiffness": 30, "tangential": 10 }],
        "loads": { "w": { "items": [{ "traction": { "edge": "block.top", "value": [2, -6] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    // 12 down on 60, 4 across on 20; 4 across at height 1 turns by 4/(30·2³/12 (1 + 2/16)).
    let u = displacement(&answer, "block[2,0]");
    close("u_y", u[1], -12.0 / 60.0, 1e-6);
    close("u_x", u[0], 4.0 / 20.0, 1e-6);
    let left = displacement(&answer, "block[0,0]");
    close("tilt", left[1] - u[1], 4.0 / (30.0 * 8.0 / 12.0 * (1.0 + 2.0 / 16.0)), 1e-6);
}
