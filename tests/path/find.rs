//! `find` and `envelope` over parameters, against closed forms.

use serde_json::{Value, json};
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::session::{Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

pub(super) use super::common::lines::{report, session, text};
use super::common::{lines, scenario_text};

pub(super) fn beam() -> Session {
    lines::embedded("beam")
}

pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

pub(super) fn near(found: &Value, expected: f64, tolerance: f64) {
    assert!((number(found) - expected).abs() <= tolerance, "{found} is not {expected} within {tolerance:e}");
}

/// The places, and the ends of the intervals.
pub(super) fn places(found: &Value) -> (Vec<f64>, Vec<[f64; 2]>) {
    let places = found["places"].as_array().unwrap().iter().map(|place| number(&place["value"])).collect();
    let holds = found["holds"].as_array().unwrap().iter().map(|ends| [number(&ends[0]), number(&ends[1])]).collect();
    (places, holds)
}

/// Example 1: r = f F = 50; the k-th support from the pulled end slips at F2 = k r, all six at 300.
#[test]
fn the_pull_at_which_a_support_begins_to_slip() {
    let mut session = beam();
    for (pair, from) in [("c6", 50.0), ("c3", 200.0), ("c1", 300.0)] {
        for condition in [format!("z_t {pair} > 0"), format!("state {pair} = slip+"), format!("reserve {pair} = 0")] {
            let found = report(&mut session, &format!("find F2 0..400 where {condition}")).unwrap();
            assert_eq!(found["exact"], true);
            let (places, holds) = places(&found);
            if from < 300.0 {
                assert!((places[0] - from).abs() < 1e-9, "{condition}: {found}");
                assert!((holds[0][0] - from).abs() < 1e-9 && (holds[0][1] - 300.0).abs() < 1e-9, "{found}");
                assert!(found["places"][0]["change"].as_str().unwrap().contains(&format!("{pair} slips +")), "{found}");
            } else if condition.starts_with("reserve") {
                // It comes to its bound where the path ends.
                assert!((places[0] - 300.0).abs() < 1e-9, "{found}");
            } else {
                assert!(places.is_empty() && holds.is_empty(), "{found}");
            }
            assert!(found["notes"][0].as_str().unwrap().contains("limit load"), "{found}");
        }
    }
    // Less than: from the other side; several pairs; a load case in the place of the parameter.
    let found = report(&mut session, "find pull 0..250 where count slip+ < 3").unwrap();
    near(&found["places"][0]["value"], 150.0, 1e-9);
    near(&found["holds"][0][1], 150.0, 1e-9);
    // Slip c6 = L/EA Σ (F2 − k r): 1e-5 · ((F2 − 50) + (F2 − 100)) = 1e-3 at F2 = 125.
    let found = report(&mut session, "find F2 0..250 where z_t c6 = 0.001").unwrap();
    near(&found["places"][0]["value"], 125.0, 1e-9);
    let found = text(&mut session, "find F2 0..250 where z_t c6 = 0.001");
    assert!(found.contains("F2 = 125 kN"), "{found}");
}

/// At F2 = 150 two supports slip: z_6 = 1e-5 (2 F2 − 3 r) = 1e-3 at r = 200/3, f = r/F = 2/3.
#[test]
fn the_friction_at_which_the_end_slips_a_millimetre() {
    let mut session = beam();
    report(&mut session, "set F2 150").unwrap();
    let found = report(&mut session, "find f 0.3..1 where z_t c6 = 0.001").unwrap();
    assert_eq!((&found["exact"], places(&found).0.len()), (&Value::Bool(true), 1), "{found}");
    near(&found["places"][0]["value"], 2.0 / 3.0, 1e-10);
    // Slips of more: below; the path begins at f = 0.3.
    let found = report(&mut session, "find f 0.3..1 where z_t c6 > 0.001").unwrap();
    let (_, holds) = places(&found);
    assert!((holds[0][0] - 0.3).abs() < 1e-12 && (holds[0][1] - 2.0 / 3.0).abs() < 1e-10, "{found}");
    // The weight has a path too: r = f F, so F = 200/3 / 0.5.
    let found = report(&mut session, "find F 110..200 where z_t c6 = 0.001").unwrap();
    near(&found["places"][0]["value"], 400.0 / 3.0, 1e-9);
}

/// All six slip where F2 = 6 f F: least f = 250/600, most F2 = 300.
#[test]
fn the_least_and_the_most_with_an_answer() {
    let mut session = beam();
    let found = report(&mut session, "find least f 0..1 where outcome answer").unwrap();
    near(&found["value"], 250.0 / 600.0, 1e-9);
    assert_eq!((&found["collapse"]["verdict"], &found["beyond"]), (&"certified".into(), &Value::Bool(true)), "{found}");
    let (answer, collapse) = (number(&found["answer"]["value"]), number(&found["collapse"]["value"]));
    assert!(collapse < 250.0 / 600.0 && answer >= 250.0 / 600.0 && answer - collapse < 2e-8, "{found}");
    let found = report(&mut session, "find most F2 0..1000 where outcome answer").unwrap();
    near(&found["value"], 300.0, 1e-9);
    assert_eq!((&found["exact"], &found["collapse"]["verdict"]), (&Value::Bool(true), &"certified".into()), "{found}");
    let found = report(&mut session, "find least F2 0..1000 where outcome answer").unwrap();
    assert!(found["collapse"].is_null() && found["value"] == 0.0, "{found}");
    let error = report(&mut session, "find least F2 400..500 where outcome answer").unwrap_err();
    assert!(error.contains("no answer was found at any of 33 values of F2 from 400 to 500"), "{error}");
}

/// A block b × 1 of weight W = 10 pushed by H at its top: it slides at H = f W and turns at H = W b/2.
fn block() -> Session {
    let text = r#"{ "format": "stickslip/1", "title": "block",
        "parameters": { "b": { "value": 2, "min": 0.4, "max": 3 }, "f": 0.6, "H": 4 },
        "materials": { "m": { "E": 20000, "nu": 0.2 } },
        "plates": [ { "id": "p", "origin": [0, 0], "size": ["b", 1], "divisions": [2, 1], "thickness": 1, "material": "m",
                      "plane": "stress" } ],
        "contacts": [ { "id": "base", "edge": "p.bottom", "against": "ground", "friction": "f" } ],
        "loads": { "weight": { "items": [ { "point": { "at": "p.top", "force": [0, -10] } } ] },
                   "push": { "factor": "H", "items": [ { "point": { "at": "p.top", "force": [1, 0] } } ] } } }"#;
    session(load_text("block", text, None).unwrap_or_else(|problems| panic!("{problems}")))
}

