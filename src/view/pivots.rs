//! The trace: one row per pivot.

use std::io::{self, Write};
use std::ops::RangeInclusive;

use unicode_width::UnicodeWidthStr;

use super::force_unit;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::{Answer, PivotRecord};
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;

/// Whether the pivots are those of a contact problem, where p is a force; in a bare LCP it has no unit. Recognized by
/// the names: `w[1]` and `z[1]` occur in a bare LCP only.
pub fn of_contact(pivots: &[PivotRecord]) -> bool {
    pivots.iter().any(|pivot| {
        [&pivot.entering, &pivot.leaving]
            .into_iter()
            .any(|name| name.as_str() != "p" && !name.starts_with("w[") && !name.starts_with("z["))
    })
}

/// Writes the pivots whose step lies in `range` (all without one); the row of step `current` is marked. The
/// sentence stands on the row where the width allows it, else beneath.
pub fn write(
    out: &mut dyn Write,
    answer: &Answer,
    range: Option<RangeInclusive<usize>>,
    current: Option<usize>,
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let pivots = answer.pivots.as_slice();
    let chosen: Vec<&PivotRecord> =
        pivots.iter().filter(|pivot| range.as_ref().is_none_or(|range| range.contains(&pivot.step))).collect();
    if chosen.is_empty() {
        let text = match (pivots.last(), &range) {
            (None, _) => answer.rules.why_no_pivots(),
            (Some(last), Some(range)) => {
                format!("no pivots in {}..{}: there are 0..{}", range.start(), range.end(), last.step)
            }
            (Some(_), None) => String::new(),
        };
        return writeln!(out, "{}", style.fit(&text, style.width));
    }
    let unit = force_unit(units).filter(|_| of_contact(pivots));
    let scale = largest(pivots.iter().map(|pivot| pivot.p));
    let mut table = Table::new(vec![
        Column::count("step"),
        Column::words("entering"),
        Column::words("leaving"),
        Column::numbers("p", unit),
    ]);
    let ties = chosen.iter().any(|pivot| pivot.ties.len() > 1);
    if ties {
        table.columns.push(Column::words("ties").droppable(1));
    }
    let longest = chosen.iter().map(|pivot| pivot.sentence.width()).max().unwrap_or(0);
    let on_the_row = longest > 0 && longest + 50 <= style.width;
    if on_the_row {
        table.columns.push(Column::words("what happens"));
    }
    for pivot in &chosen {
        let mut row = Row::new(vec![
            Cell::from(pivot.step.to_string()),
            Cell::from(pivot.entering.as_str()),
            Cell::from(pivot.leaving.as_str()),
            Cell::number(denoised(pivot.p, scale)),
        ]);
        if ties {
            let count = pivot.ties.len();
            let text = if count > 1 { format!("{count} tied") } else { String::new() };
            row.cells.push(Cell::new(text, Role::Warning));
        }
        if on_the_row {
            row.cells.push(Cell::from(pivot.sentence.as_str()));
        } else if !pivot.sentence.is_empty() {
            row.beneath = Some(pivot.sentence.clone());
        }
        row.marked = current == Some(pivot.step);
        table.rows.push(row);
    }
    table.write(out, style)?;
    if answer.unrecorded() > 0 && range.is_none() {
        let text = format!(
            "and {} more pivots, which were counted but not recorded: {} in all",
            answer.unrecorded(),
            answer.pivot_count
        );
        writeln!(out, "{}", style.paint(Role::Muted, &style.fit(&text, style.width)))?;
    }
    whose_directions(out, answer, &chosen, style)
}

/// In space: whose directions the sentences of these pivots name, beside those of the answer.
pub fn whose_directions(
    out: &mut dyn Write,
    answer: &Answer,
    pivots: &[&PivotRecord],
    style: &Style,
) -> io::Result<()> {
    let names_directions = pivots.iter().any(|pivot| pivot.sentence.contains('°'));
    if let Some(polygon) = answer.polygon.as_ref().filter(|polygon| polygon.cone && names_directions) {
        let text = format!(
            "directions in the pivots' lines are those of the {} facets of the polygon, on which the pivots are made; the answer \
             is taken on from the last of them to the cone, where the directions that `pairs` shows are the pairs' own",
            polygon.facets
        );
        style.paragraph(out, Role::Muted, &text)?;
    }
    Ok(())
}

/// A pivot in a title: its number counts from 0, so that the last of 5 pivots is number 4.
pub fn title(step: usize) -> String {
    format!("pivot {step} (p enters at 0)")
}
