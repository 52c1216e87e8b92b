//! `serve`: requests of another program, one JSON object a line, each answered at once by one line.

use std::fmt;
use std::io::{self, Write};
use std::sync::mpsc::RecvTimeoutError;

use serde::Serialize;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;
use serde_json::{Map, Value, json};

use crate::export::json as json_export;
use crate::model::words::did_you_mean_typed;
use crate::session::language::turn::Turn;
use crate::session::script::LONGEST;
use crate::session::{CommandError, Format, Next, Output, Session};
use crate::signals::{Signals, TerminalWatch};
use crate::text::printable;
use crate::view::style::Style;

use super::plain::{Input, LOOK, reader};

/// Keys of a request.
const KEYS: [&str; 2] = ["id", "command"];

/// Status of a request that cannot be understood: bad input.
const BAD_REQUEST: u8 = 2;

/// Answers requests until `quit`, the end of the input or a signal that ends the program; the exit status.
///
/// # Errors
/// stdin cannot be read, or stdout cannot be written (a reader that has gone away is not an error).
pub fn serve(session: &mut Session, style: Style, signals: &Signals) -> io::Result<u8> {
    let lines = reader()?;
    let mut stdout = io::stdout();
    loop {
        let input = lines.recv_timeout(LOOK);
        if signals.must_end() {
            return Ok(signals.status());
        }
        // one that came while nothing was computed has nothing to stop
        signals.take_interrupt();
        let request = match input {
            Ok(Input::Line(bytes)) => request(&bytes),
            Ok(Input::TooLong) => {
                Err(BadRequest::new(no_id(), format!("a request of more than {LONGEST} bytes was not read")))
            }
            Ok(Input::End) | Err(RecvTimeoutError::Disconnected) => return Ok(0),
            Ok(Input::Failed(error)) => return Err(error),
            Err(RecvTimeoutError::Timeout) => continue,
        };
        let (answer, next) = match request {
            Ok(request) => {
                let watch = TerminalWatch::new(signals);
                let (rest, next) = carry_out(session, &request.command, style, &watch);
                watch.clear();
                (Answer { id: request.id, rest }, next)
            }
            Err(bad) => (Answer { id: bad.id, rest: failure(bad.message, BAD_REQUEST) }, Next::Continue),
        };
        let answer = serde_json::to_string(&answer).map_err(io::Error::other)?;
        match writeln!(stdout, "{}", printable::json(answer)).and_then(|()| stdout.flush()) {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(0),
            written => written?,
        }
        if signals.must_end() {
            return Ok(signals.status());
        }
        if next == Next::Quit {
            return Ok(0);
        }
    }
}

/// What stands in a line: the `id` as it was written, of which a number may have more digits than any type of ours.
#[derive(Serialize)]
struct Answer {
    id: Box<RawValue>,
    #[serde(flatten)]
    rest: Map<String, Value>,
}

/// Null: the id of a line in which none can be read.
fn no_id() -> Box<RawValue> {
    RawValue::NULL.to_owned()
}

/// The keys of an object with their values as they were written, doubled ones too.
struct Keys(Vec<(String, Box<RawValue>)>);

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Keys, D::Error> {
        struct All;
        impl<'de> Visitor<'de> for All {
            type Value = Keys;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Keys, A::Error> {
                let mut keys = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    keys.push(entry);
                }
                Ok(Keys(keys))
            }
        }
        from.deserialize_map(All)
    }
}

/// A line that was understood.
struct Request {
    id: Box<RawValue>,
    command: String,
}

/// A line that was not.
struct BadRequest {
    /// Null where none can be read.
    id: Box<RawValue>,
    message: String,
}

impl BadRequest {
    fn new(id: Box<RawValue>, message: String) -> Self {
        let form = "a request is one line of JSON, {\"id\": …, \"command\": \"…\"}";
        BadRequest { id, message: format!("{message}; {form}") }
    }
}

fn request(bytes: &[u8]) -> Result<Request, BadRequest> {
    let not_json = |error: serde_json::Error| BadRequest::new(no_id(), format!("the request is not JSON: {error}"));
    let whole: &RawValue = serde_json::from_slice(bytes.trim_ascii_end()).map_err(not_json)?;
    if !whole.get().starts_with('{') {
        return Err(BadRequest::new(no_id(), "the request is JSON, but no object".to_owned()));
    }
    let Keys(keys) = serde_json::from_str(whole.get()).map_err(not_json)?;
    let all = |key: &str| keys.iter().filter(|(own, _)| own == key).map(|(_, value)| value).collect::<Vec<_>>();
    let id = match all("id")[..] {
        [id] => id.clone(),
        _ => no_id(),
    };
    let bad = |message: String| Err(BadRequest::new(id.clone(), message));
    if let Some((key, _)) = keys.iter().find(|(key, _)| !KEYS.contains(&key.as_str())) {
        return bad(format!("unknown key `{}`{}", key, did_you_mean_typed(key, KEYS)));
    }
    if let Some(key) = KEYS.into_iter().find(|key| all(key).len() > 1) {
        return bad(format!("`{key}` stands there twice"));
    }
    match all("command")[..] {
        [] => bad("`command` is missing".to_owned()),
        [command, ..] if !command.get().starts_with('"') => bad("`command` must be a string".to_owned()),
        [command, ..] => match serde_json::from_str(command.get()) {
            Ok(command) => Ok(Request { id, command }),
            Err(error) => bad(format!("`command` is no string: {error}")),
        },
    }
}

fn failure(error: String, status: u8) -> Map<String, Value> {
    object(json!({"ok": false, "error": error, "status": status}))
}

fn object(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

/// Runs the commands of a request up to the first that fails (unless `expect error` follows it).
fn carry_out(session: &mut Session, command: &str, style: Style, watch: &TerminalWatch) -> (Map<String, Value>, Next) {
    let mut nowhere = io::sink();
    let mut io = Output::new(&mut nowhere, style, Format::Values, watch);
    io.unattended = true;
    let mut reports = Vec::new();
    let mut next = Next::Continue;
    for turn in Turn::of_text(command) {
        let result = session.run(turn.command, &mut io);
        let mut answers = std::mem::take(&mut io.answers);
        let own = answers.pop().unwrap_or_default();
        match result {
            Ok(then) => {
                // what stands before the command's own answer are the answers of a script that it ran
                let own = own.get("report").cloned().unwrap_or_default();
                reports.push(if answers.is_empty() { own } else { Value::Array(answers) });
                next = then;
            }
            Err(error) if turn.forgives(&error) => reports.push(own),
            Err(error) => return (told(&error), Next::Continue),
        }
        if next != Next::Continue {
            break;
        }
    }
    let report = match reports.len() {
        0 => Value::Null,
        1 => reports.remove(0),
        _ => Value::Array(reports),
    };
    (object(json!({"ok": true, "report": report})), next)
}

/// A command that failed; the problems of a scenario each with its place.
fn told(error: &CommandError) -> Map<String, Value> {
    let mut answer = failure(error.to_string(), error.status());
    if let CommandError::Scenario(problems) = error
        && let Value::Object(mut found) = json_export::problems(std::slice::from_ref(problems))
    {
        answer.insert("problems".to_owned(), found.remove("error").unwrap_or_default());
    }
    answer
}
