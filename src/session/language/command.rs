//! What a command is. Each is described once, in its file under `session/commands`: its name, its arguments with their
//! help and an example (by clap), what may be typed next, and what it does. `commands::GROUPS` lists them all; the
//! parser, help, completion and hints are made from that table.

use std::fmt;

use clap::{ArgMatches, Args};

use crate::session::language::candidates::{Asked, Candidate};
use crate::session::{CommandError, Next, Output, Session};

/// A command whose words are read, ready to run.
pub trait Action {
    /// Does it; `text` is the command as typed.
    ///
    /// # Errors
    /// [`CommandError`]; the session then is as it was.
    fn run(&self, session: &mut Session, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError>;

    /// Whether it looks at the pivots or the final scheme of the run, which a warm start does not have.
    fn needs_pivots(&self) -> bool {
        false
    }

    /// Whether it puts another scenario in the place of the present one.
    fn loads(&self) -> bool {
        false
    }

    /// Whether it means the load cases with the factors that the scenario gives, also where a combination is shown.
    fn is_of_own_factors(&self, _: &Session) -> bool {
        false
    }

    /// Whether the command before it may fail.
    fn expects_error(&self) -> bool {
        false
    }
}

/// What `record` writes of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    /// The command, with what it showed.
    Text,
    /// The commands that lead to the state after it: nothing else could bring that back.
    State,
    /// Nothing.
    Nothing,
}

/// An entry of the table of commands.
pub struct Command {
    /// As typed.
    pub name: &'static str,
    /// Another name.
    pub alias: Option<&'static str>,
    /// Whether 0.1 had it: a prefix that was unique there keeps its meaning.
    pub in_0_1: bool,
    /// Its arguments as hints show them, where their names in the grammar say too little.
    pub usage: Option<&'static str>,
    /// What may stand at a place among its arguments, besides options and closed lists of words.
    pub complete: fn(&Asked<'_>) -> Vec<Candidate>,
    /// What is offered in grey at a place where nothing is typed yet.
    pub offer: fn(&Asked<'_>) -> Option<String>,
    /// Changes its words before clap sees them.
    pub prepare: fn(&mut [String]),
    /// Whether it takes any words as they are, `--help` too.
    pub verbatim: bool,
    /// Whether it may run where a `load` before it failed.
    pub without_scenario: bool,
    /// Whether the message of the command before stays what `expect error` tests.
    pub keeps_error: bool,
    /// What `record` writes of it.
    pub recorded: Recorded,
    /// Adds its arguments and help to a command of clap.
    pub(in crate::session) arguments: fn(clap::Command) -> clap::Command,
    /// What it does with the words that clap matched.
    pub(in crate::session) read: fn(&ArgMatches) -> Result<Box<dyn Action>, clap::Error>,
}

impl Command {
    /// A command with the arguments, the help and the doing of `A`. The other fields are those of most commands.
    pub const fn of<A: Args + Action + 'static>(name: &'static str) -> Self {
        Command {
            name,
            alias: None,
            in_0_1: true,
            usage: None,
            complete: |_| Vec::new(),
            offer: |_| None,
            prepare: |_| (),
            verbatim: false,
            without_scenario: false,
            keeps_error: false,
            recorded: Recorded::Text,
            arguments: A::augment_args,
            read: |matches| Ok(Box::new(A::from_arg_matches(matches)?)),
        }
    }

    /// Its arguments and help, as clap holds them.
    pub fn grammar(&self) -> clap::Command {
        (self.arguments)(clap::Command::new(self.name))
            .no_binary_name(true)
            .disable_help_flag(true)
            .help_template("{about-with-newline}\nUsage: {usage}\n\n{all-args}{after-help}\n")
    }

    /// What it is, in a line.
    pub fn about(&self) -> String {
        self.grammar().get_about().map(ToString::to_string).unwrap_or_default()
    }

    /// The words after its name, read.
    ///
    /// # Errors
    /// Clap's.
    pub fn read(&self, words: &[String]) -> Result<Box<dyn Action>, clap::Error> {
        (self.read)(&self.grammar().try_get_matches_from(words)?)
    }
}

impl fmt::Debug for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// A command as typed: which one, and its words read.
pub struct Parsed {
    /// Its entry in the table.
    pub command: &'static Command,
    /// What it does.
    pub action: Box<dyn Action>,
}
