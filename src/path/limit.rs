//! The limit load of a case: factor, safety, how the structure collapses, and what has been proved of it.

use super::load::{LoadEnd, LoadPath, LoadReach, trace};
use super::start::{PathError, cold};
use crate::answer::record::Ray;
use crate::explain::ray;
use crate::model::parameter::ParameterValues;
use crate::model::rules::Covering;
use crate::model::scenario::Scenario;
use crate::solve::{Prepared, Solved};
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
    let (Some(factor), LoadEnd::Limit(direction), Some(system)) = (factor, &limit.path.end, prepared.system()) else {
        return Ok(limit);
    };
    let size = factor.abs().max(f64::MIN_POSITIVE);
    let above = limit.path.numbers(factor + BESIDE * size);
    let below = limit.path.numbers(factor - BESIDE * size);
    let cases = |factor: f64| prepared.named_factors(&limit.path.case_factors(factor));
    let beyond = cases(factor + BESIDE * size);
    let subject = prepared.subject(system, &above, &beyond);
    let mut collapse = ray::look(&subject, limit.path.contact(), direction, 0.0);
    let over = cold(system, &above, watch)?;
    limit.confirmed = over.basis.is_none() && cold(system, &below, watch)?.basis.is_some();
    if let Some(found) = over.ray() {
        let p = over.point.p * over.contact.force_unit;
        collapse.class = ray::look(&subject, &over.contact, found, p).class;
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
