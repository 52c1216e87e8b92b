//! What a session writes into its journal, and `restore`: the changes of one that ended without `quit`, brought back.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use clap::{Args, ValueEnum};

use crate::model::embedded;
use crate::text::file::reason;
use crate::text::hash::Hash;

use crate::session::journal::{Chosen, Record};
use crate::session::language::command::{Action, Command, Recorded};
use crate::session::language::setting::{RULES, SetError};
use crate::session::{Change, CommandError, Next, Output, Session, Setup, load, places};

/// The word of `restore discard`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Discard {
    /// Forget the changes
    Discard,
}

/// Bring back the changes of a session in this directory that ended without `quit`
///
/// Values and rules are as they were after its last change, `undo` goes back through them; nothing is run again and
/// no file is written.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  restore\n  restore discard")]
pub struct Restore {
    /// Forget those changes instead
    #[arg(value_name = "DISCARD")]
    discard: Option<Discard>,
}

pub const RESTORE: Command = Command { recorded: Recorded::State, ..Command::of::<Restore>("restore") };

impl Action for Restore {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.restore(self.discard.is_some(), io)?;
        Ok(Next::Continue)
    }
}

impl Setup {
    /// As it is written into the journal.
    fn chosen(&self) -> Chosen {
        Chosen {
            scenario: self.scenario.name.clone(),
            file: self.scenario.path.is_some(),
            text: Hash::of(&self.scenario.text).long(),
            values: self.values.free().map(|(name, value)| (name.clone(), value)).collect(),
            rules: RULES.iter().map(|rule| (rule.shown)(&self.rules)).collect(),
        }
    }
}

impl Chosen {
    /// The scenario as it is given, and whether that is a file.
    fn key(&self) -> (String, bool) {
        (self.scenario.clone(), self.file)
    }
}

/// The scenarios of a journal, each loaded once.
struct Scenarios {
    loaded: HashMap<(String, bool), Setup>,
    /// Of each the hash of the text that it had last.
    last: HashMap<(String, bool), String>,
}

impl Scenarios {
    /// Those of some records, before a state that they end in.
    fn of(records: &[Record], now: &State) -> Scenarios {
        let recorded = records.iter().filter_map(|record| match record {
            Record::Start(chosen) | Record::Change(_, chosen) | Record::Saved(chosen) => Some(chosen),
            Record::Undo | Record::Redo | Record::Auto(_) => None,
        });
        let end = match now {
            State::Written(chosen) => Some(chosen),
            State::Here(_) => None,
        };
        let last = recorded.chain(end).map(|chosen| (chosen.key(), chosen.text.clone())).collect();
        Scenarios { loaded: HashMap::new(), last }
    }

    /// Whether what was chosen belongs to another text of its scenario, from before that was read again: a journal keeps no
    /// texts.
    fn is_lost(&self, chosen: &Chosen) -> bool {
        let key = chosen.key();
        let is_there =
            || self.loaded.get(&key).is_some_and(|setup| Hash::of(&setup.scenario.text).long() == chosen.text);
        self.last.get(&key).is_some_and(|last| *last != chosen.text) && !is_there()
    }

    /// What was chosen, on the scenario as it is now.
    fn setup(&mut self, chosen: &Chosen, io: &Output<'_>) -> Result<Setup, CommandError> {
        let key = chosen.key();
        let mut setup = match self.loaded.get(&key) {
            Some(setup) => setup.clone(),
            None => {
                let scenario = match chosen.file {
                    true => load::file(Path::new(&chosen.scenario), io.watch)?,
                    false => embedded::load(&chosen.scenario).map_err(CommandError::Scenario)?,
                };
                let setup = Setup::of(scenario);
                self.loaded.insert(key, setup.clone());
                setup
            }
        };
        let mut refusal = None;
        for (name, value) in &chosen.values {
            if !setup.values.contains_key(name) {
                refusal = Some(format!("there is no parameter `{name}` any more"));
            } else if setup.values.formula(name).is_some() {
                refusal = Some(format!("`{name}` is a formula now"));
            } else {
                setup.values.insert(name.clone(), *value);
            }
        }
        if let Some(refusal) = refusal.or_else(|| setup.scenario.law_refusal(&setup.values)) {
            return Err(CommandError::Refused(format!(
                "{} has changed so that what was set before does not fit it: {refusal}; bring the file back, or \
                 `restore discard`",
                chosen.scenario
            )));
        }
        for (rule, choice) in RULES.iter().zip(&chosen.rules) {
            (rule.set)(&mut setup.rules, choice).map_err(SetError::Choice)?;
        }
        Ok(setup)
    }
}

