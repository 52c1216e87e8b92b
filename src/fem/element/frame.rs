//! Two-node frame element, shear-flexible where its section has a shear area, with moment hinges.
//!
//! ```text
//!            EA/L on (u1, u2);      with Φ = 12EI/(G A_s L²), 0 without a shear area (Euler–Bernoulli)
//!            a = 12EI/L³(1+Φ), b = 6EI/L²(1+Φ), c = (4+Φ)EI/L(1+Φ), d = (2−Φ)EI/L(1+Φ)
//!
//!         v1  θ1  v2  θ2
//!     [   a   b  −a   b ]           local x from start to end, local y = x turned +90°,
//!     [   b   c  −b   d ]           θ counter-clockwise
//!     [  −a  −b   a  −b ]
//!     [   b   d  −b   c ]
//! ```
//!
//! A hinge releases the element's own rotation at that end, which is condensed out:
//! k ← k − k_r k_rᵀ / k_rr, f ← f − k_r f_r / k_rr. Its row and column are then zero. Loads between the nodes become
//! nodal forces by the exact displacements of the unloaded element, so that nodes move as in beam theory
//! (Przemieniecki, *Theory of Matrix Structural Analysis*, 1968, ch. 5 and 6).

use nalgebra::{DMatrix, SMatrix, SVector};

use super::axis::Axis;
use super::bar_load::{BarForces, BarLoad, Internal};
use super::{Acting, FiniteElement, NO_LENGTH, Stiffness};
use crate::doubled::{Doubled, Real};
use crate::model::structure::Material;

/// A sum below this multiple of the magnitudes of its terms is zero.
const ZERO: f64 = 16.0 * f64::EPSILON;

type Matrix6<T = f64> = SMatrix<T, 6, 6>;
type Vector6 = SVector<f64, 6>;

/// A frame element. Inside it has six rows, u_x, u_y, θ of the start, then of the end; outside, a released rotation has
/// none.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Places of start and end.
    ends: [[f64; 2]; 2],
    axis: Axis,
    /// EA.
    axial: f64,
    /// EI.
    bending: f64,
    /// G A_s; `None` for a bar that does not yield to shear.
    shear: Option<f64>,
    area: f64,
    /// Moment hinge at start, at end.
    hinges: [bool; 2],
}

impl Frame {
    /// Of a section with this area, inertia and perhaps shear area; `None` if its ends coincide.
    pub fn new(
        ends: [[f64; 2]; 2],
        material: &Material,
        [area, inertia]: [f64; 2],
        shear_area: Option<f64>,
        hinges: [bool; 2],
    ) -> Option<Frame> {
        let e = material.youngs_modulus;
        Some(Frame {
            ends,
            axis: Axis::between(ends)?,
            axial: e * area,
            bending: e * inertia,
            shear: shear_area.map(|area| e / (2.0 * (1.0 + material.poisson_ratio)) * area),
            area,
            hinges,
        })
    }

    /// The rows that are left outside.
    fn rows(&self) -> impl Iterator<Item = usize> {
        let hinges = self.hinges;
        (0..6).filter(move |row| row % 3 != 2 || !hinges[row / 3])
    }

    fn stiffness_in<T: Real>(&self) -> Option<Stiffness<T>> {
        let k = self.global_stiffness(&Axis::<T>::between(self.ends)?);
        let rows: Vec<usize> = self.rows().collect();
        Some(DMatrix::from_fn(rows.len(), rows.len(), |i, j| k[(rows[i], rows[j])]))
    }

    /// Stiffness in global axes, with rows of zeros where rotations are released.
    fn global_stiffness<T: Real>(&self, axis: &Axis<T>) -> Matrix6<T> {
        let t = rotation(axis);
        let k = t.transpose() * self.local_stiffness(axis.length) * t;
        (k + k.transpose()) * T::from(0.5)
    }

    /// Φ = 12EI/(G A_s L²).
    fn shear_number<T: Real>(&self, length: T) -> T {
        self.shear.map_or(T::zero(), |shear| T::from(12.0 * self.bending / shear) / (length * length))
    }

    /// Stiffness in bar axes without hinges.
    fn rigid_ended<T: Real>(&self, length: T) -> Matrix6<T> {
        let phi = self.shear_number(length);
        let (o, number) = (T::zero(), T::from);
        let ea = number(self.axial) / length;
        let c1 = number(self.bending) / (T::one() + phi) / length;
        let b1 = c1 / length;
        let a = number(12.0) * b1 / length;
        let b = number(6.0) * b1;
        let c = (number(4.0) + phi) * c1;
        let d = (number(2.0) - phi) * c1;
        #[rustfmt::skip]
        let full = Matrix6::from_row_slice(&[
             ea,  o,  o, -ea,  o,  o,
              o,  a,  b,   o, -a,  b,
              o,  b,  c,   o, -b,  d,
            -ea,  o,  o,  ea,  o,  o,
              o, -a, -b,   o,  a, -b,
              o,  b,  d,   o, -b,  c,
        ]);
        full
    }

