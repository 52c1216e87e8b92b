//! The names that quantities may have as arguments.

use std::collections::HashSet;

use super::Quantity;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::{Dimension, Structure};

/// The names that quantities of a scenario may have as arguments.
#[derive(Clone, Debug, Default)]
pub struct Names<'s> {
    /// Ids of the pairs.
    pub pairs: Vec<&'s str>,
    /// Where they and the nodes lie.
    pub dimension: Dimension,
    pub(super) nodes: HashSet<&'s str>,
    pub(super) bars: Vec<&'s str>,
    pub(super) structure: Option<&'s Structure>,
    pub(super) cases: Vec<&'s str>,
    pub(super) parameters: Vec<&'s str>,
    pub(super) stages: usize,
    pub(super) probes: &'s [(String, Quantity)],
}

impl<'s> Names<'s> {
    /// Those of a scenario.
    pub fn of(scenario: &'s Scenario) -> Names<'s> {
        let mut names = Names {
            parameters: scenario.parameters.keys().map(String::as_str).collect(),
            stages: scenario.stages.len(),
            probes: &scenario.probes,
            dimension: scenario.source.dimension(),
            ..Names::default()
        };
        match &scenario.source {
            Source::Structure(structure) => {
                names.pairs = structure.pairs.iter().map(|pair| pair.id.as_str()).collect();
                names.nodes = structure.nodes.iter().map(|node| node.id.as_str()).collect();
                names.bars = structure.bars.iter().map(|bar| bar.id.as_str()).collect();
                names.structure = Some(structure);
                names.cases = structure.load_cases.iter().map(|case| case.name.as_str()).collect();
            }
            Source::ContactSystem(system) => {
                names.pairs = system.pairs.iter().map(String::as_str).collect();
                names.cases = system.loads.iter().map(|load| load.name.as_str()).collect();
            }
            Source::Lcp(_) => {}
        }
        names
    }

    /// The edge contacts: `joint` of the pairs `joint[0]`, `joint[1]` …
    pub fn joints(&self) -> Vec<&'s str> {
        let mut joints: Vec<&str> =
            self.pairs.iter().filter_map(|id| id.split_once('[').map(|(joint, _)| joint)).collect();
        joints.dedup();
        joints
    }

    /// Whether a word is a name of something that quantities are of.
    pub fn has(&self, word: &str) -> bool {
        let listed = [&self.pairs, &self.bars, &self.cases, &self.parameters];
        listed.into_iter().flatten().any(|name| *name == word)
            || self.nodes.contains(word)
            || self.probes.iter().any(|(name, _)| name == word)
            || self.element(word)
            || self.joints().contains(&word)
            || self.structure.is_some_and(|structure| structure.bodies().contains(&word))
    }

    /// Ids of the bars.
    pub fn bars(&self) -> &[&'s str] {
        &self.bars
    }

    pub(super) fn element(&self, name: &str) -> bool {
        self.structure.is_some_and(|structure| structure.element_named(name).is_some())
    }
}

/// Whether a pair fits a pattern: an id, the name of an edge contact, or with `*` for any letters.
pub fn fits(pattern: &str, id: &str) -> bool {
    let mut parts = pattern.split('*');
    let first = parts.next().unwrap_or_default();
    let rest: Vec<&str> = parts.collect();
    let Some((last, middle)) = rest.split_last() else {
        return id == pattern || id.strip_prefix(pattern).is_some_and(|rest| rest.starts_with('['));
    };
    let Some(mut left) = id.strip_prefix(first) else { return false };
    for part in middle {
        match left.find(part) {
            Some(at) => left = &left[at + part.len()..],
            None => return false,
        }
    }
    left.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_fit_as_expected() {
        for (pattern, id, expected) in [
            ("joint[*]", "joint[12]", true),
            ("joint", "joint[12]", true),
            ("joint", "joints[0]", false),
            ("c1", "c1", true),
            ("c1", "c12", false),
            ("*", "c1", true),
            ("c*2", "c12", true),
            ("a*b*c", "a1b2c", true),
            ("a*b*c", "acb", false),
        ] {
            assert_eq!(fits(pattern, id), expected, "{pattern} {id}");
        }
    }
}
