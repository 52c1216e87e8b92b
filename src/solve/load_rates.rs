//! Loads that are linear in a parameter, split: what they are now, and what they grow by per unit of it.
//!
//! F(θ) = Σ factor·(F_case(θ₀) + (θ − θ₀) F′_case). F′ is read from the file itself, with the rate of every number in the
//! place of its value, so it is as exact as F; each F′ becomes a case of its own, with factor·(θ − θ₀) as its factor.

use std::sync::Arc;

use super::case::Case;
use super::prepared::{PrepareError, Prepared};
use crate::model::load::{at_values, rates_along};
use crate::model::parameter::Number;
use crate::model::problem::Problems;
use crate::model::scenario::{GivenLoad, Source};
use crate::model::structure::LoadCase;

/// A scenario made ready with its loads and, beside them, their growth.
pub struct LoadRates {
    /// The cases of the scenario as they are at the present values, then one for each case that grows, at factor 0.
    pub prepared: Arc<Prepared>,
    /// For each of the latter: the index of the case that grows.
    pub growing: Vec<usize>,
}

impl Case<'_> {
    /// Splits the loads along a parameter that stands in them.
    ///
    /// # Errors
    /// A number of the loads that is not a linear function of the parameter, with its place; loads that cannot be applied.
    pub fn load_rates(self, parameter: &str) -> Result<LoadRates, PrepareError> {
        let Case { scenario, prepared: here, values, .. } = self;
        let rates = rates_along(scenario, values, parameter).map_err(PrepareError::Problems)?;
        let mut both = at_values(scenario, values).map_err(PrepareError::Problems)?;
        let own = |case: &str| (format!("{case} per {parameter}"), Number::Value(0.0));
        let (mut cases, mut growing) = (here.cases.clone(), Vec::new());
        match (&mut both.source, rates.source) {
            (Source::Structure(structure), Source::Structure(rates)) => {
                for (index, mut case) in rates.load_cases.into_iter().enumerate() {
                    case.loads.retain(|load| !load.is_nothing());
                    if !case.loads.is_empty() {
                        growing.push(index);
                        let (name, factor) = own(&case.name);
                        structure.load_cases.push(LoadCase { name, factor, loads: case.loads });
                    }
                }
            }
            (Source::ContactSystem(system), Source::ContactSystem(rates)) => {
                for (index, load) in rates.loads.into_iter().enumerate() {
                    if load.vector.iter().any(|force| *force != 0.0) {
                        growing.push(index);
                        let (name, factor) = own(&load.name);
                        system.loads.push(GivenLoad { name, factor, vector: load.vector });
                    }
                }
            }
            _ => {}
        }
        cases.extend(growing.iter().map(|&case: &usize| own(&here.cases[case].0)));
        let mut prepared = here.with_loads(&both, values)?.ok_or_else(|| {
            PrepareError::Problems(Problems::of_file(scenario.name.as_str(), "a bare LCP has no loads", ""))
        })?;
        prepared.cases = cases;
        Ok(LoadRates { prepared: Arc::new(prepared), growing })
    }
}
