//! A cycle of a load, as it is asked in rationals.

use std::ops::ControlFlow;

use num_rational::BigRational;

use crate::answer::record::State;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::ExactSystem;
use crate::path::stages::Moment;
use crate::watch::Watch;

/// Time for one proof.
pub(super) const SECONDS: u64 = 10;

/// The affine map that a cycle of given schemes makes of the slips of the pairs that stick where it begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlipMap {
    /// Slips come back as they were.
    Identical,
    /// Differences of slips shrink to at most this share, in the largest of them, within this many cycles.
    Contracting { share: f64, cycles: u32 },
    /// Neither is proved.
    Open,
}

impl SlipMap {
    /// Its word in results.
    pub fn word(self) -> &'static str {
        match self {
            SlipMap::Identical => "identical",
            SlipMap::Contracting { .. } => "contracting",
            SlipMap::Open => "open",
        }
    }
}

/// What every pair does, and what holds it where it is open.
pub(super) type Way = Vec<(State, Option<State>)>;

/// A stretch of one working scheme.
#[derive(Clone)]
pub(super) struct Stretch<'a> {
    /// 0: on the way there; 1: on the way back.
    pub(super) half: usize,
    pub(super) way: Way,
    /// The f64 state at its end.
    pub(super) end: &'a Moment,
}

/// A state of the loop; of all joints.
pub(super) struct Place {
    pub(super) half: usize,
    /// Share of that half, 0 … 1.
    pub(super) t: BigRational,
    pub(super) z: Vec<BigRational>,
    pub(super) force: Vec<BigRational>,
}

/// A cycle of a load between two values, in rationals.
pub(super) struct Question<'a> {
    /// The problem at the first value and at the second.
    pub(super) ends: [ExactSystem<'a>; 2],
    pub(super) stretches: Vec<Stretch<'a>>,
    /// The f64 state where it begins …
    pub(super) begin: &'a Moment,
    /// … and the scheme with which that was reached.
    pub(super) reached: Way,
    pub(super) watch: &'a dyn Watch,
}

/// Why no proof came about.
pub(super) type Refused = String;

impl Question<'_> {
    pub(super) fn go_on(&self) -> Result<(), Refused> {
        match self.watch.go_on() {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(format!("it was not ready within {SECONDS} s")),
        }
    }

    pub(super) fn problem(&self) -> &ContactProblem {
        self.ends[0].problem
    }

    /// The largest Σ |terms| of a contact force on the way: forces and reserves are known to a few ε of it.
    pub(super) fn terms(&self) -> f64 {
        self.stretches.iter().map(|stretch| stretch.end.state.terms.amax()).fold(0.0, f64::max)
    }

    /// The constant of a joint's λ at the beginning of a half, and its change over it.
    pub(super) fn constant(&self, half: usize, joint: usize) -> (&BigRational, BigRational) {
        let [from, to] = [half, 1 - half].map(|end| &self.ends[end].constants[joint]);
        (from, to - from)
    }
}
