//! The source *structure*: reads its parts in the order in which they refer to each other, resolves names.

use std::path::Path;

use super::builder::{Builder, entries};
use super::reader::{Cursor, Fields};
use super::{contacts, edges, elements, foundations, loads, rigid, springs, superelement, supports, ties};
use crate::model::scenario::Places;
use crate::model::space_section::EndJoint;
use crate::model::structure::{Dimension, ElementKind, Structure};

/// Elements, and what they are made of: in their place a superelement may stand.
pub const ELEMENTS: [&str; 9] =
    ["materials", "sections", "nodes", "bars", "plates", "bricks", "meshes", "triangles", "quads"];

/// What needs elements, besides what they are made of.
const OF_ELEMENTS: [&str; 2] = ["edges", "foundations"];

/// What lies in the plane only.
const OF_PLANE: [&str; 4] = ["plates", "triangles", "quads", "edges"];

/// What links and holds nodes: its key and its reader. Each is read after those before it, which it may name.
const HOLDERS: [(&str, Reader); 5] = [
    ("edges", edges::read),
    ("rigid", rigid::read),
    ("ties", ties::read),
    ("supports", supports::read),
    ("springs", springs::read),
];

type Reader = for<'d> fn(&mut Builder<'d>, &Fields<'d>);

/// The keys of a structure.
pub fn keys() -> impl Iterator<Item = &'static str> {
    let holders = HOLDERS.map(|(key, _)| key);
    ["superelement"].into_iter().chain(ELEMENTS).chain(holders).chain(["foundations", "contacts", "loads"])
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
    match fields.cursor().dimension() {
        Dimension::Plane => fields.refuse(
            &["bricks"],
            |_| "`bricks` are solids: they stand in space".into(),
            "add \"dimension\": 3, and give every point and vector its z",
        ),
        Dimension::Space => fields.refuse(
            &OF_PLANE,
            |key| format!("`{key}` lie in the plane, and this structure stands in space"),
            "use `bars` and `bricks`; shells come through `superelement`",
        ),
    }
    let mut builder = Builder::default();
    builder.structure.dimension = fields.cursor().dimension();
    match fields.optional("superelement") {
        Some(at) => {
            refuse_elements(fields);
            superelement::read(&mut builder, at, path)?
        }
        None => {
            builder.add_nodes(fields.optional("nodes"), "nodes");
            elements::read(&mut builder, fields)?;
        }
    }
    builder.elements_complete = fields.cursor().problems_so_far() == before;
    find_rotations(&mut builder);
    HOLDERS.iter().for_each(|(_, read)| read(&mut builder, fields));
    release_torsion(&mut builder.structure);
    contacts::read(&mut builder, fields)?;
    foundations::read(&mut builder, fields);
    loads::read(&mut builder, fields);
    if builder.elements_complete {
        report_loose_nodes(&builder, fields);
    }
    Some(Found { structure: builder.structure, places: builder.places, notes: builder.notes })
}

/// Refuses elements, and what needs them, together with a superelement.
fn refuse_elements(fields: &Fields<'_>) {
    let foreign: Vec<&str> = ELEMENTS.into_iter().chain(OF_ELEMENTS).collect();
    fields.refuse(
        &foreign,
        |key| format!("`{key}` cannot stand beside `superelement`: that stands in the place of elements and nodes"),
        "its own nodes are `superelement.nodes`; beside it stand contacts, supports, springs, ties, rigid and loads",
    );
}

/// Finds the nodes that turn; those of rigid bodies are added when these are read.
fn find_rotations(builder: &mut Builder<'_>) {
    builder.has_rotation = vec![false; builder.structure.nodes.len()];
    for &(node, component) in builder.structure.superelement.iter().flat_map(|element| &element.dofs) {
        builder.has_rotation[node] |= component.is_rotation();
    }
    for element in &builder.structure.elements {
        if element.bends() {
            for &node in &element.nodes {
                builder.has_rotation[node] = true;
            }
        }
    }
}

/// Makes ball joints of the hinges in space at nodes whose rotations nothing holds but hinges: see [`EndJoint`].
fn release_torsion(structure: &mut Structure) {
    if structure.dimension == Dimension::Plane {
        return;
    }
    let mut turns = vec![false; structure.nodes.len()];
    for element in &structure.elements {
        for (at, &node) in element.nodes.iter().enumerate() {
            turns[node] |= element.turns_with(at);
        }
    }
    structure.rigid.iter().flat_map(|body| &body.nodes).for_each(|&node| turns[node] = true);
    let supports = structure.supports.iter().map(|support| (support.node, support.component));
    let springs = structure.springs.iter().flat_map(|spring| &spring.terms).map(|term| (term.node, term.component));
    let ties = structure.ties.iter().flat_map(|tie| {
        tie.nodes.iter().flat_map(|&node| tie.components.iter().map(move |&component| (node, component)))
    });
    for (node, component) in supports.chain(springs).chain(ties) {
        turns[node] |= component.is_rotation();
    }
    for element in &mut structure.elements {
        if let ElementKind::SpaceFrame { joints, .. } = &mut element.kind {
            for (joint, &node) in joints.iter_mut().zip(&element.nodes) {
                if *joint == EndJoint::Hinge && !turns[node] {
                    *joint = EndJoint::Ball;
                }
            }
        }
    }
}

/// A node that nothing holds or connects would move freely: reported at its name.
fn report_loose_nodes(builder: &Builder<'_>, fields: &Fields<'_>) {
    let structure = &builder.structure;
    // One that could not be read was told of already.
    let are_written = |key| !entries(fields, key).is_empty();
    if structure.superelement.is_none()
        && structure.elements.is_empty()
        && !are_written("springs")
        && !are_written("rigid")
    {
        let message = match structure.dimension {
            Dimension::Plane => {
                "the structure has no elements: expected bars, plates, meshes, quads, rigid bodies or springs"
            }
            Dimension::Space => "the structure has no elements: expected bars, bricks, meshes, rigid bodies or springs",
        };
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
    // A support that could not be read was told of already: its node is not without one.
    let named = entries(fields, "supports").into_iter().filter_map(|support| support.string_under("at"));
    named.filter_map(|id| builder.node_named(id)).for_each(|node| touched[node] = true);
    let solid = match structure.dimension {
        Dimension::Plane => "quad",
        Dimension::Space => "brick",
    };
    for &node in elements.chain(dofs).chain(rigid).chain(ties).chain(supports).chain(springs) {
        touched[node] = true;
    }
    // The author's nodes come first, one for each key, so places and touched run side by side; generated nodes have
    // elements.
    for (node, place) in builder.listed_nodes.into_iter().flat_map(Cursor::key_places).enumerate() {
        if !touched[node] {
            place.problem(
                format!(
                    "nothing is connected to the node \"{}\": no bar, {solid}, rigid body, tie, spring or support",
                    builder.node_id(node)
                ),
                "connect it or remove it",
            );
        }
    }
}
