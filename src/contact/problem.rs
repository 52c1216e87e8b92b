//! A contact problem: the condensed system, the laws of its pairs and its load, under one set of parameter values.

use std::sync::Arc;

use nalgebra::DVector;

use super::file_data::FileLoad;
use super::law::PairLaw;
use super::polygon::Polygon;
use super::system::ContactSystem;
use crate::lcp::exact::scalar::Scalar;
use crate::lcp::problem::NOISE;
use crate::model::rules::{FACETS, Rules};

/// λ = R (z − (g, 0)) + load over the joints, and what the laws demand of λ and z. The system is shared: what changes
/// when a parameter moves is the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactProblem {
    /// R, RF per load case and the pairs.
    pub system: Arc<ContactSystem>,
    /// The law of every pair.
    pub laws: Vec<PairLaw>,
    /// The directions in which pairs slip.
    pub polygon: Polygon,
    /// Whether friction in space is Coulomb's cone, which the polygon stands in for until the end; otherwise it is the
    /// polygon.
    pub cone: bool,
    /// Factor of every load case; empty where the load is not made of the cases.
    pub factors: Vec<f64>,
    /// Σ factor·RF over the joints, forces; a history adds what its committed slips do, R z.
    pub load: DVector<f64>,
    /// Σ |factor|·magnitude of RF: what `load` was summed from, the measure of its rounding.
    pub load_terms: DVector<f64>,
    /// The same load as the file has it, where the system keeps its file; `None` after another load was put in its
    /// place.
    pub file_load: Option<FileLoad>,
}

impl ContactProblem {
    /// The problem under Σ factor·RF.
    pub fn new(system: &Arc<ContactSystem>, laws: Vec<PairLaw>, factors: &[f64]) -> ContactProblem {
        ContactProblem::exactly(system, laws, DVector::zeros(system.joint_count())).with_factors(factors)
    }

    /// The problem under a load whose entries are exact.
    pub fn exactly(system: &Arc<ContactSystem>, laws: Vec<PairLaw>, load: DVector<f64>) -> ContactProblem {
        let polygon = if system.is_in_space() { Polygon::regular(FACETS, 0.0) } else { Polygon::PLANE };
        ContactProblem {
            system: Arc::clone(system),
            laws,
            polygon,
            cone: true,
            factors: Vec::new(),
            load_terms: load.abs(),
            load,
            file_load: None,
        }
    }

    /// The same under other factors of the load cases.
    #[must_use]
    pub fn with_factors(mut self, factors: &[f64]) -> ContactProblem {
        self.load.fill(0.0);
        self.load_terms.fill(0.0);
        for (case, factor) in self.system.loads.iter().zip(factors) {
            self.load += *factor * &case.vector;
            self.load_terms += factor.abs() * &case.terms;
        }
        self.file_load = self.system.file.as_ref().map(|file| file.load(factors));
        self.factors = factors.to_vec();
        self
    }

    /// The same with another polygon, where pairs are in space.
    #[must_use]
    pub fn with_polygon(mut self, polygon: Polygon) -> ContactProblem {
        if self.system.is_in_space() {
            self.polygon = polygon;
        }
        self
    }

    /// The same with the friction of these rules, where pairs are in space.
    #[must_use]
    pub fn under(self, rules: Rules) -> ContactProblem {
        ContactProblem { cone: rules.cone, ..self.with_polygon(Polygon::regular(rules.facets, 0.0)) }
    }

    /// The same with other gaps, where pairs have one.
    #[must_use]
    pub fn with_gaps(mut self, gaps: &[f64]) -> ContactProblem {
        self.laws.iter_mut().zip(gaps).for_each(|(law, gap)| *law = law.with_gap(*gap));
        self
    }

    /// Adds a load that is none of the cases.
    pub fn add_load(&mut self, factor: f64, vector: &DVector<f64>, terms: &DVector<f64>) {
        self.file_load = None;
        self.load += factor * vector;
        self.load_terms += factor.abs() * terms;
    }

    /// Puts a load in place of the present one; its entries count as exact.
    pub fn set_load(&mut self, load: DVector<f64>) {
        self.file_load = None;
        self.load_terms = load.abs();
        self.load = load;
    }

    /// The same with zeros in place of what a condensation leaves of them in the load.
    #[must_use]
    pub fn without_load_noise(mut self) -> ContactProblem {
        if self.system.rounded {
            self.load.zip_apply(&self.load_terms, |entry: &mut f64, terms: f64| {
                if entry.abs() <= NOISE * terms {
                    *entry = 0.0;
                }
            });
        }
        self
    }

    /// g of every pair, that is of the joints from the first on: lengths, < 0 for an interference.
    pub fn gaps(&self) -> impl Iterator<Item = f64> {
        self.laws.iter().map(PairLaw::gap)
    }

    /// f of every pair, without a unit.
    pub fn frictions(&self) -> Vec<f64> {
        self.laws.iter().map(PairLaw::friction).collect()
    }

    /// c of every pair, forces.
    pub fn fixed_bounds(&self) -> Vec<f64> {
        self.laws.iter().map(PairLaw::fixed_bound).collect()
    }

    /// z − (g, 0): the whole mutual displacement of the joints, lengths.
    pub fn dislocation(&self, z: &DVector<f64>) -> DVector<f64> {
        let mut moved = z.clone();
        moved.iter_mut().zip(self.gaps()).for_each(|(z, gap)| *z -= gap);
        moved
    }

    /// The magnitudes of the terms of [`Self::dislocation`]: those of z and of the gaps.
    pub fn dislocation_sizes(&self, mut sizes: DVector<f64>) -> DVector<f64> {
        sizes.iter_mut().zip(self.gaps()).for_each(|(size, gap)| *size += gap.abs());
        sizes
    }

    /// RF − R·(g, 0): the forces in the joints of the main system, gaps closed by force; of joints in force form their
    /// displacements.
    pub fn joint_constants(&self) -> DVector<f64> {
        DVector::from_vec(self.constants_with(&|i, j| self.system.stiffness[(i, j)]))
    }

    /// The same in another number type, with the entries of R from `stiffness`.
    pub fn constants_with<T: Scalar>(&self, stiffness: &dyn Fn(usize, usize) -> T) -> Vec<T> {
        let gaps: Vec<(usize, T)> =
            self.gaps().enumerate().filter(|(_, gap)| *gap != 0.0).map(|(k, gap)| (k, T::from_f64(gap))).collect();
        (0..self.system.joint_count())
            .map(|i| {
                let load = T::from_f64(self.load[i]);
                gaps.iter().fold(load, |sum, (k, gap)| match self.system.is_forced(*k) {
                    false => sum.sub(&stiffness(i, *k).mul(gap)),
                    true if *k == i => sum.add(gap),
                    true => sum,
                })
            })
            .collect()
    }
}
