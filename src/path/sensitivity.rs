//! Sensitivity: derivatives of slips and forces with respect to every parameter, from the final scheme, in space from
//! Newton's equations on Coulomb's cone.

use nalgebra::DVector;
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::rate::{fixed_place, problem_rates, rate, rate_lcp, with_friction_as_cohesion};
use super::start::{PathError, final_basis, state_of};
use crate::answer::attempt::AttemptEngine;
use crate::answer::pairs::JointState;
use crate::answer::record::{PairState, Slip};
use crate::contact::cone_rates::{Standing, rates_of_unknowns};
use crate::contact::force_form::unknowns;
use crate::contact::problem::ContactProblem;
use crate::contact::sums::{is_still, joint_forces};
use crate::contact::system::{ContactPair, ContactSystem};
use crate::contact::written::ContactLcp;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::outcome::{Point, RayDirection};
use crate::model::uses::Region;
use crate::solve::state::RunData;
use crate::solve::{Case, PrepareError, Prepared, Solved};

/// A variable of an answer counts as exactly on its limit below this multiple of the largest.
const ON_LIMIT: f64 = 1e-11;

/// Derivatives at one pair, in the user's units per unit of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct PairRate {
    /// Id of the pair.
    pub pair: String,
    /// dx_n/dθ.
    pub x_n: f64,
    /// dx_τ/dθ; in space of its magnitude.
    pub x_t: f64,
    /// dz_n/dθ.
    pub z_n: f64,
    /// dz_τ/dθ; in space of its magnitude.
    pub z_t: f64,
    /// In space dx_τ/dθ and dz_τ/dθ along t1 and t2.
    pub space: Option<[[f64; 2]; 2]>,
}

impl PairRate {
    /// The pair after a step of θ.
    pub fn moved(&self, pair: &PairState, step: f64) -> PairState {
        let mut moved = PairState {
            x_n: pair.x_n + step * self.x_n,
            x_t: pair.x_t + step * self.x_t,
            z_n: pair.z_n + step * self.z_n,
            z_t: pair.z_t + step * self.z_t,
            ..pair.clone()
        };
        if let (Some(space), Some([x_t, z_t])) = (&mut moved.space, self.space) {
            for t in 0..2 {
                space.x_t[t] += step * x_t[t];
                space.z_t[t] += step * z_t[t];
            }
            (moved.x_t, moved.z_t) = (space.x_t[0].hypot(space.x_t[1]), space.z_t[0].hypot(space.z_t[1]));
        }
        moved
    }
}

impl Serialize for PairRate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let slip = |plane: f64, of: usize| self.space.map_or(Slip::Plane(plane), |space| Slip::Space(space[of]));
        let mut map = serializer.serialize_map(Some(5))?;
        map.serialize_entry("pair", &self.pair)?;
        map.serialize_entry("x_n", &self.x_n)?;
        map.serialize_entry("x_t", &slip(self.x_t, 0))?;
        map.serialize_entry("z_n", &self.z_n)?;
        map.serialize_entry("z_t", &slip(self.z_t, 1))?;
        map.end()
    }
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

/// Derivatives with respect to every parameter of the scenario that stands in laws, factors and amounts of loads only,
/// in amounts linearly.
///
/// # Errors
/// Where there is no answer, or a bare LCP.
pub fn sensitivity(case: Case<'_>, solved: &Solved) -> Result<Sensitivity, PathError> {
    let Case { scenario, prepared, values, .. } = case;
    let system = prepared.system().ok_or(PathError::Plain("sensitivity"))?;
    let end = End::of(system, solved)?;
    let mut parameters = Vec::new();
    let settable = scenario.parameters.iter().filter(|(_, parameter)| parameter.formula.is_none());
    for name in settable.map(|(name, _)| name).filter(|name| fixed_place(scenario, name).is_none()) {
        let grown = match scenario.uses.place(name, Region::Amount) {
            None => None,
            Some(_) => match case.load_rates(name) {
                Ok(grown) => Some(grown),
                // A number that is not a linear function of it.
                Err(PrepareError::Problems(_)) => continue,
                Err(PrepareError::Interrupted) => return Err(PathError::Interrupted),
            },
        };
        let (prepared, growing) =
            grown.as_ref().map_or((prepared, &[][..]), |grown| (&*grown.prepared, &grown.growing[..]));
        let loaded = prepared.system().unwrap_or(system);
        let loaded = loaded.yielding.as_ref().map_or(loaded, |yielding| &yielding.exact);
        let rates = problem_rates(prepared, loaded, values, name, growing);
        parameters.push(ParameterRate {
            parameter: name.clone(),
            value: values.get(name).copied().unwrap_or_default(),
            pairs: end.rates(prepared, &rates)?,
        });
    }
    Ok(Sensitivity { parameters, on_limit: on_limit(&solved.answer.pairs) })
}

