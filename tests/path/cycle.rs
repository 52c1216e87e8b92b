//! `cycle`: shakedown, slip to and fro, ratcheting, against closed forms.

use serde_json::json;
use stickslip::model::embedded;
use stickslip::model::load::load_text;

use super::find::{beam, near, number, report, session, text};
use crate::common::{lines, scenario_text};

/// A bar of six nodes with friction r = 30 each and flexibility 1e-5 m/kN between them, pulled at its end from 0 to F
/// and back. Unloading by F slips the end back where F > 2 r: with k nodes sliding both ways, each half cycle moves the
/// k-th node from the end by what the bars behind it stretch under the pull above 2 r per node.
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
        if pull == 60.0 {
            // The residual slip: the end has moved by the stretch 1e-5 (60 − 30) of the last bar.
            near(&last["pairs"][5]["total"], 3e-4, 1e-15);
        }
        if pull > 60.0 {
            assert_eq!(last["repeated"], true, "{last}");
            assert!(found["sentence"].as_str().unwrap().contains("to rounding"), "{found}");
        }
        if pull == 61.0 {
            near(&last["dissipated"][0], 3e-4, 1e-12);
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

/// A stop above the strip, from which it goes away: its gap grows by the same every day, and no force depends on it.
#[test]
fn a_gap_that_only_grows_hides_no_ratchet() {
    let stop = r#""contacts": [
        { "id": "stop", "node": "n10", "against": "ground", "normal": [-1, 0], "law": "frictionless", "gap": 1 },"#;
    let strip = embedded::load("ratchet").expect("embedded").text;
    let scenario = load_text("strip", &strip.replace("\"contacts\": [", stop), None).expect("sound");
    let found = report(&mut session(scenario), "cycle heat 0..50").unwrap();
    assert_eq!(found["kind"], "ratchets", "{found}");
    let last = found["cycles"].as_array().unwrap().last().unwrap();
    near(&last["gap_growth"], 0.0824, 1e-12);
    for pair in last["pairs"].as_array().unwrap().iter().filter(|pair| pair["pair"] != "stop") {
        near(&pair["net"], -0.0824, 1e-12);
    }
    let sentence = found["sentence"].as_str().unwrap();
    assert!(
        sentence.contains("gaps that stay open all the time wider by up to 0.0824, which no force feels"),
        "{sentence}"
    );
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
    // Pulled and pushed, each way bears r per node: 30 to and fro shakes down, more does not.
    near(&report(&mut session, "limit cycle F2 -30..30").unwrap()["shakes_down"], 30.0, 1e-6);
}

#[test]
fn what_cannot_be_repeated_is_refused() {
    let mut session = beam();
    for (command, part) in [
        ("cycle", "required"),
        ("cycle F2", "expected `cycle LOAD A..B"),
        ("cycle F2 5..5", "empty"),
        ("cycle F2 0..x", "not a range"),
        ("cycle F3 0..1", "no parameter or load case `F3`"),
        ("cycle f 0..1", "no factor of a load case depends on it"),
        ("cycle F2 0..1 0", "not a number of cycles"),
        ("limit cycle F2 0..1 2", ""),
        ("limit F2 pull", "of which load?"),
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
    // The sentence says how near it has come, and that the next cycle was the same.
    assert_eq!((&found["proof"]["proved"], &found["proof"]["map"]), (&true.into(), &"contracting".into()), "{found}");
    let sentence = found["sentence"].as_str().unwrap();
    assert!(sentence.contains("every further cycle is the same") && last["repeated"] == true, "{found}");
}

/// Two nodes whose slips press one another on and off, r = 0.5 x_n each, x_n = (1 + 0.9 b, 1 − 0.9 a):
/// ```text
///   x_τ = (L + 2 a − b, L + 2 b − a)
/// ```
/// Pushed by L = 0.8 on both, a goes to and fro while b rests at what it has slipped before: a's bound is
/// r = (1 + 0.9 b)/2, its stiffness 2, so that a half cycle moves it by (0.8 − 2 r)/2 and loses r times that.
pub(super) fn two_nodes() -> stickslip::session::Session {
    let text = r#"{"format": "stickslip/1", "title": "Two nodes", "parameters": {"L": 0.8, "c": 0.9},
        "contact_system": {"pairs": ["a", "b"], "friction": [0.5, 0.5],
            "stiffness": [[2, 0, 0, "c"], [0, 2, "-c", 0], [0, "-c", 2, -1], ["c", 0, -1, 2]],
            "loads": {"weight": {"vector": [1, 1, 0, 0]}, "push": {"factor": "L", "vector": [0, 0, 1, 1]}}}}"#;
    session(load_text("two", text, None).unwrap_or_else(|problems| panic!("{problems}")))
}

/// What a cycle of the two nodes dissipates after b has come to rest there.
fn lost_with(b: f64) -> f64 {
    let bound = 0.5 * (1.0 + 0.9 * b);
    2.0 * bound * (0.8 - 2.0 * bound) / 2.0
}

pub(super) fn lost(cycle: &serde_json::Value) -> f64 {
    cycle["dissipated"].as_array().unwrap().iter().map(number).sum()
}

#[test]
fn the_start_decides_where_slips_press_pairs_on() {
    let mut session = two_nodes();
    // Unloaded, both slip − at 0.8: 2 a − 1.45 b = −0.3, 2 b − 0.55 a = −0.3, b = −102/427.
    let first = lost_with(-102.0 / 427.0);
    // After a tangential load of (0, 1.5) that was taken away again, found by enumeration of schemes in rationals.
    let (a, b) = (-0.140_515_222_482_435_6, -0.351_873_536_299_765_8);
    let named = format!("cycle L 0..0.8 from a={a} b={b}");
    let second = lost_with(b);
    assert!((first - 0.005_882_992).abs() < 1e-9 && (second - 0.039_866_64).abs() < 1e-8);
    for (command, expected, rest) in [
        ("cycle L 0..0.8".to_owned(), first, -102.0 / 427.0),
        (named, second, b),
        (format!("cycle L 0..0.8 from ({a}, {b})"), second, b),
        // As slips, (0, 1.5) cannot stand: b slips back to 0.25, where 2 b = 0.5 x_n, and the cycle comes to the first.
        ("cycle L 0..0.8 from 0 1.5".to_owned(), first, -102.0 / 427.0),
    ] {
        let found = report(&mut session, &command).unwrap();
        assert_eq!(found["kind"], "alternates", "{command}: {found}");
        let last = found["cycles"].as_array().unwrap().last().unwrap();
        assert!((lost(last) - expected).abs() < 1e-12, "{command}: {last}");
        near(&last["pairs"][1]["total"], rest, 1e-12);
    }
    let found = report(&mut session, "cycle L 0..0.8 from 0 1.5").unwrap();
    assert_eq!((&found["start"][0]["slip"], &found["start"][1]["slip"]), (&0.0.into(), &0.25.into()));
    let shown = text(&mut session, "cycle L 0..0.6");
    assert!(shown.contains("another start may do otherwise: a slip of b changes the contact"), "{shown}");
    // b rests anywhere down to −230/427, where at no push at all 2 a − 1.45 b = 0.5 and 2 b − 0.55 a = −1 hold.
    let found = report(&mut session, "cycle L 0..0.8 from all").unwrap();
    assert_eq!(found["decides"], true);
    let all: Vec<f64> = found["starts"].as_array().unwrap().iter().map(|start| number(&start["dissipated"])).collect();
    let (least, most) = (all.iter().fold(1.0_f64, |a, b| a.min(*b)), all.iter().fold(0.0_f64, |a, b| a.max(*b)));
    assert!((least - first).abs() < 1e-9, "{found}");
    assert!((most - lost_with(-230.0 / 427.0)).abs() < 1e-8, "{found}");
}

/// Without coupling (c = 0) each half cycle of L > 1 = 2 r moves both by L − 1 against r: 2 (L − 1) a cycle, from any start.
#[test]
fn uncoupled_the_start_does_not_decide_and_the_static_theorem_proves_it() {
    let mut session = two_nodes();
    report(&mut session, "set c 0").unwrap();
    let found = report(&mut session, "cycle L 0..1.2 from all").unwrap();
    assert_eq!(found["decides"], false, "{found}");
    for start in found["starts"].as_array().unwrap() {
        near(&start["dissipated"], 0.4, 1e-12);
    }
    let found = report(&mut session, "cycle L 0..0.9 from all").unwrap();
    assert_eq!(found["decides"], false, "{found}");
    assert!(found["sentence"].as_str().unwrap().contains("after all 5 starts it shakes down"), "{found}");
    // Slow to come to rest, and nothing but rounding when it has.
    let mut dam = super::find::session(embedded::load("dam").expect("embedded"));
    let slow = report(&mut dam, "cycle water 0..1 from rock[1]=0.001").unwrap();
    assert_eq!(slow["kind"], "shakes-down", "{slow}");
    let found = report(&mut session, "cycle L 0..0.9").unwrap();
    // Slips that shift both forces by −L/2: 1/2 − 0.45 is left on both sides.
    near(&found["static"]["least_reserve"], 0.05, 1e-7);
    assert_eq!((&found["static"]["applies"], &found["static"]["proved"]), (&true.into(), &true.into()));
    let found = report(&mut session, "limit cycle L").unwrap();
    near(&found["from_every_start"], 1.0, 1e-7);
    assert!(number(&found["from_every_start"]) < 1.0);
    let mut beam = beam();
    for command in ["set f 0.3", "set F 100"] {
        report(&mut beam, command).unwrap();
    }
    let found = report(&mut beam, "limit cycle F2").unwrap();
    near(&found["from_every_start"], 60.0, 1e-5);
    assert!(number(&found["from_every_start"]) < 60.0);
    let found = report(&mut beam, "cycle F2 0..60").unwrap();
    assert_eq!((&found["static"]["applies"], &found["static"]["proved"]), (&true.into(), &false.into()));
    // Coupled: it does not hold.
    let mut coupled = two_nodes();
    let found = report(&mut coupled, "limit cycle L").unwrap();
    assert!(found["from_every_start"].is_null() && found["static"]["applies"] == false, "{found}");
}

fn system(text: &str) -> stickslip::session::Session {
    session(load_text("t", text, None).unwrap_or_else(|problems| panic!("{problems}")))
}

/// Klarbring's pair: at no load nothing touches, and at the full one it has lifted off, so that nothing but rounding is
/// lost, whatever the start.
#[test]
fn rounding_decides_nothing() {
    let mut session = system(
        r#"{"format": "stickslip/1", "title": "k", "parameters": {"P": 1}, "contact_system": {"pairs": ["c1"], "friction": [0.5],
            "stiffness": [[1, -1], [-1, 1.5]], "loads": {"load": {"factor": "P", "vector": [0.6, -1]}}}}"#,
    );
    let found = report(&mut session, "cycle load 0..1 5 from all").unwrap();
    assert_eq!(found["decides"], false, "{found}");
    for start in found["starts"].as_array().unwrap() {
        assert_eq!((&start["kind"], number(&start["dissipated"])), (&"shakes-down".into(), 0.0), "{found}");
    }
    // Elastic from a start that is left behind: what moves is rounding, and is shown as none.
    let found = report(&mut beam(), "cycle F2 0..1 from c6=0.0005").unwrap();
    let last = found["cycles"].as_array().unwrap().last().unwrap();
    assert_eq!(lost(last), 0.0, "{last}");
    for pair in last["pairs"].as_array().unwrap() {
        assert!(["there", "back", "net"].iter().all(|key| number(&pair[*key]) == 0.0), "{pair}");
    }
}

