//! The table of parameters.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::model::parameter::{Parameter, ParameterValues};
use crate::model::scenario::Scenario;
use crate::text::number::{in_full, short};

/// Writes name, present value, unit, range and meaning; a value that differs from the file says what the file has.
pub fn write(out: &mut dyn Write, scenario: &Scenario, values: &ParameterValues, style: &Style) -> io::Result<()> {
    if scenario.parameters.is_empty() {
        return writeln!(out, "{}", style.fit("no parameters", style.width));
    }
    table(scenario, values).write(out, style)
}

/// The table that is written.
pub fn table(scenario: &Scenario, values: &ParameterValues) -> Table {
    let changed = |name: &str, parameter: &Parameter| {
        values.get(name).is_some_and(|value| value.to_bits() != parameter.value.to_bits())
    };
    let any = scenario.parameters.iter().any(|(n, p)| changed(n, p));
    let mut table = Table::new(vec![Column::words("name"), Column::given("value", None), Column::words("unit")]);
    if any {
        table.columns.push(Column::words("in the file"));
    }
    table.columns.push(Column::words("range").droppable(1));
    table.columns.push(Column::words("about").droppable(2));
    for (name, parameter) in &scenario.parameters {
        let value = values.get(name).copied().unwrap_or(parameter.value);
        let is_changed = changed(name, parameter);
        let shown = |value: f64| if parameter.formula.is_some() { short(value) } else { in_full(value) };
        let role = if is_changed { Role::Accent } else { Role::Plain };
        let mut cells = vec![
            Cell::from(name.as_str()),
            // The value of a formula has digits of rounding; what was set is shown as it was.
            Cell::new(shown(value), role),
            Cell::new(parameter.unit.clone().unwrap_or_default(), Role::Muted),
        ];
        if any {
            let file = if is_changed { format!("was {}", shown(parameter.value)) } else { String::new() };
            cells.push(Cell::new(file, Role::Accent));
        }
        cells.push(Cell::new(range(parameter), Role::Muted));
        cells.push(Cell::from(parameter.about.clone().unwrap_or_default()));
        table.rows.push(Row::new(cells));
    }
    table
}

/// `0 … 400 by 10`, or the formula.
fn range(parameter: &Parameter) -> String {
    if let Some(formula) = &parameter.formula {
        return format!("= {}", formula.text());
    }
    let mut text = match (parameter.min, parameter.max) {
        (Some(min), Some(max)) => format!("{} … {}", in_full(min), in_full(max)),
        (Some(min), None) => format!("≥ {}", in_full(min)),
        (None, Some(max)) => format!("≤ {}", in_full(max)),
        (None, None) => String::new(),
    };
    if let Some(step) = parameter.step {
        if !text.is_empty() {
            text.push(' ');
        }
        text.push_str(&format!("by {}", in_full(step)));
    }
    text
}
