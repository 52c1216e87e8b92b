//! Every table that a command prints goes to .csv and .json; K and F go out and come back as a superelement.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;
use stickslip::answer::record::{Answer, OutcomeKind};
use stickslip::model::embedded;
use stickslip::model::load::load_file;
use stickslip::session::commands;
use stickslip::session::{CommandError, Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

use super::lines;

fn run(session: &mut Session, line: &str) -> Result<String, CommandError> {
    let mut out = Vec::new();
    for command in stickslip::session::language::tokens::commands(line) {
        session.execute(command, &mut Output::text(&mut out, Style::default(), &Quiet))?;
    }
    Ok(String::from_utf8(out).expect("text"))
}

/// What leads there, WHAT and OF, and a column of the CSV; or why there is none.
type Exported = Result<(&'static str, &'static str, &'static str), &'static str>;

/// How the table of each command is exported.
const COMMANDS: &[(&str, Exported)] = &[
    ("scenarios", Ok(("load beam", "scenarios", "title"))),
    ("params", Ok(("load beam", "params", "value"))),
    ("diff", Ok(("load beam; set f 0.4", "diff", "now"))),
    ("pairs", Ok(("load beam", "pairs", "x_n"))),
    ("displacements", Ok(("load beam", "displacements", "ux"))),
    ("members", Ok(("load beam", "members", "start_N"))),
    ("reactions", Ok(("load continuous-beam", "reactions", "fy"))),
    ("show", Ok(("load beam", "show x_n c1, max u", "quantity"))),
    ("summary", Err("several tables: `export summary FILE.json`")),
    ("combine", Ok(("load dam", "combine", "outcome"))),
    ("envelope", Ok(("load beam", "envelope x_t c1 over f 0..1", "least_value"))),
    ("prove", Err("a file of its own")),
    ("check", Ok(("load beam", "check", "min_w"))),
    ("pivots", Ok(("load beam", "pivots", "entering"))),
    ("ties", Ok(("load cycling", "ties", "tied"))),
    ("tableau", Ok(("load klarbring; set f 0.5; step first", "tableau", "x+[c1]"))),
    ("ray", Ok(("load beam-ray", "ray", "z_t"))),
    ("compare", Ok(("load klarbring", "compare", "covering"))),
    ("enumerate", Ok(("load klarbring", "enumerate", "state"))),
    ("critical", Ok(("load klarbring", "critical f", "value"))),
    ("trace", Ok(("load beam; trace pull to 260", "trace", "value"))),
    ("limit", Ok(("load beam", "limit pull", "safety"))),
    ("find", Ok(("load beam", "find F2 0..400 where z_t c3 > 0", "value"))),
    ("sensitivity", Ok(("load beam", "sensitivity f", "pair"))),
    ("stages", Ok(("load pipeline; stages", "stages", "stage"))),
    ("sweep", Ok(("load beam; sweep f 0..1 3", "sweep", "outcome"))),
    ("sample", Ok(("load beam; sample f=uniform(0.4,0.6) of max u", "sample", "what"))),
    ("map", Ok(("load beam; map f 0.1..0.9 F2 50..400", "map", "at_F2"))),
    ("calibrate", Ok(("load beam", "calibrate f where z_t c6 = 0.004", "computed"))),
    ("cycle", Ok(("load beam", "cycle F2 0..61", "difference"))),
    ("status", Err("one sentence: `export result FILE.json`")),
    ("why", Err("sentences about one pair")),
    ("plot", Err("a picture: `export PICTURE FILE.svg`")),
    ("view", Err("how pictures are seen")),
    ("history", Err("what was typed: `record` writes it as a script")),
    ("new", Err("kinds of scenarios to begin with, each with names of its own")),
    ("load", Err("no table")),
    ("edit", Err("no table")),
    ("reload", Err("no table")),
    ("watch", Err("no table")),
    ("save", Err("no table")),
    ("set", Err("no table")),
    ("reset", Err("no table")),
    ("undo", Err("no table")),
    ("redo", Err("no table")),
    ("import", Err("no table")),
    ("solve", Err("no table")),
    ("step", Err("no table")),
    ("tui", Err("no table")),
    ("source", Err("no table")),
    ("record", Err("no table")),
    ("expect", Err("no table")),
    ("export", Err("no table")),
    ("echo", Err("no table")),
    ("restore", Err("no table")),
    ("help", Err("no table")),
    ("tour", Err("no table")),
    ("quit", Err("no table")),
];

/// Fields of a line of CSV.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            c => fields.last_mut().expect("one").push(c),
        }
    }
    fields
}

