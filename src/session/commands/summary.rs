//! `summary`: the answer on one screen.

use clap::Args;
use serde::Serialize;
use serde_json::{Map, Value as Json};

use crate::answer::record::Reaction;
use crate::model::quantity::{BarPlace, Internal, Names, OfPair, OfStress, Over, Quantity};
use crate::model::structure::Dimension;
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
            // those of the answer, not of a pivot before it
            reactions: answer.reactions.clone().filter(|_| self.position.is_none()).unwrap_or_default(),
            safety: self.safeties(facts),
            probes: self.probed(facts),
        });
        if io.watch.stop() {
            return Err(CommandError::Interrupted);
        }
        let [fx, fy, fz] = summary.sum_of_reactions();
        let fz = summary.is_in_space().then_some(fz);
        let extreme = |peak: &'_ Peak| ExtremeReport { quantity: peak.what, value: peak.value, at: peak.at.clone() };
        let probe = |(name, _, value): &(String, Quantity, Result<Value, NoValue>)| {
            (name.clone(), value.as_ref().map_or(Json::Null, |value| value.json()))
        };
        let report = SummaryReport {
            status: self.status_json(),
            resultants: &summary.resultants,
            extremes: summary.peaks.iter().map(extreme).collect(),
            reactions: &summary.reactions,
            sum_of_reactions: Force { fx, fy, fz },
            safety: summary.safety.iter().map(SafetyReport::of).collect(),
            probes: summary.probes.iter().map(probe).collect(),
        };
        io.show(&report, |out, style| {
            writeln!(out, "{}", view::status::line(&answer, None, &units, style))?;
            self.write_place_shown(out, style)?;
            view::summary::write(out, &summary, &units, style)?;
            if summary.safety.is_empty() {
                return Ok(());
            }
            self.write_not_of_history("safety and limits are ", out, style)
        })?;
        Ok(())
    }

    /// The probes with their values.
    pub(super) fn probed(&self, facts: &Facts<'_>) -> Vec<(String, Quantity, Result<Value, NoValue>)> {
        let probes = self.now.scenario.probes.iter();
        probes.map(|(name, quantity)| (name.clone(), quantity.clone(), facts.value(quantity))).collect()
    }

    /// How far each load case may grow; nothing where there are no pairs.
    pub(super) fn safeties(&self, facts: &Facts<'_>) -> Vec<Safety> {
        let cases = self.now.prepared.iter().flat_map(|prepared| &prepared.cases);
        cases
            .filter(|_| !self.names().pairs.is_empty())
            .filter_map(|(case, _)| {
                let found = facts.limit_of(case)?;
                let (limit, safety) = found.as_ref().map_or((None, None), |found| (found.factor, found.safety));
                let (brief, reason) = match &found {
                    Ok(found) if limit.is_some() => (found.brief(), None),
                    Ok(found) => (found.brief(), Some(format!("no limit: {}", found.end_sentence()))),
                    Err(error) => (error.brief(), Some(error.to_string())),
                };
                Some(Safety { case: case.clone(), limit, safety, brief, reason })
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
    #[serde(skip_serializing_if = "Option::is_none")]
    fz: Option<f64>,
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
        let Safety { case, limit, safety, reason, .. } = safety;
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
        most.map(|(value, at)| {
            // nothing is largest nowhere
            let at = if value == 0.0 { String::new() } else { at };
            Peak { what, quantity: Quantity::Pairs(Over::Max, which, String::new()), value, at }
        })
    };
    let bars = |which: Internal| {
        let quantity = |bar: &str| Quantity::Bar(which, bar.to_owned(), BarPlace::Extreme);
        let value = |bar: &&str| Some((facts.value(&quantity(bar)).ok()?.number()?, (*bar).to_owned()));
        let most = names.bars().iter().filter_map(value).reduce(|a, b| if b.0.abs() > a.0.abs() { b } else { a });
        most.map(|(value, at)| Peak {
            what: which.name(),
            quantity: quantity(&at),
            value,
            at: if value == 0.0 { String::new() } else { at },
        })
    };
    let of_all = |what: &'static str, quantity: Quantity| {
        let value = facts.value(&quantity).ok()?.number()?;
        let at = facts.place(&quantity).unwrap_or_default();
        Some(Peak { what, quantity, value, at })
    };
    [
        largest("compressive force", OfPair::NormalForce),
        largest("friction force", OfPair::FrictionForce),
        largest("slip", OfPair::Slip),
        largest("opening", OfPair::Opening),
        of_all("displacement", Quantity::LargestDisplacement),
        of_all("von Mises stress", Quantity::Stresses(Over::Max, OfStress::Mises, None)),
    ]
    .into_iter()
    .chain(Internal::of(names.dimension == Dimension::Space).iter().map(|which| bars(*which)))
    .flatten()
    .collect()
}
