//! Running an engine to its end: the loop, the observer that may stop it, the pivot limit.

use std::ops::ControlFlow;

use super::outcome::{Outcome, Point, Run};
use crate::lcp::pivot::{Pivot, PivotLog};

/// What one step of an engine did.
#[derive(Clone, Debug, PartialEq)]
pub enum Step<T> {
    /// A pivot was made; it is the last of [`Engine::pivots`].
    Pivoted,
    /// Nothing more to do.
    Ended(Outcome<T>),
}

/// An implementation of Lemke's algorithm, one pivot at a time. A new engine stands before the entry of p.
pub trait Engine {
    /// Number type.
    type Number;
    /// Makes the next pivot, or says how the run ended; after an end it keeps saying so.
    fn step(&mut self) -> Step<Self::Number>;
    /// The pivots made so far.
    fn pivots(&self) -> &PivotLog;
    /// The present vertex.
    fn point(&self) -> Point<Self::Number>;
}

/// Steps `engine` until it ends, more than `limit` pivots are made, or `observer` (called after every pivot) breaks.
pub fn run<E: Engine>(
    engine: &mut E,
    limit: usize,
    observer: &mut dyn FnMut(&Pivot) -> ControlFlow<()>,
) -> Run<E::Number> {
    let outcome = loop {
        if engine.pivots().count() > limit {
            break Outcome::PivotLimit;
        }
        match engine.step() {
            Step::Ended(outcome) => break outcome,
            Step::Pivoted => {
                if let Some(pivot) = engine.pivots().last()
                    && observer(pivot).is_break()
                {
                    break Outcome::Interrupted;
                }
            }
        }
    };
    Run { outcome, pivots: engine.pivots().closed(), point: engine.point() }
}
