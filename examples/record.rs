//! Records the full screen: an asciinema cast and SVG stills, from a script of keys.
//!
//! ```text
//! cargo build --release && cargo run --release --example record -- target/release/stickslip docs
//! ```
//!
//! writes `docs/screen.cast` (`asciinema play docs/screen.cast`) and `docs/screen-*.svg`, the stills of the README. The
//! program runs in a pseudo-terminal of 100 × 30 and sees keys as from a keyboard; the times of the cast are those of
//! the script, not of the machine.

use std::fmt::Write as _;
use std::fs;
use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{CommandBuilder, PtySize, native_pty_system};
use vt100::Color;

const COLUMNS: u16 = 100;
const ROWS: u16 = 30;
/// A screen is complete when nothing has come for so long.
const QUIET: Duration = Duration::from_millis(1500);
/// Nor is anything waited for longer.
const PATIENCE: Duration = Duration::from_secs(30);

type Failure = Box<dyn std::error::Error>;

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

/// The bytes that came since they were last taken.
type Bytes = Arc<Mutex<Vec<u8>>>;

/// Waits until nothing more comes; what came.
fn take(bytes: &Bytes) -> Vec<u8> {
    let begun = Instant::now();
    let (mut count, mut since) = (0, Instant::now());
    while begun.elapsed() < PATIENCE && (count == 0 || since.elapsed() < QUIET) {
        thread::sleep(Duration::from_millis(20));
        let now = bytes.lock().map_or(0, |bytes| bytes.len());
        if now != count {
            (count, since) = (now, Instant::now());
        }
    }
    bytes.lock().map(|mut bytes| std::mem::take(&mut *bytes)).unwrap_or_default()
}

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
fn picture(screen: &vt100::Screen) -> Result<String, Failure> {
    const WIDE: f64 = 8.4;
    const HIGH: f64 = 16.4;
    let (width, height) = (f64::from(COLUMNS) * WIDE + 16.0, f64::from(ROWS) * HIGH + 16.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" rx=\"6\" fill=\"#1e1e2e\"/>\n"
    );
    for row in 0..ROWS {
        let cell = |column: u16| screen.cell(row, column).ok_or("a cell outside the screen");
        let mut column = 0;
        while column < COLUMNS {
            let first = look(cell(column)?);
            let mut text = String::new();
            let mut end = column;
            while end < COLUMNS && look(cell(end)?) == first {
                let contents = cell(end)?.contents();
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
                )?;
            }
            if !text.trim().is_empty() {
                let weight = if bold { " font-weight=\"bold\"" } else { "" };
                let text = text.replace('&', "&amp;").replace('<', "&lt;");
                writeln!(
                    svg,
                    "<text x=\"{x:.1}\" y=\"{:.1}\" textLength=\"{long:.1}\" lengthAdjust=\"spacingAndGlyphs\" \
                     xml:space=\"preserve\" fill=\"{letters}\"{weight}>{text}</text>",
                    y + 12.6
                )?;
            }
            column = end;
        }
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let (Some(program), Some(folder)) = (arguments.next(), arguments.next()) else {
        return Err("usage: record PROGRAM FOLDER".into());
    };
    let folder = Path::new(&folder);
    let home = tempfile::tempdir()?;
    let pair = native_pty_system().openpty(PtySize { rows: ROWS, cols: COLUMNS, pixel_width: 0, pixel_height: 0 })?;
    let mut command = CommandBuilder::new(fs::canonicalize(program)?);
    command.args(["tui", "beam"]);
    command.cwd(home.path());
    for (name, value) in [("HOME", home.path()), ("XDG_STATE_HOME", home.path()), ("XDG_CONFIG_HOME", home.path())] {
        command.env(name, value);
    }
    command.env("TERM", "xterm-256color");
    command.env("COLORTERM", "truecolor");
    command.env_remove("NO_COLOR");
    let mut child = pair.slave.spawn_command(command)?;
    drop(pair.slave);
    let mut writer = pair.master.take_writer()?;
    let mut reader = pair.master.try_clone_reader()?;
    let bytes = Bytes::default();
    let theirs = Arc::clone(&bytes);
    thread::spawn(move || {
        let mut buffer = [0; 4096];
        while let Ok(count @ 1..) = reader.read(&mut buffer) {
            if let Ok(mut bytes) = theirs.lock() {
                bytes.extend_from_slice(&buffer[..count]);
            }
        }
    });

    let size = |count: u16| NonZeroU16::new(count).ok_or("a screen without size");
    let mut parser = vt100::Parser::new(size(ROWS)?, size(COLUMNS)?, 0);
    let head = serde_json::json!({ "version": 2, "width": COLUMNS, "height": ROWS, "title": "stickslip" });
    let mut cast = format!("{head}\n");
    let mut time = 0.0;
    for (keys, seconds, still) in SCRIPT {
        writer.write_all(keys.as_bytes())?;
        writer.flush()?;
        let came = take(&bytes);
        parser.process(&came);
        writeln!(cast, "{}", serde_json::json!([time, "o", String::from_utf8_lossy(&came)]))?;
        time += seconds;
        if let Some(name) = still {
            fs::write(folder.join(format!("screen-{name}.svg")), picture(parser.screen())?)?;
        }
    }
    writeln!(cast, "{}", serde_json::json!([time, "o", ""]))?;
    fs::write(folder.join("screen.cast"), cast)?;
    child.kill()?;
    Ok(())
}
