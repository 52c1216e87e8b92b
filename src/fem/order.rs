//! The order in which the unknowns of the main system are eliminated: nested dissection of its nodes.
//!
//! The nodes are cut in two where the fewest of them touch the other side, straight across one of the axes; the cut
//! comes after both halves, and so on in each half. What is small enough is ordered by approximate minimum degree. Of a
//! plate this leaves less fill than minimum degree alone, and much less where many rows have to come last anyway: a
//! half then reaches only those that it touches.

use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use stickslip_numerics::analysis::minimum_degree_order;

use super::error::MainSystemError;
use super::sparse::SymmetricSparse;
use super::threads::can_spread;
use super::watch::check_stop;
use crate::watch::Watch;

/// A stretch of at most this many nodes is not cut further.
const LEAF: usize = 64;
/// Halves of more nodes are ordered on two threads.
const WORTH_SPREADING: usize = 4096;
/// Stands for a number that is missing.
const NONE: u32 = u32::MAX;

/// Where the unknowns are.
#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    /// Node of each unknown.
    pub node: &'a [u32],
    /// Coordinates of each node.
    pub coordinates: &'a [[f64; 3]],
    /// Whether each unknown has to come after all others.
    pub last: &'a [bool],
}

/// The order of the rows of `k`: entry i is the row at position i.
///
/// # Errors
/// Out of memory; interrupted.
pub fn elimination_order(k: &SymmetricSparse, places: Places, watch: &dyn Watch) -> Result<Vec<u32>, MainSystemError> {
    let n = k.order();
    let groups = Groups::new(places);
    let count = groups.points.len();
    let dissection = Dissection {
        neighbors: Neighbors::new(k, &groups),
        points: &groups.points,
        side: (0..count).map(|_| AtomicU32::new(NONE)).collect(),
        done: AtomicUsize::new(0),
        is_spread: count > WORTH_SPREADING && can_spread(),
        watch,
    };
    let mut all: Vec<u32> = (0..count as u32).collect();
    let mut of_groups = vec![0; count];
    // Across an axis along which nothing is spread there is no cut.
    let flat = |axis: usize| groups.points.windows(2).all(|two| two[0][axis] == two[1][axis]);
    let expected = [0, 1, 2].map(|axis| if axis == 2 && flat(axis) { f64::INFINITY } else { 0.0 });
    dissection.dissect(&mut all, &mut of_groups, 1, expected)?;
    let mut order = Vec::with_capacity(n);
    for &group in &of_groups {
        let range = groups.start[group as usize]..groups.start[group as usize + 1];
        order.extend_from_slice(&groups.rows[range]);
    }
    order.extend((0..n as u32).filter(|&row| places.last[row as usize]));
    Ok(order)
}

/// The unknowns that need not come last, node by node.
struct Groups {
    /// Start of each group in `rows`.
    start: Vec<usize>,
    rows: Vec<u32>,
    points: Vec<[f64; 3]>,
    /// Group of each row; `NONE` for those that come last.
    of_row: Vec<u32>,
}

impl Groups {
    fn new(places: Places) -> Groups {
        let mut of_node = vec![NONE; places.coordinates.len()];
        let mut of_row = vec![NONE; places.node.len()];
        let (mut points, mut start) = (Vec::new(), vec![0_usize]);
        for (row, &node) in places.node.iter().enumerate() {
            if places.last[row] {
                continue;
            }
            let group = &mut of_node[node as usize];
            if *group == NONE {
                *group = points.len() as u32;
                points.push(places.coordinates[node as usize]);
                start.push(0);
            }
            of_row[row] = *group;
            start[*group as usize + 1] += 1;
        }
        for group in 0..points.len() {
            start[group + 1] += start[group];
        }
        let mut next = start.clone();
        let mut rows = vec![0_u32; start[points.len()]];
        for (row, &group) in of_row.iter().enumerate() {
            if group != NONE {
                rows[next[group as usize]] = row as u32;
                next[group as usize] += 1;
            }
        }
        Groups { start, rows, points, of_row }
    }
}

/// Which groups are coupled, both ways; some twice.
struct Neighbors {
    start: Vec<usize>,
    groups: Vec<u32>,
}

impl Neighbors {
    fn new(k: &SymmetricSparse, groups: &Groups) -> Neighbors {
        let count = groups.points.len();
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(4 * count);
        // The group that last coupled to each.
        let mut seen = vec![NONE; count];
        for group in 0..count {
            for &column in &groups.rows[groups.start[group]..groups.start[group + 1]] {
                for (row, _) in k.column(column as usize) {
                    let other = groups.of_row[row];
                    if [NONE, group as u32].contains(&other) || seen[other as usize] == group as u32 {
                        continue;
                    }
                    seen[other as usize] = group as u32;
                    pairs.push((group as u32, other));
                }
            }
        }
        let mut start = vec![0_usize; count + 1];
        for &(a, b) in &pairs {
            start[a as usize + 1] += 1;
            start[b as usize + 1] += 1;
        }
        for group in 0..count {
            start[group + 1] += start[group];
        }
        let mut next = start.clone();
        let mut neighbors = vec![0_u32; start[count]];
        for &(a, b) in &pairs {
            for (from, to) in [(a, b), (b, a)] {
                neighbors[next[from as usize]] = to;
                next[from as usize] += 1;
            }
        }
        Neighbors { start, groups: neighbors }
    }

    fn of(&self, group: u32) -> &[u32] {
        &self.groups[self.start[group as usize]..self.start[group as usize + 1]]
    }
}

