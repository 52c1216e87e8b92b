//! Help: the overview by groups and the page of each command, both generated from the grammar.

use crate::view::style::Style;

use crate::session::language::command::{GrammarError, grammar, resolve};

/// The groups of `help`, each with its commands in the order shown; every command stands in one of them.
pub const GROUPS: &[(&str, &[&str])] = &[
    ("scenario", &["load", "new", "scenarios", "save", "params", "set", "reset", "undo", "redo", "diff", "import"]),
    (
        "answer",
        &[
            "solve",
            "status",
            "pairs",
            "displacements",
            "members",
            "reactions",
            "show",
            "summary",
            "combine",
            "envelope",
            "check",
        ],
    ),
    ("pivots", &["pivots", "step", "why", "ties", "tableau"]),
    ("trouble", &["ray", "compare", "enumerate", "critical"]),
    ("paths", &["sweep", "trace", "limit", "find", "map", "sensitivity", "stages"]),
    ("pictures", &["plot", "tui"]),
    ("scripts", &["source", "record", "expect", "export", "echo", "restore"]),
    ("help", &["help", "tour", "history", "quit"]),
];

/// The overview of all commands, by group.
pub fn overview(style: &Style) -> String {
    let grammar = grammar();
    let mut text = String::new();
    let mut add = |label: &str, words: &str| {
        for line in style.hanging(label, words) {
            text.push_str(line.trim_end());
            text.push('\n');
        }
    };
    add("", "One command a line; `;` separates, `#` begins a comment, unique prefixes work.");
    for (group, names) in GROUPS {
        add("", "");
        add("", group);
        for name in *names {
            let about = grammar
                .find_subcommand(name)
                .and_then(|command| command.get_about())
                .map(ToString::to_string)
                .unwrap_or_default();
            add(&format!("  {name:<14} "), &about);
        }
    }
    add("", "");
    add("", "`help COMMAND` says more, with an example.");
    text
}

/// The help of one command, wrapped at `width` columns.
///
/// # Errors
/// Unknown or ambiguous name.
pub fn help(word: &str, width: usize) -> Result<String, GrammarError> {
    let name = resolve(word)?;
    let mut grammar = grammar().term_width(width);
    grammar.build();
    // `resolve` gave the name of an existing subcommand.
    let Some(command) = grammar.find_subcommand_mut(&name) else {
        return Err(GrammarError::Unknown { word: name, near: Vec::new() });
    };
    let text = command.clone().term_width(width).render_long_help().to_string();
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines().map(str::trim_end) {
        let blank = line.is_empty() && lines.last().is_some_and(String::is_empty);
        if !blank && !line.trim_start().starts_with("-h, --help") {
            // the grammar has no program name, which leaves a hole
            lines.push(line.replace("Usage:  ", "Usage: "));
        }
    }
    Ok(lines.join("\n").trim_end().to_owned() + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::language::command::parse;
    use crate::session::language::tokens;

    #[test]
    fn every_command_stands_in_one_group_and_has_an_example() {
        let grammar = grammar();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        let mut known: Vec<&str> = grammar.get_subcommands().map(|c| c.get_name()).collect();
        grouped.sort_unstable();
        known.sort_unstable();
        assert_eq!(grouped, known);
        for command in grammar.get_subcommands() {
            let example = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(example.starts_with("Example:\n"), "{}", command.get_name());
            for line in example.lines().skip(1) {
                for one in tokens::commands(line) {
                    assert!(parse(one).unwrap().is_some(), "{one}");
                }
            }
        }
    }
}
