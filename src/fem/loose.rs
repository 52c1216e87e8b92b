//! Motions that cost no energy when every contact joint is off: the kernel of K from the rigid motions of parts.
//!
//! Parts linked by pins and ties make a *cluster*. In each cluster the motions q (translations and rotations of each
//! part) that open no pin and no tie, move no support and stretch no spring are the null space of a small matrix;
//! testing motions one by one would miss a rotation about a pin or a tie.
//!
//! Of a cluster of very many parts the null space comes from an elimination, and every motion is put to the test. Where
//! that took too long or lost too many digits, elements joined by common nodes are taken as one part; its internal
//! mechanisms, if it has any, are found from the eigenvalues of R instead (see `main_system`), known to fewer digits.

use std::collections::{BTreeSet, HashMap, HashSet};

use nalgebra::{DMatrix, DVectorView};

use super::contrast::Stiffnesses;
use super::dof::Dofs;
use super::idle_spins::idle_spins;
use super::null_space::{DENSE, Terms, null_space};
use super::parts::{Parts, superelement_parts};
use super::traces::Traces;
use crate::doubled::Doubled;
use crate::model::groups::Groups;
use crate::model::pair::Joint;
use crate::model::space_section::EndJoint;
use crate::model::structure::{Component, Dimension, ElementKind, Structure};
use crate::model::superelement::Part;
use crate::model::vector::{distance, unit, way};

/// Singular values below this share of the largest belong to the null space, times the rounding of the coordinates
/// beside the size of the cluster.
const NULL: f64 = 1024.0 * f64::EPSILON;

/// Elements and springs whose stiffnesses differ by no more than this leave no doubt whether what holds a part holds it
/// in the digits of f64 and beyond; the softest shape of n membranes is 1/n⁴ as stiff as they are, and doubled
/// precision resolves 1e-22.
const CONTRAST: f64 = 1e6;

/// Two elements that share a side of at least this share of the whole are held by it against turning, in the same
/// digits: its square times the stiffness.
const SHORT: f64 = 1e-6;

/// Most additions of an elimination that may be in vain, some tenths of a second. A rope of n pieces takes n².
pub const EFFORT: usize = 2_000_000;

/// A motion of the whole structure, its displacements per node in the order of [`Component::ALL`], largest translation
/// (or rotation × size) about 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Displacements per node; 0 where there is no rotation.
    pub u: Vec<[f64; 6]>,
    /// Whether parts of one connected group move against each other (a mechanism inside the structure), as far as
    /// that was seen from the stiffness rather than from rigid parts.
    pub internal: bool,
}

/// Basis of the motions that cost no energy with all joints off: translations along the axes, then rotations,
/// as far as the cluster allows.
pub struct LooseMotions {
    pub motions: Vec<Motion>,
    /// Whether all parts were looked at one by one, so that no mechanism among them can have been missed.
    pub complete: bool,
    /// Of each cluster that moves what its motions do to the joints, in the order of `motions`; `None` where that is not known
    /// beyond f64.
    pub traces: Option<Vec<Traces>>,
}

impl LooseMotions {
    /// Whether there are surely no others, so that the stiffness need not be asked: no bars, no superelement, not too
    /// many parts connected to one another, no part so much softer than another, and no side so short beside the whole,
    /// that only the numbers could tell whether it holds.
    pub fn are_all(&self, structure: &Structure, stiffnesses: &Stiffnesses) -> bool {
        self.may_be_all(structure) && stiffnesses.contrast() <= CONTRAST
    }

    /// The part of [`LooseMotions::are_all`] for which no stiffness need be known.
    pub fn may_be_all(&self, structure: &Structure) -> bool {
        let wide = structure.elements.iter().all(|element| element.nodes.len() > 2);
        self.complete
            && wide
            && structure.superelement.is_none()
            && shortest_side(structure) >= SHORT * structure.extent().into_iter().fold(0.0, f64::max)
    }
}

/// Least distance of two nodes of an element.
pub fn shortest_side(structure: &Structure) -> f64 {
    let place = |node: usize| structure.nodes[node].position;
    let of_element = |nodes: &Vec<usize>| {
        let pairs = nodes.iter().enumerate().flat_map(|(i, a)| nodes[..i].iter().map(move |b| [*a, *b]));
        pairs.map(|[a, b]| distance(place(a), place(b))).fold(f64::INFINITY, f64::min)
    };
    structure.elements.iter().map(|element| of_element(&element.nodes)).fold(f64::INFINITY, f64::min)
}

