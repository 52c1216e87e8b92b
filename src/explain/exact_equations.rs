//! Homogeneous linear equations solved exactly: the few that a motion has to satisfy to the last digit.
//!
//! Which unknowns follow from the others is decided by an elimination in f64 beside one modulo a prime: the first tells how
//! large an entry is, the second whether it is 0. Then one regular system of integers is solved by p-adic lifting, and the
//! equations that are left are put to the test.

use std::collections::BTreeMap;
use std::time::Instant;

use num_traits::Zero;

use crate::lcp::exact::dyadic::Dyadic;
use crate::lcp::exact::modular::Prime;
use crate::lcp::exact::rational_solve::{Quotients, RationalSolution, solve};
use crate::lcp::exact::scalar::BigInt;
use crate::watch::until;

/// The free unknowns are rounded to multiples of 2^−GRID: short numbers stay short.
const GRID: i64 = 40;

/// Rows a·y = 0.
pub struct Equations {
    /// Integers: a row may be multiplied.
    rows: Vec<BTreeMap<usize, BigInt>>,
    unknowns: usize,
    end: Instant,
}

/// What came of them.
pub enum Solved {
    /// There are no equations.
    Free,
    /// A positive multiple of y, by a factor between 1/2 and 1.
    Exactly(Vec<Dyadic>),
    /// The time was up.
    OutOfTime,
}

impl Equations {
    /// No equations yet, for this many unknowns, to be solved before `end`.
    pub fn new(unknowns: usize, end: Instant) -> Equations {
        Equations { rows: Vec::new(), unknowns, end }
    }

    /// Adds Σ terms = 0; terms of one unknown add up.
    pub fn add(&mut self, terms: impl IntoIterator<Item = (usize, Dyadic)>) {
        let mut row: BTreeMap<usize, Dyadic> = BTreeMap::new();
        for (k, a) in terms {
            let sum = row.entry(k).or_default();
            *sum = sum.plus(&a);
        }
        row.retain(|_, a| !a.is_zero());
        let least = row.values().map(Dyadic::exponent).min().unwrap_or(0);
        if !row.is_empty() {
            self.rows.push(row.into_iter().map(|(k, a)| (k, a.in_units_of(least))).collect());
        }
    }

    /// The solution whose free unknowns are those of `near`; the others follow from the equations.
    pub fn nearest(&self, near: &[f64]) -> Solved {
        if self.rows.is_empty() {
            return Solved::Free;
        }
        let scale = (GRID as f64).exp2();
        let whole = |value: &f64| Dyadic::from((value * scale).round()).in_units_of(0);
        let mut y: Vec<BigInt> = near.iter().map(whole).collect();
        y.resize(self.unknowns, BigInt::zero());
        for prime in Prime::ALL {
            let Some(leads) = self.leads(prime) else { return Solved::OutOfTime };
            let (matrix, rhs) = self.regular(&leads, &y);
            let Quotients { numerators, denominator } = match solve(&matrix, &rhs, &mut |_| until(self.end)) {
                RationalSolution::Unique(found) => found,
                RationalSolution::Interrupted => return Solved::OutOfTime,
                RationalSolution::Singular { .. } | RationalSolution::Unlucky => continue,
            };
            let mut exact: Vec<BigInt> = y.iter().map(|y| y * &denominator).collect();
            for (lead, numerator) in leads.iter().zip(numerators) {
                exact[lead.unknown] = numerator;
            }
            if self.hold(&exact) {
                let exponent = -GRID - denominator.bits() as i64;
                return Solved::Exactly(exact.into_iter().map(|y| Dyadic::new(y, exponent)).collect());
            }
        }
        // Each of the primes divides a minor (never seen). 0 satisfies every equation, and proves nothing.
        Solved::Exactly(vec![Dyadic::default(); self.unknowns])
    }

