//! The main system: every joint on. R, RF and the kernel of R; displacements for given loads and dislocations.
//!
//! ```text
//!     K_m v + C z = Tᵀ F,   λ = Cᵀ v + D z − Gᵀ F       (u = T v + G z, see `elimination`)
//!     R  = D − Cᵀ K_m⁻¹ C
//!     RF = Cᵀ K_m⁻¹ Tᵀ F − Gᵀ F
//! ```

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{DMatrix, DVector};

use super::assembly::{assemble, main_matrices, on_joints, on_masters};
use super::dof::Dofs;
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::factor::{Factor, FactorError};
use super::kernel::{self, RigidKernel};
use super::loads::load_vectors;
use super::loose::{Motion, loose_motions};
use super::order::Places;
use super::sparse::SymmetricSparse;
use crate::model::pair::Joint;
use crate::model::structure::{Component, Structure};
use crate::watch::Watch;

/// An eigenvector of R is a mechanism if its u has ‖K u‖ below this share of the terms it sums, both in equations
/// scaled to a unit diagonal (so that a soft part is no mechanism beside a stiff one).
const NO_FORCE: f64 = 1e-12;

/// The residual of equilibrium is measured against at least this share of the terms that K u sums: forces that are
/// still smaller are lost in the rounding of u itself.
const LOST_IN_ROUNDING: f64 = 1e-4;

/// Displacements per node: [u_x, u_y, θ], θ counter-clockwise and 0 at nodes without one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Displacements(pub Vec<[f64; 3]>);

/// Size of the problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unknowns {
    /// Nodal components before supports and ties.
    pub all: usize,
    /// After supports and ties, before the joints.
    pub free: usize,
}

/// Seconds spent on the main system.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seconds {
    /// Numbering, loose parts, element stiffnesses and their sum.
    pub assemble: f64,
    /// Ordering and factorization.
    pub factor: f64,
    /// R, RF and the kernel.
    pub condense: f64,
}

/// R, RF, the kernel, and what is needed to return from the joints to the structure.
#[derive(Clone)]
pub struct MainSystem {
    pub(super) dofs: Dofs,
    pub(super) elimination: Elimination,
    pub(super) joints: Vec<Joint>,
    /// K on the base dofs.
    pub(super) k: Arc<SymmetricSparse>,
    /// F per load case on the base dofs.
    pub(super) f: Vec<Vec<f64>>,
    factor: Arc<Factor>,
    c: Vec<(u32, u32, f64)>,
    r: DMatrix<f64>,
    rf: Vec<DVector<f64>>,
    z: DMatrix<f64>,
    /// Of the first of the motions; internal ones follow.
    rigid: RigidKernel,
    /// Column j of `z` is B applied to Σ_i coefficients[(i, j)] · motion i; r × r.
    coefficients: DMatrix<f64>,
    motions: Vec<Motion>,
    seconds: Seconds,
}

impl fmt::Debug for MainSystem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MainSystem")
            .field("size", &self.size())
            .field("joints", &self.joints.len())
            .field("kernel", &self.z.ncols())
            .finish_non_exhaustive()
    }
}

