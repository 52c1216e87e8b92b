//! Springs to the ground and between nodes.

use super::builder::{Builder, entries};
use super::reader::{Cursor, Fields};
use crate::model::structure::{Dimension, Spring};

/// Reads `springs`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    for cursor in entries(fields, "springs") {
        let springs = springs(builder, cursor).unwrap_or_default();
        builder.structure.springs.extend(springs);
    }
}

fn springs<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Spring>> {
    let fields = cursor.fields(&["at", "between", "direction", "stiffness", "rotation"])?;
    let ends = spring_ends(builder, &fields);
    let amount = |at: Cursor<'d>, what: &str| at.number_that(what, "0 or more", |value| value >= 0.0);
    if let Some(entry) = fields.entry("rotation") {
        let is_plane = cursor.dimension() == Dimension::Plane;
        if fields.entry("stiffness").is_some() || is_plane && fields.entry("direction").is_some() {
            entry.key_problem(
                match is_plane {
                    true => "`rotation` cannot stand beside `direction` and `stiffness`",
                    false => "`rotation` cannot stand beside `stiffness`",
                },
                "it is the moment per rotation: give a second spring for the displacement",
            );
            return None;
        }
        let axis = match is_plane {
            true => Some([0.0, 0.0, 1.0]),
            false => fields.required("direction").and_then(|cursor| cursor.direction("direction")),
        };
        let stiffness = amount(entry.value(), "rotation");
        let (ends, stiffness, axis) = (ends?, stiffness?, axis?);
        let turn = |node: usize| builder.demand_rotation(entry.value(), node, "no `rotation` spring can act there");
        let is_right = ends.iter().all(|&(node, other)| turn(node) && other.is_none_or(turn));
        let spring = |(node, other): (usize, Option<usize>)| Spring::about(node, other, axis, stiffness);
        return is_right.then(|| ends.into_iter().map(spring).collect());
    }
    let direction = fields.required("direction").and_then(|cursor| cursor.direction("direction"));
    let stiffness = fields.required("stiffness").and_then(|at| amount(at, "stiffness"));
    let (ends, direction, stiffness) = (ends?, direction?, stiffness?);
    let pulls = |node: usize| builder.demand_displacement(cursor, node, direction, "no spring can pull there");
    let is_right = ends.iter().all(|&(node, other)| pulls(node) && other.is_none_or(pulls));
    is_right.then_some(())?;
    Some(ends.into_iter().map(|(node, other)| Spring::along(node, other, direction, stiffness)).collect())
}

/// The nodes that a spring connects: with the ground (each of an edge), or two with each other.
fn spring_ends<'d>(builder: &Builder<'d>, fields: &Fields<'d>) -> Option<Vec<(usize, Option<usize>)>> {
    let Some(between) = fields.entry("between") else {
        let nodes = fields.required("at").and_then(|at| builder.nodes_at(at))?;
        return Some(nodes.into_iter().map(|node| (node, None)).collect());
    };
    if fields.entry("at").is_some() {
        between.key_problem("`between` cannot stand beside `at`", "name two nodes, or one that is held to the ground");
        return None;
    }
    let entries: Vec<Cursor<'d>> = between.value().list_of(2, "the two nodes")?.collect();
    let nodes = [builder.node(entries[0]), builder.node(entries[1])];
    let [Some(a), Some(b)] = nodes else { return None };
    if a == b {
        between.value().problem(
            format!("the spring connects the node \"{}\" with itself", builder.node_id(a)),
            "name two different nodes",
        );
        return None;
    }
    Some(vec![(a, Some(b))])
}
