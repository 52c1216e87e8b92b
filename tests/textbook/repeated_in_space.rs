//! Joints in space that repeat one another: a pipe shoe between guides, blocks that meet in corners.
//!
//! ```text
//!        z │  guide (n = ∓y, clearance g)            ┌────┬────┐
//!          │ ▒●▒                                     │ a  │ b  │  head joint a|b and two joints with the ground:
//!          └──▲──── y   shoe (n = z)                 └────┴────┘  at their common edge z_ab = z_a − z_b
//! ```

use nalgebra::{Rotation3, Vector3};
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, OutcomeKind, RayClass, State, Verdict};
use stickslip::model::rules::Rules;
use stickslip::path::sensitivity::sensitivity;

use super::guides::{CLEARANCES, EA, EI, L, with_clearances};
use crate::common::*;

pub(super) fn vector(rotation: &Rotation3<f64>, x: f64, y: f64, z: f64) -> Value {
    json!((rotation * Vector3::new(x, y, z)).as_slice())
}

/// A cantilever along x whose tip is pressed by N, pushed aside by P and pulled by T; shoe and guides as given.
pub(super) fn guided(rotation: &Rotation3<f64>, contacts: &[(&str, [f64; 3], &str, &str)]) -> Case {
    let v = |x: f64, y: f64, z: f64| vector(rotation, x, y, z);
    let load = |force: Value| json!([{ "point": { "at": "B", "force": force } }]);
    let contacts: Vec<Value> = (contacts.iter())
        .map(|(id, [x, y, z], friction, gap)| {
            json!({ "id": id, "node": "B", "against": "ground", "normal": v(*x, *y, *z), "tangent": v(1.0, 0.0, 0.0),
                    "friction": friction, "gap": gap })
        })
        .collect();
    Case::json(json!({
        "dimension": 3,
        "parameters": { "P": 1, "T": 0, "N": 0, "f": 0.3, "s": 0.0, "g1": 0.01, "g2": 0.02, "zero": 0 },
        "materials": { "m": { "E": 1, "nu": 0 } },
        "sections": { "s": { "area": EA, "inertia_y": EI, "inertia_z": EI, "torsion": EI } },
        "nodes": { "A": v(0.0, 0.0, 0.0), "B": v(L, 0.0, 0.0) },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "orientation": v(0.0, 1.0, 0.0) }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": contacts,
        "loads": {
            "press": { "factor": "N", "items": load(v(0.0, 0.0, -1.0)) },
            "push": { "factor": "P", "items": load(v(0.0, -1.0, 0.0)) },
            "pull": { "factor": "T", "items": load(v(1.0, 0.0, 0.0)) }
        }
    }))
}

pub(super) const SIDES: [(&str, [f64; 3], &str, &str); 2] =
    [("low", [0.0, 1.0, 0.0], "f", "g1"), ("up", [0.0, -1.0, 0.0], "f", "g2")];

pub(super) fn turned() -> Vec<Rotation3<f64>> {
    let turn = |x: f64, y: f64, z: f64| Rotation3::new(Vector3::new(x, y, z));
    vec![Rotation3::identity(), turn(0.3, -0.7, 1.1), turn(-1.9, 0.2, 0.4)]
}

/// See [`with_clearances`].
#[test]
fn guide_with_clearances_in_space() {
    for rotation in turned() {
        let case = guided(&rotation, &SIDES);
        for (p, t) in [(1.0, 0.0), (1.0, 0.2), (1.0, 0.5), (1.0, -0.5), (-1.0, 0.7), (0.02, 0.3), (0.0, -0.3)] {
            let answer = case.solve(&[("P", p), ("T", t)]);
            is_answer(&answer);
            let [low, up] = &answer.pairs[..] else { panic!() };
            let right = with_clearances(p, t, CLEARANCES, 0.3);
            let what = format!("P = {p}, T = {t}, {rotation}");
            near(&what, low.x_n, right.x[0], 1e-9, 1.0);
            near(&what, up.x_n, right.x[1], 1e-9, 1.0);
            near(&what, low.z_n, right.gaps[0], 1e-9, CLEARANCES[0]);
            near(&what, up.z_n, right.gaps[1], 1e-9, CLEARANCES[1]);
            near_all(&what, &low.slip(), &[right.slip, 0.0], 1e-9);
            near_all(&what, &up.slip(), &[right.slip, 0.0], 1e-9);
            near(&what, low.friction()[0] + up.friction()[0], right.friction, 1e-9, 1.0);
        }
    }
}

