//! `map`: regions and their areas, against closed forms.

use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::path::envelope::Axis;
use stickslip::path::map::{LeftOut, map};
use stickslip::path::start::PathError;
use stickslip::solve::prepare;

use super::find::{beam, near, number, report, session, text};
use stickslip::session::Output;
use stickslip::view::style::Style;
use stickslip::watch::{Quiet, Watch};

fn region<'a>(map: &'a Value, states: &[(&str, &str)]) -> &'a Value {
    let found = map["regions"]
        .as_array()
        .unwrap()
        .iter()
        .find(|region| states.iter().all(|(pair, state)| region["states"][*pair] == *state));
    found.unwrap_or_else(|| panic!("no region {states:?} in {map}"))
}

fn total(map: &Value) -> f64 {
    map["regions"].as_array().unwrap().iter().map(|region| number(&region["area"])).sum()
}

/// Example 1 with weights of 100: the k-th support from the pulled end slips at F2 = 100 k f. Below F2 = 400 the strip
/// between 100 k f and 100 (k + 1) f has the area ∫ min(100 (k + 1) f, 400) − min(100 k f, 400) df over 0 … 1.
#[test]
fn the_beam_over_friction_and_pull() {
    let mut session = beam();
    session.execute("set F 100", &mut quiet(&mut Vec::new())).unwrap();
    for command in ["map f 0..1 F2 0..400", "map F2 0..400 f 0..1"] {
        let map = report(&mut session, command).unwrap();
        assert_eq!(map["exact"], true);
        // ∫ min(a f, 400) df over 0 … 1
        let below = |a: f64| if a <= 400.0 { a / 2.0 } else { 400.0 - 400.0 * 400.0 / (2.0 * a) };
        for slipping in 0..6 {
            let states: Vec<(String, &str)> =
                (1..=6).map(|k| (format!("c{k}"), if k > 6 - slipping { "slip+" } else { "stick" })).collect();
            let states: Vec<(&str, &str)> = states.iter().map(|(id, state)| (id.as_str(), *state)).collect();
            let found = region(&map, &states);
            let area = below(100.0 * (slipping + 1) as f64) - below(100.0 * slipping as f64);
            near(&found["area"], area, 1e-9);
            assert_eq!(found["answers"], 1);
        }
        let collapse = map["regions"].as_array().unwrap().iter().find(|region| region["states"].is_null()).unwrap();
        near(&collapse["area"], 400.0 - below(600.0), 1e-9);
        assert_eq!((&collapse["outcome"], &collapse["class"]), (&"ray".into(), &"mechanism".into()));
        assert_eq!(collapse["verdict"], "certified");
        assert!((total(&map) - 400.0).abs() < 1e-9);
        assert_eq!(map["regions"].as_array().unwrap().len(), 7);
    }
}

fn quiet(text: &mut Vec<u8>) -> Output<'_> {
    Output::text(text, Style::default(), &Quiet)
}

/// One pair on a normal spring of 2 and a tangential one of 3, coupled by `c`: λ = R z + RF with RF = (N, T).
fn block(c: f64) -> String {
    format!(
        r#"{{"format": "stickslip/1", "title": "A block", "parameters": {{"f": 0.5, "N": 1, "T": 0}},
           "contact_system": {{"pairs": ["a"], "friction": ["f"], "stiffness": [[2, {c}], [{c}, 3]],
             "loads": {{"weight": {{"factor": "N", "vector": [1, 0]}}, "push": {{"factor": "T", "vector": [0, 1]}}}}}}}}"#
    )
}

/// Two loads: the cone |T| ≤ f N is left and right of the slips; every bound is a straight line.
#[test]
fn two_loads_give_polygons() {
    let mut session = session(load_text("block.json", &block(0.0), None).unwrap_or_else(|error| panic!("{error}")));
    let map = report(&mut session, "map T -2..2 N -1..2").unwrap();
    // N > 0 presses: sticking where |T| < N / 2: a triangle of height 2 and base 2; the rest of N > 0 slips to both sides.
    near(&region(&map, &[("a", "stick")])["area"], 2.0, 1e-9);
    near(&region(&map, &[("a", "slip+")])["area"], 3.0, 1e-9);
    near(&region(&map, &[("a", "slip-")])["area"], 3.0, 1e-9);
    near(&region(&map, &[("a", "open")])["area"], 4.0, 1e-9);
    assert_eq!(map["regions"].as_array().unwrap().len(), 4);
    assert!(notes(&map).contains("nowhere is there more than one state of forces: that is proved"), "{map}");
}

