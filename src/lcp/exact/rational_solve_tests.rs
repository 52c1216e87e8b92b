//! Small systems, singular ones, agreement with elimination in rationals.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

fn go(matrix: &[Vec<BigInt>], rhs: &[BigInt]) -> RationalSolution {
    solve(matrix, rhs, &mut |_| ControlFlow::Continue(()))
}

fn integers(rows: &[&[i64]]) -> Vec<Vec<BigInt>> {
    rows.iter().map(|row| row.iter().map(|x| BigInt::from(*x)).collect()).collect()
}

fn quotient(solution: &Quotients, i: usize) -> BigRational {
    BigRational::new(solution.numerators[i].clone(), solution.denominator.clone())
}

#[test]
fn two_by_two() {
    // 2x + y = 1, x + 3y = −4: x = 7/5, y = −9/5
    let a = integers(&[&[2, 1], &[1, 3]]);
    let b = [BigInt::from(1), BigInt::from(-4)];
    let RationalSolution::Unique(solution) = go(&a, &b) else { panic!() };
    let fifth = |n: i64| BigRational::new(BigInt::from(n), BigInt::from(5));
    assert_eq!(quotient(&solution, 0), fifth(7));
    assert_eq!(quotient(&solution, 1), fifth(-9));
}

#[test]
fn singular_systems_are_told_apart() {
    let a = integers(&[&[1, 2, 3], &[2, 4, 6], &[1, 0, 1]]);
    let b = |v: [i64; 3]| v.map(BigInt::from);
    match go(&a, &b([1, 2, 5])) {
        RationalSolution::Singular { rank: 2, particular: Some(x) } => {
            let sum = quotient(&x, 0) + quotient(&x, 2);
            assert_eq!(sum, BigRational::from_integer(BigInt::from(5)));
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(go(&a, &b([1, 3, 5])), RationalSolution::Singular { rank: 2, particular: None });
    assert!(matches!(go(&[], &[]), RationalSolution::Unique(_)));
    let zero = integers(&[&[0]]);
    assert_eq!(go(&zero, &[BigInt::from(1)]), RationalSolution::Singular { rank: 0, particular: None });
}

#[test]
fn a_matrix_that_vanishes_modulo_the_first_prime() {
    let p = BigInt::from(Prime::ALL[0].value());
    let RationalSolution::Unique(x) = go(&[vec![p.clone()]], &[BigInt::one()]) else { panic!() };
    assert_eq!(quotient(&x, 0), BigRational::new(BigInt::one(), p));
}

#[test]
fn agrees_with_elimination_in_rationals() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for k in 1..10usize {
        let a: Vec<Vec<BigInt>> =
            (0..k).map(|_| (0..k).map(|_| BigInt::from(random.random::<i64>()) << 40u32).collect()).collect();
        let b: Vec<BigInt> = (0..k).map(|_| BigInt::from(random.random::<i64>())).collect();
        let RationalSolution::Unique(x) = go(&a, &b) else { panic!() };
        // Gauss–Jordan in rationals.
        let mut rows: Vec<Vec<BigRational>> = a
            .iter()
            .zip(&b)
            .map(|(row, b)| {
                row.iter().chain(std::iter::once(b)).map(|x| BigRational::from_integer(x.clone())).collect()
            })
            .collect();
        for c in 0..k {
            let pivot = rows[c][c].clone();
            for x in &mut rows[c] {
                *x /= &pivot;
            }
            let solved = rows[c].clone();
            for (i, row) in rows.iter_mut().enumerate() {
                if i != c {
                    let factor = row[c].clone();
                    for (x, s) in row.iter_mut().zip(&solved) {
                        *x -= &factor * s;
                    }
                }
            }
        }
        for (i, row) in rows.iter().enumerate() {
            assert_eq!(quotient(&x, i), row[k]);
        }
    }
}

/// `cargo test --release --lib rational_solve -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn hundred_and_twenty_unknowns() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let k = 120;
    let a: Vec<Vec<BigInt>> =
        (0..k).map(|_| (0..k).map(|_| BigInt::from(random.random::<i128>() >> 8)).collect()).collect();
    let b: Vec<BigInt> = (0..k).map(|_| BigInt::from(random.random::<i64>())).collect();
    let start = std::time::Instant::now();
    assert!(matches!(go(&a, &b), RationalSolution::Unique(_)));
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
    std::io::Write::write_all(&mut std::io::stderr(), format!("k = {k}: {:?}\n", start.elapsed()).as_bytes()).unwrap();
}

#[test]
fn the_null_space_is_whole_and_exact() {
    // Rank 2: row 3 = row 1 + row 2, column 3 = 2 column 1 − column 2, column 4 = column 2 / 3.
    let a = integers(&[&[1, 3, -1, 1], &[2, 9, -5, 3], &[3, 12, -6, 4], &[0, 0, 0, 0]]);
    assert_eq!(rank_modulo_prime(&a), 2);
    let basis = null_space(&a, &mut |_| ControlFlow::Continue(())).expect("not stopped");
    assert_eq!(basis.len(), 2);
    for x in &basis {
        assert!(x.iter().any(|x| !x.is_zero()));
        for row in &a {
            let sum: BigRational = row.iter().zip(x).map(|(a, x)| BigRational::from_integer(a.clone()) * x).sum();
            assert!(sum.is_zero());
        }
    }
    assert_eq!(null_space(&a, &mut |_| ControlFlow::Break(())), None);
}
