//! Which order of elimination costs less: the unknowns that joints tie to others after the rest, or among them.
//!
//! After the rest, they keep the bodies apart up to there, and only the body that C belongs to carries the rows of z;
//! but they end in one dense block with all of z, with about as many unknowns as joints: the cube of their number.
//! Among the rest each cut through the bodies reaches only the joints on its own stretch, and all of them carry rows of
//! z. Counted for the matrix at hand.

use stickslip_numerics::analysis::{AnalysisError, SupernodePatterns, UpperPattern};
use stickslip_numerics::supernodes::Supernodes;

use super::assembly::Coupling;
use super::error::MainSystemError;
use super::order::{Places, elimination_order};
use super::sparse::SymmetricSparse;
use crate::watch::Watch;

/// The cheaper order.
///
/// # Errors
/// Out of memory; interrupted.
pub fn best_order(
    k_m: &SymmetricSparse,
    places: Places,
    c: &[Coupling],
    joints: usize,
    watch: &dyn Watch,
) -> Result<Ordered, MainSystemError> {
    let with = |last: &[bool]| Ordered::new(k_m, Places { last, ..places }, c, joints, watch);
    let tied = places.last.iter().filter(|last| **last).count() as f64;
    // Elimination of the first `tied` of `tied + joints` dense columns.
    let block = ((tied + joints as f64).powi(3) - (joints as f64).powi(3)) / 3.0;
    let none = vec![false; k_m.order()];
    if block > dissected(k_m.order()) {
        let among = with(&none)?;
        if among.operations <= block {
            return Ok(among);
        }
        return Ok(among.cheaper(with(places.last)?));
    }
    let behind = with(places.last)?;
    if block < WORTH_TRYING * behind.operations {
        return Ok(behind);
    }
    Ok(behind.cheaper(with(&none)?))
}

/// The dense block is what the other order can save: below this share of all operations it is not tried.
const WORTH_TRYING: f64 = 0.25;

/// Multiplications of nested dissection for a square plate of this many unknowns, two to a node: 829/84 · 8 of the
/// number of nodes to the power 3/2 (George 1973).
fn dissected(unknowns: usize) -> f64 {
    829.0 / 84.0 * 8.0 * (unknowns as f64 / 2.0).powf(1.5)
}

/// K_m with the rows of z after it, in some order of elimination.
pub struct Ordered {
    /// Position of each row of K_m.
    position: Vec<u32>,
    /// Multiplications of the elimination: the sum of the squared lengths of its columns of L.
    operations: f64,
    /// The supernodes of L, if they are not too large.
    patterns: Result<SupernodePatterns, AnalysisError>,
}

/// Where the analysis fails for want of memory.
pub fn out_of_memory() -> MainSystemError {
    MainSystemError::OutOfMemory { doing: "analysing the main system" }
}

impl Ordered {
    fn new(
        k_m: &SymmetricSparse,
        places: Places,
        c: &[Coupling],
        joints: usize,
        watch: &dyn Watch,
    ) -> Result<Ordered, MainSystemError> {
        let n = k_m.order();
        let mut position = vec![0_u32; n];
        for (at, row) in elimination_order(k_m, places, watch)?.into_iter().enumerate() {
            position[row as usize] = at as u32;
        }
        watch.progress(&format!("analysing {n} unknowns"), 0.0);
        let each = |visit: &mut dyn FnMut(u32, u32)| {
            for column in 0..n {
                let a = position[column];
                for (row, _) in k_m.column(column) {
                    let b = position[row];
                    visit(a.min(b), a.max(b));
                }
            }
            for &(row, joint, _) in c {
                visit(position[row as usize], n as u32 + joint);
            }
        };
        let order = n + joints;
        let mut start = vec![0_u32; order + 1];
        each(&mut |_, column| start[column as usize + 1] += 1);
        for column in 0..order {
            start[column + 1] += start[column];
        }
        let mut next = start.clone();
        let mut rows = vec![0_u32; start[order] as usize];
        each(&mut |row, column| {
            let at = &mut next[column as usize];
            rows[*at as usize] = row;
            *at += 1;
        });
        let (counts, patterns) = UpperPattern { start, rows }.analyse().map_err(|_| out_of_memory())?;
        let operations = counts[..n].iter().map(|&count| f64::from(count).powi(2)).sum();
        Ok(Ordered { position, operations, patterns })
    }

    fn cheaper(self, other: Ordered) -> Ordered {
        if other.operations < self.operations { other } else { self }
    }

    /// The position of each row of K_m, and the supernodes of L.
    ///
    /// # Errors
    /// Too large; out of memory.
    pub fn into_supernodes(self) -> Result<(Vec<u32>, Supernodes), AnalysisError> {
        let supernodes = Supernodes::new(self.position.len(), self.patterns?);
        Ok((self.position, supernodes))
    }
}
