//! The certificate of a contact system that a file gives, in exact arithmetic: its numbers are the data, so that the
//! motions which cost no energy are known to the last digit, and motions without any room prove as much as others.
//!
//! ```text
//!   R ζ = 0,  ζ = Σ y_k motion_k:    ζ_n ± f ζ_τ ≥ 0,   v ≥ |ζ_τ|,   −RF·ζ − Σ c v ≥ 1
//! ```
//! An exact linear program over y and v; a point of it is the certificate, and where it has none there are contact
//! forces that balance the loads.

use std::time::Instant;

use nalgebra::DVector;
use num_rational::BigRational;
use num_traits::{One, Zero};

use super::proof::{Certificate, CertificateSearch};
use crate::contact::law::{PairLaw, SENSES};
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::ExactSystem;
use crate::lcp::exact::dyadic::{WholeRows, nearest, rational};
use crate::lcp::exact::polyhedron::{Polyhedron, State};
use crate::lcp::exact::rational_solve::null_space;
use crate::watch::until;

/// Most pairs.
const MOST_PAIRS: usize = 60;

/// Looks for a certificate until `end`.
pub(super) fn certify_exactly(problem: &ContactProblem, end: Instant) -> CertificateSearch {
    let system = &*problem.system;
    if system.file.is_none() || system.pair_count() > MOST_PAIRS || system.kernel.ncols() == 0 {
        return CertificateSearch::default();
    }
    let exact = ExactSystem::new(problem);
    let mut whole = WholeRows::default();
    exact.stiffness.iter().for_each(|row| whole.push_rational(row));
    let Some(motions) = null_space(&whole.rows, &mut |_| until(end)) else {
        return CertificateSearch { certificate: None, out_of_time: true };
    };
    let laws = &problem.laws;
    let rows = program(&exact, laws, &motions);
    let free: Vec<usize> = (0..motions.len()).collect();
    let columns = motions.len() + laws.iter().filter(|law| law.fixed_bound() > 0.0).count();
    let mut polyhedron = Polyhedron::new(columns, rows, &free);
    match polyhedron.restore(&mut || until(end).is_continue()) {
        State::Feasible => {}
        State::Empty => return CertificateSearch::default(),
        State::Stopped => return CertificateSearch { certificate: None, out_of_time: true },
    }
    let direction: Vec<BigRational> = (0..system.joint_count())
        .map(|joint| (0..motions.len()).map(|k| polyhedron.value(k) * &motions[k][joint]).sum())
        .collect();
    let power: BigRational = -direction.iter().zip(&exact.constants).map(|(z, load)| z * load).sum::<BigRational>();
    let slip = |pair: usize| system.pairs[pair].plane_tangential().map_or(0.0, |joint| nearest(&direction[joint]));
    let dissipation: f64 = laws.iter().enumerate().map(|(i, law)| law.fixed_bound() * slip(i).abs()).sum();
    let direction = DVector::from_iterator(direction.len(), direction.iter().map(nearest));
    let largest = direction.amax();
    let certificate = Certificate {
        direction: direction / largest,
        power: nearest(&power) / largest,
        dissipation: dissipation / largest,
        exact: true,
        amounts: Vec::new(),
    };
    CertificateSearch { certificate: Some(certificate), out_of_time: false }
}

/// The inequalities over y, one v for every pair with cohesion or a known bound, and the constant.
fn program(exact: &ExactSystem<'_>, laws: &[PairLaw], motions: &[Vec<BigRational>]) -> WholeRows {
    let count = motions.len();
    let own: Vec<usize> = (0..laws.len()).filter(|&pair| laws[pair].fixed_bound() > 0.0).collect();
    let width = count + own.len() + 1;
    let mut rows = WholeRows::default();
    let mut surplus = vec![BigRational::zero(); width];
    surplus[width - 1] = -BigRational::one();
    for (entry, motion) in surplus.iter_mut().zip(motions) {
        *entry = -motion.iter().zip(&exact.constants).map(|(z, load)| z * load).sum::<BigRational>();
    }
    // by_n ζ_n + by_τ ζ_τ + v of the pair ≥ 0.
    let mut add = |pair: usize, [by_n, by_t]: [BigRational; 2], v: Option<usize>| {
        let mut row = vec![BigRational::zero(); width];
        for (entry, motion) in row.iter_mut().zip(motions) {
            let tangential = exact.problem.system.pairs[pair]
                .plane_tangential()
                .map_or(BigRational::zero(), |joint| motion[joint].clone());
            *entry = &by_n * &motion[pair] + &by_t * tangential;
        }
        if let Some(v) = v {
            row[count + v] = BigRational::one();
        }
        rows.push_rational(&row);
    };
    let (one, zero) = (BigRational::one, BigRational::zero);
    for (pair, law) in laws.iter().enumerate() {
        let f = law.friction();
        if law.is_bilateral() {
            add(pair, [one(), zero()], None);
            add(pair, [-one(), zero()], None);
        } else if f > 0.0 {
            SENSES.iter().for_each(|side| add(pair, [one(), rational(side * f)], None));
        } else {
            add(pair, [one(), zero()], None);
        }
        if let Some(v) = own.iter().position(|&own| own == pair) {
            add(pair, [zero(), one()], Some(v));
            add(pair, [zero(), -one()], Some(v));
            surplus[count + v] = -rational(law.fixed_bound());
        }
    }
    rows.push_rational(&surplus);
    rows
}
