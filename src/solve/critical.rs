//! Critical friction of a scenario: above it more than one answer is possible for some load.

use super::error::QuestionError;
use super::prepared::Prepared;
use super::problem::{contact_problem, factors};
use crate::contact::schemes::critical::{CriticalFriction, critical_friction};
use crate::model::jet::Dependence;
use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::watch::Watch;

/// Blocks drawn at random where there are too many to try all.
const SAMPLES: u64 = 20_000;
/// Seed of these draws.
const SEED: u64 = 1;

impl Prepared {
    /// The value of a friction parameter above which more than one answer is possible for some load; in space on the polygon
    /// of these rules.
    ///
    /// # Errors
    /// No contact pairs; no Coulomb pair has this friction; stopped.
    pub fn critical_friction(
        &self,
        values: &ParameterValues,
        parameter: &str,
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<CriticalFriction, QuestionError> {
        let refused = |text: String| Err(QuestionError::Refused(text));
        let Some(system) = self.system() else {
            return refused("a bare LCP has no friction".to_owned());
        };
        let instead = format!("`find {parameter} A..B where outcome answer` tells where there are answers");
        if let Some(refusal) = system.dependence_refusal("critical", &instead) {
            return refused(refusal);
        }
        let along = values.along(parameter);
        let frictions = || system.pairs.iter().filter_map(|pair| pair.law.friction().map(|friction| (pair, friction)));
        if frictions().all(|(_, friction)| along.dependence(friction) == Dependence::Constant) {
            let names = values.formulas().free(frictions().flat_map(|(_, friction)| friction.names()));
            let names: Vec<String> = values.keys().filter(|name| names.contains(*name)).cloned().collect();
            return refused(if names.is_empty() {
                "no pair has a friction that is a parameter".to_owned()
            } else {
                format!("`{parameter}` is not the friction of any pair; expected {}", names.join(" or "))
            });
        }
        if let Some((pair, friction)) = frictions().find(|(_, f)| along.dependence(f) == Dependence::Nonlinear) {
            return refused(format!(
                "the friction of pair {}, {}, is not a linear function of {parameter}: `critical` needs one",
                pair.id,
                friction.text()
            ));
        }
        let factors = factors(self, values);
        let friction = |value: f64| {
            let mut values = values.clone();
            values.insert(parameter.to_owned(), value);
            contact_problem(system, &factors, &values).frictions()
        };
        if friction(0.0).iter().any(|f| *f < 0.0) {
            return refused(format!("at {parameter} = 0 a friction is negative: `critical` goes up from 0"));
        }
        let polygon = contact_problem(system, &factors, values).under(rules).polygon;
        let found = critical_friction(system, polygon, &friction, (SAMPLES, SEED), &mut |examined| {
            if examined.is_multiple_of(1024) {
                watch.progress(&format!("block {examined}"), 0.0);
            }
            watch.go_on()
        });
        if found.complete { Ok(found) } else { Err(QuestionError::Interrupted) }
    }
}