/// Of two floors under a shoe the upper one carries N, the other stays open by g1, whichever of them is named first;
/// along them the tip slips by (T − f N)/k_a.
#[test]
fn shoe_above_two_floors() {
    let (k_a, n, f, g1) = (EA / L, 1.5, 0.2, 0.01);
    let floors = [("far", [0.0, 0.0, 1.0], "f", "g1"), ("near", [0.0, 0.0, 1.0], "f", "zero")];
    for rotation in turned() {
        for first in [0, 1] {
            let case = guided(&rotation, &[floors[first], floors[1 - first]]);
            for t in [0.0, 0.1, 0.8] {
                let answer = case.solve(&[("f", f), ("N", n), ("P", 0.0), ("T", t)]);
                is_answer(&answer);
                let pair = |id: &str| answer.pairs.iter().find(|pair| pair.id == id).expect("a pair");
                near("near", pair("near").x_n, n, 1e-9, 1.0);
                near("far", pair("far").x_n, 0.0, 1e-9, 1.0);
                near("open", pair("far").z_n, g1, 1e-9, g1);
                near("slip", pair("near").slip()[0], (t - f * n).max(0.0) / k_a, 1e-9, 1.0 / k_a);
                near("friction", pair("near").friction()[0], -t.min(f * n), 1e-9, 1.0);
            }
        }
    }
}

/// A shoe under N between guides: the tip slips aside by g1 and along by u, where
///
/// ```text
///     k_a u = T − f_s N u/√(u² + g1²) − f x,     x = P − k g1 − f_s N g1/√(u² + g1²)   (the guide's force)
/// ```
#[test]
fn shoe_between_guides() {
    let (k, k_a) = (3.0 * EI / L.powi(3), EA / L);
    let (f, s, n, p, t, g1) = (0.2, 0.4, 1.5, 2.0, 1.2, 0.01);
    let guide = |u: f64| p - k * g1 - s * n * g1 / u.hypot(g1);
    let (mut low, mut high) = (0.0, t / k_a);
    for _ in 0..200 {
        let u = 0.5 * (low + high);
        let rest = t - s * n * u / f64::hypot(u, g1) - f * guide(u) - k_a * u;
        if rest > 0.0 { low = u } else { high = u }
    }
    let u = 0.5 * (low + high);
    assert!(u > 1e-3 && guide(u) > 0.1, "the case is one of slip along the guide: {u}, {}", guide(u));
    for rotation in turned() {
        let [low, up] = SIDES;
        let case = guided(&rotation, &[("shoe", [0.0, 0.0, 1.0], "s", "zero"), low, up]);
        let answer = case.solve(&[("f", f), ("s", s), ("N", n), ("P", p), ("T", t)]);
        is_answer(&answer);
        let [shoe, low, up] = &answer.pairs[..] else { panic!() };
        near("shoe", shoe.x_n, n, 1e-9, 1.0);
        near("guide", low.x_n, guide(u), 1e-9, 1.0);
        assert_eq!((shoe.state, low.state, up.state), (State::Slip, State::Slip, State::Open));
        near("along", shoe.slip()[0], u, 1e-9, u);
        near("aside", shoe.slip()[1].abs(), g1, 1e-9, g1);
        near("friction of the guide", low.friction()[0], -f * guide(u), 1e-9, 1.0);
        near("friction of the shoe", shoe.friction()[0], -s * n * u / u.hypot(g1), 1e-9, 1.0);
    }
}

/// Without clearance and friction the sides hold the tip aside: x_low − x_up = P, of least norm (P, 0); a note says so.
#[test]
fn guide_without_clearance_in_space() {
    let case = guided(&Rotation3::identity(), &SIDES);
    let answer = case.solve(&[("g1", 0.0), ("g2", 0.0), ("f", 0.0), ("P", 0.7), ("T", 0.3)]);
    is_answer(&answer);
    let [low, up] = &answer.pairs[..] else { panic!() };
    near_all("sides", &[low.x_n, up.x_n], &[0.7, 0.0], 1e-9);
    near("along", low.slip()[0], 0.3 * L / EA, 1e-9, 1e-3);
    assert!(answer.notes.iter().any(|note| note.contains("repeat one another")), "{:?}", answer.notes);
}

/// Sides that overlap have no answer, whatever the friction, and that is proved: z_low + z_up = g1 + g2 < 0.
#[test]
fn guide_with_interference_in_space() {
    let case = guided(&Rotation3::identity(), &SIDES);
    let answer = case.solve(&[("g1", -0.01), ("g2", 0.004)]);
    assert_eq!(answer.outcome, OutcomeKind::Ray);
    let ray = answer.ray.expect("a ray");
    assert_eq!((ray.class, ray.verdict, ray.misfit), (RayClass::NoEquilibrium, Some(Verdict::Certified), true));
    assert!(ray.explanation.contains("sum up to -0.006"), "{}", ray.explanation);
}

