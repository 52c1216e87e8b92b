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
use crate::lcp::outcome::Point;
use crate::lcp::variable::Variable;
use crate::model::rules::Covering;

/// Whether all variables of `basis` are ≥ 0 (up to rounding) in this LCP. A displacement is as good as 0 beside the others, or
/// where no force feels it: where nothing has moved yet there are no others.
pub fn is_answer(lcp: &MirroredLcp, basis: &Basis) -> bool {
    vertex(lcp, basis).is_some_and(|point| obeys_signs(lcp, &point, &|_| 0.0))
}

/// The same of a vertex, where the entry of a row that is a displacement may be rounding up to `still`.
pub fn obeys_signs(lcp: &MirroredLcp, point: &Point, still: &dyn Fn(Variable) -> f64) -> bool {
    let force = lcp.q.amax().max(point.w.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    let length = point.z.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let felt = |(z, (row, _)): (&f64, (usize, bool))| lcp.scale.row[row] * lcp.scale.column[row] * z.abs();
    let w_obeys = |(row, w): (usize, &f64)| *w >= -1e-11 * force || *w >= -still(Variable::W(row));
    let z_obeys = |(row, one): (usize, (&f64, (usize, bool)))| {
        *one.0 >= -1e-11 * length || felt(one) <= 1e-11 * force || *one.0 >= -still(Variable::Z(row))
    };
    point.w.iter().enumerate().all(w_obeys) && point.z.iter().zip(lcp.primary_rows()).enumerate().all(z_obeys)
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
