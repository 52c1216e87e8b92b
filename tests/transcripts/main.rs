//! The language of commands, driven without a terminal: every command and its help, scripts, recordings, journals.

mod book;
mod explain_rays;
mod export;
mod export_pictures;
mod export_tables;
mod first_mistakes;
mod generated;
mod help;
#[path = "../common/lines.rs"]
mod lines;
mod numbers;
mod pictures_in_space;
mod plausibility;
mod program;
mod pty;
mod quantities;
mod questions;
mod random_lines;
mod recording;
mod references;
mod reload;
mod repl_pty;
mod result_keys;
mod scripts;
mod serve;
mod surroundings;
mod system_limits;
mod tables;
mod tour;
mod true_words;
mod tui_pty;
mod watch_pty;
mod work;

use std::fs;
use std::path::Path;
use std::sync::Arc;

use stickslip::model::embedded;
use stickslip::session::commands;
use stickslip::session::journal::Journal;
use stickslip::session::language::help::{help, overview};
use stickslip::session::{CommandError, Next, Output, Session, script};
use stickslip::view::style::Style;
use stickslip::watch::{Quiet, Watch};

fn session(name: &str) -> Session {
    Session::new(embedded::load(name).unwrap(), &Quiet).unwrap()
}

/// What a line shows and how it ends.
fn line(session: &mut Session, text: &str) -> (String, Result<Next, CommandError>) {
    let mut out = Vec::new();
    let result = session.execute(text, &mut Output::text(&mut out, Style::default(), &Quiet));
    (String::from_utf8(out).unwrap(), result)
}

fn shown(session: &mut Session, text: &str) -> String {
    let (shown, result) = line(session, text);
    result.unwrap_or_else(|error| panic!("{text}: {error}"));
    shown
}

fn refused(session: &mut Session, text: &str) -> String {
    match line(session, text).1 {
        Ok(_) => panic!("{text} was accepted"),
        Err(error) => error.to_string(),
    }
}

/// All of a session that a failed command must leave as it was: commands that lead to it, its answer, the pivot
/// shown, the depths of undo and redo, whether it solves at once.
type State = (Vec<String>, Option<usize>, Option<usize>, (usize, usize), bool);

fn state(session: &Session) -> State {
    (
        session.as_commands(),
        session.solved().map(|solved| Arc::as_ptr(&solved) as usize),
        session.position(),
        session.undo_depths(),
        session.auto(),
    )
}

#[test]
fn help_of_everything() {
    let mut all = overview(&Style::default());
    for name in commands::all().map(|command| command.name) {
        all.push_str(&format!("\n──── help {name}\n{}", help(name, 80).unwrap()));
    }
    assert!(all.lines().all(|line| line.chars().count() <= 80));
    insta::assert_snapshot!("help", all);
}

#[test]
fn every_command_on_the_beam() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = session("beam");
    let mut transcript = String::new();
    for text in [
        "scenarios",
        "params",
        "set F2 150",
        "diff",
        "undo",
        "redo",
        "reset",
        "load beam-ray",
        "ray",
        "undo",
        "solve",
        "pairs",
        "pairs c5..c6 sort z_t",
        "displacements",
        "members",
        "reactions",
        "pivots 1..2",
        "step first",
        "step",
        "pairs c6",
        "why c6",
        "step back 1",
        "step to 3",
        "step last",
        "why c1",
        "plot slip",
        "plot force --width 60 --height 8",
        "plot gap",
        "plot pressure",
        "plot p",
        "plot structure",
        "plot slip --at first,2,last",
        "set F2 500",
        "set auto off",
        "set F2 90",
        "set auto on",
        "set covering weight",
        "reset covering",
        "echo so far",
        "expect outcome normal",
        "bogus",
        "expect error unknown",
        "load klarbring",
        "pairs",
        "load murty6",
        "pairs",
        "load frame",
        "plot moment",
        "members",
        "history",
    ] {
        transcript.push_str(&format!("> {text}\n"));
        match line(&mut session, text) {
            (shown, Ok(_)) => transcript.push_str(&shown),
            (_, Err(error)) => transcript.push_str(&format!("! {error}\n")),
        }
    }
    // rounding of the last digits is not what this test is about
    let steady: Vec<&str> = transcript.lines().filter(|line| !line.contains("min w")).collect();
    insta::assert_snapshot!("commands", steady.join("\n"));
    for (what, ending) in [("pairs", "csv"), ("pivots", "json"), ("displacements", "csv"), ("result", "json")] {
        let file = folder.path().join(format!("{what}.{ending}"));
        shown(&mut session, &format!("export {what} {}", file.display()));
        assert!(fs::metadata(&file).unwrap().len() > 20);
    }
}

