//! The main system: every joint on. R, RF and the kernel of R; displacements for given loads and dislocations.
//!
//! ```text
//!     K_m v + C z = Tᵀ F,   λ = Cᵀ v + D z − Gᵀ F       (u = T v + G z, see `elimination`)
//!     R  = D − Cᵀ K_m⁻¹ C
//!     RF = Cᵀ K_m⁻¹ Tᵀ F − Gᵀ F
//! ```

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{DMatrix, DVector};

use super::assembly::{assemble, main_matrices, on_joints, on_masters};
use super::contrast;
use super::dof::Dofs;
use super::doubled::{Doubled, Real};
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::factor::Factor;
use super::kernel::{self, RigidKernel};
use super::loads::{load_vectors, settlements};
use super::loose::{Motion, loose_motions};
use super::order::Places;
use super::refinement::{Refinement, Verdict};
use super::repeated::Repeated;
use super::sparse::SymmetricSparse;
use super::superelement::refuse_indefinite;
use crate::model::pair::Joint;
use crate::model::structure::Structure;
use crate::watch::{Quiet, Watch};

/// R and RF are taken from the f64 factor where rounding costs them no more than this share; see
/// [`MainSystem::loss`].
const MOST_LOSS: f64 = 1e-12;

/// Displacements per node: [u_x, u_y, θ], θ counter-clockwise and 0 at nodes without one; and, where the main system
/// is solved in doubled precision, what f64 leaves of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Displacements(pub Vec<[f64; 3]>, pub(super) Option<Tail>);

/// The second half of displacements in doubled precision.
#[derive(Clone, Debug, PartialEq)]
pub struct Tail {
    /// Per node.
    values: Vec<[f64; 3]>,
    /// What is left of the energy of their error, as the solver sees it.
    pub(super) error: f64,
}

impl From<Vec<[f64; 3]>> for Displacements {
    fn from(nodes: Vec<[f64; 3]>) -> Displacements {
        Displacements(nodes, None)
    }
}

impl Displacements {
    /// In doubled precision.
    pub(super) fn doubled(&self) -> Vec<[Doubled; 3]> {
        (0..self.0.len()).map(|node| self.doubled_at(node)).collect()
    }

