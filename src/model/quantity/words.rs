//! The table of the words of the language of quantities. Everything that lists or names quantities comes from it:
//! `show`, `expect`, `find`, `envelope`, `sweep --columns`, the keys of `sort`, what `max` and `sum` take, completion
//! and help.
//!
//! To add a quantity of a pair, a node, a bar, a stress or an answer: a variant of its family here, its line in
//! [`WORDS`], and its reader in `path/quantity`, which the compiler asks for.

use super::of_bar::Internal;
use super::of_stress::OfStress;
use crate::model::structure::{self, Component};
use crate::model::units::Units;

use Dimension as D;
use Meaning as M;

/// The dimension of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A word or a plain number.
    None,
    /// Length.
    Length,
    /// Force.
    Force,
    /// Force × length: moments, energies.
    Moment,
    /// Force / length².
    Stress,
    /// That of the quantity among the arguments.
    Inner,
}

impl Dimension {
    /// Its label in the author's units.
    pub fn label(self, units: &Units) -> Option<String> {
        let (length, force) = (units.length.as_deref(), units.force.as_deref());
        match self {
            Dimension::None | Dimension::Inner => None,
            Dimension::Length => length.map(str::to_owned),
            Dimension::Force => force.map(str::to_owned),
            Dimension::Moment => Some(format!("{}·{}", force?, length?)),
            Dimension::Stress => Some(format!("{}/{}²", force?, length?)),
        }
    }
}

/// A number or word of an answer as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfAnswer {
    /// How the run ended.
    Outcome,
    /// Class of the ray.
    Class,
    /// What is proved of the ray.
    Verdict,
    /// The covering variable.
    P,
    /// Number of pivots.
    Pivots,
    /// Number of answers.
    Answers,
    /// Nodal components.
    Unknowns,
    /// Those without supports and ties.
    Free,
    /// Rows of the LCP.
    Lcp,
    /// Strain energy.
    Energy,
    /// Work lost in friction.
    Dissipated,
}

/// A number of a contact pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfPair {
    /// x_n, compression positive.
    NormalForce,
    /// x_t.
    FrictionForce,
    /// z_n.
    Opening,
    /// z_t.
    Slip,
    /// f x_n + c.
    Bound,
    /// Bound + x_t.
    ReservePlus,
    /// Bound − x_t.
    ReserveMinus,
    /// Bound − |x_t|.
    Reserve,
    /// A component of x_t in space: 0 along t1, 1 along t2.
    FrictionAlong(usize),
    /// The same of z_t.
    SlipAlong(usize),
}

impl OfPair {
    /// Whether pairs of the plane, or of space, have it.
    pub fn is_of(self, dimension: structure::Dimension) -> bool {
        match dimension {
            structure::Dimension::Plane => !matches!(self, OfPair::FrictionAlong(_) | OfPair::SlipAlong(_)),
            structure::Dimension::Space => !matches!(self, OfPair::ReservePlus | OfPair::ReserveMinus),
        }
    }
}

/// A displacement of a node, or a component of its reaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfNode {
    /// u_x.
    Ux,
    /// u_y.
    Uy,
    /// u_z.
    Uz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z, in the plane the only one.
    Rz,
    /// Reaction along x, on the structure.
    Fx,
    /// Along y.
    Fy,
    /// Along z.
    Fz,
    /// Its moment in the plane.
    M,
    /// Its moment about x.
    Mx,
    /// About y.
    My,
    /// About z.
    Mz,
}

impl OfNode {
    /// The component of a displacement; `None` for a reaction.
    pub fn displaced(self) -> Option<Component> {
        match self {
            OfNode::Ux => Some(Component::X),
            OfNode::Uy => Some(Component::Y),
            OfNode::Uz => Some(Component::Z),
            OfNode::Rx => Some(Component::Rx),
            OfNode::Ry => Some(Component::Ry),
            OfNode::Rz => Some(Component::Rz),
            _ => None,
        }
    }

    /// Whether it is one of the plane, or of space.
    pub fn is_of(self, dimension: structure::Dimension) -> bool {
        let only_space =
            matches!(self, OfNode::Uz | OfNode::Rx | OfNode::Ry | OfNode::Fz | OfNode::Mx | OfNode::My | OfNode::Mz);
        match dimension {
            structure::Dimension::Plane => !only_space,
            structure::Dimension::Space => self != OfNode::M,
        }
    }
}

