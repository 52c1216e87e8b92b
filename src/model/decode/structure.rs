//! The source *structure*: reads its parts in the order in which they refer to each other, resolves names.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use super::mesh_names::MeshPart;
use super::reader::{Cursor, Fields, Place};
use super::words::{ID_RULE, did_you_mean, is_id, nearest, quoted};
use super::{contacts, edges, elements, foundations, loads, rigid, superelement, supports};
use crate::model::edge::{Edge, PlateSide};
use crate::model::scenario::Places;
use crate::model::structure::{Component, Node, Structure};
use crate::model::superelement::Superelement;

/// Cross-section of bars.
pub struct Section {
    pub area: f64,
    /// Only frames need one.
    pub inertia: Option<f64>,
    /// Frames yield to shear only with one.
    pub shear_area: Option<f64>,
    /// Needed where the temperature varies across the bar.
    pub depth: Option<f64>,
}

/// Displacement that a load case imposes on a component held by a support.
#[derive(Clone, Copy)]
pub struct Settlement<'d> {
    /// Where the case is named.
    pub case: Cursor<'d>,
    /// The node.
    pub node: usize,
    /// The component.
    pub component: Component,
    /// The amount.
    pub value: f64,
}

/// An element of a bar and where it lies along it.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// Index of the element.
    pub element: usize,
    /// Distance of its start from the start of the bar.
    pub from: f64,
    /// Its length.
    pub length: f64,
    /// (cos, sin) of its direction.
    pub direction: [f64; 2],
}

/// What a `at` names.
#[derive(Clone)]
pub enum Spot {
    Node(usize),
    Edge(Edge),
}

/// The structure as read so far, and the names by which later parts refer to it.
pub struct Builder<'d> {
    pub structure: Structure,
    pub places: Places,
    pub materials: HashMap<&'d str, usize>,
    pub sections: HashMap<&'d str, Section>,
    /// By their ids; those of meshes are made of the names of groups.
    pub bars: HashMap<Cow<'d, str>, usize>,
    /// Section of each bar, in the order of the bars.
    pub bar_sections: Vec<&'d str>,
    pub plates: HashMap<&'d str, usize>,
    pub meshes: HashMap<&'d str, MeshPart>,
    /// What was put right in mesh files.
    pub notes: Vec<String>,
    /// The edges that have a name of their own.
    pub edges: HashMap<&'d str, Edge>,
    /// Triangles and quads by their ids.
    pub single_elements: HashMap<&'d str, usize>,
    /// Nodes of the author and of bar divisions; those of plates and meshes are found by their indices.
    pub nodes: HashMap<String, usize>,
    /// Every id and what it names.
    ids: HashMap<&'d str, &'static str>,
    /// Names whose definition is wrong: reported there, not again where they are used.
    pub broken: HashSet<&'d str>,
    pub ends_of_broken_bars: Vec<Cursor<'d>>,
    /// Whether `nodes` was read at all; if not, unknown nodes are no news.
    nodes_are_known: bool,
    /// Imposed displacements of supports, until their load cases are known.
    pub settlements: Vec<Settlement<'d>>,
    /// The rigid body of each of their nodes.
    pub body_of: HashMap<usize, usize>,
    /// Whether each node has a rotation; empty until the elements are complete.
    pub has_rotation: Vec<bool>,
    /// Whether every element was read, so that what they do not touch can be judged.
    pub elements_complete: bool,
}

/// A structure as it was read.
pub struct Found {
    pub structure: Structure,
    pub places: Places,
    /// What was put right in mesh files.
    pub notes: Vec<String>,
}

