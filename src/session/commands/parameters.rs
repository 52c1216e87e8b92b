//! `params`, `diff`: the parameters, and what differs from the file.

use std::io::{self, Write};

use clap::Args;
use serde::Serialize;

use crate::session::language::command::{Action, Command};
use crate::session::language::setting::RULES;
use crate::session::{CommandError, Next, Output, Report, Session};
use crate::text::number::with_unit;
use crate::view;
use crate::view::style::Style;

/// Show the parameters, their values and ranges
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  params")]
pub struct Params;

pub const PARAMS: Command = Command::of::<Params>("params");

impl Action for Params {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_parameters(io)?;
        Ok(Next::Continue)
    }
}

/// Show what differs from the file
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  set F2 150; diff")]
pub struct Diff;

pub const DIFF: Command = Command::of::<Diff>("diff");

impl Action for Diff {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.report_difference(io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    pub(in crate::session) fn report_parameters(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = &self.now.scenario;
        let row = |(name, value): (&String, &f64)| {
            let file = scenario.parameters.get(name);
            ParameterRow {
                name: name.clone(),
                value: *value,
                file: file.map(|p| p.value),
                formula: file.and_then(|p| Some(p.formula.as_ref()?.text().to_owned())),
                min: file.and_then(|p| p.min),
                max: file.and_then(|p| p.max),
                step: file.and_then(|p| p.step),
                unit: file.and_then(|p| p.unit.clone()),
                about: file.and_then(|p| p.about.clone()),
            }
        };
        let rows: Vec<ParameterRow> = self.now.values.iter().map(row).collect();
        io.show(&rows, |out, style| view::parameters::write(out, scenario, &self.now.values, style))?;
        Ok(())
    }

    /// `diff`: against the file.
    pub(in crate::session) fn report_difference(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = &self.now.scenario;
        let mut rows: Vec<Differing<'_>> = Vec::new();
        for (name, value) in &self.now.values {
            let Some(file) = scenario.parameters.get(name) else {
                continue;
            };
            if file.value.to_bits() != value.to_bits() {
                let (was, now) = (file.value.to_string(), value.to_string());
                rows.push(Differing { name, file: was, now, unit: file.unit.as_deref() });
            }
        }
        for rule in &RULES {
            let (file, now) = ((rule.shown)(&scenario.rules), (rule.shown)(&self.now.rules));
            if file != now {
                rows.push(Differing { name: rule.name, file, now, unit: None });
            }
        }
        io.report(&Difference(rows))?;
        Ok(())
    }
}

/// A parameter in `params`.
#[derive(Serialize)]
struct ParameterRow {
    name: String,
    value: f64,
    file: Option<f64>,
    formula: Option<String>,
    min: Option<f64>,
    max: Option<f64>,
    step: Option<f64>,
    unit: Option<String>,
    about: Option<String>,
}

/// What differs from the file.
#[derive(Serialize)]
struct Difference<'a>(Vec<Differing<'a>>);

#[derive(Serialize)]
struct Differing<'a> {
    name: &'a str,
    file: String,
    now: String,
    #[serde(skip)]
    unit: Option<&'a str>,
}

impl Report for Difference<'_> {
    fn write(&self, out: &mut dyn Write, style: &Style) -> io::Result<()> {
        if self.0.is_empty() {
            return writeln!(out, "nothing differs from the file");
        }
        for Differing { name, file, now, unit } in &self.0 {
            let line = format!("{name:<14} {} (file: {file})", with_unit(now, *unit));
            writeln!(out, "{}", style.text(&line))?;
        }
        Ok(())
    }
}
