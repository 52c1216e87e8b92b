//! Exact solution of integer linear systems by p-adic lifting (Dixon 1982), every result verified by exact
//! multiplication before it is returned.
//!
//! A x = b is solved modulo p^s digit by digit with the inverse of A modulo a prime p, then x = N / D is recovered
//! from the digits. Cost O(k² · bits) instead of the O(k³ · M(bits)) of fraction-free elimination. The elimination
//! modulo p also gives the rank; a deficit is proved by expressing the remaining rows and columns exactly.

use std::ops::ControlFlow;

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use crate::lcp::exact::modular::{LimbRow, Prime};
use crate::lcp::exact::scalar::BigInt;

/// x = numerators / denominator, denominator > 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Quotients {
    /// N.
    pub numerators: Vec<BigInt>,
    /// D > 0.
    pub denominator: BigInt,
}

/// What is known of A x = b.
#[derive(Clone, Debug, PartialEq)]
pub enum RationalSolution {
    /// A is nonsingular.
    Unique(Quotients),
    /// A is singular: its rank, and one solution if there is any.
    Singular {
        /// Rank of A, proved.
        rank: usize,
        /// Some solution; `None`: there is none, proved.
        particular: Option<Quotients>,
    },
    /// Stopped by the caller.
    Interrupted,
    /// Every prime of the list divides a determinant of the system (never seen).
    Unlucky,
}

/// The least common multiple of two integers > 0.
pub fn common_multiple(a: BigInt, b: &BigInt) -> BigInt {
    if (&a % b).is_zero() {
        return a;
    }
    // a / b in lowest terms: its denominator is what is still missing.
    let missing = BigRational::new(a.clone(), b.clone());
    a * missing.denom()
}

/// Multiplies a rational row by the smallest positive integer that makes it whole; returns that integer too.
pub fn clear_denominators(row: &[BigRational]) -> (Vec<BigInt>, BigInt) {
    let mut common = BigInt::one();
    for denominator in row.iter().map(BigRational::denom).filter(|denominator| !denominator.is_one()) {
        common = common_multiple(common, denominator);
    }
    let whole = row.iter().map(|entry| entry.numer() * (&common / entry.denom())).collect();
    (whole, common)
}

/// Σ a b of two rows with their denominators cleared: one greatest common divisor in all.
pub fn product((a, common): &(Vec<BigInt>, BigInt), (b, other): &(Vec<BigInt>, BigInt)) -> BigRational {
    let terms = a.iter().zip(b).filter(|(a, b)| !a.is_zero() && !b.is_zero());
    let sum: BigInt = terms.map(|(a, b)| a * b).sum();
    if sum.is_zero() { BigRational::zero() } else { BigRational::new(sum, common * other) }
}

