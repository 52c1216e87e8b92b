//! Triangles and quads given one by one.

use super::builder::{Builder, id_of};
use super::plates::{membrane, modes};
use super::reader::{Cursor, Fields};
use crate::model::structure::{Element, ElementKind};

/// Sines of inner angles up to this count as flat.
const FLAT: f64 = 1e-9;

/// Reads one quad.
pub fn quad<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<(&'d str, Element)> {
    let fields = cursor.fields(&["id", "nodes", "thickness", "material", "plane", "element"])?;
    element(builder, &fields, "quad", |at| at.list_of(4, "the corners counter-clockwise").map(Iterator::collect))
}

/// Reads one triangle, of three nodes or of six.
pub fn triangle<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<(&'d str, Element)> {
    let fields = cursor.fields(&["id", "nodes", "thickness", "material", "plane"])?;
    element(builder, &fields, "triangle", |at| {
        let nodes: Vec<Cursor<'d>> = at.list()?.collect();
        if nodes.len() == 3 || nodes.len() == 6 {
            return Some(nodes);
        }
        at.problem(
            format!("a triangle has 3 or 6 nodes, found {}", nodes.len()),
            "list the corners counter-clockwise, then, of six, the middles of the sides 1-2, 2-3, 3-1",
        );
        None
    })
}

fn element<'d>(
    builder: &mut Builder<'d>,
    fields: &Fields<'d>,
    what: &'static str,
    listed: impl Fn(Cursor<'d>) -> Option<Vec<Cursor<'d>>>,
) -> Option<(&'d str, Element)> {
    let id = id_of(builder, fields, what);
    let common = membrane(builder, fields);
    let nodes = fields.required("nodes").and_then(|at| {
        let nodes: Vec<Option<usize>> = listed(at)?.into_iter().map(|entry| builder.node(entry)).collect();
        let nodes: Vec<usize> = nodes.into_iter().collect::<Option<_>>()?;
        check_nodes(builder, at, &nodes, what).then_some(nodes)
    });
    let incompatible = modes(fields);
    let element = common.zip(nodes).zip(incompatible).map(|(((thickness, material, plane), nodes), incompatible)| {
        Element { nodes, material, kind: ElementKind::Membrane { thickness, plane, incompatible } }
    });
    if element.is_none() {
        builder.broken.extend(id);
    }
    Some((id?, element?))
}

fn check_nodes(builder: &Builder<'_>, cursor: Cursor<'_>, nodes: &[usize], what: &str) -> bool {
    let corners = if nodes.len() == 4 { 4 } else { 3 };
    for (k, node) in nodes.iter().enumerate() {
        if nodes[..k].contains(node) {
            let place = if nodes.len() == corners { "a corner" } else { "in it" };
            let all = if nodes.len() == corners { "corners" } else { "nodes" };
            cursor.problem(
                format!("the node \"{}\" is {place} twice", builder.node_id(*node)),
                format!("a {what} has {} different {all}", ["three", "four", "five", "six"][nodes.len() - 3]),
            );
            return false;
        }
    }
    let at = |k: usize| builder.structure.nodes[nodes[k % corners]].position;
    // Turn at corner k relative to its sides: the sine of the inner angle if counter-clockwise.
    let turns: Vec<f64> = (0..corners)
        .map(|k| {
            let (a, b, c) = (at(k + corners - 1), at(k), at(k + 1));
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            (u[0] * v[1] - u[1] * v[0]) / (u[0].hypot(u[1]) * v[0].hypot(v[1]))
        })
        .collect();
    if turns.iter().all(|turn| *turn < -FLAT) {
        cursor.problem(
            format!("the corners of the {what} run clockwise"),
            "list them counter-clockwise, i.e. in the reverse order",
        );
        return false;
    }
    // A corner at an unknown place gives NaN and was reported there.
    let unknown = nodes.iter().any(|&node| builder.structure.nodes[node].position[0].is_nan());
    if !unknown && !turns.iter().all(|turn| *turn > FLAT) {
        let (message, help) = if corners == 4 {
            (
                "the quad is not convex: a corner is flat, re-entrant, or two sides cross",
                "list the corners counter-clockwise and keep every inner angle below 180°",
            )
        } else {
            ("the triangle has no area: its corners lie on one line", "choose three corners that enclose an area")
        };
        cursor.problem(message, help);
        return false;
    }
    true
}
