//! What the integration tests share: load and solve in one line, compare, and judge an answer by hand.

#![allow(dead_code)] // every test binary uses its own part

pub mod balance;
pub mod laws;
pub mod lines;
pub mod systems;

use std::path::Path;

use serde_json::Value;
use stickslip::answer::record::{Answer, OutcomeKind, PairState, RayClass, State};
use stickslip::model::embedded;
use stickslip::model::load::{at_values, load_text};
use stickslip::model::parameter::ParameterValues;
use stickslip::model::rules::{Covering, Rules, TieBreak};
use stickslip::model::scenario::Scenario;
use stickslip::solve::{Prepared, Solved, prepare};
use stickslip::watch::Quiet;

/// A scenario with its prepared geometry.
pub struct Case {
    pub scenario: Scenario,
    pub prepared: Prepared,
}

impl Case {
    /// An embedded scenario.
    pub fn embedded(name: &str) -> Case {
        Case::text(embedded::text(name).expect("an embedded scenario"))
    }

    /// The same read under other values.
    pub fn at(&self, values: &ParameterValues) -> Case {
        let scenario = at_values(&self.scenario, values).unwrap_or_else(|e| panic!("{e}"));
        let prepared = prepare(&scenario, &Quiet).unwrap_or_else(|e| panic!("{e}"));
        Case { scenario, prepared }
    }

    /// A scenario from its JSON text.
    pub fn text(text: &str) -> Case {
        let scenario = load_text("test", text, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let prepared = prepare(&scenario, &Quiet).unwrap_or_else(|e| panic!("{e}\n{text}"));
        Case { scenario, prepared }
    }

    /// A scenario from a JSON value that names files in a folder.
    pub fn in_folder(value: Value, folder: &Path) -> Case {
        let text = scenario_text(value);
        let path = folder.join("scenario.json");
        let scenario = load_text("test", &text, Some(&path)).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let prepared = prepare(&scenario, &Quiet).unwrap_or_else(|e| panic!("{e}\n{text}"));
        Case { scenario, prepared }
    }

    /// A scenario from a JSON value; `format` and `title` are added.
    pub fn json(value: Value) -> Case {
        Case::text(&scenario_text(value))
    }

    /// Solved with the parameters as in the file, except those given, under the file's rules.
    pub fn solve(&self, set: &[(&str, f64)]) -> Answer {
        self.solve_under(set, self.scenario.rules)
    }

    /// The same under other rules.
    pub fn solve_under(&self, set: &[(&str, f64)], rules: Rules) -> Answer {
        self.solved(set, rules).answer
    }

    /// The same with its trace.
    pub fn solved(&self, set: &[(&str, f64)], rules: Rules) -> Solved {
        let mut values = self.scenario.parameter_values();
        for (name, value) in set {
            values.insert((*name).to_owned(), *value).expect("a parameter");
        }
        self.prepared.case(&self.scenario, &values).under(rules).solve().unwrap_or_else(|e| panic!("{e}"))
    }
}

/// The text of a scenario; `format` and `title` are added.
pub fn scenario_text(mut value: Value) -> String {
    value["format"] = "stickslip/1".into();
    value["title"] = "test".into();
    value.to_string()
}

/// Default tie-break, given covering.
pub fn covering(covering: Covering) -> Rules {
    Rules { covering, ..Rules::default() }
}

/// Every covering with every tie rule.
pub fn all_rules() -> Vec<Rules> {
    let ties = [TieBreak::Lexicographic, TieBreak::Natural, TieBreak::FirstRow, TieBreak::Random(7)];
    let mut all = Vec::new();
    for covering in Covering::ALL {
        for tie_break in ties {
            all.push(Rules { covering, tie_break, ..Rules::default() });
        }
    }
    all
}

/// |found − expected| ≤ tolerance × size.
#[track_caller]
pub fn near(what: &str, found: f64, expected: f64, tolerance: f64, size: f64) {
    assert!(
        (found - expected).abs() <= tolerance * size.abs(),
        "{what}: found {found:.17e}, expected {expected:.17e}, off by {:.1e} of {size:e}",
        (found - expected).abs() / size.abs()
    );
}

/// Relative to the expected value.
#[track_caller]
pub fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    near(what, found, expected, tolerance, expected);
}

/// Equal to the printed figure, half a unit of its last digit (given as `unit`) allowed.
#[track_caller]
pub fn printed(what: &str, found: f64, figure: f64, unit: f64) {
    assert!((found - figure).abs() <= 0.5001 * unit, "{what}: found {found}, printed {figure}");
}

/// Each entry, relative to the largest expected one.
#[track_caller]
pub fn near_all(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = expected.iter().fold(0f64, |a, b| a.max(b.abs()));
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        near(&format!("{what}[{i}]"), *found, *expected, tolerance, if size > 0.0 { size } else { 1.0 });
    }
}

#[track_caller]
pub fn is_answer(answer: &Answer) {
    assert!(
        answer.is_answer(),
        "no answer: {:?} {:?} {:?} {:?}",
        answer.outcome,
        answer.failure,
        answer.ray,
        answer.check
    );
    assert!(answer.check.passed);
    assert_eq!(answer.p, if answer.marginal { answer.p } else { 0.0 });
}

/// The ray of a mechanism.
#[track_caller]
pub fn mechanism(answer: &Answer) -> &stickslip::answer::record::Ray {
    assert_eq!(answer.outcome, OutcomeKind::Ray, "{:?}", answer.failure);
    let ray = answer.ray.as_ref().expect("a ray");
    assert_eq!(ray.class, RayClass::Mechanism, "{ray:?}");
    assert_eq!(ray.p, answer.p);
    assert!(ray.p > 0.0);
    ray
}

/// One figure of every pair.
pub fn of_pairs(answer: &Answer, read: impl Fn(&PairState) -> f64) -> Vec<f64> {
    answer.pairs.iter().map(read).collect()
}

pub fn states(answer: &Answer) -> Vec<State> {
    answer.pairs.iter().map(|pair| pair.state).collect()
}

pub fn count(answer: &Answer, state: State) -> usize {
    answer.pairs.iter().filter(|p| p.state == state).count()
}

/// (u_x, u_y, θ) of a node.
pub fn displacement(answer: &Answer, node: &str) -> [f64; 3] {
    let all = answer.displacements.as_ref().expect("displacements");
    let found = all.iter().find(|d| d.node == node).expect("a node");
    [found.ux, found.uy, found.rz]
}