/// `blocks` in a row on rough ground with head joints between them, the first pushed by H, each with a top load of 1.
pub(super) fn row(blocks: usize) -> Case {
    let id = |i: usize| format!("b{i}");
    let bricks: Vec<Value> = (0..blocks)
        .map(|i| {
            json!({ "id": id(i), "origin": [2 * i, 0, 0], "size": [2, 1, 1], "divisions": [2, 1, 1], "material": "m" })
        })
        .collect();
    let floor = (0..blocks).map(|i| {
        json!({ "id": format!("floor{i}"), "face": format!("{}.bottom", id(i)), "against": "ground", "friction": 0.5 })
    });
    let heads = (1..blocks).map(|i| {
        json!({ "id": format!("head{i}"), "face": format!("{}.left", id(i)), "against": format!("{}.right", id(i - 1)),
                "friction": 0.3 })
    });
    let weights: Vec<Value> =
        (0..blocks).map(|i| json!({ "point": { "at": format!("{}.top", id(i)), "force": [0, 0, -1] } })).collect();
    Case::json(json!({
        "dimension": 3,
        "parameters": { "H": 0 },
        "materials": { "m": { "E": 1000, "nu": 0.2 } },
        "bricks": bricks,
        "contacts": floor.chain(heads).collect::<Vec<_>>(),
        "loads": { "weight": { "items": weights },
                   "push": { "factor": "H", "items": [{ "point": { "at": "b0.left", "force": [1, 0, 0] } }] } }
    }))
}

/// Three blocks in a row stand under their weight and slide together beyond f W: what a push meets is the friction of
/// all floors, Σ x_n is the weight, and the sums of forces do not depend on how the corners share them.
#[test]
fn a_row_of_blocks_slides_as_one() {
    let (case, weight, f) = (row(3), 3.0, 0.5);
    let sum = |answer: &Answer, read: fn(&stickslip::answer::record::PairState) -> f64| -> f64 {
        answer.pairs.iter().filter(|pair| pair.id.starts_with("floor")).map(read).sum()
    };
    // some of them where a slip has just begun
    for h in [0.0, 0.4, 0.779, 0.7795, 0.7805, 0.9, 1.239, 1.3] {
        let answer = case.solve(&[("H", h)]);
        is_answer(&answer);
        near("weight", sum(&answer, |pair| pair.x_n), weight, 1e-9, 1.0);
        near("push", sum(&answer, |pair| pair.friction()[0]), -h, 1e-9, 1.0);
        near("across", sum(&answer, |pair| pair.friction()[1]), 0.0, 1e-9, 1.0);
    }
    let answer = case.solve(&[("H", f * weight * (1.0 + 1e-4))]);
    assert_eq!(answer.ray.expect("a collapse").verdict, Some(Verdict::Certified));
}

/// `cone off`: the answer on the polygon of 8 facets, exact along a facet and 1/cos 22.5° too strong between two. Pulled
/// along the bar the guide holds f x; pulled at 22.5° from it, it holds what the cone does not.
#[test]
fn a_guide_on_its_polygon() {
    let case = guided(&Rotation3::identity(), &SIDES);
    let off = Rules { cone: false, ..case.scenario.rules };
    let (f, corner) = (0.3, std::f64::consts::FRAC_PI_8);
    for (p, t) in [(1.0, 0.2), (1.0, 0.5), (-1.0, 0.7), (0.02, 0.3)] {
        let answer = case.solve_under(&[("P", p), ("T", t)], off);
        is_answer(&answer);
        assert!(!answer.polygon.expect("in space").cone);
        let right = with_clearances(p, t, CLEARANCES, f);
        near_all("x", &of_pairs(&answer, |pair| pair.x_n), &right.x, 1e-10);
        near("slip", answer.pairs[0].slip()[0], right.slip, 1e-10, 0.01);
        let friction: f64 = answer.pairs.iter().map(|pair| pair.friction()[0]).sum();
        near("friction", friction, right.friction, 1e-10, 1.0);
    }
    // Without clearance below, so that only the friction of the lower side holds the tip along x and z: x = P.
    for (share, slips) in [(0.99, false), (1.01, true)] {
        let held = share * f / corner.cos();
        let set = [("P", 1.0), ("g1", 0.0), ("T", held * corner.cos()), ("N", held * corner.sin())];
        let answer = case.solve_under(&set, off);
        is_answer(&answer);
        near("pressed", answer.pairs[0].x_n, 1.0, 1e-10, 1.0);
        assert_eq!(answer.pairs[0].state == State::Slip, slips, "{share}");
        assert_eq!(case.solve(&set).pairs[0].state, State::Slip, "the cone holds f only");
    }
}

