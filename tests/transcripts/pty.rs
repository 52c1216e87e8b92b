//! A program on a pseudo-terminal of its own: what a person sees and types.

use std::io::{Read, Write};
use std::num::NonZeroU16;
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};

/// Longest wait for anything: only a failure takes so long, on a busy machine too.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// What the prompt looks like once colours are taken in by the screen.
pub const PROMPT: &str = "› ";

/// The program under test in `folder`, its state and configuration kept there too.
pub fn command(folder: &Path, term: &str, arguments: &[&str]) -> CommandBuilder {
    let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_stickslip"));
    command.args(arguments);
    at_home(&mut command, folder, term);
    command
}

/// Lets a command live in `folder`.
pub fn at_home(command: &mut CommandBuilder, folder: &Path, term: &str) {
    command.cwd(folder);
    command.env("HOME", folder);
    command.env("XDG_STATE_HOME", folder.join("state"));
    command.env("XDG_CONFIG_HOME", folder.join("config"));
    command.env("TERM", term);
    command.env_remove("NO_COLOR");
}

/// What a terminal got.
pub struct Seen {
    pub parser: vt100::Parser,
    /// All bytes.
    pub raw: Vec<u8>,
}

/// A program on a terminal of its own.
pub struct Terminal {
    pub child: Box<dyn Child + Send + Sync>,
    master: Box<dyn MasterPty + Send>,
    writer: Box<dyn Write + Send>,
    pub seen: Arc<Mutex<Seen>>,
    /// The settings of the terminal as the program found it.
    before: String,
}

impl Terminal {
    /// The program under test in `folder`, 80 columns and 24 rows.
    pub fn start(folder: &Path, term: &str, arguments: &[&str]) -> Terminal {
        Terminal::spawn(command(folder, term, arguments), 80, 24)
    }

    pub fn spawn(command: CommandBuilder, width: u16, height: u16) -> Terminal {
        let size = PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).unwrap();
        let before = settings(&*pair.master);
        let child = pair.slave.spawn_command(command).unwrap();
        drop(pair.slave);
        let mut reader = pair.master.try_clone_reader().unwrap();
        let writer = pair.master.take_writer().unwrap();
        let parser = vt100::Parser::new(cells(height), cells(width), 1000);
        let seen = Arc::new(Mutex::new(Seen { parser, raw: Vec::new() }));
        let theirs = Arc::clone(&seen);
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut bytes) {
                let mut seen = theirs.lock().unwrap();
                seen.parser.process(&bytes[..count]);
                seen.raw.extend_from_slice(&bytes[..count]);
            }
        });
        Terminal { child, master: pair.master, writer, seen, before }
    }

    pub fn send(&mut self, text: &str) {
        self.writer.write_all(text.as_bytes()).unwrap();
        self.writer.flush().unwrap();
    }

    /// Types a line with the pauses of a hand.
    pub fn type_by_hand(&mut self, line: &str) {
        self.send(line);
        thread::sleep(Duration::from_millis(50));
        self.send("\r");
    }

    pub fn text(&self) -> String {
        self.seen.lock().unwrap().parser.screen().contents()
    }

    /// How many bytes have come.
    pub fn bytes(&self) -> usize {
        self.seen.lock().unwrap().raw.len()
    }

    /// Waits until something is so.
    fn wait_for(&self, what: &str, mut holds: impl FnMut(&Seen) -> bool) {
        let start = Instant::now();
        while !holds(&self.seen.lock().unwrap()) {
            assert!(start.elapsed() < PATIENCE, "waited in vain for {what}:\n{}", self.text());
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits until the screen is as wanted.
    pub fn until(&self, what: &str, holds: impl Fn(&vt100::Screen) -> bool) {
        self.wait_for(what, |seen| holds(seen.parser.screen()));
    }

    /// Waits until its text is as wanted; the text.
    pub fn wait(&self, what: &str, wanted: impl Fn(&str) -> bool) -> String {
        let mut found = String::new();
        self.wait_for(what, |seen| {
            found = seen.parser.screen().contents();
            wanted(&found)
        });
        found
    }

    /// Waits until the text shows a part.
    pub fn shows(&self, part: &str) -> String {
        self.wait(part, |screen| screen.contains(part))
    }

    /// Waits until these bytes have come.
    pub fn gets(&self, part: &[u8]) {
        let what = part.escape_ascii().to_string();
        self.wait_for(&what, |seen| seen.raw.windows(part.len()).any(|window| window == part));
    }

    /// Waits for an empty prompt in the last line that is written on.
    pub fn prompt(&self) -> String {
        self.wait("the prompt", ends_in_prompt)
    }

    /// Types a line and waits for its answer and the next prompt.
    pub fn ask(&mut self, text: &str, answer: &str) -> String {
        self.send(&format!("{text}\r"));
        self.wait(answer, |screen| {
            let behind = screen.rsplit_once(&format!("{PROMPT}{text}")).map_or("", |(_, behind)| behind).trim_end();
            behind.contains(answer) && ends_in_prompt(behind)
        })
    }

    /// Waits until nothing has come for a while; the number of bytes so far.
    pub fn settle(&self) -> usize {
        let mut last = (self.bytes(), Instant::now());
        let start = Instant::now();
        while last.1.elapsed() < Duration::from_millis(600) && start.elapsed() < PATIENCE {
            thread::sleep(Duration::from_millis(20));
            if self.bytes() != last.0 {
                last = (self.bytes(), Instant::now());
            }
        }
        last.0
    }

    pub fn resize(&mut self, width: u16, height: u16) {
        self.seen.lock().unwrap().parser.screen_mut().set_size(cells(height), cells(width));
        self.master.resize(PtySize { rows: height, cols: width, pixel_width: 0, pixel_height: 0 }).unwrap();
    }

    /// The terminal no longer says how large it is.
    pub fn forget_size(&self) {
        self.master.resize(PtySize { rows: 0, cols: 0, pixel_width: 0, pixel_height: 0 }).unwrap();
    }

    pub fn signal(&self, name: &str) {
        let id = self.child.process_id().unwrap().to_string();
        assert!(Command::new("kill").args(["-s", name, &id]).status().unwrap().success());
    }

    /// Waits for the end; its exit status.
    pub fn end(&mut self) -> u32 {
        let start = Instant::now();
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status.exit_code();
            }
            assert!(start.elapsed() < PATIENCE, "it does not end:\n{}", self.text());
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// The terminal is as it was found.
    pub fn is_restored(&self) {
        self.until("the end of the alternate screen", |screen| {
            !screen.alternate_screen()
                && !screen.hide_cursor()
                && !screen.bracketed_paste()
                && screen.mouse_protocol_mode() == vt100::MouseProtocolMode::None
        });
        self.wait_for("the settings of the terminal", |_| settings(&*self.master) == self.before);
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Whether the last line that is written on is an empty prompt.
pub fn ends_in_prompt(screen: &str) -> bool {
    screen.trim_end_matches('\n').lines().next_back().is_some_and(|line| line.trim_end() == PROMPT.trim_end())
}

pub fn cells(count: u16) -> NonZeroU16 {
    NonZeroU16::new(count).unwrap()
}

fn settings(master: &dyn MasterPty) -> String {
    format!("{:?}", master.get_termios())
}
