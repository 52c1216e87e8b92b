//! Numbering of the displacement components.

use super::doubled::Real;
use crate::model::pair::Joint;
use crate::model::structure::{Component, ElementKind, Structure};

/// Components in the order x, y, r.
const COMPONENTS: [Component; 3] = [Component::X, Component::Y, Component::R];

/// Numbers of the nodal components ("base dofs"): x, y at every node, r where a frame bar is rigidly attached
/// and at the nodes of rigid bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Dofs {
    first: Vec<u32>,
    has_rotation: Vec<bool>,
    count: usize,
    frame_nodes_only_hinged: usize,
}

impl Dofs {
    /// Numbers the components node by node.
    pub fn new(structure: &Structure) -> Dofs {
        let mut frame = vec![false; structure.nodes.len()];
        let mut has_rotation = vec![false; structure.nodes.len()];
        for element in &structure.elements {
            if let ElementKind::Frame { hinges, .. } = &element.kind {
                for (end, &node) in element.nodes.iter().enumerate() {
                    frame[node] = true;
                    has_rotation[node] |= !hinges[end];
                }
            }
        }
        for &node in structure.rigid.iter().flat_map(|body| &body.nodes) {
            has_rotation[node] = true;
        }
        let mut count = 0;
        let first = has_rotation
            .iter()
            .map(|&rotation| {
                let first = count;
                count += if rotation { 3 } else { 2 };
                first as u32
            })
            .collect();
        let frame_nodes_only_hinged =
            std::iter::zip(&frame, &has_rotation).filter(|(frame, rotation)| **frame && !**rotation).count();
        Dofs { first, has_rotation, count, frame_nodes_only_hinged }
    }

    /// Number of base dofs.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Nodal components before supports and ties as they are reported: a frame node counts 3 even where all its
    /// bars are hinged.
    pub fn unknowns(&self) -> usize {
        self.count + self.frame_nodes_only_hinged
    }

    /// The base dof of a component; `None` for a rotation that does not exist.
    pub fn of(&self, node: usize, component: Component) -> Option<usize> {
        let first = self.first[node] as usize;
        match component {
            Component::X => Some(first),
            Component::Y => Some(first + 1),
            Component::R => self.has_rotation[node].then_some(first + 2),
        }
    }

    /// Displacements [u_x, u_y, θ] per node from base dofs; θ = 0 where there is none.
    pub fn scatter<T: Real>(&self, u: &[T]) -> Vec<[T; 3]> {
        std::iter::zip(&self.first, &self.has_rotation)
            .map(|(&first, &rotation)| {
                let first = first as usize;
                let theta = if rotation { u[first + 2] } else { T::zero() };
                [u[first], u[first + 1], theta]
            })
            .collect()
    }

    /// Base dofs from displacements per node.
    pub fn gather<T: Real>(&self, u: &[[T; 3]]) -> Vec<T> {
        let mut base = vec![T::zero(); self.count];
        for (node, values) in u.iter().enumerate() {
            for (component, value) in COMPONENTS.into_iter().zip(values) {
                if let Some(dof) = self.of(node, component) {
                    base[dof] = *value;
                }
            }
        }
        base
    }

    /// Node of each base dof.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        let components = self.has_rotation.iter().enumerate();
        components.flat_map(|(node, &rotation)| std::iter::repeat_n(node, if rotation { 3 } else { 2 }))
    }

    /// Which base dofs are rotations.
    pub fn is_rotation(&self) -> Vec<bool> {
        let mut rotations = vec![false; self.count];
        for (&first, &rotation) in std::iter::zip(&self.first, &self.has_rotation) {
            if rotation {
                rotations[first as usize + 2] = true;
            }
        }
        rotations
    }
}

/// Root of a union-find tree, with path halving.
pub(super) fn root(parent: &mut [u32], mut at: usize) -> usize {
    while parent[at] as usize != at {
        parent[at] = parent[parent[at] as usize];
        at = parent[at] as usize;
    }
    at
}

/// The (side, (base dof, coefficient)) of a joint, zero coefficients left out; side 0 is `node`.
pub fn joint_dofs<'a>(joint: &'a Joint, dofs: &'a Dofs) -> impl Iterator<Item = (usize, (usize, f64))> + 'a {
    joint
        .terms
        .iter()
        .enumerate()
        .flat_map(move |(side, (node, a))| {
            let x = dofs.of(*node, Component::X).map(|dof| (dof, a[0]));
            let y = dofs.of(*node, Component::Y).map(|dof| (dof, a[1]));
            [x, y].into_iter().flatten().map(move |term| (side, term))
        })
        .filter(|(_, (_, a))| *a != 0.0)
}
