//! What may stand at a place of a line: completion and hints, from the grammar and the names of the session.
//!
//! The grammar says by the `value_name` of an argument which names fit (see [`names_of`]).

use std::fs;
use std::path::Path;

use crate::model::embedded;
use crate::model::parameter::ParameterValues;
use crate::model::quantity::Names;
use crate::model::rules::Covering;
use crate::model::scenario::{Scenario, Source};
use crate::model::template;

use crate::session::language::command;
use crate::session::language::expect;
use crate::session::language::selection::{DISPLACEMENT_KEYS, MEMBER_KEYS, SORT_KEYS};
use crate::session::{Session, commands::quantities, language::tokens};

/// Never more candidates than this are offered.
const MOST: usize = 500;

/// The names of a session that can be completed: a copy, so that an editor can hold it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vocabulary {
    /// Parameters and their present values.
    pub parameters: Vec<(String, f64)>,
    /// Pair ids.
    pub pairs: Vec<String>,
    /// Node ids.
    pub nodes: Vec<String>,
    /// Bar ids.
    pub bars: Vec<String>,
    /// Load cases.
    pub cases: Vec<String>,
    /// Edge contacts.
    pub joints: Vec<String>,
    /// Probes.
    pub probes: Vec<String>,
    /// Ids of triangles and quads.
    pub elements: Vec<String>,
    /// Load combinations.
    pub combinations: Vec<String>,
}

/// One way to go on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Replaces the word.
    pub text: String,
    /// What it is, in a few words; may be empty.
    pub about: String,
}

/// The word at the cursor may be replaced by one of the candidates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// Byte where the word starts.
    pub start: usize,
    /// The candidates, in alphabetical order.
    pub candidates: Vec<Candidate>,
}

impl Session {
    /// The names that can be completed now.
    pub fn vocabulary(&self) -> Vocabulary {
        vocabulary(self.scenario(), self.values())
    }
}

/// The names of a scenario under these values.
pub fn vocabulary(scenario: &Scenario, values: &ParameterValues) -> Vocabulary {
    let (nodes, bars, elements) = match &scenario.source {
        Source::Structure(structure) => (
            structure.nodes.iter().map(|node| node.id.clone()).collect(),
            structure.bars.iter().map(|bar| bar.id.clone()).collect(),
            structure.named_elements.iter().map(|(id, _)| id.clone()).collect(),
        ),
        _ => (Vec::new(), Vec::new(), Vec::new()),
    };
    let pairs = match &scenario.source {
        Source::Structure(structure) => structure.pairs.iter().map(|pair| pair.id.clone()).collect(),
        Source::ContactSystem(system) => system.pairs.clone(),
        Source::Lcp(_) => Vec::new(),
    };
    let cases = match &scenario.source {
        Source::Structure(structure) => structure.load_cases.iter().map(|case| case.name.clone()).collect(),
        Source::ContactSystem(system) => system.loads.iter().map(|load| load.name.clone()).collect(),
        Source::Lcp(_) => Vec::new(),
    };
    Vocabulary {
        joints: Names::of(scenario).joints().into_iter().map(str::to_owned).collect(),
        probes: scenario.probes.iter().map(|(name, _)| name.clone()).collect(),
        combinations: scenario.combinations.iter().map(|(name, _)| name.clone()).collect(),
        parameters: values.free().map(|(name, value)| (name.clone(), value)).collect(),
        pairs,
        nodes,
        bars,
        elements,
        cases,
    }
}

/// The start of the line up to the cursor, taken apart.
struct Place<'a> {
    /// Words of the command before the one at the cursor.
    before: Vec<String>,
    /// The word at the cursor, as typed, up to the cursor.
    word: &'a str,
    /// Its first byte.
    start: usize,
}

