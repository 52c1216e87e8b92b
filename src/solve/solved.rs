//! One solved state, and every working scheme on the way to it.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use nalgebra::DVector;

use super::attempt::{keep_scheme, kind};
use super::engines::{EXACT_PAIRS, run_exact_contact, run_tableau};
use super::plain::{PlainProblem, solve_plain_judged};
use super::prepared::{Geometry, Prepared};
use super::warm::WarmStart;
use crate::answer::check::check_contact;
use crate::answer::pairs::{JointState, joint_state, pair_states};
use crate::answer::record::{
    Answer, Attempt, Check, EndForces, MemberForces, NodeDisplacement, OutcomeKind, PairState, PlainSolution, Reaction,
    Size, Start, Timings,
};
use crate::contact::kernel_correction::sharpen;
use crate::contact::lcp::{ContactLcp, CoveringError, contact_lcp};
use crate::contact::numbers::ContactNumbers;
use crate::contact::refine::refined;
use crate::contact::self_stress::may_hold_otherwise;
use crate::contact::system::ContactSystem;
use crate::explain::plain_ray::PlainRay;
use crate::explain::ray::{self, RayReport};
use crate::explain::sentence;
use crate::explain::words::{list, short};
use crate::fem::Displacements;
use crate::lcp::basis_solution::{Basis, vertex};
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::pivot::{Cycle, PivotLog};
use crate::model::pair::Law;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Engine, Rules};
use crate::model::scenario::Scenario;
use crate::model::uses::Redone;
use crate::solve::follow::WarmSlot;
use crate::watch::Watch;

/// Most pairs that a note names.
const NAMED: usize = 6;

/// Why nothing was solved; the session stays as it was.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// The covering does not fit the numbers.
    #[error(transparent)]
    Covering(#[from] CoveringError),
    /// A covering chosen for a bare LCP.
    #[error(
        "a bare LCP has its own covering vector (`covering` in the file, ones otherwise): `covering {0}` is for contact"
    )]
    CoveringOfPlain(Covering),
    /// A law got a value it cannot have.
    #[error("{0}")]
    Value(String),
    /// More than the exact engine takes.
    #[error(
        "engine exact takes at most {most} {what} (this problem has {found}): use engine scheme or tableau; `check exact` \
         proves an answer of any size"
    )]
    TooLargeForExact {
        /// `contact pairs` or `rows`.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many it takes.
        most: usize,
    },
    /// Stopped from outside.
    #[error("interrupted")]
    Interrupted,
}

impl SolveError {
    /// Whether the work was stopped from outside.
    pub fn is_interrupted(&self) -> bool {
        matches!(self, SolveError::Interrupted)
    }
}

/// The numbers behind an answer: what is needed to look at any pivot of its run.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one for each solved state, never in lists")]
pub enum Trace {
    /// Of a contact problem.
    Contact {
        /// The LCP.
        contact: ContactLcp,
        /// Its numbers.
        numbers: ContactNumbers,
        /// Factor of each load case.
        factors: Vec<f64>,
        /// The pivots.
        pivots: PivotLog,
        /// The last vertex, dimensionless.
        last: Point,
    },
    /// Of a bare LCP.
    Plain {
        /// The LCP.
        lcp: Arc<MirroredLcp>,
        /// The pivots.
        pivots: PivotLog,
    },
}

/// An answer with its trace.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The answer as reported.
    pub answer: Answer,
    /// How it came about.
    pub trace: Trace,
    /// What is known of the ray it ended in; contact problems only.
    pub ray: Option<Box<RayReport>>,
    /// The same for a bare LCP.
    pub plain_ray: Option<Box<PlainRay>>,
    /// What retries or a comparison with the default rules add to the explanation.
    pub(super) told: String,
    /// Whether the run came back to a basis it had met.
    pub cycled: bool,
    /// The dictionary of the answer, for the next change; contact problems under the default engine only.
    pub(super) kept: Option<WarmSlot>,
}

