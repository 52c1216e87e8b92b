//! Names found by their numbers, where a list has the names anyway: 5 … 12 bytes for each, a map keyed by text takes
//! 50.

use std::hash::{BuildHasher, RandomState};
use std::mem::replace;

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

/// Numbers hashed by the names that a list has for them; every method is given that list.
#[derive(Default)]
pub struct NameTable {
    numbers: HashTable<u32>,
    hasher: RandomState,
}

impl NameTable {
    /// With room for this many names.
    pub fn with_capacity(count: usize) -> NameTable {
        NameTable { numbers: HashTable::with_capacity(count), ..NameTable::default() }
    }

    /// The number of a name.
    pub fn get<'n>(&self, name: &str, name_of: impl Fn(u32) -> &'n str) -> Option<u32> {
        self.numbers.find(self.hasher.hash_one(name), |known| name_of(*known) == name).copied()
    }

    /// Takes a number in; the one that had its name before, if there was one, gives way to it.
    pub fn insert<'n>(&mut self, number: u32, name_of: impl Fn(u32) -> &'n str) -> Option<u32> {
        let name = name_of(number);
        let hash = |name: &str| self.hasher.hash_one(name);
        match self.numbers.entry(hash(name), |known| name_of(*known) == name, |known| hash(name_of(*known))) {
            Entry::Occupied(mut known) => Some(replace(known.get_mut(), number)),
            Entry::Vacant(free) => {
                free.insert(number);
                None
            }
        }
    }

    /// All numbers, in any order.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.numbers.iter().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_found_and_a_second_one_gives_way() {
        // Every name twice, 1000 apart.
        let names: Vec<String> = (0..2000).map(|number| format!("n{}", number % 1000)).collect();
        let name_of = |number: u32| names[number as usize].as_str();
        for mut table in [NameTable::default(), NameTable::with_capacity(1000)] {
            assert_eq!(table.get("n0", name_of), None);
            for number in 0..2000 {
                assert_eq!(table.insert(number, name_of), number.checked_sub(1000));
                assert_eq!(table.get(name_of(number), name_of), Some(number));
            }
            assert_eq!(table.get("n1000", name_of), None);
            let mut numbers: Vec<u32> = table.numbers().collect();
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(1000..2000));
        }
    }
}
