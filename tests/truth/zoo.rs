//! Small LCPs with known answers (validation, "A zoo of LCPs"), through the working-scheme engine.

use std::ops::ControlFlow;
use std::sync::Arc;

use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::answer::attempt::{AttemptCovering, AttemptEngine, PlainCovering};
use stickslip::answer::record::{OutcomeKind, Verdict};
use stickslip::explain::plain_ray::PlainRay;
use stickslip::lcp::basis::Basis;
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::mirrored::MirroredLcp;
use stickslip::lcp::outcome::{Outcome, Run};
use stickslip::lcp::problem::{Lcp, Scale};
use stickslip::lcp::ratio_test::TieRule;
use stickslip::model::load::load_text;
use stickslip::solve::{Solved, prepare};
use stickslip::watch::Quiet;

use super::classes::shuffled;

fn solve(matrix: Vec<Vec<f64>>, q: Vec<f64>, rule: Option<TieRule>) -> Run {
    let n = q.len();
    let scale = Scale::plain(&matrix);
    let lcp = Lcp { matrix, q, covering: vec![1.0; n], scale };
    let rule = rule.unwrap_or_else(|| TieRule::Lexicographic((0..n).collect()));
    let mut engine = SchemeEngine::new(Arc::new(MirroredLcp::plain(&lcp)), rule);
    run(&mut engine, 10_000, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn cottle_pang_stone_4_4_7_in_five_pivots() {
    let m = vec![vec![0.0, -1.0, 2.0], vec![2.0, 0.0, -2.0], vec![-1.0, 1.0, 0.0]];
    let run = solve(m, vec![-3.0, 6.0, -1.0], None);
    assert_eq!(run.outcome, Outcome::Normal { marginal: false });
    assert_eq!(run.pivots.count(), 5);
    for (z, expected) in run.point.z.iter().zip([0.0, 1.0, 3.0]) {
        assert!((z - expected).abs() < 1e-14);
    }
}

#[test]
fn continuum_4_1_14() {
    let run = solve(vec![vec![1.0; 2]; 2], vec![-1.0; 2], None);
    assert_eq!(run.outcome, Outcome::Normal { marginal: false });
    assert!((run.point.z[0] + run.point.z[1] - 1.0).abs() < 1e-15);
}

#[test]
fn bimatrix_4_4_23_ends_in_a_ray_at_the_first_pivot() {
    let m = vec![
        vec![0.0, 0.0, 10.0, 20.0],
        vec![0.0, 0.0, 30.0, 15.0],
        vec![10.0, 20.0, 0.0, 0.0],
        vec![30.0, 15.0, 0.0, 0.0],
    ];
    let run = solve(m, vec![-1.0; 4], None);
    assert!(matches!(run.outcome, Outcome::Ray(_)), "{:?}", run.outcome);
    assert_eq!(run.pivots.count(), 1);
}

fn murty(n: usize) -> (Vec<Vec<f64>>, Vec<f64>) {
    let m = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| {
                    if i == j {
                        1.0
                    } else if j < i {
                        2.0
                    } else {
                        0.0
                    }
                })
                .collect()
        })
        .collect();
    let q = (1..=n).map(|i| -(n + 1 - i..=n).map(|j| 2f64.powi(j as i32)).sum::<f64>()).collect();
    (m, q)
}

#[test]
fn murty_takes_two_to_the_n_pivots() {
    for n in 2..=9 {
        let (m, q) = murty(n);
        if n == 6 {
            assert_eq!(q, [-64.0, -96.0, -112.0, -120.0, -124.0, -126.0]);
        }
        let run = solve(m, q, None);
        assert_eq!(run.outcome, Outcome::Normal { marginal: false });
        assert_eq!(run.pivots.count(), 1 << n, "n = {n}");
    }
}

#[test]
fn cycling_under_first_row_ends_in_four_pivots_under_lexicographic() {
    let m = vec![vec![1.0, 2.0, 0.0], vec![0.0, 1.0, 2.0], vec![2.0, 0.0, 1.0]];
    let run = solve(m.clone(), vec![-1.0; 3], Some(TieRule::FirstRow));
    assert!(matches!(run.outcome, Outcome::Cycle(_)), "{:?}", run.outcome);
    let run = solve(m, vec![-1.0; 3], None);
    assert_eq!(run.outcome, Outcome::Normal { marginal: false });
    assert_eq!(run.pivots.count(), 4);
    for z in run.point.z {
        assert!((z - 1.0 / 3.0).abs() < 1e-15);
    }
}

