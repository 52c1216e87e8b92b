//! Bare LCPs: all answers, the exact check of a basis, and what can be proved of a ray.

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use crate::answer::record::{Ray, RayClass, Verdict};
use crate::explain::plain_ray::PlainRay;
use crate::lcp::exact::all_solutions::{Continuum, Progress, all_solutions};
use crate::lcp::exact::classes::{SolvableClass, solvable_class};
use crate::lcp::exact::dyadic::{WholeRows, nearest};
use crate::lcp::exact::farkas::{Farkas, farkas};
use crate::lcp::exact::rational_solve::{RationalSolution, solve};
use crate::lcp::exact::scalar::{BigInt, ratio_to_f64};
use crate::lcp::mirrored::MirroredLcp;
use crate::text::words::short;
use crate::watch::Watch;

/// Most rows of the exact check of a basis.
const MOST_CHECKED: usize = 1000;
/// Steps times n³ after which a search that accompanies a solution is given up; nine rows need 1023 nodes.
const BRIEF: u64 = 40_000_000;
/// The same where nothing else found an answer.
const PATIENT: u64 = 500 * BRIEF;
/// Steps between two reports of progress.
const STEPS: u64 = 64;

/// How long a search may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// As long as it takes, or until it is stopped; what was found until then is kept.
    Full,
    /// A number of steps that takes a part of a second: it accompanies a solution.
    Brief,
    /// A number of steps that takes some seconds: nothing else found an answer.
    Patient,
}

/// A set of answers with more than one element.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainContinuum {
    /// Its corners, as indices of the answers.
    pub corners: Vec<usize>,
    /// Directions in which it goes on without end, largest entry 1.
    pub directions: Vec<Vec<f64>>,
}

/// What the search gave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlainAnswers {
    /// z of every basic answer, each once.
    pub answers: Vec<Vec<f64>>,
    /// Sets of answers between and beyond them.
    pub continua: Vec<PlainContinuum>,
    /// Whether the search came to its end.
    pub complete: bool,
    /// Number of bases that were described.
    pub visited: u64,
    /// Branches cut because nothing feasible is left in them.
    pub cut: u64,
    /// Sets of answers with too many corners to list them all.
    pub undecided: u64,
}

impl PlainAnswers {
    /// Whether it is proved that there is none.
    pub fn none(&self) -> bool {
        self.complete && self.undecided == 0 && self.answers.is_empty()
    }
}

/// The final basis of a bare LCP in exact arithmetic.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainCheck {
    /// Whether its equations have one solution.
    pub unique: bool,
    /// Negative variables: `z` or `w`, row, value rounded.
    pub violations: Vec<(char, usize, f64)>,
    /// Basic variables that are exactly zero.
    pub zeros: Vec<(char, usize)>,
}

/// Solves a basis exactly and determines every sign; `None` for more than a thousand rows, or where `watch` stops it.
pub fn check_plain_exactly(lcp: &MirroredLcp, basis: &[usize], watch: &dyn Watch) -> Option<PlainCheck> {
    let n = lcp.size();
    if n > MOST_CHECKED || lcp.full_size != n {
        return None;
    }
    let WholeRows { rows, scale } = WholeRows::of_lcp(&lcp.matrix(), &lcp.q);
    let mut check = PlainCheck { unique: false, violations: Vec::new(), zeros: Vec::new() };
    let matrix: Vec<Vec<BigInt>> = basis.iter().map(|&i| basis.iter().map(|&j| rows[i][j].clone()).collect()).collect();
    let right: Vec<BigInt> = basis.iter().map(|&i| -&rows[i][n]).collect();
    let mut progress = |share| {
        watch.progress("exact check", share);
        watch.go_on()
    };
    let z = match solve(&matrix, &right, &mut progress) {
        RationalSolution::Unique(z) => z,
        RationalSolution::Interrupted => return None,
        _ => return Some(check),
    };
    check.unique = true;
    let mut tell = |letter: char, row: usize, over: &BigInt, under: &BigInt| {
        if over.is_negative() {
            check.violations.push((letter, row, ratio_to_f64(over, under)));
        } else if over.is_zero() {
            check.zeros.push((letter, row));
        }
    };
    for (&i, value) in basis.iter().zip(&z.numerators) {
        tell('z', i, value, &z.denominator);
    }
    for i in (0..n).filter(|i| !basis.contains(i)) {
        let sum: BigInt = basis.iter().zip(&z.numerators).map(|(&j, z)| &rows[i][j] * z).sum();
        tell('w', i, &(sum + &rows[i][n] * &z.denominator), &(&scale[i] * &z.denominator));
    }
    Some(check)
}

