//! Turning points of a path in space: places beyond which its answer goes on with a falling load only.
//!
//! Within a scheme the answers are a smooth curve, which turns where z goes like ± √ of what is left of the load: the
//! answers behind the turn mirror those before it. Where a pair changes its state the curve has a corner, and may go
//! back from there: the rates of the states that follow say where to. Newton's method finds the answer behind the turn
//! from either guess, and what it finds counts only near it.

use std::ops::Range;

use nalgebra::DVector;

use super::aim::Aim;
use super::over::{Over, Path};
use super::stand::{Place, Stand, displacements};
use crate::answer::record::{PairState, State};
use crate::contact::cone_rates::{Standing, rates_of_unknowns};
use crate::contact::problem::ContactProblem;
use crate::path::cone_step::Stepper;
use crate::path::start::PathError;

/// What is left of an inequality below this share of its kind: the pair is about to change its state.
const LEFT: f64 = 1e-6;
/// Shares of the range by which the first place behind a corner lies off.
const SHARES: [f64; 4] = [1e-4, 1e-5, 1e-6, 1e-3];
/// Shares of the range within which a place before the turn is mirrored: nearer the digits of the turn count, farther
/// it is no mirror.
const MIRRORED: [f64; 2] = [1e-7, 1e-2];
/// An answer behind a turn lies at most this share of its way from the guess.
const NEAR: f64 = 0.5;
/// A slip that begins, as a share of the bound over the stiffness: along its direction it counts as one, and across it
/// is held.
const BEGUN: f64 = 1e-7;

