//! Forces and reserves of a state, each with the magnitudes of the terms it was summed from.
//!
//! A value computed as a sum is known to a few ε of the sum of the magnitudes of its terms, whatever the largest force,
//! bound or stiffness elsewhere (method §4, "Zero"). Everything that asks whether a force, a
//! reserve or a displacement is zero or negative asks here.

use nalgebra::DVector;

use super::law::PairLaw;
use super::problem::ContactProblem;
use super::sum::{LAW_ROUNDING, Sum};
use super::system::ContactSystem;
use crate::lcp::problem::NOISE;

/// √R_ii of a joint.
fn root(system: &ContactSystem, joint: usize) -> f64 {
    system.stiffness[(joint, joint)].max(0.0).sqrt()
}

/// λ = R (z − (g, 0)) + RF over the joints; of joints in force form z is λ and λ is z. Where R is
/// [`rounded`](ContactSystem::rounded), √(R_ii R_kk) stands for |R_ik| of one group in the magnitudes.
pub fn joint_forces(problem: &ContactProblem, z: &DVector<f64>) -> Vec<Sum> {
    state_forces(problem, z).joints
}

/// The forces of a state of the joints, from the file where there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct StateForces {
    /// λ.
    pub joints: Vec<Sum>,
    /// What the equations of a file leave over: each is zero in a state that obeys them.
    pub left: Vec<Sum>,
}

/// [`joint_forces`] with what else a file says.
pub fn state_forces(problem: &ContactProblem, z: &DVector<f64>) -> StateForces {
    let system = &*problem.system;
    let mut forces = StateForces { joints: condensed_forces(problem, z), left: Vec::new() };
    if system.force_form.is_some() {
        return forces;
    }
    if let (Some(file), Some(load)) = (&system.file, &problem.file_load) {
        let given = file.forces(&problem.dislocation(z), &problem.dislocation_sizes(z.abs()), load);
        for (force, given) in forces.joints.iter_mut().zip(given.joints) {
            // Forces solved for from a compliance have no terms of their own.
            let magnitude = if file.compliance { force.magnitude.max(given.magnitude) } else { given.magnitude };
            *force = Sum { value: given.value, magnitude };
        }
        forces.left = given.left;
    }
    forces
}

fn condensed_forces(problem: &ContactProblem, z: &DVector<f64>) -> Vec<Sum> {
    let system = &*problem.system;
    let mut forces: Vec<Sum> = (problem.load.iter())
        .zip(&problem.load_terms)
        .map(|(value, magnitude)| Sum { value: *value, magnitude: *magnitude })
        .collect();
    let mut scaled = vec![0.0; system.groups.iter().max().map_or(1, |last| last + 1)];
    for k in 0..system.joint_count() {
        let mut gap = problem.laws.get(k).map_or(0.0, PairLaw::gap);
        if system.is_forced(k) {
            // The displacement is what comes out.
            forces[k] = forces[k].plus(1.0, Sum::exactly(gap));
            gap = 0.0;
        }
        // The distance open and the gap cancel each other: each is a term of its own.
        let (moved, size) = (z[k] - gap, z[k].abs() + gap.abs());
        if size == 0.0 {
            continue;
        }
        let column = system.stiffness.column(k);
        if system.rounded && !system.is_forced(k) {
            scaled[system.group(k)] += root(system, k) * size;
            for (i, (force, entry)) in forces.iter_mut().zip(column.iter()).enumerate() {
                force.value += entry * moved;
                if system.is_forced(i) {
                    force.magnitude += entry.abs() * size;
                }
            }
        } else {
            for (force, entry) in forces.iter_mut().zip(column.iter()) {
                force.value += entry * moved;
                force.magnitude += entry.abs() * size;
            }
        }
    }
    if scaled.iter().any(|scaled| *scaled > 0.0) {
        let felt = forces.iter_mut().enumerate().filter(|(i, _)| !system.is_forced(*i));
        felt.for_each(|(i, force)| force.magnitude += root(system, i) * scaled[system.group(i)]);
    }
    forces
}

/// What rounding can have made of the force of each joint where nothing moves: a limit on paper may lie as far beside the
/// stored numbers.
pub fn rounding_at_rest(problem: &ContactProblem) -> Vec<f64> {
    let forces = joint_forces(problem, &DVector::zeros(problem.system.joint_count()));
    forces.iter().map(|force| LAW_ROUNDING * force.magnitude).collect()
}

