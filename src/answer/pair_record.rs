//! A pair as it stands in a result.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

use crate::contact::polygon::angle;
use crate::model::pair::LawKind;

/// State of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum State {
    /// Normal joint off.
    #[serde(rename = "open")]
    Open,
    /// Both joints on.
    #[serde(rename = "stick")]
    Stick,
    /// Slips along +t.
    #[serde(rename = "slip+")]
    SlipPlus,
    /// Slips along −t.
    #[serde(rename = "slip-")]
    SlipMinus,
    /// Slips in space, in a direction of its own.
    #[serde(rename = "slip")]
    Slip,
    /// A frictionless pair in contact, or a roller.
    #[serde(rename = "closed")]
    Closed,
}

impl State {
    /// The state of a pair, and what holds it where it is open: `slips` is what its tangential joint does, `None` where it
    /// has none, and `bound` what friction can take.
    pub fn of(open: bool, slips: Option<State>, bound: f64) -> (State, Option<State>) {
        match (open, slips) {
            (true, slips) => (State::Open, slips.filter(|_| bound > 0.0)),
            (false, slips) => (slips.unwrap_or(State::Closed), None),
        }
    }

    /// The word used everywhere.
    pub fn word(self) -> &'static str {
        match self {
            State::Open => "open",
            State::Stick => "stick",
            State::SlipPlus => "slip+",
            State::SlipMinus => "slip-",
            State::Slip => "slip",
            State::Closed => "closed",
        }
    }
}

/// What a pair in space has in vectors along t1 and t2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InSpace {
    /// Tangential force on the second side.
    pub x_t: [f64; 2],
    /// Slip of the second side.
    pub z_t: [f64; 2],
    /// n and t1; `None` where a file gives no geometry.
    pub frame: Option<[[f64; 3]; 2]>,
}

/// Forces, displacements and reserves of one pair, in the user's units of force and length; signs of method §1.
#[derive(Clone, Debug, PartialEq)]
pub struct PairState {
    /// Pair id.
    pub id: String,
    /// `coulomb`, `frictionless`, `bound`.
    pub law: LawKind,
    /// Its state.
    pub state: State,
    /// What holds an open pair (cohesion, or p > 0): `stick`, `slip+`, `slip-`.
    pub held: Option<State>,
    /// Contact force along n, > 0 pressed together.
    pub x_n: f64,
    /// Tangential force on the second side, > 0 along +t: −bound while the pair slips +. In space its magnitude.
    pub x_t: f64,
    /// Opening, ≥ 0.
    pub z_n: f64,
    /// Slip of the second side, > 0 along +t. In space its magnitude.
    pub z_t: f64,
    /// Friction bound r_f = f x_n + c ≥ 0, a force (with the covering at p > 0).
    pub bound: f64,
    /// x⁺ = bound + x_t ≥ 0, a force: what is left before the pair slips +. Of the plane.
    pub reserve_plus: f64,
    /// x⁻ = bound − x_t ≥ 0, a force: what is left before the pair slips −. In space, where x_t is the magnitude, the reserve.
    pub reserve_minus: f64,
    /// Place, in the plane shown as (x, y); for a contact system [s, 0] or null.
    pub position: Option<[f64; 3]>,
    /// Number of the joint it belongs to; for pictures.
    pub joint: usize,
    /// Its vectors; `None` in the plane.
    pub space: Option<InSpace>,
}

/// A bound with a force on one side of it, bound + force: 0 where what is left is the rounding of both.
pub(super) fn reserve(bound: f64, force: f64) -> f64 {
    let left = bound + force;
    if left.abs() <= 4.0 * f64::EPSILON * (bound.abs() + force.abs()) { 0.0 } else { left }
}

impl PairState {
    /// Angle of the slip from t1 towards t2 in degrees, −180 < angle ≤ 180; only of a pair in space that slips.
    pub fn direction(&self) -> Option<f64> {
        let space = self.space.as_ref().filter(|_| self.state == State::Slip)?;
        Some(angle(space.z_t))
    }

    /// Size of its slip, a length ≥ 0: of a pair in contact, for what an open one moves by along t is no slip.
    pub fn slip_size(&self) -> f64 {
        if self.state == State::Open { 0.0 } else { self.z_t.abs() }
    }

    /// bound − |x_t|, a force.
    pub fn reserve(&self) -> f64 {
        reserve(self.bound, -self.x_t.abs())
    }

    /// x_t along its tangents, forces on the second side: one component in the plane.
    pub fn friction(&self) -> Vec<f64> {
        self.space.map_or_else(|| vec![self.x_t], |space| space.x_t.to_vec())
    }

    /// z_t along its tangents, the motion of the second side: one component in the plane.
    pub fn slip(&self) -> Vec<f64> {
        self.space.map_or_else(|| vec![self.z_t], |space| space.z_t.to_vec())
    }
}

impl Serialize for PairState {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("id", &self.id)?;
        map.serialize_entry("law", &self.law)?;
        map.serialize_entry("state", &self.state)?;
        map.serialize_entry("held", &self.held)?;
        map.serialize_entry("x_n", &self.x_n)?;
        match &self.space {
            None => map.serialize_entry("x_t", &self.x_t)?,
            Some(space) => map.serialize_entry("x_t", &space.x_t)?,
        }
        map.serialize_entry("z_n", &self.z_n)?;
        match &self.space {
            None => map.serialize_entry("z_t", &self.z_t)?,
            Some(space) => map.serialize_entry("z_t", &space.z_t)?,
        }
        if let Some(direction) = self.direction() {
            map.serialize_entry("direction", &direction)?;
        }
        map.serialize_entry("bound", &self.bound)?;
        if self.space.is_some() {
            map.serialize_entry("reserve", &self.reserve())?;
        } else {
            map.serialize_entry("reserve_plus", &self.reserve_plus)?;
            map.serialize_entry("reserve_minus", &self.reserve_minus)?;
        }
        let frame = self.space.and_then(|space| space.frame);
        let shown = if frame.is_some() { 3 } else { 2 };
        map.serialize_entry("position", &self.position.as_ref().map(|at| &at[..shown]))?;
        if let Some([normal, t1]) = frame {
            map.serialize_entry("normal", &normal)?;
            map.serialize_entry("t1", &t1)?;
        }
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 0.3 · 0.1 · 10 and 0.1 · 3 differ by rounding; what is left of a force that is smaller by 1e-12 is no rounding.
    #[test]
    fn a_reserve_of_rounding_is_none() {
        let bound = 0.3 * 0.1 * 10.0;
        let force = -(0.1 * 3.0);
        assert!(bound != -force && reserve(bound, force) == 0.0);
        assert!(reserve(1.0, -(1.0 - 1e-12)) > 9e-13 && reserve(0.0, 0.0) == 0.0);
    }
}