/// The motions from the parts, one by one where that takes no more than `effort` additions, and what they do to `joints`.
pub fn loose_motions(structure: &Structure, dofs: &Dofs, joints: &[Joint], effort: usize) -> LooseMotions {
    let parts = Parts::new(structure);
    let clusters = parts.clusters(structure);
    let spins: Vec<Spin> = idle_spins(structure, &parts).into_iter().map(|spin| (spin.part, spin.axis)).collect();
    let (mut motions, mut complete) = (Vec::new(), true);
    // The stiffness of a superelement is given in numbers, not by geometry.
    let mut traces = structure.superelement.is_none().then(Vec::<Traces>::new);
    let mut joints_of = vec![Vec::new(); structure.nodes.len()];
    for (index, joint) in joints.iter().enumerate() {
        joint.terms.iter().for_each(|(node, _)| joints_of[*node].push(index));
    }
    for cluster in clusters {
        let unknowns = Unknowns::of(&cluster, structure, dofs, &parts);
        // An elimination cannot be sure of the rank.
        complete &= unknowns.count <= DENSE;
        let rows = unknowns.rows(&cluster, &spins);
        match unknowns.null_space(&cluster, &rows, effort) {
            Some(near) => {
                motions.extend(unknowns.motions(&cluster, &near));
                if near.ncols() > 0
                    && let Some(mut all) = traces.take()
                    && let Some(traced) = unknowns.exactly().traces(&cluster, &spins, (joints, &joints_of))
                    && traced.near.ncols() == near.ncols()
                {
                    all.push(traced);
                    traces = Some(all);
                }
            }
            None => {
                (complete, traces) = (false, None);
                let (merged, cluster) = cluster.with_whole_groups(structure);
                // What turns inside a group is not looked at, so neither is the spin of one on a line.
                let lines = merged.lines(structure).into_iter().zip(0..);
                let spins: Vec<Spin> = lines.filter_map(|(axis, part)| Some((part, axis?))).collect();
                let unknowns = Unknowns::of(&cluster, structure, dofs, &merged);
                let rows = unknowns.rows(&cluster, &spins);
                let near = unknowns.null_space(&cluster, &rows, usize::MAX);
                motions.extend(near.iter().flat_map(|near| unknowns.motions(&cluster, near)));
            }
        }
    }
    LooseMotions { motions, complete, traces }
}

/// Most unknowns of parts that are held by something and traced beyond f64: the numbers get longer by some 60 digits of two
/// with each of the equations that are solved.
const MOST_TRACED: usize = 60;

/// Grid on which the centre of parts lies that are traced beyond f64, as a share of their size.
const GRID: f64 = 1.0 / 256.0;

/// A part and the line about which it does not turn.
type Spin = (u32, [f64; 3]);

impl Parts {
    /// Parts linked by pins, ties and springs.
    fn clusters(&self, structure: &Structure) -> Vec<Cluster> {
        let mut groups = Groups::new(self.turns.len());
        let first = |node: &usize| self.at_node[*node][0] as usize;
        self.at_node.iter().for_each(|parts| groups.join_all(parts.iter().map(|&part| part as usize)));
        structure.ties.iter().for_each(|tie| groups.join_all(tie.nodes.iter().map(first)));
        structure.springs.iter().for_each(|spring| groups.join_all(spring.nodes().iter().map(first)));
        let cluster_of = groups.numbers(0..self.turns.len());
        let count = cluster_of.iter().max().map_or(0, |last| last + 1);
        let mut clusters: Vec<Cluster> = (0..count).map(|_| Cluster::default()).collect();
        for (part, &cluster) in cluster_of.iter().enumerate() {
            clusters[cluster].parts.push(part as u32);
        }
        for (node, parts) in self.at_node.iter().enumerate() {
            clusters[cluster_of[parts[0] as usize]].nodes.push(node);
        }
        let index_of = |node: usize| cluster_of[self.at_node[node][0] as usize];
        for (i, support) in structure.supports.iter().enumerate() {
            clusters[index_of(support.node)].supports.push(i);
        }
        for (i, spring) in structure.springs.iter().enumerate() {
            clusters[index_of(spring.terms[0].node)].springs.push(i);
        }
        for (i, tie) in structure.ties.iter().enumerate() {
            if let Some(&node) = tie.nodes.first() {
                clusters[index_of(node)].ties.push(i);
            }
        }
        for (i, element) in structure.elements.iter().enumerate() {
            if matches!(&element.kind, ElementKind::SpaceFrame { joints, .. } if joints.contains(&EndJoint::Hinge)) {
                clusters[index_of(element.nodes[0])].hinged.push(i);
            }
        }
        clusters
    }
}

