//! Contact entries → contact pairs.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::elements::entries;
use super::law::{self, LawKind, NUMBERS, per_pair};
use super::reader::{Cursor, Fields};
use super::structure::{Builder, Spot};
use super::words::nearest;
use crate::model::memory;
use crate::model::pair::{JointDirection, Pair, joints};
use crate::model::parameter::Number;
use crate::model::structure::EdgeContact;

/// The word for the ground in `against`.
const GROUND: &str = "ground";

/// Two edges lie on each other if every node is this near its partner, relative to the length of the edge.
const NEAR: f64 = 1e-6;

/// Reads `contacts`. `None` if their matrix would be too large to go on.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) -> Option<()> {
    let mut sources = Vec::new();
    for (index, cursor) in entries(fields, "contacts").into_iter().enumerate() {
        let Some(pairs) = contact(builder, cursor) else {
            continue;
        };
        let place: Arc<str> = format!("contacts[{index}]").into();
        sources.push((cursor, pairs.len()));
        builder.structure.pairs.extend(pairs);
        builder.places.pairs.resize(builder.structure.pairs.len(), place);
    }
    refuse_too_many(&sources)?;
    report_repeated_joints(builder, &sources);
    Some(())
}

fn contact<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Pair>> {
    let fields = cursor
        .fields(&["id", "node", "edge", "against", "normal", "law", "friction", "cohesion", "gap", "bound", "skip"])?;
    let id = fields.required("id").and_then(|cursor| {
        let id = cursor.string()?;
        builder.register(cursor.place(), id, "contact");
        Some(id)
    });
    let law = match fields.optional("law") {
        Some(cursor) => cursor.choice(&LawKind::WORDS),
        None => Some(LawKind::Coulomb),
    };
    if let Some(law) = law {
        refuse_foreign_numbers(&fields, law);
        if law == LawKind::Bound {
            fields.required("bound");
        }
    }
    let is_edge = fields.entry("edge").is_some();
    let sides = match (fields.optional("node"), fields.entry("edge")) {
        (Some(_), Some(edge)) => {
            edge.key_problem(
                "`edge` cannot stand beside `node`",
                "split the entry: one contact for the node, one for the edge",
            );
            None
        }
        (None, Some(edge)) => edge_sides(builder, &fields, edge.value()),
        (Some(node), None) => node_sides(builder, &fields, node),
        (None, None) => {
            cursor.problem(
                "missing key `node` or `edge`",
                "add \"node\": … for one pair, or \"edge\": … for the pairs of an edge",
            );
            None
        }
    };
    let sides = sides.filter(|sides| !is_within_a_body(builder, cursor, sides));
    let count = sides.as_ref().map(|sides| sides.pairs.len());
    let numbers = law_numbers(&fields, law, count, is_edge);
    let skipped = fields
        .entry("skip")
        .map(|entry| {
            if is_edge {
                skipped(entry.value(), count)
            } else {
                entry.key_problem("`skip` belongs to contacts of an `edge`", "remove it");
                None
            }
        })
        .unwrap_or(Some(HashSet::new()));
    let (id, law, sides, numbers, skipped) = (id?, law?, sides?, numbers?, skipped?);
    let pairs = sides.pairs.iter().enumerate().filter(|(index, _)| !skipped.contains(index)).map(
        |(index, &(node, against))| Pair {
            id: if is_edge { format!("{id}[{index}]") } else { id.to_string() },
            node,
            weights: Pair::of_nodes(node, against),
            normal: sides.normals[index],
            slides_on_ground: false,
            law: law.with(|key| Some(numbers.get(key)?[index].clone())),
        },
    );
    let pairs = pairs.collect();
    if is_edge {
        let nodes = sides.pairs.iter().map(|(node, _)| *node).collect();
        builder.structure.edge_contacts.push(EdgeContact { id: id.to_owned(), nodes });
    }
    Some(pairs)
}

fn is_misspelt_ground(builder: &Builder<'_>, word: &str) -> bool {
    !builder.nodes.contains_key(word) && nearest(word, [GROUND]).is_some()
}

/// The two sides of a contact: (node, against) of each pair, skipped ones included, and its normal.
struct Sides {
    pairs: Vec<(usize, Option<usize>)>,
    normals: Vec<[f64; 2]>,
}

/// Reports a pair whose two nodes move as one.
fn is_within_a_body<'d>(builder: &Builder<'d>, cursor: Cursor<'d>, sides: &Sides) -> bool {
    let body = |node: usize| builder.body_of.get(&node);
    let mut sides = sides.pairs.iter();
    let within = sides.find_map(|&(node, against)| {
        let both = body(node)?;
        (body(against?) == Some(both)).then_some((node, against?, *both))
    });
    let Some((node, against, both)) = within else {
        return false;
    };
    cursor.problem(
        format!(
            "\"{}\" and \"{}\" belong to one rigid body, \"{}\": they move as one and cannot meet",
            builder.node_id(node),
            builder.node_id(against),
            builder.structure.rigid[both].id
        ),
        "remove the contact, or make two bodies",
    );
    true
}

