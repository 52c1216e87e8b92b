//! `calibrate`: friction from measurements, against structures whose friction is known.

use serde_json::Value;
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::session::Session;

use super::find::{beam, near, number, report, session, text};

/// `z_t c1 = …, …` as the session computes them now.
fn as_computed(session: &mut Session, quantities: &str) -> String {
    let shown = report(session, &format!("show {quantities}")).unwrap();
    let each = |row: &Value| format!("{} = {:e}", row["quantity"].as_str().unwrap(), number(&row["value"]));
    shown.as_array().unwrap().iter().map(each).collect::<Vec<_>>().join(", ")
}

#[test]
fn the_hot_pipe_tells_its_friction_by_its_slips() {
    let mut session = session(embedded::load("pipeline").expect("embedded"));
    report(&mut session, "set f 0.3").unwrap();
    let slips = as_computed(&mut session, "z_t c4, z_t c5, z_t c6");
    let mixed = as_computed(&mut session, "ux s3, z_t c1, uy elb");
    report(&mut session, "stages").unwrap();
    let history = as_computed(&mut session, "stage 2 z_t c6, stage 3 z_t c6, stage 3 z_t c2");
    report(&mut session, "solve").unwrap();
    // A history has no exact path over friction: it is sought from several starts.
    for (start, measured, global) in [("0.05", &slips, true), ("1", &mixed, true), ("0.7", &history, false)] {
        report(&mut session, &format!("set f {start}")).unwrap();
        let found = report(&mut session, &format!("calibrate f where {measured}")).unwrap();
        near(&found["groups"][0]["value"], 0.3, 1e-6);
        assert_eq!((&found["global"], &found["groups"][0]["identifiable"]), (&global.into(), &true.into()), "{found}");
        assert_eq!(found["degrees_of_freedom"], 2, "{found}");
    }
    // A pair that is lifted off tells nothing: at f = 0.3 c2 and c3 are open.
    let found = report(&mut session, &format!("calibrate f where {slips}")).unwrap();
    assert_eq!((&found["groups"][0]["open"], &found["groups"][0]["slip"]), (&2.into(), &4.into()));
}

/// Example 1, slips in 1e-5 m: with r = 100 f < F2 = 150 ≤ 2 r two supports slip, z_6 = 1e-5 (2 · 150 − 3 r).
#[test]
fn the_beam_tells_one_friction_with_its_error() {
    let mut session = beam();
    report(&mut session, "set F2 150").unwrap();
    let found = report(&mut session, "calibrate f where z_t c6 = 0.001").unwrap();
    near(&found["groups"][0]["value"], 2.0 / 3.0, 1e-10);
    near(&found["measurements"][0]["sensitivity"][0], -300e-5, 1e-12);
    assert!(found["groups"][0]["standard_error"].is_null() && found["degrees_of_freedom"] == 0, "{found}");
    // z_6 = 1e-5 (300 − 300 f), z_5 = 1e-5 (150 − 200 f): normal equations with measured 0.001, 0.0002 and 1e-5 each off by
    // (r_6, r_5): f = Σ a (b − m) / Σ a², a = (300, 200), b = (300, 150), m = (100, 20).
    let expected = (300.0 * 200.0 + 200.0 * 130.0) / (300.0_f64.powi(2) + 200.0_f64.powi(2));
    let residuals = [300.0 - 300.0 * expected - 100.0, 150.0 - 200.0 * expected - 20.0];
    let squares: f64 = residuals.iter().map(|r| (r * 1e-5).powi(2)).sum();
    let slope_squares = (300e-5_f64).powi(2) + (200e-5_f64).powi(2);
    let found = report(&mut session, "calibrate f where z_t c6 = 0.001, z_t c5 = 0.0002").unwrap();
    near(&found["groups"][0]["value"], expected, 1e-9);
    near(&found["squares"], squares, 1e-12 * squares.max(1e-6));
    near(&found["groups"][0]["standard_error"], (squares / slope_squares).sqrt(), 1e-7);
    near(&found["measurements"][1]["residual"], residuals[1] * 1e-5, 1e-12);
    // With errors, these are what the standard error follows from: 1/√Σ (a/σ)².
    let found = report(&mut session, "calibrate f where z_t c6 = 0.001 ± 1e-5, z_t c5 = 0.0002 ± 1e-5").unwrap();
    near(&found["groups"][0]["standard_error"], 1e-5 / slope_squares.sqrt(), 1e-9);
    near(&found["groups"][0]["value"], expected, 1e-9);
}

