//! Lemke's algorithm in exact arithmetic, fast enough for some hundred rows.
//!
//! The [`Tableau`] runs over [`BallModP`] numbers; whenever a sign needs more bits the run is repeated with twice as
//! many. Vertices and rays are then computed in rationals from the basis alone (one exact linear system each) and
//! verified: w = M z + q + d p, every sign, and at a ray the direction. The rational tableau
//! (`Tableau<BigRational>`) makes the same pivots, slowly.

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::lcp::driver::{Engine, Step};
use crate::lcp::exact::ball_mod_p::BallModP;
use crate::lcp::exact::rational_solve::{Quotients, RationalSolution, clear_denominators, solve};
use crate::lcp::exact::scalar::{BigInt, Scalar};
use crate::lcp::exact::tableau::Tableau;
use crate::lcp::outcome::{Outcome, Point, RayDirection};
use crate::lcp::pivot::PivotLog;
use crate::lcp::problem::{Lcp, MARGINAL};
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;
use crate::watch::Watch;

/// More bits than this are not tried …
const MOST_BITS: u32 = 1 << 17;
/// … and none that make the numbers of a tableau larger than this, in bits: 1 GB.
const MOST_ROOM: u64 = 1 << 33;

/// One row of the LCP in integers: scale · (M z + q + d p).
#[derive(Clone, Debug)]
struct WholeRow {
    matrix: Vec<BigInt>,
    q: BigInt,
    covering: BigInt,
    scale: BigInt,
}

/// See the [module documentation](self).
#[derive(Clone)]
pub struct Exact<'a> {
    lcp: Lcp<BigRational>,
    rows: Vec<WholeRow>,
    rule: TieRule,
    precision: u32,
    tableau: Tableau<BallModP>,
    ended: Option<Outcome<BigRational>>,
    watch: &'a dyn Watch,
}

impl<'a> Exact<'a> {
    /// An engine before the entry of p. All vectors and rows of `lcp` must have the length of q. `watch` may stop what
    /// takes long between two pivots: repeating the run with more bits, and proving its end.
    pub fn new(lcp: Lcp<BigRational>, rule: TieRule, watch: &'a dyn Watch) -> Self {
        let precision = 160 + 2 * lcp.size() as u32;
        let rows = lcp
            .matrix
            .iter()
            .zip(lcp.q.iter().zip(&lcp.covering))
            .map(|(row, (q, d))| {
                let all: Vec<BigRational> = row.iter().chain([q, d]).cloned().collect();
                let (mut matrix, scale) = clear_denominators(&all);
                let covering = matrix.pop().unwrap_or_default();
                let q = matrix.pop().unwrap_or_default();
                WholeRow { matrix, q, covering, scale }
            })
            .collect();
        Self { tableau: start(&lcp, &rule, precision), lcp, rows, rule, precision, ended: None, watch }
    }

    /// Bits that the numbers are carried with at present.
    pub fn precision(&self) -> u32 {
        self.precision
    }

    /// Repeats the run so far with twice the bits; false when there are no more, or when stopped.
    fn refine(&mut self) -> bool {
        let done = self.tableau.pivots().count();
        let entries = 2 * (self.lcp.size() as u64).pow(2).max(1);
        while self.precision < MOST_BITS && entries * 2 * u64::from(self.precision) <= MOST_ROOM {
            self.precision *= 2;
            self.tableau = start(&self.lcp, &self.rule, self.precision);
            let repeated = (0..done).all(|_| !self.watch.stop() && self.tableau.step() == Step::Pivoted);
            if repeated {
                return true;
            }
            if self.watch.stop() {
                return false;
            }
        }
        false
    }

    /// Solves the rows of the nonbasic w for the basic z and p; right-hand side −q, or minus the column of `moving`.
    fn basics(&self, moving: Option<Variable>) -> Option<Values> {
        let basic = self.tableau.basic();
        let columns: Vec<Variable> = basic.iter().copied().filter(|v| !matches!(v, Variable::W(_))).collect();
        let tight: Vec<usize> = self
            .tableau
            .nonbasic()
            .iter()
            .filter_map(|v| match v {
                Variable::W(i) => Some(*i),
                _ => None,
            })
            .collect();
        let entry = |row: &WholeRow, variable: Variable| match variable {
            Variable::Z(j) => row.matrix[j].clone(),
            Variable::P => row.covering.clone(),
            Variable::W(_) => BigInt::zero(),
        };
        let matrix: Vec<Vec<BigInt>> =
            tight.iter().map(|i| columns.iter().map(|v| entry(&self.rows[*i], *v)).collect()).collect();
        let rhs: Vec<BigInt> = tight
            .iter()
            .map(|i| {
                let row = &self.rows[*i];
                match moving {
                    None => -&row.q,
                    Some(Variable::W(j)) if j == *i => row.scale.clone(),
                    Some(variable) => -entry(row, variable),
                }
            })
            .collect();
        let mut progress = |_| self.watch.go_on();
        let RationalSolution::Unique(Quotients { numerators, denominator }) = solve(&matrix, &rhs, &mut progress)
        else {
            return None;
        };
        let n = self.lcp.size();
        let mut values = Values { z: vec![BigInt::zero(); n], p: BigInt::zero(), w: Vec::new(), denominator };
        for (variable, value) in columns.into_iter().zip(numerators) {
            match variable {
                Variable::Z(j) => values.z[j] = value,
                Variable::P => values.p = value,
                Variable::W(_) => {}
            }
        }
        match moving {
            Some(Variable::Z(j)) => values.z[j] = values.denominator.clone(),
            Some(Variable::P) => values.p = values.denominator.clone(),
            Some(Variable::W(_)) | None => {}
        }
        values.w = self
            .rows
            .iter()
            .map(|row| {
                let mut sum: BigInt = row
                    .matrix
                    .iter()
                    .zip(&values.z)
                    .filter(|(a, z)| !a.is_zero() && !z.is_zero())
                    .map(|(a, z)| a * z)
                    .sum();
                sum += &row.covering * &values.p;
                if moving.is_none() {
                    sum += &row.q * &values.denominator;
                }
                sum
            })
            .collect();
        Some(values)
    }

