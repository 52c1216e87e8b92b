//! What decides among rows that block the entering variable at the same value.

/// Rule for tied rows.
#[derive(Clone, Debug, PartialEq)]
pub enum TieRule {
    /// p first; then the smallest row of B⁻¹ divided by the pivot, compared column by column in the order of
    /// the given rows of the LCP (the perturbation q + (ε, ε², …) in that order).
    Lexicographic(Vec<usize>),
    /// The first tied row of the LCP (p counts as the last): may cycle.
    FirstRow,
    /// A tied row drawn with this seed.
    Random(u64),
}
