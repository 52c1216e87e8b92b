//! Following: rates, next event, slips committed, rates again.

use std::time::Instant;

use nalgebra::DVector;

use super::Begin;
use super::course::Course;
use super::event::next_event;
use super::follower::{Follower, Limit, Place, Targets, Way, recorded};
use super::rate_problem::{Ended, RateProblem, Rates};
use super::record::History;
use super::standing::{Laws, Normal, Reached, Sense, Standing, joint_scales};
use crate::answer::check::{TOLERANCE, check_contact};
use crate::answer::pairs::{JointState, Shares};
use crate::answer::record::{PairState, State, Verdict};
use crate::contact::problem::ContactProblem;
use crate::contact::rows::{RowId, RowKind};
use crate::contact::sum::{HIDDEN, LAW_ROUNDING};
use crate::contact::written::ContactLcp;
use crate::explain::sentence::pivot_records;
use crate::lcp::outcome::Run;
use crate::lcp::problem::NOISE;
use crate::path::start::PathError;
use crate::solve::Prepared;
use crate::solve::engines::kind;
use crate::watch::Watch;

/// No stage has more events than this.
const EVENTS: usize = 100_000;
/// This many jumps one after the other, with no way between them, lead nowhere: the place is as good as a limit.
const JUMPS: usize = 20;
/// The farthest place, as a part of the stage, at which a state is looked for where no rates lead on.
pub(super) const LONGEST_LOOK: f64 = 1e-7;
/// What is said where the loads hide in the rounding of what they move.
const HIDES: &str = "The loads of this stage could not be followed further: rates lead on, but so little resists them that from \
                     here rounding hides the loads in the forces of what they move. That the loads cannot be carried is not proved.";

/// The state from which the history goes on.
pub(super) struct Walk<'a> {
    pub(super) place: Place<'a>,
    pub(super) standing: Standing,
    /// The last run of Lemke's algorithm, on a rate problem.
    last_run: Option<(Run, ContactLcp)>,
    /// Time spent on rate problems.
    lemke_seconds: f64,
}

/// What one stretch of a stage came to.
enum Stretch {
    /// The place reached.
    Event(f64),
    /// No rates lead on from here.
    End { motion: DVector<f64>, p: f64 },
    /// Rates lead on, but so little resists that rounding hides the loads from here.
    Hidden { motion: DVector<f64>, p: f64 },
}

