//! Known answers, the limit load of the bar, the exact engine on contact problems.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::contact::law::PairLaw;
use crate::contact::polygon::Polygon;
use crate::contact::system::{ContactPair, ContactSystem};
use crate::lcp::driver::run;
use crate::lcp::exact::lemke::Exact;
use crate::lcp::exact::tableau::Tableau;
use crate::lcp::outcome::Outcome;
use crate::lcp::ratio_test::TieRule;
use crate::model::pair::Law;
use crate::model::parameter::Number;
use crate::watch::Quiet;

/// m Coulomb pairs with this R (normals, then tangentials).
pub(crate) fn coulomb(stiffness: DMatrix<f64>) -> ContactSystem {
    with_tangents(stiffness, 1)
}

/// m Coulomb pairs in space with this R (normals, then t1 and t2 of each pair).
pub(crate) fn coulomb_in_space(stiffness: DMatrix<f64>) -> ContactSystem {
    with_tangents(stiffness, 2)
}

fn with_tangents(stiffness: DMatrix<f64>, tangents: usize) -> ContactSystem {
    let m = stiffness.nrows() / (1 + tangents);
    let zero = || Number::Value(0.0);
    ContactSystem {
        tangents,
        pairs: (0..m)
            .map(|i| ContactPair {
                id: format!("c{}", i + 1),
                law: Law::Coulomb { friction: zero(), cohesion: zero(), gap: zero() },
                position: None,
                frame: None,
                joint: 0,
                tangential: m + tangents * i..m + tangents * (i + 1),
            })
            .collect(),
        kernel: DMatrix::zeros((1 + tangents) * m, 0),
        rounded: false,
        groups: Vec::new(),
        corrected: None,
        force_form: None,
        yielding: None,
        file: None,
        loads: Vec::new(),
        stiffness,
    }
}

/// The same f everywhere, no cohesion, no gap.
pub(crate) fn plain(system: &ContactSystem, f: f64, load: &[f64]) -> ContactProblem {
    let laws = vec![PairLaw::rubbing(f, 0.0, 0.0); system.pair_count()];
    ContactProblem::exactly(&Arc::new(system.clone()), laws, DVector::from_row_slice(load))
}

/// A random number up to a size, whole (so that there are ties) or real.
pub(crate) fn random_number(random: &mut ChaCha8Rng, whole: bool, size: i32) -> f64 {
    match whole {
        true => f64::from(random.random_range(-size..=size)),
        false => random.random_range(-f64::from(size)..=f64::from(size)),
    }
}

/// In three problems of ten the first pair has a fixed bound, in three of ten the last one a gap.
pub(crate) fn with_random_bound_and_gap(mut problem: ContactProblem, random: &mut ChaCha8Rng) -> ContactProblem {
    let last = problem.laws.len() - 1;
    if random.random_bool(0.3) {
        problem.laws[0] = problem.laws[0].with_fixed_bound(1.0);
    }
    if random.random_bool(0.3) {
        problem.laws[last] = problem.laws[last].with_gap(0.5);
    }
    problem
}

/// Normals last: the default rule.
pub(crate) fn tangential_first(system: &ContactSystem) -> TieRule {
    tangential_first_on(system, Polygon::PLANE)
}

/// The same on a polygon.
pub(crate) fn tangential_first_on(system: &ContactSystem, polygon: Polygon) -> TieRule {
    let rows = rows(system, polygon);
    let normals = rows.iter().filter(|r| r.couple == RowKind::Normal).count();
    TieRule::Lexicographic((normals..rows.len()).chain(0..normals).collect())
}

/// Paper, Example 1, six supports, EA/L = 1: R of the chain, normals stiff on their own.
pub(crate) fn beam() -> ContactSystem {
    let mut r = DMatrix::zeros(12, 12);
    for i in 0..6 {
        r[(i, i)] = 1.0;
    }
    for e in 0..5 {
        let (a, b) = (6 + e, 7 + e);
        r[(a, a)] += 1.0;
        r[(b, b)] += 1.0;
        r[(a, b)] -= 1.0;
        r[(b, a)] -= 1.0;
    }
    coulomb(r)
}

