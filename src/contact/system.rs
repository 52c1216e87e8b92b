//! The structure condensed to its contact joints: CSM, CLV per load case, and what is known of the pairs.

use nalgebra::{DMatrix, DVector};

use crate::model::pair::Law;

/// A pair as the contact algebra sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// `c1`, `joint[0]`.
    pub id: String,
    /// Its law and the numbers of the law (values or parameters).
    pub law: Law,
    /// Place in the plane; for a contact system read from a file [s, 0], or `None` without positions.
    pub position: Option<[f64; 2]>,
    /// Row of the tangential joint in R; `None` for a frictionless pair. The normal joint of pair i is row i.
    pub tangential: Option<usize>,
}

/// A load case on the joints.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLoad {
    /// Name of the case.
    pub name: String,
    /// RF of the case per unit factor, one entry per joint.
    pub vector: DVector<f64>,
}

/// λ = R z + Σ factor·RF over the joints: m normals, then the tangentials of the pairs that have one.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSystem {
    /// The m pairs.
    pub pairs: Vec<ContactPair>,
    /// R, k × k, symmetric, positive semidefinite, its kernel exact (theory, "Numerics that matter").
    pub stiffness: DMatrix<f64>,
    /// RF per load case.
    pub loads: Vec<JointLoad>,
    /// Orthonormal basis Z of the kernel of R, k × r (r = 0 when the structure stands without its contacts).
    pub kernel: DMatrix<f64>,
}

impl ContactSystem {
    /// Number m of contact pairs.
    pub fn pair_count(&self) -> usize {
        self.pairs.len()
    }

    /// Number k of joints.
    pub fn joint_count(&self) -> usize {
        self.stiffness.nrows()
    }
}
