//! Contact systems from files: what counts as a kernel, what is refused, frictionless pairs, compliances.

use crate::common::laws::violation;
use crate::common::{Case, close, is_answer, near, near_all, of_pairs, scenario_text};
use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, OutcomeKind, State, Verdict};
use stickslip::contact::schemes::exact_check::{ExactCheck, Finding};
use stickslip::model::load::load_text;
use stickslip::solve::exact::Exactly;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

fn system(value: Value) -> Value {
    json!({ "contact_system": value })
}

/// The whole message of a system that cannot be prepared.
fn refusal(value: Value) -> String {
    let scenario = load_text("test", &scenario_text(system(value)), None).expect("read");
    prepare(&scenario, &Quiet).expect_err("refused").to_string()
}

#[test]
fn a_contrast_of_stiffness_is_no_mechanism() {
    // Pair b: 1e-3 z_t − 1 = −f x_n = −0.5, so z_t = 500. A kernel by the ratio to the largest eigenvalue would let it go.
    let case = Case::json(system(json!({
        "pairs": ["a", "b"], "friction": [0.5, 0.5],
        "stiffness": [[1e9, 0, 0, 0], [0, 1e-3, 0, 0], [0, 0, 1e9, 0], [0, 0, 0, 1e-3]],
        "loads": { "w": { "vector": [1, 1, 0, -1] } }
    })));
    let answer = case.solve(&[]);
    is_answer(&answer);
    assert_eq!(answer.pairs[1].state, State::SlipPlus);
    close("z_t", answer.pairs[1].z_t, 500.0, 1e-15);
    assert!(answer.notes.is_empty(), "{:?}", answer.notes);
}

/// A free bar on two feet, whose R went through a transformation and back in f64: what that left between normal and tangential
/// joints would let the bar slide away until a foot lifts off, some 1e12 far. It holds up to f Σ W, and slides beyond.
#[test]
fn rounding_in_a_given_matrix_holds_no_body() {
    let weights = [38.943678582302404, 43.61013374999261];
    let limit = 0.3 * (weights[0] + weights[1]);
    for share in [0.999, 1.001, 1.5, 3.0] {
        let case = Case::json(system(json!({
            "pairs": ["c0", "c1"], "friction": [0.3, 0.3],
            "stiffness": [
                [1142.6525445880848, -1.6962085584452404e-11, -1.1283326004379415e-10, -3.8994167312218257e-11],
                [-1.6962085584452404e-11, 1131.2841904298778, -3.350073238754205e-11, 7.873610578487224e-11],
                [-1.1283326004379415e-10, -3.350073238754205e-11, 903869.257630761, -903869.2576307612],
                [-3.8994167312218257e-11, 7.873610578487224e-11, -903869.2576307612, 903869.2576307614]
            ],
            "loads": { "w": { "vector": [weights[0], weights[1], 0, 0] }, "h": { "vector": [0, 0, 0, -share * limit] } }
        })));
        let answer = case.solve(&[]);
        // All above the diagonal but that of the bar.
        let told = "5 entries of the contact stiffness matrix are what rounding leaves of zero";
        assert!(answer.notes.iter().any(|note| note.contains(told)), "{:?}", answer.notes);
        if share < 1.0 {
            is_answer(&answer);
            near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &weights, 1e-9);
        } else {
            let ray = answer.ray.unwrap_or_else(|| panic!("{share}: {:?}", answer.outcome));
            assert!(matches!(ray.verdict, Some(Verdict::Proved | Verdict::Certified)), "{share}: {:?}", ray.verdict);
        }
    }
}

