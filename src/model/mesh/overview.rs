//! What a mesh holds, in numbers.

use std::collections::HashSet;

use super::boundary::{Boundary, EdgeFault};
use super::surface::{FaceFault, Surface};
use super::{Group, Members, Mesh, MeshElement, MeshNode, Shape};
use crate::model::edge::{Edge, EdgeSide};
use crate::model::structure::Node;

/// What a mesh holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Overview {
    /// Number of elements of each shape that there is.
    pub shapes: Vec<(Shape, usize)>,
    /// Nodes that no area and no line has.
    pub unused_nodes: usize,
    /// Least and largest x, y and z of the used nodes.
    pub extent: [[f64; 3]; 2],
    /// Area of all elements; of solids that of their surface.
    pub area: f64,
    /// Volume of solids.
    pub volume: Option<f64>,
    /// The groups in the order of the file.
    pub groups: Vec<GroupView>,
    /// The boundary by direction.
    pub boundary: Vec<PieceView>,
    /// The worst area or solid.
    pub worst: Option<Worst>,
}

/// What a group holds.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupView {
    /// Name or number.
    pub name: String,
    /// 0 nodes, 1 lines and sides, 2 areas and faces, 3 solids.
    pub dimension: u8,
    /// What its members are.
    pub what: &'static str,
    /// How many.
    pub count: usize,
    /// Length of lines and edges, area of areas and faces, volume of solids.
    pub measure: Option<f64>,
    /// Why it is not one edge, or no face of solids.
    pub fault: Option<String>,
    /// Where it stands: `dam.msh:7`.
    pub place: String,
}

/// A piece of the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceView {
    /// `top`.
    pub name: String,
    /// Number of its nodes.
    pub nodes: usize,
    /// Its length; of solids its area.
    pub measure: f64,
}

/// The element of least quality.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Its number.
    pub tag: u64,
    /// See [`Shape::quality`] and [`Shape::quality_of_solid`].
    pub quality: f64,
    /// Where it stands: `dam.msh:17`.
    pub place: String,
}

impl Overview {
    /// The overview of a mesh.
    pub fn of(mesh: &Mesh) -> Overview {
        let place = |node: &MeshNode| Node { id: String::new(), position: node.position };
        let nodes: Vec<Node> = mesh.nodes.iter().map(place).collect();
        let used: HashSet<u32> = mesh.elements.iter().flat_map(|element| element.nodes.iter().copied()).collect();
        let mut extent = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for node in &used {
            for (axis, x) in nodes[*node as usize].position.into_iter().enumerate() {
                extent[0][axis] = extent[0][axis].min(x);
                extent[1][axis] = extent[1][axis].max(x);
            }
        }
        const SHAPES: [Shape; 10] = [
            Shape::Line2,
            Shape::Line3,
            Shape::Triangle3,
            Shape::Triangle6,
            Shape::Quad4,
            Shape::Quad8,
            Shape::Tetrahedron4,
            Shape::Tetrahedron10,
            Shape::Hexahedron8,
            Shape::Hexahedron20,
        ];
        let number = |shape: Shape| mesh.elements.iter().filter(|element| element.shape == shape).count();
        let worst = mesh.of_bodies().map(|index| (quality(mesh, index), index)).min_by(|a, b| a.0.total_cmp(&b.0)).map(
            |(quality, index)| {
                let element = &mesh.elements[index as usize];
                Worst { tag: element.tag, quality, place: mesh.at(element.place) }
            },
        );
        let size = mesh.of_bodies().map(|index| size(mesh, index)).sum();
        let (groups, boundary, area, volume) = if mesh.is_solid() {
            let surface = Surface::of(mesh);
            let groups = mesh.groups.iter().map(|group| group_of_solids(group, mesh, &surface, &nodes)).collect();
            let pieces = surface.facing().iter().map(|facing| {
                let face = &facing.piece;
                PieceView { name: facing.name.clone(), nodes: face.nodes.len(), measure: face.area(&nodes) }
            });
            let pieces: Vec<PieceView> = pieces.collect();
            let area = pieces.iter().map(|piece| piece.measure).sum();
            (groups, pieces, area, Some(size))
        } else {
            let boundary = Boundary::of(mesh);
            let groups = mesh.groups.iter().map(|group| group_of_areas(group, mesh, &boundary, &nodes)).collect();
            let pieces = boundary.facing().iter().map(|facing| {
                let edge = &facing.piece;
                PieceView { name: facing.name.clone(), nodes: edge.nodes.len(), measure: edge.length(&nodes) }
            });
            (groups, pieces.collect(), size, None)
        };
        Overview {
            shapes: SHAPES.into_iter().map(|shape| (shape, number(shape))).filter(|(_, count)| *count > 0).collect(),
            unused_nodes: mesh.nodes.len() - used.len(),
            extent,
            area,
            volume,
            groups,
            boundary,
            worst,
        }
    }
}

