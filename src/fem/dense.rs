//! Dense decompositions (faer) of the few full matrices: one place for them, nalgebra outside.

use faer::{Mat, MatRef, Side};
use nalgebra::{DMatrix, DVector};

/// A = U diag(σ) Vᵀ, V square; σ descending, padded with zeros to the number of columns.
pub struct Svd {
    /// Left singular vectors, rows × min(rows, columns).
    pub u: DMatrix<f64>,
    /// One per column of A.
    pub sigma: Vec<f64>,
    /// Right singular vectors, columns × columns.
    pub v: DMatrix<f64>,
}

fn view(a: &DMatrix<f64>) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(a.as_slice(), a.nrows(), a.ncols())
}

fn owned(a: MatRef<'_, f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}

/// Singular value decomposition; `None` if it did not converge.
pub fn svd(a: &DMatrix<f64>) -> Option<Svd> {
    let (rows, columns) = a.shape();
    // Rows of zeros make it at least square, so that a thin decomposition has all of V.
    let tall = rows.max(columns);
    let padded = Mat::from_fn(tall, columns, |i, j| if i < rows { a[(i, j)] } else { 0.0 });
    let svd = padded.thin_svd().ok()?;
    Some(Svd {
        u: owned(svd.U().subrows(0, rows)),
        sigma: svd.S().column_vector().iter().copied().collect(),
        v: owned(svd.V()),
    })
}

/// Eigenvalues (ascending) and eigenvectors (columns) of a symmetric matrix; `None` if it did not converge.
pub fn symmetric_eigen(a: &DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let eigen = view(a).self_adjoint_eigen(Side::Lower).ok()?;
    let values = eigen.S().column_vector().iter().copied().collect();
    Some((values, owned(eigen.U())))
}

/// Largest eigenvalue of a symmetric positive semidefinite matrix, from below, by the power method. Ten steps give
/// it within much less than the factor of 4 that thresholds allow for.
pub fn largest_eigenvalue(a: &DMatrix<f64>) -> f64 {
    let start = DVector::from_fn(a.nrows(), |i, _| 1.0 + 0.5 * (i as f64).sin());
    let mut x = start;
    let mut value = 0.0_f64;
    for _ in 0..10 {
        let norm = x.norm();
        if norm == 0.0 {
            break;
        }
        x /= norm;
        let y = a * &x;
        value = value.max(x.dot(&y));
        x = y;
    }
    value.max(a.diagonal().max())
}

/// Whether all eigenvalues of a symmetric matrix are above `limit`: A − limit·1 has a Cholesky factor (Sylvester). The
/// rounding of the factorization, some n·ε of the largest eigenvalue, has to be small beside the limit.
pub fn is_above(a: &DMatrix<f64>, limit: f64) -> bool {
    let mut shifted = a.clone();
    for i in 0..a.nrows() {
        shifted[(i, i)] -= limit;
    }
    view(&shifted).llt(Side::Lower).is_ok()
}
