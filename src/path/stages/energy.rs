//! Dissipation, and for structures the balance of energy. Both are exact where forces and displacements are affine between
//! two moments; on a curved way they take its integrals.

use super::integrals;
use super::record::{Energy, History, Moment, StageResult};
use crate::answer::record::OutcomeKind;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::fem::{Displacements, Loaded};
use crate::solve::Prepared;
use crate::solve::prepared::Geometry;

/// D of a stage.
pub(super) fn dissipated(system: &ContactSystem, moments: &[Moment]) -> f64 {
    let between = |ends: &[Moment]| match &ends[1].curve {
        Some(curve) => curve.dissipated,
        None => {
            let [a, b] = [&ends[0].state, &ends[1].state];
            integrals::dissipated([&a.z, &b.z], [&a.force, &b.force], system)
        }
    };
    moments.windows(2).map(between).sum()
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
            let stored = main.nodal_energy(&u);
            largest = largest.max(stored.abs());
            if let Some((last, old, old_stored)) = &before {
                let straight = main.work_between(&loaded(old, last), &loaded(&u, moment));
                let step = match &moment.curve {
                    None => straight,
                    Some(curve) => {
                        // The broken line by way of the mean state adds half of what the curve adds.
                        let factors = last.factors.iter().zip(&moment.factors).map(|(a, b)| 0.5 * (a + b));
                        let factors: Vec<f64> = factors.collect();
                        let bent = problem.dislocation(&curve.z);
                        let middle = main.displacements(&factors, &bent);
                        let mean = Loaded { u: &middle, lambda: &curve.force, factors: &factors };
                        let by_mean = main.work_between(&loaded(old, last), &mean)
                            + main.work_between(&mean, &loaded(&u, moment));
                        2.0 * by_mean - straight
                    }
                };
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
        let energy = Energy { residual, ..energy };
        stage.energy = Some(energy);
        // Where the structure jumps, the rest goes into its motion.
        if !energy.is_balanced() && !stage.moments.iter().any(|moment| moment.jump) {
            stage.end.check.passed = false;
            stage.end.outcome = OutcomeKind::CheckFailed;
            stage.end.failure = Some(format!(
                "the work of the loads, what is stored and what is dissipated in this stage do not balance: {residual:.1e} of the \
                 largest energy met is left over"
            ));
        }
    }
}
