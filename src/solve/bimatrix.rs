//! An answer of a bimatrix game, for which Lemke's algorithm needs the players' values as unknowns.

use std::sync::Arc;

use super::engines::run_scheme;
use super::error::SolveError;
use super::ladder::EXACT_BUDGET;
use super::settle::settled;
use crate::lcp::basis::Basis;
use crate::lcp::bimatrix::Bimatrix;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point};
use crate::lcp::ratio_test::TieRule;
use crate::watch::{Budget, Watch};

/// z from an equilibrium of the game that the LCP states; `None` where it states none or no equilibrium is found. The
/// caller checks z.
///
/// # Errors
/// Interrupted.
pub(super) fn equilibrium(lcp: &MirroredLcp, watch: &dyn Watch) -> Result<Option<Vec<f64>>, SolveError> {
    let Some(game) = Bimatrix::of(lcp) else { return Ok(None) };
    let with_values = Arc::new(MirroredLcp::plain(&game.with_values()));
    let rule = TieRule::Lexicographic((0..with_values.size()).collect());
    let run = run_scheme(&with_values, rule, watch);
    match run.outcome {
        Outcome::Normal { .. } => {}
        Outcome::Interrupted => return Err(SolveError::Interrupted),
        _ => return Ok(None),
    }
    let Some(z) = game.answer(&run.point.z) else { return Ok(None) };
    let rows: Vec<usize> = (0..lcp.size()).filter(|&row| z[row] > 0.0).collect();
    let w = (lcp.times(&z) + &lcp.q).iter().copied().collect();
    let basis = Basis { z: rows.clone(), active: rows, p: false };
    Ok(Some(settled(lcp, &basis, &Point { w, z, p: 0.0 }, &Budget::new(watch, EXACT_BUDGET)).z))
}
