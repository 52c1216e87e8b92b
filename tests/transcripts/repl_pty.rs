//! The REPL on a pseudo-terminal: what a person sees and types.
#![cfg(unix)]

use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};

/// Longest wait for anything: only a failure takes so long.
const PATIENCE: Duration = Duration::from_secs(30);

/// What the prompt looks like once colours are taken in by the screen.
const PROMPT: &str = "› ";

/// The REPL in `folder`, its state kept there too.
pub fn command(folder: &Path, term: &str, arguments: &[&str]) -> CommandBuilder {
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(arguments);
    command.cwd(folder);
    command.env("XDG_STATE_HOME", folder.join("state"));
    command.env("HOME", folder);
    command.env("TERM", term);
    command.env_remove("NO_COLOR");
    command
}

/// A program on a terminal of its own.
pub struct Terminal {
    child: Box<dyn Child + Send + Sync>,
    master: Option<Box<dyn MasterPty + Send>>,
    writer: Option<Box<dyn Write + Send>>,
    seen: Arc<Mutex<(vt100::Parser, Vec<u8>)>>,
}

impl Terminal {
    /// Starts the REPL in `folder`, its state kept there too.
    fn start(folder: &Path, term: &str, arguments: &[&str]) -> Terminal {
        Terminal::spawn(command(folder, term, arguments))
    }