#[test]
fn numbers_of_the_closed_form_appear() {
    let mut session = session("beam");
    // r = 30, F2 = 150: end slip 300 L/EA, L/EA = 1e-5
    shown(&mut session, "set f 0.3; set F2 150");
    let slips: Vec<f64> = session.pairs().iter().map(|pair| pair.z_t).collect();
    for (found, expected) in slips.iter().rev().zip([300.0, 180.0, 90.0, 30.0, 0.0, 0.0]) {
        assert!((found - expected * 1e-5).abs() < 1e-12, "{slips:?}");
    }
    // at pivot 1 only the pulled end slips, under p > 0
    shown(&mut session, "step to 1");
    assert!(session.p().unwrap() > 0.0);
    assert!(session.pairs()[5].z_t > 0.0 && session.pairs()[4].z_t == 0.0);
    shown(&mut session, "step last");
    assert_eq!(session.p(), Some(0.0));
}

#[test]
fn all_forms_of_set() {
    let mut session = session("beam");
    let mut after = |text: &str| {
        shown(&mut session, text);
        session.values()["F2"]
    };
    assert_eq!(after("set F2 100"), 100.0);
    assert_eq!(after("set F2 = 120"), 120.0);
    assert_eq!(after("set F2 += 10"), 130.0);
    assert_eq!(after("set F2 -= 30"), 100.0);
    assert_eq!(after("set F2 *= 2"), 200.0);
    assert_eq!(after("set F2 /= 2"), 100.0);
    assert_eq!(after("set F2 110%"), 110.0);
    assert_eq!(after("set F2 100; set F2 +10%"), 110.0);
    assert_eq!(after("set F2 100; set F2 -10%"), 90.0);
    assert_eq!(after("set F2=75"), 75.0);
    assert!(shown(&mut session, "set F2 1000").contains("outside"));
    for (text, part) in [
        ("set F3 1", "did you mean"),
        ("set F2", "set F2 VALUE"),
        ("set F2 many", "expected a number"),
        ("set f -0.1", "must not be negative"),
        ("set F2 1e999", "number"),
        ("set F2 /= 0", "finite"),
        ("set covering wait", "cohesive, ones or weight"),
        ("set auto maybe", "on or off"),
    ] {
        let before = state(&session);
        let error = refused(&mut session, text);
        assert!(error.contains(part), "{text}: {error}");
        assert_eq!(state(&session), before, "{text}");
    }
}

#[test]
fn a_refused_rule_leaves_the_session_as_it_was() {
    let mut session = session("beam");
    // without friction the covering `weight` has d_τ = 0
    shown(&mut session, "set f 0");
    let before = state(&session);
    refused(&mut session, "set covering weight");
    assert_eq!(state(&session), before);
    shown(&mut session, "load murty6");
    assert!(refused(&mut session, "set covering ones").contains("LCP"));
}

#[test]
fn undo_and_redo_go_all_the_way() {
    let mut session = session("beam");
    let first = session.answer().unwrap().clone();
    for k in 1..=200 {
        shown(&mut session, &format!("set F2 {k}"));
    }
    shown(&mut session, "load frame; set f 0.2");
    let last = session.answer().unwrap().pairs.clone();
    for _ in 0..202 {
        shown(&mut session, "undo");
    }
    assert_eq!(session.answer().unwrap().pairs, first.pairs);
    assert!(refused(&mut session, "undo").contains("nothing to undo"));
    for _ in 0..202 {
        shown(&mut session, "redo");
    }
    assert_eq!(session.answer().unwrap().pairs, last);
    assert!(refused(&mut session, "redo").contains("nothing to redo"));
    shown(&mut session, "undo; set f 0.25");
    assert!(refused(&mut session, "redo").contains("nothing to redo"));
}

