//! One solved state in the words of the structure: pairs, forces, displacements and the check of all of it.
//! The field names are the keys of the JSON result (`stickslip-result/1`).

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

pub use super::attempt::{Attempt, AttemptRules};
pub use super::outcome::OutcomeKind;
pub use super::pair_record::{InSpace, PairState, State};
pub use super::ray_record::{Direction, PairDirection, Ray, RayClass, Slip, VariableRate, Verdict};
use crate::contact::polygon::Polygon;
use crate::fem::{Displacements, MainSystem, Piece};
use crate::model::structure::{Component, Dimension, Structure};
use crate::model::uses::Redone;
use crate::model::vector::length;

/// Joint of a pair that a pivot turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum TurnedJoint {
    /// Along n.
    Normal,
    /// Along t.
    Tangential,
}

/// Change of working scheme at a pivot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Turned {
    /// Pair id.
    pub pair: String,
    /// Which joint.
    pub joint: TurnedJoint,
    /// State word before.
    pub from: String,
    /// State word after.
    pub to: String,
}

/// One pivot as shown to the user.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PivotRecord {
    /// 0 is the entry of p.
    pub step: usize,
    /// Name of the entering variable: `p`, `z+[c6]`, `w[1]`.
    pub entering: String,
    /// Name of the leaving variable.
    pub leaving: String,
    /// p after the pivot, in the user's units.
    pub p: f64,
    /// All tied rows, the leaving one among them.
    pub ties: Vec<String>,
    /// What it did to the working scheme; `None` at the entry of p and for a bare LCP.
    pub turned: Option<Turned>,
    /// The pivot in a sentence.
    pub sentence: String,
}

/// Fresh check of an answer from R, RF, f and K: numbers without unit. A force or reserve is measured by the magnitudes
/// of the terms that it was summed from, a displacement by the share of the forces that depends on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Check {
    /// Smallest contact force or reserve; ≥ 0 but for rounding in an answer.
    pub min_w: f64,
    /// Smallest opening, z⁺ or z⁻; likewise.
    pub min_z: f64,
    /// The smaller of w_i and z_i of a couple, the largest of all couples; for a bare LCP, w where z > 0.
    pub complementarity: f64,
    /// Largest |K u − F − Bᵀλ| relative to the forces that meet at its node; `None` where there is no K.
    pub equilibrium: Option<f64>,
    /// What rounding hides of the forces, as a share of the loads; given where a check fails because of it.
    #[serde(skip)]
    pub hidden: f64,
    /// Whether only the joints were examined so far: displacements and the equilibrium of the structure are still to come.
    #[serde(skip)]
    pub joints_only: bool,
    /// Whether all are within bounds.
    pub passed: bool,
}

/// Displacement of a node in the units of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeDisplacement {
    /// Node id.
    pub node: String,
    /// Along x.
    pub ux: f64,
    /// Along y.
    pub uy: f64,
    /// Rotation about z in radians, in the plane the only one, counter-clockwise; 0 at nodes without one.
    pub rz: f64,
    /// u_z, r_x, r_y of a structure in space.
    pub space: Option<[f64; 3]>,
    /// The components that the node does not have, in the order of `all`: nothing turns at a node of plates.
    pub without: [bool; 6],
}

impl NodeDisplacement {
    /// Of all nodes of a structure, whose displacements these are by component.
    pub fn of_nodes(structure: &Structure, u: &[[f64; 6]]) -> Vec<NodeDisplacement> {
        let in_space = structure.dimension == Dimension::Space;
        let nodes = structure.nodes.iter().map(|node| node.id.clone()).zip(u);
        nodes
            .map(|(node, &[ux, uy, uz, rx, ry, rz])| NodeDisplacement {
                node,
                ux,
                uy,
                rz,
                space: in_space.then_some([uz, rx, ry]),
                without: [false; 6],
            })
            .collect()
    }

    /// Of the nodes of a main system: those that do not turn say so.
    pub fn of_state(main: &MainSystem, structure: &Structure, u: &Displacements) -> Vec<NodeDisplacement> {
        let mut nodes = NodeDisplacement::of_nodes(structure, &u.0);
        for (at, node) in nodes.iter_mut().enumerate() {
            node.without = Component::ALL.map(|component| !main.has(at, component));
        }
        nodes
    }

