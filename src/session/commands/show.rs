//! `show`: quantities of the present answer; probes and resultants as they stand in results.

use clap::Args;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use crate::answer::record::Answer;
use crate::export::{history as history_export, json as json_export};
use crate::model::quantity::{self, Names, Quantity};
use crate::model::units::Units;
use crate::path::quantity::{Facts, Resultant, Value};
use crate::view::quantities as quantities_view;
use crate::watch::{Quiet, Watch};

use crate::session::language::command::{Action, Command};
use crate::session::language::quantities;
use crate::session::{CommandError, Next, Output, Session};

const EXAMPLE: &str = "Example:\n  show x_n c1, z_t c6\n  show sum x_n *, count stick";

/// Show quantities of the answer: forces, slips, displacements, stresses, limits
///
/// Commas may separate several. Without a quantity the probes of the scenario are shown. The same words stand in
/// `expect`, in probes, in `envelope`, `sweep --columns`, `trace … of` and `plot path`.
#[derive(Debug, Args)]
#[command(
    visible_alias = "probes",
    after_help = EXAMPLE,
    after_long_help = format!("{}\n\n{EXAMPLE}", quantities::help())
)]
pub struct Show {
    /// The quantities
    #[arg(value_name = "QUANTITY", allow_negative_numbers = true)]
    words: Vec<String>,
}

pub const SHOW: Command = Command {
    in_0_1: false,
    alias: Some("probes"),
    complete: |asked| asked.quantities(asked.given),
    ..Command::of::<Show>("show")
};

impl Action for Show {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.show(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        self.words.iter().any(|word| word == "pivots")
    }
}

/// A quantity with its value, or the reason why it has none.
#[derive(Serialize)]
struct Row {
    quantity: String,
    value: Json,
    unit: Option<String>,
    reason: Option<String>,
    /// Where an extreme stands.
    at: Option<String>,
}

impl Row {
    fn of((quantity, value, at): &quantities_view::Shown, units: &Units) -> Row {
        Row {
            quantity: quantity.to_string(),
            value: value.as_ref().map_or(Json::Null, Value::json),
            unit: quantity.unit(units),
            reason: value.as_ref().err().map(|reason| reason.0.clone()),
            at: at.clone(),
        }
    }
}

impl Session {
    /// The names quantities may have as arguments.
    pub(in crate::session) fn names(&self) -> Names<'_> {
        Names::of(&self.now.scenario)
    }

    /// What quantities are read from: the answer, or its pivot that is shown.
    pub(in crate::session) fn with_facts<T>(&self, watch: &dyn Watch, read: impl FnOnce(&Facts<'_>) -> T) -> T {
        let scenario = &self.now.scenario;
        let (Some(solved), Some(prepared)) = (&self.solved, self.prepared_shown()) else {
            return read(&Facts::of_nothing(scenario, &self.now.values, watch));
        };
        let facts = Facts::of_answer(self.now.case(prepared, watch), solved);
        if let Some(history) = &self.followed {
            return read(&facts.of_history(history));
        }
        if self.position.is_none() {
            return read(&facts);
        }
        let (pairs, displacements) = (self.pairs(), self.displacements());
        read(&facts.at_pivot(&pairs, displacements.as_deref(), self.p()))
    }

    /// Quantities named in the words of a command.
    pub(in crate::session) fn quantities(&self, words: &[String]) -> Result<Vec<Quantity>, CommandError> {
        quantity::read_all(words, &self.names()).map_err(|error| CommandError::Refused(error.to_string()))
    }

    /// `show QUANTITY …`; without one, all probes.
    pub(in crate::session) fn show(&self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let quantities = if words.is_empty() { self.all_probes()? } else { self.quantities(words)? };
        let values: Vec<quantities_view::Shown> = self.with_facts(io.watch, |facts| {
            let of = |quantity: Quantity| (quantity.clone(), facts.value(&quantity), facts.place(&quantity));
            quantities.into_iter().map(of).collect()
        });
        if io.watch.stop() {
            return Err(CommandError::Interrupted);
        }
        let units = &self.now.scenario.units;
        let rows: Vec<Row> = values.iter().map(|shown| Row::of(shown, units)).collect();
        io.show(&rows, |out, style| {
            self.write_place_shown(out, style)?;
            quantities_view::write(out, &values, units, style)
        })?;
        Ok(())
    }

    /// The probes of the scenario as quantities.
    pub(in crate::session) fn all_probes(&self) -> Result<Vec<Quantity>, CommandError> {
        let probes = &self.now.scenario.probes;
        if probes.is_empty() {
            return Err(CommandError::Refused(
                "which quantity? The scenario has no `probes`; `help show` lists the quantities".into(),
            ));
        }
        Ok(probes.iter().map(|(name, quantity)| Quantity::Probe(name.clone(), Box::new(quantity.clone()))).collect())
    }

    /// The value of every probe, null where it has none.
    pub(in crate::session) fn probe_values(&self, facts: &Facts<'_>) -> Map<String, Json> {
        let probes = self.now.scenario.probes.iter();
        probes.map(|(name, quantity)| (name.clone(), facts.value(quantity).map_or(Json::Null, |v| v.json()))).collect()
    }

    /// The resultants of all edge contacts.
    pub(in crate::session) fn resultants(&self, facts: &Facts<'_>) -> Vec<Resultant> {
        self.names().joints().into_iter().filter_map(|joint| facts.resultant(joint)).collect()
    }

    /// The present answer, or the load history that was followed, as `solve --format json` prints it; `None` while there
    /// is none.
    pub fn result(&self, timings: bool) -> Option<Json> {
        let (name, values) = (&self.now.scenario.name, &self.now.values);
        let mut result = match &self.followed {
            Some(history) => history_export::result(history, name, values, timings)?,
            None => json_export::result(self.answer()?, name, values, timings),
        };
        let has_displacements = |answer: &Answer| answer.displacements.is_some();
        let is_whole = self.quantity_answer().is_some_and(has_displacements);
        self.with_facts(&Quiet, |facts| {
            self.add_quantities(&mut result, facts, is_whole);
            let stages = result.get_mut("stages").and_then(Json::as_array_mut);
            let Some((history, stages)) = self.followed.as_ref().zip(stages) else { return };
            for (number, stage) in stages.iter_mut().enumerate() {
                let is_whole = has_displacements(&history.stages[number].end);
                self.add_quantities(stage, &facts.at_stage(history, number), is_whole);
            }
        });
        Some(result)
    }

    /// Adds the probes, resultants and stresses of a state to its result; the latter where it has displacements.
    fn add_quantities(&self, result: &mut Json, facts: &Facts<'_>, is_whole: bool) {
        let Json::Object(object) = result else { return };
        let probes = self.probe_values(facts);
        if !probes.is_empty() {
            object.insert("probes".into(), Json::Object(probes));
        }
        if !is_whole {
            return;
        }
        let (resultants, stresses) = (self.resultants(facts), facts.stresses());
        if !resultants.is_empty() {
            object.insert("resultants".into(), json!(resultants));
        }
        if !stresses.is_empty() {
            object.insert("stresses".into(), json_export::without_signed_zeros(json!(stresses)));
        }
    }
}
