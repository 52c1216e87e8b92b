//! An LCP as it was written for a contact problem: what its rows are, its units and the way back to those of the user.

use std::sync::Arc;

use super::polygon::Polygon;
use super::rows::{Quantity, RowId, RowKind};
use super::system::ContactSystem;
use nalgebra::DVector;

use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;
use crate::model::rules::TieBreak;

/// A covering that cannot be used with these numbers.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoveringError {
    /// `weight` has d_τ = f, which is zero where a force must be covered.
    #[error(
        "covering `weight` needs friction above 0 in pair {pair}: its tangential force in the main system exceeds \
         its cohesion, and with f = 0 no tightening weight can hold it; use covering cohesive or ones"
    )]
    WeightWithoutFriction {
        /// Id of the pair.
        pair: String,
    },
}

/// The LCP of a contact problem with the way back to pairs and units.
#[derive(Clone, Debug)]
pub struct ContactLcp {
    /// The dimensionless LCP.
    pub lcp: Arc<MirroredLcp>,
    /// f of each pair: what the matrix depends on, apart from R.
    pub friction: Vec<f64>,
    /// What each row of the full LCP stands for.
    pub rows: Vec<RowId>,
    /// User's force = dimensionless × this.
    pub force_unit: f64,
    /// User's length = dimensionless × this.
    pub length_unit: f64,
    /// Row of the full LCP of each pair's couples.
    pub normal_row: Vec<Option<usize>>,
    /// Likewise facet by facet; in the plane x⁺, then x⁻.
    pub facet_rows: Vec<Vec<Option<usize>>>,
    /// The facets.
    pub polygon: Polygon,
    /// For each row of the full LCP, whether its w is the displacement and its z the force ([`super::force_form`]).
    pub swapped: Vec<bool>,
}

/// Largest power of two not above `value`; 1 for zero.
pub fn power_of_two(value: f64) -> f64 {
    if value > 0.0 && value.is_finite() { 2f64.powi(value.log2().floor() as i32) } else { 1.0 }
}

impl ContactLcp {
    /// The tie rule over the rows of this LCP.
    pub fn tie_rule(&self, tie_break: TieBreak) -> TieRule {
        match tie_break {
            TieBreak::Lexicographic => TieRule::Lexicographic(self.lexicographic_order()),
            TieBreak::Natural => TieRule::Lexicographic((0..self.rows.len()).collect()),
            TieBreak::FirstRow => TieRule::FirstRow,
            TieBreak::Random(seed) => TieRule::Random(seed),
        }
    }

    /// The order of the rows of the lexicographic rule: reserves before contact forces.
    pub fn lexicographic_order(&self) -> Vec<usize> {
        let normals = self.rows.iter().filter(|row| row.couple == RowKind::Normal).count();
        (normals..self.rows.len()).chain(0..normals).collect()
    }

    /// Contact forces, and reserves f λ_n + λ_τ + c, over the primary rows and the unit of force; `forces` are λ over
    /// the joints, `friction` and `fixed` f and c of every pair.
    pub fn force_rows(
        &self,
        system: &ContactSystem,
        forces: &DVector<f64>,
        friction: &[f64],
        fixed: &[f64],
    ) -> DVector<f64> {
        let unit = self.force_unit;
        let mut rows = DVector::zeros(self.lcp.size());
        for (i, pair) in system.pairs.iter().enumerate() {
            if let Some(row) = self.normal_row[i] {
                rows[row] = forces[i] / unit;
            }
            for facet in 0..self.polygon.half() {
                let Some(row) = self.facet_rows[facet][i] else { continue };
                let along = pair.tangential.clone().zip(self.polygon.direction(facet));
                let force = along.map(|(joint, d)| d * (forces[joint] / unit)).sum::<f64>();
                rows[row] = force + friction[i] * (forces[i] / unit) + fixed[i] / unit;
            }
        }
        rows
    }

    /// Name of a variable: `p`, `x_n[c1]`, `x+[c1]`, `z-[c1]`.
    pub fn name(&self, variable: Variable, system: &ContactSystem) -> String {
        match self.quantity(variable) {
            None => "p".to_owned(),
            Some((row, Quantity::Force)) => self.rows[row].name('x', system),
            Some((row, Quantity::Displacement)) => self.rows[row].name('z', system),
        }
    }

    /// Row of a variable and what it is; `None` for p.
    pub fn quantity(&self, variable: Variable) -> Option<(usize, Quantity)> {
        let (row, is_force) = match variable {
            Variable::P => return None,
            Variable::W(row) => (row, !self.swapped[row]),
            Variable::Z(row) => (row, self.swapped[row]),
        };
        Some((row, if is_force { Quantity::Force } else { Quantity::Displacement }))
    }

    /// User's value = dimensionless × this.
    pub fn unit(&self, variable: Variable) -> f64 {
        match self.quantity(variable) {
            Some((_, Quantity::Displacement)) => self.length_unit,
            _ => self.force_unit,
        }
    }

    /// (d_n, d_τ) of a pair; 0 where it has no such row.
    pub fn covering_of(&self, pair: usize) -> (f64, f64) {
        let covers = |row: &usize| !self.swapped[*row];
        let read = |row: Option<usize>| row.filter(covers).map_or(0.0, |row| self.lcp.covering[row]);
        (read(self.normal_row[pair]), read(self.facet_rows[0][pair]))
    }

    /// What p (user's units) adds to z_n of a pair whose normal joint is in force form; 0 for all others.
    pub fn covered_distance(&self, pair: usize, p: f64) -> f64 {
        let row = self.normal_row[pair].filter(|&row| self.swapped[row]);
        row.map_or(0.0, |row| self.lcp.covering[row] * (p / self.force_unit) * self.length_unit)
    }

    /// A point in the user's units.
    pub fn in_units(&self, point: &Point) -> Point {
        let scaled = |values: &[f64], variable: fn(usize) -> Variable| {
            values.iter().enumerate().map(|(row, value)| value * self.unit(variable(row))).collect()
        };
        Point { z: scaled(&point.z, Variable::Z), w: scaled(&point.w, Variable::W), p: point.p * self.force_unit }
    }
}
