//! Where a path in space goes, and how fast.

use crate::path::end::PathEnd;

/// A breakpoint is located to this share of the range, and so is the end: no answer near so close ahead is none at all.
pub(super) const HERE: f64 = 1e-12;
/// Steps to a target: between two of them a pair may do something and undo it unseen.
const STEPS: f64 = 64.0;
/// Without a target each step is longer than the one before by this factor …
const GROWTH: f64 = 1.5;
/// … up to this multiple of the size of the load at the start.
const MOST: f64 = 1e9;

/// How a path goes on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    pub(super) start: f64,
    /// `None`: as far as it goes.
    pub(super) target: Option<f64>,
    /// The way it goes now.
    pub(super) sign: f64,
    /// The way it set out.
    outwards: f64,
    /// What steps are measured by.
    pub(super) size: f64,
}

impl Aim {
    pub(super) fn new(start: f64, to: Option<f64>) -> Aim {
        let (target, sign) = match to {
            Some(to) if to == f64::NEG_INFINITY => (None, -1.0),
            Some(to) => (Some(to), if to < start { -1.0 } else { 1.0 }),
            None => (None, 1.0),
        };
        let size = target.map_or(if start == 0.0 { 1.0 } else { start.abs() }, |to| (to - start).abs());
        Aim { start, target, sign, outwards: sign, size }
    }

    /// Turns back at a turning point, or out again.
    pub(super) fn turn(&mut self) {
        self.sign = -self.sign;
    }

    fn is_returning(&self) -> bool {
        self.sign != self.outwards
    }

    /// What ends it at a value; `None` where it goes on.
    pub(super) fn end_at(&self, value: f64) -> Option<PathEnd> {
        if self.is_returning() {
            return (value == self.start).then_some(PathEnd::Returned);
        }
        match self.target {
            Some(to) => (value == to).then_some(PathEnd::Target),
            None => ((value - self.start).abs() > MOST * self.size).then_some(PathEnd::Unbounded),
        }
    }

    /// A length at a value that tells it from its neighbours.
    pub(super) fn size_at(&self, value: f64) -> f64 {
        self.size.max(value.abs())
    }

    /// How far it is from a value to one ahead.
    pub(super) fn way(&self, from: f64, to: f64) -> f64 {
        (to - from) * self.sign
    }

    /// The way from a value halfway to one where no answer was found; all of it where it is so short that what was
    /// not found from afar is looked for once more.
    pub(super) fn halfway(&self, from: f64, lost: f64) -> f64 {
        let way = self.way(from, lost);
        if 0.5 * way > HERE * self.size_at(from) { 0.5 * way } else { way }
    }

    /// The value a length further on, or the end that lies nearer.
    pub(super) fn next(&self, value: f64, length: f64) -> f64 {
        let end = if self.is_returning() { Some(self.start) } else { self.target };
        match end {
            Some(to) if (to - value).abs() <= length * (1.0 + 1e-9) => to,
            _ => value + self.sign * length,
        }
    }

    /// The length of the first step in a scheme.
    pub(super) fn step(&self) -> f64 {
        self.size / STEPS
    }

    /// The length of the step after one of this length.
    pub(super) fn longer(&self, length: f64) -> f64 {
        match self.target {
            Some(_) => (2.0 * length).min(self.step()),
            None => GROWTH * length,
        }
    }
}
