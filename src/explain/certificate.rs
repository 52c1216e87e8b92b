//! The equilibrium LP: are there contact forces within the laws' bounds that balance the loads on every motion that
//! costs nothing? If not, a motion proves it.
//!
//! ```text
//!   find λ:  x_n ≥ 0,  |x_τ| ≤ f x_n + c,   Zᵀ λ = Zᵀ RF           (bound pairs: |x_τ| ≤ r_f, x_n free)
//!   none  ⇔  a motion ζ = Z y with  ζ_n ≥ f |ζ_τ|  in every pair and  RF·ζ + Σ c |ζ_τ| < 0
//! ```
//! The second line is the Farkas alternative: on ζ every admissible λ does at least the work −Σ c |ζ_τ|, and the loads
//! do more. The LP crate only *proposes* ζ, by f64 and with tolerances; what it proposes is then verified in exact
//! rational arithmetic, with a margin for the rounding of RF. No verified motion, no certificate.

use microlp::{ComparisonOp, OptimizationDirection, Problem, SolveOptions, SolveOutcome, Variable};
use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::kernel::{clean, releasable_kernel};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::lcp::problem::NOISE;
use crate::model::pair::Law;

/// The power of the loads has to exceed this multiple of the terms that it sums.
const MARGIN: f64 = NOISE;

/// Solves with the tightest tolerance that still allows for the rounding of the data.
fn run(problem: &Problem) -> Result<SolveOutcome, microlp::Error> {
    let mut options = SolveOptions::default();
    options.tolerances.feasibility = 1e-9;
    problem.solve_with(options)
}

/// A motion that proves that no contact forces within the laws' bounds balance the loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// ζ over the joints, largest entry 1. It may part pairs that slip: ζ_n ≥ f |ζ_τ|.
    pub direction: DVector<f64>,
    /// Power −RF·ζ of the loads on it, > `dissipation`.
    pub power: f64,
    /// Σ c |ζ_τ| + Σ r_f |ζ_τ|: the most that cohesion and known bounds can take.
    pub dissipation: f64,
}

/// What a pair allows of the forces in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Bounds {
    /// x_n ≥ 0, |x_τ| ≤ f x_n + c.
    Cone(f64, f64),
    /// x_n ≥ 0, x_τ = 0.
    Normal,
    /// x_n free, |x_τ| ≤ r.
    Band(f64),
}

pub(super) fn bounds(system: &ContactSystem, numbers: &ContactNumbers) -> Vec<Bounds> {
    system
        .pairs
        .iter()
        .enumerate()
        .map(|(i, pair)| match pair.law {
            Law::Coulomb { .. } => Bounds::Cone(numbers.friction[i], numbers.cohesion[i]),
            Law::Frictionless { .. } => Bounds::Normal,
            Law::Bound { .. } => Bounds::Band(numbers.bound[i]),
        })
        .collect()
}

/// The rows of Z at the pairs.
struct Motions<'a> {
    system: &'a ContactSystem,
    /// Motions that no bound pair's normal joint holds, noise removed.
    z: DMatrix<f64>,
    bounds: Vec<Bounds>,
    load: &'a DVector<f64>,
}

/// Looks for a certificate; `hint` is a motion near which it may lie (the direction of a ray).
pub fn certify(system: &ContactSystem, numbers: &ContactNumbers, hint: Option<&DVector<f64>>) -> Option<Certificate> {
    let motions =
        Motions { system, z: clean(&releasable_kernel(system)), bounds: bounds(system, numbers), load: &numbers.load };
    if motions.z.ncols() == 0 || motions.load.amax() == 0.0 {
        return None;
    }
    let inward = motions.inward();
    // The plain hint first: a lift-off or overturning mode is its own proof.
    let plain = hint.map(|hint| motions.z.transpose() * hint);
    let near = hint.and_then(|hint| motions.least_power(Some(hint)));
    [plain, near].into_iter().flatten().find_map(|y| motions.verify(&y, inward.as_ref())).or_else(|| {
        let y = motions.least_power(None)?;
        motions.verify(&y, inward.as_ref())
    })
}

