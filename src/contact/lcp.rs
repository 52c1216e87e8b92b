//! Contact system + numbers → LCP, eqs. (1), (2), (8) of method §3, laws mixed, dimensionless inside.
//!
//! Rows of the whole LCP: all x_n, then all x⁺, then all x⁻, each in the order of the pairs. Only x_n and x⁺ are stored; x⁻ is the mirror of x⁺ (see `lcp::mirrored`), so the 3m rows of M
//! are never formed.
//!
//! Forces are divided by `force_unit`, displacements by `length_unit`, both exact powers of two (up to the ratio
//! given by R), so that results scale back without rounding.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::contact::force_form;
use crate::contact::full_lcp::{joint_constants, rows};
use crate::contact::numbers::ContactNumbers;
use crate::contact::sums::joint_forces;
use crate::contact::system::ContactSystem;
use crate::lcp::mirrored::{Mirror, MirroredLcp};
use crate::lcp::outcome::Point;
use crate::lcp::problem::{NOISE, Scale};
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;
use crate::model::rules::{Covering, TieBreak};

/// What a row of the whole LCP stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// (x_n, z_n).
    Normal,
    /// (x⁺, z⁺).
    Plus,
    /// (x⁻, z⁻).
    Minus,
}

/// What a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A contact force or a reserve.
    Force,
    /// A mutual displacement.
    Displacement,
}

/// A row of the whole LCP: which pair, which couple.
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
}

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
    /// What each row of the whole LCP stands for.
    pub rows: Vec<RowId>,
    /// User's force = dimensionless × this.
    pub force_unit: f64,
    /// User's length = dimensionless × this.
    pub length_unit: f64,
    /// Row of the whole LCP of each pair's couples.
    pub normal_row: Vec<Option<usize>>,
    /// Likewise for x⁺.
    pub plus_row: Vec<Option<usize>>,
    /// Likewise for x⁻.
    pub minus_row: Vec<Option<usize>>,
    /// Of each row of the whole LCP: whether its w is the displacement and its z the force ([`force_form`]).
    pub swapped: Vec<bool>,
}

/// Largest power of two not above `value`; 1 for zero.
pub fn power_of_two(value: f64) -> f64 {
    if value > 0.0 && value.is_finite() { 2f64.powi(value.log2().floor() as i32) } else { 1.0 }
}

/// RF − R·(g, 0): the forces in the joints of the main system, gaps closed by force.
pub fn load_with_gaps(system: &ContactSystem, numbers: &ContactNumbers) -> DVector<f64> {
    DVector::from_vec(joint_constants(system, numbers))
}

/// √R_ii of every joint, R in the given unit. A joint without stiffness responds to nothing: any size will do for it,
/// but not zero.
fn joint_scales(system: &ContactSystem, stiffness_unit: f64) -> Vec<f64> {
    let diagonal = system.stiffness.diagonal();
    let scales = diagonal.map(|entry| (entry / stiffness_unit).max(0.0).sqrt());
    let floor = scales.amax().max(f64::MIN_POSITIVE) * 1e-9;
    scales.iter().map(|scale| scale.max(floor)).collect()
}

/// Writes the LCP of the system under the given numbers.
///
/// # Errors
/// Where the covering cannot cover q.
pub fn contact_lcp(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    covering: Covering,
) -> Result<ContactLcp, CoveringError> {
    contact_lcp_like(None, system, numbers, covering)
}

