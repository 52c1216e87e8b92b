//! The worked example of `docs/method.md` §8, pivot by pivot.
//!
//! ```text
//!   c1 ──k── c2 ──k── c3 ──▶ F        three nodes on the ground, f = 0.5, k = 1000 kN/m
//!   40       100      100             kN, pressed down (c1: 40 − lift)
//! ```

use serde_json::json;
use stickslip::answer::record::{Answer, State, Verdict};

use crate::common::{Case, is_answer, mechanism, near};

/// 1 + f of the cohesive covering.
const D: f64 = 1.5;

/// The three nodes, c1 lifted and c3 pulled.
fn solve(lift: f64, pull: f64) -> Answer {
    let k = 1000.0;
    let normal = |i: usize| (0..6).map(|j| if i == j { k } else { 0.0 }).collect::<Vec<_>>();
    let stiffness = [
        normal(0),
        normal(1),
        normal(2),
        vec![0.0, 0.0, 0.0, k, -k, 0.0],
        vec![0.0, 0.0, 0.0, -k, 2.0 * k, -k],
        vec![0.0, 0.0, 0.0, 0.0, -k, k],
    ];
    Case::json(json!({
        "parameters": { "lift": lift, "pull": pull },
        "contact_system": {
            "pairs": ["c1", "c2", "c3"], "friction": [0.5, 0.5, 0.5], "stiffness": stiffness,
            "loads": {
                "weight": { "vector": [40, 100, 100, 0, 0, 0] },
                "lift": { "factor": "lift", "vector": [-1, 0, 0, 0, 0, 0] },
                "pull": { "factor": "pull", "vector": [0, 0, 0, 0, 0, -1] }
            }
        }
    }))
    .solve(&[])
}

/// Leaving variable and p after each pivot.
fn pivots(answer: &Answer, expected: &[(&str, &str, f64)]) {
    let found: Vec<_> = answer.pivots.iter().map(|pivot| (pivot.entering.as_str(), pivot.leaving.as_str())).collect();
    assert_eq!(found, expected.iter().map(|(entering, leaving, _)| (*entering, *leaving)).collect::<Vec<_>>());
    for (pivot, (_, leaving, p)) in answer.pivots.iter().zip(expected) {
        near(&format!("p where {leaving} leaves"), pivot.p, *p, 1e-14, 100.0);
    }
}

#[test]
fn two_pairs_slip_and_one_holds() {
    let answer = solve(0.0, 110.0);
    is_answer(&answer);
    let p = [60.0 / D, 10.0 / 3.0, 0.0];
    pivots(&answer, &[("p", "x+[c3]", p[0]), ("z+[c3]", "x+[c2]", p[1]), ("z+[c2]", "p", p[2])]);
    let expected = [(State::Stick, -10.0, 0.0), (State::SlipPlus, -50.0, 0.01), (State::SlipPlus, -50.0, 0.07)];
    for (pair, (state, force, slip)) in answer.pairs.iter().zip(expected) {
        assert_eq!(pair.state, state, "{}", pair.id);
        near("x_t", pair.x_t, force, 1e-14, 100.0);
        near("z_t", pair.z_t, slip, 1e-14, 0.1);
    }
    near("reserve of c1", answer.pairs[0].reserve_plus, 10.0, 1e-14, 100.0);
}

#[test]
fn all_slide_where_the_bounds_are_used_up() {
    let answer = solve(0.0, 150.0);
    let ray = mechanism(&answer);
    // The bounds are 20 + 50 + 50 = 120; p gives 1.5 of bound to each of the three.
    near("p", ray.p, (150.0 - 120.0) / (3.0 * D), 1e-14, 100.0);
    // Statics alone would allow normal forces that are large enough; no scheme gives them.
    assert_eq!(ray.verdict, Some(Verdict::Proved));
    pivots(&answer, &[("p", "x+[c3]", 100.0 / D), ("z+[c3]", "x+[c2]", 50.0 / 3.0), ("z+[c2]", "x+[c1]", 30.0 / 4.5)]);
    for direction in ray.direction.pairs() {
        assert_eq!((direction.z_n, direction.z_t.scalar()), (0.0, 1.0), "{}", direction.pair);
    }
}

#[test]
fn a_lifted_pair_opens_and_is_held_by_the_cohesion_that_fades() {
    let answer = solve(50.0, 90.0);
    is_answer(&answer);
    pivots(&answer, &[("p", "x+[c3]", 40.0 / D), ("z+[c3]", "x_n[c1]", 10.0), ("z_n[c1]", "p", 0.0)]);
    let [c1, c2, c3] = &answer.pairs[..] else { panic!("three pairs") };
    assert_eq!((c1.state, c2.state, c3.state), (State::Open, State::Stick, State::SlipPlus));
    near("z_n of c1", c1.z_n, 0.01, 1e-14, 0.1);
    near("x_t of c2", c2.x_t, -40.0, 1e-14, 100.0);
    near("z_t of c3", c3.z_t, 0.04, 1e-14, 0.1);
}
