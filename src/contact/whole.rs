//! The contact problem as one LCP with every row written out (theory §3), in any number type.
//!
//! Coulomb, with f and c diagonal, laws mixed pair by pair:
//!
//! ```text
//! [x_n]   [ Rnn           RnT           −RnT         ] [z_n]   [ RFn               ]
//! [x⁺ ] = [ RTn + f·Rnn   RTT + f·RnT   −RTT − f·RnT ] [z⁺ ] + [ RFτ + f·RFn + c   ]
//! [x⁻ ]   [−RTn + f·Rnn  −RTT + f·RnT    RTT − f·RnT ] [z⁻ ]   [−RFτ + f·RFn + c   ]
//! ```
//!
//! with RF − R·(g, 0) in the place of RF. Rows: x_n of all pairs but the bound ones, then x⁺ of all Coulomb and
//! bound pairs, then their x⁻. A frictionless pair has only x_n; a bound pair only x^± = r_f ± x_τ.
//! The sums are formed in the number type asked for: exact from the f64 data in rationals.

use crate::lcp::problem::{Lcp, Scale};
use crate::lcp::scalar::Scalar;
use crate::model::pair::Law;
use crate::model::rules::Covering;

use super::numbers::ContactNumbers;
use super::system::ContactSystem;

/// What [`whole_lcp`] needs.
#[derive(Clone, Copy, Debug)]
pub struct WholeInput<'a> {
    /// Pairs and R.
    pub system: &'a ContactSystem,
    /// Numbers of the laws and the load.
    pub numbers: &'a ContactNumbers,
    /// Covering vector.
    pub covering: Covering,
}

/// Quantity of a pair that a row of the LCP stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// x_n with z_n.
    Normal,
    /// x⁺ with z⁺.
    Plus,
    /// x⁻ with z⁻.
    Minus,
}

/// A row of the LCP.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Row {
    /// Index of the pair.
    pub pair: usize,
    /// Which of its quantities.
    pub kind: RowKind,
}

/// The rows of the LCP in order.
pub fn rows(system: &ContactSystem) -> Vec<Row> {
    let of = |kind: RowKind, has: fn(&Law) -> bool| {
        system
            .pairs
            .iter()
            .enumerate()
            .filter(move |(_, pair)| has(&pair.law))
            .map(move |(pair, _)| Row { pair, kind })
    };
    let normal: fn(&Law) -> bool = |law| !matches!(law, Law::Bound { .. });
    let tangential: fn(&Law) -> bool = |law| !matches!(law, Law::Frictionless { .. });
    of(RowKind::Normal, normal)
        .chain(of(RowKind::Plus, tangential))
        .chain(of(RowKind::Minus, tangential))
        .collect()
}

/// Row of R of the tangential joint of a pair that has one by its law.
///
/// # Panics
/// If a Coulomb or bound pair has no tangential joint: a [`ContactSystem`] is never built so.
pub(crate) fn tangential_joint(system: &ContactSystem, pair: usize) -> usize {
    system.pairs[pair]
        .tangential
        .expect("a coulomb or bound pair has a tangential joint")
}

/// f of a pair as its law uses it: 0 for frictionless and bound pairs.
pub(crate) fn friction(system: &ContactSystem, numbers: &ContactNumbers, pair: usize) -> f64 {
    match system.pairs[pair].law {
        Law::Coulomb { .. } => numbers.friction[pair],
        Law::Frictionless { .. } | Law::Bound { .. } => 0.0,
    }
}

/// The part of the friction bound that does not depend on x_n: c, or r_f of a bound pair.
pub(crate) fn fixed_bound(system: &ContactSystem, numbers: &ContactNumbers, pair: usize) -> f64 {
    match system.pairs[pair].law {
        Law::Coulomb { .. } => numbers.cohesion[pair],
        Law::Bound { .. } => numbers.bound[pair],
        Law::Frictionless { .. } => 0.0,
    }
}

