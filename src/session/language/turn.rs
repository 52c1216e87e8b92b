//! Whose turn it is: the commands of a text one after the other, and whether one of them may fail.

use crate::session::CommandError;
use crate::session::language::{grammar, tokens};

/// A command, and what stands around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Turn<'a> {
    /// Number of its line in the text, from 1.
    pub line: usize,
    /// As typed, without its comment.
    pub command: &'a str,
    /// Whether the command after it is `expect error`.
    pub may_fail: bool,
}

impl<'a> Turn<'a> {
    /// The commands of a line.
    pub fn of_line(line: &'a str) -> Vec<Turn<'a>> {
        let commands = tokens::commands(line).into_iter();
        in_turn(commands.map(|command| Turn { line: 1, command, may_fail: false }).collect())
    }

    /// The commands of all lines of a text.
    pub fn of_text(text: &'a str) -> Vec<Turn<'a>> {
        let lines = text.lines().zip(1..);
        let commands =
            lines.flat_map(|(text, line)| tokens::commands(text).into_iter().map(move |command| (line, command)));
        in_turn(commands.map(|(line, command)| Turn { line, command, may_fail: false }).collect())
    }

    /// Whether the text goes on after this failure of the command.
    pub fn forgives(&self, error: &CommandError) -> bool {
        self.may_fail && !error.is_output() && !error.is_interrupted()
    }
}

fn in_turn(mut turns: Vec<Turn<'_>>) -> Vec<Turn<'_>> {
    for index in 1..turns.len() {
        turns[index - 1].may_fail = asks_for_failure(turns[index].command);
    }
    turns
}

/// Whether a command is `expect error …`: then the one before it may fail.
pub fn asks_for_failure(command: &str) -> bool {
    grammar::parse(command).ok().flatten().is_some_and(|parsed| parsed.action.expects_error())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_may_fail_where_the_next_expects_it() {
        let text = "set f 1; set f 2 # ; expect error\n\nexpe error \"no\"; pairs\n";
        let turns: Vec<(usize, &str, bool)> =
            Turn::of_text(text).iter().map(|turn| (turn.line, turn.command, turn.may_fail)).collect();
        let expected =
            [(1, "set f 1", false), (1, "set f 2", true), (3, "expe error \"no\"", false), (3, "pairs", false)];
        assert_eq!(turns, expected);
        assert_eq!(Turn::of_line("a;expect error")[0], Turn { line: 1, command: "a", may_fail: true });
        assert!(Turn::of_text("# nothing\n").is_empty());
    }
}
