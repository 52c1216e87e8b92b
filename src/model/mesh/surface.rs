//! Faces of a mesh of solids: what its groups are as parts of its surface, and the surface by direction.
//!
//! Nodes and elements of these faces are indices into the mesh.

use std::cell::OnceCell;
use std::collections::HashSet;
use std::ops::Deref;

use super::facing::Facing;
use super::{Group, Members, Mesh, MeshNode};
use crate::model::face::{Face, FaceSide};
use crate::model::faces::Faces;
use crate::model::groups::Groups;
use crate::model::shape::side_corners;
use crate::model::vector::{cross, way};

/// Why a group is not a face. Nodes are indices into the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FaceFault {
    /// It has no side of an element.
    Empty,
    /// An area that is not a side of an element.
    NoSide(u32),
    /// A side that two elements share.
    Inside(Vec<usize>),
    /// Its members are not a surface: points, lines, or solids.
    NoFace,
}

/// The directions by which a surface without groups is named: by its outward normal.
const DIRECTIONS: [&str; 6] = ["bottom", "top", "left", "right", "front", "back"];

/// The sides of the solids of a mesh, and the faces found among them.
pub struct Surface<M> {
    mesh: M,
    faces: Faces,
    facing: OnceCell<Vec<Facing<Face>>>,
}

fn usizes(nodes: &[u32]) -> Vec<usize> {
    nodes.iter().map(|node| *node as usize).collect()
}

impl<M: Deref<Target = Mesh>> Surface<M> {
    /// The surface of a mesh; without solids it has no faces.
    pub fn of(mesh: M) -> Self {
        let mut faces = Faces::default();
        for (index, element) in mesh.elements.iter().enumerate() {
            faces.add(index, element.shape, &usizes(&element.nodes));
        }
        Surface { mesh, faces, facing: OnceCell::new() }
    }

    fn node(&self, node: usize) -> &MeshNode {
        &self.mesh.nodes[node]
    }

    /// The face that a group is.
    ///
    /// # Errors
    /// See [`FaceFault`].
    pub fn face(&self, group: &Group) -> Result<Face, FaceFault> {
        let sides = match &group.members {
            Members::Areas(areas) => self.of_areas(areas)?,
            Members::Sides(sides) => self.of_sides(sides)?,
            Members::NodeSet(nodes) => self.of_nodes(nodes),
            Members::Points(_) | Members::Lines(_) | Members::Solids(_) => return Err(FaceFault::NoFace),
        };
        if sides.is_empty() { Err(FaceFault::Empty) } else { Ok(self.in_order(sides)) }
    }

    /// A face with its nodes in the order of their numbers in the file.
    fn in_order(&self, sides: Vec<FaceSide>) -> Face {
        let mut face = Face::of(sides);
        face.nodes.sort_unstable_by_key(|node| self.node(*node).tag);
        face
    }

    /// The sides on the surface that areas lie on.
    fn of_areas(&self, areas: &[u32]) -> Result<Vec<FaceSide>, FaceFault> {
        let side = |area: &u32| {
            let nodes = usizes(&self.mesh.elements[*area as usize].nodes);
            match self.faces.at(&nodes) {
                [] => Err(FaceFault::NoSide(*area)),
                [side] if nodes.len() > side_corners(nodes.len()) && !same(&nodes, &side.nodes) => {
                    Err(FaceFault::NoSide(*area))
                }
                [side] => Ok(side.clone()),
                _ => Err(FaceFault::Inside(nodes)),
            }
        };
        areas.iter().map(side).collect()
    }

    fn of_sides(&self, sides: &[(u32, Option<u8>)]) -> Result<Vec<FaceSide>, FaceFault> {
        let mut found = Vec::with_capacity(sides.len());
        for &(index, face) in sides {
            let element = &self.mesh.elements[index as usize];
            let nodes = usizes(&element.nodes);
            for (number, places) in element.shape.faces().into_iter().enumerate() {
                let nodes: Vec<usize> = places.iter().map(|&place| nodes[place]).collect();
                let is_named = face == Some(number as u8);
                match self.faces.at(&nodes) {
                    [side] if is_named || face.is_none() => found.push(side.clone()),
                    [_, _, ..] if is_named => return Err(FaceFault::Inside(nodes)),
                    _ => {}
                }
            }
        }
        Ok(found)
    }

