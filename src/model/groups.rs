//! What is connected: a partition of 0 … n − 1 that grows coarser as members are joined (union–find).

/// A partition; at first everyone is alone.
#[derive(Clone, Debug)]
pub struct Groups {
    /// Towards the least member of the group.
    parent: Vec<u32>,
}

impl Groups {
    /// A partition of `count` members, each alone.
    pub fn new(count: usize) -> Groups {
        Groups { parent: (0..count as u32).collect() }
    }

    /// The least member of the group of `member`.
    pub fn of(&mut self, member: usize) -> usize {
        let mut at = member;
        while self.parent[at] as usize != at {
            self.parent[at] = self.parent[self.parent[at] as usize];
            at = self.parent[at] as usize;
        }
        at
    }

    /// Makes one group of those of two members.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        self.parent[a.max(b)] = a.min(b) as u32;
    }

    /// Makes one group of those of all these members.
    pub fn join_all(&mut self, members: impl IntoIterator<Item = usize>) {
        let mut members = members.into_iter();
        if let Some(first) = members.next() {
            members.for_each(|other| self.join(first, other));
        }
    }

    /// The number of the group of each of these members; groups are counted from 0 as they first come.
    pub fn numbers(&mut self, members: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut numbers: Vec<Option<usize>> = vec![None; self.parent.len()];
        let mut next = 0..;
        let number = |member| {
            let group = self.of(member);
            *numbers[group].get_or_insert_with(|| next.next().unwrap_or_default())
        };
        members.into_iter().map(number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Groups;

    #[test]
    fn who_is_joined_hangs_together() {
        let mut groups = Groups::new(6);
        groups.join(4, 2);
        groups.join_all([5, 4]);
        groups.join_all([]);
        assert_eq!([0, 1, 2, 3, 4, 5].map(|member| groups.of(member)), [0, 1, 2, 3, 2, 2]);
        assert_eq!(groups.numbers([3, 5, 4, 0, 3]), [0, 1, 1, 2, 0]);
    }
}
