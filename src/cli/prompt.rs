//! The commands of the prompt, where the shell is asked for them: their help, and how to give them.

use std::ffi::OsString;
use std::io::Write;
use std::path::Path;

use clap::{CommandFactory, Parser};

use super::Cli;
use super::ending::Failure;
use super::look::Look;
use crate::model::embedded;
use crate::model::words::did_you_mean_typed;
use crate::session::language::grammar::exact;
use crate::session::language::help;
use crate::text::printable;
use crate::view::style::Style;

/// The word of `stickslip help WORD` or `stickslip WORD --help`, where that is not a command of the shell, and how its help is
/// to look.
pub fn asked_help(arguments: &[OsString]) -> Option<(String, Look)> {
    let (program, rest) = arguments.split_first()?;
    let (first, rest) = rest.split_first()?;
    let is_word = |word: &&OsString| word.to_str().is_some_and(|word| !word.starts_with('-'));
    let (word, options) = if first == "help" {
        // options stand on one side of the word
        match rest.split_first()? {
            (word, options) if is_word(&word) => (word.to_str()?, options),
            _ => {
                let (word, options) = rest.split_last().filter(|(word, _)| is_word(word))?;
                (word.to_str()?, options)
            }
        }
    } else {
        let (help, options) = rest.split_last()?;
        let word = exact(first.to_str()?).filter(|_| help == "--help" || help == "-h")?;
        (word.name, options)
    };
    let look = Cli::try_parse_from(std::iter::once(program).chain(options)).ok()?;
    (!is_of_the_shell(word) && look.command.is_none()).then(|| (word.to_owned(), look.look))
}

fn is_of_the_shell(word: &str) -> bool {
    word == "help" || Cli::command().find_subcommand(word).is_some()
}

/// Writes what the prompt says of a command, a topic or a quantity.
///
/// # Errors
/// A word that is none of these.
pub fn write_help(word: &str, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let unknown = |error| Failure::Status(2, format!("{error}; `stickslip --help` lists those of the shell"));
    let text = help::page(word, style).map_err(unknown)?;
    for line in text.lines() {
        writeln!(out, "{}", style.text(line))?;
    }
    Ok(0)
}

/// What to do where the first word is a command of the prompt, or no command and no scenario though words follow it; `None`
/// anywhere else.
pub fn hint(arguments: &[OsString]) -> Option<String> {
    let first = printable::line(&arguments.get(1)?.to_string_lossy());
    if arguments.iter().any(|word| word == "--json") && is_of_the_shell(&first) {
        return Some("`--json` is no option: `--format json` is, of solve, replay, sweep and check".to_owned());
    }
    hint_of(&first).or_else(|| {
        let second = arguments.get(2).map(|word| printable::line(&word.to_string_lossy()))?;
        if first.starts_with('-') || second.starts_with('-') || is_of_the_shell(&first) {
            return None;
        }
        if embedded::text(&first).is_some() || Path::new(&arguments[1]).exists() {
            return Some(format!("`{second}` after the scenario `{first}`: one scenario is opened at a time"));
        }
        let grammar = Cli::command();
        let near = did_you_mean_typed(&first, grammar.get_subcommands().map(clap::Command::get_name));
        Some(format!("unknown command `{first}`{near}; `stickslip --help` lists them"))
    })
}

/// How to give a command of the prompt; `None` of any other word.
pub fn hint_of(word: &str) -> Option<String> {
    let line = exact(word).filter(|command| !is_of_the_shell(command.name))?.name;
    Some(format!(
        "`{line}` is a command of the prompt: `stickslip SCENARIO`, then `{line} …`, or `echo '{line} …' | stickslip \
         SCENARIO`; `stickslip help {line}` says more"
    ))
}
