//! The unit square element with three answers.
//!
//! ```text
//!     ▓▓▓▓▓▓▓▓▓
//!     ┌───────┐      E = 1, ν = 0, t = 1, top fixed
//!     │       │
//!     ●───────●      f = 1.1, CLV (n1, n2, τ1, τ2) = (0.1, 0.1, 0.5, −0.5)
//!     n1      n2
//! ```
//!
//! One answer is slip (−, +) with |z_τ| = 0.52, x_n = 0.1: λ_τ1 = 0.5 − 0.52 (½ + ¼) = 0.11 = f·0.1.

use nalgebra::{DMatrix, DVector};
use serde_json::json;

use crate::common::*;

fn square() -> Case {
    // A force F at a pair's own node makes λ = −F in the main system.
    Case::json(json!({
        "parameters": { "f": 1.1 },
        "materials": { "unit": { "E": 1, "nu": 0 } },
        "nodes": { "n1": [0, 0], "n2": [1, 0], "n3": [1, 1], "n4": [0, 1] },
        "quads": [{ "id": "q", "nodes": ["n1", "n2", "n3", "n4"], "thickness": 1, "material": "unit", "plane": "stress" }],
        "supports": [{ "at": "n3", "fixed": ["x", "y"] }, { "at": "n4", "fixed": ["x", "y"] }],
        "contacts": [
            { "id": "c1", "node": "n1", "against": "ground", "normal": [0, 1], "friction": "f" },
            { "id": "c2", "node": "n2", "against": "ground", "normal": [0, 1], "friction": "f" }
        ],
        "loads": { "load": { "items": [
            { "point": { "at": "n1", "force": [-0.5, -0.1] } },
            { "point": { "at": "n2", "force": [0.5, -0.1] } }
        ] } }
    }))
}

/// K of the bilinear unit square with ν = 0, its bottom nodes, order v1, v2, u1, u2 (closed form).
fn stiffness() -> DMatrix<f64> {
    DMatrix::from_row_slice(
        4,
        4,
        &[
            0.5, 0.0, 0.125, 0.125, //
            0.0, 0.5, -0.125, -0.125, //
            0.125, -0.125, 0.5, -0.25, //
            0.125, -0.125, -0.25, 0.5,
        ],
    )
}

/// All answers by trying the 4² working schemes: (z_n1, z_n2, z_τ1, z_τ2) each.
fn enumerate(f: f64) -> Vec<DVector<f64>> {
    let r = stiffness();
    let rf = DVector::from_row_slice(&[0.1, 0.1, 0.5, -0.5]);
    let mut answers = Vec::new();
    for scheme in 0..16 {
        // 0 open, 1 stick, 2 slip +, 3 slip −
        let state = [scheme % 4, scheme / 4];
        let mut a = DMatrix::zeros(4, 4);
        let mut b = DVector::zeros(4);
        for (i, state) in state.into_iter().enumerate() {
            let (n, t) = (i, 2 + i);
            match state {
                0 => {
                    a.row_mut(n).copy_from(&r.row(n));
                    a.row_mut(t).copy_from(&r.row(t));
                    (b[n], b[t]) = (-rf[n], -rf[t]);
                }
                1 => (a[(n, n)], a[(t, t)]) = (1.0, 1.0),
                slip => {
                    let f = if slip == 2 { f } else { -f };
                    a[(n, n)] = 1.0;
                    a.row_mut(t).copy_from(&(r.row(t) + r.row(n) * f));
                    b[t] = -rf[t] - f * rf[n];
                }
            }
        }
        let Some(z) = a.lu().solve(&b) else { continue };
        let x = &r * &z + &rf;
        let fits = (0..2).all(|i| {
            let (x_n, x_t, z_n, z_t) = (x[i], x[2 + i], z[i], z[2 + i]);
            match state[i] {
                0 => z_n > 0.0,
                1 => x_n > 0.0 && x_t.abs() < f * x_n,
                2 => x_n > 0.0 && z_t > 0.0,
                _ => x_n > 0.0 && z_t < 0.0,
            }
        });
        if fits {
            answers.push(z);
        }
    }
    answers
}

#[test]
fn the_element_gives_the_stiffness_by_hand() {
    let case = square();
    let system = case.prepared.system().unwrap();
    assert!((&system.stiffness - stiffness()).amax() < 1e-14);
    near_all("CLV", system.loads[0].vector.as_slice(), &[0.1, 0.1, 0.5, -0.5], 1e-14);
    assert_eq!(system.kernel.ncols(), 0);
}

#[test]
fn one_of_three_answers_is_found() {
    let answers = enumerate(1.1);
    assert_eq!(answers.len(), 3);
    let slip = DVector::from_row_slice(&[0.0, 0.0, -0.52, 0.52]);
    assert!(answers.iter().any(|z| (z - &slip).amax() < 1e-12));
    let case = square();
    let mut found = 0;
    for rules in all_rules() {
        let answer = case.solve_under(&[], rules);
        if rules == stickslip::model::rules::Rules::default() {
            is_answer(&answer);
        }
        if !answer.is_answer() {
            continue;
        }
        found += 1;
        let p = &answer.pairs;
        let z = DVector::from_row_slice(&[p[0].z_n, p[1].z_n, p[0].z_t, p[1].z_t]);
        assert!(answers.iter().any(|known| (known - &z).amax() < 1e-9), "{rules:?}: {z}");
    }
    assert!(found > 0);
}

#[test]
fn below_the_critical_friction_there_is_one() {
    let case = square();
    for f in [0.0, 0.3, 0.6, 0.9, 0.99] {
        let answers = enumerate(f);
        assert_eq!(answers.len(), 1, "f = {f}");
        let answer = case.solve(&[("f", f)]);
        is_answer(&answer);
        let p = &answer.pairs;
        let z = [p[0].z_n, p[1].z_n, p[0].z_t, p[1].z_t];
        near_all("z", &z, answers[0].as_slice(), 1e-9);
    }
}
