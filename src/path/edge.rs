//! The least or the most of a parameter under which there is an answer: a bracket with a checked answer on one side and
//! a proved collapse on the other.

use super::end::PathEnd;
use super::friction::is_friction;
use super::start::PathError;
use super::way::Way;
use crate::answer::record::{OutcomeKind, RayClass, Verdict};
use crate::model::pair::Law;
use crate::model::parameter::Number;
use crate::model::uses::Redone;
use crate::solve::Case;

/// Values looked at before the search between two of them.
const CELLS: usize = 32;
/// The bracket is narrowed to this share of its place: nearer to the edge proofs fail for want of margin, and every
/// other way to an answer would be tried in vain.
const NARROW: f64 = 1e-8;
/// A bracket of no more than this share of its place is a limit: closer to it than this answers are found and
/// collapses are certified on the cone, whatever the angle.
pub(super) const CLOSE: f64 = 1e-5;
/// A proof beyond the bracket is brought nearer to where proofs begin, up to this share of its place.
const NEARER: f64 = 1e-4;
/// Where in the bracket a proof is looked for next, where it failed at the place before.
const SHARES: [f64; 2] = [0.5, 0.25];

/// Which end of the values with an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The least.
    Least,
    /// The most.
    Most,
}

/// What a run at one value showed.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Run {
    /// The value.
    pub value: f64,
    /// How the run ended.
    pub outcome: OutcomeKind,
    /// Class of its ray.
    pub class: Option<RayClass>,
    /// What is proved of it.
    pub verdict: Option<Verdict>,
    /// Whether it ended in an answer; in space the polygon's own answer does not count.
    #[serde(skip)]
    stands: bool,
}

/// How an answer is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// In space by the first polygon alone.
    First,
    /// In every way there is.
    All,
}

impl Run {
    /// What a case solved at a value showed.
    pub(super) fn of(value: f64, case: Case<'_>, effort: Effort) -> Result<Run, PathError> {
        let solved = match effort {
            Effort::First => case.solve_at_first(),
            Effort::All => case.solve_pairs(),
        }?;
        let ray = solved.ray.as_ref();
        let (class, verdict) = (ray.map(|ray| ray.class), ray.and_then(|ray| ray.verdict));
        Ok(Run { value, outcome: solved.answer.outcome, class, verdict, stands: solved.stands(case.rules.cone) })
    }

    pub(super) fn is_answer(&self) -> bool {
        self.stands
    }

    /// Whether the polygon has an answer from which none on the cone was found.
    pub fn is_polygon_only(&self) -> bool {
        self.outcome.is_answer() && !self.stands
    }

    /// Whether it is proved that there is no answer.
    pub fn is_proved(&self) -> bool {
        self.verdict.is_some_and(Verdict::is_proof)
    }
}

/// What was found.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Edge {
    /// The value: exact where `exact`, else that of the answer.
    pub value: f64,
    /// Whether the exact path from the answer ends there.
    pub exact: bool,
    /// The run with an answer; freshly checked, as every answer is.
    pub answer: Run,
    /// The nearest run that found none, where what is proved begins farther away.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<Run>,
    /// The run without one nearest to it, one with a proof where there is one; `None` where the end of the range has an
    /// answer.
    pub collapse: Option<Run>,
    /// Whether the proof holds for all values beyond: less friction bears no more.
    pub beyond: bool,
}

