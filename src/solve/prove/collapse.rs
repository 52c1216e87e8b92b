//! The motion that proves a collapse, with its work, in rationals.
//!
//! ```text
//!   R ζ = 0;   ζ_n ≥ f |ζ_t| (bound pairs: ζ_n = 0);   work −load·ζ > bound Σ c |ζ_t|
//! ```
//! On ζ forces within the laws' bounds take at most the bound, and the loads do more: nothing balances them. In space
//! |ζ_t| is the length of a vector where the proof is about Coulomb's cone, bounded from above by a fraction; where it
//! is about the polygon, |ζ_t| is a + b of the slip a d_k + b d_(k+1).

use std::collections::HashMap;

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::forms::of_contact;
use super::system::ProvedContact;
use super::tree::{Sum, contradiction};
use super::{MOST_MOTIONS, MOST_PAIRS_OF_MOTION};
use crate::contact::law::TangentialJoint;
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::explain::certificate::certify;
use crate::explain::motions::FreeMotions;
use crate::explain::ray::Built;
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::exact::polyhedron::State;
use crate::watch::Watch;

/// The proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Collapse {
    /// ζ over all joints.
    pub motion: Vec<BigRational>,
    /// For every pair what counts as |ζ_t|; empty in the plane, where it is the absolute value.
    pub slips: Vec<BigRational>,
    /// Whether it is about Coulomb's cone, or in the plane; otherwise about the polygon.
    pub on_cone: bool,
    /// Its coefficients over the motions of the kernel; empty where R ζ = 0 by the numbers of R.
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
    if contact.ids.len() > MOST_PAIRS_OF_MOTION || contact.kernel.len() > MOST_MOTIONS {
        return None;
    }
    let stiffness = contact.exact_stiffness();
    let forms = of_contact(contact, &stiffness);
    let (polyhedron, (state, pinned)) = forms.start(&mut || !watch.stop());
    if state != State::Empty {
        return None;
    }
    let sum = contradiction(&polyhedron, pinned)?;
    let motion = motion_of(contact, sum);
    let force = |row: &Vec<BigRational>| row.iter().zip(&motion).map(|(r, z)| r * z).sum::<BigRational>();
    if stiffness.iter().any(|row| !force(row).is_zero()) {
        return None;
    }
    verified(contact, motion, Vec::new())
}

/// ζ from its coefficients over the motions of the kernel.
fn made_of(contact: &ProvedContact, amounts: Vec<BigRational>) -> Option<Collapse> {
    let mut motion = vec![BigRational::zero(); contact.load.len()];
    for (column, amount) in contact.kernel.iter().zip(&amounts) {
        for (sum, entry) in motion.iter_mut().zip(column.iter()).filter(|(_, entry)| **entry != 0.0) {
            *sum += rational(*entry) * amount;
        }
    }
    verified(contact, motion, amounts)
}

/// The motion behind a contradiction of the signs of forces: the factors of x_n, of the reserves and of x_t over the joints.
/// With R positive semidefinite R ζ = 0, because ζᵀR ζ ≤ 0.
fn motion_of(contact: &ProvedContact, sum: Sum) -> Vec<BigRational> {
    let mut factors: HashMap<usize, BigRational> = sum.into_iter().collect();
    // The forms stand after the unknowns, pair by pair.
    let mut variables = contact.load.len()..;
    let mut next = || variables.next().and_then(|variable| factors.remove(&variable)).unwrap_or_default();
    let mut motion = vec![BigRational::zero(); contact.load.len()];
    for (pair, law) in contact.laws.iter().enumerate() {
        motion[pair] = next();
        match law.tangential {
            TangentialJoint::Free => contact.slips(pair).for_each(|joint| motion[joint] = next()),
            TangentialJoint::Bounded { friction, .. } => {
                for facet in 0..contact.polygon.facets() {
                    let factor = next();
                    motion[pair] += rational(friction) * &factor;
                    for (joint, part) in contact.slips(pair).zip(contact.polygon.direction(facet)) {
                        motion[joint] += rational(part) * &factor;
                    }
                }
                // The forms turn^k are about slips, not forces: they contribute nothing to ζ.
                let turns = if contact.tangents == 1 { 0 } else { contact.polygon.half() };
                (0..turns).for_each(|_| drop(next()));
            }
        }
    }
    motion
}

/// The proof of a motion with R ζ = 0, if every sign of it holds: on the cone where that is what friction is, else on the
/// polygon.
fn verified(contact: &ProvedContact, motion: Vec<BigRational>, amounts: Vec<BigRational>) -> Option<Collapse> {
    let ways = match (contact.tangents, contact.cone) {
        (1, _) => &[true][..],
        (_, true) => &[true, false],
        (_, false) => &[false],
    };
    ways.iter().find_map(|&on_cone| verified_on(contact, &motion, &amounts, on_cone))
}

fn verified_on(
    contact: &ProvedContact,
    motion: &[BigRational],
    amounts: &[BigRational],
    on_cone: bool,
) -> Option<Collapse> {
    let mut bound = BigRational::zero();
    let mut slips = Vec::new();
    for (pair, law) in contact.laws.iter().enumerate() {
        let normal = &motion[pair];
        let slip = match &motion[contact.slips(pair)] {
            [along] => along.abs(),
            [along, across] if on_cone => length_above(along, across),
            [along, across] => gauge(contact.polygon, along, across)?,
            _ => return None,
        };
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
        if contact.tangents > 1 {
            slips.push(slip);
        }
    }
    let work = -motion.iter().zip(contact.load.iter()).map(|(z, load)| z * rational(*load)).sum::<BigRational>();
    let (motion, amounts) = (motion.to_vec(), amounts.to_vec());
    (work > bound).then_some(Collapse { motion, slips, on_cone, amounts, work, bound })
}

/// A fraction that is no less than the length of a vector, and hardly more.
fn length_above(along: &BigRational, across: &BigRational) -> BigRational {
    if along.is_zero() || across.is_zero() {
        return along.abs() + across.abs();
    }
    let square = along * along + across * across;
    // The larger component keeps the root in the range of f64.
    let unit = along.abs().max(across.abs());
    let relative = nearest(&(&square / (&unit * &unit))).sqrt();
    let mut factor = relative;
    loop {
        let length = rational(factor) * &unit;
        if &length * &length >= square {
            return length;
        }
        factor = factor.next_up();
    }
}

/// a + b of a slip a d_k + b d_(k+1), a and b ≥ 0: the most that forces within the polygon can do on it per unit of
/// their bound.
fn gauge(polygon: Polygon, along: &BigRational, across: &BigRational) -> Option<BigRational> {
    let directions: Vec<[BigRational; 2]> =
        (0..polygon.facets()).map(|facet| polygon.direction(facet).map(rational)).collect();
    (0..directions.len()).find_map(|facet| {
        let [[a, b], [c, d]] = [&directions[facet], &directions[(facet + 1) % directions.len()]];
        let area = a * d - b * c;
        let (first, second) = ((along * d - across * c) / &area, (a * across - b * along) / &area);
        (!first.is_negative() && !second.is_negative()).then(|| first + second)
    })
}
