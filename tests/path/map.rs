//! `map`: regions and their areas, against closed forms.

use serde_json::Value;
use stickslip::model::load::load_text;

use super::find::{beam, near, number, report, session, text};

fn region<'a>(map: &'a Value, states: &[(&str, &str)]) -> &'a Value {
    let found = map["regions"].as_array().unwrap().iter().find(|region| {
        states.iter().all(|(pair, state)| region["states"][*pair] == *state)
    });
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

use stickslip::session::Output;
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

fn quiet(text: &mut Vec<u8>) -> Output<'_> {
    Output::text(text, Style::default(), &Quiet)
}

/// One pair on a normal spring of 2 and a tangential one of 3, coupled by `c`: R = [[2, c], [c, 3]] with RF = (−N, T)
/// (x = R z + RF …, so a load of N presses and T pushes).
fn block(c: f64) -> String {
    format!(
        r#"{{"format": "stickslip/1", "title": "A block", "parameters": {{
             "f": {{"value": 0.5, "min": 0, "max": 1}}, "N": {{"value": 1}}, "T": {{"value": 0}}}},
           "contact_system": {{"pairs": [{{"id": "a", "friction": "f"}}],
             "stiffness": [[2, {c}], [{c}, 3]],
             "cases": {{"normal": [1, 0], "shear": [0, 1]}},
             "factors": {{"normal": "N", "shear": "T"}}}}}}"#
    )
}

/// Two loads: the cone |T| ≤ f N is left and right of the slips; every bound is a straight line.
#[test]
fn two_loads_give_polygons() {
    let mut session = session(load_text("block.json", &block(0.0)).unwrap_or_else(|error| panic!("{error}")));
    let map = report(&mut session, "map T -2..2 N -1..2").unwrap();
    println!("{}", text(&mut session, "map T -2..2 N -1..2"));
    // N > 0 presses: sticking where |T| < N / 2: a triangle of height 2 and base 2; the rest of N > 0 slips to both sides.
    near(&region(&map, &[("a", "stick")])["area"], 2.0, 1e-9);
    near(&region(&map, &[("a", "slip+")])["area"], 3.0, 1e-9);
    near(&region(&map, &[("a", "slip-")])["area"], 3.0, 1e-9);
    near(&region(&map, &[("a", "open")])["area"], 4.0, 1e-9);
}