/// Parts linked by pins, ties and springs, and what holds them (indices into the structure).
#[derive(Default)]
struct Cluster {
    parts: Vec<u32>,
    nodes: Vec<usize>,
    supports: Vec<usize>,
    springs: Vec<usize>,
    ties: Vec<usize>,
    /// Bars in space that transmit their torque at a hinge.
    hinged: Vec<usize>,
}

impl Cluster {
    /// This cluster with one part per group of elements joined by common nodes; tied groups stay apart.
    fn with_whole_groups(self, structure: &Structure) -> (Parts, Cluster) {
        let mut groups = Groups::new(structure.nodes.len());
        let elements = structure.elements.iter().map(|element| &element.nodes);
        let given = superelement_parts(structure);
        let bodies = structure.rigid.iter().map(|body| &body.nodes).chain(given.iter().map(|part| &part.nodes));
        for nodes in elements.chain(bodies) {
            groups.join_all(nodes.iter().copied());
        }
        let mut number = vec![u32::MAX; structure.nodes.len()];
        let mut turns: Vec<bool> = Vec::new();
        let mut at_node = vec![Vec::new(); structure.nodes.len()];
        let mut turning = vec![None; structure.nodes.len()];
        for &node in &self.nodes {
            let group = groups.of(node);
            if number[group] == u32::MAX {
                number[group] = turns.len() as u32;
                turns.push(false);
            } else {
                turns[number[group] as usize] = true;
            }
            at_node[node] = vec![number[group]];
            turning[node] = Some(number[group]);
        }
        let parts = (0..turns.len() as u32).collect();
        let part_of = |part: &Part| at_node[part.nodes[0]].first().copied().unwrap_or(u32::MAX);
        let of_superelement = given.iter().map(part_of).collect();
        let of_element = structure.elements.iter().map(|element| number[groups.of(element.nodes[0])]).collect();
        let merged = Parts { at_node, turning, turns, of_element, of_superelement };
        (merged, Cluster { parts, ..self })
    }
}

fn negative(terms: Terms) -> impl Iterator<Item = (usize, f64)> {
    terms.into_iter().map(|(unknown, a)| (unknown, -a))
}

/// The unknowns of a cluster: translations and scaled rotations of each part, all of the first part, then of the next …
struct Unknowns<'a> {
    structure: &'a Structure,
    dofs: &'a Dofs,
    parts: &'a Parts,
    /// Numbers of the unknowns of each part of the cluster by component; `usize::MAX` for one that it has not.
    of_part: HashMap<u32, [usize; 6]>,
    count: usize,
    /// The point about which parts turn.
    centre: [f64; 3],
    /// Distance from there to the farthest node: rotations are scaled by it.
    size: f64,
    /// Whether the terms of what is made of them add up to it exactly, those of one unknown too: a lever may have two then, and
    /// so may a product.
    exact: bool,
}

impl<'a> Unknowns<'a> {
    fn of(cluster: &Cluster, structure: &'a Structure, dofs: &'a Dofs, parts: &'a Parts) -> Unknowns<'a> {
        let place = |node: usize| structure.nodes[node].position;
        let count = cluster.nodes.len() as f64;
        let centre: [f64; 3] = std::array::from_fn(|c| cluster.nodes.iter().map(|&n| place(n)[c]).sum::<f64>() / count);
        let distance = |node: &usize| distance(centre, place(*node));
        let size = cluster.nodes.iter().map(distance).fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        let mut of_part = HashMap::with_capacity(cluster.parts.len());
        let mut count = 0;
        for &part in &cluster.parts {
            let turns = parts.turns[part as usize];
            let mut unknowns = [usize::MAX; 6];
            for &component in structure.dimension.components().iter().filter(|c| turns || !c.is_rotation()) {
                unknowns[component as usize] = count;
                count += 1;
            }
            of_part.insert(part, unknowns);
        }
        Unknowns { structure, dofs, parts, of_part, count, centre, size, exact: false }
    }

    /// The same to the last digit: the size is a power of two, and the centre lies on a grid, so that levers stay short.
    fn exactly(&self) -> Unknowns<'a> {
        let size = self.size.log2().ceil().exp2();
        let grid = size * GRID;
        let centre = self.centre.map(|x| (x / grid).round() * grid);
        Unknowns { of_part: self.of_part.clone(), centre, size, exact: true, ..*self }
    }

