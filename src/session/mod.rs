//! The application without a terminal: one scenario, its values and rules, its answer, and the language of commands
//! that works on them. The REPL, scripts and the full screen are faces of it.
//!
//! The state is here, what is chosen in `setup`, what is shown in `present`, how it changes in `change`; `run` takes a
//! line apart by the `language`, and each of the `commands` answers to an [`Output`].

mod ask;
mod change;
pub mod commands;
mod error;
pub mod file_watch;
mod gauges;
mod history;
pub mod journal;
pub mod language;
pub mod load;
mod output;
pub mod places;
mod present;
mod recorder;
mod run;
mod save;
pub mod script;
mod setup;
pub mod shared;
mod start;
pub mod worker;

use std::sync::Arc;

pub use crate::answer::record::Answer;
use crate::answer::record::OutcomeKind;
pub use crate::answer::{diagram, record as results};
pub use crate::explain::remedy::Remedies;
use crate::export::table::Table;
use crate::model::parameter::ParameterValues;
use crate::model::plausible;
use crate::model::problem::Problem;
use crate::model::scenario::Scenario;
use crate::path::record::PathRecord;
pub use crate::path::stages::{History, HistoryEnd};
use crate::solve::look::{Looked, look};
pub use crate::solve::{Prepared, Solved};
use crate::view::projection::Viewpoint;
use crate::watch::Watch;

pub use commands::load::write_scenarios;
pub use commands::map::Drawn as DrawnMap;
pub use commands::side::{AllAnswers, Glance, OneAnswer};
pub use error::CommandError;
pub use gauges::Gauge;
use output::Report;
pub use output::{Format, Output};

use journal::{Journal, LeftOver};
use language::setting::{self, Setting};
use recorder::Recorder;
use setup::{Change, Setup};

/// What comes after a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// The next command.
    Continue,
    /// The end.
    Quit,
    /// The full screen, with the same session.
    FullScreen {
        /// The tour it begins with, if any.
        tour: Option<commands::screen::Tour>,
    },
    /// The file of the scenario in an editor, then `reload`.
    Edit,
}

/// Whether the scenario that the following commands were meant for is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Missing {
    Nothing,
    /// The last command was a `load` that failed.
    JustNow,
    /// A `load` before that failed.
    Still,
}

/// What `check` says of a scenario that has no problems.
pub struct Diagnosis {
    /// Its title.
    pub title: String,
    /// What was put right while it was read, and what was not looked into.
    pub notes: Vec<String>,
    /// What only contact holds, in sentences.
    pub loose: Vec<String>,
    /// What is allowed but can hardly be meant, under the values of the file.
    pub warnings: Vec<Problem>,
}

/// Looks at a scenario without solving it.
///
/// # Errors
/// A main system that cannot be factorized, an interruption.
pub fn diagnose(scenario: Scenario, watch: &dyn Watch) -> Result<Diagnosis, CommandError> {
    worker::run(watch, move |watch| {
        let Looked { loose, warnings, left_out } = look(&scenario, watch)?;
        let notes = scenario.notes.into_iter().chain(left_out).collect();
        Ok::<_, CommandError>(Diagnosis { title: scenario.title, notes, loose, warnings })
    })?
}

/// What is said of a scenario as soon as it is loaded: notes of its file, and what is odd enough to change every answer.
pub fn introduction(scenario: &Scenario) -> Vec<String> {
    let warnings = plausible::said_at_load(scenario).into_iter().map(|warning| format!("warning: {warning}"));
    scenario.notes.iter().cloned().chain(warnings).collect()
}

