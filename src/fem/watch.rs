//! A look from outside into long work.

use super::error::MainSystemError;

/// Hears of progress and may ask to stop. Both are called often and should return at once.
pub trait Watch {
    /// `what` is being done; `fraction` of it (0 … 1) is ready.
    fn progress(&self, what: &str, fraction: f64) {
        let _ = (what, fraction);
    }

    /// Whether the work shall end with "interrupted".
    fn stop(&self) -> bool {
        false
    }
}

/// Nobody looks.
impl Watch for () {}

/// Interrupted, if the watcher says so.
pub(super) fn check_stop(watch: &dyn Watch) -> Result<(), MainSystemError> {
    if watch.stop() {
        Err(MainSystemError::Interrupted)
    } else {
        Ok(())
    }
}
