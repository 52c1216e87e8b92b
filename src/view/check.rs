//! The fresh check of an answer, figure by figure.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::Answer;
use crate::text::number::residual;

/// Writes the figures of the check and what each means; without an answer it says that nothing was checked.
pub fn write(out: &mut dyn Write, answer: &Answer, style: &Style) -> io::Result<()> {
    use crate::answer::record::OutcomeKind::{Breakdown, PivotLimit, Ray};
    if matches!(answer.outcome, Ray | PivotLimit | Breakdown) {
        let text = style.fit("nothing to check: there is no answer", style.width);
        return writeln!(out, "{text}");
    }
    table(answer).write(out, style)?;
    let (word, role) = if answer.check.passed { ("passed", Role::Good) } else { ("FAILED", Role::Bad) };
    writeln!(out, "{}", style.paint(role, word))
}

/// The table that is written.
pub fn table(answer: &Answer) -> Table {
    let check = &answer.check;
    // a bare LCP knows no contact
    let [of_w, of_z] = match &answer.solution {
        Some(_) => ["smallest w", "smallest z"],
        None => ["smallest contact force or reserve", "smallest opening or slip"],
    };
    let mut table = Table::new(vec![
        Column::words("check"),
        Column::numbers("relative", None),
        Column::words("meaning").droppable(1),
    ]);
    let mut push = |name: &str, value: f64, meaning: &str| {
        table.rows.push(Row::new(vec![Cell::from(name), Cell::from(residual(value)), Cell::new(meaning, Role::Muted)]));
    };
    push("min w", check.min_w, of_w);
    push("min z", check.min_z, of_z);
    push("w·z", check.complementarity, "the lesser of a couple, max");
    if let Some(equilibrium) = check.equilibrium {
        push("equilibrium", equilibrium, "residual of K u = F + Bᵀλ");
    }
    table
}
