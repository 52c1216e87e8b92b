//! Beam on a tensionless elastic foundation, equal forces at both ends.
//!
//! ```text
//!     F                                       F
//!     ▼                                       ▼
//!     ●═══════════════════════════════════════●       α⁴ = k/(4 EI)
//!     ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊  ┊       frictionless pairs
//!     o  o  o  o  o  o  o  o  o  o  o  o  o  o
//!     ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇  ⌇       springs k·h
//!     |◀─ c ─▶|     lifted off        |◀─ c ─▶|
//! ```
//!
//! Full contact up to αl = π. Beyond, on 0 ≤ x ≤ c: y'''' + 4 α⁴ y = 0 with EI y'' = 0, EI y''' = −F at the end (sense of
//! signs aside), and y = 0, y''' = 0, y' + y'' (l/2 − c) = 0 at c, since the lifted part carries a constant moment.
//! Half of the beam is modelled; the middle does not turn.

use nalgebra::{Matrix4, Vector4};
use serde_json::json;
use stickslip::answer::record::{Answer, OutcomeKind, State};

use crate::common::*;

/// α = 1, EI = 1, so k = 4; the half beam of length `half`, its first `reach` on the foundation in `n` elements, the
/// rest (sure to lift off) one element.
fn half_beam(half: f64, reach: f64, n: usize) -> Case {
    let h = reach / n as f64;
    let mut nodes = serde_json::Map::new();
    let mut springs = Vec::new();
    let mut contacts = Vec::new();
    let mut bars = Vec::new();
    let middle = if reach < half { "middle".to_owned() } else { format!("a{n}") };
    let mut supports = vec![json!({ "at": middle, "fixed": ["x", "r"] })];
    for i in 0..=n {
        let (a, b) = (format!("a{i}"), format!("b{i}"));
        nodes.insert(a.clone(), json!([h * i as f64, 0]));
        nodes.insert(b.clone(), json!([h * i as f64, 0]));
        let share = if i == 0 || i == n { 0.5 } else { 1.0 };
        springs.push(json!({ "at": b, "direction": [0, 1], "stiffness": 4.0 * h * share }));
        supports.push(json!({ "at": b, "fixed": ["x"] }));
        contacts
            .push(json!({ "id": format!("c{i}"), "node": a, "against": b, "normal": [0, 1], "law": "frictionless" }));
        if i > 0 {
            bars.push(
                json!({ "id": format!("e{i}"), "nodes": [format!("a{}", i - 1), a], "material": "m", "section": "s" }),
            );
        }
    }
    if reach < half {
        nodes.insert(middle.clone(), json!([half, 0]));
        bars.push(json!({ "id": "rest", "nodes": [format!("a{n}"), middle], "material": "m", "section": "s" }));
    }
    Case::json(json!({
        "materials": { "m": { "E": 1, "nu": 0 } },
        "sections": { "s": { "area": 1, "inertia": 1 } },
        "nodes": nodes, "bars": bars, "supports": supports, "springs": springs, "contacts": contacts,
        "loads": { "ends": { "items": [{ "point": { "at": "a0", "force": [0, -1] } }] } }
    }))
}

