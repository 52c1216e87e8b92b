//! What a face shows all the time: quantities of the state shown, beside what its commands print.

use std::sync::Arc;

use crate::model::quantity::{self, Quantity};
use crate::path::quantity::Facts;
use crate::solve::Prepared;
use crate::view;
use crate::view::style::Role;
use crate::watch::Watch;

use super::Session;
use super::language::grammar::resolve;
use super::language::tokens;

/// A quantity with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    /// The quantity as `show` takes it; for a probe its name.
    pub quantity: Quantity,
    /// Its value with the unit, or why there is none.
    pub value: String,
    /// How the value looks.
    pub role: Role,
}

impl Session {
    /// The probes of the scenario and the quantities `asked`, in the state shown or at the end of a stage that was
    /// followed (from 0). Without either, what is usually looked at first.
    pub fn gauges(&self, asked: &[Quantity], stage: Option<usize>, watch: &dyn Watch) -> Vec<Gauge> {
        let scenario = self.scenario();
        let probe = |(name, quantity): &(String, Quantity)| Quantity::Probe(name.clone(), Box::new(quantity.clone()));
        let mut quantities: Vec<Quantity> = scenario.probes.iter().map(probe).collect();
        quantities.extend(asked.iter().cloned());
        if quantities.is_empty() {
            quantities = self.usual_quantities();
        }
        let read = |facts: &Facts<'_>| -> Vec<Gauge> {
            let gauge = |quantity: Quantity| {
                let (value, role) = view::quantities::shown(&quantity, &facts.value(&quantity), &scenario.units);
                Gauge { quantity, value, role }
            };
            quantities.into_iter().map(gauge).collect()
        };
        self.with_facts(watch, |facts| match stage.zip(self.history_followed()) {
            Some((stage, history)) if stage < history.stages.len() => read(&facts.at_stage(&history, stage)),
            _ => read(facts),
        })
    }

    /// Resultants of the edge contacts, or sums and extremes over the pairs.
    fn usual_quantities(&self) -> Vec<Quantity> {
        let names = self.names();
        let joints = names.joints();
        let mut texts: Vec<String> = Vec::new();
        for joint in &joints {
            texts.extend(["N", "T", "e"].map(|component| format!("resultant {joint} {component}")));
        }
        if joints.is_empty() {
            texts.extend(["sum x_n *", "min reserve *"].map(str::to_owned));
        }
        texts.extend(["max z_t *", "min z_t *", "max u"].map(str::to_owned));
        // those that make no sense here are refused
        let words = |text: &String| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        texts.iter().filter_map(|text| quantity::read_all(&words(text), &names).ok()).flatten().collect()
    }

    /// The quantities that a line asks for by `show`.
    pub fn quantities_asked(&self, line: &str) -> Vec<Quantity> {
        let words = tokens::split(line).unwrap_or_default();
        match words.split_first() {
            Some((first, rest)) if !rest.is_empty() && resolve(first).is_ok_and(|command| command.name == "show") => {
                self.quantities(rest).unwrap_or_default()
            }
            _ => Vec::new(),
        }
    }

    /// The combination whose answer is shown in the place of the scenario's own.
    pub fn combination(&self) -> Option<&str> {
        self.combination.as_ref().map(|(name, _)| name.as_str())
    }

    /// The geometry with the factors of what is shown: those of a combination, or the scenario's own.
    pub(super) fn prepared_shown(&self) -> Option<&Arc<Prepared>> {
        self.combination.as_ref().map(|(_, combined)| combined).or(self.now.prepared.as_ref())
    }
}
