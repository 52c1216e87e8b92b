//! What can be asked of an answer: one language for `expect`, `show`, probes, sweeps, paths and envelopes.
//!
//! A quantity is a word and its arguments. [`WORDS`] is the table of the words; help and completion are made from it.
//! This module reads the words against the names of a scenario; the values are read by [`crate::path::quantity`].

use std::collections::HashSet;
use std::fmt;

use super::scenario::{Scenario, Source, Units};
use super::structure::Structure;
use super::words::{did_you_mean, nearest};

/// What may follow a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arguments {
    /// Nothing.
    None,
    /// A pair.
    Pair,
    /// A node.
    Node,
    /// A bar, and a place on it.
    Bar,
    /// A node or an element.
    NodeOrElement,
    /// An edge contact and N, T or e.
    Joint,
    /// A load case.
    Case,
    /// A parameter.
    Parameter,
    /// What is summed or compared, and the pairs, bar or nodes.
    Over,
    /// A state and pairs.
    Count,
    /// A stage and another quantity.
    Stage,
}

impl Arguments {
    /// As help shows them.
    pub fn usage(self) -> &'static str {
        match self {
            Arguments::None => "",
            Arguments::Pair => "PAIR",
            Arguments::Node => "NODE",
            Arguments::Bar => "BAR [at DISTANCE | start | end]",
            Arguments::NodeOrElement => "NODE or ELEMENT",
            Arguments::Joint => "JOINT N|T|e",
            Arguments::Case => "CASE",
            Arguments::Parameter => "FRICTION",
            Arguments::Over => "QUANTITY [PATTERN]",
            Arguments::Count => "STATE [PATTERN]",
            Arguments::Stage => "S QUANTITY",
        }
    }
}

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

/// A word of the language.
#[derive(Debug)]
pub struct Word {
    /// As written.
    pub word: &'static str,
    /// What follows it.
    pub arguments: Arguments,
    /// Its dimension.
    pub dimension: Dimension,
    /// What it is.
    pub about: &'static str,
}

const fn word(word: &'static str, arguments: Arguments, dimension: Dimension, about: &'static str) -> Word {
    Word { word, arguments, dimension, about }
}

