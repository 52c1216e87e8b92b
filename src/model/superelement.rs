//! A body of which only K and F are known, computed by another program; and the rigid motions that K leaves free.

use nalgebra::DMatrix;

use super::dimension::Dimension;
use super::groups::Groups;
use super::left_by_rounding::is_left_by_rounding;
use super::node::{Component, Node};
use super::vector::way;

/// A row of K u below this share of its terms is zero by the digits of K.
const DIGITS: f64 = 64.0 * f64::EPSILON;

/// Below this share it is what a condensation (K_bb − K_bi K_ii⁻¹ K_ib) leaves of zero: ε times the condition of K_ii,
/// which is up to some 1e5 in a body of usual proportions. What is taken as free on this ground is reported.
const CONDENSED: f64 = 1e-10;

/// Singular values below this are examined.
const NEARLY: f64 = 1e-9;

/// Parts with more rows are not corrected: the corrected K is dense.
const MOST_ROWS: usize = 3000;

/// K on some displacement components of nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Superelement {
    /// The file of K.
    pub file: String,
    /// Node and component of each row of K.
    pub dofs: Vec<(usize, Component)>,
    /// The lower triangle of K: (row, column, value), row ≥ column, each place once.
    pub entries: Vec<(usize, usize, f64)>,
    /// Its connected parts.
    pub parts: Vec<Part>,
}

/// Nodes that K joins, and how they can move as one rigid body.
///
/// A rigid motion is q = (t, θ · size) about `centre`, in the order of the components of the plane or of space:
/// u = t + θ × (x − centre).
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its nodes.
    pub nodes: Vec<usize>,
    /// The point about which it turns.
    pub centre: [f64; 3],
    /// Largest distance of a coordinate from there, or 1.
    pub size: f64,
    /// Unit vectors c: motions with c·q = 0 cost nothing; as many as components where K resists every motion.
    pub resisted: Vec<Vec<f64>>,
}

impl Superelement {
    /// Finds the parts and their free motions; K is put right where it resists a rigid motion by rounding alone. Also
    /// returns what has to be said of that.
    pub fn new(
        dimension: Dimension,
        nodes: &[Node],
        file: &str,
        dofs: Vec<(usize, Component)>,
        entries: Vec<(usize, usize, f64)>,
    ) -> (Superelement, Vec<String>) {
        let element = Superelement { file: file.to_owned(), dofs, entries, parts: Vec::new() };
        let cleared = element.without_rounding();
        let (as_given, notes) = element.with_parts(dimension, nodes);
        // Each motion that only rounding resists is noted.
        if notes.is_empty() || cleared.entries.len() == as_given.entries.len() {
            return (as_given, notes);
        }
        let left = as_given.entries.len() - cleared.entries.len();
        let (cleared, mut others) = cleared.with_parts(dimension, nodes);
        if cleared.free_count(dimension) <= as_given.free_count(dimension) {
            return (as_given, notes);
        }
        others.push(format!(
            "{left} entries of the stiffness are what rounding leaves of zero (below 1e-12 of the roots of their diagonals): taken as 0, \
             they do not hinder rigid motions"
        ));
        (cleared, others)
    }

    /// How many rigid motions of its parts cost nothing.
    fn free_count(&self, dimension: Dimension) -> usize {
        self.parts.iter().map(|part| dimension.components().len() - part.resisted.len()).sum()
    }

    /// Without the entries that may be [rounding](is_left_by_rounding).
    fn without_rounding(&self) -> Superelement {
        let mut roots = vec![0.0; self.dofs.len()];
        let diagonal = self.entries.iter().filter(|(i, j, _)| i == j);
        diagonal.for_each(|&(i, _, value)| roots[i] = value.max(0.0).sqrt());
        let mut cleared = self.clone();
        cleared.entries.retain(|&(i, j, value)| i == j || !is_left_by_rounding(value, [roots[i], roots[j]]));
        cleared
    }

