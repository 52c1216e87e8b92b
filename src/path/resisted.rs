//! The answer that a structure comes to where none is near: it moves on through a medium that resists until it stands.
//!
//! Where a way along the loads ends in a jump, Newton's method finds nothing near its end, and no polygon need lead across
//! either: the answer may lie behind a direction of slip that turned by less than a facet. What the structure does is a
//! motion that something resists. In steps of its time, from the state before each step, joints have the forces
//!
//! ```text
//!     λ = R z + RF + c D (z − z before),     D the diagonal of R
//! ```
//! With a large c there is one answer and it is near; from one step to the next c gets smaller, and what comes to rest is an
//! answer of the structure alone.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::DVector;

use super::start::PathError;
use crate::contact::cone::{ConeFailure, MixedProblem};
use crate::contact::on_cone::{OnCone, cone_pairs};
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::watch::Watch;

/// Each step resists by this part of the one before …
const LESS: f64 = 0.25;
/// … or, where that has no answer, by this many times more than it.
const MORE: f64 = 16.0;
/// From this c on the structure may be near to where it comes to rest.
const NEAR: f64 = 0.05;
/// With this c nothing resists any more.
const NONE: f64 = 1e-8;
/// Steps at most.
const STEPS: usize = 256;

/// Displacements and forces of all joints.
pub(super) type Place = (DVector<f64>, DVector<f64>);

/// A problem, and the slips that its displacements count from.
pub(super) type Counted<'a> = (Cow<'a, ContactProblem>, DVector<f64>);

/// Goes from a place on until `at_rest` finds an answer of the problem itself near by; `None` where it finds none. `counted`
/// is the problem whose friction stands against the motion from some displacements. Joints that repeat one another are in
/// force form.
pub(super) fn resisted<'a, T>(
    counted: &dyn Fn(&DVector<f64>) -> Counted<'a>,
    mut place: Place,
    watch: &dyn Watch,
    at_rest: &dyn Fn(&Place) -> Result<Option<T>, PathError>,
) -> Result<Option<T>, PathError> {
    let mut c = 1.0;
    for _ in 0..STEPS {
        let (problem, shift) = counted(&place.0);
        let from = (&place.0 - &shift, place.1.clone());
        match step(&problem, &from, c, watch)?.map(|(z, force)| (z + shift, force)) {
            Some(next) => place = next,
            None => {
                c *= MORE;
                continue;
            }
        }
        if c < NEAR
            && let Some(found) = at_rest(&place)?
        {
            return Ok(Some(found));
        }
        if c < NONE {
            break;
        }
        c *= LESS;
    }
    Ok(None)
}

/// The answer near a place where the motion from there is resisted.
fn step(problem: &ContactProblem, (z, force): &Place, c: f64, watch: &dyn Watch) -> Result<Option<Place>, PathError> {
    let eased = eased(problem, z, c);
    let found = if eased.system.force_form.is_some() {
        let pairs = cone_pairs(&eased);
        let found = MixedProblem::new(&eased, &pairs).answer(z, &|joint| force[joint], watch);
        found.map(|found| found.map(|state| (state.z, state.forces)))
    } else {
        OnCone::new(&eased).nearby(z, watch).map(|answer| Some((answer.z, answer.forces)))
    };
    match found {
        Err(ConeFailure::Stopped) => Err(PathError::Interrupted),
        Err(_) => Ok(None),
        Ok(found) => Ok(found.map(|(z, forces)| {
            let force = DVector::from_iterator(z.len(), forces.iter().map(|force| force.value));
            (z, force)
        })),
    }
}

/// The problem with the resistance to a motion from z.
fn eased(problem: &ContactProblem, z: &DVector<f64>, c: f64) -> ContactProblem {
    let system = &*problem.system;
    let own = |joint: usize| if system.is_forced(joint) { 0.0 } else { system.stiffness[(joint, joint)].max(0.0) };
    let largest = (0..z.len()).map(own).fold(0.0, f64::max);
    let resistance = DVector::from_fn(z.len(), |joint, _| match (system.is_forced(joint), own(joint)) {
        (true, _) => 0.0,
        (false, own) if own > 0.0 => c * own,
        (false, _) => c * if largest > 0.0 { largest } else { 1.0 },
    });
    let mut stiffness = system.stiffness.clone();
    (0..z.len()).for_each(|joint| stiffness[(joint, joint)] += resistance[joint]);
    let held = problem.dislocation(z).component_mul(&resistance);
    let mut eased = problem.clone();
    eased.add_load(-1.0, &held, &held.abs());
    // Nothing moves freely.
    let kernel = system.kernel.columns(0, 0).into_owned();
    eased.system = Arc::new(ContactSystem { stiffness, kernel, corrected: None, file: None, ..system.clone() });
    eased
}
