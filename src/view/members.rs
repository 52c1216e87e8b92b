//! The table of member end forces, bar by bar.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit, moment_unit};
use crate::answer::diagram::{Diagram, Internal, Place};
use crate::answer::record::MemberForces;
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;
use crate::text::number::measured;

/// Writes N, Q, M at both ends of every element of `bar` (of all bars without one). Tension, and M with tension
/// on the −y side of the bar, are positive.
pub fn write(
    out: &mut dyn Write,
    members: &[MemberForces],
    bar: Option<&str>,
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let chosen: Vec<&MemberForces> = members.iter().filter(|member| bar.is_none_or(|bar| member.bar == bar)).collect();
    if chosen.is_empty() {
        let text = match bar {
            Some(bar) => format!("no bar {bar}"),
            None => "no bars".into(),
        };
        return writeln!(out, "{}", style.fit(&style.text(&text), style.width));
    }
    table(&chosen, units).write(out, style)?;
    let Some(diagram) = bar.and_then(|bar| Diagram::of(members, bar)) else { return Ok(()) };
    for &which in Internal::of(chosen.iter().any(|member| member.start.space.is_some())) {
        style.paragraph(out, Role::Plain, &extremes(&diagram, which, units))?;
    }
    Ok(())
}

/// The table that is written of some elements.
pub fn table(chosen: &[&MemberForces], units: &Units) -> Table {
    let force = |head: &str| Column::numbers(head, force_unit(units)).of(1);
    let mut table = Table::new(vec![Column::words("bar"), Column::count("element"), Column::words("end")]);
    let is_in_space = chosen.iter().any(|member| member.start.space.is_some());
    for which in Internal::of(is_in_space) {
        table.columns.push(match which.is_moment() {
            true => Column::numbers(which.symbol(), moment_unit(units)),
            false => force(which.symbol()),
        });
    }
    for member in chosen {
        for (word, end) in [("start", member.start), ("end", member.end)] {
            let first = word == "start";
            let mut cells = vec![
                Cell::from(if first { member.bar.as_str() } else { "" }),
                Cell::from(if first { member.element.to_string() } else { String::new() }),
                Cell::new(word, Role::Muted),
            ];
            cells.extend(end.named().into_iter().map(|(_, force)| Cell::number(force)));
            table.rows.push(Row::new(cells));
        }
    }
    table
}

/// `M: largest 12.5 kN m at 2.1 m, least 0 kN m at 0 m`: between the nodes too.
pub fn extremes(diagram: &Diagram, which: Internal, units: &Units) -> String {
    let unit = if which.is_moment() { moment_unit(units) } else { force_unit(units) };
    let extremes = diagram.extremes(which);
    let scale = largest(extremes.iter().map(|place| place.value));
    let [least, most] = extremes.map(|Place { distance, value }| {
        let value = measured(denoised(value, scale), unit.as_deref());
        format!("{value} at {}", measured(distance, length_unit(units).as_deref()))
    });
    format!("{}: largest {most}, least {least}", which.symbol())
}
