//! Rare collapse: draws are moved to where the parameters most likely leave the structure just at its limit.
//!
//! The limit load of a case over its present value, less 1, is a function of the parameters that is 0 at the limit. In standard
//! normal numbers the place of it nearest to 0 is found by the steps of Hasofer, Lind, Rackwitz and Fiessler. The place
//! decides only how far the estimate scatters: the weights make any place right.

use rayon::prelude::*;

use super::draw::{Draw, Rule};
use super::statistics::Found;
use super::{Sampler, with_verdict};
use crate::path::limit::limit;
use crate::path::start::PathError;
use crate::solve::Case;
use crate::solve::case::There;

/// Draws that tell whether collapse is rare …
const PILOT: usize = 200;
/// … which it is with fewer than this many collapses among them.
const FEW: usize = 4;
/// Of another seed than the draws themselves.
const PILOT_SEED: u64 = 0x9e37_79b9_7f4a_7c15;
/// Steps of the search.
const STEPS: usize = 15;
/// A difference for the slopes, in standard deviations.
const DIFFERENCE: f64 = 0.05;
/// No step is longer.
const LONGEST: f64 = 2.0;
/// A step shorter than this ends the search.
const ARRIVED: f64 = 0.05;
/// A safety within this of 1 is near the limit.
const NEAR: f64 = 0.1;

/// Where the draws are moved to.
#[derive(Clone, Debug, PartialEq)]
pub struct Centre {
    pub place: Vec<f64>,
    /// The load whose limit was followed.
    pub load: String,
}

/// The centre where collapse is rare and the limit of a load leads to it.
///
/// # Errors
/// An interruption.
pub fn centre(case: Case<'_>, draw: &Draw) -> Result<Option<Centre>, PathError> {
    // The search must not cost more than what was asked for.
    if case.prepared.system().is_none() || draw.count < 2 * PILOT {
        return Ok(None);
    }
    let rule = Rule { seed: draw.rule.seed ^ PILOT_SEED, centre: None };
    let pilot = Sampler { case, draw: Draw { rule, count: PILOT, ..draw.clone() }, quantities: &with_verdict(&[]) };
    let found = pilot.run()?;
    if found.iter().filter(|one| one.found == Found::Collapse).count() >= FEW {
        return Ok(None);
    }
    let Some(load) = governing(case, draw)? else { return Ok(None) };
    let safety = |place: &[f64]| safety(case, draw, place, &load);
    let n = draw.variables.len();
    let mut place = vec![0.0; n];
    for step in 0..STEPS {
        case.watch.progress(&format!("limit of {load}"), step as f64 / STEPS as f64);
        let Some(here) = safety(&place)? else { return Ok(None) };
        let beside: Vec<Result<Option<f64>, PathError>> = (0..n)
            .into_par_iter()
            .map(|k| {
                let mut moved = place.clone();
                moved[k] += DIFFERENCE;
                safety(&moved)
            })
            .collect();
        let mut slopes = Vec::with_capacity(n);
        for value in beside {
            let Some(value) = value? else { return Ok(None) };
            slopes.push((value - here) / DIFFERENCE);
        }
        let steep: f64 = slopes.iter().map(|slope| slope * slope).sum();
        if steep == 0.0 {
            return Ok(None);
        }
        let along: f64 = slopes.iter().zip(&place).map(|(slope, u)| slope * u).sum::<f64>() - (here - 1.0);
        let next: Vec<f64> = slopes.iter().map(|slope| slope * along / steep).collect();
        let length = next.iter().zip(&place).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let share = (LONGEST / length).min(1.0);
        place.iter_mut().zip(&next).for_each(|(u, next)| *u += share * (next - *u));
        if length < ARRIVED {
            break;
        }
    }
    let near = safety(&place)?.is_some_and(|safety| (safety - 1.0).abs() < NEAR);
    // Rounded, since the header of a file states them.
    let place = place.into_iter().map(|u| (u * 1e6).round() / 1e6).collect();
    Ok(near.then_some(Centre { place, load }))
}

/// The load of least safety at the medians.
fn governing(case: Case<'_>, draw: &Draw) -> Result<Option<String>, PathError> {
    let middle = vec![0.0; draw.variables.len()];
    let mut best: Option<(f64, &str)> = None;
    for (load, factor) in &case.prepared.cases {
        if factor.value(case.values) == 0.0 {
            continue;
        }
        if let Some(found) = safety(case, draw, &middle, load)?
            && best.is_none_or(|(least, _)| found < least)
        {
            best = Some((found, load));
        }
    }
    Ok(best.map(|(_, load)| load.to_owned()))
}

/// The limit of a load over its present value; `None` without one.
fn safety(case: Case<'_>, draw: &Draw, place: &[f64], load: &str) -> Result<Option<f64>, PathError> {
    let values = draw.at(place);
    let settings: Vec<(&str, f64)> =
        draw.variables.iter().zip(values).map(|(variable, value)| (variable.name.as_str(), value)).collect();
    let limit = |there: There| limit(there.case(case), None, load);
    match case.at_all(&settings).map_err(PathError::from).and_then(limit) {
        Err(PathError::Interrupted) => Err(PathError::Interrupted),
        found => Ok(found.ok().and_then(|found| found.safety)),
    }
}