/// Weight 100, f = 0.3, pull at the first pair. The load on a joint is −(external force along t).
pub(crate) fn beam_problem(pull: f64) -> ContactProblem {
    let mut load = [0.0; 12];
    load[..6].fill(100.0);
    load[6] = -pull;
    plain(&beam(), 0.3, &load)
}

#[test]
fn bar_on_six_supports_in_both_number_types() {
    for (pull, expected) in [
        (100.0, Some([120.0, 50.0, 10.0, 0.0, 0.0, 0.0])),
        (150.0, Some([300.0, 180.0, 90.0, 30.0, 0.0, 0.0])),
        (181.0, None),
    ] {
        let problem = beam_problem(pull);
        for covering in Covering::ALL {
            let d_t = match covering {
                Covering::Cohesive => 1.3,
                Covering::Ones => 1.0,
                Covering::Weight => 0.3,
            };
            check::<f64>(&problem, covering, expected, d_t);
            check::<BigRational>(&problem, covering, expected, d_t);
        }
    }
}

fn check<T: Scalar>(problem: &ContactProblem, covering: Covering, expected: Option<[f64; 6]>, d_t: f64) {
    let lcp = full_lcp::<T>(problem, covering);
    let rule = tangential_first(&problem.system);
    let run = run(&mut Tableau::new(&lcp, rule), 100, &mut |_| ControlFlow::Continue(()));
    match expected {
        Some(slip) => {
            assert!(matches!(run.outcome, Outcome::Normal { .. }));
            for (i, slip) in slip.iter().enumerate() {
                let z = run.point.z[6 + i].to_f64() - run.point.z[12 + i].to_f64();
                assert!((z - slip).abs() < 1e-9, "{z} {slip}");
            }
        }
        None => {
            assert!(matches!(run.outcome, Outcome::Ray(_)), "{:?}", run.outcome);
            let p = run.point.p.to_f64();
            assert!((p - 1.0 / (6.0 * d_t)).abs() < 1e-9, "{p}");
        }
    }
}

#[test]
fn laws_mix() {
    let mut system = coulomb(DMatrix::from_fn(5, 5, |i, j| if i == j { 2.0 } else { 0.1 * (i + j) as f64 }));
    let zero = Number::Value(0.0);
    let pair = |id: &str, law, tangential| ContactPair {
        id: id.into(),
        law,
        position: None,
        frame: None,
        joint: 0,
        tangential,
    };
    system.pairs = vec![
        pair("a", Law::Frictionless { gap: zero.clone() }, 3..3),
        pair("b", Law::Bound { bound: zero.clone() }, 3..4),
        pair("c", Law::Coulomb { friction: zero.clone(), cohesion: zero.clone(), gap: zero }, 4..5),
    ];
    let laws = vec![PairLaw::smooth(1.0), PairLaw::bilateral(3.0), PairLaw::rubbing(0.5, 0.25, 0.0)];
    let problem =
        ContactProblem::exactly(&Arc::new(system.clone()), laws, DVector::from_row_slice(&[1.0, 2.0, 3.0, 4.0, 5.0]));
    let lcp = full_lcp::<f64>(&problem, Covering::Cohesive);
    let kinds: Vec<_> = rows(&system, Polygon::PLANE).iter().map(|r| (r.pair, r.couple)).collect();
    assert_eq!(
        kinds,
        [
            (0, RowKind::Normal),
            (2, RowKind::Normal),
            (1, RowKind::PLUS),
            (2, RowKind::PLUS),
            (1, RowKind::MINUS),
            (2, RowKind::MINUS)
        ]
    );
    let r = |i: usize, j: usize| system.stiffness[(i, j)];
    let v = |i: usize| problem.load[i] - r(i, 0);
    let expected = [v(0), v(2), 3.0 + v(3), 0.25 + 0.5 * v(2) + v(4), 3.0 - v(3), 0.25 + 0.5 * v(2) - v(4)];
    for (q, e) in lcp.q.iter().zip(expected) {
        assert!((q - e).abs() < 1e-14);
    }
    assert_eq!(lcp.covering, [1.0, 1.0, 1.0, 1.5, 1.0, 1.5]);
    // x⁻ of c against z⁻ of b: −(f R_n − R_τ) on the tangential joint of b.
    assert!((lcp.matrix[5][4] - (r(4, 3) - 0.5 * r(2, 3))).abs() < 1e-15);
}

