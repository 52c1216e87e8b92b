//! Random contact systems with a positive definite R: an answer always exists (Haslinger 1983), so the default
//! rules must find one, and a fresh evaluation of the laws from R, RF, f must accept it.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::contact::lcp::contact_lcp;
use stickslip::contact::problem::ContactProblem;
use stickslip::lcp::basis_solution::vertex;
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::outcome::Outcome;
use stickslip::model::pair::Law;
use stickslip::model::rules::{Covering, TieBreak};

use crate::common;

/// R = A Aᵀ / n + shift·I; with `ties` the entries of A and the loads are small integers.
pub fn random_system(rng: &mut ChaCha8Rng, m: usize, ties: bool) -> ContactProblem {
    let n = 2 * m;
    let a =
        DMatrix::from_fn(
            n,
            n,
            |_, _| {
                if ties { f64::from(rng.random_range(-1..=1)) } else { rng.random_range(-1.0..1.0) }
            },
        );
    let stiffness = &a * a.transpose() / n as f64 + DMatrix::identity(n, n) * 0.05;
    let load =
        DVector::from_fn(
            n,
            |_, _| {
                if ties { f64::from(rng.random_range(-2..=2)) } else { rng.random_range(-1.0..1.0) }
            },
        );
    let f = if ties { f64::from(rng.random_range(0..=5)) } else { rng.random_range(0.0..5.0) };
    common::systems::coulomb(stiffness, load, f)
}

/// Worst violation of the laws at joint displacements z, relative to the largest force.
fn violation(problem: &ContactProblem, z: &DVector<f64>) -> f64 {
    let m = problem.system.pairs.len();
    let force = &problem.system.stiffness * z + &problem.load;
    let scale = problem.load.amax().max(1e-300);
    let mut worst = 0f64;
    for i in 0..m {
        let (x_n, x_t, z_n, z_t) = (force[i], force[m + i], z[i], z[m + i]);
        let bound = problem.laws[i].friction() * x_n;
        worst = worst.max(-x_n / scale).max(-z_n).max((x_n * z_n).abs() / scale);
        worst = worst.max((x_t.abs() - bound) / scale);
        // slip + goes with x_τ = −bound
        worst = worst.max((z_t.max(0.0) * (bound + x_t)).abs() / scale);
        worst = worst.max((z_t.min(0.0) * (bound - x_t)).abs() / scale);
    }
    worst
}

#[test]
fn default_rules_always_answer_where_r_is_positive_definite() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut worst = 0f64;
    let mut pivots = 0;
    for k in 0..2000 {
        let m = 1 + k % 20;
        let problem = random_system(&mut rng, m, k % 3 == 0);
        let contact = contact_lcp(&problem, Covering::Cohesive).unwrap();
        let mut engine = SchemeEngine::new(contact.lcp.clone(), contact.tie_rule(TieBreak::Lexicographic));
        let run = run(&mut engine, 20_000, &mut |_| ControlFlow::Continue(()));
        assert!(
            matches!(run.outcome, Outcome::Trivial | Outcome::Normal { marginal: false }),
            "problem {k}: m = {m}, f = {}: {:?}",
            problem.laws[0].friction(),
            run.outcome
        );
        pivots += run.pivots.count();
        let rebuilt = vertex(&contact.lcp, &run.pivots.basis()).expect("regular");
        for point in [&run.point, &rebuilt] {
            let z = contact.joint_displacements(&problem.system, &point.z) * contact.length_unit;
            let error = violation(&problem, &z);
            worst = worst.max(error);
            assert!(error < 1e-9, "problem {k}: violation {error:e}");
        }
    }
    println!("worst violation {worst:e}, {pivots} pivots");
}

