//! The limit load of a case: factor, safety, how the structure collapses, and what has been proved of it.

use super::load::{LoadEnd, LoadPath, LoadReach, trace};
use super::start::PathError;
use crate::answer::record::Ray;
use crate::explain::ray;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Rules};
use crate::model::scenario::Scenario;
use crate::solve::numbers::factors;
use crate::solve::{PrepareError, Prepared, Solved};
use crate::watch::Watch;

/// The limit is confirmed by independent runs at (1 ± this) of it.
const BESIDE: f64 = 1e-6;

/// What was found about the limit of a load.
#[derive(Clone, Debug)]
pub struct Limit {
    /// The path that led there.
    pub path: LoadPath,
    /// Present factor.
    pub present: f64,
    /// The limit factor; `None` where the path ended otherwise (see [`Limit::end_sentence`]).
    pub factor: Option<f64>,
    /// limit / present, where the present is not 0.
    pub safety: Option<f64>,
    /// The collapse: mode, direction, class and verdict.
    pub collapse: Option<Ray>,
    /// Whether `solve`, with all its retries, finds an answer just below the limit and none just above. A limit of 0 has
    /// no such places.
    pub confirmed: bool,
    /// A factor just beyond the end of the path at which there is an answer all the same: that end is no limit.
    pub beyond: Option<f64>,
}

impl Limit {
    /// How the path ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        let (Some(beyond), Some(last)) = (self.beyond, self.path.factors.last()) else {
            return self.path.end_sentence();
        };
        let name = &self.path.parameter.name;
        // As far again, the lower end of the range first.
        let further = beyond + (beyond - self.path.start);
        let (from, to) = (nine_digits(beyond.min(further)), nine_digits(beyond.max(further)));
        format!(
            "the path ends at {name} = {}, but an answer exists at {name} = {}: not the largest load that can be carried; \
             `find {name} {from}..{to} where outcome answer` looks further",
            nine_digits(*last),
            nine_digits(beyond)
        )
    }
}

/// With nine significant digits, which tell apart what lies [`BESIDE`] from one another.
fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

/// The structure under another value of what is followed.
struct Beside {
    prepared: Prepared,
    factors: Vec<f64>,
}

impl Beside {
    fn new(
        path: &LoadPath,
        prepared: &Prepared,
        scenario: &Scenario,
        values: &ParameterValues,
        value: f64,
        watch: &dyn Watch,
    ) -> Result<Beside, PathError> {
        if !path.moves_loads() {
            let factors = path.case_factors(value);
            return Ok(Beside { prepared: prepared.with_factors(&factors), factors });
        }
        // Where the parameter stands in the loads themselves they are told as they are there.
        let mut values = values.clone();
        values.insert(path.parameter.name.clone(), value);
        let renewed = prepared.renewed(scenario, &values, watch).map_err(|error| match error {
            PrepareError::Interrupted => PathError::Interrupted,
            PrepareError::Problems(problems) => PathError::Missing(problems.to_string()),
        })?;
        let factors = factors(renewed.as_ref().map_or(prepared, |(there, _)| there), &values);
        let prepared =
            renewed.map_or_else(|| prepared.with_factors(&factors), |(there, _)| there.with_factors(&factors));
        Ok(Beside { prepared, factors })
    }

    /// What `solve` finds there.
    fn solve(&self, scenario: &Scenario, values: &ParameterValues, watch: &dyn Watch) -> Result<Solved, PathError> {
        self.prepared.solve_briefly(scenario, values, Rules::default(), watch).map_err(|error| {
            if error.is_interrupted() { PathError::Interrupted } else { PathError::Missing(error.to_string()) }
        })
    }
}

/// Finds the limit of a load case or load parameter from the present answer (from 0 where there is none): upwards, or
/// downwards where the present value is negative.
///
/// # Errors
/// See [`PathError`].
pub fn limit(
    prepared: &Prepared,
    scenario: &Scenario,
    values: &ParameterValues,
    solved: Option<&Solved>,
    name: &str,
    watch: &dyn Watch,
) -> Result<Limit, PathError> {
    let case = prepared.cases.iter().find(|(case, _)| case == name);
    let given = case.map_or_else(|| values.get(name).copied(), |(_, factor)| Some(factor.value(values)));
    let negative = given.is_some_and(|given| given < 0.0);
    let to = negative.then_some(f64::NEG_INFINITY);
    let path = trace(prepared, scenario, values, solved, name, LoadReach { to, through: false }, watch)?;
    let present = path.parameter.present;
    let factor = path.limit();
    let safety = factor.filter(|_| present != 0.0).map(|factor| factor / present);
    let mut limit = Limit { present, factor, safety, collapse: None, confirmed: false, beyond: None, path };
    let (Some(factor), LoadEnd::Limit(direction)) = (factor, &limit.path.end) else {
        return Ok(limit);
    };
    // A limit of 0 has no size of its own.
    let size = [factor.abs(), present.abs()].into_iter().find(|size| *size > 0.0).unwrap_or(1.0);
    let outwards = if to.is_some() { -BESIDE * size } else { BESIDE * size };
    let over = factor + outwards;
    let beside = |value| Beside::new(&limit.path, prepared, scenario, values, value, watch);
    let there = beside(over)?;
    let Some(system) = there.prepared.system() else { return Ok(limit) };
    let above = there.solve(scenario, values, watch)?;
    if above.answer.is_answer() && !above.answer.marginal {
        return Ok(Limit { factor: None, safety: None, beyond: Some(over), ..limit });
    }
    if factor != 0.0 && !above.answer.is_answer() {
        let below = beside(factor - outwards)?.solve(scenario, values, watch)?;
        limit.confirmed = below.answer.is_answer();
    }
    let numbers = limit.path.numbers(over);
    let cases = there.prepared.named_factors(&there.factors);
    let subject = there.prepared.subject(system, &numbers, &cases);
    let mut collapse = ray::look(&subject, limit.path.contact(), direction, 0.0);
    if let Some(found) = &above.ray {
        collapse.class = found.class;
    }
    ray::certify_ray(&mut collapse, &subject);
    ray::explain(&mut collapse, &subject);
    let mut collapse = collapse.record(system, Covering::default());
    collapse.p = 0.0;
    collapse.explanation = format!(
        "At this load the structure is on the point of moving: {}. Beyond it nothing resists that motion.",
        collapse.mode
    );
    limit.collapse = Some(collapse);
    Ok(limit)
}
