//! Where a history goes on at rest, on joints that repeat one another.
//!
//! What such joints carry is free up to self-stress, and what leads a history on knows one self-stress of them: its rates may
//! end, in joints in which that one exceeds a law, where others exceed none and nothing need move
//! ([`crate::contact::at_rest`]). There the history rests: as long as some self-stress obeys the laws, the joints that
//! self-stress reaches stay where they are, and the others move in one scheme. Then z is affine between both ends of a rest,
//! and the laws of what stays at rest, and of each scheme, are convex: on the way between two forces that obey them all do.

use nalgebra::DVector;

use crate::answer::check::TOLERANCE;
use crate::contact::at_rest::{AtRest, at_rest_where};
use crate::contact::cone::MixedState;
use crate::contact::problem::ContactProblem;
use crate::path::start::PathError;
use crate::watch::Watch;

/// A rest that leads on by less than this part of a stage is none: histories look no nearer ahead either.
const LEAST: f64 = 1e-9;
/// The end of a rest is located to this part of a stage.
const HERE: f64 = 1e-13;

/// How far a structure rests on its way from a place t of a stage.
pub(super) struct Rest {
    /// The place in the stage.
    pub(super) to: f64,
    /// What it carries there, its slips counted from those at t.
    pub(super) found: AtRest,
}

/// A stage as a rest sees it.
pub(super) struct Beyond<'p> {
    /// The problem at a place, joints in force form, for slips that count from those where it begins to rest.
    pub(super) behind: &'p dyn Fn(f64) -> Option<ContactProblem>,
    /// Whether what is found at a place passes the check of an answer: a program finds it to its own tolerance.
    pub(super) passes: &'p dyn Fn(f64, &AtRest) -> bool,
}

/// Rests as long as it can from place t, with total z and λ there; `None` where it cannot rest.
pub(super) fn rest(
    stage: &Beyond<'_>,
    (z, force): (&DVector<f64>, &DVector<f64>),
    t: f64,
    watch: &dyn Watch,
) -> Result<Option<Rest>, PathError> {
    let at = |to: f64| -> Result<Option<AtRest>, PathError> {
        if watch.stop() {
            return Err(PathError::Interrupted);
        }
        let Some(exact) = (stage.behind)(to) else { return Ok(None) };
        let openings: Vec<f64> = z.iter().take(exact.laws.len()).copied().collect();
        let found = at_rest_where(&exact, &openings, watch).map_err(|_| PathError::Interrupted)?;
        Ok(found.filter(|found| (stage.passes)(to, found) && leads_straight(&exact, (z, force), &found.state)))
    };
    if let Some(found) = at(1.0)? {
        return Ok(Some(Rest { to: 1.0, found }));
    }
    let (mut low, mut high, mut last) = (t, 1.0, None);
    while high - low > HERE {
        let middle = 0.5 * (low + high);
        match at(middle)? {
            Some(found) => (low, last) = (middle, Some(found)),
            None => high = middle,
        }
    }
    Ok(last.filter(|_| low - t > LEAST).map(|found| Rest { to: low, found }))
}

/// Whether all pairs obey at the beginning what the scheme of the end asks of them: then no pair does anything else between.
fn leads_straight(exact: &ContactProblem, (z, force): (&DVector<f64>, &DVector<f64>), end: &MixedState) -> bool {
    let (lengths, forces) = (TOLERANCE * z.amax().max(end.z.amax()), TOLERANCE * force.amax());
    exact.system.pairs.iter().zip(&exact.laws).enumerate().all(|(i, (pair, law))| {
        let is_open = !law.is_bilateral() && end.z[i] > 0.0;
        let is_apt = if is_open { force[i] <= forces } else { law.is_bilateral() || z[i] <= lengths };
        let slip = pair.slip(&end.z);
        let size = slip[0].hypot(slip[1]);
        if size == 0.0 {
            return is_apt;
        }
        let bound = law.bound(if is_open { 0.0 } else { force[i].max(0.0) });
        let held = pair.slip(force);
        is_apt && (0..2).all(|k| (held[k] + bound * slip[k] / size).abs() <= forces)
    })
}
