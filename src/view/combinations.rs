//! Load combinations and their envelope.

use std::io::{self, Write};

use super::scale::ByUnit;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row as TableRow, Table};
use crate::model::quantity::Quantity;
use crate::model::units::Units;
use crate::path::quantity::{NoValue, Value};

/// A combination as it is shown.
pub struct Row {
    /// Its name.
    pub name: String,
    /// The line of its answer.
    pub line: String,
    /// Values of its probes, in their order.
    pub values: Vec<Result<Value, NoValue>>,
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

/// A line for each combination, then the values of the probes: a row for each combination, a column for each probe.
pub fn write(
    out: &mut dyn Write,
    rows: &[Row],
    probes: &[(String, Quantity)],
    notes: &[String],
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    for row in rows {
        writeln!(out, "{}", style.paint(Role::Accent, &style.text(&row.name)))?;
        writeln!(out, "  {}", row.line)?;
    }
    if !probes.is_empty() {
        writeln!(out)?;
        let mut table = Table::new(vec![Column::words("combination")]);
        table.columns.extend(probes.iter().map(|(name, quantity)| match quantity.unit(units) {
            None => Column::plain(name, None),
            unit => Column::numbers(name, unit),
        }));
        for row in rows {
            let mut cells = vec![Cell::new(row.name.clone(), Role::Accent)];
            cells.extend(row.values.iter().map(|value| match value {
                Ok(Value::Number(value)) => Cell::number(*value),
                Ok(Value::Word(word)) => Cell::from(word.as_str()),
                Err(reason) => Cell::new(reason.0.clone(), Role::Muted),
            }));
            table.rows.push(TableRow::new(cells));
        }
        table.write(out, style)?;
    }
    notes.iter().try_for_each(|note| style.paragraph(out, Role::Muted, note))
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
    envelope_table(at, extremes, units, style.ascii).write(out, style)?;
    for note in notes {
        style.paragraph(out, Role::Warning, note)?;
    }
    Ok(())
}

/// The table that is written; values of one unit share their power of ten.
pub fn envelope_table(at: &str, extremes: &[Extreme], units: &Units, ascii: bool) -> Table {
    let mut table = Table::new(vec![
        Column::words("quantity"),
        Column::words("unit"),
        Column::numbers("least", None),
        Column::words(at),
        Column::numbers("largest", None),
        Column::words(at),
    ]);
    let ends = |extreme: &Extreme| [extreme.least.clone(), extreme.largest.clone()];
    let values: Vec<(Option<String>, f64)> = extremes
        .iter()
        .flat_map(|extreme| ends(extreme).into_iter().flatten().map(|(value, _)| (extreme.quantity.unit(units), value)))
        .collect();
    let scales = ByUnit::of(&values);
    for extreme in extremes {
        let unit = extreme.quantity.unit(units);
        let own: Vec<f64> = ends(extreme).into_iter().flatten().map(|(value, _)| value).collect();
        let scale = scales.of_row(&own, unit.as_deref());
        let shown_unit = scale.unit(unit.as_deref(), ascii).unwrap_or_default();
        let mut cells = vec![Cell::from(extreme.quantity.to_string()), Cell::new(shown_unit, Role::Muted)];
        for end in ends(extreme) {
            match end {
                Some((value, name)) => {
                    cells.extend([Cell::from(scale.number(value)), Cell::new(name, Role::Accent)]);
                }
                None => cells.extend([Cell::new("no value", Role::Muted), Cell::from("")]),
            }
        }
        table.rows.push(TableRow::new(cells));
    }
    table
}