#[test]
fn what_cancels_in_condensing_is_no_load() {
    // R = v vᵀ, RF = −v: with z_t released RF_n − R_nt RF_t / R_tt = 0, in f64 some 1e-17. z_n = 0 is an answer.
    let case = Case::json(system(json!({
        "pairs": ["c1"], "law": ["frictionless"],
        "stiffness": [[0.010000000000000002, 0.03], [0.03, 0.09]],
        "loads": { "w": { "vector": [-0.1, -0.3] } }
    })));
    let answer = case.solve(&[]);
    is_answer(&answer);
    assert_eq!((answer.pairs[0].z_n, answer.pairs[0].x_n), (0.0, 0.0));
    // 0.09 z_t = 0.3.
    close("z_t", answer.pairs[0].z_t, 0.3 / 0.09, 1e-14);
}

#[test]
fn a_large_bound_hides_no_other_pair() {
    // Identity: pair 1 opens by z_n = 1 and slides −0.5; pair 2 is held by 1e9 … 1e15.
    for bound in [1e9, 1e12, 1e15] {
        let case = Case::json(system(json!({
            "pairs": ["c1", "c2"], "law": ["coulomb", "bound"], "friction": [0.3, 0], "bound": [0, bound],
            "stiffness": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
            "loads": { "w": { "vector": [-1, 1, 0.5, 0.25] } }
        })));
        let answer = case.solve(&[]);
        is_answer(&answer);
        let pairs = &answer.pairs;
        assert_eq!((pairs[0].state, pairs[0].z_n, pairs[0].x_n, pairs[0].z_t), (State::Open, 1.0, 0.0, -0.5));
        assert_eq!((pairs[1].x_n, pairs[1].x_t), (1.0, 0.25), "bound {bound:e}");
    }
}

/// 9 (I − n nᵀ), n = (1, 2, 2)/3, in integers, with one more joint of stiffness 9 that nothing else feels; scaled by powers
/// of two.
fn loose(scale: [f64; 4]) -> Vec<Vec<f64>> {
    let integer = [[8.0, -2.0, 0.0, -2.0], [-2.0, 5.0, 0.0, -4.0], [0.0, 0.0, 9.0, 0.0], [-2.0, -4.0, 0.0, 5.0]];
    (0..4).map(|i| (0..4).map(|j| scale[i] * integer[i][j] * scale[j]).collect()).collect()
}

#[test]
fn the_kernel_is_found_by_the_digits_at_any_scale() {
    for scale in [[1.0; 4], [1024.0, 1.0 / 1024.0, 1.0, 32.0], [1.0 / 1024.0, 1.0, 1024.0, 1.0 / 32.0]] {
        // Motion D⁻¹ (1, 2, ·, 2): both pairs open; lifted off.
        let load: Vec<f64> = scale.iter().map(|d| -d).collect();
        let value = |rows: Vec<Vec<f64>>| {
            system(json!({ "pairs": ["a", "b"], "friction": [0.5, 0.5], "stiffness": rows,
                "loads": { "w": { "vector": load } } }))
        };
        let case = Case::json(value(loose(scale)));
        assert_eq!(case.prepared.system().unwrap().kernel.ncols(), 1, "{scale:?}");
        let answer = case.solve(&[]);
        assert_eq!(answer.outcome, OutcomeKind::Ray, "{scale:?}");
        assert!(answer.notes.is_empty(), "{:?}", answer.notes);
        // With a relative error of 1e-12 in one entry its digits say that it resists: an answer, and a word on it.
        let mut rows = loose(scale);
        rows[0][0] *= 1.0 + 1e-12;
        let case = Case::json(value(rows));
        assert_eq!(case.prepared.system().unwrap().kernel.ncols(), 0, "{scale:?}");
        let answer = case.solve(&[]);
        let told = answer.notes.iter().find(|note| note.contains("nearly singular")).expect("a word");
        assert!(told.contains("z_n of a") && told.contains("z_t of b") && told.contains("`kernel`"), "{told}");
        assert!(!told.contains("z_t of a"), "{told}");
    }
}