/// Each command stands in [`COMMANDS`]: one that is new says there how its table is exported, or that it prints none.
#[test]
fn the_table_of_every_command_is_exported_or_it_has_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |ending: &str| folder.path().join(format!("a.{ending}"));
    let listed: BTreeMap<&str, _> = COMMANDS.iter().copied().collect();
    assert_eq!(listed.len(), COMMANDS.len(), "a command stands there twice");
    for name in commands::all().map(|command| command.name) {
        let how = listed.get(name).unwrap_or_else(|| panic!("{name}: is its table exported?"));
        let Ok((before, what, column)) = how else { continue };
        let mut session = lines::embedded("beam");
        run(&mut session, before).unwrap_or_else(|error| panic!("{before}: {error}"));
        for ending in ["csv", "json"] {
            let line = format!("export {what} '{}'", at(ending).display());
            run(&mut session, &line).unwrap_or_else(|error| panic!("{line}: {error}"));
        }
        let csv = fs::read_to_string(at("csv")).expect("a table");
        let mut lines = csv.lines().map(fields);
        let head = lines.next().expect("a head");
        assert!(head.iter().any(|known| known == column), "{name}: {head:?}");
        let rows: Vec<Vec<String>> = lines.collect();
        assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == head.len()), "{name}: {csv}");
        let json: Value = serde_json::from_str(&fs::read_to_string(at("json")).expect("a table")).expect("JSON");
        assert!(!json.is_null(), "{name}");
        assert!(json.as_array().is_none_or(|rows| !rows.is_empty()), "{name}");
    }
}

#[test]
fn tables_that_are_not_there_are_refused_in_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.csv");
    let file = file.display();
    for (before, what, message) in [
        ("load beam", "ray", "no ray"),
        ("load beam", "remedies", "no ray"),
        ("load murty6", "limit x", "a bare LCP has no loads"),
        ("load beam", "limit", "of which load"),
        ("load beam", "critical", "of which friction parameter"),
        ("load beam", "find", "what?"),
        ("load beam", "find F2 0..400", "expected `find NAME"),
        ("load beam", "check exactly", "only `exact` may follow"),
        ("load dam", "tableau", "tableau"),
    ] {
        let mut session = lines::embedded("beam");
        run(&mut session, before).expect("there");
        let line = format!("export {what} '{file}'");
        let error = run(&mut session, &line).expect_err(&line).to_string();
        assert!(error.contains(message), "{line}: {error}");
    }
    assert!(!folder.path().join("a.csv").exists());
}