    /// Numerators over the common denominator as rationals; not reduced, which would cost more than the run.
    fn rationals(&self, values: &Values) -> Point<BigRational> {
        let over = |n: &BigInt| BigRational::new_raw(n.clone(), values.denominator.clone());
        Point {
            z: values.z.iter().map(over).collect(),
            w: values
                .w
                .iter()
                .zip(&self.rows)
                .map(|(w, row)| BigRational::new_raw(w.clone(), &row.scale * &values.denominator))
                .collect(),
            p: over(&values.p),
        }
    }

    /// Turns the end of the run over balls into a proved one.
    fn prove(&self, outcome: Outcome<BallModP>) -> Outcome<BigRational> {
        let failed = || {
            if self.watch.stop() {
                return Outcome::Interrupted;
            }
            Outcome::Breakdown(
                "the exact values of the last basis do not confirm the run (a prime divided a pivot)".to_owned(),
            )
        };
        match outcome {
            Outcome::Trivial => Outcome::Trivial,
            Outcome::Normal { marginal } => match self.basics(None) {
                Some(values) if values.holds() && values.complementary() && marginal != Zero::is_zero(&values.p) => {
                    Outcome::Normal { marginal }
                }
                _ => failed(),
            },
            Outcome::Ray(direction) => {
                let (Some(vertex), Some(moving)) = (self.basics(None), self.basics(Some(direction.entering))) else {
                    return failed();
                };
                let Point { z, w, p } = self.rationals(&moving);
                let small = self.lcp.scale.load.map_or(0.0, |load| load * MARGINAL);
                let at = BigRational::new_raw(vertex.p.clone(), vertex.denominator.clone());
                if !vertex.holds() || !moving.holds() || Scalar::to_f64(&at) <= 0.5 * small {
                    return failed();
                }
                Outcome::Ray(RayDirection { entering: direction.entering, z, w, p })
            }
            Outcome::PivotLimit => Outcome::PivotLimit,
            Outcome::Cycle(cycle) => Outcome::Cycle(cycle),
            Outcome::Breakdown(why) => Outcome::Breakdown(why),
            Outcome::Interrupted => Outcome::Interrupted,
        }
    }
}

/// z, p = numerator / denominator; w of a row times its scale likewise.
struct Values {
    z: Vec<BigInt>,
    w: Vec<BigInt>,
    p: BigInt,
    denominator: BigInt,
}

impl Values {
    /// Nothing is negative.
    fn holds(&self) -> bool {
        !self.p.is_negative() && !self.z.iter().chain(&self.w).any(Signed::is_negative)
    }

    fn complementary(&self) -> bool {
        self.z.iter().zip(&self.w).all(|(z, w)| z.is_zero() || w.is_zero())
    }
}

fn start(lcp: &Lcp<BigRational>, rule: &TieRule, precision: u32) -> Tableau<BallModP> {
    let convert = |v: &[BigRational]| -> Vec<BallModP> { v.iter().map(|x| BallModP::new(x, precision)).collect() };
    let ball_mod_p = Lcp {
        matrix: lcp.matrix.iter().map(|row| convert(row)).collect(),
        q: convert(&lcp.q),
        covering: convert(&lcp.covering),
        scale: lcp.scale.clone(),
    };
    Tableau::new(&ball_mod_p, rule.clone())
}

impl Engine for Exact<'_> {
    type Number = BigRational;

    fn step(&mut self) -> Step<BigRational> {
        if let Some(outcome) = &self.ended {
            return Step::Ended(outcome.clone());
        }
        let outcome = loop {
            match self.tableau.step() {
                Step::Pivoted => return Step::Pivoted,
                Step::Ended(Outcome::Breakdown(why)) => {
                    // A sign that could not be determined.
                    if !self.refine() {
                        if self.watch.stop() {
                            break Outcome::Interrupted;
                        }
                        break Outcome::Breakdown(format!("{why} with {} bits", self.precision));
                    }
                }
                Step::Ended(outcome) => break self.prove(outcome),
            }
        };
        self.ended = Some(outcome.clone());
        Step::Ended(outcome)
    }

    fn pivots(&self) -> &PivotLog {
        self.tableau.pivots()
    }

    /// Exact values of the present basis; fractions are not reduced. If the basis turns out singular (a breakdown),
    /// all values are zero.
    fn point(&self) -> Point<BigRational> {
        if self.pivots().is_empty() {
            return Point { z: vec![Zero::zero(); self.lcp.size()], w: self.lcp.q.clone(), p: Zero::zero() };
        }
        match self.basics(None) {
            Some(values) => self.rationals(&values),
            None => Point {
                z: vec![Zero::zero(); self.lcp.size()],
                w: vec![Zero::zero(); self.lcp.size()],
                p: Zero::zero(),
            },
        }
    }
}

#[cfg(test)]
#[path = "lemke_tests.rs"]
mod tests;
