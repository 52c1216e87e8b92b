//! Contact pairs: the two nodes that may touch, their normal and tangent, their law.

use serde::Serialize;

use super::dimension::Dimension;
use super::parameter::Number;

/// A law without its numbers: the word that files and results have for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LawKind {
    /// Unilateral, with friction.
    Coulomb,
    /// Unilateral, without friction.
    Frictionless,
    /// Bilateral, with a known friction bound.
    Bound,
}

impl LawKind {
    /// The words.
    pub const WORDS: [(&'static str, LawKind); 3] =
        [("coulomb", LawKind::Coulomb), ("frictionless", LawKind::Frictionless), ("bound", LawKind::Bound)];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            LawKind::Coulomb => "coulomb",
            LawKind::Frictionless => "frictionless",
            LawKind::Bound => "bound",
        }
    }

    /// Whether the normal joint holds both ways: it never opens.
    pub fn is_bilateral(self) -> bool {
        self == LawKind::Bound
    }

    /// Whether the main system has a joint along t.
    pub fn has_tangential_joint(self) -> bool {
        self != LawKind::Frictionless
    }
}

/// Law of contact of one pair, with its numbers (each may be a parameter).
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Unilateral contact with Coulomb friction, bound r_f = f x_n + c.
    Coulomb {
        /// Friction coefficient f ≥ 0.
        friction: Number,
        /// Cohesion c ≥ 0.
        cohesion: Number,
        /// Initial gap g; negative: an interference.
        gap: Number,
    },
    /// Unilateral contact without friction: x_τ = 0.
    Frictionless {
        /// Initial gap g; negative: an interference.
        gap: Number,
    },
    /// Bilateral along n, with a known friction bound along t.
    Bound {
        /// Friction bound r_f ≥ 0.
        bound: Number,
    },
    /// Bilateral along n, free along t: what a known bound that is 0 and stays 0 comes to (see [`with_rollers`]). Files call
    /// it by the bound.
    Roller,
}

/// The bound of a roller.
static NO_BOUND: Number = Number::Value(0.0);

impl Law {
    /// The law without its numbers.
    pub fn kind(&self) -> LawKind {
        match self {
            Law::Coulomb { .. } => LawKind::Coulomb,
            Law::Frictionless { .. } => LawKind::Frictionless,
            Law::Bound { .. } | Law::Roller => LawKind::Bound,
        }
    }

    /// Whether the normal joint holds both ways: it never opens.
    pub fn is_bilateral(&self) -> bool {
        self.kind().is_bilateral()
    }

    /// Whether the main system has a joint along t.
    pub fn has_tangential_joint(&self) -> bool {
        self.kind().has_tangential_joint() && *self != Law::Roller
    }

    /// f, where the friction bound depends on x_n.
    pub fn friction(&self) -> Option<&Number> {
        match self {
            Law::Coulomb { friction, .. } => Some(friction),
            Law::Frictionless { .. } | Law::Bound { .. } | Law::Roller => None,
        }
    }

    /// g, where the pair can open.
    pub fn gap(&self) -> Option<&Number> {
        match self {
            Law::Coulomb { gap, .. } | Law::Frictionless { gap } => Some(gap),
            Law::Bound { .. } | Law::Roller => None,
        }
    }

    /// Its numbers with their keys in files; all but the gap are ≥ 0.
    pub fn numbers(&self) -> Vec<(&'static str, &Number)> {
        match self {
            Law::Coulomb { friction, cohesion, gap } => {
                vec![("friction", friction), ("cohesion", cohesion), ("gap", gap)]
            }
            Law::Frictionless { gap } => vec![("gap", gap)],
            Law::Bound { bound } => vec![("bound", bound)],
            Law::Roller => vec![("bound", &NO_BOUND)],
        }
    }
}

/// Nodes with their weights in a mutual displacement.
pub type Weights = Vec<(usize, f64)>;

/// A contact pair of a structure.
///
/// With the mutual displacement z = Σ weight·u of its nodes: z_n = n·z > 0 when the two sides part, z_τ = t·z.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// `c1`, `joint[0]`.
    pub id: String,
    /// Index of the second side's node.
    pub node: usize,
    /// Nodes of the second side and what each counts in the place of the pair: `node` alone, but at the end of an edge
    /// that lies between two nodes of the other.
    pub place: Weights,
    /// The nodes that move against each other, `node` first, with their weights: 1 on the second side and −1 on the
    /// first, in sum where several nodes of an edge stand for a side; nothing on the first side for the ground (u = 0).
    pub weights: Weights,
    /// Unit normal n, from `against` to `node`.
    pub normal: [f64; 3],
    /// Unit tangents: t in the plane, t1 and t2 in space (see
    /// [`Dimension::tangents`](super::dimension::Dimension::tangents)).
    pub tangents: Vec<[f64; 3]>,
    /// Whether friction acts against the firm ground although the first side is a node: the ground of a foundation
    /// yields along n only, z_τ = t·u_node.
    pub slides_on_ground: bool,
    /// The law.
    pub law: Law,
}

