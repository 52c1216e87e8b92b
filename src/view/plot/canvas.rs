//! A canvas of characters: fine lines by textplots (Braille, 2 × 4 dots a character), single characters on top.
//! Without Unicode each Braille cell becomes the ASCII character that looks most like it.

use textplots::{Chart, Plot, Shape};
use unicode_width::UnicodeWidthStr;

use crate::view::style::{Role, Style};

/// textplots refuses narrower charts.
const MINIMUM_DOTS: usize = 32;

/// A stroke in dots: x to the right from 0, y upwards from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Stroke {
    /// Joined points.
    Line(Vec<(f64, f64)>),
    /// Separate dots.
    Dots(Vec<(f64, f64)>),
}

/// A canvas of `columns` × `rows` characters.
#[derive(Clone, Debug)]
pub struct Canvas {
    columns: usize,
    rows: usize,
    cells: Vec<Option<(char, Role)>>,
    inks: Vec<Ink>,
    labels: Vec<Label>,
}

/// Strokes of one colour.
#[derive(Clone, Debug)]
struct Ink {
    role: Role,
    strokes: Vec<Stroke>,
    /// Only in characters that nothing else has used.
    under: bool,
}

/// A word near a character, if there is room.
#[derive(Clone, Debug)]
struct Label {
    column: usize,
    row: usize,
    text: String,
    role: Role,
}

impl Canvas {
    /// An empty canvas of at least one character.
    pub fn new(columns: usize, rows: usize) -> Canvas {
        let (columns, rows) = (columns.max(1), rows.max(1));
        Canvas { columns, rows, cells: vec![None; columns * rows], inks: Vec::new(), labels: Vec::new() }
    }

    /// Largest x of a dot, in dots.
    pub fn dots_x(&self) -> f64 {
        (2 * self.columns - 1) as f64
    }

    /// Largest y of a dot, in dots.
    pub fn dots_y(&self) -> f64 {
        (4 * self.rows - 1) as f64
    }

    /// Adds strokes of one colour; later ones give a shared character its colour.
    pub fn draw(&mut self, role: Role, strokes: Vec<Stroke>) {
        self.inks.push(Ink { role, strokes, under: false });
    }

    /// Adds strokes that stay out of every character already drawn in: faint lines that must not blur others.
    /// They are drawn after all those of [`Canvas::draw`], in their own order.
    pub fn draw_under(&mut self, role: Role, strokes: Vec<Stroke>) {
        self.inks.push(Ink { role, strokes, under: true });
    }

    /// Writes `text` below (else above) the character at the dot (x, y), where all of its place is free.
    pub fn label(&mut self, x: f64, y: f64, text: &str, role: Role) {
        if let Some((column, row)) = self.cell(x, y) {
            self.labels.push(Label { column, row, text: text.to_owned(), role });
        }
    }

    /// Puts a character over whatever is at the dot (x, y).
    pub fn put(&mut self, x: f64, y: f64, c: char, role: Role) {
        if let Some((column, row)) = self.cell(x, y) {
            self.cells[row * self.columns + column] = Some((c, role));
        }
    }

    /// Character at the dot (x, y): (column, row from the top).
    pub fn cell(&self, x: f64, y: f64) -> Option<(usize, usize)> {
        if !x.is_finite() || !y.is_finite() {
            return None;
        }
        let x = x.round().clamp(0.0, self.dots_x()) as usize;
        let y = y.round().clamp(0.0, self.dots_y()) as usize;
        Some((x / 2, self.rows - 1 - y / 4))
    }

    /// The lines of the canvas, painted, without blanks at their ends.
    pub fn lines(&self, style: &Style) -> Vec<String> {
        let mut dots: Vec<(u8, Role)> = vec![(0, Role::Plain); self.columns * self.rows];
        let above = self.inks.iter().filter(|ink| !ink.under);
        for ink in above.chain(self.inks.iter().filter(|ink| ink.under)) {
            for (index, bits) in self.raster(&ink.strokes) {
                let cell = &mut dots[index];
                if !(ink.under && cell.0 != 0) {
                    *cell = (cell.0 | bits, ink.role);
                }
            }
        }
        let mut over = self.cells.clone();
        // All labels or, where they do not all find room, the first and the last: some of them at random places
        // would only puzzle.
        let mut labelled = over.clone();
        if self.labels.iter().all(|label| self.place(label, &mut labelled, &dots)) {
            over = labelled;
        } else {
            for label in self.labels.first().into_iter().chain(self.labels.last()) {
                self.place(label, &mut over, &dots);
            }
        }
        let character = |index: usize| -> (char, Role) {
            match (over[index], dots[index]) {
                (Some(over), _) => over,
                (None, (0, _)) => (' ', Role::Plain),
                (None, (ink, role)) if style.ascii => (ascii(ink), role),
                // Every u8 above U+2800 is a Braille pattern.
                (None, (ink, role)) => (char::from_u32(0x2800 + u32::from(ink)).unwrap_or(' '), role),
            }
        };
        (0..self.rows)
            .map(|row| {
                let cells: Vec<(char, Role)> =
                    (0..self.columns).map(|column| character(row * self.columns + column)).collect();
                paint_runs(&cells, style)
            })
            .collect()
    }