/// Solves `matrix` x = `rhs` (square) exactly. `progress` hears a share of the work in 0 … 1 and may stop it.
pub fn solve(
    matrix: &[Vec<BigInt>],
    rhs: &[BigInt],
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> RationalSolution {
    let k = rhs.len();
    let Reduced { basis, particular, .. } = match reduced(matrix, rhs, progress) {
        Ok(found) => found,
        Err(end) => return end,
    };
    let rank = basis.rows.len();
    // Rows and columns were chosen in some order: the columns are put back.
    if rank == k {
        return RationalSolution::Unique(spread(&particular, &basis.columns, k));
    }
    let consistent = holds(matrix, &basis.columns, &particular, |row| &rhs[row]);
    RationalSolution::Singular { rank, particular: consistent.then(|| spread(&particular, &basis.columns, k)) }
}

/// A basis of {x : `matrix` x = 0} (square), exact and proved complete; `None` when stopped. `progress` as in
/// [`solve`].
pub fn null_space(
    matrix: &[Vec<BigInt>],
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<Vec<Vec<BigRational>>> {
    let k = matrix.len();
    let Reduced { basis, dependent, .. } = reduced(matrix, &vec![BigInt::zero(); k], progress).ok()?;
    let motion = |(column, combination): (usize, Quotients)| {
        let mut x = vec![BigRational::zero(); k];
        x[column] = BigRational::one();
        for (&c, numerator) in basis.columns.iter().zip(combination.numerators) {
            x[c] = -BigRational::new(numerator, combination.denominator.clone());
        }
        x
    };
    Some(dependent.into_iter().map(motion).collect())
}

/// Rank of a square matrix modulo a prime of 61 bits: never above its rank, and below it only where the prime divides a
/// minor.
pub fn rank_modulo_prime(matrix: &[Vec<BigInt>]) -> usize {
    independent(matrix, Prime::ALL[0], &mut || true).map_or(0, |basis| basis.rows.len())
}

/// A square system by its independent rows and columns.
struct Reduced {
    basis: Independent,
    /// Every other column as a combination of the chosen ones.
    dependent: Vec<(usize, Quotients)>,
    /// What solves the chosen rows, over the chosen columns.
    particular: Quotients,
}

/// Whether the combination of these columns is `right` in all rows, not only in the chosen ones.
fn holds<'a>(
    matrix: &[Vec<BigInt>],
    columns: &[usize],
    solution: &Quotients,
    right: impl Fn(usize) -> &'a BigInt,
) -> bool {
    (0..matrix.len()).all(|row| {
        let sum: BigInt = columns.iter().zip(&solution.numerators).map(|(c, n)| &matrix[row][*c] * n).sum();
        sum == right(row) * &solution.denominator
    })
}

/// The rank is proved; the error is [`RationalSolution::Interrupted`] or [`RationalSolution::Unlucky`].
fn reduced(
    matrix: &[Vec<BigInt>],
    rhs: &[BigInt],
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Reduced, RationalSolution> {
    let k = rhs.len();
    for prime in Prime::ALL {
        let Some(basis) = independent(matrix, prime, &mut || progress(0.0).is_continue()) else {
            return Err(RationalSolution::Interrupted);
        };
        // A nonzero minor modulo p is nonzero: the system of the chosen rows and columns is nonsingular.
        let square: Vec<Vec<BigInt>> =
            basis.rows.iter().map(|row| basis.columns.iter().map(|c| matrix[*row][*c].clone()).collect()).collect();
        let lifting = match Lifting::new(square, prime, &mut || progress(0.0).is_continue()) {
            ControlFlow::Break(()) => return Err(RationalSolution::Interrupted),
            ControlFlow::Continue(None) => continue,
            ControlFlow::Continue(Some(lifting)) => lifting,
        };
        let columns: Vec<usize> = (0..k).filter(|c| !basis.columns.contains(c)).collect();
        let shares = (columns.len() + 1) as f64;
        let mut done = 0.0;
        let mut lift = |b: Vec<BigInt>| {
            let lifted = lifting.solve(&b, &mut |share| progress((done + share) / shares));
            done += 1.0;
            match lifted {
                ControlFlow::Break(()) => Err(RationalSolution::Interrupted),
                ControlFlow::Continue(None) => Err(RationalSolution::Unlucky),
                ControlFlow::Continue(Some(quotients)) => Ok(quotients),
            }
        };
        let mut dependent = Vec::new();
        for column in columns {
            dependent.push((column, lift(basis.rows.iter().map(|row| matrix[*row][column].clone()).collect())?));
        }
        let particular = lift(basis.rows.iter().map(|row| rhs[*row].clone()).collect())?;
        let proved = |(column, solution): &(usize, Quotients)| {
            holds(matrix, &basis.columns, solution, |row| &matrix[row][*column])
        };
        // Else the rank is higher than it looks modulo this prime.
        if dependent.iter().all(proved) {
            return Ok(Reduced { basis, dependent, particular });
        }
    }
    Err(RationalSolution::Unlucky)
}

fn spread(solution: &Quotients, columns: &[usize], k: usize) -> Quotients {
    let mut numerators = vec![BigInt::zero(); k];
    for (column, n) in columns.iter().zip(&solution.numerators) {
        numerators[*column] = n.clone();
    }
    Quotients { numerators, denominator: solution.denominator.clone() }
}

struct Independent {
    rows: Vec<usize>,
    columns: Vec<usize>,
}

/// Rows and columns of a largest minor that is nonzero modulo p; `None` when stopped.
fn independent(matrix: &[Vec<BigInt>], p: Prime, go_on: &mut dyn FnMut() -> bool) -> Option<Independent> {
    let k = matrix.len();
    let mut a: Vec<Vec<u64>> = matrix.iter().map(|row| row.iter().map(|x| p.residue(x)).collect()).collect();
    let mut rows: Vec<usize> = (0..k).collect();
    let mut found = Independent { rows: Vec::new(), columns: Vec::new() };
    for column in 0..k {
        if !go_on() {
            return None;
        }
        let next = found.rows.len();
        let Some(pivot) = (next..k).find(|row| a[*row][column] != 0) else {
            continue;
        };
        a.swap(next, pivot);
        rows.swap(next, pivot);
        let over = p.inverse(a[next][column]);
        let (top, below) = a.split_at_mut(next + 1);
        let solved = &top[next][column..];
        for row in below {
            let factor = p.minus(p.times(row[column], over));
            if factor == 0 {
                continue;
            }
            row[column..].iter_mut().zip(solved).for_each(|(x, s)| *x = p.plus_product(*x, factor, *s));
        }
        found.rows.push(rows[next]);
        found.columns.push(column);
    }
    Some(found)
}

/// A nonsingular matrix with its inverse modulo p.
struct Lifting {
    matrix: Vec<Vec<BigInt>>,
    limbs: Vec<LimbRow>,
    inverse: Vec<Vec<u64>>,
    p: Prime,
}

impl Lifting {
    /// Continues with `None` where it is singular modulo p.
    fn new(matrix: Vec<Vec<BigInt>>, p: Prime, go_on: &mut dyn FnMut() -> bool) -> ControlFlow<(), Option<Self>> {
        let k = matrix.len();
        let mut a: Vec<Vec<u64>> = matrix
            .iter()
            .enumerate()
            .map(|(i, row)| {
                let unit = (0..k).map(|j| u64::from(i == j));
                row.iter().map(|x| p.residue(x)).chain(unit).collect()
            })
            .collect();
        for column in 0..k {
            if !go_on() {
                return ControlFlow::Break(());
            }
            let Some(pivot) = (column..k).find(|row| a[*row][column] != 0) else {
                return ControlFlow::Continue(None);
            };
            a.swap(column, pivot);
            let over = p.inverse(a[column][column]);
            a[column].iter_mut().for_each(|x| *x = p.times(*x, over));
            let solved = a[column].clone();
            for (i, row) in a.iter_mut().enumerate() {
                let factor = p.minus(row[column]);
                if i == column || factor == 0 {
                    continue;
                }
                // Columns before this one are done with.
                for (x, s) in row[column..].iter_mut().zip(&solved[column..]) {
                    if *s != 0 {
                        *x = p.plus_product(*x, factor, *s);
                    }
                }
            }
        }
        let inverse = a.into_iter().map(|row| row[k..].to_vec()).collect();
        let limbs = matrix.iter().map(|row| LimbRow::new(row)).collect();
        ControlFlow::Continue(Some(Self { matrix, limbs, inverse, p }))
    }

    /// inverse · b modulo p.
    fn digits(&self, b: &[BigInt]) -> Vec<u64> {
        let b: Vec<u64> = b.iter().map(|x| self.p.residue(x)).collect();
        self.inverse.iter().map(|row| self.p.dot(row, &b)).collect()
    }

    /// Steps that certainly suffice: p^s > 2 N D by Hadamard's bound.
    fn enough(&self, b: &[BigInt]) -> usize {
        let bits: u64 = self
            .matrix
            .iter()
            .zip(b)
            .map(|(row, b)| {
                let largest = row.iter().chain(std::iter::once(b)).map(BigInt::bits).max();
                largest.unwrap_or(0) + (row.len() as u64 + 1).ilog2() as u64 / 2 + 2
            })
            .sum();
        (2 * bits + 2) as usize / 60 + 2
    }

    fn solve(
        &self,
        b: &[BigInt],
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> ControlFlow<(), Option<Quotients>> {
        let prime = BigInt::from(self.p.value());
        let enough = self.enough(b);
        let mut rest = b.to_vec();
        let mut lifted = vec![Vec::<u64>::new(); b.len()];
        let mut attempt = 8;
        for step in 1..=enough {
            let digits = self.digits(&rest);
            for (rest, row) in rest.iter_mut().zip(&self.limbs) {
                // Divisible: A y ≡ rest modulo p.
                *rest = (std::mem::take(rest) - row.dot(&digits)) / self.p.value();
            }
            for (digits_of, y) in lifted.iter_mut().zip(digits) {
                digits_of.push(y);
            }
            let finished = rest.iter().all(Zero::is_zero);
            progress(step as f64 / enough as f64)?;
            if step == attempt || step == enough || finished {
                attempt += (attempt / 2).max(1);
                if let Some(solution) = self.recover(&lifted, &prime, step)
                    && self.verify(&solution, b)
                {
                    return ControlFlow::Continue(Some(solution));
                }
            }
        }
        ControlFlow::Continue(None)
    }

    /// N / D with |N|, D ≤ √(p^s / 2) from the digits; a guess until it is verified.
    fn recover(&self, lifted: &[Vec<u64>], prime: &BigInt, steps: usize) -> Option<Quotients> {
        let modulus = num_traits::pow(prime.clone(), steps);
        let half_bits = modulus.bits() / 2 - 1;
        let mut denominator = BigInt::one();
        let mut numerators: Vec<BigInt> = Vec::new();
        for digits in lifted {
            let x = digits.iter().rev().fold(BigInt::zero(), |sum, digit| sum * prime + BigInt::from(*digit));
            let residue = (x * &denominator) % &modulus;
            let symmetric = if (&residue << 1u32) > modulus { residue - &modulus } else { residue };
            if symmetric.bits() <= half_bits {
                numerators.push(symmetric);
                continue;
            }
            let (n, d) = rational(&symmetric, &modulus, half_bits)?;
            for previous in &mut numerators {
                *previous *= &d;
            }
            denominator *= &d;
            if denominator.bits() > half_bits {
                return None;
            }
            numerators.push(n);
        }
        Some(Quotients { numerators, denominator })
    }

    fn verify(&self, solution: &Quotients, b: &[BigInt]) -> bool {
        self.matrix.iter().zip(b).all(|(row, b)| {
            let sum: BigInt = row.iter().zip(&solution.numerators).map(|(a, n)| a * n).sum();
            sum == b * &solution.denominator
        })
    }
}

/// n / d ≡ x modulo `modulus` with n of at most `bits` bits, by Euclid's algorithm; d > 0.
fn rational(x: &BigInt, modulus: &BigInt, bits: u64) -> Option<(BigInt, BigInt)> {
    let (mut r0, mut r1) = (modulus.clone(), x.clone());
    if r1.is_negative() {
        r1 += modulus;
    }
    let (mut t0, mut t1) = (BigInt::zero(), BigInt::one());
    while r1.bits() > bits {
        let quotient = &r0 / &r1;
        let r2 = &r0 - &quotient * &r1;
        let t2 = &t0 - &quotient * &t1;
        (r0, r1) = (r1, r2);
        (t0, t1) = (t1, t2);
    }
    if t1.is_zero() || t1.bits() > bits + 2 {
        return None;
    }
    Some(if t1.is_negative() { (-r1, -t1) } else { (r1, t1) })
}

#[cfg(test)]
#[path = "rational_solve_tests.rs"]
mod tests;
