//! What each row of the LCP of a contact problem is: which pair, which of its complementary couples.

use super::law::FACETS;
use super::system::{ContactPair, ContactSystem};

/// What a row of the full LCP stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// (x_n, z_n).
    Normal,
    /// (x⁺, z⁺): the facet of +t.
    Plus,
    /// (x⁻, z⁻): the facet of −t.
    Minus,
}

impl RowKind {
    /// d_k of the facet of a reserve (see [`FACETS`]); `None` for the normal couple.
    pub fn direction(self) -> Option<f64> {
        match self {
            RowKind::Normal => None,
            RowKind::Plus => Some(FACETS[0]),
            RowKind::Minus => Some(FACETS[1]),
        }
    }
}

/// What a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A contact force or a reserve.
    Force,
    /// A mutual displacement.
    Displacement,
}

/// A row of the full LCP: which pair, which couple.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RowId {
    /// Index of the pair.
    pub pair: usize,
    /// Which couple of it.
    pub couple: RowKind,
}

impl RowId {
    /// Name of the force (`letter` x) or displacement (z) of this row: `x_n[c1]`, `z+[c1]`.
    pub fn name(self, letter: char, system: &ContactSystem) -> String {
        let index = match self.couple {
            RowKind::Normal => "_n",
            RowKind::Plus => "+",
            RowKind::Minus => "-",
        };
        format!("{letter}{index}[{}]", system.pairs[self.pair].id)
    }

    /// The joint whose displacement this row's is, or a part of it.
    pub fn joint(self, system: &ContactSystem) -> usize {
        match self.couple {
            RowKind::Normal => self.pair,
            RowKind::Plus | RowKind::Minus => tangential_joint(system, self.pair),
        }
    }
}

/// The rows of the full LCP: x_n of all pairs that open, then x⁺ of all that have a tangential joint, then their x⁻.
pub fn rows(system: &ContactSystem) -> Vec<RowId> {
    let of = |couple: RowKind, has: fn(&ContactPair) -> bool| {
        let pairs = system.pairs.iter().enumerate().filter(move |(_, pair)| has(pair));
        pairs.map(move |(pair, _)| RowId { pair, couple })
    };
    let opens: fn(&ContactPair) -> bool = |pair| !pair.law.is_bilateral();
    let slips: fn(&ContactPair) -> bool = |pair| pair.tangential.is_some();
    of(RowKind::Normal, opens).chain(of(RowKind::Plus, slips)).chain(of(RowKind::Minus, slips)).collect()
}

/// For each pair the row of one of its couples.
pub fn rows_of(rows: &[RowId], pairs: usize, couple: RowKind) -> Vec<Option<usize>> {
    let mut of = vec![None; pairs];
    rows.iter().enumerate().filter(|(_, id)| id.couple == couple).for_each(|(row, id)| of[id.pair] = Some(row));
    of
}

/// Row of R of the tangential joint of a pair that has one.
///
/// # Panics
/// If the pair has none: only pairs with a bound have rows of reserves.
pub(crate) fn tangential_joint(system: &ContactSystem, pair: usize) -> usize {
    system.pairs[pair].tangential.expect("a pair with a friction bound has a tangential joint")
}
