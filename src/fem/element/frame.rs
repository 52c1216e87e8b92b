//! Two-node Euler–Bernoulli frame element with moment hinges.
//!
//! ```text
//!            EA/L on (u1, u2);      with a = 12EI/L³, b = 6EI/L², c = 4EI/L, d = 2EI/L
//!
//!         v1  θ1  v2  θ2
//!     [   a   b  −a   b ]           local x from start to end, local y = x turned +90°,
//!     [   b   c  −b   d ]           θ counter-clockwise
//!     [  −a  −b   a  −b ]
//!     [   b   d  −b   c ]
//! ```
//!
//! A hinge releases the element's own rotation at that end, which is condensed out:
//! k ← k − k_r k_rᵀ / k_rr, f ← f − k_r f_r / k_rr (Przemieniecki, *Theory of Matrix Structural Analysis*,
//! 1968, ch. 5 and 6). Its row and column are then zero.

use nalgebra::{SMatrix, SVector};

use super::Axis;

type Matrix6 = SMatrix<f64, 6, 6>;
type Vector6 = SVector<f64, 6>;

/// Stiffness in global axes, rows u_x, u_y, θ of the start, then of the end.
pub fn stiffness(axis: &Axis, e: f64, area: f64, inertia: f64, hinges: [bool; 2]) -> Matrix6 {
    let k = local_stiffness(axis.length, e, area, inertia, hinges);
    let t = rotation(axis);
    let k = t.transpose() * k * t;
    (k + k.transpose()) * 0.5
}

/// Stiffness in bar axes.
fn local_stiffness(length: f64, e: f64, area: f64, inertia: f64, hinges: [bool; 2]) -> Matrix6 {
    let ea = e * area / length;
    let ei = e * inertia;
    let a = 12.0 * ei / length.powi(3);
    let b = 6.0 * ei / length.powi(2);
    let c = 4.0 * ei / length;
    let d = 2.0 * ei / length;
    #[rustfmt::skip]
    let full = Matrix6::from_row_slice(&[
         ea, 0.0, 0.0, -ea, 0.0, 0.0,
        0.0,   a,   b, 0.0,  -a,   b,
        0.0,   b,   c, 0.0,  -b,   d,
        -ea, 0.0, 0.0,  ea, 0.0, 0.0,
        0.0,  -a,  -b, 0.0,   a,  -b,
        0.0,   b,   d, 0.0,  -b,   c,
    ]);
    // The closed forms of the condensed matrices, so that zeros are exact zeros.
    let a3 = 3.0 * ei / length.powi(3);
    let b3 = 3.0 * ei / length.powi(2);
    let c3 = 3.0 * ei / length;
    let bending: Option<[(usize, f64); 4]> = match hinges {
        [false, false] => return full,
        // M = c3·(θ − chord rotation) at the end that is not released.
        [true, false] => Some([(1, a3), (2, 0.0), (4, -a3), (5, b3)]),
        [false, true] => Some([(1, a3), (2, b3), (4, -a3), (5, 0.0)]),
        [true, true] => None,
    };
    let mut k = Matrix6::zeros();
    for (i, j, sign) in [(0, 0, 1.0), (3, 3, 1.0), (0, 3, -1.0), (3, 0, -1.0)] {
        k[(i, j)] = sign * ea;
    }
    if let Some(shear) = bending {
        // Row v1 is `shear`; row v2 its negative; the rotation that is left: b3·(v1 − v2) + c3·θ.
        for (j, value) in shear {
            k[(1, j)] = value;
            k[(4, j)] = -value;
        }
        let r = if hinges[0] { 5 } else { 2 };
        k[(r, 1)] = b3;
        k[(r, 4)] = -b3;
        k[(r, r)] = c3;
    }
    k
}

/// Nodal forces in global axes that stand for a uniform global force `q` per unit length.
pub fn line_load(axis: &Axis, hinges: [bool; 2], q: [f64; 2]) -> Vector6 {
    rotation(axis).transpose() * local_line_load(axis, hinges, q)
}