/// `None` inside a comment or a quotation.
fn place(line: &str, position: usize) -> Option<Place<'_>> {
    let head = line.get(..position)?;
    let (from, to) = *tokens::spans(head).last()?;
    if to < head.len() {
        return None; // behind a `#`
    }
    let command = &head[from..];
    let start = command.char_indices().rev().find(|(_, c)| c.is_whitespace()).map_or(0, |(at, c)| at + c.len_utf8());
    let before = tokens::split(&command[..start]).ok()?;
    Some(Place { before, word: &command[start..], start: from + start })
}

/// The ways to complete the word that ends at byte `position` of `line`.
pub fn completions(line: &str, position: usize, vocabulary: &Vocabulary) -> Completion {
    let Some(place) = place(line, position) else {
        return Completion::default();
    };
    let mut candidates = match place.before.split_first() {
        None => command::grammar()
            .get_subcommands()
            .map(|command| candidate(command.get_name(), about(command.get_about())))
            .collect(),
        Some((first, given)) => match command::resolve(first) {
            Ok(name) => arguments(&name, given, place.word, vocabulary),
            Err(_) => Vec::new(),
        },
    };
    candidates.retain(|candidate| candidate.text.starts_with(place.word));
    candidates.sort_by(|a, b| a.text.cmp(&b.text));
    candidates.dedup_by(|a, b| a.text == b.text);
    candidates.truncate(MOST);
    Completion { start: place.start, candidates }
}

/// What could follow the end of a line.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hint {
    /// Would be typed as it stands.
    pub insert: String,
    /// Says what comes then: `PAIR`, `[FROM..TO]`.
    pub note: String,
}

impl Hint {
    fn insert(text: impl Into<String>) -> Option<Self> {
        Some(Hint { insert: text.into(), note: String::new() }).filter(|hint| !hint.insert.is_empty())
    }

    /// Both together, as shown.
    pub fn text(&self) -> String {
        format!("{}{}", self.insert, self.note)
    }
}

/// What could follow the end of `line`, in grey: the rest of the only command that fits, or the arguments of the
/// command that stands there.
pub fn hint(line: &str, vocabulary: &Vocabulary) -> Option<Hint> {
    let place = place(line, line.len())?;
    if place.before.is_empty() {
        if place.word.is_empty() {
            return None;
        }
        let name = command::resolve(place.word).ok()?;
        let rest = name.strip_prefix(place.word)?;
        let usage = usage(&name);
        let note = if usage.is_empty() { usage } else { format!(" {usage}") };
        return Some(Hint { insert: rest.to_owned(), note }).filter(|hint| *hint != Hint::default());
    }
    let name = command::resolve(&place.before[0]).ok()?;
    if !place.word.is_empty() {
        let found = completions(line, line.len(), vocabulary).candidates;
        return match found.as_slice() {
            [only] if only.text.len() > place.word.len() => Hint::insert(&only.text[place.word.len()..]),
            _ => None,
        };
    }
    match (name.as_str(), &place.before[1..]) {
        ("set", [parameter]) => vocabulary
            .parameters
            .iter()
            .find(|(name, _)| name == parameter)
            .and_then(|(_, value)| Hint::insert(value.to_string())),
        (_, []) => Some(Hint { insert: String::new(), note: usage(&name) }).filter(|hint| !hint.note.is_empty()),
        _ => None,
    }
}

/// `PAIR`, `[FROM..TO]`: the positional arguments of a command.
fn usage(name: &str) -> String {
    let grammar = command::grammar();
    let Some(command) = grammar.find_subcommand(name) else {
        return String::new();
    };
    match name {
        "set" => return "NAME VALUE".to_owned(),
        "new" => return "KIND [NAME=VALUE…] [FILE]".to_owned(),
        "step" => return "[N|back N|to K|first|last]".to_owned(),
        "pairs" => return "[PAIR…] [sort KEY]".to_owned(),
        "pivots" => return "[FROM..TO]".to_owned(),
        "export" => return "WHAT [OF] FILE".to_owned(),
        _ => {}
    }
    let words: Vec<String> = command
        .get_positionals()
        .map(|argument| {
            let name = value_name(argument);
            if argument.is_required_set() { name } else { format!("[{name}]") }
        })
        .collect();
    words.join(" ")
}