    /// Independent rows, each with the unknown that follows from it: modulo the prime they are regular. `None` when the time is
    /// up.
    fn leads(&self, p: Prime) -> Option<Vec<Lead>> {
        let mut found: Vec<(Lead, Vec<Entry>)> = Vec::new();
        for (number, whole) in self.rows.iter().enumerate() {
            if Instant::now() > self.end {
                return None;
            }
            let mut row = vec![Entry::default(); self.unknowns];
            let bits = whole.values().map(BigInt::bits).max().unwrap_or(0);
            for (&k, a) in whole {
                row[k] = Entry { size: Dyadic::new(a.clone(), -(bits as i64)).to_f64(), residue: p.residue(a) };
            }
            for (lead, solved) in &found {
                let factor = row[lead.unknown];
                if factor.residue == 0 {
                    continue;
                }
                // The leading entry is 1.
                let minus = p.minus(factor.residue);
                for (entry, solved) in row.iter_mut().zip(solved).filter(|(_, solved)| solved.residue != 0) {
                    entry.size -= factor.size * solved.size;
                    entry.residue = p.plus_product(entry.residue, minus, solved.residue);
                }
            }
            let nonzero = (0..row.len()).filter(|&k| row[k].residue != 0);
            let Some(unknown) = nonzero.max_by(|&a, &b| row[a].size.abs().total_cmp(&row[b].size.abs())) else {
                continue;
            };
            let Entry { size, residue } = row[unknown];
            // Where only its residue tells that it is not 0, its size is that of rounding.
            let (size, over) = (if size == 0.0 { 1.0 } else { size }, p.inverse(residue));
            for entry in &mut row {
                *entry = Entry { size: entry.size / size, residue: p.times(entry.residue, over) };
            }
            found.push((Lead { row: number, unknown }, row));
        }
        Some(found.into_iter().map(|(lead, _)| lead).collect())
    }

    /// The chosen rows over their leading unknowns, and what the others leave on the right.
    fn regular(&self, leads: &[Lead], y: &[BigInt]) -> (Vec<Vec<BigInt>>, Vec<BigInt>) {
        let mut place = vec![None; self.unknowns];
        leads.iter().enumerate().for_each(|(i, lead)| place[lead.unknown] = Some(i));
        let equation = |lead: &Lead| {
            let (mut row, mut right) = (vec![BigInt::zero(); leads.len()], BigInt::zero());
            for (&k, a) in &self.rows[lead.row] {
                match place[k] {
                    Some(i) => row[i] = a.clone(),
                    None => right -= a * &y[k],
                }
            }
            (row, right)
        };
        leads.iter().map(equation).unzip()
    }

    fn hold(&self, y: &[BigInt]) -> bool {
        self.rows.iter().all(|row| row.iter().map(|(k, a)| a * &y[*k]).sum::<BigInt>().is_zero())
    }
}

/// A row and the unknown that follows from it.
struct Lead {
    row: usize,
    unknown: usize,
}

/// What an elimination leaves of an entry: in f64, and modulo the prime.
#[derive(Clone, Copy, Default)]
struct Entry {
    size: f64,
    residue: u64,
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

    fn soon() -> Instant {
        Instant::now() + Duration::from_secs(10)
    }

    fn sum(row: &[(usize, f64)], y: &[Dyadic]) -> Dyadic {
        row.iter().fold(Dyadic::default(), |sum, (k, a)| sum.plus(&Dyadic::from(*a).times(&y[*k])))
    }

    fn solved(unknowns: usize, rows: &[Vec<(usize, f64)>], near: &[f64]) -> Vec<Dyadic> {
        let mut equations = Equations::new(unknowns, soon());
        rows.iter().for_each(|row| equations.add(row.iter().map(|(k, a)| (*k, Dyadic::from(*a)))));
        match equations.nearest(near) {
            Solved::Exactly(y) => y,
            Solved::Free => near.iter().map(|y| Dyadic::from(*y)).collect(),
            Solved::OutOfTime => panic!("ten seconds"),
        }
    }

    /// Rank by elimination in rationals.
    fn rank(rows: &[Vec<(usize, f64)>], unknowns: usize) -> usize {
        let mut left: Vec<Vec<BigRational>> = Vec::new();
        for row in rows {
            let mut dense = vec![BigRational::zero(); unknowns];
            row.iter().for_each(|(k, a)| dense[*k] += Dyadic::from(*a).to_rational());
            left.push(dense);
        }
        let mut rank = 0;
        for column in 0..unknowns {
            let Some(pivot) = (rank..left.len()).find(|row| !left[*row][column].is_zero()) else { continue };
            left.swap(rank, pivot);
            let (top, below) = left.split_at_mut(rank + 1);
            for row in below {
                let factor = &row[column] / &top[rank][column];
                row.iter_mut().zip(&top[rank]).for_each(|(a, b)| *a -= &factor * b);
            }
            rank += 1;
        }
        rank
    }