impl Prepared {
    /// Solves for the given parameter values under the given rules.
    ///
    /// # Errors
    /// See [`SolveError`]. A run that ends in a ray or breaks down is no error: the answer says so.
    pub fn solve(
        &self,
        scenario: &Scenario,
        values: &ParameterValues,
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        self.solve_told(scenario, values, rules, false, watch)
    }

    /// As [`Prepared::solve`], without looking for what would stop a collapse: for sweeps, which only count.
    ///
    /// # Errors
    /// As [`Prepared::solve`].
    pub fn solve_briefly(
        &self,
        scenario: &Scenario,
        values: &ParameterValues,
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        self.solve_told(scenario, values, rules, true, watch)
    }

    fn solve_told(
        &self,
        scenario: &Scenario,
        values: &ParameterValues,
        rules: Rules,
        brief: bool,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        if let Some(refusal) = scenario.law_refusal(values) {
            return Err(SolveError::Value(refusal));
        }
        let start = Instant::now();
        let mut solved = match &*self.geometry {
            Geometry::Plain { lcp, q, names, covering_given } => {
                if rules.covering != Covering::default() {
                    return Err(SolveError::CoveringOfPlain(rules.covering));
                }
                let mut lcp = lcp.clone();
                for (entry, number) in lcp.q.iter_mut().zip(q) {
                    *entry = number.value(values);
                }
                solve_plain_judged(
                    &PlainProblem { lcp: Arc::new(lcp), names, covering_given: *covering_given },
                    rules,
                    watch,
                )?
            }
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => {
                self.solve_contact_judged(system, values, rules, brief, watch)?
            }
        };
        if let Geometry::Contact { remarks, .. } = &*self.geometry {
            solved.answer.notes.extend(remarks.iter().cloned());
        }
        solved.answer.notes.extend(scenario.notes.iter().cloned());
        if !scenario.stages.is_empty() {
            solved.answer.notes.push(
                "every load case acts at once with its factor: the load history of the scenario was not followed \
                 (`stages` follows it)"
                    .to_owned(),
            );
        }
        let timings = &mut solved.answer.timings;
        timings.factor = self.factor_seconds;
        timings.condense = self.condense_seconds;
        timings.total = self.seconds + start.elapsed().as_secs_f64();
        Ok(solved)
    }

    /// One run under exactly these rules. A ray is classified; nothing is proved of it yet.
    ///
    /// What is left of p beside the load is nothing only where the state passes its check without it: where it does not,
    /// the run ends in the ray that it is.
    pub(super) fn attempt_contact(
        &self,
        system: &ContactSystem,
        numbers: &ContactNumbers,
        factors: &[f64],
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let contact = contact_lcp(system, numbers, rules.covering)?;
        let solved = self.run_contact(system, numbers, factors, contact.clone(), rules, watch)?;
        if !solved.answer.marginal || solved.answer.check.passed {
            return Ok(solved);
        }
        let mut strict = contact;
        Arc::make_mut(&mut strict.lcp).scale.load = Some(0.0);
        self.run_contact(system, numbers, factors, strict, rules, watch)
    }

