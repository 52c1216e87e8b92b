//! What only a picture asks for: the motion of a ray as displacements of the nodes, and all answers of a small
//! problem side by side.

use std::sync::Arc;

use nalgebra::DVector;

use crate::answer::record::{NodeDisplacement, PairState};
use crate::answer::same::same_pairs;
use crate::solve::prepared::Geometry;
use crate::watch::Watch;

use crate::session::error::refused;
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

/// Most pairs whose answers are shown side by side.
const MOST_PAIRS: usize = 10;

impl Session {
    /// The motion of the ray as displacements of the nodes (largest mutual displacement 1); `None` without a ray or
    /// a structure.
    pub fn mode(&self) -> Option<Vec<NodeDisplacement>> {
        let solved = self.solved.as_ref()?;
        let ray = solved.answer.ray.as_ref()?;
        let prepared = self.now.prepared.as_ref()?;
        let Geometry::Structure { system, main, structure } = &*prepared.geometry else {
            return None;
        };
        let mut z = DVector::zeros(system.joint_count());
        for (i, (pair, direction)) in system.pairs.iter().zip(ray.direction.pairs()).enumerate() {
            z[i] = direction.z_n;
            if let Some(joint) = pair.tangential {
                z[joint] = direction.z_t;
            }
        }
        if z.amax() == 0.0 {
            return None;
        }
        let u = main.displacements(&vec![0.0; prepared.cases.len()], &z);
        let nodes = structure.nodes.iter().zip(&u.0);
        Some(nodes.map(|(node, u)| NodeDisplacement { node: node.id.clone(), ux: u[0], uy: u[1], rz: u[2] }).collect())
    }

    /// Searches all working schemes of the present problem for answers.
    ///
    /// # Errors
    /// No contact problem, too many pairs, nothing solved yet, an interruption.
    pub fn all_answers(&self, watch: &dyn Watch) -> Result<AllAnswers, CommandError> {
        let (prepared, solved) = self.both()?;
        // Where a combination is shown, its factors are in its own geometry.
        let shown = self.combination.as_ref().map_or(prepared, |(_, there)| Arc::clone(there));
        let values = self.now.values.clone();
        worker::run(watch, move |watch| {
            let Some(system) = shown.system() else {
                return refused("answers are enumerated for contact problems, this is a bare LCP");
            };
            if system.pair_count() > MOST_PAIRS {
                return refused(format!(
                    "{} contact pairs are too many for all answers side by side: at most {MOST_PAIRS}; `enumerate` goes on \
                     until it is stopped",
                    system.pair_count()
                ));
            }
            let found = shown.all_answers(&values, watch)?;
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