/// A contact system as a scenario: everything mixed. `loose` motions have no stiffness.
fn random_scenario(rng: &mut ChaCha8Rng, m: usize, ties: bool, loose: usize) -> String {
    let n = 2 * m;
    let number = |rng: &mut ChaCha8Rng, size: f64| {
        if ties { f64::from(rng.random_range(-2..=2)) * size / 2.0 } else { rng.random_range(-size..size) }
    };
    // R = S (A Aᵀ/n + 0.05) S with S a contrast of stiffness up to 1e3 (none with ties).
    let a = DMatrix::from_fn(n, n, |_, _| number(rng, 1.0));
    let mut r = &a * a.transpose() / n as f64 + DMatrix::identity(n, n) * 0.05;
    if !ties {
        let s = DVector::from_fn(n, |_, _| 10f64.powf(rng.random_range(-0.75..0.75)));
        r = DMatrix::from_fn(n, n, |i, j| s[i] * r[(i, j)] * s[j]);
    }
    let mut kernel: Vec<Vec<f64>> = Vec::new();
    if loose > 0 {
        let z = DMatrix::from_fn(n, loose, |_, _| number(rng, 1.0)).qr().q();
        let keep = DMatrix::identity(n, n) - &z * z.transpose();
        r = &keep * r * &keep;
        kernel = z.column_iter().map(|z| z.iter().copied().collect()).collect();
    }
    let r = (&r + r.transpose()) * 0.5;
    let mut pair = |choices: &[f64]| choices[rng.random_range(0..choices.len())];
    let laws: Vec<&str> = (0..m)
        .map(|_| ["coulomb", "coulomb", "coulomb", "frictionless", "bound"][pair(&[0.0, 1.0, 2.0, 3.0, 4.0]) as usize])
        .collect();
    let one = |law: &[&str], pair: &mut dyn FnMut() -> f64| -> Vec<f64> {
        laws.iter().map(|l| if law.contains(l) { pair() } else { 0.0 }).collect()
    };
    let friction = one(&["coulomb"], &mut || {
        if ties { pair(&[0.0, 1.0, 2.0, 5.0]) } else { pair(&[0.0, 0.1, 0.4, 0.9, 1.3, 2.2, 3.7, 5.0]) }
    });
    let cohesion = one(&["coulomb"], &mut || pair(&[0.0, 0.0, 0.5, 1.0]));
    let gap = one(&["coulomb", "frictionless"], &mut || pair(&[0.0, 0.0, 1.0, 0.1]));
    let bound = one(&["bound"], &mut || pair(&[0.0, 0.5, 1.0]));
    let mut load: Vec<f64> = (0..n).map(|_| number(rng, 2.0)).collect();
    if loose > 0 {
        // Pulled apart on the whole: with this many pairs most would stand.
        load.iter_mut().take(m).for_each(|x| *x -= 0.75);
    }
    let mut system = serde_json::json!({
        "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(),
        "stiffness": r.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()).collect::<Vec<_>>(),
        "loads": { "load": { "vector": load } },
        "law": laws, "friction": friction, "cohesion": cohesion, "gap": gap, "bound": bound
    });
    if loose > 0 {
        system["kernel"] = serde_json::json!(kernel);
    }
    common::scenario_text(serde_json::json!({ "contact_system": system }))
}

/// Judges an answer from the file alone: λ = R (z − g) + RF over all 2m joints must be the reported forces, zero along
/// the tangents of frictionless pairs, and obey the laws.
fn judge(case: &common::Case, answer: &stickslip::answer::record::Answer, what: &str) -> f64 {
    let stickslip::model::scenario::Source::ContactSystem(given) = &case.scenario.source else {
        unreachable!("a contact system");
    };
    let m = given.pairs.len();
    let values = case.scenario.parameter_values();
    let z = DVector::from_fn(2 * m, |i, _| {
        let pair = &answer.pairs[i % m];
        if i >= m {
            return pair.z_t;
        }
        let gap = given.laws[i].numbers().into_iter().find(|(key, _)| *key == "gap");
        pair.z_n - gap.map_or(0.0, |(_, gap)| gap.value(&values))
    });
    let r = DMatrix::from_fn(2 * m, 2 * m, |i, j| given.matrix.rows()[i][j]);
    let force = &r * &z + DVector::from_column_slice(&given.loads[0].vector);
    let reported = DVector::from_fn(2 * m, |i, _| {
        let pair = &answer.pairs[i % m];
        if i < m { pair.x_n } else { pair.x_t }
    });
    // Against the terms that are summed.
    let scale = (r.abs() * z.abs()).max().max(force.amax()).max(reported.amax()).max(1.0);
    let off = (&force - &reported).amax() / scale;
    assert!(off < 1e-9, "{what}: forces off by {off:e}");
    let wrong = common::laws::violation(&case.scenario, &values, answer);
    assert!(wrong < 1e-9, "{what}: laws violated by {wrong:e}");
    off.max(wrong)
}

#[test]
fn mixed_laws_gaps_and_cohesion_always_answer_where_r_is_positive_definite() {
    let mut rng = ChaCha8Rng::seed_from_u64(20);
    for k in 0..1200 {
        let m = 1 + k % 20;
        let text = random_scenario(&mut rng, m, k % 3 == 0, 0);
        let case = common::Case::text(&text);
        let answer = case.solve(&[]);
        assert!(
            answer.is_answer() && !answer.marginal,
            "problem {k}, m = {m}: {:?} {:?} {:?}\n{text}",
            answer.outcome,
            answer.failure,
            answer.ray
        );
        judge(&case, &answer, &format!("problem {k}"));
    }
}

