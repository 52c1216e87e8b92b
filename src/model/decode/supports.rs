//! Supports and the displacements imposed on them.

use std::collections::{HashMap, HashSet};

use super::builder::{Builder, Settlement, entries};
use super::reader::{Cursor, Fields};
use crate::model::structure::{Component, Dimension, Support};
use crate::model::uses::Region;

/// Reads `supports`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let mut held = HashSet::new();
    let mut settled: HashMap<(usize, Component, Option<&str>), f64> = HashMap::new();
    for cursor in entries(fields, "supports") {
        for (support, settlement) in support(builder, cursor).unwrap_or_default() {
            if let Some((case, value)) = settlement {
                let place = (support.node, support.component, case.string());
                let known = if value == 0.0 { None } else { settled.insert(place, value) };
                if let Some(known) = known.filter(|known| *known != value) {
                    let node = &builder.structure.nodes[support.node].id;
                    let word = builder.structure.dimension.word(support.component);
                    case.problem(
                        format!("node {node} settles along {word} by {known} and by {value} in the same case"),
                        "give one of the two, or a case of its own to each: the settlements of two cases are added",
                    );
                    return;
                }
                builder.settlements.push(Settlement { case, node: support.node, component: support.component, value });
            }
            // Two edges share their corner: held twice is held.
            if held.insert((support.node, support.component)) {
                builder.structure.supports.push(support);
            }
        }
    }
}

/// The components in `fixed`; a rotation must exist at every one of the nodes.
pub fn components<'d>(
    builder: &Builder<'d>,
    cursor: Cursor<'d>,
    nodes: &[usize],
    verb: &str,
) -> Option<Vec<Component>> {
    let mut components = Vec::new();
    let mut is_right = true;
    for entry in cursor.list()? {
        let Some(component) = entry.component() else {
            is_right = false;
            continue;
        };
        if component.is_rotation() {
            let what = format!("{} cannot be {verb} there", entry.quoted());
            is_right &= nodes.iter().all(|&node| builder.demand_rotation(entry, node, &what));
        }
        let direction = Component::TRANSLATIONS.map(|along| f64::from(along == component));
        let what = format!("it cannot be {verb} there");
        is_right &= nodes.iter().all(|&node| builder.demand_displacement(entry, node, direction, &what));
        if !components.contains(&component) {
            components.push(component);
        }
    }
    if components.is_empty() && is_right {
        cursor.problem(
            "`fixed` is empty",
            format!("name any of {}, or remove the entry", builder.structure.dimension.quoted_words()),
        );
        return None;
    }
    is_right.then_some(components)
}

/// A support of one component, with the case and the amount of its settlement.
type Held<'d> = (Support, Option<(Cursor<'d>, f64)>);

fn support<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Held<'d>>> {
    let fields = cursor.fields(&["at", "fixed", "settlement", "case"])?;
    let nodes = fields.required("at").and_then(|at| builder.nodes_at(at));
    let components =
        fields.required("fixed").and_then(|fixed| components(builder, fixed, nodes.as_deref().unwrap_or(&[]), "fixed"));
    let settlement = settlement(builder, &fields, components.as_deref());
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

/// The load case and the amounts of a settlement by component. The outer `None`: something was reported.
#[allow(clippy::option_option)]
fn settlement<'d>(
    builder: &Builder<'d>,
    fields: &Fields<'d>,
    components: Option<&[Component]>,
) -> Option<Option<(Cursor<'d>, [f64; 6])>> {
    if fields.entry("settlement").is_none() && fields.entry("case").is_none() {
        return Some(None);
    }
    let case = fields.required("case").filter(|case| case.string().is_some());
    let at = fields.required("settlement")?.of(Region::Amount);
    let entries: Vec<Cursor<'d>> = at.list()?.collect();
    let dimension = builder.structure.dimension;
    if ![dimension.translations().len(), dimension.components().len()].contains(&entries.len()) {
        let (expected, help) = match dimension {
            Dimension::Plane => {
                ("[ux, uy] or [ux, uy, r]", "give the displacements along x and y, and the rotation where it is held")
            }
            Dimension::Space => (
                "[ux, uy, uz] or [ux, uy, uz, rx, ry, rz]",
                "give the displacements along x, y and z, and the rotations where they are held",
            ),
        };
        at.problem(format!("expected {expected}, found {}", at.found()), help);
        return None;
    }
    let mut amounts = [0.0; 6];
    let mut is_right = true;
    for (entry, (word, component)) in entries.into_iter().zip(dimension.words()) {
        match entry.number() {
            Some(amount) if amount != 0.0 && components.is_some_and(|held| !held.contains(&component)) => {
                entry.problem(
                    format!("the support does not hold \"{word}\", so it cannot settle there"),
                    format!("write 0, or add \"{word}\" to `fixed`"),
                );
                is_right = false;
            }
            Some(amount) => amounts[component as usize] = amount,
            None => is_right = false,
        }
    }
    let case = case?;
    is_right.then_some(Some((case, amounts)))
}