#[test]
fn indefinite_and_asymmetric_are_told_after_scaling() {
    let text = refusal(json!({ "pairs": ["a"], "stiffness": [[1e9, 0], [0, -1e-3]], "loads": {} }));
    assert!(
        text.contains("contact_system.stiffness: the contact stiffness matrix is not positive semidefinite"),
        "{text}"
    );
    // Beside 1e9 an entry of 1e-6 is nothing; of two joints of 1e-3 it is a thousandth.
    let rows = json!([[1e9, 0, 0, 0], [0, 1e-3, 0, 1e-6], [0, 0, 1e9, 0], [0, 0, 0, 1e-3]]);
    let text = scenario_text(system(json!({ "pairs": ["a", "b"], "stiffness": rows, "loads": {} })));
    let problems = load_text("test", &text, None).unwrap_err().to_string();
    assert!(problems.contains("the matrix is not symmetric: row 4, column 2 is 0, row 2, column 4 is"), "{problems}");
}

/// R of full rank with scales 1e±2, of n joints.
fn random_matrix(rng: &mut ChaCha8Rng, n: usize) -> DMatrix<f64> {
    let a = DMatrix::from_fn(n, n, |_, _| rng.random_range(-1.0..1.0));
    let s = DVector::from_fn(n, |_, _| 10f64.powf(rng.random_range(-2.0..2.0)));
    let r = &a * a.transpose() + DMatrix::identity(n, n) * 0.3;
    DMatrix::from_fn(n, n, |i, j| s[i] * (r[(i, j)] + r[(j, i)]) * 0.5 * s[j])
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

#[test]
fn a_compliance_answers_as_its_stiffness_and_obeys_its_own_rows() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut moved = 0;
    for k in 0..60 {
        let m = 1 + k % 5;
        let r = random_matrix(&mut rng, 2 * m);
        let w = r.clone().try_inverse().expect("regular");
        let w = (&w + w.transpose()) * 0.5;
        let load = DVector::from_fn(2 * m, |i, _| rng.random_range(-1.0..1.0) * r[(i, i)].sqrt());
        let free = -(&w * &load);
        let law: Vec<&str> = (0..m).map(|i| ["coulomb", "frictionless", "bound"][(i + k) % 3]).collect();
        let of = |law: &[&str], which: &str, value: f64| -> Vec<f64> {
            law.iter().map(|law| if *law == which { value } else { 0.0 }).collect()
        };
        let (friction, bound) = (of(&law, "coulomb", 0.6), of(&law, "bound", 0.2));
        let gap: Vec<f64> = law.iter().map(|law| if *law == "bound" { 0.0 } else { 0.01 * (k % 2) as f64 }).collect();
        let value = |key: &str, matrix: &DMatrix<f64>, vector: &DVector<f64>| {
            let mut value = json!({ "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "law": law,
                "friction": friction, "bound": bound, "gap": gap,
                "loads": { "w": { "vector": vector.as_slice() } } });
            value[key] = json!(rows(matrix));
            Case::json(system(value))
        };
        let by_stiffness = value("stiffness", &r, &load).solve(&[]);
        let by_compliance = value("compliance", &w, &free).solve(&[]);
        is_answer(&by_stiffness);
        is_answer(&by_compliance);
        let (a, b) = (&by_stiffness.pairs, &by_compliance.pairs);
        let root = |i: usize| r[(i, i)].sqrt();
        let force = (0..m).map(|i| (a[i].x_n / root(i)).abs().max((a[i].x_t / root(m + i)).abs())).fold(1.0, f64::max);
        for i in 0..m {
            near("x_n", b[i].x_n, a[i].x_n, 1e-9, force * root(i));
            near("x_t", b[i].x_t, a[i].x_t, 1e-9, force * root(m + i));
            near("z_n", b[i].z_n, a[i].z_n, 1e-9, force / root(i));
            near("z_t", b[i].z_t, a[i].z_t, 1e-9, force / root(m + i));
            moved += usize::from(b[i].z_n > 0.0 || b[i].z_t != 0.0);
        }
        // z = W λ + v + (g, 0), row by row.
        let lambda = DVector::from_fn(2 * m, |i, _| if i < m { b[i].x_n } else { b[i - m].x_t });
        for i in 0..2 * m {
            let (z, gap) = if i < m { (b[i].z_n, gap[i]) } else { (b[i - m].z_t, 0.0) };
            let terms: f64 = w.row(i).iter().zip(lambda.iter()).map(|(w, x)| (w * x).abs()).sum();
            let left = z - gap - free[i] - w.row(i).transpose().dot(&lambda);
            near("row of W", left, 0.0, 1e-12, terms + free[i].abs() + gap + z.abs());
        }
    }
    assert!(moved > 60, "{moved}");
}

