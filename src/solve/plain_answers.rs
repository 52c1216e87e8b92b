//! All answers of a small bare LCP: every complementary basis in exact rationals.

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::lcp::mirrored::MirroredLcp;
use crate::watch::Watch;

/// Most rows: 2ⁿ bases are solved.
pub const MOST_ROWS: usize = 9;

/// What the bases gave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlainAnswers {
    /// z of every answer, each once.
    pub answers: Vec<Vec<f64>>,
    /// No basis was singular with solutions: nothing can have been missed.
    pub complete: bool,
    /// Number of bases.
    pub visited: u64,
    /// Bases that are singular and have solutions: they were not searched.
    pub singular: u64,
}

/// The final basis of a bare LCP in exact arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainCheck {
    /// Whether its equations have one solution.
    pub unique: bool,
    /// Negative variables: `z` or `w`, row, value rounded.
    pub violations: Vec<(char, usize, f64)>,
    /// Basic variables that are exactly zero.
    pub zeros: Vec<(char, usize)>,
}

/// Solves a basis exactly and tells every sign; `None` for more than 100 rows.
pub fn check_plain_exactly(lcp: &MirroredLcp, basis: &[usize]) -> Option<PlainCheck> {
    let n = lcp.size();
    if n > 100 || lcp.whole_size != n {
        return None;
    }
    let m = exact_matrix(lcp);
    let q: Vec<BigRational> = lcp.q.iter().map(|v| exact(*v)).collect();
    let mut check = PlainCheck { unique: false, violations: Vec::new(), zeros: Vec::new() };
    let Basis::One(z) = solve(&m, &q, basis) else {
        return Some(check);
    };
    check.unique = true;
    let mut tell = |letter: char, row: usize, value: &BigRational| {
        if value.is_negative() {
            check.violations.push((letter, row, nearest(value)));
        } else if value.is_zero() {
            check.zeros.push((letter, row));
        }
    };
    for (&i, value) in basis.iter().zip(&z) {
        tell('z', i, value);
    }
    for i in (0..n).filter(|i| !basis.contains(i)) {
        let sum: BigRational = basis.iter().zip(&z).map(|(&j, z)| &m[i][j] * z).sum();
        tell('w', i, &(sum + &q[i]));
    }
    Some(check)
}

/// M, row by row.
fn exact_matrix(lcp: &MirroredLcp) -> Vec<Vec<BigRational>> {
    let matrix = lcp.matrix();
    matrix.row_iter().map(|row| row.iter().map(|entry| exact(*entry)).collect()).collect()
}

fn exact(value: f64) -> BigRational {
    <BigRational as crate::lcp::scalar::Scalar>::from_f64(value)
}

/// Goes through all bases; `None` for more than [`MOST_ROWS`] rows or when stopped.
pub fn all_plain_answers(lcp: &MirroredLcp, watch: &dyn Watch) -> Option<PlainAnswers> {
    let n = lcp.size();
    if n > MOST_ROWS || lcp.whole_size != n {
        return None;
    }
    let m = exact_matrix(lcp);
    let q: Vec<BigRational> = lcp.q.iter().map(|v| exact(*v)).collect();
    let mut found = PlainAnswers { answers: Vec::new(), complete: true, visited: 1 << n, singular: 0 };
    let mut exact_answers: Vec<Vec<BigRational>> = Vec::new();
    for basis in 0..1usize << n {
        if watch.stop() {
            return None;
        }
        let on: Vec<usize> = (0..n).filter(|i| basis >> i & 1 == 1).collect();
        let z_on = match solve(&m, &q, &on) {
            Basis::One(z) => z,
            Basis::None => continue,
            Basis::Many => {
                found.complete = false;
                found.singular += 1;
                continue;
            }
        };
        if z_on.iter().any(Signed::is_negative) {
            continue;
        }
        let mut z = vec![BigRational::zero(); n];
        for (&i, value) in on.iter().zip(z_on) {
            z[i] = value;
        }
        let holds = (0..n).all(|i| {
            let w: BigRational = on.iter().map(|&j| &m[i][j] * &z[j]).sum::<BigRational>() + &q[i];
            !w.is_negative()
        });
        if holds && !exact_answers.contains(&z) {
            found.answers.push(z.iter().map(nearest).collect());
            exact_answers.push(z);
        }
    }
    Some(found)
}

enum Basis {
    One(Vec<BigRational>),
    None,
    Many,
}

/// Solves M_SS z_S = −q_S.
fn solve(m: &[Vec<BigRational>], q: &[BigRational], on: &[usize]) -> Basis {
    let k = on.len();
    let mut a: Vec<Vec<BigRational>> = on
        .iter()
        .map(|&i| {
            let mut row: Vec<BigRational> = on.iter().map(|&j| m[i][j].clone()).collect();
            row.push(-q[i].clone());
            row
        })
        .collect();
    let mut rank = 0;
    for c in 0..k {
        let Some(pivot) = (rank..k).find(|&r| !a[r][c].is_zero()) else {
            continue;
        };
        a.swap(rank, pivot);
        let factor = a[rank][c].recip();
        a[rank].iter_mut().for_each(|v| *v *= &factor);
        let row = a[rank].clone();
        for (r, other) in a.iter_mut().enumerate() {
            if r != rank && !other[c].is_zero() {
                let factor = other[c].clone();
                for (v, p) in other.iter_mut().zip(&row) {
                    *v -= &factor * p;
                }
            }
        }
        rank += 1;
    }
    if a[rank..].iter().any(|row| !row[k].is_zero()) {
        return Basis::None;
    }
    if rank < k {
        return Basis::Many;
    }
    Basis::One(a.into_iter().map(|mut row| row.swap_remove(k)).collect())
}

fn nearest(value: &BigRational) -> f64 {
    crate::lcp::scalar::Scalar::to_f64(value)
}
