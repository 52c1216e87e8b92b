//! The part of a problem, joints in force form, whose forces are open: without the joints whose force is known to be 0.
//!
//! Where joints repeat one another, one of them that cannot carry anything (of an open pair without cohesion; the tangential joint of
//! a pair without friction) leaves the others to themselves: its force is 0, its displacement only comes out. So it is taken out of
//! the mixed matrix exactly: it changes sides with a joint that repeats it, if there is one, and then its row and column are left
//! out. What is left repeats itself less, mostly not at all, and is a problem as of any structure, which pivots solve. The scheme
//! found there, spread over all joints, is a scheme of the whole problem.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::pivoted::NEARLY;
use super::problem::ContactProblem;
use super::rows::{RowId, RowKind};
use super::system::{ContactPair, ContactSystem, ForceForm};
use super::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::problem::NOISE;

/// See the module.
pub struct FeltPart {
    /// The pairs that are left, and their joints, by their numbers in the whole.
    pairs: Vec<usize>,
    joints: Vec<usize>,
    /// The mixed matrix of all joints after they changed sides, and which of them did.
    mixed: DMatrix<f64>,
    changed: Vec<bool>,
    system: Arc<ContactSystem>,
}

impl FeltPart {
    /// The part without the joints for which `carries_nothing`, of pairs whose normal joint is one all of them; `None` where there
    /// is none to leave out, or where a scheme of the others does not tell how one of them moves.
    pub fn new(whole: &ContactSystem, carries_nothing: &[bool]) -> Option<FeltPart> {
        if !carries_nothing.contains(&true) {
            return None;
        }
        let k = whole.joint_count();
        let forced = (0..k).map(|joint| whole.is_forced(joint)).collect();
        let mut sides = Sides { mixed: whole.stiffness.clone(), forced, changed: vec![false; k] };
        sides.change(carries_nothing)?;
        let left = |joint: &usize| !carries_nothing[*joint];
        let pairs: Vec<usize> = (0..whole.pair_count()).filter(left).collect();
        let tangential = pairs.iter().filter_map(|&pair| whole.pairs[pair].plane_tangential()).filter(left);
        let joints: Vec<usize> = pairs.iter().copied().chain(tangential).collect();
        let place = |joint: usize| joints.iter().position(|own| *own == joint);
        // As it must be in force form: see `force_form`.
        let is_explicit = |&pair: &usize| {
            let Some(joint) = whole.pairs[pair].plane_tangential().filter(left) else { return true };
            !sides.forced[joint] || sides.forced[pair] || sides.is_unfelt(pair, joint)
        };
        if !pairs.iter().all(is_explicit) {
            return None;
        }
        let own_pair = |&pair: &usize| {
            let at = whole.pairs[pair].plane_tangential().filter(left).and_then(place);
            ContactPair { tangential: at.map_or(0..0, |at| at..at + 1), ..whole.pairs[pair].clone() }
        };
        let forced: Vec<bool> = joints.iter().map(|&joint| sides.forced[joint]).collect();
        let count = joints.len();
        let system = Arc::new(ContactSystem {
            pairs: pairs.iter().map(own_pair).collect(),
            tangents: whole.tangents,
            stiffness: DMatrix::from_fn(count, count, |a, b| sides.mixed[(joints[a], joints[b])]),
            loads: Vec::new(),
            rounded: true,
            groups: Vec::new(),
            kernel: DMatrix::zeros(count, 0),
            corrected: None,
            force_form: forced
                .contains(&true)
                .then(|| ForceForm { joints: forced, self_stress: DMatrix::zeros(count, 0) }),
            yielding: None,
            file: None,
        });
        Some(FeltPart { pairs, joints, mixed: sides.mixed, changed: sides.changed, system })
    }

    /// The constants of all joints of a problem of the whole, after they changed sides.
    fn constants(&self, whole: &ContactProblem) -> DVector<f64> {
        let before = whole.joint_constants();
        let moved = before.map_with_location(|joint, _, own| if self.changed[joint] { own } else { 0.0 });
        let response = &self.mixed * moved;
        before.map_with_location(|joint, _, own| if self.changed[joint] { 0.0 } else { own }) - response
    }

