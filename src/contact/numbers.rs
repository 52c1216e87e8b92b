//! The numbers of the contact laws and the load under one set of parameter values.

use nalgebra::DVector;

/// What changes when a parameter moves; R does not.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNumbers {
    /// f per pair; 0 where the law has none.
    pub friction: Vec<f64>,
    /// c per pair; 0 where the law has none.
    pub cohesion: Vec<f64>,
    /// Initial gap g per pair; 0 where the law has none.
    pub gap: Vec<f64>,
    /// Friction bound r_f per pair; 0 where the law has none.
    pub bound: Vec<f64>,
    /// Σ factor·RF over the joints.
    pub load: DVector<f64>,
}
