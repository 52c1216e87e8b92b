//! The program with meshes: what `check` lists, values that are set, files that include others or are saved elsewhere.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(arguments).current_dir(folder).env("TERM", "dumb").output().expect("the program")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

#[test]
fn check_lists_what_a_mesh_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy("fuzz/seeds/gmsh/groups-2.2.msh", folder.path().join("dam.msh")).expect("a copy");
    let found = run(folder.path(), &["check", "dam.msh"]);
    let lines: Vec<String> = text(&found.stdout).lines().map(|line| line.trim_end().to_owned()).collect();
    assert_eq!(
        lines,
        [
            "dam.msh: no problems found (Gmsh 2.2, ASCII)",
            "9 nodes, x 0 to 2, y 0 to 2",
            "6 lines of 2 nodes, 4 quadrilaterals of 4 nodes; area 4",
            "worst element: 5 (dam.msh:29), quality 1 (1 best, 0 degenerate)",
            "",
            "group  members   number  length    area",
            "foot   lines          2  2.0000",
            "head   lines          2  2.0000",
            "body   elements       4          4.0000",
            "side   lines          2  2.0000",
            "",
            "boundary  nodes  length",
            "bottom        3  2.0000",
            "top           3  2.0000",
            "left          3  2.0000",
            "right         3  2.0000",
        ]
    );
    let found = run(folder.path(), &["check", "dam.msh", "--format", "json"]);
    let found: Value = serde_json::from_str(&text(&found.stdout)).expect("JSON");
    let mesh = &found["checked"][0];
    assert_eq!(
        (mesh["mesh"].as_str(), mesh["nodes"].as_u64(), mesh["area"].as_f64()),
        (Some("dam.msh"), Some(9), Some(4.0))
    );
    assert_eq!(mesh["groups"][2]["name"], "body");
    assert_eq!(mesh["groups"][2]["area"], 4.0);
    assert_eq!(mesh["groups"][0]["length"], 2.0);
    assert_eq!(mesh["worst"]["place"], "dam.msh:29");
    assert_eq!(mesh["boundary"][1]["name"], "top");

    let broken = fs::read_to_string(folder.path().join("dam.msh")).expect("text").replace("1 1 2 5 4", "1 1 5 2 4");
    fs::write(folder.path().join("bad.msh"), broken).expect("a file");
    let found = run(folder.path(), &["check", "bad.msh", "--format", "json"]);
    assert_eq!(found.status.code(), Some(2));
    assert!(text(&found.stderr).starts_with("bad.msh:29:1: element 5 is a bow tie"), "{}", text(&found.stderr));
    let found: Value = serde_json::from_str(&text(&found.stdout)).expect("JSON");
    assert_eq!((&found["error"][0]["file"], &found["error"][0]["line"]), (&Value::from("bad.msh"), &Value::from(29)));
    let found = run(folder.path(), &["solve", "dam.msh"]);
    assert!(text(&found.stderr).contains("dam.msh: this is a mesh, not a scenario"), "{}", text(&found.stderr));
}

const SCENARIO: &str = r#"{ "format": "stickslip/1", "title": "block", "parameters": { "s": 1, "t": 1 },
  "materials": { "c": { "E": 1000, "nu": 0.2, "density": 3 } },
  "meshes": [ { "id": "m", "file": "main.inp", "scale": "s", "materials": {
    "BODY": { "material": "c", "thickness": "2*t", "plane": "stress" } } } ],
  "contacts": [ { "id": "j", "edge": "m.bottom", "against": "ground", "friction": 0.5 } ],
  "loads": { "w": { "items": [ { "gravity": { "acceleration": [0, -10], "on": ["m.Body"] } } ] } } }"#;

/// Weight = ρ g t (s · 2)(s · 1): it follows the parameters; the mesh is in three files, and stays in reach of a scenario
/// that is saved in another folder.
#[test]
fn values_follow_and_files_stay_in_reach() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("main.inp", "*HEADING\n*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=CPS4, ELSET=Body, INPUT=elements.inp\n");
    write("nodes.inp", "*NODE\n1, 0, 0\n2, 1, 0\n3, 2, 0\n4, 0, 1\n5, 1, 1\n6, 2, 1\n");
    write("elements.inp", "1, 1, 2, 5, 4\n2, 5, 6, 3, 2\n");
    write("block.json", SCENARIO);
    fs::create_dir(folder.path().join("sub")).expect("a folder");
    write(
        "run.stick",
        "load block.json\nexpect sum x_n j = 120 +- 1e-9\nset s 2\nexpect sum x_n j = 480 +- 1e-9\nset t 0.25\nexpect sum x_n j = 120 +- 1e-9\n\
         expect sy m#1 < 0\nsave sub/block.json\nload sub/block.json\nexpect sum x_n j = 120 +- 1e-9\nstatus\n",
    );
    let found = run(folder.path(), &["replay", "run.stick"]);
    let (out, error) = (text(&found.stdout), text(&found.stderr));
    assert_eq!(found.status.code(), Some(0), "{out}{error}");
    // The second element runs clockwise.
    assert!(out.contains("1 element runs clockwise"), "{out}");

    write("elements.inp", "1, 1, 2, 5, 4\n2, 5, 6, 3, 9\n");
    let found = run(folder.path(), &["check", "block.json", "main.inp"]);
    let error = text(&found.stderr);
    assert!(error.contains("meshes[0].file: elements.inp:2: element 2 names node 9"), "{error}");
    assert!(error.contains("main.inp: elements.inp:2: element 2 names node 9"), "{error}");
    write("nodes.inp", "*NODE\n1, 0, 0\n*INCLUDE, INPUT=nodes.inp\n");
    let error = text(&run(folder.path(), &["check", "block.json"]).stderr);
    assert!(error.contains("nodes.inp:3: the file \"nodes.inp\" includes itself"), "{error}");
}
