//! The values of quantities: of an answer, of a pivot, of a place on a path.

use std::cell::OnceCell;
use std::fmt;

use nalgebra::DVector;

use super::limit;
use super::stages::History;
use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::{Answer, MemberForces, NodeDisplacement, PairState, Reaction};
use crate::answer::rounding::{balance, denoised, of_members, of_reactions};
use crate::answer::stress::{Stress, StressPlace};
use crate::fem::{Displacements, MainSystem, MembraneStress, NodeStress};
use crate::model::parameter::ParameterValues;
use crate::model::quantity::{BarPlace, Over, Quantity, ResultantPart, fits};
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;
use crate::solve::numbers::{contact_numbers, factors};
use crate::solve::prepared::Geometry;
use crate::solve::{Case, Prepared, Solved};
use crate::watch::Watch;

/// The value of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number in the scenario's units.
    Number(f64),
    /// A word, as in results.
    Word(String),
}

impl Value {
    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(value) => Some(*value),
            Value::Word(_) => None,
        }
    }

    /// As in JSON.
    pub fn json(&self) -> serde_json::Value {
        match self {
            // −0 reads as 0.
            Value::Number(value) => (value + 0.0).into(),
            Value::Word(word) => word.as_str().into(),
        }
    }
}

/// A quantity with its values at the places of a path; `None` where it has none.
pub type OnPath = (Quantity, Vec<Option<f64>>);

/// Why a quantity has no value here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoValue(pub String);

impl fmt::Display for NoValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

fn none<T>(why: impl Into<String>) -> Result<T, NoValue> {
    Err(NoValue(why.into()))
}

/// A state over the whole structure: at every node, in every element and pair.
pub struct Field<'a> {
    /// The structure.
    pub structure: &'a Structure,
    /// (u_x, u_y, rotation) of every node.
    pub displacements: &'a [[f64; 3]],
    /// At the nodes of membranes.
    pub node_stresses: Vec<NodeStress>,
    /// At the centres of membranes.
    pub element_stresses: Vec<MembraneStress>,
    /// Of the bars, element by element.
    pub members: &'a [MemberForces],
    /// The pairs, in the order of the structure.
    pub pairs: &'a [PairState],
}

/// What quantities are read from: one state of the structure, and what else is known around it.
pub struct Facts<'a> {
    scenario: &'a Scenario,
    values: &'a ParameterValues,
    prepared: Option<&'a Prepared>,
    /// The answer as a whole; `None` at a place of a path.
    answer: Option<&'a Answer>,
    /// Where the search for a limit starts.
    solved: Option<&'a Solved>,
    /// Whether the state is that of the answer, not of a pivot before.
    at_end: bool,
    pairs: &'a [PairState],
    p: Option<f64>,
    factors: Vec<f64>,
    displacements: OnceCell<Option<Displacements>>,
    members: OnceCell<Vec<MemberForces>>,
    history: Option<&'a History>,
    watch: &'a dyn Watch,
}

