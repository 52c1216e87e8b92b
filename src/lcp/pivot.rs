//! The record of a run: one entry per pivot, no copies of states, bounded in memory.

use std::collections::HashMap;

use crate::lcp::basis::{Basis, ChangingBasis};
use crate::lcp::variable::Variable;

/// Pivots of a run that are recorded one by one; the later ones are only counted.
pub const RECORDED: usize = 20_000;
/// Tied rows that are recorded in all pivots of a run together: a run of a large LCP has long lists of them.
pub const RECORDED_TIES: usize = 400_000;

/// One pivot: `entering` became basic, `leaving` nonbasic.
#[derive(Clone, Debug, PartialEq)]
pub struct Pivot {
    /// 0 is the entry of p.
    pub step: usize,
    /// The variable that became basic.
    pub entering: Variable,
    /// The variable that blocked it and became nonbasic.
    pub leaving: Variable,
    /// p before the pivot (at step 0: the p that is needed).
    pub p_before: f64,
    /// p after the pivot.
    pub p_after: f64,
    /// Value that the entering variable reached.
    pub ratio: f64,
    /// The leaving variable was zero already: the basis changes, the vertex stays.
    pub degenerate: bool,
    /// All rows that blocked at that value, the leaving one among them, in the order of the rows.
    pub ties: Vec<Variable>,
}

impl Basis {
    /// The basis after the given pivots of a run that started from z = 0.
    pub fn after(pivots: &[Pivot]) -> Basis {
        let mut basis = ChangingBasis::default();
        pivots.iter().for_each(|pivot| basis.pivot(pivot.entering, pivot.leaving));
        basis.now()
    }
}

/// A basis that came back with the same variable to enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// It stood first after this pivot …
    pub first: usize,
    /// … and again after this one.
    pub again: usize,
}

/// The pivots of a run: the first ones each with its record, all of them counted; the basis they lead to; and whether
/// a basis came back.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PivotLog {
    recorded: Vec<Pivot>,
    /// Tied rows in `recorded`.
    ties: usize,
    count: usize,
    last: Option<Pivot>,
    basis: ChangingBasis,
    /// Hash of the basis: the tokens of its variables combined, so that a pivot changes it by two of them.
    hash: u128,
    /// Bases met (with what entered next) and the pivot after which each stood first.
    met: HashMap<u128, usize>,
    cycle: Option<Cycle>,
    /// How often a basis came back.
    returns: usize,
}

impl PivotLog {
    /// Adds the next pivot; its `step` is [`PivotLog::count`].
    pub fn push(&mut self, pivot: Pivot) {
        self.basis.pivot(pivot.entering, pivot.leaving);
        self.hash ^= token(pivot.entering) ^ token(pivot.leaving);
        // What enters next is the complement of what left.
        let met = self.hash ^ token(pivot.leaving).rotate_left(1);
        let first = *self.met.entry(met).or_insert(pivot.step);
        if first != pivot.step {
            self.cycle = Some(Cycle { first, again: pivot.step });
            self.returns += 1;
        }
        // Without a gap: once a pivot is left out, all later ones are.
        let room = self.recorded.len() == self.count
            && self.count < RECORDED
            && (self.count == 0 || self.ties + pivot.ties.len() <= RECORDED_TIES);
        if room {
            self.ties += pivot.ties.len();
            self.recorded.push(pivot.clone());
        }
        self.count += 1;
        self.last = Some(pivot);
    }

    /// The records of the first pivots: all of them in a run of ordinary length.
    pub fn recorded(&self) -> &[Pivot] {
        &self.recorded
    }

    /// Number of pivots, recorded or not.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether every pivot is recorded.
    pub fn is_complete(&self) -> bool {
        self.recorded.len() == self.count
    }

