//! Rollers: pairs of law `bound` with the bound 0, supports that hold one way only and look anywhere.
//!
//! ```text
//!        ▽ P                    what is turned carries the same forces
//!   ●══●══●══●   on springs     and moves by the turned displacements
//!   ○  ○  ○  ○   on rollers
//! ```

use serde_json::json;
use stickslip::answer::record::State;
use stickslip::model::vector::{cross, dot};

use crate::common::lines::{read, report};
use crate::common::*;

/// A beam on springs that it may part from, whose feet are held along the beam: by supports where nothing is turned, by
/// rollers otherwise. The beam is stiff: EI/d³ is 1e8 times a spring and more.
fn footing(nodes: usize, turn: Option<f64>) -> String {
    let (sin, cos) = turn.unwrap_or(0.0).sin_cos();
    let turned = |x: f64, y: f64| json!([cos * x - sin * y, sin * x + cos * y]);
    let between = 6.0 / (nodes - 1) as f64;
    let mut value = json!({
        "materials": { "m": { "E": 1e9, "nu": 0.2 } },
        "sections": { "s": { "area": 10, "inertia": 1 } },
        "nodes": {}, "bars": [], "supports": [], "springs": [], "contacts": [],
        "loads": { "p": { "factor": 900,
            "items": [{ "point": { "at": format!("f{}", 3 * (nodes - 1) / 4), "force": turned(0.0, -1.0) } }] } }
    });
    let mut list = |key: &str, entry| value[key].as_array_mut().expect("a list").push(entry);
    let mut rollers = Vec::new();
    let mut held = |at: String| match turn {
        None => list("supports", json!({ "at": at, "fixed": ["x"] })),
        Some(_) => rollers.push(json!({ "id": format!("along-{at}"), "node": at, "against": "ground",
                "normal": turned(1.0, 0.0), "law": "bound", "bound": 0 })),
    };
    (0..nodes).for_each(|i| held(format!("g{i}")));
    held("f0".to_owned());
    for i in 0..nodes {
        let share = if i == 0 || i + 1 == nodes { 0.5 } else { 1.0 };
        list(
            "springs",
            json!({ "at": format!("g{i}"), "direction": turned(0.0, 1.0), "stiffness": 1e4 * between * share }),
        );
        list(
            "contacts",
            json!({ "id": format!("c{i}"), "node": format!("f{i}"), "against": format!("g{i}"),
                "normal": turned(0.0, 1.0), "law": "frictionless" }),
        );
        if i > 0 {
            list(
                "bars",
                json!({ "id": format!("b{i}"), "nodes": [format!("f{}", i - 1), format!("f{i}")],
                    "material": "m", "section": "s" }),
            );
        }
    }
    rollers.into_iter().for_each(|roller| list("contacts", roller));
    for i in 0..nodes {
        for side in ["f", "g"] {
            value["nodes"][format!("{side}{i}")] = turned(between * i as f64 - 3.0, 0.0);
        }
    }
    scenario_text(value)
}

#[test]
fn a_footing_that_is_turned_answers_as_it_did() {
    let nodes = 27;
    let straight = Case::text(&footing(nodes, None)).solve(&[]);
    is_answer(&straight);
    assert!(count(&straight, State::Open) > 0);
    let (pressed, parted) = (of_pairs(&straight, |pair| pair.x_n), of_pairs(&straight, |pair| pair.z_n));
    near("the contacts carry the load", pressed.iter().sum(), 900.0, 1e-9, 900.0);
    for degrees in [30.0f64, 45.0, 217.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turned = Case::text(&footing(nodes, Some(degrees.to_radians()))).solve(&[]);
        is_answer(&turned);
        assert_eq!(states(&turned)[..nodes], states(&straight)[..], "{degrees}°");
        near_all("x_n", &of_pairs(&turned, |pair| pair.x_n)[..nodes], &pressed, 1e-9);
        near_all("z_n", &of_pairs(&turned, |pair| pair.z_n)[..nodes], &parted, 1e-9);
        for i in 0..nodes {
            let [x, y, turn] = displacement(&straight, &format!("f{i}"));
            near_all(
                &format!("f{i} at {degrees}°"),
                &displacement(&turned, &format!("f{i}")),
                &[cos * x - sin * y, sin * x + cos * y, turn],
                1e-9,
            );
        }
        for roller in &turned.pairs[nodes..] {
            assert_eq!((roller.state, roller.x_t, roller.bound, roller.z_n), (State::Closed, 0.0, 0.0, 0.0));
        }
    }
}

