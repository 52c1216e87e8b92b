//! Contact problems in which joints repeat one another: some joints stand in *force form*.
//!
//! Where the joints of a structure depend on one another (two opposed pairs at one node, a T corner of a wall), or
//! where a given compliance W is singular, no R gives λ for every z: motions z are bound to one another, and forces are
//! free up to self-stress. An independent set I keeps its displacement as the unknown, the others, D, take their force:
//!
//! ```text
//!     [λ_I]   [R   −Aᵀ] [z_I − g_I]   [RF_I     ]          z_D = A z_I + h: what the joints have in common
//!     [z_D] = [A    0 ] [λ_D      ] + [h_D + g_D]
//! ```
//! This mixed matrix and its constants stand in place of R and RF in a [`ContactSystem`] that has a [`ForceForm`].
//! A singular compliance is the case with all joints in D and W in place of the matrix. (It is a principal pivot
//! transform of λ = R z + RF wherever R exists: Cottle, Pang, Stone, "The Linear Complementarity Problem", 2.3.)
//!
//! The couples of a pair in force form change sides. Normal: (z_n, x_n) instead of (x_n, z_n). Tangential: the unknowns
//! are x⁺ and z⁻, and
//!
//! ```text
//!     λ_τ = x⁺ − f x_n − c,     z⁺ = z_τ + z⁻ ≥ 0 ⟂ x⁺ ≥ 0,     x⁻ = 2 (f x_n + c) − x⁺ ≥ 0 ⟂ z⁻ ≥ 0
//! ```
//! D is chosen so that nothing here is implicit: where the tangential joint of a pair is in D, its normal joint is too, or no
//! λ_τ of D enters its λ_n.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::pivoted::orthonormal;
use super::polygon::Polygon;
use super::problem::ContactProblem;
use super::sum::Sum;
use super::sums::joint_forces;
use super::system::{ContactSystem, ForceForm, JointLoad};
use crate::contact::rows::rows;
use crate::contact::rows::{RowId, RowKind};
use crate::contact::written::{ContactLcp, CoveringError, power_of_two};
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::problem::{Lcp, Scale};
use crate::model::rules::Covering;

/// A joint that repeats others: index and its z as a combination of theirs.
pub struct Repeats<'a> {
    /// The joint.
    pub joint: usize,
    /// (joint, factor).
    pub terms: &'a [(usize, f64)],
}

/// Which joints of a structure are independent and which repeat them.
pub struct Dependence<'a> {
    /// Index of each independent joint.
    pub independent: &'a [usize],
    /// The others.
    pub repeated: Vec<Repeats<'a>>,
    /// h of the others per load case and unit factor.
    pub offsets: Vec<Vec<f64>>,
}

impl Dependence<'_> {
    /// A vector over all joints from its entries for the independent and for the repeated ones.
    fn spread(&self, vector: &DVector<f64>, offsets: &[f64]) -> DVector<f64> {
        let mut all = DVector::zeros(self.independent.len() + self.repeated.len());
        self.independent.iter().zip(vector.iter()).for_each(|(&joint, value)| all[joint] = *value);
        self.repeated.iter().zip(offsets).for_each(|(one, offset)| all[one.joint] = *offset);
        all
    }

    /// The loads of all joints from those of the independent ones.
    pub fn loads(&self, loads: Vec<JointLoad>) -> Vec<JointLoad> {
        let sizes = |offsets: &[f64]| offsets.iter().map(|offset| offset.abs()).collect::<Vec<_>>();
        (loads.into_iter().zip(&self.offsets))
            .map(|(load, offsets)| JointLoad {
                vector: self.spread(&load.vector, offsets),
                terms: self.spread(&load.terms, &sizes(offsets)),
                name: load.name,
            })
            .collect()
    }
}

