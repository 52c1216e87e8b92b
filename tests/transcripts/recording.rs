//! The recording of the full screen in `docs/`, an asciinema cast and SVG stills, from a script of keys. It must show what
//! the program shows today; `UPDATE_README=1 cargo test --test transcripts recording` writes it anew (look at it:
//! `asciinema play docs/screen.cast`).
//!
//! A recording holds finished screens, one after each line of the script, as differences from one to the next. What a
//! terminal got in between depends on how fast the machine was, and so would a recording of that.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};
use vt100::Color;

use super::pty::{Terminal, cells, command};

const COLUMNS: u16 = 100;
const ROWS: u16 = 30;

/// What is typed, how long a viewer then looks at it (in seconds), and the name of a still.
const SCRIPT: &[(&str, f64, Option<&str>)] = &[
    ("", 3.0, Some("beam")),
    ("-", 1.0, None),
    ("-", 1.0, None),
    ("-", 1.0, None),
    ("-", 3.0, Some("ray")),
    ("+", 0.7, None),
    ("+", 0.7, None),
    ("+", 0.7, None),
    ("+", 2.0, None),
    (":load pipeline\r", 3.0, Some("pipe")),
    (":set f 0.6\r", 2.0, None),
    (":load arch\r", 3.0, None),
    (":set f 0.34\r", 4.0, Some("arch")),
    (":find least f where outcome answer\r", 4.0, None),
    ("?", 3.0, None),
];

/// A colour as SVG wants it; `plain` is that of no colour.
fn colour(colour: Color, plain: &str) -> String {
    const SIXTEEN: [&str; 16] = [
        "#1e1e2e", "#e06c75", "#98c379", "#e5c07b", "#61afef", "#c678dd", "#56b6c2", "#dcdfe4", "#6b7080", "#e88388",
        "#a9d18e", "#efd28f", "#7fbdf2", "#d08fe5", "#78c8d2", "#ffffff",
    ];
    match colour {
        Color::Default => plain.to_owned(),
        Color::Idx(index @ 0..16) => SIXTEEN[usize::from(index)].to_owned(),
        Color::Idx(index @ 16..232) => {
            let level = |part: u8| if part == 0 { 0 } else { 55 + 40 * part };
            let cube = index - 16;
            format!("#{:02x}{:02x}{:02x}", level(cube / 36), level(cube / 6 % 6), level(cube % 6))
        }
        Color::Idx(index) => {
            let grey = 8 + 10 * (index - 232);
            format!("#{grey:02x}{grey:02x}{grey:02x}")
        }
        Color::Rgb(red, green, blue) => format!("#{red:02x}{green:02x}{blue:02x}"),
    }
}

/// How a cell looks: letters and ground, bold, and which font its sign may come from: letters, lines or dots.
fn look(cell: &vt100::Cell) -> (String, String, bool, u8) {
    let (letters, ground) = (colour(cell.fgcolor(), "#dcdfe4"), colour(cell.bgcolor(), "#1e1e2e"));
    let (letters, ground) = if cell.inverse() { (ground, letters) } else { (letters, ground) };
    let font = match cell.contents().chars().next() {
        Some('\u{2800}'..='\u{28ff}') => 2,
        Some('\u{2190}'..='\u{27ff}') => 1,
        _ => 0,
    };
    (letters, ground, cell.bold(), font)
}

/// The screen as a picture: runs of equal look, each stretched to its columns, so that any monospaced font fits.
fn picture(screen: &vt100::Screen) -> String {
    const WIDE: f64 = 8.4;
    const HIGH: f64 = 16.4;
    let (width, height) = (f64::from(COLUMNS) * WIDE + 16.0, f64::from(ROWS) * HIGH + 16.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" rx=\"6\" fill=\"#1e1e2e\"/>\n"
    );
    for row in 0..ROWS {
        let cell = |column: u16| screen.cell(row, column).unwrap();
        let mut column = 0;
        while column < COLUMNS {
            let first = look(cell(column));
            let mut text = String::new();
            let mut end = column;
            while end < COLUMNS && look(cell(end)) == first {
                let contents = cell(end).contents();
                text.push_str(if contents.is_empty() { " " } else { contents });
                end += 1;
            }
            let (letters, ground, bold, _) = first;
            let (x, y) = (8.0 + f64::from(column) * WIDE, 8.0 + f64::from(row) * HIGH);
            let long = f64::from(end - column) * WIDE;
            if ground != "#1e1e2e" {
                writeln!(
                    svg,
                    "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{long:.1}\" height=\"{HIGH}\" fill=\"{ground}\"/>"
                )
                .unwrap();
            }
            if !text.trim().is_empty() {
                let weight = if bold { " font-weight=\"bold\"" } else { "" };
                let text = text.replace('&', "&amp;").replace('<', "&lt;");
                writeln!(
                    svg,
                    "<text x=\"{x:.1}\" y=\"{:.1}\" textLength=\"{long:.1}\" lengthAdjust=\"spacingAndGlyphs\" \
                     xml:space=\"preserve\" fill=\"{letters}\"{weight}>{text}</text>",
                    y + 12.6
                )
                .unwrap();
            }
            column = end;
        }
    }
    svg.push_str("</svg>\n");
    svg
}

