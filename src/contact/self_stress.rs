//! The forces of joints that repeat one another: of all that the laws admit under a given motion, those of least norm.
//!
//! Self-stress S μ moves nothing, so a state determines its forces only up to that. What an answer shows is, cluster by
//! cluster of pairs that self-stress connects,
//!
//! ```text
//!     min ½ |λ|²,   λ = λ₀ + S μ
//!     open:   λ_n = 0                              slipping ±:  λ_τ = ∓ (f λ_n + c)
//!     closed: λ_n ≥ 0                              sticking:    |λ_τ| ≤ f λ_n + c
//! ```
//! a convex quadratic program of a few unknowns. What must hold as equations is taken out by a basis of the rest, and
//! the conditions of Karush, Kuhn and Tucker of what is left are an LCP with a positive semidefinite matrix, which
//! Lemke's algorithm solves.

use nalgebra::{DMatrix, DVector};

use super::problem::ContactProblem;
use super::sum::Sum;
use super::system::ContactSystem;
use crate::lcp::problem::NOISE;
use crate::lcp::solution::solution;

/// Puts the forces of least norm in place of `forces`, with the magnitudes of their terms; z as in the state, exact
/// zeros where nothing moves. Returns the pairs whose forces are not determined by the motion.
pub fn least_norm(problem: &ContactProblem, z: &DVector<f64>, forces: &mut [Sum]) -> Vec<usize> {
    let system = &*problem.system;
    let Some(form) = &system.force_form else {
        return Vec::new();
    };
    let mut free = Vec::new();
    for pairs in clusters(system, &form.self_stress) {
        let cluster = Cluster { problem, z, pairs };
        free.extend(cluster.put_least(&form.self_stress, forces));
    }
    free.sort_unstable();
    free
}

/// Pairs with closed self-stress in a cluster with friction: their bounds change with the normal forces, so that
/// another self-stress than the one found may hold another motion. Without friction the motion does not depend on the
/// self-stress.
pub fn may_hold_otherwise(problem: &ContactProblem, z: &DVector<f64>) -> Vec<usize> {
    let system = &*problem.system;
    if let Some(yielding) = &system.yielding {
        let pairs = yielding.undetermined(problem, z, true);
        let rubs = pairs.iter().any(|&pair| problem.laws[pair].friction() > 0.0);
        return if rubs { pairs } else { Vec::new() };
    }
    let Some(form) = &system.force_form else {
        return Vec::new();
    };
    // Another motion need not slip where this one does.
    let mut sticking = z.clone();
    system.pairs.iter().flat_map(|pair| pair.tangential.clone()).for_each(|joint| sticking[joint] = 0.0);
    let mut pairs: Vec<usize> = (clusters(system, &form.self_stress).into_iter())
        .map(|pairs| Cluster { problem, z: &sticking, pairs })
        .filter(|cluster| cluster.pairs.iter().any(|&pair| problem.laws[pair].friction() > 0.0))
        .flat_map(|cluster| cluster.undetermined(&form.self_stress))
        .collect();
    pairs.sort_unstable();
    pairs
}

fn joints_of(system: &ContactSystem, pair: usize) -> impl Iterator<Item = usize> {
    std::iter::once(pair).chain(system.pairs[pair].plane_tangential())
}

/// Groups of pairs that self-stress connects.
fn clusters(system: &ContactSystem, self_stress: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let m = system.pairs.len();
    let mut group: Vec<usize> = (0..m).collect();
    for stress in self_stress.column_iter() {
        let felt: Vec<usize> = (0..m).filter(|&i| joints_of(system, i).any(|joint| stress[joint] != 0.0)).collect();
        let Some(&first) = felt.first() else { continue };
        let (joined, into): (Vec<usize>, usize) = (felt.iter().map(|&i| group[i]).collect(), group[first]);
        group.iter_mut().filter(|own| joined.contains(own)).for_each(|own| *own = into);
    }
    let mut clusters: Vec<Vec<usize>> = vec![Vec::new(); m];
    (0..m).for_each(|i| clusters[group[i]].push(i));
    clusters.retain(|pairs| {
        pairs.iter().any(|&i| joints_of(system, i).any(|joint| self_stress.row(joint).iter().any(|s| *s != 0.0)))
    });
    clusters
}

