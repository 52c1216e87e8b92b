//! A box that holds every answer of a contact problem with positive definite R.

use nalgebra::{DMatrix, DVector};

use super::system::ContactSystem;

/// Relative widening against rounding.
const WIDER: f64 = 1e-6;
/// Condition of R, scaled to unit diagonal, up to which the widening is far above all rounding.
const CONDITION: f64 = 1e6;

/// Every answer has zᵀλ ≤ 0, so zᵀR z ≤ −zᵀq: an ellipsoid about z₀/2 with z₀ = −R⁻¹q. The sides of its box over the
/// `joints`, widened a little; `None` where R is not safely positive definite.
pub(crate) fn ellipsoid(system: &ContactSystem, joints: &[usize], constants: &[f64]) -> Option<Vec<(f64, f64)>> {
    let k = joints.len();
    if k == 0 {
        return None; // no joints: nothing to box, and an empty matrix has no eigenvalues
    }
    let root: Vec<f64> = joints.iter().map(|&j| system.stiffness[(j, j)].max(0.0).sqrt()).collect();
    if root.contains(&0.0) {
        return None;
    }
    let r = DMatrix::from_fn(k, k, |i, j| system.stiffness[(joints[i], joints[j])] / root[i] / root[j]);
    let q = DVector::from_iterator(k, joints.iter().zip(&root).map(|(j, root)| constants[*j] / root));
    let eigen = r.clone().symmetric_eigenvalues();
    if eigen.min() * CONDITION <= eigen.max() {
        return None;
    }
    let inverse = r.cholesky()?.inverse();
    let z0 = -(&inverse * &q);
    let norm = (-z0.dot(&q)).max(0.0).sqrt();
    let sides: Vec<(f64, f64)> = (0..k)
        .map(|j| {
            let half = 0.5 * inverse[(j, j)].max(0.0).sqrt() * norm;
            (0.5 * z0[j] - half, 0.5 * z0[j] + half)
        })
        .collect();
    let extent = sides.iter().fold(0.0f64, |extent, side| extent.max(side.0.abs()).max(side.1.abs()));
    let wider = WIDER * extent;
    Some(sides.iter().zip(&root).map(|((low, high), root)| ((low - wider) / root, (high + wider) / root)).collect())
}