/// A state that obeys the laws under a singular W = G Gᵀ: (λ, z, friction, bound, gap) of m pairs.
fn random_state(rng: &mut ChaCha8Rng, law: &[&str], f: f64, r_f: f64) -> (DVector<f64>, DVector<f64>) {
    let m = law.len();
    let (mut force, mut z) = (DVector::zeros(2 * m), DVector::zeros(2 * m));
    for i in 0..m {
        let bilateral = law[i] == "bound";
        if !bilateral && rng.random_bool(0.3) {
            z[i] = rng.random_range(0.0..1.0);
            z[m + i] = rng.random_range(-1.0..1.0);
            continue;
        }
        force[i] = if bilateral { rng.random_range(-1.0..1.0) } else { rng.random_range(0.0..1.0) };
        let bound = match law[i] {
            "coulomb" => f * force[i],
            "bound" => r_f,
            _ => 0.0,
        };
        match rng.random_range(0..3) {
            0 => force[m + i] = bound * rng.random_range(-1.0..1.0),
            side => {
                let sign = if side == 1 { 1.0 } else { -1.0 };
                (force[m + i], z[m + i]) = (-sign * bound, sign * rng.random_range(0.0..1.0));
            }
        }
    }
    (force, z)
}

/// Problems made from an answer, so that there is one; what is found obeys W and the laws, each judged by itself.
#[test]
fn a_singular_compliance_is_solved_from_its_own_rows() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (mut tried, mut answered, mut shared) = (0, 0, 0);
    for k in 0..200 {
        let m = 1 + k % 6;
        let laws: &[&str] =
            if k % 4 == 0 { &["coulomb", "frictionless", "bound"] } else { &["coulomb", "frictionless"] };
        let law: Vec<&str> = (0..m).map(|i| laws[(i + k / 7) % laws.len()]).collect();
        let kept: Vec<usize> = (0..2 * m).filter(|&row| row < m || law[row - m] != "frictionless").collect();
        // As many bound normals as there are must move.
        let rank = rng.random_range(0..kept.len()).max(law.iter().filter(|law| **law == "bound").count());
        let whole = k % 2 == 0;
        let g = DMatrix::from_fn(2 * m, rank, |_, _| {
            let value: f64 = rng.random_range(-2.5..2.5);
            if whole { value.round() } else { value }
        });
        let w = &g * g.transpose();
        let (f, r_f) = ([0.2, 0.5, 0.0][k % 3], 0.3);
        let (force, z) = random_state(&mut rng, &law, f, r_f);
        let free = &z - &w * &force;
        let gap: Vec<f64> = law.iter().map(|law| if *law == "bound" { 0.0 } else { 0.25 * (k % 2) as f64 }).collect();
        let vector = DVector::from_fn(2 * m, |i, _| free[i] - if i < m { gap[i] } else { 0.0 });
        let of = |which: &str, value: f64| -> Vec<f64> {
            law.iter().map(|law| if *law == which { value } else { 0.0 }).collect()
        };
        let case = system(json!({ "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "law": law,
            "friction": of("coulomb", f), "bound": of("bound", r_f), "gap": gap, "compliance": rows(&w),
            "loads": { "w": { "vector": vector.as_slice() } } }));
        let text = scenario_text(case);
        let scenario = load_text("test", &text, None).expect("a scenario");
        let Ok(prepared) = prepare(&scenario, &Quiet) else {
            assert!(law.contains(&"bound"));
            continue;
        };
        let case = Case { scenario, prepared };
        let answer = case.solve(&[]);
        tried += 1;
        if let Some(ray) = &answer.ray {
            assert_ne!(ray.verdict, Some(Verdict::Certified), "{k}: there is an answer");
            continue;
        }
        assert!(answer.is_answer(), "{k} {law:?} {text}");
        answered += 1;
        shared += usize::from(answer.notes.iter().any(|note| note.contains("least norm")));
        let pairs = &answer.pairs;
        let lambda = DVector::from_fn(2 * m, |i, _| if i < m { pairs[i].x_n } else { pairs[i - m].x_t });
        for i in 0..2 * m {
            let (z, gap) = if i < m { (pairs[i].z_n, gap[i]) } else { (pairs[i - m].z_t, 0.0) };
            let terms: f64 = w.row(i).iter().zip(lambda.iter()).map(|(w, x)| (w * x).abs()).sum();
            let left = z - gap - vector[i] - w.row(i).transpose().dot(&lambda);
            near(&format!("{k}: row {i} of W"), left, 0.0, 1e-12, terms + vector[i].abs() + gap + z.abs() + 1e-3);
        }
        let values = case.scenario.parameter_values();
        assert!(violation(&case.scenario, &values, &answer) < 1e-11, "{k}");
    }
    assert!(tried > 180 && answered >= tried - 4, "{answered} of {tried}");
    assert!(shared > 20, "{shared}");
}