/// Where all pairs stick, 40 ≤ 100 f, nothing but the bound 0.4 shows of f.
#[test]
fn pairs_that_stick_tell_a_lower_bound_only() {
    let mut session = beam();
    report(&mut session, "set F2 40").unwrap();
    let found = report(&mut session, "calibrate f where z_t c6 = 0").unwrap();
    let group = &found["groups"][0];
    assert_eq!((&group["identifiable"], &group["stick"]), (&false.into(), &6.into()), "{found}");
    near(&group["interval"][0], 0.4, 1e-9);
    near(&group["interval"][1], 1.0, 0.0);
    assert!(found["other_minima"].as_array().unwrap().is_empty(), "{found}");
    let shown = text(&mut session, "calibrate f where z_t c6 = 0");
    assert!(shown.contains("f: anything from 0.4 to 1 explains as much"), "{shown}");
}

/// Three nodes in a row joined by springs k = 1000, each pressed by 100, the last one pulled by 110; the first also on
/// a spring of 500. With all slipping: 500 z_a = 110 − 100 (fa + 2 fb), 1000 (z_b − z_a) = 110 − 200 fb, 1000 (z_c −
/// z_b) = 110 − 100 fb.
fn row(measured: &str) -> Session {
    let text = format!(
        r#"{{"format": "stickslip/1", "title": "row",
        "parameters": {{"fa": {{"value": 0.5, "min": 0, "max": 1}}, "fb": {{"value": 0.5, "min": 0, "max": 1}}}},
        "measured": {measured},
        "contact_system": {{"pairs": ["a", "b", "c"], "friction": ["fa", "fb", "fb"],
            "stiffness": [[1000, 0, 0, 0, 0, 0], [0, 1000, 0, 0, 0, 0], [0, 0, 1000, 0, 0, 0],
                [0, 0, 0, 1500, -1000, 0], [0, 0, 0, -1000, 2000, -1000], [0, 0, 0, 0, -1000, 1000]],
            "loads": {{"weight": {{"vector": [100, 100, 100, 0, 0, 0]}}, "pull": {{"vector": [0, 0, 0, 0, 0, -110]}}}}}}}}"#
    );
    session(load_text("row", &text, None).unwrap_or_else(|problems| panic!("{problems}")))
}

#[test]
fn two_groups_are_told_apart_where_the_measurements_do() {
    // fa = 0.2, fb = 0.3: z_a = 30/500, z_b − z_a = 50/1000, z_c − z_b = 80/1000.
    let mut session = row(r#"{"z_t a": 0.06, "z_t b": 0.11, "z_t c": {"value": 0.19}}"#);
    let found = report(&mut session, "calibrate").unwrap();
    for (group, expected) in found["groups"].as_array().unwrap().iter().zip([0.2, 0.3]) {
        near(&group["value"], expected, 1e-9);
    }
    assert_eq!((&found["global"], &found["degrees_of_freedom"]), (&false.into(), &1.into()), "{found}");
    assert!(found["sentence"].as_str().unwrap().contains("a better one elsewhere is not ruled out"), "{found}");
    near(&found["measurements"][0]["sensitivity"][1], -0.4, 1e-9);
    // The first sticks: 1000 z_b = 110 − 200 fb = 10 at fb = 0.5 pulls it by 10 of its 100 fa: from 0.1 on.
    let found = report(&mut session, "calibrate where z_t b = 0.01, z_t c = 0.07").unwrap();
    near(&found["groups"][1]["value"], 0.5, 1e-9);
    assert_eq!(found["groups"][1]["identifiable"], true);
    let first = &found["groups"][0];
    assert_eq!((&first["identifiable"], &first["stick"]), (&false.into(), &1.into()), "{found}");
    near(&first["interval"][0], 0.1, 1e-9);
    near(&first["interval"][1], 1.0, 0.0);
    // One slip measured twice shows a combination only.
    let found = report(&mut session, "calibrate where z_t a = 0.06, max z_t a = 0.06").unwrap();
    for group in found["groups"].as_array().unwrap() {
        assert_eq!(group["identifiable"], false, "{found}");
        assert!(group["why"].as_str().unwrap().contains("only a combination"), "{found}");
    }
}

/// A node that is lifted off shows nothing of its friction. c1 slips by P − f on a spring of stiffness 1 under weight
/// 1, c2 likewise by P/2 − f; measured is c2 alone, or both so that it is met where c2 comes to rest, at f = 1/2: from
/// there on c2 tells nothing, below it does.
#[test]
fn a_kink_at_the_end_of_a_level_stretch_is_no_friction_found() {
    let text = r#"{ "format": "stickslip/1", "title": "t",
      "parameters": { "f": { "value": 0.9, "min": 0, "max": 1 }, "P": 1 },
      "contact_system": { "pairs": ["c1", "c2"], "stiffness": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        "loads": { "weight": { "vector": [1, 1, 0, 0] }, "pull": { "factor": "P", "vector": [0, 0, -1, -0.5] } },
        "friction": ["f", "f"] } }"#;
    let mut session = session(load_text("t.json", text, None).unwrap());
    for measured in ["z_t c2 = 0", "z_t c2 = -0.001", "z_t c2 = -0.001 ± 0.01"] {
        let found = report(&mut session, &format!("calibrate f 0.1..0.9 where {measured}")).unwrap();
        let group = &found["groups"][0];
        assert_eq!(group["identifiable"], false, "{measured}: {found}");
        assert!(group["standard_error"].is_null(), "{measured}: {found}");
        near(&group["interval"][0], 0.5, 1e-6);
        near(&group["interval"][1], 0.9, 1e-9);
    }
    // c1 shows it all the same.
    let found = report(&mut session, "calibrate f 0.1..0.9 where z_t c2 = 0, z_t c1 = 0.4").unwrap();
    assert_eq!(found["groups"][0]["identifiable"], true, "{found}");
    near(&found["groups"][0]["value"], 0.6, 1e-9);
}

