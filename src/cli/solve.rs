//! `solve`.

use std::io::{self, Write};

use clap::Args;

use super::ending::Failure;
use super::input::Form;
use super::settings::Settings;
use crate::export::json as json_export;
use crate::model::embedded;
use crate::session::{Answer, History, HistoryEnd, Session, exit_status};
use crate::signals::{Signals, TerminalWatch};
use crate::view;
use crate::view::style::{Role, Style};

/// Solve a scenario and print the answer
#[derive(Args, Debug)]
pub struct Solve {
    /// A file, or an embedded scenario; `-` reads one from stdin
    #[arg(default_value = embedded::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    settings: Settings,
    /// For people, or the JSON of the whole result
    #[arg(long, value_enum, default_value_t = Form::Text)]
    format: Form,
    /// Show how long it took
    #[arg(long)]
    timings: bool,
    /// Solve a scenario with stages in one step, all load cases with their factors, instead of following its history
    #[arg(long)]
    at_once: bool,
}

impl Solve {
    pub(super) fn run(&self, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let signals = Signals::install()?;
        let watch = TerminalWatch::new(&signals);
        let mut session = self.settings.session(&self.scenario, &watch)?;
        if !self.at_once && !session.scenario().stages.is_empty() {
            let history = session.follow_stages(&watch);
            watch.clear();
            return write_history(&session, &*history?, self, style, out);
        }
        let Some(answer) = session.answer() else {
            return Err(Failure::Status(4, "no answer".to_owned()));
        };
        match self.format {
            Form::Json => {
                let result = session.result(self.timings).unwrap_or_default();
                writeln!(out, "{}", json_export::pretty(&result)?)?;
            }
            Form::Text => write_answer(&session, answer, self.timings, style, out)?,
        }
        out.flush()?;
        Ok(exit_status(answer))
    }
}

/// The end of a load history, and its stages.
fn write_history(
    session: &Session,
    history: &History,
    arguments: &Solve,
    style: &Style,
    out: &mut dyn Write,
) -> Result<u8, Failure> {
    let scenario = session.scenario();
    let nothing = || Failure::Status(4, "no answer".to_owned());
    let answer = &*history.outcome().ok_or_else(nothing)?;
    if arguments.format == Form::Json {
        let result = session.result(arguments.timings).ok_or_else(nothing)?;
        writeln!(out, "{}", json_export::pretty(&result)?)?;
    } else {
        let note = match history.end {
            HistoryEnd::Broken(_) => "the load history broke down; this is the end of the last stage before",
            HistoryEnd::Complete | HistoryEnd::Limit { .. } => "the load history was followed, this is its end",
        };
        style.paragraph(out, Role::Muted, &format!("{note} (`--at-once`: all load cases at once)"))?;
        if arguments.settings.has_rules() {
            let note = "the covering, the tie-break and the engine chosen do not reach its rate problems: they are solved \
                        under the default rules";
            style.paragraph(out, Role::Muted, note)?;
        }
        view::status::write(out, answer, scenario, session.values(), style)?;
        writeln!(out)?;
        view::stages::write(out, history, &scenario.units, style)?;
        writeln!(out)?;
        view::pairs::write(out, &answer.pairs, &scenario.units, style)?;
        if let Some(ray) = &answer.ray {
            writeln!(out)?;
            view::ray::write(out, ray, &scenario.units, style)?;
        }
        if arguments.timings {
            write_timings(answer, out)?;
        }
    }
    out.flush()?;
    Ok(exit_status(answer))
}

fn write_timings(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let t = &answer.timings;
    writeln!(
        out,
        "\nfactor {:.6} s, condense {:.6} s, lemke {:.6} s, total {:.6} s",
        t.factor, t.condense, t.lemke, t.total
    )
}

/// Status, pivots, pairs, ray: what one wants to see of an answer at once.
fn write_answer(
    session: &Session,
    answer: &Answer,
    timings: bool,
    style: &Style,
    out: &mut dyn Write,
) -> Result<(), Failure> {
    let scenario = session.scenario();
    let units = &scenario.units;
    view::status::write(out, answer, scenario, session.values(), style)?;
    if !answer.pivots.is_empty() {
        writeln!(out)?;
        view::pivots::write(out, answer, None, None, units, style)?;
    }
    writeln!(out)?;
    if answer.solution.is_some() || !answer.pairs.is_empty() {
        session.write_pairs(out, style)?;
    }
    if let Some(ray) = &answer.ray {
        writeln!(out)?;
        view::ray::write(out, ray, units, style)?;
    }
    if timings {
        write_timings(answer, out)?;
    }
    Ok(())
}