/// z − v − W λ of each row and the laws, of an answer under a compliance without gaps.
fn obeys_compliance(case: &Case, w: &DMatrix<f64>, vector: &[f64], answer: &Answer) {
    let m = answer.pairs.len();
    let pick = |i: usize, normal: f64, tangential: f64| if i < m { normal } else { tangential };
    let pair = |i: usize| &answer.pairs[i % m];
    let lambda = DVector::from_fn(2 * m, |i, _| pick(i, pair(i).x_n, pair(i).x_t));
    for (i, free) in vector.iter().enumerate() {
        let z = pick(i, pair(i).z_n, pair(i).z_t);
        // Forces that share what a pair carries are known to a few ε of the largest.
        let terms = w.row(i).abs().sum() * lambda.amax();
        let left = z - free - w.row(i).transpose().dot(&lambda);
        near(&format!("row {i} of W"), left, 0.0, 1e-13, terms + free.abs() + z.abs());
    }
    assert!(violation(&case.scenario, &case.scenario.parameter_values(), answer) < 1e-11, "{:?}", answer.pairs);
}

#[test]
fn a_force_that_moves_nothing_is_no_rounding() {
    // W_ττ = 0: z_n = x_n − 2 = 0, and z_t = 5 whatever x_t is, which friction makes −0.8 · 2.
    let case = Case::json(system(json!({ "pairs": ["a"], "friction": [0.8], "compliance": [[1, 0], [0, 0]],
        "loads": { "w": { "vector": [-2, 5] } } })));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let a = &answer.pairs[0];
    assert_eq!((a.state, a.x_n, a.x_t, a.z_t), (State::SlipPlus, 2.0, -1.6, 5.0));
}

#[test]
fn what_a_reserve_leaves_of_a_bound_by_rounding_moves_nothing() {
    // a open, b closed and sticking with x_t = 0, x_n = 4/10: z = (8·0.4 − 3, 10·0.4 − 4, 2 − 10·0.4, 0) is one answer.
    let w = [[8.0, 8.0, -8.0, -4.0], [8.0, 10.0, -10.0, 0.0], [-8.0, -10.0, 10.0, 0.0], [-4.0, 0.0, 0.0, 10.0]];
    let vector = [-3.0, -4.0, 2.0, 0.0];
    let case = Case::json(system(json!({ "pairs": ["a", "b"], "friction": [0.5, 0.8], "compliance": w,
        "loads": { "w": { "vector": vector } } })));
    let answer = case.solve(&[]);
    is_answer(&answer);
    obeys_compliance(&case, &DMatrix::from_fn(4, 4, |i, j| w[i][j]), &vector, &answer);
}

