//! Every covering × tie-break × engine on the same numbers: which find an answer, and whether it is the same one.

use serde::Serialize;

use super::cold::Extent;
use super::error::SolveError;
use super::plain::{PlainProblem, attempt_plain};
use super::prepared::{Geometry, Prepared};
use super::problem::{contact_problem, factors};
use super::state::Solved;
use crate::answer::attempt::AttemptRules;
use crate::answer::record::{Answer, OutcomeKind, RayClass};
use crate::answer::same::same_answer;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Engine, Rules, TieBreak};
use crate::watch::Watch;

/// Contact pairs (or a third of the rows) up to which the tableau takes part.
const TABLEAU_PAIRS: usize = 80;
/// Contact pairs up to which exact arithmetic takes part: beyond, it would take longer than all the others together.
const COMPARED_EXACTLY: usize = 12;

/// One combination and its end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    #[serde(flatten)]
    pub rules: AttemptRules,
    /// How it ended; `None` where the covering does not fit the numbers.
    pub outcome: Option<OutcomeKind>,
    /// Class of its ray.
    pub class: Option<RayClass>,
    /// Whether it came back to a basis.
    pub cycled: bool,
    /// Number of pivots.
    pub pivots: usize,
    /// p at the end.
    pub p: f64,
    /// Which of the different answers it found, from 0.
    pub answer: Option<usize>,
}

/// The table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Its rows.
    pub rows: Vec<Compared>,
    /// How many different answers were found.
    pub answers: usize,
}

impl Prepared {
    /// Runs all combinations once, without retries. Engines that are too slow for the size are left out.
    ///
    /// # Errors
    /// Stopped from outside.
    pub fn compare(&self, values: &ParameterValues, rules: Rules, watch: &dyn Watch) -> Result<Comparison, SolveError> {
        let factors = factors(self, values);
        let pairs = match &*self.geometry {
            Geometry::Plain { lcp, .. } => lcp.size().div_ceil(3),
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => system.pairs.len(),
        };
        let coverings: &[Covering] = match &*self.geometry {
            Geometry::Plain { .. } => &[Covering::Cohesive],
            _ => &Covering::ALL,
        };
        let ties: &[TieBreak] = match &*self.geometry {
            // The natural order of a bare LCP is its lexicographic one.
            Geometry::Plain { .. } => &[TieBreak::Lexicographic, TieBreak::FirstRow, TieBreak::Random(1)],
            _ => &[TieBreak::Lexicographic, TieBreak::Natural, TieBreak::FirstRow, TieBreak::Random(1)],
        };
        let mut engines = vec![Engine::Scheme];
        if pairs <= TABLEAU_PAIRS {
            engines.push(Engine::Tableau);
        }
        if pairs <= COMPARED_EXACTLY {
            engines.push(Engine::Exact);
        }
        let mut found: Vec<Answer> = Vec::new();
        let mut rows = Vec::new();
        let all = coverings.len() * ties.len() * engines.len();
        for &covering in coverings {
            for &tie_break in ties {
                for &engine in &engines {
                    watch.progress("comparing rules", rows.len() as f64 / all as f64);
                    let rules = Rules { covering, tie_break, engine, ..rules };
                    let solved = self.attempt(values, &factors, rules, watch);
                    rows.push(row(rules, solved, &mut found)?);
                }
            }
        }
        Ok(Comparison { rows, answers: found.len() })
    }

    fn attempt(
        &self,
        values: &ParameterValues,
        factors: &[f64],
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        match &*self.geometry {
            Geometry::Plain { lcp, q, names, covering_given } => {
                let problem = PlainProblem::new(lcp, q, values, names, *covering_given);
                attempt_plain(&problem, problem.rules(rules), watch)
            }
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => {
                let problem = contact_problem(system, factors, values).under(rules);
                self.attempt_contact(&problem, (rules, Extent::Whole), watch)
            }
        }
    }
}

fn row(rules: Rules, solved: Result<Solved, SolveError>, found: &mut Vec<Answer>) -> Result<Compared, SolveError> {
    let mut row =
        Compared { rules: rules.into(), outcome: None, class: None, cycled: false, pivots: 0, p: 0.0, answer: None };
    let solved = match solved {
        Ok(solved) => solved,
        Err(SolveError::Covering(_)) => return Ok(row),
        Err(other) => return Err(other),
    };
    let answer = solved.answer;
    row.rules = answer.rules;
    row.outcome = Some(answer.outcome);
    row.class = answer.ray.as_ref().map(|ray| ray.class);
    row.cycled = solved.cycled;
    row.pivots = answer.pivot_count;
    row.p = answer.p;
    if answer.is_answer() {
        let known = found.iter().position(|other| same_answer(other, &answer));
        row.answer = Some(known.unwrap_or_else(|| {
            found.push(answer);
            found.len() - 1
        }));
    }
    Ok(row)
}
