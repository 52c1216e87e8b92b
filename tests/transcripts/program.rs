//! The program itself: its arguments, streams and exit statuses.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use stickslip::model::embedded;

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

/// The commands that only the shell has. Help is the same for a command of the prompt however the shell is asked for
/// it; where the shell does not have the command itself, it points to the prompt.
#[test]
fn every_command_is_known_where_it_is_given() {
    const SHELL_ONLY: [&str; 7] = ["replay", "merge", "serve", "schema", "doctor", "completions", "man"];
    let (out, ..) = piped(&["--help"], b"");
    let help = String::from_utf8(out).unwrap();
    let of_shell = |word: &str| help.lines().any(|line| line.strip_prefix("  ").is_some_and(|l| l.starts_with(word)));
    assert!(SHELL_ONLY.iter().all(|word| of_shell(&format!("{word} "))), "{help}");
    for word in stickslip::session::commands::all().map(|command| command.name) {
        assert!(!SHELL_ONLY.contains(&word), "{word}");
        let (out, error, status) = piped(&[word, "--help"], b"");
        let asked = piped(&["help", word], b"");
        assert_eq!((&out, status), (&asked.0, 0), "{word}: {error}");
        let (_, error, status) = piped(&[word, "a", "--no-such-option"], b"");
        let is_pointed = error.contains("is a command of the prompt");
        assert_eq!((status, is_pointed), (2, !of_shell(&format!("{word} "))), "{word}: {error}");
    }
    let (_, error, _) = piped(&["sweep", "beam", "--vary", "f=0:1:0.5", "--shard", "17/16", "--out", "x.csv"], b"");
    assert!(error.contains("17/16"), "{error}");
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
fn check_warns_of_what_is_hardly_meant_and_succeeds() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("soft.json");
    let text = embedded::text("gap").unwrap().replace("2.1e8", "210");
    fs::write(&path, &text).unwrap();
    let file = path.to_str().unwrap();
    let line = 1 + text.lines().position(|line| line.contains("210,")).unwrap();
    let (out, error, status) = piped(&["check", file, "--width", "1000"], b"");
    let out = String::from_utf8(out).unwrap();
    assert_eq!((status, error.as_str()), (0, ""));
    assert!(out.contains(&format!("warning: {file}:{line}:")), "{out}");
    assert!(out.contains("materials.steel.E: `steel` has E = 210 kN/m²") && out.contains("  help: "), "{out}");
    let (out, _, status) = piped(&["check", file, "gap", "--format", "json"], b"");
    let report: Value = serde_json::from_slice(&out).unwrap();
    let warning = &report["checked"][0]["warnings"][0];
    assert_eq!((status, &warning["line"], &warning["file"]), (0, &line.into(), &file.into()));
    assert_eq!(warning["path"], "materials.steel.E");
    assert!(warning["column"].is_u64() && warning["message"].is_string() && warning["help"].is_string());
    assert_eq!(report["checked"][1]["warnings"], serde_json::json!([]));
    assert!(report.get("error").is_none());
}

#[test]
fn schema_is_json() {
    let (out, _, status) = piped(&["schema"], b"");
    let schema: Value = serde_json::from_slice(&out).unwrap();
    assert_eq!((status, &schema["title"]), (0, &Value::from("stickslip/1")));
}

/// The embedded beam with stages, in a file.
fn beam_with_stages(folder: &Path, stages: &str) -> String {
    let text = stickslip::model::embedded::text("beam").unwrap();
    let end = text.rfind('}').unwrap();
    let path = folder.join("beam-stages.json");
    fs::write(&path, format!("{},\n  \"stages\": {stages}\n}}\n", text[..end].trim_end())).unwrap();
    path.display().to_string()
}

fn solved(arguments: &[&str]) -> (Value, i32) {
    let (out, error, status) = piped(&[&["solve"], arguments, &["--format", "json"]].concat(), b"");
    (serde_json::from_slice(&out).unwrap_or_else(|_| panic!("{error}")), status)
}

