//! What depends on geometry, stiffness and loads alone: factorization, R, RF per load case. Reused for every change of
//! laws and load factors; a change of a number in the loads or in the geometry recomputes what depends on it.

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{DMatrix, DVector};

use crate::contact::force_form::{Dependence, Repeats, with_repeated};
use crate::contact::given::{GivenError, given_system, with_loads};
use crate::contact::system::{ContactPair, ContactSystem, JointLoad};
use crate::contact::yielding::yielding;
use crate::explain::ray::Built;
use crate::fem::{MainSystem, MainSystemError};
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::problem::Scale;
use crate::model::joints::joint_numbers;
use crate::model::load::at_values;
use crate::model::pair::{Joint, JointDirection, joints, with_rollers};
use crate::model::parameter::{Number, ParameterValues};
use crate::model::problem::{LISTED, Problems};
use crate::model::scenario::{GivenLcp, Scenario, Source};
use crate::model::structure::{Dimension, Structure};
use crate::model::uses::Redone;
use crate::watch::Watch;

/// What kind of thing is solved.
#[expect(clippy::large_enum_variant, reason = "one for each prepared scenario, never in lists")]
pub enum Geometry {
    /// A structure with its main system.
    Structure {
        /// Condensed to its joints.
        system: Arc<ContactSystem>,
        /// For displacements, members, reactions and the check of equilibrium.
        main: Box<MainSystem>,
        /// The structure itself.
        structure: Structure,
    },
    /// A contact system read from a file.
    Contact {
        /// Condensed to its joints.
        system: Arc<ContactSystem>,
        /// What the user should know of the matrix of the file.
        remarks: Vec<String>,
    },
    /// A bare LCP; q is filled in at solve time.
    Plain {
        /// M, d and scale.
        lcp: MirroredLcp,
        /// q, each entry may be a parameter.
        q: Vec<Number>,
        /// Names of the rows.
        names: Vec<String>,
        /// Whether the covering vector was given.
        covering_given: bool,
    },
}

/// A scenario made ready to be solved for any values of its parameters. A copy shares the geometry.
#[derive(Clone)]
pub struct Prepared {
    /// What is solved.
    pub geometry: Arc<Geometry>,
    /// The parameter values under which its plain numbers were read.
    values: ParameterValues,
    /// Name and factor of each load case.
    pub cases: Vec<(String, Number)>,
    /// Seconds for the factorization of the main system.
    pub factor_seconds: f64,
    /// Seconds for R and RF.
    pub condense_seconds: f64,
    /// Seconds for everything here.
    pub seconds: f64,
}

impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Prepared").field("cases", &self.cases).finish_non_exhaustive()
    }
}

