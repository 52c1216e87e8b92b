//! What a reader collects before anything of it is believed.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::{LineType, MeshNode, MeshProblem, Place};
use crate::model::shape::Shape;

/// Members of a group as the file names them.
pub enum RawMembers {
    /// Numbers of the nodes of points.
    Points(Vec<u64>),
    /// Numbers of the nodes of a set.
    NodeSet(Vec<u64>),
    /// Indices of elements as they were added.
    Elements(Vec<u32>),
    /// Sides of such elements.
    Sides(Vec<(u32, Option<u8>)>),
}

impl RawMembers {
    /// Takes in those of the same kind.
    fn extend(&mut self, more: RawMembers) {
        match (self, more) {
            (RawMembers::Points(all), RawMembers::Points(more)) => all.extend(more),
            (RawMembers::NodeSet(all), RawMembers::NodeSet(more)) => all.extend(more),
            (RawMembers::Elements(all), RawMembers::Elements(more)) => all.extend(more),
            (RawMembers::Sides(all), RawMembers::Sides(more)) => all.extend(more),
            _ => {}
        }
    }
}

/// A group as it is read.
pub struct RawGroup {
    pub dimension: u8,
    pub number: i64,
    pub name: Option<String>,
    pub members: RawMembers,
    pub place: Place,
}

/// An element as it is read.
pub struct RawElement {
    pub tag: u64,
    shape: Shape,
    pub line_type: LineType,
    pub place: Place,
    /// Its node numbers are [`RawMesh::tags`] from here on.
    first: usize,
}

/// What a reader has collected.
pub struct RawMesh {
    pub files: Vec<String>,
    pub format: String,
    pub nodes: Vec<MeshNode>,
    pub node_of: HashMap<u64, u32>,
    pub elements: Vec<RawElement>,
    tags: Vec<u64>,
    pub groups: Vec<RawGroup>,
    group_of: HashMap<(u8, i64), usize>,
    /// Names of empty groups, and where they stand.
    pub empty_groups: Vec<(String, Place)>,
    pub skipped: Vec<String>,
    pub notes: Vec<String>,
    pub ignores_case: bool,
    /// Whether the format writes an element again for every group it is in.
    pub repeats_elements: bool,
}

impl RawMesh {
    pub fn new(name: &str, format: String) -> Self {
        RawMesh {
            files: vec![name.to_owned()],
            format,
            nodes: Vec::new(),
            node_of: HashMap::new(),
            elements: Vec::new(),
            tags: Vec::new(),
            groups: Vec::new(),
            group_of: HashMap::new(),
            empty_groups: Vec::new(),
            skipped: Vec::new(),
            notes: Vec::new(),
            ignores_case: false,
            repeats_elements: false,
        }
    }

    /// A problem at a place.
    pub fn problem(&self, place: Place, message: impl Into<String>, help: impl Into<String>) -> MeshProblem {
        let file = self.files[place.file as usize].clone();
        MeshProblem { file, line: place.line as usize, message: message.into(), help: help.into() }
    }

    /// `dam.msh:17`.
    pub fn line_of(&self, place: Place) -> String {
        match place.line {
            0 => self.files[place.file as usize].clone(),
            line => format!("{}:{line}", self.files[place.file as usize]),
        }
    }

    /// Adds a node: its coordinates are finite, its number is new.
    pub fn add_node(&mut self, tag: u64, position: [f64; 3], place: Place) -> Result<(), MeshProblem> {
        // Larger ones have squares that are not numbers.
        const LARGEST: f64 = 1e150;
        for (axis, x) in ["x", "y", "z"].into_iter().zip(position) {
            if x.is_nan() || x.abs() > LARGEST {
                let shown = if x.is_finite() { format!("{x:e}") } else { x.to_string() };
                return Err(self.problem(
                    place,
                    format!("node {tag}: {axis} is {shown}, which cannot be computed with"),
                    "coordinates are finite numbers up to 1e150: correct the file, or mesh again",
                ));
            }
        }
        match self.node_of.entry(tag) {
            Entry::Occupied(first) => {
                let first = self.nodes[*first.get() as usize].place;
                Err(self.problem(
                    place,
                    format!("duplicate node {tag}{}", self.first_at(first)),
                    "every node has a number of its own: renumber one of the two",
                ))
            }
            Entry::Vacant(new) => {
                new.insert(self.nodes.len() as u32);
                self.nodes.push(MeshNode { tag, position, place });
                Ok(())
            }
        }
    }

