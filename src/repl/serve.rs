//! `serve`: requests of another program, one JSON object a line, each answered at once by one line.

use std::io::{self, Write};
use std::sync::mpsc::RecvTimeoutError;

use serde_json::{Value, json};

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
                Err(BadRequest::new(&Value::Null, format!("a request of more than {LONGEST} bytes was not read")))
            }
            Ok(Input::End) | Err(RecvTimeoutError::Disconnected) => return Ok(0),
            Ok(Input::Failed(error)) => return Err(error),
            Err(RecvTimeoutError::Timeout) => continue,
        };
        let (answer, next) = match request {
            Ok(request) => {
                let watch = TerminalWatch::new(signals);
                let answered = carry_out(session, &request, style, &watch);
                watch.clear();
                answered
            }
            Err(bad) => (failure(bad.id, bad.message, BAD_REQUEST), Next::Continue),
        };
        match writeln!(stdout, "{}", printable::json(answer.to_string())).and_then(|()| stdout.flush()) {
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

/// A line that was understood.
struct Request {
    id: Value,
    command: String,
}

/// A line that was not.
struct BadRequest {
    /// Null where none can be read.
    id: Value,
    message: String,
}

impl BadRequest {
    fn new(id: &Value, message: String) -> Self {
        let form = "a request is one line of JSON, {\"id\": …, \"command\": \"…\"}";
        BadRequest { id: id.clone(), message: format!("{message}; {form}") }
    }
}

fn request(bytes: &[u8]) -> Result<Request, BadRequest> {
    let value: Value = serde_json::from_slice(bytes.trim_ascii_end())
        .map_err(|error| BadRequest::new(&Value::Null, format!("the request is not JSON: {error}")))?;
    let Value::Object(map) = value else {
        return Err(BadRequest::new(&Value::Null, "the request is JSON, but no object".to_owned()));
    };
    let id = map.get("id").cloned().unwrap_or_default();
    let bad = |message: String| Err(BadRequest::new(&id, message));
    if let Some(key) = map.keys().find(|key| !KEYS.contains(&key.as_str())) {
        return bad(format!("unknown key `{}`{}", key, did_you_mean_typed(key, KEYS)));
    }
    match map.get("command") {
        Some(Value::String(command)) => Ok(Request { id: id.clone(), command: command.clone() }),
        Some(_) => bad("`command` must be a string".to_owned()),
        None => bad("`command` is missing".to_owned()),
    }
}

fn failure(id: Value, error: String, status: u8) -> Value {
    json!({"id": id, "ok": false, "error": error, "status": status})
}

/// Runs the commands of a request up to the first that fails (unless `expect error` follows it).
fn carry_out(session: &mut Session, request: &Request, style: Style, watch: &TerminalWatch) -> (Value, Next) {
    let mut nowhere = io::sink();
    let mut io = Output::new(&mut nowhere, style, Format::Values, watch);
    io.unattended = true;
    let mut reports = Vec::new();
    let mut next = Next::Continue;
    for turn in Turn::of_text(&request.command) {
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
            Err(error) => return (told(request.id.clone(), &error), Next::Continue),
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
    (json!({"id": request.id, "ok": true, "report": report}), next)
}

/// A command that failed; the problems of a scenario each with its place.
fn told(id: Value, error: &CommandError) -> Value {
    let mut answer = failure(id, error.to_string(), error.status());
    if let CommandError::Scenario(problems) = error
        && let (Value::Object(answer), Value::Object(mut found)) =
            (&mut answer, json_export::problems(std::slice::from_ref(problems)))
    {
        answer.insert("problems".to_owned(), found.remove("error").unwrap_or_default());
    }
    answer
}