/// Two motions that only contact holds. Whatever holds them at a rate of 0 is rounding and no force.
///
/// Under the dead load alone c1 lifts off: the motion (1, 0 | 1, 0) gains 1 and parts c1 by 1 ≥ 0.25 · 1. With half the live load
/// both motions lose: 1.5 − 0.5 = 1 and 0.5 + 0.5 = 1.
#[test]
fn rounding_is_no_rate() {
    let text = r#"{"format": "stickslip/1", "title": "t", "parameters": {"P": 1}, "contact_system": {"pairs": ["c1", "c2"],
        "stiffness": [[4, -1, -4, 5], [-1, 2, 1, -3], [-4, 1, 4, -5], [5, -3, -5, 8]],
        "loads": {"dead": {"factor": 1, "vector": [0, 2, -1, 0]}, "live": {"factor": "P", "vector": [1, -1, 3, 0]}},
        "friction": [0.25, 0.125], "gap": [-0.25, 0.25], "kernel": [[-1, 1, 0, 1], [1, 0, 1, 0]]}}"#;
    let found = report(&mut system(text), "cycle live 0..1 30").unwrap();
    assert_eq!((&found["kind"], &found["collapse"]["verdict"]), (&"collapses".into(), &"certified".into()), "{found}");
    let found = report(&mut system(text), "cycle live 0.5..1 5").unwrap();
    assert_eq!((&found["kind"], &found["proof"]["proved"]), (&"alternates".into(), &true.into()), "{found}");
}

