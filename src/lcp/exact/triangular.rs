//! A triangular M with a positive diagonal, its rows in any order: all principal minors are products of that diagonal,
//! so that every q has exactly one answer (Cottle, Pang & Stone 3.3.7), and each z follows from those before it.
//!
//! Lemke's algorithm may take 2ⁿ pivots there, and its numbers grow with every row.

use nalgebra::DMatrix;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::lcp::exact::dyadic::rational;

/// The rows in an order in which each depends on z of earlier rows and its own alone; `None` where there is none, or the
/// diagonal is not positive.
pub fn order(matrix: &DMatrix<f64>) -> Option<Vec<usize>> {
    let n = matrix.nrows();
    if (0..n).any(|i| matrix[(i, i)] <= 0.0) {
        return None;
    }
    let others = |i: usize| (0..n).filter(move |&j| j != i);
    let mut missing: Vec<usize> = (0..n).map(|i| others(i).filter(|&j| matrix[(i, j)] != 0.0).count()).collect();
    let mut order: Vec<usize> = (0..n).filter(|&i| missing[i] == 0).collect();
    for known in 0..n {
        let j = *order.get(known)?;
        for i in others(j).filter(|&i| matrix[(i, j)] != 0.0) {
            missing[i] -= 1;
            if missing[i] == 0 {
                order.push(i);
            }
        }
    }
    Some(order)
}

/// z of the one answer, without rounding; `None` where `go_on`, asked before every row, stops it.
pub fn answer(
    matrix: &DMatrix<f64>,
    q: &[f64],
    order: &[usize],
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Vec<BigRational>> {
    let mut z = vec![BigRational::zero(); q.len()];
    for (known, &i) in order.iter().enumerate() {
        if !go_on() {
            return None;
        }
        let mut w = rational(q[i]);
        for &j in order[..known].iter().filter(|&&j| matrix[(i, j)] != 0.0 && !z[j].is_zero()) {
            w += rational(matrix[(i, j)]) * &z[j];
        }
        if w.is_negative() {
            z[i] = -w / rational(matrix[(i, i)]);
        }
    }
    Some(z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// M of Murty 1978, for which Lemke's algorithm with d = e takes 2ⁿ pivots, in an order of its own: with q = −e
    /// the answer is e_1, since every other row has w = −1 + 2.
    #[test]
    fn murtys_rows_in_any_order() {
        let n = 40;
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut place: Vec<usize> = (0..n).collect();
        for last in (1..n).rev() {
            place.swap(last, random.random_range(0..=last));
        }
        let mut m = DMatrix::zeros(n, n);
        for i in 0..n {
            m[(place[i], place[i])] = 1.0;
            (0..i).for_each(|j| m[(place[i], place[j])] = 2.0);
        }
        let order = order(&m).expect("triangular");
        let z = answer(&m, &vec![-1.0; n], &order, &mut || true).expect("not stopped");
        let one: Vec<bool> = (0..n).map(|row| row == place[0]).collect();
        assert!(std::iter::zip(&z, one).all(|(z, one)| *z == rational(f64::from(u8::from(one)))));
        assert_eq!(answer(&m, &vec![-1.0; n], &order, &mut || false), None);
    }

    /// A cycle among rows, or a diagonal that is not positive, is no triangle.
    #[test]
    fn what_is_no_triangle() {
        let m = DMatrix::from_row_slice(3, 3, &[1.0, 2.0, 0.0, 0.0, 1.0, -1.0, 1.0, 0.0, 1.0]);
        assert_eq!(order(&m), None);
        assert_eq!(order(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 0.0, 0.0])), None);
        assert_eq!(order(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 0.0, 3.0])), Some(vec![1, 0]));
    }
}