#[test]
fn what_stands_in_the_tables() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.csv");
    let table = |before: &str, what: &str| -> Vec<Vec<String>> {
        let mut session = lines::embedded("beam");
        run(&mut session, &format!("{before}; export {what} '{}'", file.display())).expect("written");
        fs::read_to_string(&file).expect("a table").split_terminator("\r\n").map(fields).collect()
    };
    // Murty's example, n = 6: z_1 = 2⁶ alone.
    let solution = table("load murty6", "pairs");
    assert_eq!(solution[0], ["row", "z", "w"]);
    assert_eq!((solution.len(), &solution[1][1]), (7, &"64.0".to_owned()));
    // The dictionary of one pair: x_n, x-, p basic; the others with their rates.
    let tableau = table("load klarbring; set f 0.5; step first", "tableau");
    assert_eq!(tableau[0], ["basic", "value", "z_n[c1]", "z+[c1]", "z-[c1]", "x+[c1]"]);
    assert_eq!(tableau.iter().skip(1).map(|row| row[0].as_str()).collect::<Vec<_>>(), ["x_n[c1]", "x-[c1]", "p"]);
    // 330 > 6 f F = 300: friction 0.55, weight 110 or pull 300 would hold it.
    let remedies = table("load beam-ray", "remedies");
    let needed = remedies[0].iter().position(|name| name == "needed").expect("a column");
    let kind = remedies[0].iter().position(|name| name == "kind").expect("a column");
    let of = |word: &str| -> Vec<f64> {
        remedies.iter().filter(|row| row[kind] == word).map(|row| row[needed].parse().expect("a number")).collect()
    };
    assert!((of("friction")[0] - 0.55).abs() < 1e-6 && (of("load")[0] - 110.0).abs() < 1e-3, "{remedies:?}");
    assert_eq!(table("load beam; set f 0.4", "diff")[1], ["f", "0.5", "0.4"]);
    // Support c3 slips where F2 exceeds three times f F = 50 and the weights hold: from 4 f F = 200 on.
    let places = table("load beam", "find F2 0..400 where z_t c3 > 0");
    let value = places[0].iter().position(|name| name == "value").expect("a column");
    assert!(
        (places.last().expect("a place")[value].parse::<f64>().expect("a number") - 200.0).abs() < 1e-9,
        "{places:?}"
    );
}

fn answer(session: &Session) -> &Answer {
    session.answer().expect("solved")
}

/// The contact forces, slips and displacements of every embedded structure come back from its K and F.
#[test]
fn k_and_f_come_back_as_a_superelement() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut same, mut refused) = (Vec::new(), Vec::new());
    for (name, _) in embedded::list() {
        let mut session = lines::embedded(name);
        let file = folder.path().join(format!("{name}.mtx"));
        let wrote = match run(&mut session, &format!("export stiffness '{}'", file.display())) {
            Ok(wrote) => wrote,
            Err(error) => {
                let text = error.to_string();
                assert!(text.contains("no structure") || text.contains("tensionless foundation"), "{name}: {text}");
                refused.push(name);
                continue;
            }
        };
        assert!(!wrote.contains("are not in it"), "{name}: {wrote}");
        let scenario = load_file(&file.with_extension("json")).unwrap_or_else(|error| panic!("{name}: {error}"));
        let back = Session::new(scenario, &Quiet).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (a, b) = (answer(&session), answer(&back));
        assert_eq!(a.outcome, b.outcome, "{name}");
        assert_eq!(a.pairs.len(), b.pairs.len(), "{name}");
        if !matches!(a.outcome, OutcomeKind::Normal | OutcomeKind::Trivial) {
            continue;
        }
        let largest = |of: &dyn Fn(usize) -> f64, count: usize| (0..count).map(of).fold(0.0, f64::max);
        let count = a.pairs.len();
        let force = largest(&|k| a.pairs[k].x_n.abs().max(a.pairs[k].x_t.abs()), count);
        let (u, v) = (a.displacements.as_ref().expect("u"), b.displacements.as_ref().expect("u"));
        let moved = largest(&|k| u[k].ux.abs().max(u[k].uy.abs()), u.len());
        for (a, b) in a.pairs.iter().zip(&b.pairs) {
            let near = |what: &str, a: f64, b: f64, size: f64| {
                assert!((a - b).abs() <= 1e-8 * size, "{name}: {what} {a} {b}");
            };
            near("x_n", a.x_n, b.x_n, force);
            near("x_t", a.x_t, b.x_t, force);
            near("z_n", a.z_n, b.z_n, moved);
            near("z_t", a.z_t, b.z_t, moved);
            assert_eq!((a.state, a.position), (b.state, b.position), "{name}: {}", a.id);
        }
        for (a, b) in u.iter().zip(v) {
            assert!((a.ux - b.ux).hypot(a.uy - b.uy) <= 1e-8 * moved, "{name}: {a:?} {b:?}");
        }
        same.push(name);
    }
    assert!(same.len() >= 12 && !refused.is_empty(), "{same:?} {refused:?}");
}

