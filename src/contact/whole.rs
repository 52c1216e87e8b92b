//! The contact problem as one LCP with every row written out (theory §3), in any number type.
//!
//! Coulomb, with f and c diagonal, laws mixed pair by pair:
//!
//! ```text
//! [x_n]   [ Rnn           RnT           −RnT         ] [z_n]   [ RFn               ]
//! [x⁺ ] = [ RTn + f·Rnn   RTT + f·RnT   −RTT − f·RnT ] [z⁺ ] + [ RFτ + f·RFn + c   ]
//! [x⁻ ]   [−RTn + f·Rnn  −RTT + f·RnT    RTT − f·RnT ] [z⁻ ]   [−RFτ + f·RFn + c   ]
//! ```
//!
//! with RF − R·(g, 0) in the place of RF. Rows: x_n of all pairs but the bound ones, then x⁺ of all Coulomb and
//! bound pairs, then their x⁻. A frictionless pair has only x_n; a bound pair only x^± = r_f ± x_τ.
//! The sums are formed in the number type asked for: exact from the f64 data in rationals.

use crate::lcp::problem::{Lcp, Scale};
use crate::lcp::scalar::Scalar;
use crate::model::pair::Law;
use crate::model::rules::Covering;

use super::numbers::ContactNumbers;
use super::system::ContactSystem;

/// What [`whole_lcp`] needs.
#[derive(Clone, Copy, Debug)]
pub struct WholeInput<'a> {
    /// Pairs and R.
    pub system: &'a ContactSystem,
    /// Numbers of the laws and the load.
    pub numbers: &'a ContactNumbers,
    /// Covering vector.
    pub covering: Covering,
}

/// Quantity of a pair that a row of the LCP stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// x_n with z_n.
    Normal,
    /// x⁺ with z⁺.
    Plus,
    /// x⁻ with z⁻.
    Minus,
}

/// A row of the LCP.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Row {
    /// Index of the pair.
    pub pair: usize,
    /// Which of its quantities.
    pub kind: RowKind,
}

/// The rows of the LCP in order.
pub fn rows(system: &ContactSystem) -> Vec<Row> {
    let of = |kind: RowKind, has: fn(&Law) -> bool| {
        system
            .pairs
            .iter()
            .enumerate()
            .filter(move |(_, pair)| has(&pair.law))
            .map(move |(pair, _)| Row { pair, kind })
    };
    let normal: fn(&Law) -> bool = |law| !matches!(law, Law::Bound { .. });
    let tangential: fn(&Law) -> bool = |law| !matches!(law, Law::Frictionless { .. });
    of(RowKind::Normal, normal)
        .chain(of(RowKind::Plus, tangential))
        .chain(of(RowKind::Minus, tangential))
        .collect()
}

/// Row of R of the tangential joint of a pair that has one by its law.
///
/// # Panics
/// If a Coulomb or bound pair has no tangential joint: a [`ContactSystem`] is never built so.
pub(crate) fn tangential_joint(system: &ContactSystem, pair: usize) -> usize {
    system.pairs[pair]
        .tangential
        .expect("a coulomb or bound pair has a tangential joint")
}

/// f of a pair as its law uses it: 0 for frictionless and bound pairs.
pub(crate) fn friction(system: &ContactSystem, numbers: &ContactNumbers, pair: usize) -> f64 {
    match system.pairs[pair].law {
        Law::Coulomb { .. } => numbers.friction[pair],
        Law::Frictionless { .. } | Law::Bound { .. } => 0.0,
    }
}

/// The part of the friction bound that does not depend on x_n: c, or r_f of a bound pair.
pub(crate) fn fixed_bound(system: &ContactSystem, numbers: &ContactNumbers, pair: usize) -> f64 {
    match system.pairs[pair].law {
        Law::Coulomb { .. } => numbers.cohesion[pair],
        Law::Bound { .. } => numbers.bound[pair],
        Law::Frictionless { .. } => 0.0,
    }
}

/// The quantities of a row as a combination of joints: Σ factor·λ_joint + fixed.
fn combination<T: Scalar>(input: &WholeInput, row: Row) -> (Vec<(usize, T)>, T) {
    let WholeInput {
        system, numbers, ..
    } = *input;
    let pair = row.pair;
    let side = match row.kind {
        RowKind::Normal => return (vec![(pair, T::one())], T::zero()),
        RowKind::Plus => T::one(),
        RowKind::Minus => T::one().neg(),
    };
    let mut terms = vec![(tangential_joint(system, pair), side)];
    let f = T::from_f64(friction(system, numbers, pair));
    if !f.is_zero() {
        terms.push((pair, f));
    }
    (terms, T::from_f64(fixed_bound(system, numbers, pair)))
}

