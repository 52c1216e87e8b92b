//! One run of one engine under one set of rules.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::answer::record::OutcomeKind;
use crate::lcp::basis_solution::{direction, vertex};
use crate::lcp::driver::{Engine, run};
use crate::lcp::lemke::SchemeEngine;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::parametric::Parametric;
use crate::lcp::pivot::Pivot;
use crate::lcp::ratio_test::TieRule;
use crate::watch::Watch;

/// No run makes more pivots than this; reaching it is an outcome of its own.
pub const PIVOT_LIMIT: usize = 200_000;

/// Runs the working-scheme engine; the last vertex and a ray are computed afresh from the data where the equations
/// of the last basis allow it.
pub fn run_scheme(lcp: &Arc<MirroredLcp>, rule: TieRule, watch: &dyn Watch) -> Run {
    keep_scheme(lcp, rule, watch).0
}

/// As [`run_scheme`], with the dictionary of the answer, ready to be followed along a change of the load.
pub(super) fn keep_scheme(lcp: &Arc<MirroredLcp>, rule: TieRule, watch: &dyn Watch) -> (Run, Option<Parametric>) {
    let mut engine = SchemeEngine::new(Arc::clone(lcp), rule);
    let mut run = watched(&mut engine, "Lemke", watch);
    polish(lcp, &mut run);
    (run, engine.into_parametric())
}

/// Steps an engine to its end; `watch` hears of its progress and may stop it.
pub(super) fn watched<E: Engine>(engine: &mut E, name: &str, watch: &dyn Watch) -> Run<E::Number> {
    let mut first_p = 0.0;
    let mut observer = |pivot: &Pivot| {
        if pivot.step == 0 {
            first_p = pivot.p_after;
        }
        if pivot.step.is_multiple_of(16) {
            let left = if first_p > 0.0 { pivot.p_after / first_p } else { 0.0 };
            watch.progress(&format!("{name}, pivot {}", pivot.step), (1.0 - left).clamp(0.0, 1.0));
        }
        if watch.stop() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    };
    run(engine, PIVOT_LIMIT, &mut observer)
}

/// Computes the last vertex and the ray afresh from the data, where the equations of the last basis allow it.
pub(super) fn polish(lcp: &MirroredLcp, run: &mut Run) {
    let basis = run.pivots.basis();
    match &mut run.outcome {
        Outcome::Normal { .. } => {
            if let Some(point) = vertex(lcp, &basis) {
                run.point = point;
            }
        }
        Outcome::Ray(ray) => {
            if let Some(point) = vertex(lcp, &basis) {
                run.point = nonnegative(point);
            }
            if let Some(fresh) = direction(lcp, &basis, ray.entering) {
                // The engine knows which entries are zero; the fresh solution knows their size.
                let keep = |mine: &mut [f64], fresh: &[f64]| {
                    for (mine, fresh) in mine.iter_mut().zip(fresh) {
                        if *mine != 0.0 {
                            *mine = fresh.max(0.0);
                        }
                    }
                };
                keep(&mut ray.z, &fresh.z);
                keep(&mut ray.w, &fresh.w);
                if ray.p != 0.0 {
                    ray.p = fresh.p.max(0.0);
                }
            }
        }
        _ => {}
    }
}

fn nonnegative(mut point: Point) -> Point {
    for value in point.z.iter_mut().chain(&mut point.w) {
        *value = value.max(0.0);
    }
    point
}

/// The word for an outcome.
pub fn kind(outcome: &Outcome) -> OutcomeKind {
    match outcome {
        Outcome::Trivial => OutcomeKind::Trivial,
        Outcome::Normal { .. } => OutcomeKind::Normal,
        Outcome::Ray(_) => OutcomeKind::Ray,
        Outcome::PivotLimit | Outcome::Cycle(_) => OutcomeKind::PivotLimit,
        Outcome::Breakdown(_) | Outcome::Interrupted => OutcomeKind::Breakdown,
    }
}
