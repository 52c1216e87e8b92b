//! Finite elements: in every file stiffness, load, recovery, in that order.
//!
//! Sizes are fixed and small (nalgebra); the degrees of freedom of an element are named by [`slots`].

pub mod frame;
pub mod quad4;
pub mod spring;
pub mod truss;

use nalgebra::{DVector, SMatrix};

use super::error::MainSystemError;
use crate::model::structure::{Component, Element, ElementKind, Structure};

/// A place in an element's stiffness: node and component; `None` for a rotation released by a hinge.
pub type Slot = Option<(usize, Component)>;

/// The slots of an element's rows in their order: frame u_x, u_y, θ per node; truss and quad u_x, u_y per node. A
/// released (hinged) end of a frame has no slot for its rotation: its row is condensed out and zero.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    at: [Slot; 8],
    count: usize,
}

impl std::ops::Deref for Slots {
    type Target = [Slot];

    fn deref(&self) -> &[Slot] {
        &self.at[..self.count]
    }
}

/// See [`Slots`].
pub fn slots(element: &Element) -> Slots {
    let mut slots = Slots { at: [None; 8], count: 0 };
    let mut push = |slot| {
        slots.at[slots.count] = slot;
        slots.count += 1;
    };
    for (end, &node) in element.nodes.iter().enumerate() {
        push(Some((node, Component::X)));
        push(Some((node, Component::Y)));
        if let ElementKind::Frame { hinges, .. } = &element.kind {
            push((!hinges[end]).then_some((node, Component::R)));
        }
    }
    slots
}

/// Stiffness of an element, in the upper left corner of an array that holds the largest.
pub type Stiffness = SMatrix<f64, 8, 8>;

/// Stiffness of element number `index` in global axes, rows as in [`slots`]; forces per displacement.
///
/// # Errors
/// A bar without length or a quad that is not convex and counter-clockwise.
pub fn stiffness(structure: &Structure, index: usize) -> Result<Stiffness, MainSystemError> {
    let element = &structure.elements[index];
    let material = &structure.materials[element.material];
    let refuse = |what: &str| MainSystemError::Element {
        nodes: element.nodes.iter().map(|&node| structure.nodes[node].id.clone()).collect(),
        what: what.to_owned(),
    };
    let axis = || Axis::of(structure, element).ok_or_else(|| refuse("its two nodes are at the same place"));
    let mut stiffness = Stiffness::zeros();
    match &element.kind {
        ElementKind::Frame { area, inertia, hinges } => {
            let k = frame::stiffness(&axis()?, material.youngs_modulus, *area, *inertia, *hinges);
            stiffness.fixed_view_mut::<6, 6>(0, 0).copy_from(&k);
        }
        ElementKind::Truss { area } => {
            let k = truss::stiffness(&axis()?, material.youngs_modulus, *area);
            stiffness.fixed_view_mut::<4, 4>(0, 0).copy_from(&k);
        }
        ElementKind::Quad { thickness, plane } => {
            let corners = corners(structure, element);
            stiffness = quad4::stiffness(&corners, &quad4::elasticity(material, *plane), *thickness)
                .ok_or_else(|| refuse("it is not convex, or its nodes do not go round counter-clockwise"))?;
        }
    }
    Ok(stiffness)
}

/// Nodal forces that stand for a uniform force `q` per unit length on the bar `index`, global axes, rows as in
/// [`slots`]. Zero for a bar without length (refused by [`stiffness`]) and for a quad (it has no line).
pub fn line_load(structure: &Structure, index: usize, q: [f64; 2]) -> DVector<f64> {
    let element = &structure.elements[index];
    match (&element.kind, Axis::of(structure, element)) {
        (ElementKind::Frame { hinges, .. }, Some(axis)) => {
            DVector::from_column_slice(frame::line_load(&axis, *hinges, q).as_slice())
        }
        (ElementKind::Truss { .. }, Some(axis)) => DVector::from_column_slice(truss::line_load(&axis, q).as_slice()),
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
        (length > 0.0).then(|| Axis { length, cos: dx / length, sin: dy / length })
    }

    /// Components in bar axes (x from start to end, y = x turned +90°) of a global vector.
    pub fn to_local(self, v: [f64; 2]) -> [f64; 2] {
        [self.cos * v[0] + self.sin * v[1], self.cos * v[1] - self.sin * v[0]]
    }
}
