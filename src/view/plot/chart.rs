//! Curves over an axis: title, scale with readable values, legend, names at the abscissa.

use std::io::{self, Write};

use unicode_width::UnicodeWidthStr;

use super::Series;
use super::canvas::{Canvas, Stroke};
use crate::view::number::{short, with_unit};
use crate::view::style::{Role, Style, pad_left};

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// Joined points, each with the curve's marker.
    Marked,
    /// Joined points without markers.
    Plain,
    /// Markers that nothing joins.
    Points,
    /// A dotted line without markers, for bounds.
    Dotted,
}

/// A curve and its look.
#[derive(Clone, Debug)]
pub struct Curve {
    /// The data.
    pub series: Series,
    /// Marker and colour: curves of one number belong together.
    pub number: usize,
    /// How it is drawn.
    pub line: Line,
}

/// A chart.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// Its title; the unit of the ordinates belongs in it.
    pub title: String,
    /// Curves, the first one lowest.
    pub curves: Vec<Curve>,
    /// Names at abscissas, in ascending order; those that find room are shown, first and last before the others.
    pub names: Vec<(f64, String)>,
    /// Whether the values of the abscissas are shown at both ends.
    pub values: bool,
    /// What the abscissa is, with its unit.
    pub abscissa: String,
    /// Unit of the abscissa.
    pub unit: Option<String>,
    /// Whether positive ordinates point downwards (bending moments, drawn on the tension side).
    pub inverted: bool,
    /// Rows of the drawing.
    pub height: usize,
}

/// Values beyond this are cut: sums and differences of them stay finite.
const HUGE: f64 = 1e300;
/// Ranges below this cannot be divided into ticks any more.
const TINY: f64 = 1e-290;

/// Marker of curve `number`.
pub fn marker(number: usize, style: &Style) -> char {
    const FINE: [char; 6] = ['●', '○', '◆', '◇', '■', '□'];
    const ASCII: [char; 6] = ['*', 'o', '#', '+', 'x', '@'];
    let markers = if style.ascii { ASCII } else { FINE };
    markers[number % markers.len()]
}

