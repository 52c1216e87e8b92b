//! `reload`, `edit`, `watch`: a scenario that is written in another window, or in an editor.

use std::path::Path;
use std::sync::Arc;

use clap::{Args, ValueEnum};

use crate::model::load::at_values;
use crate::model::scenario::{Scenario, Source};
use crate::session::language::command::{Action, Command};
use crate::session::language::setting::{RULES, rules_of};
use crate::session::language::tokens;
use crate::session::{CommandError, Next, Output, Session, Setup, introduction, load};
use crate::text::file::reason;
use crate::text::number::short;

/// Open the file of the scenario in your editor; read it again when that ends
///
/// The editor is that of the variable VISUAL, or else of EDITOR, or else vi; words after its name are options for it.
/// An embedded scenario has no file: `save FILE` gives it one. Only at the prompt or in the full screen.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  save beam.json; edit")]
pub struct Edit;

pub const EDIT: Command = Command { in_0_1: false, ..Command::of::<Edit>("edit") };

impl Action for Edit {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.edit(io)
    }
}

/// Read the file of the scenario again
///
/// Values and rules that were set are kept where they still fit the file, and it is said which do not. `undo` goes back
/// to the text before.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  reload")]
pub struct Reload;

pub const RELOAD: Command = Command { in_0_1: false, ..Command::of::<Reload>("reload") };

impl Action for Reload {
    fn run(&self, session: &mut Session, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.reload(text, io)?;
        Ok(Next::Continue)
    }
}

/// The word of `watch`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Switch {
    /// From now on
    On,
    /// No longer
    Off,
}

/// Read the file of the scenario again whenever it is saved, say in another window
///
/// Also the meshes it names. As with `reload` values that were set are kept where they fit. A file with an error is told
/// with the place, and the last good answer stays. Only at the prompt or in the full screen.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  watch on; watch off\n  watch")]
pub struct Watch {
    /// On or off; without it, what is watched
    #[arg(value_name = "SWITCH")]
    how: Option<Switch>,
}

pub const WATCH: Command = Command { in_0_1: false, ..Command::of::<Watch>("watch") };

impl Action for Watch {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.watch(self.how, io)?;
        Ok(Next::Continue)
    }
}

/// The editor where the user has named none.
const EDITOR: &str = "vi";

impl Session {
    /// The file of the scenario, which `what` needs.
    fn own_file(&self, what: &str) -> Result<&Path, CommandError> {
        let scenario = self.scenario();
        scenario.path.as_deref().ok_or_else(|| {
            CommandError::Refused(format!(
                "{what}: `{name}` is an embedded scenario and has no file; `save {name}.json` gives it one",
                name = scenario.name
            ))
        })
    }

    /// `reload`: the text of the file as it is now, under the values and rules that were set, as far as they still fit.
    fn reload(&mut self, text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = load::file(self.own_file("reload")?, io.watch)?;
        let name = scenario.name.clone();
        // the other files that a scenario names may have changed
        if scenario.text == self.scenario().text && !scenario.text.contains("\"file\"") {
            return self.say_what_changed(&[format!("{name} is as it was")], io);
        }
        let carried = Carried::of(&self.now, scenario);
        let mut notes = vec![match carried.dropped.as_slice() {
            [] => format!("{name} read again"),
            dropped => format!("{name} read again, without {}", dropped.join("; ")),
        }];
        if !carried.kept.is_empty() {
            notes.push(format!("kept: {}", carried.kept.join(", ")));
        }
        notes.extend(introduction(&carried.setup.scenario));
        self.change_noting(carried.setup, text, &notes, io)
    }

    /// `edit`: the face runs the editor and then reloads.
    fn edit(&self, io: &Output<'_>) -> Result<Next, CommandError> {
        self.needs_hands("edit", "opens an editor", io)?;
        self.own_file("edit")?;
        Ok(Next::Edit)
    }

    /// `watch`.
    fn watch(&mut self, how: Option<Switch>, io: &mut Output<'_>) -> Result<(), CommandError> {
        if how == Some(Switch::On) {
            self.needs_hands("watch on", "shows changes as they come", io)?;
            self.own_file("watch on")?;
        }
        self.watches = how.map_or(self.watches, |how| how == Switch::On);
        let name = &self.scenario().name;
        let said = match (self.watches, self.scenario().path.is_some()) {
            (false, _) => "no file is watched".to_owned(),
            (true, true) => format!("{name} is watched: whenever it is saved, it is read again and solved"),
            (true, false) => format!("`{name}` has no file to watch; the next scenario that has one is watched"),
        };
        Ok(io.say(&said)?)
    }

