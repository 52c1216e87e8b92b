//! All answers: a tree of branches in which every end is an answer, a set of answers, or a contradiction.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::forms::{Branch, Forms};
use crate::lcp::exact::corners::corners;
use crate::lcp::exact::polyhedron::{GoOn, Polyhedron, State};
use crate::lcp::exact::scalar::BigInt;

/// More nodes than this make no tree that one would want to check.
pub const MOST_NODES: usize = 5_000;

/// After this many nodes …
const LOOK: usize = 500;
/// … a tree is given up if, at this rate, it would need this many times the most nodes.
const HOPELESS: usize = 4;

/// Factors of variables.
pub type Sum = Vec<(usize, BigRational)>;

/// The same sum with the factor `unit` as 1.
pub(super) fn in_units(sum: Vec<(usize, BigInt)>, unit: &BigInt) -> Sum {
    sum.into_iter().map(|(variable, factor)| (variable, BigRational::new(factor, unit.clone()))).collect()
}

/// A node.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// The branches of a group, in their order.
    Split { group: usize, below: Vec<Tree> },
    /// A sum of variables that is negative whatever the unknowns, though none of its terms may be.
    Cut(Sum),
    /// One answer; `tight`: a sum that is zero whatever the unknowns and whose terms are ≥ 0, so that all of them are 0.
    Answer { answer: usize, tight: Sum },
    /// A set of answers: all that the branches above leave; these are its corners.
    Set { answers: Vec<usize> },
}

/// The tree, and the unknowns of every answer in it.
#[derive(Clone, Debug, PartialEq)]
pub struct AllAnswers {
    /// The root.
    pub tree: Tree,
    /// Of each answer.
    pub answers: Vec<Vec<BigRational>>,
    /// Ends that are sets.
    pub sets: usize,
    /// Nodes.
    pub nodes: usize,
}

/// Why there is no tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoTree {
    /// It was stopped.
    Stopped,
    /// It would have more than [`MOST_NODES`].
    TooLarge,
}

/// Grows the tree; `progress` hears the number of nodes and the share of the tree that is done, and stops it with false.
///
/// # Errors
/// [`NoTree`].
pub fn grow(forms: &Forms, progress: &mut dyn FnMut(usize, f64) -> bool) -> Result<AllAnswers, NoTree> {
    let mut search = Search { forms, progress, nodes: 0, share: 0.0, answers: Vec::new(), sets: 0 };
    let (root, state) = forms.start(&mut search.go_on());
    let tree = search.node(&root, state, &mut vec![None; forms.groups.len()], 1.0)?;
    Ok(AllAnswers { tree, answers: search.answers, sets: search.sets, nodes: search.nodes })
}

struct Search<'a> {
    forms: &'a Forms,
    progress: &'a mut dyn FnMut(usize, f64) -> bool,
    nodes: usize,
    share: f64,
    answers: Vec<Vec<BigRational>>,
    sets: usize,
}

/// What a branch asks for; the state, and the variable that was fixed last.
pub(super) fn impose(polyhedron: &mut Polyhedron, branch: &Branch, go_on: &mut GoOn) -> (State, Option<usize>) {
    polyhedron.impose(branch.zero.iter().copied(), branch.signs.iter().copied(), go_on)
}

/// The sum that proves a polyhedron empty, −1 whatever the unknowns.
pub(super) fn contradiction(empty: &Polyhedron, pinned: Option<usize>) -> Option<Sum> {
    empty.contradiction(pinned).map(|(factors, sum)| in_units(factors, &-sum))
}

/// The same from Farkas' y over the rows of an LCP: the factors are y for w and −Mᵀy for z.
pub(super) fn of_farkas(forms: &Forms, weights: &[BigRational]) -> Sum {
    let n = forms.unknowns;
    let column = |j: usize| -> BigRational { forms.forms.iter().zip(weights).map(|(form, y)| &form[j] * y).sum() };
    let unit = -column(n);
    let all = (0..n).map(|j| -column(j)).chain(weights.iter().cloned()).enumerate();
    all.filter(|(_, factor)| !factor.is_zero()).map(|(variable, factor)| (variable, factor / &unit)).collect()
}

impl Search<'_> {
    fn go_on(&mut self) -> impl FnMut() -> bool + '_ {
        || (self.progress)(self.nodes, self.share)
    }

    fn node(
        &mut self,
        polyhedron: &Polyhedron,
        (state, pinned): (State, Option<usize>),
        chosen: &mut Vec<Option<usize>>,
        share: f64,
    ) -> Result<Tree, NoTree> {
        self.nodes += 1;
        let hopeless = self.nodes >= LOOK && self.share * (HOPELESS * MOST_NODES) as f64 / (self.nodes as f64) < 1.0;
        if self.nodes > MOST_NODES || hopeless {
            return Err(NoTree::TooLarge);
        }
        match state {
            State::Stopped => return Err(NoTree::Stopped),
            State::Empty => {
                self.share += share;
                // What made it empty is a row: the contradiction itself.
                return contradiction(polyhedron, pinned).map(Tree::Cut).ok_or(NoTree::Stopped);
            }
            State::Feasible if !(self.progress)(self.nodes, self.share) => return Err(NoTree::Stopped),
            State::Feasible => {}
        }
        let broken = |group: &usize| {
            let branches = &self.forms.groups[*group].branches;
            !branches.iter().any(|branch| branch.zero.iter().all(|&variable| polyhedron.is_zero(variable)))
        };
        let mut open = (0..chosen.len()).filter(|&group| chosen[group].is_none());
        let first = open.clone().find(broken);
        let Some(group) = first.or_else(|| open.next()) else {
            self.share += share;
            return self.leaf(polyhedron);
        };
        let branches = &self.forms.groups[group].branches;
        let share = share / branches.len() as f64;
        let mut below = Vec::with_capacity(branches.len());
        for (number, branch) in branches.iter().enumerate() {
            chosen[group] = Some(number);
            let mut child = polyhedron.clone();
            let state = impose(&mut child, branch, &mut self.go_on());
            below.push(self.node(&child, state, chosen, share)?);
        }
        chosen[group] = None;
        Ok(Tree::Split { group, below })
    }

    /// Every group has its branch.
    fn leaf(&mut self, polyhedron: &Polyhedron) -> Result<Tree, NoTree> {
        let unknowns: Vec<usize> = (0..self.forms.unknowns).collect();
        let only = polyhedron.only_point(&mut self.go_on());
        if let Some(tight) = only {
            let z = unknowns.iter().map(|&variable| polyhedron.value(variable)).collect();
            let unit = tight.first().map_or_else(BigInt::one, |(_, factor)| factor.abs());
            return Ok(Tree::Answer { answer: self.known(z), tight: in_units(tight, &unit) });
        }
        let found = corners(&polyhedron.clone().without_fixed(), &unknowns, &mut self.go_on());
        if !found.complete {
            return Err(if self.go_on()() { NoTree::TooLarge } else { NoTree::Stopped });
        }
        self.sets += 1;
        Ok(Tree::Set { answers: found.corners.into_iter().map(|z| self.known(z)).collect() })
    }

    fn known(&mut self, z: Vec<BigRational>) -> usize {
        self.answers.iter().position(|known| *known == z).unwrap_or_else(|| {
            self.answers.push(z);
            self.answers.len() - 1
        })
    }
}
