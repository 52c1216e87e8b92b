//! The numbers of a contact system under the present parameter values.

use nalgebra::DVector;

/// Numbers of the laws, one entry per pair (0 where the law has no such number), and the total load.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNumbers {
    /// Friction coefficient f ≥ 0.
    pub friction: Vec<f64>,
    /// Cohesion c ≥ 0, a force.
    pub cohesion: Vec<f64>,
    /// Initial gap g ≥ 0, a length.
    pub gap: Vec<f64>,
    /// Known friction bound r_f ≥ 0, a force.
    pub bound: Vec<f64>,
    /// Σ factor·RF over the joints.
    pub load: DVector<f64>,
}