fn notes(map: &Value) -> String {
    map["notes"].as_array().unwrap().iter().filter_map(Value::as_str).collect::<Vec<_>>().join("; ")
}

/// As below, over both loads with f = 1.5: sticking for |T| < 1.5 N, opening for T > 1.25 N, slip + for T < −1.5 N. Both are
/// possible between the lines to T = 2, also where the upper end T = 2 sticks as well: ∫ min(1.5 N, 2) − 1.25 N dN from 0 to
/// 1.6. Where lines meet there is no region of no area.
#[test]
fn other_answers_are_found_where_both_ends_stick() {
    let mut session = session(load_text("block.json", &block(2.4), None).unwrap_or_else(|error| panic!("{error}")));
    session.execute("set f 1.5", &mut quiet(&mut Vec::new())).unwrap();
    let map = report(&mut session, "map T -2..2 N -1..2").unwrap();
    assert_eq!(map["regions"].as_array().unwrap().len(), 4, "{map}");
    let several = map["regions"].as_array().unwrap().iter().find(|region| !region["other"].is_null()).unwrap();
    assert_eq!((&several["states"]["a"], &several["other"]["a"]), (&"stick".into(), &"open".into()));
    let both =
        0.25 / 2.0 * (4.0_f64 / 3.0).powi(2) + 2.0 * (1.6 - 4.0 / 3.0) - 0.625 * (1.6 * 1.6 - (4.0_f64 / 3.0).powi(2));
    // Two answers nearer than 1e-8 are one: there a bound is known to that.
    near(&several["area"], both, 1e-8);
    assert_eq!(several["answers"], 3);
    assert!(notes(&map).contains("from all answers at its upper one"), "{map}");
    assert!((total(&map) - 12.0).abs() < 1e-9);
}

/// Two blocks with the same friction, the first pushed by T, coupled by k; its slip −z adds c z to its pressure:
/// T − 3 z = f (1 − c z) while it slips alone, and k z = f where it takes the second with it: a parabola in f.
#[test]
fn friction_against_load_gives_curves() {
    let (c, k): (f64, f64) = (0.5, 1.0);
    let scenario = format!(
        r#"{{"format": "stickslip/1", "title": "Two blocks", "parameters": {{
             "f": {{"value": 0.2, "min": 0, "max": 0.5}}, "T": {{"value": 0, "min": 0, "max": 3}}}},
           "contact_system": {{"pairs": ["a", "b"], "friction": ["f", "f"],
             "stiffness": [[2, 0, {c}, 0], [0, 2, 0, 0], [{c}, 0, 3, {k}], [0, 0, {k}, 3]],
             "loads": {{"weight": {{"factor": 1, "vector": [1, 1, 0, 0]}},
                        "push": {{"factor": "T", "vector": [0, 0, 1, 0]}}}}}}}}"#
    );
    let mut session = session(load_text("blocks.json", &scenario, None).unwrap_or_else(|error| panic!("{error}")));
    let map = report(&mut session, "map f T").unwrap();
    // ∫ over 0 … 1/2 of f, of 3 f / k + f (1 − c f / k) − f, and the rest of 1.5.
    let stick = 0.125;
    let alone = 3.0 / k * 0.125 - c / k * 0.125 / 3.0;
    near(&region(&map, &[("a", "stick"), ("b", "stick")])["area"], stick, 1e-9);
    near(&region(&map, &[("a", "slip-"), ("b", "stick")])["area"], alone, 1e-9);
    near(&region(&map, &[("a", "slip-"), ("b", "slip+")])["area"], 1.5 - stick - alone, 1e-9);
    assert_eq!(map["regions"].as_array().unwrap().len(), 3);
}

