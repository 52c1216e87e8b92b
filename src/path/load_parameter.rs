//! What a load path varies: a load case, or a parameter of loads.

use std::sync::Arc;

use nalgebra::DVector;

use super::rate::fixed_place;
use super::start::PathError;
use crate::contact::system::ContactSystem;
use crate::model::jet::Dependence;
use crate::model::scenario::Scenario;
use crate::model::uses::Region;
use crate::solve::error::QuestionError;
use crate::solve::load_rates::LoadRates;
use crate::solve::problem::factors;
use crate::solve::{Case, PrepareError, Prepared};

/// What a load path varies: the factor of a case, or a parameter in which the factors of some cases are affine.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadParameter {
    /// As asked for: the case or the parameter.
    pub name: String,
    /// The cases it drives.
    pub cases: Vec<DrivenCase>,
    /// Its present value.
    pub present: f64,
}

/// A case whose factor is offset + rate · θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivenCase {
    /// Index of the case.
    pub case: usize,
    /// Factor at θ = 0.
    pub offset: f64,
    /// Growth of the factor per unit of θ.
    pub rate: f64,
}

impl LoadParameter {
    /// Finds a case of this name, or the cases that depend on the parameter of this name. Where that stands in the
    /// loads themselves, what they grow by makes cases of its own, and the geometry with those is returned, too.
    ///
    /// # Errors
    /// An unknown name; a parameter that moves something else too, or a load in another way than a + b θ.
    pub(super) fn find(case: Case<'_>, name: &str) -> Result<(LoadParameter, Option<Arc<Prepared>>), PathError> {
        let Case { scenario, prepared, values, .. } = case;
        let system = prepared.system().ok_or(PathError::Plain("trace"))?;
        if let Some(case) = prepared.cases.iter().position(|(known, _)| known == name) {
            let cases = vec![DrivenCase { case, offset: 0.0, rate: 1.0 }];
            let present = prepared.cases[case].1.value(values);
            return Ok((LoadParameter { name: name.to_owned(), cases, present }, None));
        }
        let Some(present) = values.get(name).copied() else {
            return Err(PathError::Unknown { name: name.to_owned(), known: known(prepared, scenario) });
        };
        let mixed = |why: String| PathError::Mixed { name: name.to_owned(), why };
        if let Some(refusal) = values.formula(name).and_then(|_| scenario.refusal(name, present)) {
            return Err(PathError::Target(refusal));
        }
        if let Some(why) = fixed_place(scenario, name) {
            return Err(mixed(why));
        }
        let along = values.along(name);
        let mut at_zero = values.clone();
        at_zero.insert(name.to_owned(), 0.0);
        let mut cases = Vec::new();
        for (case, (known, factor)) in prepared.cases.iter().enumerate() {
            let jet = factor.along(&along);
            match jet.dependence {
                Dependence::Constant => {}
                Dependence::Affine => {
                    cases.push(DrivenCase { case, offset: factor.value(&at_zero), rate: jet.rate });
                }
                Dependence::Nonlinear => {
                    return Err(mixed(format!(
                        "the factor of case {known}, {}, is not a linear function of it: `sweep {name} A..B` varies it",
                        factor.text()
                    )));
                }
            }
        }
        let law = system.pairs.iter().find_map(|pair| {
            let numbers = pair.law.numbers();
            let (what, _) = numbers.into_iter().find(|(_, number)| along.dependence(number) != Dependence::Constant)?;
            Some((what, format!("it is the {what} of pair {}", pair.id)))
        });
        if let Some(("friction", why)) = &law
            && cases.is_empty()
        {
            return Err(PathError::Target(format!(
                "{name} is no load: {why}; `trace {name} to V` follows it, `find least {name} A..B where outcome answer` \
                 brackets where answers begin"
            )));
        }
        if let Some((_, why)) = law {
            let rest = if cases.is_empty() {
                "; only loads and friction can be followed exactly, use `sweep` for the others"
            } else {
                " and the factor of a load case as well; give them parameters of their own"
            };
            return Err(mixed(format!("{why}{rest}")));
        }
        let mut parameter = LoadParameter { name: name.to_owned(), cases, present };
        let grown = parameter.grown(case)?;
        if parameter.cases.is_empty() && grown.is_some() {
            return Err(PathError::Idle(parameter.name));
        }
        if parameter.cases.is_empty() {
            return Err(PathError::Unknown { name: name.to_owned(), known: known(prepared, scenario) });
        }
        Ok((parameter, grown))
    }