/// A bar on n supports, each pressed by F, just above its limit load n f F: p = (F2 − n f F) / (n d_τ), with R as a
/// factorization leaves it: noise where true zeros are, kernel made exact by projection.
#[test]
fn p_at_the_limit_of_the_bar() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(33);
    for spacing in [1.0, 3.0, 6.0, 12.0] {
        for n in [3usize, 6, 9] {
            let k = 2 * n;
            let mut r = DMatrix::from_fn(k, k, |_, _| 1e-17 * random.random_range(-1.0..1.0));
            r = (&r + r.transpose()) * 0.5;
            let stiffness = 2.1e6 / spacing;
            for i in 0..n {
                r[(i, i)] += 0.7 * stiffness;
            }
            for e in n..k - 1 {
                for (i, j, sign) in [(e, e, 1.0), (e + 1, e + 1, 1.0), (e, e + 1, -1.0), (e + 1, e, -1.0)] {
                    r[(i, j)] += sign * stiffness;
                }
            }
            let z = DVector::from_fn(k, |i, _| if i < n { 0.0 } else { 1.0 / (n as f64).sqrt() });
            let keep = DMatrix::identity(k, k) - &z * z.transpose();
            let r = &keep * r * &keep;
            let system = coulomb((&r + r.transpose()) * 0.5);
            let limit = 30.0 * n as f64;
            for (excess, tolerance) in [(1e-9, 1e-5), (1e-6, 1e-8)] {
                let pull = limit * (1.0 + excess);
                let mut load = vec![0.0; k];
                load[..n].fill(100.0);
                load[n] = -pull;
                let problem = plain(&system, 0.3, &load);
                for (covering, d_t) in Covering::ALL.into_iter().zip([1.3, 1.0, 0.3]) {
                    let lcp = full_lcp::<f64>(&problem, covering);
                    let got =
                        run(
                            &mut Tableau::new(&lcp, tangential_first(&system)),
                            200,
                            &mut |_| ControlFlow::Continue(()),
                        );
                    let expected = (pull - limit) / (n as f64 * d_t);
                    assert!(matches!(got.outcome, Outcome::Ray(_)), "{spacing} {n} {covering}: {:?}", got.outcome);
                    assert!(
                        (got.point.p / expected - 1.0).abs() < tolerance,
                        "{spacing} {n} {covering} {excess}: {} {expected}",
                        got.point.p
                    );
                }
                let below = ContactProblem {
                    load: DVector::from_fn(k, |i, _| if i == n { -limit * (1.0 - excess) } else { problem.load[i] }),
                    ..problem
                };
                let lcp = full_lcp::<f64>(&below, Covering::Cohesive);
                let got =
                    run(&mut Tableau::new(&lcp, tangential_first(&system)), 200, &mut |_| ControlFlow::Continue(()));
                assert!(matches!(got.outcome, Outcome::Normal { marginal: false }), "{:?}", got.outcome);
            }
        }
    }
}

/// Random positive definite R with stiffness contrasts up to `contrast`, reals.
fn random_contact(random: &mut rand_chacha::ChaCha8Rng, m: usize, contrast: f64) -> ContactSystem {
    use rand::Rng;
    let k = 2 * m;
    let a = DMatrix::from_fn(k, k, |_, _| random.random_range(-1.0..1.0));
    let scale = DMatrix::from_diagonal(&DVector::from_fn(k, |_, _| contrast.powf(random.random_range(0.0..0.5))));
    let r = &scale * (&a * a.transpose() + DMatrix::identity(k, k) * 0.1) * &scale;
    coulomb((&r + r.transpose()) * 0.5)
}