fn quality(mesh: &Mesh, index: u32) -> f64 {
    let element = &mesh.elements[index as usize];
    match element.shape.is_solid() {
        true => element.shape.quality_of_solid(&places(mesh, element)),
        false => element.shape.quality(&places_in_plane(mesh, element)),
    }
}

/// Area or volume of an element.
fn size(mesh: &Mesh, index: u32) -> f64 {
    let element = &mesh.elements[index as usize];
    match element.shape.is_solid() {
        true => element.shape.volume(&places(mesh, element)),
        false => element.shape.area(&places_in_plane(mesh, element)),
    }
}

fn places(mesh: &Mesh, element: &MeshElement) -> Vec<[f64; 3]> {
    element.nodes.iter().map(|node| mesh.nodes[*node as usize].position).collect()
}

fn places_in_plane(mesh: &Mesh, element: &MeshElement) -> Vec<[f64; 2]> {
    element.nodes.iter().map(|node| mesh.position(*node)).collect()
}

fn group_of_areas(group: &Group, mesh: &Mesh, boundary: &Boundary<&Mesh>, nodes: &[Node]) -> GroupView {
    let edge = boundary.edge(group);
    let of_edge = || edge.as_ref().ok().map(|edge| edge.length(nodes));
    let (dimension, measure) = match &group.members {
        Members::Points(_) => (0, None),
        Members::NodeSet(_) => (0, of_edge()),
        Members::Lines(lines) => (1, Some(lines.iter().map(|line| length(mesh, *line, nodes)).sum())),
        Members::Sides(_) => (1, of_edge()),
        Members::Areas(all) | Members::Solids(all) => (2, Some(all.iter().map(|index| size(mesh, *index)).sum())),
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
    group_view(group, mesh, dimension, measure, fault)
}

fn group_of_solids(group: &Group, mesh: &Mesh, surface: &Surface<&Mesh>, nodes: &[Node]) -> GroupView {
    let face = surface.face(group);
    let of_face = face.as_ref().ok().map(|face| face.area(nodes));
    let (dimension, measure) = match &group.members {
        Members::Points(_) => (0, None),
        Members::NodeSet(_) => (0, of_face),
        Members::Lines(_) => (1, None),
        Members::Areas(_) | Members::Sides(_) => (2, of_face),
        Members::Solids(all) => (3, Some(all.iter().map(|index| size(mesh, *index)).sum())),
    };
    let fault = match (&face, &group.members) {
        // Sets of nodes need not be faces.
        (Err(fault), Members::Areas(_) | Members::Sides(_)) => Some(match fault {
            FaceFault::NoSide(_) | FaceFault::Empty => "no sides of solids".into(),
            FaceFault::Inside(_) => "inside a body".into(),
            FaceFault::NoFace => "no face".into(),
        }),
        _ => None,
    };
    group_view(group, mesh, dimension, measure, fault)
}

fn group_view(group: &Group, mesh: &Mesh, dimension: u8, measure: Option<f64>, fault: Option<String>) -> GroupView {
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
    let side = EdgeSide { element: 0, ends, middle, reversed: false };
    Edge { nodes: Vec::new(), sides: vec![side] }.length(nodes)
}
