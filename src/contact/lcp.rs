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
use crate::contact::law::PairLaw;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{Quantity, RowId, RowKind, rows, rows_of};
use crate::contact::sums::joint_forces;
use crate::contact::system::ContactSystem;
use crate::lcp::mirrored::{Mirror, MirroredLcp};
use crate::lcp::outcome::Point;
use crate::lcp::problem::{NOISE, Scale};
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;
use crate::model::rules::{Covering, TieBreak};

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

/// √R_ii of every joint, R in the given unit. A joint without stiffness responds to nothing: any size will do for it,
/// but not zero.
fn joint_scales(system: &ContactSystem, stiffness_unit: f64) -> Vec<f64> {
    let diagonal = system.stiffness.diagonal();
    let scales = diagonal.map(|entry| (entry / stiffness_unit).max(0.0).sqrt());
    let floor = scales.amax().max(f64::MIN_POSITIVE) * 1e-9;
    scales.iter().map(|scale| scale.max(floor)).collect()
}

/// Writes the LCP of a problem.
///
/// # Errors
/// Where the covering cannot cover q.
pub fn contact_lcp(problem: &ContactProblem, covering: Covering) -> Result<ContactLcp, CoveringError> {
    contact_lcp_like(None, problem, covering)
}

/// As [`contact_lcp`], sharing the stiffness of an earlier LCP of the same system.
///
/// # Errors
/// Where the covering cannot cover q.
pub fn contact_lcp_like(
    earlier: Option<&ContactLcp>,
    problem: &ContactProblem,
    covering: Covering,
) -> Result<ContactLcp, CoveringError> {
    let system = &*problem.system;
    if system.force_form.is_some() {
        return force_form::contact_lcp(problem, covering);
    }
    let rows = earlier.map_or_else(|| rows(system), |earlier| earlier.rows.clone());
    let [normal_row, plus_row, minus_row] =
        [RowKind::Normal, RowKind::Plus, RowKind::Minus].map(|couple| rows_of(&rows, system.pair_count(), couple));
    // x⁻ is not stored: its rows are the last ones.
    let stored = &rows[..rows.len() - minus_row.iter().flatten().count()];
    let joints: Vec<usize> = stored.iter().map(|row| row.joint(system)).collect();
    let written = Written::of(earlier, problem, stored);
    let joint_scale = match earlier {
        Some(earlier) => {
            let mut scale = vec![0.0; system.joint_count()];
            joints.iter().zip(&earlier.lcp.scale.column).for_each(|(&joint, own)| scale[joint] = *own);
            scale
        }
        None => joint_scales(system, written.stiffness_unit),
    };
    let base = match earlier {
        Some(earlier) => Arc::clone(&earlier.lcp.base),
        None => Arc::new(stiffness_of(system, &joints, written.stiffness_unit)),
    };
    let mut lcp = MirroredLcp {
        base,
        q: DVector::zeros(stored.len()),
        covering: DVector::from_element(stored.len(), 1.0),
        whole: (0..stored.len()).collect(),
        mirrors: vec![None; stored.len()],
        scale: Scale {
            row: joints.iter().map(|&joint| joint_scale[joint]).collect(),
            column: joints.iter().map(|&joint| joint_scale[joint]).collect(),
            load: Some(written.load_size()),
        },
        full_size: rows.len(),
    };
    for (row, id) in stored.iter().enumerate() {
        let (i, law) = (id.pair, &problem.laws[id.pair]);
        if id.couple == RowKind::Normal {
            lcp.q[row] = written.load[i] / written.force_unit;
            continue;
        }
        lcp.q[row] = written.reserve(law, i, joints[row]);
        lcp.covering[row] = law.covering(covering);
        if lcp.covering[row] == 0.0 && written.least_reserve(law, i, joints[row]) < 0.0 {
            return Err(CoveringError::WeightWithoutFriction { pair: system.pairs[i].id.clone() });
        }
        lcp.scale.row[row] += law.friction() * joint_scale[i];
        lcp.mirrors[row] = minus_row[i].map(|minus| Mirror {
            whole: minus,
            normal: normal_row[i],
            friction: law.friction(),
            constant: 2.0 * (law.fixed_bound() / written.force_unit),
            covering: law.covering_of_both(covering),
        });
    }
    Ok(ContactLcp {
        lcp: Arc::new(lcp),
        friction: problem.frictions(),
        swapped: vec![false; rows.len()],
        force_unit: written.force_unit,
        length_unit: written.length_unit(),
        rows,
        normal_row,
        plus_row,
        minus_row,
    })
}

/// R over some joints, dimensionless.
fn stiffness_of(system: &ContactSystem, joints: &[usize], unit: f64) -> DMatrix<f64> {
    let stiffness = system.pivot_stiffness();
    let mut entries = Vec::with_capacity(joints.len() * joints.len());
    for &joint in joints {
        let column = stiffness.column(joint);
        entries.extend(joints.iter().map(|&row| column[row] / unit));
    }
    DMatrix::from_vec(joints.len(), joints.len(), entries)
}

/// The constants of an LCP and its units.
struct Written {
    /// RF − R·(g, 0) of the joints, what cancels to rounding left out.
    load: Vec<f64>,
    /// Largest |q| of all rows, and of their loads alone; forces.
    largest: f64,
    largest_load: f64,
    force_unit: f64,
    stiffness_unit: f64,
}

impl Written {
    fn of(earlier: Option<&ContactLcp>, problem: &ContactProblem, stored: &[RowId]) -> Written {
        let system = &*problem.system;
        let constants = joint_forces(problem, &DVector::zeros(system.joint_count()));
        let load: Vec<f64> = constants.iter().map(|sum| sum.cleaned()).collect();
        let (mut largest, mut largest_load) = (0f64, 0f64);
        for row in stored {
            let (normal, own, law) = (load[row.pair], load[row.joint(system)], &problem.laws[row.pair]);
            if row.couple == RowKind::Normal {
                largest = largest.max(normal.abs());
                largest_load = largest_load.max(normal.abs());
            } else {
                let bound = law.friction() * normal + law.fixed_bound();
                largest = largest.max((bound + own).abs()).max((bound - own).abs());
                largest_load = largest_load.max((law.friction() * normal).abs()).max(own.abs());
            }
        }
        let stiffness_unit = earlier.map_or_else(
            || power_of_two(system.stiffness.diagonal().amax()),
            |earlier| earlier.force_unit / earlier.length_unit,
        );
        Written { load, largest, largest_load, force_unit: power_of_two(largest), stiffness_unit }
    }

    fn length_unit(&self) -> f64 {
        self.force_unit / self.stiffness_unit
    }

    /// Size of the load, dimensionless.
    fn load_size(&self) -> f64 {
        (if self.largest_load > 0.0 { self.largest_load } else { self.largest }) / self.force_unit
    }

    /// q of x⁺, dimensionless; 0 where it is rounding.
    fn reserve(&self, law: &PairLaw, pair: usize, joint: usize) -> f64 {
        let terms = [
            self.load[joint] / self.force_unit,
            law.friction() * (self.load[pair] / self.force_unit),
            law.fixed_bound() / self.force_unit,
        ];
        let sum: f64 = terms.iter().sum();
        let noise = NOISE * terms.iter().map(|term| term.abs()).sum::<f64>();
        if sum.abs() <= noise { 0.0 } else { sum }
    }

    /// The smaller reserve in the main system, a force.
    fn least_reserve(&self, law: &PairLaw, pair: usize, joint: usize) -> f64 {
        law.friction() * self.load[pair] + law.fixed_bound() - self.load[joint].abs()
    }
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
