//! Rules compared: covering × tie-break × engine.

use std::io::{self, Write};

use super::number::{denoised, engineering};
use super::status::{class_word, outcome_word};
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::solve::compare::{Compared, Comparison};

/// Letter of an answer: A, B … Z, then its number.
fn letter(index: usize) -> String {
    u8::try_from(index)
        .ok()
        .filter(|k| *k < 26)
        .map_or_else(|| (index + 1).to_string(), |k| char::from(b'A' + k).to_string())
}

fn outcome(row: &Compared) -> (String, Role) {
    match (row.outcome, row.class) {
        (None, _) => ("does not fit: f = 0".to_owned(), Role::Muted),
        (Some(_), _) if row.cycled => ("cycles".to_owned(), Role::Bad),
        (Some(outcome), Some(class)) => {
            (format!("{}: {}", outcome_word(outcome), class_word(class)), Role::of_outcome(outcome))
        }
        (Some(outcome), None) => (outcome_word(outcome).to_owned(), Role::of_outcome(outcome)),
    }
}

/// Writes the table and a line that sums it up.
pub fn write(out: &mut dyn Write, comparison: &Comparison, style: &Style) -> io::Result<()> {
    let mut table = Table::new(vec![
        Column::words("covering"),
        Column::words("tie-break"),
        Column::words("engine"),
        Column::words("outcome"),
        Column::count("pivots"),
        Column::numbers("p", None).droppable(1),
        Column::words("answer"),
    ]);
    for row in &comparison.rows {
        let (text, role) = outcome(row);
        let ran = row.outcome.is_some();
        table.rows.push(Row::new(vec![
            Cell::from(row.covering.as_str()),
            Cell::from(row.tie_break.as_str()),
            Cell::from(row.engine.as_str()),
            Cell::new(text, role),
            Cell::from(if ran { row.pivots.to_string() } else { String::new() }),
            Cell::from(if ran { engineering(denoised(row.p, 1.0)) } else { String::new() }),
            Cell::from(row.answer.map_or(String::new(), letter)),
        ]));
    }
    table.write(out, style)?;
    let found = comparison.rows.iter().filter(|row| row.answer.is_some()).count();
    let ran = comparison.rows.iter().filter(|row| row.outcome.is_some()).count();
    let cycled = comparison.rows.iter().filter(|row| row.cycled).count();
    let answers = match comparison.answers {
        0 => "none found an answer".to_owned(),
        1 if found == ran => "all found the same answer".to_owned(),
        1 => format!("{found} of {ran} found an answer, all the same one"),
        n => format!("{found} of {ran} found an answer, {n} different ones"),
    };
    let cycles = match cycled {
        0 => String::new(),
        n => format!("; {n} came back to a working scheme they had met (a cycle)"),
    };
    let text = format!("{answers}{cycles}");
    for line in style.wrap(&style.text(&text), style.width) {
        writeln!(out, "{line}")?;
    }
    Ok(())
}
