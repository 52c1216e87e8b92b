//! A followed history as data.

use std::borrow::Cow;

use super::integrals::Integrals;
use crate::answer::pairs::JointState;
use crate::answer::record::{Answer, InSpace, OutcomeKind, PairState, Ray, State, Verdict};
use crate::answer::rounding::largest;
use crate::path::change::Change;
use crate::path::start::PathError;
use crate::text::number::short;
use crate::text::words::list;

/// The structure at one moment of the history.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Place in its stage, 0 … 1.
    pub t: f64,
    /// Factor of each load case.
    pub factors: Vec<f64>,
    /// The pairs; z_t is the total slip, states are what they did on the way here.
    pub pairs: Vec<PairState>,
    /// The pairs that change their motion here.
    pub changes: Vec<Change>,
    /// The changes in words; empty without any.
    pub sentence: String,
    /// Whether the structure jumped here: no quasi-static way led on.
    pub jump: bool,
    /// What every pair did on the way here, and what held it where it was open.
    pub(in crate::path) way: Vec<(State, Option<State>)>,
    /// Total z and λ over the joints.
    pub(in crate::path) state: JointState,
    /// What belongs to the way here and not to its ends, where it is not a straight line; z is the mean one.
    pub(super) curve: Option<Integrals>,
}

impl Moment {
    /// Whether it is a point of a curved way, at which nothing else happens.
    pub fn is_passed(&self) -> bool {
        self.curve.is_some() && self.changes.is_empty() && !self.jump && self.t > 0.0 && self.t < 1.0
    }
}

/// A stage that was followed.
#[derive(Clone, Debug, PartialEq)]
pub struct StageResult {
    /// Start, events and end; between two of them everything is affine in t.
    pub moments: Vec<Moment>,
    /// Pivots made in all its rate problems.
    pub pivots: usize,
    /// Slip of each pair in this stage.
    pub slip: Vec<f64>,
    /// Work lost in friction, −∫ x_τ dz_τ ≥ 0.
    pub dissipated: f64,
    /// Work of the nodal forces and change of the energy that the nodes store; structures only.
    pub energy: Option<Energy>,
    /// Where nothing moved on joints that repeat one another, from place to place in the stage, though no rates led on: what
    /// these carry there is some self-stress within friction, which nothing determines.
    pub rests: Vec<[f64; 2]>,
    /// What the ends of its legs may be wrong by, as a share of the largest displacement, where directions of slip turn
    /// on the way: the sum of the last corrections. `None` where every way is straight.
    pub estimated_error: Option<f64>,
    /// The state at its end as an answer, where a pair on the limit at which it slipped last is shown as slipping; a
    /// ray, with the state at which it was met, where the history ended in a limit. The last stage's has the attempts
    /// and pivots of the last rate problem, whose forces are rates per whole stage.
    pub end: Answer,
}

impl StageResult {
    /// Factors of the load cases at its end, without a unit.
    pub fn factors(&self) -> &[f64] {
        self.moments.last().map_or(&[], |end| &end.factors)
    }

    /// The largest slip at its end.
    pub fn max_slip(&self) -> f64 {
        largest(self.moments.last().into_iter().flat_map(|end| &end.pairs).map(|pair| pair.z_t))
    }

    /// The largest slip in this stage.
    pub fn max_slip_increment(&self) -> f64 {
        largest(self.slip.iter().copied())
    }

    /// At how many of its moments pairs change their motion.
    pub fn change_count(&self) -> usize {
        self.moments.iter().filter(|moment| !moment.changes.is_empty()).count()
    }

    /// Whether some pair slips against a force.
    pub fn rubs(&self) -> bool {
        let slips = |state: State| matches!(state, State::SlipPlus | State::SlipMinus | State::Slip);
        let pairs = self.moments.iter().flat_map(|moment| moment.pairs.iter().zip(&moment.way));
        let rubs = |pair: &PairState, state, held: Option<State>| {
            pair.bound > 0.0 && (slips(state) || held.is_some_and(slips))
        };
        pairs.into_iter().any(|(pair, &(state, held))| rubs(pair, state, held))
    }

    /// What the pairs do between its moments, in order; stretches of no length are left out.
    pub fn schemes(&self) -> impl Iterator<Item = &[(State, Option<State>)]> {
        self.moments.windows(2).filter(|ends| ends[1].t > ends[0].t).map(|ends| &ends[1].way[..])
    }
}

/// ∫ F·du = ΔU + D of a stage, with the nodal forces F that stand for all loads, heat among them, and the displacements u of
/// the nodes: what loads between nodes do to their elements while the nodes stand still is in neither.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// ∫ F·du.
    pub work: f64,
    /// ΔU, U = ½ uᵀ K u of the nodes.
    pub stored: f64,
    /// |work − stored − dissipated| / the largest energy met in the whole history: a stage that does no work has no
    /// scale of its own.
    pub residual: f64,
}

impl Energy {
    /// What may be left over of the largest energy. Forces pass their check with a thousandth of this beside those that meet
    /// at a node, whose work may be a thousand times what is left of it.
    const BALANCED: f64 = 1e-6;

    /// Whether no more is left over than rounding leaves.
    pub fn is_balanced(&self) -> bool {
        self.residual <= Energy::BALANCED
    }
}