/// A measurement that the model meets to the last digit over a whole stretch.
#[test]
fn a_stretch_that_meets_the_measurements_ends() {
    let text = r#"{ "format": "stickslip/1", "title": "t", "parameters": { "f": { "value": 0.6, "min": 0, "max": 2 } },
      "contact_system": { "pairs": ["c1", "c2"], "stiffness": [[3, 0, 0, 0], [0, 3, 0, 0], [0, 0, 3, 1], [0, 0, 1, 3]],
        "loads": { "weight": { "vector": [1, 1, 0, 0] }, "pull": { "vector": [0, 0, -0.7, -0.1] } },
        "friction": ["f", 0.3] } }"#;
    let mut session = session(load_text("t.json", text, None).unwrap());
    let measured = as_computed(&mut session, "x_t c1, x_t c2");
    let found = report(&mut session, &format!("calibrate f 0.75..2 where {measured}")).unwrap();
    assert_eq!(found["groups"][0]["identifiable"], false, "{found}");
}

#[test]
fn open_pairs_tell_nothing() {
    let text = r#"{"format": "stickslip/1", "title": "lifted", "parameters": {"f": 0.5}, "measured": {"z_t a": 0.2},
        "contact_system": {"pairs": ["a"], "friction": ["f"], "stiffness": [[2, 0], [0, 1]],
            "loads": {"all": {"vector": [-1, -0.2]}}}}"#;
    let mut session = session(load_text("lifted", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "calibrate").unwrap();
    let group = &found["groups"][0];
    assert_eq!((&group["identifiable"], &group["open"]), (&false.into(), &1.into()), "{found}");
    assert!(group["why"].as_str().unwrap().contains("open: nothing shows"), "{found}");
}

/// The beam slides as a whole where 6 f F < F2, below f = 250/600. More slip at the end than there: the least is at the
/// end of the path; less than under f = 1: at that of the range. Neither has a standard error, because there the sum of
/// squares slopes.
#[test]
fn an_end_of_the_path_or_the_range_has_no_standard_error() {
    let mut session = beam();
    report(&mut session, "set F2 250").unwrap();
    for (command, value) in [
        ("calibrate f 0..1 where z_t c6 = 0.1 ± 1e-4, z_t c5 = 0.1 ± 1e-4", 250.0 / 600.0),
        ("calibrate f 0..1 where z_t c6 = 0 ± 1e-4, z_t c5 = 0 ± 1e-4", 1.0),
    ] {
        let found = report(&mut session, command).unwrap();
        let group = &found["groups"][0];
        near(&group["value"], value, 1e-9);
        assert!(group["at_end"] == true && group["standard_error"].is_null(), "{command}: {found}");
        // Why the range is shorter than asked for.
        let sentence = found["sentence"].as_str().unwrap();
        assert!(sentence.contains("; the path ends there: ") && sentence.contains("f = 0.4167"), "{sentence}");
    }
}

