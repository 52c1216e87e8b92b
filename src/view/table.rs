//! A small table writer: aligned columns with units, fitted to the width without losing any of them. Words are broken
//! over several lines first, then numbers lose a digit, then columns go on beneath.

use std::io::{self, Write};

use unicode_width::UnicodeWidthStr;

use super::scale::{APART, Scale};
use super::style::{Role, Style, pad_left, pad_right};
use crate::answer::rounding::{denoised, largest};
use crate::text::number::DIGITS;

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

/// What the numbers of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Measured: what is rounding beside the largest is 0.
    Measured,
    /// The same, freed of its rounding already: beside a bound of 1e15 a force of 1 is not noise.
    Clean,
    /// Given by the user, or typed again as they are read.
    Given,
    /// Counts and ratios: no trailing zeros.
    Plain,
}

/// One column.
#[derive(Clone, Debug)]
pub struct Column {
    head: String,
    unit: Option<String>,
    pub(super) align: Align,
    kind: Kind,
    /// Columns of one quantity have the same number.
    quantity: Option<u8>,
    rank: u8,
    /// The largest of its numbers in rows that are not written.
    unwritten: f64,
}

impl Column {
    /// Left-aligned words.
    pub fn words(head: &str) -> Column {
        Column {
            head: head.into(),
            unit: None,
            align: Align::Left,
            kind: Kind::Measured,
            quantity: None,
            rank: 0,
            unwritten: 0.0,
        }
    }

    /// Counters, at the right.
    pub fn count(head: &str) -> Column {
        Column { align: Align::Right, ..Column::words(head) }
    }

    /// Numbers with their unit; they share one power of ten.
    pub fn numbers(head: &str, unit: Option<String>) -> Column {
        Column { unit, align: Align::Decimal, ..Column::words(head) }
    }

    /// Numbers that the user gives or reads back to the last digit: parameters, factors, breakpoints.
    pub fn given(head: &str, unit: Option<String>) -> Column {
        Column { kind: Kind::Given, ..Column::numbers(head, unit) }
    }

    /// Counts or ratios: `37`, `1.3333`.
    pub fn plain(head: &str, unit: Option<String>) -> Column {
        Column { kind: Kind::Plain, ..Column::numbers(head, unit) }
    }

    /// Its small numbers are not rounding.
    pub fn clean(mut self) -> Column {
        self.kind = Kind::Clean;
        self
    }

    /// Shares its power of ten with the other columns of this quantity, unless all its numbers are under a thousandth of
    /// their largest.
    pub fn of(mut self, quantity: u8) -> Column {
        self.quantity = Some(quantity);
        self
    }

    /// For a part of a table: the power of ten is that of a column in which a number of this size stands, too.
    pub fn with_unwritten(mut self, largest: f64) -> Column {
        self.unwritten = largest;
        self
    }

    /// Goes on beneath first where the table is too wide; the highest rank goes before the others, 0 last, and columns of one
    /// rank go together.
    pub fn droppable(mut self, rank: u8) -> Column {
        self.rank = rank;
        self
    }
}

/// What a cell holds and its colour.
#[derive(Clone, Debug)]
pub struct Cell {
    text: String,
    number: Option<f64>,
    role: Role,
}

impl Cell {
    /// Coloured text.
    pub fn new(text: impl Into<String>, role: Role) -> Cell {
        Cell { text: text.into(), number: None, role }
    }

    /// A number, written as its column asks for.
    pub fn number(value: f64) -> Cell {
        Cell { text: String::new(), number: Some(value), role: Role::Plain }
    }

