//! Following: rates, next event, slips committed, rates again.

use std::time::Instant;

use nalgebra::DVector;

use super::course::Course;
use super::energy;
use super::event::next_event;
use super::rate_problem::{Ended, RateProblem, Rates};
use super::record::{History, HistoryEnd, Moment, StageResult};
use super::standing::{Laws, Normal, Reached, Sense, Standing, joint_scales, scheme_of};
use crate::answer::pairs::JointState;
use crate::answer::record::{OutcomeKind, PairState, Ray, State};
use crate::contact::complementarity::{ContactLcp, Couple, RowMeaning};
use crate::contact::numbers::ContactNumbers;
use crate::explain::sentence::pivot_records;
use crate::lcp::outcome::Run;
use crate::lcp::problem::NOISE;
use crate::path::change::{between, sentence};
use crate::path::start::PathError;
use crate::solve::Prepared;
use crate::solve::attempt::kind;
use crate::watch::Watch;

/// No stage has more events than this.
const EVENTS: usize = 100_000;

/// The state from which the history goes on.
pub(super) struct Walk<'a> {
    pub(super) prepared: &'a Prepared,
    pub(super) laws: Laws<'a>,
    pub(super) watch: &'a dyn Watch,
    pub(super) standing: Standing,
    factors: Vec<f64>,
    gaps: Vec<f64>,
    /// What every pair did on the way here.
    way: Vec<(State, Option<State>)>,
    /// The last run of Lemke's algorithm, on a rate problem.
    last_run: Option<(Run, ContactLcp)>,
    /// Time spent on rate problems.
    lemke_seconds: f64,
}

/// The way through a stage.
pub(super) struct Way {
    pub(super) moments: Vec<Moment>,
    pivots: usize,
    /// z_τ of its last stretch, over the joints.
    last_slip: DVector<f64>,
}

/// What one stretch of a stage came to.
enum Stretch {
    /// The place reached.
    Event(f64),
    /// No rates lead on from here.
    End { motion: DVector<f64>, p: f64 },
}

