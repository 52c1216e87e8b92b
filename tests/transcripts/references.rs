//! The table of computed against reference in the README: made from the scripts in `scenarios/scripts`, whose lines
//! `expect QUANTITY = REFERENCE ± TOLERANCE  # ref: SOURCE` are its rows. `UPDATE_README=1` writes it anew.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use stickslip::model::embedded;
use stickslip::model::expression::Expression;
use stickslip::model::jet::Jet;
use stickslip::session::{Session, language::tokens};
use stickslip::text::number::{short, with_unit};

use super::lines::{self, report};

const BEGIN: &str = "<!-- table of references: made from scenarios/scripts by tests/transcripts/references.rs -->\n";
const END: &str = "<!-- end of the table of references -->\n";

/// The parameters that are not those of the file: `f = 0.4, W = 0`.
fn changed(session: &Session) -> String {
    let scenario = session.scenario();
    let of_file = scenario.parameter_values();
    let words = session.values().free().filter(|(name, value)| of_file[*name] != *value);
    words.map(|(name, value)| format!("{name} = {}", short(value))).collect::<Vec<_>>().join(", ")
}

/// What is off, as a part of the reference (of 1 where that is 0); what only rounding can tell is `< 1e-9`.
fn error(reference: f64, computed: f64) -> String {
    let scale = if reference == 0.0 { 1.0 } else { reference.abs() };
    let off = (computed - reference).abs() / scale;
    if off < 1e-9 { "< 1e-9".to_owned() } else { format!("{:.1e}", off) }
}

/// The rows of one script. A script may go on in other scenarios; each row names its own.
fn rows(script: &Path, table: &mut String) -> usize {
    let mut session = lines::embedded(embedded::DEFAULT);
    let mut count = 0;
    for line in fs::read_to_string(script).unwrap().lines() {
        let referred = line.split_once("# ref: ");
        for command in tokens::commands(line) {
            let expectation = command.trim().strip_prefix("expect ");
            if let (Some((_, source)), Some(expectation)) = (referred, expectation) {
                let (quantity, bound) = expectation.split_once(" = ").expect("an equation");
                let (formula, _) = bound.split_once('±').expect("a tolerance");
                let names: Vec<&str> = session.values().keys().map(String::as_str).collect();
                let formula = Expression::parse(formula.trim(), &names).unwrap();
                let reference = formula.evaluate(&|name| Jet::constant(session.values()[name])).value;
                let found = &report(&mut session, &format!("show {quantity}")).unwrap()[0];
                let computed = found["value"].as_f64().unwrap_or_else(|| panic!("{found}"));
                let unit = found["unit"].as_str();
                let changed = changed(&session);
                writeln!(
                    table,
                    "| {} | {quantity} | {changed} | {} | {} | {} | {} |",
                    session.scenario().name,
                    source.trim(),
                    with_unit(&short(reference), unit),
                    short(computed),
                    error(reference, computed),
                )
                .unwrap();
                count += 1;
            }
            report(&mut session, command).unwrap_or_else(|error| panic!("{command}: {error}"));
        }
    }
    count
}

#[test]
fn the_table_of_references_is_what_the_scenarios_compute() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut table = String::from("| scenario | quantity | with | reference from | reference | computed | error |\n");
    table.push_str("| --- | --- | --- | --- | --- | --- | --- |\n");
    let mut scripts: Vec<PathBuf> =
        fs::read_dir(root.join("scenarios/scripts")).unwrap().map(|entry| entry.unwrap().path()).collect();
    scripts.sort();
    let count: usize = scripts.iter().map(|script| rows(script, &mut table)).sum();
    assert!(count >= 30, "{count}");

    let file = root.join("README.md");
    let readme = fs::read_to_string(&file).unwrap();
    let (before, rest) = readme.split_once(BEGIN).expect("the table begins");
    let (stands, after) = rest.split_once(END).expect("the table ends");
    if std::env::var_os("UPDATE_README").is_some() {
        fs::write(&file, format!("{before}{BEGIN}{table}{END}{after}")).unwrap();
        return;
    }
    assert_eq!(stands, table, "UPDATE_README=1 cargo test --test transcripts references writes it anew");
}