#[test]
fn slips_that_cannot_be_are_refused() {
    let mut session = two_nodes();
    for (command, part) in [
        ("cycle L 0..0.8 from", "expected `from all`"),
        ("cycle L 0..0.8 from 1", "expected 2 slips behind `from`, one for each pair, found 1"),
        ("cycle L 0..0.8 from a=1 2", "`2` is not a slip; expected PAIR=SLIP"),
        ("cycle L 0..0.8 from a=nan", "`a=nan` is not a slip"),
        ("cycle L 0..0.8 from d=1", "no pair `d`"),
        ("cycle L 0..0.8 from everything", "expected `from all`"),
        ("cycle L 0..0.8 from a", "how far has a slipped? e.g. `from a=0.001`"),
        ("cycle L 0..0.8 from all a=1", "`from all` chooses the slips itself; `a=1` is one too many"),
        ("cycle L 0..0.8 from a=1 a=2", "the slip of a is given twice"),
        ("cycle L 0..0.8 from *=1 b=2", "the slip of b is given twice"),
    ] {
        let refusal = report(&mut session, command).unwrap_err();
        assert!(refusal.contains(part), "{command}: {refusal}");
    }
    // 300 is all the beam can bear.
    let refusal = report(&mut beam(), "cycle F2 310..320 from c1=0.1").unwrap_err();
    assert!(refusal.contains("cannot stand under the first loads with these slips"), "{refusal}");
}