impl Chart {
    /// Writes the chart, `height` rows of drawing and up to four lines around it.
    pub fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        let title = style.fit(&style.text(&self.title), style.width);
        writeln!(out, "{}", style.paint(Role::Title, &title))?;
        let points = || {
            self.curves.iter().flat_map(|curve| &curve.series.points).filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        if points().next().is_none() {
            return writeln!(out, "{}", style.fit("nothing to draw", style.width));
        }
        // Nothing but zeros needs no height.
        let flat = points().all(|&(_, y)| y == 0.0);
        let rows = if flat { 3 } else { self.height.clamp(3, 200) };
        let ticks = Ticks::new(points().map(|&(_, y)| y), (rows / 3).clamp(2, 8));
        let labels: Vec<String> = ticks.values.iter().map(|&value| short(value)).collect();
        let gutter = labels.iter().map(|label| label.width()).max().unwrap_or(0);
        // Label, blank, axis; at least a few columns must remain for the drawing.
        let (gutter, columns) = match style.width.checked_sub(gutter + 2) {
            Some(columns) if columns >= 8 => (gutter, columns),
            _ => {
                let text = format!("no room for a drawing in {} columns", style.width);
                return writeln!(out, "{}", style.fit(&text, style.width));
            }
        };

        let mut canvas = Canvas::new(columns, rows);
        let (first, last) = range(points().map(|&(x, _)| x));
        // Half a character from the ends, so that markers stand where their point is.
        let width = canvas.dots_x();
        let to_x = |x: f64| {
            if last > first { (x.clamp(first, last) - first) / (last - first) * width } else { width / 2.0 }
        };
        let height = canvas.dots_y();
        let to_y = |y: f64| {
            let share = (y.clamp(-HUGE, HUGE) - ticks.low) / (ticks.high - ticks.low);
            if self.inverted { (1.0 - share) * height } else { share * height }
        };
        for curve in &self.curves {
            let role = Role::Series(curve.number);
            let dots: Vec<(f64, f64)> = curve
                .series
                .points
                .iter()
                .filter(|(x, y)| x.is_finite() && y.is_finite())
                .map(|&(x, y)| (to_x(x), to_y(y)))
                .collect();
            match curve.line {
                Line::Dotted => {
                    canvas.draw_under(role, vec![Stroke::Dots(dotted(&dots, 4.0))]);
                }
                Line::Plain => canvas.draw(role, vec![Stroke::Line(dots)]),
                Line::Marked | Line::Points => {
                    let stride = dots.len().div_ceil((columns / 4).max(1)).max(1);
                    let mark = marker(curve.number, style);
                    for &(x, y) in dots.iter().step_by(stride) {
                        canvas.put(x, y, mark, role);
                    }
                    if curve.line == Line::Marked {
                        canvas.draw(role, vec![Stroke::Line(dots)]);
                    }
                }
            }
        }

        // The zero line, faint.
        let zero = to_y(0.0);
        let faint: Vec<(f64, f64)> = (0..columns).step_by(2).map(|column| (2.0 * column as f64, zero)).collect();
        canvas.draw_under(Role::Muted, vec![Stroke::Dots(faint)]);

        let mut at_row: Vec<Option<&str>> = vec![None; rows];
        for (value, label) in ticks.values.iter().zip(&labels) {
            if let Some((_, row)) = canvas.cell(0.0, to_y(*value)) {
                at_row[row] = Some(label);
            }
        }
        for (row, line) in canvas.lines(style).iter().enumerate() {
            let (label, axis) = match (at_row[row], style.ascii) {
                (Some(label), true) => (label, '+'),
                (Some(label), false) => (label, '┤'),
                (None, true) => ("", '|'),
                (None, false) => ("", '│'),
            };
            let label = pad_left(label, gutter);
            let axis = style.paint(Role::Muted, &axis.to_string());
            writeln!(out, "{label} {axis}{line}")?;
        }
        self.write_abscissa(out, style, gutter + 2, columns, &|x| {
            canvas.cell(to_x(x), 0.0).map_or(0, |(column, _)| column)
        })?;
        if self.values && last > first {
            let unit = self.unit.as_deref();
            let (left, right) = (short(first), with_unit(&short(last), unit));
            let mut line = Slots::new(columns);
            line.put(0, &style.text(&left));
            let right = style.text(&right);
            line.put(columns.saturating_sub(right.width()), &right);
            let middle = style.text(&self.abscissa);
            line.put(columns.saturating_sub(middle.width()) / 2, &middle);
            let text = format!("{}{}", " ".repeat(gutter + 2), line.text());
            writeln!(out, "{}", style.paint(Role::Muted, text.trim_end()))?;
        }
        self.write_legend(out, style, gutter + 2)
    }

    /// The axis with a tick at every name, and the names that find room.
    fn write_abscissa(
        &self,
        out: &mut dyn Write,
        style: &Style,
        indent: usize,
        columns: usize,
        column: &dyn Fn(f64) -> usize,
    ) -> io::Result<()> {
        let (corner, plain, tick) = if style.ascii { ('+', '-', '+') } else { ('└', '─', '┴') };
        let mut axis = vec![plain; columns];
        // Ticks closer than every third character say nothing.
        if 3 * self.names.len() <= columns.max(9) {
            for (x, _) in &self.names {
                axis[column(*x).min(columns - 1)] = tick;
            }
        }
        let axis: String = std::iter::once(corner).chain(axis).collect();
        let axis = style.paint(Role::Muted, &axis);
        writeln!(out, "{}{axis}", " ".repeat(indent - 1))?;
        if self.names.is_empty() {
            return Ok(());
        }
        let mut line = Slots::new(columns);
        let last = self.names.len() - 1;
        let order = [0, last].into_iter().chain(1..last.max(1));
        for index in order {
            let (x, name) = &self.names[index];
            let name = style.text(name);
            let start = column(*x).saturating_sub(name.width() / 2);
            line.put(start.min(columns.saturating_sub(name.width())), &name);
        }
        writeln!(out, "{}", format!("{}{}", " ".repeat(indent), line.text()).trim_end())
    }

    fn write_legend(&self, out: &mut dyn Write, style: &Style, indent: usize) -> io::Result<()> {
        let (marked, dotted): (Vec<&Curve>, Vec<&Curve>) = self
            .curves
            .iter()
            .filter(|curve| !curve.series.label.is_empty())
            .partition(|curve| curve.line != Line::Dotted);
        let entries: Vec<(char, Role, String)> = marked
            .into_iter()
            .chain(dotted)
            .map(|curve| {
                let sign = match (curve.line, style.ascii) {
                    (Line::Dotted, true) => ':',
                    (Line::Dotted, false) => '┈',
                    _ => marker(curve.number, style),
                };
                (sign, Role::Series(curve.number), style.text(&curve.series.label))
            })
            .collect();
        write_legend(out, &entries, indent, style)
    }
}

