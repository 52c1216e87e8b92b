//! Known answers, and agreement with the tableau on random problems.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::contact::full_lcp::full_lcp;
use crate::contact::full_lcp::tests::{
    beam, beam_problem, coulomb, plain, random_number, tangential_first, with_random_bound_and_gap,
};
use crate::contact::rows::rows;
use crate::contact::schemes::critical::tests::unit_square;
use crate::lcp::driver::run;
use crate::lcp::exact::scalar::Scalar;
use crate::lcp::exact::tableau::Tableau;
use crate::lcp::outcome::Outcome;
use crate::model::pair::Law;
use crate::model::rules::Covering;

fn all(problem: &ContactProblem) -> Enumeration {
    enumerate(problem, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn without_pairs_there_is_the_one_answer_of_the_main_system() {
    let got = all(&plain(&coulomb(DMatrix::zeros(0, 0)), 0.5, &[]));
    assert_eq!((got.answers.len(), got.total, got.complete), (1, 1, true));
}

#[test]
fn klarbring_has_three_answers() {
    let system = coulomb(DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.5]));
    let got = all(&plain(&system, 2.0, &[0.6, -1.0]));
    assert_eq!(got.total, 4);
    let expected = [
        (PairScheme::STICK, [0.0, 0.0], [0.6, -1.0]),
        (PairScheme::SLIP_PLUS, [0.0, 0.4], [0.2, -0.4]),
        (PairScheme::OPEN, [0.2, 0.8], [0.0, 0.0]),
    ];
    assert_eq!(got.answers.len(), 3, "{got:?}");
    for (answer, (scheme, z, x)) in got.answers.iter().zip(expected) {
        assert_eq!(answer.schemes, [vec![scheme]]);
        assert!((&answer.state.z - DVector::from_row_slice(&z)).amax() < 1e-14);
        assert!((&answer.state.force - DVector::from_row_slice(&x)).amax() < 1e-14);
    }
    let below = all(&plain(&system, 1.4, &[0.6, -1.0]));
    assert_eq!(below.answers.len(), 1);
}

#[test]
fn unit_square_has_three_answers_above_its_critical_friction() {
    let system = unit_square();
    let load = [0.1, 0.1, 0.5, -0.5];
    let got = all(&plain(&system, 1.1, &load));
    assert_eq!(got.answers.len(), 3, "{got:?}");
    let slip = got
        .answers
        .iter()
        .find(|a| a.schemes.contains(&vec![PairScheme::SLIP_MINUS, PairScheme::SLIP_PLUS]))
        .expect("slip (−, +)");
    for i in 0..2 {
        assert!((slip.state.z[2 + i].abs() - 0.52).abs() < 1e-12);
        assert!((slip.state.force[i] - 0.1).abs() < 1e-12);
    }
    assert_eq!(all(&plain(&system, 0.9, &load)).answers.len(), 1);
}

#[test]
fn beam_beyond_its_limit_has_no_answer() {
    let system = beam();
    let got = all(&beam_problem(181.0));
    assert!(got.no_answer(), "{got:?}");
    // f = ¼ is exact in f64: 125 = 5 · 25, the fifth pair is on its limit and does not move, so two schemes meet in one
    // answer; z_1 = 25 · (1 + 2 + 3 + 4).
    let mut load = [0.0; 12];
    load[..6].fill(100.0);
    load[6] = -125.0;
    let got = all(&plain(&system, 0.25, &load));
    assert_eq!(got.answers.len(), 1);
    assert_eq!(got.answers[0].schemes.len(), 2);
    assert_eq!(got.answers[0].state.z[6], 250.0);
    let got = all(&beam_problem(150.0));
    assert_eq!(got.answers.len(), 1);
    assert!((got.answers[0].state.z[6] - 300.0).abs() < 1e-9);
    let got = all(&beam_problem(100.0));
    assert_eq!(got.answers.len(), 1);
}

#[test]
fn at_the_limit_there_is_a_continuum() {
    // f = ½ and weight 1 are exact in f64: six supports carry 3 to the last digit, and may all slide on.
    let system = beam();
    let mut load = [0.0; 12];
    load[..6].fill(1.0);
    load[6] = -3.0;
    let got = all(&plain(&system, 0.5, &load));
    assert!(!got.answers.is_empty());
    assert!(got.answers.iter().any(|a| a.continuum), "{got:?}");
}

#[test]
fn stops_when_told() {
    let system = coulomb(DMatrix::identity(20, 20));
    let problem = plain(&system, 0.5, &[0.0; 20]);
    let got = enumerate(&problem, &mut |_| ControlFlow::Break(()));
    assert!(!got.complete && !got.no_answer());
}