/// (c, |M_mid|) for α = F = EI = 1 by the differential equation: bisection in c.
fn exact(half: f64) -> (f64, f64) {
    // y = e^{-x}(A cos + B sin) + e^{x}(C cos + D sin); derivatives of the four terms.
    let terms = |x: f64| -> [Vector4<f64>; 4] {
        let (s, c) = x.sin_cos();
        let (d, g) = ((-x).exp(), x.exp());
        // (cos, sin) coefficients of each derivative: decaying: A → (−A+B), B → (−A−B); growing: C → (C+D), D → (−C+D)
        let mut m = [[1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        [0, 1, 2, 3].map(|_| {
            let row = Vector4::from_fn(|i, _| {
                let e = if i < 2 { d } else { g };
                e * (m[i][0] * c + m[i][1] * s)
            });
            for (i, [a, b]) in m.iter_mut().enumerate() {
                let sign = if i < 2 { -1.0 } else { 1.0 };
                (*a, *b) = (sign * *a + *b, -*a + sign * *b);
            }
            row
        })
    };
    // y''(0) = 0, y'''(0) = 1, y(c) = 0, y'''(c) = 0; what is left: y'(c) + y''(c)(half − c).
    let solve = |c: f64| {
        let (start, end) = (terms(0.0), terms(c));
        let a =
            Matrix4::from_rows(&[start[2].transpose(), start[3].transpose(), end[0].transpose(), end[3].transpose()]);
        let y = a.lu().solve(&Vector4::new(0.0, 1.0, 0.0, 0.0)).unwrap();
        (end[1].dot(&y) + end[2].dot(&y) * (half - c), end[2].dot(&y).abs())
    };
    let (mut low, mut high) = (0.3, 1.5);
    assert!(solve(low).0 * solve(high).0 < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if solve(middle).0 * solve(low).0 > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, solve(low).1)
}

/// (c, |M_mid|) of an answer: c where the pressure, linear beside its end, reaches zero.
fn measured(answer: &Answer, h: f64) -> (f64, f64) {
    let last = answer.pairs.iter().rposition(|p| p.state == State::Closed).unwrap();
    assert!(answer.pairs[..=last].iter().all(|p| p.state == State::Closed));
    let y = displacement(answer, &format!("a{last}"))[1];
    let next = displacement(answer, &format!("a{}", last + 1))[1];
    let c = h * (last as f64 + y / (y - next));
    let middle = answer.members.as_ref().unwrap().last().unwrap().end.m;
    (c, middle.abs())
}

#[test]
fn contact_length_and_moment() {
    for (length, c, moment) in [(4.0, 1.08301, 0.33789), (5.0, 0.94347, 0.30262), (8.0, 0.75940, 0.24905)] {
        let half = length / 2.0;
        let (exact_c, exact_moment) = exact(half);
        printed("αc by the equation", exact_c, c, 1e-5);
        printed("M α/F by the equation", exact_moment, moment, 1e-5);
        // The error of lumped springs falls as h²: refined once and extrapolated. c falls into the middle of an element
        // in both meshes, so that their errors are alike. (Much finer elements gain nothing in f64: their 12 EI/h³
        // drowns the springs.)
        let found = [60, 120].map(|inside| {
            let h = c / (inside as f64 + 0.5);
            let n = inside + inside / 4;
            let answer = half_beam(half, n as f64 * h, n).solve(&[]);
            is_answer(&answer);
            // The part without a foundation has lifted off.
            assert!(displacement(&answer, "middle")[1] > 0.0);
            measured(&answer, h)
        });
        let extrapolated = |coarse: f64, fine: f64| (4.0 * fine - coarse) / 3.0;
        printed("αc", extrapolated(found[0].0, found[1].0), c, 1e-5);
        printed("M α/F", extrapolated(found[0].1, found[1].1), moment, 1e-5);
        for (c, moment) in found {
            near("αc", c, exact_c, 3e-4, 1.0);
            near("M α/F", moment, exact_moment, 3e-4, 1.0);
        }
    }
}

#[test]
fn full_contact_up_to_pi() {
    for half in [0.5, 1.0, 1.5] {
        let answer = half_beam(half, half, 100).solve(&[]);
        assert_eq!(answer.outcome, OutcomeKind::Trivial);
        is_answer(&answer);
        assert_eq!(count(&answer, State::Closed), 101);
        // The foundation carries F.
        let carried: f64 = answer.pairs.iter().map(|p| p.x_n).sum();
        close("Σ x_n", carried, 1.0, 1e-9);
    }
    let beyond = half_beam(1.6, 1.6, 100).solve(&[]);
    is_answer(&beyond);
    assert!(count(&beyond, State::Open) > 0);
}
