//! Two-node bar that carries axial force only: k = (EA/L) (e, −e)(e, −e)ᵀ with e its unit vector.

use nalgebra::{SMatrix, SVector};

use super::Axis;

type Matrix4 = SMatrix<f64, 4, 4>;
type Vector4 = SVector<f64, 4>;

/// Stiffness in global axes, rows u_x, u_y of the start, then of the end.
pub fn stiffness(axis: &Axis, e: f64, area: f64) -> Matrix4 {
    let d = Vector4::from([-axis.cos, -axis.sin, axis.cos, axis.sin]);
    d * d.transpose() * (e * area / axis.length)
}

/// Nodal forces that stand for a uniform global force `q` per unit length: half of it to each node.
pub fn line_load(axis: &Axis, q: [f64; 2]) -> Vector4 {
    let half = 0.5 * axis.length;
    Vector4::from([q[0], q[1], q[0], q[1]]) * half
}

/// Internal forces (N, Q, M) at the start and at the end, bar axes, for global displacements `u` and the uniform
/// global force `q`: N = EA ε ∓ q_x L/2; a transverse force is carried to the nodes as by a simple beam.
pub fn end_forces(axis: &Axis, e: f64, area: f64, u: &[f64; 4], q: [f64; 2]) -> [[f64; 3]; 2] {
    let [start, end] = [[u[0], u[1]], [u[2], u[3]]].map(|v| axis.to_local(v));
    let n = e * area / axis.length * (end[0] - start[0]);
    let [qx, qy] = axis.to_local(q).map(|q| 0.5 * q * axis.length);
    [[n + qx, -qy, 0.0], [n - qx, qy, 0.0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hanging bar: q along the axis, free end at the end: N = qL at the start, 0 at the end.
    #[test]
    fn own_weight_of_a_hanging_bar() {
        let axis = Axis { length: 3.0, cos: 0.0, sin: -1.0 };
        let (e, area, q) = (200.0, 0.5, [0.0, -4.0]);
        // u of the free end: (qL/2) / (EA/L), consistent nodal force.
        let u_end = -(4.0 * 3.0 / 2.0) / (e * area / 3.0);
        let [start, end] = end_forces(&axis, e, area, &[0.0, 0.0, 0.0, u_end], q);
        assert!((start[0] - 12.0).abs() < 1e-13);
        assert!(end[0].abs() < 1e-13);
    }

    /// Q = dM/dx with M = 0 at both ends of a simple beam under q < 0 (local y up): +|q|L/2, −|q|L/2.
    #[test]
    fn transverse_force_goes_to_the_nodes() {
        let axis = Axis { length: 3.0, cos: 1.0, sin: 0.0 };
        let [start, end] = end_forces(&axis, 1.0, 1.0, &[0.0; 4], [0.0, -4.0]);
        assert_eq!(start, [0.0, 6.0, 0.0]);
        assert_eq!(end, [0.0, -6.0, 0.0]);
    }
}
