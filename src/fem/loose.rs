//! Motions that cost no energy when every contact joint is off: the kernel of K from the rigid motions of parts.
//!
//! A *part* is a set of elements that can only move as one rigid body: elements with a common edge, frame bars
//! rigidly attached to one node, a rigid body and elements with two nodes in it; a lone node is a part without rotation. A part of a superelement moves as its stiffness lets it. Parts that share a node are
//! pinned there.
//! Parts linked by pins and ties make a *cluster*. In each cluster the motions q (a translation and a rotation per
//! part) that open no pin and no tie, move no support and stretch no spring are the null space of a small matrix;
//! testing motions one by one would miss a rotation about a pin or a tie.
//!
//! In a cluster of very many parts (a large truss) elements joined by common nodes are taken as one part; its
//! internal mechanisms, if it has any, are found from the eigenvalues of R instead (see `main_system`).

use std::collections::HashSet;

use nalgebra::{DMatrix, DVector};

use super::dense::svd;
use super::dof::{Dofs, root};
use crate::model::structure::{Component, Structure};
use crate::model::superelement::Part;

/// Singular values below this share of the largest belong to the null space, times the rounding of the coordinates
/// beside the size of the cluster.
const NULL: f64 = 1024.0 * f64::EPSILON;

/// Clusters with more motion parameters than this are taken apart into whole groups only.
const MANY: usize = 240;

/// A motion of the whole structure, [u_x, u_y, θ] per node, largest translation (or rotation × size) about 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Displacements per node; θ = 0 where there is no rotation.
    pub u: Vec<[f64; 3]>,
    /// Whether parts of one connected group move against each other (a mechanism inside the structure), as far as
    /// that was seen from the stiffness rather than from rigid parts.
    pub internal: bool,
}

/// Basis of the motions that cost no energy with all joints off: translations along x, along y, then rotations,
/// as far as the cluster allows.
pub fn loose_motions(structure: &Structure, dofs: &Dofs) -> Vec<Motion> {
    let parts = Parts::new(structure);
    let clusters = parts.clusters(structure);
    let mut motions = Vec::new();
    for cluster in clusters {
        let null_space =
            if 3 * cluster.parts.len() <= MANY { cluster.null_space(structure, dofs, &parts) } else { None };
        match null_space {
            Some(space) => motions.extend(space),
            None => {
                let (merged, cluster) = cluster.with_whole_groups(structure);
                motions.extend(cluster.null_space(structure, dofs, &merged).unwrap_or_default());
            }
        }
    }
    motions
}

/// Parts at every node.
struct Parts {
    /// Part numbers at each node; the first moves it, all others are pinned to that.
    at_node: Vec<Vec<u32>>,
    /// The part that turns with the rotation of the node.
    turning: Vec<Option<u32>>,
    /// Whether a part can turn (is more than a lone node).
    turns: Vec<bool>,
    /// The part of each part of the superelement; `u32::MAX` for one that lies in another cluster.
    of_superelement: Vec<u32>,
}

/// The parts of the superelement, if there is one.
fn superelement_parts(structure: &Structure) -> &[Part] {
    structure.superelement.as_ref().map_or(&[], |element| &element.parts)
}

