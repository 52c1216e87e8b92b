//! Help: the overview by groups and the page of each command, both made from the table of commands.

use crate::session::commands::GROUPS;
use crate::session::commands::ray::RAY;
use crate::session::language::error::GrammarError;
use crate::session::language::grammar::resolve;
use crate::session::language::topics::{self, TOPICS};
use crate::session::{CommandError, Output, Session};
use crate::view::style::Style;

/// The overview of all commands, by group.
pub fn overview(style: &Style) -> String {
    let mut text = String::new();
    let mut add = |label: &str, words: &str| {
        for line in style.hanging(label, words) {
            text.push_str(line.trim_end());
            text.push('\n');
        }
    };
    add("", "One command a line; `;` separates, `#` begins a comment, unique prefixes work.");
    for (group, commands) in GROUPS {
        add("", "");
        add("", group);
        for command in *commands {
            add(&format!("  {:<14} ", command.name), &command.about());
        }
    }
    add("", "");
    add("", "topics");
    for topic in TOPICS {
        add(&format!("  {:<14} ", topic.name), topic.about);
    }
    add("  ray            ", "also how to find out what a ray means, step by step");
    add("", "");
    add("", "`help COMMAND` says more, with an example.");
    text
}

/// The help of one command, wrapped at `width` columns.
///
/// # Errors
/// Unknown or ambiguous name.
pub fn help(word: &str, width: usize) -> Result<String, GrammarError> {
    let text = resolve(word)?.grammar().term_width(width).render_long_help().to_string();
    let mut lines: Vec<&str> = Vec::new();
    for line in text.lines().map(str::trim_end) {
        let blank = line.is_empty() && lines.last().is_some_and(|last| last.is_empty());
        if !blank {
            lines.push(line);
        }
    }
    Ok(lines.join("\n").trim_end().to_owned() + "\n")
}

impl Session {
    /// `help`: all commands, one of them, or a topic; `help ray` with the steps for the present problem. It stands with
    /// the table, which the commands themselves do not know.
    pub(in crate::session) fn show_help(&self, word: Option<&str>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let text = match word {
            None => overview(&io.style),
            Some(word) => match topics::find(word) {
                Some(topic) => topic.text(&io.style),
                None => {
                    let text = help(word, io.style.width)?;
                    let is_ray = resolve(word).is_ok_and(|command| command.name == RAY.name);
                    if is_ray { format!("{text}\n{}", self.ray_guide(&io.style)) } else { text }
                }
            },
        };
        io.show(&text, |out, style| {
            for line in text.lines() {
                writeln!(out, "{}", style.text(line))?;
            }
            Ok(())
        })?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::session::commands;
    use crate::session::language::grammar::parse;
    use crate::session::language::tokens;

    #[test]
    fn every_command_has_an_example_that_can_be_read() {
        for command in commands::all() {
            let grammar = command.grammar();
            let example = grammar.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(example.starts_with("Example:\n"), "{}", command.name);
            assert!(!command.about().is_empty(), "{}", command.name);
            for line in example.lines().skip(1) {
                for one in tokens::commands(line) {
                    assert!(parse(one).unwrap().is_some(), "{one}");
                }
            }
        }
    }

    #[test]
    fn no_two_commands_have_one_name() {
        let mut names: Vec<&str> = commands::all().flat_map(|c| [Some(c.name), c.alias]).flatten().collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
