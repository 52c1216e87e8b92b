//! A bare LCP: one run under given rules, and the retries after one that ended badly.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::bimatrix::equilibrium;
use super::descent::descent;
use super::engines::{EXACT_ROWS, PIVOT_LIMIT, covered, run_exact_plain, run_scheme_within, run_tableau};
use super::error::SolveError;
use super::finish::{empty_answer, fail_check};
use super::ladder::{EXACT_BUDGET, LAST_RESORT, Ladder, others};
use super::plain_answers::{Effort, PlainAnswers, RayProof, all_plain_answers, prove_plain_ray};
use super::settle::{ray_holds, settled};
use super::state::{LookedAt, RunData, Solved};
use crate::answer::attempt::{AttemptCovering, AttemptEngine, AttemptRules, PlainCovering};
use crate::answer::check::TOLERANCE;
use crate::answer::check_plain::{ROW_ROUNDING, check_rows, rows};
use crate::answer::record::{Answer, OutcomeKind, PlainSolution, Ray, Size, Verdict};
use crate::contact::sum::HIDDEN;
use crate::explain::plain_ray::PlainRay;
use crate::explain::sentence;
use crate::lcp::exact::dyadic::nearest;
use crate::lcp::exact::triangular;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::{Outcome, Point, Run};
use crate::lcp::pivot::PivotLog;
use crate::lcp::ratio_test::TieRule;
use crate::model::parameter::{Number, ParameterValues};
use crate::model::rules::{Engine, Rules, TieBreak};
use crate::watch::{Budget, Watch};

/// What is said of the answers where nothing was proved.
const UNKNOWN: &str = "For a general M this proves nothing about whether one exists.";
/// Finds z of an LCP of some class, which the caller checks; `None` where it is not of that class, or none was found.
type Find = fn(&MirroredLcp, &dyn Watch) -> Result<Option<Vec<f64>>, SolveError>;
/// A way to an answer that fits the data of some LCPs only, and what is said of it.
type Special = (AttemptEngine, Find, &'static str);
/// Those that are tried first.
const SPECIAL: [Special; 2] = [
    (
        AttemptEngine::Substitution,
        by_substitution,
        "M is triangular with a positive diagonal, its rows in some order: this is the one answer, one z after another",
    ),
    (
        AttemptEngine::Bimatrix,
        equilibrium,
        "this is a bimatrix game; stated with the players' values as unknowns Lemke's algorithm finds an equilibrium",
    ),
];
/// The one that is tried where other coverings lead to nothing.
const DESCENT: Special = (
    AttemptEngine::Descent,
    descent,
    "these are the first-order conditions of a quadratic program that is not convex: steps down it, each convex and solved by \
     Lemke's algorithm, end here; another answer may lie lower",
);
/// What is said of an answer so far away that rounding hides q there.
const FAR: &str = "z is so large that the rounding of M z hides q: an answer of the numbers as they are written, which may be none if \
                   they were rounded, as a motion that nothing resists makes it";
/// Rows up to which all bases are tried before anything else.
const FEW_ROWS: usize = 9;
/// A patient search of all bases ends after this time.
const PATIENCE: Duration = Duration::from_secs(10);
/// Pivots after which other coverings are tried before a run under the default rules goes on to the limit of pivots: more
/// than the 2¹⁴ that the known examples of exponential length (Murty, Fathi) take at 14 rows, as many as 200 rows take in some
/// seconds.
const FIRST_PIVOTS: usize = 20_000;
/// Random covering vectors that are tried.
const RANDOM_COVERINGS: u64 = 3;

/// A bare LCP with q filled in.
#[derive(Clone)]
pub(super) struct PlainProblem<'a> {
    /// M, q, d of the file (ones without one).
    lcp: Arc<MirroredLcp>,
    /// Names of its rows.
    names: &'a [String],
    /// Its own covering vector: that of the file, else ones.
    covering: PlainCovering,
}

/// How a bare LCP is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PlainRules {
    covering: PlainCovering,
    tie_break: TieBreak,
    engine: Engine,
    /// A run of the scheme ends after so many pivots.
    most_pivots: usize,
}

impl From<PlainRules> for AttemptRules {
    fn from(rules: PlainRules) -> AttemptRules {
        AttemptRules {
            covering: AttemptCovering::Plain(rules.covering),
            tie_break: rules.tie_break,
            engine: AttemptEngine::Lemke(rules.engine),
        }
    }
}

