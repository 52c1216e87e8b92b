//! Joints that repeat others: their rows of B depend on those of other joints, supports and ties.
//!
//! ```text
//!     z_D = Σ factor·z_I        (and what supports that settle impose)
//! ```
//! The others are independent and make R. Which joints are taken for repeated ones is a choice: normals rather than
//! tangentials, so that a repeated tangential joint follows from tangential joints alone, and no force of a normal
//! joint depends on that of a repeated tangential one. Where it does, both joints of the pair must be repeated, or friction
//! is implicit (contact, `force_form`). Normals that are held both ways come first.

use super::joint_rows::JointRow;
use crate::model::pair::{Joint, JointDirection};
use crate::model::structure::Structure;

/// A joint that repeats others.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeated {
    /// Index of the joint.
    pub joint: usize,
    /// Its z as a combination of those of independent joints: (joint, factor).
    pub terms: Vec<(usize, f64)>,
}

impl Repeated {
    /// From the row that is left of a joint, which says Σ coefficient·z = 0; `None` where no other joint is in it:
    /// supports and ties hold it.
    pub(super) fn of(joint: usize, row: &JointRow, joints: usize) -> Option<Repeated> {
        let others = row.joints.iter().map(|(&j, &a)| (j as usize, -a));
        // Numbers beyond those of the joints are imposed displacements.
        let terms: Vec<(usize, f64)> = others.filter(|(j, _)| *j != joint && *j < joints).collect();
        (!terms.is_empty()).then_some(Repeated { joint, terms })
    }
}

/// Whether no friction of a repeated tangential joint depends on itself: the normal joint of its pair is repeated too, or
/// feels no repeated tangential joint.
pub(super) fn is_explicit(repeated: &[Repeated], joints: &[Joint]) -> bool {
    let is_tangential = |index: usize| joints[index].direction != JointDirection::Normal;
    let tangential: Vec<&Repeated> = repeated.iter().filter(|one| is_tangential(one.joint)).collect();
    let is_own = |joint: usize, of: usize| joints[joint].pair == joints[of].pair;
    tangential.iter().all(|one| {
        let normal_follows = repeated.iter().any(|other| !is_tangential(other.joint) && is_own(other.joint, one.joint));
        let felt = |joint: usize| !is_tangential(joint) && is_own(joint, one.joint);
        normal_follows || !tangential.iter().any(|other| other.terms.iter().any(|(joint, _)| felt(*joint)))
    })
}

/// The joints in the order in which they are taken for independent: bilateral normals, tangentials, other normals.
pub(super) fn by_preference(structure: &Structure, joints: &[Joint]) -> Vec<usize> {
    let place = |joint: &Joint| match joint.direction {
        JointDirection::Normal if structure.pairs[joint.pair].law.is_bilateral() => 0,
        JointDirection::Tangential(_) => 1,
        JointDirection::Normal => 2,
    };
    let mut order: Vec<usize> = (0..joints.len()).collect();
    order.sort_by_key(|&index| place(&joints[index]));
    order
}