    /// The problem of the part that belongs to one of the whole. Its gaps stand in its load.
    pub fn problem(&self, whole: &ContactProblem) -> ContactProblem {
        let constants = self.constants(whole);
        let laws = self.pairs.iter().map(|&pair| whole.laws[pair].with_gap(0.0)).collect();
        let load = DVector::from_iterator(self.joints.len(), self.joints.iter().map(|&joint| constants[joint]));
        ContactProblem::exactly(&self.system, laws, load)
    }

    /// The scheme of the whole from one of the part, at which these are the unknowns of its joints.
    pub fn spread(&self, whole: (&ContactProblem, &ContactLcp), part: Scheme<'_>) -> Basis {
        let moved = &self.mixed * self.over_all(part.unknowns) + self.constants(whole.0);
        self.scheme(whole, &part, &moved, None)
    }

    /// The scheme of the whole that a collapse of the part ends in, as its `direction` closes the first open pair: the scheme of the
    /// ray, with that pair closed. `open`: z of all joints. `None` where nothing closes.
    pub fn closed_by_collapse(
        &self,
        (whole, contact): (&ContactProblem, &ContactLcp),
        collapse: Scheme<'_>,
        open: &DVector<f64>,
    ) -> Option<Basis> {
        let motion = &self.mixed * self.over_all(collapse.unknowns);
        let closes = |pair: &usize| !self.pairs.contains(pair) && motion[*pair] < 0.0;
        let after = |pair: usize| -open[pair] / motion[pair];
        let closing = (0..whole.laws.len()).filter(closes).min_by(|&a, &b| after(a).total_cmp(&after(b)))?;
        Some(self.scheme((whole, contact), &collapse, &motion, Some(closing)))
    }

    fn over_all(&self, part: &DVector<f64>) -> DVector<f64> {
        let mut all = DVector::zeros(self.mixed.nrows());
        self.joints.iter().zip(part.iter()).for_each(|(&joint, own)| all[joint] = *own);
        all
    }

    /// `moved`: in which sense joints that carry nothing move.
    fn scheme(
        &self,
        (whole, contact): (&ContactProblem, &ContactLcp),
        part: &Scheme<'_>,
        moved: &DVector<f64>,
        closing: Option<usize>,
    ) -> Basis {
        let of_part = |row: RowId| {
            let pair = self.pairs.iter().position(|own| *own == row.pair)?;
            part.contact.rows.iter().position(|own| *own == RowId { pair, couple: row.couple })
        };
        // Whether the displacement of a couple is free, rather than its force.
        let moves = |row: RowId| match of_part(row) {
            Some(at) => part.basis.z.contains(&at) != part.contact.swapped[at],
            None => match (row.couple, whole.system.pairs[row.pair].plane_tangential()) {
                (RowKind::Normal, _) | (_, None) => closing != Some(row.pair),
                (RowKind::PLUS, Some(joint)) => moved[joint] >= 0.0,
                (RowKind::Facet(_), Some(joint)) => moved[joint] < 0.0,
            },
        };
        let z: Vec<usize> =
            (0..contact.rows.len()).filter(|&row| moves(contact.rows[row]) != contact.swapped[row]).collect();
        Basis { active: z.clone(), z, p: false }
    }
}

/// A scheme of a part: its LCP, the basis, and the unknowns of its joints at its vertex or along its ray.
#[derive(Clone, Copy)]
pub struct Scheme<'a> {
    /// The LCP of the part.
    pub contact: &'a ContactLcp,
    /// Which variables are basic there.
    pub basis: &'a Basis,
    /// Displacements, of joints in force form forces.
    pub unknowns: &'a DVector<f64>,
}

/// Joints that change sides: their force becomes the unknown in place of their displacement, or the other way round.
struct Sides {
    mixed: DMatrix<f64>,
    forced: Vec<bool>,
    changed: Vec<bool>,
}

