//! Random contact systems: a load path must pass through the vertices that its schemes have by their own equations, and,
//! where R is positive definite and friction small, so that the answer is unique, through the answers that cold runs find;
//! warm starts must agree with cold ones.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::contact::law::PairLaw;
use stickslip::contact::lcp::contact_lcp;
use stickslip::contact::load_path::path_lcp;
use stickslip::contact::problem::ContactProblem;
use stickslip::lcp::basis::Basis;
use stickslip::lcp::basis_solution::vertex;
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::outcome::Outcome;
use stickslip::lcp::parametric::{End, Parametric, Path, Reach};
use stickslip::lcp::variable::Variable;
use stickslip::model::rules::{Covering, TieBreak};
use stickslip::solve::warm::WarmStart;
use stickslip::watch::Quiet;

use crate::common::systems::coulomb;

/// R = A Aᵀ / n + I; with `ties` the entries of A and the loads are small integers.
fn random_system(rng: &mut ChaCha8Rng, m: usize, ties: bool) -> ContactProblem {
    let n = 2 * m;
    let number = |rng: &mut ChaCha8Rng, ties: bool| {
        if ties { f64::from(rng.random_range(-1..=1)) } else { rng.random_range(-1.0..1.0) }
    };
    let a = DMatrix::from_fn(n, n, |_, _| number(rng, ties));
    let stiffness = &a * a.transpose() / n as f64 + DMatrix::identity(n, n);
    let load = DVector::from_fn(n, |_, _| number(rng, ties));
    let friction = if ties { 0.25 } else { rng.random_range(0.0..0.4) };
    let mut problem = coulomb(stiffness, load, friction);
    let cohesion = if rng.random_bool(0.3) { 0.1 } else { 0.0 };
    let gap = if rng.random_bool(0.3) { 0.1 } else { 0.0 };
    problem.laws = vec![PairLaw::rubbing(friction, cohesion, gap); m];
    problem
}

fn cold(problem: &ContactProblem) -> (Basis, DVector<f64>, WarmStart) {
    let contact = contact_lcp(problem, Covering::Cohesive).expect("covers all");
    let rule = contact.tie_rule(TieBreak::Lexicographic);
    let mut engine = SchemeEngine::new(Arc::clone(&contact.lcp), rule);
    let run = run(&mut engine, 20_000, &mut |_| ControlFlow::Continue(()));
    assert!(matches!(run.outcome, Outcome::Trivial | Outcome::Normal { .. }));
    let z = contact.joint_displacements(&problem.system, &run.point.z) * contact.length_unit;
    let basis = run.pivots.basis();
    let engine = engine.into_parametric().expect("stands on an answer");
    (basis, z, WarmStart::new(engine, contact, problem.clone()))
}

#[test]
fn paths_and_warm_starts_end_in_the_answers_of_cold_runs() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    for k in 0..400 {
        let m = 1 + k % 14;
        let ties = k % 3 == 0;
        let mut problem = random_system(&mut rng, m, ties);
        if k % 5 == 0 {
            // Start from nothing: everything degenerate where there are no gaps.
            problem.load.fill(0.0);
        }
        let (mut basis, _, mut kept) = cold(&problem);
        for step in 0..4 {
            let mut next = problem.clone();
            next.load = DVector::from_fn(2 * m, |_, _| {
                if ties { f64::from(rng.random_range(-2..=2)) } else { rng.random_range(-1.0..1.0) }
            });
            let increment = &next.load - &problem.load;
            let contact = path_lcp(&problem, &increment);
            let mut engine =
                Parametric::new(Arc::clone(&contact.lcp), &basis, contact.lexicographic_order()).expect("regular");
            let reach = Reach { target: 1.0, through: false, pivots: 10_000 };
            let path = engine.follow(reach, &mut |_| ControlFlow::Continue(()));
            assert_eq!(path.end, End::Target, "problem {k}.{step}, m = {m}");
            let z_of = |z: &[f64]| contact.joint_displacements(&problem.system, z) * contact.length_unit;
            for knot in path.knots.iter().skip(1) {
                let mut there = problem.clone();
                there.load += knot.t * &increment;
                let (_, z, _) = cold(&there);
                let error = (z_of(&knot.point.z) - &z).amax();
                // z_τ of pairs that just touch without force may be anything.
                assert!(error <= 1e-9, "problem {k}.{step} at t = {}: {error:e}", knot.t);
            }
            let warm = kept.follow(&next, &Quiet).expect("a way");
            let (_, z, _) = cold(&next);
            let found = contact.joint_displacements(&problem.system, &warm.point.z) * warm.length_unit;
            assert!((&found - &z).amax() <= 1e-11, "problem {k}.{step}");
            basis = engine.basis();
            problem = next;
        }
    }
}