#[test]
fn painleve_rod() {
    assert!(matches!(solve(vec![vec![-0.05]], vec![-1.0], None).outcome, Outcome::Ray(_)));
    assert_eq!(solve(vec![vec![-0.05]], vec![1.0], None).outcome, Outcome::Trivial);
}

/// w_i and the sum of the magnitudes of its terms in rationals: what an answer is worth, whatever the program says.
pub(super) fn worst_violation(matrix: &[Vec<f64>], q: &[f64], z: &[f64]) -> f64 {
    let exact = |x: f64| BigRational::from_float(x).expect("finite");
    assert!(z.iter().all(|z| *z >= 0.0), "{z:?}");
    let mut worst = 0.0f64;
    for (i, row) in matrix.iter().enumerate() {
        let terms: Vec<BigRational> =
            row.iter().zip(z).map(|(m, z)| exact(*m) * exact(*z)).chain([exact(q[i])]).collect();
        let w: BigRational = terms.iter().sum();
        let size: BigRational = terms.iter().map(|term| term.abs()).sum();
        if !size.is_zero() {
            let share = (w / size).to_f64().expect("at most 1");
            worst = worst.max(if z[i] > 0.0 { share.abs() } else { -share });
        }
    }
    worst
}

fn scenario(matrix: &[Vec<f64>], q: &[f64], covering: Option<&[f64]>) -> String {
    let covering = covering.map_or(String::new(), |d| format!(", \"covering\": {d:?}"));
    format!(
        "{{\"format\": \"stickslip/1\", \"title\": \"an lcp\", \"lcp\": {{\"M\": {matrix:?}, \"q\": {q:?}{covering}}}}}"
    )
}

/// Solved as a user's scenario, with retries.
pub(super) fn solved(matrix: &[Vec<f64>], q: &[f64], covering: Option<&[f64]>) -> Solved {
    let scenario = load_text("lcp", &scenario(matrix, q, covering), None).expect("a scenario");
    let prepared = prepare(&scenario, &Quiet).expect("prepared");
    prepared.case(&scenario, &scenario.parameter_values()).solve().expect("solved")
}

/// A bimatrix game of k × k with integer costs in copositive form: strategies x, y and the two values, each as a
/// difference of two unknowns. Every vertex of the run is highly degenerate.
fn game(k: usize, random: &mut ChaCha8Rng) -> (Vec<Vec<f64>>, Vec<f64>) {
    let n = 2 * k + 4;
    let (mut m, mut q) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for i in 0..k {
        for j in 0..k {
            m[i][k + j] = f64::from(random.random_range(1..1000));
            m[k + i][j] = f64::from(random.random_range(1..1000));
        }
        for (sign, value) in [(1.0, 0), (-1.0, 1)] {
            (m[i][2 * k + value], m[2 * k + value][i]) = (sign, -sign);
            (m[k + i][2 * k + 2 + value], m[2 * k + 2 + value][k + i]) = (sign, -sign);
        }
    }
    for value in 0..4 {
        q[2 * k + value] = if value % 2 == 0 { 1.0 } else { -1.0 };
    }
    (m, q)
}

/// The kind of `game18-cycle`: one rate that is noise widened the tie test until all rows tied, and the lexicographic rule
/// went round for ever. Exact arithmetic has no such trouble, so every one of these has an answer.
#[test]
fn degenerate_games_do_not_cycle_under_the_lexicographic_rule() {
    let mut random = ChaCha8Rng::seed_from_u64(18);
    for case in 0..100 {
        let k = random.random_range(4..26);
        let (m, q) = game(k, &mut random);
        let run = solve(m.clone(), q.clone(), None);
        assert!(matches!(run.outcome, Outcome::Normal { .. }), "case {case}, k {k}: {:?}", run.outcome);
        assert!(run.pivots.count() < 1000, "case {case}, k {k}: {} pivots", run.pivots.count());
        let solved = solved(&m, &q, None);
        assert_eq!(solved.answer.outcome, OutcomeKind::Normal, "case {case}");
        assert_eq!(solved.answer.attempts.len(), 1, "case {case}");
        let z = &solved.answer.solution.as_ref().expect("of an lcp").z;
        assert!(worst_violation(&m, &q, z) <= 1e-13, "case {case}");
    }
}

