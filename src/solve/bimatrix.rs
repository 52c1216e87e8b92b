//! An answer of a bimatrix game, for which Lemke's algorithm needs the players' values as unknowns.

use std::sync::Arc;

use super::engines::{covered, run_scheme};
use super::error::SolveError;
use super::ladder::EXACT_BUDGET;
use super::settle::settled;
use crate::answer::attempt::PlainCovering;
use crate::answer::check_plain::{ROW_ROUNDING, check_plain};
use crate::lcp::basis::Basis;
use crate::lcp::bimatrix::Bimatrix;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point};
use crate::lcp::ratio_test::TieRule;
use crate::watch::{Budget, Watch};

/// Random covering vectors that are tried after that of ones: each leads to an equilibrium along a path of its own.
const COVERINGS: u64 = 8;

/// z from an equilibrium of the game that the LCP states; `None` where it states none or no equilibrium is found. The
/// caller checks z.
///
/// # Errors
/// Interrupted.
pub(super) fn equilibrium(lcp: &MirroredLcp, watch: &dyn Watch) -> Result<Option<Vec<f64>>, SolveError> {
    let Some(game) = Bimatrix::of(lcp) else { return Ok(None) };
    let with_values = Arc::new(MirroredLcp::plain(&game.with_values()));
    let mut last = None;
    for covering in std::iter::once(PlainCovering::Ones).chain((1..=COVERINGS).map(PlainCovering::Random)) {
        let rule = TieRule::Lexicographic((0..with_values.size()).collect());
        let run = run_scheme(&covered(&with_values, covering), rule, watch);
        match run.outcome {
            Outcome::Normal { .. } => {}
            Outcome::Interrupted => return Err(SolveError::Interrupted),
            _ => continue,
        }
        let Some(z) = game.answer(&run.point.z) else { continue };
        // Rows may be active whose z is 0: where strategies are as good as one another the equations are those of the basis.
        let basis = run.pivots.basis();
        let own = |rows: &[usize]| rows.iter().copied().filter(|&row| row < lcp.size()).collect();
        let basis = Basis { z: own(&basis.z), active: own(&basis.active), p: false };
        let w = (lcp.times(&z) + &lcp.q).iter().copied().collect();
        let z = settled(lcp, &basis, &Point { w, z, p: 0.0 }, &Budget::new(watch, EXACT_BUDGET)).z;
        if check_plain(lcp, &z, ROW_ROUNDING).passed {
            return Ok(Some(z));
        }
        last = Some(z);
    }
    Ok(last)
}
