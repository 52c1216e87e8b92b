//! Finite elements: in every file stiffness, load, recovery, in that order.
//!
//! Sizes are fixed and small (nalgebra); the degrees of freedom of an element are named by [`slots`].

pub mod frame;
pub mod quad4;
pub mod spring;
pub mod truss;

use nalgebra::{DMatrix, DVector};

use super::error::MainSystemError;
use crate::model::structure::{Component, Element, ElementKind, Structure};

/// The (node, component) of each row of the element's stiffness, in its order: frame u_x, u_y, θ per node;
/// truss and quad u_x, u_y per node. A released (hinged) end of a frame has no slot for its rotation: its row
/// is condensed out and zero, marked `None`.
pub fn slots(element: &Element) -> Vec<Option<(usize, Component)>> {
    let mut slots = Vec::with_capacity(8);
    for (end, &node) in element.nodes.iter().enumerate() {
        slots.push(Some((node, Component::X)));
        slots.push(Some((node, Component::Y)));
        if let ElementKind::Frame { hinges, .. } = &element.kind {
            slots.push((!hinges[end]).then_some((node, Component::R)));
        }
    }
    slots
}

/// Stiffness of element number `index` in global axes, rows as in [`slots`]; forces per displacement.
///
/// # Errors
/// A bar without length or a quad that is not convex and counter-clockwise.
pub fn stiffness(structure: &Structure, index: usize) -> Result<DMatrix<f64>, MainSystemError> {
    let element = &structure.elements[index];
    let material = &structure.materials[element.material];
    let refuse = |what: &str| MainSystemError::Element {
        nodes: element
            .nodes
            .iter()
            .map(|&node| structure.nodes[node].id.clone())
            .collect(),
        what: what.to_owned(),
    };
    Ok(match &element.kind {
        ElementKind::Frame {
            area,
            inertia,
            hinges,
        } => {
            let axis = Axis::of(structure, element)
                .ok_or_else(|| refuse("its two nodes are at the same place"))?;
            let k = frame::stiffness(&axis, material.youngs_modulus, *area, *inertia, *hinges);
            DMatrix::from_fn(6, 6, |i, j| k[(i, j)])
        }
        ElementKind::Truss { area } => {
            let axis = Axis::of(structure, element)
                .ok_or_else(|| refuse("its two nodes are at the same place"))?;
            let k = truss::stiffness(&axis, material.youngs_modulus, *area);
            DMatrix::from_fn(4, 4, |i, j| k[(i, j)])
        }
        ElementKind::Quad { thickness, plane } => {
            let corners = corners(structure, element);
            let k = quad4::stiffness(&corners, &quad4::elasticity(material, *plane), *thickness)
                .ok_or_else(|| {
                    refuse("it is not convex, or its nodes do not go round counter-clockwise")
                })?;
            DMatrix::from_fn(8, 8, |i, j| k[(i, j)])
        }
    })
}

/// Nodal forces that stand for a uniform force `q` per unit length on the bar `index`, global axes, rows as in
/// [`slots`]. Zero for a bar without length (refused by [`stiffness`]) and for a quad (it has no line).
pub fn line_load(structure: &Structure, index: usize, q: [f64; 2]) -> DVector<f64> {
    let element = &structure.elements[index];
    match (&element.kind, Axis::of(structure, element)) {
        (ElementKind::Frame { hinges, .. }, Some(axis)) => {
            DVector::from_column_slice(frame::line_load(&axis, *hinges, q).as_slice())
        }
        (ElementKind::Truss { .. }, Some(axis)) => {
            DVector::from_column_slice(truss::line_load(&axis, q).as_slice())
        }
        _ => DVector::zeros(slots(element).len()),
    }
}

/// Corners of a quad.
pub fn corners(structure: &Structure, element: &Element) -> [[f64; 2]; 4] {
    // A checked quad has four nodes.
    std::array::from_fn(|i| structure.nodes[element.nodes[i]].position)
}

/// Length and direction of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Length L.
    pub length: f64,
    /// cos of the angle from global x to local x.
    pub cos: f64,
    /// sin of it.
    pub sin: f64,
}

impl Axis {
    /// From the start node to the end node; `None` if they coincide.
    pub fn of(structure: &Structure, element: &Element) -> Option<Axis> {
        let [a, b] = [0, 1].map(|end| structure.nodes[element.nodes[end]].position);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        (length > 0.0).then(|| Axis {
            length,
            cos: dx / length,
            sin: dy / length,
        })
    }

    /// Components in bar axes (x from start to end, y = x turned +90°) of a global vector.
    pub fn to_local(&self, v: [f64; 2]) -> [f64; 2] {
        [
            self.cos * v[0] + self.sin * v[1],
            self.cos * v[1] - self.sin * v[0],
        ]
    }

    /// Global components of a vector in bar axes.
    pub fn to_global(&self, v: [f64; 2]) -> [f64; 2] {
        [
            self.cos * v[0] - self.sin * v[1],
            self.sin * v[0] + self.cos * v[1],
        ]
    }
}
