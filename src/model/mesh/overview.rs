//! What a mesh holds, in numbers.

use std::collections::HashSet;

use super::boundary::{Boundary, EdgeFault};
use super::{Group, Members, Mesh, Shape};
use crate::model::edge::Edge;
use crate::model::structure::Node;
use crate::model::vector::flat;

/// What a mesh holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Overview {
    /// Number of elements of each shape that there is.
    pub shapes: Vec<(Shape, usize)>,
    /// Nodes that no area and no line has.
    pub unused_nodes: usize,
    /// Least and largest x and y of the used nodes.
    pub extent: [[f64; 2]; 2],
    /// Area of all elements.
    pub area: f64,
    /// The groups in the order of the file.
    pub groups: Vec<GroupView>,
    /// The boundary by direction.
    pub boundary: Vec<EdgeView>,
    /// The worst area.
    pub worst: Option<Worst>,
}

/// What a group holds.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupView {
    /// Name or number.
    pub name: String,
    /// 0 nodes, 1 lines and sides, 2 areas.
    pub dimension: u8,
    /// What its members are.
    pub what: &'static str,
    /// How many.
    pub count: usize,
    /// Length of lines and edges, area of areas.
    pub measure: Option<f64>,
    /// Why it is not one edge.
    pub fault: Option<String>,
    /// Where it stands: `dam.msh:7`.
    pub place: String,
}

/// A piece of the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeView {
    /// `top`.
    pub name: String,
    /// Number of its nodes.
    pub nodes: usize,
    /// Its length.
    pub length: f64,
}

/// The element of least quality.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Its number.
    pub tag: u64,
    /// See [`Shape::quality`].
    pub quality: f64,
    /// Where it stands: `dam.msh:17`.
    pub place: String,
}

impl Overview {
    /// Of a mesh.
    pub fn of(mesh: &Mesh) -> Overview {
        let boundary = Boundary::of(mesh);
        let nodes: Vec<Node> = (0..mesh.nodes.len())
            .map(|k| Node { id: String::new(), position: flat(mesh.position(k as u32)) })
            .collect();
        let positions = |index: u32| -> Vec<[f64; 2]> {
            mesh.elements[index as usize].nodes.iter().map(|node| mesh.position(*node)).collect()
        };
        let area = |index: u32| mesh.elements[index as usize].shape.area(&positions(index));
        let used: HashSet<u32> = mesh.elements.iter().flat_map(|element| element.nodes.iter().copied()).collect();
        let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for node in &used {
            for (axis, x) in mesh.position(*node).into_iter().enumerate() {
                extent[0][axis] = extent[0][axis].min(x);
                extent[1][axis] = extent[1][axis].max(x);
            }
        }
        let all = [Shape::Line2, Shape::Line3, Shape::Triangle3, Shape::Triangle6, Shape::Quad4, Shape::Quad8];
        let number = |shape: Shape| mesh.elements.iter().filter(|element| element.shape == shape).count();
        let worst = mesh
            .areas()
            .map(|index| (mesh.elements[index as usize].shape.quality(&positions(index)), index))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(quality, index)| {
                let element = &mesh.elements[index as usize];
                Worst { tag: element.tag, quality, place: mesh.at(element.place) }
            });
        let groups = mesh.groups.iter().map(|group| view(group, mesh, &boundary, &nodes, &area)).collect();
        let edges = boundary.facing().iter().map(|facing| EdgeView {
            name: facing.name.clone(),
            nodes: facing.edge.nodes.len(),
            length: facing.edge.length(&nodes),
        });
        Overview {
            shapes: all.into_iter().map(|shape| (shape, number(shape))).filter(|(_, count)| *count > 0).collect(),
            unused_nodes: mesh.nodes.len() - used.len(),
            extent,
            area: mesh.areas().map(area).sum(),
            groups,
            boundary: edges.collect(),
            worst,
        }
    }
}

fn view(
    group: &Group,
    mesh: &Mesh,
    boundary: &Boundary<&Mesh>,
    nodes: &[Node],
    area: &dyn Fn(u32) -> f64,
) -> GroupView {
    let edge = boundary.edge(group);
    let (dimension, measure) = match &group.members {
        Members::Points(_) => (0, None),
        Members::NodeSet(_) => (0, edge.as_ref().ok().map(|edge| edge.length(nodes))),
        Members::Lines(lines) => (1, Some(lines.iter().map(|line| length(mesh, *line, nodes)).sum())),
        Members::Sides(_) => (1, edge.as_ref().ok().map(|edge| edge.length(nodes))),
        Members::Areas(areas) => (2, Some(areas.iter().map(|index| area(*index)).sum())),
    };
    let fault = match (&edge, &group.members) {
        // Sets of nodes need not be edges, nor lines of bars.
        (Err(fault), Members::Lines(_) | Members::Sides(_)) => Some(match fault {
            EdgeFault::Pieces(count, _) => format!("{count} pieces"),
            EdgeFault::NoSide(..) | EdgeFault::Empty => "no sides of elements".into(),
            EdgeFault::Inside(..) => "inside a body".into(),
            EdgeFault::HalfSide(_) | EdgeFault::WithoutMiddle(_) => "half a quadratic side".into(),
            EdgeFault::Branch(_) => "branches".into(),
            EdgeFault::Turns(_) => "on both sides of a body".into(),
            EdgeFault::NoEdge => "no edge".into(),
        }),
        _ => None,
    };
    GroupView {
        name: group.name.clone(),
        dimension,
        what: group.members.what(),
        count: group.members.count(),
        measure,
        fault,
        place: mesh.at(group.place),
    }
}

/// Length of a line.
fn length(mesh: &Mesh, line: u32, nodes: &[Node]) -> f64 {
    let line = &mesh.elements[line as usize].nodes;
    let ends = [line[0] as usize, line[1] as usize];
    let middle = line.get(2).map(|node| *node as usize);
    let side = crate::model::edge::EdgeSide { element: 0, ends, middle, reversed: false };
    Edge { nodes: Vec::new(), sides: vec![side] }.length(nodes)
}
