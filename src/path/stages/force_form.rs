//! Load histories of structures whose joints repeat one another.
//!
//! The rate problem of [`super::rate_problem`] is written from R, which such joints do not have. Here every stretch between
//! two events is followed in the LCP of the total load with increments of slip: all slips up to its start are committed, so
//! that the law of friction relates forces to the slip from there on, which within a stretch is what the rates say. The
//! scheme just ahead is found by Lemke's algorithm a small step further on; from the start of the stretch the answer is
//! then followed exactly, up to the next event.

use std::sync::Arc;

use nalgebra::DVector;

use super::Begin;
use super::beyond::explanation;
use super::course::Course;
use super::follower::{Follower, Limit, Place, Targets, Way, recorded};
use super::record::History;
use super::resting::{Beyond, Rest, rest};
use super::standing::Laws;
use super::walk::breakdown;
use crate::answer::check::{TOLERANCE, check_contact};
use crate::answer::pairs::{JointState, pair_states};
use crate::answer::record::{PairState, Ray, State};
use crate::contact::at_rest::AtRest;
use crate::contact::felt_part::{FeltPart, Scheme};
use crate::contact::force_form::unknowns;
use crate::contact::lcp::contact_lcp;
use crate::contact::load_path::{obeys_signs, path_lcp};
use crate::contact::problem::ContactProblem;
use crate::contact::written::ContactLcp;
use crate::explain::ray;
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::outcome::{Point, RayDirection};
use crate::lcp::parametric::{Parametric, Reach};
use crate::lcp::problem::NOISE;
use crate::lcp::variable::Variable;
use crate::model::rules::Covering;
use crate::path::cone_step::behind_slips;
use crate::path::start::{Cold, PathError, cold, state_of};
use crate::solve::Prepared;
use crate::solve::engines::under_other_coverings;
use crate::watch::Watch;

/// No stage has more events than this.
const EVENTS: usize = 20_000;
/// Steps after which the scheme ahead is looked for, as parts of a stage: the first that no event hides.
const AHEAD: [f64; 5] = [1e-3, 1e-5, 1e-7, 1e-8, 1e-9];
/// Pivots on the way to the next event.
const PIVOTS: usize = 1_000;
/// An event nearer than this part of a stage is the present place.
const HERE: f64 = 1e-13;

/// The state from which a history goes on.
struct ForcedWalk<'a> {
    place: Place<'a>,
    /// Total z and λ.
    state: JointState,
    /// Total slips over the joints; 0 in normal ones.
    slips: DVector<f64>,
    pairs: Vec<PairState>,
    /// In which sense each pair slipped last, ±1.
    last_slip: Vec<f64>,
    /// The largest |z| met so far.
    largest: f64,
}

/// A place from which a way is looked for.
struct Here<'h> {
    course: &'h Course,
    /// The place, as a part of the stage.
    t: f64,
    /// Whether what stands there was jumped to.
    has_jumped: bool,
    /// The problem there beyond the committed slips, and its LCP along the load's rate.
    problem: ContactProblem,
    path: ContactLcp,
}

/// What lies ahead of a place.
enum Ahead {
    /// The next event: its place, the LCP, the point.
    Event(f64, Box<ContactLcp>, Point),
    /// Likewise, but what the scheme leads to fails its check.
    Doubtful(f64, Box<ContactLcp>, Point),
    /// A state here or a little further on that no scheme leads to from here.
    Jump(f64, Box<ContactLcp>, Point),
    /// Nothing: the ray of the nearest look ahead.
    Limit(Option<Box<(ContactLcp, RayDirection, f64)>>),
}

/// Follows the given factors of all load cases, stage by stage, from where the history begins.
pub(super) fn follow<'a>(
    prepared: &'a Prepared,
    laws: Laws<'a>,
    begin: &Begin,
    targets: Targets<'_>,
    watch: &'a dyn Watch,
) -> Result<History, PathError> {
    let joints = laws.problem.system.joint_count();
    let mut walk = ForcedWalk {
        place: Place::unloaded(prepared, laws, watch),
        state: JointState::at(laws.problem, DVector::zeros(joints), 0.0),
        slips: DVector::zeros(joints),
        pairs: Vec::new(),
        last_slip: vec![0.0; laws.problem.system.pair_count()],
        largest: 0.0,
    };
    walk.stand_unloaded();
    walk.begin(begin, targets.0)?;
    let (stages, end) = walk.stages(targets)?;
    Ok(recorded(&walk.place, stages, end))
}

