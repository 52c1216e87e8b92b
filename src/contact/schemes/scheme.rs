//! The state of one pair in a working scheme.

/// Tangential joint of a pair: on, or released with the slip in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Tangential {
    /// z_τ = 0.
    Stick,
    /// x⁺ = 0, z_τ ≥ 0.
    SlipPlus,
    /// x⁻ = 0, z_τ ≤ 0.
    SlipMinus,
}

impl Tangential {
    /// +1 and −1 for the two slips, 0 for stick.
    pub fn sign(self) -> f64 {
        match self {
            Tangential::Stick => 0.0,
            Tangential::SlipPlus => 1.0,
            Tangential::SlipMinus => -1.0,
        }
    }

    /// The word of the state of a closed pair.
    pub fn word(self) -> &'static str {
        match self {
            Tangential::Stick => "stick",
            Tangential::SlipPlus => "slip+",
            Tangential::SlipMinus => "slip-",
        }
    }
}

/// Joints of a pair. A frictionless pair has no tangential joint: `tangential` is not read. A bound pair is
/// never open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PairScheme {
    /// Normal joint off: x_n = 0, z_n free.
    pub open: bool,
    /// Tangential joint.
    pub tangential: Tangential,
}

impl PairScheme {
    /// Both joints on.
    pub const STICK: PairScheme = PairScheme { open: false, tangential: Tangential::Stick };
    /// Closed, slips along +t.
    pub const SLIP_PLUS: PairScheme = PairScheme { open: false, tangential: Tangential::SlipPlus };
    /// Closed, slips along −t.
    pub const SLIP_MINUS: PairScheme = PairScheme { open: false, tangential: Tangential::SlipMinus };
    /// Open, the tangential joint released too.
    pub const OPEN: PairScheme = PairScheme { open: true, tangential: Tangential::SlipPlus };
    /// Open, held by cohesion.
    pub const OPEN_STICK: PairScheme = PairScheme { open: true, tangential: Tangential::Stick };
}