/// How a history ends.
#[derive(Clone, Debug, PartialEq)]
pub enum HistoryEnd {
    /// All stages were followed.
    Complete,
    /// Within a stage the rate problem had no answer, and no other state was there to jump to.
    Limit {
        /// Which stage, from 0.
        stage: usize,
        /// Place in it.
        t: f64,
        /// The collapse.
        collapse: Box<Ray>,
    },
    /// The numbers no longer belonged together in the stage after the last one here.
    Broken(Box<PathError>),
}

/// A followed history.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Names of the load cases.
    pub cases: Vec<String>,
    /// The stages; the last one is incomplete where the history ended in it. One that broke down is not among them.
    pub stages: Vec<StageResult>,
    /// How it ended.
    pub end: HistoryEnd,
}

impl History {
    /// The end of the last stage followed, as an answer.
    pub fn answer(&self) -> Option<&Answer> {
        self.stages.last().map(|stage| &stage.end)
    }

    /// The same as the result of all of the history: no answer where a stage broke down.
    pub fn outcome(&self) -> Option<Cow<'_, Answer>> {
        let end = self.answer()?;
        let HistoryEnd::Broken(error) = &self.end else { return Some(Cow::Borrowed(end)) };
        let failure = Some(error.to_string());
        Some(Cow::Owned(Answer { outcome: OutcomeKind::Breakdown, failure, ..end.clone() }))
    }

    /// Itself unless a stage broke down.
    ///
    /// # Errors
    /// How it did.
    pub fn unbroken(self) -> Result<History, PathError> {
        match self.end {
            HistoryEnd::Broken(error) => Err(*error),
            _ => Ok(self),
        }
    }

    /// Whether a stage, from 0, is here and was followed to its end.
    pub fn has_end_of(&self, stage: usize) -> bool {
        let cut = matches!(self.end, HistoryEnd::Limit { stage: last, .. } if last == stage);
        stage < self.stages.len() && !cut
    }

    /// How the history ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        match &self.end {
            HistoryEnd::Complete => "all stages were followed".to_owned(),
            HistoryEnd::Limit { stage, t, collapse } => {
                format!("stage {} cannot be completed: at {t:.6} of it {}", stage + 1, limit_words(collapse))
            }
            HistoryEnd::Broken(error) => error.to_string(),
        }
    }

    /// Where it rested on joints that repeat one another, and what that says of the forces there; `None` where it did not.
    pub fn rest_sentence(&self) -> Option<String> {
        let of_stage = |(index, stage): (usize, &StageResult)| {
            let places = stage.rests.iter().map(|[from, to]| format!("from {} to {}", short(*from), short(*to)));
            let places: Vec<String> = places.collect();
            (!places.is_empty()).then(|| format!("stage {} {} of it", index + 1, list(&places)))
        };
        let places: Vec<String> = self.stages.iter().enumerate().filter_map(of_stage).collect();
        (!places.is_empty()).then(|| format!("{RESTS} ({})", list(&places)))
    }

    /// The pairs at place t of a stage; z_t is the total slip. `None` beyond the end.
    pub fn pairs_at(&self, stage: usize, t: f64) -> Option<Vec<PairState>> {
        let moments = &self.stages.get(stage)?.moments;
        let ends = moments.windows(2).find(|ends| (ends[0].t..=ends[1].t).contains(&t))?;
        let length = ends[1].t - ends[0].t;
        let s = if length == 0.0 { 1.0 } else { (t - ends[0].t) / length };
        let mix = |a: f64, b: f64| if s == 1.0 { b } else { a + s * (b - a) };
        let mixed = ends[0].pairs.iter().zip(&ends[1].pairs).zip(&ends[1].way).map(|((a, b), &(state, held))| {
            let (state, held) = if s == 1.0 { (b.state, b.held) } else { (state, held) };
            let space = a.space.zip(b.space).map(|(a, b)| InSpace {
                x_t: [0, 1].map(|t| mix(a.x_t[t], b.x_t[t])),
                z_t: [0, 1].map(|t| mix(a.z_t[t], b.z_t[t])),
                ..b
            });
            PairState {
                space,
                state,
                held,
                x_n: mix(a.x_n, b.x_n),
                x_t: mix(a.x_t, b.x_t),
                z_n: mix(a.z_n, b.z_n),
                z_t: mix(a.z_t, b.z_t),
                bound: mix(a.bound, b.bound),
                reserve_plus: mix(a.reserve_plus, b.reserve_plus),
                reserve_minus: mix(a.reserve_minus, b.reserve_minus),
                ..b.clone()
            }
        });
        Some(mixed.collect())
    }
}

/// What is said where a history rests on joints that repeat one another.
pub(in crate::path) const RESTS: &str = "joints that repeat one another stay at rest by forces within friction that their \
                                         motion leaves undetermined; other forces may let go earlier";

/// What ends a history, and how it moves there.
pub(in crate::path) fn limit_words(collapse: &Ray) -> String {
    let proof = match collapse.verdict {
        Some(Verdict::Certified) => "the limit load is reached",
        Some(Verdict::Proved) => "no state leads on, which all working schemes together prove",
        _ => "no rates and no other state lead on, which is not proved to be the limit load",
    };
    format!("{proof} ({})", collapse.mode)
}