/// A scenario that is being worked on.
pub struct Session {
    now: Setup,
    solved: Option<Arc<Solved>>,
    /// The answer before the last change.
    previous: Option<Arc<Solved>>,
    /// The pivot shown; `None` for the end.
    position: Option<usize>,
    auto: bool,
    undo: Vec<Change>,
    redo: Vec<Change>,
    /// Whether the files of the scenario are watched.
    watches: bool,
    history: Vec<String>,
    journal: Option<Journal>,
    left_over: Option<LeftOver>,
    recorder: Option<Recorder>,
    /// Message of the command before, if it failed.
    last_error: Option<String>,
    /// A `load` that failed while lines came by themselves.
    missing: Missing,
    /// Whether a run failed and no `expect outcome` has asked for that.
    trouble: bool,
    /// Depth of nested scripts.
    depth: usize,
    /// What the last `trace` or `stages` followed.
    path: Option<Arc<PathRecord>>,
    /// The values under which it was followed.
    path_values: ParameterValues,
    /// The last map.
    map: Option<Arc<commands::map::Drawn>>,
    /// The last `sample`.
    sampled: Option<Arc<crate::path::sample::Sampled>>,
    /// What the last `map`, `find`, `cycle`, `sample`, `prove` or `calibrate` reported.
    result: Option<serde_json::Value>,
    /// The table of the last `sweep` that was shown.
    swept: Option<Arc<Table>>,
    /// What would stop the collapse of this answer, once it was looked for.
    remedies: Option<(Arc<Solved>, Arc<Remedies>)>,
    /// The load history that quantities mean, until the next change or `solve`.
    followed: Option<Arc<History>>,
    /// The combination whose answer is shown: its name, and the geometry with its factors. `None` for the scenario's own.
    combination: Option<(String, Arc<Prepared>)>,
    /// From where a structure in space is seen.
    viewpoint: Viewpoint,
}

impl Session {
    /// A session on a scenario, solved with the values of its file.
    ///
    /// # Errors
    /// A main system that cannot be factorized, rules that do not fit, an interruption.
    pub fn new(scenario: Scenario, watch: &dyn Watch) -> Result<Self, CommandError> {
        Self::with_settings(scenario, &[], watch)
    }

    /// A session on a scenario, solved after `settings`, each the words after a `set`.
    ///
    /// # Errors
    /// As [`Session::new`], and settings that `set` would refuse.
    pub fn with_settings(
        scenario: Scenario,
        settings: &[Vec<String>],
        watch: &dyn Watch,
    ) -> Result<Self, CommandError> {
        let mut now = Setup::of(scenario);
        for words in settings {
            match setting::read(words, &now.scenario, &now.values)? {
                Setting::Auto(_) => {
                    return Err(CommandError::Refused("`auto` is for a session: a single run is always solved".into()));
                }
                setting => now.take(&setting)?,
            }
        }
        let solved = now.solve(watch)?;
        let mut session = Session {
            now,
            solved: None,
            previous: None,
            position: None,
            auto: true,
            undo: Vec::new(),
            redo: Vec::new(),
            watches: false,
            history: Vec::new(),
            journal: None,
            left_over: None,
            recorder: None,
            last_error: None,
            missing: Missing::Nothing,
            trouble: false,
            depth: 0,
            path: None,
            path_values: ParameterValues::default(),
            map: None,
            sampled: None,
            result: None,
            swept: None,
            remedies: None,
            followed: None,
            combination: None,
            viewpoint: Viewpoint::default(),
        };
        session.take_answer(Some(solved));
        Ok(session)
    }

    /// Writes every change to `journal` from now on, and remembers what an earlier session left there.
    pub fn keep_journal(&mut self, journal: Journal) {
        self.left_over = journal.left_over();
        self.journal = Some(journal);
    }

    /// What an earlier session in the same directory left behind.
    pub fn left_over(&self) -> Option<&LeftOver> {
        self.left_over.as_ref()
    }

    /// Ends the session in order: nothing is left to restore.
    ///
    /// # Errors
    /// The journal cannot be removed.
    pub fn close(&mut self) -> std::io::Result<()> {
        self.recorder = None;
        match &mut self.journal {
            Some(journal) => journal.close(),
            None => Ok(()),
        }
    }
}

/// The status of a `solve` (see the help).
pub fn exit_status(answer: &Answer) -> u8 {
    match answer.outcome {
        OutcomeKind::Trivial | OutcomeKind::Normal => 0,
        OutcomeKind::Ray => match answer.ray.as_ref().map(|ray| ray.class) {
            Some(class) if class.is_of_structure() => 3,
            Some(_) | None => 4,
        },
        OutcomeKind::PivotLimit | OutcomeKind::Breakdown | OutcomeKind::CheckFailed => 4,
    }
}
