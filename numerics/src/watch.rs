//! How long work is watched from outside: its progress, and whether it should stop.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Hears of progress and may ask to stop. Both are called often and return at once.
pub trait Watch: Sync {
    /// `what` is being done; `fraction` of it (0 … 1) is finished.
    fn progress(&self, what: &str, fraction: f64) {
        let _ = (what, fraction);
    }

    /// Whether the work is to end as interrupted.
    fn stop(&self) -> bool {
        false
    }

    /// The same for a loop that asks whether to go on.
    fn go_on(&self) -> ControlFlow<()> {
        if self.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Nobody looks.
pub struct Quiet;

impl Watch for Quiet {}

/// Continue until `end`: for work that is given no watch.
pub fn until(end: Instant) -> ControlFlow<()> {
    if Instant::now() < end { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// Another watch that also asks to stop when a time budget is used up.
pub struct Budget<'a> {
    watch: &'a dyn Watch,
    end: Instant,
}

impl<'a> Budget<'a> {
    /// This much time from now.
    pub fn new(watch: &'a dyn Watch, time: Duration) -> Budget<'a> {
        Budget { watch, end: Instant::now() + time }
    }

    /// Whether the time ran out, and nobody else stopped the work.
    pub fn ran_out(&self) -> bool {
        !self.watch.stop() && self.left().is_zero()
    }

    /// What is left.
    pub fn left(&self) -> Duration {
        self.end.saturating_duration_since(Instant::now())
    }
}

impl Watch for Budget<'_> {
    fn progress(&self, what: &str, fraction: f64) {
        self.watch.progress(what, fraction);
    }

    fn stop(&self) -> bool {
        self.watch.stop() || self.left().is_zero()
    }
}

/// Passes on the wish to stop, not the progress of a single step of many.
pub struct StopOnly<'a>(pub &'a dyn Watch);

impl Watch for StopOnly<'_> {
    fn stop(&self) -> bool {
        self.0.stop()
    }
}
