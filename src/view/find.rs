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

fn sentence(out: &mut dyn Write, text: &str, role: Role, style: &Style) -> io::Result<()> {
    for line in style.wrap(&style.text(text), style.width) {
        writeln!(out, "{}", style.paint(role, &line))?;
    }
    Ok(())
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
        let text = format!("{condition} for {name} from {} to {}", number(*from), number(*to));
        sentence(out, &text, Role::Accent, style)?;
    }
    if found.holds.is_empty() && found.places.is_empty() {
        let [a, b] = found.covered;
        let text =
            format!("{condition} nowhere for {name} from {} to {}", number(a.max(range[0])), number(b.min(range[1])));
        sentence(out, &text, Role::Warning, style)?;
    }
    for at in &found.places {
        let role = if found.holds.is_empty() { Role::Accent } else { Role::Plain };
        sentence(out, &place(asked, at), role, style)?;
    }
    for note in &found.notes {
        sentence(out, note, Role::Muted, style)?;
    }
    Ok(())
}

/// `f = 0.34: ray, no-equilibrium, certified`.
fn run(name: &str, run: &Run) -> String {
    let words = [Some(run.outcome.word()), run.class.map(RayClass::word), run.verdict.map(Verdict::word)];
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
        return sentence(out, &text, Role::Accent, style);
    };
    let how = if found.exact { ", where the path ends" } else { "" };
    sentence(out, &format!("{which} {name} with an answer: {value}{how}"), Role::Accent, style)?;
    let proved = if collapse.is_proved() { "" } else { " (not proved that there is none)" };
    sentence(out, &format!("an answer at {}, freshly checked", run(name, &found.answer)), Role::Plain, style)?;
    sentence(out, &format!("no answer at {}{proved}", run(name, collapse)), Role::Plain, style)?;
    if found.beyond {
        let text = "the proof holds for every smaller value: less friction bears no more";
        sentence(out, text, Role::Muted, style)?;
    }
    Ok(())
}
