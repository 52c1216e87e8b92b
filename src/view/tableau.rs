//! The dictionary of a small problem.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::rounding::denoised;
use crate::explain::tableau::Dictionary;

/// Writes basic = value + Σ rate·nonbasic row by row, and what comes next.
pub fn write(out: &mut dyn Write, dictionary: &Dictionary, style: &Style) -> io::Result<()> {
    let at = match dictionary.step {
        None => "before the entry of p".to_owned(),
        Some(step) => format!("after {}", super::pivots::title(step)),
    };
    writeln!(out, "{}", style.text(&format!("dictionary {at}: basic = value + rates · nonbasic")))?;
    let mut columns = vec![Column::words("basic"), Column::numbers("value", None).clean()];
    // The last ones go on beneath first.
    columns.extend(
        dictionary
            .nonbasic
            .iter()
            .enumerate()
            .map(|(k, name)| Column::numbers(name, None).clean().droppable(u8::try_from(k + 1).unwrap_or(u8::MAX))),
    );
    let mut table = Table::new(columns);
    for ((name, value), rates) in dictionary.basic.iter().zip(&dictionary.values).zip(&dictionary.rates) {
        let mut cells = vec![Cell::from(name.as_str()), Cell::number(denoised(*value, 1.0))];
        cells.extend(rates.iter().map(|rate| Cell::number(*rate)));
        table.rows.push(Row::new(cells));
    }
    table.write(out, style)?;
    let next = match (&dictionary.entering, &dictionary.leaving) {
        (Some(entering), Some(leaving)) => format!("next: {entering} enters, {leaving} leaves"),
        _ => "the run ends here".to_owned(),
    };
    writeln!(out, "{}", style.paint(Role::Muted, &style.text(&next)))
}
