//! One run of one engine on an LCP. The dense tableau in f64 and in exact rationals answers in the same units as the
//! working-scheme engine.

use std::ops::ControlFlow;
use std::sync::Arc;

use num_rational::BigRational;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::answer::attempt::PlainCovering;
use crate::answer::record::OutcomeKind;
use crate::contact::full_lcp::full_lcp_of;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::ExactSystem;
use crate::contact::written::ContactLcp;
use crate::lcp::basis_solution::{direction, vertex};
use crate::lcp::driver::{Engine, run};
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::exact::lemke::Exact;
use crate::lcp::exact::tableau::Tableau;
use crate::lcp::lemke::SchemeEngine;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point, RayDirection, Run};
use crate::lcp::parametric::Parametric;
use crate::lcp::pivot::Pivot;
use crate::lcp::problem::{Lcp, Scale};
use crate::lcp::ratio_test::TieRule;
use crate::lcp::variable::Variable;
use crate::model::rules::{Covering, TieBreak};
use crate::watch::Watch;

/// Most contact pairs that the exact engine takes.
pub const EXACT_PAIRS: usize = 60;
/// Most rows of a bare LCP that the exact engine takes.
pub const EXACT_ROWS: usize = 400;

/// No run makes more pivots than this; reaching it is an outcome of its own.
pub const PIVOT_LIMIT: usize = 200_000;

/// Runs that cycle or end in a ray are tried again with this many seeds of random draws.
const DRAWS: u64 = 8;

/// A bare LCP with this covering vector in place of its own.
pub(super) fn covered(lcp: &Arc<MirroredLcp>, covering: PlainCovering) -> Arc<MirroredLcp> {
    let n = lcp.size();
    let row_size = |i: usize| {
        let largest = lcp.base.row(i).amax();
        if largest > 0.0 { largest } else { 1.0 }
    };
    let covering: Vec<f64> = match covering {
        PlainCovering::Given => return Arc::clone(lcp),
        PlainCovering::Ones => vec![1.0; n],
        PlainCovering::Rows => (0..n).map(row_size).collect(),
        PlainCovering::Random(seed) => {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            (0..n).map(|i| row_size(i) * f64::powf(2.0, random.random_range(-3.0..3.0))).collect()
        }
    };
    Arc::new(MirroredLcp { covering: covering.into(), ..MirroredLcp::clone(lcp) })
}

/// Runs the working-scheme engine; the last vertex and a ray are computed afresh from the data where the equations
/// of the last basis allow it.
pub fn run_scheme(lcp: &Arc<MirroredLcp>, rule: TieRule, watch: &dyn Watch) -> Run {
    run_scheme_within(lcp, rule, PIVOT_LIMIT, watch)
}

/// The LCP of pairs under the lexicographic rule; where that cycles, since rounding hides how rows of B⁻¹ differ, under others.
pub fn run_past_cycles(contact: &ContactLcp, watch: &dyn Watch) -> Run {
    let others = std::iter::once(TieBreak::Natural).chain((0..DRAWS).map(TieBreak::Random));
    let run = |rule| run_scheme(&contact.lcp, contact.tie_rule(rule), watch);
    let cycles = |run: &Run| matches!(run.outcome, Outcome::Cycle(_));
    let first = run(TieBreak::Lexicographic);
    if !cycles(&first) {
        return first;
    }
    others.map(run).find(|run| !cycles(run)).unwrap_or(first)
}

/// What is made of the first run of several under covering vectors drawn at random of which something is made: a ray under one
/// of them does not say that there is no answer.
pub fn under_other_coverings<T>(
    contact: &ContactLcp,
    watch: &dyn Watch,
    mut made: impl FnMut(&Run) -> Option<T>,
) -> Option<T> {
    (0..DRAWS).take_while(|_| !watch.stop()).find_map(|seed| {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let drawn = contact.lcp.covering.map(|d| d * f64::powf(2.0, random.random_range(-3.0..3.0)));
        let lcp = Arc::new(contact.lcp.with_covering(drawn));
        let run = run_scheme(&lcp, contact.tie_rule(TieBreak::Random(seed)), watch);
        if matches!(run.outcome, Outcome::Trivial | Outcome::Normal { marginal: false }) { made(&run) } else { None }
    })
}

/// As [`run_scheme`], ending after `most` pivots.
pub(super) fn run_scheme_within(lcp: &Arc<MirroredLcp>, rule: TieRule, most: usize, watch: &dyn Watch) -> Run {
    let mut engine = SchemeEngine::new(Arc::clone(lcp), rule);
    let mut run = watched(&mut engine, "Lemke", most, watch);
    polish(lcp, &mut run);
    run
}

/// As [`run_scheme`], with the dictionary of the answer, ready to be followed along a change of the load.
pub(super) fn keep_scheme(lcp: &Arc<MirroredLcp>, rule: TieRule, watch: &dyn Watch) -> (Run, Option<Parametric>) {
    let mut engine = SchemeEngine::new(Arc::clone(lcp), rule);
    let mut run = watched(&mut engine, "Lemke", PIVOT_LIMIT, watch);
    polish(lcp, &mut run);
    (run, engine.into_parametric())
}

