//! Loads, resolved: on nodes, on elements, and displacements imposed on supports.

use super::node::Component;
use super::parameter::Number;

/// One resolved part of a load case, per unit factor.
#[derive(Clone, Debug, PartialEq)]
pub enum Load {
    /// Force and moment at a node. Edge loads (`point` on an edge, `traction`) arrive here
    /// already made consistent, one per edge node.
    Nodal {
        /// The node.
        node: usize,
        /// (F_x, F_y, F_z).
        force: [f64; 3],
        /// (M_x, M_y, M_z), in the plane M_z alone; not zero only at nodes with a rotation.
        moment: [f64; 3],
    },
    /// What acts on an element apart from its nodes; the element makes nodal forces of it.
    Element {
        /// Index into [`Structure::elements`](super::structure::Structure::elements).
        element: usize,
        /// What acts.
        load: ElementLoad,
    },
    /// Displacement imposed on a component that a support holds.
    Settlement {
        /// The node.
        node: usize,
        /// The component.
        component: Component,
        /// Displacement, or rotation.
        value: f64,
    },
}

/// What acts on an element, apart from its nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElementLoad {
    /// Force per unit length of a frame or truss element, linear along it, global axes.
    Line {
        /// Distances from the start of the element between which it acts.
        range: [f64; 2],
        /// (q_x, q_y, q_z) at both of them.
        value: [[f64; 3]; 2],
    },
    /// Force and moment between the nodes of a frame or truss element.
    Point {
        /// Distance from the start of the element.
        distance: f64,
        /// (F_x, F_y, F_z), global axes.
        force: [f64; 3],
        /// (M_x, M_y, M_z); in the plane M_z alone, counter-clockwise.
        moment: [f64; 3],
    },
    /// Uniform force per volume of any element, global axes: (b_x, b_y, b_z).
    Body([f64; 3]),
    /// What an element would do if nothing held it: temperature, lack of fit, prestress.
    FreeStrain {
        /// Along a bar; in all directions of a membrane or a solid.
        strain: f64,
        /// Of a frame bar in its local x–y plane, > 0 when the −y side is the longer one, and in x–z likewise.
        curvature: [f64; 2],
    },
}

impl Load {
    /// Whether it is no load at all.
    pub fn is_nothing(&self) -> bool {
        match self {
            Load::Nodal { force, moment, .. } => *force == [0.0; 3] && *moment == [0.0; 3],
            Load::Element { load, .. } => load.is_nothing(),
            Load::Settlement { value, .. } => *value == 0.0,
        }
    }
}

impl ElementLoad {
    /// Whether it is no load at all.
    pub fn is_nothing(&self) -> bool {
        match self {
            ElementLoad::Line { value, .. } => *value == [[0.0; 3]; 2],
            ElementLoad::Point { force, moment, .. } => *force == [0.0; 3] && *moment == [0.0; 3],
            ElementLoad::Body(force) => *force == [0.0; 3],
            ElementLoad::FreeStrain { strain, curvature } => *strain == 0.0 && *curvature == [0.0; 2],
        }
    }
}

/// A named load case: `factor` × the sum of its loads.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCase {
    /// Name in the file.
    pub name: String,
    /// Factor, may be a parameter.
    pub factor: Number,
    /// The loads per unit factor.
    pub loads: Vec<Load>,
}
