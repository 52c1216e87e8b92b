//! Parameter values → the numbers of the contact laws and the load.

use nalgebra::DVector;

use super::prepared::Prepared;
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::model::pair::Law;
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
    let m = system.pairs.len();
    let mut numbers = ContactNumbers {
        friction: vec![0.0; m],
        cohesion: vec![0.0; m],
        gap: vec![0.0; m],
        bound: vec![0.0; m],
        load: DVector::zeros(system.joint_count()),
        load_terms: DVector::zeros(system.joint_count()),
        file_load: None,
    };
    for (i, pair) in system.pairs.iter().enumerate() {
        match &pair.law {
            Law::Coulomb { friction, cohesion, gap } => {
                numbers.friction[i] = value(friction);
                numbers.cohesion[i] = value(cohesion);
                numbers.gap[i] = value(gap);
            }
            Law::Frictionless { gap } => numbers.gap[i] = value(gap),
            Law::Bound { bound } => numbers.bound[i] = value(bound),
        }
    }
    for (load, factor) in system.loads.iter().zip(factors) {
        numbers.add_load(*factor, &load.vector, &load.terms);
    }
    numbers.file_load = system.file.as_ref().map(|file| file.load(factors));
    numbers
}
