//! Linear programs, solved by the interior-point crate Clarabel and, where its accuracy does not suffice, refined.
//!
//! What comes back is a proposal in f64, never a proof: whoever claims something on it verifies it from the data.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Feasibility and gap of a solution, relative.
const TOLERANCE: f64 = 1e-9;
/// A refinement looks this far around the point that it refines, in the magnified unknowns.
const RANGE: f64 = 1e3;

/// A row Σ coefficient · x against its bound.
#[derive(Clone, Debug)]
struct Row {
    terms: Vec<(usize, f64)>,
    bound: f64,
}

impl Row {
    fn value(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|(k, a)| a * x[*k]).sum()
    }
}

/// min cost·x over rows `a·x ≤ b` and `a·x = b`, x free.
#[derive(Clone, Debug, Default)]
pub struct LinearProgram {
    cost: Vec<f64>,
    at_most: Vec<Row>,
    equal: Vec<Row>,
}

/// A point with the multipliers of the rows: cost + Σ multiplier · row = 0 at an optimum.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// x.
    pub x: Vec<f64>,
    /// Of the rows `≤`, in the order added, ≥ 0.
    pub at_most: Vec<f64>,
    /// Of the rows `=`, in the order added.
    pub equal: Vec<f64>,
}

/// How a program ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Optimal within the tolerance.
    Optimum(Point),
    /// No x: Σ multiplier · row = 0 with Σ multiplier · bound < 0 (`x` is empty).
    Infeasible(Point),
    /// x can go on along this direction for ever at falling cost (no multipliers).
    Unbounded(Vec<f64>),
    /// The time was up.
    OutOfTime,
    /// The numbers did not allow for a decision.
    Undecided,
}

impl LinearProgram {
    /// A variable with its cost; returns its index.
    pub fn variable(&mut self, cost: f64) -> usize {
        self.cost.push(cost);
        self.cost.len() - 1
    }

    /// Sets the costs anew; all others are 0.
    pub fn set_costs(&mut self, costs: impl IntoIterator<Item = (usize, f64)>) {
        self.cost.fill(0.0);
        for (variable, cost) in costs {
            self.cost[variable] = cost;
        }
    }

    /// Σ terms ≤ bound.
    pub fn at_most(&mut self, terms: Vec<(usize, f64)>, bound: f64) {
        self.at_most.push(Row { terms, bound });
    }

    /// Σ terms = bound.
    pub fn equal(&mut self, terms: Vec<(usize, f64)>, bound: f64) {
        self.equal.push(Row { terms, bound });
    }

