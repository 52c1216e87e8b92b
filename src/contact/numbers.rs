//! The laws of contact and the load under one set of parameter values.

use nalgebra::DVector;

use super::file_data::FileLoad;
use super::law::PairLaw;

/// What changes when a parameter moves; R does not.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactNumbers {
    /// The law of every pair.
    pub laws: Vec<PairLaw>,
    /// Σ factor·RF over the joints.
    pub load: DVector<f64>,
    /// Σ |factor|·magnitude of RF: what `load` was summed from, the measure of its rounding.
    pub load_terms: DVector<f64>,
    /// The same load as the file has it, where the system keeps its file; `None` after another load was put in its place.
    pub file_load: Option<FileLoad>,
}

impl ContactNumbers {
    /// Laws under a load whose entries are exact.
    pub fn exactly(laws: Vec<PairLaw>, load: DVector<f64>) -> ContactNumbers {
        ContactNumbers { laws, load_terms: load.abs(), load, file_load: None }
    }

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

    /// Gap of every pair, that is of the joints from the first on.
    pub fn gaps(&self) -> impl Iterator<Item = f64> {
        self.laws.iter().map(PairLaw::gap)
    }

    /// The same with other gaps, where pairs have one.
    #[must_use]
    pub fn with_gaps(&self, gaps: &[f64]) -> ContactNumbers {
        let laws = self.laws.iter().zip(gaps).map(|(law, gap)| law.with_gap(*gap)).collect();
        ContactNumbers { laws, ..self.clone() }
    }

    /// f of every pair.
    pub fn frictions(&self) -> Vec<f64> {
        self.laws.iter().map(PairLaw::friction).collect()
    }

    /// z − (g, 0): the whole mutual displacement of the joints.
    pub fn dislocation(&self, z: &DVector<f64>) -> DVector<f64> {
        let mut moved = z.clone();
        moved.iter_mut().zip(self.gaps()).for_each(|(z, gap)| *z -= gap);
        moved
    }

    /// The magnitudes of its terms: those of z and of the gaps.
    pub fn dislocation_sizes(&self, mut sizes: DVector<f64>) -> DVector<f64> {
        sizes.iter_mut().zip(self.gaps()).for_each(|(size, gap)| *size += gap.abs());
        sizes
    }
}
