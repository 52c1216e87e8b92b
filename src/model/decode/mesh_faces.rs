//! What names of a mesh of solids mean: groups `ID.NAME` as faces, its surface by direction.

use super::mesh_names::MeshPart;
use super::reader::Cursor;
use super::spot::Spot;
use crate::model::face::Face;
use crate::model::mesh::surface::DIRECTIONS;
use crate::model::mesh::{Group, Members};

impl MeshPart {
    fn face_in_structure(&self, face: &Face) -> Face {
        // Sides belong to solids, all of which are used with all their nodes.
        let node = |node: &mut usize| *node = self.node_of[*node].unwrap_or_default();
        let mut face = face.clone();
        face.nodes.iter_mut().for_each(node);
        for side in &mut face.sides {
            side.element = self.element_of[side.element].unwrap_or_default();
            side.nodes.iter_mut().for_each(node);
        }
        face
    }

    /// The group that a name of a face means: areas and surfaces before sets of nodes.
    fn face_group<'m>(&'m self, name: &'m str) -> Option<&'m Group> {
        let groups: Vec<&Group> = self.mesh.groups_named(name).collect();
        let faces = |group: &&&Group| matches!(group.members, Members::Areas(_) | Members::Sides(_));
        let nodes = |group: &&&Group| matches!(group.members, Members::NodeSet(_) | Members::Points(_));
        groups.iter().find(faces).or_else(|| groups.iter().find(nodes)).or(groups.first()).copied()
    }

    /// The node or face that the group `name`, or the part of the surface that looks there, is.
    pub(super) fn face_spot(&self, cursor: Cursor<'_>, name: &str) -> Option<Spot> {
        match self.face_group(name) {
            Some(group) => {
                if let Members::NodeSet(nodes) | Members::Points(nodes) = &group.members
                    && let [node] = nodes[..]
                {
                    return self.used(cursor, node).map(Spot::Node);
                }
                match self.surface.face(group) {
                    Ok(face) => Some(Spot::Face(self.face_in_structure(&face))),
                    Err(fault) => {
                        let (message, help) = self.surface.words(group, &fault);
                        cursor.problem(message, help);
                        None
                    }
                }
            }
            None => self.face_by_direction(cursor, name).map(Spot::Face),
        }
    }

    /// The part of the surface that looks one way.
    fn face_by_direction(&self, cursor: Cursor<'_>, name: &str) -> Option<Face> {
        if self.is_nearly_a_group(name) {
            self.unknown_group(cursor, name);
            return None;
        }
        let facing = self.surface.facing();
        if let Some(found) = facing.iter().find(|facing| facing.name == name) {
            return Some(self.face_in_structure(&found.face));
        }
        let pieces: Vec<&str> =
            facing.iter().filter(|facing| DIRECTIONS[facing.direction] == name).map(|f| f.name.as_str()).collect();
        if pieces.is_empty() {
            self.unknown_group(cursor, name);
        } else {
            cursor.problem(
                format!("the surface of \"{}\" that looks to the {name} is in {} pieces", self.id(), pieces.len()),
                format!("expected {}", self.names(&pieces)),
            );
        }
        None
    }

    /// Names of its faces by direction.
    pub(super) fn facing_names(&self) -> Vec<&str> {
        self.surface.facing().iter().map(|facing| facing.name.as_str()).collect()
    }

    /// All nodes of what is named, see [`MeshPart::node_set`].
    pub(super) fn face_nodes(&self, name: &str) -> Vec<usize> {
        match self.face_group(name) {
            Some(group) => match (&group.members, self.surface.face(group)) {
                (Members::NodeSet(nodes) | Members::Points(nodes), _) => self.used_of(nodes),
                (_, Ok(face)) => self.face_in_structure(&face).nodes,
                (Members::Lines(elements) | Members::Areas(elements), Err(_)) => {
                    let nodes = elements.iter().flat_map(|index| &self.mesh.elements[*index as usize].nodes);
                    self.used_of(&nodes.copied().collect::<Vec<u32>>())
                }
                (_, Err(_)) => Vec::new(),
            },
            None if self.is_nearly_a_group(name) => Vec::new(),
            None => {
                let pieces = self
                    .surface
                    .facing()
                    .iter()
                    .filter(|facing| DIRECTIONS[facing.direction] == name || facing.name == name);
                pieces.flat_map(|facing| self.face_in_structure(&facing.face).nodes).collect()
            }
        }
    }
}