#[test]
fn what_cannot_be_calibrated_is_refused() {
    for (command, part) in [
        ("calibrate", "nothing was measured"),
        ("calibrate F2 where z_t c6 = 0.001", "F2 is not the friction of any pair"),
        ("calibrate g where z_t c6 = 0.001", "no parameter or load case `g`"),
        ("calibrate f where z_t c9 = 0.001", "no pair `c9`"),
        ("calibrate f where slip c1 = 0.001", "calibrate: "),
        ("calibrate f where z_t c6", "calibrate: `` is not a comparison"),
        ("calibrate f where z_t c6 < 1", "expected `where QUANTITY = VALUE"),
        ("calibrate \"\"", "expected the name of a friction parameter"),
        ("calibrate f where", "expected `where QUANTITY = VALUE"),
        ("calibrate f where \"\"", "expected `where QUANTITY = VALUE"),
        ("calibrate f where z_t c6 = 1 ± 0", "a standard error is greater than 0"),
        ("calibrate f where z_t c6 = 1 ± -1", "what stands after `±` is not negative"),
        ("calibrate f where state c6 = stick", "expected `where QUANTITY = VALUE"),
        ("calibrate f where limit pull = 300", "not measured on a structure in one state"),
        ("calibrate f where z_t c6 = 0.001, x_t c1 = 5", "of different kinds (a length and a force)"),
        ("calibrate f where z_t c6 = 0.001 ± 1e-5, z_t c5 = 5", "z_t c5 has no error, others have"),
        ("calibrate f f where z_t c6 = 0", "f is named twice"),
        ("calibrate f 1..0 where z_t c6 = 0", "the range 1..0 is empty"),
        ("calibrate f -1..1 where z_t c6 = 0", "friction is not negative"),
    ] {
        let refusal = report(&mut beam(), command).unwrap_err();
        assert!(refusal.contains(part), "{command}: {refusal}");
    }
    // More is sought than measured; no friction bears the load.
    let refusal = report(&mut row(r#"{"z_t c": 0.1}"#), "calibrate").unwrap_err();
    assert!(refusal.contains("1 measurement cannot tell 2 frictions"), "{refusal}");
    let mut session = beam();
    report(&mut session, "set F2 700").unwrap();
    let refusal = report(&mut session, "calibrate f where z_t c6 = 0.001").unwrap_err();
    assert!(refusal.contains("at no start is there an answer") && refusal.contains("outcome is ray"), "{refusal}");
}

#[test]
fn measurements_in_a_file_are_judged_where_they_stand() {
    for (measured, part) in [
        (r#"{"z_t d": 1}"#, "no pair `d`"),
        (r#"{"state a": 1}"#, "is a word, not a number"),
        (r#"{"z_t a": "far"}"#, "expected a number"),
        (r#"{"z_t a": {"error": 1}}"#, "missing"),
        (r#"{"z_t a": {"value": 1, "error": 0}}"#, "error of a measurement must be positive"),
        (r#"{"z_t a, z_t b": 1}"#, "a measurement is of one quantity"),
        (r#"{"z_t a": {"value": 1, "eror": 1}}"#, "unknown key"),
    ] {
        let text = format!(
            r#"{{"format": "stickslip/1", "title": "t", "measured": {measured}, "contact_system": {{"pairs": ["a", "b"],
            "stiffness": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "loads": {{}}}}}}"#
        );
        let problems = load_text("t", &text, None).expect_err(measured).to_string();
        assert!(problems.contains(part), "{measured}: {problems}");
    }
}

/// The portal, 240 heavy, slides under its wind of 30 below f = 30/240 = 1/8: there the path ends, and a friction that the
/// measurements would have lower stands there; what no friction changes leaves all of them from there on.
#[test]
fn an_end_of_the_range_without_an_answer_does_not_end_the_search() {
    let mut session = session(embedded::load("portal").expect("embedded"));
    for range in ["", "0..1", "0.1..1"] {
        let found = report(&mut session, &format!("calibrate f {range} where z_t l-heel = 0.001")).unwrap();
        near(&found["groups"][0]["value"], 0.125, 1e-6);
        assert_eq!(found["groups"][0]["at_end"], true, "{found}");
        let found = report(&mut session, &format!("calibrate f {range} where x_t l-heel = 1")).unwrap();
        assert_eq!(found["groups"][0]["identifiable"], false, "{found}");
        near(&found["groups"][0]["interval"][0], 0.125, 1e-6);
        near(&found["groups"][0]["interval"][1], 1.0, 0.0);
    }
}
