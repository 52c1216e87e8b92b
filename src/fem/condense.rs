//! R, RF and the kernel of R of a main system that is factorized; in doubled precision where f64 loses too much.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::assembly::{on_joints, on_masters};
use super::contrast;
use super::dof::Dofs;
use super::error::MainSystemError;
use super::kernel::{self, RigidKernel};
use super::links::LoadTerms;
use super::loose::Motion;
use super::main_system::MainSystem;
use super::refinement::{Field, Verdict};
use super::sparse::SymmetricSparse;
use super::threads::both;
use crate::doubled::Real;
use crate::model::structure::Structure;
use crate::model::vector::length;
use crate::watch::Watch;

/// R and RF of the f64 factor are taken as they are where rounding hardly changes the energy uᵀ K u by more than this share
/// of it, in the field of every load and in that of a dislocation.
const MOST_LOSS: f64 = 1e-12;

/// What rounding makes of a sum of a few terms, as a share of these.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl MainSystem {
    /// R, RF and their kernel, from the f64 factor if its rounding costs little, otherwise in doubled precision.
    pub(super) fn condense(
        &mut self,
        structure: &Structure,
        d: DMatrix<f64>,
        watch: &dyn Watch,
    ) -> Result<(), MainSystemError> {
        if self.factor.is_shifted() {
            return self.condense_doubled(true, structure, watch);
        }
        self.doubled = None;
        self.r = self.factor.schur(d);
        self.project();
        self.take_loads(structure, watch)
    }

    /// RF from F. Where rounding may cost too much, in doubled precision; R too, but only where it is measured to be wrong,
    /// for the field of a load may bend the whole structure where those of the joints do not.
    pub(super) fn take_loads(&mut self, structure: &Structure, watch: &dyn Watch) -> Result<(), MainSystemError> {
        let masters = self.elimination.masters();
        (self.rf, self.amplification) = both(masters, || self.condensed_loads(), || self.worst_amplification());
        self.balance_loads();
        if !loses(self.amplification, masters) {
            return Ok(());
        }
        let is_right = self.correct_stiffness(structure, watch)?;
        self.condense_doubled(!is_right, structure, watch)
    }

    /// Makes the kernel of R exact.
    pub(super) fn project(&mut self) {
        kernel::project(&mut self.r, &self.z);
        self.links.part(&mut self.r);
    }

    /// RF in doubled precision, which takes a few solutions; R too if it is asked for, which takes one for each column.
    fn condense_doubled(
        &mut self,
        with_r: bool,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<(), MainSystemError> {
        if with_r {
            let r = self.refinement(structure, watch)?.stiffness(watch)?;
            self.r = r.ok_or_else(|| contrast::refusal(structure))?;
            self.project();
        }
        self.amplification = 1.0;
        self.take_loads_doubled(structure, watch)
    }

    /// RF from F by the f64 factor, not yet balanced.
    fn condensed_loads(&self) -> Vec<DVector<f64>> {
        let driving = self.driving_forces();
        let loads: Vec<Vec<f64>> = driving.iter().map(|f| on_masters(&self.elimination, f)).collect();
        let condensed = self.factor.project(&loads);
        let rf = std::iter::zip(&driving, condensed.column_iter());
        rf.map(|(f, column)| column - DVector::from_vec(on_joints(&self.elimination, f))).collect()
    }

    /// RF from F in doubled precision.
    pub(super) fn take_loads_doubled(
        &mut self,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<(), MainSystemError> {
        let f = std::mem::take(&mut self.f);
        let settled = std::mem::take(&mut self.settled);
        let rf = self.refinement(structure, watch)?.loads(&f, &settled, watch);
        (self.f, self.settled) = (f, settled);
        self.rf = rf?.ok_or_else(|| contrast::refusal(structure))?;
        self.balance_loads();
        Ok(())
    }

    /// [`driving_force`] of each load case.
    pub(super) fn driving_forces(&self) -> Vec<Cow<'_, [f64]>> {
        std::iter::zip(&self.f, &self.settled)
            .map(|(f, settled)| driving_force(&self.k, f, settled.as_deref()))
            .collect()
    }

    fn balance_loads(&mut self) {
        let motions = &self.motions[..self.rigid.coefficients.nrows()];
        let terms: Vec<LoadTerms> = std::iter::zip(&self.rf, self.driving_forces())
            .map(|(rf, driving)| self.links.load_terms(&self.dofs, &self.elimination, &driving, rf))
            .collect();
        let mut all = Vec::with_capacity(terms.len());
        for ((rf, f), LoadTerms { mut terms, size, are_far }) in std::iter::zip(&mut self.rf, &self.f).zip(terms) {
            // Forces of joints that repeat one another are shared anew, small ones made of large ones.
            let are_far = are_far && self.repeated.is_empty();
            if !are_far {
                terms.fill(size);
            }
            if balance(rf, &self.rigid, motions, (f, &self.dofs), are_far.then_some(&terms)) && are_far {
                // The correction of the largest has come to all.
                terms.fill(size);
            }
            all.push(terms);
        }
        self.rf_terms = all;
    }

    /// Σ|u||K||u| over uᵀ K u, the largest over the load cases on the main system and a random dislocation that is not
    /// a motion of the kernel.
    fn worst_amplification(&self) -> f64 {
        let k = self.joints.len();
        let mut state = 0.37;
        let mut z = DVector::from_fn(k, |i, _| {
            state = (state * 997.0_f64).fract() + 1e-3;
            let size = self.r[(i, i)];
            if size > 0.0 { (state - 0.5).signum() / size.sqrt() } else { 0.0 }
        });
        z -= &self.z * (self.z.transpose() * &z);
        let cases = self.f.len();
        let single = DMatrix::<f64>::identity(cases, cases);
        let none = vec![0.0; cases];
        // What the rounding of the fields themselves does to an estimate of it does not count.
        let of_cases = (0..cases).map(|case| (&single.as_slice()[cases * case..cases * (case + 1)], DVector::zeros(k)));
        let states: Vec<(&[f64], DVector<f64>)> = std::iter::once((&none[..], z)).chain(of_cases).collect();
        let fields = self.unrefined_displacements(&states);
        fields.iter().map(|u| amplification(&self.k, u, &self.k.times(u))).fold(0.0, f64::max)
    }

    /// Adds eigenvectors of R that cost no energy in K to the kernel.
    pub(super) fn add_internal_mechanisms(
        &mut self,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<(), MainSystemError> {
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
                let field = Field { f: &idle, settled: None, z: z.as_slice() };
                let Some((u, _)) = refinement.displacements(field, watch)? else { break };
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
        self.project();
        Ok(())
    }

    /// Adds a motion `u` without energy and its dislocations `z` to the kernel, unless it is in there.
    fn add_motion(&mut self, z: &DVector<f64>, mut u: Vec<[f64; 6]>) {
        let Some(extended) = kernel::extend(&self.z, z) else {
            return;
        };
        let mut largest = u.iter().map(|&[x, y, z, ..]| length([x, y, z])).fold(0.0, f64::max);
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
}

/// F − K s of a load case with the displacements s that its supports impose: what moves the free unknowns.
pub(super) fn driving_force<'f>(k: &SymmetricSparse, f: &'f [f64], settled: Option<&[f64]>) -> Cow<'f, [f64]> {
    match settled {
        None => Cow::Borrowed(f),
        Some(settled) => Cow::Owned(std::iter::zip(f, k.times(settled)).map(|(f, k)| f - k).collect()),
    }
}

