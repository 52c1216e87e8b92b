//! What only a picture asks for: the motion of a ray as displacements of the nodes, and all answers of a small
//! problem side by side.

use std::sync::Arc;

use crate::answer::record::{NodeDisplacement, PairState};
use crate::answer::same::same_pairs;
use crate::model::parameter::ParameterValues;
use crate::solve::all_answers::MOST_PAIRS as MOST_ENUMERATED;
use crate::solve::case::There;
use crate::solve::prepared::Geometry;
use crate::solve::{Prepared, Solved};
use crate::watch::Watch;

use crate::session::error::refused;
use crate::session::setup::refused_or_interrupted;
use crate::session::{CommandError, Session, worker};

/// One of several answers.
#[derive(Clone, Debug, PartialEq)]
pub struct OneAnswer {
    /// Its pairs.
    pub pairs: Vec<PairState>,
    /// Whether it holds in exact arithmetic; otherwise up to rounding.
    pub exact: bool,
    /// Whether others may lie right beside it.
    pub continuum: bool,
    /// Whether it is the present answer of the session.
    pub shown: bool,
}

/// All answers found by a search over working schemes.
#[derive(Clone, Debug, PartialEq)]
pub struct AllAnswers {
    /// The answers, in the order of the search.
    pub answers: Vec<OneAnswer>,
    /// Whether these are all: the search came to its end and left no scheme undecided.
    pub complete: bool,
}

/// An answer beside the present one.
pub struct Glance {
    /// The geometry there.
    pub prepared: Arc<Prepared>,
    /// The values there.
    pub values: ParameterValues,
    /// The answer there.
    pub solved: Arc<Solved>,
    /// The motion of the ray it ended in.
    pub mode: Option<Vec<NodeDisplacement>>,
}

/// The motion of a ray as displacements of the nodes.
fn mode_of(prepared: &Prepared, solved: &Solved) -> Option<Vec<NodeDisplacement>> {
    let ray = solved.answer.ray.as_ref()?;
    let Geometry::Structure { system, main, structure } = &*prepared.geometry else {
        return None;
    };
    let z = system.over_joints(ray.direction.pairs().iter().map(|direction| (direction.z_n, direction.slip())));
    if z.amax() == 0.0 {
        return None;
    }
    let u = main.displacements(&vec![0.0; prepared.cases.len()], &z);
    Some(NodeDisplacement::of_nodes(structure, &u.0))
}

/// Most pairs whose answers are shown side by side.
const MOST_PAIRS: usize = 10;

impl Session {
    /// The motion of the ray as displacements of the nodes (largest mutual displacement 1); `None` without a ray or
    /// a structure.
    pub fn mode(&self) -> Option<Vec<NodeDisplacement>> {
        mode_of(self.now.prepared.as_ref()?, self.solved.as_ref()?)
    }

    /// The answer at other values of parameters, or factors of load cases, on the side: the session stays as it is.
    ///
    /// # Errors
    /// Impossible values; nothing solved yet; an interruption.
    pub fn glance(&self, settings: &[(String, f64)], watch: &dyn Watch) -> Result<Glance, CommandError> {
        let (prepared, solved) = self.both()?;
        let setup = self.now.clone();
        let settings = settings.to_vec();
        worker::run(watch, move |watch| {
            let named: Vec<(&str, f64)> = settings.iter().map(|(name, value)| (name.as_str(), *value)).collect();
            let case = setup.case(&prepared, watch);
            let there = case.at_all(&named)?;
            let solved = there.case(case).solve_from(&solved).map_err(refused_or_interrupted)?;
            let mode = mode_of(&there.prepared, &solved);
            let There { prepared, values } = there;
            Ok(Glance { prepared, values, solved: Arc::new(solved), mode })
        })?
    }

    /// Searches all working schemes of the present problem for answers.
    ///
    /// # Errors
    /// No contact problem, too many pairs, nothing solved yet, an interruption.
    pub fn all_answers(&self, watch: &dyn Watch) -> Result<AllAnswers, CommandError> {
        let (prepared, solved) = self.both()?;
        // Where a combination is shown, its factors are in its own geometry.
        let shown = self.prepared_shown().map_or(prepared, Arc::clone);
        let (values, rules) = (self.now.values.clone(), self.now.rules);
        worker::run(watch, move |watch| {
            let Some(system) = shown.system() else {
                return refused("answers are enumerated for contact problems, this is a bare LCP");
            };
            if system.turning_pairs() > MOST_PAIRS {
                let pairs = system.turning_pairs();
                let listed = match pairs <= MOST_ENUMERATED {
                    true => "`enumerate` goes on until it is stopped".to_owned(),
                    false => format!("`enumerate` takes {MOST_ENUMERATED}"),
                };
                return refused(format!(
                    "{pairs} contact pairs are too many for all answers side by side: at most {MOST_PAIRS}; {listed}"
                ));
            }
            let found = shown.all_answers(&values, rules, watch)?;
            let each = found.answers.into_iter().zip(found.exact).zip(found.continuum);
            let answers = each.map(|((answer, exact), continuum)| OneAnswer {
                shown: solved.answer.is_answer() && same_pairs(&answer.answer.pairs, &solved.answer.pairs),
                pairs: answer.answer.pairs,
                exact,
                continuum,
            });
            Ok(AllAnswers { answers: answers.collect(), complete: found.complete && found.undecided == 0 })
        })?
    }
}