/// Reads a structure. `None`, or an incomplete structure, only after a problem was reported.
pub fn read<'d>(fields: &Fields<'d>, path: Option<&Path>) -> Option<Found> {
    let before = fields.cursor().problems_so_far();
    let mut builder = Builder {
        structure: Structure::default(),
        places: Places::default(),
        materials: HashMap::new(),
        sections: HashMap::new(),
        bars: HashMap::new(),
        bar_sections: Vec::new(),
        plates: HashMap::new(),
        meshes: HashMap::new(),
        notes: Vec::new(),
        edges: HashMap::new(),
        single_elements: HashMap::new(),
        nodes: HashMap::new(),
        ids: HashMap::new(),
        broken: HashSet::new(),
        ends_of_broken_bars: Vec::new(),
        nodes_are_known: true,
        settlements: Vec::new(),
        body_of: HashMap::new(),
        has_rotation: Vec::new(),
        elements_complete: false,
    };
    let names = match fields.optional("superelement") {
        Some(at) => superelement::read(&mut builder, fields, at, path)?,
        None => {
            let names = add_nodes(&mut builder, fields.optional("nodes"), "nodes");
            elements::read(&mut builder, fields)?;
            names
        }
    };
    builder.elements_complete = fields.cursor().problems_so_far() == before;
    builder.find_rotations();
    edges::read(&mut builder, fields);
    rigid::read(&mut builder, fields);
    supports::read(&mut builder, fields);
    contacts::read(&mut builder, fields)?;
    foundations::read(&mut builder, fields);
    loads::read(&mut builder, fields);
    if builder.elements_complete {
        builder.report_loose_nodes(fields, &names);
    }
    Some(Found { structure: builder.structure, places: builder.places, notes: builder.notes })
}

/// Adds the nodes of the file, which stand at the path `within`; the places of their names.
pub fn add_nodes<'d>(builder: &mut Builder<'d>, nodes: Option<Cursor<'d>>, within: &str) -> Vec<Place<'d>> {
    let mut names = Vec::new();
    let entries = nodes.and_then(Cursor::entries);
    builder.nodes_are_known = nodes.is_none() || entries.is_some();
    for entry in entries.unwrap_or_default() {
        builder.register(entry.key_place(), entry.name(), "node");
        // A node without a usable place stays known, with a place that no geometric check complains about.
        let position = entry.value().vector().unwrap_or([f64::NAN; 2]);
        names.push(entry.key_place());
        builder.add_node(Node { id: entry.name().to_string(), position }, format!("{within}.{}", entry.name()).into());
    }
    names
}

impl<'d> Builder<'d> {
    /// Makes an id known; reports an ill-formed or repeated one.
    pub fn register(&mut self, place: Place<'d>, id: &'d str, kind: &'static str) {
        if !is_id(id) {
            place.problem(format!("{} cannot be an id", quoted(id)), ID_RULE);
        } else if let Some(first) = self.ids.insert(id, kind) {
            place.problem(
                format!("duplicate id {}: a {first} has it already", quoted(id)),
                "nodes, elements, edges and contacts share one set of ids: rename one of the two",
            );
        }
    }

    /// Appends a node that can be named.
    pub fn add_node(&mut self, node: Node, place: Arc<str>) -> usize {
        let index = self.structure.nodes.len();
        self.nodes.insert(node.id.clone(), index);
        self.structure.nodes.push(node);
        self.places.nodes.push(place);
        index
    }

    /// The id of a node.
    pub fn node_id(&self, node: usize) -> &str {
        &self.structure.nodes[node].id
    }

    /// The node or edge that a string names.
    pub fn spot(&self, cursor: Cursor<'d>) -> Option<Spot> {
        let name = cursor.string()?;
        if let Some(&node) = self.nodes.get(name) {
            return Some(Spot::Node(node));
        }
        if let Some(edge) = self.edges.get(name) {
            return Some(Spot::Edge(edge.clone()));
        }
        if let Some((part, rest)) = self.mesh_name(name) {
            return part.spot(cursor, rest);
        }
        if self.is_of_broken_mesh(name) {
            return None;
        }
        if let Some((id, side)) = name.split_once('.') {
            let plate = self.plate(cursor, id, name)?;
            let Some((_, side)) = PlateSide::WORDS.iter().find(|(word, _)| *word == side) else {
                cursor.problem(
                    format!("the plate \"{id}\" has no edge {}", quoted(side)),
                    format!("expected {id}.bottom, {id}.top, {id}.left or {id}.right"),
                );
                return None;
            };
            return Some(Spot::Edge(side.edge(&self.structure.plates[plate])));
        }
        if let Some((id, indices)) = name.strip_suffix(']').and_then(|rest| rest.split_once('[')) {
            let plate = self.plate(cursor, id, name)?;
            let node = self.plate_node(plate, indices);
            if node.is_none() {
                let grid = &self.structure.plates[plate].nodes;
                cursor.problem(
                    format!("the plate \"{id}\" has no node {}", quoted(name)),
                    format!(
                        "its nodes are {id}[i,j] with i = 0…{} and j = 0…{}, without spaces",
                        grid[0].len() - 1,
                        grid.len() - 1
                    ),
                );
            }
            return node.map(Spot::Node);
        }
        self.unknown_spot(cursor, name);
        None
    }

