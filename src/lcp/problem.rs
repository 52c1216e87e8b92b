//! The whole LCP written out: w = M z + q + d p, w ≥ 0, z ≥ 0, wᵀz = 0.

use super::outcome::Point;
use crate::lcp::exact::scalar::Scalar;

/// A value or rate counts as zero below this multiple of its natural size (method §4, "Zero"), see [`Scale`].
pub const NOISE: f64 = 256.0 * f64::EPSILON;
/// Rounds of equilibration: each halves the distance of the logarithms of the factors from their limits.
const EQUILIBRATIONS: usize = 8;
/// A p that is more than this share of what it was when it entered is no rounding, however large z.
const MOST_LEFT: f64 = 1e-4;
/// p at a ray at most this multiple of the load, or of the terms of each row, is a normal end, flagged marginal.
pub const MARGINAL: f64 = 1e-12;

/// Sizes against which rounding noise is judged: the response (M Δz)_i counts as zero when it is at most
/// 256 ε · `row`_i · Σ_k `column`_k |Δz_k|.
///
/// For contact `row`_i = √R_ii (friction-weighted for the reserves) and `column`_k = √R_kk, i.e. R scaled to
/// unit diagonal (method §4); for a plain LCP see [`Scale::plain`].
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// One entry per row of the LCP.
    pub row: Vec<f64>,
    /// One entry per column of the LCP.
    pub column: Vec<f64>,
    /// Size of what has to be balanced, where q holds other numbers besides: a friction bound of 1e15 is not a load.
    /// What is left of p is judged against it. A bare LCP has none.
    pub load: Option<f64>,
}

impl Scale {
    /// The scale of a plain LCP: `row`_i `column`_k ≥ |M_ik|, as tight as one factor per row and column can be, so that
    /// other units of single rows and columns change no decision (Ruiz's equilibration in the largest norm, 2001).
    pub fn plain(matrix: &[Vec<f64>]) -> Scale {
        let n = matrix.len();
        let mut scale = Scale { row: vec![1.0; n], column: vec![1.0; n], load: None };
        let largest = |entries: &mut dyn Iterator<Item = f64>| entries.fold(0.0, |a: f64, b| a.max(b.abs()));
        for _ in 0..EQUILIBRATIONS {
            let rows: Vec<f64> =
                (0..n).map(|i| largest(&mut (0..n).map(|k| matrix[i][k] / scale.column[k])) / scale.row[i]).collect();
            let columns: Vec<f64> =
                (0..n).map(|k| largest(&mut (0..n).map(|i| matrix[i][k] / scale.row[i])) / scale.column[k]).collect();
            let widen = |sizes: &mut [f64], by: &[f64]| {
                sizes.iter_mut().zip(by).filter(|(_, by)| **by > 0.0).for_each(|(size, by)| *size *= by.sqrt());
            };
            widen(&mut scale.row, &rows);
            widen(&mut scale.column, &columns);
        }
        for (row, entries) in scale.row.iter_mut().zip(matrix) {
            *row = largest(&mut entries.iter().zip(&scale.column).map(|(entry, column)| entry / column));
        }
        scale
    }
}

/// An LCP with its covering vector, every row written out.
#[derive(Clone, Debug, PartialEq)]
pub struct Lcp<T> {
    /// M, n × n, row by row.
    pub matrix: Vec<Vec<T>>,
    /// q, length n.
    pub q: Vec<T>,
    /// Covering vector d > 0, length n.
    pub covering: Vec<T>,
    /// See [`Scale`].
    pub scale: Scale,
}

impl<T> Lcp<T> {
    /// Number n of complementary couples.
    pub fn size(&self) -> usize {
        self.q.len()
    }
}

impl<T: Scalar> Lcp<T> {
    /// Whether what is left of p is as good as nothing; see [`as_good_as_nothing`].
    pub fn is_marginal(&self, point: &Point) -> bool {
        let terms = |i: usize| -> f64 {
            let row = self.matrix[i].iter().zip(&point.z).filter(|(_, z)| **z != 0.0);
            self.q[i].to_f64().abs() + row.map(|(m, z)| (m.to_f64() * z).abs()).sum::<f64>()
        };
        as_good_as_nothing(point, self.scale.load, |i| (self.q[i].to_f64(), self.covering[i].to_f64()), terms)
    }
}

/// Whether the p that is left at the end of a run is small enough for an answer: compared with the load, where its size
/// is known. The rows of a bare LCP may be of any size: there p is compared, in every row that has no w to spare for
/// it, with the terms of that row. Where z is very large these hide any p: it is nothing only where it is little of what it
/// was when it entered, too.
pub(super) fn as_good_as_nothing(
    point: &Point,
    load: Option<f64>,
    start: impl Fn(usize) -> (f64, f64),
    terms: impl Fn(usize) -> f64,
) -> bool {
    if let Some(load) = load {
        return point.p <= MARGINAL * load;
    }
    let needed = |i: usize| {
        let (q, covering) = start(i);
        -q / covering
    };
    let entered = (0..point.w.len()).map(needed).fold(0.0, f64::max);
    if point.p > MOST_LEFT * entered {
        return false;
    }
    (0..point.w.len()).all(|i| {
        let share = start(i).1 * point.p;
        point.w[i] >= share || share <= MARGINAL * terms(i)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Beside z = 2e13 the terms of the row hide any p; one that has grown since it entered is no rounding.
    #[test]
    fn a_large_z_hides_no_p() {
        let lcp =
            Lcp { matrix: vec![vec![1.0]], q: vec![-24.0], covering: vec![1.0], scale: Scale::plain(&[vec![1.0]]) };
        let is_marginal = |p: f64, z: f64| lcp.is_marginal(&Point { z: vec![z], w: vec![0.0], p });
        assert!(!is_marginal(488.0, 2e15) && !is_marginal(1.0, 2e15));
        assert!(is_marginal(1e-12, 24.0) && is_marginal(1e-3, 2e15));
    }
}
