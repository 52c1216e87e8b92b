//! The language of quantities on closed forms: a cantilever and a block on the ground, combinations, probes.

use serde_json::Value;
use stickslip::model::load::load_text;
use stickslip::session::Session;

use super::lines::{self, read, told};

/// The report of a command that must succeed.
fn report(session: &mut Session, command: &str) -> Value {
    lines::report(session, command).unwrap_or_else(|error| panic!("{command}: {error}"))
}

/// A cantilever AB of length 4 with P = 3 downwards at B (E I = 200), and a block 2 × 1 under a load (H, −W) spread over
/// its top, H = 2, W = 10.
pub(super) const TWO: &str = r#"{
  "format": "stickslip/1", "title": "cantilever and block", "units": { "length": "m", "force": "kN" },
  "parameters": { "P": 3, "H": 2, "W": 10, "f": 0.5 },
  "materials": { "m": { "E": 20000, "nu": 0.3 } },
  "sections": { "s": { "area": 0.1, "inertia": 0.01 } },
  "nodes": { "A": [0, 0], "B": [4, 0] },
  "bars": [ { "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 2 } ],
  "plates": [ { "id": "b", "origin": [10, 0], "size": [2, 1], "divisions": [4, 2], "thickness": 1, "material": "m",
                "plane": "stress" } ],
  "supports": [ { "at": "A", "fixed": ["x", "y", "r"] } ],
  "contacts": [ { "id": "base", "edge": "b.bottom", "against": "ground", "friction": "f" } ],
  "loads": {
    "tip": { "factor": "P", "items": [ { "point": { "at": "B", "force": [0, -1] } } ] },
    "weight": { "factor": "W", "items": [ { "point": { "at": "b.top", "force": [0, -1] } } ] },
    "push": { "factor": "H", "items": [ { "point": { "at": "b.top", "force": [1, 0] } } ] }
  },
  "combinations": { "calm": { "weight": 1, "tip": 1 }, "storm": { "weight": "2*f", "push": 1.5, "tip": 2 } },
  "probes": { "tip sag": "uy B", "clamp": "M AB start", "lift": "count open base", "tilt": "resultant base e" }
}"#;

fn expect(session: &mut Session, text: &str) {
    told(session, &format!("expect {text}")).unwrap_or_else(|error| panic!("expect {text}: {error}"));
}

/// Resting supports without friction give nothing along the run, so the riser has no shear and the nozzle no horizontal
/// force: exactly 0 in quantities, as in the tables.
#[test]
fn what_is_rounding_reads_zero_everywhere() {
    let mut session = read(include_str!("../../scenarios/pipeline.json"));
    told(&mut session, "set f 0").expect("an answer");
    for quantity in ["fx noz", "Q riser start", "max Q riser", "N run end", "M run end", "sum x_t c*", "nozzle_force"] {
        let shown = report(&mut session, &format!("show {quantity}"));
        assert_eq!(shown[0]["value"].as_f64(), Some(0.0), "{quantity}: {shown}");
        expect(&mut session, &format!("{quantity} = 0"));
    }
    // The weight of 4 m + 18 m of pipe is carried by the nozzle and the supports together.
    let carried = report(&mut session, "show fy noz")[0]["value"].as_f64().expect("a number")
        + report(&mut session, "show sum x_n c*")[0]["value"].as_f64().expect("a number");
    assert!((carried - 22.0 * 0.62).abs() < 1e-9, "{carried}");
}

#[test]
fn quantities_have_the_values_of_closed_forms() {
    let mut session = read(TWO);
    for text in [
        "outcome answer",
        "outcome != ray",
        // Cantilever: M = −P (L − x), Q = P, u_y = −P L³/(3 E I) = −0.32, rotation −P L²/(2 E I) = −0.12.
        "M AB start = -12 ± 1e-9",
        "M AB at 1 = -9 ± 1e-9",
        "M AB at 3.5 = -1.5 ± 1e-9",
        "M AB end = 0 ± 1e-9",
        "min M AB = -12 ± 1e-9",
        "max M AB = 0 ± 1e-9",
        "M AB = -12 ± 1e-9",
        "Q AB at 2 = 3 ± 1e-9",
        "N AB = 0 ± 1e-9",
        "uy B = -0.32 ± 1e-9",
        "rz B = -0.12 ± 1e-9",
        "max u = 0.32 ± 1e-6",
        "fx A = 0 ± 1e-9",
        "fy A = 3 ± 1e-9",
        "m A = 12 ± 1e-9",
        // Block: N = W, T = −H (along +x the ground pushes back), e = H h / W = 0.2 to the right.
        "sum x_n base[*] = 10 ± 1e-9",
        "sum x_t base = -2 ± 1e-9",
        "resultant base N = 10 ± 1e-9",
        "resultant base T = -2 ± 1e-9",
        "resultant base e = 0.2 ± 1e-9",
        "count open = 0",
        "count stick base[*] >= 1",
        "max x_n >= 2",
        "reserve base[2] >= 0",
        "state base[2] stick",
        // Mean vertical stress under a uniform load W / (2 · 1); at the middle column of elements it is close to it.
        "sy b{1,1} < 0",
        "mises b[2,1] > 0",
        // Push: slides at H = f W = 5 or overturns at H · 1 = W · 1, so it slides.
        "limit push = 5 ± 1e-6",
        "safety push = 2.5 ± 1e-6",
        "\"tip sag\" = -0.32 ± 1e-9",
        "clamp < -11.9",
        "lift = 0",
        "energy > 0",
        "pivots >= 0",
    ] {
        expect(&mut session, text);
    }
    // Strain energy of the cantilever: P² L³ / (6 E I) = 0.48; the block adds a little more.
    let energy = report(&mut session, "show energy")[0]["value"].as_f64().expect("a number");
    assert!(energy > 0.48 && energy < 0.49, "{energy}");
}

#[test]
fn expectations_that_fail_say_what_was_found() {
    let mut session = read(TWO);
    for (text, part) in [
        ("M AB start = -11 ± 0.5", "expected M AB start = -11 ± 0.5, found -1"),
        ("outcome ray", "expected outcome ray, found outcome trivial"),
        ("state base[0] open", "expected state base[0] open, found state base[0]"),
        ("verdict proved", "expected verdict proved, found outcome trivial"),
        ("M AB at 9 = 0", "found 9 is beyond the bar AB, which is 4 long"),
        ("fx B = 0", "found no support at node B"),
        ("stres b{0,0} = 0", "unknown quantity `stres`"),
        ("\"tip sog\" < 0", "unknown quantity `tip sog` (did you mean `tip sag`?)"),
        ("M BC start = 0", "no bar `BC`: the only bar is AB"),
        ("x_n base[*] = 0", "put sum, max or min before it"),
        ("outcome norml", "did you mean `normal`"),
    ] {
        let error = told(&mut session, &format!("expect {text}")).expect_err(text);
        assert!(error.contains(part), "{text}: {error}");
    }
}

#[test]
fn show_lists_values_with_units_and_reasons() {
    let mut session = read(TWO);
    let text = told(&mut session, "show M AB start, uy B, state base[2], fx B, 'tip sag'").unwrap();
    for part in ["M AB start", "-12", "kN·m", "-0.32", "stick", "no support at node B", "tip sag"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let probes = report(&mut session, "show");
    assert_eq!(probes.as_array().unwrap().len(), 4);
    assert_eq!(probes[0]["quantity"], "tip sag");
    assert_eq!(probes[0]["unit"], "m");
    let none = report(&mut session, "show resultant base e, fx B");
    assert!(none[1]["value"].is_null() && none[1]["reason"] == "no support at node B", "{none}");
}

#[test]
fn results_hold_probes_and_resultants() {
    let session = read(TWO);
    let result = session.result(false).expect("an answer");
    assert!((result["probes"]["clamp"].as_f64().unwrap() + 12.0).abs() < 1e-9, "{}", result["probes"]);
    let base = &result["resultants"][0];
    assert_eq!(base["joint"], "base");
    assert!((base["N"].as_f64().unwrap() - 10.0).abs() < 1e-9 && (base["e"].as_f64().unwrap() - 0.2).abs() < 1e-9);
}

#[test]
fn combinations_multiply_the_factors_of_their_cases() {
    let mut session = read(TWO);
    let all = report(&mut session, "combine");
    let all = all["combinations"].as_array().unwrap();
    // calm: W, P; storm: 2 f W = W, 1.5 H, 2 P.
    for (one, name, sag, tilt) in [(&all[0], "calm", -0.32, 0.0), (&all[1], "storm", -0.64, 0.3)] {
        assert_eq!(one["name"], name);
        assert!(one["outcome"] == "normal" || one["outcome"] == "trivial", "{one}");
        let probe = |probe: &str| one["probes"][probe].as_f64().unwrap_or_else(|| panic!("{one}"));
        assert!((probe("tip sag") - sag).abs() < 1e-9, "{one}");
        assert!((probe("tilt") - tilt).abs() < 1e-9, "{one}");
    }
    assert_eq!(all[1]["factors"]["push"], 3.0);
    expect(&mut session, "\"tip sag\" = -0.32 ± 1e-9");
    told(&mut session, "combine storm").unwrap();
    expect(&mut session, "\"tip sag\" = -0.64 ± 1e-9");
    expect(&mut session, "M AB at 2 = -12 ± 1e-9");
    told(&mut session, "solve").unwrap();
    expect(&mut session, "\"tip sag\" = -0.32 ± 1e-9");
    let error = told(&mut session, "combine strom").unwrap_err();
    assert!(error.contains("no combination `strom`") && error.contains("storm"), "{error}");
    let error = told(
        &mut read(
            &TWO.replace("\"combinations\"", "\"stages\"")
                .replace("{ \"calm\": {", "[ {")
                .replace("}, \"storm\": {", "}, {")
                .replace("\"tip\": 2 } }", "\"tip\": 2 } ]"),
        ),
        "combine",
    );
    assert!(error.unwrap_err().contains("the scenario has no `combinations`"));
}

/// With f = 0.4 the block slides at H = f W = 4; in `storm`, which multiplies W by 2 f and H by 1.5, the push of 3 may grow to
/// f · 2 f W = 3.2. What asks about the load case means what is shown; what varies numbers of the file says that it does not.
#[test]
fn commands_say_whether_they_mean_the_combination_that_is_shown() {
    let mut session = read(TWO);
    told(&mut session, "set f 0.4").unwrap();
    told(&mut session, "combine storm").unwrap();
    let own = "of the load cases with their own factors; the tables are those of combination storm";
    let near = |value: &Value, number: f64| value.as_f64().is_some_and(|found| (found - number).abs() < 1e-9);
    let limit = report(&mut session, "limit push");
    assert!(near(&limit["limit"], 3.2) && near(&limit["present"], 3.0), "{limit}");
    expect(&mut session, "limit push = 3.2 ± 1e-9");
    let summary = report(&mut session, "summary");
    let push = summary["safety"].as_array().unwrap().iter().find(|one| one["case"] == "push").unwrap();
    assert!(near(&push["limit"], 3.2) && near(&push["safety"], 3.2 / 3.0), "{push}");
    let limit = report(&mut session, "limit H");
    assert!(near(&limit["limit"], 4.0) && near(&limit["present"], 2.0), "{limit}");
    for command in ["limit push", "summary", "show limit push", "pairs", "reactions"] {
        let text = told(&mut session, command).unwrap();
        assert!(text.contains("of combination storm") && !text.contains(own), "{command}: {text}");
    }
    for command in
        ["limit H", "trace H to 3", "find H 0..5 where max z_t > 1", "sensitivity", "envelope tilt over H 0..3"]
    {
        let text = told(&mut session, command).unwrap().replace('\n', " ");
        assert!(text.starts_with(own), "{command}: {text}");
    }
    let text = told(&mut session, "envelope tilt over combinations").unwrap();
    assert!(!text.contains(own), "{text}");
    told(&mut session, "solve").unwrap();
    for command in ["limit push", "summary", "trace H to 3"] {
        let text = told(&mut session, command).unwrap();
        assert!(!text.contains("storm"), "{command}: {text}");
    }
}

#[test]
fn the_envelope_names_what_governs() {
    let mut session = read(TWO);
    let envelope = report(&mut session, "envelope tilt, 'tip sag', max x_n over combinations");
    let rows = envelope["envelope"].as_array().unwrap();
    let end = |row: usize, end: &str| {
        let end = &rows[row][end];
        (end["value"].as_f64().unwrap(), end["combination"].as_str().unwrap().to_owned())
    };
    assert!((end(0, "largest").0 - 0.3).abs() < 1e-9 && end(0, "largest").1 == "storm");
    assert!(end(0, "least").0.abs() < 1e-9 && end(0, "least").1 == "calm");
    assert!((end(1, "least").0 + 0.64).abs() < 1e-9 && end(1, "least").1 == "storm");
    assert_eq!(rows.len(), 3);
    assert_eq!(report(&mut session, "envelope")["envelope"].as_array().unwrap().len(), 4);
    assert!(told(&mut session, "envelope outcome").unwrap_err().contains("is a word"));
    let text = told(&mut session, "envelope").unwrap();
    assert!(text.contains("storm") && text.contains("calm"), "{text}");
}

#[test]
fn sweeps_paths_and_plots_speak_the_same_language() {
    let mut session = read(TWO);
    let sweep = report(&mut session, "sweep P 1..3 3 --columns 'M AB start, \"tip sag\", state base[2], mises b{1,1}'");
    let columns: Vec<&str> = sweep["columns"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    let at = |name: &str| columns.iter().position(|column| *column == name).unwrap_or_else(|| panic!("{columns:?}"));
    for (row, p) in sweep["rows"].as_array().unwrap().iter().zip([1.0, 2.0, 3.0]) {
        // M = −4 P, sag = −P L³/(3 E I) = −0.32 P / 3.
        assert!((row[at("M AB start")].as_f64().unwrap() + 4.0 * p).abs() < 1e-9, "{row}");
        assert!((row[at("tip sag")].as_f64().unwrap() + 0.32 * p / 3.0).abs() < 1e-9, "{row}");
        assert_eq!(row[at("state base[2]")], "stick");
    }
    // The block slides at H = 5; until then T = −H and e = H / W.
    let trace = report(&mut session, "trace push to 4 of resultant base T, tilt");
    let along = &trace["along"];
    let last = |k: usize| along["quantities"][k]["values"].as_array().unwrap().last().unwrap().as_f64().unwrap();
    assert!((last(0) + 4.0).abs() < 1e-9 && (last(1) - 0.4).abs() < 1e-9, "{along}");
    let text = told(&mut session, "trace push to 4 of M AB start").unwrap();
    assert!(text.contains("M AB start") && text.contains("-12"), "{text}");
    let plot = told(&mut session, "plot path tilt").unwrap();
    assert!(plot.contains("tilt over push"), "{plot}");
    assert!(told(&mut session, "trace push of stat base[0]").unwrap_err().contains("unknown quantity `stat`"));
    assert!(told(&mut session, "sweep P 1..3 --columns 'M CD'").unwrap_err().contains("no bar `CD`"));
}

#[test]
fn the_summary_fits_on_a_screen() {
    let mut session = read(TWO);
    let text = told(&mut session, "summary").unwrap();
    for part in ["base", "push", "2.5", "tip sag"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    for row in [&["bending", "moment", "-12.000", "kN·m", "AB"][..], &["sum", "of", "1", "0", "3.0000"]] {
        assert!(text.lines().any(|line| line.split_whitespace().eq(row.iter().copied())), "{row:?}: {text}");
    }
    assert!(text.lines().count() <= 40, "{text}");
    // bars of the plane have N, Q and M, each once, and no torque
    assert!(!text.contains("V_y") && !text.contains("torque") && text.matches("bending moment").count() == 1, "{text}");
    let report = report(&mut session, "summary");
    assert!((report["sum_of_reactions"]["fy"].as_f64().unwrap() - 3.0).abs() < 1e-9, "{report}");
}

#[test]
fn wrong_probes_and_combinations_are_told_with_their_place() {
    let problems = |text: &str| load_text("t.json", text, None).expect_err("wrong").to_string();
    for (from, to, part) in [
        ("\"uy B\"", "\"uy C\"", "probes[\"tip sag\"]: no node `C`"),
        ("\"uy B\"", "\"uz B\"", "`uz` is a quantity of space, and this structure lies in the plane"),
        ("\"uy B\"", "\"uy B, ux B\"", "a probe is one quantity, found 2"),
        ("\"uy B\"", "3", "probes[\"tip sag\"]: expected a string, found the number 3"),
        ("\"lift\"", "\"M\"", "a probe cannot be named \"M\": it is a quantity itself"),
        ("\"weight\": 1,", "\"wieght\": 1,", "combinations.calm.wieght: unknown load case \"wieght\" (did you mean"),
        ("\"2*f\"", "\"2*g\"", "combinations.storm.weight: in \"2*g\": unknown parameter \"g\""),
        ("\"calm\": { \"weight\": 1, \"tip\": 1 }", "\"calm\": {}", "the combination names no load case"),
    ] {
        assert!(TWO.contains(from), "{from}");
        let text = problems(&TWO.replace(from, to));
        assert!(text.contains(part), "{part}: {text}");
    }
}