impl<'a> Walk<'a> {
    /// Stands where the history begins; parts with interference (gaps below 0) are put together first.
    pub(super) fn start(
        prepared: &'a Prepared,
        laws: Laws<'a>,
        begin: &Begin,
        targets: &[Vec<f64>],
        watch: &'a dyn Watch,
    ) -> Result<Walk<'a>, PathError> {
        let mut walk = Walk {
            place: Place::unloaded(prepared, laws, watch),
            standing: Standing::unloaded(laws),
            last_run: None,
            lemke_seconds: 0.0,
        };
        walk.place.way = walk.states().iter().map(|pair| (pair.state, pair.held)).collect();
        walk.begin(begin, targets)?;
        Ok(walk)
    }

    /// Follows the stages one after the other.
    pub(super) fn follow(mut self, targets: Targets<'_>) -> Result<History, PathError> {
        let (mut stages, end) = self.stages(targets)?;
        if let (Some(stage), Some((run, contact))) = (stages.last_mut(), &self.last_run) {
            stage.end.attempts.iter_mut().for_each(|attempt| attempt.outcome = kind(&run.outcome));
            stage.end.pivot_count = run.pivots.count();
            stage.end.pivots = pivot_records(run.pivots.recorded(), contact, &self.place.laws.problem.system);
            stage.end.timings.lemke = self.lemke_seconds;
        }
        Ok(recorded(&self.place, stages, end))
    }

    /// From t to the next event or to the end of the stage.
    fn stretch(
        &mut self,
        course: &Course,
        (rate, sizes): (&DVector<f64>, &DVector<f64>),
        t: f64,
        reached: &mut Vec<Reached>,
        way: &mut Way,
    ) -> Result<Stretch, PathError> {
        let Some(mut problem) = RateProblem::new(self.place.laws, &self.standing, (rate, sizes)) else {
            return Err(breakdown(t, "the stiffness of the open pairs is not positive definite"));
        };
        let start = Instant::now();
        let (mut ended, mut run) = problem.solve(&self.standing, self.place.watch);
        if matches!(ended, Ended::Ray { .. })
            && let Some(neutral) = problem.neutral(&self.standing)
            && let (Ended::Rates(rates), found) = neutral.solve(&self.standing, self.place.watch)
        {
            (ended, run, problem) = (Ended::Rates(rates), found, neutral);
        }
        self.lemke_seconds += start.elapsed().as_secs_f64();
        way.pivots += run.pivots.count();
        self.last_run = Some((run, problem.contact.clone()));
        let (rates, end) = match ended {
            Ended::Rates(rates) => (rates, None),
            Ended::Ray { motion, p, little: Some(rates) } => (rates, Some((motion, p))),
            Ended::Ray { motion, p, little: None } => return Ok(Stretch::End { motion, p }),
            Ended::Interrupted => return Err(PathError::Interrupted),
            Ended::Breakdown(why) => return Err(breakdown(t, &why)),
        };
        let (step, mut now) = next_event(self.place.laws, &self.standing, &rates, (sizes, 1.0 - t));
        // Likewise where the last digits of the place hide the way that is left.
        let mut to = if step >= 1.0 - t - LAW_ROUNDING { 1.0 } else { t + step };
        if let Some((motion, p)) = end {
            let until = self.clear_until(course, &rates, (t, to));
            let is_back = to == t && now.iter().all(|limit| reached.contains(limit));
            if is_back || self.collapse(course, t, &motion, p)?.verdict == Some(Verdict::Certified) {
                return Ok(Stretch::End { motion, p });
            }
            // A way that is no longer than what is looked ahead by where there is none leads nowhere.
            if until < to && until - t <= LONGEST_LOOK {
                return Ok(Stretch::Hidden { motion, p });
            }
            if until < to {
                to = until;
                now.clear();
            }
        }
        if to == t {
            // Nothing has moved: what was reached stays reached.
            now.retain(|limit| !reached.contains(limit));
            if now.is_empty() {
                return Err(breakdown(t, "the rates lead back to the limits from which they start"));
            }
            reached.append(&mut now);
            self.classify(course, t, reached);
            return Ok(Stretch::Event(to));
        }
        self.advance(course, &problem, &rates, (t, to), &now)?;
        *reached = now;
        way.moments.push(self.moment(to, false));
        Ok(Stretch::Event(to))
    }

    /// Up to where rates that little resists lead: to the place at which the rounding of what they move begins to hide the loads.
    fn clear_until(&self, course: &Course, rates: &Rates, (t, to): (f64, f64)) -> f64 {
        let hides = |at: f64| {
            let problem = self.problem_at(&course.factors_at(at), &course.gaps_at(at));
            let mut there = JointState::at(&problem, &self.standing.z + &rates.z * (at - t), 0.0);
            // What a stage ends in is checked with the terms of the largest displacements met beside its own.
            let sizes = self.place.laws.force_sizes(&there.z, &course.sizes_at(&self.place.laws.problem.system, at));
            there.terms += sizes.zip_map(self.standing.force_sizes(), f64::max);
            check_contact(&problem, &there, None).hidden > HIDDEN
        };
        let (mut clear, mut hidden) = if hides(to) { (t, to) } else { return to };
        while hidden - clear > LAW_ROUNDING {
            let middle = clear.midpoint(hidden);
            *if hides(middle) { &mut hidden } else { &mut clear } = middle;
        }
        clear
    }

    /// Goes on at the given rates.
    fn advance(
        &mut self,
        course: &Course,
        problem: &RateProblem<'_>,
        rates: &Rates,
        (t, to): (f64, f64),
        reached: &[Reached],
    ) -> Result<(), PathError> {
        let (laws, system) = (self.place.laws, &*self.place.laws.problem.system);
        let load = course.load_at(system, to);
        let standing = &self.standing;
        let before = laws.force_sizes(&standing.z, &course.sizes_at(system, t));
        let mut z = &standing.z + &rates.z * (to - t);
        let close: Vec<usize> = reached
            .iter()
            .filter_map(|limit| match limit {
                Reached::Closing(pair) => Some(*pair),
                _ => None,
            })
            .collect();
        problem.correct(standing, &rates.moving, &close, &mut z, &load, |pair| laws.constant(pair));
        let found = laws.force(&z, &load);
        let mut force = found.clone();
        problem.settle(standing, &rates.moving, &mut force, |pair| laws.constant(pair));
        let sizes = laws.force_sizes(&z, &course.sizes_at(system, to));
        // Whatever the rates were: what stands at the end has to be a state. Where a load is let off, what is left has the rounding
        // of what was there.
        let size = |joint: usize| sizes[joint].max(before[joint]);
        if (0..z.len()).any(|joint| (found[joint] - force[joint]).abs() > TOLERANCE * size(joint)) {
            return Err(breakdown(
                t,
                "the forces of the laws are not those of the displacements that the rates lead to",
            ));
        }
        let lengths = laws.length_sizes(&joint_scales(system), &z) * TOLERANCE;
        if let Some(pair) =
            system.pairs.iter().enumerate().position(|(i, pair)| !pair.law.is_bilateral() && z[i] < -lengths[i])
        {
            let why = format!("the bodies of pair {} would overlap where the rates lead to", system.pairs[pair].id);
            return Err(breakdown(t, &why));
        }
        self.place.way = self.way_of(rates);
        for meaning in &rates.moving {
            let sense = match meaning.couple {
                RowKind::Normal => continue,
                RowKind::PLUS => Sense::Plus,
                RowKind::Facet(_) => Sense::Minus,
            };
            self.standing.last_slip[meaning.pair] = Some(sense);
        }
        self.standing.z = z;
        self.standing.force = force;
        self.place.factors = course.factors_at(to);
        self.place.gaps = course.gaps_at(to);
        self.standing.classify(laws, &sizes, reached);
        Ok(())
    }

    /// What every pair does at these rates.
    fn way_of(&self, rates: &Rates) -> Vec<(State, Option<State>)> {
        let moves = |pair: usize, couple: RowKind| rates.moving.contains(&RowId { pair, couple });
        // A pair that may slip but whose rate is rounding rests at its limit.
        let noise = self.place.laws.length_sizes(&joint_scales(&self.place.laws.problem.system), &rates.z) * NOISE;
        let slides = |joint: Option<usize>| joint.is_some_and(|joint| rates.z[joint].abs() > noise[joint]);
        let pairs = self.place.laws.problem.system.pairs.iter().enumerate();
        pairs
            .map(|(i, pair)| {
                let open = match self.standing.normal[i] {
                    Normal::Open => true,
                    Normal::Grazing => moves(i, RowKind::Normal),
                    Normal::Closed | Normal::Bilateral => false,
                };
                let slips = match (moves(i, RowKind::PLUS), moves(i, RowKind::MINUS)) {
                    _ if !slides(pair.plane_tangential()) => State::Stick,
                    (true, _) => State::SlipPlus,
                    (_, true) => State::SlipMinus,
                    _ => State::Stick,
                };
                let held = if open && pair.rubs() { self.place.laws.constant(i) } else { 0.0 };
                State::of(open, pair.rubs().then_some(slips), held)
            })
            .collect()
    }

    /// Stands in another state, at place `t` of the stage.
    pub(super) fn stand_at(&mut self, course: &Course, t: f64, z: DVector<f64>, way: Vec<(State, Option<State>)>) {
        let system = &*self.place.laws.problem.system;
        for (i, pair) in system.pairs.iter().enumerate() {
            let Some(joint) = pair.plane_tangential() else {
                continue;
            };
            let slip = z[joint] - self.standing.z[joint];
            if slip != 0.0 {
                self.standing.last_slip[i] = Some(if slip > 0.0 { Sense::Plus } else { Sense::Minus });
            }
        }
        self.standing.force = self.place.laws.force(&z, &course.load_at(system, t));
        self.standing.z = z;
        self.place.factors = course.factors_at(t);
        self.place.gaps = course.gaps_at(t);
        self.place.way = way;
        self.classify(course, t, &[]);
    }

    /// See [`Standing::classify`].
    fn classify(&mut self, course: &Course, t: f64, reached: &[Reached]) {
        let laws = self.place.laws;
        let sizes = laws.force_sizes(&self.standing.z, &course.sizes_at(&laws.problem.system, t));
        self.standing.classify(laws, &sizes, reached);
    }
}

