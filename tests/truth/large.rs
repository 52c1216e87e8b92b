//! Long runs: the working-scheme engine against the dense tableau, whose M is formed from R and f by other code, and
//! the growth of errors over thousands of pivots. The full sizes stand behind `--ignored`, with `--release`.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::contact::full_lcp::full_lcp;
use stickslip::contact::lcp::contact_lcp;
use stickslip::contact::problem::ContactProblem;
use stickslip::lcp::basis::Basis;
use stickslip::lcp::basis_solution::vertex;
use stickslip::lcp::driver::{Engine, Step, run};
use stickslip::lcp::exact::tableau::Tableau;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::mirrored::MirroredLcp;
use stickslip::lcp::outcome::{Outcome, Run};
use stickslip::lcp::parametric::{End, Parametric, Reach};
use stickslip::lcp::problem::{Lcp, Scale};
use stickslip::lcp::ratio_test::TieRule;
use stickslip::model::rules::{Covering, TieBreak};

#[path = "../../benches/common/mod.rs"]
#[allow(dead_code, reason = "the measurements use the rest")]
mod plates;

use crate::common::systems;
use plates::{Plates, Pull, Ready};

/// Coulomb pairs with a random positive definite R; `whole`: small integers, so that ties are everywhere.
fn random_system(m: usize, f: f64, whole: bool, seed: u64) -> ContactProblem {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let n = 2 * m;
    let mut number = |low: i32, high: i32| {
        if whole { f64::from(rng.random_range(low..=high)) } else { rng.random_range(f64::from(low)..f64::from(high)) }
    };
    let a = DMatrix::from_fn(n, n, |_, _| number(-1, 1));
    let stiffness = &a * a.transpose() + DMatrix::identity(n, n);
    let load = DVector::from_fn(n, |_, _| number(-3, 3));
    systems::coulomb(stiffness, load, f)
}

/// Worst violation of the laws, forces relative to the largest load, displacements to the largest of them.
fn violation(problem: &ContactProblem, z: &DVector<f64>, force: &DVector<f64>) -> f64 {
    let m = problem.laws.len();
    let (force, z) = (force / problem.load.amax(), z / z.amax());
    let of_pair = |i: usize| {
        let (x_n, x_t, z_n, z_t) = (force[i], force[m + i], z[i], z[m + i]);
        let bound = problem.laws[i].friction() * x_n;
        // Slip + goes with x_τ = −bound.
        [
            -x_n,
            -z_n,
            (x_n * z_n).abs(),
            x_t.abs() - bound,
            (z_t.max(0.0) * (bound + x_t)).abs(),
            (z_t.min(0.0) * (bound - x_t)).abs(),
        ]
    };
    (0..m).flat_map(of_pair).fold(0.0, f64::max)
}

fn finished<E: Engine>(engine: &mut E) -> Run<E::Number> {
    run(engine, 100_000, &mut |_| ControlFlow::Continue(()))
}

