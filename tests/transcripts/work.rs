//! The user's work: what is saved, what a crash leaves, what a terminal gets to see.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use serde_json::Value;
use stickslip::session::Session;
use stickslip::session::journal::Journal;

use super::{line, refused, session, shown};

pub(super) fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    for name in ["NO_COLOR", "LC_ALL", "LC_CTYPE", "LANG"] {
        command.env_remove(name);
    }
    command.env("TERM", "xterm");
    command
}

/// stdout, stderr, status.
fn ended(mut child: Child, input: &[u8]) -> (String, String, i32) {
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_vec();
    let writer = std::thread::spawn(move || stdin.write_all(&input));
    let output = child.wait_with_output().unwrap();
    // a program that has read enough closes the pipe
    let _ = writer.join().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(output.stdout), text(output.stderr), output.status.code().unwrap_or(-1))
}

pub(super) fn run(arguments: &[&str], input: &[u8]) -> (String, String, i32) {
    ended(program(arguments).spawn().unwrap(), input)
}

/// The value that the last `params` shows.
pub(super) fn value<'a>(out: &'a str, name: &str) -> &'a str {
    let row = out.lines().rev().find(|line| line.split_whitespace().next() == Some(name)).unwrap_or_default();
    row.split_whitespace().nth(1).unwrap_or_default()
}

pub(super) fn at(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

fn beam(folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, stickslip::model::embedded::text("beam").unwrap()).unwrap();
    path
}

#[test]
fn the_full_screen_is_refused_where_nobody_sees_it() {
    for word in ["tui", "tour"] {
        let script = format!("{word}\nexpect outcome ray\n");
        // what comes after it is tested: no green by leaving early
        for (arguments, status) in [
            (&[][..], 2),
            (&["replay", "-"], 2),
            (&["replay", "-", "--keep-going"], 2),
            (&["replay", "-", "--format", "json"], 2),
        ] {
            let (out, error, found) = run(arguments, script.as_bytes());
            assert_eq!(found, status, "{arguments:?}: {out}{error}");
            assert!(error.contains("refused") && error.contains(word), "{error}");
        }
        let (_, error, status) = run(&["replay", "-", "--keep-going"], script.as_bytes());
        assert!(error.contains("expected") && status == 2, "{error}");
        let asked_for = format!("{word}\nexpect error \"full screen\"\nexpect outcome ray\n");
        assert_eq!(run(&["replay", "-"], asked_for.as_bytes()).2, 1);
        assert_eq!(run(&[], asked_for.as_bytes()).2, 1);
    }
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("a.stick");
    fs::write(&script, "tui\n").unwrap();
    assert!(refused(&mut session("beam"), &format!("source {}", script.display())).contains("full screen"));
}

#[test]
fn a_saved_file_is_the_one_that_diff_and_reset_follow() {
    let folder = tempfile::tempdir().unwrap();
    let file = at(folder.path(), "mine.json");
    let mut one = session("beam");
    shown(&mut one, &format!("set F2 150; set f 0.3; save {file}"));
    assert_eq!(one.scenario().name, file);
    assert!(shown(&mut one, "diff").contains("nothing differs"));
    shown(&mut one, "set F2 90; set covering weight");
    assert!(shown(&mut one, "diff").contains("150"));
    shown(&mut one, "reset");
    assert_eq!((one.values()["F2"], one.values()["f"]), (150.0, 0.3));
    // back through the changes, and the file is still the one on disk
    shown(&mut one, "undo; undo; undo; undo; undo");
    assert_eq!((one.values()["F2"], one.values()["f"]), (250.0, 0.5));
    assert_eq!(one.scenario().name, file);
    shown(&mut one, "reset F2");
    assert_eq!(one.values()["F2"], 150.0);
    // and `save` without a name goes there
    shown(&mut one, "set F2 77; save");
    let mut two = session("gap");
    shown(&mut two, &format!("load {file}"));
    assert_eq!(two.values()["F2"], 77.0);
    let (out, _, _) =
        run(&["replay", "-"], format!("set F2 60\nsave {file}\nexport result {file}.out.json").as_bytes());
    assert!(out.contains("saved"), "{out}");
    let result: Value = serde_json::from_str(&fs::read_to_string(format!("{file}.out.json")).unwrap()).unwrap();
    assert_eq!(result["scenario"], file.as_str());
}

