//! How a run of Lemke's algorithm ends.

use super::variable::Variable;
use crate::lcp::pivot::{Cycle, PivotLog};

/// Values of all variables of the LCP at one vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point<T = f64> {
    /// z, length n.
    pub z: Vec<T>,
    /// w = M z + q + d p, length n.
    pub w: Vec<T>,
    /// p.
    pub p: T,
}

/// A direction in which the entering variable grows without bound.
#[derive(Clone, Debug, PartialEq)]
pub struct RayDirection<T = f64> {
    /// The entering variable.
    pub entering: Variable,
    /// z̄ ≥ 0.
    pub z: Vec<T>,
    /// w̄ ≥ 0.
    pub w: Vec<T>,
    /// p̄ ≥ 0.
    pub p: T,
}

/// The end of a run. None of these is an error: each says what was found.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome<T = f64> {
    /// q ≥ 0: z = 0 is the answer, no pivot.
    Trivial,
    /// p reached 0. `marginal`: it stopped at p ≤ 1e-12 × largest |q| without leaving.
    Normal {
        /// See above.
        marginal: bool,
    },
    /// No row blocks the entering variable at p > 0.
    Ray(RayDirection<T>),
    /// The pivot limit was reached.
    PivotLimit,
    /// A basis came back: the run would go on for ever. In exact arithmetic only under first-row and random.
    Cycle(Cycle),
    /// The numbers no longer belong together; says which check failed.
    Breakdown(String),
    /// Stopped from outside.
    Interrupted,
}

/// A finished run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run<T = f64> {
    /// How it ended.
    pub outcome: Outcome<T>,
    /// Its pivots (p in f64 whatever the engine).
    pub pivots: PivotLog,
    /// The last vertex.
    pub point: Point<T>,
}