/// A session over a scenario, and one over what its `export stiffness` writes.
fn there_and_back(text: &str) -> [Session; 2] {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let session =
        |name: &str| Session::new(load_file(&at(name)).unwrap_or_else(|e| panic!("{e}")), &Quiet).expect("solved");
    fs::write(at("a.json"), text).expect("a file");
    let mut first = session("a.json");
    run(&mut first, &format!("export stiffness '{}'", at("b.json").display())).expect("written");
    [first, session("b.json")]
}

/// A cantilever under a force at its end stores F² L³/6EI, as it is and as a superelement.
#[test]
fn a_superelement_stores_as_much() {
    let text = r#"{ "format": "stickslip/1", "title": "Cantilever",
        "materials": {"m": {"E": 200, "nu": 0.2}}, "sections": {"s": {"area": 1, "inertia": 1}},
        "nodes": {"A": [0, 0], "B": [4, 0]},
        "bars": [{"id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 2}],
        "supports": [{"at": "A", "fixed": ["x", "y", "r"]}],
        "loads": {"q": {"items": [{"point": {"at": "B", "force": [0, -3]}}]}} }"#;
    let [session, back] = there_and_back(text);
    for mut session in [session, back] {
        let shown = lines::report(&mut session, "show energy").unwrap_or_else(|e| panic!("{e}"));
        let energy = shown[0]["value"].as_f64().expect("a number");
        assert!((energy - 9.0 * 64.0 / 1200.0).abs() < 1e-12, "{energy}");
    }
}

/// What holds a rotation at a hinge comes back where it does something, and is left out where it does not: B turns with A
/// through the spring, C is turned and pulls D, E is held, F and G would turn by themselves. With M_D = k φ/(1 + k L/3EI).
#[test]
fn rotations_at_hinges_come_back() {
    let text = r#"{ "format": "stickslip/1", "title": "Hinges",
        "materials": {"m": {"E": 200, "nu": 0.2}}, "sections": {"s": {"area": 1, "inertia": 1}},
        "nodes": {"A": [0, 0], "B": [4, 0], "C": [0, 2], "D": [4, 2], "E": [0, 4], "F": [4, 4], "G": [8, 4]},
        "bars": [{"id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "hinges": ["end"]},
                 {"id": "CD", "nodes": ["C", "D"], "material": "m", "section": "s", "hinges": ["start"]},
                 {"id": "EF", "nodes": ["E", "F"], "material": "m", "section": "s", "hinges": ["start", "end"]},
                 {"id": "FG", "nodes": ["F", "G"], "material": "m", "section": "s", "hinges": ["start", "end"]}],
        "supports": [{"at": "A", "fixed": ["x", "y"]}, {"at": "B", "fixed": ["x", "y"]},
                     {"at": "C", "fixed": ["x", "y", "r"], "settlement": [0, 0, 0.01], "case": "q"},
                     {"at": "D", "fixed": ["x", "y"]}, {"at": "E", "fixed": ["x", "y", "r"]},
                     {"at": "F", "fixed": ["x", "y"]}, {"at": "G", "fixed": ["x", "y"]}],
        "ties": [{"nodes": ["F", "G"], "fixed": ["y", "r"]}],
        "springs": [{"between": ["A", "B"], "rotation": 30}, {"between": ["C", "D"], "rotation": 30},
                    {"between": ["F", "G"], "rotation": 5}, {"at": "E", "rotation": 7}],
        "loads": {"q": {"items": [{"line": {"bar": "AB", "value": [0, -2]}}]}} }"#;
    let [session, back] = there_and_back(text);
    for session in [&session, &back] {
        let turns = answer(session).displacements.as_ref().expect("u");
        let near = |node: usize, right: f64| {
            let found = turns[node].rz;
            assert!((found - right).abs() < 1e-12, "{node}: {found} {right}");
        };
        let (simple, moment) = (-2.0 * 64.0 / (24.0 * 200.0), 30.0 * 0.01 / (1.0 + 30.0 * 4.0 / 600.0));
        for (node, turn) in [(0, simple), (1, simple), (2, 0.01), (3, moment * 4.0 / 600.0), (4, 0.0)] {
            near(node, turn);
        }
        assert_eq!((turns[5].rz, turns[6].rz), (0.0, 0.0));
    }
}

/// Supports that settle, ties, rigid bodies, springs of every kind, edges that do not match.
#[test]
fn what_stands_beside_k_comes_along() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = folder.path().join("a.json");
    let text = r#"{ "format": "stickslip/1", "title": "All", "units": {"length": "m"},
        "materials": {"m": {"E": 1e4, "nu": 0.2}}, "sections": {"s": {"area": 0.1, "inertia": 0.01}},
        "parameters": {"f": 0.25},
        "nodes": {"A": [0, 0], "B": [2, 0], "C": [4, 0], "D": [4, 1], "T": [0, 0], "W": [2, -1]},
        "bars": [{"id": "AC", "polyline": ["A", "B", "C"], "divisions": 2, "material": "m", "section": "s"},
                 {"id": "TW", "nodes": ["T", "W"], "material": "m", "section": "s", "hinges": ["end"]}],
        "plates": [{"id": "p", "origin": [2, -2], "size": [1, 1], "divisions": [2, 2], "thickness": 1, "material": "m",
                    "plane": "stress"}],
        "rigid": [{"id": "head", "nodes": ["C", "D"]}],
        "ties": [{"nodes": ["A", "T"], "fixed": ["x", "y"]}, {"nodes": ["W", "p[0,2]"], "fixed": ["x", "y"]}],
        "supports": [{"at": "T", "fixed": ["x", "r"], "settlement": [0.001, 0, 0.002], "case": "one"},
                     {"at": "p.bottom", "fixed": ["x", "y"], "settlement": [0, -0.001], "case": "two"}],
        "springs": [{"at": "D", "direction": [3, 4], "stiffness": 50}, {"at": "B", "rotation": 20},
                    {"between": ["B", "p[2,2]"], "direction": [0, 1], "stiffness": 10}],
        "contacts": [{"id": "stop", "node": "D", "against": "ground", "normal": [0, 1], "friction": "f", "gap": 0.001},
                     {"id": "pin", "node": "B", "against": "p[1,2]", "normal": [0, 1], "friction": 0.3, "gap": 0.002},
                     {"id": "slide", "node": "A", "against": "ground", "normal": [0, 1], "law": "frictionless"}],
        "loads": {"one": {"factor": 1.5, "items": [{"point": {"at": "B", "force": [1, -8]}}]},
                  "two": {"items": [{"line": {"bar": "AC", "value": [0, -2]}},
                                    {"temperature": {"change": 10, "on": ["AC"]}}]}} }"#;
    fs::write(&scenario, text).expect("a file");
    let mut session = Session::new(load_file(&scenario).unwrap_or_else(|e| panic!("{e}")), &Quiet).expect("solved");
    run(&mut session, &format!("set f 0.4; export stiffness '{}/b.json'", folder.path().display())).expect("written");
    for name in ["b.json", "b.mtx", "b.one.mtx", "b.two.mtx"] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    let mut back = Session::new(load_file(&folder.path().join("b.json")).unwrap_or_else(|e| panic!("{e}")), &Quiet)
        .expect("solved");
    let (a, b) = (answer(&session), answer(&back));
    assert!(a.is_answer() && b.is_answer());
    for (a, b) in a.pairs.iter().zip(&b.pairs) {
        assert_eq!((&a.id, a.state), (&b.id, b.state));
        assert!((a.x_n - b.x_n).abs() < 1e-9 && (a.x_t - b.x_t).abs() < 1e-9, "{a:?} {b:?}");
    }
    let reactions = |answer: &Answer| -> f64 { answer.reactions.iter().flatten().map(|r| r.fy).sum() };
    assert!((reactions(a) - reactions(b)).abs() < 1e-9);
    // Back and out again: the same K.
    run(&mut back, &format!("export stiffness '{}/c.mtx'", folder.path().display())).expect("written");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a file");
    assert_eq!(read("b.mtx"), read("c.mtx"));
    // The scenario itself is never written over.
    let error =
        run(&mut session, &format!("export stiffness '{}/a.mtx'", folder.path().display())).expect_err("itself");
    assert!(error.to_string().contains("the scenario itself"), "{error}");
    assert_eq!(read("a.json"), text);
    assert!(!folder.path().join("a.mtx").exists());
}
