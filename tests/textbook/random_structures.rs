//! Random structures: two bodies of bars and quads, on the ground, on each other, on springs and ties, all laws. There
//! is no closed form; every answer must balance, fit its displacements and obey its laws, every ray must be one that
//! a loose structure may have, and a turned or mirrored structure must do the same.
//!
//! ```text
//!     a3 ─── a4 ─── a5        body a: bars, some trusses, hinges
//!     │  ╲   │      │
//!     a0 ─── a1 ─── a2        nodes a0 … a2 may touch b0 … b2 (same place) along any normal
//!     b0 ─── b1 ─── b2
//!     │    ▒ │ ▒    │         body b: bars and two quads
//!     b3 ─── b4 ─── b5        on the ground: pairs, springs, supports
//! ```

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, OutcomeKind, RayClass, State};
use stickslip::model::load::load_text;
use stickslip::model::rules::Rules;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

use super::balance::check;
use crate::common::*;

/// Columns of a rotation or reflection.
type Turn = [[f64; 2]; 2];

fn turned(q: &Turn, v: [f64; 2]) -> [f64; 2] {
    [q[0][0] * v[0] + q[1][0] * v[1], q[0][1] * v[0] + q[1][1] * v[1]]
}

fn mirrored(q: &Turn) -> bool {
    q[0][0] * q[1][1] - q[0][1] * q[1][0] < 0.0
}

/// The bars of both bodies; what each is depends on `bits`.
fn bars(bits: &[bool]) -> Vec<Value> {
    let mut bars = Vec::new();
    for (body, edges) in [
        ("a", vec![(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5), (0, 4)]),
        ("b", vec![(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)]),
    ] {
        for (k, (from, to)) in edges.into_iter().enumerate() {
            let slot = k + if body == "a" { 0 } else { 8 };
            let truss = k >= 7 || bits[slot] && k % 3 == 1;
            let mut bar = json!({ "id": format!("{body}_{from}{to}"), "nodes": [format!("{body}{from}"), format!("{body}{to}")],
                                  "kind": if truss { "truss" } else { "frame" }, "material": "steel", "section": "bar" });
            if !truss && bits[20 + slot] && k % 2 == 0 {
                bar["hinges"] = json!(["end"]);
            }
            if bits[40 + slot % 8] && !truss {
                bar["divisions"] = (1 + slot % 3).into();
            }
            bars.push(bar);
        }
    }
    bars
}

