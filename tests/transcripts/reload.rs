//! `reload`, and what `edit` and `watch` refuse where nobody sits at a terminal.

use std::fs;
use std::path::Path;

use stickslip::model::load::load_file;
use stickslip::session::{Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

use super::lines::told;

/// Two springs and a contact: x_n = F - k u with given parameters.
fn write(path: &Path, parameters: &str, friction: &str) {
    let text = format!(
        r#"{{
  "format": "stickslip/1", "title": "two blocks", "parameters": {{ {parameters} }},
  "nodes": {{ "a": [0, 0], "b": ["L", 0] }},
  "materials": {{ "m": {{ "E": 1000, "nu": 0.2 }} }}, "sections": {{ "s": {{ "area": 1, "inertia": 1 }} }},
  "bars": [{{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s" }}],
  "contacts": [
    {{ "id": "c1", "node": "a", "against": "ground", "normal": [0, 1], "friction": "{friction}" }},
    {{ "id": "c2", "node": "b", "against": "ground", "normal": [0, 1], "friction": "{friction}" }}
  ],
  "loads": {{ "weight": {{ "factor": "F", "items": [{{ "point": {{ "at": "a", "force": [0, -1] }} }}, {{ "point": {{ "at": "b", "force": [0, -1] }} }}] }} }}
}}"#
    );
    fs::write(path, text).unwrap();
}

#[test]
fn what_was_set_is_kept_where_it_fits_and_the_rest_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.json");
    write(&path, r#""L": 2, "F": 5, "f": 0.5, "x": 1"#, "f + x");
    let mut session = Session::new(load_file(&path).unwrap(), &Quiet).unwrap();
    assert!(told(&mut session, "reload").unwrap().contains("is as it was"));
    told(&mut session, "set F 7; set f 0.25; set x 3; set covering weight").unwrap();
    // f gets another value in the file, x goes, F becomes a formula, L stays as it was but was never set
    write(&path, r#""L": 3, "F": { "formula": "2*L" }, "f": 0.75"#, "f");
    let said = told(&mut session, "reload").unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    for part in [
        "s.json read again, without F = 7 (it is a formula now); x = 3 (there is no such parameter any more)",
        "kept: f = 0.25, covering weight",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let value = |session: &Session, name: &str| session.values()[name];
    assert_eq!((value(&session, "f"), value(&session, "L"), value(&session, "F")), (0.25, 3.0, 6.0));
    // each pair bears F
    assert!((session.answer().unwrap().pairs[0].x_n - 6.0).abs() < 1e-9);
    told(&mut session, "undo").unwrap();
    assert_eq!((value(&session, "F"), value(&session, "x")), (7.0, 3.0));
    told(&mut session, "redo").unwrap();
    told(&mut session, "reset").unwrap();
    assert_eq!(value(&session, "f"), 0.75);
}

/// The rules of the polygon are kept like all others, and dropped where the problem is no longer in space.
#[test]
fn rules_of_space_are_kept_in_space() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.json");
    let text = |title: &str| stickslip::model::embedded::load("block-3d").unwrap().text.replace("\"title\": \"", title);
    fs::write(&path, text("\"title\": \"One ")).unwrap();
    let mut session = Session::new(load_file(&path).unwrap(), &Quiet).unwrap();
    told(&mut session, "set facets 16; set cone off").unwrap();
    fs::write(&path, text("\"title\": \"Another ")).unwrap();
    let said = told(&mut session, "reload").unwrap();
    assert!(said.contains("kept: facets 16, cone off"), "{said}");
    let rules = session.rules();
    assert_eq!((rules.facets, rules.cone), (16, false));
    assert!(told(&mut session, "set nothing 1").unwrap_err().contains("engine, facets, cone and auto"));
    write(&path, r#""L": 2, "F": 5, "f": 0.5"#, "f");
    let said = told(&mut session, "reload").unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("facets 16 (it is for problems in space); cone off (it is for problems in space)"), "{said}");
}

#[test]
fn values_that_make_the_new_text_invalid_give_way_to_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.json");
    write(&path, r#""L": 2, "F": 5, "f": 0.5"#, "f");
    let mut session = Session::new(load_file(&path).unwrap(), &Quiet).unwrap();
    told(&mut session, "set L 4").unwrap();
    // at L = 4 its bar has no length
    let text = fs::read_to_string(&path).unwrap().replace("[\"L\", 0]", "[\"L - 4\", 0]");
    fs::write(&path, text).unwrap();
    let said = told(&mut session, "reload").unwrap();
    assert!(said.contains("read again, without L = 4 ("), "{said}");
    assert_eq!(session.values()["L"], 2.0);
}

#[test]
fn a_file_that_is_wrong_or_gone_leaves_the_session_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.json");
    write(&path, r#""L": 2, "F": 5, "f": 0.5"#, "f");
    let mut session = Session::new(load_file(&path).unwrap(), &Quiet).unwrap();
    told(&mut session, "set F 7").unwrap();
    let before = session.as_commands();
    write(&path, r#""L": 2, "F": 5, "f": 0.5"#, "g");
    let error = told(&mut session, "reload").unwrap_err();
    assert!(error.contains("s.json:7:") && error.contains("contacts[0].friction"), "{error}");
    fs::remove_file(&path).unwrap();
    assert!(told(&mut session, "reload").unwrap_err().contains("cannot read"));
    assert_eq!(session.as_commands(), before);
    assert!((session.answer().unwrap().pairs[0].x_n - 7.0).abs() < 1e-9);
}

#[test]
fn what_needs_hands_is_refused_in_scripts_and_embedded_scenarios_have_no_file() {
    let mut session = Session::new(stickslip::model::embedded::load("beam").unwrap(), &Quiet).unwrap();
    for command in ["edit", "watch on"] {
        let error = told(&mut session, command).unwrap_err();
        assert!(error.contains("in a script and on a pipe it is refused"), "{error}");
        let mut out = Vec::new();
        let mut io = Output::text(&mut out, Style::default(), &Quiet);
        io.has_screen = true;
        let error = session.execute(command, &mut io).unwrap_err().to_string();
        assert!(error.contains("`save beam.json` gives it one"), "{error}");
    }
    assert!(told(&mut session, "reload").unwrap_err().contains("`save beam.json` gives it one"));
    assert!(told(&mut session, "watch").unwrap().contains("no file is watched"));
    assert!(session.watched().is_none());
}
