//! Guides: two opposed pairs at the tip of a cantilever, whose joints repeat one another.
//!
//! ```text
//!     ▽ g₂
//!   ══●───────────▒   k = 3EI/L³, k_a = EA/L
//!     △ g₁
//! ```

use serde_json::{Value, json};
use stickslip::answer::record::{RayClass, State, Verdict};
use stickslip::path::end::PathEnd;
use stickslip::path::sensitivity::sensitivity;
use stickslip::path::{friction, load};

use crate::common::*;

pub const EA: f64 = 500.0;
pub const EI: f64 = 1000.0;
pub const L: f64 = 10.0;
/// g₁ and g₂ of the scenarios.
pub const CLEARANCES: [f64; 2] = [0.01, 0.02];

/// A cantilever turned by some angle with a guide at its tip.
pub fn guide(angle: f64) -> Case {
    let (sin, cos) = angle.sin_cos();
    let turn = |x: f64, y: f64| json!([cos * x - sin * y, sin * x + cos * y]);
    let pair = |id: &str, n: f64, gap: &str| json!({ "id": id, "node": "B", "against": "ground", "normal": turn(0.0, n), "friction": "f", "gap": gap });
    Case::json(json!({
        "parameters": { "P": 1, "T": 0, "f": 0.3, "g1": 0.01, "g2": 0.02 },
        "materials": { "m": { "E": 1, "nu": 0 } },
        "sections": { "s": { "area": EA, "inertia": EI } },
        "nodes": { "A": turn(0.0, 0.0), "B": turn(L, 0.0) },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "r"] }],
        "contacts": [pair("low", 1.0, "g1"), pair("up", -1.0, "g2")],
        "loads": {
            "press": { "factor": "P", "items": [{ "point": { "at": "B", "force": turn(0.0, -1.0) } }] },
            "pull": { "factor": "T", "items": [{ "point": { "at": "B", "force": turn(1.0, 0.0) } }] }
        }
    }))
}

/// The answer of a guide whose sides have the clearances g₁ and g₂, under P towards the first and an axial T.
pub struct Guided {
    /// What the sides carry.
    pub x: [f64; 2],
    /// How far each is open.
    pub gaps: [f64; 2],
    /// Slip of the tip along the axis.
    pub slip: f64,
    /// Friction of both sides on the tip, along the axis.
    pub friction: f64,
}

/// The tip moves by P/k until a side closes; that side carries P − k g, and holds an axial force up to f times that; the
/// rest stretches the bar (k = 3EI/L³, k_a = EA/L).
pub fn with_clearances(p: f64, t: f64, [g1, g2]: [f64; 2], f: f64) -> Guided {
    let (k, k_a) = (3.0 * EI / L.powi(3), EA / L);
    let x = [f64::max(p - k * g1, 0.0), f64::max(-p - k * g2, 0.0)];
    let down = (p / k).clamp(-g2, g1);
    let held = f * (x[0] + x[1]);
    let slip = (t.abs() - held).max(0.0) * t.signum() / k_a;
    Guided { x, gaps: [g1 - down, g2 + down], slip, friction: -t.signum() * t.abs().min(held) }
}

/// See [`with_clearances`].
#[test]
fn guide_with_clearances() {
    for angle in [0.0, 0.5, 2.2, -1.1] {
        let case = guide(angle);
        for (p, t) in
            [(1.0, 0.0), (1.0, 0.2), (1.0, 0.5), (1.0, -0.5), (-1.0, 0.2), (-1.0, 0.7), (0.02, 0.3), (0.0, -0.3)]
        {
            let answer = case.solve(&[("P", p), ("T", t)]);
            is_answer(&answer);
            let [low, up] = &answer.pairs[..] else { panic!() };
            let right = with_clearances(p, t, CLEARANCES, 0.3);
            let what = format!("P = {p}, T = {t}, angle {angle}");
            near(&what, low.x_n, right.x[0], 1e-12, 1.0);
            near(&what, up.x_n, right.x[1], 1e-12, 1.0);
            near(&what, low.z_n, right.gaps[0], 1e-12, CLEARANCES[0]);
            near(&what, up.z_n, right.gaps[1], 1e-12, CLEARANCES[1]);
            near(&what, low.z_t, right.slip, 1e-12, 0.01);
            near(&what, up.z_t, -right.slip, 1e-12, 0.01);
            // t is opposite on the two sides
            near(&what, low.x_t - up.x_t, right.friction, 1e-12, 1.0);
        }
    }
}

