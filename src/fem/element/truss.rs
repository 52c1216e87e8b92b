//! Two-node bar that carries axial force only: k = (EA/L) (e, −e)(e, −e)ᵀ with e its unit vector.
//!
//! Forces across it between its nodes are carried to the nodes as by a simple beam.

use nalgebra::{SMatrix, SVector};

use super::Axis;
use super::bar_load::{BarLoad, Internal};
use crate::fem::doubled::Real;

type Matrix4<T = f64> = SMatrix<T, 4, 4>;
type Vector4<T = f64> = SVector<T, 4>;

/// Stiffness in global axes for EA, rows u_x, u_y of the start, then of the end.
pub fn stiffness<T: Real>(axis: &Axis<T>, axial: f64) -> Matrix4<T> {
    let d = Vector4::from([-axis.cos, -axis.sin, axis.cos, axis.sin]);
    d * d.transpose() * (T::from(axial) / axis.length)
}

/// Nodal forces in global axes that stand for the load between the nodes. A couple becomes two opposite forces.
pub fn nodal_forces(axis: &Axis, axial: f64, load: &BarLoad) -> Vector4 {
    let [a, b, c, d] = local_forces(axis, axial, load);
    let ([a, b], [c, d]) = (axis.to_global([a, b]), axis.to_global([c, d]));
    Vector4::from([a, b, c, d])
}

fn local_forces(axis: &Axis, axial: f64, load: &BarLoad) -> [f64; 4] {
    let length = axis.length;
    let along = |end: bool, s: f64| if end { s / length } else { 1.0 - s / length };
    let turn = |end: bool| if end { 1.0 / length } else { -1.0 / length };
    let force = |end: bool| {
        let x = load.work(&|s| [along(end, s), 0.0, 0.0]);
        let y = load.work(&|s| [0.0, along(end, s), turn(end)]);
        [x, y]
    };
    let ([x1, y1], [x2, y2]) = (force(false), force(true));
    let free = axial * load.strain;
    [x1 - free, y1, x2 + free, y2]
}

/// Internal forces at the start and at the end for global displacements `u` and the load between the nodes; as a
/// simple beam it has M = 0 at both ends.
pub fn end_forces(axis: &Axis, axial: f64, u: &[f64; 4], load: &BarLoad) -> [Internal; 2] {
    let [start, end] = [[u[0], u[1]], [u[2], u[3]]].map(|v| axis.to_local(v));
    let n = axial / axis.length * (end[0] - start[0]);
    let [x1, y1, x2, y2] = local_forces(axis, axial, load);
    [[n + x1, -y1, 0.0], [n - x2, y2, 0.0]]
}

#[cfg(test)]
mod tests {
    use super::super::bar_load::Span;
    use super::*;

    fn uniform(axis: &Axis, q: [f64; 2]) -> BarLoad {
        let q = axis.to_local(q);
        BarLoad { spans: vec![Span { range: [0.0, axis.length], force: [q, q] }], ..BarLoad::default() }
    }

    /// A hanging bar: q along the axis, free end at the end: N = qL at the start, 0 at the end.
    #[test]
    fn own_weight_of_a_hanging_bar() {
        let axis = Axis { length: 3.0, cos: 0.0, sin: -1.0 };
        let (axial, q) = (100.0, [0.0, -4.0]);
        // u of the free end: (qL/2) / (EA/L), consistent nodal force.
        let u_end = -(4.0 * 3.0 / 2.0) / (axial / 3.0);
        let [start, end] = end_forces(&axis, axial, &[0.0, 0.0, 0.0, u_end], &uniform(&axis, q));
        assert!((start[0] - 12.0).abs() < 1e-13);
        assert!(end[0].abs() < 1e-13);
    }

    /// Q = dM/dx with M = 0 at both ends of a simple beam under q < 0 (local y up): +|q|L/2, −|q|L/2.
    #[test]
    fn transverse_force_goes_to_the_nodes() {
        let axis = Axis { length: 3.0, cos: 1.0, sin: 0.0 };
        let [start, end] = end_forces(&axis, 1.0, &[0.0; 4], &uniform(&axis, [0.0, -4.0]));
        for (found, right) in [start, end].iter().flatten().zip([0.0, 6.0, 0.0, 0.0, -6.0, 0.0]) {
            assert!((found - right).abs() < 1e-14);
        }
    }

    /// Held at both ends and heated: N = −EA ε₀.
    #[test]
    fn heat_presses_a_held_bar() {
        let axis = Axis { length: 3.0, cos: 0.6, sin: 0.8 };
        let load = BarLoad { strain: 0.002, ..BarLoad::default() };
        let [start, end] = end_forces(&axis, 50.0, &[0.0; 4], &load);
        assert!((start[0] + 0.1).abs() < 1e-15 && (end[0] + 0.1).abs() < 1e-15);
    }
}