/// A time step of discs with friction in the form of Stewart & Trinkle (1996): rows r_n, t⁺, t⁻, λ for each of m contacts of
/// a stack of discs, M = [N, D]ᵀ W [N, D] bordered by the cone μ r_n − t⁺ − t⁻ and by λ. Its answers have rows in which all
/// terms are zero up to rounding.
fn stewart_trinkle(m: usize, random: &mut ChaCha8Rng) -> (Vec<Vec<f64>>, Vec<f64>) {
    // Contact c joins body c to body c + 1 of a chain; three velocities a body; normal (0, 1) tilted a little.
    let bodies = m + 1;
    let mut jacobian = vec![vec![0.0; 3 * bodies]; 2 * m];
    let mut relative = vec![0.0; 2 * m];
    for c in 0..m {
        let angle: f64 = random.random_range(-0.5..0.5);
        let (n, t) = ([angle.sin(), angle.cos()], [angle.cos(), -angle.sin()]);
        for (side, sign) in [(c, -1.0), (c + 1, 1.0)] {
            for axis in 0..2 {
                jacobian[c][3 * side + axis] = sign * n[axis];
                jacobian[m + c][3 * side + axis] = sign * t[axis];
            }
            jacobian[m + c][3 * side + 2] = 0.05;
        }
        // About half of the contacts part by themselves.
        relative[c] = random.random_range(-1.0..1.0);
        relative[m + c] = random.random_range(-1.0..1.0);
    }
    let mobility: Vec<f64> =
        (0..3 * bodies).map(|k| random.random_range(100.0..1000.0) * if k % 3 == 2 { 400.0 } else { 1.0 }).collect();
    let response =
        |a: usize, b: usize| -> f64 { (0..3 * bodies).map(|k| jacobian[a][k] * mobility[k] * jacobian[b][k]).sum() };
    let (mut matrix, mut q) = (vec![vec![0.0; 4 * m]; 4 * m], vec![0.0; 4 * m]);
    // The joint behind a row, and its sign.
    let joint = |row: usize| match row / m {
        0 => (row, 1.0),
        1 => (row, 1.0),
        _ => (row - m, -1.0),
    };
    for a in 0..3 * m {
        let (i, s) = joint(a);
        q[a] = s * relative[i];
        for (b, entry) in matrix[a].iter_mut().enumerate().take(3 * m) {
            let (j, r) = joint(b);
            *entry = s * r * response(i, j);
        }
    }
    for c in 0..m {
        matrix[m + c][3 * m + c] = 1.0;
        matrix[2 * m + c][3 * m + c] = 1.0;
        matrix[3 * m + c][c] = 0.5;
        matrix[3 * m + c][m + c] = -1.0;
        matrix[3 * m + c][2 * m + c] = -1.0;
    }
    (matrix, q)
}

/// The kind of `st-small` and `fc2d-gran40`: right answers were refused, since a row of noise was measured against itself.
#[test]
fn time_steps_with_friction_are_answered_at_the_first_attempt() {
    let mut random = ChaCha8Rng::seed_from_u64(40);
    for case in 0..40 {
        let m = random.random_range(2..25);
        let (matrix, q) = stewart_trinkle(m, &mut random);
        let solved = solved(&matrix, &q, None);
        let answer = &solved.answer;
        assert_eq!((answer.outcome, answer.attempts.len()), (OutcomeKind::Normal, 1), "case {case}, m {m}: {answer:?}");
        let z = &answer.solution.as_ref().expect("of an lcp").z;
        assert!(worst_violation(&matrix, &q, z) <= 1e-13, "case {case}");
    }
}

