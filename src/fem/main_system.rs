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

use super::assembly::{Coupling, assemble, assemble_seen, main_matrices};
use super::contrast::{self, Stiffnesses};
use super::dof::Dofs;
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::factor::Factor;
use super::kernel::{self, RigidKernel};
use super::links::Links;
use super::loads::{load_vectors, settlements};
use super::loose::{EFFORT, Motion, loose_motions};
use super::order::Places;
use super::outline::{Outline, refuse_torques};
use super::refinement::{Refinement, Verdict};
use super::repeated::Repeated;
use super::sparse::SymmetricSparse;
use super::threads::both;
use super::traces::Traces;
use crate::doubled::Doubled;
use crate::model::pair::Joint;
use crate::model::structure::{Component, Structure};
use crate::watch::{Quiet, Watch};

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
    pub(super) independent: Vec<usize>,
    /// The other joints.
    pub(super) repeated: Vec<Repeated>,
    /// K on the base dofs.
    pub(super) k: Arc<SymmetricSparse>,
    /// F per load case on the base dofs.
    pub(super) f: Vec<Vec<f64>>,
    /// S s per load case on the base dofs, for the cases in which supports settle.
    pub(super) settled: Vec<Option<Vec<f64>>>,
    /// K in doubled precision, where f64 loses too much of the structure's stiffness.
    pub(super) doubled: Option<Arc<SymmetricSparse<Doubled>>>,
    /// Σ|u||K||u| over uᵀ K u, the largest that was met: how much R and RF lose to rounding; 1 where what loses was
    /// made in doubled precision.
    pub(super) amplification: f64,
    pub(super) factor: Arc<Factor>,
    pub(super) c: Vec<Coupling>,
    pub(super) r: DMatrix<f64>,
    pub(super) rf: Vec<DVector<f64>>,
    /// What the entries of RF were summed from.
    pub(super) rf_terms: Vec<DVector<f64>>,
    pub(super) links: Links,
    pub(super) z: DMatrix<f64>,
    /// The kernel of the first of the motions; internal ones follow.
    pub(super) rigid: RigidKernel,
    /// Column j of `z` is B applied to Σ_i coefficients[(i, j)] · motion i; r × r.
    pub(super) coefficients: DMatrix<f64>,
    pub(super) motions: Vec<Motion>,
    /// Those of the loose parts, as far as they are known beyond f64.
    traces: Option<Arc<Vec<Traces>>>,
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
    /// Assembles, factorizes and condenses the structure to its joints; those that [repeat](Repeated) others are left
    /// out of R, RF and the kernel.
    ///
    /// # Errors
    /// Bodies held too often, joints held by supports, ties and bodies, a mechanism, an element without shape, a moment
    /// where nothing turns, too large,
    /// interrupted: see [`MainSystemError`].
    pub fn new(structure: &Structure, all_joints: &[Joint], watch: &dyn Watch) -> Result<MainSystem, MainSystemError> {
        MainSystem::with_effort(structure, all_joints, watch, EFFORT)
    }

    /// With a bound of its own for the additions that look for motions among the parts, before R is asked.
    ///
    /// # Errors
    /// As [`MainSystem::new`].
    pub(super) fn with_effort(
        structure: &Structure,
        all_joints: &[Joint],
        watch: &dyn Watch,
        effort: usize,
    ) -> Result<MainSystem, MainSystemError> {
        let clock = Instant::now();
        watch.progress(&format!("assembling {} elements", structure.elements.len()), 0.0);
        let Outline { dofs, elimination, joints, independent, repeated, f, settled } =
            Outline::new(structure, all_joints, watch)?;
        let mut stiffnesses = Stiffnesses::of_springs(structure);
        let (k, loose) = both(
            dofs.count(),
            || assemble_seen(structure, &dofs, &|| watch.stop(), |k| stiffnesses.take(k)),
            || loose_motions(structure, &dofs, all_joints, effort),
        );
        let k = k?;
        let no_others = loose.are_all(structure, &stiffnesses);
        let (motions, traces) = (loose.motions, loose.traces.map(Arc::new));
        let rigid = kernel::rigid_kernel(structure, &joints, &motions)?;
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
        let node = elimination.nodes(&dofs);
        let links = Links::new(&main);
        let coordinates: Vec<[f64; 3]> = structure.nodes.iter().map(|node| node.position).collect();
        let places = Places { node: &node, coordinates: &coordinates, last: &last };
        let factor = Factor::new(&mut main.k_m, &main.c, places, joints.len(), watch)?;
        drop(main.k_m);
        let mut system = MainSystem {
            dofs,
            elimination,
            joints,
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
            rf_terms: Vec::new(),
            links,
            z: rigid.z.clone(),
            coefficients: rigid.coefficients.clone(),
            rigid,
            motions,
            traces,
            seconds,
        };
        system.refuse_mechanisms(structure, watch)?;
        system.seconds.factor = clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        let condensing = format!("condensing to {} joints", system.joints.len());
        watch.progress(&condensing, 0.0);
        system.condense(structure, main.d, watch)?;
        if !no_others {
            system.add_internal_mechanisms(structure, watch)?;
        }
        system.seconds.condense = clock.elapsed().as_secs_f64();
        watch.progress(&condensing, 1.0);
        Ok(system)
    }

    /// Whether a node has this component of a displacement: nothing turns at nodes of trusses, plates and solids.
    pub fn has(&self, node: usize, component: Component) -> bool {
        self.dofs.of(node, component).is_some()
    }

    /// The same structure under other loads: F and RF anew, with the factorization kept.
    ///
    /// # Errors
    /// A moment where nothing turns; loads under which the structure cannot be solved.
    pub fn with_loads(&self, structure: &Structure) -> Result<MainSystem, MainSystemError> {
        let clock = Instant::now();
        let mut system = self.clone();
        system.f = load_vectors(structure, &self.dofs)?;
        refuse_torques(structure, &self.dofs, self.elimination.spins(), &system.f)?;
        system.settled = settlements(structure, &self.dofs, &self.elimination)?;
        if system.doubled.is_some() {
            system.take_loads_doubled(structure, &Quiet)?;
        } else {
            system.take_loads(structure, &Quiet)?;
        }
        system.seconds = Seconds { condense: clock.elapsed().as_secs_f64(), ..Seconds::default() };
        Ok(system)
    }

    /// The tools of doubled precision; K is assembled anew the first time.
    pub(super) fn refinement(
        &mut self,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<Refinement<'_>, MainSystemError> {
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

    /// K_m and the terms of C, for measuring other solvers on the same matrices; the joints have to be
    /// independent.
    ///
    /// # Errors
    /// As [`MainSystem::new`] up to the assembly.
    pub fn matrices_of(
        structure: &Structure,
        joints: &[Joint],
        watch: &dyn Watch,
    ) -> Result<(SymmetricSparse, Vec<Coupling>), MainSystemError> {
        let dofs = Dofs::new(structure);
        let elimination = Elimination::new(structure, &dofs, joints)?;
        let k: SymmetricSparse = assemble(structure, &dofs, &|| watch.stop())?;
        let main = main_matrices(&k, &elimination);
        Ok((main.k_m, main.c))
    }

    /// Index among all joints of each joint that R is made of, ascending.
    pub fn independent(&self) -> &[usize] {
        &self.independent
    }

    /// The other joints.
    pub fn repeated(&self) -> &[Repeated] {
        &self.repeated
    }

    /// R, force per length, k × k: rows and columns in the order of the independent joints; exactly symmetric, R Z = 0
    /// to rounding.
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

    /// What the motions do to all joints, cluster by cluster in their order, where that is known beyond f64.
    pub fn traces(&self) -> Option<&[Traces]> {
        let traces = self.traces.as_ref()?;
        let count: usize = traces.iter().map(|cluster| cluster.near.ncols()).sum();
        (count == self.motions.len()).then_some(traces)
    }

    /// How many joints the structure has, with those that are left out of R.
    pub fn joint_count(&self) -> usize {
        self.all_joints.len()
    }

    /// How much of each of the motions is in a motion of the joints, as far as it lies in the kernel.
    pub fn amounts(&self, z: &DVector<f64>) -> DVector<f64> {
        &self.coefficients * (self.z.transpose() * self.of_independent(z))
    }

    /// RF per load case and unit factor, in the order of the joints: forces, x_n > 0 presses.
    pub fn loads(&self) -> &[DVector<f64>] {
        &self.rf
    }

    /// Magnitudes that each entry of RF of each load case was summed from, per unit factor: what its rounding is measured by.
    pub fn load_terms(&self) -> &[DVector<f64>] {
        &self.rf_terms
    }

    /// Of each joint the group in which joints feel one another: between two of them R is zero.
    pub fn groups(&self) -> &[usize] {
        &self.links.stiffness
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
