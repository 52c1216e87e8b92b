//! Load cases: each kind of load in a file of its own, made nodal where it acts on an edge.

mod fluid;
mod gravity;
mod line;
mod point;
mod pressure;
mod strain;
mod temperature;
mod traction;

use super::builder::{Builder, Settlement};
use super::reader::{Cursor, Entry, Fields};
use super::words::{ID_RULE, is_id, quoted};
use crate::model::edge::Edge;
use crate::model::parameter::Number;
use crate::model::structure::{Element, Load, LoadCase};
use crate::model::uses::Region;

/// Reads one kind of load.
type Kind = for<'d> fn(&Builder<'d>, Cursor<'d>) -> Option<Vec<Load>>;

const KINDS: [(&str, Kind); 8] = [
    ("point", point::read),
    ("traction", traction::read),
    ("line", line::read),
    ("gravity", gravity::read),
    ("temperature", temperature::read),
    ("strain", strain::read),
    ("pressure", pressure::read),
    ("fluid", fluid::read),
];

/// Reads `loads`.
pub fn read<'d>(builder: &mut Builder<'d>, fields: &Fields<'d>) {
    let entries = fields.optional("loads").and_then(Cursor::entries);
    for entry in entries.unwrap_or_default() {
        check_case_name(entry);
        if builder.structure.load_cases.iter().any(|case| case.name == entry.name()) {
            entry.key_problem(
                format!("the superelement has a load case \"{}\" already", entry.name()),
                "cases beside those of the superelement have names of their own; factors of `combinations` and `stages` add them up",
            );
            continue;
        }
        if let Some(case) = load_case(builder, entry) {
            builder.structure.load_cases.push(case);
        } else {
            builder.broken.insert(entry.name());
        }
    }
    settle(builder);
}

/// Adds the settlements of the supports to their cases.
fn settle(builder: &mut Builder<'_>) {
    let mut reported: Option<Cursor<'_>> = None;
    for Settlement { case, node, component, value } in std::mem::take(&mut builder.settlements) {
        // A name that is not a string was reported.
        let Some(name) = case.string() else { continue };
        let cases = &mut builder.structure.load_cases;
        if let Some(known) = cases.iter_mut().find(|known| known.name == name) {
            known.loads.push(Load::Settlement { node, component, value });
        } else if !builder.broken.contains(name) && reported.is_none_or(|last| last.value.start() != case.value.start())
        {
            let known: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
            case.unknown("load case", name, &known);
            reported = Some(case);
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
    let words = KINDS.map(|(word, _)| word);
    let fields = cursor.fields(&words)?;
    let present: Vec<(Entry<'d>, Kind)> =
        KINDS.iter().filter_map(|(word, read)| Some((fields.entry(word)?, *read))).collect();
    match &present[..] {
        [(entry, read)] => read(builder, entry.value()),
        [] => {
            if cursor.entries()?.is_empty() {
                let help = format!("expected {{ \"point\": … }} or one of {}", words[1..].join(", "));
                cursor.problem("the load is empty", help);
            }
            None
        }
        _ => {
            let found: Vec<String> = present.iter().map(|(entry, _)| format!("`{}`", entry.name())).collect();
            cursor.problem(
                format!("a load has one key, found {}", found.join(" and ")),
                "write one object for each load",
            );
            None
        }
    }
}

/// Nodal forces as loads.
fn nodal(forces: impl IntoIterator<Item = (usize, [f64; 3])>) -> Vec<Load> {
    forces.into_iter().map(|(node, force)| Load::Nodal { node, force, moment: [0.0; 3] }).collect()
}

/// The bar that a string names.
fn bar<'d>(builder: &Builder<'d>, at: Cursor<'d>) -> Option<usize> {
    let name = at.string()?;
    let bar = builder.bars.get(name).copied();
    if bar.is_none() && !builder.broken.contains(name) {
        let mut known: Vec<&str> = builder.bars.keys().map(|id| &**id).collect();
        known.sort_unstable();
        at.unknown("bar", name, &known);
    }
    bar
}

/// The edge of `edge`; a bar has none.
fn edge<'d>(builder: &Builder<'d>, at: Cursor<'d>, what: &str) -> Option<Edge> {
    if at.string().is_some_and(|name| builder.bars.contains_key(name)) {
        at.problem(
            format!("{} is a bar: {what} acts on an edge", at.quoted()),
            "name the edge of a plate or one of `edges`; for a bar use `line`",
        );
        return None;
    }
    builder.edge(at)
}

/// One number, or two: at the first and at the last place.
fn one_or_two(at: Cursor<'_>) -> Option<[f64; 2]> {
    if !at.is_list() {
        return at.number().map(|value| [value; 2]);
    }
    let values: Vec<Option<f64>> = at.list_of(2, "at the first and at the last place")?.map(Cursor::number).collect();
    Some([values[0]?, values[1]?])
}

/// One vector, or two: at the first and at the last place.
fn one_or_two_vectors(at: Cursor<'_>) -> Option<[[f64; 3]; 2]> {
    let is_pair = at.is_list() && at.list()?.any(Cursor::is_list);
    if !is_pair {
        return at.vector().map(|value| [value; 2]);
    }
    let values: Vec<Option<[f64; 3]>> =
        at.list_of(2, "vectors at the first and at the last place")?.map(Cursor::vector).collect();
    Some([values[0]?, values[1]?])
}

/// A value that varies linearly from the first to the last of two.
fn between<const N: usize>([first, last]: [[f64; N]; 2], share: f64) -> [f64; N] {
    std::array::from_fn(|i| first[i] + share * (last[i] - first[i]))
}

/// The elements of `on`: those of the named bars, plates, triangles and quads, each once; all without the key.
fn elements<'d>(builder: &Builder<'d>, on: Option<Cursor<'d>>) -> Option<Vec<usize>> {
    match on {
        Some(on) => named_elements(builder, on, |_, _| true),
        None => Some((0..builder.structure.elements.len()).collect()),
    }
}

/// The elements named in `on`, each once. `suits` says at the place of a name what is wrong with an element of it.
fn named_elements<'d>(
    builder: &Builder<'d>,
    on: Cursor<'d>,
    suits: impl Fn(Cursor<'d>, &Element) -> bool,
) -> Option<Vec<usize>> {
    let names = on.list()?;
    if names.len() == 0 {
        on.problem("the load is on nothing", "name the elements that it acts on");
        return None;
    }
    let mut elements = Vec::new();
    let mut is_right = true;
    for at in names {
        let Some(found) = builder.elements_of(at) else {
            is_right = false;
            continue;
        };
        is_right &= found.iter().all(|&element| suits(at, &builder.structure.elements[element]));
        elements.extend(found);
    }
    elements.sort_unstable();
    elements.dedup();
    is_right.then_some(elements)
}
