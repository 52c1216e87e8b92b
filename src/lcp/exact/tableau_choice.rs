//! What leaves: zero tests, the ratio test, the tie rules.

use std::cmp::Ordering;

use rand::Rng;

use super::{Place, Tableau, Undecided};
use crate::lcp::exact::scalar::Scalar;
use crate::lcp::problem::NOISE;
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;

/// Relative difference below which two f64 entries of B⁻¹ / pivot count as equal in the lexicographic rule.
const LEXICOGRAPHIC_NOISE: f64 = 1e-10;
/// Scaled size of a direction or a vertex: Σ column_k |z_k| and |p|.
#[derive(Clone, Copy, Default)]
pub(super) struct Size {
    pub(super) z: f64,
    pub(super) p: f64,
    pub(super) q: bool,
}

impl<T: Scalar> Tableau<T> {
    /// Size of the vertex reached when the entering variable of column `column` has moved by `t`.
    pub(super) fn vertex_size(&self, column: usize, t: f64) -> Size {
        let mut size = Size { q: true, ..Size::default() };
        for (row, variable) in self.basic.iter().enumerate() {
            let moved = self.values[row].to_f64().abs() + t * self.rows[row][column].to_f64().abs();
            self.count(&mut size, *variable, moved);
        }
        self.count(&mut size, self.nonbasic[column], t);
        size
    }

    /// Size of the direction of column `column`.
    pub(super) fn direction_size(&self, column: usize) -> Size {
        let mut size = Size::default();
        for (row, variable) in self.basic.iter().enumerate() {
            self.count(&mut size, *variable, self.rows[row][column].to_f64().abs());
        }
        self.count(&mut size, self.nonbasic[column], 1.0);
        size
    }

    pub(super) fn count(&self, size: &mut Size, variable: Variable, amount: f64) {
        match variable {
            Variable::W(_) => {}
            Variable::Z(k) => size.z += self.lcp.scale.column[k] * amount,
            Variable::P => size.p += amount,
        }
    }

    /// Largest amount of `variable` that counts as zero beside a direction or vertex of this size.
    pub(super) fn noise(&self, variable: Variable, size: Size) -> f64 {
        let q = |i: usize| {
            if size.q { self.lcp.q[i].to_f64().abs() } else { 0.0 }
        };
        NOISE
            * match variable {
                Variable::W(i) => self.lcp.scale.row[i] * size.z + self.lcp.covering[i].to_f64() * size.p + q(i),
                Variable::Z(k) => (size.z + self.weight_of_p * size.p) / self.lcp.scale.column[k],
                Variable::P => size.z / self.weight_of_p + size.p,
            }
    }

    /// Sign of a number of `variable`; in f64 up to its noise.
    pub(super) fn sign(&self, number: &T, variable: Variable, size: Size) -> Result<Ordering, Undecided> {
        let sign = number.sign().ok_or(Undecided(variable))?;
        if !T::is_exact() && number.to_f64().abs() <= self.noise(variable, size) {
            return Ok(Ordering::Equal);
        }
        Ok(sign)
    }

    /// Coefficient of the perturbation of row `j` of the LCP in row `row` of the dictionary: entry (row, j) of B⁻¹.
    pub(super) fn inverse_entry(&self, row: usize, j: usize) -> T {
        match self.place(Variable::W(j)) {
            Place::Column(column) => self.rows[row][column].neg(),
            Place::Row(own) if own == row => T::one(),
            Place::Row(_) => T::zero(),
        }
    }

    /// Order of the rows, p last.
    pub(super) fn rank(&self, row: usize) -> (bool, usize) {
        (self.basic[row] == Variable::P, row)
    }

    /// Chooses among tied rows (not empty, ordered by [`Tableau::rank`]).
    pub(super) fn choose(&mut self, ties: &[usize], column: usize) -> Result<usize, Undecided> {
        if ties.len() == 1 {
            return Ok(ties[0]);
        }
        if let Some(random) = &mut self.random {
            return Ok(ties[random.random_range(0..ties.len())]);
        }
        let order = match &self.rule {
            TieRule::Lexicographic(order) => order,
            TieRule::FirstRow | TieRule::Random(_) => return Ok(ties[0]),
        };
        if let Some(row) = ties.iter().find(|row| self.basic[**row] == Variable::P) {
            return Ok(*row);
        }
        let mut best = ties[0];
        for &row in &ties[1..] {
            if self.lexicographic(row, best, column, order)? == Ordering::Less {
                best = row;
            }
        }
        Ok(best)
    }

