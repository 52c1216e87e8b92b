//! Isoparametric membranes: triangles of 3 and 6 nodes, quadrilaterals of 4 and 8 (`shape_functions`).
//!
//! ```text
//!     k = t Σ_g Bᵀ D B w det J        ε = B u = (ε_xx, ε_yy, γ_xy),  σ = D (ε − ε₀)
//!     ε₀ = α ΔT (1, 1, 0)             plane stress
//!     ε₀ = (1 + ν) α ΔT (1, 1, 0)     plane strain: ε_z is held
//! ```
//! Hughes, *The Finite Element Method*, 1987, §2.7 and §3.10; Cook, *Concepts and Applications*, 4th ed., §3.9.

use nalgebra::{SMatrix, SVector};

use super::acting::{Acting, free_strain};
use super::finite_element::{FiniteElement, Stiffness, Stress, energy_of_stress, weighted};
use super::incompatible;
use super::jacobian::{determinant, in_plane};
use crate::doubled::{Doubled, Real};
use crate::model::shape_functions::{AreaShape, MOST};
use crate::model::structure::{ElementLoad, Material, Plane};

type Matrix3 = SMatrix<f64, 3, 3>;

/// A membrane element with all that its integrals need; its rows are u_x, u_y of each node in turn.
pub struct Membrane<'a> {
    /// Coordinates of its nodes: 3, 4, 6 or 8.
    pub nodes: Vec<[f64; 2]>,
    /// What it is made of.
    pub material: &'a Material,
    /// Stress state.
    pub plane: Plane,
    /// Thickness out of the plane.
    pub thickness: f64,
    /// Whether an element of four nodes has incompatible modes besides the functions of its nodes.
    pub incompatible: bool,
}

/// D: (σ_xx, σ_yy, σ_xy) = D (ε_xx, ε_yy, γ_xy).
fn elasticity(material: &Material, plane: Plane) -> Matrix3 {
    let (e, nu) = (material.youngs_modulus, material.poisson_ratio);
    let (direct, cross) = match plane {
        Plane::Stress => (e / (1.0 - nu * nu), e * nu / (1.0 - nu * nu)),
        Plane::Strain => {
            let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
            (c * (1.0 - nu), c * nu)
        }
    };
    let shear = material.shear_modulus();
    Matrix3::new(direct, cross, 0.0, cross, direct, 0.0, 0.0, 0.0, shear)
}