/// The system of all joints from that of the independent ones; its pairs are those of all joints already.
pub fn with_repeated(system: ContactSystem, dependence: &Dependence<'_>) -> ContactSystem {
    let Dependence { independent, repeated, .. } = dependence;
    let k = independent.len() + repeated.len();
    let mut mixed = DMatrix::zeros(k, k);
    for (a, &i) in independent.iter().enumerate() {
        for (b, &j) in independent.iter().enumerate() {
            mixed[(i, j)] = system.stiffness[(a, b)];
        }
    }
    let mut self_stress = DMatrix::zeros(k, repeated.len());
    let mut forced = vec![false; k];
    for (column, one) in repeated.iter().enumerate() {
        forced[one.joint] = true;
        self_stress[(one.joint, column)] = 1.0;
        for &(joint, factor) in one.terms {
            mixed[(one.joint, joint)] = factor;
            mixed[(joint, one.joint)] = -factor;
            self_stress[(joint, column)] = -factor;
        }
    }
    let motions: Vec<DVector<f64>> = (system.kernel.column_iter())
        .map(|column| {
            let mut z = dependence.spread(&column.into_owned(), &vec![0.0; repeated.len()]);
            for one in repeated {
                z[one.joint] = one.terms.iter().map(|&(joint, factor)| factor * z[joint]).sum();
            }
            z
        })
        .collect();
    ContactSystem {
        groups: Vec::new(),
        stiffness: mixed,
        loads: dependence.loads(system.loads),
        kernel: orthonormal(&motions, k),
        force_form: Some(ForceForm { joints: forced, self_stress }),
        ..system
    }
}

/// The joint forces and displacements of a state or of a direction in the user's units, from the unknowns of the LCP.
pub fn unknowns(
    system: &ContactSystem,
    problem: Option<&ContactProblem>,
    contact: &ContactLcp,
    z: &[f64],
) -> DVector<f64> {
    let mut unknowns = DVector::zeros(system.joint_count());
    let mut slipping = Vec::new();
    for (row, meaning) in contact.rows.iter().enumerate() {
        let unit = if contact.swapped[row] { contact.force_unit } else { contact.length_unit };
        let value = z[row] * unit;
        match (meaning.couple, system.pairs[meaning.pair].plane_tangential()) {
            (RowKind::Normal, _) => unknowns[meaning.pair] += value,
            (RowKind::PLUS, Some(joint)) if system.is_forced(joint) => slipping.push((meaning.pair, joint, value)),
            (RowKind::PLUS, Some(joint)) => unknowns[joint] += value,
            (RowKind::Facet(_), Some(joint)) if system.is_forced(joint) => {}
            (RowKind::Facet(_), Some(joint)) => unknowns[joint] -= value,
            (_, None) => {}
        }
    }
    if slipping.is_empty() {
        return unknowns;
    }
    let response = responses(system, problem, &unknowns);
    for (pair, joint, plus) in slipping {
        let f = contact.friction[pair];
        let pressed = if system.is_forced(pair) {
            unknowns[pair]
        } else if unknowns[pair] > 0.0 && problem.is_some() {
            0.0
        } else {
            response[pair]
        };
        let fixed = problem.map_or(0.0, |problem| problem.laws[pair].fixed_bound());
        let force = Sum::exactly(plus).plus(-f, Sum::exactly(pressed)).plus(-1.0, Sum::exactly(fixed));
        // What x⁺ and the bound leave of each other by rounding would come out as a displacement with no larger terms.
        unknowns[joint] = force.cleaned();
    }
    unknowns
}

/// Forces of the joints in displacement form and displacements of the others; of a direction without a problem.
fn responses(system: &ContactSystem, problem: Option<&ContactProblem>, unknowns: &DVector<f64>) -> DVector<f64> {
    let linear = &system.stiffness * unknowns;
    match problem {
        Some(problem) => linear + problem.joint_constants(),
        None => linear,
    }
}

