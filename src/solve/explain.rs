//! Questions about a solved state: its ties, its dictionary, how far its scheme holds, what would stop a collapse, what
//! is loose.

use std::time::Duration;

use super::case::Case;
use super::cold::Extent;
use super::error::QuestionError;
use super::prepared::{Geometry, Prepared};
use super::problem::contact_problem;
use super::state::{RunData, Solved};
use crate::answer::record::RayClass;
use crate::contact::problem::ContactProblem;
use crate::explain::loose::{LoosePart, loose_pairs, loose_parts};
use crate::explain::margin::{FinalScheme, Margin, friction_margin, load_margin};
use crate::explain::motions::FreeMotions;
use crate::explain::ray::RayReport;
use crate::explain::remedy::{Remedies, remedies};
use crate::explain::tableau::{Dictionary, NoDictionary, dictionary};
use crate::explain::ties::{TieReport, ties};
use crate::explain::unpressed::unpressed;
use crate::explain::vertex::Naming;
use crate::lcp::basis_solution::vertex;
use crate::model::plausible;
use crate::model::problem::Problem;
use crate::model::rules::{Engine, Rules};
use crate::model::scenario::Scenario;
use crate::watch::{Budget, Watch};

/// Time for all remedies.
pub const REMEDY_TIME: Duration = Duration::from_secs(10);

impl Solved {
    fn naming<'a>(&'a self, prepared: &'a Prepared) -> Option<Naming<'a>> {
        match (&self.run, &*prepared.geometry) {
            (RunData::Contact { contact, .. }, _) => Some(Naming::Contact(contact, prepared.system()?)),
            (RunData::Plain { lcp, .. }, Geometry::Plain { names, .. }) => Some(Naming::Plain(lcp, names)),
            (RunData::Plain { .. }, _) => None,
        }
    }

    /// Ties and degenerate vertices of the run.
    ///
    /// # Errors
    /// Stopped from outside.
    pub fn ties(&self, prepared: &Prepared, watch: &dyn Watch) -> Result<Option<TieReport>, QuestionError> {
        let Some(naming) = self.naming(prepared) else { return Ok(None) };
        let pivots = self.pivots();
        let last = match &self.run {
            RunData::Contact { last, .. } => Some(last.clone()),
            RunData::Plain { lcp, .. } => vertex(lcp, &pivots.basis()),
        };
        let Some(last) = last else { return Ok(None) };
        let report = ties(&naming, pivots, &last, self.answer.rules.tie_break, watch);
        report.map(Some).ok_or(QuestionError::Interrupted)
    }

    /// The dictionary after pivot `step`; `None` as step: before the entry of p.
    ///
    /// # Errors
    /// Too large, singular.
    pub fn dictionary_at(&self, prepared: &Prepared, step: Option<usize>) -> Result<Dictionary, NoDictionary> {
        let naming = self.naming(prepared).ok_or(NoDictionary::Singular)?;
        dictionary(&naming, self.pivots(), step)
    }

    /// How far the final scheme holds, in every load factor and friction parameter; empty without an answer that came
    /// from pivots.
    pub fn margins(&self, Case { scenario, prepared, values, .. }: Case<'_>, pair: usize) -> Vec<Margin> {
        let (RunData::Contact { contact, problem, pivots, last }, Some(system)) = (&self.run, prepared.system()) else {
            return Vec::new();
        };
        if system.is_in_space() {
            // The last basis does not tell how far a slip may turn before its pair sticks.
            return Vec::new();
        }
        let basis = pivots.basis();
        if !self.answer.is_answer() || basis.p || self.answer.marginal {
            return Vec::new();
        }
        if self.answer.rules.engine.is_without_pivots() {
            return Vec::new();
        }
        let Some(fresh) = vertex(&contact.lcp, &basis) else {
            return Vec::new();
        };
        // A trivial answer has no vertex of its own in the trace.
        let point = if pivots.is_empty() { &fresh } else { last };
        let scheme = FinalScheme { contact, problem, basis: &basis, point };
        let mut margins: Vec<Margin> = prepared
            .cases
            .iter()
            .zip(&problem.factors)
            .zip(&system.loads)
            .filter_map(|(((name, _), factor), load)| load_margin(&scheme, pair, (name, load), *factor))
            .collect();
        let mut names: Vec<&str> = Vec::new();
        for pair in &system.pairs {
            if let Some(name) = pair.law.friction().and_then(|friction| friction.parameter())
                && !names.contains(&name)
            {
                names.push(name);
            }
        }
        for name in names {
            let present = values.get(name).copied().unwrap_or_default();
            let slider = scenario.parameters.get(name).and_then(|parameter| parameter.max);
            let end = (2.0 * present).max(slider.unwrap_or(1.0)).max(present);
            let at = |value: f64| {
                let mut values = values.clone();
                values.insert(name.to_owned(), value);
                contact_problem(system, &problem.factors, &values)
            };
            margins.extend(friction_margin(&scheme, pair, name, present, end, &at));
        }
        margins
    }
}

impl Prepared {
    /// What would stop a collapse; `None` where there is none. Takes at most [`REMEDY_TIME`] and says whether
    /// everything was tried.
    pub fn remedies(&self, solved: &Solved, watch: &dyn Watch) -> Option<Remedies> {
        let RunData::Contact { problem, .. } = &solved.run else {
            return None;
        };
        let mechanism = |report: &&RayReport| report.class == RayClass::Mechanism;
        let report = solved.ray.as_deref().filter(mechanism)?;
        let budget = Budget::new(watch, REMEDY_TIME);
        let solves = |changed: &ContactProblem| {
            let rules = Rules { engine: Engine::Scheme, ..Rules::default() };
            self.attempt_contact(changed, (rules, Extent::Whole), &budget).is_ok_and(|found| found.stands(changed.cone))
        };
        let parts = report.mode.as_ref().map_or(&[][..], |mode| mode.parts.as_slice());
        Some(remedies(problem, &FreeMotions::new(&problem.system, self.built()), parts, &solves, &budget))
    }

    /// What the scenario allows but can hardly mean, in the order of the file and under its values.
    pub fn warnings(&self, scenario: &Scenario) -> Vec<Problem> {
        let mut warnings = plausible::warnings(scenario);
        if let Geometry::Structure { system, .. } | Geometry::Contact { system, .. } = &*self.geometry {
            // A contact on the wrong side is reported once.
            let told: Vec<String> = warnings.iter().map(|warning| warning.path.clone()).collect();
            warnings.extend(unpressed(scenario, system).into_iter().filter(|warning| !told.contains(&warning.path)));
        }
        plausible::placed(scenario, warnings)
    }

    /// Parts that only contact holds, each with its motions in words.
    pub fn loose_parts(&self) -> Vec<LoosePart> {
        match &*self.geometry {
            Geometry::Structure { main, structure, .. } => loose_parts(structure, main.kernel_motions()),
            _ => Vec::new(),
        }
    }

    /// The same in sentences; for a contact system without a structure its motions pair by pair.
    pub fn loose_sentences(&self) -> Vec<String> {
        match &*self.geometry {
            Geometry::Contact { system, .. } => loose_pairs(system),
            _ => self.loose_parts().iter().map(LoosePart::sentence).collect(),
        }
    }
}
