//! Coulomb's cone: the answer in space that obeys |x_τ| ≤ f x_n + c itself, not the friction polygon around it
//! (method §7).
//!
//! ```text
//!   λ = R z + q,    x_n ≥ 0 ⟂ z_n ≥ 0,    |x_τ| ≤ f x_n + c,    x_τ = −(f x_n + c) z_τ / |z_τ|  where z_τ ≠ 0
//! ```
//! Newton's method on the natural map of these laws starts from the answer of the polygon, with halved steps; the
//! states it ends in are polished with residuals in doubled precision, and what comes out is checked afresh against the
//! cone. Where that fails the search starts again from a point that projections have brought nearer. Every loop ends.
//!
//! A pair has none, one or two tangential joints: the plane is the case of one.

mod check;
mod free;
mod mixed;
mod natural_map;
mod newton;
mod polish;
mod projection;

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

pub use check::ConeCheck;
pub use mixed::{MixedProblem, MixedState};

use super::law::{PairLaw, TangentialJoint};
use super::sum::{HIDDEN, LAW_ROUNDING, Sum};
use crate::lcp::problem::NOISE;
use crate::watch::Watch;
use stickslip_numerics::products::{add_columns, add_sparse_response};

/// Sweeps of projections before each search: the first search starts at the given point.
pub const FROM_ANYWHERE: &[usize] = &[0, 50, 200, 800];
/// The same where the answer is near, if there is one: a path tries a shorter step where none is found.
pub const FROM_NEARBY: &[usize] = &[0, 50];

/// A pair: its law, and the rows of R of its tangential joints. The normal joint of pair i is row i.
#[derive(Clone, Debug, PartialEq)]
pub struct ConePair {
    /// The law; its gap is already in the load.
    pub law: PairLaw,
    /// Rows of t, or of t1 and t2; none of a frictionless pair.
    pub tangents: Range<usize>,
}

/// λ = R z + load over the joints, and the laws of the pairs.
#[derive(Clone, Copy, Debug)]
pub struct ConeProblem<'a> {
    /// R, symmetric.
    pub stiffness: &'a DMatrix<f64>,
    /// RF − R·(g, 0).
    pub load: &'a DVector<f64>,
    /// What each entry of the load was summed from, ≥ its magnitude.
    pub load_terms: &'a DVector<f64>,
    /// Whether R is a result of a condensation, see [`ContactSystem::rounded`](super::system::ContactSystem::rounded).
    pub rounded: bool,
    /// Orthonormal basis Z of the kernel of R, with no columns where R is regular.
    pub kernel: &'a DMatrix<f64>,
    /// The pairs.
    pub pairs: &'a [ConePair],
}

/// State of a pair on the cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConeState {
    /// z_n > 0.
    Open,
    /// In contact, without tangential joints.
    Closed,
    /// In contact, z_τ = 0.
    Stick,
    /// In contact, z_τ ≠ 0.
    Slip,
}

/// An answer that passed its check.
#[derive(Clone, Debug, PartialEq)]
pub struct ConeAnswer {
    /// z over the joints; exactly 0 where a joint is held.
    pub z: DVector<f64>,
    /// λ over the joints with the magnitudes of its terms.
    pub forces: Vec<Sum>,
    /// One a pair.
    pub states: Vec<ConeState>,
    /// The fresh check.
    pub check: ConeCheck,
    /// Steps of Newton's method that led to it.
    pub steps: usize,
    /// Largest difference of a slip from the start's, as a share of the largest slip of both; 0 without slips.
    pub distance: f64,
}

