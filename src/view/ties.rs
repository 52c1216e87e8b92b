//! Ties of a run, what chose among them, and the degenerate vertices.

use std::io::{self, Write};

use super::style::{Role, Style};
use crate::explain::ties::TieReport;

/// Writes the rule, every pivot with tied rows, and the vertices whose basic variables are zero.
pub fn write(out: &mut dyn Write, report: &TieReport, style: &Style) -> io::Result<()> {
    let line = |out: &mut dyn Write, label: &str, text: &str| -> io::Result<()> {
        for line in style.hanging(&style.text(label), &style.text(text)) {
            writeln!(out, "{line}")?;
        }
        Ok(())
    };
    line(out, "rule       ", &report.rule)?;
    if report.ties.is_empty() {
        let text = match report.pivots {
            0 => "no pivots, no ties".to_owned(),
            1 => "no ties: the pivot was decided by its ratio".to_owned(),
            n => format!("no ties: each of the {n} pivots was decided by its ratio"),
        };
        line(out, "ties       ", &text)?;
    }
    for tie in &report.ties {
        let label = format!("pivot {:<4} ", tie.step);
        let text = format!("{} tied; {} left ({})", tie.tied.join(", "), tie.leaving, tie.reason);
        line(out, &label, &text)?;
    }
    if report.degenerate.is_empty() {
        return line(out, "degenerate ", "no vertex: no basic variable is zero");
    }
    for vertex in &report.degenerate {
        let label = format!("after {:<4} ", vertex.step);
        line(out, &label, &format!("basic at zero: {}", vertex.zeros.join(", ")))?;
    }
    if !report.complete {
        let text = "earlier vertices were not looked at for zeros";
        writeln!(out, "{}", style.paint(Role::Muted, text))?;
    }
    Ok(())
}
