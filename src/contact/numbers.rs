//! The numbers of the contact laws and the load under one set of parameter values.

use nalgebra::DVector;

use super::file_data::FileLoad;

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
    /// Σ |factor|·magnitude of RF: what `load` was summed from, the measure of its rounding.
    pub load_terms: DVector<f64>,
    /// The same load as the file has it, where the system keeps its file; `None` after another load was put in its place.
    pub file_load: Option<FileLoad>,
}

impl ContactNumbers {
    /// Adds a load.
    pub fn add_load(&mut self, factor: f64, vector: &DVector<f64>, terms: &DVector<f64>) {
        self.file_load = None;
        self.load += factor * vector;
        self.load_terms += factor.abs() * terms;
    }

    /// Puts a load in the place of the present one; its entries count as exact.
    pub fn set_load(&mut self, load: DVector<f64>) {
        self.file_load = None;
        self.load_terms = load.abs();
        self.load = load;
    }
}
