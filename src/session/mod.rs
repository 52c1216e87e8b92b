//! The application without a terminal: one scenario, its values and rules, its answer, and the language of commands
//! that works on them. The REPL, scripts and the full screen are faces of it.
//!
//! `words` → `command` (the grammar) → `apply` (changes) or `reports` (read-only) → [`Output`].

pub mod commands;
mod error;
mod history;
pub mod journal;
pub mod language;
pub mod load;
mod output;
pub mod worker;

use std::sync::Arc;

use serde_json::json;

pub use crate::answer::record::Answer;
use crate::answer::record::{NodeDisplacement, OutcomeKind, PairState, PlainSolution, RayClass};
pub use crate::answer::{diagram, record as results};
pub use crate::explain::remedy::Remedies;
use crate::export::table::Table;
use crate::model::parameter::ParameterValues;
use crate::model::problem::Problem;
use crate::model::rules::Rules;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Structure;
use crate::model::uses::Redone;
use crate::path::record::PathRecord;
pub use crate::path::stages::History;
use crate::solve;
use crate::solve::Case;
pub use crate::solve::{Prepared, Solved};
use crate::text::printable;
use crate::watch::Watch;

pub use commands::dispatch::write_scenarios;
pub use commands::side::{AllAnswers, OneAnswer};
pub use error::CommandError;
pub use output::{Format, Output};

use commands::record::Recorder;
use commands::{combinations, script};
use journal::{Journal, LeftOver};
use language::setting::Setting;
use language::{command, setting, tokens};

/// What comes after a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// The next command.
    Continue,
    /// The end.
    Quit,
    /// The full screen, with the same session.
    FullScreen {
        /// Whether it begins with the tour.
        tour: bool,
    },
}

/// What the user has chosen: all that `undo` brings back.
#[derive(Clone)]
struct Setup {
    scenario: Arc<Scenario>,
    /// The factorization and R of the scenario; kept for every change of values and rules.
    prepared: Option<Arc<Prepared>>,
    values: ParameterValues,
    rules: Rules,
}

/// A change that can be taken back.
#[derive(Clone)]
struct Change {
    /// The command, as typed.
    command: String,
    /// What was before it (in `undo`), or after it (in `redo`).
    setup: Setup,
}

/// What the commands that follow were meant for and is not there.
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
    /// What was put right while it was read.
    pub notes: Vec<String>,
    /// What only contact holds, in sentences.
    pub loose: Vec<String>,
    /// What is allowed and hardly meant, under the values of the file.
    pub warnings: Vec<Problem>,
}

