//! Schema of materials, sections and elements.

use std::collections::BTreeMap;

use schemars::JsonSchema;

use super::Number;

/// A linear elastic material
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus
    #[schemars(rename = "E", extend("exclusiveMinimum" = 0))]
    modulus: Number,
    /// Poisson's ratio; 0.5 is excluded in plane strain
    #[schemars(extend("exclusiveMinimum" = -1, "maximum" = 0.5))]
    nu: Number,
    /// Mass per volume; 0 if left out
    #[schemars(extend("minimum" = 0))]
    density: Option<Number>,
    /// Thermal expansion; 0 if left out
    expansion: Option<Number>,
}

/// Cross-section of a bar
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Section {
    /// Area
    #[schemars(extend("exclusiveMinimum" = 0))]
    area: Number,
    /// Second moment of area; not needed by trusses
    #[schemars(extend("exclusiveMinimum" = 0))]
    inertia: Option<Number>,
    /// Depth, across which a temperature may vary
    #[schemars(extend("exclusiveMinimum" = 0))]
    depth: Option<Number>,
    /// Shear area; without one the bar does not yield to shear
    #[schemars(extend("exclusiveMinimum" = 0))]
    shear_area: Option<Number>,
}

/// A bar between two nodes or along several
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["nodes"] }, { "required": ["polyline"] }]))]
pub struct Bar {
    /// Id
    id: String,
    /// Start and end
    nodes: Option<[String; 2]>,
    /// The nodes from start to end, two or more
    polyline: Option<Vec<String>>,
    /// `frame` if left out
    kind: Option<BarKind>,
    /// Id of the material
    material: String,
    /// Id of the section
    section: String,
    /// Number of equal elements (of each segment of a polyline); 1 if left out
    #[schemars(range(min = 1))]
    divisions: Option<u32>,
    /// Ends with a hinge
    hinges: Option<Vec<BarEnd>>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
pub enum BarKind {
    Frame,
    Truss,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
pub enum BarEnd {
    Start,
    End,
}

/// A rectangle of four-node elements: `size` and `divisions`, or grid lines `x` and `y`
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [
    { "required": ["size", "divisions"] },
    { "required": ["x", "y"] },
]))]
pub struct Plate {
    /// Id
    id: String,
    /// Place of node [0,0]
    origin: [Number; 2],
    /// Length and height
    size: Option<[Number; 2]>,
    /// Elements along the length and the height
    divisions: Option<[u32; 2]>,
    /// Grid lines along the length, from the origin
    x: Option<Vec<Number>>,
    /// Grid lines along the height, from the origin
    y: Option<Vec<Number>>,
    /// Degrees counter-clockwise about the origin; 0 if left out
    rotation: Option<Number>,
    /// Thickness
    #[schemars(extend("exclusiveMinimum" = 0))]
    thickness: Number,
    /// Id of the material
    material: String,
    /// Plane strain or plane stress
    plane: Plane,
    /// Plain, or with modes of bending of its own; plain if left out
    element: Option<QuadKind>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
pub enum QuadKind {
    Plain,
    Incompatible,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
pub enum Plane {
    Strain,
    Stress,
}

/// A mesh file: nodes id/17, elements id#17, groups of lines are edges id.GROUP
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Mesh {
    /// Id
    id: String,
    /// File of Gmsh (.msh) or of Abaqus or CalculiX (.inp), relative to the scenario
    file: String,
    /// Multiplies the coordinates; 1 if left out
    #[schemars(extend("exclusiveMinimum" = 0))]
    scale: Option<Number>,
    /// What the groups are made of; "*" is for elements in no group
    materials: BTreeMap<String, MeshGroup>,
}

/// What a group of a mesh is made of
#[derive(JsonSchema)]
#[schemars(untagged)]
enum MeshGroup {
    /// Elements
    Areas(MeshAreas),
    /// Lines that are bars
    Lines(MeshLines),
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MeshAreas {
    /// Id of the material
    material: String,
    /// Thickness
    #[schemars(extend("exclusiveMinimum" = 0))]
    thickness: Number,
    /// Plane strain or plane stress
    plane: Plane,
    /// Plain, or with modes of bending of their own (four nodes); plain if left out
    element: Option<QuadKind>,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct MeshLines {
    /// Id of the material
    material: String,
    /// Id of the section
    section: String,
    /// If left out as the file says: truss for T2D2, else frame
    kind: Option<BarKind>,
}

/// One four-node element of any convex shape
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Quad {
    /// Id
    id: String,
    /// Corners counter-clockwise
    nodes: [String; 4],
    /// Thickness
    #[schemars(extend("exclusiveMinimum" = 0))]
    thickness: Number,
    /// Id of the material
    material: String,
    /// Plane strain or plane stress
    plane: Plane,
    /// Plain, or with modes of bending of its own; plain if left out
    element: Option<QuadKind>,
}

/// One triangle of three nodes or six
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Triangle {
    /// Id
    id: String,
    /// Corners counter-clockwise, then, of six, the middles of the sides 1-2, 2-3, 3-1
    nodes: Vec<String>,
    /// Thickness
    #[schemars(extend("exclusiveMinimum" = 0))]
    thickness: Number,
    /// Id of the material
    material: String,
    /// Plane strain or plane stress
    plane: Plane,
}
