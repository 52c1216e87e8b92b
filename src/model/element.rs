//! Finite elements as data: their nodes, what they are made of, and how they lie in the structure.
//!
//! [`crate::fem`] says how they carry force, in one file for each kind.

use super::node::Component;
use super::shape::{Shape, side_corners};
use super::space_section::{EndJoint, SpaceSection};

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
    /// G = E/2(1 + ν), force per area.
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
        /// Whether a membrane of four nodes has modes of its own besides those of its nodes, so that it bends freely.
        incompatible: bool,
    },
    /// Two-node frame element in space, `nodes` = [start, end].
    SpaceFrame {
        /// Cross-section.
        section: SpaceSection,
        /// A vector in the local x–y plane; `None` for the common one (see
        /// [`BarAxes::in_space`](super::bar_axes::BarAxes::in_space)).
        orientation: Option<[f64; 3]>,
        /// How start and end are joined to their nodes.
        joints: [EndJoint; 2],
    },
    /// Two-node bar in space that carries axial force only, `nodes` = [start, end].
    SpaceTruss {
        /// Cross-section area.
        area: f64,
        /// As for a frame; used for loads across the bar.
        orientation: Option<[f64; 3]>,
    },
    /// Tetrahedron of 4 or 10 nodes, hexahedron of 8 or 20, in the order of
    /// [`shape_functions`](super::shape_functions).
    Solid {
        /// Whether a hexahedron of eight nodes has modes of its own besides those of its nodes, so that it bends
        /// freely.
        incompatible: bool,
    },
}

impl ElementKind {
    /// Whether it has incompatible modes.
    pub fn is_incompatible(&self) -> bool {
        matches!(self, ElementKind::Membrane { incompatible: true, .. } | ElementKind::Solid { incompatible: true })
    }
}

/// One finite element.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// As many as its shape has: 2 (frame, truss), 3, 4, 6, 8 (membrane), or 4, 8, 10, 20 (solid).
    pub nodes: Vec<usize>,
    /// Index into [`Structure::materials`](super::structure::Structure::materials).
    pub material: usize,
    /// Kind and its data.
    pub kind: ElementKind,
}

impl Element {
    /// Line, triangle, quadrilateral, tetrahedron or hexahedron, with how many nodes.
    pub fn shape(&self) -> Shape {
        match (&self.kind, self.nodes.len()) {
            (ElementKind::Solid { .. }, 4) => Shape::Tetrahedron4,
            (ElementKind::Solid { .. }, 10) => Shape::Tetrahedron10,
            (ElementKind::Solid { .. }, 20) => Shape::Hexahedron20,
            (ElementKind::Solid { .. }, _) => Shape::Hexahedron8,
            (ElementKind::Membrane { .. }, 3) => Shape::Triangle3,
            (ElementKind::Membrane { .. }, 6) => Shape::Triangle6,
            (ElementKind::Membrane { .. }, 8) => Shape::Quad8,
            (ElementKind::Membrane { .. }, _) => Shape::Quad4,
            _ => Shape::Line2,
        }
    }

    /// The displacements of its node number `at` that strain it: a hinge leaves out the rotation.
    pub fn components(&self, at: usize) -> &'static [Component] {
        match &self.kind {
            ElementKind::Frame { hinges, .. } if !hinges[at] => &[Component::X, Component::Y, Component::Rz],
            ElementKind::Frame { .. } | ElementKind::Truss { .. } | ElementKind::Membrane { .. } => {
                &[Component::X, Component::Y]
            }
            ElementKind::SpaceFrame { joints, .. } if joints[at] != EndJoint::Ball => &Component::ALL,
            ElementKind::SpaceFrame { .. } | ElementKind::SpaceTruss { .. } | ElementKind::Solid { .. } => {
                &Component::TRANSLATIONS
            }
        }
    }

    /// Whether its end number `at` turns with its node.
    pub fn turns_with(&self, at: usize) -> bool {
        match &self.kind {
            ElementKind::Frame { hinges, .. } => !hinges[at],
            ElementKind::SpaceFrame { joints, .. } => joints[at] == EndJoint::Rigid,
            _ => false,
        }
    }

    /// Whether it bends, so that its nodes have rotations.
    pub fn bends(&self) -> bool {
        matches!(self.kind, ElementKind::Frame { .. } | ElementKind::SpaceFrame { .. })
    }

    /// What its length (bars), area (membranes) or volume (solids) is multiplied by to give its volume.
    pub fn area(&self) -> f64 {
        match &self.kind {
            ElementKind::Frame { area, .. } | ElementKind::Truss { area } | ElementKind::SpaceTruss { area, .. } => {
                *area
            }
            ElementKind::SpaceFrame { section, .. } => section.area,
            ElementKind::Membrane { thickness, .. } => *thickness,
            ElementKind::Solid { .. } => 1.0,
        }
    }

    /// Area and second moments of area of the cross-section of one that bends: one in the plane, I_y and I_z in space.
    pub fn section(&self) -> Option<(f64, Vec<f64>)> {
        match self.kind {
            ElementKind::Frame { area, inertia, .. } => Some((area, vec![inertia])),
            ElementKind::SpaceFrame { section: SpaceSection { area, inertia_y, inertia_z, .. }, .. } => {
                Some((area, vec![inertia_y, inertia_z]))
            }
            _ => None,
        }
    }

    /// Its sides from corner to corner; the one line of a bar.
    pub fn sides(&self) -> impl Iterator<Item = [usize; 2]> {
        let shape = self.shape();
        let corners = shape.corners();
        let of_solid = shape.sides_of_solid().iter().copied();
        let round = match shape.dimension() {
            1 => 0..1,
            2 => 0..corners,
            _ => 0..0,
        };
        let round = round.map(move |side| [side, (side + 1) % corners]);
        round.chain(of_solid).map(|ends| ends.map(|end| self.nodes[end]))
    }

    /// Neighbours along its sides: corner to corner, or to the node in the middle and on.
    pub fn neighbours(&self) -> Vec<[usize; 2]> {
        let middles = self.nodes[self.shape().corners()..].iter();
        if !self.shape().is_quadratic() {
            return self.sides().collect();
        }
        self.sides().zip(middles).flat_map(|([a, b], &middle)| [[a, middle], [middle, b]]).collect()
    }

    /// The borders over which neighbours move with it: sides of bars and areas, faces of solids, as corner nodes in
    /// increasing order, `usize::MAX` after the last.
    pub fn borders(&self) -> impl Iterator<Item = [usize; 4]> {
        let border = |nodes: &[usize]| {
            let mut border = [usize::MAX; 4];
            border[..nodes.len()].copy_from_slice(nodes);
            border.sort_unstable();
            border
        };
        let is_solid = self.shape().is_solid();
        let sides = self.sides().filter(move |_| !is_solid).map(move |ends| border(&ends));
        let faces = self.shape().faces().into_iter().map(move |places| {
            let nodes: Vec<usize> =
                places[..side_corners(places.len())].iter().map(|&place| self.nodes[place]).collect();
            border(&nodes)
        });
        sides.chain(faces)
    }

    /// The nodes of an area as they lie round it, middle nodes between their corners; the two of a bar, none of a
    /// solid.
    pub fn ring(&self) -> impl Iterator<Item = usize> {
        let shape = self.shape();
        let corners = if shape.is_solid() { 0 } else { shape.corners() };
        (0..corners).flat_map(move |k| [Some(self.nodes[k]), self.nodes.get(corners + k).copied()]).flatten()
    }
}