    proptest! {
        /// All equations hold, and as many unknowns as elimination in rationals leaves free are those of `near`, by one factor.
        #[test]
        fn what_is_free_stays(
            rows in prop::collection::vec(prop::collection::vec((0_usize..7, -40_i32..40, -3_i32..3), 1..5), 1..9),
            near in prop::collection::vec(-64_i32..64, 7),
        ) {
            let entry = |&(k, a, e): &(usize, i32, i32)| (k, f64::from(a) * f64::from(e).exp2() / 3.0);
            let rows: Vec<Vec<(usize, f64)>> = rows.iter().map(|row| row.iter().map(entry).collect()).collect();
            // None is 0.
            let near: Vec<f64> = near.into_iter().map(|y| f64::from(2 * y + 1) / 64.0).collect();
            let y = solved(7, &rows, &near);
            for row in &rows {
                prop_assert!(sum(row, &y).is_zero(), "{rows:?} {y:?}");
            }
            let share = |k: usize| y[k].to_rational() / Dyadic::from(near[k]).to_rational();
            let in_range = |k: &usize| (0.5..=1.0).contains(&(y[*k].to_f64() / near[*k]));
            let alike = |k: usize| (0..7).filter(|other| share(*other) == share(k)).count();
            let most = (0..7).filter(in_range).map(alike).max().unwrap_or(0);
            prop_assert!(most >= 7 - rank(&rows, 7), "{rows:?} {near:?} {y:?}");
        }
    }

    #[test]
    fn solutions_satisfy_every_equation_and_keep_the_free_unknowns() {
        // y0 + 2 y1 = 0, 3 y1 − y2 = 0, and their sum: one free unknown of these, and y3.
        let rows = [vec![(0, 1.0), (1, 2.0)], vec![(1, 3.0), (2, -1.0)]];
        let rows = [rows[0].clone(), rows[1].clone(), rows.concat()];
        let near = [-0.4, 0.2, 0.6, 0.125];
        let y = solved(4, &rows, &near);
        assert!(rows.iter().all(|row| sum(row, &y).is_zero()));
        let factor = y[3].to_f64() / near[3];
        assert!((0.5..=1.0).contains(&factor));
        assert!(y.iter().zip(near).all(|(y, near)| (y.to_f64() - factor * near).abs() < 1e-6 && !y.is_zero()));
        assert!(matches!(Equations::new(2, Instant::now()).nearest(&[1.0, 1.0]), Solved::Free));
    }

    /// y_k a_k = y_{k+1} b_k: numbers of some 100 bits more at every step, and each equation written with all that follow.
    #[test]
    fn a_chain_of_many_equations_is_quick() {
        let count = 60;
        let own = |k: usize| [(k, 1.0 / (k + 3) as f64), (k + 1, -1.0 / (k + 3) as f64 * (1.0 + 1.0 / (k + 7) as f64))];
        let rows: Vec<Vec<(usize, f64)>> = (0..count).map(|k| (k..count).flat_map(own).collect()).collect();
        let near: Vec<f64> = (0..=count).map(|k| 7.0 / (k + 7) as f64).collect();
        let y = solved(count + 1, &rows, &near);
        assert!(rows.iter().all(|row| sum(row, &y).is_zero()));
        let factor = y[0].to_f64();
        assert!(y.iter().zip(near).all(|(y, near)| (y.to_f64() / factor - near).abs() < 1e-9));
    }

    #[test]
    fn opposed_terms_of_one_unknown_are_no_equation() {
        let mut equations = Equations::new(1, soon());
        equations.add([(0, Dyadic::from(1.0)), (0, Dyadic::from(-1.0))]);
        assert!(matches!(equations.nearest(&[1.0]), Solved::Free));
    }
}