impl Membrane<'_> {
    fn shape(&self) -> AreaShape {
        AreaShape::of(self.nodes.len())
    }

    /// Stiffness; `None` if det J ≤ 0 at a node or an integration point (not convex, clockwise, or a middle node too
    /// far from its middle).
    fn stiffness_in<T: Real>(&self) -> Option<Stiffness<T>> {
        let rows = 2 * self.nodes.len();
        Some(self.stiffness_of_all()?.resize(rows, rows, T::zero()))
    }

    /// The same with the rows of the incompatible modes after those of the nodes, each as it was when it was eliminated
    /// (the last one first).
    fn stiffness_of_all<T: Real>(&self) -> Option<Stiffness<T>> {
        if self.shape().nodes().iter().any(|&at| determinant(&self.jacobian::<f64>(at)) <= 0.0) {
            return None;
        }
        let d = elasticity(self.material, self.plane);
        let [d11, d12, d22, d33] = [d[(0, 0)], d[(0, 1)], d[(1, 1)], d[(2, 2)]].map(T::from);
        let count = self.functions();
        let mut k = Stiffness::zeros(2 * count, 2 * count);
        for (at, w) in self.shape().points() {
            let (dn, det) = self.gradients::<T>(at);
            if det.to_f64() <= 0.0 {
                return None;
            }
            let weight = T::from(self.thickness * w) * det;
            // Bᵀ D B block by block: D has only four entries that are not zero.
            for i in 0..count {
                let [xi, yi] = dn[i];
                for j in i..count {
                    let [xj, yj] = dn[j];
                    k[(2 * i, 2 * j)] += weight * (d11 * xi * xj + d33 * yi * yj);
                    k[(2 * i, 2 * j + 1)] += weight * (d12 * xi * yj + d33 * yi * xj);
                    k[(2 * i + 1, 2 * j)] += weight * (d12 * yi * xj + d33 * xi * yj);
                    k[(2 * i + 1, 2 * j + 1)] += weight * (d22 * yi * yj + d33 * xi * xj);
                }
            }
        }
        k.fill_lower_triangle_with_upper_triangle();
        incompatible::eliminate(&mut k, 2 * self.nodes.len()..2 * count);
        Some(k)
    }

    /// Functions that displacements are made of: of the nodes, then the incompatible modes.
    fn functions(&self) -> usize {
        self.nodes.len() + if self.incompatible { incompatible::MODES } else { 0 }
    }

    /// Nodal forces ∫ N b t dA of the uniform force `b` per volume, rows as in the stiffness.
    fn body_force(&self, b: [f64; 2]) -> Vec<f64> {
        let mut f = vec![0.0; 2 * self.nodes.len()];
        for (at, w) in self.shape().points() {
            let weight = self.thickness * self.gradients::<f64>(at).1 * w;
            for (i, n) in self.shape().values(at)[..self.nodes.len()].iter().enumerate() {
                f[2 * i] += weight * n * b[0];
                f[2 * i + 1] += weight * n * b[1];
            }
        }
        f
    }

    /// Nodal forces ∫ Bᵀ D ε₀ t dA of the free expansion `strain` = α ΔT, rows as in the stiffness.
    fn expansion_force(&self, strain: f64) -> Vec<f64> {
        let stress = elasticity(self.material, self.plane) * self.initial_strain(strain);
        let mut f = vec![0.0; 2 * self.nodes.len()];
        for (at, w) in self.shape().points() {
            let (dn, det) = self.gradients::<f64>(at);
            let weight = self.thickness * det * w;
            for (i, [x, y]) in dn[..self.nodes.len()].iter().enumerate() {
                f[2 * i] += weight * (x * stress[0] + y * stress[2]);
                f[2 * i + 1] += weight * (y * stress[1] + x * stress[2]);
            }
        }
        f
    }

    /// Area × thickness.
    #[cfg(test)]
    fn volume(&self) -> f64 {
        self.shape().points().into_iter().map(|(at, w)| self.thickness * self.gradients::<f64>(at).1 * w).sum()
    }

    /// The displacements `u` of its nodes, then the amounts of the incompatible modes.
    fn with_modes(&self, u: &[f64]) -> Vec<f64> {
        let k = self.incompatible.then(|| self.stiffness_of_all::<f64>()).flatten();
        k.map_or_else(|| u.to_vec(), |k| incompatible::completed(&k, u, 2 * self.functions()))
    }

    /// Stress at (ξ, η) for the displacements `u`, [modes](Self::with_modes) included, and the free expansion
    /// `strain` = α ΔT: extrapolated from the points where the element's stresses are best.
    fn stress_at(&self, at: [f64; 2], u: &[f64], strain: f64) -> Stress {
        let (points, weights) = (self.shape().stress_points(), self.shape().extrapolation(at));
        weighted(&weights, points.into_iter().map(|point| self.stress_at_point(point, u, strain)))
    }

    /// D (B u − ε₀) at (ξ, η), with σ_zz.
    fn stress_at_point(&self, at: [f64; 2], u: &[f64], strain: f64) -> Stress {
        let (dn, _) = self.gradients::<f64>(at);
        let mut total = SVector::<f64, 3>::zeros();
        for (i, [x, y]) in dn[..u.len() / 2].iter().enumerate() {
            total[0] += x * u[2 * i];
            total[1] += y * u[2 * i + 1];
            total[2] += y * u[2 * i] + x * u[2 * i + 1];
        }
        let stress = elasticity(self.material, self.plane) * (total - self.initial_strain(strain));
        let across = match self.plane {
            Plane::Stress => 0.0,
            // ε_z = 0 = (σ_z − ν (σ_x + σ_y))/E + α ΔT.
            Plane::Strain => {
                self.material.poisson_ratio * (stress[0] + stress[1]) - self.material.youngs_modulus * strain
            }
        };
        [stress[0], stress[1], stress[2], across, 0.0, 0.0]
    }

    fn initial_strain(&self, strain: f64) -> SVector<f64, 3> {
        let in_plane = match self.plane {
            Plane::Stress => strain,
            Plane::Strain => (1.0 + self.material.poisson_ratio) * strain,
        };
        SVector::<f64, 3>::new(in_plane, in_plane, 0.0)
    }

    /// (∂N_i/∂x, ∂N_i/∂y) of all functions and det J at (ξ, η).
    fn gradients<T: Real>(&self, at: [f64; 2]) -> ([[T; 2]; MOST], T) {
        let mut gradients = self.shape().gradients(at);
        let j = self.jacobian_of(&gradients);
        let det = determinant(&j);
        let inverse = T::one() / det;
        for natural in &mut gradients[..self.nodes.len()] {
            *natural = in_plane(&j, inverse, *natural);
        }
        if self.incompatible {
            let centre = self.jacobian::<T>(self.shape().centre());
            let modes = incompatible::gradients(at, &centre, determinant(&centre) / det);
            gradients[self.nodes.len()..self.functions()].copy_from_slice(&modes);
        }
        (gradients, det)
    }

    /// J: (∂x/∂ξ, ∂y/∂ξ), (∂x/∂η, ∂y/∂η) at (ξ, η).
    fn jacobian<T: Real>(&self, at: [f64; 2]) -> [[T; 2]; 2] {
        self.jacobian_of(&self.shape().gradients(at))
    }

    /// The same from (∂N_i/∂ξ, ∂N_i/∂η) there.
    fn jacobian_of<T: Real>(&self, gradients: &[[T; 2]; MOST]) -> [[T; 2]; 2] {
        // Coordinates from the first node: the place in the plane costs no digits.
        let mut j = [[T::zero(); 2]; 2];
        for (n, node) in gradients.iter().zip(&self.nodes) {
            for a in 0..2 {
                for b in 0..2 {
                    j[a][b] += n[a] * T::difference(node[b], self.nodes[0][b]);
                }
            }
        }
        j
    }
}