/// z over all joints of a direction of the LCP, in the user's units.
pub fn motion(system: &ContactSystem, contact: &ContactLcp, z: &[f64]) -> DVector<f64> {
    let mut motion = unknowns(system, None, contact, z);
    let response = responses(system, None, &motion);
    for joint in (0..motion.len()).filter(|&joint| system.is_forced(joint)) {
        motion[joint] = response[joint];
    }
    motion
}

/// λ and z of every joint as affine functions of the unknowns of the LCP, the constant in the last column;
/// dimensionless.
struct Forms {
    force: DMatrix<f64>,
    displacement: DMatrix<f64>,
}

/// What the constants of the LCP are made of, dimensionless.
struct Constants<'a> {
    /// Those of the joints: forces; displacements of those in force form.
    joints: &'a DVector<f64>,
    /// c or r_f of the pairs.
    fixed: &'a [f64],
}

/// Pairs, rows and frictions under which an LCP is written, and the unit of R.
struct Writer<'a> {
    system: &'a ContactSystem,
    rows: &'a [RowId],
    friction: &'a [f64],
    stiffness_unit: f64,
}

impl Writer<'_> {
    fn forced(&self, joint: usize) -> bool {
        self.system.is_forced(joint)
    }

    /// An entry of the mixed matrix, dimensionless.
    fn entry(&self, i: usize, j: usize) -> f64 {
        let entry = self.system.stiffness[(i, j)];
        match (self.forced(i), self.forced(j)) {
            (false, false) => entry / self.stiffness_unit,
            (true, true) => entry * self.stiffness_unit,
            _ => entry,
        }
    }

    /// λ and z of all joints; without unknowns only their constants.
    fn forms(&self, constants: &Constants<'_>, with_unknowns: bool) -> Forms {
        let (k, system) = (self.system.joint_count(), self.system);
        let width = if with_unknowns { self.rows.len() } else { 0 };
        let (mut force, mut displacement) = (DMatrix::zeros(k, width + 1), DMatrix::zeros(k, width + 1));
        // Responses of the rows of the mixed matrix.
        let mut response = DMatrix::zeros(k, width + 1);
        response.column_mut(width).copy_from(constants.joints);
        for (r, meaning) in self.rows.iter().enumerate().take(width) {
            let joint = match meaning.couple {
                RowKind::Normal => meaning.pair,
                _ => system.pairs[meaning.pair].plane_tangential().unwrap_or(meaning.pair),
            };
            let sign = if meaning.couple == RowKind::MINUS { -1.0 } else { 1.0 };
            match (meaning.couple, self.forced(joint)) {
                (RowKind::Normal, true) => force[(joint, r)] = 1.0,
                // x⁺ follows below; z⁻ moves nothing but its own couple.
                (_, true) => continue,
                (_, false) => displacement[(joint, r)] = sign,
            }
            for i in 0..k {
                response[(i, r)] = sign * self.entry(i, joint);
            }
        }
        for i in (0..k).filter(|&i| !self.forced(i)) {
            force.row_mut(i).copy_from(&response.row(i));
        }
        // λ_τ = x⁺ − f x_n − c of the tangential joints in force form.
        for (pair, joint) in self.forced_tangentials() {
            let pressed = force.row(pair) * self.friction[pair];
            let mut own = -pressed;
            own[width] -= constants.fixed[pair];
            if with_unknowns && let Some(plus) = self.row_of(pair, RowKind::PLUS) {
                own[plus] += 1.0;
            }
            for i in 0..k {
                let entry = self.entry(i, joint);
                if entry != 0.0 {
                    let mut row = response.row_mut(i);
                    row += &own * entry;
                }
            }
            force.row_mut(joint).copy_from(&own);
        }
        for i in 0..k {
            if self.forced(i) {
                displacement.row_mut(i).copy_from(&response.row(i));
            } else {
                force.row_mut(i).copy_from(&response.row(i));
            }
        }
        Forms { force, displacement }
    }

    fn forced_tangentials(&self) -> impl Iterator<Item = (usize, usize)> {
        let pairs = self.system.pairs.iter().enumerate();
        pairs
            .filter_map(|(i, pair)| pair.plane_tangential().map(|joint| (i, joint)))
            .filter(|(_, joint)| self.forced(*joint))
    }

    fn row_of(&self, pair: usize, couple: RowKind) -> Option<usize> {
        self.rows.iter().position(|row| *row == RowId { pair, couple })
    }

    /// The rows of the LCP, the constant in the last column.
    fn written(&self, forms: &Forms, constants: &Constants<'_>) -> DMatrix<f64> {
        let width = forms.force.ncols() - 1;
        let mut written = DMatrix::zeros(self.rows.len(), width + 1);
        for (r, meaning) in self.rows.iter().enumerate() {
            let i = meaning.pair;
            let mut row = written.row_mut(r);
            let side = match meaning.couple {
                RowKind::Normal if self.forced(i) => {
                    row.copy_from(&forms.displacement.row(i));
                    continue;
                }
                RowKind::Normal => {
                    row.copy_from(&forms.force.row(i));
                    continue;
                }
                RowKind::PLUS => 1.0,
                RowKind::Facet(_) => -1.0,
            };
            let joint = self.system.pairs[i].plane_tangential().unwrap_or(i);
            let mut bound = forms.force.row(i) * self.friction[i];
            bound[width] += constants.fixed[i];
            match (meaning.couple, self.forced(joint)) {
                (RowKind::PLUS, true) => {
                    row.copy_from(&forms.displacement.row(joint));
                    if width > 0
                        && let Some(minus) = self.row_of(i, RowKind::MINUS)
                    {
                        row[minus] += 1.0;
                    }
                }
                (_, true) => {
                    row.copy_from(&(bound * 2.0));
                    if width > 0
                        && let Some(plus) = self.row_of(i, RowKind::PLUS)
                    {
                        row[plus] -= 1.0;
                    }
                }
                (_, false) => row.copy_from(&(bound + forms.force.row(joint) * side)),
            }
        }
        written
    }
}