/// Looks at a scenario without solving it.
///
/// # Errors
/// A main system that cannot be factorized, an interruption.
pub fn diagnose(scenario: Scenario, watch: &dyn Watch) -> Result<Diagnosis, CommandError> {
    worker::run(watch, move |watch| {
        let prepared = solve::prepare(&scenario, watch)?;
        let (loose, warnings) = (prepared.loose_sentences(), prepared.warnings(&scenario));
        Ok::<_, CommandError>(Diagnosis { title: scenario.title, notes: scenario.notes, loose, warnings })
    })?
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
    history: Vec<String>,
    journal: Option<Journal>,
    left_over: Option<LeftOver>,
    recorder: Option<Recorder>,
    /// Message of the command before, if it failed.
    last_error: Option<String>,
    /// A `load` that failed while lines came by themselves.
    missing: Missing,
    /// A run that ended without an answer and that no `expect outcome` has asked for.
    trouble: Option<OutcomeKind>,
    /// Depth of nested scripts.
    depth: usize,
    /// What the last `trace` or `stages` followed.
    path: Option<Arc<PathRecord>>,
    map: Option<Arc<commands::map::Drawn>>,
    /// The table of the last `sweep` that was shown.
    swept: Option<Arc<Table>>,
    /// What would stop the collapse of this answer, once it was looked for.
    remedies: Option<(Arc<Solved>, Arc<Remedies>)>,
    /// The load history that quantities mean, until the next change or `solve`.
    followed: Option<Arc<History>>,
    /// The combination whose answer is shown; `None` for the scenario's own factors.
    combination: Option<combinations::Combination>,
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
                Setting::Parameter(name, value) => {
                    now.values.insert(name, value);
                }
                Setting::Covering(covering) => now.rules.covering = covering,
                Setting::TieBreak(tie_break) => now.rules.tie_break = tie_break,
                Setting::Engine(engine) => now.rules.engine = engine,
                Setting::Auto(_) => {
                    return Err(CommandError::Refused("`auto` is for a session: a single run is always solved".into()));
                }
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
            history: Vec::new(),
            journal: None,
            left_over: None,
            recorder: None,
            last_error: None,
            missing: Missing::Nothing,
            trouble: None,
            depth: 0,
            path: None,
            map: None,
            swept: None,
            remedies: None,
            followed: None,
            combination: None,
        };
        session.take_answer(Some(solved));
        Ok(session)
    }

    /// The scenario as loaded.
    pub fn scenario(&self) -> &Scenario {
        &self.now.scenario
    }

    /// The scenario, shared: equal pointers mean that nothing was loaded in between.
    pub fn shared_scenario(&self) -> Arc<Scenario> {
        Arc::clone(&self.now.scenario)
    }

    /// The present parameter values.
    pub fn values(&self) -> &ParameterValues {
        &self.now.values
    }

    /// The present rules.
    pub fn rules(&self) -> Rules {
        self.now.rules
    }

    /// Whether each change is solved at once.
    pub fn auto(&self) -> bool {
        self.auto
    }

    /// The present answer; `None` after a change with `auto` off.
    pub fn answer(&self) -> Option<&Answer> {
        self.solved.as_deref().map(|solved| &solved.answer)
    }

    /// The present solved state, shared.
    pub fn solved(&self) -> Option<Arc<Solved>> {
        self.solved.clone()
    }

    /// The prepared geometry, shared.
    pub fn prepared(&self) -> Option<Arc<Prepared>> {
        self.now.prepared.clone()
    }

    /// The structure under the parameter values of the present answer, if the scenario is one.
    pub fn structure(&self) -> Option<&Structure> {
        match (&self.now.prepared, &self.now.scenario.source) {
            (Some(prepared), _) => prepared.structure(),
            (None, Source::Structure(structure)) => Some(structure),
            (None, _) => None,
        }
    }

    /// The answer before the last change.
    pub fn previous_answer(&self) -> Option<&Answer> {
        self.previous.as_deref().map(|solved| &solved.answer)
    }

    /// The solved state before the last change, shared.
    pub fn previous(&self) -> Option<Arc<Solved>> {
        self.previous.clone()
    }

    /// The pivot chosen by `step`; `None` at the end.
    pub fn position(&self) -> Option<usize> {
        self.position
    }

    /// The step of the pivot shown; `None` where there are no pivots.
    pub fn shown_step(&self) -> Option<usize> {
        let last = self.answer()?.pivot_count.checked_sub(1)?;
        Some(self.position.unwrap_or(last))
    }

    /// The pairs at the pivot shown.
    pub fn pairs(&self) -> Vec<PairState> {
        let Some(solved) = &self.solved else {
            return Vec::new();
        };
        self.position
            .zip(self.now.prepared.as_ref())
            .and_then(|(step, prepared)| solved.pairs_at(prepared, step))
            .unwrap_or_else(|| solved.answer.pairs.clone())
    }

    /// p at the pivot shown.
    pub fn p(&self) -> Option<f64> {
        let solved = self.solved.as_ref()?;
        match self.position {
            Some(step) => solved.p_at(step),
            None => Some(solved.answer.p),
        }
    }

    /// The displacements at the pivot shown; `None` where there are none.
    pub fn displacements(&self) -> Option<Vec<NodeDisplacement>> {
        let solved = self.solved.as_ref()?;
        match self.position.zip(self.now.prepared.as_ref()) {
            Some((step, prepared)) => solved.displacements_at(prepared, step),
            None => solved.answer.displacements.clone(),
        }
    }

    /// z and w of a bare LCP at the pivot shown; `None` for contact problems.
    pub fn solution(&self) -> Option<PlainSolution> {
        let solved = self.solved.as_ref()?;
        match self.position {
            Some(step) => solved.plain_at(step),
            None => solved.answer.solution.clone(),
        }
    }

    /// What the last `trace` or `stages` followed.
    pub fn path(&self) -> Option<Arc<PathRecord>> {
        self.path.clone()
    }

    /// The commands given so far.
    pub fn history(&self) -> &[String] {
        &self.history
    }

    /// How many changes can be taken back, and done again.
    pub fn undo_depths(&self) -> (usize, usize) {
        (self.undo.len(), self.redo.len())
    }

    /// The exit status a script or pipe has earned by a run without an answer; 0 without one.
    pub fn trouble_status(&self) -> u8 {
        if self.trouble.is_some() { 4 } else { 0 }
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

    /// Runs the commands of a line; stops at the first that fails (unless `expect error` follows it).
    ///
    /// # Errors
    /// [`CommandError`]; the command that failed has left the session as it was.
    pub fn execute(&mut self, line: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        let commands = tokens::commands(line);
        for (index, command) in commands.iter().enumerate() {
            match self.run(command, io) {
                Ok(Next::Continue) => {}
                Ok(next) => return Ok(next),
                Err(error) => {
                    let asked_for = commands.get(index + 1).is_some_and(|next| script::expects_error(next));
                    if !asked_for || error.is_output() || error.is_interrupted() {
                        return Err(error);
                    }
                }
            }
        }
        Ok(Next::Continue)
    }

    /// Runs one command.
    pub(crate) fn run(&mut self, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        io.report = None;
        let result = if self.depth == 0 && self.recorder.is_some() {
            self.run_recorded(text, io)
        } else {
            self.run_plain(text, io)
        };
        if self.depth == 0 {
            self.history.push(text.to_owned());
        }
        if io.format != Format::Text {
            let report = io.report.take().unwrap_or_default();
            let answer = match &result {
                Ok(_) => json!({"command": text, "line": io.line, "ok": true, "report": report}),
                Err(error) => json!({
                    "command": text, "line": io.line, "ok": false,
                    "error": error.to_string(), "status": error.status(),
                }),
            };
            match io.format {
                Format::Values => io.answers.push(answer),
                _ => writeln!(io.out, "{}", printable::json(answer.to_string()))?,
            }
        }
        io.out.flush()?;
        result
    }

    fn run_plain(&mut self, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        let parsed = command::parse(text);
        // `expect error` and `echo` look at or pass by the message of the command before them
        let keeps_error =
            matches!(parsed, Ok(None | Some(command::Command::Expect { .. } | command::Command::Echo { .. })));
        let is_load =
            matches!(parsed, Ok(Some(command::Command::Load { .. } | command::Command::New { kind: Some(_), .. })));
        let result = match parsed {
            Ok(None) => return Ok(Next::Continue),
            Ok(Some(command)) => self.needs_scenario(&command, io).and_then(|()| self.apply(command, text, io)),
            Err(error) => Err(error.into()),
        };
        self.missing = match (is_load, &result) {
            // Who interrupts sits there: what follows is meant for the session as it is.
            (true, Err(error)) if io.unattended && !error.is_interrupted() => Missing::JustNow,
            (true, _) => Missing::Nothing,
            (false, _) if !io.unattended => Missing::Nothing,
            (false, _) if self.missing == Missing::JustNow => {
                if script::expects_error(text) {
                    Missing::Nothing
                } else {
                    Missing::Still
                }
            }
            (false, _) => self.missing,
        };
        match &result {
            Ok(_) if !keeps_error => self.last_error = None,
            Err(error) if !matches!(error, CommandError::Unmet(_)) => {
                self.last_error = Some(error.to_string());
            }
            _ => {}
        }
        result
    }

    /// Whether a command may run after a `load` that failed: one that comes by itself was meant for the scenario that is
    /// not there, and would change another.
    fn needs_scenario(&self, command: &command::Command, io: &Output<'_>) -> Result<(), CommandError> {
        use language::command::Command::{Echo, Expect, Help, Load, New, Quit, Scenarios};
        let allowed = match command {
            Load { .. } | New { .. } | Help { .. } | Quit | Echo { .. } | Scenarios => true,
            Expect { words } => words.first().is_some_and(|word| word == "error"),
            _ => false,
        };
        if self.missing == Missing::Nothing || !io.unattended || allowed {
            return Ok(());
        }
        Err(CommandError::Refused(
            "not done: the `load` before it failed, and this was meant for what it did not load; `load` something that \
             is there first"
                .into(),
        ))
    }

    /// Commands that bring a fresh session to the present scenario, values and rules.
    pub fn as_commands(&self) -> Vec<String> {
        let scenario = &self.now.scenario;
        // a file may bear the name of an embedded scenario
        let embedded = scenario.path.is_some() && crate::model::embedded::text(&scenario.name).is_some();
        let place = if embedded { "./" } else { "" };
        let mut commands = vec![format!("load {}", tokens::quote(&format!("{place}{}", scenario.name)))];
        let mut sets: Vec<String> = self
            .now
            .values
            .free()
            .filter(|(name, value)| {
                scenario.parameters.get(*name).is_none_or(|parameter| parameter.value.to_bits() != value.to_bits())
            })
            .map(|(name, value)| format!("set {name} {value}"))
            .collect();
        let (rules, file) = (self.now.rules, scenario.rules);
        if rules.covering != file.covering {
            sets.push(format!("set covering {}", rules.covering));
        }
        if rules.tie_break != file.tie_break {
            sets.push(format!("set tie-break {}", rules.tie_break));
        }
        if rules.engine != file.engine {
            sets.push(format!("set engine {}", rules.engine));
        }
        // one run for all of them: a run half-way might be refused
        if sets.len() > 1 || !self.auto {
            commands.push("set auto off".to_owned());
        }
        let several = sets.len() > 1;
        commands.extend(sets);
        if several && self.auto {
            commands.push("set auto on".to_owned());
        }
        commands
    }

    /// Makes `solved` the present answer, shown at its end.
    fn take_answer(&mut self, solved: Option<Arc<Solved>>) {
        self.trouble = solved
            .as_ref()
            .map(|solved| solved.answer.outcome)
            .filter(|outcome| {
                matches!(outcome, OutcomeKind::PivotLimit | OutcomeKind::Breakdown | OutcomeKind::CheckFailed)
            })
            .or(self.trouble);
        self.previous = self.solved.take().or(self.previous.take());
        self.solved = solved;
        self.position = None;
        self.followed = None;
        self.combination = None;
    }
}

