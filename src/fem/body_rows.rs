//! The rows that hold the nodes of a rigid body to its first node, and what they do to nodal forces.
//!
//! ```text
//!     u_i − u_0 − θ × (x_i − x_0) = 0     a row per coordinate of each node but the first; each rotation is one class
//! ```
//!
//! They are reduced before the joints, like joints whose z is always zero. The forces inside a body are their
//! multipliers μ; with A the rows and G_A what a z of theirs would move, μ = G_Aᵀ (K u − F).

use super::classes::Classes;
use super::dof::Dofs;
use super::error::{Holder, OverConstraint};
use super::idle_spins::{IdleSpin, turn};
use crate::model::structure::Structure;
use crate::model::vector::way;

/// Σ a·u = 0 on the base dofs.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyRow {
    /// Index of the body; `None` of a row that holds an idle spin.
    pub body: Option<usize>,
    /// (base dof, a); the first is that of the node that follows.
    pub terms: Vec<(usize, f64)>,
}

/// The rows of all bodies, then those that hold idle spins.
pub fn body_rows(structure: &Structure, dofs: &Dofs, spins: &[IdleSpin]) -> Vec<BodyRow> {
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
                rows.push(BodyRow { body: Some(body), terms: terms.collect() });
            }
        }
    }
    for spin in spins {
        let Some(&(node, _)) = spin.turns.first() else { continue };
        rows.push(BodyRow { body: None, terms: turn(dofs, node, spin.axis) });
    }
    rows
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
    let mut others: Vec<usize> = involved.iter().filter_map(|row| row.body).filter(|other| *other != body).collect();
    others.sort_unstable();
    others.dedup();
    holders.extend(others.into_iter().map(|other| Holder::Body { id: structure.rigid[other].id.clone() }));
    OverConstraint { body, id: structure.rigid[body].id.clone(), holders }
}
