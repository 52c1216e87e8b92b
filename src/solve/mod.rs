//! The pipeline: scenario → prepared geometry (once) → solved state (for every change of a parameter).

pub mod all_answers;
pub mod attempt;
mod by_path;
pub mod compare;
pub mod explain;
mod history_answer;
pub mod judge;
mod ladder;
pub mod numbers;
mod plain;
pub mod plain_answers;
pub mod prepared;
pub mod resume;
pub mod retry;
mod settle;
pub mod solved;
pub mod warm;
mod written;

pub use prepared::{PrepareError, Prepared, prepare, prepare_at};
pub use solved::{SolveError, Solved};
