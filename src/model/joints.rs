//! Which contact pairs form one joint: a line along which a quantity can be drawn.
//!
//! Two pairs are neighbours in a joint where the way from one to the other runs along both their tangents and through
//! the material of one of the sides. The two pads of a portal are connected through its columns only, the two sides of
//! a slot lie across from each other, at a corner the tangents differ: these are joints of their own.

use std::collections::{BinaryHeap, HashMap};

use super::structure::Structure;
use super::vector::{distance, dot, length, way};

/// Cosine of the largest turn between neighbours, 60°: a ring of eight pairs is still one joint.
const TURN: f64 = 0.5;
/// Sine of the largest angle between a tangent and the way to the neighbour, 30°: half of that turn.
const ASIDE: f64 = 0.5 + 1e-9;
/// How much longer the way through the material may be than the straight one.
const DETOUR: f64 = 1.2;
/// More pieces than this are not searched for neighbours that the order of the pairs does not show.
const MOST_PIECES: usize = 500;

/// Number of the joint of each pair; joints are numbered in the order of their first pairs.
pub fn joint_numbers(structure: &Structure) -> Vec<usize> {
    let material = Material::of(structure);
    let follow = |a: usize, b: usize| are_neighbours(structure, &material, a, b).is_some();
    let mut pieces: Vec<Vec<usize>> = Vec::new();
    for pair in 0..structure.pairs.len() {
        match pieces.last_mut() {
            Some(piece) if piece.last().is_some_and(|&last| follow(last, pair)) => piece.push(pair),
            _ => pieces.push(vec![pair]),
        }
    }
    if pieces.len() <= MOST_PIECES {
        join_nearest(structure, &material, &mut pieces);
    }
    pieces.sort_by_key(|piece| piece.iter().copied().min());
    let mut numbers = vec![0; structure.pairs.len()];
    for (number, piece) in pieces.iter().enumerate() {
        piece.iter().for_each(|&pair| numbers[pair] = number);
    }
    numbers
}

/// Joins pieces whose ends are neighbours, the nearest ones first: the pairs of a joint need not follow one another.
fn join_nearest(structure: &Structure, material: &Material, pieces: &mut Vec<Vec<usize>>) {
    let ends = |piece: &[usize]| [piece[0], piece[piece.len() - 1]];
    let mut near: Vec<(f64, usize, usize)> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        for other in &pieces[index + 1..] {
            for a in ends(piece) {
                near.extend(
                    ends(other)
                        .iter()
                        .filter_map(|&b| are_neighbours(structure, material, a, b).map(|distance| (distance, a, b))),
                );
            }
        }
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, a, b) in near {
        let at = |pair: usize, pieces: &[Vec<usize>]| pieces.iter().position(|piece| ends(piece).contains(&pair));
        let (Some(first), Some(second)) = (at(a, pieces), at(b, pieces)) else { continue };
        if first != second {
            let other = pieces[second].clone();
            pieces[first].extend(other);
            pieces.remove(second);
        }
    }
}

/// The distance of two pairs that are neighbours in a joint.
fn are_neighbours(structure: &Structure, material: &Material, a: usize, b: usize) -> Option<f64> {
    let [p, q] = [a, b].map(|pair| &structure.pairs[pair]);
    let [from, to] = [p, q].map(|pair| pair.at_place(|node| structure.nodes[node].position));
    let way = way(from, to);
    let distance = length(way);
    let along = |normal: [f64; 3]| dot(way, normal).abs() <= ASIDE * distance;
    if dot(p.normal, q.normal) < TURN || !along(p.normal) || !along(q.normal) {
        return None;
    }
    let meet_on_ground = distance == 0.0 && p.against().is_none() && q.against().is_none();
    let through = meet_on_ground
        || material.connects(p.node, q.node, DETOUR * distance)
        || p.against().zip(q.against()).is_some_and(|(a, b)| material.connects(a, b, DETOUR * distance));
    through.then_some(distance)
}

/// The ways through the structure: nodes and the lengths between them.
struct Material {
    ways: Vec<Vec<(usize, f64)>>,
    /// Body of every node that belongs to a rigid one or to a superelement: from any of its nodes to any other.
    bodies: HashMap<usize, usize>,
    positions: Vec<[f64; 3]>,
}

impl Material {
    fn of(structure: &Structure) -> Material {
        let positions: Vec<[f64; 3]> = structure.nodes.iter().map(|node| node.position).collect();
        let length = |a: usize, b: usize| distance(positions[a], positions[b]);
        let mut ways = vec![Vec::new(); positions.len()];
        for element in &structure.elements {
            for [a, b] in element.neighbours() {
                ways[a].push((b, length(a, b)));
                ways[b].push((a, length(a, b)));
            }
        }
        let rigid = structure.rigid.iter().map(|body| body.nodes.as_slice());
        let parts = structure.superelement.iter().flat_map(|body| &body.parts);
        let condensed = parts.map(|part| part.nodes.as_slice());
        let bodies =
            rigid.chain(condensed).enumerate().flat_map(|(index, nodes)| nodes.iter().map(move |&n| (n, index)));
        Material { ways, bodies: bodies.collect(), positions }
    }

