//! Work of the loads and strain energy of the structure at given displacements.

use nalgebra::DVector;
use stickslip_numerics::doubled::dot;

use super::displacements::Displacements;
use super::main_system::MainSystem;

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

    /// U = ½ uᵀ K u ≥ 0, force · length.
    pub fn strain_energy(&self, u: &Displacements) -> f64 {
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
}
