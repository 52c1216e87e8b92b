//! The tour of the README at a terminal, typed line by line and pasted as a whole; `book.rs` runs it as a script.
#![cfg(unix)]

use super::pty::{Terminal, ends_in_prompt};

/// The lines of the tour.
fn lines() -> Vec<String> {
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let (_, tour) = readme.split_once("```stickslip\n").unwrap();
    tour.split_once("```").unwrap().0.lines().map(str::to_owned).collect()
}

/// No line was refused, and what the comments of the tour promise was shown.
fn is_whole(terminal: &Terminal) {
    let text = String::from_utf8_lossy(&terminal.seen.lock().unwrap().raw).into_owned();
    assert!(!text.contains("error:"), "{text}");
    for said in ["22.222", "ray: mechanism", "certified", "300", "One contact pair", "3 answers"] {
        assert!(text.contains(said), "{said} is not shown:\n{text}");
    }
}

#[test]
fn the_tour_can_be_typed() {
    let folder = tempfile::tempdir().unwrap();
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
    terminal.prompt();
    let lines = lines();
    assert!(lines.len() >= 15, "{lines:?}");
    for line in &lines {
        terminal.type_by_hand(line);
        let asks = |screen: &str| screen.trim_end().ends_with("q stop --");
        let screen =
            terminal.wait("the next prompt, or the end of a page", |screen| asks(screen) || ends_in_prompt(screen));
        if asks(&screen) {
            terminal.send("a");
        }
        terminal.prompt();
    }
    is_whole(&terminal);
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn the_tour_can_be_pasted() {
    let lines = lines();
    // as terminals mark what is pasted, and as old ones give it
    for (before, between, after) in [("\x1b[200~", "\n", "\x1b[201~\r"), ("", "\r", "\r")] {
        let folder = tempfile::tempdir().unwrap();
        let mut terminal = Terminal::start(folder.path(), "xterm-256color", &[]);
        terminal.prompt();
        terminal.send(&format!("{before}{}{between}echo the tour is over{after}", lines.join(between)));
        terminal.shows("\nthe tour is over");
        terminal.prompt();
        is_whole(&terminal);
        terminal.send("quit\r");
        assert_eq!(terminal.end(), 0);
    }
}