    /// Stiffness in bar axes.
    fn local_stiffness<T: Real>(&self, length: T) -> Matrix6<T> {
        let ea = T::from(self.axial) / length;
        // The closed forms of the condensed matrices, so that zeros are exact zeros.
        let c3 = T::from(3.0 * self.bending) / (T::one() + T::from(0.25) * self.shear_number(length)) / length;
        let b3 = c3 / length;
        let a3 = b3 / length;
        let o = T::zero();
        let bending: Option<[(usize, T); 4]> = match self.hinges {
            [false, false] => return self.rigid_ended(length),
            // M = c3·(θ − chord rotation) at the end that is not released.
            [true, false] => Some([(1, a3), (2, o), (4, -a3), (5, b3)]),
            [false, true] => Some([(1, a3), (2, b3), (4, -a3), (5, o)]),
            [true, true] => None,
        };
        let mut k = Matrix6::zeros();
        for (i, j, value) in [(0, 0, ea), (3, 3, ea), (0, 3, -ea), (3, 0, -ea)] {
            k[(i, j)] = value;
        }
        if let Some(shear) = bending {
            // Row v1 is `shear`; row v2 its negative; the rotation that is left: b3·(v1 − v2) + c3·θ.
            for (j, value) in shear {
                k[(1, j)] = value;
                k[(4, j)] = -value;
            }
            let r = if self.hinges[0] { 5 } else { 2 };
            k[(r, 1)] = b3;
            k[(r, 4)] = -b3;
            k[(r, r)] = c3;
        }
        k
    }

    /// Displacements (along x, along y, rotation of the section) at a distance from the start when row `row` of the
    /// element without hinges is displaced by 1 and nothing acts between its nodes.
    fn shape(&self, row: usize, s: f64) -> [f64; 3] {
        let length = self.axis.length;
        let phi = self.shear_number(length);
        let x = s / length;
        let (x2, x3, over) = (x * x, x * x * x, 1.0 / (1.0 + phi));
        match row {
            0 => [1.0 - x, 0.0, 0.0],
            3 => [x, 0.0, 0.0],
            1 => [0.0, (1.0 - 3.0 * x2 + 2.0 * x3 + phi * (1.0 - x)) * over, 6.0 / length * (x2 - x) * over],
            4 => [0.0, (3.0 * x2 - 2.0 * x3 + phi * x) * over, 6.0 / length * (x - x2) * over],
            2 => [
                0.0,
                length * (x - 2.0 * x2 + x3 + 0.5 * phi * (x - x2)) * over,
                (1.0 - 4.0 * x + 3.0 * x2 + phi * (1.0 - x)) * over,
            ],
            _ => [0.0, length * (x3 - x2 - 0.5 * phi * (x - x2)) * over, (3.0 * x2 - 2.0 * x + phi * x) * over],
        }
    }

    /// Forces at the ends in bar axes that stand for the load between them.
    fn local_forces(&self, load: &BarLoad) -> Vector6 {
        let mut f = Vector6::from_fn(|row, _| load.work(&|s| self.shape(row, s)));
        let (normal, moment) = (self.axial * load.strain, self.bending * load.curvature);
        f += Vector6::from([-normal, 0.0, -moment, normal, 0.0, moment]);
        if self.hinges != [false; 2] {
            let mut k = self.rigid_ended(self.axis.length);
            for (r, _) in [(2, 0), (5, 1)].into_iter().filter(|(_, end)| self.hinges[*end]) {
                let column: Vector6 = k.column(r).into();
                f -= column * (f[r] / k[(r, r)]);
                f[r] = 0.0;
                k -= column * column.transpose() / column[r];
            }
        }
        f
    }

    /// Internal forces at the start and at the end for global displacements `u` (the released rotations are ignored)
    /// and the load between the nodes.
    ///
    /// N > 0 tension, Q = dM/dx, M > 0 tension on the −y side: with f the forces on the element's ends,
    /// start (−f_x1, f_y1, −m_1), end (f_x2, −f_y2, m_2). What is no more than rounding of the terms of a force is 0.
    fn end_forces(&self, u: &[f64; 6], load: &BarLoad) -> [Internal; 2] {
        let local = rotation(&self.axis) * Vector6::from(*u);
        let (stiffness, loads) = (self.local_stiffness(self.axis.length), self.local_forces(load));
        let mut f = stiffness * local - loads;
        // Both components of a displacement are as well known as the larger one.
        let sizes = Vector6::from_fn(|i, _| match i % 3 {
            2 => u[i].abs(),
            _ => u[i - i % 3].abs() + u[i - i % 3 + 1].abs(),
        });
        let terms = stiffness.abs() * sizes + loads.abs();
        f.zip_apply(&terms, |f, terms| *f = if f.abs() <= ZERO * terms { 0.0 } else { *f });
        [[-f[0], f[1], -f[2]], [f[3], -f[4], f[5]]]
    }
}

