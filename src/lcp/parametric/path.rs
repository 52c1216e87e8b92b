//! A path in a load parameter, as it is reported: how far it goes, its breakpoints, why it ends.

use super::super::outcome::{Point, RayDirection};
use super::super::variable::Variable;
use crate::lcp::basis::Basis;

/// How far a path goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// t at which it ends; infinite: as far as it goes.
    pub target: f64,
    /// Whether it goes on where t has to fall.
    pub through: bool,
    /// No more pivots than this.
    pub pivots: usize,
}

/// Why a path ends.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// t reached the target.
    Target,
    /// t would have to fall: there is no answer on this path just beyond its last knot.
    Turning,
    /// Nothing blocks while t stays: the limit of the load, with the direction of collapse.
    Limit(RayDirection),
    /// The last scheme holds for every larger t.
    Unbounded,
    /// Going through turning points t fell back to 0.
    Returned,
    /// More pivots than allowed.
    PivotLimit,
    /// Stopped from outside.
    Interrupted,
    /// The numbers no longer belong together.
    Breakdown(String),
}

/// A breakpoint: where the scheme changes (the first: the start; the last: the end).
#[derive(Clone, Debug, PartialEq)]
pub struct Breakpoint {
    /// t.
    pub t: f64,
    /// All variables there, computed afresh from the data; its `p` is t, or less by rounding.
    pub point: Point,
    /// What reached zero here, one after the other.
    pub leaving: Vec<Variable>,
    /// The scheme beyond it: rows of the whole LCP whose z is basic, ascending.
    pub scheme: Vec<usize>,
}

/// A followed path: its knots; between two of them everything is affine.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The knots, start and end included. t rises along them except beyond turning points.
    pub knots: Vec<Breakpoint>,
    /// Why it ended.
    pub end: End,
    /// Pivots made.
    pub pivots: usize,
}

impl Path {
    /// The scheme at the end.
    pub fn last_scheme(&self) -> Basis {
        let z = self.knots.last().map_or(Vec::new(), |knot| knot.scheme.clone());
        Basis { active: z.clone(), z, p: false }
    }
}
