//! What is allowed and yet hardly meant: materials no one builds with under the named units, parts that nothing uses,
//! loads that load nothing, ground inside a body, contacts and elements given twice. Warnings, never errors: an odd model is
//! still the author's.

mod loads;
pub mod normals;
mod overlaps;
mod stiffness;
mod twins;
mod units;
mod unused;

use std::ops::Range;

use super::locate::Document;
use super::problem::Problem;
use super::scenario::{Scenario, Source};
use super::tree::{Kind, Node};

/// A warning before its place is known as line and column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// JSON path of what is meant.
    pub path: String,
    /// What is odd.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl Warning {
    /// A warning at a JSON path.
    pub fn new(path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Warning {
        Warning { path: path.into(), message: message.into(), help: help.into() }
    }
}

/// All that is odd in the file itself, under the parameter values of the file.
pub fn warnings(scenario: &Scenario) -> Vec<Warning> {
    let structure = match &scenario.source {
        Source::Structure(structure) => Some(structure),
        Source::ContactSystem(_) | Source::Lcp(_) => None,
    };
    let mut warnings = unused::parameters(scenario);
    // The text was parsed when it was loaded; a matrix is not read once more for nothing.
    let is_asked = structure.is_some() || !scenario.parameters.is_empty();
    if let Some(document) = is_asked.then(|| Document::parse(&scenario.text)).and_then(Result::ok) {
        let file = document.root();
        warnings.extend(units::of_parameters(scenario, file));
        if let Some(structure) = structure {
            warnings.extend(unused::materials_and_sections(structure, file));
            warnings.extend(stiffness::materials(scenario, structure, file));
            warnings.extend(stiffness::weights(scenario, structure, file));
            warnings.extend(stiffness::sections(scenario, structure, file));
            warnings.extend(normals::upside_down(scenario, structure));
            warnings.extend(overlaps::of_contacts(scenario, structure));
            warnings.extend(twins::of_contacts(scenario, structure));
            warnings.extend(twins::of_elements(scenario, structure));
            warnings.extend(loads::of_structure(scenario, structure, file));
        }
    }
    if let Source::ContactSystem(system) = &scenario.source {
        warnings.extend(loads::of_contact_system(scenario, system));
    }
    warnings
}

/// The pairs of each contact of the file.
fn contacts(scenario: &Scenario) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut from = 0;
    scenario.places.pairs.chunk_by(|a, b| a == b).map(move |own| {
        let range = from..from + own.len();
        from = range.end;
        range
    })
}

/// What is said as soon as a scenario is loaded: odd enough to change every answer.
pub fn said_at_load(scenario: &Scenario) -> Vec<String> {
    let Source::Structure(structure) = &scenario.source else { return Vec::new() };
    let told = |Warning { path, message, help }: Warning| format!("{path}: {message}: {help}");
    let contacts = twins::of_contacts(scenario, structure);
    contacts.into_iter().chain(twins::of_elements(scenario, structure)).map(told).collect()
}

/// The warnings in the order of the file, each with its place.
pub fn placed(scenario: &Scenario, warnings: Vec<Warning>) -> Vec<Problem> {
    if warnings.is_empty() {
        return Vec::new();
    }
    let Ok(document) = Document::parse(&scenario.text) else { return Vec::new() };
    let mut placed: Vec<(usize, Problem)> = warnings
        .into_iter()
        .map(|Warning { path, message, help }| {
            let offset = document.offset_of(&path);
            let (line, column) = document.position(offset);
            (offset, Problem { line, column, path: document.path_at(offset), message, help })
        })
        .collect();
    placed.sort_by_key(|(offset, _)| *offset);
    placed.into_iter().map(|(_, problem)| problem).collect()
}

/// Every text in a value, however deep.
fn texts<'v>(value: Node<'v>, found: &mut Vec<&'v str>) {
    match value.kind() {
        Kind::Array => value.items().for_each(|value| texts(value, found)),
        Kind::Object => value.properties().for_each(|(_, value)| texts(value, found)),
        _ => found.extend(value.as_str()),
    }
}

/// The keys of an object of the file, in its order.
fn keys<'v>(file: Node<'v>, key: &str) -> impl Iterator<Item = &'v str> {
    file.get(key).into_iter().flat_map(Node::properties).filter_map(|(name, _)| name.as_str())
}