/// Why a scenario cannot be prepared.
#[derive(Debug, thiserror::Error)]
pub enum PrepareError {
    /// The scenario is at fault; says where.
    #[error("{0}")]
    Problems(Problems),
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl PrepareError {
    /// Whether the work was stopped from outside.
    pub fn is_interrupted(&self) -> bool {
        matches!(self, PrepareError::Interrupted)
    }
}

/// Prepares a scenario under the parameter values of its file.
///
/// # Errors
/// As [`prepare_at`].
pub fn prepare(scenario: &Scenario, watch: &dyn Watch) -> Result<Prepared, PrepareError> {
    prepare_at(scenario, &scenario.parameter_values(), watch)
}

/// Prepares a scenario under other parameter values.
///
/// # Errors
/// Values that make the model invalid; dependent joints, a mechanism in the main system, a model too large for memory,
/// an unusable given matrix: each with its place in the file.
pub fn prepare_at(scenario: &Scenario, values: &ParameterValues, watch: &dyn Watch) -> Result<Prepared, PrepareError> {
    let again;
    let scenario = match scenario.uses.between(&scenario.parameter_values(), values) {
        Redone::Lcp => scenario,
        Redone::Loads | Redone::Stiffness => {
            again = at_values(scenario, values).map_err(PrepareError::Problems)?;
            &again
        }
    };
    let start = Instant::now();
    stickslip_numerics::compute_sequentially();
    let mut prepared = match &scenario.source {
        Source::Structure(structure) => prepare_structure(scenario, structure, watch)?,
        Source::ContactSystem(given) => {
            let (system, remarks) = given_system(given).map_err(|error| given_problem(scenario, error))?;
            Prepared {
                geometry: Arc::new(Geometry::Contact { system: Arc::new(system), remarks }),
                values: ParameterValues::new(),
                cases: given.loads.iter().map(|load| (load.name.clone(), load.factor.clone())).collect(),
                factor_seconds: 0.0,
                condense_seconds: 0.0,
                seconds: 0.0,
            }
        }
        Source::Lcp(given) => prepare_plain(given),
    };
    prepared.seconds = start.elapsed().as_secs_f64();
    prepared.values = values.clone();
    Ok(prepared)
}

/// Gives an error of a given contact system its place in the file.
fn given_problem(scenario: &Scenario, error: GivenError) -> PrepareError {
    let path = match &error {
        GivenError::Indefinite { key, .. }
        | GivenError::NegativeDiagonal { key, .. }
        | GivenError::NegativeMinor { key, .. } => format!("contact_system.{key}"),
        GivenError::Held { .. } | GivenError::NearlySingular { .. } => "contact_system.compliance".to_owned(),
        GivenError::Unheld { case, .. } => format!("contact_system.loads.{case}"),
    };
    PrepareError::Problems(scenario.problem_at(&path, error.to_string(), ""))
}

fn prepare_plain(given: &GivenLcp) -> Prepared {
    let n = given.q.len();
    let lcp = MirroredLcp {
        base: Arc::new(DMatrix::from_fn(n, n, |i, j| given.matrix[i][j])),
        q: DVector::zeros(n),
        covering: given.covering.as_ref().map_or_else(|| DVector::repeat(n, 1.0), |d| DVector::from_column_slice(d)),
        whole: (0..n).collect(),
        mirrors: vec![None; n],
        scale: Scale::plain(&given.matrix),
        full_size: n,
    };
    Prepared {
        geometry: Arc::new(Geometry::Plain {
            lcp,
            q: given.q.clone(),
            names: given.names.clone(),
            covering_given: given.covering.is_some(),
        }),
        values: ParameterValues::new(),
        cases: Vec::new(),
        factor_seconds: 0.0,
        condense_seconds: 0.0,
        seconds: 0.0,
    }
}

/// Gives an error of the main system its place in the file.
pub(super) fn main_system_problem(scenario: &Scenario, structure: &Structure, error: MainSystemError) -> PrepareError {
    let places = &scenario.places;
    let node = |node: usize| places.of_node(structure, node);
    let path = match &error {
        MainSystemError::Interrupted => return PrepareError::Interrupted,
        MainSystemError::DependentJoints(joints) => {
            let place = |pair: usize| places.pairs.get(pair).map_or("contacts".to_owned(), ToString::to_string);
            return problems_at(scenario, joints.iter().map(|joint| (place(joint.pair), joint.to_string())));
        }
        MainSystemError::OverConstrained(bodies) => {
            let place = |body: usize| format!("rigid[{body}]");
            return problems_at(scenario, bodies.iter().map(|body| (place(body.body), body.to_string())));
        }
        MainSystemError::Mechanism { node: at, .. }
        | MainSystemError::Lost { node: at, .. }
        | MainSystemError::Contrast { node: at, .. }
        | MainSystemError::Slender { node: at, .. } => node(*at),
        MainSystemError::Indefinite { .. } => "superelement.stiffness.file".to_owned(),
        MainSystemError::MomentWithoutRotation { case, .. } => format!("loads.{case}"),
        MainSystemError::Element { nodes, .. } => structure
            .nodes
            .iter()
            .position(|candidate| Some(&candidate.id) == nodes.first())
            .map_or(String::new(), node),
        _ => String::new(),
    };
    PrepareError::Problems(scenario.problem_at(&path, error.to_string(), ""))
}

/// Several problems with their places; of very many the first ones.
fn problems_at(scenario: &Scenario, all: impl Iterator<Item = (String, String)>) -> PrepareError {
    let mut listed = Problems { file: scenario.name.clone(), problems: Vec::new(), more: 0 };
    for (path, message) in all {
        if listed.problems.len() < LISTED {
            listed.problems.extend(scenario.problem_at(&path, message, "").problems);
        } else {
            listed.more += 1;
        }
    }
    PrepareError::Problems(listed)
}

/// RF of every load case with its name and the magnitude of its terms.
fn joint_loads(structure: &Structure, main: &MainSystem) -> Vec<JointLoad> {
    let cases = structure.load_cases.iter().zip(main.loads()).zip(main.load_terms());
    cases
        .map(|((case, vector), terms)| JointLoad {
            name: case.name.clone(),
            // A joint far from the load carries the rounding of forces that pass elsewhere.
            terms: vector.zip_map(terms, |force, terms| force.abs().max(terms)),
            vector: vector.clone(),
        })
        .collect()
}

fn dependence(main: &MainSystem) -> Dependence<'_> {
    let repeated = main.repeated().iter().map(|one| Repeats { joint: one.joint, terms: &one.terms }).collect();
    Dependence { independent: main.independent(), repeated, offsets: main.repeated_offsets() }
}