/// Steps an engine to its end, at most `most` pivots; `watch` hears of its progress and may stop it.
fn watched<E: Engine>(engine: &mut E, name: &str, most: usize, watch: &dyn Watch) -> Run<E::Number> {
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
    run(engine, most, &mut observer)
}

/// Computes the last vertex and the ray afresh from the data, where the equations of the last basis allow it.
fn polish(lcp: &MirroredLcp, run: &mut Run) {
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

/// Every row of a mirrored LCP written out, in its units.
pub fn written_out(lcp: &MirroredLcp) -> Lcp<f64> {
    let n = lcp.full_size;
    let columns = lcp.primary_rows();
    let spread = |row: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let entry = |&(j, mirrored): &(usize, bool)| if mirrored { -row(j) } else { row(j) };
        columns.iter().map(entry).collect()
    };
    let mut whole = Lcp {
        matrix: vec![Vec::new(); n],
        q: vec![0.0; n],
        covering: vec![0.0; n],
        scale: Scale {
            row: vec![0.0; n],
            column: columns.iter().map(|&(j, _)| lcp.scale.column[j]).collect(),
            load: lcp.scale.load,
        },
    };
    let matrix = lcp.matrix();
    for i in 0..lcp.size() {
        let k = lcp.whole[i];
        whole.matrix[k] = spread(&|j| matrix[(i, j)]);
        whole.q[k] = lcp.q[i];
        whole.covering[k] = lcp.covering[i];
        whole.scale.row[k] = lcp.scale.row[i];
        let Some(mirror) = &lcp.mirrors[i] else {
            continue;
        };
        let k = mirror.whole;
        whole.matrix[k] = spread(&|j| mirror.reflect(i, |row| matrix[(row, j)], 0.0, 0.0));
        (whole.q[k], whole.covering[k]) = lcp.mirror_start(i, mirror);
        whole.scale.row[k] = lcp.scale.row[i];
    }
    whole
}

/// Runs the dense tableau in f64.
pub fn run_tableau(lcp: &Arc<MirroredLcp>, rule: TieRule, watch: &dyn Watch) -> Run {
    let mut engine = Tableau::<f64>::new(&written_out(lcp), rule);
    let mut run = watched(&mut engine, "tableau", PIVOT_LIMIT, watch);
    polish(lcp, &mut run);
    run
}

/// Runs the tableau of a bare LCP in exact rationals.
pub fn run_exact_plain(lcp: &MirroredLcp, rule: TieRule, watch: &dyn Watch) -> Run {
    let whole = written_out(lcp);
    let exact = |values: &[f64]| values.iter().map(|v| rational(*v)).collect();
    let problem = Lcp {
        matrix: whole.matrix.iter().map(|row| exact(row)).collect(),
        q: exact(&whole.q),
        covering: exact(&whole.covering),
        scale: whole.scale,
    };
    rounded(run_exact(problem, rule, watch), 1.0, 1.0)
}

/// Runs the tableau of a contact problem in exact rationals: M is formed from the R and RF that enumeration works on, so
/// that a motion that costs nothing costs exactly nothing.
pub fn run_exact_contact(
    problem: &ContactProblem,
    contact: &ContactLcp,
    covering: Covering,
    rule: TieRule,
    watch: &dyn Watch,
) -> Run {
    let ExactSystem { stiffness, constants, .. } = ExactSystem::new(problem);
    let mut lcp = full_lcp_of(problem, covering, &stiffness, &constants);
    lcp.scale.load = contact.lcp.scale.load.map(|load| load * contact.force_unit);
    rounded(run_exact(lcp, rule, watch), contact.force_unit, contact.length_unit)
}

fn run_exact(problem: Lcp<BigRational>, rule: TieRule, watch: &dyn Watch) -> Run<BigRational> {
    watched(&mut Exact::new(problem, rule, watch), "exact arithmetic", PIVOT_LIMIT, watch)
}

/// An exact run in f64, forces divided by `force` and displacements by `length` (powers of two).
fn rounded(run: Run<BigRational>, force: f64, length: f64) -> Run {
    let all = |values: &[BigRational], unit: f64| -> Vec<f64> { values.iter().map(|v| nearest(v) / unit).collect() };
    let mut pivots = run.pivots;
    pivots.rescale(|pivot| {
        pivot.p_before /= force;
        pivot.p_after /= force;
        pivot.ratio /= match pivot.entering {
            Variable::Z(_) => length,
            _ => force,
        };
    });
    Run {
        outcome: match run.outcome {
            Outcome::Ray(ray) => Outcome::Ray(RayDirection {
                entering: ray.entering,
                z: all(&ray.z, length),
                w: all(&ray.w, force),
                p: nearest(&ray.p) / force,
            }),
            Outcome::Trivial => Outcome::Trivial,
            Outcome::Normal { marginal } => Outcome::Normal { marginal },
            Outcome::PivotLimit => Outcome::PivotLimit,
            Outcome::Cycle(cycle) => Outcome::Cycle(cycle),
            Outcome::Breakdown(why) => Outcome::Breakdown(why),
            Outcome::Interrupted => Outcome::Interrupted,
        },
        point: Point { z: all(&run.point.z, length), w: all(&run.point.w, force), p: nearest(&run.point.p) / force },
        pivots,
    }
}