/// Every word of the language.
pub const WORDS: &[Word] = &[
    word("outcome", Arguments::None, Dimension::None, "how the run ended; `answer` holds for trivial and normal"),
    word("class", Arguments::None, Dimension::None, "class of the ray"),
    word("verdict", Arguments::None, Dimension::None, "what is proved of the ray"),
    word("p", Arguments::None, Dimension::None, "p at the end, or at the pivot shown"),
    word("pivots", Arguments::None, Dimension::None, "number of pivots"),
    word("answers", Arguments::None, Dimension::None, "number of answers, all of them enumerated"),
    word("unknowns", Arguments::None, Dimension::None, "nodal components"),
    word("free", Arguments::None, Dimension::None, "nodal components without supports and ties"),
    word("lcp", Arguments::None, Dimension::None, "rows of the LCP"),
    word("energy", Arguments::None, Dimension::Moment, "strain energy"),
    word("dissipated", Arguments::None, Dimension::Moment, "work lost in friction; in a stage, of that stage"),
    word("x_n", Arguments::Pair, Dimension::Force, "compressive force"),
    word("x_t", Arguments::Pair, Dimension::Force, "friction force"),
    word("z_n", Arguments::Pair, Dimension::Length, "distance open"),
    word("z_t", Arguments::Pair, Dimension::Length, "slip"),
    word("bound", Arguments::Pair, Dimension::Force, "friction bound"),
    word("reserve_plus", Arguments::Pair, Dimension::Force, "bound + x_t"),
    word("reserve_minus", Arguments::Pair, Dimension::Force, "bound − x_t"),
    word("reserve", Arguments::Pair, Dimension::Force, "bound − |x_t|"),
    word("state", Arguments::Pair, Dimension::None, "open, stick, slip+, slip- or closed"),
    word("sum", Arguments::Over, Dimension::Inner, "sum over pairs: sum x_n joint[*]"),
    word("max", Arguments::Over, Dimension::Inner, "largest over pairs, along a bar, or |u|: max M AB, max u"),
    word("min", Arguments::Over, Dimension::Inner, "least over pairs or along a bar"),
    word("count", Arguments::Count, Dimension::None, "number of pairs in a state: count open joint[*]"),
    word("resultant", Arguments::Joint, Dimension::Inner, "of an edge contact: N, T, or the eccentricity e of N"),
    word("ux", Arguments::Node, Dimension::Length, "displacement along x"),
    word("uy", Arguments::Node, Dimension::Length, "displacement along y"),
    word("rz", Arguments::Node, Dimension::None, "rotation"),
    word("N", Arguments::Bar, Dimension::Force, "normal force of a bar; without a place the one of largest magnitude"),
    word("Q", Arguments::Bar, Dimension::Force, "shear force of a bar; likewise"),
    word("M", Arguments::Bar, Dimension::Moment, "bending moment of a bar; likewise"),
    word("fx", Arguments::Node, Dimension::Force, "reaction along x"),
    word("fy", Arguments::Node, Dimension::Force, "reaction along y"),
    word("m", Arguments::Node, Dimension::Moment, "moment of the reaction"),
    word("sx", Arguments::NodeOrElement, Dimension::Stress, "stress along x"),
    word("sy", Arguments::NodeOrElement, Dimension::Stress, "stress along y"),
    word("sxy", Arguments::NodeOrElement, Dimension::Stress, "shear stress"),
    word("s1", Arguments::NodeOrElement, Dimension::Stress, "larger principal stress in the plane"),
    word("s2", Arguments::NodeOrElement, Dimension::Stress, "smaller principal stress in the plane"),
    word("mises", Arguments::NodeOrElement, Dimension::Stress, "equivalent stress of von Mises"),
    word("limit", Arguments::Case, Dimension::None, "limit of a load"),
    word("safety", Arguments::Case, Dimension::None, "limit of a load over its present value"),
    word("critical", Arguments::Parameter, Dimension::None, "friction above which several answers are possible"),
    word("stage", Arguments::Stage, Dimension::Inner, "a quantity at the end of a stage: stage 2 x_n c1"),
];

/// The table entry of a word.
pub fn entry(word: &str) -> Option<&'static Word> {
    WORDS.iter().find(|known| known.word == word)
}

/// Which number of a bar, joint or set of pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// Σ.
    Sum,
    /// The largest.
    Max,
    /// The least.
    Min,
}

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

