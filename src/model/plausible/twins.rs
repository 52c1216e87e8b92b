//! What is given twice: contacts with the same nodes and the same normal once more, elements of a kind with the same nodes.

use std::collections::HashMap;
use std::mem::discriminant;

use super::{Warning, contacts};
use crate::model::locate::Document;
use crate::model::pair::Pair;
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;
use crate::model::tree::Node;

/// Weights and directions carry rounding.
const ALIKE: f64 = 1e-9;

/// Contacts of the file all of whose pairs stand in others before them, one warning for each. Faces that meet may share
/// the nodes of an edge; a guide presses the same node from both sides.
pub fn of_contacts(scenario: &Scenario, structure: &Structure) -> Vec<Warning> {
    let (pairs, places) = (&structure.pairs, &scenario.places.pairs);
    let mut seen: HashMap<Vec<usize>, Vec<usize>> = HashMap::new();
    let mut warnings = Vec::new();
    for own in contacts(scenario) {
        let firsts: Option<Vec<usize>> = own
            .clone()
            .map(|i| {
                let before = seen.get(&nodes(&pairs[i]))?;
                before.iter().copied().find(|&first| is_repeated(&pairs[first], &pairs[i]))
            })
            .collect();
        if let Some(firsts) = firsts {
            let mut ids: Vec<String> =
                firsts.into_iter().map(|first| format!("`{}`", pairs[first].contact())).collect();
            ids.dedup();
            warnings.push(Warning::new(
                places[own.start].to_string(),
                format!(
                    "`{}` has the nodes and the normal of {}: both press at the same place, and nothing says how they \
                     share the force",
                    pairs[own.start].contact(),
                    ids.join(", ")
                ),
                "keep one of them; the two sides of a guide have opposite normals",
            ));
        }
        own.for_each(|i| seen.entry(nodes(&pairs[i])).or_default().push(i));
    }
    warnings
}

/// Bars, triangles and quads that have the nodes of another one of their kind; areas and solids of meshes are told where these
/// are read.
pub fn of_elements(scenario: &Scenario, structure: &Structure) -> Vec<Warning> {
    let named = structure.named_elements.iter().map(|(id, element)| (id.as_str(), *element));
    let bars = structure.bars.iter().flat_map(|bar| bar.elements.clone().map(|element| (bar.id.as_str(), element)));
    let mut seen = HashMap::new();
    let mut twins: Vec<[&str; 2]> = Vec::new();
    for (id, index) in bars.chain(named) {
        let element = &structure.elements[index];
        let mut nodes = element.nodes.clone();
        nodes.sort_unstable();
        let (first, at) = *seen.entry((discriminant(&element.kind), nodes)).or_insert((id, index));
        if at != index && !twins.contains(&[first, id]) {
            twins.push([first, id]);
        }
    }
    if twins.is_empty() {
        return Vec::new();
    }
    let Ok(document) = Document::parse(&scenario.text) else { return Vec::new() };
    let told = |[first, id]: [&str; 2]| {
        let what = match first == id {
            true => format!("`{id}` has two elements with the same nodes"),
            false => format!("`{id}` has the nodes of `{first}`"),
        };
        Warning::new(
            place(document.root(), id),
            format!("{what}: both count, in stiffness and in weight"),
            "remove one of them; if there are two, one of twice the thickness or section says so",
        )
    };
    twins.into_iter().map(told).collect()
}

/// The place of an element with an id of its own, or of the mesh whose bars bear its name.
fn place(file: Node<'_>, id: &str) -> String {
    let mesh = id.split(['.', '#']).next();
    let of = |(key, id): (&'static str, Option<&str>)| {
        let mut items = file.get(key).into_iter().flat_map(Node::items);
        let at = items.position(|item| item.get("id").and_then(Node::as_str) == id)?;
        Some(format!("{key}[{at}]"))
    };
    [("bars", Some(id)), ("triangles", Some(id)), ("quads", Some(id)), ("meshes", mesh)]
        .into_iter()
        .find_map(of)
        .unwrap_or_default()
}

/// The nodes of a pair in order.
fn nodes(pair: &Pair) -> Vec<usize> {
    let mut nodes: Vec<usize> = pair.weights.iter().map(|(node, _)| *node).collect();
    nodes.sort_unstable();
    nodes
}

/// Whether two pairs of the same nodes have the same z_n, perhaps with their sides exchanged.
fn is_repeated(first: &Pair, second: &Pair) -> bool {
    let row = |pair: &Pair, of: usize| {
        let weight: f64 = pair.weights.iter().filter(|(node, _)| *node == of).map(|(_, weight)| weight).sum();
        pair.normal.map(|part| weight * part)
    };
    first.weights.iter().all(|&(node, _)| {
        let [one, other] = [first, second].map(|pair| row(pair, node));
        one.iter().zip(other).all(|(one, other)| (one - other).abs() <= ALIKE)
    })
}