/// Weight: all six supports together carry 6 f F = 250 from F = 250/3 on. Prestress: a node between the ground and a bar that
/// is too long by ε₀, pressed by EA ε₀ = 1000 ε₀, withstands a push of 10 at f = 0.5 from ε₀ = 0.02 on.
#[test]
fn the_least_weight_and_prestress() {
    let found = report(&mut beam(), "find least F 0..500 where outcome answer").unwrap();
    near(&found["value"], 250.0 / 3.0, 1e-9);
    assert_eq!(found["collapse"]["verdict"], "certified", "{found}");
    let text = r#"{ "format": "stickslip/1", "title": "prop", "parameters": { "e": { "value": 0.05, "min": 0, "max": 0.1 } },
        "materials": { "m": { "E": 1000, "nu": 0.2 } }, "sections": { "s": { "area": 1 } },
        "nodes": { "A": [0, 0], "B": [0, 1] },
        "bars": [ { "id": "prop", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" } ],
        "supports": [ { "at": "B", "fixed": ["x", "y"] } ],
        "contacts": [ { "id": "c", "node": "A", "against": "ground", "normal": [0, 1], "friction": 0.5 } ],
        "loads": { "prestress": { "items": [ { "strain": { "on": ["prop"], "value": "e" } } ] },
                   "push": { "items": [ { "point": { "at": "A", "force": [10, 0] } } ] } } }"#;
    let mut session = session(load_text("prop", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "find least e where outcome answer").unwrap();
    near(&found["value"], 0.02, 1e-9);
    assert!(["certified", "proved"].map(Value::from).contains(&found["collapse"]["verdict"]), "{found}");
}

/// The voussoir arch of 21 blocks, against limit analysis by an independent linear programme (`scenarios/scripts/arch.stick`):
/// least friction 0.350458429 at t/R = 0.15, least t/R 0.106741541 at f = 1; at 0.9999 of each it is proved to fall.
#[test]
fn the_least_friction_and_thickness_of_an_arch() {
    let mut session = session(embedded::load("arch").expect("embedded"));
    for (setting, name, least) in [("set eta 0.15", "f", 0.350_458_429), ("set f 1", "eta", 0.106_741_541)] {
        report(&mut session, setting).unwrap();
        let found = report(&mut session, &format!("find least {name} where outcome answer")).unwrap();
        // The programme's figures have eight digits.
        near(&found["value"], least, 2e-8);
        assert_eq!(found["collapse"]["verdict"], "certified", "{found}");
        assert_eq!(found["answer"]["outcome"], "normal", "{found}");
        near(&found["collapse"]["value"], least, 2e-8);
        for command in [&format!("set {name} {}", 0.9999 * least), "expect class mechanism", "expect verdict certified"]
        {
            session.execute(command, &mut Output::text(&mut Vec::new(), Style::default(), &Quiet)).expect(command);
        }
        report(&mut session, &format!("reset {name}")).unwrap();
    }
}

/// Three nodes in a row, each held down by a spring of its own (R_nn = k I), so that statics alone would let x_n grow:
/// the collapse where f · 240 < 110 is found by the search through the schemes, which holds for that f only.
#[test]
fn a_proof_by_search_is_claimed_for_no_other_friction() {
    let text = r#"{ "format": "stickslip/1", "title": "row", "parameters": { "f": 0.5 },
        "contact_system": { "pairs": ["c1", "c2", "c3"], "friction": ["f", "f", "f"],
            "stiffness": [[1000, 0, 0, 0, 0, 0], [0, 1000, 0, 0, 0, 0], [0, 0, 1000, 0, 0, 0],
                [0, 0, 0, 1000, -1000, 0], [0, 0, 0, -1000, 2000, -1000], [0, 0, 0, 0, -1000, 1000]],
            "loads": { "weight": { "vector": [40, 100, 100, 0, 0, 0] }, "pull": { "vector": [0, 0, 0, 0, 0, -110] } } } }"#;
    let mut session = session(load_text("row", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "find least f 0.1..1 where outcome answer").unwrap();
    near(&found["value"], 110.0 / 240.0, 1e-8);
    assert_eq!((&found["collapse"]["verdict"], &found["beyond"]), (&"proved".into(), &Value::Bool(false)), "{found}");
}

#[test]
fn overturning_against_sliding() {
    let mut session = block();
    // Geometry: H h = W b/2 at b = 0.8.
    let found = report(&mut session, "find least b where outcome answer").unwrap();
    near(&found["value"], 0.8, 1e-7);
    assert_eq!(found["collapse"]["verdict"], "certified", "{found}");
    assert_eq!(found["beyond"], false);
    // Sliding: f = H/W.
    near(&report(&mut session, "find least f 0..2 where outcome answer").unwrap()["value"], 0.4, 1e-9);
    // limit = min(f W, W b/2) = min(6, 5 b): it turns below b = 1.2 and slides above.
    let found = report(&mut session, "find b where limit push < 6").unwrap();
    assert_eq!(found["exact"], false);
    let (places, holds) = places(&found);
    assert_eq!(places.len(), 1, "{found}");
    assert!((places[0] - 1.2).abs() < 1e-6 && (holds[0][1] - 1.2).abs() < 1e-6, "{found}");
    let bracket = &found["places"][0]["bracket"];
    assert!(number(&bracket[0]) <= places[0] && places[0] <= number(&bracket[1]), "{found}");
    // e = H h / W does not depend on b; the resultant of the path over H is exact.
    let found = report(&mut session, "find H 0..5 where resultant base e = 0.25").unwrap();
    near(&found["places"][0]["value"], 2.5, 1e-9);
    assert_eq!(found["exact"], true);
}

/// The dam slides where the water is f N/T times as heavy as water, and turns over its toe where the moments about that are
/// in balance; from the friction on at which both are the same its limit is that of turning.
#[test]
fn the_dam_turns_over_where_it_would_slide_later() {
    let (z, h, b, crest, drain) = (28.0, 30.0, 24.0, 4.0, 0.6);
    let (weight, uplift, thrust) = (24.0 * h * (b + crest) / 2.0, drain * 9.81 * z * b / 2.0, 9.81 * z * z / 2.0);
    // rectangle and triangle of the section, the triangle of uplift with its largest at the heel
    let about_toe = 24.0 * h * (crest * (b - crest / 2.0) + (b - crest) / 2.0 * (b - crest) * 2.0 / 3.0);
    let turning = (about_toe - uplift * 2.0 * b / 3.0) / (thrust * z / 3.0);
    let sliding = (weight - uplift) / thrust;
    let mut session = session(embedded::load("dam").expect("embedded"));
    let found = report(&mut session, &format!("find f 1..2 where limit water < {}", turning - 1e-9)).unwrap();
    let (places, holds) = places(&found);
    assert_eq!((places.len(), holds.len()), (1, 1), "{found}");
    assert!((places[0] - turning / sliding).abs() < 1e-6, "{found}, not {}", turning / sliding);
    for (f, limit, mode) in [(1.6, 1.6 * sliding, "translation"), (1.8, turning, "rotation")] {
        let found = text(&mut session, &format!("set f {f}; limit water"));
        assert!(found.contains(&format!("rigid {mode}")) || found.contains(&format!("{mode} of the whole")), "{found}");
        near(&report(&mut session, "limit water").unwrap()["limit"], limit, 1e-6);
    }
}

#[test]
fn envelopes_tell_the_place_that_governs() {
    let mut session = beam();
    // Largest slip at the end of the range; x_t c6 = −50 from F2 = 50 on.
    let found = report(&mut session, "envelope z_t c6, x_t c6, count slip+ over F2 0..250").unwrap();
    assert_eq!(found["exact"], true);
    let row = |k: usize, end: &str| found["envelope"][k][end].clone();
    near(&row(0, "largest")["value"], 0.005, 1e-12);
    near(&row(0, "largest")["at"]["F2"], 250.0, 0.0);
    near(&row(1, "least")["value"], -50.0, 1e-9);
    near(&row(1, "least")["at"]["F2"], 50.0, 1e-9);
    assert_eq!(row(1, "least")["change"], "pair c6 slips +");
    near(&row(2, "largest")["value"], 4.0, 0.0);
    near(&row(2, "largest")["at"]["F2"], 200.0, 1e-9);
    // Over two parameters a grid, and said to be so: slip grows with F2 and falls with f.
    let found = report(&mut session, "envelope z_t c6 over f 0.5..1 F2 0..250").unwrap();
    assert_eq!(found["exact"], false);
    near(&found["envelope"][0]["largest"]["value"], 0.005, 1e-12);
    near(&found["envelope"][0]["largest"]["at"]["f"], 0.5, 0.0);
    assert!(found["notes"][0].as_str().unwrap().contains("a grid of 121 answers"), "{found}");
    // Beyond 300 = 6 r all supports slip and nothing holds the beam: no more is said of the rest, and that it is so.
    let found = report(&mut session, "envelope z_t c6 over F2 0..400").unwrap();
    near(&found["covered"][0], 0.0, 0.0);
    near(&found["covered"][1], 300.0, 1e-9);
    assert!(found["notes"][0].as_str().unwrap().contains("over F2 from 0 to 300 only"), "{found}");
    let found = text(&mut session, "envelope x_t c6 over F2 0..250");
    assert!(found.contains("F2 = 50: pair c6 slips +"), "{found}");
}

/// A quad on smooth ground, pressed by 8 (1 − t) from above and by 8 t from both sides: σ_x = −8 t, σ_y = −8 (1 − t);
/// von Mises, 8 √(3 t² − 3 t + 1), is least at t = 1/2, where nothing changes, and is 8 √(7/16) = √28 at t = 1/4 and 3/4.
#[test]
fn zeros_and_extremes_between_breakpoints_are_found() {
    let text = r#"{ "format": "stickslip/1", "title": "pressed", "parameters": { "t": 0.1 },
        "materials": { "m": { "E": 1000, "nu": 0.3 } },
        "nodes": { "a": [0, 0], "b": [1, 0], "c": [1, 1], "d": [0, 1] },
        "quads": [ { "id": "q", "nodes": ["a", "b", "c", "d"], "thickness": 1, "material": "m", "plane": "stress" } ],
        "edges": { "bottom": ["a", "b"], "right": ["b", "c"], "top": ["c", "d"], "left": ["d", "a"] },
        "supports": [ { "at": "a", "fixed": ["x"] } ],
        "contacts": [ { "id": "g", "edge": "bottom", "against": "ground", "law": "frictionless" } ],
        "loads": { "all": { "items": [ { "pressure": { "edge": "top", "value": "8*(1 - t)" } },
          { "pressure": { "edge": "left", "value": "8*t" } }, { "pressure": { "edge": "right", "value": "8*t" } } ] } } }"#;
    let mut session = session(load_text("pressed", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "envelope mises q over t 0..0.9").unwrap();
    assert_eq!(found["exact"], true, "{found}");
    let ends = &found["envelope"][0];
    near(&ends["least"]["value"], 4.0, 1e-9);
    // A place of a smooth extreme is known to √ε.
    near(&ends["least"]["at"]["t"], 0.5, 1e-7);
    near(&ends["largest"]["value"], 8.0, 1e-9);
    near(&ends["largest"]["at"]["t"], 0.0, 0.0);
    let found = report(&mut session, &format!("find t 0..0.9 where mises q = {}", 28.0_f64.sqrt())).unwrap();
    let (places, _) = places(&found);
    assert!(places.len() == 2 && (places[0] - 0.25).abs() < 1e-9 && (places[1] - 0.75).abs() < 1e-9, "{found}");
    let found = report(&mut session, "find t 0..0.9 where mises q < 5").unwrap();
    // 3 t² − 3 t + 1 = 25/64: t = 1/2 ± √(1/4 − 13/64) = 1/2 ± √3/8.
    let half = 3.0_f64.sqrt() / 8.0;
    near(&found["holds"][0][0], 0.5 - half, 1e-9);
    near(&found["holds"][0][1], 0.5 + half, 1e-9);
    // The largest of numbers that bend upwards does so too; their least bends either way, and is not called exact.
    for (quantity, exact) in [("max mises", true), ("min s2", true), ("min mises", false), ("max s2", false)] {
        for command in [format!("envelope {quantity} over t 0..0.9"), format!("find t 0..0.9 where {quantity} > 5")] {
            let found = report(&mut session, &command).unwrap();
            assert_eq!(found["exact"], exact, "{command}: {found}");
            let notes = found["notes"].to_string();
            assert_eq!(notes.contains(&format!("{quantity} may bend either way")), !exact, "{command}: {notes}");
        }
    }
}

/// The heated pipe: the moment at its nozzle is zero near f = 0.1287 and largest where c1 begins to stick.
#[test]
fn the_moment_at_the_nozzle_over_the_friction() {
    let mut session = session(embedded::load("pipeline").expect("embedded"));
    let found = report(&mut session, "find f 0..1 where m noz = 0").unwrap();
    near(&found["places"][0]["value"], 0.1287, 5e-5);
    assert_eq!(places(&found).0.len(), 1, "{found}");
    let found = report(&mut session, "envelope m noz over f 0..1").unwrap();
    let row = &found["envelope"][0];
    near(&row["least"]["value"], -5.130, 5e-4);
    near(&row["least"]["at"]["f"], 0.0, 0.0);
    near(&row["largest"]["value"], 20.041, 5e-4);
    near(&row["largest"]["at"]["f"], 0.4815246519, 1e-9);
    assert_eq!(row["largest"]["change"], "pair c1 sticks");
}

/// A spring of 100 carries F until the pair of bound 0.2·10 slips: u = (F ∓ 2)/100 beyond ±2.
#[test]
fn ranges_begin_below_zero() {
    let text = r#"{ "format": "stickslip/1", "title": "t", "parameters": { "F": { "value": 3 } },
        "nodes": { "A": [0, 0] }, "springs": [{ "at": "A", "direction": [1, 0], "stiffness": 100 }],
        "contacts": [{ "id": "c", "node": "A", "against": "ground", "normal": [0, 1], "friction": 0.2 }],
        "loads": { "w": { "items": [{ "point": { "at": "A", "force": [0, -10] } }] },
                   "p": { "factor": "F", "items": [{ "point": { "at": "A", "force": [1, 0] } }] } } }"#;
    let mut session = session(load_text("t.json", text, None).unwrap());
    for (range, least) in [("-5..5", -0.03), ("-6.5..-5", -0.045), ("-.05e2..5", -0.03)] {
        let row = report(&mut session, &format!("envelope ux A over F {range}")).unwrap()["envelope"][0].clone();
        near(&row["least"]["value"], least, 1e-12);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("rows.json");
        let mut written = Vec::new();
        let mut io = Output::text(&mut written, Style::default(), &Quiet);
        let command = format!("sweep F {range} 3 --out {} --columns 'ux A'", file.display());
        session.execute(&command, &mut io).unwrap_or_else(|error| panic!("{command}: {error}"));
        let rows = std::fs::read_to_string(&file).unwrap();
        let first: Value = serde_json::from_str(rows.lines().nth(1).unwrap()).unwrap();
        near(&first["ux A"], least, 1e-12);
    }
    let error = report(&mut session, "sweep F -5..5 --ot x.csv").expect_err("no such option");
    assert!(error.contains("--ot"), "{error}");
}

/// A spring of 100 pulled by 3 where · 1: words of the commands may be names of parameters.
#[test]
fn names_may_be_words_of_the_commands() {
    let text = r#"{ "format": "stickslip/1", "title": "t", "parameters": { "where": 1, "most": 3, "of": 0.2 },
        "nodes": { "A": [0, 0] }, "springs": [{ "at": "A", "direction": [1, 0], "stiffness": 100 }],
        "contacts": [{ "id": "c", "node": "A", "against": "ground", "normal": [0, 1], "friction": "of" }],
        "loads": { "w": { "items": [{ "point": { "at": "A", "force": [0, -10] } }] },
                   "p": { "factor": "where*most", "items": [{ "point": { "at": "A", "force": [1, 0] } }] } } }"#;
    let mut session = session(load_text("t.json", text, None).unwrap());
    let mut place = |command: &str| report(&mut session, command).unwrap_or_else(|error| panic!("{command}: {error}"));
    // x_t = −3 where while it sticks, |x_t| ≤ 2
    near(&place("find where 0..1 where x_t c = -1.5")["places"][0]["value"], 0.5, 1e-9);
    near(&place("find most 0..3 where x_t c = -1.5")["places"][0]["value"], 1.5, 1e-9);
    near(&place("find most most 0..3 where x_t c > -1.5")["places"][0]["value"], 1.5, 1e-6);
    assert!(place("map of 0.1..1 where 0..1 of x_t c").to_string().contains("\"of\""));
}

