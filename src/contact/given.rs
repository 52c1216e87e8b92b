//! A contact system read from a file → joints: tangential joints of frictionless pairs condensed out, kernel exact.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::system::{ContactPair, ContactSystem, JointLoad};
use crate::model::pair::Law;
use crate::model::scenario::GivenContactSystem;

/// Eigenvalues below this multiple of the largest belong to the kernel (theory, "Numerics that matter").
const KERNEL: f64 = 1e-10;
/// An eigenvalue below −this multiple of the largest makes R unusable.
const NEGATIVE: f64 = 1e-9;
/// A motion given as kernel may stretch the structure by this relative energy at most.
const GIVEN_KERNEL: f64 = 1e-8;

/// Why a given contact system cannot be used; each names the key of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GivenError {
    /// CSM with a negative eigenvalue.
    #[error(
        "the contact stiffness matrix is not positive semidefinite: its smallest eigenvalue is {smallest:.3e}, its \
         largest {largest:.3e}"
    )]
    Indefinite {
        /// Smallest eigenvalue.
        smallest: f64,
        /// Largest eigenvalue.
        largest: f64,
    },
    /// A kernel vector that is none.
    #[error("kernel[{index}] is no motion without force: R z is {residual:.3e} of the largest stiffness times |z|")]
    NoKernel {
        /// Which one.
        index: usize,
        /// ‖R z‖ / (max R ‖z‖).
        residual: f64,
    },
    /// A load acts on a tangential motion of frictionless pairs that nothing resists.
    #[error("load case {case} pushes frictionless pair {pair} along a tangential motion that nothing resists")]
    Unheld {
        /// Load case.
        case: String,
        /// A pair that moves.
        pair: String,
    },
}

/// What gives back z_τ of the frictionless pairs: z_τ = flexibility · (coupling · z + Σ factor · RF_τ), negated.
#[derive(Clone, Debug, PartialEq)]
pub struct ReleasedTangentials {
    /// Pair of each released joint.
    pub pairs: Vec<usize>,
    /// −(pseudo)inverse of R_ττ.
    flexibility: DMatrix<f64>,
    /// R_τj over the joints that are kept.
    coupling: DMatrix<f64>,
    /// RF_τ per load case.
    loads: Vec<DVector<f64>>,
    /// Rows of the whole that are kept.
    kept: Vec<usize>,
    /// Basis of the released motions that nothing resists.
    free: DMatrix<f64>,
}

impl ReleasedTangentials {
    /// The load vectors of the joints that are kept, those of the released ones taken along.
    ///
    /// # Errors
    /// A load along a motion that nothing resists.
    pub fn take_loads(&mut self, given: &GivenContactSystem) -> Result<Vec<JointLoad>, GivenError> {
        let m = given.pairs.len();
        let mut loads = Vec::new();
        self.loads.clear();
        for load in &given.loads {
            let tangential = DVector::from_fn(self.pairs.len(), |a, _| load.vector[m + self.pairs[a]]);
            let size = load.vector.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            let unheld = self.free.transpose() * &tangential;
            if unheld.amax() > 1e-9 * size {
                let worst = tangential.iamax();
                let pair = given.pairs[self.pairs[worst]].clone();
                return Err(GivenError::Unheld { case: load.name.clone(), pair });
            }
            let vector = DVector::from_fn(self.kept.len(), |a, _| load.vector[self.kept[a]])
                + self.coupling.transpose() * (&self.flexibility * &tangential);
            loads.push(JointLoad::exactly(load.name.clone(), vector));
            self.loads.push(tangential);
        }
        Ok(loads)
    }

    /// z_τ of each released joint under joint displacements z (with the gap already taken off z_n) and factors.
    pub fn displacements(&self, z: &DVector<f64>, factors: &[f64]) -> DVector<f64> {
        let mut force = &self.coupling * z;
        for (load, factor) in self.loads.iter().zip(factors) {
            force += *factor * load;
        }
        &self.flexibility * force
    }
}