/// Kills sessions after random commands among changes and saves, and compares what `restore` brings back.
#[test]
fn whatever_was_saved_restore_brings_back_the_same_values() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(11);
    for _ in 0..12 {
        let folder = tempfile::tempdir().unwrap();
        let files: Vec<String> =
            (0..2).map(|k| beam(folder.path(), &format!("{k}.json")).display().to_string()).collect();
        let mut one =
            Session::new(stickslip::model::load::load_file(Path::new(&files[0])).unwrap(), &stickslip::watch::Quiet)
                .unwrap();
        one.keep_journal(Journal::new(folder.path(), Path::new("/here")));
        shown(&mut one, "set F2 += 3");
        for _ in 0..random.random_range(3..12) {
            let file = &files[random.random_range(0..2)];
            let text = match random.random_range(0..12) {
                0 => format!("save {file}"),
                1 => "save".to_owned(),
                2 => format!("load {file}"),
                3 => "undo".to_owned(),
                4 => "redo".to_owned(),
                5 => "reset f".to_owned(),
                6 => "set tie-break natural".to_owned(),
                7 => "reset".to_owned(),
                8 => "set F2 *= 1.1".to_owned(),
                9 => "set auto off; set f 110%; set auto on".to_owned(),
                10 => format!("set f {}", random.random_range(0.1..0.9)),
                _ => "set F2 += 10".to_owned(),
            };
            // `undo` with nothing to undo is refused
            let _ = line(&mut one, &text);
        }
        let then = (one.as_commands(), one.values().clone(), one.rules(), one.pairs(), one.undo_depths());
        drop(one);
        let before: Vec<Vec<u8>> = files.iter().map(|file| fs::read(file).unwrap()).collect();
        let mut two = session("gap");
        two.keep_journal(Journal::new(folder.path(), Path::new("/here")));
        shown(&mut two, "restore");
        let depths = two.undo_depths();
        assert_eq!(
            (two.as_commands(), two.values().clone(), two.rules(), two.pairs()),
            (then.0, then.1, then.2, then.3)
        );
        assert_eq!((depths.0, depths.1), (then.4.0 + 1, then.4.1));
        // it ran changes only: no file was written
        assert_eq!(files.iter().map(|file| fs::read(file).unwrap()).collect::<Vec<_>>(), before);
        // all the way back to where this session was
        for _ in 0..depths.0 {
            shown(&mut two, "undo");
        }
        assert_eq!(two.scenario().name, "gap");
    }
}

#[test]
fn a_file_that_changed_or_went_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = beam(folder.path(), "b.json");
    let start = |name: &str| {
        let mut one =
            Session::new(stickslip::model::load::load_file(&file).unwrap(), &stickslip::watch::Quiet).unwrap();
        one.keep_journal(Journal::new(folder.path(), Path::new(name)));
        shown(&mut one, "set F2 123");
    };
    start("/a");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("Multi-span", "Another")).unwrap();
    let mut two = session("gap");
    two.keep_journal(Journal::new(folder.path(), Path::new("/a")));
    assert!(shown(&mut two, "restore").contains("not as it was"));
    assert_eq!(two.values()["F2"], 123.0);
    start("/b");
    fs::remove_file(&file).unwrap();
    let mut three = session("gap");
    three.keep_journal(Journal::new(folder.path(), Path::new("/b")));
    assert!(refused(&mut three, "restore").contains("b.json"));
    assert_eq!(three.scenario().name, "gap");
    // nothing is lost by trying
    fs::write(&file, text).unwrap();
    shown(&mut three, "restore");
    assert_eq!(three.values()["F2"], 123.0);
}

