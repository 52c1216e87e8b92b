//! Friction that explains measurements, and how well.

use std::io::{self, Write};

use super::path::exact;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::path::calibrate::{Calibration, Group};
use crate::text::number::{measured, measured_alike, short, with_unit};

/// Most sensitivities that stand in a row.
const COLUMNS: usize = 4;

/// `f = 0.3 ± 0.002: 2 pairs slip, 1 sticks`.
fn group(found: &Group) -> String {
    let mut text = match found.interval {
        Some([from, to]) if !found.identifiable && to > from => {
            format!("{}: anything from {} to {} explains as much", found.parameter, exact(from), exact(to))
        }
        _ if !found.identifiable => format!("{} is not determined (here {})", found.parameter, exact(found.value)),
        _ => format!("{} = {}", found.parameter, exact(found.value)),
    };
    if let Some(error) = found.standard_error {
        text.push_str(&format!(" ± {}", short(error)));
    }
    if found.at_end && found.identifiable {
        text.push_str(", an end of its range");
    }
    let states = [(found.slip, "slip"), (found.stick, "stick"), (found.open, "open")];
    let states: Vec<String> =
        states.iter().filter(|(count, _)| *count > 0).map(|(count, word)| format!("{count} {word}")).collect();
    if !states.is_empty() {
        text.push_str(&format!(" (of its pairs {})", states.join(", ")));
    }
    if let Some(why) = &found.why {
        text.push_str(&format!("; {why}"));
    }
    text
}

/// Root of the mean square of the residuals over their errors beyond which a fit explains nothing.
const MISFIT: f64 = 5.0;

/// The groups, the measurements beside what is computed, what was looked at.
pub fn write(out: &mut dyn Write, found: &Calibration, style: &Style) -> io::Result<()> {
    for each in &found.groups {
        let role = if each.identifiable { Role::Accent } else { Role::Warning };
        style.paragraph(out, role, &group(each))?;
    }
    let mut columns = vec![
        Column::words("quantity"),
        Column::words("measured"),
        Column::words("computed"),
        Column::words("residual"),
    ];
    let shown = &found.groups[..found.groups.len().min(COLUMNS)];
    columns.extend(shown.iter().map(|group| Column::plain(&format!("per {}", group.parameter), None).droppable(1)));
    let mut table = Table::new(columns);
    for row in &found.measurements {
        let number = |value: f64| Cell::from(measured(value, row.unit.as_deref()));
        let (numbers, unit) =
            measured_alike(&[[row.measured].as_slice(), row.error.as_slice()].concat(), row.unit.as_deref());
        let given = Cell::from(with_unit(&numbers.join(" ± "), unit));
        let mut cells = vec![Cell::from(row.quantity.clone()), given, number(row.computed), number(row.residual)];
        cells.extend(row.sensitivity[..shown.len()].iter().map(|slope| Cell::from(short(*slope))));
        table.rows.push(Row::new(cells));
    }
    table.write(out, style)?;
    let spare = match found.degrees_of_freedom {
        0 => "as many measurements as frictions: nothing is left to judge the fit by".to_owned(),
        spare => {
            let misfit = (found.squares / spare as f64).sqrt();
            let errors = found.measurements.iter().all(|row| row.error.is_some());
            match errors && misfit > MISFIT {
                true => format!(
                    "{spare} more than frictions: no friction explains these measurements, they are off by {} times their errors",
                    short(misfit)
                ),
                false => format!("{spare} more than frictions"),
            }
        }
    };
    style.paragraph(out, Role::Plain, &format!("sum of squares {}; {spare}", short(found.squares)))?;
    for [value, squares] in &found.other_minima {
        let text = format!(
            "also least nearby: {} = {}, sum of squares {}",
            found.groups[0].parameter,
            exact(*value),
            short(*squares)
        );
        style.paragraph(out, Role::Warning, &text)?;
    }
    let role = if found.global { Role::Plain } else { Role::Warning };
    style.paragraph(out, role, &found.sentence)
}
