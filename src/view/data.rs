//! The data of a scenario as tables: what stands in its file, a table for each of its lists, expressions with their
//! present values. What is not in the file (nodes of a mesh, entries of a matrix) is named, not listed.

use serde_json::{Map, Value};

use super::style::Role;
use super::table::{Cell, Column, Row, Table};
use crate::model::expression::Expression;
use crate::model::jet::Jet;
use crate::model::locate::Document;
use crate::model::parameter::ParameterValues;
use crate::model::scenario::Scenario;
use crate::text::number::{in_full, short};

/// Keys of a file that are lists of things, with their headings, in the order of a report. What is not here has a table
/// of another shape (a superelement, a contact system, an LCP, loads, stages), is shown elsewhere (parameters,
/// combinations, probes, rules) or is not data (title, remarks).
const LISTS: &[(&str, &str)] = &[
    ("materials", "Materials"),
    ("sections", "Sections"),
    ("nodes", "Nodes"),
    ("bars", "Bars"),
    ("plates", "Plates"),
    ("quads", "Quads"),
    ("triangles", "Triangles"),
    ("meshes", "Meshes"),
    ("edges", "Edges"),
    ("supports", "Supports"),
    ("springs", "Springs"),
    ("foundations", "Foundations"),
    ("rigid", "Rigid bodies"),
    ("ties", "Ties"),
    ("contacts", "Contacts"),
];

/// Keys whose strings are names and words, never numbers.
const WORDS: &[&str] = &[
    "id", "name", "node", "nodes", "polyline", "material", "section", "kind", "plane", "element", "hinges", "at",
    "fixed", "on", "edge", "bar", "against", "law", "method", "axes", "about", "between", "case", "file", "pairs",
    "dofs", "names",
];

/// Most rows of a matrix that is shown.
const MATRIX: usize = 8;
/// Most entries of a list in a cell; of a longer list the first and the last are named.
const ENTRIES: usize = 8;

/// Where expressions get their values from.
struct Reader<'a> {
    values: &'a ParameterValues,
    names: Vec<&'a str>,
}

