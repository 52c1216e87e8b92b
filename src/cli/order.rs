//! Options may stand before the command: they are put after it, where the grammar has them.

use std::ffi::OsString;

use clap::Command;

/// Whether an option of this name has a value, by any command that knows it; `None` if none does.
fn takes_value(grammar: &Command, long: &str) -> Option<bool> {
    let commands = std::iter::once(grammar).chain(grammar.get_subcommands());
    commands
        .flat_map(Command::get_arguments)
        .find(|argument| argument.get_long() == Some(long))
        .map(|argument| argument.get_action().takes_values())
}

/// The arguments with the options ahead of the command moved after it. Where no command follows them, or one of them is
/// unknown, everything stays as it is. Clap's own `help` takes no options: `help --help` becomes `help help`.
pub fn command_first(grammar: &Command, mut arguments: Vec<OsString>) -> Vec<OsString> {
    if let [_, word, option] = &mut arguments[..]
        && word == "help"
        && (option == "--help" || option == "-h")
    {
        *option = "help".into();
    }
    let mut at = 1;
    while let Some(word) = arguments.get(at).and_then(|word| word.to_str()) {
        let Some(option) = word.strip_prefix("--") else { break };
        let (name, value) = option.split_once('=').map_or((option, None), |(name, value)| (name, Some(value)));
        match takes_value(grammar, name) {
            Some(true) if value.is_none() => at += 2,
            Some(_) => at += 1,
            None => return arguments,
        }
    }
    let is_command = |word: &OsString| word.to_str().is_some_and(|word| grammar.find_subcommand(word).is_some());
    if at == 1 || !arguments.get(at).is_some_and(is_command) {
        return arguments;
    }
    let mut ordered = arguments;
    ordered[1..=at].rotate_right(1);
    ordered
}
