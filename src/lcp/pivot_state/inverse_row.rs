//! The rows of B⁻¹ of tied rows, read from the dictionary for the lexicographic rule, column by column.

use super::{Candidate, PivotState};
use crate::lcp::dictionary::{Place, Slot};
use crate::lcp::ratio_test::TiedRows;
use crate::lcp::updated_matrix::ColumnReader;
use crate::lcp::variable::Variable;

impl PivotState {
    /// The rows of B⁻¹ of the candidates tied along column c, for the lexicographic rule.
    pub(crate) fn inverse_rows<'a>(
        &'a self,
        c: usize,
        tied: &'a [Candidate],
        table_row: &'a dyn Fn(Variable) -> usize,
    ) -> InverseRows<'a> {
        InverseRows { stand: self, tied, along: c, table_row }
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

/// The rows of B⁻¹ of tied candidates: what an ε added to a w does to their values.
pub(crate) struct InverseRows<'a> {
    stand: &'a PivotState,
    tied: &'a [Candidate],
    /// The column along which they are tied.
    along: usize,
    table_row: &'a dyn Fn(Variable) -> usize,
}

impl TiedRows for InverseRows<'_> {
    fn table_row(&self, tied: usize) -> usize {
        (self.table_row)(self.stand.name(&self.tied[tied]))
    }

    fn certainty(&self, tied: usize) -> f64 {
        self.stand.relative_fall(self.along, &self.tied[tied])
    }

    fn entries(&self, of: &[usize], row: usize) -> Vec<(f64, f64)> {
        let column = InverseColumn::new(self.stand, row);
        of.iter().map(|&tied| column.entry(&self.tied[tied])).collect()
    }
}

/// The column of B⁻¹ that belongs to the w of one row of the whole LCP.
struct InverseColumn<'a> {
    stand: &'a PivotState,
    variable: Variable,
    /// Where that w is nonbasic: what stands in its column of the dictionary, and its entries.
    nonbasic: Option<(Slot, ColumnReader<'a>)>,
}

impl InverseColumn<'_> {
    fn new(stand: &PivotState, row: usize) -> InverseColumn<'_> {
        let d = &stand.dictionary;
        let nonbasic = stand.nonbasic_w(row).map(|c| (d.column[c], d.reader(c)));
        InverseColumn { stand, variable: Variable::W(row), nonbasic }
    }

    /// 1 where a variable of the dictionary is the w itself.
    fn is(&self, local: Slot) -> f64 {
        f64::from(self.stand.variable(local, false) == self.variable)
    }

    /// The entry in the row of a variable of the dictionary.
    fn visible(&self, local: Slot) -> f64 {
        match self.stand.dictionary.place(local) {
            Place::Row(_) if self.is(local) == 1.0 => 1.0,
            // A nonbasic w stands in its column with the opposite sign of its ε.
            Place::Row(r) => self.nonbasic.as_ref().map_or(0.0, |(_, column)| -column.entry(r)),
            Place::Column(_) => 0.0,
        }
    }

    /// Natural size of that entry.
    fn natural(&self, local: Slot) -> f64 {
        match self.nonbasic {
            Some((Slot::W(j) | Slot::Z(j), _)) => self.stand.inverse_size(local, j),
            _ => 0.0,
        }
    }

    /// The entry in the row of a candidate, divided by its rate, and the natural size of that.
    fn entry(&self, candidate: &Candidate) -> (f64, f64) {
        let stand = self.stand;
        let mut size = self.natural(candidate.variable) + 1.0;
        let mut entry = self.visible(candidate.variable);
        if candidate.mirror_row
            && let Slot::W(i) = candidate.variable
            && let Some(mirror) = &stand.lcp.mirrors[i]
        {
            let own = f64::from(stand.variable(Slot::W(i), true) == self.variable);
            entry = own + self.is(Slot::W(i)) - entry + mirror.covering * self.visible(Slot::P);
            if let Some(n) = mirror.normal {
                let double = 2.0 * mirror.friction;
                entry += double * (self.visible(Slot::W(n)) - self.is(Slot::W(n)));
                size += double * (1.0 + self.natural(Slot::W(n)));
            }
        }
        (entry / candidate.fall, size / candidate.fall)
    }
}
