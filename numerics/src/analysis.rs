//! The structure of sparse Cholesky factors: orders of elimination and supernodes.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::simplicial::{
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::cholesky::supernodal::{
    factorize_supernodal_symbolic_cholesky, factorize_supernodal_symbolic_cholesky_scratch,
};
use faer::sparse::{FaerError, SymbolicSparseColMatRef};

/// Why there is no structure.
#[derive(Debug)]
pub enum AnalysisError {
    /// More entries than a 32-bit index counts.
    TooLarge,
    /// Memory is short.
    OutOfMemory,
}

impl From<FaerError> for AnalysisError {
    fn from(error: FaerError) -> AnalysisError {
        match error {
            FaerError::IndexOverflow => AnalysisError::TooLarge,
            _ => AnalysisError::OutOfMemory,
        }
    }
}

/// Order of elimination by approximate minimum degree, of a symmetric pattern by columns (`start`, `rows`) without
/// duplicates.
///
/// # Errors
/// Out of memory.
pub fn minimum_degree_order(start: &[u32], rows: &[u32]) -> Result<Vec<u32>, AnalysisError> {
    let n = start.len() - 1;
    let (mut order, mut inverse) = (vec![0_u32; n], vec![0_u32; n]);
    let request = amd::order_scratch::<u32>(n, rows.len());
    let mut memory = MemBuffer::try_new(request).map_err(|_| AnalysisError::OutOfMemory)?;
    amd::order(
        &mut order,
        &mut inverse,
        SymbolicSparseColMatRef::new_checked(n, n, start, None, rows),
        amd::Control::default(),
        MemStack::new(&mut memory),
    )?;
    Ok(order)
}

/// The upper triangle of a symmetric pattern by columns: start of each column, and its rows, in any order, some twice.
pub struct UpperPattern {
    /// One entry more than columns.
    pub start: Vec<u32>,
    /// Rows of all columns.
    pub rows: Vec<u32>,
}

/// Columns of a Cholesky factor L that share their pattern.
pub struct SupernodePatterns {
    /// First column of each supernode, and the order of the matrix.
    pub begin: Vec<u32>,
    /// Where the pattern of each supernode starts in `rows`; one entry more than supernodes.
    pub pattern_start: Vec<usize>,
    /// Rows below the columns of the supernodes, ascending in each.
    pub rows: Vec<u32>,
}

impl UpperPattern {
    /// Columns of the pattern.
    pub fn order(&self) -> usize {
        self.start.len() - 1
    }

    /// How many entries each column of L has, and the supernodes of L if they are not too large.
    ///
    /// # Errors
    /// Out of memory.
    pub fn analyse(&self) -> Result<(Vec<u32>, Result<SupernodePatterns, AnalysisError>), AnalysisError> {
        let order = self.order();
        let (mut tree, mut counts) = (vec![0_i32; order], vec![0_u32; order]);
        let request = StackReq::or(
            prefactorize_symbolic_cholesky_scratch::<u32>(order, self.rows.len()),
            factorize_supernodal_symbolic_cholesky_scratch::<u32>(order),
        );
        let mut memory = MemBuffer::try_new(request).map_err(|_| AnalysisError::OutOfMemory)?;
        let stack = MemStack::new(&mut memory);
        let pattern = SymbolicSparseColMatRef::new_unsorted_checked(order, order, &self.start, None, &self.rows);
        let tree = prefactorize_symbolic_cholesky(&mut tree, &mut counts, pattern, stack);
        let structure = factorize_supernodal_symbolic_cholesky(pattern, tree, &counts, stack, Default::default());
        let patterns = structure.map_err(AnalysisError::from).map(|structure| {
            let mut begin = structure.supernode_begin().to_vec();
            let (mut pattern_start, mut rows) = (vec![0], Vec::new());
            for s in 0..begin.len() {
                rows.extend_from_slice(structure.supernode(s).pattern());
                pattern_start.push(rows.len());
            }
            begin.push(order as u32);
            SupernodePatterns { begin, pattern_start, rows }
        });
        Ok((counts, patterns))
    }
}
