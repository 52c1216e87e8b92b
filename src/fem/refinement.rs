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

use super::assembly::{given_entries, on_joints, on_masters};
use super::dof::Dofs;
use super::element::{Slot, slots, spring, stiffness};
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::factor::Factor;
use super::sparse::SymmetricSparse;
use super::watch::check_stop;
use crate::doubled::{Doubled, Real};
use crate::model::structure::{Component, Structure};
use crate::watch::Watch;

/// Conjugate gradients go on until the square of the error's energy norm has fallen to this share of the first, or no
/// longer falls: 1e-24 of the displacements where the preconditioner is good.
const CONVERGED: f64 = 1e-48;

/// Steps without progress after which they end.
const PATIENCE: usize = 8;

/// The largest share that counts as an answer: with a preconditioner off by a factor of 1e16, still 1e-10 of the
/// displacements. What is left is returned and goes into the check of equilibrium.
const ANSWERED: f64 = 1e-36;

/// Far more steps than there are motions that the preconditioner does not know.
const MOST_STEPS: usize = 400;

/// A motion that costs at most this share (squared) of the terms that its energy sums costs nothing: by so much does
/// the rounding of the coordinates strain the elements.
const ROUNDING_STRAIN: f64 = 64.0 * f64::EPSILON;

/// The same of the rows of a given K, of which only the digits of a file are known.
const GIVEN_DIGITS: f64 = 64.0 * f64::EPSILON;

/// Below this share of its terms an energy is beyond what conjugate gradients in doubled precision can resolve.
const UNSOLVABLE: f64 = 1e-22;

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

    /// The factor's answer to K_m v = b, in f64.
    fn precondition(&self, b: &[Doubled]) -> Vec<Doubled> {
        let mut v: Vec<f64> = b.iter().map(|b| b.to_f64()).collect();
        self.factor.solve(&mut v);
        v.into_iter().map(Doubled::from).collect()
    }

    /// K_m⁻¹ b by flexible conjugate gradients (Golub, Ye 1999: the preconditioner, rounded, is not quite symmetric),
    /// and what is left of the energy of the error.
    ///
    /// # Errors
    /// No convergence (`None`); interrupted.
    fn solve(&self, b: &[Doubled], watch: &dyn Watch) -> Result<Option<(Vec<Doubled>, f64)>, MainSystemError> {
        let mut v = vec![Doubled::zero(); b.len()];
        let mut residual = b.to_vec();
        let mut z = self.precondition(&residual);
        let mut rz = dot(&residual, &z);
        let mut direction = z.clone();
        let first = rz;
        let mut best = (rz, v.clone());
        let mut idle = 0;
        for _ in 0..MOST_STEPS {
            if rz.is_nan() || rz <= CONVERGED * first || idle > PATIENCE {
                break;
            }
            check_stop(watch)?;
            let response = self.forces_on_masters(&self.expand(&direction));
            let stiffness = dot(&direction, &response);
            let step = Doubled::from(dot(&residual, &direction) / stiffness);
            for i in 0..v.len() {
                v[i] += step * direction[i];
                residual[i] -= step * response[i];
            }
            z = self.precondition(&residual);
            // Rounding may turn the sign of what is next to nothing.
            rz = dot(&residual, &z).abs();
            idle += 1;
            if rz < best.0 {
                best = (rz, v.clone());
                idle = 0;
            }
            // The new direction is conjugate to the last one, whatever the preconditioner did.
            let turn = Doubled::from(-dot(&z, &response) / stiffness);
            for (d, z) in std::iter::zip(&mut direction, &z) {
                *d = *z + turn * *d;
            }
        }
        let (error, v) = best;
        Ok((error <= ANSWERED * first).then_some((v, error)))
    }

    /// u for Σ F on the base dofs and the dislocations `z`, and what is left of the energy of the error; `None` if it
    /// does not converge.
    ///
    /// # Errors
    /// Interrupted.
    pub fn displacements(
        &self,
        f: &[f64],
        settled: Option<&[f64]>,
        z: &[f64],
        watch: &dyn Watch,
    ) -> Result<Option<(Vec<Doubled>, f64)>, MainSystemError> {
        let nothing = vec![Doubled::zero(); self.elimination.masters()];
        let add_settled = |mut u: Vec<Doubled>| {
            for (u, settled) in std::iter::zip(&mut u, settled.unwrap_or_default()) {
                *u += Doubled::from(*settled);
            }
            u
        };
        let imposed = add_settled(self.elimination.expand(&nothing, z));
        let mut rhs = self.forces_on_masters(&imposed);
        let f: Vec<Doubled> = f.iter().map(|&f| Doubled::from(f)).collect();
        for (rhs, f) in std::iter::zip(&mut rhs, on_masters(self.elimination, &f)) {
            *rhs = f - *rhs;
        }
        let v = self.solve(&rhs, watch)?;
        Ok(v.map(|(v, error)| (add_settled(self.elimination.expand(&v, z)), error)))
    }

    /// Gᵀ (K u − f).
    pub(super) fn joint_forces(&self, u: &[Doubled], f: &[f64]) -> DVector<f64> {
        let mut force = self.k.times(u);
        for (force, f) in std::iter::zip(&mut force, f) {
            *force -= Doubled::from(*f);
        }
        let force = on_joints(self.elimination, &force);
        DVector::from_iterator(force.len(), force.into_iter().map(Real::to_f64))
    }

    /// R; `None` if something does not converge.
    ///
    /// # Errors
    /// Interrupted.
    pub fn stiffness(&self, watch: &dyn Watch) -> Result<Option<DMatrix<f64>>, MainSystemError> {
        let joints = self.elimination.joints();
        let idle = vec![0.0; self.k.order()];
        let mut r = DMatrix::zeros(joints, joints);
        for joint in 0..joints {
            let mut z = vec![0.0; joints];
            z[joint] = 1.0;
            let Some((u, _)) = self.displacements(&idle, None, &z, watch)? else { return Ok(None) };
            r.set_column(joint, &self.joint_forces(&u, &idle));
            let what = format!("condensing to {joints} joints in doubled precision");
            watch.progress(&what, joint as f64 / joints as f64);
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
        let mut rf = Vec::with_capacity(f.len());
        for (f, settled) in std::iter::zip(f, settled) {
            let Some((u, _)) = self.displacements(f, settled.as_deref(), &closed, watch)? else { return Ok(None) };
            rf.push(self.joint_forces(&u, f));
        }
        Ok(Some(rf))
    }

    /// What the motion v that a pivot points to costs; v is freed of everything the structure resists first.
    pub fn judge(&self, structure: &Structure, v: &mut Vec<f64>) -> Verdict {
        let mut motion: Vec<Doubled> = v.iter().map(|&v| Doubled::from(v)).collect();
        for _ in 0..4 {
            let resisted = self.precondition(&self.forces_on_masters(&self.expand(&motion)));
            for (v, resisted) in std::iter::zip(&mut motion, resisted) {
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
        let energy = dot(u, &self.k.times(u));
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

fn dot(a: &[Doubled], b: &[Doubled]) -> f64 {
    std::iter::zip(a, b).fold(Doubled::zero(), |sum, (a, b)| sum + *a * *b).to_f64()
}
