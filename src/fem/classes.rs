//! Classes of equal displacement components: what supports, ties and the rotations of rigid bodies make of the base
//! dofs.

use std::collections::BTreeMap;

use super::dof::Dofs;
use crate::model::groups::Groups;
use crate::model::structure::{Component, Load, Structure};
use crate::model::vector::distance;

/// What supports and ties make of the base dofs: classes of equal components.
pub struct Classes {
    /// Representative of the class of each base dof.
    pub class: Vec<u32>,
    /// Whether the class of each base dof is held by a support.
    pub held: Vec<bool>,
    /// The classes on which some load case imposes a displacement, with the numbers of those displacements in the rows
    /// of the joints: they follow the joints.
    pub settled: BTreeMap<u32, u32>,
    /// For the rotations of rigid bodies, the distance at which each is reduced as a displacement.
    pub reach: BTreeMap<u32, f64>,
}

impl Classes {
    /// The classes of all base dofs; the displacements imposed on supports are numbered after the joints.
    pub fn new(structure: &Structure, dofs: &Dofs, joints: usize) -> Classes {
        let mut groups = Groups::new(dofs.count());
        for tie in &structure.ties {
            for &component in &tie.components {
                groups.join_all(tie.nodes.iter().filter_map(|&node| dofs.of(node, component)));
            }
        }
        for body in &structure.rigid {
            for component in Component::ROTATIONS {
                groups.join_all(body.nodes.iter().filter_map(|&node| dofs.of(node, component)));
            }
        }
        let class: Vec<u32> = (0..dofs.count()).map(|dof| groups.of(dof) as u32).collect();
        let mut held_class = vec![false; dofs.count()];
        for support in &structure.supports {
            // A support of a rotation that does not exist holds nothing.
            if let Some(dof) = dofs.of(support.node, support.component) {
                held_class[class[dof] as usize] = true;
            }
        }
        let held = class.iter().map(|&c| held_class[c as usize]).collect();
        let mut settled = BTreeMap::new();
        for load in structure.load_cases.iter().flat_map(|case| &case.loads) {
            if let Load::Settlement { node, component, .. } = *load
                && let Some(dof) = dofs.of(node, component)
            {
                let next = (joints + settled.len()) as u32;
                settled.entry(class[dof]).or_insert(next);
            }
        }
        let reach = reaches(structure, dofs, &class);
        Classes { class, held, settled, reach }
    }

    /// What one unit of the reduced unknown of a class is divided by in the rows of the bodies and joints: a length for
    /// rotations (radians become displacements), 1 for translations.
    pub fn unit(&self, class: u32) -> f64 {
        self.reach.get(&class).copied().unwrap_or(1.0)
    }
}

/// For each class of rotations of bodies, the reach of the largest body, a power of two: a rotation is reduced as the
/// displacement at that distance, so that coefficients compare.
fn reaches(structure: &Structure, dofs: &Dofs, class: &[u32]) -> BTreeMap<u32, f64> {
    let mut reaches = BTreeMap::new();
    for rigid in &structure.rigid {
        let first = rigid.nodes[0];
        let place = |node: usize| structure.nodes[node].position;
        let arm = |node: &usize| distance(place(first), place(*node));
        let reach = rigid.nodes.iter().map(arm).fold(0.0, f64::max);
        for dof in
            Component::ROTATIONS.into_iter().filter_map(|component| dofs.of(first, component)).filter(|_| reach > 0.0)
        {
            let known = reaches.entry(class[dof]).or_insert(0.0_f64);
            *known = known.max(reach.log2().round().exp2());
        }
    }
    reaches
}
