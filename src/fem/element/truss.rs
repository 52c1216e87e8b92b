//! Two-node bar that carries axial force only: k = (EA/L) (e, −e)(e, −e)ᵀ with e its unit vector.
//!
//! Forces across it between its nodes are carried to the nodes as by a simple beam.

use nalgebra::{DMatrix, SMatrix, SVector};

use super::axis::Axis;
use super::bar_load::{BarForces, BarLoad, Internal};
use super::{Acting, FiniteElement, NO_LENGTH, Stiffness};
use crate::doubled::{Doubled, Real};
use crate::model::structure::Material;

type Matrix4<T = f64> = SMatrix<T, 4, 4>;
type Vector4<T = f64> = SVector<T, 4>;

/// A truss element; its rows are u_x, u_y of the start, then of the end.
pub struct Truss {
    /// Places of start and end.
    ends: [[f64; 2]; 2],
    axis: Axis,
    /// EA.
    axial: f64,
    area: f64,
}

impl Truss {
    /// `None` if its ends coincide.
    pub fn new(ends: [[f64; 2]; 2], material: &Material, area: f64) -> Option<Truss> {
        Some(Truss { ends, axis: Axis::between(ends)?, axial: material.youngs_modulus * area, area })
    }

    fn stiffness_in<T: Real>(&self) -> Option<Stiffness<T>> {
        let axis = Axis::<T>::between(self.ends)?;
        let d = Vector4::from([-axis.cos, -axis.sin, axis.cos, axis.sin]);
        let k: Matrix4<T> = d * d.transpose() * (T::from(self.axial) / axis.length);
        Some(DMatrix::from_column_slice(4, 4, k.as_slice()))
    }

    /// Forces at the ends in bar axes that stand for the load between them. A couple becomes two opposite forces.
    fn local_forces(&self, load: &BarLoad) -> [f64; 4] {
        let length = self.axis.length;
        let along = |end: bool, s: f64| if end { s / length } else { 1.0 - s / length };
        let turn = |end: bool| if end { 1.0 / length } else { -1.0 / length };
        let force = |end: bool| {
            let x = load.work(&|s| [along(end, s), 0.0, 0.0]);
            let y = load.work(&|s| [0.0, along(end, s), turn(end)]);
            [x, y]
        };
        let ([x1, y1], [x2, y2]) = (force(false), force(true));
        let free = self.axial * load.strain;
        [x1 - free, y1, x2 + free, y2]
    }

    /// Internal forces at the start and at the end for global displacements `u` and the load between the nodes; as a
    /// simple beam it has M = 0 at both ends.
    fn end_forces(&self, u: &[f64], load: &BarLoad) -> [Internal; 2] {
        let [start, end] = [[u[0], u[1]], [u[2], u[3]]].map(|v| self.axis.to_local(v));
        let n = self.axial / self.axis.length * (end[0] - start[0]);
        let [x1, y1, x2, y2] = self.local_forces(load);
        [[n + x1, -y1, 0.0], [n - x2, y2, 0.0]]
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
        let [a, b, c, d] = self.local_forces(&BarLoad::of(acting, &self.axis, self.area));
        [self.axis.to_global([a, b]), self.axis.to_global([c, d])].concat()
    }

    fn bar_forces(&self, u: &[f64], acting: &Acting) -> Option<BarForces> {
        let load = BarLoad::of(acting, &self.axis, self.area);
        Some(load.forces_along(self.end_forces(u, &load), self.axis.length))
    }
}

#[cfg(test)]
mod tests {
    use super::super::bar_load::Span;
    use super::*;

    fn truss(end: [f64; 2], axial: f64) -> Truss {
        let material = Material { youngs_modulus: axial, poisson_ratio: 0.0, density: 0.0, expansion: 0.0 };
        Truss::new([[0.0; 2], end], &material, 1.0).unwrap()
    }

    fn uniform(truss: &Truss, q: [f64; 2]) -> BarLoad {
        let q = truss.axis.to_local(q);
        BarLoad { spans: vec![Span { range: [0.0, truss.axis.length], force: [q, q] }], ..BarLoad::default() }
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
        for (found, right) in [start, end].iter().flatten().zip([0.0, 6.0, 0.0, 0.0, -6.0, 0.0]) {
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
}
