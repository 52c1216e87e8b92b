//! Ties: nodes that share displacements.

use std::collections::HashMap;

use super::builder::{Builder, entries};
use super::reader::{Cursor, Fields};
use super::supports::components;
use crate::model::structure::Tie;

/// Reads `ties`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    for cursor in entries(fields, "ties") {
        builder.structure.ties.extend(tie(builder, cursor));
    }
}

fn tie<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Tie> {
    let fields = cursor.fields(&["nodes", "at", "fixed"])?;
    let nodes = match (fields.optional("nodes"), fields.entry("at")) {
        (Some(_), Some(at)) => {
            at.key_problem("`at` cannot stand beside `nodes`", "give the nodes, or an edge whose nodes are all tied");
            None
        }
        (None, Some(at)) => builder.edge_nodes_at(at.value()),
        (nodes, None) => {
            let nodes = nodes.or_else(|| fields.required("nodes"));
            nodes.and_then(|at| tied_nodes(builder, at))
        }
    };
    let nodes = nodes.filter(|nodes| !ties_a_body(builder, cursor, nodes));
    let components = match (fields.optional("fixed"), &nodes) {
        (Some(fixed), nodes) => components(builder, fixed, nodes.as_deref().unwrap_or(&[]), "tied"),
        (None, _) => Some(builder.structure.dimension.translations().to_vec()),
    };
    Some(Tie { nodes: nodes?, components: components? })
}

/// Reports two nodes of one rigid body.
fn ties_a_body<'d>(builder: &Builder<'d>, cursor: Cursor<'d>, nodes: &[usize]) -> bool {
    let mut seen = HashMap::new();
    for &node in nodes {
        let Some(&body) = builder.body_of.get(&node) else { continue };
        if let Some(other) = seen.insert(body, node) {
            cursor.problem(
                format!(
                    "the nodes \"{}\" and \"{}\" of this tie belong to one rigid body, \"{}\": they move as one already",
                    builder.node_id(other),
                    builder.node_id(node),
                    builder.structure.rigid[body].id
                ),
                "keep one node of the body in the tie",
            );
            return true;
        }
    }
    false
}

fn tied_nodes<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<usize>> {
    let mut nodes = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        match builder.node(entry) {
            Some(node) if nodes.contains(&node) => {
                entry.problem(
                    format!("the node \"{}\" is in this tie twice", builder.node_id(node)),
                    "name each node once",
                );
                is_right = false;
            }
            Some(node) => nodes.push(node),
            None => is_right = false,
        }
    }
    if is_right && nodes.len() < 2 {
        cursor.problem(
            format!("a tie needs two or more nodes, found {}", nodes.len()),
            "name the nodes that move together",
        );
        return None;
    }
    is_right.then_some(nodes)
}
