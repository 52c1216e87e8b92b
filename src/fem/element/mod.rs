//! Finite elements: in every file stiffness, load, recovery, in that order.
//!
//! Sizes are fixed and small (nalgebra); the degrees of freedom of an element are named by [`slots`].

pub mod bar_load;
pub mod frame;
mod incompatible;
pub mod membrane;
pub mod shape;
pub mod spring;
pub mod truss;

use nalgebra::SMatrix;

use self::bar_load::{BarLoad, Internal};
use self::frame::Frame;
use self::membrane::Membrane;
use self::shape::{MOST, Shape};
use super::doubled::Real;
use super::error::MainSystemError;
use crate::model::structure::{Component, Element, ElementKind, Spring, Structure};

/// Most rows of an element's stiffness.
pub const ROWS: usize = 2 * MOST;

/// A place in an element's stiffness: node and component; `None` for a rotation released by a hinge.
pub type Slot = Option<(usize, Component)>;

/// The slots of an element's rows in their order: frame u_x, u_y, θ per node; truss and membrane u_x, u_y per node. A
/// released (hinged) end of a frame has no slot for its rotation: its row is condensed out and zero.
#[derive(Clone, Copy, Debug)]
pub struct Slots {
    at: [Slot; ROWS],
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
    let mut slots = Slots { at: [None; ROWS], count: 0 };
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
pub type Stiffness<T = f64> = SMatrix<T, ROWS, ROWS>;

/// What a stiffness may be as a number: beyond, products of it lose digits to underflow, or overflow.
const STIFFNESSES: std::ops::Range<f64> = 1e-200..1e200;

/// What the size of an element may be: its third power is a number like any other.
const SIZES: std::ops::Range<f64> = 1e-60..1e60;

/// Stiffness of element number `index` in global axes, rows as in [`slots`]; forces per displacement.
///
/// # Errors
/// A bar without length, a membrane that is turned inside out somewhere, a stiffness too large or small for numbers.
pub fn stiffness<T: Real>(structure: &Structure, index: usize) -> Result<Stiffness<T>, MainSystemError> {
    let element = &structure.elements[index];
    let refuse = |what: String| MainSystemError::Element {
        name: structure.element_in_words(index),
        nodes: element.nodes.iter().map(|&node| structure.nodes[node].id.clone()).collect(),
        what,
    };
    let size = extent(structure, element);
    if size != 0.0 && !SIZES.contains(&size) {
        return Err(refuse(beyond("size", size, &SIZES, "use another unit of length")));
    }
    let mut stiffness = Stiffness::zeros();
    match element.kind {
        ElementKind::Frame { .. } | ElementKind::Truss { .. } => {
            let bar = BarElement::<T>::of(structure, index);
            match bar.ok_or_else(|| refuse("its two nodes are at the same place".to_owned()))? {
                BarElement::Frame(frame) => {
                    stiffness.fixed_view_mut::<6, 6>(0, 0).copy_from(&frame.stiffness());
                }
                BarElement::Truss(axis, axial) => {
                    stiffness.fixed_view_mut::<4, 4>(0, 0).copy_from(&truss::stiffness(&axis, axial));
                }
            }
        }
        ElementKind::Membrane { .. } => {
            stiffness = with_membrane(structure, index, |membrane| membrane.stiffness())
                .flatten()
                .ok_or_else(|| refuse("it is not convex, or its nodes do not go round counter-clockwise".to_owned()))?;
        }
    }
    // A row of zeros is a released or an idle one; nothing but zeros is a stiffness below every number.
    let all_zero = stiffness.diagonal().iter().all(|k| k.to_f64() == 0.0);
    let unusable = |k: &f64| (*k != 0.0 || all_zero) && !STIFFNESSES.contains(k);
    if let Some(k) = stiffness.diagonal().iter().map(|k| k.to_f64()).find(unusable) {
        let advice = "check its material, section and thickness, or use other units";
        return Err(refuse(beyond("stiffness", k, &STIFFNESSES, advice)));
    }
    Ok(stiffness)
}

/// Stiffness of a spring on u_x, u_y of its node.
///
/// # Errors
/// A stiffness too large or small for numbers.
pub fn check_spring(structure: &Structure, spring: &Spring) -> Result<(), MainSystemError> {
    if spring.stiffness != 0.0 && !STIFFNESSES.contains(&spring.stiffness) {
        let nodes: Vec<String> = spring.nodes().into_iter().map(|node| structure.nodes[node].id.clone()).collect();
        return Err(MainSystemError::Element {
            name: format!("the spring at {}", nodes.join(" and ")),
            nodes,
            what: beyond("stiffness", spring.stiffness, &STIFFNESSES, "use other units"),
        });
    }
    Ok(())
}

fn beyond(what: &str, value: f64, range: &std::ops::Range<f64>, advice: &str) -> String {
    let std::ops::Range { start, end } = range;
    format!("its {what} is {value:.1e}, and numbers from {start:.0e} to {end:.0e} can be computed with: {advice}")
}

/// Largest difference of a coordinate between two nodes of an element.
fn extent(structure: &Structure, element: &Element) -> f64 {
    let place = |node: usize, c: usize| structure.nodes[node].position[c];
    let first = element.nodes[0];
    let differences = element.nodes.iter().flat_map(|&node| [0, 1].map(|c| (place(node, c) - place(first, c)).abs()));
    differences.fold(0.0, f64::max)
}

/// A frame or truss element with its stiffnesses.
pub enum BarElement<T = f64> {
    /// Bends.
    Frame(Frame<T>),
    /// Axial force only: EA.
    Truss(Axis<T>, f64),
}

impl<T: Real> BarElement<T> {
    /// Element number `index`; `None` for a membrane or a bar without length.
    pub fn of(structure: &Structure, index: usize) -> Option<BarElement<T>> {
        let element = &structure.elements[index];
        let material = &structure.materials[element.material];
        let e = material.youngs_modulus;
        match &element.kind {
            ElementKind::Frame { area, inertia, shear_area, hinges } => Some(BarElement::Frame(Frame {
                axis: Axis::of(structure, element)?,
                axial: e * area,
                bending: e * inertia,
                shear: shear_area.map(|area| e / (2.0 * (1.0 + material.poisson_ratio)) * area),
                hinges: *hinges,
            })),
            ElementKind::Truss { area } => Some(BarElement::Truss(Axis::of(structure, element)?, e * area)),
            ElementKind::Membrane { .. } => None,
        }
    }
}

impl BarElement {
    /// Length and direction.
    pub fn axis(&self) -> &Axis {
        match self {
            BarElement::Frame(frame) => &frame.axis,
            BarElement::Truss(axis, _) => axis,
        }
    }

