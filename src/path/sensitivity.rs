//! Sensitivity: derivatives of slips and forces with respect to every parameter, from the final scheme.

use nalgebra::DVector;

use super::rate::{fixed_place, problem_rates, rate, rate_lcp, with_friction_as_cohesion};
use super::start::{PathError, final_basis, plane_system, state_of};
use crate::answer::pairs::JointState;
use crate::answer::record::PairState;
use crate::contact::force_form::unknowns;
use crate::contact::sums::{is_still, joint_forces};
use crate::contact::system::ContactSystem;
use crate::lcp::basis_solution::vertex;
use crate::model::uses::Region;
use crate::solve::state::RunData;
use crate::solve::{Case, PrepareError, Solved};

/// A variable of an answer counts as exactly on its limit below this multiple of the largest.
const ON_LIMIT: f64 = 1e-11;

/// Derivatives at one pair, in the user's units per unit of the parameter.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct PairRate {
    /// Id of the pair.
    pub pair: String,
    /// dx_n/dθ.
    pub x_n: f64,
    /// dx_τ/dθ.
    pub x_t: f64,
    /// dz_n/dθ.
    pub z_n: f64,
    /// dz_τ/dθ.
    pub z_t: f64,
}

/// Derivatives of the answer with respect to one parameter.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ParameterRate {
    /// The parameter θ.
    pub parameter: String,
    /// Its present value.
    pub value: f64,
    /// The pairs.
    pub pairs: Vec<PairRate>,
}

/// Derivatives of the answer.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Sensitivity {
    /// For each parameter, in the order of the file.
    pub parameters: Vec<ParameterRate>,
    /// Pairs exactly on a limit: there the derivatives hold to one side only.
    pub on_limit: Vec<String>,
}