    /// Solves it within so many seconds.
    pub fn solve(&self, seconds: f64) -> Outcome {
        let (n, equal) = (self.cost.len(), self.equal.len());
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut bounds = Vec::with_capacity(equal + self.at_most.len());
        for (i, row) in self.equal.iter().chain(&self.at_most).enumerate() {
            for &(k, a) in &row.terms {
                rows.push(i);
                columns.push(k);
                values.push(a);
            }
            bounds.push(row.bound);
        }
        if !(values.iter().chain(&bounds).chain(&self.cost)).all(|value| value.is_finite()) {
            return Outcome::Undecided;
        }
        let a = CscMatrix::new_from_triplets(bounds.len(), n, rows, columns, values);
        let cones = [SupportedConeT::ZeroConeT(equal), SupportedConeT::NonnegativeConeT(self.at_most.len())];
        let settings = DefaultSettings {
            verbose: false,
            time_limit: seconds,
            tol_gap_abs: TOLERANCE,
            tol_gap_rel: TOLERANCE,
            tol_feas: TOLERANCE,
            max_threads: 1,
            ..DefaultSettings::default()
        };
        let Ok(mut solver) = DefaultSolver::new(&CscMatrix::zeros((n, n)), &self.cost, &a, &bounds, &cones, settings)
        else {
            return Outcome::Undecided;
        };
        solver.solve();
        let found = &solver.solution;
        let point =
            |x: &[f64]| Point { x: x.to_vec(), at_most: found.z[equal..].to_vec(), equal: found.z[..equal].to_vec() };
        match found.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Outcome::Optimum(point(&found.x)),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Outcome::Infeasible(point(&[])),
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Outcome::Unbounded(found.x.clone()),
            SolverStatus::MaxTime => Outcome::OutOfTime,
            _ => Outcome::Undecided,
        }
    }

    /// The optimum near `x`, which misses it by about 1/`zoom`: the same program in the magnified difference, so that
    /// the tolerance of the crate counts 1/`zoom` (iterative refinement of linear programs, Gleixner et al. 2016).
    /// `None` where that gives no point.
    pub fn refined(&self, x: &[f64], zoom: f64, seconds: f64) -> Option<Vec<f64>> {
        let mut near = LinearProgram { cost: self.cost.clone(), ..LinearProgram::default() };
        let rest = |row: &Row| (row.bound - row.value(x)) * zoom;
        for row in &self.equal {
            near.equal(row.terms.clone(), rest(row));
        }
        for row in &self.at_most {
            let bound = rest(row);
            // Beyond what the difference can reach a row binds nothing.
            let reach: f64 = row.terms.iter().map(|(_, a)| a.abs() * RANGE).sum();
            if bound < reach {
                near.at_most(row.terms.clone(), bound);
            }
        }
        for k in 0..self.cost.len() {
            near.at_most(vec![(k, 1.0)], RANGE);
            near.at_most(vec![(k, -1.0)], RANGE);
        }
        match near.solve(seconds) {
            Outcome::Optimum(found) => Some(x.iter().zip(found.x).map(|(x, d)| x + d / zoom).collect()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// max 3a + 5b, a ≤ 4, 2b ≤ 12, 3a + 2b ≤ 18, a, b ≥ 0: (2, 6) with multipliers 0, 3/2, 1 (Hillier & Lieberman).
    fn wyndor() -> LinearProgram {
        let mut program = LinearProgram::default();
        let (a, b) = (program.variable(-3.0), program.variable(-5.0));
        program.at_most(vec![(a, 1.0)], 4.0);
        program.at_most(vec![(b, 2.0)], 12.0);
        program.at_most(vec![(a, 3.0), (b, 2.0)], 18.0);
        program.at_most(vec![(a, -1.0)], 0.0);
        program.at_most(vec![(b, -1.0)], 0.0);
        program
    }

    #[test]
    fn optimum_with_its_multipliers() {
        let Outcome::Optimum(found) = wyndor().solve(10.0) else { panic!() };
        for (found, expected) in found.x.iter().chain(&found.at_most).zip([2.0, 6.0, 0.0, 1.5, 1.0, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
        }
    }

    #[test]
    fn no_point_and_no_end_are_told_apart_with_their_proofs() {
        // x ≤ −1 and x ≥ 1.
        let mut none = LinearProgram::default();
        let x = none.variable(0.0);
        none.at_most(vec![(x, 1.0)], -1.0);
        none.at_most(vec![(x, -1.0)], -1.0);
        let Outcome::Infeasible(proof) = none.solve(10.0) else { panic!() };
        assert!((proof.at_most[0] - proof.at_most[1]).abs() < 1e-6 * proof.at_most[0]);
        // min −x − y, x − y = 0: along (1, 1).
        let mut endless = LinearProgram::default();
        let (x, y) = (endless.variable(-1.0), endless.variable(-1.0));
        endless.equal(vec![(x, 1.0), (y, -1.0)], 0.0);
        let Outcome::Unbounded(direction) = endless.solve(10.0) else { panic!() };
        assert!(direction[0] > 0.0 && (direction[0] - direction[1]).abs() < 1e-6 * direction[0]);
    }

    #[test]
    fn numbers_that_are_none_are_undecided_and_no_time_is_out_of_time() {
        let mut program = wyndor();
        program.at_most(vec![(0, f64::NAN)], 1.0);
        assert_eq!(program.solve(10.0), Outcome::Undecided);
        assert_eq!(wyndor().solve(0.0), Outcome::OutOfTime);
    }

    #[test]
    fn refinement_reaches_the_last_digits() {
        // max t ≤ 1/3 · 1e-9 in company of entries of size 1: the first answer cannot know t.
        let mut program = LinearProgram::default();
        let (t, x) = (program.variable(-1.0), program.variable(0.0));
        program.at_most(vec![(t, 3.0), (x, -1.0)], -1.0 + 1e-9);
        program.at_most(vec![(x, 1.0)], 1.0);
        program.at_most(vec![(x, -1.0)], 1.0);
        let Outcome::Optimum(rough) = program.solve(10.0) else { panic!() };
        let fine = program.refined(&rough.x, 1e6, 10.0).expect("a point");
        let expected = (1.0 + (-1.0 + 1e-9)) / 3.0;
        assert!((fine[t] - expected).abs() < 1e-14, "{} for {expected}", fine[t]);
    }
}