/// A journal keeps values and rules, no texts: what a file held before it was read again is not made up from what it holds now.
#[test]
fn what_a_file_held_before_it_was_read_again_is_told_to_be_gone() {
    let folder = tempfile::tempdir().unwrap();
    let file = beam(folder.path(), "b.json");
    let open = |name: &str| {
        let mut one =
            Session::new(stickslip::model::load::load_file(&file).unwrap(), &stickslip::watch::Quiet).unwrap();
        one.keep_journal(Journal::new(folder.path(), Path::new(name)));
        one
    };
    let text = fs::read_to_string(&file).unwrap();
    for (after, ways) in [("", (2, 0)), ("; undo", (1, 1))] {
        fs::write(&file, &text).unwrap();
        let mut one = open(after);
        shown(&mut one, "set F2 123");
        fs::write(&file, text.replace("Multi-span", "Another")).unwrap();
        shown(&mut one, &format!("reload; set F2 150; set F2 160{after}"));
        drop(one);
        let mut two = session("gap");
        two.keep_journal(Journal::new(folder.path(), Path::new(after)));
        let said = shown(&mut two, "restore");
        assert!(
            said.contains("`reload` cannot be undone: what") && said.contains("b.json held then is not kept"),
            "{said}"
        );
        assert_eq!(two.undo_depths(), ways);
        (0..ways.0).for_each(|_| drop(shown(&mut two, "undo")));
        assert!(refused(&mut two, "undo").contains("nothing to undo"));
        assert_eq!((two.values()["F2"], two.scenario().title.contains("Another")), (123.0, true));
    }
}

/// Everything that a user or a file can say, with what steers a terminal in it.
#[test]
fn no_input_steers_the_terminal() {
    const POISON: &str = "\u{1b}]0;owned\u{7}\u{1b}[2J\u{1b}[31m\u{9b}2J\u{85}\u{202e}\u{2066}\u{200f}\r";
    let folder = tempfile::tempdir().unwrap();
    let text = stickslip::model::embedded::text("beam").unwrap();
    let title = serde_json::from_str::<Value>(&format!("\"{}\"", "T")).unwrap();
    let in_json: String = POISON.chars().map(|c| format!("\\u{:04x}", u32::from(c))).collect();
    assert_eq!(title, "T");
    let name = folder.path().join(format!("a{POISON}b.json"));
    let poisoned = text
        .replacen("\"title\": \"", &format!("\"title\": \"{in_json}"), 1)
        .replacen("\"length\": \"", &format!("\"length\": \"{in_json}"), 1)
        .replacen("\"about\": \"", &format!("\"about\": \"{in_json}"), 1)
        .replacen("\"description\": \"", &format!("\"description\": \"{in_json}"), 1);
    fs::write(&name, poisoned).unwrap();
    let (name, out) = (name.display().to_string(), at(folder.path(), &format!("o{POISON}.csv")));
    let script = format!(
        "echo '{POISON}'\nload '{name}'\nstatus\nparams\nset F2 9\ndiff\nsave '{name}'\npairs\ndisplacements\nmembers\nplot slip\nplot structure\nexport pairs '{out}'\nhistory\nwhy '{POISON}'\nhelp '{POISON}'\nset '{POISON}' 1\nexpect error '{POISON}'\nsource '{POISON}'\n{POISON}\nsweep F2 1..2 2\nsweep F2 1..2 2 --out '{out}2.csv'\nrecord '{out}.stick'\nrecord off\nload '{POISON}'\ntrace '{POISON}'\n"
    );
    let shard = at(folder.path(), &format!("s{POISON}.csv"));
    let commands: Vec<(Vec<&str>, &str)> = vec![
        (vec![], &script),
        (vec!["--color", "always"], &script),
        (vec!["replay", "-", "--keep-going"], &script),
        (vec!["replay", "-", "--keep-going", "--format", "json"], &script),
        (vec!["solve", &name], ""),
        (vec!["solve", &name, "--format", "json"], ""),
        (vec!["solve", &name, "--set", POISON], ""),
        (vec!["solve", &name, "--covering", POISON], ""),
        (vec!["solve", POISON, "--format", "json"], ""),
        (vec![POISON], ""),
        (vec!["solve", "beam", POISON], ""),
        (vec!["--color", POISON, "solve"], ""),
        (vec!["check", &name, POISON], ""),
        (vec!["check", &name, POISON, "--format", "json"], ""),
        (vec!["sweep", &name, "--vary", "f=0:1:0.5"], ""),
        (vec!["sweep", &name, "--vary", "f=0:1:0.5", "--format", "json"], ""),
        (vec!["sweep", &name, "--vary", "f=0:1:0.5", "--out", &shard], ""),
        (vec!["sweep", "beam", "--vary", POISON], ""),
        (vec!["merge", &shard], ""),
        (vec!["merge", &shard, "--out", &out], ""),
        (vec!["merge", POISON], ""),
        (vec!["replay", POISON], ""),
    ];
    for (arguments, input) in commands {
        let colour = arguments.contains(&"always");
        let (out, error, _) = run(&arguments, input.as_bytes());
        for shown in [&out, &error] {
            let plain = if colour { without_colours(shown) } else { shown.clone() };
            let bad = plain.chars().find(|c| *c != '\n' && stickslip::text::printable::is_unprintable(*c));
            assert!(bad.is_none(), "{arguments:?}: {bad:?} in {plain:?}");
        }
        assert!(out.len() + error.len() > 10, "{arguments:?}");
    }
}

