//! Work of the loads and energy of the structure at given displacements.

use nalgebra::DVector;
use stickslip_numerics::doubled::dot;

use super::assembly::given_entries;
use super::displacements::Displacements;
use super::element::{finite_element, spring};
use super::loads::ActingLoads;
use super::main_system::MainSystem;
use super::recovery::own_displacements;
use crate::doubled::Doubled;
use crate::model::structure::Structure;

/// A state of the structure with what acts on it.
#[derive(Clone, Copy, Debug)]
pub struct Loaded<'a> {
    /// Displacements.
    pub u: &'a Displacements,
    /// Joint forces.
    pub lambda: &'a DVector<f64>,
    /// Factors of the load cases.
    pub factors: &'a [f64],
}

impl MainSystem {
    /// F·u of all load cases under the given factors.
    fn work(&self, factors: &[f64], u: &Displacements) -> f64 {
        let u = self.dofs.gather(&u.0);
        self.f.iter().zip(factors).map(|(f, factor)| factor * f.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>()).sum()
    }

    /// ½ (F_a + F_b)·(u_b − u_a), force · length, > 0 where loads give energy away: the work of the loads, and of the
    /// reactions of supports that settle, from one state to the other, where forces and displacements change linearly.
    pub fn work_between(&self, a: &Loaded<'_>, b: &Loaded<'_>) -> f64 {
        let of_loads = self.work(a.factors, b.u) - self.work(a.factors, a.u) + self.work(b.factors, b.u)
            - self.work(b.factors, a.u);
        let moved = (0..self.dofs.count()).filter(|&dof| self.elimination.settlement(dof).is_some());
        let moved: Vec<usize> = moved.collect();
        if moved.is_empty() {
            return 0.5 * of_loads;
        }
        let [from, to] = [a, b].map(|state| self.dofs.gather(&state.u.0));
        let [first, last] = [a, b].map(|state| self.unbalanced(state.u, state.lambda, state.factors));
        let of_supports: f64 = moved.into_iter().map(|dof| (first[dof] + last[dof]) * (to[dof] - from[dof])).sum();
        0.5 * (of_loads + of_supports)
    }

    /// ½ uᵀ K u ≥ 0, force · length: what K stores at the displacements of the nodes, beside which [`Self::work_between`] is the work
    /// of the nodal forces. Of a load between nodes both leave out the same, what it does to its element while the nodes
    /// stand still; of heat both count what its nodal forces do. So these two balance, and [`Self::strain_energy`] does
    /// with neither.
    pub fn nodal_energy(&self, u: &Displacements) -> f64 {
        0.5 * match &self.doubled {
            None => {
                let u = self.dofs.gather(&u.0);
                std::iter::zip(self.k.times(&u), u).map(|(f, u)| f * u).sum()
            }
            Some(k) => {
                let u = self.dofs.gather(&u.doubled());
                dot(&k.times(&u), &u).to_f64()
            }
        }
    }

    /// Strain energy ≥ 0, force · length, at the displacements `u` under Σ factor·F: of the forces inside all elements, with
    /// what acts between their nodes and without what they do freely; of springs; of a superelement ½ uᵀ K u.
    pub fn strain_energy(&self, structure: &Structure, u: &Displacements, factors: &[f64]) -> f64 {
        let loads = ActingLoads::of(structure, factors);
        let of_element = |index: usize| {
            // One without shape was refused by its stiffness.
            let element = finite_element(structure, index).ok()?;
            Some(element.strain_energy(&own_displacements(structure, index, u), loads.on(index)))
        };
        let of_elements: f64 = (0..structure.elements.len()).filter_map(of_element).sum();
        let of_springs: f64 = structure.springs.iter().map(|one| spring::energy(one, &u.0)).sum();
        of_elements + of_springs + self.given_energy(structure, u)
    }

    /// ½ uᵀ K u of the superelement.
    fn given_energy(&self, structure: &Structure, u: &Displacements) -> f64 {
        if structure.superelement.is_none() {
            return 0.0;
        }
        let u = self.dofs.gather(&u.doubled());
        let mut twice = Doubled::default();
        given_entries(structure, &self.dofs, |row, column, value| {
            let own = u[row] * u[column] * Doubled::from(value);
            twice += if row == column { own } else { own + own };
        });
        0.5 * twice.to_f64()
    }
}