/// Builds the contact system of a file.
///
/// # Errors
/// See [`GivenError`].
pub fn given_system(given: &GivenContactSystem) -> Result<(ContactSystem, ReleasedTangentials), GivenError> {
    let m = given.pairs.len();
    let read = |i: usize, j: usize| 0.5 * (given.stiffness[i][j] + given.stiffness[j][i]);
    let full = DMatrix::from_fn(2 * m, 2 * m, read);
    let largest_entry = full.amax();
    let eigen = eigen(full.clone());
    let (smallest, largest) =
        eigen.eigenvalues.iter().fold((0f64, 0f64), |(a, b), &value| (a.min(value), b.max(value)));
    if smallest < -NEGATIVE * largest {
        return Err(GivenError::Indefinite { smallest, largest });
    }
    let motions: Vec<DVector<f64>> = match &given.kernel {
        Some(kernel) => {
            for (index, motion) in kernel.iter().enumerate() {
                let z = DVector::from_column_slice(motion);
                let force = (&full * &z).amax();
                // A stiffness of zero resists nothing: 0 / 0 is no residual.
                let residual = if force == 0.0 && z.amax() > 0.0 { 0.0 } else { force / (largest_entry * z.amax()) };
                if residual.is_nan() || residual > GIVEN_KERNEL {
                    return Err(GivenError::NoKernel { index, residual });
                }
            }
            kernel.iter().map(|motion| DVector::from_column_slice(motion)).collect()
        }
        None => (0..2 * m)
            .filter(|&k| eigen.eigenvalues[k] <= KERNEL * largest)
            .map(|k| eigen.eigenvectors.column(k).into_owned())
            .collect(),
    };
    let full = project(&full, &orthonormal(&motions, 2 * m));

    let released: Vec<usize> = (0..m).filter(|&i| matches!(given.laws[i], Law::Frictionless { .. })).collect();
    let kept: Vec<usize> = (0..m).chain((0..m).filter(|i| !released.contains(i)).map(|i| m + i)).collect();
    let own = DMatrix::from_fn(released.len(), released.len(), |a, b| full[(m + released[a], m + released[b])]);
    let coupling = DMatrix::from_fn(released.len(), kept.len(), |a, b| full[(m + released[a], kept[b])]);
    let (inverse, free) = pseudo_inverse(&own, largest);
    let mut stiffness = DMatrix::from_fn(kept.len(), kept.len(), |a, b| full[(kept[a], kept[b])]);
    stiffness -= coupling.transpose() * &inverse * &coupling;
    let stiffness = 0.5 * (&stiffness + stiffness.transpose());

    // Motions of the kept joints alone that cost nothing: those of the whole, restricted.
    let restricted: Vec<DVector<f64>> =
        motions.iter().map(|motion| DVector::from_fn(kept.len(), |a, _| motion[kept[a]])).collect();
    let kernel = orthonormal(&restricted, kept.len());
    let stiffness = project(&stiffness, &kernel);
    let mut next = m;
    let pairs = (0..m)
        .map(|i| {
            let tangential = (!released.contains(&i)).then(|| {
                next += 1;
                next - 1
            });
            ContactPair {
                id: given.pairs[i].clone(),
                law: given.laws[i].clone(),
                position: given.positions.as_ref().map(|s| [s[i], 0.0]),
                tangential,
            }
        })
        .collect();
    let mut recovery =
        ReleasedTangentials { pairs: released, flexibility: -inverse, coupling, loads: Vec::new(), kept, free };
    let loads = recovery.take_loads(given)?;
    Ok((ContactSystem { pairs, stiffness, loads, rounded: false, kernel }, recovery))
}

/// Orthonormal basis of the span of some vectors of length n; nearly dependent ones count once.
pub fn orthonormal(vectors: &[DVector<f64>], n: usize) -> DMatrix<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for vector in vectors {
        let size = vector.norm();
        if size == 0.0 {
            continue;
        }
        let mut rest = vector / size;
        for _ in 0..2 {
            for one in &basis {
                rest -= one.dot(&rest) * one;
            }
        }
        let left = rest.norm();
        if left > 1e-8 {
            basis.push(rest / left);
        }
    }
    if basis.is_empty() { DMatrix::zeros(n, 0) } else { DMatrix::from_columns(&basis) }
}

/// (I − ZZᵀ) R (I − ZZᵀ), exactly symmetric.
pub fn project(stiffness: &DMatrix<f64>, kernel: &DMatrix<f64>) -> DMatrix<f64> {
    if kernel.ncols() == 0 {
        return stiffness.clone();
    }
    let left = stiffness - kernel * (kernel.transpose() * stiffness);
    let both = &left - (&left * kernel) * kernel.transpose();
    0.5 * (&both + both.transpose())
}

/// Eigenvalues and eigenvectors; an empty matrix has none.
fn eigen(matrix: DMatrix<f64>) -> SymmetricEigen<f64, nalgebra::Dyn> {
    if matrix.is_empty() {
        return SymmetricEigen { eigenvalues: DVector::zeros(0), eigenvectors: matrix };
    }
    SymmetricEigen::new(matrix)
}

/// Inverse on the range, and a basis of the null space.
fn pseudo_inverse(matrix: &DMatrix<f64>, largest: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = matrix.nrows();
    let eigen = eigen(matrix.clone());
    let mut inverse = DMatrix::zeros(n, n);
    let mut free = Vec::new();
    for k in 0..n {
        let vector = eigen.eigenvectors.column(k);
        if eigen.eigenvalues[k] > KERNEL * largest {
            inverse += vector * vector.transpose() / eigen.eigenvalues[k];
        } else {
            free.push(vector.into_owned());
        }
    }
    let free = if free.is_empty() { DMatrix::zeros(n, 0) } else { DMatrix::from_columns(&free) };
    (inverse, free)
}
