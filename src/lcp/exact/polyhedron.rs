//! {x : x = A y + b, x ≥ 0, y ≥ 0} as an exact dictionary in integers, the linear programming behind enumeration.
//!
//! Every variable is basic (a row) or nonbasic (a column, value 0):
//! ```text
//!   D · x_row = Σ a · x_column + a_last        D > 0, a integers (Edmonds: every entry is a minor of the data)
//! ```
//! Variables are ≥ 0, or free until they are [restricted](Polyhedron::restrict). A variable can be
//! [fixed](Polyhedron::fix) at zero: it leaves the dictionary for good. After every change the dictionary is made
//! feasible again by the least-index rule, which cannot cycle; a row with a negative constant and no positive entry is
//! the proof that nothing is left. No number is ever rounded, so every such statement is a proof about the data.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use crate::lcp::exact::dyadic::WholeRows;
use crate::lcp::exact::scalar::BigInt;

/// Whether anything is left of the polyhedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The present values (nonbasic variables 0) are one of its points.
    Feasible,
    /// It has no point: proved.
    Empty,
    /// Stopped by the caller; the dictionary is equivalent but need not be feasible.
    Stopped,
}

/// Asked before every pivot; false stops the work.
pub type GoOn<'a> = dyn FnMut() -> bool + 'a;

/// See the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Polyhedron {
    /// Variable of each row.
    basic: Vec<usize>,
    /// Variable of each column.
    nonbasic: Vec<usize>,
    /// Entries of each row, the constant last.
    rows: Vec<Vec<BigInt>>,
    /// D.
    denominator: BigInt,
    /// Of each variable: whether its sign is free.
    free: Vec<bool>,
    /// Of each variable: what stands in the dictionary is this times the variable (≠ 0).
    scale: Vec<BigInt>,
}

impl Polyhedron {
    /// `columns` nonbasic variables 0 … columns − 1 and one basic variable for each row of `given` (its coefficients and
    /// its constant), numbered on from there; `free` of those whose sign is free. Not yet feasible.
    pub fn new(columns: usize, given: WholeRows, free: &[usize]) -> Self {
        let count = columns + given.rows.len();
        let mut is_free = vec![false; count];
        for &variable in free {
            is_free[variable] = true;
        }
        let mut made = Self {
            basic: (columns..count).collect(),
            nonbasic: (0..columns).collect(),
            rows: given.rows,
            denominator: BigInt::one(),
            free: is_free,
            scale: std::iter::repeat_n(BigInt::one(), columns).chain(given.scale).collect(),
        };
        made.free_to_rows();
        made
    }

    /// Free variables become basic wherever they can: there they never block and never leave.
    fn free_to_rows(&mut self) {
        for column in 0..self.nonbasic.len() {
            if self.free[self.nonbasic[column]]
                && let Some(row) =
                    (0..self.rows.len()).find(|&r| !self.free[self.basic[r]] && !self.rows[r][column].is_zero())
            {
                self.pivot(row, column);
            }
        }
    }

    /// Number of nonbasic variables: 0 where the polyhedron is at most one point.
    pub fn dimension(&self) -> usize {
        self.nonbasic.len()
    }

    /// The nonbasic variables.
    pub fn nonbasic(&self) -> &[usize] {
        &self.nonbasic
    }

    /// The basic variables, one a row.
    pub fn basic(&self) -> &[usize] {
        &self.basic
    }

    /// Whether the sign of a variable is free.
    pub fn is_free(&self, variable: usize) -> bool {
        self.free[variable]
    }

    /// D.
    pub fn denominator(&self) -> &BigInt {
        &self.denominator
    }

    /// The row that proves that the polyhedron is empty: its constant is negative and nothing can make it grow.
    pub fn hopeless_row(&self) -> Option<usize> {
        (0..self.rows.len())
            .find(|&r| !self.free[self.basic[r]] && self.constant(r).is_negative() && self.helps(r).is_none())
    }

    /// Entry of a row and a column, up to the positive factor D.
    pub fn entry(&self, row: usize, column: usize) -> &BigInt {
        &self.rows[row][column]
    }

    /// Constant of a row, up to the positive factor D.
    pub fn constant(&self, row: usize) -> &BigInt {
        &self.rows[row][self.nonbasic.len()]
    }

    /// Row of a basic variable.
    pub fn row_of(&self, variable: usize) -> Option<usize> {
        self.basic.iter().position(|&v| v == variable)
    }

    /// Whether a variable is zero at the present values.
    pub fn is_zero(&self, variable: usize) -> bool {
        self.row_of(variable).is_none_or(|row| self.constant(row).is_zero())
    }

    /// Whether a variable is zero on the whole polyhedron because it left the dictionary or its row is zero.
    pub fn vanishes(&self, variable: usize) -> bool {
        match self.row_of(variable) {
            Some(row) => self.rows[row].iter().all(Zero::is_zero),
            None => !self.nonbasic.contains(&variable),
        }
    }

    /// Present value of a variable.
    pub fn value(&self, variable: usize) -> BigRational {
        match self.row_of(variable) {
            Some(row) => BigRational::new(self.constant(row).clone(), &self.denominator * &self.scale[variable]),
            None => BigRational::zero(),
        }
    }

