//! Histories that turn back where a part is in neutral equilibrium: the way back is the way out reversed.

use serde_json::{Value, json};
use stickslip::path::stages::{History, HistoryEnd, follow};

use crate::common::lines::{read, report};
use crate::common::{Case, near, scenario_text};

/// Of R z, 100 in both structures, that is E times the settlement, the sums of a force keep 256 ε.
const FORCES: f64 = 256.0 * f64::EPSILON * 100.0;
/// Gaps beside the settlement: what such a force moves.
const GAPS: f64 = 256.0 * f64::EPSILON;

/// Symmetric arch of `count` voussoirs on springings at 150° and 30°; the right one gives way by `spread`.
fn arch(count: usize, stages: Value) -> Value {
    let place = |radius: f64, k: usize| {
        let angle = (150.0 - 120.0 * k as f64 / count as f64).to_radians();
        json!([radius * angle.cos(), radius * angle.sin()])
    };
    let normal = |k: usize, sign: f64| {
        let angle = (150.0 - 120.0 * k as f64 / count as f64).to_radians();
        json!([sign * angle.sin(), -sign * angle.cos()])
    };
    let (mut nodes, mut quads, mut contacts) = (json!({}), vec![], vec![]);
    let mut pair = |id: String, node: String, against: String, normal: Value| {
        contacts.push(json!({"id": id, "node": node, "against": against, "normal": normal, "friction": 0.8}));
    };
    for k in 0..count {
        for (name, radius, at) in [("a", 0.85, k), ("b", 1.15, k), ("c", 1.15, k + 1), ("d", 0.85, k + 1)] {
            nodes[format!("{name}{k}")] = place(radius, at);
        }
        let corners = ["a", "d", "c", "b"].map(|name| format!("{name}{k}"));
        quads
            .push(json!({"id": format!("q{k}"), "nodes": corners, "thickness": 1, "material": "m", "plane": "stress"}));
        if k > 0 {
            pair(format!("i{k}"), format!("a{k}"), format!("d{}", k - 1), normal(k, 1.0));
            pair(format!("o{k}"), format!("b{k}"), format!("c{}", k - 1), normal(k, 1.0));
        }
    }
    for (name, radius, at) in [("gi", 0.85, 0), ("go", 1.15, 0), ("hi", 0.85, count), ("ho", 1.15, count)] {
        nodes[name] = place(radius, at);
    }
    pair("i0".into(), "a0".into(), "gi".into(), normal(0, 1.0));
    pair("o0".into(), "b0".into(), "go".into(), normal(0, 1.0));
    pair(format!("i{count}"), format!("d{}", count - 1), "hi".into(), normal(count, -1.0));
    pair(format!("o{count}"), format!("c{}", count - 1), "ho".into(), normal(count, -1.0));
    let still = ["gi", "go"].map(|at| json!({"at": at, "fixed": ["x", "y"]}));
    let moved = ["hi", "ho"].map(|at| json!({"at": at, "fixed": ["x", "y"], "settlement": [1, 0], "case": "spread"}));
    let supports = [still, moved].concat();
    json!({"format": "stickslip/1", "title": "arch", "materials": {"m": {"E": 1e6, "nu": 0.2, "density": 1}},
        "nodes": nodes, "quads": quads, "contacts": contacts, "supports": supports,
        "parameters": {"s": 1e-4}, "loads": {"g": {"items": [{"gravity": {"acceleration": [0, -1]}}]},
        "spread": {"factor": "s", "items": []}}, "stages": stages})
}

fn followed(scenario: Value) -> History {
    let case = Case::json(scenario);
    let values = case.scenario.parameter_values();
    let history = follow(case.prepared.case(&case.scenario, &values)).expect("a history");
    assert_eq!(history.end, HistoryEnd::Complete);
    history
}

/// z_n and x_n of a pair at the end of a stage.
fn pair(history: &History, stage: usize, id: &str) -> [f64; 2] {
    let pair = history.stages[stage].end.pairs.iter().find(|pair| pair.id == id).expect(id);
    [pair.z_n, pair.x_n]
}

/// Every force is that of before, and the gaps in `moved` grow by as much.
fn turned(history: &History, [before, after]: [usize; 2], settlement: f64, moved: &[(&str, f64)]) {
    for there in &history.stages[before].end.pairs {
        let [[from, force], [to, now]] = [before, after].map(|stage| pair(history, stage, &there.id));
        let by = moved.iter().find(|(id, _)| *id == there.id).map_or(0.0, |(_, by)| *by);
        let of = |what: &str| format!("{what} of {} in stage {after}", there.id);
        near(&of("gap"), to - from, by, GAPS, settlement);
        near(&of("force"), now, force, FORCES, 1.0);
    }
}

