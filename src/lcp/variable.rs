//! The variables of Lemke's algorithm and their complements.

/// A variable of w = M z + q + d p. The index is the row of the *whole* LCP (3m rows for m Coulomb pairs).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variable {
    /// w_i.
    W(usize),
    /// z_i.
    Z(usize),
    /// The artificial variable; in contact problems the tightening weight.
    P,
}

impl Variable {
    /// The other variable of the complementary couple; p has none.
    pub fn complement(self) -> Option<Variable> {
        match self {
            Variable::W(i) => Some(Variable::Z(i)),
            Variable::Z(i) => Some(Variable::W(i)),
            Variable::P => None,
        }
    }
}
