//! The laws of contact judged from the reported pairs alone.

use stickslip::answer::record::{Answer, State};
use stickslip::model::pair::Law;
use stickslip::model::parameter::ParameterValues;
use stickslip::model::scenario::{Scenario, Source};

/// Worst violation of the laws by the reported pairs, relative to the largest force and displacement reported.
pub fn violation(scenario: &Scenario, values: &ParameterValues, answer: &Answer) -> f64 {
    let laws: Vec<&Law> = match &scenario.source {
        Source::Structure(structure) => structure.pairs.iter().map(|pair| &pair.law).collect(),
        Source::ContactSystem(system) => system.laws.iter().collect(),
        Source::Lcp(_) => return 0.0,
    };
    let largest = |read: &dyn Fn(&stickslip::answer::record::PairState) -> f64| {
        let size = answer.pairs.iter().fold(0f64, |a, p| a.max(read(p).abs()));
        if size > 0.0 { size } else { 1.0 }
    };
    let force = largest(&|p| p.x_n.abs().max(p.x_t.abs()).max(p.bound.abs()));
    let length = largest(&|p| p.z_n.abs().max(p.z_t.abs()));
    let mut worst = 0f64;
    for (law, pair) in laws.into_iter().zip(&answer.pairs) {
        let (x_n, x_t) = (pair.x_n / force, pair.x_t / force);
        let (z_n, z_t) = (pair.z_n / length, pair.z_t / length);
        let mut at_most = |excess: f64| worst = worst.max(excess);
        let bound = match law {
            Law::Coulomb { friction, cohesion, .. } => friction.value(values) * x_n + cohesion.value(values) / force,
            Law::Frictionless { .. } => 0.0,
            Law::Bound { bound } => bound.value(values) / force,
            Law::Roller => 0.0,
        };
        at_most((pair.bound / force - bound).abs());
        if matches!(law, Law::Bound { .. }) {
            at_most(z_n.abs());
        } else {
            at_most(-x_n);
            at_most(-z_n);
            at_most((x_n * z_n).abs());
            assert_eq!(pair.state == State::Open, pair.z_n > 0.0, "{pair:?}");
        }
        at_most(x_t.abs() - bound);
        if matches!(law, Law::Frictionless { .. }) {
            at_most(x_t.abs());
            continue;
        }
        // slip + goes with x_τ = −bound
        at_most(z_t.max(0.0) * (bound + x_t).abs());
        at_most((-z_t).max(0.0) * (bound - x_t).abs());
        let word = pair.held.unwrap_or(pair.state);
        match word {
            State::SlipPlus => assert!(pair.z_t > 0.0, "{pair:?}"),
            State::SlipMinus => assert!(pair.z_t < 0.0, "{pair:?}"),
            State::Stick => assert!(pair.z_t == 0.0, "{pair:?}"),
            State::Slip => panic!("{pair:?} slips in space"),
            State::Open | State::Closed => {}
        }
    }
    worst
}