/// Something that can be asked of an answer. Names are those of the scenario it was read with.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A word without arguments.
    Plain(&'static str),
    /// A number or the state of a pair.
    Pair(&'static str, String),
    /// Of all pairs that fit a pattern.
    Pairs(Over, &'static str, String),
    /// How many pairs of a pattern are in a state.
    Count(&'static str, String),
    /// Of an edge contact.
    Resultant(String, ResultantPart),
    /// `ux`, `uy`, `rz` of a node, or a component of its reaction.
    Node(&'static str, String),
    /// The largest |u|.
    LargestDisplacement,
    /// `N`, `Q` or `M` of a bar.
    Bar(&'static str, String, BarPlace),
    /// A stress at a node.
    NodeStress(&'static str, String),
    /// A stress in an element.
    ElementStress(&'static str, String),
    /// `limit` or `safety` of a load.
    Load(&'static str, String),
    /// Critical friction.
    Critical(String),
    /// At the end of a stage, from 1.
    Stage(usize, Box<Quantity>),
    /// A probe of the scenario: its name and what it stands for.
    Probe(String, Box<Quantity>),
}

/// The states of pairs.
pub const STATES: &[&str] = &["open", "stick", "slip+", "slip-", "closed"];

/// Words that are no quantity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct QuantityError(pub String);

/// The names that quantities of a scenario may have as arguments.
#[derive(Clone, Debug, Default)]
pub struct Names<'s> {
    /// Ids of the pairs.
    pub pairs: Vec<&'s str>,
    nodes: HashSet<&'s str>,
    bars: Vec<&'s str>,
    structure: Option<&'s Structure>,
    cases: Vec<&'s str>,
    parameters: Vec<&'s str>,
    stages: usize,
    probes: &'s [(String, Quantity)],
}

impl<'s> Names<'s> {
    /// Those of a scenario.
    pub fn of(scenario: &'s Scenario) -> Names<'s> {
        let mut names = Names {
            parameters: scenario.parameters.keys().map(String::as_str).collect(),
            stages: scenario.stages.len(),
            probes: &scenario.probes,
            ..Names::default()
        };
        match &scenario.source {
            Source::Structure(structure) => {
                names.pairs = structure.pairs.iter().map(|pair| pair.id.as_str()).collect();
                names.nodes = structure.nodes.iter().map(|node| node.id.as_str()).collect();
                names.bars = structure.bars.iter().map(|bar| bar.id.as_str()).collect();
                names.structure = Some(structure);
                names.cases = structure.load_cases.iter().map(|case| case.name.as_str()).collect();
            }
            Source::ContactSystem(system) => {
                names.pairs = system.pairs.iter().map(String::as_str).collect();
                names.cases = system.loads.iter().map(|load| load.name.as_str()).collect();
            }
            Source::Lcp(_) => {}
        }
        names
    }

    /// The edge contacts: `joint` of the pairs `joint[0]`, `joint[1]` …
    pub fn joints(&self) -> Vec<&'s str> {
        let mut joints: Vec<&str> =
            self.pairs.iter().filter_map(|id| id.split_once('[').map(|(joint, _)| joint)).collect();
        joints.dedup();
        joints
    }

    /// Ids of the bars.
    pub fn bars(&self) -> &[&'s str] {
        &self.bars
    }

    fn element(&self, name: &str) -> bool {
        self.structure.is_some_and(|structure| structure.element_named(name).is_some())
    }
}

/// Whether a pair fits a pattern: an id, the name of an edge contact, or with `*` for any letters.
pub fn fits(pattern: &str, id: &str) -> bool {
    let mut parts = pattern.split('*');
    let first = parts.next().unwrap_or_default();
    let rest: Vec<&str> = parts.collect();
    let Some((last, middle)) = rest.split_last() else {
        return id == pattern || id.strip_prefix(pattern).is_some_and(|rest| rest.starts_with('['));
    };
    let Some(mut left) = id.strip_prefix(first) else { return false };
    for part in middle {
        match left.find(part) {
            Some(at) => left = &left[at + part.len()..],
            None => return false,
        }
    }
    left.ends_with(last)
}

fn error<T>(text: impl Into<String>) -> Result<T, QuantityError> {
    Err(QuantityError(text.into()))
}

/// The known name, or "no pair `jiont[0]` (did you mean `joint[0]`?): the pairs are c1, c2".
fn known<'n>(what: &str, word: &str, names: &[&'n str]) -> Result<&'n str, QuantityError> {
    if let Some(found) = names.iter().find(|name| **name == word) {
        return Ok(found);
    }
    // Of two letters any other two are near.
    let near = nearest(word, names.iter().copied()).filter(|_| word.len() > 2);
    let near = near.map_or(String::new(), |near| format!(" (did you mean `{near}`?)"));
    error(match names {
        [] => format!("no {what} `{word}`: this scenario has none"),
        [only] => format!("no {what} `{word}`{near}: the only {what} is {only}"),
        [first, .., last] if names.len() > 8 => format!("no {what} `{word}`{near}: the {what}s are {first} … {last}"),
        names => format!("no {what} `{word}`{near}: the {what}s are {}", names.join(", ")),
    })
}

/// Reads one quantity from the front of `words`; what is left comes back.
///
/// # Errors
/// An unknown word or name, with the one that may be meant.
pub fn read<'w>(words: &'w [String], names: &Names<'_>) -> Result<(Quantity, &'w [String]), QuantityError> {
    let Some((first, rest)) = words.split_first() else {
        return error("a quantity is expected: `help show` lists them");
    };
    let probe = |name: &str, quantity: &Quantity| Quantity::Probe(name.to_owned(), Box::new(quantity.clone()));
    if let Some((name, quantity)) = names.probes.iter().find(|(name, _)| name == first) {
        return Ok((probe(name, quantity), rest));
    }
    if let Some(inner) = quoted(first) {
        let (quantity, more) = read(&inner, names)?;
        return match more.first() {
            None => Ok((quantity, rest)),
            Some(word) => error(format!("`{word}` after {quantity} in `{first}`: quote each quantity by itself")),
        };
    }
    let found = read_words(first, rest, names);
    if found.is_err() {
        // Typed without quotes a name with blanks comes in words; of several the longest.
        let typed = |name: &str| {
            let parts: Vec<&str> = name.split_whitespace().collect();
            let fits = words.len() >= parts.len() && parts.iter().zip(words).all(|(part, word)| part == word);
            fits.then_some(parts.len()).filter(|count| *count > 1)
        };
        let named = names.probes.iter().filter_map(|(name, quantity)| Some((typed(name)?, name, quantity)));
        if let Some((count, name, quantity)) = named.max_by_key(|(count, ..)| *count) {
            return Ok((probe(name, quantity), &words[count..]));
        }
    }
    found
}

/// The words of a quantity that was quoted as a whole: `m noz` in one word.
fn quoted(word: &str) -> Option<Vec<String>> {
    let words = shlex::split(word)?;
    (words.len() > 1 && entry(&words[0]).is_some()).then_some(words)
}

/// Reads a quantity that is no probe.
fn read_words<'w>(
    first: &str,
    rest: &'w [String],
    names: &Names<'_>,
) -> Result<(Quantity, &'w [String]), QuantityError> {
    let Some(entry) = entry(first) else {
        let probes = names.probes.iter().map(|(name, _)| name.as_str());
        let near = did_you_mean(first, WORDS.iter().map(|known| known.word).chain(probes));
        return error(format!("unknown quantity `{first}`{near}; `help show` lists them"));
    };
    let argument = |rest: &'w [String]| match rest.split_first() {
        Some((argument, rest)) if !argument.is_empty() => Ok((argument.as_str(), rest)),
        _ => error(format!("`{}` of what? Write `{} {}`", entry.word, entry.word, entry.arguments.usage())),
    };
    match entry.arguments {
        Arguments::None => Ok((Quantity::Plain(entry.word), rest)),
        Arguments::Pair => {
            let (pair, rest) = argument(rest)?;
            if pair.contains('*') {
                return error(format!("`{} {pair}` is of several pairs: put sum, max or min before it", entry.word));
            }
            known("pair", pair, &names.pairs)?;
            Ok((Quantity::Pair(entry.word, pair.to_owned()), rest))
        }
        Arguments::Node => {
            let (node, rest) = argument(rest)?;
            node_named(node, names)?;
            Ok((Quantity::Node(entry.word, node.to_owned()), rest))
        }
        Arguments::Bar => bar(entry, rest, names, None),
        Arguments::NodeOrElement => {
            let (name, rest) = argument(rest)?;
            if names.element(name) && names.nodes.contains(name) {
                return error(format!(
                    "`{} {name}`: {name} is a node and an element as well; give one of them another id",
                    entry.word
                ));
            }
            if names.element(name) {
                return Ok((Quantity::ElementStress(entry.word, name.to_owned()), rest));
            }
            let elements = names.structure.map_or(&[][..], |structure| &structure.named_elements);
            let elements: Vec<&str> = elements.iter().map(|(id, _)| id.as_str()).collect();
            known_place("node or element", name, names, &elements)?;
            Ok((Quantity::NodeStress(entry.word, name.to_owned()), rest))
        }
        Arguments::Joint => {
            let (joint, rest) = argument(rest)?;
            known("edge contact", joint, &names.joints())?;
            let part = match rest.first().map(String::as_str) {
                Some("N") => ResultantPart::Normal,
                Some("T") => ResultantPart::Tangential,
                Some("e") => ResultantPart::Eccentricity,
                _ => return error(format!("`resultant {joint}` takes N, T or e")),
            };
            Ok((Quantity::Resultant(joint.to_owned(), part), &rest[1..]))
        }
        Arguments::Case => {
            let (load, rest) = argument(rest)?;
            let loads: Vec<&str> = names.cases.iter().chain(&names.parameters).copied().collect();
            known("load case or parameter", load, &loads)?;
            Ok((Quantity::Load(entry.word, load.to_owned()), rest))
        }
        Arguments::Parameter => {
            let (parameter, rest) = argument(rest)?;
            known("parameter", parameter, &names.parameters)?;
            Ok((Quantity::Critical(parameter.to_owned()), rest))
        }
        Arguments::Over => over(entry, rest, names),
        Arguments::Count => {
            let (state, rest) = argument(rest)?;
            let state = known("state", state, STATES)?;
            let (pattern, rest) = pattern(rest, names)?;
            Ok((Quantity::Count(state, pattern), rest))
        }
        Arguments::Stage => {
            let (number, rest) = argument(rest)?;
            let stage = number.parse::<usize>().ok().filter(|stage| (1..=names.stages).contains(stage));
            let Some(stage) = stage else {
                return error(match names.stages {
                    0 => format!("no stage {number}: the scenario has no `stages`"),
                    last => format!("no stage {number}: there are stages 1 to {last}"),
                });
            };
            let (inner, rest) = read(rest, names)?;
            Ok((Quantity::Stage(stage, Box::new(inner)), rest))
        }
    }
}

fn node_named(node: &str, names: &Names<'_>) -> Result<(), QuantityError> {
    known_place("node", node, names, &[])
}

/// Refuses what is neither a node nor one of the `others`.
fn known_place(what: &str, name: &str, names: &Names<'_>, others: &[&str]) -> Result<(), QuantityError> {
    if names.nodes.contains(name) {
        return Ok(());
    }
    if names.nodes.is_empty() {
        return error(format!("no {what} `{name}`: this scenario is no structure"));
    }
    // In order: of equally near names always the same one is told.
    let mut all: Vec<&str> = names.nodes.iter().chain(others).copied().collect();
    all.sort_unstable();
    error(format!("no {what} `{name}`{}", did_you_mean(name, all)))
}

fn bar<'w>(
    entry: &'static Word,
    rest: &'w [String],
    names: &Names<'_>,
    over: Option<Over>,
) -> Result<(Quantity, &'w [String]), QuantityError> {
    let Some((name, rest)) = rest.split_first() else {
        return error(format!("`{}` of which bar?", entry.word));
    };
    known("bar", name, &names.bars)?;
    let found = |place, rest| Ok((Quantity::Bar(entry.word, name.clone(), place), rest));
    if let Some(over) = over {
        return found(BarPlace::Over(over), rest);
    }
    match rest {
        [at, distance, rest @ ..] if at == "at" => match distance.parse::<f64>() {
            Ok(distance) if distance.is_finite() => found(BarPlace::At(distance), rest),
            _ => error(format!("`{distance}` is no distance from the start of {name}")),
        },
        [place, rest @ ..] if place == "start" => found(BarPlace::Start, rest),
        [place, rest @ ..] if place == "end" => found(BarPlace::End, rest),
        rest => found(BarPlace::Extreme, rest),
    }
}

