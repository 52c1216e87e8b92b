//! The fresh check of an answer of a bare LCP, from M and q alone.

use super::record::Check;
use crate::doubled::Sum;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::problem::NOISE;

/// Checks z ≥ 0, w = M z + q ≥ 0 and w_i = 0 where z_i > 0. Every w_i is judged against the sum of the magnitudes of
/// its own terms, so that no row hides behind the size of another one; z_i has no terms and must not be negative at
/// all. `tolerance`: the share of that sum that passes as rounding, [`ROW_ROUNDING`] for an answer that is not marginal.
pub fn check_plain(lcp: &MirroredLcp, z: &[f64], tolerance: f64) -> Check {
    check_rows(&rows(lcp, z), z, tolerance)
}

/// The same of z whose [`rows`] are known.
pub fn check_rows(rows: &[Sum], z: &[f64], tolerance: f64) -> Check {
    let length = z.iter().fold(0.0, |a: f64, z| a.max(z.abs()));
    let mut check = Check::default();
    let mut sound = z.iter().all(|z| z.is_finite());
    for (row, &z_i) in rows.iter().zip(z) {
        let w = row.relative();
        check.min_w = check.min_w.min(w);
        check.min_z = check.min_z.min(if length > 0.0 { z_i / length } else { 0.0 });
        if z_i != 0.0 {
            check.complementarity = check.complementarity.max(w.abs());
        }
        sound &= w.is_finite();
    }
    check.passed = sound && check.min_z >= 0.0 && check.min_w >= -tolerance && check.complementarity <= tolerance;
    check
}

/// Every w_i of a bare LCP.
pub fn rows(lcp: &MirroredLcp, z: &[f64]) -> Vec<Sum> {
    (0..z.len()).map(|i| row(lcp, z, i)).collect()
}

/// w_i = q_i + Σ M_ij z_j in doubled precision, of a bare LCP.
pub fn row(lcp: &MirroredLcp, z: &[f64], i: usize) -> Sum {
    let mut sum = Sum::default();
    sum.add(lcp.q[i]);
    for (j, &z) in z.iter().enumerate().filter(|(_, z)| **z != 0.0) {
        sum.add_product(lcp.base[(i, j)], z);
    }
    sum
}

/// Largest share of its own terms by which a row of a bare LCP may be violated.
pub const ROW_ROUNDING: f64 = NOISE;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lcp::problem::{Lcp, Scale};

    fn lcp(matrix: &[&[f64]], q: &[f64]) -> MirroredLcp {
        let matrix: Vec<Vec<f64>> = matrix.iter().map(|row| row.to_vec()).collect();
        MirroredLcp::plain(&Lcp { scale: Scale::plain(&matrix), matrix, q: q.to_vec(), covering: vec![1.0; q.len()] })
    }

    /// A row of the Stewart–Trinkle form, w = μ r_n − t⁺ − t⁻, whose terms are as small as the others' noise, beside rows
    /// of ordinary size.
    #[test]
    fn a_row_is_judged_by_its_own_terms() {
        let m: &[&[f64]] = &[&[1.0, 0.0, 0.0], &[0.0, 0.5, -1.0], &[0.0, 0.0, 1.0]];
        let q = [-1.0, 0.0, -1e-17];
        // w_2 = 0.5 · 2e-17 − 1e-17 = 0.
        assert!(check_plain(&lcp(m, &q), &[1.0, 2e-17, 1e-17], ROW_ROUNDING).passed);
        // It is short by a tenth of what it sums, though that is nothing beside the first row.
        let check = check_plain(&lcp(m, &q), &[1.0, 1.8e-17, 1e-17], ROW_ROUNDING);
        assert!(!check.passed && check.min_w < -0.01, "{check:?}");
    }

    #[test]
    fn a_negative_z_does_not_hide_behind_a_large_one() {
        // z_2 = −1 beside z_1 = 1e12.
        let m: &[&[f64]] = &[&[1.0, 0.0], &[0.0, 1.0]];
        assert!(!check_plain(&lcp(m, &[-1e12, 1.0]), &[1e12, -1.0], ROW_ROUNDING).passed);
        assert!(check_plain(&lcp(m, &[-1e12, 1.0]), &[1e12, 0.0], ROW_ROUNDING).passed);
    }

    #[test]
    fn a_large_w_beside_a_small_z_is_no_complementarity() {
        let m: &[&[f64]] = &[&[1.0, 0.0], &[0.0, 1.0]];
        assert!(!check_plain(&lcp(m, &[-1.0, 1.0]), &[1.0, 1e-12], ROW_ROUNDING).passed);
    }

    #[test]
    fn what_is_not_a_number_does_not_pass() {
        let m: &[&[f64]] = &[&[1.0]];
        assert!(!check_plain(&lcp(m, &[-1.0]), &[f64::NAN], ROW_ROUNDING).passed);
    }
}