/// Whether rounding that is amplified so may cost too much of the energy of a field of so many unknowns.
pub(super) fn loses(amplification: f64, unknowns: usize) -> bool {
    // Each term of uᵀ K u is off by ε at random, and there are as many as unknowns.
    f64::EPSILON * amplification / (unknowns.max(1) as f64).sqrt() > MOST_LOSS
}

/// Σ|u||K||u| over uᵀ K u for displacements u and the forces K u.
pub(super) fn amplification(k: &SymmetricSparse, u: &[f64], forces: &[f64]) -> f64 {
    let terms: f64 = std::iter::zip(k.times_absolute(u), u).map(|(terms, u)| terms * u.abs()).sum();
    let energy = dot(forces, u).max(f64::EPSILON * terms);
    if terms > 0.0 { terms / energy } else { 0.0 }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    std::iter::zip(a, b).map(|(a, b)| a * b).sum()
}

/// On the motions of loose parts RF is known exactly: uᵀ (Bᵀ RF + F) = 0. Puts that right to the last digit. Of joints that
/// are reached by far less than others `terms` tells the magnitudes: as long as RF is right by these, no joint is changed by more
/// than the rounding of its own. Whether changes may have been larger.
fn balance(
    rf: &mut DVector<f64>,
    rigid: &RigidKernel,
    motions: &[Motion],
    (f, dofs): (&[f64], &Dofs),
    terms: Option<&DVector<f64>>,
) -> bool {
    if motions.is_empty() {
        return false;
    }
    let moved: Vec<Vec<f64>> = motions.iter().map(|motion| dofs.gather(&motion.u)).collect();
    let work = DVector::from_iterator(moved.len(), moved.iter().map(|u| -dot(u, f)));
    let error = rigid.coefficients.transpose() * work - rigid.z.transpose() * &*rf;
    let mut change = &rigid.z * &error;
    let mut is_rounding = false;
    if let Some(terms) = terms {
        let sizes = moved.iter().map(|u| u.iter().zip(f).map(|(u, f)| (u * f).abs()).sum());
        let sizes = DVector::from_iterator(moved.len(), sizes);
        let rounding = rigid.coefficients.abs().transpose() * sizes + rigid.z.abs().transpose() * terms;
        is_rounding = error.iter().zip(&rounding).all(|(error, size)| error.abs() <= ROUNDING * size);
        let swamps = |change: f64, terms: f64| is_rounding && change.abs() > ROUNDING * terms;
        change.zip_apply(terms, |change: &mut f64, terms| {
            if swamps(*change, terms) {
                *change = 0.0;
            }
        });
    }
    *rf += change;
    !is_rounding
}
