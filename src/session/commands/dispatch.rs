//! Command → change of the session. A change is made ready and solved on the side and taken over only when all of
//! it succeeded.

use std::io::Write;
use std::sync::Arc;

use serde_json::{Value, json};

use crate::answer::record::Start;
use crate::model::embedded;
use crate::model::load::at_values;
use crate::model::quantity::Quantity;
use crate::model::uses::Redone;
use crate::solve::Prepared;
use crate::solve::follow::same_answer;
use crate::view::number::short;
use crate::view::status;
use crate::view::style::Role;

use crate::session::journal::Record;
use crate::session::language::command::Command;
use crate::session::language::expect;
use crate::session::language::setting::{self, Setting};
use crate::session::{
    Change, CommandError, Format, Next, Output, Session, Setup, commands::import, commands::save, commands::script,
    language::help, load,
};

impl Session {
    /// One command. The arms that only show something are in `reports`.
    pub(in crate::session) fn apply(
        &mut self,
        command: Command,
        text: &str,
        io: &mut Output<'_>,
    ) -> Result<Next, CommandError> {
        if command.needs_pivots() {
            self.ensure_pivots(io)?;
        }
        match command {
            Command::Load { scenario } => self.load(&scenario, text, io)?,
            Command::New { kind, words } => self.new_scenario(kind.as_deref(), &words, text, io)?,
            Command::Scenarios => scenarios(io)?,
            Command::Save { file } => self.save(file.as_deref(), io)?,
            Command::Params => self.report_parameters(io)?,
            Command::Set { words } => self.set(&words, text, io)?,
            Command::Reset { name } => self.reset(name.as_deref(), text, io)?,
            Command::Undo => self.undo(io)?,
            Command::Redo => self.redo(io)?,
            Command::Diff => self.report_difference(io)?,
            Command::Solve => self.solve_again(io)?,
            Command::Status => self.report_status(io)?,
            Command::Pairs { words } => self.report_pairs(&words, io)?,
            Command::Displacements { words } => self.report_displacements(&words, io)?,
            Command::Members { words } => self.report_members(&words, io)?,
            Command::Reactions => self.report_reactions(io)?,
            Command::Show { words } => self.show(&words, io)?,
            Command::Summary => self.summary(io)?,
            Command::Combine { name } => self.combine(name.as_deref(), io)?,
            Command::Envelope { words } => self.envelope(&words, io)?,
            Command::Check { how: None } => self.report_check(io)?,
            Command::Check { how: Some(_) } => self.check_exactly(io)?,
            Command::Pivots { range } => self.report_pivots(range.as_deref(), io)?,
            Command::Step { words } => self.step(&words, io)?,
            Command::Why { pair } => self.report_why(&pair, io)?,
            Command::Ties => self.report_ties(io)?,
            Command::Tableau => self.report_tableau(io)?,
            Command::Compare => self.compare(io)?,
            Command::Enumerate { answer } => self.enumerate(answer, io)?,
            Command::Critical { friction } => self.critical(&friction, io)?,
            Command::Ray => self.report_ray(io)?,
            Command::Plot { picture, at, width, height, of } => self.plot(picture, &at, width, height, &of, io)?,
            Command::Trace { name, to, through } => self.trace(&name, &to, through, io)?,
            Command::Limit { name } => self.limit(&name, io)?,
            Command::Sensitivity { parameter } => self.sensitivity(parameter.as_deref(), io)?,
            Command::Find { words } => self.find(&words, io)?,
            Command::Map { words } => self.draw_map(&words, io)?,
            Command::Stages { stage } => self.stages(stage, io)?,
            Command::Sweep { words, out, resume, shard, columns } => {
                self.sweep(&words, out.as_deref(), resume, shard, columns.as_deref(), io)?;
            }
            Command::Source { file } => return script::source(self, &file, io),
            Command::Record { file } => self.record(&file, io)?,
            Command::Expect { words } => self.expect(&words, io)?,
            Command::Export { what, words } => self.export(what, &words, io)?,
            Command::Import { file } => {
                let (written, rows) = import::import(&file, io.watch)?;
                io.say(&format!("wrote {}: an LCP of {rows} rows", written.display()))?;
            }
            Command::Echo { words } => io.say(&words.join(" "))?,
            Command::Restore { discard } => self.restore(discard.is_some(), io)?,
            Command::Help { command } => show_help(command.as_deref(), io)?,
            Command::History => self.report_history(io)?,
            Command::Tui => return self.full_screen("tui", io),
            Command::Tour => return self.full_screen("tour", io),
            Command::Quit => return Ok(Next::Quit),
        }
        Ok(Next::Continue)
    }

