//! Any list of JSON records as CSV: nested objects become columns `outer_inner`, lists of plain values one field.

use std::io::{self, Write};

use serde_json::{Map, Value};

use super::csv::quoted;

/// A table; fields that a record does not have are null.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns, in the order in which the records bring them.
    pub columns: Vec<String>,
    /// One entry per column.
    pub rows: Vec<Vec<Value>>,
}

impl Table {
    /// Of records; what is not an object becomes a row with the one column `value`.
    pub fn of(records: &[Value]) -> Table {
        let mut table = Table::default();
        let flat: Vec<Map<String, Value>> = records.iter().map(flat).collect();
        for name in flat.iter().flat_map(Map::keys) {
            if !table.columns.contains(name) {
                table.columns.push(name.clone());
            }
        }
        // an object that is null elsewhere has no column of its own
        let columns = table.columns.clone();
        let is_spread = |name: &str| columns.iter().any(|other| other.starts_with(&format!("{name}_")));
        let is_null = |name: &str| flat.iter().all(|record| record.get(name).is_none_or(Value::is_null));
        table.columns.retain(|name| !(is_spread(name) && is_null(name)));
        let field = |record: &Map<String, Value>, name: &String| record.get(name).cloned().unwrap_or_default();
        table.rows = flat.iter().map(|record| table.columns.iter().map(|name| field(record, name)).collect()).collect();
        table
    }

    /// Writes the table (RFC 4180), numbers in full precision.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut line = |fields: &mut dyn Iterator<Item = String>| {
            let fields: Vec<String> = fields.map(|field| quoted(&field).into_owned()).collect();
            write!(out, "{}\r\n", fields.join(","))
        };
        line(&mut self.columns.iter().cloned())?;
        self.rows.iter().try_for_each(|row| line(&mut row.iter().map(written)))
    }
}

/// Each record once for every record of its list `key`, whose fields follow its own.
pub fn unfolded(records: &[Value], key: &str) -> Vec<Value> {
    let with = |outer: &Value, inner: &Value| {
        let (Value::Object(outer), Value::Object(inner)) = (outer, inner) else { return Value::Null };
        let own = outer.iter().filter(|(name, _)| *name != key);
        Value::Object(own.chain(inner).map(|(name, value)| (name.clone(), value.clone())).collect())
    };
    let inner = |record: &Value| record.get(key).and_then(Value::as_array).cloned().unwrap_or_default();
    records.iter().flat_map(|record| inner(record).iter().map(|one| with(record, one)).collect::<Vec<_>>()).collect()
}

fn flat(record: &Value) -> Map<String, Value> {
    let mut flat = Map::new();
    match record {
        Value::Object(fields) => {
            for (name, value) in fields {
                fill(&mut flat, name, value);
            }
        }
        value => fill(&mut flat, "value", value),
    }
    flat
}

fn fill(flat: &mut Map<String, Value>, name: &str, value: &Value) {
    match value {
        Value::Object(fields) => {
            for (inner, value) in fields {
                fill(flat, &format!("{name}_{inner}"), value);
            }
        }
        Value::Array(list) => {
            let words: Vec<String> = list.iter().map(written).collect();
            flat.insert(name.to_owned(), words.join(" ").into());
        }
        value => {
            flat.insert(name.to_owned(), value.clone());
        }
    }
}

/// A value in a field: −0 is 0, null is empty.
fn written(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Number(number) => match number.as_f64().filter(|_| number.is_f64()) {
            Some(0.0) => "0.0".to_owned(),
            Some(number) => format!("{number:?}"),
            None => number.to_string(),
        },
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn nested_records_become_columns() {
        let table = Table::of(&[
            json!({"name": "a,b", "least": {"value": -0.0, "at": "x"}, "list": [1, 0.1]}),
            json!({"name": "c", "least": null, "more": true}),
        ]);
        let mut out = Vec::new();
        table.csv(&mut out).expect("a vector takes it");
        let expected = "name,least_value,least_at,list,more\r\n\"a,b\",0.0,x,1 0.1,\r\nc,,,,true\r\n";
        assert_eq!(String::from_utf8(out).expect("text"), expected);
    }

    #[test]
    fn a_list_within_records_is_unfolded() {
        let all = [json!({"parameter": "f", "pairs": [{"pair": "c1"}, {"pair": "c2"}]}), json!({"pairs": []})];
        let unfolded = unfolded(&all, "pairs");
        assert_eq!(unfolded, [json!({"parameter": "f", "pair": "c1"}), json!({"parameter": "f", "pair": "c2"})]);
    }
}