    /// What the motions do to the joints, from those at each node; `None` where many equations hold the cluster.
    fn traces(
        &self,
        cluster: &Cluster,
        spins: &[Spin],
        (joints, joints_of): (&[Joint], &[Vec<usize>]),
    ) -> Option<Traces> {
        let rows = self.rows(cluster, spins);
        if !rows.is_empty() && self.count > MOST_TRACED {
            return None;
        }
        let near = self.null_space(cluster, &rows, EFFORT)?;
        Some(Traces { joints: self.moved_joints(cluster, joints, joints_of), rows, near })
    }

    /// What holds the cluster: each row is 0.
    fn rows(&self, cluster: &Cluster, spins: &[Spin]) -> Vec<Terms> {
        let mut rows: Vec<Terms> = [self.pins(cluster), self.given_resistance(), self.holders(cluster)].concat();
        if self.structure.dimension == Dimension::Space {
            rows.extend(self.torsions(cluster));
            let own = spins.iter().filter(|(part, _)| self.of_part.contains_key(part));
            rows.extend(own.map(|&(part, axis)| self.spin(part, axis).collect::<Terms>()));
        }
        rows
    }

    /// The null space of the rows; `None` where an elimination took more than `effort` additions or lost too many digits.
    fn null_space(&self, cluster: &Cluster, rows: &[Terms], effort: usize) -> Option<DMatrix<f64>> {
        let places = cluster.nodes.iter().flat_map(|&n| self.structure.nodes[n].position);
        let largest = places.fold(0.0_f64, |m, x| m.max(x.abs()));
        let null = NULL * (1.0 + largest / self.size);
        let space = null_space(rows, self.count, null, effort)?;
        (self.count <= DENSE || space.is_of(rows, null)).then_some(space.basis)
    }