/// Both engines on one problem; the answers agree to 1e-9 of the largest. Returns the number of pivots and whether
/// they were the same ones.
fn agree(problem: &ContactProblem, what: &str) -> (usize, bool) {
    let covering = Covering::default();
    let contact = contact_lcp(problem, covering).expect("cohesive covers everything");
    let rule = contact.tie_rule(TieBreak::Lexicographic);
    let fast = finished(&mut SchemeEngine::new(Arc::clone(&contact.lcp), rule.clone()));
    let whole = full_lcp::<f64>(problem, covering);
    let judge = finished(&mut Tableau::new(&whole, rule));
    let normal = Outcome::Normal { marginal: false };
    assert_eq!((&fast.outcome, &judge.outcome), (&normal, &normal), "{what}");
    // As the product does, each answer is computed afresh from the data at the end.
    let answer = |run: &Run| {
        let point = vertex(&contact.lcp, &run.pivots.basis()).expect("regular");
        let z = contact.joint_displacements(&problem.system, &point.z) * contact.length_unit;
        let force = &problem.system.stiffness * &z + &problem.load;
        let violation = violation(problem, &z, &force);
        assert!(violation < 1e-9, "{what}: violation {violation:e}");
        (z, force)
    };
    let (fast_z, fast_x) = answer(&fast);
    let (judge_z, judge_x) = answer(&judge);
    let z_error = (fast_z - &judge_z).amax() / judge_z.amax();
    let x_error = (fast_x - &judge_x).amax() / judge_x.amax();
    assert!(z_error < 1e-9 && x_error < 1e-9, "{what}: z {z_error:e}, x {x_error:e}");
    let raw = contact.joint_displacements(&problem.system, &fast.point.z) * contact.length_unit;
    let z_drift = (raw - &judge_z).amax() / judge_z.amax();
    assert!(z_drift < 1e-9, "{what}: drift {z_drift:e}");
    let names = |run: &Run| -> Vec<_> {
        let pivots = run.pivots.recorded().iter();
        pivots.map(|pivot| (pivot.entering, pivot.leaving)).collect()
    };
    let same = names(&fast) == names(&judge);
    if same {
        // p at every pivot; the judge's M is not made dimensionless.
        let first = judge.pivots.recorded()[0].p_after;
        for (a, b) in fast.pivots.recorded().iter().zip(judge.pivots.recorded()) {
            let error = (a.p_after * contact.force_unit - b.p_after).abs() / first;
            assert!(error < 1e-9, "{what}: p at pivot {} differs by {error:e}", a.step);
        }
    }
    println!(
        "{what}: {} pivots{}, z before the last computation to {z_drift:.0e}",
        fast.pivots.count(),
        if same { ", the same" } else { "" }
    );
    (fast.pivots.count(), same)
}

fn agree_on_all(m: usize) {
    for f in [0.1, 0.5, 2.0] {
        for (whole, name) in [(false, "random"), (true, "random with ties")] {
            let problem = random_system(m, f, whole, 7 + m as u64);
            let (_, same) = agree(&problem, &format!("{name}, m = {m}, f = {f}"));
            assert!(same, "{name}, m = {m}, f = {f}: other pivots");
        }
        // Pulled from both sides the plates stick longer: the more friction, the stronger the pull.
        for (pull, traction, name) in
            [(Pull::OneSided, 60.0, "plates"), (Pull::Symmetric, 600.0 * f, "plates with ties")]
        {
            let ready = Ready::new(&Plates { pull, traction, ..Plates::with_pairs(m, f) });
            let problem = ready.problem(&ready.values(&[]));
            // Mirror images tie up to the rounding of their condensation: the order may differ, the answer not.
            let (pivots, _) = agree(&problem, &format!("{name}, m = {m}, f = {f}"));
            assert!(pivots > m / 4, "{name}, m = {m}, f = {f}: {pivots} pivots");
        }
    }
}

#[test]
fn engines_agree_on_sixty_pairs() {
    agree_on_all(60);
}

#[test]
#[ignore = "a minute: run with --release"]
fn engines_agree_on_three_hundred_and_a_thousand_pairs() {
    agree_on_all(300);
    agree_on_all(1000);
}

/// Largest error of w = M z + q + d p over the rows, relative to the terms that a row sums.
fn residual(matrix: &DMatrix<f64>, lcp: &MirroredLcp, point: &stickslip::lcp::outcome::Point) -> f64 {
    let z = DVector::from_column_slice(&point.z);
    let w = matrix * &z + &lcp.q + point.p * &lcp.covering;
    let terms = matrix.abs() * z.abs() + lcp.q.abs() + point.p * lcp.covering.abs();
    (0..lcp.size()).map(|i| (w[i] - point.w[i]).abs() / terms[i]).fold(0.0, f64::max)
}

