//! Help: the overview by groups and the page of each command, both made from the table of commands.

use crate::session::commands::GROUPS;
use crate::session::commands::ray::RAY;
use crate::session::language::error::GrammarError;
use crate::session::language::grammar::{exact, resolve};
use crate::session::language::quantities;
use crate::session::language::topics::{self, TOPICS};
use crate::session::{CommandError, Output, Session};
use crate::text::number::{in_full, with_unit};
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
    add("", "One command per line; `;` separates, `#` begins a comment, unique prefixes work.");
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
    add("", "`help WORD` says more: of a command with an example, of a quantity, a parameter or a load case.");
    text
}

/// What there is to say of a word: a topic, a command, a quantity, or both of these.
///
/// # Errors
/// It is none of these, or may be several commands.
pub fn page(word: &str, style: &Style) -> Result<String, GrammarError> {
    if let Some(topic) = topics::find(word) {
        return Ok(topic.text(style));
    }
    match (quantities::about(word, style), exact(word)) {
        (Some(text), None) => Ok(text),
        (Some(text), Some(command)) => Ok(format!("{}\n{text}", help(command.name, style.width)?)),
        (None, _) => help(word, style.width),
    }
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
            Some(word) => match (page(word, &io.style), self.about_name(word)) {
                (Ok(text), _) if resolve(word).is_ok_and(|command| command.name == RAY.name) => {
                    format!("{text}\n{}", self.ray_guide(&io.style))
                }
                (Ok(text), Some(about)) => format!("{text}\n{about}"),
                (Err(_), Some(about)) => about,
                (page, None) => page?,
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

    /// What a parameter or a load case of the scenario is, and what can be done with it.
    fn about_name(&self, word: &str) -> Option<String> {
        if let Some(parameter) = self.now.scenario.parameters.get(word) {
            let value = with_unit(&in_full(self.now.values[word]), parameter.unit.as_deref());
            let about = parameter.about.as_ref().map_or_else(String::new, |about| format!(": {about}"));
            return Some(match &parameter.formula {
                Some(formula) => format!("parameter {word} = {} = {value}{about}; computed, not set\n", formula.text()),
                None => format!(
                    "parameter {word} = {value}{about}\n`set {word} VALUE`, `sweep {word} A..B`, `find {word} A..B where …`\n"
                ),
            });
        }
        let prepared = self.now.prepared.as_ref()?;
        let (_, factor) = prepared.cases.iter().find(|(case, _)| case == word)?;
        let factor = in_full(factor.value(&self.now.values));
        Some(format!(
            "load case {word}, factor {factor}\n`limit {word}`, `trace {word} to F`, `find {word} A..B where …`\n"
        ))
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
