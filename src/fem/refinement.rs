//! The main system in doubled precision, for structures whose stiffness f64 loses in rounding.
//!
//! A bar of n elements is 1/n⁴ as stiff as its elements: from a few thousand on its own stiffness is below the
//! rounding of the entries of K. So K is assembled from element stiffnesses of 32 digits, and the f64 factor (of a
//! slightly shifted K_m if need be) becomes the preconditioner of conjugate gradients whose residuals are computed
//! with that K. R and RF come from the displacement fields of the single dislocations and loads:
//!
//! ```text
//!     u_j = G e_j − T K_m⁻¹ Tᵀ K G e_j,   R e_j = Gᵀ K u_j,       RF = Gᵀ (K T K_m⁻¹ Tᵀ F − F)
//! ```

use nalgebra::{DMatrix, DVector};
use num_traits::Zero;
use rayon::prelude::*;
use stickslip_numerics::doubled::dot;

use super::assembly::{given_entries, on_joints, on_masters};
use super::descent::{Descent, Solution};
use super::dof::Dofs;
use super::element::{Slot, slots, spring, stiffness};
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::factor::Factor;
use super::sparse::SymmetricSparse;
use super::threads::can_spread_over;
use super::watch::check_stop;
use crate::doubled::{Doubled, Real};
use crate::model::structure::{Component, Structure};
use crate::watch::Watch;

/// Fields that are solved for in step, so that each look at the factor serves all of them.
const IN_STEP: usize = 4;

/// Columns of R between two words about progress.
const COLUMNS: usize = 4 * IN_STEP;

/// A motion that costs at most this share (squared) of the terms that its energy sums costs nothing: by so much does
/// the rounding of the coordinates strain the elements.
const ROUNDING_STRAIN: f64 = 64.0 * f64::EPSILON;

/// The same of the rows of a given K, of which only the digits of a file are known.
const GIVEN_DIGITS: f64 = 64.0 * f64::EPSILON;

/// Below this share of its terms an energy is beyond what conjugate gradients in doubled precision can resolve.
const UNSOLVABLE: f64 = 1e-22;

/// What displacements are asked for.
pub struct Field<'a> {
    /// Σ F on the base dofs.
    pub f: &'a [f64],
    /// S s on the base dofs, where supports settle.
    pub settled: Option<&'a [f64]>,
    /// The dislocations.
    pub z: &'a [f64],
}

/// What a suspect motion turned out to be.
pub enum Verdict {
    /// It costs nothing: a mechanism.
    Mechanism,
    /// It costs something, too little to be computed with.
    Unsolvable,
    /// The structure resists it.
    Resisted,
}

/// K in doubled precision with what is needed to solve with it.
pub struct Refinement<'a> {
    pub dofs: &'a Dofs,
    pub k: &'a SymmetricSparse<Doubled>,
    pub elimination: &'a Elimination,
    pub factor: &'a Factor,
}

