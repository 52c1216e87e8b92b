//! The structure while it is read, and what every reader of a part of it asks.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::mesh_names::MeshPart;
use super::name_table::NameTable;
use super::reader::{Cursor, Fields, Place};
use super::words::{ID_RULE, is_id, quoted};
use crate::model::bar_axes::BarAxes;
use crate::model::edge::Edge;
use crate::model::scenario::{NodePlace, Places};
use crate::model::space_section::SpaceSection;
use crate::model::structure::{Component, ElementKind, Node, Structure};
use crate::model::superelement::Superelement;
use crate::model::vector::{distance, way};

/// What an id of a node names.
const NODE: &str = "node";

/// Cross-section of bars.
pub struct Section {
    pub area: f64,
    /// Of bars in the plane that bend; only frames need one.
    pub bending: Option<Bending>,
    /// Needed where the temperature varies across the bar: along y, and in space along z.
    pub depth: [Option<f64>; 2],
}

/// What a section needs to bend.
#[derive(Clone, Copy)]
pub enum Bending {
    /// In the plane; frames yield to shear only with a shear area.
    Plane { inertia: f64, shear_area: Option<f64> },
    /// In space.
    Space(SpaceSection),
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
    /// Its direction, a unit vector.
    pub direction: [f64; 3],
}

/// The structure as read so far, and the names by which later parts refer to it.
#[derive(Default)]
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
    pub bricks: HashMap<&'d str, usize>,
    pub meshes: HashMap<&'d str, MeshPart>,
    /// What was put right in mesh files.
    pub notes: Vec<String>,
    /// The edges that have a name of their own.
    pub edges: HashMap<&'d str, Edge>,
    /// Triangles and quads by their ids.
    pub single_elements: HashMap<&'d str, usize>,
    /// Nodes of the author and of bar divisions; those of plates and meshes are found by their indices.
    nodes: NameTable,
    /// Every id but those of nodes, and what it names.
    ids: HashMap<&'d str, &'static str>,
    /// Names whose definition is wrong: reported there, not again where they are used.
    pub broken: HashSet<&'d str>,
    pub ends_of_broken_bars: Vec<Cursor<'d>>,
    /// The object of the author's nodes.
    pub listed_nodes: Option<Cursor<'d>>,
    /// Whether `nodes` could not be read at all: unknown nodes are then not reported.
    pub nodes_are_unknown: bool,
    /// Imposed displacements of supports, until their load cases are known.
    pub settlements: Vec<Settlement<'d>>,
    /// The rigid body of each node that is in one.
    pub body_of: HashMap<usize, usize>,
    /// Whether each node has a rotation; empty until the elements are complete.
    pub has_rotation: Vec<bool>,
    /// Whether every element was read, so that what they do not touch can be judged.
    pub elements_complete: bool,
}

impl<'d> Builder<'d> {
    /// Makes an id known; reports an ill-formed or repeated one.
    pub fn register(&mut self, place: Place<'d>, id: &'d str, kind: &'static str) {
        if !is_id(id) {
            place.problem(format!("{} cannot be an id", quoted(id)), ID_RULE);
        } else if let Some(first) = self.named(id, kind) {
            place.problem(
                format!("duplicate id {}: a {first} has it already", quoted(id)),
                "nodes, elements, edges and contacts share one set of ids: rename one of the two",
            );
        }
    }

