//! Load histories in space, on Coulomb's cone (method §7).
//!
//! Directions of slip turn on the way, so that rates are not constant between two events. The law is the one of the
//! rate problem all the same: eq. (8) in increments from the slips just before ([`crate::path::cone_step`]), as the
//! increments get short. From event to event the way is taken in legs ([`leg`]) whose ends are extrapolated to steps of
//! no length, as exactly as is asked for; an event is crossed in one step so short that nothing can turn in it. A step
//! begins from the one before, and where that leads nowhere from the answer on the friction polygon.

mod leg;
mod resting;

use nalgebra::DVector;

use self::leg::{Begin as LegBegin, Measure, TOLERANCE, Taken, along, change_within, taken};
use super::Begin;
use super::beyond::explanation;
use super::course::Course;
use super::follower::{Follower, Limit, Place, Targets, Way, recorded};
use super::integrals::Integrals;
use super::record::History;
use super::standing::Laws;
use super::walk::breakdown;
use crate::answer::pairs::{JointState, pairs_in_space};
use crate::answer::record::{PairState, PolygonRecord, Ray, State};
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::explain::certificate::certify;
use crate::explain::motions::FreeMotions;
use crate::explain::ray::{self, RayReport};
use crate::lcp::outcome::RayDirection;
use crate::lcp::problem::NOISE;
use crate::lcp::variable::Variable;
use crate::model::rules::{Covering, Rules};
use crate::path::cone_step::{PolygonRay, Scheme, Step, Stepper, behind_slips};
use crate::path::start::PathError;
use crate::solve::Prepared;
use crate::text::words::{short as short_number, some};
use crate::watch::Watch;

/// A step across an event is this part of a stage: what turns in it moves the end by some 1e-14.
const SHORT: f64 = 1e-7;
/// An event is located to this part of a stage.
const HERE: f64 = 1e-10;
/// The longest leg, as a part of a stage: what happens and is undone within one would not be seen.
const LONGEST: f64 = 0.125;
/// A leg that was taken in at most this many steps is followed by one of twice its length: k (k + 1)/2 steps in all are
/// worth most per length where k is near the largest.
const EASY: usize = 6;
/// No stage has more legs than this.
const LEGS: usize = 50_000;
/// As many legs in a row …
const CREEPING: usize = 256;
/// … lead this part of a stage on at least, or are given up.
const LEAD: f64 = 1e-3;
/// After this many events in a row they are crossed in longer and longer steps.
const CROWDED: usize = 4;
/// A collapse is certified this part of a stage further on.
const CERTIFIED_AT: f64 = 1e-6;
/// A step that moves more than this share of the largest displacement …
const FAR: f64 = 1e-4;
/// … or than this where no answer was near, …
const SEEN: f64 = 1e-6;
/// … is looked at again this many times shorter …
const SHORTER: f64 = 16.0;
/// … and is a jump where the motion is still more than this part of it.
const STAYS: f64 = 0.25;

/// The state from which the history goes on.
struct SpaceWalk<'a> {
    place: Place<'a>,
    stepper: Stepper<'a>,
    /// Total z over the joints; z_n is the distance open.
    z: DVector<f64>,
    /// The last step, its slips counted from where it began.
    increments: JointState,
    /// ż on the last leg, per unit of the stage.
    rate: DVector<f64>,
    /// Whether each pair has slipped and stands at its limit since.
    slid: Vec<bool>,
    /// The way to the present moment from the one before.
    integrals: Option<Integrals>,
    measure: Measure,
    /// Sum of the errors of all legs, as shares of the largest displacement.
    error: f64,
}

