//! Load combinations and their envelope.

use std::io::{self, Write};

use super::number::{short, with_unit};
use super::style::{Role, Style};
use super::table::{Cell, Column, Row as TableRow, Table};
use crate::model::quantity::Quantity;
use crate::model::scenario::Units;

/// A combination as it is shown.
pub struct Row {
    /// Its name.
    pub name: String,
    /// The line of its answer.
    pub line: String,
    /// Its probes.
    pub values: Vec<Line>,
}

/// A named value.
pub struct Line {
    /// Name of the probe.
    pub name: String,
    /// Value with unit, or why there is none.
    pub text: String,
}

/// Least and largest value of a quantity, each with the combination or the place that governs.
pub struct Extreme {
    /// The quantity.
    pub quantity: Quantity,
    /// The least; `None` without any value.
    pub least: Option<(f64, String)>,
    /// The largest.
    pub largest: Option<(f64, String)>,
}

/// A line for each combination, its probes beneath.
pub fn write(out: &mut dyn Write, rows: &[Row], note: Option<&str>, style: &Style) -> io::Result<()> {
    for row in rows {
        writeln!(out, "{}", style.paint(Role::Accent, &style.text(&row.name)))?;
        writeln!(out, "  {}", row.line)?;
        for value in &row.values {
            let line = format!("  {} = {}", value.name, value.text);
            writeln!(out, "{}", style.fit(&style.text(&line), style.width))?;
        }
    }
    match note {
        Some(note) => writeln!(out, "{}", style.paint(Role::Muted, &style.text(note))),
        None => Ok(()),
    }
}

/// A row for each quantity; `at` heads what governs.
pub fn write_envelope(
    out: &mut dyn Write,
    at: &str,
    extremes: &[Extreme],
    notes: &[String],
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let mut table = Table::new(vec![
        Column::words("quantity"),
        Column::words("least"),
        Column::words(at),
        Column::words("largest"),
        Column::words(at),
    ]);
    for extreme in extremes {
        let unit = extreme.quantity.unit(units);
        let mut cells = vec![Cell::from(extreme.quantity.to_string())];
        for end in [&extreme.least, &extreme.largest] {
            match end {
                Some((value, name)) => {
                    cells.push(Cell::from(with_unit(&short(*value), unit.as_deref())));
                    cells.push(Cell::new(name.clone(), Role::Accent));
                }
                None => cells.extend([Cell::new("no value", Role::Muted), Cell::from("")]),
            }
        }
        table.rows.push(TableRow::new(cells));
    }
    table.write(out, style)?;
    for note in notes {
        for line in style.wrap(&style.text(note), style.width) {
            writeln!(out, "{}", style.paint(Role::Warning, &line))?;
        }
    }
    Ok(())
}
