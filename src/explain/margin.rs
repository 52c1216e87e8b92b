//! How far the final working scheme holds: when a load factor or a friction parameter moves, which joint turns first.
//!
//! Within one scheme every quantity is linear in the load factors: those margins are exact. In a friction parameter it
//! is a rational function: that margin comes from a search over a grid and bisection, and says so.

use nalgebra::DVector;
use serde::Serialize;

use super::vertex::value;
use crate::contact::lcp::contact_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{Quantity, RowKind};
use crate::contact::system::JointLoad;
use crate::contact::written::{ContactLcp, CoveringError};
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::outcome::Point;
use crate::lcp::variable::Variable;
use crate::model::rules::Covering;

/// Points of the search in a friction parameter, each way.
const GRID: usize = 64;
/// Released joints up to which a friction parameter is searched.
pub const MOST_RELEASED: usize = 200;
/// Relative size of a basic variable below which it is at its limit already.
const AT_LIMIT: f64 = 1e-10;

/// A joint that turns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Turn {
    /// Value of the parameter.
    pub at: f64,
    /// Id of the pair.
    pub pair: String,
    /// What happens: "uses up its reserve x+".
    pub what: String,
}

/// First turns when one parameter moves.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Margin {
    /// "factor of load case `pull`", "friction f".
    pub parameter: String,
    /// Its present value.
    pub present: f64,
    /// First turn of any pair downwards.
    pub down: Option<Turn>,
    /// First turn of any pair upwards.
    pub up: Option<Turn>,
    /// First turn of the pair asked for, downwards, if the others did not turn before.
    pub own_down: Option<Turn>,
    /// The same upwards.
    pub own_up: Option<Turn>,
    /// Exact (linear), or found by a search.
    pub exact: bool,
}

/// A final scheme: all that its margins need.
#[derive(Clone, Copy)]
pub struct FinalScheme<'a> {
    /// Its LCP.
    pub contact: &'a ContactLcp,
    /// The problem.
    pub problem: &'a ContactProblem,
    /// The basis, p not in it.
    pub basis: &'a Basis,
    /// The vertex, dimensionless.
    pub point: &'a Point,
}

/// Basic variables that may not become negative: not the reserves and slips of open pairs without cohesion.
fn watched(scheme: &FinalScheme) -> Vec<Variable> {
    let FinalScheme { contact, problem, basis, .. } = scheme;
    super::vertex::basics(&contact.lcp, basis)
        .into_iter()
        .filter(|variable| {
            let (Variable::W(row) | Variable::Z(row)) = variable else {
                return false;
            };
            let meaning = contact.rows[*row];
            let open = contact.normal_row[meaning.pair]
                .is_some_and(|row| basis.z.binary_search(&row).is_ok() != contact.swapped[row]);
            let loose = open && problem.laws[meaning.pair].fixed_bound() == 0.0;
            !loose || meaning.couple == RowKind::Normal
        })
        .collect()
}

fn what(scheme: &FinalScheme, variable: Variable) -> (usize, &'static str) {
    let Some((row, quantity)) = scheme.contact.quantity(variable) else {
        return (0, "p");
    };
    let force = quantity == Quantity::Force;
    let meaning = scheme.contact.rows[row];
    let words = match (meaning.couple, force) {
        (RowKind::Normal, true) => "loses its contact force",
        (RowKind::Normal, false) => "comes into contact",
        (RowKind::PLUS, true) => "uses up its reserve x+",
        (RowKind::Facet(_), true) => "uses up its reserve x-",
        (_, false) => "stops slipping",
    };
    (meaning.pair, words)
}

fn turn(scheme: &FinalScheme, at: f64, variable: Variable) -> Turn {
    let (pair, what) = what(scheme, variable);
    Turn { at, pair: scheme.problem.system.pairs[pair].id.clone(), what: what.to_owned() }
}

/// Largest force and displacement of a point in the user's units.
fn sizes(contact: &ContactLcp, point: &Point) -> (f64, f64) {
    let (mut force, mut length) = (0.0_f64, 0.0_f64);
    for row in 0..contact.rows.len() {
        for variable in [Variable::W(row), Variable::Z(row)] {
            match contact.quantity(variable) {
                Some((_, Quantity::Displacement)) => length = length.max(value(point, variable).abs()),
                _ => force = force.max(value(point, variable).abs()),
            }
        }
    }
    (force, length)
}