    fn run_contact(
        &self,
        system: &ContactSystem,
        numbers: &ContactNumbers,
        factors: &[f64],
        contact: ContactLcp,
        rules: Rules,
        watch: &dyn Watch,
    ) -> Result<Solved, SolveError> {
        let start = Instant::now();
        let rule = contact.tie_rule(rules.tie_break);
        let mut engine = None;
        let mut run = match rules.engine {
            Engine::Scheme => {
                let (run, kept) = keep_scheme(&contact.lcp, rule, watch);
                engine = kept;
                run
            }
            Engine::Tableau => run_tableau(&contact.lcp, rule, watch),
            Engine::Exact => {
                if let Some(refusal) = system.refusal("engine exact") {
                    return Err(SolveError::Value(refusal));
                }
                if system.pairs.len() > EXACT_PAIRS {
                    return Err(SolveError::TooLargeForExact {
                        what: "contact pairs",
                        found: system.pairs.len(),
                        most: EXACT_PAIRS,
                    });
                }
                run_exact_contact(system, numbers, &contact, rules.covering, rule, watch)
            }
        };
        if run.outcome == Outcome::Interrupted {
            return Err(SolveError::Interrupted);
        }
        if matches!(run.outcome, Outcome::Ray(_)) && rules.engine != Engine::Exact {
            let basis = run.pivots.basis();
            let point = std::mem::take(&mut run.point);
            run.point = sharpen(system, numbers, &contact, &basis, point);
        }
        if matches!(run.outcome, Outcome::Normal { .. }) {
            let point = std::mem::take(&mut run.point);
            run.point = refined(system, numbers, &contact, point);
            // An answer stands without the covering: that is how it is checked.
            run.point.p = 0.0;
        }
        let seconds = start.elapsed().as_secs_f64();
        let words = rules.words();
        let mut answer = empty_answer(&run, contact.force_unit, words, self.size(system, &contact));
        answer.timings.lemke = seconds;
        answer.pivots = sentence::pivot_records(run.pivots.recorded(), &contact, system);

        let state = joint_state(system, numbers, &contact, &run.point);
        answer.pairs = pair_states(system, numbers, &contact, &state);
        self.add_released_slips(&mut answer.pairs, numbers, factors, &state.z);
        let mut ray = None;
        if let Outcome::Ray(direction) = &run.outcome {
            let cases = self.named_factors(factors);
            let subject = self.subject(system, numbers, &cases);
            let report = ray::look(&subject, &contact, direction, answer.p);
            answer.ray = Some(report.record(system, rules.covering));
            ray = Some(Box::new(report));
        }
        if answer.is_answer() {
            self.complete(&mut answer, system, numbers, factors, &state);
        }
        let kept = engine
            .filter(|_| answer.is_answer())
            .map(|engine| WarmStart::new(engine, contact.clone(), numbers.clone()))
            .map(|kept| Arc::new(Mutex::new(Some(kept))));
        let refused = answer.outcome == OutcomeKind::CheckFailed;
        let cycled = matches!(run.outcome, Outcome::Cycle(_));
        let trace = Trace::Contact {
            contact,
            numbers: numbers.clone(),
            factors: factors.to_vec(),
            pivots: run.pivots,
            last: run.point,
        };
        let mut solved = Solved { answer, trace, ray, plain_ray: None, cycled, kept, told: String::new() };
        if refused {
            self.prove_after_all(&mut solved, watch);
        }
        Ok(solved)
    }

    /// The state at a point found other than by pivots from z = 0, freshly checked; `words` are covering, tie-break
    /// and engine as the attempt is listed.
    pub(super) fn answer_at(
        &self,
        system: &ContactSystem,
        numbers: &ContactNumbers,
        factors: &[f64],
        contact: ContactLcp,
        point: Point,
        words: [String; 3],
    ) -> Solved {
        let point = refined(system, numbers, &contact, point);
        let state = joint_state(system, numbers, &contact, &point);
        let run = Run { outcome: Outcome::Normal { marginal: false }, pivots: PivotLog::default(), point };
        let mut answer = empty_answer(&run, contact.force_unit, words, self.size(system, &contact));
        answer.pairs = pair_states(system, numbers, &contact, &state);
        self.add_released_slips(&mut answer.pairs, numbers, factors, &state.z);
        self.complete(&mut answer, system, numbers, factors, &state);
        Solved {
            answer,
            trace: Trace::Contact {
                contact,
                numbers: numbers.clone(),
                factors: factors.to_vec(),
                pivots: run.pivots,
                last: run.point,
            },
            ray: None,
            plain_ray: None,
            cycled: false,
            kept: None,
            told: String::new(),
        }
    }

    pub(super) fn size(&self, system: &ContactSystem, contact: &ContactLcp) -> Size {
        let unknowns = match &*self.geometry {
            Geometry::Structure { main, .. } => Some(main.size()),
            _ => None,
        };
        Size {
            unknowns: unknowns.map(|size| size.all),
            free: unknowns.map(|size| size.free),
            pairs: system.pairs.len(),
            lcp: contact.rows.len(),
        }
    }