impl<'a> PlainProblem<'a> {
    /// `lcp` has the rest; its q is left open.
    pub(super) fn new(
        lcp: &MirroredLcp,
        q: &[Number],
        values: &ParameterValues,
        names: &'a [String],
        covering_given: bool,
    ) -> PlainProblem<'a> {
        let q = q.iter().map(|number| number.value(values)).collect::<Vec<_>>().into();
        let covering = if covering_given { PlainCovering::Given } else { PlainCovering::Ones };
        PlainProblem { lcp: Arc::new(MirroredLcp { q, ..lcp.clone() }), names, covering }
    }

    /// The user's rules under the problem's own covering.
    pub(super) fn rules(&self, rules: Rules) -> PlainRules {
        PlainRules {
            covering: self.covering,
            tie_break: rules.tie_break,
            engine: rules.engine,
            most_pivots: PIVOT_LIMIT,
        }
    }
}

/// One run under exactly these rules.
pub(super) fn attempt_plain(
    problem: &PlainProblem,
    rules: PlainRules,
    watch: &dyn Watch,
) -> Result<Solved, SolveError> {
    let lcp = covered(&problem.lcp, rules.covering);
    let rule = match rules.tie_break {
        TieBreak::Lexicographic | TieBreak::Natural => TieRule::Lexicographic((0..lcp.size()).collect()),
        TieBreak::FirstRow => TieRule::FirstRow,
        TieBreak::Random(seed) => TieRule::Random(seed),
    };
    let start = Instant::now();
    let mut run = match rules.engine {
        Engine::Scheme => run_scheme_within(&lcp, rule, rules.most_pivots, watch),
        Engine::Tableau => run_tableau(&lcp, rule, watch),
        Engine::Exact if lcp.size() > EXACT_ROWS => {
            return Err(SolveError::TooLargeForExact { what: "rows", found: lcp.size(), most: EXACT_ROWS });
        }
        Engine::Exact => run_exact_plain(&lcp, rule, watch),
    };
    if run.outcome == Outcome::Interrupted {
        return Err(SolveError::Interrupted);
    }
    let marginal = run.outcome == Outcome::Normal { marginal: true };
    let basis = run.pivots.basis();
    if matches!(run.outcome, Outcome::Normal { .. }) && !basis.p && rules.engine != Engine::Exact {
        run.point = settled(&lcp, &basis, &run.point, &Budget::new(watch, EXACT_BUDGET));
    }
    let seconds = start.elapsed().as_secs_f64();
    let size = Size { unknowns: None, free: None, pairs: 0, lcp: lcp.size() };
    let mut answer = empty_answer(&run, 1.0, rules.into(), size);
    answer.timings.lemke = seconds;
    answer.pivots = sentence::plain_records(run.pivots.recorded(), problem.names);
    let mut plain_ray = None;
    if let Outcome::Ray(direction) = &run.outcome {
        let ray = PlainRay::new(&lcp, problem.names, &run.pivots, direction, run.point.p);
        answer.ray = Some(ray.record(Verdict::Undecided, UNKNOWN));
        plain_ray = Some(Box::new(ray));
    }
    answer.solution = Some(PlainSolution { z: run.point.z.clone(), w: run.point.w.clone() });
    if answer.is_answer() {
        // A marginal answer holds only up to the p that was left.
        let tolerance = if marginal { TOLERANCE } else { ROW_ROUNDING };
        check(&mut answer, &lcp, tolerance);
        if !answer.check.passed {
            fail_check(&mut answer);
        }
    }
    let cycled = matches!(run.outcome, Outcome::Cycle(_));
    Ok(Solved {
        answer,
        run: RunData::Plain { lcp, pivots: run.pivots },
        ray: None,
        plain_ray,
        cycled,
        rest: None,
        looked_at: LookedAt::default(),
        retry_note: String::new(),
        warm: None,
    })
}

