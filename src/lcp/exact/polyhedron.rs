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
//! To write the proof down, the factors of the fixed variables are needed too: a dictionary that
//! [keeps](Polyhedron::keep_fixed) them has it.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use crate::lcp::exact::dyadic::WholeRows;
use crate::lcp::exact::rational_solve::clear_denominators;
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
    /// For each variable, whether its sign is free.
    free: Vec<bool>,
    /// For each variable, the factor ≠ 0: what stands in the dictionary is the variable times this.
    scale: Vec<BigInt>,
    /// From this variable on, those that are fixed keep their columns.
    keeps_from: usize,
    /// For each variable, whether it is fixed and still has a column.
    fixed: Vec<bool>,
}

impl Polyhedron {
    /// `columns` nonbasic variables 0 … columns − 1 and one basic variable for each row of `given` (its coefficients
    /// and its constant), numbered on from there; `free` of those whose sign is free. Not yet feasible.
    pub fn new(columns: usize, given: WholeRows, free: &[usize]) -> Self {
        let count = columns + given.rows.len();
        let mut is_free = vec![false; count];
        for &variable in free {
            is_free[variable] = true;
        }
        Self {
            basic: (columns..count).collect(),
            nonbasic: (0..columns).collect(),
            rows: given.rows,
            denominator: BigInt::one(),
            free: is_free,
            scale: std::iter::repeat_n(BigInt::one(), columns).chain(given.scale).collect(),
            keeps_from: usize::MAX,
            fixed: vec![false; count],
        }
    }

    /// Makes it feasible for the first time. Free variables become basic wherever they can: there they never block and
    /// never leave.
    pub fn start(&mut self, go_on: &mut GoOn) -> State {
        for column in 0..self.nonbasic.len() {
            if self.free[self.nonbasic[column]]
                && let Some(row) =
                    (0..self.rows.len()).find(|&r| !self.free[self.basic[r]] && !self.rows[r][column].is_zero())
            {
                if !go_on() {
                    return State::Stopped;
                }
                self.pivot(row, column);
            }
        }
        self.restore(go_on)
    }

    /// From now on variables that are fixed keep their columns, for [`Polyhedron::contradiction`]: all from number
    /// `first` on.
    #[must_use]
    pub fn keep_fixed(mut self, first: usize) -> Self {
        self.keeps_from = first;
        self
    }

    /// Without the columns of fixed variables, and of those that are fixed from now on, as the search for corners needs
    /// it.
    #[must_use]
    pub fn without_fixed(mut self) -> Self {
        self.keeps_from = usize::MAX;
        while let Some(column) = self.nonbasic.iter().position(|&variable| self.fixed[variable]) {
            self.drop_column(column);
        }
        self
    }

    /// For an empty polyhedron: factors of variables (in the user's units) whose sum is a negative number, whatever the
    /// values; and this number. Factors of variables ≥ 0 are ≥ 0; fixed variables, where they are kept, may have any.
    /// `pinned` is the variable whose fixing at zero was refused, if that emptied it.
    pub fn contradiction(&self, pinned: Option<usize>) -> Option<(Vec<(usize, BigInt)>, BigInt)> {
        let hopeless = self.hopeless_row().map(|row| (row, false));
        let refused = || {
            let row = self.row_of(pinned?)?;
            let sign = self.constant(row).signum();
            let stuck = !sign.is_zero() && self.towards(row, &sign).is_none();
            stuck.then_some((row, sign.is_positive()))
        };
        let (row, turned) = hopeless.or_else(refused)?;
        // D · x_row − Σ a x_column = constant, or the same with the other sign.
        let signed = |value: BigInt| if turned { -value } else { value };
        let own = (self.basic[row], signed(&self.denominator * &self.scale[self.basic[row]]));
        let others = self
            .nonbasic
            .iter()
            .enumerate()
            .map(|(column, &variable)| (variable, signed(-(&self.rows[row][column] * &self.scale[variable]))));
        let factors = std::iter::once(own).chain(others).filter(|(_, factor)| !factor.is_zero()).collect();
        Some((factors, signed(self.constant(row).clone())))
    }

