//! Equilibrium of an answer, node by node, from K itself and nothing condensed.
//!
//! ```text
//!     r = K u − F − Bᵀ λ on every component that no support holds (ties summed, rigid bodies as a whole)
//!     |r_i| ≤ TOL · s_i + ρ_i
//!     s_i   the forces that meet there: of each element, of the loads, of the joints
//!     ρ_i   what rounding leaves: 4 ε Σ_k |K_ik||u_k|, with ε² where K and u are in doubled precision (|u_k|: of the terms
//!           that u_k is the sum of, u = T v + G z + S s); where conjugate gradients ended; and the rounding of
//!           λ = R z + RF where a joint acts
//! ```

use nalgebra::DVector;

use super::displacements::Displacements;
use super::element::{slots, spring, stiffness};
use super::main_system::MainSystem;
use super::recovery::own_displacements;
use super::threads::each_element;
use crate::doubled::Real;
use crate::model::pair::Joint;
use crate::model::structure::{Component, Structure};
use crate::model::vector::{distance, length};

/// The share of the forces at a node that an answer may leave unbalanced.
const TOLERANCE: f64 = 1e-9;

/// Roundings in the sum of a row of K u: of the stiffness, of u, of the product and of the sum.
const ROW: f64 = 4.0 * f64::EPSILON;

/// The same in doubled precision.
const DOUBLED_ROW: f64 = 4.0 * f64::EPSILON * f64::EPSILON;

/// The same of a row of R z with z from an LCP (method §4, "Zero").
const JOINT_ROW: f64 = 64.0 * f64::EPSILON;

/// States that share each look at K.
const TOGETHER: usize = 8;

/// A state whose equilibrium is asked for.
pub struct BalancedState<'a> {
    /// Factor of each load case.
    pub factors: &'a [f64],
    /// Mutual displacements of all joints.
    pub dislocation: DVector<f64>,
    /// The magnitudes of the terms that each of these is the sum of.
    pub terms: DVector<f64>,
    /// Joint forces λ.
    pub force: &'a DVector<f64>,
    /// Of forces that were chosen among those that self-stress leaves free the magnitudes of their terms, 0 of the others.
    pub shared: Option<DVector<f64>>,
}

impl BalancedState<'_> {
    fn joint_terms(&self) -> JointTerms<'_> {
        JointTerms { dislocations: Some(&self.terms), shared: self.shared.as_ref() }
    }
}

/// The magnitudes of the terms that numbers of the joints are sums of: what cancels leaves their rounding, however small it
/// is.
#[derive(Clone, Copy, Default)]
pub struct JointTerms<'a> {
    /// Of the mutual displacements of all joints.
    pub dislocations: Option<&'a DVector<f64>>,
    /// Of forces that were chosen among those that self-stress leaves free, 0 of the others.
    pub shared: Option<&'a DVector<f64>>,
}

/// The largest residual relative to the forces that meet there and to what rounding may leave.
fn largest_share(residual: &[f64], scale: &[f64], rounding: &[f64]) -> f64 {
    let shares = residual.iter().zip(scale.iter().zip(rounding)).map(|(r, (scale, rounding))| {
        let size = scale + rounding / TOLERANCE;
        // A force where none can be is infinitely wrong; NaN stays NaN.
        if *r == 0.0 { 0.0 } else { r.abs() / size }
    });
    shares.fold(0.0, |largest: f64, share| if share.is_nan() { f64::NAN } else { largest.max(share) })
}

impl MainSystem {
    /// Nodal forces K u − F − Bᵀ λ on the base dofs without those inside rigid bodies: what supports and ties have to
    /// give.
    pub(super) fn unbalanced(&self, u: &Displacements, lambda: &DVector<f64>, factors: &[f64]) -> Vec<f64> {
        match &self.doubled {
            None => self.minus_loads(self.k.times(&self.dofs.gather(&u.0)), lambda, factors),
            Some(k) => self.minus_loads(k.times(&self.dofs.gather(&u.doubled())), lambda, factors),
        }
    }