impl Pair {
    /// Of a node with another one, or with the ground, with the tangents of its normal.
    pub fn at_node(
        id: String,
        node: usize,
        against: Option<usize>,
        normal: [f64; 3],
        dimension: Dimension,
        law: Law,
    ) -> Pair {
        let tangents = dimension.tangents(normal);
        let weights = Pair::of_nodes(node, against);
        Pair { id, node, place: vec![(node, 1.0)], weights, normal, tangents, slides_on_ground: false, law }
    }

    /// The id of the contact that it comes from: `joint` of `joint[0]`.
    pub fn contact(&self) -> &str {
        self.id.split('[').next().unwrap_or(&self.id)
    }

    /// A quantity of nodes at the place of the pair.
    pub fn at_place<const N: usize>(&self, of_node: impl Fn(usize) -> [f64; N]) -> [f64; N] {
        if let [(node, 1.0)] = self.place[..] {
            return of_node(node);
        }
        let terms = self.place.iter().map(|&(node, weight)| of_node(node).map(|value| weight * value));
        terms.fold([0.0; N], |sum, term| std::array::from_fn(|c| sum[c] + term[c]))
    }

    /// The node that stands for the first side; none on the ground.
    pub fn against(&self) -> Option<usize> {
        let least = self.weights.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        least.filter(|(_, weight)| *weight < 0.0).map(|(node, _)| *node)
    }

    /// The weights of a node against another one, or against the ground.
    pub fn of_nodes(node: usize, against: Option<usize>) -> Weights {
        [Some((node, 1.0)), against.map(|against| (against, -1.0))].into_iter().flatten().collect()
    }

    /// Whether one node stands on each side, or one on the firm ground.
    pub fn is_of_nodes(&self) -> bool {
        !self.slides_on_ground && matches!(self.weights[..], [(_, 1.0)] | [(_, 1.0), (_, -1.0)])
    }

    /// Whether the ground is on its first side.
    pub fn is_on_ground(&self) -> bool {
        self.weights.iter().all(|(_, weight)| *weight >= 0.0)
    }

    /// A vector of the plane of contact, from its components along the tangents.
    pub fn along_tangents(&self, components: &[f64]) -> [f64; 3] {
        let parts = components.iter().zip(&self.tangents);
        parts.fold([0.0; 3], |sum, (size, t)| std::array::from_fn(|c| sum[c] + size * t[c]))
    }

    /// The weights of the motion along its tangents.
    pub fn tangential_weights(&self) -> &[(usize, f64)] {
        if self.slides_on_ground { &self.weights[..1] } else { &self.weights }
    }
}

/// The pairs with a roller for each whose bound is 0 in the file, so that no setting can change it; `None` without such.
///
/// As a joint it would be held in the main system, to be let go in every answer: forces of what holds it would come into R
/// that the structure does not have, and take digits from those that it has.
pub fn with_rollers(pairs: &[Pair]) -> Option<Vec<Pair>> {
    let rolls = |pair: &Pair| matches!(pair.law, Law::Bound { bound: Number::Value(0.0) });
    let of = |pair: &Pair| Pair { law: if rolls(pair) { Law::Roller } else { pair.law.clone() }, ..pair.clone() };
    pairs.iter().any(rolls).then(|| pairs.iter().map(of).collect())
}

/// Direction of a joint of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointDirection {
    /// Along n.
    Normal,
    /// Along one of the tangents: 0 is t or t1, 1 is t2.
    Tangential(usize),
}

/// One joint and its row of B: z = Σ a·u over its `terms`.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Index of the pair.
    pub pair: usize,
    /// Along n or along a tangent.
    pub direction: JointDirection,
    /// (node, a), that of the pair's own node first: one term for a pair with the ground, two between nodes, more
    /// where edges meet that do not match.
    pub terms: Vec<(usize, [f64; 3])>,
}

/// The joints of the main system: all normals in the order of the pairs, then, pair by pair, one along each tangent of
/// those that have such joints (all but the frictionless ones). This is the order of the rows of R and RF.
pub fn joints(pairs: &[Pair]) -> Vec<Joint> {
    let row = |weights: &[(usize, f64)], a: [f64; 3]| {
        weights.iter().map(|&(node, weight)| (node, a.map(|a| weight * a))).collect()
    };
    let normals = pairs.iter().enumerate().map(|(index, pair)| Joint {
        pair: index,
        direction: JointDirection::Normal,
        terms: row(&pair.weights, pair.normal),
    });
    let rubbing = pairs.iter().enumerate().filter(|(_, pair)| pair.law.has_tangential_joint());
    let tangentials = rubbing.flat_map(|(index, pair)| {
        pair.tangents.iter().enumerate().map(move |(tangent, &a)| Joint {
            pair: index,
            direction: JointDirection::Tangential(tangent),
            terms: row(pair.tangential_weights(), a),
        })
    });
    normals.chain(tangentials).collect()
}
