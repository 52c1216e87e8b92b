//! A look from outside into long work.

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
