//! What the system sets limits to: lines, pipes, devices, files, memory.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::pty::PATIENCE;
use super::work::{at, program, run, value};

fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-s", name, &id]).status().unwrap().success());
}

fn end(child: &mut Child) -> i32 {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code().unwrap_or(-1);
        }
        if start.elapsed() > PATIENCE {
            let _ = child.kill();
            panic!("it does not end");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_line_that_is_too_long_is_refused_whole() {
    let input = format!(
        "set F2 100\necho {}; set F2 200\nexpect error bytes\nexpect outcome normal\nexpect x_n c1 = 100 ± 1e-6\nparams\n",
        "x".repeat(1 << 20)
    );
    let (out, error, status) = run(&[], input.as_bytes());
    assert!(error.contains("line 2 has more than"), "{error}");
    assert!(value(&out, "F2") == "100", "{out}");
    assert_eq!(status, 0, "{error}");
    let (out, _, status) = run(&["replay", "-", "--keep-going"], input.as_bytes());
    assert!(!out.contains("xxx") || status == 2, "{status}");
}

#[test]
#[cfg(unix)]
fn reading_that_does_not_end_can_be_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = at(folder.path(), "fifo");
    assert!(Command::new("mkfifo").arg(&fifo).status().unwrap().success());
    for arguments in [
        &["solve", &fifo][..],
        &["check", &fifo],
        &["sweep", &fifo, "--vary", "f=0.1"],
        &["replay", &fifo],
        &["merge", &fifo],
        &["import", &fifo],
        &["solve", "-"],
        &["replay", "-"],
        &[&fifo],
    ] {
        for name in ["INT", "TERM"] {
            let mut child = program(arguments).spawn().unwrap();
            let stdin = child.stdin.take();
            std::thread::sleep(Duration::from_millis(300));
            signal(&child, name);
            assert_eq!(end(&mut child), 130, "{arguments:?} {name}");
            drop(stdin);
        }
    }
    // in a session the session stays
    let mut child = program(&[]).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(format!("load {fifo}\n").as_bytes()).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    signal(&child, "TERM");
    assert_eq!(end(&mut child), 143);
}

#[test]
#[cfg(unix)]
fn pipes_are_read_and_devices_are_not() {
    let folder = tempfile::tempdir().unwrap();
    let text = stickslip::model::embedded::text("beam").unwrap();
    let (out, error, status) = run(&["solve", "/dev/stdin", "--format", "json"], text.as_bytes());
    assert_eq!(status, 0, "{error}");
    let (dash, _, _) = run(&["solve", "-", "--format", "json"], text.as_bytes());
    let pairs = |text: &str| serde_json::from_str::<Value>(text).unwrap()["pairs"].clone();
    assert_eq!(pairs(&dash), pairs(&out));
    for arguments in [
        &["solve", "/dev/zero"][..],
        &["check", "/dev/zero"],
        &["replay", "/dev/zero"],
        &["merge", "/dev/zero"],
        &["solve", folder.path().to_str().unwrap()],
    ] {
        let (_, error, status) = run(arguments, b"");
        assert_eq!(status, 2, "{arguments:?}: {error}");
        assert!(error.contains("device") || error.contains("folder"), "{error}");
    }
}

#[test]
#[cfg(unix)]
fn a_limit_of_the_file_size_is_an_error_like_a_full_disk() {
    let folder = tempfile::tempdir().unwrap();
    let out = at(folder.path(), "rows.csv");
    let program = env!("CARGO_BIN_EXE_stickslip");
    // blocks of 512 bytes: 4 KiB of rows
    let limited = format!("ulimit -f 8; exec {program} sweep beam --vary f=0:1:0.001 --out {out}");
    let output = Command::new("sh").args(["-c", &limited]).output().unwrap();
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains("rows.csv") && error.to_lowercase().contains("large"), "{error}");
    // the rows that are whole are kept and the sweep goes on from them
    let (said, error, status) = run(&["sweep", "beam", "--vary", "f=0:1:0.001", "--out", &out, "--resume"], b"");
    assert_eq!(status, 0, "{error}");
    assert!(said.contains("were there already; complete"), "{said}");
    let save = format!("ulimit -f 1; exec {program} replay -");
    let mut child = Command::new("sh")
        .args(["-c", &save])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let file = at(folder.path(), "saved.json");
    child.stdin.take().unwrap().write_all(format!("save {file}").as_bytes()).unwrap();
    let mut error = String::new();
    child.stderr.take().unwrap().read_to_string(&mut error).unwrap();
    assert_eq!(end(&mut child), 2, "{error}");
    assert!(error.contains("cannot write") && !Path::new(&file).exists(), "{error}");
}

/// Memory that does not suffice is a message and a status, wherever it ends.
#[test]
#[cfg(target_os = "linux")]
fn tight_memory_ends_in_a_message() {
    let folder = tempfile::tempdir().unwrap();
    let plates = stickslip::model::embedded::text("plates-free").unwrap();
    let fine = at(folder.path(), "fine.json");
    fs::write(&fine, plates.replace("[16, 8]", "[480, 240]")).unwrap();
    let bars = at(folder.path(), "bars.json");
    let text = r#"{ "format": "stickslip/1", "title": "t", "nodes": { "A": [0, 0], "B": [2, 0] },
        "materials": { "s": { "E": 1, "nu": 0 } }, "sections": { "b": { "area": 1, "inertia": 1 } },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "s", "section": "b", "divisions": 4000000 }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "r"] }] }"#;
    fs::write(&bars, text).unwrap();
    let program = env!("CARGO_BIN_EXE_stickslip");
    for (kilobytes, file, estimated) in
        [(56_000, "beam", false), (250_000, &*fine, true), (250_000, &bars, true), (600_000, &bars, true)]
    {
        let limited = format!("ulimit -v {kilobytes}; exec {program} solve {file}");
        let output = Command::new("sh").args(["-c", &limited]).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        // an exit, not a signal
        let status = output.status.code().unwrap_or_else(|| panic!("{file} {kilobytes}: {:?} {error}", output.status));
        assert!([2, 4].contains(&status) && error.contains("memory"), "{file} {kilobytes}: {status} {error}");
        assert_eq!(error.contains("ulimit -v"), estimated, "{file} {kilobytes}: {error}");
    }
}
