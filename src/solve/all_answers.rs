//! Every answer of a small problem as a solved state.

use std::sync::Arc;

use nalgebra::DVector;

use super::cold::Extent;
use super::error::{QuestionError, SolveError};
use super::finish::excuse_hidden;
use super::plain::plain_answer;
use super::plain_answers::{Effort, all_plain_answers};
use super::prepared::{Geometry, Prepared};
use super::problem::{contact_problem, factors};
use super::state::Solved;
use crate::answer::attempt::{AttemptCovering, AttemptEngine, AttemptRules, PlainCovering};
use crate::answer::record::PairDirection;
use crate::contact::lcp::contact_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::enumerate::{Continuum as ContactContinuum, EnumeratedAnswer};
use crate::contact::schemes::near::enumerate_to_rounding;
use crate::contact::schemes::scheme::PairScheme;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Rules, TieBreak};
use crate::watch::Watch;

/// Most contact pairs that `enumerate` takes.
pub const MOST_PAIRS: usize = 60;
/// Most rows of a bare LCP that `enumerate` takes.
const MOST_ROWS: usize = 300;

/// All answers of a problem.
#[derive(Clone, Debug)]
pub struct AllAnswers {
    /// Each answer as a solved state without pivots.
    pub answers: Vec<Solved>,
    /// For each: whether it was proved in exact arithmetic. One of rounded data that fails its check is none of the structure: what
    /// resists its motions is rounding.
    pub exact: Vec<bool>,
    /// For each: whether others lie next to it.
    pub continuum: Vec<bool>,
    /// Sets of answers between and beyond them.
    pub continua: Vec<Continuum>,
    /// Whether the search came to its end.
    pub complete: bool,
    /// Schemes (of a bare LCP: bases) that were solved.
    pub visited: u64,
    /// Partial schemes that were cut off.
    pub cut: u64,
    /// All schemes there are.
    pub total: u64,
    /// Schemes that could not be decided.
    pub undecided: u64,
    /// Whether the numbers as stored have none, but it is open whether some lie within their rounding.
    pub within_rounding: bool,
    /// In space: the facets of the polygon whose answers these are.
    pub facets: Option<usize>,
}

/// A set of answers with more than one element: the hull of its corners, and from there on along its directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Continuum {
    /// Its corners, as indices of the answers.
    pub corners: Vec<usize>,
    /// Directions in which it goes on without end, largest entry 1.
    pub directions: Vec<Moving>,
}

/// A direction in the set of answers.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Moving {
    /// Of a contact problem.
    Pairs(Vec<PairDirection>),
    /// z of a bare LCP.
    Plain(Vec<f64>),
}

impl AllAnswers {
    /// Whether it is proved that there is none.
    pub fn none(&self) -> bool {
        self.complete && self.undecided == 0 && self.answers.is_empty() && !self.within_rounding
    }
}

