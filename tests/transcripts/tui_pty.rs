//! The full screen in a pseudo-terminal: what a terminal sees of it, how many bytes it gets, and how it is left.

use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};

/// Longest wait for anything: the machine may be busy.
const PATIENCE: Duration = Duration::from_secs(30);

struct Seen {
    parser: vt100::Parser,
    bytes: usize,
    /// All of them.
    raw: Vec<u8>,
    /// Whether no code of 256 colours was seen.
    sixteen: bool,
}

struct Screen {
    master: Box<dyn MasterPty + Send>,
    child: Box<dyn Child + Send + Sync>,
    writer: Box<dyn Write + Send>,
    seen: Arc<Mutex<Seen>>,
    before: String,
    _home: tempfile::TempDir,
}

impl Screen {
    fn start(arguments: &[&str], width: u16, height: u16) -> Screen {
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_stickslip"));
        command.args(arguments);
        Screen::spawn(command, width, height)
    }

    fn spawn(mut command: CommandBuilder, width: u16, height: u16) -> Screen {
        let home = tempfile::tempdir().unwrap();
        let pair = native_pty_system()
            .openpty(PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 })
            .unwrap();
        for (name, folder) in [("XDG_STATE_HOME", "state"), ("XDG_CONFIG_HOME", "config")] {
            command.env(name, home.path().join(folder));
        }
        command.env("HOME", home.path());
        command.env("TERM", "xterm-256color");
        command.env_remove("NO_COLOR");
        command.cwd(home.path());
        let before = termios(&*pair.master);
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let mut reader = pair.master.try_clone_reader().unwrap();
        let writer = pair.master.take_writer().unwrap();
        let seen = Arc::new(Mutex::new(Seen {
            parser: vt100::Parser::new(size(height), size(width), 0),
            bytes: 0,
            raw: Vec::new(),
            sixteen: true,
        }));
        let theirs = Arc::clone(&seen);
        thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                let mut seen = theirs.lock().unwrap();
                seen.parser.process(&buffer[..count]);
                seen.bytes += count;
                seen.raw.extend_from_slice(&buffer[..count]);
                seen.sixteen &= !buffer[..count].windows(4).any(|code| code == b"8;5;");
            }
        });
        Screen { master: pair.master, child, writer, seen, before, _home: home }
    }

    fn send(&mut self, keys: &str) {
        self.writer.write_all(keys.as_bytes()).unwrap();
        self.writer.flush().unwrap();
    }

    fn text(&self) -> String {
        self.seen.lock().unwrap().parser.screen().contents()
    }

    fn bytes(&self) -> usize {
        self.seen.lock().unwrap().bytes
    }

    fn until(&self, what: &str, holds: impl Fn(&vt100::Screen) -> bool) {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if holds(self.seen.lock().unwrap().parser.screen()) {
                return;
            }
            thread::sleep(Duration::from_millis(10));
        }
        panic!("waited in vain for {what}:\n{}", self.text());
    }

    fn wait(&self, part: &str) {
        self.until(part, |screen| screen.contents().contains(part));
    }

    fn wait_for_bytes(&self, part: &[u8]) {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if self.seen.lock().unwrap().raw.windows(part.len()).any(|window| window == part) {
                return;
            }
            thread::sleep(Duration::from_millis(10));
        }
        panic!("waited in vain for {}", part.escape_ascii());
    }

    /// Waits until nothing has come for a while; gives the number of bytes so far.
    fn settle(&self) -> usize {
        let mut last = (self.bytes(), Instant::now());
        let start = Instant::now();
        while last.1.elapsed() < Duration::from_millis(600) && start.elapsed() < PATIENCE {
            thread::sleep(Duration::from_millis(20));
            if self.bytes() != last.0 {
                last = (self.bytes(), Instant::now());
            }
        }
        self.bytes()
    }

    fn resize(&mut self, width: u16, height: u16) {
        self.seen.lock().unwrap().parser.screen_mut().set_size(size(height), size(width));
        self.master.resize(PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 }).unwrap();
    }

    fn signal(&self, name: &str) {
        let id = self.child.process_id().unwrap().to_string();
        let status = Command::new("kill").args(["-s", name, &id]).status();
        assert!(status.unwrap().success());
    }

    fn exit(&mut self) -> u32 {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.exit_code();
            }
            thread::sleep(Duration::from_millis(10));
        }
        panic!("it does not end:\n{}", self.text());
    }

    /// The terminal is as it was found.
    fn is_restored(&self) {
        self.until("the end of the alternate screen", |screen| {
            !screen.alternate_screen()
                && !screen.hide_cursor()
                && !screen.bracketed_paste()
                && screen.mouse_protocol_mode() == vt100::MouseProtocolMode::None
        });
        let start = Instant::now();
        while termios(&*self.master) != self.before && start.elapsed() < PATIENCE {
            thread::sleep(Duration::from_millis(10));
        }
        assert_eq!(termios(&*self.master), self.before);
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        let _ = self.child.kill();
    }
}

