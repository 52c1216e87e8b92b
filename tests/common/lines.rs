//! Lines given to a session: what they show, what they report.

#![allow(dead_code)] // every test binary uses its own part

use std::sync::atomic::{AtomicUsize, Ordering};

use serde_json::Value;
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::model::scenario::Scenario;
use stickslip::session::{Format, Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

/// A session on a scenario, solved.
pub fn session(scenario: Scenario) -> Session {
    Session::new(scenario, &Quiet).unwrap_or_else(|error| panic!("{error}"))
}

/// A session on an embedded scenario.
pub fn embedded(name: &str) -> Session {
    session(embedded::load(name).expect("embedded"))
}

/// A session on the text of a scenario.
pub fn read(text: &str) -> Session {
    session(load_text("case.json", text, None).unwrap_or_else(|problems| panic!("{problems}")))
}

fn given(session: &mut Session, line: &str, format: Format) -> Result<String, String> {
    let mut text = Vec::new();
    let style = Style { width: 100, color: false, ascii: false };
    let ended = session.execute(line, &mut Output::new(&mut text, style, format, &Quiet));
    ended.map(|_| String::from_utf8(text).expect("text")).map_err(|error| error.to_string())
}

/// What a line shows on 100 columns, or its error.
pub fn told(session: &mut Session, line: &str) -> Result<String, String> {
    given(session, line, Format::Text)
}

/// The same of a line that must succeed.
pub fn text(session: &mut Session, line: &str) -> String {
    told(session, line).unwrap_or_else(|error| panic!("{line}: {error}"))
}

/// The report of a line, as in `replay --format json`, or its error.
pub fn report(session: &mut Session, line: &str) -> Result<Value, String> {
    let mut answer: Value = serde_json::from_str(&given(session, line, Format::JsonLines)?).expect("JSON");
    Ok(answer["report"].take())
}

/// `work` on all items, on as many threads as there are cores; not on those of the program's own pool, for which the work
/// of a session may wait.
pub fn side_by_side<T: Sync>(items: &[T], work: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
                    work(item);
                }
            });
        }
    });
}
