//! Lemke's algorithm on a mirrored LCP: the working-scheme engine.
//!
//! w = M z + q + d p. p enters first, at the smallest value for which w ≥ 0 with z = 0; then the complement of
//! what left enters, until p leaves (normal end) or nothing blocks (ray). One dictionary of N rows carries the
//! run ([`super::dictionary`]); zero tests are scaled (method §4, "Zero").

use std::collections::HashMap;
use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::dictionary::{Dictionary, Place, Slot};
use super::driver::{Engine, Step};
use super::mirrored::MirroredLcp;
use super::outcome::{Outcome, Point, RayDirection};
use super::parametric::Parametric;
use super::ratio_test::{TieRule, choose};
use super::variable::Variable;
use crate::lcp::pivot::{Pivot, PivotLog};
use crate::lcp::pivot_state::{Candidate, NOISE, PivotState, Sizes};

/// The engine; see the module.
#[derive(Clone, Debug)]
pub struct SchemeEngine {
    state: PivotState,
    rule: TieRule,
    random: ChaCha8Rng,
    pivots: PivotLog,
    /// What enters next; `None` before the entry of p.
    entering: Option<Slot>,
    ended: Option<Outcome>,
    /// Row of every basic variable in the whole tableau (see [`TieRule::FirstRow`]).
    table_row: HashMap<Variable, usize>,
    /// Set where the run stopped because z⁺ and z⁻ of a couple would both be basic: the vertex after that.
    artefact_point: Option<Point>,
}

impl SchemeEngine {
    /// A run that stands before the entry of p.
    pub fn new(lcp: Arc<MirroredLcp>, rule: TieRule) -> SchemeEngine {
        let rows: f64 = lcp.scale.row.iter().sum();
        let covering: f64 = lcp.covering.iter().map(|d| d.abs()).sum();
        let sizes = Sizes {
            q: lcp.q.iter().map(|q| q.abs()).collect(),
            d: lcp.covering.iter().map(|d| d.abs()).collect(),
            p_per_force: if covering > 0.0 { rows / covering } else { 1.0 },
            p: 0.0,
        };
        let seed = if let TieRule::Random(seed) = rule { seed } else { 0 };
        SchemeEngine {
            rule,
            random: ChaCha8Rng::seed_from_u64(seed),
            pivots: PivotLog::default(),
            entering: None,
            ended: None,
            table_row: (0..lcp.full_size).map(|row| (Variable::W(row), row)).collect(),
            artefact_point: None,
            state: PivotState::new(Arc::clone(&lcp), Dictionary::new(&lcp), sizes),
        }
    }

    /// The problem that is solved.
    pub fn lcp(&self) -> &MirroredLcp {
        &self.state.lcp
    }

    /// How often the dictionary was built afresh from the data.
    pub fn refreshes(&self) -> usize {
        self.state.refreshes
    }

    /// After a normal or trivial end: the dictionary, standing on the answer, ready to follow changes of the load.
    /// `None` after any other end and under rules that a path does not use.
    pub fn into_parametric(self) -> Option<Parametric> {
        let on_answer = matches!(self.ended, Some(Outcome::Trivial | Outcome::Normal { marginal: false }));
        match self.rule {
            TieRule::Lexicographic(order) if on_answer => Parametric::standing(self.state, order),
            _ => None,
        }
    }

    fn end(&mut self, outcome: Outcome) -> Step<f64> {
        self.ended = Some(outcome.clone());
        Step::Ended(outcome)
    }

    /// The end where nothing goes on but p is as good as zero: an answer.
    fn at_limit_of_p(&self) -> Option<Outcome> {
        self.state.lcp.is_marginal(&self.state.point()).then_some(Outcome::Normal { marginal: true })
    }

    /// The end where no row blocks the entering variable of column c.
    fn nothing_blocks(&mut self, c: usize) -> Step<f64> {
        let end = self.at_limit_of_p().unwrap_or_else(|| Outcome::Ray(self.state.ray(c)));
        self.end(end)
    }

    fn broken(&mut self, why: &str) -> Step<f64> {
        self.end(Outcome::Breakdown(why.to_owned()))
    }

