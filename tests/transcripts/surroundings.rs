//! The first minutes: no terminal, no HOME, nowhere to write, an old locale; and `doctor`, which tells of it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// The program with nothing in its environment but what is `set`.
fn program(set: &[(&str, &str)], arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stickslip"));
    command.env_clear().envs(set.iter().copied()).args(arguments).stdin(Stdio::null());
    command
}

fn output(set: &[(&str, &str)], arguments: &[&str]) -> (String, String, i32) {
    told(program(set, arguments).output().unwrap())
}

fn told(output: Output) -> (String, String, i32) {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (text(output.stdout), text(output.stderr), output.status.code().unwrap_or(-1))
}

fn doctor(set: &[(&str, &str)]) -> Value {
    let (out, error, status) = output(set, &["doctor", "--format", "json"]);
    assert_eq!((status, error.as_str()), (0, ""), "{out}");
    serde_json::from_str(&out).unwrap()
}

#[test]
fn an_empty_environment_is_enough() {
    let (out, error, status) = output(&[], &["solve", "beam"]);
    assert!(out.contains("normal") && error.is_empty() && status == 0, "{out}{error}");
    // no terminal and no commands: not nothing
    let (out, error, status) = output(&[], &[]);
    assert!(out.is_empty() && error.contains("no terminal") && error.contains("solve") && status == 0, "{out}{error}");
    let (_, error, status) = output(&[], &["tui"]);
    assert!(error.contains("needs a terminal") && status == 2, "{error}");
}

/// Everything that is written but JSON and files of others is ASCII where the locale knows nothing else.
#[test]
fn an_old_locale_gets_ascii() {
    let subcommands = ["solve", "sweep", "check", "serve", "doctor", "new", "man", "merge", "replay", "import"];
    let help = subcommands.iter().map(|name| vec![*name, "--help"]);
    let others = [
        vec!["--help"],
        vec!["solve", "beam"],
        vec!["solve", "beam-ray"],
        vec!["solve", "nowhere"],
        vec!["solve", "beam", "--covering", "none"],
        vec!["sweep", "beam", "--vary", "f=0:0.2:0.1"],
        vec!["check", "beam"],
        vec!["doctor"],
        vec!["pairs"],
        vec!["help", "pairs"],
        vec!["scenarios"],
        vec!["new"],
        vec![],
    ];
    for locale in [("LANG", "C"), ("LC_ALL", "POSIX"), ("LC_CTYPE", "de_DE")] {
        for arguments in help.clone().chain(others.clone()) {
            let (out, error, _) = output(&[locale], &arguments);
            assert!(out.is_ascii() && error.is_ascii(), "{arguments:?}: {out}{error}");
            assert!(!out.contains('?') && !error.contains('?'), "{arguments:?}: {out}{error}");
        }
    }
    // and where it knows more, help says 60° and not 60 of something
    assert!(output(&[("LANG", "C.UTF-8")], &["check", "--help"]).0.contains("60°"));
}

