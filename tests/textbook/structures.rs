//! Small structures solved by statics: skew pairs, chains of pairs, trusses, hinges, mixed laws, ties, loose bodies.

use serde_json::{Value, json};
use stickslip::answer::record::{OutcomeKind, State};
use stickslip::model::rules::{Covering, Rules};

use super::balance::check;
use crate::common::*;

/// A point on two equal springs against a skew plane:
///
/// ```text
///        F ↘  ⌇k           x_n = −F·n, and if |F·t| > f x_n: k z_τ = |F·t| − f x_n.
///     ─────●─⌇─ k          F·n > 0: open, z = F/k.
///    ╱╱╱╱ n ╱╱╱
/// ```
#[test]
fn point_on_springs_against_a_skew_ground() {
    let k = 250.0;
    for turn in 0..12 {
        let angle = 0.3 + 30f64.to_radians() * f64::from(turn);
        let n = [angle.cos(), angle.sin()];
        let t = [n[1], -n[0]];
        for (f, force) in [(0.3, [3.0, -4.0]), (0.0, [1.0, 2.0]), (2.0, [-5.0, 0.5]), (0.7, [0.0, 0.0])] {
            let case = Case::json(json!({
                "nodes": { "P": [1, 2] },
                "springs": [
                    { "at": "P", "direction": [1, 0], "stiffness": k },
                    { "at": "P", "direction": [0, 1], "stiffness": k }
                ],
                "contacts": [{ "id": "c", "node": "P", "against": "ground", "normal": n, "friction": f }],
                "loads": { "load": { "items": [{ "point": { "at": "P", "force": force } }] } }
            }));
            assert!(check(&case, &[], Rules::default()));
            let answer = case.solve(&[]);
            let pair = &answer.pairs[0];
            let along = |a: [f64; 2]| a[0] * force[0] + a[1] * force[1];
            let (fn_, ft) = (along(n), along(t));
            let expected = if fn_ > 0.0 {
                [0.0, 0.0, fn_ / k, ft / k]
            } else if ft.abs() <= -f * fn_ {
                [-fn_, -ft, 0.0, 0.0]
            } else {
                let x_t = f * fn_ * ft.signum();
                [-fn_, x_t, 0.0, (ft + x_t) / k]
            };
            let found = [pair.x_n, pair.x_t, pair.z_n * k, pair.z_t * k];
            let expected = [expected[0], expected[1], expected[2] * k, expected[3] * k];
            near_all("pair", &found, &expected, 1e-9);
        }
    }
}

/// Two points on springs, one against the other with a skew normal: the first carries F, the second only what the
/// pair hands over. Stick: x = −F k2/(k1 + k2) along n and t; slip: x_τ = ∓f x_n.
#[test]
fn point_against_point_with_a_skew_normal() {
    let (k1, k2) = (250.0, 100.0);
    for turn in 0..12 {
        let angle = 0.1 + 30f64.to_radians() * f64::from(turn);
        let n = [angle.cos(), angle.sin()];
        let t = [n[1], -n[0]];
        let force = [3.0, -4.0];
        for f in [0.0, 0.3, 1.0, 5.0] {
            let spring = |at: &str, d: [i32; 2], k: f64| json!({ "at": at, "direction": d, "stiffness": k });
            let case = Case::json(json!({
                "nodes": { "A": [1, 2], "B": [1, 2] },
                "springs": [
                    spring("A", [1, 0], k1), spring("A", [0, 1], k1),
                    spring("B", [1, 0], k2), spring("B", [0, 1], k2)
                ],
                "contacts": [{ "id": "c", "node": "A", "against": "B", "normal": n, "friction": f }],
                "loads": { "load": { "items": [{ "point": { "at": "A", "force": force } }] } }
            }));
            assert!(check(&case, &[], Rules::default()));
            let answer = case.solve(&[]);
            let pair = &answer.pairs[0];
            let along = |a: [f64; 2]| a[0] * force[0] + a[1] * force[1];
            let (fn_, ft) = (along(n), along(t));
            let share = k2 / (k1 + k2);
            let x_n = -fn_ * share;
            let expected = if fn_ > 0.0 {
                [0.0, 0.0, fn_ / k1, ft / k1]
            } else if ft.abs() * share <= f * x_n {
                [x_n, -ft * share, 0.0, 0.0]
            } else {
                let x_t = -f * x_n * ft.signum();
                [x_n, x_t, 0.0, (ft + x_t) / k1 + x_t / k2]
            };
            let found = [pair.x_n, pair.x_t, pair.z_n * k1, pair.z_t * k1];
            let expected = [expected[0], expected[1], expected[2] * k1, expected[3] * k1];
            near_all("pair", &found, &expected, 1e-9);
        }
    }
}