fn value_name(argument: &clap::Arg) -> String {
    argument.get_value_names().and_then(|names| names.first()).map(ToString::to_string).unwrap_or_default()
}

fn about(text: Option<&clap::builder::StyledStr>) -> String {
    text.map(ToString::to_string).unwrap_or_default()
}

fn candidate(text: impl Into<String>, about: impl Into<String>) -> Candidate {
    Candidate { text: text.into(), about: about.into() }
}

/// What may follow the words `given` of the command `name`.
fn arguments(name: &str, given: &[String], word: &str, vocabulary: &Vocabulary) -> Vec<Candidate> {
    let grammar = command::grammar();
    let Some(command) = grammar.find_subcommand(name) else {
        return Vec::new();
    };
    let options = || command.get_arguments().filter_map(|argument| Some((argument.get_long()?, argument)));
    // the value of an option
    if let Some(option) = given.last().and_then(|last| last.strip_prefix("--"))
        && let Some((_, argument)) = options().find(|(long, _)| *long == option)
    {
        return values(argument, given, vocabulary, word);
    }
    let mut candidates: Vec<Candidate> = if word.starts_with('-') {
        options().map(|(long, argument)| candidate(format!("--{long}"), about(argument.get_help()))).collect()
    } else {
        Vec::new()
    };
    let mut given_positionals = 0;
    let mut skip = false;
    for word in given {
        if skip {
            skip = false;
        } else if word.starts_with("--") && options().next().is_some() {
            skip = !word.contains('=');
        } else {
            given_positionals += 1;
        }
    }
    let positionals: Vec<&clap::Arg> = command.get_positionals().collect();
    let at = positionals
        .get(given_positionals)
        .or_else(|| positionals.last().filter(|last| last.get_num_args().is_some_and(|n| n.max_values() > 1)));
    if let Some(argument) = at {
        candidates.extend(values(argument, given, vocabulary, word));
    }
    candidates
}

/// What an argument may be.
fn values(argument: &clap::Arg, given: &[String], vocabulary: &Vocabulary, word: &str) -> Vec<Candidate> {
    let possible = argument.get_possible_values();
    if !possible.is_empty() {
        return possible.iter().map(|value| candidate(value.get_name(), about(value.get_help()))).collect();
    }
    names_of(&value_name(argument), given, vocabulary, word)
}

/// What may follow `plot path` and the words after it.
fn of_path(given: &[String], vocabulary: &Vocabulary) -> Vec<Candidate> {
    if given.last().is_some_and(|word| word == "over") {
        return vocabulary.cases.iter().map(|case| candidate(case, "load case")).collect();
    }
    let words = ["slip", "force", "gap", "pressure", "over"];
    let pairs = vocabulary.pairs.iter().map(String::as_str);
    pairs.chain(words).map(|word| candidate(word, "")).collect()
}

/// What can be chosen of the kind that follows `new`, but for what was chosen already.
fn of_template(given: &[String]) -> Vec<Candidate> {
    let Some(template) = given.first().and_then(|kind| template::find(kind).ok()) else {
        return Vec::new();
    };
    let Ok(scenario) = template.default_scenario() else {
        return Vec::new();
    };
    let chosen = |name: &str| given.iter().any(|word| word.split_once('=').is_some_and(|(known, _)| known == name));
    let choices = template.choices(&scenario).into_iter().filter(|choice| !chosen(&choice.name));
    choices.map(|choice| candidate(format!("{}=", choice.name), choice.about)).collect()
}

