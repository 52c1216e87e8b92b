//! A checked scenario: what `load` returns and everything later works on.

use std::path::PathBuf;
use std::sync::Arc;

use indexmap::IndexMap;

use super::locate::Document;
use super::measurement::Measurement;
use super::mesh::MeshFiles;
use super::pair::Law;
use super::parameter::{Formulas, Number, Parameter, ParameterValues};
use super::problem::{Problem, Problems};
use super::quantity::Quantity;
use super::rules::Rules;
use super::structure::{Dimension, Load, Structure};
use super::units::Units;
use super::uses::Uses;
use crate::text::hash::Hash;

/// Value of the key `format` of a file.
pub const FORMAT: &str = "stickslip/1";

/// A contact system computed elsewhere (CSM and CLV given).
#[derive(Clone, Debug, PartialEq)]
pub struct GivenContactSystem {
    /// Ids of the m pairs.
    pub pairs: Vec<String>,
    /// Tangential joints of each pair: 1 in the plane, 2 in space.
    pub tangents: usize,
    /// Coordinate of each pair along the contact zone, for plots.
    pub positions: Option<Vec<f64>>,
    /// What relates forces and displacements, 2m × 2m row by row: all normals, then all tangentials; in space 3m × 3m,
    /// the two tangentials of a pair one after the other. Symmetric up to 1e-8 after scaling to unit diagonal.
    pub matrix: GivenMatrix,
    /// Load cases: name, factor, CLV (an entry per row).
    pub loads: Vec<GivenLoad>,
    /// Law of each pair.
    pub laws: Vec<Law>,
    /// Motions z with R z = 0 known to the author, an entry per row.
    pub kernel: Option<Vec<Vec<f64>>>,
}

/// The matrix of a given contact system.
#[derive(Clone, Debug, PartialEq)]
pub enum GivenMatrix {
    /// CSM: λ = R (z − (g, 0)) + RF; the load vectors are forces.
    Stiffness(Vec<Vec<f64>>),
    /// W: z = W λ + Σ factor·vector + (g, 0); the load vectors are mutual displacements without contact forces.
    Compliance(Vec<Vec<f64>>),
}

impl GivenMatrix {
    /// Its rows.
    pub fn rows(&self) -> &[Vec<f64>] {
        match self {
            GivenMatrix::Stiffness(rows) | GivenMatrix::Compliance(rows) => rows,
        }
    }
}

/// A load case of a given contact system.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenLoad {
    /// Name.
    pub name: String,
    /// Factor, may be a parameter.
    pub factor: Number,
    /// Contact load vector (with a compliance: displacements), an entry per row of the matrix.
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
#[expect(clippy::large_enum_variant, reason = "one for each scenario, never in lists")]
pub enum Source {
    /// Structure with contact pairs.
    Structure(Structure),
    /// CSM and CLV.
    ContactSystem(GivenContactSystem),
    /// Bare LCP.
    Lcp(GivenLcp),
}

impl Source {
    /// The plane or space: in which its structure lies, or its pairs slip.
    pub fn dimension(&self) -> Dimension {
        match self {
            Source::Structure(structure) => structure.dimension,
            Source::ContactSystem(given) if given.tangents == 2 => Dimension::Space,
            Source::ContactSystem(_) | Source::Lcp(_) => Dimension::Plane,
        }
    }
}

/// A stage of a load history: multiplier of each named case; cases not named count 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// (case name, multiplier).
    pub multipliers: Vec<(String, Number)>,
}

/// Where in the file each part of a structure stands, as JSON paths. Parts that one entry generates (the nodes of
/// a plate, the pairs of an edge) share its path. Empty for the other sources, except `pairs`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// Places of the nodes, one entry after the other.
    pub nodes: Vec<NodePlace>,
    /// Place of each element: its bar, plate or quad.
    pub elements: Vec<Arc<str>>,
    /// Place of each contact pair.
    pub pairs: Vec<Arc<str>>,
}

/// Where nodes that follow one another come from.
#[derive(Clone, Debug, PartialEq)]
pub struct NodePlace {
    /// Index of the first node after these.
    pub end: usize,
    /// JSON path of the entry; where each node has an entry of its own, under its id, that of their list.
    pub path: Arc<str>,
    pub is_list: bool,
}

impl Places {
    /// JSON path of what a node comes from.
    pub fn of_node(&self, structure: &Structure, node: usize) -> String {
        match self.nodes.get(self.nodes.partition_point(|place| place.end <= node)) {
            Some(place) if place.is_list => format!("{}.{}", place.path, structure.nodes[node].id),
            Some(place) => place.path.to_string(),
            None => String::new(),
        }
    }
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
    /// The formulas among them, each after those it needs.
    pub formulas: Arc<Formulas>,
    /// Where the parameters stand.
    pub uses: Uses,
    /// What is described; its plain numbers are those under the parameter values it was read with.
    pub source: Source,
    /// Load history; empty without one.
    pub stages: Vec<Stage>,
    /// Load combinations by name: multipliers of the cases' factors; cases not named count 0.
    pub combinations: Vec<(String, Stage)>,
    /// Names for quantities, in the order of the file.
    pub probes: Vec<(String, Quantity)>,
    /// What was measured on the real structure, in the order of the file.
    pub measured: Vec<Measurement>,
    /// Covering, tie-break and engine the file asks for.
    pub rules: Rules,
    /// Where its parts stand in `text`.
    pub places: Places,
    /// The meshes it names, as they were when it was loaded.
    pub meshes: MeshFiles,
    /// What was put right in them, in words.
    pub notes: Vec<String>,
}

