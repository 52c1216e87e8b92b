//! Work that is spread over threads, with the same results on any number of them.

use std::error::Error;
use std::sync::OnceLock;

use rayon::prelude::*;

use crate::model::memory::address_space_left;

/// Address space that a thread takes at most for its stack and its share of the heap (glibc reserves 64 MiB and aligns
/// them to as many).
const BYTES_PER_THREAD: f64 = 136.0 * 1024.0 * 1024.0;

/// Fewer unknowns than these are not worth a second thread.
const LARGE: usize = 2000;

/// Whether the pool of threads exists; makes it at the first call. Where the system refuses or the address space is
/// limited (`ulimit -v`), work goes on on one thread, with the same results. Small work should not ask.
pub fn can_spread() -> bool {
    static POOL: OnceLock<bool> = OnceLock::new();
    *POOL.get_or_init(|| {
        let threads = std::thread::available_parallelism().map_or(1, usize::from) as f64;
        if address_space_left().is_some_and(|left| left < threads * BYTES_PER_THREAD) {
            return false;
        }
        match rayon::ThreadPoolBuilder::new().build_global() {
            Ok(()) => true,
            // Without a source: somebody else made it before.
            Err(error) => error.source().is_none(),
        }
    })
}

/// `work` on each item, in their order; so many of them are worth a thread of their own.
pub fn map_all<I: Send, T: Send>(items: Vec<I>, worth: usize, work: impl Fn(I) -> T + Sync + Send) -> Vec<T> {
    if items.len() >= 2 * worth && can_spread() {
        items.into_par_iter().with_min_len(worth).map(work).collect()
    } else {
        items.into_iter().map(work).collect()
    }
}

/// Elements of which something is kept at once, and how many are worth a thread.
const AT_ONCE: usize = 4096;
const OF_A_THREAD: usize = 64;

/// What `of` makes of each element, on all threads, to `take` in their order, up to its first error.
///
/// # Errors
/// Those of `take`.
pub fn each_element<T: Send, E>(
    elements: impl Iterator<Item = usize>,
    of: impl Fn(usize) -> T + Sync + Send,
    mut take: impl FnMut(usize, T) -> Result<(), E>,
) -> Result<(), E> {
    let elements: Vec<usize> = elements.collect();
    for some in elements.chunks(AT_ONCE) {
        for (&index, made) in some.iter().zip(map_all(some.to_vec(), OF_A_THREAD, &of)) {
            take(index, made)?;
        }
    }
    Ok(())
}

/// Whether work on so many unknowns is worth threads, and there are some.
pub fn can_spread_over(unknowns: usize) -> bool {
    unknowns >= LARGE && can_spread()
}

/// Two things at once where there are so many unknowns that it is worth it.
pub fn both<A: Send, B: Send>(unknowns: usize, a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    if can_spread_over(unknowns) { rayon::join(a, b) } else { (a(), b()) }
}