    fn with_parts(mut self, dimension: Dimension, nodes: &[Node]) -> (Superelement, Vec<String>) {
        let mut notes = Vec::new();
        let part_of = self.part_of_nodes(nodes.len());
        let count = part_of.iter().flatten().max().map_or(0, |last| last + 1);
        let mut rows: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (row, (node, _)) in self.dofs.iter().enumerate() {
            if let Some(part) = part_of[*node] {
                rows[part].push(row);
            }
        }
        for rows in &rows {
            let part = self.part(dimension, nodes, rows, &mut notes);
            self.parts.push(part);
        }
        (self, notes)
    }

    /// The part of every node that has a row, counted from 0.
    fn part_of_nodes(&self, nodes: usize) -> Vec<Option<usize>> {
        let mut groups = Groups::new(nodes);
        for &(i, j, _) in self.entries.iter().filter(|(_, _, value)| *value != 0.0) {
            groups.join(self.dofs[i].0, self.dofs[j].0);
        }
        let mut part_of = vec![None; nodes];
        let numbers = groups.numbers(self.dofs.iter().map(|&(node, _)| node));
        for (&(node, _), part) in self.dofs.iter().zip(numbers) {
            part_of[node] = Some(part);
        }
        part_of
    }

    fn part(&mut self, dimension: Dimension, nodes: &[Node], rows: &[usize], notes: &mut Vec<String>) -> Part {
        let mut own: Vec<usize> = rows.iter().map(|&row| self.dofs[row].0).collect();
        own.sort_unstable();
        own.dedup();
        let place = |node: usize, c: usize| nodes[node].position[c];
        let mean = |c: usize| own.iter().map(|&node| place(node, c)).sum::<f64>() / own.len() as f64;
        let centre = [0, 1, 2].map(mean);
        let reach = |node: &usize| [0, 1, 2].map(|c| (place(*node, c) - centre[c]).abs());
        let size = own.iter().flat_map(reach).fold(0.0, f64::max);
        let mut part = Part { nodes: own, centre, size: if size > 0.0 { size } else { 1.0 }, resisted: Vec::new() };
        let moved = |&row: &usize| part.moved(dimension, nodes, self.dofs[row]);
        let rigid: Vec<Vec<f64>> = rows.iter().map(moved).collect();
        let free = self.free_motions(rows, &rigid);
        let names: &[&str] = match dimension {
            Dimension::Plane => &["along x", "along y", "round"],
            Dimension::Space => &["along x", "along y", "along z", "about x", "about y", "about z"],
        };
        let words = |q: &[f64]| {
            let moved = q.iter().zip(names.iter().copied()).filter(|(q, _)| q.abs() > 1e-6).map(|(_, name)| name);
            moved.collect::<Vec<_>>().join(" and ")
        };
        let near = free.iter().filter(|(_, share)| *share > DIGITS);
        let mut at = nodes[part.nodes[0]].id.clone();
        if part.nodes.len() > 1 {
            at = format!("{at} and what hangs on it");
        }
        for (q, share) in near.clone() {
            let what =
                format!("the stiffness resists the rigid motion {} of {at} with {share:.1e} of its terms", words(q));
            notes.push(if *share <= CONDENSED && rows.len() <= MOST_ROWS {
                format!("{what}: rounding of its digits, taken as free")
            } else {
                format!("{what}, little but more than its digits leave: taken as it is; if nothing holds the body, give more digits")
            });
        }
        let free: Vec<(Vec<f64>, f64)> = free.into_iter().filter(|(_, share)| *share <= CONDENSED).collect();
        if free.iter().any(|(_, share)| *share > DIGITS) {
            if rows.len() <= MOST_ROWS {
                let motions: Vec<Vec<f64>> =
                    free.iter().map(|(q, _)| rigid.iter().map(|v| dot(v, q)).collect()).collect();
                self.take_out(rows, &motions);
            } else {
                let exact: Vec<Vec<f64>> = free.into_iter().filter(|(_, s)| *s <= DIGITS).map(|(q, _)| q).collect();
                part.resisted = complement(&exact, names.len());
                return part;
            }
        }
        part.resisted = complement(&free.into_iter().map(|(q, _)| q).collect::<Vec<_>>(), names.len());
        part
    }