    /// forces − Σ factor·F − Bᵀ λ, and without the forces inside rigid bodies.
    fn minus_loads<T: Real>(&self, mut forces: Vec<T>, lambda: &DVector<f64>, factors: &[f64]) -> Vec<f64> {
        for (f, factor) in std::iter::zip(&self.f, factors) {
            for (force, f) in std::iter::zip(&mut forces, f) {
                *force -= T::from(*factor) * T::from(*f);
            }
        }
        for (joint, lambda) in std::iter::zip(&self.all_joints, lambda.iter()) {
            self.each_term(joint, |dof, a| forces[dof] -= T::from(a) * T::from(*lambda));
        }
        self.elimination.take_out_body_forces(&mut forces);
        forces.into_iter().map(Real::to_f64).collect()
    }

    /// Calls `visit(dof, a)` with the terms of a row of B.
    pub(super) fn each_term(&self, joint: &Joint, mut visit: impl FnMut(usize, f64)) {
        for (node, a) in &joint.terms {
            for (component, a) in std::iter::zip(Component::TRANSLATIONS, a) {
                if let Some(dof) = self.dofs.of(*node, component) {
                    visit(dof, *a);
                }
            }
        }
    }

    /// Sums over ties, then zero where a support holds.
    fn unheld(&self, mut values: Vec<f64>) -> Vec<f64> {
        for dof in 0..values.len() {
            let class = self.elimination.class(dof);
            if class != dof {
                values[class] += std::mem::take(&mut values[dof]);
            }
        }
        for (dof, value) in values.iter_mut().enumerate() {
            if self.elimination.is_held(dof) {
                *value = 0.0;
            }
        }
        values
    }

    /// An upper bound of the compatibility and equilibrium residuals of each state, from displacements that are not
    /// shown: 1e-9 or less where the residuals are. Where rounding alone explains what is left at every node, the
    /// forces that meet there need not be known; elsewhere both are computed as for an answer that is shown.
    pub fn equilibrium_bounds(&self, structure: &Structure, states: &[BalancedState<'_>]) -> Vec<f64> {
        if self.doubled.is_some() {
            let bound = |state: &BalancedState<'_>| {
                let u = self.displacements(state.factors, &state.dislocation);
                self.residuals(structure, state, &u)
            };
            return states.iter().map(bound).collect();
        }
        let independent: Vec<(&[f64], DVector<f64>)> =
            states.iter().map(|state| (state.factors, self.of_independent(&state.dislocation))).collect();
        let found = self.unrefined_displacements(&independent);
        let mut bounds = Vec::with_capacity(states.len());
        for (states, found) in states.chunks(TOGETHER).zip(found.chunks(TOGETHER)) {
            let summed = match found {
                [_] => self.forces_with_terms::<1>(found),
                _ => self.forces_with_terms::<TOGETHER>(found),
            };
            bounds.extend(states.iter().zip(found).zip(summed).map(|((state, u), summed)| {
                let bound = self.unexplained(state, u, summed);
                if bound <= TOLERANCE { bound } else { self.refined_bound(structure, state) }
            }));
        }
        bounds
    }

    /// The same of one state from refined displacements, and only if rounding does not explain what they leave either,
    /// from the forces that meet.
    fn refined_bound(&self, structure: &Structure, state: &BalancedState<'_>) -> f64 {
        let u = [self.plain_displacements(state.factors, &self.of_independent(&state.dislocation))];
        let summed = self.forces_with_terms::<1>(&u).swap_remove(0);
        let bound = self.unexplained(state, &u[0], summed);
        if bound <= TOLERANCE {
            return bound;
        }
        self.residuals(structure, state, &Displacements::from(self.dofs.scatter(&u[0])))
    }

