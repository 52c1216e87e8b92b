//! Load history with memory: the stages of a scenario followed one after the other (theory §6, "Load history").
//!
//! Eq. (8) relates the *total* slip to the force, which is right for one monotone loading from the unloaded state.
//! Here the slip reached so far is a given dislocation, RF + R[:, τ]·z_τ, and (z⁺, z⁻) are increments; z_n stays
//! total. Within a stage all factors move in proportion from the last stage's values to this one's, and that way is
//! followed exactly, breakpoint by breakpoint, not jumped over in one step of eq. (8): one step would let a pair
//! slip to and fro within the stage for nothing and would forget where in the stage a pair stopped, so its end
//! would depend on how the history is cut into stages. Where a pair closes again, or its slip would turn back,
//! the slip so far is committed and the path starts anew from there; in between slips only grow, which is where
//! eq. (8) in increments and the law of slip in rates say the same.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::DVector;

use super::change::{Change, changes, sentence};
use super::start::{Cold, PIVOTS, PathError, cold, state_of};
use crate::answer::pairs::{JointState, pair_states};
use crate::answer::record::{PairState, Ray};
use crate::contact::complementarity::{ContactLcp, Couple};
use crate::contact::load_path::{order, path_lcp};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::explain::ray;
use crate::fem::Displacements;
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Knot, Parametric, Reach};
use crate::lcp::variable::Variable;
use crate::lcp::vertex::Basis;
use crate::model::parameter::ParameterValues;
use crate::model::scenario::Scenario;
use crate::solve::Prepared;
use crate::solve::numbers::{contact_numbers, factors};
use crate::solve::prepared::Geometry;
use crate::solve::solved::dislocation;
use crate::watch::Watch;

/// After a jump the path goes on this part of a stage further on.
const BEYOND: f64 = 1e-9;
/// A slip that falls by less than this multiple of the largest is rounding.
const NOISE: f64 = 1e-12;

/// The structure at one moment of the history.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Place in its stage, 0 … 1.
    pub t: f64,
    /// Factor of each load case.
    pub factors: Vec<f64>,
    /// The pairs: states are those of the loading that led here, z_t the total slip.
    pub pairs: Vec<PairState>,
    /// The pairs that change their state here.
    pub changes: Vec<Change>,
    /// The changes in words; empty without any.
    pub sentence: String,
    /// Whether the structure jumped here: no quasi-static way led on.
    pub jump: bool,
    z: DVector<f64>,
    force: DVector<f64>,
}

/// A stage that was followed.
#[derive(Clone, Debug, PartialEq)]
pub struct StageResult {
    /// Start, breakpoints and end; between two of them everything is affine in t.
    pub moments: Vec<Moment>,
    /// Pivots made.
    pub pivots: usize,
    /// Slip of each pair in this stage.
    pub slip: Vec<f64>,
    /// Work lost in friction, −∫ x_τ dz_τ ≥ 0.
    pub dissipated: f64,
    /// Work of the loads and change of the strain energy, and what is left over of their balance with the
    /// dissipation relative to the largest of the three; structures only.
    pub energy: Option<Energy>,
}

/// ∫ F·du = ΔU + D of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// ∫ F·du.
    pub work: f64,
    /// ΔU, U = ½ uᵀ K u.
    pub stored: f64,
    /// |work − stored − dissipated| / largest of them.
    pub residual: f64,
}

/// How a history ends.
#[derive(Clone, Debug, PartialEq)]
pub enum HistoryEnd {
    /// All stages were followed.
    Complete,
    /// The limit load was reached within a stage.
    Limit {
        /// Which stage, from 0.
        stage: usize,
        /// Place in it.
        t: f64,
        /// The collapse.
        collapse: Box<Ray>,
    },
}

/// A followed history.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Names of the load cases.
    pub cases: Vec<String>,
    /// The stages; the last one is incomplete where the history ended in it.
    pub stages: Vec<StageResult>,
    /// How it ended.
    pub end: HistoryEnd,
}

