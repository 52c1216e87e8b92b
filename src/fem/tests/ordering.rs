//! The elimination order: complete, with what has to come last at the end, and with little fill.

use std::collections::BTreeSet;

use crate::fem::order::{Places, elimination_order};
use crate::fem::sparse::SymmetricSparse;
use crate::watch::Quiet;

/// A plate of nx × ny square elements, two unknowns to a node, all unknowns of an element coupled. The nodes are
/// numbered in a scrambled order.
struct Plate {
    node: Vec<u32>,
    coordinates: Vec<[f64; 3]>,
    matrix: SymmetricSparse,
}

impl Plate {
    fn new(nx: usize, ny: usize) -> Plate {
        let count = (nx + 1) * (ny + 1);
        // 7 919 is prime and larger than any row of nodes used here.
        let scrambled = |i: usize, j: usize| (7919 * (i * (ny + 1) + j)) % count;
        assert_ne!(count % 7919, 0);
        let mut coordinates = vec![[0.0; 3]; count];
        let mut terms = BTreeSet::new();
        for i in 0..=nx {
            for j in 0..=ny {
                coordinates[scrambled(i, j)] = [i as f64, j as f64, 0.0];
            }
        }
        for i in 0..nx {
            for j in 0..ny {
                let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
                let unknowns = corners.iter().flat_map(|&(i, j)| {
                    let node = scrambled(i, j);
                    [2 * node, 2 * node + 1]
                });
                let unknowns: Vec<usize> = unknowns.collect();
                for &a in &unknowns {
                    terms.extend(unknowns.iter().filter(|&&b| b <= a).map(|&b| (b, a)));
                }
            }
        }
        let matrix = SymmetricSparse::from_terms::<()>(
            2 * count,
            |visit| terms.iter().for_each(|&(column, _)| visit(column)),
            |visit| {
                terms.iter().for_each(|&(column, row)| visit(row, column, 1.0));
                Ok(())
            },
        )
        .expect("no term fails");
        Plate { node: (0..2 * count as u32).map(|unknown| unknown / 2).collect(), coordinates, matrix }
    }

    fn is_on_edge(&self, unknown: usize) -> bool {
        self.coordinates[self.node[unknown] as usize][1] == 0.0
    }

    fn order(&self, last: &[bool]) -> Vec<u32> {
        let places = Places { node: &self.node, coordinates: &self.coordinates, last };
        elimination_order(&self.matrix, places, &Quiet).expect("nothing fails")
    }

    /// Entries of L by elimination on sets: each column hands its rows on to the first of them.
    fn fill(&self, order: &[u32]) -> usize {
        let n = order.len();
        let mut position = vec![0; n];
        for (at, &row) in order.iter().enumerate() {
            position[row as usize] = at;
        }
        let mut below: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); n];
        for column in 0..n {
            for (row, _) in self.matrix.column(column) {
                let (a, b) = (position[row], position[column]);
                if a != b {
                    below[a.min(b)].insert(a.max(b));
                }
            }
        }
        let mut entries = n;
        for column in 0..n {
            let rows = std::mem::take(&mut below[column]);
            entries += rows.len();
            let mut rows = rows.into_iter();
            if let Some(parent) = rows.next() {
                below[parent].extend(rows);
            }
        }
        entries
    }
}

#[test]
fn every_unknown_once_and_the_last_ones_last() {
    let plate = Plate::new(30, 11);
    let n = plate.node.len();
    let last: Vec<bool> = (0..n).map(|unknown| plate.is_on_edge(unknown)).collect();
    let order = plate.order(&last);
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().copied().eq(0..n as u32));
    let tail = last.iter().filter(|last| **last).count();
    assert_eq!(tail, 2 * 31);
    assert!(order[n - tail..].iter().all(|&row| last[row as usize]));
}

/// Nested dissection of a square grid of k × k nodes leaves 31/4 k² log₂ k + O(k²) entries (George 1973) for one
/// unknown to a node, four times as many for two; elimination row by row leaves k³ and 4 k³.
#[test]
fn little_fill_in_a_square_plate() {
    let k = 48.0_f64;
    let plate = Plate::new(47, 47);
    let entries = plate.fill(&plate.order(&vec![false; plate.node.len()])) as f64;
    let dissected = 4.0 * 7.75 * k.powi(2) * k.log2();
    assert!(entries < dissected, "{entries} entries, dissected {dissected}");
    assert!(entries < 4.0 * k.powi(3));
}

/// Two halves that are ordered on two threads, more nodes than one thread orders alone; on a pool of one thread the
/// same.
#[test]
fn the_order_does_not_depend_on_the_number_of_threads() {
    let plate = Plate::new(120, 60);
    let last = vec![false; plate.node.len()];
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| plate.order(&last))
    };
    let order = with(1);
    assert_eq!(order, with(2));
    assert_eq!(order, with(3));
}

/// A long strip whose lower edge comes last: a cut across it reaches only the stretch of the edge between the next
/// two larger cuts, so that the entries in the rows of the edge grow as its length times the logarithm of it, and
/// not as its square.
#[test]
fn what_comes_last_fills_only_where_it_touches() {
    let fill = |nx: usize| {
        let plate = Plate::new(nx, 4);
        let last: Vec<bool> = (0..plate.node.len()).map(|unknown| plate.is_on_edge(unknown)).collect();
        let edge = last.iter().filter(|last| **last).count();
        // Without the dense triangle of the edge itself, which no order avoids.
        plate.fill(&plate.order(&last)) - edge * (edge + 1) / 2
    };
    let (short, long) = (fill(100) as f64, fill(400) as f64);
    let growth = (long / short).log(4.0);
    assert!(growth < 1.3, "entries grow as the length to the power {growth:.2}");
}
