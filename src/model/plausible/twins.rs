//! Contacts given twice: the same nodes and the same normal once more.

use std::collections::HashMap;

use super::{Warning, contacts};
use crate::model::pair::Pair;
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;

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
