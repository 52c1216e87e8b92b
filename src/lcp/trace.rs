//! The record of a run: one entry per pivot, no copies of states.

use super::variable::Variable;

/// One pivot: `entering` became basic, `leaving` nonbasic.
#[derive(Clone, Debug, PartialEq)]
pub struct Pivot {
    /// 0 is the entry of p.
    pub step: usize,
    /// The variable that became basic.
    pub entering: Variable,
    /// The variable that blocked it and became nonbasic.
    pub leaving: Variable,
    /// p before the pivot (at step 0: the p that is needed).
    pub p_before: f64,
    /// p after the pivot.
    pub p_after: f64,
    /// Value that the entering variable reached.
    pub ratio: f64,
    /// All rows that blocked at that value, the leaving one among them, in the order of the rows.
    pub ties: Vec<Variable>,
}
