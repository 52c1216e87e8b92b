//! Ties of the ratio test, what chose among them, and the degenerate vertices they leave behind.

use serde::Serialize;

use super::vertex::{Naming, zero_basics};
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::outcome::Point;
use crate::lcp::pivot::{Pivot, PivotLog};
use crate::lcp::variable::Variable;
use crate::model::rules::TieBreak;
use crate::watch::Watch;

/// Most vertices that are computed afresh to look for zeros.
const MOST_VERTICES: usize = 100;

/// A pivot at which more than one row blocked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tie {
    /// The pivot.
    pub step: usize,
    /// All rows that blocked.
    pub tied: Vec<String>,
    /// The one that left.
    pub leaving: String,
    /// Why it was chosen.
    pub reason: String,
}

/// A vertex at which basic variables are zero.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Degenerate {
    /// The pivot after which it is reached.
    pub step: usize,
    /// Its basic variables that are zero.
    pub zeros: Vec<String>,
}

/// Ties and degeneracy of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TieReport {
    /// The tie-break in use, in a sentence.
    pub rule: String,
    /// Number of pivots.
    pub pivots: usize,
    /// Pivots with ties.
    pub ties: Vec<Tie>,
    /// Degenerate vertices.
    pub degenerate: Vec<Degenerate>,
    /// Whether every vertex was looked at.
    pub complete: bool,
}

/// What a tie-break does.
fn rule_words(tie_break: TieBreak, naming: &Naming) -> String {
    let (contact, in_space) = match naming {
        Naming::Contact(_, system) => (true, system.is_in_space()),
        Naming::Plain(..) => (false, false),
    };
    let order = match (tie_break, contact) {
        (TieBreak::Lexicographic, true) if in_space => {
            "lexicographic: p first, then as if the reserve x^k of every facet had a little more than every x_n"
        }
        (TieBreak::Natural, true) if in_space => "natural: p first, then lexicographic in the order x_n, x^0, x^1, …",
        (TieBreak::Lexicographic, true) => {
            "lexicographic: p first, then as if every x+ and x- had a little more than every x_n"
        }
        (TieBreak::Natural, true) => "natural: p first, then lexicographic in the order x_n, x+, x-",
        (TieBreak::Lexicographic | TieBreak::Natural, false) => "lexicographic: p first, then the order of the rows",
        (TieBreak::FirstRow, _) => "first-row: the first tied row of the tableau; may cycle",
        (TieBreak::Random(_), _) => "random: a tied row drawn with the seed",
    };
    order.to_owned()
}

fn reason(pivot: &Pivot, tie_break: TieBreak) -> &'static str {
    match tie_break {
        TieBreak::FirstRow => "first of the tied rows",
        TieBreak::Random(_) => "drawn",
        _ if pivot.leaving == Variable::P => "p leaves whenever it can",
        _ if pivot.step == 0 => "last in the order: it needs the largest p",
        _ => "lexicographically smallest row",
    }
}

/// Looks through a run; `last` is its last vertex. `None` where it was stopped.
pub fn ties(
    naming: &Naming,
    log: &PivotLog,
    last: &Point,
    tie_break: TieBreak,
    watch: &dyn Watch,
) -> Option<TieReport> {
    let pivots = log.recorded();
    let names = |variables: &[Variable]| variables.iter().map(|v| naming.name(*v)).collect();
    let tied = pivots
        .iter()
        .filter(|pivot| pivot.ties.len() > 1)
        .map(|pivot| Tie {
            step: pivot.step,
            tied: names(&pivot.ties),
            leaving: naming.name(pivot.leaving),
            reason: reason(pivot, tie_break).to_owned(),
        })
        .collect();
    let lcp = naming.lcp();
    let first = pivots.len().saturating_sub(MOST_VERTICES);
    let mut degenerate = Vec::new();
    for step in first..pivots.len() {
        if watch.stop() {
            return None;
        }
        let basis = Basis::after(&pivots[..=step]);
        let zeros = match (step + 1 == log.count()).then(|| last.clone()).or_else(|| vertex(lcp, &basis)) {
            Some(point) => zero_basics(lcp, &basis, &point),
            None => continue,
        };
        if !zeros.is_empty() {
            degenerate.push(Degenerate { step, zeros: names(&zeros) });
        }
    }
    Some(TieReport {
        rule: rule_words(tie_break, naming),
        pivots: log.count(),
        ties: tied,
        degenerate,
        complete: first == 0 && log.is_complete(),
    })
}
