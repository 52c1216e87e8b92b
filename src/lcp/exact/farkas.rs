//! "There is no answer" by linear programming: {z ≥ 0 : M z + q ≥ 0} is empty if and only if some y ≥ 0 has Mᵀy ≤ 0
//! and qᵀy < 0 (Farkas).
//!
//! The linear program is an LCP itself, with the skew matrix [[0, M], [−Mᵀ, 0]] over (y, z): Lemke's algorithm ends at
//! a feasible z or in a ray whose y-part is such a vector. The run in f64 only *proposes* it: which entries are
//! positive, and which columns are tight. These equations are then solved in integers and every sign is checked
//! exactly; only then is it a proof. For smaller problems the exact dictionary decides where f64 cannot.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use num_traits::{Signed, Zero};

use crate::lcp::driver::run;
use crate::lcp::exact::dyadic::WholeRows;
use crate::lcp::exact::polyhedron::{Polyhedron, State};
use crate::lcp::exact::rational_solve::{RationalSolution, solve};
use crate::lcp::exact::scalar::{BigInt, ratio_to_f64};
use crate::lcp::lemke::SchemeEngine;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Outcome;
use crate::lcp::problem::{Lcp, Scale};
use crate::lcp::ratio_test::TieRule;

/// Most pivots of a run in f64.
const MOST_PIVOTS: usize = 20_000;
/// Entries below this times the largest, and sums below this times their terms, are proposed to be zero.
const NOTHING: f64 = 1e-9;
/// Largest product of n³ and the number of pivots that the exact dictionary makes to decide what f64 could not.
const MOST_EXACT: usize = 20_000_000;

/// The proof that {z ≥ 0 : M z + q ≥ 0} is empty, verified in integers.
#[derive(Clone, Debug, PartialEq)]
pub struct Farkas {
    /// y ≥ 0 rounded to f64, largest entry 1.
    pub multipliers: Vec<f64>,
    /// −qᵀy > 0 of it.
    pub gap: f64,
    /// y as integers, any positive multiple.
    pub weights: Vec<BigInt>,
}

/// Looks for the proof; `None`: nothing is proved, there may be a feasible z or not. `go_on` is asked now and then.
///
/// It looks in units of rows and columns, powers of two, in which their largest entries are near 1: where those of the file
/// are far apart the run in f64 proposes nothing right.
pub fn farkas(matrix: &DMatrix<f64>, q: &DVector<f64>, go_on: &mut dyn FnMut() -> bool) -> Option<Farkas> {
    let Some(units) = Units::of(matrix, q) else { return in_own_units(matrix, q, go_on) };
    let found = in_own_units(&units.matrix, &units.q, go_on)?;
    Some(units.back(found))
}

/// The problem R M C, R q in other units; R and C hold powers of two, so that not a digit is lost.
struct Units {
    matrix: DMatrix<f64>,
    q: DVector<f64>,
    /// Exponents of R.
    rows: Vec<i32>,
}

impl Units {
    /// `None` where an entry would leave the range of f64.
    fn of(matrix: &DMatrix<f64>, q: &DVector<f64>) -> Option<Units> {
        let rows: Vec<Vec<f64>> = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
        let scale = Scale::plain(&rows);
        let exponents = |sizes: &[f64]| -> Vec<i32> {
            sizes.iter().map(|size| if *size > 0.0 { -size.log2().round() as i32 } else { 0 }).collect()
        };
        let (rows, columns) = (exponents(&scale.row), exponents(&scale.column));
        let mut is_exact = true;
        let mut times = |value: f64, exponent: i32| {
            let scaled = libm::ldexp(value, exponent);
            is_exact &= libm::ldexp(scaled, -exponent) == value;
            scaled
        };
        let n = q.len();
        let matrix = DMatrix::from_fn(n, n, |i, j| times(matrix[(i, j)], rows[i] + columns[j]));
        let q = DVector::from_fn(n, |i, _| times(q[i], rows[i]));
        is_exact.then_some(Units { matrix, q, rows })
    }