impl Parts {
    fn new(structure: &Structure) -> Parts {
        // Rigid bodies count as elements, after the others, and so do the parts of a superelement.
        let elements = structure.elements.len();
        let beyond = elements + structure.rigid.len();
        let given = superelement_parts(structure);
        let mut parent: Vec<u32> = (0..(beyond + given.len()) as u32).collect();
        let mut join = |a: u32, b: u32| {
            let (a, b) = (root(&mut parent, a as usize), root(&mut parent, b as usize));
            parent[a.max(b)] = a.min(b) as u32;
        };
        // Elements that share an edge.
        let mut edges = Vec::new();
        for (index, element) in structure.elements.iter().enumerate() {
            edges.extend(element.sides().map(|[a, b]| (a.min(b) as u32, a.max(b) as u32, index as u32)));
        }
        edges.sort_unstable();
        for pair in edges.windows(2) {
            if (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1) {
                join(pair[0].2, pair[1].2);
            }
        }
        // Elements with two nodes in one body.
        let body_of = structure.body_of_nodes();
        for (index, element) in structure.elements.iter().enumerate() {
            let bodies: Vec<usize> = element.nodes.iter().filter_map(|&node| body_of[node]).collect();
            for (at, &body) in bodies.iter().enumerate() {
                if bodies[..at].contains(&body) {
                    join(index as u32, (elements + body) as u32);
                }
            }
        }
        // Frame bars rigidly attached to one node, or to a body.
        let mut turning: Vec<Option<u32>> =
            body_of.iter().map(|body| body.map(|body| (elements + body) as u32)).collect();
        for (index, element) in structure.elements.iter().enumerate() {
            for (end, &node) in element.nodes.iter().enumerate() {
                if element.components(end).contains(&Component::R) {
                    match turning[node] {
                        Some(other) => join(index as u32, other),
                        None => turning[node] = Some(index as u32),
                    }
                }
            }
        }
        if let Some(element) = &structure.superelement {
            let mut part_of = vec![None; structure.nodes.len()];
            for (index, part) in given.iter().enumerate() {
                part.nodes.iter().for_each(|&node| part_of[node] = Some((beyond + index) as u32));
            }
            for &(node, _) in element.dofs.iter().filter(|(_, component)| *component == Component::R) {
                match (turning[node], part_of[node]) {
                    (Some(body), Some(part)) => join(part, body),
                    (_, part) => turning[node] = part,
                }
            }
        }
        // Number the parts; lone nodes come last.
        let mut number = vec![u32::MAX; parent.len()];
        let mut turns = Vec::new();
        let mut part_of = |parent: &mut Vec<u32>, element: usize| {
            let element = root(parent, element);
            if number[element] == u32::MAX {
                number[element] = turns.len() as u32;
                turns.push(true);
            }
            number[element]
        };
        let mut at_node: Vec<Vec<u32>> = vec![Vec::new(); structure.nodes.len()];
        let elements = structure.elements.iter().map(|element| &element.nodes);
        let bodies = structure.rigid.iter().map(|body| &body.nodes);
        let parts = given.iter().map(|part| &part.nodes);
        for (index, nodes) in elements.chain(bodies).chain(parts).enumerate() {
            let part = part_of(&mut parent, index);
            for &node in nodes {
                if !at_node[node].contains(&part) {
                    at_node[node].push(part);
                }
            }
        }
        for turning in turning.iter_mut().flatten() {
            *turning = part_of(&mut parent, *turning as usize);
        }
        let of_superelement = (0..given.len()).map(|part| part_of(&mut parent, beyond + part)).collect();
        for parts in at_node.iter_mut().filter(|parts| parts.is_empty()) {
            parts.push(turns.len() as u32);
            turns.push(false);
        }
        Parts { at_node, turning, turns, of_superelement }
    }