/// The data of a scenario: headings with their tables, in the order of a report.
pub fn tables(scenario: &Scenario, values: &ParameterValues) -> Vec<(&'static str, Table)> {
    // The text was parsed when it was loaded.
    let Ok(document) = Document::parse(&scenario.text) else { return Vec::new() };
    let Value::Object(root) = document.value() else { return Vec::new() };
    let reader = Reader { values, names: values.keys().map(String::as_str).collect() };
    let mut tables: Vec<(&'static str, Table)> = LISTS
        .iter()
        .filter_map(|&(key, heading)| Some((heading, reader.list(key, root.get(key)?)?)))
        .filter(|(_, table)| !table.rows.is_empty())
        .collect();
    if let Some(Value::Object(superelement)) = root.get("superelement") {
        tables.push(("Superelement", reader.fields(superelement)));
    }
    if let Some(Value::Object(system)) = root.get("contact_system") {
        tables.extend([("Contact system", reader.fields(system)), ("Loads", reader.system_loads(system))]);
    }
    if let Some(Value::Object(lcp)) = root.get("lcp") {
        tables.push(("LCP", reader.fields(lcp)));
    }
    if let Some(Value::Object(loads)) = root.get("loads") {
        tables.push(("Loads", reader.loads(loads)));
    }
    if let Some(Value::Array(stages)) = root.get("stages") {
        tables.push(("Stages", reader.stages(stages)));
    }
    tables
}

impl Reader<'_> {
    /// A list of objects, or an object of named things, as a table with a column for each key that occurs.
    fn list(&self, of: &str, value: &Value) -> Option<Table> {
        let (named, entries): (bool, Vec<(&str, &Value)>) = match value {
            Value::Array(entries) => (false, entries.iter().map(|entry| ("", entry)).collect()),
            Value::Object(entries) => (true, entries.iter().map(|(name, entry)| (name.as_str(), entry)).collect()),
            _ => return None,
        };
        let mut keys: Vec<&str> = Vec::new();
        for (_, entry) in &entries {
            let Value::Object(fields) = entry else { continue };
            keys.extend(fields.keys().map(String::as_str).filter(|key| !keys.contains(key)).collect::<Vec<_>>());
        }
        let plain = entries.iter().any(|(_, entry)| !entry.is_object());
        let what = if of == "nodes" { "position" } else { "value" };
        let heads = named.then_some("name").into_iter().chain(keys.iter().copied()).chain(plain.then_some(what));
        let mut table = Table::new(heads.map(Column::words).collect());
        for (name, entry) in entries {
            let mut cells: Vec<Cell> = named.then(|| Cell::from(name)).into_iter().collect();
            let field = |key: &&str| entry.get(*key).map_or_else(String::new, |value| self.text(key, value));
            cells.extend(keys.iter().map(field).map(Cell::from));
            if plain {
                // an edge is a list of names, a node one of numbers
                let key = if of == "edges" { "nodes" } else { "" };
                cells.push(Cell::from(if entry.is_object() { String::new() } else { self.text(key, entry) }));
            }
            table.rows.push(Row::new(cells));
        }
        Some(table)
    }

    /// A row for each item of each load case.
    fn loads(&self, loads: &Map<String, Value>) -> Table {
        let mut table = Table::new(["load case", "factor", "load", "with"].map(Column::words).into());
        for (case, load) in loads {
            let factor = load.get("factor").map_or_else(|| "1".to_owned(), |factor| self.text("factor", factor));
            let items = load.get("items").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
            let mut first = [case.clone(), factor];
            if items.is_empty() {
                table.rows.push(Row::new(first.clone().map(Cell::from).into_iter().chain(blank(2)).collect()));
            }
            for (kind, of) in items.iter().filter_map(Value::as_object).flatten() {
                let cells = std::mem::take(&mut first).into_iter().chain([kind.clone(), self.text(kind, of)]);
                table.rows.push(Row::new(cells.map(Cell::from).collect()));
            }
        }
        table
    }

    /// The load cases of a contact system with their factors.
    fn system_loads(&self, system: &Map<String, Value>) -> Table {
        let mut table = Table::new(["load case", "factor", "vector"].map(Column::words).into());
        for (case, load) in system.get("loads").and_then(Value::as_object).into_iter().flatten() {
            let text = |key: &str, or: &str| load.get(key).map_or_else(|| or.to_owned(), |of| self.text(key, of));
            let cells = [case.clone(), text("factor", "1"), text("vector", "")];
            table.rows.push(Row::new(cells.map(Cell::from).into()));
        }
        table
    }

    /// A row for each stage.
    fn stages(&self, stages: &[Value]) -> Table {
        let mut table = Table::new(vec![Column::count("stage"), Column::words("multiplies the factors by")]);
        for (number, stage) in (1..).zip(stages) {
            table.rows.push(Row::new(vec![Cell::from(number.to_string()), Cell::from(self.text("", stage))]));
        }
        table
    }

    /// A row for each field but the loads; a large matrix by its size.
    fn fields(&self, fields: &Map<String, Value>) -> Table {
        let mut table = Table::new(vec![Column::words("of"), Column::words("value")]);
        for (key, value) in fields.iter().filter(|(key, _)| *key != "loads") {
            let rows = value.as_array().filter(|rows| !rows.is_empty() && rows.iter().all(Value::is_array));
            let row = |name: String, text: String| Row::new(vec![Cell::from(name), Cell::from(text)]);
            match rows {
                Some(rows) if rows.len() <= MATRIX => {
                    table.rows.extend(rows.iter().zip(1..).map(|(line, number)| {
                        let entries = line.as_array().into_iter().flatten();
                        row(format!("{key}, row {number}"), self.joined("", entries))
                    }));
                }
                Some(rows) => {
                    let size = format!("{} rows, see the scenario", rows.len());
                    table.rows.push(Row::new(vec![Cell::from(key.as_str()), Cell::new(size, Role::Muted)]));
                }
                None => table.rows.push(row(key.clone(), self.text(key, value))),
            }
        }
        table
    }

    /// A value of the file: numbers as they stand there, expressions with their values.
    fn text(&self, key: &str, value: &Value) -> String {
        match value {
            Value::Null => String::new(),
            Value::Bool(yes) => if *yes { "yes" } else { "no" }.to_owned(),
            Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), given),
            Value::String(text) if WORDS.contains(&key) => text.clone(),
            Value::String(text) => match self.number(text) {
                Some(value) => format!("{text} = {}", short(value)),
                None => text.clone(),
            },
            Value::Array(entries) => self.entries(key, entries),
            Value::Object(fields) => {
                let field = |(key, value): (&String, &Value)| format!("{key} {}", self.text(key, value));
                fields.iter().map(field).collect::<Vec<_>>().join(", ")
            }
        }
    }

    /// A list; of a long one its ends.
    fn entries(&self, key: &str, entries: &[Value]) -> String {
        let text = match entries {
            [first, .., last] if entries.len() > ENTRIES => {
                format!("{} … {}, {} of them", self.text(key, first), self.text(key, last), entries.len())
            }
            entries => self.joined(key, entries.iter()),
        };
        if WORDS.contains(&key) { text } else { format!("({text})") }
    }

    fn joined<'v>(&self, key: &str, entries: impl Iterator<Item = &'v Value>) -> String {
        entries.map(|entry| self.text(key, entry)).collect::<Vec<_>>().join(", ")
    }

    /// The present value of a parameter or an expression; `None` for any other text.
    fn number(&self, text: &str) -> Option<f64> {
        let known = self.values.get(text).copied();
        known.or_else(|| {
            let expression = Expression::parse(text, &self.names).ok()?;
            Some(expression.evaluate(&|name| Jet::constant(self.values[name])).value)
        })
    }
}

