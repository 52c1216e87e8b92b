//! Patch tests of bars: constant normal force, constant moment, constant shear, in chains of unequal elements that lie
//! anyhow in the plane; every node to 1e-12.

use serde_json::{Value, json};

use crate::common::*;

const E: f64 = 2.0e3;
const AREA: f64 = 0.7;
const INERTIA: f64 = 0.3;
const NU: f64 = 0.25;
const SHEAR_AREA: f64 = 0.5;
/// Places of the nodes along the chain.
const PLACES: [f64; 5] = [0.0, 0.7, 1.0, 2.6, 4.0];
const L: f64 = 4.0;

/// A chain turned by `angle` with what `rest` adds; `kind` and a section.
fn chain(angle: f64, kind: &str, section: &Value, rest: &Value) -> Case {
    let (s, c) = angle.sin_cos();
    let mut scenario = json!({ "materials": { "m": { "E": E, "nu": NU } }, "sections": { "s": section }, "bars": [] });
    for (i, x) in PLACES.iter().enumerate() {
        scenario["nodes"][format!("n{i}")] = json!([1.0 + c * x, -2.0 + s * x]);
        if i > 0 {
            let nodes = [format!("n{}", i - 1), format!("n{i}")];
            let bar = json!({ "id": format!("b{i}"), "nodes": nodes, "kind": kind, "material": "m", "section": "s" });
            scenario["bars"].as_array_mut().expect("a list").push(bar);
        }
    }
    for (key, value) in rest.as_object().expect("an object") {
        scenario[key] = value.clone();
    }
    Case::json(scenario)
}

/// Every node at (along, across, θ), and the internal forces (N, Q, M) at every end.
fn check(what: &str, case: &Case, angle: f64, right: impl Fn(f64) -> [f64; 3], inner: impl Fn(f64) -> [f64; 3]) {
    let answer = case.solve(&[]);
    is_answer(&answer);
    let (s, c) = angle.sin_cos();
    let size = PLACES.iter().flat_map(|x| right(*x)).fold(0f64, |m, u| m.max(u.abs()));
    for (i, x) in PLACES.into_iter().enumerate() {
        let [ux, uy, theta] = displacement(&answer, &format!("n{i}"));
        let found = [c * ux + s * uy, -s * ux + c * uy, theta];
        for (found, right) in found.into_iter().zip(right(x)) {
            near(&format!("{what}, n{i}"), found, right, 1e-12, size);
        }
    }
    let forces = PLACES.iter().flat_map(|x| inner(*x)).fold(0f64, |m, f| m.max(f.abs()));
    for (i, member) in answer.members.as_ref().expect("members").iter().enumerate() {
        for (end, x) in [(&member.start, PLACES[i]), (&member.end, PLACES[i + 1])] {
            for (found, right) in [end.n, end.q, end.m].into_iter().zip(inner(x)) {
                near(&format!("{what}, {}", member.bar), found, right, 1e-12, forces);
            }
        }
    }
}

/// N in a chain of trusses on rollers across it: u = N x/EA.
#[test]
fn trusses_under_constant_force() {
    let n = 5.0;
    for angle in [0.0_f64, 0.6, 2.1] {
        let (s, c) = angle.sin_cos();
        let mut springs = Vec::new();
        for i in 1..PLACES.len() {
            // Across the chain nothing else holds a node; nothing moves it either.
            springs.push(json!({ "at": format!("n{i}"), "direction": [-s, c], "stiffness": 10 }));
        }
        let rest = json!({
            "springs": springs,
            "supports": [{ "at": "n0", "fixed": ["x", "y"] }],
            "loads": { "w": { "items": [{ "point": { "at": "n4", "force": [n * c, n * s] } }] } }
        });
        let case = chain(angle, "truss", &json!({ "area": AREA }), &rest);
        check("truss", &case, angle, |x| [n * x / (E * AREA), 0.0, 0.0], |_| [n, 0.0, 0.0]);
    }
}

