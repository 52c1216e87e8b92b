//! What repeated loading comes to, in words and cycle by cycle.

use std::io::{self, Write};

use super::moment_unit;
use super::path::exact;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::model::units::Units;
use crate::path::cycle::{Cycle, Kind, Turn};
use crate::path::cycle_starts::Starts;
use crate::path::exact_cycle::{MOST_PAIRS as MOST_PROVED_PAIRS, MOST_SCHEMES, Repetition, SlipMap};
use crate::path::shakedown_limit::{Beyond, ShakedownLimit};
use crate::path::static_shakedown::{MOST_PAIRS, Static};
use crate::text::number::{measured, short, with_unit};

/// Cycles shown of a longer list, at its beginning and at its end.
const SHOWN: usize = 6;

/// `shakes down`, …
pub fn word(kind: Kind) -> &'static str {
    match kind {
        Kind::ShakesDown => "shakes down",
        Kind::Alternates => "slips to and fro",
        Kind::Ratchets => "ratchets",
        Kind::Collapses => "collapses",
        Kind::Undecided => "undecided",
    }
}

fn role(kind: Kind) -> Role {
    match kind {
        Kind::ShakesDown => Role::Good,
        Kind::Alternates | Kind::Ratchets | Kind::Undecided => Role::Warning,
        Kind::Collapses => Role::Bad,
    }
}

/// The largest net slip of a cycle and its pair.
fn furthest(turn: &Turn) -> Option<(&str, f64)> {
    let pairs = turn.pairs.iter().map(|pair| (pair.pair.as_str(), pair.net));
    pairs.reduce(|a, b| if b.1.abs() > a.1.abs() { b } else { a })
}

/// The verdict, the cycles, the pairs of the last one.
pub fn write(out: &mut dyn Write, cycle: &Cycle, unit: Option<&str>, units: &Units, style: &Style) -> io::Result<()> {
    let [from, to] = cycle.ends.map(|end| with_unit(&short(end), unit));
    let mut line = format!("{} from {from} to {to} and back: {}", cycle.name, word(cycle.kind));
    if let (Kind::Ratchets, Some((pair, net))) = (cycle.kind, cycle.turns.last().and_then(furthest)) {
        line.push_str(&format!(", {} per cycle at {pair}", measured(net, units.length.as_deref())));
    }
    style.paragraph(out, role(cycle.kind), &line)?;
    style.paragraph(out, Role::Plain, &cycle.sentence)?;
    for text in [repetition(&cycle.repetition), every_start(&cycle.every_start)].into_iter().flatten() {
        style.paragraph(out, Role::Muted, &text)?;
    }
    if cycle.turns.is_empty() {
        return Ok(());
    }
    let energy = moment_unit(units);
    let mut table = Table::new(vec![
        Column::count("cycle"),
        Column::numbers("dissipated there", energy.clone()).of(1),
        Column::numbers("back", energy).of(1),
        Column::numbers("largest net slip", units.length.clone()),
        Column::words("at"),
        Column::numbers("difference", None).droppable(1),
    ]);
    let count = cycle.turns.len();
    for (index, turn) in cycle.turns.iter().enumerate() {
        if count > 2 * SHOWN && (SHOWN..count - SHOWN).contains(&index) {
            continue;
        }
        let (pair, net) = furthest(turn).unwrap_or_default();
        table.rows.push(Row::new(vec![
            Cell::from((index + 1).to_string()),
            Cell::number(turn.dissipated[0]),
            Cell::number(turn.dissipated[1]),
            Cell::number(net),
            Cell::from(if net == 0.0 { String::new() } else { pair.to_owned() }),
            Cell::from(turn.difference.map_or(String::new(), share)),
        ]));
    }
    table.write(out, style)?;
    if count > 2 * SHOWN {
        style.paragraph(out, Role::Muted, &format!("the first and the last {SHOWN} of {count} cycles"))?;
    }
    pairs(out, cycle, units, style)
}

/// A difference as a share of the largest: 0, or how far from it.
fn share(difference: f64) -> String {
    if difference == 0.0 { "0".to_owned() } else { format!("{difference:.1e}") }
}