    /// Internal forces of the bars under the displacements u; `None` without a structure.
    pub(crate) fn members(&self, u: &Displacements, factors: &[f64]) -> Option<Vec<MemberForces>> {
        let Geometry::Structure { main, structure, .. } = &*self.geometry else {
            return None;
        };
        let members = main.member_forces(structure, u, factors).into_iter().map(|member| MemberForces {
            bar: structure.bars[member.bar].id.clone(),
            element: member.element,
            start: end_forces(member.start),
            end: end_forces(member.end),
            pieces: member.pieces,
        });
        Some(members.collect())
    }

    /// Forces of the supports under the displacements u and the joint forces; `None` without a structure.
    pub(crate) fn reactions(&self, u: &Displacements, force: &DVector<f64>, factors: &[f64]) -> Option<Vec<Reaction>> {
        let Geometry::Structure { main, structure, .. } = &*self.geometry else {
            return None;
        };
        let reactions = main.reactions(structure, u, force, factors).into_iter().map(|reaction| Reaction {
            node: structure.nodes[reaction.node].id.clone(),
            fx: reaction.force[0],
            fy: reaction.force[1],
            m: reaction.moment,
        });
        Some(reactions.collect())
    }

    /// Displacements, members, reactions and the fresh check of an answer.
    pub(super) fn complete(
        &self,
        answer: &mut Answer,
        system: &ContactSystem,
        numbers: &ContactNumbers,
        factors: &[f64],
        state: &JointState,
    ) {
        let otherwise = may_hold_otherwise(system, numbers, &state.z);
        let shared: Vec<usize> = state.free.iter().copied().filter(|pair| !otherwise.contains(pair)).collect();
        let kinds = [
            (
                shared,
                "the motion does not depend on how they share what they carry, which is undetermined; shown are the \
                      forces of least norm that obey the laws",
            ),
            (
                otherwise,
                "the forces shown are those of least norm for the motion shown; with friction in these pairs \
                         another self-stress may hold another motion",
            ),
        ];
        for (pairs, words) in kinds.iter().filter(|(pairs, _)| !pairs.is_empty()) {
            let mut ids: Vec<String> = pairs.iter().take(NAMED).map(|&pair| system.pairs[pair].id.clone()).collect();
            if pairs.len() > NAMED {
                ids.push(format!("{} more", pairs.len() - NAMED));
            }
            answer.notes.push(format!("joints of {} repeat one another: {words}", list(&ids)));
        }
        let equilibrium = self.recover(answer, numbers, factors, state);
        judge(answer, check_contact(system, numbers, state, equilibrium));
    }

    /// Displacements, members and reactions of a state; the residual of its equilibrium, where there is a K.
    pub(super) fn recover(
        &self,
        answer: &mut Answer,
        numbers: &ContactNumbers,
        factors: &[f64],
        state: &JointState,
    ) -> Option<f64> {
        let mut equilibrium = None;
        if let Geometry::Structure { main, structure, .. } = &*self.geometry {
            let u = main.displacements(factors, &dislocation(numbers, &state.z));
            let compatibility = main.compatibility_residual(&u, &dislocation(numbers, &state.z));
            equilibrium = Some(compatibility + main.equilibrium_residual(structure, &u, &state.force, factors));
            answer.members = self.members(&u, factors);
            answer.reactions = self.reactions(&u, &state.force, factors);
            answer.displacements = Some(named(structure, &u));
        }
        equilibrium
    }

