//! `trace`: the answer followed over a load or a friction coefficient.

use std::io::{self, Write};
use std::sync::Arc;

use clap::Args;
use indexmap::IndexMap;
use serde::Serialize;

use crate::answer::record::State;
use crate::model::quantity::Quantity;
use crate::path::change::{Breakpoint, Change};
use crate::path::friction::{FrictionPath, Interval, is_friction};
use crate::path::load::{LoadPath, LoadReach};
use crate::path::on_cone::ConePath;
use crate::path::record::PathRecord;
use crate::path::way::{FRICTION, Way};
use crate::session::commands::along::Along;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::start::case_names;
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::solve::Prepared;
use crate::view;
use crate::view::style::Style;

/// Follow the answer over a load or a friction coefficient: every breakpoint, exactly
///
/// NAME is a load case, a parameter in which the loads are linear, or a friction parameter. A load is followed from its
/// present factor upwards (from 0 where there is no answer now) to the target, a turning point or its limit; friction
/// up to the target, or else to the end of the slider. In space the answer is followed on Coulomb's cone in steps, and
/// breakpoints are searched for between two of them. `plot path` and `export path` show the way afterwards.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  trace pull\n  trace F2 to 400\n  trace f to 1\n  trace pull --through\n  trace pull to 260 of x_t c6, max z_t"
)]
pub struct Trace {
    /// What to follow
    #[arg(value_name = "TRACED")]
    name: String,
    /// `to` and the value to reach; `of` and quantities to show on the way
    #[arg(value_name = "to VALUE", num_args = 0.., allow_negative_numbers = true)]
    to: Vec<String>,
    /// Follow the path through turning points, where the load has to fall
    #[arg(long)]
    through: bool,
}

pub const TRACE: Command = Command { complete: words, ..Command::of::<Trace>("trace") };

impl Action for Trace {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.trace(&self.name, &self.to, self.through, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        true
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

/// What is followed, its target, and the quantities on the way.
fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    match asked.given {
        [] => asked.varied(),
        [_] => Candidate::plain(["to", "of"]),
        [_, to, _] if to == "to" => Candidate::plain(["of"]),
        [_, to, _, of, rest @ ..] if to == "to" && of == "of" => asked.quantities(rest),
        [_, of, rest @ ..] if of == "of" => asked.quantities(rest),
        _ => Vec::new(),
    }
}

impl Session {
    /// `trace NAME [to V] [of QUANTITY …] [--through]`.
    pub(in crate::session) fn trace(
        &mut self,
        name: &str,
        words: &[String],
        through: bool,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (to, words) = match words {
            [word, value, rest @ ..] if word == "to" => {
                let to = value.parse::<f64>();
                (Some(to.map_err(|_| CommandError::Refused(format!("trace: `{value}` is not a number")))?), rest)
            }
            words => (None, words),
        };
        let quantities = match words {
            [] => Vec::new(),
            [word, rest @ ..] if word == "of" && !rest.is_empty() => self.quantities(rest)?,
            _ => {
                return Err(CommandError::Refused(
                    "trace: expected `trace NAME`, `trace NAME to VALUE`, and then `of QUANTITY`".into(),
                ));
            }
        };
        let ground = self.ground(io.watch)?;
        let units = self.now.scenario.units.clone();
        let geometry = Arc::clone(&ground.prepared);
        let to = match is_friction(ground.case(io.watch), name) {
            true => Some(to.unwrap_or_else(|| {
                let slider = self.now.scenario.parameters.get(name).and_then(|p| p.max);
                let present = self.now.values.get(name).copied().unwrap_or_default();
                slider.filter(|max| *max > present).unwrap_or(FRICTION.max(2.0 * present))
            })),
            false => to,
        };
        let what = name.to_owned();
        let way = worker::run(io.watch, move |watch| {
            Way::reach(ground.case(watch), &ground.solved, &what, LoadReach { to, through })
        })??;
        let shown = (&*geometry, &quantities[..]);
        match &way {
            Way::Friction(path) => {
                let record = PathRecord::of_friction(path);
                self.show_way(record, &FrictionReport::of(path), shown, io, |out, style| {
                    view::path::write_friction(out, path, &units, style)
                })
            }
            Way::Load(path) => {
                let record = PathRecord::of_load(path, &case_names(&geometry));
                self.show_way(record, &LoadReport::of(path), shown, io, |out, style| {
                    view::path::write_load(out, path, &units, style)
                })
            }
            Way::OnCone(path) => {
                let record = PathRecord::of_cone(path, &case_names(&geometry));
                self.show_way(record, &ConeReport::of(path), shown, io, |out, style| {
                    view::path::write_on_cone(out, path, &units, style)
                })
            }
        }
    }