/// Follows the given factors of all load cases, stage by stage, from the unloaded structure.
pub(super) fn follow<'a>(
    prepared: &'a Prepared,
    laws: Laws<'a>,
    (begin, rules): (&Begin, Rules),
    targets: Targets<'_>,
    watch: &'a dyn Watch,
) -> Result<History, PathError> {
    if !rules.cone {
        let why = "a history in space is followed on Coulomb's cone, where directions of slip turn with the motion; \
                   `set cone on` (`solver.cone`: true) first";
        return Err(PathError::Missing(why.to_owned()));
    }
    let stepper = Stepper::new(rules.facets, watch);
    let (joints, pairs) = (laws.problem.system.joint_count(), laws.problem.system.pair_count());
    let mut z = DVector::zeros(joints);
    laws.problem.gaps().zip(z.iter_mut()).for_each(|(gap, z)| *z = gap.max(0.0));
    let increments = JointState::unloaded_on_cone(z.clone());
    let mut walk = SpaceWalk {
        place: Place::unloaded(prepared, laws, watch),
        stepper,
        z,
        increments,
        rate: DVector::zeros(joints),
        slid: vec![false; pairs],
        integrals: None,
        measure: Measure::new(&laws.problem.system),
        error: 0.0,
    };
    walk.place.way = walk.states().iter().map(|pair| (pair.state, pair.held)).collect();
    walk.begin(begin, targets.0)?;
    let (mut stages, end) = walk.stages(targets)?;
    let polygon = PolygonRecord { cone: true, ..PolygonRecord::of(walk.polygon()) };
    for stage in &mut stages {
        stage.end.polygon = Some(polygon);
        stage.end.attempts.iter_mut().for_each(|attempt| attempt.facets = Some(polygon.facets));
    }
    Ok(recorded(&walk.place, stages, end))
}

/// What keeps a leg from its full length.
enum Ahead {
    /// A pair does something else from here on.
    Change(f64),
    /// A shorter one may succeed.
    Shorter(f64),
}