/// A state while a session is rebuilt: one of this session, or one that is only written down.
#[derive(Clone)]
enum State {
    Here(Box<Setup>),
    Written(Chosen),
}

impl State {
    fn setup(self, scenarios: &mut Scenarios, io: &Output<'_>) -> Result<Setup, CommandError> {
        match self {
            State::Here(setup) => Ok(*setup),
            State::Written(chosen) => scenarios.setup(&chosen, io),
        }
    }
}

/// A session being rebuilt from records.
struct Rebuilt {
    now: State,
    undo: Vec<(String, State)>,
    redo: Vec<(String, State)>,
    auto: bool,
}

impl Rebuilt {
    fn of(session: &Session) -> Self {
        let states = |changes: &[Change]| {
            changes.iter().map(|change| (change.command.clone(), State::Here(Box::new(change.setup.clone())))).collect()
        };
        Rebuilt {
            now: State::Here(Box::new(session.now.clone())),
            undo: states(&session.undo),
            redo: states(&session.redo),
            auto: session.auto,
        }
    }

    fn take(&mut self, record: Record) {
        match record {
            Record::Start(chosen) => self.take(Record::Change(load_command(&chosen), chosen)),
            Record::Change(command, chosen) => {
                let before = std::mem::replace(&mut self.now, State::Written(chosen));
                self.undo.push((command, before));
                self.redo.clear();
            }
            Record::Saved(chosen) => {
                let before = std::mem::replace(&mut self.now, State::Written(chosen.clone()));
                let key = match before {
                    State::Written(before) => Some(before.key()),
                    State::Here(_) => None,
                };
                for (_, state) in self.undo.iter_mut().chain(&mut self.redo) {
                    let State::Written(state) = state else { continue };
                    // What was in a file that is written over is values of that from now on.
                    if Some(state.key()) == key || state.key() == chosen.key() {
                        (state.scenario, state.file) = chosen.key();
                        state.text.clone_from(&chosen.text);
                    }
                }
            }
            Record::Undo => turn(&mut self.now, &mut self.undo, &mut self.redo),
            Record::Redo => turn(&mut self.now, &mut self.redo, &mut self.undo),
            Record::Auto(auto) => self.auto = auto,
        }
    }
}

fn turn(now: &mut State, from: &mut Vec<(String, State)>, to: &mut Vec<(String, State)>) {
    if let Some((command, state)) = from.pop() {
        to.push((command, std::mem::replace(now, state)));
    }
}

fn load_command(chosen: &Chosen) -> String {
    format!("load {}", crate::session::language::tokens::quote(&chosen.scenario))
}

impl Session {
    /// Writes a change into the journal; gives a note where that cannot be done: the change itself is done.
    pub(in crate::session) fn note_in_journal(
        &mut self,
        before: &Setup,
        record: impl FnOnce(Chosen) -> Record,
    ) -> Option<String> {
        let journal = self.journal.as_mut()?;
        let written = journal.append(|| before.chosen(), &[record(self.now.chosen())]);
        written.err().map(|error| not_kept(&error))
    }

