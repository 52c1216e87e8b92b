//! `map`, `find` and `envelope` in space, along paths on Coulomb's cone.

use std::f64::consts::PI;

use serde_json::{Value, json};
use stickslip::session::Session;

use super::find::{near, number};
use crate::common::lines::{read, report, text};
use crate::common::scenario_text;

/// A block of weight 2 with f = 1/2 pushed by (X, Y), on springs of `k` along the normal and `k_t` along the
/// tangents, rigid where these are 0: it stands where |(X, Y)| ≤ 1.
fn block(k: f64, k_t: f64) -> Session {
    read(&scenario_text(json!({
        "parameters": { "X": 0.1, "Y": 0.2, "f": 0.5 },
        "contact_system": {
            "pairs": ["a"], "tangents": 2, "stiffness": [[k, 0, 0], [0, k_t, 0], [0, 0, k_t]], "friction": ["f"],
            "loads": { "weight": { "factor": 2, "vector": [1, 0, 0] }, "x": { "factor": "X", "vector": [0, 1, 0] },
                       "y": { "factor": "Y", "vector": [0, 0, 1] } } }
    })))
}

fn region<'a>(map: &'a Value, state: Option<&str>) -> &'a Value {
    let regions = map["regions"].as_array().expect("regions");
    let found: Vec<&Value> = regions.iter().filter(|region| region["states"]["a"].as_str() == state).collect();
    let [one] = found[..] else { panic!("{state:?}: {} regions in {map}", found.len()) };
    one
}

/// A disc of area π f² W², here half of it or a quarter; around it the block slips against its springs, or nothing
/// stands, which is certified.
#[test]
fn two_pushes_on_a_block_give_the_disc_of_friction() {
    for (k, k_t, outside, line, area) in [
        (1.0, 1.0, Some("slip"), "map X -1.5..1.4 Y 0..1.3", [PI / 2.0, 2.9 * 1.3]),
        (0.0, 0.0, None, "map X 0..1.4 Y 0..1.3", [PI / 4.0, 1.4 * 1.3]),
    ] {
        let map = report(&mut block(k, k_t), line).expect("a map");
        near(&region(&map, Some("stick"))["area"], area[0], 1e-8);
        near(&region(&map, outside)["area"], area[1] - area[0], 1e-8);
        assert_eq!((&map["exact"], &map["complete"]), (&false.into(), &true.into()));
        assert!(map["notes"].to_string().contains("Coulomb's cone in steps"), "{}", map["notes"]);
        if outside.is_none() {
            let collapse = region(&map, None);
            assert_eq!((&collapse["class"], &collapse["verdict"]), (&"mechanism".into(), &"certified".into()));
        }
    }
}

/// Held by a spring along the normal alone the block slides away at the same circle: ∫ √(1 − Y²) from 0.5 to 0.8 of
/// it is what stands. A few lines tell it, each with its end.
#[test]
fn a_block_on_a_spring_slides_away_at_the_disc_of_friction() {
    let map = report(&mut block(1.0, 0.0), "map X 0..1 Y 0.5..0.8").expect("a map");
    let below = |y: f64| 0.5 * (y * (1.0 - y * y).sqrt() + y.asin());
    let area = below(0.8) - below(0.5);
    near(&region(&map, Some("stick"))["area"], area, 1e-9);
    let collapse = region(&map, None);
    near(&collapse["area"], 0.3 - area, 1e-9);
    assert_eq!((&collapse["class"], &collapse["verdict"]), (&"mechanism".into(), &"certified".into()));
    assert_eq!(map["complete"], true);
}

/// At X = 0.6 a path over Y ends at 0.8, as narrowly as a breakpoint is located: rigid, or held by a spring along the
/// normal.
#[test]
fn the_end_of_a_path_is_as_narrow_as_a_breakpoint() {
    for k in [0.0, 1.0] {
        let mut session = block(k, 0.0);
        report(&mut session, "set X 0.6").expect("set");
        let path = report(&mut session, "trace Y to 2").expect("a path");
        let end = path["along"]["values"].as_array().and_then(|values| values.last()).map(number).expect("an end");
        assert!((end - 0.8).abs() <= 1e-11, "{k}: {end}");
    }
}

/// Pushed by 1 along y and by X along x, the block stands from f = √(1 + X²)/2 on: 1/4 (X √(1 + X²) + asinh X) over X.
#[test]
fn friction_against_a_push() {
    let mut session = block(1.0, 1.0);
    report(&mut session, "set Y 1").expect("set");
    let map = report(&mut session, "map X 0..1 f 0.3..0.9").expect("a map");
    let below = 0.25 * (2f64.sqrt() + 1f64.asinh());
    near(&region(&map, Some("slip"))["area"], below - 0.3, 1e-9);
    near(&region(&map, Some("stick"))["area"], 0.9 - below, 1e-9);
}

/// With the cone off the block stands where the polygon of four facets holds it: in a square, K tan(π/K) f² W² = 4.
#[test]
fn the_polygon_has_a_map_of_its_own() {
    let mut session = block(1.0, 1.0);
    for rule in ["set facets 4", "set cone off"] {
        report(&mut session, rule).expect(rule);
    }
    let map = report(&mut session, "map X -1.5..1.4 Y -1.2..1.3").expect("a map");
    near(&region(&map, Some("stick"))["area"], 4.0, 1e-8);
    assert!(map["notes"].to_string().contains("solved one by one"), "{}", map["notes"]);
}

/// z = −(X, Y)(1 − 1/|(X, Y)|) where that is beyond 1: at X = 2 the slip along t1 is −1 at Y = 0, farther elsewhere,
/// and −3/2 at |(X, Y)| = 4.
#[test]
fn places_are_found_along_the_cone() {
    let mut session = block(1.0, 1.0);
    report(&mut session, "set X 2").expect("set");
    let envelope = report(&mut session, "envelope z_t1 a over Y -3..4").expect("an envelope");
    let peaks = &envelope["envelope"][0];
    near(&peaks["largest"]["value"], -1.0, 1e-9);
    near(&peaks["least"]["value"], 2.0 / 20f64.sqrt() - 2.0, 1e-9);
    let found = report(&mut session, "find Y 0..4 where z_t1 a = -1.5").expect("found");
    near(&found["places"][0]["value"], 12f64.sqrt(), 1e-9);
    assert_eq!(found["exact"], false);
    report(&mut session, "set X 0.6").expect("set");
    let found = report(&mut session, "find Y -2..2 where state a = stick").expect("found");
    near(&found["holds"][0][0], -0.8, 1e-9);
    near(&found["holds"][0][1], 0.8, 1e-9);
    assert!(text(&mut session, "find Y -2..2 where state a = stick").contains("followed on Coulomb's cone in steps"));
}

/// The push passes the disc of friction at a distance of 1 − 1e-10: the block sticks over 2 √2e-10 of the way, far less
/// than a step.
#[test]
fn what_is_done_and_undone_within_a_step_is_found() {
    let mut session = block(1.0, 1.0);
    for line in ["set X 0.9999999999", "set Y -2"] {
        report(&mut session, line).expect(line);
    }
    let path = report(&mut session, "trace Y to 2.13").expect("a path");
    let places: Vec<f64> =
        path["breakpoints"].as_array().expect("places").iter().map(|at| number(&at["value"])).collect();
    let half = (1.0 - 0.9999999999f64.powi(2)).sqrt();
    assert_eq!(places.len(), 2, "{path}");
    assert!((places[0] + half).abs() < 1e-8 && (places[1] - half).abs() < 1e-8, "{places:?} {half}");
}