    pub fn spawn(command: CommandBuilder) -> Terminal {
        let pair =
            native_pty_system().openpty(PtySize { rows: 24, cols: 80, pixel_width: 0, pixel_height: 0 }).unwrap();
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let mut reader = pair.master.try_clone_reader().unwrap();
        let writer = pair.master.take_writer().unwrap();
        let seen = Arc::new(Mutex::new((vt100::Parser::new(cells(24), cells(80), 1000), Vec::new())));
        let theirs = Arc::clone(&seen);
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut bytes) {
                let mut seen = theirs.lock().unwrap();
                seen.0.process(&bytes[..count]);
                seen.1.extend_from_slice(&bytes[..count]);
            }
        });
        Terminal { child, master: Some(pair.master), writer: Some(writer), seen }
    }

    fn screen(&self) -> String {
        self.seen.lock().unwrap().0.screen().contents()
    }

    fn bytes(&self) -> Vec<u8> {
        self.seen.lock().unwrap().1.clone()
    }

    pub fn send(&mut self, text: &str) {
        let writer = self.writer.as_mut().unwrap();
        writer.write_all(text.as_bytes()).unwrap();
        writer.flush().unwrap();
    }

    /// Types a line with the pauses of a hand.
    fn type_by_hand(&mut self, line: &str) {
        self.send(line);
        std::thread::sleep(Duration::from_millis(50));
        self.send("\r");
    }

    /// Waits until the screen is as wanted.
    pub fn wait(&self, what: &str, wanted: impl Fn(&str) -> bool) -> String {
        let start = Instant::now();
        loop {
            let screen = self.screen();
            if wanted(&screen) {
                return screen;
            }
            assert!(start.elapsed() < PATIENCE, "waiting for {what}:\n{screen}");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits for an empty prompt in the last line that is written on.
    pub fn prompt(&self) -> String {
        self.wait("the prompt", |screen| {
            screen.trim_end_matches('\n').lines().next_back().is_some_and(|line| line.trim_end() == PROMPT.trim_end())
        })
    }

    /// Types a line and waits for its answer and the next prompt.
    pub fn ask(&mut self, text: &str, answer: &str) -> String {
        self.send(&format!("{text}\r"));
        self.wait(answer, |screen| {
            let mut behind = screen.rsplit_once(&format!("{PROMPT}{text}")).map_or("", |(_, behind)| behind);
            behind = behind.trim_end();
            behind.contains(answer)
                && behind.lines().next_back().is_some_and(|line| line.trim_end() == PROMPT.trim_end())
        })
    }

    /// Waits for the end; its exit status.
    pub fn end(mut self) -> u32 {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.exit_code();
            }
            assert!(start.elapsed() < PATIENCE, "it does not end:\n{}", self.screen());
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn signal(&self, signal: &str) {
        let id = self.child.process_id().unwrap().to_string();
        let sent = std::process::Command::new("kill").args([signal, &id]).status().unwrap();
        assert!(sent.success());
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn cells(count: u16) -> NonZeroU16 {
    NonZeroU16::new(count).unwrap()
}

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
fn the_history_comes_back_in_the_next_run_and_can_be_searched() {
    let folder = folder();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    terminal.ask("set F2 123", "normal");
    terminal.ask("status", "LCP of 18");
    // written as it was typed, not at the end
    terminal.signal("-KILL");
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
    terminal.seen.lock().unwrap().0.screen_mut().set_size(cells(24), cells(40));
    terminal.master.as_ref().unwrap().resize(PtySize { rows: 24, cols: 40, pixel_width: 0, pixel_height: 0 }).unwrap();
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
    let bytes = Arc::clone(&terminal.seen);
    assert_eq!(terminal.end(), 0);
    assert!(!bytes.lock().unwrap().1.contains(&0x1b));
}

#[test]
fn killed_sessions_are_restored() {
    for end in ["-KILL", "-HUP", "-TERM"] {
        let folder = folder();
        let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        terminal.prompt();
        terminal.ask("set F2 123", "normal");
        terminal.ask("set f 0.4", "normal");
        terminal.signal(end);
        let bytes = Arc::clone(&terminal.seen);
        let status = terminal.end();
        match end {
            "-HUP" => assert_eq!(status, 129),
            "-TERM" => assert_eq!(status, 143),
            _ => {}
        }
        if end != "-KILL" {
            // bracketed paste is turned off again; the last bytes may come after the end of the program
            let is_off = || {
                let bytes = bytes.lock().unwrap();
                let text = String::from_utf8_lossy(&bytes.1);
                text.rfind("\u{1b}[?2004l") > text.rfind("\u{1b}[?2004h")
            };
            let deadline = std::time::Instant::now() + Duration::from_secs(10);
            while !is_off() {
                assert!(std::time::Instant::now() < deadline, "{end}");
                std::thread::sleep(Duration::from_millis(20));
            }
        }
        let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        terminal.wait("the offer", |screen| screen.contains("brings back its 2 changes"));
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
fn a_line_that_drops_loses_nothing() {
    let folder = folder();
    let size = PtySize { rows: 24, cols: 80, pixel_width: 0, pixel_height: 0 };
    let pair = native_pty_system().openpty(size).unwrap();
    let mut child = pair.slave.spawn_command(command(folder.path(), "xterm-256color", &[])).unwrap();
    drop(pair.slave);
    let mut reader = pair.master.try_clone_reader().unwrap();
    let mut writer = pair.master.take_writer().unwrap();
    let mut seen = Vec::new();
    let mut read_until = |wanted: &str| {
        let mut bytes = [0; 4096];
        while !String::from_utf8_lossy(&seen).contains(wanted) {
            let count = reader.read(&mut bytes).unwrap();
            seen.extend_from_slice(&bytes[..count]);
        }
    };
    read_until("›");
    writer.write_all(b"set F2 123\r").unwrap();
    read_until("(was 0.005)");
    // the other end of the terminal goes away, with all that holds it
    drop(reader);
    drop(writer);
    drop(pair.master);
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(start.elapsed() < PATIENCE, "it does not end");
        std::thread::sleep(Duration::from_millis(10));
    }
    let terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.wait("the offer", |screen| screen.contains("brings back its 1 change"));
}

/// A scenario of the test, with this much friction.
fn block(folder: &Path, title: &str, friction: &str) {
    let text = format!(
        r#"{{ "format": "stickslip/1", "title": "{title}",
          "parameters": {{ "f": {friction}, "H": 0.1 }},
          "materials": {{ "m": {{ "E": 1000, "nu": 0.2 }} }},
          "plates": [{{ "id": "b", "origin": [0, 0], "size": [1, 1], "divisions": [1, 1], "thickness": 1, "material": "m", "plane": "stress" }}],
          "contacts": [{{ "id": "base", "edge": "b.bottom", "against": "ground", "friction": "f" }}],
          "loads": {{ "weight": {{ "items": [{{ "point": {{ "at": "b.top", "force": [0, -1] }} }}] }},
                     "push": {{ "factor": "H", "items": [{{ "point": {{ "at": "b.top", "force": [1, 0] }} }}] }} }} }}"#
    );
    std::fs::write(folder.join("b.json"), text).unwrap();
}

#[test]
fn a_watched_file_is_solved_when_it_is_saved_and_the_line_stays() {
    let folder = folder();
    block(folder.path(), "one", "0.5");
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &["b.json"]);
    terminal.prompt();
    terminal.ask("set H 0.2", "trivial");
    terminal.ask("watch on", "is watched");
    // half a line is typed, the cursor goes back into it
    terminal.send("show x_t base[1]\x1b[D\x1b[D\x1b[D");
    terminal.wait("the line", |screen| screen.contains("show x_t base[1]"));
    block(folder.path(), "two", "0.6");
    let told = |screen: &str| {
        let below = screen.rsplit_once("b.json read again").map_or("", |(_, below)| below);
        below.contains("kept: H = 0.2") && below.trim_end().ends_with("show x_t base[1]")
    };
    let screen = terminal.wait("the news and the line under them", told);
    assert_eq!(screen.matches("show x_t base[1]").count(), 1, "{screen}");
    // the cursor is where it was
    terminal.send("0");
    terminal.wait("the cursor", |screen| screen.contains("show x_t base0[1]"));
    terminal.send("\x03");
    // a file with an error: the place is told, the session stays as it was
    std::fs::write(folder.path().join("b.json"), "{ \"format\": \"stickslip/1\",\n  \"title\": }").unwrap();
    terminal.wait("the place", |screen| screen.contains("b.json:2:"));
    terminal.ask("params", "0.6");
    // an editor that writes beside the file and renames; what was set does not fit any more
    block(folder.path(), "three", "0.7");
    terminal.wait("right again", |screen| screen.matches("b.json read again").count() == 2);
    // one that is taken away is told once, and read when it comes back, also as it was
    std::fs::rename(folder.path().join("b.json"), folder.path().join("away.json")).unwrap();
    terminal.wait("that it is gone", |screen| screen.contains("b.json is gone: the last answer stays"));
    terminal.ask("params", "0.7");
    std::fs::rename(folder.path().join("away.json"), folder.path().join("b.json")).unwrap();
    terminal.wait("that it is back", |screen| screen.contains("b.json is as it was"));
    // an editor that cuts the file and writes it a moment later: one answer, no error
    std::fs::write(folder.path().join("b.json"), "").unwrap();
    std::thread::sleep(Duration::from_millis(200));
    block(folder.path(), "four", "0.8");
    terminal.wait("the one answer", |screen| screen.matches("b.json read again").count() == 3);
    let screen = terminal.ask("watch off", "no file is watched");
    assert_eq!(screen.matches("the file is empty").count(), 0, "{screen}");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn edit_opens_the_editor_of_the_user_and_reads_again() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    block(folder.path(), "one", "0.5");
    let editor = folder.path().join("my editor");
    // an editor with an option: it changes the friction, after the user pressed a key and Ctrl-C
    std::fs::write(&editor, "#!/bin/sh\ntrap '' INT\necho EDITING $1\nread key\nsed -i s/0.5/0.625/ \"$2\"\n").unwrap();
    std::fs::set_permissions(&editor, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = command(folder.path(), "xterm-256color", &["beam"]);
    command.env("VISUAL", format!("'{}' --wait", editor.display()));
    let mut terminal = Terminal::spawn(command);
    terminal.prompt();
    terminal.ask("edit", "`save beam.json` gives it one");
    terminal.ask("load b.json", "trivial");
    terminal.send("edit\r");
    terminal.wait("the editor", |screen| screen.contains("EDITING --wait"));
    terminal.send("\x03x\r");
    terminal.wait("the news", |screen| screen.contains("b.json read again"));
    terminal.ask("params", "0.625");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
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
    let bytes = terminal.bytes();
    let text = String::from_utf8_lossy(&bytes);
    // codes that move the cursor or set a mode are there, colours (they end in m) are not
    let coloured = text
        .split("\u{1b}[")
        .skip(1)
        .any(|code| code.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').starts_with('m'));
    assert!(!coloured, "{text:?}");
    assert!(text.is_ascii());
}