impl Prepared {
    /// Every answer for these values; in space every answer on the polygon of these rules.
    ///
    /// # Errors
    /// Too many pairs or rows; a covering that does not fit the numbers. Stopped, what was found until then is returned
    /// as incomplete.
    pub fn all_answers(
        &self,
        values: &ParameterValues,
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<AllAnswers, QuestionError> {
        let system = match &*self.geometry {
            Geometry::Plain { lcp, q, .. } => {
                let q = q.iter().map(|number| number.value(values)).collect::<Vec<_>>().into();
                return all_of_plain(&Arc::new(MirroredLcp { q, ..lcp.clone() }), watch);
            }
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => system,
        };
        let instead = "`export lcp FILE.json` writes an LCP whose answers can be listed";
        if let Some(refusal) = system.dependence_refusal("enumerate", instead) {
            return Err(QuestionError::Refused(refusal));
        }
        too_many("contact pairs", system.turning_pairs(), MOST_PAIRS)?;
        let problem = contact_problem(system, &factors(self, values), values).under(Rules { cone: false, ..rules });
        let facets = system.is_in_space().then(|| problem.polygon.facets());
        let mut steps = 0u64;
        let found = enumerate_to_rounding(&problem, &mut |progress| {
            steps += 1;
            if steps.is_multiple_of(64) {
                watch.progress(&format!("{} schemes, {} answers", progress.nodes, progress.found), progress.share);
            }
            watch.go_on()
        });
        if found.no_answer() || found.within_rounding {
            // At what is a limit on paper, the stored numbers may lie just beyond it.
            let mut near = vec![self.attempt_contact(&problem, (Rules::default(), Extent::Whole), watch)?];
            for candidate in &found.answers {
                near.push(self.enumerated_answer(&problem, candidate)?);
            }
            let answers: Vec<Solved> = near.into_iter().filter(|near| near.answer.is_answer()).take(1).collect();
            return Ok(AllAnswers {
                exact: vec![false; answers.len()],
                continuum: vec![false; answers.len()],
                continua: Vec::new(),
                complete: found.complete,
                visited: found.visited,
                cut: found.cut,
                total: found.total,
                undecided: 0,
                within_rounding: found.within_rounding && answers.is_empty(),
                facets,
                answers,
            });
        }
        let answers = found
            .answers
            .iter()
            .map(|candidate| self.enumerated_answer(&problem, candidate))
            .collect::<Result<Vec<_>, _>>()?;
        let stands = |solved: &Solved| system.has_exact_data() || solved.answer.is_answer();
        let pairs = |direction: &DVector<f64>| {
            let pair = |i: usize| PairDirection::of(system, i, direction);
            Moving::Pairs((0..system.pair_count()).map(pair).collect())
        };
        let continuum = |piece: &ContactContinuum| Continuum {
            corners: piece.corners.clone(),
            directions: piece.directions.iter().map(pairs).collect(),
        };
        Ok(AllAnswers {
            exact: answers.iter().map(stands).collect(),
            answers,
            continuum: found.answers.iter().map(|answer| answer.continuum).collect(),
            continua: found.continua.iter().map(continuum).collect(),
            complete: found.complete,
            visited: found.visited,
            cut: found.cut,
            total: found.total,
            undecided: found.undecided,
            within_rounding: false,
            facets,
        })
    }

    /// An enumerated answer as a solved state, freshly checked.
    pub(super) fn enumerated_answer(
        &self,
        problem: &ContactProblem,
        candidate: &EnumeratedAnswer,
    ) -> Result<Solved, SolveError> {
        let system = &*problem.system;
        let contact = contact_lcp(problem, Covering::default())?;
        let mut z = vec![0.0; contact.rows.len()];
        let polygon = problem.polygon;
        for (value, row) in z.iter_mut().zip(&contact.rows) {
            // What the scheme holds is zero, not the rounding of a linear program.
            let scheme = candidate.schemes.first().map(|scheme| scheme[row.pair]);
            *value = match row.couple.facet() {
                None if scheme.is_some_and(|scheme| !scheme.open) => 0.0,
                None => candidate.state.z[row.pair].max(0.0),
                Some(facet) => {
                    let free = scheme.is_none_or(|scheme| {
                        // Without cohesion an open pair may slip either way.
                        let is_loose = scheme == PairScheme::OPEN;
                        is_loose || scheme.tangential.facets(polygon).contains(&facet)
                    });
                    let slip = system.pairs[row.pair].slip(&candidate.state.z);
                    if free { polygon.slips(slip)[facet] } else { 0.0 }
                }
            } / contact.length_unit;
        }
        let point = Point { w: vec![0.0; z.len()], z, p: 0.0 };
        let rules = AttemptRules::from(Rules::default()).by(AttemptEngine::Enumeration);
        let mut solved = self.answer_at(problem, contact, point, rules, Extent::Whole)?;
        if system.has_exact_data() {
            excuse_hidden(&mut solved.answer);
        }
        Ok(solved)
    }
}

/// Refuses a size at which the search would never end or its exact numbers would fill the memory.
fn too_many(what: &str, found: usize, most: usize) -> Result<(), QuestionError> {
    if found <= most {
        return Ok(());
    }
    Err(QuestionError::Refused(format!("{found} {what} are too many to enumerate: at most {most}")))
}

fn all_of_plain(lcp: &Arc<MirroredLcp>, watch: &dyn Watch) -> Result<AllAnswers, QuestionError> {
    too_many("rows", lcp.size(), MOST_ROWS)?;
    let found = all_plain_answers(lcp, Effort::Full, watch).ok_or(QuestionError::Interrupted)?;
    let rules = AttemptRules {
        covering: AttemptCovering::Plain(PlainCovering::Ones),
        tie_break: TieBreak::Lexicographic,
        engine: AttemptEngine::Enumeration,
    };
    let count = found.answers.len();
    let next_to = |answer: usize| found.continua.iter().any(|piece| piece.corners.contains(&answer));
    Ok(AllAnswers {
        answers: found.answers.iter().map(|z| plain_answer(lcp, z, rules)).collect(),
        exact: vec![true; count],
        continuum: (0..count).map(next_to).collect(),
        continua: found
            .continua
            .iter()
            .map(|piece| Continuum {
                corners: piece.corners.clone(),
                directions: piece.directions.iter().cloned().map(Moving::Plain).collect(),
            })
            .collect(),
        complete: found.complete,
        visited: found.visited,
        cut: found.cut,
        total: 1u64.checked_shl(lcp.size() as u32).unwrap_or(u64::MAX),
        undecided: found.undecided,
        within_rounding: false,
        facets: None,
    })
}
