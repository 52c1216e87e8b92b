//! Two-node frame element in space: a [`Beam`] in the local x–y plane, one in x–z and a shaft, turned into place.
//!
//! ```text
//!     T = (GJ/L) (r_x2 − r_x1)        St Venant's torsion; shear centre and centroid at one place
//! ```

use nalgebra::{DMatrix, SMatrix, SVector};

use super::super::acting::Acting;
use super::super::bar_load::{BarForces, BarLoad, Bending, Internal};
use super::super::beam::Beam;
use super::super::finite_element::{FiniteElement, Stiffness};
use super::super::frame::ZERO;
use crate::doubled::{Doubled, Real};
use crate::model::bar_axes::{AxesFault, BarAxes};
use crate::model::space_section::{EndJoint, SpaceSection};
use crate::model::structure::Material;

type Matrix12<T = f64> = SMatrix<T, 12, 12>;
type Vector12 = SVector<f64, 12>;

/// A frame element in space. Inside it has twelve rows, u_x, u_y, u_z, r_x, r_y, r_z of the start, then of the end;
/// outside, an end that is a ball joint has no rotations.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceFrame {
    /// Places of start and end.
    ends: [[f64; 3]; 2],
    orientation: Option<[f64; 3]>,
    axes: BarAxes,
    /// In x–y, with EA; in x–z, without.
    beams: [Beam; 2],
    /// GJ.
    torsion: f64,
    area: f64,
    joints: [EndJoint; 2],
}

/// The rows of the twelve that a beam's rows u, v, θ of both ends are, with the sign of each: θ in x–z is −r_y.
const ROWS: [[(usize, f64); 6]; 2] = [
    [(0, 1.0), (1, 1.0), (5, 1.0), (6, 1.0), (7, 1.0), (11, 1.0)],
    [(0, 1.0), (2, 1.0), (4, -1.0), (6, 1.0), (8, 1.0), (10, -1.0)],
];

impl SpaceFrame {
    /// From this section, its local axes by [`BarAxes::in_space`].
    ///
    /// # Errors
    /// See [`AxesFault`].
    pub fn new(
        ends: [[f64; 3]; 2],
        orientation: Option<[f64; 3]>,
        material: &Material,
        section: &SpaceSection,
        joints: [EndJoint; 2],
    ) -> Result<SpaceFrame, AxesFault> {
        let (e, g) = (material.youngs_modulus, material.shear_modulus());
        let hinges = joints.map(|joint| joint != EndJoint::Rigid);
        let beam = |plane, axial, inertia, shear_area: Option<f64>| Beam {
            plane,
            axial,
            bending: e * inertia,
            shear: shear_area.map(|area| g * area),
            hinges,
        };
        Ok(SpaceFrame {
            ends,
            orientation,
            axes: BarAxes::in_space(ends, orientation)?,
            beams: [
                beam(Bending::Xy, e * section.area, section.inertia_z, section.shear_area_y),
                beam(Bending::Xz, 0.0, section.inertia_y, section.shear_area_z),
            ],
            torsion: g * section.torsion,
            area: section.area,
            joints,
        })
    }

    /// The rows that are left outside.
    fn rows(&self) -> Vec<usize> {
        (0..12).filter(|row| row % 6 < 3 || self.joints[row / 6] != EndJoint::Ball).collect()
    }

    /// All twelve displacements, those of the rows that are left out 0.
    fn with_left_out(&self, u: &[f64]) -> Vector12 {
        let mut all = Vector12::zeros();
        self.rows().into_iter().zip(u).for_each(|(row, u)| all[row] = *u);
        all
    }

    fn stiffness_in<T: Real>(&self) -> Result<Stiffness<T>, AxesFault> {
        let k = self.global_stiffness(&BarAxes::<T>::in_space(self.ends, self.orientation)?);
        let rows = self.rows();
        Ok(DMatrix::from_fn(rows.len(), rows.len(), |i, j| k[(rows[i], rows[j])]))
    }

    /// Stiffness in global axes, with rows of zeros where rotations are left out.
    fn global_stiffness<T: Real>(&self, axes: &BarAxes<T>) -> Matrix12<T> {
        let t = rotation(axes);
        let k = t.transpose() * self.local_stiffness(axes.length) * t;
        (k + k.transpose()) * T::from(0.5)
    }

    /// Stiffness in bar axes.
    fn local_stiffness<T: Real>(&self, length: T) -> Matrix12<T> {
        let mut k = Matrix12::zeros();
        for (beam, rows) in self.beams.iter().zip(ROWS) {
            let of_beam = beam.stiffness(length);
            for (i, (row, a)) in rows.into_iter().enumerate() {
                for (j, (column, b)) in rows.into_iter().enumerate() {
                    k[(row, column)] += of_beam[(i, j)] * T::from(a * b);
                }
            }
        }
        if !self.joints.contains(&EndJoint::Ball) {
            let gj = T::from(self.torsion) / length;
            (k[(3, 3)], k[(3, 9)], k[(9, 3)], k[(9, 9)]) = (gj, -gj, -gj, gj);
        }
        k
    }

