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
    let [[x0, y0, z0], [x1, y1, z1]] = overview.extent.map(|corner| corner.map(short));
    let upwards = if mesh.is_solid() { format!(", z {z0} to {z1}") } else { String::new() };
    say(format!("{} nodes{unused}, x {x0} to {x1}, y {y0} to {y1}{upwards}", mesh.nodes.len()))?;
    let elements: Vec<String> = overview.shapes.iter().map(|(shape, count)| counted(*shape, *count)).collect();
    let size = match overview.volume {
        Some(volume) => format!("volume {}, surface {}", short(volume), short(overview.area)),
        None => format!("area {}", short(overview.area)),
    };
    say(format!("{}; {size}", elements.join(", ")))?;
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
        let measure = if mesh.is_solid() { "area" } else { "length" };
        let mut table =
            Table::new(vec![Column::words("boundary"), Column::count("nodes"), Column::numbers(measure, None)]);
        const LISTED: usize = 40;
        for piece in overview.boundary.iter().take(LISTED) {
            let cells = [piece.name.as_str().into(), piece.nodes.to_string().into(), Cell::number(piece.measure)];
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
    let what = match (count, shape.dimension()) {
        (1, _) => shape.word().to_owned(),
        // tetrahedra, hexahedra
        (_, 3) => shape.word().replace("hedron", "hedra"),
        _ => format!("{}s", shape.word()),
    };
    format!("{count} {what} of {} nodes", shape.nodes())
}

fn groups(overview: &Overview, style: &Style) -> Table {
    let is_solid = overview.volume.is_some();
    let mut table = Table::new(vec![
        Column::words("group"),
        Column::words("members"),
        Column::count("number"),
        Column::numbers(if is_solid { "area" } else { "length" }, None),
        Column::numbers(if is_solid { "volume" } else { "area" }, None),
        Column::words("").droppable(1),
    ]);
    let of_body = if is_solid { 3 } else { 2 };
    for group in &overview.groups {
        let measure = |is_body: bool| {
            // Of sets of nodes that of the edge or face they make; lines beside solids have no column.
            let shown = group.measure.filter(|_| !is_solid || group.dimension != 1);
            Cell::maybe(shown.filter(|_| (group.dimension == of_body) == is_body))
        };
        let what = if is_solid { "no face" } else { "no edge" };
        let fault = group.fault.as_ref().map_or(String::new(), |fault| format!("{what}: {fault}"));
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
