//! The REPL on a pseudo-terminal: what a person sees and types.
#![cfg(unix)]

use std::path::Path;
use std::time::{Duration, Instant};

use super::pty::{PATIENCE, Terminal};

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn tab_completes_and_hints_are_shown() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.send("stat");
    terminal.wait("the hint", |screen| screen.contains("› status"));
    terminal.send("\t\r");
    terminal.wait("the answer", |screen| screen.contains("LCP of 18"));
    terminal.prompt();
    // the candidates, each with what it is
    terminal.send("set F\t\t");
    terminal.wait("the parameters", |screen| screen.contains("F2") && screen.contains("250"));
    terminal.send("2 1\u{15}");
    terminal.send("why c\t\t");
    terminal.wait("the pairs", |screen| screen.contains("c1") && screen.contains("c5"));
    terminal.send("6\r");
    terminal.wait("the answer", |screen| screen.contains("c6 slip+"));
    terminal.prompt();
    terminal.send("load klar\t\r");
    terminal.wait("the scenario", |screen| screen.contains("One contact pair"));
    terminal.prompt();
    terminal.send("\u{4}");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn what_is_odd_in_a_file_is_said_before_the_first_prompt() {
    let folder = folder();
    let pad =
        |id: &str| format!(r#"{{"id": "{id}", "node": "n", "against": "ground", "normal": [0, 1], "friction": 0.3}}"#);
    let text = format!(
        r#"{{"format": "stickslip/1", "title": "pad", "nodes": {{"n": [0, 0]}},
            "springs": [{{"at": "n", "direction": [1, 0], "stiffness": 10}}], "contacts": [{}, {}],
            "loads": {{"w": {{"items": [{{"point": {{"at": "n", "force": [1, -10]}}}}]}}}}}}"#,
        pad("pad"),
        pad("shoe")
    );
    std::fs::write(folder.path().join("pad.json"), text).unwrap();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &["pad.json"]);
    terminal.wait("the warning", |screen| screen.contains("warning: contacts[1]: `shoe` has the nodes"));
    terminal.prompt();
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_terminal_that_says_no_size_has_eighty_columns() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.forget_size();
    terminal.send("status\r");
    // the widest line of the status
    let screen = terminal.wait("the answer", |screen| screen.contains("LCP of 18"));
    let widest = screen.lines().map(|line| line.chars().count()).max();
    assert!(widest.is_some_and(|widest| (61..=80).contains(&widest)), "{screen}");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