    /// What had an id before; from now on it names this kind. A node is known by its own table, once it is added.
    fn named(&mut self, id: &'d str, kind: &'static str) -> Option<&'static str> {
        let node = self.node_named(id).map(|_| NODE);
        let other = if kind == NODE { self.ids.get(id).copied() } else { self.ids.insert(id, kind) };
        node.or(other)
    }

    /// Appends a node that can be named.
    pub fn add_node(&mut self, id: String, position: [f64; 3]) -> usize {
        let nodes = &mut self.structure.nodes;
        let index = nodes.len();
        nodes.push(Node { id, position });
        // A later one of the same name is reported where it stands.
        let _ = self.nodes.insert(index as u32, |node| &nodes[node as usize].id);
        index
    }

    /// The node of a name.
    pub fn node_named(&self, name: &str) -> Option<usize> {
        self.nodes.get(name, |node| &self.structure.nodes[node as usize].id).map(|node| node as usize)
    }

    /// The names of all nodes that have one.
    pub fn node_names(&self) -> impl Iterator<Item = &str> {
        self.nodes.numbers().map(|node| self.structure.nodes[node as usize].id.as_str())
    }

    /// The nodes since the last call come from the entry at a path, or each from its own in the list there.
    pub fn place_nodes(&mut self, path: impl Into<Arc<str>>, is_list: bool) {
        let end = self.structure.nodes.len();
        if self.places.nodes.last().map_or(0, |place| place.end) < end {
            self.places.nodes.push(NodePlace { end, path: path.into(), is_list });
        }
    }

    /// The id of a node.
    pub fn node_id(&self, node: usize) -> &str {
        &self.structure.nodes[node].id
    }

    /// Adds the nodes of the file, which stand at the path `within`.
    pub fn add_nodes(&mut self, nodes: Option<Cursor<'d>>, within: &str) {
        let entries = nodes.and_then(Cursor::each_entry);
        self.listed_nodes = nodes;
        self.nodes_are_unknown = nodes.is_some() && entries.is_none();
        if let Some(entries) = entries {
            let count = entries.size_hint().1.unwrap_or_default();
            self.structure.nodes.reserve_exact(count);
            self.nodes = NameTable::with_capacity(count);
            for entry in entries {
                self.register(entry.key_place(), entry.name(), NODE);
                // A node without a usable place stays known, with a place that no geometric check complains about.
                let position = entry.value().vector().unwrap_or([f64::NAN; 3]);
                self.add_node(entry.name().to_owned(), position);
            }
        }
        self.place_nodes(within, true);
    }

    /// The elements of a bar with their places along it.
    pub fn stretches(&self, bar: usize) -> Vec<Stretch> {
        let structure = &self.structure;
        let mut from = 0.0;
        let stretch = |element: usize| {
            let nodes = &structure.elements[element].nodes;
            let [a, b] = [0, 1].map(|end| structure.nodes[nodes[end]].position);
            let length = distance(a, b);
            let stretch = Stretch { element, from, length, direction: way(a, b).map(|d| d / length) };
            from += length;
            stretch
        };
        structure.bars[bar].elements.clone().map(stretch).collect()
    }

    /// The local axes of an element of a bar, which has a length and, in space, an orientation across it.
    pub fn bar_axes(&self, stretch: &Stretch) -> Option<BarAxes> {
        let element = &self.structure.elements[stretch.element];
        match element.kind {
            ElementKind::SpaceFrame { orientation, .. } | ElementKind::SpaceTruss { orientation, .. } => {
                let ends = [0, 1].map(|end| self.structure.nodes[element.nodes[end]].position);
                BarAxes::in_space(ends, orientation).ok()
            }
            _ => {
                let [cos, sin, _] = stretch.direction;
                let (x, y) = ([cos, sin, 0.0], [-sin, cos, 0.0]);
                Some(BarAxes { length: stretch.length, x, y, z: [0.0, 0.0, 1.0] })
            }
        }
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

    /// Whether a superelement knows nothing of a displacement of this node.
    pub fn lacks(&self, node: usize, component: Component) -> bool {
        let knows = |element: &Superelement| element.dofs.contains(&(node, component));
        self.structure.superelement.as_ref().is_some_and(|element| !knows(element)) && !self.body_of.contains_key(&node)
    }

    /// Reports a displacement along one of the axes asked of a node of a superelement that has none.
    pub fn demand_displacement(&self, cursor: Cursor<'d>, node: usize, direction: [f64; 3], what: &str) -> bool {
        let mut asked = Component::TRANSLATIONS.into_iter().zip(direction);
        let Some((component, _)) = asked.find(|(c, amount)| *amount != 0.0 && self.lacks(node, *c)) else {
            return true;
        };
        let word = self.structure.dimension.word(component);
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
}

/// The entries of a list that may be left out.
pub fn entries<'d>(fields: &Fields<'d>, key: &str) -> Vec<Cursor<'d>> {
    fields.optional(key).and_then(Cursor::list).map(Iterator::collect).unwrap_or_default()
}

/// The index of the material that `material` names.
pub fn material_of<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<usize> {
    let cursor = fields.required("material")?;
    let name = cursor.string()?;
    let index = builder.materials.get(name).copied();
    if index.is_none() {
        let mut known: Vec<&str> = builder.materials.keys().copied().collect();
        known.sort_unstable();
        cursor.unknown("material", name, &known);
    }
    index
}

/// The `id` of an entry, made known.
pub fn id_of<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>, kind: &'static str) -> Option<&'d str> {
    let cursor = fields.required("id")?;
    let id = cursor.string()?;
    builder.register(cursor.place(), id, kind);
    Some(id)
}
