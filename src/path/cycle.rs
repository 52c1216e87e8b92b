//! A load that goes to and fro: does the structure shake down, slip to and fro, or creep further with every cycle?
//!
//! The history is followed by the rate problem ([`super::stages`]). The rates depend on the forces and on the gaps that are
//! open, not on the slips committed before: where both come back after a cycle, every further cycle is the same.

use super::exact_cycle::{self, Repetition};
use super::load_parameter::factors_at;
use super::stages::{Begin, History, HistoryEnd, RESTS, StageResult};
use super::start::PathError;
use super::static_shakedown::{Static, static_shakedown};
use super::to_and_fro::ToAndFro;
use super::widening::{Alike, stays_open};
use crate::answer::record::{PairState, Ray, Verdict};
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::lcp::problem::NOISE;
use crate::solve::case::Case;
use crate::solve::problem::contact_problem;
use crate::text::number::short;

/// Two states are one where they differ by less than this share of the largest of their kind.
const SAME: f64 = 1e-12;
/// In space, where the way is followed to some 1e-10.
const SAME_IN_SPACE: f64 = 1e-8;
/// What two cycles leave behind is the same where it differs by less than this share of it.
const SAME_NET: f64 = 1e-6;
/// Cycles after which they are judged first; then after twice as many, and so on.
const FIRST: usize = 4;
/// Cycles followed at most, where nothing else is said.
pub const MOST: usize = 256;

/// What repeated loading comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Nothing is lost to friction any more: no pair that is pressed slips.
    ShakesDown,
    /// The same slips to and fro in every cycle.
    Alternates,
    /// The same further way in every cycle.
    Ratchets,
    /// A limit is met on the way, and proved.
    Collapses,
    /// Not told apart within the cycles followed, or as far as these lead on.
    Undecided,
}

/// Largest ratio of the forces of starting slips to those of the loads: beyond it, 10⁹ ε of the loads are rounding.
const MOST_FORCE: f64 = 1e9;

/// A slip of a pair.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct PairSlip {
    /// Pair id.
    pub pair: String,
    /// z_τ; in space its length.
    pub slip: f64,
    /// In space along t1 and t2.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_t: Option<[f64; 2]>,
}

/// One pair over one cycle.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct PairCycle {
    /// Pair id.
    pub pair: String,
    /// Slip on the way there.
    pub there: f64,
    /// Slip on the way back.
    pub back: f64,
    /// What is left of both: the way per cycle.
    pub net: f64,
    /// Total slip at its end.
    pub total: f64,
}

/// One cycle.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Turn {
    /// Work lost in friction on the way there and back.
    pub dissipated: [f64; 2],
    /// The pairs.
    pub pairs: Vec<PairCycle>,
    /// The largest difference of a contact force or gap from the cycle before, as a share of the largest of its kind;
    /// `None` for the first.
    pub difference: Option<f64>,
    /// By how much the gap of a pair that stays open has grown most, where that difference leaves it out: no force feels it.
    pub gap_growth: f64,
    /// Whether such gaps close within a cycle, event by event as in the two cycles before.
    #[serde(skip)]
    pub gaps_close: bool,
    /// Working schemes passed on the way there and back.
    pub schemes: usize,
    /// Whether the next cycle passes the same in the same order; `None` where none was followed.
    pub repeated: Option<bool>,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// The load case or parameter.
    pub name: String,
    /// Its values at both ends.
    pub ends: [f64; 2],
    /// What it comes to.
    pub kind: Kind,
    /// The cycles up to the first that repeats.
    pub turns: Vec<Turn>,
    /// The history behind them, the way from the unloaded structure to the first end included.
    pub history: History,
    /// The proof, or what is missing, in a sentence.
    pub sentence: String,
    /// What is proved of its repetition, in rationals.
    pub repetition: Repetition,
    /// What the static theorem says of every start.
    pub every_start: Static,
}

impl Cycle {
    /// The slips with which it begins at the first value.
    pub fn start(&self) -> Vec<PairSlip> {
        let pairs = self.history.stages.first().map_or(&[][..], |stage| &stage.end.pairs);
        let slip = |pair: &PairState| PairSlip {
            pair: pair.id.clone(),
            slip: pair.z_t,
            z_t: pair.space.map(|space| space.z_t),
        };
        pairs.iter().map(slip).collect()
    }

