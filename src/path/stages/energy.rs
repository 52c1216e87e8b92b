//! Dissipation, and for structures the balance of energy. Both are exact: forces and displacements are affine between
//! two moments.

use super::record::{Energy, History, Moment, StageResult};
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::fem::{Displacements, Loaded};
use crate::solve::Prepared;
use crate::solve::prepared::Geometry;

/// D = −Σ ½ (x_τa + x_τb) Δz_τ of a stage.
pub(super) fn dissipated(system: &ContactSystem, moments: &[Moment]) -> f64 {
    let mut sum = 0.0;
    for ends in moments.windows(2) {
        let [a, b] = [&ends[0].state, &ends[1].state];
        for joint in system.pairs.iter().flat_map(|pair| pair.tangential.clone()) {
            sum -= 0.5 * (a.force[joint] + b.force[joint]) * (b.z[joint] - a.z[joint]);
        }
    }
    sum
}

fn loaded<'a>(u: &'a Displacements, moment: &'a Moment) -> Loaded<'a> {
    Loaded { u, lambda: &moment.state.force, factors: &moment.factors }
}

/// W = Σ ½ (F_a + F_b)·Δu and ΔU of every stage, and what is left of W − ΔU − D beside the largest energy met.
pub(super) fn balance(prepared: &Prepared, problem: &ContactProblem, history: &mut History) {
    let Geometry::Structure { main, .. } = &*prepared.geometry else {
        return;
    };
    let displacements = |moment: &Moment| main.displacements(&moment.factors, &problem.dislocation(&moment.state.z));
    let (mut largest, mut work, mut dissipated) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut of_stage = |stage: &StageResult| {
        let mut energy = Energy::default();
        let mut before: Option<(&Moment, Displacements, f64)> = None;
        for moment in &stage.moments {
            let u = displacements(moment);
            let stored = main.strain_energy(&u);
            largest = largest.max(stored.abs());
            if let Some((last, old, old_stored)) = &before {
                let step = main.work_between(&loaded(old, last), &loaded(&u, moment));
                energy.work += step;
                energy.stored += stored - old_stored;
                work += step;
                largest = largest.max(work.abs());
            }
            before = Some((moment, u, stored));
        }
        dissipated += stage.dissipated;
        largest = largest.max(dissipated.abs());
        energy
    };
    let energies: Vec<Energy> = history.stages.iter().map(&mut of_stage).collect();
    for (stage, energy) in history.stages.iter_mut().zip(energies) {
        let left = (energy.work - energy.stored - stage.dissipated).abs();
        let residual = if largest > 0.0 { left / largest } else { 0.0 };
        stage.energy = Some(Energy { residual, ..energy });
    }
}
