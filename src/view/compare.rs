//! Rules compared: covering × tie-break × engine.

use std::fmt::Display;
use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::attempt::{AttemptCovering, AttemptEngine, AttemptRules};
use crate::answer::rounding::denoised;
use crate::model::rules::TieBreak;
use crate::solve::compare::{Compared, Comparison};
use crate::text::number::short;

/// Letter of an answer: A, B … Z, then its number.
fn letter(index: usize) -> String {
    u8::try_from(index)
        .ok()
        .filter(|k| *k < 26)
        .map_or_else(|| (index + 1).to_string(), |k| char::from(b'A' + k).to_string())
}

fn outcome(row: &Compared) -> (String, Role) {
    match (row.outcome, row.class) {
        (None, _) => ("does not fit: f = 0".to_owned(), Role::Muted),
        (Some(_), _) if row.cycled => ("cycles".to_owned(), Role::Bad),
        (Some(outcome), Some(class)) => (format!("{}: {}", outcome.word(), class.word()), Role::of_outcome(outcome)),
        (Some(outcome), None) => (outcome.word().to_owned(), Role::of_outcome(outcome)),
    }
}

/// Rows of the comparison with the same end, and the rules that lead to it.
struct Group<'a> {
    coverings: Vec<AttemptCovering>,
    tie_breaks: Vec<TieBreak>,
    engines: Vec<AttemptEngine>,
    /// One of the rows.
    row: &'a Compared,
}

/// What a row of the table shows of an end.
fn end(row: &Compared) -> (String, usize, String, Option<usize>) {
    (outcome(row).0, row.pivots, short(p_of(row)), row.answer)
}

fn p_of(row: &Compared) -> f64 {
    denoised(row.p, 1.0)
}

/// Joins groups with the same end that differ in one rule alone: in engines first, then tie-breaks, then coverings.
fn groups(rows: &[Compared]) -> Vec<Group<'_>> {
    let mut groups: Vec<Group> = Vec::new();
    for row in rows {
        let AttemptRules { covering, tie_break, engine } = row.rules;
        groups.push(Group { coverings: vec![covering], tie_breaks: vec![tie_break], engines: vec![engine], row });
    }
    for rule in 0..3 {
        let mut joined: Vec<Group> = Vec::new();
        for mut group in groups {
            let same = joined.iter_mut().find(|other| {
                end(other.row) == end(group.row)
                    && (rule == 0 || other.engines == group.engines)
                    && (rule == 1 || other.tie_breaks == group.tie_breaks)
                    && (rule == 2 || other.coverings == group.coverings)
            });
            match (same, rule) {
                (Some(other), 0) => other.engines.append(&mut group.engines),
                (Some(other), 1) => other.tie_breaks.append(&mut group.tie_breaks),
                (Some(other), _) => other.coverings.append(&mut group.coverings),
                (None, _) => joined.push(group),
            }
        }
        groups = joined;
    }
    groups
}

/// The names of a group, or `all` where there are no others.
fn names<T: PartialEq + Display>(chosen: &[T], rows: &[Compared], of: impl Fn(&AttemptRules) -> T) -> String {
    let every = rows.iter().all(|row| chosen.contains(&of(&row.rules)));
    if every && chosen.len() > 1 {
        return "all".to_owned();
    }
    chosen.iter().map(T::to_string).collect::<Vec<_>>().join(", ")
}

/// Writes the table, equal ends in one row, and a line that sums it up.
pub fn write(out: &mut dyn Write, comparison: &Comparison, style: &Style) -> io::Result<()> {
    let mut table = Table::new(vec![
        Column::words("covering"),
        Column::words("tie-break"),
        Column::words("engine"),
        Column::words("outcome"),
        Column::count("pivots"),
        Column::numbers("p", None).clean().droppable(1),
        Column::words("answer"),
    ]);
    for group in groups(&comparison.rows) {
        let row = group.row;
        let (text, role) = outcome(row);
        let ran = row.outcome.is_some();
        table.rows.push(Row::new(vec![
            Cell::from(names(&group.coverings, &comparison.rows, |rules| rules.covering)),
            Cell::from(names(&group.tie_breaks, &comparison.rows, |rules| rules.tie_break)),
            Cell::from(names(&group.engines, &comparison.rows, |rules| rules.engine)),
            Cell::new(text, role),
            Cell::from(if ran { row.pivots.to_string() } else { String::new() }),
            Cell::maybe(ran.then(|| p_of(row))),
            Cell::from(row.answer.map_or(String::new(), letter)),
        ]));
    }
    table.write(out, style)?;
    let found = comparison.rows.iter().filter(|row| row.answer.is_some()).count();
    let ran = comparison.rows.iter().filter(|row| row.outcome.is_some()).count();
    let cycled = comparison.rows.iter().filter(|row| row.cycled).count();
    let answers = match comparison.answers {
        0 => "none found an answer".to_owned(),
        1 if found == ran => "all found the same answer".to_owned(),
        1 => format!("{found} of {ran} found an answer, all the same one"),
        n => format!("{found} of {ran} found an answer, {n} different ones"),
    };
    let cycles = match cycled {
        0 => String::new(),
        n => format!("; {n} came back to a working scheme they had met (a cycle)"),
    };
    let text = format!("{answers}{cycles}");
    style.paragraph(out, Role::Plain, &text)
}
