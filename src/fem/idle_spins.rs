//! Rotations that move nothing and that nothing resists. They are held (`body_rows`), and loads that would drive them
//! are refused (`outline`).
//!
//! A part whose nodes all lie on one line can spin about it, a node to which bars transmit only their torque can turn
//! about any axis. Such are bars between ball joints, divided or not, rigid bodies of which only displacements are
//! held, and nodes between hinges:
//!
//! ```text
//!     s_p a_p, θ_n     spin of each part on a line about its axis a_p, rotation of each lone node
//!     a_b·θ = s_b      at a hinge: it transmits the torque of its bar b
//! ```
//!
//! with what supports, ties and springs hold: the null space of these rows, group by group of what they connect.

use super::dof::Dofs;
use super::null_space::{NullSpace, Terms, null_space};
use super::parts::{Parts, STRAIGHT};
use crate::model::groups::Groups;
use crate::model::structure::{Component, Dimension, Structure};
use crate::model::vector::{dot, length, unit, way};

/// Singular values and amounts below this share of the largest are rounding.
const NULL: f64 = 1024.0 * f64::EPSILON;

/// A coefficient of the rows is a product of two unit vectors, each known to 2.5 ε, summed from three terms.
const COEFFICIENT: f64 = 8.0 * f64::EPSILON;

/// Rotations of some nodes and parts at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct IdleSpin {
    /// The part at which it is held.
    pub part: u32,
    /// Unit vector of the axis about which the part is held.
    pub axis: [f64; 3],
    /// By how much each node turns, those of the part first. Where there are none, there is no displacement to be held.
    pub turns: Vec<(usize, [f64; 3])>,
    /// By how much a component of a turn may be off: the vector of the null space is as good as the rows let it be.
    pub error: f64,
}

/// The rotation of a node about an axis, as a sum over base dofs.
pub fn turn(dofs: &Dofs, node: usize, axis: [f64; 3]) -> Vec<(usize, f64)> {
    let terms = Component::ROTATIONS.into_iter().map(|about| (dofs.of(node, about), axis[about.axis()]));
    terms.filter_map(|(dof, a)| Some((dof?, a))).filter(|(_, a)| *a != 0.0).collect()
}

/// The idle spins, in the order of the parts that they begin with.
pub fn idle_spins(structure: &Structure, parts: &Parts) -> Vec<IdleSpin> {
    if structure.dimension == Dimension::Plane {
        return Vec::new();
    }
    let spins = Spins::new(structure, parts);
    let rows = spins.resisted(structure);
    let mut groups = Groups::new(spins.count);
    spins.axes.iter().for_each(|axes| groups.join_all(axes.iter().map(|(unknown, _)| *unknown)));
    rows.iter().for_each(|row| groups.join_all(row.iter().map(|(unknown, _)| *unknown)));
    let group_of = groups.numbers(0..spins.count);
    let count = group_of.iter().max().map_or(0, |last| last + 1);
    let mut unknowns = vec![Vec::new(); count];
    let mut number = vec![0; spins.count];
    for (unknown, &group) in group_of.iter().enumerate() {
        number[unknown] = unknowns[group].len();
        unknowns[group].push(unknown);
    }
    let mut of_group: Vec<Vec<Terms>> = vec![Vec::new(); count];
    for row in rows {
        let Some(&(first, _)) = row.first() else { continue };
        of_group[group_of[first]].push(row.into_iter().map(|(unknown, a)| (number[unknown], a)).collect());
    }
    let mut idle = Vec::new();
    for (unknowns, rows) in std::iter::zip(&unknowns, &of_group) {
        let Some(NullSpace { basis, sensitivity }) = null_space(rows, unknowns.len(), NULL, usize::MAX) else {
            continue;
        };
        let mut vectors: Vec<Vec<f64>> = basis.column_iter().map(|vector| vector.iter().copied().collect()).collect();
        while let Some(vector) = (!vectors.is_empty()).then(|| vectors.remove(0)) {
            let Some(mut spin) = spins.told(unknowns, &vector) else { continue };
            spin.error = COEFFICIENT * sensitivity * vector.iter().map(|x| x * x).sum::<f64>().sqrt();
            // The others without what would turn the part about the axis that is held.
            let about = |vector: &[f64]| dot(spin.axis, spins.rotation(spin.part, unknowns, vector));
            let held = about(&vector);
            for other in &mut vectors {
                let share = about(other) / held;
                let size = other.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                for (other, one) in other.iter_mut().zip(&vector) {
                    *other -= share * one;
                    if other.abs() <= NULL * size {
                        *other = 0.0;
                    }
                }
            }
            idle.push(spin);
        }
    }
    idle
}

/// The unknown spins.
struct Spins<'a> {
    parts: &'a Parts,
    /// The unknowns of each part and the axes about which they turn it: none, one along its line, or x, y and z.
    axes: Vec<Vec<(usize, [f64; 3])>>,
    /// The part of each unknown.
    part_of: Vec<u32>,
    /// The nodes that turn with each part.
    turning: Vec<Vec<usize>>,
    count: usize,
}

