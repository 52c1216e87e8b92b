//! All corners and all extreme directions of a polyhedron, by going through its feasible bases.

use std::collections::{HashSet, VecDeque};

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::lcp::exact::polyhedron::{GoOn, Polyhedron};

/// No more than this many bases of one polyhedron are visited.
const MOST_BASES: usize = 20_000;

/// The polyhedron is the hull of its corners, plus any non-negative combination of its directions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corners {
    /// Values of the variables asked for at each corner, each corner once.
    pub corners: Vec<Vec<BigRational>>,
    /// Directions in which it goes on without end, largest entry 1, each once.
    pub directions: Vec<Vec<BigRational>>,
    /// Whether these are all.
    pub complete: bool,
}

impl Corners {
    /// More than one point.
    pub fn is_continuum(&self) -> bool {
        self.corners.len() > 1 || !self.directions.is_empty()
    }
}

/// Goes through the feasible bases of a feasible polyhedron; `variables` are those whose values are returned. A
/// polyhedron that holds a whole line has no corner: the line counts as two directions and is left out of the search.
pub fn corners(start: &Polyhedron, variables: &[usize], go_on: &mut GoOn) -> Corners {
    let mut found = Corners { complete: true, ..Corners::default() };
    let mut start = start.clone();
    lines(&mut start, variables, &mut found, go_on);
    let key = |polyhedron: &Polyhedron| {
        let mut key = polyhedron.nonbasic().to_vec();
        key.sort_unstable();
        key
    };
    let mut seen = HashSet::from([key(&start)]);
    let mut known: HashSet<Vec<BigRational>> = HashSet::new();
    let mut queue = VecDeque::from([start]);
    while let Some(polyhedron) = queue.pop_front() {
        let corner: Vec<BigRational> = variables.iter().map(|&v| polyhedron.value(v)).collect();
        if known.insert(corner.clone()) {
            found.corners.push(corner);
        }
        for column in 0..polyhedron.dimension() {
            let blocking = blocking(&polyhedron, column);
            if blocking.is_empty() {
                add_direction(&mut found, &polyhedron, variables, column);
            }
            for row in blocking {
                let mut next = polyhedron.nonbasic().to_vec();
                next[column] = polyhedron.basic()[row];
                next.sort_unstable();
                if seen.contains(&next) {
                    continue;
                }
                if seen.len() >= MOST_BASES || !go_on() {
                    found.complete = false;
                    return found;
                }
                seen.insert(next);
                let mut neighbour = polyhedron.clone();
                neighbour.pivot(row, column);
                queue.push_back(neighbour);
            }
        }
    }
    found
}

/// Rows that stop the variable of `column` first; none: it can grow without end.
fn blocking(polyhedron: &Polyhedron, column: usize) -> Vec<usize> {
    let mut rows: Vec<usize> = Vec::new();
    for row in 0..polyhedron.basic().len() {
        let entry = polyhedron.entry(row, column);
        if polyhedron.is_free(polyhedron.basic()[row]) || !entry.is_negative() {
            continue;
        }
        let against = rows.first().map(|&best| {
            // constant / −entry against the smallest so far.
            let own = polyhedron.constant(row) * -polyhedron.entry(best, column);
            own.cmp(&(polyhedron.constant(best) * -entry))
        });
        match against {
            Some(std::cmp::Ordering::Greater) => {}
            Some(std::cmp::Ordering::Equal) => rows.push(row),
            Some(std::cmp::Ordering::Less) | None => rows = vec![row],
        }
    }
    rows
}

fn add_direction(found: &mut Corners, polyhedron: &Polyhedron, variables: &[usize], column: usize) {
    let rates: Vec<BigRational> = variables.iter().map(|&v| polyhedron.rate(v, column)).collect();
    let largest = rates.iter().map(Signed::abs).max().unwrap_or_else(BigRational::zero);
    if largest.is_zero() {
        return; // moves none of the variables asked for
    }
    let direction: Vec<BigRational> = rates.into_iter().map(|rate| rate / &largest).collect();
    if !found.directions.contains(&direction) {
        found.directions.push(direction);
    }
}

/// Free variables that no inequality meets are lines of the polyhedron.
fn lines(start: &mut Polyhedron, variables: &[usize], found: &mut Corners, go_on: &mut GoOn) {
    while let Some(column) = (0..start.dimension()).find(|&c| start.is_free(start.nonbasic()[c])) {
        let variable = start.nonbasic()[column];
        let mut stops = blocking(start, column);
        if stops.is_empty() {
            start.negate(variable);
            stops = blocking(start, column);
        }
        if let Some(&row) = stops.first() {
            start.pivot(row, column);
            continue;
        }
        add_direction(found, start, variables, column);
        start.negate(variable);
        add_direction(found, start, variables, column);
        start.fix(variable, go_on);
    }
}