impl Setup {
    fn of(scenario: Scenario) -> Self {
        Setup {
            values: scenario.parameter_values(),
            rules: scenario.rules,
            scenario: Arc::new(scenario),
            prepared: None,
        }
    }

    /// What was chosen, with the geometry made ready for it.
    fn case<'a>(&'a self, prepared: &'a Prepared, watch: &'a dyn Watch) -> Case<'a> {
        prepared.case(&self.scenario, &self.values).under(self.rules).watched(watch)
    }

    /// Solves cold, preparing the geometry if that was not done yet.
    fn solve(&mut self, watch: &dyn Watch) -> Result<Arc<Solved>, CommandError> {
        self.solve_from(None, watch)
    }

    /// Solves, from the `last` answer of the same geometry where there is one and that pays.
    fn solve_from(&mut self, last: Option<Arc<Solved>>, watch: &dyn Watch) -> Result<Arc<Solved>, CommandError> {
        let scenario = Arc::clone(&self.scenario);
        let prepared = self.prepared.clone();
        let (values, rules) = (self.values.clone(), self.rules);
        let (prepared, solved) = worker::run(watch, move |watch| {
            let (prepared, redone) = match prepared {
                Some(prepared) => match prepared.renewed(&scenario, &values, watch)? {
                    Some((renewed, redone)) => (Arc::new(renewed), redone),
                    None => (prepared, Redone::Lcp),
                },
                None => (Arc::new(solve::prepare_at(&scenario, &values, watch)?), Redone::Stiffness),
            };
            let case = prepared.case(&scenario, &values).under(rules).watched(watch);
            let solved = match last.filter(|_| redone < Redone::Stiffness) {
                Some(last) => case.solve_from(&last),
                None => case.solve(),
            };
            let mut solved = solved.map_err(|error| {
                if error.is_interrupted() { CommandError::Interrupted } else { CommandError::Solve(error.to_string()) }
            })?;
            solved.answer.redone = redone;
            Ok::<_, CommandError>((prepared, Arc::new(solved)))
        })??;
        self.prepared = Some(prepared);
        Ok(solved)
    }

    fn same_choice(&self, other: &Setup) -> bool {
        Arc::ptr_eq(&self.scenario, &other.scenario)
            && self.rules == other.rules
            && self.values.len() == other.values.len()
            && self.values.iter().zip(&other.values).all(|((a, x), (b, y))| a == b && x.to_bits() == y.to_bits())
    }
}

/// The status of a `solve` (see the help).
pub fn exit_status(answer: &Answer) -> u8 {
    match answer.outcome {
        OutcomeKind::Trivial | OutcomeKind::Normal => 0,
        OutcomeKind::Ray => match answer.ray.as_ref().map(|ray| ray.class) {
            Some(RayClass::Mechanism | RayClass::NoEquilibrium) => 3,
            Some(RayClass::Artefact | RayClass::Fault) | None => 4,
        },
        OutcomeKind::PivotLimit | OutcomeKind::Breakdown | OutcomeKind::CheckFailed => 4,
    }
}