    /// Adds the cases that the loads grow by along this parameter, where it stands in them.
    fn grown(&mut self, case: Case<'_>) -> Result<Option<Arc<Prepared>>, PathError> {
        let Case { scenario, prepared, values, .. } = case;
        let Some(place) = scenario.uses.place(&self.name, Region::Amount) else { return Ok(None) };
        let mixed = |why: String| PathError::Mixed { name: self.name.clone(), why };
        let LoadRates { prepared: grown, growing } = case.load_rates(&self.name).map_err(|error| match error {
            PrepareError::Problems(problems) => mixed(match problems.problems.first() {
                Some(first) => format!("{}: {}; {}", first.path, first.message, first.help),
                None => place.to_owned(),
            }),
            PrepareError::Interrupted => PathError::Interrupted,
        })?;
        let mut added = Vec::new();
        for (k, &case) in growing.iter().enumerate() {
            let (known, factor) = &prepared.cases[case];
            if self.cases.iter().any(|driven| driven.case == case) {
                return Err(mixed(format!(
                    "it stands in the loads of case {known} ({place}) and in its factor: their product is not a linear \
                     function of it; `sweep {} A..B` varies it",
                    self.name
                )));
            }
            let rate = factor.value(values);
            added.push(DrivenCase { case: prepared.cases.len() + k, offset: -rate * self.present, rate });
        }
        self.cases.extend(added);
        Ok(Some(grown))
    }

    /// Sets the factors of the cases to their values at θ.
    pub(super) fn drive(&self, factors: &mut [f64], value: f64) {
        for driven in &self.cases {
            factors[driven.case] = driven.offset + driven.rate * value;
        }
    }

    /// RF per unit of it.
    pub(super) fn direction(&self, system: &ContactSystem) -> DVector<f64> {
        self.cases.iter().fold(DVector::zeros(system.joint_count()), |sum: DVector<f64>, driven| {
            sum + driven.rate * &system.loads[driven.case].vector
        })
    }
}

/// The names that `trace` takes.
pub fn known(prepared: &Prepared, scenario: &Scenario) -> String {
    let cases: Vec<&str> = prepared.cases.iter().map(|(name, _)| name.as_str()).collect();
    let free = scenario.parameters.iter().filter(|(_, parameter)| parameter.formula.is_none());
    let parameters: Vec<&str> = free.map(|(name, _)| name.as_str()).collect();
    let mut text =
        if cases.is_empty() { "no load cases".to_owned() } else { format!("load cases {}", cases.join(", ")) };
    if !parameters.is_empty() {
        text.push_str(&format!("; parameters {}", parameters.join(", ")));
    }
    text
}

/// The factors of all load cases at a value of a case or parameter.
pub(super) fn factors_at(case: Case<'_>, name: &str, value: f64) -> Result<Vec<f64>, PathError> {
    let Case { scenario, prepared, values, watch, .. } = case;
    let there = case.at(name, value)?;
    let found = factors(&there.prepared, &there.values);
    if prepared.cases.iter().any(|(known, _)| known == name) {
        return Ok(found);
    }
    let why = |what: &str| PathError::Mixed { name: name.to_owned(), why: what.to_owned() };
    if prepared.renewed(scenario, &there.values, watch).map_err(QuestionError::from)?.is_some() {
        return Err(why("it moves more than the factors of load cases; put it into the factor of one"));
    }
    if factors(prepared, values) == found && values.get(name).is_some_and(|now| *now != value) {
        return Err(why("no factor of a load case depends on it"));
    }
    Ok(found)
}
