//! A motion that costs no energy, in words: which parts move, how, and what that does to the pairs.

use nalgebra::DVector;

use super::rigid::{Fitted, RigidMotion};
use crate::contact::polygon::{angle, degrees};
use crate::contact::system::ContactSystem;
use crate::fem::{MainSystem, mutual_displacements};
use crate::model::pair::joints;
use crate::model::structure::{Dimension, Structure};
use crate::model::vector::length;
use crate::text::words::list;

/// Entries below this share of the largest do not move.
pub(super) const STILL: f64 = 1e-7;

/// A part that moves as one rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct PartMotion {
    /// Its name as it stands in a sentence: `` `upper` ``, `` `AB` and `BC` ``.
    pub name: String,
    /// How it moves.
    pub motion: RigidMotion,
    /// Where the structure lies.
    pub dimension: Dimension,
}

impl PartMotion {
    /// "rigid translation of `upper` along +x".
    pub fn words(&self) -> String {
        self.motion.words(&self.name, self.dimension)
    }
}

/// A motion of the structure that costs no energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Displacements per node, in the order of the components.
    pub displacements: Vec<[f64; 6]>,
    /// The parts that move; empty where the motion is not one of rigid parts.
    pub parts: Vec<PartMotion>,
}

/// A bar, plate, triangle, quad or rigid body with its nodes, or a node that is in none of them.
struct Member {
    id: String,
    nodes: Vec<usize>,
}