impl<'a> Facts<'a> {
    /// Of an answer.
    pub fn of_answer(case: Case<'a>, solved: &'a Solved) -> Facts<'a> {
        let displacements = solved.answer.displacements.as_deref().map(from_nodes);
        Facts {
            answer: Some(&solved.answer),
            solved: Some(solved),
            p: Some(solved.answer.p),
            displacements: OnceCell::from(displacements),
            ..Facts::of_state(case, factors(case.prepared, case.values), &solved.answer.pairs)
        }
    }

    /// Of a state without an answer behind it: a place of a path, the end of a stage.
    pub fn of_state(case: Case<'a>, factors: Vec<f64>, pairs: &'a [PairState]) -> Facts<'a> {
        Facts {
            prepared: Some(case.prepared),
            pairs,
            factors,
            displacements: OnceCell::new(),
            ..Facts::of_nothing(case.scenario, case.values, case.watch)
        }
    }

    /// Before anything was solved.
    pub fn of_nothing(scenario: &'a Scenario, values: &'a ParameterValues, watch: &'a dyn Watch) -> Facts<'a> {
        Facts {
            scenario,
            values,
            prepared: None,
            answer: None,
            solved: None,
            at_end: true,
            pairs: &[],
            p: None,
            factors: Vec::new(),
            displacements: OnceCell::from(None),
            members: OnceCell::new(),
            history: None,
            watch,
        }
    }

    /// The same at a pivot of the answer: its pairs, its displacements and its p.
    pub fn at_pivot(
        self,
        pairs: &'a [PairState],
        displacements: Option<&[NodeDisplacement]>,
        p: Option<f64>,
    ) -> Facts<'a> {
        Facts { pairs, p, displacements: OnceCell::from(displacements.map(from_nodes)), at_end: false, ..self }
    }

    /// Of a load history: the end of its last stage, and of the others.
    pub fn of_history(self, history: &'a History) -> Facts<'a> {
        match history.stages.len() {
            0 => Facts { history: Some(history), ..self },
            last => Facts { history: Some(history), ..self.at_stage(history, last - 1) },
        }
    }

    /// The end of a stage, from 0.
    pub fn at_stage(&self, history: &'a History, stage: usize) -> Facts<'a> {
        let stage = &history.stages[stage];
        Facts {
            answer: Some(&stage.end),
            prepared: self.prepared,
            pairs: &stage.end.pairs,
            p: Some(stage.end.p),
            factors: stage.moments.last().map_or_else(Vec::new, |moment| moment.factors.clone()),
            displacements: OnceCell::from(stage.end.displacements.as_deref().map(from_nodes)),
            ..Facts::of_nothing(self.scenario, self.values, self.watch)
        }
    }

    fn answer(&self) -> Result<&'a Answer, NoValue> {
        self.answer.ok_or_else(|| self.missing())
    }

    /// Why there is nothing to read, in words.
    fn missing(&self) -> NoValue {
        NoValue("no answer".to_owned())
    }

    fn structure(&self) -> Result<(&'a Structure, &'a MainSystem), NoValue> {
        match self.prepared.map(|prepared| &*prepared.geometry) {
            Some(Geometry::Structure { main, structure, .. }) => Ok((structure, main)),
            Some(_) => none("the scenario is no structure"),
            None => Err(self.missing()),
        }
    }

    fn displacements(&self) -> Result<&Displacements, NoValue> {
        let found = self.displacements.get_or_init(|| {
            let (prepared, (_, main)) = (self.prepared?, self.structure().ok()?);
            let system = prepared.system()?;
            let numbers = contact_numbers(system, &self.factors, self.values);
            Some(main.displacements(&self.factors, &numbers.dislocation(&self.joints(|pair| [pair.z_n, pair.z_t]))))
        });
        found.as_ref().ok_or_else(|| self.missing())
    }

    /// A normal and a tangential number of every pair over the joints.
    fn joints(&self, read: impl Fn(&PairState) -> [f64; 2]) -> DVector<f64> {
        let Some(system) = self.prepared.and_then(Prepared::system) else { return DVector::zeros(0) };
        let mut joints = DVector::zeros(system.joint_count());
        for (i, (pair, state)) in system.pairs.iter().zip(self.pairs).enumerate() {
            let [normal, tangential] = read(state);
            joints[i] = normal;
            if let Some(joint) = pair.tangential {
                joints[joint] = tangential;
            }
        }
        joints
    }

    fn pair(&self, id: &str) -> Result<&'a PairState, NoValue> {
        self.pairs.iter().find(|pair| pair.id == id).ok_or_else(|| self.missing())
    }

    fn node(&self, id: &str) -> Result<usize, NoValue> {
        let (structure, _) = self.structure()?;
        structure.nodes.iter().position(|node| node.id == id).ok_or_else(|| NoValue(format!("no node {id}")))
    }

    fn reactions(&self) -> Result<Vec<Reaction>, NoValue> {
        if !self.at_end {
            return none("no reactions at this pivot: `step last`");
        }
        if let Some(answer) = self.answer {
            return answer.reactions.clone().ok_or_else(|| self.missing());
        }
        let (Some(prepared), u) = (self.prepared, self.displacements()?) else { return Err(self.missing()) };
        let force = self.joints(|pair| [pair.x_n, pair.x_t]);
        prepared.reactions(u, &force, &self.factors).ok_or_else(|| self.missing())
    }

    /// The value of a quantity; a reason where it has none.
    ///
    /// # Errors
    /// See [`NoValue`].
    pub fn value(&self, quantity: &Quantity) -> Result<Value, NoValue> {
        match quantity {
            Quantity::Plain(word) => self.plain(word),
            Quantity::Pair("state", id) => Ok(Value::Word(self.pair(id)?.state.word().to_owned())),
            Quantity::Pair(word, id) => Ok(Value::Number(of_pair(word, self.pair(id)?))),
            Quantity::Stage(stage, inner) => self.of_stage(*stage, inner),
            Quantity::Probe(_, inner) => self.value(inner),
            _ => self.number(quantity).map(Value::Number),
        }
        .and_then(|value| match value {
            Value::Number(number) if !number.is_finite() => none("not a finite number"),
            value => Ok(value),
        })
    }

    fn number(&self, quantity: &Quantity) -> Result<f64, NoValue> {
        match quantity {
            Quantity::Plain(_) | Quantity::Pair(..) | Quantity::Stage(..) | Quantity::Probe(..) => {
                self.value(quantity)?.number().ok_or_else(|| NoValue("a word, no number".to_owned()))
            }
            Quantity::Pairs(over, word, pattern) => {
                let chosen = self.chosen(pattern)?.into_iter().map(|pair| of_pair(word, pair));
                Ok(match over {
                    Over::Sum => balance(chosen),
                    Over::Max => chosen.fold(f64::NEG_INFINITY, f64::max),
                    Over::Min => chosen.fold(f64::INFINITY, f64::min),
                })
            }
            Quantity::Count(state, pattern) => {
                Ok(self.chosen(pattern)?.into_iter().filter(|pair| pair.state.word() == *state).count() as f64)
            }
            Quantity::Resultant(joint, part) => {
                let found = self.resultant(joint).ok_or_else(|| self.missing())?;
                match part {
                    ResultantPart::Normal => Ok(found.normal),
                    ResultantPart::Tangential => Ok(found.tangential),
                    ResultantPart::Eccentricity => {
                        found.eccentricity.ok_or_else(|| NoValue("no eccentricity where N = 0".to_owned()))
                    }
                }
            }
            Quantity::Node(word, node) => self.of_node(word, node),
            Quantity::LargestDisplacement => {
                Ok(self.displacements()?.0.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max))
            }
            Quantity::Bar(word, bar, place) => self.of_bar(word, bar, *place),
            Quantity::NodeStress(word, node) => {
                let at = self.node(node)?;
                let found = self.node_stresses()?.into_iter().find(|stress| stress.node == at);
                let found = found.ok_or_else(|| NoValue(format!("no plate, quad or triangle at node {node}")))?;
                Ok(Stress::new(StressPlace::Node(node.clone()), found.stress).number(word))
            }
            Quantity::ElementStress(word, name) => {
                let element = self.structure()?.0.element_named(name);
                let element = element.ok_or_else(|| NoValue(format!("no element {name}")))?;
                let found = self.element_stresses()?.into_iter().find(|stress| stress.element == element);
                let found = found.ok_or_else(|| self.missing())?;
                Ok(Stress::new(StressPlace::Element(name.clone()), found.stress).number(word))
            }
            Quantity::Load(word, name) => self.of_load(word, name),
            Quantity::Critical(parameter) => {
                let prepared = self.prepared.ok_or_else(|| self.missing())?;
                let found = prepared
                    .critical_friction(self.values, parameter, self.watch)
                    .map_err(|error| NoValue(error.to_string()))?;
                found.value.ok_or_else(|| NoValue("no friction was found at which several answers are possible".into()))
            }
        }
    }

    fn node_stresses(&self) -> Result<Vec<NodeStress>, NoValue> {
        let (structure, main) = self.structure()?;
        Ok(main.node_stresses(structure, self.displacements()?, &self.factors))
    }

    fn element_stresses(&self) -> Result<Vec<MembraneStress>, NoValue> {
        let (structure, main) = self.structure()?;
        Ok(main.element_stresses(structure, self.displacements()?, &self.factors))
    }

    /// The stresses at the nodes of plates, quads and triangles, then those in the elements; empty where there are none.
    pub fn stresses(&self) -> Vec<Stress> {
        let (Ok((structure, _)), Ok(nodes), Ok(elements)) =
            (self.structure(), self.node_stresses(), self.element_stresses())
        else {
            return Vec::new();
        };
        let at_nodes = nodes.into_iter().map(|at| (StressPlace::Node(structure.nodes[at.node].id.clone()), at.stress));
        let inside = elements
            .into_iter()
            .filter_map(|at| Some((StressPlace::Element(structure.element_name(at.element)?), at.stress)));
        at_nodes.chain(inside).map(|(place, stress)| Stress::new(place, stress)).collect()
    }

    fn plain(&self, word: &str) -> Result<Value, NoValue> {
        let count = |count: usize| Ok(Value::Number(count as f64));
        let size = |size: Option<usize>| size.map_or_else(|| none("the scenario is no structure"), count);
        match word {
            "outcome" => Ok(Value::Word(written(&self.answer()?.outcome))),
            "class" | "verdict" => {
                let answer = self.answer()?;
                let Some(ray) = &answer.ray else {
                    return none(format!("outcome {}", written(&answer.outcome)));
                };
                match (word, ray.verdict) {
                    ("class", _) => Ok(Value::Word(written(&ray.class))),
                    (_, Some(verdict)) => Ok(Value::Word(written(&verdict))),
                    (_, None) => none("no verdict"),
                }
            }
            "p" => self.p.map(Value::Number).ok_or_else(|| self.missing()),
            "pivots" => count(self.answer()?.pivot_count),
            "lcp" => count(self.answer()?.size.lcp),
            "unknowns" => size(self.answer()?.size.unknowns),
            "free" => size(self.answer()?.size.free),
            "answers" => {
                let prepared = self.prepared.ok_or_else(|| self.missing())?;
                let all = prepared.all_answers(self.values, self.watch).map_err(|error| NoValue(error.to_string()))?;
                let proved = all.undecided == 0 && all.exact.iter().all(|exact| *exact);
                if !proved || all.continuum.iter().any(|continuum| *continuum) {
                    return none(format!("{} answers found, but their number is not proved", all.answers.len()));
                }
                count(all.answers.len())
            }
            "energy" => {
                let (_, main) = self.structure()?;
                Ok(Value::Number(main.strain_energy(self.displacements()?)))
            }
            "dissipated" => Ok(Value::Number(self.history()?.stages.iter().map(|stage| stage.dissipated).sum())),
            word => none(format!("no quantity {word}")),
        }
    }

    fn chosen(&self, pattern: &str) -> Result<Vec<&'a PairState>, NoValue> {
        let chosen: Vec<&PairState> = self.pairs.iter().filter(|pair| fits(pattern, &pair.id)).collect();
        if chosen.is_empty() { Err(self.missing()) } else { Ok(chosen) }
    }

    fn of_node(&self, word: &str, node: &str) -> Result<f64, NoValue> {
        let component = match word {
            "ux" => 0,
            "uy" => 1,
            "rz" => 2,
            _ => {
                let reactions = self.reactions()?;
                let found = reactions.iter().find(|reaction| reaction.node == node);
                let found = found.ok_or_else(|| NoValue(format!("no support at node {node}")))?;
                let [force, moment] = of_reactions(&reactions);
                return Ok(match word {
                    "fx" => denoised(found.fx, force),
                    "fy" => denoised(found.fy, force),
                    _ => denoised(found.m, moment),
                });
            }
        };
        let u = self.displacements()?;
        Ok(u.0[self.node(node)?][component])
    }

    fn members(&self) -> Result<&[MemberForces], NoValue> {
        let (_, u) = (self.structure()?, self.displacements()?);
        Ok(self.members.get_or_init(|| {
            let at_end = self.answer.filter(|_| self.at_end).and_then(|answer| answer.members.clone());
            at_end.or_else(|| self.prepared?.members(u, &self.factors)).unwrap_or_default()
        }))
    }

    /// The state over the whole structure.
    ///
    /// # Errors
    /// No structure, or no displacements.
    pub fn field(&self) -> Result<Field<'_>, NoValue> {
        let ((structure, main), u) = (self.structure()?, self.displacements()?);
        Ok(Field {
            structure,
            displacements: &u.0,
            node_stresses: main.node_stresses(structure, u, &self.factors),
            element_stresses: main.element_stresses(structure, u, &self.factors),
            members: self.members()?,
            pairs: self.pairs,
        })
    }

    fn of_bar(&self, word: &str, bar: &str, place: BarPlace) -> Result<f64, NoValue> {
        let members = self.members()?;
        let diagram = Diagram::of(members, bar).ok_or_else(|| self.missing())?;
        let [force, moment] = of_members(members.iter());
        let (which, scale) = match word {
            "N" => (Internal::Axial, force),
            "Q" => (Internal::Shear, force),
            _ => (Internal::Moment, moment),
        };
        let [least, largest] = diagram.extremes(which).map(|place| place.value);
        let beyond = |s: f64| NoValue(format!("{s} is beyond the bar {bar}, which is {} long", diagram.length()));
        match place {
            BarPlace::Start => diagram.at(which, 0.0).ok_or_else(|| self.missing()),
            BarPlace::End => diagram.at(which, diagram.length()).ok_or_else(|| self.missing()),
            BarPlace::At(s) => diagram.at(which, s).ok_or_else(|| beyond(s)),
            BarPlace::Over(Over::Min) => Ok(least),
            BarPlace::Over(_) => Ok(largest),
            BarPlace::Extreme => Ok(if least.abs() > largest.abs() { least } else { largest }),
        }
        .map(|value| denoised(value, scale))
    }

    fn of_load(&self, word: &str, name: &str) -> Result<f64, NoValue> {
        let prepared = self.prepared.ok_or_else(|| self.missing())?;
        let case = prepared.case(self.scenario, self.values).watched(self.watch);
        let found = limit::limit(case, self.solved, name).map_err(|error| NoValue(error.to_string()))?;
        let value = if word == "limit" { found.factor } else { found.safety };
        value.ok_or_else(|| NoValue(format!("no limit: {}", found.end_sentence())))
    }

    fn history(&self) -> Result<&'a History, NoValue> {
        self.history.ok_or_else(|| NoValue("of which history? `stages` follows that of the scenario first".to_owned()))
    }

    fn of_stage(&self, stage: usize, inner: &Quantity) -> Result<Value, NoValue> {
        let history = self.history()?;
        // Stages count from 1.
        let Some(found) = history.stages.get(stage - 1) else {
            return none(format!("stage {stage} was not reached: {}", history.end_sentence()));
        };
        match inner {
            Quantity::Plain("dissipated") => Ok(Value::Number(found.dissipated)),
            inner => self.at_stage(history, stage - 1).value(inner),
        }
    }

    /// Of an edge contact.
    pub fn resultant(&self, joint: &str) -> Option<Resultant> {
        let head = format!("{joint}[");
        let pairs: Vec<&PairState> = self.pairs.iter().filter(|pair| pair.id.starts_with(&head)).collect();
        let normal = balance(pairs.iter().map(|pair| pair.x_n));
        let tangential = balance(pairs.iter().map(|pair| pair.x_t));
        let places = self.places(joint, &pairs);
        let moment: Option<f64> = pairs.iter().zip(&places).map(|(pair, s)| Some(pair.x_n * (*s)?)).sum();
        let eccentricity = moment.map(|moment| moment / normal).filter(|e| normal != 0.0 && e.is_finite());
        (!pairs.is_empty()).then(|| Resultant { joint: joint.to_owned(), normal, tangential, eccentricity })
    }

    /// Places of pairs of a joint along it, from its middle: along the nodes of its edge, or by the positions of a given
    /// contact system.
    fn places(&self, joint: &str, pairs: &[&PairState]) -> Vec<Option<f64>> {
        if let Ok((structure, _)) = self.structure()
            && let Some(edge) = structure.edge_contacts.iter().find(|edge| edge.id == joint)
        {
            let at = |node: usize| structure.nodes[node].position;
            let mut lengths = vec![0.0];
            for ends in edge.nodes.windows(2) {
                let (a, b) = (at(ends[0]), at(ends[1]));
                lengths.push(lengths[lengths.len() - 1] + (b[0] - a[0]).hypot(b[1] - a[1]));
            }
            let middle = 0.5 * lengths[lengths.len() - 1];
            let index = |id: &str| id.strip_prefix(joint)?.strip_prefix('[')?.strip_suffix(']')?.parse::<usize>().ok();
            return pairs.iter().map(|pair| Some(lengths.get(index(&pair.id)?)? - middle)).collect();
        }
        let place = |pair: &&PairState| pair.position.map(|at| at[0]);
        let ends = pairs.first().and_then(place).zip(pairs.last().and_then(place));
        pairs.iter().map(|pair| Some(place(pair)? - ends.map(|(a, b)| 0.5 * (a + b))?)).collect()
    }
}