    /// `, first at dam.msh:17`, where there are lines.
    pub fn first_at(&self, place: Place) -> String {
        if place.line == 0 { String::new() } else { format!(", first at {}", self.line_of(place)) }
    }

    /// The node with this number.
    pub fn node(&self, tag: u64) -> Option<u32> {
        self.node_of.get(&tag).copied()
    }

    /// Adds an element with the numbers of its nodes and returns its index.
    pub fn add_element(&mut self, tag: u64, shape: Shape, nodes: &[u64], place: Place) -> u32 {
        let (index, first) = (self.elements.len(), self.tags.len());
        self.elements.push(RawElement { tag, shape, line_type: LineType::Beam, place, first });
        self.tags.extend_from_slice(nodes);
        index as u32
    }

    /// Says of the element added last that it is a truss.
    pub fn last_is_truss(&mut self) {
        if let Some(last) = self.elements.last_mut() {
            last.line_type = LineType::Truss;
        }
    }

    /// Number, shape and node numbers of an element.
    pub fn element(&self, index: u32) -> (u64, Shape, &[u64]) {
        let element = &self.elements[index as usize];
        (element.tag, element.shape, &self.tags[element.first..element.first + element.shape.nodes()])
    }

    /// Two elements of one number.
    pub fn duplicate_element(&self, second: u32, first: u32) -> MeshProblem {
        let [second, first] = [second, first].map(|index| &self.elements[index as usize]);
        self.problem(
            second.place,
            format!("duplicate element {}{}", second.tag, self.first_at(first.place)),
            "every element has a number of its own: renumber one of the two",
        )
    }

    /// Number of elements so far.
    pub fn element_count(&self) -> u32 {
        self.elements.len() as u32
    }

    /// Adds the node of a point to groups of points.
    pub fn add_point(&mut self, node: u64, groups: &[i64], place: Place) {
        for &number in groups {
            if let RawMembers::Points(nodes) = self.group(0, number, place) {
                nodes.push(node);
            }
        }
    }

    /// Adds the last element to groups of its dimension.
    pub fn put_in_groups(&mut self, shape: Shape, groups: &[i64], place: Place) {
        let last = self.element_count() - 1;
        for &number in groups {
            if let RawMembers::Elements(elements) = self.group(shape.dimension(), number, place) {
                elements.push(last);
            }
        }
    }

    fn group(&mut self, dimension: u8, number: i64, place: Place) -> &mut RawMembers {
        let groups = &mut self.groups;
        let index = *self.group_of.entry((dimension, number)).or_insert_with(|| {
            let members =
                if dimension == 0 { RawMembers::Points(Vec::new()) } else { RawMembers::Elements(Vec::new()) };
            groups.push(RawGroup { dimension, number, name: None, members, place });
            groups.len() - 1
        });
        &mut groups[index].members
    }

    /// Gives groups the names they have in the file, by dimension and number; those of one dimension and name are one
    /// group. Names of groups without members are kept, to be reported where they are asked for.
    pub fn name_groups(&mut self, mut names: HashMap<(u8, i64), (String, Place)>) {
        let mut first_of: HashMap<(u8, String), usize> = HashMap::new();
        let mut groups: Vec<RawGroup> = Vec::with_capacity(self.groups.len());
        for mut group in std::mem::take(&mut self.groups) {
            let found = names.remove(&(group.dimension, group.number)).filter(|(name, _)| !name.trim().is_empty());
            if let Some((name, place)) = found {
                group.place = place;
                if let Some(&first) = first_of.get(&(group.dimension, name.clone())) {
                    groups[first].members.extend(group.members);
                    continue;
                }
                first_of.insert((group.dimension, name.clone()), groups.len());
                group.name = Some(name);
            }
            groups.push(group);
        }
        self.groups = groups;
        self.empty_groups.extend(names.into_values().filter(|(name, _)| !name.trim().is_empty()));
        self.empty_groups.sort_by_key(|(_, place)| place.line);
    }
}