/// A node on a spring, pressed by 1 and lifted by L, pushed aside by 0.2 L: it opens at L = 1, where it has gone 0.2,
/// comes down there and sticks at x_τ = 0.2 (1 − L) < 0.5 (1 − L). Later cycles move it only while it is open, by 0.2
/// (3 − 1) to and fro, and lose nothing.
#[test]
fn a_pair_that_moves_while_it_is_open_shakes_down() {
    let text = r#"{"format": "stickslip/1", "title": "lift", "parameters": {"L": 0},
        "contact_system": {"pairs": ["a"], "friction": [0.5], "stiffness": [[2, 0], [0, 1]],
            "loads": {"weight": {"vector": [1, 0]}, "lift": {"factor": "L", "vector": [-1, -0.2]}}}}"#;
    let mut session = session(load_text("lift", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "cycle L 0..3").unwrap();
    assert_eq!(found["kind"], "shakes-down", "{found}");
    let last = found["cycles"].as_array().unwrap().last().unwrap();
    for (key, expected) in [("there", 0.4), ("back", -0.4), ("total", 0.2)] {
        near(&last["pairs"][0][key], expected, 1e-14);
    }
    assert!(lost(last).abs() < 1e-15, "{last}");
}

/// In rationals: the beam goes to and fro, the strip ratchets by -2 s (0.05 − 8.8 / EA) however its slips begin, the sliders
/// contract, two nodes keep what they have slipped. On a limit it is proved where the numbers are stored without rounding.
#[test]
fn what_repeats_is_proved_in_rationals() {
    let mut beam = beam();
    for command in ["set f 0.3", "set F 100"] {
        report(&mut beam, command).unwrap();
    }
    for pull in ["50", "60.0001", "61", "75", "150"] {
        let found = report(&mut beam, &format!("cycle F2 0..{pull}")).unwrap();
        let proof = &found["proof"];
        assert_eq!(proof["proved"], true, "{pull}: {proof}");
        assert!(number(&proof["net"]) < 1e-25 && number(&proof["distance"]) < 1e-12, "{pull}: {proof}");
    }
    // Exactly at its limit: as stored c6 is beyond it by a few ε of 100, and that is said.
    let found = report(&mut beam, "cycle F2 0..60").unwrap();
    let sentence = found["proof"]["sentence"].as_str().unwrap();
    assert!(
        found["proof"]["proved"] == false
            && sentence.contains("nothing but rounding: there the cycle comes to a limit")
    );
    let shown = text(&mut beam, "cycle F2 0..61");
    assert!(shown.contains("proved in rationals, for R and RF as they are stored"), "{shown}");
    let mut strip = session(embedded::load("ratchet").expect("embedded"));
    let found = report(&mut strip, "cycle heat 0..50").unwrap();
    assert_eq!(found["proof"]["proved"], true, "{}", found["proof"]);
    near(&found["proof"]["net"], 0.0824, 1e-14);
    let mut nodes = two_nodes();
    // Without coupling every number is stored as it is: at L = 1 both nodes come to both their limits, to the last digit.
    report(&mut nodes, "set c 0").unwrap();
    let found = report(&mut nodes, "cycle L 0..1").unwrap();
    assert_eq!((&found["kind"], &found["proof"]["proved"]), (&"shakes-down".into(), &true.into()), "{found}");
    report(&mut nodes, "set c 0.9").unwrap();
    for push in ["0.6", "0.8", "0.95", "1.2"] {
        let proof = &report(&mut nodes, &format!("cycle L 0..{push}")).unwrap()["proof"];
        assert_eq!((&proof["proved"], &proof["map"]), (&true.into(), &"identical".into()), "{push}: {proof}");
    }
}