/// r = f F = 30, L/EA = 1e-5: under 150 the bars carry 120, 90, 60, 30 and 0, so the ends slip 300, 180, 90, 30 and 0
/// (in 1e-5) and 30 · 600e-5 are dissipated; on the way back to −150 everything is twice that (Masing).
#[test]
fn solve_follows_the_history_of_a_scenario_with_stages() {
    let folder = tempfile::tempdir().unwrap();
    let stages = r#"[{"weight": 1}, {"weight": 1, "pull": 1}, {"weight": 1, "pull": -1}]"#;
    let file = beam_with_stages(folder.path(), stages);
    let set = ["--set", "f=0.3", "--set", "F2=150"];
    let (result, status) = solved(&[&[file.as_str()][..], &set].concat());
    assert_eq!((status, &result["outcome"], &result["p"]), (0, &"normal".into(), &0.0.into()));
    let close = |found: &Value, expected: f64| {
        let found = found.as_f64().unwrap_or_else(|| panic!("{found}"));
        assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-3), "{found} is not {expected}");
    };
    let slips = |pairs: &Value, factor: f64| {
        for (pair, slip) in pairs.as_array().unwrap().iter().zip([0.0, 0.0, 30.0, 90.0, 180.0, 300.0]) {
            close(&pair["z_t"], factor * slip * 1e-5);
        }
    };
    slips(&result["pairs"], -1.0);
    assert_eq!(result["pairs"][5]["state"], "slip-");
    assert!(result["check"]["passed"].as_bool().unwrap(), "{}", result["check"]);
    assert_eq!(result["attempts"].as_array().unwrap().len(), 1);
    assert_eq!(result["attempts"][0]["covering"], "cohesive");
    assert!(!result["pivots"].as_array().unwrap().is_empty());
    let stages = result["stages"].as_array().unwrap();
    assert_eq!(stages.len(), 3);
    for (stage, (pull, dissipated, factor)) in
        stages.iter().zip([(0.0, 0.0, 0.0), (150.0, 0.18, 1.0), (-150.0, 0.36, -1.0)])
    {
        close(&stage["factors"]["weight"], 100.0);
        close(&stage["factors"]["pull"], pull);
        close(&stage["dissipated"], dissipated);
        slips(&stage["pairs"], factor);
        assert!(stage["balance"].as_f64().unwrap() <= 1e-12, "{}", stage["balance"]);
        close(&stage["displacements"][5]["ux"], factor * 300e-5);
        let length = |key: &str| stage[key].as_array().unwrap().len();
        assert_eq!((length("members"), length("displacements")), (5, 6));
        assert!(stage["reactions"].is_array());
    }
    close(&result["displacements"][5]["ux"], -300e-5);

    let (at_once, status) = solved(&[&[file.as_str(), "--at-once"][..], &set].concat());
    assert_eq!(status, 0);
    slips(&at_once["pairs"], 1.0);
    assert!(at_once.get("stages").is_none());

    let (out, _, status) = piped(&[&["solve", &file][..], &set].concat(), b"");
    let out = String::from_utf8(out).unwrap();
    assert_eq!(status, 0);
    assert!(out.contains("the load history was followed") && out.contains("--at-once"), "{out}");
    assert!(out.contains("dissipated") && out.contains("mm") && out.contains("-3.0000"), "{out}");
}

/// 6 f F = 300 of the 500 that the second stage asks for.
#[test]
fn solve_tells_the_limit_on_the_way_of_a_history() {
    let folder = tempfile::tempdir().unwrap();
    let stages = r#"[{"weight": 1}, {"weight": 1, "pull": 2}, {"weight": 1}]"#;
    let file = beam_with_stages(folder.path(), stages);
    let (result, status) = solved(&[&file]);
    assert_eq!(status, 3);
    assert_eq!(result["outcome"], "ray");
    assert_eq!((&result["ray"]["class"], &result["ray"]["verdict"]), (&"mechanism".into(), &"certified".into()));
    assert!(result.get("displacements").is_none());
    let stages = result["stages"].as_array().unwrap();
    assert_eq!(stages.len(), 2);
    assert!((stages[1]["done"].as_f64().unwrap() - 0.6).abs() <= 1e-12, "{}", stages[1]["done"]);
    assert!((stages[1]["factors"]["pull"].as_f64().unwrap() - 300.0).abs() <= 1e-9);
    let (.., status) = piped(&["solve", &file], b"");
    assert_eq!(status, 3);
}