impl<'a> Follower<'a> for Walk<'a> {
    fn place(&self) -> &Place<'a> {
        &self.place
    }

    fn state(&self) -> JointState {
        let (z, force, terms) = (&self.standing.z, &self.standing.force, self.standing.force_sizes());
        let z_terms = DVector::zeros(z.len());
        let (z, force, terms) = (z.clone(), force.clone(), terms.clone());
        JointState {
            z,
            force,
            terms,
            z_terms,
            left: Vec::new(),
            p: 0.0,
            free: Vec::new(),
            shares: Shares::LeastNorm,
            on_cone: false,
        }
    }

    fn states(&self) -> Vec<PairState> {
        let mut pairs = self.standing.pair_states(self.place.laws);
        let problem = self.problem_at(&self.place.factors, &self.place.gaps);
        self.place.prepared.add_released_slips(&mut pairs, &problem, &self.standing.z);
        pairs
    }

    fn problem_at(&self, factors: &[f64], gaps: &[f64]) -> ContactProblem {
        self.place.laws.problem.clone().with_gaps(gaps).with_factors(factors)
    }

    fn stand_behind(&mut self, factors: &[f64], slips: DVector<f64>) -> Result<Option<&'static str>, PathError> {
        let gaps: Vec<f64> = self.place.laws.problem.gaps().collect();
        match self.answer_behind(slips.clone(), factors, &gaps)? {
            Err(how) => Ok(Some(how)),
            Ok(there) => {
                self.standing.z = slips;
                let here = Course { factors: [factors.to_vec(), factors.to_vec()], gaps: [gaps.clone(), gaps] };
                self.stand_at(&here, 1.0, there.z, there.states);
                Ok(None)
            }
        }
    }

    fn along(&mut self, course: &Course, report: &dyn Fn(f64) -> f64) -> Result<(Way, Limit), PathError> {
        let system = &*self.place.laws.problem.system;
        let (rate, sizes) = (course.rate(system), course.rate_sizes(system));
        let mut way = Way::from(self.moment(0.0, false));
        let (mut t, mut reached, mut events, mut jumps) = (0.0, Vec::new(), 0, 0);
        if rate.amax() == 0.0 {
            self.place.factors = course.factors_at(1.0);
            way.moments.push(self.moment(1.0, false));
            return Ok((way, None));
        }
        while t < 1.0 {
            self.place.watch.progress("stages", report(t));
            if self.place.watch.stop() {
                return Err(PathError::Interrupted);
            }
            events += 1;
            if events > EVENTS {
                return Err(breakdown(t, &format!("the limit of {EVENTS} events in a stage was reached")));
            }
            let last = self.standing.z.clone();
            let to = match self.stretch(course, (&rate, &sizes), t, &mut reached, &mut way)? {
                Stretch::Event(to) => {
                    jumps = if to > t { 0 } else { jumps };
                    to
                }
                Stretch::End { motion, p } => match self.beyond(course, t, (&motion, p, jumps < JUMPS), &mut way)? {
                    Ok(to) => {
                        jumps += 1;
                        to
                    }
                    Err(collapse) => return Ok((way, Some((t, collapse)))),
                },
                // Where there are rates nothing jumps.
                Stretch::Hidden { motion, p } => match self.beyond(course, t, (&motion, p, false), &mut way)? {
                    Ok(to) => to,
                    Err(mut collapse) => {
                        if !collapse.verdict.is_some_and(Verdict::is_proof) {
                            HIDES.clone_into(&mut collapse.explanation);
                        }
                        return Ok((way, Some((t, collapse))));
                    }
                },
            };
            if to > t {
                way.last_slip = &self.standing.z - &last;
            }
            t = to;
        }
        Ok((way, None))
    }
}

/// A history that cannot go on for reasons of its numbers.
pub(super) fn breakdown(t: f64, why: &str) -> PathError {
    PathError::Breakdown { name: "place in the stage".to_owned(), at: t, why: why.to_owned() }
}