/// The pairs that move in the last cycle, or hold a slip from before.
fn pairs(out: &mut dyn Write, cycle: &Cycle, units: &Units, style: &Style) -> io::Result<()> {
    let Some(last) = cycle.turns.last() else { return Ok(()) };
    let moved = |pair: &&crate::path::cycle::PairCycle| pair.there != 0.0 || pair.back != 0.0 || pair.total != 0.0;
    let length = || units.length.clone();
    let mut table = Table::new(vec![
        Column::words("pair"),
        Column::numbers("slip there", length()).of(1),
        Column::numbers("back", length()).of(1),
        Column::numbers("net", length()).of(1),
        Column::numbers("total", length()).of(1),
    ]);
    for pair in last.pairs.iter().filter(moved) {
        let numbers = [pair.there, pair.back, pair.net, pair.total];
        let cells = std::iter::once(Cell::from(pair.pair.clone())).chain(numbers.map(Cell::number));
        table.rows.push(Row::new(cells.collect()));
    }
    if table.rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "{}", style.paint(Role::Title, &format!("Cycle {}", cycle.turns.len())))?;
    table.write(out, style)
}

/// What is proved in rationals of the repetition; `None` where there was nothing to prove.
pub fn repetition(found: &Repetition) -> Option<String> {
    let proved = match found {
        Repetition::NotAsked => return None,
        Repetition::TooLarge { pairs, schemes } => {
            return Some(format!(
                "no proof in rationals was tried: {pairs} pairs and {schemes} working schemes are too many (at most \
                 {MOST_PROVED_PAIRS} pairs and {MOST_SCHEMES} schemes)"
            ));
        }
        Repetition::Unproved(why) => {
            return Some(format!("found to the digits of f64, not proved in rationals: {why}"));
        }
        Repetition::Proved(found) => found,
    };
    let map = match proved.map {
        SlipMap::Identical => "; with these schemes a cycle returns every slip as it was".to_owned(),
        SlipMap::Contracting { share, cycles } if share < f64::MIN_POSITIVE => {
            let cycle = if cycles == 1 { "a cycle".to_owned() } else { format!("{cycles} cycles") };
            format!("; with these schemes the slips after {cycle} do not depend on those before")
        }
        SlipMap::Contracting { share, cycles } => {
            let shrink = if cycles == 1 { "a cycle shrinks".to_owned() } else { format!("{cycles} cycles shrink") };
            format!("; with these schemes {shrink} differences of slips to at most {} of them", short(share))
        }
        SlipMap::Open => String::new(),
    };
    Some(format!(
        "proved in rationals, for R and RF as they are stored: a cycle of {} of its working schemes whose contact forces are within \
         {:.0e} of the one followed keeps all the laws at every moment and ends with the forces and gaps with which it began, so \
         that it can repeat for ever{map}",
        proved.schemes, proved.distance
    ))
}

/// What the static theorem says of every start; `None` where it was not asked.
pub fn every_start(found: &Static) -> Option<String> {
    match found {
        Static::NotAsked => None,
        Static::Inapplicable(why) => Some(format!("another start may do otherwise: {why}")),
        Static::TooLarge(pairs) => Some(format!(
            "the static theorem of shakedown was not asked of other starts: {pairs} pairs are too many (at most {MOST_PAIRS})"
        )),
        Static::Nothing => Some("the static theorem of shakedown proves nothing of other starts".to_owned()),
        Static::Proved(_) => Some(
            "from every start it shakes down: some slips leave every pair short of its bound all the time".to_owned(),
        ),
    }
}

