//! What names of a mesh mean: nodes `ID/TAG`, elements `ID#TAG`, groups `ID.NAME` as edges, nodes and elements.

use std::collections::HashSet;
use std::sync::Arc;

use super::reader::Cursor;
use super::spot::Spot;
use super::words::{did_you_mean, listed, quoted};
use crate::model::edge::Edge;
use crate::model::mesh::boundary::{Boundary, DIRECTIONS};
use crate::model::mesh::surface::Surface;
use crate::model::mesh::{Group, Members, Mesh};

/// A mesh in the structure.
pub struct MeshPart {
    id: String,
    pub(super) mesh: Arc<Mesh>,
    /// Index into the structure of each node of the file that is used.
    pub node_of: Vec<Option<usize>>,
    /// Index into the structure of each element of the file that is used.
    pub element_of: Vec<Option<usize>>,
    boundary: Boundary<Arc<Mesh>>,
    pub(super) surface: Surface<Arc<Mesh>>,
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

    fn in_structure(&self, edge: &Edge) -> Edge {
        // Sides belong to areas, all of which are used with all their nodes.
        let node = |node: usize| self.node_of[node].unwrap_or_default();
        let mut edge = edge.clone();
        edge.nodes.iter_mut().for_each(|at| *at = node(*at));
        for side in &mut edge.sides {
            side.element = self.element_of[side.element].unwrap_or_default();
            side.ends = side.ends.map(node);
            side.middle = side.middle.map(node);
        }
        edge
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
        if self.mesh.is_solid() {
            return self.face_spot(cursor, name);
        }
        let groups: Vec<&Group> = self.mesh.groups_named(name).collect();
        let edges = |group: &&&Group| matches!(group.members, Members::Lines(_) | Members::Sides(_));
        let nodes = |group: &&&Group| matches!(group.members, Members::NodeSet(_) | Members::Points(_));
        match groups.iter().find(edges).or_else(|| groups.iter().find(nodes)).or(groups.first()) {
            Some(group) => {
                if let Members::NodeSet(nodes) | Members::Points(nodes) = &group.members
                    && let [node] = nodes[..]
                {
                    return self.used(cursor, node).map(Spot::Node);
                }
                self.edge(cursor, group).map(Spot::Edge)
            }
            None => self.by_direction(cursor, name).map(Spot::Edge),
        }
    }

    /// What its groups bound: `edge` or `face`.
    pub(super) fn border(&self) -> &'static str {
        if self.mesh.is_solid() { "face" } else { "edge" }
    }

    fn a_border(&self) -> &'static str {
        if self.mesh.is_solid() { "a face" } else { "an edge" }
    }

    fn edge(&self, cursor: Cursor<'_>, group: &Group) -> Option<Edge> {
        match self.boundary.edge(group) {
            Ok(edge) => Some(self.in_structure(&edge)),
            Err(fault) => {
                let (message, help) = self.boundary.words(group, &fault);
                cursor.problem(message, help);
                None
            }
        }
    }

    /// The part of the outer boundary that looks one way.
    fn by_direction(&self, cursor: Cursor<'_>, name: &str) -> Option<Edge> {
        if self.is_nearly_a_group(name) {
            self.unknown_group(cursor, name);
            return None;
        }
        let facing = self.boundary.facing();
        if let Some(found) = facing.iter().find(|facing| facing.name == name) {
            return Some(self.in_structure(&found.edge));
        }
        let pieces: Vec<&str> =
            facing.iter().filter(|facing| DIRECTIONS[facing.direction] == name).map(|f| f.name.as_str()).collect();
        if pieces.is_empty() {
            self.unknown_group(cursor, name);
        } else {
            cursor.problem(
                format!("the boundary of \"{}\" that looks to the {name} is in {} pieces", self.id, pieces.len()),
                format!("expected {}", self.names(&pieces)),
            );
        }
        None
    }

    /// Whether a group has this name in other letters, or one without members: then the direction is hardly meant.
    pub(super) fn is_nearly_a_group(&self, name: &str) -> bool {
        self.mesh.groups.iter().any(|group| group.name.eq_ignore_ascii_case(name))
            || self.mesh.empty_group(name).is_some()
    }

    pub(super) fn names(&self, names: &[&str]) -> String {
        let names: Vec<String> = names.iter().map(|name| format!("\"{}.{name}\"", self.id)).collect();
        listed(&names.iter().map(String::as_str).collect::<Vec<_>>())
    }

    pub(super) fn unknown_group(&self, cursor: Cursor<'_>, name: &str) {
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
        if known.is_empty() && self.mesh.is_solid() {
            known = self.facing_names();
        } else if known.is_empty() {
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

    pub(super) fn used(&self, cursor: Cursor<'_>, node: u32) -> Option<usize> {
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
        if self.mesh.is_solid() {
            let mut seen = HashSet::new();
            let nodes: Vec<usize> = self.face_nodes(name).into_iter().filter(|node| seen.insert(*node)).collect();
            return (!nodes.is_empty()).then_some(nodes);
        }
        let groups: Vec<&Group> = self.mesh.groups_named(name).collect();
        let lines = groups.iter().find(|group| matches!(group.members, Members::Lines(_) | Members::Sides(_)));
        let set = groups.iter().find(|group| matches!(group.members, Members::NodeSet(_) | Members::Points(_)));
        let mut nodes = match lines.or(set) {
            Some(group) => match (self.boundary.edge(group), &group.members) {
                (_, Members::NodeSet(nodes) | Members::Points(nodes)) => self.used_of(nodes),
                (Ok(edge), _) => self.in_structure(&edge).nodes,
                (Err(_), Members::Lines(lines)) => {
                    let nodes = lines.iter().flat_map(|line| self.mesh.elements[*line as usize].nodes.iter().copied());
                    self.used_of(&nodes.collect::<Vec<u32>>())
                }
                (Err(_), _) => self.used_of(&self.boundary.nodes_of_sides(group)),
            },
            None if self.is_nearly_a_group(name) => return None,
            None => {
                let pieces = self.boundary.facing().iter().filter(|facing| DIRECTIONS[facing.direction] == name);
                pieces.flat_map(|facing| self.in_structure(&facing.edge).nodes).collect()
            }
        };
        let mut seen = HashSet::new();
        nodes.retain(|node| seen.insert(*node));
        (!nodes.is_empty()).then_some(nodes)
    }

    pub(super) fn used_of(&self, nodes: &[u32]) -> Vec<usize> {
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