/// RF − R·(g, 0): the joint forces of the main system with all gaps closed by force.
pub fn joint_constants<T: Scalar>(system: &ContactSystem, numbers: &ContactNumbers) -> Vec<T> {
    (0..system.joint_count())
        .map(|i| {
            let mut sum = T::from_f64(numbers.load[i]);
            for (k, pair) in system.pairs.iter().enumerate() {
                let gap = numbers.gap[k];
                if gap != 0.0 && !matches!(pair.law, Law::Bound { .. }) {
                    let force = T::from_f64(system.stiffness[(i, k)]).mul(&T::from_f64(gap));
                    sum = sum.sub(&force);
                }
            }
            sum
        })
        .collect()
}

/// Forms the LCP, see the [module documentation](self).
pub fn whole_lcp<T: Scalar>(input: &WholeInput) -> Lcp<T> {
    let WholeInput {
        system,
        numbers,
        covering,
    } = *input;
    let rows = rows(system);
    let combinations: Vec<(Vec<(usize, T)>, T)> =
        rows.iter().map(|row| combination(input, *row)).collect();
    let joint = |row: &Row| match row.kind {
        RowKind::Normal => row.pair,
        RowKind::Plus | RowKind::Minus => tangential_joint(system, row.pair),
    };
    let constants = joint_constants::<T>(system, numbers);
    let stiffness: Vec<Vec<T>> = (0..system.joint_count())
        .map(|i| {
            (0..system.joint_count())
                .map(|j| T::from_f64(system.stiffness[(i, j)]))
                .collect()
        })
        .collect();

    let matrix = combinations
        .iter()
        .map(|(terms, _)| {
            let responses: Vec<T> = (0..system.joint_count())
                .map(|j| {
                    terms.iter().fold(T::zero(), |sum, (i, factor)| {
                        sum.add(&factor.mul(&stiffness[*i][j]))
                    })
                })
                .collect();
            rows.iter()
                .map(|column| match column.kind {
                    RowKind::Normal | RowKind::Plus => responses[joint(column)].clone(),
                    RowKind::Minus => responses[joint(column)].neg(),
                })
                .collect()
        })
        .collect();
    let q = combinations
        .iter()
        .map(|(terms, fixed)| {
            terms.iter().fold(fixed.clone(), |sum, (i, factor)| {
                sum.add(&factor.mul(&constants[*i]))
            })
        })
        .collect();
    let cover = rows
        .iter()
        .map(|row| covering_entry::<T>(input, *row, covering))
        .collect();
    let root = |i: usize| system.stiffness[(i, i)].max(0.0).sqrt();
    let scale = Scale {
        row: rows
            .iter()
            .map(|row| match row.kind {
                RowKind::Normal => root(row.pair),
                RowKind::Plus | RowKind::Minus => {
                    friction(system, numbers, row.pair) * root(row.pair) + root(joint(row))
                }
            })
            .collect(),
        column: rows
            .iter()
            .map(|row| {
                let root = root(joint(row));
                if root > 0.0 { root } else { 1.0 }
            })
            .collect(),
    };
    Lcp {
        matrix,
        q,
        covering: cover,
        scale,
    }
}