/// The names behind a `value_name` of the grammar.
fn names_of(kind: &str, given: &[String], vocabulary: &Vocabulary, word: &str) -> Vec<Candidate> {
    let plain = |names: &[String]| names.iter().map(|name| candidate(name, "")).collect::<Vec<_>>();
    let fixed = |names: &[&str]| names.iter().map(|name| candidate(*name, "")).collect::<Vec<_>>();
    let parameters =
        || vocabulary.parameters.iter().map(|(name, value)| candidate(name, value.to_string())).collect::<Vec<_>>();
    let rules = [
        ("auto", "solve after each change"),
        ("covering", "covering vector"),
        ("engine", "implementation of Lemke's algorithm"),
        ("tie-break", "what decides among tied rows"),
    ];
    let rules = || rules.iter().map(|(name, about)| candidate(*name, *about)).collect::<Vec<_>>();
    match kind {
        "SCENARIO" => {
            let mut all: Vec<Candidate> =
                embedded::list().into_iter().map(|(name, title)| candidate(name, title)).collect();
            all.extend(files(word));
            all
        }
        "KIND" => template::ALL.iter().map(|template| candidate(template.kind, "")).collect(),
        "NAME=VALUE FILE" => of_template(given).into_iter().chain(files(word)).collect(),
        "FILE" => {
            let mut all = files(word);
            if word.is_empty() && given.is_empty() {
                all.retain(|file| !file.text.starts_with('.'));
            }
            all
        }
        "PARAMETER" => {
            let mut all = parameters();
            all.extend(rules().into_iter().filter(|rule| rule.text != "auto"));
            all
        }
        "SETTING" => match given {
            [] => {
                let mut all = parameters();
                all.extend(rules());
                all
            }
            [name] => match name.as_str() {
                "covering" => Covering::ALL.iter().map(|c| candidate(c.to_string(), "")).collect(),
                "tie-break" => fixed(&["lexicographic", "natural", "first-row", "random:"]),
                "engine" => fixed(&["scheme", "tableau", "exact"]),
                "auto" => fixed(&["on", "off"]),
                _ => fixed(&["+=", "-=", "*=", "/="]),
            },
            _ => Vec::new(),
        },
        "OF FILE" => {
            let (what, of) = given.split_first().map_or(("", given), |(what, of)| (what.as_str(), of));
            let mut all = files(word);
            all.extend(match what {
                "quantities" | "envelope" => plain(&quantities::next_names(of, vocabulary)),
                "sensitivity" => parameters(),
                "moment" | "shear" | "axial" => plain(&vocabulary.bars),
                "slip" | "force" | "gap" | "pressure" => fixed(&["first", "last"]),
                "path" => of_path(of, vocabulary),
                _ => Vec::new(),
            });
            all
        }
        "TRACED" | "LOAD" => {
            let mut all = parameters();
            all.extend(vocabulary.cases.iter().map(|case| candidate(case, "load case")));
            all
        }
        "to VALUE" => match given {
            [_] => fixed(&["to", "of"]),
            [_, to, _] if to == "to" => fixed(&["of"]),
            [_, to, _, of, rest @ ..] if to == "to" && of == "of" => plain(&quantities::next_names(rest, vocabulary)),
            [_, of, rest @ ..] if of == "of" => plain(&quantities::next_names(rest, vocabulary)),
            _ => Vec::new(),
        },
        "FOUND" => found(given, vocabulary, &|| {
            let mut all = parameters();
            all.extend(vocabulary.cases.iter().map(|case| candidate(case, "load case")));
            all
        }),
        "MAPPED" => match given.iter().position(|word| word == "of") {
            Some(at) => plain(&quantities::next_names(&given[at + 1..], vocabulary)),
            None => {
                let mut all = parameters();
                all.extend(vocabulary.cases.iter().map(|case| candidate(case, "load case")));
                all.extend(fixed(&["of"]).into_iter().filter(|_| !given.is_empty()));
                all
            }
        },
        "NAME" | "SWEPT" => parameters(),
        "OF" => match given.first().map(String::as_str) {
            Some("path") => of_path(&given[1..], vocabulary),
            Some("moment" | "shear" | "axial") => plain(&vocabulary.bars),
            _ => Vec::new(),
        },
        "PAIR" => plain(&vocabulary.pairs),
        "PAIRS" | "NODES" | "BARS" => {
            let (names, keys) = match kind {
                "PAIRS" => (&vocabulary.pairs, SORT_KEYS),
                "NODES" => (&vocabulary.nodes, DISPLACEMENT_KEYS),
                _ => (&vocabulary.bars, MEMBER_KEYS),
            };
            match given.last().map(String::as_str) {
                Some("sort") => fixed(keys),
                Some("top") => Vec::new(),
                _ => {
                    let mut all = plain(names);
                    all.extend([candidate("sort", "by a column"), candidate("top", "the first rows")]);
                    all
                }
            }
        }
        "STEP" => match given {
            [] => fixed(&["back", "to", "first", "last"]),
            _ => Vec::new(),
        },
        "PIVOTS" => fixed(&["first", "last", "first,last"]),
        "COMMAND" => command::grammar()
            .get_subcommands()
            .map(|command| candidate(command.get_name(), about(command.get_about())))
            .collect(),
        "EXPECTATION" => match given {
            [] => {
                let mut all: Vec<Candidate> = expect::subjects().map(|word| candidate(word, "")).collect();
                all.extend(quantities::next_names(given, vocabulary).into_iter().map(|name| candidate(name, "")));
                all
            }
            [subject] if subject != "state" && !expect::choices(subject).is_empty() => fixed(expect::choices(subject)),
            [.., subject, _] if subject == "state" => fixed(expect::choices("state")),
            given => quantities::next_names(given, vocabulary).into_iter().map(|name| candidate(name, "")).collect(),
        },
        "QUANTITY" if given.iter().any(|word| word == "over") => {
            let mut all = parameters();
            all.extend(vocabulary.cases.iter().map(|case| candidate(case, "load case")));
            all.extend(fixed(&["combinations"]));
            all
        }
        "QUANTITY" => {
            let mut all = plain(&quantities::next_names(given, vocabulary));
            all.extend(fixed(&["over"]).into_iter().filter(|_| !given.is_empty()));
            all
        }
        "COMBINATION" => plain(&vocabulary.combinations),
        _ => Vec::new(),
    }
}

