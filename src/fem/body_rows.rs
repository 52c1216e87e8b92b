//! The rows that hold the nodes of a rigid body to its first node, and what they do to nodal forces.
//!
//! ```text
//!     u_i − u_0 − θ × (x_i − x_0) = 0     two rows per node after the first; the rotations are one class
//! ```
//!
//! They are reduced before the joints, like joints whose z is always zero. The forces inside a body are their
//! multipliers μ; with A the rows and G_A what a z of theirs would move, μ = G_Aᵀ (K u − F).

use std::collections::BTreeMap;

use super::dof::Dofs;
use super::doubled::Real;
use super::elimination::{Classes, Elimination};
use super::error::{Holder, OverConstraint};
use crate::model::structure::{Component, Structure};

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
            let arm = [0, 1].map(|c| place(node)[c] - place(first)[c]);
            for (component, lever) in [(Component::X, arm[1]), (Component::Y, -arm[0])] {
                let terms = [
                    (dofs.of(node, component), 1.0),
                    (dofs.of(first, component), -1.0),
                    (dofs.of(first, Component::R), lever),
                ];
                let terms = terms.into_iter().filter_map(|(dof, a)| Some((dof?, a))).filter(|(_, a)| *a != 0.0);
                rows.push(BodyRow { body, terms: terms.collect() });
            }
        }
    }
    rows
}

/// Of each class of rotations of bodies the reach of the largest body, a power of two: a rotation is reduced as the
/// displacement at that distance, so that coefficients compare.
pub fn reaches(structure: &Structure, dofs: &Dofs, class: &[u32]) -> BTreeMap<u32, f64> {
    let mut reaches = BTreeMap::new();
    for rigid in &structure.rigid {
        let first = rigid.nodes[0];
        let place = |node: usize, c: usize| structure.nodes[node].position[c];
        let arm = |node: &usize| (place(*node, 0) - place(first, 0)).hypot(place(*node, 1) - place(first, 1));
        let reach = rigid.nodes.iter().map(arm).fold(0.0, f64::max);
        if let Some(dof) = dofs.of(first, Component::R).filter(|_| reach > 0.0) {
            let known = reaches.entry(class[dof]).or_insert(0.0_f64);
            *known = known.max(reach.log2().round().exp2());
        }
    }
    reaches
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
    let supports = structure.supports.iter().filter(|support| touched(dofs.of(support.node, support.component)));
    let mut holders: Vec<Holder> =
        supports.map(|support| Holder::Support { node: id(support.node), component: support.component }).collect();
    for tie in &structure.ties {
        for &component in &tie.components {
            if touched(dofs.of(tie.nodes[0], component)) {
                holders.push(Holder::Tie { nodes: [tie.nodes[0], tie.nodes[1]].map(id), component });
            }
        }
    }
    let mut others: Vec<usize> = involved.iter().map(|row| row.body).filter(|other| *other != body).collect();
    others.sort_unstable();
    others.dedup();
    holders.extend(others.into_iter().map(|other| Holder::Body { id: structure.rigid[other].id.clone() }));
    OverConstraint { body, id: structure.rigid[body].id.clone(), holders }
}

impl Elimination {
    /// Takes the forces inside rigid bodies out of nodal forces: f − Aᵀ μ with μ = G_Aᵀ f. What is left is for supports
    /// and ties; in balance it is nothing where there are none.
    pub fn take_out_body_forces<T: Real>(&self, forces: &mut [T]) {
        let mut inner = vec![T::zero(); self.bodies().len()];
        for (dof, force) in forces.iter().enumerate() {
            for (row, a) in self.body_terms(dof) {
                inner[row] += T::from(a) * *force;
            }
        }
        for (row, inner) in std::iter::zip(self.bodies(), inner) {
            for &(dof, a) in &row.terms {
                forces[dof] -= T::from(a) * inner;
            }
        }
    }

    /// Adds to the sums of magnitudes of nodal forces what of them the bodies hand on.
    pub fn add_body_forces(&self, magnitudes: &mut [f64]) {
        let mut inner = vec![0.0; self.bodies().len()];
        for (dof, magnitude) in magnitudes.iter().enumerate() {
            for (row, a) in self.body_terms(dof) {
                inner[row] += a.abs() * magnitude;
            }
        }
        for (row, inner) in std::iter::zip(self.bodies(), inner) {
            for &(dof, a) in &row.terms {
                magnitudes[dof] += a.abs() * inner;
            }
        }
    }
}