/// Small whole numbers, in which zeros and ties are exact: λ and z are chosen by the laws first, and W and v = z − W λ follow,
/// so that there is an answer, which must be found and not be refused.
#[test]
fn whole_numbers_made_from_an_answer_are_answered() {
    let mut rng = ChaCha8Rng::seed_from_u64(17);
    let mut answered = 0;
    for k in 0..300 {
        let m = 1 + k % 3;
        let rank = rng.random_range(1..2 * m);
        let g = DMatrix::from_fn(2 * m, rank, |_, _| f64::from(rng.random_range(-2..=2)));
        let w = &g * g.transpose();
        let tenths: Vec<i32> = (0..m).map(|_| [0, 3, 5, 8][rng.random_range(0..4)]).collect();
        let (mut force, mut z) = (DVector::zeros(2 * m), DVector::zeros(2 * m));
        for i in 0..m {
            if rng.random_bool(0.3) {
                (z[i], z[m + i]) = (f64::from(rng.random_range(0..4)), f64::from(rng.random_range(-3..4)));
                continue;
            }
            // x_n in tens: the bound is whole.
            let tens = rng.random_range(0..3);
            force[i] = f64::from(10 * tens);
            let bound = f64::from(tenths[i] * tens);
            match rng.random_range(-1..=1) {
                0 => force[m + i] = f64::from(rng.random_range(-tenths[i] * tens..=tenths[i] * tens)),
                side => {
                    (force[m + i], z[m + i]) = (-f64::from(side) * bound, f64::from(side * rng.random_range(0..4)));
                }
            }
        }
        let vector = &z - &w * &force;
        let friction: Vec<f64> = tenths.iter().map(|tenths| f64::from(*tenths) / 10.0).collect();
        let case = Case::json(system(json!({ "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(),
            "friction": friction, "compliance": rows(&w), "loads": { "w": { "vector": vector.as_slice() } } })));
        let answer = case.solve(&[]);
        if let Some(ray) = &answer.ray {
            assert_ne!(ray.verdict, Some(Verdict::Certified), "{k}: there is an answer");
            continue;
        }
        assert!(answer.is_answer(), "{k}: {friction:?} {w} {vector} {force} {z} {answer:?}");
        obeys_compliance(&case, &w, vector.as_slice(), &answer);
        answered += 1;
    }
    assert!(answered >= 297, "{answered}");
}

#[test]
fn a_compliance_of_one_direction() {
    // Both joints move along one direction, so x_n + x_t counts: z_n = z_t = x_n + x_t − 2. Closed and sticking: x_n + x_t =
    // 2 with |x_t| ≤ x_n/2; of least norm is (1, 1) without friction's bound, (4/3, 2/3) with it.
    let case = Case::json(system(json!({ "pairs": ["a"], "friction": [0.5], "compliance": [[1, 1], [1, 1]],
        "loads": { "w": { "vector": [-2, -2] } } })));
    let answer = case.solve(&[]);
    is_answer(&answer);
    near("x_n", answer.pairs[0].x_n, 4.0 / 3.0, 1e-14, 1.0);
    near("x_t", answer.pairs[0].x_t, 2.0 / 3.0, 1e-14, 1.0);
    // The tangent of a frictionless pair carries no force: W of the others is what counts.
    let case = Case::json(system(json!({ "pairs": ["a"], "law": ["frictionless"], "compliance": [[1, 1], [1, 1]],
        "loads": { "w": { "vector": [-2, 1] } } })));
    // Closed: z_n = x_n − 2 = 0, z_t = x_n + 1.
    let answer = case.solve(&[]);
    is_answer(&answer);
    assert_eq!((answer.pairs[0].x_n, answer.pairs[0].z_t), (2.0, 3.0));
    // A joint held both ways that no force moves.
    let text =
        refusal(json!({ "pairs": ["a"], "law": ["bound"], "bound": [1], "compliance": [[0, 0], [0, 1]], "loads": {} }));
    assert!(text.contains("contact_system.compliance: pair a is held along n both ways"), "{text}");
}

