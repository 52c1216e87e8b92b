//! The table of reactions.

use std::io::{self, Write};

use super::style::Style;
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, moment_unit};
use crate::answer::record::Reaction;
use crate::answer::rounding::balance;
use crate::model::units::Units;
use crate::text::number::{short, with_unit};

/// Writes the forces of supports and springs on the structure, and their totals: the sums, and the moment of all of
/// them about the origin. Forces of contact with the ground are not among them: they stand under the pairs.
pub fn write(
    out: &mut dyn Write,
    reactions: &[Reaction],
    about_origin: f64,
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    if reactions.is_empty() {
        return writeln!(out, "{}", style.fit("no supports and no springs", style.width));
    }
    table(reactions, units).write(out, style)?;
    let moment = with_unit(&short(about_origin), moment_unit(units).as_deref());
    writeln!(out, "{}", style.fit(&style.text(&format!("moment of all of them about (0, 0): {moment}")), style.width))
}

/// The table that is written, with the sums.
pub fn table(reactions: &[Reaction], units: &Units) -> Table {
    let force = |head: &str| Column::numbers(head, force_unit(units)).of(1);
    let moments = reactions.iter().any(|reaction| reaction.m != 0.0);
    let mut table = Table::new(vec![Column::words("node"), force("F_x"), force("F_y")]);
    if moments {
        table.columns.push(Column::numbers("M", moment_unit(units)).droppable(1));
    }
    let mut push = |name: &str, fx: f64, fy: f64, m: Option<f64>| {
        let mut cells = vec![Cell::from(name), Cell::number(fx), Cell::number(fy)];
        if moments {
            cells.push(Cell::maybe(m));
        }
        table.rows.push(Row::new(cells));
    };
    for reaction in reactions {
        push(&reaction.node, reaction.fx, reaction.fy, Some(reaction.m));
    }
    if reactions.len() > 1 {
        let fx = balance(reactions.iter().map(|r| r.fx));
        let fy = balance(reactions.iter().map(|r| r.fy));
        // Moments at different places do not add up to anything.
        push("sum", fx, fy, None);
    }
    table
}