/// Of three voussoirs, hinges at i0, o1, o2, i3, and i1 touches without a force: the crown may turn about o1 and o2 at no cost.
/// As the springing comes back, nothing drives that motion.
#[test]
fn an_arch_comes_back() {
    let history = followed(arch(
        3,
        json!([{"g": 1}, {"g": 1, "spread": 1}, {"g": 1, "spread": 0.9}, {"g": 1, "spread": 1}, {"g": 1, "spread": 0.5}]),
    ));
    let at = |radius: f64, degrees: f64| [radius * degrees.to_radians().cos(), radius * degrees.to_radians().sin()];
    let [i0, o0, o1, i2] = [at(0.85, 150.0), at(1.15, 150.0), at(1.15, 110.0), at(0.85, 70.0)];
    let [o2, i3, o3] = [at(1.15, 70.0), at(0.85, 30.0), at(1.15, 30.0)];
    let turn = |by: f64, about: [f64; 2], of: [f64; 2]| [-by * (of[1] - about[1]), by * (of[0] - about[0])];
    // Voussoirs 0 and 1 turn about i0 by α and voussoir 2 about o2, so that i3 follows the springing by 1: its height above o2,
    // and the distances of o2 from both hinges, give both turns.
    let (left, right) = ([o2[0] - i0[0], o2[1] - i0[1]], [i3[0] - o2[0], i3[1] - o2[1]]);
    let det = left[1] * right[0] - right[1] * left[0];
    let (alpha, beta) = (-right[0] / det, left[0] / det);
    let along = |degrees: f64, v: [f64; 2]| {
        let normal = [degrees.to_radians().sin(), -degrees.to_radians().cos()];
        normal[0] * v[0] + normal[1] * v[1]
    };
    let opens_at_springing = along(150.0, turn(alpha, i0, o0));
    let relative = [turn(beta, o2, i2), turn(alpha, o2, i2)];
    let opens_at_crown = along(70.0, [relative[0][0] - relative[1][0], relative[0][1] - relative[1][1]]);
    let opens_at_right = -along(30.0, turn(beta, i3, o3));
    let rates = [("o0", opens_at_springing), ("i2", opens_at_crown), ("o3", opens_at_right)];
    for (stages, by) in [([1, 2], -0.1e-4), ([2, 3], 0.1e-4), ([3, 4], -0.5e-4)] {
        turned(&history, stages, 1e-4, &rates.map(|(id, rate)| (id, by * rate)));
    }
    // Thrust at the crown: moments about i0 of voussoir 0 and of half the crown, which stands on o1.
    let corners = [i0, at(0.85, 110.0), o1, o0];
    let (mut twice, mut first) = (0.0, 0.0);
    for (a, b) in (0..4).map(|k| (corners[k], corners[(k + 1) % 4])) {
        let cross = a[0] * b[1] - b[0] * a[1];
        twice += cross;
        first += (a[0] + b[0]) * cross / 3.0;
    }
    let (weight, centre) = ((0.5 * twice).abs(), first / twice);
    let thrust = (weight * (centre - i0[0]) + 0.5 * weight * (o1[0] - i0[0])) / (o1[1] - i0[1]);
    let expected = along(110.0, [thrust, 0.5 * weight]);
    near("thrust", pair(&history, 2, "o1")[1], expected, FORCES, 1.0);
}

/// Whatever the number of voussoirs, the springing goes to and fro for ever without a loss.
#[test]
fn arches_come_back_in_cycles() {
    for count in [3, 5, 7] {
        let mut session = read(&scenario_text(arch(count, json!([{"g": 1}, {"g": 1, "spread": 1}]))));
        let found = report(&mut session, "cycle s 5e-5..1e-4").expect("followed");
        assert_eq!(found["kind"], "shakes-down", "{count} voussoirs: {found}");
    }
}

/// The base block in the middle settles and half comes back. Two of the blocks above stand on what does not settle; their corners
/// over other blocks are free of any force, and a load that cannot reach them leaves rounding in them. The block between rests on
/// what settles and on what stays: it turns by half as much.
#[test]
fn a_wall_comes_back() {
    let (mut plates, mut nodes, mut supports, mut contacts) = (vec![], json!({}), vec![], vec![]);
    let mut block = |id: String, x: i32, y: i32| {
        plates.push(
            json!({"id": id, "origin": [x, y], "size": [2, 1], "divisions": [2, 1], "thickness": 1, "material": "m",
            "plane": "strain"}),
        );
    };
    let mut pair = |id: String, node: String, against: String| {
        contacts.push(json!({"id": id, "node": node, "against": against, "normal": [0, 1], "friction": 0.5}));
    };
    for k in 0..3 {
        block(format!("base{k}"), 2 * k, 0);
        for j in 0..3 {
            let ground = format!("g{k}{j}");
            nodes[&ground] = json!([2 * k + j, 0]);
            let mut support = json!({"at": ground, "fixed": ["x", "y"]});
            if k == 1 {
                (support["settlement"], support["case"]) = (json!([0, -1]), json!("set"));
            }
            supports.push(support);
            pair(format!("c{ground}"), format!("base{k}[{j},0]"), ground);
        }
    }
    for k in 0..4 {
        block(format!("top{k}"), 2 * k - 1, 1);
        for j in (0..3).filter(|j| (0..=6).contains(&(2 * k - 1 + j))) {
            let x = 2 * k - 1 + j;
            // Over a joint between two base blocks the pair is with the left one.
            let base = ((x - 1).max(0)) / 2;
            pair(format!("t{k}{j}"), format!("top{k}[{j},0]"), format!("base{base}[{},1]", x - 2 * base));
        }
    }
    let history = followed(json!({"format": "stickslip/1", "title": "wall", "plates": plates, "nodes": nodes,
        "materials": {"m": {"E": 1e4, "nu": 0.2, "density": 1}}, "supports": supports, "contacts": contacts,
        "loads": {"g": {"items": [{"gravity": {"acceleration": [0, -1]}}]}, "set": {"factor": 0.01, "items": []}},
        "stages": [{"g": 1}, {"g": 1, "set": 1}, {"g": 1, "set": 0.5}]}));
    turned(&history, [1, 2], 0.01, &[("t12", -0.005), ("t21", -0.0025)]);
}
