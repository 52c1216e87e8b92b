//! Typed reading of a JSON tree that goes on after a problem, so that one pass finds them all.
//!
//! A [`Cursor`] stands on one value. Its accessors return `None` after having reported what is wrong at that
//! place; the caller leaves the part out and reads on.

use std::cell::{Cell, OnceCell, RefCell};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::PathBuf;

use super::declared::Parameters;
pub use super::findings::{Findings, Place};
use super::name_table::NameTable;
use super::words::shortened;
use super::words::{counted, did_you_mean, listed, quoted};
use crate::model::dimension::Dimension;
use crate::model::locate::Document;
use crate::model::mesh::MeshFiles;
use crate::model::tree::{Kind, Node};
use crate::model::uses::Region;

/// Up to so many keys are compared with one another, one by one.
const FEW: usize = 16;

/// What one reading of a text collects, besides what it returns.
#[derive(Default)]
pub struct Reading {
    pub findings: Findings,
    /// Set once, before the numbers that may name them are read.
    pub parameters: OnceCell<Parameters>,
    /// A byte offset for every name of a parameter in every region.
    pub uses: RefCell<BTreeMap<(String, Region), usize>>,
    /// Whether points and vectors have two numbers or three.
    pub dimension: Cell<Dimension>,
    /// The file of the scenario: others are named relative to it.
    pub path: Option<PathBuf>,
    /// Meshes read so far.
    pub meshes: RefCell<MeshFiles>,
}

/// A position in the tree: one value, and the region whose numbers are read from it.
#[derive(Clone, Copy)]
pub struct Cursor<'d> {
    pub(super) value: Node<'d>,
    pub(super) reading: &'d Reading,
    pub(super) region: Region,
}

impl<'d> Cursor<'d> {
    /// The outermost value. Numbers count as geometry unless [`Cursor::of`] says otherwise.
    pub fn root(document: &'d Document<'d>, reading: &'d Reading) -> Self {
        Cursor { value: document.root(), reading, region: Region::Geometry }
    }

    /// The same place; the numbers from here on belong to another region.
    pub fn of(self, region: Region) -> Self {
        Cursor { region, ..self }
    }

    fn at(self, value: Node<'d>) -> Self {
        Cursor { value, ..self }
    }

    /// Reports a problem at this value.
    pub fn problem(self, message: impl Into<String>, help: impl Into<String>) {
        self.reading.findings.add(self.value.start(), message.into(), help.into());
    }

    /// How many problems were reported so far, anywhere.
    pub fn problems_so_far(self) -> usize {
        self.reading.findings.count()
    }

