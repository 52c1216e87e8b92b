//! Linear programs, some of whose rows may bound the length of others (second-order cones), solved by the
//! interior-point crate Clarabel and, where its accuracy does not suffice, refined.
//!
//! What comes back is a proposal in f64, never a proof: whoever bases a claim on it verifies it from the data.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Feasibility and gap of a solution, relative.
pub const TOLERANCE: f64 = 1e-9;
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

    /// bound − Σ coefficient · x.
    fn rest(&self, x: &[f64]) -> f64 {
        self.bound - self.value(x)
    }
}

/// The rows of a cone with other bounds.
fn moved(cone: &[Row], bounds: &[f64]) -> Vec<Row> {
    cone.iter().zip(bounds).map(|(row, bound)| Row { terms: row.terms.clone(), bound: *bound }).collect()
}

/// A cone around a point far from its apex, `rests` there and the `length` of all but the first of them. The first
/// row t against the vector v, of which u lies along its `rests` and w across:
///
/// ```text
///   t ≥ |v|   ⇔   (t − u)(t + u) ≥ |w|²,   t + u ≥ 0
/// ```
/// t − u is small and t + u nearly 2 `length`: over the root of that and times it both are of one size, so that the
/// tolerance of the crate counts by what is left of the cone, not by how far it is from its apex.
fn from_its_side(cone: &[Row], rests: &[f64], length: f64) -> Vec<Row> {
    let share: Vec<f64> = rests[1..].iter().map(|rest| rest / length).collect();
    // Σ factor · row; its bound is given, where terms of it cancel.
    let sum = |factors: &[f64], bound: f64| {
        let rows = cone.iter().zip(factors).filter(|(_, factor)| **factor != 0.0);
        Row { terms: rows.flat_map(|(row, f)| row.terms.iter().map(move |(k, a)| (*k, f * a))).collect(), bound }
    };
    let root = (2.0 * length).sqrt();
    let (small, large) = (0.5 * root * (rests[0] - length), 0.5 * (rests[0] + length) / root);
    let of = |sign: f64| -> Vec<f64> {
        let [own, along] = [1.0, -1.0].map(|side| 0.5 * (root + sign * side / root));
        std::iter::once(own).chain(share.iter().map(|share| -along * share)).collect()
    };
    let mut rows = vec![sum(&of(1.0), small + large), sum(&of(-1.0), small - large)];
    for part in 0..share.len() {
        let mut factors: Vec<f64> = share.iter().map(|other| -other * share[part]).collect();
        factors[part] += 1.0;
        factors.insert(0, 0.0);
        rows.push(sum(&factors, 0.0));
    }
    rows
}

/// min cost·x over rows `a·x ≤ b` and `a·x = b`, and cones, x free.
#[derive(Clone, Debug, Default)]
pub struct LinearProgram {
    cost: Vec<f64>,
    at_most: Vec<Row>,
    equal: Vec<Row>,
    /// b − a·x of the first row is at least the length of the vector that the others make.
    cones: Vec<Vec<Row>>,
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

    /// Σ `most` ≥ the length of the vector of the Σ `parts`: two rows where that is one part, one where it is none.
    pub fn at_least_length(&mut self, most: &[(usize, f64)], parts: &[Vec<(usize, f64)>]) {
        let negative = |terms: &[(usize, f64)]| -> Vec<(usize, f64)> { terms.iter().map(|(k, a)| (*k, -a)).collect() };
        match parts {
            [] => self.at_most(negative(most), 0.0),
            [part] => {
                self.at_most([part.clone(), negative(most)].concat(), 0.0);
                self.at_most([negative(part), negative(most)].concat(), 0.0);
            }
            _ => {
                let row = |terms: &[(usize, f64)]| Row { terms: negative(terms), bound: 0.0 };
                self.cones.push(std::iter::once(most).chain(parts.iter().map(Vec::as_slice)).map(row).collect());
            }
        }
    }

    /// Solves it within this many seconds.
    pub fn solve(&self, seconds: f64) -> Outcome {
        let (n, equal) = (self.cost.len(), self.equal.len());
        let linear = equal + self.at_most.len();
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut bounds = Vec::with_capacity(linear);
        for (i, row) in self.equal.iter().chain(&self.at_most).chain(self.cones.iter().flatten()).enumerate() {
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
        let mut cones = vec![SupportedConeT::ZeroConeT(equal), SupportedConeT::NonnegativeConeT(self.at_most.len())];
        cones.extend(self.cones.iter().map(|cone| SupportedConeT::SecondOrderConeT(cone.len())));
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
        let point = |x: &[f64]| Point {
            x: x.to_vec(),
            at_most: found.z[equal..linear].to_vec(),
            equal: found.z[..equal].to_vec(),
        };
        match found.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Outcome::Optimum(point(&found.x)),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Outcome::Infeasible(point(&[])),
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Outcome::Unbounded(found.x.clone()),
            SolverStatus::MaxTime => Outcome::OutOfTime,
            _ => Outcome::Undecided,
        }
    }

