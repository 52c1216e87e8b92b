//! `cycle`: shakedown, slip to and fro, ratcheting, against closed forms.

use stickslip::model::embedded;
use stickslip::model::load::load_text;

use super::find::{beam, near, number, report, session, text};

/// A bar of six nodes with friction r = 30 each and flexibility 1e-5 m/kN between them, pulled at its end from 0 to F and
/// back. Unloading by F slips the end back where F > 2 r: with k nodes sliding both ways, each half cycle moves the k-th
/// node from the end by what the bars behind it stretch under the pull above 2 r a node.
#[test]
fn the_bar_shakes_down_up_to_twice_its_friction() {
    let mut session = beam();
    for command in ["set f 0.3", "set F 100"] {
        report(&mut session, command).unwrap();
    }
    let flexibility = 1e-5;
    for pull in [60.0, 60.0001, 61.0, 75.0, 150.0] {
        let found = report(&mut session, &format!("cycle F2 0..{pull}")).unwrap();
        let turns = found["cycles"].as_array().unwrap();
        let last = turns.last().unwrap();
        // The range of the pull that nodes beyond the first k bear is pull − 60 k: the slip of the k-th in a half cycle
        // is the stretch of all bars behind it, 1e-5 Σ (pull − 60 j), j = k …
        let excess = |k: usize| (pull - 60.0 * k as f64).max(0.0);
        let slip = |k: usize| flexibility * (k..=5).map(excess).sum::<f64>();
        let dissipated: f64 = (1..=5).map(|k| 30.0 * slip(k)).sum();
        assert_eq!(found["kind"], if pull <= 60.0 { "shakes-down" } else { "alternates" }, "{found}");
        for (k, pair) in ["c6", "c5", "c4"].iter().enumerate() {
            let entry = last["pairs"].as_array().unwrap().iter().find(|entry| entry["pair"] == *pair).unwrap();
            near(&entry["there"], slip(k + 1), 1e-14);
            near(&entry["back"], -slip(k + 1), 1e-14);
        }
        for half in last["dissipated"].as_array().unwrap() {
            near(half, dissipated, 1e-12);
        }
    }
}

/// Moseley's lead on the roof: 0.0824 downhill every day (the sum is in `scenarios/scripts/ratchet.stick`).
#[test]
fn the_strip_on_a_slope_ratchets() {
    let mut session = session(embedded::load("ratchet").expect("embedded"));
    let found = report(&mut session, "cycle heat 0..50").unwrap();
    assert_eq!(found["kind"], "ratchets");
    let last = found["cycles"].as_array().unwrap().last().unwrap();
    for pair in last["pairs"].as_array().unwrap() {
        near(&pair["net"], -0.0824, 1e-12);
    }
    assert!(text(&mut session, "cycle heat 0..50").contains("ratchets, -0.0824 per cycle"));
    report(&mut session, "set slope 0").unwrap();
    let found = report(&mut session, "cycle heat 0..50").unwrap();
    assert_eq!(found["kind"], "alternates");
}

/// The largest pull that shakes down is 60, whichever end is looked at first; more than 180 cannot be carried.
#[test]
fn the_largest_pull_that_shakes_down() {
    let mut session = beam();
    for command in ["set f 0.3", "set F 100"] {
        report(&mut session, command).unwrap();
    }
    for command in ["limit cycle F2", "limit cycle F2 0..10", "limit cycle pull 0..170"] {
        let found = report(&mut session, command).unwrap();
        near(&found["shakes_down"], 60.0, 1e-6);
        assert!(number(&found["beyond"]) > 60.0 && number(&found["beyond"]) < 60.000_001, "{found}");
        assert_eq!(found["kind_beyond"], "alternates");
    }
    let found = report(&mut session, "cycle F2 0..181").unwrap();
    assert_eq!((&found["kind"], &found["collapse"]["class"]), (&"collapses".into(), &"mechanism".into()));
    // Pulled and pushed, each way bears r a node: 30 to and fro shakes down, more does not.
    near(&report(&mut session, "limit cycle F2 -30..30").unwrap()["shakes_down"], 30.0, 1e-6);
}

#[test]
fn what_cannot_be_repeated_is_refused() {
    let mut session = beam();
    for (command, part) in [
        ("cycle", "required"),
        ("cycle F2", "expected `cycle LOAD A..B"),
        ("cycle F2 5..5", "empty"),
        ("cycle F2 0..x", "no range"),
        ("cycle F3 0..1", "no parameter or load case `F3`"),
        ("cycle f 0..1", "no factor of a load case depends on it"),
        ("cycle F2 0..1 0", "no number of cycles"),
        ("limit cycle F2 0..1 2", ""),
        ("limit F2 pull", "expected one load"),
    ] {
        let refusal = report(&mut session, command).unwrap_err();
        assert!(refusal.contains(part), "{command}: {refusal}");
    }
}

/// Two sliders on R = [[4, −3], [−3, 4]], positive definite, that stay closed: R z = λ − F is bounded by friction, so that no
/// slip can be left behind for ever. The slips converge to 3/16 to and fro of the first, a little less left each time.
#[test]
fn the_tail_of_a_convergence_is_no_ratchet() {
    let text = r#"{"format": "stickslip/1", "title": "Two sliders", "parameters": {"P": 1},
        "contact_system": {"pairs": ["a", "b"], "friction": [0.5, 0.5],
            "stiffness": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 4, -3], [0, 0, -3, 4]],
            "loads": {"weight": {"factor": 1, "vector": [7, 8, -1, -1]},
                      "push": {"factor": "P", "vector": [-0.5, 0.5, -1, 0]}}}}"#;
    let mut session = session(load_text("sliders", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "cycle P -2..5").unwrap();
    assert_eq!(found["kind"], "alternates");
    let last = found["cycles"].as_array().unwrap().last().unwrap();
    near(&last["pairs"][0]["there"], -last["pairs"][0]["back"].as_f64().unwrap(), 1e-12);
    near(&last["pairs"][0]["there"].as_f64().unwrap().abs().into(), 0.1875, 1e-9);
}
