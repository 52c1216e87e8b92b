//! The point of an answer, refined against the data.
//!
//! The engines work in f64 on an R freed of its kernel; what they find leaves residuals of the size of the condition of
//! the scheme's equations. With the residuals evaluated from the data, in doubled precision, the equations of the same
//! scheme are solved once more for what is missing (iterative refinement): each row then holds to a few ε of its own
//! terms (Skeel 1980).

use nalgebra::DVector;

use super::problem::ContactProblem;
use super::sum::Sum;
use super::sums::{joint_forces, pair_sums};
use super::system::ContactSystem;
use crate::contact::rows::{RowId, RowKind};
use crate::contact::written::ContactLcp;
use crate::doubled::dot;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::corrected;
use crate::lcp::outcome::Point;
use crate::lcp::problem::NOISE;

/// Rounds at most.
const ROUNDS: usize = 4;
/// Residuals up to this share of their terms are as good as z in f64 can make them.
const GOOD: f64 = NOISE / 8.0;

/// The point with the rows of its released joints put right; unchanged where they are right already, or where no step
/// helps.
pub fn refined(problem: &ContactProblem, contact: &ContactLcp, point: Point) -> Point {
    let system = &*problem.system;
    if system.force_form.is_some() {
        return point;
    }
    let mut best = point;
    let mut left = worst(&rows(problem, contact, &best, false), &released(&best));
    for _ in 0..ROUNDS {
        if left <= GOOD {
            break;
        }
        let sums = rows(problem, contact, &best, true);
        let w = equations(problem, contact, &best, &sums);
        let Some(mut next) = corrected(&contact.lcp, &released(&best), &best, &w) else {
            break;
        };
        settle_signs(problem, contact, &mut next);
        let now = worst(&rows(problem, contact, &next, true), &released(&next));
        if now.is_nan() || now >= left {
            break;
        }
        (best, left) = (next, now);
    }
    best
}

/// The basis of the rows whose joint is released at a point.
fn released(point: &Point) -> Basis {
    let rows: Vec<usize> = (0..point.z.len()).filter(|&row| point.z[row] > 0.0).collect();
    Basis { active: rows.clone(), z: rows, p: false }
}

/// An open pair that nothing holds slides either way: z⁺ < 0 is z⁻, and ζ < 0 of any facet is that of its mirror.
/// Elsewhere what is below zero is rounding.
fn settle_signs(problem: &ContactProblem, contact: &ContactLcp, point: &mut Point) {
    for (row, meaning) in contact.rows.iter().enumerate() {
        if point.z[row] >= 0.0 {
            continue;
        }
        let i = meaning.pair;
        let is_open = contact.normal_row[i].is_some_and(|normal| point.z[normal] > 0.0);
        let mirror = |facet: usize| (facet + contact.polygon.half()) % contact.polygon.facets();
        let other = meaning.couple.facet().and_then(|facet| contact.facet_rows[mirror(facet)][i]);
        let moved = std::mem::take(&mut point.z[row]);
        if let Some(other) = other.filter(|_| is_open && problem.laws[i].fixed_bound() == 0.0) {
            point.z[other] -= moved;
        }
    }
}

/// w of every row as the LCP has it, dimensionless: the reserves of an open pair contain f x_n, which the matrix sees.
fn equations(problem: &ContactProblem, contact: &ContactLcp, point: &Point, sums: &[Sum]) -> Vec<f64> {
    let row_of = |(row, sum): (&RowId, &Sum)| {
        let normal = contact.normal_row[row.pair].filter(|&normal| point.z[normal] > 0.0);
        let coupled = match (row.couple, normal) {
            (RowKind::Normal, _) | (_, None) => 0.0,
            (_, Some(normal)) => problem.laws[row.pair].friction() * sums[normal].value,
        };
        (sum.value + coupled) / contact.force_unit
    };
    contact.rows.iter().zip(sums).map(row_of).collect()
}

/// Largest residual of the rows that have to be zero, as a share of their terms.
fn worst(sums: &[Sum], basis: &Basis) -> f64 {
    basis.active.iter().map(|&row| sums[row].share().abs()).fold(0.0, f64::max)
}

/// w of every row in the user's units, `doubled` in twice the precision.
fn rows(problem: &ContactProblem, contact: &ContactLcp, point: &Point, doubled: bool) -> Vec<Sum> {
    let system = &*problem.system;
    let z = contact.joint_displacements(system, &point.z) * contact.length_unit;
    let mut forces = joint_forces(problem, &z);
    let mut unpressed: Vec<bool> = z.iter().take(system.pair_count()).map(|z| *z > 0.0).collect();
    if doubled && system.file.is_none() {
        add_doubled(system, &problem.load, &problem.dislocation(&z), &mut forces);
    }
    // A pressure that is rounding bounds no friction: the slip is then as exact as its own row.
    unpressed.iter_mut().zip(&forces).for_each(|(unpressed, force)| *unpressed |= force.is_zero());
    (contact.rows.iter())
        .map(|row| {
            let sums = pair_sums(problem, &forces, (row.pair, unpressed[row.pair]));
            let sum = match row.couple.facet() {
                None => sums.normal,
                Some(facet) => sums.reserves.get(facet).copied(),
            };
            sum.unwrap_or_default()
        })
        .collect()
}

/// Puts the values of R z + RF, summed in twice the precision, in place of the plain ones.
fn add_doubled(system: &ContactSystem, load: &DVector<f64>, moved: &DVector<f64>, forces: &mut [Sum]) {
    for (i, force) in forces.iter_mut().enumerate() {
        // R is symmetric to the last digit: a column is a row.
        force.value = dot(load[i], system.stiffness.column(i).iter().zip(moved.iter()));
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::contact::full_lcp::tests::{coulomb, plain};
    use crate::contact::lcp::contact_lcp;
    use crate::model::rules::Covering;

    #[test]
    fn an_answer_with_an_error_comes_back_to_the_digits_of_the_data() {
        // Two pairs that open: R_nn z_n = −RF_n, nearly singular. z_n = (1, −1)/δ·… from the closed form of 2 × 2.
        let delta = 2f64.powi(-30);
        let mut r = DMatrix::identity(4, 4);
        (r[(0, 1)], r[(1, 0)]) = (1.0 - delta, 1.0 - delta);
        let system = coulomb(r);
        let problem = plain(&system, 0.3, &[-1.0, -1.0, 0.0, 0.0]);
        let contact = contact_lcp(&problem, Covering::Cohesive).expect("covered");
        // R_nn (1, 1) = 2 − δ: z_n = 1 / (2 − δ) each.
        let exact = 1.0 / (2.0 - delta);
        let mut point = Point { z: vec![0.0; 6], w: vec![0.0; 6], p: 0.0 };
        point.z[0] = (exact + 1e-9) / contact.length_unit;
        point.z[1] = (exact - 2e-9) / contact.length_unit;
        let found = refined(&problem, &contact, point);
        let z = DVector::from_fn(2, |i, _| found.z[i] * contact.length_unit);
        let left = DVector::from_fn(2, |i, _| r_row(delta, i, &z) - 1.0);
        assert!(left.amax() <= 4.0 * f64::EPSILON, "{z} {left}");
    }

    fn r_row(delta: f64, i: usize, z: &DVector<f64>) -> f64 {
        z[i] + z[1 - i] - delta * z[1 - i]
    }
}