    /// Nodal forces in global axes that stand for the load between the nodes, rows as in [`slots`].
    pub fn nodal_forces(&self, load: &BarLoad) -> Vec<f64> {
        match self {
            BarElement::Frame(frame) => frame.nodal_forces(load).as_slice().to_vec(),
            BarElement::Truss(axis, axial) => truss::nodal_forces(axis, *axial, load).as_slice().to_vec(),
        }
    }

    /// (N, Q, M) at the start and at the end for the displacements `u` of its rows.
    pub fn end_forces(&self, u: &[f64], load: &BarLoad) -> [Internal; 2] {
        match self {
            BarElement::Frame(frame) => frame.end_forces(&std::array::from_fn(|i| u[i]), load),
            BarElement::Truss(axis, axial) => truss::end_forces(axis, *axial, &std::array::from_fn(|i| u[i]), load),
        }
    }
}

/// What `run` makes of element number `index` as a membrane; `None` for a bar.
pub fn with_membrane<T>(structure: &Structure, index: usize, run: impl FnOnce(&Membrane<'_>) -> T) -> Option<T> {
    let element = &structure.elements[index];
    let ElementKind::Membrane { thickness, plane, incompatible } = element.kind else { return None };
    let shape = Shape::of(element.nodes.len())?;
    let mut nodes = [[0.0; 2]; MOST];
    for (at, &node) in nodes.iter_mut().zip(&element.nodes) {
        *at = structure.nodes[node].position;
    }
    let nodes = &nodes[..element.nodes.len()];
    let material = &structure.materials[element.material];
    Some(run(&Membrane { shape, nodes, material, plane, thickness, incompatible }))
}

/// Length and direction of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis<T = f64> {
    /// Length L.
    pub length: T,
    /// cos of the angle from global x to local x.
    pub cos: T,
    /// sin of it.
    pub sin: T,
}

impl<T: Real> Axis<T> {
    /// From the start node to the end node; `None` if they coincide.
    pub fn of(structure: &Structure, element: &Element) -> Option<Axis<T>> {
        let [a, b] = [0, 1].map(|end| structure.nodes[element.nodes[end]].position);
        let size = (b[0] - a[0]).hypot(b[1] - a[1]);
        if size == 0.0 {
            return None;
        }
        // A power of two, so that no square is too small or too large for a number.
        let unit = size.log2().round().exp2();
        let [dx, dy] = [0, 1].map(|c| T::difference(b[c], a[c]) / T::from(unit));
        let length = (dx * dx + dy * dy).sqrt();
        Some(Axis { length: length * T::from(unit), cos: dx / length, sin: dy / length })
    }
}

impl Axis {
    /// Components in bar axes (x from start to end, y = x turned +90°) of a global vector.
    pub fn to_local(self, v: [f64; 2]) -> [f64; 2] {
        [self.cos * v[0] + self.sin * v[1], self.cos * v[1] - self.sin * v[0]]
    }

    /// Global components of a vector in bar axes.
    pub fn to_global(self, v: [f64; 2]) -> [f64; 2] {
        [self.cos * v[0] - self.sin * v[1], self.sin * v[0] + self.cos * v[1]]
    }
}
