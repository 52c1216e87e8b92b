//! What a reader collects, and the [`Mesh`] that is made of it: numbers become indices, what is written twice becomes
//! one, areas are judged and turned.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::shape::{Shape, ShapeFault};
use super::{Group, LineType, Members, Mesh, MeshElement, MeshNode, MeshProblem, Place};
use crate::model::words::counted;

/// Nodes count as in one plane if they are this near to it, relative to the size of the mesh: what Gmsh itself allows
/// its geometry (`Geometry.Tolerance`).
const IN_PLANE: f64 = 1e-8;

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

/// A group as it is read.
pub struct RawGroup {
    pub dimension: u8,
    pub number: i64,
    pub name: Option<String>,
    pub members: RawMembers,
    pub place: Place,
}

struct RawElement {
    tag: u64,
    shape: Shape,
    line_type: LineType,
    place: Place,
    /// Its node numbers are [`RawMesh::tags`] from here on.
    first: usize,
}

/// What a reader has collected.
pub struct RawMesh {
    pub files: Vec<String>,
    format: String,
    pub nodes: Vec<MeshNode>,
    node_of: HashMap<u64, u32>,
    elements: Vec<RawElement>,
    tags: Vec<u64>,
    pub groups: Vec<RawGroup>,
    group_of: HashMap<(u8, i64), usize>,
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

    fn line_of(&self, place: Place) -> String {
        match place.line {
            0 => self.files[place.file as usize].clone(),
            line => format!("{}:{line}", self.files[place.file as usize]),
        }
    }

