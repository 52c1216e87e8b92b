//! Why a given contact system cannot be used.

/// Why a given contact system cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GivenError {
    /// A joint that answers its own motion with a push.
    #[error(
        "the {} matrix is not positive semidefinite: its diagonal entry for {joint} is {value:.3e}, which must be 0 or more",
        name(key)
    )]
    NegativeDiagonal {
        /// Key of the file.
        key: &'static str,
        /// The joint in words.
        joint: String,
        /// The entry.
        value: f64,
    },
    /// Two joints whose common entry is larger than their own ones allow.
    #[error(
        "the {} matrix is not positive semidefinite: its entry for {} and {} is {entry:.17e}, and the two diagonal entries allow \
         no more than √(a b) = {bound:.17e}; the digits of the file leave no room for the difference",
        name(key), joints[0], joints[1]
    )]
    NegativeMinor {
        /// Key of the file.
        key: &'static str,
        /// The joints in words.
        joints: [String; 2],
        /// Their entry.
        entry: f64,
        /// √ of the product of the diagonal entries.
        bound: f64,
    },
    /// A matrix with a negative eigenvalue.
    #[error(
        "the {} matrix is not positive semidefinite: scaled to unit diagonal, its smallest eigenvalue is \
         {smallest:.3e}",
        name(key)
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

/// The matrix in words.
fn name(key: &str) -> &'static str {
    if key == "stiffness" { "contact stiffness" } else { "compliance" }
}
