//! A box that holds every answer of a contact problem with positive definite R, proved, for all q within given bounds.
//!
//! Every answer has zᵀλ ≤ 0, so zᵀR z ≤ −zᵀq: an ellipsoid about z₀/2, z₀ = −R⁻¹q. What is computed in f64 only comes
//! near to R⁻¹ and z₀; the bounds hold for whatever came out, with C ≈ R⁻¹ and r = q + R z₀:
//!
//! ```text
//!   λ_min(R) ≥ μ                               R − (μ + c) 1 has a Cholesky factor in f64, c ≥ its rounding (Rump)
//!   |z| ≤ |q| / μ                              from μ |z|² ≤ zᵀR z ≤ −zᵀq
//!   (z − z₀/2)ᵀR (z − z₀/2) ≤ ρ² = z₀ᵀR z₀ / 4 + |r| |q| / μ
//!   z_j = C_jᵀR z + (e_j − R C_j)ᵀz,           |C_jᵀR (z − z₀/2)| ≤ √(C_jᵀR C_j) ρ
//! ```
//! Sums carry the bounds of their rounding ([`Ball`]).

use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;

use crate::contact::schemes::ball::Ball;
use crate::lcp::exact::dyadic::nearest;

/// Condition of R, scaled to a diagonal near 1, up to which a box is worth its cost.
const CONDITION: f64 = 1e10;
/// Share of the least eigenvalue, as computed in f64, that is then proved to be a lower bound.
const SAFE: f64 = 0.5;

/// Lowest and highest z of each of the `joints`; `None` where R is not safely positive definite there.
pub(crate) fn ellipsoid(
    stiffness: &[Vec<BigRational>],
    constants: &[Ball],
    joints: &[usize],
) -> Option<Vec<(f64, f64)>> {
    let k = joints.len();
    if k == 0 {
        return None; // no joints: nothing to box, and an empty matrix has no eigenvalues
    }
    // Powers of two: scaling is exact.
    let root = |&j: &usize| {
        let entry = nearest(&stiffness[j][j]);
        (entry > 0.0 && entry.is_finite()).then(|| 2f64.powi((entry.log2() / 2.0).round() as i32))
    };
    let root: Vec<f64> = joints.iter().map(root).collect::<Option<_>>()?;
    let divided = |ball: Ball, by: f64| Ball { middle: ball.middle / by, radius: ball.radius / by };
    let entry = |i: usize, j: usize| divided(Ball::around(&stiffness[joints[i]][joints[j]]), root[i] * root[j]);
    let balls: Vec<Vec<Ball>> = (0..k).map(|i| (0..k).map(|j| entry(i, j)).collect()).collect();
    let q: Vec<Ball> = (0..k).map(|i| divided(constants[joints[i]], root[i])).collect();
    let r = DMatrix::from_fn(k, k, |i, j| balls[i][j].middle);
    let least = least_eigenvalue(&r)?;
    let largest_z = norm(&q).over(Ball::exactly(least))?;

    let inverse = r.cholesky()?.inverse();
    let z0 = -(&inverse * DVector::from_iterator(k, q.iter().map(|q| q.middle)));
    let z0: Vec<Ball> = z0.iter().map(|z| Ball::exactly(*z)).collect();
    let r_z0: Vec<Ball> = balls.iter().map(|row| dot(row, &z0)).collect();
    let left: Vec<Ball> = q.iter().zip(&r_z0).map(|(q, r_z)| q.plus(*r_z)).collect();
    let quarter = dot(&z0, &r_z0).times(Ball::exactly(0.25));
    let radius = root_above(quarter.plus(norm(&left).times(largest_z)));
    (0..k)
        .map(|j| {
            let column: Vec<Ball> = inverse.column(j).iter().map(|c| Ball::exactly(*c)).collect();
            let r_c: Vec<Ball> = balls.iter().map(|row| dot(row, &column)).collect();
            let missing: Vec<Ball> =
                (0..k).map(|i| Ball::exactly(if i == j { 1.0 } else { 0.0 }).minus(r_c[i])).collect();
            let half = root_above(dot(&column, &r_c)).times(radius).plus(norm(&missing).times(largest_z));
            let middle = dot(&r_c, &z0).times(Ball::exactly(0.5));
            let end = |ball: Ball, sign: f64| outward(ball.middle + sign * ball.radius, sign) / root[j];
            let (low, high) = (end(middle.minus(half), -1.0), end(middle.plus(half), 1.0));
            (low.is_finite() && high.is_finite()).then_some((low, high))
        })
        .collect()
}

