//! Load cases: points, tractions and line loads, made nodal where they act on edges.

use super::reader::{Cursor, Entry, Fields};
use super::structure::{Builder, Spot};
use super::words::{ID_RULE, is_id, quoted};
use crate::model::edge::tributary_lengths;
use crate::model::parameter::Number;
use crate::model::structure::{Load, LoadCase};
use crate::model::uses::Region;

const KINDS: [&str; 5] = ["point", "traction", "line", "gravity", "temperature"];

/// Reads `loads`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let entries = fields.optional("loads").and_then(Cursor::entries);
    for entry in entries.unwrap_or_default() {
        check_case_name(entry);
        if let Some(case) = load_case(builder, entry) {
            builder.structure.load_cases.push(case);
        }
    }
}

/// Reports a load case whose name is not a name.
pub fn check_case_name(entry: Entry<'_>) {
    if !is_id(entry.name()) {
        let message = format!("{} cannot name a load case", quoted(entry.name()));
        entry.key_problem(message, ID_RULE);
    }
}

/// `factor` of a load case; 1 without one.
pub fn factor(fields: &Fields<'_>) -> Option<Number> {
    match fields.optional("factor") {
        Some(cursor) => cursor.of(Region::Factor).any_number(),
        None => Some(Number::Value(1.0)),
    }
}

fn load_case<'d>(builder: &Builder<'d>, entry: Entry<'d>) -> Option<LoadCase> {
    let fields = entry.value().fields(&["factor", "items"])?;
    let factor = factor(&fields);
    let mut loads = Vec::new();
    for cursor in fields.required("items")?.of(Region::Amount).list()? {
        // A wrong item was reported; the others are read on.
        loads.extend(item(builder, cursor).unwrap_or_default());
    }
    Some(LoadCase { name: entry.name().to_string(), factor: factor?, loads })
}

fn item<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&KINDS)?;
    let present: Vec<Entry<'d>> = KINDS.iter().filter_map(|kind| fields.entry(kind)).collect();
    let [entry] = present[..] else {
        if present.len() > 1 {
            cursor.problem(
                format!(
                    "a load has one key, found {}",
                    present.iter().map(|entry| format!("`{}`", entry.name())).collect::<Vec<_>>().join(" and ")
                ),
                "write one object for each load",
            );
        } else if cursor.entries()?.is_empty() {
            cursor.problem("the load is empty", "expected { \"point\": … }, { \"traction\": … } or { \"line\": … }");
        }
        return None;
    };
    let value = entry.value();
    match entry.name() {
        "point" => point(builder, value),
        "traction" => traction(builder, value),
        "line" => line(builder, value),
        kind => {
            entry.key_problem(
                format!("`{kind}` loads are not supported yet"),
                "remove it; `point`, `traction` and `line` loads are there",
            );
            None
        }
    }
}

fn point<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["at", "force", "moment"])?;
    let spot = fields.required("at").and_then(|at| builder.spot(at));
    let force = fields.required("force").and_then(Cursor::vector);
    let moment = match fields.optional("moment") {
        Some(cursor) => Some((cursor, cursor.number()?)),
        None => None,
    };
    match spot? {
        Spot::Node(node) => {
            let moment = match moment {
                Some((cursor, moment)) => {
                    builder.demand_rotation(cursor, node, "no `moment` can act there").then_some(moment)?
                }
                None => 0.0,
            };
            Some(vec![Load::Nodal { node, force: force?, moment }])
        }
        Spot::Edge { plate, side } => {
            if let Some((cursor, _)) = moment {
                cursor.problem(
                    "a `moment` cannot act on an edge: its nodes have no rotation",
                    "remove it, or give a couple of forces",
                );
                return None;
            }
            let force = force?;
            let edge = builder.edge_nodes(plate, side);
            let lengths = tributary_lengths(&edge, &builder.structure.nodes);
            let total: f64 = lengths.iter().sum();
            let shares = edge.into_iter().zip(lengths).map(|(node, length)| {
                let share = length / total;
                nodal(node, [force[0] * share, force[1] * share])
            });
            Some(shares.collect())
        }
    }
}

fn traction<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["edge", "value"])?;
    let edge = fields.required("edge").and_then(|at| builder.edge(at));
    let value = fields.required("value").and_then(Cursor::vector);
    let ((plate, side), value) = (edge?, value?);
    let edge = builder.edge_nodes(plate, side);
    let lengths = tributary_lengths(&edge, &builder.structure.nodes);
    let shares =
        edge.into_iter().zip(lengths).map(|(node, length)| nodal(node, [value[0] * length, value[1] * length]));
    Some(shares.collect())
}

fn nodal(node: usize, force: [f64; 2]) -> Load {
    Load::Nodal { node, force, moment: 0.0 }
}

fn line<'d>(builder: &Builder<'d>, cursor: Cursor<'d>) -> Option<Vec<Load>> {
    let fields = cursor.fields(&["bar", "value"])?;
    let value = fields.required("value").and_then(Cursor::vector);
    let at = fields.required("bar")?;
    let name = at.string()?;
    let Some(&bar) = builder.bars.get(name) else {
        if !builder.broken.contains(name) {
            let mut known: Vec<&str> = builder.bars.keys().copied().collect();
            known.sort_unstable();
            at.unknown("bar", name, &known);
        }
        return None;
    };
    let value = value?;
    let elements = builder.structure.bars[bar].elements.clone();
    let length = |element: usize| {
        let ends = &builder.structure.elements[element].nodes;
        let [a, b] = [0, 1].map(|end| builder.structure.nodes[ends[end]].position);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    Some(elements.map(|element| Load::Line { element, range: [0.0, length(element)], value: [value; 2] }).collect())
}