/// Writes `sign name` entries in as many lines as they need.
pub fn write_legend(
    out: &mut dyn Write,
    entries: &[(char, Role, String)],
    indent: usize,
    style: &Style,
) -> io::Result<()> {
    let indent = indent.min(style.width / 3);
    let mut line = String::new();
    let mut used = indent;
    for (sign, role, name) in entries {
        let name = style.fit(name, style.width.saturating_sub(indent + 2));
        let width = 2 + name.width();
        if used > indent && used + 3 + width > style.width {
            writeln!(out, "{}{line}", " ".repeat(indent))?;
            line.clear();
            used = indent;
        }
        if used > indent {
            line.push_str("   ");
            used += 3;
        }
        line.push_str(&style.paint(*role, &sign.to_string()));
        line.push(' ');
        line.push_str(&name);
        used += width;
    }
    if !line.is_empty() {
        writeln!(out, "{}{line}", " ".repeat(indent))?;
    }
    Ok(())
}

/// Dots `pitch` apart along a polyline.
pub fn dotted(points: &[(f64, f64)], pitch: f64) -> Vec<(f64, f64)> {
    let mut dots: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
    let mut left = pitch;
    for ends in points.windows(2) {
        let ((x0, y0), (x1, y1)) = (ends[0], ends[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        if !length.is_finite() {
            continue;
        }
        let mut at = left;
        while at <= length {
            let share = at / length;
            dots.push((x0 + share * (x1 - x0), y0 + share * (y1 - y0)));
            at += pitch;
        }
        left = at - length;
    }
    dots
}

/// Smallest and largest, cut to what can be computed with.
pub fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    (low.clamp(-HUGE, HUGE), high.clamp(-HUGE, HUGE))
}

/// A scale that holds 0 and all values and ends at ticks 1, 2 or 5 × 10^k apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// The ticks, both ends among them.
    pub values: Vec<f64>,
}

impl Ticks {
    /// At most about `count` + 1 ticks.
    pub fn new(values: impl Iterator<Item = f64>, count: usize) -> Ticks {
        let (low, high) = range(values.filter(|value| value.is_finite()).chain([0.0]));
        if high - low < TINY {
            // All zero: a scale of no size would divide by zero; only its 0 is named.
            return Ticks { low: -1.0, high: 1.0, values: vec![0.0] };
        }
        let step = round_step((high - low) / count.max(1) as f64);
        let first = (low / step + 1e-9).floor() as i64;
        let last = (high / step - 1e-9).ceil() as i64;
        Ticks {
            low: first as f64 * step,
            high: last as f64 * step,
            values: (first..=last).map(|i| i as f64 * step).collect(),
        }
    }
}

/// The least of 1, 2 or 5 × 10^k that is not less than `rough`.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powi(rough.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= rough * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// Round places between two values, at most about `count`; none where they are too close to tell apart.
pub fn round_places(low: f64, high: f64, count: usize) -> Vec<f64> {
    if high - low < TINY {
        return Vec::new();
    }
    let step = round_step((high - low) / count.max(1) as f64);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A line into which texts are put where nothing stands yet.
struct Slots {
    cells: Vec<char>,
}

impl Slots {
    fn new(columns: usize) -> Slots {
        Slots { cells: vec![' '; columns] }
    }

    /// Puts `text` at `start` if it and a blank on either side find free room. Texts whose characters are not one
    /// column wide each are left out.
    fn put(&mut self, start: usize, text: &str) {
        let count = text.chars().count();
        let end = start + count;
        if count == 0 || count != text.width() || end > self.cells.len() {
            return;
        }
        let around = start.saturating_sub(1)..(end + 1).min(self.cells.len());
        if self.cells[around].iter().any(|c| *c != ' ') {
            return;
        }
        for (cell, c) in self.cells[start..end].iter_mut().zip(text.chars()) {
            *cell = c;
        }
    }

    fn text(&self) -> String {
        self.cells.iter().collect::<String>().trim_end().to_owned()
    }
}
