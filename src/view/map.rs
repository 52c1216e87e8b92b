//! The map of two parameters: a picture in letters, and a row for each region.

use std::io::{self, Write};

use super::style::{Role, Style, pad_left};
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::{RayClass, State, Verdict};
use crate::path::map::{Map, Region};
use crate::text::number::{heading, short, with_unit};

/// Rows of the picture.
const HEIGHT: usize = 18;
/// No picture is wider.
const WIDEST: usize = 72;
/// More pairs than this are counted, not named.
const NAMED: usize = 12;

/// What stands beside the picture.
pub struct Labels<'a> {
    /// Unit of each axis.
    pub units: [Option<&'a str>; 2],
    /// The quantity read at the marked places, with its unit.
    pub quantity: Option<(String, Option<String>)>,
}

/// How a region is coloured: no two neighbours in the list alike.
pub fn role(index: usize, region: &Region) -> Role {
    if region.states.is_none() { Role::Muted } else { Role::Series(index) }
}

/// What fills a region: its letter; without an answer a dot; `/` between the letters where other answers exist.
pub fn fill(map: &Map, region: usize, column: usize, row: usize) -> char {
    let found = &map.regions[region];
    if found.states.is_none() {
        return '.';
    }
    if found.has_several() && (column + row).is_multiple_of(2) {
        '/'
    } else {
        found.letter.chars().last().unwrap_or('?')
    }
}

/// The picture, line by line from above; each cell with its region.
pub fn cells(map: &Map, width: usize, height: usize) -> Vec<Vec<Option<usize>>> {
    let at = |column: usize, row: usize| map.region_at(place_of(map, (column, row), width, height));
    (0..height).map(|row| (0..width).map(|column| at(column, row)).collect()).collect()
}

/// Where a region's mark stands in a picture: column and row from above.
pub fn mark(map: &Map, region: usize, width: usize, height: usize) -> (usize, usize) {
    cell(map, map.regions[region].at, width, height)
}

/// Column and row from above of a place in a picture; the nearest one where it lies outside.
pub fn cell(map: &Map, at: [f64; 2], width: usize, height: usize) -> (usize, usize) {
    let share = |axis: usize| {
        let [low, high] = map.axes[axis].range;
        (at[axis] - low) / (high - low)
    };
    let cell = |share: f64, count: usize| ((share * count as f64) as usize).min(count - 1);
    (cell(share(0), width), height - 1 - cell(share(1), height))
}

/// The place in the middle of a cell of a picture, column and row from above.
pub fn place_of(map: &Map, (column, row): (usize, usize), width: usize, height: usize) -> [f64; 2] {
    let at = |axis: usize, k: usize, count: usize| {
        let [low, high] = map.axes[axis].range;
        low + (high - low) * (k as f64 + 0.5) / count as f64
    };
    [at(0, column, width), at(1, height - 1 - row, height)]
}

/// The picture, the regions, the notes.
pub fn write(out: &mut dyn Write, map: &Map, labels: &Labels<'_>, style: &Style) -> io::Result<()> {
    let width = style.width.saturating_sub(gutter(map)).clamp(8, WIDEST);
    picture(out, map, labels, (width, HEIGHT), style)?;
    writeln!(out)?;
    regions(out, map, labels, style)?;
    for note in &map.notes {
        style.paragraph(out, Role::Muted, note)?;
    }
    Ok(())
}

/// Columns left of the plane in a picture, of which the last is its axis, and right of it.
pub fn gutter(map: &Map) -> usize {
    numbers(map) + 4
}

/// Columns of the numbers beside the vertical axis.
fn numbers(map: &Map) -> usize {
    map.axes[1].range.map(|end| short(end).len()).into_iter().max().unwrap_or_default()
}

/// Where the plane stands in a picture: its first column, and its first row, after the name of the axis.
pub fn corner(map: &Map) -> (usize, usize) {
    (numbers(map) + 2, 1)
}

/// Rows of a picture besides those of the plane: the name above, the axis and its numbers below.
pub const AROUND: usize = 3;

/// The plane in letters, of this many columns and rows, with its axes.
pub fn picture(
    out: &mut dyn Write,
    map: &Map,
    labels: &Labels<'_>,
    (width, height): (usize, usize),
    style: &Style,
) -> io::Result<()> {
    let [low, high] = map.axes[1].range.map(short);
    let gutter = numbers(map);
    writeln!(out, "{}", style.paint(Role::Header, &style.text(&heading(&map.axes[1].name, labels.units[1]))))?;
    let rows = cells(map, width, height);
    let marks: Vec<(usize, usize)> = (0..map.regions.len()).map(|region| mark(map, region, width, height)).collect();
    for (row, regions) in rows.iter().enumerate() {
        let label = match row {
            0 => &high,
            row if row + 1 == height => &low,
            _ => "",
        };
        write!(out, "{} {}", pad_left(label, gutter), if style.ascii { '|' } else { '│' })?;
        let mut column = 0;
        while column < width {
            let region = regions[column];
            let run = regions[column..].iter().take_while(|other| **other == region).count();
            let text: String = (column..column + run)
                .map(|column| match region {
                    None => ' ',
                    // The letter of a region without an answer stands at its mark.
                    Some(region) if marks[region] == (column, row) => {
                        map.regions[region].letter.chars().last().unwrap_or('?')
                    }
                    Some(region) => fill(map, region, column, row),
                })
                .collect();
            let role = region.map_or(Role::Plain, |region| role(region, &map.regions[region]));
            write!(out, "{}", style.paint(role, &text))?;
            column += run;
        }
        writeln!(out)?;
    }
    let [low, high] = map.axes[0].range.map(short);
    let line = if style.ascii { "-" } else { "─" };
    writeln!(out, "{} {}{}", " ".repeat(gutter), if style.ascii { '+' } else { '└' }, line.repeat(width))?;
    let name = style.text(&heading(&map.axes[0].name, labels.units[0]));
    let gap = width.saturating_sub(low.len() + high.len() + name.chars().count());
    writeln!(
        out,
        "{}{low}{}{}{}{high}",
        " ".repeat(gutter + 2),
        " ".repeat(gap / 2),
        style.paint(Role::Header, &name),
        " ".repeat(gap - gap / 2)
    )
}

