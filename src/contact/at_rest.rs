//! An answer in which no joint moves that self-stress reaches.
//!
//! What such joints T carry is free up to self-stress S μ, so that pivots may pass by an answer that holds: they turn the
//! joints in which one self-stress exceeds a law, where another exceeds none. With T as it was built, that is at z = g,
//! the other joints N no longer feel the self-stress,
//!
//! ```text
//!     λ_N = R_NN (z_N − g_N) + RF_N,      λ_T = R_TN (z_N − g_N) + RF_T + S μ
//! ```
//! so that their laws are a problem of its own with a regular R, and the laws of T are rows of a linear program in μ (in
//! space of a conic one). Where nothing but T moves, as where rigid bodies stand on the ground, it has a solution wherever
//! any forces within friction balance the loads; and where none do there is no answer at all.
//!
//! Where a self-stress obeys the laws by itself (a node between two rough faces) any load could be held by wedging the parts
//! hard enough. Nothing says that they are: such an answer is not looked for.

use nalgebra::{DMatrix, DVector};

use super::cone::{ConeFailure, ConePair, ConeProblem, MixedState, answer_on_cone};
use super::on_cone::{as_they_are, cone_pairs};
use super::pivoted::orthonormal;
use super::problem::ContactProblem;
use super::sum::Sum;
use super::sums::{joint_forces, known_to};
use super::system::ContactSystem;
use super::yielding::FELT;
use crate::lcp::linear_program::{LinearProgram, Outcome, TOLERANCE};
use crate::watch::Watch;
use stickslip_numerics::least_norm::least_norm;

/// Room, as a share of the largest force, that forces of least norm keep in every law: the program is exact to [`TOLERANCE`].
const ROOM: f64 = 1e-7;
/// Corrections of what has to be 0 exactly: each gains all digits of the numbers at hand.
const CORRECTIONS: usize = 2;
/// A program takes no longer than this, in seconds.
const BUDGET: f64 = 10.0;
/// Magnifications where the room in the laws is less than the program can tell from 0.
const ZOOMS: [f64; 2] = [1e4, 1e7];

/// An answer in which no pair moves that self-stress reaches.
#[derive(Clone, Debug)]
pub struct AtRest {
    /// The state.
    pub state: MixedState,
    /// Whether its forces are those of least norm.
    pub is_least_norm: bool,
}

/// The answer in which no pair moves that self-stress reaches; `None` where there is none, or where joints do not repeat
/// one another.
///
/// # Errors
/// Stopped from outside.
pub fn at_rest(problem: &ContactProblem, watch: &dyn Watch) -> Result<Option<AtRest>, ConeFailure> {
    let Some(exact) = as_they_are(problem) else { return Ok(None) };
    let built: Vec<f64> = exact.gaps().collect();
    at_rest_where(&exact, &built, watch)
}

/// The same with these pairs as far open as they are now (`openings`, one for each pair) and not slipping from there, in a
/// problem with joints in force form whose slips count from the present ones.
///
/// # Errors
/// Stopped from outside.
pub fn at_rest_where(
    exact: &ContactProblem,
    openings: &[f64],
    watch: &dyn Watch,
) -> Result<Option<AtRest>, ConeFailure> {
    let Some(stress) = exact.system.force_form.as_ref().map(|form| &form.self_stress) else { return Ok(None) };
    let [reached, others] = reached_and_others(&exact.system, stress);
    let Some(mut unknowns) = unmoved(exact, &reached, openings) else { return Ok(None) };
    let pairs = cone_pairs(exact);
    if reached.is_empty() || !move_others(exact, &pairs, &others, &mut unknowns, watch)? {
        return Ok(None);
    }
    let forces = joint_forces(exact, &unknowns);
    let start = DVector::from_fn(unknowns.len(), |joint, _| match exact.system.is_forced(joint) {
        true => 0.0,
        false => forces[joint].value,
    });
    let opening = |pair: usize| if exact.system.is_forced(pair) { forces[pair].cleaned() } else { unknowns[pair] };
    let is_open = |pair: usize| opening(pair) > 0.0 && !exact.system.pairs[pair].law.is_bilateral();
    let open: Vec<bool> = (0..pairs.len()).map(is_open).collect();
    let laws = Laws { exact, pairs: &pairs, reached: &reached, open: &open, start, stress };
    let Some((carried, is_least_norm)) = laws.forces() else { return Ok(None) };
    for joint in (0..unknowns.len()).filter(|&joint| exact.system.is_forced(joint)) {
        unknowns[joint] = carried[joint];
    }
    Ok(Some(AtRest { state: state(exact, &unknowns), is_least_norm }))
}

