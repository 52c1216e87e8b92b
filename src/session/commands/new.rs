//! `new`: a scenario to begin with, from the template of its kind.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::export::atomic;
use crate::model::embedded;
use crate::model::scenario::Scenario;
use crate::model::template::{self, Choice, Template};
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::tokens;
use crate::session::{CommandError, Next, Output, Session, Setup, worker};
use crate::view;
use crate::watch::Watch;

/// Write a scenario to begin with, load it and solve it; without KIND, list the kinds
///
/// The kinds are portal, continuous-beam, pipeline, block, block-stack, wall, arch, dam, footing, retaining-wall and
/// press-fit. Their dimensions are parameters, or counts of parts: NAME=VALUE chooses any of them, the others stay as
/// `new` lists them. The file has comments, which `save` keeps, and is KIND.json if none is named; one that is there
/// already stays as it is.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  new\n  new wall courses=5 bricks=4 f=0.5 wall-5.json")]
pub struct New {
    /// What to begin with
    #[arg(value_name = "KIND")]
    kind: Option<String>,
    /// Values of its parameters and counts, and the file
    #[arg(value_name = "NAME=VALUE FILE")]
    words: Vec<String>,
}

pub const NEW: Command = Command {
    in_0_1: false,
    usage: Some("KIND [NAME=VALUE…] [FILE]"),
    complete: candidates,
    without_scenario: true,
    ..Command::of::<New>("new")
};

impl Action for New {
    fn run(&self, session: &mut Session, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.new_scenario(self.kind.as_deref(), &self.words, text, io)?;
        Ok(Next::Continue)
    }

    fn loads(&self) -> bool {
        self.kind.is_some()
    }
}

/// The kind; then what can be chosen of it, except for what was chosen already, and the file.
fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    let [kind, given @ ..] = asked.given else {
        return Candidate::plain(template::ALL.iter().map(|template| template.kind));
    };
    let mut all = asked.files();
    let chosen = |name: &str| given.iter().any(|word| word.split_once('=').is_some_and(|(known, _)| known == name));
    if let Ok(template) = template::find(kind)
        && let Ok(scenario) = template.default_scenario()
    {
        let choices = template.choices(&scenario).into_iter().filter(|choice| !chosen(&choice.name));
        all.extend(choices.map(|choice| Candidate::new(format!("{}=", choice.name), choice.about)));
    }
    all
}

/// A kind with its title and what can be chosen of it.
pub type Offered = (&'static Template, String, Vec<Choice>);

/// Every kind.
///
/// # Errors
/// A template is broken, which a test excludes.
pub fn kinds() -> Result<Vec<Offered>, CommandError> {
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
    if path.as_os_str().is_empty() {
        return Err(CommandError::Refused("new: the name of the file is empty; leave it out for KIND.json".into()));
    }
    let place = path.clone();
    let scenario = worker::run(watch, move |_| template.scenario(&given, &place))?.map_err(refused)?;
    atomic::create(&path, |out| out.write_all(scenario.text.as_bytes()))
        .map_err(|error| CommandError::Refused(format!("new: {error}")))?;
    Ok((path, scenario))
}

/// A note for each value that lies outside the range its kind has for it: the slider was widened, the kind was not made
/// for that.
///
/// # Errors
/// The template is broken, which a test excludes.
pub fn beyond_range(kind: &str, scenario: &Scenario) -> Result<Vec<String>, CommandError> {
    let usual = template::find(kind).and_then(Template::default_scenario).map_err(refused)?;
    let outside = scenario.parameters.iter().filter_map(|(name, parameter)| {
        let (min, max) = usual.parameters.get(name).and_then(|usual| usual.min.zip(usual.max))?;
        let is_outside = parameter.formula.is_none() && !(min..=max).contains(&parameter.value);
        is_outside.then(|| format!("{name} = {} lies outside {min} … {max}, the usual range", parameter.value))
    });
    Ok(outside.collect())
}

/// How a file is named in a command: one that would be taken for an embedded scenario or an option has its folder.
pub fn typed(path: &Path) -> String {
    let name = path.display().to_string();
    let place = if embedded::text(&name).is_some() || name.starts_with('-') { "./" } else { "" };
    tokens::quote(&format!("{place}{name}"))
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
            let listed: Vec<Kind<'_>> =
                kinds.iter().map(|(template, title, choices)| kind_of(template, title, choices)).collect();
            io.show(&listed, |out, style| view::templates::write(out, &kinds, style))?;
            return Ok(());
        };
        let (path, scenario) = write(kind, words, io.watch)?;
        let mut notes = vec![format!("wrote {}", path.display())];
        notes.extend(beyond_range(kind, &scenario)?);
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

/// A kind, as listed for programs.
#[derive(Serialize)]
struct Kind<'a> {
    kind: &'a str,
    title: &'a str,
    names: Vec<Named<'a>>,
}

/// What can be chosen of it.
#[derive(Serialize)]
struct Named<'a> {
    name: &'a str,
    value: f64,
    unit: Option<&'a str>,
    count: bool,
    min: Option<f64>,
    max: Option<f64>,
    about: &'a str,
}

fn kind_of<'a>(template: &'a Template, title: &'a str, choices: &'a [Choice]) -> Kind<'a> {
    let named = |choice: &'a Choice| Named {
        name: &choice.name,
        value: choice.default,
        unit: choice.unit.as_deref(),
        count: choice.count,
        min: choice.range.map(|range| range.0),
        max: choice.range.map(|range| range.1),
        about: &choice.about,
    };
    Kind { kind: template.kind, title, names: choices.iter().map(named).collect() }
}