/// `slip+ c5 c6; stick c1 to c4`: the pairs by their states.
pub fn states(states: &[(String, State)]) -> String {
    let mut parts = Vec::new();
    for state in [State::Open, State::Stick, State::SlipPlus, State::SlipMinus, State::Slip, State::Closed] {
        let word = state.word();
        let ids: Vec<&str> = states.iter().filter(|(_, found)| *found == state).map(|(id, _)| id.as_str()).collect();
        if ids.is_empty() {
            continue;
        }
        parts.push(match () {
            () if ids.len() == states.len() => format!("all {word}"),
            () if states.len() > NAMED => format!("{} {word}", ids.len()),
            () => format!("{word} {}", ids.join(" ")),
        });
    }
    parts.join("; ")
}

/// What holds in a region, in words.
pub fn meaning(region: &Region) -> String {
    match &region.states {
        Some(found) => {
            let mut text = states(found);
            if let Some(other) = &region.other {
                text.push_str(&format!("; from the upper end: {}", states(other)));
            }
            match region.answers {
                Some(answers) if answers > 1 => format!("{text} ({answers} answers at the marked place)"),
                _ => text,
            }
        }
        None => {
            let class = region.class.map_or("no answer", RayClass::word);
            let words = [Some(class), region.verdict.map(Verdict::word)];
            let words = words.into_iter().flatten().collect::<Vec<_>>().join(", ");
            region.mode.as_ref().map_or(words.clone(), |mode| format!("{words}: {mode}"))
        }
    }
}

fn regions(out: &mut dyn Write, map: &Map, labels: &Labels<'_>, style: &Style) -> io::Result<()> {
    let unit = |axis: usize| labels.units[axis].map(str::to_owned);
    let area_unit = match labels.units {
        [Some(a), Some(b)] => Some(format!("{a}·{b}")),
        [a, b] => a.or(b).map(str::to_owned),
    };
    let mut columns = vec![
        Column::words(""),
        Column::given("area", area_unit),
        Column::plain(&map.axes[0].name, unit(0)).droppable(2),
        Column::plain(&map.axes[1].name, unit(1)).droppable(2),
    ];
    if let Some((name, unit)) = &labels.quantity {
        columns.push(Column::numbers(name, unit.clone()));
    }
    let mut table = Table::new(columns);
    for (index, region) in map.regions.iter().enumerate() {
        let mut cells = vec![
            Cell::new(region.letter.clone(), role(index, region)),
            Cell::number(region.area),
            Cell::number(region.at[0]),
            Cell::number(region.at[1]),
        ];
        if labels.quantity.is_some() {
            cells.push(match &region.value {
                None => Cell::from("no value"),
                Some(value) => value.as_f64().map_or_else(|| value.as_str().unwrap_or("?").into(), Cell::number),
            });
        }
        table.rows.push(Row::new(cells));
    }
    table.write(out, style)?;
    writeln!(out)?;
    for (index, region) in map.regions.iter().enumerate() {
        for line in style.hanging(&format!("{} ", region.letter), &style.text(&meaning(region))) {
            writeln!(out, "{}", style.paint(role(index, region), &line))?;
        }
    }
    let whole: f64 = map.axes.iter().map(|axis| axis.range[1] - axis.range[0]).product();
    let held: f64 = map.regions.iter().filter(|region| region.states.is_some()).map(|region| region.area).sum();
    let line = match map.regions.iter().filter(|region| region.states.is_none()).count() {
        0 => "an answer in the whole plane".to_owned(),
        none if none == map.regions.len() => "no answer anywhere in the plane".to_owned(),
        _ => format!("an answer in {} % of the plane", short(100.0 * held / whole)),
    };
    writeln!(out, "{}", style.paint(Role::Accent, &line))
}

/// A value with the unit of its axis.
pub fn place(map: &Map, labels: &Labels<'_>, at: [f64; 2]) -> String {
    let one = |axis: usize| format!("{} = {}", map.axes[axis].name, with_unit(&short(at[axis]), labels.units[axis]));
    format!("{}, {}", one(0), one(1))
}
