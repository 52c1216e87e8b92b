//! Ties, supports and springs.

use std::collections::{HashMap, HashSet};

use super::elements::entries;
use super::reader::{Cursor, Fields};
use super::structure::{Builder, Settlement};
use crate::model::structure::{Component, Spring, Support, Tie};
use crate::model::uses::Region;

/// Reads all three lists.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    for (index, cursor) in entries(fields, "ties").into_iter().enumerate() {
        if let Some(tie) = tie(builder, cursor) {
            builder.structure.ties.push(tie);
            builder.places.ties.push(format!("ties[{index}]").into());
        }
    }
    let mut held = HashSet::new();
    for (index, cursor) in entries(fields, "supports").into_iter().enumerate() {
        let place: std::sync::Arc<str> = format!("supports[{index}]").into();
        for (support, settlement) in support(builder, cursor).unwrap_or_default() {
            if let Some((case, value)) = settlement {
                builder.settlements.push(Settlement { case, node: support.node, component: support.component, value });
            }
            // Two edges share their corner: held twice is held.
            if held.insert((support.node, support.component)) {
                builder.structure.supports.push(support);
                builder.places.supports.push(place.clone());
            }
        }
    }
    for cursor in entries(fields, "springs") {
        let springs = springs(builder, cursor).unwrap_or_default();
        builder.structure.springs.extend(springs);
    }
}

/// The components in `fixed`; a rotation must exist at every one of the nodes.
fn components<'d>(builder: &Builder<'d>, cursor: Cursor<'d>, nodes: &[usize], verb: &str) -> Option<Vec<Component>> {
    let mut components = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        let Some(component) = entry.choice(&Component::WORDS) else {
            is_right = false;
            continue;
        };
        if component == Component::R {
            let what = format!("\"r\" cannot be {verb} there");
            is_right &= nodes.iter().all(|&node| builder.demand_rotation(entry, node, &what));
        }
        let direction = [component == Component::X, component == Component::Y].map(f64::from);
        let what = format!("it cannot be {verb} there");
        is_right &= nodes.iter().all(|&node| builder.demand_displacement(entry, node, direction, &what));
        if !components.contains(&component) {
            components.push(component);
        }
    }
    if components.is_empty() && is_right {
        cursor.problem("`fixed` is empty", "name any of \"x\", \"y\", \"r\", or remove the entry");
        return None;
    }
    is_right.then_some(components)
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
        (None, _) => Some(vec![Component::X, Component::Y]),
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

/// A support of one component, with the case and the amount of its settlement.
type Held<'d> = (Support, Option<(Cursor<'d>, f64)>);

fn support<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Held<'d>>> {
    let fields = cursor.fields(&["at", "fixed", "settlement", "case"])?;
    let nodes = fields.required("at").and_then(|at| builder.nodes_at(at));
    let components =
        fields.required("fixed").and_then(|fixed| components(builder, fixed, nodes.as_deref().unwrap_or(&[]), "fixed"));
    let settlement = settlement(&fields, components.as_deref());
    let (components, settlement) = (components?, settlement?);
    let supports = nodes?.into_iter().flat_map(|node| {
        let hold = |&component: &Component| {
            let moved = settlement.map(|(case, amounts)| (case, amounts[component as usize]));
            (Support { node, component }, moved)
        };
        components.iter().map(hold).collect::<Vec<_>>()
    });
    Some(supports.collect())
}

/// The load case and the amounts [u_x, u_y, r] of a settlement. The outer `None`: something was reported.
#[allow(clippy::option_option)]
fn settlement<'d>(fields: &Fields<'d>, components: Option<&[Component]>) -> Option<Option<(Cursor<'d>, [f64; 3])>> {
    if fields.entry("settlement").is_none() && fields.entry("case").is_none() {
        return Some(None);
    }
    let case = fields.required("case").filter(|case| case.string().is_some());
    let at = fields.required("settlement")?.of(Region::Amount);
    let entries: Vec<Cursor<'d>> = at.list()?.collect();
    if !(2..=3).contains(&entries.len()) {
        at.problem(
            format!("expected [ux, uy] or [ux, uy, r], found {}", at.found()),
            "give the displacements along x and y, and the rotation where it is held",
        );
        return None;
    }
    let mut amounts = [0.0; 3];
    let mut is_right = true;
    for (k, (entry, (word, component))) in entries.into_iter().zip(Component::WORDS).enumerate() {
        match entry.number() {
            Some(amount) if amount != 0.0 && components.is_some_and(|held| !held.contains(&component)) => {
                entry.problem(
                    format!("the support does not hold \"{word}\", so it cannot settle there"),
                    format!("write 0, or add \"{word}\" to `fixed`"),
                );
                is_right = false;
            }
            Some(amount) => amounts[k] = amount,
            None => is_right = false,
        }
    }
    let case = case?;
    is_right.then_some(Some((case, amounts)))
}

fn springs<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Spring>> {
    let fields = cursor.fields(&["at", "between", "direction", "stiffness", "rotation"])?;
    let ends = spring_ends(builder, &fields);
    let amount = |at: Cursor<'d>, what: &str| at.number_that(what, "0 or more", |value| value >= 0.0);
    if let Some(entry) = fields.entry("rotation") {
        if fields.entry("direction").is_some() || fields.entry("stiffness").is_some() {
            entry.key_problem(
                "`rotation` cannot stand beside `direction` and `stiffness`",
                "it is the moment per rotation: give a second spring for the displacement",
            );
            return None;
        }
        let stiffness = amount(entry.value(), "rotation");
        let (ends, stiffness) = (ends?, stiffness?);
        let turn = |node: usize| builder.demand_rotation(entry.value(), node, "no `rotation` spring can act there");
        let is_right = ends.iter().all(|&(node, other)| turn(node) && other.is_none_or(turn));
        let spring = |(node, other): (usize, Option<usize>)| Spring::rotational(node, other, stiffness);
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