/// The halves are ordered side by side; what one marks, the other does not take for its own.
struct Dissection<'a> {
    neighbors: Neighbors,
    points: &'a [[f64; 3]],
    /// Mark of the side of a cut that each group was put on last.
    side: Vec<AtomicU32>,
    /// Groups that have been ordered.
    done: AtomicUsize,
    /// Whether there are threads for it.
    is_spread: bool,
    watch: &'a dyn Watch,
}

impl Dissection<'_> {
    /// Writes the order of some groups to `out`. `number` of this stretch: 1 for all, 2 k and 2 k + 1 for the halves of
    /// stretch k. `expected`: how many groups a cut across each axis will take.
    fn dissect(
        &self,
        members: &mut [u32],
        out: &mut [u32],
        number: u32,
        mut expected: [f64; 3],
    ) -> Result<(), MainSystemError> {
        if members.len() <= LEAF {
            self.order_leaf(members, out)?;
            self.done.fetch_add(members.len(), Ordering::Relaxed);
            return Ok(());
        }
        check_stop(self.watch)?;
        let (done, all) = (self.done.load(Ordering::Relaxed), self.side.len());
        self.watch.progress(&format!("ordering, {done} of {all} nodes"), done as f64 / all as f64);
        let size = members.len();
        let half = size / 2;
        // Along the axis where the fewest are expected; where they are more, another way may be the better one.
        let mut best: Option<(usize, Vec<u32>)> = None;
        let mut untried = vec![0, 1, 2];
        let mut last = 3;
        while let Some(at) = (0..untried.len()).min_by(|&a, &b| expected[untried[a]].total_cmp(&expected[untried[b]])) {
            let axis = untried.remove(at);
            let fewest = best.as_ref().map_or(f64::INFINITY, |(_, cut)| cut.len() as f64);
            if expected[axis] >= fewest {
                break;
            }
            let cut = self.split(members, number, axis);
            last = axis;
            expected[axis] = cut.len() as f64;
            if expected[axis] < fewest {
                best = Some((axis, cut));
            }
        }
        let Some((axis, mut cut)) = best else { return Ok(()) };
        if last != axis {
            cut = self.split(members, number, axis);
        }
        // The halves are as wide as the whole along the cut, and half as long across it.
        for other in (0..3).filter(|other| *other != axis) {
            expected[other] *= 0.5;
        }
        let (near, far) = members.split_at_mut(half);
        // The cut to the end of the near half.
        let of_cut = mark(number, 3);
        cut.iter().for_each(|&group| self.side[group as usize].store(of_cut, Ordering::Relaxed));
        let mut kept = 0;
        for i in 0..near.len() {
            if self.side[near[i] as usize].load(Ordering::Relaxed) != of_cut {
                near.swap(kept, i);
                kept += 1;
            }
        }
        let near = &mut near[..kept];
        let (out, last) = out.split_at_mut(size - cut.len());
        last.copy_from_slice(&cut);
        self.done.fetch_add(cut.len(), Ordering::Relaxed);
        let (first, second) = out.split_at_mut(kept);
        let mut near = || self.dissect(near, first, 2 * number, expected);
        let mut far = || self.dissect(far, second, 2 * number + 1, expected);
        if self.is_spread && size > WORTH_SPREADING {
            let (near, far) = rayon::join(near, far);
            near.and(far)
        } else {
            near().and_then(|()| far())
        }
    }

    /// The nearer half of the members along an axis to the front; returns those of it that touch the other half.
    fn split(&self, members: &mut [u32], number: u32, axis: usize) -> Vec<u32> {
        let key = |group: u32| {
            let point = self.points[group as usize];
            [point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]]
        };
        let half = members.len() / 2;
        members.select_nth_unstable_by(half, |&a, &b| {
            let (a, b) = (key(a), key(b));
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2]))
        });
        let (near, far) = members.split_at(half);
        let of_far = mark(number, axis as u32);
        far.iter().for_each(|&group| self.side[group as usize].store(of_far, Ordering::Relaxed));
        // Marks of the other axis, and of the last time along this one.
        near.iter().for_each(|&group| self.side[group as usize].store(NONE, Ordering::Relaxed));
        let touches = |&group: &u32| {
            let neighbors = self.neighbors.of(group);
            neighbors.iter().any(|&other| self.side[other as usize].load(Ordering::Relaxed) == of_far)
        };
        near.iter().copied().filter(|group| touches(group)).collect()
    }

    /// Approximate minimum degree of a few groups.
    fn order_leaf(&self, members: &[u32], out: &mut [u32]) -> Result<(), MainSystemError> {
        let out_of_memory = || MainSystemError::OutOfMemory { doing: "ordering the unknowns" };
        let mut number: Vec<(u32, u32)> = members.iter().copied().zip(0..).collect();
        number.sort_unstable();
        let number_of = |group: &u32| number.binary_search_by_key(group, |entry| entry.0).ok().map(|at| number[at].1);
        let (mut start, mut rows) = (vec![0_u32], Vec::new());
        for &group in members {
            let from = rows.len();
            rows.extend(self.neighbors.of(group).iter().filter_map(number_of));
            rows[from..].sort_unstable();
            let mut kept = from;
            for i in from..rows.len() {
                if i == from || rows[i] != rows[kept - 1] {
                    rows[kept] = rows[i];
                    kept += 1;
                }
            }
            rows.truncate(kept);
            start.push(rows.len() as u32);
        }
        let order = minimum_degree_order(&start, &rows).map_err(|_| out_of_memory())?;
        out.iter_mut().zip(order).for_each(|(out, i)| *out = members[i as usize]);
        Ok(())
    }
}

/// What marks a side (0, 1, 2: the far one along that axis; 3: the cut) of the stretch with a number.
fn mark(number: u32, side: u32) -> u32 {
    4 * number + side
}
