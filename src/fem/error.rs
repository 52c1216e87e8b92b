//! What can be wrong with a structure that only its equations show.

use std::fmt;

use crate::model::pair::JointDirection;
use crate::model::structure::{Component, Dimension};
use crate::model::vector::unit;

/// Why there is no main system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MainSystemError {
    /// Joints that repeat what supports, ties or other joints already hold: the main system would be singular.
    /// All of them, in the order of the joints.
    #[error("{}", list(.0))]
    DependentJoints(Vec<DependentJoint>),
    /// Rigid bodies that supports and ties hold more often than they can move. All of them.
    #[error("{}", list(.0))]
    OverConstrained(Vec<OverConstraint>),
    /// The structure moves freely although every joint is on.
    #[error(
        "the structure is a mechanism whatever its contacts do: {} {}; {}add a support, a tie, a bar or a spring that holds it",
        match .body {
            Some(body) => format!("{body} is free to move, its node {node_id}"),
            None => format!("node {node_id} is free to move"),
        },
        .direction,
        match .beside {
            Some(nodes) => format!(
                "its node {} lies on {}, which joins nothing by itself: a contact or a tie does; ",
                nodes[0], nodes[1]
            ),
            None => String::new(),
        }
    )]
    Mechanism {
        /// The node that moves most.
        node: usize,
        /// Its id.
        node_id: String,
        /// The plate, brick or mesh that it is a node of.
        body: Option<String>,
        /// How it moves.
        direction: FreeDirection,
        /// Ids of a node of that body and of one at the same place that nothing joins to it.
        beside: Option<Box<[String; 2]>>,
    },
    /// The structure stands, but on so small a share of the stiffness of its stiffest part that not even doubled
    /// precision can solve it.
    #[error(
        "the stiffnesses differ too much to be solved: {stiffest} is {contrast:.0e} times as stiff as {softest}; \
         make the stiff part rigid by supports or ties, or bring the two closer together"
    )]
    Contrast {
        /// A node of the stiffest element.
        node: usize,
        /// The stiffest element, in words.
        stiffest: String,
        /// The softest element, in words.
        softest: String,
        /// How many times as stiff.
        contrast: f64,
    },
    /// The same where no part is much stiffer than another: the shape or the number of the elements is to blame.
    #[error(
        "the structure resists some motion by so little that even doubled precision loses it beside the stiffness of {stiffest}, \
         though no part is much stiffer than another: elements are too long and thin, or too many in a row; use fewer ones, of \
         better shape"
    )]
    Slender {
        /// A node of the stiffest element.
        node: usize,
        /// The stiffest element, in words.
        stiffest: String,
    },
    /// Sides so short beside the whole that the digits do not tell whether they hold anything.
    #[error(
        "whether the structure stands cannot be told: the shortest side of its elements is {share:.0e} of the size of the whole, and \
         what it holds is lost in the digits of the numbers; use elements of better shape, or leave the short ones out"
    )]
    Lost {
        /// A node that moves.
        node: usize,
        /// Shortest side over the size of the structure.
        share: f64,
    },
    /// The factorization met NaN or infinity.
    #[error("the stiffness matrix is not finite: check the sizes, materials and stiffnesses of the model")]
    NotFinite,
    /// A moment on a node that has no rotation: no frame bar is rigidly attached to it.
    #[error(
        "load case {case} has a moment at node {node_id}, where no frame bar is rigidly attached: \
         remove the moment or a hinge"
    )]
    MomentWithoutRotation {
        /// Index of the load case.
        load_case: usize,
        /// Its name.
        case: String,
        /// The node.
        node: usize,
        /// Its id.
        node_id: String,
    },
    /// Supports that ties make one, of which some settle differently.
    #[error(
        "load case {case} moves the supports at {} and {}, which ties make one, by different amounts: \
         give both the same settlement, or remove one of the two supports", .nodes[0], .nodes[1]
    )]
    UnequalSettlements {
        /// Name of the load case.
        case: String,
        /// Ids of two nodes that are held.
        nodes: [String; 2],
    },
    /// An element that has no stiffness because of its shape.
    #[error("{name} cannot be used: {what}")]
    Element {
        /// The element, or the spring, in words.
        name: String,
        /// Ids of its nodes.
        nodes: Vec<String>,
        /// What is wrong.
        what: String,
    },
    /// The factor does not fit.
    #[error(
        "the model is too large: {unknowns} unknowns and {joints} joints need {} of memory, {} is available; \
         use fewer divisions", bytes(*.needed), bytes(*.available)
    )]
    TooLarge {
        /// Unknowns after supports, ties and joints.
        unknowns: usize,
        /// Joints.
        joints: usize,
        /// Bytes needed, at least.
        needed: u64,
        /// Bytes that are available.
        available: u64,
    },
    /// The K of a superelement has a negative eigenvalue.
    #[error(
        "{file}: the stiffness is not positive semidefinite: after scaling to unit diagonal it has an eigenvalue below \
         -1e-9, a motion that would release energy; check the signs of its entries and the order of rows and columns"
    )]
    Indefinite {
        /// The file of K.
        file: String,
    },
    /// Memory ran out although the estimate was within it.
    #[error("out of memory while {doing}: use fewer divisions or free some memory")]
    OutOfMemory {
        /// The step of the work.
        doing: &'static str,
    },
    /// An eigenvalue problem did not converge.
    #[error("the eigenvalues of the contact stiffness matrix did not converge: check units and stiffnesses")]
    NoConvergence,
    /// The watcher asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// A joint that others already hold.
