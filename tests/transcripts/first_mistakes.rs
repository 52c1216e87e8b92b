//! What somebody meets who does not know the program yet: a wrong word to the shell, a body that only contact holds, and what
//! is said beside a load history.

use std::process::Command;

use super::lines::{read, text, told};

/// A sliding bearing of one node, loaded downwards by W and sideways by P, which springs of stiffness 2 resist. The file
/// has a history at whose end P is 0.
const BEARING: &str = r#"{"format": "stickslip/1", "title": "bearing", "units": {"length": "m", "force": "kN"},
 "parameters": {"f": 0.1, "P": 30}, "nodes": {"n": [0, 0]},
 "springs": [{"at": "n", "direction": [1, 0], "stiffness": 2}],
 "contacts": [{"id": "pad", "node": "n", "against": "ground", "normal": [0, 1], "friction": "f"}],
 "loads": {"weight": {"items": [{"point": {"at": "n", "force": [0, -100]}}]},
           "push": {"factor": "P", "items": [{"point": {"at": "n", "force": [1, 0]}}]}},
 "stages": [{"weight": 1}, {"weight": 1, "push": 1}, {"weight": 1}]}"#;

fn refused(words: &[&str]) -> String {
    let ended = Command::new(env!("CARGO_BIN_EXE_stickslip")).args(words).output().unwrap();
    assert_eq!(ended.status.code(), Some(2), "{words:?}");
    String::from_utf8(ended.stderr).unwrap()
}

#[test]
fn a_wrong_word_to_the_shell_is_told_as_one() {
    let unknown = "error: unknown command `solv` (did you mean `solve`?); `stickslip --help` lists them\n";
    assert_eq!(refused(&["solv", "beam"]), unknown);
    let second = "error: `frame` after the scenario `beam`: one scenario is opened at a time\n";
    assert_eq!(refused(&["beam", "frame"]), second);
    assert!(refused(&["why", "beam"]).contains("`why` is a command of the prompt"));
}

#[test]
fn bodies_and_nodes_that_only_contact_holds_have_names() {
    let block = r#"{"format": "stickslip/1", "title": "block", "nodes": {"a": [0, 0], "b": [1, 0]},
     "rigid": [{"id": "block", "nodes": ["a", "b"]}],
     "contacts": [{"id": "c1", "node": "a", "against": "ground", "normal": [0, 1], "friction": 0.4},
                  {"id": "c2", "node": "b", "against": "ground", "normal": [0, 1], "friction": 0.4}],
     "loads": {"w": {"items": [{"point": {"at": "a", "force": [0, -1]}}]}}}"#;
    let said = text(&mut read(block), "status");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("loose: `block` can slide along x, lift off along y and turn about (0.5, 0)"), "{said}");
    let said = text(&mut read(BEARING), "status");
    assert!(said.contains("loose: node `n` can lift off along y; only contact holds it"), "{said}");
}

#[test]
fn a_contact_given_twice_is_told_with_the_status() {
    let pad = r#"{"id": "pad", "node": "n", "against": "ground", "normal": [0, 1], "friction": "f"}"#;
    let twice = BEARING.replace(pad, &format!("{pad}, {}", pad.replace("pad", "shoe")));
    let words = |scenario: &str| text(&mut read(scenario), "status").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&twice).contains("warnings contacts[1]: `shoe` has the nodes and the normal of `pad`"));
    assert!(!words(BEARING).contains("warnings"));
}

#[test]
fn after_a_history_what_is_not_of_it_says_so_and_pictures_have_its_loads() {
    let mut session = read(BEARING);
    // √(100² + 30²)
    assert!(text(&mut session, "plot structure").contains("weight + push up to 104.4 kN"));
    told(&mut session, "stages").unwrap();
    for line in ["why pad", "sensitivity"] {
        let said = text(&mut session, line);
        assert!(said.starts_with("of the answer with every load case acting at once; "), "{line}: {said}");
    }
    let said = text(&mut session, "summary");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("safety and limits are of the answer with every load case acting at once; "), "{said}");
    // The push has left.
    let said = text(&mut session, "plot structure");
    assert!(said.contains("load up to 100 kN") && !said.contains("weight + push"), "{said}");
}

#[test]
fn rounding_is_no_margin_and_service_events_are_named() {
    // A bar on a roller: heat lengthens it and presses nothing, whatever its temperature.
    let bar = r#"{"format": "stickslip/1", "title": "bar", "parameters": {"f": 0.05},
     "materials": {"s": {"E": 2.1e8, "nu": 0.3, "expansion": 1.2e-5}}, "sections": {"s": {"area": 0.0156, "inertia": 9.208e-4}},
     "nodes": {"A": [0, 0], "B": [0, 6], "C": [20, 6], "D": [20, 0]},
     "bars": [{"id": "bar", "polyline": ["A", "B", "C", "D"], "material": "s", "section": "s"}],
     "supports": [{"at": "A", "fixed": ["x", "y"]}],
     "contacts": [{"id": "pad", "node": "D", "against": "ground", "normal": [0, 1], "friction": "f"}],
     "loads": {"dead": {"items": [{"line": {"bar": "bar", "value": [0, -10], "range": [6, 26]}}]},
               "heat": {"factor": 30, "items": [{"temperature": {"change": 1, "on": ["bar"]}}]}}}"#;
    let said = text(&mut read(bar), "why pad");
    let (_, heat) = said.split_once("`heat` = 30").unwrap();
    assert!(heat.trim_start().starts_with("up, first       nothing turns"), "{said}");
    // The pad slips when the push exceeds f W = 10; then the spring alone takes all of it.
    let said = text(&mut read(BEARING), "set P 0; limit push");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("the only change lies at push = 10, where pair pad slips +"), "{said}");
    let friction = told(&mut read(BEARING), "limit f").unwrap_err();
    assert!(
        friction.starts_with("f is no load: it is the friction of pair pad; `trace f to V` follows it"),
        "{friction}"
    );
}

