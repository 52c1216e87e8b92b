//! Curves over an axis: title, scale with readable values, legend, names at the abscissa.

use std::io::{self, Write};

use unicode_width::UnicodeWidthStr;

use super::Series;
use super::canvas::{Canvas, Stroke};
use super::ticks::{HUGE, Ticks, range};
use crate::text::number::{heading, with_unit};
use crate::view::scale::Scale;
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

/// Which values of the abscissa are written.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Values {
    /// None.
    #[default]
    None,
    /// Those of its ends, lengths.
    Lengths,
    /// Those of its ends, which are typed as they are read: a load factor, a coefficient of friction.
    Typed,
    /// Lengths at these abscissas: where pieces begin and end, each counted from its own beginning.
    Pieces(Vec<(f64, f64)>),
}

/// A chart.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What is drawn.
    pub title: String,
    /// Unit of the ordinates; it stands after the title, with their power of ten.
    pub ordinate: Option<String>,
    /// What is said after the unit.
    pub about: String,
    /// Curves, the first one lowest.
    pub curves: Vec<Curve>,
    /// Names at abscissas, in ascending order; those that find room are shown, first and last before the others.
    pub names: Vec<(f64, String)>,
    /// Abscissas between pieces that are not connected.
    pub breaks: Vec<f64>,
    /// Values at the abscissa.
    pub values: Values,
    /// What the abscissa is.
    pub abscissa: String,
    /// Unit of the abscissa.
    pub unit: Option<String>,
    /// Whether positive ordinates point downwards (bending moments, drawn on the tension side).
    pub inverted: bool,
    /// Rows of the drawing.
    pub height: usize,
}

/// Columns of a piece that is parted from the others by a line.
const NARROWEST: usize = 8;

/// Marker of curve `number`.
pub fn marker(number: usize, style: &Style) -> char {
    const FINE: [char; 6] = ['●', '○', '◆', '◇', '■', '□'];
    const ASCII: [char; 6] = ['*', 'o', '#', '+', 'x', '@'];
    let markers = if style.ascii { ASCII } else { FINE };
    markers[number % markers.len()]
}

/// The axes of a chart.
pub struct Axes {
    /// Ticks of the ordinate.
    pub ticks: Ticks,
    /// The power of ten of the ticks.
    pub scale: Scale,
    /// Least and largest abscissa.
    pub range: (f64, f64),
    /// Whether all ordinates are 0.
    pub flat: bool,
}

impl Axes {
    /// The labels of the ticks.
    pub fn labels(&self) -> Vec<String> {
        self.ticks.values.iter().map(|&value| self.scale.number(value)).collect()
    }
}

impl Chart {
    /// The axes with at most about `count` ticks; `None` where there is nothing to draw.
    pub fn axes(&self, count: impl Fn(bool) -> usize) -> Option<Axes> {
        let points = || {
            self.curves.iter().flat_map(|curve| &curve.series.points).filter(|(x, y)| x.is_finite() && y.is_finite())
        };
        points().next()?;
        let flat = points().all(|&(_, y)| y == 0.0);
        let ticks = Ticks::new(points().map(|&(_, y)| y), count(flat));
        let scale = Scale::of_axis(ticks.values.iter().copied());
        Some(Axes { scale, ticks, range: range(points().map(|&(x, _)| x)), flat })
    }

    /// The title, the unit with its power of ten, and what is said after it.
    pub fn heading(&self, scale: Option<&Scale>, ascii: bool) -> String {
        let unit = scale.map_or(self.ordinate.clone(), |scale| scale.unit(self.ordinate.as_deref(), ascii));
        format!("{}{}", heading(&self.title, unit.as_deref()), self.about)
    }

    /// The heading cut to the columns there are: the title, and what is said after the unit, give way before the unit
    /// does.
    fn fitted_heading(&self, scale: Option<&Scale>, style: &Style) -> String {
        let heading = self.heading(scale, style.ascii);
        let whole = style.text(&heading);
        let behind = &heading[self.title.len()..];
        let unit = &behind[..behind.len() - self.about.len()];
        let with = |end: &str| {
            let end = style.text(end);
            let room = style.width.checked_sub(end.width()).filter(|room| 2 * room > style.width)?;
            Some(style.fit(&style.text(&self.title), room) + &end)
        };
        match whole.width() > style.width {
            true => with(behind).or_else(|| with(unit)).unwrap_or_else(|| style.fit(&whole, style.width)),
            false => whole,
        }
    }

    /// The power of ten of the values at the abscissa.
    pub fn abscissa_scale(&self, (first, last): (f64, f64)) -> Scale {
        match &self.values {
            Values::Typed => Scale::of_typed_axis([first, last]),
            Values::Pieces(places) => Scale::of_axis(places.iter().map(|(_, value)| *value)),
            _ => Scale::of_axis([first, last]),
        }
    }

