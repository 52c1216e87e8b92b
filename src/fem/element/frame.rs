//! Two-node frame element of the plane: a [`Beam`] turned into place.

use nalgebra::DMatrix;

use super::acting::Acting;
use super::bar_load::{BarForces, BarLoad, Bending, Internal};
use super::beam::{Beam, Matrix6, Vector6};
use super::finite_element::{FiniteElement, NO_LENGTH, Stiffness};
use crate::doubled::{Doubled, Real};
use crate::model::bar_axes::BarAxes;
use crate::model::structure::Material;

/// A sum below this multiple of the magnitudes of its terms is zero.
pub const ZERO: f64 = 16.0 * f64::EPSILON;

/// A frame element. Inside it has six rows, u_x, u_y, θ of the start, then of the end; outside, a released rotation has
/// none.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Places of start and end.
    ends: [[f64; 2]; 2],
    axes: BarAxes,
    beam: Beam,
    area: f64,
}

impl Frame {
    /// From a section with this area, inertia and perhaps shear area; `None` if its ends coincide.
    pub fn new(
        ends: [[f64; 2]; 2],
        material: &Material,
        [area, inertia]: [f64; 2],
        shear_area: Option<f64>,
        hinges: [bool; 2],
    ) -> Option<Frame> {
        let e = material.youngs_modulus;
        let beam = Beam {
            plane: Bending::Xy,
            axial: e * area,
            bending: e * inertia,
            shear: shear_area.map(|area| material.shear_modulus() * area),
            hinges,
        };
        Some(Frame { ends, axes: BarAxes::in_plane(ends)?, beam, area })
    }

    /// The rows that are left outside.
    fn rows(&self) -> impl Iterator<Item = usize> {
        let hinges = self.beam.hinges;
        (0..6).filter(move |row| row % 3 != 2 || !hinges[row / 3])
    }

    /// All six displacements, those of the released rotations 0.
    fn with_released(&self, u: &[f64]) -> [f64; 6] {
        let mut all = [0.0; 6];
        self.rows().zip(u).for_each(|(row, u)| all[row] = *u);
        all
    }

    fn stiffness_in<T: Real>(&self) -> Option<Stiffness<T>> {
        let k = self.global_stiffness(&BarAxes::<T>::in_plane(self.ends)?);
        let rows: Vec<usize> = self.rows().collect();
        Some(DMatrix::from_fn(rows.len(), rows.len(), |i, j| k[(rows[i], rows[j])]))
    }

    /// Stiffness in global axes, with rows of zeros where rotations are released.
    fn global_stiffness<T: Real>(&self, axes: &BarAxes<T>) -> Matrix6<T> {
        let t = rotation(axes);
        let k = t.transpose() * self.beam.stiffness(axes.length) * t;
        (k + k.transpose()) * T::from(0.5)
    }

    /// Internal forces at the start and at the end for global displacements `u` (the released rotations are ignored)
    /// and the load between the nodes.
    ///
    /// With f the forces on the element's ends, start (−f_x1, f_y1, −m_1), end (f_x2, −f_y2, m_2). What is no more than
    /// rounding of the terms of a force is 0.
    pub fn end_forces(&self, u: &[f64; 6], load: &BarLoad) -> [Internal; 2] {
        let length = self.axes.length;
        let local = rotation(&self.axes) * Vector6::from(*u);
        let (stiffness, loads) = (self.beam.stiffness(length), self.beam.forces(load, length));
        let mut f = stiffness * local - loads;
        // Both components of a displacement are as well known as the larger one.
        let sizes = Vector6::from_fn(|i, _| match i % 3 {
            2 => u[i].abs(),
            _ => u[i - i % 3].abs() + u[i - i % 3 + 1].abs(),
        });
        let terms = stiffness.abs() * sizes + loads.abs();
        f.zip_apply(&terms, |f, terms| *f = if f.abs() <= ZERO * terms { 0.0 } else { *f });
        [[-f[0], f[1], -f[2], 0.0, 0.0, 0.0], [f[3], -f[4], f[5], 0.0, 0.0, 0.0]]
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
        let load = BarLoad::of(acting, &self.axes, self.area);
        let f = rotation(&self.axes).transpose() * self.beam.forces(&load, self.axes.length);
        self.rows().map(|row| f[row]).collect()
    }

    fn strain_energy(&self, u: &[f64], acting: &Acting) -> f64 {
        let Beam { axial, bending, shear, .. } = self.beam;
        let none = f64::INFINITY;
        let stiffnesses = [axial, shear.unwrap_or(none), bending, none, none, none];
        self.bar_forces(u, acting).map_or(0.0, |forces| forces.strain_energy(&stiffnesses))
    }

    fn bar_forces(&self, u: &[f64], acting: &Acting) -> Option<BarForces> {
        let load = BarLoad::of(acting, &self.axes, self.area);
        Some(load.forces_along(self.end_forces(&self.with_released(u), &load), self.axes.length))
    }

    fn elastic_curve(&self, u: &[f64], acting: &Acting, shares: &[f64]) -> Option<Vec<[f64; 3]>> {
        let load = BarLoad::of(acting, &self.axes, self.area);
        let all = self.with_released(u);
        let forces = load.forces_along(self.end_forces(&all, &load), self.axes.length);
        forces.pieces.first()?; // there is none where the length is not a number
        let local = rotation(&self.axes) * Vector6::from(all);
        let places: Vec<f64> = shares.iter().map(|share| share * self.axes.length).collect();
        let curve = self.beam.curve(&load, &forces, [local[0], local[1]], local[4], &places);
        Some(curve.into_iter().map(|[u, v]| self.axes.to_global([u, v, 0.0])).collect())
    }
}

/// Global to bar axes.
fn rotation<T: Real>(axes: &BarAxes<T>) -> Matrix6<T> {
    let mut t = Matrix6::zeros();
    for o in [0, 3] {
        for c in 0..2 {
            t[(o, o + c)] = axes.x[c];
            t[(o + 1, o + c)] = axes.y[c];
        }
        t[(o + 2, o + 2)] = T::one();
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar from the origin to `end` with the EA and EI of `section`, and G A_s.
    fn flexible(end: [f64; 2], section: [f64; 2], shear: Option<f64>) -> Frame {
        let material = Material { youngs_modulus: 1.0, poisson_ratio: 0.0, density: 0.0, expansion: 0.0 };
        let mut frame = Frame::new([[0.0; 2], end], &material, section, None, [false; 2]).unwrap();
        frame.beam.shear = shear;
        frame
    }

    /// Free axial strain and curvature: u = ε₀ x, v = κ₀ x²/2 leaves no internal force.
    #[test]
    fn free_deformation_makes_no_force() {
        let load = BarLoad { strain: 0.01, curvature: [0.03, 0.0], ..BarLoad::default() };
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
        for hinges in [[false; 2], [true, false], [false, true], [true, true]] {
            let mut frame = flexible([1.5, 2.0], [21.0, 14.0], Some(5.0));
            frame.beam.hinges = hinges;
            let k = frame.global_stiffness(&frame.axes);
            // Rotation by 1 about the start: the end moves by (−L sin, L cos).
            let turn = Vector6::from([0.0, 0.0, 1.0, -2.5 * 0.8, 2.5 * 0.6, 1.0]);
            let shift = Vector6::from([0.3, -0.4, 0.0, 0.3, -0.4, 0.0]);
            assert!((k * turn).amax() < 1e-13 * k.amax());
            assert!((k * shift).amax() < 1e-13 * k.amax());
        }
    }
}