    /// The last pivot, recorded or not.
    pub fn last(&self) -> Option<&Pivot> {
        self.last.as_ref()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The basis after the last pivot.
    pub fn basis(&self) -> Basis {
        self.basis.now()
    }

    /// The last return to a basis, where there were more than `allowed`.
    pub fn cycle(&self, allowed: usize) -> Option<Cycle> {
        self.cycle.filter(|_| self.returns > allowed)
    }

    /// Recomputes the amounts of all recorded pivots.
    pub fn rescale(&mut self, mut scale: impl FnMut(&mut Pivot)) {
        self.recorded.iter_mut().chain(&mut self.last).for_each(&mut scale);
    }

    /// The log of a run that has ended: without the bases met.
    pub fn closed(&self) -> PivotLog {
        PivotLog {
            recorded: self.recorded.clone(),
            last: self.last.clone(),
            basis: self.basis.clone(),
            met: HashMap::new(),
            ..*self
        }
    }
}

/// A number for each variable, as good as random and the same in every run (SplitMix64, twice).
fn token(variable: Variable) -> u128 {
    let code = match variable {
        Variable::W(i) => 2 * i as u64 + 1,
        Variable::Z(i) => 2 * i as u64 + 2,
        Variable::P => 0,
    };
    let mixed = |seed: u64| {
        let mut x = code.wrapping_add(seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    };
    (u128::from(mixed(0x5851_f42d_4c95_7f2d)) << 64) | u128::from(mixed(0x1405_7b7e_f767_814f))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pivot(step: usize, entering: Variable, leaving: Variable, ties: usize) -> Pivot {
        let ties = vec![leaving; ties];
        Pivot { step, entering, leaving, p_before: 1.0, p_after: 1.0, ratio: 0.0, degenerate: true, ties }
    }

    #[test]
    fn a_basis_that_comes_back_is_named_with_both_pivots() {
        use Variable::{P, W, Z};
        let mut log = PivotLog::default();
        for (step, (entering, leaving)) in [
            (P, W(0)),
            (Z(0), W(1)),
            (Z(1), W(2)),
            (Z(2), Z(0)),
            (W(0), Z(1)),
            (W(1), Z(2)),
            (W(2), W(0)),
            (Z(0), W(1)),
        ]
        .into_iter()
        .enumerate()
        {
            assert_eq!(log.cycle(0), None, "before pivot {step}");
            log.push(pivot(step, entering, leaving, 1));
            if step == 6 {
                // {p, w1, w2} as after pivot 0, and z0 enters as it did then.
                break;
            }
        }
        assert_eq!(log.cycle(0), Some(Cycle { first: 0, again: 6 }));
        assert_eq!(log.cycle(1), None);
        assert_eq!(log.basis(), Basis { z: vec![], active: vec![0], p: true });
    }

    #[test]
    fn the_same_basis_on_the_way_back_is_no_cycle() {
        use Variable::{P, W, Z};
        let mut log = PivotLog::default();
        log.push(pivot(0, P, W(0), 1));
        log.push(pivot(1, Z(0), W(1), 1));
        // The same basis as after pivot 0, but now z1 would enter.
        log.push(pivot(2, W(1), Z(0), 1));
        assert_eq!(log.cycle(0), None);
    }

    #[test]
    fn a_long_run_keeps_a_bounded_record_and_the_whole_count() {
        use Variable::{P, W, Z};
        let mut log = PivotLog::default();
        log.push(pivot(0, P, W(0), 1));
        for step in 1..=3 * RECORDED {
            let i = step / 2;
            let (entering, leaving) = if step % 2 == 1 { (Z(i), W(i + 1)) } else { (W(i), Z(i - 1)) };
            log.push(pivot(step, entering, leaving, 1));
        }
        assert_eq!(log.recorded().len(), RECORDED);
        assert_eq!(log.count(), 3 * RECORDED + 1);
        assert_eq!(log.last().map(|pivot| pivot.step), Some(3 * RECORDED));
        assert!(!log.is_complete());

        let mut tied = PivotLog::default();
        tied.push(pivot(0, P, W(0), 1));
        for step in 1..10 {
            tied.push(pivot(step, Z(step), W(step), RECORDED_TIES / 4));
        }
        assert_eq!((tied.recorded().len(), tied.count()), (4, 10));
    }
}
