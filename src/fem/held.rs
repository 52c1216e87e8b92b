//! What the loads do to the joints while every joint holds, without R: a factorization of K_m alone and a solution for
//! each load case. It is what RF is, and costs a part of it.

use nalgebra::DVector;

use super::assembly::{assemble_seen, main_stiffness, on_joints, on_masters};
use super::condense::{amplification, driving_force, loses};
use super::contrast::Stiffnesses;
use super::error::MainSystemError;
use super::factor::Factor;
use super::kinematics::Kinematics;
use super::links::largest_force;
use super::order::Places;
use super::outline::Outline;
use crate::model::structure::Structure;
use crate::watch::Watch;

/// The joint forces of a load case per unit factor.
pub struct HeldForces {
    /// RF, in the order of the joints: x_n > 0 presses.
    pub forces: DVector<f64>,
    /// Largest nodal force or joint force of the case: what rounding in RF is measured by.
    pub size: f64,
}

impl Kinematics {
    /// RF of every load case; `None` where joints repeat others, where there may be motions that the parts do not show,
    /// or where f64 may lose too much of it to rounding.
    ///
    /// # Errors
    /// An element without shape; too large; out of memory; interrupted.
    pub fn held_forces(
        &self,
        structure: &Structure,
        watch: &dyn Watch,
    ) -> Result<Option<Vec<HeldForces>>, MainSystemError> {
        let Outline { dofs, elimination, repeated, f, settled, .. } = self.outline();
        if !repeated.is_empty() || !self.loose().may_be_all(structure) {
            return Ok(None);
        }
        let mut stiffnesses = Stiffnesses::of_springs(structure);
        let k = assemble_seen(structure, dofs, &|| watch.stop(), |k| stiffnesses.take(k))?;
        if !self.loose().are_all(structure, &stiffnesses) {
            return Ok(None);
        }
        let coordinates: Vec<[f64; 3]> = structure.nodes.iter().map(|node| node.position).collect();
        let node = elimination.nodes(dofs);
        let places = Places { node: &node, coordinates: &coordinates, last: &vec![false; node.len()] };
        let factor = Factor::new(&mut main_stiffness(&k, elimination), &[], places, 0, watch)?;
        if factor.is_shifted() {
            return Ok(None);
        }
        let closed = vec![0.0; elimination.joints()];
        let mut held = Vec::with_capacity(f.len());
        let driving: Vec<_> =
            std::iter::zip(f, settled).map(|(f, settled)| driving_force(&k, f, settled.as_deref())).collect();
        let mut solved: Vec<Vec<f64>> = driving.iter().map(|driving| on_masters(elimination, driving)).collect();
        factor.solve_many(&mut solved);
        for (((f, settled), driving), v) in f.iter().zip(settled).zip(&driving).zip(&solved) {
            let mut u = elimination.expand(v, &closed);
            for (u, settled) in std::iter::zip(&mut u, settled.as_deref().unwrap_or_default()) {
                *u += settled;
            }
            let mut nodal = k.times(&u);
            if loses(amplification(&k, &u, &nodal), elimination.masters()) {
                return Ok(None);
            }
            for (nodal, f) in std::iter::zip(&mut nodal, f) {
                *nodal -= f;
            }
            let forces = DVector::from_vec(on_joints(elimination, &nodal));
            let size = largest_force(dofs, driving, &forces);
            held.push(HeldForces { forces, size });
        }
        Ok(Some(held))
    }
}
