//! The fresh check of an answer on the cone: the laws evaluated from R and the load, row by row as shares of what each
//! row is summed from.

use nalgebra::DVector;

use super::{ConeProblem, length};
use crate::contact::sum::{HIDDEN, LAW_ROUNDING, Sum};

/// How far an answer is from the laws; all as shares, 0 … 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConeCheck {
    /// Least x_n, or reserve f x_n + c − |x_τ|; ≤ 0.
    pub min_w: f64,
    /// Least z_n; ≤ 0.
    pub min_z: f64,
    /// Largest product x_n z_n or reserve · |z_τ|, the smaller of the two shares; also z_n of a bilateral pair.
    pub complementarity: f64,
    /// Largest part of a friction force that does not oppose the slip: across it, or along with it.
    pub misdirection: f64,
    /// Largest share of the loads that rounding may hide in a force.
    pub hidden: f64,
    /// The pair that violates its law most.
    pub worst_pair: usize,
    /// Whether rounding explains all of it.
    pub passed: bool,
}

impl ConeCheck {
    /// The check of z with its forces λ.
    pub fn of(problem: &ConeProblem, z: &DVector<f64>, forces: &[Sum]) -> ConeCheck {
        let mut check = ConeCheck::default();
        let mut worst = 0.0;
        for pair in 0..problem.pairs.len() {
            let own = check_pair(problem, pair, z, forces);
            // A NaN is the worst of all.
            if own.violation().is_nan() || own.violation() > worst {
                worst = own.violation();
                check.worst_pair = pair;
            }
            check.min_w = check.min_w.min(own.min_w);
            check.min_z = check.min_z.min(own.min_z);
            check.complementarity = check.complementarity.max(own.complementarity);
            check.misdirection = check.misdirection.max(own.misdirection);
        }
        let bounds = problem.pairs.iter().map(|pair| pair.fixed()).fold(0.0, f64::max);
        let loads = problem.load_terms.amax().max(problem.load.amax()).max(bounds);
        if loads > 0.0 {
            check.hidden = forces.iter().map(|force| LAW_ROUNDING * force.magnitude / loads).fold(0.0, f64::max);
        }
        check.passed = worst <= LAW_ROUNDING && check.hidden <= HIDDEN;
        check
    }

    /// The largest violation of any law.
    pub fn violation(&self) -> f64 {
        [-self.min_w, -self.min_z, self.complementarity, self.misdirection]
            .into_iter()
            .fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) })
    }
}

fn check_pair(problem: &ConeProblem, i: usize, z: &DVector<f64>, forces: &[Sum]) -> ConeCheck {
    let pair = &problem.pairs[i];
    let mut check = ConeCheck::default();
    let opening = problem.share(&[(i, z[i])], forces);
    if pair.law.is_bilateral() {
        check.complementarity = opening;
    } else {
        check.min_w = forces[i].share().min(0.0);
        check.min_z = if z[i] < 0.0 { -opening } else { 0.0 };
        check.complementarity = if z[i] > 0.0 { forces[i].share().abs().min(opening) } else { 0.0 };
    }
    if !pair.rubs() {
        return check;
    }
    let [mut force, mut terms] = [[0.0; 2]; 2];
    for (t, joint) in pair.tangents.clone().enumerate() {
        (force[t], terms[t]) = (forces[joint].value, forces[joint].magnitude);
    }
    let bound = problem.bound(i, z[i] > 0.0, forces);
    let size = length(force);
    let reserve = bound.plus(-1.0, Sum { value: size, magnitude: length(terms) });
    check.min_w = check.min_w.min(reserve.share());
    let slip = pair.tangential(z);
    let slipped = length(slip);
    if slipped > 0.0 {
        let all = problem.share(&problem.slip(i, z), forces);
        check.complementarity = check.complementarity.max(reserve.share().abs().min(all));
        // The part of the force that is not against the slip, relative to all that the row is summed from.
        let along = slip.map(|slip| slip / slipped);
        let with = (force[0] * along[0] + force[1] * along[1]).max(0.0);
        let beside = (force[0] * along[1] - force[1] * along[0]).abs();
        let wrong = Sum { value: with.hypot(beside), magnitude: length(terms) + bound.magnitude };
        // Or the part of the slip that is not against the force, by what the forces feel of it.
        let opposed = if size > 0.0 { force.map(|force| -force / size) } else { [0.0; 2] };
        let kept = (slip[0] * opposed[0] + slip[1] * opposed[1]).max(0.0);
        let stray: Vec<(usize, f64)> =
            pair.tangents.clone().enumerate().map(|(t, joint)| (joint, slip[t] - kept * opposed[t])).collect();
        check.misdirection = wrong.share().min(problem.share(&stray, forces));
    }
    check
}