impl Sides {
    /// Makes the force the unknown of all joints that carry nothing, and the displacement that of as many of the others as can be.
    /// `None` where what one of the former does is not told by the others.
    fn change(&mut self, carries_nothing: &[bool]) -> Option<()> {
        let k = self.forced.len();
        let diagonal = self.mixed.diagonal();
        for repeating in (0..k).filter(|&joint| !carries_nothing[joint]) {
            let factor = |sides: &Sides, joint: usize| sides.mixed[(repeating, joint)].abs();
            let apt = (0..k).filter(|&joint| carries_nothing[joint] && !self.forced[joint]);
            let largest = apt.max_by(|&a, &b| factor(self, a).total_cmp(&factor(self, b)));
            // An entry that is rounding beside the others of its row is no dependence.
            let Some(joint) = largest.filter(|_| self.forced[repeating]) else { continue };
            let row = (0..k).filter(|&other| !self.forced[other]).map(|other| factor(self, other)).fold(0.0, f64::max);
            if factor(self, joint) > NOISE * row {
                self.pivot(&[joint, repeating])?;
            }
        }
        loop {
            let open = (0..k).filter(|&joint| carries_nothing[joint] && !self.forced[joint]);
            let share = |joint: usize| self.mixed[(joint, joint)] / diagonal[joint];
            let Some(joint) = open.max_by(|&a, &b| share(a).total_cmp(&share(b))) else { return Some(()) };
            if diagonal[joint] <= 0.0 || share(joint) <= NEARLY {
                return None;
            }
            self.pivot(&[joint])?;
        }
    }

    /// The principal pivot transform on a block.
    fn pivot(&mut self, block: &[usize]) -> Option<()> {
        let (k, size) = (self.forced.len(), block.len());
        let inverse = DMatrix::from_fn(size, size, |a, b| self.mixed[(block[a], block[b])]).try_inverse()?;
        let columns = DMatrix::from_fn(k, size, |i, b| self.mixed[(i, block[b])]) * &inverse;
        let rows = DMatrix::from_fn(size, k, |a, j| self.mixed[(block[a], j)]);
        self.mixed -= &columns * &rows;
        let across = &inverse * rows;
        for (a, &joint) in block.iter().enumerate() {
            for other in 0..k {
                self.mixed[(other, joint)] = columns[(other, a)];
                self.mixed[(joint, other)] = -across[(a, other)];
            }
            (self.forced[joint], self.changed[joint]) = (!self.forced[joint], !self.changed[joint]);
        }
        for (a, &i) in block.iter().enumerate() {
            for (b, &j) in block.iter().enumerate() {
                self.mixed[(i, j)] = inverse[(a, b)];
            }
        }
        Some(())
    }

    /// Whether the force of a tangential joint does not enter that of the normal one.
    fn is_unfelt(&self, pair: usize, joint: usize) -> bool {
        let row = self.mixed.row(pair).amax();
        self.mixed[(pair, joint)].abs() <= NOISE * row
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::force_form::{Dependence, Repeats, with_repeated};
    use crate::contact::full_lcp::tests::{coulomb, plain};

    /// Two opposed pairs at one node on a spring of 3 along the normal and of 2 along t; the first is open by a gap of 0.5. What is
    /// left is the second pair alone, on the same springs.
    #[test]
    fn an_open_pair_leaves_its_node_to_the_opposite_one() {
        let opposed = [[(0, -1.0)], [(2, -1.0)]];
        let repeated = (opposed.iter().zip([1, 3])).map(|(terms, joint)| Repeats { joint, terms }).collect();
        let mut system = coulomb(DMatrix::from_row_slice(2, 2, &[3.0, 0.0, 0.0, 2.0]));
        system.pairs = coulomb(DMatrix::zeros(4, 4)).pairs;
        let system = with_repeated(system, &Dependence { independent: &[0, 2], repeated, offsets: Vec::new() });
        let mut whole = plain(&system, 0.5, &[-7.0, 0.0, 1.0, 0.0]).with_gaps(&[0.5, 0.0]);
        whole.set_load(DVector::from_row_slice(&[-7.0, 0.0, 1.0, 0.0]));
        let part = FeltPart::new(&system, &[true, false, true, false]).expect("a part");
        let alone = part.problem(&whole);
        assert_eq!(alone.system.force_form, None);
        assert_eq!(alone.system.stiffness, DMatrix::from_row_slice(2, 2, &[3.0, 0.0, 0.0, 2.0]));
        // λ₁ = 3 (z₁ − 0.5) − 7 and λ₂ = −λ₁ where the first carries nothing and z₂ = −(z₁ − 0.5): λ₂ = 3 z₂ + 7.
        assert_eq!(alone.joint_constants(), DVector::from_row_slice(&[7.0, -1.0]));
    }
}