/// What the laws bound from below in a pair: each ≥ 0 in an answer.
#[derive(Clone, Debug, PartialEq)]
pub struct PairSums {
    /// x_n; `None` where the normal joint is bilateral.
    pub normal: Option<Sum>,
    /// The reserve of every facet, in the plane x⁺ and x⁻; none without friction.
    pub reserves: Vec<Sum>,
}

/// x_n and the reserves of a pair under joint forces. An open pair has x_n = 0, not the rounding of a stiff joint's λ,
/// in its bound.
pub fn pair_sums(problem: &ContactProblem, forces: &[Sum], (pair, is_open): (usize, bool)) -> PairSums {
    let of = &problem.system.pairs[pair];
    let normal = (!of.law.is_bilateral()).then(|| forces[pair]);
    if !of.rubs() {
        return PairSums { normal, reserves: Vec::new() };
    }
    let bound = friction_bound(problem, forces, (pair, is_open));
    let reserve = |facet: usize| {
        let along = of.tangential.clone().zip(problem.polygon.direction(facet));
        along.fold(bound, |sum, (joint, d)| sum.plus(d, forces[joint]))
    };
    PairSums { normal, reserves: (0..problem.polygon.facets()).map(reserve).collect() }
}

/// f x_n + c of a pair under joint forces, x_n = 0 where it is open.
pub fn friction_bound(problem: &ContactProblem, forces: &[Sum], (pair, is_open): (usize, bool)) -> Sum {
    let fixed = Sum::exactly(problem.laws[pair].fixed_bound());
    if is_open { fixed } else { fixed.plus(problem.laws[pair].friction(), forces[pair]) }
}

/// What share of the forces depends on the displacement of a joint: max over the rows of |R_ik z_k| / Σ |terms|, 0 … 1.
/// A z whose share is a few ε cannot be told from 0 by any force. A joint that no force feels is measured by the
/// largest z.
pub fn displacement_share(system: &ContactSystem, z: &DVector<f64>, forces: &[Sum], joint: usize) -> f64 {
    share_of(system, z, forces, (joint, z[joint].abs()))
}

/// The same of a part of it, `moved` ≥ 0: of the slip along one facet.
pub fn share_of(system: &ContactSystem, z: &DVector<f64>, forces: &[Sum], (joint, moved): (usize, f64)) -> f64 {
    if moved == 0.0 {
        return 0.0;
    }
    let column = system.stiffness.column(joint);
    let feels = |i: &usize| column[*i] != 0.0;
    let forced = |i: &usize| system.is_forced(*i);
    let any_force = (0..column.len()).any(|i| feels(&i) && !forced(&i));
    if !any_force && !forced(&joint) {
        let others = (0..z.len()).filter(|i| !forced(i));
        return moved / others.map(|i| z[i].abs()).fold(0.0, f64::max);
    }
    // Where forces tell, displacements of joints in force form, which follow from this one, tell nothing more.
    let felt = (0..column.len()).filter(|i| feels(i) && !(any_force && forced(i)));
    felt.map(|i| column[i].abs() * moved / forces[i].magnitude).fold(0.0, f64::max)
}

/// Whether the displacement of a joint is rounding: no force can tell it from 0.
pub fn is_still(system: &ContactSystem, z: &DVector<f64>, forces: &[Sum], joint: usize) -> bool {
    if system.is_forced(joint) && system.stiffness.column(joint).iter().all(|entry| *entry == 0.0) {
        // A force that moves nothing follows from the laws alone; no displacement can call it rounding.
        return false;
    }
    // The joint's own force says so at once in most cases.
    let own = system.stiffness[(joint, joint)].abs() * z[joint].abs();
    own <= NOISE * forces[joint].magnitude && displacement_share(system, z, forces, joint) <= NOISE
}

/// A force in force form is known to a few ε of this: the sums that it enters, weighted by its part in each.
pub fn known_to(system: &ContactSystem, responses: &[Sum], joint: usize) -> f64 {
    let column = system.stiffness.column(joint);
    let any_force = (0..column.len()).any(|i| column[i] != 0.0 && !system.is_forced(i));
    let felt = column.iter().zip(responses).enumerate().filter(|(i, _)| !any_force || !system.is_forced(*i));
    let (sum, size) = felt.fold((0.0, 0.0), |(sum, size), (_, (entry, response))| {
        (sum + entry.abs() * response.magnitude, size + entry * entry)
    });
    if size > 0.0 { sum / size } else { 0.0 }
}