impl ForcedWalk<'_> {
    /// The problem for slips that count from the committed ones.
    fn beyond_slips(&self, factors: &[f64], gaps: &[f64]) -> ContactProblem {
        behind_slips(self.problem_at(factors, gaps), &self.slips)
    }

    /// Stands without loads, as the parts were built: no displacements, no forces, every pair as far open as its gap, which is
    /// none below 0. That is an answer whatever joints repeat one another, and needs no run, which may miss it among others.
    fn stand_unloaded(&mut self) {
        let problem = self.problem_at(&self.place.factors, &self.place.gaps);
        let mut unknowns = DVector::zeros(problem.system.joint_count());
        for (pair, gap) in self.place.gaps.iter().enumerate().filter(|(pair, _)| !problem.system.is_forced(*pair)) {
            unknowns[pair] = *gap;
        }
        let state = JointState::at(&problem, unknowns, 0.0);
        self.stand(&problem, &path_lcp(&problem, &problem.load), state);
    }

    /// Stands under these factors and gaps at the answer in increments from the committed slips; how the run ended where
    /// there is none.
    fn stand_under(&mut self, factors: &[f64], gaps: &[f64]) -> Result<Option<&'static str>, PathError> {
        let problem = self.beyond_slips(factors, gaps);
        let found = cold(&problem, self.place.watch)?;
        if found.basis.is_none() {
            return Ok(Some(found.how()));
        }
        (self.place.factors, self.place.gaps) = (factors.to_vec(), gaps.to_vec());
        self.stand(&problem, &found.contact, state_of(&problem, &found.contact, &found.point));
        Ok(None)
    }

    /// Stands at a state of the problem of increments of slip whose LCP this is.
    fn stand(&mut self, problem: &ContactProblem, contact: &ContactLcp, mut state: JointState) {
        let system = &*self.place.laws.problem.system;
        state.left.clear();
        // Where all joints close again, what is left of the displacements met is rounding, and opens nothing.
        self.largest = self.largest.max((&state.z + &self.slips).amax());
        state.z.iter_mut().filter(|z| z.abs() <= NOISE * self.largest).for_each(|z| *z = 0.0);
        let mut pairs = pair_states(problem, contact, &state);
        self.place.way = pairs.iter().map(|pair| (pair.state, pair.held)).collect();
        for (i, (pair, shown)) in system.pairs.iter().zip(&mut pairs).enumerate() {
            let Some(joint) = pair.plane_tangential() else { continue };
            if state.z[joint] != 0.0 {
                self.last_slip[i] = state.z[joint].signum();
            }
            state.z[joint] += self.slips[joint];
            self.slips[joint] = state.z[joint];
            shown.z_t = state.z[joint];
            // On the limit at which it slipped last it is shown as slipping.
            let word = match self.last_slip[i] {
                last if last > 0.0 && shown.reserve_plus == 0.0 => State::SlipPlus,
                last if last < 0.0 && shown.reserve_minus == 0.0 => State::SlipMinus,
                _ => continue,
            };
            match shown.state {
                State::Open => shown.held = shown.held.map(|_| word),
                _ => shown.state = word,
            }
        }
        self.state = state;
        self.pairs = pairs;
    }

    /// Whether a point of the LCP of a problem beyond the committed slips is the present state: no slip in it, and as far
    /// open. Sizes are those of this point and of all states before.
    fn is_here(&self, problem: &ContactProblem, contact: &ContactLcp, point: &Point) -> bool {
        let there = state_of(problem, contact, point);
        let still = &self.state.z - &self.slips;
        (&there.z - &still).amax() <= TOLERANCE * self.largest.max((&there.z + &self.slips).amax())
    }

    /// The next event, found from the scheme a little ahead. Unless what stands here was jumped to, an answer here that is another
    /// state is jumped to.
    fn ahead(
        &self,
        course: &Course,
        rate: &DVector<f64>,
        (t, has_jumped): (f64, bool),
        way: &mut Way,
    ) -> Result<Ahead, PathError> {
        let problem = self.beyond_slips(&course.factors_at(t), &course.gaps_at(t));
        let path = path_lcp(&problem, rate);
        let here = Here { course, t, has_jumped, problem, path };
        let (mut jump, mut limit, mut elsewhere) = (None, None, None);
        for step in AHEAD {
            let (to, problem) = self.a_little_ahead(&here, step);
            let found = cold(&problem, self.place.watch)?;
            let Some(basis) = &found.basis else {
                let p = found.point.p * found.contact.force_unit;
                limit = found.ray().cloned().map(|ray| Box::new((found.contact.clone(), ray, p)));
                jump = None;
                continue;
            };
            jump = passes(&problem, &found.contact, &found.point)
                .then(|| (to, Box::new(found.contact.clone()), found.point.clone()));
            match self.onward(&here, basis, way) {
                Some(event @ Ahead::Event(..)) => return Ok(event),
                other => elsewhere = later(other, elsewhere),
            }
        }
        let jump = jump.map(|(to, contact, point)| Ahead::Jump(to, contact, point));
        let felt = match self.in_felt_part(&here, way)? {
            Some(event @ Ahead::Event(..)) => return Ok(event),
            felt => felt,
        };
        let drawn = match self.under_drawn_coverings(&here, way) {
            Some(event @ Ahead::Event(..)) => return Ok(event),
            drawn => drawn,
        };
        // What fails its check comes after all that passes it.
        let found = [drawn, felt, jump, elsewhere].into_iter().fold(None, |found, other| later(other, found));
        Ok(found.unwrap_or(Ahead::Limit(limit)))
    }

    /// The place a step of a stage further on, and the problem there.
    fn a_little_ahead(&self, here: &Here<'_>, step: f64) -> (f64, ContactProblem) {
        let to = (here.t + step).min(1.0);
        (to, self.problem_behind(here.course, to))
    }

    /// The problem at a place of a stage beyond the committed slips.
    fn problem_behind(&self, course: &Course, to: f64) -> ContactProblem {
        self.beyond_slips(&course.factors_at(to), &course.gaps_at(to))
    }

    /// The next event after t, where a scheme of the joints that can carry something leads on from here ([`FeltPart`]). Where they
    /// collapse, the jump to where their motion closes an open pair, if that is a state a little ahead.
    fn in_felt_part(&self, here: &Here<'_>, way: &mut Way) -> Result<Option<Ahead>, PathError> {
        let Some(part) = self.felt_part() else { return Ok(None) };
        let mut jump = None;
        for step in AHEAD {
            let (to, whole) = self.a_little_ahead(here, step);
            let problem = part.problem(&whole);
            let found = cold(&problem, self.place.watch)?;
            let Some(basis) = &found.basis else {
                let met = self.where_it_closes(&part, (&whole, &problem), &found);
                jump = met.map(|(contact, point)| Ahead::Jump(to, Box::new(contact), point)).or(jump);
                continue;
            };
            let unknowns = unknowns(&problem.system, Some(&problem), &found.contact, &found.point.z);
            let scheme = Scheme { contact: &found.contact, basis, unknowns: &unknowns };
            let basis = part.spread((&whole, &here.path), scheme);
            match self.onward(here, &basis, way) {
                Some(event @ Ahead::Event(..)) => return Ok(Some(event)),
                other => jump = later(other, jump),
            }
        }
        Ok(jump)
    }

    /// The part of the joints that can carry something in the present state.
    fn felt_part(&self) -> Option<FeltPart> {
        let Laws { problem } = self.place.laws;
        let mut nothing = vec![false; problem.system.joint_count()];
        for (i, (pair, law)) in problem.system.pairs.iter().zip(&problem.laws).enumerate() {
            let (open, bare) = (!law.is_bilateral() && self.state.z[i] > 0.0, law.fixed_bound() == 0.0);
            nothing[i] = open && bare;
            if let Some(joint) = pair.plane_tangential() {
                nothing[joint] = bare && (open || law.friction() == 0.0);
            }
        }
        FeltPart::new(&problem.system, &nothing)
    }

    /// The state in which a collapse of the part ends where it closes an open pair, if it passes the check of an answer.
    fn where_it_closes(
        &self,
        part: &FeltPart,
        (whole, problem): (&ContactProblem, &ContactProblem),
        found: &Cold,
    ) -> Option<(ContactLcp, Point)> {
        let ray = found.ray()?;
        let mut basis = found.last.clone();
        match ray.entering {
            Variable::Z(row) => basis.z.push(row),
            Variable::W(row) => basis.active.retain(|own| *own != row),
            Variable::P => return None,
        }
        let unknowns = unknowns(&problem.system, None, &found.contact, &ray.z);
        let collapse = Scheme { contact: &found.contact, basis: &basis, unknowns: &unknowns };
        let contact = path_lcp(whole, &whole.load);
        let basis = part.closed_by_collapse((whole, &contact), collapse, &self.state.z)?;
        let point = vertex(&contact.lcp, &basis).filter(|point| passes(whole, &contact, point))?;
        Some((contact, point))
    }

    /// The next event after t, where the runs of other coverings a little ahead find a scheme that leads on from here; else the jump
    /// to the nearest state that they find the least ahead. In joints that repeat one another the matrix is not one that a run under
    /// a given covering must solve: it may end in a ray, or at an answer far off, where another run ends at the state that goes on.
    fn under_drawn_coverings(&self, here: &Here<'_>, way: &mut Way) -> Option<Ahead> {
        let mut nearest: Option<(f64, Ahead)> = None;
        let still = &self.state.z - &self.slips;
        let event = AHEAD.iter().find_map(|step| {
            let (to, problem) = self.a_little_ahead(here, *step);
            let contact = contact_lcp(&problem, Covering::Cohesive).ok()?;
            nearest = None;
            under_other_coverings(&contact, self.place.watch, |run| {
                let event = self.onward(here, &run.pivots.basis(), way);
                let event = event.filter(|ahead| matches!(ahead, Ahead::Event(..)));
                let motion = (&state_of(&problem, &contact, &run.point).z - &still).amax();
                if event.is_none()
                    && nearest.as_ref().is_none_or(|(least, _)| motion < *least)
                    && passes(&problem, &contact, &run.point)
                {
                    nearest = Some((motion, Ahead::Jump(to, Box::new(contact.clone()), run.point.clone())));
                }
                event
            })
        });
        event.or(nearest.map(|(_, jump)| jump))
    }

    /// Where the scheme of a basis leads from here on: to the next event, or, unless what stands here was jumped to, to another
    /// state here.
    fn onward(&self, here: &Here<'_>, basis: &Basis, way: &mut Way) -> Option<Ahead> {
        let Here { course, t, has_jumped, problem, path } = here;
        // Beside what moved before, a displacement from here on may be rounding; force takes none for another.
        let still = |variable| match variable {
            Variable::Z(row) if !path.swapped[row] => TOLERANCE * self.largest / path.length_unit,
            Variable::W(row) if path.swapped[row] => TOLERANCE * self.largest / path.length_unit,
            _ => 0.0,
        };
        vertex(&path.lcp, basis).filter(|point| obeys_signs(&path.lcp, point, &still))?;
        let mut engine = Parametric::new(Arc::clone(&path.lcp), basis, path.lexicographic_order())?;
        let start = engine.point();
        if !has_jumped && !self.is_here(problem, path, &start) {
            return passes(problem, path, &start).then(|| Ahead::Jump(*t, Box::new(path.clone()), start));
        }
        let reach = Reach { target: 1.0 - t, through: false, pivots: PIVOTS };
        let followed = engine.follow(reach, &mut |_| self.place.watch.go_on());
        way.pivots += followed.pivots;
        let knot = followed.knots.iter().find(|knot| knot.t > HERE)?;
        let to = if knot.t >= 1.0 - t - HERE { 1.0 } else { t + knot.t };
        let point = Point { p: 0.0, ..knot.point.clone() };
        let is_state = passes(&self.problem_behind(course, to), path, &point);
        let kind = if is_state { Ahead::Event } else { Ahead::Doubtful };
        Some(kind(to, Box::new(path.clone()), point))
    }

    /// The collapse at place t of a stage, from the ray met just beyond it.
    fn collapse(&self, course: &Course, t: f64, ray: Option<Box<(ContactLcp, RayDirection, f64)>>) -> Ray {
        // At the limit itself the forces still balance.
        let (factors, gaps) = (course.factors_at(t + AHEAD[1]), course.gaps_at(t + AHEAD[1]));
        let problem = self.beyond_slips(&factors, &gaps);
        let (contact, direction, p) = match ray {
            Some(found) => *found,
            // The run ended in no ray: there is no motion to show.
            None => {
                let contact = path_lcp(&problem, &problem.load);
                let still = vec![0.0; contact.rows.len()];
                let direction = RayDirection { entering: Variable::P, z: still.clone(), w: still, p: 0.0 };
                (contact, direction, 0.0)
            }
        };
        let mut collapse = ray::report(&problem, self.place.prepared.built(), &contact, &direction, p);
        collapse.explanation = explanation(&collapse).to_owned();
        collapse
    }
}

