//! What each row of the LCP of a contact problem is: which pair, which of its complementary couples.

use super::polygon::Polygon;
use super::system::{ContactPair, ContactSystem};

/// What a row of the full LCP stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// (x_n, z_n).
    Normal,
    /// (x^k, ζ_k) of facet k of the friction polygon. In the plane facet 0 is (x⁺, z⁺), facet 1 (x⁻, z⁻).
    Facet(u16),
}

impl RowKind {
    /// (x⁺, z⁺) of a pair in the plane: the facet of +t.
    pub const PLUS: RowKind = RowKind::Facet(0);
    /// (x⁻, z⁻): the facet of −t.
    pub const MINUS: RowKind = RowKind::Facet(1);

    /// The facet of a reserve; `None` for the normal couple.
    pub fn facet(self) -> Option<usize> {
        match self {
            RowKind::Normal => None,
            RowKind::Facet(facet) => Some(usize::from(facet)),
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
    /// Name of the force (`letter` x) or displacement (z) of this row: `x_n[c1]`, `z+[c1]`, in space `z^3[c1]`.
    pub fn name(self, letter: char, system: &ContactSystem) -> String {
        let pair = &system.pairs[self.pair];
        let index = match self.couple {
            RowKind::Normal => "_n".to_owned(),
            RowKind::Facet(facet) if pair.is_in_space() => format!("^{facet}"),
            RowKind::PLUS => "+".to_owned(),
            RowKind::Facet(_) => "-".to_owned(),
        };
        format!("{letter}{index}[{}]", pair.id)
    }

    /// The joints to whose displacements that of this row contributes, with its components along them: the normal
    /// joint, or those of d_k along the tangential ones. The force of the row feels the same joints by the same
    /// factors.
    pub fn joints(self, system: &ContactSystem, polygon: Polygon) -> impl Iterator<Item = (usize, f64)> + use<> {
        let (joints, components) = match self.couple.facet() {
            None => (self.pair..self.pair + 1, [1.0, 0.0]),
            Some(facet) => (system.pairs[self.pair].tangential.clone(), polygon.direction(facet)),
        };
        joints.zip(components)
    }
}

/// The rows of the full LCP: x_n of all pairs that open, then facet by facet the reserves of all that have tangential
/// joints. Those of the second half of the facets are mirrors of the first half.
pub fn rows(system: &ContactSystem, polygon: Polygon) -> Vec<RowId> {
    let of = |couple: RowKind, has: fn(&ContactPair) -> bool| {
        let pairs = system.pairs.iter().enumerate().filter(move |(_, pair)| has(pair));
        pairs.map(move |(pair, _)| RowId { pair, couple })
    };
    let facets = (0..polygon.facets()).flat_map(|facet| of(RowKind::Facet(facet as u16), ContactPair::rubs));
    of(RowKind::Normal, |pair| !pair.law.is_bilateral()).chain(facets).collect()
}

/// For each pair the row of one of its couples.
pub fn rows_of(rows: &[RowId], pairs: usize, couple: RowKind) -> Vec<Option<usize>> {
    let mut of = vec![None; pairs];
    rows.iter().enumerate().filter(|(_, id)| id.couple == couple).for_each(|(row, id)| of[id.pair] = Some(row));
    of
}

/// The same of every facet of the polygon.
pub fn facet_rows(rows: &[RowId], pairs: usize, polygon: Polygon) -> Vec<Vec<Option<usize>>> {
    (0..polygon.facets()).map(|facet| rows_of(rows, pairs, RowKind::Facet(facet as u16))).collect()
}
