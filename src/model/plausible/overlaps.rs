//! Sides that look away from each other: each lies deep inside what the other stands for.

use super::{Warning, contacts};
use crate::model::pair::Pair;
use crate::model::parameter::Number;
use crate::model::scenario::Scenario;
use crate::model::structure::Structure;
use crate::model::vector::distance;

/// Contacts of several pairs that all begin with an interference deeper than it is from one pair to the next, one warning
/// for each. No fit is so tight.
pub fn of_contacts(scenario: &Scenario, structure: &Structure) -> Vec<Warning> {
    let position = |pair: &Pair| pair.at_place(|node| structure.nodes[node].position);
    let depth = |pair: &Pair| match pair.law.gap() {
        Some(Number::Value(gap)) => -gap,
        _ => 0.0,
    };
    let look_away = |pairs: &[Pair]| {
        let least = pairs.iter().map(depth).fold(f64::INFINITY, f64::min);
        let apart = pairs.windows(2).map(|two| distance(position(&two[0]), position(&two[1]))).fold(0.0, f64::max);
        pairs.len() > 1 && least > apart
    };
    let told = |own: std::ops::Range<usize>| {
        Warning::new(
            scenario.places.pairs[own.start].to_string(),
            format!(
                "the sides of `{}` begin inside one another, deeper than it is from one of its pairs to the next: they look \
                 away from each other",
                structure.pairs[own.start].contact()
            ),
            "name the sides that face each other, or make the gap the distance that they are apart",
        )
    };
    contacts(scenario).filter(|own| look_away(&structure.pairs[own.clone()])).map(told).collect()
}