/// The main system, with rollers where pairs have no bound; where one is all that holds a part along its tangent, though not in
/// an answer, all of them are joints: the loads need not push the part.
fn main_system(
    scenario: &Scenario,
    structure: &Structure,
    watch: &dyn Watch,
) -> Result<(Structure, Vec<Joint>, MainSystem), PrepareError> {
    let made = |structure: Structure| {
        let joints = joints(&structure.pairs);
        match MainSystem::new(&structure, &joints, watch) {
            Ok(main) => Ok((structure, joints, main)),
            Err(error) => Err(main_system_problem(scenario, &structure, error)),
        }
    };
    if let Some(pairs) = with_rollers(&structure.pairs) {
        match made(Structure { pairs, ..structure.clone() }) {
            Err(PrepareError::Problems(_)) => {}
            made => return made,
        }
    }
    made(structure.clone())
}

fn prepare_structure(scenario: &Scenario, structure: &Structure, watch: &dyn Watch) -> Result<Prepared, PrepareError> {
    let (structure, joints, main) = main_system(scenario, structure, watch)?;
    // The two tangential joints of a pair stand one after the other.
    let tangential = |pair: usize| {
        let of_pair = |joint: &Joint| joint.pair == pair && joint.direction != JointDirection::Normal;
        let first = joints.iter().position(of_pair).unwrap_or_default();
        first..first + joints.iter().filter(|joint| of_pair(joint)).count()
    };
    let numbers = joint_numbers(&structure);
    let pairs = structure
        .pairs
        .iter()
        .enumerate()
        .map(|(i, pair)| ContactPair {
            id: pair.id.clone(),
            law: pair.law.clone(),
            position: Some(pair.at_place(|node| structure.nodes[node].position)),
            frame: (structure.dimension == Dimension::Space).then(|| [pair.normal, pair.tangents[0]]),
            joint: numbers[i],
            tangential: tangential(i),
        })
        .collect();
    let loads = joint_loads(&structure, &main);
    let mut system = ContactSystem {
        pairs,
        tangents: structure.dimension.coordinates() - 1,
        stiffness: main.stiffness().clone(),
        loads,
        rounded: true,
        groups: main.groups().to_vec(),
        kernel: main.kernel().clone(),
        corrected: None,
        force_form: None,
        yielding: None,
        file: None,
    };
    system.zero_free_joints();
    if !main.repeated().is_empty() {
        system = with_repeated(system, &dependence(&main));
        if system.is_in_space() {
            system = yielding(system);
        }
    }
    let seconds = main.timings();
    let cases = structure.load_cases.iter().map(|case| (case.name.clone(), case.factor.clone())).collect();
    Ok(Prepared {
        geometry: Arc::new(Geometry::Structure { system: Arc::new(system), main: Box::new(main), structure }),
        values: ParameterValues::new(),
        cases,
        factor_seconds: seconds.factor,
        condense_seconds: seconds.condense,
        seconds: 0.0,
    })
}

