//! What decides among rows that block the entering variable at the same value.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::variable::Variable;

/// Rule for tied rows.
#[derive(Clone, Debug, PartialEq)]
pub enum TieRule {
    /// p first; then the smallest row of B⁻¹ divided by the pivot, compared column by column in the order of
    /// the given rows of the LCP (the perturbation q + (ε, ε², …) in that order).
    Lexicographic(Vec<usize>),
    /// The first tied row of the tableau, whatever stands in it: may cycle.
    FirstRow,
    /// A tied row drawn with this seed.
    Random(u64),
}

impl TieRule {
    /// How often a basis may come back before the run is called a cycle. Where the choice follows from the basis the
    /// first return is one; a draw may break out of the circle.
    pub(crate) fn returns_allowed(&self) -> usize {
        match self {
            TieRule::Lexicographic(_) | TieRule::FirstRow => 0,
            TieRule::Random(_) => 100,
        }
    }
}

/// Entries of two rows of B⁻¹ that differ by less than this multiple of their natural size are equal.
const SAME: f64 = 1e-10;

/// Tied rows as the tie rules see them, numbered from 0.
pub(crate) trait TiedRows {
    /// Of each of the rows `of`: the entry of its row of B⁻¹ in the column of w_`row`, divided by the pivot, and the
    /// natural size of that.
    fn entries(&self, of: &[usize], row: usize) -> Vec<(f64, f64)>;
    /// Its row in the whole tableau, where an entering variable takes the row of the leaving one.
    fn table_row(&self, tied: usize) -> usize;
    /// Rate at which it falls relative to the natural size of that rate: how surely it falls at all.
    fn certainty(&self, tied: usize) -> f64;
}

/// The tied row that leaves: index into `names`.
///
/// `at_start`: p is being let in from infinity, every row has only its own ε, and the row whose ε is smallest
/// (latest in the order) needs the largest p.
pub(crate) fn choose(
    rule: &TieRule,
    random: &mut ChaCha8Rng,
    names: &[Variable],
    rows: &impl TiedRows,
    at_start: bool,
) -> usize {
    if names.len() == 1 {
        return 0;
    }
    match rule {
        TieRule::FirstRow => (0..names.len()).min_by_key(|&k| rows.table_row(k)).unwrap_or(0),
        TieRule::Random(_) => {
            let mut sorted: Vec<usize> = (0..names.len()).collect();
            sorted.sort_unstable_by_key(|&k| names[k]);
            sorted[random.random_range(0..sorted.len())]
        }
        TieRule::Lexicographic(order) => {
            if let Some(k) = names.iter().position(|name| *name == Variable::P) {
                return k;
            }
            if at_start {
                let rank = |k: usize| order.iter().position(|&row| Variable::W(row) == names[k]).unwrap_or(0);
                return (0..names.len()).max_by_key(|&k| rank(k)).unwrap_or(0);
            }
            let mut left: Vec<usize> = (0..names.len()).collect();
            for &row in order {
                // Every entry with its own uncertainty: that of a row whose rate is nearly noise is wide, and must not
                // hide the differences of the others. A row stays while it could be the smallest.
                let entries = rows.entries(&left, row);
                let most = entries.iter().map(|(entry, size)| entry + SAME * size).fold(f64::INFINITY, f64::min);
                let mut kept = entries.iter();
                left.retain(|_| kept.next().is_some_and(|(entry, size)| entry - SAME * size <= most));
                if left.len() == 1 {
                    return left[0];
                }
            }
            // Exact rows of B⁻¹ differ somewhere; these do not as far as rounding lets one see.
            left.into_iter().max_by(|&a, &b| rows.certainty(a).total_cmp(&rows.certainty(b))).unwrap_or(0)
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;

    /// Entries of a row of B⁻¹ / pivot with their sizes, in the columns of w_0, w_1 …, and how surely the row falls.
    struct Row(Vec<(f64, f64)>, f64);

    impl TiedRows for &[Row] {
        fn entries(&self, of: &[usize], row: usize) -> Vec<(f64, f64)> {
            of.iter().map(|&k| self[k].0[row]).collect()
        }
        fn table_row(&self, _: usize) -> usize {
            0
        }
        fn certainty(&self, tied: usize) -> f64 {
            self[tied].1
        }
    }

    fn chosen(rows: &[Row]) -> usize {
        let names: Vec<Variable> = (0..rows.len()).map(Variable::W).collect();
        let rule = TieRule::Lexicographic(vec![0, 1]);
        choose(&rule, &mut ChaCha8Rng::seed_from_u64(0), &names, &rows, false)
    }

    /// A row whose rate is noise has entries of any size after the division by it. They are uncertain by as much, but
    /// those of the other rows are not: such a row made all of them tie, and the run cycle.
    #[test]
    fn one_uncertain_row_hides_no_difference_of_the_others() {
        let first = || Row(vec![(0.5, 1.0), (0.0, 1.0)], 0.1);
        let smallest = || Row(vec![(0.1, 1.0), (9.0, 1.0)], 0.1);
        let noise = |entry| Row(vec![(entry, 1e13), (entry, 1e13)], 1e-13);
        assert_eq!(chosen(&[first(), smallest()]), 1);
        for entry in [-3e2, 0.0, 3e2, 3e4] {
            assert_eq!(chosen(&[first(), smallest(), noise(entry)]), 1, "{entry}");
            assert_eq!(chosen(&[noise(entry), first(), smallest()]), 2, "{entry}");
        }
        // Smaller for certain, it is the smallest.
        assert_eq!(chosen(&[first(), smallest(), noise(-3e4)]), 2);
    }

    #[test]
    fn equal_entries_are_told_apart_in_the_next_column() {
        let row = |second| Row(vec![(0.5, 1.0), (second, 1.0)], 0.1);
        assert_eq!(chosen(&[row(0.3), row(0.2), row(0.4)]), 1);
        assert_eq!(chosen(&[row(-0.3), row(-0.2)]), 0);
    }
}
