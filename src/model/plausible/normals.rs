//! Ground above the structure that stands on it: a footing whose normal points down.

use std::collections::HashMap;

use super::Warning;
use crate::model::groups::Groups;
use crate::model::scenario::Scenario;
use crate::model::structure::{ElementLoad, Load, Structure};
use crate::model::vector::{dot, unit};

/// Directions agree within 60°.
const ALIKE: f64 = 0.5;

/// Contacts with the ground whose normal points the way of the weight, while the whole part they hold lies on the side
/// where the ground would be. One warning for each contact of the file.
pub fn upside_down(scenario: &Scenario, structure: &Structure) -> Vec<Warning> {
    let Some(weight) = weight(structure) else { return Vec::new() };
    let part = parts(structure);
    let mut extents: HashMap<(usize, [u64; 3]), [f64; 2]> = HashMap::new();
    let mut warnings: Vec<Warning> = Vec::new();
    for (pair, place) in structure.pairs.iter().zip(&scenario.places.pairs) {
        let ([(node, _)], n) = (&pair.weights[..], pair.normal) else { continue };
        let told = warnings.last().is_some_and(|last| last.path == **place);
        if told || dot(n, weight) < ALIKE || is_guided(structure, *node, n) {
            continue;
        }
        let along = |node: usize| dot(n, structure.nodes[node].position);
        let [least, largest] = *extents.entry((part[*node], n.map(f64::to_bits))).or_insert_with(|| {
            let all = (0..structure.nodes.len()).filter(|&other| part[other] == part[*node]).map(along);
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
        });
        // Coordinates carry rounding: a level beam lies on no side.
        let level = 1e-9 * (largest.abs() + least.abs());
        if along(*node) >= largest - level && least < largest - level {
            let id = pair.contact();
            warnings.push(Warning::new(
                place.to_string(),
                format!(
                    "the normal {} of `{id}` points down, the way of the loads, and the structure lies above it: \
                     as if the ground lay on top",
                    structure.dimension.in_words(n)
                ),
                "a normal points from the ground to the node, into the structure: turn it round",
            ));
        }
    }
    warnings
}

/// Whether a node is held from the other side too: a guide.
pub fn is_guided(structure: &Structure, node: usize, normal: [f64; 3]) -> bool {
    structure.pairs.iter().any(|other| other.node == node && dot(other.normal, normal) < -ALIKE)
}

/// Whether a direction is that of the weight.
pub fn is_down(structure: &Structure, direction: [f64; 3]) -> bool {
    weight(structure).is_some_and(|weight| dot(direction, weight) >= ALIKE)
}

/// Direction of the sum of all gravity, or else of all forces; `None` without any.
fn weight(structure: &Structure) -> Option<[f64; 3]> {
    let mut sums = [[0.0; 3]; 2];
    for load in structure.load_cases.iter().flat_map(|case| &case.loads) {
        let (kind, force) = match load {
            Load::Nodal { force, .. } => (1, *force),
            Load::Element { load, .. } => match load {
                ElementLoad::Body(value) => (0, *value),
                ElementLoad::Point { force, .. } => (1, *force),
                ElementLoad::Line { range, value } => {
                    (1, [0, 1, 2].map(|axis| 0.5 * (range[1] - range[0]) * (value[0][axis] + value[1][axis])))
                }
                ElementLoad::FreeStrain { .. } => continue,
            },
            Load::Settlement { .. } => continue,
        };
        sums[kind] = std::array::from_fn(|c| sums[kind][c] + force[c]);
    }
    unit(sums[0]).or_else(|| unit(sums[1]))
}

/// A label for each node: the same for nodes that elements, ties and rigid bodies join.
pub fn parts(structure: &Structure) -> Vec<usize> {
    let mut parts = Groups::new(structure.nodes.len());
    let elements = structure.elements.iter().map(|element| &element.nodes);
    let ties = structure.ties.iter().map(|tie| &tie.nodes);
    let rigid = structure.rigid.iter().map(|body| &body.nodes);
    for nodes in elements.chain(ties).chain(rigid) {
        parts.join_all(nodes.iter().copied());
    }
    (0..structure.nodes.len()).map(|node| parts.of(node)).collect()
}
