//! `cycle` and `limit cycle`: a load that goes to and fro.

use clap::Args;
use serde::Serialize;

use super::find::range;
use crate::answer::record::Ray;
use crate::path::cycle::{Kind, MOST, Turn, cycle, shakedown_limit};
use crate::path::record::PathRecord;
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// Repeat a load: does the structure shake down, slip to and fro, or creep further with every cycle?
///
/// `cycle LOAD A..B [N]`: from the unloaded structure to A, the other loads at their present factors, then to B and back
/// to A until a cycle repeats to 1e-12, at most N (256) times. Where the forces and gaps at the end of a cycle are those
/// at its beginning, every further cycle is the same. LOAD is a load case or a parameter that factors of load cases
/// depend on. `plot path` draws the loops.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  cycle F2 0..61\n  cycle pull -50..50 20")]
pub struct Repeated {
    /// The load, its two values, the most cycles
    #[arg(value_name = "REPEATED", required = true, num_args = 1..=3, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const CYCLE: Command = Command { in_0_1: false, complete: candidates, ..Command::of::<Repeated>("cycle") };

impl Action for Repeated {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.cycle(&self.words, io)?;
        Ok(Next::Continue)
    }
}

fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    if asked.given.is_empty() { asked.varied() } else { Vec::new() }
}

/// `A..B` in any order: from the first to the second.
fn ends(word: &str) -> Result<[f64; 2], CommandError> {
    match word.split_once("..") {
        Some((a, b)) if a.parse::<f64>().is_ok_and(|a| b.parse::<f64>().is_ok_and(|b| a > b)) => {
            range(&format!("{b}..{a}"), "cycle").map(|[b, a]| [a, b])
        }
        _ => range(word, "cycle"),
    }
}

#[derive(Serialize)]
struct CycleReport<'a> {
    load: &'a str,
    from: f64,
    to: f64,
    kind: Kind,
    cycles: &'a [Turn],
    collapse: Option<&'a Ray>,
    sentence: &'a str,
}

#[derive(Serialize)]
struct ShakedownReport<'a> {
    load: &'a str,
    from: f64,
    shakes_down: f64,
    beyond: Option<f64>,
    kind_beyond: Option<Kind>,
}

impl Session {
    /// `cycle LOAD A..B [N]`.
    pub(in crate::session) fn cycle(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let (name, span, most) = match words {
            [name, span] => (name, span, MOST),
            [name, span, count] => match count.parse::<usize>() {
                Ok(most @ 1..=100_000) => (name, span, most),
                _ => return refused(format!("cycle: `{count}` is no number of cycles; expected 1 to 100000")),
            },
            _ => return refused("cycle: expected `cycle LOAD A..B [N]`, e.g. `cycle pull 0..61`"),
        };
        let (name, ends) = (self.varied(name)?.to_owned(), ends(span)?);
        let ground = self.ground(io.watch)?;
        let what = name.clone();
        let found = worker::run(io.watch, move |watch| cycle(ground.case(watch), &what, ends, most))??;
        let units = &self.now.scenario.units;
        let report = CycleReport {
            load: &name,
            from: ends[0],
            to: ends[1],
            kind: found.kind,
            cycles: &found.turns,
            collapse: found.collapse(),
            sentence: &found.sentence,
        };
        io.show(&report, |out, style| view::cycle::write(out, &found, self.load_unit(&name), units, style))?;
        self.keep_path(PathRecord::of_history(&found.history));
        Ok(())
    }

    /// The unit of a parameter.
    fn load_unit(&self, name: &str) -> Option<&str> {
        self.now.scenario.parameters.get(name)?.unit.as_deref()
    }

    /// `limit cycle LOAD [A..B]`: from A, 0 if it is left out; B is looked at first.
    pub(in crate::session) fn limit_cycle(
        &mut self,
        words: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (name, span) = match words {
            [name] => (name, None),
            [name, span] => (name, Some(ends(span)?)),
            _ => return refused("limit cycle: expected `limit cycle LOAD [A..B]`"),
        };
        let name = self.varied(name)?.to_owned();
        let ground = self.ground(io.watch)?;
        let present = match ground.prepared.cases.iter().find(|(case, _)| *case == name) {
            Some((_, factor)) => factor.value(&self.now.values),
            None => self.now.values.get(&name).copied().unwrap_or_default(),
        };
        let ends = span.unwrap_or([0.0, if present == 0.0 { 1.0 } else { present }]);
        let what = name.clone();
        let found = worker::run(io.watch, move |watch| shakedown_limit(ground.case(watch), &what, ends))??;
        let report = ShakedownReport {
            load: &name,
            from: found.from,
            shakes_down: found.shakes_down,
            beyond: found.beyond.map(|(value, _)| value),
            kind_beyond: found.beyond.map(|(_, kind)| kind),
        };
        io.show(&report, |out, style| view::cycle::write_limit(out, &name, &found, self.load_unit(&name), style))?;
        Ok(())
    }
}