impl MainSystem {
    /// Assembles, factorizes and condenses the structure to its joints.
    ///
    /// # Errors
    /// Dependent joints, a mechanism, an element without shape, a moment where nothing turns, too large,
    /// interrupted: see [`MainSystemError`].
    pub fn new(structure: &Structure, joints: &[Joint], watch: &dyn Watch) -> Result<MainSystem, MainSystemError> {
        let clock = Instant::now();
        watch.progress(&format!("assembling {} elements", structure.elements.len()), 0.0);
        let dofs = Dofs::new(structure);
        let elimination = Elimination::new(structure, &dofs, joints).map_err(MainSystemError::DependentJoints)?;
        let f = load_vectors(structure, &dofs)?;
        let k = assemble(structure, &dofs, &|| watch.stop())?;
        let motions = loose_motions(structure, &dofs);
        let rigid = kernel::rigid_kernel(structure, joints, &motions)?;
        let mut main = main_matrices(&k, &elimination);
        let mut seconds = Seconds { assemble: clock.elapsed().as_secs_f64(), ..Seconds::default() };

        let clock = Instant::now();
        let mut last = vec![false; elimination.masters()];
        for dof in 0..dofs.count() {
            if elimination.joint_terms(dof).next().is_some() {
                for (master, _) in elimination.free_terms(dof) {
                    last[master] = true;
                }
            }
        }
        let mut node = vec![0; elimination.masters()];
        for (dof, at) in dofs.nodes().enumerate() {
            for (master, _) in elimination.free_terms(dof) {
                node[master] = at as u32;
            }
        }
        let coordinates: Vec<[f64; 2]> = structure.nodes.iter().map(|node| node.position).collect();
        let places = Places { node: &node, coordinates: &coordinates, last: &last };
        let factor = Factor::new(&mut main.k_m, &main.c, places, joints.len(), watch).map_err(|error| match error {
            FactorError::Other(error) => error,
            FactorError::Singular(v) => {
                let u = elimination.expand(&v, &vec![0.0; joints.len()]);
                kernel::mechanism(structure, &dofs.scatter(&u))
            }
        })?;
        drop(main.k_m);
        seconds.factor = clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        watch.progress(&format!("condensing to {} joints", joints.len()), 0.0);
        let mut r = factor.schur(std::mem::take(&mut main.d));
        kernel::project(&mut r, &rigid.z);
        let mut system = MainSystem {
            dofs,
            elimination,
            joints: joints.to_vec(),
            k: Arc::new(k),
            f: Vec::new(),
            factor: Arc::new(factor),
            c: main.c,
            r,
            rf: Vec::new(),
            z: rigid.z.clone(),
            coefficients: rigid.coefficients.clone(),
            rigid,
            motions,
            seconds,
        };
        system.take_loads(f);
        system.add_internal_mechanisms()?;
        system.seconds.condense = clock.elapsed().as_secs_f64();
        watch.progress(&format!("condensing to {} joints", joints.len()), 1.0);
        Ok(system)
    }

    /// The same structure under other loads: F and RF anew, with the factorization kept.
    ///
    /// # Errors
    /// A moment where nothing turns.
    pub fn with_loads(&self, structure: &Structure) -> Result<MainSystem, MainSystemError> {
        let clock = Instant::now();
        let mut system = self.clone();
        system.take_loads(load_vectors(structure, &self.dofs)?);
        system.seconds = Seconds { condense: clock.elapsed().as_secs_f64(), ..Seconds::default() };
        Ok(system)
    }

    /// F per load case, and RF from it.
    fn take_loads(&mut self, f: Vec<Vec<f64>>) {
        let loads: Vec<Vec<f64>> = f.iter().map(|f| on_masters(&self.elimination, f)).collect();
        let condensed = self.factor.project(&loads);
        let motions = &self.motions[..self.rigid.coefficients.nrows()];
        let rf = f.iter().zip(condensed.column_iter()).map(|(f, column)| {
            let mut rf = column - DVector::from_vec(on_joints(&self.elimination, f));
            balance(&mut rf, &self.rigid, motions, f, &self.dofs);
            rf
        });
        self.rf = rf.collect();
        self.f = f;
    }

    /// K_m, for measuring other solvers on the same matrix.
    ///
    /// # Errors
    /// As [`MainSystem::new`] up to the assembly.
    pub fn matrix(
        structure: &Structure,
        joints: &[Joint],
        watch: &dyn Watch,
    ) -> Result<SymmetricSparse, MainSystemError> {
        let dofs = Dofs::new(structure);
        let elimination = Elimination::new(structure, &dofs, joints).map_err(MainSystemError::DependentJoints)?;
        let k = assemble(structure, &dofs, &|| watch.stop())?;
        Ok(main_matrices(&k, &elimination).k_m)
    }

