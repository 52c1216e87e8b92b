//! The word holds: random contact systems of every awkward kind, solved cold and followed warm, each answer judged from
//! the file row by row, each claim that there is no answer contradicted where an exhaustive search finds one.

#[path = "../common/mod.rs"]
mod common;

mod certificates;
mod classes;
mod cone;
mod enumerate;
mod explain_engines;
mod judge;
mod large;
mod random_contact;
mod space;
mod zoo;

use judge::Problem;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::json;
use stickslip::answer::record::{Answer, OutcomeKind, Verdict};
use stickslip::model::rules::Rules;
use stickslip::watch::Quiet;

/// Families of problems.
const FAMILIES: [&str; 7] = ["ties", "kernel", "frictionless", "gaps", "scales", "bounds", "mixed"];

/// What was counted.
#[derive(Debug, Default)]
struct Count {
    problems: usize,
    answers: usize,
    warm: usize,
    claims: usize,
    /// No answer given and none claimed impossible, or the run was refused.
    undecided: usize,
    wrong: Vec<String>,
    false_claims: Vec<String>,
}

fn pick<T: Copy>(rng: &mut ChaCha8Rng, choices: &[T]) -> T {
    choices[rng.random_range(0..choices.len())]
}

fn power_of_ten(rng: &mut ChaCha8Rng, from: f64, to: f64) -> f64 {
    10f64.powf(rng.random_range(from..to))
}

/// A problem of a family, and factors the load and the friction are later multiplied by.
fn problem(rng: &mut ChaCha8Rng, family: &str) -> Problem {
    let m = pick(rng, &[1, 1, 2, 2, 2, 3, 5, 8]);
    let n = 2 * m;
    let mixed = family == "mixed";
    let integers = matches!(family, "ties" | "kernel") || (mixed && rng.random_bool(0.5));
    let number = |rng: &mut ChaCha8Rng| {
        if integers { f64::from(rng.random_range(-2..=2)) } else { rng.random_range(-1.0..1.0) }
    };
    let loose = family == "kernel" || (matches!(family, "frictionless" | "mixed") && rng.random_bool(0.5));
    let rank = if loose { rng.random_range(0..n) } else { n };
    let a: Vec<Vec<f64>> = (0..n).map(|_| (0..rank).map(|_| number(rng)).collect()).collect();
    let diagonal = if loose { 0.0 } else { pick(rng, &[1.0, 0.25]) };
    let scaled = family == "scales" || (mixed && rng.random_bool(0.5));
    // Powers of two keep a kernel exact.
    let scale: Vec<f64> = (0..n)
        .map(|_| match scaled {
            true if loose => 2f64.powi(rng.random_range(-10..=10)),
            true => power_of_ten(rng, -3.0, 3.0),
            false => 1.0,
        })
        .collect();
    let r: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| {
                    let product: f64 = a[i].iter().zip(&a[j]).map(|(x, y)| x * y).sum();
                    // The same rounding on both sides of the diagonal.
                    let (first, second) = if i < j { (i, j) } else { (j, i) };
                    (product + if i == j { diagonal } else { 0.0 }) * scale[first] * scale[second]
                })
                .collect()
        })
        .collect();
    let size = if mixed { power_of_ten(rng, -6.0, 6.0) } else { 1.0 };
    // Loads now and then lie in the range of R: everything cancels.
    let in_range = rng.random_bool(0.2);
    let weights: Vec<f64> = (0..n).map(|_| number(rng)).collect();
    let load = (0..n)
        .map(|i| {
            let free = number(rng) * scale[i];
            let held: f64 = r[i].iter().zip(&weights).map(|(r, weight)| r * weight).sum();
            size * if in_range { held } else { free }
        })
        .collect();
    let laws: &[&'static str] = match family {
        "frictionless" => &["frictionless", "frictionless", "coulomb"],
        "bounds" => &["bound", "coulomb"],
        "mixed" => &["coulomb", "frictionless", "bound"],
        _ => &["coulomb"],
    };
    let law: Vec<&'static str> = (0..m).map(|_| pick(rng, laws)).collect();
    let mut of = |takers: &[&str], value: &mut dyn FnMut(&mut ChaCha8Rng) -> f64| -> Vec<f64> {
        law.iter().map(|law| if takers.contains(law) { value(rng) } else { 0.0 }).collect()
    };
    let friction = of(&["coulomb"], &mut |rng| {
        if integers { pick(rng, &[0.0, 0.5, 1.0, 2.0]) } else { rng.random_range(0.0..3.0) }
    });
    let cohesive = mixed || family == "gaps";
    let cohesion = of(&["coulomb"], &mut |rng| if cohesive { size * pick(rng, &[0.0, 0.0, 0.5, 1.0]) } else { 0.0 });
    let gapped = mixed || family == "gaps";
    let gap = of(&["coulomb", "frictionless"], &mut |rng| {
        if gapped { pick(rng, &[0.0, 0.0, 0.1, 1.0, 1e3]) } else { 0.0 }
    });
    let bound = of(&["bound"], &mut |rng| pick(rng, &[0.0, 0.5, 1.0, 1e9, 1e12, 1e15]));
    Problem { r, load, law, friction, cohesion, gap, bound }
}

fn scenario(problem: &Problem) -> String {
    let m = problem.pairs();
    common::scenario_text(json!({ "parameters": { "F": 1.0 }, "contact_system": {
        "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(),
        "stiffness": problem.r, "loads": { "load": { "factor": "F", "vector": problem.load } },
        "law": problem.law, "friction": problem.friction, "cohesion": problem.cohesion, "gap": problem.gap,
        "bound": problem.bound
    } }))
}