/// Beyond the critical friction (f c > 3): with N = 1 sticking is possible for |T| < f, opening for T > 3 / c, and both,
/// with slipping, between. Upwards the block sticks until T = f, downwards it stays open until T = 3 / c.
#[test]
fn several_answers_are_found_from_both_ends() {
    let mut session = session(load_text("block.json", &block(2.4), None).unwrap_or_else(|error| panic!("{error}")));
    session.execute("set N 1", &mut quiet(&mut Vec::new())).unwrap();
    let map = report(&mut session, "map T 0..2 f 1.3..1.8").unwrap();
    let both = map["regions"].as_array().unwrap().iter().find(|region| !region["other"].is_null()).unwrap();
    assert_eq!((&both["states"]["a"], &both["other"]["a"]), (&"stick".into(), &"open".into()));
    assert_eq!(both["answers"], 3);
    // ∫ f − 3 / c df over 1.3 … 1.8
    near(&both["area"], (1.8 * 1.8 - 1.3 * 1.3) / 2.0 - 1.25 * 0.5, 1e-9);
    near(&region(&map, &[("a", "open")])["area"], 2.0 * 0.5 - (1.8 * 1.8 - 1.3 * 1.3) / 2.0, 1e-9);
    assert!(text(&mut session, "map T 0..2 f 1.3..1.8").contains("hatched: more than one answer"));
}

/// The arch of 21 blocks, 44 pairs: with so much friction it turns about joints and does not slide when it falls, at
/// 0.148316546 g (limit analysis by an independent linear programme, eight digits) whatever the friction.
#[test]
fn an_arch_of_44_pairs_is_mapped_to_its_end() {
    let mut session = session(embedded::load("arch").expect("embedded"));
    let map = report(&mut session, "map quake 0.14..0.16 f 0.9..1").unwrap();
    assert_eq!((&map["exact"], &map["complete"]), (&true.into(), &true.into()), "{map}");
    let area = |outcome: &str| -> f64 {
        let regions = map["regions"].as_array().unwrap().iter().filter(|region| region["outcome"] == outcome);
        regions.map(|region| number(&region["area"])).sum()
    };
    assert!((area("answer") - 0.1 * 0.008_316_546).abs() < 1e-10, "{map}");
    assert!((area("answer") + area("ray") - 0.1 * 0.02).abs() < 1e-12, "{map}");
    for region in map["regions"].as_array().unwrap().iter().filter(|region| region["outcome"] == "ray") {
        assert_eq!(region["verdict"], "certified", "{region}");
    }
}