/// Whether w of a row is a displacement and its z the force.
fn is_swapped(system: &ContactSystem, row: RowId) -> bool {
    match row.couple {
        RowKind::Normal => system.is_forced(row.pair),
        RowKind::PLUS => system.pairs[row.pair].plane_tangential().is_some_and(|joint| system.is_forced(joint)),
        RowKind::Facet(_) => false,
    }
}

/// Unit of R: of its largest diagonal entry, or of the inverse of the largest one of W.
fn stiffness_unit(system: &ContactSystem) -> f64 {
    let diagonal = |forced: bool| {
        let of = (0..system.joint_count()).filter(move |&joint| system.is_forced(joint) == forced);
        of.map(|joint| system.stiffness[(joint, joint)]).fold(0.0, f64::max)
    };
    match (diagonal(false), diagonal(true)) {
        (0.0, compliance) if compliance > 0.0 => power_of_two(1.0 / compliance),
        (stiffness, _) => power_of_two(stiffness),
    }
}

fn dimensionless(system: &ContactSystem, joints: &DVector<f64>, force_unit: f64, length_unit: f64) -> DVector<f64> {
    let unit = |joint: usize| if system.is_forced(joint) { length_unit } else { force_unit };
    DVector::from_fn(joints.len(), |joint, _| joints[joint] / unit(joint))
}

/// Writes the LCP of a system with joints in force form: all rows written out, none mirrored.
///
/// # Errors
/// Where the covering cannot cover q.
pub fn contact_lcp(problem: &ContactProblem, covering: Covering) -> Result<ContactLcp, CoveringError> {
    let system = &*problem.system;
    let contact = written_lcp(problem, covering);
    let MirroredLcp { q, covering, .. } = &*contact.lcp;
    match (0..q.len()).find(|&row| covering[row] == 0.0 && q[row] < 0.0) {
        Some(row) => {
            let pair = system.pairs[contact.rows[row].pair].id.clone();
            Err(CoveringError::WeightWithoutFriction { pair })
        }
        None => Ok(contact),
    }
}