    /// `tui` and `tour`: typed by hand only. In a script they would end it with what it was going to test untested.
    fn full_screen(&self, word: &str, io: &Output<'_>) -> Result<Next, CommandError> {
        if self.depth > 0 || !io.has_screen {
            return Err(CommandError::Refused(format!(
                "`{word}` opens the full screen, which needs a terminal that understands cursor codes: type it at the \
                 prompt there; in a script and on a pipe it is refused"
            )));
        }
        Ok(Next::FullScreen { tour: word == "tour" })
    }

    /// Takes `next` over if it can be solved (or need not be yet), and says what changed.
    fn change(&mut self, next: Setup, text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        self.change_noting(next, text, &[], io)
    }

    /// [`Session::change`] with lines ahead of the status line.
    pub(in crate::session) fn change_noting(
        &mut self,
        next: Setup,
        text: &str,
        notes: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let mut before = self.now.clone();
        let mut notes = notes.to_vec();
        let news = !before.same_choice(&next);
        if !self.auto && before.scenario.uses.between(&before.values, &next.values) > Redone::Lcp {
            // Nothing is solved now, but values that make the model invalid are refused all the same.
            at_values(&next.scenario, &next.values).map_err(CommandError::Scenario)?;
        }
        self.enter(next, true, io)?;
        let same = |a: &Arc<Prepared>, b: &Option<Arc<Prepared>>| b.as_ref().is_some_and(|b| Arc::ptr_eq(a, b));
        if Arc::ptr_eq(&before.scenario, &self.now.scenario) {
            // One factorization for each step of a slider would fill the memory: `undo` computes it anew.
            before.prepared = before.prepared.filter(|prepared| same(prepared, &self.now.prepared));
        }
        if news {
            notes.extend(self.note_in_journal(&before, |now| Record::Change(text.to_owned(), now)));
            self.undo.push(Change { command: text.to_owned(), setup: before });
            self.redo.clear();
        }
        self.say_what_changed(&notes, io)
    }

    /// Makes `next` the present setup, with its answer; `warm`: found from the present one where that pays.
    fn enter(&mut self, mut next: Setup, warm: bool, io: &mut Output<'_>) -> Result<(), CommandError> {
        let solved = if self.auto {
            let same_geometry = match (&self.now.prepared, &next.prepared) {
                (Some(now), Some(next)) => Arc::ptr_eq(now, next),
                _ => false,
            };
            let last = self.solved.clone().filter(|_| warm && same_geometry);
            Some(next.solve_from(last, io.watch)?)
        } else {
            None
        };
        let same_scenario = Arc::ptr_eq(&self.now.scenario, &next.scenario);
        self.now = next;
        self.take_answer(solved);
        if !same_scenario {
            self.previous = None;
            self.path = None;
            self.swept = None;
        }
        Ok(())
    }

    /// An answer found by a warm start has no pivots of its own: the cold run that has them takes its place. Says so
    /// where it ends in another answer.
    ///
    /// # Errors
    /// As for a solve; the session then is as it was.
    pub fn ensure_pivots(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(warm) = self.solved.clone() else {
            return Ok(());
        };
        if warm.answer.start == Start::Cold {
            return Ok(());
        }
        let cold = self.now.clone().solve(io.watch)?;
        if !same_answer(&warm.answer, &cold.answer) && io.format == Format::Text {
            let note = "the cold run ends in another answer than the one followed so far: there are several; the \
                        one with these pivots is shown from here on";
            let note = io.style.paint(Role::Warning, note);
            writeln!(io.out, "{note}")?;
        }
        self.solved = Some(cold);
        Ok(())
    }

