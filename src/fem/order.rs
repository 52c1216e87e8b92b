//! The order in which the unknowns of the main system are eliminated: nested dissection of its nodes.
//!
//! The nodes are cut in two where the fewest of them touch the other side, straight across the longer way or the
//! other; the cut comes behind both halves, and so on in each half. What is small enough is ordered by approximate
//! minimum degree. Of a plate this leaves less fill than minimum degree alone, and much less where many rows have to
//! come last anyway: a half then reaches only those that it touches.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use super::error::MainSystemError;
use super::sparse::SymmetricSparse;
use super::watch::check_stop;
use crate::watch::Watch;

/// So many nodes are not cut further.
const LEAF: usize = 64;
/// In the place of a number: there is none.
const NONE: u32 = u32::MAX;

/// Where the unknowns are.
#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    /// Node of each unknown.
    pub node: &'a [u32],
    /// Coordinates of each node.
    pub coordinates: &'a [[f64; 2]],
    /// Whether each unknown has to come behind all others.
    pub last: &'a [bool],
}

/// The order of the rows of `k`: entry i is the row at position i.
///
/// # Errors
/// Out of memory; interrupted.
pub fn elimination_order(k: &SymmetricSparse, places: Places, watch: &dyn Watch) -> Result<Vec<u32>, MainSystemError> {
    let n = k.order();
    let groups = Groups::new(places);
    let mut dissection = Dissection {
        neighbors: Neighbors::new(k, &groups),
        points: groups.points,
        side: vec![Side::Elsewhere; groups.start.len() - 1],
        number: vec![NONE; groups.start.len() - 1],
        out: Vec::with_capacity(groups.start.len() - 1),
        watch,
    };
    let mut all: Vec<u32> = (0..dissection.side.len() as u32).collect();
    dissection.dissect(&mut all, [0.0; 2])?;
    let mut order = Vec::with_capacity(n);
    for &group in &dissection.out {
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
    points: Vec<[f64; 2]>,
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

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Elsewhere,
    Cut,
    Far,
}

struct Dissection<'a> {
    neighbors: Neighbors,
    points: Vec<[f64; 2]>,
    /// Side of the present cut.
    side: Vec<Side>,
    /// Number within the present leaf.
    number: Vec<u32>,
    /// The order found so far.
    out: Vec<u32>,
    watch: &'a dyn Watch,
}

impl Dissection<'_> {
    /// Appends the order of some groups; `expected`: how many groups a cut across either axis will take.
    fn dissect(&mut self, members: &mut [u32], mut expected: [f64; 2]) -> Result<(), MainSystemError> {
        if members.len() <= LEAF {
            return self.order_leaf(members);
        }
        check_stop(self.watch)?;
        let (done, all) = (self.out.len(), self.side.len());
        self.watch.progress(&format!("ordering, {done} of {all} nodes"), done as f64 / all as f64);
        let half = members.len() / 2;
        let mut axis = usize::from(expected[1] < expected[0]);
        let mut cut = self.split(members, axis);
        expected[axis] = cut.len() as f64;
        if expected[1 - axis] < expected[axis] {
            // Worse than expected: the other way may be the better one.
            let other = self.split(members, 1 - axis);
            expected[1 - axis] = other.len() as f64;
            if other.len() < cut.len() {
                (axis, cut) = (1 - axis, other);
            } else {
                cut = self.split(members, axis);
            }
        }
        // The halves are as wide as the whole along the cut, and half as long across it.
        expected[1 - axis] *= 0.5;
        let (near, far) = members.split_at_mut(half);
        // The cut to the end of the near half.
        for &group in &cut {
            self.side[group as usize] = Side::Cut;
        }
        let side = &self.side;
        let mut kept = 0;
        for i in 0..near.len() {
            if side[near[i] as usize] != Side::Cut {
                near.swap(kept, i);
                kept += 1;
            }
        }
        for &group in &cut {
            self.side[group as usize] = Side::Elsewhere;
        }
        let near = &mut near[..kept];
        self.dissect(near, expected)?;
        self.dissect(far, expected)?;
        self.out.extend(cut);
        Ok(())
    }

    /// The nearer half of the members along an axis to the front; returns those of it that touch the other half.
    fn split(&mut self, members: &mut [u32], axis: usize) -> Vec<u32> {
        let points = &self.points;
        let key = |group: u32| {
            let point = points[group as usize];
            (point[axis], point[1 - axis])
        };
        let half = members.len() / 2;
        members.select_nth_unstable_by(half, |&a, &b| {
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let (near, far) = members.split_at(half);
        for &group in far {
            self.side[group as usize] = Side::Far;
        }
        let touches = |&group: &u32| {
            let neighbors = self.neighbors.of(group);
            neighbors.iter().any(|&other| self.side[other as usize] == Side::Far)
        };
        let cut = near.iter().copied().filter(|group| touches(group)).collect();
        for &group in far {
            self.side[group as usize] = Side::Elsewhere;
        }
        cut
    }

    /// Approximate minimum degree of a few groups.
    fn order_leaf(&mut self, members: &[u32]) -> Result<(), MainSystemError> {
        let out_of_memory = || MainSystemError::OutOfMemory { doing: "ordering the unknowns" };
        for (number, &group) in members.iter().enumerate() {
            self.number[group as usize] = number as u32;
        }
        let (mut start, mut rows) = (vec![0_u32], Vec::new());
        for &group in members {
            let from = rows.len();
            let inside = self.neighbors.of(group).iter();
            rows.extend(inside.map(|&other| self.number[other as usize]).filter(|&number| number != NONE));
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
        for &group in members {
            self.number[group as usize] = NONE;
        }
        let n = members.len();
        let (mut order, mut inverse) = (vec![0_u32; n], vec![0_u32; n]);
        let request = amd::order_scratch::<u32>(n, rows.len());
        let mut memory = MemBuffer::try_new(request).map_err(|_| out_of_memory())?;
        amd::order(
            &mut order,
            &mut inverse,
            SymbolicSparseColMatRef::new_checked(n, n, &start, None, &rows),
            amd::Control::default(),
            MemStack::new(&mut memory),
        )
        .map_err(|_| out_of_memory())?;
        self.out.extend(order.into_iter().map(|i| members[i as usize]));
        Ok(())
    }
}
