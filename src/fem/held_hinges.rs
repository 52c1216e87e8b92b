//! Nodes in the plane at which every bar is hinged, and which turn nevertheless: something else than a bar holds their
//! rotation.
//!
//! A support, a spring to the ground, or a spring or a tie to a node that turns gives such a rotation a meaning: a spring
//! between it and another node is one between two rotations and not one to the ground, and the rotation that a settling
//! support imposes is one that such a spring feels. One that nothing resists would only turn by itself, so that it is
//! none, as are those of springs and ties among such nodes alone. In space a hinge keeps the rotations of its node where
//! anything names one, see [`EndJoint`](crate::model::space_section::EndJoint), and `idle_spins` holds what is left.

use crate::model::groups::Groups;
use crate::model::structure::{Component, Dimension, Structure};

/// Marks these nodes.
pub fn held_hinges(structure: &Structure) -> Vec<bool> {
    let mut hinged = vec![false; structure.nodes.len()];
    if structure.dimension == Dimension::Space {
        return hinged;
    }
    // Whether bars end at each node, and whether it turns with anything.
    let mut turns = hinged.clone();
    for element in structure.elements.iter().filter(|element| element.bends()) {
        for (at, &node) in element.nodes.iter().enumerate() {
            hinged[node] = true;
            turns[node] |= element.turns_with(at);
        }
    }
    structure.rigid.iter().flat_map(|body| &body.nodes).for_each(|&node| turns[node] = true);
    for (hinged, turns) in std::iter::zip(&mut hinged, &turns) {
        *hinged &= !turns;
    }
    if !hinged.contains(&true) {
        return hinged;
    }

    let is_rotation = |component: &Component| component.is_rotation();
    let mut groups = Groups::new(structure.nodes.len());
    for tie in structure.ties.iter().filter(|tie| tie.components.iter().any(is_rotation)) {
        groups.join_all(tie.nodes.iter().copied());
    }
    let mut resisted = turns;
    for support in structure.supports.iter().filter(|support| is_rotation(&support.component)) {
        resisted[support.node] = true;
    }
    for spring in structure.springs.iter().filter(|spring| spring.stiffness > 0.0) {
        if spring.terms.iter().any(|term| is_rotation(&term.component)) {
            groups.join_all(spring.nodes());
            resisted[spring.terms[0].node] |= spring.is_to_ground();
        }
    }
    let mut group_resists = vec![false; structure.nodes.len()];
    for node in (0..structure.nodes.len()).filter(|&node| resisted[node]) {
        group_resists[groups.of(node)] = true;
    }
    for (node, hinged) in hinged.iter_mut().enumerate() {
        *hinged &= group_resists[groups.of(node)];
    }
    hinged
}
