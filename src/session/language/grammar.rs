//! The words of a line → a command, by the table of commands.

use crate::model::quantity;
use crate::model::words::did_you_mean_typed;
use crate::session::commands;
use crate::session::language::command::{Command, Parsed};
use crate::session::language::error::GrammarError;
use crate::session::language::tokens;

/// The command of a name or an alias.
pub fn exact(word: &str) -> Option<&'static Command> {
    commands::all().find(|command| command.name == word || command.alias == Some(word))
}

/// The command of a name, an alias, or a prefix that only one command has.
///
/// # Errors
/// Unknown or ambiguous.
pub fn resolve(word: &str) -> Result<&'static Command, GrammarError> {
    if let Some(command) = exact(word) {
        return Ok(command);
    }
    let fitting: Vec<&Command> =
        commands::all().filter(|command| !word.is_empty() && command.name.starts_with(word)).collect();
    let old: Vec<&Command> = fitting.iter().copied().filter(|command| command.in_0_1).collect();
    match (&fitting[..], &old[..]) {
        // A prefix that was unique in 0.1 keeps its meaning.
        ([one], _) | (_, [one]) => Ok(*one),
        ([], _) => Err(GrammarError::Unknown {
            word: word.to_owned(),
            // a quantity is asked for by its exact word
            near: match quantity::entry(word) {
                Some(entry) => {
                    let show = format!("show {} {}", entry.word, entry.meaning.arguments());
                    format!(" (did you mean `{}`?)", show.trim_end())
                }
                None => did_you_mean_typed(word, commands::all().map(|command| command.name)),
            },
        }),
        _ => Err(GrammarError::Ambiguous {
            word: word.to_owned(),
            candidates: fitting.iter().map(|command| command.name.to_owned()).collect(),
        }),
    }
}

/// Reads one command (no `;`, no comment); `None` for a blank one.
///
/// # Errors
/// [`GrammarError`], with what to write instead.
pub fn parse(text: &str) -> Result<Option<Parsed>, GrammarError> {
    let mut words = tokens::split(text)?;
    if words.is_empty() {
        return Ok(None);
    }
    let command = resolve(&words.remove(0))?;
    (command.prepare)(&mut words);
    if words == ["--help"] && !command.verbatim {
        return parse(&format!("help {}", command.name));
    }
    match command.read(&words) {
        Ok(action) => Ok(Some(Parsed { command, action })),
        Err(_) if words.iter().any(|word| word == "--json") => Err(GrammarError::Arguments(format!(
            "{}: `--json` is no option: `export result FILE.json` writes the answer, and `stickslip replay --format json` tells \
             all commands so",
            command.name
        ))),
        Err(error) => Err(GrammarError::Arguments(one_paragraph(&error, command.name))),
    }
}

/// Clap's message without its `error:`, its layout and its pointer to `--help`.
fn one_paragraph(error: &clap::Error, name: &str) -> String {
    let text = error.render().to_string();
    let mut parts = Vec::new();
    for line in text.lines() {
        let line = line.trim();
        if line.is_empty() || line.starts_with("For more information") {
            continue;
        }
        if line.starts_with("Usage:") {
            break;
        }
        // Clap's own advice for what is no option is to write it behind `--`, which no command here is helped by.
        if line.starts_with("tip: to pass '") {
            continue;
        }
        parts.push(line.trim_start_matches("error: ").trim_start_matches("tip: "));
    }
    format!("{name}: {}; see `help {name}`", parts.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The name of the command of a line, and its words as clap read them.
    fn read(text: &str) -> (&'static str, Vec<String>) {
        let parsed = parse(text).unwrap().unwrap();
        let grammar = parsed.command.grammar();
        let matches = grammar.clone().get_matches_from(&tokens::split(text).unwrap()[1..]);
        let id = grammar.get_positionals().next().map(|argument| argument.get_id().to_string());
        let words = id.and_then(|id| matches.get_raw(&id)).into_iter().flatten();
        (parsed.command.name, words.map(|word| word.to_string_lossy().into_owned()).collect())
    }

    #[test]
    fn clap_accepts_the_grammar() {
        commands::all().for_each(|command| command.grammar().debug_assert());
    }

    #[test]
    fn prefixes_and_typos() {
        let none = Vec::<String>::new();
        assert_eq!(read("piv"), ("pivots", none.clone()));
        assert_eq!(read("exit"), ("quit", none.clone()));
        assert_eq!(read("com"), ("compare", none.clone()));
        assert_eq!(read("comb"), ("combine", none.clone()));
        assert_eq!(read("en"), ("enumerate", none));
        let ambiguous = parse("p").err().unwrap().to_string();
        assert!(ambiguous.contains("pairs, pivots, plot") || ambiguous.contains("params"), "{ambiguous}");
        let typo = parse("piars").err().unwrap().to_string();
        assert!(typo.contains("did you mean `pairs`"), "{typo}");
    }

    #[test]
    fn signs_are_no_options() {
        assert_eq!(read("set F2 -10%").1, ["F2", "-10%"]);
        assert_eq!(read("set F2 -= 10").1, ["F2", "-=", "10"]);
        assert_eq!(read("echo --at -x"), ("echo", vec!["--at".to_owned(), "-x".to_owned()]));
        assert_eq!(read("trace pull to -3").1, ["pull"]);
        assert!(parse("sweep f -1..1 3").is_ok());
    }

    #[test]
    fn every_command_has_its_help() {
        for name in commands::all().map(|command| command.name).filter(|name| *name != "echo") {
            assert_eq!(parse(&format!("{name} --help")).unwrap().unwrap().command.name, "help", "{name}");
        }
        assert_eq!(read("echo --help"), ("echo", vec!["--help".to_owned()]));
    }

    #[test]
    fn wrong_arguments_say_where_help_is() {
        let error = parse("plot sli").err().unwrap().to_string();
        assert!(error.contains("slip") && error.contains("help plot"), "{error}");
        assert!(parse("load").err().unwrap().to_string().contains("help load"));
    }
}
