//! An LCP whose rows partly come in mirrored couples, as the friction reserves of contact do.
//!
//! ```text
//!   w_i  = M_i z + q_i + d_i p                      primary rows, i = 0 … N−1
//!   w_i' = 2 f_i w_n(i) + b_i + e_i p − w_i          mirror of row i (not every row has one)
//!   column of z_i' = −(column of z_i)
//! ```
//! For a Coulomb pair w_i = x⁺, w_i' = x⁻, w_n = x_n, b = 2c, e = 2(d_τ − f d_n) (method §5): so 2m rows carry
//! all of the 3m-row LCP (8). A plain LCP is the case without mirrors.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::outcome::Point;
use super::problem::{Lcp, Scale, as_good_as_nothing};
use crate::doubled::Real;
use stickslip_numerics::products::add_sparse_response;

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

impl Mirror {
    /// 2 f w_n + `shift` b + e p − w_i for row i, from the w of the primary rows: the value of w_i' where `shift` = 1,
    /// its rate or an entry of its row where `shift` = 0.
    #[inline]
    pub(crate) fn reflect<T: Real>(&self, i: usize, w: impl Fn(usize) -> T, p: f64, shift: f64) -> T {
        let normal = self.normal.map_or_else(T::zero, &w);
        T::from(2.0 * self.friction) * normal + T::from(shift * self.constant) + T::from(self.covering) * T::from(p)
            - w(i)
    }
}

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct MirroredLcp {
    /// S, N × N, which M follows from: M_i = S_i + f_i S_n(i) in rows with a mirror and a normal force (w = x⁺ = x_τ +
    /// f x_n), S_i in the others. Shared between all LCPs of a system, whatever their loads and their friction.
    pub base: Arc<DMatrix<f64>>,
    /// q, N.
    pub q: DVector<f64>,
    /// d, N; ≥ 0 for Lemke's algorithm, of any sign as the increment of a path.
    pub covering: DVector<f64>,
    /// Row of the whole LCP of each primary row.
    pub whole: Vec<usize>,
    /// Mirror of each primary row.
    pub mirrors: Vec<Option<Mirror>>,
    /// The sizes against which rounding noise is judged, over the primary rows and columns.
    pub scale: Scale,
    /// Number of rows n of the whole LCP.
    pub full_size: usize,
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
            base: Arc::new(DMatrix::from_fn(n, n, |i, j| lcp.matrix[i][j])),
            q: DVector::from_column_slice(&lcp.q),
            covering: DVector::from_column_slice(&lcp.covering),
            whole: (0..n).collect(),
            mirrors: vec![None; n],
            scale: lcp.scale.clone(),
            full_size: n,
        }
    }

    /// The same with another covering vector over the primary rows, > 0; that of a mirror is that of its row.
    pub fn with_covering(&self, covering: DVector<f64>) -> MirroredLcp {
        let mut lcp = MirroredLcp { covering, ..self.clone() };
        for i in 0..lcp.size() {
            let normal = lcp.coupling(i).map_or(0.0, |(n, f)| f * lcp.covering[n]);
            let own = lcp.covering[i];
            lcp.mirrors[i].iter_mut().for_each(|mirror| mirror.covering = 2.0 * (own - normal));
        }
        lcp
    }

    /// Size of the load: see [`Scale::load`].
    pub fn load_size(&self) -> f64 {
        self.scale.load.filter(|load| *load > 0.0).unwrap_or_else(|| self.q.amax())
    }

    /// Whether what is left of p is as good as nothing; see [`as_good_as_nothing`].
    pub fn is_marginal(&self, point: &Point) -> bool {
        let terms = |i: usize| {
            let row = point.z.iter().enumerate().filter(|(_, z)| **z != 0.0);
            self.q[i].abs() + row.map(|(j, z)| (self.base[(i, j)] * z).abs()).sum::<f64>()
        };
        as_good_as_nothing(point, self.scale.load, |i| (self.q[i], self.covering[i]), terms)
    }

    /// n(i) and f_i of a row that is coupled to a normal force.
    pub(crate) fn coupling(&self, i: usize) -> Option<(usize, f64)> {
        let mirror = self.mirrors[i].as_ref()?;
        Some((mirror.normal?, mirror.friction))
    }

    /// A column of S → of M, or S z → M z.
    fn couple(&self, response: &mut [f64]) {
        for i in 0..self.size() {
            if let Some((n, f)) = self.coupling(i) {
                response[i] += f * response[n];
            }
        }
    }

    /// Column j of M.
    pub(crate) fn write_column(&self, j: usize, into: &mut [f64]) {
        into.copy_from_slice(self.base.column(j).as_slice());
        self.couple(into);
    }

    /// The entries of M column by column, appended.
    pub(crate) fn write_matrix(&self, into: &mut Vec<f64>) {
        for column in self.base.column_iter() {
            let start = into.len();
            into.extend_from_slice(column.as_slice());
            self.couple(&mut into[start..]);
        }
    }

    /// M over the primary rows, N × N.
    pub fn matrix(&self) -> DMatrix<f64> {
        let n = self.size();
        let mut entries = Vec::with_capacity(n * n);
        self.write_matrix(&mut entries);
        DMatrix::from_vec(n, n, entries)
    }

    /// M z.
    pub fn times(&self, z: &[f64]) -> DVector<f64> {
        let mut response = DVector::zeros(self.size());
        // Most pairs stick, and their displacements are zero.
        add_sparse_response(response.as_mut_slice(), self.base.as_slice(), z);
        self.couple(response.as_mut_slice());
        response
    }

    /// Primary row of each row of the whole LCP, and whether it is the mirror of that.
    pub(crate) fn primary_rows(&self) -> Vec<(usize, bool)> {
        let mut rows = vec![(0, false); self.full_size];
        for (i, mirror) in self.mirrors.iter().enumerate() {
            rows[self.whole[i]] = (i, false);
            if let Some(mirror) = mirror {
                rows[mirror.whole] = (i, true);
            }
        }
        rows
    }

    /// q of the mirror of row i, and its entry of the covering vector.
    pub(crate) fn mirror_start(&self, i: usize, mirror: &Mirror) -> (f64, f64) {
        (mirror.reflect(i, |row| self.q[row], 0.0, 1.0), mirror.reflect(i, |row| self.covering[row], 1.0, 0.0))
    }
}
