//! The exact check.

use std::io::{self, Write};

use super::style::{Role, Style};
use crate::contact::polygon::{Polygon, degrees};
use crate::contact::schemes::exact_check::{ExactCheck, ExactSign, Finding};
use crate::solve::exact::Exactly;
use crate::text::number::short;

fn signs(signs: &[ExactSign]) -> String {
    let words: Vec<String> = signs.iter().map(|sign| format!("{} = {}", sign.name, short(sign.value))).collect();
    words.join(", ")
}

/// The finding in sentences, and whether it is good.
pub fn sentences(check: &Exactly, names: &[String]) -> (Role, Vec<String>) {
    match check {
        Exactly::Contact(check) => of_contact(check),
        Exactly::Plain(check) => {
            let name = |letter: char, row: usize| format!("{letter}[{}]", names.get(row).map_or("?", String::as_str));
            if !check.unique {
                return (
                    Role::Warning,
                    vec!["not decided: the equations of the basis have no single solution".to_owned()],
                );
            }
            if check.violations.is_empty() {
                let mut lines = vec!["proved: the basis solved in exact arithmetic, all signs hold".to_owned()];
                if !check.zeros.is_empty() {
                    let zeros: Vec<String> = check.zeros.iter().map(|(letter, row)| name(*letter, *row)).collect();
                    lines.push(format!("exactly zero: {}", zeros.join(", ")));
                }
                return (Role::Good, lines);
            }
            let bad: Vec<String> = check
                .violations
                .iter()
                .map(|(letter, row, value)| format!("{} = {}", name(*letter, *row), short(*value)))
                .collect();
            (Role::Bad, vec![format!("refuted in exact arithmetic: {}", bad.join(", "))])
        }
    }
}

fn of_contact(check: &ExactCheck) -> (Role, Vec<String>) {
    let (role, mut lines) = match &check.finding {
        Finding::Proved { zeros } => {
            let mut lines = vec![format!(
                "proved: {} equations solved and {} signs told in exact arithmetic, all hold",
                check.released, check.signs
            )];
            if !zeros.is_empty() {
                let names: Vec<&str> = zeros.iter().map(|sign| sign.name.as_str()).collect();
                lines.push(format!("exactly on a limit: {}", names.join(", ")));
            }
            (Role::Good, lines)
        }
        Finding::Refuted { violations } => (
            Role::Bad,
            vec![
                format!("refuted in exact arithmetic: {}", signs(violations)),
                "values of the size of rounding mean that the data stand at a limit which f64 cannot store exactly"
                    .to_owned(),
            ],
        ),
        Finding::Singular { rank, consistent } => (
            Role::Warning,
            vec![format!(
                "not decided: the {} equations of the working scheme have rank {rank} and {}",
                check.released,
                if *consistent { "many solutions" } else { "no solution" }
            )],
        ),
        Finding::Interrupted => (Role::Warning, vec!["interrupted".to_owned()]),
        Finding::Failed => (Role::Warning, vec!["not decided: the exact solver gave up".to_owned()]),
    };
    lines.extend((check.polygon != Polygon::PLANE).then(|| checked_polygon(check.polygon)));
    (role, lines)
}

/// What friction was in an exact check in space.
fn checked_polygon(polygon: Polygon) -> String {
    let turned = match polygon.turn() {
        0.0 => String::new(),
        turn => format!(" turned by {}", degrees(turn.to_degrees())),
    };
    format!(
        "this is the working scheme on the polygon of {} facets{turned}, each direction taken as the fractions that its \
         components are stored as; the answer on the cone that Newton's method goes on to is not a fraction: `check` has its \
         figures",
        polygon.facets()
    )
}

/// Writes the finding.
pub fn write(out: &mut dyn Write, check: &Exactly, names: &[String], style: &Style) -> io::Result<()> {
    let (role, lines) = sentences(check, names);
    for text in lines {
        style.paragraph(out, role, &text)?;
    }
    Ok(())
}