/// Every answer of a bare LCP, in exact arithmetic; `None` where nothing was searched (contact's mirrored rows).
pub fn all_plain_answers(lcp: &MirroredLcp, effort: Effort, watch: &dyn Watch) -> Option<PlainAnswers> {
    let n = lcp.size() as u64;
    if lcp.full_size != lcp.size() {
        return None;
    }
    let most = match effort {
        Effort::Full => u64::MAX,
        Effort::Brief => BRIEF / n.saturating_pow(3).max(1),
        Effort::Patient => PATIENT / n.saturating_pow(3).max(1),
    };
    let mut steps = 0;
    let mut observer = |progress: Progress| {
        steps += 1;
        if steps % STEPS == 0 {
            let what = format!("{} branches, {} answers", progress.nodes, progress.found);
            watch.progress(&what, progress.share);
        }
        steps < most && !watch.stop()
    };
    let found = all_solutions(WholeRows::of_lcp(&lcp.matrix(), &lcp.q), &mut observer);
    let rounded = |z: &Vec<BigRational>| z.iter().map(nearest).collect::<Vec<f64>>();
    let continuum = |piece: &Continuum| PlainContinuum {
        corners: piece.corners.clone(),
        directions: piece.directions.iter().map(rounded).collect(),
    };
    Some(PlainAnswers {
        answers: found.basic.iter().map(rounded).collect(),
        continua: found.continua.iter().map(continuum).collect(),
        complete: found.complete,
        visited: found.leaves,
        cut: found.cut,
        undecided: found.unlisted,
    })
}

/// What is proved of a bare LCP whose run ended in a ray.
#[derive(Clone, Debug, PartialEq)]
pub enum RayProof {
    /// No z ≥ 0 is even feasible.
    Infeasible(Farkas),
    /// An answer exists for every q: the ray is due to rounding or to the covering.
    Solvable(SolvableClass),
}

/// Looks for a proof that there is no answer, or that there must be one.
pub fn prove_plain_ray(lcp: &MirroredLcp, watch: &dyn Watch) -> Option<RayProof> {
    if lcp.full_size != lcp.size() {
        return None;
    }
    let matrix = lcp.matrix();
    watch.progress("looking for a proof that there is no answer", 0.0);
    if let Some(class) = solvable_class(&matrix, &mut || !watch.stop()) {
        return Some(RayProof::Solvable(class));
    }
    farkas(&matrix, &lcp.q, &mut || !watch.stop()).map(RayProof::Infeasible)
}

impl RayProof {
    /// What it proves.
    pub fn verdict(&self) -> Option<Verdict> {
        match self {
            RayProof::Infeasible(_) => Some(Verdict::Certified),
            RayProof::Solvable(_) => None,
        }
    }

    /// The class of the ray: a fault where an answer must exist.
    pub fn class(&self) -> RayClass {
        match self {
            RayProof::Infeasible(_) => RayClass::NoEquilibrium,
            RayProof::Solvable(_) => RayClass::Fault,
        }
    }

    /// The proof in words; `names` are those of the rows.
    pub fn sentence(&self, names: &[String]) -> String {
        match self {
            RayProof::Infeasible(proof) => format!(
                "Proved: there is no answer, because {} is at most {} for every z ≥ 0, and an answer has w ≥ 0.",
                combination(&proof.multipliers, names),
                short(-proof.gap)
            ),
            RayProof::Solvable(class) => format!(
                "An answer exists for every q, because {}: this ray is rounding, not a property of the problem.",
                class.words()
            ),
        }
    }

    /// The ray with this proof on record.
    pub fn record(&self, ray: &PlainRay, names: &[String]) -> Ray {
        let mut record = ray.record(Verdict::Undecided, &self.sentence(names));
        (record.class, record.verdict) = (self.class(), self.verdict());
        record
    }
}

/// "w[1] + 0.5 w[3]".
fn combination(multipliers: &[f64], names: &[String]) -> String {
    const SHOWN: usize = 6;
    let terms: Vec<String> = multipliers
        .iter()
        .zip(names)
        .filter(|(y, _)| **y > 0.0)
        .map(|(y, name)| if *y == 1.0 { format!("w[{name}]") } else { format!("{} w[{name}]", short(*y)) })
        .collect();
    if terms.len() <= SHOWN {
        return terms.join(" + ");
    }
    let equal = multipliers.iter().filter(|y| **y > 0.0).all(|y| *y == 1.0);
    if equal && terms.len() == names.len() {
        return "the sum of all w".to_owned();
    }
    let count = terms.len() - SHOWN;
    format!("{} + {count} more", terms[..SHOWN].join(" + "))
}