/// Three slabs on each other and on the ground, turned as a whole; G on each, H on the top one.
///
/// ```text
///     H ─▶ ┌────────┐ f3
///          ├────────┤ f2     slides where f_i × (weight above) is least: f1·3G, f2·2G, f3·G
///          ├────────┤ f1     p = (H − f_i W_i)/(5 (1 + f_i))
///         ╱╱╱╱╱╱╱╱╱╱
/// ```
fn slabs(angle: f64) -> Case {
    let (s, c) = angle.to_radians().sin_cos();
    let turn = |x: f64, y: f64| json!([c * x - s * y, s * x + c * y]);
    let plate = |i: usize| {
        json!({ "id": format!("s{i}"), "origin": turn(0.0, i as f64 - 1.0), "size": [8, 1], "divisions": [4, 1],
                "rotation": angle, "thickness": 1, "material": "m", "plane": "stress" })
    };
    let weight = |i: usize| json!({ "point": { "at": format!("s{i}.bottom"), "force": turn(0.0, -1.0) } });
    Case::json(json!({
        "parameters": { "f1": 0.5, "f2": 0.5, "f3": 0.5, "H": 0.1 },
        "materials": { "m": { "E": 1000, "nu": 0.3 } },
        "plates": [plate(1), plate(2), plate(3)],
        "contacts": [
            { "id": "g", "edge": "s1.bottom", "against": "ground", "friction": "f1" },
            { "id": "l", "edge": "s2.bottom", "against": "s1.top", "friction": "f2" },
            { "id": "u", "edge": "s3.bottom", "against": "s2.top", "friction": "f3" }
        ],
        "loads": {
            "weight": { "items": [weight(1), weight(2), weight(3)] },
            "push": { "factor": "H", "items": [{ "point": { "at": "s3.bottom", "force": turn(1.0, 0.0) } }] }
        }
    }))
}

#[test]
fn chain_of_slabs() {
    for angle in [0.0, 37.0, 90.0, 180.0, 211.0] {
        let case = slabs(angle);
        for (which, f) in [(0, [0.1, 0.5, 0.9]), (1, [0.5, 0.2, 0.9]), (2, [0.5, 0.5, 0.4]), (1, [1.2, 0.3, 1.7])] {
            let limits = [3.0 * f[0], 2.0 * f[1], f[2]];
            let limit = limits[which];
            assert!(limits.iter().all(|other| *other >= limit));
            let set = |h: f64| [("f1", f[0]), ("f2", f[1]), ("f3", f[2]), ("H", h)];
            for h in [0.0, 0.5 * limit, 0.95 * limit, limit * (1.0 - 1e-9)] {
                assert!(check(&case, &set(h), Rules::default()), "angle {angle}, f = {f:?}, H = {h}");
            }
            for (beyond, tolerance) in [(1.0 + 1e-9, 1e-5), (1.0 + 1e-6, 1e-7), (1.01, 1e-9)] {
                let h = limit * beyond;
                let answer = case.solve(&set(h));
                let ray = mechanism(&answer);
                close("p", ray.p, (h - limit) / (5.0 * (1.0 + f[which])), tolerance);
                for (i, pair) in ray.direction.pairs().iter().enumerate() {
                    let expected = f64::from(u8::from(i / 5 == which));
                    near("z̄_τ", pair.z_t.scalar(), expected, 1e-9, 1.0);
                    near("z̄_n", pair.z_n, 0.0, 1e-9, 1.0);
                }
            }
        }
    }
}

