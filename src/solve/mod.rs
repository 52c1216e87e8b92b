//! The pipeline: scenario → prepared geometry (once) → solved state (for every change of a parameter).
//!
//! ```
//! use stickslip::{model::embedded, solve::prepare, watch::Quiet};
//!
//! let scenario = embedded::load("beam")?;
//! let prepared = prepare(&scenario, &Quiet)?;
//! let mut values = scenario.parameter_values();
//! values.insert("F2".to_owned(), 250.0).expect("a parameter of the beam");
//! let answer = prepared.case(&scenario, &values).solve()?.answer;
//! // Pair c6 slips on its bound f x_n = 0.5 · 100 kN.
//! let c6 = &answer.pairs[5];
//! assert!(answer.is_answer() && (c6.x_t + 0.5 * 100.0).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod all_answers;
mod at_rest;
mod bimatrix;
pub mod case;
mod cold;
pub mod compare;
mod cone;
pub mod counted;
mod critical;
mod descent;
pub mod engines;
pub mod error;
pub mod exact;
pub mod explain;
pub mod finish;
pub mod follow;
mod from_zero_load;
mod history_answer;
pub mod known_collapses;
mod ladder;
pub mod load_rates;
pub mod look;
mod plain;
pub mod plain_answers;
pub mod prepared;
pub mod problem;
pub mod prove;
pub mod retry;
mod settle;
mod space;
pub mod state;
pub mod warm;
mod written_out;

pub use case::Case;
pub use error::SolveError;
pub use prepared::{PrepareError, Prepared, prepare, prepare_at};
pub use state::Solved;
