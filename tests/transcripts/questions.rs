//! Questions that have no answer, or have one in another place: what is said of them.

use super::lines::{read, report, text, told};
use super::quantities::TWO;

/// What a line is refused with.
fn refused(session: &mut stickslip::session::Session, line: &str) -> String {
    told(session, line).expect_err(line)
}

/// Nothing turns at a node of plates, so that it has no rotation, nowhere 0; nodes of bars and of rigid bodies have one.
#[test]
fn nodes_without_a_rotation_show_none() {
    let folder = tempfile::tempdir().expect("a place");
    let stiff = TWO.replace(r#""supports""#, r#""rigid": [ { "id": "cap", "at": "b.top" } ], "supports""#);
    for (scenario, corner_turns) in [(TWO, false), (&stiff, true)] {
        let mut session = read(scenario);
        for (node, turns) in [("B", true), ("b[0,0]", false), ("b[0,2]", corner_turns)] {
            let shown = report(&mut session, &format!("show rz {node}")).expect("a row");
            assert_eq!(shown[0]["value"].is_number(), turns, "{shown}");
            assert_eq!(
                shown[0]["reason"].as_str().is_some_and(|why| why.contains("has no rotation")),
                !turns,
                "{shown}"
            );
            let result = session.result(false).expect("an answer");
            let nodes = result["displacements"].as_array().expect("nodes").clone();
            let of_node = nodes.iter().find(|one| one["node"] == node).expect("the node");
            assert!(of_node["ux"].is_number() && of_node["rz"].is_number() == turns, "{of_node}");
            let file = folder.path().join("u.csv");
            text(&mut session, &format!("export displacements {}", file.display()));
            let written = std::fs::read_to_string(&file).expect("written");
            let id = if node.contains(',') { format!("\"{node}\",") } else { format!("{node},") };
            let row = written.lines().find_map(|row| row.strip_prefix(&id)).expect("the node");
            let row: Vec<&str> = row.split(',').collect();
            assert!(row[0].parse::<f64>().is_ok() && row[2].parse::<f64>().is_ok() == turns, "{row:?}");
            assert!(turns || row[2].is_empty(), "{row:?}");
        }
        assert!(refused(&mut session, "expect rz b[0,0] = 0").contains("has no rotation"));
    }
}

/// Two squares of side 1 and thickness 1, pulled along x by H and pushed by 2 H at its free side: σ_x = H and −2 H all over.
const SQUARES: &str = r#"{
  "format": "stickslip/1", "title": "two squares", "parameters": { "H": { "value": 3, "min": 0, "max": 10 } },
  "materials": { "m": { "E": 1000, "nu": 0 } },
  "plates": [ { "id": "a", "origin": [0, 0], "size": [1, 1], "divisions": [2, 2], "thickness": 1, "material": "m", "plane": "stress" },
              { "id": "b", "origin": [3, 0], "size": [1, 1], "divisions": [2, 2], "thickness": 1, "material": "m", "plane": "stress" } ],
  "supports": [ { "at": "a.left", "fixed": ["x", "y"] }, { "at": "b.left", "fixed": ["x", "y"] } ],
  "loads": {
    "pull": { "factor": "H", "items": [ { "traction": { "edge": "a.right", "value": [1, 0] } } ] },
    "push": { "factor": "2*H", "items": [ { "traction": { "edge": "b.right", "value": [-1, 0] } } ] } },
  "probes": { "worst": "max mises b" }
}"#;

/// Extremes of stresses have the values of the closed form, wherever quantities are asked for.
#[test]
fn extremes_of_stresses_are_quantities() {
    let mut session = read(SQUARES);
    for expected in [
        "max sx = 3 ± 1e-9",
        "min sx = -6 ± 1e-9",
        "max sx b = -6 ± 1e-9",
        "max mises = 6 ± 1e-9",
        "max mises a = 3 ± 1e-9",
        "min s2 a = 0 ± 1e-9",
        "worst = 6 ± 1e-9",
    ] {
        text(&mut session, &format!("expect {expected}"));
    }
    let worst = report(&mut session, "find H where max mises a = 4").expect("a place");
    assert!((worst["places"][0]["value"].as_f64().expect("a value") - 4.0).abs() < 1e-9, "{worst}");
    let rows = report(&mut session, "sweep H 1..2 2 --columns 'min sx'").expect("rows");
    let column = rows["columns"].as_array().expect("columns").iter().position(|name| name == "min sx").expect("min sx");
    for (row, expected) in rows["rows"].as_array().expect("rows").iter().zip([-2.0, -4.0]) {
        assert!((row[column].as_f64().expect("a number") - expected).abs() < 1e-9, "{row}");
    }
    assert!(refused(&mut session, "show max mises c").contains("no plate, brick or mesh `c`"));
    let mut bars = super::lines::embedded("beam");
    let shown = report(&mut bars, "show max mises").expect("a row");
    assert!(shown[0]["reason"].as_str().is_some_and(|why| why.contains("no plate")), "{shown}");
}