/// 8 192 pivots on Murty's problem: M is unit lower triangular with twos, numbers up to 2^13.
#[test]
fn errors_do_not_grow_over_murtys_pivots() {
    let n = 13;
    let matrix = DMatrix::from_fn(n, n, |i, j| match j.cmp(&i) {
        std::cmp::Ordering::Less => 2.0,
        std::cmp::Ordering::Equal => 1.0,
        std::cmp::Ordering::Greater => 0.0,
    });
    let rows: Vec<Vec<f64>> = matrix.row_iter().map(|r| r.iter().copied().collect()).collect();
    let q: Vec<f64> =
        (1..=n as i32).map(|i| -(n as i32 + 1 - i..=n as i32).map(|j| 2f64.powi(j)).sum::<f64>()).collect();
    let lcp =
        Arc::new(MirroredLcp::plain(&Lcp { scale: Scale::plain(&rows), matrix: rows, q, covering: vec![1.0; n] }));
    let mut engine = SchemeEngine::new(Arc::clone(&lcp), TieRule::Lexicographic((0..n).collect()));
    let mut worst = 0f64;
    while engine.step() == Step::Pivoted {
        worst = worst.max(residual(&matrix, &lcp, &engine.point()));
    }
    assert_eq!(engine.pivots().count(), 1 << n);
    println!("worst {worst:e}, {} restarts from the data", engine.refreshes());
    assert!(worst < 1e-13, "{worst:e}");
}

/// One dictionary follows a random positive definite problem through random loads, until `pivots` pivots are made.
/// Returns the worst residual after the first and the last tenth of the walks.
fn errors_of_a_long_walk(n: usize, pivots: usize) -> (f64, f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let a = DMatrix::from_fn(n, n, |_, _| rng.random_range(-1.0..1.0));
    let matrix = &a * a.transpose() / n as f64 + DMatrix::identity(n, n) * 0.1;
    let load = |rng: &mut ChaCha8Rng| DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0));
    let mut lcp = MirroredLcp {
        base: Arc::new(matrix.clone()),
        q: DVector::repeat(n, 1.0),
        covering: load(&mut rng),
        whole: (0..n).collect(),
        mirrors: vec![None; n],
        scale: Scale {
            row: matrix.diagonal().map(f64::sqrt).as_slice().to_vec(),
            column: matrix.diagonal().map(f64::sqrt).as_slice().to_vec(),
            load: None,
        },
        full_size: n,
    };
    let start = Basis { z: Vec::new(), active: Vec::new(), p: false };
    let order = (0..n).collect();
    let mut engine = Parametric::new(Arc::new(lcp.clone()), &start, order).expect("z = 0 is an answer");
    let reach = Reach { target: 1.0, through: false, pivots: 100_000 };
    let (mut made, mut errors) = (0, Vec::new());
    while made < pivots {
        let (end, some) = engine.walk(reach, &mut |_| ControlFlow::Continue(()));
        assert_eq!(end, End::Target);
        made += some;
        // The load reached; the next one is somewhere else.
        lcp.q += &lcp.covering;
        lcp.covering = load(&mut rng) - &lcp.q;
        let point = engine.point();
        let at_target = MirroredLcp { covering: DVector::zeros(n), ..lcp.clone() };
        errors.push(residual(&matrix, &at_target, &point));
        assert!(point.z.iter().chain(&point.w).all(|value| *value > -1e-12));
        assert!(point.z.iter().zip(&point.w).all(|(z, w)| z * w == 0.0));
        assert!(engine.reload(Arc::new(lcp.clone())));
    }
    let tenth = errors.len() / 10;
    let worst = |some: &[f64]| some.iter().copied().fold(0.0, f64::max);
    println!(
        "n = {n}: {made} pivots in {} walks, {} restarts; worst residual first {:.1e}, last {:.1e}",
        errors.len(),
        engine.refreshes(),
        worst(&errors[..tenth]),
        worst(&errors[errors.len() - tenth..])
    );
    assert_eq!(engine.refreshes(), 0, "no restart hides the errors");
    (worst(&errors[..tenth]), worst(&errors[errors.len() - tenth..]))
}

#[test]
fn errors_do_not_grow_over_a_long_walk() {
    let (_, last) = errors_of_a_long_walk(60, 5_000);
    assert!(last < 1e-13, "{last:e}");
}

#[test]
#[ignore = "run with --release"]
fn errors_do_not_grow_over_twenty_thousand_pivots() {
    let (_, last) = errors_of_a_long_walk(300, 20_000);
    assert!(last < 1e-12, "{last:e}");
}