    /// The collapse on the way, where there is one.
    pub fn collapse(&self) -> Option<&Ray> {
        match (&self.history.end, self.kind) {
            (HistoryEnd::Limit { collapse, .. }, Kind::Collapses) => Some(collapse),
            _ => None,
        }
    }
}

/// Refuses slips whose forces would leave no digits of those of the loads.
fn within_reason(problem: &ContactProblem, slips: &[[f64; 2]]) -> Result<(), PathError> {
    let (system, loads) = (&problem.system, problem.load_terms.amax());
    let slips = std::iter::zip(&system.pairs, slips);
    for (pair, joint, slip) in
        slips.flat_map(|(pair, slip)| pair.tangential.clone().zip(slip).map(move |(j, s)| (pair, j, s)))
    {
        let force = system.stiffness.column(joint).amax() * slip.abs();
        if !force.is_finite() || (loads > 0.0 && force > MOST_FORCE * loads) {
            return Err(PathError::Missing(format!(
                "cycle: a slip of {} at {} is too far: the forces it causes would drown those of the loads in rounding",
                short(*slip),
                pair.id
            )));
        }
    }
    Ok(())
}

/// What differences and rounding of a history are judged against.
#[derive(Clone, Copy)]
struct Sizes {
    /// The largest contact force.
    force: f64,
    /// The largest Σ |terms| of a contact force: it is known to a few ε of that.
    terms: f64,
    /// The largest slip in half a cycle.
    slip: f64,
    /// The same, or what such terms move the softest joint by.
    way: f64,
    /// The largest gap, or way.
    gap: f64,
    /// Two states are one where they differ by less than this share.
    same: f64,
}

impl Sizes {
    fn of(stages: &[StageResult], (softest, same): (f64, f64)) -> Sizes {
        let moments = || stages.iter().flat_map(|stage| &stage.moments);
        let largest = |of: &dyn Fn(&PairState) -> f64| {
            moments().flat_map(|moment| &moment.pairs).map(|pair| of(pair).abs()).fold(0.0, f64::max)
        };
        let force = largest(&|pair| pair.x_n.abs().max(pair.x_t.abs()));
        let terms = moments().map(|moment| moment.state.terms.amax()).fold(force, f64::max);
        let slip = stages.iter().flat_map(|stage| &stage.slip).fold(0.0, |a: f64, slip| a.max(slip.abs()));
        let way = slip.max(terms * softest);
        Sizes { force, terms, slip, way, gap: largest(&|pair| pair.z_n).max(way), same }
    }

    /// A difference of forces as a share of the largest; 0 where it is rounding.
    fn force_share(&self, off: f64) -> f64 {
        if off <= NOISE * self.terms { 0.0 } else { off / self.force }
    }

    fn gap_share(&self, off: f64) -> f64 {
        if off <= NOISE * self.gap { 0.0 } else { off / self.gap }
    }

    /// Whether a loss ∫ x dz is none: a small share of what the largest force loses on the largest slip, or the rounding
    /// of x on that slip and of z under that force.
    fn is_lossless(&self, lost: f64) -> bool {
        lost <= self.same * self.force * self.slip + NOISE * (self.terms * self.slip + self.force * self.way)
    }

    /// A way without what is rounding of it.
    fn moved(&self, way: f64) -> f64 {
        if way.abs() <= self.same * self.way { 0.0 } else { way }
    }
}

/// Follows a load from the first value to the second and back, until a cycle repeats: the other loads stand at their
/// present factors. It begins at the unloaded structure, or at the first value with slips left behind.
///
/// # Errors
/// A name that is not a load, a bare LCP, slips that cannot be, a history that breaks down; see [`PathError`].
pub fn cycle(case: Case<'_>, name: &str, ends: [f64; 2], most: usize, begin: &Begin) -> Result<Cycle, PathError> {
    let found = followed(case, name, ends, most, begin)?;
    let every_start = match found.kind {
        Kind::ShakesDown | Kind::Undecided => {
            let places = found.history.stages.iter().skip(1).take(2).flat_map(|stage| &stage.moments);
            static_shakedown(case, places)
        }
        _ => Static::NotAsked,
    };
    let repetition = repetition(case, &found)?;
    Ok(Cycle { every_start, repetition, ..found })
}

