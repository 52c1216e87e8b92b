//! One try of the solver: under which rules it ran, and how it ended.

use std::fmt;

use serde::{Serialize, Serializer};

use super::outcome::OutcomeKind;
use crate::model::rules::{Covering, Engine, Rules, TieBreak};

/// Covering vector d of a bare LCP.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlainCovering {
    /// That of the file.
    Given,
    /// d_i = 1.
    Ones,
    /// d_i = the largest |M_ik| of its row.
    Rows,
    /// d_i drawn with this seed between 1/8 and 8 times the largest |M_ik| of its row.
    Random(u64),
}

/// Covering vector of a try, of a contact problem or a bare LCP.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttemptCovering {
    Contact(Covering),
    Plain(PlainCovering),
}

/// What found, or looked for, an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttemptEngine {
    /// Lemke's algorithm.
    Lemke(Engine),
    /// All working schemes, or bases, one after another.
    Enumeration,
    /// The path from zero load along the growing load.
    LoadPath,
    /// Lemke's algorithm on a bimatrix game stated with the values of its players as unknowns.
    Bimatrix,
    /// One z after another of a triangular M.
    Substitution,
    /// Convex steps down a quadratic program that is not convex, each solved by Lemke's algorithm.
    Descent,
    /// Joints that repeat one another kept at rest, their forces chosen within the laws.
    AtRest,
}

impl AttemptEngine {
    /// Whether what it finds comes without pivots of the problem itself.
    pub fn is_without_pivots(self) -> bool {
        !matches!(self, AttemptEngine::Lemke(_) | AttemptEngine::LoadPath)
    }
}

/// Rules of a try.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct AttemptRules {
    pub covering: AttemptCovering,
    pub tie_break: TieBreak,
    pub engine: AttemptEngine,
}

impl AttemptRules {
    /// The same with another engine.
    pub fn by(self, engine: AttemptEngine) -> AttemptRules {
        AttemptRules { engine, ..self }
    }

    /// Why an answer has no pivots.
    pub fn why_no_pivots(self) -> String {
        match self.engine {
            AttemptEngine::AtRest => "no pivots: the joints that repeat one another stay at rest".to_owned(),
            engine if engine.is_without_pivots() => format!("no pivots: the answer was found by {engine}"),
            _ => "no pivots: the main system is the answer".to_owned(),
        }
    }
}

/// One try of the solver.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attempt {
    #[serde(flatten)]
    pub rules: AttemptRules,
    /// K of its friction polygon; in space only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facets: Option<usize>,
    /// Angle of its first facet from t1 towards t2, degrees; where it is turned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn: Option<f64>,
    /// How it ended.
    pub outcome: OutcomeKind,
    /// Pivots that it made, where that is known; shown in words only.
    #[serde(skip)]
    pub pivots: Option<usize>,
    /// Which limit it reached, where that is no ray and no answer; where a path ended.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl Attempt {
    /// One that made no polygon.
    pub fn new(rules: AttemptRules, outcome: OutcomeKind) -> Attempt {
        Attempt { rules, facets: None, turn: None, outcome, pivots: None, why: None }
    }
}

impl From<Rules> for AttemptRules {
    fn from(rules: Rules) -> AttemptRules {
        AttemptRules {
            covering: AttemptCovering::Contact(rules.covering),
            tie_break: rules.tie_break,
            engine: AttemptEngine::Lemke(rules.engine),
        }
    }
}

/// `covering ones, tie-break lexicographic, engine exact`.
impl fmt::Display for AttemptRules {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "covering {}, tie-break {}, engine {}", self.covering, self.tie_break, self.engine)
    }
}

impl fmt::Display for PlainCovering {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlainCovering::Given => f.write_str("given"),
            PlainCovering::Ones => f.write_str("ones"),
            PlainCovering::Rows => f.write_str("rows"),
            PlainCovering::Random(seed) => write!(f, "random:{seed}"),
        }
    }
}

impl fmt::Display for AttemptCovering {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AttemptCovering::Contact(covering) => covering.fmt(f),
            AttemptCovering::Plain(covering) => covering.fmt(f),
        }
    }
}

impl fmt::Display for AttemptEngine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AttemptEngine::Lemke(engine) => engine.fmt(f),
            AttemptEngine::Enumeration => f.write_str("enumeration"),
            AttemptEngine::LoadPath => f.write_str("load-path"),
            AttemptEngine::Bimatrix => f.write_str("bimatrix"),
            AttemptEngine::Descent => f.write_str("descent"),
            AttemptEngine::Substitution => f.write_str("substitution"),
            AttemptEngine::AtRest => f.write_str("at-rest"),
        }
    }
}

impl Serialize for AttemptCovering {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for AttemptEngine {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