    /// Whether a way no longer than `most` leads from one node to another.
    fn connects(&self, from: usize, to: usize, most: f64) -> bool {
        if from == to {
            return true;
        }
        if self.bodies.get(&from).is_some_and(|body| self.bodies.get(&to) == Some(body)) {
            return true;
        }
        let straight = |node: usize| distance(self.positions[node], self.positions[to]);
        // the shortest first, measured by the way made and the straight rest of it; lengths as ordered integers
        let mut open = BinaryHeap::from([(std::cmp::Reverse(straight(from).to_bits()), from)]);
        let mut best = HashMap::from([(from, 0.0)]);
        while let Some((_, node)) = open.pop() {
            if node == to {
                return true;
            }
            let made = best[&node];
            for &(next, length) in &self.ways[node] {
                let whole = made + length;
                if whole + straight(next) <= most && best.get(&next).is_none_or(|known| whole < *known) {
                    best.insert(next, whole);
                    open.push((std::cmp::Reverse((whole + straight(next)).to_bits()), next));
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::embedded;
    use crate::model::pair::{Law, Pair};
    use crate::model::parameter::Number;
    use crate::model::scenario::Source;
    use crate::model::structure::{Node, RigidBody};
    use crate::model::vector::flat;

    /// Pairs of one rigid body with the ground: (x, y) and the normal.
    fn body(pairs: &[([f64; 2], [f64; 2])]) -> Vec<usize> {
        let mut structure = Structure::default();
        for (index, &(position, normal)) in pairs.iter().enumerate() {
            structure.nodes.push(Node { id: format!("n{index}"), position: flat(position) });
            let law = Law::Frictionless { gap: Number::Value(0.0) };
            let id = format!("c{index}");
            structure.pairs.push(Pair::at_node(id, index, None, flat(normal), structure.dimension, law));
        }
        structure.rigid.push(RigidBody { id: "body".into(), nodes: (0..pairs.len()).collect() });
        joint_numbers(&structure)
    }

    fn of_embedded(name: &str) -> Vec<(String, usize)> {
        let scenario = embedded::load(name).expect("embedded");
        let Source::Structure(structure) = &scenario.source else { panic!("{name} is not a structure") };
        let ids = structure.pairs.iter().map(|pair| pair.id.clone());
        ids.zip(joint_numbers(structure)).collect()
    }

    #[test]
    fn the_floor_and_the_wall_of_a_corner_are_two_joints() {
        let (floor, wall) = ([0.0, 1.0], [1.0, 0.0]);
        let pairs =
            [([2.0, 0.0], floor), ([1.0, 0.0], floor), ([0.0, 0.0], floor), ([0.0, 0.0], wall), ([0.0, 1.0], wall)];
        assert_eq!(body(&pairs), [0, 0, 0, 1, 1]);
    }

    #[test]
    fn the_two_sides_of_a_slot_are_two_joints_in_any_order() {
        let (left, right) = ([1.0, 0.0], [-1.0, 0.0]);
        let at = |x: f64, normal: [f64; 2]| move |y: f64| ([x, y], normal);
        let (l, r) = (at(0.0, left), at(0.2, right));
        assert_eq!(body(&[l(0.0), l(1.0), l(2.0), r(0.0), r(1.0), r(2.0)]), [0, 0, 0, 1, 1, 1]);
        assert_eq!(body(&[l(0.0), r(0.0), l(1.0), r(1.0)]), [0, 1, 0, 1]);
    }

    /// A ring of eight pairs: each neighbour turns by 45°, and the way to it lies 22.5° aside.
    #[test]
    fn a_ring_is_one_joint() {
        let pairs: Vec<_> = (0..8)
            .map(|k| {
                let (s, c) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                ([c, s], [c, s])
            })
            .collect();
        assert_eq!(body(&pairs), [0; 8]);
    }

    #[test]
    fn the_feet_of_a_portal_are_two_joints_and_the_supports_of_a_beam_one() {
        assert_eq!(of_embedded("portal").into_iter().map(|(_, joint)| joint).collect::<Vec<_>>(), [0, 0, 1, 1]);
        assert!(of_embedded("beam").iter().all(|(_, joint)| *joint == 0));
        assert!(of_embedded("press-fit").iter().all(|(_, joint)| *joint == 0));
    }

    /// All inner pairs are listed before all outer ones; a joint has one of each.
    #[test]
    fn each_joint_of_an_arch_is_one() {
        let pairs = of_embedded("arch");
        let count = pairs.iter().map(|(_, joint)| joint + 1).max().unwrap_or(0);
        assert_eq!(2 * count, pairs.len());
        for (id, joint) in &pairs {
            let name = id.trim_end_matches("-in").trim_end_matches("-out");
            let mates: Vec<&str> =
                pairs.iter().filter(|(_, other)| other == joint).map(|(id, _)| id.as_str()).collect();
            assert_eq!(mates, [format!("{name}-in"), format!("{name}-out")], "{id}");
        }
    }
}
