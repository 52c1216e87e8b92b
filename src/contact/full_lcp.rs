//! The contact problem as one LCP with every row written out (method §3), in any number type.
//!
//! Coulomb, with f and c diagonal, laws mixed pair by pair:
//!
//! ```text
//! [x_n]   [ Rnn           RnT           −RnT         ] [z_n]   [ RFn               ]
//! [x⁺ ] = [ RTn + f·Rnn   RTT + f·RnT   −RTT − f·RnT ] [z⁺ ] + [ RFτ + f·RFn + c   ]
//! [x⁻ ]   [−RTn + f·Rnn  −RTT + f·RnT    RTT − f·RnT ] [z⁻ ]   [−RFτ + f·RFn + c   ]
//! ```
//!
//! with RF − R·(g, 0) in place of RF. Rows: x_n of all pairs that open, then x⁺ of all that have a tangential
//! joint, then their x⁻. A pair without a tangential joint has only x_n, a bilateral one only x^±.
//! The sums are formed in the number type asked for: exact from the f64 data in rationals.

use super::problem::ContactProblem;
use super::rows::{RowId, RowKind, rows};
use crate::lcp::exact::scalar::Scalar;
use crate::lcp::problem::{Lcp, Scale};
use crate::model::rules::Covering;

/// The force of a row as a combination of joints: Σ factor·λ_joint + fixed.
fn combination<T: Scalar>(problem: &ContactProblem, row: RowId) -> (Vec<(usize, T)>, T) {
    let mut terms = displacement(problem, row);
    if row.couple == RowKind::Normal {
        return (terms, T::zero());
    }
    let law = &problem.laws[row.pair];
    let f = T::from_f64(law.friction());
    if !f.is_zero() {
        terms.push((row.pair, f));
    }
    (terms, T::from_f64(law.fixed_bound()))
}

/// The joints that a displacement of the row moves, and by how much.
fn displacement<T: Scalar>(problem: &ContactProblem, row: RowId) -> Vec<(usize, T)> {
    let joints = row.joints(&problem.system, problem.polygon).filter(|(_, factor)| *factor != 0.0);
    joints.map(|(joint, factor)| (joint, T::from_f64(factor))).collect()
}

/// R in another number type, exactly where that type can.
fn stiffness_in<T: Scalar>(problem: &ContactProblem) -> Vec<Vec<T>> {
    let k = problem.system.joint_count();
    (0..k).map(|i| (0..k).map(|j| T::from_f64(problem.system.stiffness[(i, j)])).collect()).collect()
}

/// Forms the LCP, see the [module documentation](self).
pub fn full_lcp<T: Scalar>(problem: &ContactProblem, covering: Covering) -> Lcp<T> {
    let stiffness = stiffness_in::<T>(problem);
    let constants = problem.constants_with(&|i, j| stiffness[i][j].clone());
    full_lcp_of(problem, covering, &stiffness, &constants)
}

/// Forms the LCP with an R of its own, one row per joint, and RF − R·(g, 0), in place of those of the problem.
pub fn full_lcp_of<T: Scalar>(
    problem: &ContactProblem,
    covering: Covering,
    stiffness: &[Vec<T>],
    constants: &[T],
) -> Lcp<T> {
    let system = &*problem.system;
    let rows = rows(system, problem.polygon);
    let moved: Vec<Vec<(usize, T)>> = rows.iter().map(|row| displacement(problem, *row)).collect();
    let combinations: Vec<(Vec<(usize, T)>, T)> = rows.iter().map(|row| combination(problem, *row)).collect();
    let matrix = combinations
        .iter()
        .map(|(terms, _)| {
            let responses: Vec<T> = (0..system.joint_count())
                .map(|j| terms.iter().fold(T::zero(), |sum, (i, factor)| sum.add(&factor.mul(&stiffness[*i][j]))))
                .collect();
            let entry = |column: &Vec<(usize, T)>| {
                column.iter().fold(T::zero(), |sum, (joint, factor)| sum.add(&factor.mul(&responses[*joint])))
            };
            moved.iter().map(entry).collect()
        })
        .collect();
    let q = combinations
        .iter()
        .map(|(terms, fixed)| terms.iter().fold(fixed.clone(), |sum, (i, factor)| sum.add(&factor.mul(&constants[*i]))))
        .collect();
    let loads = combinations.iter().flat_map(|(terms, _)| terms);
    let loads = loads.map(|(i, factor)| (factor.to_f64() * constants[*i].to_f64()).abs());
    let root = |i: usize| system.stiffness[(i, i)].max(0.0).sqrt();
    let own = |row: &RowId| row.joints(system, problem.polygon).map(|(joint, d)| d.abs() * root(joint)).sum::<f64>();
    let row_scale = |row: &RowId| match row.couple {
        RowKind::Normal => own(row),
        RowKind::Facet(_) => problem.laws[row.pair].friction() * root(row.pair) + own(row),
    };
    let column_scale = |row: &RowId| {
        let root = own(row);
        if root > 0.0 { root } else { 1.0 }
    };
    let scale = Scale {
        load: Some(loads.fold(0.0, f64::max)),
        row: rows.iter().map(row_scale).collect(),
        column: rows.iter().map(column_scale).collect(),
    };
    let covering = rows.iter().map(|row| covering_entry(problem, *row, covering)).collect();
    Lcp { matrix, q, covering, scale }
}

/// d_n or d_τ of a row (method §4), summed in the number type: [`PairLaw::covering`](super::law::PairLaw::covering).
fn covering_entry<T: Scalar>(problem: &ContactProblem, row: RowId, covering: Covering) -> T {
    let law = &problem.laws[row.pair];
    match covering {
        _ if row.couple == RowKind::Normal || law.is_bilateral() => T::one(),
        Covering::Cohesive => T::one().add(&T::from_f64(law.friction())),
        Covering::Ones => T::one(),
        Covering::Weight => T::from_f64(law.friction()),
    }
}

#[cfg(test)]
#[path = "full_lcp_tests.rs"]
pub(crate) mod tests;
