//! `combine` and `envelope`: the load combinations of the scenario, each solved with the present values.

use std::sync::Arc;

use serde_json::{Value as Json, json};

use crate::model::quantity::Quantity;
use crate::path::quantity::{Facts, NoValue, Value};
use crate::solve::numbers::factors;
use crate::solve::{Prepared, Solved};
use crate::view;
use crate::view::combinations::{Extreme, Line, Row};
use crate::view::status::outcome_word;
use crate::watch::Watch;

use super::selection::no_such;
use super::{CommandError, Output, Session, worker};

/// A combination whose answer is shown in the place of the scenario's own.
#[derive(Clone)]
pub(super) struct Combination {
    /// The geometry with the factors of the combination.
    pub(super) prepared: Arc<Prepared>,
}

/// A combination with its answer.
struct Combined {
    name: String,
    prepared: Arc<Prepared>,
    factors: Vec<f64>,
    solved: Arc<Solved>,
}

impl Session {
    /// The combinations, all or the one named, solved.
    fn combined(&self, name: Option<&str>, io: &mut Output<'_>) -> Result<Vec<Combined>, CommandError> {
        let known = &self.now.scenario.combinations;
        if known.is_empty() {
            return Err(CommandError::Refused(
                "the scenario has no `combinations`: { \"ULS1\": { \"weight\": 1.35, \"pull\": 1.5 } }".into(),
            ));
        }
        if let Some(name) = name
            && !known.iter().any(|(known, _)| known == name)
        {
            let names = known.iter().map(|(name, _)| name.as_str());
            return Err(CommandError::Refused(no_such("combination", name, names)));
        }
        let ground = self.ground(io.watch)?;
        let (scenario, values, rules) = (Arc::clone(&self.now.scenario), self.now.values.clone(), self.now.rules);
        let name = name.map(str::to_owned);
        worker::run(io.watch, move |watch| {
            let own = factors(&ground.prepared, &values);
            let chosen =
                scenario.combinations.iter().filter(|(known, _)| name.as_ref().is_none_or(|name| name == known));
            let mut combined = Vec::new();
            for (name, combination) in chosen {
                let factor = |(case, own): (&(String, _), &f64)| {
                    let named = combination.multipliers.iter().find(|(known, _)| *known == case.0);
                    named.map_or(0.0, |(_, multiplier)| multiplier.value(&values) * own)
                };
                let factors: Vec<f64> = ground.prepared.cases.iter().zip(&own).map(factor).collect();
                let prepared = Arc::new(ground.prepared.with_factors(&factors));
                let solved = prepared.solve(&scenario, &values, rules, watch).map_err(|error| {
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

    fn facts_of<'a>(&'a self, combined: &'a Combined, watch: &'a dyn Watch) -> Facts<'a> {
        Facts::of_answer(&self.now.scenario, &combined.prepared, &self.now.values, &combined.solved, watch)
    }

    /// `combine [NAME]`.
    pub(super) fn combine(&mut self, name: Option<&str>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let all = self.combined(name, io)?;
        let watch = io.watch;
        let probes = &self.now.scenario.probes;
        let units = self.now.scenario.units.clone();
        let rows: Vec<(Row, Json)> = all
            .iter()
            .map(|combined| {
                let answer = &combined.solved.answer;
                let facts = self.facts_of(combined, watch);
                let values: Vec<Result<Value, NoValue>> =
                    probes.iter().map(|(_, quantity)| facts.value(quantity)).collect();
                let cases = combined.prepared.cases.iter().map(|(case, _)| case.clone());
                let json = json!({
                    "name": combined.name,
                    "factors": cases.zip(combined.factors.iter().map(|f| json!(f))).collect::<serde_json::Map<_, _>>(),
                    "outcome": answer.outcome,
                    "ray": answer.ray.as_ref().map(|ray| json!(ray.class)),
                    "pivots": answer.pivot_count,
                    "pairs": answer.pairs,
                    "probes": self.probe_values(&facts),
                });
                let line = view::status::line(answer, None, &units, &io.style);
                let values = probes.iter().zip(values);
                let values = values.map(|((name, quantity), value)| Line {
                    name: name.clone(),
                    text: view::quantities::shown(quantity, &value, &units).0,
                });
                (Row { name: combined.name.clone(), line, values: values.collect() }, json)
            })
            .collect();
        let note = match (name, &all[..]) {
            (Some(name), [_]) => {
                Some(format!("the answer of combination {name} is shown until the next change or `solve`"))
            }
            _ => None,
        };
        let (rows, json): (Vec<Row>, Vec<Json>) = rows.into_iter().unzip();
        io.report(
            || json!({"combinations": json}),
            |out, style| view::combinations::write(out, &rows, note.as_deref(), style),
        )?;
        if let (Some(_), [one]) = (name, &all[..]) {
            let (solved, prepared) = (Arc::clone(&one.solved), Arc::clone(&one.prepared));
            self.take_answer(Some(solved));
            self.combination = Some(Combination { prepared });
        }
        Ok(())
    }

    /// `envelope [QUANTITY …] [over combinations]`.
    pub(super) fn envelope(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let words = match words.iter().position(|word| word == "over") {
            None => words,
            Some(at) => match &words[at + 1..] {
                [what] if what == "combinations" => &words[..at],
                _ => {
                    return Err(CommandError::Refused("envelope: expected `over combinations` at the end".to_owned()));
                }
            },
        };
        let quantities = if words.is_empty() { self.all_probes()? } else { self.quantities(words)? };
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.is_word()) {
            return Err(CommandError::Refused(format!("envelope: `{quantity}` is a word, not a number")));
        }
        let all = self.combined(None, io)?;
        let watch = io.watch;
        let without: Vec<String> = all
            .iter()
            .filter(|combined| !combined.solved.answer.is_answer())
            .map(|combined| format!("{} ({})", combined.name, outcome_word(combined.solved.answer.outcome)))
            .collect();
        let answered: Vec<(&Combined, Facts<'_>)> = all
            .iter()
            .filter(|combined| combined.solved.answer.is_answer())
            .map(|combined| (combined, self.facts_of(combined, watch)))
            .collect();
        let extremes: Vec<Extreme> = quantities.into_iter().map(|quantity| extreme(quantity, &answered)).collect();
        let units = &self.now.scenario.units;
        io.report(
            || {
                let end = |end: &Option<(f64, String)>| {
                    end.as_ref().map(|(value, name)| json!({"value": value, "combination": name}))
                };
                json!({
                    "envelope": extremes.iter().map(|extreme| json!({
                        "quantity": extreme.quantity.to_string(),
                        "unit": extreme.quantity.unit(units),
                        "least": end(&extreme.least),
                        "largest": end(&extreme.largest),
                    })).collect::<Vec<_>>(),
                    "without_answer": without,
                })
            },
            |out, style| view::combinations::write_envelope(out, &extremes, &without, units, style),
        )?;
        Ok(())
    }
}

/// The least and the largest value of a quantity, the first of equals.
fn extreme(quantity: Quantity, answered: &[(&Combined, Facts<'_>)]) -> Extreme {
    let mut found = Extreme { quantity, least: None, largest: None };
    for (combined, facts) in answered {
        let Some(value) = facts.value(&found.quantity).ok().and_then(|value| value.number()) else { continue };
        if found.least.as_ref().is_none_or(|(least, _)| value < *least) {
            found.least = Some((value, combined.name.clone()));
        }
        if found.largest.as_ref().is_none_or(|(largest, _)| value > *largest) {
            found.largest = Some((value, combined.name.clone()));
        }
    }
    found
}
