//! Published programmes without a feasible point, and random ones that are known to have one or none.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::lcp::exact::scalar::Scalar;
use num_rational::BigRational;

fn of(n: usize, rows: &[f64], q: &[f64]) -> Option<Farkas> {
    farkas(&DMatrix::from_row_slice(n, n, rows), &DVector::from_row_slice(q), &mut || true)
}

#[test]
fn one_negative_row_is_its_own_proof() {
    let found = of(1, &[-1.0], &[-9.8]).expect("−z − 9.8 ≥ 0 has no solution");
    assert_eq!((found.multipliers, found.gap), (vec![1.0], 9.8));
    assert_eq!(of(1, &[-1.0], &[9.8]), None);
    assert_eq!(of(1, &[1.0], &[-9.8]), None);
}

#[test]
fn equations_that_cancel_exactly_are_a_proof() {
    // Rows sum to zero, q to −1.
    let found =
        of(3, &[1.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0], &[1.0, -3.0, 1.0]).expect("eᵀM = 0, eᵀq = −1");
    assert_eq!(found.multipliers, [1.0; 3]);
    assert_eq!(found.gap, 1.0);
    // The same with eᵀq = 0: z = (1, 2, 1)·t + … is feasible.
    assert_eq!(of(3, &[1.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0], &[1.0, -2.0, 1.0]), None);
}

/// y rational, dense and random; M with Mᵀy exactly zero in some columns and negative in the others.
#[test]
fn random_programmes_made_infeasible_are_proved_and_feasible_ones_never() {
    let mut random = ChaCha8Rng::seed_from_u64(41);
    for case in 0..60 {
        let n = 5 + case % 36;
        // Integers, so that the last row can cancel the others exactly.
        let mut matrix = DMatrix::from_fn(n, n, |_, _| f64::from(random.random_range(-9i32..=9)));
        let mut q = DVector::from_fn(n, |_, _| f64::from(random.random_range(-9i32..=9)));
        let infeasible = case % 2 == 0;
        if infeasible {
            for j in 0..n {
                let sum: f64 = (0..n - 1).map(|i| matrix[(i, j)]).sum();
                matrix[(n - 1, j)] = -sum - if j % 3 == 0 { 1.0 } else { 0.0 };
            }
            q[n - 1] = -(0..n - 1).map(|i| q[i]).sum::<f64>() - 1.0;
        } else {
            // z = e is feasible.
            for i in 0..n {
                let sum: f64 = matrix.row(i).iter().sum();
                q[i] = -sum + if i % 2 == 0 { 0.0 } else { 1.0 };
            }
        }
        let found = farkas(&matrix, &q, &mut || true);
        assert_eq!(found.is_some(), infeasible, "case {case}");
    }
}

/// BᵀB with B e = 0, so that eᵀM = 0, and eᵀq = −1; rows and columns in units up to 2⁵² apart. The proof is R⁻¹e, checked here in
/// rationals.
#[test]
fn units_of_rows_and_columns_hide_no_proof() {
    let mut random = ChaCha8Rng::seed_from_u64(43);
    for n in [20, 60, 90] {
        let mut b = DMatrix::from_fn(n / 3, n, |_, _| f64::from(random.random_range(-3i32..=3)));
        b.row_iter_mut().for_each(|mut row| row[0] -= row.sum());
        let mut q = DVector::from_fn(n, |_, _| f64::from(random.random_range(-5i32..=5)));
        q[0] -= q.sum() + 1.0;
        let mut unit = || f64::from(random.random_range(-26i32..=26)).exp2();
        let rows: Vec<f64> = (0..n).map(|_| unit()).collect();
        let columns: Vec<f64> = (0..n).map(|_| unit()).collect();
        let product = b.tr_mul(&b);
        let matrix = DMatrix::from_fn(n, n, |i, j| rows[i] * product[(i, j)] * columns[j]);
        let q = DVector::from_fn(n, |i, _| rows[i] * q[i]);
        let found = farkas(&matrix, &q, &mut || true).expect("a proof");
        let sum = |of: &dyn Fn(usize) -> f64| -> BigRational {
            let term = |i: usize| BigRational::from_integer(found.weights[i].clone()) * BigRational::from_f64(of(i));
            (0..n).map(term).sum()
        };
        assert!(found.weights.iter().all(|weight| !weight.is_negative()), "{n}");
        assert!((0..n).all(|j| !sum(&|i| matrix[(i, j)]).is_positive()) && sum(&|i| q[i]).is_negative(), "{n}");
        // The multipliers are the weights, the largest 1, and the gap is theirs.
        let gap: f64 = -(0..n).map(|i| found.multipliers[i] * q[i]).sum::<f64>();
        assert!((gap - found.gap).abs() <= 1e-9 * found.gap, "{n}: {gap} {}", found.gap);
        assert_eq!(found.multipliers.iter().copied().fold(0.0, f64::max), 1.0);
    }
}

#[test]
fn rounding_is_no_proof() {
    // x − x with entries that f64 cannot hold: 0.1 + 0.2 − 0.3 = 5.6e-17 > 0 exactly, so z is feasible for a tiny
    // q < 0.
    let q = [-1.0, 0.0];
    assert_eq!(of(2, &[0.1 + 0.2 - 0.3, 0.0, 0.0, 1.0], &q), None);
    // And exactly zero is a proof.
    assert!(of(2, &[0.0, 0.0, 0.0, 1.0], &q).is_some());
}

#[test]
fn the_exact_dictionary_alone_finds_the_same() {
    let mut random = ChaCha8Rng::seed_from_u64(42);
    let mut proved = 0;
    for case in 0..40 {
        let n = 2 + case % 6;
        let matrix = DMatrix::from_fn(n, n, |_, _| random.random_range(-1.0..1.0));
        let q = DVector::from_fn(n, |_, _| random.random_range(-1.0..0.5));
        let whole = WholeRows::of_lcp(&matrix, &q);
        let exact = exactly(&whole, &mut || true);
        assert_eq!(exact.is_some(), farkas(&matrix, &q, &mut || true).is_some());
        if let Some(found) = exact {
            proved += 1;
            let y: Vec<BigRational> = found.multipliers.iter().map(|v| <BigRational as Scalar>::from_f64(*v)).collect();
            let gap: f64 = -(0..n).map(|i| q[i] * Scalar::to_f64(&y[i])).sum::<f64>();
            assert!((gap - found.gap).abs() <= 1e-12, "{gap} {found:?}");
        }
    }
    assert!(proved > 5, "{proved}");
}
