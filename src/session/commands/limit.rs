//! `limit`: how far a load can grow.

use std::sync::Arc;

use clap::Args;
use serde::Serialize;

use crate::answer::record::Ray;
use crate::model::parameter::Number;
use crate::path::limit;
use crate::path::load_parameter::known;
use crate::path::record::PathRecord;
use crate::path::start::PathError;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::start::{PathStart, case_names};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// Find the limit of a load: its factor, the safety, how the structure collapses
///
/// A load whose present value is negative grows downwards. `limit cycle LOAD [A..B]` brackets the largest value to which
/// the load may go to and fro from A (0 if it is left out) so that the structure still shakes down; B, or the present
/// value, is looked at first.
///
/// In space, where slips turn, no path leads to the limit: runs of their own bracket it, with an answer on Coulomb's
/// cone on one side and a collapse that is certified on it on the other. Where forces within the friction bounds balance
/// loads that the law of slip does not carry, what is proved begins farther away: it is said where the answers end and where
/// the proof begins.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  limit pull\n  limit F2\n  limit cycle F2 0..100")]
pub struct Limit {
    /// Load case, or a parameter in which the loads are linear; `cycle` before it
    #[arg(value_name = "LOAD", num_args = 0..=3, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const LIMIT: Command = Command { complete: candidates, ..Command::of::<Limit>("limit") };

fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    match asked.given {
        [] => asked.varied().into_iter().chain(Candidate::plain(["cycle"])).collect(),
        [first] if first == "cycle" => asked.varied(),
        _ => Vec::new(),
    }
}

impl Action for Limit {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        match &self.words[..] {
            [first, rest @ ..] if first == "cycle" && !rest.is_empty() => session.limit_cycle(rest, io)?,
            [name] => session.limit(name, io)?,
            _ => return Err(session.no_load()),
        }
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }

    fn is_of_own_factors(&self, session: &Session) -> bool {
        !matches!(&self.words[..], [name] if session.combined_case(name).is_some())
    }
}

#[derive(Serialize)]
struct LimitReport<'a> {
    load: &'a str,
    limit: Option<f64>,
    present: f64,
    safety: Option<f64>,
    collapse: Option<&'a Ray>,
    confirmed: bool,
    answer_beyond: Option<f64>,
    end: String,
}

/// A combination that is shown, and its answer.
struct OfCombination {
    name: String,
    ground: PathStart,
}

impl Session {
    /// The combination that is shown, where this is one of its load cases; with its factors as numbers a parameter
    /// moves none of them.
    fn combined_case(&self, name: &str) -> Option<OfCombination> {
        let ((combination, prepared), solved) = (self.combination.as_ref()?, self.solved.as_ref()?);
        let ground = PathStart { setup: self.now.clone(), prepared: Arc::clone(prepared), solved: Arc::clone(solved) };
        let is_case = prepared.cases.iter().any(|(known, _)| known == name);
        is_case.then(|| OfCombination { name: combination.clone(), ground })
    }

    /// That one load is expected, and which ones there are.
    fn no_load(&self) -> CommandError {
        let known = self.now.prepared.as_ref().map_or_else(String::new, |prepared| known(prepared, &self.now.scenario));
        CommandError::Refused(format!(
            "limit: of which load? `limit LOAD`, or `limit cycle LOAD [A..B]`; there are {known}"
        ))
    }

    /// `limit LOAD`.
    pub(in crate::session) fn limit(&mut self, name: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let ground = match self.combined_case(name) {
            Some(combined) => {
                io.remark(&format!("of combination {}, with its factors", combined.name))?;
                combined.ground
            }
            None => self.ground(io.watch)?,
        };
        let cases = case_names(&ground.prepared);
        let is_idle = |(case, factor): &(String, Number)| case == name && *factor == Number::Value(0.0);
        if ground.prepared.cases.iter().any(is_idle) {
            io.remark(&format!("the factor of {name} is 0 in the file: by itself the case never acts"))?;
        }
        let what = name.to_owned();
        let found = worker::run(io.watch, move |watch| limit::limit(ground.case(watch), Some(&ground.solved), &what))?;
        let found = found.map_err(|error| match error {
            // no exact path leads over it, but runs of their own can bracket it
            PathError::Mixed { name, why } => {
                let why =
                    format!("{why}; `find least|most {name} A..B where outcome answer` brackets where answers end");
                PathError::Mixed { name, why }
            }
            error => error,
        })?;
        let unit = self.now.scenario.unit_of(name).map(str::to_owned);
        let report = LimitReport {
            load: name,
            limit: found.factor,
            present: found.present,
            safety: found.safety,
            collapse: found.collapse(),
            confirmed: found.confirmed,
            answer_beyond: found.beyond,
            end: found.end_sentence(),
        };
        io.show(&report, |out, style| view::path::write_limit(out, &found, unit.as_deref(), style))?;
        if let Some(record) = found.path.as_ref().map(|path| PathRecord::of_load(path, &cases)) {
            // A single place draws no picture: a path that does is kept.
            if record.places.len() > 1 || self.path.is_none() {
                self.keep_path(record);
            }
        }
        Ok(())
    }
}
