//! The table of the contact pairs.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit};
use crate::answer::record::{PairState, State};
use crate::model::units::Units;

/// State of a pair in words; an open pair that cohesion (or p) still holds says so: `open (held)`,
/// `open (slip +)` (method §4).
pub fn state_words(pair: &PairState) -> &'static str {
    match (pair.state, pair.held) {
        (State::Open, Some(State::Stick)) => "open (held)",
        (State::Open, Some(State::SlipPlus)) => "open (slip +)",
        (State::Open, Some(State::SlipMinus)) => "open (slip -)",
        (state, _) => state.word(),
    }
}

/// Writes state, forces, displacements, bound and reserves of every pair given.
pub fn write(out: &mut dyn Write, pairs: &[PairState], units: &Units, style: &Style) -> io::Result<()> {
    if pairs.is_empty() {
        return writeln!(out, "{}", style.fit("no contact pairs", style.width));
    }
    table(pairs, units).write(out, style)
}

/// The table that is written.
pub fn table(pairs: &[PairState], units: &Units) -> Table {
    let force = |head: &str| Column::numbers(head, force_unit(units)).clean().of(1);
    let length = |head: &str| Column::numbers(head, length_unit(units)).clean().of(2);
    let friction = pairs.iter().any(|pair| pair.law.has_tangential_joint());
    let mut columns = vec![
        Column::words("pair"),
        Column::words("state"),
        force("x_n"),
        force("x_τ").droppable(1),
        length("z_n").droppable(2),
        length("z_τ"),
    ];
    if friction {
        columns.extend([force("bound").droppable(3), force("x⁺").droppable(4), force("x⁻").droppable(5)]);
    }
    let mut table = Table::new(columns);
    for pair in pairs {
        let mut cells = vec![Cell::from(pair.id.as_str()), Cell::new(state_words(pair), Role::State(pair.state))];
        cells.extend([pair.x_n, pair.x_t, pair.z_n, pair.z_t].map(Cell::number));
        if friction {
            cells.extend([pair.bound, pair.reserve_plus, pair.reserve_minus].map(Cell::number));
        }
        table.rows.push(Row::new(cells));
    }
    table
}