/// Solves a bare LCP, with retries under the default tie-break.
pub(super) fn solve_plain_judged(
    problem: &PlainProblem,
    rules: Rules,
    watch: &dyn Watch,
) -> Result<Solved, SolveError> {
    let asked = problem.rules(rules);
    let own = PlainRules { most_pivots: if rules.are_default() { FIRST_PIVOTS } else { asked.most_pivots }, ..asked };
    let mut first = attempt_plain(problem, own, watch)?;
    if first.answer.is_answer() {
        return Ok(first);
    }
    if rules.are_default() {
        return retry(problem, first, own, watch);
    }
    let other = attempt_plain(problem, problem.rules(Rules::default()), watch)?;
    if other.answer.is_answer() {
        let (tie_break, count) = (TieBreak::default(), other.pivot_count());
        first.say(&format!(" The default tie-break ({tie_break}) finds an answer in {count} pivots."));
    }
    Ok(first)
}

/// Proofs that there is no answer, then other rules, then all bases; the first answer wins. Without one the first run
/// is shown, with what was proved.
fn retry(problem: &PlainProblem, mut first: Solved, own: PlainRules, watch: &dyn Watch) -> Result<Solved, SolveError> {
    let mut ladder = Ladder::new(first);
    for special in SPECIAL {
        if let Some(answer) = specially(problem, &mut ladder, (special, own), watch)? {
            return Ok(answer);
        }
    }
    first = ladder.without_answer();
    if let (Some(ray), RunData::Plain { lcp, pivots }) = (&mut first.plain_ray, &first.run) {
        ray.exact = ray_holds(lcp, &pivots.basis(), ray.entering, &Budget::new(watch, EXACT_BUDGET));
        first.answer.ray = Some(ray.record(Verdict::Undecided, UNKNOWN));
    }
    // Beyond a few rows, a combination of rows proves sooner than all bases that there is no answer.
    let few = problem.lcp.size() <= FEW_ROWS;
    let (mut proof, mut given_up) = (None, false);
    if !few && first.plain_ray.is_some() {
        (proof, given_up) = prove_in_time(&problem.lcp, watch);
    }
    if let (Some(proof @ RayProof::Infeasible(_)), Some(ray)) = (&proof, &first.plain_ray) {
        first.answer.ray = Some(proof.record(ray, problem.names));
        return Ok(first);
    }
    let budget = Budget::new(watch, EXACT_BUDGET);
    let found = all_plain_answers(&problem.lcp, Effort::Brief, &budget);
    let too_long = budget.ran_out() && found.as_ref().is_some_and(|found| !found.complete);
    if let Some(proof) = proof_by_all_bases(found.as_ref(), &first) {
        first.answer.ray = Some(proof);
        return Ok(first);
    }
    if few && first.plain_ray.is_some() {
        (proof, given_up) = prove_in_time(&problem.lcp, watch);
    }
    if let (Some(proof), Some(ray)) = (&proof, &first.plain_ray) {
        first.answer.ray = Some(proof.record(ray, problem.names));
    }
    let rungs = rungs(problem, &first, own);
    let by_rounding = first.plain_ray.as_ref().is_some_and(|ray| ray.exact == Some(false));
    if by_rounding && proof.is_none() {
        fail_ray(&mut first);
    }
    if given_up {
        let seconds = EXACT_BUDGET.as_secs();
        first.say(&format!(" A proof that there is no answer was looked for and given up after {seconds} s."));
    }
    let mut ladder = Ladder::new(first);
    if too_long {
        ladder.gave_up(AttemptRules::from(own).by(AttemptEngine::Enumeration), EXACT_BUDGET);
    }
    let budget = if by_rounding { LAST_RESORT } else { EXACT_BUDGET };
    let attempt = |rules: PlainRules, watch: &dyn Watch| attempt_plain(problem, rules, watch);
    let proved = |again: &mut Solved| prove_ray(again, problem, found.as_ref(), watch);
    if let Some(solved) = ladder.climb(&rungs, budget, watch, &attempt, &proved)? {
        return Ok(solved);
    }
    if let Some(answer) = specially(problem, &mut ladder, (DESCENT, own), watch)? {
        return Ok(answer);
    }
    by_all_bases(problem, ladder, found, own, watch)
}

/// The answer that a special way leads to.
fn specially(
    problem: &PlainProblem,
    ladder: &mut Ladder,
    ((engine, find, note), own): (Special, PlainRules),
    watch: &dyn Watch,
) -> Result<Option<Solved>, SolveError> {
    let Some(z) = find(&problem.lcp, watch)? else { return Ok(None) };
    let found = plain_answer(&problem.lcp, &z, AttemptRules::from(own).by(engine));
    ladder.first_answer(std::iter::once(Ok(found)), Some(note.to_owned()))
}

