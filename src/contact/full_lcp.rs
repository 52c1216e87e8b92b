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
//! with RF − R·(g, 0) in the place of RF. Rows: x_n of all pairs that open, then x⁺ of all that have a tangential
//! joint, then their x⁻. A pair without a tangential joint has only x_n, a bilateral one only x^±.
//! The sums are formed in the number type asked for: exact from the f64 data in rationals.

use crate::lcp::exact::scalar::Scalar;
use crate::lcp::problem::{Lcp, Scale};
use crate::model::rules::Covering;

use crate::contact::lcp::{RowId, RowKind};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::{ContactPair, ContactSystem};

/// What [`full_lcp`] needs.
#[derive(Clone, Copy, Debug)]
pub struct WholeInput<'a> {
    /// Pairs and R.
    pub system: &'a ContactSystem,
    /// Numbers of the laws and the load.
    pub numbers: &'a ContactNumbers,
    /// Covering vector.
    pub covering: Covering,
}

/// The rows of the LCP in order.
pub fn rows(system: &ContactSystem) -> Vec<RowId> {
    let of = |couple: RowKind, has: fn(&ContactPair) -> bool| {
        let pairs = system.pairs.iter().enumerate().filter(move |(_, pair)| has(pair));
        pairs.map(move |(pair, _)| RowId { pair, couple })
    };
    let opens: fn(&ContactPair) -> bool = |pair| !pair.law.is_bilateral();
    let slips: fn(&ContactPair) -> bool = |pair| pair.tangential.is_some();
    of(RowKind::Normal, opens).chain(of(RowKind::Plus, slips)).chain(of(RowKind::Minus, slips)).collect()
}

/// Row of R of the tangential joint of a pair that has one.
///
/// # Panics
/// If the pair has none: only pairs with a bound have rows of reserves.
pub(crate) fn tangential_joint(system: &ContactSystem, pair: usize) -> usize {
    system.pairs[pair].tangential.expect("a pair with a friction bound has a tangential joint")
}

/// The quantities of a row as a combination of joints: Σ factor·λ_joint + fixed.
fn combination<T: Scalar>(input: &WholeInput, row: RowId) -> (Vec<(usize, T)>, T) {
    let WholeInput { system, numbers, .. } = *input;
    let pair = row.pair;
    let side = match row.couple {
        RowKind::Normal => return (vec![(pair, T::one())], T::zero()),
        RowKind::Plus => T::one(),
        RowKind::Minus => T::one().neg(),
    };
    let mut terms = vec![(tangential_joint(system, pair), side)];
    let f = T::from_f64(numbers.laws[pair].friction());
    if !f.is_zero() {
        terms.push((pair, f));
    }
    (terms, T::from_f64(numbers.laws[pair].fixed_bound()))
}

/// R in another number type, exactly where that type can.
fn stiffness_in<T: Scalar>(system: &ContactSystem) -> Vec<Vec<T>> {
    let k = system.joint_count();
    (0..k).map(|i| (0..k).map(|j| T::from_f64(system.stiffness[(i, j)])).collect()).collect()
}

/// RF − R·(g, 0): the joint forces of the main system with all gaps closed by force.
pub fn joint_constants<T: Scalar>(system: &ContactSystem, numbers: &ContactNumbers) -> Vec<T> {
    let closed = |i: usize, k: usize| T::from_f64(system.stiffness[(i, k)]);
    constants_with(system, numbers, &closed)
}

/// [`joint_constants`] with the entries of R from `stiffness`.
fn constants_with<T: Scalar>(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    stiffness: &dyn Fn(usize, usize) -> T,
) -> Vec<T> {
    let gaps: Vec<(usize, T)> =
        numbers.gaps().enumerate().filter(|(_, gap)| *gap != 0.0).map(|(k, gap)| (k, T::from_f64(gap))).collect();
    (0..system.joint_count())
        .map(|i| {
            let load = T::from_f64(numbers.load[i]);
            gaps.iter().fold(load, |sum, (k, gap)| match system.is_forced(*k) {
                false => sum.sub(&stiffness(i, *k).mul(gap)),
                true if *k == i => sum.add(gap),
                true => sum,
            })
        })
        .collect()
}

/// Forms the LCP, see the [module documentation](self).
pub fn full_lcp<T: Scalar>(input: &WholeInput) -> Lcp<T> {
    full_lcp_of(input, &stiffness_in(input.system))
}

/// Forms the LCP with an R of its own, one row per joint, in place of that of the system.
pub fn full_lcp_of<T: Scalar>(input: &WholeInput, stiffness: &[Vec<T>]) -> Lcp<T> {
    let WholeInput { system, numbers, .. } = *input;
    let rows = rows(system);
    let combinations: Vec<(Vec<(usize, T)>, T)> = rows.iter().map(|row| combination(input, *row)).collect();
    let joint = |row: &RowId| match row.couple {
        RowKind::Normal => row.pair,
        RowKind::Plus | RowKind::Minus => tangential_joint(system, row.pair),
    };
    let constants = constants_with(system, numbers, &|i, j| stiffness[i][j].clone());

    let matrix = combinations
        .iter()
        .map(|(terms, _)| {
            let responses: Vec<T> = (0..system.joint_count())
                .map(|j| terms.iter().fold(T::zero(), |sum, (i, factor)| sum.add(&factor.mul(&stiffness[*i][j]))))
                .collect();
            rows.iter()
                .map(|column| match column.couple {
                    RowKind::Normal | RowKind::Plus => responses[joint(column)].clone(),
                    RowKind::Minus => responses[joint(column)].neg(),
                })
                .collect()
        })
        .collect();
    let q = combinations
        .iter()
        .map(|(terms, fixed)| terms.iter().fold(fixed.clone(), |sum, (i, factor)| sum.add(&factor.mul(&constants[*i]))))
        .collect();
    let cover = rows.iter().map(|row| covering_entry::<T>(input, *row)).collect();
    let root = |i: usize| system.stiffness[(i, i)].max(0.0).sqrt();
    let load = combinations.iter().flat_map(|(terms, _)| terms);
    let load = load.map(|(i, factor)| (factor.to_f64() * constants[*i].to_f64()).abs()).fold(0.0, f64::max);
    let scale = Scale {
        load: Some(load),
        row: rows
            .iter()
            .map(|row| match row.couple {
                RowKind::Normal => root(row.pair),
                RowKind::Plus | RowKind::Minus => numbers.laws[row.pair].friction() * root(row.pair) + root(joint(row)),
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
    Lcp { matrix, q, covering: cover, scale }
}

/// d_n or d_τ of a row (method §4).
fn covering_entry<T: Scalar>(input: &WholeInput, row: RowId) -> T {
    let law = &input.numbers.laws[row.pair];
    match input.covering {
        _ if row.couple == RowKind::Normal || law.is_bilateral() => T::one(),
        Covering::Cohesive => T::one().add(&T::from_f64(law.friction())),
        Covering::Ones => T::one(),
        Covering::Weight => T::from_f64(law.friction()),
    }
}

#[cfg(test)]
#[path = "full_lcp_tests.rs"]
pub(crate) mod tests;
