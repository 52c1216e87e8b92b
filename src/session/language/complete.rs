//! Completion and hints: the place in a line, and what the command that stands there says may follow.

use crate::session::commands;
use crate::session::language::command::Command;
use crate::session::language::grammar::resolve;
use crate::session::language::tokens;
use crate::session::language::topics::TOPICS;

use super::candidates::{Asked, MOST};
pub use super::candidates::{Candidate, Vocabulary};

/// The word at the cursor may be replaced by one of the candidates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// Byte where the word starts.
    pub start: usize,
    /// The candidates, in alphabetical order.
    pub candidates: Vec<Candidate>,
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
        return None; // after a `#`
    }
    let command = &head[from..];
    let start = command.char_indices().rev().find(|(_, c)| c.is_whitespace()).map_or(0, |(at, c)| at + c.len_utf8());
    let before = tokens::split(&command[..start]).ok()?;
    Some(Place { before, word: &command[start..], start: from + start })
}

/// The names of the commands.
fn commands() -> Vec<Candidate> {
    commands::all().map(|command| Candidate::new(command.name, command.about())).collect()
}

/// The ways to complete the word that ends at byte `position` of `line`.
pub fn completions(line: &str, position: usize, vocabulary: &Vocabulary) -> Completion {
    let Some(place) = place(line, position) else {
        return Completion::default();
    };
    let mut candidates = match place.before.split_first() {
        None => commands(),
        Some((first, given)) => resolve(first).map_or_else(
            |_| Vec::new(),
            |command| arguments(command, Asked { given, word: place.word, option: None, names: vocabulary }),
        ),
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
    /// `None` where there is nothing to say.
    fn of(insert: impl Into<String>, note: impl Into<String>) -> Option<Self> {
        Some(Hint { insert: insert.into(), note: note.into() }).filter(|hint| *hint != Hint::default())
    }

    /// Both together, as shown.
    pub fn text(&self) -> String {
        format!("{}{}", self.insert, self.note)
    }
}

/// What could follow the end of `line`, in grey: the rest of the only command that fits, or the arguments of the
/// command that stands there.
pub fn hint(line: &str, vocabulary: &Vocabulary) -> Option<Hint> {
    let Place { before, word, .. } = place(line, line.len())?;
    let Some((first, given)) = before.split_first() else {
        let command = resolve(word).ok()?;
        let usage = usage(command);
        let note = if usage.is_empty() { usage } else { format!(" {usage}") };
        return Hint::of(command.name.strip_prefix(word)?, note);
    };
    let command = resolve(first).ok()?;
    if !word.is_empty() {
        let found = completions(line, line.len(), vocabulary).candidates;
        return match found.as_slice() {
            [only] => Hint::of(&only.text[word.len()..], ""),
            _ => None,
        };
    }
    match (command.offer)(&Asked { given, word, option: None, names: vocabulary }) {
        Some(offered) => Hint::of(offered, ""),
        None if given.is_empty() => Hint::of("", usage(command)),
        None => None,
    }
}

/// `PAIR`, `[FROM..TO]`: the positional arguments of a command.
fn usage(command: &Command) -> String {
    if let Some(usage) = command.usage {
        return usage.to_owned();
    }
    let words: Vec<String> = command
        .grammar()
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

/// What may stand at a place among the words of a command.
fn arguments(command: &Command, asked: Asked<'_>) -> Vec<Candidate> {
    let grammar = command.grammar();
    let options = || grammar.get_arguments().filter_map(|argument| Some((argument.get_long()?, argument)));
    let option = asked.given.last().and_then(|last| last.strip_prefix("--"));
    if let Some((long, argument)) =
        options().find(|(long, argument)| Some(*long) == option && argument.get_action().takes_values())
    {
        return values(command, argument, &Asked { option: Some(long), ..asked });
    }
    let mut candidates: Vec<Candidate> = if asked.word.starts_with('-') {
        options().map(|(long, argument)| Candidate::new(format!("--{long}"), about(argument.get_help()))).collect()
    } else {
        Vec::new()
    };
    let mut given_positionals = 0;
    let mut skip = false;
    for word in asked.given {
        if skip {
            skip = false;
        } else if word.starts_with("--") && options().next().is_some() {
            skip = !word.contains('=');
        } else {
            given_positionals += 1;
        }
    }
    let positionals: Vec<&clap::Arg> = grammar.get_positionals().collect();
    let at = positionals
        .get(given_positionals)
        .or_else(|| positionals.last().filter(|last| last.get_num_args().is_some_and(|n| n.max_values() > 1)));
    if let Some(argument) = at {
        candidates.extend(values(command, argument, &asked));
    }
    candidates
}

/// What an argument may be: one of a closed list of words, a file, or what the command says.
fn values(command: &Command, argument: &clap::Arg, asked: &Asked<'_>) -> Vec<Candidate> {
    let possible = argument.get_possible_values();
    if !possible.is_empty() {
        return possible.iter().map(|value| Candidate::new(value.get_name(), about(value.get_help()))).collect();
    }
    match value_name(argument).as_str() {
        "FILE" => {
            let mut all = asked.files();
            if asked.word.is_empty() && asked.given.is_empty() {
                all.retain(|file| !file.text.starts_with('.'));
            }
            all
        }
        "COMMAND" => {
            let topics = TOPICS.iter().map(|topic| Candidate::new(topic.name, topic.about));
            commands().into_iter().chain(topics).collect()
        }
        _ => (command.complete)(asked),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::structure::Dimension;

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
            bodies: vec!["lower".into()],
            combinations: vec!["ULS1".into()],
            dimension: Dimension::Plane,
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

    /// What is not there is not offered: words of space in the plane, of the plane in space.
    #[test]
    fn in_space_there_are_the_words_of_space() {
        let vocabulary = Vocabulary { dimension: Dimension::Space, ..vocabulary() };
        let at_end = |line: &str| -> Vec<String> {
            let found = completions(line, line.len(), &vocabulary).candidates;
            found.into_iter().map(|candidate| candidate.text).collect()
        };
        assert_eq!(at_end("pairs c1 sort z_"), ["z_n", "z_t", "z_t1", "z_t2"]);
        assert_eq!(at_end("pairs c1 sort reserve"), ["reserve"]);
        assert_eq!(at_end("displacements sort r"), ["rx", "ry", "rz"]);
        assert_eq!(at_end("members sort M"), ["My", "Mz"]);
        assert_eq!(at_end("expect state c1 slip"), ["slip"]);
        assert_eq!(at_end("show count sl"), ["slip"]);
        assert_eq!(at_end("show max M"), ["My", "Mz"]);
        assert_eq!(at_end("reset co"), ["cone", "covering"]);
        assert_eq!(at_end("show u"), ["unknowns", "ux", "uy", "uz"]);
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