/// What can be proved in rationals of the cycle that repeats.
fn repetition(case: Case<'_>, found: &Cycle) -> Result<Repetition, PathError> {
    let stages = &found.history.stages;
    let last = 2 * found.turns.len();
    let (Kind::ShakesDown | Kind::Alternates | Kind::Ratchets, Some([before, there, back])) =
        (found.kind, stages.get(last.wrapping_sub(2)..=last))
    else {
        return Ok(Repetition::NotAsked);
    };
    let system = case.prepared.system().ok_or(PathError::Plain("cycle"))?;
    if system.is_in_space() {
        let why = "on Coulomb's cone nothing is linear between two events";
        return Ok(Repetition::Unproved(why.to_owned()));
    }
    let at = |end: f64| -> Result<ContactProblem, PathError> {
        Ok(contact_problem(system, &factors_at(case, &found.name, end)?, case.values).without_load_noise())
    };
    let problems = [at(found.ends[0])?, at(found.ends[1])?];
    Ok(exact_cycle::prove(&problems, before, [there, back], case.watch))
}

/// As [`cycle`], without asking the static theorem.
pub(super) fn followed(
    case: Case<'_>,
    name: &str,
    ends: [f64; 2],
    most: usize,
    begin: &Begin,
) -> Result<Cycle, PathError> {
    let system = case.prepared.system().ok_or(PathError::Plain("cycle"))?;
    let [a, b] = ends;
    let (softest, same) = (softest(system), if system.is_in_space() { SAME_IN_SPACE } else { SAME });
    let (start, turned) = (factors_at(case, name, a)?, factors_at(case, name, b)?);
    if let Begin::Slips(slips) = begin {
        within_reason(&contact_problem(system, &start, case.values), slips)?;
    }
    let mut targets = vec![start.clone()];
    (0..most).for_each(|_| targets.extend([turned.clone(), start.clone()]));
    let mut count = FIRST;
    let mut decided = |stages: &[StageResult]| {
        if stages.len() != 1 + 2 * count {
            return false;
        }
        count *= 2;
        judged(stages, true, (softest, same)).0 != Kind::Undecided
    };
    let load = ToAndFro { name, ends };
    let history = load.follow(case, begin, &targets, &mut decided)?;
    let (mut kind, turns) = judged(&history.stages, history.end == HistoryEnd::Complete, (softest, same));
    let is_proof = |collapse: &Ray| collapse.verdict.is_some_and(Verdict::is_proof);
    if kind == Kind::Undecided && matches!(&history.end, HistoryEnd::Limit { collapse, .. } if is_proof(collapse)) {
        kind = Kind::Collapses;
    }
    let mut sentence = said(kind, &turns, &history, same, load);
    if history.stages.iter().any(|stage| !stage.rests.is_empty()) {
        sentence.push_str(&format!("; {RESTS}"));
    }
    Ok(Cycle {
        name: name.to_owned(),
        ends,
        kind,
        turns,
        history,
        sentence,
        repetition: Repetition::NotAsked,
        every_start: Static::NotAsked,
    })
}

/// The largest displacement of a tangential joint under a unit force, the others held.
fn softest(system: &ContactSystem) -> f64 {
    let joints = system.pairs.iter().flat_map(|pair| pair.tangential.clone());
    let stiffness = joints.map(|joint| system.stiffness[(joint, joint)]).filter(|stiffness| *stiffness > 0.0);
    stiffness.map(f64::recip).fold(0.0, f64::max)
}

