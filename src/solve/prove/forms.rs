//! What an answer has to fulfil, as signs of linear forms and a choice among branches: the one language of all proofs.
//!
//! ```text
//!   contact   z_n ≥ 0, x_n ≥ 0, x+ ≥ 0, x- ≥ 0;   per pair one of   stick  z_n = z_t = 0        open  x_n = x+ = x- = 0
//!                                                                   slip+  z_n = x+ = 0, z_t ≥ 0       (where c = 0)
//!                                                                   slip-  z_n = x- = 0, z_t ≤ 0
//!   LCP       z ≥ 0, w ≥ 0;                       per row one of    z = 0,   w = 0
//! ```
//! With c > 0 an open pair has three branches as a closed one has; a bound pair has z_n = 0 and no x_n ≥ 0; a
//! frictionless pair has x_t = 0 and is closed or open.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::system::{ProvedContact, ProvedSystem};
use crate::contact::law::{PairLaw, TangentialJoint};
use crate::lcp::exact::dyadic::{WholeRows, rational, rational_rows};
use crate::lcp::exact::polyhedron::{GoOn, Polyhedron, State};
use crate::lcp::exact::rational_solve::{clear_denominators, product};

/// One way for a pair or a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// `stick`, `slip+`, `slip-`, `open`, `open stick` …; `z` or `w`, whichever is zero.
    pub name: &'static str,
    /// Variables that are zero in it.
    pub zero: Vec<usize>,
    /// A displacement with a sign: whether it is ≥ 0, else ≤ 0.
    pub sign: Option<(usize, bool)>,
}

/// A pair or a row of an LCP, of which one branch holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Its id.
    pub name: String,
    /// The branches: in every answer at least one of them holds.
    pub branches: Vec<Branch>,
}

/// Variables: the unknowns z, then the forms.
#[derive(Clone, Debug, PartialEq)]
pub struct Forms {
    /// Number of unknowns.
    pub unknowns: usize,
    /// Name of every variable: `z_n c1`, `x+ c1`, `w 3`.
    pub names: Vec<String>,
    /// Coefficients of each form over the unknowns, its constant last.
    pub forms: Vec<Vec<BigRational>>,
    /// Of every variable: whether it is ≥ 0 in every answer.
    pub signed: Vec<bool>,
    /// Variables that are zero in every answer.
    pub zero: Vec<usize>,
    /// One for each pair or row.
    pub groups: Vec<Group>,
}

impl Forms {
    /// Of a system.
    pub fn of(system: &ProvedSystem) -> Forms {
        match system {
            ProvedSystem::Contact(contact) => of_contact(contact, &contact.exact_stiffness()),
            ProvedSystem::Plain { matrix, q, names } => {
                let n = q.len();
                let mut forms = rational_rows(matrix);
                forms.iter_mut().zip(q).for_each(|(form, constant)| form.push(rational(*constant)));
                let group = |i: usize| Group {
                    name: names[i].clone(),
                    branches: vec![
                        Branch { name: "z", zero: vec![i], sign: None },
                        Branch { name: "w", zero: vec![n + i], sign: None },
                    ],
                };
                let named = |letter: &'static str| names.iter().map(move |name| format!("{letter} {name}"));
                Forms {
                    unknowns: n,
                    names: named("z").chain(named("w")).collect(),
                    forms,
                    signed: vec![true; 2 * n],
                    zero: Vec::new(),
                    groups: (0..n).map(group).collect(),
                }
            }
        }
    }

    /// The unknowns of a contact system without any form: all that a motion speaks of.
    pub fn unknowns_of(contact: &ProvedContact) -> Forms {
        let m = contact.ids.len();
        let names = ["z_n", "z_t"].iter().flat_map(|word| contact.ids.iter().map(move |id| format!("{word} {id}")));
        Forms {
            unknowns: 2 * m,
            names: names.collect(),
            forms: Vec::new(),
            signed: contact.laws.iter().map(|law| !law.is_bilateral()).chain(vec![false; m]).collect(),
            zero: (0..m).filter(|&pair| contact.laws[pair].is_bilateral()).collect(),
            groups: Vec::new(),
        }
    }

    /// Value of every variable where the unknowns have these.
    pub fn values(&self, z: &[BigRational]) -> Vec<BigRational> {
        let whole = clear_denominators(&z.iter().cloned().chain([One::one()]).collect::<Vec<_>>());
        let value = |form: &Vec<BigRational>| product(&clear_denominators(form), &whole);
        z.iter().cloned().chain(self.forms.iter().map(value)).collect()
    }

