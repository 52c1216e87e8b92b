//! What `find` found, in words.

use std::io::{self, Write};

use super::path::exact;
use super::style::{Role, Style};
use crate::answer::record::{RayClass, Verdict};
use crate::path::edge::{Edge, Run};
use crate::path::find::{Found, Place};
use crate::text::number::with_unit;

/// What was asked.
pub struct Asked<'a> {
    /// The parameter or load case.
    pub name: &'a str,
    /// Its unit.
    pub unit: Option<&'a str>,
    /// The range searched.
    pub range: [f64; 2],
    /// The condition, as written.
    pub condition: &'a str,
}

/// `F2 = 200 kN`; with a bracket what it lies between.
fn place(asked: &Asked<'_>, place: &Place) -> String {
    let Asked { name, unit, .. } = asked;
    let number = |value: f64| with_unit(&exact(value), *unit);
    let mut text = format!("{name} = {}", number(place.value));
    if let Some([a, b]) = place.bracket {
        text.push_str(&format!(" (between {a} and {b})"));
    }
    let side = |value: &Option<serde_json::Value>| match value {
        None => "no value".to_owned(),
        Some(value) => value.as_f64().map_or_else(|| value.as_str().unwrap_or_default().to_owned(), exact),
    };
    let (below, above) = (side(&place.below), side(&place.above));
    if below != above && place.below.is_some() && place.above.is_some() {
        text.push_str(&format!(": from {below} to {above}"));
    }
    if let Some(change) = &place.change {
        text.push_str(&format!("; {change}"));
    }
    text
}

/// Intervals, then places, then what limits them.
pub fn write(out: &mut dyn Write, asked: &Asked<'_>, found: &Found, style: &Style) -> io::Result<()> {
    let Asked { name, unit, condition, range } = asked;
    let number = |value: f64| with_unit(&exact(value), *unit);
    for [from, to] in &found.holds {
        let text = if from == to {
            format!("{condition} at {name} = {} only", number(*from))
        } else {
            format!("{condition} for {name} from {} to {}", number(*from), number(*to))
        };
        style.paragraph(out, Role::Accent, &text)?;
    }
    if found.holds.is_empty() && found.places.is_empty() {
        let [a, b] = found.covered;
        let text =
            format!("{condition} nowhere for {name} from {} to {}", number(a.max(range[0])), number(b.min(range[1])));
        style.paragraph(out, Role::Warning, &text)?;
    }
    for at in &found.places {
        let role = if found.holds.is_empty() { Role::Accent } else { Role::Plain };
        style.paragraph(out, role, &place(asked, at))?;
    }
    for note in &found.notes {
        style.paragraph(out, Role::Muted, note)?;
    }
    Ok(())
}

/// `f = 0.34: ray, no-equilibrium, certified`.
fn run(name: &str, run: &Run) -> String {
    let words = [Some(run.outcome.word()), run.class.map(RayClass::word), run.verdict.map(Verdict::word)];
    if run.is_polygon_only() {
        return format!("{name} = {}: an answer of the polygon only", run.value);
    }
    let words: Vec<&str> = words.into_iter().flatten().collect();
    format!("{name} = {}: {}", run.value, words.join(", "))
}

/// The least or the most of a parameter under which there is an answer.
pub fn write_edge(
    out: &mut dyn Write,
    (name, which): (&str, &str),
    unit: Option<&str>,
    found: &Edge,
    style: &Style,
) -> io::Result<()> {
    let value = with_unit(&exact(found.value), unit);
    let Some(collapse) = &found.collapse else {
        let text = format!("there is an answer at the end of the range already: {name} = {value}");
        return style.paragraph(out, Role::Accent, &text);
    };
    let how = if found.exact { ", where the path ends" } else { "" };
    style.paragraph(out, Role::Accent, &format!("{which} {name} with an answer: {value}{how}"))?;
    let proved = if collapse.is_proved() { "" } else { " (not proved that there is none)" };
    style.paragraph(out, Role::Plain, &format!("an answer at {}, freshly checked", run(name, &found.answer)))?;
    if let Some(none) = &found.undecided {
        style.paragraph(out, Role::Plain, &format!("none found at {} (not proved)", run(name, none)))?;
    }
    style.paragraph(out, Role::Plain, &format!("no answer at {}{proved}", run(name, collapse)))?;
    if found.beyond {
        let text = "the proof holds for every smaller value: less friction bears no more";
        style.paragraph(out, Role::Muted, text)?;
    }
    Ok(())
}