/// What may follow the words of `find`.
fn found(given: &[String], vocabulary: &Vocabulary, names: &dyn Fn() -> Vec<Candidate>) -> Vec<Candidate> {
    let plain = |names: Vec<String>| names.iter().map(|name| candidate(name, "")).collect::<Vec<_>>();
    if let Some(at) = given.iter().position(|word| word == "where") {
        return match &given[at + 1..] {
            [subject, _] if subject == "state" => plain(vec!["=".to_owned()]),
            [.., subject, sign] if sign == "=" && !expect::choices(subject).is_empty() => {
                plain(expect::choices(subject).iter().map(|word| (*word).to_owned()).collect())
            }
            [subject, _, sign] if sign == "=" && subject == "state" => {
                plain(expect::choices("state").iter().map(|word| (*word).to_owned()).collect())
            }
            rest => plain(quantities::next_names(rest, vocabulary)),
        };
    }
    let is_extreme = |word: &String| word == "least" || word == "most";
    let rest = if given.first().is_some_and(is_extreme) { &given[1..] } else { given };
    match rest {
        [] => {
            let mut all = names();
            if given.is_empty() {
                all.extend([candidate("least", "the first value with an answer"), candidate("most", "the last one")]);
            }
            all
        }
        _ => vec![candidate("where", "the condition")],
    }
}