/// The extremes are those of the stresses at the nodes in the result, at the node where they stand there.
#[test]
fn extremes_of_stresses_are_those_of_the_result() {
    let space = include_str!("../../scenarios/block-3d.json");
    for (scenario, body, words) in
        [(TWO, "b", &["sx", "sy", "sxy", "s1", "s2", "mises"][..]), (space, "block", &["sz", "syz", "s3", "mises"])]
    {
        let mut session = read(scenario);
        let stresses = session.result(false).expect("an answer")["stresses"].as_array().expect("stresses").clone();
        let at_nodes: Vec<_> = stresses.iter().filter(|one| one["node"].is_string()).collect();
        assert!(at_nodes.len() > 4);
        for word in words {
            for (over, sign) in [("max", 1.0), ("min", -1.0)] {
                for body in ["", body] {
                    let inside =
                        |one: &&&serde_json::Value| one["node"].as_str().is_some_and(|node| node.starts_with(body));
                    let value = |one: &serde_json::Value| one[word].as_f64().expect("a number");
                    let extreme =
                        at_nodes.iter().filter(inside).map(|one| sign * value(one)).fold(f64::NEG_INFINITY, f64::max);
                    let shown = report(&mut session, &format!("show {over} {word} {body}")).expect("a row")[0].take();
                    assert_eq!(shown["value"].as_f64(), Some(sign * extreme), "{over} {word} {body}");
                    let there = at_nodes.iter().find(|one| one["node"] == shown["at"]).expect("a node");
                    assert_eq!(value(there), sign * extreme, "{shown}");
                }
            }
        }
        let peaks = report(&mut session, "summary").expect("a summary");
        let stress =
            peaks["extremes"].as_array().expect("extremes").iter().find(|one| one["quantity"] == "von Mises stress");
        assert_eq!(
            stress.expect("a line")["value"],
            report(&mut session, "show max mises").expect("a row")[0]["value"]
        );
    }
}

/// Signs of comparison need no blanks, wherever conditions are read; a probe with such a sign in its name keeps it.
#[test]
fn comparisons_need_no_blanks() {
    // u_y of B = −P L³/(3 E I), −0.32 at P = 3; M at the clamp is −4 P.
    let mut session = read(&TWO.replace("tip sag", "u<0"));
    for line in [
        "uy B=-0.32±1e-9",
        "uy B<-0.3",
        "uy B < -0.3",
        "u<0=-4*P*16/600 ± 1e-9",
        "u<0 = -0.32 ± 1e-9",
        "M AB start=-12±1e-9",
        "M AB at 1<=-8.9",
        "max x_n base[*]>=2",
        "count open=0",
        "state base[2]=stick",
        "outcome!=ray",
        "pivots>=0",
        "result places[0].value=2±1e-9",
    ] {
        text(&mut session, "find P 1..4 where M AB start=-8");
        text(&mut session, &format!("expect {line}"));
    }
    let found = report(&mut session, "find P 1..4 where uy B<-0.16*4/3").expect("an interval");
    assert!((found["holds"][0][0].as_f64().expect("a number") - 2.0).abs() < 1e-9, "{found}");
    assert!(refused(&mut session, "expect uy B>0").contains("expected uy B > 0"));
    assert!(refused(&mut session, "expect uy C>0").contains("no node `C`"));
    let mut beam = super::lines::embedded("beam");
    let slip = report(&mut beam, "show z_t c6").expect("a row")[0]["value"].as_f64().expect("a number");
    let found = report(&mut beam, &format!("calibrate f 0..1 where z_t c6={slip}")).expect("a friction");
    assert!((found["groups"][0]["value"].as_f64().expect("a number") - 0.5).abs() < 1e-6, "{found}");
    assert!(refused(&mut beam, "expect collapse<0.1").contains("nothing was sampled yet"));
}

/// The table of a quantity along a path: where n of the beam's pairs have reached their bound r = 50, c6 has slipped by
/// (L/EA) r n (n − 1)/2, L/EA = 1e-5.
#[test]
fn quantities_along_a_path_go_to_a_table() {
    let folder = tempfile::tempdir().expect("a place");
    let mut session = super::lines::embedded("beam");
    text(&mut session, "set F2 0");
    text(&mut session, "trace F2 to 260");
    let file = folder.path().join("p.csv");
    text(&mut session, &format!("export path z_t c6, max u {}", file.display()));
    let written = std::fs::read_to_string(&file).expect("written");
    let mut rows = written.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let head = rows.next().expect("a head");
    let column = |name: &str| head.iter().position(|column| *column == name).expect("a column");
    let (value, slip, change) = (column("value"), column("z_t c6"), column("change"));
    assert!(column("max u") > slip && change > slip);
    let mut turns = 0;
    for row in rows {
        let number = |at: usize| row[at].parse::<f64>().expect("a number");
        let n = number(value) / 50.0;
        if (n - n.round()).abs() < 1e-9 {
            let n = n.round();
            assert!((number(slip) - 1e-5 * 50.0 * n * (n - 1.0) / 2.0).abs() < 1e-12, "{row:?}");
            turns += 1;
        }
    }
    assert!(turns >= 5, "{written}");
    let json = file.with_extension("json");
    text(&mut session, &format!("export path z_t c6 {}", json.display()));
    let rows: serde_json::Value = serde_json::from_slice(&std::fs::read(&json).expect("written")).expect("JSON");
    assert!(rows.as_array().is_some_and(|rows| rows.len() > 5 && rows.iter().all(|row| row["z_t c6"].is_number())));
    let mut pipe = super::lines::embedded("pipeline");
    text(&mut pipe, "stages");
    text(&mut pipe, &format!("export path fx noz {}", file.display()));
    let written = std::fs::read_to_string(&file).expect("written");
    assert!(written.starts_with("stage,value,factor ") && written.lines().count() > 2, "{written}");
    assert!(refused(&mut pipe, &format!("export path force {}", file.display())).contains("takes quantities"));
}

