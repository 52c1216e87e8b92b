//! Stopping from outside, as an error of this module.

use super::error::MainSystemError;
use crate::watch::Watch;

/// Interrupted, if the watcher says so.
pub(super) fn check_stop(watch: &dyn Watch) -> Result<(), MainSystemError> {
    if watch.stop() { Err(MainSystemError::Interrupted) } else { Ok(()) }
}
