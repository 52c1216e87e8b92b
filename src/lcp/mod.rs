//! Linear complementarity problems and Lemke's algorithm: pure algebra, knows no structures.

pub mod all_solutions;
pub mod classes;
pub mod corners;
mod dense;
mod dictionary;
pub mod doubled;
pub mod driver;
pub mod dyadic;
pub mod exact;
pub mod farkas;
pub mod filtered;
pub mod lemke;
pub mod linear_program;
pub mod mirrored;
pub mod outcome;
pub mod parametric;
pub mod polyhedron;
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