fn judge_claim(problem: &Problem, answer: &Answer, count: &mut Count, text: &str) {
    let Some(verdict) = answer.ray.as_ref().and_then(|ray| ray.verdict) else {
        count.undecided += 1;
        return;
    };
    if verdict == Verdict::Undecided {
        count.undecided += 1;
        return;
    }
    count.claims += 1;
    if problem.must_have_answer() {
        count.false_claims.push(format!("{verdict:?}: {text}"));
    }
}

fn run(problems: usize, seed: u64) -> Count {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut count = Count::default();
    for k in 0..problems {
        let family = FAMILIES[k % FAMILIES.len()];
        let problem = problem(&mut rng, family);
        let text = scenario(&problem);
        let Ok(loaded) = stickslip::model::load::load_text("test", &text, None) else {
            panic!("refused: {text}");
        };
        count.problems += 1;
        // A load on a free tangential motion of frictionless pairs is refused in words.
        let Ok(prepared) = stickslip::solve::prepare(&loaded, &Quiet) else {
            count.undecided += 1;
            continue;
        };
        let mut values = loaded.parameter_values();
        let rules = Rules::default();
        let mut solved = prepared.case(&loaded, &values).under(rules).solve().expect("solved");
        if !solved.answer.is_answer() {
            judge_claim(&problem, &solved.answer, &mut count, &text);
            continue;
        }
        count.answers += 1;
        if let Some(fault) = problem.fault_of(&solved.answer) {
            count.wrong.push(format!("{family}: {fault}\n{text}"));
        }
        for factor in [1.25, 0.5, -1.0] {
            let mut moved = problem.clone();
            moved.load.iter_mut().for_each(|load| *load *= factor);
            values.insert("F".to_owned(), factor);
            let Some(next) = prepared.case(&loaded, &values).under(rules).follow(&solved) else {
                break;
            };
            count.warm += 1;
            assert_ne!(next.answer.outcome, OutcomeKind::CheckFailed);
            if let Some(fault) = moved.fault_of(&next.answer) {
                count.wrong.push(format!("{family}, warm, F = {factor}: {fault}\n{text}"));
            }
            solved = next;
        }
    }
    count
}

fn assert_truth(count: &Count) {
    println!(
        "{} problems: {} answers, {} warm answers, {} claims, {} undecided; {} wrong, {} false claims",
        count.problems,
        count.answers,
        count.warm,
        count.claims,
        count.undecided,
        count.wrong.len(),
        count.false_claims.len()
    );
    for faults in [&count.false_claims, &count.wrong] {
        let mut faults: Vec<&String> = faults.iter().collect();
        faults.sort_by_key(|fault| fault.len());
        faults.iter().take(6).for_each(|fault| println!("{fault}\n"));
    }
    assert!(count.wrong.is_empty() && count.false_claims.is_empty());
}

#[test]
fn no_answer_is_wrong_and_no_claim_false() {
    let count = run(350, 11);
    assert_truth(&count);
    assert!(count.answers > 250 && count.claims > 20 && count.warm > 700, "{count:?}");
}

/// `STICKSLIP_TRUTH=20000 cargo test --release --test truth -- --ignored --nocapture`
#[test]
#[ignore = "minutes: the size comes from STICKSLIP_TRUTH, 20 000 without it"]
fn the_field() {
    let number = |name: &str, other: u64| std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(other);
    assert_truth(&run(number("STICKSLIP_TRUTH", 20_000) as usize, number("STICKSLIP_TRUTH_SEED", 12)));
}

/// Kinds that a scale common to all rows, or rounding in a motion that leaves joints at rest, left without a verdict.
#[test]
fn what_has_no_answer_is_proved_to_have_none_at_any_scale() {
    let system = |stiffness: [[f64; 4]; 4], load: [f64; 4], cohesion: f64| {
        json!({ "contact_system": {
            "pairs": ["c1", "c2"], "stiffness": stiffness, "loads": { "load": { "vector": load } },
            "friction": [0, 0], "cohesion": [cohesion, 0] } })
    };
    let nothing = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0; 4], [0.0; 4]];
    let at_rest = [[2.0, 0.0, -1.0, 0.0], [0.0, 3.0, -5.0, -3.0], [-1.0, -5.0, 9.0, 5.0], [0.0, -3.0, 5.0, 3.0]];
    let problems = [
        // z_1 ≥ 1 keeps w_2 ≥ 0, and then w_1 > 0 with z_1 > 0.
        json!({ "lcp": { "M": [[1e11, 0], [1e-9, 0]], "q": [2e11, -1e-9] } }),
        // f = 0 takes nothing of the tangential load, 2^-40.
        system(nothing, [2.0, 2.0, 2f64.powi(-40), 0.0], 0.0),
        // R (0, 1, 0, 1) = 0, and the load −2 · 1 − 1 · 1 < 0 drives pair c2 apart.
        system(at_rest, [1.0, -2.0, 1.0, -1.0], 0.5),
    ];
    for problem in problems {
        let loaded = stickslip::model::load::load_text("test", &common::scenario_text(problem.clone()), None);
        let loaded = loaded.unwrap_or_else(|problems| panic!("{problems}"));
        let prepared = stickslip::solve::prepare(&loaded, &Quiet).expect("sound");
        let solved =
            prepared.case(&loaded, &loaded.parameter_values()).under(Rules::default()).solve().expect("solved");
        let verdict = solved.answer.ray.as_ref().and_then(|ray| ray.verdict);
        assert!(matches!(verdict, Some(Verdict::Certified | Verdict::Proved)), "{problem}: {:?}", solved.answer);
    }
}
