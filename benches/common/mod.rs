//! Contact problems for measurements, generated: two plates on one another, the lower one fixed along its base.

#[allow(dead_code)] // each example uses only a part of this module
pub mod block;

use stickslip::contact::problem::ContactProblem;
use stickslip::model::load::load_text;
use stickslip::model::parameter::ParameterValues;
use stickslip::model::scenario::Scenario;
use stickslip::solve::problem::{contact_problem, factors};
use stickslip::solve::{Prepared, prepare};
use stickslip::watch::Quiet;

/// What acts on the upper plate besides its weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pull {
    /// Forward and up on one side, springs on the same side: no symmetry, a few accidental ties.
    OneSided,
    /// Outward on both sides, springs on both sides: mirror images of each other slip and stop in ties.
    Symmetric,
}

/// Two plates, 8 long and 4 high each unless `size` says otherwise.
#[derive(Clone, Copy, Debug)]
pub struct Plates {
    /// Elements of each plate along and across the joint: `divisions[0] + 1` pairs.
    pub divisions: [usize; 2],
    /// Size of each plate.
    pub size: [f64; 2],
    /// f of all pairs, parameter `f`.
    pub friction: f64,
    /// Traction on the sides, parameter `T`.
    pub traction: f64,
    /// Where it acts.
    pub pull: Pull,
    /// Load cases in all, at least 2; those after `weight` and `pull` have the factor 0.
    pub cases: usize,
}

impl Plates {
    /// `pairs` pairs, plates of nearly square elements (at most 40 across), a pull that slides and lifts a part.
    pub fn with_pairs(pairs: usize, friction: f64) -> Plates {
        Plates {
            divisions: [pairs - 1, (pairs / 8).clamp(4, 40)],
            size: [8.0, 4.0],
            friction,
            traction: 60.0,
            pull: Pull::OneSided,
            cases: 2,
        }
    }

    /// The scenario file.
    pub fn text(&self) -> String {
        let [nx, ny] = self.divisions;
        let [width, height] = self.size;
        let (f, t) = (self.friction, self.traction);
        let (pull, springs) = match self.pull {
            Pull::OneSided => (
                r#"{"traction":{"edge":"upper.left","value":[1,0.7]}}"#,
                r#"{"at":"upper.left","direction":[1,0],"stiffness":10}"#,
            ),
            Pull::Symmetric => (
                r#"{"traction":{"edge":"upper.left","value":[-1,0]}},
                   {"traction":{"edge":"upper.right","value":[1,0]}}"#,
                r#"{"at":"upper.left","direction":[1,0],"stiffness":10},
                   {"at":"upper.right","direction":[1,0],"stiffness":10}"#,
            ),
        };
        let further: String = (2..self.cases)
            .map(|case| {
                format!(
                    r#","c{case}":{{"factor":0,"items":[{{"traction":{{"edge":"upper.top","value":[{case},-1]}}}}]}}"#
                )
            })
            .collect();
        format!(
            r#"{{"format":"stickslip/1","title":"Two plates","parameters":{{"f":{f},"T":{t}}},
"materials":{{"m":{{"E":1e5,"nu":0.3}}}},
"plates":[
{{"id":"lower","origin":[0,0],"size":[{width},{height}],"divisions":[{nx},{ny}],"thickness":0.1,"material":"m","plane":"strain"}},
{{"id":"upper","origin":[0,{height}],"size":[{width},{height}],"divisions":[{nx},{ny}],"thickness":0.1,"material":"m","plane":"strain"}}],
"supports":[{{"at":"lower.bottom","fixed":["x","y"]}}],
"springs":[{springs}],
"contacts":[{{"id":"joint","edge":"upper.bottom","against":"lower.top","friction":"f"}}],
"loads":{{"weight":{{"items":[{{"traction":{{"edge":"upper.top","value":[0,-100]}}}}]}},
"pull":{{"factor":"T","items":[{pull}]}}{further}}}}}"#
        )
    }

    /// The same with `T` inside the loads and the width of the upper plate a parameter `b`: what moves then is RF with
    /// the kept factorization, or K.
    pub fn inner_scenario(&self) -> Scenario {
        let text = self
            .text()
            .replace(r#""factor":"T","#, "")
            .replace(r#""value":[1,0.7]"#, r#""value":["T","0.7*T"]"#)
            .replace(r#""parameters":{"#, &format!(r#""parameters":{{"b":{},"#, self.size[0]))
            .replace(&format!(r#""size":[{},"#, self.size[0]), r#""size":["b","#);
        load_text("plates", &text, None).expect("the generated scenario is sound")
    }

    /// The same with springs under the whole top of the upper plate as well: it stands without its contacts.
    pub fn standing_scenario(&self) -> Scenario {
        let held = r#""springs":[{"at":"upper.top","direction":[0,1],"stiffness":1},"#;
        let text = self.text().replace(r#""springs":["#, held).replace(r#""stiffness":10}"#, r#""stiffness":3000}"#);
        load_text("plates", &text, None).expect("the generated scenario is sound")
    }

    /// The scenario, loaded.
    pub fn scenario(&self) -> Scenario {
        load_text("plates", &self.text(), None).expect("the generated scenario is sound")
    }
}

/// A block of nx × ny × nz bricks, 3 × 3 × 1, on a rough plane: pushed on one side by two thirds of what it can bear.
#[allow(dead_code)] // as above
pub fn brick_block([nx, ny, nz]: [usize; 3], facets: usize, cone: &str) -> Scenario {
    let text = format!(
        r#"{{"format":"stickslip/1","dimension":3,"title":"Block of bricks",
"materials":{{"concrete":{{"E":3e7,"nu":0.2,"density":25}}}},
"bricks":[{{"id":"block","origin":[0,0,0],"size":[3,3,1],"divisions":[{nx},{ny},{nz}],"material":"concrete"}}],
"contacts":[{{"id":"base","face":"block.bottom","against":"ground","friction":0.5}}],
"loads":{{"weight":{{"items":[{{"gravity":{{"acceleration":[0,0,-1]}}}}]}},
"push":{{"items":[{{"traction":{{"face":"block.right","value":[24,7,0]}}}}]}}}},
"solver":{{"facets":{facets},"cone":{cone}}}}}"#
    );
    load_text("block", &text, None).expect("the generated scenario is sound")
}

/// A scenario with all that depends on its geometry alone.
pub struct Ready {
    /// The scenario.
    pub scenario: Scenario,
    /// Factorized and condensed.
    pub prepared: Prepared,
}

impl Ready {
    /// Loads and condenses.
    pub fn new(plates: &Plates) -> Ready {
        let scenario = plates.scenario();
        let prepared = prepare(&scenario, &Quiet).expect("two plates stand in the main system");
        Ready { scenario, prepared }
    }

    /// The scenario's values with some of them changed.
    pub fn values(&self, changes: &[(&str, f64)]) -> ParameterValues {
        let mut values = self.scenario.parameter_values();
        for (name, value) in changes {
            values.insert((*name).to_owned(), *value);
        }
        values
    }

    /// The contact problem.
    pub fn problem(&self, values: &ParameterValues) -> ContactProblem {
        let system = self.prepared.system().expect("contact is condensed");
        contact_problem(system, &factors(&self.prepared, values), values)
    }
}
