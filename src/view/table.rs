//! A small table writer: aligned columns with units, fitted to the width by leaving out whole columns.

use std::io::{self, Write};

use unicode_width::UnicodeWidthStr;

use super::style::{Role, Style, pad_left, pad_right};

/// Where the text of a cell stands in its column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// At the left.
    Left,
    /// At the right.
    Right,
    /// Decimal points below each other.
    Decimal,
}

/// One column.
#[derive(Clone, Debug)]
pub struct Column {
    pub(super) head: String,
    pub(super) unit: Option<String>,
    pub(super) align: Align,
    rank: u8,
}

impl Column {
    /// Left-aligned words.
    pub fn words(head: &str) -> Column {
        Column { head: head.into(), unit: None, align: Align::Left, rank: 0 }
    }

    /// Counters, at the right.
    pub fn count(head: &str) -> Column {
        Column { align: Align::Right, ..Column::words(head) }
    }

    /// Numbers with their unit.
    pub fn numbers(head: &str, unit: Option<String>) -> Column {
        Column { unit, align: Align::Decimal, ..Column::words(head) }
    }

    /// May be left out where the table is too wide; the highest rank goes first, 0 stays to the last.
    pub fn droppable(mut self, rank: u8) -> Column {
        self.rank = rank;
        self
    }
}

/// Text of a cell and its colour.
#[derive(Clone, Debug)]
pub struct Cell {
    pub(super) text: String,
    role: Role,
}

impl Cell {
    /// Coloured text.
    pub fn new(text: impl Into<String>, role: Role) -> Cell {
        Cell { text: text.into(), role }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Cell {
        Cell::new(text, Role::Plain)
    }
}

/// One row.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// As many as there are columns.
    pub cells: Vec<Cell>,
    /// A sentence beneath the row.
    pub beneath: Option<String>,
    /// Whether the row is the present position.
    pub marked: bool,
}

impl Row {
    /// A row of cells.
    pub fn new(cells: Vec<Cell>) -> Row {
        Row { cells, ..Row::default() }
    }
}

/// A table.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows.
    pub rows: Vec<Row>,
}

/// Blanks between columns.
const GAP: usize = 2;

impl Table {
    /// An empty table.
    pub fn new(columns: Vec<Column>) -> Table {
        Table { columns, rows: Vec::new() }
    }

    /// Writes the table: heads, units (if any), rows. Columns that find no room are named beneath it.
    pub fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        let columns: Vec<Printed> = (0..self.columns.len()).map(|index| self.printed(index, style)).collect();
        let gutter = if self.rows.iter().any(|row| row.marked) { 2 } else { 0 };
        let room = style.width.saturating_sub(gutter);
        let all: usize = columns.iter().map(|column| column.width).sum();
        let gaps = columns.len().saturating_sub(1);
        // One blank between columns if that saves one from being left out.
        let tight = all + GAP * gaps > room && all + gaps <= room;
        let gap = if tight { 1 } else { GAP };
        let shown = self.shown(&columns, room, gap);
        let units = shown.iter().any(|&(i, _)| !columns[i].unit.is_empty());

