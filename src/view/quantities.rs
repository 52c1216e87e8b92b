//! Values of quantities in a table.

use std::io::{self, Write};

use super::path::exact;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::model::quantity::Quantity;
use crate::model::units::Units;
use crate::path::quantity::{NoValue, OnPath, Value};
use crate::path::record::PathRecord;
use crate::text::number::{measured, with_unit};

/// A quantity, its value, and where an extreme stands.
pub type Shown = (Quantity, Result<Value, NoValue>, Option<String>);

/// A value with its unit, or why there is none.
pub fn shown(quantity: &Quantity, value: &Result<Value, NoValue>, units: &Units) -> (String, Role) {
    match value {
        Ok(Value::Number(value)) => (measured(*value, quantity.unit(units).as_deref()), Role::Plain),
        Ok(Value::Word(word)) => (word.clone(), Role::Plain),
        Err(reason) => (reason.0.clone(), Role::Muted),
    }
}

/// Quantities at the places of a path, a column each; nothing where none is asked for.
pub fn write_along(
    out: &mut dyn Write,
    path: &PathRecord,
    along: &[OnPath],
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    if along.is_empty() {
        return Ok(());
    }
    let mut columns = vec![Column::given(&path.name, None)];
    for (quantity, _) in along {
        columns.push(match quantity.unit(units) {
            None => Column::plain(&quantity.to_string(), None),
            unit => Column::numbers(&quantity.to_string(), unit),
        });
    }
    let mut table = Table::new(columns);
    for (k, place) in path.places.iter().enumerate() {
        let mut cells = vec![Cell::number(place.value)];
        cells.extend(along.iter().map(|(_, values)| Cell::maybe(values.get(k).copied().flatten())));
        table.rows.push(Row::new(cells));
    }
    table.write(out, style)
}

/// One line for each quantity; numbers with ten digits.
pub fn write(out: &mut dyn Write, values: &[Shown], units: &Units, style: &Style) -> io::Result<()> {
    let mut table = Table::new(vec![Column::words("quantity"), Column::words("value")]);
    for (quantity, value, at) in values {
        let (text, role) = match value {
            Ok(Value::Number(value)) => {
                let place = at.as_ref().map_or(String::new(), |at| format!(" at {at}"));
                (with_unit(&exact(*value), quantity.unit(units).as_deref()) + &place, Role::Plain)
            }
            value => shown(quantity, value, units),
        };
        table.rows.push(Row::new(vec![Cell::from(quantity.to_string()), Cell::new(text, role)]));
    }
    table.write(out, style)
}
