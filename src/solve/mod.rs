//! The pipeline: scenario → prepared geometry (once) → solved state (for every change of a parameter).

pub mod attempt;
pub mod numbers;
pub mod prepared;
pub mod solved;
pub mod warm;

pub use prepared::{PrepareError, Prepared, prepare};
pub use solved::{SolveError, Solved};
