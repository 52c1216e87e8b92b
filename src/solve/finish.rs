//! From a state of the joints to what is reported of it: displacements, members, reactions, and the fresh check.

use nalgebra::DVector;

use super::engines::kind;
use super::prepared::{Geometry, Prepared};
use crate::answer::check::{TOLERANCE, check_contact};
use crate::answer::pairs::{JointState, Shares};
use crate::answer::record::{
    Answer, Attempt, AttemptRules, Check, EndForces, MemberForces, NodeDisplacement, OutcomeKind, PairState, Reaction,
    Size, Start, Timings,
};
use crate::contact::problem::ContactProblem;
use crate::contact::self_stress::may_hold_otherwise;
use crate::contact::sum::{HIDDEN, LAW_ROUNDING};
use crate::contact::system::{ContactPair, ContactSystem};
use crate::contact::written::ContactLcp;
use crate::fem::{Displacements, JointTerms};
use crate::lcp::outcome::{Outcome, Run};
use crate::lcp::pivot::Cycle;
use crate::lcp::problem::NOISE;
use crate::model::structure::{Dimension, Structure};
use crate::model::uses::Redone;
use crate::model::vector::{dot, length};
use crate::text::words::{short, some};

/// A slip below this multiple of the displacements whose difference it is counts as zero.
const SLIP_ZERO: f64 = 16.0 * f64::EPSILON;

impl Prepared {
    /// Displacements, members, reactions and the fresh check of an answer, and the notes on its state. Whatever an
    /// earlier state has left of these is replaced.
    pub(super) fn complete(&self, answer: &mut Answer, problem: &ContactProblem, state: &JointState) {
        answer.notes = notes_on_shared_forces(problem, state);
        answer.notes.extend(note_on_lost_loads(problem, state));
        let equilibrium = self.recover(answer, problem, state, &state.z);
        judge(answer, check_contact(problem, state, equilibrium));
    }

    /// The part of [`Prepared::complete`] that comes first: the fresh check of the joints.
    pub(super) fn complete_joints(&self, answer: &mut Answer, problem: &ContactProblem, state: &JointState) {
        answer.notes = notes_on_shared_forces(problem, state);
        answer.notes.extend(note_on_lost_loads(problem, state));
        judge(answer, Check { joints_only: true, ..check_contact(problem, state, None) });
    }

    /// The part of [`Prepared::complete`] that [`Prepared::complete_joints`] leaves.
    pub(super) fn complete_rest(&self, answer: &mut Answer, problem: &ContactProblem, state: &JointState) {
        let equilibrium = self.recover(answer, problem, state, &state.z);
        answer.check = answer.check.with_equilibrium(equilibrium);
        if !answer.check.passed {
            fail_check(answer);
        }
    }

    /// Displacements, members and reactions of a state; the residual of its equilibrium, where there is a K. z is as good as the
    /// rounding of `met`, the largest numbers it was summed from: z itself where it was found at once.
    pub(super) fn recover(
        &self,
        answer: &mut Answer,
        problem: &ContactProblem,
        state: &JointState,
        met: &DVector<f64>,
    ) -> Option<f64> {
        let mut equilibrium = None;
        if let Geometry::Structure { main, structure, .. } = &*self.geometry {
            let dislocation = problem.dislocation(&state.z);
            let u = main.displacements(&problem.factors, &dislocation);
            let terms = problem.dislocation_sizes(met.abs());
            let compatibility = main.compatibility_residual(&u, &dislocation, &terms);
            let shared = state.shared_terms(&problem.system);
            let terms = JointTerms { dislocations: Some(&terms), shared: shared.as_ref() };
            let residual = main.equilibrium_residual(structure, &u, &terms, &state.force, &problem.factors);
            equilibrium = Some(compatibility + residual);
            answer.members = self.members(&u, &problem.factors);
            answer.reactions = self.reactions(&u, &state.force, &problem.factors);
            let displacements = NodeDisplacement::of_state(main, structure, &u);
            answer.notes.extend(note_on_large_displacements(structure, &displacements));
            answer.displacements = Some(displacements);
        }
        equilibrium
    }