/// Follows the stages of the scenario from the unloaded structure.
///
/// # Errors
/// No stages; a state that cannot be found; see [`PathError`]. A limit load on the way is no error.
pub fn follow(
    prepared: &Prepared,
    scenario: &Scenario,
    values: &ParameterValues,
    watch: &dyn Watch,
) -> Result<History, PathError> {
    if scenario.stages.is_empty() {
        return Err(PathError::Missing(
            "the scenario has no `stages`: nothing tells the order of its loads (see the scenario format)".to_owned(),
        ));
    }
    let own = factors(prepared, values);
    let targets: Vec<Vec<f64>> = scenario
        .stages
        .iter()
        .map(|stage| {
            let mut target = vec![0.0; own.len()];
            for (name, multiplier) in &stage.multipliers {
                if let Some(case) = prepared.cases.iter().position(|(known, _)| known == name) {
                    target[case] = own[case] * multiplier.value(values);
                }
            }
            target
        })
        .collect();
    follow_factors(prepared, values, &targets, watch)
}

/// Follows the unloaded structure through the given factors of all load cases.
///
/// # Errors
/// As [`follow`].
pub fn follow_factors(
    prepared: &Prepared,
    values: &ParameterValues,
    targets: &[Vec<f64>],
    watch: &dyn Watch,
) -> Result<History, PathError> {
    let system = prepared.system().ok_or(PathError::Plain("stages"))?;
    let mut walk = Walk::start(prepared, system, values, watch)?;
    let mut history = History {
        cases: prepared.cases.iter().map(|(name, _)| name.clone()).collect(),
        stages: Vec::new(),
        end: HistoryEnd::Complete,
    };
    for (index, target) in targets.iter().enumerate() {
        let report = |t: f64| (index as f64 + t) / targets.len() as f64;
        let (stage, limit) = walk.stage(target, &report)?;
        history.stages.push(stage);
        if let Some((t, collapse)) = limit {
            history.end = HistoryEnd::Limit { stage: index, t, collapse: Box::new(collapse) };
            break;
        }
    }
    Ok(history)
}

impl History {
    /// How the history ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        match &self.end {
            HistoryEnd::Complete => "all stages were followed".to_owned(),
            HistoryEnd::Limit { stage, t, collapse } => format!(
                "stage {} cannot be completed: at {:.6} of it the limit load is reached ({})",
                stage + 1,
                t,
                collapse.mode
            ),
        }
    }

    /// The pairs at place t of a stage; z_t is the total slip. `None` beyond the end.
    pub fn pairs_at(&self, stage: usize, t: f64) -> Option<Vec<PairState>> {
        let moments = &self.stages.get(stage)?.moments;
        let ends = moments.windows(2).find(|ends| (ends[0].t..=ends[1].t).contains(&t))?;
        let length = ends[1].t - ends[0].t;
        let s = if length == 0.0 { 1.0 } else { (t - ends[0].t) / length };
        let mix = |a: f64, b: f64| if s == 1.0 { b } else { a + s * (b - a) };
        Some(
            ends[0]
                .pairs
                .iter()
                .zip(&ends[1].pairs)
                .map(|(a, b)| PairState {
                    x_n: mix(a.x_n, b.x_n),
                    x_t: mix(a.x_t, b.x_t),
                    z_n: mix(a.z_n, b.z_n),
                    z_t: mix(a.z_t, b.z_t),
                    bound: mix(a.bound, b.bound),
                    reserve_plus: mix(a.reserve_plus, b.reserve_plus),
                    reserve_minus: mix(a.reserve_minus, b.reserve_minus),
                    ..b.clone()
                })
                .collect(),
        )
    }
}

/// The state from which the history goes on.
struct Walk<'a> {
    prepared: &'a Prepared,
    system: &'a ContactSystem,
    /// Laws; the load is filled in.
    numbers: ContactNumbers,
    watch: &'a dyn Watch,
    factors: Vec<f64>,
    /// Total z over the joints.
    z: DVector<f64>,
    force: DVector<f64>,
    pairs: Vec<PairState>,
}