impl Motions<'_> {
    fn row(&self, joint: usize) -> Vec<f64> {
        self.z.row(joint).iter().copied().collect()
    }

    /// Adds y and the constraints ζ_n − f |ζ_τ| ≥ s (s = 0 without `slack`); returns y and the cost of |ζ_τ| is put on t.
    fn problem(
        &self,
        direction: OptimizationDirection,
        power: bool,
        limit: f64,
        slack: bool,
    ) -> (Problem, Vec<Variable>) {
        let size = self.load.amax();
        let mut problem = Problem::new(direction);
        let cost = self.z.transpose() * self.load / size;
        let y: Vec<Variable> =
            (0..self.z.ncols()).map(|k| problem.add_var(if power { cost[k] } else { 0.0 }, (-limit, limit))).collect();
        let s = slack.then(|| problem.add_var(1.0, (0.0, 1.0)));
        for (i, bounds) in self.bounds.iter().enumerate() {
            let normal = self.row(i);
            let tangential = self.system.pairs[i].tangential.map(|joint| self.row(joint));
            let moves = |row: &[f64]| row.iter().any(|v| *v != 0.0);
            if !moves(&normal) && !tangential.as_deref().is_some_and(moves) {
                continue;
            }
            let terms = |row: &[f64], sign: f64| -> Vec<(Variable, f64)> {
                y.iter().zip(row).filter(|(_, v)| **v != 0.0).map(|(y, v)| (*y, sign * v)).collect()
            };
            let (f, c, unilateral) = match *bounds {
                Bounds::Cone(f, c) => (f, c, true),
                Bounds::Normal => (0.0, 0.0, true),
                Bounds::Band(r) => (0.0, r, false),
            };
            let mut cone = terms(&normal, 1.0);
            if let Some(tangential) = tangential.filter(|_| f > 0.0 || c > 0.0) {
                let t = problem.add_var(if power { c / size } else { 0.0 }, (0.0, f64::INFINITY));
                for sign in [1.0, -1.0] {
                    let mut terms = terms(&tangential, sign);
                    terms.push((t, -1.0));
                    problem.add_constraint(terms.as_slice(), ComparisonOp::Le, 0.0);
                }
                if f > 0.0 {
                    cone.push((t, -f));
                }
            }
            if unilateral && !cone.is_empty() {
                if let Some(s) = s {
                    cone.push((s, -1.0));
                }
                problem.add_constraint(cone.as_slice(), ComparisonOp::Ge, 0.0);
            }
        }
        (problem, y)
    }

    fn solve(problem: &Problem, y: &[Variable]) -> Option<DVector<f64>> {
        match run(problem) {
            Ok(SolveOutcome::Solution(solution)) => {
                Some(DVector::from_iterator(y.len(), y.iter().map(|y| solution.var_value(*y))))
            }
            // Infeasible, interrupted or a numerical failure: nothing is proposed.
            _ => None,
        }
    }

    /// The admissible motion on which the loads do most work: in a box, or among those that have as much of the hint
    /// as the hint itself (a slice does not have the optimum y = 0 that hides a very small power).
    fn least_power(&self, hint: Option<&DVector<f64>>) -> Option<DVector<f64>> {
        let limit = if hint.is_some() { 1e3 } else { 1.0 };
        let (mut problem, y) = self.problem(OptimizationDirection::Minimize, true, limit, false);
        if let Some(hint) = hint {
            let along = self.z.transpose() * hint;
            if along.amax() == 0.0 {
                return None;
            }
            let terms: Vec<(Variable, f64)> = y.iter().copied().zip(along.iter().copied()).collect();
            problem.add_constraint(terms.as_slice(), ComparisonOp::Eq, along.norm_squared());
        }
        Self::solve(&problem, &y)
    }

    /// A motion with ζ_n > f |ζ_τ| in every pair that moves at all, if there is one.
    fn inward(&self) -> Option<DVector<f64>> {
        let (problem, y) = self.problem(OptimizationDirection::Maximize, false, 1.0, true);
        Self::solve(&problem, &y)
    }

    /// Smallest ζ_n − f |ζ_τ| of the pairs that move.
    fn least_slack(&self, y: &DVector<f64>) -> f64 {
        let zeta = &self.z * y;
        let mut least = f64::INFINITY;
        for (i, bounds) in self.bounds.iter().enumerate() {
            let tangential = self.system.pairs[i].tangential;
            let rows = [Some(i), tangential];
            if rows.into_iter().flatten().all(|joint| self.z.row(joint).amax() == 0.0) {
                continue;
            }
            let slip = tangential.map_or(0.0, |joint| zeta[joint].abs());
            match *bounds {
                Bounds::Cone(f, _) => least = least.min(zeta[i] - f * slip),
                Bounds::Normal => least = least.min(zeta[i]),
                Bounds::Band(_) => {}
            }
        }
        least
    }

    /// The certificate if y, or y moved inward by as much as it lacks, is one in exact arithmetic.
    fn verify(&self, y: &DVector<f64>, inward: Option<&DVector<f64>>) -> Option<Certificate> {
        let size = (&self.z * y).amax();
        if size == 0.0 || !size.is_finite() {
            return None;
        }
        let y = y / size;
        if let Some(found) = self.exactly(&y) {
            return Some(found);
        }
        let inward = inward?;
        let room = self.least_slack(inward);
        if room <= 0.0 {
            return None;
        }
        let lacks = (-self.least_slack(&y)).max(0.0) + 16.0 * f64::EPSILON;
        self.exactly(&(&y + inward * (2.0 * lacks / room)))
    }

    fn exactly(&self, y: &DVector<f64>) -> Option<Certificate> {
        let exact = |value: f64| BigRational::from_float(value);
        let y_exact: Vec<BigRational> = y.iter().map(|v| exact(*v)).collect::<Option<_>>()?;
        let zeta = |joint: usize| -> Option<BigRational> {
            let mut sum = BigRational::zero();
            for (k, y) in y_exact.iter().enumerate() {
                let entry = self.z[(joint, k)];
                if entry != 0.0 {
                    sum += exact(entry)? * y;
                }
            }
            Some(sum)
        };
        // −(RF·ζ + Σ c |ζ_τ|), and the sum of the sizes of its terms.
        let mut surplus = BigRational::zero();
        let f64_zeta = &self.z * y;
        let (power, mut terms) = self
            .load
            .iter()
            .zip(f64_zeta.iter())
            .fold((0.0, 0.0), |(power, terms), (load, zeta)| (power - load * zeta, terms + (load * zeta).abs()));
        let mut dissipation = 0.0;
        let mut add = |joint: usize, zeta: &BigRational| -> Option<()> {
            surplus -= exact(self.load[joint])? * zeta;
            Some(())
        };
        let mut taken = BigRational::zero();
        for (i, bounds) in self.bounds.iter().enumerate() {
            let normal = zeta(i)?;
            add(i, &normal)?;
            let slip = match self.system.pairs[i].tangential {
                Some(joint) => {
                    let slip = zeta(joint)?;
                    add(joint, &slip)?;
                    slip.abs()
                }
                None => BigRational::zero(),
            };
            let (f, c) = match *bounds {
                Bounds::Cone(f, c) => (f, c),
                Bounds::Normal => (0.0, 0.0),
                Bounds::Band(r) => {
                    if !normal.is_zero() {
                        return None;
                    }
                    (0.0, r)
                }
            };
            if normal < exact(f)? * &slip {
                return None;
            }
            if c > 0.0
                && let Some(joint) = self.system.pairs[i].tangential
            {
                taken += exact(c)? * slip;
                let work = c * f64_zeta[joint].abs();
                dissipation += work;
                terms += work;
            }
        }
        if surplus - taken <= exact(MARGIN * terms)? {
            return None;
        }
        let largest = f64_zeta.amax();
        Some(Certificate { direction: f64_zeta / largest, power: power / largest, dissipation: dissipation / largest })
    }
}

