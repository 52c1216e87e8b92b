//! Decompositions of dense matrices.

use faer::linalg::solvers::{Llt, PartialPivLu, Solve};
use faer::{Mat, MatMut, MatRef, Side};
use nalgebra::{DMatrix, DVector};

use crate::doubled::add_response;

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

/// Smallest eigenvalue of a symmetric matrix; `None` if the iteration did not converge.
pub fn smallest_eigenvalue(matrix: &DMatrix<f64>) -> Option<f64> {
    view(matrix).self_adjoint_eigenvalues(Side::Lower).ok()?.first().copied()
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

/// Cholesky factorization of a symmetric matrix.
pub struct Cholesky(Llt<f64>);

impl Cholesky {
    /// `None` where a pivot is not positive.
    pub fn new(matrix: &DMatrix<f64>) -> Option<Cholesky> {
        view(matrix).llt(Side::Lower).ok().map(Cholesky)
    }

    /// right := matrix⁻¹ right.
    pub fn solve(&self, right: &mut [f64]) {
        let n = right.len();
        self.0.solve_in_place(MatMut::from_column_major_slice_mut(right, n, 1));
    }
}

/// LU factorization with partial pivoting of a square matrix, with the matrix kept for refinement.
pub struct Factor {
    lu: PartialPivLu<f64>,
    matrix: DMatrix<f64>,
}

impl Factor {
    /// Factorizes; a singular matrix shows as non-finite or failing solutions (`solve` returns `None`).
    pub fn new(matrix: DMatrix<f64>) -> Factor {
        Factor { lu: view(&matrix).partial_piv_lu(), matrix }
    }

    /// Solves A X = B for all columns; `None` if not finite.
    pub fn solve_many(&self, right: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut x = view(right).to_owned();
        if right.nrows() > 0 {
            self.lu.solve_in_place(x.as_mut());
        }
        let solution = owned(x.as_ref());
        solution.iter().all(|value| value.is_finite()).then_some(solution)
    }

    /// Solves A x = b with refinement (two steps for small systems, one for large ones), residuals in twice the
    /// precision; `None` if not finite.
    pub fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        let n = right.len();
        let mut solution = DVector::zeros(n);
        let mut residual = right.clone();
        let refinements = if n > 128 { 1 } else { 2 };
        for round in 0..=refinements {
            let mut correction = Mat::from_fn(n, 1, |i, _| residual[i]);
            if n > 0 {
                self.lu.solve_in_place(correction.as_mut());
            }
            for i in 0..n {
                solution[i] += correction[(i, 0)];
            }
            if !solution.iter().all(|value: &f64| value.is_finite()) {
                return None;
            }
            if round < refinements {
                residual = self.residual(right, &solution);
            }
        }
        Some(solution)
    }

    /// b − A x in doubled precision, rounded.
    fn residual(&self, right: &DVector<f64>, x: &DVector<f64>) -> DVector<f64> {
        let mut sum = right.clone();
        let mut error = DVector::<f64>::zeros(right.len());
        add_response(sum.as_mut_slice(), error.as_mut_slice(), self.matrix.as_slice(), (-x).as_slice());
        sum + error
    }
}