impl<'a> Walk<'a> {
    /// Stands on the unloaded structure; parts with interference (gaps below 0) are put together first.
    pub(super) fn start(prepared: &'a Prepared, laws: Laws<'a>, watch: &'a dyn Watch) -> Result<Walk<'a>, PathError> {
        let own = &laws.numbers.gap;
        let mut walk = Walk {
            prepared,
            laws,
            watch,
            standing: Standing::unloaded(laws),
            factors: vec![0.0; prepared.cases.len()],
            gaps: own.iter().map(|gap| gap.max(0.0)).collect(),
            way: Vec::new(),
            last_run: None,
            lemke_seconds: 0.0,
        };
        walk.way = walk.states().iter().map(|pair| (pair.state, pair.held)).collect();
        if own.iter().any(|gap| *gap < 0.0) {
            let none = walk.factors.clone();
            let course = Course { factors: [none.clone(), none], gaps: [walk.gaps.clone(), own.clone()] };
            if let (_, Some((at, _))) = walk.along(&course, &|_| 0.0)? {
                let name = "interference".to_owned();
                return Err(PathError::NoStart {
                    name,
                    at,
                    how: "in a limit: the parts cannot be put together".into(),
                });
            }
        }
        Ok(walk)
    }

    /// Follows the given factors of all load cases, stage by stage.
    pub(super) fn follow(mut self, targets: &[Vec<f64>]) -> Result<History, PathError> {
        let mut stages = Vec::new();
        let mut end = HistoryEnd::Complete;
        for (index, target) in targets.iter().enumerate() {
            let report = |t: f64| (index as f64 + t) / targets.len() as f64;
            let course = Course {
                factors: [self.factors.clone(), target.clone()],
                gaps: [self.gaps.clone(), self.gaps.clone()],
            };
            let before = self.states();
            let (way, limit) = self.along(&course, &report)?;
            stages.push(self.result(way, &before, limit.as_ref()));
            if let Some((t, collapse)) = limit {
                end = HistoryEnd::Limit { stage: index, t, collapse: Box::new(collapse) };
                break;
            }
        }
        if let (Some(stage), Some((run, contact))) = (stages.last_mut(), &self.last_run) {
            stage.end.attempts.iter_mut().for_each(|attempt| attempt.outcome = kind(&run.outcome));
            stage.end.pivot_count = run.pivots.count();
            stage.end.pivots = pivot_records(run.pivots.recorded(), contact, self.laws.system);
            stage.end.timings.lemke = self.lemke_seconds;
        }
        let cases = self.prepared.cases.iter().map(|(name, _)| name.clone()).collect();
        let mut history = History { cases, stages, end };
        energy::balance(self.prepared, self.laws.numbers, &mut history);
        Ok(history)
    }

    /// A stage that has been followed, from the pairs `before` it.
    fn result(&self, mut way: Way, before: &[PairState], limit: Option<&(f64, Ray)>) -> StageResult {
        self.tell_changes(&mut way.moments);
        let numbers = self.numbers_at(&self.factors, &self.gaps);
        let pairs = self.states();
        let slip = pairs.iter().zip(before).map(|(pair, before)| pair.z_t - before.z_t).collect();
        let (system, state) = (self.laws.system, self.state());
        let mut end = self.prepared.history_answer(system, &numbers, &self.factors, &state, &way.last_slip, pairs);
        if let Some((_, collapse)) = limit
            && end.is_answer()
        {
            end.outcome = OutcomeKind::Ray;
            end.p = collapse.p;
            end.ray = Some(collapse.clone());
        }
        StageResult {
            dissipated: energy::dissipated(self.laws.system, &way.moments),
            moments: way.moments,
            pivots: way.pivots,
            slip,
            energy: None,
            end,
        }
    }

    /// Follows one stage; the place and the collapse where it ends in a limit.
    fn along(&mut self, course: &Course, report: &dyn Fn(f64) -> f64) -> Result<(Way, Option<(f64, Ray)>), PathError> {
        let system = self.laws.system;
        let (rate, sizes) = (course.rate(system), course.rate_sizes(system));
        let none = DVector::zeros(system.joint_count());
        let mut way = Way { moments: vec![self.moment(0.0, false)], pivots: 0, last_slip: none };
        let (mut t, mut reached, mut events) = (0.0, Vec::new(), 0);
        if rate.amax() == 0.0 {
            self.factors = course.factors_at(1.0);
            way.moments.push(self.moment(1.0, false));
            return Ok((way, None));
        }
        while t < 1.0 {
            self.watch.progress("stages", report(t));
            if self.watch.stop() {
                return Err(PathError::Interrupted);
            }
            events += 1;
            if events > EVENTS {
                return Err(breakdown(t, &format!("the limit of {EVENTS} events in a stage was reached")));
            }
            let last = self.standing.z.clone();
            let to = match self.stretch(course, (&rate, &sizes), t, &mut reached, &mut way)? {
                Stretch::Event(to) => to,
                Stretch::End { motion, p } => match self.beyond(course, t, (&motion, p), &mut way)? {
                    Ok(to) => to,
                    Err(collapse) => return Ok((way, Some((t, collapse)))),
                },
            };
            if to > t {
                way.last_slip = &self.standing.z - &last;
            }
            t = to;
        }
        Ok((way, None))
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
        let system = self.laws.system;
        let Some(problem) = RateProblem::new(self.laws, &self.standing, rate) else {
            return Err(breakdown(t, "the stiffness of the open pairs is not positive definite"));
        };
        let start = Instant::now();
        let (ended, run) = problem.solve(&self.standing, sizes, self.watch);
        self.lemke_seconds += start.elapsed().as_secs_f64();
        way.pivots += run.pivots.count();
        self.last_run = Some((run, problem.contact.clone()));
        let rates = match ended {
            Ended::Rates(rates) => rates,
            Ended::Ray { motion, p } => return Ok(Stretch::End { motion, p }),
            Ended::Interrupted => return Err(PathError::Interrupted),
            Ended::Breakdown(why) => return Err(breakdown(t, &why)),
        };
        let (step, mut now) = next_event(self.laws, &self.standing, &rates, sizes);
        let to = if step >= 1.0 - t { 1.0 } else { t + step };
        if step > 1.0 - t {
            now.clear();
        }
        if to == t {
            // Nothing has moved: what was reached stays reached.
            reached.append(&mut now);
            self.standing.classify(self.laws, &course.sizes_at(system, t), reached);
            return Ok(Stretch::Event(to));
        }
        self.advance(course, &problem, &rates, (t, to), &now);
        *reached = now;
        way.moments.push(self.moment(to, false));
        Ok(Stretch::Event(to))
    }

    /// Goes on at the given rates.
    fn advance(
        &mut self,
        course: &Course,
        problem: &RateProblem<'_>,
        rates: &Rates,
        (t, to): (f64, f64),
        reached: &[Reached],
    ) {
        let (laws, system) = (self.laws, self.laws.system);
        let load = course.load_at(system, to);
        let standing = &self.standing;
        let mut z = &standing.z + &rates.z * (to - t);
        let close: Vec<usize> = reached
            .iter()
            .filter_map(|limit| match limit {
                Reached::Closing(pair) => Some(*pair),
                _ => None,
            })
            .collect();
        problem.correct(standing, &rates.moving, &close, &mut z, &load, |pair| laws.constant(pair));
        let mut force = laws.force(&z, &load);
        problem.settle(standing, &rates.moving, &mut force, |pair| laws.constant(pair));
        self.way = self.way_of(rates);
        for meaning in &rates.moving {
            let sense = match meaning.couple {
                Couple::Normal => continue,
                Couple::Plus => Sense::Plus,
                Couple::Minus => Sense::Minus,
            };
            self.standing.last_slip[meaning.pair] = Some(sense);
        }
        self.standing.z = z;
        self.standing.force = force;
        self.factors = course.factors_at(to);
        self.gaps = course.gaps_at(to);
        self.standing.classify(laws, &course.sizes_at(system, to), reached);
    }

    /// What every pair does at these rates.
    fn way_of(&self, rates: &Rates) -> Vec<(State, Option<State>)> {
        let moves = |pair: usize, couple: Couple| rates.moving.contains(&RowMeaning { pair, couple });
        // A pair that may slip but whose rate is rounding rests at its limit.
        let noise = self.laws.length_sizes(&joint_scales(self.laws.system), &rates.z) * NOISE;
        let slides = |joint: Option<usize>| joint.is_some_and(|joint| rates.z[joint].abs() > noise[joint]);
        let pairs = self.laws.system.pairs.iter().enumerate();
        pairs
            .map(|(i, pair)| {
                let open = match self.standing.normal[i] {
                    Normal::Open => true,
                    Normal::Grazing => moves(i, Couple::Normal),
                    Normal::Closed | Normal::Bilateral => false,
                };
                let slips = match (moves(i, Couple::Plus), moves(i, Couple::Minus)) {
                    _ if !slides(pair.tangential) => State::Stick,
                    (true, _) => State::SlipPlus,
                    (_, true) => State::SlipMinus,
                    _ => State::Stick,
                };
                let held = if open && pair.tangential.is_some() { self.laws.constant(i) } else { 0.0 };
                scheme_of(open, pair.tangential.is_some(), slips, held)
            })
            .collect()
    }

    /// The numbers of the laws under these factors and gaps.
    pub(super) fn numbers_at(&self, factors: &[f64], gaps: &[f64]) -> ContactNumbers {
        let mut numbers = ContactNumbers { gap: gaps.to_vec(), ..self.laws.numbers.clone() };
        numbers.load.fill(0.0);
        for (load, factor) in self.laws.system.loads.iter().zip(factors) {
            numbers.load.axpy(*factor, &load.vector, 1.0);
        }
        numbers
    }

    /// Stands in another state, at place `t` of the stage.
    pub(super) fn stand_at(&mut self, course: &Course, t: f64, z: DVector<f64>, way: Vec<(State, Option<State>)>) {
        let system = self.laws.system;
        for (i, pair) in system.pairs.iter().enumerate() {
            let Some(joint) = pair.tangential else {
                continue;
            };
            let slip = z[joint] - self.standing.z[joint];
            if slip != 0.0 {
                self.standing.last_slip[i] = Some(if slip > 0.0 { Sense::Plus } else { Sense::Minus });
            }
        }
        self.standing.force = self.laws.force(&z, &course.load_at(system, t));
        self.standing.z = z;
        self.factors = course.factors_at(t);
        self.gaps = course.gaps_at(t);
        self.way = way;
        self.standing.classify(self.laws, &course.sizes_at(system, t), &[]);
    }

    fn state(&self) -> JointState {
        let (z, force, terms) = (&self.standing.z, &self.standing.force, self.standing.force_sizes());
        let z_terms = DVector::zeros(z.len());
        let (z, force, terms) = (z.clone(), force.clone(), terms.clone());
        JointState { z, force, terms, z_terms, left: Vec::new(), slips: None, p: 0.0, free: Vec::new() }
    }

    /// The pairs where it stands.
    fn states(&self) -> Vec<PairState> {
        let mut pairs = self.standing.pair_states(self.laws);
        let numbers = self.numbers_at(&self.factors, &self.gaps);
        self.prepared.add_released_slips(&mut pairs, &numbers, &self.factors, &self.standing.z);
        pairs
    }

    pub(super) fn moment(&self, t: f64, jump: bool) -> Moment {
        let mut pairs = self.states();
        for (pair, way) in pairs.iter_mut().zip(&self.way) {
            (pair.state, pair.held) = *way;
        }
        Moment {
            t,
            factors: self.factors.clone(),
            pairs,
            changes: Vec::new(),
            sentence: String::new(),
            jump,
            way: self.way.clone(),
            state: self.state(),
        }
    }

    /// What changes at each moment: what the pairs did on the way to it and do after it differs.
    fn tell_changes(&self, moments: &mut [Moment]) {
        let ids = || self.laws.system.pairs.iter().map(|pair| pair.id.as_str());
        for k in 0..moments.len().saturating_sub(1) {
            let changes = between(ids(), &moments[k].way, &moments[k + 1].way);
            moments[k].sentence = sentence(&changes);
            moments[k].changes = changes;
        }
    }
}

/// A history that cannot go on for reasons of its numbers.
pub(super) fn breakdown(t: f64, why: &str) -> PathError {
    PathError::Breakdown { name: "place in the stage".to_owned(), at: t, why: why.to_owned() }
}