/// Interval of multipliers α for which the LP finds admissible forces under `fixed` + α·`varied`; `None` if it finds
/// none for any α. Ends beyond 1e6 are infinite. By the LP alone, in f64: necessary for an answer, not sufficient.
pub fn balanced_multipliers(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    fixed: &DVector<f64>,
    varied: &DVector<f64>,
) -> Option<[f64; 2]> {
    const FAR: f64 = 1e6;
    let z = clean(&releasable_kernel(system));
    let size = fixed.amax().max(varied.amax());
    if z.ncols() == 0 || size == 0.0 {
        return None;
    }
    let end = |direction: OptimizationDirection| {
        let mut problem = Problem::new(direction);
        let alpha = problem.add_var(1.0, (-FAR, FAR));
        let mut balance: Vec<Vec<(Variable, f64)>> = vec![Vec::new(); z.ncols()];
        let mut put = |variable: Variable, joint: usize| {
            for (k, row) in balance.iter_mut().enumerate() {
                if z[(joint, k)] != 0.0 {
                    row.push((variable, z[(joint, k)]));
                }
            }
        };
        for (i, bounds) in bounds(system, numbers).into_iter().enumerate() {
            let lowest = if matches!(bounds, Bounds::Band(_)) { f64::NEG_INFINITY } else { 0.0 };
            let normal = problem.add_var(0.0, (lowest, f64::INFINITY));
            put(normal, i);
            let Some(joint) = system.pairs[i].tangential else {
                continue;
            };
            let (f, c) = match bounds {
                Bounds::Cone(f, c) => (f, c / size),
                Bounds::Normal => continue,
                Bounds::Band(r) => (0.0, r / size),
            };
            let slip = if f > 0.0 {
                problem.add_var(0.0, (f64::NEG_INFINITY, f64::INFINITY))
            } else {
                problem.add_var(0.0, (-c, c))
            };
            put(slip, joint);
            if f > 0.0 {
                for sign in [1.0, -1.0] {
                    problem.add_constraint([(slip, sign), (normal, -f)], ComparisonOp::Le, c);
                }
            }
        }
        let (right, left) = (z.transpose() * fixed / size, z.transpose() * varied / size);
        for (k, mut row) in balance.into_iter().enumerate() {
            if left[k] != 0.0 {
                row.push((alpha, -left[k]));
            }
            problem.add_constraint(row.as_slice(), ComparisonOp::Eq, right[k]);
        }
        match run(&problem) {
            Ok(SolveOutcome::Solution(solution)) => Some(solution.var_value(alpha)),
            _ => None,
        }
    };
    let low = end(OptimizationDirection::Minimize)?;
    let high = end(OptimizationDirection::Maximize)?;
    let far = |value: f64| {
        if value.abs() >= 0.999 * FAR { value.signum() * f64::INFINITY } else { value }
    };
    Some([far(low), far(high)])
}