/// Without clearance the sides share what presses: x_low − x_up = P, and of least norm is (P, 0). The axial force is held up
/// to f P; beyond, the bar stretches by (T − f P)/k_a.
#[test]
fn guide_without_clearance() {
    let case = guide(0.0);
    for (p, t) in [(1.0, 0.2), (1.0, 0.5), (-2.0, 0.5), (-2.0, -0.9), (0.0, 0.5)] {
        let answer = case.solve(&[("P", p), ("T", t), ("g1", 0.0), ("g2", 0.0)]);
        is_answer(&answer);
        let [low, up] = &answer.pairs[..] else { panic!() };
        near("x_low", low.x_n, p.max(0.0), 1e-12, 1.0);
        near("x_up", up.x_n, (-p).max(0.0), 1e-12, 1.0);
        near("z", low.z_n.max(up.z_n), 0.0, 1e-12, 0.01);
        let slip = (t.abs() - 0.3 * p.abs()).max(0.0) * t.signum() / (EA / L);
        near("slip", low.z_t, slip, 1e-12, 0.01);
        near("slip", up.z_t, -slip, 1e-12, 0.01);
    }
    let note = |case: &Case, t: f64, g2: f64, f: f64| {
        let answer = case.solve(&[("P", 1.0), ("T", t), ("g1", 0.0), ("g2", g2), ("f", f)]);
        is_answer(&answer);
        answer.notes.join(" ")
    };
    // Wedged by s the sides hold f (P + 2 s) against T: sticking or slipping, other self-stress holds more.
    for t in [0.2, 0.5] {
        let text = note(&case, t, 0.0, 0.3);
        assert!(text.contains("low and up") && text.contains("least norm for the motion shown"), "{text}");
        assert!(text.contains("another self-stress may hold another motion"), "{text}");
    }
    // Without friction s changes no motion; with a clearance above there is none.
    let text = note(&case, 0.2, 0.0, 0.0);
    assert!(text.contains("low and up") && text.contains("motion does not depend on how they share"), "{text}");
    assert!(!text.contains("another motion"), "{text}");
    assert_eq!(note(&case, 0.2, 0.01, 0.3), "");
}

/// Sides nearer to each other than the node is wide: no displacement opens both.
#[test]
fn guide_with_interference_has_no_answer() {
    let case = guide(0.3);
    let answer = case.solve(&[("g1", -0.03), ("g2", 0.02)]);
    let ray = answer.ray.as_ref().expect("no answer");
    assert_eq!((ray.class, ray.verdict), (RayClass::NoEquilibrium, Some(Verdict::Certified)));
    assert!(ray.explanation.contains("distances of pairs low and up sum up to -0.01"), "{}", ray.explanation);
    // With room for both it is the guide with clearances moved: the low side pushes the tip up by 0.01.
    let answer = case.solve(&[("g1", -0.01), ("g2", 0.02)]);
    is_answer(&answer);
    near("x_low", answer.pairs[0].x_n, 1.0 + 3.0 * EI / L.powi(3) * 0.01, 1e-12, 1.0);
    near("z_up", answer.pairs[1].z_n, 0.01, 1e-12, 0.01);
}

#[test]
fn states_of_a_guide() {
    let answer = guide(0.0).solve(&[("P", 1.0)]);
    assert_eq!(states(&answer), [State::Stick, State::Open]);
}