impl Scenario {
    /// Hash of its text and of what stands in the files it names: meshes and matrices.
    pub fn hash(&self) -> Hash {
        let mut hash = Hash::of(&self.text);
        let mut numbers = |rows: &mut dyn Iterator<Item = f64>| {
            hash = rows.fold(hash, |hash, number| hash.and(&number.to_bits().to_le_bytes()));
        };
        match &self.source {
            Source::ContactSystem(given) => numbers(&mut given.matrix.rows().iter().flatten().copied()),
            Source::Lcp(lcp) => numbers(&mut lcp.matrix.iter().flatten().copied()),
            Source::Structure(structure) => {
                if let Some(element) = &structure.superelement {
                    let entries = element.entries.iter().flat_map(|&(i, j, value)| [i as f64, j as f64, value]);
                    numbers(&mut entries.into_iter());
                    let loads = structure.load_cases.iter().flat_map(|case| &case.loads);
                    let components = structure.dimension.components().iter();
                    let forces = loads.filter_map(|load| match *load {
                        Load::Nodal { node, force, moment } => {
                            let all = [force, moment];
                            let along = components.clone().map(|c| all[usize::from(c.is_rotation())][c.axis()]);
                            Some(std::iter::once(node as f64).chain(along).collect::<Vec<f64>>())
                        }
                        _ => None,
                    });
                    numbers(&mut forces.flatten());
                }
            }
        }
        let mut meshes: Vec<_> = self.meshes.0.iter().collect();
        meshes.sort_by_key(|(name, _)| name.as_str());
        for (name, mesh) in meshes {
            hash = mesh.hash(hash.and(name.as_bytes()));
        }
        hash
    }

    /// A problem of this scenario that only a later stage could find, placed at a JSON path such as those in
    /// [`Places`] (at the nearest place around it if the path leads nowhere).
    pub fn problem_at(&self, path: &str, message: impl Into<String>, help: impl Into<String>) -> Problems {
        let mut problems = Problems::of_file(self.name.as_str(), message, help);
        // The text was parsed when it was loaded.
        if let Ok(document) = Document::parse(&self.text) {
            let offset = document.offset_of(path);
            let (line, column) = document.position(offset);
            for problem in &mut problems.problems {
                *problem = Problem {
                    line,
                    column,
                    path: document.path_at(offset),
                    message: std::mem::take(&mut problem.message),
                    help: std::mem::take(&mut problem.help),
                };
            }
        }
        problems
    }

    /// The unit of a parameter; `None` where it has none, and of what is not a parameter.
    pub fn unit_of(&self, parameter: &str) -> Option<&str> {
        self.parameters.get(parameter)?.unit.as_deref()
    }

    /// Why the parameter cannot take this value whatever the others are: a formula, a value that is not finite, a
    /// negative friction, cohesion or bound. `None` if it can.
    pub fn refusal(&self, parameter: &str, value: f64) -> Option<String> {
        if let Some(formula) = self.parameters.get(parameter).and_then(|parameter| parameter.formula.as_ref()) {
            let free: Vec<String> = self.formulas.free(formula.parameters()).into_iter().collect();
            let instead = match &free[..] {
                [] => "change it in the file".to_owned(),
                free => format!("set {}", free.join(" or ")),
            };
            return Some(format!("{parameter} is a formula, {}: it is computed, not set; {instead}", formula.text()));
        }
        if !value.is_finite() {
            return Some(format!("{parameter} must be a finite number"));
        }
        if value >= 0.0 {
            return None;
        }
        self.signed_numbers().into_iter().find_map(|(id, what, number)| {
            (number.parameter() == Some(parameter))
                .then(|| format!("{parameter} is the {what} of {id} and must not be negative, found {value}"))
        })
    }

    /// Why the laws of contact cannot take these values: a negative friction, cohesion or bound, or a number that is
    /// not finite. `None` if they can.
    pub fn law_refusal(&self, values: &ParameterValues) -> Option<String> {
        if let Some((name, value)) = values.iter().find(|(_, value)| !value.is_finite()) {
            return Some(match values.formula(name) {
                Some(formula) => format!("{name} = {} must be a finite number, found {value}", formula.text()),
                None => format!("{name} must be a finite number"),
            });
        }
        self.signed_numbers().into_iter().find_map(|(id, what, number)| {
            let value = number.value(values);
            match number {
                _ if value >= 0.0 => None,
                Number::Parameter(name) => {
                    Some(format!("{name} is the {what} of {id} and must not be negative, found {value}"))
                }
                _ => Some(format!("{} is the {what} of {id} and must not be negative, found {value}", number.text())),
            }
        })
    }

    /// Pair, key and number of everything in the laws that must not be negative.
    fn signed_numbers(&self) -> Vec<(&str, &'static str, &Number)> {
        let laws: Vec<(&str, &Law)> = match &self.source {
            Source::Structure(structure) => structure.pairs.iter().map(|pair| (pair.id.as_str(), &pair.law)).collect(),
            Source::ContactSystem(system) => system.pairs.iter().map(String::as_str).zip(&system.laws).collect(),
            Source::Lcp(_) => Vec::new(),
        };
        let all = laws.into_iter().flat_map(|(id, law)| {
            law.numbers().into_iter().filter(|(key, _)| *key != "gap").map(move |(key, number)| (id, key, number))
        });
        all.collect()
    }

    /// Every parameter at the value of the file.
    pub fn parameter_values(&self) -> ParameterValues {
        let values = self.parameters.iter().map(|(name, parameter)| (name.clone(), parameter.value)).collect();
        ParameterValues::with_formulas(values, Arc::clone(&self.formulas))
    }
}