    /// Writes the chart, `height` rows of drawing and up to five lines around it.
    pub fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        // Nothing but zeros needs no height.
        let height = |flat: bool| if flat { 3 } else { self.height.clamp(3, 200) };
        let axes = self.axes(|flat| (height(flat) / 3).clamp(2, 8));
        let scale = axes.as_ref().map(|axes| &axes.scale);
        writeln!(out, "{}", style.paint(Role::Title, &self.fitted_heading(scale, style)))?;
        let Some(axes) = axes else {
            return writeln!(out, "{}", style.fit("nothing to draw", style.width));
        };
        let rows = height(axes.flat);
        let labels = axes.labels();
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
        let frame = Frame::new(&canvas, &axes, self.inverted);
        self.draw(&mut canvas, &frame, style);
        let mut at_row: Vec<Option<&str>> = vec![None; rows];
        for (value, label) in axes.ticks.values.iter().zip(&labels) {
            if let Some((_, row)) = canvas.cell(0.0, frame.y(*value)) {
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
        let column = |x: f64| canvas.cell(frame.x(x), 0.0).map_or(0, |(column, _)| column);
        self.write_abscissa(out, style, gutter + 2, columns, &column)?;
        self.write_values(out, style, (gutter + 2, columns), axes.range, &column)?;
        self.write_legend(out, style, gutter + 2)
    }

    /// The curves, the zero line and the lines between pieces.
    fn draw(&self, canvas: &mut Canvas, frame: &Frame, style: &Style) {
        let columns = (canvas.dots_x() as usize).div_ceil(2);
        for curve in &self.curves {
            let role = Role::Series(curve.number);
            let finite = curve.series.points.iter().filter(|(x, y)| x.is_finite() && y.is_finite());
            let dots: Vec<(f64, f64)> = finite.map(|&(x, y)| (frame.x(x), frame.y(y))).collect();
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
        let zero = frame.y(0.0);
        let faint: Vec<(f64, f64)> = (0..columns).step_by(2).map(|column| (2.0 * column as f64, zero)).collect();
        canvas.draw_under(Role::Muted, vec![Stroke::Dots(faint)]);
        let height = canvas.dots_y();
        // closer ones would hide what they part
        let parted = columns >= NARROWEST * (self.breaks.len() + 1);
        for x in self.breaks.iter().filter(|_| parted) {
            let x = frame.x(*x);
            canvas.draw_under(Role::Muted, vec![Stroke::Dots(dotted(&[(x, 0.0), (x, height)], 2.0))]);
        }
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
            line.put_at(column(*x), &style.text(name));
        }
        writeln!(out, "{}", format!("{}{}", " ".repeat(indent), line.text()).trim_end())
    }

    /// Values at the abscissa and what it is.
    fn write_values(
        &self,
        out: &mut dyn Write,
        style: &Style,
        (indent, columns): (usize, usize),
        (first, last): (f64, f64),
        column: &dyn Fn(f64) -> usize,
    ) -> io::Result<()> {
        if self.values == Values::None || last <= first {
            return Ok(());
        }
        let scale = self.abscissa_scale((first, last));
        let unit = scale.unit(self.unit.as_deref(), style.ascii);
        let mut write = |line: Slots| {
            let text = format!("{}{}", " ".repeat(indent), line.text());
            writeln!(out, "{}", style.paint(Role::Muted, text.trim_end()))
        };
        let mut line = Slots::new(columns);
        let middle = |line: &mut Slots, text: &str| {
            line.put(columns.saturating_sub(text.width()) / 2, text);
        };
        let abscissa = style.text(&self.abscissa);
        if let Values::Pieces(places) = &self.values {
            let all = places.iter().all(|(x, value)| line.put_at(column(*x), &scale.number(*value)));
            if all && !places.is_empty() {
                write(line)?;
            }
            let mut line = Slots::new(columns);
            middle(&mut line, &style.text(&heading(&self.abscissa, unit.as_deref())));
            return write(line);
        }
        line.put(0, &scale.number(first));
        let right = style.text(&with_unit(&scale.number(last), unit.as_deref()));
        line.put(columns.saturating_sub(right.width()), &right);
        middle(&mut line, &abscissa);
        write(line)
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

/// Where an abscissa and an ordinate stand on a canvas.
struct Frame {
    range: (f64, f64),
    ordinates: (f64, f64),
    size: (f64, f64),
    inverted: bool,
}

impl Frame {
    fn new(canvas: &Canvas, axes: &Axes, inverted: bool) -> Frame {
        let size = (canvas.dots_x(), canvas.dots_y());
        Frame { range: axes.range, ordinates: (axes.ticks.low, axes.ticks.high), size, inverted }
    }

    fn x(&self, x: f64) -> f64 {
        let (first, last) = self.range;
        let share = if last > first { (x.clamp(first, last) - first) / (last - first) } else { 0.5 };
        share * self.size.0
    }

    fn y(&self, y: f64) -> f64 {
        let (low, high) = self.ordinates;
        let share = (y.clamp(-HUGE, HUGE) - low) / (high - low);
        if self.inverted { (1.0 - share) * self.size.1 } else { share * self.size.1 }
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

/// A line into which texts are put where nothing stands yet.
struct Slots {
    cells: Vec<char>,
}

impl Slots {
    fn new(columns: usize) -> Slots {
        Slots { cells: vec![' '; columns] }
    }

    /// Puts `text` around a column; see [`Slots::put`].
    fn put_at(&mut self, column: usize, text: &str) -> bool {
        let start = column.saturating_sub(text.width() / 2);
        self.put(start.min(self.cells.len().saturating_sub(text.width())), text)
    }

    /// Puts `text` at `start` if it and a blank on either side find free room. Texts whose characters are not one
    /// column wide each are left out.
    fn put(&mut self, start: usize, text: &str) -> bool {
        let count = text.chars().count();
        let end = start + count;
        if count == 0 || count != text.width() || end > self.cells.len() {
            return false;
        }
        let around = start.saturating_sub(1)..(end + 1).min(self.cells.len());
        if self.cells[around].iter().any(|c| *c != ' ') {
            return false;
        }
        for (cell, c) in self.cells[start..end].iter_mut().zip(text.chars()) {
            *cell = c;
        }
        true
    }

    fn text(&self) -> String {
        self.cells.iter().collect::<String>().trim_end().to_owned()
    }
}
