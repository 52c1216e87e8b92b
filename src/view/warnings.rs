//! What is allowed in a scenario but can hardly be meant.

use std::io::{self, Write};

use super::style::Style;
use crate::model::problem::{LISTED, Problem};

/// A block per warning: `warning: file:line:column: path: message`, then what to do; at most [`LISTED`] of them.
pub fn write(out: &mut dyn Write, file: &str, warnings: &[Problem], style: &Style) -> io::Result<()> {
    for Problem { line, column, path, message, help } in warnings.iter().take(LISTED) {
        let text = format!("{file}:{line}:{column}: {path}: {message}");
        for line in style.hanging("warning: ", &style.text(&text)) {
            writeln!(out, "{line}")?;
        }
        for line in style.hanging("  help: ", &style.text(help)) {
            writeln!(out, "{line}")?;
        }
    }
    match warnings.len().saturating_sub(LISTED) {
        0 => Ok(()),
        1 => writeln!(out, "and 1 more warning"),
        more => writeln!(out, "and {more} more warnings"),
    }
}
