//! The linear algebra that stickslip takes from faer, in f64.
//!
//! faer is generic: what calls it compiles it, each time anew and, in tests, unoptimized. This crate calls it once, is optimized
//! always, and is the only one that names it. All of it runs on one thread, so that the bits of a result do not depend on the
//! machine's number of cores.

pub mod analysis;
pub mod blocks;
pub mod decompositions;
pub mod products;

/// Lets faer compute on one thread, so that the bits of a result do not depend on the number of threads; parallel
/// factorizations of the sizes met here are no faster.
pub fn compute_sequentially() {
    faer::set_global_parallelism(faer::Par::Seq);
}