    /// A proof in these units as one in those of the file: y = R y'.
    fn back(&self, found: Farkas) -> Farkas {
        let least = self.rows.iter().min().copied().unwrap_or_default();
        let shifts = self.rows.iter().map(|exponent| exponent.abs_diff(least));
        let weights: Vec<BigInt> = found.weights.iter().zip(shifts).map(|(weight, shift)| weight << shift).collect();
        let multipliers: Vec<f64> =
            found.multipliers.iter().zip(&self.rows).map(|(y, exponent)| libm::ldexp(*y, *exponent)).collect();
        let largest = multipliers.iter().fold(0.0, |most: f64, y| most.max(*y));
        Farkas { multipliers: multipliers.iter().map(|y| y / largest).collect(), gap: found.gap / largest, weights }
    }
}

fn in_own_units(matrix: &DMatrix<f64>, q: &DVector<f64>, go_on: &mut dyn FnMut() -> bool) -> Option<Farkas> {
    let whole = WholeRows::of_lcp(matrix, q);
    if let Some(y) = proposed(matrix, q, go_on)
        && let Some(found) = confirm(&whole, matrix, &y, go_on)
    {
        return Some(found);
    }
    exactly(&whole, go_on)
}

/// The y-part of the ray of the skew LCP, in f64.
fn proposed(matrix: &DMatrix<f64>, q: &DVector<f64>, go_on: &mut dyn FnMut() -> bool) -> Option<Vec<f64>> {
    let n = q.len();
    let entry = |i: usize, j: usize| match (i < n, j < n) {
        (true, false) => matrix[(i, j - n)],
        (false, true) => -matrix[(j, i - n)],
        _ => 0.0,
    };
    let skew: Vec<Vec<f64>> = (0..2 * n).map(|i| (0..2 * n).map(|j| entry(i, j)).collect()).collect();
    let lcp = Lcp {
        scale: Scale::plain(&skew),
        matrix: skew,
        q: q.iter().copied().chain(std::iter::repeat_n(0.0, n)).collect(),
        covering: vec![1.0; 2 * n],
    };
    let rule = TieRule::Lexicographic((0..2 * n).collect());
    let mut engine = SchemeEngine::new(Arc::new(MirroredLcp::plain(&lcp)), rule);
    let mut observer =
        |_: &crate::lcp::pivot::Pivot| if go_on() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    match run(&mut engine, MOST_PIVOTS, &mut observer).outcome {
        Outcome::Ray(ray) => Some(ray.z[..n].to_vec()),
        _ => None,
    }
}

/// Solves for the proposed y exactly and checks every sign.
fn confirm(
    whole: &WholeRows,
    matrix: &DMatrix<f64>,
    proposed: &[f64],
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Farkas> {
    let n = proposed.len();
    let largest = proposed.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let support: Vec<usize> = (0..n).filter(|&i| proposed[i] > NOTHING * largest).collect();
    let tight: Vec<usize> = (0..n)
        .filter(|&j| {
            let terms = support.iter().map(|&i| matrix[(i, j)] * proposed[i]);
            let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), term: f64| (sum + term, size + term.abs()));
            sum.abs() <= NOTHING * size
        })
        .collect();
    // The largest y_i is prescribed; of the others and of the tight columns as many are taken as are independent. The
    // numbers of `whole` are rows of M times a scale: unknowns y_i / scale_i.
    let given = *support.iter().max_by(|a, b| proposed[**a].total_cmp(&proposed[**b]))?;
    let others: Vec<usize> = support.iter().copied().filter(|&i| i != given).collect();
    let coefficient = |j: usize, i: usize| matrix[(i, j)] * proposed[i];
    let (columns, rows) = independent(&tight, &others, &coefficient);
    let equations: Vec<Vec<BigInt>> =
        columns.iter().map(|&j| rows.iter().map(|&i| whole.rows[i][j].clone()).collect()).collect();
    let right: Vec<BigInt> = columns.iter().map(|&j| -&whole.rows[given][j]).collect();
    let mut progress = |_: f64| if go_on() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let RationalSolution::Unique(solution) = solve(&equations, &right, &mut progress) else {
        return None;
    };
    let mut y = vec![BigInt::zero(); n];
    y[given] = solution.denominator;
    for (&i, numerator) in rows.iter().zip(solution.numerators) {
        y[i] = numerator;
    }
    verified(whole, &y)
}