fn joints(system: &ContactSystem, pair: usize) -> impl Iterator<Item = usize> {
    std::iter::once(pair).chain(system.pairs[pair].tangential.clone())
}

/// The pairs with a joint that self-stress reaches, and the others.
fn reached_and_others(system: &ContactSystem, stress: &DMatrix<f64>) -> [Vec<usize>; 2] {
    let felt = FELT * stress.amax();
    let is_reached = |pair: &usize| joints(system, *pair).any(|joint| stress.row(joint).amax() > felt);
    let (reached, others) = (0..system.pair_count()).partition(is_reached);
    [reached, others]
}

/// The unknowns with the joints that self-stress reaches where they are, and without forces in those in force form. `None`
/// where that is no state: parts that do not fit, or joints in force form that yield.
fn unmoved(exact: &ContactProblem, reached: &[usize], openings: &[f64]) -> Option<DVector<f64>> {
    let system = &*exact.system;
    let mut unknowns = DVector::zeros(system.joint_count());
    for &pair in reached {
        if openings[pair] < 0.0 {
            return None;
        }
        if !system.is_forced(pair) {
            unknowns[pair] = openings[pair];
        }
    }
    let moved = joint_forces(exact, &unknowns);
    let forced: Vec<usize> = (0..unknowns.len()).filter(|&joint| system.is_forced(joint)).collect();
    for pair in 0..system.pair_count() {
        for joint in joints(system, pair).filter(|&joint| system.is_forced(joint)) {
            let yields = forced.iter().any(|&other| system.stiffness[(joint, other)] != 0.0);
            let moved = moved[joint].cleaned();
            let may_move = joint == pair && !system.pairs[pair].law.is_bilateral() && moved > 0.0;
            if yields || !(moved == 0.0 || may_move) {
                return None;
            }
        }
    }
    Some(unknowns)
}

/// The displacements of the pairs that self-stress does not reach, which obey their laws on the cone; `false` where none
/// are found. On a polygon that is solved for its own sake nothing may slip, for its slips are others.
fn move_others(
    exact: &ContactProblem,
    pairs: &[ConePair],
    others: &[usize],
    unknowns: &mut DVector<f64>,
    watch: &dyn Watch,
) -> Result<bool, ConeFailure> {
    if others.is_empty() {
        return Ok(true);
    }
    let system = &*exact.system;
    let mut own: Vec<usize> = others.to_vec();
    let mut own_pairs = Vec::new();
    for &pair in others {
        let first = own.len();
        own.extend(pairs[pair].tangents.clone());
        own_pairs.push(ConePair { tangents: first..own.len(), ..pairs[pair].clone() });
    }
    let forces = joint_forces(exact, unknowns);
    let read = |pick: fn(&Sum) -> f64| DVector::from_fn(own.len(), |row, _| pick(&forces[own[row]]));
    let stiffness = DMatrix::from_fn(own.len(), own.len(), |a, b| system.stiffness[(own[a], own[b])]);
    let problem = ConeProblem {
        stiffness: &stiffness,
        load: &read(|sum| sum.value),
        load_terms: &read(|sum| sum.magnitude),
        rounded: system.rounded,
        kernel: &kernel_of_others(system, &own),
        pairs: &own_pairs,
    };
    let found = match answer_on_cone(&problem, &DVector::zeros(own.len()), watch) {
        Ok(found) => found,
        Err(ConeFailure::Stopped) => return Err(ConeFailure::Stopped),
        Err(_) => return Ok(false),
    };
    own.iter().zip(found.z.iter()).for_each(|(&joint, z)| unknowns[joint] = *z);
    let slips = own_pairs.iter().any(|pair| pair.tangents.clone().any(|joint| found.z[joint] != 0.0));
    Ok(!slips || exact.cone || !system.is_in_space())
}

