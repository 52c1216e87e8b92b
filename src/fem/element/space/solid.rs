//! Isoparametric solids: tetrahedra of 4 and 10 nodes, hexahedra of 8 and 20 (`shape_functions`), those of 8 with or
//! without incompatible modes.
//!
//! ```text
//!     k_ij = Σ_g (λ g_i g_jᵀ + μ g_j g_iᵀ + μ (g_i·g_j) 1) w det J         g_i = ∂N_i/∂(x, y, z)
//!     σ = λ tr(ε − ε₀) 1 + 2μ (ε − ε₀),  ε₀ = α ΔT 1
//!     λ = Eν/((1 + ν)(1 − 2ν)),  μ = E/2(1 + ν)
//! ```
//! Hughes, *The Finite Element Method*, 1987, §2.7 and §3.10.

use super::super::acting::{Acting, free_strain};
use super::super::finite_element::{FiniteElement, Stiffness, Stress, energy_of_stress, weighted};
use super::super::incompatible;
use super::super::jacobian::{SpaceJacobian, Triple};
use crate::doubled::{Doubled, Real};
use crate::model::shape_functions::{MOST_OF_SOLID, SolidShape, TETRAHEDRON_SIDES, VolumePoint};
use crate::model::structure::{ElementLoad, Material};

/// Incompatible modes of a brick, each along x, y and z.
const MODES: usize = 3;

/// A solid element with all that its integrals need; its rows are u_x, u_y, u_z of each node in turn.
pub struct Solid<'a> {
    /// Coordinates of its nodes: 4, 8, 10 or 20.
    pub nodes: Vec<[f64; 3]>,
    /// What it is made of; ν < 0.5.
    pub material: &'a Material,
    /// Whether an element of eight nodes has incompatible modes besides the functions of its nodes.
    pub incompatible: bool,
}

/// Gradients of all functions of an element, those of the nodes first, and det J.
struct Gradients<T> {
    of: [Triple<T>; MOST_OF_SOLID + MODES],
    determinant: T,
}

