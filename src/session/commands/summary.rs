//! `summary`: the answer on one screen.

use clap::Args;
use serde::Serialize;
use serde_json::{Map, Value as Json};

use crate::answer::record::Reaction;
use crate::model::quantity::{BarPlace, Internal, Names, OfLoad, OfPair, Over, Quantity};
use crate::path::quantity::{Facts, NoValue, Resultant, Value};
use crate::view;
use crate::view::summary::{self, Peak, Safety};

use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Show the answer on one screen: resultants, extremes, reactions, safety of each load case
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  summary")]
pub struct Summary;

pub const SUMMARY: Command = Command { in_0_1: false, ..Command::of::<Summary>("summary") };

impl Action for Summary {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.summary(io)?;
        Ok(Next::Continue)
    }
}

impl Session {
    /// `summary`.
    pub(in crate::session) fn summary(&mut self, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_quantities()?.clone();
        let units = self.now.scenario.units.clone();
        let summary = self.with_facts(io.watch, |facts| summary::Summary {
            resultants: if answer.is_answer() { self.resultants(facts) } else { Vec::new() },
            peaks: if answer.is_answer() { peaks(facts, &self.names()) } else { Vec::new() },
            reactions: answer.reactions.clone().unwrap_or_default(),
            safety: self.safeties(facts),
            probes: self.probed(facts),
        });
        if io.watch.stop() {
            return Err(CommandError::Interrupted);
        }
        let [fx, fy] = summary.sum_of_reactions();
        let extreme = |peak: &'_ Peak| ExtremeReport { quantity: peak.what, value: peak.value, at: peak.at.clone() };
        let probe = |(name, _, value): &(String, Quantity, Result<Value, NoValue>)| {
            (name.clone(), value.as_ref().map_or(Json::Null, |value| value.json()))
        };
        let report = SummaryReport {
            status: self.status_json(),
            resultants: &summary.resultants,
            extremes: summary.peaks.iter().map(extreme).collect(),
            reactions: &summary.reactions,
            sum_of_reactions: Force { fx, fy },
            safety: summary.safety.iter().map(SafetyReport::of).collect(),
            probes: summary.probes.iter().map(probe).collect(),
        };
        io.show(&report, |out, style| {
            writeln!(out, "{}", view::status::line(&answer, None, &units, style))?;
            view::summary::write(out, &summary, &units, style)
        })?;
        Ok(())
    }

    /// The probes with their values.
    pub(super) fn probed(&self, facts: &Facts<'_>) -> Vec<(String, Quantity, Result<Value, NoValue>)> {
        let probes = self.now.scenario.probes.iter();
        probes.map(|(name, quantity)| (name.clone(), quantity.clone(), facts.value(quantity))).collect()
    }

    fn safeties(&self, facts: &Facts<'_>) -> Vec<Safety> {
        let cases = self.now.prepared.as_ref().map(|prepared| prepared.cases.iter().map(|(case, _)| case.clone()));
        let value = |which, case: &str| facts.value(&Quantity::Load(which, case.to_owned()));
        cases
            .into_iter()
            .flatten()
            .filter(|_| !self.names().pairs.is_empty())
            .map(|case| {
                let limit = value(OfLoad::Limit, &case);
                let safety = value(OfLoad::Safety, &case).ok().and_then(|value| value.number());
                let reason = limit.as_ref().err().map(|reason| reason.0.clone());
                Safety { limit: limit.ok().and_then(|value| value.number()), safety, reason, case }
            })
            .collect()
    }
}

#[derive(Serialize)]
struct SummaryReport<'a> {
    status: Json,
    resultants: &'a [Resultant],
    extremes: Vec<ExtremeReport>,
    reactions: &'a [Reaction],
    sum_of_reactions: Force,
    safety: Vec<SafetyReport<'a>>,
    probes: Map<String, Json>,
}

#[derive(Serialize)]
struct ExtremeReport {
    quantity: &'static str,
    value: f64,
    at: String,
}

#[derive(Serialize)]
struct Force {
    fx: f64,
    fy: f64,
}

#[derive(Serialize)]
struct SafetyReport<'a> {
    case: &'a str,
    limit: Option<f64>,
    safety: Option<f64>,
    reason: Option<&'a str>,
}

impl<'a> SafetyReport<'a> {
    fn of(safety: &'a Safety) -> Self {
        let Safety { case, limit, safety, reason } = safety;
        SafetyReport { case, limit: *limit, safety: *safety, reason: reason.as_deref() }
    }
}

/// The largest of everything, with its place.
fn peaks(facts: &Facts<'_>, names: &Names<'_>) -> Vec<Peak> {
    let largest = |what: &'static str, which: OfPair| {
        let value = |id: &&str| {
            let value = facts.value(&Quantity::Pair(which, (*id).to_owned())).ok()?.number()?;
            Some((value, (*id).to_owned()))
        };
        let all = names.pairs.iter().filter_map(value);
        let most = all.reduce(|best, next| if next.0.abs() > best.0.abs() { next } else { best });
        most.map(|(value, at)| Peak { what, quantity: Quantity::Pairs(Over::Max, which, String::new()), value, at })
    };
    let bars = |what: &'static str, which: Internal| {
        let value = |bar: &&str| {
            let value = facts.value(&Quantity::Bar(which, (*bar).to_owned(), BarPlace::Extreme)).ok()?.number()?;
            Some((value, (*bar).to_owned()))
        };
        let most = names.bars().iter().filter_map(value).reduce(|a, b| if b.0.abs() > a.0.abs() { b } else { a });
        let quantity = |bar: &str| Quantity::Bar(which, bar.to_owned(), BarPlace::Extreme);
        most.map(|(value, at)| Peak { what, quantity: quantity(&at), value, at })
    };
    let displacement = facts.value(&Quantity::LargestDisplacement).ok().and_then(|value| value.number());
    let displacement = displacement.map(|value| Peak {
        what: "displacement",
        quantity: Quantity::LargestDisplacement,
        value,
        at: String::new(),
    });
    [
        largest("compressive force", OfPair::NormalForce),
        largest("friction force", OfPair::FrictionForce),
        largest("slip", OfPair::Slip),
        largest("opening", OfPair::Opening),
        displacement,
        bars("normal force", Internal::Axial),
        bars("shear force", Internal::Shear),
        bars("bending moment", Internal::Moment),
    ]
    .into_iter()
    .flatten()
    .collect()
}
