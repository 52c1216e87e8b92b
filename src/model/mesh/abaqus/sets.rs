//! Sets of nodes and of elements: written out, generated, made of other sets.

use std::collections::HashMap;

use super::cards::{Cards, unquoted, whole};
use super::{MeshProblem, Place};
use crate::model::words::{did_you_mean, quoted};

/// What a line of a set names.
enum Entry {
    One(u64, Place),
    Range {
        first: u64,
        last: u64,
        step: u64,
    },
    Set(String, Place),
    /// The nodes of an element set.
    OfElements(String, Place),
}

struct Set {
    /// As it was written first.
    name: String,
    place: Place,
    entries: Vec<Entry>,
}

/// All sets of a kind, in the order of the file.
pub struct Sets {
    what: &'static str,
    all: Vec<Set>,
    by_name: HashMap<String, usize>,
}

/// Numbers of the nodes of the elements in a set, by its name and the place where it is named.
type NodesOf<'a> = &'a dyn Fn(&str, Place) -> Result<Vec<u64>, MeshProblem>;

/// What its members are found by.
pub struct Members<'a> {
    /// Their numbers in increasing order.
    pub sorted: &'a [u64],
    /// Nodes of element sets.
    pub of_elements: NodesOf<'a>,
}

/// A name without the instance before it.
fn bare(name: &str) -> &str {
    let name = unquoted(name);
    name.rsplit_once('.').map_or(name, |(_, name)| name)
}

impl Sets {
    pub fn new(what: &'static str) -> Sets {
        Sets { what, all: Vec::new(), by_name: HashMap::new() }
    }

    /// The set of this name, new or begun before.
    pub fn open(&mut self, name: &str, place: Place) -> usize {
        let name = unquoted(name);
        let all = &mut self.all;
        *self.by_name.entry(name.to_uppercase()).or_insert_with(|| {
            all.push(Set { name: name.to_owned(), place, entries: Vec::new() });
            all.len() - 1
        })
    }

    /// Name and place of every set.
    pub fn names(&self) -> impl Iterator<Item = (&str, Place)> {
        self.all.iter().map(|set| (set.name.as_str(), set.place))
    }

    /// Puts one member into a set.
    pub fn push(&mut self, set: usize, tag: u64, place: Place) {
        self.all[set].entries.push(Entry::One(tag, place));
    }

    /// Puts the nodes of an element set into a set.
    pub fn push_elements(&mut self, set: usize, name: &str, place: Place) {
        self.all[set].entries.push(Entry::OfElements(name.to_owned(), place));
    }

    /// Reads a data line of a set.
    pub fn read(
        &mut self,
        set: usize,
        generate: bool,
        fields: &[String],
        place: Place,
        cards: &Cards<'_>,
    ) -> Result<(), MeshProblem> {
        let named = fields.iter().filter(|field| !field.is_empty());
        if !generate {
            self.all[set].entries.extend(named.map(|field| match whole(bare(field)) {
                Some(tag) => Entry::One(tag, place),
                None => Entry::Set(bare(field).to_owned(), place),
            }));
            return Ok(());
        }
        let numbers: Vec<Option<u64>> = named.map(|field| whole(field)).collect();
        let entry = match numbers[..] {
            [Some(one)] => Entry::Range { first: one, last: one, step: 1 },
            [Some(first), Some(last)] if first <= last => Entry::Range { first, last, step: 1 },
            [Some(first), Some(last), Some(step)] if first <= last && step > 0 => Entry::Range { first, last, step },
            _ => {
                return Err(cards.problem(
                    place,
                    format!(
                        "{} \"{}\" is generated from {}, expected first, last and step",
                        self.what,
                        self.all[set].name,
                        quoted(&fields.join(", "))
                    ),
                    "write whole numbers, the first not larger than the last, and a step from 1",
                ));
            }
        };
        self.all[set].entries.push(entry);
        Ok(())
    }

    /// The numbers of all members of every set, each once.
    pub fn resolved(&self, members: &Members<'_>, cards: &Cards<'_>) -> Result<Vec<Vec<u64>>, MeshProblem> {
        let mut done: Vec<Option<Vec<u64>>> = Vec::new();
        done.resize_with(self.all.len(), || None);
        for set in 0..self.all.len() {
            self.resolve(set, members, cards, &mut done)?;
        }
        Ok(done.into_iter().map(Option::unwrap_or_default).collect())
    }

    /// Resolves a set and those it is made of, without recursion: a file may chain any number of them.
    fn resolve(
        &self,
        start: usize,
        members: &Members<'_>,
        cards: &Cards<'_>,
        done: &mut [Option<Vec<u64>>],
    ) -> Result<(), MeshProblem> {
        let mut path = vec![start];
        let mut on_path = vec![false; self.all.len()];
        on_path[start] = true;
        while let Some(&set) = path.last() {
            if done[set].is_some() {
                path.pop();
                continue;
            }
            let Set { name, entries, .. } = &self.all[set];
            let mut waits = None;
            for entry in entries {
                let Entry::Set(other, place) = entry else { continue };
                let Some(&index) = self.by_name.get(&other.to_uppercase()) else {
                    let known = self.all.iter().map(|set| set.name.as_str());
                    return Err(cards.problem(
                        *place,
                        format!(
                            "{} \"{name}\" names the set {}, which is not there{}",
                            self.what,
                            quoted(other),
                            did_you_mean(other, known)
                        ),
                        "define it, or correct the name",
                    ));
                };
                if done[index].is_none() {
                    if on_path[index] {
                        let message = format!("{} \"{name}\" contains itself through \"{other}\"", self.what);
                        return Err(cards.problem(*place, message, "remove one of the two from the other"));
                    }
                    waits = Some(index);
                    break;
                }
            }
            if let Some(index) = waits {
                on_path[index] = true;
                path.push(index);
                continue;
            }
            done[set] = Some(self.numbers(set, members, cards, done)?);
            on_path[set] = false;
            path.pop();
        }
        Ok(())
    }

    /// The numbers of a set whose parts are done.
    fn numbers(
        &self,
        set: usize,
        members: &Members<'_>,
        cards: &Cards<'_>,
        done: &[Option<Vec<u64>>],
    ) -> Result<Vec<u64>, MeshProblem> {
        let mut numbers = Vec::new();
        for entry in &self.all[set].entries {
            match entry {
                Entry::One(tag, place) => {
                    if members.sorted.binary_search(tag).is_err() {
                        return Err(cards.problem(
                            *place,
                            format!(
                                "{} \"{}\" names {tag}, which the file does not have",
                                self.what, self.all[set].name
                            ),
                            "remove it from the set, or save the mesh as a whole",
                        ));
                    }
                    numbers.push(*tag);
                }
                // Numbers between that the file leaves out are no members.
                Entry::Range { first, last, step } => {
                    let from = members.sorted.partition_point(|tag| tag < first);
                    let to = members.sorted.partition_point(|tag| tag <= last);
                    let within = members.sorted[from..to].iter();
                    numbers.extend(within.filter(|tag| (**tag - first).is_multiple_of(*step)));
                }
                Entry::Set(other, _) => {
                    let index = self.by_name.get(&other.to_uppercase());
                    numbers.extend(index.and_then(|index| done[*index].as_ref()).into_iter().flatten());
                }
                Entry::OfElements(other, place) => numbers.extend((members.of_elements)(other, *place)?),
            }
        }
        let mut seen = std::collections::HashSet::with_capacity(numbers.len());
        numbers.retain(|number| seen.insert(*number));
        Ok(numbers)
    }

    /// The index of a set by its name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(&bare(name).to_uppercase()).copied()
    }
}
