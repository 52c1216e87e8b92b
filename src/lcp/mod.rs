//! Linear complementarity problems and Lemke's algorithm: pure algebra, knows no structures.

pub mod outcome;
pub mod trace;
pub mod variable;