    /// The entry of p (pivot 0), or the trivial end.
    fn start(&mut self) -> Step<f64> {
        let lcp = Arc::clone(&self.state.lcp);
        // q and d of all rows, mirrors included. q itself is data; that of a mirror is a sum and carries its rounding.
        let mut rows: Vec<(Slot, bool, f64, f64)> =
            (0..lcp.size()).map(|i| (Slot::W(i), false, lcp.q[i], lcp.covering[i])).collect();
        for (i, mirror) in lcp.mirrors.iter().enumerate() {
            if let Some(mirror) = mirror {
                let (q, d) = lcp.mirror_start(i, mirror);
                let normal = mirror.normal.map_or(0.0, |n| 2.0 * mirror.friction * lcp.q[n].abs());
                let noise = NOISE * (normal + mirror.constant + lcp.q[i].abs());
                rows.push((Slot::W(i), true, if q.abs() <= noise { 0.0 } else { q }, d));
            }
        }
        let negative: Vec<_> = rows.iter().filter(|row| row.2 < 0.0).collect();
        if negative.is_empty() {
            return self.end(Outcome::Trivial);
        }
        if negative.iter().any(|row| row.3 <= 0.0) {
            return self.broken("the covering vector is zero in a row whose q is negative");
        }
        let needed = negative.iter().map(|row| -row.2 / row.3).fold(0.0, f64::max);
        self.state.sizes.p = needed;
        let tied: Vec<Candidate> = negative
            .iter()
            .filter(|row| {
                // The row that needs the most is one of them, even where the noise of its numbers rounds to 0.
                -row.2 / row.3 == needed || row.2 + row.3 * needed <= NOISE * (row.2.abs() + row.3 * needed)
            })
            .map(|row| Candidate { variable: row.0, mirror_row: row.1, value: -row.2, fall: row.3, noise: 0.0 })
            .collect();
        let c = lcp.size();
        self.state.fetch(c);
        let chosen = self.choose(c, &tied, true);
        self.exchange(tied[chosen], c, needed, &tied);
        Step::Pivoted
    }

    /// Index of the candidate that leaves of those tied along column c.
    fn choose(&mut self, c: usize, tied: &[Candidate], at_start: bool) -> usize {
        let names: Vec<Variable> = tied.iter().map(|candidate| self.state.name(candidate)).collect();
        if tied.len() > 1 {
            self.state.dictionary.settle_w();
        }
        let table_row = |name: Variable| self.table_row.get(&name).copied().unwrap_or(usize::MAX);
        let rows = self.state.inverse_rows(c, tied, &table_row);
        let mut random = self.random.clone();
        let chosen = choose(&self.rule, &mut random, &names, &rows, at_start);
        self.random = random;
        chosen
    }

    /// Makes the pivot and its record.
    fn exchange(&mut self, leaving: Candidate, c: usize, step: f64, tied: &[Candidate]) {
        let entering = self.state.variable(self.state.dictionary.column[c], false);
        let name = self.state.name(&leaving);
        let mut ties: Vec<Variable> = tied.iter().map(|tie| self.state.name(tie)).collect();
        ties.sort_unstable();
        let p_before = if self.pivots.is_empty() { step } else { self.state.p() };
        let slipping = match (leaving.variable, leaving.mirror_row) {
            (Slot::W(i), true) => match self.state.dictionary.place(Slot::W(i)) {
                Place::Column(j) if j != c => Some(i),
                _ => None,
            },
            _ => None,
        };
        self.entering = match slipping {
            Some(i) => {
                self.finish_artefact(i, c, step);
                None
            }
            None => self.state.exchange(&leaving, c, step, tied),
        };
        let p_after = self.artefact_point.as_ref().map_or_else(|| self.state.p(), |point| point.p);
        self.pivots.push(Pivot {
            step: self.pivots.count(),
            entering,
            leaving: name,
            p_before,
            p_after,
            ratio: step,
            degenerate: leaving.value <= leaving.noise,
            ties,
        });
        if let Some(row) = self.table_row.remove(&name) {
            self.table_row.insert(entering, row);
        }
        if name == Variable::P {
            self.ended = Some(Outcome::Normal { marginal: false });
        }
    }