    /// Forces at the ends in bar axes that stand for the load between them. Torques go to the ends that take them; no
    /// reader lets one through on a bar with two ball joints.
    fn local_forces(&self, load: &BarLoad) -> Vector12 {
        let length = self.axes.length;
        let mut f = Vector12::zeros();
        for (beam, rows) in self.beams.iter().zip(ROWS) {
            let of_beam = beam.forces(load, length);
            for (i, (row, sign)) in rows.into_iter().enumerate() {
                // What pulls along the bar counts once.
                if beam.plane == Bending::Xy || i % 3 != 0 {
                    f[row] += sign * of_beam[i];
                }
            }
        }
        let torque = |share: &dyn Fn(f64) -> f64| load.work(&|s| [0.0, 0.0, 0.0, share(s), 0.0, 0.0]);
        let is_ball = self.joints.map(|joint| joint == EndJoint::Ball);
        if !is_ball[0] {
            f[3] = torque(&|s| if is_ball[1] { 1.0 } else { 1.0 - s / length });
        }
        if !is_ball[1] {
            f[9] = torque(&|s| if is_ball[0] { 1.0 } else { s / length });
        }
        f
    }

    /// Internal forces at the start and at the end for global displacements `u` of its twelve rows (those that are left
    /// out are ignored) and the load between the nodes. What is no more than rounding of the terms of a force is 0.
    fn end_forces(&self, u: &Vector12, load: &BarLoad) -> [Internal; 2] {
        let (stiffness, loads) = (self.local_stiffness(self.axes.length), self.local_forces(load));
        let mut f = stiffness * (rotation(&self.axes) * u) - loads;
        // All components of a displacement, or of a rotation, are as well known as the largest one.
        let sizes = Vector12::from_fn(|i, _| (0..3).map(|c| u[i - i % 3 + c].abs()).sum());
        let terms = stiffness.abs() * sizes + loads.abs();
        f.zip_apply(&terms, |f, terms| *f = if f.abs() <= ZERO * terms { 0.0 } else { *f });
        [[-f[0], f[1], -f[5], f[2], f[4], -f[3]], [f[6], -f[7], f[11], -f[8], -f[10], f[9]]]
    }
}

impl FiniteElement for SpaceFrame {
    fn stiffness(&self) -> Result<Stiffness, &'static str> {
        self.stiffness_in().map_err(AxesFault::words)
    }

    fn doubled_stiffness(&self) -> Result<Stiffness<Doubled>, &'static str> {
        self.stiffness_in().map_err(AxesFault::words)
    }

    fn nodal_forces(&self, acting: &Acting) -> Vec<f64> {
        let load = BarLoad::of(acting, &self.axes, self.area);
        let f = rotation(&self.axes).transpose() * self.local_forces(&load);
        self.rows().into_iter().map(|row| f[row]).collect()
    }

    fn strain_energy(&self, u: &[f64], acting: &Acting) -> f64 {
        let [y, z] = &self.beams;
        let [shear_y, shear_z] = [y, z].map(|beam| beam.shear.unwrap_or(f64::INFINITY));
        let stiffnesses = [y.axial, shear_y, y.bending, shear_z, z.bending, self.torsion];
        self.bar_forces(u, acting).map_or(0.0, |forces| forces.strain_energy(&stiffnesses))
    }

    fn bar_forces(&self, u: &[f64], acting: &Acting) -> Option<BarForces> {
        let load = BarLoad::of(acting, &self.axes, self.area);
        Some(load.forces_along(self.end_forces(&self.with_left_out(u), &load), self.axes.length))
    }

    fn elastic_curve(&self, u: &[f64], acting: &Acting, shares: &[f64]) -> Option<Vec<[f64; 3]>> {
        let load = BarLoad::of(acting, &self.axes, self.area);
        let all = self.with_left_out(u);
        let forces = load.forces_along(self.end_forces(&all, &load), self.axes.length);
        forces.pieces.first()?; // there is none where the length is not a number
        let local = rotation(&self.axes) * all;
        let places: Vec<f64> = shares.iter().map(|share| share * self.axes.length).collect();
        let [y, z] = [(0, 1), (1, 2)].map(|(beam, row): (usize, usize)| {
            self.beams[beam].curve(&load, &forces, [local[0], local[row]], local[6 + row], &places)
        });
        // what pulls along the bar belongs to the first
        let across = z.into_iter().map(|[_, w]| w);
        Some(y.into_iter().zip(across).map(|([u, v], w)| self.axes.to_global([u, v, w])).collect())
    }
}

/// Global to bar axes.
fn rotation<T: Real>(axes: &BarAxes<T>) -> Matrix12<T> {
    let mut t = Matrix12::zeros();
    for o in [0, 3, 6, 9] {
        for c in 0..3 {
            t[(o, o + c)] = axes.x[c];
            t[(o + 1, o + c)] = axes.y[c];
            t[(o + 2, o + c)] = axes.z[c];
        }
    }
    t
}

#[cfg(test)]
mod tests;