fn run_exact(problem: &ContactProblem, covering: Covering) -> crate::lcp::outcome::Run<BigRational> {
    let lcp = full_lcp::<BigRational>(problem, covering);
    let mut engine = Exact::new(lcp, tangential_first(&problem.system), &Quiet);
    run(&mut engine, 5000, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn exact_engine_solves_stiffness_contrasts() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(31);
    for case in 0..60 {
        let m = 1 + case % 6;
        let system = random_contact(&mut random, m, 1e9);
        let load: Vec<f64> = (0..2 * m).map(|_| random.random_range(-1.0..1.0)).collect();
        let problem = plain(&system, [0.3, 1.0, 4.0][case % 3], &load);
        let got = run_exact(&problem, Covering::Cohesive);
        assert!(
            matches!(got.outcome, Outcome::Trivial | Outcome::Normal { marginal: false }),
            "case {case}: {:?}",
            got.outcome
        );
    }
}

/// Contact problems with ties, gaps and cohesion: the f64 tableau against the exact engine.
fn engines_agree(problems: usize, most_pairs: usize) {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(34);
    for case in 0..problems {
        let m = random.random_range(1..=most_pairs);
        let k = 2 * m;
        let ties = case % 2 == 0;
        let mut number = |range: i32| {
            if ties {
                f64::from(random.random_range(-range..=range))
            } else {
                random.random_range(-f64::from(range)..=f64::from(range))
            }
        };
        let a = DMatrix::from_fn(k, k, |_, _| number(2));
        let system = coulomb(&a * a.transpose() + DMatrix::identity(k, k));
        let load: Vec<f64> = (0..k).map(|_| number(4)).collect();
        let mut problem = plain(&system, [0.25, 0.5, 1.0, 2.0, 5.0][random.random_range(0..5)], &load);
        for law in &mut problem.laws {
            *law = law.with_fixed_bound(f64::from(random.random_range(0..2)));
            *law = law.with_gap(0.25 * f64::from(random.random_range(0..2)));
        }
        for covering in Covering::ALL {
            let rounded = run(
                &mut Tableau::new(&full_lcp::<f64>(&problem, covering), tangential_first(&system)),
                5000,
                &mut |_| ControlFlow::Continue(()),
            );
            let exact = run_exact(&problem, covering);
            let kind = |ray: bool, answer: bool| (ray, answer);
            let rounded_kind = kind(
                matches!(rounded.outcome, Outcome::Ray(_)),
                matches!(rounded.outcome, Outcome::Normal { .. } | Outcome::Trivial),
            );
            let exact_kind = kind(
                matches!(exact.outcome, Outcome::Ray(_)),
                matches!(exact.outcome, Outcome::Normal { .. } | Outcome::Trivial),
            );
            assert_eq!(rounded_kind, exact_kind, "case {case} {covering}: {:?}", rounded.outcome);
            assert!(exact_kind.1 || covering != Covering::Cohesive, "case {case}");
            let size = exact.point.z.iter().map(|z| Scalar::to_f64(z).abs()).fold(1e-3, f64::max);
            for (a, b) in rounded.point.z.iter().zip(&exact.point.z) {
                assert!((a - Scalar::to_f64(b)).abs() < 1e-6 * size, "case {case} {covering}");
            }
        }
    }
}

#[test]
fn f64_and_exact_engine_agree() {
    engines_agree(150, 6);
}

/// `cargo test --release --lib full_lcp -- --ignored`
#[test]
#[ignore = "long"]
fn f64_and_exact_engine_agree_on_many() {
    engines_agree(2000, 12);
}

/// `cargo test --release --lib full_lcp -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn exact_engine_with_sixty_pairs() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(32);
    for (contrast, f) in [(1.0, 0.3), (1.0, 2.0), (1e9, 0.5)] {
        let m = 60;
        let system = random_contact(&mut random, m, contrast);
        let load: Vec<f64> = (0..2 * m).map(|_| random.random_range(-1.0..1.0)).collect();
        let problem = plain(&system, f, &load);
        let start = std::time::Instant::now();
        let got = run_exact(&problem, Covering::Cohesive);
        let outcome = format!("{:?}", got.outcome);
        std::io::Write::write_all(
            &mut std::io::stderr(),
            format!(
                "contrast {contrast:e}, f {f}: {:?}, {} pivots, {}\n",
                start.elapsed(),
                got.pivots.count(),
                &outcome[..outcome.len().min(40)]
            )
            .as_bytes(),
        )
        .unwrap();
    }
}