        let head = |text: fn(&Printed) -> &str, role: Role, out: &mut dyn Write| {
            let cells: Vec<(String, usize, Align, Role)> = shown
                .iter()
                .map(|&(i, width)| {
                    let align = self.columns[i].align;
                    (text(&columns[i]).to_owned(), width, align, role)
                })
                .collect();
            write_line(out, (gutter, gap), None, &cells, style)
        };
        head(|column| &column.head, Role::Header, out)?;
        if units {
            head(|column| &column.unit, Role::Muted, out)?;
        }
        for (index, row) in self.rows.iter().enumerate() {
            let cells: Vec<(String, usize, Align, Role)> = shown
                .iter()
                .map(|&(i, width)| {
                    let text = columns[i].cells[index].clone();
                    let role = row.cells.get(i).map_or(Role::Plain, |cell| cell.role);
                    (text, width, self.columns[i].align, role)
                })
                .collect();
            let mark = row.marked.then(|| style.mark());
            write_line(out, (gutter, gap), mark, &cells, style)?;
            if let Some(sentence) = &row.beneath {
                let indent = (gutter + 4).min(style.width / 4);
                for line in style.wrap(sentence, style.width - indent) {
                    writeln!(out, "{}{}", " ".repeat(indent), style.paint(Role::Muted, &line))?;
                }
            }
        }
        let left_out: Vec<&str> = (0..columns.len())
            .filter(|i| !shown.iter().any(|(shown, _)| shown == i))
            .map(|i| columns[i].head.as_str())
            .collect();
        if !left_out.is_empty() {
            let text = format!("(no room for {})", left_out.join(", "));
            for line in style.wrap(&text, style.width) {
                writeln!(out, "{}", style.paint(Role::Muted, &line))?;
            }
        }
        Ok(())
    }

    fn printed(&self, index: usize, style: &Style) -> Printed {
        let column = &self.columns[index];
        let mut cells: Vec<String> = self
            .rows
            .iter()
            .map(|row| row.cells.get(index).map_or_else(String::new, |cell| style.text(&cell.text)))
            .collect();
        if column.align == Align::Decimal {
            align_decimals(&mut cells);
        }
        let head = style.text(&column.head);
        let unit = column.unit.as_ref().map_or_else(String::new, |unit| style.text(unit));
        let width = cells.iter().map(|cell| cell.width()).chain([head.width(), unit.width()]).max().unwrap_or(0);
        Printed { head, unit, cells, width }
    }

    /// Columns that are shown, with their widths: whole ones as long as that is possible; then words are cut.
    fn shown(&self, columns: &[Printed], width: usize, gap: usize) -> Vec<(usize, usize)> {
        let total = |shown: &[(usize, usize)]| {
            shown.iter().map(|(_, width)| width).sum::<usize>() + gap * shown.len().saturating_sub(1)
        };
        let mut shown: Vec<(usize, usize)> =
            columns.iter().enumerate().map(|(index, column)| (index, column.width)).collect();
        while total(&shown) > width {
            let last = shown.iter().enumerate().max_by_key(|(place, (index, _))| (self.columns[*index].rank, *place));
            match last {
                Some((place, (index, _))) if self.columns[*index].rank > 0 => {
                    shown.remove(place);
                }
                _ => break,
            }
        }
        // Words give way next; a number is never cut, its column goes.
        while total(&shown) > width {
            let excess = total(&shown) - width;
            let widest = shown
                .iter_mut()
                .filter(|(index, width)| self.columns[*index].align == Align::Left && *width > 6)
                .max_by_key(|(_, width)| *width);
            match widest {
                Some((_, width)) => *width -= excess.min(*width - 6),
                None => break,
            }
        }
        while total(&shown) > width && shown.len() > 1 {
            shown.pop();
        }
        if let [(_, only)] = shown.as_mut_slice() {
            *only = (*only).min(width);
        }
        shown
    }
}

/// A column ready for printing.
struct Printed {
    head: String,
    unit: String,
    cells: Vec<String>,
    width: usize,
}

/// Pads numbers so that their decimal points (or the ends of their integers) stand below each other.
fn align_decimals(cells: &mut [String]) {
    let integer = |cell: &str| cell.find(['.', 'e']).unwrap_or(cell.len());
    let is_number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let before = cells.iter().filter(|cell| is_number(cell)).map(|cell| integer(cell)).max().unwrap_or(0);
    let after = cells.iter().filter(|cell| is_number(cell)).map(|cell| cell.len() - integer(cell)).max().unwrap_or(0);
    for cell in cells.iter_mut() {
        if is_number(cell) {
            let left = before - integer(cell);
            let right = after - (cell.len() - integer(cell));
            *cell = format!("{}{cell}{}", " ".repeat(left), " ".repeat(right));
        }
    }
}

fn write_line(
    out: &mut dyn Write,
    (gutter, gap): (usize, usize),
    mark: Option<char>,
    cells: &[(String, usize, Align, Role)],
    style: &Style,
) -> io::Result<()> {
    let mut line = match mark {
        Some(mark) => style.paint(Role::Accent, &mark.to_string()) + " ",
        None => " ".repeat(gutter),
    };
    for (place, (text, width, align, role)) in cells.iter().enumerate() {
        if place > 0 {
            line.push_str(&" ".repeat(gap));
        }
        let text = style.fit(text, *width);
        let padded = match align {
            Align::Left => pad_right(&text, *width),
            Align::Right | Align::Decimal => pad_left(&text, *width),
        };
        let body = padded.trim();
        match (body.is_empty(), padded.find(body)) {
            (false, Some(start)) => {
                line.push_str(&padded[..start]);
                line.push_str(&style.paint(*role, body));
                line.push_str(&padded[start + body.len()..]);
            }
            _ => line.push_str(&padded),
        }
    }
    writeln!(out, "{}", line.trim_end())
}