#[test]
fn a_saved_scenario_has_the_same_answer_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["beam", "frame-rotated", "block", "plates-free", "klarbring"] {
        let file = folder.path().join(format!("{name}.json"));
        let mut one = session(name);
        shown(&mut one, "set f *= 1.1; set tie-break natural");
        shown(&mut one, &format!("save {}", file.display()));
        let mut two = session("gap");
        shown(&mut two, &format!("load {}", file.display()));
        assert_eq!(two.rules(), one.rules());
        assert_eq!(two.answer().unwrap().pairs, one.answer().unwrap().pairs, "{name}");
        assert_eq!(two.answer().unwrap().pivots, one.answer().unwrap().pivots, "{name}");
        assert!(shown(&mut two, "diff").contains("nothing differs"));
    }
    let mut embedded = session("beam");
    assert!(refused(&mut embedded, "save").contains("save FILE"));
    assert!(refused(&mut embedded, "save /nowhere/at/all.json").contains("cannot"));
}

#[test]
fn collected_changes_are_solved_once() {
    let mut session = session("beam");
    shown(&mut session, "set auto off; set f 0; set covering weight");
    assert!(session.answer().is_none());
    assert!(refused(&mut session, "pairs").contains("solve"));
    // solved only now, and refused only now
    assert!(line(&mut session, "solve").1.is_err());
    shown(&mut session, "set f 0.3; solve");
    assert!(session.answer().is_some());
    assert!(!session.auto());
}

#[test]
fn a_recording_reproduces_the_session() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("session.stick");
    let mut one = session("beam");
    shown(&mut one, "set f 0.37; set F2 150; step to 1");
    shown(&mut one, &format!("record {}", file.display()));
    for text in [
        "pairs",
        "step last",
        "set F2 += 10",
        "set f +10% # more of it",
        "bogus \"it's; #\"",
        "set covering weight; undo; redo",
        "expect outcome ray",
        "plot slip",
        "load frame; set f 0.2",
    ] {
        let _ = line(&mut one, text);
    }
    shown(&mut one, "record off");
    shown(&mut one, "set f 0.9");
    let script = fs::read_to_string(&file).unwrap();
    assert!(script.contains("# expect outcome ray"), "{script}");
    let mut two = session("gap");
    let mut out = Vec::new();
    let mut io = Output::text(&mut out, Style::default(), &Quiet);
    let ended = script::run(&mut two, "recording", &script, false, &mut io, &mut |error| panic!("{error}\n{script}"));
    assert_eq!(ended.unwrap().status, 0);
    shown(&mut one, "undo");
    assert_eq!(two.as_commands(), one.as_commands());
    assert_eq!(two.answer().unwrap().pairs, one.answer().unwrap().pairs);
    // what the recording shows as comments is what the replay shows
    let shown_again = String::from_utf8(out).unwrap();
    let answers: Vec<&str> = script.lines().filter_map(|line| line.strip_prefix("#   ")).collect();
    assert!(
        answers.iter().filter(|line| !line.starts_with("expected")).all(|line| shown_again.contains(line.trim_end()))
    );
    assert!(refused(&mut one, &format!("record {}", file.display())).contains("exists"));
}

