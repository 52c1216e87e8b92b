//! Which variables of an LCP are basic.

use std::collections::BTreeSet;

use super::variable::Variable;

/// A basis: rows are those of the whole LCP.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Basis {
    /// Rows whose z is basic, ascending.
    pub z: Vec<usize>,
    /// Rows whose w is nonbasic, ascending. Differs from `z` while p is basic.
    pub active: Vec<usize>,
    /// Whether p is basic.
    pub p: bool,
}

/// A basis on its way from pivot to pivot, at first that of z = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ChangingBasis {
    z: BTreeSet<usize>,
    active: BTreeSet<usize>,
    p: bool,
}

impl ChangingBasis {
    pub(super) fn pivot(&mut self, entering: Variable, leaving: Variable) {
        match leaving {
            Variable::W(i) => {
                self.active.insert(i);
            }
            Variable::Z(i) => {
                self.z.remove(&i);
            }
            Variable::P => self.p = false,
        }
        match entering {
            Variable::W(i) => {
                self.active.remove(&i);
            }
            Variable::Z(i) => {
                self.z.insert(i);
            }
            Variable::P => self.p = true,
        }
    }

    pub(super) fn now(&self) -> Basis {
        Basis { z: self.z.iter().copied().collect(), active: self.active.iter().copied().collect(), p: self.p }
    }
}
