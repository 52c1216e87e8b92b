//! Finite elements as data: their nodes, what they are made of, and how they lie in the structure.
//!
//! How they carry force is told by [`crate::fem`], in one file for each kind.

use super::node::Component;
use super::shape::Shape;

/// Linear elastic material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, > 0.
    pub youngs_modulus: f64,
    /// Poisson's ratio in (−1, 0.5].
    pub poisson_ratio: f64,
    /// Mass per volume.
    pub density: f64,
    /// Coefficient of thermal expansion.
    pub expansion: f64,
}

impl Material {
    /// G = E/2(1 + ν).
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }
}

/// Stress state of a plate or quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// ε_zz = 0.
    Strain,
    /// σ_zz = 0.
    Stress,
}

/// What an element is made of and how it carries force.
#[derive(Clone, Debug, PartialEq)]
pub enum ElementKind {
    /// Two-node frame element, `nodes` = [start, end].
    Frame {
        /// Cross-section area.
        area: f64,
        /// Second moment of area.
        inertia: f64,
        /// Shear area; `None` for a bar that does not yield to shear.
        shear_area: Option<f64>,
        /// Moment hinge at start, at end.
        hinges: [bool; 2],
    },
    /// Two-node bar that carries axial force only, `nodes` = [start, end].
    Truss {
        /// Cross-section area.
        area: f64,
    },
    /// Membrane of 3, 4, 6 or 8 nodes, counter-clockwise: corners, then the middles of the sides 1-2, 2-3, ….
    Membrane {
        /// Thickness out of the plane.
        thickness: f64,
        /// Stress state.
        plane: Plane,
        /// Whether a membrane of four nodes has modes of its own beside those of its nodes, so that it bends freely.
        incompatible: bool,
    },
}

/// One finite element.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// As many as its shape has: 2 (frame, truss), or 3, 4, 6, 8 (membrane).
    pub nodes: Vec<usize>,
    /// Index into [`Structure::materials`](super::structure::Structure::materials).
    pub material: usize,
    /// Kind and its data.
    pub kind: ElementKind,
}

impl Element {
    /// Line, triangle or quadrilateral, with how many nodes.
    pub fn shape(&self) -> Shape {
        match (&self.kind, self.nodes.len()) {
            (ElementKind::Frame { .. } | ElementKind::Truss { .. }, _) => Shape::Line2,
            (ElementKind::Membrane { .. }, 3) => Shape::Triangle3,
            (ElementKind::Membrane { .. }, 6) => Shape::Triangle6,
            (ElementKind::Membrane { .. }, 8) => Shape::Quad8,
            (ElementKind::Membrane { .. }, _) => Shape::Quad4,
        }
    }

    /// The displacements of its node number `at` that strain it: a hinge leaves out the rotation.
    pub fn components(&self, at: usize) -> &'static [Component] {
        match &self.kind {
            ElementKind::Frame { hinges, .. } if !hinges[at] => &[Component::X, Component::Y, Component::Rz],
            ElementKind::Frame { .. } | ElementKind::Truss { .. } | ElementKind::Membrane { .. } => {
                &[Component::X, Component::Y]
            }
        }
    }

    /// Whether it bends, so that its nodes have rotations.
    pub fn bends(&self) -> bool {
        matches!(self.kind, ElementKind::Frame { .. })
    }

    /// What its length (bars) or area (membranes) is multiplied with to give its volume.
    pub fn area(&self) -> f64 {
        match &self.kind {
            ElementKind::Frame { area, .. } | ElementKind::Truss { area } => *area,
            ElementKind::Membrane { thickness, .. } => *thickness,
        }
    }

    /// Area and second moment of area of the cross-section of one that bends.
    pub fn section(&self) -> Option<[f64; 2]> {
        match self.kind {
            ElementKind::Frame { area, inertia, .. } => Some([area, inertia]),
            ElementKind::Truss { .. } | ElementKind::Membrane { .. } => None,
        }
    }

    /// Its sides from corner to corner; the one line of a bar.
    pub fn sides(&self) -> impl Iterator<Item = [usize; 2]> {
        let corners = self.shape().corners();
        let count = if corners == 2 { 1 } else { corners };
        (0..count).map(move |side| [self.nodes[side], self.nodes[(side + 1) % corners]])
    }

    /// Its nodes as they lie round it, middle nodes between their corners; the two of a bar.
    pub fn ring(&self) -> impl Iterator<Item = usize> {
        let corners = self.shape().corners();
        (0..corners).flat_map(move |k| [Some(self.nodes[k]), self.nodes.get(corners + k).copied()]).flatten()
    }
}
