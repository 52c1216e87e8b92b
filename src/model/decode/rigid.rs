//! Rigid bodies.

use super::builder::{Builder, entries, id_of};
use super::reader::{Cursor, Fields};
use crate::model::structure::RigidBody;

/// Reads `rigid`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    for cursor in entries(fields, "rigid") {
        let Some(body) = body(builder, cursor) else {
            // What depends on it cannot be judged.
            builder.elements_complete = false;
            continue;
        };
        let index = builder.structure.rigid.len();
        for &node in &body.nodes {
            builder.body_of.insert(node, index);
            builder.has_rotation[node] = true;
        }
        builder.structure.rigid.push(body);
    }
}

fn body<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<RigidBody> {
    let fields = cursor.fields(&["id", "nodes", "at", "about"])?;
    let id = id_of(builder, &fields, "rigid body");
    let listed = match (fields.optional("nodes"), fields.entry("at")) {
        (Some(_), Some(at)) => {
            at.key_problem("`at` cannot stand beside `nodes`", "give the nodes, or an edge whose nodes move as one");
            None
        }
        (None, Some(at)) => {
            let nodes = builder.edge_nodes_at(at.value());
            nodes.map(|nodes| nodes.into_iter().map(|node| (node, at.value())).collect())
        }
        (nodes, None) => nodes.or_else(|| fields.required("nodes")).and_then(|at| listed_nodes(builder, at)),
    };
    let about = match fields.optional("about") {
        Some(at) => builder.node(at).map(|node| Some((node, at))),
        None => Some(None),
    };
    let (id, listed, about) = (id?, listed?, about?);
    // The node to which the body refers comes first.
    let mut nodes: Vec<(usize, Cursor<'d>)> = about.into_iter().collect();
    nodes.extend(listed.into_iter().filter(|(node, _)| about.is_none_or(|(first, _)| first != *node)));
    if nodes.len() < 2 {
        cursor.problem(
            format!("the rigid body \"{id}\" needs two or more nodes, found {}", nodes.len()),
            "name the nodes that move as one",
        );
        return None;
    }
    let shared = nodes.iter().find_map(|(node, at)| Some((node, at, *builder.body_of.get(node)?)));
    if let Some((&node, at, other)) = shared {
        at.problem(
            format!(
                "the rigid bodies \"{}\" and \"{id}\" share the node \"{}\"",
                builder.structure.rigid[other].id,
                builder.node_id(node)
            ),
            "make them one body, or give each a node of its own there and tie the two",
        );
        return None;
    }
    Some(RigidBody { id: id.to_owned(), nodes: nodes.into_iter().map(|(node, _)| node).collect() })
}

fn listed_nodes<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<(usize, Cursor<'d>)>> {
    let mut nodes: Vec<(usize, Cursor<'d>)> = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        match builder.node(entry) {
            Some(node) if nodes.iter().any(|(other, _)| *other == node) => {
                entry.problem(
                    format!("the node \"{}\" is in this rigid body twice", builder.node_id(node)),
                    "name each node once",
                );
                is_right = false;
            }
            Some(node) => nodes.push((node, entry)),
            None => is_right = false,
        }
    }
    is_right.then_some(nodes)
}
