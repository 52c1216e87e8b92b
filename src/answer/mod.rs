//! One solved state in the words of the structure, and its independent check.

pub mod attempt;
pub mod check;
pub mod check_plain;
pub mod diagram;
pub mod outcome;
pub mod pair_record;
pub mod pairs;
pub mod ray_record;
pub mod record;
pub mod rounding;
pub mod same;
pub mod stress;
