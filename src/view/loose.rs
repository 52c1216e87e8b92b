//! What only contact holds.

use std::io::{self, Write};

use super::style::{Role, Style};

/// Writes one line per loose part; nothing where there are none.
pub fn write(out: &mut dyn Write, sentences: &[String], style: &Style) -> io::Result<()> {
    for sentence in sentences {
        for line in style.hanging("loose: ", &style.text(sentence)) {
            writeln!(out, "{}", style.paint(Role::Muted, &line))?;
        }
    }
    Ok(())
}