#[test]
fn wrong_questions_are_refused_in_words() {
    for (command, part) in [
        ("find", "help find"),
        ("find F2 0..400", "find: expected `find NAME [A..B] where QUANTITY = VALUE`"),
        ("find G 0..1 where z_t c1 > 0", "no parameter or load case `G`"),
        ("find F2 4..1 where z_t c1 > 0", "the range 4..1 is empty"),
        ("find F2 0-4 where z_t c1 > 0", "`0-4` is not a range; expected A..B"),
        ("find pull where z_t c1 > 0", "find: in which range? pull has no slider"),
        ("find F2 where z_t c9 > 0", "no pair `c9`"),
        ("find F2 where z_t c1 = 0 ± 1", "without a tolerance"),
        ("find F2 where z_t c1", "is not a comparison"),
        ("find f -1..1 where z_t c1 > 0", "must not be negative"),
        ("envelope x_n c1 over", "expected `over combinations` or `over PARAMETER A..B`"),
        ("envelope x_n c1 over F2 0..1 F2 0..1", "F2 is named twice"),
        ("envelope state c1 over f 0..1", "is a word, not a number"),
    ] {
        let error = report(&mut beam(), command).expect_err(command);
        assert!(error.contains(part), "{command}: {error}");
    }
}

/// A beam of span 4 on a pin and a pressed support, EI = 20000: forces 10 P and 10 (3 − P) at its quarters, where the
/// flexibilities are 3/4, 7/12 and 3/4 over EI, store U = (P²/3 − P + 27/4)/400, which is least at P = 3/2.
#[test]
fn a_parabola_that_turns_close_to_the_end_of_a_stretch_is_searched_and_sampled() {
    let text = r#"{ "format": "stickslip/1", "title": "bent", "parameters": { "P": 1 },
        "materials": { "m": { "E": 2e8, "nu": 0.3 } }, "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
        "nodes": { "A": [0, 0], "B": [1, 0], "C": [3, 0], "D": [4, 0] },
        "bars": [ { "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" },
          { "id": "BC", "nodes": ["B", "C"], "material": "m", "section": "s" },
          { "id": "CD", "nodes": ["C", "D"], "material": "m", "section": "s" } ],
        "supports": [ { "at": "A", "fixed": ["x", "y"] } ],
        "contacts": [ { "id": "c", "node": "D", "against": "ground", "normal": [0, 1] } ],
        "loads": { "w": { "items": [ { "point": { "at": "D", "force": [0, -1e5] } } ] },
          "p": { "factor": "P", "items": [ { "point": { "at": "B", "force": [0, -10] } } ] },
          "q": { "factor": "3 - P", "items": [ { "point": { "at": "C", "force": [0, -10] } } ] } } }"#;
    let mut session = session(load_text("bent", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "envelope energy over P 0..30").unwrap();
    near(&found["envelope"][0]["least"]["value"], 6.0 / 400.0, 1e-12);
    near(&found["envelope"][0]["least"]["at"]["P"], 1.5, 1e-9);
    let found = report(&mut session, "find P 0..30 where energy < 0.01625").unwrap();
    // P²/3 − P + 1/4 = 0.
    let half = 1.5 * (2.0_f64 / 3.0).sqrt();
    near(&found["holds"][0][0], 1.5 - half, 1e-9);
    near(&found["holds"][0][1], 1.5 + half, 1e-9);
    // Nearer to the lower end, and to the upper one.
    for (range, from) in [("1.499..90", 1.499), ("-90..1.51", 1.51)] {
        let found = report(&mut session, &format!("envelope energy over P {range}")).unwrap();
        near(&found["envelope"][0]["least"]["at"]["P"], 1.5, 1e-6);
        assert!(number(&found["envelope"][0]["least"]["at"]["P"]) != from, "{found}");
    }
    // U < u for |P − 3/2| < r, u = (r²/3 + 6)/400: half of 0..30 lies below r = 13.5.
    let found = report(&mut session, "sample P=uniform(0,30) of energy").unwrap();
    let spread = &found["quantities"][0];
    near(&spread["mean"], (100.0 - 15.0 + 6.75) / 400.0, 1e-10);
    let median = spread["quantiles"].as_array().unwrap().iter().find(|quantile| quantile[0] == 0.5);
    near(&median.unwrap_or_else(|| panic!("{found}"))[1], (13.5 * 13.5 / 3.0 + 6.0) / 400.0, 1e-10);
}