/// How far two vectors along t1 and t2 are apart.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// What the cycles of a history come to, and those up to the first that repeats; the last stage of one that is not
/// `complete` ends in a limit.
fn judged(stages: &[StageResult], complete: bool, (softest, same): (f64, f64)) -> (Kind, Vec<Turn>) {
    let end = |stage: usize| &stages[stage].end.pairs;
    let sizes = Sizes::of(stages, (softest, same));
    let cycles = (stages.len() - usize::from(!complete)).saturating_sub(1) / 2;
    let mut turns: Vec<Turn> = Vec::new();
    let mut kind = Kind::Undecided;
    for number in 0..cycles {
        let (there, back) = (2 * number + 1, 2 * number + 2);
        let halves: [&StageResult; 2] = [&stages[there], &stages[back]];
        let pairs = end(back).iter().enumerate().map(|(index, pair)| {
            let [there, back] = halves.map(|half| sizes.moved(half.slip[index]));
            let net = match (pair.space, end(2 * number)[index].space) {
                (Some(now), Some(before)) => apart(now.z_t, before.z_t),
                _ => there + back,
            };
            PairCycle { pair: pair.id.clone(), there, back, net: sizes.moved(net), total: pair.z_t }
        });
        let pairs: Vec<PairCycle> = pairs.collect();
        let net = pairs.iter().fold(0.0, |a: f64, pair| a.max(pair.net.abs()));
        // Where slips go on, gaps that never close may grow with them: the next cycle, farther open, does not feel it.
        let stays: Vec<bool> = (0..pairs.len()).map(|pair| net > 0.0 && stays_open(halves, pair)).collect();
        // So it is with gaps that close in between where three cycles go alike event by event.
        let alike = net > 0.0 && number > 1 && {
            let cycle = |back: usize| [&stages[there - 2 * back], &stages[there - 2 * back + 1]];
            let (force, length) = (|off| sizes.force_share(off) <= same, |off| sizes.gap_share(off) <= same);
            Alike { force: &force, length: &length, place: same }.only_widens([cycle(0), cycle(1), cycle(2)])
        };
        let gaps_close = std::cell::Cell::new(false);
        let gap_growth = std::cell::Cell::new(0.0);
        let off = |now: usize, before: usize| {
            end(now).iter().zip(end(before)).zip(&stays).fold(0.0, |largest: f64, ((a, b), stays)| {
                let friction = match (a.space, b.space) {
                    (Some(a), Some(b)) => apart(a.x_t, b.x_t),
                    _ => (a.x_t - b.x_t).abs(),
                };
                let forces = sizes.force_share((a.x_n - b.x_n).abs().max(friction));
                let gap = sizes.gap_share((a.z_n - b.z_n).abs());
                if (*stays || alike) && a.z_n > b.z_n && gap > same {
                    gaps_close.set(gaps_close.get() || !stays);
                    gap_growth.set(f64::max(gap_growth.get(), a.z_n - b.z_n));
                    return largest.max(forces);
                }
                largest.max(forces).max(gap)
            })
        };
        // The place before the first cycle is the end of the way there from the unloaded structure.
        let closed = off(back, back - 2);
        let difference = (number > 0).then(|| closed.max(off(there, there - 2)));
        let lost = halves.map(|half| half.dissipated);
        // What moves to and fro without loss is open, or on a bound of 0.
        let lossless = lost.iter().all(|lost| sizes.is_lossless(*lost));
        let lost = if lossless { [0.0; 2] } else { lost };
        let schemes = |first: usize| stages[first..].iter().take(2).flat_map(StageResult::schemes);
        // In space places passed on the way are among them.
        let in_space = end(back).iter().any(|pair| pair.space.is_some());
        let repeated = (number + 1 < cycles && !in_space).then(|| schemes(there).eq(schemes(there + 2)));
        let before = turns.last().and_then(|turn: &Turn| turn.difference);
        let (gap_growth, gaps_close, schemes) = (gap_growth.get(), gaps_close.get(), schemes(there).count());
        turns.push(Turn { dissipated: lost, pairs, difference, gap_growth, gaps_close, schemes, repeated });
        // A cycle that only comes near to the one before is followed by others that come nearer: how far in all?
        let tail = difference.zip(before).map_or(0.0, |(now, before)| tail(now, before));
        if closed > same || tail > same {
            continue;
        }
        // What is left behind may be the tail of a convergence: it ratchets only where the next cycle leaves the same.
        let before = turns.len().checked_sub(2).map(|before| &turns[before].pairs);
        let repeats = before.is_some_and(|before| {
            let now = turns[turns.len() - 1].pairs.iter();
            now.zip(before).all(|(now, before)| (now.net - before.net).abs() <= SAME_NET * net)
        });
        kind = match () {
            () if lossless && net == 0.0 => Kind::ShakesDown,
            () if net == 0.0 => Kind::Alternates,
            () if repeats => Kind::Ratchets,
            () => continue,
        };
        break;
    }
    (kind, turns)
}