#[derive(Clone, Debug, PartialEq)]
pub struct DependentJoint {
    /// Index of the pair, for the place in the file.
    pub pair: usize,
    /// Its id.
    pub pair_id: String,
    /// Which of its joints.
    pub direction: JointDirection,
    /// What holds it already.
    pub holders: Vec<Holder>,
}

/// A rigid body that others hold more often than it can move.
#[derive(Clone, Debug, PartialEq)]
pub struct OverConstraint {
    /// Index of the body.
    pub body: usize,
    /// Its id.
    pub id: String,
    /// What holds it; one of them too much.
    pub holders: Vec<Holder>,
}

/// Something that holds a displacement.
#[derive(Clone, Debug, PartialEq)]
pub enum Holder {
    /// A support.
    Support {
        /// Id of the node.
        node: String,
        /// Word of the component held.
        component: &'static str,
    },
    /// A tie.
    Tie {
        /// Ids of two of the tied nodes.
        nodes: [String; 2],
        /// Word of the component shared.
        component: &'static str,
    },
    /// A rigid body.
    Body {
        /// Its id.
        id: String,
    },
    /// A joint of another pair.
    Joint {
        /// Id of the pair.
        pair: String,
        /// Which of its joints.
        direction: JointDirection,
    },
}

/// How a node moves in a mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeDirection {
    dimension: Dimension,
    /// Displacement, or rotation where the node does not move.
    u: [f64; 6],
}

impl FreeDirection {
    /// From the displacement of the node that moves most.
    pub(super) fn of(dimension: Dimension, u: [f64; 6]) -> FreeDirection {
        FreeDirection { dimension, u }
    }
}

impl fmt::Display for FreeDirection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z, turn @ ..] = self.u;
        let turns = unit([x, y, z]).is_none();
        let components = if turns { self.dimension.rotations() } else { self.dimension.translations() };
        let d = unit(if turns { turn } else { [x, y, z] }).unwrap_or_default();
        let along = |c: &Component| d[c.axis()];
        let mut moving = components.iter().filter(|c| along(c).abs() >= 1e-6);
        match (moving.next(), moving.next()) {
            (Some(&only), None) if turns => write!(f, "by turning ({})", self.dimension.word(only)),
            (Some(&only), None) => write!(f, "in {}", self.dimension.word(only)),
            _ => {
                let d: Vec<String> = components.iter().map(|c| format!("{:.3}", along(c))).collect();
                write!(f, "{} ({})", if turns { "by turning about" } else { "along" }, d.join(", "))
            }
        }
    }
}

fn direction_word(direction: JointDirection) -> &'static str {
    match direction {
        JointDirection::Normal => "normal",
        JointDirection::Tangential(_) => "tangential",
    }
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Holder::Support { node, component } => {
                write!(f, "the support at {node} in {component}")
            }
            Holder::Tie { nodes, component } => {
                write!(f, "the tie of {} and {} in {}", nodes[0], nodes[1], component)
            }
            Holder::Body { id } => write!(f, "the rigid body {id}"),
            Holder::Joint { pair, direction } => {
                write!(f, "the {} joint of {pair}", direction_word(*direction))
            }
        }
    }
}

impl fmt::Display for DependentJoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the {} joint of {} is already held by {}",
            direction_word(self.direction),
            self.pair_id,
            all(&self.holders)
        )?;
        f.write_str(match self.direction {
            JointDirection::Normal => ": use `skip` or split the node",
            JointDirection::Tangential(_) => ": use `skip`, a `frictionless` pair, or split the node",
        })
    }
}

impl fmt::Display for OverConstraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the rigid body {} moves as one, and {} hold more displacements than it has: remove one of them, or hold fewer \
             displacements",
            self.id,
            all(&self.holders)
        )
    }
}

/// `a, b and c`.
fn all(holders: &[Holder]) -> String {
    let words: Vec<String> = holders.iter().map(Holder::to_string).collect();
    match &words[..] {
        [] => String::new(),
        [one] => one.clone(),
        [before @ .., last] => format!("{} and {last}", before.join(", ")),
    }
}

fn list(what: &[impl fmt::Display]) -> String {
    let lines: Vec<String> = what.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

/// Bytes in words, 1 GB = 10⁹ bytes.
fn bytes(count: u64) -> String {
    if count >= 1_000_000_000 {
        format!("{:.1} GB", count as f64 / 1e9)
    } else {
        format!("{:.0} MB", (count as f64 / 1e6).max(1.0))
    }
}
