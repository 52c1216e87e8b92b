//! JSON Schema of the scenario format, for editors and other programs.
//!
//! The decoder reads the tree by hand, to collect all problems with their places; these types only say the same once
//! more in a form from which a schema can be made. The tests hold the two together, key by key.

#![expect(dead_code, reason = "the types are only looked at: the schema is made of them")]

use std::collections::BTreeMap;

use schemars::generate::SchemaSettings;
use schemars::transform::{RecursiveTransform, Transform};
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value};

mod elements;
mod loads;

use elements::{Bar, Material, Mesh, Plate, Quad, Section, Triangle};
use loads::LoadCase;

/// A scenario of stickslip: a structure, a superelement, a contact system or an LCP
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields, title = "stickslip/1")]
#[schemars(extend("oneOf" = [
    { "required": ["contact_system"] },
    { "required": ["lcp"], "not": { "anyOf": [{ "required": ["stages"] }, { "required": ["combinations"] }] } },
    { "anyOf": [
        { "required": ["materials"] }, { "required": ["sections"] }, { "required": ["nodes"] },
        { "required": ["bars"] }, { "required": ["plates"] }, { "required": ["quads"] },
        { "required": ["meshes"] }, { "required": ["triangles"] }, { "required": ["edges"] },
        { "required": ["foundations"] }, { "required": ["rigid"] }, { "required": ["ties"] }, { "required": ["supports"] }, { "required": ["springs"] },
        { "required": ["contacts"] }, { "required": ["loads"] }, { "required": ["superelement"] },
    ] },
]))]
struct Scenario {
    /// Where the schema of this file is, for editors
    #[schemars(rename = "$schema")]
    schema: Option<String>,
    /// Version of the format
    #[schemars(extend("const" = "stickslip/1"))]
    format: String,
    /// A few words on what this is
    #[schemars(length(min = 1))]
    title: String,
    /// More about it
    description: Option<String>,
    /// Labels of the author's consistent units
    units: Option<Units>,
    /// What the user varies, by name; a number of the model may be written as the name of one, or as an expression
    parameters: Option<BTreeMap<String, Parameter>>,
    /// Load history: for each stage what multiplies the factors of the load cases; cases not named count 0
    stages: Option<Vec<BTreeMap<String, Number>>>,
    /// Load combinations by name: what multiplies the factors of the load cases; cases not named count 0
    combinations: Option<BTreeMap<String, BTreeMap<String, Number>>>,
    /// Names for quantities, like "lift": "z_n base[0]"
    probes: Option<BTreeMap<String, String>>,
    /// Rules of the solver
    solver: Option<Solver>,
    /// Materials by id
    materials: Option<BTreeMap<String, Material>>,
    /// Cross-sections of bars by id
    sections: Option<BTreeMap<String, Section>>,
    /// Nodes by id: [x, y]
    nodes: Option<BTreeMap<String, [Number; 2]>>,
    /// Frame and truss bars
    bars: Option<Vec<Bar>>,
    /// Rectangular plates of bilinear elements
    plates: Option<Vec<Plate>>,
    /// Meshes of Gmsh, Abaqus and CalculiX
    meshes: Option<Vec<Mesh>>,
    /// Single triangles
    triangles: Option<Vec<Triangle>>,
    /// Single four-node elements
    quads: Option<Vec<Quad>>,
    /// Edges with a name: chains of the sides of elements, corner by corner
    edges: Option<BTreeMap<String, Vec<String>>>,
    /// Rigid bodies
    rigid: Option<Vec<Rigid>>,
    /// Nodes that share displacements
    ties: Option<Vec<Tie>>,
    /// Supports
    supports: Option<Vec<Support>>,
    /// Springs to the ground
    springs: Option<Vec<Spring>>,
    /// Elastic foundations along bars and edges
    foundations: Option<Vec<Foundation>>,
    /// Frictional contacts
    contacts: Option<Vec<Contact>>,
    /// Load cases by name
    loads: Option<BTreeMap<String, LoadCase>>,
    /// K and F of another program in the place of elements and nodes
    superelement: Option<Superelement>,
    /// CSM and CLV computed elsewhere
    contact_system: Option<ContactSystem>,
    /// A bare linear complementarity problem
    lcp: Option<Lcp>,
}

/// Labels of units
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Units {
    /// E.g. m
    length: Option<String>,
    /// E.g. kN
    force: Option<String>,
}

/// A number, the name of a parameter, or an expression of parameters
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Number {
    /// The number itself
    Value(f64),
    /// The name of a parameter, or an expression like 2*F + 1
    Expression(String),
}

/// A value, or an object with it or with a formula
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Parameter {
    /// The value alone
    Value(f64),
    /// The value with its range, or a formula
    Object(ParameterObject),
}

