//! The certificate of a contact system that a file gives, in exact arithmetic: its numbers are the data, so that the
//! motions which cost no energy are known to the last digit, and motions without any room prove as much as others.
//!
//! ```text
//!   R ζ = 0,  ζ = Σ y_k motion_k:    ζ_n ± f ζ_τ ≥ 0,   v ≥ |ζ_τ|,   −RF·ζ − Σ c v ≥ 1
//! ```
//! An exact linear program over y and v; a point of it is the certificate, and where it has none there are contact
//! forces that balance the loads. In space the friction of a pair lies in a polygon around the disk |x_τ| ≤ f x_n + c:
//! what is proved for the polygon holds for the disk, and between the two nothing is proved.

use std::time::Instant;

use nalgebra::DVector;
use num_rational::BigRational;
use num_traits::{One, Zero};

use super::proof::{Certificate, CertificateSearch};
use crate::contact::cone::ConePair;
use crate::contact::law::SENSES;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::ExactSystem;
use crate::lcp::exact::dyadic::{WholeRows, nearest, rational};
use crate::lcp::exact::polyhedron::{Polyhedron, State};
use crate::lcp::exact::rational_solve::null_space;
use crate::watch::until;

/// Most pairs.
const MOST_PAIRS: usize = 60;

/// Corners of a polygon of sixteen sides around the unit disk, in 64ths, in one eighth of the plane: its sides touch the disk
/// along the tangents, and no corner lies farther out than 1.023.
const CORNERS: [[i32; 2]; 2] = [[64, 13], [54, 37]];

/// The corners of what |x_τ| ≤ 1 stands for: ±1 in the plane, a polygon around the disk in space.
fn corners(tangents: usize) -> Vec<Vec<f64>> {
    match tangents {
        0 => Vec::new(),
        1 => SENSES.iter().map(|sense| vec![*sense]).collect(),
        _ => {
            let quarter = CORNERS.into_iter().flat_map(|[x, y]| [[x, y], [y, x]]);
            let all = quarter.flat_map(|[x, y]| [[x, y], [-y, x], [-x, -y], [y, -x]]);
            all.map(|corner| corner.map(|part| f64::from(part) / 64.0).to_vec()).collect()
        }
    }
}

/// Looks for a certificate until `end`; the pairs are those of the problem, with the friction that is to be proved too small.
/// `None` where the data are not exact, or too many.
pub(super) fn certify_exactly(problem: &ContactProblem, pairs: &[ConePair], end: Instant) -> Option<CertificateSearch> {
    let system = &*problem.system;
    if !system.has_exact_data() || system.pair_count() > MOST_PAIRS || system.kernel.ncols() == 0 {
        return None;
    }
    let exact = ExactSystem::new(problem);
    let mut whole = WholeRows::default();
    exact.stiffness.iter().for_each(|row| whole.push_rational(row));
    let Some(motions) = null_space(&whole.rows, &mut |_| until(end)) else {
        return Some(CertificateSearch { certificate: None, out_of_time: true });
    };
    let rows = program(&exact, pairs, &motions);
    let free: Vec<usize> = (0..motions.len()).collect();
    let columns = motions.len() + pairs.iter().filter(|pair| pair.law.fixed_bound() > 0.0).count();
    let mut polyhedron = Polyhedron::new(columns, rows, &free);
    match polyhedron.start(&mut || until(end).is_continue()) {
        State::Feasible => {}
        State::Empty => return Some(CertificateSearch::default()),
        State::Stopped => return Some(CertificateSearch { certificate: None, out_of_time: true }),
    }
    let direction: Vec<BigRational> = (0..system.joint_count())
        .map(|joint| (0..motions.len()).map(|k| polyhedron.value(k) * &motions[k][joint]).sum())
        .collect();
    let power: BigRational = -direction.iter().zip(&exact.constants).map(|(z, load)| z * load).sum::<BigRational>();
    let slip = |pair: &ConePair| pair.tangents.clone().map(|joint| nearest(&direction[joint])).fold(0.0, f64::hypot);
    let dissipation: f64 = pairs.iter().map(|pair| pair.law.fixed_bound() * slip(pair)).sum();
    let direction = DVector::from_iterator(direction.len(), direction.iter().map(nearest));
    let largest = direction.amax();
    let certificate = Certificate {
        direction: direction / largest,
        power: nearest(&power) / largest,
        dissipation: dissipation / largest,
        exact: true,
        of_this_load: false,
        amounts: Vec::new(),
    };
    Some(CertificateSearch { certificate: Some(certificate), out_of_time: false })
}

/// The inequalities over y, one v for every pair with cohesion or a known bound, and the constant.
fn program(exact: &ExactSystem<'_>, pairs: &[ConePair], motions: &[Vec<BigRational>]) -> WholeRows {
    let count = motions.len();
    let own: Vec<usize> = (0..pairs.len()).filter(|&pair| pairs[pair].law.fixed_bound() > 0.0).collect();
    let width = count + own.len() + 1;
    let mut rows = WholeRows::default();
    let mut surplus = vec![BigRational::zero(); width];
    surplus[width - 1] = -BigRational::one();
    for (entry, motion) in surplus.iter_mut().zip(motions) {
        *entry = -motion.iter().zip(&exact.constants).map(|(z, load)| z * load).sum::<BigRational>();
    }
    // by_n ζ_n + by · ζ_τ + v of the pair ≥ 0.
    let mut add = |pair: usize, by_n: f64, by: &[BigRational], v: Option<usize>| {
        let mut row = vec![BigRational::zero(); width];
        for (entry, motion) in row.iter_mut().zip(motions) {
            let slip = pairs[pair].tangents.clone().zip(by).map(|(joint, by)| by * &motion[joint]);
            *entry = rational(by_n) * &motion[pair] + slip.sum::<BigRational>();
        }
        if let Some(v) = v {
            row[count + v] = BigRational::one();
        }
        rows.push_rational(&row);
    };
    for (pair, ConePair { law, tangents }) in pairs.iter().enumerate() {
        let f = law.friction();
        let corners = corners(tangents.len());
        let times = |corner: &[f64], factor: f64| -> Vec<BigRational> {
            corner.iter().map(|part| rational(*part) * rational(factor)).collect()
        };
        if law.is_bilateral() {
            SENSES.iter().for_each(|sense| add(pair, *sense, &[], None));
        } else if f > 0.0 {
            corners.iter().for_each(|corner| add(pair, 1.0, &times(corner, f), None));
        } else {
            add(pair, 1.0, &[], None);
        }
        if let Some(v) = own.iter().position(|&own| own == pair) {
            corners.iter().for_each(|corner| add(pair, 0.0, &times(corner, 1.0), Some(v)));
            surplus[count + v] = -rational(law.fixed_bound());
        }
    }
    rows.push_rational(&surplus);
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every side of the polygon is at least as far from the origin as the disk is wide: for neighbours p and q
    /// |p × q| ≥ |q − p|; four of the sides touch it.
    #[test]
    fn the_polygon_holds_the_disk() {
        let mut corners = corners(2);
        corners.sort_by(|p, q| p[1].atan2(p[0]).total_cmp(&q[1].atan2(q[0])));
        assert_eq!(corners.len(), 16);
        let mut touching = 0;
        for (p, q) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            // Multiples of 1/64: these products are exact.
            let area = p[0] * q[1] - p[1] * q[0];
            let side = (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2);
            assert!(area > 0.0 && area * area >= side, "{p:?} {q:?}");
            touching += usize::from(area * area == side);
            assert!(p[0].hypot(p[1]) < 1.023);
        }
        assert_eq!(touching, 4);
    }
}