/// Draws follow the load history of each point: in stage 1 B goes down by P L³/(3 E I) = 64 P/600.
#[test]
fn samples_follow_the_stages() {
    let staged =
        TWO.replace(r#""probes""#, r#""stages": [ { "weight": 1, "tip": 1 }, { "weight": 1, "tip": 0.5 } ], "probes""#);
    let mut session = read(&staged);
    let folder = tempfile::tempdir().expect("a place");
    let file = folder.path().join("draws.csv");
    text(
        &mut session,
        &format!("sample P=uniform(1,2) 8 of stage 1 uy B, stage 2 uy B --crude --out {}", file.display()),
    );
    let written = std::fs::read_to_string(&file).expect("written");
    let rows: Vec<Vec<&str>> = written.lines().skip(1).map(|row| row.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|column| *column == name).expect("a column");
    let (first, second) = (column("stage 1 uy B"), column("stage 2 uy B"));
    assert_eq!(rows.len(), 9);
    for row in &rows[1..] {
        let number = |at: usize| row[at].parse::<f64>().expect("a number");
        let p = number(0);
        assert!((number(first) + 64.0 * p / 600.0).abs() < 1e-9, "{row:?}");
        assert!((number(second) + 32.0 * p / 600.0).abs() < 1e-9, "{row:?}");
    }
    let sampled = report(&mut session, "sample P=uniform(1,2) 8 of stage 1 uy B").expect("a sample");
    let spread = &sampled["quantities"][0];
    assert_eq!(spread["known"].as_f64(), Some(1.0), "{sampled}");
    assert!(spread["most"].as_f64().is_some_and(|most| most <= -64.0 / 600.0 + 1e-9), "{sampled}");
    for line in ["map P 1..2 H 0..1 of stage 1 uy B", "trace push to 2 of stage 1 uy B"] {
        assert!(refused(&mut session, line).contains("sweep"), "{line}");
    }
    assert!(refused(&mut session, "trace push to 2 of rz b[0,0]").contains("has no rotation"));
    assert!(refused(&mut read(TWO), "sample P=uniform(1,2) of dissipated").contains("has no `stages`"));
    assert!(refused(&mut session, "show P").contains("`P` is a parameter"));
}

/// What is written for others keeps the labels of the units, and names of files have no blanks.
#[test]
fn systems_keep_their_units() {
    let folder = tempfile::tempdir().expect("a place");
    let mut session = read(TWO);
    for what in ["system", "lcp"] {
        let file = folder.path().join(format!("{what}.json"));
        text(&mut session, &format!("export {what} {}", file.display()));
        let written: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).expect("written")).expect("JSON");
        assert_eq!(written["units"], serde_json::json!({"length": "m", "force": "kN"}));
        let again = stickslip::model::load::load_text("again.json", &written.to_string(), None).expect("a scenario");
        assert_eq!((again.units.length.as_deref(), again.units.force.as_deref()), (Some("m"), Some("kN")));
    }
    let mut tower = super::lines::embedded("tower");
    text(&mut tower, &format!("export report {}", folder.path().join("t.md").display()));
    let files: Vec<String> = std::fs::read_dir(folder.path())
        .expect("files")
        .map(|file| file.expect("a file").file_name().into_string().expect("text"))
        .collect();
    assert!(
        files.contains(&"t-moment-M_y.svg".to_owned()) && files.iter().all(|file| !file.contains(' ')),
        "{files:?}"
    );
    let report = std::fs::read_to_string(folder.path().join("t.md")).expect("written");
    assert!(report.contains("t-moment-M_y.svg"), "the report names its figures");
}

/// An answer without pivots that is not that of the main system says by what it was found, wherever pivots are asked for: the
/// game of Cottle, Pang & Stone 4.4.23, on which Lemke's algorithm ends in a ray at its first pivot.
#[test]
fn answers_without_pivots_say_who_found_them() {
    let game = r#"{"format":"stickslip/1","title":"game","lcp":{"M":[[0,0,10,20],[0,0,30,15],[10,20,0,0],[30,15,0,0]],"q":[-1,-1,-1,-1]}}"#;
    let mut session = read(game);
    let found = "no pivots: the answer was found by bimatrix";
    assert!(text(&mut session, "pivots").contains(found));
    for line in ["step", "plot p"] {
        assert!(refused(&mut session, line).contains(found), "{line}");
    }
}