/// The quantities of a row as a combination of joints: Σ factor·λ_joint + fixed.
fn combination<T: Scalar>(input: &WholeInput, row: Row) -> (Vec<(usize, T)>, T) {
    let WholeInput {
        system, numbers, ..
    } = *input;
    let pair = row.pair;
    let side = match row.kind {
        RowKind::Normal => return (vec![(pair, T::one())], T::zero()),
        RowKind::Plus => T::one(),
        RowKind::Minus => T::one().neg(),
    };
    let mut terms = vec![(tangential_joint(system, pair), side)];
    let f = T::from_f64(friction(system, numbers, pair));
    if !f.is_zero() {
        terms.push((pair, f));
    }
    (terms, T::from_f64(fixed_bound(system, numbers, pair)))
}

/// RF − R·(g, 0): the joint forces of the main system with all gaps closed by force.
pub fn joint_constants<T: Scalar>(system: &ContactSystem, numbers: &ContactNumbers) -> Vec<T> {
    (0..system.joint_count())
        .map(|i| {
            let mut sum = T::from_f64(numbers.load[i]);
            for (k, pair) in system.pairs.iter().enumerate() {
                let gap = numbers.gap[k];
                if gap != 0.0 && !matches!(pair.law, Law::Bound { .. }) {
                    let force = T::from_f64(system.stiffness[(i, k)]).mul(&T::from_f64(gap));
                    sum = sum.sub(&force);
                }
            }
            sum
        })
        .collect()
}

/// Forms the LCP, see the [module documentation](self).
pub fn whole_lcp<T: Scalar>(input: &WholeInput) -> Lcp<T> {
    let WholeInput {
        system,
        numbers,
        covering,
    } = *input;
    let rows = rows(system);
    let combinations: Vec<(Vec<(usize, T)>, T)> =
        rows.iter().map(|row| combination(input, *row)).collect();
    let joint = |row: &Row| match row.kind {
        RowKind::Normal => row.pair,
        RowKind::Plus | RowKind::Minus => tangential_joint(system, row.pair),
    };
    let constants = joint_constants::<T>(system, numbers);
    let stiffness: Vec<Vec<T>> = (0..system.joint_count())
        .map(|i| {
            (0..system.joint_count())
                .map(|j| T::from_f64(system.stiffness[(i, j)]))
                .collect()
        })
        .collect();

    let matrix = combinations
        .iter()
        .map(|(terms, _)| {
            let responses: Vec<T> = (0..system.joint_count())
                .map(|j| {
                    terms.iter().fold(T::zero(), |sum, (i, factor)| {
                        sum.add(&factor.mul(&stiffness[*i][j]))
                    })
                })
                .collect();
            rows.iter()
                .map(|column| match column.kind {
                    RowKind::Normal | RowKind::Plus => responses[joint(column)].clone(),
                    RowKind::Minus => responses[joint(column)].neg(),
                })
                .collect()
        })
        .collect();
    let q = combinations
        .iter()
        .map(|(terms, fixed)| {
            terms.iter().fold(fixed.clone(), |sum, (i, factor)| {
                sum.add(&factor.mul(&constants[*i]))
            })
        })
        .collect();
    let cover = rows
        .iter()
        .map(|row| covering_entry::<T>(input, *row, covering))
        .collect();
    let root = |i: usize| system.stiffness[(i, i)].max(0.0).sqrt();
    let scale = Scale {
        row: rows
            .iter()
            .map(|row| match row.kind {
                RowKind::Normal => root(row.pair),
                RowKind::Plus | RowKind::Minus => {
                    friction(system, numbers, row.pair) * root(row.pair) + root(joint(row))
                }
            })
            .collect(),
        column: rows
            .iter()
            .map(|row| {
                let root = root(joint(row));
                if root > 0.0 { root } else { 1.0 }
            })
            .collect(),
    };
    Lcp {
        matrix,
        q,
        covering: cover,
        scale,
    }
}

/// d_n or d_τ of a row (theory §4, "Coverings").
fn covering_entry<T: Scalar>(input: &WholeInput, row: Row, covering: Covering) -> T {
    let law = &input.system.pairs[row.pair].law;
    if row.kind == RowKind::Normal || !matches!(law, Law::Coulomb { .. }) {
        return T::one();
    }
    let f = T::from_f64(input.numbers.friction[row.pair]);
    match covering {
        Covering::Cohesive => T::one().add(&f),
        Covering::Ones => T::one(),
        Covering::Weight => f,
    }
}

#[cfg(test)]
#[path = "whole_tests.rs"]
pub(crate) mod tests;