/// A beam of span 4 under 10 per length with moments P and 3 P at its ends, M = P at the first and −3 P at the second: the
/// largest M stands where Q = 20 − P − 10 s is 0 and is P + (20 − P)²/20, from P = 20 on it is that at the end.
#[test]
fn the_largest_moment_along_a_bar_is_searched_where_its_place_wanders() {
    let text = r#"{ "format": "stickslip/1", "title": "wandering", "parameters": { "P": 1 },
        "materials": { "m": { "E": 2e8, "nu": 0.3 } }, "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
        "nodes": { "A": [0, 0], "B": [4, 0] },
        "bars": [ { "id": "b", "nodes": ["A", "B"], "material": "m", "section": "s" } ],
        "supports": [ { "at": "A", "fixed": ["x", "y"] } ],
        "contacts": [ { "id": "c", "node": "B", "against": "ground", "normal": [0, 1] } ],
        "loads": { "w": { "items": [ { "point": { "at": "B", "force": [0, -1e5] } },
            { "line": { "bar": "b", "value": [0, -10] } } ] },
          "p": { "factor": "P", "items": [ { "point": { "at": "A", "force": [0, 0], "moment": -1 } },
            { "point": { "at": "B", "force": [0, 0], "moment": -3 } } ] } } }"#;
    let mut session = session(load_text("wandering", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "envelope max M b over P 0..200").unwrap();
    assert_eq!(found["exact"], true, "{found}");
    near(&found["envelope"][0]["least"]["value"], 15.0, 1e-9);
    near(&found["envelope"][0]["least"]["at"]["P"], 10.0, 1e-5);
    near(&found["envelope"][0]["largest"]["value"], 200.0, 1e-9);
    let found = report(&mut session, "find P 0..200 where max M b < 16").unwrap();
    let half = 10.0 * 0.2_f64.sqrt();
    near(&found["holds"][0][0], 10.0 - half, 1e-8);
    near(&found["holds"][0][1], 10.0 + half, 1e-8);
}

