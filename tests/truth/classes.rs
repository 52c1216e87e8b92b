//! Bare LCPs whose class shows a way to an answer where Lemke's algorithm in f64 loses its way.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::answer::attempt::AttemptEngine;
use stickslip::answer::record::OutcomeKind;

use super::zoo::{solved, worst_violation};

/// A random order of n things.
pub(super) fn shuffled(n: usize, random: &mut ChaCha8Rng) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    for last in (1..n).rev() {
        order.swap(last, random.random_range(0..=last));
    }
    order
}

/// Triangles of integers, in any order: z of the one answer, here in i128, grows to 1e26, and f64 runs end in rays, in
/// breakdowns or fail their check. Whoever finds it, each z is the right one to its last digits.
#[test]
fn triangles_of_any_size_are_answered() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut substituted = 0;
    for n in [60, 110, 150, 200] {
        let place = shuffled(n, &mut random);
        let (mut m, mut q) = (vec![vec![0.0; n]; n], vec![0.0; n]);
        let mut expected = vec![0_i128; n];
        for i in 0..n {
            let mut w: i128 = -random.random_range(1..10);
            q[place[i]] = w as f64;
            m[place[i]][place[i]] = 1.0;
            for j in 0..i {
                let entry: i128 = random.random_range(-2..3);
                m[place[i]][place[j]] = entry as f64;
                w += entry * expected[place[j]];
            }
            expected[place[i]] = (-w).max(0);
        }
        let solved = solved(&m, &q, None);
        assert_eq!(solved.answer.outcome, OutcomeKind::Normal, "n = {n}");
        let z = &solved.answer.solution.as_ref().expect("of an lcp").z;
        for (row, (z, &expected)) in std::iter::zip(z, &expected).enumerate() {
            let expected = expected as f64;
            assert!((z - expected).abs() <= 1e-12 * expected, "n = {n}, row {row}: {z:e}, {expected:e}");
        }
        substituted += usize::from(solved.answer.rules.engine == AttemptEngine::Substitution);
    }
    assert!(substituted > 0, "f64 runs solved them all");
}

/// Games in which strategies are as good as one another: the equations of an equilibrium are those of its basis, not of
/// the strategies that are played.
#[test]
fn games_with_strategies_twice_are_answered() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for case in 0..12 {
        let (a, b) = (random.random_range(4..24), random.random_range(4..24));
        let mut costs = |rows: usize, columns: usize| -> Vec<Vec<f64>> {
            let half: Vec<Vec<f64>> = (0..rows.div_ceil(2))
                .map(|_| (0..columns).map(|_| f64::from(random.random_range(1..10))).collect())
                .collect();
            (0..rows).map(|row| half[row / 2].clone()).collect()
        };
        let (of_first, of_second) = (costs(a, b), costs(b, a));
        let n = a + b;
        let mut m = vec![vec![0.0; n]; n];
        for i in 0..a {
            m[i][a..].copy_from_slice(&of_first[i]);
        }
        for i in 0..b {
            m[a + i][..a].copy_from_slice(&of_second[i]);
        }
        let q = vec![-1.0; n];
        let solved = solved(&m, &q, None);
        assert_eq!(solved.answer.outcome, OutcomeKind::Normal, "case {case}");
        let z = &solved.answer.solution.as_ref().expect("of an lcp").z;
        assert!(worst_violation(&m, &q, z) <= 1e-13, "case {case}");
    }
}

/// Subset sums of Chung 1989, of more numbers than a brief search of all bases gets through: z_i is a_i where a_i belongs
/// to the subset, else 0. An odd sum of even numbers there is not, and that is proved of fewer.
#[test]
fn subsets_are_found_by_all_bases() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for (n, exists) in [(20, true), (14, false)] {
        let numbers: Vec<i64> = (0..n).map(|_| 2 * random.random_range(1000..5000)).collect();
        let sum = numbers.iter().step_by(3).sum::<i64>() + i64::from(!exists);
        let mut m = vec![vec![0.0; n + 2]; n + 2];
        m[n][..n].fill(1.0);
        m[n + 1][..n].fill(-1.0);
        (0..n).for_each(|i| m[i][i] = -1.0);
        (m[n][n], m[n + 1][n + 1]) = (-6.0, -6.0);
        let mut q: Vec<f64> = numbers.iter().map(|&a| a as f64).collect();
        q.extend([-sum as f64, sum as f64]);
        let solved = solved(&m, &q, None);
        if exists {
            assert_eq!(solved.answer.outcome, OutcomeKind::Normal);
            let z = &solved.answer.solution.as_ref().expect("of an lcp").z;
            assert_eq!(z[..n].iter().sum::<f64>(), sum as f64);
            assert!(std::iter::zip(z, &numbers).all(|(&z, &a)| z == 0.0 || z == a as f64));
        } else {
            let verdict = solved.answer.ray.as_ref().expect("a ray").verdict;
            assert_eq!(verdict.map(|verdict| verdict.word()), Some("proved"));
        }
    }
}