    /// Internal forces of the bars under the displacements u; `None` without a structure.
    pub(crate) fn members(&self, u: &Displacements, factors: &[f64]) -> Option<Vec<MemberForces>> {
        let Geometry::Structure { main, structure, .. } = &*self.geometry else {
            return None;
        };
        let members = main.member_forces(structure, u, factors).into_iter().map(|member| MemberForces {
            bar: structure.bars[member.bar].id.clone(),
            element: member.element,
            start: end_forces(structure.dimension, member.start),
            end: end_forces(structure.dimension, member.end),
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
            m: reaction.moment[2],
            space: (structure.dimension == Dimension::Space).then_some([
                reaction.force[2],
                reaction.moment[0],
                reaction.moment[1],
            ]),
        });
        Some(reactions.collect())
    }

    /// z_τ of the frictionless pairs, which have no tangential joint: from B u, or from the released joints of a
    /// given contact system.
    pub(crate) fn add_released_slips(&self, pairs: &mut [PairState], problem: &ContactProblem, z: &DVector<f64>) {
        match &*self.geometry {
            Geometry::Structure { main, structure, .. } => {
                if !structure.pairs.iter().any(|pair| !pair.law.has_tangential_joint()) {
                    return;
                }
                let u = main.displacements(&problem.factors, &problem.dislocation(z));
                for (pair, shown) in structure.pairs.iter().zip(pairs) {
                    if pair.law.has_tangential_joint() {
                        continue;
                    }
                    let mut slips = pair.tangents.iter().map(|&t| {
                        // All components of a displacement have the absolute error of the largest one.
                        let along = |&(node, weight): &(usize, f64)| {
                            let [x, y, z, ..] = u.0[node];
                            [weight * dot(t, [x, y, z]), weight.abs() * (x.abs() + y.abs() + z.abs())]
                        };
                        let [slip, terms] = pair
                            .tangential_weights()
                            .iter()
                            .map(along)
                            .fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]]);
                        if slip.abs() <= SLIP_ZERO * terms { 0.0 } else { slip }
                    });
                    match &mut shown.space {
                        None => shown.z_t = slips.next().unwrap_or(0.0),
                        Some(space) => {
                            space.z_t.iter_mut().zip(slips).for_each(|(shown, slip)| *shown = slip);
                            shown.z_t = space.z_t[0].hypot(space.z_t[1]);
                        }
                    }
                }
            }
            Geometry::Contact { system, .. } => {
                let file = system.yielding.as_ref().map_or(&system.file, |yielding| &yielding.exact.file);
                let Some(file) = file else {
                    return;
                };
                let load = file.load(&problem.factors);
                let slips = if system.repeats_joints() {
                    let forces = system.over_joints(pairs.iter().map(|shown| (shown.x_n, shown.friction())));
                    file.slips_under(&forces, &load)
                } else {
                    let moved = problem.dislocation(z);
                    file.forces(&moved, &moved.abs(), &load).slips
                };
                let mut slips = file.released_pairs.iter().zip(slips.iter());
                while let Some((&pair, along)) = slips.next() {
                    match &mut pairs[pair].space {
                        None => pairs[pair].z_t = *along,
                        Some(space) => {
                            // The joint along t2 follows that along t1.
                            space.z_t = [*along, slips.next().map_or(0.0, |(_, across)| *across)];
                            pairs[pair].z_t = space.z_t[0].hypot(space.z_t[1]);
                        }
                    }
                }
            }
            Geometry::Plain { .. } => {}
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
}

