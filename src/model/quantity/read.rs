//! The words of a command, a probe or an option → quantities, against the names of a scenario.

use super::of_bar::Internal;
use super::of_stress::OfStress;
use super::words::{Meaning, Over, Word, entry, pair_words, states_of, words_of};
use super::{BarPlace, Names, Quantity, ResultantPart, fits};
use crate::model::structure::Dimension;
use crate::model::words::{did_you_mean_typed, no_such};

/// Words that are not a quantity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct QuantityError(pub String);

pub(super) fn error<T>(text: impl Into<String>) -> Result<T, QuantityError> {
    Err(QuantityError(text.into()))
}

/// The known name.
fn known<'n>(what: &str, word: &str, names: &[&'n str]) -> Result<&'n str, QuantityError> {
    let found = names.iter().find(|name| **name == word);
    found.copied().ok_or_else(|| QuantityError(no_such(what, word, names.iter().copied())))
}

/// Reads one quantity from the front of `words`; returns it with the words that are left.
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
        // Typed without quotes, a name with blanks comes as several words; of several such names the longest is taken.
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

/// Reads a quantity that is not a probe.
fn read_words<'w>(
    first: &str,
    rest: &'w [String],
    names: &Names<'_>,
) -> Result<(Quantity, &'w [String]), QuantityError> {
    let Some(entry) = entry(first) else {
        let probes = names.probes.iter().map(|(name, _)| name.as_str());
        if names.parameters.contains(&first) {
            return error(format!("`{first}` is a parameter, not a quantity of the answer: `params` shows its value"));
        }
        let near = did_you_mean_typed(first, words_of(names.dimension).map(|known| known.word).chain(probes));
        return error(format!("unknown quantity `{first}`{near}; `help show` lists them"));
    };
    lies_there(entry, names)?;
    let argument = |rest: &'w [String]| match rest.split_first() {
        Some((argument, rest)) if !argument.is_empty() && !argument.starts_with(['=', '<', '>', '!']) => {
            Ok((argument.clone(), rest))
        }
        _ => error(format!(
            "`{}` of what? Write `{} {}`{}",
            entry.word,
            entry.word,
            entry.meaning.arguments(),
            also_a_parameter(entry.word, names)
        )),
    };
    match entry.meaning {
        Meaning::Answer(which) => Ok((Quantity::Answer(which), rest)),
        Meaning::Pair(_) | Meaning::State => {
            let (pair, rest) = argument(rest)?;
            if pair.contains('*') {
                return error(format!("`{} {pair}` is of several pairs: put sum, max or min before it", entry.word));
            }
            known("pair", &pair, &names.pairs)?;
            let quantity = match entry.meaning {
                Meaning::Pair(which) => Quantity::Pair(which, pair),
                _ => Quantity::State(pair),
            };
            Ok((quantity, rest))
        }
        Meaning::Node(which) => {
            let (node, rest) = argument(rest)?;
            known_place("node", &node, names, &[])?;
            Ok((Quantity::Node(which, node), rest))
        }
        Meaning::Bar(which) => bar(which, rest, names, None),
        Meaning::Stress(which) => {
            let (name, rest) = argument(rest)?;
            Ok((stress(which, name, names)?, rest))
        }
        Meaning::Resultant => {
            let (joint, rest) = argument(rest)?;
            known("edge contact", &joint, &names.joints())?;
            let part = rest.first().and_then(|word| ResultantPart::WORDS.iter().find(|(known, _)| known == word));
            let Some((_, part)) = part else { return error(format!("`resultant {joint}` takes N, T or e")) };
            Ok((Quantity::Resultant(joint, *part), &rest[1..]))
        }
        Meaning::Load(which) => {
            let (load, rest) = argument(rest)?;
            let loads: Vec<&str> = names.cases.iter().chain(&names.parameters).copied().collect();
            known("load case or parameter", &load, &loads)?;
            Ok((Quantity::Load(which, load), rest))
        }
        Meaning::Critical => {
            let (parameter, rest) = argument(rest)?;
            known("parameter", &parameter, &names.parameters)?;
            Ok((Quantity::Critical(parameter), rest))
        }
        Meaning::Over(how) => over(how, rest, names),
        Meaning::Count => {
            let (state, rest) = argument(rest)?;
            let state = known("state", &state, &states_of(names.dimension))?;
            let (pattern, rest) = pattern(rest, names)?;
            Ok((Quantity::Count(state, pattern), rest))
        }
        Meaning::Stage => {
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

/// A stress at a node or in an element.
fn stress(which: OfStress, name: String, names: &Names<'_>) -> Result<Quantity, QuantityError> {
    match (names.element(&name), names.nodes.contains(name.as_str())) {
        (true, true) => error(format!(
            "`{} {name}`: {name} is a node and an element as well; give one of them another id",
            Meaning::Stress(which).word()
        )),
        (true, false) => Ok(Quantity::ElementStress(which, name)),
        (false, _) => {
            let elements = names.structure.map_or(&[][..], |structure| &structure.named_elements);
            let elements: Vec<&str> = elements.iter().map(|(id, _)| id.as_str()).collect();
            known_place("node or element", &name, names, &elements)?;
            Ok(Quantity::NodeStress(which, name))
        }
    }
}

/// Refuses a quantity of space in the plane, and the other way round.
fn lies_there(entry: &Word, names: &Names<'_>) -> Result<(), QuantityError> {
    // A bare LCP lies nowhere: the name is refused.
    let is_anywhere = names.structure.is_some() || !names.pairs.is_empty();
    if entry.meaning.is_of(names.dimension) || !is_anywhere {
        return Ok(());
    }
    let what = if names.structure.is_some() { "structure" } else { "problem" };
    let (other, here) = match names.dimension {
        Dimension::Plane => (Dimension::Space, Dimension::Plane),
        Dimension::Space => (Dimension::Plane, Dimension::Space),
    };
    let (other, here) = (other.in_which(), here.in_which());
    let instead = match (entry.word, names.dimension) {
        ("M", Dimension::Space) => ": it has `My` and `Mz`",
        ("Q", Dimension::Space) => ": it has `Vy` and `Vz`",
        ("Mz", Dimension::Plane) => ": it has `M`",
        ("Vy", Dimension::Plane) => ": it has `Q`",
        _ => "",
    };
    let parameter = also_a_parameter(entry.word, names);
    error(format!("`{}` is a quantity of {other}, and this {what} lies in {here}{instead}{parameter}", entry.word))
}

/// Where the value of a parameter is shown that has the name of a quantity.
fn also_a_parameter(word: &str, names: &Names<'_>) -> &'static str {
    match names.parameters.contains(&word) {
        true => "; the value of the parameter of this name is shown by `params`",
        false => "",
    }
}

/// Refuses what is neither a node nor one of the `others`.
fn known_place(what: &str, name: &str, names: &Names<'_>, others: &[&str]) -> Result<(), QuantityError> {
    if names.nodes.contains(name) {
        return Ok(());
    }
    if names.nodes.is_empty() {
        return error(format!("no {what} `{name}`: this scenario has no structure"));
    }
    // In order, so that of equally near names the same one is always suggested.
    let mut all: Vec<&str> = names.nodes.iter().chain(others).copied().collect();
    all.sort_unstable();
    error(format!("no {what} `{name}`{}", did_you_mean_typed(name, all)))
}

fn bar<'w>(
    which: Internal,
    rest: &'w [String],
    names: &Names<'_>,
    over: Option<Over>,
) -> Result<(Quantity, &'w [String]), QuantityError> {
    let Some((name, rest)) = rest.split_first() else {
        let word = which.symbol();
        return error(format!("`{word}` of which bar?{}", also_a_parameter(word, names)));
    };
    known("bar", name, &names.bars)?;
    let found = |place, rest| Ok((Quantity::Bar(which, name.clone(), place), rest));
    if let Some(over) = over {
        return found(BarPlace::Over(over), rest);
    }
    match rest {
        [at, distance, rest @ ..] if at == "at" => match distance.parse::<f64>() {
            Ok(distance) if distance.is_finite() => found(BarPlace::At(distance), rest),
            _ => error(format!("`{distance}` is not a distance from the start of {name}")),
        },
        [place, rest @ ..] if place == "start" => found(BarPlace::Start, rest),
        [place, rest @ ..] if place == "end" => found(BarPlace::End, rest),
        rest => found(BarPlace::Extreme, rest),
    }
}

fn over<'w>(over: Over, rest: &'w [String], names: &Names<'_>) -> Result<(Quantity, &'w [String]), QuantityError> {
    let word = Meaning::Over(over).word();
    let Some((inner, after)) = rest.split_first() else {
        return error(format!("`{word}` of what? Write e.g. `{word} x_n joint[*]`"));
    };
    if inner == "u" && over == Over::Max {
        return Ok((Quantity::LargestDisplacement, after));
    }
    let entry = entry(inner);
    entry.map_or(Ok(()), |entry| lies_there(entry, names))?;
    match entry.map(|entry| entry.meaning) {
        Some(Meaning::Bar(which)) if over != Over::Sum => bar(which, after, names, Some(over)),
        Some(Meaning::Pair(which)) => {
            let (pattern, rest) = pattern(after, names)?;
            Ok((Quantity::Pairs(over, which, pattern), rest))
        }
        Some(Meaning::Stress(which)) if over != Over::Sum => {
            let (body, rest) = body(after, names)?;
            Ok((Quantity::Stresses(over, which, body), rest))
        }
        _ => error(format!(
            "`{word} {inner}`{}: expected a number of pairs, like `{word} x_n joint[*]`{}",
            did_you_mean_typed(inner, pair_words(names.dimension).map(|(word, _)| word)),
            match over {
                Over::Sum => "",
                Over::Max => ", of a bar, like `max M AB`, a stress, like `max s1`, or `max u`",
                Over::Min => ", of a bar, like `min M AB`, or a stress, like `min s2`",
            }
        )),
    }
}

/// A plate, a brick, a mesh or a part of one; all of them where none is named.
fn body<'w>(rest: &'w [String], names: &Names<'_>) -> Result<(Option<String>, &'w [String]), QuantityError> {
    let bodies = names.structure.map_or_else(Vec::new, |structure| structure.bodies());
    match rest.split_first() {
        Some((body, rest)) if bodies.contains(&body.as_str()) => Ok((Some(body.clone()), rest)),
        Some((body, _)) if goes_on(body) => error(no_such("plate, brick or mesh", body, bodies)),
        _ => Ok((None, rest)),
    }
}

