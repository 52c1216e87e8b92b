//! Runs of their own just beside a place on a load path.

use super::load_parameter::LoadParameter;
use super::start::PathError;
use crate::model::rules::Rules;
use crate::solve::problem::factors;
use crate::solve::{Case, Prepared, Solved};
use crate::text::number::rounded;

/// The end of a path is confirmed by runs of their own at (1 ± this) of it.
pub(super) const BESIDE: f64 = 1e-6;

/// A run of its own at a value beside a place.
#[derive(Clone, Debug)]
pub(super) struct Beside {
    pub(super) value: f64,
    /// The structure there, and its load factors.
    pub(super) prepared: Prepared,
    pub(super) factors: Vec<f64>,
    pub(super) solved: Solved,
}

impl Beside {
    /// The run under another value of what is followed, with all its retries; `moves_loads` where that stands in the loads
    /// themselves.
    pub(super) fn run(
        parameter: &LoadParameter,
        moves_loads: bool,
        case: Case<'_>,
        value: f64,
    ) -> Result<Beside, PathError> {
        let (prepared, factors) = there(parameter, moves_loads, case, value)?;
        let solved = Case { prepared: &prepared, ..case }.under(Rules::default()).solve_pairs()?;
        Ok(Beside { value, prepared, factors, solved })
    }

    /// Whether it is an answer beyond all doubt.
    pub(super) fn is_plain_answer(&self) -> bool {
        self.solved.answer.is_answer() && !self.solved.answer.marginal
    }
}

/// The structure under another value of what is followed, made ready, and its load factors.
pub(super) fn there(
    parameter: &LoadParameter,
    moves_loads: bool,
    case: Case<'_>,
    value: f64,
) -> Result<(Prepared, Vec<f64>), PathError> {
    if moves_loads {
        // Where the parameter stands in the loads themselves, they are read anew at this value.
        let there = case.at(&parameter.name, value)?;
        let factors = factors(&there.prepared, &there.values);
        return Ok((there.prepared.with_factors(&factors), factors));
    }
    let mut factors = factors(case.prepared, case.values);
    parameter.drive(&mut factors, value);
    Ok((case.prepared.with_factors(&factors), factors))
}

/// The size of a load: one of 0 has that of its present value, or none of its own.
pub(super) fn size(factor: f64, present: f64) -> f64 {
    [factor.abs(), present.abs()].into_iter().find(|size| *size > 0.0).unwrap_or(1.0)
}

/// What is said of a path over a load beyond whose end there is an answer; `further` is the command that looks for more.
pub(super) fn no_limit(end: &str, further: &str) -> String {
    format!("{end}: not the largest load that can be carried; {further} looks further")
}

/// The command that looks for answers from a value on, as far as `reach`.
pub(super) fn search(name: &str, from: f64, reach: f64) -> String {
    let to = from + reach;
    let (low, high) = (nine_digits(from.min(to)), nine_digits(from.max(to)));
    format!("`find {name} {low}..{high} where outcome answer`")
}

/// With nine significant digits, which tell apart what lies [`BESIDE`] from one another.
pub(super) fn nine_digits(value: f64) -> f64 {
    rounded(value, 9)
}