    /// Adds eigenvectors of R that cost no energy in K to the kernel.
    fn add_internal_mechanisms(&mut self) -> Result<(), MainSystemError> {
        let suspects = kernel::suspects(&self.r, &self.z)?;
        if suspects.is_empty() {
            return Ok(());
        }
        let scale: Vec<f64> =
            self.k.diagonal().into_iter().map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 }).collect();
        let norm = |v: Vec<f64>| {
            let scaled = std::iter::zip(v, &scale).map(|(v, s)| (v * s).powi(2));
            scaled.sum::<f64>().sqrt()
        };
        for z in suspects {
            let u = self.base_displacements(&vec![0.0; self.f.len()], &z);
            let force = norm(self.unheld_forces(self.k.times(&u)));
            let terms = norm(self.k.times_absolute(&u));
            if force > NO_FORCE * terms {
                continue;
            }
            if let Some(extended) = kernel::extend(&self.z, &z) {
                let mut u = self.dofs.scatter(&u);
                let mut largest = u.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
                if largest == 0.0 {
                    largest = 1.0;
                }
                u.iter_mut().flatten().for_each(|u| *u /= largest);
                self.motions.push(Motion { u, internal: true });
                // The new column is (z − Z Zᵀ z) / norm, and z is B applied to largest · the new motion.
                let at = self.z.ncols();
                let norm = extended.column(at).dot(&z);
                let inside = &self.coefficients * (self.z.transpose() * &z);
                let mut coefficients = self.coefficients.clone().resize(at + 1, at + 1, 0.0);
                coefficients.view_mut((0, at), (at, 1)).copy_from(&(-inside / norm));
                coefficients[(at, at)] = largest / norm;
                self.coefficients = coefficients;
                self.z = extended;
            }
        }
        kernel::project(&mut self.r, &self.z);
        Ok(())
    }

    /// R, k × k: rows and columns in the order of the joints; exactly symmetric, R Z = 0 to rounding.
    pub fn stiffness(&self) -> &DMatrix<f64> {
        &self.r
    }

    /// Z, k × r: orthonormal basis of the kernel of R; r = 0 when the structure stands without its contacts.
    pub fn kernel(&self) -> &DMatrix<f64> {
        &self.z
    }

    /// Motions behind the kernel, for words and pictures: as many as Z has columns and with the same span on the
    /// joints, but in a convenient basis (translations, then rotations, part by part), not column by column.
    pub fn kernel_motions(&self) -> &[Motion] {
        &self.motions
    }

    /// How much of each of the motions is in a motion of the joints, as far as it lies in the kernel.
    pub fn amounts(&self, z: &DVector<f64>) -> DVector<f64> {
        &self.coefficients * (self.z.transpose() * z)
    }

    /// RF per load case and unit factor, in the order of the joints.
    pub fn loads(&self) -> &[DVector<f64>] {
        &self.rf
    }

    /// Largest nodal force or joint force of each load case per unit factor: what rounding in its RF is measured by.
    pub fn load_sizes(&self) -> Vec<f64> {
        let rotation = self.dofs.is_rotation();
        std::iter::zip(&self.f, &self.rf)
            .map(|(f, rf)| {
                let nodal = std::iter::zip(f, &rotation).filter(|(_, rotation)| !**rotation).map(|(f, _)| f.abs());
                nodal.fold(rf.amax(), f64::max)
            })
            .collect()
    }

    /// u under Σ factor·F and the mutual displacements `z` of the joints (the whole mutual displacement B u: with
    /// an initial gap g it is z_n − g).
    ///
    /// # Panics
    /// If there are not as many factors as load cases and as many z as joints.
    pub fn displacements(&self, factors: &[f64], z: &DVector<f64>) -> Displacements {
        Displacements(self.dofs.scatter(&self.base_displacements(factors, z)))
    }

    fn base_displacements(&self, factors: &[f64], z: &DVector<f64>) -> Vec<f64> {
        assert_eq!(factors.len(), self.f.len(), "a factor for every load case");
        assert_eq!(z.len(), self.joints.len(), "a z for every joint");
        // K_m v = Tᵀ F − C z.
        let mut f = vec![0.0; self.dofs.count()];
        for (case, factor) in std::iter::zip(&self.f, factors) {
            for (sum, f) in std::iter::zip(&mut f, case) {
                *sum += factor * f;
            }
        }
        let mut v = on_masters(&self.elimination, &f);
        for &(row, joint, value) in &self.c {
            v[row as usize] -= value * z[joint as usize];
        }
        self.factor.solve(&mut v);
        self.elimination.expand(&v, z.as_slice())
    }

    /// Nodal forces K u − F − Bᵀ λ on the base dofs: what supports and ties have to give.
    pub(super) fn unbalanced(&self, u: &Displacements, lambda: &DVector<f64>, factors: &[f64]) -> Vec<f64> {
        let mut forces = self.k.times(&self.dofs.gather(&u.0));
        for (f, factor) in std::iter::zip(&self.f, factors) {
            for (force, f) in std::iter::zip(&mut forces, f) {
                *force -= factor * f;
            }
        }
        for (force, joint) in std::iter::zip(&mut forces, self.joint_forces(lambda)) {
            *force -= joint;
        }
        forces
    }

    /// Bᵀ λ on the base dofs.
    fn joint_forces(&self, lambda: &DVector<f64>) -> Vec<f64> {
        let mut forces = vec![0.0; self.dofs.count()];
        for (joint, lambda) in std::iter::zip(&self.joints, lambda.iter()) {
            for (node, a) in &joint.terms {
                for (component, a) in std::iter::zip([Component::X, Component::Y], a) {
                    if let Some(dof) = self.dofs.of(*node, component) {
                        forces[dof] += a * lambda;
                    }
                }
            }
        }
        forces
    }

    /// Sums over ties, then zero where a support holds.
    fn unheld_forces(&self, mut forces: Vec<f64>) -> Vec<f64> {
        for dof in 0..forces.len() {
            let class = self.elimination.class(dof);
            if class != dof {
                forces[class] += std::mem::take(&mut forces[dof]);
            }
        }
        for (dof, force) in forces.iter_mut().enumerate() {
            if self.elimination.is_held(dof) {
                *force = 0.0;
            }
        }
        forces
    }

    /// Largest |K u − F − Bᵀ λ| on the components that no support holds (ties summed), relative to the largest
    /// force: load, joint force or support reaction; moments relative to the largest moment, or to the largest
    /// force times the mean length of a frame element. From K itself, not from anything condensed.
    pub fn equilibrium_residual(
        &self,
        structure: &Structure,
        u: &Displacements,
        lambda: &DVector<f64>,
        factors: &[f64],
    ) -> f64 {
        let unbalanced = self.unbalanced(u, lambda, factors);
        let joint_forces = self.joint_forces(lambda);
        let terms = self.k.times_absolute(&self.dofs.gather(&u.0));
        let rotation = self.dofs.is_rotation();
        // Index 0: forces, 1: moments.
        let mut scale = [0.0_f64; 2];
        for dof in 0..self.dofs.count() {
            let load: f64 = std::iter::zip(&self.f, factors).map(|(f, factor)| f[dof] * factor).sum();
            let reaction = if self.elimination.is_held(dof) { unbalanced[dof] } else { 0.0 };
            let largest = [load, joint_forces[dof], reaction, LOST_IN_ROUNDING * terms[dof]]
                .into_iter()
                .fold(0.0, |m: f64, x| m.max(x.abs()));
            let kind = usize::from(rotation[dof]);
            scale[kind] = scale[kind].max(largest);
        }
        scale[1] = scale[1].max(scale[0] * super::recovery::mean_frame_length(structure));
        let residual = self.unheld_forces(unbalanced);
        residual
            .iter()
            .zip(&rotation)
            .filter(|(r, _)| **r != 0.0)
            .map(|(r, &rotation)| r.abs() / scale[usize::from(rotation)])
            .fold(0.0, f64::max)
    }

    /// Numbers of unknowns.
    pub fn size(&self) -> Unknowns {
        Unknowns { all: self.dofs.unknowns(), free: self.elimination.free() }
    }

    /// Time spent.
    pub fn timings(&self) -> Seconds {
        self.seconds
    }

    /// Entries stored for the factor of the main system.
    pub fn factor_entries(&self) -> usize {
        self.factor.stored()
    }
}

/// On the motions of loose parts RF is known exactly: uᵀ (Bᵀ RF + F) = 0. Puts that right to the last digit.
fn balance(rf: &mut DVector<f64>, rigid: &RigidKernel, motions: &[Motion], f: &[f64], dofs: &Dofs) {
    if motions.is_empty() {
        return;
    }
    let work = DVector::from_iterator(
        motions.len(),
        motions.iter().map(|motion| {
            let u = dofs.gather(&motion.u);
            -std::iter::zip(u, f).map(|(u, f)| u * f).sum::<f64>()
        }),
    );
    let error = rigid.coefficients.transpose() * work - rigid.z.transpose() * &*rf;
    *rf += &rigid.z * error;
}
