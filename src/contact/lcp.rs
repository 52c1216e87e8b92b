//! Contact problem → LCP, eqs. (1), (2), (8) of method §3, laws mixed, dimensionless inside.
//!
//! Rows of the full LCP: all x_n, then all x⁺, then all x⁻, each in the order of the pairs. Only x_n and x⁺ are stored; x⁻
//! is the mirror of x⁺ (see `lcp::mirrored`), so the 3m rows of M are never formed.
//!
//! Forces are divided by `force_unit`, displacements by `length_unit`, both exact powers of two (up to the ratio
//! given by R), so that results scale back without rounding.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::contact::force_form;
use crate::contact::law::PairLaw;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{RowId, RowKind, rows, rows_of};
use crate::contact::sums::joint_forces;
use crate::contact::system::ContactSystem;
use crate::contact::written::{ContactLcp, CoveringError, power_of_two};
use crate::lcp::mirrored::{Mirror, MirroredLcp};
use crate::lcp::problem::{NOISE, Scale};
use crate::model::rules::Covering;

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
    let written = LoadAndUnits::of(earlier, problem, stored);
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
struct LoadAndUnits {
    /// RF − R·(g, 0) of the joints, what cancels to rounding left out.
    load: Vec<f64>,
    /// Largest |q| of all rows, and of their loads alone; forces.
    largest: f64,
    largest_load: f64,
    force_unit: f64,
    stiffness_unit: f64,
}

impl LoadAndUnits {
    fn of(earlier: Option<&ContactLcp>, problem: &ContactProblem, stored: &[RowId]) -> LoadAndUnits {
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
        LoadAndUnits { load, largest, largest_load, force_unit: power_of_two(largest), stiffness_unit }
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
}
