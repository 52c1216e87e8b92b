//! What can be asked of an answer: one language for `expect`, `show`, probes, sweeps, paths and envelopes.
//!
//! A quantity is a word and its arguments. [`words`] has the table of the words, [`read`](mod@read) reads them against
//! the names of a scenario; the values are read by [`crate::path::quantity`].

mod bend;
mod list;
mod names;
mod of_bar;
mod of_stress;
mod read;
mod words;

use std::fmt;

use super::units::Units;

pub use bend::Bend;
pub use list::{read_all, read_text};
pub use names::{Names, fits};
pub use of_bar::Internal;
pub use of_stress::OfStress;
pub use read::{QuantityError, read};
pub use words::{
    Dimension, Meaning, OfAnswer, OfLoad, OfNode, OfPair, Over, WORDS, Word, displacement_words, entry, pair_words,
    states_of, words_of,
};

/// Where on a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BarPlace {
    /// At a distance from its start.
    At(f64),
    /// At its start.
    Start,
    /// At its end.
    End,
    /// The signed value of largest magnitude.
    Extreme,
    /// The largest or least value along it.
    Over(Over),
}

/// Part of the resultant of an edge contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResultantPart {
    /// Σ x_n.
    Normal,
    /// Σ x_t.
    Tangential,
    /// Σ x_n s / Σ x_n from the middle, > 0 towards later nodes.
    Eccentricity,
}

impl ResultantPart {
    /// As written.
    pub const WORDS: [(&'static str, ResultantPart); 3] =
        [("N", ResultantPart::Normal), ("T", ResultantPart::Tangential), ("e", ResultantPart::Eccentricity)];

    fn word(self) -> &'static str {
        ResultantPart::WORDS[self as usize].0
    }
}

/// Something that can be asked of an answer. Names are those of the scenario it was read with.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// Of the answer as a whole.
    Answer(OfAnswer),
    /// A number of a pair.
    Pair(OfPair, String),
    /// The state of a pair.
    State(String),
    /// Of all pairs that fit a pattern.
    Pairs(Over, OfPair, String),
    /// How many pairs of a pattern are in a state.
    Count(&'static str, String),
    /// Of an edge contact.
    Resultant(String, ResultantPart),
    /// A displacement of a node, or a component of its reaction.
    Node(OfNode, String),
    /// The largest |u|.
    LargestDisplacement,
    /// `N`, `Q` or `M` of a bar.
    Bar(Internal, String, BarPlace),
    /// A stress at a node.
    NodeStress(OfStress, String),
    /// A stress in an element.
    ElementStress(OfStress, String),
    /// The largest or least of a stress over the nodes of areas and solids: of all of them, or of a body.
    Stresses(Over, OfStress, Option<String>),
    /// Limit or safety of a load.
    Load(OfLoad, String),
    /// Critical friction.
    Critical(String),
    /// At the end of a stage, from 1.
    Stage(usize, Box<Quantity>),
    /// A probe of the scenario: its name and what it stands for.
    Probe(String, Box<Quantity>),
}

impl Quantity {
    /// Its unit in the author's labels.
    pub fn unit(&self, units: &Units) -> Option<String> {
        self.dimension().label(units)
    }

    /// The quantity itself: of a stage or a probe the one inside.
    fn innermost(&self) -> &Quantity {
        match self {
            Quantity::Stage(_, inner) | Quantity::Probe(_, inner) => inner.innermost(),
            quantity => quantity,
        }
    }

