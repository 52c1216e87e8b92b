//! The structure condensed to its contact joints: CSM, CLV per load case, and what is known of the pairs.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::file_data::FileData;

use crate::lcp::problem::NOISE;
use crate::model::pair::Law;

/// A joint whose unit dislocation is this close (squared) to the kernel lies in it.
const FREE: f64 = 1e-12;

/// A pair as the contact algebra sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// `c1`, `joint[0]`.
    pub id: String,
    /// Its law and the numbers of the law (values or parameters).
    pub law: Law,
    /// Its place; for a contact system read from a file [s, 0, 0], or `None` without positions.
    pub position: Option<[f64; 3]>,
    /// n and t1 of a pair of a structure in space.
    pub frame: Option<[[f64; 3]; 2]>,
    /// Number of the joint it belongs to: a line along which its pairs follow one another.
    pub joint: usize,
    /// Rows of its tangential joints in R: one along t in the plane, t1 and t2 in space, none of a frictionless pair.
    /// The normal joint of pair i is row i.
    pub tangential: Range<usize>,
}

impl ContactPair {
    /// Whether it has tangential joints.
    pub fn rubs(&self) -> bool {
        !self.tangential.is_empty()
    }

    /// Whether it slips in a plane of directions, along t1 and t2.
    pub fn is_in_space(&self) -> bool {
        self.tangential.len() == 2
    }

    /// z_τ (> 0 along +t) of the pair, from z over the joints, along t or along t1 and t2; 0 where it has no tangential
    /// joint.
    pub fn slip(&self, z: &DVector<f64>) -> [f64; 2] {
        let mut slip = [0.0; 2];
        slip.iter_mut().zip(self.tangential.clone()).for_each(|(slip, joint)| *slip = z[joint]);
        slip
    }

    /// The tangential joint of a pair in the plane: for what [`ContactSystem::space_refusal`] keeps out of space.
    pub fn plane_tangential(&self) -> Option<usize> {
        debug_assert!(!self.is_in_space(), "pair {} has two tangential joints", self.id);
        self.tangential.clone().next()
    }
}

/// A load case on the joints.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLoad {
    /// Name of the case.
    pub name: String,
    /// RF of the case per unit factor, one entry per joint.
    pub vector: DVector<f64>,
    /// Sum of the magnitudes of the terms that went into each entry of RF.
    pub terms: DVector<f64>,
}

impl JointLoad {
    /// A load whose entries are exact.
    pub fn exactly(name: String, vector: DVector<f64>) -> JointLoad {
        JointLoad { name, terms: vector.abs(), vector }
    }
}

/// The joints whose force is the unknown (see [`super::force_form`]).
#[derive(Clone, Debug, PartialEq)]
pub struct ForceForm {
    /// Per joint, whether its force is the unknown.
    pub joints: Vec<bool>,
    /// Basis of the self-stress: joint forces that nothing feels, k × s.
    pub self_stress: DMatrix<f64>,
}

/// What a yielding system was made from (see [`super::yielding`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Yielding {
    /// The system as it is, its repeated joints in force form.
    pub exact: Arc<ContactSystem>,
    /// T: the joints that yield, those that are repeated and those that repeat them.
    pub joints: Vec<usize>,
    /// ε, a displacement per force.
    pub compliance: f64,
}

/// λ = R z + Σ factor·RF over the joints: m normals, then the tangentials of the pairs that have one.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSystem {
    /// The m pairs.
    pub pairs: Vec<ContactPair>,
    /// Tangential joints of each pair that rubs: 1 in the plane, 2 in space.
    pub tangents: usize,
    /// R, k × k, symmetric, positive semidefinite: what answers are checked against. Of a structure its kernel is exact
    /// (method §2); of a file it stands as given. With a [`ForceForm`] the mixed matrix of both forms.
    pub stiffness: DMatrix<f64>,
    /// RF per load case.
    pub loads: Vec<JointLoad>,
    /// Whether the entries of R are results of a condensation, each known to a few ε √(R_ii R_kk) only: a true zero is
    /// stored as noise. Otherwise they are data, exact to the last digit.
    pub rounded: bool,
    /// Of each joint the group in which joints feel one another: between two groups R is zero, not rounding. Empty where all
    /// may feel one another.
    pub groups: Vec<usize>,
    /// Orthonormal basis Z of the kernel of R, k × r (r = 0 when the structure stands without its contacts).
    pub kernel: DMatrix<f64>,
    /// R with the kernel exact, where that differs from `stiffness`: what the pivots work on.
    pub corrected: Option<DMatrix<f64>>,
    /// The joints whose force is the unknown, where joints repeat one another; `None` where all are independent.
    pub force_form: Option<ForceForm>,
    /// What the system was made from where joints that repeat one another in space were made to yield, so that R holds
    /// for all of them.
    pub yielding: Option<Box<Yielding>>,
    /// The data of a file that R and RF were made from; `None` where they are the data, and for a structure.
    pub file: Option<Arc<FileData>>,
}

impl ContactSystem {
    /// Number m of contact pairs.
    pub fn pair_count(&self) -> usize {
        self.pairs.len()
    }

    /// Number of pairs that can be in more than one state: all but rollers.
    pub fn turning_pairs(&self) -> usize {
        self.pairs.iter().filter(|pair| pair.law != Law::Roller).count()
    }

    /// Number k of joints.
    pub fn joint_count(&self) -> usize {
        self.stiffness.nrows()
    }

