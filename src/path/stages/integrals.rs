//! What belongs to the way from one moment of a history to the next and not to its ends.

use nalgebra::DVector;

use crate::contact::system::ContactSystem;

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Integrals {
    /// ∫ z dt over the joints; of a moment that is recorded, the mean of z.
    pub(super) z: DVector<f64>,
    /// The same of λ.
    pub(super) force: DVector<f64>,
    /// −∫ x_τ dz_τ.
    pub(super) dissipated: f64,
}

impl Integrals {
    /// Of a straight way, its ends z and λ.
    pub(super) fn straight(
        length: f64,
        [a, b]: [&DVector<f64>; 2],
        forces: [&DVector<f64>; 2],
        system: &ContactSystem,
    ) -> Integrals {
        let half = 0.5 * length;
        Integrals {
            z: (a + b) * half,
            force: (forces[0] + forces[1]) * half,
            dissipated: dissipated([a, b], forces, system),
        }
    }

    /// This way and another after it.
    pub(super) fn plus(&self, other: &Integrals) -> Integrals {
        Integrals {
            z: &self.z + &other.z,
            force: &self.force + &other.force,
            dissipated: self.dissipated + other.dissipated,
        }
    }
}

/// −Σ ½ (x_τa + x_τb) Δz_τ between two places with forces and slips affine between them.
pub(super) fn dissipated([a, b]: [&DVector<f64>; 2], forces: [&DVector<f64>; 2], system: &ContactSystem) -> f64 {
    let joints = system.pairs.iter().flat_map(|pair| pair.tangential.clone());
    joints.map(|joint| -0.5 * (forces[0][joint] + forces[1][joint]) * (b[joint] - a[joint])).sum()
}