/// Without the colours that this program uses; outside a curve, red without bold is not one of them.
fn without_colours(text: &str) -> String {
    let mut plain = text.to_owned();
    for code in ["0", "1", "90", "32", "33", "1;31", "1;36", "35", "34", "36"] {
        plain = plain.replace(&format!("\u{1b}[{code}m"), "");
    }
    plain
}

#[test]
fn options_may_stand_before_the_command() {
    for (before, after) in [
        (&["--format", "json", "solve", "beam"][..], &["solve", "beam", "--format", "json"][..]),
        (&["--format=json", "solve", "beam"], &["solve", "beam", "--format=json"]),
        (&["--ascii", "--set", "F2=100", "solve"], &["solve", "--ascii", "--set", "F2=100"]),
        (&["--width", "50", "check", "beam", "gap"], &["check", "beam", "gap", "--width", "50"]),
        (
            &["--vary", "f=0:1:0.5", "--shard", "1/2", "sweep", "beam"],
            &["sweep", "beam", "--vary", "f=0:1:0.5", "--shard", "1/2"],
        ),
        (&["--keep-going", "replay", "-"], &["replay", "-", "--keep-going"]),
    ] {
        let found = run(before, b"bogus\nstatus\n");
        assert_eq!(found, run(after, b"bogus\nstatus\n"), "{before:?}");
        assert!(found.2 == 0 || before.contains(&"replay"), "{before:?}: {}", found.1);
    }
    assert_eq!(run(&["--format", "yaml", "solve"], b"").2, 2);
    assert_eq!(run(&["--bogus", "solve"], b"").2, 2);
}

#[test]
fn bad_input_is_told_in_json_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let bad = at(folder.path(), "bad.json");
    fs::write(&bad, "{ \"format\": \"stickslip/1\", \"title\": \"t\",\n  \"nodes\": { \"A\": [0] } }").unwrap();
    for arguments in [
        &["solve", &bad, "--format", "json"][..],
        &["sweep", &bad, "--vary", "f=1", "--format", "json"],
        &["check", "beam", &bad, "--format", "json"],
    ] {
        let (out, error, status) = run(arguments, b"");
        let found: Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{arguments:?}: {out}"));
        let first = &found["error"][0];
        assert_eq!((&first["file"], &first["line"]), (&Value::from(bad.as_str()), &Value::from(2)), "{out}");
        for key in ["column", "path", "message", "help"] {
            assert!(!first[key].is_null(), "{key}: {out}");
        }
        assert_eq!(status, 2);
        assert!(error.contains("bad.json:2:"), "{error}");
    }
    for arguments in [
        &["solve", "nowhere", "--format", "json"][..],
        &["solve", "beam", "--set", "x=1", "--format=json"],
        &["--format", "json", "solve", "beam", "--covering", "x"],
    ] {
        let (out, _, status) = run(arguments, b"");
        let found: Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{arguments:?}: {out}"));
        assert!(found["error"][0]["message"].as_str().is_some_and(|text| !text.is_empty()), "{out}");
        assert_eq!(status, 2);
    }
    let (out, _, status) = run(&["check", "beam", "plates-free", "--format", "json"], b"");
    let found: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((status, found["checked"].as_array().unwrap().len()), (0, 2));
    assert_eq!(found["checked"][1]["loose"].as_array().unwrap().len(), 1);
    assert!(found["error"].is_null());
}