/// d_n or d_τ of a row (theory §4, "Coverings").
fn covering_entry<T: Scalar>(input: &WholeInput, row: Row, covering: Covering) -> T {
    let law = &input.system.pairs[row.pair].law;
    if row.kind == RowKind::Normal || !matches!(law, Law::Coulomb { .. }) {
        return T::one();
    }
    let f = T::from_f64(input.numbers.friction[row.pair]);
    match covering {
        Covering::Cohesive => T::one().add(&f),
        Covering::Ones => T::one(),
        Covering::Weight => f,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::ops::ControlFlow;

    use nalgebra::{DMatrix, DVector};
    use num_rational::BigRational;

    use super::*;
    use crate::contact::system::ContactPair;
    use crate::lcp::driver::run;
    use crate::lcp::exact::Exact;
    use crate::lcp::outcome::Outcome;
    use crate::lcp::ratio_test::TieRule;
    use crate::lcp::tableau::Tableau;
    use crate::model::parameter::Number;

    /// m Coulomb pairs with this R (normals, then tangentials).
    pub(crate) fn coulomb(stiffness: DMatrix<f64>) -> ContactSystem {
        let m = stiffness.nrows() / 2;
        let zero = || Number::Value(0.0);
        ContactSystem {
            pairs: (0..m)
                .map(|i| ContactPair {
                    id: format!("c{}", i + 1),
                    law: Law::Coulomb {
                        friction: zero(),
                        cohesion: zero(),
                        gap: zero(),
                    },
                    position: None,
                    tangential: Some(m + i),
                })
                .collect(),
            kernel: DMatrix::zeros(2 * m, 0),
            loads: Vec::new(),
            stiffness,
        }
    }

    /// The same f everywhere, no cohesion, no gap.
    pub(crate) fn plain(f: f64, load: &[f64]) -> ContactNumbers {
        let m = load.len() / 2;
        ContactNumbers {
            friction: vec![f; m],
            cohesion: vec![0.0; m],
            gap: vec![0.0; m],
            bound: vec![0.0; m],
            load: DVector::from_row_slice(load),
        }
    }

    /// Normals last: the default rule.
    pub(crate) fn tangential_first(system: &ContactSystem) -> TieRule {
        let rows = rows(system);
        let normals = rows.iter().filter(|r| r.kind == RowKind::Normal).count();
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
    pub(crate) fn beam_numbers(pull: f64) -> ContactNumbers {
        let mut load = [0.0; 12];
        load[..6].fill(100.0);
        load[6] = -pull;
        plain(0.3, &load)
    }

    #[test]
    fn bar_on_six_supports_in_both_number_types() {
        let system = beam();
        for (pull, expected) in [
            (100.0, Some([120.0, 50.0, 10.0, 0.0, 0.0, 0.0])),
            (150.0, Some([300.0, 180.0, 90.0, 30.0, 0.0, 0.0])),
            (181.0, None),
        ] {
            let numbers = beam_numbers(pull);
            for covering in Covering::ALL {
                let input = WholeInput {
                    system: &system,
                    numbers: &numbers,
                    covering,
                };
                let d_t = match covering {
                    Covering::Cohesive => 1.3,
                    Covering::Ones => 1.0,
                    Covering::Weight => 0.3,
                };
                check::<f64>(&input, expected, d_t);
                check::<BigRational>(&input, expected, d_t);
            }
        }
    }

    fn check<T: Scalar>(input: &WholeInput, expected: Option<[f64; 6]>, d_t: f64) {
        let lcp = whole_lcp::<T>(input);
        let rule = tangential_first(input.system);
        let run = run(&mut Tableau::new(&lcp, rule), 100, &mut |_| {
            ControlFlow::Continue(())
        });
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
        let mut system = coulomb(DMatrix::from_fn(5, 5, |i, j| {
            if i == j { 2.0 } else { 0.1 * (i + j) as f64 }
        }));
        let zero = Number::Value(0.0);
        let pair = |id: &str, law, tangential| ContactPair {
            id: id.into(),
            law,
            position: None,
            tangential,
        };
        system.pairs = vec![
            pair("a", Law::Frictionless { gap: zero.clone() }, None),
            pair(
                "b",
                Law::Bound {
                    bound: zero.clone(),
                },
                Some(3),
            ),
            pair(
                "c",
                Law::Coulomb {
                    friction: zero.clone(),
                    cohesion: zero.clone(),
                    gap: zero,
                },
                Some(4),
            ),
        ];
        let numbers = ContactNumbers {
            friction: vec![0.0, 0.0, 0.5],
            cohesion: vec![0.0, 0.0, 0.25],
            gap: vec![1.0, 0.0, 0.0],
            bound: vec![0.0, 3.0, 0.0],
            load: DVector::from_row_slice(&[1.0, 2.0, 3.0, 4.0, 5.0]),
        };
        let lcp = whole_lcp::<f64>(&WholeInput {
            system: &system,
            numbers: &numbers,
            covering: Covering::Cohesive,
        });
        let kinds: Vec<_> = rows(&system).iter().map(|r| (r.pair, r.kind)).collect();
        use RowKind::*;
        assert_eq!(
            kinds,
            [
                (0, Normal),
                (2, Normal),
                (1, Plus),
                (2, Plus),
                (1, Minus),
                (2, Minus)
            ]
        );
        let r = |i: usize, j: usize| system.stiffness[(i, j)];
        let v = |i: usize| numbers.load[i] - r(i, 0);
        let expected = [
            v(0),
            v(2),
            3.0 + v(3),
            0.25 + 0.5 * v(2) + v(4),
            3.0 - v(3),
            0.25 + 0.5 * v(2) - v(4),
        ];
        for (q, e) in lcp.q.iter().zip(expected) {
            assert!((q - e).abs() < 1e-14);
        }
        assert_eq!(lcp.covering, [1.0, 1.0, 1.0, 1.5, 1.0, 1.5]);
        // x⁻ of c against z⁻ of b: −(f R_n − R_τ) on the tangential joint of b.
        assert!((lcp.matrix[5][4] - (r(4, 3) - 0.5 * r(2, 3))).abs() < 1e-15);
    }

    /// Validation 1 at its limit load: p = (F2 − n f F) / (n d_τ), with R as a factorization leaves it: noise where true
    /// zeros are, kernel made exact by projection.
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
                    for (i, j, sign) in [
                        (e, e, 1.0),
                        (e + 1, e + 1, 1.0),
                        (e, e + 1, -1.0),
                        (e + 1, e, -1.0),
                    ] {
                        r[(i, j)] += sign * stiffness;
                    }
                }
                let z =
                    DVector::from_fn(k, |i, _| if i < n { 0.0 } else { 1.0 / (n as f64).sqrt() });
                let keep = DMatrix::identity(k, k) - &z * z.transpose();
                let r = &keep * r * &keep;
                let system = coulomb((&r + r.transpose()) * 0.5);
                let limit = 30.0 * n as f64;
                for (excess, tolerance) in [(1e-9, 1e-5), (1e-6, 1e-8)] {
                    let pull = limit * (1.0 + excess);
                    let mut load = vec![0.0; k];
                    load[..n].fill(100.0);
                    load[n] = -pull;
                    let numbers = plain(0.3, &load);
                    for (covering, d_t) in Covering::ALL.into_iter().zip([1.3, 1.0, 0.3]) {
                        let lcp = whole_lcp::<f64>(&WholeInput {
                            system: &system,
                            numbers: &numbers,
                            covering,
                        });
                        let got = run(
                            &mut Tableau::new(&lcp, tangential_first(&system)),
                            200,
                            &mut |_| ControlFlow::Continue(()),
                        );
                        let expected = (pull - limit) / (n as f64 * d_t);
                        assert!(
                            matches!(got.outcome, Outcome::Ray(_)),
                            "{spacing} {n} {covering}: {:?}",
                            got.outcome
                        );
                        assert!(
                            (got.point.p / expected - 1.0).abs() < tolerance,
                            "{spacing} {n} {covering} {excess}: {} {expected}",
                            got.point.p
                        );
                    }
                    let below = ContactNumbers {
                        load: DVector::from_fn(k, |i, _| {
                            if i == n {
                                -limit * (1.0 - excess)
                            } else {
                                numbers.load[i]
                            }
                        }),
                        ..numbers
                    };
                    let lcp = whole_lcp::<f64>(&WholeInput {
                        system: &system,
                        numbers: &below,
                        covering: Covering::Cohesive,
                    });
                    let got = run(
                        &mut Tableau::new(&lcp, tangential_first(&system)),
                        200,
                        &mut |_| ControlFlow::Continue(()),
                    );
                    assert!(
                        matches!(got.outcome, Outcome::Normal { marginal: false }),
                        "{:?}",
                        got.outcome
                    );
                }
            }
        }
    }

    /// Random positive definite R with stiffness contrasts up to `contrast`, reals.
    fn random_contact(
        random: &mut rand_chacha::ChaCha8Rng,
        m: usize,
        contrast: f64,
    ) -> ContactSystem {
        use rand::Rng;
        let k = 2 * m;
        let a = DMatrix::from_fn(k, k, |_, _| random.random_range(-1.0..1.0));
        let scale = DMatrix::from_diagonal(&DVector::from_fn(k, |_, _| {
            contrast.powf(random.random_range(0.0..0.5))
        }));
        let r = &scale * (&a * a.transpose() + DMatrix::identity(k, k) * 0.1) * &scale;
        coulomb((&r + r.transpose()) * 0.5)
    }

    fn run_exact(input: &WholeInput) -> crate::lcp::outcome::Run<BigRational> {
        let lcp = whole_lcp::<BigRational>(input);
        let mut engine = Exact::new(lcp, tangential_first(input.system));
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
            let numbers = plain([0.3, 1.0, 4.0][case % 3], &load);
            let got = run_exact(&WholeInput {
                system: &system,
                numbers: &numbers,
                covering: Covering::Cohesive,
            });
            assert!(
                matches!(
                    got.outcome,
                    Outcome::Trivial | Outcome::Normal { marginal: false }
                ),
                "case {case}: {:?}",
                got.outcome
            );
        }
    }

    /// `cargo test --release --lib whole -- --ignored --nocapture`
    #[test]
    #[ignore = "a measurement"]
    fn exact_engine_with_sixty_pairs() {
        use rand::{Rng, SeedableRng};
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(32);
        for (contrast, f) in [(1.0, 0.3), (1.0, 2.0), (1e9, 0.5)] {
            let m = 60;
            let system = random_contact(&mut random, m, contrast);
            let load: Vec<f64> = (0..2 * m).map(|_| random.random_range(-1.0..1.0)).collect();
            let numbers = plain(f, &load);
            let start = std::time::Instant::now();
            let got = run_exact(&WholeInput {
                system: &system,
                numbers: &numbers,
                covering: Covering::Cohesive,
            });
            let outcome = format!("{:?}", got.outcome);
            std::io::Write::write_all(
                &mut std::io::stderr(),
                format!(
                    "contrast {contrast:e}, f {f}: {:?}, {} pivots, {}\n",
                    start.elapsed(),
                    got.pivots.len(),
                    &outcome[..outcome.len().min(40)]
                )
                .as_bytes(),
            )
            .unwrap();
        }
    }
}