    /// Adds a node: its coordinates are finite, its number is new.
    pub fn add_node(&mut self, tag: u64, position: [f64; 3], place: Place) -> Result<(), MeshProblem> {
        // Larger ones have squares that are no numbers.
        const LARGEST: f64 = 1e150;
        for (axis, x) in ["x", "y", "z"].into_iter().zip(position) {
            if x.is_nan() || x.abs() > LARGEST {
                return Err(self.problem(
                    place,
                    format!("node {tag}: {axis} is {x}, which cannot be computed with"),
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

    fn first_at(&self, place: Place) -> String {
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

    /// Gives groups the names they have in the file, by dimension and number.
    pub fn name_groups(&mut self, mut names: HashMap<(u8, i64), (String, Place)>) {
        for group in &mut self.groups {
            if let Some((name, place)) = names.remove(&(group.dimension, group.number)) {
                group.name = Some(name).filter(|name| !name.trim().is_empty());
                group.place = place;
            }
        }
    }
}

/// Problems of many items: the first of each kind and how many others there are.
#[derive(Default)]
struct Faults(Vec<(&'static str, MeshProblem, usize)>);

impl Faults {
    fn add(&mut self, kind: &'static str, problem: impl FnOnce() -> MeshProblem) {
        match self.0.iter_mut().find(|(known, ..)| *known == kind) {
            Some((_, _, count)) => *count += 1,
            None => self.0.push((kind, problem(), 1)),
        }
    }

    fn end(self) -> Result<(), Vec<MeshProblem>> {
        let said = self.0.into_iter().map(|(_, mut problem, count)| {
            if count > 1 {
                problem.message += &format!(" (and {} like it)", counted(count - 1, "more element", "more elements"));
            }
            problem
        });
        let said: Vec<MeshProblem> = said.collect();
        if said.is_empty() { Ok(()) } else { Err(said) }
    }
}

/// The checked mesh.
///
/// # Errors
/// What is wrong with it: one problem of each kind.
pub fn mesh(raw: RawMesh) -> Result<Mesh, Vec<MeshProblem>> {
    if raw.elements.is_empty() {
        let message = "the mesh has no elements";
        return Err(vec![raw.problem(Place::default(), message, "mesh the geometry and save it with its elements")]);
    }
    let (mut elements, final_index) = resolved(&raw)?;
    in_one_plane(&raw, &elements)?;
    let turned = judged(&raw, &mut elements)?;
    let mut notes = raw.notes.clone();
    let turned_count = turned.iter().filter(|turned| **turned).count();
    if let Some(first) = turned.iter().position(|turned| *turned) {
        let first = &elements[first];
        notes.push(format!(
            "{} clockwise and {} turned round, the first at {}: element {}",
            if turned_count == 1 { "1 element runs".into() } else { format!("{turned_count} elements run") },
            if turned_count == 1 { "is" } else { "are" },
            raw.line_of(first.place),
            first.tag
        ));
    }
    let groups = groups(&raw, &elements, &final_index, &turned).map_err(|problem| vec![problem])?;
    let mut element_of = HashMap::new();
    for (element, index) in raw.elements.iter().zip(&final_index) {
        element_of.insert(element.tag, *index);
    }
    Ok(Mesh {
        files: raw.files,
        format: raw.format,
        nodes: raw.nodes,
        elements,
        groups,
        ignores_case: raw.ignores_case,
        notes,
        skipped: raw.skipped,
        node_of: raw.node_of,
        element_of,
    })
}

/// The elements with indices of nodes, each once, and the index of each that was added.
fn resolved(raw: &RawMesh) -> Result<(Vec<MeshElement>, Vec<u32>), Vec<MeshProblem>> {
    let mut faults = Faults::default();
    let mut elements: Vec<MeshElement> = Vec::with_capacity(raw.elements.len());
    let mut final_index = Vec::with_capacity(raw.elements.len());
    let mut by_tag: HashMap<u64, u32> = HashMap::with_capacity(raw.elements.len());
    let mut by_nodes: HashMap<[u32; 8], u32> = HashMap::with_capacity(raw.elements.len());
    for index in 0..raw.element_count() {
        let (tag, shape, tags) = raw.element(index);
        let place = raw.elements[index as usize].place;
        let mut key = [u32::MAX; 8];
        let mut missing = None;
        for (node, tag) in key.iter_mut().zip(tags) {
            match raw.node(*tag) {
                Some(found) => *node = found,
                None => missing = missing.or(Some(*tag)),
            }
        }
        if let Some(node) = missing {
            faults.add("node", || {
                raw.problem(
                    place,
                    format!("element {tag} names node {node}, which the file does not have"),
                    "save the mesh with all its nodes",
                )
            });
            final_index.push(0);
            continue;
        }
        let nodes = key[..shape.nodes()].to_vec();
        if let Some(node) = nodes.iter().enumerate().find_map(|(k, node)| nodes[..k].contains(node).then_some(*node)) {
            faults.add("twice", || {
                raw.problem(
                    place,
                    format!("element {tag} has node {} twice", raw.nodes[node as usize].tag),
                    format!("{} has different nodes: mesh again", shape.words()),
                )
            });
        }
        key.sort_unstable();
        let same_tag = by_tag.get(&tag).copied();
        let same_nodes = by_nodes.get(&key).copied().filter(|&other| elements[other as usize].shape == shape);
        match (same_tag, same_nodes) {
            (_, Some(other)) if raw.repeats_elements && same_tag.is_none_or(|same| same == other) => {
                by_tag.insert(tag, other);
                final_index.push(other);
                continue;
            }
            (Some(other), _) => faults.add("tag", || {
                raw.problem(
                    place,
                    format!("duplicate element {tag}{}", raw.first_at(elements[other as usize].place)),
                    "every element has a number of its own: renumber one of the two",
                )
            }),
            (None, Some(other)) if shape.is_area() => faults.add("nodes", || {
                let other = &elements[other as usize];
                raw.problem(
                    place,
                    format!("element {tag} has the same nodes as element {}{}", other.tag, raw.first_at(other.place)),
                    "two elements on one another count twice: remove one of the two",
                )
            }),
            _ => {}
        }
        by_tag.insert(tag, elements.len() as u32);
        by_nodes.insert(key, elements.len() as u32);
        final_index.push(elements.len() as u32);
        let line_type = raw.elements[index as usize].line_type;
        elements.push(MeshElement { tag, shape, nodes, line_type, place });
    }
    faults.end()?;
    Ok((elements, final_index))
}

/// The nodes of the areas lie in one plane z = const.
fn in_one_plane(raw: &RawMesh, elements: &[MeshElement]) -> Result<(), Vec<MeshProblem>> {
    let areas = || elements.iter().filter(|element| element.shape.is_area());
    let Some(first) = areas().next().map(|element| element.nodes[0] as usize) else { return Ok(()) };
    let position = |node: u32| raw.nodes[node as usize].position;
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for node in areas().flat_map(|element| &element.nodes) {
        for (axis, x) in position(*node).into_iter().enumerate() {
            (low[axis], high[axis]) = (low[axis].min(x), high[axis].max(x));
        }
    }
    let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let plane = raw.nodes[first].position[2];
    let mut faults = Faults::default();
    for element in areas() {
        if let Some(&node) = element.nodes.iter().find(|&&node| (position(node)[2] - plane).abs() > IN_PLANE * size) {
            faults.add("plane", || {
                raw.problem(
                    element.place,
                    format!(
                        "element {} lies outside the plane of the mesh: its node {} has z = {}, node {} has z = {plane}",
                        element.tag,
                        raw.nodes[node as usize].tag,
                        position(node)[2],
                        raw.nodes[first].tag
                    ),
                    "a structure lies in the x-y plane: every node has the same z",
                )
            });
        }
    }
    faults.end()
}

/// Turns clockwise areas round and says which; refuses those that enclose no area.
fn judged(raw: &RawMesh, elements: &mut [MeshElement]) -> Result<Vec<bool>, Vec<MeshProblem>> {
    let mut faults = Faults::default();
    let mut turned = vec![false; elements.len()];
    for (element, turned) in elements.iter_mut().zip(&mut turned) {
        if !element.shape.is_area() {
            continue;
        }
        let place = |node: &u32| {
            let [x, y, _] = raw.nodes[*node as usize].position;
            [x, y]
        };
        let positions: Vec<[f64; 2]> = element.nodes.iter().map(place).collect();
        match element.shape.is_clockwise(&positions) {
            Ok(false) => {}
            Ok(true) => {
                element.nodes = element.shape.turned(&element.nodes);
                *turned = true;
            }
            Err(fault) => {
                let (kind, what, help) = said(raw, element, fault);
                faults.add(kind, || raw.problem(element.place, format!("element {} {what}", element.tag), help));
            }
        }
    }
    faults.end()?;
    Ok(turned)
}

fn said(raw: &RawMesh, element: &MeshElement, fault: ShapeFault) -> (&'static str, String, &'static str) {
    let tag = |k: usize| raw.nodes[element.nodes[k] as usize].tag;
    match fault {
        ShapeFault::Coincident(a, b) => (
            "coincident",
            format!("has no length between its nodes {} and {}, which are at the same place", tag(a), tag(b)),
            "remove the element, or join its neighbours over it",
        ),
        ShapeFault::BowTie => (
            "bow tie",
            "is a bow tie: two of its sides cross".into(),
            "list its corners in the order in which they go round",
        ),
        ShapeFault::NoArea => {
            ("area", "has zero area: its corners lie on one line".into(), "remove the element, or mesh again")
        }
        ShapeFault::NotConvex => (
            "convex",
            "is not convex: a corner has 180° or more, so the Jacobian is not positive there".into(),
            "split it into triangles, or mesh again",
        ),
        ShapeFault::Folded => (
            "folded",
            "has middle nodes so far from the middle of their sides that its Jacobian is not positive everywhere"
                .into(),
            "move them to the middle half of their sides, or mesh with straight sides",
        ),
    }
}

/// Groups that have members, lines and areas apart.
fn groups(
    raw: &RawMesh,
    elements: &[MeshElement],
    final_index: &[u32],
    turned: &[bool],
) -> Result<Vec<Group>, MeshProblem> {
    let mut groups = Vec::new();
    for group in &raw.groups {
        let name = group.name.clone().unwrap_or_else(|| group.number.to_string());
        let nodes = |tags: &[u64]| -> Result<Vec<u32>, MeshProblem> {
            let found = tags.iter().map(|&tag| {
                raw.node(tag).ok_or_else(|| {
                    raw.problem(
                        group.place,
                        format!("the group \"{name}\" names node {tag}, which the file does not have"),
                        "save the mesh with all its nodes",
                    )
                })
            });
            Ok(once(found.collect::<Result<Vec<u32>, MeshProblem>>()?))
        };
        let all = match &group.members {
            RawMembers::Points(tags) => vec![Members::Points(nodes(tags)?)],
            RawMembers::NodeSet(tags) => vec![Members::NodeSet(nodes(tags)?)],
            RawMembers::Elements(indices) => {
                let indices = once(indices.iter().map(|&index| final_index[index as usize]).collect());
                let (areas, lines) =
                    indices.into_iter().partition(|&index: &u32| elements[index as usize].shape.is_area());
                vec![Members::Lines(lines), Members::Areas(areas)]
            }
            RawMembers::Sides(sides) => {
                let side = |&(index, corner): &(u32, Option<u8>)| {
                    let index = final_index[index as usize];
                    let corners = elements[index as usize].shape.corners() as u8;
                    let corner = corner.map(|k| if turned[index as usize] { corners - 1 - k } else { k });
                    (index, corner)
                };
                vec![Members::Sides(once(sides.iter().map(side).collect()))]
            }
        };
        groups.extend(all.into_iter().filter(|members| members.count() > 0).map(|members| Group {
            name: name.clone(),
            is_named: group.name.is_some(),
            members,
            place: group.place,
        }));
    }
    Ok(groups)
}

/// Each member once, in the order of the first time.
fn once<T: Copy + Eq + std::hash::Hash>(members: Vec<T>) -> Vec<T> {
    let mut seen = std::collections::HashSet::with_capacity(members.len());
    members.into_iter().filter(|member| seen.insert(*member)).collect()
}
