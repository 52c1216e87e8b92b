//! Where a scheme of a path in space ends, and what lies beyond.

use nalgebra::DVector;

use super::JUMP;
use super::aim::{Aim, HERE};
use super::over::Path;
use super::stand::Stand;
use crate::contact::sum::LAW_ROUNDING;
use crate::explain::certificate::{certify, certify_again};
use crate::explain::motions::FreeMotions;
use crate::explain::proof::Certificate;
use crate::explain::ray::{RayReport, explain};
use crate::lcp::exact::dyadic::nearest;
use crate::model::rules::Covering;
use crate::path::cone_step::Stepper;
use crate::path::end::PathEnd;
use crate::path::start::PathError;

/// Where no answer is near, another one, or a certified collapse, is looked for this share of the range further on.
const BEYOND: f64 = 1e-7;

/// Where a scheme, or the answer that was followed, ends.
pub(super) struct Edge {
    pub(super) last: Stand,
    /// The answer just beyond; none where none was found.
    pub(super) next: Option<Stand>,
    /// Whether that lies away from the last one, or is still to be looked for.
    pub(super) jump: bool,
}

/// What lies beyond the end of what Newton's method follows.
pub(super) enum Beyond {
    Jump(Box<Stand>),
    /// With [`ConePath::for_good`](super::ConePath::for_good).
    End(PathEnd, bool),
}

impl Path<'_> {
    /// Where the scheme of `here` ends, or its answer: `next` is what was found in the step beyond.
    pub(super) fn edge(&self, stepper: &Stepper<'_>, here: Stand, next: Option<Stand>) -> Result<Edge, PathError> {
        let Some(next) = next else { return Ok(Edge { last: here, next: None, jump: true }) };
        // The size of z within the whole step: next to the place where a slip begins or ends, only a remainder of
        // it is seen.
        let size = next.step.z.amax().max(here.step.z.amax());
        let moved = |last: &Stand, next: &Stand| (&next.step.z - &last.step.z).amax() > JUMP * size;
        let jumps = |last: &Stand, next: &Option<Stand>| next.as_ref().is_none_or(|next| moved(last, next));
        let beyond = next.clone();
        let (mut last, mut next) = self.narrowed(stepper, here, next, false)?;
        if jumps(&last, &next) {
            // The other answer may have been found where the first still goes on.
            (last, next) = self.narrowed(stepper, last, beyond, true)?;
        }
        let jump = jumps(&last, &next);
        Ok(Edge { last, next, jump })
    }

    /// The two places between which the scheme of the first ends, looked for from halfway between both answers, or from
    /// the first alone. The second is missing where no answer was found near the first.
    fn narrowed(
        &self,
        stepper: &Stepper<'_>,
        before: Stand,
        after: Stand,
        from_first: bool,
    ) -> Result<(Stand, Option<Stand>), PathError> {
        let digits = HERE * after.value().abs().max(before.value().abs());
        let (mut before, mut high, mut after) = (before, after.value(), Some(after));
        while (high - before.value()).abs() > digits {
            let middle = 0.5 * (before.value() + high);
            if middle == before.value() || middle == high {
                break;
            }
            let guess = match &after {
                Some(after) if !from_first => (&before.step.z + &after.step.z) * 0.5,
                _ => before.step.z.clone(),
            };
            match self.near(stepper, middle, &guess)? {
                Some(found) if found.step.scheme == before.step.scheme => before = found,
                found => (high, after) = (middle, found),
            }
        }
        Ok((before, after))
    }

    /// What lies beyond a value near which there is no further answer.
    pub(super) fn beyond(&self, stepper: &Stepper<'_>, end: f64, aim: &Aim) -> Result<Beyond, PathError> {
        let value = end + BEYOND * aim.sign * aim.size_at(end);
        let problem = self.problem(value)?;
        if let Ok(step) = stepper.anywhere(problem.clone(), &DVector::zeros(problem.system.joint_count()), None)? {
            let found = self.stand(value, step)?;
            if !self.is_hidden(end, &found)? {
                return Ok(Beyond::Jump(Box::new(found)));
            }
        }
        let built = self.case.prepared.built();
        let motions = FreeMotions::new(&problem.system, built);
        let Some(certificate) = certify(&problem, &motions).certificate else {
            let end = if self.is_answer(value)? { PathEnd::AnswerBeyond(value) } else { PathEnd::NoAnswer };
            return Ok(Beyond::End(end, false));
        };
        let for_good = !self.over.is_friction() && self.goes_on_to(aim, &certificate, &motions)?;
        let mut report = RayReport::of_certificate(&problem, certificate);
        explain(&mut report, &problem, built);
        let collapse = PathEnd::Collapse(Box::new(report.record(&problem.system, Covering::default())));
        Ok(Beyond::End(collapse, for_good))
    }

    /// Whether a collapse goes on from its place up to the target. The loads that forces can balance at all are a
    /// convex set, which a path leaves once. What is proved of one load only goes on where its motion proves it at
    /// the target as well: work, normal forces and what friction can take are straight lines between the two.
    fn goes_on_to(&self, aim: &Aim, certificate: &Certificate, motions: &FreeMotions) -> Result<bool, PathError> {
        let Some(target) = aim.target.filter(|_| certificate.of_this_load) else {
            return Ok(!certificate.of_this_load);
        };
        let amounts: Vec<f64> = certificate.amounts.iter().map(nearest).collect();
        Ok(certify_again(&self.problem(target)?, motions, &amounts).is_some())
    }

    /// Whether the scheme before this one, which ended at `left`, still has an answer at `last`, with the same forces:
    /// the two differ by a motion that nothing resists. Of a limit rounding makes a scheme of its own, as long as the
    /// digits to which the limit is known: there every slip along the collapse is an answer.
    pub(super) fn presses_alike(&self, stepper: &Stepper<'_>, left: &Stand, last: &Stand) -> Result<bool, PathError> {
        let Some(kept) = self.kept(stepper, last.value(), left)? else { return Ok(false) };
        let [one, other] = [&kept.step.increments, &last.step.increments];
        Ok((0..one.z.len()).all(|joint| one.sum(joint).plus(-1.0, other.sum(joint)).share().abs() <= LAW_ROUNDING))
    }
}
