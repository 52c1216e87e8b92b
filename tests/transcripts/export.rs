//! `export`: what is written is what the answer holds, read back by small readers of this test.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use stickslip::model::{embedded, load::load_file};
use stickslip::session::{CommandError, Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

/// A block with a post, in which there is something of everything that can be exported: two load combinations, two
/// stages, a probe, an edge contact, a bar, a support.
pub(super) const SCENARIO: &str = r#"{
  "format": "stickslip/1", "title": "Block with a post", "units": { "length": "m", "force": "kN" },
  "parameters": { "f": { "value": 0.5, "min": 0, "max": 1 }, "H": 30 },
  "materials": { "m": { "E": 1e5, "nu": 0.2 } }, "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
  "nodes": { "A": [0, 3], "B": [0, 1], "S": [5, 1], "T": [5, 3] },
  "plates": [ { "id": "block", "origin": [0, 0], "size": [2, 1], "divisions": [2, 1], "thickness": 1,
                "material": "m", "plane": "stress" } ],
  "bars": [ { "id": "post", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 2 },
            { "id": "stay", "nodes": ["T", "S"], "material": "m", "section": "s" } ],
  "ties": [ { "nodes": ["B", "block[0,1]"], "fixed": ["x", "y"] }, { "nodes": ["post/1", "block[0,1]"], "fixed": ["x"] } ],
  "supports": [ { "at": "S", "fixed": ["x", "y", "r"] } ],
  "contacts": [ { "id": "base", "edge": "block.bottom", "against": "ground", "friction": "f" } ],
  "loads": {
    "weight": { "items": [ { "point": { "at": "block.top", "force": [0, -100] } }, { "point": { "at": "T", "force": [0, -7] } } ] },
    "push": { "factor": "H", "items": [ { "point": { "at": "block[0,0]", "force": [1, 0] } } ] } },
  "stages": [ { "weight": 1 }, { "weight": 1, "push": 1 } ],
  "combinations": { "ULS": { "weight": 1.2, "push": 1.1 }, "SLS": { "weight": 1, "push": 1 } },
  "probes": { "lift, left": "x_n base[0]" }
}"#;

pub(super) fn run(session: &mut Session, line: &str) -> Result<(), CommandError> {
    let mut out = Vec::new();
    session.execute(line, &mut Output::text(&mut out, Style::default(), &Quiet)).map(|_| ())
}

pub(super) fn open(folder: &Path) -> (Session, PathBuf) {
    let file = folder.join("post.json");
    fs::write(&file, SCENARIO).expect("a file");
    let scenario = load_file(&file).unwrap_or_else(|problems| panic!("{problems}"));
    (Session::new(scenario, &Quiet).expect("solved"), file)
}

/// The rows of a CSV text, fields unquoted.
fn csv(text: &str) -> Vec<Vec<String>> {
    let mut rows = vec![vec![String::new()]];
    let mut quoted = false;
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        let field = rows.last_mut().and_then(|row| row.last_mut()).expect("a field");
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => field.push(chars.next().expect("a quote")),
            '"' => quoted = !quoted,
            ',' if !quoted => rows.last_mut().expect("a row").push(String::new()),
            '\r' if !quoted => {}
            '\n' if !quoted => rows.push(vec![String::new()]),
            c => field.push(c),
        }
    }
    assert_eq!(rows.pop(), Some(vec![String::new()]), "the last line ends");
    rows
}

/// The numbers of an array of a `.vtu`.
fn array(text: &str, section: &str, name: &str) -> Vec<f64> {
    let section = text.split_once(&format!("<{section}")).expect("the section").1;
    let body = section.split_once(&format!("Name=\"{name}\"")).unwrap_or_else(|| panic!("no {name}")).1;
    let body = body.split_once('>').and_then(|(_, rest)| rest.split_once("</DataArray>")).expect("an array").0;
    body.split_ascii_whitespace().map(|word| word.parse().expect("a number")).collect()
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
}

