//! The rows of a sweep as a table.

use std::io::{self, Write};

use serde_json::Value;

use super::style::Style;
use super::table::{Cell, Column, Row, Table};

/// Columns that go first where the table is too wide.
const LESS: [&str; 7] = ["failure", "max_x_n_pair", "max_x_n", "max_gap_pair", "max_gap", "closed", "class"];

/// Writes the columns that hold anything; the first `axes` of them are the parameters.
pub fn write(
    out: &mut dyn Write,
    columns: &[String],
    rows: &[Vec<Value>],
    axes: usize,
    style: &Style,
) -> io::Result<()> {
    let used: Vec<usize> = (0..columns.len())
        .filter(|&k| k < axes || rows.iter().any(|row| !matches!(&row[k], Value::Null) && row[k] != 0 && row[k] != 0.0))
        .collect();
    let is_words = |k: usize| rows.iter().any(|row| row[k].is_string());
    let is_count = |k: usize| rows.iter().all(|row| row[k].is_u64() || row[k].is_null());
    let mut table = Table::new(
        used.iter()
            .map(|&k| {
                let rank = LESS.iter().position(|name| *name == columns[k]).map_or(0, |at| (LESS.len() - at) as u8);
                let column = if is_words(k) {
                    Column::words(&columns[k])
                } else if k < axes {
                    Column::given(&columns[k], None)
                } else if is_count(k) {
                    Column::count(&columns[k])
                } else {
                    Column::numbers(&columns[k], None)
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