fn over<'w>(
    word: &'static Word,
    rest: &'w [String],
    names: &Names<'_>,
) -> Result<(Quantity, &'w [String]), QuantityError> {
    let over = match word.word {
        "sum" => Over::Sum,
        "max" => Over::Max,
        _ => Over::Min,
    };
    let Some((inner, after)) = rest.split_first() else {
        return error(format!("`{}` of what? Write e.g. `{} x_n joint[*]`", word.word, word.word));
    };
    if inner == "u" && over == Over::Max {
        return Ok((Quantity::LargestDisplacement, after));
    }
    match entry(inner) {
        Some(inner) if inner.arguments == Arguments::Bar && over != Over::Sum => bar(inner, after, names, Some(over)),
        Some(inner) if inner.arguments == Arguments::Pair && inner.word != "state" => {
            let (pattern, rest) = pattern(after, names)?;
            Ok((Quantity::Pairs(over, inner.word, pattern), rest))
        }
        _ => {
            let words = WORDS.iter().filter(|known| known.arguments == Arguments::Pair).map(|known| known.word);
            let near = did_you_mean(inner, words);
            error(format!(
                "`{} {inner}`{near}: expected a number of pairs, like `{} x_n joint[*]`{}",
                word.word,
                word.word,
                match over {
                    Over::Sum => "",
                    Over::Max => ", of a bar, like `max M AB`, or `max u`",
                    Over::Min => ", or of a bar, like `min M AB`",
                }
            ))
        }
    }
}