/// The first answer among all bases, searched more patiently where a brief search came to no end; or what no answer among
/// them proves of the first run.
fn by_all_bases(
    problem: &PlainProblem,
    mut ladder: Ladder,
    brief: Option<PlainAnswers>,
    own: PlainRules,
    watch: &dyn Watch,
) -> Result<Solved, SolveError> {
    let is_open = |found: &PlainAnswers| !found.complete && found.answers.is_empty();
    let found = match brief {
        Some(brief) if is_open(&brief) => {
            all_plain_answers(&problem.lcp, Effort::Patient, &Budget::new(watch, PATIENCE))
        }
        brief => brief,
    };
    if watch.stop() {
        return Err(SolveError::Interrupted);
    }
    let Some(found) = found else { return Ok(ladder.without_answer()) };
    let state =
        |z: &Vec<f64>| Ok(plain_answer(&problem.lcp, z, AttemptRules::from(own).by(AttemptEngine::Enumeration)));
    let note = others(found.answers.len(), !found.continua.is_empty(), found.complete);
    if let Some(answer) = ladder.first_answer(found.answers.iter().map(state), note)? {
        return Ok(answer);
    }
    let mut first = ladder.without_answer();
    if let Some(proof) = proof_by_all_bases(Some(&found), &first).filter(|_| first.answer.ray.is_some()) {
        first.answer.ray = Some(proof);
    }
    Ok(first)
}

/// z of a triangular M, one after another in exact arithmetic, rounded.
fn by_substitution(lcp: &MirroredLcp, watch: &dyn Watch) -> Result<Option<Vec<f64>>, SolveError> {
    let plain = lcp.mirrors.iter().all(Option::is_none);
    let Some(order) = plain.then(|| triangular::order(&lcp.base)).flatten() else { return Ok(None) };
    let budget = Budget::new(watch, EXACT_BUDGET);
    let z = triangular::answer(&lcp.base, lcp.q.as_slice(), &order, &mut || !budget.stop());
    if z.is_none() && !budget.ran_out() {
        return Err(SolveError::Interrupted);
    }
    Ok(z.map(|z| z.iter().map(nearest).collect()))
}

/// An answer of a bare LCP found without pivots of its own, as a solved state, freshly checked.
pub(super) fn plain_answer(lcp: &Arc<MirroredLcp>, z: &[f64], rules: AttemptRules) -> Solved {
    let w = lcp.times(z) + &lcp.q;
    let point = Point { w: w.iter().copied().collect(), z: z.to_vec(), p: 0.0 };
    let run = Run { outcome: Outcome::Normal { marginal: false }, pivots: PivotLog::default(), point };
    let size = Size { lcp: lcp.size(), ..Size::default() };
    let mut answer = empty_answer(&run, 1.0, rules, size);
    answer.solution = Some(PlainSolution { z: run.point.z, w: run.point.w });
    check(&mut answer, lcp, ROW_ROUNDING);
    if !answer.check.passed {
        answer.outcome = OutcomeKind::CheckFailed;
    }
    Solved {
        answer,
        run: RunData::Plain { lcp: Arc::clone(lcp), pivots: PivotLog::default() },
        ray: None,
        plain_ray: None,
        cycled: false,
        warm: None,
        rest: None,
        looked_at: LookedAt::default(),
        retry_note: String::new(),
    }
}

/// Checks what was found. Where it passes, w that is rounding of its own terms is 0, and z beside which rounding hides q is told.
fn check(answer: &mut Answer, lcp: &MirroredLcp, tolerance: f64) {
    let Some(PlainSolution { z, w }) = &mut answer.solution else { return };
    let rows = rows(lcp, z);
    answer.check = check_rows(&rows, z, tolerance);
    if !answer.check.passed {
        return;
    }
    for (w, row) in w.iter_mut().zip(&rows) {
        *w = if row.relative().abs() <= ROW_ROUNDING { 0.0 } else { row.value() };
    }
    let largest = rows.iter().map(|row| row.magnitude()).fold(0.0, f64::max);
    if ROW_ROUNDING * largest > HIDDEN * lcp.q.amax() {
        answer.notes.push(FAR.to_owned());
    }
}

/// Looks for a proof within its time, and says whether that was too short.
fn prove_in_time(lcp: &MirroredLcp, watch: &dyn Watch) -> (Option<RayProof>, bool) {
    let budget = Budget::new(watch, EXACT_BUDGET);
    let proof = prove_plain_ray(lcp, &budget);
    let given_up = proof.is_none() && budget.ran_out();
    (proof, given_up)
}