/// Clamped chains under a moment, a force along and a force across at the end, with and without a shear area:
/// N x/EA; M x²/2EI, M x/EI; F (L x²/2 − x³/6)/EI + F x/GA_s, F (L x − x²/2)/EI.
#[test]
fn frames_under_constant_force_moment_and_shear() {
    let ei = E * INERTIA;
    for angle in [0.0_f64, 0.6, 2.1] {
        let (s, c) = angle.sin_cos();
        for shear_area in [None, Some(SHEAR_AREA)] {
            let mut section = json!({ "area": AREA, "inertia": INERTIA });
            let mut flexibility = 0.0;
            if let Some(area) = shear_area {
                section["shear_area"] = json!(area);
                flexibility = 2.0 * (1.0 + NU) / (E * area);
            }
            let clamped = |force: [f64; 2], moment: f64| {
                let force = [c * force[0] - s * force[1], s * force[0] + c * force[1]];
                let point = json!({ "at": "n4", "force": force, "moment": moment });
                let rest = json!({
                    "supports": [{ "at": "n0", "fixed": ["x", "y", "r"] }],
                    "loads": { "w": { "items": [{ "point": point }] } }
                });
                chain(angle, "frame", &section, &rest)
            };
            let f = 3.0;
            check("axial", &clamped([f, 0.0], 0.0), angle, |x| [f * x / (E * AREA), 0.0, 0.0], |_| [f, 0.0, 0.0]);
            let bent = |x: f64| [0.0, f * x * x / (2.0 * ei), f * x / ei];
            check("moment", &clamped([0.0; 2], f), angle, bent, |_| [0.0, 0.0, f]);
            let sheared = |x: f64| {
                let v = f * (L * x * x / 2.0 - x * x * x / 6.0) / ei + f * x * flexibility;
                [0.0, v, f * (L * x - x * x / 2.0) / ei]
            };
            check("shear", &clamped([0.0, f], 0.0), angle, sheared, |x| [0.0, -f, f * (L - x)]);
        }
    }
}

/// Shear alone: guided at both ends (no rotation anywhere is free in the limit of a stiff section), Timoshenko's bar
/// under F with EI held by rotations that are fixed at every node: v = F x/GA_s + F Σ h³/12EI over the elements passed.
#[test]
fn timoshenko_bars_in_pure_shear() {
    let (f, ei) = (3.0, E * INERTIA);
    let flexibility = 2.0 * (1.0 + NU) / (E * SHEAR_AREA);
    let guided: Vec<Value> = (0..PLACES.len())
        .map(|i| {
            let fixed: &[&str] = if i == 0 { &["x", "y", "r"] } else { &["r"] };
            json!({ "at": format!("n{i}"), "fixed": fixed })
        })
        .collect();
    let rest = json!({
        "supports": guided,
        "loads": { "w": { "items": [{ "point": { "at": "n4", "force": [0, f] } }] } }
    });
    let section = json!({ "area": AREA, "inertia": INERTIA, "shear_area": SHEAR_AREA });
    let answer = chain(0.0, "frame", &section, &rest).solve(&[]);
    is_answer(&answer);
    let mut v = 0.0;
    for i in 1..PLACES.len() {
        let h = PLACES[i] - PLACES[i - 1];
        v += f * h * flexibility + f * h.powi(3) / (12.0 * ei);
        let found = displacement(&answer, &format!("n{i}"))[1];
        near(&format!("n{i}"), found, v, 1e-12, v);
    }
}

/// A bar on a foundation, bonded or tensionless, each node loaded by q times the length that belongs to it: it settles by
/// q/k and does not bend; the pairs press with just these forces.
#[test]
fn bars_settle_uniformly_on_foundations() {
    let (q, k) = (3.0, 70.0);
    let lengths = [0.35, 0.5, 0.95, 1.5, 0.7];
    for angle in [0.0_f64, 0.6] {
        let (s, c) = angle.sin_cos();
        for tensionless in [false, true] {
            let force = |(i, length): (usize, &f64)| json!({ "point": { "at": format!("n{i}"), "force": [q * length * s, -q * length * c] } });
            let items: Vec<Value> = lengths.iter().enumerate().map(force).collect();
            let nodes: Vec<String> = (0..PLACES.len()).map(|i| format!("n{i}")).collect();
            let rest = json!({
                "bars": [{ "id": "line", "polyline": nodes, "material": "m", "section": "s" }],
                "foundations": [{ "id": "soil", "on": "line", "stiffness": k, "tensionless": tensionless }],
                "springs": [{ "at": "n0", "direction": [c, s], "stiffness": 1000 }],
                "loads": { "w": { "items": items } }
            });
            let case = chain(angle, "frame", &json!({ "area": AREA, "inertia": INERTIA }), &rest);
            let answer = case.solve(&[]);
            is_answer(&answer);
            for node in nodes {
                let right = [q / k * s, -q / k * c, 0.0];
                near_all(&node, &displacement(&answer, &node), &right, 1e-12);
            }
            for member in answer.members.as_ref().expect("members") {
                let inner = [&member.start, &member.end].map(|end| [end.n, end.q, end.m]);
                assert!(inner.iter().flatten().all(|force| force.abs() < 1e-12 * q * L), "{inner:?}");
            }
            if tensionless {
                near_all("pairs", &of_pairs(&answer, |pair| pair.x_n), &lengths.map(|length| q * length), 1e-12);
            }
        }
    }
}
