//! The fresh check: the laws of contact evaluated from R, RF and f, without the LCP or any engine.

use super::pairs::JointState;
use super::record::Check;
use crate::contact::complementarity::load_with_gaps;
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::model::pair::Law;

/// Largest relative violation that an answer may have.
pub const TOLERANCE: f64 = 1e-9;

/// Checks an answer over the joints. Forces are relative to the largest joint force or load (gaps closed by force are
/// a load), displacements to the largest |z|, products to both. `equilibrium` is ‖K u − F − Bᵀλ‖ relative, where there is a K.
pub fn check_contact(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    state: &JointState,
    equilibrium: Option<f64>,
) -> Check {
    let force = state.force.amax().max(numbers.load.amax()).max(load_with_gaps(system, numbers).amax());
    let length = state.z.amax();
    let relative = |value: f64, size: f64| if size > 0.0 { value / size } else { value };
    let mut check = Check { equilibrium, ..Check::default() };
    let mut couple = |x: f64, z: f64| {
        check.min_w = check.min_w.min(relative(x, force));
        check.min_z = check.min_z.min(relative(z, length));
        let product = relative(x, force) * relative(z, length);
        check.complementarity = check.complementarity.max(product.abs());
    };
    for (i, pair) in system.pairs.iter().enumerate() {
        let x_n = state.force[i];
        let bound = match pair.law {
            Law::Bound { .. } => numbers.bound[i],
            Law::Coulomb { .. } => {
                couple(x_n, state.z[i]);
                numbers.friction[i] * x_n + numbers.cohesion[i]
            }
            Law::Frictionless { .. } => {
                couple(x_n, state.z[i]);
                continue;
            }
        };
        let Some(joint) = pair.tangential else {
            continue;
        };
        let (x_t, z_t) = (state.force[joint], state.z[joint]);
        couple(bound + x_t, z_t.max(0.0));
        couple(bound - x_t, (-z_t).max(0.0));
    }
    check.passed = accepted(&check);
    check
}

/// Checks an answer of a bare LCP from M and q; w is computed afresh.
pub fn check_plain(lcp: &MirroredLcp, point: &Point) -> Check {
    let z = &point.z;
    let matrix = lcp.matrix();
    let response = lcp.times(z);
    let length = z.iter().fold(0.0, |a: f64, z| a.max(z.abs()));
    let mut check = Check::default();
    for i in 0..lcp.size() {
        let w = response[i] + lcp.q[i];
        // Each row is judged against the terms it sums.
        let size = lcp.q[i].abs().max((0..lcp.size()).map(|j| (matrix[(i, j)] * z[j]).abs()).fold(0.0, f64::max));
        let w = if size > 0.0 { w / size } else { w };
        let z = if length > 0.0 { z[i] / length } else { 0.0 };
        check.min_w = check.min_w.min(w);
        check.min_z = check.min_z.min(z);
        check.complementarity = check.complementarity.max((w * z).abs());
    }
    check.passed = accepted(&check);
    check
}

fn accepted(check: &Check) -> bool {
    // Written so that a NaN anywhere is a failure.
    check.min_w >= -TOLERANCE
        && check.min_z >= -TOLERANCE
        && check.complementarity <= TOLERANCE
        && check.equilibrium.is_none_or(|residual| residual <= TOLERANCE)
}