impl Refinement<'_> {
    /// Tᵀ K u.
    fn forces_on_masters(&self, u: &[Doubled]) -> Vec<Doubled> {
        on_masters(self.elimination, &self.k.times(u))
    }

    /// T v.
    fn expand(&self, v: &[Doubled]) -> Vec<Doubled> {
        self.elimination.expand(v, &vec![0.0; self.elimination.joints()])
    }

    /// The factor's answers to K_m v = b, in f64.
    fn precondition<'b>(&self, b: impl Iterator<Item = &'b [Doubled]>) -> Vec<Vec<Doubled>> {
        let mut v: Vec<Vec<f64>> = b.map(|b| b.iter().map(|b| b.to_f64()).collect()).collect();
        self.factor.solve_many(&mut v);
        v.into_iter().map(|v| v.into_iter().map(Doubled::from).collect()).collect()
    }

    /// K_m⁻¹ b for every b, and what is left of the energy of the error; `None` if one does not converge.
    ///
    /// # Errors
    /// Interrupted.
    fn solve(&self, right: Vec<Vec<Doubled>>, watch: &dyn Watch) -> Result<Option<Vec<Solution>>, MainSystemError> {
        let z = self.precondition(right.iter().map(Vec::as_slice));
        let mut all: Vec<Descent> = std::iter::zip(right, z).map(|(right, z)| Descent::new(right, z)).collect();
        loop {
            let mut going: Vec<&mut Descent> = all.iter_mut().filter(|descent| descent.goes_on()).collect();
            if going.is_empty() {
                break;
            }
            check_stop(watch)?;
            for descent in &mut going {
                descent.step(self.forces_on_masters(&self.expand(descent.direction())));
            }
            let z = self.precondition(going.iter().map(|descent| descent.residual()));
            std::iter::zip(going, z).for_each(|(descent, z)| descent.turn(z));
        }
        Ok(all.into_iter().map(Descent::solution).collect())
    }

    /// What `take` makes of the displacements of every field and of what is left of the energy of their error; `None` if
    /// one does not converge.
    ///
    /// # Errors
    /// Interrupted.
    fn each<T: Send>(
        &self,
        fields: &[Field],
        watch: &dyn Watch,
        take: impl Fn(&Field, Vec<Doubled>, f64) -> T + Sync,
    ) -> Result<Option<Vec<T>>, MainSystemError> {
        let in_step = |fields: &[Field]| -> Result<Option<Vec<T>>, MainSystemError> {
            let right = fields.iter().map(|field| self.right_side(field)).collect();
            let Some(solutions) = self.solve(right, watch)? else { return Ok(None) };
            let all = std::iter::zip(fields, solutions);
            Ok(Some(all.map(|(field, (v, error))| take(field, self.field(field, &v), error)).collect()))
        };
        // The cuts depend on the number of fields alone, so that the results do not depend on the threads.
        let groups = fields.chunks(fields.len().div_ceil(2).clamp(1, IN_STEP));
        let groups: Vec<_> = if groups.len() > 1 && can_spread_over(self.k.order()) {
            groups.collect::<Vec<_>>().into_par_iter().map(in_step).collect()
        } else {
            groups.map(in_step).collect()
        };
        let mut all = Vec::with_capacity(fields.len());
        for group in groups {
            let Some(group) = group? else { return Ok(None) };
            all.extend(group);
        }
        Ok(Some(all))
    }

    /// T v + G z + S s.
    fn field(&self, field: &Field, v: &[Doubled]) -> Vec<Doubled> {
        let mut u = self.elimination.expand(v, field.z);
        for (u, settled) in std::iter::zip(&mut u, field.settled.unwrap_or_default()) {
            *u += Doubled::from(*settled);
        }
        u
    }

    /// Tᵀ (F − K (G z + S s)).
    fn right_side(&self, field: &Field) -> Vec<Doubled> {
        let mut right = self.forces_on_masters(&self.field(field, &vec![Doubled::zero(); self.elimination.masters()]));
        let f: Vec<Doubled> = field.f.iter().map(|&f| Doubled::from(f)).collect();
        for (right, f) in std::iter::zip(&mut right, on_masters(self.elimination, &f)) {
            *right = f - *right;
        }
        right
    }

    /// u of a field, and what is left of the energy of the error; `None` if it does not converge.
    ///
    /// # Errors
    /// Interrupted.
    pub fn displacements(&self, field: Field, watch: &dyn Watch) -> Result<Option<Solution>, MainSystemError> {
        Ok(self.each(&[field], watch, |_, u, error| (u, error))?.and_then(|mut all| all.pop()))
    }

    /// Gᵀ (K u − F) of every field; `None` if one does not converge.
    ///
    /// # Errors
    /// Interrupted.
    pub fn joint_forces(
        &self,
        fields: &[Field],
        watch: &dyn Watch,
    ) -> Result<Option<Vec<DVector<f64>>>, MainSystemError> {
        self.each(fields, watch, |field, u, _| {
            let mut force = self.k.times(&u);
            for (force, f) in std::iter::zip(&mut force, field.f) {
                *force -= Doubled::from(*f);
            }
            let force = on_joints(self.elimination, &force);
            DVector::from_iterator(force.len(), force.into_iter().map(Real::to_f64))
        })
    }

    /// R; `None` if something does not converge.
    ///
    /// # Errors
    /// Interrupted.
    pub fn stiffness(&self, watch: &dyn Watch) -> Result<Option<DMatrix<f64>>, MainSystemError> {
        let joints = self.elimination.joints();
        let idle = vec![0.0; self.k.order()];
        let mut r = DMatrix::zeros(joints, joints);
        for first in (0..joints).step_by(COLUMNS) {
            let columns = COLUMNS.min(joints - first);
            let single = DMatrix::from_fn(joints, columns, |i, j| f64::from(i == first + j));
            let fields: Vec<Field> =
                single.as_slice().chunks(joints).map(|z| Field { f: &idle, settled: None, z }).collect();
            let Some(forces) = self.joint_forces(&fields, watch)? else { return Ok(None) };
            for (j, force) in forces.iter().enumerate() {
                r.set_column(first + j, force);
            }
            let what = format!("condensing to {joints} joints in doubled precision");
            watch.progress(&what, (first + columns) as f64 / joints as f64);
        }
        Ok(Some((&r + r.transpose()) * 0.5))
    }

    /// RF of every load in `f`; `None` if something does not converge.
    ///
    /// # Errors
    /// Interrupted.
    pub fn loads(
        &self,
        f: &[Vec<f64>],
        settled: &[Option<Vec<f64>>],
        watch: &dyn Watch,
    ) -> Result<Option<Vec<DVector<f64>>>, MainSystemError> {
        let closed = vec![0.0; self.elimination.joints()];
        let fields = std::iter::zip(f, settled);
        let fields: Vec<Field> = fields.map(|(f, s)| Field { f, settled: s.as_deref(), z: &closed }).collect();
        self.joint_forces(&fields, watch)
    }

    /// What the motion v that a pivot points to costs; v is freed of everything the structure resists first.
    pub fn judge(&self, structure: &Structure, v: &mut Vec<f64>) -> Verdict {
        let mut motion: Vec<Doubled> = v.iter().map(|&v| Doubled::from(v)).collect();
        for _ in 0..4 {
            let forces = self.forces_on_masters(&self.expand(&motion));
            let resisted = self.precondition(std::iter::once(forces.as_slice()));
            for (v, resisted) in std::iter::zip(&mut motion, resisted.into_iter().flatten()) {
                *v -= resisted;
            }
            let largest = motion.iter().fold(0.0_f64, |m, v| m.max(v.to_f64().abs()));
            if !(largest > 0.0 && largest.is_finite()) {
                return Verdict::Resisted;
            }
            motion.iter_mut().for_each(|v| *v /= Doubled::from(largest));
        }
        *v = motion.iter().map(|v| v.to_f64()).collect();
        self.cost(structure, &self.expand(&motion))
    }

    /// What the displacements `u` cost. Nothing, if they strain no element more than the rounding of its coordinates
    /// does; too little to compute with, if their energy drowns in the terms that it sums.
    pub fn cost(&self, structure: &Structure, u: &[Doubled]) -> Verdict {
        let nodal = self.dofs.scatter(u);
        let largest = |components: [Component; 3]| {
            let values = nodal.iter().flat_map(|u| components.iter().map(|&c| u[c as usize].to_f64().abs()));
            values.fold(0.0, f64::max)
        };
        let size = [largest(Component::TRANSLATIONS), largest(Component::ROTATIONS)];
        let allowed = ROUNDING_STRAIN * ROUNDING_STRAIN;
        let mut strained = false;
        each_stiffness(structure, |slots, k| {
            let own: Vec<Doubled> = slots.iter().map(|&(node, component)| nodal[node][component as usize]).collect();
            let scale: Vec<f64> =
                slots.iter().map(|&(_, component)| size[usize::from(component.is_rotation())]).collect();
            let (mut energy, mut terms) = (Doubled::zero(), 0.0);
            for i in 0..own.len() {
                for j in 0..own.len() {
                    energy += own[i] * k(i, j) * own[j];
                    terms += scale[i] * k(i, j).to_f64().abs() * scale[j];
                }
            }
            strained |= energy.to_f64() > allowed * terms;
        });
        strained |= self.strains_superelement(structure, u);
        if !strained {
            return Verdict::Mechanism;
        }
        let energy = dot(u, &self.k.times(u)).to_f64();
        let rounded: Vec<f64> = u.iter().map(|u| u.to_f64()).collect();
        let terms: f64 = self.k.times_absolute(&rounded).iter().zip(&rounded).map(|(f, u)| f * u.abs()).sum();
        if energy <= UNSOLVABLE * terms { Verdict::Unsolvable } else { Verdict::Resisted }
    }
}