/// Lemke's answer by the tableau, in f64.
fn lemke(problem: &ContactProblem) -> Option<DVector<f64>> {
    let system = &*problem.system;
    let lcp = full_lcp::<f64>(problem, Covering::Cohesive);
    let run = run(&mut Tableau::new(&lcp, tangential_first(system)), 2000, &mut |_| ControlFlow::Continue(()));
    if !matches!(run.outcome, Outcome::Normal { .. } | Outcome::Trivial) {
        assert!(matches!(run.outcome, Outcome::Ray(_)), "{:?}", run.outcome);
        return None;
    }
    let mut z = DVector::zeros(system.joint_count());
    for (row, value) in rows(system, problem.polygon).iter().zip(&run.point.z) {
        row.joints(system, problem.polygon).for_each(|(joint, d)| z[joint] += d * value.to_f64());
    }
    Some(z)
}

/// Random R = AᵀA (integers with ties, or reals), `loose` rows fewer than needed.
fn random_problem(random: &mut ChaCha8Rng, m: usize, ties: bool, loose: usize) -> ContactProblem {
    let k = 2 * m;
    let mut number = |size: i32| random_number(random, ties, size);
    let a = DMatrix::from_fn(k + 1 - loose, k, |_, _| number(2));
    let mut r = a.transpose() * &a;
    if loose == 0 {
        r += DMatrix::identity(k, k);
    }
    let load: Vec<f64> = (0..k).map(|_| number(4)).collect();
    let f = [0.25, 0.5, 1.0, 3.0][random.random_range(0..4)];
    with_random_bound_and_gap(plain(&coulomb(r), f, &load), random)
}

#[test]
fn finds_the_answer_of_the_tableau() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for case in 0..240 {
        let m = 1 + case % 4;
        let problem = random_problem(&mut random, m, case % 2 == 0, 0);
        let z = lemke(&problem).expect("positive definite: an answer exists");
        let got = all(&problem);
        assert!(got.complete && got.undecided == 0, "case {case}");
        let size = z.amax().max(1.0);
        assert!(got.answers.iter().any(|a| (&a.state.z - &z).amax() < 1e-6 * size), "case {case}: {z} {got:?}");
        if !got.answers.iter().any(|a| a.continuum || a.schemes.len() > 1) {
            assert!(got.answers.len() % 2 == 1, "case {case}: an even number of answers");
        }
    }
}

#[test]
fn loose_parts_never_contradict_the_tableau() {
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let mut none = 0;
    for case in 0..160 {
        let m = 1 + case % 3;
        let problem = random_problem(&mut random, m, case % 2 == 0, 2);
        let got = all(&problem);
        assert!(got.complete);
        if lemke(&problem).is_some() {
            assert!(!got.no_answer(), "case {case}");
        }
        none += usize::from(got.no_answer());
    }
    assert!(none > 0);
}

/// Pairs of all laws; R without the tangential joints of frictionless pairs.
fn random_mixture(random: &mut ChaCha8Rng, m: usize, ties: bool) -> ContactProblem {
    let mut problem = random_problem(random, m, ties, 0);
    let system = Arc::make_mut(&mut problem.system);
    let zero = crate::model::parameter::Number::Value(0.0);
    let mut keep: Vec<usize> = (0..m).collect();
    for pair in 0..m {
        system.pairs[pair].tangential = keep.len()..keep.len() + 1;
        match random.random_range(0..3) {
            0 => {
                system.pairs[pair].law = Law::Frictionless { gap: zero.clone() };
                system.pairs[pair].tangential = 0..0;
                problem.laws[pair] = PairLaw::smooth(problem.laws[pair].gap());
                continue;
            }
            1 => {
                system.pairs[pair].law = Law::Bound { bound: zero.clone() };
                problem.laws[pair] = PairLaw::bilateral(f64::from(random.random_range(0..3)));
            }
            _ => {
                let cohesion = f64::from(random.random_range(0..2));
                problem.laws[pair] = problem.laws[pair].with_fixed_bound(cohesion);
            }
        }
        keep.push(m + pair);
    }
    system.stiffness = system.stiffness.select_rows(&keep).select_columns(&keep);
    problem.set_load(problem.load.select_rows(&keep));
    problem
}

#[test]
fn finds_the_answer_of_the_tableau_for_mixed_laws() {
    let mut random = ChaCha8Rng::seed_from_u64(14);
    for case in 0..300 {
        let m = 1 + case % 4;
        let problem = random_mixture(&mut random, m, case % 2 == 0);
        let z = lemke(&problem).expect("positive definite: an answer exists");
        let got = all(&problem);
        assert!(got.complete && got.undecided == 0, "case {case}");
        let size = z.amax().max(1.0);
        assert!(got.answers.iter().any(|a| (&a.state.z - &z).amax() < 1e-6 * size), "case {case}: {z} {got:?}");
    }
}

