//! `help ray`: how to find out what a ray means, step by step, with the names of the problem that is loaded.

use crate::answer::record::{Direction, Ray, RayClass};
use crate::model::scenario::{Scenario, Source};
use crate::session::Session;
use crate::session::language::{tokens, topics};
use crate::view::style::Style;

/// More load cases or friction coefficients than this are not gone through.
const MOST: usize = 3;
/// All working schemes of more pairs take long.
const FEW_PAIRS: usize = 10;

/// Commands to type, and what they show.
type Step = (Vec<String>, &'static str);

impl Session {
    /// The steps, with the commands for the present problem.
    pub(in crate::session) fn ray_guide(&self, style: &Style) -> String {
        let name = &self.scenario().name;
        let ray = self.answer().and_then(|answer| answer.ray.as_ref());
        let intro = match (ray, self.answer()) {
            (Some(ray), _) => format!("{name} ends in a ray, {}.", class(ray)),
            (None, Some(answer)) => {
                format!("{name} has no ray now, its outcome is {}; if it had one:", answer.outcome.word())
            }
            (None, None) => format!("{name} is not solved yet; if it ends in a ray:"),
        };
        let mut lines = vec![(String::new(), intro)];
        for (number, (commands, tells)) in self.ray_steps().into_iter().enumerate() {
            let commands: Vec<String> = commands.iter().map(|command| format!("`{command}`")).collect();
            lines.push((format!("{}. ", number + 1), format!("{}: {tells}", commands.join(", "))));
        }
        topics::hanging(lines.iter().map(|(label, text)| (label.as_str(), text.as_str())), style)
    }

    /// Every command of the guide is one for the present problem.
    fn ray_steps(&self) -> Vec<Step> {
        let one = |command: &str| vec![command.to_owned()];
        let ray = self.answer().and_then(|answer| answer.ray.as_ref());
        let mut steps: Vec<Step> = Vec::new();
        if ray.is_some() {
            steps.push((
                one("ray"),
                "its class. A mechanism is a collapse, certified or proved; an artefact or a fault is the run's, not the \
                 structure's; no equilibrium: nothing is known but that the run found none. It also says what would help.",
            ));
        }
        if let Source::Lcp(_) = self.scenario().source {
            steps.extend(self.steps_of_lcp());
            return steps;
        }
        if ray.is_some_and(|ray| ray.class == RayClass::Mechanism) {
            steps.push((one("plot mode"), "what moves. A part that should not move lacks a support."));
        }
        let pair = ray.and_then(moving_pair).or_else(|| self.pairs().first().map(|pair| pair.id.clone()));
        if let Some(pair) = pair {
            steps.push((vec![format!("why {pair}")], "a pair of it: its reserves, and the pivots that turned it."));
        }
        let scenario = self.scenario();
        let limits: Vec<String> = cases(scenario).take(MOST).map(|case| format!("limit {case}")).collect();
        if !limits.is_empty() {
            steps.push((
                limits,
                "how much of each load is borne beside the others; without one that holds the rest down nothing is.",
            ));
        }
        let frictions: Vec<String> = frictions(scenario)
            .into_iter()
            .take(MOST)
            .map(|name| format!("find least {name} where outcome answer"))
            .collect();
        if !frictions.is_empty() {
            steps.push((frictions, "the friction that would do, between an answer and a proved collapse."));
        }
        steps.push((
            one("compare"),
            "every covering, tie-break and engine: if one of them finds an answer, only the run failed.",
        ));
        if self.pairs().len() <= FEW_PAIRS {
            steps.push((
                one("enumerate"),
                "all working schemes in exact arithmetic: that there is no answer is then proved.",
            ));
        }
        steps.push((vec!["pivots".to_owned(), "ties".to_owned()], "how the run came there, and where rows were tied."));
        steps
    }

    fn steps_of_lcp(&self) -> Vec<Step> {
        let one = |command: &str| vec![command.to_owned()];
        let size = self.solution().map_or(0, |solution| solution.z.len());
        let name = match &self.scenario().source {
            Source::Lcp(lcp) => lcp.names.first().cloned(),
            _ => None,
        };
        let first = name.unwrap_or_else(|| "1".to_owned());
        let mut steps: Vec<Step> = vec![
            (
                vec![format!("why {}", tokens::quote(&format!("z[{first}]")))],
                "how a variable came to its value at the end of the run.",
            ),
            (
                vec!["ties".to_owned(), "pivots".to_owned()],
                "where rows were tied: a run in a circle shows the same rows again and again.",
            ),
            (
                one("compare"),
                "every tie-break and engine: if one of them finds an answer, only the run failed; M need not be of a class \
                 for which Lemke's algorithm always ends in one.",
            ),
        ];
        if size <= FEW_PAIRS {
            steps.push((
                one("enumerate"),
                "all bases in exact arithmetic: all answers, or the proof that there is none.",
            ));
        }
        steps.push((one("set engine exact"), "the same run without rounding."));
        steps
    }
}

fn class(ray: &Ray) -> String {
    match ray.verdict {
        Some(verdict) => format!("{} ({})", ray.class.word(), verdict.word()),
        None => ray.class.word().to_owned(),
    }
}

/// A pair that moves along the ray.
fn moving_pair(ray: &Ray) -> Option<String> {
    match &ray.direction {
        Direction::Pairs(pairs) => {
            let size = |z_n: f64, z_t: f64| z_n.abs().max(z_t.abs());
            pairs
                .iter()
                .max_by(|a, b| size(a.z_n, a.z_t.scalar()).total_cmp(&size(b.z_n, b.z_t.scalar())))
                .map(|pair| pair.pair.clone())
        }
        Direction::Variables(_) => None,
    }
}

/// The load cases, as they are typed.
fn cases(scenario: &Scenario) -> impl Iterator<Item = String> {
    let names: Vec<&str> = match &scenario.source {
        Source::Structure(structure) => structure.load_cases.iter().map(|case| case.name.as_str()).collect(),
        Source::ContactSystem(system) => system.loads.iter().map(|load| load.name.as_str()).collect(),
        Source::Lcp(_) => Vec::new(),
    };
    names.into_iter().map(tokens::quote).collect::<Vec<_>>().into_iter()
}

/// The parameters that are the friction of some pair.
fn frictions(scenario: &Scenario) -> Vec<String> {
    let laws: Vec<_> = match &scenario.source {
        Source::Structure(structure) => structure.pairs.iter().map(|pair| &pair.law).collect(),
        Source::ContactSystem(system) => system.laws.iter().collect(),
        Source::Lcp(_) => Vec::new(),
    };
    let mut names: Vec<String> = Vec::new();
    for name in laws.iter().filter_map(|law| law.friction()?.parameter()) {
        if !names.iter().any(|known| known == name) && scenario.parameters[name].formula.is_none() {
            names.push(name.to_owned());
        }
    }
    names
}