/// A number of the file: `210e6` where that is all of it.
fn given(value: f64) -> String {
    let brief = short(value);
    if brief.parse() == Ok(value) { brief } else { in_full(value) }
}

fn blank(count: usize) -> impl Iterator<Item = Cell> {
    std::iter::repeat_with(|| Cell::from("")).take(count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::load::load_text;
    use crate::text::number::DIGITS;
    use crate::view::style::Style;

    fn rows(scenario: &Scenario, values: &ParameterValues, heading: &str) -> Vec<Vec<String>> {
        let (_, table) = tables(scenario, values).into_iter().find(|(known, _)| *known == heading).unwrap();
        let columns = table.printed(DIGITS, &Style::default());
        let row = |at: usize| columns.iter().map(|column| column.cells[at].trim().to_owned()).collect();
        (0..table.rows.len()).map(row).collect()
    }

    #[test]
    fn numbers_stand_as_in_the_file_and_expressions_with_their_values() {
        // the parameter `s1` has the name of a node: names are never read as numbers
        let text = r#"{ "format": "stickslip/1", "title": "t", "parameters": { "s1": 4, "f": 0.5, "q": 3 },
            "materials": { "steel": { "E": 2.1e8, "nu": 0.3 } },
            "sections": { "s": { "area": 0.0123456789, "inertia": "s1^2/1e6" } },
            "nodes": { "s1": [0, 0], "s2": ["s1", "s1/3"] },
            "bars": [{ "id": "b", "nodes": ["s1", "s2"], "material": "steel", "section": "s" }],
            "supports": [{ "at": "s1", "fixed": ["x", "y", "r"] }],
            "contacts": [{ "id": "c", "node": "s2", "against": "ground", "normal": [0, 1], "friction": "f" }],
            "loads": { "dead": { "items": [{ "line": { "bar": "b", "value": [0, "-2*q"] } },
                                           { "point": { "at": "s2", "force": [0, -1] } }] },
                       "none": { "factor": "q", "items": [] } } }"#;
        let scenario = load_text("t", text, None).unwrap();
        let mut values = scenario.parameter_values();
        values.insert("s1".into(), 5.0);
        let rows = |heading| rows(&scenario, &values, heading);
        assert_eq!(rows("Materials"), [["steel", "210e6", "0.3"]]);
        // 5²/1e6 = 25e-6
        assert_eq!(rows("Sections"), [["s", "0.0123456789", "s1^2/1e6 = 25e-6"]]);
        assert_eq!(rows("Nodes"), [["s1", "(0, 0)"], ["s2", "(s1 = 5, s1/3 = 1.6667)"]]);
        assert_eq!(rows("Bars"), [["b", "s1, s2", "steel", "s"]]);
        assert_eq!(rows("Supports"), [["s1", "x, y, r"]]);
        assert_eq!(rows("Contacts"), [["c", "s2", "ground", "(0, 1)", "f = 0.5"]]);
        let loads = [
            ["dead", "1", "line", "bar b, value (0, -2*q = -6)"],
            ["", "", "point", "at s2, force (0, -1)"],
            ["none", "q = 3", "", ""],
        ];
        assert_eq!(rows("Loads"), loads);
    }
}