#[test]
fn every_table_is_written_as_csv_and_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, _) = open(folder.path());
    for line in ["set H 49", "sweep f 0.4..0.6 3", "trace push to 20", "stages"] {
        run(&mut session, line).unwrap_or_else(|error| panic!("{line}: {error}"));
    }
    let header = |what: &str, of: &str| -> (Vec<String>, usize) {
        let [csv_file, json_file] = ["csv", "json"].map(|ending| folder.path().join(format!("{what}.{ending}")));
        for file in [&csv_file, &json_file] {
            let line = format!("export {what} {of} '{}'", file.display());
            run(&mut session, &line).unwrap_or_else(|error| panic!("{line}: {error}"));
        }
        json(&json_file);
        let rows = csv(&fs::read_to_string(&csv_file).expect("a file"));
        assert!(rows.len() > 1, "{what} is empty");
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{what}");
        (rows[0].clone(), rows.len() - 1)
    };
    let mut header = header;
    for (what, of, columns, count) in [
        ("pairs", "", "id,law,state,held,x_n,x_t,z_n,z_t,bound,reserve_plus,reserve_minus,x,y", 3),
        ("displacements", "", "node,ux,uy,rz", 11),
        ("members", "", "bar,element,start_N,start_Q,start_M,end_N,end_Q,end_M", 3),
        ("reactions", "", "node,fx,fy,m", 1),
        ("stresses", "", "node,sx,sy,sxy,s1,s2,mises", 6),
        ("resultants", "", "joint,N,T,e", 1),
        ("quantities", "x_n base[1], max u", "quantity,value,unit,reason,at", 2),
        ("probes", "", "quantity,value,unit,reason,at", 1),
        ("parameters", "", "name,value,file,formula,min,max,step,unit,about", 2),
        ("combinations", "", "name,factors_weight,factors_push,outcome,ray,pivots,probes_lift, left", 2),
        ("envelope", "", "quantity,unit,least_value,least_combination,largest_value,largest_combination", 1),
        (
            "stages",
            "",
            "stage,pivots,factors_weight,factors_push,max_slip,max_slip_increment,slip_increment_base[0],\
             slip_increment_base[1],slip_increment_base[2],dissipated,work,stored,balance,changes",
            2,
        ),
        ("sensitivity", "", "parameter,value,pair,x_n,x_t,z_n,z_t", 6),
        ("sensitivity", "f", "parameter,value,pair,x_n,x_t,z_n,z_t", 3),
    ] {
        let (names, rows) = header(what, of);
        assert_eq!((names.join(","), rows), (columns.to_owned(), count), "{what}");
    }
    // one number in a cell
    let rows = csv(&fs::read_to_string(folder.path().join("stages.csv")).expect("a file"));
    assert!(rows[1..].iter().flatten().all(|cell| cell.parse::<f64>().is_ok()), "{rows:?}");
    for what in ["pivots", "answers", "compare", "path"] {
        header(what, "");
    }
    let (names, rows) = header("sweep", "");
    assert_eq!((names[0].as_str(), rows), ("f", 3));
    // what a table says is what the answer holds: vertical equilibrium, with the 7 of the stay on its support
    let rows = csv(&fs::read_to_string(folder.path().join("pairs.csv")).expect("a file"));
    let sum: f64 = rows[1..].iter().map(|row| row[4].parse::<f64>().expect("a number")).sum();
    assert!((sum - 100.0).abs() < 1e-9, "{sum}");
    assert_eq!(json(&folder.path().join("reactions.json"))[0]["fy"].as_f64().map(f64::round), Some(7.0));
}

#[test]
fn the_result_of_a_followed_history_has_its_stages() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, _) = open(folder.path());
    let file = folder.path().join("result.json");
    run(&mut session, &format!("export result '{}'", file.display())).expect("written");
    let result = json(&file);
    assert!(result.get("stages").is_none());
    // 6 nodes and 2 elements
    assert_eq!(result["stresses"].as_array().map(Vec::len), Some(8));
    run(&mut session, &format!("stages; export result '{}'", file.display())).expect("written");
    assert_eq!(json(&file)["stages"].as_array().map(Vec::len), Some(2));
}

/// Σ of the contact forces of the file and the loads is 0, its displacements are those of the answer, and its stresses
/// over the top of the block carry the weight.
#[test]
fn a_mesh_holds_the_state_of_the_structure() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, _) = open(folder.path());
    let file = folder.path().join("post.vtu");
    run(&mut session, &format!("export vtu '{}'", file.display())).expect("written");
    let text = fs::read_to_string(&file).expect("a file");
    // 5 named or divided nodes, 6 of the block, 3 pairs
    let points = array(&text, "Points", "Points");
    assert_eq!(points.len(), 3 * 14);
    let [connectivity, offsets, types] = ["connectivity", "offsets", "types"].map(|name| array(&text, "Cells", name));
    assert_eq!(types, [[3.0; 3].as_slice(), &[9.0; 2], &[1.0; 3]].concat());
    assert_eq!(offsets.last(), Some(&(connectivity.len() as f64)));
    assert!(connectivity.iter().all(|&point| (0.0..14.0).contains(&point)));
    let answer = session.answer().expect("an answer");
    let displacement = array(&text, "PointData", "displacement");
    for (place, node) in answer.displacements.as_ref().expect("displacements").iter().enumerate() {
        assert_eq!(displacement[3 * place..3 * place + 2], [node.ux, node.uy], "{}", node.node);
    }
    let force = array(&text, "PointData", "contact_force");
    let sum = |axis: usize| force.iter().skip(axis).step_by(3).sum::<f64>();
    assert!((sum(0) + 30.0).abs() < 1e-9 && (sum(1) - 100.0).abs() < 1e-9, "{} {}", sum(0), sum(1));
    let state = array(&text, "PointData", "contact_state");
    assert!(state[..11].iter().all(|&state| state == -1.0) && state[11..].iter().all(|&state| state >= 0.0));
    // the stay carries 7 in compression
    assert_eq!(array(&text, "CellData", "N")[4..6].iter().map(|n| n.round()).collect::<Vec<_>>(), [-7.0, -7.0]);
    let stress = array(&text, "CellData", "stress");
    // σ_yy at the centres of the two elements, each 1 wide and 1 thick: they carry the 100 together
    let upper: f64 = (3..5).map(|cell| stress[4 * cell + 1]).sum();
    assert!((upper + 100.0).abs() < 1e-9, "{upper}");
}

