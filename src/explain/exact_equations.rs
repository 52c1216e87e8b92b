//! Homogeneous linear equations solved exactly: the few that a motion has to satisfy to the last digit.

use std::collections::BTreeMap;
use std::time::Instant;

use num_rational::BigRational;
use num_traits::Zero;

use crate::lcp::exact::dyadic::{nearest, rational};

/// The free unknowns are rounded to multiples of 1/GRID: short numbers stay short.
const GRID: f64 = (1u64 << 40) as f64;

type Row = BTreeMap<usize, BigRational>;

/// Rows a·y = 0.
pub struct Equations {
    rows: Vec<Row>,
    unknowns: usize,
    end: Instant,
}

/// What came of them.
pub enum Solved {
    /// There are no equations.
    Free,
    /// y.
    Exactly(Vec<BigRational>),
    /// The time was up.
    OutOfTime,
}

impl Equations {
    /// No equations yet, for this many unknowns, to be solved before `end`.
    pub fn new(unknowns: usize, end: Instant) -> Equations {
        Equations { rows: Vec::new(), unknowns, end }
    }

    /// Adds Σ terms = 0; terms of one unknown add up.
    pub fn add(&mut self, terms: impl IntoIterator<Item = (usize, BigRational)>) {
        let mut row = Row::new();
        for (k, a) in terms {
            *row.entry(k).or_insert_with(BigRational::zero) += a;
        }
        row.retain(|_, a| !a.is_zero());
        if !row.is_empty() {
            self.rows.push(row);
        }
    }

    /// The solution whose free unknowns are those of `near`; the others follow from the equations.
    pub fn nearest(self, near: &[f64]) -> Solved {
        if self.rows.is_empty() {
            return Solved::Free;
        }
        // In reduced echelon form, by leading unknown.
        let mut solved: BTreeMap<usize, Row> = BTreeMap::new();
        for mut row in self.rows {
            let known: Vec<usize> = row.keys().copied().filter(|k| solved.contains_key(k)).collect();
            for k in known {
                if Instant::now() > self.end {
                    return Solved::OutOfTime;
                }
                if let (Some(factor), Some(lead)) = (row.remove(&k), solved.get(&k)) {
                    subtract(&mut row, &factor, lead);
                }
            }
            let Some(lead) =
                row.keys().copied().max_by(|a, b| nearest(&row[a]).abs().total_cmp(&nearest(&row[b]).abs()))
            else {
                continue;
            };
            let Some(pivot) = row.remove(&lead) else { continue };
            row.values_mut().for_each(|a| *a /= &pivot);
            for other in solved.values_mut() {
                if Instant::now() > self.end {
                    return Solved::OutOfTime;
                }
                if let Some(factor) = other.remove(&lead) {
                    subtract(other, &factor, &row);
                }
            }
            solved.insert(lead, row);
        }
        let mut y: Vec<BigRational> = near.iter().map(|value| rational((value * GRID).round() / GRID)).collect();
        y.resize(self.unknowns, BigRational::zero());
        for (lead, row) in &solved {
            // Rows hold free unknowns only: y[lead] + Σ a y = 0.
            let sum: BigRational = row.iter().map(|(k, a)| a * &y[*k]).sum();
            y[*lead] = -sum;
        }
        Solved::Exactly(y)
    }
}

/// row −= factor · (what `lead` stands for): the leading unknown, whose coefficient is 1, has been taken out already.
fn subtract(row: &mut Row, factor: &BigRational, lead: &Row) {
    for (k, a) in lead {
        let entry = row.entry(*k).or_insert_with(BigRational::zero);
        *entry -= factor * a;
        if entry.is_zero() {
            row.remove(k);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn r(n: i64, d: i64) -> BigRational {
        BigRational::new(n.into(), d.into())
    }

    #[test]
    fn solutions_satisfy_every_equation_and_keep_the_free_unknowns() {
        // y0 + 2 y1 = 0, 3 y1 − y2 = 0, and their sum: one free unknown.
        let rows = [vec![(0, r(1, 1)), (1, r(2, 1))], vec![(1, r(3, 1)), (2, r(-1, 1))]];
        let mut equations = Equations::new(4, Instant::now() + Duration::from_secs(10));
        rows.iter().for_each(|row| equations.add(row.clone()));
        equations.add(rows.concat());
        let Solved::Exactly(y) = equations.nearest(&[-0.4, 0.2, 0.6, 0.125]) else { panic!() };
        for row in rows {
            let sum: BigRational = row.iter().map(|(k, a)| a * &y[*k]).sum();
            assert!(sum.is_zero());
        }
        assert_eq!(y[3], r(1, 8));
        assert!((nearest(&y[1]) - 0.2).abs() < 1e-6 && !y[1].is_zero());
        assert!(matches!(Equations::new(2, Instant::now()).nearest(&[1.0, 1.0]), Solved::Free));
    }

    #[test]
    fn opposed_terms_of_one_unknown_are_no_equation() {
        let mut equations = Equations::new(1, Instant::now() + Duration::from_secs(10));
        equations.add([(0, r(1, 1)), (0, r(-1, 1))]);
        assert!(matches!(equations.nearest(&[1.0]), Solved::Free));
    }
}