/// A change of friction by up to 10 %, alone and with a change of load, in a kept dictionary of the old friction.
#[test]
fn warm_starts_follow_friction_to_the_answers_of_cold_runs() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let (mut followed, mut all) = (0, 0);
    for k in 0..400 {
        let m = 1 + k % 14;
        let mut problem = random_system(&mut rng, m, k % 3 == 0);
        let (_, _, mut kept) = cold(&problem);
        for step in 0..6 {
            let factor = rng.random_range(0.97..1.03);
            for law in &mut problem.laws {
                *law = law.with_friction(law.friction() * factor);
            }
            if step % 2 == 1 {
                for load in problem.load.iter_mut() {
                    *load += rng.random_range(-0.05..0.05);
                }
            }
            let (_, z, fresh) = cold(&problem);
            all += 1;
            match kept.follow(&problem, &Quiet) {
                Some(warm) => {
                    followed += 1;
                    let contact = fresh.contact();
                    let found = contact.joint_displacements(&problem.system, &warm.point.z) * warm.length_unit;
                    assert!((&found - &z).amax() <= 1e-10, "problem {k}.{step}");
                }
                None => kept = fresh,
            }
        }
    }
    // Most small changes can be followed; the others are solved cold.
    assert!(followed * 10 >= all * 9, "{followed} of {all}");
}

/// The knots of a path, read from the kept dictionary, are the vertices of their schemes: for every knot the equations of
/// the scheme before it, with t in the place of what left there, are solved afresh. Friction up to 2 (several answers), a
/// kernel of R, stiffnesses of joints that differ by 1e±4, ties, loads on one side only.
#[test]
fn knots_are_the_vertices_that_their_equations_give() {
    let mut rng = ChaCha8Rng::seed_from_u64(61);
    let (mut compared, mut ends) = (0, std::collections::BTreeSet::new());
    for k in 0..90 {
        let m = 2 + k % 22;
        let ties = k % 3 == 0;
        let mut problem = random_system(&mut rng, m, ties);
        let friction = [0.2, 0.6, 2.0][k % 3];
        problem.laws = vec![PairLaw::rubbing(friction, if k % 7 == 0 { 0.1 } else { 0.0 }, 0.0); m];
        let mut stiffness = problem.system.stiffness.clone();
        if k % 4 == 1 {
            let sizes: Vec<f64> = (0..2 * m).map(|_| 10f64.powf(rng.random_range(-2.0..2.0))).collect();
            stiffness = DMatrix::from_fn(2 * m, 2 * m, |i, j| sizes[i] * stiffness[(i, j)] * sizes[j]);
        }
        if k % 4 == 2 {
            // All pairs moved along by the same amount cost nothing.
            let motion = DVector::from_fn(2 * m, |i, _| if i < m { 0.0 } else { 1.0 / (m as f64).sqrt() });
            let free = DMatrix::identity(2 * m, 2 * m) - &motion * motion.transpose();
            stiffness = &free * stiffness * &free;
            stiffness = (&stiffness + stiffness.transpose()) * 0.5;
        }
        let law = problem.laws.clone();
        problem = coulomb(stiffness, DVector::zeros(2 * m), friction);
        problem.laws = law;
        for i in 0..m {
            problem.load[i] = 1.0;
        }
        let mut increment = DVector::zeros(2 * m);
        let pushed = if k % 5 == 0 { 1 } else { m };
        for i in 0..pushed {
            increment[i] = if ties { -1.0 } else { rng.random_range(-1.0..0.2) };
            increment[m + i] = if ties { f64::from(rng.random_range(-1..=1)) } else { rng.random_range(-1.0..1.0) };
        }
        let contact = path_lcp(&problem, &increment);
        let held = Basis { z: Vec::new(), active: Vec::new(), p: false };
        let mut engine =
            Parametric::new(Arc::clone(&contact.lcp), &held, contact.lexicographic_order()).expect("all held");
        let reach = Reach { target: 40.0, through: k % 2 == 0, pivots: 5_000 };
        let path = engine.follow(reach, &mut |_| ControlFlow::Continue(()));
        ends.insert(format!("{:?}", path.end).split(['(', ' ']).next().unwrap_or_default().to_owned());
        compared += compare_with_equations(&path, &contact.lcp, k);
    }
    assert!(compared > 1_000, "{compared}");
    for end in ["Target", "Limit", "Turning"] {
        assert!(ends.contains(end), "{end}: {ends:?}");
    }
}

/// Number of knots compared.
fn compare_with_equations(path: &Path, lcp: &stickslip::lcp::mirrored::MirroredLcp, number: usize) -> usize {
    let mut compared = 0;
    for two in path.knots.windows(2) {
        let (before, knot) = (&two[0], &two[1]);
        let Some(Variable::W(row) | Variable::Z(row)) = knot.leaving.first().copied() else { continue };
        let mut active = before.scheme.clone();
        active.push(row);
        active.sort_unstable();
        active.dedup();
        let z = before.scheme.iter().copied().filter(|&z| z != row).collect();
        let Some(fresh) = vertex(lcp, &Basis { z, active, p: true }) else { continue };
        let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let force = lcp.q.amax() + fresh.p.abs() * lcp.covering.amax();
        // Displacements of 0 are the rounding of what the forces do to the stiffest joint.
        let moved = largest(&fresh.z).max(force / lcp.base.diagonal().amax());
        for (found, fresh, size) in
            [(&knot.point.z, &fresh.z, moved), (&knot.point.w, &fresh.w, force.max(largest(&fresh.w)))]
        {
            let off = found.iter().zip(fresh).fold(0.0, |off: f64, (found, fresh)| off.max((found - fresh).abs()));
            assert!(off <= 1e-11 * size, "problem {number} at {}: {off:e} of {size:e}", knot.t);
        }
        assert!((knot.t - fresh.p).abs() <= 1e-11 * fresh.p.abs().max(1.0), "{number}: {} {}", knot.t, fresh.p);
        compared += 1;
    }
    compared
}
