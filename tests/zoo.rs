//! Small LCPs with known answers (validation, "A zoo of LCPs"), through the working-scheme engine.

use std::ops::ControlFlow;
use std::sync::Arc;

use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::mirrored::MirroredLcp;
use stickslip::lcp::outcome::{Outcome, Run};
use stickslip::lcp::problem::{Lcp, Scale};
use stickslip::lcp::ratio_test::TieRule;

fn solve(matrix: Vec<Vec<f64>>, q: Vec<f64>, rule: Option<TieRule>) -> Run {
    let n = q.len();
    let scale = Scale::plain(&matrix);
    let lcp = Lcp { matrix, q, covering: vec![1.0; n], scale };
    let rule = rule.unwrap_or_else(|| TieRule::Lexicographic((0..n).collect()));
    let mut engine = SchemeEngine::new(Arc::new(MirroredLcp::plain(&lcp)), rule);
    run(&mut engine, 10_000, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn cottle_pang_stone_4_4_7_in_five_pivots() {
    let m = vec![vec![0.0, -1.0, 2.0], vec![2.0, 0.0, -2.0], vec![-1.0, 1.0, 0.0]];
    let run = solve(m, vec![-3.0, 6.0, -1.0], None);
    assert_eq!(run.outcome, Outcome::Normal { marginal: false });
    assert_eq!(run.pivots.count(), 5);
    for (z, expected) in run.point.z.iter().zip([0.0, 1.0, 3.0]) {
        assert!((z - expected).abs() < 1e-14);
    }
}

#[test]
fn continuum_4_1_14() {
    let run = solve(vec![vec![1.0; 2]; 2], vec![-1.0; 2], None);
    assert_eq!(run.outcome, Outcome::Normal { marginal: false });
    assert!((run.point.z[0] + run.point.z[1] - 1.0).abs() < 1e-15);
}

#[test]
fn bimatrix_4_4_23_ends_in_a_ray_at_the_first_pivot() {
    let m = vec![
        vec![0.0, 0.0, 10.0, 20.0],
        vec![0.0, 0.0, 30.0, 15.0],
        vec![10.0, 20.0, 0.0, 0.0],
        vec![30.0, 15.0, 0.0, 0.0],
    ];
    let run = solve(m, vec![-1.0; 4], None);
    assert!(matches!(run.outcome, Outcome::Ray(_)), "{:?}", run.outcome);
    assert_eq!(run.pivots.count(), 1);
}

fn murty(n: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
    let m = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| {
                    if i == j {
                        1.0
                    } else if j < i {
                        2.0
                    } else {
                        0.0
                    }
                })
                .collect()
        })
        .collect();
    let q = (1..=n).map(|i| -(n + 1 - i..=n).map(|j| 2f64.powi(j as i32)).sum::<f64>()).collect();
    (m, q)
}

#[test]
fn murty_takes_two_to_the_n_pivots() {
    for n in 2..=9 {
        let (m, q) = murty(n);
        if n == 6 {
            assert_eq!(q, [-64.0, -96.0, -112.0, -120.0, -124.0, -126.0]);
        }
        let run = solve(m, q, None);
        assert_eq!(run.outcome, Outcome::Normal { marginal: false });
        assert_eq!(run.pivots.count(), 1 << n, "n = {n}");
    }
}

#[test]
fn cycling_under_first_row_ends_in_four_pivots_under_lexicographic() {
    let m = vec![vec![1.0, 2.0, 0.0], vec![0.0, 1.0, 2.0], vec![2.0, 0.0, 1.0]];
    let run = solve(m.clone(), vec![-1.0; 3], Some(TieRule::FirstRow));
    assert!(matches!(run.outcome, Outcome::Cycle(_)), "{:?}", run.outcome);
    let run = solve(m, vec![-1.0; 3], None);
    assert_eq!(run.outcome, Outcome::Normal { marginal: false });
    assert_eq!(run.pivots.count(), 4);
    for z in run.point.z {
        assert!((z - 1.0 / 3.0).abs() < 1e-15);
    }
}

#[test]
fn painleve_rod() {
    assert!(matches!(solve(vec![vec![-0.05]], vec![-1.0], None).outcome, Outcome::Ray(_)));
    assert_eq!(solve(vec![vec![-0.05]], vec![1.0], None).outcome, Outcome::Trivial);
}