    /// Brings back what an earlier session left behind. Nothing is run: each record says all values and rules.
    pub(in crate::session) fn restore(&mut self, discard: bool, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(left) = self.left_over.take() else {
            return Err(CommandError::Refused(
                "nothing to restore: no session in this directory ended without `quit`".into(),
            ));
        };
        let changes = left.changes();
        let s = if changes == 1 { "" } else { "s" };
        if discard {
            left.discard().map_err(|source| CommandError::File {
                doing: "remove the journal in",
                path: places::state().unwrap_or_default(),
                source,
            })?;
            return Ok(io.say(&format!("{changes} change{s} forgotten"))?);
        }
        let before = self.now.clone();
        let notes = match self.rebuild(&left.records, io) {
            Ok(notes) => notes,
            Err(error) => {
                self.left_over = Some(left);
                return Err(error);
            }
        };
        let records: Vec<Record> = left
            .records
            .iter()
            .map(|record| match record.clone() {
                Record::Start(chosen) => Record::Change(load_command(&chosen), chosen),
                other => other,
            })
            .collect();
        let kept = self.journal.as_mut().map_or(Ok(()), |journal| journal.append(|| before.chosen(), &records));
        let mut said = vec![format!("{changes} change{s} restored")];
        said.extend(notes);
        match kept {
            // the new journal holds everything: a file that stays behind is only offered once more
            Ok(()) => drop(left.discard()),
            Err(error) => said.push(not_kept(&error)),
        }
        self.say_what_changed(&said, io)
    }

    /// Takes the records over, with an answer, or leaves everything as it was.
    fn rebuild(&mut self, records: &[Record], io: &Output<'_>) -> Result<Vec<String>, CommandError> {
        let mut rebuilt = Rebuilt::of(self);
        records.iter().cloned().for_each(|record| rebuilt.take(record));
        let mut scenarios = Scenarios::of(records, &rebuilt.now);
        let written = match &rebuilt.now {
            State::Written(chosen) => Some(chosen.text.clone()),
            State::Here(_) => None,
        };
        let mut now = rebuilt.now.setup(&mut scenarios, io)?;
        let solved = if rebuilt.auto { Some(now.solve(io.watch)?) } else { None };
        let mut notes = Vec::new();
        let mut changes = |states: Vec<(String, State)>, done: &str| -> Result<Vec<Change>, CommandError> {
            let mut changes = Vec::new();
            // from the last one back: a state that can no longer be made ends the way
            for (command, state) in states.into_iter().rev() {
                if let State::Written(chosen) = &state
                    && scenarios.is_lost(chosen)
                {
                    notes.push(format!("`{command}` cannot be {done}: what {} held then is not kept", chosen.scenario));
                    break;
                }
                match state.setup(&mut scenarios, io) {
                    Ok(mut setup) => {
                        if Arc::ptr_eq(&setup.scenario, &now.scenario) {
                            setup.prepared.clone_from(&now.prepared);
                        }
                        changes.push(Change { command, setup });
                    }
                    Err(error) if error.is_interrupted() => return Err(error),
                    Err(_) => break,
                }
            }
            changes.reverse();
            Ok(changes)
        };
        let (undo, redo) = (changes(rebuilt.undo, "undone")?, changes(rebuilt.redo, "done again")?);
        let changed = written.is_some_and(|text| text != Hash::of(&now.scenario.text).long());
        (self.now, self.undo, self.redo, self.auto) = (now, undo, redo, rebuilt.auto);
        self.take_answer(solved);
        self.previous = None;
        self.path = None;
        let name = &self.now.scenario.name;
        let note =
            format!("{name} is not as it was: the values and rules are those of before, the rest is as it is now");
        if changed {
            notes.insert(0, note);
        }
        Ok(notes)
    }
}

fn not_kept(error: &std::io::Error) -> String {
    let folder = places::state().unwrap_or_default();
    format!("a crash would lose this change: the journal in {} cannot be written: {}", folder.display(), reason(error))
}
