//! What a mesh file holds.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::model::mesh::overview::Overview;
use crate::model::mesh::{Mesh, Shape};
use crate::text::number::short;

/// Writes nodes, elements, groups with their lengths and areas, the boundary by direction, and the worst element.
pub fn write(out: &mut dyn Write, name: &str, mesh: &Mesh, overview: &Overview, style: &Style) -> io::Result<()> {
    let mut say = |text: String| -> io::Result<()> { style.paragraph(out, Role::Plain, &text) };
    say(format!("{name}: no problems found ({})", mesh.format))?;
    let unused = match overview.unused_nodes {
        0 => String::new(),
        count => format!(" ({count} of them unused)"),
    };
    let [[x0, y0], [x1, y1]] = overview.extent.map(|corner| corner.map(short));
    say(format!("{} nodes{unused}, x {x0} to {x1}, y {y0} to {y1}", mesh.nodes.len()))?;
    let elements: Vec<String> = overview.shapes.iter().map(|(shape, count)| counted(*shape, *count)).collect();
    say(format!("{}; area {}", elements.join(", "), short(overview.area)))?;
    if let Some(worst) = &overview.worst {
        let (quality, place) = (short(worst.quality), &worst.place);
        say(format!("worst element: {} ({place}), quality {quality} (1 best, 0 degenerate)", worst.tag))?;
    }
    for note in &mesh.notes {
        say(format!("note: {note}"))?;
    }
    if !mesh.skipped.is_empty() {
        say(format!("left alone: {}", mesh.skipped.join(", ")))?;
    }
    if !overview.groups.is_empty() {
        writeln!(out)?;
        groups(overview, style).write(out, style)?;
    }
    if !overview.boundary.is_empty() {
        writeln!(out)?;
        let mut table =
            Table::new(vec![Column::words("boundary"), Column::count("nodes"), Column::numbers("length", None)]);
        const LISTED: usize = 40;
        for edge in overview.boundary.iter().take(LISTED) {
            let cells = [edge.name.as_str().into(), edge.nodes.to_string().into(), Cell::number(edge.length)];
            table.rows.push(Row::new(cells.into()));
        }
        table.write(out, style)?;
        if overview.boundary.len() > LISTED {
            writeln!(out, "and {} more pieces", overview.boundary.len() - LISTED)?;
        }
    }
    Ok(())
}

/// `3 quadrilaterals of 8 nodes`.
fn counted(shape: Shape, count: usize) -> String {
    let what = ["line", "triangle", "quadrilateral"][shape.corners() - 2];
    format!("{count} {what}{} of {} nodes", if count == 1 { "" } else { "s" }, shape.nodes())
}

fn groups(overview: &Overview, style: &Style) -> Table {
    let mut table = Table::new(vec![
        Column::words("group"),
        Column::words("members"),
        Column::count("number"),
        Column::numbers("length", None),
        Column::numbers("area", None),
        Column::words("").droppable(1),
    ]);
    for group in &overview.groups {
        let measure = |is_area: bool| Cell::maybe(group.measure.filter(|_| (group.dimension == 2) == is_area));
        let fault = group.fault.as_ref().map_or(String::new(), |fault| format!("no edge: {fault}"));
        table.rows.push(Row::new(vec![
            Cell::from(style.text(&group.name)),
            Cell::from(group.what),
            Cell::from(group.count.to_string()),
            measure(false),
            measure(true),
            Cell::new(fault, Role::Muted),
        ]));
    }
    table
}
