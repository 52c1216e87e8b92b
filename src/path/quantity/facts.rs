//! What quantities are read from: an answer, a pivot of it, a place of a path, the end of a stage.

use std::cell::OnceCell;

use nalgebra::DVector;

use super::value::{NoValue, none};
use crate::answer::record::{Answer, MemberForces, NodeDisplacement, PairState, Reaction};
use crate::fem::{Displacements, MainSystem};
use crate::model::parameter::ParameterValues;
use crate::model::rules::Rules;
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;
use crate::path::stages::History;
use crate::solve::prepared::Geometry;
use crate::solve::problem::{contact_problem, factors};
use crate::solve::{Case, Prepared, Solved};
use crate::watch::Watch;

/// What quantities are read from: one state of the structure, and what else is known around it.
pub struct Facts<'a> {
    pub(super) scenario: &'a Scenario,
    pub(super) values: &'a ParameterValues,
    pub(super) prepared: Option<&'a Prepared>,
    /// The answer as a whole; `None` at a place of a path.
    pub(super) answer: Option<&'a Answer>,
    /// Where the search for a limit starts.
    pub(super) solved: Option<&'a Solved>,
    /// Whether the state is that of the answer, not of a pivot before.
    pub(super) at_end: bool,
    pub(super) pairs: &'a [PairState],
    pub(super) p: Option<f64>,
    pub(super) factors: Vec<f64>,
    pub(super) displacements: OnceCell<Option<Displacements>>,
    pub(super) members: OnceCell<Vec<MemberForces>>,
    pub(super) history: Option<&'a History>,
    pub(super) rules: Rules,
    pub(super) watch: &'a dyn Watch,
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
            rules: case.rules,
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
            rules: scenario.rules,
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
            rules: self.rules,
            p: Some(stage.end.p),
            factors: stage.moments.last().map_or_else(Vec::new, |moment| moment.factors.clone()),
            displacements: OnceCell::from(stage.end.displacements.as_deref().map(from_nodes)),
            ..Facts::of_nothing(self.scenario, self.values, self.watch)
        }
    }

    pub(super) fn answer(&self) -> Result<&'a Answer, NoValue> {
        self.answer.ok_or_else(|| self.missing())
    }

    /// Why there is nothing to read, in words.
    pub(super) fn missing(&self) -> NoValue {
        NoValue("no answer".to_owned())
    }

    pub(super) fn structure(&self) -> Result<(&'a Structure, &'a MainSystem), NoValue> {
        match self.prepared.map(|prepared| &*prepared.geometry) {
            Some(Geometry::Structure { main, structure, .. }) => Ok((structure, main)),
            Some(_) => none("the scenario has no structure"),
            None => Err(self.missing()),
        }
    }

    pub(super) fn displacements(&self) -> Result<&Displacements, NoValue> {
        let found = self.displacements.get_or_init(|| {
            let (prepared, (_, main)) = (self.prepared?, self.structure().ok()?);
            let system = prepared.system()?;
            let problem = contact_problem(system, &self.factors, self.values);
            let z = self.joints(|pair| (pair.z_n, pair.slip()));
            Some(main.displacements(&self.factors, &problem.dislocation(&z)))
        });
        found.as_ref().ok_or_else(|| self.missing())
    }

    /// A normal number and those along the tangents of every pair over the joints.
    fn joints(&self, read: impl Fn(&PairState) -> (f64, Vec<f64>)) -> DVector<f64> {
        let Some(system) = self.prepared.and_then(Prepared::system) else { return DVector::zeros(0) };
        system.over_joints(self.pairs.iter().map(read))
    }

    pub(super) fn pair(&self, id: &str) -> Result<&'a PairState, NoValue> {
        self.pairs.iter().find(|pair| pair.id == id).ok_or_else(|| self.missing())
    }

    pub(super) fn node(&self, id: &str) -> Result<usize, NoValue> {
        let (structure, _) = self.structure()?;
        structure.nodes.iter().position(|node| node.id == id).ok_or_else(|| NoValue(format!("no node {id}")))
    }

    pub(super) fn reactions(&self) -> Result<Vec<Reaction>, NoValue> {
        if !self.at_end {
            return none("no reactions at this pivot: `step last`");
        }
        if let Some(answer) = self.answer {
            return answer.reactions.clone().ok_or_else(|| self.missing());
        }
        let (Some(prepared), u) = (self.prepared, self.displacements()?) else { return Err(self.missing()) };
        let force = self.joints(|pair| (pair.x_n, pair.friction()));
        prepared.reactions(u, &force, &self.factors).ok_or_else(|| self.missing())
    }
}

fn from_nodes(nodes: &[NodeDisplacement]) -> Displacements {
    nodes.iter().map(|node| node.all()).collect::<Vec<_>>().into()
}