impl Path<'_> {
    /// The first place in which the curve of answers goes on from `last`, the end of the places in the last scheme,
    /// where the nearest answer a step ahead lies away from it, the load going one of these ways. `None` where none was
    /// found.
    pub(super) fn continued(
        &self,
        stepper: &Stepper<'_>,
        (places, scheme): (&[Place], Range<usize>),
        last: &Stand,
        (ways, aim): (&[f64], &Aim),
    ) -> Result<Option<Stand>, PathError> {
        match self.behind_corner(stepper, places, last, (ways, aim))? {
            None if ways.len() > 1 => self.mirrored(stepper, &places[scheme], last, aim),
            found => Ok(found),
        }
    }

    /// z′ over the joints per unit of the load where the pairs of `last` change their states so; `None` where the
    /// equations are singular, or over friction.
    fn rates(&self, problem: &ContactProblem, last: &Stand, group: &[(usize, State)]) -> Option<DVector<f64>> {
        let Over::Load(parameter, _) = self.over else { return None };
        let laws = problem.laws.iter().map(|law| law.with_gap(0.0).with_friction(0.0).with_fixed_bound(0.0));
        let rates = ContactProblem::exactly(&problem.system, laws.collect(), parameter.direction(&problem.system));
        rates_of_unknowns(problem, &rates, &standing_after(problem, &last.place.pairs, group))
    }

    /// z at a value where it goes on from `here` alone; `None` where nothing says how.
    pub(super) fn ahead(&self, here: &Stand, value: f64) -> Result<Option<DVector<f64>>, PathError> {
        let rate = self.rates(&self.problem(here.value())?, here, &[]);
        Ok(rate.map(|rate| &here.step.z + (value - here.value()) * rate))
    }

    /// Behind a smooth turn, in the same scheme.
    fn mirrored(
        &self,
        stepper: &Stepper<'_>,
        places: &[Place],
        last: &Stand,
        aim: &Aim,
    ) -> Result<Option<Stand>, PathError> {
        let size = aim.size_at(last.value());
        for place in places.iter().rev() {
            let back = (place.value - last.value()).abs() / size;
            if !(MIRRORED[0]..=MIRRORED[1]).contains(&back) {
                continue;
            }
            let from = displacements(&self.problem(place.value)?, &place.pairs);
            let way = &last.step.z - &from;
            if way.amax() == 0.0 {
                continue;
            }
            let guess = &last.step.z + &way;
            let found = self.near(stepper, place.value, &guess)?;
            let is_there = |found: &Stand| {
                found.step.scheme == last.step.scheme && (&found.step.z - &guess).amax() <= NEAR * way.amax()
            };
            if let Some(found) = found.filter(is_there) {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// Behind a corner, where pairs change their states, with the load growing one of these ways.
    fn behind_corner(
        &self,
        stepper: &Stepper<'_>,
        places: &[Place],
        last: &Stand,
        (ways, aim): (&[f64], &Aim),
    ) -> Result<Option<Stand>, PathError> {
        let problem = self.problem(last.value())?;
        let changing = changing(&problem, places, &last.place.pairs);
        let mut groups: Vec<&[(usize, State)]> = changing.chunks(1).collect();
        if changing.len() > 1 {
            groups.push(&changing);
        }
        for group in groups {
            let mut scheme = last.step.scheme.clone();
            group.iter().for_each(|(pair, state)| scheme[*pair] = (*state, None));
            let Some(rate) = self.rates(&problem, last, group) else { continue };
            for (sign, share) in ways.iter().flat_map(|sign| SHARES.map(|share| (sign, share))) {
                let step = sign * share * aim.size_at(last.value());
                let (value, way) = (last.value() + step, step * &rate);
                let guess = &last.step.z + &way;
                let is_there =
                    |found: &Stand| found.step.scheme == scheme && (&found.step.z - &guess).amax() <= NEAR * way.amax();
                if let Some(found) = self.near(stepper, value, &guess)?.filter(is_there) {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }
}

/// Pairs that are about to change their state, and the state that follows; by the load and by how far they moved on the
/// way.
fn changing(problem: &ContactProblem, places: &[Place], pairs: &[PairState]) -> Vec<(usize, State)> {
    let all = || places.iter().flat_map(|place| &place.pairs);
    let most = |read: fn(&PairState) -> f64| all().map(read).fold(0.0, f64::max);
    let [opening, slip, force] = [most(|pair| pair.z_n), most(|pair| pair.z_t), problem.load_terms.amax()];
    let after = |pair: &PairState| match (pair.state, pair.held) {
        (State::Open, None) if pair.z_n <= LEFT * opening.max(slip) => Some(match pair.space {
            None => State::Closed,
            Some(_) if pair.z_t > LEFT * slip => State::Slip,
            Some(_) => State::Stick,
        }),
        (State::Open, _) => None,
        // A pair with a bound of its own stays.
        _ if pair.x_n.abs() <= LEFT * force && pair.bound <= LEFT * force => Some(State::Open),
        (State::Stick, _) if pair.reserve() <= LEFT * pair.bound => Some(State::Slip),
        (State::Slip, _) if pair.z_t <= LEFT * slip => Some(State::Stick),
        _ => None,
    };
    pairs.iter().enumerate().filter_map(|(i, pair)| Some((i, after(pair)?))).collect()
}

/// How the pairs stand where these have changed.
fn standing_after(problem: &ContactProblem, pairs: &[PairState], group: &[(usize, State)]) -> Vec<Standing> {
    let stiffness = |i: usize| {
        let joints = problem.system.pairs[i].tangential.clone();
        joints.map(|joint| problem.system.stiffness[(joint, joint)]).fold(0.0, f64::max)
    };
    let standing = |(i, pair): (usize, &PairState)| {
        let state = group.iter().find(|(changed, _)| *changed == i).map_or(pair.state, |(_, state)| *state);
        let [friction, slip] = pair.space.map_or([[0.0; 2]; 2], |space| [space.x_t, space.z_t]);
        let size = friction[0].hypot(friction[1]);
        let slip = match state {
            State::Stick | State::Closed => [0.0; 2],
            // It begins against the friction.
            State::Slip if pair.state == State::Stick && size > 0.0 && stiffness(i) > 0.0 => {
                friction.map(|part| -part / size * BEGUN * pair.bound / stiffness(i))
            }
            _ => slip,
        };
        let open = state == State::Open;
        Standing { open, pressed: pair.x_n, bound: if open { 0.0 } else { pair.bound }, slip }
    };
    pairs.iter().enumerate().map(standing).collect()
}
