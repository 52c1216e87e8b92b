//! From displacements to member forces, stresses and reactions.

use nalgebra::DVector;

use super::element::{Axis, corners, frame, quad4, slots, spring, truss};
use super::main_system::{Displacements, MainSystem};
use crate::model::structure::{Component, ElementKind, Load, Spring, Structure};

/// Internal forces at one end of an element in bar axes: local x from start to end, local y = x turned +90°.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndForces {
    /// Normal force N, > 0 tension.
    pub normal: f64,
    /// Shear force Q = dM/dx.
    pub shear: f64,
    /// Bending moment M, > 0 tension on the −y side.
    pub moment: f64,
}

/// Internal forces of one element of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MemberForces {
    /// Index into [`Structure::bars`].
    pub bar: usize,
    /// Element along the bar, from 0.
    pub element: usize,
    /// At its start.
    pub start: EndForces,
    /// At its end.
    pub end: EndForces,
}

/// Stress at the centre of a quad, tension positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadStress {
    /// Index into [`Structure::elements`].
    pub element: usize,
    /// (σ_xx, σ_yy, σ_xy).
    pub stress: [f64; 3],
}

/// Force of the supports of a node on the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// The node.
    pub node: usize,
    /// (F_x, F_y).
    pub force: [f64; 2],
    /// Moment, counter-clockwise.
    pub moment: f64,
}

impl MainSystem {
    /// N, Q, M at both ends of every bar element under Σ factor·F and the displacements `u`.
    pub fn member_forces(&self, structure: &Structure, u: &Displacements, factors: &[f64]) -> Vec<MemberForces> {
        let mut line = vec![[0.0; 2]; structure.elements.len()];
        for (case, factor) in std::iter::zip(&structure.load_cases, factors) {
            for load in &case.loads {
                if let Load::Line { element, value } = load {
                    line[*element][0] += factor * value[0];
                    line[*element][1] += factor * value[1];
                }
            }
        }
        let mut members = Vec::new();
        for (bar, data) in structure.bars.iter().enumerate() {
            for (position, index) in data.elements.clone().enumerate() {
                let ends = bar_end_forces(structure, index, u, line[index]);
                let [start, end] = ends.map(|[normal, shear, moment]| EndForces { normal, shear, moment });
                members.push(MemberForces { bar, element: position, start, end });
            }
        }
        members
    }

    /// Stresses at the centres of all quads.
    pub fn quad_stresses(&self, structure: &Structure, u: &Displacements) -> Vec<QuadStress> {
        let quads = structure.elements.iter().enumerate().filter_map(|(index, element)| match &element.kind {
            ElementKind::Quad { plane, .. } => Some((index, element, *plane)),
            _ => None,
        });
        quads
            .map(|(index, element, plane)| {
                let d = quad4::elasticity(&structure.materials[element.material], plane);
                let mut values = [0.0; 8];
                for (i, &node) in element.nodes.iter().enumerate() {
                    values[2 * i] = u.0[node][0];
                    values[2 * i + 1] = u.0[node][1];
                }
                QuadStress {
                    element: index,
                    stress: quad4::stress_at_centre(&corners(structure, element), &d, &values),
                }
            })
            .collect()
    }

    /// Force of every spring on its node, in the order of [`Structure::springs`].
    pub fn spring_forces(&self, structure: &Structure, u: &Displacements) -> Vec<[f64; 2]> {
        let force = |s: &Spring| spring::force(s, [u.0[s.node][0], u.0[s.node][1]]);
        structure.springs.iter().map(force).collect()
    }

    /// Forces of the supports on the structure, one entry per supported node in the order of the nodes, for the
    /// displacements `u` and the joint forces `lambda` under Σ factor·F. Where a support holds several tied
    /// nodes it carries what they all hand over; if several supports hold them, the first of those does.
    pub fn reactions(
        &self,
        structure: &Structure,
        u: &Displacements,
        lambda: &DVector<f64>,
        factors: &[f64],
    ) -> Vec<Reaction> {
        let forces = self.unbalanced(u, lambda, factors);
        let mut supported = vec![false; forces.len()];
        // The support that takes the forces of the unsupported nodes of a class.
        let mut taker = vec![usize::MAX; forces.len()];
        let mut nodes: Vec<usize> = Vec::new();
        for support in &structure.supports {
            nodes.push(support.node);
            if let Some(dof) = self.dofs.of(support.node, support.component) {
                supported[dof] = true;
                let taker = &mut taker[self.elimination.class(dof)];
                *taker = (*taker).min(dof);
            }
        }
        let mut reaction = vec![0.0; forces.len()];
        for (dof, force) in forces.iter().enumerate() {
            if self.elimination.is_held(dof) {
                // A held class has a support, hence a taker.
                let at = if supported[dof] { dof } else { taker[self.elimination.class(dof)] };
                reaction[at] += force;
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        let value = |node, component| {
            let dof = self.dofs.of(node, component);
            dof.map_or(0.0, |dof| reaction[dof])
        };
        nodes
            .into_iter()
            .map(|node| Reaction {
                node,
                force: [value(node, Component::X), value(node, Component::Y)],
                moment: value(node, Component::R),
            })
            .collect()
    }
}

/// (N, Q, M) at the start and end of a bar element; zeros for anything else.
fn bar_end_forces(structure: &Structure, index: usize, u: &Displacements, line: [f64; 2]) -> [[f64; 3]; 2] {
    let element = &structure.elements[index];
    let material = &structure.materials[element.material];
    let Some(axis) = Axis::of(structure, element) else {
        return [[0.0; 3]; 2];
    };
    let values: Vec<f64> = slots(element)
        .iter()
        .map(|slot| match slot {
            Some((node, Component::X)) => u.0[*node][0],
            Some((node, Component::Y)) => u.0[*node][1],
            Some((node, Component::R)) => u.0[*node][2],
            None => 0.0,
        })
        .collect();
    let e = material.youngs_modulus;
    match (&element.kind, &values[..]) {
        (ElementKind::Frame { area, inertia, hinges }, &[a, b, c, d, f, g]) => {
            frame::end_forces(&axis, e, *area, *inertia, *hinges, &[a, b, c, d, f, g], line)
        }
        (ElementKind::Truss { area }, &[a, b, c, d]) => truss::end_forces(&axis, e, *area, &[a, b, c, d], line),
        _ => [[0.0; 3]; 2],
    }
}

/// Mean length of the frame elements; 1 if there are none.
pub(super) fn mean_frame_length(structure: &Structure) -> f64 {
    let lengths: Vec<f64> = structure
        .elements
        .iter()
        .filter(|element| matches!(element.kind, ElementKind::Frame { .. }))
        .filter_map(|element| Axis::of(structure, element))
        .map(|axis| axis.length)
        .collect();
    if lengths.is_empty() { 1.0 } else { lengths.iter().sum::<f64>() / lengths.len() as f64 }
}
