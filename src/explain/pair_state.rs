//! Why a pair is in its state: what its numbers say.

use crate::answer::record::{PairState, State};
use crate::model::units::Units;
use crate::text::number::{short, with_unit};

/// A pair whose smaller reserve is below this share of its bound stands at its limit.
const AT_LIMIT: f64 = 1e-12;

/// What holds a pair in its state, in a sentence.
pub fn cause(pair: &PairState, units: &Units) -> String {
    let force = |value: f64| with_unit(&short(value), units.force.as_deref());
    let length = |value: f64| with_unit(&short(value), units.length.as_deref());
    let (x_t, bound) = (pair.x_t, force(pair.bound));
    match pair.state {
        State::Open => {
            format!("nothing presses it together: x_n = {} and it is open by {}", force(pair.x_n), length(pair.z_n))
        }
        State::Closed => {
            format!("it is pressed together with x_n = {}, and without friction x_t = 0", force(pair.x_n))
        }
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
