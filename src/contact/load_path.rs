//! The LCP of a contact problem whose load grows: load + t · increment in place of the covering.

use std::sync::Arc;

use nalgebra::DVector;

use super::force_form::constants;
use super::problem::ContactProblem;
use crate::contact::lcp::contact_lcp;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::mirrored::MirroredLcp;
use crate::model::rules::Covering;

/// Whether all variables of `basis` are ≥ 0 (up to rounding) in this LCP. A displacement is as good as 0 beside the others, or
/// where no force feels it: where nothing has moved yet there are no others.
pub fn is_answer(lcp: &MirroredLcp, basis: &Basis) -> bool {
    let Some(point) = vertex(lcp, basis) else {
        return false;
    };
    let force = lcp.q.amax().max(point.w.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    let length = point.z.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let felt = |(z, (row, _)): (&f64, (usize, bool))| lcp.scale.row[row] * lcp.scale.column[row] * z.abs();
    point.w.iter().all(|w| *w >= -1e-11 * force)
        && point.z.iter().zip(lcp.primary_rows()).all(|one| *one.0 >= -1e-11 * length || felt(one) <= 1e-11 * force)
}

/// The dimensionless LCP of base + t · increment: q is that of `problem`, the covering that of the increment of the
/// load (t in the user's units of the increment's factor).
pub fn path_lcp(problem: &ContactProblem, increment: &DVector<f64>) -> ContactLcp {
    let system = &*problem.system;
    let mut reference = problem.clone();
    if problem.joint_constants().amax() == 0.0 {
        reference.set_load(increment.clone());
    }
    // `ones` covers everything; only the matrix, the units and the rows are taken from it.
    let mut contact = match contact_lcp(&reference, Covering::Ones) {
        Ok(contact) => contact,
        Err(_) => unreachable!("covering ones fits all numbers"),
    };
    let (load, fixed) = (problem.joint_constants(), problem.fixed_bounds());
    let nothing = vec![0.0; fixed.len()];
    let mut lcp = MirroredLcp::clone(&contact.lcp);
    if system.force_form.is_some() {
        lcp.q = constants(system, &contact, &load, &fixed);
        lcp.covering = constants(system, &contact, increment, &nothing);
    } else {
        let friction = problem.frictions();
        lcp.q = contact.force_rows(system, &load, &friction, &fixed);
        lcp.covering = contact.force_rows(system, increment, &friction, &nothing);
        lcp.mirrors.iter_mut().flatten().for_each(|mirror| mirror.covering = 0.0);
    }
    contact.lcp = Arc::new(lcp);
    contact
}