impl Solid<'_> {
    fn shape(&self) -> SolidShape {
        SolidShape::of(self.nodes.len())
    }

    /// Points of its integrals.
    fn points(&self) -> Vec<VolumePoint> {
        self.shape().points(self.bulges())
    }

    /// Whether a side of a tetrahedron has its node elsewhere than in the middle.
    fn bulges(&self) -> bool {
        if self.shape() != SolidShape::Tetrahedron10 {
            return false;
        }
        let size = self.nodes.iter().flatten().fold(0.0_f64, |size, x| size.max(x.abs()));
        let off = |[a, b]: [usize; 2], middle: &[f64; 3]| {
            (0..3).any(|c| (0.5 * (self.nodes[a][c] + self.nodes[b][c]) - middle[c]).abs() > 4.0 * f64::EPSILON * size)
        };
        TETRAHEDRON_SIDES.into_iter().zip(&self.nodes[4..]).any(|(ends, middle)| off(ends, middle))
    }

    /// Lamé's λ and μ.
    fn moduli(&self) -> [f64; 2] {
        let nu = self.material.poisson_ratio;
        let mu = self.material.shear_modulus();
        [2.0 * mu * nu / (1.0 - 2.0 * nu), mu]
    }

    /// Stiffness; `None` if det J ≤ 0 at a node or an integration point.
    fn stiffness_in<T: Real>(&self) -> Option<Stiffness<T>> {
        let rows = 3 * self.nodes.len();
        Some(self.stiffness_of_all()?.resize(rows, rows, T::zero()))
    }

    /// The same with the rows of the incompatible modes after those of the nodes, each as it was when it was eliminated
    /// (the last one first).
    fn stiffness_of_all<T: Real>(&self) -> Option<Stiffness<T>> {
        if self.shape().nodes().iter().any(|&at| self.jacobian::<f64>(at).determinant <= 0.0) {
            return None;
        }
        let [lambda, mu] = self.moduli().map(T::from);
        let count = self.functions();
        let mut k = Stiffness::zeros(3 * count, 3 * count);
        for (at, w) in self.points() {
            let gradients = self.gradients::<T>(at);
            if gradients.determinant.to_f64() <= 0.0 {
                return None;
            }
            let weight = T::from(w) * gradients.determinant;
            for j in 0..count {
                let gj = gradients.of[j];
                let (by_lambda, by_mu) = (gj.map(|g| lambda * weight * g), gj.map(|g| mu * weight * g));
                for i in 0..=j {
                    let gi = gradients.of[i];
                    let dot = gi[0] * by_mu[0] + gi[1] * by_mu[1] + gi[2] * by_mu[2];
                    for a in 0..3 {
                        for b in 0..3 {
                            let mut value = gi[a] * by_lambda[b] + gi[b] * by_mu[a];
                            if a == b {
                                value += dot;
                            }
                            k[(3 * i + a, 3 * j + b)] += value;
                        }
                    }
                }
            }
        }
        k.fill_lower_triangle_with_upper_triangle();
        incompatible::eliminate(&mut k, 3 * self.nodes.len()..3 * count);
        Some(k)
    }

    /// Functions that displacements are made of: of the nodes, then the incompatible modes.
    fn functions(&self) -> usize {
        self.nodes.len() + if self.incompatible { MODES } else { 0 }
    }

    /// Nodal forces ∫ N b dV of the uniform force `b` per volume, rows as in the stiffness.
    fn body_force(&self, b: [f64; 3]) -> Vec<f64> {
        let mut f = vec![0.0; 3 * self.nodes.len()];
        for (at, w) in self.points() {
            let weight = self.jacobian::<f64>(at).determinant * w;
            for (f, n) in f.chunks_exact_mut(3).zip(self.shape().values(at)) {
                f.iter_mut().zip(b).for_each(|(f, b)| *f += weight * n * b);
            }
        }
        f
    }

    /// Nodal forces ∫ Bᵀ σ₀ dV of the free expansion `strain` = α ΔT, rows as in the stiffness.
    fn expansion_force(&self, strain: f64) -> Vec<f64> {
        let stress = self.held_stress(strain);
        let mut f = vec![0.0; 3 * self.nodes.len()];
        for (at, w) in self.points() {
            let gradients = self.gradients::<f64>(at);
            let weight = stress * gradients.determinant * w;
            for (f, gradient) in f.chunks_exact_mut(3).zip(gradients.of) {
                f.iter_mut().zip(gradient).for_each(|(f, g)| *f += weight * g);
            }
        }
        f
    }

    /// (3λ + 2μ) α ΔT: the pressure of a body that is held while it would expand.
    fn held_stress(&self, strain: f64) -> f64 {
        let [lambda, mu] = self.moduli();
        (3.0 * lambda + 2.0 * mu) * strain
    }

    /// The displacements `u` of its nodes, then the amounts of the incompatible modes.
    fn with_modes(&self, u: &[f64]) -> Vec<f64> {
        let k = self.incompatible.then(|| self.stiffness_of_all::<f64>()).flatten();
        k.map_or_else(|| u.to_vec(), |k| incompatible::completed(&k, u, 3 * self.functions()))
    }

    /// Stress at (ξ, η, ζ) for the displacements `u`, [modes](Self::with_modes) included, and the free expansion
    /// `strain` = α ΔT: extrapolated from the points where the element's stresses are best.
    fn stress_at(&self, at: [f64; 3], u: &[f64], strain: f64) -> Stress {
        let (points, weights) = (self.shape().stress_points(), self.shape().extrapolation(at));
        weighted(&weights, points.into_iter().map(|point| self.stress_at_point(point, u, strain)))
    }

    /// Stress of the strains at (ξ, η, ζ).
    fn stress_at_point(&self, at: [f64; 3], u: &[f64], strain: f64) -> Stress {
        let gradients = self.gradients::<f64>(at);
        // ∂u_a/∂x_b
        let mut slopes = [[0.0; 3]; 3];
        for (u, gradient) in u.chunks_exact(3).zip(gradients.of) {
            for (slopes, u) in slopes.iter_mut().zip(u) {
                slopes.iter_mut().zip(gradient).for_each(|(slope, g)| *slope += u * g);
            }
        }
        let [lambda, mu] = self.moduli();
        let volume = lambda * (slopes[0][0] + slopes[1][1] + slopes[2][2]) - self.held_stress(strain);
        let direct = |a: usize| volume + 2.0 * mu * slopes[a][a];
        let shear = |a: usize, b: usize| mu * (slopes[a][b] + slopes[b][a]);
        [direct(0), direct(1), shear(0, 1), direct(2), shear(1, 2), shear(2, 0)]
    }

    /// Gradients of all functions at (ξ, η, ζ).
    fn gradients<T: Real>(&self, at: [f64; 3]) -> Gradients<T> {
        let natural = self.shape().gradients(at);
        let jacobian = self.jacobian_of(&natural);
        let determinant = jacobian.determinant;
        let mut of = [[T::zero(); 3]; MOST_OF_SOLID + MODES];
        for (of, natural) in of.iter_mut().zip(&natural[..self.nodes.len()]) {
            *of = jacobian.turn(*natural);
        }
        if self.incompatible {
            let centre = self.jacobian(self.shape().centre());
            let modes = incompatible::gradients_in_space(at, &centre, determinant);
            of[self.nodes.len()..self.functions()].copy_from_slice(&modes);
        }
        Gradients { of, determinant }
    }

    fn jacobian<T: Real>(&self, at: [f64; 3]) -> SpaceJacobian<T> {
        self.jacobian_of(&self.shape().gradients(at))
    }

    /// The Jacobian where the functions of the nodes have these gradients.
    fn jacobian_of<T: Real>(&self, natural: &[Triple<T>]) -> SpaceJacobian<T> {
        // Coordinates from the first node: the place in space costs no digits.
        let mut j = [[T::zero(); 3]; 3];
        for (n, node) in natural.iter().zip(&self.nodes) {
            for b in 0..3 {
                let x = T::difference(node[b], self.nodes[0][b]);
                for a in 0..3 {
                    j[a][b] += n[a] * x;
                }
            }
        }
        SpaceJacobian::of(j)
    }
}