/// Files and folders that begin as the word does; folders end in a slash.
fn files(word: &str) -> Vec<Candidate> {
    let (folder, typed) = match word.rfind('/') {
        Some(at) => (&word[..=at], &word[at + 1..]),
        None => ("", word),
    };
    let here = if folder.is_empty() { "." } else { folder };
    let Ok(entries) = fs::read_dir(Path::new(here)) else {
        return Vec::new();
    };
    entries
        .flatten()
        .take(10_000)
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            if !name.starts_with(typed) || (name.starts_with('.') && !typed.starts_with('.')) {
                return None;
            }
            let slash = if entry.path().is_dir() { "/" } else { "" };
            // a name that needs quotation marks cannot be completed piece by piece: leave it out
            let plain = tokens::quote(&name) == name;
            plain.then(|| candidate(format!("{folder}{name}{slash}"), ""))
        })
        .take(MOST)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vocabulary() -> Vocabulary {
        Vocabulary {
            parameters: vec![("f".into(), 0.3), ("F2".into(), 100.0)],
            pairs: vec!["c1".into(), "c2".into(), "joint[0]".into()],
            nodes: vec!["A".into(), "B".into()],
            bars: vec!["AB".into()],
            cases: vec!["pull".into()],
            joints: vec!["joint".into()],
            probes: vec!["nozzle moment".into()],
            elements: vec!["q1".into()],
            combinations: vec!["ULS1".into()],
        }
    }

    fn at_end(line: &str) -> Vec<String> {
        completions(line, line.len(), &vocabulary()).candidates.into_iter().map(|candidate| candidate.text).collect()
    }

    #[test]
    fn each_place_gets_its_names() {
        assert_eq!(at_end("pa"), ["pairs", "params"]);
        assert_eq!(at_end("set F"), ["F2"]);
        assert_eq!(at_end("set covering w"), ["weight"]);
        assert_eq!(at_end("pairs c"), ["c1", "c2"]);
        assert_eq!(at_end("pairs c1 sort z_"), ["z_n", "z_t"]);
        assert_eq!(at_end("why j"), ["joint[0]"]);
        assert_eq!(at_end("members A"), ["AB"]);
        assert_eq!(at_end("expect state c1 slip"), ["slip+", "slip-"]);
        assert_eq!(at_end("expect x_n "), ["c1", "c2", "joint[0]"]);
        assert_eq!(at_end("plot sl"), ["slip"]);
        assert_eq!(at_end("plot slip --w"), ["--width"]);
        assert_eq!(at_end("plot slip --at f"), ["first", "first,last"]);
        assert_eq!(at_end("help se"), ["sensitivity", "set"]);
        assert_eq!(at_end("trace p"), ["pull"]);
        assert_eq!(at_end("find le"), ["least"]);
        assert_eq!(at_end("find least p"), ["pull"]);
        assert_eq!(at_end("find f 0..1 w"), ["where"]);
        assert_eq!(at_end("find f where x_n "), ["c1", "c2", "joint[0]"]);
        assert_eq!(at_end("find f where state c1 = slip"), ["slip+", "slip-"]);
        assert_eq!(at_end("envelope x_n c1 over p"), ["pull"]);
        assert_eq!(at_end("trace pull t"), ["to"]);
        assert_eq!(at_end("plot path fo"), ["force"]);
        assert_eq!(at_end("load beam-r"), ["beam-ray"]);
        assert_eq!(at_end("set f 0.3; wh"), ["why"]);
        assert_eq!(at_end("reset co"), ["covering"]);
        assert!(at_end("pairs # c").is_empty());
        assert!(at_end("echo \"pa").is_empty());
        assert!(at_end("bogus c").is_empty());
    }

    #[test]
    fn the_start_of_the_word_is_told() {
        let line = "status; set F";
        assert_eq!(completions(line, line.len(), &vocabulary()).start, 12);
    }

    #[test]
    fn hints_say_what_follows() {
        let hint = |line: &str| hint(line, &vocabulary()).map(|hint| (hint.insert, hint.note));
        let both = |insert: &str, note: &str| Some((insert.to_owned(), note.to_owned()));
        assert_eq!(hint("piv"), both("ots", " [FROM..TO]"));
        assert_eq!(hint("set F2 "), both("100", ""));
        assert_eq!(hint("why "), both("", "PAIR"));
        assert_eq!(hint("set covering w"), both("eight", ""));
        assert_eq!(hint(""), None);
        assert_eq!(hint("p"), None);
    }

    #[test]
    fn no_place_of_a_line_is_too_strange() {
        for line in ["set ü é", "\"", "a;;;b", "pairs \u{2003}c"] {
            for position in 0..=line.len() + 1 {
                let _ = completions(line, position, &vocabulary());
            }
            let _ = hint(line, &vocabulary());
        }
    }
}
