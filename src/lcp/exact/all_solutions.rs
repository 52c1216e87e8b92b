//! Every solution of an LCP: w = M z + q, w ≥ 0, z ≥ 0, wᵀz = 0.
//!
//! Branch and bound over the couples: w_i = 0 or z_i = 0. At every node the linear program that is left (all signs, the
//! couples decided so far) is kept feasible in exact arithmetic ([`Polyhedron`]); where it is empty the node ends, and
//! that is a proof. Where all couples are decided, or only one point is left, the whole set of solutions of that basis
//! is described by its corners and directions, singular or not. So the list is complete whenever the search came to its
//! end.

use num_rational::BigRational;

use crate::lcp::exact::corners::{Corners, corners};
use crate::lcp::exact::dyadic::WholeRows;
use crate::lcp::exact::polyhedron::{Polyhedron, State};

/// A set of solutions with more than one element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Continuum {
    /// Its corners, as indices of [`Solutions::basic`], ascending.
    pub corners: Vec<usize>,
    /// Directions in which it goes on without end, largest entry 1.
    pub directions: Vec<Vec<BigRational>>,
}

impl Continuum {
    fn is_part_of(&self, other: &Continuum) -> bool {
        self.corners.iter().all(|corner| other.corners.contains(corner))
            && self.directions.iter().all(|direction| other.directions.contains(direction))
    }
}

/// What the search found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solutions {
    /// z of every basic solution, in the order of the search.
    pub basic: Vec<Vec<BigRational>>,
    /// Sets of solutions between and beyond the basic ones; none is part of another.
    pub continua: Vec<Continuum>,
    /// Sets whose corners were too many to be listed.
    pub unlisted: u64,
    /// Bases that were described.
    pub leaves: u64,
    /// Branches that ended because their linear program is empty.
    pub cut: u64,
    /// Whether the search came to its end.
    pub complete: bool,
}

impl Solutions {
    /// There is none: proved.
    pub fn none(&self) -> bool {
        self.complete && self.basic.is_empty() && self.unlisted == 0
    }

    /// Adds what one leaf holds; returns the indices of its corners, new ones last.
    pub fn add(&mut self, found: Corners) -> Vec<usize> {
        if !found.complete {
            self.unlisted += 1;
        }
        let is_continuum = found.is_continuum();
        let mut at: Vec<usize> = found
            .corners
            .into_iter()
            .map(|corner| {
                self.basic.iter().position(|known| *known == corner).unwrap_or_else(|| {
                    self.basic.push(corner);
                    self.basic.len() - 1
                })
            })
            .collect();
        at.sort_unstable();
        if !is_continuum {
            return at;
        }
        let piece = Continuum { corners: at.clone(), directions: found.directions };
        if !self.continua.iter().any(|known| piece.is_part_of(known)) {
            self.continua.retain(|known| !known.is_part_of(&piece));
            self.continua.push(piece);
        }
        at
    }
}

/// How far the search is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Nodes visited.
    pub nodes: u64,
    /// Share of the tree that is done, 0 … 1.
    pub share: f64,
    /// Basic solutions found.
    pub found: usize,
}

/// Finds every solution; `rows` are those of M with q as the last column. `observer` hears of the progress before every
/// step and stops the search by returning false; what was found until then is returned as incomplete.
pub fn all_solutions(rows: WholeRows, observer: &mut dyn FnMut(Progress) -> bool) -> Solutions {
    let n = rows.rows.len();
    let mut search = Search {
        size: n,
        observer,
        progress: Progress { nodes: 0, share: 0.0, found: 0 },
        found: Solutions::default(),
    };
    let mut root = Polyhedron::new(n, rows, &[]);
    let state = root.start(&mut search.go_on());
    search.found.complete = search.node(root, state, vec![false; n], 1.0);
    search.found
}

struct Search<'a> {
    size: usize,
    observer: &'a mut dyn FnMut(Progress) -> bool,
    progress: Progress,
    found: Solutions,
}

impl Search<'_> {
    fn go_on(&mut self) -> impl FnMut() -> bool + '_ {
        || (self.observer)(self.progress)
    }

    /// False when stopped. `share` of the whole tree hangs below this node.
    fn node(&mut self, polyhedron: Polyhedron, state: State, mut decided: Vec<bool>, share: f64) -> bool {
        self.progress.nodes += 1;
        if state == State::Stopped || !(self.observer)(self.progress) {
            return false;
        }
        if state == State::Empty {
            self.found.cut += 1;
            self.progress.share += share;
            return true;
        }
        let n = self.size;
        for (i, decided) in decided.iter_mut().enumerate() {
            *decided |= polyhedron.vanishes(i) || polyhedron.vanishes(n + i);
        }
        let open: Vec<usize> = (0..n).filter(|&i| !decided[i]).collect();
        let broken = open.iter().copied().find(|&i| !polyhedron.is_zero(i) && !polyhedron.is_zero(n + i));
        let Some(couple) = broken.or(open.first().copied()) else {
            return self.leaf(&polyhedron, share);
        };
        if polyhedron.dimension() == 0 {
            if broken.is_none() {
                return self.leaf(&polyhedron, share);
            }
            self.found.cut += 1;
            self.progress.share += share;
            return true;
        }
        decided[couple] = true;
        for variable in [couple, n + couple] {
            let mut child = polyhedron.clone();
            let state = child.fix(variable, &mut self.go_on());
            if !self.node(child, state, decided.clone(), 0.5 * share) {
                return false;
            }
        }
        true
    }

    /// All couples are decided: the solutions of this basis.
    fn leaf(&mut self, polyhedron: &Polyhedron, share: f64) -> bool {
        let variables: Vec<usize> = (0..self.size).collect();
        let mut stopped = false;
        let mut go_on = || {
            let go = (self.observer)(self.progress);
            stopped |= !go;
            go
        };
        let found = corners(polyhedron, &variables, &mut go_on);
        self.found.add(found);
        self.found.leaves += 1;
        self.progress.found = self.found.basic.len();
        self.progress.share += share;
        !stopped
    }
}

#[cfg(test)]
#[path = "all_solutions_tests.rs"]
mod tests;
