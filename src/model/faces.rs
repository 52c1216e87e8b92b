//! Sides of solid elements by their corners, to find faces among them.

use std::collections::HashMap;

use super::face::FaceSide;
use super::shape::{Shape, side_corners};

/// Sides of solids by their corner nodes.
#[derive(Default)]
pub struct Faces {
    by_corners: HashMap<Box<[usize]>, Vec<FaceSide>>,
}

fn key(nodes: &[usize]) -> Box<[usize]> {
    let mut key: Box<[usize]> = nodes[..side_corners(nodes.len())].into();
    key.sort_unstable();
    key
}

impl Faces {
    /// Adds those of an element.
    pub fn add(&mut self, element: usize, shape: Shape, nodes: &[usize]) {
        for face in shape.faces() {
            let side = FaceSide { element, nodes: face.iter().map(|&place| nodes[place]).collect() };
            self.by_corners.entry(key(&side.nodes)).or_default().push(side);
        }
    }

    /// The sides with these corners, the first of `nodes` in any order: two inside a body, one on its surface.
    pub fn at(&self, nodes: &[usize]) -> &[FaceSide] {
        self.by_corners.get(&key(nodes)).map_or(&[], Vec::as_slice)
    }

    /// The sides of one element only, in the order of elements.
    pub fn surface(&self) -> Vec<&FaceSide> {
        let mut surface: Vec<&FaceSide> =
            self.by_corners.values().filter(|sides| sides.len() == 1).map(|sides| &sides[0]).collect();
        surface.sort_unstable_by(|a, b| (a.element, &a.nodes).cmp(&(b.element, &b.nodes)));
        surface
    }
}
