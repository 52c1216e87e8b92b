//! Whether work can be spread over threads.

use std::error::Error;
use std::sync::OnceLock;

use crate::model::memory::address_space_left;

/// Address space that a thread takes at most for its stack and its share of the heap (glibc reserves 64 MiB and aligns
/// them to as many).
const BYTES_PER_THREAD: f64 = 136.0 * 1024.0 * 1024.0;

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