impl FiniteElement for Frame {
    fn stiffness(&self) -> Result<Stiffness, &'static str> {
        self.stiffness_in().ok_or(NO_LENGTH)
    }

    fn doubled_stiffness(&self) -> Result<Stiffness<Doubled>, &'static str> {
        self.stiffness_in().ok_or(NO_LENGTH)
    }

    fn nodal_forces(&self, acting: &Acting) -> Vec<f64> {
        let load = BarLoad::of(acting, &self.axis, self.area);
        let f = rotation(&self.axis).transpose() * self.local_forces(&load);
        self.rows().map(|row| f[row]).collect()
    }

    fn bar_forces(&self, u: &[f64], acting: &Acting) -> Option<BarForces> {
        let load = BarLoad::of(acting, &self.axis, self.area);
        let mut all = [0.0; 6];
        for (row, u) in self.rows().zip(u) {
            all[row] = *u;
        }
        Some(load.forces_along(self.end_forces(&all, &load), self.axis.length))
    }
}

/// Global to bar axes.
fn rotation<T: Real>(axis: &Axis<T>) -> Matrix6<T> {
    let mut t = Matrix6::zeros();
    for o in [0, 3] {
        t[(o, o)] = axis.cos;
        t[(o, o + 1)] = axis.sin;
        t[(o + 1, o)] = -axis.sin;
        t[(o + 1, o + 1)] = axis.cos;
        t[(o + 2, o + 2)] = T::one();
    }
    t
}

#[cfg(test)]
mod tests {
    use super::super::bar_load::{PointForce, Span};
    use super::*;

    /// cos 0.6, sin 0.8.
    const END: [f64; 2] = [1.5, 2.0];
    const LENGTH: f64 = 2.5;
    const HINGES: [[bool; 2]; 4] = [[false; 2], [true, false], [false, true], [true, true]];

    fn frame(hinges: [bool; 2], shear: Option<f64>) -> Frame {
        Frame { hinges, ..flexible(END, [21.0, 14.0], shear) }
    }

    /// With EA and EI, and G A_s.
    fn flexible(end: [f64; 2], section: [f64; 2], shear: Option<f64>) -> Frame {
        let material = Material { youngs_modulus: 1.0, poisson_ratio: 0.0, density: 0.0, expansion: 0.0 };
        let frame = Frame::new([[0.0; 2], end], &material, section, None, [false; 2]).unwrap();
        Frame { shear, ..frame }
    }

    fn uniform(q: [f64; 2]) -> BarLoad {
        BarLoad { spans: vec![Span { range: [0.0, LENGTH], force: [q, q] }], ..BarLoad::default() }
    }

    /// The closed forms against k − k_r k_rᵀ / k_rr worked out from the full matrix.
    #[test]
    fn hinges_are_condensed_rotations() {
        for shear in [None, Some(5.0)] {
            let full = frame([false; 2], shear).local_stiffness(LENGTH);
            for hinges in HINGES {
                let mut k = full;
                for (r, released) in [(2, hinges[0]), (5, hinges[1])] {
                    if released {
                        let column: Vector6 = k.column(r).into();
                        k -= column * column.transpose() / column[r];
                    }
                }
                let closed = frame(hinges, shear).local_stiffness(LENGTH);
                assert!((closed - k).amax() < 1e-13 * full.amax(), "{hinges:?}");
            }
        }
    }

    /// qL/2 and ± qL²/12; with a hinge 3/8, 5/8 of qL and qL²/8 at the other end.
    #[test]
    fn uniform_load() {
        let (qx, qy, l) = (0.3, -1.7, LENGTH);
        for (hinges, [v1, m1, v2, m2]) in HINGES.into_iter().zip([
            [0.5, 1.0 / 12.0, 0.5, -1.0 / 12.0],
            [0.375, 0.0, 0.625, -0.125],
            [0.625, 0.125, 0.375, 0.0],
            [0.5, 0.0, 0.5, 0.0],
        ]) {
            let f = frame(hinges, None).local_forces(&uniform([qx, qy]));
            let t = qy * l;
            let right = Vector6::from([0.5 * qx * l, v1 * t, m1 * t * l, 0.5 * qx * l, v2 * t, m2 * t * l]);
            assert!((f - right).amax() < 1e-14, "{hinges:?}: {f}");
        }
    }