    /// The one line after a change.
    pub(in crate::session) fn say_what_changed(
        &self,
        notes: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let previous = self.previous_answer();
        let units = &self.now.scenario.units;
        io.report(
            || {
                let mut report = self.status_json();
                if let Value::Object(map) = &mut report
                    && !notes.is_empty()
                {
                    map.insert("notes".into(), json!(notes));
                }
                report
            },
            |out, style| {
                for note in notes {
                    for line in style.wrap(note, style.width.max(1)) {
                        writeln!(out, "{line}")?;
                    }
                }
                match self.answer() {
                    Some(answer) => {
                        writeln!(out, "{}", status::line(answer, previous, units, style))?;
                        for note in &answer.notes {
                            writeln!(out, "{}", style.paint(Role::Warning, &style.text(note)))?;
                        }
                        Ok(())
                    }
                    None => writeln!(out, "not solved yet: `solve`, or `set auto on`"),
                }
            },
        )?;
        Ok(())
    }

    fn load(&mut self, name: &str, text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = load::scenario(name, io.watch)?;
        let mut notes = vec![format!("{}: {}", scenario.name, scenario.title)];
        notes.extend(scenario.description.clone());
        notes.extend(scenario.notes.iter().cloned());
        self.change_noting(Setup::of(scenario), text, &notes, io)
    }

    fn set(&mut self, words: &[String], text: &str, io: &mut Output<'_>) -> Result<(), CommandError> {
        let scenario = Arc::clone(&self.now.scenario);
        let mut next = self.now.clone();
        let mut notes = Vec::new();
        match setting::read(words, &scenario, &self.now.values)? {
            Setting::Parameter(name, value) => {
                if let Some(parameter) = scenario.parameters.get(&name) {
                    let below = parameter.min.is_some_and(|min| value < min);
                    let above = parameter.max.is_some_and(|max| value > max);
                    if below || above {
                        let end = |end: Option<f64>| end.map_or("…".to_owned(), short);
                        notes.push(format!(
                            "{name} = {} lies outside {} … {}, the range of its slider",
                            short(value),
                            end(parameter.min),
                            end(parameter.max)
                        ));
                    }
                }
                next.values.insert(name, value);
                if let Some(refusal) = scenario.law_refusal(&next.values) {
                    return Err(setting::SetError::Value(refusal).into());
                }
            }
            Setting::Covering(covering) => next.rules.covering = covering,
            Setting::TieBreak(tie_break) => next.rules.tie_break = tie_break,
            Setting::Engine(engine) => next.rules.engine = engine,
            Setting::Auto(auto) => return self.set_auto(auto, io),
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
            Some("covering") => next.rules.covering = rules.covering,
            Some("tie-break") => next.rules.tie_break = rules.tie_break,
            Some("engine") => next.rules.engine = rules.engine,
            Some(name) => {
                let value = *file.get(name).ok_or_else(|| setting::unknown_parameter(name, &next.scenario))?;
                if let Some(refusal) = next.scenario.refusal(name, value) {
                    return Err(CommandError::Refused(refusal));
                }
                next.values.insert(name.to_owned(), value);
            }
        }
        self.change(next, text, io)
    }

    fn undo(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(change) = self.undo.last().cloned() else {
            return Err(CommandError::Refused("nothing to undo".into()));
        };
        let before = self.now.clone();
        self.enter(change.setup, false, io)?;
        self.undo.pop();
        let mut notes = vec![format!("undone: {}", change.command)];
        notes.extend(self.note_in_journal(&before, |_| Record::Undo));
        self.redo.push(Change { command: change.command, setup: before });
        self.say_what_changed(&notes, io)
    }