fn members(structure: &Structure) -> Vec<Member> {
    let nodes_of = |elements: std::ops::Range<usize>| {
        let mut nodes: Vec<usize> =
            structure.elements[elements].iter().flat_map(|element| element.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let mut all: Vec<Member> = structure
        .bars
        .iter()
        .map(|bar| (&bar.id, &bar.elements))
        .chain(structure.plates.iter().map(|plate| (&plate.id, &plate.elements)))
        .chain(structure.bricks.iter().map(|brick| (&brick.id, &brick.elements)))
        .map(|(id, elements)| Member { id: format!("`{id}`"), nodes: nodes_of(elements.clone()) })
        .collect();
    for mesh in &structure.meshes {
        all.extend(mesh.bodies.iter().map(|body| {
            let mut nodes: Vec<usize> =
                body.elements.iter().flat_map(|element| structure.elements[*element].nodes.iter().copied()).collect();
            nodes.sort_unstable();
            nodes.dedup();
            Member { id: format!("`{}`", body.name), nodes }
        }));
    }
    let mut named = vec![false; structure.elements.len()];
    for elements in structure
        .bars
        .iter()
        .map(|bar| &bar.elements)
        .chain(structure.plates.iter().map(|plate| &plate.elements))
        .chain(structure.bricks.iter().map(|brick| &brick.elements))
        .chain(structure.meshes.iter().map(|mesh| &mesh.elements))
    {
        named[elements.clone()].fill(true);
    }
    for (index, element) in structure.elements.iter().enumerate().filter(|(index, _)| !named[*index]) {
        let id = match structure.element_name(index) {
            Some(id) => format!("`{id}`"),
            None => structure.element_in_words(index),
        };
        all.push(Member { id, nodes: element.nodes.clone() });
    }
    if let Some(element) = &structure.superelement {
        let id = |nodes: &[usize]| match element.parts.len() {
            1 => "the superelement".to_owned(),
            _ => format!("the part of the superelement at `{}`", structure.nodes[nodes[0]].id),
        };
        all.extend(element.parts.iter().map(|part| Member { id: id(&part.nodes), nodes: part.nodes.clone() }));
    }
    all.extend(structure.rigid.iter().map(|body| Member { id: format!("`{}`", body.id), nodes: body.nodes.clone() }));
    let mut is_in_one = vec![false; structure.nodes.len()];
    all.iter().flat_map(|member| &member.nodes).for_each(|&node| is_in_one[node] = true);
    let alone = (0..structure.nodes.len()).filter(|&node| !is_in_one[node]);
    all.extend(alone.map(|node| Member { id: format!("node `{}`", structure.nodes[node].id), nodes: vec![node] }));
    all
}

/// Largest extent of the structure; 1 of a structure at one place.
fn size(structure: &Structure) -> f64 {
    let size = structure.extent().into_iter().fold(0.0, f64::max);
    if size > 0.0 { size } else { 1.0 }
}

/// The motion of the structure with these mutual displacements of the joints, if one costs no energy.
pub fn mode(structure: &Structure, main: &MainSystem, direction: &DVector<f64>) -> Option<Mode> {
    let motions = main.kernel_motions();
    if motions.is_empty() || direction.amax() == 0.0 {
        return None;
    }
    let amounts = main.amounts(direction);
    let mut displacements = vec![[0.0; 6]; structure.nodes.len()];
    for (motion, amount) in motions.iter().zip(amounts.iter()) {
        for (sum, u) in displacements.iter_mut().zip(&motion.u) {
            for (sum, u) in sum.iter_mut().zip(u) {
                *sum += amount * u;
            }
        }
    }
    let moved = mutual_displacements(&joints(&structure.pairs), &displacements);
    if (moved - direction).amax() > 1e-6 * direction.amax() {
        return None;
    }
    let parts = parts(structure, &displacements).unwrap_or_default();
    Some(Mode { displacements, parts })
}

/// The parts that move, each rigid; `None` where one of them is not.
pub fn parts(structure: &Structure, displacements: &[[f64; 6]]) -> Option<Vec<PartMotion>> {
    let extent = size(structure);
    let moved = |node: usize| length([displacements[node][0], displacements[node][1], displacements[node][2]]);
    let largest = (0..displacements.len()).map(moved).fold(0.0, f64::max);
    if largest == 0.0 {
        return Some(Vec::new());
    }
    // Members with the same rigid motion are one part.
    let mut groups: Vec<(Fitted, Vec<usize>)> = Vec::new();
    let members = members(structure);
    for (index, member) in members.iter().enumerate() {
        let rigid = Fitted::of(structure, &member.nodes, displacements, 1e-6 * largest)?;
        if !member.nodes.iter().any(|&node| moved(node) > STILL * largest) {
            continue;
        }
        match groups.iter_mut().find(|(other, _)| rigid.is_like(other, extent, largest)) {
            Some((_, group)) => group.push(index),
            None => groups.push((rigid, vec![index])),
        }
    }
    let describe = |(rigid, group): (Fitted, Vec<usize>)| {
        let names: Vec<String> = group.iter().map(|&member| members[member].id.clone()).collect();
        let nodes: Vec<usize> = group.iter().flat_map(|&member| members[member].nodes.iter().copied()).collect();
        let motion = rigid.describe(centre(structure, &nodes), extent, largest);
        PartMotion { name: part_name(&names, members.len()), motion, dimension: structure.dimension }
    };
    Some(groups.into_iter().map(describe).collect())
}

/// The middle of nodes.
fn centre(structure: &Structure, nodes: &[usize]) -> [f64; 3] {
    let count = nodes.len() as f64;
    std::array::from_fn(|c| nodes.iter().map(|&node| structure.nodes[node].position[c]).sum::<f64>() / count)
}

fn part_name(names: &[String], all: usize) -> String {
    if names.len() == all && all > 1 { "the whole structure".to_owned() } else { listed_parts(names, "members") }
}

/// All of a few names; of many the first and the last, and how many `things` there are.
pub(super) fn listed_parts(names: &[String], things: &str) -> String {
    match names {
        [first, .., last] if names.len() > 4 => format!("{first} to {last} ({} {things})", names.len()),
        _ => list(names),
    }
}

/// More ways of slip than this are not listed one by one.
const MOST_WAYS: usize = 6;

/// What a direction does to the pairs: "all pairs slip +", `base[0] to base[3] open`.
pub fn pair_words(system: &ContactSystem, direction: &DVector<f64>) -> Vec<String> {
    let largest = direction.amax();
    let moves = |z: f64| z.abs() > STILL * largest;
    let mut kinds: Vec<(String, Vec<usize>)> =
        ["open", "close", "slip +", "slip -"].map(|k| (k.to_owned(), Vec::new())).into();
    for (i, pair) in system.pairs.iter().enumerate() {
        let slip: Vec<f64> = pair.tangential.clone().map(|joint| direction[joint]).collect();
        let kind = match slip[..] {
            _ if moves(direction[i]) => (if direction[i] > 0.0 { "open" } else { "close" }).to_owned(),
            [z_t] if moves(z_t) => (if z_t > 0.0 { "slip +" } else { "slip -" }).to_owned(),
            [along, across] if moves(along.hypot(across)) => {
                format!("slip towards {}", degrees(angle([along, across])))
            }
            _ => continue,
        };
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, pairs)) => pairs.push(i),
            None => kinds.push((kind, vec![i])),
        }
    }
    // a body that turns slips in a different direction everywhere
    let ways = |kind: &str| kind.starts_with("slip towards");
    if kinds.iter().filter(|(kind, _)| ways(kind)).count() > MOST_WAYS {
        let (turning, mut rest): (Vec<_>, Vec<_>) = kinds.into_iter().partition(|(kind, _)| ways(kind));
        let mut pairs: Vec<usize> = turning.into_iter().flat_map(|(_, pairs)| pairs).collect();
        pairs.sort_unstable();
        rest.push(("slip each its own way".to_owned(), pairs));
        kinds = rest;
    }
    kinds
        .into_iter()
        .filter(|(_, pairs)| !pairs.is_empty())
        .map(|(kind, pairs)| {
            let verb = match (pairs.len(), kind.as_str()) {
                (1, "open") => "opens".to_owned(),
                (1, "close") => "closes".to_owned(),
                (1, _) => kind.replacen("slip", "slips", 1),
                _ => kind,
            };
            format!("{} {verb}", pair_names(system, &pairs))
        })
        .collect()
}

/// "all pairs", "pair c1", "pairs c1 and c3", `pairs base[0] to base[3]`.
pub fn pair_names(system: &ContactSystem, pairs: &[usize]) -> String {
    let id = |i: usize| system.pairs[i].id.clone();
    if pairs.len() == system.pairs.len() && pairs.len() > 1 {
        return "all pairs".to_owned();
    }
    if let [one] = pairs {
        return format!("pair {}", id(*one));
    }
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for &i in pairs {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == i => *last = i,
            _ => runs.push((i, i)),
        }
    }
    let words: Vec<String> = runs
        .into_iter()
        .flat_map(|(first, last)| match last - first {
            0 => vec![id(first)],
            1 => vec![id(first), id(last)],
            _ => vec![format!("{} to {}", id(first), id(last))],
        })
        .collect();
    format!("pairs {}", list(&words))
}
