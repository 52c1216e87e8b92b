//! When two answers are one.

use super::record::{Answer, PairState};

/// Values may differ by this share of the largest of their kind: an answer passes its check with violations of some
/// 1e-9 of its terms, which the condition number of its scheme magnifies.
const SAME: f64 = 1e-7;

/// Whether numbers of one kind are the same, as shares of the largest of them.
fn near(a: &[f64], b: &[f64]) -> bool {
    let size = a.iter().chain(b).fold(0.0, |size: f64, value| size.max(value.abs()));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * size)
}

/// Whether two lists of pairs have the same forces and displacements, each by their own size. A pair on a limit may be
/// classified either way, so the states in words are not compared.
pub fn same_pairs(a: &[PairState], b: &[PairState]) -> bool {
    let values =
        |pairs: &[PairState], pick: fn(&PairState) -> [f64; 2]| -> Vec<f64> { pairs.iter().flat_map(pick).collect() };
    let alike = |pick: fn(&PairState) -> [f64; 2]| near(&values(a, pick), &values(b, pick));
    alike(|pair| [pair.x_n, pair.x_t]) && alike(|pair| [pair.z_n, pair.z_t])
}

/// Whether two results are both answers, or both none, and have the same values: of the pairs, or z of a bare LCP.
pub fn same_answer(a: &Answer, b: &Answer) -> bool {
    a.is_answer() == b.is_answer()
        && match (&a.solution, &b.solution) {
            (Some(a), Some(b)) => near(&a.z, &b.z),
            (None, None) => same_pairs(&a.pairs, &b.pairs),
            _ => false,
        }
}