    /// Rate of a variable where the nonbasic variable of `column` grows by one (in the dictionary's own units).
    pub fn rate(&self, variable: usize, column: usize) -> BigRational {
        match self.row_of(variable) {
            Some(row) => BigRational::new(self.rows[row][column].clone(), &self.denominator * &self.scale[variable]),
            None if self.nonbasic[column] == variable => BigRational::new(BigInt::one(), self.scale[variable].clone()),
            None => BigRational::zero(),
        }
    }

    /// Exchanges the basic variable of `row` for the nonbasic one of `column`; their entry must not be zero.
    pub fn pivot(&mut self, row: usize, column: usize) {
        let width = self.nonbasic.len() + 1;
        let pivot = self.rows[row][column].clone();
        let own = std::mem::take(&mut self.rows[row]);
        for (i, other) in self.rows.iter_mut().enumerate() {
            if i == row {
                continue;
            }
            if other[column].is_zero() {
                if pivot != self.denominator {
                    for entry in other.iter_mut().filter(|entry| !entry.is_zero()) {
                        *entry = &*entry * &pivot / &self.denominator;
                    }
                }
                continue;
            }
            let factor = other[column].clone();
            for j in (0..width).filter(|&j| j != column) {
                let mut sum = &other[j] * &pivot;
                if !own[j].is_zero() {
                    sum -= &factor * &own[j];
                }
                if !sum.is_zero() && !self.denominator.is_one() {
                    sum /= &self.denominator;
                }
                other[j] = sum;
            }
        }
        self.rows[row] = own
            .into_iter()
            .enumerate()
            .map(|(j, entry)| if j == column { self.denominator.clone() } else { -entry })
            .collect();
        self.denominator = pivot;
        if self.denominator.is_negative() {
            self.denominator = -&self.denominator;
            for entry in self.rows.iter_mut().flatten() {
                *entry = -&*entry;
            }
        }
        std::mem::swap(&mut self.basic[row], &mut self.nonbasic[column]);
    }

    fn drop_column(&mut self, column: usize) {
        self.nonbasic.remove(column);
        for row in &mut self.rows {
            row.remove(column);
        }
    }

    /// Makes the dictionary feasible by the least-index rule.
    pub fn restore(&mut self, go_on: &mut GoOn) -> State {
        loop {
            let broken = (0..self.rows.len())
                .filter(|&r| !self.free[self.basic[r]] && self.constant(r).is_negative())
                .min_by_key(|&r| self.basic[r]);
            let Some(row) = broken else {
                return State::Feasible;
            };
            let Some(column) = self.helps(row) else {
                return State::Empty;
            };
            if !go_on() {
                return State::Stopped;
            }
            self.pivot(row, column);
        }
    }

    /// The column of least index along which the variable of `row` can grow.
    fn helps(&self, row: usize) -> Option<usize> {
        (0..self.nonbasic.len())
            .filter(|&c| {
                let entry = &self.rows[row][c];
                entry.is_positive() || (self.free[self.nonbasic[c]] && !entry.is_zero())
            })
            .min_by_key(|&c| (!self.free[self.nonbasic[c]], self.nonbasic[c]))
    }

    /// Replaces a variable by its negative.
    pub fn negate(&mut self, variable: usize) {
        self.scale[variable] = -&self.scale[variable];
        if let Some(row) = self.row_of(variable) {
            for entry in &mut self.rows[row] {
                *entry = -&*entry;
            }
        } else if let Some(column) = self.nonbasic.iter().position(|&v| v == variable) {
            for row in &mut self.rows {
                row[column] = -&row[column];
            }
        }
    }

    /// A free variable is ≥ 0 from now on.
    pub fn restrict(&mut self, variable: usize, go_on: &mut GoOn) -> State {
        self.free[variable] = false;
        self.restore(go_on)
    }

    /// A variable is zero from now on and leaves the dictionary.
    pub fn fix(&mut self, variable: usize, go_on: &mut GoOn) -> State {
        if let Some(row) = self.row_of(variable) {
            let sign = self.constant(row).signum();
            // Any column will do where the variable is zero already: no constant changes.
            let column = if sign.is_zero() {
                (0..self.nonbasic.len()).find(|&c| !self.rows[row][c].is_zero())
            } else {
                (0..self.nonbasic.len())
                    .filter(|&c| {
                        let towards = (&self.rows[row][c] * &sign).is_negative();
                        towards || (self.free[self.nonbasic[c]] && !self.rows[row][c].is_zero())
                    })
                    .min_by_key(|&c| (!self.free[self.nonbasic[c]], self.nonbasic[c]))
            };
            match column {
                Some(column) => {
                    if !go_on() {
                        return State::Stopped;
                    }
                    self.pivot(row, column);
                }
                None if sign.is_zero() => {
                    self.rows.remove(row);
                    self.basic.remove(row);
                    return self.restore(go_on);
                }
                None => return State::Empty,
            }
        }
        if let Some(column) = self.nonbasic.iter().position(|&v| v == variable) {
            self.drop_column(column);
        }
        self.restore(go_on)
    }
}
