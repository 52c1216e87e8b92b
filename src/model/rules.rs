//! The user's choices for the run of Lemke's algorithm: covering vector, tie-break, engine.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

/// Covering vector d of a contact LCP (method §4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Covering {
    /// (d_n, d_τ) = (1, 1 + f): tightening weight and an equal extra cohesion.
    #[default]
    Cohesive,
    /// (1, 1): textbook.
    Ones,
    /// (1, f): the paper's tightening weight.
    Weight,
}

/// What decides among tied rows of the ratio test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TieBreak {
    /// p first, then lexicographic with the columns of all x⁺, x⁻ before those of all x_n.
    #[default]
    Lexicographic,
    /// p first, then lexicographic in the order x_n, x⁺, x⁻.
    Natural,
    /// The first tied row; may cycle.
    FirstRow,
    /// A tied row at random, reproducible by its seed.
    Random(u64),
}

/// Which implementation of Lemke's algorithm runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Engine {
    /// The working-scheme engine.
    #[default]
    Scheme,
    /// Dense tableau in f64.
    Tableau,
    /// Dense tableau in exact rationals.
    Exact,
}

/// A word that is not one of the choices; says what is accepted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown {what} `{word}`: expected {expected}")]
pub struct UnknownChoice {
    /// `covering`, `tie-break` or `engine`.
    pub what: &'static str,
    /// The word found.
    pub word: String,
    /// The accepted words.
    pub expected: &'static str,
}

/// K of the friction polygon in space where nothing else is said.
pub const FACETS: u16 = 8;
/// Most facets: the next polygon would differ from the circle by less than 1 in 10⁴.
const MOST_FACETS: u16 = 256;

/// Numbers of facets that a polygon can have.
pub const FACETS_EXPECTED: &str = "an even number from 4 to 256";

/// A number of facets, if a polygon can have that many: an even number, for every direction has its opposite.
pub fn facets(count: usize) -> Option<u16> {
    u16::try_from(count).ok().filter(|facets| (4..=MOST_FACETS).contains(facets) && facets.is_multiple_of(2))
}

/// The choices together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Rules {
    /// Covering vector.
    pub covering: Covering,
    /// Tie-break.
    pub tie_break: TieBreak,
    /// Engine.
    pub engine: Engine,
    /// K, the facets of the friction polygon of pairs in space: even, at least 4.
    pub facets: u16,
    /// Whether the answer of a problem in space is taken from the polygon to Coulomb's cone.
    pub cone: bool,
}

impl Default for Rules {
    fn default() -> Rules {
        Rules {
            covering: Covering::default(),
            tie_break: TieBreak::default(),
            engine: Engine::default(),
            facets: FACETS,
            cone: true,
        }
    }
}

impl Rules {
    /// Sets the number of facets from its word.
    ///
    /// # Errors
    /// Anything else than an even number from 4 to [`MOST_FACETS`].
    pub fn set_facets(&mut self, word: &str) -> Result<(), UnknownChoice> {
        self.facets = word.parse().ok().and_then(facets).ok_or_else(|| UnknownChoice {
            what: "number of facets",
            word: word.into(),
            expected: FACETS_EXPECTED,
        })?;
        Ok(())
    }

    /// Sets from the word on or off whether the answer is taken to Coulomb's cone.
    ///
    /// # Errors
    /// Any other word.
    pub fn set_cone(&mut self, word: &str) -> Result<(), UnknownChoice> {
        self.cone = match word {
            "on" | "true" => true,
            "off" | "false" => false,
            _ => return Err(UnknownChoice { what: "choice of cone", word: word.into(), expected: "on or off" }),
        };
        Ok(())
    }

    /// Whether covering and tie-break are the defaults: only then a failed run is retried (method §4).
    pub fn are_default(&self) -> bool {
        self.covering == Covering::default() && self.tie_break == TieBreak::default()
    }
}

impl Covering {
    /// Accepted words.
    pub const WORDS: &'static str = "cohesive, ones or weight";
    /// All of them.
    pub const ALL: [Covering; 3] = [Covering::Cohesive, Covering::Ones, Covering::Weight];
}

impl TieBreak {
    /// Accepted words.
    pub const WORDS: &'static str = "lexicographic, natural, first-row or random:SEED (e.g. random:7)";
}

impl Engine {
    /// Accepted words.
    pub const WORDS: &'static str = "scheme, tableau or exact";
}

impl fmt::Display for Covering {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Covering::Cohesive => "cohesive",
            Covering::Ones => "ones",
            Covering::Weight => "weight",
        })
    }
}

impl fmt::Display for TieBreak {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TieBreak::Lexicographic => f.write_str("lexicographic"),
            TieBreak::Natural => f.write_str("natural"),
            TieBreak::FirstRow => f.write_str("first-row"),
            TieBreak::Random(seed) => write!(f, "random:{seed}"),
        }
    }
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Engine::Scheme => "scheme",
            Engine::Tableau => "tableau",
            Engine::Exact => "exact",
        })
    }
}

impl Serialize for TieBreak {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for Covering {
    type Err = UnknownChoice;
    fn from_str(word: &str) -> Result<Self, UnknownChoice> {
        match word {
            "cohesive" => Ok(Covering::Cohesive),
            "ones" => Ok(Covering::Ones),
            "weight" => Ok(Covering::Weight),
            _ => Err(UnknownChoice { what: "covering", word: word.into(), expected: Covering::WORDS }),
        }
    }
}

impl FromStr for TieBreak {
    type Err = UnknownChoice;
    fn from_str(word: &str) -> Result<Self, UnknownChoice> {
        let unknown = || UnknownChoice { what: "tie-break", word: word.into(), expected: TieBreak::WORDS };
        match word {
            "lexicographic" => Ok(TieBreak::Lexicographic),
            "natural" => Ok(TieBreak::Natural),
            "first-row" => Ok(TieBreak::FirstRow),
            _ => {
                let seed = word.strip_prefix("random:").ok_or_else(unknown)?;
                seed.parse().map(TieBreak::Random).map_err(|_| unknown())
            }
        }
    }
}

impl FromStr for Engine {
    type Err = UnknownChoice;
    fn from_str(word: &str) -> Result<Self, UnknownChoice> {
        match word {
            "scheme" => Ok(Engine::Scheme),
            "tableau" => Ok(Engine::Tableau),
            "exact" => Ok(Engine::Exact),
            _ => Err(UnknownChoice { what: "engine", word: word.into(), expected: Engine::WORDS }),
        }
    }
}