#[test]
fn commands_meant_for_a_scenario_that_did_not_load_are_refused() {
    for arguments in [&[][..], &["replay", "-", "--keep-going"]] {
        let (out, error, status) = run(arguments, b"load nowhere\nset F2 7\nparams\nload beam\nset F2 8\nparams\n");
        assert_eq!(status, 2);
        assert_eq!(error.matches("not done").count(), 2, "{error}");
        assert_eq!((value(&out, "F2"), out.matches("in the file").count()), ("8", 1), "{out}");
        let (out, error, status) = run(arguments, b"load nowhere\nexpect error nowhere\nset F2 7\nparams\n");
        assert_eq!((status, error.contains("not done")), (0, false), "{error}");
        assert_eq!(value(&out, "F2"), "7", "{out}");
    }
    // by hand one goes on
    let mut one = session("beam");
    assert!(refused(&mut one, "load nowhere").contains("nowhere"));
    shown(&mut one, "set F2 7");
}

#[test]
fn reactions_have_one_entry_for_a_node_that_is_held_and_sprung() {
    // A cantilever clamped across and in rotation, held along by a spring; another spring props its end.
    let folder = tempfile::tempdir().unwrap();
    let file = at(folder.path(), "springs.json");
    fs::write(
        &file,
        r#"{ "format": "stickslip/1", "title": "t", "nodes": { "A": [0, 0], "B": [2, 0] },
        "materials": { "s": { "E": 1000, "nu": 0 } }, "sections": { "b": { "area": 1, "inertia": 1 } },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "s", "section": "b" }],
        "supports": [{ "at": "A", "fixed": ["y", "r"] }],
        "springs": [{ "at": "A", "direction": [1, 0], "stiffness": 8 }, { "at": "B", "direction": [0, 1], "stiffness": 3 }],
        "loads": { "P": { "items": [{ "point": { "at": "B", "force": [4, -6] } }] } } }"#,
    )
    .unwrap();
    let (out, error, status) = run(&["solve", &file, "--format", "json"], b"");
    assert_eq!(status, 0, "{error}");
    let result: Value = serde_json::from_str(&out).unwrap();
    let reactions = result["reactions"].as_array().unwrap();
    let entry = |k: usize, key: &str| reactions[k][key].as_f64().unwrap();
    assert_eq!(
        (reactions.len(), &reactions[0]["node"], &reactions[1]["node"]),
        (2, &Value::from("A"), &Value::from("B"))
    );
    // the spring at A takes all of 4 along; at the end of a clamped bar 3 EI/L³ = 375 stands beside the spring of 3
    let spring = 6.0 * 3.0 / 378.0;
    for (found, expected) in [
        (entry(0, "fx"), -4.0),
        (entry(0, "fy"), 6.0 - spring),
        (entry(0, "m"), 2.0 * (6.0 - spring)),
        (entry(1, "fx"), 0.0),
        (entry(1, "fy"), spring),
        (entry(1, "m"), 0.0),
    ] {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    let mut one = session("beam");
    let table = shown(&mut one, &format!("load {file}; reactions"));
    assert!(table.contains("sum") && table.contains("about (0, 0): 12"), "{table}");
}
