//! The LCP itself, for other solvers: as a scenario of this program (JSON) or in Matrix Market files.

use std::io::{self, Write};

use serde_json::{Value, json};

use crate::lcp::problem::Lcp;
use crate::model::scenario::FORMAT;
use crate::model::units::Units;

/// A variable's name as an id of the format: `x+[joint[0]]` becomes `x_plus_joint_0`, `1` becomes `w_1`.
fn id(name: &str) -> String {
    let spelled = name.replace('+', "_plus").replace("x-", "x_minus");
    let plain: String = spelled.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    let words: Vec<&str> = plain.split('_').filter(|word| !word.is_empty()).collect();
    let id = words.join("_");
    if id.starts_with(|c: char| c.is_ascii_alphabetic()) { id } else { format!("w_{id}") }
}

/// A `stickslip/1` scenario of this source, which is no structure.
pub(super) fn of_source(key: &str, source: Value, title: &str, units: &Units) -> Value {
    let mut scenario = json!({"format": FORMAT, "title": title});
    if let Some(units) = units.json() {
        scenario["units"] = units;
    }
    scenario[key] = source;
    scenario
}

/// The LCP as a `stickslip/1` scenario with the source `lcp`: it loads and solves as it is.
pub fn scenario(lcp: &Lcp<f64>, names: &[String], title: &str, units: &Units) -> Value {
    let names: Vec<String> = names.iter().map(|name| id(name)).collect();
    let source = json!({ "M": lcp.matrix, "q": lcp.q, "covering": lcp.covering, "names": names });
    of_source("lcp", source, title, units)
}

/// A bare LCP as the text of a scenario, a row of M a line.
///
/// # Errors
/// Those of `out`.
pub fn scenario_text(out: &mut dyn Write, title: &str, matrix: &[Vec<f64>], q: &[f64]) -> io::Result<()> {
    let text = |value: Value| value.to_string();
    writeln!(
        out,
        "{{\n  \"format\": \"{FORMAT}\",\n  \"title\": {},\n  \"lcp\": {{\n    \"M\": [",
        text(json!(title))
    )?;
    for (i, row) in matrix.iter().enumerate() {
        let comma = if i + 1 < matrix.len() { "," } else { "" };
        writeln!(out, "      {}{comma}", text(json!(row)))?;
    }
    writeln!(out, "    ],\n    \"q\": {}\n  }}\n}}", text(json!(q)))
}

/// A dense matrix in Matrix Market array format, column by column; a vector is a matrix of one column.
///
/// # Errors
/// Those of `out`.
pub fn matrix_market(out: &mut dyn Write, rows: &[Vec<f64>], comment: &str) -> io::Result<()> {
    let columns = rows.first().map_or(0, Vec::len);
    writeln!(out, "%%MatrixMarket matrix array real general")?;
    for line in comment.lines() {
        writeln!(out, "% {line}")?;
    }
    writeln!(out, "{} {columns}", rows.len())?;
    for j in 0..columns {
        for row in rows {
            writeln!(out, "{:e}", row[j])?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lcp::problem::Scale;
    use crate::model::load::load_text;
    use crate::model::scenario::Source;

    #[test]
    fn the_scenario_loads_to_the_same_lcp() {
        let matrix = vec![vec![2.0, 1.0 / 3.0], vec![-1e-17, 1.5]];
        let lcp = Lcp { scale: Scale::plain(&matrix), matrix, q: vec![-1.0, 0.1], covering: vec![1.0, 1.7] };
        let names = ["x_n[c1]", "x-[joint[0]]"].map(str::to_owned);
        let text = scenario(&lcp, &names, "two rows", &Units::default()).to_string();
        let loaded = load_text("two", &text, None).expect("a scenario");
        let Source::Lcp(given) = loaded.source else { panic!("an lcp") };
        assert_eq!(given.matrix, lcp.matrix);
        assert_eq!(given.covering, Some(lcp.covering));
        assert_eq!(given.names, ["x_n_c1", "x_minus_joint_0"]);
    }

    #[test]
    fn the_text_of_a_bare_lcp_loads_to_it() {
        let matrix = vec![vec![2.0, 1.0 / 3.0], vec![-1e-17, 1.5]];
        let mut out = Vec::new();
        scenario_text(&mut out, "say \"two\"", &matrix, &[-1.0, 0.1]).expect("a vector takes it");
        let loaded = load_text("two", &String::from_utf8(out).expect("text"), None).expect("a scenario");
        assert_eq!(loaded.title, "say \"two\"");
        let Source::Lcp(given) = loaded.source else { panic!("an lcp") };
        assert_eq!(given.matrix, matrix);
    }

    #[test]
    fn a_matrix_goes_to_a_file_and_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let rows = [vec![0.1, -1e-300], vec![2.0 / 3.0, 5e-324]];
        let mut out = Vec::new();
        matrix_market(&mut out, &rows, "M of w = M z + q").expect("a vector takes it");
        std::fs::write(folder.path().join("m.mtx"), out).expect("a file");
        let text = r#"{ "format": "stickslip/1", "title": "t", "lcp": { "M": { "file": "m.mtx" }, "q": [1, 2] } }"#;
        let loaded = load_text("t", text, Some(&folder.path().join("t.json"))).expect("a scenario");
        let Source::Lcp(given) = loaded.source else { panic!("an lcp") };
        assert_eq!(given.matrix, rows);
    }

    #[test]
    fn matrix_market_goes_column_by_column() {
        let mut out = Vec::new();
        matrix_market(&mut out, &[vec![1.0, 2.0], vec![3.0, 4.5]], "M").expect("a vector takes it");
        assert_eq!(
            String::from_utf8(out).expect("text"),
            "%%MatrixMarket matrix array real general\n% M\n2 2\n1e0\n3e0\n2e0\n4.5e0\n"
        );
    }
}
