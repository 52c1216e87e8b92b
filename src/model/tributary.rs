//! The length of edge or the area of face that stands for each contact pair: what its nodal forces are spread over.

use std::collections::HashSet;

use super::structure::Structure;
use super::vector::{length, way};

/// For each pair of the structure the integral of its node's shape function along the edge or bar, or over the face, it
/// lies on: half of the sides beside it, on quadratic sides 1/6, 4/6, 1/6 of their length. `None` for a pair of single
/// nodes, and on an edge whose last node may be joined to its first.
pub fn tributary_lengths(structure: &Structure) -> Vec<Option<f64>> {
    let middles: HashSet<usize> = structure
        .elements
        .iter()
        .flat_map(|element| element.nodes.iter().skip(element.shape().corners()).copied())
        .collect();
    let mut lengths = vec![None; structure.pairs.len()];
    for (joint, pairs) in joints(structure) {
        let edge = structure.edge_contacts.iter().find(|edge| edge.id == joint);
        if let Some(known) = edge.filter(|edge| !edge.shares.is_empty()) {
            let share = |index: usize| Some(known.shares[index]).filter(|share| *share > 0.0);
            pairs.iter().for_each(|&(pair, index)| lengths[pair] = share(index));
            continue;
        }
        let nodes: Vec<usize> = match edge {
            Some(edge) => edge.nodes.clone(),
            None => pairs.iter().map(|&(pair, _)| structure.pairs[pair].node).collect(),
        };
        if nodes.len() < 2 || may_be_closed(structure, &nodes) {
            continue;
        }
        let shares = shares(structure, &nodes, &middles);
        for (place, &(pair, index)) in pairs.iter().enumerate() {
            let at = if edge.is_some() { index } else { place };
            lengths[pair] = shares.get(at).copied().filter(|length| *length > 0.0);
        }
    }
    lengths
}

/// Pairs `joint[k]` by joint: (index of the pair, k).
fn joints(structure: &Structure) -> Vec<(&str, Vec<(usize, usize)>)> {
    let mut joints: Vec<(&str, Vec<(usize, usize)>)> = Vec::new();
    for (pair, of) in structure.pairs.iter().enumerate() {
        let Some((joint, rest)) = of.id.split_once('[') else { continue };
        let Some(index) = rest.strip_suffix(']').and_then(|digits| digits.parse().ok()) else { continue };
        match joints.last_mut().filter(|(last, _)| *last == joint) {
            Some((_, pairs)) => pairs.push((pair, index)),
            None => joints.push((joint, vec![(pair, index)])),
        }
    }
    joints
}

/// Whether an element has a side from the last node to the first: then the way round may be closed.
fn may_be_closed(structure: &Structure, nodes: &[usize]) -> bool {
    let [first, .., last] = nodes else { return false };
    let joins = |[a, b]: [usize; 2]| [a, b] == [*first, *last] || [b, a] == [*first, *last];
    nodes.len() > 3 && structure.elements.iter().any(|element| element.sides().any(joins))
}

fn shares(structure: &Structure, nodes: &[usize], middles: &HashSet<usize>) -> Vec<f64> {
    let distance = |a: usize, b: usize| {
        let [p, q] = [a, b].map(|at| structure.nodes[nodes[at]].position);
        length(way(p, q))
    };
    let mut shares = vec![0.0; nodes.len()];
    let mut at = 0;
    while at + 1 < nodes.len() {
        let parts: &[f64] = match at + 2 < nodes.len() && middles.contains(&nodes[at + 1]) {
            true => &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0],
            false => &[0.5, 0.5],
        };
        let end = at + parts.len() - 1;
        let length: f64 = (at..end).map(|k| distance(k, k + 1)).sum();
        for (k, part) in parts.iter().enumerate() {
            shares[at + k] += part * length;
        }
        at = end;
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::load::load_text;
    use crate::model::scenario::Source;

    fn lengths(text: &str) -> Vec<Option<f64>> {
        match load_text("t", text, None).unwrap_or_else(|problems| panic!("{problems}")).source {
            Source::Structure(structure) => tributary_lengths(&structure),
            _ => panic!("no structure"),
        }
    }

    fn near(found: &[Option<f64>], expected: &[Option<f64>]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.is_some(), expected.is_some(), "{found:?}");
            let (found, expected) = (found.unwrap_or(0.0), expected.unwrap_or(0.0));
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn nodes_of_an_edge_have_half_of_the_sides_beside_them_and_single_ones_nothing() {
        let text = |skip: &str| {
            format!(
                r#"{{ "format": "stickslip/1", "title": "t", "materials": {{ "m": {{ "E": 1, "nu": 0 }} }},
                "nodes": {{ "A": [0, 9], "B": [1, 9] }}, "sections": {{ "s": {{ "area": 1, "inertia": 1 }} }},
                "bars": [{{ "id": "b", "nodes": ["A", "B"], "material": "m", "section": "s" }}],
                "plates": [{{ "id": "p", "origin": [0, 0], "x": [0, 1, 3], "y": [0, 1], "thickness": 1, "material": "m", "plane": "stress" }}],
                "foundations": [{{ "id": "soil", "on": "b", "stiffness": 1, "tensionless": true }}],
                "contacts": [{{ "id": "c", "node": "A", "against": "ground", "normal": [1, 0] }},
                             {{ "id": "base", "edge": "p.bottom", "against": "ground"{skip} }}] }}"#
            )
        };
        let mut all = [Some(0.5), Some(1.5), Some(1.0), Some(0.5), Some(0.5), None].to_vec();
        let mut found = lengths(&text(""));
        let by_size = |a: &Option<f64>, b: &Option<f64>| a.partial_cmp(b).unwrap();
        found.sort_by(by_size);
        all.sort_by(by_size);
        near(&found, &all);
        // the pair that is left out keeps its length to itself
        let mut found = lengths(&text(r#", "skip": [1]"#));
        let mut all = [Some(0.5), Some(1.0), Some(0.5), Some(0.5), None].to_vec();
        found.sort_by(by_size);
        all.sort_by(by_size);
        near(&found, &all);
    }

    #[test]
    fn middle_nodes_have_four_sixths() {
        let text = r#"{ "format": "stickslip/1", "title": "t", "materials": { "m": { "E": 1, "nu": 0 } },
            "nodes": { "A": [0, 0], "B": [6, 0], "C": [0, 6], "D": [3, 0], "E": [3, 3], "F": [0, 3] },
            "triangles": [{ "id": "q", "nodes": ["A", "B", "C", "D", "E", "F"], "thickness": 1, "material": "m", "plane": "stress" }],
            "edges": { "low": ["A", "D", "B"] },
            "contacts": [{ "id": "base", "edge": "low", "against": "ground" }] }"#;
        near(&lengths(text), &[Some(1.0), Some(4.0), Some(1.0)]);
    }
}
