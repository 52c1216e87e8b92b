//! A line → its commands → each is read, allowed or not, run and answered.

use serde_json::json;

use super::language::command::Parsed;
use super::language::error::GrammarError;
use super::language::grammar;
use super::language::turn::Turn;
use super::{CommandError, Format, Missing, Next, Output, Session};
use crate::text::printable;

impl Session {
    /// Runs the commands of a line; stops at the first that fails (unless `expect error` follows it).
    ///
    /// # Errors
    /// [`CommandError`]; the command that failed has left the session as it was.
    pub fn execute(&mut self, line: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        for turn in Turn::of_line(line) {
            match self.run(turn.command, io) {
                Ok(Next::Continue) => {}
                Err(error) if turn.forgives(&error) => {}
                ended => return ended,
            }
        }
        Ok(Next::Continue)
    }

    /// Runs one command.
    pub(crate) fn run(&mut self, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        io.report = None;
        let parsed = grammar::parse(text);
        let result = if self.depth == 0 && self.recorder.is_some() {
            self.run_recorded(text, parsed, io)
        } else {
            self.run_parsed(text, parsed, io)
        };
        if self.depth == 0 {
            self.history.push(text.to_owned());
        }
        if io.format != Format::Text {
            let report = io.report.take().unwrap_or_default();
            let answer = match &result {
                Ok(_) => json!({"command": text, "line": io.line, "ok": true, "report": report}),
                Err(error) => json!({
                    "command": text, "line": io.line, "ok": false,
                    "error": error.to_string(), "status": error.status(),
                }),
            };
            match io.format {
                Format::Values => io.answers.push(answer),
                _ => writeln!(io.out, "{}", printable::json(answer.to_string()))?,
            }
        }
        io.out.flush()?;
        result
    }

    /// Somebody has seen what the last line said: what follows is meant for the session as it is.
    pub fn attend(&mut self) {
        self.missing = Missing::Nothing;
    }

    pub(super) fn run_parsed(
        &mut self,
        text: &str,
        parsed: Result<Option<Parsed>, GrammarError>,
        io: &mut Output<'_>,
    ) -> Result<Next, CommandError> {
        let parsed = match parsed {
            Ok(None) => return Ok(Next::Continue),
            Ok(Some(parsed)) => Ok(parsed),
            Err(error) => Err(CommandError::from(error)),
        };
        let read = parsed.as_ref().ok();
        let keeps_error = read.is_some_and(|parsed| parsed.command.keeps_error);
        let loads = read.is_some_and(|parsed| parsed.action.loads());
        let expects_error = read.is_some_and(|parsed| parsed.action.expects_error());
        let result = parsed.and_then(|parsed| self.act(&parsed, text, io));
        self.missing = match (loads, &result) {
            // Whoever interrupts is at the keyboard: what follows is meant for the session as it is.
            (true, Err(error)) if io.unattended && !error.is_interrupted() => Missing::JustNow,
            (true, _) => Missing::Nothing,
            (false, _) if !io.unattended => Missing::Nothing,
            (false, _) if self.missing == Missing::JustNow && expects_error => Missing::Nothing,
            (false, _) if self.missing == Missing::JustNow => Missing::Still,
            (false, _) => self.missing,
        };
        match &result {
            Ok(_) if !keeps_error => self.last_error = None,
            Err(error) if !matches!(error, CommandError::Unmet(_)) => {
                self.last_error = Some(error.to_string());
            }
            _ => {}
        }
        result
    }

    /// Runs a command, unless a `load` before it failed: one that comes by itself was meant for the scenario that is not
    /// there, and would change another.
    fn act(&mut self, parsed: &Parsed, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        let Parsed { command, action } = parsed;
        let allowed = action.loads() || command.without_scenario || action.expects_error();
        if self.missing != Missing::Nothing && io.unattended && !allowed {
            return Err(CommandError::Refused(
                "not done: the `load` before it failed, and this was meant for what it should have loaded; `load` \
                 something that is there first"
                    .into(),
            ));
        }
        if !io.joints_first {
            self.ensure_whole(io.watch)?;
        }
        if action.needs_pivots() {
            self.ensure_pivots(io)?;
        }
        if action.is_of_own_factors(self)
            && let Some(name) = self.combination()
        {
            let note = format!("of the load cases with their own factors; the tables are those of combination {name}");
            io.remark(&note)?;
        }
        action.run(self, text, io)
    }
}