/// As [`contact_lcp`], sharing the stiffness of an earlier LCP of the same system.
///
/// # Errors
/// Where the covering cannot cover q.
pub fn contact_lcp_like(
    earlier: Option<&ContactLcp>,
    system: &ContactSystem,
    numbers: &ContactNumbers,
    covering: Covering,
) -> Result<ContactLcp, CoveringError> {
    if system.force_form.is_some() {
        return force_form::contact_lcp(system, numbers, covering);
    }
    let constants = joint_forces(system, numbers, &DVector::zeros(system.joint_count()));
    // What cancels to rounding is no load.
    let load: Vec<f64> = constants.iter().map(|sum| sum.cleaned()).collect();
    let pairs = &system.pairs;
    let normals: Vec<usize> = (0..pairs.len()).filter(|&i| !pairs[i].law.is_bilateral()).collect();
    let tangentials: Vec<(usize, usize)> =
        pairs.iter().enumerate().filter_map(|(i, pair)| pair.tangential.map(|joint| (i, joint))).collect();

    let stiffness_unit = earlier.map_or_else(
        || power_of_two(system.stiffness.diagonal().amax()),
        |earlier| earlier.force_unit / earlier.length_unit,
    );
    let laws = &numbers.laws;
    // Largest |q| of all rows, and of their loads alone.
    let mut largest = 0f64;
    let mut largest_load = 0f64;
    for &i in &normals {
        largest = largest.max(load[i].abs());
        largest_load = largest_load.max(load[i].abs());
    }
    for &(i, joint) in &tangentials {
        let bound = laws[i].friction() * load[i] + laws[i].fixed_bound();
        largest = largest.max((bound + load[joint]).abs()).max((bound - load[joint]).abs());
        largest_load = largest_load.max((laws[i].friction() * load[i]).abs()).max(load[joint].abs());
    }
    let force_unit = power_of_two(largest);
    let length_unit = force_unit / stiffness_unit;

    let count = normals.len() + tangentials.len();
    let joint_of = |row: usize| {
        if row < normals.len() { normals[row] } else { tangentials[row - normals.len()].1 }
    };
    let column_scale = match earlier {
        Some(earlier) => {
            let mut scale = vec![0.0; system.joint_count()];
            for (row, own) in earlier.lcp.scale.column.iter().enumerate() {
                scale[joint_of(row)] = *own;
            }
            scale
        }
        None => joint_scales(system, stiffness_unit),
    };
    let base = earlier.map_or_else(
        || {
            let joints: Vec<usize> = (0..count).map(joint_of).collect();
            let stiffness = system.pivot_stiffness();
            let mut entries = Vec::with_capacity(count * count);
            for &joint in &joints {
                let column = stiffness.column(joint);
                entries.extend(joints.iter().map(|&row| column[row] / stiffness_unit));
            }
            Arc::new(DMatrix::from_vec(count, count, entries))
        },
        |earlier| Arc::clone(&earlier.lcp.base),
    );
    let mut q = DVector::zeros(count);
    let mut d = DVector::zeros(count);
    let mut row_scale = vec![0.0; count];
    let mut mirrors: Vec<Option<Mirror>> = vec![None; count];
    let rows = earlier.map_or_else(|| rows(system), |earlier| earlier.rows.clone());
    let (mut normal_row, mut plus_row, mut minus_row) =
        (vec![None; pairs.len()], vec![None; pairs.len()], vec![None; pairs.len()]);
    for (row, &i) in normals.iter().enumerate() {
        q[row] = load[i] / force_unit;
        d[row] = 1.0;
        row_scale[row] = column_scale[i];
        normal_row[i] = Some(row);
    }
    for (k, &(i, joint)) in tangentials.iter().enumerate() {
        let row = normals.len() + k;
        let law = &laws[i];
        let f = law.friction();
        let constant = law.fixed_bound() / force_unit;
        let terms = [load[joint] / force_unit, f * (load[i] / force_unit), constant];
        let sum: f64 = terms.iter().sum();
        let noise = NOISE * terms.iter().map(|term| term.abs()).sum::<f64>();
        q[row] = if sum.abs() <= noise { 0.0 } else { sum };
        d[row] = law.covering(covering);
        let minus = f * load[i] + law.fixed_bound() - load[joint].abs();
        if d[row] == 0.0 && minus < 0.0 {
            return Err(CoveringError::WeightWithoutFriction { pair: pairs[i].id.clone() });
        }
        row_scale[row] = column_scale[joint] + f * column_scale[i];
        mirrors[row] = Some(Mirror {
            whole: count + k,
            normal: normal_row[i],
            friction: f,
            constant: 2.0 * constant,
            covering: law.covering_of_both(covering),
        });
        plus_row[i] = Some(row);
        minus_row[i] = Some(count + k);
    }
    let lcp = MirroredLcp {
        base,
        q,
        covering: d,
        whole: (0..count).collect(),
        mirrors,
        scale: Scale {
            row: row_scale,
            column: (0..count).map(|row| column_scale[joint_of(row)]).collect(),
            load: Some(if largest_load > 0.0 { largest_load } else { largest } / force_unit),
        },
        full_size: rows.len(),
    };
    Ok(ContactLcp {
        lcp: Arc::new(lcp),
        friction: numbers.frictions(),
        swapped: vec![false; rows.len()],
        rows,
        force_unit,
        length_unit,
        normal_row,
        plus_row,
        minus_row,
    })
}

impl ContactLcp {
    /// The tie rule over the rows of this LCP.
    pub fn tie_rule(&self, tie_break: TieBreak) -> TieRule {
        let normals = self.rows.iter().filter(|row| row.couple == RowKind::Normal).count();
        let n = self.rows.len();
        match tie_break {
            TieBreak::Lexicographic => TieRule::Lexicographic((normals..n).chain(0..normals).collect()),
            TieBreak::Natural => TieRule::Lexicographic((0..n).collect()),
            TieBreak::FirstRow => TieRule::FirstRow,
            TieBreak::Random(seed) => TieRule::Random(seed),
        }
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

    /// z over the joints (z_n, z_τ = z⁺ − z⁻) of a point or direction, dimensionless. With joints in force form: of a
    /// direction.
    pub fn joint_displacements(&self, system: &ContactSystem, z: &[f64]) -> DVector<f64> {
        if system.force_form.is_some() {
            return force_form::motion(system, self, z) / self.length_unit;
        }
        let mut joints = DVector::zeros(system.joint_count());
        for (row, meaning) in self.rows.iter().enumerate() {
            match (meaning.couple, system.pairs[meaning.pair].tangential) {
                (RowKind::Normal, _) => joints[meaning.pair] += z[row],
                (RowKind::Plus, Some(joint)) => joints[joint] += z[row],
                (RowKind::Minus, Some(joint)) => joints[joint] -= z[row],
                (_, None) => {}
            }
        }
        joints
    }

    /// (d_n, d_τ) of a pair; 0 where it has no such row.
    pub fn covering_of(&self, pair: usize) -> (f64, f64) {
        let covers = |row: &usize| !self.swapped[*row];
        let read = |row: Option<usize>| row.filter(covers).map_or(0.0, |row| self.lcp.covering[row]);
        (read(self.normal_row[pair]), read(self.plus_row[pair]))
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
