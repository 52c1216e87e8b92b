//! Rates of the answer within its scheme: what one more unit of a parameter does, from one extra solve.

use std::sync::Arc;

use crate::contact::force_form::constants;
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::direction;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Point, RayDirection};
use crate::lcp::variable::Variable;
use crate::model::parameter::{Number, ParameterValues};
use crate::model::scenario::Scenario;
use crate::model::uses::Region;
use crate::solve::Prepared;
use crate::solve::problem::problem_by;

/// d(problem)/dθ, factors of the load cases included, at these values for a parameter θ, with R and RF as they are. The
/// last cases are what earlier ones grow by per unit of θ ([`LoadRates`](crate::solve::load_rates::LoadRates));
/// `growing`: the indices of these earlier ones.
pub(crate) fn problem_rates(
    prepared: &Prepared,
    system: &Arc<ContactSystem>,
    values: &ParameterValues,
    name: &str,
    growing: &[usize],
) -> ContactProblem {
    let along = values.along(name);
    let rate = |number: &Number| number.along(&along).rate;
    let own = &prepared.cases[..prepared.cases.len() - growing.len()];
    // (factor F)′ = factor′ F + factor F′.
    let grown = growing.iter().map(|&case| own[case].1.value(values));
    let factors: Vec<f64> = own.iter().map(|(_, factor)| rate(factor)).chain(grown).collect();
    problem_by(system, &factors, &rate)
}

/// Where a parameter stands apart from laws, factors and amounts of loads, in words: those places cannot be followed.
/// `None` if nowhere.
pub(crate) fn fixed_place(scenario: &Scenario, name: &str) -> Option<String> {
    if let Some(path) = scenario.uses.place(name, Region::Geometry) {
        return Some(format!("it stands in the geometry or stiffness ({path}): `sweep {name} A..B` varies it"));
    }
    in_loads(scenario.uses.place(name, Region::Load)?, name)
}

/// The same, amounts of loads included.
pub(crate) fn place_beside_laws(scenario: &Scenario, name: &str) -> Option<String> {
    fixed_place(scenario, name).or_else(|| in_loads(scenario.uses.place(name, Region::Amount)?, name))
}

fn in_loads(path: &str, name: &str) -> Option<String> {
    Some(format!("it stands in the loads ({path}): `sweep {name} A..B` varies it"))
}

/// The LCP at `point` with d = dM/dθ z + dq/dθ as covering: to first order w = M z + q + (θ − θ₀) d.
pub(crate) fn rate_lcp(
    problem: &ContactProblem,
    contact: &ContactLcp,
    point: &Point,
    rates: &ContactProblem,
    sign: f64,
) -> MirroredLcp {
    let system = &*problem.system;
    let mut lcp = MirroredLcp::clone(&contact.lcp);
    if system.force_form.is_some() {
        let rates = with_friction_as_cohesion(contact, point, rates);
        lcp.covering = sign * constants(system, contact, &rates.joint_constants(), &rates.fixed_bounds());
        return lcp;
    }
    let load = rates.joint_constants() * (sign / contact.force_unit);
    for (i, pair) in system.pairs.iter().enumerate() {
        let x_n = contact.normal_row[i].map_or(0.0, |row| point.w[row]);
        if let Some(row) = contact.normal_row[i] {
            lcp.covering[row] = load[i];
        }
        let (Some(row), Some(joint)) = (contact.facet_rows[0][i], pair.plane_tangential()) else {
            continue;
        };
        let rate = &rates.laws[i];
        let bound = sign * (rate.friction() * x_n + rate.fixed_bound() / contact.force_unit);
        lcp.covering[row] = load[joint] + problem.laws[i].friction() * load[i] + bound;
        if let Some(mirror) = &mut lcp.mirrors[row] {
            mirror.covering = 2.0 * bound;
        }
    }
    lcp
}

/// The rates with what a friction that moves adds to the bound, f′ x_n, as a rate of the cohesion.
pub(crate) fn with_friction_as_cohesion(contact: &ContactLcp, point: &Point, rates: &ContactProblem) -> ContactProblem {
    let mut rates = rates.clone();
    for pair in 0..rates.laws.len() {
        if let Some(row) = contact.normal_row[pair] {
            let pressed = if contact.swapped[row] { point.z[row] } else { point.w[row] };
            let rate = &mut rates.laws[pair];
            *rate = rate.with_fixed_bound(rate.fixed_bound() + rate.friction() * pressed * contact.force_unit);
        }
    }
    rates
}

/// dz/dθ and dw/dθ within the scheme, dimensionless; `None` where its equations are singular.
pub(crate) fn rate(lcp: &MirroredLcp, basis: &Basis) -> Option<RayDirection> {
    direction(lcp, basis, Variable::P)
}
