//! The zoo of LCPs, and f64 against exact numbers.

use std::ops::ControlFlow;

use num_rational::BigRational;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::lcp::driver::run;
use crate::lcp::outcome::Run;
use crate::lcp::problem::Scale;

fn lcp<T: Scalar>(m: &[Vec<f64>], q: &[f64], d: &[f64]) -> Lcp<T> {
    let convert = |v: &[f64]| v.iter().map(|x| T::from_f64(*x)).collect::<Vec<T>>();
    Lcp {
        matrix: m.iter().map(|row| convert(row)).collect(),
        q: convert(q),
        covering: convert(d),
        scale: Scale {
            row: m.iter().map(|row| row.iter().fold(0.0, |a: f64, x| a.max(x.abs()))).collect(),
            column: vec![1.0; q.len()],
            load: None,
        },
    }
}

fn solve<T: Scalar>(m: &[Vec<f64>], q: &[f64], rule: TieRule) -> Run<T> {
    let d = vec![1.0; q.len()];
    run(&mut Tableau::new(&lcp::<T>(m, q, &d), rule), 500, &mut |_| ControlFlow::Continue(()))
}

fn natural(n: usize) -> TieRule {
    TieRule::Lexicographic((0..n).collect())
}

fn z<T: Scalar>(run: &Run<T>) -> Vec<f64> {
    run.point.z.iter().map(Scalar::to_f64).collect()
}

fn zoo<T: Scalar>() {
    // Cottle, Pang, Stone 4.4.7
    let m = [vec![0., -1., 2.], vec![2., 0., -2.], vec![-1., 1., 0.]];
    let got = solve::<T>(&m, &[-3., 6., -1.], natural(3));
    assert!(matches!(got.outcome, Outcome::Normal { .. }));
    assert_eq!(got.pivots.count(), 5);
    assert_eq!(z(&got), [0., 1., 3.]);

    // 4.1.14: a continuum z1 + z2 = 1
    let got = solve::<T>(&[vec![1., 1.], vec![1., 1.]], &[-1., -1.], natural(2));
    assert!(matches!(got.outcome, Outcome::Normal { marginal: false }));
    assert_eq!(z(&got).iter().sum::<f64>(), 1.0);

    // 4.4.23: bimatrix game, ray at the first pivot
    let m = [vec![0., 0., 10., 20.], vec![0., 0., 30., 15.], vec![10., 20., 0., 0.], vec![30., 15., 0., 0.]];
    let got = solve::<T>(&m, &[-1.; 4], natural(4));
    assert!(matches!(got.outcome, Outcome::Ray(_)), "{:?}", got.outcome);
    assert_eq!(got.pivots.count(), 1);
    assert_eq!(got.point.p.to_f64(), 1.0);

    // Murty: 2^n pivots
    for n in 1..=6usize {
        let m: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| match j.cmp(&i) {
                        Ordering::Less => 2.0,
                        Ordering::Equal => 1.0,
                        Ordering::Greater => 0.0,
                    })
                    .collect()
            })
            .collect();
        let q: Vec<f64> = (1..=n).map(|i| -(n + 1 - i..=n).map(|j| 2f64.powi(j as i32)).sum::<f64>()).collect();
        let got = solve::<T>(&m, &q, natural(n));
        assert!(matches!(got.outcome, Outcome::Normal { marginal: false }));
        assert_eq!(got.pivots.count(), 1 << n);
    }

    // Painlevé's rod
    let got = solve::<T>(&[vec![-0.05]], &[-1.], natural(1));
    assert!(matches!(got.outcome, Outcome::Ray(_)));
    let got = solve::<T>(&[vec![-0.05]], &[1.], natural(1));
    assert!(matches!(got.outcome, Outcome::Trivial));
    assert!(got.pivots.is_empty());
    assert_eq!(got.point.w[0].to_f64(), 1.0);
}

#[test]
fn zoo_in_f64() {
    zoo::<f64>();
}

#[test]
fn zoo_in_rationals() {
    zoo::<BigRational>();
}

fn cycling<T: Scalar>() {
    let m = [vec![1., 2., 0.], vec![0., 1., 2.], vec![2., 0., 1.]];
    let got = solve::<T>(&m, &[-1.; 3], TieRule::FirstRow);
    assert!(matches!(got.outcome, Outcome::Cycle(_)), "{:?}", got.outcome);
    let got = solve::<T>(&m, &[-1.; 3], natural(3));
    assert!(matches!(got.outcome, Outcome::Normal { marginal: false }));
    assert_eq!(got.pivots.count(), 4);
    for x in z(&got) {
        assert!((x - 1.0 / 3.0).abs() < 1e-15);
    }
}

#[test]
fn first_row_cycles_where_lexicographic_ends() {
    cycling::<f64>();
    cycling::<BigRational>();
}

#[test]
fn random_ties_repeat_with_their_seed() {
    let m = [vec![1., 2., 0.], vec![0., 1., 2.], vec![2., 0., 1.]];
    for seed in 0..5 {
        let a = solve::<f64>(&m, &[-1.; 3], TieRule::Random(seed));
        let b = solve::<f64>(&m, &[-1.; 3], TieRule::Random(seed));
        assert_eq!(a, b);
    }
}

#[test]
fn a_ray_is_a_direction_of_the_problem() {
    // w̄ = M z̄ + d p̄ for the Painlevé rod: the reserve is lost whatever z.
    let m = [vec![-1.0, 0.5], vec![0.25, -2.0]];
    let got = solve::<BigRational>(&m, &[-1.0, -3.0], natural(2));
    let Outcome::Ray(ray) = &got.outcome else { panic!("{:?}", got.outcome) };
    let problem = lcp::<BigRational>(&m, &[-1.0, -3.0], &[1.0, 1.0]);
    for i in 0..2 {
        let mut w = problem.covering[i].mul(&ray.p);
        for (j, z) in ray.z.iter().enumerate() {
            w = Scalar::add(&w, &Scalar::mul(&problem.matrix[i][j], z));
        }
        assert_eq!(w, ray.w[i]);
    }
}

/// A problem with small integers: ties everywhere.
fn integer_problem(random: &mut ChaCha8Rng) -> (Vec<Vec<f64>>, Vec<f64>) {
    let n = random.random_range(1..=6);
    let m = (0..n).map(|_| (0..n).map(|_| f64::from(random.random_range(-2..=3))).collect()).collect();
    let q = (0..n).map(|_| f64::from(random.random_range(-3..=2))).collect();
    (m, q)
}

#[test]
fn f64_and_rationals_make_the_same_pivots() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for case in 0..1000 {
        let (m, q) = integer_problem(&mut random);
        let rule = match case % 3 {
            0 => TieRule::FirstRow,
            1 => TieRule::Random(case),
            _ => natural(q.len()),
        };
        let a = solve::<f64>(&m, &q, rule.clone());
        let b = solve::<BigRational>(&m, &q, rule.clone());
        let word = |o: &str| o.split(['(', ' ']).next().unwrap_or("").to_owned();
        assert_eq!(word(&format!("{:?}", a.outcome)), word(&format!("{:?}", b.outcome)), "case {case}: {m:?} {q:?}");
        let path = |pivots: &PivotLog| {
            pivots.recorded().iter().map(|p| (p.entering, p.leaving, p.ties.clone())).collect::<Vec<_>>()
        };
        assert_eq!(path(&a.pivots), path(&b.pivots), "case {case}: {m:?} {q:?}");
        if matches!(b.outcome, Outcome::Cycle(_) | Outcome::PivotLimit) {
            assert!(!matches!(rule, TieRule::Lexicographic(_)));
        }
    }
}