/// A pattern of pairs; all of them where none is given.
fn pattern<'w>(rest: &'w [String], names: &Names<'_>) -> Result<(String, &'w [String]), QuantityError> {
    let starts_comparison = |word: &str| word.starts_with(['=', '<', '>', '!']);
    match rest.split_first() {
        Some((pattern, rest)) if !starts_comparison(pattern) && entry(pattern).is_none() => {
            if names.pairs.iter().any(|id| fits(pattern, id)) {
                return Ok((pattern.clone(), rest));
            }
            known("pair", pattern, &names.pairs)?;
            Ok((pattern.clone(), rest))
        }
        _ if names.pairs.is_empty() => error("this scenario has no pairs"),
        _ => Ok(("*".to_owned(), rest)),
    }
}

/// Reads all quantities of `words`; commas outside brackets may separate them.
///
/// # Errors
/// As [`read`].
pub fn read_all(words: &[String], names: &Names<'_>) -> Result<Vec<Quantity>, QuantityError> {
    let mut quantities = Vec::new();
    for part in listed_parts(words, names) {
        let mut rest = &part[..];
        while !rest.is_empty() {
            let (quantity, after) = read(rest, names)?;
            quantities.push(quantity);
            rest = after;
        }
    }
    Ok(quantities)
}

/// Reads quantities from a text in which quotation marks hold a name together.
///
/// # Errors
/// As [`read`], and an open quotation.
pub fn read_text(text: &str, names: &Names<'_>) -> Result<Vec<Quantity>, QuantityError> {
    let Some(words) = shlex::split(text) else {
        return error(format!("a quotation mark in `{text}` is left open"));
    };
    read_all(&words, names)
}

