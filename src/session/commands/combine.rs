//! `combine` and `envelope`: the load combinations of the scenario, each solved with the present values.

use std::sync::Arc;

use clap::Args;
use indexmap::IndexMap;
use serde::Serialize;
use serde_json::{Map, Value as Json};

use crate::answer::record::{OutcomeKind, PairState, RayClass};
use crate::path::quantity::{Facts, NoValue, Value};
use crate::solve::problem::factors;
use crate::solve::{Case, Prepared, Solved};
use crate::view;
use crate::view::combinations::Row;
use crate::watch::Watch;

use crate::model::words::no_such;
use crate::session::language::candidates::Candidate;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session, worker};

/// Solve the load combinations of the scenario
///
/// Each multiplies the factors of the load cases it names; cases it does not name count 0. With NAME its answer is
/// the one that the other commands show, until the next change or `solve`.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  combine\n  combine ULS1")]
pub struct Combine {
    /// The combination; all of them if none is named
    #[arg(value_name = "COMBINATION")]
    name: Option<String>,
}

pub const COMBINE: Command = Command {
    in_0_1: false,
    complete: |asked| Candidate::plain(&asked.names.combinations),
    ..Command::of::<Combine>("combine")
};

impl Action for Combine {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.combine(self.name.as_deref(), io)?;
        Ok(Next::Continue)
    }
}

/// A combination with its answer.
pub(super) struct Combined {
    pub(super) name: String,
    prepared: Arc<Prepared>,
    factors: Vec<f64>,
    pub(super) solved: Arc<Solved>,
}

#[derive(Serialize)]
struct CombinationsReport<'a> {
    combinations: Vec<CombinationReport<'a>>,
}

#[derive(Serialize)]
struct CombinationReport<'a> {
    name: &'a str,
    factors: IndexMap<String, f64>,
    outcome: OutcomeKind,
    ray: Option<RayClass>,
    pivots: usize,
    pairs: &'a [PairState],
    probes: Map<String, Json>,
}

impl Session {
    /// The combinations, all or the one named, solved.
    pub(super) fn combined(&self, name: Option<&str>, io: &mut Output<'_>) -> Result<Vec<Combined>, CommandError> {
        let known = &self.now.scenario.combinations;
        if known.is_empty() {
            return Err(CommandError::Refused(
                "the scenario has no `combinations`; in its file they are written \"combinations\": { \"ULS1\": { \"weight\": \
                 1.35, \"pull\": 1.5 } }, with the names of its load cases"
                    .into(),
            ));
        }
        if let Some(name) = name
            && !known.iter().any(|(known, _)| known == name)
        {
            let names = known.iter().map(|(name, _)| name.as_str());
            return Err(CommandError::Refused(no_such("combination", name, names)));
        }
        let ground = self.ground(io.watch)?;
        let name = name.map(str::to_owned);
        worker::run(io.watch, move |watch| {
            let Case { scenario, values, .. } = ground.case(watch);
            let own = factors(&ground.prepared, values);
            let chosen =
                scenario.combinations.iter().filter(|(known, _)| name.as_ref().is_none_or(|name| name == known));
            let mut combined = Vec::new();
            for (name, combination) in chosen {
                let factor = |(case, own): (&(String, _), &f64)| {
                    let named = combination.multipliers.iter().find(|(known, _)| *known == case.0);
                    named.map_or(0.0, |(_, multiplier)| multiplier.value(values) * own)
                };
                let factors: Vec<f64> = ground.prepared.cases.iter().zip(&own).map(factor).collect();
                let prepared = Arc::new(ground.prepared.with_factors(&factors));
                let solved = Case { prepared: &prepared, ..ground.case(watch) }.solve().map_err(|error| {
                    if error.is_interrupted() {
                        CommandError::Interrupted
                    } else {
                        CommandError::Solve(format!("combination {name}: {error}"))
                    }
                })?;
                combined.push(Combined { name: name.clone(), prepared, factors, solved: Arc::new(solved) });
            }
            Ok(combined)
        })?
    }

    pub(super) fn facts_of<'a>(&'a self, combined: &'a Combined, watch: &'a dyn Watch) -> Facts<'a> {
        Facts::of_answer(self.now.case(&combined.prepared, watch), &combined.solved)
    }

    /// `combine [NAME]`.
    pub(in crate::session) fn combine(&mut self, name: Option<&str>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let all = self.combined(name, io)?;
        let watch = io.watch;
        let probes = &self.now.scenario.probes;
        let units = self.now.scenario.units.clone();
        let rows: Vec<(Row, CombinationReport<'_>)> = all
            .iter()
            .map(|combined| {
                let answer = &combined.solved.answer;
                let facts = self.facts_of(combined, watch);
                let values: Vec<Result<Value, NoValue>> =
                    probes.iter().map(|(_, quantity)| facts.value(quantity)).collect();
                let cases = combined.prepared.cases.iter().map(|(case, _)| case.clone());
                let report = CombinationReport {
                    name: &combined.name,
                    factors: cases.zip(combined.factors.iter().copied()).collect(),
                    outcome: answer.outcome,
                    ray: answer.ray.as_ref().map(|ray| ray.class),
                    pivots: answer.pivot_count,
                    pairs: &answer.pairs,
                    probes: self.probe_values(&facts),
                };
                let line = view::status::line(answer, None, &units, &io.style);
                (Row { name: combined.name.clone(), line, values }, report)
            })
            .collect();
        let shown = name.map(|name| format!("combination {name} is what is shown until the next change or `solve`"));
        let rays = all.iter().filter(|one| one.solved.answer.ray.is_some() && !probes.is_empty());
        let notes: Vec<String> = rays
            .filter_map(|one| Some(format!("{}: {}", one.name, view::status::ray_note(&one.solved.answer, &units)?)))
            .chain(shown)
            .collect();
        let (rows, combinations): (Vec<Row>, Vec<CombinationReport<'_>>) = rows.into_iter().unzip();
        io.show(&CombinationsReport { combinations }, |out, style| {
            view::combinations::write(out, &rows, probes, &notes, &units, style)
        })?;
        if let (Some(_), [one]) = (name, &all[..]) {
            let (solved, prepared) = (Arc::clone(&one.solved), Arc::clone(&one.prepared));
            self.take_answer(Some(solved));
            self.combination = Some((one.name.clone(), prepared));
        }
        Ok(())
    }
}