/// The code of a colour, for letters or for the ground behind them.
fn code(colour: Color, ground: u8) -> String {
    match colour {
        Color::Default => String::new(),
        Color::Idx(index @ 0..8) => format!(";{}", 30 + ground + index),
        Color::Idx(index @ 8..16) => format!(";{}", 82 + ground + index),
        Color::Idx(index) => format!(";{};5;{index}", 38 + ground),
        Color::Rgb(red, green, blue) => format!(";{};2;{red};{green};{blue}", 38 + ground),
    }
}

/// The codes that give a cell its look; those of letters only where there are any.
fn codes(cell: &vt100::Cell) -> String {
    let mut codes = code(cell.bgcolor(), 10);
    let switches = [(cell.underline(), ";4"), (cell.inverse(), ";7")];
    if !cell.contents().trim().is_empty() || cell.underline() || cell.inverse() {
        codes += &code(cell.fgcolor(), 0);
        let more = [(cell.bold(), ";1"), (cell.dim(), ";2"), (cell.italic(), ";3")];
        codes.extend(switches.into_iter().chain(more).filter(|(is_on, _)| *is_on).map(|(_, code)| code));
    }
    codes
}

/// A row in the codes that a terminal needs: the same text for the same looks.
fn row(screen: &vt100::Screen, row: u16) -> String {
    let (mut line, mut last) = (format!("\x1b[{};1H\x1b[0m", row + 1), String::new());
    for cell in (0..COLUMNS).map(|column| screen.cell(row, column).unwrap()) {
        if cell.is_wide_continuation() {
            continue;
        }
        let codes = codes(cell);
        if codes != last {
            line += &format!("\x1b[0{codes}m");
            last = codes;
        }
        line += if cell.has_contents() { cell.contents() } else { " " };
    }
    line
}

fn rows(screen: &vt100::Screen) -> Vec<String> {
    (0..ROWS).map(|number| row(screen, number)).collect()
}

/// A screen on which everything looks like this one, written anew.
fn told_anew(screen: &vt100::Screen) -> vt100::Parser {
    let mut parser = blank();
    parser.process(format!("\x1b[?25l{}\x1b[H", rows(screen).concat()).as_bytes());
    parser
}

fn blank() -> vt100::Parser {
    vt100::Parser::new(cells(ROWS), cells(COLUMNS), 0)
}

/// Types the script, and hands over each screen: its place in the script, its terminal.
fn play(mut told: impl FnMut(usize, &Terminal)) {
    let home = tempfile::tempdir().unwrap();
    let mut program = command(home.path(), "xterm-256color", &["tui", "beam"]);
    program.env("COLORTERM", "truecolor");
    program.env("LC_ALL", "C.UTF-8");
    let mut terminal = Terminal::spawn(program, COLUMNS, ROWS);
    for (index, (keys, ..)) in SCRIPT.iter().enumerate() {
        terminal.send(keys);
        told(index, &terminal);
    }
}

fn record(folder: &Path) {
    let head = json!({ "version": 2, "width": COLUMNS, "height": ROWS, "title": "stickslip" });
    let mut cast = format!("{head}\n");
    let mut last = blank();
    let (mut bytes, mut time) = (0, 0.0);
    play(|index, terminal| {
        while terminal.bytes() == bytes {
            thread::sleep(Duration::from_millis(20));
        }
        thread::sleep(Duration::from_secs(2));
        bytes = terminal.settle();
        let now = told_anew(terminal.seen.lock().unwrap().parser.screen());
        writeln!(cast, "{}", json!([time, "o", now.screen().contents_diff(last.screen())])).unwrap();
        let (_, seconds, still) = SCRIPT[index];
        time = f64::round(10.0 * (time + seconds)) / 10.0;
        if let Some(name) = still {
            fs::write(folder.join(format!("screen-{name}.svg")), picture(now.screen())).unwrap();
        }
        last = now;
    });
    writeln!(cast, "{}", json!([time, "o", ""])).unwrap();
    fs::write(folder.join("screen.cast"), cast).unwrap();
}

#[test]
fn the_recording_shows_the_screens_of_today() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    if std::env::var_os("UPDATE_README").is_some() {
        record(&folder);
    }
    let cast = fs::read_to_string(folder.join("screen.cast")).unwrap();
    let mut recorded = blank();
    let mut screens = Vec::new();
    for (event, (.., still)) in cast.lines().skip(1).zip(SCRIPT) {
        let event: Value = serde_json::from_str(event).unwrap();
        recorded.process(event[2].as_str().unwrap().as_bytes());
        screens.push((rows(recorded.screen()), recorded.screen().contents()));
        if let Some(name) = still {
            let stands = fs::read_to_string(folder.join(format!("screen-{name}.svg"))).unwrap();
            assert!(stands == picture(recorded.screen()), "screen-{name}.svg is not a still of the recording");
        }
    }
    assert_eq!((screens.len(), cast.lines().count()), (SCRIPT.len(), SCRIPT.len() + 2), "a screen for each line");
    play(|index, terminal| {
        let (wanted, text) = &screens[index];
        let what = format!("screen {index} of docs/screen.cast (UPDATE_README=1 writes it anew):\n{text}\n");
        terminal.until(&what, |screen| rows(screen) == *wanted);
    });
}
