//! Linear complementarity problems and Lemke's algorithm: pure algebra, knows no structures.
//!
//! w = M z + q + d p, w ≥ 0, z ≥ 0, wᵀz = 0, p let down to 0:
//!
//! ```
//! use std::ops::ControlFlow;
//! use stickslip::lcp::{driver::run, problem::{Lcp, Scale}, ratio_test::TieRule, exact::tableau::Tableau};
//!
//! let matrix = vec![vec![2.0, 1.0], vec![1.0, 2.0]];
//! let lcp = Lcp { scale: Scale::plain(&matrix), matrix, q: vec![-5.0, -6.0], covering: vec![1.0, 1.0] };
//! let mut engine = Tableau::new(&lcp, TieRule::Lexicographic(vec![0, 1]));
//! let run = run(&mut engine, 100, &mut |pivot| {
//!     println!("{:?} enters, {:?} leaves, p = {}", pivot.entering, pivot.leaving, pivot.p_after);
//!     ControlFlow::Continue(())
//! });
//! // 2·4/3 + 7/3 = 5 and 4/3 + 2·7/3 = 6.
//! assert!((run.point.z[0] - 4.0 / 3.0).abs() < 1e-15 && (run.point.z[1] - 7.0 / 3.0).abs() < 1e-15);
//! ```
//!
//! [`exact::tableau`] is generic over its numbers and obviously right; [`lemke`] is the fast engine on [`mirrored`]
//! rows.

pub mod basis;
pub mod basis_solution;
pub mod bimatrix;
mod dictionary;
pub mod driver;
pub mod exact;
pub mod lemke;
pub mod linear_program;
pub mod mirrored;
pub mod outcome;
pub mod parametric;
pub mod pivot;
mod pivot_state;
pub mod problem;
pub mod ratio_test;
pub mod solution;
mod updated_matrix;
pub mod variable;
mod waiting_steps;
