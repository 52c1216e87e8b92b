//! `enumerate`: every answer.

use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use serde::Serialize;

use crate::answer::record::{PairState, PlainSolution};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::solve::Solved;
use crate::solve::all_answers::{AllAnswers, Continuum, Moving};
use crate::view;

/// How long the answers of a stopped search are waited for.
const PATIENCE: Duration = Duration::from_secs(2);

/// List every answer; with a number, show that one
///
/// Goes through all working schemes in exact arithmetic, cutting what cannot be completed. Where answers lie side by
/// side it tells the corners of the continuum and the directions in which it has no end. Ctrl-C shows what was found
/// so far. `enumerate 2` makes the second answer the one that `pairs`, `plot` and the others show; `solve` goes back
/// to Lemke's. In space the answers are those of the friction polygon (`set facets`), not of the cone.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  load klarbring; enumerate; enumerate 2; pairs")]
pub struct Enumerate {
    /// Number of the answer to show
    #[arg(value_name = "ANSWER")]
    answer: Option<usize>,
}

pub const ENUMERATE: Command = Command::of::<Enumerate>("enumerate");

impl Action for Enumerate {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.enumerate(self.answer, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

#[derive(Serialize)]
struct AnswersReport<'a> {
    answers: Vec<OneReport<'a>>,
    continua: Vec<ContinuumReport<'a>>,
    complete: bool,
    visited: u64,
    cut: u64,
    total: u64,
    undecided: u64,
    within_rounding: bool,
    /// Of the polygon whose answers they are, in space.
    #[serde(skip_serializing_if = "Option::is_none")]
    facets: Option<usize>,
}

#[derive(Serialize)]
struct OneReport<'a> {
    pairs: &'a [PairState],
    solution: &'a Option<PlainSolution>,
    exact: bool,
    continuum: bool,
}

/// A set of answers: its corners, numbered from 1 as the answers are, and the directions in which it has no end.
#[derive(Serialize)]
struct ContinuumReport<'a> {
    answers: Vec<usize>,
    /// z at the corners, of a bare LCP.
    corners: Option<Vec<&'a [f64]>>,
    directions: &'a [Moving],
}

impl<'a> AnswersReport<'a> {
    fn of(all: &'a AllAnswers) -> Self {
        let flags = all.exact.iter().zip(&all.continuum);
        let one = |(solved, (exact, continuum)): (&'a Solved, (&bool, &bool))| OneReport {
            pairs: &solved.answer.pairs,
            solution: &solved.answer.solution,
            exact: *exact,
            continuum: *continuum,
        };
        let z = |corner: &usize| all.answers[*corner].answer.solution.as_ref().map(|solution| &solution.z[..]);
        let continuum = |piece: &'a Continuum| ContinuumReport {
            answers: piece.corners.iter().map(|corner| corner + 1).collect(),
            corners: piece.corners.iter().map(z).collect(),
            directions: &piece.directions,
        };
        AnswersReport {
            answers: all.answers.iter().zip(flags).map(one).collect(),
            continua: all.continua.iter().map(continuum).collect(),
            complete: all.complete,
            visited: all.visited,
            cut: all.cut,
            total: all.total,
            undecided: all.undecided,
            within_rounding: all.within_rounding,
            facets: all.facets,
        }
    }
}

impl Session {
    pub(in crate::session) fn enumerate(
        &mut self,
        answer: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (values, rules) = (self.now.values.clone(), self.now.rules);
        // Stopped, it shows what was found so far.
        let (prepared, _) = self.both()?;
        let mut all: AllAnswers =
            worker::run_patiently(io.watch, PATIENCE, move |watch| prepared.all_answers(&values, rules, watch))??;
        if let Some(number) = answer {
            let count = all.answers.len();
            if number == 0 || number > count {
                return Err(CommandError::Refused(match count {
                    0 => "enumerate: there is no answer to show".to_owned(),
                    1 => format!("enumerate: there is no answer {number}; expected 1"),
                    _ => format!("enumerate: there is no answer {number}; expected 1 … {count}"),
                }));
            }
            let chosen = all.answers.swap_remove(number - 1);
            self.take_answer(Some(Arc::new(chosen)));
            return self.report_pairs(&[], io);
        }
        io.show(&AnswersReport::of(&all), |out, style| view::enumerate::write(out, &all, style))?;
        Ok(())
    }
}
