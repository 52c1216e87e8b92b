//! `combine` and `envelope`: the load combinations of the scenario, each solved with the present values.

use std::sync::Arc;

use serde_json::{Value as Json, json};

use crate::model::quantity::Quantity;
use crate::path::envelope::{Axis, Peak, envelope};
use crate::path::quantity::{Facts, NoValue, Value};
use crate::solve::numbers::factors;
use crate::solve::{Case, Prepared, Solved};
use crate::view;
use crate::view::combinations::{Extreme, Line, Row};
use crate::view::path::exact;
use crate::view::status::outcome_word;
use crate::watch::Watch;

use crate::session::language::selection::no_such;
use crate::session::{CommandError, Output, Session, commands::find, worker};

/// A combination whose answer is shown in the place of the scenario's own.
#[derive(Clone)]
pub(in crate::session) struct Combination {
    /// The geometry with the factors of the combination.
    pub(in crate::session) prepared: Arc<Prepared>,
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

    fn facts_of<'a>(&'a self, combined: &'a Combined, watch: &'a dyn Watch) -> Facts<'a> {
        Facts::of_answer(self.now.case(&combined.prepared, watch), &combined.solved)
    }

    /// `combine [NAME]`.
    pub(in crate::session) fn combine(&mut self, name: Option<&str>, io: &mut Output<'_>) -> Result<(), CommandError> {
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

    /// `envelope [QUANTITY …] [over combinations | PARAMETER A..B …]`.
    pub(in crate::session) fn envelope(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let (words, over) = match words.iter().position(|word| word == "over") {
            None => (words, None),
            Some(at) => (&words[..at], Some(&words[at + 1..])),
        };
        let quantities = if words.is_empty() { self.all_probes()? } else { self.quantities(words)? };
        if let Some(quantity) = quantities.iter().find(|quantity| quantity.is_word()) {
            return Err(CommandError::Refused(format!("envelope: `{quantity}` is a word, not a number")));
        }
        match over {
            None => self.envelope_of_combinations(quantities, io),
            Some([what]) if what == "combinations" => self.envelope_of_combinations(quantities, io),
            Some(ranges) => self.envelope_of_parameters(quantities, ranges, io),
        }
    }

    fn envelope_of_combinations(&self, quantities: Vec<Quantity>, io: &mut Output<'_>) -> Result<(), CommandError> {
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
            |out, style| {
                let notes: Vec<String> = match without.is_empty() {
                    true => Vec::new(),
                    false => vec![format!("without an answer: {}", without.join(", "))],
                };
                view::combinations::write_envelope(out, "in", &extremes, &notes, units, style)
            },
        )?;
        Ok(())
    }

    /// Parameters and load cases with their ranges, those of their sliders where they are left out.
    pub(in crate::session) fn axes(&self, words: &[String], command: &str) -> Result<Vec<Axis>, CommandError> {
        let mut axes: Vec<Axis> = Vec::new();
        let mut rest = words;
        while let Some((name, after)) = rest.split_first() {
            let name = self.varied(name)?.to_owned();
            let (range, after) = match after.split_first() {
                Some((word, after)) if word.contains("..") => (find::range(word, command)?, after),
                _ => (self.slider(&name, command)?, after),
            };
            if axes.iter().any(|axis| axis.name == name) {
                return Err(CommandError::Refused(format!("{command}: {name} is named twice")));
            }
            axes.push(Axis { name, range });
            rest = after;
        }
        if axes.is_empty() || axes.len() > 3 {
            return Err(CommandError::Refused(
                "envelope: expected `over combinations` or `over PARAMETER A..B`, up to three of them".to_owned(),
            ));
        }
        Ok(axes)
    }

    fn envelope_of_parameters(
        &self,
        quantities: Vec<Quantity>,
        words: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let axes = self.axes(words, "envelope … over")?;
        let ground = self.ground(io.watch)?;
        let (over, asked) = (axes.clone(), quantities.clone());
        let found = worker::run(io.watch, move |watch| envelope(ground.case(watch), &over, &asked))??;
        let units = &self.now.scenario.units;
        let place = |peak: &Peak| -> serde_json::Map<String, Json> {
            axes.iter().zip(&peak.at).map(|(axis, at)| (axis.name.clone(), json!(at))).collect()
        };
        let end = |peak: &Option<Peak>| {
            peak.as_ref().map(|peak| json!({"value": peak.value, "at": place(peak), "change": peak.change}))
        };
        let words = |peak: &Peak| {
            let at = axes.iter().zip(&peak.at).map(|(axis, at)| format!("{} = {}", axis.name, exact(*at)));
            let at = at.collect::<Vec<_>>().join(", ");
            (peak.value, peak.change.as_ref().map_or(at.clone(), |change| format!("{at}: {change}")))
        };
        io.report(
            || {
                json!({
                    "envelope": quantities.iter().zip(&found.peaks).map(|(quantity, [least, largest])| json!({
                        "quantity": quantity.to_string(),
                        "unit": quantity.unit(units),
                        "least": end(least),
                        "largest": end(largest),
                    })).collect::<Vec<_>>(),
                    "over": axes.iter().map(|axis| json!({
                        "parameter": axis.name, "from": axis.range[0], "to": axis.range[1],
                    })).collect::<Vec<_>>(),
                    "exact": found.exact,
                    "notes": found.notes,
                })
            },
            |out, style| {
                let rows = quantities.iter().zip(&found.peaks).map(|(quantity, [least, largest])| Extreme {
                    quantity: quantity.clone(),
                    least: least.as_ref().map(words),
                    largest: largest.as_ref().map(words),
                });
                view::combinations::write_envelope(out, "at", &rows.collect::<Vec<_>>(), &found.notes, units, style)
            },
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
