//! Parts of a structure: elements that can only move as one rigid body.
//!
//! They have an edge in common (solids a face), or are frame bars rigidly attached to one node, or have two nodes in
//! one rigid body (solids three that are not on one line); a lone node is a part without rotation. A part of a
//! superelement moves as its stiffness lets it. Parts that share a node are pinned there.

use super::held_hinges::held_hinges;
use crate::model::groups::Groups;
use crate::model::structure::{Component, Structure};
use crate::model::superelement::Part;
use crate::model::vector::{cross, length, unit, way};

/// Parts at every node.
pub struct Parts {
    /// Part numbers at each node; the first moves it, all others are pinned to that.
    pub at_node: Vec<Vec<u32>>,
    /// The part that turns with the rotation of the node.
    pub turning: Vec<Option<u32>>,
    /// Whether a part can turn (is more than a lone node without rotations).
    pub turns: Vec<bool>,
    /// The part of each element.
    pub of_element: Vec<u32>,
    /// The part of each part of the superelement; `u32::MAX` for one that lies in another cluster.
    pub of_superelement: Vec<u32>,
}

/// Sines, and cosines of right angles, below this are rounding of coordinates.
pub const STRAIGHT: f64 = 1e-9;

/// The unit vector along the line on which all these nodes lie; `None` where they do not.
fn axis(structure: &Structure, nodes: &[usize]) -> Option<[f64; 3]> {
    let place = |node: usize| structure.nodes[node].position;
    let (&first, others) = nodes.split_first()?;
    let ways = || others.iter().map(|&node| way(place(first), place(node)));
    let longest = ways().max_by(|a, b| length(*a).total_cmp(&length(*b)))?;
    let along = unit(longest)?;
    ways().all(|way| length(cross(along, way)) <= STRAIGHT * length(longest)).then_some(along)
}

/// The nodes that turn by themselves: bars transmit nothing to them but their torque, or no moment at all.
fn turning_alone(structure: &Structure, turning: &[Option<u32>]) -> Vec<usize> {
    let mut alone = held_hinges(structure);
    for element in &structure.elements {
        for (at, &node) in element.nodes.iter().enumerate() {
            alone[node] |= turning[node].is_none() && element.components(at).contains(&Component::Rx);
        }
    }
    (0..structure.nodes.len()).filter(|&node| alone[node]).collect()
}

/// The parts of the superelement, if there is one.
pub fn superelement_parts(structure: &Structure) -> &[Part] {
    structure.superelement.as_ref().map_or(&[], |element| &element.parts)
}

impl Parts {
    /// From the elements, bodies and the superelement of a structure.
    pub fn new(structure: &Structure) -> Parts {
        // Rigid bodies count as elements, after the others, and so do the parts of a superelement.
        let elements = structure.elements.len();
        let beyond = elements + structure.rigid.len();
        let given = superelement_parts(structure);
        let mut groups = Groups::new(beyond + given.len());
        let mut join = |a: u32, b: u32| groups.join(a as usize, b as usize);
        // Elements that share a side, solids that share a face.
        let mut borders = Vec::new();
        for (index, element) in structure.elements.iter().enumerate() {
            borders.extend(element.borders().map(|nodes| (nodes, index as u32)));
        }
        borders.sort_unstable();
        for pair in borders.windows(2) {
            if pair[0].0 == pair[1].0 {
                join(pair[0].1, pair[1].1);
            }
        }
        // Elements with so many nodes in one body that they cannot turn against it.
        let body_of = structure.body_of_nodes();
        for (index, element) in structure.elements.iter().enumerate() {
            let bodies: Vec<(usize, usize)> =
                element.nodes.iter().filter_map(|&node| Some((body_of[node]?, node))).collect();
            for (at, &(body, _)) in bodies.iter().enumerate() {
                let own = bodies[..=at].iter().filter(|(other, _)| *other == body).map(|(_, node)| *node);
                let own: Vec<usize> = own.collect();
                if own.len() > 1 && (!element.shape().is_solid() || axis(structure, &own).is_none()) {
                    join(index as u32, (elements + body) as u32);
                }
            }
        }
        // Frame bars rigidly attached to one node, or to a body.
        let mut turning: Vec<Option<u32>> =
            body_of.iter().map(|body| body.map(|body| (elements + body) as u32)).collect();
        for (index, element) in structure.elements.iter().enumerate() {
            for (end, &node) in element.nodes.iter().enumerate() {
                if element.turns_with(end) {
                    match turning[node] {
                        Some(other) => join(index as u32, other),
                        None => turning[node] = Some(index as u32),
                    }
                }
            }
        }
        if let Some(element) = &structure.superelement {
            let mut part_of = vec![None; structure.nodes.len()];
            for (index, part) in given.iter().enumerate() {
                part.nodes.iter().for_each(|&node| part_of[node] = Some((beyond + index) as u32));
            }
            for &(node, _) in element.dofs.iter().filter(|(_, component)| component.is_rotation()) {
                match (turning[node], part_of[node]) {
                    (Some(body), Some(part)) => join(part, body),
                    (_, part) => turning[node] = part,
                }
            }
        }
        // Number the parts; lone nodes come last.
        let mut number = vec![u32::MAX; beyond + given.len()];
        let mut turns = Vec::new();
        let mut part_of = |element: usize| {
            let element = groups.of(element);
            if number[element] == u32::MAX {
                number[element] = turns.len() as u32;
                turns.push(true);
            }
            number[element]
        };
        let mut at_node: Vec<Vec<u32>> = vec![Vec::new(); structure.nodes.len()];
        let elements = structure.elements.iter().map(|element| &element.nodes);
        let bodies = structure.rigid.iter().map(|body| &body.nodes);
        let parts = given.iter().map(|part| &part.nodes);
        for (index, nodes) in elements.chain(bodies).chain(parts).enumerate() {
            let part = part_of(index);
            for &node in nodes {
                if !at_node[node].contains(&part) {
                    at_node[node].push(part);
                }
            }
        }
        for turning in turning.iter_mut().flatten() {
            *turning = part_of(*turning as usize);
        }
        let of_element = (0..structure.elements.len()).map(&mut part_of).collect();
        let of_superelement = (0..given.len()).map(|part| part_of(beyond + part)).collect();
        for parts in at_node.iter_mut().filter(|parts| parts.is_empty()) {
            parts.push(turns.len() as u32);
            turns.push(false);
        }
        for node in turning_alone(structure, &turning) {
            at_node[node].push(turns.len() as u32);
            turning[node] = Some(turns.len() as u32);
            turns.push(true);
        }
        Parts { at_node, turning, turns, of_element, of_superelement }
    }

    /// The line on which all nodes of each part lie, as a unit vector along it; `None` where they do not.
    pub fn lines(&self, structure: &Structure) -> Vec<Option<[f64; 3]>> {
        let mut nodes = vec![Vec::new(); self.turns.len()];
        for (node, parts) in self.at_node.iter().enumerate() {
            parts.iter().for_each(|&part| nodes[part as usize].push(node));
        }
        nodes.iter().map(|nodes| axis(structure, nodes)).collect()
    }
}