fn node_sides<'d>(builder: &Builder<'d>, fields: &Fields<'d>, at: Cursor<'d>) -> Option<Sides> {
    let node = builder.node(at);
    let normal = fields.required("normal").and_then(|cursor| cursor.direction("normal"));
    let against = fields.required("against").and_then(|cursor| match cursor.string()? {
        GROUND => Some(None),
        word if is_misspelt_ground(builder, word) => {
            cursor.unknown("node", word, &[GROUND]);
            None
        }
        _ => Some(Some((cursor, builder.node(cursor)?))),
    })?;
    let node = node?;
    if let Some((cursor, other)) = against
        && other == node
    {
        cursor.problem(
            format!("the node \"{}\" is in contact with itself", builder.node_id(node)),
            "name two different nodes, or \"ground\"",
        );
        return None;
    }
    Some(Sides { pairs: vec![(node, against.map(|(_, other)| other))], normals: vec![normal?] })
}

fn edge_sides<'d>(builder: &Builder<'d>, fields: &Fields<'d>, at: Cursor<'d>) -> Option<Sides> {
    let edge = builder.edge(at);
    let normal = match fields.optional("normal") {
        Some(cursor) => Some(cursor.direction("normal")?),
        None => None,
    };
    let against = fields.required("against")?;
    let edge = edge?;
    let nodes = &builder.structure.nodes;
    if against.string()? == GROUND {
        let normals = match normal {
            Some(normal) => vec![normal; edge.nodes.len()],
            // Subtracting from 0 turns −0 into 0.
            None => edge.outward_normals(nodes).into_iter().map(|outward| outward.map(|n| 0.0 - n)).collect(),
        };
        // The last node of a closed edge is the first.
        let pairs: Vec<(usize, Option<usize>)> = edge.distinct_nodes().iter().map(|&node| (node, None)).collect();
        return Some(Sides { normals: normals[..pairs.len()].to_vec(), pairs });
    }
    if is_misspelt_ground(builder, against.string()?) {
        against.unknown("edge", against.string()?, &[GROUND]);
        return None;
    }
    let other = match builder.spot(against)? {
        Spot::Edge(edge) => edge,
        Spot::Node(_) => {
            against.problem(
                format!("expected an edge or \"ground\", found the node {}", against.quoted()),
                "an edge meets an edge with as many nodes, or the ground",
            );
            return None;
        }
    };
    if other == edge {
        against.problem(
            format!("the edge {} is in contact with itself", against.quoted()),
            "name two different edges, or \"ground\"",
        );
        return None;
    }
    let reversed = partners(builder, at, against, edge.distinct_nodes(), other.distinct_nodes())?;
    let mut partners = other.distinct_nodes().to_vec();
    let mut normals = match normal {
        Some(normal) => vec![normal; partners.len()],
        None => other.outward_normals(nodes)[..partners.len()].to_vec(),
    };
    if reversed {
        partners.reverse();
        normals.reverse();
    }
    let pairs = edge.distinct_nodes().iter().copied().zip(partners.into_iter().map(Some)).collect();
    Some(Sides { pairs, normals })
}

/// Whether the other edge runs the other way; each of its nodes must be at the place of its partner.
fn partners<'d>(
    builder: &Builder<'d>,
    at: Cursor<'d>,
    against: Cursor<'d>,
    nodes: &[usize],
    others: &[usize],
) -> Option<bool> {
    let mut others = others.to_vec();
    if others.len() != nodes.len() {
        against.problem(
            format!(
                "the edges do not match: {} has {} nodes, {} has {}",
                at.quoted(),
                nodes.len(),
                against.quoted(),
                others.len()
            ),
            "give both plates the same grid lines along the joint",
        );
        return None;
    }
    let place = |node: usize| builder.structure.nodes[node].position;
    let distance = |a: usize, b: usize| {
        let (a, b) = (place(a), place(b));
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    // Edges have at least two nodes.
    let near = NEAR * distance(nodes[0], nodes[nodes.len() - 1]);
    // Of two plates turned towards each other one counts its edge the other way round.
    let mut reversed = false;
    if distance(nodes[0], others[0]) > near && distance(nodes[0], others[others.len() - 1]) <= near {
        others.reverse();
        reversed = true;
    }
    for (&node, &other) in nodes.iter().zip(&others) {
        // A repeated node is the shared corner of two edges of one plate.
        if node == other || distance(node, other) > near {
            let (a, b) = (place(node), place(other));
            against.problem(
                format!(
                    "the edges do not match: \"{}\" is at ({}, {}), its partner \"{}\" at ({}, {})",
                    builder.node_id(node),
                    a[0],
                    a[1],
                    builder.node_id(other),
                    b[0],
                    b[1]
                ),
                "every node must be at the place of its partner; an initial gap is given by `gap`, not by the geometry",
            );
            return None;
        }
    }
    Some(reversed)
}

fn refuse_foreign_numbers(fields: &Fields<'_>, law: LawKind) {
    for (key, laws) in NUMBERS {
        if !law.takes(key) {
            let owners: Vec<&str> = laws.iter().map(|law| law.word()).collect();
            fields.refuse(
                &[key],
                |key| format!("`{key}` does not belong to the law {}, but to {}", law.word(), owners.join(" and ")),
                "remove it, or change `law`",
            );
        }
    }
}

/// The numbers of the law by key, one per pair. Without a known count, or law, they are checked one by one.
fn law_numbers(
    fields: &Fields<'_>,
    law: Option<LawKind>,
    count: Option<usize>,
    is_edge: bool,
) -> Option<HashMap<&'static str, Vec<Number>>> {
    let mut numbers = HashMap::new();
    let mut is_right = true;
    for (key, _) in NUMBERS {
        let Some(cursor) = fields.optional(key) else {
            is_right &= !(key == "bound" && law == Some(LawKind::Bound));
            continue;
        };
        if !law.is_some_and(|law| law.takes(key)) {
            continue;
        }
        let count = match count {
            Some(count) => count,
            None if cursor.is_list() => continue,
            None => 1,
        };
        let values = if is_edge {
            per_pair(cursor, key, count, true)
        } else {
            law::number(cursor, key).map(|number| vec![number])
        };
        match values {
            Some(values) => {
                numbers.insert(key, values);
            }
            None => is_right = false,
        }
    }
    is_right.then_some(numbers)
}