#[test]
fn a_series_has_a_file_for_every_state() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, _) = open(folder.path());
    let file = folder.path().join("way.pvd");
    run(&mut session, &format!("set H 49; export vtu '{}'", file.display())).expect("written");
    let times = |text: &str| -> Vec<f64> {
        let words = text.split("timestep=\"").skip(1);
        words.map(|rest| rest.split('"').next().and_then(|time| time.parse().ok()).expect("a time")).collect()
    };
    let pivots = session.answer().expect("an answer").pivots.len();
    let text = fs::read_to_string(&file).expect("a file");
    assert_eq!(times(&text), (0..pivots).map(|step| step as f64).collect::<Vec<_>>());
    for name in text.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
        let mesh = fs::read_to_string(folder.path().join(name)).expect("a file of the series");
        assert_eq!(array(&mesh, "PointData", "contact_state").len(), 14);
    }
    run(&mut session, &format!("stages; export vtu '{}'", file.display())).expect("written");
    let times = times(&fs::read_to_string(&file).expect("a file"));
    assert!(times.is_sorted_by(|a, b| a < b) && times[0] == 0.0 && times.last() == Some(&2.0), "{times:?}");
}

#[test]
fn what_cannot_be_exported_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, file) = open(folder.path());
    let at = |name: &str| folder.path().join(name).display().to_string();
    let link = folder.path().join("link.json");
    std::os::unix::fs::symlink(&file, &link).expect("a link");
    for (line, message) in [
        (format!("export pairs {}", at("a.txt")), ".csv or .json"),
        (format!("export pairs {}", at("a")), ".csv or .json"),
        (format!("export vtu {}", at("a.csv")), ".vtu or .pvd"),
        (format!("export result {}", at("a.csv")), "must end in .json"),
        (format!("export pairs base[0] {}", at("a.csv")), "`base[0]` makes no sense"),
        (format!("export quantities {}", at("a.csv")), "of which quantities"),
        (format!("export quantities foo {}", at("a.csv")), "foo"),
        (format!("export stages {}", at("a.csv")), "`stages` first"),
        (format!("export sweep {}", at("a.csv")), "no sweep"),
        (format!("export path {}", at("a.csv")), "no path"),
        (format!("export pairs {}", file.display()), "the scenario itself"),
        (format!("export pairs {}", link.display()), "the scenario itself"),
        (format!("export pairs {}/no/such/a.csv", folder.path().display()), "cannot write"),
        ("export pairs".to_owned(), "OF FILE"),
        (format!("set H 80; export vtu {}", at("a.vtu")), "no answer"),
        (format!("export displacements {}", at("a.csv")), "no displacements"),
        (format!("export reactions {}", at("a.csv")), "no reactions"),
        (format!("load murty6; export vtu {}", at("a.vtu")), "no structure"),
    ] {
        let error = run(&mut session, &line).expect_err(&line).to_string();
        assert!(error.contains(message), "{line}: {error}");
    }
    assert_eq!(fs::read_to_string(&file).expect("there"), SCENARIO);
    let left: Vec<_> =
        fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("one").file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

/// The embedded structures, at the end and at the first pivot: whatever can be exported is, and nothing panics.
#[test]
fn embedded_structures_are_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, _) in embedded::list() {
        let mut session = Session::new(embedded::load(name).expect("embedded"), &Quiet).expect("solved");
        for line in ["export vtu x.vtu", "export pairs x.csv", "export result x.json", "step first; export vtu x.vtu"] {
            let line = line.replace(" x.", &format!(" {}/x.", folder.path().display()));
            if let Err(error) = run(&mut session, &line) {
                assert!(matches!(error, CommandError::Refused(_)), "{name}: {line}: {error}");
            }
        }
    }
}