/// Whether a word that may be left out is there: neither a comparison nor the next quantity.
fn goes_on(word: &str) -> bool {
    !word.starts_with(['=', '<', '>', '!']) && entry(word).is_none()
}

/// A pattern of pairs; all of them where none is given.
fn pattern<'w>(rest: &'w [String], names: &Names<'_>) -> Result<(String, &'w [String]), QuantityError> {
    match rest.split_first() {
        Some((pattern, rest)) if goes_on(pattern) => {
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

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use super::*;
    use crate::model::quantity::{OfNode, read_text};
    use crate::model::structure::{Plate, Structure};

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
            dimension: Dimension::Plane,
        }
    }

    fn words(text: &str) -> Vec<String> {
        shlex::split(text).unwrap()
    }

    #[test]
    fn every_quantity_reads_and_writes_itself() {
        let probes = [("nozzle moment".to_owned(), Quantity::Bar(Internal::Moment, "AB".into(), BarPlace::Start))];
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
            "max mises",
            "min s2 lower",
            "stage 1 max sxy lower",
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
        // σ_xy = σ_yx: what is read is one quantity.
        assert_eq!(read(&words("syx B"), &names).unwrap().0, read(&words("sxy B"), &names).unwrap().0);
        assert_eq!(read(&words("\"nozzle moment\" < 20"), &names).unwrap().1, ["<", "20"]);
        assert_eq!(read(&words("count open = 3"), &names).unwrap().1, ["=", "3"]);
    }

    /// Quoted as a whole or not, with the name of a node in quotes inside, a probe with blanks in its name.
    #[test]
    fn quotation_marks_hold_together_what_they_hold() {
        let probe = |name: &str| (name.to_owned(), Quantity::Node(OfNode::M, "B".into()));
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
    fn a_wrong_place_on_a_bar_is_told_as_one() {
        let names = names(&[]);
        let error = |text: &str| read_text(text, &names).expect_err(text).to_string();
        assert_eq!(
            error("M AB ende"),
            "`ende` after `M AB` (did you mean `end`?): expected `at DISTANCE`, `start` or `end`, or another quantity"
        );
        assert!(error("x_n c1 ende").contains("unknown quantity `ende`"));
        assert!(error("M AB, ende").contains("unknown quantity `ende`"));
        assert!(error("M AB x_n c9").contains("no pair `c9`"));
    }

    #[test]
    fn unknown_words_and_names_are_told() {
        let names = names(&[]);
        for (text, part) in [
            ("xn c1", "unknown quantity `xn` (did you mean `x_n`?)"),
            ("x_n c9", "no pair `c9`"),
            ("x_n joint[*]", "put sum, max or min before it"),
            ("x_n", "`x_n` of what? Write `x_n PAIR`"),
            ("x_n = 3", "`x_n` of what? Write `x_n PAIR`"),
            ("F2", "`F2` is a parameter, not a quantity of the answer: `params` shows its value"),
            ("M CD", "no bar `CD`"),
            ("M AB at x", "`x` is not a distance"),
            ("sum M AB", "expected a number of pairs"),
            ("sum mises", "expected a number of pairs"),
            ("max mises lowr", "no plate, brick or mesh `lowr` (did you mean `lower`?)"),
            ("max s3", "`s3` is a quantity of space"),
            ("sum x_n d*", "no pair `d*`"),
            ("count opne", "no state `opne` (did you mean `open`?)"),
            ("count slip", "no state `slip` (did you mean `slip+`"),
            ("max Mz AB", "`Mz` is a quantity of space, and this structure lies in the plane"),
            ("x_t1 c1", "`x_t1` is a quantity of space, and this structure lies in the plane"),
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
}