fn structure(seed: u64, q: &Turn) -> String {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut chance = |p: f64| rng.random_bool(p);
    let bits: Vec<bool> = (0..64).map(|_| chance(0.5)).collect();
    let loose = chance(0.4);
    let with_quads = chance(0.5);
    let with_tie = chance(0.3);
    let mut number = |low: f64, high: f64| rng.random_range(low..high);
    let turn = |v: [f64; 2]| json!(turned(q, v));
    let bulge = number(-0.3, 0.3);
    let mut nodes = serde_json::Map::new();
    for (body, y) in [("a", [0.0, 1.0]), ("b", [0.0, -1.2])] {
        for i in 0..6 {
            let x = (i % 3) as f64 + if i >= 3 { 0.2 * bulge } else { 0.0 };
            let lift = if i % 3 == 1 { bulge } else { 0.0 };
            let lift = if i < 3 { lift } else { 0.3 * lift };
            nodes.insert(format!("{body}{i}"), turn([x, y[i / 3] + lift]));
        }
    }
    let bars = bars(&bits);
    let quad = |id: &str, mut corners: Vec<&str>| {
        if mirrored(q) {
            corners.reverse();
        }
        json!({ "id": id, "nodes": corners, "thickness": 0.05, "material": "brick", "plane": "stress" })
    };
    let quads = if with_quads {
        vec![quad("q1", vec!["b3", "b4", "b1", "b0"]), quad("q2", vec!["b4", "b5", "b2", "b1"])]
    } else {
        Vec::new()
    };
    let (mut contacts, mut springs, mut supports, mut ties) = (vec![], vec![], vec![], vec![]);
    let law = |contact: &mut Value, number: &mut dyn FnMut(f64, f64) -> f64| {
        match number(0.0, 10.0) as usize {
            0 => contact["law"] = "frictionless".into(),
            1 => {
                contact["law"] = "bound".into();
                contact["bound"] = number(0.0, 5.0).into();
            }
            2 => contact["friction"] = number(1.0, 4.0).into(),
            3 => contact["cohesion"] = number(0.0, 2.0).into(),
            _ => contact["friction"] = number(0.0, 0.9).into(),
        }
        if contact["law"] != "bound" && number(0.0, 1.0) < 0.15 {
            contact["gap"] = number(0.0, 0.001).into();
        }
    };
    for i in 0..3 {
        if with_tie && i == 1 {
            ties.push(json!({ "nodes": ["a1", "b1"] }));
            continue;
        }
        let normal = turn([number(-0.6, 0.6), 1.0]);
        let mut contact =
            json!({ "id": format!("ab{i}"), "node": format!("a{i}"), "against": format!("b{i}"), "normal": normal });
        law(&mut contact, &mut number);
        contacts.push(contact);
    }
    for i in 3..6 {
        if !loose && i == 3 {
            supports.push(json!({ "at": "b3", "fixed": ["x", "y", "r"] }));
            continue;
        }
        let normal = turn([number(-0.3, 0.3), 1.0]);
        let mut contact =
            json!({ "id": format!("g{i}"), "node": format!("b{i}"), "against": "ground", "normal": normal });
        law(&mut contact, &mut number);
        contacts.push(contact);
    }
    if bits[60] {
        springs
            .push(json!({ "at": "a5", "direction": turn([number(-1.0, 1.0), 1.0]), "stiffness": number(10.0, 1e5) }));
    }
    if bits[61] && bits[62] {
        for d in [[1.0, 0.0], [0.0, 1.0]] {
            springs.push(json!({ "at": "a0", "direction": turn(d), "stiffness": 1e4 }));
            springs.push(json!({ "at": "b4", "direction": turn(d), "stiffness": 1e3 }));
        }
        springs.push(json!({ "at": "a3", "direction": turn([1.0, 0.3]), "stiffness": 1e4 }));
    }
    let mut items = Vec::new();
    for at in ["a3", "a4", "a5", "b1"] {
        let force = turn([number(-4.0, 4.0), number(-20.0, 1.0)]);
        items.push(json!({ "point": { "at": at, "force": force } }));
    }
    items.push(json!({ "line": { "bar": "a_34", "value": turn([number(-1.0, 1.0), number(-5.0, 0.0)]) } }));
    items.push(json!({ "line": { "bar": "b_14", "value": turn([number(-1.0, 1.0), number(-1.0, 0.0)]) } }));
    scenario_text(json!({
        "materials": { "steel": { "E": 2e7, "nu": 0.3 }, "brick": { "E": 1e6, "nu": 0.2 } },
        "sections": { "bar": { "area": 0.01, "inertia": 2e-5 } },
        "nodes": nodes, "bars": bars, "quads": quads, "ties": ties, "supports": supports, "springs": springs,
        "contacts": contacts, "loads": { "load": { "items": items } }
    }))
}

const STRAIGHT: Turn = [[1.0, 0.0], [0.0, 1.0]];

/// The case, or the message of what is wrong with it.
fn case(seed: u64, q: &Turn) -> Result<Case, String> {
    let text = structure(seed, q);
    let scenario = load_text("random", &text, None).map_err(|e| format!("{e}\n{text}"))?;
    match prepare(&scenario, &Quiet) {
        Ok(prepared) => Ok(Case { scenario, prepared }),
        Err(e) => Err(e.to_string()),
    }
}