impl FiniteElement for Solid<'_> {
    fn stiffness(&self) -> Result<Stiffness, &'static str> {
        self.stiffness_in().ok_or(INSIDE_OUT)
    }

    fn doubled_stiffness(&self) -> Result<Stiffness<Doubled>, &'static str> {
        self.stiffness_in().ok_or(INSIDE_OUT)
    }

    fn nodal_forces(&self, acting: &Acting) -> Vec<f64> {
        let mut all = vec![0.0; 3 * self.nodes.len()];
        for &(factor, load) in acting {
            let forces = match load {
                ElementLoad::Body(b) => self.body_force(b.map(|b| factor * b)),
                ElementLoad::FreeStrain { strain, .. } => self.expansion_force(factor * strain),
                ElementLoad::Line { .. } | ElementLoad::Point { .. } => continue,
            };
            all.iter_mut().zip(forces).for_each(|(all, force)| *all += force);
        }
        all
    }

    fn strain_energy(&self, u: &[f64], acting: &Acting) -> f64 {
        let (u, strain) = (self.with_modes(u), free_strain(acting));
        let of_point = |(at, w): VolumePoint| {
            let volume = self.gradients::<f64>(at).determinant * w;
            volume * energy_of_stress(self.material, self.stress_at_point(at, &u, strain))
        };
        self.points().into_iter().map(of_point).sum()
    }

    fn stress(&self, u: &[f64], acting: &Acting) -> Option<Stress> {
        Some(self.stress_at(self.shape().centre(), &self.with_modes(u), free_strain(acting)))
    }

    fn node_stresses(&self, u: &[f64], acting: &Acting) -> Option<Vec<Stress>> {
        let (u, strain) = (self.with_modes(u), free_strain(acting));
        Some(self.shape().nodes().iter().map(|&at| self.stress_at(at, &u, strain)).collect())
    }
}

const INSIDE_OUT: &str = "it is turned inside out somewhere: its nodes are not in the order of its shape, or one of them \
                          lies so that it folds";

#[cfg(test)]
mod tests;
