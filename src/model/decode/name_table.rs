//! Names found by their numbers, where a list has the names anyway: 4 … 12 bytes for each, a map keyed by text takes
//! 50.

use std::hash::{BuildHasher, RandomState};

/// A slot without a number.
const FREE: u32 = u32::MAX;

/// Numbers hashed by the names that a list has for them; every method is given that list.
#[derive(Default)]
pub struct NameTable {
    /// As many as a power of two, or none.
    slots: Vec<u32>,
    count: usize,
    hasher: RandomState,
}

impl NameTable {
    /// With room for so many names.
    pub fn with_capacity(count: usize) -> NameTable {
        NameTable { slots: vec![FREE; slots_for(count)], ..NameTable::default() }
    }

    /// The number of a name.
    pub fn get<'n>(&self, name: &str, name_of: impl Fn(u32) -> &'n str) -> Option<u32> {
        if self.count == 0 {
            return None;
        }
        Some(self.slots[self.slot(name, name_of)]).filter(|number| *number != FREE)
    }

    /// Takes a number in; the one that had its name before, if there was one, gives way to it.
    pub fn insert<'n>(&mut self, number: u32, name_of: impl Fn(u32) -> &'n str) -> Option<u32> {
        if self.slots.len() < slots_for(self.count + 1) {
            let slots = vec![FREE; slots_for(self.count + 1)];
            for known in std::mem::replace(&mut self.slots, slots).into_iter().filter(|known| *known != FREE) {
                let slot = self.slot(name_of(known), &name_of);
                self.slots[slot] = known;
            }
        }
        let slot = self.slot(name_of(number), name_of);
        let before = Some(std::mem::replace(&mut self.slots[slot], number)).filter(|before| *before != FREE);
        self.count += usize::from(before.is_none());
        before
    }

    /// All numbers, in any order.
    pub fn numbers(&self) -> impl Iterator<Item = u32> {
        self.slots.iter().copied().filter(|number| *number != FREE)
    }

    /// Where a name stands, or would stand; there is a free slot.
    fn slot<'n>(&self, name: &str, name_of: impl Fn(u32) -> &'n str) -> usize {
        let last = self.slots.len() - 1;
        let mut slot = self.hasher.hash_one(name) as usize & last;
        while self.slots[slot] != FREE && name_of(self.slots[slot]) != name {
            slot = (slot + 1) & last;
        }
        slot
    }
}

/// At least a quarter stays free.
fn slots_for(count: usize) -> usize {
    (count + count / 3 + 1).next_power_of_two()
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
                assert!(4 * table.count < 3 * table.slots.len() + 4);
            }
            assert_eq!(table.get("n1000", name_of), None);
            let mut numbers: Vec<u32> = table.numbers().collect();
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(1000..2000));
        }
    }
}
