//! What names of a mesh mean: nodes `ID/TAG`, elements `ID#TAG`, groups `ID.NAME` as edges, nodes and elements.

use std::collections::HashSet;
use std::sync::Arc;

use super::reader::Cursor;
use super::spot::Spot;
use super::words::{did_you_mean, listed, quoted};
use crate::model::edge::Edge;
use crate::model::face::Face;
use crate::model::mesh::boundary::Boundary;
use crate::model::mesh::facing::Facing;
use crate::model::mesh::surface::Surface;
use crate::model::mesh::{Group, Members, Mesh};

/// A mesh in the structure.
pub struct MeshPart {
    id: String,
    mesh: Arc<Mesh>,
    /// Index into the structure of each node of the file that is used.
    pub node_of: Vec<Option<usize>>,
    /// Index into the structure of each element of the file that is used.
    pub element_of: Vec<Option<usize>>,
    boundary: Boundary<Arc<Mesh>>,
    surface: Surface<Arc<Mesh>>,
}

impl MeshPart {
    /// A mesh whose elements are still to come.
    pub fn new(id: &str, mesh: Arc<Mesh>, node_of: Vec<Option<usize>>) -> MeshPart {
        let (boundary, surface) = (Boundary::of(Arc::clone(&mesh)), Surface::of(Arc::clone(&mesh)));
        MeshPart { id: id.to_owned(), node_of, element_of: vec![None; mesh.elements.len()], boundary, surface, mesh }
    }

    /// The name of the mesh.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Sides belong to areas and solids, all of which are used with all their nodes.
    fn node_in_structure(&self, node: usize) -> usize {
        self.node_of[node].unwrap_or_default()
    }

    fn edge_in_structure(&self, mut edge: Edge) -> Edge {
        let node = |node: usize| self.node_in_structure(node);
        edge.nodes.iter_mut().for_each(|at| *at = node(*at));
        for side in &mut edge.sides {
            side.element = self.element_of[side.element].unwrap_or_default();
            side.ends = side.ends.map(node);
            side.middle = side.middle.map(node);
        }
        edge
    }

    fn face_in_structure(&self, mut face: Face) -> Face {
        let node = |node: &mut usize| *node = self.node_in_structure(*node);
        face.nodes.iter_mut().for_each(node);
        for side in &mut face.sides {
            side.element = self.element_of[side.element].unwrap_or_default();
            side.nodes.iter_mut().for_each(node);
        }
        face
    }

    /// The node or edge that `name` (the whole of what stands there) means; `rest` follows the id.
    pub fn spot(&self, cursor: Cursor<'_>, rest: &str) -> Option<Spot> {
        if let Some(tag) = rest.strip_prefix('/') {
            return self.node(cursor, tag).map(Spot::Node);
        }
        let Some(name) = rest.strip_prefix('.') else {
            cursor.problem(
                format!("{} is an element, expected a node or {}", cursor.quoted(), self.a_border()),
                format!("nodes of the mesh are \"{0}/17\", {1}s \"{0}.GROUP\"", self.id, self.border()),
            );
            return None;
        };
        let Some(group) = self.border_group(name) else { return self.by_direction(cursor, name) };
        if let Members::NodeSet(nodes) | Members::Points(nodes) = &group.members
            && let [node] = nodes[..]
        {
            return self.used(cursor, node).map(Spot::Node);
        }
        self.border_of(group).map_err(|(message, help)| cursor.problem(message, help)).ok()
    }