/// Other units of single rows and columns (powers of two, exact) are the same problem.
#[test]
fn units_of_rows_and_columns_change_nothing() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for case in 0..60 {
        let n = random.random_range(2..12);
        // Diagonally dominant: a P-matrix, one answer.
        let matrix: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| if i == j { n as f64 } else { random.random_range(-1.0..1.0) }).collect())
            .collect();
        let q: Vec<f64> = (0..n).map(|_| random.random_range(-1.0..1.0)).collect();
        let mut units = || -> Vec<f64> { (0..n).map(|_| f64::powi(2.0, random.random_range(-30..30))).collect() };
        let (rows, columns) = (units(), units());
        let scaled: Vec<Vec<f64>> =
            (0..n).map(|i| (0..n).map(|j| rows[i] * matrix[i][j] * columns[j]).collect()).collect();
        let scaled_q: Vec<f64> = (0..n).map(|i| rows[i] * q[i]).collect();
        let plain = solved(&matrix, &q, None).answer;
        let other = solved(&scaled, &scaled_q, Some(&rows)).answer;
        assert!(plain.is_answer() && other.is_answer(), "case {case}: {:?} {:?}", plain.outcome, other.outcome);
        assert_eq!((plain.pivot_count, other.attempts.len()), (other.pivot_count, 1), "case {case}");
        let (a, b) = (plain.solution.expect("z").z, other.solution.expect("z").z);
        for k in 0..n {
            let back = b[k] * columns[k];
            assert!((back - a[k]).abs() <= 1e-12 * a[k].abs().max(1e-300), "case {case}: {back} {}", a[k]);
        }
    }
}

/// Murty's example 2.11: the given d ends in a ray, d = e in the only answer, z = (27, 22.75) by M z = −q; also beside idle
/// rows w = z + 1, which put enumeration out of reach.
#[test]
fn another_covering_is_tried_after_a_ray() {
    for idle in [0, 12] {
        let n = 2 + idle;
        let mut matrix = vec![vec![0.0; n]; n];
        (0..n).for_each(|i| matrix[i][i] = 1.0);
        matrix[0][..2].copy_from_slice(&[-1.5, 2.0]);
        matrix[1][..2].copy_from_slice(&[-4.0, 4.0]);
        let (mut q, mut d) = (vec![1.0; n], vec![1.0; n]);
        q[..2].copy_from_slice(&[-5.0, 17.0]);
        d[..2].copy_from_slice(&[5.0, 16.0]);
        let answer = solved(&matrix, &q, Some(&d)).answer;
        assert_eq!(answer.outcome, OutcomeKind::Normal);
        assert_eq!(
            (answer.attempts[0].rules.covering, answer.attempts[0].outcome),
            (AttemptCovering::Plain(PlainCovering::Given), OutcomeKind::Ray)
        );
        assert_eq!((answer.rules.covering, answer.pivot_count), (AttemptCovering::Plain(PlainCovering::Ones), 3));
        let z = answer.solution.expect("z").z;
        assert!((z[0] - 27.0).abs() <= 1e-12 && (z[1] - 22.75).abs() <= 1e-12, "{z:?}");
    }
}

/// Fathi's example, M = A Aᵀ of Murty's triangular A and q = −e: 2ⁿ pivots under the default rules, with e₁
/// the answer, because the first column of M is (1, 2, 2, …). It is found by another covering in the two pivots that bring z₁ in.
#[test]
fn a_path_of_exponential_length_is_left_for_another_covering() {
    let n = 15;
    let (a, _) = murty(n);
    let product = |i: usize, j: usize| (0..n).map(|k| a[i][k] * a[j][k]).sum();
    let matrix: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| product(i, j)).collect()).collect();
    let answer = solved(&matrix, &vec![-1.0; n], None).answer;
    assert_eq!(answer.attempts[0].outcome, OutcomeKind::PivotLimit);
    assert_eq!((answer.outcome, answer.pivot_count, answer.attempts.len()), (OutcomeKind::Normal, 2, 2));
    let z = answer.solution.expect("z").z;
    assert!(z.iter().enumerate().all(|(i, z)| *z == f64::from(u8::from(i == 0))), "{z:?}");
}

