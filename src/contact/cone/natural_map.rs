//! The natural map of the laws: zero in the answers and nowhere else.
//!
//! ```text
//!   Φ_n = λ_n − max(λ_n − r z_n, 0)          (unilateral)      Φ_n = r z_n      (bilateral)
//!   Φ_τ = λ_τ − P(a),   a = λ_τ − r z_τ,     P onto the disk of radius b = f max(λ_n − r z_n, 0) + c
//! ```
//! With |a| ≤ b, where the pair is held, Φ_τ = r z_τ; otherwise Φ_τ = λ_τ − b a/|a|. All of Φ are forces.

use nalgebra::DVector;

use super::{ConeProblem, length};
use crate::contact::sum::Sum;
use crate::lcp::problem::NOISE;

/// Outside of the disk of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outside {
    /// a/|a|, the direction of the friction; 0 where a is.
    pub along: [f64; 2],
    /// b/|a|, 0 … 1.
    pub ratio: f64,
}

/// The branch of the natural map that a pair is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Branch {
    /// λ_n − r z_n > 0, or bilateral: the equation is z_n = 0.
    pub is_closed: bool,
    /// Whether the tangential equation is z_τ = 0 (`None`, as in a pair without one), or that of slip.
    pub outside: Option<Outside>,
}

/// Φ at a point.
#[derive(Clone, Debug)]
pub(super) struct NaturalMap {
    pub branches: Vec<Branch>,
    /// Over the joints.
    pub residual: DVector<f64>,
    /// ‖Φ/√r‖.
    pub norm: f64,
    /// Whether every entry is what rounding leaves of its terms.
    pub is_zero: bool,
}

impl NaturalMap {
    pub fn at(problem: &ConeProblem, scale: &DVector<f64>, z: &DVector<f64>, forces: &[Sum]) -> NaturalMap {
        let mut map = NaturalMap {
            branches: Vec::with_capacity(problem.pairs.len()),
            residual: DVector::zeros(z.len()),
            norm: 0.0,
            is_zero: true,
        };
        let mut put = |joint: usize, value: f64, terms: f64| {
            map.residual[joint] = value;
            map.is_zero &= value.abs() <= NOISE * (terms + scale[joint] * z[joint].abs());
        };
        for (i, pair) in problem.pairs.iter().enumerate() {
            let normal = forces[i].value - scale[i] * z[i];
            let is_closed = pair.law.is_bilateral() || normal > 0.0;
            put(i, if is_closed { scale[i] * z[i] } else { forces[i].value }, forces[i].magnitude);
            let mut branch = Branch { is_closed, outside: None };
            if pair.rubs() {
                let pressed = if is_closed && !pair.law.is_bilateral() { normal } else { 0.0 };
                let bound = pair.friction() * pressed + pair.fixed();
                let terms = pair.friction() * (forces[i].magnitude + scale[i] * z[i].abs()) + pair.fixed();
                let mut a = [0.0; 2];
                for (joint, a) in pair.tangents.clone().zip(&mut a) {
                    *a = forces[joint].value - scale[joint] * z[joint];
                }
                let size = length(a);
                // A bound of 0 leaves an open pair free, whatever a is.
                if size > bound || bound == 0.0 {
                    let unit = if size > 0.0 { size.recip() } else { 0.0 };
                    branch.outside = Some(Outside { along: a.map(|a| a * unit), ratio: bound * unit });
                }
                for (t, joint) in pair.tangents.clone().enumerate() {
                    let value = match branch.outside {
                        None => scale[joint] * z[joint],
                        Some(outside) => forces[joint].value - bound * outside.along[t],
                    };
                    put(joint, value, forces[joint].magnitude + terms);
                }
            }
            map.branches.push(branch);
        }
        map.norm = map.residual.iter().zip(scale).map(|(value, r)| value * value / r).sum::<f64>().sqrt();
        map
    }
}