/// Finds it within a range.
///
/// # Errors
/// No answer anywhere in the range; see [`PathError`].
pub fn edge(case: Case<'_>, name: &str, range: [f64; 2], which: Which) -> Result<Edge, PathError> {
    let run =
        |value: f64, effort| -> Result<Run, PathError> { Run::of(value, case.at(name, value)?.case(case), effort) };
    let [from, to] = if which == Which::Least { range } else { [range[1], range[0]] };
    let mut before: Vec<Run> = Vec::new();
    let mut answer = None;
    for k in 0..=CELLS {
        let share = k as f64 / CELLS as f64;
        case.watch.progress(&format!("{name} = {}", from + share * (to - from)), share);
        let next = run(if k == CELLS { to } else { from + share * (to - from) }, Effort::All)?;
        if next.is_answer() {
            answer = Some(next);
            break;
        }
        before.push(next);
    }
    let Some(answer) = answer else {
        return Err(PathError::Missing(format!(
            "no answer was found at any of {} values of {name} from {} to {}",
            CELLS + 1,
            range[0],
            range[1]
        )));
    };
    let Some(mut collapse) = before.pop() else {
        return Ok(Edge { value: answer.value, exact: false, answer, undecided: None, collapse: None, beyond: false });
    };
    // The proof nearest to the answer stands for the other side.
    while !collapse.is_proved() {
        let Some(farther) = before.pop() else { break };
        collapse = farther;
    }
    let in_space = case.prepared.is_in_space();
    let mut bracket = narrowed(&run, answer, collapse, in_space)?;
    let mut exact = end_of_path(case, name, &bracket)?;
    if exact.is_none() && !in_space && is_wide([&bracket.answer, bracket.collapse()], CLOSE) {
        // No path tells where the answers end: runs do.
        let Bracket { answer, none, proof } = bracket;
        bracket = narrowed_by(&|value| run(value, Effort::All), answer, proof.unwrap_or(none), true)?;
        exact = end_of_path(case, name, &bracket)?;
    }
    let Bracket { answer, none, proof } = bracket;
    let (collapse, undecided) = match proof {
        Some(proof) => (proof, Some(none)),
        None => (none, None),
    };
    Ok(Edge {
        value: exact.unwrap_or(answer.value),
        exact: exact.is_some(),
        // A motion that certifies the collapse does so under less friction too; a search through the schemes holds only there.
        beyond: which == Which::Least && collapse.verdict == Some(Verdict::Certified) && is_friction_alone(case, name),
        answer,
        undecided,
        collapse: Some(collapse),
    })
}

/// The end of the values with an answer, as runs of their own show it.
pub(super) struct Bracket {
    /// The last run with an answer.
    pub(super) answer: Run,
    /// The run without one nearest to it: proved, or none is nearer to the answer that is.
    pub(super) none: Run,
    /// The nearest run with a proof that there is no answer, where it lies beyond `none`.
    pub(super) proof: Option<Run>,
}

impl Bracket {
    /// The run without an answer that stands for the other side.
    fn collapse(&self) -> &Run {
        self.proof.as_ref().unwrap_or(&self.none)
    }
}

/// Whether two runs are farther from one another than this share of their place.
fn is_wide([inner, outer]: [&Run; 2], share: f64) -> bool {
    (inner.value - outer.value).abs() > share * inner.value.abs().max(outer.value.abs())
}

/// The answer and the runs without one nearest to each other that further runs between them show. In space the first polygons
/// lead there; what they leave open is looked for in every way at the place they end at.
pub(super) fn narrowed(
    run: &dyn Fn(f64, Effort) -> Result<Run, PathError>,
    answer: Run,
    collapse: Run,
    in_space: bool,
) -> Result<Bracket, PathError> {
    let thoroughly = |answer, collapse| narrowed_by(&|value| run(value, Effort::All), answer, collapse, in_space);
    if !in_space {
        return thoroughly(answer, collapse);
    }
    let bracket = narrowed_by(&|value| run(value, Effort::First), answer, collapse.clone(), true)?;
    if bracket.none.is_proved() {
        return Ok(bracket);
    }
    let none = run(bracket.none.value, Effort::All)?;
    if none.is_answer() { thoroughly(none, collapse) } else { Ok(Bracket { none, ..bracket }) }
}