/// A row of nodes on normal springs, joined by bars and pulled at its end: it slides at Σ f N, where no wedge holds it. Statics alone
/// would let springs press harder, so that no certificate says so: of three pairs all working schemes prove it, of eleven they
/// are too many, and what is not proved is not called a collapse.
#[test]
fn what_is_not_proved_is_no_collapse() {
    for (m, kind) in [(3, "collapses"), (11, "undecided")] {
        let mut stiffness = vec![vec![0.0; 2 * m]; 2 * m];
        (0..m).for_each(|i| stiffness[i][i] = 1000.0);
        for i in m..2 * m - 1 {
            for (a, b, by) in [(i, i, 1.0), (i + 1, i + 1, 1.0), (i, i + 1, -1.0), (i + 1, i, -1.0)] {
                stiffness[a][b] += 1000.0 * by;
            }
        }
        let own: Vec<f64> = (0..2 * m).map(|row| if row < m { 40.0 } else { 0.0 }).collect();
        let pull: Vec<f64> = (0..2 * m).map(|row| if row + 1 == 2 * m { -1.0 } else { 0.0 }).collect();
        let mut session = lines::read(&scenario_text(json!({
            "parameters": { "F": 10 },
            "contact_system": {
                "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "stiffness": stiffness,
                "friction": vec![0.5; m],
                "loads": { "own": { "vector": own }, "pull": { "factor": "F", "vector": pull } }
            }
        })));
        let limit = 20.0 * m as f64;
        let found = report(&mut session, &format!("cycle pull 0..{}", 1.5 * limit)).unwrap();
        assert_eq!(found["kind"], kind, "{found}");
        let sentence = found["sentence"].as_str().unwrap();
        assert!(sentence.contains(&format!("in cycle 1 on the way to pull = {}", 1.5 * limit)), "{sentence}");
        assert!(sentence.contains(&format!("at {limit}")), "{sentence}");
        assert_eq!(sentence.contains("not proved"), kind == "undecided", "{sentence}");
        assert_eq!(found["collapse"].is_null(), kind == "undecided", "{found}");
    }
}

/// A block of weight W = 10 that rubs with f = 1/2 on a floor and is held against sinking only, and a push H along it: it slides
/// away at f W = 5. Where the other load alone is 6, more than f W in any share of both, it slides away at once and does not get to
/// the first value; where it is 5, it stands there, and no push on that side can be added. Against it, it goes to and fro up to 2 f W = 10 without a slip.
#[test]
fn where_nothing_gets_away_from_the_first_value_no_end_shakes_down() {
    let mut session = lines::read(&scenario_text(json!({
        "parameters": { "H": 6 },
        "nodes": { "b": [0, 0] },
        "springs": [{ "at": "b", "direction": [0, 1], "stiffness": 1000 }],
        "contacts": [{ "id": "floor", "node": "b", "against": "ground", "normal": [0, 1], "friction": 0.5 }],
        "loads": {
            "w": { "items": [{ "point": { "at": "b", "force": [0, -10] } }] },
            "h": { "factor": "H", "items": [{ "point": { "at": "b", "force": [1, 0] } }] },
            "q": { "factor": 0, "items": [{ "point": { "at": "b", "force": [1, 0] } }] }
        }
    })));
    for (h, place) in [("6", "before the first cycle"), ("5", "in cycle 1 on the way to q = 1: at 0 ")] {
        report(&mut session, &format!("set H {h}")).unwrap();
        let found = report(&mut session, "limit cycle q 0..1").unwrap();
        assert!(found["shakes_down"].is_null() && found["kind_beyond"] == "collapses", "{found}");
        near(&found["beyond"], 0.0, 0.0);
        let why = found["why_beyond"].as_str().unwrap();
        assert!(why.starts_with(place) && (h == "5" || why.contains("at 0.000000 of it")), "{why}");
        let shown = text(&mut session, "limit cycle q 0..1");
        assert!(
            shown.starts_with("q from 0 towards 1: no end shakes down") && shown.contains("it collapses"),
            "{shown}"
        );
        let cycle = report(&mut session, "cycle q 0..1").unwrap();
        assert_eq!((&cycle["kind"], &cycle["sentence"]), (&"collapses".into(), &found["why_beyond"]));
    }
    near(&report(&mut session, "limit cycle q 0..-1").unwrap()["shakes_down"], -10.0, 1e-6);
}

