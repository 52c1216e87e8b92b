//! Why a given contact system cannot be used.

/// Why a given contact system cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GivenError {
    /// A matrix with a negative eigenvalue.
    #[error(
        "the {} matrix is not positive semidefinite: scaled to unit diagonal, its smallest eigenvalue is \
         {smallest:.3e}", if *key == "stiffness" { "contact stiffness" } else { "compliance" }
    )]
    Indefinite {
        /// Key of the file.
        key: &'static str,
        /// Smallest eigenvalue.
        smallest: f64,
    },
    /// W in which a normal joint that holds both ways does not move under its own force, the other such joints held.
    #[error(
        "pair {pair} is held along n both ways (law bound), and the compliance matrix says that no force moves it along n \
         where the other such pairs hold: leave it out, or give it another law"
    )]
    Held {
        /// Id of the pair.
        pair: String,
    },
    /// W in space that is singular but for its last digits.
    #[error(
        "the compliance matrix is nearly singular: {motion} would move nothing if its last digits were others, and with \
         these friction in space is not solved; give more digits, or `stiffness`"
    )]
    NearlySingular {
        /// Forces that hardly move anything.
        motion: String,
    },
    /// A load acts on a tangential motion of frictionless pairs that nothing resists.
    #[error("load case {case} pushes frictionless pair {pair} along a tangential motion that nothing resists")]
    Unheld {
        /// Load case.
        case: String,
        /// A pair that moves.
        pair: String,
    },
}