/// In one way. With `past_undecided` on to where the answers end, where runs are left open farther out than that.
fn narrowed_by(
    run: &dyn Fn(f64) -> Result<Run, PathError>,
    mut answer: Run,
    mut collapse: Run,
    past_undecided: bool,
) -> Result<Bracket, PathError> {
    let mut undecided: Vec<Run> = Vec::new();
    while is_wide([&answer, &collapse], NARROW) {
        // Where a proof fails close to the edge, nearer to it there may still be one.
        let share = SHARES[undecided.len()];
        let middle = collapse.value + share * (answer.value - collapse.value);
        if middle == answer.value || middle == collapse.value {
            break;
        }
        let next = run(middle)?;
        if next.is_answer() {
            (answer, undecided) = (next, Vec::new());
        } else if next.is_proved() || !collapse.is_proved() {
            (collapse, undecided) = (next, Vec::new());
        } else {
            undecided.push(next);
            if undecided.len() == SHARES.len() {
                break;
            }
        }
    }
    // Loads that forces within the friction bounds balance, and that the law of slip does not carry, may reach far from
    // the answers to what is proved to be too large: there the answers end before the proofs begin.
    let nearest = undecided.into_iter().next();
    let Some(none) = nearest.filter(|none| past_undecided && is_wide([&answer, none], CLOSE)) else {
        return Ok(Bracket { answer, none: collapse, proof: None });
    };
    let mut bracket = Bracket { answer, none, proof: Some(collapse) };
    while is_wide([&bracket.answer, &bracket.none], NARROW) {
        let middle = 0.5 * (bracket.answer.value + bracket.none.value);
        if middle == bracket.answer.value || middle == bracket.none.value {
            break;
        }
        let next = run(middle)?;
        if next.is_answer() {
            bracket.answer = next;
            continue;
        }
        let farther = std::mem::replace(&mut bracket.none, next);
        if bracket.none.is_proved() {
            bracket.proof = None;
        } else if farther.is_proved() {
            bracket.proof = Some(farther);
        }
    }
    with_nearer_proof(run, bracket)
}

/// The same with its proof brought nearer: what is proved begins somewhere between it and the run before.
fn with_nearer_proof(run: &dyn Fn(f64) -> Result<Run, PathError>, mut bracket: Bracket) -> Result<Bracket, PathError> {
    let mut open = bracket.none.value;
    while let Some(proof) = &bracket.proof {
        let middle = 0.5 * (open + proof.value);
        if (proof.value - open).abs() <= NEARER * proof.value.abs() || middle == open || middle == proof.value {
            break;
        }
        let next = run(middle)?;
        if next.is_proved() { bracket.proof = Some(next) } else { open = middle }
    }
    Ok(bracket)
}

/// Where the exact path from the answer towards the collapse ends, between the two or within their rounding.
fn end_of_path(case: Case<'_>, name: &str, bracket: &Bracket) -> Result<Option<f64>, PathError> {
    let (answer, collapse) = (&bracket.answer, bracket.collapse());
    let there = case.at(name, answer.value)?;
    let here = there.case(case);
    let solved = here.solve_pairs()?;
    let target = collapse.value + (collapse.value - answer.value);
    let target = if is_friction(here, name) { target.max(0.0) } else { target };
    let end = Way::follow(here, &solved, name, target).map(|way| match &way {
        Way::Friction(path) => path.schemes.last().map(|last| last.to).filter(|_| path.end == PathEnd::NoAnswer),
        Way::Load(path) if !path.from_zero => path.limit(),
        // Narrowed as the bracket is.
        Way::Load(_) | Way::OnCone(_) => None,
    });
    let room = 2.0 * (answer.value - collapse.value).abs();
    match end {
        Ok(end) => Ok(end.filter(|end| (end - answer.value).abs() <= room && (end - collapse.value).abs() <= room)),
        Err(PathError::Interrupted) => Err(PathError::Interrupted),
        // No path leads over it.
        Err(_) => Ok(None),
    }
}

/// Whether the parameter is a friction coefficient as it stands, and nothing else: then less of it bears no more.
fn is_friction_alone(case: Case<'_>, name: &str) -> bool {
    let Some(system) = case.prepared.system() else { return false };
    let mut moved = case.values.clone();
    moved.insert(name.to_owned(), case.values.get(name).copied().unwrap_or_default() + 1.0);
    let elsewhere = case.scenario.uses.between(case.values, &moved) > Redone::Lcp
        || case.prepared.cases.iter().any(|(_, factor)| factor.names().contains(&name));
    let law = |law: &Law| {
        law.numbers().into_iter().all(|(key, number)| match number {
            Number::Value(_) => true,
            Number::Parameter(parameter) => parameter != name || key == "friction",
            // A formula may turn it round.
            Number::Expression(_) => false,
        })
    };
    !elsewhere && case.values.formulas().iter().next().is_none() && system.pairs.iter().all(|pair| law(&pair.law))
}