impl SpaceWalk<'_> {
    fn polygon(&self) -> Polygon {
        Polygon::regular(self.stepper.facets, 0.0)
    }

    /// Stands at the end of a step.
    fn stand(&mut self, step: Step, mut way: Scheme, integrals: Integrals, (factors, gaps): (Vec<f64>, Vec<f64>)) {
        let Step { z, increments, .. } = step;
        (self.place.factors, self.place.gaps) = (factors, gaps);
        self.measure.meet(&z, &increments.force);
        (self.z, self.increments, self.integrals) = (z, increments, Some(integrals));
        let problem = self.problem_at(&self.place.factors, &self.place.gaps);
        let shown = pairs_in_space(&problem, &self.increments);
        for (i, (pair, shown)) in problem.system.pairs.iter().zip(shown).enumerate() {
            let moves = self.increments.slip(pair) != [0.0; 2];
            self.slid[i] = moves || (self.slid[i] && self.at_limit(pair.tangential.clone(), &shown));
            // What does not leave the limit at which it slipped goes on, however slowly at first.
            match &mut way[i] {
                (state @ State::Stick, _) | (State::Open, Some(state @ State::Stick)) if self.slid[i] => {
                    *state = State::Slip
                }
                _ => {}
            }
        }
        self.place.way = way;
    }

    /// z and λ.
    fn here(&self) -> (&DVector<f64>, &DVector<f64>) {
        (&self.z, &self.increments.force)
    }

    /// Whether the friction of a pair is at its bound.
    fn at_limit(&self, joints: std::ops::Range<usize>, shown: &PairState) -> bool {
        let noise: f64 = joints.map(|joint| NOISE * self.increments.terms[joint]).sum();
        shown.bound > 0.0 && shown.reserve() <= noise
    }

    /// The length of the step across what happens at t, after `crowded` others without a leg between them.
    fn length_across(&self, course: &Course, t: f64, crowded: usize) -> Result<f64, PathError> {
        if crowded > CROWDED {
            let problem = along(self.place.laws.problem, course);
            let longer = (SHORT * 4f64.powi((crowded - CROWDED).min(8) as i32)).min(1.0 - t);
            if self.is_straight(&problem, t, longer)? {
                return Ok(longer);
            }
        }
        Ok(short(1.0 - t))
    }

    /// One short step across whatever happens at t, or a rest where no step leads on; what follows where there is no answer
    /// after it.
    fn cross(
        &mut self,
        course: &Course,
        (t, length): (f64, f64),
        way: &mut Way,
    ) -> Result<Result<(f64, Scheme), PolygonRay>, PathError> {
        let laws = self.place.laws;
        let problem = along(laws.problem, course);
        let to = reached(t, length);
        let guess = &self.z + &self.rate * length;
        let near = self.stepper.onward(problem(to), self.here(), &guess)?;
        // What can stay where it is does not jump.
        if near.is_none()
            && let Some(rested) = self.rest(course, t, way)?
        {
            return Ok(Ok(rested));
        }
        let (step, is_near) = match near {
            Some(step) => (step, true),
            None => match self.stepper.anywhere(problem(to), &self.z, Some(&self.increments.force))? {
                Ok(step) => (step, false),
                Err(ray) => return Ok(Err(ray)),
            },
        };
        let moved = &step.z - &self.z;
        let size = self.measure.size_with(&step.z, &step.increments.force);
        let motion = self.measure.of(&moved);
        let mut jump = false;
        if motion > if is_near { FAR } else { SEEN } * size {
            let guess = &self.z + &moved / SHORTER;
            let there = || problem(t + length / SHORTER);
            let nearer = match self.stepper.onward(there(), self.here(), &guess)? {
                None if !is_near => self.stepper.anywhere(there(), &self.z, Some(&self.increments.force))?.ok(),
                nearer => nearer,
            };
            jump = nearer.is_none_or(|nearer| self.measure.of(&(nearer.z - &self.z)) > STAYS * motion);
        }
        if jump
            && is_near
            && let Some(rested) = self.rest(course, t, way)?
        {
            return Ok(Ok(rested));
        }
        let ends = [&self.increments.force, &step.increments.force];
        let integrals = Integrals::straight(length, [&self.z, &step.z], ends, &laws.problem.system);
        self.rate = if jump { DVector::zeros(moved.len()) } else { moved / length };
        way.last_slip = step.increments.z.clone();
        let scheme = step.scheme.clone();
        self.stand(step, scheme.clone(), mean(integrals, length), (course.factors_at(to), course.gaps_at(to)));
        way.moments.push(self.moment(to, jump));
        Ok(Ok((to, scheme)))
    }

    /// Whether one step of this length ends where two of half of it do.
    fn is_straight(&self, problem: &dyn Fn(f64) -> ContactProblem, t: f64, length: f64) -> Result<bool, PathError> {
        let near = |at: f64, from: (&DVector<f64>, &DVector<f64>)| {
            self.stepper.onward(problem(at), from, &(from.0 + &self.rate * (0.5 * length)))
        };
        let (Some(one), Some(half)) = (near(t + length, self.here())?, near(t + 0.5 * length, self.here())?) else {
            return Ok(false);
        };
        let Some(two) = near(t + length, (&half.z, &half.increments.force))? else { return Ok(false) };
        Ok(self.measure.share(&(one.z - two.z)) <= TOLERANCE)
    }

    /// A leg of length `h`, and a short step at its end, after which the laws hold to rounding. The place reached and what
    /// the pairs do there, or how far ahead the next try should reach.
    fn advance(
        &mut self,
        course: &Course,
        (t, h): (f64, f64),
        scheme: &Scheme,
        way: &mut Way,
    ) -> Result<Result<(f64, Scheme, usize), Ahead>, PathError> {
        let laws = self.place.laws;
        let problem = along(laws.problem, course);
        let begin = LegBegin { t, z: &self.z, force: &self.increments.force, rate: &self.rate, scheme };
        let leg = match taken(&self.stepper, &problem, &begin, h, &self.measure)? {
            Taken::Whole(leg) => leg,
            Taken::Changes => {
                let within = change_within(&self.stepper, &problem, &begin, h, HERE)?;
                return Ok(Err(if within > 0.9 * h { Ahead::Shorter(0.75 * h) } else { Ahead::Change(within) }));
            }
            Taken::Shorter => return Ok(Err(Ahead::Shorter(0.5 * h))),
        };
        let last = short(1.0 - t - h);
        let to = reached(t + h, last);
        let end = &leg.z + &leg.rate * last;
        let mut step = None;
        if leg.is_straight() {
            // All of it in one step: directions of slip are known the better the longer it is.
            let found = self.stepper.onward(problem(to), self.here(), &end)?;
            step = found.filter(|step| step.scheme == *scheme && self.measure.share(&(&step.z - &end)) <= TOLERANCE);
        }
        if step.is_none() {
            step = self.stepper.onward(problem(to), (&leg.z, &leg.force), &end)?;
        }
        let Some(step) = step else { return Ok(Err(Ahead::Shorter(0.5 * h))) };
        let ends = [&leg.force, &step.increments.force];
        let integrals = leg.way.plus(&Integrals::straight(last, [&leg.z, &step.z], ends, &laws.problem.system));
        way.last_slip = step.increments.z.clone();
        self.error += leg.error;
        self.rate = leg.rate;
        let ahead = step.scheme.clone();
        self.stand(step, scheme.clone(), mean(integrals, to - t), (course.factors_at(to), course.gaps_at(to)));
        way.moments.push(self.moment(to, false));
        Ok(Ok((to, ahead, leg.rows)))
    }

    /// What to say where so many tries to go on led hardly any further.
    fn why_stuck(&self, led: f64) -> String {
        let problem = self.problem_at(&self.place.factors, &self.place.gaps);
        let system = &*problem.system;
        let free =
            system.yielding.as_ref().map_or(Vec::new(), |yielding| yielding.undetermined(&problem, &self.z, true));
        let named = |pairs: &[usize]| some(&pairs.iter().map(|&i| system.pairs[i].id.as_str()).collect::<Vec<_>>());
        let led = short_number(led);
        let tried = format!("{CREEPING} legs in a row led on by {led} of the stage only");
        if free.is_empty() {
            let sliding: Vec<usize> = (0..self.slid.len()).filter(|&i| self.slid[i]).collect();
            let who = if sliding.is_empty() { String::new() } else { format!("; {} slide there", named(&sliding)) };
            return format!("{tried}{who}: its changes crowd; slightly other proportions of the loads part them");
        }
        format!(
            "{tried}: what {} carry is not determined, for their joints repeat one another, and how they stick or slip \
             hangs on it; take the friction from some of them, or the wall behind them for a spring",
            named(&free)
        )
    }

    /// The collapse at place t of a stage: certified just beyond, or the motion of a ray of the polygon.
    fn collapse(&self, course: &Course, t: f64, found: PolygonRay) -> Ray {
        let Place { prepared, laws, .. } = &self.place;
        let at = t + CERTIFIED_AT;
        let problem = along(laws.problem, course)(at);
        let motions = FreeMotions::new(&problem.system, prepared.built());
        let mut collapse = match certify(&problem, &motions).certificate {
            Some(certificate) => {
                let mut report = RayReport::of_certificate(&problem, certificate);
                ray::explain(&mut report, &problem, prepared.built());
                report.record(&problem.system, Covering::default())
            }
            None => {
                let problem = behind_slips(problem, &self.z);
                let (contact, direction, p) = match found {
                    Some(found) => *found,
                    // The run ended in no ray: there is no motion to show.
                    None => {
                        let contact = crate::contact::load_path::path_lcp(&problem, &problem.load);
                        let still = vec![0.0; contact.rows.len()];
                        (contact, RayDirection { entering: Variable::P, z: still.clone(), w: still, p: 0.0 }, 0.0)
                    }
                };
                ray::report(&problem, prepared.built(), &contact, &direction, p)
            }
        };
        collapse.explanation = explanation(&collapse).to_owned();
        collapse
    }
}

