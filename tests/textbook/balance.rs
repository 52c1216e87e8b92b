//! Every embedded structure balances by hand, at many values of its parameters, and its pairs obey their laws.

use rayon::prelude::*;
use stickslip::model::embedded;
use stickslip::model::rules::{Covering, Rules};
use stickslip::model::scenario::Source;
use stickslip::model::structure::Dimension;
use stickslip::model::uses::Redone;

use crate::common::balance::{imbalance, incompatibility, nodal_imbalance};
use crate::common::laws::violation;
use crate::common::*;

/// Checks an answer by hand where there is one.
#[track_caller]
pub fn check(case: &Case, set: &[(&str, f64)], rules: Rules) -> bool {
    let mut values = case.scenario.parameter_values();
    for (name, value) in set {
        values.insert((*name).to_owned(), *value);
    }
    // Geometry and loads may depend on the values.
    let redone = case.scenario.uses.between(&case.scenario.parameter_values(), &values);
    let moved = (redone > Redone::Lcp).then(|| case.at(&values));
    let case = moved.as_ref().unwrap_or(case);
    let answer = case.solve_under(set, rules);
    if !answer.is_answer() {
        assert!(answer.ray.is_some(), "{set:?} {rules:?}: {:?}", answer.failure);
        return false;
    }
    is_answer(&answer);
    let off = imbalance(&case.scenario, &values, &answer);
    assert!(off < 1e-9, "{set:?} {rules:?}: out of balance by {off:e}");
    let off = nodal_imbalance(&case.scenario, &values, &answer);
    assert!(off < 1e-9, "{set:?} {rules:?}: a node out of balance by {off:e}");
    let off = incompatibility(&case.scenario, &values, &answer);
    assert!(off < 1e-9, "{set:?} {rules:?}: displacements and pairs differ by {off:e}");
    let wrong = violation(&case.scenario, &values, &answer);
    assert!(wrong < 1e-9, "{set:?} {rules:?}: laws violated by {wrong:e}");
    true
}

#[test]
fn embedded_structures_balance() {
    embedded::names().collect::<Vec<_>>().into_par_iter().for_each(|name| {
        let case = Case::embedded(name);
        // In space the laws are those of a cone: below.
        if !matches!(&case.scenario.source, Source::Structure(structure) if structure.dimension == Dimension::Plane) {
            return;
        }
        let parameters: Vec<(String, f64, f64)> =
            case.scenario.parameters.iter().filter_map(|(name, p)| Some((name.clone(), p.min?, p.max?))).collect();
        let mut answers = 0;
        for rule in Covering::ALL {
            answers += usize::from(check(&case, &[], covering(rule)));
        }
        for (name, min, max) in &parameters {
            for k in 0..=6 {
                let value = min + (max - min) * f64::from(k) / 6.0;
                answers += usize::from(check(&case, &[(name, value)], Rules::default()));
            }
        }
        assert!(answers >= 5, "{name}: only {answers} answers");
    });
}

/// Six sums of forces and moments for every part, and the displacements against the pairs.
#[test]
fn embedded_structures_in_space_balance() {
    let mut answers = 0;
    for name in embedded::names() {
        let case = Case::embedded(name);
        if !matches!(&case.scenario.source, Source::Structure(structure) if structure.dimension == Dimension::Space) {
            continue;
        }
        let ranges: Vec<(String, f64, f64)> =
            case.scenario.parameters.iter().filter_map(|(name, p)| Some((name.clone(), p.min?, p.max?))).collect();
        let middles = ranges.iter().map(|(name, min, max)| vec![(name.as_str(), min + 0.4 * (max - min))]);
        for set in std::iter::once(Vec::new()).chain(middles) {
            let mut values = case.scenario.parameter_values();
            for (name, value) in &set {
                values.insert((*name).to_owned(), *value);
            }
            let case = case.at(&values);
            let answer = case.solve_under(&set, case.scenario.rules);
            if !answer.is_answer() {
                continue;
            }
            answers += 1;
            let off = imbalance(&case.scenario, &values, &answer);
            assert!(off < 1e-9, "{name} {set:?}: out of balance by {off:e}");
            let off = incompatibility(&case.scenario, &values, &answer);
            assert!(off < 1e-9, "{name} {set:?}: displacements and pairs differ by {off:e}");
            let mut wrong = answer.clone();
            let pressed = wrong.pairs.iter_mut().max_by(|a, b| a.x_n.total_cmp(&b.x_n)).expect("pairs");
            pressed.x_n *= 1.0001;
            assert!(imbalance(&case.scenario, &values, &wrong) > 1e-7, "{name}");
        }
    }
    assert!(answers >= 12, "{answers}");
}

#[test]
fn every_rule_that_answers_answers_right() {
    for name in ["beam", "block", "frame-rotated", "plates-hinged", "slope", "klarbring", "gap"] {
        let case = Case::embedded(name);
        for rules in all_rules() {
            check(&case, &[], rules);
        }
    }
}

#[test]
fn the_checks_by_hand_can_fail() {
    let case = Case::embedded("frame-rotated");
    let values = case.scenario.parameter_values();
    let answer = case.solve(&[]);
    let judge = |answer: &stickslip::answer::record::Answer| {
        [
            imbalance(&case.scenario, &values, answer),
            nodal_imbalance(&case.scenario, &values, answer),
            incompatibility(&case.scenario, &values, answer),
            violation(&case.scenario, &values, answer),
        ]
        .map(|off| off > 1e-6)
    };
    assert_eq!(judge(&answer), [false; 4]);
    let mut wrong = answer.clone();
    wrong.pairs[1].x_n *= 1.0001;
    assert_eq!(judge(&wrong), [true, true, false, true]);
    let mut wrong = answer.clone();
    wrong.pairs[2].z_t *= 1.0001;
    assert_eq!(judge(&wrong), [false, false, true, false]);
    let mut wrong = answer.clone();
    wrong.members.as_mut().unwrap()[3].end.q += 0.01;
    assert_eq!(judge(&wrong), [false, true, false, false]);
    let mut wrong = answer.clone();
    wrong.reactions.as_mut().unwrap()[0].m += 0.1;
    assert_eq!(judge(&wrong), [true, true, false, false]);
    let mut wrong = answer.clone();
    wrong.pairs[0].x_t *= -1.0;
    assert_eq!(judge(&wrong), [true, true, false, true]);
}