/// Two nodes on springs whose cycles come nearer in one ratio q: by d in the last of them, so that d q/(1 − q), the sum of the
/// series, is left to come. That is what keeps it from being the same to 1e-12, and the sentence says so.
#[test]
fn what_is_left_to_come_is_told() {
    let point = |at: &str, x: f64, y: f64| json!({ "point": { "at": at, "force": [x, y] } });
    let rubs =
        |id: &str, at: &str| json!({ "id": id, "node": at, "against": "ground", "normal": [0, 1], "friction": 0.6 });
    let mut session = lines::read(&scenario_text(json!({
        "nodes": { "m0": [0, 0], "m1": [1, 0] },
        "springs": [
            { "at": "m0", "direction": [0, 1], "stiffness": 1000 }, { "at": "m1", "direction": [0, 1], "stiffness": 100 },
            { "between": ["m0", "m1"], "direction": [1, 0.5], "stiffness": 3000 },
            { "at": "m0", "direction": [1, 0], "stiffness": 300 }
        ],
        "contacts": [rubs("c0", "m0"), rubs("c1", "m1")],
        "loads": { "w": { "items": [point("m0", 0.0, -10.77), point("m1", 0.0, -8.969)] },
                   "p0": { "items": [point("m1", 45.91, 2.498), point("m0", -1.317, -4.558)] } }
    })));
    let found = report(&mut session, "cycle p0 0..0.26").unwrap();
    assert_eq!(found["kind"], "undecided");
    let turns = found["cycles"].as_array().unwrap();
    let [before, last] = [2, 1].map(|back| number(&turns[turns.len() - back]["difference"]));
    let ratio = last / before;
    let left = last * ratio / (1.0 - ratio);
    assert!(last < 1e-12 && left > 1e-12, "{last} {left}");
    let sentence = found["sentence"].as_str().unwrap();
    assert!(sentence.contains(&format!("together move it by {left:.1e} more")), "{sentence}");
}

/// A slider pressed by N on a rod with EA/L = 1 from a shoe that is pressed by 1 and holds: pushed to and fro by q it slips by
/// q − N/2, and loses N/2 on each part of the way. Where that is 1e-13 of what the shoe could lose, it is not nothing that
/// slips under a force, as it is for N = 0.
#[test]
fn a_loss_that_rounding_could_make_up_is_told_from_none() {
    for (pressed, said) in
        [(0.0, "nothing slips under a force"), (2e-13, "what slips under a force loses no more than rounding")]
    {
        let shoe = |id: &str, node: &str| json!({ "id": id, "node": node, "against": "ground", "normal": [0, 1], "friction": 0.5 });
        let force = |at: &str, force: [f64; 2]| json!({ "point": { "at": at, "force": force } });
        let text = scenario_text(json!({
            "materials": { "m": { "E": 100, "nu": 0 } },
            "sections": { "s": { "area": 0.01 } },
            "nodes": { "slider": [0, 0], "shoe": [1, 0] },
            "bars": [{ "id": "rod", "kind": "truss", "nodes": ["slider", "shoe"], "material": "m", "section": "s" }],
            "contacts": [shoe("light", "slider"), shoe("heavy", "shoe")],
            "loads": {
                "own": { "items": [force("slider", [0.0, -pressed]), force("shoe", [0.0, -1.0])] },
                "q": { "items": [force("slider", [1.0, 0.0])] }
            }
        }));
        let mut session = lines::read(&text);
        let found = report(&mut session, "cycle q -0.4..0.4").unwrap();
        assert_eq!(found["kind"], "shakes-down", "{found}");
        assert!(found["sentence"].as_str().unwrap().starts_with(said), "{found}");
    }
}