/// Width and height of a block of weight 10 that 4 pushes at its top: it turns where 4 h > 5 b. No exact path leads
/// over either, and that is said; the bound lies where halving finds it.
#[test]
fn two_lengths_are_mapped_by_answers_of_their_own() {
    let text = r#"{ "format": "stickslip/1", "title": "block",
        "parameters": { "b": { "value": 2, "min": 0.4, "max": 3 }, "h": { "value": 1, "min": 0.5, "max": 2 } },
        "materials": { "m": { "E": 20000, "nu": 0.2 } },
        "plates": [ { "id": "p", "origin": [0, 0], "size": ["b", "h"], "divisions": [1, 1], "thickness": 1, "material": "m",
                      "plane": "stress" } ],
        "contacts": [ { "id": "base", "edge": "p.bottom", "against": "ground", "friction": 0.6 } ],
        "loads": { "weight": { "items": [ { "point": { "at": "p.top", "force": [0, -10] } } ] },
                   "push": { "items": [ { "point": { "at": "p.top", "force": [4, 0] } } ] } } }"#;
    let mut session = session(load_text("block", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let map = report(&mut session, "map b 0.7..0.9 h 0.9..1.1").unwrap();
    assert_eq!((&map["exact"], &map["complete"]), (&false.into(), &true.into()));
    let regions = map["regions"].as_array().unwrap();
    let collapse = regions.iter().find(|region| region["outcome"] == "ray").unwrap();
    // ∫ 0.8 h − 0.7 dh over 0.9 … 1.1
    near(&collapse["area"], 0.4 * (1.1 * 1.1 - 0.9 * 0.9) - 0.7 * 0.2, 1e-9);
    assert_eq!((&collapse["verdict"], regions.len()), (&"certified".into(), 2));
    assert!(
        notes(&map).contains("no exact path leads over b") && notes(&map).contains("were not looked for along"),
        "{map}"
    );
}

/// What cannot be mapped is refused in words, and nothing is exported before there is a map.
#[test]
fn what_is_no_map_is_refused() {
    let mut session = beam();
    for (command, part) in [
        ("map", "required"),
        ("map f 0..1", "expected two parameters"),
        ("map f 0..1 f 0..1", "f is named twice"),
        ("map f 0..1 F3 0..1", "no parameter or load case `F3`"),
        ("map f 1..0 F2 0..400", "the smaller value comes first"),
        ("map f -1..1 F2 0..400", "f"),
        ("map f 0..1 F2 0..400 of", "quantity"),
        ("map f 0..1 F2 0..400 of limit pull", "is not read from one state"),
        ("export map x.svg", "no map yet"),
        ("export map x.vtu", "must end in"),
    ] {
        let refusal = report(&mut session, command).unwrap_err();
        assert!(refusal.contains(part), "{command}: {refusal}");
    }
}

/// A map is exported as one of the values it was drawn under, and forgotten with its scenario.
#[test]
fn a_map_tells_the_values_it_was_drawn_under() {
    let folder = tempfile::tempdir().expect("a place");
    let file = folder.path().join("map.svg");
    let export = format!("export map {}", file.display());
    let figure = || std::fs::read_to_string(&file).expect("written");
    let mut session = beam();
    report(&mut session, "map f 0.2..0.8 F2 100..200").unwrap();
    // the axes themselves may move
    for (command, stale) in [("set f 0.3", false), ("set F 90", true)] {
        report(&mut session, command).unwrap();
        report(&mut session, &export).unwrap();
        assert_eq!(figure().contains("drawn under F = 100"), stale, "{command}");
    }
    report(&mut session, "load block").unwrap();
    assert!(report(&mut session, &export).unwrap_err().contains("no map yet"));
}

#[test]
fn a_map_of_too_many_axes_is_refused_by_its_own_name() {
    let refusal = report(&mut beam(), "map f 0..1 F 0..1 F2 0..1 weight 0..1").unwrap_err();
    assert!(refusal.starts_with("map: expected two"), "{refusal}");
}

/// Ctrl-C after some of its lines: what they show is drawn, with areas that fill the plane, and no answer is looked
/// for any more. Before the first lines there is nothing to draw.
#[test]
fn a_stopped_map_draws_what_it_has() {
    struct Impatient(AtomicUsize);
    impl Watch for Impatient {
        fn progress(&self, what: &str, _: f64) {
            if !what.starts_with("f = ") {
                return;
            }
            let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1));
        }
        fn stop(&self) -> bool {
            self.0.load(Ordering::Relaxed) == 0
        }
    }
    let axis = |name: &str, range| Axis { name: name.to_owned(), range };
    let scenario = embedded::load("beam").expect("embedded");
    let values = scenario.parameter_values();
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let stopped = |lines: usize| {
        let watch = Impatient(AtomicUsize::new(lines));
        map(prepared.case(&scenario, &values).watched(&watch), [axis("f", [0.0, 1.0]), axis("F2", [0.0, 400.0])], None)
    };
    assert_eq!(stopped(1), Err(PathError::Interrupted));
    let found = (2..200).find_map(|k| stopped(8 * k).ok()).expect("a map");
    let (why, lines) = found.left_out.expect("left out");
    assert!(why == LeftOut::Stopped && lines >= 17, "{why:?} {lines}");
    let areas: f64 = found.regions.iter().map(|region| region.area).sum();
    assert!((areas - 400.0).abs() < 1e-9, "{areas}");
    // Strips of 1/16 at most lie between lines: no bound of a region is farther from its place than that.
    let collapse: f64 = found.regions.iter().filter(|region| region.states.is_none()).map(|region| region.area).sum();
    assert!((collapse - 400.0 / 3.0).abs() < 400.0 / 16.0, "{collapse}");
    assert!(found.regions.iter().all(|region| region.answers.is_none() && region.verdict.is_none()));
    assert!(found.notes[0].starts_with("stopped before its end"), "{:?}", found.notes);
}