/// Why there is no answer on the cone.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ConeFailure {
    /// The watch said so.
    #[error("interrupted")]
    Stopped,
    /// Newton's method did not end in an answer.
    #[error(
        "Newton's method did not end on Coulomb's cone: after {steps} steps from {starts} starts the laws are still violated by {violation:.1e} of the forces"
    )]
    NotConverged {
        /// Steps of all searches.
        steps: usize,
        /// Searches.
        starts: usize,
        /// The pair that violates its law most, in the best point found.
        pair: usize,
        /// The violation as a share of the terms of its row.
        violation: f64,
    },
    /// Joints that repeat one another press the harder the less they yield: the parts do not fit.
    #[error("joints that repeat one another do not come to rest: their gaps leave no room for all of them")]
    DoNotFit,
    /// R, the load or the start has entries that are not numbers.
    #[error("the contact stiffness matrix, the load or the start has entries that are not finite")]
    NotFinite,
}

/// The answer on the cone that Newton's method finds from `start`, displacements over the joints.
///
/// # Errors
/// [`ConeFailure`] where it finds none: nothing is then known of whether there is one.
pub fn answer_on_cone(
    problem: &ConeProblem,
    start: &DVector<f64>,
    watch: &dyn Watch,
) -> Result<ConeAnswer, ConeFailure> {
    answer_after(problem, start, FROM_ANYWHERE, watch)
}

/// The same by searches after as many sweeps each: [`FROM_ANYWHERE`], [`FROM_NEARBY`].
///
/// # Errors
/// [`ConeFailure`] where it finds none.
pub fn answer_after(
    problem: &ConeProblem,
    start: &DVector<f64>,
    sweeps: &[usize],
    watch: &dyn Watch,
) -> Result<ConeAnswer, ConeFailure> {
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    if ![problem.stiffness.as_slice(), problem.load.as_slice(), start.as_slice()].into_iter().all(finite) {
        return Err(ConeFailure::NotFinite);
    }
    let scale = problem.scale();
    let mut steps = 0;
    let mut best: Option<ConeCheck> = None;
    let mut from = start.clone();
    for &sweeps in sweeps {
        projection::sweep(problem, &scale, &mut from, sweeps, watch)?;
        let search = newton::by_displacements(problem, &scale, from.clone(), watch)?;
        steps += search.steps;
        let found = problem.polished(polish::held(problem, search.at, &search.map.branches), start, steps);
        let check = found.check;
        if check.passed {
            return Ok(found);
        }
        if best.as_ref().is_none_or(|best| check.violation() < best.violation()) {
            best = Some(check);
        }
    }
    let (pair, violation) = best.map_or((0, f64::INFINITY), |check| (check.worst_pair, check.violation()));
    Err(ConeFailure::NotConverged { steps, starts: sweeps.len(), pair, violation })
}

/// The answer in which just those joints move that move in z, near it. It may break the laws by twice what rounding
/// explains: a little further than another does that breaks them just as much.
///
/// # Errors
/// [`ConeFailure::NotConverged`] where it breaks them by more.
pub fn kept_on_cone(problem: &ConeProblem, z: &DVector<f64>) -> Result<ConeAnswer, ConeFailure> {
    let found = problem.polished(z.clone(), z, 0);
    let check = found.check;
    if check.violation() <= 2.0 * LAW_ROUNDING && check.hidden <= HIDDEN {
        return Ok(found);
    }
    Err(ConeFailure::NotConverged { steps: 0, starts: 0, pair: check.worst_pair, violation: check.violation() })
}

impl ConePair {
    /// f.
    fn friction(&self) -> f64 {
        self.law.friction()
    }

    /// Whether it has a friction bound: the natural map of what slips freely is x_τ = 0.
    fn rubs(&self) -> bool {
        !self.tangents.is_empty()
    }

    /// c, the bound of an open pair.
    fn fixed(&self) -> f64 {
        match self.law.tangential {
            TangentialJoint::Bounded { fixed, .. } => fixed,
            TangentialJoint::Free => 0.0,
        }
    }

    /// The tangential part, at this pair, of a vector over the joints; the second entry is 0 where the pair has one
    /// direction.
    fn tangential(&self, vector: &DVector<f64>) -> [f64; 2] {
        let mut found = [0.0; 2];
        self.tangents.clone().zip(&mut found).for_each(|(joint, entry)| *entry = vector[joint]);
        found
    }
}

