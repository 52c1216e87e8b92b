//! Which joints feel one another, and what a load reaches: rounding comes no farther.

use nalgebra::{DMatrix, DVector};

use super::assembly::MainMatrices;
use super::dof::Dofs;
use super::elimination::Elimination;
use crate::model::groups::Groups;

/// Below this share of the largest load, what a joint was summed from counts on its own.
const FAR: f64 = 1e-6;

/// Groups of the joints.
#[derive(Clone, Debug)]
pub struct Links {
    /// Of each joint the group in which joints feel one another: between two of them R is zero to the last digit.
    pub stiffness: Vec<usize>,
    /// Of each unknown of v, then of each joint, the group through which a load passes: joints are joined by the unknowns
    /// between them alone, for what K has between joints themselves carries no load.
    passes: Vec<usize>,
    masters: usize,
}

impl Links {
    /// Of the main system.
    pub fn new(matrices: &MainMatrices) -> Links {
        let MainMatrices { k_m, c, d } = matrices;
        let (masters, joints) = (k_m.order(), d.nrows());
        let mut groups = Groups::new(masters + joints);
        for column in 0..masters {
            k_m.column(column).filter(|(_, value)| *value != 0.0).for_each(|(row, _)| groups.join(row, column));
        }
        for &(master, joint, value) in c {
            if value != 0.0 {
                groups.join(master as usize, masters + joint as usize);
            }
        }
        let passes = groups.numbers(0..masters + joints);
        for column in 0..joints {
            (0..joints)
                .filter(|&row| d[(row, column)] != 0.0)
                .for_each(|row| groups.join(masters + row, masters + column));
        }
        Links { stiffness: groups.numbers(masters..masters + joints), passes, masters }
    }

    /// The magnitudes that each entry of RF of driving forces f was summed from: rounding in it is measured by these.
    pub fn load_terms(&self, dofs: &Dofs, elimination: &Elimination, f: &[f64], rf: &DVector<f64>) -> LoadTerms {
        let size = largest_force(dofs, f, rf);
        let mut of_group = vec![0.0f64; self.passes.iter().max().map_or(0, |last| last + 1)];
        for (dof, (force, rotation)) in f.iter().zip(dofs.is_rotation()).enumerate() {
            // A moment is no force: how large it is where it arrives, RF tells.
            for (master, _) in elimination.free_terms(dof).filter(|_| !rotation) {
                let of = &mut of_group[self.passes[master]];
                *of = of.max(force.abs());
            }
        }
        let passes = |joint: usize| self.passes[self.masters + joint];
        for (joint, force) in rf.iter().enumerate() {
            of_group[passes(joint)] = of_group[passes(joint)].max(force.abs());
        }
        let direct = on_joints_absolute(elimination, f);
        let own = DVector::from_fn(rf.len(), |joint, _| direct[joint].max(of_group[passes(joint)]));
        let are_far = own.iter().any(|own| *own < FAR * size);
        LoadTerms { terms: own, size, are_far }
    }

    /// Makes entries of R zero between joints that do not feel one another.
    pub fn part(&self, r: &mut DMatrix<f64>) {
        if self.stiffness.windows(2).all(|two| two[0] == two[1]) {
            return;
        }
        for column in 0..r.ncols() {
            for row in 0..r.nrows() {
                if self.stiffness[row] != self.stiffness[column] {
                    r[(row, column)] = 0.0;
                }
            }
        }
    }
}

/// What RF of a load case was summed from.
#[derive(Clone, Debug)]
pub struct LoadTerms {
    /// Of each joint on its own.
    pub terms: DVector<f64>,
    /// The largest of the load.
    pub size: f64,
    /// Whether some joints are reached by far less than that.
    pub are_far: bool,
}

/// |G|ᵀ |f|.
fn on_joints_absolute(elimination: &Elimination, f: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; elimination.joints()];
    for (dof, value) in f.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        elimination.joint_terms(dof).for_each(|(joint, g)| out[joint] += (g * value).abs());
    }
    out
}

/// Largest nodal force of driving forces f, or joint force of the RF that they give.
pub(super) fn largest_force(dofs: &Dofs, f: &[f64], rf: &DVector<f64>) -> f64 {
    let nodal = std::iter::zip(f, dofs.is_rotation()).filter(|(_, rotation)| !rotation).map(|(f, _)| f.abs());
    nodal.fold(rf.amax(), f64::max)
}