/// All working schemes of a turned footing, and the proof that its answer is the only one.
#[test]
fn a_turned_footing_has_as_many_answers_as_it_had() {
    let found = |turn: Option<f64>| {
        let report = report(&mut read(&footing(5, turn)), "enumerate").unwrap();
        (report["answers"].as_array().expect("a list").len(), report["complete"].clone())
    };
    let straight = found(None);
    assert_eq!(straight.0, 1);
    assert_eq!(found(Some(0.5)), straight);
    // Rollers do not count where a search is bounded by the number of pairs.
    let turned = Case::text(&footing(31, Some(0.5)));
    let system = turned.prepared.system().expect("pairs");
    assert_eq!((system.pair_count(), system.turning_pairs()), (31 + 32, 31));
}

/// A cantilever along x whose tip is held by a roller with the normal n:
///
/// ```text
///   u = C (F + x n), n·u = 0   ⇒   x = −n·C F / n·C n,   C = diag(L/EA, L³/3EI, L³/3EI)
/// ```
#[test]
fn a_cantilever_on_an_inclined_roller() {
    let (e, area, inertia, l) = (2.0e5, 0.3, 0.02, 4.0f64);
    let c = [l / (e * area), l.powi(3) / (3.0 * e * inertia), l.powi(3) / (3.0 * e * inertia)];
    let force = [30.0, -50.0, 20.0];
    let normal = [2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0];
    let compliance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * c[i] * b[i]).sum::<f64>();
    let x = -compliance(normal, force) / compliance(normal, normal);
    let moved: Vec<f64> = (0..3).map(|i| c[i] * (force[i] + x * normal[i])).collect();
    let answer = Case::json(json!({
        "dimension": 3,
        "materials": { "m": { "E": e, "nu": 0.2 } },
        "sections": { "s": { "area": area, "inertia_y": inertia, "inertia_z": inertia, "torsion": inertia } },
        "nodes": { "A": [0, 0, 0], "B": [l, 0, 0] },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": [{ "id": "c", "node": "B", "against": "ground", "normal": normal, "law": "bound", "bound": 0 }],
        "loads": { "p": { "items": [{ "point": { "at": "B", "force": force } }] } }
    }))
    .solve(&[]);
    is_answer(&answer);
    let [pair] = &answer.pairs[..] else { panic!() };
    assert_eq!(pair.state, State::Closed);
    near("x_n", pair.x_n, x, 1e-12, x);
    let space = pair.space.as_ref().expect("in space");
    let [n, t1] = space.frame.expect("a frame");
    let moved = [moved[0], moved[1], moved[2]];
    near_all("z_t", &space.z_t, &[dot(t1, moved), dot(cross(n, t1), moved)], 1e-12);
}

/// A body on two inclined rollers, held along the slope by nothing: it stands where the load is along the normal, with half of
/// it on each, and rolls away where it is not.
#[test]
fn a_body_that_only_rollers_carry() {
    let (sin, cos) = std::f64::consts::FRAC_PI_6.sin_cos();
    let roller = |node: &str| json!({ "id": format!("under-{node}"), "node": node, "against": "ground", "normal": [-sin, cos], "law": "bound", "bound": 0 });
    let case = Case::json(json!({
        "parameters": { "P": 10, "T": 0 },
        "nodes": { "A": [0, 0], "B": [2.0 * cos, 2.0 * sin], "C": [cos, sin] },
        "rigid": [{ "id": "body", "nodes": ["A", "B", "C"] }],
        "contacts": [roller("A"), roller("B")],
        "loads": {
            "press": { "factor": "P", "items": [{ "point": { "at": "C", "force": [sin, -cos] } }] },
            "pull": { "factor": "T", "items": [{ "point": { "at": "C", "force": [cos, sin] } }] }
        }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &[5.0, 5.0], 1e-12);
    mechanism(&case.solve(&[("T", 1e-3)]));
}
