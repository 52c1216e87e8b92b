//! Proof in rationals that a cycle repeats for ever.
//!
//! The working schemes of a followed cycle are taken from f64, nothing else. With them every place at which the scheme
//! changes is the solution of linear equations in the slips of the pairs that stick at the beginning ([`affine`]), and those
//! slips are chosen so that the cycle ends with the forces and gaps with which it began. What comes out is a loop of rational
//! states that is judged by itself ([`judge`]): no sign is wrong at any place, between two places everything is linear, and
//! pairs move only where the laws let them. Such a loop, followed again and again, is a history: it repeats for ever. R and
//! RF are taken as they are stored, those of a structure with zeros in place of their rounding.

mod affine;
mod judge;
mod question;

use std::time::Duration;

use num_rational::BigRational;

use self::affine::Family;
pub use self::question::SlipMap;
use self::question::{Place, Question, Refused, SECONDS, Stretch};
use super::stages::StageResult;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::ExactSystem;
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::problem::NOISE;
use crate::watch::{Budget, Watch};

/// Pairs up to which it is tried.
pub const MOST_PAIRS: usize = 24;
/// Working schemes of a cycle up to which it is tried.
pub const MOST_SCHEMES: usize = 120;
/// The order of coinciding events is taken from slips near those that close the loop, and then from these.
const PASSES: usize = 3;
/// Contact forces of the exact cycle and of the one followed differ by at most this share of the largest.
const NEAR: f64 = 1e-9;
/// What is proved of the repetition of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub enum Repetition {
    /// There was nothing to prove: no cycle repeats.
    NotAsked,
    /// This many pairs, or working schemes, are too many.
    TooLarge { pairs: usize, schemes: usize },
    /// Not proved: why.
    Unproved(String),
    /// A loop of rational states with all the signs.
    Proved(ExactLoop),
}

/// A cycle that repeats for ever, proved.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactLoop {
    /// Its working schemes.
    pub schemes: usize,
    /// What a cycle of these schemes does to slips near it.
    pub map: SlipMap,
    /// The largest difference between a contact force of it and of the cycle followed, a force.
    pub distance: f64,
    /// The largest slip that it leaves behind, exact but for the rounding to f64: a length.
    pub net: f64,
}

/// Proves that a cycle repeats: `before` is the stage that ends where it begins, `halves` are its way there and back, under
/// `problems` at the first and the second value.
pub(super) fn prove(
    problems: &[ContactProblem; 2],
    before: &StageResult,
    halves: [&StageResult; 2],
    watch: &dyn Watch,
) -> Repetition {
    let budget = Budget::new(watch, Duration::from_secs(SECONDS));
    match question(problems, before, halves, &budget).map(|question| question.answer()) {
        Ok(Ok(found)) => Repetition::Proved(found),
        Ok(Err(why)) => Repetition::Unproved(why),
        Err(refusal) => refusal,
    }
}

fn question<'a>(
    problems: &'a [ContactProblem; 2],
    before: &'a StageResult,
    halves: [&'a StageResult; 2],
    watch: &'a dyn Watch,
) -> Result<Question<'a>, Repetition> {
    let stretches: Vec<Stretch<'_>> =
        halves.into_iter().enumerate().flat_map(|(half, stage)| stretches_of(half, stage)).collect();
    let (pairs, schemes) = (problems[0].laws.len(), stretches.len());
    if pairs > MOST_PAIRS || schemes > MOST_SCHEMES {
        return Err(Repetition::TooLarge { pairs, schemes });
    }
    if problems[0].system.repeats_joints() {
        return Err(Repetition::Unproved("joints repeat one another, so that there is no R".to_owned()));
    }
    if halves.iter().any(|stage| stage.moments.iter().any(|moment| moment.jump)) {
        return Err(Repetition::Unproved("it jumps on its way".to_owned()));
    }
    let begin = before.moments.last().ok_or(Repetition::NotAsked)?;
    let reached = stretches_of(0, before).last().map_or_else(|| begin.way.clone(), |stretch| stretch.way);
    let ends = [0, 1].map(|end| ExactSystem::without_noise(&problems[end]));
    Ok(Question { ends, stretches, begin, reached, watch })
}

/// The stretches of a half, without those that are rounding: events that coincide may stand in any order in f64.
fn stretches_of(half: usize, stage: &StageResult) -> impl Iterator<Item = Stretch<'_>> {
    let windows = stage.moments.windows(2).filter(|ends| ends[1].t - ends[0].t > NOISE);
    windows.map(move |ends| Stretch { half, way: ends[1].way.clone(), end: &ends[1] })
}

impl Question<'_> {
    /// The loop, what it is one of, and the largest slip that it leaves behind.
    fn closed(&self) -> Result<(Family<'_>, Vec<Place>, BigRational), Refused> {
        let slips = affine::slips(self);
        let mut chosen: Vec<BigRational> = slips.iter().map(|joint| rational(self.begin.state.z[*joint])).collect();
        let mut why = String::new();
        for _ in 0..PASSES {
            let family = affine::family(self, &slips, &chosen)?;
            chosen = family.closing(self)?;
            let places = family.places(self, &chosen);
            match judge::judged(self, &places) {
                Ok(net) => return Ok((family, places, net)),
                Err(wrong) => why = wrong,
            }
        }
        Err(why)
    }

    fn answer(&self) -> Result<ExactLoop, Refused> {
        let (family, places, net) = self.closed()?;
        let (mut distance, mut largest) = (0.0, 0.0);
        for (place, stretch) in places[1..].iter().zip(&family.stretches) {
            for (exact, followed) in place.force.iter().zip(stretch.end.state.force.iter()) {
                distance = f64::max(distance, (nearest(exact) - followed).abs());
                largest = f64::max(largest, followed.abs());
            }
        }
        if distance > NEAR * largest {
            return Err("the cycle of these schemes that closes is another one".to_owned());
        }
        Ok(ExactLoop { schemes: self.stretches.len(), map: family.map(self)?, distance, net: nearest(&net) })
    }
}

#[cfg(test)]
mod tests;
