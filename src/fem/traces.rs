//! What the motions of loose parts do to the joints, as sums that are exact: for proofs in which nothing may be lost to
//! rounding.
//!
//! The displacements of [`Motion`](super::Motion) are f64 numbers. A rotation about the anchor of a spring moves what is
//! there only by their rounding, but a proof that rests on it needs to know that it does not move at all.

use nalgebra::DMatrix;

use super::null_space::Terms;

/// A cluster of parts linked by pins, ties and springs. The terms of one unknown in a row or a joint add up to its
/// coefficient exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Traces {
    /// What holds the parts: each of these sums is 0.
    pub rows: Vec<Terms>,
    /// The motions over the unknowns of the parts: the null space of the rows, to rounding.
    pub near: DMatrix<f64>,
    /// Index among all joints of each that some unknown moves, and its mutual displacement.
    pub joints: Vec<(usize, Terms)>,
}