    /// Rigid motions that K resists by less than 1e-9 of its terms, each with the share it does: the largest
    /// |(K u)_i| / Σ |K_ij||u_j|.
    fn free_motions(&self, rows: &[usize], rigid: &[Vec<f64>]) -> Vec<(Vec<f64>, f64)> {
        let count = rigid.first().map_or(0, Vec::len);
        let mut local = vec![usize::MAX; self.dofs.len()];
        for (at, &row) in rows.iter().enumerate() {
            local[row] = at;
        }
        let mut diagonal = vec![0.0_f64; rows.len()];
        let mut own = Vec::new();
        for &(i, j, value) in self.entries.iter().filter(|(i, ..)| local[*i] != usize::MAX) {
            let (i, j) = (local[i], local[j]);
            own.push((i, j, value));
            if i != j {
                own.push((j, i, value));
            } else {
                diagonal[i] = value;
            }
        }
        // (K V)_i and Σ |K_ij||V_j| by rows scaled to unit diagonal.
        let mut forces = DMatrix::<f64>::zeros(rows.len() + count, count);
        let mut largest = 0.0_f64;
        let mut sums = vec![0.0_f64; rows.len()];
        for &(i, j, value) in &own {
            if diagonal[i] > 0.0 {
                let root = diagonal[i].sqrt();
                for c in 0..count {
                    forces[(i, c)] += value * rigid[j][c] / root;
                }
                sums[i] += (value / root).abs() * rigid[j].iter().map(|v| v.abs()).sum::<f64>();
                largest = largest.max(sums[i]);
            }
        }
        if largest > 0.0 {
            forces /= largest;
        }
        // Motions that move no displacement at all do not count.
        let moves = DMatrix::from_fn(rows.len(), count, |i, c| rigid[i][c]);
        for (k, idle) in small_directions(moves, NEARLY).into_iter().enumerate() {
            for c in 0..count {
                forces[(rows.len() + k, c)] = idle[c];
            }
        }
        let share = |q: &[f64]| {
            let u: Vec<f64> = rigid.iter().map(|v| dot(v, q)).collect();
            let (mut force, mut terms) = (vec![0.0; u.len()], vec![0.0; u.len()]);
            for &(i, j, value) in &own {
                force[i] += value * u[j];
                terms[i] += (value * u[j]).abs();
            }
            let shares = std::iter::zip(&force, &terms).filter(|(force, _)| **force != 0.0).map(|(f, t)| (f / t).abs());
            shares.fold(0.0, f64::max)
        };
        let candidates = echelon(small_directions(forces, NEARLY));
        let with_share = |q: Vec<f64>| {
            let share = share(&q);
            (q, share)
        };
        candidates.into_iter().map(with_share).collect()
    }

    /// Makes K of these rows cost exactly nothing in the motions: (1 − Q Qᵀ) S (1 − Q Qᵀ) with S = K at unit diagonal.
    fn take_out(&mut self, rows: &[usize], motions: &[Vec<f64>]) {
        let n = rows.len();
        let mut local = vec![usize::MAX; self.dofs.len()];
        for (at, &row) in rows.iter().enumerate() {
            local[row] = at;
        }
        let mut k = DMatrix::<f64>::zeros(n, n);
        for &(i, j, value) in self.entries.iter().filter(|(i, ..)| local[*i] != usize::MAX) {
            k[(local[i], local[j])] = value;
            k[(local[j], local[i])] = value;
        }
        let scale: Vec<f64> = k.diagonal().iter().map(|d| if *d > 0.0 { d.sqrt() } else { 1.0 }).collect();
        let mut s = DMatrix::from_fn(n, n, |i, j| k[(i, j)] / scale[i] / scale[j]);
        let q = DMatrix::from_fn(n, motions.len(), |i, m| motions[m][i] * scale[i]).qr().q();
        // Twice: what the first pass leaves is rounding of large terms, what the second leaves of small ones.
        for _ in 0..2 {
            let y = &s * &q;
            let y = &y - &q * (q.transpose() * &y) * 0.5;
            s -= &q * y.transpose() + &y * q.transpose();
        }
        self.entries.retain(|(i, ..)| local[*i] == usize::MAX);
        for j in 0..n {
            for i in j..n {
                let value = 0.5 * (s[(i, j)] + s[(j, i)]) * scale[i] * scale[j];
                if value != 0.0 {
                    let (a, b) = (rows[i].max(rows[j]), rows[i].min(rows[j]));
                    self.entries.push((a, b, value));
                }
            }
        }
    }
}