fn size(count: u16) -> NonZeroU16 {
    NonZeroU16::new(count).unwrap()
}

fn termios(master: &dyn MasterPty) -> String {
    format!("{:?}", master.get_termios())
}

#[test]
fn start_vary_step_ray_resize_quit() {
    let mut screen = Screen::start(&["tui", "beam"], 80, 24);
    screen.wait("normal · 5 pivots");
    assert!(screen.seen.lock().unwrap().parser.screen().alternate_screen());
    // sixteen colours, in their own codes
    assert!(screen.seen.lock().unwrap().sixteen);
    screen.send("\x1b[B\x1b[B[");
    screen.wait("F2 = 150 kN");
    screen.wait("pairs changed");
    screen.send("u");
    screen.wait("F2 = 250 kN");
    screen.send("\x1b[D\x1b[D");
    screen.wait("Pivot 2 (p enters at 0): pair c5 slips +");
    screen.send("\x1b[F");
    screen.wait("Pivot 4 (p enters at 0)");
    screen.send(":set F2 330\r");
    screen.wait("ray: mechanism");
    screen.wait("mode of the ray");
    screen.resize(140, 45);
    screen.wait("6 Answer");
    screen.wait("3 Pairs");
    screen.resize(40, 12);
    screen.wait("2 Parameters");
    screen.resize(30, 8);
    screen.wait("panes need 40 x 12");
    screen.resize(80, 24);
    screen.wait("ray: mechanism");
    screen.send("?");
    screen.wait("Keys");
    screen.send("\x1b");
    screen.until("the end of the help", |screen| !screen.contents().contains("Keys"));
    screen.send("q");
    assert_eq!(screen.exit(), 0);
    screen.is_restored();
}

#[test]
fn few_bytes_for_a_step_and_none_at_rest() {
    for (width, height) in [(80, 24), (140, 45)] {
        let mut screen = Screen::start(&["tui", "plates-free"], width, height);
        screen.wait("normal");
        let mut before = screen.settle();
        // right, a slider, a pivot back
        for (key, most) in [("+", 8000), ("+", 8000), ("\x1b[D", 8000), ("\t", 8000)] {
            screen.send(key);
            thread::sleep(Duration::from_millis(300));
            let after = screen.settle();
            let sent = after - before;
            println!("{width}x{height}: {key:?} {sent} bytes");
            assert!(sent > 0 && sent <= most, "{key:?}: {sent} bytes");
            before = after;
        }
        thread::sleep(Duration::from_secs(3));
        assert_eq!(screen.bytes(), before, "bytes at rest");
    }
}

#[test]
#[ignore = "takes a minute"]
fn a_minute_of_rest_sends_nothing() {
    let mut screen = Screen::start(&["tui", "beam"], 140, 45);
    screen.wait("normal");
    let before = screen.settle();
    thread::sleep(Duration::from_secs(60));
    assert_eq!(screen.bytes(), before);
    screen.send("q");
    assert_eq!(screen.exit(), 0);
}

#[test]
fn a_moving_mode_stays_cheap_and_can_be_stopped() {
    let mut screen = Screen::start(&["tui", "beam-ray"], 80, 24);
    screen.wait("ray: mechanism");
    screen.settle();
    screen.send("m");
    screen.wait("moving");
    let before = screen.bytes();
    thread::sleep(Duration::from_secs(2));
    let sent = screen.bytes() - before;
    assert!(sent > 0 && sent < 40_000, "{sent} bytes in two seconds");
    screen.send("m");
    let before = screen.settle();
    thread::sleep(Duration::from_secs(1));
    assert_eq!(screen.bytes(), before);
}

