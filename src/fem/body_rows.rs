//! The rows that hold the nodes of a rigid body to its first node, and what they do to nodal forces.
//!
//! ```text
//!     u_i − u_0 − θ × (x_i − x_0) = 0     a row per coordinate of each node after the first; each rotation is one class
//! ```
//!
//! They are reduced before the joints, like joints whose z is always zero. The forces inside a body are their
//! multipliers μ; with A the rows and G_A what a z of theirs would move, μ = G_Aᵀ (K u − F).

use super::classes::Classes;
use super::dof::Dofs;
use super::error::{Holder, OverConstraint};
use super::parts::axis;
use crate::model::structure::{Component, Dimension, Element, Load, Structure};
use crate::model::vector::way;

/// Σ a·u = 0 on the base dofs.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyRow {
    /// Index of the body.
    pub body: usize,
    /// (base dof, a); the first is that of the node that follows.
    pub terms: Vec<(usize, f64)>,
}

/// The rows of all bodies.
pub fn body_rows(structure: &Structure, dofs: &Dofs) -> Vec<BodyRow> {
    let mut rows = Vec::new();
    for (body, rigid) in structure.rigid.iter().enumerate() {
        let first = rigid.nodes[0];
        let place = |node: usize| structure.nodes[node].position;
        for &node in &rigid.nodes[1..] {
            let arm = way(place(first), place(node));
            for &component in structure.dimension.translations() {
                let [one, other] = component.levers(arm).map(|(rotation, lever)| (dofs.of(first, rotation), -lever));
                let terms = [(dofs.of(node, component), 1.0), (dofs.of(first, component), -1.0), one, other];
                let terms = terms.into_iter().filter_map(|(dof, a)| Some((dof?, a))).filter(|(_, a)| *a != 0.0);
                rows.push(BodyRow { body, terms: terms.collect() });
            }
        }
        if let Some(axis) = idle_spin(structure, body) {
            let terms =
                structure.dimension.rotations().iter().map(|&about| (dofs.of(first, about), axis[about.axis()]));
            let terms = terms.filter_map(|(dof, a)| Some((dof?, a))).filter(|(_, a)| *a != 0.0);
            rows.push(BodyRow { body, terms: terms.collect() });
        }
    }
    rows
}

/// The line about which a body in space can turn without moving or turning anything else: all its nodes lie on it, and
/// nothing but itself has to do with its rotations. It is held there.
pub fn idle_spin(structure: &Structure, body: usize) -> Option<[f64; 3]> {
    if structure.dimension == Dimension::Plane {
        return None;
    }
    let nodes = &structure.rigid[body].nodes;
    let axis = axis(structure, nodes)?;
    let is_own = |node: &usize| nodes.contains(node);
    let turned_by_bar = |element: &Element| {
        let ends = element.nodes.iter().enumerate();
        element.bends()
            && !element.nodes.iter().all(is_own)
            && ends.filter(|(_, node)| is_own(node)).any(|(at, _)| element.components(at).contains(&Component::Rx))
    };
    let moment = |load: &Load| match load {
        Load::Nodal { node, moment, .. } => *moment != [0.0; 3] && is_own(node),
        Load::Element { .. } | Load::Settlement { .. } => false,
    };
    let turns = |component: &Component| component.is_rotation();
    let is_felt = structure.elements.iter().any(turned_by_bar)
        || structure.supports.iter().any(|support| turns(&support.component) && is_own(&support.node))
        || structure.ties.iter().any(|tie| tie.components.iter().any(turns) && tie.nodes.iter().any(is_own))
        || structure.springs.iter().flat_map(|s| &s.terms).any(|term| turns(&term.component) && is_own(&term.node))
        || structure.superelement.iter().flat_map(|s| &s.dofs).any(|(node, c)| turns(c) && is_own(node))
        || structure.load_cases.iter().flat_map(|case| &case.loads).any(moment);
    (!is_felt).then_some(axis)
}

/// Who holds the nodes of a body so that rows of bodies repeat what others hold.
pub fn over_constraint(
    structure: &Structure,
    dofs: &Dofs,
    classes: &Classes,
    body: usize,
    involved: &[&BodyRow],
) -> OverConstraint {
    let touched = |dof: Option<usize>| {
        dof.is_some_and(|dof| {
            let same = |(other, _): &(usize, f64)| classes.class[*other] == classes.class[dof];
            involved.iter().any(|row| row.terms.iter().any(same))
        })
    };
    let id = |node: usize| structure.nodes[node].id.clone();
    let word = |component| structure.dimension.word(component);
    let supports = structure.supports.iter().filter(|support| touched(dofs.of(support.node, support.component)));
    let mut holders: Vec<Holder> = supports
        .map(|support| Holder::Support { node: id(support.node), component: word(support.component) })
        .collect();
    for tie in &structure.ties {
        for &component in &tie.components {
            if touched(dofs.of(tie.nodes[0], component)) {
                holders.push(Holder::Tie { nodes: [tie.nodes[0], tie.nodes[1]].map(id), component: word(component) });
            }
        }
    }
    let mut others: Vec<usize> = involved.iter().map(|row| row.body).filter(|other| *other != body).collect();
    others.sort_unstable();
    others.dedup();
    holders.extend(others.into_iter().map(|other| Holder::Body { id: structure.rigid[other].id.clone() }));
    OverConstraint { body, id: structure.rigid[body].id.clone(), holders }
}