    /// A number, or nothing.
    pub fn maybe(value: Option<f64>) -> Cell {
        value.map_or_else(|| Cell::from(""), Cell::number)
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
/// Words are not broken into lines shorter than this, unless nothing else helps.
const NARROW: usize = 12;

/// A column ready for printing.
pub(super) struct Printed {
    pub(super) head: String,
    pub(super) unit: String,
    pub(super) cells: Vec<String>,
    width: usize,
    /// Words may be broken into lines as short as this.
    least: usize,
}

/// Columns that stand beside each other, with their widths, and the blanks between them.
struct Block {
    columns: Vec<(usize, usize)>,
    gap: usize,
}

impl Table {
    /// An empty table.
    pub fn new(columns: Vec<Column>) -> Table {
        Table { columns, rows: Vec::new() }
    }

    /// Writes the table: heads, units (if any), rows; columns that find no room beneath, after the first one again.
    pub fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        let (columns, blocks) = self.blocks(style);
        for (index, block) in blocks.iter().enumerate() {
            if index > 0 {
                writeln!(out)?;
            }
            self.write_block(out, &columns, block, (self.gutter(), index == 0), style)?;
        }
        Ok(())
    }

    /// Writes the columns that stand beside each other, a row on a line; says whether these are all.
    pub fn write_beside(&self, out: &mut dyn Write, style: &Style) -> io::Result<bool> {
        let (columns, blocks) = self.blocks(style);
        if let Some(block) = blocks.first() {
            self.write_block(out, &columns, block, (self.gutter(), true), style)?;
        }
        Ok(blocks.len() <= 1)
    }

    /// Columns ahead of the rows for the mark of one of them.
    fn gutter(&self) -> usize {
        if self.rows.iter().any(|row| row.marked) { 2 } else { 0 }
    }

    /// The columns with as many digits as there is room for, and which of them stand beside each other.
    fn blocks(&self, style: &Style) -> (Vec<Printed>, Vec<Block>) {
        let room = style.width.saturating_sub(self.gutter());
        let beside = |columns: &[Printed]| fitted(columns, &all(columns), room).map(|block| vec![block]);
        let columns = self.printed(DIGITS, style);
        if let Some(blocks) = beside(&columns) {
            return (columns, blocks);
        }
        let fewer = self.printed(DIGITS - 1, style);
        if let Some(blocks) = beside(&fewer) {
            return (fewer, blocks);
        }
        let blocks = self.folded(&columns, room);
        (columns, blocks)
    }

    /// The columns with at most this many digits in their numbers.
    pub(super) fn printed(&self, digits: usize, style: &Style) -> Vec<Printed> {
        (0..self.columns.len()).map(|index| self.printed_column(index, digits, style)).collect()
    }

    fn numbers(&self, index: usize) -> impl Iterator<Item = f64> + '_ {
        self.rows.iter().filter_map(move |row| row.cells.get(index)?.number)
    }

    fn printed_column(&self, index: usize, digits: usize, style: &Style) -> Printed {
        let column = &self.columns[index];
        let alike = |other: &Column| column.quantity.is_some() && other.quantity == column.quantity;
        let of_quantity: Vec<usize> =
            (0..self.columns.len()).filter(|&other| other == index || alike(&self.columns[other])).collect();
        let with_unwritten = |other: usize| self.numbers(other).chain([self.columns[other].unwritten]);
        let most = largest(of_quantity.iter().flat_map(|&other| with_unwritten(other)));
        let value = |value: f64| if column.kind == Kind::Measured { denoised(value, most) } else { value };
        let own = largest(with_unwritten(index).map(value));
        let decisive = if own > 0.0 && own < APART * most { own } else { most };
        let scale = match column.kind {
            Kind::Given => Scale::given(self.numbers(index)),
            Kind::Plain => Scale::of_axis(self.numbers(index)),
            _ => Scale::with_digits([decisive], digits),
        };
        let text = |cell: &Cell| match cell.number {
            Some(number) => scale.number(value(number)),
            None => style.text(&cell.text),
        };
        let mut cells: Vec<String> =
            self.rows.iter().map(|row| row.cells.get(index).map_or_else(String::new, text)).collect();
        if column.align == Align::Decimal {
            align_decimals(&mut cells);
        }
        let head = style.text(&column.head);
        let own_unit = column.unit.as_ref().map(|unit| style.text(unit));
        let unit = scale.unit(own_unit.as_deref(), style.ascii).unwrap_or_default();
        let width = cells.iter().map(|cell| cell.width()).chain([head.width(), unit.width()]).max().unwrap_or(0);
        let word = cells.iter().flat_map(|cell| cell.split(' ')).map(|word| word.width()).max().unwrap_or(0);
        let least = match column.align {
            Align::Left => width.min(head.width().max(word.min(2 * NARROW)).max(NARROW)),
            _ => width,
        };
        Printed { head, unit, cells, width, least }
    }