    /// z_τ of the frictionless pairs, which have no tangential joint: from B u, or from the released joints of a
    /// given contact system.
    pub(crate) fn add_released_slips(
        &self,
        pairs: &mut [PairState],
        numbers: &ContactNumbers,
        factors: &[f64],
        z: &DVector<f64>,
    ) {
        match &*self.geometry {
            Geometry::Structure { main, structure, .. } => {
                if !structure.pairs.iter().any(|pair| matches!(pair.law, Law::Frictionless { .. })) {
                    return;
                }
                let u = main.displacements(factors, &dislocation(numbers, z));
                for (pair, shown) in structure.pairs.iter().zip(pairs) {
                    if matches!(pair.law, Law::Frictionless { .. }) {
                        let t = pair.tangent();
                        // Both components of a displacement are as well known as the larger one.
                        let along = |&(node, weight): &(usize, f64)| {
                            let [x, y] = [u.0[node][0], u.0[node][1]];
                            [weight * (t[0] * x + t[1] * y), weight.abs() * (x.abs() + y.abs())]
                        };
                        let [slip, terms] = pair
                            .tangential_weights()
                            .iter()
                            .map(along)
                            .fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]]);
                        shown.z_t = if slip.abs() <= SLIP_ZERO * terms { 0.0 } else { slip };
                    }
                }
            }
            Geometry::Contact { system, .. } => {
                let Some(file) = &system.file else {
                    return;
                };
                if system.force_form.is_some() {
                    let mut forces = DVector::zeros(system.joint_count());
                    for (i, (pair, shown)) in system.pairs.iter().zip(&*pairs).enumerate() {
                        forces[i] = shown.x_n;
                        pair.tangential.into_iter().for_each(|joint| forces[joint] = shown.x_t);
                    }
                    let slips = file.slips_under(&forces, &file.load(factors));
                    for (&pair, slip) in file.released_pairs.iter().zip(slips.iter()) {
                        pairs[pair].z_t = *slip;
                    }
                    return;
                }
                let moved = dislocation(numbers, z);
                let slips = file.forces(&moved, &moved.abs(), &file.load(factors)).slips;
                for (&pair, slip) in file.released_pairs.iter().zip(slips.iter()) {
                    pairs[pair].z_t = *slip;
                }
            }
            Geometry::Plain { .. } => {}
        }
    }
}

/// The whole mutual displacement of the joints: z with the gaps taken off.
pub(crate) fn dislocation(numbers: &ContactNumbers, z: &DVector<f64>) -> DVector<f64> {
    let mut z = z.clone();
    for (i, gap) in numbers.gap.iter().enumerate() {
        z[i] -= gap;
    }
    z
}

fn end_forces(ends: crate::fem::EndForces) -> EndForces {
    EndForces { n: ends.normal, q: ends.shear, m: ends.moment }
}

fn named(structure: &crate::model::structure::Structure, u: &Displacements) -> Vec<NodeDisplacement> {
    structure
        .nodes
        .iter()
        .zip(&u.0)
        .map(|(node, u)| NodeDisplacement { node: node.id.clone(), ux: u[0], uy: u[1], rz: u[2] })
        .collect()
}

/// Takes the check over, and says what holds open pairs.
pub(super) fn judge(answer: &mut Answer, check: Check) {
    answer.check = check;
    if !answer.check.passed {
        fail_check(answer);
    }
    for pair in &answer.pairs {
        if pair.held.is_some() {
            answer.notes.push(format!(
                "pair {} is open and still held by its cohesion: cohesion acts across the gap in this law",
                pair.id
            ));
        }
    }
}

/// A slip below this multiple of the displacements that it is the difference of is zero.
const SLIP_ZERO: f64 = 16.0 * f64::EPSILON;

pub(super) fn fail_check(answer: &mut Answer) {
    answer.outcome = OutcomeKind::CheckFailed;
    answer.failure = Some(format!(
        "the state found does not pass its check from R, RF and f (min w {:.1e}, min z {:.1e}, complementarity {:.1e}{})",
        answer.check.min_w,
        answer.check.min_z,
        answer.check.complementarity,
        answer.check.equilibrium.map_or(String::new(), |e| format!(", equilibrium {e:.1e}"))
    ));
    if let Some(last) = answer.attempts.last_mut() {
        last.outcome = OutcomeKind::CheckFailed;
    }
}

