//! Incompatible modes of the four-node membrane, 1 − ξ² and 1 − η², and of the brick of eight nodes, with 1 − ζ² more,
//! in addition to the functions of their nodes, so that they bend as a beam does. They belong to the element alone and
//! are eliminated in it.
//!
//! ```text
//!     k = k_uu − k_uα k_αα⁻¹ k_αu,     α = −k_αα⁻¹ k_αu u
//!     (∂N/∂x, ∂N/∂y) = (det J₀/det J) J₀⁻¹ (∂N/∂ξ, ∂N/∂η)    J₀ at the centre; likewise in space
//! ```
//! With gradients taken by J₀ their integral over the element vanishes, and constant stresses stay exact in any shape
//! (Taylor, Beresford, Wilson, *A non-conforming element for stress analysis*, 1976). Loads and free strains act on
//! the functions of the nodes only: a uniform one does no work on the modes.

use std::ops::Range;

use super::finite_element::Stiffness;
use super::jacobian::{SpaceJacobian, Triple, determinant, in_plane};
use crate::doubled::Real;

/// Modes, each along x and along y.
pub const MODES: usize = 2;

/// Their gradients at (ξ, η) with J at the centre and det J₀ / det J.
pub fn gradients<T: Real>([x, y]: [f64; 2], centre: &[[T; 2]; 2], ratio: T) -> [[T; 2]; MODES] {
    let natural = [[T::from(-2.0 * x), T::zero()], [T::zero(), T::from(-2.0 * y)]];
    natural.map(|natural| in_plane(centre, determinant(centre), natural).map(|value| value * ratio))
}

/// Those of the brick at (ξ, η, ζ), each along x, y and z, with the Jacobian at the centre.
pub fn gradients_in_space<T: Real>(at: [f64; 3], centre: &SpaceJacobian<T>, determinant: T) -> [Triple<T>; 3] {
    let ratio = centre.determinant / determinant;
    [0, 1, 2].map(|mode| {
        let mut natural = [T::zero(); 3];
        natural[mode] = T::from(-2.0 * at[mode]);
        centre.turn(natural).map(|value| value * ratio)
    })
}

/// Eliminates `rows` of a symmetric k, the last one first; each keeps its entries as they are when its turn comes.
pub fn eliminate<T: Real>(k: &mut Stiffness<T>, rows: Range<usize>) {
    for row in rows.rev() {
        let pivot = k[(row, row)];
        for i in 0..row {
            for j in 0..=i {
                let entry = k[(i, j)] - k[(i, row)] * k[(row, j)] / pivot;
                k[(i, j)] = entry;
                k[(j, i)] = entry;
            }
        }
    }
}

/// The displacements of the nodes, then the amounts of the modes, up to `count` rows, from the rows of k that
/// [`eliminate`] left.
pub fn completed(k: &Stiffness, nodes: &[f64], count: usize) -> Vec<f64> {
    let mut u = nodes.to_vec();
    for row in u.len()..count {
        let forced: f64 = u.iter().enumerate().map(|(j, u)| k[(row, j)] * u).sum();
        u.push(-forced / k[(row, row)]);
    }
    u
}

#[cfg(test)]
mod tests {
    use super::super::finite_element::FiniteElement;
    use super::super::membrane::Membrane;
    use crate::model::structure::{Material, Plane};

