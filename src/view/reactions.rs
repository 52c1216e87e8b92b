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
    about_origin: [f64; 3],
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    if reactions.is_empty() {
        return writeln!(out, "{}", style.fit("no supports and no springs", style.width));
    }
    table(reactions, units).write(out, style)?;
    let unit = moment_unit(units);
    let (origin, moment) = match reactions.iter().any(|reaction| reaction.space.is_some()) {
        false => ("(0, 0)", short(about_origin[2])),
        true => ("(0, 0, 0)", format!("({})", about_origin.map(short).join(", "))),
    };
    let moment = with_unit(&moment, unit.as_deref());
    writeln!(out, "{}", style.fit(&style.text(&format!("moment of all of them about {origin}: {moment}")), style.width))
}

/// The table that is written, with the sums.
pub fn table(reactions: &[Reaction], units: &Units) -> Table {
    let force = |head: &str| Column::numbers(head, force_unit(units)).of(1);
    let is_in_space = reactions.iter().any(|reaction| reaction.space.is_some());
    let moments = reactions.iter().any(|reaction| reaction.moment() != [0.0; 3]);
    let (forces, turns): (&[&str], &[&str]) = match is_in_space {
        false => (&["F_x", "F_y"], &["M"]),
        true => (&["F_x", "F_y", "F_z"], &["M_x", "M_y", "M_z"]),
    };
    let mut table = Table::new(vec![Column::words("node")]);
    table.columns.extend(forces.iter().map(|head| force(head)));
    if moments {
        table.columns.extend(turns.iter().map(|head| Column::numbers(head, moment_unit(units)).droppable(1)));
    }
    let mut push = |name: &str, force: [f64; 3], moment: Option<[f64; 3]>| {
        let mut cells = vec![Cell::from(name)];
        cells.extend(force[..forces.len()].iter().map(|force| Cell::number(*force)));
        if moments {
            cells.extend((3 - turns.len()..3).map(|c| Cell::maybe(moment.map(|moment| moment[c]))));
        }
        table.rows.push(Row::new(cells));
    };
    for reaction in reactions {
        push(&reaction.node, reaction.force(), Some(reaction.moment()));
    }
    if reactions.len() > 1 {
        let sum = [0, 1, 2].map(|c| balance(reactions.iter().map(|reaction| reaction.force()[c])));
        // Moments at different places do not add up to anything.
        push("sum", sum, None);
    }
    table
}