#[test]
fn the_exact_check_has_the_data_of_the_file() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let mut proved = 0;
    for k in 0..20 {
        let m = 2 + k % 3;
        let r = random_matrix(&mut rng, 2 * m);
        let load = DVector::from_fn(2 * m, |i, _| rng.random_range(-1.0..1.0) * r[(i, i)].sqrt());
        let law: Vec<&str> = (0..m).map(|i| if i == 0 { "frictionless" } else { "coulomb" }).collect();
        let friction: Vec<f64> = law.iter().map(|law| if *law == "coulomb" { 0.5 } else { 0.0 }).collect();
        let case =
            Case::json(system(json!({ "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "law": law,
            "friction": friction, "stiffness": rows(&r), "loads": { "w": { "vector": load.as_slice() } } })));
        let solved = case.solved(&[], case.scenario.rules);
        is_answer(&solved.answer);
        let Ok(Exactly::Contact(ExactCheck { finding, .. })) = case.prepared.check_exactly(&solved, &Quiet) else {
            panic!("a contact problem");
        };
        assert!(matches!(finding, Finding::Proved { .. }), "{finding:?}");
        proved += 1;
    }
    assert_eq!(proved, 20);
    // R = v vᵀ exactly, v = (1, 3), and RF_n too small by one digit: closed up to rounding, but x_n < 0 in the data.
    let case = Case::json(system(json!({ "pairs": ["c"], "law": ["frictionless"], "stiffness": [[2, 3], [3, 9]],
        "loads": { "w": { "vector": [-1.0000000000000002, -3] } } })));
    let solved = case.solved(&[], case.scenario.rules);
    let found = case.prepared.check_exactly(&solved, &Quiet).expect("checked");
    let Exactly::Contact(check) = found else { panic!("a contact problem") };
    assert!(matches!(check.finding, Finding::Refuted { .. }) || solved.answer.pairs[0].z_n > 0.0, "{check:?}");
}

/// Pairs on springs along the normals, R_nn = [3 1; 1 5], that slide away at no cost. The load pulls b open by 1/5, which
/// presses a by 2 + 1/5: it slides under more than f · 2.2, and that is certified, of this load.
#[test]
fn a_pair_on_a_spring_slides_while_another_is_open() {
    let mut stiffness = vec![vec![0.0; 6]; 6];
    (stiffness[0][0], stiffness[0][1], stiffness[1][0], stiffness[1][1]) = (3.0, 1.0, 1.0, 5.0);
    let case = Case::json(json!({
        "parameters": { "T": 1 },
        "contact_system": {
            "pairs": ["a", "b"], "tangents": 2, "stiffness": stiffness, "friction": [0.5, 0.5],
            "loads": { "weight": { "vector": [2, -1, 0, 0, 0, 0] },
                       "pull": { "factor": "T", "vector": [0, 0, 0.6, 0.8, 0, 0] } }
        }
    }));
    for excess in [1e-1, 1e-4, 1e-8] {
        let ray = case.solve(&[("T", 1.1 * (1.0 + excess))]).ray.expect("it slides");
        assert_eq!((ray.verdict, ray.of_this_load), (Some(Verdict::Certified), true), "{excess:e}: {ray:?}");
        let answer = case.solve(&[("T", 1.1 * (1.0 - excess))]);
        is_answer(&answer);
        near_all("x", &of_pairs(&answer, |pair| pair.x_n), &[2.2, 0.0], 1e-12);
        near_all("z", &of_pairs(&answer, |pair| pair.z_n), &[0.0, 0.2], 1e-12);
    }
}