/// Resultant of the forces of an edge contact.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Resultant {
    /// Id of the contact.
    pub joint: String,
    /// Σ x_n.
    #[serde(rename = "N")]
    pub normal: f64,
    /// Σ x_t.
    #[serde(rename = "T")]
    pub tangential: f64,
    /// Distance of N from the middle, > 0 towards later nodes; `None` where N = 0.
    #[serde(rename = "e")]
    pub eccentricity: Option<f64>,
}

/// A number of a pair.
pub fn of_pair(word: &str, pair: &PairState) -> f64 {
    match word {
        "x_n" => pair.x_n,
        "x_t" => pair.x_t,
        "z_n" => pair.z_n,
        "z_t" => pair.z_t,
        "bound" => pair.bound,
        "reserve_plus" => pair.reserve_plus,
        "reserve_minus" => pair.reserve_minus,
        // The only word of the table that is left.
        _ => pair.bound - pair.x_t.abs(),
    }
}

/// The word of an outcome, class or verdict, as in results.
pub(super) fn written(word: &impl serde::Serialize) -> String {
    serde_json::to_value(word).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default()
}

fn from_nodes(nodes: &[NodeDisplacement]) -> Displacements {
    nodes.iter().map(|node| [node.ux, node.uy, node.rz]).collect::<Vec<_>>().into()
}