    fn with<T>(nodes: &[[f64; 2]; 4], incompatible: bool, run: impl Fn(&Membrane<'_>) -> T) -> T {
        let material = Material { youngs_modulus: 3.0, poisson_ratio: 0.3, density: 0.0, expansion: 0.0 };
        let nodes = nodes.to_vec();
        run(&Membrane { nodes, material: &material, plane: Plane::Stress, thickness: 0.7, incompatible })
    }

    /// A linear field on a distorted quad: its constant stress everywhere, and the energy of that stress.
    #[test]
    fn constant_stress_in_any_shape() {
        let nodes = [[0.1, -0.2], [2.3, 0.3], [1.9, 1.7], [-0.4, 1.1]];
        let u: Vec<f64> = nodes.iter().flat_map(|[x, y]| [0.1 + 0.02 * x - 0.05 * y, 0.07 * x + 0.03 * y]).collect();
        // ε = (0.02, 0.03, 0.02), plane stress.
        let c = 3.0 / (1.0 - 0.09);
        let exact = [c * (0.02 + 0.3 * 0.03), c * (0.03 + 0.3 * 0.02), 3.0 / 2.6 * 0.02, 0.0, 0.0, 0.0];
        with(&nodes, true, |element| {
            let centre = element.stress(&u, &[]).unwrap();
            for found in element.node_stresses(&u, &[]).unwrap().into_iter().chain([centre]) {
                for (found, exact) in found.into_iter().zip(exact) {
                    assert!((found - exact).abs() < 1e-14);
                }
            }
            let k = element.stiffness().unwrap();
            let energy: f64 =
                (0..8).flat_map(|i| (0..8).map(move |j| (i, j))).map(|(i, j)| u[i] * k[(i, j)] * u[j]).sum();
            // Shoelace.
            let cross = |i: usize| nodes[i][0] * nodes[(i + 1) % 4][1] - nodes[(i + 1) % 4][0] * nodes[i][1];
            let area = 0.5 * (0..4).map(cross).sum::<f64>();
            let density = 0.02 * exact[0] + 0.03 * exact[1] + 0.02 * exact[2];
            assert!((energy - 0.7 * area * density).abs() < 1e-14);
        });
    }

    /// A rectangle a × b bent by κ: u = −κ x y, v = κ x²/2 + ν κ y²/2 has the energy E I κ² a, I = t b³/12; a plain
    /// element is too stiff by (1/(1 + ν)) (1/(1 − ν) + (a/b)²/2) (Cook, *Concepts and Applications*, §6.6).
    /// σ_x = −E κ y.
    #[test]
    fn a_rectangle_bends_as_a_beam() {
        let (a, b, kappa, nu) = (2.0, 0.5, 0.01, 0.3);
        let nodes = [[-a / 2.0, -b / 2.0], [a / 2.0, -b / 2.0], [a / 2.0, b / 2.0], [-a / 2.0, b / 2.0]];
        let u: Vec<f64> =
            nodes.iter().flat_map(|[x, y]| [-kappa * x * y, 0.5 * kappa * x * x + 0.5 * nu * kappa * y * y]).collect();
        let exact = 3.0 * (0.7 * b * b * b / 12.0) * kappa * kappa * a;
        for (incompatible, factor) in [(true, 1.0), (false, (1.0 / (1.0 - nu) + 0.5 * (a / b) * (a / b)) / (1.0 + nu))]
        {
            with(&nodes, incompatible, |element| {
                let k = element.stiffness().unwrap();
                let energy: f64 =
                    (0..8).flat_map(|i| (0..8).map(move |j| (i, j))).map(|(i, j)| u[i] * k[(i, j)] * u[j]).sum();
                assert!((energy / exact - factor).abs() < 1e-12 * factor, "{energy} {exact} {factor}");
                if incompatible {
                    for (stress, [_, y]) in element.node_stresses(&u, &[]).unwrap().into_iter().zip(nodes) {
                        assert!((stress[0] + 3.0 * kappa * y).abs() < 1e-14, "{stress:?}");
                        assert!(stress[1].abs() < 1e-14 && stress[2].abs() < 1e-14);
                    }
                }
            });
        }
    }

    /// Rigid motions cost nothing, and nothing else does.
    #[test]
    fn three_rigid_motions() {
        let nodes = [[0.1, -0.2], [2.3, 0.3], [1.9, 1.7], [-0.4, 1.1]];
        let k = with(&nodes, true, |element| element.stiffness()).unwrap();
        let k = nalgebra::DMatrix::from_fn(8, 8, |i, j| k[(i, j)]);
        let mut values: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        assert!(values[..3].iter().all(|value| value.abs() < 1e-14) && values[3] > 1e-2, "{values:?}");
    }
}
