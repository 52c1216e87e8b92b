//! Contact problem → LCP, eqs. (1), (2), (8) of method §3, laws mixed, dimensionless inside.
//!
//! Rows of the full LCP: all x_n, then all x⁺, then all x⁻, each in the order of the pairs; in space facet by facet of
//! the polygon. Only x_n and the first half of the facets are stored, in the plane x⁺; the others are their mirrors
//! (see `lcp::mirrored`), so the 3m rows of M, in space (1 + K) m, are never formed.
//!
//! Forces are divided by `force_unit`, displacements by `length_unit`, both exact powers of two (up to the ratio
//! given by R), so that results scale back without rounding.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::contact::force_form;
use crate::contact::law::PairLaw;
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{RowId, RowKind, facet_rows, rows, rows_of};
use crate::contact::sums::joint_forces;
use crate::contact::system::ContactSystem;
use crate::contact::written::{ContactLcp, CoveringError, power_of_two};
use crate::lcp::mirrored::{Mirror, MirroredLcp};
use crate::lcp::problem::{NOISE, Scale};
use crate::model::rules::Covering;

/// √R_ii of every joint, R in the given unit. A joint without stiffness responds to nothing: any size but zero will do
/// for it.
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
    let polygon = problem.polygon;
    let rows = earlier.map_or_else(|| rows(system, polygon), |earlier| earlier.rows.clone());
    let normal_row = rows_of(&rows, system.pair_count(), RowKind::Normal);
    let facet_rows = facet_rows(&rows, system.pair_count(), polygon);
    // The mirrors are not stored: their rows are the last ones.
    let mirrored = facet_rows[polygon.half()..].iter().flatten().flatten().count();
    let stored = &rows[..rows.len() - mirrored];
    let written = LoadAndUnits::of(earlier, problem, stored);
    let scales: Vec<f64> = match earlier {
        Some(earlier) => earlier.lcp.scale.column.clone(),
        None => {
            let joint_scale = joint_scales(system, written.stiffness_unit);
            let own = |row: &RowId| row.joints(system, polygon).map(|(joint, d)| d.abs() * joint_scale[joint]).sum();
            stored.iter().map(own).collect()
        }
    };
    let base = match earlier {
        Some(earlier) => Arc::clone(&earlier.lcp.base),
        None => Arc::new(base_of(problem, stored, written.stiffness_unit)),
    };
    let mut lcp = MirroredLcp {
        base,
        q: DVector::zeros(stored.len()),
        covering: DVector::from_element(stored.len(), 1.0),
        whole: (0..stored.len()).collect(),
        mirrors: vec![None; stored.len()],
        scale: Scale { row: scales.clone(), column: scales.clone(), load: Some(written.load_size()) },
        full_size: rows.len(),
    };
    for (row, id) in stored.iter().enumerate() {
        let (i, law) = (id.pair, &problem.laws[id.pair]);
        let Some(facet) = id.couple.facet() else {
            lcp.q[row] = written.load[i] / written.force_unit;
            continue;
        };
        let along = written.along(problem, *id);
        lcp.q[row] = written.reserve(law, i, &along);
        lcp.covering[row] = law.covering(covering);
        if lcp.covering[row] == 0.0 && written.least_reserve(law, i, &along) < 0.0 {
            return Err(CoveringError::WeightWithoutFriction { pair: system.pairs[i].id.clone() });
        }
        // A pair without a normal row holds both ways: its bound does not depend on x_n.
        lcp.scale.row[row] += law.friction() * normal_row[i].map_or(0.0, |normal| scales[normal]);
        lcp.mirrors[row] = facet_rows[facet + polygon.half()][i].map(|minus| Mirror {
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
        polygon,
        swapped: vec![false; rows.len()],
        force_unit: written.force_unit,
        length_unit: written.length_unit(),
        rows,
        normal_row,
        facet_rows,
    })
}

