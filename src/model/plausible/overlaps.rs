//! Sides that look away from each other: each lies deep inside what the other stands for.

use super::Warning;
use crate::model::pair::Pair;
use crate::model::parameter::Number;
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;
use crate::model::vector::distance;

/// Contacts of several pairs that all begin with an interference deeper than it is from one pair to the next, one warning
/// for each. No fit is so tight.
pub fn of_contacts(scenario: &Scenario, structure: &Structure) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut contacts: Vec<Vec<(&Pair, _)>> = Vec::new();
    for (pair, place) in structure.pairs.iter().zip(&scenario.places.pairs) {
        match contacts.last_mut() {
            Some(own) if own[0].1 == place => own.push((pair, place)),
            _ => contacts.push(vec![(pair, place)]),
        }
    }
    let position = |pair: &Pair| structure.nodes[pair.node].position;
    for own in contacts.iter().filter(|own| own.len() > 1) {
        let depths: Option<Vec<f64>> = own
            .iter()
            .map(|(pair, _)| match pair.law.gap() {
                Some(Number::Value(gap)) if *gap < 0.0 => Some(-gap),
                _ => None,
            })
            .collect();
        let Some(depths) = depths else { continue };
        let apart = own.windows(2).map(|two| distance(position(two[0].0), position(two[1].0)));
        if depths.into_iter().fold(f64::INFINITY, f64::min) > apart.fold(0.0, f64::max) {
            let (pair, place) = own[0];
            warnings.push(Warning::new(
                place.to_string(),
                format!(
                    "the sides of `{}` begin inside one another, deeper than it is from one of its pairs to the next: they \
                     look away from each other",
                    pair.contact()
                ),
                "name the sides that face each other, or make the gap the distance that they are apart",
            ));
        }
    }
    warnings
}