/// Derivatives of the guide with clearances, while the tip slips on its lower side: x = P − k g1, k_a u = T − f x.
#[test]
fn sensitivities_of_a_guide_in_space() {
    let (k, k_a, f) = (3.0 * EI / L.powi(3), EA / L, 0.3);
    for rotation in turned() {
        let case = guided(&rotation, &SIDES);
        let solved = case.solved(&[("T", 0.5)], case.scenario.rules);
        let mut values = case.scenario.parameter_values();
        values.insert("T".to_owned(), 0.5).expect("a parameter");
        let found = sensitivity(case.prepared.case(&case.scenario, &values), &solved).expect("rates");
        let of = |name: &str, pair: usize| {
            found.parameters.iter().find(|rate| rate.parameter == name).expect("a parameter").pairs[pair].clone()
        };
        let pressed = 1.0 - k * 0.01;
        let along = |name: &str| of(name, 0).space.expect("in space").map(|[along, _]| along);
        for (name, x_t, z_t, x_n) in [
            ("f", -pressed, -pressed / k_a, 0.0),
            ("P", -f, -f / k_a, 1.0),
            ("T", 0.0, 1.0 / k_a, 0.0),
            ("g1", f * k, f * k / k_a, -k),
        ] {
            near_all(name, &along(name), &[x_t, z_t], 1e-10);
            near(name, of(name, 0).x_n, x_n, 1e-10, 1.0);
            // The other side moves with it.
            near(name, of(name, 1).space.expect("in space")[1][0], z_t, 1e-10, 0.1);
        }
        near("clearance", of("g2", 1).z_n, 1.0, 1e-10, 1.0);
        near("closed", of("g1", 1).z_n, 1.0, 1e-10, 1.0);
    }
    // Held on both sides without clearance it shares its forces at will, and that has no derivative.
    let case = guided(&Rotation3::identity(), &SIDES);
    let mut values = case.scenario.parameter_values();
    for gap in ["g1", "g2"] {
        values.insert(gap.to_owned(), 0.0).expect("a parameter");
    }
    let solved = case.prepared.case(&case.scenario, &values).solve().expect("solved");
    let refused = sensitivity(case.prepared.case(&case.scenario, &values), &solved).expect_err("undetermined");
    assert!(refused.to_string().contains("no derivative of its own"), "{refused}");
}

/// The guide given by its compliance W = B K⁻¹ Bᵀ of rank 3, B the rows n, t1, t2 of both sides: its answers are those of
/// the structure.
#[test]
fn a_singular_compliance_in_space() {
    let compliance = Vector3::new(L / EA, L.powi(3) / (3.0 * EI), L.powi(3) / (3.0 * EI));
    let rows: Vec<Vector3<f64>> =
        [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
            .map(Vector3::from)
            .to_vec();
    let moved =
        |force: Vector3<f64>| rows.iter().map(|row| row.dot(&compliance.component_mul(&force))).collect::<Vec<_>>();
    let matrix: Vec<Vec<f64>> = rows.iter().map(|row| moved(*row)).collect();
    let case = Case::json(json!({
        "parameters": { "P": 1, "T": 0, "f": 0.3 },
        "contact_system": {
            "pairs": ["low", "up"], "tangents": 2, "compliance": matrix, "friction": ["f", "f"], "gap": CLEARANCES,
            "loads": { "push": { "factor": "P", "vector": moved(Vector3::new(0.0, -1.0, 0.0)) },
                       "pull": { "factor": "T", "vector": moved(Vector3::new(1.0, 0.0, 0.0)) } }
        }
    }));
    let off = Rules { cone: false, ..case.scenario.rules };
    for (p, t) in [(1.0, 0.0), (1.0, 0.2), (1.0, 0.5), (-1.0, 0.7), (0.02, 0.3)] {
        for rules in [case.scenario.rules, off] {
            let answer = case.solve_under(&[("P", p), ("T", t)], rules);
            is_answer(&answer);
            let right = with_clearances(p, t, CLEARANCES, 0.3);
            near_all("x", &of_pairs(&answer, |pair| pair.x_n), &right.x, 1e-10);
            near_all("z", &of_pairs(&answer, |pair| pair.z_n), &right.gaps, 1e-10);
            answer.pairs.iter().for_each(|pair| near("slip", pair.slip()[0], right.slip, 1e-10, 0.01));
            let friction: f64 = answer.pairs.iter().map(|pair| pair.friction()[0]).sum();
            near("friction", friction, right.friction, 1e-10, 1.0);
        }
    }
}
