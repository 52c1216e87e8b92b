//! The table of the contact pairs.

use std::io::{self, Write};

use super::number::{aligned, largest};
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit};
use crate::answer::record::{PairState, State};
use crate::model::scenario::Units;

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
    let (force, length) = (force_unit(units), length_unit(units));
    let friction = pairs.iter().any(|pair| pair.law.has_tangential_joint());
    let mut columns = vec![
        Column::words("pair"),
        Column::words("state"),
        Column::numbers("x_n", force.clone()),
        Column::numbers("x_τ", force.clone()).droppable(1),
        Column::numbers("z_n", length.clone()).droppable(2),
        Column::numbers("z_τ", length),
    ];
    if friction {
        columns.push(Column::numbers("bound", force.clone()).droppable(3));
        columns.push(Column::numbers("x⁺", force.clone()).droppable(4));
        columns.push(Column::numbers("x⁻", force).droppable(5));
    }
    let forces = largest(pairs.iter().flat_map(|p| [p.x_n, p.x_t, p.bound]));
    let lengths = largest(pairs.iter().flat_map(|p| [p.z_n, p.z_t]));
    let f = |value: f64| Cell::from(aligned(value, forces));
    let d = |value: f64| Cell::from(aligned(value, lengths));
    let mut table = Table::new(columns);
    for pair in pairs {
        let mut cells = vec![
            Cell::from(pair.id.as_str()),
            Cell::new(state_words(pair), Role::State(pair.state)),
            f(pair.x_n),
            f(pair.x_t),
            d(pair.z_n),
            d(pair.z_t),
        ];
        if friction {
            cells.extend([f(pair.bound), f(pair.reserve_plus), f(pair.reserve_minus)]);
        }
        table.rows.push(Row::new(cells));
    }
    table
}