/// The length of a short step with `room` before it: no shorter one is left over.
fn short(room: f64) -> f64 {
    if room < 1.5 * SHORT { room } else { SHORT }
}

/// The end of a step from t; at the end of the stage to the last digit.
fn reached(t: f64, length: f64) -> f64 {
    if 1.0 - t - length < 0.1 * SHORT { 1.0 } else { t + length }
}

/// Integrals with the means of z and λ in place of their integrals.
fn mean(way: Integrals, length: f64) -> Integrals {
    Integrals { z: way.z / length, force: way.force / length, ..way }
}

impl<'a> Follower<'a> for SpaceWalk<'a> {
    fn place(&self) -> &Place<'a> {
        &self.place
    }

    fn state(&self) -> JointState {
        JointState { z: self.z.clone(), ..self.increments.clone() }
    }

    fn integrals(&self) -> Option<Integrals> {
        self.integrals.clone()
    }

    fn estimated_error(&self) -> Option<f64> {
        Some(self.error)
    }

    fn states(&self) -> Vec<PairState> {
        let problem = self.problem_at(&self.place.factors, &self.place.gaps);
        let mut pairs = pairs_in_space(&problem, &self.increments);
        for (i, (pair, shown)) in problem.system.pairs.iter().zip(&mut pairs).enumerate() {
            // On the limit at which it slipped last it is shown as slipping.
            if self.slid[i] && self.at_limit(pair.tangential.clone(), shown) {
                match shown.state {
                    State::Stick => shown.state = State::Slip,
                    State::Open => shown.held = shown.held.map(|_| State::Slip),
                    _ => {}
                }
                (shown.x_t, shown.reserve_plus, shown.reserve_minus) = (shown.bound, 2.0 * shown.bound, 0.0);
            }
            if let Some(space) = shown.space.as_mut().filter(|_| pair.rubs()) {
                space.z_t = pair.slip(&self.z);
                shown.z_t = space.z_t[0].hypot(space.z_t[1]);
            }
        }
        self.place.prepared.add_released_slips(&mut pairs, &problem, &self.z);
        pairs
    }

    fn problem_at(&self, factors: &[f64], gaps: &[f64]) -> ContactProblem {
        self.place.laws.problem.clone().with_polygon(self.polygon()).with_gaps(gaps).with_factors(factors)
    }

    fn stand_behind(&mut self, factors: &[f64], slips: DVector<f64>) -> Result<Option<&'static str>, PathError> {
        let gaps: Vec<f64> = self.place.laws.problem.gaps().collect();
        let Ok(step) = self.stepper.anywhere(self.problem_at(factors, &gaps), &slips, None)? else {
            return Ok(Some("without an answer on Coulomb's cone"));
        };
        let (z, force) = (step.z.clone(), step.increments.force.clone());
        let (scheme, still) = (step.scheme.clone(), Integrals { z, force, dissipated: 0.0 });
        self.stand(step, scheme, still, (factors.to_vec(), gaps));
        Ok(None)
    }

    fn along(&mut self, course: &Course, report: &dyn Fn(f64) -> f64) -> Result<(Way, Limit), PathError> {
        self.integrals = None;
        let mut way = Way::from(self.moment(0.0, false));
        if course.rate(&self.place.laws.problem.system).amax() == 0.0 {
            self.place.factors = course.factors_at(1.0);
            way.moments.push(self.moment(1.0, false));
            return Ok((way, None));
        }
        self.stepper.pivots.set(0);
        // The rate on the stage before belongs to another load.
        self.rate.fill(0.0);
        let (mut t, mut h, mut legs, mut crowded) = (0.0, LONGEST, 0, 0);
        let (mut next, mut event): (Option<f64>, Option<f64>) = (None, None);
        let mut ahead: Option<Scheme> = None;
        let mut mark = -1.0;
        let is_rigid = self.is_rigid();
        while t < 1.0 {
            self.place.watch.progress("stages", report(t));
            if self.place.watch.stop() {
                return Err(PathError::Interrupted);
            }
            if is_rigid && let Some((to, _)) = self.rest(course, t, &mut way)? {
                t = to;
                continue;
            }
            legs += 1;
            if legs > LEGS {
                return Err(breakdown(t, &format!("the limit of {LEGS} legs in a stage was reached")));
            }
            if legs % CREEPING == 0 {
                if t - mark < LEAD {
                    let why = self.why_stuck(t - mark);
                    t = self.rest(course, t, &mut way)?.ok_or_else(|| breakdown(t, &why))?.0;
                    (ahead, next, event) = (None, None, None);
                }
                mark = t;
                continue;
            }
            let length = next.take().unwrap_or(h).min(LONGEST).min(1.0 - t - SHORT);
            let Some(scheme) = ahead.clone().filter(|_| length > 2.0 * SHORT) else {
                crowded += 1;
                let before = event.take().filter(|event| *event > 10.0 * HERE);
                let at_event = before.is_some();
                let length = match before {
                    Some(before) => before,
                    None => self.length_across(course, t, crowded)?,
                };
                match self.cross(course, (t, length), &mut way)? {
                    Ok((to, _)) if at_event => t = to,
                    Ok((to, scheme)) => (t, ahead) = (to, Some(scheme)),
                    Err(ray) => {
                        way.pivots = self.stepper.pivots.get();
                        return Ok((way, Some((t, self.collapse(course, t, ray)))));
                    }
                }
                continue;
            };
            match self.advance(course, (t, length), &scheme, &mut way)? {
                Ok((to, scheme, rows)) => {
                    crowded = 0;
                    (t, ahead) = (to, Some(scheme));
                    h = if rows <= EASY { h.max(2.0 * length) } else { length };
                }
                Err(found) => {
                    // A leg has a short step at its end: it has to end at the event, from where that is crossed.
                    let (length, change) = match found {
                        Ahead::Change(length) => (length - SHORT, Some(length)),
                        Ahead::Shorter(length) => (length, None),
                    };
                    next = Some(length);
                    if length <= 2.0 * SHORT {
                        event = change;
                        ahead = None;
                    }
                }
            }
        }
        way.pivots = self.stepper.pivots.get();
        Ok((way, None))
    }
}
