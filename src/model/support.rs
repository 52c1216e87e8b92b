//! What holds nodes: supports, ties, rigid bodies and springs.

use super::node::Component;

/// A displacement component held by a support.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// The node.
    pub node: usize,
    /// The component that is held.
    pub component: Component,
}

/// Nodes that share displacement components.
#[derive(Clone, Debug, PartialEq)]
pub struct Tie {
    /// Two or more nodes.
    pub nodes: Vec<usize>,
    /// The shared components.
    pub components: Vec<Component>,
}

/// Nodes that move as one body: u_i = u_0 + θ × (x_i − x_0), small displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Name in the file.
    pub id: String,
    /// Its nodes, two or more; the first is the one whose displacement and rotation are the body's unknowns.
    pub nodes: Vec<usize>,
}

/// Linear spring: it resists the stretch Σ factor·u of its terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Components that stretch it: those of one node, to the ground, or of two nodes with opposite factors.
    pub terms: Vec<SpringTerm>,
    /// Force per stretch, or moment per rotation, ≥ 0.
    pub stiffness: f64,
}

/// What one component of a node does to a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringTerm {
    /// The node.
    pub node: usize,
    /// The component.
    pub component: Component,
    /// Stretch per displacement.
    pub factor: f64,
}

impl Spring {
    /// From a node to the ground, or to another node, along a unit vector.
    pub fn along(node: usize, other: Option<usize>, direction: [f64; 3], stiffness: f64) -> Spring {
        Spring::of(node, other, Component::TRANSLATIONS.into_iter().zip(direction), stiffness)
    }

    /// Against the rotation of a node about a unit vector, or between those of two nodes.
    pub fn about(node: usize, other: Option<usize>, axis: [f64; 3], stiffness: f64) -> Spring {
        let components = Component::ROTATIONS.into_iter().zip(axis);
        Spring::of(node, other, components.filter(|(_, a)| *a != 0.0), stiffness)
    }

    fn of(
        node: usize,
        other: Option<usize>,
        components: impl Iterator<Item = (Component, f64)> + Clone,
        stiffness: f64,
    ) -> Spring {
        let ends = [Some((node, 1.0)), other.map(|other| (other, -1.0))];
        let terms = ends.into_iter().flatten().flat_map(|(node, sign)| {
            let term = move |(component, a): (Component, f64)| SpringTerm { node, component, factor: sign * a };
            components.clone().map(term)
        });
        Spring { terms: terms.collect(), stiffness }
    }

    /// Its nodes, each once.
    pub fn nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = self.terms.iter().map(|term| term.node).collect();
        nodes.dedup();
        nodes
    }

    /// Whether its other end is the ground.
    pub fn is_to_ground(&self) -> bool {
        self.nodes().len() == 1
    }
}