    /// The motions of the cluster from the null space.
    fn motions(&self, cluster: &Cluster, near: &DMatrix<f64>) -> Vec<Motion> {
        let motion = |q: DVectorView<'_, f64>| {
            let mut u = vec![[0.0; 6]; self.structure.nodes.len()];
            for &node in &cluster.nodes {
                for &component in self.structure.dimension.components() {
                    let terms = self.of_node(node, component).unwrap_or_default();
                    let moved = terms.into_iter().map(|(i, a)| a * q[i]).sum::<f64>();
                    u[node][component as usize] = if component.is_rotation() { moved / self.size } else { moved };
                }
            }
            Motion { u, internal: false }
        };
        near.column_iter().map(motion).collect()
    }

    /// The mutual displacement of every joint that the cluster moves.
    fn moved_joints(&self, cluster: &Cluster, joints: &[Joint], joints_of: &[Vec<usize>]) -> Vec<(usize, Terms)> {
        let own: HashSet<usize> = cluster.nodes.iter().copied().collect();
        let touched: BTreeSet<usize> = cluster.nodes.iter().flat_map(|&node| joints_of[node].iter().copied()).collect();
        let mut moved = Vec::new();
        for index in touched {
            let mut row = Terms::new();
            for (node, a) in joints[index].terms.iter().filter(|(node, _)| own.contains(node)) {
                for (&component, a) in self.structure.dimension.translations().iter().zip(a) {
                    row.extend(self.times(*a, self.of_node(*node, component).unwrap_or_default()));
                }
            }
            if !row.is_empty() {
                moved.push((index, row));
            }
        }
        moved
    }

    /// A number, and what rounding leaves of it where that counts.
    fn parts_of(&self, number: Doubled) -> impl Iterator<Item = f64> {
        let rest = Some(number.tail()).filter(|rest| self.exact && *rest != 0.0);
        std::iter::once(number.to_f64()).chain(rest)
    }

    /// The terms of a multiple.
    fn times(&self, factor: f64, terms: Terms) -> impl Iterator<Item = (usize, f64)> {
        let of_term = move |(unknown, a)| self.parts_of(Doubled::product(factor, a)).map(move |part| (unknown, part));
        terms.into_iter().flat_map(of_term)
    }

    /// Displacement of a node as it moves with a part; rotations are multiplied by `size`.
    fn moved(&self, node: usize, part: u32, component: Component) -> Terms {
        let unknowns = self.of_part[&part];
        let place = self.structure.nodes[node].position;
        let mut terms = vec![(unknowns[component as usize], 1.0)];
        if !component.is_rotation() {
            let arm = std::array::from_fn(|c| Doubled::sum(place[c], -self.centre[c]));
            for (rotation, lever) in component.levers(arm) {
                let parts = self.parts_of(lever).map(|part| (unknowns[rotation as usize], part / self.size));
                terms.extend(parts);
            }
        }
        terms.retain(|(unknown, _)| *unknown != usize::MAX);
        terms
    }

    /// Displacement of a node; `None` for a rotation that it has not.
    fn of_node(&self, node: usize, component: Component) -> Option<Terms> {
        let part = if component.is_rotation() {
            self.parts.turning[node].filter(|_| self.dofs.of(node, component).is_some())?
        } else {
            self.parts.at_node[node][0]
        };
        Some(self.moved(node, part, component))
    }

    /// Parts that share a node move it alike.
    fn pins(&self, cluster: &Cluster) -> Vec<Terms> {
        let given: Option<HashSet<&(usize, Component)>> =
            self.structure.superelement.as_ref().map(|element| element.dofs.iter().collect());
        let mut rows = Vec::new();
        for &node in &cluster.nodes {
            for &other in &self.parts.at_node[node][1..] {
                for &component in self.structure.dimension.translations() {
                    // A superelement does not take part in a displacement that is none of its dofs.
                    if given.as_ref().is_some_and(|given| !given.contains(&(node, component))) {
                        continue;
                    }
                    let mut row = self.moved(node, self.parts.at_node[node][0], component);
                    row.extend(negative(self.moved(node, other, component)));
                    rows.push(row);
                }
            }
        }
        rows
    }

    /// Hinged bars turn with their nodes about their own axes.
    fn torsions(&self, cluster: &Cluster) -> Vec<Terms> {
        let mut rows = Vec::new();
        for &index in &cluster.hinged {
            let element = &self.structure.elements[index];
            let part = self.parts.of_element[index];
            let [a, b] = [0, 1].map(|end| self.structure.nodes[element.nodes[end]].position);
            let Some(axis) = unit(way(a, b)) else { continue };
            for (at, &node) in element.nodes.iter().enumerate() {
                let handed_on = !element.turns_with(at) && element.components(at).contains(&Component::Rx);
                let Some(with) = self.parts.turning[node].filter(|with| handed_on && *with != part) else { continue };
                rows.push(self.spin(part, axis).chain(negative(self.spin(with, axis).collect())).collect());
            }
        }
        rows
    }

    /// By how much a part turns about an axis.
    fn spin(&self, part: u32, axis: [f64; 3]) -> impl Iterator<Item = (usize, f64)> {
        let unknowns = self.of_part[&part];
        let turned = Component::ROTATIONS.map(|component| (unknowns[component as usize], axis[component.axis()]));
        turned.into_iter().filter(|(unknown, _)| *unknown != usize::MAX)
    }

    /// What the parts of a superelement resist.
    fn given_resistance(&self) -> Vec<Terms> {
        let mut rows = Vec::new();
        for (part, &number) in superelement_parts(self.structure).iter().zip(&self.parts.of_superelement) {
            let Some(unknowns) = self.of_part.get(&number) else { continue };
            let arm = way(self.centre, part.centre);
            let components = self.structure.dimension.components();
            for c in &part.resisted {
                let resisted = |wanted: Component| {
                    let mut sum = 0.0;
                    for (&component, c) in components.iter().zip(c) {
                        if component.is_rotation() {
                            sum += if component == wanted { c * part.size } else { 0.0 };
                        } else {
                            let levers = component.levers(arm).into_iter().filter(|(rotation, _)| *rotation == wanted);
                            sum += levers.map(|(_, lever)| c * lever).sum::<f64>();
                        }
                    }
                    sum / self.size
                };
                let terms = components.iter().zip(c).map(|(&component, c)| {
                    (unknowns[component as usize], if component.is_rotation() { resisted(component) } else { *c })
                });
                rows.push(terms.filter(|(unknown, _)| *unknown != usize::MAX).collect());
            }
        }
        rows
    }

    /// Supports hold, springs are not stretched, ties stay closed.
    fn holders(&self, cluster: &Cluster) -> Vec<Terms> {
        let mut rows = Vec::new();
        for &support in &cluster.supports {
            let support = &self.structure.supports[support];
            rows.extend(self.of_node(support.node, support.component));
        }
        let springs = cluster.springs.iter().map(|&spring| &self.structure.springs[spring]);
        for spring in springs.filter(|spring| spring.stiffness > 0.0) {
            let terms = spring
                .terms
                .iter()
                .filter_map(|term| Some(self.times(term.factor, self.of_node(term.node, term.component)?)));
            rows.push(terms.flatten().collect());
        }
        for tie in cluster.ties.iter().map(|&tie| &self.structure.ties[tie]) {
            for &component in &tie.components {
                let mut terms = tie.nodes.iter().filter_map(|&node| self.of_node(node, component));
                let Some(first) = terms.next() else { continue };
                for other in terms {
                    let mut row = first.clone();
                    row.extend(negative(other));
                    rows.push(row);
                }
            }
        }
        rows
    }
}
