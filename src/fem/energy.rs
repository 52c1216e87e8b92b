//! Work of the loads and strain energy of the structure at given displacements.

use super::main_system::{Displacements, MainSystem};

impl MainSystem {
    /// F·u of all load cases under the given factors.
    pub fn work(&self, factors: &[f64], u: &Displacements) -> f64 {
        let u = self.dofs.gather(&u.0);
        self.f.iter().zip(factors).map(|(f, factor)| factor * f.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>()).sum()
    }

    /// U = ½ uᵀ K u.
    pub fn strain_energy(&self, u: &Displacements) -> f64 {
        let u = self.dofs.gather(&u.0);
        let force = self.k.times(&u);
        0.5 * force.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>()
    }
}
