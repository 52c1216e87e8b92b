//! `set`, `reset`: values of parameters and rules.

use clap::Args;

use crate::model::parameter::Parameter;
use crate::session::journal::Record;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::setting::{self, SetError, Setting, rules_of};
use crate::session::{CommandError, Next, Output, Session};
use crate::text::number::short;

/// Change a parameter or a rule, and solve again
///
/// VALUE is a number; `110%` of the present value; `+10%` or `-10%` more or less than it; or `+= 10`, `-= 10`,
/// `*= 2`, `/= 2`. A value outside min … max is accepted: the range is the slider's.
///
/// Rules: `set covering cohesive|ones|weight`, `set tie-break lexicographic|natural|first-row|random:SEED`, `set engine
/// scheme|tableau|exact`; they hold for `solve`, not for the rate problems of `stages`. `set auto off` stops solving
/// after each change until `solve` or `set auto on`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  set F2 120\n  set F2 += 10\n  set f 110%\n  set covering weight")]
pub struct Set {
    /// Parameter, or auto, covering, tie-break, engine; then the value
    #[arg(value_name = "SETTING", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const SET: Command =
    Command { usage: Some("NAME VALUE"), complete: settings, offer: present_value, ..Command::of::<Set>("set") };

impl Action for Set {
    fn run(&self, session: &mut Session, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.set(&self.words, text, io)?;
        Ok(Next::Continue)
    }
}

/// What may follow `set`.
fn settings(asked: &Asked<'_>) -> Vec<Candidate> {
    match asked.given {
        [] => {
            let mut all = parameters_and_rules(asked);
            all.push(Candidate::new("auto", "solve after each change"));
            all
        }
        [name] if name == "auto" => Candidate::plain(["on", "off"]),
        [name] => Candidate::plain(setting::rule(name).map_or(&["+=", "-=", "*=", "/="][..], |rule| rule.choices)),
        _ => Vec::new(),
    }
}

fn parameters_and_rules(asked: &Asked<'_>) -> Vec<Candidate> {
    let mut all = asked.parameters();
    all.extend(rules_of(asked.names.dimension).map(|rule| Candidate::new(rule.name, rule.about)));
    all
}

/// The value of the parameter that is named.
fn present_value(asked: &Asked<'_>) -> Option<String> {
    let [name] = asked.given else { return None };
    let (_, value) = asked.names.parameters.iter().find(|(known, _)| known == name)?;
    Some(value.to_string())
}

/// Put a parameter, or everything, back to the value of the file
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  reset F2\n  reset")]
pub struct Reset {
    /// Parameter; without it all of them and the rules
    #[arg(value_name = "PARAMETER")]
    name: Option<String>,
}

pub const RESET: Command = Command { complete: parameters_and_rules, ..Command::of::<Reset>("reset") };

impl Action for Reset {
    fn run(&self, session: &mut Session, text: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.reset(self.name.as_deref(), text, io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    fn set(&mut self, words: &[String], text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let setting = setting::read(words, &self.now.scenario, &self.now.values)?;
        if let Setting::Auto(auto) = setting {
            return self.set_auto(auto, io);
        }
        let mut next = self.now.clone();
        next.take(&setting)?;
        let mut notes = Vec::new();
        if let Setting::Parameter(name, value) = &setting {
            if let Some(refusal) = next.scenario.law_refusal(&next.values) {
                return Err(SetError::Value(refusal).into());
            }
            notes.extend(next.scenario.parameters.get(name).and_then(|parameter| outside(name, parameter, *value)));
        }
        self.change_noting(next, text, &notes, io)
    }

    fn set_auto(&mut self, auto: bool, io: &mut Output<'_>) -> Result<(), CommandError> {
        if auto && self.solved.is_none() {
            let solved = self.now.solve(io.watch)?;
            self.take_answer(Some(solved));
        }
        let news = self.auto != auto;
        self.auto = auto;
        let now = self.now.clone();
        let note = if news { self.note_in_journal(&now, |_| Record::Auto(auto)) } else { None };
        if auto {
            return self.say_what_changed(note.as_slice(), io);
        }
        let said = "changes are collected until `solve` or `set auto on`".to_owned();
        Ok(io.say(&[Some(said), note].into_iter().flatten().collect::<Vec<_>>().join("; "))?)
    }

    fn reset(&mut self, name: Option<&str>, text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let mut next = self.now.clone();
        let file = next.scenario.parameter_values();
        let rules = next.scenario.rules;
        match name {
            None => {
                next.values = file;
                next.rules = rules;
            }
            Some(name) => {
                if let Some(rule) = setting::rule(name) {
                    (rule.set)(&mut next.rules, &(rule.shown)(&rules)).map_err(SetError::Choice)?;
                    return self.change(next, text, io);
                }
                let value = *file.get(name).ok_or_else(|| setting::unknown_parameter(name, &next.scenario))?;
                if let Some(refusal) = next.scenario.refusal(name, value) {
                    return Err(CommandError::Refused(refusal));
                }
                next.values.insert(name.to_owned(), value);
            }
        }
        self.change(next, text, io)
    }
}

/// What is said of a value outside the range of the slider.
fn outside(name: &str, parameter: &Parameter, value: f64) -> Option<String> {
    let inside = parameter.min.is_none_or(|min| value >= min) && parameter.max.is_none_or(|max| value <= max);
    let end = |end: Option<f64>| end.map_or("…".to_owned(), short);
    let (min, max) = (end(parameter.min), end(parameter.max));
    (!inside).then(|| format!("{name} = {} lies outside {min} … {max}, the range of its slider", short(value)))
}