/// Pairs that self-stress connects, in a state.
struct Cluster<'a> {
    problem: &'a ContactProblem,
    z: &'a DVector<f64>,
    pairs: Vec<usize>,
}

/// Self-stress of a cluster: joints, all of it and what the laws leave of it by row.
struct Freedom {
    joints: Vec<usize>,
    stress: DMatrix<f64>,
    free: DMatrix<f64>,
}

/// A combination of joint forces, Σ factor·λ + constant.
struct Combination {
    terms: Vec<(usize, f64)>,
    constant: f64,
}

impl Combination {
    fn of(&self, vector: impl Fn(usize) -> f64) -> f64 {
        self.terms.iter().map(|&(joint, factor)| factor * vector(joint)).sum()
    }
}

impl Cluster<'_> {
    /// What must be zero and what must not be negative.
    fn laws(&self) -> (Vec<Combination>, Vec<Combination>) {
        let (mut zero, mut positive) = (Vec::new(), Vec::new());
        for &i in &self.pairs {
            let pair = &self.problem.system.pairs[i];
            let open = !pair.law.is_bilateral() && self.z[i] > 0.0;
            let normal = || Combination { terms: vec![(i, 1.0)], constant: 0.0 };
            if open {
                zero.push(normal());
            } else if !pair.law.is_bilateral() {
                positive.push(normal());
            }
            let Some(joint) = pair.plane_tangential() else { continue };
            let f = if open { 0.0 } else { self.problem.laws[i].friction() };
            let constant = self.problem.laws[i].fixed_bound();
            let reserve = |side: f64| {
                let mut terms = vec![(joint, side)];
                terms.extend((f > 0.0).then_some((i, f)));
                Combination { terms, constant }
            };
            if f == 0.0 && constant == 0.0 {
                zero.push(Combination { terms: vec![(joint, 1.0)], constant: 0.0 });
                continue;
            }
            let slip = self.z[joint];
            match (slip > 0.0, slip < 0.0) {
                (true, _) => zero.push(reserve(1.0)),
                (_, true) => zero.push(reserve(-1.0)),
                _ => positive.extend([reserve(1.0), reserve(-1.0)]),
            }
        }
        (zero, positive)
    }

    /// The self-stress that the combinations which must be zero leave.
    fn freedom(&self, self_stress: &DMatrix<f64>, zero: &[Combination]) -> Option<Freedom> {
        let joints: Vec<usize> = self.pairs.iter().flat_map(|&pair| joints_of(&self.problem.system, pair)).collect();
        let columns: Vec<usize> = (0..self_stress.ncols())
            .filter(|&column| joints.iter().any(|&joint| self_stress[(joint, column)] != 0.0))
            .collect();
        let rows = DMatrix::from_fn(zero.len(), columns.len(), |a, b| zero[a].of(|j| self_stress[(j, columns[b])]));
        let basis = null_basis(&rows, columns.len())?;
        let stress = DMatrix::from_fn(joints.len(), columns.len(), |a, b| self_stress[(joints[a], columns[b])]);
        Some(Freedom { free: &stress * basis, stress, joints })
    }

    /// The pairs whose forces could be others.
    fn moved(&self, Freedom { joints, stress, free }: &Freedom) -> Vec<usize> {
        let place = |joint: usize| joints.iter().position(|own| *own == joint);
        let moved = |&pair: &usize| {
            joints_of(&self.problem.system, pair)
                .filter_map(place)
                .any(|a| free.row(a).amax() > NOISE * stress.row(a).amax())
        };
        self.pairs.iter().copied().filter(moved).collect()
    }

    fn undetermined(&self, self_stress: &DMatrix<f64>) -> Vec<usize> {
        self.freedom(self_stress, &self.laws().0).map_or(Vec::new(), |freedom| self.moved(&freedom))
    }

    /// Puts the forces of least norm in their place; the pairs whose forces could be others.
    fn put_least(&self, self_stress: &DMatrix<f64>, forces: &mut [Sum]) -> Vec<usize> {
        let (zero, positive) = self.laws();
        let Some(freedom) = self.freedom(self_stress, &zero) else {
            return Vec::new();
        };
        let Freedom { joints, free, .. } = &freedom;
        let place = |joint: usize| joints.iter().position(|own| *own == joint);
        let Some(change) = shortest(free, &|joint| forces[joint].value, joints, &positive, &place) else {
            return Vec::new();
        };
        for (a, &joint) in joints.iter().enumerate() {
            let added = Sum { value: change.by[a], magnitude: change.sizes[a] };
            forces[joint] = forces[joint].plus(1.0, added);
        }
        // What a law stops stands exactly at its limit: normal forces first, friction then follows from them.
        let stopped = || zero.iter().chain(change.at_limit.iter().map(|&row| &positive[row]));
        for limit in stopped().filter(|limit| limit.terms.len() == 1 && limit.constant == 0.0) {
            forces[limit.terms[0].0].value = 0.0;
        }
        for limit in stopped().filter(|limit| limit.terms.len() > 1 || limit.constant != 0.0) {
            let ((joint, side), others) = (limit.terms[0], &limit.terms[1..]);
            let bound = others.iter().map(|&(other, f)| f * forces[other].value).sum::<f64>() + limit.constant;
            forces[joint].value = -side * bound;
        }
        self.moved(&freedom)
    }
}