#[test]
fn signals_leave_the_terminal_as_it_was() {
    for (signal, status) in [("TERM", 143), ("INT", 130), ("QUIT", 131), ("HUP", 129)] {
        let mut screen = Screen::start(&["tui", "beam"], 80, 24);
        screen.wait("normal");
        screen.signal(signal);
        assert_eq!(screen.exit(), status, "{signal}");
        screen.is_restored();
    }
}

#[test]
fn ctrl_z_gives_the_terminal_back_and_fg_takes_it_again() {
    let mut screen = Screen::start(&["tui", "beam"], 80, 24);
    screen.wait("normal");
    for by_key in [true, false] {
        if by_key {
            screen.send("\x1a");
        } else {
            screen.signal("TSTP");
        }
        screen.is_restored();
        let id = screen.child.process_id().unwrap();
        let stat = format!("/proc/{id}/stat");
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            // the state stands behind the name of the program
            let text = std::fs::read_to_string(&stat).unwrap_or_default();
            if text.contains(") T ") || text.is_empty() {
                break;
            }
            thread::sleep(Duration::from_millis(10));
        }
        screen.signal("CONT");
        screen.until("the panes", |screen| screen.alternate_screen() && screen.contents().contains("2 Parameters"));
    }
    screen.send("+");
    screen.wait("f = 0.55");
    screen.send("q");
    assert_eq!(screen.exit(), 0);
    screen.is_restored();
}

#[test]
fn to_the_command_line_and_back_with_one_session() {
    let mut screen = Screen::start(&["beam"], 80, 24);
    screen.wait("lists the commands");
    screen.send("set F2 100\r");
    screen.wait("normal · 2 pivots");
    screen.send("tui\r");
    screen.wait("F2    100");
    screen.send("+");
    screen.wait("f = 0.55");
    screen.send("q");
    screen.until("the prompt", |screen| !screen.alternate_screen());
    screen.send("params\r");
    screen.wait("0.55");
    screen.send("undo\r");
    screen.wait("undone: set f 0.55");
    screen.send("tour\r");
    screen.wait("Tour 1 of 6");
    screen.send("\r\r\r\r\r");
    screen.wait("Tour 6 of 6");
    screen.wait("ray: mechanism");
    screen.send("Q");
    assert_eq!(screen.exit(), 0);
    screen.is_restored();
}

/// A scenario of the test, with this much friction, put into its place as an editor does that renames.
fn block(folder: &std::path::Path, friction: &str) {
    let text = format!(
        r#"{{ "format": "stickslip/1", "title": "a block", "parameters": {{ "f": {friction}, "H": 0.1 }},
          "materials": {{ "m": {{ "E": 1000, "nu": 0.2 }} }},
          "plates": [{{ "id": "b", "origin": [0, 0], "size": [1, 1], "divisions": [1, 1], "thickness": 1, "material": "m", "plane": "stress" }}],
          "contacts": [{{ "id": "base", "edge": "b.bottom", "against": "ground", "friction": "f" }}],
          "loads": {{ "weight": {{ "items": [{{ "point": {{ "at": "b.top", "force": [0, -1] }} }}] }},
                     "push": {{ "factor": "H", "items": [{{ "point": {{ "at": "b.top", "force": [1, 0] }} }}] }} }} }}"#
    );
    std::fs::write(folder.join("new"), text).unwrap();
    std::fs::rename(folder.join("new"), folder.join("b.json")).unwrap();
}

#[test]
fn a_watched_file_is_shown_when_it_is_saved_and_its_errors_over_the_last_picture() {
    let folder = tempfile::tempdir().unwrap();
    block(folder.path(), "0.5");
    let path = folder.path().join("b.json").display().to_string();
    let mut screen = Screen::start(&["tui", &path], 100, 30);
    screen.wait("a block");
    screen.send(":watch on\r");
    screen.wait("is watched");
    block(folder.path(), "0.625");
    screen.wait("0.625");
    std::fs::write(&path, "{ \"format\": \"stickslip/1\",\n  \"title\": }").unwrap();
    screen.wait("b.json:2:");
    let text = screen.text();
    assert!(text.contains("0.625") && text.contains("2 Parameters"), "the panes stay:\n{text}");
    // it swallows no key: the friction goes up, the error stays
    screen.send("+");
    screen.until("a key", |screen| screen.contents().contains("0.645") && screen.contents().contains("b.json:2:"));
    block(folder.path(), "0.25");
    screen.until("right again", |screen| !screen.contents().contains("b.json:2:"));
    screen.settle();
    let before = screen.bytes();
    thread::sleep(Duration::from_secs(2));
    assert_eq!(screen.bytes(), before, "nothing is sent while nothing is saved");
    screen.send("q");
    assert_eq!(screen.exit(), 0);
}

