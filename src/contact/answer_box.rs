//! A box that holds every answer of a contact problem with positive definite R.

use nalgebra::{DMatrix, DVector};

use super::scheme_solve::Sizes;
use super::system::ContactSystem;

/// Relative widening against rounding.
const WIDER: f64 = 1e-6;

/// Sides of the box, and the largest √R_jj |z_j| in it.
pub(crate) struct Boxes {
    pub sides: Vec<(f64, f64)>,
    pub extent: f64,
}

/// Every answer has zᵀλ ≤ 0, so zᵀR z ≤ −zᵀq: an ellipsoid about z₀/2 with z₀ = −R⁻¹q. Its box, widened a little; `None`
/// where R is not safely positive definite.
pub(crate) fn ellipsoid(system: &ContactSystem, sizes: &Sizes, joints: &[usize], constants: &[f64]) -> Option<Boxes> {
    let k = joints.len();
    if k == 0 {
        return None; // no joints: nothing to box, and an empty matrix has no eigenvalues
    }
    let r = DMatrix::from_fn(k, k, |i, j| {
        system.stiffness[(joints[i], joints[j])] / sizes.root[joints[i]] / sizes.root[joints[j]]
    });
    let q = DVector::from_iterator(k, joints.iter().map(|j| constants[*j] / sizes.root[*j]));
    let eigen = r.clone().symmetric_eigenvalues();
    if eigen.min() <= 1e-9 * eigen.max() {
        return None;
    }
    let inverse = r.cholesky()?.inverse();
    let z0 = -(&inverse * &q);
    let norm = (-z0.dot(&q)).max(0.0).sqrt();
    let mut extent = 0.0f64;
    let sides: Vec<(f64, f64)> = (0..k)
        .map(|j| {
            let half = 0.5 * inverse[(j, j)].max(0.0).sqrt() * norm;
            let side = (0.5 * z0[j] - half, 0.5 * z0[j] + half);
            extent = extent.max(side.0.abs()).max(side.1.abs());
            side
        })
        .collect();
    let wider = WIDER * extent;
    Some(Boxes {
        sides: sides
            .iter()
            .zip(joints)
            .map(|((low, high), j)| {
                let root = sizes.root[*j];
                ((low - wider) / root, (high + wider) / root)
            })
            .collect(),
        extent,
    })
}
