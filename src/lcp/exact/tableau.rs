//! Lemke's algorithm on a dense dictionary, generic over the number type: the judge of the fast engine.
//!
//! ```text
//! basic_i = value_i + Σ_j a_ij nonbasic_j          (n rows, n + 1 columns)
//! ```
//!
//! It starts as w = q + M z + d p. p enters first and is let in just as far as makes w ≥ 0; from then on the
//! complement of the variable that left last enters. Every pivot exchanges one row with one column and rewrites
//! the whole dictionary. Nothing is cached, nothing exploited: small and slow on purpose.
//!
//! Exact number types compare with zero exactly. In f64 a coefficient or value counts as zero by the bounds of
//! [`Scale`](crate::lcp::problem::Scale).
//!
//! Tie rules: `Lexicographic` lets p leave as soon as it can, then takes the lexicographically smallest row of
//! B⁻¹ / pivot. `FirstRow` and `Random` choose among the tied rows as they stand, p among them; the order of the
//! rows is that of the dictionary, p last: row i starts as w_i, and a variable that enters takes the row of the one
//! that leaves. `Random` draws once for every tie of two or more.

use std::cmp::Ordering;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::lcp::driver::{Engine, Step};
use crate::lcp::exact::scalar::Scalar;
use crate::lcp::outcome::{Outcome, Point, RayDirection};
use crate::lcp::pivot::{Pivot, PivotLog};
use crate::lcp::problem::Lcp;
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;

/// A basic variable below −(this × its noise) means that the f64 numbers no longer belong together.
const BREAKDOWN: f64 = 1e7;

#[path = "tableau_choice.rs"]
mod choice;

/// A sign that could not be determined: NaN in f64, too little precision in a ball.
struct Undecided(Variable);

/// Where a variable stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Row(usize),
    Column(usize),
}

/// See the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Tableau<T> {
    lcp: Lcp<T>,
    rule: TieRule,
    random: Option<ChaCha8Rng>,
    rows: Vec<Vec<T>>,
    values: Vec<T>,
    basic: Vec<Variable>,
    nonbasic: Vec<Variable>,
    entering: Variable,
    pivots: PivotLog,
    ended: Option<Outcome<T>>,
    /// Typical d_i / row_i: what a unit of p weighs against scaled displacements.
    weight_of_p: f64,
}

impl<T: Scalar> Tableau<T> {
    /// An engine before the entry of p. All vectors and rows of `lcp` must have the length of q.
    pub fn new(lcp: &Lcp<T>, rule: TieRule) -> Self {
        let n = lcp.size();
        let rows = lcp
            .matrix
            .iter()
            .zip(&lcp.covering)
            .map(|(row, d)| row.iter().chain(std::iter::once(d)).cloned().collect())
            .collect();
        let ratios =
            || lcp.covering.iter().zip(&lcp.scale.row).filter(|(_, row)| **row > 0.0).map(|(d, row)| d.to_f64() / row);
        let (low, high) =
            ratios().fold((f64::INFINITY, 0.0f64), |(low, high), ratio| (low.min(ratio), high.max(ratio)));
        let random = match rule {
            TieRule::Random(seed) => Some(ChaCha8Rng::seed_from_u64(seed)),
            _ => None,
        };
        Self {
            rule,
            random,
            rows,
            values: lcp.q.clone(),
            basic: (0..n).map(Variable::W).collect(),
            nonbasic: (0..n).map(Variable::Z).chain(std::iter::once(Variable::P)).collect(),
            entering: Variable::P,
            pivots: PivotLog::default(),
            ended: None,
            weight_of_p: if high > 0.0 { (low * high).sqrt() } else { 1.0 },
            lcp: lcp.clone(),
        }
    }

    /// The basic variables, row by row.
    pub fn basic(&self) -> &[Variable] {
        &self.basic
    }

    /// The nonbasic variables, column by column.
    pub fn nonbasic(&self) -> &[Variable] {
        &self.nonbasic
    }

    /// Present values of the basic variables, row by row.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Coefficients of the dictionary, row by row, columns as [`Tableau::nonbasic`].
    pub fn rows(&self) -> &[Vec<T>] {
        &self.rows
    }

    fn place(&self, variable: Variable) -> Place {
        if let Some(row) = self.basic.iter().position(|v| *v == variable) {
            return Place::Row(row);
        }
        // Invariant: every variable is either basic or nonbasic.
        let column = self.nonbasic.iter().position(|v| *v == variable);
        Place::Column(column.expect("every variable has a row or a column"))
    }

    fn p_value(&self) -> T {
        match self.place(Variable::P) {
            Place::Row(row) => self.values[row].clone(),
            Place::Column(_) => T::zero(),
        }
    }

    /// First basic variable that is negative beyond all rounding (f64 only).
    fn broken(&self, column: usize) -> Option<String> {
        if T::is_exact() {
            return None;
        }
        let size = self.vertex_size(column, 0.0);
        self.basic.iter().enumerate().find_map(|(row, variable)| {
            let value = self.values[row].to_f64();
            (value < -BREAKDOWN * self.noise(*variable, size)).then(|| {
                format!("the basic variable {variable:?} fell to {value:e}: rounding errors have grown too large, use exact arithmetic")
            })
        })
    }