/// A number beyond a sum of two.
fn outward(value: f64, sign: f64) -> f64 {
    value + sign * (4.0 * f64::EPSILON * value.abs() + f64::MIN_POSITIVE)
}

fn dot(a: &[Ball], b: &[Ball]) -> Ball {
    a.iter().zip(b).fold(Ball::ZERO, |sum, (a, b)| sum.plus(a.times(*b)))
}

/// At least the Euclidean norm.
fn norm(a: &[Ball]) -> Ball {
    root_above(dot(a, a))
}

/// At least the root of a number ≥ 0.
fn root_above(square: Ball) -> Ball {
    Ball::exactly(outward((square.middle + square.radius).max(0.0).sqrt(), 1.0))
}

/// A number > 0 below every eigenvalue of all symmetric matrices that are rounded to this one.
fn least_eigenvalue(r: &DMatrix<f64>) -> Option<f64> {
    let k = r.nrows();
    let eigen = r.clone().symmetric_eigenvalues();
    if eigen.min() * CONDITION <= eigen.max() {
        return None;
    }
    let least = SAFE * eigen.min();
    // Rump: (k + 1) ε trace / (1 − …); as much again for the rounding of the entries and of the shift, and twice over.
    let rounding = 8.0 * (k as f64 + 2.0) * f64::EPSILON * r.trace();
    let shifted = r - DMatrix::identity(k, k) * (least + rounding);
    shifted.cholesky().map(|_| least)
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::lcp::exact::dyadic::rational;

    /// Points of the ellipsoid as far as it goes: its support points in the directions of the axes, from the exact
    /// inverse of a matrix in whole numbers.
    #[test]
    fn the_box_holds_the_ellipsoid_and_hardly_more() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        for case in 0..40 {
            let k = 1 + case % 6;
            let a = DMatrix::from_fn(k, k, |_, _| f64::from(random.random_range(-3..=3)));
            let r = &a * a.transpose() + DMatrix::identity(k, k);
            let q = DVector::from_fn(k, |_, _| f64::from(random.random_range(-3..=3)));
            let stiffness: Vec<Vec<BigRational>> =
                r.row_iter().map(|row| row.iter().map(|v| rational(*v)).collect()).collect();
            let constants: Vec<Ball> = q.iter().map(|v| Ball::exactly(*v)).collect();
            let joints: Vec<usize> = (0..k).collect();
            let sides = ellipsoid(&stiffness, &constants, &joints).expect("positive definite");
            let inverse = r.clone().try_inverse().expect("regular");
            let z0 = -(&inverse * &q);
            let size = (-z0.dot(&q)).sqrt();
            for (j, (low, high)) in sides.iter().enumerate() {
                let half = 0.5 * inverse[(j, j)].sqrt() * size;
                let (least, most) = (0.5 * z0[j] - half, 0.5 * z0[j] + half);
                let slack = 1e-9 * (1.0 + size);
                assert!(*low <= least + 1e-15 && *high >= most - 1e-15, "case {case}: {low} {least} {most} {high}");
                assert!(least - low <= slack && high - most <= slack, "case {case}: too wide");
            }
        }
        // λ_min is 0.
        let one = rational(1.0);
        let singular = vec![vec![one.clone(), one.clone()], vec![one.clone(), one.clone()]];
        assert_eq!(ellipsoid(&singular, &[Ball::exactly(1.0); 2], &[0, 1]), None);
    }
}