    /// The other reserve of a slipping couple is used up: its z would enter beside the one that is basic, and
    /// (z⁺, z⁻) = (1, 1) moves nothing else. The run ends in that ray at the vertex after this step.
    fn finish_artefact(&mut self, i: usize, c: usize, step: f64) {
        let state = &mut self.state;
        state.dictionary.advance(&state.column, step);
        let entering = state.dictionary.column[c];
        let mut point = state.point();
        match state.variable(entering, false) {
            Variable::W(k) => point.w[k] = step,
            Variable::Z(k) => point.z[k] = step,
            Variable::P => point.p = step,
        }
        let n = state.lcp.full_size;
        let mut z = vec![0.0; n];
        let other = state.variable(Slot::Z(i), true);
        for variable in [state.variable(Slot::Z(i), false), other] {
            if let Variable::Z(k) = variable {
                z[k] = 1.0;
            }
        }
        self.artefact_point = Some(point);
        self.ended = Some(Outcome::Ray(RayDirection { entering: other, z, w: vec![0.0; n], p: 0.0 }));
    }
}

impl Engine for SchemeEngine {
    type Number = f64;

    fn step(&mut self) -> Step<f64> {
        if let Some(outcome) = &self.ended {
            return Step::Ended(outcome.clone());
        }
        let Some(entering) = self.entering else {
            return self.start();
        };
        if let Some(cycle) = self.pivots.cycle(self.rule.returns_allowed()) {
            return self.end(self.at_limit_of_p().unwrap_or(Outcome::Cycle(cycle)));
        }
        if !self.state.check_drift() {
            return self.broken("the equations of the working scheme are singular");
        }
        let Some(c) = self.state.column_of(entering) else {
            return self.broken("the entering variable is basic already");
        };
        self.state.fetch(c);
        let (mut tied, mut step) = self.state.blocking(c, true);
        if self.state.is_suspicious(c, &tied) && self.state.refine_if_doubtful(c, &tied) {
            (tied, step) = self.state.blocking(c, true);
        }
        if tied.is_empty() {
            return self.nothing_blocks(c);
        }
        let mut chosen = self.choose(c, &tied, false);
        // A pivot on a small rate needs a row of the dictionary whose errors are small beside that rate.
        if self.state.is_suspicious(c, &tied[chosen..=chosen])
            && self.state.refine_if_doubtful(c, &tied[chosen..=chosen])
        {
            (tied, step) = self.state.blocking(c, true);
            if tied.is_empty() {
                return self.nothing_blocks(c);
            }
            chosen = self.choose(c, &tied, false);
        }
        self.exchange(tied[chosen], c, step, &tied);
        Step::Pivoted
    }

    fn pivots(&self) -> &PivotLog {
        &self.pivots
    }

    fn point(&self) -> Point {
        self.artefact_point.clone().unwrap_or_else(|| self.state.point())
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::lcp::driver::run;
    use crate::lcp::exact::tableau::Tableau;
    use crate::lcp::problem::{Lcp, Scale};

    /// w = q + z: a load of the smallest number there is has an answer, z = −q; p must come
    /// in over some row.
    #[test]
    fn the_row_that_needs_most_of_p_is_found_for_the_smallest_numbers() {
        for q in [-5e-324, -1e-310, -f64::MIN_POSITIVE] {
            let lcp = Lcp {
                matrix: vec![vec![1.0]],
                q: vec![q],
                covering: vec![1.5],
                scale: Scale { row: vec![1.0], column: vec![1.0], load: None },
            };
            let rule = TieRule::Lexicographic(vec![0]);
            let mut engine = SchemeEngine::new(Arc::new(MirroredLcp::plain(&lcp)), rule.clone());
            let by_scheme = run(&mut engine, 10, &mut |_| ControlFlow::Continue(()));
            let by_tableau = run(&mut Tableau::new(&lcp, rule), 10, &mut |_| ControlFlow::Continue(()));
            for (outcome, pivots) in
                [(by_scheme.outcome, by_scheme.pivots.count()), (by_tableau.outcome, by_tableau.pivots.count())]
            {
                assert!(matches!(outcome, Outcome::Normal { .. }), "{q:e}: {outcome:?}");
                assert!(pivots >= 1, "{q:e}");
            }
        }
    }
}
