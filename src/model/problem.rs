//! What is wrong with a scenario: place, what was found, what was expected, what to do.

use std::fmt;

/// At most this many problems are listed; the rest is counted.
pub const LISTED: usize = 20;

/// One problem of a scenario file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Line, from 1; 0 when the problem has no place in the text (a file that cannot be read).
    pub line: usize,
    /// Column in characters, from 1; 0 without a place.
    pub column: usize,
    /// JSON path, e.g. `contacts[2].friction`; empty for the file as a whole.
    pub path: String,
    /// What was found and what was expected.
    pub message: String,
    /// What to do; may be empty.
    pub help: String,
}

/// All problems found in one pass over a scenario, the first [`LISTED`] of them in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problems {
    /// The name or path of the scenario, as given by the user.
    pub file: String,
    /// The problems, never empty.
    pub problems: Vec<Problem>,
    /// How many more there are.
    pub more: usize,
}

impl Problems {
    /// One problem of the file as a whole, without a place in its text.
    pub fn of_file(file: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Problems {
            file: file.into(),
            problems: vec![Problem {
                line: 0,
                column: 0,
                path: String::new(),
                message: message.into(),
                help: help.into(),
            }],
            more: 0,
        }
    }
}

impl fmt::Display for Problems {
    /// A block per problem: `file:line:column: path: message`, then an indented line with what to do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{}", self.file)?;
            if problem.line > 0 {
                write!(f, ":{}:{}", problem.line, problem.column)?;
            }
            if !problem.path.is_empty() {
                write!(f, ": {}", problem.path)?;
            }
            write!(f, ": {}", problem.message)?;
            if !problem.help.is_empty() {
                write!(f, "\n  help: {}", problem.help)?;
            }
        }
        match self.more {
            0 => Ok(()),
            1 => write!(f, "\nand 1 more problem"),
            more => write!(f, "\nand {more} more problems"),
        }
    }
}

impl std::error::Error for Problems {}
