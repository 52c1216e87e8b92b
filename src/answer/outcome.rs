//! How a run ended.

use serde::Serialize;

/// How the run ended, as the user reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OutcomeKind {
    /// The main system is the answer; no pivot.
    Trivial,
    /// p reached zero.
    Normal,
    /// No answer found: see [`Ray`](super::ray_record::Ray).
    Ray,
    /// The pivot limit was reached (a cycle ends here too).
    PivotLimit,
    /// The numbers no longer belonged together.
    Breakdown,
    /// An answer was found that failed its fresh check.
    CheckFailed,
}

impl OutcomeKind {
    /// The word used everywhere.
    pub fn word(self) -> &'static str {
        match self {
            OutcomeKind::Trivial => "trivial",
            OutcomeKind::Normal => "normal",
            OutcomeKind::Ray => "ray",
            OutcomeKind::PivotLimit => "pivot-limit",
            OutcomeKind::Breakdown => "breakdown",
            OutcomeKind::CheckFailed => "check-failed",
        }
    }

    /// Whether it is an answer.
    pub fn is_answer(self) -> bool {
        matches!(self, OutcomeKind::Trivial | OutcomeKind::Normal)
    }

    /// Whether the run failed: neither an answer nor a ray.
    pub fn is_failure(self) -> bool {
        matches!(self, OutcomeKind::PivotLimit | OutcomeKind::Breakdown | OutcomeKind::CheckFailed)
    }
}