    /// The residuals of compatibility and equilibrium as for an answer that is shown.
    fn residuals(&self, structure: &Structure, state: &BalancedState<'_>, u: &Displacements) -> f64 {
        self.compatibility_residual(u, &state.dislocation, &state.terms)
            + self.equilibrium_residual(structure, u, &state.joint_terms(), state.force, state.factors)
    }

    /// K u and Σ_k |K_ik||u_k| of each of up to N displacements of the base dofs.
    fn forces_with_terms<const N: usize>(&self, fields: &[Vec<f64>]) -> Vec<[Vec<f64>; 2]> {
        let at = |dof: usize| std::array::from_fn(|k| fields.get(k).map_or(0.0, |u| u[dof]));
        let side_by_side: Vec<[f64; N]> = (0..self.dofs.count()).map(at).collect();
        let both = self.k.times_with_terms(&side_by_side);
        (0..fields.len()).map(|k| [0, 1].map(|which| both.iter().map(|row| row[which][k]).collect())).collect()
    }

    /// The compatibility residual of a state, and the largest force that is left, as a share of 1e9 times what rounding
    /// may leave.
    fn unexplained(&self, state: &BalancedState<'_>, u: &[f64], [forces, mut terms]: [Vec<f64>; 2]) -> f64 {
        if self.settled.iter().any(Option::is_some) {
            terms = self.k.times_absolute(&self.sizes(u, state.factors, Some(&state.terms)));
        }
        let residual = self.unheld(self.minus_loads(forces, state.force, state.factors));
        let rounding = self.rounding_of(u, &terms, 0.0, state.factors, Some(&state.terms));
        let rounding = self.handed_on(self.with_shared(rounding, state.shared.as_ref()));
        let nothing = vec![0.0; residual.len()];
        let bound = largest_share(&residual, &nothing, &rounding);
        if self.repeated.is_empty() {
            return bound;
        }
        let u = Displacements::from(self.dofs.scatter(u));
        bound + self.compatibility_residual(&u, &state.dislocation, &state.terms)
    }

    /// Magnitudes summed over ties and bodies, zero where a support holds.
    fn handed_on(&self, mut magnitudes: Vec<f64>) -> Vec<f64> {
        self.elimination.add_body_forces(&mut magnitudes);
        self.unheld(magnitudes)
    }

    /// Largest |K u − F − Bᵀ λ| of a component that no support holds, relative to the forces that meet there, in the
    /// sense of this module: at most 1e-9 if every node is balanced.
    pub fn equilibrium_residual(
        &self,
        structure: &Structure,
        u: &Displacements,
        terms: &JointTerms<'_>,
        lambda: &DVector<f64>,
        factors: &[f64],
    ) -> f64 {
        let residual = self.unheld(self.unbalanced(u, lambda, factors));
        let scale = self.handed_on(self.meeting_forces(structure, u, lambda, factors));
        let rounding = self.handed_on(self.with_shared(self.rounding(u, factors, terms.dislocations), terms.shared));
        largest_share(&residual, &scale, &rounding)
    }

    /// What rounding may leave of each row with that of forces that are shared.
    fn with_shared(&self, mut rows: Vec<f64>, shared: Option<&DVector<f64>>) -> Vec<f64> {
        let Some(shared) = shared else { return rows };
        for (joint, terms) in std::iter::zip(&self.all_joints, shared.iter()) {
            self.each_term(joint, |dof, a| rows[dof] += JOINT_ROW * (a * terms).abs());
        }
        rows
    }