    /// For a feasible polyhedron: factors ≥ 0 of variables whose sum is 0 whatever the values, > 0 for every column, so
    /// that all these variables are 0; `None` where the polyhedron is more than the present point. Columns of fixed
    /// variables must be kept.
    pub fn only_point(&self, go_on: &mut GoOn) -> Option<Vec<(usize, BigInt)>> {
        let live: Vec<usize> = (0..self.nonbasic.len()).filter(|&c| !self.fixed[self.nonbasic[c]]).collect();
        if live.iter().any(|&c| self.free[self.nonbasic[c]]) {
            return None;
        }
        let tight: Vec<usize> =
            (0..self.rows.len()).filter(|&r| !self.free[self.basic[r]] && self.constant(r).is_zero()).collect();
        // Factors y of these rows with −Σ y a ≥ 1 in every column.
        let mut rows = WholeRows::default();
        for &column in &live {
            rows.rows.push(tight.iter().map(|&r| -&self.rows[r][column]).chain([-BigInt::one()]).collect());
            rows.scale.push(BigInt::one());
        }
        let mut dual = Polyhedron::new(tight.len(), rows, &[]);
        if dual.start(go_on) != State::Feasible {
            return None;
        }
        let (factors, common) = clear_denominators(&(0..tight.len()).map(|k| dual.value(k)).collect::<Vec<_>>());
        debug_assert!(common.is_positive());
        let mut sum: Vec<(usize, BigInt)> = Vec::new();
        for (&row, factor) in tight.iter().zip(&factors) {
            sum.push((self.basic[row], factor * &self.denominator * &self.scale[self.basic[row]]));
        }
        for (column, &variable) in self.nonbasic.iter().enumerate() {
            let entry: BigInt = tight.iter().zip(&factors).map(|(&r, y)| y * &self.rows[r][column]).sum();
            sum.push((variable, -(entry * &self.scale[variable])));
        }
        sum.retain(|(_, factor)| !factor.is_zero());
        Some(sum)
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

    /// Whether a variable is zero on the whole polyhedron because it is fixed or its row is zero.
    pub fn vanishes(&self, variable: usize) -> bool {
        match self.row_of(variable) {
            Some(row) => {
                let live = |column: usize| self.nonbasic.get(column).is_none_or(|&variable| !self.fixed[variable]);
                self.rows[row].iter().enumerate().all(|(column, entry)| entry.is_zero() || !live(column))
            }
            None => self.fixed[variable] || !self.nonbasic.contains(&variable),
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
    fn restore(&mut self, go_on: &mut GoOn) -> State {
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

    /// [Fixes](Polyhedron::fix) variables at zero, one after the other as long as anything is left; returns the state
    /// and the variable that was fixed last.
    pub fn fix_all(&mut self, variables: impl IntoIterator<Item = usize>, go_on: &mut GoOn) -> (State, Option<usize>) {
        let mut last = None;
        for variable in variables {
            last = Some(variable);
            let state = self.fix(variable, go_on);
            if state != State::Feasible {
                return (state, last);
            }
        }
        (State::Feasible, last)
    }

    /// [Fixes](Polyhedron::fix_all) the variables `zero`, then [restricts](Polyhedron::restrict) those of `signs`, (variable,
    /// whether it is ≥ 0 and not ≤ 0), as long as anything is left; returns the state and the variable whose fixing, if that
    /// was the last step, led to it.
    pub fn impose(
        &mut self,
        zero: impl IntoIterator<Item = usize>,
        signs: impl IntoIterator<Item = (usize, bool)>,
        go_on: &mut GoOn,
    ) -> (State, Option<usize>) {
        let (mut state, mut pinned) = self.fix_all(zero, go_on);
        for (variable, up) in signs {
            if state != State::Feasible {
                break;
            }
            if !up {
                self.negate(variable);
            }
            (state, pinned) = (self.restrict(variable, go_on), None);
        }
        (state, pinned)
    }

    /// The column of least index along which the variable of `row` can grow.
    fn helps(&self, row: usize) -> Option<usize> {
        self.towards(row, &-BigInt::one())
    }

    /// The column of least index along which the variable of `row`, whose sign is `sign`, gets nearer to zero.
    fn towards(&self, row: usize, sign: &BigInt) -> Option<usize> {
        (0..self.nonbasic.len())
            .filter(|&c| {
                let (entry, variable) = (&self.rows[row][c], self.nonbasic[c]);
                let nearer = if sign.is_positive() { entry.is_negative() } else { entry.is_positive() };
                !self.fixed[variable] && (nearer || (self.free[variable] && !entry.is_zero()))
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
                (0..self.nonbasic.len()).find(|&c| !self.fixed[self.nonbasic[c]] && !self.rows[row][c].is_zero())
            } else {
                self.towards(row, &sign)
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
            if variable >= self.keeps_from {
                self.fixed[variable] = true;
            } else {
                self.drop_column(column);
            }
        }
        self.restore(go_on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y − x ≥ 0 and 3 − y ≥ 0, x free: the first pivot, that of x, is asked for already.
    #[test]
    fn it_can_be_stopped_from_the_first_pivot_on() {
        let made = || {
            let mut rows = WholeRows::default();
            rows.push(&[-1.0, 1.0, 0.0]);
            rows.push(&[0.0, -1.0, 3.0]);
            Polyhedron::new(2, rows, &[0])
        };
        assert_eq!(made().start(&mut || false), State::Stopped);
        let (mut asked, mut whole) = (0, made());
        let state = whole.start(&mut || {
            asked += 1;
            true
        });
        assert_eq!((state, asked, whole.basic().contains(&0)), (State::Feasible, 1, true));
    }
}