#[test]
fn every_answer_stands_up_to_statics() {
    let (mut answers, mut rays, mut refused) = (0, 0, 0);
    for seed in 0..400 {
        let case = match case(seed, &STRAIGHT) {
            Ok(case) => case,
            Err(message) => {
                assert!(message.contains("mechanism") || message.contains("joint"), "seed {seed}: {message}");
                refused += 1;
                continue;
            }
        };
        let system = case.prepared.system().unwrap();
        let stiffness = &system.stiffness;
        let lost = (stiffness * &system.kernel).amax();
        assert!(lost <= 1e-13 * stiffness.amax(), "seed {seed}: R Z = {lost:e}");
        assert_eq!(*stiffness, stiffness.transpose(), "seed {seed}");
        let answer = case.solve(&[]);
        if answer.is_answer() {
            answers += 1;
            check(&case, &[], Rules::default());
        } else {
            rays += 1;
            let ray = answer.ray.unwrap_or_else(|| panic!("seed {seed}: {:?}", answer.failure));
            assert!(matches!(ray.class, RayClass::Mechanism | RayClass::NoEquilibrium), "seed {seed}: {ray:?}");
            assert!(system.kernel.ncols() > 0, "seed {seed}");
        }
    }
    println!("{answers} answers, {rays} rays, {refused} refused");
    assert!(answers > 150 && rays > 20, "{answers} answers, {rays} rays, {refused} refused");
}

fn compare(what: &str, a: &Answer, b: &Answer, sign: f64) {
    assert_eq!(a.outcome, b.outcome, "{what}");
    assert_eq!(a.pivots.len(), b.pivots.len(), "{what}");
    let size = |all: &[f64]| all.iter().fold(1e-30f64, |a, b| a.max(b.abs()));
    for (name, tangential, x, y) in [
        ("x_n", false, of_pairs(a, |p| p.x_n), of_pairs(b, |p| p.x_n)),
        ("x_τ", true, of_pairs(a, |p| p.x_t), of_pairs(b, |p| p.x_t)),
        ("z_n", false, of_pairs(a, |p| p.z_n), of_pairs(b, |p| p.z_n)),
        ("z_τ", true, of_pairs(a, |p| p.z_t), of_pairs(b, |p| p.z_t)),
    ] {
        let sign = if tangential { sign } else { 1.0 };
        let scale = size(&x);
        // At a ray the vertex may be far off (z large beside what it carries).
        let tolerance = if a.outcome == OutcomeKind::Ray { 1e-6 } else { 1e-8 };
        for (x, y) in x.iter().zip(&y) {
            near(&format!("{name}, {what}"), *y, sign * x, tolerance, scale);
        }
    }
    for (x, y) in states(a).into_iter().zip(states(b)) {
        let flipped = match x {
            State::SlipPlus if sign < 0.0 => State::SlipMinus,
            State::SlipMinus if sign < 0.0 => State::SlipPlus,
            other => other,
        };
        assert_eq!(flipped, y, "{what}");
    }
    assert_eq!(a.ray.as_ref().map(|r| r.class), b.ray.as_ref().map(|r| r.class), "{what}");
    near(what, b.p, a.p, 1e-7, a.p.max(1e-3));
}

#[test]
fn turned_and_mirrored_structures_do_the_same() {
    let (s, c) = 0.7f64.sin_cos();
    let mut compared = 0;
    for seed in 0..150 {
        let straight = case(seed, &STRAIGHT);
        for (name, q) in [
            ("turned", [[c, s], [-s, c]]),
            ("upside down", [[-1.0, 0.0], [0.0, -1.0]]),
            ("mirrored", [[-1.0, 0.0], [0.0, 1.0]]),
            ("turned and mirrored", [[c, s], [s, -c]]),
        ] {
            let other = case(seed, &q);
            match (&straight, &other) {
                (Ok(a), Ok(b)) => {
                    compared += 1;
                    let sign = if mirrored(&q) { -1.0 } else { 1.0 };
                    let what = format!("seed {seed}, {name}");
                    compare(&what, &a.solve(&[]), &b.solve(&[]), sign);
                }
                (Err(_), Err(_)) => {}
                (Ok(_), Err(e)) | (Err(e), Ok(_)) => {
                    panic!("seed {seed}, {name}: only one is refused: {e}")
                }
            }
        }
    }
    assert!(compared > 200, "{compared}");
}