    /// A vector over the joints from a number along the normal and those along the tangents of every pair.
    pub fn over_joints<T: IntoIterator<Item = f64>>(
        &self,
        of_pairs: impl IntoIterator<Item = (f64, T)>,
    ) -> DVector<f64> {
        let mut joints = DVector::zeros(self.joint_count());
        for (i, (pair, (normal, tangential))) in self.pairs.iter().zip(of_pairs).enumerate() {
            joints[i] = normal;
            pair.tangential.clone().zip(tangential).for_each(|(joint, value)| joints[joint] = value);
        }
        joints
    }

    /// Whether pairs slip in a plane of directions: then their friction polygon has more than two facets.
    pub fn is_in_space(&self) -> bool {
        self.tangents == 2
    }

    /// Why `command` cannot be used in space; `None` in the plane.
    pub fn space_refusal(&self, command: &str) -> Option<String> {
        self.is_in_space().then(|| format!("`{command}` works in the plane only so far; this problem is in space"))
    }

    /// Magnitude up to which an entry of R is the rounding of a zero, in its unit; 0 where the entries are data.
    pub fn entry_noise(&self, i: usize, j: usize) -> f64 {
        if !self.rounded || self.group(i) != self.group(j) {
            return 0.0;
        }
        NOISE * (self.stiffness[(i, i)] * self.stiffness[(j, j)]).max(0.0).sqrt()
    }

    /// The group of a joint.
    pub fn group(&self, joint: usize) -> usize {
        self.groups.get(joint).copied().unwrap_or(0)
    }

    /// Whether R and RF are the numbers of a file, or condensed from them exactly: then the data are known to the last digit.
    pub fn has_exact_data(&self) -> bool {
        match &self.file {
            Some(file) => !file.compliance,
            None => !self.rounded && self.force_form.is_none() && self.yielding.is_none(),
        }
    }

    /// Whether joints repeat one another: an answer need not exist then where the structure stands.
    pub fn repeats_joints(&self) -> bool {
        self.force_form.is_some() || self.yielding.is_some()
    }

    /// R with zeros in place of what the condensation leaves of them: it says nothing and would make all fractions
    /// long.
    pub fn stiffness_without_noise(&self) -> DMatrix<f64> {
        self.stiffness.map_with_location(|i, j, entry| if entry.abs() > self.entry_noise(i, j) { entry } else { 0.0 })
    }

    /// Whether the force of a joint is the unknown.
    pub fn is_forced(&self, joint: usize) -> bool {
        self.force_form.as_ref().is_some_and(|form| form.joints[joint])
    }

    /// Why `command`, which works on R alone, cannot be used, and what to do `instead`; `None` where all joints are
    /// independent.
    pub fn dependence_refusal(&self, command: &str, instead: &str) -> Option<String> {
        let exact = self.yielding.as_ref().map_or(self, |yielding| &yielding.exact);
        let form = exact.force_form.as_ref()?;
        let felt = |joint: usize| form.self_stress.row(joint).amax() > 0.0;
        let of_pair = |(i, pair): &(usize, &ContactPair)| felt(*i) || pair.tangential.clone().any(felt);
        let ids: Vec<&str> = self.pairs.iter().enumerate().filter(of_pair).map(|(_, pair)| pair.id.as_str()).collect();
        if ids.is_empty() {
            return Some(format!(
                "`{command}` needs a contact stiffness matrix, and a singular compliance has none: {instead}"
            ));
        }
        let (named, more) = ids.split_at(ids.len().min(6));
        let more = if more.is_empty() { String::new() } else { format!(" and {} more", more.len()) };
        Some(format!(
            "`{command}` needs joints that are independent of one another; those of {}{more} repeat one another: {instead}",
            named.join(", ")
        ))
    }

    /// A load vector without the displacements that stand in it for joints in force form.
    pub fn forces_of(&self, load: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(load.len(), |joint, _| if self.is_forced(joint) { 0.0 } else { load[joint] })
    }

    /// R with its kernel exact: what the LCP is written from.
    pub fn pivot_stiffness(&self) -> &DMatrix<f64> {
        self.corrected.as_ref().unwrap_or(&self.stiffness)
    }

    /// Makes joints that carry no elastic force at all exactly such: a joint whose unit dislocation lies in the kernel
    /// (it alone holds some motion of a part) has a zero row and column in R, not one of rounding noise, against which
    /// every zero test that is relative to √R_ii would fail. The kernel is given a basis that contains it.
    pub fn zero_free_joints(&mut self) {
        let k = self.joint_count();
        let free: Vec<usize> = (0..k).filter(|&i| 1.0 - self.kernel.row(i).norm_squared() <= FREE).collect();
        if free.is_empty() {
            return;
        }
        let mut rest = self.kernel.clone();
        for &i in &free {
            self.stiffness.row_mut(i).fill(0.0);
            self.stiffness.column_mut(i).fill(0.0);
            rest.row_mut(i).fill(0.0);
        }
        let svd = rest.svd(true, false);
        let mut columns: Vec<DVector<f64>> =
            free.iter().map(|&i| DVector::from_fn(k, |j, _| f64::from(i == j))).collect();
        if let Some(u) = svd.u {
            // The rest of the basis is orthonormal too: its singular values are 1 or 0.
            columns.extend(
                svd.singular_values
                    .iter()
                    .zip(u.column_iter())
                    .filter(|(value, _)| **value > 0.5)
                    .map(|(_, column)| column.into_owned()),
            );
        }
        self.kernel = DMatrix::from_columns(&columns);
    }
}
