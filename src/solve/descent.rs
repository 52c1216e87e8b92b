//! An answer of an LCP that states the first-order conditions of a quadratic program which is not convex.
//!
//! ```text
//!     min ½ xᵀQ x + cᵀx,  A x ≤ b,  x ≥ 0:     w = [Q Aᵀ; −A 0] (x, y) + (c, b),   Q symmetric
//! ```
//! Lemke's algorithm may end in a ray there. Steps towards the least of ½ xᵀQ x + cᵀx + ½ ρ |x − xₖ|², where ρ makes Q + ρ convex,
//! go down until none is left (proximal points: Rockafellar 1976), and each is an LCP that Lemke's algorithm does solve. Where the
//! basis of a step is that of the one before, it is that of an answer, if its equations have one.

use std::sync::Arc;

use nalgebra::DMatrix;
use stickslip_numerics::decompositions::smallest_eigenvalue;

use super::engines::run_scheme;
use super::error::SolveError;
use super::settle::settled;
use crate::answer::check_plain::{ROW_ROUNDING, check_plain};
use crate::lcp::basis_solution::vertex;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Outcome;
use crate::lcp::ratio_test::TieRule;
use crate::watch::Watch;

/// Steps of one descent.
const STEPS: usize = 1000;
/// ρ as a multiple of the least with which Q + ρ is not negative in any direction: halfway between long steps, for which a small
/// one is good, and equations that are far from singular.
const CONVEX: f64 = 2.0;

/// z of an LCP of this form; `None` where it is not of it, is convex, has no x, or the descent comes to no end. The caller checks
/// z.
///
/// # Errors
/// Interrupted.
pub(super) fn descent(lcp: &MirroredLcp, watch: &dyn Watch) -> Result<Option<Vec<f64>>, SolveError> {
    let Some(x) = variables(lcp) else { return Ok(None) };
    let curvature = DMatrix::from_fn(x.len(), x.len(), |i, j| lcp.base[(x[i], x[j])]);
    let Some(least) = smallest_eigenvalue(&curvature).filter(|least| *least < 0.0) else { return Ok(None) };
    let weight = -CONVEX * least;
    let mut base = DMatrix::clone(&lcp.base);
    x.iter().for_each(|&i| base[(i, i)] += weight);
    let mut step = MirroredLcp { base: Arc::new(base), ..MirroredLcp::clone(lcp) };
    let mut before = None;
    for _ in 0..STEPS {
        let rule = TieRule::Lexicographic((0..lcp.size()).collect());
        let run = run_scheme(&Arc::new(step.clone()), rule, watch);
        match run.outcome {
            Outcome::Trivial | Outcome::Normal { .. } => {}
            Outcome::Interrupted => return Err(SolveError::Interrupted),
            _ => return Ok(None),
        }
        let basis = run.pivots.basis();
        if before.as_ref() == Some(&basis)
            && let Some(point) = vertex(lcp, &basis)
        {
            let z = settled(lcp, &basis, &point, watch).z;
            if check_plain(lcp, &z, ROW_ROUNDING).passed {
                return Ok(Some(z));
            }
        }
        x.iter().for_each(|&i| step.q[i] = lcp.q[i] - weight * run.point.z[i]);
        before = Some(basis);
    }
    Ok(None)
}

/// The rows of x: all but those whose diagonal is 0 and that are beside all others as y is; `None` where there are none, or their
/// block is not symmetric.
fn variables(lcp: &MirroredLcp) -> Option<Vec<usize>> {
    let (n, m) = (lcp.size(), &lcp.base);
    if lcp.mirrors.iter().any(Option::is_some) {
        return None;
    }
    let is_multiplier = |i: usize| (0..n).all(|j| m[(i, j)] == -m[(j, i)]);
    let x: Vec<usize> = (0..n).filter(|&i| !is_multiplier(i)).collect();
    let is_symmetric = x.iter().all(|&i| x.iter().all(|&j| m[(i, j)] == m[(j, i)]));
    (is_symmetric && !x.is_empty()).then_some(x)
}
