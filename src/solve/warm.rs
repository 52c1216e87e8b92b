//! Warm start: the last answer followed along a change of its numbers in a kept dictionary (method §5).
//!
//! Loads, gaps, cohesions and bounds only move q: the answer is followed along the change, pivot by pivot. Friction
//! is in the matrix: the dictionary stays that of the friction it was built for, and the difference of the bounds,
//! Δf x_n, stands in as an extra cohesion until the scheme holds, then the scheme is solved for the new friction.

use std::sync::{Arc, Mutex};

use nalgebra::DVector;

use crate::contact::problem::ContactProblem;
use crate::contact::written::ContactLcp;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Parametric, Reach};
use crate::watch::Watch;

/// A path with more pivots than this is no shorter than a cold run.
const PIVOTS: usize = 2_000;
/// Friction that moves further than this from that of the dictionary is solved cold.
const FRICTION_REACH: f64 = 0.25;
/// The extra cohesion is set anew this many times before the cold start takes over.
const ROUNDS: usize = 8;

/// The dictionary of an answer, kept for the next change.
#[derive(Clone, Debug)]
pub struct WarmStart {
    engine: Parametric,
    /// The LCP the dictionary was built for: matrix, units, rows.
    contact: ContactLcp,
    /// Where it stands now: load, gap, cohesion, bound; its friction is that of the matrix.
    problem: ContactProblem,
    /// Extra cohesion per pair that stands in for a change of friction.
    extra: Vec<f64>,
}

/// What an answer keeps for the next change; shared by the answers of one chain.
pub(super) type WarmSlot = Arc<Mutex<Option<WarmStart>>>;

/// An answer found from the last one.
#[derive(Clone, Debug)]
pub struct WarmPoint {
    /// All variables, dimensionless in the units of the kept LCP.
    pub point: Point,
    /// User's length = dimensionless × this.
    pub length_unit: f64,
    /// Pivots on the way.
    pub pivots: usize,
}

impl WarmStart {
    /// Keeps the dictionary of an answer just found.
    pub fn new(engine: Parametric, contact: ContactLcp, problem: ContactProblem) -> WarmStart {
        let extra = vec![0.0; problem.laws.len()];
        WarmStart { engine, contact, problem, extra }
    }

    /// Refines what is kept from the data, where its answer was not good enough; then [`WarmStart::follow`] again.
    pub fn refine(&mut self) {
        self.engine.refine();
    }

    /// The LCP whose matrix can be shared by others of the same system.
    pub fn contact(&self) -> &ContactLcp {
        &self.contact
    }

    /// q per primary row and b per mirrored row for the given numbers, with the friction of the matrix.
    fn right_side(&self, problem: &ContactProblem, extra: &[f64]) -> (DVector<f64>, Vec<f64>) {
        let fixed: Vec<f64> = problem.laws.iter().zip(extra).map(|(law, extra)| law.fixed_bound() + extra).collect();
        let load = problem.joint_constants();
        let q = self.contact.force_rows(&problem.system, &load, &self.contact.friction, &fixed);
        (q, self.per_row(&fixed, self.contact.force_unit).into_iter().map(|constant| 2.0 * constant).collect())
    }

    /// Follows the answer to other numbers and extra cohesions; `None` where the path does not get there.
    fn walk(&mut self, to: &ContactProblem, extra: &[f64], watch: &dyn Watch) -> Option<usize> {
        let (from_q, from_b) = self.right_side(&self.problem, &self.extra);
        let (to_q, to_b) = self.right_side(to, extra);
        if from_q == to_q && from_b == to_b {
            self.problem = to.clone();
            return Some(0);
        }
        let mut lcp = MirroredLcp::clone(&self.contact.lcp);
        for row in 0..lcp.size() {
            lcp.q[row] = from_q[row];
            lcp.covering[row] = to_q[row] - from_q[row];
            if let Some(mirror) = &mut lcp.mirrors[row] {
                mirror.constant = from_b[row];
                mirror.covering = to_b[row] - from_b[row];
            }
        }
        if !self.engine.reload(Arc::new(lcp)) {
            return None;
        }
        let reach = Reach { target: 1.0, through: false, pivots: PIVOTS };
        let (end, pivots) = self.engine.walk(reach, &mut |_| watch.go_on());
        if end != End::Target {
            return None;
        }
        self.problem = to.clone();
        self.extra = extra.to_vec();
        Some(pivots)
    }

    /// Values per pair on the primary rows of x⁺, divided by `unit`.
    fn per_row(&self, per_pair: &[f64], unit: f64) -> Vec<f64> {
        let mut rows = vec![0.0; self.contact.lcp.size()];
        for (value, row) in per_pair.iter().zip(&self.contact.facet_rows[0]) {
            if let Some(row) = row {
                rows[*row] = value / unit;
            }
        }
        rows
    }

    /// The answer for other numbers of the same system. `None`: solve cold (friction moved too far, the path turns or
    /// ends before the target, no scheme held, or `watch` asked to stop); what was kept is of no use then. The caller
    /// runs the fresh check on what it makes of the answer.
    pub fn follow(&mut self, to: &ContactProblem, watch: &dyn Watch) -> Option<WarmPoint> {
        if to.system.force_form.is_some() {
            return None;
        }
        let length_unit = self.contact.length_unit;
        let frictions = to.frictions();
        let change: Vec<f64> = frictions.iter().zip(&self.contact.friction).map(|(to, from)| to - from).collect();
        if change.iter().zip(&frictions).any(|(change, f)| change.abs() > FRICTION_REACH * f) {
            return None;
        }
        if change.iter().all(|change| *change == 0.0) {
            let none = vec![0.0; change.len()];
            let pivots = self.walk(to, &none, watch)?;
            return Some(WarmPoint { point: self.engine.point(), length_unit, pivots });
        }
        let change_rows = self.per_row(&change, 1.0);
        let mut extra = self.extra.clone();
        let mut pivots = 0;
        for _ in 0..ROUNDS {
            pivots += self.walk(to, &extra, watch)?;
            let unit = self.contact.force_unit;
            let extra_rows = self.per_row(&extra, unit);
            if let Some(point) = self.engine.at_friction(&change_rows, &extra_rows) {
                return Some(WarmPoint { point, length_unit, pivots });
            }
            let point = self.engine.point();
            let next: Vec<f64> = change
                .iter()
                .zip(&self.contact.normal_row)
                .map(|(change, row)| row.map_or(0.0, |row| change * point.w[row].max(0.0) * unit))
                .collect();
            if next == extra {
                return None;
            }
            extra = next;
        }
        None
    }
}
