//! Schema of `loads`.

use schemars::JsonSchema;

use super::Number;

/// Loads that grow together
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct LoadCase {
    /// 1 if left out
    factor: Option<Number>,
    /// The loads
    items: Vec<Load>,
}

/// One load
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Load {
    /// At a node or at a place of a bar; on an edge the total
    Point(PointLoad),
    /// Along an edge
    Traction(Traction),
    /// Along a bar
    Line(LineLoad),
    /// On elements with a density
    Gravity(Gravity),
    /// Change of temperature
    Temperature(Temperature),
    /// Lack of fit or prestress of bars
    Strain(Strain),
    /// Into the body, along an edge
    Pressure(Pressure),
    /// Pressure of a fluid at rest on an edge
    Fluid(Fluid),
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{ "required": ["at", "force"] }, { "required": ["bar", "distance"] }]))]
struct PointLoad {
    /// Node or edge
    at: Option<String>,
    /// Bar
    bar: Option<String>,
    /// From the start of the bar
    distance: Option<Number>,
    /// Force [Fx, Fy]
    force: Option<[Number; 2]>,
    /// Counter-clockwise
    moment: Option<Number>,
}

/// The same everywhere, or at the first and at the last place
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Vectors {
    /// The same everywhere
    Constant([Number; 2]),
    /// At the first and at the last place
    Linear([[Number; 2]; 2]),
}

/// The same everywhere, or at the first and at the last place
#[derive(JsonSchema)]
#[schemars(untagged)]
enum Values {
    /// The same everywhere
    Constant(Number),
    /// At the first and at the last place
    Linear([Number; 2]),
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Traction {
    /// Edge
    edge: String,
    /// Force per unit length of edge
    value: Vectors,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct LineLoad {
    /// Bar
    bar: String,
    /// Force per unit length
    value: Vectors,
    /// Distances from the start of the bar between which it acts; all of it if left out
    range: Option<[Number; 2]>,
    /// `global` if left out
    axes: Option<Axes>,
}

/// Axes of a line load; projected: per vertical length for x, per horizontal length for y
#[derive(JsonSchema)]
#[schemars(rename_all = "lowercase")]
enum Axes {
    Global,
    Local,
    Projected,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Gravity {
    /// Acceleration [gx, gy]
    acceleration: [Number; 2],
    /// Ids of the elements; all if left out
    on: Option<Vec<String>>,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[schemars(extend("anyOf" = [{ "required": ["change"] }, { "required": ["gradient"] }]))]
struct Temperature {
    /// Degrees
    change: Option<Number>,
    /// How much warmer the +y side of frame bars is than the other, across the depth of their section
    gradient: Option<Number>,
    /// Ids of the elements
    on: Vec<String>,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Strain {
    /// Ids of the bars
    on: Vec<String>,
    /// Free strain ε₀: N = EA (ε − ε₀)
    value: Number,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Pressure {
    /// Edge
    edge: String,
    /// Force per area, into the body
    value: Values,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
struct Fluid {
    /// Edge
    edge: String,
    /// Height of the surface
    level: Number,
    /// Weight per volume
    weight: Number,
}