/// What is said of pairs whose joints repeat one another, so that the motion leaves their forces undetermined.
fn notes_on_shared_forces(problem: &ContactProblem, state: &JointState) -> Vec<String> {
    let otherwise = may_hold_otherwise(problem, &state.z);
    let shared: Vec<usize> = state.free.iter().copied().filter(|pair| !otherwise.contains(pair)).collect();
    let [those, own] = match state.shares {
        Shares::LeastNorm => {
            ["the forces of least norm that obey the laws", "those of least norm for the motion shown"]
        }
        Shares::Compliant => ["those that equal and very small compliances in these joints give"; 2],
        Shares::Any => ["some that obey the laws"; 2],
    };
    let kinds = [
        (
            shared,
            format!(
                "the motion does not depend on how they share what they carry, which is undetermined; shown are {those}"
            ),
        ),
        (
            otherwise,
            format!(
                "the forces shown are {own}; with friction in these pairs another self-stress may hold another motion"
            ),
        ),
    ];
    let note = |(pairs, words): &(Vec<usize>, String)| {
        let ids: Vec<&str> = pairs.iter().map(|&pair| problem.system.pairs[pair].id.as_str()).collect();
        format!("joints of {} repeat one another: {words}", some(&ids))
    };
    kinds.iter().filter(|(pairs, _)| !pairs.is_empty()).map(note).collect()
}

/// What is said of loads that the rounding of what else acts in a joint hides.
fn note_on_lost_loads(problem: &ContactProblem, state: &JointState) -> Option<String> {
    let system = &*problem.system;
    let is_lost = |joint: usize| {
        let (load, terms) = (problem.load[joint].abs(), problem.load_terms[joint]);
        !system.is_forced(joint) && load > NOISE * terms && load <= LAW_ROUNDING * state.sum(joint).magnitude
    };
    let of_pair = |(i, pair): &(usize, &ContactPair)| is_lost(*i) || pair.tangential.clone().any(is_lost);
    let ids: Vec<&str> = system.pairs.iter().enumerate().filter(of_pair).map(|(_, pair)| pair.id.as_str()).collect();
    (!ids.is_empty()).then(|| {
        format!(
            "the load on {} is smaller than the rounding of what else acts there: the answer takes no notice of it",
            some(&ids)
        )
    })
}

/// What is said of displacements larger than the structure itself: equilibrium is written on the structure as it is drawn, so
/// they are no prediction, and most often a slip of units.
fn note_on_large_displacements(structure: &Structure, displacements: &[NodeDisplacement]) -> Option<String> {
    let size = length(structure.extent());
    let largest = displacements.iter().map(NodeDisplacement::length).fold(0.0, f64::max);
    (size > 0.0 && largest > size).then(|| {
        format!(
            "the largest displacement is {} times the size of the structure, and equilibrium is written for small ones: do the \
             units of stiffnesses, loads and expansions fit together?",
            short(largest / size)
        )
    })
}

fn end_forces(dimension: Dimension, [n, q, m, vz, my, t]: [f64; 6]) -> EndForces {
    EndForces { n, q, m, space: (dimension == Dimension::Space).then_some([vz, my, t]) }
}

/// Takes over the check, and says what holds open pairs.
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

/// An answer that is proved by exact data fails only by what the last digit of its displacements hides of the loads.
pub(super) fn excuse_hidden(answer: &mut Answer) {
    let check = answer.check.of_proved_state();
    if answer.outcome == OutcomeKind::CheckFailed && check.passed {
        answer.check = check;
        pass_check(answer);
    }
}

/// Takes back that the check failed.
pub(super) fn pass_check(answer: &mut Answer) {
    answer.outcome = OutcomeKind::Normal;
    answer.failure = None;
    if let Some(last) = answer.attempts.last_mut() {
        last.outcome = OutcomeKind::Normal;
    }
}