/// Orthonormal motions that cost nothing and move no joint but these.
fn kernel_of_others(system: &ContactSystem, own: &[usize]) -> DMatrix<f64> {
    let kernel = &system.kernel;
    let held = (0..system.joint_count()).filter(|joint| !own.contains(joint));
    let rows: Vec<DVector<f64>> = held.map(|joint| kernel.row(joint).transpose()).collect();
    let rows: Vec<DVector<f64>> = rows.into_iter().filter(|row| row.norm() > FELT).collect();
    let held = orthonormal(&rows, kernel.ncols());
    let left = DMatrix::identity(kernel.ncols(), kernel.ncols()) - &held * held.transpose();
    let left: Vec<DVector<f64>> =
        left.column_iter().map(|column| column.into_owned()).filter(|column| column.norm() > FELT).collect();
    let motions = kernel * orthonormal(&left, kernel.ncols());
    motions.select_rows(own)
}

/// The laws of the pairs that self-stress reaches, at rest.
struct Laws<'a> {
    exact: &'a ContactProblem,
    pairs: &'a [ConePair],
    reached: &'a [usize],
    /// Of each pair whether it is open.
    open: &'a [bool],
    /// λ without self-stress …
    start: DVector<f64>,
    /// … and the self-stress.
    stress: &'a DMatrix<f64>,
}