#[test]
fn a_moment_acts_alone() {
    let beam = |load: &str| {
        let text = format!(
            r#"{{"format": "stickslip/1", "title": "beam", "materials": {{"s": {{"E": 1, "nu": 0}}}},
             "sections": {{"s": {{"area": 1, "inertia": 1}}}}, "nodes": {{"A": [0, 0], "B": [1, 0]}},
             "bars": [{{"id": "AB", "nodes": ["A", "B"], "material": "s", "section": "s"}}],
             "supports": [{{"at": "A", "fixed": ["x", "y", "r"]}}], "loads": {{"m": {{"items": [{{"point": {load}}}]}}}}}}"#
        );
        super::lines::text(&mut read(&text), "show uy B")
    };
    // M l² / 2 E I
    let expected = beam(r#"{"at": "B", "force": [0, 0], "moment": 3}"#);
    assert!(expected.contains("1.5"), "{expected}");
    assert_eq!(beam(r#"{"at": "B", "moment": 3}"#), expected);
}

#[test]
fn a_range_behind_an_equals_sign_is_told_where_it_stands() {
    let mut session = read(BEARING);
    for line in
        ["map P=0..40 f 0..1", "map P 0..40 f=0..1", "envelope z_t pad over P=0..40", "find P=0..40 where z_t pad = 1"]
    {
        let said = told(&mut session, line).unwrap_err();
        assert!(said.contains("`: here the range stands behind the name: `"), "{line}: {said}");
    }
}

#[test]
fn displacements_beyond_the_size_of_the_structure_are_told() {
    // The free end goes α T L = 36 L, less f N L/(E A) < 1e-6 L.
    let bar = |expansion: &str| {
        format!(
            r#"{{"format": "stickslip/1", "title": "bar",
             "materials": {{"s": {{"E": 2.1e8, "nu": 0.3, "expansion": {expansion}}}}}, "sections": {{"s": {{"area": 0.0156, "inertia": 9.2e-4}}}},
             "nodes": {{"C": [0, 0], "D": [20, 0]}}, "bars": [{{"id": "bar", "nodes": ["C", "D"], "material": "s", "section": "s"}}],
             "supports": [{{"at": "C", "fixed": ["x", "y"]}}],
             "contacts": [{{"id": "pad", "node": "D", "against": "ground", "normal": [0, 1], "friction": 0.05}}],
             "loads": {{"heat": {{"items": [{{"temperature": {{"on": ["bar"], "change": 30}}}}]}},
                       "weight": {{"items": [{{"point": {{"at": "D", "force": [0, -10]}}}}]}}}}}}"#
        )
    };
    let said = |expansion: &str| {
        let status = text(&mut read(&bar(expansion)), "status");
        status.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let words = "the largest displacement is 36.0 times the size of the structure";
    assert!(said("1.2").contains(words), "{}", said("1.2"));
    assert!(!said("1.2e-5").contains("times the size"), "{}", said("1.2e-5"));
}

/// Heated by 100 K the pipe closes a gap of 5 mm (1.2e-5 · 100 · 10 m = 12 mm); cooled again, nothing acts and nothing has
/// moved. What is left of the difference of two numbers of 5 mm is rounding, though no force is there to measure it by.
#[test]
fn a_history_may_end_without_any_load() {
    let pipe = r#"{"format": "stickslip/1", "dimension": 3, "title": "pipe",
     "materials": {"s": {"E": 2e8, "nu": 0.3, "expansion": 1.2e-5}},
     "sections": {"p": {"area": 5e-3, "inertia_y": 3e-5, "inertia_z": 3e-5, "torsion": 6e-5}},
     "nodes": {"a": [0, 0, 0], "b": [10, 0, 0], "c": [10, 5, 0]},
     "bars": [{"id": "p", "polyline": ["a", "b", "c"], "material": "s", "section": "p"}],
     "supports": [{"at": "a", "fixed": ["x", "y", "z", "rx", "ry", "rz"]}],
     "contacts": [{"id": "stop", "node": "b", "against": "ground", "normal": [-1, 0, 0], "friction": 0.3, "gap": 0.005}],
     "loads": {"heat": {"factor": 100, "items": [{"temperature": {"change": 1, "on": ["p"]}}]}},
     "stages": [{"heat": 1}, {"heat": 0}]}"#;
    let mut session = read(pipe);
    told(&mut session, "stages").unwrap();
    let said = text(&mut session, "check");
    assert!(said.contains("passed") && !said.contains("FAILED"), "{said}");
    for line in ["expect outcome normal", "expect z_n stop = 0.005 +- 1e-15", "expect stage 1 x_n stop > 100"] {
        told(&mut session, line).unwrap_or_else(|error| panic!("{line}: {error}"));
    }
}
