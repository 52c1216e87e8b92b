//! The rows of a sweep as a table.

use std::io::{self, Write};

use serde_json::Value;

use super::style::Style;
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit};
use crate::model::units::Units;
use crate::path::sweep::CHECKSUM;

/// Columns that go first where the table is too wide.
const LESS: [&str; 7] = ["failure", "max_x_n_pair", "max_x_n", "max_gap_pair", "max_gap", "closed", "class"];

/// Unit of a column that every sweep of contact pairs has.
pub fn unit_of(column: &str, units: &Units) -> Option<String> {
    match column {
        "p" | "max_x_n" => force_unit(units),
        "max_slip" | "max_gap" => length_unit(units),
        _ => None,
    }
}

/// Writes the columns that hold anything, each with its unit; the first `axes` of them are the parameters. The checksum
/// is for files.
pub fn write(
    out: &mut dyn Write,
    columns: &[(String, Option<String>)],
    rows: &[Vec<Value>],
    axes: usize,
    style: &Style,
) -> io::Result<()> {
    let holds = |k: usize| rows.iter().any(|row| !matches!(&row[k], Value::Null) && row[k] != 0 && row[k] != 0.0);
    // the place of a largest value that is 0 everywhere says nothing
    let of_nothing = |name: &str| {
        name.strip_suffix("_pair")
            .is_some_and(|of| columns.iter().position(|(known, _)| known == of).is_some_and(|k| !holds(k)))
    };
    let is_shown = |k: usize| columns[k].0 != CHECKSUM && holds(k) && !of_nothing(&columns[k].0);
    let used: Vec<usize> = (0..columns.len()).filter(|&k| k < axes || is_shown(k)).collect();
    let is_words = |k: usize| rows.iter().any(|row| row[k].is_string());
    let is_count = |k: usize| rows.iter().all(|row| row[k].is_u64() || row[k].is_null());
    let mut table = Table::new(
        used.iter()
            .map(|&k| {
                let (name, unit) = &columns[k];
                let rank = LESS.iter().position(|less| less == name).map_or(0, |at| (LESS.len() - at) as u8);
                let column = if is_words(k) {
                    Column::words(name)
                } else if k < axes {
                    Column::given(name, unit.clone())
                } else if is_count(k) {
                    Column::count(name)
                } else {
                    Column::numbers(name, unit.clone())
                };
                if k < axes { column } else { column.droppable(rank) }
            })
            .collect(),
    );
    for row in rows {
        let cells = used.iter().map(|&k| match &row[k] {
            Value::Null => Cell::from(""),
            Value::String(text) => Cell::from(style.text(text)),
            Value::Number(number) if k >= axes && is_count(k) => Cell::from(number.to_string()),
            other => Cell::number(other.as_f64().unwrap_or(f64::NAN)),
        });
        table.rows.push(Row::new(cells.collect()));
    }
    table.write(out, style)
}