/// A parameter with what a slider needs, or one that is computed from others
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [
    { "required": ["value"], "not": { "required": ["formula"] } },
    { "required": ["formula"], "not": { "anyOf": [
        { "required": ["value"] }, { "required": ["min"] }, { "required": ["max"] }, { "required": ["step"] },
    ] } },
]))]
struct ParameterObject {
    /// Value in the file, within min and max
    value: Option<f64>,
    /// An expression of other parameters, which gives the value
    formula: Option<String>,
    /// Low end of the slider
    min: Option<f64>,
    /// High end of the slider
    max: Option<f64>,
    /// Step of the slider
    #[schemars(extend("exclusiveMinimum" = 0))]
    step: Option<f64>,
    /// Label of its unit
    unit: Option<String>,
    /// What it is
    about: Option<String>,
}

/// Rules of the solver
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Solver {
    /// Covering vector; not for an lcp
    covering: Option<Covering>,
    /// Which of tied rows leaves: lexicographic, natural, first-row or random:SEED
    #[schemars(regex(pattern = r"^(lexicographic|natural|first-row|random:[0-9]+)$"))]
    tie_break: Option<String>,
    /// Which implementation of Lemke's algorithm runs
    engine: Option<Engine>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Covering {
    Cohesive,
    Ones,
    Weight,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Engine {
    Scheme,
    Tableau,
    Exact,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Component {
    X,
    Y,
    R,
}

/// Nodes that move as one rigid body
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["nodes"] }, { "required": ["at"] }]))]
struct Rigid {
    /// Id
    id: String,
    /// Its nodes
    nodes: Option<Vec<String>>,
    /// An edge all nodes of which move as one
    at: Option<String>,
    /// Node that belongs to the body and by which its motion is told; the first one if left out
    about: Option<String>,
}

/// Nodes that share displacements
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["nodes"] }, { "required": ["at"] }]))]
struct Tie {
    /// Two nodes or more
    nodes: Option<Vec<String>>,
    /// An edge all nodes of which are tied
    at: Option<String>,
    /// What they share; x and y if left out
    fixed: Option<Vec<Component>>,
}

/// A support
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Support {
    /// Node or edge
    at: String,
    /// Held displacements
    fixed: Vec<Component>,
    /// Imposed displacement [ux, uy] or [ux, uy, r], scaled by the factor of `case`
    settlement: Option<Vec<Number>>,
    /// Load case of the settlement
    case: Option<String>,
}

/// A spring to the ground or between two nodes
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["at"] }, { "required": ["between"] }]))]
#[schemars(extend("anyOf" = [{ "required": ["direction", "stiffness"] }, { "required": ["rotation"] }]))]
struct Spring {
    /// Node or edge, held to the ground
    at: Option<String>,
    /// Two nodes, held to each other
    between: Option<[String; 2]>,
    /// Any non-zero vector
    direction: Option<[Number; 2]>,
    /// Force per displacement; at an edge, of each node
    #[schemars(extend("minimum" = 0))]
    stiffness: Option<Number>,
    /// Moment per rotation, instead of direction and stiffness
    #[schemars(extend("minimum" = 0))]
    rotation: Option<Number>,
}

/// An elastic foundation
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Foundation {
    /// Id; pairs are id[0], id[1] …
    id: String,
    /// Bar or edge
    on: String,
    /// Force per length of line and displacement, along `direction`
    #[schemars(extend("exclusiveMinimum" = 0))]
    stiffness: Number,
    /// From the ground to the body; if left out the inward normal of an edge, local y of a bar
    direction: Option<[Number; 2]>,
    /// The same along the line; beside `tensionless` only with `friction`
    #[schemars(extend("minimum" = 0))]
    tangential: Option<Number>,
    /// Whether it can open; false if left out
    tensionless: Option<bool>,
    /// Friction coefficient f ≥ 0 of a tensionless one; frictionless if left out
    friction: Option<Number>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Law {
    Coulomb,
    Frictionless,
    Bound,
}

/// One for all pairs, or for an edge an array with one entry per pair
#[derive(JsonSchema)]
#[schemars(untagged)]
enum PerPair {
    /// For all pairs
    All(Number),
    /// Pair by pair
    Each(Vec<Number>),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Method {
    Nodes,
    Mortar,
}

/// Frictional contact of a node or of the nodes of an edge
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["node", "normal"] }, { "required": ["edge"] }]))]
struct Contact {
    /// Id of the pair, or of the row of pairs id[0], id[1] …
    id: String,
    /// A node
    node: Option<String>,
    /// An edge
    edge: Option<String>,
    /// Another node or edge, or "ground"
    against: String,
    /// From `against` to `node`; an edge has its own
    normal: Option<[Number; 2]>,
    /// `coulomb` if left out
    law: Option<Law>,
    /// Friction coefficient f ≥ 0
    friction: Option<PerPair>,
    /// Cohesion c ≥ 0
    cohesion: Option<PerPair>,
    /// Gap g; negative: an interference; "geometry": the distance of the two sides as they are drawn
    gap: Option<PerPair>,
    /// Friction bound r_f ≥ 0 of the law `bound`
    bound: Option<PerPair>,
    /// Indices of an edge without contact
    skip: Option<Vec<u32>>,
    /// How two edges meet: node by node, or by mortar where the nodes do not match; if left out as the nodes ask for
    method: Option<Method>,
}