    /// The place of the value.
    pub fn place(self) -> Place<'d> {
        Place { offset: self.value.start(), findings: &self.reading.findings }
    }

    /// What stands here, for messages: `the number 5`, `the string "x"`, `an object`.
    pub fn found(self) -> String {
        let value = self.value;
        match value.kind() {
            Kind::String => format!("the string {}", quoted(value.as_str().unwrap_or_default())),
            Kind::Number => format!("the number {}", shortened(value.as_number().unwrap_or_default())),
            Kind::Boolean => format!("`{}`", value.as_bool().unwrap_or_default()),
            Kind::Null => "`null`".into(),
            Kind::Array => format!("a list of {}", value.items().len()),
            Kind::Object => "an object".into(),
        }
    }

    /// The text of the string here in quotation marks; of anything else, what it is.
    pub fn quoted(self) -> String {
        self.value.as_str().map_or_else(|| self.found(), quoted)
    }

    pub(super) fn wrong_type(self, expected: &str, help: &str) {
        self.problem(format!("expected {expected}, found {}", self.found()), help);
    }

    /// Whether a string stands here.
    pub fn is_string(self) -> bool {
        self.value.kind() == Kind::String
    }

    /// Whether a list stands here.
    pub fn is_list(self) -> bool {
        self.value.kind() == Kind::Array
    }

    /// Whether an object stands here.
    pub fn is_object(self) -> bool {
        self.value.kind() == Kind::Object
    }

    /// Whether an object with this key stands here.
    pub fn has_key(self, key: &str) -> bool {
        self.value.get(key).is_some()
    }

    /// The string under this key of an object, if there is one.
    pub fn string_under(self, key: &str) -> Option<&'d str> {
        self.value.get(key)?.as_str()
    }

    /// The parameters of the scenario.
    pub fn parameters(self) -> &'d Parameters {
        self.reading.parameters.get_or_init(Parameters::default)
    }

    /// The plane or space.
    pub fn dimension(self) -> Dimension {
        self.reading.dimension.get()
    }

    /// A string.
    pub fn string(self) -> Option<&'d str> {
        let string = self.value.as_str();
        if string.is_none() {
            self.wrong_type("a string", "write text in \"…\"");
        }
        string
    }

    /// `true` or `false`.
    pub fn boolean(self) -> Option<bool> {
        let boolean = self.value.as_bool();
        if boolean.is_none() {
            self.wrong_type("`true` or `false`", "write it without quotation marks");
        }
        boolean
    }

    /// A string that is one of `words`.
    pub fn choice<T: Copy>(self, words: &[(&'static str, T)]) -> Option<T> {
        let word = self.string()?;
        let found = words.iter().find(|(name, _)| *name == word);
        if found.is_none() {
            let names: Vec<&str> = words.iter().map(|(name, _)| *name).collect();
            self.unknown("word", word, &names);
        }
        found.map(|(_, value)| *value)
    }

    /// Reports a word that names nothing known.
    pub fn unknown(self, what: &str, word: &str, known: &[&str]) {
        let help = match known {
            [] => format!("the scenario defines no {what}"),
            _ => format!("expected {}", listed(known)),
        };
        self.problem(format!("unknown {what} {}{}", quoted(word), did_you_mean(word, known.iter().copied())), help);
    }

    /// The entries of a list.
    pub fn list(self) -> Option<impl ExactSizeIterator<Item = Cursor<'d>>> {
        if !self.is_list() {
            self.wrong_type("a list", "write the entries in [ … ]");
            return None;
        }
        Some(self.value.items().map(move |value| self.at(value)))
    }

    /// The entries of a list that must have `count` of them; `what` says why.
    pub fn list_of(self, count: usize, what: &str) -> Option<impl ExactSizeIterator<Item = Cursor<'d>>> {
        let entries = self.list()?;
        let found = entries.len();
        if found != count {
            self.problem(
                format!("expected {}, {what}, found {found}", counted(count, "entry", "entries")),
                if found < count { "add the missing ones" } else { "remove the extra ones" },
            );
            return None;
        }
        Some(entries)
    }

    /// The entries of an object as a map from names the author chose; a repeated name is reported.
    pub fn entries(self) -> Option<Vec<Entry<'d>>> {
        Some(self.each_entry()?.collect())
    }

    /// The same one by one, for very many.
    pub fn each_entry(self) -> Option<impl Iterator<Item = Entry<'d>>> {
        if !self.is_object() {
            self.wrong_type("an object { … }", "write \"key\": value entries in { … }");
            return None;
        }
        let properties = self.value.properties();
        let mut seen = (properties.len() > FEW).then(|| NameTable::with_capacity(properties.len()));
        Some(properties.enumerate().filter_map(move |(before, (key, _))| {
            let entry = Entry { key, cursor: self };
            let is_new = match &mut seen {
                Some(seen) => {
                    seen.insert(key.number(), |number| key.numbered(number).as_str().unwrap_or_default()).is_none()
                }
                None => self.value.properties().take(before).all(|(other, _)| other.as_str() != key.as_str()),
            };
            if !is_new {
                entry.key_problem(
                    format!("the key {} appears twice in this object", quoted(entry.name())),
                    "remove or rename one of the two",
                );
            }
            is_new.then_some(entry)
        }))
    }

    /// The places of the keys of an object.
    pub fn key_places(self) -> impl Iterator<Item = Place<'d>> {
        self.value.properties().map(move |(key, _)| Place { offset: key.start(), findings: &self.reading.findings })
    }

    /// The keys of an object, without a word on repeated ones; none where no object stands.
    pub fn names(self) -> impl Iterator<Item = &'d str> {
        self.value.properties().filter_map(|(key, _)| key.as_str())
    }

    /// The value of a key of an object, whatever other keys it has.
    pub fn get(self, key: &str) -> Option<Self> {
        self.value.get(key).map(|value| self.at(value))
    }

    /// The entries of an object with fixed keys; any other key is reported.
    pub fn fields(self, known: &[&'static str]) -> Option<Fields<'d>> {
        let entries = self.entries()?;
        for entry in &entries {
            if !known.contains(&entry.name()) {
                entry.key_problem(
                    format!(
                        "unknown key {}{}",
                        quoted(entry.name()),
                        did_you_mean(entry.name(), known.iter().copied())
                    ),
                    format!("known keys here: {}", known.join(", ")),
                );
            }
        }
        Some(Fields { cursor: self, entries })
    }
}

/// One `key: value` of an object.
#[derive(Clone, Copy)]
pub struct Entry<'d> {
    key: Node<'d>,
    /// The object.
    cursor: Cursor<'d>,
}

impl<'d> Entry<'d> {
    /// The key.
    pub fn name(self) -> &'d str {
        self.key.as_str().unwrap_or_default()
    }

    /// The value.
    pub fn value(self) -> Cursor<'d> {
        self.cursor.at(self.key.value())
    }

    /// The place of the key.
    pub fn key_place(self) -> Place<'d> {
        Place { offset: self.key_offset(), findings: &self.cursor.reading.findings }
    }

    /// Byte offset of the key.
    pub fn key_offset(self) -> usize {
        self.key.start()
    }

    /// Reports a problem at the key.
    pub fn key_problem(self, message: impl Into<String>, help: impl Into<String>) {
        self.key_place().problem(message, help);
    }
}

/// An object with fixed keys.
pub struct Fields<'d> {
    cursor: Cursor<'d>,
    entries: Vec<Entry<'d>>,
}

impl<'d> Fields<'d> {
    /// The object itself.
    pub fn cursor(&self) -> Cursor<'d> {
        self.cursor
    }

    /// The entry of a key, if the key is there.
    pub fn entry(&self, key: &str) -> Option<Entry<'d>> {
        self.entries.iter().find(|entry| entry.name() == key).copied()
    }

    /// The value of a key, if the key is there.
    pub fn optional(&self, key: &str) -> Option<Cursor<'d>> {
        self.entry(key).map(Entry::value)
    }

    /// The value of a key; reported if it is missing.
    pub fn required(&self, key: &str) -> Option<Cursor<'d>> {
        let found = self.optional(key);
        if found.is_none() {
            self.cursor.problem(format!("missing key `{key}`"), format!("add \"{key}\": …"));
        }
        found
    }

    /// Reports keys that are there but belong elsewhere.
    pub fn refuse(&self, keys: &[&str], message: impl Fn(&str) -> String, help: impl Display) {
        for entry in &self.entries {
            if keys.contains(&entry.name()) {
                entry.key_problem(message(entry.name()), help.to_string());
            }
        }
    }
}
