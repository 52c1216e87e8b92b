//! Which order of elimination costs less: the unknowns that joints tie to others behind the rest, or among them.
//!
//! Behind the rest they leave the bodies apart before, and only the body that C belongs to carries the rows of z; but
//! they end in one dense block with all of z, with about as many unknowns as joints:
//! the cube of their number. Among the rest each cut through the bodies reaches only the joints on its own stretch, and
//! all of them carry rows of z. Counted for the matrix at hand.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};

use super::error::MainSystemError;
use super::order::{Places, elimination_order};
use super::sparse::SymmetricSparse;
use crate::watch::Watch;

/// Position of each row of K_m in the cheaper order.
///
/// # Errors
/// Out of memory; interrupted.
pub fn best_order(
    k_m: &SymmetricSparse,
    places: Places,
    c: &[(u32, u32, f64)],
    joints: usize,
    watch: &dyn Watch,
) -> Result<Vec<u32>, MainSystemError> {
    let positions = |last: &[bool]| -> Result<Vec<u32>, MainSystemError> {
        let order = elimination_order(k_m, Places { last, ..places }, watch)?;
        let mut position = vec![0_u32; order.len()];
        for (at, &row) in order.iter().enumerate() {
            position[row as usize] = at as u32;
        }
        Ok(position)
    };
    let behind = positions(places.last)?;
    let tied = places.last.iter().filter(|last| **last).count() as f64;
    // Elimination of `tied` of `tied + joints` dense columns.
    let block = ((tied + joints as f64).powi(3) - (joints as f64).powi(3)) / 3.0;
    let cost = operations(k_m, &behind, c, joints)?;
    if block < WORTH_TRYING * cost {
        return Ok(behind);
    }
    let among = positions(&vec![false; k_m.order()])?;
    Ok(if operations(k_m, &among, c, joints)? < cost { among } else { behind })
}

/// The dense block is what the other order can save: below this share of all operations it is not tried.
const WORTH_TRYING: f64 = 0.1;

/// Multiplications of the elimination of K_m in an order, with the rows of z behind it: the sum of the squared lengths
/// of the columns of L.
fn operations(
    k_m: &SymmetricSparse,
    position: &[u32],
    c: &[(u32, u32, f64)],
    joints: usize,
) -> Result<f64, MainSystemError> {
    let out_of_memory = || MainSystemError::OutOfMemory { doing: "ordering the unknowns" };
    let n = k_m.order();
    let order = n + joints;
    // The upper triangle by columns.
    let each = |visit: &mut dyn FnMut(usize, usize)| {
        for column in 0..n {
            let a = position[column] as usize;
            for (row, _) in k_m.column(column) {
                let b = position[row] as usize;
                visit(a.min(b), a.max(b));
            }
        }
        for &(row, joint, _) in c {
            visit(position[row as usize] as usize, n + joint as usize);
        }
    };
    let mut start = vec![0_u32; order + 1];
    each(&mut |_, column| start[column + 1] += 1);
    for column in 0..order {
        start[column + 1] += start[column];
    }
    let mut next = start.clone();
    let mut rows = vec![0_u32; start[order] as usize];
    each(&mut |row, column| {
        rows[next[column] as usize] = row as u32;
        next[column] += 1;
    });
    let (mut tree, mut counts) = (vec![0_i32; order], vec![0_u32; order]);
    let request = prefactorize_symbolic_cholesky_scratch::<u32>(order, rows.len());
    let mut memory = MemBuffer::try_new(request).map_err(|_| out_of_memory())?;
    prefactorize_symbolic_cholesky(
        &mut tree,
        &mut counts,
        SymbolicSparseColMatRef::new_unsorted_checked(order, order, &start, None, &rows),
        MemStack::new(&mut memory),
    );
    Ok(counts[..n].iter().map(|&count| f64::from(count).powi(2)).sum())
}
