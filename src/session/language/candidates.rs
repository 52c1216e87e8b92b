//! What may stand at a place of a line: the names of the session, and how a command asks for them.

use std::fs;
use std::path::Path;

use crate::model::parameter::ParameterValues;
use crate::model::quantity::Names;
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Dimension;
use crate::session::Session;
use crate::session::language::tokens;

/// Never more candidates than this are offered.
pub(super) const MOST: usize = 500;

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
    /// Plates, bricks, meshes and their parts.
    pub bodies: Vec<String>,
    /// Load combinations.
    pub combinations: Vec<String>,
    /// Where the pairs and the nodes lie.
    pub dimension: Dimension,
}

impl Vocabulary {
    /// The names of a scenario under these values.
    pub fn of(scenario: &Scenario, values: &ParameterValues) -> Vocabulary {
        let mut names = Vocabulary {
            joints: Names::of(scenario).joints().into_iter().map(str::to_owned).collect(),
            probes: scenario.probes.iter().map(|(name, _)| name.clone()).collect(),
            combinations: scenario.combinations.iter().map(|(name, _)| name.clone()).collect(),
            dimension: scenario.source.dimension(),
            parameters: values.free().map(|(name, value)| (name.clone(), value)).collect(),
            ..Vocabulary::default()
        };
        match &scenario.source {
            Source::Structure(structure) => {
                names.pairs = structure.pairs.iter().map(|pair| pair.id.clone()).collect();
                names.nodes = structure.nodes.iter().map(|node| node.id.clone()).collect();
                names.bars = structure.bars.iter().map(|bar| bar.id.clone()).collect();
                names.elements = structure.named_elements.iter().map(|(id, _)| id.clone()).collect();
                names.bodies = structure.bodies().into_iter().map(str::to_owned).collect();
                names.cases = structure.load_cases.iter().map(|case| case.name.clone()).collect();
            }
            Source::ContactSystem(system) => {
                names.pairs.clone_from(&system.pairs);
                names.cases = system.loads.iter().map(|load| load.name.clone()).collect();
            }
            Source::Lcp(_) => {}
        }
        names
    }
}

impl Session {
    /// The names that can be completed now.
    pub fn vocabulary(&self) -> Vocabulary {
        Vocabulary::of(self.scenario(), self.values())
    }
}

/// One way to go on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Replaces the word.
    pub text: String,
    /// What it is, in a few words; may be empty.
    pub about: String,
}

impl Candidate {
    /// With a few words on what it is.
    pub fn new(text: impl Into<String>, about: impl Into<String>) -> Candidate {
        Candidate { text: text.into(), about: about.into() }
    }

    /// Names that speak for themselves.
    pub fn plain<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> Vec<Candidate> {
        names.into_iter().map(|name| Candidate::new(name.as_ref(), "")).collect()
    }
}

/// A place among the words of a command, and the names that there are.
pub struct Asked<'a> {
    /// The words before it, without the name of the command.
    pub given: &'a [String],
    /// The word at the cursor, up to it.
    pub word: &'a str,
    /// The option whose value stands there, without its dashes.
    pub option: Option<&'a str>,
    /// The names.
    pub names: &'a Vocabulary,
}

impl Asked<'_> {
    /// Parameters, with their present values.
    pub fn parameters(&self) -> Vec<Candidate> {
        self.names.parameters.iter().map(|(name, value)| Candidate::new(name, value.to_string())).collect()
    }

    /// Load cases.
    pub fn cases(&self) -> Vec<Candidate> {
        self.names.cases.iter().map(|case| Candidate::new(case, "load case")).collect()
    }

    /// What a path or a range may go over: parameters and load cases.
    pub fn varied(&self) -> Vec<Candidate> {
        let mut all = self.parameters();
        all.extend(self.cases());
        all
    }

    /// Files and folders that begin as the word does; folders end in a slash.
    pub fn files(&self) -> Vec<Candidate> {
        let (folder, typed) = match self.word.rfind('/') {
            Some(at) => (&self.word[..=at], &self.word[at + 1..]),
            None => ("", self.word),
        };
        let here = if folder.is_empty() { "." } else { folder };
        let Ok(entries) = fs::read_dir(Path::new(here)) else {
            return Vec::new();
        };
        let candidate = |entry: fs::DirEntry| {
            let name = entry.file_name().into_string().ok()?;
            if !name.starts_with(typed) || (name.starts_with('.') && !typed.starts_with('.')) {
                return None;
            }
            let slash = if entry.path().is_dir() { "/" } else { "" };
            // a name that needs quotation marks cannot be completed piece by piece: leave it out
            let plain = tokens::quote(&name) == name;
            plain.then(|| Candidate::new(format!("{folder}{name}{slash}"), ""))
        };
        entries.flatten().take(10_000).filter_map(candidate).take(MOST).collect()
    }

    /// Names, then `sort KEY` and `top N`.
    pub fn rows(&self, names: &[String], keys: &[&str]) -> Vec<Candidate> {
        match self.given.last().map(String::as_str) {
            Some("sort") => Candidate::plain(keys),
            Some("top") => Vec::new(),
            _ => {
                let mut all = Candidate::plain(names);
                all.extend([Candidate::new("sort", "by a column"), Candidate::new("top", "the first rows")]);
                all
            }
        }
    }
}