fn said(kind: Kind, turns: &[Turn], history: &History, same: f64, load: ToAndFro<'_>) -> String {
    let count = turns.len();
    match kind {
        Kind::ShakesDown => {
            let hidden = history.stages.iter().skip(2 * count - 1).take(2).any(StageResult::rubs);
            let slips = match same {
                SAME if hidden => "what slips under a force loses no more than rounding can make up".to_owned(),
                SAME => "nothing slips under a force".to_owned(),
                _ => format!("what slips under a force loses less than {same:e} of what its largest could on its way"),
            };
            format!("{slips} in cycle {count}: it is elastic, and so is every further one, the same")
        }
        Kind::Alternates => format!("the slips of cycle {count} go to and fro; {}", recurrence(turns, same)),
        Kind::Ratchets => {
            let grown = turns.last().filter(|turn| turn.gap_growth > 0.0).map_or(String::new(), |turn| {
                let [stay, open] =
                    if turn.gaps_close { ["", " while they are open"] } else { [" that stay open all the time", ""] };
                format!(", and gaps{stay} wider by up to {}{open}, which no force feels", short(turn.gap_growth))
            });
            format!("cycle {count} leaves slips behind{grown}; {}", recurrence(turns, same))
        }
        Kind::Collapses => load.end_sentence(history),
        Kind::Undecided if matches!(history.end, HistoryEnd::Limit { .. }) => load.end_sentence(history),
        Kind::Undecided => unrepeated(turns, same),
    }
}

/// How far the last cycle is from repeating: what it differs by from the one before, and, where that falls, what is left to come.
fn unrepeated(turns: &[Turn], same: f64) -> String {
    let count = turns.len();
    let difference = |back: usize| count.checked_sub(back).and_then(|index| turns[index].difference);
    let Some(last) = difference(1) else { return format!("no cycle of {count} repeats to {same:e}") };
    let before = count.checked_sub(2).map(|index| &turns[index]);
    if let Some(before) =
        before.filter(|turn| last.max(turn.difference.map_or(0.0, |before| tail(last, before))) <= same)
        && let Some((now, then)) = least_repeated(&turns[count - 1], before)
    {
        return format!(
            "forces and gaps of cycle {count} are those of the one before to {same:e}, but not what it leaves behind: {} slips on by \
             {} after {} in that one",
            now.pair,
            short(now.net),
            short(then.net)
        );
    }
    let differs = format!("cycle {count} differs from the one before by {last:.1e} of the largest force or gap");
    let Some(before) = difference(2).filter(|before| last < *before) else {
        return format!("no cycle of {count} is found to repeat to {same:e}; {differs}");
    };
    format!(
        "no cycle of {count} is found to repeat to {same:e} together with all that would follow it; {differs}, {:.3} times the \
         difference of the cycle before: if that goes on, all later cycles together move it by {:.1e} more",
        last / before,
        tail(last, before)
    )
}

/// The pair whose way over a cycle is least like that over the one before, in both.
fn least_repeated<'t>(turn: &'t Turn, before: &'t Turn) -> Option<(&'t PairCycle, &'t PairCycle)> {
    let off = |(now, then): &(&PairCycle, &PairCycle)| (now.net - then.net).abs();
    turn.pairs.iter().zip(&before.pairs).max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Why every further cycle is like the last.
fn recurrence(turns: &[Turn], same: f64) -> String {
    let Some(last) = turns.last() else { return String::new() };
    let next = match last.repeated {
        Some(true) => format!("; the next was followed as well and passes the same {} working schemes", last.schemes),
        Some(false) => "; the next was followed as well: events that coincide come in another order".to_owned(),
        None => String::new(),
    };
    let before = turns.len().checked_sub(2).and_then(|before| turns[before].difference);
    let near = match (last.difference, before) {
        (None, _) => format!("to {same:e} of the largest"),
        (Some(now), _) if now <= NOISE => "to rounding (256 ε of the terms that each force sums)".to_owned(),
        (Some(now), Some(before)) if now < before => format!(
            "to {now:.1e} of the largest, {:.3} times the difference of the cycle before: if that goes on, all later cycles \
             together come {:.0e} nearer",
            now / before,
            tail(now, before)
        ),
        (Some(now), _) => format!("to {now:.1e} of the largest"),
    };
    if last.gaps_close {
        return format!(
            "event by event its forces are those of the two cycles before, {near}, and gaps widen and slips go on by the same from \
             each to the next, so that no law comes nearer to its limit: to these digits every further cycle does the same{next}"
        );
    }
    let others = if last.gap_growth > 0.0 { "other " } else { "" };
    format!(
        "its forces and {others}gaps are at its end what they were at its beginning, {near}. The rates depend on nothing else: to these \
         digits every further cycle is the same{next}"
    )
}

/// What is left to come where differences fall from one cycle to the next, in the same ratio from here on; 0 where they are
/// rounding.
fn tail(now: f64, before: f64) -> f64 {
    if now <= NOISE || now >= before { 0.0 } else { now * now / (before - now) }
}

#[cfg(test)]
#[path = "cycle_tests.rs"]
mod tests;
