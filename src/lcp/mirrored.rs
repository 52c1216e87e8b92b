//! An LCP whose rows partly come in mirrored couples, as the friction reserves of contact do.
//!
//! ```text
//!   w_i  = M_i z + q_i + d_i p                      primary rows, i = 0 … N−1
//!   w_i' = 2 f_i w_n(i) + b_i + e_i p − w_i          mirror of row i (not every row has one)
//!   column of z_i' = −(column of z_i)
//! ```
//! For a Coulomb pair w_i = x⁺, w_i' = x⁻, w_n = x_n, b = 2c, e = 2(d_τ − f d_n) (theory §5): so 2m rows carry
//! all of the 3m-row LCP (8). A plain LCP is the case without mirrors.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::dense::add_response;
use super::problem::{Lcp, Scale};

/// M over the primary rows, not stored for contact: M_i = S_i + f_i S_n(i) in the coupled rows (w = x⁺ = x_τ + f
/// x_n), S_i in the others. S is shared between all LCPs of a system, whatever their loads and their friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Operator {
    base: Arc<DMatrix<f64>>,
    /// n(i) and f_i of the coupled rows; no n(i) is coupled itself.
    coupled: Vec<Option<(usize, f64)>>,
}

impl Operator {
    /// A matrix as it is.
    pub fn plain(matrix: DMatrix<f64>) -> Operator {
        Operator {
            coupled: vec![None; matrix.nrows()],
            base: Arc::new(matrix),
        }
    }

    /// S with f_i times row n(i) added to each coupled row i; `rows`: n(i) and f_i per row.
    pub fn coupled(base: Arc<DMatrix<f64>>, rows: Vec<Option<(usize, f64)>>) -> Operator {
        debug_assert!(base.is_square() && base.nrows() == rows.len());
        Operator {
            base,
            coupled: rows,
        }
    }

    /// S.
    pub fn base(&self) -> &Arc<DMatrix<f64>> {
        &self.base
    }

    /// n(i) and f_i of row i, where it is coupled.
    pub(crate) fn coupling(&self, i: usize) -> Option<(usize, f64)> {
        self.coupled[i]
    }

    /// S z → M z.
    fn couple(&self, response: &mut [f64]) {
        for (i, coupled) in self.coupled.iter().enumerate() {
            if let Some((n, f)) = *coupled {
                response[i] += f * response[n];
            }
        }
    }

    /// Entries column by column, appended.
    pub(crate) fn write_out(&self, into: &mut Vec<f64>) {
        for column in self.base.column_iter() {
            let start = into.len();
            into.extend_from_slice(column.as_slice());
            self.couple(&mut into[start..]);
        }
    }

    /// M as a matrix.
    pub fn written_out(&self) -> DMatrix<f64> {
        let n = self.base.nrows();
        let mut entries = Vec::with_capacity(n * n);
        self.write_out(&mut entries);
        DMatrix::from_vec(n, n, entries)
    }

    /// M z.
    pub fn times(&self, z: &[f64]) -> DVector<f64> {
        let mut response = DVector::zeros(self.base.nrows());
        add_response(response.as_mut_slice(), self.base.as_slice(), z);
        self.couple(response.as_mut_slice());
        response
    }
}

/// The mirror of a primary row.
#[derive(Clone, Debug, PartialEq)]
pub struct Mirror {
    /// Row of the whole LCP that holds w_i'.
    pub whole: usize,
    /// Primary row n(i) of the normal force, if the sum of the couple depends on one.
    pub normal: Option<usize>,
    /// f_i ≥ 0.
    pub friction: f64,
    /// b_i = w_i + w_i' − 2 f w_n at p = 0.
    pub constant: f64,
    /// e_i.
    pub covering: f64,
}

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct MirroredLcp {
    /// M over the primary rows, N × N.
    pub matrix: Operator,
    /// q, N.
    pub q: DVector<f64>,
    /// d, N; ≥ 0 for Lemke's algorithm, of any sign as the increment of a path.
    pub covering: DVector<f64>,
    /// Row of the whole LCP of each primary row.
    pub whole: Vec<usize>,
    /// Mirror of each primary row.
    pub mirrors: Vec<Option<Mirror>>,
    /// Against what rounding noise is judged, over the primary rows and columns.
    pub scale: Scale,
    /// Number of rows n of the whole LCP.
    pub whole_size: usize,
}

impl MirroredLcp {
    /// Number N of primary rows.
    pub fn size(&self) -> usize {
        self.q.len()
    }

    /// A plain LCP: no mirrors.
    pub fn plain(lcp: &Lcp<f64>) -> MirroredLcp {
        let n = lcp.size();
        MirroredLcp {
            matrix: Operator::plain(DMatrix::from_fn(n, n, |i, j| lcp.matrix[i][j])),
            q: DVector::from_column_slice(&lcp.q),
            covering: DVector::from_column_slice(&lcp.covering),
            whole: (0..n).collect(),
            mirrors: vec![None; n],
            scale: lcp.scale.clone(),
            whole_size: n,
        }
    }

    /// q of the mirror of row i, and its entry of the covering vector.
    pub(crate) fn mirror_start(&self, row: usize, mirror: &Mirror) -> (f64, f64) {
        let (q_n, d_n) = mirror
            .normal
            .map_or((0.0, 0.0), |n| (self.q[n], self.covering[n]));
        (
            2.0 * mirror.friction * q_n + mirror.constant - self.q[row],
            2.0 * mirror.friction * d_n + mirror.covering - self.covering[row],
        )
    }
}
