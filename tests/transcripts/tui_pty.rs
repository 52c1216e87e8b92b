//! The full screen in a pseudo-terminal: what a terminal sees of it, how many bytes it gets, and how it is left.

use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::CommandBuilder;
use tempfile::TempDir;

use super::pty::{PATIENCE, Terminal, at_home};

/// The program on a terminal of this size, with a home of its own.
fn start(arguments: &[&str], width: u16, height: u16) -> (TempDir, Terminal) {
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(arguments);
    spawn(command, width, height)
}

fn spawn(mut command: CommandBuilder, width: u16, height: u16) -> (TempDir, Terminal) {
    let home = tempfile::tempdir().unwrap();
    at_home(&mut command, home.path(), "xterm-256color");
    (home, Terminal::spawn(command, width, height))
}

#[test]
fn start_vary_step_ray_resize_quit() {
    let (_home, mut screen) = start(&["tui", "beam"], 80, 24);
    screen.shows("normal · 5 pivots");
    assert!(screen.seen.lock().unwrap().parser.screen().alternate_screen());
    // sixteen colours, in their own codes
    let is_of_256 = |code: &[u8]| code == b"8;5;";
    assert!(!screen.seen.lock().unwrap().raw.windows(4).any(is_of_256));
    screen.send("\x1b[B\x1b[B[");
    screen.shows("F2 = 150 kN");
    screen.shows("pairs changed");
    screen.send("u");
    screen.shows("F2 = 250 kN");
    screen.send("\x1b[D\x1b[D");
    screen.shows("Pivot 2 (p enters at 0): pair c5 slips +");
    screen.send("\x1b[F");
    screen.shows("Pivot 4 (p enters at 0)");
    screen.send(":set F2 330\r");
    screen.shows("ray: mechanism");
    screen.shows("mode of the ray");
    screen.resize(140, 45);
    screen.shows("6 Answer");
    screen.shows("3 Pairs");
    screen.resize(40, 12);
    screen.shows("2 Parameters");
    screen.resize(30, 8);
    screen.shows("panes need 40 x 12");
    screen.resize(80, 24);
    screen.shows("ray: mechanism");
    screen.send("?");
    screen.shows("Keys");
    screen.send("\x1b");
    screen.until("the end of the help", |screen| !screen.contents().contains("Keys"));
    screen.send("q");
    assert_eq!(screen.end(), 0);
    screen.is_restored();
}

#[test]
fn few_bytes_for_a_step_and_none_at_rest() {
    for (width, height) in [(80, 24), (140, 45)] {
        let (_home, mut screen) = start(&["tui", "plates-free"], width, height);
        screen.shows("normal");
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
    let (_home, mut screen) = start(&["tui", "beam"], 140, 45);
    screen.shows("normal");
    let before = screen.settle();
    thread::sleep(Duration::from_secs(60));
    assert_eq!(screen.bytes(), before);
    screen.send("q");
    assert_eq!(screen.end(), 0);
}

#[test]
fn a_moving_mode_stays_cheap_and_can_be_stopped() {
    let (_home, mut screen) = start(&["tui", "beam-ray"], 80, 24);
    screen.shows("ray: mechanism");
    screen.settle();
    screen.send("m");
    screen.shows("moving");
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
        let (_home, mut screen) = start(&["tui", "beam"], 80, 24);
        screen.shows("normal");
        screen.signal(signal);
        assert_eq!(screen.end(), status, "{signal}");
        screen.is_restored();
    }
}

#[test]
fn ctrl_z_gives_the_terminal_back_and_fg_takes_it_again() {
    let (_home, mut screen) = start(&["tui", "beam"], 80, 24);
    screen.shows("normal");
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
            // the state stands after the name of the program
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
    screen.shows("f = 0.55");
    screen.send("q");
    assert_eq!(screen.end(), 0);
    screen.is_restored();
}

#[test]
fn to_the_command_line_and_back_with_one_session() {
    let (_home, mut screen) = start(&["beam"], 80, 24);
    screen.shows("lists the commands");
    screen.send("set F2 100\r");
    screen.shows("normal · 2 pivots");
    screen.send("tui\r");
    screen.shows("F2    100");
    screen.send("+");
    screen.shows("f = 0.55");
    screen.send("q");
    screen.until("the prompt", |screen| !screen.alternate_screen());
    screen.send("params\r");
    screen.shows("0.55");
    screen.send("undo\r");
    screen.shows("undone: set f 0.55");
    screen.send("tour\r");
    screen.shows("Tour 1 of 6");
    screen.send("\r\r\r\r\r");
    screen.shows("Tour 6 of 6");
    screen.shows("ray: mechanism");
    screen.send("Q");
    assert_eq!(screen.end(), 0);
    screen.is_restored();
}

#[test]
fn a_load_answers_in_the_last_line_and_y_copies() {
    let (_home, mut screen) = start(&["tui", "beam"], 80, 24);
    screen.shows("normal");
    screen.send(":load greco\r");
    screen.shows("greco · ");
    // no box stands in the way: the next key acts
    screen.send(":load no/such.json\r");
    screen.shows("no/such.json");
    screen.send(":load beam\r");
    screen.shows("F2    250");
    screen.send("2y");
    screen.shows("copied: 0.5");
    // "0.5" in base64
    screen.gets(b"\x1b]52;c;MC41\x07");
    screen.send("q");
    assert_eq!(screen.end(), 0);
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
    let (_home, mut screen) = spawn(command, 100, 24);
    screen.shows("normal");
    screen.shows("no action `fly`");
    screen.send("q+");
    screen.shows("f = 0.55");
    screen.send("x");
    assert_eq!(screen.end(), 0);
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
    let (_home, mut screen) = spawn(command, 80, 24);
    screen.until("the alternate screen", vt100::Screen::alternate_screen);
    assert_eq!(screen.end(), 101);
    screen.shows("on purpose");
    screen.is_restored();
}
