//! The natural map of the laws: zero in the answers and nowhere else.
//!
//! ```text
//!   Φ_n = λ_n − max(λ_n − r z_n, 0)          (unilateral)      Φ_n = r z_n      (bilateral)
//!   Φ_τ = λ_τ − P(a),   a = λ_τ − r z_τ,     P onto what friction admits, b = f max(λ_n − r z_n, 0) + c
//! ```
//! What friction admits is the disk of radius b or the polygon around it. With a inside of it, where the pair is held,
//! Φ_τ = r z_τ; otherwise Φ_τ = λ_τ − P(a), on the disk λ_τ − b a/|a|. All of Φ are forces.

use nalgebra::DVector;

use super::{ConePair, across, length};
use crate::contact::polygon::Polygon;
use crate::contact::sum::Sum;
use crate::lcp::problem::NOISE;

/// What friction admits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Admitted {
    /// |x_τ| ≤ b.
    Disk,
    /// d_k·x_τ ≤ b for every facet of a polygon in space.
    Polygon(Polygon),
}

/// Outside of what friction admits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outside {
    /// P(a).
    nearest: [f64; 2],
    /// ∂P/∂b: on the disk a/|a|, the direction of the friction; 0 where a is.
    pub along: [f64; 2],
    /// ∂P/∂a, row by row.
    pub turned: [[f64; 2]; 2],
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

impl Admitted {
    /// Where a lies outside of it, or b is 0, which leaves an open pair free.
    fn outside(self, a: [f64; 2], bound: f64) -> Option<Outside> {
        let size = length(a);
        if bound == 0.0 || matches!(self, Admitted::Disk) {
            let unit = if size > 0.0 { size.recip() } else { 0.0 };
            let (along, ratio) = (a.map(|a| a * unit), bound * unit);
            let turned = [0, 1].map(|t| [0, 1].map(|u| ratio * across(along, t, u)));
            return (size > bound || bound == 0.0).then_some(Outside {
                nearest: along.map(|e| bound * e),
                along,
                turned,
            });
        }
        let Admitted::Polygon(polygon) = self else { return None };
        let beyond = |facet: usize| {
            let [x, y] = polygon.direction(facet);
            x * a[0] + y * a[1]
        };
        let facet = (0..polygon.facets()).max_by(|&k, &l| beyond(k).total_cmp(&beyond(l)))?;
        if beyond(facet) <= bound {
            return None;
        }
        let ([x, y], half) = (polygon.direction(facet), polygon.half_side());
        let aside = x * a[1] - y * a[0];
        let at = |aside: f64| [bound * x - aside * y, bound * y + aside * x];
        if aside.abs() <= half * bound {
            return Some(Outside { nearest: at(aside), along: [x, y], turned: [[y * y, -x * y], [-x * y, x * x]] });
        }
        let end = half.copysign(aside);
        Some(Outside { nearest: at(end * bound), along: [x - end * y, y + end * x], turned: [[0.0; 2]; 2] })
    }
}

impl NaturalMap {
    /// Φ where the joints of `pairs` have displacements z, known to a few ε of `sizes`, and forces.
    pub fn at(
        (pairs, admitted): (&[ConePair], Admitted),
        scale: &DVector<f64>,
        (z, sizes): (&DVector<f64>, &DVector<f64>),
        forces: &[Sum],
    ) -> NaturalMap {
        let mut map = NaturalMap {
            branches: Vec::with_capacity(pairs.len()),
            residual: DVector::zeros(z.len()),
            norm: 0.0,
            is_zero: true,
        };
        let mut put = |joint: usize, value: f64, terms: f64| {
            map.residual[joint] = value;
            map.is_zero &= value.abs() <= NOISE * (terms + scale[joint] * sizes[joint]);
        };
        for (i, pair) in pairs.iter().enumerate() {
            let normal = forces[i].value - scale[i] * z[i];
            let is_closed = pair.law.is_bilateral() || normal > 0.0;
            put(i, if is_closed { scale[i] * z[i] } else { forces[i].value }, forces[i].magnitude);
            let mut branch = Branch { is_closed, outside: None };
            if pair.rubs() {
                let pressed = if is_closed && !pair.law.is_bilateral() { normal } else { 0.0 };
                let bound = pair.friction() * pressed + pair.fixed();
                let terms = pair.friction() * (forces[i].magnitude + scale[i] * sizes[i]) + pair.fixed();
                let mut a = [0.0; 2];
                for (joint, a) in pair.tangents.clone().zip(&mut a) {
                    *a = forces[joint].value - scale[joint] * z[joint];
                }
                branch.outside = admitted.outside(a, bound);
                for (t, joint) in pair.tangents.clone().enumerate() {
                    let value = match branch.outside {
                        None => scale[joint] * z[joint],
                        Some(outside) => forces[joint].value - outside.nearest[t],
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
