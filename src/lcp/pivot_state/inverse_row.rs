//! The rows of B⁻¹ of tied rows, read from the dictionary for the lexicographic rule.

use super::{Candidate, PivotState};
use crate::lcp::dictionary::{Place, Slot};
use crate::lcp::ratio_test::TiedRow;
use crate::lcp::variable::Variable;

impl PivotState {
    /// The rows of B⁻¹ of the candidates tied along column c, for the lexicographic rule.
    pub(crate) fn inverse_rows<'a>(
        &'a self,
        c: usize,
        tied: &'a [Candidate],
        table_row: &'a dyn Fn(Variable) -> usize,
    ) -> Vec<InverseRow<'a>> {
        tied.iter()
            .map(|candidate| InverseRow {
                stand: self,
                candidate,
                table_row,
                certainty: self.relative_fall(c, candidate),
            })
            .collect()
    }

    /// Column of the nonbasic w that stands in row `whole` of the whole LCP.
    fn nonbasic_w(&self, whole: usize) -> Option<usize> {
        let (i, mirrored) = self.primary[whole];
        if mirrored != self.dictionary.turned[i] {
            return None;
        }
        self.column_of(Slot::W(i))
    }

    /// Natural size of the entry of the row of B⁻¹ of `local` in the column of primary row `j`.
    fn inverse_size(&self, local: Slot, j: usize) -> f64 {
        let scale = &self.lcp.scale;
        let column = scale.row[j].max(f64::MIN_POSITIVE);
        match local {
            Slot::W(i) => scale.row[i] / column,
            Slot::Z(k) => 1.0 / (scale.column[k] * column),
            Slot::P => self.sizes.p_per_force / column,
        }
    }
}

/// The row of B⁻¹ of a tied candidate: what an ε added to a w does to its value.
pub(crate) struct InverseRow<'a> {
    stand: &'a PivotState,
    candidate: &'a Candidate,
    table_row: &'a dyn Fn(Variable) -> usize,
    certainty: f64,
}

impl TiedRow for InverseRow<'_> {
    fn table_row(&self) -> usize {
        (self.table_row)(self.stand.name(self.candidate))
    }

    fn certainty(&self) -> f64 {
        self.certainty
    }

    fn entry(&self, row: usize) -> (f64, f64) {
        let stand = self.stand;
        let d = &stand.dictionary;
        let column = stand.nonbasic_w(row);
        let is = |local: Slot| f64::from(stand.variable(local, false) == Variable::W(row));
        let visible = |local: Slot| match d.place(local) {
            Place::Row(_) if is(local) == 1.0 => 1.0,
            // A nonbasic w stands in its column with the opposite sign of its ε.
            Place::Row(r) => column.map_or(0.0, |c| -d.entry(r, c)),
            Place::Column(_) => 0.0,
        };
        let natural = |local: Slot| match column.map(|c| d.column[c]) {
            Some(Slot::W(j) | Slot::Z(j)) => stand.inverse_size(local, j),
            _ => 0.0,
        };
        let candidate = self.candidate;
        let mut size = natural(candidate.variable) + 1.0;
        let mut entry = visible(candidate.variable);
        if candidate.mirror_row
            && let Slot::W(i) = candidate.variable
            && let Some(mirror) = &stand.lcp.mirrors[i]
        {
            let own = f64::from(stand.variable(Slot::W(i), true) == Variable::W(row));
            entry = own + is(Slot::W(i)) - entry + mirror.covering * visible(Slot::P);
            if let Some(n) = mirror.normal {
                let double = 2.0 * mirror.friction;
                entry += double * (visible(Slot::W(n)) - is(Slot::W(n)));
                size += double * (1.0 + natural(Slot::W(n)));
            }
        }
        (entry / candidate.fall, size / candidate.fall)
    }
}