impl Spins<'_> {
    fn new<'a>(structure: &Structure, parts: &'a Parts) -> Spins<'a> {
        let lines = parts.lines(structure);
        let mut turning = vec![Vec::new(); lines.len()];
        for (node, part) in parts.turning.iter().enumerate() {
            if let Some(part) = part {
                turning[*part as usize].push(node);
            }
        }
        let mut nodes = vec![0_u32; lines.len()];
        parts.at_node.iter().flatten().for_each(|&part| nodes[part as usize] += 1);
        let mut part_of = Vec::new();
        let mut axes = Vec::with_capacity(lines.len());
        for (part, line) in lines.into_iter().enumerate() {
            let about: Vec<[f64; 3]> = match line {
                Some(line) => vec![line],
                None if nodes[part] == 1 && !turning[part].is_empty() => {
                    vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                }
                None => Vec::new(),
            };
            let first = part_of.len();
            part_of.resize(first + about.len(), part as u32);
            axes.push((first..).zip(about).collect());
        }
        Spins { parts, axes, count: part_of.len(), part_of, turning }
    }

    /// The rotation of a part about an axis. Axes at right angles are so but for rounding.
    fn about(&self, part: u32, axis: [f64; 3], factor: f64) -> impl Iterator<Item = (usize, f64)> {
        let terms = self.axes[part as usize].iter().map(move |&(unknown, own)| (unknown, dot(own, axis)));
        terms.filter(|(_, a)| a.abs() > STRAIGHT).map(move |(unknown, a)| (unknown, factor * a))
    }

    /// The rotation of a node.
    fn of_node(&self, node: usize, component: Component, factor: f64) -> Terms {
        let mut axis = [0.0; 3];
        axis[component.axis()] = 1.0;
        self.parts.turning[node].map_or(Vec::new(), |part| self.about(part, axis, factor).collect())
    }

    /// Σ a·unknown = 0: what supports, ties, springs and a superelement hold, and what hinges transmit.
    fn resisted(&self, structure: &Structure) -> Vec<Terms> {
        let mut rows: Vec<Terms> = Vec::new();
        let held = structure.supports.iter().map(|support| (support.node, support.component));
        let given = structure.superelement.iter().flat_map(|element| element.dofs.iter().copied());
        let rotations = held.chain(given).filter(|(_, component)| component.is_rotation());
        rows.extend(rotations.map(|(node, component)| self.of_node(node, component, 1.0)));
        for tie in &structure.ties {
            for &component in tie.components.iter().filter(|component| component.is_rotation()) {
                let pairs = tie.nodes.windows(2).map(|nodes| {
                    [self.of_node(nodes[0], component, 1.0), self.of_node(nodes[1], component, -1.0)].concat()
                });
                rows.extend(pairs);
            }
        }
        for spring in structure.springs.iter().filter(|spring| spring.stiffness > 0.0) {
            let turned = spring.terms.iter().filter(|term| term.component.is_rotation());
            rows.push(turned.flat_map(|term| self.of_node(term.node, term.component, term.factor)).collect());
        }
        for (element, &part) in std::iter::zip(&structure.elements, &self.parts.of_element).filter(|(e, _)| e.bends()) {
            let [a, b] = [0, 1].map(|end| structure.nodes[element.nodes[end]].position);
            let Some(along) = unit(way(a, b)) else { continue };
            for (at, &node) in element.nodes.iter().enumerate() {
                let hands_on = !element.turns_with(at) && element.components(at).contains(&Component::Rx);
                let Some(with) = self.parts.turning[node].filter(|with| hands_on && *with != part) else { continue };
                rows.push(self.about(part, along, 1.0).chain(self.about(with, along, -1.0)).collect());
            }
        }
        rows
    }

    /// The rotation of a part in a vector of the unknowns of a group.
    fn rotation(&self, part: u32, unknowns: &[usize], vector: &[f64]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for &(unknown, axis) in &self.axes[part as usize] {
            // The unknowns of a group ascend.
            if let Ok(at) = unknowns.binary_search(&unknown) {
                (0..3).for_each(|c| sum[c] += vector[at] * axis[c]);
            }
        }
        sum
    }

    /// A vector as a spin, held where it turns most of what has displacements to be held.
    fn told(&self, unknowns: &[usize], vector: &[f64]) -> Option<IdleSpin> {
        let mut parts: Vec<u32> = unknowns.iter().map(|&unknown| self.part_of[unknown]).collect();
        parts.dedup();
        let mut turned: Vec<(u32, [f64; 3])> =
            parts.into_iter().map(|part| (part, self.rotation(part, unknowns, vector))).collect();
        turned.retain(|(_, rotation)| length(*rotation) > 0.0);
        let rank = |&(part, rotation): &(u32, [f64; 3])| (!self.turning[part as usize].is_empty(), length(rotation));
        let mut most = 0;
        for at in 1..turned.len() {
            if rank(&turned[at]) > rank(&turned[most]) {
                most = at;
            }
        }
        turned.swap(0, most);
        let &(part, rotation) = turned.first()?;
        let turns = turned
            .iter()
            .flat_map(|&(part, rotation)| self.turning[part as usize].iter().map(move |&node| (node, rotation)));
        Some(IdleSpin { part, axis: unit(rotation)?, turns: turns.collect(), error: 0.0 })
    }
}
