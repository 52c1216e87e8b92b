//! Numbers of pairs, and of all pairs that fit a pattern.

use super::facts::Facts;
use super::value::NoValue;
use crate::answer::record::{InSpace, PairState};
use crate::answer::rounding::balance;
use crate::model::quantity::{OfPair, Over, fits};

impl OfPair {
    /// Of a pair, in the unit and with the sign of the field of [`PairState`]; NaN where it has none.
    pub fn of(self, pair: &PairState) -> f64 {
        let component =
            |of: fn(&InSpace) -> [f64; 2], along: usize| pair.space.map_or(f64::NAN, |space| of(&space)[along]);
        match self {
            OfPair::ReservePlus | OfPair::ReserveMinus if pair.space.is_some() => f64::NAN,
            OfPair::FrictionAlong(along) => component(|space| space.x_t, along),
            OfPair::SlipAlong(along) => component(|space| space.z_t, along),
            OfPair::NormalForce => pair.x_n,
            OfPair::FrictionForce => pair.x_t,
            OfPair::Opening => pair.z_n,
            OfPair::Slip => pair.z_t,
            OfPair::Bound => pair.bound,
            OfPair::ReservePlus => pair.reserve_plus,
            OfPair::ReserveMinus => pair.reserve_minus,
            OfPair::Reserve => pair.reserve(),
        }
    }
}

impl<'a> Facts<'a> {
    fn chosen(&self, pattern: &str) -> Result<Vec<&'a PairState>, NoValue> {
        let chosen: Vec<&PairState> = self.pairs.iter().filter(|pair| fits(pattern, &pair.id)).collect();
        if chosen.is_empty() { Err(self.missing()) } else { Ok(chosen) }
    }

    /// The sum, or an extreme and the first pair at which it stands.
    pub(super) fn of_pairs(&self, over: Over, which: OfPair, pattern: &str) -> Result<(f64, &'a str), NoValue> {
        let chosen = self.chosen(pattern)?;
        let better = |a: f64, b: f64| if over == Over::Max { a > b } else { a < b };
        let values = chosen.iter().map(|pair| (which.of(pair), pair.id.as_str())).filter(|(value, _)| !value.is_nan());
        Ok(match over {
            Over::Sum => (balance(chosen.iter().map(|pair| which.of(pair))), ""),
            Over::Max | Over::Min => values
                .reduce(|best, next| if better(next.0, best.0) { next } else { best })
                .ok_or_else(|| self.missing())?,
        })
    }

    /// How many pairs are in a state.
    pub(super) fn count(&self, state: &str, pattern: &str) -> Result<f64, NoValue> {
        Ok(self.chosen(pattern)?.into_iter().filter(|pair| pair.state.word() == state).count() as f64)
    }
}
