//! Linear complementarity problems and Lemke's algorithm: pure algebra, knows no structures.

mod dense;
mod dictionary;
pub mod doubled;
pub mod driver;
pub mod exact;
pub mod filtered;
pub mod lemke;
pub mod mirrored;
pub mod outcome;
pub mod parametric;
pub mod problem;
pub mod ratio_test;
pub mod rational_solve;
pub mod scalar;
mod stand;
pub mod tableau;
pub mod trace;
mod updated_matrix;
pub mod variable;
pub mod vertex;

pub(crate) use dense::compute_sequentially;
