//! The table of nodal displacements.

use std::io::{self, Write};

use super::length_unit;
use super::style::Style;
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::NodeDisplacement;
use crate::model::units::Units;

/// Writes u_x, u_y and the rotation (where any node has one) of the nodes given.
pub fn write(out: &mut dyn Write, displacements: &[NodeDisplacement], units: &Units, style: &Style) -> io::Result<()> {
    if displacements.is_empty() {
        return writeln!(out, "{}", style.fit("no nodes", style.width));
    }
    table(displacements, units).write(out, style)
}

/// The table that is written.
pub fn table(displacements: &[NodeDisplacement], units: &Units) -> Table {
    let length = |head: &str| Column::numbers(head, length_unit(units)).of(1);
    let rotations = displacements.iter().any(|node| node.rz != 0.0);
    let mut table = Table::new(vec![Column::words("node"), length("u_x"), length("u_y")]);
    if rotations {
        table.columns.push(Column::numbers("rotation", Some("rad".into())).droppable(1));
    }
    for node in displacements {
        let mut cells = vec![Cell::from(node.node.as_str()), Cell::number(node.ux), Cell::number(node.uy)];
        if rotations {
            cells.push(Cell::number(node.rz));
        }
        table.rows.push(Row::new(cells));
    }
    table
}
