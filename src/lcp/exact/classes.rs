//! Classes of M for which an answer exists for every q, recognised from the data without rounding.

use nalgebra::DMatrix;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use crate::lcp::exact::dyadic::{WholeRows, rational_rows};
use crate::lcp::exact::scalar::BigInt;
use crate::lcp::exact::triangular;

/// Largest number of rows for which all principal minors are examined.
const MOST_MINORS: usize = 10;
/// Largest number of rows for which definiteness is decided exactly.
const MOST_DEFINITE: usize = 100;

/// Why every q has an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolvableClass {
    /// M + Mᵀ is positive definite: exactly one answer.
    PositiveDefinite,
    /// All principal minors of M are positive: exactly one answer.
    PMatrix,
    /// No entry of M is negative and its diagonal is positive (strictly copositive).
    NonNegative,
}

impl SolvableClass {
    /// For "… has an answer for every q".
    pub fn words(self) -> &'static str {
        match self {
            SolvableClass::PositiveDefinite => "M is positive definite",
            SolvableClass::PMatrix => "all principal minors of M are positive",
            SolvableClass::NonNegative => "M has no negative entry and a positive diagonal",
        }
    }
}

/// The class of M, where it belongs to one of these and that is cheap to find out. `go_on` is asked before every step
/// of an elimination and may stop it.
pub fn solvable_class(matrix: &DMatrix<f64>, go_on: &mut dyn FnMut() -> bool) -> Option<SolvableClass> {
    let n = matrix.nrows();
    if (0..n).any(|i| matrix[(i, i)] <= 0.0) {
        return None; // all three have a positive diagonal
    }
    if n <= MOST_DEFINITE && is_positive_definite(matrix, go_on) {
        return Some(SolvableClass::PositiveDefinite);
    }
    if matrix.iter().all(|entry| *entry >= 0.0) {
        return Some(SolvableClass::NonNegative);
    }
    let is_p = triangular::order(matrix).is_some() || n <= MOST_MINORS && is_p_matrix(rational_rows(matrix));
    is_p.then_some(SolvableClass::PMatrix)
}

/// Leading minors of M + Mᵀ by elimination in integers.
fn is_positive_definite(matrix: &DMatrix<f64>, go_on: &mut dyn FnMut() -> bool) -> bool {
    let n = matrix.nrows();
    let mut rows = WholeRows::default();
    for i in 0..n {
        let mut row = Vec::with_capacity(2 * n);
        row.extend((0..n).map(|j| matrix[(i, j)]));
        row.extend((0..n).map(|j| matrix[(j, i)]));
        rows.push(&row);
    }
    // The sum of the two halves, exactly; each row times a positive number.
    let mut a: Vec<Vec<BigInt>> = rows.rows.iter().map(|row| (0..n).map(|j| &row[j] + &row[n + j]).collect()).collect();
    let mut before = BigInt::one();
    for k in 0..n {
        let pivot = a[k][k].clone();
        if !pivot.is_positive() || !go_on() {
            return false;
        }
        let own = a[k].clone();
        for row in &mut a[k + 1..] {
            let factor = row[k].clone();
            for (entry, top) in row[k + 1..].iter_mut().zip(&own[k + 1..]) {
                *entry = (&*entry * &pivot - &factor * top) / &before;
            }
        }
        before = pivot;
    }
    true
}

/// M is P if and only if its first entry is positive and both the rest and the Schur complement of that entry are P.
fn is_p_matrix(matrix: Vec<Vec<BigRational>>) -> bool {
    let Some(first) = matrix.first() else { return true };
    let pivot = &first[0];
    if !pivot.is_positive() {
        return false;
    }
    let rest: Vec<Vec<BigRational>> = matrix[1..].iter().map(|row| row[1..].to_vec()).collect();
    let schur = matrix[1..]
        .iter()
        .map(|row| {
            let factor = &row[0] / pivot;
            let entry = |(a, b): (&BigRational, &BigRational)| {
                if factor.is_zero() { a.clone() } else { a - &factor * b }
            };
            row[1..].iter().zip(&first[1..]).map(entry).collect()
        })
        .collect();
    is_p_matrix(rest) && is_p_matrix(schur)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(n: usize, rows: &[f64]) -> Option<SolvableClass> {
        solvable_class(&DMatrix::from_row_slice(n, n, rows), &mut || true)
    }

    #[test]
    fn classes_are_told_apart() {
        assert_eq!(of(2, &[2.0, 1.0, -1.0, 2.0]), Some(SolvableClass::PositiveDefinite));
        // Murty: P, not positive definite.
        assert_eq!(of(2, &[1.0, 0.0, -4.0, 1.0]), Some(SolvableClass::PMatrix));
        assert_eq!(of(2, &[1.0, 3.0, 3.0, 1.0]), Some(SolvableClass::NonNegative));
        // Determinant −3; zero on the diagonal; singular.
        assert_eq!(of(2, &[1.0, -2.0, -2.0, 1.0]), None);
        assert_eq!(of(2, &[0.0, 1.0, 1.0, 1.0]), None);
        assert_eq!(of(2, &[1.0, -1.0, -1.0, 1.0]), None);
    }

    #[test]
    fn one_unit_in_the_last_place_decides() {
        // det = 1·d − 1 with d = 1 ± ε.
        let above = 1.0 + f64::EPSILON;
        assert_eq!(of(2, &[1.0, -1.0, -1.0, above]), Some(SolvableClass::PositiveDefinite));
        assert_eq!(of(2, &[1.0, -1.0, -1.0, 1.0 - f64::EPSILON]), None);
    }
}
