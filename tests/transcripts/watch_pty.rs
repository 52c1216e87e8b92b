//! A file that is edited while a session stands on it, at the prompt and in the full screen.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::thread;
use std::time::Duration;

use super::pty::{Terminal, command};

/// A scenario with this much friction.
fn block(title: &str, friction: &str) -> String {
    format!(
        r#"{{ "format": "stickslip/1", "title": "{title}",
          "parameters": {{ "f": {friction}, "H": 0.1 }},
          "materials": {{ "m": {{ "E": 1000, "nu": 0.2 }} }},
          "plates": [{{ "id": "b", "origin": [0, 0], "size": [1, 1], "divisions": [1, 1], "thickness": 1, "material": "m", "plane": "stress" }}],
          "contacts": [{{ "id": "base", "edge": "b.bottom", "against": "ground", "friction": "f" }}],
          "loads": {{ "weight": {{ "items": [{{ "point": {{ "at": "b.top", "force": [0, -1] }} }}] }},
                     "push": {{ "factor": "H", "items": [{{ "point": {{ "at": "b.top", "force": [1, 0] }} }}] }} }} }}"#
    )
}

fn save(folder: &Path, text: &str) {
    fs::write(folder.join("b.json"), text).unwrap();
}

/// The same as an editor does that renames.
fn replace(folder: &Path, text: &str) {
    fs::write(folder.join("new"), text).unwrap();
    fs::rename(folder.join("new"), folder.join("b.json")).unwrap();
}

/// A program of the shell.
fn script(path: &Path, text: &str) {
    fs::write(path, text).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn a_watched_file_is_solved_when_it_is_saved_and_the_line_stays() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), &block("one", "0.5"));
    let mut terminal = Terminal::start(folder.path(), "xterm-256color", &["b.json"]);
    terminal.prompt();
    terminal.ask("set H 0.2", "trivial");
    terminal.ask("watch on", "is watched");
    // half a line is typed, the cursor goes back into it
    terminal.send("show x_t base[1]\x1b[D\x1b[D\x1b[D");
    terminal.wait("the line", |screen| screen.contains("show x_t base[1]"));
    save(folder.path(), &block("two", "0.6"));
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
    // a file with an error: the place is given, the session stays as it was
    save(folder.path(), "{ \"format\": \"stickslip/1\",\n  \"title\": }");
    terminal.wait("the place", |screen| screen.contains("b.json:2:"));
    terminal.ask("params", "0.6");
    // an editor that writes beside the file and renames
    replace(folder.path(), &block("three", "0.7"));
    terminal.wait("right again", |screen| screen.matches("b.json read again").count() == 2);
    // one that is taken away is reported once, and read when it comes back, also as it was
    fs::rename(folder.path().join("b.json"), folder.path().join("away.json")).unwrap();
    terminal.wait("that it is gone", |screen| screen.contains("b.json is gone: the last answer stays"));
    terminal.ask("params", "0.7");
    fs::rename(folder.path().join("away.json"), folder.path().join("b.json")).unwrap();
    terminal.wait("that it is back", |screen| screen.contains("b.json is as it was"));
    // an editor that cuts the file and writes it a moment later: one answer, no error
    save(folder.path(), "");
    thread::sleep(Duration::from_millis(200));
    save(folder.path(), &block("four", "0.8"));
    // the first lines may have left the screen
    let below =
        |screen: &str| screen.rsplit_once("b.json is as it was").map_or(String::new(), |(_, below)| below.to_owned());
    terminal.wait("the one answer", |screen| below(screen).matches("b.json read again").count() == 1);
    let screen = terminal.ask("watch off", "no file is watched");
    assert_eq!(screen.matches("the file is empty").count(), 0, "{screen}");
    terminal.send("quit\r");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_watched_file_is_shown_when_it_is_saved_and_its_errors_over_the_last_picture() {
    let folder = tempfile::tempdir().unwrap();
    replace(folder.path(), &block("a block", "0.5"));
    let mut screen = Terminal::spawn(command(folder.path(), "xterm-256color", &["tui", "b.json"]), 100, 30);
    screen.shows("a block");
    screen.send(":watch on\r");
    screen.shows("is watched");
    replace(folder.path(), &block("a block", "0.625"));
    screen.shows("0.625");
    save(folder.path(), "{ \"format\": \"stickslip/1\",\n  \"title\": }");
    screen.shows("b.json:2:");
    let text = screen.text();
    assert!(text.contains("0.625") && text.contains("2 Parameters"), "the panes stay:\n{text}");
    // it swallows no key: the friction goes up, the error stays
    screen.send("+");
    screen.until("a key", |screen| screen.contents().contains("0.645") && screen.contents().contains("b.json:2:"));
    replace(folder.path(), &block("a block", "0.25"));
    screen.until("right again", |screen| !screen.contents().contains("b.json:2:"));
    screen.settle();
    let before = screen.bytes();
    thread::sleep(Duration::from_secs(2));
    assert_eq!(screen.bytes(), before, "nothing is sent while nothing is saved");
    screen.send("q");
    assert_eq!(screen.end(), 0);
}

#[test]
fn edit_opens_the_editor_of_the_user_and_reads_again() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), &block("one", "0.5"));
    let editor = folder.path().join("my editor");
    // an editor with an option: it changes the friction, after the user pressed a key and Ctrl-C
    script(&editor, "#!/bin/sh\ntrap '' INT\necho EDITING $1\nread key\nsed -i s/0.5/0.625/ \"$2\"\n");
    let mut command = command(folder.path(), "xterm-256color", &["beam"]);
    command.env("VISUAL", format!("'{}' --wait", editor.display()));
    let mut terminal = Terminal::spawn(command, 80, 24);
    terminal.prompt();
    terminal.ask("edit", "gives it one");
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
fn edit_lends_the_terminal_to_the_editor() {
    let folder = tempfile::tempdir().unwrap();
    replace(folder.path(), &block("a block", "0.5"));
    let editor = folder.path().join("editor");
    script(&editor, "#!/bin/sh\necho EDITING\nread key\nsed -i s/0.5/0.625/ \"$1\"\n");
    let mut command = command(folder.path(), "xterm-256color", &["tui", "b.json"]);
    command.env("VISUAL", editor.display().to_string());
    let mut screen = Terminal::spawn(command, 100, 30);
    screen.shows("a block");
    screen.send(":edit\r");
    screen.until("the editor", |screen| !screen.alternate_screen() && screen.contents().contains("EDITING"));
    screen.is_restored();
    screen.send("x\r");
    screen.until("the panes", |screen| screen.alternate_screen() && screen.contents().contains("0.625"));
    screen.send("q");
    assert_eq!(screen.end(), 0);
    screen.is_restored();
}