    /// Fixed-end moments of a force P at a from the start, b from the end: P a b²/L², −P a² b/L² (Roark); of a triangle
    /// from 0 to w: wL²/30, −wL²/20; of a couple m: m b(2a − b)/L², m a(2b − a)/L².
    #[test]
    fn fixed_end_moments() {
        let l = LENGTH;
        let (a, p, w, m) = (0.8, 3.0, 2.0, 4.0);
        let b = l - a;
        let point = |force, moment| BarLoad { points: vec![PointForce { at: a, force, moment }], ..BarLoad::default() };
        let triangle =
            BarLoad { spans: vec![Span { range: [0.0, l], force: [[0.0, 0.0], [0.0, w]] }], ..BarLoad::default() };
        let cases = [
            (point([0.0, p], 0.0), [p * a * b * b / (l * l), -p * a * a * b / (l * l)]),
            (triangle, [w * l * l / 30.0, -w * l * l / 20.0]),
            (point([0.0, 0.0], m), [-m * b * (2.0 * a - b) / (l * l), -m * a * (2.0 * b - a) / (l * l)]),
        ];
        for (load, [start, end]) in cases {
            let f = frame([false; 2], None).local_forces(&load);
            assert!((f[2] - start).abs() < 1e-14 && (f[5] - end).abs() < 1e-14, "{load:?}: {f}");
        }
    }

    /// A part load is the difference of two that reach the end, and loads keep resultant and moment with any hinges
    /// and with shear: Σ f_y = P, Σ m + f_y2 L = P a.
    #[test]
    fn loads_keep_their_resultant() {
        let l = LENGTH;
        for shear in [None, Some(5.0)] {
            for hinges in HINGES {
                let load = BarLoad {
                    spans: vec![Span { range: [0.4, 1.9], force: [[0.5, 1.0], [-0.3, -2.5]] }],
                    points: vec![PointForce { at: 2.1, force: [0.7, -1.2], moment: 0.6 }],
                    ..BarLoad::default()
                };
                let f = frame(hinges, shear).local_forces(&load);
                // ∫ q_y = −0.75·1.5; its moment ∫ s q ds by Simpson, exact for a quadratic.
                let q = |s: f64| 1.0 + (s - 0.4) / 1.5 * -3.5;
                let first = 1.5 / 6.0 * (0.4 * q(0.4) + 4.0 * 1.15 * q(1.15) + 1.9 * q(1.9));
                let (force, moment) = (-0.75 * 1.5 - 1.2, first - 1.2 * 2.1 + 0.6);
                assert!((f[1] + f[4] - force).abs() < 1e-14, "{hinges:?}");
                assert!((f[2] + f[5] + f[4] * l - moment).abs() < 1e-13, "{hinges:?}");
                assert!((f[0] + f[3] - (0.1 * 1.5 + 0.7)).abs() < 1e-14);
            }
        }
    }

    /// Free axial strain and curvature: u = ε₀ x, v = κ₀ x²/2 leaves no internal force.
    #[test]
    fn free_deformation_makes_no_force() {
        let load = BarLoad { strain: 0.01, curvature: 0.03, ..BarLoad::default() };
        for shear in [None, Some(5.0)] {
            let frame = flexible([2.0, 0.0], [3.0, 7.0], shear);
            let ends = frame.end_forces(&[0.0, 0.0, 0.0, 0.02, 0.06, 0.06], &load);
            assert!(ends.iter().flatten().all(|value| value.abs() < 1e-14), "{ends:?}");
        }
    }

    /// Cantilever with a shear area under a tip force: v = PL³/3EI + PL/GA_s.
    #[test]
    fn shear_adds_its_share() {
        let k = flexible([2.0, 0.0], [3.0, 7.0], Some(5.0)).stiffness().unwrap();
        let v = 8.0 / 21.0 + 2.0 / 5.0;
        let theta = 4.0 / 14.0;
        let force = [k[(4, 4)] * v + k[(4, 5)] * theta, k[(5, 4)] * v + k[(5, 5)] * theta];
        assert!((force[0] - 1.0).abs() < 1e-13 && force[1].abs() < 1e-13, "{force:?}");
    }

    #[test]
    fn rigid_motions_cost_nothing() {
        for hinges in HINGES {
            let frame = frame(hinges, Some(5.0));
            let k = frame.global_stiffness(&frame.axis);
            // Rotation by 1 about the start: the end moves by (−L sin, L cos).
            let turn = Vector6::from([0.0, 0.0, 1.0, -2.5 * 0.8, 2.5 * 0.6, 1.0]);
            let shift = Vector6::from([0.3, -0.4, 0.0, 0.3, -0.4, 0.0]);
            assert!((k * turn).amax() < 1e-13 * k.amax());
            assert!((k * shift).amax() < 1e-13 * k.amax());
        }
    }
}
