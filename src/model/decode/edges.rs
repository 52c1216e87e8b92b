//! Edges with a name of their own: chains of the sides of triangles and quads.

use super::builder::Builder;
use super::reader::{Cursor, Entry, Fields};
use crate::model::edge::{ChainError, Edge, Sides};

/// Reads `edges`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let entries = fields.optional("edges").and_then(Cursor::entries).unwrap_or_default();
    if entries.is_empty() {
        return;
    }
    let sides = Sides::of(&builder.structure.elements);
    for entry in entries {
        builder.register(entry.key_place(), entry.name(), "edge");
        match edge(builder, entry, &sides) {
            Some(edge) => {
                builder.edges.entry(entry.name()).or_insert(edge);
            }
            None => {
                builder.broken.insert(entry.name());
            }
        }
    }
}

fn edge<'d>(builder: &Builder<'d>, entry: Entry<'d>, sides: &Sides) -> Option<Edge> {
    let cursor = entry.value();
    let nodes: Vec<Option<usize>> = cursor.list()?.map(|node| builder.node(node)).collect();
    let nodes: Vec<usize> = nodes.into_iter().collect::<Option<_>>()?;
    let id = |node: usize| builder.node_id(node);
    // A node in the middle of a quadratic side, and the corner of that side that is named beside it.
    let half = |[a, b]: [usize; 2]| {
        let of = |middle: usize, corner: usize| sides.with_middle(middle).filter(|ends| ends.contains(&corner));
        of(a, b).map(|ends| (a, ends)).or_else(|| of(b, a).map(|ends| (b, ends)))
    };
    let (message, help) = match sides.chain(&nodes) {
        Ok(edge) => return Some(edge),
        // Elements that could not be read are reported where they stand.
        Err(_) if !builder.elements_complete => return None,
        Err(ChainError::TooShort) => (
            format!("an edge needs two or more nodes, found {}", nodes.len()),
            "name the corners along the edge in order",
        ),
        Err(ChainError::NoSide([a, b])) => match half([a, b]) {
            Some((middle, [from, to])) => (
                format!(
                    "half a quadratic edge: \"{}\" is in the middle of the side from \"{}\" to \"{}\"",
                    id(middle),
                    id(from),
                    id(to)
                ),
                "begin and end the edge at corners: name both of the side",
            ),
            None => (
                format!("no triangle, quad or plate has a side from \"{}\" to \"{}\"", id(a), id(b)),
                "name every corner along the edge in order: neighbours are the two ends of one element side",
            ),
        },
        Err(ChainError::Inside([a, b])) => (
            format!("two elements share the side from \"{}\" to \"{}\": it lies inside a body", id(a), id(b)),
            "an edge is on the outside; to cut a body give each part its own nodes",
        ),
        Err(ChainError::Turns(node)) => (
            format!("the body changes from one side of the edge to the other at \"{}\"", id(node)),
            "split the edge there",
        ),
    };
    cursor.problem(message, help);
    None
}