    /// The meaning of its word; of several pairs, the meaning of the word that each of them is asked for.
    fn meaning(&self) -> Meaning {
        match self.innermost() {
            Quantity::Answer(which) => Meaning::Answer(*which),
            Quantity::Pair(which, _) | Quantity::Pairs(_, which, _) => Meaning::Pair(*which),
            Quantity::State(_) => Meaning::State,
            Quantity::Count(..) => Meaning::Count,
            Quantity::Resultant(..) => Meaning::Resultant,
            Quantity::Node(which, _) => Meaning::Node(*which),
            Quantity::LargestDisplacement => Meaning::Node(OfNode::Ux),
            Quantity::Bar(which, ..) => Meaning::Bar(*which),
            Quantity::NodeStress(which, _) | Quantity::ElementStress(which, _) | Quantity::Stresses(_, which, _) => {
                Meaning::Stress(*which)
            }
            Quantity::Load(which, _) => Meaning::Load(*which),
            Quantity::Critical(_) => Meaning::Critical,
            Quantity::Stage(..) | Quantity::Probe(..) => Meaning::Stage,
        }
    }

    /// The pattern of the pairs that it asks for.
    pub fn pattern(&self) -> Option<&str> {
        match self.innermost() {
            Quantity::Pairs(_, _, pattern) | Quantity::Count(_, pattern) => Some(pattern),
            _ => None,
        }
    }

    /// Its dimension.
    pub fn dimension(&self) -> Dimension {
        match self.innermost() {
            Quantity::Resultant(_, ResultantPart::Eccentricity) => Dimension::Length,
            Quantity::Resultant(..) => Dimension::Force,
            quantity => quantity.meaning().entry().dimension,
        }
    }

    /// The words that it may be; none where its value is a number.
    pub fn choices(&self) -> &'static [&'static str] {
        self.meaning().entry().choices
    }

    /// The word of the table.
    pub fn word(&self) -> &'static str {
        self.meaning().word()
    }

    /// Whether its value is a word, not a number.
    pub fn is_word(&self) -> bool {
        !self.choices().is_empty()
    }

    /// Whether it can be read from one state of the pairs and the structure, without a run or a path of its own.
    pub fn is_of_state(&self) -> bool {
        match self {
            Quantity::Answer(which) => *which == OfAnswer::Energy,
            Quantity::Load(..) | Quantity::Critical(_) | Quantity::Stage(..) => false,
            Quantity::Probe(_, inner) => inner.is_of_state(),
            _ => true,
        }
    }

    /// Whether the load history is to be followed for it: a quantity of a stage, and the work lost on the way.
    pub fn is_of_history(&self) -> bool {
        match self {
            Quantity::Stage(..) | Quantity::Answer(OfAnswer::Dissipated) => true,
            Quantity::Probe(_, inner) => inner.is_of_history(),
            _ => false,
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let over = |over: &Over| Meaning::Over(*over).word();
        let word = self.word();
        match self {
            Quantity::Answer(_) => write!(f, "{word}"),
            Quantity::Pair(_, name)
            | Quantity::State(name)
            | Quantity::Node(_, name)
            | Quantity::NodeStress(_, name)
            | Quantity::ElementStress(_, name)
            | Quantity::Load(_, name)
            | Quantity::Critical(name) => write!(f, "{word} {name}"),
            Quantity::Pairs(how, _, pattern) => write!(f, "{} {word} {pattern}", over(how)),
            Quantity::Stresses(how, _, body) => {
                write!(f, "{} {word}", over(how))?;
                body.as_ref().map_or(Ok(()), |body| write!(f, " {body}"))
            }
            Quantity::Count(state, pattern) => write!(f, "{word} {state} {pattern}"),
            Quantity::Resultant(joint, part) => write!(f, "{word} {joint} {}", part.word()),
            Quantity::LargestDisplacement => write!(f, "max u"),
            Quantity::Bar(_, bar, place) => match place {
                BarPlace::At(distance) => write!(f, "{word} {bar} at {distance}"),
                BarPlace::Start => write!(f, "{word} {bar} start"),
                BarPlace::End => write!(f, "{word} {bar} end"),
                BarPlace::Extreme => write!(f, "{word} {bar}"),
                BarPlace::Over(how) => write!(f, "{} {word} {bar}", over(how)),
            },
            Quantity::Stage(stage, inner) => write!(f, "stage {stage} {inner}"),
            Quantity::Probe(name, _) => write!(f, "{name}"),
        }
    }
}