#[test]
fn a_journal_brings_everything_back() {
    let folder = tempfile::tempdir().unwrap();
    let place = Path::new("/somewhere");
    let mut one = session("beam");
    one.keep_journal(Journal::new(folder.path(), place));
    shown(&mut one, "set f 0.37; set F2 += 10; set F2 *= 1.5; undo; set tie-break natural");
    shown(&mut one, "load frame; set f 110%");
    let (commands, pairs, depths) = (one.as_commands(), one.pairs(), one.undo_depths());
    drop(one); // a crash, as far as the journal can tell
    let mut two = session("beam");
    two.keep_journal(Journal::new(folder.path(), place));
    assert!(two.left_over().is_some());
    shown(&mut two, "restore");
    assert_eq!((two.as_commands(), two.pairs()), (commands, pairs));
    assert_eq!(two.undo_depths().0, depths.0 + 1); // and the `load` it began with
    assert!(refused(&mut two, "restore").contains("nothing to restore"));
    shown(&mut two, "undo; undo");
    drop(two);
    // the second crash loses nothing either
    let mut three = session("gap");
    three.keep_journal(Journal::new(folder.path(), place));
    shown(&mut three, "restore");
    assert_eq!(three.scenario().name, "beam");
    three.close().unwrap();
    let mut four = session("gap");
    four.keep_journal(Journal::new(folder.path(), place));
    assert!(four.left_over().is_none());
}

struct Stopped;
impl Watch for Stopped {
    fn stop(&self) -> bool {
        true
    }
}

#[test]
fn an_interrupted_command_changes_nothing() {
    let mut session = session("beam");
    shown(&mut session, "set F2 100; step first");
    for text in ["set F2 150", "load frame", "undo", "solve", "reset"] {
        let before = state(&session);
        let mut out = Vec::new();
        let result = session.execute(text, &mut Output::text(&mut out, Style::default(), &Stopped));
        assert!(matches!(&result, Err(error) if error.is_interrupted() && error.status() == 130), "{result:?}");
        assert_eq!(state(&session), before, "{text}");
    }
}

#[test]
fn given_numbers_keep_their_digits() {
    let mut session = session("beam");
    shown(&mut session, "set F2 60.00006; set f 0.123456789012");
    for command in ["params", "status"] {
        let text = shown(&mut session, command);
        assert!(text.contains("60.00006") && text.contains("0.123456789012"), "{text}");
    }
    assert!(refused(&mut session, "set f=").contains("to what?"));
    assert!(refused(&mut session, "set f=abc").starts_with("`abc`"));
}

#[test]
fn the_lcp_goes_to_a_scenario_and_to_matrix_market() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let mut session = session("beam");
    let said = shown(&mut session, &format!("export lcp {}", at("b.mtx")));
    for part in ["b.mtx", "b.q.mtx", "b.d.mtx"] {
        assert!(said.contains(part), "{said}");
        let text = fs::read_to_string(at(part)).unwrap();
        let columns = if part == "b.mtx" { 18 } else { 1 };
        assert!(text.contains(&format!("\n18 {columns}\n")), "{text}");
    }
    assert!(refused(&mut session, &format!("export lcp {}", at("b.csv"))).contains(".mtx"));
    shown(&mut session, &format!("export lcp {}; load {}", at("b.json"), at("b.json")));
    shown(&mut session, "expect outcome normal; expect lcp = 18");
    // Without friction the tightening weight covers nothing: no covering vector of an lcp.
    let text = r#"{ "format": "stickslip/1", "title": "t", "solver": { "covering": "weight" }, "contact_system":
        { "pairs": ["c"], "stiffness": [[1, 0], [0, 1]], "loads": { "w": { "vector": [1, 0] } } } }"#;
    fs::write(at("smooth.json"), text).unwrap();
    shown(&mut session, &format!("load {}", at("smooth.json")));
    assert!(refused(&mut session, &format!("export lcp {}", at("c.json"))).contains("d > 0"));
}

/// Pivots are made on the polygon, answers in space are on the cone: below the pivots stands which directions are whose. With
/// the cone off they are the same, and in the plane there are none.
#[test]
fn pivots_in_space_say_whose_directions_they_tell() {
    let words = "directions in the pivots' lines are those of the 8 facets of the polygon";
    let in_one_line = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut space = session("bearing-two-way");
    let pivots = in_one_line(shown(&mut space, "pivots"));
    assert!(pivots.contains('°') && pivots.contains(words), "{pivots}");
    let off = in_one_line(shown(&mut space, "set cone off; pivots"));
    assert!(off.contains('°') && !off.contains(words), "{off}");
    let plane = in_one_line(shown(&mut session("beam"), "pivots"));
    assert!(!plane.contains("directions in the pivots' lines"), "{plane}");
}