/// A largest set of columns and rows that make a regular matrix, by elimination in f64 with full pivoting.
fn independent(
    columns: &[usize],
    rows: &[usize],
    coefficient: &dyn Fn(usize, usize) -> f64,
) -> (Vec<usize>, Vec<usize>) {
    if columns.is_empty() || rows.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let mut matrix = DMatrix::from_fn(columns.len(), rows.len(), |j, i| coefficient(columns[j], rows[i]));
    for mut row in matrix.row_iter_mut() {
        let size = row.amax();
        if size > 0.0 {
            row /= size;
        }
    }
    let lu = matrix.full_piv_lu();
    let pivots = lu.u().diagonal().map(f64::abs);
    let rank = pivots.iter().filter(|pivot| **pivot > NOTHING).count();
    let mut columns = DVector::from_column_slice(columns);
    lu.p().permute_rows(&mut columns);
    let mut rows = DVector::from_column_slice(rows).transpose();
    lu.q().permute_columns(&mut rows);
    (columns.iter().take(rank).copied().collect(), rows.iter().take(rank).copied().collect())
}

/// The exact dictionary of {z ≥ 0 : M z + q ≥ 0}: its proof of emptiness is the row that cannot be mended.
fn exactly(whole: &WholeRows, go_on: &mut dyn FnMut() -> bool) -> Option<Farkas> {
    let n = whole.rows.len();
    let mut left = MOST_EXACT / (n * n * n).max(1);
    let mut polyhedron = Polyhedron::new(n, whole.clone(), &[]);
    let state = polyhedron.start(&mut || {
        left = left.saturating_sub(1);
        left > 0 && go_on()
    });
    if state != State::Empty {
        return None;
    }
    let row = polyhedron.hopeless_row()?;
    let mut y = vec![BigInt::zero(); n];
    if let Some(i) = polyhedron.basic()[row].checked_sub(n) {
        y[i] = polyhedron.denominator().clone();
    }
    for (column, variable) in polyhedron.nonbasic().iter().enumerate() {
        if let Some(i) = variable.checked_sub(n) {
            y[i] = -polyhedron.entry(row, column);
        }
    }
    verified(whole, &y)
}

/// y ≥ 0, Mᵀy ≤ 0, qᵀy < 0 in integers; y over the rows of `whole`, any positive multiple.
fn verified(whole: &WholeRows, y: &[BigInt]) -> Option<Farkas> {
    let n = y.len();
    let sum = |column: usize| -> BigInt {
        (0..n)
            .filter(|&i| !y[i].is_zero() && !whole.rows[i][column].is_zero())
            .map(|i| &whole.rows[i][column] * &y[i])
            .sum()
    };
    let gap = -sum(n);
    if y.iter().any(Signed::is_negative) || !gap.is_positive() || (0..n).any(|j| sum(j).is_positive()) {
        return None;
    }
    // As multipliers of the rows of M they are y_i · scale_i.
    let own: Vec<BigInt> = y.iter().zip(&whole.scale).map(|(y, scale)| y * scale).collect();
    let largest = own.iter().max()?;
    let multipliers = own.iter().map(|y| ratio_to_f64(y, largest)).collect();
    let gap = ratio_to_f64(&gap, largest);
    Some(Farkas { multipliers, gap, weights: own })
}

#[cfg(test)]
#[path = "farkas_tests.rs"]
mod tests;