#[test]
fn edit_lends_the_terminal_to_the_editor() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    block(folder.path(), "0.5");
    let editor = folder.path().join("editor");
    std::fs::write(&editor, "#!/bin/sh\necho EDITING\nread key\nsed -i s/0.5/0.625/ \"$1\"\n").unwrap();
    std::fs::set_permissions(&editor, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(["tui", &folder.path().join("b.json").display().to_string()]);
    command.env("VISUAL", editor.display().to_string());
    let mut screen = Screen::spawn(command, 100, 30);
    screen.wait("a block");
    screen.send(":edit\r");
    screen.until("the editor", |screen| !screen.alternate_screen() && screen.contents().contains("EDITING"));
    screen.is_restored();
    screen.send("x\r");
    screen.until("the panes", |screen| screen.alternate_screen() && screen.contents().contains("0.625"));
    screen.send("q");
    assert_eq!(screen.exit(), 0);
    screen.is_restored();
}

#[test]
fn a_load_answers_in_the_last_line_and_y_copies() {
    let mut screen = Screen::start(&["tui", "beam"], 80, 24);
    screen.wait("normal");
    screen.send(":load greco\r");
    screen.wait("greco · ");
    // no box stands in the way: the next key acts
    screen.send(":load no/such.json\r");
    screen.wait("no/such.json");
    screen.send(":load beam\r");
    screen.wait("F2    250");
    screen.send("2y");
    screen.wait("copied: 0.5");
    // "0.5" in base64
    screen.wait_for_bytes(b"\x1b]52;c;MC41\x07");
    screen.send("q");
    assert_eq!(screen.exit(), 0);
    screen.is_restored();
}

#[test]
fn keys_can_be_changed() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("stickslip");
    std::fs::create_dir(&folder).unwrap();
    let text = r#"{"keys": {"leave": "x", "fly": "y"}, "explain": false}"#;
    std::fs::write(folder.join("config.json"), text).unwrap();
    let mut command = CommandBuilder::new("/bin/sh");
    // the program gets another home than the one of `spawn`
    command.args([
        "-c",
        &format!("XDG_CONFIG_HOME={} exec {} tui beam", home.path().display(), env!("CARGO_BIN_EXE_stickslip")),
    ]);
    let mut screen = Screen::spawn(command, 100, 24);
    screen.wait("normal");
    screen.wait("no action `fly`");
    screen.send("q+");
    screen.wait("f = 0.55");
    screen.send("x");
    assert_eq!(screen.exit(), 0);
    screen.is_restored();
}

#[test]
fn without_a_terminal_it_says_so() {
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip")).args(["tui", "beam"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("needs a terminal"));
    assert!(output.stdout.is_empty());
}

/// Run by the test below in a pseudo-terminal of its own.
#[test]
#[ignore = "helper of another test"]
fn panics_while_the_panes_are_shown() {
    if std::env::var_os("STICKSLIP_TEST_PANIC").is_none() {
        return;
    }
    let _screen = stickslip::tui::terminal::Screen::take(true).unwrap();
    thread::sleep(Duration::from_millis(300));
    panic!("on purpose");
}

#[test]
fn a_panic_leaves_the_terminal_as_it_was() {
    let mut command = CommandBuilder::new(std::env::current_exe().unwrap());
    command.args(["--exact", "tui_pty::panics_while_the_panes_are_shown", "--ignored", "--nocapture"]);
    command.env("STICKSLIP_TEST_PANIC", "1");
    // the message must not be scrolled away
    command.env("RUST_BACKTRACE", "0");
    let mut screen = Screen::spawn(command, 80, 24);
    screen.until("the alternate screen", vt100::Screen::alternate_screen);
    assert_eq!(screen.exit(), 101);
    screen.wait("on purpose");
    screen.is_restored();
}
