//! Every file in `tests/invalid` and the whole message it gets; and no text makes the reading panic.
//!
//! `STICKSLIP_BLESS=1 cargo test --test bad_input` rewrites the `.expected` files from what the program says now:
//! read the difference before committing it.

mod fuzz_seeds;

use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use stickslip::model::catalog::load_named_or_file;
use stickslip::model::embedded;
use stickslip::model::load::{load_file, load_text};

fn invalid_files() -> Vec<PathBuf> {
    let folder = Path::new("tests/invalid");
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .expect("cargo runs tests in the root of the package")
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    files.sort();
    files
}

/// The memory of the machine that runs the test does not belong in a file.
fn without_machine(message: &str) -> String {
    let mut lines = Vec::new();
    for line in message.lines() {
        match line.split_once(", this machine has ") {
            Some((before, _)) => lines.push(format!("{before}, this machine has …")),
            None => lines.push(line.to_string()),
        }
    }
    lines.join("\n")
}

#[test]
fn every_invalid_file_gets_its_message() {
    let bless = std::env::var_os("STICKSLIP_BLESS").is_some();
    let mut wrong = Vec::new();
    let files = invalid_files();
    assert!(files.len() > 100, "only {} files found", files.len());
    for file in files {
        let found = match load_file(&file) {
            Ok(_) => "loaded without a problem".to_string(),
            Err(problems) => without_machine(&problems.to_string()),
        };
        let expected_file = file.with_extension("expected");
        if bless {
            fs::write(&expected_file, found + "\n").unwrap();
            continue;
        }
        let expected = fs::read_to_string(&expected_file).unwrap_or_default();
        if expected.trim_end() != found {
            wrong.push(format!("{}\n--- expected\n{expected}--- found\n{found}\n", file.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_expected_message_has_its_file() {
    for entry in fs::read_dir("tests/invalid").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "expected") {
            assert!(path.with_extension("json").exists(), "{}", path.display());
        }
    }
}

#[test]
fn a_missing_file_and_an_unknown_name_say_what_was_expected() {
    let problems = load_named_or_file("no/such.json").unwrap_err().to_string();
    assert!(problems.starts_with("no/such.json: cannot read the file: "), "{problems}");
    let problems = load_named_or_file("baem").unwrap_err().to_string();
    assert!(
        problems.starts_with(
            "baem: no embedded scenario and no file has this name (did you mean \"beam\"?)\n  \
             help: expected the path of a scenario file or one of beam, beam-limit, "
        ),
        "{problems}"
    );
    assert_eq!(load_named_or_file("beam").unwrap().name, "beam");
    let file = load_named_or_file("scenarios/beam.json").unwrap();
    assert_eq!(file.path.as_deref(), Some(Path::new("scenarios/beam.json")));
}

#[test]
fn text_that_is_not_utf8_is_refused_at_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("latin1.json");
    fs::write(&path, b"{\n  \"title\": \"Tr\xe4ger\" }").unwrap();
    let problems = load_file(&path).unwrap_err();
    let problem = &problems.problems[0];
    assert_eq!((problem.line, problem.column), (2, 15));
    assert_eq!(problem.message, "the file is not UTF-8");
}

#[test]
fn more_than_twenty_problems_are_counted() {
    let nodes: Vec<String> = (0..50).map(|k| format!("\"n{k}\": [0]")).collect();
    let text = format!("{{ \"format\": \"stickslip/1\", \"title\": \"t\", \"nodes\": {{ {} }} }}", nodes.join(", "));
    let problems = load_text("many", &text, None).unwrap_err();
    assert_eq!(problems.problems.len(), 20);
    assert_eq!(problems.more, 30);
    assert!(problems.to_string().ends_with("\nand 30 more problems"));
}

/// An embedded scenario with some bytes replaced, removed or repeated.
fn mutated() -> impl Strategy<Value = String> {
    let names: Vec<&'static str> = embedded::names().collect();
    let piece = prop_oneof![
        Just(""),
        Just("-1"),
        Just("0"),
        Just("1e999"),
        Just("1e308"),
        Just("[]"),
        Just("{}"),
        Just("null"),
        Just("\"\""),
        Just("\"f\""),
        Just("["),
        Just("]"),
        Just("{"),
        Just("}"),
        Just(","),
        Just("\""),
        Just("\\u0000"),
        Just("é"),
        Just("99999999999"),
        Just("[0, 0]"),
    ];
    let edit = (any::<prop::sample::Index>(), 0usize..8, piece);
    (prop::sample::select(names), prop::collection::vec(edit, 1..5)).prop_map(|(name, edits)| {
        let mut text: Vec<char> = embedded::text(name).unwrap().chars().collect();
        for (at, removed, piece) in edits {
            let from = at.index(text.len());
            let to = (from + removed).min(text.len());
            text.splice(from..to, piece.chars());
        }
        text.into_iter().collect()
    })
}

/// Any JSON, with the keys and words of the format more often than chance.
fn random_json() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "format",
        "stickslip/1",
        "title",
        "nodes",
        "bars",
        "plates",
        "quads",
        "contacts",
        "loads",
        "id",
        "node",
        "edge",
        "against",
        "ground",
        "normal",
        "law",
        "friction",
        "gap",
        "bound",
        "skip",
        "size",
        "divisions",
        "origin",
        "x",
        "y",
        "A",
        "f",
        "lower",
        "lower.top",
        "lower[0,0]",
        "items",
        "point",
        "at",
        "force",
        "lcp",
        "M",
        "q",
        "names",
        "contact_system",
        "pairs",
        "stiffness",
        "kernel",
        "materials",
        "sections",
        "E",
        "nu",
        "parameters",
        "value",
    ]);
    let leaf = prop_oneof![
        word.clone().prop_map(|word| format!("\"{word}\"")),
        any::<f64>().prop_filter("JSON", |x| x.is_finite()).prop_map(|x| format!("{x:e}")),
        (-3i32..9).prop_map(|x| x.to_string()),
        Just("null".to_string()),
        Just("true".to_string()),
    ];
    leaf.prop_recursive(5, 64, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(|list| format!("[{}]", list.join(","))),
            prop::collection::vec((word.clone(), inner), 0..6).prop_map(|entries| {
                let entries: Vec<String> =
                    entries.into_iter().map(|(key, value)| format!("\"{key}\":{value}")).collect();
                format!("{{{}}}", entries.join(","))
            }),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_of_a_scenario_panics(text in mutated()) {
        if let Err(problems) = load_text("mutated", &text, None) {
            prop_assert!(!problems.problems.is_empty());
            prop_assert!(!problems.to_string().is_empty());
        }
    }

    #[test]
    fn no_json_panics(body in random_json()) {
        let _ = load_text("random", &body, None);
        let text = format!(
            r#"{{"format":"stickslip/1","title":"t","materials":{{"m":{{"E":1,"nu":0}}}},"sections":{{"s":{{"area":1,"inertia":1}}}},"nodes":{{"A":[0,0],"B":[1,0]}},"plates":[{{"id":"lower","origin":[0,0],"size":[1,1],"divisions":[2,2],"thickness":1,"material":"m","plane":"stress"}}],"contacts":{body},"supports":{body},"loads":{body},"bars":{body}}}"#
        );
        let _ = load_text("random", &text, None);
    }
}
