//! `new`: a scenario to begin with, from the template of its kind.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::super::{CommandError, Output, Session, Setup, worker};
use crate::export::atomic;
use crate::model::embedded;
use crate::model::scenario::Scenario;
use crate::model::template::{self, Choice, Template};
use crate::view;
use crate::watch::Watch;

/// Every kind with its title and what can be chosen of it.
///
/// # Errors
/// A template is broken, which a test excludes.
pub fn kinds() -> Result<Vec<(&'static Template, String, Vec<Choice>)>, CommandError> {
    let of = |template: &'static Template| {
        let scenario = template.default_scenario().map_err(refused)?;
        let choices = template.choices(&scenario);
        Ok((template, scenario.title, choices))
    };
    template::ALL.iter().map(of).collect()
}

fn refused(error: template::TemplateError) -> CommandError {
    CommandError::Refused(format!("new: {error}"))
}

/// Writes the scenario of a kind to its file, which must not be there yet. `words` are `NAME=VALUE` and at most one file.
///
/// # Errors
/// Words that do not fit the kind, a file that is there or cannot be written, an interruption: then nothing is written.
pub fn write(kind: &str, words: &[String], watch: &dyn Watch) -> Result<(PathBuf, Scenario), CommandError> {
    let template = template::find(kind).map_err(refused)?;
    let mut given = Vec::new();
    let mut file = None;
    for word in words {
        match word.split_once('=') {
            Some((name, value)) => given.push((name.to_owned(), value.to_owned())),
            None => {
                if let Some(before) = file.replace(PathBuf::from(word)) {
                    return Err(CommandError::Refused(format!(
                        "new: {} and {word} cannot both be the file; a value is written NAME=VALUE, without blanks",
                        before.display()
                    )));
                }
            }
        }
    }
    let path = file.unwrap_or_else(|| PathBuf::from(format!("{kind}.json")));
    let place = path.clone();
    let scenario = worker::run(watch, move |_| template.scenario(&given, &place))?.map_err(refused)?;
    atomic::create(&path, |out| out.write_all(scenario.text.as_bytes()))
        .map_err(|error| CommandError::Refused(format!("new: {error}")))?;
    Ok((path, scenario))
}

/// How a file is named in a command: one that would be taken for an embedded scenario or an option has its folder.
pub fn typed(path: &Path) -> String {
    let name = path.display().to_string();
    let place = if embedded::text(&name).is_some() || name.starts_with('-') { "./" } else { "" };
    super::super::tokens::quote(&format!("{place}{name}"))
}

impl Session {
    /// `new`.
    pub(in crate::session) fn new_scenario(
        &mut self,
        kind: Option<&str>,
        words: &[String],
        text: &str,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let Some(kind) = kind else {
            let kinds = kinds()?;
            let json = || kinds.iter().map(|(template, title, choices)| listed(template, title, choices)).collect();
            io.report(json, |out, style| view::templates::write(out, &kinds, style))?;
            return Ok(());
        };
        let (path, scenario) = write(kind, words, io.watch)?;
        let mut notes = vec![format!("wrote {}", path.display())];
        notes.push(format!("{}: {}", scenario.name, scenario.title));
        notes.extend(scenario.description.clone());
        let changed = self.change_noting(Setup::of(scenario), text, &notes, io);
        if matches!(&changed, Err(error) if !error.is_output()) {
            // the file is ours and nothing refers to it: a command that fails leaves nothing behind
            let _ = std::fs::remove_file(&path);
        }
        changed
    }
}

fn listed(template: &Template, title: &str, choices: &[Choice]) -> Value {
    let choices = choices.iter().map(|choice| {
        json!({
            "name": choice.name, "value": choice.default, "unit": choice.unit, "count": choice.count,
            "min": choice.range.map(|range| range.0), "max": choice.range.map(|range| range.1), "about": choice.about,
        })
    });
    json!({ "kind": template.kind, "title": title, "names": choices.collect::<Vec<_>>() })
}