#[test]
fn doctor_says_what_it_finds_and_writes_nothing() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().to_str().unwrap();
    let report = doctor(&[("HOME", path), ("TERM", "xterm")]);
    assert_eq!(report["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(report["state"]["path"], format!("{path}/.local/state/stickslip"));
    assert_eq!(report["state"]["writable"], true);
    assert_eq!(report["configuration"]["path"], format!("{path}/.config/stickslip/config.json"));
    assert_eq!(report["configuration"]["exists"], false);
    assert_eq!(report["terminal"]["cursor_codes"], true);
    // stdin is not a terminal
    assert_eq!(report["terminal"]["full_screen"], false);
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
    let cores = std::thread::available_parallelism().unwrap().get();
    assert_eq!(report["threads"], cores);
    assert_eq!(doctor(&[("RAYON_NUM_THREADS", "3")])["threads"], 3);
    let bare = doctor(&[("LC_ALL", "C")]);
    assert_eq!(bare["state"]["path"], Value::Null);
    assert_eq!(bare["terminal"]["unicode"], false);
    assert_eq!(bare["terminal"]["cursor_codes"], false);
    let (text, ..) = output(&[("LC_ALL", "C")], &["doctor"]);
    for said in ["LC_ALL=C is not UTF-8", "neither XDG_STATE_HOME nor HOME", "a crash loses"] {
        assert!(text.split_whitespace().collect::<Vec<_>>().join(" ").contains(said), "{said}: {text}");
    }
}

/// A folder where even root cannot make a file.
#[test]
#[cfg(target_os = "linux")]
fn nowhere_to_write() {
    let state = &doctor(&[("HOME", "/proc/nobody")])["state"];
    assert_eq!(state["writable"], false);
    assert!(state["trouble"].as_str().unwrap().contains("/proc"), "{state}");
    let at = |folder: &Path, arguments: &[&str]| {
        told(program(&[("HOME", "/proc/nobody")], arguments).current_dir(folder).output().unwrap())
    };
    let proc = Path::new("/proc/self");
    let (out, error, status) = at(proc, &["solve", "beam"]);
    assert!(status == 0 && error.is_empty(), "{out}{error}");
    for arguments in [&["new", "wall"][..], &["sweep", "beam", "--vary", "f=0:1:0.5", "--out", "rows.csv"]] {
        let (_, error, status) = at(proc, arguments);
        assert!(status == 2 && error.starts_with("error: ") && error.lines().count() == 1, "{error}");
    }
    // a working directory that is gone
    let folder = tempfile::tempdir().unwrap();
    let gone = folder.path().join("gone");
    fs::create_dir(&gone).unwrap();
    let script = format!("rmdir {} && exec \"$0\" \"$@\"", gone.display());
    let run = |arguments: &[&str]| {
        fs::create_dir_all(&gone).unwrap();
        let mut shell = Command::new("sh");
        shell.args(["-c", &script, env!("CARGO_BIN_EXE_stickslip")]).args(arguments).current_dir(&gone);
        told(shell.stdin(Stdio::null()).output().unwrap())
    };
    let (out, error, status) = run(&["solve", "beam"]);
    assert!(status == 0 && out.contains("normal"), "{error}");
    let (out, ..) = run(&["doctor", "--format", "json"]);
    let report: Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&report["work"]["path"], &report["work"]["writable"]), (&Value::Null, &Value::Bool(false)), "{out}");
}

/// At a terminal: what cannot be kept is said before anything is typed.
#[test]
#[cfg(unix)]
fn a_session_that_leaves_no_trace_says_so() {
    use crate::pty::{Terminal, command};
    let folder = tempfile::tempdir().unwrap();
    let start = |changes: &[(&str, Option<&str>)]| {
        let mut command = command(folder.path(), "xterm", &[]);
        for (name, value) in changes {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            }
        }
        Terminal::spawn(command, 80, 24)
    };
    let mut bare = start(&[("HOME", None), ("XDG_STATE_HOME", None)]);
    let greeting = bare.prompt();
    assert!(greeting.contains("a crash would lose all changes") && greeting.contains("HOME"), "{greeting}");
    bare.ask("set f 0.4", "ray");
    bare.send("quit\r");
    assert_eq!(bare.end(), 0);
    let mut old = start(&[("LC_ALL", Some("POSIX"))]);
    let greeting = old.wait("the prompt", |screen| screen.trim_end().ends_with("\n>"));
    assert!(greeting.is_ascii() && !greeting.contains("a crash"), "{greeting}");
    old.send("quit\r");
    assert_eq!(old.end(), 0);
}

/// The manual is as complete as the grammar, and every shell gets its completions.
#[test]
fn manual_and_completions() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man1");
    let (_, error, status) = output(&[], &["man", pages.to_str().unwrap()]);
    assert_eq!(status, 0, "{error}");
    let (help, ..) = output(&[], &["--help"]);
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| line.starts_with("  "))
        // what is further in goes on from the line before
        .filter(|line| !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.len() > 10, "{commands:?}");
    for name in &commands {
        let page = fs::read_to_string(pages.join(format!("stickslip-{name}.1"))).unwrap();
        assert!(page.contains(".SH NAME") && page.contains(&format!("stickslip\\-{name}")), "{name}: {page}");
    }
    // one for each command, and stickslip.1
    assert_eq!(fs::read_dir(&pages).unwrap().count(), commands.len() + 1);
    assert!(output(&[], &["man"]).0.contains(".SH SUBCOMMANDS"));
    let (_, error, status) = output(&[], &["man", "/proc/nobody"]);
    assert!(status == 2 && error.contains("/proc/nobody"), "{error}");
    for shell in ["bash", "elvish", "fish", "nushell", "powershell", "zsh"] {
        let (script, _, status) = output(&[], &["completions", shell]);
        assert!(status == 0 && commands.iter().all(|name| script.contains(name)), "{shell}");
    }
    assert_eq!(output(&[], &["completions", "tcsh"]).2, 2);
}