/// The same, even where the covering does not cover q.
pub fn written_lcp(problem: &ContactProblem, covering: Covering) -> ContactLcp {
    let system = &*problem.system;
    let rows = rows(system, Polygon::PLANE);
    let frictions = problem.frictions();
    let stiffness_unit = stiffness_unit(system);
    let writer = Writer { system, rows: &rows, friction: &frictions, stiffness_unit };
    let load = joint_forces(problem, &DVector::zeros(system.joint_count()));
    // What cancels to rounding is not a load.
    let load = DVector::from_iterator(load.len(), load.iter().map(|sum| sum.cleaned()));
    // Forces as they are, displacements as the forces that a stiffness of one unit makes of them.
    let unscaled = dimensionless(system, &load, 1.0, 1.0 / stiffness_unit);
    let fixed = problem.fixed_bounds();
    let constants = Constants { joints: &unscaled, fixed: &fixed };
    let written = writer.written(&writer.forms(&constants, true), &constants);
    let n = rows.len();
    let largest = written.column(n).amax();
    let force_unit = power_of_two(largest);
    let matrix: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| written[(i, j)]).collect()).collect();
    let swapped: Vec<bool> = rows.iter().map(|row| is_swapped(system, *row)).collect();
    let q: Vec<f64> = (0..n).map(|i| written[(i, n)] / force_unit).collect();
    let cover: Vec<f64> =
        rows.iter().zip(&swapped).map(|(row, swapped)| cover(problem, *row, *swapped, covering)).collect();
    let of = |couple: RowKind| (0..system.pairs.len()).map(|pair| writer.row_of(pair, couple)).collect::<Vec<_>>();
    let scale = Scale::plain(&matrix);
    let lcp = MirroredLcp::plain(&Lcp { matrix, q, covering: cover, scale });
    let (normal_row, facet_rows) = (of(RowKind::Normal), vec![of(RowKind::PLUS), of(RowKind::MINUS)]);
    ContactLcp {
        lcp: Arc::new(lcp),
        friction: frictions,
        normal_row,
        facet_rows,
        polygon: Polygon::PLANE,
        force_unit,
        length_unit: force_unit / stiffness_unit,
        swapped,
        rows,
    }
}

/// Entry of the covering vector: as everywhere for forces and reserves; 1 for displacements; and for the second reserve
/// of a couple in force form what both have together.
fn cover(problem: &ContactProblem, row: RowId, swapped: bool, covering: Covering) -> f64 {
    let system = &*problem.system;
    if row.couple == RowKind::Normal || swapped {
        return 1.0;
    }
    let own = problem.laws[row.pair].covering(covering);
    let forced = system.pairs[row.pair].plane_tangential().is_some_and(|joint| system.is_forced(joint));
    if forced { 2.0 * own } else { own }
}

/// q of an LCP written for the same system and frictions, for other constants of its joints and pairs (user's units).
pub fn constants(system: &ContactSystem, contact: &ContactLcp, joints: &DVector<f64>, fixed: &[f64]) -> DVector<f64> {
    let joints = dimensionless(system, joints, contact.force_unit, contact.length_unit);
    let fixed: Vec<f64> = fixed.iter().map(|fixed| fixed / contact.force_unit).collect();
    let stiffness_unit = contact.force_unit / contact.length_unit;
    let writer = Writer { system, rows: &contact.rows, friction: &contact.friction, stiffness_unit };
    let constants = Constants { joints: &joints, fixed: &fixed };
    writer.written(&writer.forms(&constants, false), &constants).column(0).into_owned()
}