/// Quadratic programs that are not convex, over 0 ≤ x, A x ≤ b, x ≤ u, rows in any order: the least of a continuous function over a
/// bounded set fulfils the first-order conditions, so that every one has an answer, judged here from M and q alone.
#[test]
fn quadratic_programs_that_are_not_convex_are_answered() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut by_descent = 0;
    for case in 0..25 {
        let (k, constraints) = (random.random_range(4..12_usize), random.random_range(0..4_usize));
        let n = 2 * k + constraints;
        let mut m = vec![vec![0.0; n]; n];
        let mut couple = |i: usize, j: usize, entry: f64, back: f64| (m[i][j], m[j][i]) = (entry, back);
        for i in 0..k {
            (0..=i).for_each(|j| {
                let entry = f64::from(random.random_range(-9..10));
                couple(i, j, entry, entry);
            });
            couple(i, k + i, 1.0, -1.0);
            (2 * k..n).for_each(|row| {
                let entry = f64::from(random.random_range(-3..4));
                couple(i, row, entry, -entry);
            });
        }
        let own = |i: usize, random: &mut ChaCha8Rng| {
            f64::from(if i < k { random.random_range(-9..10) } else { random.random_range(1..4) })
        };
        let q: Vec<f64> = (0..n).map(|i| own(i, &mut random)).collect();
        let order = shuffled(n, &mut random);
        let m: Vec<Vec<f64>> = order.iter().map(|&i| order.iter().map(|&j| m[i][j]).collect()).collect();
        let q: Vec<f64> = order.iter().map(|&i| q[i]).collect();
        let answer = solved(&m, &q, None).answer;
        assert!(answer.is_answer(), "case {case}: {:?}", answer.outcome);
        by_descent += usize::from(answer.rules.engine == AttemptEngine::Descent);
        let z = answer.solution.expect("z").z;
        assert!(worst_violation(&m, &q, &z) <= 1e-14, "case {case}: {}", worst_violation(&m, &q, &z));
    }
    assert!(by_descent >= 3, "{by_descent}");
}

/// z₁ − z₂ = 1 and δ z₂ = 2 with δ = 2⁻⁵⁰: the answer (2⁵¹ + 1, 2⁵¹) is one of these numbers, but not of others that round to them,
/// and what M z + q leaves of its terms is no w.
#[test]
fn an_answer_so_far_away_that_rounding_hides_q_is_told() {
    let matrix = [vec![1.0, -1.0], vec![-1.0, 1.0 + f64::powi(2.0, -50)]];
    let answer = solved(&matrix, &[-1.0, -1.0], None).answer;
    assert!(answer.is_answer() && answer.notes.iter().any(|note| note.contains("hides q")), "{:?}", answer.notes);
    let solution = answer.solution.expect("z");
    assert_eq!((solution.z, solution.w), (vec![f64::powi(2.0, 51) + 1.0, f64::powi(2.0, 51)], vec![0.0; 2]));
    let answer = solved(&[vec![1.0, -1.0], vec![-1.0, 1.5]], &[-1.0, -1.0], None).answer;
    assert!(answer.is_answer() && !answer.notes.iter().any(|note| note.contains("hides q")), "{:?}", answer.notes);
}

/// No attempt is made twice: the list has no rule twice.
#[test]
fn retries_never_repeat_a_run() {
    // w = −z − 1: no answer; 12 rows, so that it is not enumerated. M = −1 has the ray z̄ = p̄ = 1.
    let n = 12;
    let matrix: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| if i == j { -1.0 } else { 0.0 }).collect()).collect();
    let solved = solved(&matrix, &vec![-1.0; n], None);
    assert_eq!(solved.answer.outcome, OutcomeKind::Ray);
    let mut seen: Vec<String> = solved.answer.attempts.iter().map(|attempt| attempt.rules.to_string()).collect();
    // The one shown stands last.
    assert_eq!(seen.last(), Some(&solved.answer.rules.to_string()));
    let all = seen.len();
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), all, "{seen:?}");
}

