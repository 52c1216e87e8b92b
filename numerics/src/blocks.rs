//! In-place operations on blocks of larger matrices: what a supernodal factorization is made of.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
pub use faer::{Accum, MatMut, MatRef};

/// target := factor · left · right, or that added to it.
pub fn multiply(target: MatMut<f64>, accum: Accum, left: MatRef<f64>, right: MatRef<f64>, factor: f64) {
    matmul(target, accum, left, right, factor, Par::Seq);
}

/// right := lower⁻¹ right.
pub fn solve_lower(lower: MatRef<f64>, right: MatMut<f64>) {
    solve_lower_triangular_in_place(lower, right, Par::Seq);
}

/// right := upper⁻¹ right.
pub fn solve_upper(upper: MatRef<f64>, right: MatMut<f64>) {
    solve_upper_triangular_in_place(upper, right, Par::Seq);
}

/// Cholesky factorization of blocks up to some size.
pub struct BlockCholesky(MemBuffer);

/// A pivot is not positive.
pub struct NotPositive;

impl BlockCholesky {
    /// Room for blocks of this order; `None` where memory is short.
    pub fn new(order: usize) -> Option<BlockCholesky> {
        let request = cholesky_in_place_scratch::<f64>(order, Par::Seq, Default::default());
        MemBuffer::try_new(request).ok().map(BlockCholesky)
    }

    /// The lower triangle of a block := its Cholesky factor.
    ///
    /// # Errors
    /// The block is not positive definite.
    pub fn factorize(&mut self, block: MatMut<f64>) -> Result<(), NotPositive> {
        let memory = MemStack::new(&mut self.0);
        let factor = cholesky_in_place(block, Default::default(), Par::Seq, memory, Default::default());
        factor.map(|_| ()).map_err(|_| NotPositive)
    }
}
