//! Cycles that go event by event as those before, but for gaps that are wider while they are open.
//!
//! Between two events everything is affine in the state at the beginning of a cycle. Where three cycles meet the same events at
//! the same places with the same forces, and differ by the same from one to the next, what the next one differs by obeys all laws
//! as well as long as no law gets nearer to its limit: gaps that are open only widen, gaps that are closed stay so, and slips
//! under friction keep their length or go on in their sense. Then so does every further one.

use super::stages::{Moment, StageResult};
use crate::answer::record::PairState;

/// What counts as no difference of forces and of lengths.
pub(super) struct Alike<'a> {
    pub(super) force: &'a dyn Fn(f64) -> bool,
    pub(super) length: &'a dyn Fn(f64) -> bool,
    /// Two events are at one place of a stage where they are nearer to each other than this.
    pub(super) place: f64,
}

impl Alike<'_> {
    /// Whether the last of three cycles goes on from the two before it as every further one will; the last one first, and of
    /// each the way there and back.
    pub(super) fn only_widens(&self, cycles: [[&StageResult; 2]; 3]) -> bool {
        (0..2).all(|half| {
            let [now, before, earlier] = cycles.map(|cycle| &cycle[half].moments[..]);
            let moments = || now.iter().zip(before).zip(earlier).map(|((now, before), earlier)| [now, before, earlier]);
            let count = now.len();
            before.len() == count
                && earlier.len() == count
                && moments().all(|three| self.is_one_event(three))
                && moments().zip(moments().skip(1)).all(|(from, to)| self.slips_on(from, to))
        })
    }

    /// Whether three moments are one event but for gaps that widen by the same each time.
    fn is_one_event(&self, [now, before, earlier]: [&Moment; 3]) -> bool {
        let is_one =
            |other: &Moment| (now.t - other.t).abs() <= self.place && now.jump == other.jump && now.way == other.way;
        let pairs = now.pairs.iter().zip(&before.pairs).zip(&earlier.pairs);
        is_one(before)
            && is_one(earlier)
            && pairs.into_iter().all(|((now, before), earlier)| {
                let is_open = now.z_n > 0.0;
                let wider = [now.z_n - before.z_n, before.z_n - earlier.z_n];
                now.space.is_none()
                    && [before, earlier]
                        .iter()
                        .all(|other| self.has_forces_of(now, other) && (other.z_n > 0.0) == is_open)
                    && (wider[0] >= 0.0 || (self.length)(wider[0].abs()))
                    && (self.length)((wider[0] - wider[1]).abs())
            })
    }

    fn has_forces_of(&self, pair: &PairState, other: &PairState) -> bool {
        (self.force)((pair.x_n - other.x_n).abs()) && (self.force)((pair.x_t - other.x_t).abs())
    }

    /// Whether what slips under friction from one moment to the next goes as far as in the cycle before, or farther in the same
    /// sense, by the same each time.
    fn slips_on(&self, from: [&Moment; 3], to: [&Moment; 3]) -> bool {
        (0..from[0].pairs.len()).all(|pair| {
            let [a, b] = [&from[0].pairs[pair], &to[0].pairs[pair]];
            let is_free = [a, b].iter().all(|end| end.z_n > 0.0 && end.bound == 0.0);
            let slips = [0, 1, 2].map(|cycle| to[cycle].pairs[pair].z_t - from[cycle].pairs[pair].z_t);
            let longer = [slips[0] - slips[1], slips[1] - slips[2]];
            is_free
                || (self.length)(longer[0].abs())
                || (longer[0] * slips[1] > 0.0 && (self.length)((longer[0] - longer[1]).abs()))
        })
    }
}

/// Whether a pair is open all through the stages, with nothing that holds it across its gap.
pub(super) fn stays_open(stages: [&StageResult; 2], pair: usize) -> bool {
    let mut moments = stages.into_iter().flat_map(|stage| &stage.moments).map(|moment| &moment.pairs[pair]);
    moments.all(|pair| pair.z_n > 0.0 && pair.bound == 0.0)
}