/// |v|.
fn length(v: [f64; 2]) -> f64 {
    v[0].hypot(v[1])
}

/// Component `t` of (I − e eᵀ) `u`.
fn across(along: [f64; 2], t: usize, u: usize) -> f64 {
    f64::from(t == u) - along[t] * along[u]
}

impl ConeProblem<'_> {
    /// z polished as it stands, with its forces and its check, found from `start`.
    fn polished(&self, z: DVector<f64>, start: &DVector<f64>, steps: usize) -> ConeAnswer {
        let point = polish::polished(self, z);
        let forces = self.forces(&point.bending);
        let check = ConeCheck::of(self, &point.z, &forces);
        let (states, distance) = (self.states(&point.z), self.slip_difference(&point.z, start));
        ConeAnswer { z: point.z, forces, states, check, steps, distance }
    }

    /// r of every joint, a stiffness > 0: R_ii, in the tangent plane of a pair the same along both directions. A joint
    /// without stiffness takes that of the others: the natural map has the same zeros with any r.
    fn scale(&self) -> DVector<f64> {
        let diagonal = self.stiffness.diagonal();
        let largest = diagonal.iter().fold(0.0, |a: f64, b| a.max(*b));
        let or = |value: f64, other: f64| if value > 0.0 { value } else { other };
        let mut scale = diagonal.clone();
        for (i, pair) in self.pairs.iter().enumerate() {
            let tangential = pair.tangents.clone().map(|joint| diagonal[joint]).fold(0.0, f64::max);
            let one = or(largest, 1.0);
            scale[i] = or(diagonal[i], or(tangential, one));
            let tangential = or(tangential, scale[i]);
            pair.tangents.clone().for_each(|joint| scale[joint] = tangential);
        }
        scale
    }

    /// λ = R z + load with the magnitudes of its terms; of a condensed R √(R_ii R_kk) stands for |R_ik| in them.
    pub(super) fn forces(&self, z: &DVector<f64>) -> Vec<Sum> {
        let root = |joint: usize| self.stiffness[(joint, joint)].max(0.0).sqrt();
        let mut values: Vec<f64> = self.load.iter().copied().collect();
        let mut terms: Vec<f64> =
            self.load.iter().zip(self.load_terms).map(|(load, terms)| terms.max(load.abs())).collect();
        add_sparse_response(&mut values, self.stiffness.as_slice(), z.as_slice());
        if self.rounded {
            let scaled: f64 = z.iter().enumerate().map(|(k, z)| root(k) * z.abs()).sum();
            terms.iter_mut().enumerate().for_each(|(i, terms)| *terms += root(i) * scaled);
        } else {
            for (k, z) in z.iter().enumerate().filter(|(_, z)| **z != 0.0) {
                terms.iter_mut().zip(self.column(k)).for_each(|(terms, entry)| *terms += (entry * z).abs());
            }
        }
        values.into_iter().zip(terms).map(|(value, magnitude)| Sum { value, magnitude }).collect()
    }

    /// Column k of R.
    fn column(&self, k: usize) -> &[f64] {
        let rows = self.stiffness.nrows();
        &self.stiffness.as_slice()[k * rows..(k + 1) * rows]
    }

    /// What share of any force depends on displacements `moved` of some joints: max over the rows of
    /// |R moved| / Σ |terms|. Where no force feels them it is 1: nothing says that they are rounding.
    fn share(&self, moved: &[(usize, f64)], forces: &[Sum]) -> f64 {
        let mut terms = vec![0.0; forces.len()];
        let columns: Vec<(&[f64], f64)> = moved.iter().map(|(joint, z)| (self.column(*joint), *z)).collect();
        add_columns(&mut terms, &columns);
        let felt = terms.iter().any(|term| *term != 0.0);
        let of_rows = terms.iter().zip(forces).filter(|(term, _)| **term != 0.0);
        let share = of_rows.fold(0.0_f64, |share, (term, force)| share.max(term.abs() / force.magnitude));
        if felt { share } else { f64::from(moved.iter().any(|(_, z)| *z != 0.0)) }
    }

    /// z_τ of a pair, joint by joint.
    fn slip(&self, pair: usize, z: &DVector<f64>) -> Vec<(usize, f64)> {
        self.pairs[pair].tangents.clone().map(|joint| (joint, z[joint])).collect()
    }

    /// f x_n + c, with what it was summed from; an open pair has x_n = 0, not the rounding of a stiff joint's λ.
    fn bound(&self, pair: usize, is_open: bool, forces: &[Sum]) -> Sum {
        let fixed = Sum::exactly(self.pairs[pair].fixed());
        if is_open { fixed } else { fixed.plus(self.pairs[pair].friction(), forces[pair]) }
    }

    /// The part of a displacement that strains the structure: without its part in the kernel, which no force feels.
    fn bending(&self, z: &DVector<f64>) -> DVector<f64> {
        if self.kernel.ncols() == 0 { z.clone() } else { z - self.kernel * self.kernel.tr_mul(z) }
    }

    /// Displacements that no force can tell from 0 set to 0.
    fn stilled(&self, mut point: Point) -> Point {
        let forces = self.forces(&point.bending);
        let mut stopped = DVector::zeros(point.z.len());
        for (i, pair) in self.pairs.iter().enumerate() {
            for joints in [i..i + 1, pair.tangents.clone()] {
                let moved: Vec<(usize, f64)> = joints.map(|joint| (joint, point.z[joint])).collect();
                // A joint's own force says so at once in most cases.
                let own = |(joint, z): &(usize, f64)| {
                    (self.stiffness[(*joint, *joint)] * z).abs() <= NOISE * forces[*joint].magnitude
                };
                let moves = moved.iter().any(|(_, z)| *z != 0.0);
                if moves && moved.iter().all(own) && self.share(&moved, &forces) <= NOISE {
                    moved.iter().for_each(|(joint, z)| stopped[*joint] = -z);
                }
            }
        }
        point.shift(self, &stopped);
        point
    }

    pub(super) fn states(&self, z: &DVector<f64>) -> Vec<ConeState> {
        let state = |(i, pair): (usize, &ConePair)| match z[i] > 0.0 {
            true => ConeState::Open,
            false if !pair.rubs() => ConeState::Closed,
            false if pair.tangents.clone().all(|joint| z[joint] == 0.0) => ConeState::Stick,
            false => ConeState::Slip,
        };
        self.pairs.iter().enumerate().map(state).collect()
    }

    pub(super) fn slip_difference(&self, z: &DVector<f64>, start: &DVector<f64>) -> f64 {
        let (mut largest, mut difference) = (0.0_f64, 0.0_f64);
        for pair in self.pairs {
            let (slip, from) = (pair.tangential(z), pair.tangential(start));
            largest = largest.max(length(slip)).max(length(from));
            difference = difference.max(length([slip[0] - from[0], slip[1] - from[1]]));
        }
        if largest > 0.0 { difference / largest } else { 0.0 }
    }
}

/// A displacement and the part of it that strains the structure: however large a motion of the kernel is,
/// λ = R·bending + load is known to the digits of its own terms.
#[derive(Clone, Debug)]
struct Point {
    z: DVector<f64>,
    bending: DVector<f64>,
}

impl Point {
    fn at(problem: &ConeProblem, z: DVector<f64>) -> Point {
        Point { bending: problem.bending(&z), z }
    }

    fn shift(&mut self, problem: &ConeProblem, step: &DVector<f64>) {
        self.z += step;
        self.bending += problem.bending(step);
    }
}

#[cfg(test)]
mod tests;