/// Derivatives with respect to every parameter of the scenario that stands in laws, factors and amounts of loads only, in
/// those linearly.
///
/// # Errors
/// Where there is no answer, or a bare LCP.
pub fn sensitivity(case: Case<'_>, solved: &Solved) -> Result<Sensitivity, PathError> {
    let Case { scenario, prepared, values, .. } = case;
    let system = plane_system(prepared, "sensitivity", "`sweep` shows how answers change")?;
    let (RunData::Contact { contact, problem, .. }, Some(basis)) = (&solved.run, final_basis(solved)) else {
        return Err(PathError::Missing("there is no answer whose derivatives could be taken".to_owned()));
    };
    let singular =
        || PathError::Missing("the equations of the final scheme are singular: there are no derivatives".to_owned());
    // Afresh, forces included: a warm answer keeps only its displacements.
    let point = vertex(&contact.lcp, &basis).ok_or_else(singular)?;
    if system.force_form.is_some() && !state_of(problem, contact, &point).free.is_empty() {
        let refusal = system.refusal("sensitivity").unwrap_or_default();
        return Err(PathError::Missing(format!("{refusal}: how they share their forces has no derivative of its own")));
    }
    let mut parameters = Vec::new();
    let settable = scenario.parameters.iter().filter(|(_, parameter)| parameter.formula.is_none());
    for name in settable.map(|(name, _)| name).filter(|name| fixed_place(scenario, name).is_none()) {
        let grown = match scenario.uses.place(name, Region::Amount) {
            None => None,
            Some(_) => match case.load_rates(name) {
                Ok(grown) => Some(grown),
                // A number that is no linear function of it.
                Err(PrepareError::Problems(_)) => continue,
                Err(PrepareError::Interrupted) => return Err(PathError::Interrupted),
            },
        };
        let (prepared, growing) =
            grown.as_ref().map_or((prepared, &[][..]), |grown| (&*grown.prepared, &grown.growing[..]));
        let loaded = prepared.system().unwrap_or(system);
        let rates = problem_rates(prepared, loaded, values, name, growing);
        let lcp = rate_lcp(problem, contact, &point, &rates, 1.0);
        let direction = rate(&lcp, &basis).ok_or_else(singular)?;
        if system.force_form.is_some() {
            let rates = with_friction_as_cohesion(contact, &point, &rates);
            let unknowns = unknowns(system, Some(&rates), contact, &direction.z);
            let state = JointState::at(&rates, unknowns, 0.0);
            let mut shown = solved.answer.pairs.clone();
            prepared.add_released_slips(&mut shown, &rates, &state.z);
            let value = values.get(name).copied().unwrap_or_default();
            let pairs = rates_of_state(system, &state, &shown);
            parameters.push(ParameterRate { parameter: name.clone(), value, pairs });
            continue;
        }
        let z = contact.joint_displacements(system, &direction.z) * contact.length_unit;
        // A rate below the rounding of its terms is 0.
        let forces = joint_forces(&rates, &z);
        let z = DVector::from_fn(z.len(), |k, _| if is_still(system, &z, &forces, k) { 0.0 } else { z[k] });
        // The released slips are linear in all of this, so their rates follow from the rates.
        let mut shown = solved.answer.pairs.clone();
        prepared.add_released_slips(&mut shown, &rates, &z);
        let pairs = system
            .pairs
            .iter()
            .enumerate()
            .map(|(i, pair)| {
                let row = |row: Option<usize>| row.map(|row| direction.w[row] * contact.force_unit);
                let of_joint = |value: f64, joint: usize| if forces[joint].is_zero() { 0.0 } else { value };
                let x_n = of_joint(row(contact.normal_row[i]).unwrap_or(forces[i].value), i);
                let reserves = (row(contact.facet_rows[0][i]), row(contact.facet_rows[1][i]));
                PairRate {
                    pair: pair.id.clone(),
                    x_n,
                    x_t: match (reserves, pair.plane_tangential()) {
                        ((Some(plus), Some(minus)), Some(joint)) => of_joint(0.5 * (plus - minus), joint),
                        _ => 0.0,
                    },
                    z_n: contact.normal_row[i].map_or(0.0, |_| z[i]),
                    z_t: pair.plane_tangential().map_or(shown[i].z_t, |joint| z[joint]),
                }
            })
            .collect();
        parameters.push(ParameterRate {
            parameter: name.clone(),
            value: values.get(name).copied().unwrap_or_default(),
            pairs,
        });
    }
    Ok(Sensitivity { parameters, on_limit: on_limit(&solved.answer.pairs) })
}

/// The rates of the pairs where forces and displacements of all joints are those of a state.
fn rates_of_state(system: &ContactSystem, state: &JointState, shown: &[PairState]) -> Vec<PairRate> {
    let force = |joint: usize| state.sum(joint).cleaned();
    (system.pairs.iter().zip(shown).enumerate())
        .map(|(i, (pair, shown))| PairRate {
            pair: pair.id.clone(),
            x_n: force(i),
            x_t: pair.plane_tangential().map_or(0.0, force),
            z_n: state.z[i],
            z_t: pair.plane_tangential().map_or(shown.z_t, |joint| state.z[joint]),
        })
        .collect()
}

/// Pairs that stand exactly between two states.
pub fn on_limit(pairs: &[PairState]) -> Vec<String> {
    let largest = |value: fn(&PairState) -> f64| pairs.iter().map(|pair| value(pair).abs()).fold(0.0, f64::max);
    let force = largest(|pair| pair.x_n).max(largest(|pair| pair.x_t));
    pairs
        .iter()
        .filter(|pair| {
            let zero = |x: f64| x.abs() <= ON_LIMIT * force;
            let open = pair.z_n > 0.0;
            let touching = !pair.law.is_bilateral() && !open && zero(pair.x_n);
            let slipping = pair.law.has_tangential_joint()
                && !open
                && !touching
                && pair.z_t == 0.0
                && (zero(pair.reserve_plus) || zero(pair.reserve_minus));
            touching || slipping
        })
        .map(|pair| pair.id.clone())
        .collect()
}
