//! A vertex of a run with names: its basic variables and their values, in the user's units.

use crate::contact::system::ContactSystem;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::Point;
use crate::lcp::variable::Variable;

use super::sentence::plain_name;

/// Values below this multiple of the largest of their kind are zero.
const ZERO: f64 = 1e-11;

/// What gives variables their names and units.
#[derive(Clone, Copy)]
pub enum Naming<'a> {
    /// A contact problem.
    Contact(&'a ContactLcp, &'a ContactSystem),
    /// A bare LCP with the names of its rows.
    Plain(&'a MirroredLcp, &'a [String]),
}

impl Naming<'_> {
    /// The LCP.
    pub fn lcp(&self) -> &MirroredLcp {
        match self {
            Naming::Contact(contact, _) => &contact.lcp,
            Naming::Plain(lcp, _) => lcp,
        }
    }

    /// `x+[c6]`, `w[1]`, `p`.
    pub fn name(&self, variable: Variable) -> String {
        match self {
            Naming::Contact(contact, system) => contact.name(variable, system),
            Naming::Plain(_, names) => plain_name(variable, names),
        }
    }

    /// User's value = dimensionless × this.
    pub fn unit(&self, variable: Variable) -> f64 {
        match (self, variable) {
            (Naming::Contact(contact, _), variable) => contact.unit(variable),
            (Naming::Plain(..), _) => 1.0,
        }
    }
}

/// Value of a variable at a point; times [`Naming::unit`] it is the user's.
pub fn value(point: &Point, variable: Variable) -> f64 {
    match variable {
        Variable::W(i) => point.w[i],
        Variable::Z(i) => point.z[i],
        Variable::P => point.p,
    }
}

/// The basic variables: w, then z, then p.
pub fn basics(lcp: &MirroredLcp, basis: &Basis) -> Vec<Variable> {
    let w = (0..lcp.full_size).filter(|i| basis.active.binary_search(i).is_err()).map(Variable::W);
    w.chain(basis.z.iter().map(|i| Variable::Z(*i))).chain(basis.p.then_some(Variable::P)).collect()
}

/// The basic variables that are zero at this vertex.
pub fn zero_basics(lcp: &MirroredLcp, basis: &Basis, point: &Point) -> Vec<Variable> {
    let largest = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let force = lcp.q.amax().max(largest(&point.w)).max(point.p);
    let length = largest(&point.z);
    basics(lcp, basis)
        .into_iter()
        .filter(|variable| {
            let size = match variable {
                Variable::Z(_) => length,
                _ => force,
            };
            value(point, *variable).abs() <= ZERO * size
        })
        .collect()
}
