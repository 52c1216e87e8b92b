//! Rows and pairs of a given contact system, and its joints in words.

use nalgebra::{DMatrix, DVector};

use crate::contact::file_data::FileData;
use crate::contact::pivoted::PivotedCholesky;
use crate::contact::system::ContactPair;
use crate::lcp::problem::NOISE;
use crate::model::scenario::GivenContactSystem;

/// Which rows are kept as joints and which are released, and the frictionless pairs of the released ones.
pub(super) struct Rows {
    pub kept: Vec<usize>,
    pub released: Vec<usize>,
    pub pairs: Vec<usize>,
}

impl Rows {
    pub fn of(given: &GivenContactSystem) -> Rows {
        let (m, tangents) = (given.pairs.len(), given.tangents);
        let tangential = |i: usize| (0..tangents).map(move |t| m + tangents * i + t);
        let rubs = |i: &usize| given.laws[*i].has_tangential_joint();
        let smooth = || (0..m).filter(|i| !rubs(i));
        Rows {
            kept: (0..m).chain((0..m).filter(rubs).flat_map(tangential)).collect(),
            released: smooth().flat_map(tangential).collect(),
            pairs: smooth().flat_map(|i| (0..tangents).map(move |_| i)).collect(),
        }
    }

    /// A vector of the file over the rows that are kept.
    pub fn over_kept(&self, vector: &[f64]) -> DVector<f64> {
        DVector::from_iterator(self.kept.len(), self.kept.iter().map(|&row| vector[row]))
    }

    pub fn block(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |a, b| matrix[(rows[a], columns[b])])
    }

    pub fn data(
        self,
        matrix: DMatrix<f64>,
        compliance: bool,
        given: &GivenContactSystem,
        factor: PivotedCholesky,
    ) -> FileData {
        FileData {
            matrix,
            compliance,
            loads: given.loads.iter().map(|load| DVector::from_column_slice(&load.vector)).collect(),
            kept: self.kept,
            released: self.released,
            released_pairs: self.pairs,
            factor,
        }
    }
}

/// start − Σ terms, 0 where rounding alone can have made it, and the sum of all magnitudes.
pub(super) fn cleaned(start: f64, terms: &DVector<f64>) -> (f64, f64) {
    let (value, size) =
        terms.iter().fold((start, start.abs()), |(value, size), term| (value - term, size + term.abs()));
    (if value.abs() <= NOISE * size { 0.0 } else { value }, size)
}

pub(super) fn pairs(given: &GivenContactSystem) -> Vec<ContactPair> {
    let mut next = given.pairs.len();
    (given.pairs.iter().enumerate())
        .map(|(i, id)| {
            let first = next;
            next += if given.laws[i].has_tangential_joint() { given.tangents } else { 0 };
            ContactPair {
                id: id.clone(),
                law: given.laws[i].clone(),
                position: given.positions.as_ref().map(|s| [s[i], 0.0, 0.0]),
                frame: None,
                joint: 0,
                tangential: first..next,
            }
        })
        .collect()
}

/// `z_n of c1`, `z_t of c2`, in space z_t1 and z_t2: the joint of a row of the matrix.
pub(super) fn joint_name(given: &GivenContactSystem, row: usize) -> String {
    let (word, pair) = match row.checked_sub(given.pairs.len()) {
        None => ("z_n", row),
        Some(along) if given.tangents == 1 => ("z_t", along),
        Some(along) => (["z_t1", "z_t2"][along % 2], along / 2),
    };
    format!("{word} of {}", given.pairs[pair])
}

/// `1 z_n of c1, -0.5 z_t of c2`, in space z_t1 and z_t2: the entries of a vector over all joints, largest 1; what is
/// small after scaling to unit diagonal is left out.
pub(super) fn joints_in_words(given: &GivenContactSystem, z: &DVector<f64>, scale: &[f64]) -> String {
    let sizes: Vec<f64> = z.iter().zip(scale).map(|(z, scale)| (z * scale).abs()).collect();
    let largest = sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
    let named: Vec<usize> = (0..z.len()).filter(|&i| sizes[i] > 1e-6 * largest).collect();
    let one = |&i: &usize| {
        let share = z[i] / z.amax();
        let share = if share.abs() < 1e-3 {
            format!("{share:.3e}")
        } else {
            format!("{share:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        format!("{share} {}", joint_name(given, i))
    };
    match named.len() {
        0..=6 => named.iter().map(one).collect::<Vec<_>>().join(", "),
        more => format!("{}, … ({more} joints)", named[..5].iter().map(one).collect::<Vec<_>>().join(", ")),
    }
}
