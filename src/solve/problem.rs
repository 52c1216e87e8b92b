//! Parameter values → the contact problem.

use std::sync::Arc;

use super::prepared::Prepared;
use crate::contact::law::PairLaw;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::model::parameter::{Number, ParameterValues};

/// The factor of every load case, without a unit.
pub fn factors(prepared: &Prepared, values: &ParameterValues) -> Vec<f64> {
    prepared.cases.iter().map(|(_, factor)| factor.value(values)).collect()
}

/// The laws and Σ factor·RF at some values.
pub fn contact_problem(system: &Arc<ContactSystem>, factors: &[f64], values: &ParameterValues) -> ContactProblem {
    problem_by(system, factors, &|number| number.value(values))
}

/// The same with every number of the laws as `value` reads it.
pub(crate) fn problem_by(
    system: &Arc<ContactSystem>,
    factors: &[f64],
    value: &dyn Fn(&Number) -> f64,
) -> ContactProblem {
    let laws = system.pairs.iter().map(|pair| PairLaw::of(&pair.law, value)).collect();
    ContactProblem::new(system, laws, factors)
}
