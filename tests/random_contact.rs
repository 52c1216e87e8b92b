//! Random contact systems with a positive definite R: an answer always exists (Haslinger 1983), so the default
//! rules must find one, and a fresh evaluation of the laws from R, RF, f must accept it.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::contact::complementarity::contact_lcp;
use stickslip::contact::numbers::ContactNumbers;
use stickslip::contact::system::{ContactPair, ContactSystem, JointLoad};
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::outcome::Outcome;
use stickslip::lcp::vertex::{Basis, vertex};
use stickslip::model::pair::Law;
use stickslip::model::parameter::Number;
use stickslip::model::rules::{Covering, TieBreak};

/// R = A Aᵀ / n + shift·I; with `ties` the entries of A and the loads are small integers.
pub fn random_system(
    rng: &mut ChaCha8Rng,
    m: usize,
    ties: bool,
) -> (ContactSystem, ContactNumbers) {
    let n = 2 * m;
    let a = DMatrix::from_fn(n, n, |_, _| {
        if ties {
            f64::from(rng.random_range(-1..=1))
        } else {
            rng.random_range(-1.0..1.0)
        }
    });
    let stiffness = &a * a.transpose() / n as f64 + DMatrix::identity(n, n) * 0.05;
    let load = DVector::from_fn(n, |_, _| {
        if ties {
            f64::from(rng.random_range(-2..=2))
        } else {
            rng.random_range(-1.0..1.0)
        }
    });
    let law = Law::Coulomb {
        friction: Number::Value(0.0),
        cohesion: Number::Value(0.0),
        gap: Number::Value(0.0),
    };
    let pairs = (0..m)
        .map(|i| ContactPair {
            id: format!("c{}", i + 1),
            law: law.clone(),
            position: None,
            tangential: Some(m + i),
        })
        .collect();
    let f = if ties {
        f64::from(rng.random_range(0..=5))
    } else {
        rng.random_range(0.0..5.0)
    };
    let numbers = ContactNumbers {
        friction: vec![f; m],
        cohesion: vec![0.0; m],
        gap: vec![0.0; m],
        bound: vec![0.0; m],
        load: load.clone(),
    };
    let system = ContactSystem {
        pairs,
        stiffness,
        loads: vec![JointLoad {
            name: "load".into(),
            vector: load,
        }],
        kernel: DMatrix::zeros(n, 0),
    };
    (system, numbers)
}

/// Worst violation of the laws at joint displacements z, relative to the largest force.
fn violation(system: &ContactSystem, numbers: &ContactNumbers, z: &DVector<f64>) -> f64 {
    let m = system.pairs.len();
    let force = &system.stiffness * z + &numbers.load;
    let scale = numbers.load.amax().max(1e-300);
    let mut worst = 0f64;
    for i in 0..m {
        let (x_n, x_t, z_n, z_t) = (force[i], force[m + i], z[i], z[m + i]);
        let bound = numbers.friction[i] * x_n;
        worst = worst
            .max(-x_n / scale)
            .max(-z_n)
            .max((x_n * z_n).abs() / scale);
        worst = worst.max((x_t.abs() - bound) / scale);
        // slip + goes with x_τ = −bound
        worst = worst.max((z_t.max(0.0) * (bound + x_t)).abs() / scale);
        worst = worst.max((z_t.min(0.0) * (bound - x_t)).abs() / scale);
    }
    worst
}

#[test]
fn default_rules_always_answer_where_r_is_positive_definite() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut worst = 0f64;
    let mut pivots = 0;
    for k in 0..2000 {
        let m = 1 + k % 20;
        let (system, numbers) = random_system(&mut rng, m, k % 3 == 0);
        let contact = contact_lcp(&system, &numbers, Covering::Cohesive).unwrap();
        let mut engine = SchemeEngine::new(
            contact.lcp.clone(),
            contact.tie_rule(TieBreak::Lexicographic),
        );
        let run = run(&mut engine, 20_000, &mut |_| ControlFlow::Continue(()));
        assert!(
            matches!(
                run.outcome,
                Outcome::Trivial | Outcome::Normal { marginal: false }
            ),
            "problem {k}: m = {m}, f = {}: {:?}",
            numbers.friction[0],
            run.outcome
        );
        pivots += run.pivots.len();
        let rebuilt = vertex(&contact.lcp, &Basis::after(&run.pivots)).expect("regular");
        for point in [&run.point, &rebuilt] {
            let z = contact.joint_displacements(&system, &point.z) * contact.length_unit;
            let error = violation(&system, &numbers, &z);
            worst = worst.max(error);
            assert!(error < 1e-9, "problem {k}: violation {error:e}");
        }
    }
    println!("worst violation {worst:e}, {pivots} pivots");
}