impl FiniteElement for Membrane<'_> {
    fn stiffness(&self) -> Result<Stiffness, &'static str> {
        self.stiffness_in().ok_or(INSIDE_OUT)
    }

    fn doubled_stiffness(&self) -> Result<Stiffness<Doubled>, &'static str> {
        self.stiffness_in().ok_or(INSIDE_OUT)
    }

    fn nodal_forces(&self, acting: &Acting) -> Vec<f64> {
        let mut all = vec![0.0; 2 * self.nodes.len()];
        for &(factor, load) in acting {
            let forces = match load {
                ElementLoad::Body([x, y, _]) => self.body_force([x, y].map(|b| factor * b)),
                ElementLoad::FreeStrain { strain, .. } => self.expansion_force(factor * strain),
                ElementLoad::Line { .. } | ElementLoad::Point { .. } => continue,
            };
            all.iter_mut().zip(forces).for_each(|(all, force)| *all += force);
        }
        all
    }

    fn strain_energy(&self, u: &[f64], acting: &Acting) -> f64 {
        let (u, strain) = (self.with_modes(u), free_strain(acting));
        let of_point = |(at, w): ([f64; 2], f64)| {
            let volume = self.thickness * self.gradients::<f64>(at).1 * w;
            volume * energy_of_stress(self.material, self.stress_at_point(at, &u, strain))
        };
        self.shape().points().into_iter().map(of_point).sum()
    }

    fn stress(&self, u: &[f64], acting: &Acting) -> Option<Stress> {
        Some(self.stress_at(self.shape().centre(), &self.with_modes(u), free_strain(acting)))
    }

    fn node_stresses(&self, u: &[f64], acting: &Acting) -> Option<Vec<Stress>> {
        let (u, strain) = (self.with_modes(u), free_strain(acting));
        Some(self.shape().nodes().iter().map(|&at| self.stress_at(at, &u, strain)).collect())
    }
}