    /// Compares two rows of B⁻¹, each divided by the size of its pivot.
    pub(super) fn lexicographic(
        &self,
        first: usize,
        second: usize,
        column: usize,
        order: &[usize],
    ) -> Result<Ordering, Undecided> {
        // At the entry of p the pivots are d > 0, later a < 0: their sizes count.
        let size = |row: usize| {
            let a = &self.rows[row][column];
            if self.pivots.is_empty() { a.clone() } else { a.neg() }
        };
        let (u_size, v_size) = (size(first), size(second));
        for &j in order {
            let u = self.inverse_entry(first, j).mul(&v_size);
            let v = self.inverse_entry(second, j).mul(&u_size);
            let sign = u.compare(&v).ok_or(Undecided(self.basic[first]))?;
            if sign == Ordering::Equal {
                continue;
            }
            if !T::is_exact() {
                let (u, v) = (u.to_f64(), v.to_f64());
                if (u - v).abs() <= LEXICOGRAPHIC_NOISE * (u.abs() + v.abs()) {
                    continue;
                }
                // Noise beside an entry that should be zero.
                let unit = (u_size.to_f64() * v_size.to_f64()).abs();
                if (u - v).abs() <= NOISE * unit.min(1.0) {
                    continue;
                }
            }
            return Ok(sign);
        }
        Ok(Ordering::Equal)
    }

    /// Entry of p: the rows that need the largest p, or none when q ≥ 0.
    pub(super) fn start(&mut self) -> Result<Option<Vec<usize>>, Undecided> {
        let n = self.lcp.size();
        let mut best: Option<(T, Vec<usize>)> = None;
        for i in 0..n {
            let variable = Variable::W(i);
            if self.values[i].sign().ok_or(Undecided(variable))? != Ordering::Less {
                continue;
            }
            let need = self.values[i].neg().div(&self.lcp.covering[i]);
            best = Some(match best {
                None => (need, vec![i]),
                Some((largest, mut rows)) => {
                    let order = self.compare_ratios(&need, &largest, variable)?;
                    match order {
                        Ordering::Greater => (need, vec![i]),
                        Ordering::Equal => {
                            rows.push(i);
                            (largest, rows)
                        }
                        Ordering::Less => (largest, rows),
                    }
                }
            });
        }
        Ok(best.map(|(_, rows)| rows))
    }

    pub(super) fn compare_ratios(&self, a: &T, b: &T, variable: Variable) -> Result<Ordering, Undecided> {
        let order = a.compare(b).ok_or(Undecided(variable))?;
        if !T::is_exact() {
            let (a, b) = (a.to_f64(), b.to_f64());
            if (a - b).abs() <= NOISE * a.abs().max(b.abs()) {
                return Ok(Ordering::Equal);
            }
        }
        Ok(order)
    }

    /// Rows that block the entering variable of `column` at the smallest value, in the order of the rows.
    pub(super) fn ratio_test(&self, column: usize) -> Result<Vec<usize>, Undecided> {
        let size = self.direction_size(column);
        let mut candidates: Vec<(usize, T)> = Vec::new();
        for (row, variable) in self.basic.iter().enumerate() {
            let a = &self.rows[row][column];
            if self.sign(a, *variable, size)? != Ordering::Less {
                continue;
            }
            let value = &self.values[row];
            let ratio = match value.sign().ok_or(Undecided(*variable))? {
                Ordering::Greater => value.div(&a.neg()),
                _ => T::zero(),
            };
            candidates.push((row, ratio));
        }
        let Some((first, rest)) = candidates.split_first() else {
            return Ok(Vec::new());
        };
        let mut smallest = &first.1;
        for (row, ratio) in rest {
            if ratio.compare(smallest).ok_or(Undecided(self.basic[*row]))? == Ordering::Less {
                smallest = ratio;
            }
        }
        let vertex = (!T::is_exact()).then(|| self.vertex_size(column, smallest.to_f64()));
        let mut ties = Vec::new();
        for (row, ratio) in &candidates {
            let variable = self.basic[*row];
            let tied = match vertex {
                None => ratio.compare(smallest).ok_or(Undecided(variable))? == Ordering::Equal,
                Some(vertex) => {
                    let left = (ratio.to_f64() - smallest.to_f64()) * self.rows[*row][column].to_f64().abs();
                    left <= self.noise(variable, vertex)
                }
            };
            if tied {
                ties.push(*row);
            }
        }
        ties.sort_by_key(|row| self.rank(*row));
        Ok(ties)
    }
}
