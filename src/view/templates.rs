//! The kinds of structures that `new` writes.

use std::io::{self, Write};

use super::style::{Role, Style, pad_left, pad_right};
use crate::model::template::{Choice, Template};
use crate::text::number::in_full;

/// Writes each kind with its title, and beneath it what can be chosen of it: name, value, range, meaning.
pub fn write(out: &mut dyn Write, kinds: &[(&Template, String, Vec<Choice>)], style: &Style) -> io::Result<()> {
    let value = |choice: &Choice| match &choice.unit {
        Some(unit) => format!("{} {unit}", in_full(choice.default)),
        None => in_full(choice.default),
    };
    let range =
        |choice: &Choice| choice.range.map_or(String::new(), |(a, b)| format!("{} … {}", in_full(a), in_full(b)));
    let all = || kinds.iter().flat_map(|(_, _, choices)| choices);
    let widest = |text: &dyn Fn(&Choice) -> String| all().map(|choice| text(choice).chars().count()).max().unwrap_or(0);
    let name = |choice: &Choice| choice.name.clone();
    let (names, values, ranges) = (widest(&name), widest(&value), widest(&range));
    for (template, title, choices) in kinds {
        writeln!(out, "{}  {}", style.paint(Role::Accent, template.kind), style.text(title))?;
        for choice in choices {
            let label = format!(
                "  {}  {}  {}  ",
                pad_right(&choice.name, names),
                pad_right(&value(choice), values),
                pad_left(&range(choice), ranges)
            );
            // the meaning hangs beneath itself where there is room for it, or stands on lines of its own
            let label = style.text(&label);
            let (first, indent) = match label.chars().count() {
                wide if wide + 16 <= style.width => (label, wide),
                _ => (label + "\n      ", 6),
            };
            let lines = style.wrap(&choice.about, style.width.saturating_sub(indent));
            let meaning = lines.join(&format!("\n{}", " ".repeat(indent)));
            for line in format!("{first}{meaning}").lines() {
                writeln!(out, "{}", line.trim_end())?;
            }
        }
    }
    let lines = [
        "",
        "`new KIND NAME=VALUE … FILE` writes one of them; without FILE to KIND.json, which must not be there yet.",
        "The range of a number of parts is what it may be; any other range is that of its slider, and grows with the value.",
    ];
    for line in lines {
        let wrapped = style.wrap(line, style.width.max(1));
        for line in if wrapped.is_empty() { vec![String::new()] } else { wrapped } {
            writeln!(out, "{line}")?;
        }
    }
    Ok(())
}
