//! Bar on n frictional supports (Popov & Lovtsov 2020, Example 1).
//!
//! ```text
//!     F      F      F      F      F      F
//!     ▼      ▼      ▼      ▼      ▼      ▼
//!     ●──L───●──L───●──L───●──L───●──L───●──▶ F2        EA, EI
//!     ▲      ▲      ▲      ▲      ▲      ▲
//!  j= n     n−1            …      2      1              r = f F at every support
//! ```
//!
//! With k = ⌊F2/r⌋ and ρ = F2 − k r the slip of support j, counted from the pulled end, is
//!
//! ```text
//!     z_j = (L/EA)·[(k−j+1) ρ + r (k−j)(k−j+1)/2]   for j ≤ k, else 0
//! ```
//!
//! friction is r for j ≤ k and ρ at j = k+1. Beyond F2 = n r it slides away, and what is missing per pair is
//! p = (F2 − n f F)/(n d_τ), with d_τ = 1 + f (cohesive), 1 (ones), f (weight).

use serde_json::json;
use stickslip::answer::record::{OutcomeKind, State};
use stickslip::model::rules::Covering;

use crate::common::*;

const AREA: f64 = 0.0025;
const E: f64 = 2e8;

/// The beam on `n` supports at distance `length`.
fn beam(n: usize, length: f64) -> Case {
    let name = |i: usize| format!("s{}", i + 1);
    let nodes: serde_json::Map<_, _> = (0..n).map(|i| (name(i), json!([length * i as f64, 0]))).collect();
    let bars: Vec<_> = (1..n)
        .map(|i| {
            json!({ "id": format!("b{i}"), "nodes": [name(i - 1), name(i)],
                    "material": "steel", "section": "beam" })
        })
        .collect();
    let contacts: Vec<_> = (0..n)
        .map(|i| {
            json!({ "id": format!("c{}", i + 1), "node": name(i), "against": "ground",
                    "normal": [0, 1], "friction": "f" })
        })
        .collect();
    let weights: Vec<_> = (0..n).map(|i| json!({ "point": { "at": name(i), "force": [0, -1] } })).collect();
    Case::json(json!({
        "parameters": { "f": 0.3, "F": 100.0, "F2": 0.0 },
        "materials": { "steel": { "E": E, "nu": 0.3 } },
        "sections": { "beam": { "area": AREA, "inertia": 2e-5 } },
        "nodes": nodes, "bars": bars, "contacts": contacts,
        "loads": {
            "weight": { "factor": "F", "items": weights },
            "pull": { "factor": "F2", "items": [{ "point": { "at": name(n - 1), "force": [1, 0] } }] }
        }
    }))
}

/// (slips, frictions) from the left, by the formula.
fn closed_form(n: usize, unit: f64, r: f64, pull: f64) -> (Vec<f64>, Vec<f64>) {
    // A hair above the step itself: at F2 = k r both formulas agree.
    let k = ((pull / r + 1e-12).floor() as usize).min(n);
    let rho = pull - k as f64 * r;
    (0..n)
        .rev()
        .map(|j| {
            // j counts from 0 here: j + 1 of the formula.
            let slip = if j < k {
                let a = (k - j) as f64;
                unit * (a * rho + r * (a - 1.0) * a / 2.0)
            } else {
                0.0
            };
            let friction = match j.cmp(&k) {
                std::cmp::Ordering::Less => r,
                std::cmp::Ordering::Equal => rho,
                std::cmp::Ordering::Greater => 0.0,
            };
            (slip, friction)
        })
        .unzip()
}

/// Slips, forces and states against the formula.
#[track_caller]
fn agrees(case: &Case, n: usize, unit: f64, r: f64, pull: f64, set: &[(&str, f64)]) {
    for rule in Covering::ALL {
        let answer = case.solve_under(set, covering(rule));
        is_answer(&answer);
        let what = format!("{rule}, n = {n}, F2 = {pull}");
        let (slips, friction) = closed_form(n, unit, r, pull);
        near_all(&format!("z_τ, {what}"), &of_pairs(&answer, |p| p.z_t), &slips, 1e-9);
        let force = of_pairs(&answer, |p| -p.x_t);
        for (found, expected) in force.iter().zip(&friction) {
            near(&format!("x_τ, {what}"), *found, *expected, 1e-9, r);
        }
        for pair in &answer.pairs {
            close(&format!("x_n, {what}"), pair.x_n, 100.0, 1e-9);
            assert_eq!(pair.z_n, 0.0);
        }
    }
}

#[test]
fn printed_figures_of_six_supports() {
    // L/EA = 1: slips from the pulled end.
    let unit = 5.0 / (E * AREA);
    let case = beam(6, 5.0);
    for (pull, expected) in [
        (100.0, [120.0, 50.0, 10.0, 0.0, 0.0, 0.0]),
        (150.0, [300.0, 180.0, 90.0, 30.0, 0.0, 0.0]),
        (180.0, [450.0, 300.0, 180.0, 90.0, 30.0, 0.0]),
    ] {
        let answer = case.solve(&[("F2", pull)]);
        assert_eq!(answer.outcome, OutcomeKind::Normal);
        is_answer(&answer);
        let mut slips = of_pairs(&answer, |p| p.z_t / unit);
        slips.reverse();
        near_all("z_τ", &slips, &expected, 1e-9);
    }
    let ray = case.solve(&[("F2", 181.0)]);
    close("p", mechanism(&ray).p, 1.0 / (6.0 * 1.3), 1e-9);
}