/// Orthonormal basis of what rows take to zero; `None` where that is nothing.
fn null_basis(rows: &DMatrix<f64>, columns: usize) -> Option<DMatrix<f64>> {
    if rows.nrows() == 0 {
        return (columns > 0).then(|| DMatrix::identity(columns, columns));
    }
    // Padded to a square: otherwise the decomposition gives only as many right vectors as there are rows.
    let padded = rows.clone().resize_vertically(rows.nrows().max(columns), 0.0);
    let svd = padded.svd(false, true);
    let v_t = svd.v_t?;
    let least = NOISE * columns as f64 * svd.singular_values.max();
    let free: Vec<DVector<f64>> =
        (0..columns).filter(|&k| svd.singular_values[k] <= least).map(|k| v_t.row(k).transpose()).collect();
    (!free.is_empty()).then(|| DMatrix::from_columns(&free))
}

/// What is added to the forces of the joints.
struct Change {
    by: Vec<f64>,
    /// Magnitudes of its terms.
    sizes: Vec<f64>,
    /// The inequalities that stop it.
    at_limit: Vec<usize>,
}

/// The ν that makes λ₀ + Q ν shortest under g·λ + constant ≥ 0: with ν = P⁻¹ (Qᵀ Gᵀ y − Qᵀ λ₀), P = Qᵀ Q, the slacks
/// and the multipliers y are w and z of an LCP.
fn shortest(
    free: &DMatrix<f64>,
    force: &dyn Fn(usize) -> f64,
    joints: &[usize],
    positive: &[Combination],
    place: &dyn Fn(usize) -> Option<usize>,
) -> Option<Change> {
    let start = DVector::from_iterator(joints.len(), joints.iter().map(|&joint| force(joint)));
    let inverse = (free.transpose() * free).try_inverse()?;
    let rows: Vec<DVector<f64>> = positive
        .iter()
        .map(|row| DVector::from_fn(free.ncols(), |b, _| row.of(|j| place(j).map_or(0.0, |a| free[(a, b)]))))
        .collect();
    let shortest = -(&inverse * (free.transpose() * &start));
    let solve = |multipliers: &[(usize, f64)]| {
        let pull = multipliers.iter().fold(DVector::zeros(free.ncols()), |sum, (row, y)| sum + &rows[*row] * *y);
        &shortest + &inverse * pull
    };
    let slack = |row: usize, nu: &DVector<f64>| positive[row].of(force) + positive[row].constant + rows[row].dot(nu);
    let n = positive.len();
    let size = (0..n).map(|row| slack(row, &shortest).abs()).fold(0.0, f64::max);
    let mut multipliers: Vec<(usize, f64)> = Vec::new();
    if size > 0.0 && (0..n).any(|row| slack(row, &shortest) < -NOISE * size) {
        let weighed: Vec<DVector<f64>> = rows.iter().map(|row| &inverse * row).collect();
        let matrix: Vec<Vec<f64>> =
            rows.iter().map(|row| weighed.iter().map(|other| row.dot(other)).collect()).collect();
        let q: Vec<f64> = (0..n).map(|row| slack(row, &shortest) / size).collect();
        let z = solution(matrix, q)?;
        multipliers = z.iter().enumerate().filter(|(_, y)| **y > 0.0).map(|(row, y)| (row, y * size)).collect();
    }
    let nu = solve(&multipliers);
    let terms = |a: usize| free.row(a).iter().zip(nu.iter()).map(|(q, nu)| q * nu).collect::<Vec<f64>>();
    Some(Change {
        by: (0..joints.len()).map(|a| terms(a).iter().sum()).collect(),
        sizes: (0..joints.len()).map(|a| terms(a).iter().map(|term| term.abs()).sum()).collect(),
        at_limit: multipliers.into_iter().map(|(row, _)| row).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::full_lcp::tests::{coulomb, plain};
    use crate::contact::system::ForceForm;

    /// Two opposed pairs at one node: their normals and their tangents are opposed.
    fn guide() -> ContactSystem {
        let mut system = coulomb(DMatrix::zeros(4, 4));
        let self_stress = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0]);
        system.force_form = Some(ForceForm { joints: vec![false, true, false, true], self_stress });
        system
    }

    fn settled(f: f64, z: [f64; 4], forces: [f64; 4]) -> ([f64; 4], Vec<usize>) {
        let mut sums = forces.map(Sum::exactly);
        let free = least_norm(&plain(&guide(), f, &[0.0; 4]), &DVector::from_row_slice(&z), &mut sums);
        (sums.map(|sum| sum.value), free)
    }

    #[test]
    fn a_guide_is_pressed_on_one_side_only() {
        // x_1 − x_2 = 3 and x_τ1 − x_τ2 = 1: without inequalities (1.5, −1.5); x_2 ≥ 0 makes it (3, 0), and with that
        // x_τ2 = 0.
        assert_eq!(settled(0.5, [0.0; 4], [5.0, 2.0, 1.5, 0.5]), ([3.0, 0.0, 1.0, 0.0], vec![0, 1]));
    }

    #[test]
    fn a_guide_that_must_hold_more_is_wedged_no_more_than_that() {
        // f = 1/2, x_1 − x_2 = 2, x_τ1 − x_τ2 = 4 = T: |x_τ1| + |x_τ2| ≤ f (x_1 + x_2) wants x_1 + x_2 ≥ 8: (5, 3), and
        // x_τ = (5/2, −3/2).
        let (forces, free) = settled(0.5, [0.0; 4], [12.0, 10.0, 4.0, 0.0]);
        for (found, expected) in forces.iter().zip([5.0, 3.0, 2.5, -1.5]) {
            assert!((found - expected).abs() < 1e-14, "{forces:?}");
        }
        assert_eq!(free, [0, 1]);
    }

    #[test]
    fn an_open_side_leaves_nothing_to_choose() {
        let forces = [3.0, 0.0, 1.0, 0.0];
        assert_eq!(settled(0.5, [0.0, 0.1, 0.0, 0.0], forces), (forces, vec![]));
    }

    #[test]
    fn what_slips_stays_at_its_bound() {
        // x_τ1 = −x_1/2, x_τ2 = x_2/2 (they slip against each other's sense): x_τ1 − x_τ2 = −(x_1 + x_2)/2 fixes the
        // sum.
        let forces = [5.0, 2.0, -2.5, 1.0];
        assert_eq!(settled(0.5, [0.0, 0.0, 1.0, -1.0], forces), (forces, vec![]));
    }
}