/// Stiffness and loads of another program on some displacements of nodes
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Superelement {
    /// K, symmetric and positive semidefinite, with a row for each of `dofs`
    stiffness: MatrixFile,
    /// Load cases by name
    loads: Option<BTreeMap<String, ForceFile>>,
    /// Nodes by id: [x, y]
    nodes: BTreeMap<String, [Number; 2]>,
    /// Node and displacement of each row of K
    dofs: Vec<(String, Component)>,
}

/// Forces in a file: one column with a row for each of `dofs`
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct ForceFile {
    /// Matrix Market file beside the scenario
    file: String,
    /// What multiplies them; 1 if left out
    factor: Option<Number>,
}

/// Contact stiffness matrix and contact load vectors
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["stiffness"] }, { "required": ["compliance"] }]))]
struct ContactSystem {
    /// Ids of the m pairs
    pairs: Vec<String>,
    /// Places of the pairs, for plots
    positions: Option<Vec<Number>>,
    /// CSM, 2m × 2m: all normals, then all tangentials; this or `compliance` is required
    stiffness: Option<Matrix>,
    /// Its inverse W in the place of `stiffness`: z = W λ + Σ factor·vector + (g, 0)
    compliance: Option<Matrix>,
    /// Load cases by name
    loads: BTreeMap<String, JointLoad>,
    /// Law of each pair; coulomb if left out
    law: Option<Vec<Law>>,
    /// f of each pair; 0 if left out
    friction: Option<Vec<Number>>,
    /// c of each pair; 0 if left out
    cohesion: Option<Vec<Number>>,
    /// g of each pair; 0 if left out
    gap: Option<Vec<Number>>,
    /// r_f of each pair, where the law is `bound`
    bound: Option<Vec<Number>>,
    /// Motions z with R z = 0
    kernel: Option<Vec<Vec<Number>>>,
}

/// A square matrix
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Matrix {
    /// Its rows
    Rows(Vec<Vec<Number>>),
    /// In a Matrix Market file
    File(MatrixFile),
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MatrixFile {
    /// Matrix Market file, relative to the scenario
    file: String,
}

/// Loads in the joints
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct JointLoad {
    /// 1 if left out
    factor: Option<Number>,
    /// 2m entries: all normals, then all tangentials
    vector: Vec<Number>,
}

/// w = M z + q, w ≥ 0, z ≥ 0, wᵀz = 0
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Lcp {
    /// n × n
    #[schemars(rename = "M")]
    matrix: Matrix,
    /// Right-hand side
    q: Vec<Number>,
    /// Covering vector d; ones if left out
    covering: Option<Vec<Number>>,
    /// Names of the rows
    names: Option<Vec<String>>,
}

/// The decoder knows a key that is left out, but no `null`.
fn without_null(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else {
        return;
    };
    if let Some(Value::Array(kinds)) = object.get_mut("type") {
        kinds.retain(|kind| kind != "null");
        if let [one] = kinds.as_slice() {
            let one = one.clone();
            object.insert("type".into(), one);
        }
    }
    if let Some(Value::Array(kinds)) = object.get_mut("enum") {
        kinds.retain(|kind| !kind.is_null());
    }
    if let Some(Value::Array(ways)) = object.get_mut("anyOf") {
        ways.retain(|way| way.get("type").is_none_or(|kind| kind != "null"));
        if let [Value::Object(one)] = ways.as_slice() {
            let one = one.clone();
            object.remove("anyOf");
            for (key, value) in one {
                object.entry(key).or_insert(value);
            }
        }
    }
}

/// The schema, JSON Schema draft 2020-12.
pub fn schema() -> Value {
    let mut schema = SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<Scenario>();
    RecursiveTransform(without_null).transform(&mut schema);
    let Value::Object(mut rules) = schema.to_value() else {
        return Value::Bool(true); // a type with fields never is
    };
    // What it is stands first.
    let mut ordered = Map::new();
    for key in ["$schema", "title", "description"] {
        ordered.extend(rules.remove(key).map(|value| (key.to_owned(), value)));
    }
    ordered.extend(rules);
    Value::Object(ordered)
}

#[cfg(test)]
mod tests;