/// The same in bar axes: qL/2 and ± qL²/12; with a hinge 3/8, 5/8 of qL and qL²/8 at the other end.
fn local_line_load(axis: &Axis, hinges: [bool; 2], q: [f64; 2]) -> Vector6 {
    let length = axis.length;
    let [qx, qy] = axis.to_local(q);
    let (total, axial) = (qy * length, 0.5 * qx * length);
    let (v1, m1, v2, m2) = match hinges {
        [false, false] => (0.5, 1.0 / 12.0, 0.5, -1.0 / 12.0),
        [true, false] => (0.375, 0.0, 0.625, -0.125),
        [false, true] => (0.625, 0.125, 0.375, 0.0),
        [true, true] => (0.5, 0.0, 0.5, 0.0),
    };
    Vector6::from([axial, v1 * total, m1 * total * length, axial, v2 * total, m2 * total * length])
}

/// Internal forces (N, Q, M) at the start and at the end, bar axes, for global displacements `u` (the released
/// rotations are ignored) and the uniform global force `q` on the element.
///
/// N > 0 tension, Q = dM/dx, M > 0 tension on the −y side: with f the forces on the element's ends,
/// start (−f_x1, f_y1, −m_1), end (f_x2, −f_y2, m_2).
pub fn end_forces(
    axis: &Axis,
    e: f64,
    area: f64,
    inertia: f64,
    hinges: [bool; 2],
    u: &[f64; 6],
    q: [f64; 2],
) -> [[f64; 3]; 2] {
    let local = rotation(axis) * Vector6::from(*u);
    let f = local_stiffness(axis.length, e, area, inertia, hinges) * local - local_line_load(axis, hinges, q);
    [[-f[0], f[1], -f[2]], [f[3], -f[4], f[5]]]
}

/// Global to bar axes.
fn rotation(axis: &Axis) -> Matrix6 {
    let mut t = Matrix6::zeros();
    for o in [0, 3] {
        t[(o, o)] = axis.cos;
        t[(o, o + 1)] = axis.sin;
        t[(o + 1, o)] = -axis.sin;
        t[(o + 1, o + 1)] = axis.cos;
        t[(o + 2, o + 2)] = 1.0;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXIS: Axis = Axis { length: 2.5, cos: 0.6, sin: 0.8 };

    /// The closed forms against k − k_r k_rᵀ / k_rr worked out from the full matrix.
    #[test]
    fn hinges_are_condensed_rotations() {
        let full = local_stiffness(2.5, 7.0, 3.0, 2.0, [false; 2]);
        let q = [0.3, -1.7];
        for hinges in [[true, false], [false, true], [true, true]] {
            let mut k = full;
            let mut f = local_line_load(&AXIS, [false; 2], q);
            for (r, released) in [(2, hinges[0]), (5, hinges[1])] {
                if released {
                    let column: Vector6 = k.column(r).into();
                    let pivot = k[(r, r)];
                    f -= column * (f[r] / pivot);
                    k -= column * column.transpose() / pivot;
                }
            }
            let closed = local_stiffness(2.5, 7.0, 3.0, 2.0, hinges);
            assert!((closed - k).amax() < 1e-13 * full.amax(), "{hinges:?}");
            let closed = local_line_load(&AXIS, hinges, q);
            assert!((closed - f).amax() < 1e-13, "{hinges:?}");
        }
    }

    #[test]
    fn rigid_motions_cost_nothing() {
        for hinges in [[false; 2], [true, false], [false, true], [true, true]] {
            let k = stiffness(&AXIS, 7.0, 3.0, 2.0, hinges);
            // Rotation by 1 about the start: the end moves by (−L sin, L cos).
            let turn = Vector6::from([0.0, 0.0, 1.0, -2.5 * 0.8, 2.5 * 0.6, 1.0]);
            let shift = Vector6::from([0.3, -0.4, 0.0, 0.3, -0.4, 0.0]);
            assert!((k * turn).amax() < 1e-13 * k.amax());
            assert!((k * shift).amax() < 1e-13 * k.amax());
        }
    }
}