    /// Σ |force| that elements, springs, loads and joints bring to each component: of translations the lengths of the
    /// forces (a direction is right to rounding), of rotations the moments and the forces with the element as their lever.
    fn meeting_forces(
        &self,
        structure: &Structure,
        u: &Displacements,
        lambda: &DVector<f64>,
        factors: &[f64],
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.dofs.count()];
        let rigid = structure.rigid_elements();
        let elements = (0..structure.elements.len()).filter(|&index| !rigid[index]);
        let forces = |index| element_forces(structure, index, u);
        let Ok(()) = each_element(elements, forces, |index, forces| {
            self.add_element(structure, index, &forces, &mut sums);
            Ok::<(), std::convert::Infallible>(())
        });
        self.add_superelement(structure, u, &mut sums);
        for spring in &structure.springs {
            // Along a unit vector: its force is the length of its components.
            let force = spring::force(spring, &u.0).abs();
            for term in &spring.terms {
                if let Some(dof) = self.dofs.of(term.node, term.component) {
                    sums[dof] += force;
                }
            }
        }
        for (f, factor) in std::iter::zip(&self.f, factors) {
            self.add_loads(structure.nodes.len(), f, factor.abs(), &mut sums);
        }
        for (joint, lambda) in std::iter::zip(&self.all_joints, lambda.iter()) {
            for (node, a) in &joint.terms {
                let force = length(*a) * lambda.abs();
                Component::TRANSLATIONS
                    .iter()
                    .filter_map(|c| self.dofs.of(*node, *c))
                    .for_each(|dof| sums[dof] += force);
            }
        }
        sums
    }

    /// Adds `factor` times the lengths of the nodal forces and moments `f` of a load case.
    fn add_loads(&self, nodes: usize, f: &[f64], factor: f64, sums: &mut [f64]) {
        for node in 0..nodes {
            let of = |component: Component| self.dofs.of(node, component).map_or(0.0, |dof| f[dof]);
            let sizes = [Component::TRANSLATIONS, Component::ROTATIONS].map(|kind| length(kind.map(of)));
            for component in Component::ALL {
                if let Some(dof) = self.dofs.of(node, component) {
                    sums[dof] += factor * sizes[usize::from(component.is_rotation())];
                }
            }
        }
    }

    /// Adds what the other nodes of a superelement do to each of its rows as they move against the node of the row.
    fn add_superelement(&self, structure: &Structure, u: &Displacements, sums: &mut [f64]) {
        let Some(element) = &structure.superelement else { return };
        for &(i, j, k) in &element.entries {
            for (row, column) in if i == j { vec![(i, i)] } else { vec![(i, j), (j, i)] } {
                let ((own, component), (other, moved)) = (element.dofs[row], element.dofs[column]);
                let with = if moved.is_rotation() { 0.0 } else { u.0[own][moved as usize] };
                if let Some(dof) = self.dofs.of(own, component) {
                    sums[dof] += (k * (u.0[other][moved as usize] - with)).abs();
                }
            }
        }
    }

    /// Adds the nodal forces of one element to the sums of magnitudes.
    fn add_element(&self, structure: &Structure, index: usize, forces: &[f64], sums: &mut [f64]) {
        let element = &structure.elements[index];
        let slots = slots(element);
        let place = |at: usize| structure.nodes[element.nodes[at]].position;
        let lever = distance(place(0), place(1));
        for &node in &element.nodes {
            let of = |wanted: Component| {
                let found = slots.iter().position(|slot| *slot == (node, wanted));
                found.map_or(0.0, |at| forces[at])
            };
            let force = length(Component::TRANSLATIONS.map(of));
            let moment = length(Component::ROTATIONS.map(of));
            for component in Component::ALL {
                let amount = if component.is_rotation() { moment + force * lever } else { force };
                if let Some(dof) = self.dofs.of(node, component) {
                    sums[dof] += amount;
                }
            }
        }
    }

    /// The magnitudes of the terms that u is the sum of: those of a node that follows a joint may cancel (one at rest where
    /// a gap opens by all that the other side moves), and what supports that settle add.
    fn sizes(&self, base: &[f64], factors: &[f64], dislocations: Option<&DVector<f64>>) -> Vec<f64> {
        let mut sizes = self.elimination.sizes(base, &self.dislocation_sizes(base, dislocations));
        for (size, settled) in std::iter::zip(&mut sizes, self.settlement(factors).into_iter().flatten()) {
            *size += settled.abs();
        }
        sizes
    }

    /// |B u| of the independent joints, or of the terms that are known of them, whichever is more: a gap that is open by all
    /// of itself moves nothing, and is a difference all the same.
    fn dislocation_sizes(&self, base: &[f64], dislocations: Option<&DVector<f64>>) -> Vec<f64> {
        let size = |(index, joint): (usize, &Joint)| {
            let mut z = 0.0;
            self.each_term(joint, |dof, a| z += a * base[dof]);
            dislocations.map_or(0.0, |terms| terms[self.independent[index]]).max(z.abs())
        };
        self.joints.iter().enumerate().map(size).collect()
    }

    /// What rounding may leave of each row; `dislocations`: the magnitudes of the terms of those of all joints, where they are
    /// known.
    pub(super) fn rounding(&self, u: &Displacements, factors: &[f64], dislocations: Option<&DVector<f64>>) -> Vec<f64> {
        let base = self.dofs.gather(&u.0);
        let terms = self.k.times_absolute(&self.sizes(&base, factors, dislocations));
        self.rounding_of(&base, &terms, u.1.as_ref().map_or(0.0, |tail| tail.error), factors, dislocations)
    }

    /// The same from u on the base dofs, the terms Σ_k |K_ik||u_k| of each row, and what is left of the energy of the
    /// error of u.
    fn rounding_of(
        &self,
        base: &[f64],
        terms: &[f64],
        error: f64,
        factors: &[f64],
        dislocations: Option<&DVector<f64>>,
    ) -> Vec<f64> {
        // λ is as good as R and RF, and R and RF as good as the energies they come from.
        let root = |joint: usize| self.r[(joint, joint)].max(0.0).sqrt();
        let sizes = self.dislocation_sizes(base, dislocations);
        let dislocation: f64 = sizes.iter().enumerate().map(|(index, size)| root(index) * size).sum();
        let row = if self.doubled.is_some() { DOUBLED_ROW } else { ROW };
        let mut rows: Vec<f64> = terms.iter().map(|terms| row * terms).collect();
        if error > 0.0 {
            // r_i² ≤ K_ii · rᵀ K⁻¹ r: what is left of the energy of the error tells what is left of each row.
            let unsolved = 2.0 * error.sqrt();
            std::iter::zip(&mut rows, self.k.diagonal()).for_each(|(row, k)| *row += unsolved * k.sqrt());
        }
        let field = std::iter::zip(terms, base).map(|(terms, u)| terms * u.abs()).sum::<f64>().sqrt();
        // Balancing RF on the motions of the kernel spreads its rounding over all joints that feel them, also that of
        // joints that do not: they enter with the rounding of Z, whose columns are of length one.
        let loads: Vec<f64> = (0..self.joints.len())
            .map(|joint| std::iter::zip(&self.rf, factors).map(|(rf, factor)| (rf[joint] * factor).abs()).sum())
            .collect();
        let spread: f64 = loads.iter().sum();
        for (index, joint) in self.joints.iter().enumerate() {
            let balanced = spread * self.z.row(index).iter().map(|z| z.abs()).sum::<f64>();
            let rounded = JOINT_ROW * (root(index) * dislocation + loads[index] + balanced)
                + row * self.amplification.sqrt() * root(index) * field;
            self.each_term(joint, |dof, a| rows[dof] += a.abs() * rounded);
        }
        rows
    }
}

/// k u of one element, rows as in [`slots`]; zeros if it has no stiffness.
fn element_forces(structure: &Structure, index: usize, u: &Displacements) -> Vec<f64> {
    let own = own_displacements(structure, index, u);
    let Ok(k) = stiffness::<f64>(structure, index) else {
        return vec![0.0; own.len()];
    };
    (0..own.len()).map(|i| own.iter().enumerate().map(|(j, u)| k[(i, j)] * u).sum()).collect()
}
