//! A number is a number: parameters and expressions anywhere in a scenario, what a change of one costs, and what is
//! refused.

use stickslip::model::load::load_text;
use stickslip::session::Session;

use super::lines::{read, report, told};

/// A bar along x from A to B; B is pressed to the ground and pulled along the bar by P = 2 F + 10.
///
/// With the bound f W exceeded the bar carries N = P − f W and B slips by N L / (E A).
const BAR: &str = r#"{ // comments may stand anywhere
  "$schema": "stickslip.schema.json",
  "format": "stickslip/1", "title": "bar", /* and
  these too */
  "parameters": {
    "L": { "value": 2, "min": 0.5, "max": 4, "step": 0.25 }, "E": 1000, "A": 0.1, "W": 100,
    "f": 0.3, // friction
    "F": 20, "g": 0, "P": { "formula": "2*F + 10", "unit": "kN" }, "Q": { "formula": "P - f*W" },
  },
  "materials": { "m": { "E": "E", "nu": 0 } },
  "sections": { "s": { "area": "A" } },
  "nodes": { "A": [0, 0], "B": ["L*cos(0)", "sin(0)"] },
  "bars": [ { "id": "AB", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" } ],
  "supports": [ { "at": "A", "fixed": ["x", "y"] } ],
  "contacts": [ { "id": "c", "node": "B", "against": "ground", "normal": [0, "L"], "friction": "f/1", "gap": "g" } ],
  "loads": {
    "weight": { "items": [ { "point": { "at": "B", "force": [0, "-W"] } } ] },
    "pull": { "factor": "P", "items": [ { "point": { "at": "B", "force": [1, 0] } } ] },
  },
}"#;

struct Rig(Session);

impl Rig {
    fn new(text: &str) -> Rig {
        Rig(read(text))
    }

    fn run(&mut self, command: &str) -> Result<String, String> {
        told(&mut self.0, command)
    }

    fn ok(&mut self, command: &str) -> String {
        self.run(command).unwrap_or_else(|error| panic!("{command}: {error}"))
    }

    fn refused(&mut self, command: &str) -> String {
        self.run(command).expect_err(command)
    }

    /// Whether B slips by N L / (E A), N = 2 F + 10 − f W, and is pressed by W.
    fn holds(&self, what: &str) {
        let values = self.0.values();
        let of = |name: &str| values[name];
        let force = 2.0 * of("F") + 10.0 - of("f") * of("W");
        let slip = force * of("L") / (of("E") * of("A"));
        let pair = &self.0.pairs()[0];
        assert!((pair.x_n - of("W")).abs() < 1e-12 * of("W"), "{what}: x_n {} {}", pair.x_n, of("W"));
        assert!((pair.z_t - slip).abs() < 1e-12 * slip.abs(), "{what}: z_t {} {slip}", pair.z_t);
        assert!((of("Q") - force).abs() < 1e-12 * force, "{what}: Q {} {force}", of("Q"));
    }
}

#[test]
fn a_parameter_works_wherever_it_stands_and_what_is_redone_is_told() {
    let mut rig = Rig::new(BAR);
    rig.holds("as loaded");
    for (command, redone) in [
        ("set F 25", ""),
        ("set f 0.2", ""),
        ("set W 80", "new RF, "),
        ("set L 3", "new K, "),
        ("set E 2000", "new K, "),
        ("set A 0.2", "new K, "),
        ("undo", ""),
        ("redo", ""),
        ("reset", ""),
    ] {
        let line = rig.ok(command);
        rig.holds(command);
        if !redone.is_empty() {
            assert!(line.contains(redone), "{command}: {line}");
        } else if command.starts_with("set") {
            assert!(!line.contains("new "), "{command}: {line}");
        }
    }
}

#[test]
fn several_changes_at_once_are_solved_once() {
    let mut rig = Rig::new(BAR);
    for command in ["set auto off", "set L 4", "set W 50", "set F 30", "set auto on"] {
        rig.ok(command);
    }
    rig.holds("after all of them");
}

#[test]
fn values_that_make_the_model_invalid_are_refused_with_their_place() {
    let mut rig = Rig::new(BAR);
    let before = rig.ok("status");
    for (command, part) in [
        ("set L 0", "case.json:13:13: bars[0]: the bar \"AB\" has no length"),
        ("set A 0", "case.json:11:32: sections.s.area: area must be greater than 0, found \"A\" = 0"),
        ("set E -1", "materials.m.E: E must be greater than 0, found \"E\" = -1"),
        ("set f -0.1", "f/1 is the friction of c and must not be negative, found -0.1"),
        ("set P 3", "P is a formula, 2*F + 10: it is computed, not set; set F"),
        ("set Q 3", "Q is a formula, P - f*W: it is computed, not set; set F or W or f"),
        ("reset Q", "Q is a formula"),
        ("sweep P 0..1", "P is a formula"),
    ] {
        let error = rig.refused(command);
        assert!(error.contains(part), "{command}: {error}");
        assert_eq!(rig.ok("status"), before, "{command}");
    }
    // The same where nothing is solved at once.
    rig.ok("set auto off");
    assert!(rig.refused("set A 0").contains("area must be greater than 0"));
    rig.ok("set auto on");
    rig.holds("after all refusals");
}

#[test]
fn a_gap_may_be_negative() {
    // The tip is pressed in by 0.01: nothing but the contact holds B across the bar, so only the position changes.
    let mut rig = Rig::new(BAR);
    rig.ok("set g -0.01");
    let pair = &rig.0.pairs()[0];
    assert!((pair.x_n - 100.0).abs() < 1e-10 && pair.z_n == 0.0, "{pair:?}");
    let uy = rig.0.displacements().expect("an answer")[1].uy;
    // z_n = uy + g ≥ 0 holds with equality.
    assert!((uy - 0.01).abs() < 1e-14, "{uy}");
}

#[test]
fn paths_follow_affine_factors_and_refuse_the_rest_in_words() {
    let mut rig = Rig::new(BAR);
    // B begins to slip where 2 F + 10 = f W = 30.
    rig.ok("set F 0");
    let trace = rig.ok("trace F to 20");
    assert!(trace.contains("\n10 ") && trace.contains("slips +"), "{trace}");
    for (command, part) in [
        ("trace L to 3", "L cannot be followed: it stands in the geometry or stiffness (nodes.B[0])"),
        ("limit E", "E cannot be followed: it stands in the geometry or stiffness (materials.m.E)"),
        ("trace Q to 3", "Q is a formula"),
        ("sensitivity L", "no derivatives with respect to L: it stands in the geometry"),
    ] {
        let error = rig.refused(command);
        assert!(error.contains(part), "{command}: {error}");
    }
    let text = BAR.replace("2*F + 10", "F*F/10 + 10");
    let mut rig = Rig::new(&text);
    let error = rig.refused("trace F to 30");
    assert!(error.contains("the factor of case pull, P, is not a linear function of it: `sweep F A..B`"), "{error}");
}

#[test]
fn friction_that_is_an_expression_is_followed_exactly() {
    // Bound f² W: B sticks from f² = P / W = 0.5 on.
    let text = BAR.replace("\"f/1\"", "\"f^2\"").replace("\"P - f*W\"", "\"P - f^2*W\"");
    let mut rig = Rig::new(&text);
    let trace = rig.ok("trace f to 1");
    assert!(trace.contains("0.7071"), "{trace}");
    assert!(trace.contains("sticks"), "{trace}");
}

#[test]
fn sensitivities_are_derivatives_of_expressions_too() {
    // z_t = (2 F + 10 − f W) L / (E A): dz_t/dF = 2 L / (E A) = 0.04, dz_t/df = −W L / (E A) = −2.
    let mut rig = Rig::new(BAR);
    let named = report(&mut rig.0, "sensitivity f").expect("an answer");
    assert_eq!(named["parameters"].as_array().unwrap().len(), 1, "{named}");
    assert_eq!(named["parameters"][0]["parameter"], "f");
    let report = report(&mut rig.0, "sensitivity").expect("an answer");
    let rates = report["parameters"].as_array().expect("rates");
    let of = |name: &str| {
        let rate = rates.iter().find(|rate| rate["parameter"] == name).unwrap_or_else(|| panic!("{name}"));
        rate["pairs"][0]["z_t"].as_f64().expect("a number")
    };
    assert!((of("F") - 0.04).abs() < 1e-12 && (of("f") + 2.0).abs() < 1e-12, "{report}");
    assert!(rates.iter().all(|rate| rate["parameter"] != "L" && rate["parameter"] != "P"), "{report}");
}

#[test]
fn sweeps_go_over_geometry_and_loads() {
    let mut rig = Rig::new(BAR);
    let report = report(&mut rig.0, "sweep L 0..4 3 W 50..100 2").expect("a sweep");
    let columns: Vec<&str> = report["columns"].as_array().unwrap().iter().filter_map(|name| name.as_str()).collect();
    let at = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 6);
    for row in rows {
        let number = |name: &str| row[at(name)].as_f64().unwrap_or_else(|| panic!("{row}"));
        if number("L") == 0.0 {
            assert_eq!(row[at("outcome")], "refused");
            assert!(row[at("failure")].as_str().unwrap().contains("has no length"), "{row}");
            continue;
        }
        let slip = (50.0 - 0.3 * number("W")) * number("L") / 100.0;
        assert!((number("max_slip") - slip).abs() < 1e-12, "{row}");
    }
    rig.holds("the session is where it was");
}

