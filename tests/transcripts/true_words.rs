//! Words that say what is so: advice that helps, brackets between what they are between, slips that are slips, limits of 0.

use std::process::Command;

use super::lines::{read, report, text, told};

/// Two nodes on springs. `up` is pulled off the ground by 1 and sideways by 10, against 1 each way: it parts and moves 10
/// along the ground. `on` is pressed by 100 and pushed by P against a spring k: it slips by (P − f 100)/k.
const TWO: &str = r#"{"format": "stickslip/1", "title": "two", "parameters": {"f": 0.1, "P": 12, "k": 2},
 "nodes": {"u": [0, 0], "o": [1, 0]},
 "springs": [{"at": "u", "direction": [1, 0], "stiffness": 1}, {"at": "u", "direction": [0, 1], "stiffness": 1},
             {"at": "o", "direction": [1, 0], "stiffness": "k"}],
 "contacts": [{"id": "up", "node": "u", "against": "ground", "normal": [0, 1], "friction": "f"},
              {"id": "on", "node": "o", "against": "ground", "normal": [0, 1], "friction": "f"}],
 "loads": {"weight": {"items": [{"point": {"at": "o", "force": [0, -100]}}, {"point": {"at": "u", "force": [10, 1]}}]},
           "push": {"factor": "P", "items": [{"point": {"at": "o", "force": [1, 0]}}]},
           "never": {"factor": 0, "items": [{"point": {"at": "o", "force": [1, 0]}}]}}}"#;

#[test]
fn what_is_no_option_gets_advice_that_helps() {
    let ended = Command::new(env!("CARGO_BIN_EXE_stickslip")).args(["solve", "beam", "--json"]).output().unwrap();
    let said = String::from_utf8(ended.stderr).unwrap();
    assert_eq!((ended.status.code(), said.contains("`--format json` is")), (Some(2), true), "{said}");
    let mut session = read(TWO);
    let said = told(&mut session, "solve --json").unwrap_err();
    assert!(said.contains("`export result FILE.json`"), "{said}");
    let said = told(&mut session, "plot slip scale -5").unwrap_err();
    assert!(said.contains("`scale` makes no sense here") && !said.contains("-- -5"), "{said}");
    let said = told(&mut session, "pairs --wide").unwrap_err();
    assert!(said.contains("--wide") && !said.contains("to pass"), "{said}");
}

#[test]
fn brackets_of_find_lie_between_runs_whether_or_not_these_have_an_answer() {
    let said = text(&mut read(TWO), "find k 1..4 where z_t on > 1.5");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        said.contains("narrowed to a bracket between two more") && !said.contains("answer on either side"),
        "{said}"
    );
}

#[test]
fn the_largest_slip_of_a_sweep_is_of_a_pair_in_contact() {
    let report = report(&mut read(TWO), "sweep P 12..14 2").unwrap();
    let columns: Vec<&str> = report["columns"].as_array().unwrap().iter().filter_map(|name| name.as_str()).collect();
    let at = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for (row, push) in rows.iter().zip([12.0, 14.0]) {
        assert_eq!(row[at("open")], 1, "{row}");
        let slip = row[at("max_slip")].as_f64().unwrap();
        assert!((slip - (push - 0.1 * 100.0) / 2.0).abs() < 1e-12, "{row}");
        assert_eq!(row[at("max_slip_pair")], "on");
    }
}

#[test]
fn the_limit_of_a_case_that_never_acts_says_so() {
    let mut session = read(TWO);
    let said = "the factor of never is 0 in the file: by itself the case never acts";
    assert!(text(&mut session, "limit never").contains(said));
    assert!(!text(&mut session, "limit push").contains("never acts"));
}

/// A body on three feet, of which those off the corner are pressed by N each and are an arm of 1 away: about the corner it
/// takes 2 f N. Pressed at the corner alone it takes nothing, whatever its weight.
#[test]
fn one_pressed_foot_takes_no_torque() {
    let body = |weight: f64, n: f64| {
        let foot = |id: &str, node: &str| {
            format!(r#"{{"id": "{id}", "node": "{node}", "against": "ground", "normal": [0, 0, 1], "friction": 0.3}}"#)
        };
        let press = |node: &str, force: f64| format!(r#"{{"point": {{"at": "{node}", "force": [0, 0, {}]}}}}"#, -force);
        format!(
            r#"{{"format": "stickslip/1", "title": "feet", "dimension": 3, "parameters": {{"T": 0}},
             "nodes": {{"A": [0, 0, 0], "B": [1, 0, 0], "C": [0, 1, 0]}}, "rigid": [{{"id": "r", "nodes": ["A", "B", "C"]}}],
             "contacts": [{}, {}, {}], "loads": {{"w": {{"items": [{}, {}, {}]}},
             "turn": {{"factor": "T", "items": [{{"point": {{"at": "A", "moment": [0, 0, 1]}}}}]}}}}}}"#,
            foot("a", "A"),
            foot("b", "B"),
            foot("c", "C"),
            press("A", weight),
            press("B", n),
            press("C", n)
        )
    };
    for weight in [10.0, 1e4] {
        let found = report(&mut read(&body(weight, 0.0)), "limit turn").unwrap();
        assert_eq!(found["limit"], 0.0, "{found}");
    }
    let found = report(&mut read(&body(10.0, 1e-5)), "limit turn").unwrap();
    let expected = 2.0 * 0.3 * 1e-5;
    assert!((found["limit"].as_f64().unwrap() - expected).abs() < 1e-4 * expected, "{found}");
}