/// The equations that stay those of the answer while a parameter moves a little.
enum End<'a> {
    /// Of the final scheme, in the plane.
    Scheme {
        system: &'a ContactSystem,
        solved: &'a Solved,
        contact: &'a ContactLcp,
        problem: &'a ContactProblem,
        basis: Basis,
        point: Point,
    },
    /// Of Newton's method, on Coulomb's cone; joints that repeat one another as they are.
    Cone { solved: &'a Solved, problem: ContactProblem },
}

fn singular() -> PathError {
    PathError::Missing("the equations of the final scheme are singular: there are no derivatives".to_owned())
}

fn undetermined(system: &ContactSystem) -> PathError {
    let why = "how they share their forces has no derivative of its own";
    PathError::Missing(system.dependence_refusal("sensitivity", why).unwrap_or_default())
}

/// The problem with joints that repeat one another as they are, where its motion determines what they carry.
fn determined(problem: &ContactProblem, solved: &Solved) -> Result<ContactProblem, PathError> {
    let Some(yielding) = &problem.system.yielding else { return Ok(problem.clone()) };
    let z = problem.system.over_joints(solved.answer.pairs.iter().map(|shown| (shown.z_n, shown.slip())));
    match yielding.exactly(problem) {
        Some(exact) if yielding.undetermined(problem, &z, false).is_empty() => Ok(exact),
        _ => Err(undetermined(&problem.system)),
    }
}

impl<'a> End<'a> {
    fn of(system: &'a ContactSystem, solved: &'a Solved) -> Result<End<'a>, PathError> {
        let nothing = || {
            let why = match solved.answer.is_answer() && solved.answer.rules.engine == AttemptEngine::AtRest {
                true => {
                    "the answer is known with the joints that repeat one another at rest, and what these carry is not determined: it \
                     has no derivatives; `sweep` solves at values beside it"
                }
                false => "there is no answer whose derivatives could be taken",
            };
            PathError::Missing(why.to_owned())
        };
        let RunData::Contact { contact, problem, .. } = &solved.run else { return Err(nothing()) };
        if system.is_in_space() {
            return match &solved.answer.polygon {
                Some(polygon) if solved.answer.is_answer() && polygon.cone => {
                    Ok(End::Cone { problem: determined(problem, solved)?, solved })
                }
                Some(_) if solved.answer.is_answer() => Err(PathError::Missing(
                    "`sensitivity` follows an answer on Coulomb's cone, and this one is on the polygon: `set cone on`, or \
                     more facets, may lead to one"
                        .to_owned(),
                )),
                _ => Err(nothing()),
            };
        }
        let basis = final_basis(solved).ok_or_else(nothing)?;
        // Afresh, forces included: a warm answer keeps only its displacements.
        let point = vertex(&contact.lcp, &basis).ok_or_else(singular)?;
        if system.force_form.is_some() && !state_of(problem, contact, &point).free.is_empty() {
            return Err(undetermined(system));
        }
        Ok(End::Scheme { system, solved, contact, problem, basis, point })
    }

    /// The rates of the pairs where these are the rates of the problem.
    fn rates(&self, prepared: &Prepared, rates: &ContactProblem) -> Result<Vec<PairRate>, PathError> {
        match self {
            End::Cone { solved, problem } => {
                rates_on_cone(prepared, problem, rates, &solved.answer.pairs).ok_or_else(singular)
            }
            End::Scheme { system, solved, contact, problem, basis, point } => {
                let lcp = rate_lcp(problem, contact, point, rates, 1.0);
                let direction = rate(&lcp, basis).ok_or_else(singular)?;
                Ok(rates_of_scheme(prepared, (system, contact, point), rates, &direction, &solved.answer.pairs))
            }
        }
    }
}