fn skipped(cursor: Cursor<'_>, count: Option<usize>) -> Option<HashSet<usize>> {
    let mut skipped = HashSet::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        let Some(index) = entry.whole("an index in `skip`", 0) else {
            is_right = false;
            continue;
        };
        let Some(count) = count else { continue };
        if index >= count {
            entry.problem(
                format!("the edge has no pair {index}: it has {count} nodes"),
                format!("pairs count from 0 to {}", count - 1),
            );
            is_right = false;
        }
        skipped.insert(index);
    }
    if is_right && count == Some(skipped.len()) {
        cursor.problem("every pair of the edge is skipped", "remove the contact");
        return None;
    }
    is_right.then_some(skipped)
}

fn refuse_too_many(sources: &[(Cursor<'_>, usize)]) -> Option<()> {
    let pairs: usize = sources.iter().map(|(_, count)| count).sum();
    let Some(refusal) = memory::refusal(memory::for_joints(2.0 * pairs as f64)) else {
        return Some(());
    };
    // With a refusal there are pairs, so there is a largest entry.
    let (largest, _) = sources.iter().max_by_key(|(_, count)| *count)?;
    largest.problem(
        format!("the model is too large: with {pairs} contact pairs it {refusal}"),
        "use fewer nodes along the joint, here first",
    );
    None
}

/// Two nodes have two relative displacements; a third joint between them, or two along one line, would make the
/// joints dependent. Reported once for each contact entry.
fn report_repeated_joints(builder: &Builder<'_>, sources: &[(Cursor<'_>, usize)]) {
    let pairs = &builder.structure.pairs;
    let mut entry_of = Vec::with_capacity(pairs.len());
    for (entry, (_, count)) in sources.iter().enumerate() {
        entry_of.resize(entry_of.len() + count, entry);
    }
    let mut reported = HashSet::new();
    // Of each two nodes: the directions that have a joint, and its pair.
    type Directions = Vec<([f64; 2], usize)>;
    let mut taken: HashMap<(usize, Option<usize>), Directions> = HashMap::new();
    // By pair, so that the later entry of the file is the one that repeats.
    let mut all = joints(pairs);
    all.sort_by_key(|joint| joint.pair);
    for joint in all {
        let pair = &pairs[joint.pair];
        let key = match pair.weights[..] {
            [(node, _)] => (node, None),
            [(node, _), (against, _)] => (node.min(against), Some(node.max(against))),
            // Every pair of edges that do not match has a node of its own.
            _ => continue,
        };
        let direction = match joint.direction {
            JointDirection::Normal => pair.normal,
            JointDirection::Tangential => pair.tangent(),
        };
        let earlier = taken.entry(key).or_default();
        let parallel =
            earlier.iter().find(|(other, _)| (direction[0] * other[1] - direction[1] * other[0]).abs() < 1e-9);
        let repeated = match (parallel, &earlier[..]) {
            (Some((_, first)), _) => Some(*first),
            (None, [_, (_, second), ..]) => Some(*second),
            _ => None,
        };
        let entry = entry_of[joint.pair];
        match repeated {
            Some(first) if reported.insert(entry) => {
                let against = match pair.weights.get(1) {
                    Some((against, _)) => format!("\"{}\"", builder.node_id(*against)),
                    None => "the ground".into(),
                };
                sources[entry].0.problem(
                    format!(
                        "the {} joint of \"{}\" repeats a relative displacement that \"{}\" has already (\"{}\" against {against})",
                        match joint.direction {
                            JointDirection::Normal => "normal",
                            JointDirection::Tangential => "tangential",
                        },
                        pair.id,
                        pairs[first].id,
                        builder.node_id(pair.node),
                    ),
                    "remove one of the two, use `skip`, make them `frictionless` with different normals, or split the node",
                );
            }
            Some(_) => {}
            None => earlier.push((direction, joint.pair)),
        }
    }
}
