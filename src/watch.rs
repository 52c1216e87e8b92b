//! A look from outside into long work: progress, and whether to stop.

/// Hears of progress and may ask to stop. Both are called often and return at once.
pub trait Watch: Sync {
    /// `what` is being done; `fraction` of it (0 … 1) is ready.
    fn progress(&self, what: &str, fraction: f64) {
        let _ = (what, fraction);
    }

    /// Whether the work shall end as interrupted.
    fn stop(&self) -> bool {
        false
    }
}

/// Nobody looks.
pub struct Quiet;

impl Watch for Quiet {}