/// Margins in the factor of a load case; `name` is how it is called in the scenario.
pub fn load_margin(
    scheme: &FinalScheme,
    pair: usize,
    (name, load): (&str, &JointLoad),
    present: f64,
) -> Option<Margin> {
    let unmoved = scheme.problem.laws.iter().map(|law| law.with_gap(0.0).with_fixed_bound(0.0)).collect();
    let mut rate = ContactProblem::exactly(&scheme.problem.system, unmoved, DVector::zeros(load.vector.len()));
    rate.add_load(1.0, &load.vector, &load.terms);
    let rate = rate.without_load_noise();
    // Only M and q of this LCP are used: any covering that can be written will do.
    let change = contact_lcp(&rate, Covering::Ones).ok()?;
    let rates = change.in_units(&vertex(&change.lcp, scheme.basis)?);
    let values = scheme.contact.in_units(scheme.point);
    let (force, length) = sizes(scheme.contact, &values);
    let (force_rate, length_rate) = sizes(scheme.contact, &rates);
    let mut margin = Margin {
        parameter: format!("factor of load case `{name}`"),
        present,
        down: None,
        up: None,
        own_down: None,
        own_up: None,
        exact: true,
    };
    for variable in watched(scheme) {
        let (value, rate) = (value(&values, variable), value(&rates, variable));
        let (size, rate_size) = match scheme.contact.quantity(variable) {
            Some((_, Quantity::Displacement)) => (length, length_rate),
            _ => (force, force_rate),
        };
        if rate.abs() <= 1e-12 * rate_size {
            continue;
        }
        let value = if value <= AT_LIMIT * size { 0.0 } else { value };
        let step = value / rate;
        let at = present - step;
        // A difference of equal numbers is 0, not a factor of 1e-15.
        let at = if at.abs() <= 1e-12 * present.abs().max(step.abs()) { 0.0 } else { at };
        let own = what(scheme, variable).0 == pair;
        let sooner = |slot: &mut Option<Turn>, up: bool| {
            let earlier = slot.as_ref().is_none_or(|found| if up { at < found.at } else { at > found.at });
            if earlier {
                *slot = Some(turn(scheme, at, variable));
            }
        };
        if rate < 0.0 {
            sooner(&mut margin.up, true);
            if own {
                sooner(&mut margin.own_up, true);
            }
        } else {
            sooner(&mut margin.down, false);
            if own {
                sooner(&mut margin.own_down, false);
            }
        }
    }
    Some(margin)
}

/// Margins in a friction parameter; `at` gives the problem for a value of it, `end` is the largest value looked at.
pub fn friction_margin(
    scheme: &FinalScheme,
    pair: usize,
    name: &str,
    present: f64,
    end: f64,
    at: &dyn Fn(f64) -> ContactProblem,
) -> Option<Margin> {
    if scheme.basis.z.len() > MOST_RELEASED {
        return None;
    }
    let watched = watched(scheme);
    // Basic variables in user's units relative to the present sizes, and which of them is most negative.
    let now = scheme.contact.in_units(scheme.point);
    let (force, length) = sizes(scheme.contact, &now);
    let worst = |parameter: f64, own: bool| -> Option<(f64, Variable)> {
        let lcp: Result<ContactLcp, CoveringError> = contact_lcp(&at(parameter), Covering::Ones);
        let lcp = lcp.ok()?;
        let point = lcp.in_units(&vertex(&lcp.lcp, scheme.basis)?);
        watched
            .iter()
            .filter(|variable| !own || what(scheme, **variable).0 == pair)
            .map(|variable| {
                let size = match lcp.quantity(*variable) {
                    Some((_, Quantity::Displacement)) => length,
                    _ => force,
                };
                let size = if size > 0.0 { size } else { 1.0 };
                (value(&point, *variable) / size, *variable)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let search = |target: f64, own: bool| -> Option<Turn> {
        let mut good = present;
        for k in 1..=GRID {
            let next = present + (target - present) * k as f64 / GRID as f64;
            let fails = |parameter: f64| worst(parameter, own).is_none_or(|(least, _)| least < -AT_LIMIT);
            if fails(next) {
                let mut bad = next;
                for _ in 0..60 {
                    let middle = 0.5 * (good + bad);
                    if fails(middle) {
                        bad = middle;
                    } else {
                        good = middle;
                    }
                }
                let (_, variable) = worst(bad, own)?;
                return Some(turn(scheme, good, variable));
            }
            good = next;
        }
        None
    };
    Some(Margin {
        parameter: format!("friction {name}"),
        present,
        down: (present > 0.0).then(|| search(0.0, false)).flatten(),
        up: search(end, false),
        own_down: (present > 0.0).then(|| search(0.0, true)).flatten(),
        own_up: search(end, true),
        exact: false,
    })
}