    /// The mesh that a name begins with, and what follows its id.
    fn mesh_name<'n>(&self, name: &'n str) -> Option<(&MeshPart, &'n str)> {
        let at = name.find(['/', '.', '#'])?;
        Some((self.meshes.get(&name[..at])?, &name[at..]))
    }

    fn is_of_broken_mesh(&self, name: &str) -> bool {
        name.find(['/', '.', '#']).is_some_and(|at| self.broken.contains(&name[..at]))
    }

    /// All nodes that `at` names, where their order does not matter: one, those of an edge, or those of a set.
    pub fn nodes_at(&self, cursor: Cursor<'d>) -> Option<Vec<usize>> {
        let name = cursor.string()?;
        let set = self.mesh_name(name).and_then(|(part, rest)| part.node_set(rest));
        set.or_else(|| match self.spot(cursor)? {
            Spot::Node(node) => Some(vec![node]),
            Spot::Edge(edge) => Some(edge.distinct_nodes().to_vec()),
        })
    }

    /// All nodes of an edge or a set; a single node is reported.
    pub fn edge_nodes_at(&self, cursor: Cursor<'d>) -> Option<Vec<usize>> {
        match self.nodes_at(cursor)? {
            nodes if nodes.len() > 1 => Some(nodes),
            _ => self.edge(cursor).map(|edge| edge.nodes),
        }
    }

    fn plate(&self, cursor: Cursor<'d>, id: &str, name: &str) -> Option<usize> {
        let plate = self.plates.get(id).copied();
        if plate.is_none() && !self.broken.contains(id) {
            let known: Vec<&str> = self.plates.keys().copied().collect();
            let hint = match nearest(id, known) {
                Some(near) => format!(": did you mean {}?", quoted(&name.replacen(id, near, 1))),
                None => String::new(),
            };
            cursor.problem(format!("unknown plate {} in {}{hint}", quoted(id), quoted(name)), self.known_plates());
        }
        plate
    }

    fn plate_node(&self, plate: usize, indices: &str) -> Option<usize> {
        let (i, j) = indices.split_once(',')?;
        let index = |digits: &str| {
            let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
            digits.parse::<usize>().ok().filter(|_| plain)
        };
        let row = self.structure.plates[plate].nodes.get(index(j)?)?;
        row.get(index(i)?).copied()
    }

    fn unknown_spot(&self, cursor: Cursor<'d>, name: &str) {
        let bar = name.split_once('/').map(|(bar, _)| bar);
        if !self.nodes_are_known || self.broken.contains(name) || bar.is_some_and(|bar| self.broken.contains(bar)) {
            return;
        }
        if self.meshes.contains_key(name) {
            cursor.problem(
                format!("\"{name}\" is a mesh, expected a node or an edge"),
                format!("name one of its nodes, \"{name}/17\", or groups of lines, \"{name}.GROUP\""),
            );
            return;
        }
        if self.plates.contains_key(name) {
            cursor.problem(
                format!("\"{name}\" is a plate, expected a node or an edge"),
                format!("name one of its nodes, \"{name}[i,j]\", or edges, \"{name}.top\""),
            );
            return;
        }
        if let Some((id, bar)) = bar.and_then(|id| Some((id, *self.bars.get(id)?))) {
            let divisions = self.structure.bars[bar].elements.len();
            let help = match divisions {
                1 => format!("the bar \"{id}\" is not divided: give it `divisions`"),
                2 => format!("its one inner node is \"{id}/1\""),
                _ => format!("its inner nodes are \"{id}/1\" to \"{id}/{}\"", divisions - 1),
            };
            cursor.problem(format!("the bar \"{id}\" has no node {}", quoted(name)), help);
            return;
        }
        let hint = did_you_mean(name, self.nodes.keys().map(String::as_str));
        let help = if hint.is_empty() {
            "expected the id of a node, a plate node like \"lower[0,8]\" or an edge like \"lower.top\""
        } else {
            "nodes are named by their id"
        };
        cursor.problem(format!("unknown node {}{hint}", quoted(name)), help);
    }

    fn known_plates(&self) -> String {
        let mut known: Vec<&str> = self.plates.keys().copied().collect();
        known.sort_unstable();
        if known.is_empty() {
            "the structure has no plates".into()
        } else {
            format!("expected {}", super::words::listed(&known))
        }
    }

    /// The node that a string names; an edge is reported.
    pub fn node(&self, cursor: Cursor<'d>) -> Option<usize> {
        match self.spot(cursor)? {
            Spot::Node(node) => Some(node),
            Spot::Edge(_) => {
                cursor.problem(
                    format!("expected a node, found the edge {}", cursor.quoted()),
                    "name one node, e.g. a plate node \"lower[0,8]\"",
                );
                None
            }
        }
    }

    /// The edge that a string names; a node is reported.
    pub fn edge(&self, cursor: Cursor<'d>) -> Option<Edge> {
        match self.spot(cursor)? {
            Spot::Edge(edge) => Some(edge),
            Spot::Node(_) => {
                cursor.problem(
                    format!("expected an edge, found the node {}", cursor.quoted()),
                    "edges belong to plates, \"lower.top\", or are named under `edges`",
                );
                None
            }
        }
    }

    /// The elements of a bar, plate, mesh, group of a mesh, triangle or quad that a string names.
    pub fn elements_of(&self, cursor: Cursor<'d>) -> Option<Vec<usize>> {
        let name = cursor.string()?;
        if let Some(&bar) = self.bars.get(name) {
            return Some(self.structure.bars[bar].elements.clone().collect());
        }
        if let Some(&plate) = self.plates.get(name) {
            return Some(self.structure.plates[plate].elements.clone().collect());
        }
        if let Some(&element) = self.single_elements.get(name) {
            return Some(vec![element]);
        }
        let mesh = self.meshes.get(name).map(|part| (part, ""));
        if let Some((part, rest)) = mesh.or_else(|| self.mesh_name(name)) {
            return part.elements(cursor, rest);
        }
        if !self.broken.contains(name) && !self.is_of_broken_mesh(name) {
            let own = self.plates.keys().chain(self.single_elements.keys()).chain(self.meshes.keys()).copied();
            let mut known: Vec<&str> = self.bars.keys().map(|id| &**id).chain(own).collect();
            known.sort_unstable();
            cursor.unknown("element", name, &known);
        }
        None
    }

    /// The elements of a bar with their places along it.
    pub fn stretches(&self, bar: usize) -> Vec<Stretch> {
        let structure = &self.structure;
        let mut from = 0.0;
        let stretch = |element: usize| {
            let nodes = &structure.elements[element].nodes;
            let [a, b] = [0, 1].map(|end| structure.nodes[nodes[end]].position);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dy);
            let stretch = Stretch { element, from, length, direction: [dx / length, dy / length] };
            from += length;
            stretch
        };
        structure.bars[bar].elements.clone().map(stretch).collect()
    }

    /// The element of a bar at a distance from its start, and the distance from the start of that element.
    pub fn place_on_bar(&self, at: Cursor<'d>, bar: usize, distance: f64) -> Option<(usize, f64)> {
        let stretches = self.stretches(bar);
        let last = stretches.last()?;
        let total = last.from + last.length;
        // A distance computed by an expression may miss the end of the bar by rounding.
        let room = 4.0 * f64::EPSILON * total;
        if !(distance >= -room && distance <= total + room) {
            at.problem(
                format!(
                    "the distance {distance} is not on the bar \"{}\", which is {total} long",
                    self.structure.bars[bar].id
                ),
                format!("give a distance from its start between 0 and {total}"),
            );
            return None;
        }
        let stretch = stretches.iter().rev().find(|stretch| stretch.from <= distance).unwrap_or(&stretches[0]);
        Some((stretch.element, (distance - stretch.from).clamp(0.0, stretch.length)))
    }

    fn find_rotations(&mut self) {
        self.has_rotation = vec![false; self.structure.nodes.len()];
        for &(node, component) in self.structure.superelement.iter().flat_map(|element| &element.dofs) {
            self.has_rotation[node] |= component == Component::R;
        }
        for element in &self.structure.elements {
            if element.bends() {
                for &node in &element.nodes {
                    self.has_rotation[node] = true;
                }
            }
        }
    }

    /// Whether a superelement knows nothing of a displacement of this node.
    pub fn lacks(&self, node: usize, component: Component) -> bool {
        let knows = |element: &Superelement| element.dofs.contains(&(node, component));
        self.structure.superelement.as_ref().is_some_and(|element| !knows(element)) && !self.body_of.contains_key(&node)
    }

    /// Reports a displacement along x or y asked of a node of a superelement that has none.
    pub fn demand_displacement(&self, cursor: Cursor<'d>, node: usize, direction: [f64; 2], what: &str) -> bool {
        let asked = [(Component::X, "x"), (Component::Y, "y")].into_iter().zip(direction);
        let Some(((_, word), _)) = asked.into_iter().find(|((c, _), amount)| *amount != 0.0 && self.lacks(node, *c))
        else {
            return true;
        };
        cursor.problem(
            format!("the node \"{}\" of the superelement has no dof \"{word}\": {what}", self.node_id(node)),
            "keep this displacement when K is made and name it in `dofs`, or choose another direction",
        );
        false
    }

    /// Whether the structure consists of springs, rigid bodies or a superelement alone.
    pub fn has_no_elements(&self) -> bool {
        self.structure.elements.is_empty() && self.elements_complete
    }

    /// Reports a rotation asked of a node that has none. Silent while elements are missing for other reasons.
    pub fn demand_rotation(&self, cursor: Cursor<'d>, node: usize, what: &str) -> bool {
        if self.has_rotation[node] || !self.elements_complete {
            return true;
        }
        cursor.problem(
            format!("the node \"{}\" has no rotation: {what}", self.node_id(node)),
            "only nodes of frame bars and of rigid bodies have one: remove it here",
        );
        false
    }

    /// A node that nothing holds or connects would move freely: reported at its name.
    fn report_loose_nodes(&self, fields: &Fields<'d>, names: &[Place<'d>]) {
        let structure = &self.structure;
        if structure.superelement.is_none()
            && structure.elements.is_empty()
            && structure.springs.is_empty()
            && structure.rigid.is_empty()
        {
            let message =
                "the structure has no elements: expected bars, plates, meshes, quads, rigid bodies or springs";
            fields.cursor().problem(message, "add what carries the load");
            return;
        }
        let mut touched = vec![false; structure.nodes.len()];
        let dofs = structure.superelement.iter().flat_map(|element| &element.dofs).map(|(node, _)| node);
        let elements = structure.elements.iter().flat_map(|element| &element.nodes);
        let rigid = structure.rigid.iter().flat_map(|body| &body.nodes);
        let ties = structure.ties.iter().flat_map(|tie| &tie.nodes);
        let supports = structure.supports.iter().map(|support| &support.node);
        let springs = structure.springs.iter().flat_map(|spring| spring.terms.iter().map(|term| &term.node));
        for &node in elements.chain(dofs).chain(rigid).chain(ties).chain(supports).chain(springs) {
            touched[node] = true;
        }
        // The author's nodes come first, so names and touched run side by side; generated nodes have elements.
        for (node, place) in names.iter().enumerate() {
            if !touched[node] {
                place.problem(
                    format!(
                        "nothing is connected to the node \"{}\": no bar, quad, rigid body, tie, spring or support",
                        self.node_id(node)
                    ),
                    "connect it or remove it",
                );
            }
        }
    }
}
