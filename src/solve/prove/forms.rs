//! What an answer has to fulfil, as signs of linear forms and a choice among branches: the one language of all proofs.
//!
//! ```text
//!   contact   z_n ≥ 0, x_n ≥ 0, x+ ≥ 0, x- ≥ 0;   per pair one of   stick  z_n = z_t = 0        open  x_n = x+ = x- = 0
//!                                                                   slip+  z_n = x+ = 0, z_t ≥ 0       (where c = 0)
//!                                                                   slip-  z_n = x- = 0, z_t ≤ 0
//!   LCP       z ≥ 0, w ≥ 0;                       per row one of    z = 0,   w = 0
//! ```
//! With c > 0 an open pair has three branches as a closed one has; a bound pair has z_n = 0 and no x_n ≥ 0; a
//! frictionless pair has x_t = 0 and is closed or open. In space x^k ≥ 0 of every facet, z_t1 and z_t2 in place of z_t, and
//! ```text
//!   slip^k        z_n = x^k = turn^k = 0, the slip along d_k          turn^k = d_k × z_τ
//!   slip^k^k+1    z_n = x^k = x^(k+1) = 0, turn^k ≥ 0, turn^(k+1) ≤ 0, where turn^(k + K/2) is −turn^k
//! ```

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::system::{ProvedContact, ProvedSystem};
use crate::contact::law::{PairLaw, TangentialJoint};
use crate::contact::polygon::Polygon;
use crate::contact::schemes::scheme::{Tangential, slip_forms};
use crate::lcp::exact::dyadic::{WholeRows, rational, rational_rows};
use crate::lcp::exact::polyhedron::{GoOn, Polyhedron, State};
use crate::lcp::exact::rational_solve::{clear_denominators, product};

/// One way for a pair or a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// `stick`, `slip+`, `slip-`, `open`, `open stick` …; `z` or `w`, whichever is zero.
    pub name: String,
    /// Variables that are zero in it.
    pub zero: Vec<usize>,
    /// Displacements with a sign: whether it is ≥ 0, else ≤ 0.
    pub signs: Vec<(usize, bool)>,
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
    /// Tangential joints of each pair; 0 of an LCP.
    pub tangents: usize,
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
                        Branch { name: "z".to_owned(), zero: vec![i], signs: Vec::new() },
                        Branch { name: "w".to_owned(), zero: vec![n + i], signs: Vec::new() },
                    ],
                };
                let named = |letter: &'static str| names.iter().map(move |name| format!("{letter} {name}"));
                Forms {
                    tangents: 0,
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

    /// The unknowns of a contact system without any form: all that a motion needs.
    pub fn unknowns_of(contact: &ProvedContact) -> Forms {
        let m = contact.ids.len();
        let named = |word: &'static str| move |id: &String| format!("{word} {id}");
        let words = if contact.tangents == 1 { &["z_t"][..] } else { &["z_t1", "z_t2"] };
        let slips = contact.ids.iter().flat_map(|id| words.iter().map(move |word| named(word)(id)));
        Forms {
            tangents: contact.tangents,
            unknowns: (1 + contact.tangents) * m,
            names: contact.ids.iter().map(named("z_n")).chain(slips).collect(),
            forms: Vec::new(),
            signed: contact
                .laws
                .iter()
                .map(|law| !law.is_bilateral())
                .chain(vec![false; contact.tangents * m])
                .collect(),
            zero: (0..m).filter(|&pair| contact.laws[pair].is_bilateral()).collect(),
            groups: Vec::new(),
        }
    }

    /// Value of every variable for these unknowns.
    pub fn values(&self, z: &[BigRational]) -> Vec<BigRational> {
        let whole = clear_denominators(&z.iter().cloned().chain([One::one()]).collect::<Vec<_>>());
        let value = |form: &Vec<BigRational>| product(&clear_denominators(form), &whole);
        z.iter().cloned().chain(self.forms.iter().map(value)).collect()
    }

    /// The branches that hold, one for each group, where these values are an answer.
    pub fn scheme(&self, values: &[BigRational]) -> Option<Vec<&str>> {
        let signs = self.signed.iter().zip(values).all(|(signed, value)| !signed || !value.is_negative());
        if !signs || self.zero.iter().any(|&variable| !values[variable].is_zero()) {
            return None;
        }
        self.groups
            .iter()
            .map(|group| Some(&*group.branches.iter().find(|branch| branch.holds(values))?.name))
            .collect()
    }

    /// All signs but those of the slips and all that is zero in every answer, with no branch chosen yet; its state, and
    /// the variable that was fixed last.
    pub(super) fn start(&self, go_on: &mut GoOn) -> (Polyhedron, (State, Option<usize>)) {
        let mut rows = WholeRows::default();
        self.forms.iter().for_each(|form| rows.push_rational(form));
        let free: Vec<usize> = (0..self.names.len()).filter(|&variable| !self.signed[variable]).collect();
        let mut made = Polyhedron::new(self.unknowns, rows, &free).keep_fixed(0);
        let state = match made.start(go_on) {
            State::Feasible => made.fix_all(self.zero.iter().copied(), go_on),
            other => (other, None),
        };
        (made, state)
    }
}

impl Branch {
    /// Whether its displacements have their signs.
    pub(super) fn signs_hold(&self, values: &[BigRational]) -> bool {
        self.signs.iter().all(|&(variable, up)| match up {
            true => !values[variable].is_negative(),
            false => !values[variable].is_positive(),
        })
    }

    /// Whether its zeros and its signs hold.
    pub fn holds(&self, values: &[BigRational]) -> bool {
        self.signs_hold(values) && self.zero.iter().all(|&variable| values[variable].is_zero())
    }
}