#[test]
fn comments_and_formulas_survive_a_save() {
    let folder = tempfile::tempdir().expect("a place");
    let path = folder.path().join("bar.json");
    let mut rig = Rig::new(BAR);
    rig.ok("set L 3.5");
    rig.ok(&format!("save {}", path.display()));
    let text = std::fs::read_to_string(&path).expect("saved");
    assert_eq!(text, BAR.replace("\"value\": 2,", "\"value\": 3.5,"));
}

#[test]
fn formulas_are_shown_with_their_values() {
    let mut rig = Rig::new(BAR);
    let table = rig.ok("params");
    let row = table.lines().find(|line| line.trim_start().starts_with("P ")).expect("a row");
    assert!(row.contains("50") && row.contains("= 2*F + 10"), "{table}");
}

fn problems(text: &str) -> String {
    load_text("t.json", text, None).expect_err("wrong").to_string()
}

#[test]
fn formulas_in_a_circle_are_told_with_all_their_names() {
    let with = |parameters: &str| BAR.replace("\"F\": 20,", &format!("\"F\": 20, {parameters},"));
    let text = problems(&with(
        r#""a": { "formula": "b + 1" }, "b": { "formula": "2*c" }, "c": { "formula": "a*F" }, "d": { "formula": "c" }"#,
    ));
    assert!(text.contains("parameters.a.formula: the formulas go in a circle: a → b → c → a"), "{text}");
    assert_eq!(text.matches("circle").count(), 1, "{text}");
    let text = problems(&with(r#""a": { "formula": "a" }"#));
    assert!(text.contains("in a circle: a → a"), "{text}");
    let text = problems(&with(r#""a": { "formula": "2*G" }"#));
    assert!(text.contains("parameters.a.formula: in \"2*G\": unknown parameter \"G\" (did you mean"), "{text}");
    let text = problems(&with(r#""a": { "formula": "1/g" }"#));
    assert!(text.contains("the formula \"1/g\" is not a finite number at g = 0"), "{text}");
    let text = problems(&with(r#""a": { "formula": "F", "max": 3 }"#));
    assert!(text.contains("`max` cannot stand beside `formula`"), "{text}");
}

#[test]
fn wrong_expressions_are_told_with_their_column() {
    // The column is that of the wrong word within the text.
    let text = problems(&BAR.replace("\"L*cos(0)\"", "\"L*cso(0)\""));
    assert!(
        text.starts_with("t.json:12:36: nodes.B[0]: in \"L*cso(0)\": unknown function \"cso\" (did you mean"),
        "{text}"
    );
    let text = problems(&BAR.replace("\"L*cos(0)\"", "\"L/g\""));
    assert!(text.contains("nodes.B[0]: \"L/g\" is not a finite number at L = 2, g = 0"), "{text}");
    let text = problems(&BAR.replace("\"divisions\"", "").replace("\"kind\": \"truss\"", "\"divisions\": \"2\""));
    assert!(text.contains("bars[0].divisions: expected a number, found the string \"2\""), "{text}");
}

#[test]
fn chains_of_formulas_are_neither_deep_nor_slow() {
    let chain: Vec<String> =
        (1..2000).map(|k| format!("\"a{k}\": {{ \"formula\": \"a{}*1 + a{}*0\" }}", k - 1, k - 1)).collect();
    let text = BAR.replace("\"g\": 0,", &format!("\"g\": 0, \"a0\": 1, {},", chain.join(", ")));
    let scenario = load_text("chain", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(scenario.parameter_values()["a1999"], 1.0);
}
