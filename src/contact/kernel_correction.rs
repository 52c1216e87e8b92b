//! The last vertex of a ray, corrected by what is known exactly of the kernel.
//!
//! R is stored rounded, so Zᵀ R z is not quite 0 but of the size ε |R| |z|. Just beyond a limit p is as small as that:
//! at (1 + 1e-9) × the overturning load of two plates it cost the fifth digit of p. The forces λ = R z + RF have a
//! known part on the kernel, Zᵀ λ = Zᵀ RF; with it the equations of the basis are solved once more for what is missing.

use nalgebra::DVector;

use crate::contact::problem::ContactProblem;
use crate::contact::rows::RowKind;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::corrected;
use crate::lcp::outcome::Point;

/// w of all rows at a point, dimensionless, from forces whose kernel part is exact.
fn balanced_rows(problem: &ContactProblem, contact: &ContactLcp, point: &Point) -> Vec<f64> {
    let system = &*problem.system;
    let z: DVector<f64> = contact.joint_displacements(system, &point.z) * contact.length_unit;
    let mut force = system.pivot_stiffness() * z + problem.joint_constants();
    // Twice: the first step leaves rounding of the size it removed.
    for _ in 0..2 {
        let missing = system.kernel.transpose() * (&problem.load - &force);
        force += &system.kernel * missing;
    }
    contact
        .rows
        .iter()
        .map(|row| {
            let i = row.pair;
            let (d_n, d_t) = contact.covering_of(i);
            let own: f64 = row.joints(system, contact.polygon).map(|(joint, d)| d * force[joint]).sum();
            if row.couple == RowKind::Normal {
                return own / contact.force_unit + d_n * point.p;
            }
            let bound = problem.laws[i].bound(force[i]);
            (bound + own) / contact.force_unit + d_t * point.p
        })
        .collect()
}

/// The vertex of `basis` with its equations solved once more from forces whose kernel part is exact; the point as it
/// is where there is no kernel or the equations are singular.
pub fn kernel_correction(problem: &ContactProblem, contact: &ContactLcp, basis: &Basis, point: Point) -> Point {
    let system = &*problem.system;
    if system.kernel.ncols() == 0 || system.force_form.is_some() {
        return point;
    }
    let rows = balanced_rows(problem, contact, &point);
    let Some(mut found) = corrected(&contact.lcp, basis, &point, &rows) else {
        return point;
    };
    let clean = |value: &mut f64| *value = value.max(0.0);
    found.z.iter_mut().chain(&mut found.w).chain([&mut found.p]).for_each(clean);
    found
}
