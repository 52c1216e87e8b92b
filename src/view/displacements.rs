//! The table of nodal displacements.

use std::io::{self, Write};

use super::length_unit;
use super::style::Style;
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::NodeDisplacement;
use crate::model::units::Units;

/// Writes the displacements and the rotations (where any node has one) of the nodes given.
pub fn write(out: &mut dyn Write, displacements: &[NodeDisplacement], units: &Units, style: &Style) -> io::Result<()> {
    if displacements.is_empty() {
        return writeln!(out, "{}", style.fit("no nodes", style.width));
    }
    table(displacements, units).write(out, style)
}

/// The table that is written.
pub fn table(displacements: &[NodeDisplacement], units: &Units) -> Table {
    let length = |head: &str| Column::numbers(head, length_unit(units)).of(1);
    let is_in_space = displacements.iter().any(|node| node.space.is_some());
    let rotations = displacements.iter().any(|node| node.all()[3..].iter().any(|turn| *turn != 0.0));
    let (lengths, turns): (&[&str], &[&str]) = match is_in_space {
        false => (&["u_x", "u_y"], &["rotation"]),
        true => (&["u_x", "u_y", "u_z"], &["r_x", "r_y", "r_z"]),
    };
    let mut table = Table::new(vec![Column::words("node")]);
    table.columns.extend(lengths.iter().map(|head| length(head)));
    if rotations {
        let turned = |head: &&str| Column::numbers(head, Some("rad".into())).droppable(1);
        table.columns.extend(turns.iter().map(turned));
    }
    for node in displacements {
        let mut cells = vec![Cell::from(node.node.as_str())];
        cells.extend((0..lengths.len()).map(|at| Cell::maybe(node.component(at))));
        if rotations {
            cells.extend((6 - turns.len()..6).map(|at| Cell::maybe(node.component(at))));
        }
        table.rows.push(Row::new(cells));
    }
    table
}