/// A stretch of a path in increments from a committed slip.
struct Stretch {
    contact: ContactLcp,
    /// z_τ committed; 0 in the normal joints.
    committed: DVector<f64>,
    /// Stage place of its t = 0.
    start: f64,
}

impl<'a> Walk<'a> {
    fn start(
        prepared: &'a Prepared,
        system: &'a ContactSystem,
        values: &ParameterValues,
        watch: &'a dyn Watch,
    ) -> Result<Walk<'a>, PathError> {
        let none = vec![0.0; prepared.cases.len()];
        let numbers = contact_numbers(system, &none, values);
        let found = cold(system, &numbers, watch)?;
        if found.basis.is_none() {
            return Err(PathError::NoStart { name: "all loads".to_owned(), at: 0.0, how: found.how().to_owned() });
        }
        let mut state = state_of(system, &numbers, &found.contact, &found.point);
        // Nothing has moved along the contacts yet.
        for pair in &system.pairs {
            if let Some(joint) = pair.tangential {
                state.z[joint] = 0.0;
            }
        }
        let mut pairs = pair_states(system, &numbers, &found.contact, &state);
        prepared.add_released_slips(&mut pairs, &numbers, &none, &state.z);
        Ok(Walk { prepared, system, numbers, watch, factors: none, z: state.z, force: state.force, pairs })
    }

    fn load(&self, factors: &[f64]) -> DVector<f64> {
        self.system
            .loads
            .iter()
            .zip(factors)
            .fold(DVector::zeros(self.system.joint_count()), |sum: DVector<f64>, (load, factor)| {
                sum + *factor * &load.vector
            })
    }

    /// z_τ alone.
    fn tangential(&self) -> DVector<f64> {
        let mut slip = DVector::zeros(self.system.joint_count());
        for joint in self.system.pairs.iter().filter_map(|pair| pair.tangential) {
            slip[joint] = self.z[joint];
        }
        slip
    }

    /// The laws under the load of these factors and the dislocation of a committed slip.
    fn numbers_at(&self, factors: &[f64], committed: &DVector<f64>) -> ContactNumbers {
        let mut numbers = self.numbers.clone();
        numbers.set_load(self.load(factors) + &self.system.stiffness * committed);
        numbers
    }

    /// The present scheme in increments: the open pairs, everything else at rest.
    fn rest_basis(&self, contact: &ContactLcp) -> Basis {
        let mut open: Vec<usize> =
            (0..self.system.pairs.len()).filter(|&i| self.z[i] > 0.0).filter_map(|i| contact.normal_row[i]).collect();
        open.sort_unstable();
        Basis { active: open.clone(), z: open, p: false }
    }

    /// Follows one stage; the place and the collapse where it ends in a limit.
    fn stage(
        &mut self,
        target: &[f64],
        report: &dyn Fn(f64) -> f64,
    ) -> Result<(StageResult, Option<(f64, Ray)>), PathError> {
        let from = self.factors.clone();
        let at = |t: f64| -> Vec<f64> {
            from.iter().zip(target).map(|(a, b)| if t == 1.0 { *b } else { a + t * (b - a) }).collect()
        };
        let slips_before: Vec<f64> = self.pairs.iter().map(|pair| pair.z_t).collect();
        let mut result = StageResult {
            moments: vec![self.moment(0.0, false)],
            pivots: 0,
            slip: Vec::new(),
            dissipated: 0.0,
            energy: None,
        };
        let increment = self.load(target) - self.load(&from);
        let mut limit = None;
        let mut t = 0.0;
        if increment.amax() == 0.0 {
            self.factors = target.to_vec();
            t = 1.0;
            result.moments.push(self.moment(1.0, false));
        }
        while t < 1.0 {
            let committed = self.tangential();
            let numbers = self.numbers_at(&at(t), &committed);
            let contact = path_lcp(self.system, &numbers, &increment);
            let basis = self.rest_basis(&contact);
            let stretch = Stretch { contact, committed, start: t };
            let order = order(&stretch.contact);
            let Some(mut engine) = Parametric::new(Arc::clone(&stretch.contact.lcp), &basis, order) else {
                return Err(self.breakdown(t, "the equations of the open pairs are singular"));
            };
            let reach = Reach { target: 1.0 - t, through: false, pivots: PIVOTS };
            let watch = self.watch;
            let path = engine.follow(reach, &mut |along| {
                watch.progress("stages", report(t + along));
                if watch.stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            result.pivots += path.pivots;
            let cut = self.cut(&stretch, &path.knots);
            let last = cut.unwrap_or(path.knots.len() - 1);
            for knot in &path.knots[1..=last] {
                let whole = cut.is_none() && path.end == End::Target && knot.t == 1.0 - t;
                let place = if whole { 1.0 } else { stretch.start + knot.t };
                self.take(&stretch, place, &at(place), &knot.point, &mut result, false);
            }
            let here = if cut.is_none() && path.end == End::Target { 1.0 } else { stretch.start + path.knots[last].t };
            if cut.is_some() {
                if here <= t {
                    return Err(self.breakdown(t, "the slips turn back at once"));
                }
                t = here;
                continue;
            }
            t = here;
            match path.end {
                End::Target => {}
                End::Limit(direction) => {
                    let numbers = self.numbers_at(&at(t + 1e-6), &stretch.committed);
                    let mut collapse = ray::report(self.system, &numbers, &stretch.contact, &direction, 0.0);
                    collapse.explanation =
                        "The loads of this stage cannot be reached: nothing resists this motion.".to_owned();
                    limit = Some((t, collapse));
                    break;
                }
                End::Turning => t = self.jump(&at, t, &mut result)?,
                End::Interrupted => return Err(PathError::Interrupted),
                End::Unbounded | End::Returned => {
                    return Err(self.breakdown(t, "the path left its stage"));
                }
                End::PivotLimit => {
                    return Err(self.breakdown(t, "the limit of pivots was reached"));
                }
                End::Breakdown(why) => return Err(self.breakdown(t, &why)),
            }
        }
        self.changes(&mut result);
        result.slip = self.pairs.iter().zip(&slips_before).map(|(pair, before)| pair.z_t - before).collect();
        self.balance(&mut result);
        Ok((result, limit))
    }

    fn breakdown(&self, t: f64, why: &str) -> PathError {
        PathError::Breakdown { name: "place in the stage".to_owned(), at: t, why: why.to_owned() }
    }

    fn moment(&self, t: f64, jump: bool) -> Moment {
        Moment {
            t,
            factors: self.factors.clone(),
            pairs: self.pairs.clone(),
            changes: Vec::new(),
            sentence: String::new(),
            jump,
            z: self.z.clone(),
            force: self.force.clone(),
        }
    }

    /// First knot at which the slip must be committed: a pair closed there, or a slip turns back beyond it.
    fn cut(&self, stretch: &Stretch, knots: &[Knot]) -> Option<usize> {
        let contact = &stretch.contact;
        let lcp = &contact.lcp;
        (1..knots.len()).find(|&k| {
            let closes = knots[k].leaving.iter().any(|leaving| match leaving {
                Variable::Z(row) => contact.rows[*row].couple == Couple::Normal,
                _ => false,
            });
            if closes {
                return true;
            }
            let Some(next) = knots.get(k + 1) else {
                return false;
            };
            let here = &knots[k];
            let largest = here.point.z.iter().chain(&next.point.z).fold(0.0, |a: f64, b| a.max(b.abs()));
            (0..contact.rows.len()).any(|row| {
                let meaning = contact.rows[row];
                if meaning.couple == Couple::Normal {
                    return false;
                }
                // The slip of an open pair that nothing holds may turn as it likes.
                let free = contact.normal_row[meaning.pair].is_some_and(|normal| {
                    here.scheme.binary_search(&normal).is_ok() && self.numbers.cohesion[meaning.pair] == 0.0
                });
                let scale = contact.plus_row[meaning.pair].map_or(1.0, |plus| lcp.scale.column[plus]);
                !free && scale * (next.point.z[row] - here.point.z[row]) < -NOISE * scale * largest
            })
        })
    }

    /// Stands at a point of a stretch and records it.
    fn take(
        &mut self,
        stretch: &Stretch,
        t: f64,
        factors: &[f64],
        point: &Point,
        result: &mut StageResult,
        jump: bool,
    ) {
        let numbers = self.numbers_at(factors, &stretch.committed);
        let state = state_of(self.system, &numbers, &stretch.contact, point);
        let mut pairs = pair_states(self.system, &numbers, &stretch.contact, &state);
        let total = JointState { z: &state.z + &stretch.committed, ..state };
        for (pair, shown) in self.system.pairs.iter().zip(&mut pairs) {
            if let Some(joint) = pair.tangential {
                shown.z_t = total.z[joint];
            }
        }
        self.prepared.add_released_slips(&mut pairs, &numbers, factors, &total.z);
        self.factors = factors.to_vec();
        self.z = total.z;
        self.force = total.force;
        self.pairs = pairs;
        let moment = self.moment(t, jump);
        result.moments.push(moment);
    }

    /// No way leads on from here: the answer just beyond, in increments from the present slip.
    fn jump(&mut self, at: &dyn Fn(f64) -> Vec<f64>, t: f64, result: &mut StageResult) -> Result<f64, PathError> {
        let beyond = (t + BEYOND).min(1.0);
        let committed = self.tangential();
        let numbers = self.numbers_at(&at(beyond), &committed);
        let Cold { contact, basis, point, outcome: _ } = cold(self.system, &numbers, self.watch)?;
        if basis.is_none() {
            return Err(self.breakdown(t, "the structure jumps, and no state to jump to was found"));
        }
        let stretch = Stretch { contact, committed, start: t };
        self.take(&stretch, beyond, &at(beyond), &point, result, true);
        Ok(beyond)
    }

    /// What changes at each moment: the states of the loading before it and after it differ.
    fn changes(&self, result: &mut StageResult) {
        for k in 0..result.moments.len().saturating_sub(1) {
            let changes = changes(&result.moments[k].pairs, &result.moments[k + 1].pairs);
            result.moments[k].sentence = sentence(&changes);
            result.moments[k].changes = changes;
        }
    }

    fn displacements(&self, moment: &Moment) -> Option<Displacements> {
        let Geometry::Structure { main, .. } = &self.prepared.geometry else {
            return None;
        };
        Some(main.displacements(&moment.factors, &dislocation(&self.numbers, &moment.z)))
    }

    /// Dissipation, and for structures the balance of energy; both exact, because forces and displacements are
    /// affine between moments.
    fn balance(&self, result: &mut StageResult) {
        for ends in result.moments.windows(2) {
            for joint in self.system.pairs.iter().filter_map(|pair| pair.tangential) {
                let force = 0.5 * (ends[0].force[joint] + ends[1].force[joint]);
                result.dissipated -= force * (ends[1].z[joint] - ends[0].z[joint]);
            }
        }
        let Geometry::Structure { main, .. } = &self.prepared.geometry else {
            return;
        };
        let mut energy = Energy::default();
        let mut before: Option<(&Moment, Displacements)> = None;
        let mut first = 0.0;
        for moment in &result.moments {
            let Some(u) = self.displacements(moment) else {
                return;
            };
            let stored = main.strain_energy(&u);
            match &before {
                None => first = stored,
                Some((last, old)) => {
                    energy.work += 0.5
                        * (main.work(&last.factors, &u) - main.work(&last.factors, old)
                            + main.work(&moment.factors, &u)
                            - main.work(&moment.factors, old));
                }
            }
            energy.stored = stored - first;
            before = Some((moment, u));
        }
        let largest = energy.work.abs().max(energy.stored.abs()).max(result.dissipated.abs());
        let left = (energy.work - energy.stored - result.dissipated).abs();
        energy.residual = if largest > 0.0 { left / largest } else { 0.0 };
        result.energy = Some(energy);
    }
}