pub(super) fn fail_check(answer: &mut Answer) {
    answer.outcome = OutcomeKind::CheckFailed;
    let hidden = match answer.check.hidden {
        hidden if hidden > HIDDEN => format!(
            "; its forces are differences of so much larger ones that rounding hides {hidden:.1e} of the loads: a motion that \
             nothing resists, or stiffnesses too far apart (parts far stiffer than what holds them, a Poisson's ratio next to 0.5)"
        ),
        _ => unbalanced_words(&answer.check),
    };
    answer.failure = Some(format!(
        "the state found does not pass its check from R, RF and f (min w {:.1e}, min z {:.1e}, complementarity {:.1e}{}){hidden}",
        answer.check.min_w,
        answer.check.min_z,
        answer.check.complementarity,
        answer.check.equilibrium.map_or(String::new(), |e| format!(", equilibrium {e:.1e}"))
    ));
    if let Some(last) = answer.attempts.last_mut() {
        last.outcome = OutcomeKind::CheckFailed;
    }
}

/// What is said where the joints obey their laws, and the nodes are not balanced.
fn unbalanced_words(check: &Check) -> String {
    let joints = Check { equilibrium: None, ..*check };
    match check.equilibrium {
        Some(left) if joints.is_within(LAW_ROUNDING) && !joints.joints_only => format!(
            "; the joints obey their laws, but the displacements balance the nodes only to {left:.1e} of the forces there \
             ({TOLERANCE:.0e} is asked for): rounding of large displacements that hardly anything resists, or of stiffnesses \
             too far apart; a further support or spring there, or stiffnesses nearer to each other, may help"
        ),
        _ => String::new(),
    }
}

/// The parts of an answer that follow from the run alone; user's force = dimensionless × `force_unit`.
pub(super) fn empty_answer(run: &Run, force_unit: f64, rules: AttemptRules, size: Size) -> Answer {
    let outcome = kind(&run.outcome);
    let failure = match &run.outcome {
        Outcome::PivotLimit => Some(format!("{} pivots were made, and no end was in sight.", run.pivots.count() - 1)),
        Outcome::Cycle(Cycle { first, again }) => Some(format!(
            "the tie-break {} cycles: the basis after pivot {first} came back after pivot {again}, at p = {}.",
            rules.tie_break,
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
        polygon: None,
        attempts: vec![Attempt {
            pivots: Some(run.pivots.count()),
            why: failure.clone().filter(|_| outcome == OutcomeKind::PivotLimit),
            ..Attempt::new(rules, outcome)
        }],
        rules,
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

#[cfg(test)]
mod tests {
    use super::{Check, unbalanced_words};
    use crate::answer::pairs::joint_state;
    use crate::model::load::load_text;
    use crate::solve::prepare;
    use crate::solve::state::RunData;
    use crate::watch::Quiet;

    #[test]
    fn an_answer_that_is_completed_again_says_everything_once() {
        // R = 1: z_n = 1 opens the pair, x_t = 0.5 stays below its cohesion of 2.
        let text = r#"{ "format": "stickslip/1", "title": "held", "contact_system": {
            "pairs": ["c1"], "friction": [0.5], "cohesion": [2], "stiffness": [[1, 0], [0, 1]],
            "loads": { "w": { "vector": [-1, 0.5] } } } }"#;
        let scenario = load_text("held", text, None).expect("read");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let mut solved = prepared.case(&scenario, &scenario.parameter_values()).solve().expect("solved");
        let said = solved.answer.notes.clone();
        assert_eq!(said.iter().filter(|note| note.contains("still held by its cohesion")).count(), 1, "{said:?}");
        let RunData::Contact { contact, problem, last, .. } = &solved.run else { panic!("no contact") };
        prepared.complete(&mut solved.answer, problem, &joint_state(problem, contact, last));
        assert_eq!(solved.answer.notes, said);
    }

    /// Only where the joints pass by themselves it is the balance alone that fails.
    #[test]
    fn a_balance_that_fails_alone_is_said() {
        let unbalanced = Check { equilibrium: Some(2e-9), ..Check::default() };
        let words = unbalanced_words(&unbalanced);
        assert!(words.contains("only to 2.0e-9 of the forces there (1e-9 is asked for)"), "{words}");
        for other in [Check { equilibrium: None, ..unbalanced }, Check { min_w: -1e-3, ..unbalanced }] {
            assert_eq!(unbalanced_words(&other), "");
        }
    }
}
