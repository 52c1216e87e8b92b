//! The motion that proves a collapse, with its work, in rationals.
//!
//! ```text
//!   R ζ = 0;   ζ_n ≥ f |ζ_t| (bound pairs: ζ_n = 0);   work −load·ζ > bound Σ c |ζ_t|
//! ```
//! On ζ forces within the laws' bounds take at most the bound, and the loads do more: nothing balances them.

use std::collections::HashMap;

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::MOST_MOTIONS;
use super::forms::of_contact;
use super::system::ProvedContact;
use super::tree::{Sum, contradiction};
use crate::contact::law::TangentialJoint;
use crate::contact::problem::ContactProblem;
use crate::explain::certificate::certify;
use crate::explain::motions::FreeMotions;
use crate::explain::ray::Built;
use crate::lcp::exact::dyadic::rational;
use crate::lcp::exact::polyhedron::State;
use crate::watch::Watch;

/// Most pairs of which the motion is found by exact linear programming.
const MOST_PAIRS: usize = 60;

/// The proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Collapse {
    /// ζ over all 2m joints.
    pub motion: Vec<BigRational>,
    /// How much of each motion of the kernel it is made of; empty where R ζ = 0 by the numbers of R.
    pub amounts: Vec<BigRational>,
    /// −load·ζ.
    pub work: BigRational,
    /// Σ c |ζ_t| < work.
    pub bound: BigRational,
}

/// Looks for the proof: by the fast certificate of a structure, else exactly.
pub fn collapse(
    problem: &ContactProblem,
    built: Built<'_>,
    contact: &ProvedContact,
    watch: &dyn Watch,
) -> Option<Collapse> {
    watch.progress("collapse motion", 0.0);
    if built.is_some() {
        let found = certify(problem, &FreeMotions::new(&problem.system, built)).certificate;
        let amounts = found.map(|found| found.amounts).filter(|amounts| amounts.len() == contact.kernel.len());
        if let Some(proof) = amounts.and_then(|amounts| made_of(contact, amounts)) {
            return Some(proof);
        }
    }
    if contact.ids.len() > MOST_PAIRS || contact.kernel.len() > MOST_MOTIONS {
        return None;
    }
    let stiffness = contact.exact_stiffness();
    let forms = of_contact(contact, &stiffness);
    let (polyhedron, (state, pinned)) = forms.start(&mut || !watch.stop());
    if state != State::Empty {
        return None;
    }
    let sum = contradiction(&forms, &polyhedron, pinned)?;
    let motion = motion_of(contact, sum);
    let force = |row: &Vec<BigRational>| row.iter().zip(&motion).map(|(r, z)| r * z).sum::<BigRational>();
    if stiffness.iter().any(|row| !force(row).is_zero()) {
        return None;
    }
    verified(contact, motion, Vec::new())
}

/// ζ as so much of each motion of the kernel.
fn made_of(contact: &ProvedContact, amounts: Vec<BigRational>) -> Option<Collapse> {
    let mut motion = vec![BigRational::zero(); contact.load.len()];
    for (column, amount) in contact.kernel.iter().zip(&amounts) {
        for (sum, entry) in motion.iter_mut().zip(column.iter()).filter(|(_, entry)| **entry != 0.0) {
            *sum += rational(*entry) * amount;
        }
    }
    verified(contact, motion, amounts)
}

/// The motion behind a contradiction of the signs of forces: the factors of x_n, x+, x- and x_t over the joints. With R
/// positive semidefinite R ζ = 0, because ζᵀR ζ ≤ 0.
fn motion_of(contact: &ProvedContact, sum: Sum) -> Vec<BigRational> {
    let m = contact.ids.len();
    let mut factors: HashMap<usize, BigRational> = sum.into_iter().collect();
    // The forms follow the unknowns, those of a pair one another.
    let mut variables = 2 * m..;
    let mut next = || variables.next().and_then(|variable| factors.remove(&variable)).unwrap_or_default();
    let mut motion = vec![BigRational::zero(); 2 * m];
    for (pair, law) in contact.laws.iter().enumerate() {
        motion[pair] = next();
        motion[m + pair] = match law.tangential {
            TangentialJoint::Free => next(),
            TangentialJoint::Bounded { friction, .. } => {
                let (plus, minus) = (next(), next());
                motion[pair] += rational(friction) * (&plus + &minus);
                plus - minus
            }
        };
    }
    motion
}

/// The proof of a motion with R ζ = 0, if every sign of it holds.
fn verified(contact: &ProvedContact, motion: Vec<BigRational>, amounts: Vec<BigRational>) -> Option<Collapse> {
    let m = contact.ids.len();
    let mut bound = BigRational::zero();
    for (pair, law) in contact.laws.iter().enumerate() {
        let (normal, slip) = (&motion[pair], motion[m + pair].abs());
        let least = match law.tangential {
            TangentialJoint::Free => BigRational::zero(),
            TangentialJoint::Bounded { friction, fixed } => {
                bound += rational(fixed) * &slip;
                rational(friction) * &slip
            }
        };
        let holds = if law.is_bilateral() { normal.is_zero() } else { *normal >= least };
        if !holds {
            return None;
        }
    }
    let work = -motion.iter().zip(contact.load.iter()).map(|(z, load)| z * rational(*load)).sum::<BigRational>();
    (work > bound).then_some(Collapse { motion, amounts, work, bound })
}
