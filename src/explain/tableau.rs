//! The dictionary of a small problem at a vertex: every basic variable as value + Σ rate·nonbasic, user's units.

use serde::Serialize;

use super::vertex::{Naming, basics, value};
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::{direction, vertex};
use crate::lcp::outcome::Point;
use crate::lcp::pivot::PivotLog;
use crate::lcp::variable::Variable;

/// Most rows that are printed.
pub const MOST_ROWS: usize = 12;

/// See the module.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dictionary {
    /// The pivot after which it stands; `None`: before the entry of p.
    pub step: Option<usize>,
    /// Names of the basic variables, row by row.
    pub basic: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// Names of the nonbasic variables, column by column.
    pub nonbasic: Vec<String>,
    /// Rates, row by row.
    pub rates: Vec<Vec<f64>>,
    /// The variable that enters next; `None` at the end.
    pub entering: Option<String>,
    /// The variable that leaves next.
    pub leaving: Option<String>,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoDictionary {
    /// Too large to print.
    #[error("the dictionary has {0} rows: it is printed up to {MOST_ROWS}")]
    TooLarge(usize),
    /// The basis is singular.
    #[error("the equations of this basis are singular")]
    Singular,
}

/// The dictionary after `step` pivots (`None`: the start).
///
/// # Errors
/// See [`NoDictionary`].
pub fn dictionary(naming: &Naming, log: &PivotLog, step: Option<usize>) -> Result<Dictionary, NoDictionary> {
    let pivots = log.recorded();
    let lcp = naming.lcp();
    let n = lcp.full_size;
    if n > MOST_ROWS {
        return Err(NoDictionary::TooLarge(n));
    }
    let done = step.map_or(0, |step| (step + 1).min(log.count()));
    let basis = pivots.get(..done).map_or_else(|| log.basis(), Basis::after);
    let point = vertex(lcp, &basis).ok_or(NoDictionary::Singular)?;
    let basic = basics(lcp, &basis);
    let nonbasic: Vec<Variable> = (0..n)
        .map(Variable::Z)
        .filter(|v| !basic.contains(v))
        .chain((0..n).map(Variable::W).filter(|v| !basic.contains(v)))
        .chain((!basis.p).then_some(Variable::P))
        .collect();
    let columns: Vec<Point> = nonbasic
        .iter()
        .map(|variable| direction(lcp, &basis, *variable).map(|ray| Point { z: ray.z, w: ray.w, p: ray.p }))
        .collect::<Option<_>>()
        .ok_or(NoDictionary::Singular)?;
    let clean = |value: f64, size: f64| {
        if value.abs() <= 1e-13 * size { 0.0 } else { value }
    };
    let rates = basic
        .iter()
        .map(|row| {
            nonbasic
                .iter()
                .zip(&columns)
                .map(|(variable, column)| {
                    let largest = basic.iter().map(|v| value(column, *v).abs()).fold(0.0, f64::max);
                    clean(value(column, *row), largest) * naming.unit(*row) / naming.unit(*variable)
                })
                .collect()
        })
        .collect();
    let largest = basic.iter().map(|v| value(&point, *v).abs()).fold(0.0, f64::max);
    let next = pivots.get(done);
    let names = |variables: &[Variable]| variables.iter().map(|v| naming.name(*v)).collect();
    Ok(Dictionary {
        step: done.checked_sub(1),
        values: basic.iter().map(|v| clean(value(&point, *v), largest) * naming.unit(*v)).collect(),
        basic: names(&basic),
        nonbasic: names(&nonbasic),
        rates,
        entering: next.map(|pivot| naming.name(pivot.entering)),
        leaving: next.map(|pivot| naming.name(pivot.leaving)),
    })
}