    fn redo(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let Some(change) = self.redo.last().cloned() else {
            return Err(CommandError::Refused("nothing to redo".into()));
        };
        let before = self.now.clone();
        self.enter(change.setup, false, io)?;
        self.redo.pop();
        let mut notes = vec![format!("done again: {}", change.command)];
        notes.extend(self.note_in_journal(&before, |_| Record::Redo));
        self.undo.push(Change { command: change.command, setup: before });
        self.say_what_changed(&notes, io)
    }

    fn solve_again(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let mut next = self.now.clone();
        let solved = next.solve(io.watch)?;
        self.now = next;
        self.take_answer(Some(solved));
        self.say_what_changed(&[], io)
    }

    fn save(&mut self, file: Option<&std::path::Path>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let path = match file {
            Some(path) => path.to_owned(),
            None => self.now.scenario.path.clone().ok_or_else(|| {
                CommandError::Refused(format!(
                    "`{}` is an embedded scenario: write `save FILE`",
                    self.now.scenario.name
                ))
            })?,
        };
        let saved = save::save(&self.now.scenario, &self.now.values, self.now.rules, &path)?;
        let mut said = format!("saved {}", path.display());
        // what went into a pipe or a device cannot be loaded again
        if path.is_file() {
            let before = self.now.clone();
            self.now.scenario = Arc::new(saved);
            // where changes are taken back the file stays this one
            for change in self.undo.iter_mut().chain(&mut self.redo) {
                if Arc::ptr_eq(&change.setup.scenario, &before.scenario) {
                    change.setup.scenario = Arc::clone(&self.now.scenario);
                }
            }
            if let Some(note) = self.note_in_journal(&before, Record::Saved) {
                said = format!("{said}; {note}");
            }
        }
        Ok(io.say(&said)?)
    }

    /// `step [N|back N|to K|first|last]`.
    fn step(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let (Some(last), Some(recorded)) = (answer.pivot_count.checked_sub(1), answer.last_recorded()) else {
            return Err(CommandError::Refused("no pivots: the main system is the answer".into()));
        };
        let here = self.shown_step().unwrap_or(last);
        let count = |word: &str| {
            word.parse::<usize>().map_err(|_| {
                CommandError::Refused(format!(
                    "step: `{word}` is no number of pivots; expected N, back N, to K, first or last"
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

    fn expect(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let expectation = expect::read(words, &self.names(), &self.now.values)?;
        self.with_facts(io.watch, |facts| expectation.test(facts, self.last_error.as_deref()))?;
        match expectation {
            expect::Expectation::Word { quantity: Quantity::Plain("outcome"), .. } => self.trouble = None,
            expect::Expectation::Error(_) => self.last_error = None,
            _ => {}
        }
        Ok(io.say(&format!("as expected: {}", words.join(" ")))?)
    }
}

/// `scenarios`.
pub(super) fn scenarios(io: &mut Output<'_>) -> Result<(), CommandError> {
    let list = embedded::list();
    io.report(
        || list.iter().map(|(name, title)| json!({"name": name, "title": title})).collect(),
        |out, style| write_scenarios(out, style),
    )?;
    Ok(())
}

/// A line per embedded scenario.
///
/// # Errors
/// Those of `out`.
pub fn write_scenarios(out: &mut dyn Write, style: &crate::view::style::Style) -> std::io::Result<()> {
    let width = embedded::names().map(str::len).max().unwrap_or(0);
    for (name, title) in embedded::list() {
        let line = format!("{name:<width$} {title}");
        writeln!(out, "{}", style.fit(&style.text(&line), style.width))?;
    }
    Ok(())
}

fn show_help(command: Option<&str>, io: &mut Output<'_>) -> Result<(), CommandError> {
    let text = match command {
        None => help::overview(&io.style),
        Some(word) => help::help(word, io.style.width)?,
    };
    io.report(
        || Value::String(text.clone()),
        |out, style| {
            for line in text.lines() {
                writeln!(out, "{}", style.text(line))?;
            }
            Ok(())
        },
    )?;
    Ok(())
}