/// The parts of an answer that follow from the run alone; user's force = dimensionless × `force_unit`.
pub(super) fn empty_answer(run: &Run, force_unit: f64, words: [String; 3], size: Size) -> Answer {
    let outcome = kind(&run.outcome);
    let [covering, tie_break, engine] = words;
    let failure = match &run.outcome {
        Outcome::PivotLimit => Some(format!("the limit of {} pivots was reached.", super::attempt::PIVOT_LIMIT)),
        Outcome::Cycle(Cycle { first, again }) => Some(format!(
            "the tie-break {tie_break} cycles: the basis after pivot {first} came back after pivot {again}, at p = {}.",
            short(run.point.p * force_unit)
        )),
        Outcome::Breakdown(why) => Some(why.clone()),
        _ => None,
    };
    Answer {
        outcome,
        marginal: run.outcome == Outcome::Normal { marginal: true },
        ray: None,
        p: run.point.p * force_unit,
        attempts: vec![Attempt {
            covering: covering.clone(),
            tie_break: tie_break.clone(),
            engine: engine.clone(),
            outcome,
            pivots: Some(run.pivots.count()),
            why: failure.clone().filter(|_| outcome == OutcomeKind::PivotLimit),
        }],
        covering,
        tie_break,
        engine,
        pivots: Vec::new(),
        pivot_count: run.pivots.count(),
        pairs: Vec::new(),
        check: Check::default(),
        displacements: None,
        members: None,
        reactions: None,
        solution: None,
        size,
        timings: Timings::default(),
        start: Start::Cold,
        redone: Redone::default(),
        notes: Vec::new(),
        failure,
    }
}

impl Solved {
    /// Number of pivots.
    pub fn pivot_count(&self) -> usize {
        match &self.trace {
            Trace::Contact { pivots, .. } | Trace::Plain { pivots, .. } => pivots.count(),
        }
    }

    /// p after pivot `step`, in the user's units; `None` beyond the last.
    pub fn p_at(&self, step: usize) -> Option<f64> {
        self.answer.pivots.get(step).map(|pivot| pivot.p)
    }

    /// The vertex after pivot `step` over the joints; `None` beyond the last and for a bare LCP.
    fn state_at(&self, prepared: &Prepared, step: usize) -> Option<JointState> {
        let Trace::Contact { contact, numbers, pivots, last, .. } = &self.trace else {
            return None;
        };
        let system = prepared.system()?;
        let point = if step + 1 == pivots.count() {
            last.clone()
        } else {
            vertex(&contact.lcp, &Basis::after(pivots.recorded().get(..=step)?))?
        };
        Some(joint_state(system, numbers, contact, &point))
    }

    /// The pairs after pivot `step`: the working scheme on the way, under its p.
    pub fn pairs_at(&self, prepared: &Prepared, step: usize) -> Option<Vec<PairState>> {
        let Trace::Contact { contact, numbers, factors, .. } = &self.trace else {
            return None;
        };
        let state = self.state_at(prepared, step)?;
        let mut pairs = pair_states(prepared.system()?, numbers, contact, &state);
        prepared.add_released_slips(&mut pairs, numbers, factors, &state.z);
        Some(pairs)
    }

    /// The displacements after pivot `step`; structures only.
    pub fn displacements_at(&self, prepared: &Prepared, step: usize) -> Option<Vec<NodeDisplacement>> {
        let (Trace::Contact { numbers, factors, .. }, Geometry::Structure { main, structure, .. }) =
            (&self.trace, &*prepared.geometry)
        else {
            return None;
        };
        let state = self.state_at(prepared, step)?;
        Some(named(structure, &main.displacements(factors, &dislocation(numbers, &state.z))))
    }

    /// z and w of a bare LCP after pivot `step`.
    pub fn plain_at(&self, step: usize) -> Option<PlainSolution> {
        let Trace::Plain { lcp, pivots } = &self.trace else {
            return None;
        };
        let point = vertex(lcp, &Basis::after(pivots.recorded().get(..=step)?))?;
        Some(PlainSolution { z: point.z, w: point.w })
    }
}
