//! Two-node bar that carries axial force only: k = (EA/L) (e, −e)(e, −e)ᵀ with e its unit vector.
//!
//! Forces across it between its nodes are carried to the nodes as by a simple beam.

use nalgebra::DMatrix;

use super::acting::Acting;
use super::bar_load::{BarForces, BarLoad, Bending, Internal};
use super::finite_element::{FiniteElement, NO_LENGTH, Stiffness};
use crate::doubled::{Doubled, Real};
use crate::model::bar_axes::{AxesFault, BarAxes, direction};
use crate::model::structure::Material;

/// A truss element; its rows are the translations of the start, then of the end.
pub struct Truss {
    /// Places of start and end.
    ends: [[f64; 3]; 2],
    axes: BarAxes,
    /// Translations of a node: 2 in the plane, 3 in space.
    translations: usize,
    /// EA.
    axial: f64,
    area: f64,
}

impl Truss {
    /// In the plane; `None` if its ends coincide.
    pub fn in_plane(ends: [[f64; 2]; 2], material: &Material, area: f64) -> Option<Truss> {
        let axes = BarAxes::in_plane(ends)?;
        let ends = ends.map(|[x, y]| [x, y, 0.0]);
        Some(Truss { ends, axes, translations: 2, axial: material.youngs_modulus * area, area })
    }

    /// In space; its orientation is for the loads across it.
    ///
    /// # Errors
    /// See [`AxesFault`].
    pub fn in_space(
        ends: [[f64; 3]; 2],
        orientation: Option<[f64; 3]>,
        material: &Material,
        area: f64,
    ) -> Result<Truss, AxesFault> {
        let axes = BarAxes::in_space(ends, orientation)?;
        Ok(Truss { ends, axes, translations: 3, axial: material.youngs_modulus * area, area })
    }

    fn stiffness_in<T: Real>(&self) -> Option<Stiffness<T>> {
        let (length, x) = direction::<T>(self.ends)?;
        let stiffness = T::from(self.axial) / length;
        let count = self.translations;
        let d = |row: usize| if row < count { -x[row] } else { x[row - count] };
        Some(DMatrix::from_fn(2 * count, 2 * count, |i, j| d(i) * d(j) * stiffness))
    }

    /// Forces at the ends in bar axes that stand for the load between them. A couple becomes two opposite forces.
    fn local_forces(&self, load: &BarLoad) -> [[f64; 3]; 2] {
        let length = self.axes.length;
        let free = self.axial * load.strain;
        [false, true].map(|end| {
            let along = |s: f64| if end { s / length } else { 1.0 - s / length };
            let turn = if end { 1.0 / length } else { -1.0 / length };
            let across = |plane: Bending| load.work(&|s| plane.motion([0.0, along(s), turn]));
            let x = load.work(&|s| Bending::Xy.motion([along(s), 0.0, 0.0]));
            [if end { x + free } else { x - free }, across(Bending::Xy), across(Bending::Xz)]
        })
    }

    /// Internal forces at the start and at the end for global displacements `u` and the load between the nodes; as a
    /// simple beam it has no moment at both ends.
    fn end_forces(&self, u: &[f64], load: &BarLoad) -> [Internal; 2] {
        let [start, end] = [0, 1].map(|end| {
            let mut of_end = [0.0; 3];
            of_end[..self.translations].copy_from_slice(&u[end * self.translations..][..self.translations]);
            self.axes.to_local(of_end)
        });
        let n = self.axial / self.axes.length * (end[0] - start[0]);
        let [[x1, y1, z1], [x2, y2, z2]] = self.local_forces(load);
        [[n + x1, -y1, 0.0, -z1, 0.0, 0.0], [n - x2, y2, 0.0, z2, 0.0, 0.0]]
    }
}

