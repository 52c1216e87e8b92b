//! Work of the loads and strain energy of the structure at given displacements.

use super::doubled::Real;
use super::main_system::{Displacements, MainSystem};
use super::sparse::SymmetricSparse;

impl MainSystem {
    /// F·u of all load cases under the given factors.
    pub fn work(&self, factors: &[f64], u: &Displacements) -> f64 {
        let u = self.dofs.gather(&u.0);
        self.f.iter().zip(factors).map(|(f, factor)| factor * f.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>()).sum()
    }

    /// U = ½ uᵀ K u.
    pub fn strain_energy(&self, u: &Displacements) -> f64 {
        fn half<T: Real>(k: &SymmetricSparse<T>, u: &[T]) -> f64 {
            let force = k.times(u);
            0.5 * std::iter::zip(force, u).fold(T::zero(), |sum, (f, u)| sum + f * *u).to_f64()
        }
        match &self.doubled {
            None => half(&self.k, &self.dofs.gather(&u.0)),
            Some(k) => half(k, &self.dofs.gather(&u.doubled())),
        }
    }
}
