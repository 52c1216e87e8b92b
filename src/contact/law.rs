//! The law of a pair, resolved: what its two joints can do, in numbers.
//!
//! ```text
//!   normal joint       unilateral: x_n ≥ 0 ⟂ z_n ≥ 0, which starts at the gap g;   bilateral: z_n = 0
//!   tangential joint   free: x_τ = 0;   bounded: |x_τ| ≤ f x_n + c
//! ```
//! Only the decoder and the report of the law know the word that a file has for this; a known friction bound r_f is
//! f = 0 and c = r_f. The directions of friction are those of [`super::polygon`]: a pair in the plane has two.

use crate::model::pair::{Law, LawKind};
use crate::model::parameter::Number;
use crate::model::rules::Covering;

/// The two senses in which a pair in the plane slips along t.
pub const SENSES: [f64; 2] = [1.0, -1.0];

/// What a pair can do along n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalJoint {
    /// It opens: z_n ≥ 0 is the distance, which is `gap` where nothing moves. A gap < 0 is an interference.
    Unilateral {
        /// g, a length.
        gap: f64,
    },
    /// It holds both ways: z_n = 0, x_n has any sign.
    Bilateral,
}

/// What a pair can do along t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TangentialJoint {
    /// x_τ = 0. The main system has no such joint.
    Free,
    /// |x_τ| ≤ f x_n + c.
    Bounded {
        /// f ≥ 0.
        friction: f64,
        /// c ≥ 0, a force.
        fixed: f64,
    },
}

/// The law of a pair with its numbers; or the rates of these numbers, when a parameter moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairLaw {
    /// Along n.
    pub normal: NormalJoint,
    /// Along t.
    pub tangential: TangentialJoint,
}

impl PairLaw {
    /// The law of a file, its numbers as `value` reads them.
    pub fn of(law: &Law, value: &dyn Fn(&Number) -> f64) -> PairLaw {
        match law {
            Law::Coulomb { friction, cohesion, gap } => PairLaw::rubbing(value(friction), value(cohesion), value(gap)),
            Law::Frictionless { gap } => PairLaw::smooth(value(gap)),
            Law::Bound { bound } => PairLaw::bilateral(value(bound)),
            Law::Roller => PairLaw { normal: NormalJoint::Bilateral, tangential: TangentialJoint::Free },
        }
    }

    /// A unilateral pair that rubs: f, c and g.
    pub fn rubbing(friction: f64, fixed: f64, gap: f64) -> PairLaw {
        PairLaw { normal: NormalJoint::Unilateral { gap }, tangential: TangentialJoint::Bounded { friction, fixed } }
    }

    /// A unilateral pair that slips freely: g.
    pub fn smooth(gap: f64) -> PairLaw {
        PairLaw { normal: NormalJoint::Unilateral { gap }, tangential: TangentialJoint::Free }
    }

    /// A pair that never opens and slips under a known force.
    pub fn bilateral(fixed: f64) -> PairLaw {
        PairLaw { normal: NormalJoint::Bilateral, tangential: TangentialJoint::Bounded { friction: 0.0, fixed } }
    }

    /// The word of the law.
    pub fn kind(&self) -> LawKind {
        match (self.normal, self.tangential) {
            (NormalJoint::Bilateral, _) => LawKind::Bound,
            (_, TangentialJoint::Free) => LawKind::Frictionless,
            (_, TangentialJoint::Bounded { .. }) => LawKind::Coulomb,
        }
    }

    /// Whether the pair never opens.
    pub fn is_bilateral(&self) -> bool {
        self.normal == NormalJoint::Bilateral
    }

    /// Whether the pair never opens and slips freely.
    pub fn is_roller(&self) -> bool {
        self.is_bilateral() && self.tangential == TangentialJoint::Free
    }

    /// g, a length, < 0 for an interference; 0 where the pair never opens.
    pub fn gap(&self) -> f64 {
        match self.normal {
            NormalJoint::Unilateral { gap } => gap,
            NormalJoint::Bilateral => 0.0,
        }
    }

    /// The law with another gap, where it has one.
    #[must_use]
    pub fn with_gap(mut self, gap: f64) -> PairLaw {
        if let NormalJoint::Unilateral { gap: own } = &mut self.normal {
            *own = gap;
        }
        self
    }

    /// f ≥ 0, without a unit; 0 without friction.
    pub fn friction(&self) -> f64 {
        match self.tangential {
            TangentialJoint::Bounded { friction, .. } => friction,
            TangentialJoint::Free => 0.0,
        }
    }

    /// The part of the friction bound that does not depend on x_n: c ≥ 0, a force.
    pub fn fixed_bound(&self) -> f64 {
        match self.tangential {
            TangentialJoint::Bounded { fixed, .. } => fixed,
            TangentialJoint::Free => 0.0,
        }
    }

    /// The friction bound f x_n + c where it is pressed so, a force.
    pub fn bound(&self, pressed: f64) -> f64 {
        self.friction() * pressed + self.fixed_bound()
    }

    /// The law with another f, where its bound depends on x_n.
    #[must_use]
    pub fn with_friction(mut self, friction: f64) -> PairLaw {
        if let (NormalJoint::Unilateral { .. }, TangentialJoint::Bounded { friction: own, .. }) =
            (self.normal, &mut self.tangential)
        {
            *own = friction;
        }
        self
    }

    /// The law with another c, where it has a bound.
    #[must_use]
    pub fn with_fixed_bound(mut self, fixed: f64) -> PairLaw {
        if let TangentialJoint::Bounded { fixed: own, .. } = &mut self.tangential {
            *own = fixed;
        }
        self
    }

    /// d_τ, without a unit: the entry of the covering in the rows of the reserves; d_n is 1 (method §4).
    pub fn covering(&self, covering: Covering) -> f64 {
        match covering {
            _ if self.is_bilateral() => 1.0,
            Covering::Ones => 1.0,
            Covering::Cohesive => 1.0 + self.friction(),
            Covering::Weight => self.friction(),
        }
    }

    /// 2 (d_τ − f d_n), without a unit: what both reserves together are covered by, without the rounding of the
    /// difference.
    pub fn covering_of_both(&self, covering: Covering) -> f64 {
        match covering {
            _ if self.is_bilateral() => 2.0,
            Covering::Cohesive => 2.0,
            Covering::Ones => 2.0 * (1.0 - self.friction()),
            Covering::Weight => 0.0,
        }
    }
}