#[test]
fn trivial_up_to_the_friction_of_one_support() {
    let case = beam(6, 5.0);
    for pull in [0.0, 1.0, 15.0, 29.999999] {
        for rule in Covering::ALL {
            let answer = case.solve_under(&[("F2", pull)], covering(rule));
            assert_eq!(answer.outcome, OutcomeKind::Trivial);
            assert!(answer.pivots.is_empty());
            assert_eq!(count(&answer, State::Stick), 6);
            near("x_τ at the pull", -answer.pairs[5].x_t, pull, 1e-9, 30.0);
        }
    }
}

#[test]
fn slips_by_the_formula_for_all_lengths() {
    for n in [3, 6, 9] {
        for length in [1.0, 3.0, 6.0, 12.0] {
            let case = beam(n, length);
            let unit = length / (E * AREA);
            let r = 30.0;
            for k in 0..n {
                for part in [0.25, 0.5, 0.9, 1.0] {
                    let pull = r * (k as f64 + part);
                    agrees(&case, n, unit, r, pull, &[("F2", pull)]);
                }
            }
            let below = n as f64 * r * (1.0 - 1e-9);
            agrees(&case, n, unit, r, below, &[("F2", below)]);
        }
    }
}

#[test]
fn pivots_follow_the_formula() {
    // Pivot 0: p = (F2 − r)/d_τ; after pivot k: (F2 − (k+1) r)/((k+1) d_τ), while that is positive.
    let case = beam(6, 5.0);
    let answer = case.solve(&[("F2", 175.0)]);
    assert_eq!(answer.pivots.len(), 6);
    for (k, pivot) in answer.pivots.iter().enumerate() {
        let k1 = (k + 1) as f64;
        let expected = ((175.0 - k1 * 30.0) / (k1 * 1.3)).max(0.0);
        near("p", pivot.p, expected, 1e-9, 100.0);
        assert_eq!(pivot.step, k);
    }
    assert_eq!(answer.pivots[0].entering, "p");
    assert_eq!(answer.pivots[0].leaving, "x+[c6]");
    assert_eq!(answer.pivots[1].entering, "z+[c6]");
    assert_eq!(answer.pivots[5].leaving, "p");
}

#[test]
fn exactly_at_the_limit_it_stands() {
    for n in [3, 6, 9] {
        for length in [1.0, 3.0, 5.0, 6.0, 12.0] {
            let case = beam(n, length);
            let limit = n as f64 * 30.0;
            for rule in Covering::ALL {
                let answer = case.solve_under(&[("F2", limit)], covering(rule));
                assert_eq!(answer.outcome, OutcomeKind::Normal, "n = {n}, L = {length}, {rule}");
            }
            agrees(&case, n, length / (E * AREA), 30.0, limit, &[("F2", limit)]);
        }
    }
}

#[test]
fn beyond_the_limit_p_is_what_is_missing() {
    for n in [3, 6, 9] {
        for length in [1.0, 3.0, 6.0, 12.0] {
            let case = beam(n, length);
            for f in [0.3, 0.5, 0.75, 1.5] {
                let limit = n as f64 * f * 100.0;
                for (beyond, tolerance) in
                    [(1.0 + 1e-9, 1e-5), (1.0 + 1e-6, 1e-7), (1.01, 1e-9), (1.1, 1e-9), (3.0, 1e-9)]
                {
                    let pull = limit * beyond;
                    for (rule, d) in [(Covering::Cohesive, 1.0 + f), (Covering::Ones, 1.0), (Covering::Weight, f)] {
                        let answer = case.solve_under(&[("f", f), ("F2", pull)], covering(rule));
                        let ray = mechanism(&answer);
                        let expected = (pull - limit) / (n as f64 * d);
                        let what = format!("p, n = {n}, L = {length}, f = {f}, ×{beyond}, {rule}");
                        close(&what, ray.p, expected, tolerance);
                        for pair in ray.direction.pairs() {
                            near("mode", pair.z_t.scalar(), 1.0, 1e-9, 1.0);
                            assert_eq!(pair.z_n, 0.0);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn the_embedded_beams_are_this_beam() {
    for (name, outcome) in
        [("beam", OutcomeKind::Normal), ("beam-limit", OutcomeKind::Normal), ("beam-ray", OutcomeKind::Ray)]
    {
        let case = Case::embedded(name);
        let answer = case.solve(&[]);
        assert_eq!(answer.outcome, outcome, "{name}");
        let values = case.scenario.parameter_values();
        let (r, pull) = (values["f"] * values["F"], values["F2"]);
        if outcome == OutcomeKind::Ray {
            close("p", mechanism(&answer).p, (pull - 6.0 * r) / (6.0 * 1.5), 1e-9);
        } else {
            agrees(&case, 6, 1e-5, r, pull, &[]);
        }
    }
}
