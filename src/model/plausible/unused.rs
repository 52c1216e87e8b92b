//! Parameters, materials and sections that nothing uses.

use std::collections::HashSet;

use super::{Warning, keys};
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;
use crate::model::tree::{Kind, Node};

/// Parameters that can be set and stand in no number of the model. A formula that nothing uses is there to be shown.
pub fn parameters(scenario: &Scenario) -> Vec<Warning> {
    let free = scenario.parameters.iter().filter(|(name, of)| of.formula.is_none() && !scenario.uses.is_used(name));
    free.map(|(name, _)| {
        let in_formulas: Vec<&str> = scenario
            .parameters
            .iter()
            .filter(|(_, of)| of.formula.as_ref().is_some_and(|formula| formula.parameters().any(|p| p == name)))
            .map(|(formula, _)| formula.as_str())
            .collect();
        let message = match in_formulas[..] {
            [] => format!("nothing uses the parameter `{name}`"),
            _ => format!(
                "the parameter `{name}` stands only in {}, which no number of the model uses",
                in_formulas.join(", ")
            ),
        };
        Warning::new(
            format!("parameters.{name}"),
            message,
            format!("put \"{name}\" where its number is meant, or remove it"),
        )
    })
    .collect()
}

/// Materials without an element, sections without a bar.
pub fn materials_and_sections(structure: &Structure, file: Node<'_>) -> Vec<Warning> {
    let used: HashSet<usize> = structure.elements.iter().map(|element| element.material).collect();
    let materials = keys(file, "materials").enumerate().filter(|(index, _)| !used.contains(index));
    let materials = materials.map(|(_, name)| ("materials", "element", "material", name));
    let mut named = HashSet::new();
    sections_of(file, &mut named);
    let sections = keys(file, "sections").filter(|name| !named.contains(name));
    let sections = sections.map(|name| ("sections", "bar", "section", name));
    materials
        .chain(sections)
        .map(|(key, part, what, name)| {
            Warning::new(
                format!("{key}.{name}"),
                format!("no {part} has the {what} `{name}`"),
                format!("name it as the `{what}` of one, or remove it"),
            )
        })
        .collect()
}

/// The texts under keys `section`, wherever they stand: bars and groups of meshes have them.
fn sections_of<'v>(value: Node<'v>, found: &mut HashSet<&'v str>) {
    match value.kind() {
        Kind::Array => value.items().for_each(|value| sections_of(value, found)),
        Kind::Object => {
            found.extend(value.get("section").and_then(Node::as_str));
            value.properties().for_each(|(_, value)| sections_of(value, found));
        }
        _ => {}
    }
}
