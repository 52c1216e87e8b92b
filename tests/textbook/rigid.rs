//! Rigid bodies: blocks on springs, caps on columns, rigid arms, footings, bodies that stand on contacts only.

use serde_json::{Value, json};
use stickslip::answer::record::{Answer, State, Verdict};
use stickslip::model::load::load_text;
use stickslip::path::stages::follow;
use stickslip::session::{Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

use crate::common::*;

fn reaction(answer: &Answer, node: &str) -> [f64; 3] {
    let all = answer.reactions.as_ref().expect("reactions");
    let found = all.iter().find(|reaction| reaction.node == node).expect("a reaction");
    [found.fx, found.fy, found.m]
}

/// A block of four corners and its centre on springs k_x, k_y at every corner, b above and below the centre, a on both
/// sides: u = F/4k, θ = M/4(k_x b² + k_y a²), every corner at u + θ × r; with a force at a corner too, and turned.
#[test]
fn block_on_springs_at_its_corners() {
    let (a, b, kx, ky) = (2.0, 1.0, 3.0, 5.0);
    for angle in [0.0_f64, 0.7] {
        let (s, c) = angle.sin_cos();
        let turn = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
        let corners = [("A", [-a, -b]), ("B", [a, -b]), ("C", [a, b]), ("D", [-a, b])];
        let mut nodes = json!({ "O": turn([0.0, 0.0]) });
        let mut springs = Vec::new();
        for (id, place) in corners {
            nodes[id] = json!(turn(place));
            springs.push(json!({ "at": id, "direction": turn([1.0, 0.0]), "stiffness": kx }));
            springs.push(json!({ "at": id, "direction": turn([0.0, 1.0]), "stiffness": ky }));
        }
        let case = Case::json(json!({
            "nodes": nodes, "springs": springs,
            "rigid": [{ "id": "block", "nodes": ["A", "B", "C", "D"], "about": "O" }],
            "loads": {
                "centre": { "items": [{ "point": { "at": "O", "force": turn([6.0, -10.0]), "moment": 7.0 } }] },
                "corner": { "items": [{ "point": { "at": "C", "force": turn([1.0, 2.0]), "moment": -3.0 } }] }
            }
        }));
        let answer = case.solve(&[]);
        is_answer(&answer);
        let (fx, fy) = (6.0 + 1.0, -10.0 + 2.0);
        let moment = 7.0 - 3.0 + a * 2.0 - b * 1.0;
        let (ux, uy) = (fx / (4.0 * kx), fy / (4.0 * ky));
        let theta = moment / (4.0 * (kx * b * b + ky * a * a));
        for (id, [x, y]) in corners {
            let right = turn([ux - theta * y, uy + theta * x]);
            let found = displacement(&answer, id);
            near_all(id, &found, &[right[0], right[1], theta], 1e-12);
        }
        let right = turn([ux, uy]);
        near_all("centre", &displacement(&answer, "O"), &[right[0], right[1], theta], 1e-12);
    }
}

/// A plate with all its nodes in a body, under gravity, on two springs and a support: the body has the plate's weight.
#[test]
fn weight_of_the_elements_inside() {
    let (density, t, k) = (2.5, 0.2, 40.0);
    let all: Vec<String> = (0..=4).flat_map(|i| (0..=2).map(move |j| format!("p[{i},{j}]"))).collect();
    let case = Case::json(json!({
        "materials": { "m": { "E": 1e9, "nu": 0.2, "density": density } },
        "plates": [{ "id": "p", "origin": [0, 0], "size": [4, 3], "divisions": [4, 2], "thickness": t, "material": "m",
                     "plane": "stress" }],
        "rigid": [{ "id": "block", "nodes": all }],
        "springs": [{ "at": "p[0,0]", "direction": [0, 1], "stiffness": k },
                    { "at": "p[3,0]", "direction": [0, 1], "stiffness": k }],
        "supports": [{ "at": "p[0,2]", "fixed": ["x"] }],
        "loads": { "g": { "items": [{ "gravity": { "acceleration": [0, -10] } }, { "pressure": { "edge": "p.right", "value": 2 } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let (weight, push) = (density * 4.0 * 3.0 * t * 10.0, 2.0 * 3.0 * t);
    // About p[0,0]: 3 F_b = 2 W + 3 P − 1.5 P, the support holding P at the top.
    let right = (2.0 * weight + 1.5 * push) / 3.0;
    near_all("right spring", &reaction(&answer, "p[3,0]"), &[0.0, right, 0.0], 1e-12);
    near_all("left spring", &reaction(&answer, "p[0,0]"), &[0.0, weight - right, 0.0], 1e-12);
    near_all("support", &reaction(&answer, "p[0,2]"), &[push, 0.0, 0.0], 1e-12);
    close("sinks", displacement(&answer, "p[3,2]")[1], -right / k, 1e-12);
}

const EI: f64 = 300.0;
const EA: f64 = 4000.0;
const H: f64 = 3.0;

/// Portal of two columns clamped at the foot, 2a apart, with a rigid cap: unknowns u and θ,
/// [2·12EI/h³, 2·6EI/h²; 2·6EI/h², 2·4EI/h + 2a²EA/h] (u, θ)ᵀ = (F, 0)ᵀ. A pin at each head leaves 2·3EI/h³.
fn portal(hinges: Value) -> Case {
    Case::json(json!({
        "materials": { "m": { "E": 1, "nu": 0.2 } },
        "sections": { "s": { "area": EA, "inertia": EI } },
        "nodes": { "a": [0, 0], "b": [0, H], "c": [4, 0], "d": [4, H], "tip": [6, 3.5] },
        "bars": [{ "id": "left", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 2, "hinges": hinges },
                 { "id": "right", "nodes": ["c", "d"], "material": "m", "section": "s", "hinges": hinges }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "r"] }, { "at": "c", "fixed": ["x", "y", "r"] }],
        "rigid": [{ "id": "cap", "nodes": ["b", "d", "tip"] }],
        "loads": { "sway": { "items": [{ "point": { "at": "d", "force": [5, 0] } }] } }
    }))
}

#[test]
fn rigid_cap_over_two_columns() {
    let (f, a) = (5.0, 2.0);
    let answer = portal(json!([])).solve(&[]);
    is_answer(&answer);
    let (k11, k12) = (24.0 * EI / H.powi(3), 12.0 * EI / (H * H));
    let k22 = 8.0 * EI / H + 2.0 * a * a * EA / H;
    let determinant = k11 * k22 - k12 * k12;
    let (u, theta) = (f * k22 / determinant, -f * k12 / determinant);
    near_all("b", &displacement(&answer, "b"), &[u, -theta * a, theta], 1e-11);
    near_all("d", &displacement(&answer, "d"), &[u, theta * a, theta], 1e-11);
    near_all("tip", &displacement(&answer, "tip"), &[u - 0.5 * theta, theta * 4.0, theta], 1e-11);
    for foot in ["a", "c"] {
        close("shear", reaction(&answer, foot)[0], -f / 2.0, 1e-11);
    }
    let (left, right) = (reaction(&answer, "a"), reaction(&answer, "c"));
    near("vertical", left[1] + right[1], 0.0, 1e-11, f);
    near("about the left foot", left[2] + right[2] + 4.0 * right[1] - f * H, 0.0, 1e-11, f * H);

    let answer = portal(json!(["end"])).solve(&[]);
    is_answer(&answer);
    close("pinned", displacement(&answer, "b")[0], f * H.powi(3) / (6.0 * EI), 1e-11);
}

/// Cantilever with a rigid arm e across its tip, P at the arm's end: tip v = PL³/3EI, its rotation M L/EI with M = P e,
/// and the end of the arm goes with it. The limit of frames whose arm becomes stiffer.
#[test]
fn eccentric_load_through_a_rigid_arm() {
    let (l, e, p) = (4.0, 1.5, 2.0);
    let scenario = |arm: Value, rigid: Value| {
        Case::json(json!({
            "materials": { "m": { "E": 1, "nu": 0.2 }, "hard": { "E": 1e7, "nu": 0.2 } },
            "sections": { "s": { "area": EA, "inertia": EI } },
            "nodes": { "a": [0, 0], "b": [l, 0], "c": [l, e] },
            "bars": arm, "rigid": rigid,
            "supports": [{ "at": "a", "fixed": ["x", "y", "r"] }],
            "loads": { "w": { "items": [{ "point": { "at": "c", "force": [p, -p], "moment": 0.5 } }] } }
        }))
        .solve(&[])
    };
    let bar = |id: &str, a: &str, b: &str, m: &str| json!({ "id": id, "nodes": [a, b], "material": m, "section": "s" });
    let rigid = scenario(json!([bar("ab", "a", "b", "m")]), json!([{ "id": "arm", "nodes": ["b", "c"] }]));
    is_answer(&rigid);
    let moment = -p * e + 0.5;
    let theta = -p * l * l / (2.0 * EI) + moment * l / EI;
    let v = -p * l.powi(3) / (3.0 * EI) + moment * l * l / (2.0 * EI);
    let u = p * l / EA;
    near_all("tip", &displacement(&rigid, "b"), &[u, v, theta], 1e-11);
    near_all("arm", &displacement(&rigid, "c"), &[u - theta * e, v, theta], 1e-11);
    near_all("clamp", &reaction(&rigid, "a"), &[-p, p, p * l - moment], 1e-11);
    // 1e7 times as stiff: 1e-7 of its own bending from the rigid one.
    let stiff = scenario(json!([bar("ab", "a", "b", "m"), bar("bc", "b", "c", "hard")]), json!([]));
    near_all("limit", &displacement(&stiff, "c"), &displacement(&rigid, "c"), 1e-6);
}

/// A rigid footing 0 … 8 on a tensionless foundation k, P at x_p outside its kern. Nodes 0.5 apart carry k·0.5 (half at
/// the ends); pressure p_i = −k_i (v + θ x_i) on the nodes that press, Σ p = P, Σ p x = P x_p: the set is found by
/// taking away what would pull, the two equations are solved anew.
#[test]
fn footing_on_a_tensionless_foundation() {
    let (k, p, n) = (50.0, 12.0, 16);
    for x_p in [2.0, 1.0] {
        let body = json!({
            "materials": { "m": { "E": 1e6, "nu": 0.2 } },
            "plates": [{ "id": "f", "origin": [0, 0], "size": [8, 1], "divisions": [n, 1], "thickness": 1, "material": "m",
                         "plane": "stress" }],
            "nodes": { "top": [x_p, 4] },
            "rigid": [{ "id": "footing", "at": "f.bottom", "about": "top" }],
            "supports": [{ "at": "top", "fixed": ["x"] }],
            "foundations": [{ "id": "soil", "on": "f.bottom", "stiffness": k, "tensionless": true }],
            "loads": { "w": { "items": [{ "point": { "at": "top", "force": [0, -p] } }] } }
        });
        let answer = Case::json(body).solve(&[]);
        is_answer(&answer);
        let x = |i: usize| i as f64 * 8.0 / n as f64;
        let stiffness = |i: usize| k * 8.0 / n as f64 * if i == 0 || i == n { 0.5 } else { 1.0 };
        let mut pressing: Vec<usize> = (0..=n).collect();
        let (mut v, mut theta);
        loop {
            let sum = |power: i32| pressing.iter().map(|&i| stiffness(i) * x(i).powi(power)).sum::<f64>();
            let (s0, s1, s2) = (sum(0), sum(1), sum(2));
            let determinant = s0 * s2 - s1 * s1;
            (v, theta) = (-p * (s2 - s1 * x_p) / determinant, -p * (s0 * x_p - s1) / determinant);
            let before = pressing.len();
            pressing.retain(|&i| v + theta * x(i) < 0.0);
            if pressing.len() == before {
                break;
            }
        }
        assert!(pressing.len() <= n);
        let right: Vec<f64> = (0..=n).map(|i| (-stiffness(i) * (v + theta * x(i))).max(0.0)).collect();
        near_all("pressures", &of_pairs(&answer, |pair| pair.x_n), &right, 1e-11);
        near_all("top", &displacement(&answer, "top"), &[0.0, v + theta * x_p, theta], 1e-11);
        near("support", reaction(&answer, "top")[0], 0.0, 1e-11, p);
        // The compressed length is near 3 times the distance of P from the edge.
        let length = -v / theta;
        near("length", length, 3.0 * x_p, 0.25, 1.0);
    }
}

/// A block of no elements on two contacts of the ground, one with friction: statics alone. W at height h, push H:
/// left x_n = W/2 − H h/2a, x_t = −H; it slides when H > f x_n of the one with friction.
fn standing(f: f64) -> Case {
    Case::json(json!({
        "parameters": { "H": 1.0 },
        "nodes": { "A": [-2, 0], "B": [2, 0], "G": [0, 1] },
        "rigid": [{ "id": "block", "nodes": ["A", "B", "G"] }],
        "contacts": [
            { "id": "a", "node": "A", "against": "ground", "normal": [0, 1], "friction": f },
            { "id": "b", "node": "B", "against": "ground", "normal": [0, 1], "law": "frictionless" }
        ],
        "loads": { "weight": { "items": [{ "point": { "at": "G", "force": [0, -10] } }] },
                   "push": { "factor": "H", "items": [{ "point": { "at": "G", "force": [1, 0] } }] } }
    }))
}

#[test]
fn a_rigid_body_on_two_contacts() {
    let case = standing(0.5);
    let answer = case.solve(&[]);
    is_answer(&answer);
    near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &[5.0 - 0.25, 5.0 + 0.25], 1e-13);
    near("x_t", answer.pairs[0].x_t, -1.0, 1e-13, 1.0);
    assert_eq!(states(&answer), [State::Stick, State::Closed]);
    // H = f (5 − H/4): H = 2.5/1.125; p of the covering (1, 1 + f) is missing in f (x_n + p) + p.
    let limit = 2.5 / 1.125;
    is_answer(&case.solve(&[("H", limit * (1.0 - 1e-9))]));
    let beyond = case.solve(&[("H", limit * 1.01)]);
    let ray = mechanism(&beyond);
    assert_eq!(ray.verdict, Some(Verdict::Certified));
    close("p", ray.p, 0.01 * limit * 1.125 / 1.5, 1e-10);
    // Overturning about B: H h = W a, with friction enough to hold it.
    let case = standing(4.0);
    // x_n of a is 5 − H/4; it slides at H = 4 (5 − H/4), H = 10, before it overturns at 20.
    is_answer(&case.solve(&[("H", 9.999)]));
    mechanism(&case.solve(&[("H", 10.001)]));
}

/// Two rigid bodies upon each other, the lower on springs: the upper one stands by contact only, the joints carry what
/// statics says and the lower one sinks and turns under both.
#[test]
fn contact_between_rigid_bodies() {
    let (k, w, h) = (20.0, 8.0, 1.0);
    let case = Case::json(json!({
        "nodes": { "a": [-1, 0], "b": [1, 0], "c": [-1, 1], "d": [1, 1], "e": [-1, 1], "f": [1, 1], "g": [0.3, 2] },
        "rigid": [{ "id": "lower", "nodes": ["a", "b", "c", "d"] }, { "id": "upper", "nodes": ["e", "f"], "about": "g" }],
        "springs": [{ "at": "a", "direction": [0, 1], "stiffness": k }, { "at": "b", "direction": [0, 1], "stiffness": k },
                    { "at": "a", "direction": [1, 0], "stiffness": k }],
        "contacts": [
            { "id": "left", "node": "e", "against": "c", "normal": [0, 1], "friction": 0.5 },
            { "id": "right", "node": "f", "against": "d", "normal": [0, 1], "law": "frictionless" }
        ],
        "loads": { "w": { "items": [{ "point": { "at": "g", "force": [h, -w] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    // About the left contact: 2 R = 1.3 W + 1·H.
    let right = (1.3 * w + h) / 2.0;
    near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &[w - right, right], 1e-12);
    near_all("x_t", &of_pairs(&answer, |pair| pair.x_t), &[-h, 0.0], 1e-12);
    let values = case.scenario.parameter_values();
    assert!(balance::imbalance(&case.scenario, &values, &answer) < 1e-12);
    assert!(balance::incompatibility(&case.scenario, &values, &answer) < 1e-12);
    // The springs: about a 2 B = 1.3 W + 2·H.
    let b = (1.3 * w + 2.0 * h) / 2.0;
    near_all("b", &reaction(&answer, "b"), &[0.0, b, 0.0], 1e-12);
    near_all("a", &reaction(&answer, "a"), &[-h, w - b, 0.0], 1e-12);
    let theta = (w - b - b) / k / 2.0;
    let (u, v) = (h / k, -(w - b) / k);
    near_all("g", &displacement(&answer, "g"), &[u - 2.0 * theta, v + 1.3 * theta, theta], 1e-12);
}

/// Two rigid links pinned to supports and to each other by a tie, the pin on a spring: v = P/k, links turn by ±v/L. A
/// hinge of the tie is not a hinge of the body: with one of them clamped nothing moves.
#[test]
fn links_pinned_by_a_tie() {
    let (l, k, p) = (2.0, 5.0, 3.0);
    let case = |fixed: Value| {
        Case::json(json!({
            "nodes": { "a": [0, 0], "b": [l, 0], "c": [l, 0], "d": [2.0 * l, 0], "e": [l, 1] },
            "rigid": [{ "id": "left", "nodes": ["a", "b", "e"] }, { "id": "right", "nodes": ["c", "d"] }],
            "ties": [{ "nodes": ["b", "c"] }],
            "supports": [{ "at": "a", "fixed": fixed }, { "at": "d", "fixed": ["y"] }],
            "springs": [{ "at": "c", "direction": [0, 1], "stiffness": k }],
            "loads": { "w": { "items": [{ "point": { "at": "b", "force": [0, -p] } }] } }
        }))
        .solve(&[])
    };
    let answer = case(json!(["x", "y"]));
    is_answer(&answer);
    let v = -p / k;
    near_all("b", &displacement(&answer, "b"), &[0.0, v, v / l], 1e-12);
    near_all("c", &displacement(&answer, "c"), &[0.0, v, -v / l], 1e-12);
    near_all("e", &displacement(&answer, "e"), &[-v / l, v, v / l], 1e-12);
    for node in ["a", "d"] {
        near_all(node, &reaction(&answer, node), &[0.0; 3], 1e-12);
    }
    let answer = case(json!(["x", "y", "r"]));
    is_answer(&answer);
    near_all("b", &displacement(&answer, "b"), &[0.0; 3], 1e-14);
    near_all("clamp", &reaction(&answer, "a"), &[0.0, p, p * l], 1e-12);
}

/// A support that settles carries the body with it, turns it, and its forces work: in a history W = ΔU + D, also where a
/// pair slips on the way.
#[test]
fn settlements_and_histories_of_bodies() {
    let (k, kh, s, turn) = (30.0, 12.0, 0.02, 0.01);
    let mut scenario = json!({
        "nodes": { "a": [0, 0], "b": [4, 0], "c": [2, 1] },
        "rigid": [{ "id": "body", "nodes": ["a", "b", "c"] }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "r"], "settlement": [s, -s, turn], "case": "moved" }],
        "springs": [{ "at": "b", "direction": [0, 1], "stiffness": k }],
        "loads": { "moved": { "items": [] } }
    });
    let answer = Case::json(scenario.clone()).solve(&[]);
    is_answer(&answer);
    near_all("a", &displacement(&answer, "a"), &[s, -s, turn], 1e-13);
    near_all("b", &displacement(&answer, "b"), &[s, -s + 4.0 * turn, turn], 1e-13);
    near_all("c", &displacement(&answer, "c"), &[s - turn, -s + 2.0 * turn, turn], 1e-13);
    let spring = k * (-s + 4.0 * turn);
    near_all("support", &reaction(&answer, "a"), &[0.0, spring, 4.0 * spring], 1e-12);

    // A slider d under the body's c, dragged against its spring: it sticks up to f·W, then slips.
    let (f, w) = (0.4, 2.0);
    scenario["nodes"]["d"] = json!([2, 1]);
    scenario["springs"] = json!([{ "at": "d", "direction": [1, 0], "stiffness": kh }]);
    scenario["supports"][0]["settlement"] = json!([0.2, 0, 0]);
    scenario["contacts"] = json!([{ "id": "slide", "node": "d", "against": "c", "normal": [0, 1], "friction": f }]);
    scenario["loads"]["weight"] = json!({ "items": [{ "point": { "at": "d", "force": [0, -w] } }] });
    scenario["stages"] = json!([{ "weight": 1 }, { "weight": 1, "moved": 1 }, { "weight": 1, "moved": -1 }]);
    let case = Case::json(scenario);
    let values = case.scenario.parameter_values();
    let history = follow(case.prepared.case(&case.scenario, &values)).expect("a history");
    let end = &history.stages[1].end;
    near("slip", end.pairs[0].z_t, f * w / kh - 0.2, 1e-12, 1.0);
    near_all("drag", &reaction(end, "a"), &[f * w, w, 2.0 * w - f * w], 1e-12);
    let dissipated = [0.0, f * w * (0.2 - f * w / kh), f * w * (0.4 - 2.0 * f * w / kh)];
    for (stage, right) in history.stages.iter().zip(dissipated) {
        near("dissipated", stage.dissipated, right, 1e-12, 1.0);
        let energy = stage.energy.expect("a structure");
        assert!(stage.end.check.passed && energy.residual < 1e-12, "{energy:?}");
    }
    assert_eq!(history.stages.len(), 3);
}

/// The height of the portal as a slider: a new K, and the sway F h³/6EI of pinned heads at the new height.
#[test]
fn a_body_follows_its_coordinates_live() {
    let text = scenario_text(json!({
        "parameters": { "h": { "value": 3, "min": 1, "max": 6 } },
        "materials": { "m": { "E": 1, "nu": 0.2 } },
        "sections": { "s": { "area": EA, "inertia": EI } },
        "nodes": { "a": [0, 0], "b": [0, "h"], "c": [4, 0], "d": [4, "h"], "tip": [6, "h + 1/2"] },
        "bars": [{ "id": "left", "nodes": ["a", "b"], "material": "m", "section": "s", "hinges": ["end"] },
                 { "id": "right", "nodes": ["c", "d"], "material": "m", "section": "s", "hinges": ["end"] }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "r"] }, { "at": "c", "fixed": ["x", "y", "r"] }],
        "rigid": [{ "id": "cap", "nodes": ["b", "d"], "about": "tip" }],
        "loads": { "sway": { "items": [{ "point": { "at": "d", "force": [5, 0] } }] } }
    }));
    let scenario = load_text("portal", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
    let mut session = Session::new(scenario, &Quiet).unwrap_or_else(|error| panic!("{error}"));
    for height in [3.0_f64, 4.0, 2.5] {
        let sway = 5.0 * height.powi(3) / (6.0 * EI);
        for command in [
            format!("set h {height}"),
            format!("expect ux b = {sway:e} ± 1e-13"),
            format!("expect ux tip = {sway:e} ± 1e-13"),
        ] {
            let mut out = Vec::new();
            let style = Style { width: 100, color: false, ascii: false };
            let mut io = Output::text(&mut out, style, &Quiet);
            session.execute(&command, &mut io).unwrap_or_else(|error| panic!("{command}: {error}"));
        }
    }
}

/// A block of no elements on two contacts with friction: four joints for three motions. What statics fixes is shown
/// (x_n, Σ x_t), and it slides at H = f W, not before and certified beyond.
#[test]
fn joints_that_a_body_makes_dependent() {
    let f = 0.5;
    let case = Case::json(json!({
        "parameters": { "H": 1.0 },
        "nodes": { "A": [-2, 0], "B": [2, 0], "G": [0, 1] },
        "rigid": [{ "id": "block", "nodes": ["A", "B", "G"] }],
        "contacts": [
            { "id": "a", "node": "A", "against": "ground", "normal": [0, 1], "friction": f },
            { "id": "b", "node": "B", "against": "ground", "normal": [0, 1], "friction": f }
        ],
        "loads": { "weight": { "items": [{ "point": { "at": "G", "force": [0, -10] } }] },
                   "push": { "factor": "H", "items": [{ "point": { "at": "G", "force": [1, 0] } }] } }
    }));
    for h in [1.0, -3.0, 4.999] {
        let answer = case.solve(&[("H", h)]);
        is_answer(&answer);
        near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &[5.0 - h / 4.0, 5.0 + h / 4.0], 1e-10);
        near("Σ x_t", of_pairs(&answer, |pair| pair.x_t).iter().sum(), -h, 1e-10, 5.0);
        for pair in &answer.pairs {
            assert!(pair.x_t.abs() <= f * pair.x_n + 1e-9, "{pair:?}");
        }
    }
    let beyond = case.solve(&[("H", 5.05)]);
    let ray = mechanism(&beyond);
    assert_eq!(ray.verdict, Some(Verdict::Certified));
}
