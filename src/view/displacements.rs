//! The table of nodal displacements.

use std::io::{self, Write};

use super::length_unit;
use super::number::{in_column, largest};
use super::style::Style;
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::NodeDisplacement;
use crate::model::scenario::Units;

/// Writes u_x, u_y and the rotation (where any node has one) of the nodes given.
pub fn write(out: &mut dyn Write, displacements: &[NodeDisplacement], units: &Units, style: &Style) -> io::Result<()> {
    if displacements.is_empty() {
        return writeln!(out, "{}", style.fit("no nodes", style.width));
    }
    table(displacements, units).write(out, style)
}

/// The table that is written.
pub fn table(displacements: &[NodeDisplacement], units: &Units) -> Table {
    let length = length_unit(units);
    let rotations = displacements.iter().any(|node| node.rz != 0.0);
    let mut table =
        Table::new(vec![Column::words("node"), Column::numbers("u_x", length.clone()), Column::numbers("u_y", length)]);
    if rotations {
        table.columns.push(Column::numbers("rotation", Some("rad".into())).droppable(1));
    }
    let lengths = largest(displacements.iter().flat_map(|node| [node.ux, node.uy]));
    let angles = largest(displacements.iter().map(|node| node.rz));
    for node in displacements {
        let mut cells = vec![
            Cell::from(node.node.as_str()),
            Cell::from(in_column(node.ux, lengths)),
            Cell::from(in_column(node.uy, lengths)),
        ];
        if rotations {
            cells.push(Cell::from(in_column(node.rz, angles)));
        }
        table.rows.push(Row::new(cells));
    }
    table
}
