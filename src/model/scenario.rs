//! A checked scenario: what `load` returns and everything later works on.

use std::path::PathBuf;

use indexmap::IndexMap;

use super::pair::Law;
use super::parameter::{Number, Parameter, ParameterValues};
use super::rules::Rules;
use super::structure::Structure;

/// Labels of the author's units; nothing is converted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Units {
    /// Unit of length, e.g. `m`.
    pub length: Option<String>,
    /// Unit of force, e.g. `kN`.
    pub force: Option<String>,
}

/// A contact system computed elsewhere (CSM and CLV given).
#[derive(Clone, Debug, PartialEq)]
pub struct GivenContactSystem {
    /// Ids of the m pairs.
    pub pairs: Vec<String>,
    /// Coordinate of each pair along the contact zone, for plots.
    pub positions: Option<Vec<f64>>,
    /// CSM, 2m × 2m row by row: all normals, then all tangentials. Symmetric up to 1e-8 of its largest entry.
    pub stiffness: Vec<Vec<f64>>,
    /// Load cases: name, factor, CLV (2m).
    pub loads: Vec<GivenLoad>,
    /// Law of each pair.
    pub laws: Vec<Law>,
    /// Motions z with R z = 0 known to the author, each 2m long.
    pub kernel: Option<Vec<Vec<f64>>>,
}

/// A load case of a given contact system.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenLoad {
    /// Name.
    pub name: String,
    /// Factor, may be a parameter.
    pub factor: Number,
    /// Contact load vector, 2m.
    pub vector: Vec<f64>,
}

/// A bare LCP w = M z + q.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenLcp {
    /// M, n × n row by row.
    pub matrix: Vec<Vec<f64>>,
    /// q; each entry may be a parameter.
    pub q: Vec<Number>,
    /// Covering vector d > 0; ones if not given.
    pub covering: Option<Vec<f64>>,
    /// Names of the rows; `1`, `2` … if not given.
    pub names: Vec<String>,
}

/// One of the three things a scenario can describe.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Structure with contact pairs.
    Structure(Structure),
    /// CSM and CLV.
    ContactSystem(GivenContactSystem),
    /// Bare LCP.
    Lcp(GivenLcp),
}

/// A stage of a load history: multiplier of each named case; cases not named count 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// (case name, multiplier).
    pub multipliers: Vec<(String, Number)>,
}

/// A scenario that passed every check.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Name or path as given to `load`.
    pub name: String,
    /// The file it was read from; `None` for an embedded one.
    pub path: Option<PathBuf>,
    /// The text of the file as read.
    pub text: String,
    /// Title.
    pub title: String,
    /// Longer description.
    pub description: Option<String>,
    /// Labels of units.
    pub units: Units,
    /// Parameters in the order of the file.
    pub parameters: IndexMap<String, Parameter>,
    /// What is described.
    pub source: Source,
    /// Load history; empty without one.
    pub stages: Vec<Stage>,
    /// Covering, tie-break and engine the file asks for.
    pub rules: Rules,
}

impl Scenario {
    /// Every parameter at the value of the file.
    pub fn parameter_values(&self) -> ParameterValues {
        self.parameters
            .iter()
            .map(|(name, parameter)| (name.clone(), parameter.value))
            .collect()
    }
}