const INSIDE_OUT: &str = "it is not convex, or its nodes do not go round counter-clockwise";

#[cfg(test)]
mod tests {
    use super::*;

    fn material(e: f64, nu: f64) -> Material {
        Material { youngs_modulus: e, poisson_ratio: nu, density: 0.0, expansion: 0.0 }
    }

    fn with<T>(nodes: &[[f64; 2]], plane: Plane, run: impl Fn(&Membrane) -> T) -> T {
        let material = material(3.0, 0.3);
        run(&Membrane { nodes: nodes.to_vec(), material: &material, plane, thickness: 0.7, incompatible: false })
    }

    /// One distorted element of every shape; the quadratic ones with a side that bulges.
    fn distorted() -> Vec<Vec<[f64; 2]>> {
        let quad = [[0.1, -0.2], [2.3, 0.3], [1.9, 1.7], [-0.4, 1.1]];
        let triangle = [[0.1, -0.2], [2.3, 0.3], [-0.4, 1.1]];
        let quadratic = |corners: &[[f64; 2]]| {
            let mut nodes = corners.to_vec();
            for (i, a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                nodes.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
            }
            nodes[corners.len()][1] -= 0.15;
            nodes
        };
        vec![quad.to_vec(), triangle.to_vec(), quadratic(&quad), quadratic(&triangle)]
    }

    /// Unit square, E = 1, ν = 0, t = 1: k_11 = ∫ (N_x² + N_y²/2) = 1/3 + 1/6 = 1/2, and the couplings by hand.
    #[test]
    fn unit_square() {
        let material = material(1.0, 0.0);
        let nodes = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let element = Membrane {
            nodes: nodes.to_vec(),
            material: &material,
            plane: Plane::Strain,
            thickness: 1.0,
            incompatible: false,
        };
        let k = element.stiffness().unwrap();
        // ∫N1x N2x = −1/3, ∫N1y N2y = 1/6; ∫N1x N1y = 1/4.
        assert!((k[(0, 0)] - 0.5).abs() < 1e-15);
        assert!((k[(0, 2)] - (-1.0 / 3.0 + 0.5 / 6.0)).abs() < 1e-15);
        assert!((k[(0, 1)] - 0.125).abs() < 1e-15);
    }

    /// Any linear field on any distorted element gives its constant stress exactly at every place, and ½ uᵀ k u is
    /// ½ t A εᵀ σ.
    #[test]
    fn linear_fields_are_exact() {
        for nodes in distorted() {
            for plane in [Plane::Stress, Plane::Strain] {
                with(&nodes, plane, |element| {
                    let u: Vec<f64> = nodes
                        .iter()
                        .flat_map(|[x, y]| [0.1 + 0.02 * x - 0.05 * y, -0.3 + 0.07 * x + 0.03 * y])
                        .collect();
                    let strain = SVector::<f64, 3>::new(0.02, 0.03, 0.02);
                    let exact = elasticity(element.material, plane) * strain;
                    for &at in element.shape().nodes().iter().chain([&element.shape().centre()]) {
                        let stress = element.stress_at(at, &u, 0.0);
                        for i in 0..3 {
                            assert!((stress[i] - exact[i]).abs() < 1e-13, "{} nodes", nodes.len());
                        }
                    }
                    let k = element.stiffness().unwrap();
                    let count = u.len();
                    let energy: f64 =
                        (0..count).map(|i| (0..count).map(|j| u[i] * k[(i, j)] * u[j]).sum::<f64>()).sum();
                    let volume = element.volume();
                    assert!((energy - volume * strain.dot(&exact)).abs() < 1e-14, "{} nodes", nodes.len());
                });
            }
        }
    }

