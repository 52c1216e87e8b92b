//! What holds up a path though nothing ends: variables that are zero but for their rounding.
//!
//! A slip that symmetry forbids comes out as some 1e-12 of the others, of either sign. Where it falls below what counts as
//! zero the scheme seems to end, and the scheme beyond is the same, or one that ends at once in this: then how far it fell
//! is its rounding, and so far it counts as zero from there on.

use std::collections::HashMap;

use crate::lcp::basis::Basis;

/// Relative distance beyond a jump at which the next answer is looked for.
const BEYOND: f64 = 1e-9;
/// A variable counts as zero up to this multiple of the rounding that was seen of it: one fall tells no more than its size.
const SEEN: f64 = 8.0;

/// How far beyond a value the next answer is looked for.
pub(super) fn further(value: f64) -> f64 {
    BEYOND * value.abs().max(1e-3)
}

/// Of variables that are zero but for their rounding how large this is, as a share of the largest of their kind.
#[derive(Default)]
pub(super) struct Rounding(HashMap<usize, f64>);

impl Rounding {
    /// These variables fell below zero so far, and what they ended goes on. What falls by more than the share of its way that a
    /// path looks ahead is none of rounding.
    pub(super) fn learn(&mut self, fallen: &[(usize, f64)]) {
        for (row, margin) in fallen.iter().filter(|(_, margin)| margin.abs() <= BEYOND) {
            let known = self.0.entry(*row).or_insert(0.0);
            *known = known.max(SEEN * margin.abs());
        }
    }

    /// Whether the variable is zero but for its rounding.
    pub(super) fn hides(&self, row: usize, margin: f64) -> bool {
        self.0.get(&row).is_some_and(|rounding| margin.abs() <= *rounding)
    }
}

/// The schemes that were entered since the path last got on, and where.
#[derive(Default)]
pub(super) struct Standstill(Vec<(Basis, f64)>);

impl Standstill {
    /// A scheme entered at `from` has ended at `value`, and `next` follows: whether this is the same, or one that was entered
    /// no more than a few looks ahead ago.
    pub(super) fn is_met_again(&mut self, scheme: Basis, from: f64, value: f64, next: &Basis) -> bool {
        let same = scheme == *next;
        self.0.push((scheme, from));
        self.0.retain(|(_, from)| (value - from).abs() <= 4.0 * further(value));
        same || self.0.iter().any(|(scheme, _)| scheme == next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_goes_round_stands_still() {
        let scheme = |row: usize| Basis { z: vec![row], active: vec![row], p: false };
        let mut path = Standstill::default();
        let mut met =
            |of: usize, from: f64, value: f64, next: usize| path.is_met_again(scheme(of), from, value, &scheme(next));
        // 0 → 1 → 2 → 0 on the spot, then on to 1.
        assert!(!met(0, 0.1, 0.2, 1) && !met(1, 0.2, 0.2, 2) && !met(2, 0.2, 0.2, 0));
        assert!(met(0, 0.2, 0.2 + 1e-10, 1) && met(1, 0.2, 0.2, 2));
        // Back in schemes that were left long ago is no standstill; the end of a scheme that goes on is one.
        assert!(!met(2, 0.2, 0.3, 0) && met(0, 0.3, 0.4, 0));
    }

    #[test]
    fn rounding_is_what_was_seen_and_little() {
        let mut rounding = Rounding::default();
        rounding.learn(&[(3, -2e-12), (4, -1e-3)]);
        rounding.learn(&[(3, -1e-12)]);
        assert!(rounding.hides(3, -1.5e-11) && rounding.hides(3, 1.5e-11) && !rounding.hides(3, -1.7e-11));
        assert!(!rounding.hides(4, -1e-3) && !rounding.hides(5, 0.0));
    }
}