    /// Shows a path with the quantities along it, and keeps it.
    fn show_way(
        &mut self,
        record: PathRecord,
        report: &impl Serialize,
        (geometry, quantities): (&Prepared, &[Quantity]),
        io: &mut Output<'_>,
        write: impl FnOnce(&mut dyn Write, &Style) -> io::Result<()>,
    ) -> Result<(), CommandError> {
        let along = self.report_along(geometry, &record, quantities, io.watch)?;
        let report = Report { along: Along::of(&record, &along), path: report, end: &record.end };
        let units = &self.now.scenario.units;
        io.show(&report, |out, style| {
            write(out, style)?;
            view::quantities::write_along(out, &record, &along, units, style)
        })?;
        self.keep_path(record);
        Ok(())
    }
}

/// A path with what all of them have.
#[derive(Serialize)]
struct Report<'a, P> {
    along: Along<'a>,
    #[serde(flatten)]
    path: &'a P,
    end: &'a str,
}

/// A path in space, with the keys of the two below that it has.
#[derive(Serialize)]
struct ConeReport<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    load: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    parameter: Option<&'a str>,
    start: f64,
    from_zero: bool,
    breakpoints: Vec<ConeTurn<'a>>,
    limit: Option<f64>,
    answer_beyond: Option<f64>,
    last: f64,
}

#[derive(Serialize)]
struct ConeTurn<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    factor: Option<f64>,
    value: f64,
    changes: &'a [Change],
    jump: bool,
    sentence: &'a str,
}

impl<'a> ConeReport<'a> {
    fn of(path: &'a ConePath) -> Self {
        let name = path.name.as_str();
        let turn = |at: &'a Breakpoint| ConeTurn {
            factor: (!path.over.is_friction()).then_some(at.value),
            value: at.value,
            changes: &at.changes,
            jump: at.jump,
            sentence: &at.sentence,
        };
        ConeReport {
            load: (!path.over.is_friction()).then_some(name),
            parameter: path.over.is_friction().then_some(name),
            start: path.start,
            from_zero: path.from_zero,
            breakpoints: path.breakpoints.iter().map(turn).collect(),
            limit: path.limit(),
            answer_beyond: path.end.answer_beyond(),
            last: path.last(),
        }
    }
}

/// A path over friction.
#[derive(Serialize)]
struct FrictionReport<'a> {
    parameter: &'a str,
    intervals: Vec<States<'a>>,
    breakpoints: Vec<Jump<'a>>,
}

/// The states between two breakpoints.
#[derive(Serialize)]
struct States<'a> {
    from: f64,
    to: f64,
    states: IndexMap<&'a str, State>,
}

#[derive(Serialize)]
struct Jump<'a> {
    value: f64,
    changes: &'a [Change],
    jump: bool,
    sentence: &'a str,
}

impl<'a> FrictionReport<'a> {
    fn of(path: &'a FrictionPath) -> Self {
        let states = |interval: &'a Interval| States {
            from: interval.from,
            to: interval.to,
            states: interval.pairs.iter().map(|pair| (pair.id.as_str(), pair.state)).collect(),
        };
        let jump = |at: &'a Breakpoint| {
            let Breakpoint { value, changes, jump, sentence, .. } = at;
            Jump { value: *value, changes, jump: *jump, sentence }
        };
        FrictionReport {
            parameter: &path.name,
            intervals: path.intervals.iter().map(states).collect(),
            breakpoints: path.breakpoints.iter().map(jump).collect(),
        }
    }
}

/// A path over a load.
#[derive(Serialize)]
struct LoadReport<'a> {
    load: &'a str,
    start: f64,
    from_zero: bool,
    breakpoints: Vec<Turn<'a>>,
    limit: Option<f64>,
    answer_beyond: Option<f64>,
    last: Option<f64>,
}

#[derive(Serialize)]
struct Turn<'a> {
    factor: f64,
    changes: &'a [Change],
    sentence: &'a str,
    at_constant_load: bool,
}

impl<'a> LoadReport<'a> {
    fn of(path: &'a LoadPath) -> Self {
        let turn = |at: &'a Breakpoint| {
            let Breakpoint { value, changes, jump, sentence, .. } = at;
            Turn { factor: *value, changes, sentence, at_constant_load: *jump }
        };
        LoadReport {
            load: &path.parameter.name,
            start: path.start,
            from_zero: path.from_zero,
            breakpoints: path.breakpoints.iter().map(turn).collect(),
            limit: path.limit(),
            answer_beyond: path.end.answer_beyond(),
            last: path.factors.last().copied(),
        }
    }
}
