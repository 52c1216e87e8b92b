//! Parameter values → the numbers of the contact laws and the load.

use nalgebra::DVector;

use super::prepared::Prepared;
use crate::contact::law::PairLaw;
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::model::parameter::{Number, ParameterValues};

/// The factor of every load case.
pub fn factors(prepared: &Prepared, values: &ParameterValues) -> Vec<f64> {
    prepared.cases.iter().map(|(_, factor)| factor.value(values)).collect()
}

/// The numbers of the laws and Σ factor·RF.
pub fn contact_numbers(system: &ContactSystem, factors: &[f64], values: &ParameterValues) -> ContactNumbers {
    numbers_by(system, factors, &|number| number.value(values))
}

/// The numbers of the laws, each as `value` reads it, and Σ factor·RF.
pub(crate) fn numbers_by(system: &ContactSystem, factors: &[f64], value: &dyn Fn(&Number) -> f64) -> ContactNumbers {
    let laws = system.pairs.iter().map(|pair| PairLaw::of(&pair.law, value)).collect();
    let mut numbers = ContactNumbers::exactly(laws, DVector::zeros(system.joint_count()));
    for (load, factor) in system.loads.iter().zip(factors) {
        numbers.add_load(*factor, &load.vector, &load.terms);
    }
    numbers.file_load = system.file.as_ref().map(|file| file.load(factors));
    numbers
}
