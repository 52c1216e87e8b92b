//! The table of the contact pairs.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{force_unit, length_unit};
use crate::answer::record::{PairState, State};
use crate::answer::rounding::largest;
use crate::model::units::Units;

/// State of a pair in words; an open pair that cohesion (or p) still holds says so: `open (held)`,
/// `open (slip +)` (method §4).
pub fn state_words(pair: &PairState) -> &'static str {
    match (pair.state, pair.held) {
        (State::Open, Some(State::Stick)) => "open (held)",
        (State::Open, Some(State::SlipPlus)) => "open (slip +)",
        (State::Open, Some(State::SlipMinus)) => "open (slip -)",
        (State::Open, Some(State::Slip)) => "open (slip)",
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
    part(&pairs.iter().collect::<Vec<_>>(), pairs, units)
}

/// What a column shows of a pair.
type Reader = fn(&PairState) -> f64;

/// The rows of some of the pairs, in the powers of ten of all.
pub fn part(some: &[&PairState], all: &[PairState], units: &Units) -> Table {
    let column = |column: Column, value: Reader| column.with_unwritten(largest(all.iter().map(value)));
    let force = |head: &str| Column::numbers(head, force_unit(units)).clean().of(1);
    let length = |head: &str| Column::numbers(head, length_unit(units)).clean().of(2);
    let friction = all.iter().any(|pair| pair.law.has_tangential_joint());
    let mut columns: Vec<(Column, Reader)> = Vec::new();
    if all.iter().any(|pair| pair.space.is_some()) {
        columns.extend([
            (force("x_n"), (|pair| pair.x_n) as Reader),
            (force("x_t1").droppable(1), |pair| pair.friction()[0]),
            (force("x_t2").droppable(1), |pair| pair.friction()[1]),
            (length("z_n").droppable(2), |pair| pair.z_n),
            (length("z_t1"), |pair| pair.slip()[0]),
            (length("z_t2"), |pair| pair.slip()[1]),
        ]);
        if friction {
            columns.extend([
                (force("bound").droppable(3), (|pair| pair.bound) as Reader),
                (force("reserve").droppable(4), PairState::reserve),
            ]);
        }
    } else {
        columns.extend([
            (force("x_n"), (|pair| pair.x_n) as Reader),
            (force("x_τ").droppable(1), |pair| pair.x_t),
            (length("z_n").droppable(2), |pair| pair.z_n),
            (length("z_τ"), |pair| pair.z_t),
        ]);
        if friction {
            columns.extend([
                (force("bound").droppable(3), (|pair| pair.bound) as Reader),
                (force("x⁺").droppable(4), |pair| pair.reserve_plus),
                (force("x⁻").droppable(5), |pair| pair.reserve_minus),
            ]);
        }
    }
    let values: Vec<fn(&PairState) -> f64> = columns.iter().map(|(_, value)| *value).collect();
    let numbers = columns.into_iter().map(|(head, value)| column(head, value));
    let mut table = Table::new([Column::words("pair"), Column::words("state")].into_iter().chain(numbers).collect());
    for pair in some {
        let mut cells = vec![Cell::from(pair.id.as_str()), Cell::new(state_words(pair), Role::State(pair.state))];
        cells.extend(values.iter().map(|value| Cell::number(value(pair))));
        table.rows.push(Row::new(cells));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::tests::sample;

    /// A part of a table is read in the numbers of the whole: its rows are those of the whole.
    #[test]
    fn a_part_has_the_powers_of_ten_of_all() {
        let mut pairs = sample::beam(0.3, 70.0).pairs;
        pairs[0].x_n = 3.0e7;
        let style = Style { width: 200, ..Style::default() };
        let written = |table: Table| {
            let mut out = Vec::new();
            table.write(&mut out, &style).unwrap();
            String::from_utf8(out).unwrap()
        };
        let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        let whole = written(table(&pairs, &Units::default()));
        let last = written(part(&[&pairs[pairs.len() - 1]], &pairs, &Units::default()));
        assert_eq!(words(whole.lines().last().unwrap()), words(last.lines().last().unwrap()));
        assert_eq!(words(whole.lines().nth(1).unwrap()), words(last.lines().nth(1).unwrap()));
    }
}