    /// The components by name, of the plane or of space; none where the node does not have it.
    pub fn named(&self) -> Vec<(&'static str, Option<f64>)> {
        let names = ["ux", "uy", "uz", "rx", "ry", "rz"];
        let of_plane = |component: usize| matches!(component, 0 | 1 | 5);
        let shown = (0..6).filter(|component| self.space.is_some() || of_plane(*component));
        shown.map(|component| (names[component], self.component(component))).collect()
    }

    /// A component in the order of `all`; none where the node does not have it.
    pub fn component(&self, component: usize) -> Option<f64> {
        (!self.without[component]).then(|| self.all()[component])
    }

    /// (u_x, u_y, u_z, r_x, r_y, r_z), lengths and radians.
    pub fn all(&self) -> [f64; 6] {
        let [uz, rx, ry] = self.space.unwrap_or_default();
        [self.ux, self.uy, uz, rx, ry, self.rz]
    }

    /// The length of its translation.
    pub fn length(&self) -> f64 {
        let [x, y, z, ..] = self.all();
        length([x, y, z])
    }
}

impl Serialize for NodeDisplacement {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        named(serializer, Some(("node", &self.node)), self.named())
    }
}

/// A map of one name and numbers.
fn named<S: Serializer>(
    serializer: S,
    name: Option<(&str, &str)>,
    numbers: Vec<(&str, impl Serialize)>,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(usize::from(name.is_some()) + numbers.len()))?;
    if let Some((key, name)) = name {
        map.serialize_entry(key, name)?;
    }
    numbers.into_iter().try_for_each(|(key, number)| map.serialize_entry(key, &number))?;
    map.end()
}

/// Internal forces at one end of an element in the user's units, bar axes: N > 0 tension, Q = dM/dx, M > 0 tension on the
/// −y side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndForces {
    /// Normal force.
    pub n: f64,
    /// Shear force Q, in space V_y.
    pub q: f64,
    /// Bending moment M, in space M_z.
    pub m: f64,
    /// V_z, M_y and T of a bar in space: M_y > 0 tension on the −z side, V_z = dM_y/dx, T along +x.
    pub space: Option<[f64; 3]>,
}

impl EndForces {
    /// Names and values as results show them.
    pub fn named(&self) -> Vec<(&'static str, f64)> {
        match self.space {
            None => vec![("N", self.n), ("Q", self.q), ("M", self.m)],
            Some([vz, my, t]) => {
                vec![("N", self.n), ("Vy", self.q), ("Vz", vz), ("T", t), ("My", my), ("Mz", self.m)]
            }
        }
    }
}

impl Serialize for EndForces {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        named(serializer, None, self.named())
    }
}

/// Internal forces of one element of a bar.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MemberForces {
    /// Bar id.
    pub bar: String,
    /// Element along the bar, from 0.
    pub element: usize,
    /// At its start.
    pub start: EndForces,
    /// At its end.
    pub end: EndForces,
    /// Exactly in between; ranges are distances from the start of the bar.
    #[serde(skip)]
    pub pieces: Vec<Piece>,
}

/// Force of the supports and springs of a node on the structure, their sum, in the user's units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reaction {
    /// Node id.
    pub node: String,
    /// Along x.
    pub fx: f64,
    /// Along y.
    pub fy: f64,
    /// Moment about z, in the plane the only one, counter-clockwise.
    pub m: f64,
    /// F_z, M_x, M_y of a structure in space.
    pub space: Option<[f64; 3]>,
}

impl Reaction {
    /// (F_x, F_y, F_z).
    pub fn force(&self) -> [f64; 3] {
        [self.fx, self.fy, self.space.map_or(0.0, |[fz, ..]| fz)]
    }

    /// (M_x, M_y, M_z).
    pub fn moment(&self) -> [f64; 3] {
        let [_, mx, my] = self.space.unwrap_or_default();
        [mx, my, self.m]
    }

    /// Names and values as results show them.
    pub fn named(&self) -> Vec<(&'static str, f64)> {
        match self.space {
            None => vec![("fx", self.fx), ("fy", self.fy), ("m", self.m)],
            Some(_) => {
                let values = self.force().into_iter().chain(self.moment());
                ["fx", "fy", "fz", "mx", "my", "mz"].into_iter().zip(values).collect()
            }
        }
    }
}

