//! Whether work can be spread over threads.

use std::error::Error;
use std::sync::OnceLock;

/// Whether the pool of threads exists; makes it at the first call. Where the system refuses (`ulimit -v`, `ulimit -u`),
/// work goes on on one thread, with the same results.
pub fn can_spread() -> bool {
    static POOL: OnceLock<bool> = OnceLock::new();
    *POOL.get_or_init(|| match rayon::ThreadPoolBuilder::new().build_global() {
        Ok(()) => true,
        // Without a source: somebody else made it before.
        Err(error) => error.source().is_none(),
    })
}