fn rates_of_scheme(
    prepared: &Prepared,
    (system, contact, point): (&ContactSystem, &ContactLcp, &Point),
    rates: &ContactProblem,
    direction: &RayDirection,
    pairs: &[PairState],
) -> Vec<PairRate> {
    let mut shown = pairs.to_vec();
    if system.force_form.is_some() {
        let rates = with_friction_as_cohesion(contact, point, rates);
        let unknowns = unknowns(system, Some(&rates), contact, &direction.z);
        let state = JointState::at(&rates, unknowns, 0.0);
        prepared.add_released_slips(&mut shown, &rates, &state.z);
        return rates_of_state(system, &state, &shown);
    }
    let z = contact.joint_displacements(system, &direction.z) * contact.length_unit;
    // A rate below the rounding of its terms is 0.
    let forces = joint_forces(rates, &z);
    let z = DVector::from_fn(z.len(), |k, _| if is_still(system, &z, &forces, k) { 0.0 } else { z[k] });
    // The released slips are linear in all of this, so their rates follow from the rates.
    prepared.add_released_slips(&mut shown, rates, &z);
    let pairs = system.pairs.iter().enumerate();
    pairs
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
                space: None,
            }
        })
        .collect()
}

/// The same on Coulomb's cone.
fn rates_on_cone(
    prepared: &Prepared,
    problem: &ContactProblem,
    rates: &ContactProblem,
    pairs: &[PairState],
) -> Option<Vec<PairRate>> {
    let system = &*problem.system;
    let standing = |pair: &PairState| Standing {
        open: pair.z_n > 0.0,
        pressed: pair.x_n,
        bound: pair.bound,
        slip: pair.space.map_or([0.0; 2], |space| space.z_t),
    };
    let standing: Vec<Standing> = pairs.iter().map(standing).collect();
    let unknowns = rates_of_unknowns(problem, rates, &standing)?;
    let responses = joint_forces(rates, &unknowns);
    let still = |k: usize| is_still(system, &unknowns, &responses, k);
    let unknowns = DVector::from_fn(unknowns.len(), |k, _| if still(k) { 0.0 } else { unknowns[k] });
    let response = |k: usize| responses[k].cleaned();
    let z = DVector::from_fn(unknowns.len(), |k, _| if system.is_forced(k) { response(k) } else { unknowns[k] });
    let force = |k: usize| if system.is_forced(k) { unknowns[k] } else { response(k) };
    let mut shown = pairs.to_vec();
    prepared.add_released_slips(&mut shown, rates, &z);
    // d|v| = v·dv / |v|.
    let of_size = |[a, b]: [f64; 2], [da, db]: [f64; 2]| {
        let size = a.hypot(b);
        if size > 0.0 { (a * da + b * db) / size } else { da.hypot(db) }
    };
    let rate = |(i, (pair, at)): (usize, (&ContactPair, &PairState))| {
        let open = at.z_n > 0.0;
        let mut x_t = [0.0; 2];
        let mut z_t = shown[i].space.map_or([0.0; 2], |space| space.z_t);
        for (t, joint) in pair.tangential.clone().enumerate() {
            x_t[t] = if at.bound == 0.0 { 0.0 } else { force(joint) };
            z_t[t] = z[joint];
        }
        let own = at.space.map_or([[0.0; 2]; 2], |space| [space.x_t, space.z_t]);
        PairRate {
            pair: pair.id.clone(),
            x_n: if open { 0.0 } else { force(i) },
            x_t: of_size(own[0], x_t),
            z_n: z[i],
            z_t: of_size(own[1], z_t),
            space: Some([x_t, z_t]),
        }
    };
    Some(system.pairs.iter().zip(pairs).enumerate().map(rate).collect())
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
            space: None,
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