    /// Parts linked by pins, ties and springs.
    fn clusters(&self, structure: &Structure) -> Vec<Cluster> {
        let mut parent: Vec<u32> = (0..self.turns.len() as u32).collect();
        let mut join = |a: u32, b: u32| {
            let (a, b) = (root(&mut parent, a as usize), root(&mut parent, b as usize));
            parent[a.max(b)] = a.min(b) as u32;
        };
        for parts in &self.at_node {
            parts[1..].iter().for_each(|&other| join(parts[0], other));
        }
        for tie in &structure.ties {
            for nodes in tie.nodes.windows(2) {
                join(self.at_node[nodes[0]][0], self.at_node[nodes[1]][0]);
            }
        }
        for spring in &structure.springs {
            for nodes in spring.nodes().windows(2) {
                join(self.at_node[nodes[0]][0], self.at_node[nodes[1]][0]);
            }
        }
        let mut cluster_of = vec![usize::MAX; self.turns.len()];
        let mut clusters: Vec<Cluster> = Vec::new();
        for part in 0..self.turns.len() {
            let first = root(&mut parent, part);
            if cluster_of[first] == usize::MAX {
                cluster_of[first] = clusters.len();
                clusters.push(Cluster::default());
            }
            cluster_of[part] = cluster_of[first];
            clusters[cluster_of[part]].parts.push(part as u32);
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
}

impl Cluster {
    /// This cluster with one part per group of elements joined by common nodes; tied groups stay apart.
    fn with_whole_groups(self, structure: &Structure) -> (Parts, Cluster) {
        let mut parent: Vec<u32> = (0..structure.nodes.len() as u32).collect();
        let elements = structure.elements.iter().map(|element| &element.nodes);
        let given = superelement_parts(structure);
        let bodies = structure.rigid.iter().map(|body| &body.nodes).chain(given.iter().map(|part| &part.nodes));
        for nodes in elements.chain(bodies) {
            for nodes in nodes.windows(2) {
                let (a, b) = (root(&mut parent, nodes[0]), root(&mut parent, nodes[1]));
                parent[a.max(b)] = a.min(b) as u32;
            }
        }
        let mut number = vec![u32::MAX; structure.nodes.len()];
        let mut turns: Vec<bool> = Vec::new();
        let mut at_node = vec![Vec::new(); structure.nodes.len()];
        let mut turning = vec![None; structure.nodes.len()];
        for &node in &self.nodes {
            let group = root(&mut parent, node);
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
        let merged = Parts { at_node, turning, turns, of_superelement };
        (merged, Cluster { parts, ..self })
    }

    /// Motions of the cluster; `None` if the decomposition did not converge.
    fn null_space(&self, structure: &Structure, dofs: &Dofs, parts: &Parts) -> Option<Vec<Motion>> {
        let place = |node: usize| structure.nodes[node].position;
        let count = self.nodes.len() as f64;
        let centre: [f64; 2] = std::array::from_fn(|c| self.nodes.iter().map(|&n| place(n)[c]).sum::<f64>() / count);
        let size =
            self.nodes.iter().map(|&n| (place(n)[0] - centre[0]).hypot(place(n)[1] - centre[1])).fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };

        // Columns: translations and scaled rotation of each part, in the order x, y, r of the first part, …
        let mut column = vec![[usize::MAX; 3]; parts.turns.len()];
        let mut columns = 0;
        for &part in &self.parts {
            let wide = if parts.turns[part as usize] { 3 } else { 2 };
            for slot in column[part as usize].iter_mut().take(wide) {
                *slot = columns;
                columns += 1;
            }
        }
        // Displacement of a node as it moves with a part: x, y, and θ · size.
        let moved = |node: usize, part: u32, component: Component| {
            let column = column[part as usize];
            let arm = [0, 1].map(|c| (place(node)[c] - centre[c]) / size);
            let mut terms = Vec::with_capacity(2);
            let (own, turned) = match component {
                Component::X => (Some(0), -arm[1]),
                Component::Y => (Some(1), arm[0]),
                Component::R => (None, 1.0),
            };
            terms.extend(own.map(|own| (column[own], 1.0)));
            if column[2] != usize::MAX {
                terms.push((column[2], turned));
            }
            terms
        };
        let with_node = |node: usize, component: Component| match component {
            Component::R => parts.turning[node]
                .filter(|_| dofs.of(node, Component::R).is_some())
                .map(|part| moved(node, part, component)),
            _ => Some(moved(node, parts.at_node[node][0], component)),
        };

        let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
        let negative = |terms: Vec<(usize, f64)>| terms.into_iter().map(|(c, a)| (c, -a));
        let given: Option<HashSet<&(usize, Component)>> =
            structure.superelement.as_ref().map(|element| element.dofs.iter().collect());
        for &node in &self.nodes {
            for &other in &parts.at_node[node][1..] {
                for component in [Component::X, Component::Y] {
                    // Of a displacement that a superelement does not know nothing follows for it.
                    if given.as_ref().is_some_and(|given| !given.contains(&(node, component))) {
                        continue;
                    }
                    let mut row = moved(node, parts.at_node[node][0], component);
                    row.extend(negative(moved(node, other, component)));
                    rows.push(row);
                }
            }
        }
        for (part, &number) in superelement_parts(structure).iter().zip(&parts.of_superelement) {
            let Some(columns) = column.get(number as usize).filter(|columns| columns[0] != usize::MAX) else {
                continue;
            };
            let arm = [0, 1].map(|c| part.centre[c] - centre[c]);
            for c in &part.resisted {
                let turned = (c[1] * arm[0] - c[0] * arm[1] + c[2] * part.size) / size;
                let terms = columns.iter().copied().zip([c[0], c[1], turned]);
                rows.push(terms.filter(|(column, _)| *column != usize::MAX).collect());
            }
        }
        for &support in &self.supports {
            let support = &structure.supports[support];
            rows.extend(with_node(support.node, support.component));
        }
        for &spring in &self.springs {
            let spring = &structure.springs[spring];
            if spring.stiffness > 0.0 {
                let terms = spring.terms.iter().filter_map(|term| {
                    let terms = with_node(term.node, term.component)?;
                    Some(terms.into_iter().map(|(i, a)| (i, term.factor * a)))
                });
                rows.push(terms.flatten().collect());
            }
        }
        for &tie in &self.ties {
            let tie = &structure.ties[tie];
            for &component in &tie.components {
                let mut terms = tie.nodes.iter().filter_map(|&n| with_node(n, component));
                let Some(first) = terms.next() else { continue };
                for other in terms {
                    let mut row = first.clone();
                    row.extend(negative(other));
                    rows.push(row);
                }
            }
        }

        let largest = self.nodes.iter().flat_map(|&n| place(n)).fold(0.0_f64, |m, x| m.max(x.abs()));
        let basis = null_basis(&rows, columns, NULL * (1.0 + largest / size))?;
        let motions = basis.column_iter().map(|q| {
            let mut u = vec![[0.0; 3]; structure.nodes.len()];
            for &node in &self.nodes {
                let component = |c| {
                    let terms = with_node(node, c).unwrap_or_default();
                    terms.into_iter().map(|(i, a)| a * q[i]).sum::<f64>()
                };
                u[node] = [component(Component::X), component(Component::Y), component(Component::R) / size];
            }
            Motion { u, internal: false }
        });
        Some(motions.collect())
    }
}

/// Basis of the null space of sparse rows, in echelon form: each vector has a leading one where the others are 0.
/// Singular values below the share `null` of the largest count as zero.
fn null_basis(rows: &[Vec<(usize, f64)>], columns: usize, null: f64) -> Option<DMatrix<f64>> {
    let mut a = DMatrix::zeros(rows.len(), columns);
    for (i, row) in rows.iter().enumerate() {
        for &(j, value) in row {
            a[(i, j)] += value;
        }
    }
    let svd = svd(&a)?;
    let largest = svd.sigma.first().copied().unwrap_or(0.0);
    let mut basis: Vec<DVector<f64>> = std::iter::zip(&svd.sigma, svd.v.column_iter())
        .filter(|(sigma, _)| **sigma <= null * largest)
        .map(|(_, vector)| vector.into_owned())
        .collect();
    // Gauss–Jordan on the vectors, pivots from the left.
    let mut done = 0;
    for column in 0..columns {
        let Some(best) = (done..basis.len()).max_by(|&a, &b| basis[a][column].abs().total_cmp(&basis[b][column].abs()))
        else {
            break;
        };
        if basis[best][column].abs() < 1e-6 {
            continue;
        }
        basis.swap(done, best);
        let pivot = basis[done][column];
        basis[done] /= pivot;
        let leading = basis[done].clone();
        for (i, vector) in basis.iter_mut().enumerate() {
            if i != done {
                let factor = vector[column];
                vector.axpy(-factor, &leading, 1.0);
            }
        }
        done += 1;
    }
    for vector in &mut basis {
        vector.apply(|x| {
            if x.abs() < 1e-13 {
                *x = 0.0;
            }
        });
    }
    let mut out = DMatrix::zeros(columns, basis.len());
    for (i, vector) in basis.iter().enumerate() {
        out.set_column(i, vector);
    }
    Some(out)
}