impl Refinement<'_> {
    /// Whether a superelement resists the displacements by more than its own digits tell from nothing.
    fn strains_superelement(&self, structure: &Structure, u: &[Doubled]) -> bool {
        let (mut forces, mut terms) = (vec![Doubled::zero(); u.len()], vec![0.0; u.len()]);
        given_entries(structure, self.dofs, |row, column, value| {
            let mut add = |row: usize, column: usize| {
                let term = Doubled::from(value) * u[column];
                forces[row] += term;
                terms[row] += term.to_f64().abs();
            };
            add(row, column);
            if row != column {
                add(column, row);
            }
        });
        forces.iter().zip(&terms).any(|(force, terms)| force.to_f64().abs() > GIVEN_DIGITS * terms)
    }
}

/// Calls `visit(slots, k)` with every element and spring; those without stiffness were refused before.
fn each_stiffness(structure: &Structure, mut visit: impl FnMut(&[Slot], &dyn Fn(usize, usize) -> Doubled)) {
    let rigid = structure.rigid_elements();
    for (index, element) in structure.elements.iter().enumerate().filter(|(index, _)| !rigid[*index]) {
        if let Ok(k) = stiffness::<Doubled>(structure, index) {
            visit(&slots(element), &|i, j| k[(i, j)]);
        }
    }
    for spring in &structure.springs {
        let slots: Vec<Slot> = spring.terms.iter().map(|term| (term.node, term.component)).collect();
        visit(&slots, &|i, j| spring::stiffness(spring, i, j));
    }
}