/// Nodes on springs of their own whose forces are straight lines in t: x_n = n + n' t, x_τ = −s (t − p), f = 1.
fn on_springs(lines: &[[f64; 4]]) -> Session {
    let m = lines.len();
    let mut stiffness = vec![vec![0.0; 2 * m]; 2 * m];
    (0..2 * m).for_each(|i| stiffness[i][i] = 1.0);
    let of = |pick: fn(&[f64; 4]) -> [f64; 2]| -> Vec<f64> {
        [0, 1].iter().flat_map(|k| lines.iter().map(|line| pick(line)[*k])).collect()
    };
    lines::read(&scenario_text(json!({
        "parameters": { "t": 0 },
        "contact_system": {
            "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "stiffness": stiffness, "friction": vec![1; m],
            "loads": {
                "fixed": { "vector": of(|[n, _, s, p]| [*n, s * p]) },
                "moving": { "factor": "t", "vector": of(|[_, rise, s, _]| [*rise, -s]) }
            }
        }
    })))
}

/// Reserves h − s |t − p| are tents. A narrow one stands out over a flat one where no quarter of the way shows it; the largest
/// x_n is least in the corner where two straight lines meet.
#[test]
fn the_largest_of_many_is_found_for_certain() {
    let (flat, top, slope, place) = (1.9, 1.9001, 1.9, 0.61803);
    let mut session = on_springs(&[[flat, 0.0, 0.0, 0.0], [top, 0.0, slope, place]]);
    let found = report(&mut session, "envelope max reserve * over t 0..1").unwrap();
    assert_eq!(found["exact"], true, "{found}");
    near(&found["envelope"][0]["largest"]["value"], top, 1e-14);
    near(&found["envelope"][0]["largest"]["at"]["t"], place, 1e-14);
    let found = report(&mut session, "find t 0..1 where max reserve * > 1.90005").unwrap();
    assert_eq!(found["exact"], true, "{found}");
    let half = 0.00005 / slope;
    near(&found["holds"][0][0], place - half, 1e-12);
    near(&found["holds"][0][1], place + half, 1e-12);
    let mut session = on_springs(&[[1.0, 0.3, 0.0, 0.0], [1.2, -0.41, 0.0, 0.0]]);
    let found = report(&mut session, "envelope max x_n * over t 0..1").unwrap();
    let corner = 0.2 / 0.71;
    near(&found["envelope"][0]["least"]["at"]["t"], corner, 1e-14);
    near(&found["envelope"][0]["least"]["value"], 1.0 + 0.3 * corner, 1e-14);
}