impl Internal {
    /// `N`, `Q`, `Vy` ….
    pub fn symbol(self) -> &'static str {
        Meaning::Bar(self).word()
    }
}

/// How far a load can grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfLoad {
    /// Its limit.
    Limit,
    /// The limit over the present value.
    Safety,
}

/// Which number of several pairs, or along a bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// Σ.
    Sum,
    /// The largest.
    Max,
    /// The least.
    Min,
}

/// What a word means, and with it what must follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Nothing follows.
    Answer(OfAnswer),
    /// A pair.
    Pair(OfPair),
    /// A pair.
    State,
    /// What is summed or compared, and the pairs, the bar or the body.
    Over(Over),
    /// A state and pairs.
    Count,
    /// An edge contact and N, T or e.
    Resultant,
    /// A node.
    Node(OfNode),
    /// A bar, and a place on it.
    Bar(Internal),
    /// A node or an element.
    Stress(OfStress),
    /// A load case, or a parameter in which the loads are linear.
    Load(OfLoad),
    /// A friction parameter.
    Critical,
    /// A stage and another quantity.
    Stage,
}

impl Meaning {
    /// What follows the word, as help shows it.
    pub fn arguments(self) -> &'static str {
        match self {
            Meaning::Answer(_) => "",
            Meaning::Pair(_) | Meaning::State => "PAIR",
            Meaning::Node(_) => "NODE",
            Meaning::Bar(_) => "BAR [at DISTANCE | start | end]",
            Meaning::Stress(_) => "NODE or ELEMENT",
            Meaning::Resultant => "JOINT N|T|e",
            Meaning::Load(_) => "CASE",
            Meaning::Critical => "FRICTION",
            Meaning::Over(Over::Sum) => "QUANTITY [PATTERN]",
            Meaning::Over(_) => "QUANTITY [PATTERN | BODY]",
            Meaning::Count => "STATE [PATTERN]",
            Meaning::Stage => "S QUANTITY",
        }
    }

    /// Whether there is such a thing in the plane, or in space.
    pub fn is_of(self, dimension: structure::Dimension) -> bool {
        match self {
            Meaning::Pair(which) => which.is_of(dimension),
            Meaning::Node(which) => which.is_of(dimension),
            Meaning::Bar(which) => which.is_of(dimension),
            Meaning::Stress(which) => which.is_of(dimension),
            _ => true,
        }
    }

    /// Its line in the table; every meaning has one.
    pub fn entry(self) -> &'static Word {
        WORDS.iter().find(|entry| entry.meaning == self).unwrap_or(&WORDS[0])
    }

    /// As written.
    pub fn word(self) -> &'static str {
        self.entry().word
    }
}

/// A word of the language.
#[derive(Debug)]
pub struct Word {
    /// As written.
    pub word: &'static str,
    /// The other way in which it may be written: a shear stress has its letters in either order.
    pub also: Option<&'static str>,
    /// What it means.
    pub meaning: Meaning,
    /// Its dimension.
    pub dimension: Dimension,
    /// What it is, in a line.
    pub about: &'static str,
    /// The words that it may be; none where it is a number.
    pub choices: &'static [&'static str],
}

impl Word {
    /// The words that it may be in the plane, or in space; none where it is a number.
    pub fn choices_of(&self, dimension: structure::Dimension) -> Vec<&'static str> {
        match self.meaning {
            Meaning::State => states_of(dimension),
            _ => self.choices.to_vec(),
        }
    }
}

const fn number(word: &'static str, meaning: Meaning, dimension: Dimension, about: &'static str) -> Word {
    Word { word, also: None, meaning, dimension, about, choices: &[] }
}

const fn shear(word: &'static str, also: &'static str, which: OfStress, about: &'static str) -> Word {
    Word { also: Some(also), ..number(word, Meaning::Stress(which), Dimension::Stress, about) }
}

const fn chosen(word: &'static str, meaning: Meaning, choices: &'static [&'static str], about: &'static str) -> Word {
    Word { word, also: None, meaning, dimension: Dimension::None, about, choices }
}

/// The states of pairs.
const STATES: &[&str] = &["open", "stick", "slip+", "slip-", "slip", "closed"];

/// Those of pairs in the plane, which slip along +t or −t, or in space.
pub fn states_of(dimension: structure::Dimension) -> Vec<&'static str> {
    let elsewhere: &[&str] = match dimension {
        structure::Dimension::Plane => &["slip"],
        structure::Dimension::Space => &["slip+", "slip-"],
    };
    STATES.iter().copied().filter(|state| !elsewhere.contains(state)).collect()
}

