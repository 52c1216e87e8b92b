//! `pivots`, `step`.

use std::io::{self, Write};

use clap::Args;
use serde::Serialize;

use crate::answer::record::PivotRecord;

use crate::session::language::candidates::Candidate;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Report, Session};
use crate::view;
use crate::view::style::Style;

/// List the pivots, each with its sentence
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  pivots\n  pivots 2..4")]
pub struct Pivots {
    /// One pivot, or FROM..TO; either end may be left out
    #[arg(value_name = "RANGE")]
    range: Option<String>,
}

pub const PIVOTS: Command = Command { usage: Some("[FROM..TO]"), ..Command::of::<Pivots>("pivots") };

impl Action for Pivots {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_pivots(self.range.as_deref(), io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

/// Move along the pivots: `pairs` and `plot` then show the structure at that pivot
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  step first; step; step 2; step back 1; step to 4; step last")]
pub struct Step {
    /// N, back N, to K, first or last; one pivot on if left out
    #[arg(value_name = "STEP")]
    words: Vec<String>,
}

pub const STEP: Command = Command {
    usage: Some("[N|back N|to K|first|last]"),
    complete: |asked| match asked.given {
        [] => Candidate::plain(["back", "to", "first", "last"]),
        _ => Vec::new(),
    },
    ..Command::of::<Step>("step")
};

impl Action for Step {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.step(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }
}

impl Session {
    /// `pivots [FROM..TO]`.
    pub(in crate::session) fn report_pivots(
        &self,
        range: Option<&str>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let last = answer.pivots.last().map_or(0, |pivot| pivot.step);
        let range = match range {
            None => None,
            Some(text) => {
                let bad = || {
                    CommandError::Refused(format!(
                        "pivots: `{text}` is not a range; expected K, FROM..TO, FROM.. or ..TO with 0 … {last}"
                    ))
                };
                let end = |word: &str, open: usize| match word.trim() {
                    "" => Ok(open),
                    word => word.parse::<usize>().map_err(|_| bad()),
                };
                let (from, to) = match text.split_once("..") {
                    Some((from, to)) => (end(from, 0)?, end(to.trim_start_matches('='), last)?),
                    None => {
                        let one = text.parse().map_err(|_| bad())?;
                        (one, one)
                    }
                };
                if from > to || from > last {
                    return Err(bad());
                }
                Some(from..=to)
            }
        };
        let inside = |pivot: &&PivotRecord| range.as_ref().is_none_or(|range| range.contains(&pivot.step));
        let chosen: Vec<&PivotRecord> = answer.pivots.iter().filter(inside).collect();
        io.show(&chosen, |out, style| {
            view::pivots::write(out, answer, range.clone(), self.position, &self.now.scenario.units, style)
        })?;
        Ok(())
    }

    /// `step [N|back N|to K|first|last]`.
    fn step(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let (Some(last), Some(recorded)) = (answer.pivot_count.checked_sub(1), answer.last_recorded()) else {
            return Err(CommandError::Refused(answer.rules.why_no_pivots()));
        };
        let here = self.shown_step().unwrap_or(last);
        let count = |word: &str| {
            word.parse::<usize>().map_err(|_| {
                CommandError::Refused(format!(
                    "step: `{word}` is not a number of pivots; expected N, back N, to K, first or last"
                ))
            })
        };
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let to = match words.as_slice() {
            [] => here.saturating_add(1),
            ["first"] => 0,
            ["last"] => last,
            ["back"] => here.saturating_sub(1),
            ["back", n] => here.saturating_sub(count(n)?),
            ["to", "first"] => 0,
            ["to", "last"] => last,
            ["to", k] => {
                let k = count(k)?;
                if k > last {
                    return Err(CommandError::Refused(format!("no pivot {k}: the pivots are 0 … {last}")));
                }
                if k > recorded && k < last {
                    return Err(CommandError::Refused(format!(
                        "pivot {k} was counted but not recorded: there are 0 … {recorded} and the last, {last}"
                    )));
                }
                k
            }
            [n] => here.saturating_add(count(n)?),
            _ => {
                return Err(CommandError::Refused("step: expected N, back N, to K, first or last".into()));
            }
        }
        .min(last);
        // Between the last record and the end nothing can be shown: forward leads to the end, back to the record.
        let to = if to > recorded && to < last { if to > here { last } else { recorded } } else { to };
        self.position = (to < last).then_some(to);
        self.report_step(to, last, to == here, io)
    }

    /// The sentence of the pivot that `step` came to.
    pub(in crate::session) fn report_step(
        &self,
        to: usize,
        last: usize,
        stayed: bool,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let pivot = answer.pivots.iter().find(|pivot| pivot.step == to);
        io.report(&StepReport { step: to, last, pivot, stayed })?;
        Ok(())
    }
}

/// The pivot that `step` came to.
#[derive(Serialize)]
struct StepReport<'a> {
    step: usize,
    last: usize,
    pivot: Option<&'a PivotRecord>,
    #[serde(skip)]
    stayed: bool,
}

impl Report for StepReport<'_> {
    fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        let sentence = self.pivot.map_or("", |pivot| pivot.sentence.as_str());
        let end = match (self.stayed, self.step == self.last, self.step == 0) {
            (true, true, _) => " (the last pivot)",
            (true, _, true) => " (the first pivot)",
            _ => "",
        };
        let label = format!("{} of {}{end}: ", view::pivots::title(self.step), self.last);
        for line in style.hanging(&label, &style.text(sentence)) {
            writeln!(out, "{line}")?;
        }
        Ok(())
    }
}
