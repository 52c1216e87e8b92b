//! Why a pair is in its state: what its numbers say.

use crate::answer::record::{PairState, State};
use crate::model::units::Units;
use crate::text::number::{measured, short};

/// A pair whose smaller reserve is below this share of its bound stands at its limit.
const AT_LIMIT: f64 = 1e-12;

/// What holds a pair in its state, in a sentence.
pub fn cause(pair: &PairState, units: &Units) -> String {
    let force = |value: f64| measured(value, units.force.as_deref());
    let length = |value: f64| measured(value, units.length.as_deref());
    let (x_t, bound) = (pair.x_t, force(pair.bound));
    match pair.state {
        State::Open => {
            format!("nothing presses it together: x_n = {} and it is open by {}", force(pair.x_n), length(pair.z_n))
        }
        State::Closed => {
            format!("it is pressed together with x_n = {}, and without friction x_t = 0", force(pair.x_n))
        }
        State::Stick if pair.space.is_some() && pair.reserve() < 0.0 => format!(
            "between two facets of the polygon it is held beyond Coulomb's bound {bound}: its friction force |x_t| = {}",
            force(x_t)
        ),
        State::Stick if pair.space.is_some() => format!(
            "its friction force |x_t| = {} does not exceed the bound {bound}; its reserve is {}",
            force(x_t),
            force(pair.reserve())
        ),
        State::Stick if pair.reserve_plus.min(pair.reserve_minus) <= AT_LIMIT * pair.bound.abs() => {
            format!("it stands exactly at its limit, |x_t| = {} = bound {bound}, but has not moved", force(x_t.abs()))
        }
        State::Stick => format!(
            "its friction force |x_t| = {} does not exceed the bound {bound}; reserves x+ = {}, x- = {}",
            force(x_t.abs()),
            force(pair.reserve_plus),
            force(pair.reserve_minus)
        ),
        State::SlipPlus => format!(
            "its reserve x+ is used up: x_t = {} stands at the bound -{bound}, and it has slipped {} along +t",
            force(x_t),
            length(pair.z_t)
        ),
        State::Slip => format!(
            "friction stands at its bound {bound} against the slip, and it has slipped {} towards {}° from t1",
            length(pair.z_t),
            short(pair.direction().unwrap_or_default())
        ),
        State::SlipMinus => format!(
            "its reserve x- is used up: x_t = {} stands at the bound {bound}, and it has slipped {} along -t",
            force(x_t),
            length(-pair.z_t)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::pair_record::InSpace;
    use crate::model::pair::LawKind;

    /// bound 10: a force of 9 is within it; one of 10.5 is held by a polygon of 8 facets only, whose corners lie at
    /// 10/cos 22.5° = 10.82.
    #[test]
    fn a_pair_that_the_polygon_holds_is_not_said_to_be_within_the_bound() {
        let held = |x_t: f64| {
            let pair = PairState {
                id: "c".to_owned(),
                law: LawKind::Coulomb,
                state: State::Stick,
                held: None,
                x_n: 10.0,
                x_t,
                z_n: 0.0,
                z_t: 0.0,
                bound: 10.0,
                reserve_plus: 10.0 + x_t,
                reserve_minus: 10.0 - x_t,
                position: None,
                joint: 0,
                space: Some(InSpace { x_t: [x_t, 0.0], z_t: [0.0; 2], frame: None }),
            };
            cause(&pair, &Units::default())
        };
        assert!(held(9.0).contains("|x_t| = 9 does not exceed the bound 10"), "{}", held(9.0));
        assert!(held(10.5).contains("held beyond Coulomb's bound 10"), "{}", held(10.5));
    }
}