    /// Puts a label into `over` where it and a blank on either side find free cells; says whether it did.
    fn place(&self, label: &Label, over: &mut [Option<(char, Role)>], dots: &[(u8, Role)]) -> bool {
        let length = label.text.chars().count();
        if length == 0 || length != label.text.width() || length > self.columns {
            return false;
        }
        let start = label.column.saturating_sub(length / 2).min(self.columns - length);
        let around = start.saturating_sub(1)..(start + length + 1).min(self.columns);
        let rows = [label.row.checked_add(1), label.row.checked_sub(1)];
        for row in rows.into_iter().flatten().filter(|row| *row < self.rows) {
            let free = around.clone().all(|column| {
                let index = row * self.columns + column;
                over[index].is_none() && dots[index].0 == 0
            });
            if free {
                let from = row * self.columns + start;
                for (cell, c) in over[from..].iter_mut().zip(label.text.chars()) {
                    *cell = Some((c, label.role));
                }
                return true;
            }
        }
        false
    }

    /// Braille dots of `strokes` as textplots draws them: characters and their bytes. Only the part of the canvas that they
    /// reach into is drawn: an arrow costs what an arrow takes.
    fn raster(&self, strokes: &[Stroke]) -> Vec<(usize, u8)> {
        let place = |&(x, y): &(f64, f64)| (x.round().clamp(0.0, self.dots_x()), y.round().clamp(0.0, self.dots_y()));
        let placed = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
            points.iter().filter(|(x, y)| x.is_finite() && y.is_finite()).map(place).collect()
        };
        let placed: Vec<(bool, Vec<(f64, f64)>)> = strokes
            .iter()
            .map(|stroke| match stroke {
                Stroke::Line(points) => (true, placed(points)),
                Stroke::Dots(points) => (false, placed(points)),
            })
            .collect();
        let all = || placed.iter().flat_map(|(_, points)| points);
        if all().next().is_none() {
            return Vec::new();
        }
        // characters that the dots lie in: from the left, from below
        let reach = |axis: fn(&(f64, f64)) -> f64, dots: f64| {
            let characters = || all().map(|point| (axis(point) / dots) as usize);
            (characters().min().unwrap_or(0), characters().max().unwrap_or(0))
        };
        let ((left, right), (low, high)) = (reach(|point| point.0, 2.0), reach(|point| point.1, 4.0));
        let width = (2 * (right - left + 1)).max(MINIMUM_DOTS) as u32;
        let height = 4 * (high - low + 1) as u32;
        // textplots counts y from below and leaves the dot row 0 to the line under the chart: hence the 1.
        let inside = |(x, y): &(f64, f64)| ((x - (2 * left) as f64) as f32, (y - (4 * low) as f64) as f32 + 1.0);
        let points: Vec<(bool, Vec<(f32, f32)>)> = placed
            .iter()
            .map(|(joined, points)| (*joined && points.len() > 1, points.iter().map(inside).collect()))
            .collect();
        let shapes: Vec<Shape<'_>> = points
            .iter()
            .map(|(joined, points)| if *joined { Shape::Lines(points) } else { Shape::Points(points) })
            .collect();
        let mut chart = Chart::new_with_y_range(width, height, 0.0, width as f32, 0.0, height as f32);
        let mut chart = &mut chart;
        for shape in &shapes {
            chart = chart.lineplot(shape);
        }
        chart.figures();
        let mut cells = Vec::new();
        for (line, row) in chart.frame().lines().zip((low..=high).rev()) {
            for (c, column) in line.chars().zip(left..=right) {
                if ('\u{2801}'..='\u{28ff}').contains(&c) {
                    cells.push(((self.rows - 1 - row) * self.columns + column, (c as u32 - 0x2800) as u8));
                }
            }
        }
        cells
    }
}

/// A row of characters with as few colour changes as possible.
pub fn paint_runs(cells: &[(char, Role)], style: &Style) -> String {
    let end = cells.iter().rposition(|(c, _)| *c != ' ').map_or(0, |last| last + 1);
    let mut line = String::new();
    let mut run = String::new();
    let mut role = Role::Plain;
    for &(c, next) in &cells[..end] {
        if next != role && c != ' ' {
            line.push_str(&style.paint(role, &run));
            run.clear();
            role = next;
        }
        run.push(c);
    }
    line.push_str(&style.paint(role, &run));
    line
}

/// The ASCII character most like a Braille pattern.
fn ascii(ink: u8) -> char {
    // Bits of the left and the right column, from the top.
    const LEFT: [u8; 4] = [0x01, 0x02, 0x04, 0x40];
    const RIGHT: [u8; 4] = [0x08, 0x10, 0x20, 0x80];
    let mean = |bits: [u8; 4]| {
        let set: Vec<usize> = (0..4).filter(|&i| ink & bits[i] != 0).collect();
        let count = set.len();
        (count, set.iter().sum::<usize>() as f64 / count.max(1) as f64)
    };
    let ((left, left_at), (right, right_at)) = (mean(LEFT), mean(RIGHT));
    let rise = left_at - right_at;
    let level = (left_at + right_at) / 2.0;
    match (left, right) {
        (l, r) if l + r >= 6 => '#',
        (0, r) if r >= 3 => '|',
        (l, 0) if l >= 3 => '|',
        (0, _) => dot(right_at),
        (_, 0) => dot(left_at),
        // Two lines one above the other.
        (l, r) if l + r >= 4 && rise.abs() < 0.6 => '=',
        (l, r) if l + r >= 3 && rise >= 1.4 => '/',
        (l, r) if l + r >= 3 && rise <= -1.4 => '\\',
        _ if level < 0.75 => '\'',
        _ if level < 1.75 || (rise == 0.0 && level < 2.5) => '-',
        _ if level < 2.75 => '.',
        _ => '_',
    }
}

fn dot(at: f64) -> char {
    if at < 0.75 {
        '\''
    } else if at < 1.75 {
        ':'
    } else {
        '.'
    }
}
