//! Four-node bilinear membrane, 2 × 2 Gauss points.
//!
//! ```text
//!     k = t Σ_g Bᵀ D B det J      ε = B u = (ε_xx, ε_yy, γ_xy),  σ = D ε
//!     N_i = (1 + ξ_i ξ)(1 + η_i η)/4,  (ξ_i, η_i) = (−1,−1), (1,−1), (1,1), (−1,1)
//! ```
//! Hughes, *The Finite Element Method*, 1987, §3.2 and §3.8.

use nalgebra::{SMatrix, SVector};

use crate::model::structure::{Material, Plane};

type Matrix8 = SMatrix<f64, 8, 8>;
type Vector8 = SVector<f64, 8>;
type Matrix3 = SMatrix<f64, 3, 3>;

const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// D: (σ_xx, σ_yy, σ_xy) = D (ε_xx, ε_yy, γ_xy).
pub fn elasticity(material: &Material, plane: Plane) -> Matrix3 {
    let (e, nu) = (material.youngs_modulus, material.poisson_ratio);
    let (direct, cross) = match plane {
        Plane::Stress => (e / (1.0 - nu * nu), e * nu / (1.0 - nu * nu)),
        Plane::Strain => {
            let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
            (c * (1.0 - nu), c * nu)
        }
    };
    let shear = e / (2.0 * (1.0 + nu));
    Matrix3::new(direct, cross, 0.0, cross, direct, 0.0, 0.0, 0.0, shear)
}

/// Stiffness, rows u_x, u_y of each corner in turn; `None` if det J ≤ 0 at a corner (not convex, or clockwise).
pub fn stiffness(corners: &[[f64; 2]; 4], d: &Matrix3, thickness: f64) -> Option<Matrix8> {
    let convex = CORNERS.iter().all(|&at| gradients(corners, at).1 > 0.0);
    if !convex {
        return None;
    }
    let g = 1.0 / 3.0_f64.sqrt();
    let mut k = Matrix8::zeros();
    for at in CORNERS {
        let (dn, det) = gradients(corners, [at[0] * g, at[1] * g]);
        let weight = thickness * det;
        // Bᵀ D B block by block: D has only four entries that are not zero.
        let (d11, d12, d22, d33) = (d[(0, 0)], d[(0, 1)], d[(1, 1)], d[(2, 2)]);
        for i in 0..4 {
            let [xi, yi] = dn[i];
            for j in i..4 {
                let [xj, yj] = dn[j];
                k[(2 * i, 2 * j)] += weight * (d11 * xi * xj + d33 * yi * yj);
                k[(2 * i, 2 * j + 1)] += weight * (d12 * xi * yj + d33 * yi * xj);
                k[(2 * i + 1, 2 * j)] += weight * (d12 * yi * xj + d33 * xi * yj);
                k[(2 * i + 1, 2 * j + 1)] += weight * (d22 * yi * yj + d33 * xi * xj);
            }
        }
    }
    k.fill_lower_triangle_with_upper_triangle();
    Some(k)
}

/// Stresses (σ_xx, σ_yy, σ_xy) at the centre, tension positive, for the displacements `u` of the corners.
pub fn stress_at_centre(corners: &[[f64; 2]; 4], d: &Matrix3, u: &[f64; 8]) -> [f64; 3] {
    let (dn, _) = gradients(corners, [0.0, 0.0]);
    let u = Vector8::from(*u);
    let mut strain = SVector::<f64, 3>::zeros();
    for (i, [x, y]) in dn.into_iter().enumerate() {
        strain[0] += x * u[2 * i];
        strain[1] += y * u[2 * i + 1];
        strain[2] += y * u[2 * i] + x * u[2 * i + 1];
    }
    (d * strain).into()
}

/// (∂N_i/∂x, ∂N_i/∂y) of the four shape functions and det J at (ξ, η).
fn gradients(corners: &[[f64; 2]; 4], at: [f64; 2]) -> ([[f64; 2]; 4], f64) {
    let natural = CORNERS.map(|c| [0.25 * c[0] * (1.0 + c[1] * at[1]), 0.25 * c[1] * (1.0 + c[0] * at[0])]);
    let mut j = [[0.0; 2]; 2];
    for (n, corner) in natural.iter().zip(corners) {
        for a in 0..2 {
            for b in 0..2 {
                j[a][b] += n[a] * corner[b];
            }
        }
    }
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    let inverse = 1.0 / det;
    let gradients =
        natural.map(|[xi, eta]| [(j[1][1] * xi - j[0][1] * eta) * inverse, (j[0][0] * eta - j[1][0] * xi) * inverse]);
    (gradients, det)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(e: f64, nu: f64) -> Material {
        Material { youngs_modulus: e, poisson_ratio: nu, density: 0.0, expansion: 0.0 }
    }

    /// Unit square, E = 1, ν = 0, t = 1: k_11 = ∫ (N_x² + N_y²/2) = 1/3 + 1/6 = 1/2, and the couplings by hand.
    #[test]
    fn unit_square() {
        let d = elasticity(&material(1.0, 0.0), Plane::Strain);
        let k = stiffness(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &d, 1.0).unwrap();
        // ∫N1x N2x = −1/3, ∫N1y N2y = 1/6; ∫N1x N1y = 1/4.
        assert!((k[(0, 0)] - 0.5).abs() < 1e-15);
        assert!((k[(0, 2)] - (-1.0 / 3.0 + 0.5 / 6.0)).abs() < 1e-15);
        assert!((k[(0, 1)] - 0.125).abs() < 1e-15);
    }

    /// Any linear field on any convex quad gives its constant stress exactly, and the nodal forces balance it.
    #[test]
    fn linear_fields_are_exact() {
        let corners = [[0.1, -0.2], [2.3, 0.3], [1.9, 1.7], [-0.4, 1.1]];
        for plane in [Plane::Stress, Plane::Strain] {
            let d = elasticity(&material(3.0, 0.3), plane);
            let k = stiffness(&corners, &d, 0.7).unwrap();
            let mut u = [0.0; 8];
            for (i, [x, y]) in corners.into_iter().enumerate() {
                u[2 * i] = 0.1 + 0.02 * x - 0.05 * y;
                u[2 * i + 1] = -0.3 + 0.07 * x + 0.03 * y;
            }
            let strain = SVector::<f64, 3>::new(0.02, 0.03, 0.02);
            let exact = d * strain;
            let stress = stress_at_centre(&corners, &d, &u);
            for i in 0..3 {
                assert!((stress[i] - exact[i]).abs() < 1e-14);
            }
            // Energy ½ uᵀ k u = ½ t A εᵀ σ.
            let area = 0.5
                * (0..4)
                    .map(|i| {
                        let [a, b] = [corners[i], corners[(i + 1) % 4]];
                        a[0] * b[1] - b[0] * a[1]
                    })
                    .sum::<f64>();
            let v = Vector8::from(u);
            let energy = (v.transpose() * k * v)[0];
            assert!((energy - 0.7 * area * strain.dot(&exact)).abs() < 1e-14);
        }
    }

    #[test]
    fn clockwise_and_reentrant_quads_are_refused() {
        let d = elasticity(&material(1.0, 0.0), Plane::Stress);
        let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        let dart = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
        assert!(stiffness(&clockwise, &d, 1.0).is_none());
        assert!(stiffness(&dart, &d, 1.0).is_none());
    }
}