#[test]
fn a_bound_of_1e9_hides_nothing() {
    // R = 1: c1 opens by 1 (λ_n = z_n − 1), and its tangential force must vanish: z_t = −0.5. c2 never slips, its bound
    // being 1e9. Nothing else is an answer, whatever is small beside the bound.
    let mut system = coulomb(DMatrix::identity(4, 4));
    system.pairs[1].law = Law::Bound { bound: crate::model::parameter::Number::Value(1e9) };
    let mut problem = plain(&system, 0.3, &[-1.0, 1.0, 0.5, 0.25]);
    problem.laws[1] = PairLaw::bilateral(1e9);
    let got = all(&problem);
    assert_eq!(got.answers.len(), 1, "{got:?}");
    assert_eq!(got.answers[0].state.z, DVector::from_row_slice(&[1.0, 0.0, -0.5, 0.0]));
    assert!(got.complete && got.undecided == 0 && got.continua.is_empty());
}

#[test]
fn bounds_gaps_and_stiffnesses_of_any_size_leave_one_answer_in_a_diagonal_system() {
    // R diagonal: every pair is a problem of its own with exactly one answer, in closed form.
    let mut random = ChaCha8Rng::seed_from_u64(15);
    for case in 0..200 {
        let m = 1 + case % 5;
        let mut scale = || 2f64.powi(random.random_range(-30..=30));
        let mut r = DMatrix::zeros(2 * m, 2 * m);
        let mut load = vec![0.0; 2 * m];
        let mut bounds = vec![0.0; m];
        for j in 0..2 * m {
            r[(j, j)] = scale();
            load[j] = r[(j, j)] * (scale() - scale());
        }
        bounds.iter_mut().for_each(|bound| *bound = scale() * scale());
        let mut system = coulomb(r.clone());
        let mut laws = vec![PairLaw::rubbing(0.25, 0.0, 0.0); m];
        for pair in (0..m).filter(|pair| pair % 2 == 1) {
            system.pairs[pair].law = Law::Bound { bound: crate::model::parameter::Number::Value(bounds[pair]) };
            laws[pair] = PairLaw::bilateral(bounds[pair]);
        }
        let problem = ContactProblem::exactly(&Arc::new(system), laws, DVector::from_row_slice(&load));
        let got = all(&problem);
        assert_eq!(got.answers.len(), 1, "case {case}: {got:?}");
        for pair in 0..m {
            let (n, t) = (load[pair], load[m + pair]);
            let (bound, open) = if pair % 2 == 1 { (bounds[pair], false) } else { (0.25 * n.max(0.0), n < 0.0) };
            let slip = if t.abs() <= bound { 0.0 } else { -(t - bound.copysign(t)) / r[(m + pair, m + pair)] };
            let z_n = if open { -n / r[(pair, pair)] } else { 0.0 };
            let z = &got.answers[0].state.z;
            assert!((z[pair] - z_n).abs() <= 1e-15 * z_n.abs(), "case {case}, pair {pair}");
            // t − bound cancels in f64 here, not in the search.
            let noise = 4.0 * f64::EPSILON * (t.abs() + bound) / r[(m + pair, m + pair)];
            assert!((z[m + pair] - slip).abs() <= noise, "case {case}, pair {pair}: {} {slip}", z[m + pair]);
        }
    }
}

#[test]
fn a_continuum_tells_its_direction() {
    // One frictionless pair without stiffness, at its limit: it opens without end.
    let mut system = coulomb(DMatrix::zeros(2, 2));
    system.kernel = DMatrix::identity(2, 2);
    let got = all(&plain(&system, 0.5, &[0.0, 0.0]));
    assert!(got.complete);
    assert!(!got.continua.is_empty(), "{got:?}");
    let upwards = got.continua.iter().flat_map(|piece| &piece.directions).any(|z| z[0] == 1.0);
    assert!(upwards, "{got:?}");
}

/// `cargo test --release --lib enumerate -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn ten_pairs() {
    let mut random = ChaCha8Rng::seed_from_u64(13);
    for (loose, cohesive) in [(0, false), (0, true), (3, false)] {
        let mut problem = random_problem(&mut random, 10, false, loose);
        if cohesive {
            problem.laws.iter_mut().for_each(|law| *law = law.with_fixed_bound(0.5));
        }
        let start = std::time::Instant::now();
        let got = all(&problem);
        std::io::Write::write_all(
            &mut std::io::stderr(),
            format!(
                "loose {loose}, cohesion {cohesive}: {:?}; {} answers, visited {}, cut {}, of {}\n",
                start.elapsed(),
                got.answers.len(),
                got.visited,
                got.cut,
                got.total
            )
            .as_bytes(),
        )
        .unwrap();
    }
}
