//! A structure with all that holds it, before anything is known of its stiffness.

use super::dof::Dofs;
use super::elimination::Elimination;
use super::error::MainSystemError;
use super::idle_spins::{IdleSpin, turn};
use super::kernel::mechanism;
use super::loads::{load_vectors, settlements};
use super::repeated::Repeated;
use super::superelement::refuse_indefinite;
use crate::model::pair::Joint;
use crate::model::structure::Structure;
use crate::watch::Watch;

/// A torque below this share of the moments that it is the sum of is the rounding of the sum and of their own (method §4,
/// "Zero"); what the spin itself may be off by comes on top.
const SUM: f64 = 64.0 * f64::EPSILON;

/// See the module; the parts are those of [`MainSystem`](super::MainSystem).
pub struct Outline {
    pub dofs: Dofs,
    pub elimination: Elimination,
    pub joints: Vec<Joint>,
    pub independent: Vec<usize>,
    pub repeated: Vec<Repeated>,
    pub f: Vec<Vec<f64>>,
    pub settled: Vec<Option<Vec<f64>>>,
}

impl Outline {
    /// Numbers the displacements, tells joints that repeat others from those that are held, eliminates what is held,
    /// and puts the loads on the nodes.
    ///
    /// # Errors
    /// As [`MainSystem::new`](super::MainSystem::new) up to the assembly.
    pub fn new(structure: &Structure, all_joints: &[Joint], watch: &dyn Watch) -> Result<Outline, MainSystemError> {
        let dofs = Dofs::new(structure);
        refuse_indefinite(structure, &dofs, watch)?;
        let repeated = Elimination::repeated(structure, &dofs, all_joints)?;
        let is_repeated = |index: &usize| repeated.iter().any(|repeated| repeated.joint == *index);
        let independent: Vec<usize> = (0..all_joints.len()).filter(|index| !is_repeated(index)).collect();
        let joints: Vec<Joint> = independent.iter().map(|&index| all_joints[index].clone()).collect();
        let elimination = Elimination::new(structure, &dofs, &joints)?;
        let f = load_vectors(structure, &dofs)?;
        refuse_torques(structure, &dofs, elimination.spins(), &f)?;
        let settled = settlements(structure, &dofs, &elimination)?;
        Ok(Outline { dofs, elimination, joints, independent, repeated, f, settled })
    }
}

/// Refuses loads that would drive a spin that is held.
///
/// # Errors
/// The mechanism that it is.
pub fn refuse_torques(
    structure: &Structure,
    dofs: &Dofs,
    spins: &[IdleSpin],
    f: &[Vec<f64>],
) -> Result<(), MainSystemError> {
    for spin in spins {
        let terms: Vec<(usize, f64)> = spin.turns.iter().flat_map(|&(node, axis)| turn(dofs, node, axis)).collect();
        for f in f {
            let (torque, rounding) = terms.iter().fold((0.0, 0.0), |(sum, rounding): (f64, f64), &(dof, a)| {
                (sum + a * f[dof], rounding + (SUM * a.abs() + spin.error) * f[dof].abs())
            });
            if torque.abs() > rounding {
                let mut u = vec![[0.0; 6]; structure.nodes.len()];
                spin.turns.iter().for_each(|&(node, [x, y, z])| u[node] = [0.0, 0.0, 0.0, x, y, z]);
                return Err(mechanism(structure, &u));
            }
        }
    }
    Ok(())
}