/// D R Dᵀ over the stored rows, dimensionless: D has the directions of the rows over the joints.
fn base_of(problem: &ContactProblem, stored: &[RowId], unit: f64) -> DMatrix<f64> {
    let system = &*problem.system;
    let stiffness = system.pivot_stiffness();
    let joints: Vec<Vec<(usize, f64)>> =
        stored.iter().map(|row| row.joints(system, problem.polygon).filter(|(_, d)| *d != 0.0).collect()).collect();
    // In the plane, where every pair has both joints, D is 1.
    if joints.len() == stiffness.nrows() && joints.iter().enumerate().all(|(row, own)| own[..] == [(row, 1.0)]) {
        return stiffness / unit;
    }
    let mut entries = Vec::with_capacity(stored.len() * stored.len());
    for column in &joints {
        if let [(joint, 1.0)] = column[..] {
            let response = stiffness.column(joint);
            entries.extend(joints.iter().map(|row| combined(row, |joint| response[joint] / unit)));
        } else {
            let mut response = DVector::zeros(stiffness.nrows());
            column.iter().for_each(|&(joint, d)| response.axpy(d, &stiffness.column(joint), 1.0));
            entries.extend(joints.iter().map(|row| combined(row, |joint| response[joint] / unit)));
        }
    }
    let mut base = DMatrix::from_vec(stored.len(), stored.len(), entries);
    if problem.polygon != Polygon::PLANE {
        // The sums of both triangles round differently.
        base.fill_upper_triangle_with_lower_triangle();
    }
    base
}

/// Σ d value(joint).
fn combined(joints: &[(usize, f64)], value: impl Fn(usize) -> f64) -> f64 {
    match joints {
        [(joint, 1.0)] => value(*joint),
        _ => joints.iter().map(|&(joint, d)| d * value(joint)).sum(),
    }
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
            let own: f64 = row.joints(system, problem.polygon).map(|(joint, d)| d * load[joint]).sum();
            let (normal, law) = (load[row.pair], &problem.laws[row.pair]);
            if row.couple == RowKind::Normal {
                largest = largest.max(normal.abs());
                largest_load = largest_load.max(normal.abs());
            } else {
                let bound = law.bound(normal);
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

    /// The terms of the force along the direction of a row, forces.
    fn along(&self, problem: &ContactProblem, row: RowId) -> Vec<f64> {
        row.joints(&problem.system, problem.polygon).map(|(joint, d)| d * self.load[joint]).collect()
    }

    /// q of a reserve, dimensionless; 0 where it is rounding. `along` has the terms of the force along its facet.
    fn reserve(&self, law: &PairLaw, pair: usize, along: &[f64]) -> f64 {
        let force = along.iter().map(|term| term / self.force_unit);
        let bound = [law.friction() * (self.load[pair] / self.force_unit), law.fixed_bound() / self.force_unit];
        let terms: Vec<f64> = force.chain(bound).collect();
        let sum: f64 = terms.iter().sum();
        let noise = NOISE * terms.iter().map(|term| term.abs()).sum::<f64>();
        if sum.abs() <= noise { 0.0 } else { sum }
    }

    /// The smaller of a reserve and its mirror in the main system, a force.
    fn least_reserve(&self, law: &PairLaw, pair: usize, along: &[f64]) -> f64 {
        law.bound(self.load[pair]) - along.iter().sum::<f64>().abs()
    }
}

impl ContactLcp {
    /// z over the joints (z_n, z_τ = Σ ζ_k d_k, in the plane z⁺ − z⁻) of a point or direction, dimensionless. With
    /// joints in force form only of a direction.
    pub fn joint_displacements(&self, system: &ContactSystem, z: &[f64]) -> DVector<f64> {
        if system.force_form.is_some() {
            return force_form::motion(system, self, z) / self.length_unit;
        }
        let mut joints = DVector::zeros(system.joint_count());
        for (row, meaning) in self.rows.iter().enumerate() {
            meaning.joints(system, self.polygon).for_each(|(joint, d)| joints[joint] += d * z[row]);
        }
        joints
    }
}