/// The same cycle after different starts.
pub fn write_starts(
    out: &mut dyn Write,
    found: &Starts,
    unit: Option<&str>,
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let [from, to] = found.ends.map(|end| with_unit(&short(end), unit));
    let role = if found.decides { Role::Warning } else { Role::Good };
    style.paragraph(
        out,
        Role::Accent,
        &format!("{} from {from} to {to} and back, after different slips", found.name),
    )?;
    style.paragraph(out, role, &found.sentence())?;
    if let Some(text) = every_start(&found.every_start) {
        style.paragraph(out, Role::Muted, &text)?;
    }
    let mut table = Table::new(vec![
        Column::words("start"),
        Column::words("comes to"),
        Column::count("cycles"),
        Column::numbers("dissipated per cycle", moment_unit(units)),
        Column::numbers("largest net slip", units.length.clone()).droppable(1),
    ]);
    for start in &found.starts {
        table.rows.push(Row::new(vec![
            Cell::from(start.start.clone()),
            Cell::from(word(start.kind).to_owned()),
            Cell::from(start.cycles.to_string()),
            Cell::maybe(start.dissipated),
            Cell::maybe(start.net),
        ]));
    }
    table.write(out, style)?;
    for (start, why) in found.starts.iter().filter_map(|start| start.why.as_ref().map(|why| (start, why))) {
        style.paragraph(out, Role::Muted, &format!("{}: {why}", start.start))?;
    }
    Ok(())
}

/// The largest amplitude that shakes down, between two values.
pub fn write_limit(
    out: &mut dyn Write,
    name: &str,
    found: &ShakedownLimit,
    unit: Option<&str>,
    style: &Style,
) -> io::Result<()> {
    // All digits where ten do not tell one end from the next.
    let ends = [found.shakes_down, found.beyond.as_ref().map(|beyond| beyond.value)].map(|end| end.map(exact));
    let is_told = ends[0].is_none() || ends[0] != ends[1];
    let number = |value: f64| with_unit(&if is_told { exact(value) } else { value.to_string() }, unit);
    let from = number(found.from);
    let (shakes_down, beyond) = match (found.shakes_down, &found.beyond) {
        (Some(shakes_down), beyond) => (shakes_down, beyond),
        (None, beyond) => return write_no_end(out, name, (&from, &number(found.towards)), beyond.as_ref(), style),
    };
    let Some(beyond) = beyond else {
        let text = format!("{name} from {from}: shakes down as far as was looked, to {}", number(shakes_down));
        style.paragraph(out, Role::Good, &text)?;
        return write_every_start(out, found, &number, style);
    };
    let seen = if beyond.kind == Kind::Undecided { "found to shake" } else { "that shakes" };
    let text = format!("{name} from {from}: the largest end {seen} down is {}", number(shakes_down));
    style.paragraph(out, Role::Accent, &text)?;
    let mut text = match (&beyond.why, beyond.kind) {
        (Some(why), _) => format!("at {} nothing is decided, for {why}", number(beyond.value)),
        (None, Kind::Undecided) => format!("at {} it is undecided", number(beyond.value)),
        (None, kind) => format!("at {} it {}", number(beyond.value), word(kind)),
    };
    if let Some((value, kind)) = beyond.decided {
        text += &format!("; at {} it {}", number(value), word(kind));
    }
    style.paragraph(out, Role::Plain, &text)?;
    write_every_start(out, found, &number, style)
}

/// No end shakes down: what the history comes to instead.
fn write_no_end(
    out: &mut dyn Write,
    name: &str,
    (from, towards): (&str, &str),
    instead: Option<&Beyond>,
    style: &Style,
) -> io::Result<()> {
    let is_proved = instead.is_some_and(|instead| instead.kind != Kind::Undecided);
    let seen = if is_proved { "shakes down" } else { "was found to shake down" };
    style.paragraph(out, Role::Bad, &format!("{name} from {from} towards {towards}: no end {seen}"))?;
    match instead.and_then(|instead| instead.why.as_ref().map(|why| (instead.kind, why))) {
        Some((Kind::Undecided, why)) => style.paragraph(out, Role::Plain, why),
        Some((kind, why)) => style.paragraph(out, Role::Plain, &format!("it {} {why}", word(kind))),
        None => Ok(()),
    }
}

fn write_every_start(
    out: &mut dyn Write,
    found: &ShakedownLimit,
    number: &dyn Fn(f64) -> String,
    style: &Style,
) -> io::Result<()> {
    let text = match (&found.every_start, every_start(&found.every_start.1)) {
        ((Some(to), _), _) => format!(
            "up to {} it shakes down from every start: some slips leave every pair short of its bound all the time",
            number(*to)
        ),
        (_, Some(text)) => text,
        (_, None) => return Ok(()),
    };
    style.paragraph(out, Role::Muted, &text)
}
