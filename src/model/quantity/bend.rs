//! How quantities bend where all forces and displacements move on straight lines, as on an exact path over a load.
//!
//! A function that bends one way only turns once at most, wherever it is looked at, and is a straight line where it meets one in a
//! place between: its extremes and zeros are found for certain. The larger of two numbers that bend upwards does so, too, and
//! the smaller of two that bend downwards; the other ones bend either way, at as many places as there are numbers.

use super::{BarPlace, OfPair, OfStress, Over, Quantity};

/// See the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    /// Not at all; or it is a parabola, a quotient of two straight lines, or the same all along.
    Smooth,
    /// Upwards only: convex.
    Up,
    /// Downwards only: concave.
    Down,
    /// Upwards only between places where friction of one of the pairs is 0.
    UpBetweenTurns,
    /// Either way, at places that nothing tells.
    Either,
}

impl Bend {
    /// That of the largest or the least, or of the sum, of many that bend so.
    fn over(self, over: Over) -> Bend {
        match (over, self) {
            (Over::Sum, bend) => bend,
            (Over::Max, Bend::Smooth | Bend::Up) => Bend::Up,
            (Over::Min, Bend::Smooth | Bend::Down) => Bend::Down,
            _ => Bend::Either,
        }
    }
}

impl OfPair {
    fn bend(self) -> Bend {
        match self {
            // Bound − |x_t|.
            OfPair::Reserve => Bend::Down,
            _ => Bend::Smooth,
        }
    }
}

impl OfStress {
    fn bend(self, in_space: bool) -> Bend {
        match self {
            // Largest eigenvalue and a norm.
            OfStress::First | OfStress::Mises => Bend::Up,
            OfStress::Third => Bend::Down,
            OfStress::Second => {
                if in_space {
                    Bend::Either
                } else {
                    Bend::Down
                }
            }
            _ => Bend::Smooth,
        }
    }
}

impl Quantity {
    /// How it bends along straight lines of all forces and displacements.
    pub fn bend(&self, in_space: bool) -> Bend {
        match self.innermost() {
            Quantity::Pair(which, _) => which.bend(),
            Quantity::Pairs(Over::Max, OfPair::Reserve, _) => Bend::UpBetweenTurns,
            Quantity::Pairs(over, which, _) => which.bend().over(*over),
            Quantity::LargestDisplacement => Bend::Up,
            Quantity::Bar(_, _, BarPlace::Over(over)) => Bend::Smooth.over(*over),
            // From the largest to the least where these are as far from 0: a jump.
            Quantity::Bar(_, _, BarPlace::Extreme) => Bend::Either,
            Quantity::NodeStress(which, _) | Quantity::ElementStress(which, _) => which.bend(in_space),
            Quantity::Stresses(over, which, _) => which.bend(in_space).over(*over),
            _ => Bend::Smooth,
        }
    }
}