impl Prepared {
    /// The same scenario made ready for other parameter values, and what was computed anew for them; `None` where this
    /// is ready for them already.
    ///
    /// # Errors
    /// As [`prepare_at`].
    pub fn renewed(
        &self,
        scenario: &Scenario,
        values: &ParameterValues,
        watch: &dyn Watch,
    ) -> Result<Option<(Prepared, Redone)>, PrepareError> {
        match scenario.uses.between(&self.values, values) {
            Redone::Lcp => Ok(None),
            Redone::Loads => {
                let again = at_values(scenario, values).map_err(PrepareError::Problems)?;
                match self.with_loads(&again, values)? {
                    Some(prepared) => Ok(Some((prepared, Redone::Loads))),
                    None => Ok(Some((prepare_at(scenario, values, watch)?, Redone::Stiffness))),
                }
            }
            Redone::Stiffness => Ok(Some((prepare_at(scenario, values, watch)?, Redone::Stiffness))),
        }
    }

    /// RF anew with the kept factorization; `scenario` was read under `values`. `None` where the sources do not match.
    pub(super) fn with_loads(
        &self,
        scenario: &Scenario,
        values: &ParameterValues,
    ) -> Result<Option<Prepared>, PrepareError> {
        let start = Instant::now();
        let geometry = match (&*self.geometry, &scenario.source) {
            (Geometry::Structure { system, main, structure: before }, Source::Structure(structure)) => {
                // The laws with the joints that they have in this main system.
                let structure = Structure { pairs: before.pairs.clone(), ..structure.clone() };
                let main =
                    main.with_loads(&structure).map_err(|error| main_system_problem(scenario, &structure, error))?;
                let loads = dependence(&main).loads(joint_loads(&structure, &main));
                let system = match &system.yielding {
                    Some(made) => yielding(ContactSystem { loads, ..ContactSystem::clone(&made.exact) }),
                    None => ContactSystem { loads, ..ContactSystem::clone(system) },
                };
                let system = Arc::new(system);
                Geometry::Structure { system, main: Box::new(main), structure }
            }
            (Geometry::Contact { system, remarks }, Source::ContactSystem(given)) => {
                let system = Arc::new(with_loads(system, given).map_err(|error| given_problem(scenario, error))?);
                Geometry::Contact { system, remarks: remarks.clone() }
            }
            _ => return Ok(None),
        };
        Ok(Some(Prepared {
            geometry: Arc::new(geometry),
            values: values.clone(),
            cases: self.cases.clone(),
            factor_seconds: 0.0,
            condense_seconds: start.elapsed().as_secs_f64(),
            seconds: start.elapsed().as_secs_f64(),
        }))
    }

    /// The same with other factors of the load cases, fixed ones.
    pub fn with_factors(&self, factors: &[f64]) -> Prepared {
        let cases = self.cases.iter().zip(factors).map(|((name, _), factor)| (name.clone(), Number::Value(*factor)));
        Prepared {
            geometry: Arc::clone(&self.geometry),
            values: self.values.clone(),
            cases: cases.collect(),
            factor_seconds: self.factor_seconds,
            condense_seconds: self.condense_seconds,
            seconds: self.seconds,
        }
    }

    /// The structure under its parameter values, if this is one.
    pub fn structure(&self) -> Option<&Structure> {
        match &*self.geometry {
            Geometry::Structure { structure, .. } => Some(structure),
            Geometry::Contact { .. } | Geometry::Plain { .. } => None,
        }
    }

    /// The structure and its main system, where there is one.
    pub(crate) fn built(&self) -> Built<'_> {
        match &*self.geometry {
            Geometry::Structure { main, structure, .. } => Some((structure, main)),
            Geometry::Contact { .. } | Geometry::Plain { .. } => None,
        }
    }

    /// The contact system, unless this is a bare LCP.
    pub fn system(&self) -> Option<&Arc<ContactSystem>> {
        match &*self.geometry {
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => Some(system),
            Geometry::Plain { .. } => None,
        }
    }

    /// Whether pairs slip in a plane of directions.
    pub fn is_in_space(&self) -> bool {
        self.system().is_some_and(|system| system.is_in_space())
    }
}