/// What is said of a ray where all bases were tried in exact arithmetic and none is an answer.
fn proof_by_all_bases(found: Option<&PlainAnswers>, solved: &Solved) -> Option<Ray> {
    let ray = solved.plain_ray.as_ref().filter(|_| found.is_some_and(PlainAnswers::none))?;
    let said = "Proved: every complementary basis was tried in exact arithmetic, none is an answer.";
    Some(ray.record(Verdict::Proved, said))
}

/// Replaces the ray by a proof that there is no answer; whether there is such a proof.
fn prove_ray(solved: &mut Solved, problem: &PlainProblem, found: Option<&PlainAnswers>, watch: &dyn Watch) -> bool {
    let Some(ray) = &solved.plain_ray else { return false };
    let record = if let Some(proof) = proof_by_all_bases(found, solved) {
        proof
    } else if let (Some(proof @ RayProof::Infeasible(_)), _) = prove_in_time(&problem.lcp, watch) {
        proof.record(ray, problem.names)
    } else {
        return false;
    };
    solved.answer.ray = Some(record);
    true
}

/// A ray that is none in exact arithmetic claims nothing: the run broke down.
fn fail_ray(solved: &mut Solved) {
    let answer = &mut solved.answer;
    let why = "the run ended in a ray by rounding: in exact arithmetic it is none.";
    answer.outcome = OutcomeKind::Breakdown;
    answer.ray = None;
    answer.failure = Some(why.to_owned());
    if let Some(attempt) = answer.attempts.last_mut() {
        attempt.outcome = OutcomeKind::Breakdown;
        attempt.why = Some(why.to_owned());
    }
}

/// What is tried after a first run without an answer, in order. Where rounding is to blame it is the sizes of the rows as
/// covering, then exact arithmetic; after a ray that is no rounding, other coverings. These may come to an answer in a few
/// pivots where the first run came to none in many: so it goes on only after them, and exact arithmetic, which is slower,
/// comes last.
fn rungs(problem: &PlainProblem, first: &Solved, own: PlainRules) -> Vec<PlainRules> {
    if first.plain_ray.as_ref().is_some_and(|ray| ray.whatever_the_covering) {
        return Vec::new();
    }
    let mut coverings = Vec::new();
    let ones = problem.lcp.covering.iter().all(|d| *d == problem.lcp.covering[0]);
    if !ones {
        coverings.push(PlainCovering::Ones);
    }
    coverings.push(PlainCovering::Rows);
    coverings.extend((1..=RANDOM_COVERINGS).map(PlainCovering::Random));
    let mut rungs: Vec<PlainRules> = coverings.into_iter().map(|covering| PlainRules { covering, ..own }).collect();
    // The covering by rows may happen to be a multiple of d.
    rungs.retain(|rules| !is_multiple(&covered(&problem.lcp, rules.covering), &problem.lcp));
    rungs.push(PlainRules { tie_break: TieBreak::Random(1), ..own });
    let unfinished = first.answer.outcome == OutcomeKind::PivotLimit && !first.cycled;
    if unfinished {
        rungs.push(PlainRules { most_pivots: PIVOT_LIMIT, ..own });
    }
    if problem.lcp.size() <= EXACT_ROWS {
        let exact = PlainRules { engine: Engine::Exact, ..own };
        match first.plain_ray.as_ref().map(|ray| ray.exact) {
            // Exact arithmetic has nothing to add.
            Some(Some(true)) => {}
            Some(None) => rungs.push(exact),
            None if unfinished => rungs.push(exact),
            // A ray, or another end, by rounding: first the covering that makes little of it where rows differ in size.
            Some(Some(false)) | None => {
                let by_rows = rungs.iter().position(|rules| rules.covering == PlainCovering::Rows);
                rungs.insert(by_rows.map_or(0, |at| at + 1), exact);
            }
        }
    }
    rungs
}

/// Whether the covering vectors differ only by a factor: then the pivots are the same.
fn is_multiple(a: &MirroredLcp, b: &MirroredLcp) -> bool {
    let (x, y) = (&a.covering, &b.covering);
    (0..x.len()).all(|i| x[i] * y[0] == y[i] * x[0])
}
