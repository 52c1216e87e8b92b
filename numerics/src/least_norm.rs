//! Equations that may leave some of their unknowns open.

use faer::linalg::solvers::{ColPivQr, Qr};
use faer::{Mat, MatRef};
use nalgebra::{DMatrix, DVector};

/// The shortest x of those that bring A x nearest to b: A P = Q [R₁; 0], and with R₁ᵀ = Z T the unknowns are
/// x = P Z T⁻ᵀ (Qᵀ b)₁. A row of R below n ε of the first is what rounding leaves of a zero (Golub & Van Loan, "Matrix
/// Computations", 5.5.7). `None` where something is not finite.
pub fn least_norm(a: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    let (rows, n) = a.shape();
    if !a.iter().chain(b.iter()).all(|value| value.is_finite()) {
        return None;
    }
    let factor = ColPivQr::new(MatRef::from_column_major_slice(a.as_slice(), rows, n));
    let (q, r) = (factor.compute_thin_Q(), factor.thin_R());
    let zero = rows.max(n) as f64 * f64::EPSILON * if r.nrows() > 0 { r[(0, 0)].abs() } else { 0.0 };
    let rank = (0..r.nrows()).take_while(|&i| r[(i, i)].abs() > zero).count();
    let target = DVector::from_fn(rank, |i, _| (0..rows).map(|row| q[(row, i)] * b[row]).sum::<f64>());
    let across = Qr::new(Mat::from_fn(n, rank, |i, j| r[(j, i)]).as_ref());
    let (z, t) = (across.compute_thin_Q(), across.thin_R());
    let mut amount = DVector::<f64>::zeros(rank);
    for i in 0..rank {
        let known: f64 = (0..i).map(|j| t[(j, i)] * amount[j]).sum();
        amount[i] = (target[i] - known) / t[(i, i)];
    }
    let place = factor.P().arrays().0;
    let mut x = DVector::zeros(n);
    for (i, &unknown) in place.iter().enumerate() {
        x[unknown] = (0..rank).map(|j| z[(i, j)] * amount[j]).sum();
    }
    x.iter().all(|value: &f64| value.is_finite()).then_some(x)
}