/// Lines that a program types come at once; a pause before one says that the answer above it has been seen.
#[test]
fn a_failed_load_locks_what_comes_with_it_and_not_what_is_typed_later() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.send("load nosuch\rstatus\r");
    terminal.wait("the refusal", |screen| screen.contains("not done: the `load` before it failed"));
    terminal.prompt();
    std::thread::sleep(Duration::from_millis(400));
    terminal.send("status\r");
    terminal.wait("the answer", |screen| screen.contains("LCP of 18"));
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn the_history_comes_back_in_the_next_run_and_can_be_searched() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.ask("set F2 123", "normal");
    terminal.ask("status", "LCP of 18");
    // written as it was typed, not at the end
    terminal.signal("KILL");
    terminal.end();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.send("\u{1b}[A");
    terminal.wait("the last line", |screen| screen.trim_end().ends_with("› status"));
    terminal.send("\u{1b}[A");
    terminal.wait("the line before", |screen| screen.trim_end().ends_with("› set F2 123"));
    terminal.send("\u{15}\u{12}F2");
    terminal.wait("the search", |screen| screen.contains("reverse-i-search") && screen.contains("set F2 123"));
    terminal.send("\r");
    terminal.wait("its answer", |screen| screen.contains("(was "));
    terminal.prompt();
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn pasted_and_typed_ahead_lines_all_arrive() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.send("\u{1b}[200~set F2 110\nset F2 120\necho pasted\u{1b}[201~\r");
    terminal.wait("the pasted lines", |screen| screen.contains("\npasted"));
    // each answer stands under its command
    let screen = terminal.wait("the commands", |screen| screen.contains("› echo pasted\n"));
    for command in ["› set F2 110\nnormal", "› set F2 120\nnormal", "› echo pasted\npasted"] {
        assert!(screen.contains(command), "{command} is missing in\n{screen}");
    }
    terminal.prompt();
    // faster than they are answered, and with a long table among them that would be paged
    let lines: String = (1..=20).map(|k| format!("set F2 {k}\r")).collect();
    terminal.send(&format!("help plot\r{lines}echo typed\r"));
    terminal.wait("the last of them", |screen| screen.contains("\ntyped"));
    terminal.prompt();
    terminal.ask("diff", "20 kN (file: 250)");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn long_results_are_paged_and_keys_answer() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &["murty6"]);
    terminal.prompt();
    terminal.type_by_hand("pivots");
    let first = terminal.wait("the question", |screen| screen.contains("more: space page"));
    terminal.send(" ");
    let second = terminal.wait("the next page", |screen| screen.contains("more: space page") && screen != first);
    assert_ne!(first, second);
    terminal.send("q");
    terminal.prompt();
    terminal.type_by_hand("help");
    terminal.wait("the question", |screen| screen.contains("more: space page"));
    terminal.send("a");
    terminal.wait("the end", |screen| screen.contains("more: of a command with an example"));
    terminal.prompt();
    // what is no answer to the question is the next command
    terminal.type_by_hand("help");
    terminal.wait("the question", |screen| screen.contains("more: space page"));
    terminal.send("status\r");
    terminal.wait("the answer", |screen| screen.contains("LCP of 6"));
    terminal.prompt();
    terminal.send("\u{4}");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn control_c_drops_the_line() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.send("set F2 9");
    terminal.wait("the line", |screen| screen.contains("set F2 9"));
    terminal.send("\u{3}");
    terminal.prompt();
    terminal.ask("diff", "nothing differs");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

/// Two plates so fine that their factorization takes a while.
fn large(folder: &Path) -> String {
    let text = stickslip::model::embedded::text("plates-free").unwrap();
    let fine = text.replace("[16, 8]", "[480, 240]").replace("[16,8]", "[480,240]");
    assert_ne!(fine, text, "the scenario is written differently");
    let file = folder.join("fine.json");
    std::fs::write(&file, fine).unwrap();
    "fine.json".to_owned()
}

#[test]
fn control_c_stops_a_computation_and_leaves_the_session_as_it_was() {
    let folder = folder();
    let file = large(folder.path());
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.ask("set F2 123", "normal");
    terminal.send(&format!("load {file}\r"));
    // progress appears after a second: then it is surely computing
    terminal.wait("the progress", |screen| screen.contains("Ctrl-C stops"));
    let start = Instant::now();
    terminal.send("\u{3}");
    terminal.wait("the message", |screen| screen.contains("interrupted"));
    let elapsed = start.elapsed();
    terminal.prompt();
    assert!(elapsed < Duration::from_millis(200), "{elapsed:?}");
    terminal.ask("diff", "123");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn the_width_follows_the_window() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.ask("pairs c1", "50.000");
    terminal.resize(40, 24);
    std::thread::sleep(Duration::from_millis(100));
    // at 80 columns the line goes on
    terminal.ask("load gap", "stop at\ndistance g below");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_dumb_terminal_gets_no_codes() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "dumb", &[]);
    terminal.wait("the prompt", |screen| screen.trim_end().ends_with('>'));
    terminal.send("set F2 150\n");
    terminal.wait("the answer", |screen| screen.contains("was 0.005"));
    terminal.send("bogus\n");
    terminal.wait("the error", |screen| screen.contains("unknown command"));
    terminal.send("set F2 9\u{3}");
    terminal.send("diff\n");
    terminal.wait("the session as it was", |screen| screen.contains("150 kN (file: 250)"));
    terminal.send("quit\n");
    assert_eq!(terminal.end(), 0);
    assert!(!terminal.seen.lock().unwrap().raw.contains(&0x1b));
}

