//! Contact entries → contact pairs.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::builder::{Builder, entries};
use super::face_sides;
use super::law::{self, NUMBERS, per_pair};
use super::reader::{Cursor, Fields};
use super::sides::{self, Sides};
use crate::model::dimension::projection;
use crate::model::memory;
use crate::model::pair::{LawKind, Pair, Weights};
use crate::model::parameter::Number;
use crate::model::structure::{Dimension, EdgeContact};
use crate::model::vector::cross;

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
    Some(())
}

fn contact<'d>(builder: &mut Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Pair>> {
    let border = border(builder);
    let mut keys = vec!["id", "node", border];
    keys.extend(["against", "normal", "law", "friction", "cohesion", "gap", "bound", "skip"]);
    keys.push(if border == "edge" { "method" } else { "tangent" });
    let fields = cursor.fields(&keys)?;
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
    let a_border = if border == "edge" { "an `edge`" } else { "a `face`" };
    let is_border = fields.entry(border).is_some();
    let skipped = match fields.entry("skip") {
        None => Some(Vec::new()),
        Some(entry) if is_border => indices(entry.value()),
        Some(entry) => {
            entry.key_problem(format!("`skip` belongs to contacts of {a_border}"), "remove it");
            None
        }
    };
    let out: HashSet<usize> = skipped.iter().flatten().map(|(_, index)| *index).collect();
    let sides = match (fields.optional("node"), fields.entry(border)) {
        (Some(_), Some(entry)) => {
            entry.key_problem(
                format!("`{border}` cannot stand beside `node`"),
                format!("split the entry: one contact for the node, one for the {border}"),
            );
            None
        }
        (None, Some(face)) if border == "face" => face_sides::of_face(builder, &fields, face.value(), &out),
        (None, Some(edge)) => sides::of_edge(builder, &fields, edge.value(), &out),
        (Some(node), None) => sides::of_node(builder, &fields, node),
        (None, None) => {
            cursor.problem(
                format!("missing key `node` or `{border}`"),
                format!(
                    "add \"node\": … for one pair, or \"{border}\": … for the pairs of {}",
                    a_border.replace('`', "")
                ),
            );
            None
        }
    };
    let sides = sides.map(|sides| sides.without(&out));
    let tangents = match fields.optional("tangent") {
        Some(at) => tangents(at, sides.as_ref()),
        None => sides.as_ref().map(|sides| {
            sides.normals.iter().map(|&normal| builder.structure.dimension.tangents(normal)).collect::<Vec<_>>()
        }),
    };
    let sides = sides.filter(|sides| !is_within_a_body(builder, cursor, sides));
    let sides = sides.filter(|sides| has_its_displacements(builder, cursor, sides, law));
    if !is_border {
        fields.refuse(&["method"], |key| format!("`{key}` belongs to contacts of an `edge`"), "remove it");
    }
    let count = sides.as_ref().map(|sides| sides.nodes.len());
    let numbers = law_numbers(&fields, law, sides.as_ref(), is_border);
    let left = skipped.and_then(|skipped| leaves_pairs(&fields, &skipped, count, border));
    let (id, law, sides, numbers, (), tangents) = (id?, law?, sides?, numbers?, left?, tangents?);
    let pairs = sides.weights.iter().enumerate().filter_map(|(index, weights)| {
        Some(Pair {
            id: if is_border { format!("{id}[{index}]") } else { id.to_string() },
            node: sides.nodes[index],
            place: sides.places.get(&index).cloned().unwrap_or_else(|| vec![(sides.nodes[index], 1.0)]),
            weights: weights.clone()?,
            normal: sides.normals[index],
            tangents: tangents[index].clone(),
            slides_on_ground: false,
            law: law.with(|key| Some(numbers.get(key)?[index].clone())),
        })
    });
    let pairs = pairs.collect();
    if is_border {
        let shares = sides.shares;
        builder.structure.edge_contacts.push(EdgeContact { id: id.to_owned(), nodes: sides.nodes, shares });
    }
    Some(pairs)
}

