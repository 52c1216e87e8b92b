//! Projections pair by pair: slow and sure-footed steps towards the cone, from where Newton's method can start again.

use nalgebra::DVector;

use super::{ConeFailure, ConeProblem, length};
use crate::watch::Watch;

/// Makes `sweeps` sweeps over the pairs, each pair moved to where its own laws hold with r for its stiffness.
pub(super) fn sweep(
    problem: &ConeProblem,
    scale: &DVector<f64>,
    z: &mut DVector<f64>,
    sweeps: usize,
    watch: &dyn Watch,
) -> Result<(), ConeFailure> {
    let mut force = problem.stiffness * &*z + problem.load;
    let shift = |z: &mut DVector<f64>, force: &mut DVector<f64>, joint: usize, to: f64| {
        let step = to - z[joint];
        if step != 0.0 {
            z[joint] = to;
            force.axpy(step, &problem.stiffness.column(joint), 1.0);
        }
    };
    for _ in 0..sweeps {
        if watch.stop() {
            return Err(ConeFailure::Stopped);
        }
        for (i, pair) in problem.pairs.iter().enumerate() {
            let open = if pair.law.is_bilateral() { 0.0 } else { (z[i] - force[i] / scale[i]).max(0.0) };
            shift(z, &mut force, i, open);
            let pressed = if pair.law.is_bilateral() { 0.0 } else { force[i].max(0.0) };
            let bound = pair.friction() * pressed + pair.fixed();
            let mut a = [0.0; 2];
            for (joint, a) in pair.tangents.clone().zip(&mut a) {
                *a = force[joint] - scale[joint] * z[joint];
            }
            let size = length(a);
            let beyond = if size > bound { (size - bound) / size } else { 0.0 };
            for (joint, a) in pair.tangents.clone().zip(a) {
                shift(z, &mut force, joint, -beyond * a / scale[joint]);
            }
        }
    }
    Ok(())
}