    /// The sides on the surface with all their nodes in a set.
    fn of_nodes(&self, nodes: &[u32]) -> Vec<FaceSide> {
        let set: HashSet<usize> = nodes.iter().map(|node| *node as usize).collect();
        let whole = self.faces.surface().into_iter().filter(|side| side.nodes.iter().all(|node| set.contains(node)));
        whole.cloned().collect()
    }

    /// The pieces of the surface by the direction of their outward normals, those of one direction by their first node
    /// from left to right, then from the front, then from below.
    pub fn facing(&self) -> &[Facing<Face>] {
        self.facing.get_or_init(|| self.find_facing())
    }

    fn find_facing(&self) -> Vec<Facing<Face>> {
        let surface = self.faces.surface();
        let mut found = Vec::new();
        for (direction, word) in DIRECTIONS.into_iter().enumerate() {
            let sides: Vec<&FaceSide> =
                surface.iter().copied().filter(|side| self.direction(side) == direction).collect();
            let mut groups = Groups::new(self.mesh.nodes.len());
            sides.iter().for_each(|side| groups.join_all(side.nodes.iter().copied()));
            let piece_of = groups.numbers(sides.iter().map(|side| side.nodes[0]));
            let count = piece_of.iter().max().map_or(0, |last| last + 1);
            let mut pieces: Vec<Vec<FaceSide>> = vec![Vec::new(); count];
            sides.iter().zip(piece_of).for_each(|(side, piece)| pieces[piece].push((*side).clone()));
            let mut pieces: Vec<Face> = pieces.into_iter().map(|sides| self.in_order(sides)).collect();
            let first = |face: &Face| {
                let places = face.nodes.iter().map(|node| self.node(*node).position);
                places.fold([f64::INFINITY; 3], |least, at| if at < least { at } else { least })
            };
            pieces.sort_by(|a, b| first(a).partial_cmp(&first(b)).unwrap_or(std::cmp::Ordering::Equal));
            found.extend(Facing::named(word, pieces));
        }
        found
    }

    /// Where a side looks by the largest component of its normal; at 45° up or down, then left or right.
    fn direction(&self, side: &FaceSide) -> usize {
        let at = |k: usize| self.node(side.nodes[k]).position;
        let last = side_corners(side.nodes.len()) - 1;
        // Of a quadrilateral: its diagonals; of a triangle two sides.
        let [x, y, z] = cross(way(at(0), at(last - 1)), way(at(last - 2), at(last)));
        let largest = x.abs().max(y.abs()).max(z.abs()) * (1.0 - 1e-9);
        if z.abs() >= largest {
            usize::from(z > 0.0)
        } else if x.abs() >= largest {
            2 + usize::from(x > 0.0)
        } else {
            4 + usize::from(y > 0.0)
        }
    }

    /// What is wrong with a group as a face, and what to do.
    pub fn words(&self, group: &Group, fault: &FaceFault) -> (String, String) {
        let mesh = &*self.mesh;
        let (why, help) = match fault {
            FaceFault::Empty => ("has no side of an element on the surface".into(), "name another group"),
            FaceFault::NoSide(area) => {
                let area = &mesh.elements[*area as usize];
                (
                    format!(
                        "is not a face: its element {} ({}) is not a side of a solid",
                        area.tag,
                        mesh.at(area.place)
                    ),
                    "areas of a face lie on the surface and have the nodes of its solids",
                )
            }
            FaceFault::Inside(nodes) => {
                let tags: Vec<String> = nodes.iter().map(|node| self.node(*node).tag.to_string()).collect();
                (
                    format!("lies inside a body: its side with the nodes {} has solids on both sides", tags.join(", ")),
                    "a face is on the outside; to cut a body give each part nodes of its own",
                )
            }
            FaceFault::NoFace => (
                format!("consists of {}, which is not a face", group.members.what()),
                "name a group of areas on the surface, a surface or a node set",
            ),
        };
        (format!("the group \"{}\" ({}) {why}", group.name, mesh.at(group.place)), help.into())
    }
}

fn same(a: &[usize], b: &[usize]) -> bool {
    let set = |nodes: &[usize]| nodes.iter().copied().collect::<HashSet<usize>>();
    set(a) == set(b)
}