/// The words between the commas that stand outside brackets.
fn listed_parts(words: &[String], names: &Names<'_>) -> Vec<Vec<String>> {
    let mut parts = vec![Vec::new()];
    for word in words {
        if names.probes.iter().any(|(name, _)| name == word) {
            parts.last_mut().into_iter().for_each(|part: &mut Vec<String>| part.push(word.clone()));
            continue;
        }
        let mut depth = 0;
        let mut piece = String::new();
        for c in word.chars() {
            match c {
                '[' | '{' | '(' => depth += 1,
                ']' | '}' | ')' => depth -= 1,
                _ => {}
            }
            if c != ',' || depth > 0 {
                piece.push(c);
                continue;
            }
            let piece = std::mem::take(&mut piece);
            parts.last_mut().into_iter().filter(|_| !piece.is_empty()).for_each(|part| part.push(piece.clone()));
            parts.push(Vec::new());
        }
        parts.last_mut().into_iter().filter(|_| !piece.is_empty()).for_each(|part| part.push(piece.clone()));
    }
    parts.retain(|part| !part.is_empty());
    parts
}

impl Quantity {
    /// Its unit in the author's labels.
    pub fn unit(&self, units: &Units) -> Option<String> {
        self.dimension().label(units)
    }

    fn dimension(&self) -> Dimension {
        match self {
            Quantity::Plain(word)
            | Quantity::Pair(word, _)
            | Quantity::Pairs(_, word, _)
            | Quantity::Node(word, _)
            | Quantity::Bar(word, ..)
            | Quantity::NodeStress(word, _)
            | Quantity::ElementStress(word, _)
            | Quantity::Load(word, _) => entry(word).map_or(Dimension::None, |entry| entry.dimension),
            Quantity::Count(..) | Quantity::Critical(_) => Dimension::None,
            Quantity::Resultant(_, ResultantPart::Eccentricity) | Quantity::LargestDisplacement => Dimension::Length,
            Quantity::Resultant(..) => Dimension::Force,
            Quantity::Stage(_, inner) | Quantity::Probe(_, inner) => inner.dimension(),
        }
    }

    /// Whether it can be read from one state of the pairs and the structure, without a run or a path of its own.
    pub fn is_of_state(&self) -> bool {
        match self {
            Quantity::Plain(word) => *word == "energy",
            Quantity::Load(..) | Quantity::Critical(_) | Quantity::Stage(..) => false,
            Quantity::Probe(_, inner) => inner.is_of_state(),
            _ => true,
        }
    }