/// In the form w = A y − 1, C x − 1 of a game nothing blocks the first z: said with the form that works.
#[test]
fn a_game_that_no_covering_solves_is_told_with_the_form_that_works() {
    let (k, mut random) = (6, ChaCha8Rng::seed_from_u64(3));
    let mut matrix = vec![vec![0.0; 2 * k]; 2 * k];
    for i in 0..k {
        for j in 0..k {
            matrix[i][k + j] = f64::from(random.random_range(1..100));
            matrix[k + i][j] = f64::from(random.random_range(1..100));
        }
    }
    let q = vec![-1.0; 2 * k];
    let lcp = MirroredLcp::plain(&Lcp {
        scale: Scale::plain(&matrix),
        matrix: matrix.clone(),
        q: q.clone(),
        covering: vec![1.0; 2 * k],
    });
    let run = solve(matrix.clone(), q, None);
    let Outcome::Ray(direction) = &run.outcome else { panic!("{:?}", run.outcome) };
    let names: Vec<String> = (1..=2 * k).map(|row| row.to_string()).collect();
    let plain = PlainRay::new(&lcp, &names, &run.pivots, direction, run.point.p);
    assert!(plain.whatever_the_covering);
    let ray = plain.record(Verdict::Undecided, "");
    // The last row needs p first (lexicographically), so the last z enters.
    assert_eq!(ray.driver, "z[12]");
    let rates = ray.direction.variables();
    assert_eq!((rates[0].variable.as_str(), rates.len()), ("z[12]", 1 + k));
    for part in ["no d > 0 gets past this pivot", "bimatrix game", "A y - u e"] {
        assert!(ray.explanation.contains(part), "{part}: {}", ray.explanation);
    }
    // That form: z = (x, y, u, v); x / Σx and y / Σy are then an equilibrium.
    let n = 2 * k + 2;
    let (mut form, mut right) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for i in 0..2 * k {
        form[i][..2 * k].copy_from_slice(&matrix[i]);
        let value = 2 * k + i / k;
        (form[i][value], form[value][i]) = (-1.0, 1.0);
    }
    right[2 * k..].fill(-1.0);
    assert!(solved(&form, &right, None).answer.is_answer());
}

/// Where a ray from the first pivot on is all that Lemke's algorithm has to say the game is solved in that form, whatever q < 0
/// and whatever the order of the rows; every answer is judged from M and q alone.
#[test]
fn games_are_answered() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for case in 0..60 {
        let (a, b) = (random.random_range(1..20), random.random_range(1..20));
        let n: usize = a + b;
        let order = shuffled(n, &mut random);
        let mut m = vec![vec![0.0; n]; n];
        for i in 0..n {
            for j in (0..n).filter(|&j| (i < a) != (j < a)) {
                m[order[i]][order[j]] = f64::from(random.random_range(1..1000));
            }
        }
        let uniform = case % 2 == 0;
        let q: Vec<f64> = (0..n).map(|_| if uniform { -1.0 } else { -random.random_range(0.01..10.0) }).collect();
        let solved = solved(&m, &q, None);
        assert_eq!(solved.answer.outcome, OutcomeKind::Normal, "case {case}");
        let z = &solved.answer.solution.as_ref().expect("of an lcp").z;
        assert!(worst_violation(&m, &q, z) <= 1e-13, "case {case}");
        let run = solve(m, q, None);
        if run.pivots.count() == 1 && matches!(run.outcome, Outcome::Ray(_)) {
            assert_eq!(solved.answer.rules.engine, AttemptEngine::Bimatrix, "case {case}");
        }
    }
}

/// The basis that came back is named, and what moves at its pivots: nothing.
#[test]
fn a_cycle_names_its_pivots() {
    let m = vec![vec![1.0, 2.0, 0.0], vec![0.0, 1.0, 2.0], vec![2.0, 0.0, 1.0]];
    let run = solve(m, vec![-1.0; 3], Some(TieRule::FirstRow));
    let Outcome::Cycle(cycle) = run.outcome else { panic!("{:?}", run.outcome) };
    assert_eq!(cycle.again, run.pivots.count() - 1);
    let pivots = run.pivots.recorded();
    // The same basis and the same variable to enter after both.
    assert_eq!(Basis::after(&pivots[..=cycle.first]), Basis::after(&pivots[..=cycle.again]));
    assert_eq!(pivots[cycle.first].leaving, pivots[cycle.again].leaving);
    assert!(pivots[cycle.first + 1..].iter().all(|pivot| pivot.degenerate && pivot.p_after == 1.0));
}
