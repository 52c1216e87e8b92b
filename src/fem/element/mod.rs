//! Finite elements, one file each: stiffness, loads, recovery, in that order.
//!
//! A [`FiniteElement`] holds all that the rest of the program must know of an element; nothing else asks which one it
//! is. [`slots`] tells which displacements its rows are, and [`Element`](crate::model::structure::Element) how it lies
//! among others.

mod acting;
pub mod bar_load;
mod beam;
mod finite_element;
mod frame;
mod incompatible;
mod jacobian;
mod membrane;
mod space;
pub mod spring;
mod truss;

pub use self::acting::Acting;
use self::finite_element::NO_LENGTH;
pub use self::finite_element::{FiniteElement, Number, Stiffness, Stress};
use self::frame::Frame;
use self::membrane::Membrane;
use self::space::{Solid, SpaceFrame};
use self::truss::Truss;
use super::error::MainSystemError;
use crate::model::bar_axes::AxesFault;
use crate::model::structure::{Component, Element, ElementKind, Spring, Structure};

/// A row of an element's stiffness: node and component.
pub type Slot = (usize, Component);

/// The finite element of element number `index`.
///
/// # Errors
/// What is wrong with its shape, in words that follow its name.
pub fn finite_element(structure: &Structure, index: usize) -> Result<Box<dyn FiniteElement + '_>, &'static str> {
    let element = &structure.elements[index];
    let material = &structure.materials[element.material];
    let nodes = || element.nodes.iter().map(|&node| structure.nodes[node].in_plane());
    let places = || element.nodes.iter().map(|&node| structure.nodes[node].position);
    let ends = || [0, 1].map(|end| structure.nodes[element.nodes[end]].in_plane());
    let ends_in_space = || [0, 1].map(|end| structure.nodes[element.nodes[end]].position);
    Ok(match element.kind {
        ElementKind::Frame { area, inertia, shear_area, hinges } => {
            Box::new(Frame::new(ends(), material, [area, inertia], shear_area, hinges).ok_or(NO_LENGTH)?)
        }
        ElementKind::Truss { area } => Box::new(Truss::in_plane(ends(), material, area).ok_or(NO_LENGTH)?),
        ElementKind::Membrane { thickness, plane, incompatible } => {
            Box::new(Membrane { nodes: nodes().collect(), material, plane, thickness, incompatible })
        }
        ElementKind::SpaceFrame { ref section, orientation, joints } => {
            let frame = SpaceFrame::new(ends_in_space(), orientation, material, section, joints);
            Box::new(frame.map_err(AxesFault::words)?)
        }
        ElementKind::SpaceTruss { area, orientation } => {
            let truss = Truss::in_space(ends_in_space(), orientation, material, area);
            Box::new(truss.map_err(AxesFault::words)?)
        }
        ElementKind::Solid { incompatible } => Box::new(Solid { nodes: places().collect(), material, incompatible }),
    })
}

/// The displacements of an element's rows in their order, node by node.
pub fn slots(element: &Element) -> Vec<Slot> {
    let mut slots = Vec::with_capacity(3 * element.nodes.len());
    for (at, &node) in element.nodes.iter().enumerate() {
        slots.extend(element.components(at).iter().map(|&component| (node, component)));
    }
    slots
}

/// Range of stiffnesses: beyond it, products of them overflow, or lose digits to underflow.
const STIFFNESSES: std::ops::Range<f64> = 1e-200..1e200;

/// Range of the sizes of elements: their third power is then well within the range of f64.
const SIZES: std::ops::Range<f64> = 1e-60..1e60;

/// Stiffness of element number `index` in global axes, rows as in [`slots`]; forces per displacement.
///
/// # Errors
/// A bar without length, a membrane that is turned inside out somewhere, a stiffness too large or small for numbers.
pub fn stiffness<T: Number>(structure: &Structure, index: usize) -> Result<Stiffness<T>, MainSystemError> {
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
    let stiffness = finite_element(structure, index).and_then(|element| T::stiffness(&*element));
    let stiffness = stiffness.map_err(|what| refuse(what.to_owned()))?;
    // A row of zeros is an idle one; where all are zero, the stiffness is too small for f64.
    let diagonal = || (0..stiffness.nrows()).map(|i| stiffness[(i, i)].to_f64());
    let all_zero = diagonal().all(|k| k == 0.0);
    if let Some(k) = diagonal().find(|k| (*k != 0.0 || all_zero) && !STIFFNESSES.contains(k)) {
        let advice = "check its material, section and thickness, or use other units";
        return Err(refuse(beyond("stiffness", k, &STIFFNESSES, advice)));
    }
    Ok(stiffness)
}

/// Whether the stiffness of a spring can be computed with.
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
    format!("its {what} is {value:.1e}, and only numbers from {start:.0e} to {end:.0e} can be computed with: {advice}")
}

/// Largest difference of a coordinate between two nodes of an element.
fn extent(structure: &Structure, element: &Element) -> f64 {
    let place = |node: usize, c: usize| structure.nodes[node].position[c];
    let first = element.nodes[0];
    let differences =
        element.nodes.iter().flat_map(|&node| [0, 1, 2].map(|c| (place(node, c) - place(first, c)).abs()));
    differences.fold(0.0, f64::max)
}