impl Laws<'_> {
    /// λ under which all laws hold, and whether they are those of least norm: so in space, unless the laws leave no room to
    /// look for them; else those with the most room. In the plane those of least norm are found from them (see
    /// [`super::self_stress`]).
    fn forces(&self) -> Option<(DVector<f64>, bool)> {
        let bounds = self.reached.iter().map(|&pair| self.exact.laws[pair].fixed_bound()).fold(0.0, f64::max);
        let unit = self.start.amax().max(bounds);
        if unit == 0.0 {
            return Some((self.start.clone(), true));
        }
        if self.is_wedged() {
            return None;
        }
        let (mut program, room) = self.program(unit, 1.0, &[]);
        program.set_costs([(room, -1.0)]);
        let Outcome::Optimum(widest) = program.solve(BUDGET) else { return None };
        let mut amounts = widest.x;
        for zoom in ZOOMS {
            if amounts[room] > ROOM {
                break;
            }
            amounts = program.refined(&amounts, zoom, BUDGET)?;
        }
        if amounts[room] < 0.0 {
            return None;
        }
        let seeks_least = self.exact.system.is_in_space() && amounts[room] > 2.0 * ROOM;
        let least = if seeks_least { self.least_norm(unit) } else { None };
        let is_least_norm = least.is_some();
        let (amounts, unloaded) = least.unwrap_or((amounts, Vec::new()));
        let amounts = DVector::from_fn(self.stress.ncols(), |column, _| unit * amounts[column]);
        let carried = &self.start + self.stress * amounts;
        let carried = self.without_idle(carried, &unloaded)?;
        self.obeyed(&carried, unit).then_some((carried, is_least_norm))
    }

    /// Whether forces obey the laws as exactly as the program is to find them: one that it almost solved may miss them by far more.
    fn obeyed(&self, carried: &DVector<f64>, unit: f64) -> bool {
        self.reached.iter().all(|&i| {
            let (law, tangents) = (&self.exact.laws[i], self.pairs[i].tangents.clone());
            let pressed = if self.open[i] { 0.0 } else { carried[i] };
            let along = tangents.map(|joint| carried[joint] * carried[joint]).sum::<f64>().sqrt();
            (law.is_bilateral() || pressed >= -TOLERANCE * unit)
                && along <= law.bound(pressed.max(0.0)) + TOLERANCE * unit
        })
    }

    /// The same forces with exactly nothing where the laws admit nothing, which the program meets to its tolerance only.
    fn without_idle(&self, mut carried: DVector<f64>, unloaded: &[usize]) -> Option<DVector<f64>> {
        let idle: Vec<usize> = self.reached.iter().flat_map(|&pair| self.idle_joints(pair, unloaded)).collect();
        if idle.is_empty() {
            return Some(carried);
        }
        let rows = self.stress.select_rows(&idle);
        let size = carried.amax();
        for _ in 0..CORRECTIONS {
            let left = DVector::from_fn(idle.len(), |row, _| -carried[idle[row]]);
            carried += self.stress * least_norm(&rows, &left)?;
        }
        // More is left where no self-stress of all takes it away.
        let is_idle = idle.iter().all(|&joint| carried[joint].abs() <= TOLERANCE * size);
        idle.iter().for_each(|&joint| carried[joint] = 0.0);
        is_idle.then_some(carried)
    }

    /// The joints of a pair that carry nothing by its laws: of an open or unloaded one, and of one without friction along
    /// the face.
    fn idle_joints(&self, pair: usize, unloaded: &[usize]) -> Vec<usize> {
        let law = &self.exact.laws[pair];
        let is_idle = self.open[pair] || unloaded.contains(&pair);
        let is_free = law.fixed_bound() == 0.0 && (is_idle || law.friction() == 0.0);
        let tangents = self.pairs[pair].tangents.clone().filter(|_| is_free);
        is_idle.then_some(pair).into_iter().chain(tangents).collect()
    }

    /// Whether a self-stress alone obeys the laws of Coulomb and presses: then the parts could be wedged as hard as one likes,
    /// which no load decides.
    fn is_wedged(&self) -> bool {
        let (mut program, room) = self.program(1.0, 0.0, &[]);
        program.equal(vec![(room, 1.0)], 0.0);
        let rubs = |pair: &&usize| !self.open[**pair] && self.exact.laws[**pair].friction() > 0.0;
        let pressed: Vec<(usize, f64)> =
            self.reached.iter().filter(rubs).flat_map(|&pair| self.force(pair, 1.0)).collect();
        let mut costs = vec![0.0; room + 1];
        pressed.iter().for_each(|&(k, a)| costs[k] -= a);
        program.set_costs(costs.iter().copied().enumerate());
        program.at_most(pressed, 1.0);
        match program.solve(BUDGET) {
            Outcome::Optimum(found) => found.x.iter().zip(&costs).map(|(x, cost)| -x * cost).sum::<f64>() > ROOM,
            _ => true,
        }
    }

    /// The variables of the program: the amounts of the self-stress in this unit of force, then 1 (0 where nothing is
    /// `loaded`), then the room that is left in every law. Pairs that are `unloaded` carry nothing.
    fn program(&self, unit: f64, loaded: f64, unloaded: &[usize]) -> (LinearProgram, usize) {
        let mut program = LinearProgram::default();
        for _ in 0..self.stress.ncols() {
            program.variable(0.0);
        }
        let (one, room) = (program.variable(0.0), program.variable(0.0));
        program.equal(vec![(one, 1.0)], loaded);
        program.at_most(vec![(room, 1.0)], 1.0);
        for &i in self.reached {
            let (pair, law) = (&self.pairs[i], &self.exact.laws[i]);
            let idle = self.idle_joints(i, unloaded);
            idle.iter().for_each(|&joint| program.equal(self.force(joint, unit), 0.0));
            let is_pressed = !law.is_bilateral() && !idle.contains(&i);
            if is_pressed {
                let pressed: Vec<(usize, f64)> = self.force(i, unit).into_iter().chain([(room, -1.0)]).collect();
                program.at_least_length(&pressed, &[]);
            }
            let tangents: Vec<Vec<(usize, f64)>> = (pair.tangents.clone().filter(|joint| !idle.contains(joint)))
                .map(|joint| self.force(joint, unit))
                .collect();
            if !tangents.is_empty() {
                let f = if idle.contains(&i) { 0.0 } else { law.friction() };
                let pressed = self.force(i, unit).into_iter().map(|(k, a)| (k, f * a)).filter(|(_, a)| *a != 0.0);
                let bound: Vec<(usize, f64)> = pressed.chain([(one, law.fixed_bound() / unit), (room, -1.0)]).collect();
                program.at_least_length(&bound, &tangents);
            }
        }
        (program, room)
    }

    /// λ of a joint over the variables.
    fn force(&self, joint: usize, unit: f64) -> Vec<(usize, f64)> {
        let stress = self.stress.row(joint);
        let one = self.stress.ncols();
        let amounts = stress.iter().copied().enumerate();
        amounts.chain([(one, self.start[joint] / unit)]).filter(|(_, a)| *a != 0.0).collect()
    }

    /// The forces of least norm that leave some room in the laws, and the pairs that they do not load: those that would be
    /// loaded by hardly more than this room.
    fn least_norm(&self, unit: f64) -> Option<(Vec<f64>, Vec<usize>)> {
        let found = self.shortest(unit, &[])?;
        let carried = |joint: usize| self.force(joint, unit).iter().map(|(k, a)| a * found[*k]).sum::<f64>();
        let is_idle = |pair: &usize| !self.exact.system.pairs[*pair].law.is_bilateral() && carried(*pair) < 2.0 * ROOM;
        let idle: Vec<usize> = self.reached.iter().copied().filter(is_idle).collect();
        let without = if idle.is_empty() { None } else { self.shortest(unit, &idle) };
        Some(without.map_or((found, Vec::new()), |without| (without, idle)))
    }

    /// The same with these pairs unloaded.
    fn shortest(&self, unit: f64, unloaded: &[usize]) -> Option<Vec<f64>> {
        let (mut program, room) = self.program(unit, 1.0, unloaded);
        let length = program.variable(0.0);
        program.set_costs([(length, 1.0)]);
        program.equal(vec![(room, 1.0)], ROOM);
        let all = self.reached.iter().flat_map(|&pair| joints(&self.exact.system, pair));
        let parts: Vec<Vec<(usize, f64)>> = all.map(|joint| self.force(joint, unit)).collect();
        program.at_least_length(&[(length, 1.0)], &parts);
        match program.solve(BUDGET) {
            Outcome::Optimum(found) => Some(found.x),
            _ => None,
        }
    }
}

/// The state of these unknowns, each force and displacement with the magnitudes of its terms.
fn state(exact: &ContactProblem, unknowns: &DVector<f64>) -> MixedState {
    let system = &*exact.system;
    let responses = joint_forces(exact, unknowns);
    let (mut z, mut z_terms, mut forces) = (unknowns.clone(), DVector::zeros(unknowns.len()), responses.clone());
    for joint in (0..unknowns.len()).filter(|&joint| system.is_forced(joint)) {
        (z[joint], z_terms[joint]) = (responses[joint].cleaned(), responses[joint].magnitude);
        let magnitude = known_to(system, &responses, joint).max(unknowns[joint].abs());
        forces[joint] = Sum { value: unknowns[joint], magnitude };
    }
    MixedState { z, forces, z_terms, steps: 0 }
}