    /// The optimum near `x`, which misses it by about 1/`zoom`: the same program in the magnified difference, so that
    /// the tolerance of the crate counts for only 1/`zoom` (iterative refinement of linear programs,
    /// Gleixner et al. 2016). `None` where that gives no point.
    pub fn refined(&self, x: &[f64], zoom: f64, seconds: f64) -> Option<Vec<f64>> {
        let mut near = LinearProgram { cost: self.cost.clone(), ..LinearProgram::default() };
        let rest = |row: &Row| row.rest(x) * zoom;
        let reach = |row: &Row| row.terms.iter().map(|(_, a)| a.abs() * RANGE).sum::<f64>();
        for row in &self.equal {
            near.equal(row.terms.clone(), rest(row));
        }
        for row in &self.at_most {
            let bound = rest(row);
            // Beyond what the difference can reach a row binds nothing.
            if bound < reach(row) {
                near.at_most(row.terms.clone(), bound);
            }
        }
        for cone in &self.cones {
            let rests: Vec<f64> = cone.iter().map(rest).collect();
            let length = rests[1..].iter().map(|part| part * part).sum::<f64>().sqrt();
            let far = cone[1..].iter().map(reach).sum::<f64>();
            if rests[0] - length >= reach(&cone[0]) + far {
                continue;
            }
            near.cones.push(if length > far { from_its_side(cone, &rests, length) } else { moved(cone, &rests) });
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
    fn the_farthest_point_of_a_disk_is_on_its_rim() {
        // max 3a + 4b, |(a, b)| ≤ r = 1: (0.6, 0.8), which the crate's tolerance leaves uncertain by its square root.
        let mut program = LinearProgram::default();
        let [a, b, r] = [-3.0, -4.0, 0.0].map(|cost| program.variable(cost));
        program.equal(vec![(r, 1.0)], 1.0);
        program.at_least_length(&[(r, 1.0)], &[vec![(a, 1.0)], vec![(b, 1.0)]]);
        let Outcome::Optimum(found) = program.solve(10.0) else { panic!() };
        assert!((found.x[a] - 0.6).abs() < 1e-4 && (found.x[b] - 0.8).abs() < 1e-4, "{:?}", found.x);
        assert!(found.at_most.is_empty() && (found.equal[0] - 5.0).abs() < 1e-4, "{found:?}");
        // One part is its magnitude: max a, |a| ≤ r.
        let mut program = LinearProgram::default();
        let [a, r] = [-1.0, 0.0].map(|cost| program.variable(cost));
        program.at_most(vec![(r, 1.0)], 2.0);
        program.at_least_length(&[(r, 1.0)], &[vec![(a, 1.0)]]);
        let Outcome::Optimum(found) = program.solve(10.0) else { panic!() };
        assert!((found.x[a] - 2.0).abs() < 1e-6);
    }

    #[test]
    fn a_refined_cone_is_as_narrow_as_it_was() {
        // max s, a − s ≥ |(b, c)|, b = 0.6, c = 0.8, a ≤ 1 + 1e-10: s = 1e-10, far below the tolerance of the crate.
        let mut program = LinearProgram::default();
        let [s, a, b, c] = [-1.0, 0.0, 0.0, 0.0].map(|cost| program.variable(cost));
        program.at_most(vec![(a, 1.0)], 1.0 + 1e-10);
        program.equal(vec![(b, 1.0)], 0.6);
        program.equal(vec![(c, 1.0)], 0.8);
        program.at_least_length(&[(a, 1.0), (s, -1.0)], &[vec![(b, 1.0)], vec![(c, 1.0)]]);
        let Outcome::Optimum(rough) = program.solve(10.0) else { panic!() };
        let fine = program.refined(&rough.x, 1e6, 10.0).expect("a point");
        assert!((fine[s] - 1e-10).abs() < 1e-13, "{:e} after {:e}", fine[s], rough.x[s]);
    }

    #[test]
    fn refinement_reaches_the_last_digits() {
        // max t ≤ 1/3 · 1e-9 beside entries of size 1: the first answer cannot know t.
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