/// A guide with clearances along its loads and its friction: P from 1 to −1 opens the low side at k g₁ and closes the upper
/// one at −k g₂; T = 0.5 slips on the low side for f < T/(P − k g₁); with P = 1 the tip stretches by (T − f (P − k g₁))/k_a.
#[test]
fn paths_and_sensitivities_of_a_guide() {
    let (k, k_a, f) = (3.0 * EI / L.powi(3), EA / L, 0.3);
    let case = guide(0.4);
    let mut values = case.scenario.parameter_values();
    values.insert("T".to_owned(), 0.5).expect("a parameter");
    let solved = case.solved(&[("T", 0.5)], case.scenario.rules);
    let (prepared, scenario) = (&case.prepared, &case.scenario);
    let reach = load::LoadReach { to: Some(-1.0), through: false };
    let path = load::trace(prepared.case(scenario, &values), Some(&solved), "P", reach).expect("a path");
    assert_eq!(path.end, PathEnd::Target);
    let at: Vec<f64> = path.breakpoints.iter().map(|breakpoint| breakpoint.value).collect();
    near_all("breakpoints", &at, &[k * 0.01, -k * 0.02], 1e-12);
    let path = friction::trace(prepared.case(scenario, &values), Some(&solved), "f", 1.0).expect("a path");
    let at: Vec<f64> = path.breakpoints.iter().map(|breakpoint| breakpoint.value).collect();
    near_all("breakpoints", &at, &[0.5 / (1.0 - k * 0.01)], 1e-11);
    let found = sensitivity(prepared.case(scenario, &values), &solved).expect("rates");
    let of = |name: &str| &found.parameters.iter().find(|rate| rate.parameter == name).expect("a parameter").pairs[0];
    let pressed = 1.0 - k * 0.01;
    near("dz_t/df", of("f").z_t, -pressed / k_a, 1e-12, 0.01);
    near("dx_t/df", of("f").x_t, -pressed, 1e-12, 1.0);
    near("dz_t/dP", of("P").z_t, -f / k_a, 1e-12, 0.01);
    near("dx_n/dP", of("P").x_n, 1.0, 1e-12, 1.0);
    near("dx_n/dg1", of("g1").x_n, -k, 1e-12, k);
    near("dz_t/dg1", of("g1").z_t, f * k / k_a, 1e-12, 0.01);
    near("dz_t/dT", of("T").z_t, 1.0 / k_a, 1e-12, 0.01);
    let up = &found.parameters.iter().find(|rate| rate.parameter == "g2").expect("a parameter").pairs[1];
    near("dz_n/dg2", up.z_n, 1.0, 1e-12, 1.0);
}

/// Two pairs held both ways at one node, friction bounds 0.1 and 0.05: the tip is held along n, and along the bar up to the
/// sum of the bounds.
#[test]
fn bounds_of_a_clamp_add_up() {
    let mut value: Value = serde_json::from_str(&guide(0.0).scenario.text).expect("json");
    for (i, bound) in [0.1, 0.05].into_iter().enumerate() {
        let pair = value["contacts"][i].as_object_mut().expect("a pair");
        pair.remove("friction");
        pair.remove("gap");
        pair.insert("law".into(), "bound".into());
        pair.insert("bound".into(), bound.into());
    }
    let case = Case::json(value);
    for t in [0.12, 0.5, -0.5_f64] {
        let answer = case.solve(&[("T", t)]);
        is_answer(&answer);
        let [low, up] = &answer.pairs[..] else { panic!() };
        near("pressed", low.x_n - up.x_n, 1.0, 1e-12, 1.0);
        near("friction", low.x_t - up.x_t, -t.signum() * t.abs().min(0.15), 1e-12, 1.0);
        near("slip", low.z_t, t.signum() * (t.abs() - 0.15).max(0.0) / (EA / L), 1e-12, 0.01);
    }
}
