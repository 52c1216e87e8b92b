//! Spins that move nothing and that nothing resists: of a part whose nodes all lie on one line, about that line. They are
//! held (`body_rows`), and loads that would drive them are refused (`outline`).
//!
//! Such are bars between ball joints, divided or not, and rigid bodies of which only displacements are held.

use super::dof::Dofs;
use super::parts::{Parts, STRAIGHT};
use crate::model::structure::{Component, Dimension, Structure};
use crate::model::vector::{dot, unit, way};

/// The spin of a part about the line on which it lies.
#[derive(Clone, Debug, PartialEq)]
pub struct IdleSpin {
    /// The part.
    pub part: u32,
    /// Unit vector along the line.
    pub axis: [f64; 3],
    /// The nodes that turn with the part. Where there are none, there is no displacement to be held.
    pub nodes: Vec<usize>,
}

impl IdleSpin {
    /// The rotation of a node about its axis, as a sum over base dofs.
    pub fn turn(&self, dofs: &Dofs, node: usize) -> Vec<(usize, f64)> {
        let terms = Component::ROTATIONS.into_iter().map(|about| (dofs.of(node, about), self.axis[about.axis()]));
        terms.filter_map(|(dof, a)| Some((dof?, a))).filter(|(_, a)| *a != 0.0).collect()
    }
}

/// The idle spins in the order of the parts.
pub fn idle_spins(structure: &Structure, parts: &Parts) -> Vec<IdleSpin> {
    if structure.dimension == Dimension::Plane {
        return Vec::new();
    }
    let lines = parts.lines(structure);
    let mut nodes = vec![Vec::new(); lines.len()];
    for (node, part) in parts.turning.iter().enumerate() {
        if let Some(part) = part {
            nodes[*part as usize].push(node);
        }
    }
    let felt = felt(structure, parts, &lines);
    let spins = std::iter::zip(lines, nodes).enumerate().filter(|(part, _)| !felt[*part]);
    spins.filter_map(|(part, (axis, nodes))| Some(IdleSpin { part: part as u32, axis: axis?, nodes })).collect()
}

/// Of each part that lies on a line whether anything beside itself has to do with its spin.
fn felt(structure: &Structure, parts: &Parts, lines: &[Option<[f64; 3]>]) -> Vec<bool> {
    let mut felt = vec![false; lines.len()];
    let mut feel = |part: Option<u32>, axis: [f64; 3]| {
        if let Some(part) = part.map(|part| part as usize)
            && lines[part].is_some_and(|line| dot(line, axis).abs() > STRAIGHT)
        {
            felt[part] = true;
        }
    };
    let held = structure.supports.iter().map(|support| (support.node, support.component));
    let tied = structure.ties.iter().flat_map(|tie| {
        tie.nodes.iter().flat_map(|&node| tie.components.iter().map(move |&component| (node, component)))
    });
    let sprung = structure.springs.iter().flat_map(|spring| &spring.terms).map(|term| (term.node, term.component));
    let given = structure.superelement.iter().flat_map(|element| element.dofs.iter().copied());
    for (node, component) in held.chain(tied).chain(sprung).chain(given).filter(|(_, c)| c.is_rotation()) {
        let mut axis = [0.0; 3];
        axis[component.axis()] = 1.0;
        feel(parts.turning[node], axis);
    }
    let body_of = structure.body_of_nodes();
    // Ends of bars that turn with each node.
    let mut ends = vec![0_u32; structure.nodes.len()];
    for (element, &part) in std::iter::zip(&structure.elements, &parts.of_element).filter(|(e, _)| e.bends()) {
        let along =
            || unit(way(structure.nodes[element.nodes[0]].position, structure.nodes[element.nodes[1]].position));
        for (at, &node) in element.nodes.iter().enumerate() {
            let turning = parts.turning[node];
            if element.turns_with(at) {
                ends[node] += 1;
            } else if element.components(at).contains(&Component::Rx) && turning != Some(part) {
                // A hinge hands on the torque of its bar.
                let along = along().unwrap_or_default();
                feel(turning, along);
                feel(Some(part), along);
            }
        }
    }
    // The end of a bar that goes on to nothing is not a joint: whether it turns is for its supports to say.
    for (node, _) in ends.iter().enumerate().filter(|(node, ends)| **ends == 1 && body_of[*node].is_none()) {
        if let Some(part) = parts.turning[node] {
            feel(Some(part), lines[part as usize].unwrap_or_default());
        }
    }
    felt
}
