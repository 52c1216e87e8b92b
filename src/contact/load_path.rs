//! The LCP of a contact problem whose load grows: load + t · increment in the place of the covering.

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

/// Whether all variables of `basis` are ≥ 0 (up to rounding) in this LCP.
pub fn is_answer(lcp: &MirroredLcp, basis: &Basis) -> bool {
    let Some(point) = vertex(lcp, basis) else {
        return false;
    };
    let force = lcp.q.amax().max(point.w.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    let length = point.z.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    point.w.iter().all(|w| *w >= -1e-11 * force) && point.z.iter().all(|z| *z >= -1e-11 * length)
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
    if system.force_form.is_some() {
        let fixed = problem.fixed_bounds();
        let mut lcp = MirroredLcp::clone(&contact.lcp);
        lcp.q = constants(system, &contact, &problem.joint_constants(), &fixed);
        lcp.covering = constants(system, &contact, increment, &vec![0.0; fixed.len()]);
        contact.lcp = Arc::new(lcp);
        return contact;
    }
    let unit = contact.force_unit;
    let load = problem.joint_constants();
    let mut lcp = MirroredLcp::clone(&contact.lcp);
    for (i, pair) in system.pairs.iter().enumerate() {
        if let Some(row) = contact.normal_row[i] {
            lcp.q[row] = load[i] / unit;
            lcp.covering[row] = increment[i] / unit;
        }
        if let (Some(row), Some(joint)) = (contact.plus_row[i], pair.tangential) {
            let f = problem.laws[i].friction();
            lcp.q[row] = load[joint] / unit + f * (load[i] / unit) + problem.laws[i].fixed_bound() / unit;
            lcp.covering[row] = increment[joint] / unit + f * (increment[i] / unit);
            if let Some(mirror) = &mut lcp.mirrors[row] {
                mirror.covering = 0.0;
            }
        }
    }
    contact.lcp = Arc::new(lcp);
    contact
}
