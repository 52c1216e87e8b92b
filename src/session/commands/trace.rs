//! `trace`: the answer followed over a load or a friction coefficient.

use std::sync::Arc;

use clap::Args;
use serde_json::json;

use crate::path::friction::{self, is_friction};
use crate::path::load::{self, LoadReach};
use crate::path::record::PathRecord;
use crate::session::commands::along::along_json;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::start::case_names;
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// Friction without a target and without a slider ends here.
const FRICTION: f64 = 10.0;

/// Follow the answer over a load or a friction coefficient: every breakpoint, exactly
///
/// NAME is a load case, a parameter in which the loads are linear, or a friction parameter. A load is followed from its present factor
/// upwards (from 0 where there is no answer now) to the target, a turning point or its limit; friction up to the
/// target, or else to the end of the slider. `plot path` and `export path` show the way afterwards.
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
                (Some(to.map_err(|_| CommandError::Refused(format!("trace: `{value}` is no number")))?), rest)
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
        let what = name.to_owned();
        if is_friction(ground.case(io.watch), name) {
            let to = to.unwrap_or_else(|| {
                let slider = self.now.scenario.parameters.get(name).and_then(|p| p.max);
                let present = self.now.values.get(name).copied().unwrap_or_default();
                slider.filter(|max| *max > present).unwrap_or(FRICTION.max(2.0 * present))
            });
            let path = worker::run(io.watch, move |watch| {
                friction::trace(ground.case(watch), Some(&ground.solved), &what, to)
            })??;
            let record = PathRecord::of_friction(&path);
            let along = self.report_along(&geometry, &record, &quantities, io.watch)?;
            io.report(
                || {
                    json!({
                        "along": along_json(&record, &along),
                        "parameter": path.name,
                        "intervals": path.intervals.iter().map(|interval| json!({
                            "from": interval.from,
                            "to": interval.to,
                            "states": interval.pairs.iter().map(|pair| (pair.id.clone(), json!(pair.state)))
                                .collect::<serde_json::Map<_, _>>(),
                        })).collect::<Vec<_>>(),
                        "breakpoints": path.breakpoints.iter().map(|at| json!({
                            "value": at.value, "changes": at.changes, "jump": at.jump, "sentence": at.sentence,
                        })).collect::<Vec<_>>(),
                        "end": record.end,
                    })
                },
                |out, style| {
                    view::path::write_friction(out, &path, &units, style)?;
                    view::quantities::write_along(out, &record, &along, &units, style)
                },
            )?;
            self.path = Some(Arc::new(record));
            return Ok(());
        }
        let path = worker::run(io.watch, move |watch| {
            load::trace(ground.case(watch), Some(&ground.solved), &what, LoadReach { to, through })
        })??;
        let record = PathRecord::of_load(&path, &case_names(&geometry));
        let along = self.report_along(&geometry, &record, &quantities, io.watch)?;
        io.report(
            || {
                json!({
                    "along": along_json(&record, &along),
                    "load": path.parameter.name,
                    "start": path.start,
                    "from_zero": path.from_zero,
                    "breakpoints": path.breakpoints.iter().map(|at| json!({
                        "factor": at.value, "changes": at.changes, "sentence": at.sentence,
                        "at_constant_load": at.jump,
                    })).collect::<Vec<_>>(),
                    "limit": path.limit(),
                    "last": path.factors.last(),
                    "end": record.end,
                })
            },
            |out, style| {
                view::path::write_load(out, &path, &units, style)?;
                view::quantities::write_along(out, &record, &along, &units, style)
            },
        )?;
        self.path = Some(Arc::new(record));
        Ok(())
    }
}
