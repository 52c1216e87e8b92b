//! A small LCP solved for its own sake: no trace, no retries.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::basis_solution::vertex;
use super::driver::run;
use super::lemke::SchemeEngine;
use super::mirrored::MirroredLcp;
use super::outcome::Outcome;
use super::problem::{Lcp, Scale};
use super::ratio_test::TieRule;

/// Pivots after which it is given up.
const PIVOTS: usize = 10_000;

/// z of w = M z + q ≥ 0, z ≥ 0, wᵀz = 0; `None` where Lemke's algorithm finds none. Where M is positive semidefinite
/// there is none then.
pub fn solution(matrix: Vec<Vec<f64>>, q: Vec<f64>) -> Option<Vec<f64>> {
    let n = q.len();
    let lcp = Lcp { covering: vec![1.0; n], scale: Scale::plain(&matrix), matrix, q };
    let lcp = Arc::new(MirroredLcp::plain(&lcp));
    let mut engine = SchemeEngine::new(Arc::clone(&lcp), TieRule::Lexicographic((0..n).collect()));
    let found = run(&mut engine, PIVOTS, &mut |_| ControlFlow::Continue(()));
    if !matches!(found.outcome, Outcome::Normal { .. }) {
        return None;
    }
    Some(vertex(&lcp, &found.pivots.basis()).unwrap_or(found.point).z)
}
