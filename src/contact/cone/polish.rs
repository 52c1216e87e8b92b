//! The point of a search, polished in its states: Newton's method on the equations of these states alone, with
//! residuals in doubled precision, so that each row holds to a few ε of its own terms.
//!
//! ```text
//!   open:  λ_n = 0        slip:  λ_τ + b z_τ/|z_τ| = 0,  b = f λ_n + c   (b = c while open)        else z = 0
//! ```
//! In this form the direction of a slip is as exact as that of its friction, however small the slip is.

use nalgebra::{DMatrix, DVector};

use super::natural_map::Branch;
use super::newton::hold;
use super::{ConeProblem, Point, across, length};
use crate::contact::sum::Sum;
use crate::lcp::problem::NOISE;
use stickslip_numerics::decompositions::Factor;
use stickslip_numerics::doubled::add_response;

/// Rounds at most.
const ROUNDS: usize = 5;
/// Residuals up to this share of their terms are as good as z in f64 can make them.
const GOOD: f64 = NOISE / 32.0;

/// z with what is held at exactly 0.
pub(super) fn held(problem: &ConeProblem, mut z: DVector<f64>, states: &[Branch]) -> DVector<f64> {
    for (i, (pair, state)) in problem.pairs.iter().zip(states).enumerate() {
        if state.is_closed {
            z[i] = 0.0;
        }
        if state.outside.is_none() {
            pair.tangents.clone().for_each(|joint| z[joint] = 0.0);
        }
    }
    z
}

/// z with what moves put right; unchanged where no round helps.
pub(super) fn polished(problem: &ConeProblem, z: DVector<f64>) -> Point {
    let mut best = problem.stilled(Point::at(problem, z));
    let mut rows = Rows::at(problem, &best);
    for _ in 0..ROUNDS {
        if rows.worst <= GOOD {
            break;
        }
        let Some(step) = rows.step(problem, &best) else { break };
        let mut next = best.clone();
        next.shift(problem, &step);
        let found = Rows::at(problem, &next);
        if found.worst.is_nan() || found.worst >= rows.worst {
            break;
        }
        (best, rows) = (next, found);
    }
    problem.stilled(best)
}

/// The equations of the joints that move.
struct Rows {
    joints: Vec<usize>,
    residual: Vec<f64>,
    /// Largest residual as a share of its terms.
    worst: f64,
}

/// b and z_τ/|z_τ| of a pair that slips; a bound of 0 has no direction.
fn friction(problem: &ConeProblem, pair: usize, z: &DVector<f64>, forces: &[Sum]) -> (Sum, [f64; 2]) {
    let slip = problem.pairs[pair].tangential(z);
    let size = length(slip);
    let bound = problem.bound(pair, z[pair] > 0.0, forces);
    (bound, if size > 0.0 { slip.map(|slip| slip / size) } else { [0.0; 2] })
}

impl Rows {
    fn at(problem: &ConeProblem, point: &Point) -> Rows {
        let Point { z, bending } = point;
        let mut forces = problem.forces(bending);
        let (mut high, mut low) = (problem.load.as_slice().to_vec(), vec![0.0; bending.len()]);
        add_response(&mut high, &mut low, problem.stiffness.as_slice(), bending.as_slice());
        for (force, (high, low)) in forces.iter_mut().zip(high.iter().zip(&low)) {
            force.value = high + low;
        }
        let mut rows = Rows { joints: Vec::new(), residual: Vec::new(), worst: 0.0 };
        let mut put = |joint: usize, sum: Sum| {
            rows.joints.push(joint);
            rows.residual.push(sum.value);
            rows.worst = rows.worst.max(sum.share().abs());
        };
        for (i, pair) in problem.pairs.iter().enumerate() {
            if z[i] != 0.0 {
                put(i, forces[i]);
            }
            if problem.slip(i, z).iter().any(|(_, z)| *z != 0.0) {
                let (bound, along) = friction(problem, i, z, &forces);
                for (joint, along) in pair.tangents.clone().zip(along) {
                    put(joint, forces[joint].plus(along, bound));
                }
            }
        }
        rows
    }

    /// One step of Newton's method; `None` where the equations are singular.
    fn step(&self, problem: &ConeProblem, point: &Point) -> Option<DVector<f64>> {
        let Point { z, bending } = point;
        let forces = problem.forces(bending);
        let n = self.joints.len();
        let mut place = vec![usize::MAX; z.len()];
        self.joints.iter().enumerate().for_each(|(at, &joint)| place[joint] = at);
        let mut matrix = DMatrix::from_fn(n, n, |i, j| problem.stiffness[(self.joints[i], self.joints[j])]);
        for (i, pair) in problem.pairs.iter().enumerate() {
            if pair.tangents.clone().all(|joint| place[joint] == usize::MAX) {
                continue;
            }
            let (bound, along) = friction(problem, i, z, &forces);
            let size = length(pair.tangential(z));
            for (t, joint) in pair.tangents.clone().enumerate() {
                if z[i] == 0.0 {
                    let factor = pair.friction() * along[t];
                    for (j, other) in self.joints.iter().enumerate() {
                        matrix[(place[joint], j)] += factor * problem.stiffness[(i, *other)];
                    }
                }
                for (u, other) in pair.tangents.clone().enumerate() {
                    matrix[(place[joint], place[other])] += bound.value / size * across(along, t, u);
                }
            }
        }
        if let Some(free) = problem.free_motions(&forces, |i| z[i] > 0.0, |joint| place[joint] < n) {
            hold(&mut matrix, &free.select_rows(&self.joints));
        }
        let right = DVector::from_fn(n, |at, _| -self.residual[at]);
        let found = Factor::new(matrix).solve(&right)?;
        let mut step = DVector::zeros(z.len());
        self.joints.iter().zip(found.iter()).for_each(|(&joint, value)| step[joint] = *value);
        Some(step)
    }
}