    /// What its groups bound: `edge` or `face`.
    fn border(&self) -> &'static str {
        if self.mesh.is_solid() { "face" } else { "edge" }
    }

    fn a_border(&self) -> &'static str {
        if self.mesh.is_solid() { "a face" } else { "an edge" }
    }

    /// The group that a name of an edge or a face means: what bounds a body before sets of nodes.
    fn border_group<'m>(&'m self, name: &'m str) -> Option<&'m Group> {
        let groups: Vec<&Group> = self.mesh.groups_named(name).collect();
        let bounds = |group: &&&Group| match group.members {
            Members::Lines(_) => !self.mesh.is_solid(),
            Members::Areas(_) => self.mesh.is_solid(),
            Members::Sides(_) => true,
            _ => false,
        };
        let nodes = |group: &&&Group| matches!(group.members, Members::NodeSet(_) | Members::Points(_));
        groups.iter().find(bounds).or_else(|| groups.iter().find(nodes)).or(groups.first()).copied()
    }

    /// The edge or face that a group is, or why it is neither and what to do.
    fn border_of(&self, group: &Group) -> Result<Spot, (String, String)> {
        if self.mesh.is_solid() {
            let face = self.surface.face(group).map_err(|fault| self.surface.words(group, &fault))?;
            return Ok(Spot::Face(self.face_in_structure(face)));
        }
        let edge = self.boundary.edge(group).map_err(|fault| self.boundary.words(group, &fault))?;
        Ok(Spot::Edge(self.edge_in_structure(edge)))
    }

    /// The part of the outer boundary, or of the surface, that looks one way.
    fn by_direction(&self, cursor: Cursor<'_>, name: &str) -> Option<Spot> {
        if self.mesh.is_solid() {
            let face = self.piece(cursor, name, "surface", self.surface.facing())?;
            return Some(Spot::Face(self.face_in_structure(face.clone())));
        }
        let edge = self.piece(cursor, name, "boundary", self.boundary.facing())?;
        Some(Spot::Edge(self.edge_in_structure(edge.clone())))
    }

    /// The one piece that a name means.
    fn piece<'p, P>(&self, cursor: Cursor<'_>, name: &str, outside: &str, facing: &'p [Facing<P>]) -> Option<&'p P> {
        if self.is_nearly_a_group(name) {
            self.unknown_group(cursor, name);
            return None;
        }
        if let Some(found) = facing.iter().find(|facing| facing.name == name) {
            return Some(&found.piece);
        }
        let pieces: Vec<&str> =
            facing.iter().filter(|facing| facing.direction == name).map(|facing| facing.name.as_str()).collect();
        if pieces.is_empty() {
            self.unknown_group(cursor, name);
        } else {
            cursor.problem(
                format!("the {outside} of \"{}\" that looks to the {name} is in {} pieces", self.id, pieces.len()),
                format!("expected {}", self.names(&pieces)),
            );
        }
        None
    }

    /// Whether a group has this name up to case, or an empty group has it: then the direction is hardly meant.
    fn is_nearly_a_group(&self, name: &str) -> bool {
        self.mesh.groups.iter().any(|group| group.name.eq_ignore_ascii_case(name))
            || self.mesh.empty_group(name).is_some()
    }

    fn names(&self, names: &[&str]) -> String {
        let names: Vec<String> = names.iter().map(|name| format!("\"{}.{name}\"", self.id)).collect();
        listed(&names.iter().map(String::as_str).collect::<Vec<_>>())
    }

    fn unknown_group(&self, cursor: Cursor<'_>, name: &str) {
        if let Some(place) = self.mesh.empty_group(name) {
            cursor.problem(
                format!("the group {} ({}) is empty: nothing of the mesh is in it", quoted(name), self.mesh.at(place)),
                match self.mesh.is_solid() {
                    true => "put areas of the surface into it, or name another group",
                    false => "put lines of the boundary into it, or name another group",
                },
            );
            return;
        }
        let mut known: Vec<&str> = self
            .mesh
            .groups
            .iter()
            .filter(|group| match group.members {
                Members::Areas(_) => self.mesh.is_solid(),
                Members::Solids(_) => false,
                _ => true,
            })
            .map(|group| group.name.as_str())
            .collect();
        if known.is_empty() {
            // One of the two is always empty.
            known.extend(self.surface.facing().iter().map(|facing| facing.name.as_str()));
            known.extend(self.boundary.facing().iter().map(|facing| facing.name.as_str()));
        }
        let file = &self.mesh.files[0];
        cursor.problem(
            format!(
                "the mesh \"{}\" ({file}) has no group {}{}",
                self.id,
                quoted(name),
                did_you_mean(name, known.iter().copied())
            ),
            format!("expected {}", self.names(&known)),
        );
    }

    fn node(&self, cursor: Cursor<'_>, tag: &str) -> Option<usize> {
        let found = tag.parse().ok().filter(|_| tag.bytes().all(|byte| byte.is_ascii_digit()));
        match found.and_then(|tag| self.mesh.node(tag)) {
            Some(node) => self.used(cursor, node),
            None => {
                cursor.problem(
                    format!("the mesh \"{}\" ({}) has no node {}", self.id, self.mesh.files[0], quoted(tag)),
                    format!("its nodes are \"{}/TAG\" with the numbers of the file", self.id),
                );
                None
            }
        }
    }

    fn used(&self, cursor: Cursor<'_>, node: u32) -> Option<usize> {
        let found = self.node_of[node as usize];
        if found.is_none() {
            let node = &self.mesh.nodes[node as usize];
            cursor.problem(
                format!("the node \"{}/{}\" ({}) belongs to no element", self.id, node.tag, self.mesh.at(node.place)),
                "name a node of an element",
            );
        }
        found
    }

    /// All nodes of what is named, where their order does not matter and no edge need be in one piece. `None` if
    /// nothing is named so, or none of its nodes is used.
    pub fn node_set(&self, rest: &str) -> Option<Vec<usize>> {
        let name = rest.strip_prefix('.')?;
        let mut nodes = match self.border_group(name) {
            Some(group) => self.nodes_of(group),
            None if self.is_nearly_a_group(name) => return None,
            None => {
                let edges = self.boundary.facing().iter().filter(|facing| facing.is_named(name));
                let faces = self.surface.facing().iter().filter(|facing| facing.is_named(name));
                let nodes = edges.flat_map(|edge| &edge.piece.nodes).chain(faces.flat_map(|face| &face.piece.nodes));
                nodes.map(|node| self.node_in_structure(*node)).collect()
            }
        };
        let mut seen = HashSet::new();
        nodes.retain(|node| seen.insert(*node));
        (!nodes.is_empty()).then_some(nodes)
    }

    /// The nodes of a group of nodes, of an edge or a face, or of a boundary that makes neither; none of bodies.
    fn nodes_of(&self, group: &Group) -> Vec<usize> {
        if let Members::NodeSet(nodes) | Members::Points(nodes) = &group.members {
            return self.used_of(nodes);
        }
        match (self.border_of(group), &group.members) {
            (Ok(Spot::Edge(edge)), _) => edge.nodes,
            (Ok(Spot::Face(face)), _) => face.nodes,
            (_, Members::Lines(elements) | Members::Areas(elements)) if !self.mesh.is_body(group) => {
                let nodes = elements.iter().flat_map(|index| &self.mesh.elements[*index as usize].nodes);
                self.used_of(&nodes.copied().collect::<Vec<u32>>())
            }
            (_, Members::Sides(_)) if !self.mesh.is_solid() => self.used_of(&self.boundary.nodes_of_sides(group)),
            _ => Vec::new(),
        }
    }

    fn used_of(&self, nodes: &[u32]) -> Vec<usize> {
        nodes.iter().filter_map(|node| self.node_of[*node as usize]).collect()
    }

    /// The elements of the mesh, of one of its groups, or the one that is named; something else is reported.
    pub fn elements(&self, cursor: Cursor<'_>, rest: &str) -> Option<Vec<usize>> {
        if rest.is_empty() {
            return Some(self.element_of.iter().flatten().copied().collect());
        }
        if let Some(tag) = rest.strip_prefix('#') {
            let index = tag.parse().ok().and_then(|tag| self.mesh.element(tag));
            let found = index.and_then(|index| self.element_of[index as usize]);
            if found.is_none() {
                cursor.problem(
                    format!("the mesh \"{}\" ({}) has no element {}", self.id, self.mesh.files[0], quoted(tag)),
                    format!("its elements are \"{}#TAG\" with the numbers of the file", self.id),
                );
            }
            return found.map(|element| vec![element]);
        }
        let name = rest.strip_prefix('.').unwrap_or(rest);
        let of = |group: &Group| match &group.members {
            Members::Areas(indices) | Members::Lines(indices) | Members::Solids(indices) => {
                let used = indices.iter().filter_map(|index| self.element_of[*index as usize]);
                Some(used.collect::<Vec<usize>>()).filter(|used| !used.is_empty())
            }
            _ => None,
        };
        let found: Vec<usize> = self.mesh.groups_named(name).filter_map(of).flatten().collect();
        if found.is_empty() {
            let known: Vec<&str> =
                self.mesh.groups.iter().filter(|group| of(group).is_some()).map(|group| group.name.as_str()).collect();
            cursor.problem(
                format!(
                    "the mesh \"{}\" ({}) has no group of elements {}{}",
                    self.id,
                    self.mesh.files[0],
                    quoted(name),
                    did_you_mean(name, known.iter().copied())
                ),
                match known[..] {
                    [] => format!("name the whole mesh, \"{}\"", self.id),
                    _ => format!("expected {}, or \"{}\" for all of them", self.names(&known), self.id),
                },
            );
            return None;
        }
        Some(found)
    }

    /// The group of areas or solids that consists of just these elements of the structure.
    pub fn group_of_elements(&self, elements: &[usize]) -> Option<&str> {
        let wanted: HashSet<&usize> = elements.iter().collect();
        let fits = |group: &&Group| match &group.members {
            Members::Areas(indices) | Members::Solids(indices) if indices.len() == elements.len() => {
                indices.iter().all(|index| self.element_of[*index as usize].is_some_and(|e| wanted.contains(&e)))
            }
            _ => false,
        };
        self.mesh.groups.iter().find(fits).map(|group| group.name.as_str())
    }

    /// `ID#TAG` of an element of the structure.
    pub fn element_name(&self, element: usize) -> String {
        let index = self.element_of.iter().position(|of| *of == Some(element));
        index.map_or(self.id.clone(), |index| format!("{}#{}", self.id, self.mesh.elements[index].tag))
    }
}