    /// The scenario whose files are to be watched, if any is.
    pub fn watched(&self) -> Option<Arc<Scenario>> {
        self.watches.then(|| self.shared_scenario()).filter(|scenario| scenario.path.is_some())
    }

    /// What is done by hand only.
    fn needs_hands(&self, command: &str, does: &str, io: &Output<'_>) -> Result<(), CommandError> {
        if self.depth == 0 && io.has_screen {
            return Ok(());
        }
        Err(CommandError::Refused(format!(
            "`{command}` {does}, which needs somebody at a terminal that understands cursor codes: in a script and \
             on a pipe it is refused, `reload` is not"
        )))
    }
}

/// A scenario that was read again, with what had been set before.
struct Carried {
    setup: Setup,
    /// `f = 0.3`.
    kept: Vec<String>,
    /// `x = 3 (there is no such parameter any more)`.
    dropped: Vec<String>,
}

impl Carried {
    fn of(now: &Setup, scenario: Scenario) -> Carried {
        let mut carried = Carried { setup: Setup::of(scenario), kept: Vec::new(), dropped: Vec::new() };
        let file = now.scenario.parameter_values();
        // only what was set differs from its file
        let set = now.values.free().filter(|(name, value)| file[*name].to_bits() != value.to_bits());
        for (name, value) in set {
            let said = format!("{name} = {}", short(value));
            match carried.put(name, value) {
                None => carried.kept.push(said),
                Some(why) => carried.dropped.push(format!("{said} ({why})")),
            }
        }
        carried.check_together();
        carried.keep_rules(now);
        carried
    }

    /// Sets a value; why not, where it does not fit.
    fn put(&mut self, name: &str, value: f64) -> Option<String> {
        let setup = &mut self.setup;
        let Some(&before) = setup.values.get(name) else {
            return Some("there is no such parameter any more".to_owned());
        };
        if setup.values.formula(name).is_some() {
            return Some("it is a formula now".to_owned());
        }
        setup.values.insert(name.to_owned(), value);
        let refusal = setup.scenario.law_refusal(&setup.values);
        if refusal.is_some() {
            setup.values.insert(name.to_owned(), before);
        }
        refusal
    }

    /// Values may make a model invalid that is valid with those of its file.
    fn check_together(&mut self) {
        let file = self.setup.scenario.parameter_values();
        if self.kept.is_empty() {
            return;
        }
        if let Err(problems) = at_values(&self.setup.scenario, &self.setup.values) {
            let why = problems.problems.first().map_or(String::new(), |problem| problem.message.clone());
            self.setup.values = file;
            self.dropped.push(format!("{} ({why})", self.kept.drain(..).collect::<Vec<_>>().join(", ")));
        }
    }

    fn keep_rules(&mut self, now: &Setup) {
        for rule in &RULES {
            let was = (rule.shown)(&now.rules);
            if was == (rule.shown)(&now.scenario.rules) {
                continue;
            }
            let said = format!("{} {was}", rule.name);
            let scenario = &self.setup.scenario;
            let misfit = match rule.name {
                "covering" if matches!(scenario.source, Source::Lcp(_)) => Some("a bare LCP has its own"),
                name if rules_of(scenario.source.dimension()).all(|known| known.name != name) => {
                    Some("it is for problems in space")
                }
                _ => None,
            };
            match misfit {
                Some(why) => self.dropped.push(format!("{said} ({why})")),
                None if (rule.set)(&mut self.setup.rules, &was).is_ok() => self.kept.push(said),
                None => {}
            }
        }
    }
}

/// Opens a file in the editor of the user and waits for its end; the terminal must be as the shell left it.
///
/// # Errors
/// No such editor; one that ended with an error.
pub fn open_editor(path: &Path) -> Result<(), CommandError> {
    let named = |name| std::env::var(name).ok().filter(|value| !value.trim().is_empty());
    let editor = named("VISUAL").or_else(|| named("EDITOR")).unwrap_or_else(|| EDITOR.to_owned());
    let words = tokens::split(&editor).map_err(|error| CommandError::Refused(format!("edit: {error}")))?;
    let failed = |what: String| CommandError::Refused(format!("edit: {what}"));
    let Some((program, arguments)) = words.split_first() else {
        return Err(failed("VISUAL and EDITOR name no program".into()));
    };
    let ended = std::process::Command::new(program).args(arguments).arg(path).status();
    let status = ended.map_err(|error| {
        failed(format!(
            "cannot start `{program}`: {}; set the variable VISUAL or EDITOR to your editor",
            reason(&error)
        ))
    })?;
    if status.success() {
        return Ok(());
    }
    Err(failed(format!("`{program}` ended with {status}: nothing is read again; `reload` does it all the same")))
}