#[test]
fn killed_sessions_are_restored() {
    for end in ["KILL", "HUP", "TERM"] {
        let folder = folder();
        let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        terminal.prompt();
        terminal.ask("set F2 123", "normal");
        terminal.ask("set f 0.4", "normal");
        terminal.signal(end);
        let status = terminal.end();
        match end {
            "HUP" => assert_eq!(status, 129),
            "TERM" => assert_eq!(status, 143),
            _ => {}
        }
        if end != "KILL" {
            // bracketed paste is turned off again
            terminal.is_restored();
        }
        let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        terminal.wait("the offer", |screen| screen.contains("brings back its 2"));
        terminal.prompt();
        terminal.ask("restore", "2 changes restored");
        terminal.ask("diff", "123 kN");
        terminal.send("quit\r");
        assert_eq!(terminal.end(), 0);
        let terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        let screen = terminal.prompt();
        assert!(!screen.contains("restore"), "{screen}");
    }
}

#[test]
fn colours_can_be_turned_off() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &["--color", "never", "--ascii"]);
    terminal.wait("the prompt", |screen| screen.trim_end().ends_with('>'));
    terminal.send("pairs\r");
    terminal.wait("the answer", |screen| screen.contains("slip+"));
    terminal.send("quit\r");
    terminal.wait("the end", |screen| screen.contains("quit"));
    let seen = terminal.seen.lock().unwrap();
    let text = String::from_utf8_lossy(&seen.raw);
    // codes that move the cursor or set a mode are there, colours (they end in m) are not
    let coloured = text
        .split("\u{1b}[")
        .skip(1)
        .any(|code| code.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').starts_with('m'));
    assert!(!coloured, "{text:?}");
    assert!(text.is_ascii());
}

/// Run by the test below. With this process goes all that holds the other end of the terminal: within the tests another
/// thread that starts a program may hand on a copy of it.
#[test]
#[ignore = "helper of another test"]
fn a_terminal_that_goes_away() {
    let Some(folder) = std::env::var_os("STICKSLIP_TEST_FOLDER") else { return };
    let mut terminal = Terminal::start(Path::new(&folder), "xterm-256color", &[]);
    terminal.prompt();
    terminal.ask("set F2 123", "(was 0.005)");
    if std::env::var_os("STICKSLIP_TEST_PAGED").is_some() {
        terminal.type_by_hand("help");
        terminal.wait("the question", |screen| screen.contains("more: space page"));
    }
    std::process::exit(0);
}

#[test]
fn a_line_that_drops_loses_nothing() {
    session_is_left_over(false);
}

#[test]
fn a_line_that_drops_under_a_long_result_loses_nothing() {
    session_is_left_over(true);
}

/// A session whose terminal goes away, at its prompt or while it asks how to go on with a long result, ends and can be
/// brought back.
fn session_is_left_over(paged: bool) {
    let folder = folder();
    let helper = ["--exact", "repl_pty::a_terminal_that_goes_away", "--ignored", "--nocapture"];
    let mut command = std::process::Command::new(std::env::current_exe().unwrap());
    if paged {
        command.env("STICKSLIP_TEST_PAGED", "1");
    }
    let output = command.args(helper).env("STICKSLIP_TEST_FOLDER", folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // the program ends a moment later: until then its changes are its own
    let start = Instant::now();
    loop {
        let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        if terminal.prompt().contains("brings back its 1") {
            break;
        }
        terminal.send("quit\r");
        terminal.end();
        assert!(start.elapsed() < PATIENCE, "nothing is left of the session that was cut off");
    }
}