    /// The branches that hold, one for each group, where these values are an answer.
    pub fn scheme(&self, values: &[BigRational]) -> Option<Vec<&'static str>> {
        let signs = self.signed.iter().zip(values).all(|(signed, value)| !signed || !value.is_negative());
        if !signs || self.zero.iter().any(|&variable| !values[variable].is_zero()) {
            return None;
        }
        self.groups.iter().map(|group| Some(group.branches.iter().find(|branch| branch.holds(values))?.name)).collect()
    }

    /// All signs but those of the slips and all that is zero in every answer, nothing decided yet; beside the state the
    /// variable that was fixed last.
    pub(super) fn start(&self, go_on: &mut GoOn) -> (Polyhedron, (State, Option<usize>)) {
        let mut rows = WholeRows::default();
        self.forms.iter().for_each(|form| rows.push_rational(form));
        let free: Vec<usize> = (0..self.names.len()).filter(|&variable| !self.signed[variable]).collect();
        let mut made = Polyhedron::new(self.unknowns, rows, &free).keep_fixed();
        let state = match made.restore(go_on) {
            State::Feasible => made.fix_all(self.zero.iter().copied(), go_on),
            other => (other, None),
        };
        (made, state)
    }
}

impl Branch {
    /// Whether its displacement has its sign, if there is one.
    pub(super) fn sign_holds(&self, values: &[BigRational]) -> bool {
        self.sign.is_none_or(|(variable, up)| match up {
            true => !values[variable].is_negative(),
            false => !values[variable].is_positive(),
        })
    }

    /// Whether its zeros and its sign hold.
    pub fn holds(&self, values: &[BigRational]) -> bool {
        self.sign_holds(values) && self.zero.iter().all(|&variable| values[variable].is_zero())
    }
}

/// Of a contact system with this R. Forms pair by pair: x_n, then x_t of a frictionless one, else x+ and x-.
pub(super) fn of_contact(contact: &ProvedContact, stiffness: &[Vec<BigRational>]) -> Forms {
    let m = contact.ids.len();
    let force = |joint: usize| -> Vec<BigRational> {
        let row = &stiffness[joint];
        let gaps = contact.laws.iter().map(PairLaw::gap).zip(row).filter(|(gap, _)| *gap != 0.0);
        let closed: BigRational = gaps.map(|(gap, entry)| rational(gap) * entry).sum();
        row.iter().cloned().chain([rational(contact.load[joint]) - closed]).collect()
    };
    let mut made = Forms::unknowns_of(contact);
    for (pair, (law, id)) in contact.laws.iter().zip(&contact.ids).enumerate() {
        let (normal, tangential) = (force(pair), force(m + pair));
        let mut form = |word: &str, form: Vec<BigRational>, signed: bool| {
            made.names.push(format!("{word} {id}"));
            made.forms.push(form);
            made.signed.push(signed);
            made.names.len() - 1
        };
        let x_n = form("x_n", normal.clone(), !law.is_bilateral());
        let branches = match law.tangential {
            TangentialJoint::Free => {
                let x_t = form("x_t", tangential, false);
                made.zero.push(x_t);
                if stiffness.iter().all(|row| row[m + pair].is_zero()) {
                    made.zero.push(m + pair);
                }
                frictionless(pair, x_n)
            }
            TangentialJoint::Bounded { friction, fixed } => {
                let mut reserve = |word: &str, side: BigRational| {
                    let (f, last) = (rational(friction), normal.len() - 1);
                    let mut sum: Vec<_> = normal.iter().zip(&tangential).map(|(n, t)| &f * n + &side * t).collect();
                    sum[last] += rational(fixed);
                    form(word, sum, true)
                };
                let reserves = [reserve("x+", One::one()), reserve("x-", -BigRational::one())];
                rubbing(law, pair, x_n, m + pair, reserves)
            }
        };
        made.groups.push(Group { name: id.clone(), branches });
    }
    made
}

fn frictionless(z_n: usize, x_n: usize) -> Vec<Branch> {
    let branch = |name, zero| Branch { name, zero: vec![zero], sign: None };
    vec![branch("closed", z_n), branch("open", x_n)]
}

fn rubbing(law: &PairLaw, z_n: usize, x_n: usize, z_t: usize, [plus, minus]: [usize; 2]) -> Vec<Branch> {
    let three = |names: [&'static str; 3], normal: usize| {
        let [stick, up, down] = names;
        vec![
            Branch { name: stick, zero: vec![normal, z_t], sign: None },
            Branch { name: up, zero: vec![normal, plus], sign: Some((z_t, true)) },
            Branch { name: down, zero: vec![normal, minus], sign: Some((z_t, false)) },
        ]
    };
    let mut all = three(["stick", "slip+", "slip-"], z_n);
    if law.is_bilateral() {
        return all;
    }
    if law.fixed_bound() > 0.0 {
        all.extend(three(["open stick", "open slip+", "open slip-"], x_n));
    } else {
        all.push(Branch { name: "open", zero: vec![x_n, plus, minus], sign: None });
    }
    all
}