/// The key of a contact of many pairs: `edge` in the plane, `face` in space.
fn border(builder: &Builder<'_>) -> &'static str {
    if builder.structure.dimension == Dimension::Space { "face" } else { "edge" }
}

/// The two tangents of every pair in space from a vector whose projection on the plane of contact is t1.
fn tangents<'d>(at: Cursor<'d>, sides: Option<&Sides>) -> Option<Vec<Vec<[f64; 3]>>> {
    let wanted = at.direction("tangent")?;
    let sides = sides?;
    let of = |(weights, &normal): (&Option<Weights>, &[f64; 3])| match weights {
        Some(_) => projection(wanted, normal).map(|t| vec![t, cross(normal, t)]),
        None => Some(Vec::new()),
    };
    let found: Option<Vec<_>> = sides.weights.iter().zip(&sides.normals).map(of).collect();
    if found.is_none() {
        at.problem(
            "the tangent points along the normal, so it gives no direction in the plane of contact",
            "give a vector across the normal: t1 is its projection on the plane of contact",
        );
    }
    found
}

/// Reports a node of a superelement without a displacement that a joint needs.
fn has_its_displacements<'d>(builder: &Builder<'d>, cursor: Cursor<'d>, sides: &Sides, law: Option<LawKind>) -> bool {
    std::iter::zip(&sides.weights, &sides.normals).all(|(weights, &normal)| {
        weights.iter().flatten().all(|&(node, _)| {
            let along = |tangent| builder.demand_displacement(cursor, node, tangent, "the tangential joint needs it");
            builder.demand_displacement(cursor, node, normal, "the normal joint needs it")
                && (law == Some(LawKind::Frictionless)
                    || builder.structure.dimension.tangents(normal).into_iter().all(along))
        })
    })
}

/// Reports a pair whose nodes move as one.
fn is_within_a_body<'d>(builder: &Builder<'d>, cursor: Cursor<'d>, sides: &Sides) -> bool {
    let body = |node: usize| builder.body_of.get(&node).copied();
    let within = sides.weights.iter().flatten().find_map(|weights| {
        let [(node, _), others @ ..] = &weights[..] else { return None };
        let both = body(*node)?;
        let (against, _) = others.first()?;
        others.iter().all(|(other, _)| body(*other) == Some(both)).then_some((*node, *against, both))
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
    sides: Option<&Sides>,
    is_border: bool,
) -> Option<HashMap<&'static str, Vec<Number>>> {
    let count = sides.map(|sides| sides.nodes.len());
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
        let values = if key == "gap" && sides::is_geometry(cursor) {
            // Without sides there is nothing to measure, and that was reported.
            sides.and_then(|sides| geometry(cursor, sides))
        } else if is_border {
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

/// The gaps as the two sides are drawn; 0 where there is no pair.
fn geometry(cursor: Cursor<'_>, sides: &Sides) -> Option<Vec<Number>> {
    if sides.gaps.is_none() {
        cursor.problem("there is no distance to the ground in the geometry", "give the gap as a number");
    }
    Some(sides.gaps.as_ref()?.iter().map(|gap| Number::Value(*gap)).collect())
}

/// The entries of `skip`.
fn indices<'d>(cursor: Cursor<'d>) -> Option<Vec<(Cursor<'d>, usize)>> {
    let index = |entry: Cursor<'d>| Some((entry, entry.whole("an index in `skip`", 0)?));
    // All of them are read before one ends it: each that is wrong is reported.
    let found: Vec<_> = cursor.list()?.map(index).collect();
    found.into_iter().collect()
}

/// Checks that what is skipped is there, and not all.
fn leaves_pairs(
    fields: &Fields<'_>,
    skipped: &[(Cursor<'_>, usize)],
    count: Option<usize>,
    border: &str,
) -> Option<()> {
    let Some(count) = count else { return Some(()) };
    let beyond: Vec<_> = skipped.iter().filter(|(_, index)| *index >= count).collect();
    for (entry, index) in &beyond {
        entry.problem(
            format!("the {border} has no pair {index}: it has {count} nodes"),
            format!("pairs count from 0 to {}", count - 1),
        );
    }
    let out: HashSet<usize> = skipped.iter().map(|(_, index)| *index).collect();
    if beyond.is_empty() && out.len() == count {
        fields.required("skip")?.problem(format!("every pair of the {border} is skipped"), "remove the contact");
        return None;
    }
    beyond.is_empty().then_some(())
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