    /// Exchanges row and column.
    fn pivot(&mut self, row: usize, column: usize, ties: &[usize]) {
        let p_before = self.p_value().to_f64();
        let tied = ties.iter().map(|row| self.basic[*row]).collect();
        let leaving = self.basic[row];
        let entering = self.nonbasic[column];

        let degenerate = !self.pivots.is_empty() && {
            let here = if T::is_exact() { choice::Size::default() } else { self.vertex_size(column, 0.0) };
            !matches!(self.sign(&self.values[row], leaving, here), Ok(Ordering::Greater))
        };

        let inverse = T::one().div(&self.rows[row][column]);
        let mut solved: Vec<T> =
            self.rows[row].iter().map(|a| if a.is_zero() { T::zero() } else { a.mul(&inverse).neg() }).collect();
        let mut value = self.values[row].mul(&inverse).neg();
        if !T::is_exact() && !self.pivots.is_empty() && value.sign() == Some(Ordering::Less) {
            // The leaving variable was negative by rounding.
            value = T::zero();
        }
        solved[column] = inverse.clone();
        for i in 0..self.rows.len() {
            if i == row {
                continue;
            }
            let factor = std::mem::replace(&mut self.rows[i][column], T::zero());
            if factor.is_zero() {
                continue;
            }
            for (j, a) in self.rows[i].iter_mut().enumerate() {
                if j == column {
                    *a = factor.mul(&inverse);
                } else if !solved[j].is_zero() {
                    *a = a.add(&factor.mul(&solved[j]));
                }
            }
            self.values[i] = self.values[i].add(&factor.mul(&value));
        }
        if !T::is_exact() {
            // Tied variables reached zero with the leaving one.
            for &i in ties {
                self.values[i] = T::zero();
            }
        }
        self.rows[row] = solved;
        let ratio = value.to_f64();
        self.values[row] = value;
        self.basic[row] = entering;
        self.nonbasic[column] = leaving;
        let p_after = self.p_value().to_f64();
        let step = self.pivots.count();
        self.pivots.push(Pivot {
            step,
            entering,
            leaving,
            p_before: if step == 0 { p_after } else { p_before },
            p_after,
            ratio,
            degenerate,
            ties: tied,
        });
        match leaving.complement() {
            Some(next) => self.entering = next,
            None => self.ended = Some(Outcome::Normal { marginal: false }),
        }
    }

    /// The end where nothing goes on but p is as good as zero: an answer.
    fn at_limit_of_p(&self) -> Option<Outcome<T>> {
        let p = self.p_value();
        if p.is_zero() {
            return Some(Outcome::Normal { marginal: false });
        }
        let Point { z, w, .. } = self.point();
        let all = |values: Vec<T>| values.iter().map(Scalar::to_f64).collect();
        let point = Point { z: all(z), w: all(w), p: p.to_f64() };
        self.lcp.is_marginal(&point).then_some(Outcome::Normal { marginal: true })
    }

    fn ray(&self, column: usize) -> Outcome<T> {
        if let Some(end) = self.at_limit_of_p() {
            return end;
        }
        let n = self.lcp.size();
        let size = self.direction_size(column);
        let mut direction = RayDirection {
            entering: self.nonbasic[column],
            z: vec![T::zero(); n],
            w: vec![T::zero(); n],
            p: T::zero(),
        };
        let mut put = |variable: Variable, amount: T| match variable {
            Variable::W(i) => direction.w[i] = amount,
            Variable::Z(i) => direction.z[i] = amount,
            Variable::P => direction.p = amount,
        };
        put(self.nonbasic[column], T::one());
        for (row, variable) in self.basic.iter().enumerate() {
            let a = &self.rows[row][column];
            if let Ok(Ordering::Greater) = self.sign(a, *variable, size) {
                put(*variable, a.clone());
            }
        }
        Outcome::Ray(direction)
    }

    fn advance(&mut self) -> Result<Step<T>, Undecided> {
        if self.pivots.is_empty() {
            let Some(ties) = self.start()? else {
                return Ok(Step::Ended(Outcome::Trivial));
            };
            let column = self.lcp.size();
            let row = self.choose(&ties, column)?;
            self.pivot(row, column, &ties);
            return Ok(Step::Pivoted);
        }
        if let Some(cycle) = self.pivots.cycle(self.rule.returns_allowed()) {
            return Ok(Step::Ended(self.at_limit_of_p().unwrap_or(Outcome::Cycle(cycle))));
        }
        let Place::Column(column) = self.place(self.entering) else {
            return Ok(Step::Ended(Outcome::Breakdown(format!(
                "the entering variable {:?} is basic already",
                self.entering
            ))));
        };
        if let Some(why) = self.broken(column) {
            return Ok(Step::Ended(Outcome::Breakdown(why)));
        }
        let ties = self.ratio_test(column)?;
        if ties.is_empty() {
            return Ok(Step::Ended(self.ray(column)));
        }
        let row = self.choose(&ties, column)?;
        self.pivot(row, column, &ties);
        Ok(Step::Pivoted)
    }
}

impl<T: Scalar> Engine for Tableau<T> {
    type Number = T;

    fn step(&mut self) -> Step<T> {
        if let Some(outcome) = &self.ended {
            return Step::Ended(outcome.clone());
        }
        let step = self.advance().unwrap_or_else(|Undecided(variable)| {
            Step::Ended(Outcome::Breakdown(format!(
                "the sign of a number in the row of {variable:?} could not be told"
            )))
        });
        if let Step::Ended(outcome) = &step {
            self.ended = Some(outcome.clone());
        }
        step
    }

    fn pivots(&self) -> &PivotLog {
        &self.pivots
    }

    fn point(&self) -> Point<T> {
        let n = self.lcp.size();
        let mut point = Point { z: vec![T::zero(); n], w: vec![T::zero(); n], p: T::zero() };
        for (variable, value) in self.basic.iter().zip(&self.values) {
            match variable {
                Variable::W(i) => point.w[*i] = value.clone(),
                Variable::Z(i) => point.z[*i] = value.clone(),
                Variable::P => point.p = value.clone(),
            }
        }
        point
    }
}

#[cfg(test)]
#[path = "tableau_tests.rs"]
mod tests;