/// How a run can end; `answer` stands for trivial and normal.
const OUTCOMES: &[&str] = &["trivial", "normal", "answer", "ray", "pivot-limit", "breakdown", "check-failed"];
/// Classes of rays.
const CLASSES: &[&str] = &["mechanism", "artefact", "fault", "no-equilibrium"];
/// What is proved of a ray.
const VERDICTS: &[&str] = &["certified", "proved", "undecided"];

/// Every word of the language.
pub static WORDS: &[Word] = &[
    chosen(
        "outcome",
        M::Answer(OfAnswer::Outcome),
        OUTCOMES,
        "how the run ended; `answer` holds for trivial and normal",
    ),
    chosen("class", M::Answer(OfAnswer::Class), CLASSES, "class of the ray"),
    chosen("verdict", M::Answer(OfAnswer::Verdict), VERDICTS, "what is proved of the ray"),
    number("p", M::Answer(OfAnswer::P), D::None, "p at the end, or at the pivot shown"),
    number("pivots", M::Answer(OfAnswer::Pivots), D::None, "number of pivots"),
    number("answers", M::Answer(OfAnswer::Answers), D::None, "number of answers, all of them enumerated"),
    number("unknowns", M::Answer(OfAnswer::Unknowns), D::None, "nodal components"),
    number("free", M::Answer(OfAnswer::Free), D::None, "nodal components without supports and ties"),
    number("lcp", M::Answer(OfAnswer::Lcp), D::None, "rows of the LCP"),
    number("energy", M::Answer(OfAnswer::Energy), D::Moment, "strain energy"),
    number(
        "dissipated",
        M::Answer(OfAnswer::Dissipated),
        D::Moment,
        "work lost in friction; in a stage, of that stage",
    ),
    number("x_n", M::Pair(OfPair::NormalForce), D::Force, "compressive force"),
    number("x_t", M::Pair(OfPair::FrictionForce), D::Force, "friction force (in space its magnitude)"),
    number("z_n", M::Pair(OfPair::Opening), D::Length, "distance open"),
    number("z_t", M::Pair(OfPair::Slip), D::Length, "slip (in space its magnitude)"),
    number("bound", M::Pair(OfPair::Bound), D::Force, "friction bound"),
    number("reserve_plus", M::Pair(OfPair::ReservePlus), D::Force, "bound + x_t"),
    number("reserve_minus", M::Pair(OfPair::ReserveMinus), D::Force, "bound − x_t"),
    number("reserve", M::Pair(OfPair::Reserve), D::Force, "bound − |x_t|"),
    number("x_t1", M::Pair(OfPair::FrictionAlong(0)), D::Force, "in space: friction force along t1"),
    number("x_t2", M::Pair(OfPair::FrictionAlong(1)), D::Force, "in space: friction force along t2"),
    number("z_t1", M::Pair(OfPair::SlipAlong(0)), D::Length, "in space: slip along t1"),
    number("z_t2", M::Pair(OfPair::SlipAlong(1)), D::Length, "in space: slip along t2"),
    chosen("state", M::State, STATES, "open, stick, slip+, slip- (in space: slip) or closed"),
    number("sum", M::Over(Over::Sum), D::Inner, "sum over pairs: sum x_n joint[*]"),
    number(
        "max",
        M::Over(Over::Max),
        D::Inner,
        "largest over pairs, along a bar, of a stress over the nodes, or |u|: max M AB, max mises dam, max u",
    ),
    number(
        "min",
        M::Over(Over::Min),
        D::Inner,
        "least over pairs, along a bar, or of a stress over the nodes: min s2 dam",
    ),
    number("count", M::Count, D::None, "number of pairs in a state: count open joint[*]"),
    number("resultant", M::Resultant, D::Inner, "of an edge contact: N, T, or the eccentricity e of N"),
    number("ux", M::Node(OfNode::Ux), D::Length, "displacement along x"),
    number("uy", M::Node(OfNode::Uy), D::Length, "displacement along y"),
    number("uz", M::Node(OfNode::Uz), D::Length, "displacement along z, in space"),
    number("rx", M::Node(OfNode::Rx), D::None, "rotation about x, in space"),
    number("ry", M::Node(OfNode::Ry), D::None, "rotation about y, in space"),
    number("rz", M::Node(OfNode::Rz), D::None, "rotation, in space about z"),
    number(
        "N",
        M::Bar(Internal::Axial),
        D::Force,
        "normal force of a bar; without a place the one of largest magnitude",
    ),
    number("Q", M::Bar(Internal::Shear), D::Force, "shear force of a bar; likewise"),
    number("M", M::Bar(Internal::Moment), D::Moment, "bending moment of a bar; likewise"),
    number("Vy", M::Bar(Internal::ShearY), D::Force, "shear force along y of a bar in space; likewise"),
    number("Vz", M::Bar(Internal::ShearZ), D::Force, "shear force along z of a bar in space; likewise"),
    number("T", M::Bar(Internal::Torsion), D::Moment, "torque of a bar in space; likewise"),
    number("My", M::Bar(Internal::MomentY), D::Moment, "bending moment about y of a bar in space; likewise"),
    number("Mz", M::Bar(Internal::MomentZ), D::Moment, "bending moment about z of a bar in space; likewise"),
    number("fx", M::Node(OfNode::Fx), D::Force, "reaction along x"),
    number("fy", M::Node(OfNode::Fy), D::Force, "reaction along y"),
    number("fz", M::Node(OfNode::Fz), D::Force, "reaction along z, in space"),
    number("m", M::Node(OfNode::M), D::Moment, "moment of the reaction"),
    number("mx", M::Node(OfNode::Mx), D::Moment, "moment of the reaction about x, in space"),
    number("my", M::Node(OfNode::My), D::Moment, "moment of the reaction about y, in space"),
    number("mz", M::Node(OfNode::Mz), D::Moment, "moment of the reaction about z, in space"),
    number("sx", M::Stress(OfStress::X), D::Stress, "stress along x"),
    number("sy", M::Stress(OfStress::Y), D::Stress, "stress along y"),
    number("sz", M::Stress(OfStress::Z), D::Stress, "stress along z, in space"),
    shear("sxy", "syx", OfStress::Xy, "shear stress (also syx)"),
    shear("syz", "szy", OfStress::Yz, "shear stress, in space (also szy)"),
    shear("sxz", "szx", OfStress::Xz, "shear stress, in space (also szx)"),
    number("s1", M::Stress(OfStress::First), D::Stress, "largest principal stress (in the plane of the two there)"),
    number("s2", M::Stress(OfStress::Second), D::Stress, "second principal stress"),
    number("s3", M::Stress(OfStress::Third), D::Stress, "third principal stress, in space"),
    number("mises", M::Stress(OfStress::Mises), D::Stress, "equivalent stress of von Mises"),
    number("limit", M::Load(OfLoad::Limit), D::None, "limit of a load"),
    number("safety", M::Load(OfLoad::Safety), D::None, "limit of a load over its present value"),
    number("critical", M::Critical, D::None, "friction above which several answers are possible"),
    number("stage", M::Stage, D::Inner, "a quantity at the end of a stage: stage 2 x_n c1"),
];

/// The words that mean something in the plane, or in space.
pub fn words_of(dimension: structure::Dimension) -> impl Iterator<Item = &'static Word> {
    WORDS.iter().filter(move |entry| entry.meaning.is_of(dimension))
}

/// The table entry of a word.
pub fn entry(word: &str) -> Option<&'static Word> {
    WORDS.iter().find(|known| known.word == word || known.also == Some(word))
}

/// The words for the numbers of a pair in the plane, or in space.
pub fn pair_words(dimension: structure::Dimension) -> impl Iterator<Item = (&'static str, OfPair)> {
    words_of(dimension).filter_map(|entry| match entry.meaning {
        Meaning::Pair(which) => Some((entry.word, which)),
        _ => None,
    })
}

/// The words for the displacements of a node in the plane, or in space.
pub fn displacement_words(dimension: structure::Dimension) -> impl Iterator<Item = (&'static str, OfNode)> {
    words_of(dimension).filter_map(|entry| match entry.meaning {
        Meaning::Node(which) if which.displaced().is_some() => Some((entry.word, which)),
        _ => None,
    })
}
