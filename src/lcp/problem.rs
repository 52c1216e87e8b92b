//! The whole LCP written out: w = M z + q + d p, w ≥ 0, z ≥ 0, wᵀz = 0.

/// A value or rate counts as zero below this multiple of its natural size (theory: 64 … 256 ε), see [`Scale`].
pub const NOISE: f64 = 256.0 * f64::EPSILON;
/// p at a ray at most this multiple of the largest |q| is a normal end, flagged marginal.
pub const MARGINAL: f64 = 1e-12;

/// Sizes against which rounding noise is judged: the response (M Δz)_i counts as zero when it is at most
/// 256 ε · `row`_i · Σ_k `column`_k |Δz_k|.
///
/// For contact `row`_i = √R_ii (friction-weighted for the reserves) and `column`_k = √R_kk, i.e. R scaled to
/// unit diagonal (theory §4); for a plain LCP `column` = 1 and `row`_i = max_k |M_ik|.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// One entry per row of the LCP.
    pub row: Vec<f64>,
    /// One entry per column of the LCP.
    pub column: Vec<f64>,
}

impl Scale {
    /// The scale of a plain LCP.
    pub fn plain(matrix: &[Vec<f64>]) -> Scale {
        Scale {
            row: matrix
                .iter()
                .map(|row| row.iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs())))
                .collect(),
            column: vec![1.0; matrix.len()],
        }
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
