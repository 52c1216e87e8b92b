//! The limit load of a case: factor, safety, how the structure collapses, and what has been proved of it.

use super::load::{LoadEnd, LoadPath, LoadReach, trace};
use super::start::{PathError, cold};
use crate::answer::record::Ray;
use crate::explain::ray;
use crate::model::parameter::ParameterValues;
use crate::model::rules::Covering;
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
    /// The limit factor; `None` where the path ended otherwise (see `path.end`).
    pub factor: Option<f64>,
    /// limit / present, where both have the same sign and the present is not 0.
    pub safety: Option<f64>,
    /// The collapse: mode, direction, class and verdict.
    pub collapse: Option<Ray>,
    /// Whether a run of its own finds an answer just below the limit and none just above.
    pub confirmed: bool,
}

/// The scenario made ready for another value of a parameter, and the factors of its cases there.
fn at(
    prepared: &Prepared,
    scenario: &Scenario,
    values: &ParameterValues,
    name: &str,
    value: f64,
    watch: &dyn Watch,
) -> Result<(Prepared, Vec<f64>), PathError> {
    let mut values = values.clone();
    values.insert(name.to_owned(), value);
    let renewed = prepared.renewed(scenario, &values, watch).map_err(|error| match error {
        PrepareError::Interrupted => PathError::Interrupted,
        PrepareError::Problems(problems) => PathError::Missing(problems.to_string()),
    })?;
    let there = renewed.map_or_else(|| prepared.with_factors(&factors(prepared, &values)), |(there, _)| there);
    let factors = factors(&there, &values);
    Ok((there, factors))
}

/// Finds the limit of a load case or load parameter, upwards from the present answer (from 0 where there is none).
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
    let reach = LoadReach { to: None, through: false };
    let path = trace(prepared, scenario, values, solved, name, reach, watch)?;
    let present = path.parameter.present;
    let factor = path.limit();
    let mut limit = Limit {
        present,
        factor,
        safety: factor
            .filter(|factor| present != 0.0 && factor.signum() == present.signum())
            .map(|factor| factor / present),
        collapse: None,
        confirmed: false,
        path,
    };
    let (Some(factor), LoadEnd::Limit(direction)) = (factor, &limit.path.end) else {
        return Ok(limit);
    };
    let size = factor.abs().max(f64::MIN_POSITIVE);
    let (over, under) = (factor + BESIDE * size, factor - BESIDE * size);
    // Where the parameter stands in the loads themselves they are told as they are there.
    let renewed =
        if limit.path.moves_loads() { Some(at(prepared, scenario, values, name, over, watch)?) } else { None };
    let (prepared, beyond) = match &renewed {
        Some((there, factors)) => (there, there.named_factors(factors)),
        None => (prepared, prepared.named_factors(&limit.path.case_factors(over))),
    };
    let Some(system) = prepared.system() else { return Ok(limit) };
    let (above, below) = (limit.path.numbers(over), limit.path.numbers(under));
    let subject = prepared.subject(system, &above, &beyond);
    let mut collapse = ray::look(&subject, limit.path.contact(), direction, 0.0);
    let run = cold(system, &above, watch)?;
    limit.confirmed = run.basis.is_none() && cold(system, &below, watch)?.basis.is_some();
    if let Some(found) = run.ray() {
        let p = run.point.p * run.contact.force_unit;
        collapse.class = ray::look(&subject, &run.contact, found, p).class;
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
