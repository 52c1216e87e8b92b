//! The result's keys against the documented ones; CSV read back.

use serde_json::Value;

use super::{csv, json};
use crate::answer::record::*;
use crate::model::parameter::ParameterValues;
use crate::view::tests::sample::{beam, beam_ray};

fn keys(value: &Value) -> Vec<&str> {
    match value {
        Value::Object(map) => map.keys().map(String::as_str).collect(),
        _ => panic!("not an object: {value}"),
    }
}

fn parameters() -> ParameterValues {
    [("f".to_owned(), 0.3), ("F2".to_owned(), 100.0)].into()
}

/// Keys of `stickslip-result/1` in their order, of an answer of a structure.
const ANSWER: [&str; 18] = [
    "format",
    "scenario",
    "parameters",
    "outcome",
    "marginal",
    "ray",
    "p",
    "covering",
    "tie_break",
    "engine",
    "attempts",
    "pivots",
    "pairs",
    "check",
    "displacements",
    "members",
    "reactions",
    "size",
];

#[test]
fn an_answer_has_the_documented_keys() {
    let result = json::result(&beam(0.3, 100.0), "beam", &parameters(), false);
    assert_eq!(keys(&result), ANSWER);
    assert_eq!(result["format"], "stickslip-result/1");
    assert_eq!(result["scenario"], "beam");
    assert_eq!(result["parameters"]["F2"], 100.0);
    assert_eq!(result["outcome"], "normal");
    assert_eq!(result["ray"], Value::Null);
    assert_eq!(keys(&result["attempts"][0]), ["covering", "tie_break", "engine", "outcome"]);
    let pivot = ["step", "entering", "leaving", "p", "ties", "turned", "sentence"];
    assert_eq!(keys(&result["pivots"][1]), pivot);
    assert_eq!(result["pivots"][0]["turned"], Value::Null);
    let turned = &result["pivots"][1]["turned"];
    assert_eq!(keys(turned), ["pair", "joint", "from", "to"]);
    assert_eq!(turned["joint"], "tangential");
    let pair = [
        "id",
        "law",
        "state",
        "held",
        "x_n",
        "x_t",
        "z_n",
        "z_t",
        "bound",
        "reserve_plus",
        "reserve_minus",
        "position",
    ];
    assert_eq!(keys(&result["pairs"][0]), pair);
    assert_eq!(result["pairs"][5]["state"], "slip+");
    assert_eq!(result["pairs"][0]["held"], Value::Null);
    assert_eq!(keys(&result["check"]), ["min_w", "min_z", "complementarity", "equilibrium", "passed"]);
    assert_eq!(keys(&result["displacements"][0]), ["node", "ux", "uy", "rz"]);
    assert_eq!(keys(&result["members"][0]), ["bar", "element", "start", "end", "diagram", "extremes"]);
    assert_eq!(keys(&result["members"][0]["start"]), ["N", "Q", "M"]);
    assert_eq!(keys(&result["size"]), ["unknowns", "free", "pairs", "lcp"]);
    // −0 is not a result.
    assert!(!result.to_string().contains("-0.0,") && !result.to_string().contains("-0.0}"));
}

#[test]
fn a_bounded_record_tells_how_many_pivots_there_were() {
    let mut answer = beam(0.3, 100.0);
    answer.pivot_count = 200_001;
    let result = json::result(&answer, "beam", &parameters(), false);
    assert_eq!(result["pivot_count"], 200_001);
    assert_eq!(result["pivots"].as_array().map(Vec::len), Some(answer.pivots.len()));
}

#[test]
fn timings_only_on_request() {
    let result = json::result(&beam(0.3, 100.0), "beam", &parameters(), true);
    assert_eq!(keys(&result).last(), Some(&"timings"));
    assert_eq!(keys(&result["timings"]), ["factor", "condense", "lemke", "total"]);
}