    /// The same of one node.
    pub(super) fn doubled_at(&self, node: usize) -> [Doubled; 3] {
        let tail = self.1.as_ref().map_or([0.0; 3], |tail| tail.values[node]);
        std::array::from_fn(|c| Doubled::sum(self.0[node][c], tail[c]))
    }
}

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
    /// The joints that R is made of.
    pub(super) joints: Vec<Joint>,
    /// All joints of the structure.
    pub(super) all_joints: Vec<Joint>,
    /// Index among all joints of each one of `joints`.
    independent: Vec<usize>,
    /// The other joints.
    repeated: Vec<Repeated>,
    /// K on the base dofs.
    pub(super) k: Arc<SymmetricSparse>,
    /// F per load case on the base dofs.
    pub(super) f: Vec<Vec<f64>>,
    /// S s per load case on the base dofs, for the cases in which supports settle.
    settled: Vec<Option<Vec<f64>>>,
    /// K in doubled precision, where f64 loses too much of the structure's stiffness.
    pub(super) doubled: Option<Arc<SymmetricSparse<Doubled>>>,
    /// Σ|u||K||u| over uᵀ K u, the largest that was met: how much R and RF lose to rounding.
    pub(super) amplification: f64,
    factor: Arc<Factor>,
    c: Vec<(u32, u32, f64)>,
    pub(super) r: DMatrix<f64>,
    pub(super) rf: Vec<DVector<f64>>,
    pub(super) z: DMatrix<f64>,
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
    /// Assembles, factorizes and condenses the structure to its joints; those that [repeat](Repeated) others are left out
    /// of R, RF and the kernel.
    ///
    /// # Errors
    /// Bodies held too often, joints held by supports, ties and bodies, a mechanism, an element without shape, a moment
    /// where nothing turns, too large,
    /// interrupted: see [`MainSystemError`].
    pub fn new(structure: &Structure, all_joints: &[Joint], watch: &dyn Watch) -> Result<MainSystem, MainSystemError> {
        let clock = Instant::now();
        watch.progress(&format!("assembling {} elements", structure.elements.len()), 0.0);
        let dofs = Dofs::new(structure);
        refuse_indefinite(structure, &dofs, watch)?;
        let repeated = Elimination::repeated(structure, &dofs, all_joints)?;
        let is_repeated = |index: &usize| repeated.iter().any(|repeated| repeated.joint == *index);
        let independent: Vec<usize> = (0..all_joints.len()).filter(|index| !is_repeated(index)).collect();
        let joints: &[Joint] = &independent.iter().map(|&index| all_joints[index].clone()).collect::<Vec<_>>();
        let elimination = Elimination::new(structure, &dofs, joints)?;
        let f = load_vectors(structure, &dofs)?;
        let settled = settlements(structure, &dofs, &elimination)?;
        let k = assemble(structure, &dofs, &|| watch.stop())?;
        let motions = loose_motions(structure, &dofs);
        let rigid = kernel::rigid_kernel(structure, joints, &motions)?;
        let mut main = main_matrices(&k, &elimination);
        let seconds = Seconds { assemble: clock.elapsed().as_secs_f64(), ..Seconds::default() };

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
        let factor = Factor::new(&mut main.k_m, &main.c, places, joints.len(), watch)?;
        drop(main.k_m);
        let mut system = MainSystem {
            dofs,
            elimination,
            joints: joints.to_vec(),
            all_joints: all_joints.to_vec(),
            independent,
            repeated,
            k: Arc::new(k),
            f,
            settled,
            doubled: None,
            amplification: 0.0,
            factor: Arc::new(factor),
            c: main.c,
            r: DMatrix::zeros(0, 0),
            rf: Vec::new(),
            z: rigid.z.clone(),
            coefficients: rigid.coefficients.clone(),
            rigid,
            motions,
            seconds,
        };
        system.refuse_mechanisms(structure, watch)?;
        system.seconds.factor = clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        watch.progress(&format!("condensing to {} joints", joints.len()), 0.0);
        system.condense(structure, main.d, watch)?;
        system.add_internal_mechanisms(structure, watch)?;
        system.seconds.condense = clock.elapsed().as_secs_f64();
        watch.progress(&format!("condensing to {} joints", joints.len()), 1.0);
        Ok(system)
    }

    /// The same structure under other loads: F and RF anew, with the factorization kept.
    ///
    /// # Errors
    /// A moment where nothing turns; loads under which the structure cannot be solved.
    pub fn with_loads(&self, structure: &Structure) -> Result<MainSystem, MainSystemError> {
        let clock = Instant::now();
        let mut system = self.clone();
        system.f = load_vectors(structure, &self.dofs)?;
        system.settled = settlements(structure, &self.dofs, &self.elimination)?;
        if system.doubled.is_some() {
            system.take_loads_doubled(structure, &Quiet)?;
        } else {
            system.take_loads();
            system.refine_if_lost(structure, &Quiet)?;
        }
        system.seconds = Seconds { condense: clock.elapsed().as_secs_f64(), ..Seconds::default() };
        Ok(system)
    }

    /// The tools of doubled precision; K is assembled anew the first time.
    fn refinement(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<Refinement<'_>, MainSystemError> {
        let k = match self.doubled.take() {
            Some(k) => k,
            None => Arc::new(assemble(structure, &self.dofs, &|| watch.stop())?),
        };
        let k = self.doubled.insert(k);
        Ok(Refinement { dofs: &self.dofs, k, elimination: &self.elimination, factor: &self.factor })
    }

    /// Looks into the motion that a small or failed pivot points to.
    ///
    /// # Errors
    /// It costs nothing, or too little to be computed with.
    fn refuse_mechanisms(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<(), MainSystemError> {
        let Some(mut v) = self.factor.suspect() else {
            return Ok(());
        };
        let verdict = self.refinement(structure, watch)?.judge(structure, &mut v);
        let u = || self.dofs.scatter(&self.elimination.expand(&v, &vec![0.0; self.joints.len()]));
        match verdict {
            Verdict::Resisted => Ok(()),
            Verdict::Mechanism => Err(kernel::mechanism(structure, &u())),
            Verdict::Unsolvable => Err(contrast::refusal(structure)),
        }
    }

    /// R, RF and their kernel, from the f64 factor if its rounding costs little, otherwise in doubled precision.
    fn condense(&mut self, structure: &Structure, d: DMatrix<f64>, watch: &dyn Watch) -> Result<(), MainSystemError> {
        if self.factor.is_shifted() {
            return self.condense_doubled(structure, watch);
        }
        self.doubled = None;
        self.r = self.factor.schur(d);
        kernel::project(&mut self.r, &self.z);
        self.take_loads();
        self.refine_if_lost(structure, watch)
    }

    /// R and RF in doubled precision where rounding takes too much of them.
    fn refine_if_lost(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<(), MainSystemError> {
        self.amplification = self.worst_amplification();
        // Each term of uᵀ K u is off by ε at random, and there are as many as unknowns.
        let loss = f64::EPSILON * self.amplification / (self.elimination.masters().max(1) as f64).sqrt();
        if loss > MOST_LOSS { self.condense_doubled(structure, watch) } else { Ok(()) }
    }

    fn condense_doubled(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<(), MainSystemError> {
        let r = self.refinement(structure, watch)?.stiffness(watch)?;
        self.r = r.ok_or_else(|| contrast::refusal(structure))?;
        kernel::project(&mut self.r, &self.z);
        self.amplification = 1.0;
        self.take_loads_doubled(structure, watch)
    }

    /// RF from F by the f64 factor.
    fn take_loads(&mut self) {
        let driving = self.driving_forces();
        let loads: Vec<Vec<f64>> = driving.iter().map(|f| on_masters(&self.elimination, f)).collect();
        let condensed = self.factor.project(&loads);
        let rf = std::iter::zip(&driving, condensed.column_iter());
        self.rf = rf.map(|(f, column)| column - DVector::from_vec(on_joints(&self.elimination, f))).collect();
        self.balance_loads();
    }

    /// RF from F in doubled precision.
    fn take_loads_doubled(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<(), MainSystemError> {
        let f = std::mem::take(&mut self.f);
        let settled = std::mem::take(&mut self.settled);
        let rf = self.refinement(structure, watch)?.loads(&f, &settled, watch);
        (self.f, self.settled) = (f, settled);
        self.rf = rf?.ok_or_else(|| contrast::refusal(structure))?;
        self.balance_loads();
        Ok(())
    }

    /// F − K S s per load case: what moves the free unknowns.
    fn driving_forces(&self) -> Vec<Cow<'_, [f64]>> {
        let cases = std::iter::zip(&self.f, &self.settled);
        cases
            .map(|(f, settled)| match settled {
                None => Cow::Borrowed(&f[..]),
                Some(settled) => Cow::Owned(std::iter::zip(f, self.k.times(settled)).map(|(f, k)| f - k).collect()),
            })
            .collect()
    }

    fn balance_loads(&mut self) {
        let motions = &self.motions[..self.rigid.coefficients.nrows()];
        for (rf, f) in std::iter::zip(&mut self.rf, &self.f) {
            balance(rf, &self.rigid, motions, f, &self.dofs);
        }
    }

    /// Σ|u||K||u| over uᵀ K u, the largest of a random dislocation that is no motion of the kernel and of the load
    /// cases on the main system.
    fn worst_amplification(&self) -> f64 {
        let k = self.joints.len();
        let mut state = 0.37;
        let mut z = DVector::from_fn(k, |i, _| {
            state = (state * 997.0_f64).fract() + 1e-3;
            let size = self.r[(i, i)];
            if size > 0.0 { (state - 0.5).signum() / size.sqrt() } else { 0.0 }
        });
        z -= &self.z * (self.z.transpose() * &z);
        let none = vec![0.0; self.f.len()];
        let mut fields = vec![self.plain_displacements(&none, &z)];
        for case in 0..self.f.len() {
            let mut factors = none.clone();
            factors[case] = 1.0;
            fields.push(self.plain_displacements(&factors, &DVector::zeros(k)));
        }
        let amplification = |u: &Vec<f64>| {
            let terms = dot(&self.k.times_absolute(u), &u.iter().map(|u| u.abs()).collect::<Vec<_>>());
            let energy = dot(&self.k.times(u), u).max(f64::EPSILON * terms);
            if terms > 0.0 { terms / energy } else { 0.0 }
        };
        fields.iter().map(amplification).fold(0.0, f64::max)
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
        let elimination = Elimination::new(structure, &dofs, joints)?;
        let k: SymmetricSparse = assemble(structure, &dofs, &|| watch.stop())?;
        Ok(main_matrices(&k, &elimination).k_m)
    }

    /// Adds eigenvectors of R that cost no energy in K to the kernel.
    fn add_internal_mechanisms(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<(), MainSystemError> {
        let Some(suspects) = kernel::suspects(&self.r, &self.z)? else {
            return Ok(());
        };
        let refined = self.doubled.is_some();
        let idle = vec![0.0; self.dofs.count()];
        for suspect in 0..suspects.count {
            let mut z = suspects.vectors.column(suspect).into_owned();
            let mut free = None;
            // The eigenvector of a rounded R; what the structure resists is taken out of it twice.
            for _ in 0..3 {
                let refinement = self.refinement(structure, watch)?;
                let Some((u, _)) = refinement.displacements(&idle, None, z.as_slice(), watch)? else { break };
                if let Verdict::Mechanism = refinement.cost(structure, &u) {
                    free = Some(u);
                    break;
                }
                let force = on_joints(refinement.elimination, &refinement.k.times(&u));
                z -= suspects.resisting(&DVector::from_iterator(force.len(), force.into_iter().map(Real::to_f64)));
            }
            if let Some(u) = free {
                let u: Vec<f64> = u.into_iter().map(Real::to_f64).collect();
                self.add_motion(&z, self.dofs.scatter(&u));
            }
        }
        if !refined {
            self.doubled = None;
        }
        kernel::project(&mut self.r, &self.z);
        Ok(())
    }

    /// Adds a motion `u` without energy and its dislocations `z` to the kernel, unless it is in there.
    fn add_motion(&mut self, z: &DVector<f64>, mut u: Vec<[f64; 3]>) {
        let Some(extended) = kernel::extend(&self.z, z) else {
            return;
        };
        let mut largest = u.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
        if largest == 0.0 {
            largest = 1.0;
        }
        u.iter_mut().flatten().for_each(|u| *u /= largest);
        self.motions.push(Motion { u, internal: true });
        // The new column is (z − Z Zᵀ z) / norm, and z is B applied to largest · the new motion.
        let at = self.z.ncols();
        let norm = extended.column(at).dot(z);
        let inside = &self.coefficients * (self.z.transpose() * z);
        let mut coefficients = self.coefficients.clone().resize(at + 1, at + 1, 0.0);
        coefficients.view_mut((0, at), (at, 1)).copy_from(&(-inside / norm));
        coefficients[(at, at)] = largest / norm;
        self.coefficients = coefficients;
        self.z = extended;
    }

    /// Index among all joints of each joint that R is made of, ascending.
    pub fn independent(&self) -> &[usize] {
        &self.independent
    }

    /// The other joints.
    pub fn repeated(&self) -> &[Repeated] {
        &self.repeated
    }

    /// z of the [repeated](Self::repeated) joints under each load case per unit factor where no independent joint moves:
    /// what supports that settle make of them.
    pub fn repeated_offsets(&self) -> Vec<Vec<f64>> {
        let of = |settled: &Option<Vec<f64>>, joint: usize| {
            let Some(settled) = settled else { return 0.0 };
            let mut z = 0.0;
            self.each_term(&self.all_joints[joint], |dof, a| z += a * settled[dof]);
            z
        };
        self.settled.iter().map(|case| self.repeated.iter().map(|joint| of(case, joint.joint)).collect()).collect()
    }

    /// Largest difference of a repeated joint's z from B u, as a share of the displacements of its nodes. Nodes at rest
    /// have the rounding of the largest displacement.
    pub fn compatibility_residual(&self, u: &Displacements, z: &DVector<f64>) -> f64 {
        let length = |u: &[f64; 3]| u[0].hypot(u[1]);
        let rounding = 64.0 * f64::EPSILON * u.0.iter().map(length).fold(0.0, f64::max);
        let share = |joint: usize| {
            let (mut rest, mut size) = (z[joint], z[joint].abs());
            for (node, a) in &self.all_joints[joint].terms {
                rest -= std::iter::zip(a, &u.0[*node]).map(|(a, u)| a * u).sum::<f64>();
                size += length(&u.0[*node]);
            }
            if rest.abs() <= rounding { 0.0 } else { rest.abs() / size }
        };
        self.repeated.iter().map(|repeated| share(repeated.joint)).fold(0.0, f64::max)
    }

    /// The entries of the independent joints of a vector over all joints.
    fn of_independent(&self, z: &DVector<f64>) -> DVector<f64> {
        assert_eq!(z.len(), self.all_joints.len(), "a z for every joint");
        DVector::from_iterator(self.independent.len(), self.independent.iter().map(|&joint| z[joint]))
    }

    /// R, k × k: rows and columns in the order of the independent joints; exactly symmetric, R Z = 0 to rounding.
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
        &self.coefficients * (self.z.transpose() * self.of_independent(z))
    }

    /// RF per load case and unit factor, in the order of the joints.
    pub fn loads(&self) -> &[DVector<f64>] {
        &self.rf
    }

    /// Largest nodal force or joint force of each load case per unit factor: what rounding in its RF is measured by.
    pub fn load_sizes(&self) -> Vec<f64> {
        let rotation = self.dofs.is_rotation();
        std::iter::zip(self.driving_forces(), &self.rf)
            .map(|(f, rf)| {
                let nodal =
                    std::iter::zip(f.iter(), &rotation).filter(|(_, rotation)| !**rotation).map(|(f, _)| f.abs());
                nodal.fold(rf.amax(), f64::max)
            })
            .collect()
    }

    /// u under Σ factor·F and the mutual displacements `z` of all joints (the whole mutual displacement B u: with
    /// an initial gap g it is z_n − g); those of repeated joints follow from the others.
    ///
    /// # Panics
    /// If there are not as many factors as load cases and as many z as joints.
    pub fn displacements(&self, factors: &[f64], z: &DVector<f64>) -> Displacements {
        let z = &self.of_independent(z);
        if let Some(k) = &self.doubled {
            let refinement = Refinement { dofs: &self.dofs, k, elimination: &self.elimination, factor: &self.factor };
            let f = sum_of_cases(self.f.iter().map(Some), factors).unwrap_or_default();
            let settled = self.settlement(factors);
            // R and RF came from the same equations, so these converge too.
            if let Ok(Some((u, error))) = refinement.displacements(&f, settled.as_deref(), z.as_slice(), &Quiet) {
                let part = |part: fn(Doubled) -> f64| {
                    let u: Vec<f64> = u.iter().map(|&u| part(u)).collect();
                    self.dofs.scatter(&u)
                };
                return Displacements(part(Real::to_f64), Some(Tail { values: part(Doubled::tail), error }));
            }
        }
        Displacements(self.dofs.scatter(&self.plain_displacements(factors, z)), None)
    }

    /// Σ factor·S s on the base dofs; `None` if no support settles.
    pub(super) fn settlement(&self, factors: &[f64]) -> Option<Vec<f64>> {
        sum_of_cases(self.settled.iter().map(Option::as_ref), factors)
    }

    /// The base dofs from the f64 factor, with one step of refinement: then the error of each equation is a few ε of
    /// the terms of that equation (Skeel 1980), not of the largest of all.
    fn plain_displacements(&self, factors: &[f64], z: &DVector<f64>) -> Vec<f64> {
        assert_eq!(z.len(), self.joints.len(), "a z for every joint");
        assert_eq!(factors.len(), self.f.len(), "a factor for every load case");
        let mut f = sum_of_cases(self.f.iter().map(Some), factors).unwrap_or_else(|| vec![0.0; self.dofs.count()]);
        let settled = self.settlement(factors);
        if let Some(settled) = &settled {
            for (f, k) in std::iter::zip(&mut f, self.k.times(settled)) {
                *f -= k;
            }
        }
        // K_m v = Tᵀ (F − K S s) − C z.
        let mut v = on_masters(&self.elimination, &f);
        for &(row, joint, value) in &self.c {
            v[row as usize] -= value * z[joint as usize];
        }
        self.factor.solve(&mut v);
        let u = self.elimination.expand(&v, z.as_slice());
        let mut rest = self.k.times(&u);
        for (rest, f) in std::iter::zip(&mut rest, &f) {
            *rest = f - *rest;
        }
        let mut correction = on_masters(&self.elimination, &rest);
        self.factor.solve(&mut correction);
        for (v, correction) in std::iter::zip(&mut v, correction) {
            *v += correction;
        }
        let mut u = self.elimination.expand(&v, z.as_slice());
        for (u, settled) in std::iter::zip(&mut u, settled.into_iter().flatten()) {
            *u += settled;
        }
        u
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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    std::iter::zip(a, b).map(|(a, b)| a * b).sum()
}

/// On the motions of loose parts RF is known exactly: uᵀ (Bᵀ RF + F) = 0. Puts that right to the last digit.
fn balance(rf: &mut DVector<f64>, rigid: &RigidKernel, motions: &[Motion], f: &[f64], dofs: &Dofs) {
    if motions.is_empty() {
        return;
    }
    let work = motions.iter().map(|motion| -dot(&dofs.gather(&motion.u), f));
    let work = DVector::from_iterator(motions.len(), work);
    let error = rigid.coefficients.transpose() * work - rigid.z.transpose() * &*rf;
    *rf += &rigid.z * error;
}

/// Σ factor·vector over the load cases that have one; `None` if none does.
fn sum_of_cases<'a>(cases: impl Iterator<Item = Option<&'a Vec<f64>>>, factors: &[f64]) -> Option<Vec<f64>> {
    let mut sum: Option<Vec<f64>> = None;
    for (case, factor) in cases.zip(factors) {
        let Some(case) = case else { continue };
        let sum = sum.get_or_insert_with(|| vec![0.0; case.len()]);
        for (sum, value) in std::iter::zip(sum, case) {
            *sum += factor * value;
        }
    }
    sum
}
