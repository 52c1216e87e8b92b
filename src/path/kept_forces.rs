//! Forces that self-stress leaves free, on the way of a history: they stay what they were as far as they can.

use nalgebra::{DMatrix, DVector};

use crate::contact::pivoted::orthonormal;
use crate::contact::problem::ContactProblem;
use crate::contact::sums::joint_forces;
use crate::contact::yielding::FELT;
use stickslip_numerics::least_norm::least_norm;

/// Friction is at its bound where its reserve is this share of it.
const AT_BOUND: f64 = 1e-6;
/// Friction farther beyond its bound than this share of it is brought back …
const BEYOND: f64 = 1e-12;
/// … to this share of it within: what sticks there is told from what slips.
const WITHIN: f64 = 1e-9;
/// Projections to and fro. Where the motion is free of slip they gain a digit in a few.
const PROJECTIONS: usize = 200;

/// λ over the joints of a problem in force form at displacements z: of all that differ by self-stress those that change
/// least from `force`. Friction at its bound turns only with a slip, and what is open carries nothing: these forces change
/// only as much as no self-stress can spare them.
pub(super) fn kept_forces(exact: &ContactProblem, z: &DVector<f64>, force: &DVector<f64>) -> DVector<f64> {
    let system = &*exact.system;
    let Some(form) = &system.force_form else { return force.clone() };
    let unknowns = DVector::from_fn(z.len(), |joint, _| if system.is_forced(joint) { force[joint] } else { z[joint] });
    let mut now = force.clone();
    for (joint, response) in joint_forces(exact, &unknowns).into_iter().enumerate() {
        if !system.is_forced(joint) {
            now[joint] = response.value;
        }
    }
    let mut is_kept = vec![false; z.len()];
    for (i, (pair, law)) in system.pairs.iter().zip(&exact.laws).enumerate() {
        is_kept[i] = z[i] > 0.0;
        let pressed = if is_kept[i] { 0.0 } else { force[i].max(0.0) };
        let bound = law.bound(pressed);
        let [along, across] = pair.slip(force);
        let is_at_bound = bound - along.hypot(across) <= AT_BOUND * bound;
        pair.tangential.clone().for_each(|joint| is_kept[joint] = is_at_bound);
    }
    let (kept, others): (Vec<usize>, Vec<usize>) = (0..z.len()).partition(|joint| is_kept[*joint]);
    let change = force - &now;
    let Some(amount) = nearest(&form.self_stress, &change, [&kept, &others]) else { return now };
    let near = now + &form.self_stress * amount;
    within_laws(exact, z, &near).unwrap_or(near)
}

/// Forces that differ from these by self-stress and obey the laws of what does not move: friction that has to turn at its bound
/// without a slip. By projections to and fro (von Neumann); `None` where they do not get there, as where a pair has to slip.
fn within_laws(exact: &ContactProblem, z: &DVector<f64>, near: &DVector<f64>) -> Option<DVector<f64>> {
    let system = &*exact.system;
    let form = system.force_form.as_ref()?;
    let mut basis = None;
    let mut forces = near.clone();
    for _ in 0..PROJECTIONS {
        let mut obeying = forces.clone();
        for (i, (pair, law)) in system.pairs.iter().zip(&exact.laws).enumerate() {
            if z[i] > 0.0 {
                obeying[i] = 0.0;
            } else if !pair.law.is_bilateral() {
                obeying[i] = forces[i].max(0.0);
            }
            let bound = law.bound(obeying[i].max(0.0));
            let [along, across] = pair.slip(&forces);
            let size = along.hypot(across);
            if size > (1.0 + BEYOND) * bound {
                let share = (1.0 - WITHIN) * bound / size;
                pair.tangential.clone().for_each(|joint| obeying[joint] = share * forces[joint]);
            }
        }
        let off = obeying - &forces;
        if off.amax() <= BEYOND * forces.amax() {
            return Some(forces);
        }
        let basis = basis.get_or_insert_with(|| {
            let columns: Vec<DVector<f64>> = form.self_stress.column_iter().map(|column| column.into_owned()).collect();
            orthonormal(&columns, near.len())
        });
        forces += &*basis * basis.tr_mul(&off);
    }
    None
}

/// Multiples of the columns of S that bring the rows `first` of S a as near to those of `wanted` as can be, and of all that
/// do the rows `then`. `None` where something is not finite.
fn nearest(s: &DMatrix<f64>, wanted: &DVector<f64>, [first, then]: [&[usize]; 2]) -> Option<DVector<f64>> {
    let of = |rows: &[usize]| (s.select_rows(rows), wanted.select_rows(rows));
    let (matrix, right) = of(first);
    let felt = FELT * s.amax();
    let rows: Vec<DVector<f64>> =
        matrix.row_iter().map(|row| row.transpose()).filter(|row| row.norm() > felt).collect();
    let spent = orthonormal(&rows, s.ncols());
    let amount = &spent * least_norm(&(&matrix * &spent), &right)?;
    let left = DMatrix::identity(s.ncols(), s.ncols()) - &spent * spent.transpose();
    let (matrix, right) = of(then);
    let more = least_norm(&(&matrix * &left), &(right - &matrix * &amount))?;
    Some(amount + left * more)
}
