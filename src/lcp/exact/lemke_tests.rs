//! The same run as the rational tableau.

use std::ops::ControlFlow;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::lcp::driver::run;
use crate::lcp::pivot::Pivot;
use crate::lcp::problem::Scale;
use crate::watch::Quiet;

fn problem(m: Vec<Vec<BigRational>>, q: Vec<BigRational>) -> Lcp<BigRational> {
    let n = q.len();
    Lcp {
        matrix: m,
        q,
        covering: vec![Scalar::one(); n],
        scale: Scale { row: vec![1.0; n], column: vec![1.0; n], load: None },
    }
}

#[test]
fn same_run_as_the_rational_tableau() {
    let mut random = ChaCha8Rng::seed_from_u64(21);
    let mut rays = 0;
    for case in 0..600u64 {
        let n = random.random_range(1..=7usize);
        // Integers (ties), thirds (denominators that are not powers of two), or any f64.
        let mut number = |range: i64| match case % 3 {
            0 => BigRational::from_integer(BigInt::from(random.random_range(-range..=range + 1))),
            1 => BigRational::new(BigInt::from(random.random_range(-range..=range + 1)), BigInt::from(3)),
            _ => <BigRational as Scalar>::from_f64(random.random_range(-1.0..1.5) * range as f64),
        };
        let m = (0..n).map(|_| (0..n).map(|_| number(2)).collect()).collect();
        let q = (0..n).map(|_| number(3)).collect();
        let lcp = problem(m, q);
        let rule = match case % 5 {
            0 => TieRule::FirstRow,
            1 => TieRule::Random(case),
            _ => TieRule::Lexicographic((0..n).rev().collect()),
        };
        let mut on = |_: &Pivot| ControlFlow::Continue(());
        let slow = run(&mut Tableau::new(&lcp, rule.clone()), 300, &mut on);
        let fast = run(&mut Exact::new(lcp, rule, &Quiet), 300, &mut on);
        assert_eq!(slow.outcome, fast.outcome, "case {case}");
        assert_eq!(slow.point, fast.point, "case {case}");
        assert_eq!(slow.pivots.count(), fast.pivots.count());
        for (a, b) in slow.pivots.recorded().iter().zip(fast.pivots.recorded()) {
            assert_eq!((a.entering, a.leaving, &a.ties), (b.entering, b.leaving, &b.ties));
            assert!((a.p_after - b.p_after).abs() <= 1e-12 * a.p_after.abs());
        }
        rays += usize::from(matches!(slow.outcome, Outcome::Ray(_)));
    }
    assert!(rays > 20);
}

#[test]
fn takes_more_bits_where_they_are_needed() {
    // w2 loses to w1 by 2^-2000 only.
    let one = || BigRational::from_integer(BigInt::from(1));
    let tiny = BigRational::new(BigInt::from(1), BigInt::from(1) << 2000u32);
    let third = BigRational::new(BigInt::from(1), BigInt::from(3));
    let m = vec![vec![one(), Zero::zero()], vec![Zero::zero(), one()]];
    let lcp = problem(m, vec![-&third - &tiny, -third]);
    let mut engine = Exact::new(lcp, TieRule::Lexicographic(vec![0, 1]), &Quiet);
    assert_eq!(engine.step(), Step::Pivoted);
    assert_eq!(engine.pivots().recorded()[0].leaving, Variable::W(0));
    assert_eq!(engine.pivots().recorded()[0].ties.len(), 1);
    assert!(engine.precision() > 2000);
}
