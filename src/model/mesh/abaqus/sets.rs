//! Sets of nodes and of elements: written out, generated, made of other sets.

use std::collections::HashMap;

use super::cards::{Cards, unquoted, whole};
use super::{MeshProblem, Place};
use crate::model::words::{did_you_mean, quoted};

/// Members of all sets together: more would not be a mesh but a claim on memory.
const MOST_MEMBERS: usize = 20_000_000;

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
    /// Where it was begun by its own keyword, first and once more.
    begun: [Option<Place>; 2],
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

/// A name or number without the instance before it: `Part-1-1.17`.
pub fn bare(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, name)| unquoted(name))
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
            all.push(Set { name: name.to_owned(), place, entries: Vec::new(), begun: [None; 2] });
            all.len() - 1
        })
    }

    /// The set that a keyword of its own begins or goes on with: what follows is added to it.
    pub fn begin(&mut self, name: &str, place: Place) -> usize {
        let set = self.open(name, place);
        let [first, again] = &mut self.all[set].begun;
        match first {
            None => *first = Some(place),
            Some(_) => *again = again.or(Some(place)),
        }
        set
    }

    /// Name and place of the first set that was begun twice, and how many there are.
    pub fn merged(&self) -> Option<(&str, Place, usize)> {
        let mut merged = self.all.iter().filter_map(|set| Some((set.name.as_str(), set.begun[1]?)));
        let (name, place) = merged.next()?;
        Some((name, place, 1 + merged.count()))
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
            self.all[set].entries.extend(named.map(|field| match whole(field) {
                Some(tag) => Entry::One(tag, place),
                None => Entry::Set(field.clone(), place),
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
        let mut on_path = vec![false; self.all.len()];
        let mut total = 0;
        for set in 0..self.all.len() {
            // Without recursion: a file may chain any number of sets. Each on the path with the entry it waits for.
            let mut path = vec![(set, 0)];
            while let Some((set, from)) = path.pop() {
                if done[set].is_some() {
                    continue;
                }
                on_path[set] = true;
                if let Some((entry, part)) = self.unfinished(set, from, &done, &on_path, cards)? {
                    path.extend([(set, entry), (part, 0)]);
                    continue;
                }
                let numbers = self.numbers(set, members, cards, &done)?;
                total += numbers.len();
                if total > MOST_MEMBERS {
                    let Set { name, place, .. } = &self.all[set];
                    let message = format!("{} \"{name}\": all sets together have too many members", self.what);
                    return Err(cards.problem(*place, message, "remove sets that are not needed"));
                }
                done[set] = Some(numbers);
                on_path[set] = false;
            }
        }
        Ok(done.into_iter().map(Option::unwrap_or_default).collect())
    }

    /// The first entry from `from` on that is a set which is not done, and that set.
    fn unfinished(
        &self,
        set: usize,
        from: usize,
        done: &[Option<Vec<u64>>],
        on_path: &[bool],
        cards: &Cards<'_>,
    ) -> Result<Option<(usize, usize)>, MeshProblem> {
        let Set { name, entries, .. } = &self.all[set];
        for (at, entry) in entries.iter().enumerate().skip(from) {
            let Entry::Set(other, place) = entry else { continue };
            let Some(index) = self.find(other) else {
                if whole(bare(other)).is_some() {
                    continue;
                }
                let near = did_you_mean(other, self.all.iter().map(|set| set.name.as_str()));
                let message =
                    format!("{} \"{name}\" names the set {}, which is not there{near}", self.what, quoted(other));
                return Err(cards.problem(*place, message, "define it, or correct the name"));
            };
            if done[index].is_none() {
                if on_path[index] {
                    let message = format!("{} \"{name}\" contains itself through {}", self.what, quoted(other));
                    return Err(cards.problem(*place, message, "remove one of the two from the other"));
                }
                return Ok(Some((at, index)));
            }
        }
        Ok(None)
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
                Entry::One(tag, place) => numbers.push(self.known(set, *tag, *place, members, cards)?),
                // Numbers between that the file leaves out are no members.
                Entry::Range { first, last, step } => {
                    let from = members.sorted.partition_point(|tag| tag < first);
                    let to = members.sorted.partition_point(|tag| tag <= last);
                    let within = members.sorted[from..to].iter();
                    numbers.extend(within.filter(|tag| (**tag - first).is_multiple_of(*step)));
                }
                Entry::Set(other, place) => match (self.find(other), whole(bare(other))) {
                    (Some(index), _) => numbers.extend(done[index].as_ref().into_iter().flatten()),
                    (None, Some(tag)) => numbers.push(self.known(set, tag, *place, members, cards)?),
                    (None, None) => {}
                },
                Entry::OfElements(other, place) => numbers.extend((members.of_elements)(other, *place)?),
            }
        }
        let mut seen = std::collections::HashSet::with_capacity(numbers.len());
        numbers.retain(|number| seen.insert(*number));
        Ok(numbers)
    }

    /// A number, if the file has what it means.
    fn known(
        &self,
        set: usize,
        tag: u64,
        place: Place,
        members: &Members<'_>,
        cards: &Cards<'_>,
    ) -> Result<u64, MeshProblem> {
        if members.sorted.binary_search(&tag).is_ok() {
            return Ok(tag);
        }
        let message = format!("{} \"{}\" names {tag}, which the file does not have", self.what, self.all[set].name);
        Err(cards.problem(place, message, "remove it from the set, or save the mesh as a whole"))
    }

    /// The index of a set by its name, with or without an instance before it.
    pub fn find(&self, name: &str) -> Option<usize> {
        let find = |name: &str| self.by_name.get(&name.to_uppercase()).copied();
        find(unquoted(name)).or_else(|| find(bare(name)))
    }
}