impl Part {
    /// What each rigid motion does to a displacement.
    fn moved(&self, dimension: Dimension, nodes: &[Node], (node, component): (usize, Component)) -> Vec<f64> {
        let arm = way(self.centre, nodes[node].position).map(|arm| arm / self.size);
        let of = |motion: Component| match (motion.is_rotation(), component.is_rotation()) {
            (false, _) => f64::from(motion == component),
            (true, true) => f64::from(motion == component) / self.size,
            (true, false) => component
                .levers(arm)
                .into_iter()
                .find(|(rotation, _)| *rotation == motion)
                .map_or(0.0, |(_, lever)| lever),
        };
        dimension.components().iter().map(|&motion| of(motion)).collect()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Directions q with |A q| ≤ limit.
fn small_directions(a: DMatrix<f64>, limit: f64) -> Vec<Vec<f64>> {
    let columns = a.ncols();
    let a = if a.nrows() < columns { a.resize_vertically(columns, 0.0) } else { a };
    let svd = a.svd(false, true);
    let Some(v) = svd.v_t else { return Vec::new() };
    let small = svd.singular_values.iter().zip(v.row_iter()).filter(|(sigma, _)| **sigma <= limit);
    small.map(|(_, v)| v.iter().copied().collect()).collect()
}

/// The same span by simple vectors: each has a leading one where the others are 0.
fn echelon(mut basis: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut done = 0;
    for c in 0..basis.first().map_or(0, Vec::len) {
        let Some(best) = (done..basis.len()).max_by(|&a, &b| basis[a][c].abs().total_cmp(&basis[b][c].abs())) else {
            break;
        };
        if basis[best][c].abs() < 1e-6 {
            continue;
        }
        basis.swap(done, best);
        let pivot = basis[done][c];
        basis[done].iter_mut().for_each(|q| *q /= pivot);
        let lead = basis[done].clone();
        for (_, q) in basis.iter_mut().enumerate().filter(|(i, _)| *i != done) {
            let factor = q[c];
            q.iter_mut().zip(&lead).for_each(|(q, lead)| *q -= factor * lead);
        }
        done += 1;
    }
    // Rounding of unit vectors.
    basis.iter_mut().flatten().filter(|q| q.abs() < 1e-14).for_each(|q| *q = 0.0);
    basis
}

/// Orthonormal vectors of `count` entries that span what is orthogonal to `motions`.
fn complement(motions: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let units = (0..count).map(|unit| (0..count).map(|c| f64::from(c == unit)).collect());
    for mut rest in motions.iter().cloned().chain(units) {
        let before = dot(&rest, &rest).sqrt();
        for _ in 0..2 {
            for one in &basis {
                let share = dot(one, &rest);
                rest.iter_mut().zip(one).for_each(|(rest, one)| *rest -= share * one);
            }
        }
        let left = dot(&rest, &rest).sqrt();
        if left > 1e-9 * before {
            basis.push(rest.into_iter().map(|q| q / left).collect());
        }
    }
    basis.split_off(motions.len().min(basis.len()))
}
