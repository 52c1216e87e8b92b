//! What all finite elements can do.

use nalgebra::DMatrix;

use super::acting::Acting;
use super::bar_load::BarForces;
use crate::doubled::{Doubled, Real};
use crate::model::structure::Material;

/// Stiffness of an element in global axes, rows as in [`slots`](super::slots); forces per displacement.
pub type Stiffness<T = f64> = DMatrix<T>;

/// σ_xx, σ_yy, σ_xy, σ_zz, σ_yz and σ_zx, tension positive; the last two are 0 in the plane.
pub type Stress = [f64; 6];

/// Σ weight × stress.
pub(super) fn weighted(weights: &[f64], stresses: impl Iterator<Item = Stress>) -> Stress {
    let mut sum = Stress::default();
    for (weight, stress) in weights.iter().zip(stresses) {
        sum.iter_mut().zip(stress).for_each(|(sum, value)| *sum += weight * value);
    }
    sum
}

/// Strain energy per volume of a stress in an elastic material: of what changes the shape, and of what changes the volume.
pub(super) fn energy_of_stress(material: &Material, [xx, yy, xy, zz, yz, zx]: Stress) -> f64 {
    let sum = xx + yy + zz;
    let mean = sum / 3.0;
    let of_shape: f64 =
        [xx, yy, zz].iter().map(|direct| (direct - mean).powi(2)).sum::<f64>() + 2.0 * (xy * xy + yz * yz + zx * zx);
    let of_volume = (1.0 - 2.0 * material.poisson_ratio) / (6.0 * material.youngs_modulus);
    of_shape / (4.0 * material.shear_modulus()) + of_volume * sum * sum
}

/// What an element does with displacements and loads. Vectors and matrices have rows as in [`slots`](super::slots).
pub trait FiniteElement {
    /// Stiffness in global axes.
    ///
    /// # Errors
    /// What is wrong with its shape, in words that follow its name.
    fn stiffness(&self) -> Result<Stiffness, &'static str>;

    /// The same in doubled precision.
    ///
    /// # Errors
    /// As [`FiniteElement::stiffness`].
    fn doubled_stiffness(&self) -> Result<Stiffness<Doubled>, &'static str>;

    /// Nodal forces in global axes that stand for what acts; kinds of load that no reader puts on it are ignored.
    fn nodal_forces(&self, acting: &Acting) -> Vec<f64>;

    /// Strain energy for its displacements `u`: of the forces and stresses inside, so that what it does freely costs nothing.
    fn strain_energy(&self, u: &[f64], acting: &Acting) -> f64;

    /// Internal forces of a bar for its displacements `u`.
    fn bar_forces(&self, _u: &[f64], _acting: &Acting) -> Option<BarForces> {
        None
    }

    /// Displacements in global axes of a bar that bends, at these shares of its length from its start (ascending), for
    /// its displacements `u`.
    fn elastic_curve(&self, _u: &[f64], _acting: &Acting, _shares: &[f64]) -> Option<Vec<[f64; 3]>> {
        None
    }

    /// Stress of an area or a solid at its centre for its displacements `u`.
    fn stress(&self, _u: &[f64], _acting: &Acting) -> Option<Stress> {
        None
    }

    /// Stresses of an area or a solid at its nodes for its displacements `u`.
    fn node_stresses(&self, _u: &[f64], _acting: &Acting) -> Option<Vec<Stress>> {
        None
    }
}

pub(super) const NO_LENGTH: &str = "its two nodes are at the same place";

/// A number in which elements can give their stiffness.
pub trait Number: Real {
    /// Stiffness of an element.
    ///
    /// # Errors
    /// What is wrong with its shape.
    fn stiffness(element: &dyn FiniteElement) -> Result<Stiffness<Self>, &'static str>;
}

impl Number for f64 {
    fn stiffness(element: &dyn FiniteElement) -> Result<Stiffness, &'static str> {
        element.stiffness()
    }
}

impl Number for Doubled {
    fn stiffness(element: &dyn FiniteElement) -> Result<Stiffness<Doubled>, &'static str> {
        element.doubled_stiffness()
    }
}
