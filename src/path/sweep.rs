//! A sweep: the answer at every point of a grid, one row each, in the order of the grid whatever the number of threads.
//! Each row has what a cold run finds at its point ([`super::sweep_points`]).

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

use super::grid::{Grid, Shard};
use super::sample::draw::Rule;
use crate::answer::record::{Answer, State};
use crate::model::dimension::Dimension;
use crate::model::quantity::Quantity;
use crate::solve::Case;
use crate::text::hash::Hash;
use crate::text::printable;

/// How rows are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// A comment line with the header, column names, rows.
    Csv,
    /// A header object, then an object for each row, one a line.
    Json,
}

/// What is swept.
pub struct Sweep<'a> {
    /// At the values of the parameters that are not varied.
    pub case: Case<'a>,
    /// The points.
    pub grid: &'a Grid,
    /// Which part of them.
    pub shard: Shard,
    /// How rows are written.
    pub format: Format,
    /// Columns after the usual ones.
    pub quantities: &'a [Quantity],
}

/// First line of a file: what it holds, and whether two files belong together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// `stickslip-sweep/2`.
    pub format: String,
    /// Version of the program.
    pub version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Of the scenario with the files it names, the values that are not varied and the rules.
    pub hash: String,
    /// Ranges of the axes.
    pub grid: Vec<String>,
    /// Points of the whole grid.
    pub points: usize,
    /// How they were drawn, where they are not those of a grid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drawn: Option<Rule>,
    /// Part of them in this file.
    pub shard: Shard,
    /// Quantities with columns of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<String>,
}

/// Name of the last column of a file.
pub const CHECKSUM: &str = "checksum";

/// Names of the columns between the parameters and the checksum.
pub(super) const COLUMNS: [&str; 16] = [
    "outcome",
    "class",
    "p",
    "pivots",
    "open",
    "stick",
    "slip+",
    "slip-",
    "closed",
    "max_slip",
    "max_slip_pair",
    "max_gap",
    "max_gap_pair",
    "max_x_n",
    "max_x_n_pair",
    "failure",
];

/// Name of the format of sweep files.
pub const FORMAT: &str = "stickslip-sweep/2";

/// What is found at a point.
pub(super) enum Found {
    /// `watch` asked to stop.
    Stopped,
    /// Refused, in words.
    Refused(String),
    /// The fields of the row, and whether there is an answer.
    Solved(Vec<Value>, bool),
}

/// A row: the point and what was found there.
pub(super) struct Row {
    pub(super) line: String,
    pub(super) is_answer: bool,
}

impl Sweep<'_> {
    /// The header of the file.
    pub fn header(&self) -> Header {
        let mut hash = self.case.scenario.hash();
        for (name, value) in self.case.values.free() {
            if self.grid.axes.iter().all(|axis| axis.name != *name) {
                hash = hash.and(name.as_bytes());
                hash = hash.and(&value.to_bits().to_le_bytes());
            }
        }
        let rules = self.case.rules;
        hash = hash.and(format!("{} {} {}", rules.covering, rules.tie_break, rules.engine).as_bytes());
        if self.case.scenario.source.dimension() == Dimension::Space {
            hash = hash.and(format!("{} {}", rules.facets, rules.cone).as_bytes());
        }
        Header {
            format: FORMAT.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: self.case.scenario.name.clone(),
            hash: hash.long(),
            grid: self.grid.axes.iter().map(|axis| axis.range.clone()).collect(),
            points: self.grid.len(),
            drawn: self.grid.drawn.as_ref().map(|draw| draw.rule.clone()),
            shard: self.shard,
            quantities: self.quantities.iter().map(ToString::to_string).collect(),
        }
    }

    /// The lines before the rows.
    pub fn preamble(&self) -> String {
        let header = self.header();
        let columns = if self.format == Format::Csv { columns_line(&header.columns()) } else { String::new() };
        header_line(&header, self.format) + &columns
    }

    /// Names of the columns.
    pub fn columns(&self) -> Vec<String> {
        self.header().columns()
    }

    /// The fields of the parameters, by which a row is recognized.
    pub fn key(&self, index: usize) -> String {
        key(self.grid, self.format, index)
    }

    /// `None` where `watch` asked to stop.
    pub(super) fn row(&self, index: usize, found: Found, hash: &str) -> Option<Row> {
        let (fields, is_answer) = match found {
            Found::Solved(fields, is_answer) => (fields, is_answer),
            Found::Stopped => return None,
            Found::Refused(refusal) => {
                let mut fields = vec![Value::Null; COLUMNS.len()];
                fields[0] = json!("refused");
                if let Some(failure) = fields.last_mut() {
                    *failure = json!(refusal);
                }
                fields.resize(COLUMNS.len() + self.quantities.len(), Value::Null);
                (fields, false)
            }
        };
        let body = match self.format {
            Format::Csv => {
                let cells: Vec<String> = fields.iter().map(cell).collect();
                format!("{}{}", self.key(index), cells.join(","))
            }
            Format::Json => {
                let names = COLUMNS.map(str::to_owned).into_iter();
                let names = names.chain(self.quantities.iter().map(ToString::to_string));
                let object: Map<String, Value> = names.zip(fields).collect();
                let text = printable::json(Value::Object(object).to_string());
                let fields = text.strip_prefix('{').and_then(|text| text.strip_suffix('}')).unwrap_or_default();
                format!("{}{fields}", self.key(index))
            }
        };
        let sum = checksum(hash, index, &body);
        Some(Row { line: format!("{body}{}{sum}{}", before_sum(self.format), after_sum(self.format)), is_answer })
    }
}