impl FiniteElement for Truss {
    fn stiffness(&self) -> Result<Stiffness, &'static str> {
        self.stiffness_in().ok_or(NO_LENGTH)
    }

    fn doubled_stiffness(&self) -> Result<Stiffness<Doubled>, &'static str> {
        self.stiffness_in().ok_or(NO_LENGTH)
    }

    fn nodal_forces(&self, acting: &Acting) -> Vec<f64> {
        let forces = self.local_forces(&BarLoad::of(acting, &self.axes, self.area));
        forces.iter().flat_map(|&force| self.axes.to_global(force)[..self.translations].to_vec()).collect()
    }

    fn strain_energy(&self, u: &[f64], acting: &Acting) -> f64 {
        // What lies across it is carried to the nodes without yielding.
        let mut stiffnesses = [f64::INFINITY; 6];
        stiffnesses[0] = self.axial;
        self.bar_forces(u, acting).map_or(0.0, |forces| forces.strain_energy(&stiffnesses))
    }

    fn bar_forces(&self, u: &[f64], acting: &Acting) -> Option<BarForces> {
        let load = BarLoad::of(acting, &self.axes, self.area);
        Some(load.forces_along(self.end_forces(u, &load), self.axes.length))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bar_load::Span;
    use super::*;

    fn truss(end: [f64; 2], axial: f64) -> Truss {
        let material = Material { youngs_modulus: axial, poisson_ratio: 0.0, density: 0.0, expansion: 0.0 };
        Truss::in_plane([[0.0; 2], end], &material, 1.0).unwrap()
    }

    fn uniform(truss: &Truss, q: [f64; 2]) -> BarLoad {
        let q = truss.axes.to_local([q[0], q[1], 0.0]);
        BarLoad { spans: vec![Span { range: [0.0, truss.axes.length], force: [q, q] }], ..BarLoad::default() }
    }

    /// A hanging bar: q along the axis, free end at the end: N = qL at the start, 0 at the end.
    #[test]
    fn own_weight_of_a_hanging_bar() {
        let (axial, q) = (100.0, [0.0, -4.0]);
        let truss = truss([0.0, -3.0], axial);
        // u of the free end: (qL/2) / (EA/L), consistent nodal force.
        let u_end = -(4.0 * 3.0 / 2.0) / (axial / 3.0);
        let [start, end] = truss.end_forces(&[0.0, 0.0, 0.0, u_end], &uniform(&truss, q));
        assert!((start[0] - 12.0).abs() < 1e-13);
        assert!(end[0].abs() < 1e-13);
    }

    /// Q = dM/dx with M = 0 at both ends of a simple beam under q < 0 (local y up): +|q|L/2, −|q|L/2.
    #[test]
    fn transverse_force_goes_to_the_nodes() {
        let truss = truss([3.0, 0.0], 1.0);
        let [start, end] = truss.end_forces(&[0.0; 4], &uniform(&truss, [0.0, -4.0]));
        for (found, right) in
            [start, end].iter().flatten().zip([0.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0, -6.0, 0.0, 0.0, 0.0, 0.0])
        {
            assert!((found - right).abs() < 1e-14);
        }
    }

    /// Held at both ends and heated: N = −EA ε₀.
    #[test]
    fn heat_presses_a_held_bar() {
        let load = BarLoad { strain: 0.002, ..BarLoad::default() };
        let [start, end] = truss([1.8, 2.4], 50.0).end_forces(&[0.0; 4], &load);
        assert!((start[0] + 0.1).abs() < 1e-15 && (end[0] + 0.1).abs() < 1e-15);
    }
    /// In space: N = EA u·e/L, the force across the bar is carried to the ends in both planes, and k u is what the ends
    /// need.
    #[test]
    fn in_space() {
        let material = Material { youngs_modulus: 70.0, poisson_ratio: 0.0, density: 0.0, expansion: 0.0 };
        let ends = [[0.5, 1.0, -1.0], [1.5, 3.0, 1.0]];
        let truss = Truss::in_space(ends, None, &material, 2.0).unwrap();
        let e = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
        let u = [0.1, -0.2, 0.05, 0.03, 0.3, -0.1];
        let stretch: f64 = (0..3).map(|c| e[c] * (u[3 + c] - u[c])).sum();
        let n = 140.0 / 3.0 * stretch;
        // 4 per length along global z: 4 · 2/3 of it along the bar, the rest along local y; local z is level.
        let q = [0.0, 0.0, 4.0];
        let mut load = BarLoad::default();
        load.spans.push(Span { range: [0.0, 3.0], force: [truss.axes.to_local(q); 2] });
        let [start, end] = truss.end_forces(&u, &load);
        let across = 4.0 * (1.0 - 4.0_f64 / 9.0).sqrt();
        let right = [n + 4.0, 1.5 * -across, 0.0, 0.0, 0.0, 0.0];
        for i in 0..6 {
            assert!((start[i] - right[i]).abs() < 1e-14, "{start:?} {right:?}");
        }
        assert!((end[0] - (n - 4.0)).abs() < 1e-14 && (end[1] - 1.5 * across).abs() < 1e-14);
        let k = truss.stiffness().unwrap();
        for row in 0..6 {
            let force: f64 = (0..6).map(|j| k[(row, j)] * u[j]).sum();
            let sign = if row < 3 { -1.0 } else { 1.0 };
            assert!((force - sign * n * e[row % 3]).abs() < 1e-13);
        }
    }
}