/// The later of two ways on, unless it leads to what fails its check and the other does not.
fn later(other: Option<Ahead>, before: Option<Ahead>) -> Option<Ahead> {
    match (&other, &before) {
        (Some(Ahead::Doubtful(..)), Some(Ahead::Jump(..))) => before,
        _ => other.or(before),
    }
}

/// Whether a point is a state that passes the check of an answer: what is jumped to hangs on no way that led there.
fn passes(problem: &ContactProblem, contact: &ContactLcp, point: &Point) -> bool {
    check_contact(problem, &state_of(problem, contact, point), None).passed
}

impl<'a> Follower<'a> for ForcedWalk<'a> {
    fn place(&self) -> &Place<'a> {
        &self.place
    }

    fn state(&self) -> JointState {
        self.state.clone()
    }

    fn states(&self) -> Vec<PairState> {
        let Place { prepared, factors, gaps, .. } = &self.place;
        let mut pairs = self.pairs.clone();
        prepared.add_released_slips(&mut pairs, &self.problem_at(factors, gaps), &self.state.z);
        pairs
    }

    fn problem_at(&self, factors: &[f64], gaps: &[f64]) -> ContactProblem {
        self.place.laws.problem.clone().with_gaps(gaps).with_factors(factors)
    }

    fn stand_behind(&mut self, factors: &[f64], slips: DVector<f64>) -> Result<Option<&'static str>, PathError> {
        self.slips = slips;
        let gaps: Vec<f64> = self.place.laws.problem.gaps().collect();
        self.stand_under(factors, &gaps)
    }

    fn along(&mut self, course: &Course, report: &dyn Fn(f64) -> f64) -> Result<(Way, Limit), PathError> {
        let mut way = Way::from(self.moment(0.0, false));
        let (mut t, mut events, mut has_jumped) = (0.0, 0, false);
        let constants = |at: f64| self.problem_at(&course.factors_at(at), &course.gaps_at(at)).joint_constants();
        let rate = constants(1.0) - constants(0.0);
        if rate.amax() == 0.0 {
            self.place.factors = course.factors_at(1.0);
            way.moments.push(self.moment(1.0, false));
            return Ok((way, None));
        }
        while t < 1.0 {
            self.place.watch.progress("stages", report(t));
            events += 1;
            if events > EVENTS {
                return Err(breakdown(t, &format!("the limit of {EVENTS} events in a stage was reached")));
            }
            let behind = |to: f64| self.problem_behind(course, to);
            let passes = |to: f64, found: &AtRest| {
                let problem = behind(to);
                check_contact(&problem, &JointState::at_rest(&problem, found.clone()), None).passed
            };
            let beyond = Beyond { behind: &|to| Some(behind(to)), passes: &passes };
            let ahead = self.ahead(course, &rate, (t, has_jumped), &mut way)?;
            let rests = match ahead {
                Ahead::Event(..) => None,
                // What can stay where it is does not jump.
                _ => rest(&beyond, (&self.state.z, &self.state.force), t, self.place.watch)?,
            };
            let (to, contact, state, jump) = match (ahead, rests) {
                (_, Some(Rest { to, found })) => {
                    way.rest([t, to]);
                    (to, path_lcp(&behind(to), &rate), Ok(found), false)
                }
                (Ahead::Event(to, contact, point) | Ahead::Doubtful(to, contact, point), None) => {
                    (to, *contact, Err(point), false)
                }
                (Ahead::Jump(to, contact, point), None) => (to, *contact, Err(point), true),
                (Ahead::Limit(ray), None) => return Ok((way, Some((t, self.collapse(course, t, ray))))),
            };
            let (problem, before) = (behind(to), self.slips.clone());
            let state = match state {
                Ok(rest) => JointState::at_rest(&problem, rest),
                Err(point) => state_of(&problem, &contact, &point),
            };
            (self.place.factors, self.place.gaps) = (course.factors_at(to), course.gaps_at(to));
            self.stand(&problem, &contact, state);
            way.last_slip = &self.slips - before;
            way.moments.push(self.moment(to, jump));
            (t, has_jumped) = (to, jump && to == t);
        }
        Ok((way, None))
    }
}