    /// Blocks of columns where they do not all stand beside each other: those of the lowest rank come first, columns of one
    /// rank stay together where they can, the first column is repeated.
    fn folded(&self, columns: &[Printed], room: usize) -> Vec<Block> {
        let rank = |index: &usize| self.columns[*index].rank;
        let mut left: Vec<usize> = (1..columns.len()).collect();
        left.sort_by_key(rank);
        let mut blocks = Vec::new();
        while !left.is_empty() {
            let mut chosen = vec![0];
            let with = |chosen: &[usize], more: &[usize]| {
                let mut wider = [chosen, more].concat();
                wider.sort_unstable();
                wider
            };
            'ranks: for alike in left.chunk_by(|a, b| rank(a) == rank(b)) {
                let wider = with(&chosen, alike);
                if fitted(columns, &wider, room).is_some() {
                    chosen = wider;
                    continue;
                }
                if chosen.len() > 1 {
                    break;
                }
                for index in alike {
                    let wider = with(&chosen, &[*index]);
                    if chosen.len() > 1 && fitted(columns, &wider, room).is_none() {
                        break 'ranks;
                    }
                    chosen = wider;
                }
            }
            left.retain(|index| !chosen.contains(index));
            blocks.push(fitted(columns, &chosen, room).unwrap_or_else(|| squeezed(columns, &chosen, room)));
        }
        if blocks.is_empty() {
            blocks.push(squeezed(columns, &[0], room));
        }
        blocks
    }

    fn write_block(
        &self,
        out: &mut dyn Write,
        columns: &[Printed],
        block: &Block,
        (gutter, first): (usize, bool),
        style: &Style,
    ) -> io::Result<()> {
        let line = |out: &mut dyn Write, mark: Option<char>, text: &dyn Fn(usize) -> (String, Role)| {
            let cells: Vec<(String, usize, Align, Role)> = block
                .columns
                .iter()
                .map(|&(index, width)| {
                    let (text, role) = text(index);
                    (text, width, self.columns[index].align, role)
                })
                .collect();
            write_line(out, (gutter, block.gap), mark, &cells, style)
        };
        line(out, None, &|index| (columns[index].head.clone(), Role::Header))?;
        if block.columns.iter().any(|&(index, _)| !columns[index].unit.is_empty()) {
            line(out, None, &|index| (columns[index].unit.clone(), Role::Muted))?;
        }
        for (number, row) in self.rows.iter().enumerate() {
            let lines: Vec<Vec<String>> = block
                .columns
                .iter()
                .map(|&(index, width)| {
                    let text = &columns[index].cells[number];
                    let breaks = self.columns[index].align == Align::Left && text.width() > width;
                    if breaks { style.wrap(text, width) } else { vec![text.clone()] }
                })
                .collect();
            for part in 0..lines.iter().map(Vec::len).max().unwrap_or(0) {
                let mark = (row.marked && part == 0).then(|| style.mark());
                line(out, mark, &|index| {
                    let place = block.columns.iter().position(|(column, _)| *column == index).unwrap_or_default();
                    let text = lines[place].get(part).cloned().unwrap_or_default();
                    (text, row.cells.get(index).map_or(Role::Plain, |cell| cell.role))
                })?;
            }
            if let Some(sentence) = row.beneath.as_ref().filter(|_| first) {
                let indent = (gutter + 4).min(style.width / 4);
                for line in style.wrap(sentence, style.width - indent) {
                    writeln!(out, "{}{}", " ".repeat(indent), style.paint(Role::Muted, &line))?;
                }
            }
        }
        Ok(())
    }
}

fn all(columns: &[Printed]) -> Vec<usize> {
    (0..columns.len()).collect()
}

/// The chosen columns beside each other, if they find room: with one blank between them if that helps, words broken into
/// lines if that does.
fn fitted(columns: &[Printed], chosen: &[usize], room: usize) -> Option<Block> {
    let gaps = chosen.len().saturating_sub(1);
    let natural: usize = chosen.iter().map(|&index| columns[index].width).sum();
    let least: usize = chosen.iter().map(|&index| columns[index].least).sum();
    let gap = match () {
        () if natural + GAP * gaps <= room => GAP,
        () if natural + gaps <= room => 1,
        () if least + GAP * gaps <= room => GAP,
        () if least + gaps <= room => 1,
        () => return None,
    };
    let mut block = Block { columns: chosen.iter().map(|&index| (index, columns[index].width)).collect(), gap };
    let mut excess = (natural + gap * gaps).saturating_sub(room);
    while excess > 0 {
        let widest = block.columns.iter_mut().filter(|(index, width)| *width > columns[*index].least);
        let (_, width) = widest.max_by_key(|(_, width)| *width)?;
        *width -= 1;
        excess -= 1;
    }
    Some(block)
}

/// The last of the chosen columns and as much of the others as there is room for: where even two of them are too wide.
fn squeezed(columns: &[Printed], chosen: &[usize], room: usize) -> Block {
    let mut block = Block { columns: chosen.iter().map(|&index| (index, columns[index].width)).collect(), gap: 1 };
    if let [(_, key), (_, other)] = block.columns.as_mut_slice() {
        match room.checked_sub(*other + 1) {
            Some(rest) if rest >= 3 => *key = (*key).min(rest),
            _ => drop(block.columns.remove(0)),
        }
    }
    if let [(_, only)] = block.columns.as_mut_slice() {
        *only = (*only).min(room);
    }
    block
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