impl Serialize for Reaction {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        named(serializer, Some(("node", &self.node)), self.named())
    }
}

/// How large the problem is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Size {
    /// Nodal components before supports and ties; structures only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unknowns: Option<usize>,
    /// After supports and ties; structures only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<usize>,
    /// Contact pairs.
    pub pairs: usize,
    /// Rows of the LCP.
    pub lcp: usize,
}

/// Seconds spent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Timings {
    /// Ordering and factorization of the main system.
    pub factor: f64,
    /// R and RF.
    pub condense: f64,
    /// Lemke's algorithm.
    pub lemke: f64,
    /// All of it.
    pub total: f64,
}

/// The friction polygon behind a result in space, and how its answer came to Coulomb's cone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PolygonRecord {
    /// K.
    pub facets: usize,
    /// Angle of the first facet from t1 towards t2, degrees.
    pub turn: f64,
    /// Whether the answer is on the cone; otherwise it is the polygon's own.
    pub cone: bool,
    /// Steps of Newton's method from the polygon's answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub newton: Option<usize>,
    /// Largest change of a slip on the way, as a share of the largest slip.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
}

impl PolygonRecord {
    /// Of a polygon, whose answer is its own so far.
    pub fn of(polygon: Polygon) -> PolygonRecord {
        PolygonRecord {
            facets: polygon.facets(),
            turn: polygon.turn().to_degrees(),
            cone: false,
            newton: None,
            distance: None,
        }
    }
}

/// From where an answer was found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// From z = 0 by the pivots of the answer.
    #[default]
    Cold,
    /// From the last answer, followed along the change.
    Warm {
        /// Changes of the working scheme on the way.
        changes: usize,
    },
}

/// Everything about one solved state.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// How it ended.
    pub outcome: OutcomeKind,
    /// Normal, but p stopped below 1e-12 of the largest |q|.
    pub marginal: bool,
    /// Where the run ended in a ray.
    pub ray: Option<Ray>,
    /// p at the end, a force in the user's unit; 0 in an answer.
    pub p: f64,
    /// Rules of the last attempt.
    pub rules: AttemptRules,
    /// The polygon of the last attempt; in space only.
    pub polygon: Option<PolygonRecord>,
    /// All tries, in order.
    pub attempts: Vec<Attempt>,
    /// The pivots of the last attempt; only the first ones of a very long run.
    pub pivots: Vec<PivotRecord>,
    /// Number of all its pivots.
    pub pivot_count: usize,
    /// The pairs at the end (at the last vertex of a ray).
    pub pairs: Vec<PairState>,
    /// The fresh check.
    pub check: Check,
    /// Displacements of the nodes; `None` where there is no structure or no answer.
    pub displacements: Option<Vec<NodeDisplacement>>,
    /// Member end forces; likewise.
    pub members: Option<Vec<MemberForces>>,
    /// Reactions of supports and springs; likewise.
    pub reactions: Option<Vec<Reaction>>,
    /// z and w, bare LCP only.
    pub solution: Option<PlainSolution>,
    /// Sizes.
    pub size: Size,
    /// Times.
    pub timings: Timings,
    /// From where it was found.
    pub start: Start,
    /// What was computed anew for it.
    pub redone: Redone,
    /// Remarks for the user that are not errors (cohesion in an open pair, several answers …).
    pub notes: Vec<String>,
    /// Why there is no answer, where `outcome` is no ray and no answer.
    pub failure: Option<String>,
}

impl Answer {
    /// Whether this is an answer (trivial or normal, and checked).
    pub fn is_answer(&self) -> bool {
        self.outcome.is_answer()
    }

    /// The last pivot of which there is a record.
    pub fn last_recorded(&self) -> Option<usize> {
        self.pivots.len().checked_sub(1)
    }

    /// Number of pivots without a record.
    pub fn unrecorded(&self) -> usize {
        self.pivot_count.saturating_sub(self.pivots.len())
    }
}

/// z and w of a bare LCP.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlainSolution {
    /// z.
    pub z: Vec<f64>,
    /// w.
    pub w: Vec<f64>,
}