/// Of a contact system with this R. Forms pair by pair: x_n, then x_t of a frictionless one, else the reserves and, in space,
/// turn^k of the facets that are not mirrors.
pub(super) fn of_contact(contact: &ProvedContact, stiffness: &[Vec<BigRational>]) -> Forms {
    let force = |joint: usize| -> Vec<BigRational> {
        let row = &stiffness[joint];
        let gaps = contact.laws.iter().map(PairLaw::gap).zip(row).filter(|(gap, _)| *gap != 0.0);
        let closed: BigRational = gaps.map(|(gap, entry)| rational(gap) * entry).sum();
        row.iter().cloned().chain([rational(contact.load[joint]) - closed]).collect()
    };
    let mut made = Forms::unknowns_of(contact);
    for (pair, (law, id)) in contact.laws.iter().zip(&contact.ids).enumerate() {
        let (normal, slips) = (force(pair), contact.slips(pair));
        let tangential: Vec<Vec<BigRational>> = slips.clone().map(force).collect();
        let x_n = made.add(format!("x_n {id}"), normal.clone(), !law.is_bilateral());
        let branches = match law.tangential {
            TangentialJoint::Free => {
                let words = if contact.tangents == 1 { &["x_t"][..] } else { &["x_t1", "x_t2"] };
                for ((word, form), z_t) in words.iter().zip(tangential).zip(slips) {
                    let x_t = made.add(format!("{word} {id}"), form, false);
                    made.zero.push(x_t);
                    if stiffness.iter().all(|row| row[z_t].is_zero()) {
                        made.zero.push(z_t);
                    }
                }
                frictionless(pair, x_n)
            }
            TangentialJoint::Bounded { friction, fixed } => {
                let f = rational(friction);
                let mut bound: Vec<BigRational> = normal.iter().map(|n| &f * n).collect();
                bound.iter_mut().next_back().into_iter().for_each(|constant| *constant += rational(fixed));
                rubbing(&mut made, contact, pair, x_n, (bound, tangential))
            }
        };
        made.groups.push(Group { name: id.clone(), branches });
    }
    made
}

impl Forms {
    /// Adds a form; its variable.
    fn add(&mut self, name: String, form: Vec<BigRational>, signed: bool) -> usize {
        self.names.push(name);
        self.forms.push(form);
        self.signed.push(signed);
        self.names.len() - 1
    }
}

fn frictionless(z_n: usize, x_n: usize) -> Vec<Branch> {
    let branch = |name: &str, zero| Branch { name: name.to_owned(), zero: vec![zero], signs: Vec::new() };
    vec![branch("closed", z_n), branch("open", x_n)]
}

/// The forms and branches of a pair with friction; `bound` is f x_n + c, `tangential` λ along the tangents.
fn rubbing(
    made: &mut Forms,
    contact: &ProvedContact,
    pair: usize,
    x_n: usize,
    (bound, tangential): (Vec<BigRational>, Vec<Vec<BigRational>>),
) -> Vec<Branch> {
    let (law, id, polygon, slips) = (&contact.laws[pair], &contact.ids[pair], contact.polygon, contact.slips(pair));
    let in_plane = polygon == Polygon::PLANE;
    let mut reserves = Vec::new();
    for facet in 0..polygon.facets() {
        let mut form = bound.clone();
        for (row, part) in tangential.iter().zip(polygon.direction(facet)) {
            let part = rational(part);
            form.iter_mut().zip(row).for_each(|(sum, entry)| *sum += &part * entry);
        }
        let word = match (in_plane, facet) {
            (true, 0) => "x+".to_owned(),
            (true, _) => "x-".to_owned(),
            (false, facet) => format!("x^{facet}"),
        };
        reserves.push(made.add(format!("{word} {id}"), form, true));
    }
    let turns: Vec<usize> = match in_plane {
        true => slips.clone().collect(),
        false => (slip_forms(polygon).into_iter().enumerate())
            .map(|(facet, parts)| {
                let mut form = vec![BigRational::zero(); made.unknowns + 1];
                slips.clone().zip(parts).for_each(|(z_t, part)| form[z_t] = rational(part));
                made.add(format!("turn^{facet} {id}"), form, false)
            })
            .collect(),
    };
    let of = |prefix: &str, normal: usize| -> Vec<Branch> {
        let branch = |state: Tangential| {
            let conditions = state.conditions(polygon);
            let held = if state == Tangential::Stick { slips.clone() } else { 0..0 };
            let zero = [normal].into_iter().chain(held).chain(conditions.reserves.iter().map(|facet| reserves[*facet]));
            Branch {
                name: format!("{prefix}{}", state.word(polygon)),
                zero: zero.chain(conditions.zero.iter().map(|form| turns[*form])).collect(),
                signs: conditions.signs.iter().map(|&(form, up)| (turns[form], up)).collect(),
            }
        };
        Tangential::all(polygon).into_iter().map(branch).collect()
    };
    let mut all = of("", pair);
    if law.is_bilateral() {
        // Without a bound and where no force feels its slip it rolls: that is no other state.
        if law.fixed_bound() == 0.0 && tangential.iter().flat_map(|row| &row[..made.unknowns]).all(Zero::is_zero) {
            made.zero.extend(slips);
            all.truncate(1);
        }
        return all;
    }
    if law.fixed_bound() > 0.0 {
        all.extend(of("open ", x_n));
    } else {
        let zero = [x_n].into_iter().chain(reserves.iter().copied().take(2)).collect();
        all.push(Branch { name: "open".to_owned(), zero, signs: Vec::new() });
    }
    all
}