    /// Whether its value is a word, not a number.
    pub fn is_word(&self) -> bool {
        match self {
            Quantity::Plain(word) => matches!(*word, "outcome" | "class" | "verdict"),
            Quantity::Pair(word, _) => *word == "state",
            Quantity::Stage(_, inner) | Quantity::Probe(_, inner) => inner.is_word(),
            _ => false,
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let over = |over: &Over| match over {
            Over::Sum => "sum",
            Over::Max => "max",
            Over::Min => "min",
        };
        match self {
            Quantity::Plain(word) => write!(f, "{word}"),
            Quantity::Pair(word, name)
            | Quantity::Node(word, name)
            | Quantity::NodeStress(word, name)
            | Quantity::ElementStress(word, name)
            | Quantity::Load(word, name) => write!(f, "{word} {name}"),
            Quantity::Pairs(how, word, pattern) => write!(f, "{} {word} {pattern}", over(how)),
            Quantity::Count(state, pattern) => write!(f, "count {state} {pattern}"),
            Quantity::Resultant(joint, part) => {
                let part = match part {
                    ResultantPart::Normal => "N",
                    ResultantPart::Tangential => "T",
                    ResultantPart::Eccentricity => "e",
                };
                write!(f, "resultant {joint} {part}")
            }
            Quantity::LargestDisplacement => write!(f, "max u"),
            Quantity::Bar(word, bar, place) => match place {
                BarPlace::At(distance) => write!(f, "{word} {bar} at {distance}"),
                BarPlace::Start => write!(f, "{word} {bar} start"),
                BarPlace::End => write!(f, "{word} {bar} end"),
                BarPlace::Extreme => write!(f, "{word} {bar}"),
                BarPlace::Over(how) => write!(f, "{} {word} {bar}", over(how)),
            },
            Quantity::Critical(parameter) => write!(f, "critical {parameter}"),
            Quantity::Stage(stage, inner) => write!(f, "stage {stage} {inner}"),
            Quantity::Probe(name, _) => write!(f, "{name}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use super::*;
    use crate::model::structure::Plate;

    /// Node and quad `A`, quad `q1`, a plate `lower` of 4 × 2 elements.
    fn structure() -> &'static Structure {
        static STRUCTURE: OnceLock<Structure> = OnceLock::new();
        STRUCTURE.get_or_init(|| Structure {
            plates: vec![Plate { id: "lower".into(), elements: 0..8, nodes: vec![vec![0; 5]; 3] }],
            named_elements: vec![("q1".into(), 8), ("A".into(), 9)],
            ..Structure::default()
        })
    }

    fn names(probes: &[(String, Quantity)]) -> Names<'_> {
        Names {
            pairs: vec!["c1", "c2", "joint[0]", "joint[1]"],
            nodes: ["A", "B", "lower[0,8]"].into_iter().collect(),
            bars: vec!["AB"],
            structure: Some(structure()),
            cases: vec!["pull"],
            parameters: vec!["f", "F2"],
            stages: 2,
            probes,
        }
    }

    fn words(text: &str) -> Vec<String> {
        shlex::split(text).unwrap()
    }

    #[test]
    fn every_quantity_reads_and_writes_itself() {
        let probes = [("nozzle moment".to_owned(), Quantity::Bar("M", "AB".into(), BarPlace::Start))];
        let names = names(&probes);
        for text in [
            "outcome",
            "pivots",
            "x_n c1",
            "state joint[1]",
            "reserve c2",
            "sum x_n joint[*]",
            "max z_t *",
            "count open joint",
            "resultant joint e",
            "ux A",
            "rz lower[0,8]",
            "max u",
            "M AB",
            "M AB at 1.5",
            "N AB end",
            "min M AB",
            "fy B",
            "sx B",
            "mises lower{3,1}",
            "s1 q1",
            "limit pull",
            "safety F2",
            "critical f",
            "stage 2 x_n c1",
        ] {
            let words = words(text);
            let (quantity, rest) = read(&words, &names).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert!(rest.is_empty(), "{text}");
            assert_eq!(quantity.to_string(), text);
        }
        assert_eq!(read(&words("\"nozzle moment\" < 20"), &names).unwrap().1, ["<", "20"]);
        assert_eq!(read(&words("count open = 3"), &names).unwrap().1, ["=", "3"]);
    }

    /// Quoted as a whole or not, with the name of a node in quotes inside, a probe with blanks in its name.
    #[test]
    fn quotation_marks_hold_together_what_they_hold() {
        let probe = |name: &str| (name.to_owned(), Quantity::Node("m", "B".into()));
        let probes = [probe("foot"), probe("nozzle moment"), probe("nozzle moment hot"), probe("m of B")];
        let names = names(&probes);
        let all = |text: &str| {
            let all = read_text(text, &names).unwrap_or_else(|error| panic!("{text}: {error}"));
            all.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(all("'m B'"), ["m B"]);
        assert_eq!(
            all("m B, 'sum x_n joint[*]' 'M AB at 1.5', foot"),
            ["m B", "sum x_n joint[*]", "M AB at 1.5", "foot"]
        );
        assert_eq!(all("'m \"B\"' 'stage 2 x_n c1' stage 1 'x_n c1'"), ["m B", "stage 2 x_n c1", "stage 1 x_n c1"]);
        assert_eq!(all("nozzle moment, foot"), ["nozzle moment", "foot"]);
        assert_eq!(all("nozzle moment hot 'nozzle moment' m of B"), ["nozzle moment hot", "nozzle moment", "m of B"]);
        assert_eq!(read(&words("'x_n c1' < 20"), &names).unwrap().1, ["<", "20"]);
        assert_eq!(read(&words("nozzle moment < 20"), &names).unwrap().1, ["<", "20"]);
        for (text, part) in [
            ("'m B m B'", "quote each quantity by itself"),
            ("'m D'", "no node `D`"),
            ("'no such probe'", "unknown quantity `no such probe`"),
            ("nozzle", "unknown quantity `nozzle`"),
        ] {
            let error = read(&words(text), &names).expect_err(text).to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn lists_are_separated_by_commas_outside_brackets() {
        let names = names(&[]);
        let all = |text: &str| {
            let all = read_text(text, &names).unwrap_or_else(|error| panic!("{text}: {error}"));
            all.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(
            all("x_n c1, M AB,ux lower[0,8],mises lower{1,1}"),
            ["x_n c1", "M AB", "ux lower[0,8]", "mises lower{1,1}"]
        );
        assert_eq!(all("x_n c1 x_t c2"), ["x_n c1", "x_t c2"]);
    }

    #[test]
    fn unknown_words_and_names_are_told() {
        let names = names(&[]);
        for (text, part) in [
            ("xn c1", "unknown quantity `xn`: did you mean \"x_n\"?"),
            ("x_n c9", "no pair `c9`"),
            ("x_n joint[*]", "put sum, max or min before it"),
            ("x_n", "`x_n` of what? Write `x_n PAIR`"),
            ("M CD", "no bar `CD`"),
            ("M AB at x", "`x` is no distance"),
            ("sum M AB", "expected a number of pairs"),
            ("sum x_n d*", "no pair `d*`"),
            ("count opne", "no state `opne` (did you mean `open`?)"),
            ("resultant c1 N", "no edge contact `c1`"),
            ("resultant joint M", "takes N, T or e"),
            ("mises lower{4,0}", "no node or element `lower{4,0}`"),
            ("mises A", "A is a node and an element as well"),
            ("mises q2", "no node or element `q2`"),
            ("stage 3 x_n c1", "there are stages 1 to 2"),
            ("limit puls", "did you mean `pull`?"),
        ] {
            let found = read(&words(text), &names).unwrap_err().to_string();
            assert!(found.contains(part), "{text}: {found}");
        }
    }

    #[test]
    fn patterns_fit_as_expected() {
        for (pattern, id, expected) in [
            ("joint[*]", "joint[12]", true),
            ("joint", "joint[12]", true),
            ("joint", "joints[0]", false),
            ("c1", "c1", true),
            ("c1", "c12", false),
            ("*", "c1", true),
            ("c*2", "c12", true),
            ("a*b*c", "a1b2c", true),
            ("a*b*c", "acb", false),
        ] {
            assert_eq!(fits(pattern, id), expected, "{pattern} {id}");
        }
    }
}
