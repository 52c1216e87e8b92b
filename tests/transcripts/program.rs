//! The program itself: its arguments, streams and exit statuses.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.env_remove("NO_COLOR").env("TERM", "xterm");
    command
}

fn piped(arguments: &[&str], input: &[u8]) -> (Vec<u8>, String, i32) {
    let mut child =
        program().args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_vec();
    let writer = std::thread::spawn(move || {
        let _ = stdin.write_all(&input);
    });
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    (output.stdout, error, output.status.code().unwrap())
}

#[test]
fn exit_statuses_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.json");
    fs::write(&bad, "{").unwrap();
    let bad = bad.display().to_string();
    for (arguments, input, status) in [
        (&["solve"][..], "", 0),
        (&["solve", "beam", "--set", "F2=10"], "", 0),
        (&["solve", "beam-ray"], "", 3),
        (&["solve", "painleve"], "", 3),
        (&["solve", "beam", "--set", "nothing=1"], "", 2),
        (&["solve", "beam", "--covering", "none"], "", 2),
        (&["solve", "nowhere"], "", 2),
        (&["solve", "greco", "--covering", "ones", "--set", "f=2"], "", 4),
        (&["solve", "cycling", "--tie-break", "first-row"], "", 4),
        (&["check", "beam", "frame"], "", 0),
        (&["check", "beam", &bad], "", 2),
        (&["scenarios"], "", 0),
        (&["completions", "bash"], "", 0),
        (&["--help"], "", 0),
        (&["--version"], "", 0),
        (&["--bogus"], "", 2),
        (&[&bad], "", 2),
        (&[], "status\n", 0),
        (&["beam-ray"], "status\n", 0),
        (&[], "bogus\nstatus\n", 2),
        (&[], "bogus\nexpect error unknown\n", 0),
        (&[], "expect outcome ray\n", 1),
        (&[], "expect outcome normal\nquit\nbogus\n", 0),
        (&["replay", "-"], "expect outcome normal", 0),
        (&["replay", "-"], "expect outcome ray", 1),
        (&["replay", "-"], "bogus", 2),
        (&["replay", "nowhere.stick"], "", 2),
    ] {
        let (_, error, found) = piped(arguments, input.as_bytes());
        assert_eq!(found, status, "{arguments:?} {input:?}: {error}");
        assert_eq!(error.is_empty(), !error.contains(':'), "{error}");
    }
}

#[test]
fn a_pipe_gets_results_only() {
    let (out, error, status) = piped(&["--width", "60"], b"status\npairs\n\xff\xfe\nset F2 150\r\nplot slip\n");
    let out = String::from_utf8(out).unwrap();
    assert!(!out.contains('\u{1b}') && !out.contains("> "), "{out}");
    assert!(out.starts_with("beam"));
    assert!(out.lines().all(|line| line.trim_end().chars().count() <= 60), "{out}");
    assert!(error.contains("unknown command"), "{error}");
    assert_eq!(status, 2);
    let (out, ..) = piped(&["--ascii"], b"status; pairs; plot slip; plot structure; pivots");
    assert!(out.is_ascii());
    let (out, ..) = piped(&["--color", "always"], b"pairs");
    assert!(out.contains(&0x1b));
}

#[test]
fn replays_repeat_to_the_byte_in_other_processes() {
    let scripts: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/scripts");
    let script = scripts.join("plates.stick").display().to_string();
    for format in ["text", "json"] {
        let first = piped(&["replay", &script, "--format", format], b"");
        assert_eq!(first.2, 0);
        assert_eq!(piped(&["replay", &script, "--format", format], b""), first);
    }
    let (out, _, _) = piped(&["solve", "frame", "--format", "json"], b"");
    assert_eq!(piped(&["solve", "frame", "--format", "json"], b"").0, out);
    let result: serde_json::Value = serde_json::from_slice(&out).unwrap();
    assert_eq!(result["format"], "stickslip-result/1");
}

#[test]
fn a_closed_pipe_is_success() {
    let mut child = program().stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let mut stdin = child.stdin.take().unwrap();
    let _ = stdin.write_all("pairs\n".repeat(50).as_bytes());
    drop(stdin);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn check_names_loose_parts_and_mechanisms() {
    let (out, error, status) = piped(&["check", "plates-free", "gap"], b"");
    let out = String::from_utf8(out).unwrap();
    assert_eq!((status, error.as_str()), (0, ""));
    let loose = out.lines().find(|line| line.starts_with("loose: ")).unwrap();
    assert!(loose.contains("`upper`") && loose.contains("slide along x"), "{out}");
    assert_eq!(out.matches("loose: ").count(), 1, "{out}");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a mechanism.json");
    let text = r#"{ "format": "stickslip/1", "title": "t", "nodes": { "A": [0, 0], "B": [2, 0] },
        "materials": { "s": { "E": 1, "nu": 0 } }, "sections": { "b": { "area": 1, "inertia": 1 } },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "s", "section": "b" }],
        "supports": [{ "at": "A", "fixed": ["x", "y"] }] }"#;
    fs::write(&path, text).unwrap();
    let (_, error, status) = piped(&["check", path.to_str().unwrap()], b"");
    assert_eq!(status, 2);
    assert!(error.contains("mechanism") && error.contains("node B"), "{error}");
}

#[test]
fn schema_is_json() {
    let (out, _, status) = piped(&["schema"], b"");
    let schema: Value = serde_json::from_slice(&out).unwrap();
    assert_eq!((status, &schema["title"]), (0, &Value::from("stickslip/1")));
}
