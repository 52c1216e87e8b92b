//! Scripts: their status, what they say where they fail, scripts within scripts, and those that come along.

use std::fs;
use std::path::{Path, PathBuf};

use stickslip::session::{Format, Output, script};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

use super::lines::side_by_side;
use super::{refused, session, shown};

/// Runs a script; what it shows, its failures, its status.
fn replay(text: &str, format: Format, keep_going: bool) -> (String, Vec<String>, u8) {
    let mut session = session("beam");
    let mut out = Vec::new();
    let mut failures = Vec::new();
    let mut io = Output::new(&mut out, Style::default(), format, &Quiet);
    let ended = script::run(&mut session, "test", text, keep_going, &mut io, &mut |error| {
        failures.push(error.to_string());
    })
    .unwrap();
    (String::from_utf8(out).unwrap(), failures, ended.status)
}

#[test]
fn statuses_of_scripts() {
    for (text, keep_going, status, told) in [
        ("status", false, 0, 0),
        ("load beam-ray", false, 0, 0), // a ray in a script is a result
        ("expect outcome ray", false, 1, 1),
        ("bogus", false, 2, 1),
        ("set f 1; load nowhere.json\nstatus", false, 2, 1),
        ("bogus\nexpect error \"unknown command\"", false, 0, 0),
        ("bogus; expect error unknown; status", false, 0, 0),
        ("bogus\nstatus\nexpect error unknown", false, 2, 1),
        ("expect error unknown", false, 1, 1),
        ("bogus\nexpect outcome ray\nbogus", true, 2, 3),
        ("expect outcome ray\nbogus", true, 1, 2),
        ("quit\nbogus", false, 0, 0),
        ("load cycling; set tie-break first-row", false, 4, 0),
        ("load cycling; set tie-break first-row\nexpect outcome pivot-limit", false, 0, 0),
    ] {
        let (_, failures, found) = replay(text, Format::Text, keep_going);
        assert_eq!((found, failures.len()), (status, told), "{text}: {failures:?}");
    }
}

#[test]
fn a_failed_expectation_says_where_and_what() {
    let (_, failures, _) = replay("\nset f 0.3\nset F2 181; expect p < 0.1", Format::Text, false);
    assert_eq!(failures.len(), 1);
    assert!(failures[0].starts_with("test:3: expected p < 0.1, found 0.12820512"), "{}", failures[0]);
    let (_, failures, _) = replay("expect state c9 stick", Format::Text, false);
    assert!(failures[0].contains("no pair `c9`: the pairs are c1, c2"), "{}", failures[0]);
}

#[test]
fn json_lines_are_one_object_per_command() {
    let text = "status # first\n\npairs c1; bogus\nexpect error unknown\nplot slip\nset F2 181";
    let (out, _, status) = replay(text, Format::JsonLines, false);
    assert_eq!(status, 0);
    let objects: Vec<serde_json::Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let lines: Vec<u64> = objects.iter().map(|o| o["line"].as_u64().unwrap()).collect();
    assert_eq!(lines, [1, 3, 3, 4, 5, 6]);
    assert_eq!(objects[0]["report"]["outcome"], "normal");
    assert_eq!(objects[1]["report"][0]["id"], "c1");
    assert_eq!(objects[2]["ok"], false);
    assert_eq!(objects[2]["status"], 2);
    assert_eq!(objects[5]["report"]["parameters"]["F2"], 181.0);
}

#[test]
fn the_scripts_that_come_along_hold_and_repeat_to_the_byte() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/scripts");
    let paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(paths.len() >= 4);
    side_by_side(&paths, |path| {
        let text = fs::read_to_string(path).unwrap();
        for format in [Format::Text, Format::JsonLines] {
            let (first, failures, status) = replay(&text, format, false);
            assert_eq!((status, &failures), (0, &Vec::new()), "{}", path.display());
            assert_eq!(replay(&text, format, false).0, first, "{}", path.display());
        }
    });
}

#[test]
fn scripts_within_scripts() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner.stick");
    let outer = folder.path().join("outer.stick");
    fs::write(&inner, "set F2 100\nexpect outcome ray\n").unwrap();
    fs::write(&outer, format!("# calls\nsource {}\n", inner.display())).unwrap();
    let mut session = session("beam");
    let error = refused(&mut session, &format!("source {}", outer.display()));
    assert!(error.contains("outer.stick:2") && error.contains("inner.stick:2"), "{error}");
    assert_eq!(session.values()["F2"], 100.0);
    let own = folder.path().join("own.stick");
    fs::write(&own, format!("source {}", own.display())).unwrap();
    assert!(refused(&mut session, &format!("source {}", own.display())).contains("scripts within scripts"));
    shown(&mut session, "status");
}