#[test]
fn a_ray_has_the_last_vertex_but_no_displacements() {
    let mut answer = beam_ray();
    // Even if someone left them there.
    answer.displacements = Some(Vec::new());
    let result = json::result(&answer, "beam", &parameters(), false);
    let expected: Vec<&str> =
        ANSWER.into_iter().filter(|key| !["displacements", "members", "reactions"].contains(key)).collect();
    assert_eq!(keys(&result), expected);
    assert_eq!(keys(&result["ray"]), ["class", "verdict", "p", "driver", "direction", "mode", "explanation"]);
    assert_eq!(result["ray"]["class"], "mechanism");
    assert_eq!(result["ray"]["verdict"], "certified");
    assert_eq!(keys(&result["ray"]["direction"][0]), ["pair", "z_n", "z_t"]);
    assert_eq!(result["pairs"].as_array().map(Vec::len), Some(6));
}

#[test]
fn a_failure_has_neither_pairs_nor_ray() {
    for (outcome, word) in [
        (OutcomeKind::PivotLimit, "pivot-limit"),
        (OutcomeKind::Breakdown, "breakdown"),
        (OutcomeKind::CheckFailed, "check-failed"),
    ] {
        let answer = Answer { outcome, solution: Some(PlainSolution { z: vec![0.0], w: vec![0.0] }), ..beam_ray() };
        let result = json::result(&answer, "beam", &parameters(), false);
        assert_eq!(result["outcome"], word);
        assert_eq!(result["ray"], Value::Null);
        for absent in ["pairs", "displacements", "members", "reactions", "solution"] {
            assert!(result.get(absent).is_none(), "{absent} after {word}");
        }
        assert!(result.get("pivots").is_some() && result.get("check").is_some());
    }
}

#[test]
fn a_bare_lcp_has_a_solution_and_no_structure() {
    let answer = Answer {
        pairs: Vec::new(),
        displacements: None,
        members: None,
        reactions: None,
        solution: Some(PlainSolution { z: vec![0.0, 1.0, 3.0], w: vec![2.0, -0.0, 0.0] }),
        check: Check { equilibrium: None, ..Check::default() },
        size: Size { unknowns: None, free: None, pairs: 0, lcp: 3 },
        ..beam(0.3, 100.0)
    };
    let result = json::result(&answer, "cps", &ParameterValues::new(), false);
    assert_eq!(result["pairs"], Value::Array(Vec::new()));
    assert_eq!(result["solution"].to_string(), r#"{"z":[0.0,1.0,3.0],"w":[2.0,0.0,0.0]}"#);
    assert_eq!(result["check"]["equilibrium"], Value::Null);
    assert_eq!(keys(&result["size"]), ["pairs", "lcp"]);
    for absent in ["displacements", "members", "reactions"] {
        assert!(result.get(absent).is_none(), "{absent}");
    }
}

#[test]
fn full_precision_comes_back() {
    let mut answer = beam(0.3, 100.0);
    answer.pairs[0].x_n = 1.0 / 3.0;
    answer.pairs[1].x_n = 1e-300;
    let text = json::pairs(&answer).to_string();
    let read: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(read[0]["x_n"].as_f64(), Some(1.0 / 3.0));
    let mut out = Vec::new();
    csv::pairs(&mut out, &answer).expect("a vector takes everything");
    let text = String::from_utf8(out).expect("UTF-8");
    let cell = |line: usize| {
        let line = text.split("\r\n").nth(line).expect("a line");
        line.split(',').nth(4).and_then(|cell| cell.parse().ok())
    };
    assert_eq!(cell(1), Some(1.0 / 3.0));
    assert_eq!(cell(2), Some(1e-300));
}

#[test]
fn csv_quotes_what_it_must() {
    assert_eq!(csv::quoted("c1"), "c1");
    assert_eq!(csv::quoted("lower[0,8]"), "\"lower[0,8]\"");
    assert_eq!(csv::quoted("say \"x\"\n"), "\"say \"\"x\"\"\n\"");
    let answer = beam(0.3, 100.0);
    let all = [csv::pairs, csv::pivots, csv::displacements, csv::members];
    for (write, columns) in all.into_iter().zip([13, 10, 4, 8]) {
        let mut out = Vec::new();
        write(&mut out, &answer).expect("a vector takes everything");
        let text = String::from_utf8(out).expect("UTF-8");
        assert!(text.ends_with("\r\n") && text.lines().count() > 3);
        for line in text.lines() {
            // Commas outside quotes: every second piece between quotes.
            let outside = line.split('"').step_by(2).collect::<String>();
            assert_eq!(outside.matches(',').count() + 1, columns, "{line}");
        }
    }
}
