//! The linear algebra of stickslip in f64: dense operations and the sparse Cholesky factorization with its Schur
//! complement.
//!
//! faer is generic: what calls it compiles it, each time anew and, in tests, unoptimized. This crate calls it once, is
//! optimized always, and is the only one that names it. All of it runs on one thread, so that the bits of a result do
//! not depend on the machine's number of cores; only the factorization of large matrices is spread, in pieces that do
//! not depend on it.

pub mod analysis;
pub mod blocks;
pub mod decompositions;
pub mod doubled;
pub mod least_norm;
pub mod products;
pub mod supernodes;
pub mod watch;

/// Lets faer compute on one thread, so that the bits of a result do not depend on the number of threads; parallel
/// factorizations of the sizes met here are no faster.
pub fn compute_sequentially() {
    faer::set_global_parallelism(faer::Par::Seq);
}