impl Header {
    /// Names of the columns.
    pub fn columns(&self) -> Vec<String> {
        let axes = self.grid.iter().map(|range| range.split('=').next().unwrap_or_default().to_owned());
        axes.chain(COLUMNS.map(str::to_owned))
            .chain(self.quantities.iter().cloned())
            .chain([CHECKSUM.to_owned()])
            .collect()
    }

    /// Whether `line` is the row of this point, character by character as it was written.
    pub(super) fn is_row(&self, index: usize, format: Format, line: &str) -> bool {
        line.strip_suffix(after_sum(format))
            .and_then(|line| line.rsplit_once(before_sum(format)))
            .is_some_and(|(body, sum)| sum == checksum(&self.hash, index, body))
    }
}

/// The fields of the parameters at point `index`, with which its row begins.
pub(super) fn key(grid: &Grid, format: Format, index: usize) -> String {
    let values = grid.point(index);
    match format {
        Format::Csv => values.iter().map(|value| format!("{},", number(*value))).collect(),
        Format::Json => {
            let fields = grid.axes.iter().zip(values);
            let fields: Vec<String> =
                fields.map(|(axis, value)| format!("{}:{}", json!(axis.name), number(value))).collect();
            format!("{{{},", fields.join(","))
        }
    }
}

/// What binds a row to its sweep, its place there and its characters.
fn checksum(hash: &str, index: usize, body: &str) -> String {
    Hash::of(hash).and(format!(" {index} ").as_bytes()).and(body.as_bytes()).short()
}

/// What stands between the other fields of a row and its checksum.
fn before_sum(format: Format) -> &'static str {
    match format {
        Format::Csv => ",",
        Format::Json => ",\"checksum\":\"",
    }
}

/// What stands between the checksum of a row and its end.
fn after_sum(format: Format) -> &'static str {
    match format {
        Format::Csv => "\n",
        Format::Json => "\"}\n",
    }
}

/// The first line of a file.
pub(super) fn header_line(header: &Header, format: Format) -> String {
    let header = printable::json(json!(header).to_string());
    match format {
        Format::Csv => format!("# {header}\n"),
        Format::Json => format!("{header}\n"),
    }
}

/// The line of column names of a CSV.
pub(super) fn columns_line(columns: &[String]) -> String {
    let columns: Vec<String> = columns.iter().map(|column| cell(&Value::String(column.clone()))).collect();
    format!("{}\n", columns.join(","))
}

/// A number as JSON writes it: the shortest that reads back the same.
fn number(value: f64) -> String {
    json!(value).to_string()
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => {
            let text = printable::line(text);
            if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
        }
        other => other.to_string(),
    }
}

/// The columns after the parameters.
pub(super) fn fields(answer: &Answer) -> Vec<Value> {
    let is_state = !answer.outcome.is_failure();
    let has_pairs = is_state && !answer.pairs.is_empty();
    let count = |state: State| {
        if has_pairs { json!(answer.pairs.iter().filter(|pair| pair.state == state).count()) } else { Value::Null }
    };
    let largest = |value: &dyn Fn(usize) -> f64| -> [Value; 2] {
        if !has_pairs {
            return [Value::Null, Value::Null];
        }
        let best = (0..answer.pairs.len()).fold(0, |best, k| if value(k).abs() > value(best).abs() { k } else { best });
        [json!(value(best)), json!(answer.pairs[best].id)]
    };
    // Slips in space have directions of their own: neither + nor −.
    let in_space = answer.pairs.iter().any(|pair| pair.space.is_some());
    let sense = |state: State| if in_space { Value::Null } else { count(state) };
    // A size, as in the line of the status: its sign says the sense, not which slip is larger.
    let [slip, slip_pair] = largest(&|k| answer.pairs[k].slip_size());
    let [gap, gap_pair] = largest(&|k| answer.pairs[k].z_n);
    let [force, force_pair] = largest(&|k| answer.pairs[k].x_n);
    vec![
        json!(answer.outcome),
        answer.ray.as_ref().map_or(Value::Null, |ray| json!(ray.class)),
        if is_state { json!(answer.p) } else { Value::Null },
        json!(answer.pivot_count),
        count(State::Open),
        count(State::Stick),
        sense(State::SlipPlus),
        sense(State::SlipMinus),
        count(State::Closed),
        slip,
        slip_pair,
        gap,
        gap_pair,
        force,
        force_pair,
        answer.failure.as_ref().map_or(Value::Null, |why| json!(why)),
    ]
}