/// Two bars pinned at the apex on rough feet:
///
/// ```text
///            ▼ P
///            ●
///          ╱   ╲  h        x_n = P/2, thrust (P/2)·a/h (truss bars or hinged frames; feet slide apart
///         ●──a──┴──a──●    if f < a/h: p = (P/2)(a/h − f)/(1 + f))
/// ```
fn rafters(a: f64, h: f64, bar: &Value, loads: &Value) -> Case {
    let mut bars = Vec::new();
    for (id, nodes) in [("l", ["L", "top"]), ("r", ["top", "R"])] {
        let mut bar = bar.clone();
        bar["id"] = id.into();
        bar["nodes"] = json!(nodes);
        if id == "l" && bar["kind"] == "frame" {
            bar["hinges"] = json!(["end"]);
        }
        bars.push(bar);
    }
    Case::json(json!({
        "parameters": { "f": 1.0 },
        "materials": { "m": { "E": 2e8, "nu": 0.3 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
        "nodes": { "L": [-a, 0], "top": [0, h], "R": [a, 0] },
        "bars": bars,
        "contacts": [
            { "id": "cl", "node": "L", "against": "ground", "normal": [0, 1], "friction": "f" },
            { "id": "cr", "node": "R", "against": "ground", "normal": [0, 1], "friction": "f" }
        ],
        "loads": loads
    }))
}

#[test]
fn rafters_on_rough_feet() {
    let load = 10.0;
    let loads = json!({ "load": { "items": [{ "point": { "at": "top", "force": [0, -load] } }] } });
    for bar in [
        json!({ "kind": "truss", "material": "m", "section": "s" }),
        json!({ "kind": "frame", "material": "m", "section": "s" }),
        json!({ "kind": "frame", "material": "m", "section": "s", "divisions": 3 }),
    ] {
        for (a, h) in [(1.0, 2.0), (3.0, 4.0), (2.0, 2.0), (3.0, 2.0)] {
            let case = rafters(a, h, &bar, &loads);
            let limit = a / h;
            for f in [limit * (1.0 + 1e-9), limit * 1.1, 3.0] {
                assert!(check(&case, &[("f", f)], Rules::default()), "{bar} a = {a}, f = {f}");
                let answer = case.solve(&[("f", f)]);
                near_all("x_n", &of_pairs(&answer, |p| p.x_n), &[load / 2.0; 2], 1e-9);
                let thrust = load / 2.0 * limit;
                near_all("x_τ", &of_pairs(&answer, |p| p.x_t), &[thrust, -thrust], 1e-9);
            }
            for (below, tolerance) in [(1.0 - 1e-9, 1e-5), (1.0 - 1e-6, 1e-7), (0.9, 1e-9), (0.1, 1e-9)] {
                let f = limit * below;
                let answer = case.solve(&[("f", f)]);
                let ray = mechanism(&answer);
                let expected = load / 2.0 * (limit - f) / (1.0 + f);
                close(&format!("p, {bar}, a/h = {limit}, ×{below}"), ray.p, expected, tolerance);
            }
        }
    }
}

/// The same under its own weight q per length of bar: thrust q l a/(2 h), x_n = q l.
#[test]
fn hinged_rafters_under_a_line_load() {
    let (a, h, q) = (3.0f64, 4.0f64, 2.0);
    let length = a.hypot(h);
    let loads = json!({ "load": { "items": [
        { "line": { "bar": "l", "value": [0, -q] } }, { "line": { "bar": "r", "value": [0, -q] } }
    ] } });
    for divisions in [1, 2, 5] {
        let bar = json!({ "kind": "frame", "material": "m", "section": "s", "divisions": divisions });
        let case = rafters(a, h, &bar, &loads);
        let limit = a / (2.0 * h);
        assert!(check(&case, &[("f", 0.5)], Rules::default()));
        let answer = case.solve(&[("f", 0.5)]);
        near_all("x_n", &of_pairs(&answer, |p| p.x_n), &[q * length; 2], 1e-9);
        let thrust = q * length * limit;
        near_all("x_τ", &of_pairs(&answer, |p| p.x_t), &[thrust, -thrust], 1e-9);
        // At the hinge and at the feet no moment; at the apex N is the horizontal thrust's share.
        let members = answer.members.as_ref().unwrap();
        near("M at the foot", members[0].start.m, 0.0, 1e-9, q * length * length);
        near("M at the hinge", members[divisions - 1].end.m, 0.0, 1e-9, q * length * length);
        near("N at the apex", members[divisions - 1].end.n, -thrust * a / length, 1e-9, thrust);
        for f in [0.3, 0.1, 0.0] {
            let answer = case.solve(&[("f", f)]);
            close("p", mechanism(&answer).p, q * length * (limit - f) / (1.0 + f), 1e-9);
        }
    }
}

/// A ladder on a rough floor against a smooth wall:
///
/// ```text
///     ▒●          wall force P b/(2 h) = friction at the foot, at most f P;
///     ▒ ╲ ▼ P     slides if f < b/(2 h): p = P (b/(2 h) − f)/(1 + f)
///     ▒  ╲   h
///        ▁●▁ b
/// ```
#[test]
fn ladder() {
    let (b, h, load) = (1.5, 3.0, 80.0);
    let case = Case::json(json!({
        "parameters": { "f": 0.5 },
        "materials": { "m": { "E": 1e7, "nu": 0.3 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-5 } },
        "nodes": { "foot": [b, 0], "head": [0, h] },
        "bars": [{ "id": "ladder", "nodes": ["foot", "head"], "material": "m", "section": "s", "divisions": 2 }],
        "contacts": [
            { "id": "floor", "node": "foot", "against": "ground", "normal": [0, 1], "friction": "f" },
            { "id": "wall", "node": "head", "against": "ground", "normal": [1, 0], "law": "frictionless" }
        ],
        "loads": { "load": { "items": [{ "point": { "at": "ladder/1", "force": [0, -load] } }] } }
    }));
    let limit = b / (2.0 * h);
    for f in [limit * (1.0 + 1e-9), 0.3, 1.0, 4.0] {
        assert!(check(&case, &[("f", f)], Rules::default()), "f = {f}");
        let answer = case.solve(&[("f", f)]);
        let (floor, wall) = (&answer.pairs[0], &answer.pairs[1]);
        close("floor", floor.x_n, load, 1e-9);
        close("wall", wall.x_n, load * limit, 1e-9);
        close("friction", floor.x_t, -load * limit, 1e-9);
        assert_eq!(floor.state, State::Stick);
        assert_eq!(wall.state, State::Closed);
    }
    for (below, tolerance) in [(1.0 - 1e-9, 1e-5), (1.0 - 1e-6, 1e-7), (0.9, 1e-9), (0.0, 1e-9)] {
        let f = limit * below;
        for rule in [Covering::Cohesive, Covering::Ones] {
            let answer = case.solve_under(&[("f", f)], covering(rule));
            let ray = mechanism(&answer);
            let d = if rule == Covering::Ones { 1.0 } else { 1.0 + f };
            close(&format!("p, ×{below}"), ray.p, load * (limit - f) / d, tolerance);
            near("z̄_τ of the foot", ray.direction.pairs()[0].z_t.scalar(), 1.0, 1e-9, 1.0);
        }
    }
}

/// A bar pushed towards a wall behind a gap: u = P l/EA − (what the wall takes); x_n = P − g EA/l once it closes.
#[test]
fn bar_closes_a_gap() {
    let (length, ea) = (2.0, 1e4);
    for kind in ["truss", "frame"] {
        let supports = json!([{ "at": "A", "fixed": if kind == "frame" { json!(["x", "y", "r"]) } else { json!(["x", "y"]) } },
                              { "at": "B", "fixed": ["y"] }]);
        let case = Case::json(json!({
            "parameters": { "P": 10.0, "g": 0.001 },
            "materials": { "m": { "E": 1e6, "nu": 0.3 } },
            "sections": { "s": { "area": 0.01, "inertia": 1e-5 } },
            "nodes": { "A": [0, 0], "B": [length, 0] },
            "bars": [{ "id": "b", "nodes": ["A", "B"], "kind": kind, "material": "m", "section": "s" }],
            "supports": supports,
            "contacts": [{ "id": "c", "node": "B", "against": "ground", "normal": [-1, 0], "law": "frictionless", "gap": "g" }],
            "loads": { "push": { "factor": "P", "items": [{ "point": { "at": "B", "force": [1, 0] } }] } }
        }));
        for (load, gap) in [(10.0, 0.001), (10.0, 0.0), (10.0, 0.003), (-10.0, 0.0), (-10.0, 0.001)] {
            let set = [("P", load), ("g", gap)];
            assert!(check(&case, &set, Rules::default()));
            let answer = case.solve(&set);
            let pair = &answer.pairs[0];
            let free = load * length / ea;
            if free > gap {
                close("x_n", pair.x_n, load - gap * ea / length, 1e-9);
            } else {
                close("z_n", pair.z_n, gap - free, 1e-9);
            }
            // Compression from A's support: N = −(load − x_n).
            let n = answer.members.as_ref().unwrap()[0].start.n;
            near("N", n, load - pair.x_n, 1e-9, 10.0);
        }
    }
}

/// Cohesion glues a pulled point up to c along t; once open it still holds along t (and a note says so).
#[test]
fn cohesion() {
    let k = 100.0;
    let case = Case::json(json!({
        "parameters": { "c": 1.0, "Fx": 0.0, "Fy": 0.0 },
        "nodes": { "P": [0, 0] },
        "springs": [
            { "at": "P", "direction": [1, 0], "stiffness": k },
            { "at": "P", "direction": [0, 1], "stiffness": k }
        ],
        "contacts": [{ "id": "c", "node": "P", "against": "ground", "normal": [0, 1], "friction": 0.5, "cohesion": "c" }],
        "loads": {
            "x": { "factor": "Fx", "items": [{ "point": { "at": "P", "force": [1, 0] } }] },
            "y": { "factor": "Fy", "items": [{ "point": { "at": "P", "force": [0, 1] } }] }
        }
    }));
    for (fx, fy, c) in [
        (2.0, -1.0, 1.0),
        (1.4, -1.0, 1.0),
        (-3.0, -2.0, 0.5),
        (0.5, 2.0, 1.0),
        (3.0, 2.0, 1.0),
        (-3.0, 2.0, 1.0),
        (-3.0, 2.0, 0.0),
    ] {
        let set = [("Fx", fx), ("Fy", fy), ("c", c)];
        assert!(check(&case, &set, Rules::default()), "{set:?}");
        let answer = case.solve(&set);
        let pair = &answer.pairs[0];
        let x_n = (-fy).max(0.0);
        let bound = 0.5 * x_n + c;
        let x_t = -fx.clamp(-bound, bound);
        let found = [pair.x_n, pair.x_t, pair.z_n * k, pair.z_t * k, pair.bound];
        near_all("pair", &found, &[x_n, x_t, fy.max(0.0), fx + x_t, bound], 1e-9);
        assert_eq!(answer.notes.is_empty(), !(fy > 0.0 && c > 0.0), "{:?}", answer.notes);
    }
}

/// All laws in one structure: points on springs, coupled by a stiff truss chain so that they feel each other.
#[test]
fn mixed_laws_in_one_structure() {
    let laws = [
        json!({ "law": "coulomb", "friction": 0.3 }),
        json!({ "law": "frictionless" }),
        json!({ "law": "bound", "bound": 1.5 }),
        json!({ "law": "coulomb", "friction": 2.0, "cohesion": 0.2, "gap": 0.001 }),
        json!({ "law": "frictionless", "gap": 0.002 }),
        json!({ "law": "coulomb", "friction": 0.0 }),
    ];
    let mut answers = 0;
    for seed in 0..40u32 {
        let wave = |k: usize, phase: f64| (f64::from(seed) * 1.7 + k as f64 * 2.3 + phase).sin();
        let mut nodes = serde_json::Map::new();
        let (mut springs, mut contacts, mut bars, mut items) = (vec![], vec![], vec![], vec![]);
        for (k, law) in laws.iter().enumerate() {
            let id = format!("n{k}");
            nodes.insert(id.clone(), json!([k as f64, 0.2 * wave(k, 0.0)]));
            for d in [[1, 0], [0, 1]] {
                springs.push(json!({ "at": id, "direction": d, "stiffness": 300.0 }));
            }
            let mut contact = law.clone();
            contact["id"] = format!("c{k}").into();
            contact["node"] = id.clone().into();
            contact["against"] = "ground".into();
            contact["normal"] = json!([0.5 * wave(k, 1.0), 1.0]);
            contacts.push(contact);
            if k > 0 {
                let kind = if k % 2 == 0 { "truss" } else { "frame" };
                bars.push(json!({ "id": format!("b{k}"), "nodes": [format!("n{}", k - 1), id], "kind": kind,
                                  "material": "m", "section": "s" }));
            }
            items.push(json!({ "point": { "at": id, "force": [8.0 * wave(k, 2.0), 6.0 * wave(k, 3.0) - 3.0] } }));
        }
        let case = Case::json(json!({
            "materials": { "m": { "E": 1e6, "nu": 0.3 } },
            "sections": { "s": { "area": 0.01, "inertia": 1e-5 } },
            "nodes": nodes, "bars": bars, "springs": springs, "contacts": contacts,
            "loads": { "load": { "items": items } }
        }));
        answers += usize::from(check(&case, &[], Rules::default()));
    }
    // It stands without its contacts: always an answer.
    assert_eq!(answers, 40);
}

/// Two plates tied along their common edge are one plate.
#[test]
fn tied_plates_are_one_plate() {
    let common = |plates: Value, ties: Value, top: &str| {
        Case::json(json!({
            "parameters": { "f": 0.4, "H": 0.2 },
            "materials": { "m": { "E": 1000, "nu": 0.2 } },
            "plates": plates, "ties": ties,
            "contacts": [{ "id": "base", "edge": "a.bottom", "against": "ground", "friction": "f" }],
            "loads": {
                "weight": { "items": [{ "point": { "at": format!("{top}.top"), "force": [0, -1] } }] },
                "push": { "factor": "H", "items": [{ "point": { "at": format!("{top}.top"), "force": [1, 0] } }] }
            }
        }))
    };
    let plate = |id: &str, y: f64, height: f64, divisions: [usize; 2]| {
        json!({ "id": id, "origin": [0, y], "size": [1, height], "divisions": divisions,
                "thickness": 1, "material": "m", "plane": "stress" })
    };
    let one = common(json!([plate("a", 0.0, 2.0, [4, 8])]), json!([]), "a");
    let ties: Vec<Value> = (0..=4).map(|i| json!({ "nodes": [format!("a[{i},4]"), format!("b[{i},0]")] })).collect();
    let two = common(json!([plate("a", 0.0, 1.0, [4, 4]), plate("b", 1.0, 1.0, [4, 4])]), json!(ties), "b");
    for set in
        [[("f", 0.4), ("H", 0.2)], [("f", 0.2), ("H", 0.19)], [("f", 0.4), ("H", 0.26)], [("f", 0.2), ("H", 0.23)]]
    {
        let (a, b) = (one.solve(&set), two.solve(&set));
        assert_eq!(a.outcome, b.outcome);
        near("p", b.p, a.p, 1e-9, 1.0);
        assert_eq!(states(&a), states(&b));
        near_all("x_n", &of_pairs(&b, |p| p.x_n), &of_pairs(&a, |p| p.x_n), 1e-9);
        near_all("x_τ", &of_pairs(&b, |p| p.x_t), &of_pairs(&a, |p| p.x_t), 1e-9);
        check(&two, &set, Rules::default());
    }
}

/// A loose beam on three legs of pairs at skew bearings: two planes of a V, smooth or rough.
///
/// ```text
///     ╲   ▼P  ╱      slopes ±45°, smooth: x_n = P/√2 each when loaded in the middle;
///      ●──●──●       loaded off the middle it runs away sideways
/// ```
#[test]
fn beam_in_a_vee() {
    let case = Case::json(json!({
        "parameters": { "f": 0.0, "M": 0.0, "P": 10.0 },
        "materials": { "m": { "E": 1e6, "nu": 0.3 } },
        "sections": { "s": { "area": 0.01, "inertia": 1e-5 } },
        "nodes": { "A": [-1, 1], "C": [0, 1], "B": [1, 1] },
        "bars": [
            { "id": "l", "nodes": ["A", "C"], "material": "m", "section": "s" },
            { "id": "r", "nodes": ["C", "B"], "material": "m", "section": "s" }
        ],
        "contacts": [
            { "id": "a", "node": "A", "against": "ground", "normal": [1, 1], "friction": "f" },
            { "id": "b", "node": "B", "against": "ground", "normal": [-1, 1], "friction": "f" }
        ],
        "loads": {
            "load": { "factor": "P", "items": [{ "point": { "at": "C", "force": [0, -1] } }] },
            "turn": { "factor": "M", "items": [{ "point": { "at": "C", "force": [0, 0], "moment": 1 } }] }
        }
    }));
    let root = 2f64.sqrt();
    assert!(check(&case, &[], Rules::default()));
    let answer = case.solve(&[]);
    near_all("x_n", &of_pairs(&answer, |p| p.x_n), &[10.0 / root; 2], 1e-9);
    // Rough planes hold a moment: the beam turns about the instantaneous centre at (0, 0)… up to a limit.
    for f in [0.1, 0.3, 0.8] {
        assert!(check(&case, &[("f", f), ("M", 0.5 * f)], Rules::default()));
        let answer = case.solve(&[("f", f), ("M", 1000.0)]);
        assert_eq!(answer.outcome, OutcomeKind::Ray, "f = {f}");
    }
    // Smooth planes hold none: the smallest moment is a mechanism.
    let answer = case.solve(&[("M", 1e-3)]);
    mechanism(&answer);
}