#[test]
fn only_a_gap_and_no_load() {
    // λ = R (z − g) is rounding of R g here: it must not be judged against itself.
    for (r, f) in
        [([[0.175, 0.25], [0.25, 0.675]], 0.0), ([[1.0, 0.3], [0.3, 0.7]], 0.4), ([[3.1, -0.7], [-0.7, 0.3]], 2.0)]
    {
        for gap in [0.1, 0.3, 1e-7] {
            let case = common::Case::text(&common::scenario_text(serde_json::json!({ "contact_system": {
                "pairs": ["c"], "stiffness": r, "loads": { "load": { "vector": [0, 0] } }, "friction": [f], "gap": [gap]
            } })));
            let answer = case.solve(&[]);
            common::is_answer(&answer);
            common::close("z_n", answer.pairs[0].z_n, gap, 1e-12);
            common::near("z_τ", answer.pairs[0].z_t, 0.0, 1e-12, gap);
            assert_eq!((answer.pairs[0].x_n, answer.pairs[0].x_t), (0.0, 0.0));
        }
    }
}

#[test]
fn every_rule_answers_right_or_says_so() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let (mut answers, mut rays) = (0, 0);
    for k in 0..150 {
        let text = random_scenario(&mut rng, 1 + k % 8, k % 2 == 0, 0);
        let case = common::Case::text(&text);
        for rules in common::all_rules() {
            let values = case.scenario.parameter_values();
            let Ok(solved) = case.prepared.case(&case.scenario, &values).under(rules).solve() else {
                continue; // `weight` without friction
            };
            let answer = solved.answer;
            if answer.is_answer() {
                answers += 1;
                judge(&case, &answer, &format!("problem {k} {rules:?}"));
            } else if let Some(ray) = &answer.ray {
                use stickslip::answer::record::RayClass;
                rays += 1;
                assert!(matches!(ray.class, RayClass::Artefact | RayClass::Fault), "problem {k} {rules:?}: {ray:?}");
            } else {
                // Only rules that may cycle may end otherwise.
                use stickslip::answer::record::OutcomeKind;
                assert_eq!(answer.outcome, OutcomeKind::PivotLimit, "problem {k} {rules:?}: {:?}", answer.failure);
                assert!(!matches!(rules.tie_break, TieBreak::Lexicographic | TieBreak::Natural));
            }
        }
    }
    assert!(answers > 1000 && rays > 50, "{answers} answers, {rays} rays");
}

#[test]
fn loose_parts_stand_or_their_ray_is_a_motion_the_loads_drive() {
    use stickslip::answer::record::RayClass;
    let mut rng = ChaCha8Rng::seed_from_u64(22);
    let (mut answers, mut mechanisms, mut others) = (0, 0, 0);
    for k in 0..600 {
        let m = 2 + k % 12;
        let text = random_scenario(&mut rng, m, false, 1 + k % 3);
        let case = common::Case::text(&text);
        let answer = case.solve(&[]);
        let what = format!("problem {k}, m = {m}");
        if answer.is_answer() {
            answers += 1;
            judge(&case, &answer, &what);
            continue;
        }
        let ray =
            answer.ray.as_ref().unwrap_or_else(|| panic!("{what}: {:?} {:?}\n{text}", answer.outcome, answer.failure));
        match ray.class {
            RayClass::Mechanism => mechanisms += 1,
            RayClass::NoEquilibrium => {
                others += 1;
                continue;
            }
            other => panic!("{what}: {other:?}\n{text}"),
        }
        // Over the joints that exist: no energy, and the loads work on it.
        let system = case.prepared.system().unwrap();
        let z = DVector::from_fn(system.joint_count(), |joint, _| {
            if joint < m {
                return ray.direction.pairs()[joint].z_n;
            }
            let pair = system.pairs.iter().position(|pair| pair.plane_tangential() == Some(joint));
            ray.direction.pairs()[pair.unwrap()].z_t.scalar()
        });
        assert!((&system.stiffness * &z).amax() <= 1e-9 * system.stiffness.amax(), "{what}");
        assert!(system.loads[0].vector.dot(&z) < 0.0, "{what}");
        assert!((z.amax() - 1.0).abs() < 1e-12, "{what}");
        for (i, pair) in system.pairs.iter().enumerate() {
            match pair.law {
                Law::Bound { .. } => assert_eq!(z[i], 0.0, "{what}"),
                _ => assert!(z[i] >= -1e-9, "{what}"),
            }
        }
    }
    println!("{answers} answers, {mechanisms} mechanisms, {others} without equilibrium");
    assert!(answers > 100 && mechanisms > 20, "{answers} answers, {mechanisms} mechanisms");
}