    /// Without loads the energy of the stresses is ½ uᵀ k u, whatever the shape and the displacements.
    #[test]
    fn stresses_store_what_the_stiffness_does() {
        for nodes in distorted() {
            for plane in [Plane::Stress, Plane::Strain] {
                with(&nodes, plane, |plain| {
                    for incompatible in [false, nodes.len() == 4] {
                        let element = Membrane { nodes: nodes.clone(), incompatible, ..*plain };
                        let u = nalgebra::DVector::from_fn(2 * nodes.len(), |i, _| (1.7 * i as f64 + 0.3).sin());
                        let right = 0.5 * u.dot(&(element.stiffness().unwrap() * &u));
                        assert!((element.strain_energy(u.as_slice(), &[]) - right).abs() < 1e-13 * right);
                    }
                });
            }
        }
    }

    /// Free expansion is met exactly by u = α ΔT x: no stress in the plane, and k u = f. In plane strain ε_z is held.
    #[test]
    fn free_expansion_makes_no_stress() {
        let heat = 0.01;
        for nodes in distorted() {
            for plane in [Plane::Stress, Plane::Strain] {
                with(&nodes, plane, |element| {
                    let factor = if plane == Plane::Strain { 1.3 * heat } else { heat };
                    let u: Vec<f64> = nodes.iter().flatten().map(|x| factor * x).collect();
                    let stress = element.stress_at(element.shape().centre(), &u, heat);
                    let across = if plane == Plane::Strain { -3.0 * heat } else { 0.0 };
                    for (found, right) in stress.into_iter().zip([0.0, 0.0, 0.0, across]) {
                        assert!((found - right).abs() < 1e-14, "{} nodes: {stress:?}", nodes.len());
                    }
                    let (k, f) = (element.stiffness().unwrap(), element.expansion_force(heat));
                    for i in 0..u.len() {
                        let force: f64 = (0..u.len()).map(|j| k[(i, j)] * u[j]).sum();
                        assert!((force - f[i]).abs() < 1e-14, "{} nodes", nodes.len());
                    }
                });
            }
        }
    }

    /// Resultant and moment of a body force are those of the area (shoelace formula; the bulge of a quadratic side is
    /// a parabola of area 2/3 × length × 0.15 below the chord, of known centroid only in x and y by the integral of
    /// the same map: so the resultant alone is compared there).
    #[test]
    fn body_forces_keep_their_resultant() {
        for nodes in distorted() {
            with(&nodes, Plane::Stress, |element| {
                let corners = if nodes.len() > 4 { nodes.len() / 2 } else { nodes.len() };
                let corner = |i: usize| nodes[i % corners];
                let cross = |i: usize| corner(i)[0] * corner(i + 1)[1] - corner(i + 1)[0] * corner(i)[1];
                let mut area = 0.5 * (0..corners).map(cross).sum::<f64>();
                if corners < nodes.len() {
                    // The middle of the first side lies 0.15 lower: shoelace along the parabola adds 2/3·0.15·Δx.
                    area += 2.0 / 3.0 * 0.15 * (nodes[1][0] - nodes[0][0]);
                }
                let f = element.body_force([0.3, -2.0]);
                let sum = |a: usize| f.iter().skip(a).step_by(2).sum::<f64>();
                assert!((sum(0) - 0.3 * 0.7 * area).abs() < 1e-14, "{} nodes", nodes.len());
                assert!((sum(1) + 2.0 * 0.7 * area).abs() < 1e-14, "{} nodes", nodes.len());
                assert!((element.volume() - 0.7 * area).abs() < 1e-14);
            });
        }
    }

    #[test]
    fn elements_turned_inside_out_are_refused() {
        let clockwise = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        let dart = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
        let flat = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
        // The middle of the first side beyond a quarter of it: det J < 0 at its end.
        let far = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.8, 0.0], [0.5, 0.5], [0.0, 0.5]];
        for nodes in [&clockwise[..], &dart, &flat, &far] {
            assert!(with(nodes, Plane::Stress, |element| element.stiffness().is_err()));
        }
    }
}
