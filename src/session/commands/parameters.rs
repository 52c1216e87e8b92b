//! `params`, `diff`: the parameters, and what differs from the file.

use clap::Args;
use serde_json::json;

use crate::session::language::command::{Action, Command};
use crate::session::language::setting::RULES;
use crate::session::{CommandError, Next, Output, Session};
use crate::text::number::with_unit;
use crate::view;

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
        io.report(
            || {
                self.now
                    .values
                    .iter()
                    .map(|(name, value)| {
                        let file = scenario.parameters.get(name);
                        json!({
                            "name": name,
                            "value": value,
                            "file": file.map(|p| p.value),
                            "formula": file.and_then(|p| Some(p.formula.as_ref()?.text().to_owned())),
                            "min": file.and_then(|p| p.min),
                            "max": file.and_then(|p| p.max),
                            "step": file.and_then(|p| p.step),
                            "unit": file.and_then(|p| p.unit.clone()),
                            "about": file.and_then(|p| p.about.clone()),
                        })
                    })
                    .collect()
            },
            |out, style| view::parameters::write(out, scenario, &self.now.values, style),
        )?;
        Ok(())
    }

    /// `diff`: against the file.
    pub(in crate::session) fn report_difference(&self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = &self.now.scenario;
        let mut rows: Vec<(String, String, String, Option<&str>)> = Vec::new();
        for (name, value) in &self.now.values {
            let Some(file) = scenario.parameters.get(name) else {
                continue;
            };
            if file.value.to_bits() != value.to_bits() {
                rows.push((name.clone(), file.value.to_string(), value.to_string(), file.unit.as_deref()));
            }
        }
        for rule in &RULES {
            let (file, now) = ((rule.shown)(&scenario.rules), (rule.shown)(&self.now.rules));
            if file != now {
                rows.push((rule.name.to_owned(), file, now, None));
            }
        }
        io.report(
            || rows.iter().map(|(name, file, now, _)| json!({"name": name, "file": file, "now": now})).collect(),
            |out, style| {
                if rows.is_empty() {
                    return writeln!(out, "nothing differs from the file");
                }
                for (name, file, now, unit) in &rows {
                    let line = format!("{name:<14} {} (file: {file})", with_unit(now, *unit));
                    writeln!(out, "{}", style.text(&line))?;
                }
                Ok(())
            },
        )?;
        Ok(())
    }
}
