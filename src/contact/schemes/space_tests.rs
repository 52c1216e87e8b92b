//! Working schemes in space: the plane written in space, closed forms, and agreement with Lemke's run on random
//! problems.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::critical::{Coverage, critical_friction};
use super::enumerate::{Enumeration, enumerate};
use super::exact_check::{Finding, exact_check};
use super::scheme::{PairScheme, schemes_of};
use crate::contact::full_lcp::full_lcp;
use crate::contact::full_lcp::tests::{
    coulomb_in_space, plain, random_number, tangential_first_on, with_random_bound_and_gap,
};
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::rows;
use crate::lcp::driver::run;
use crate::lcp::exact::tableau::Tableau;
use crate::lcp::outcome::Outcome;
use crate::model::rules::Covering;

fn all(problem: &ContactProblem) -> Enumeration {
    enumerate(problem, &mut |_| ControlFlow::Continue(()))
}

/// Lemke's run by the tableau: z over the joints and the scheme of its last basis.
fn lemke(problem: &ContactProblem) -> (DVector<f64>, Vec<PairScheme>) {
    let (system, polygon) = (&*problem.system, problem.polygon);
    let lcp = full_lcp::<f64>(problem, Covering::Cohesive);
    let rule = tangential_first_on(system, polygon);
    let run = run(&mut Tableau::new(&lcp, rule), 4000, &mut |_| ControlFlow::Continue(()));
    assert!(matches!(run.outcome, Outcome::Normal { .. } | Outcome::Trivial), "{:?}", run.outcome);
    let rows = rows(system, polygon);
    let mut z = DVector::zeros(system.joint_count());
    for (row, value) in rows.iter().zip(&run.point.z) {
        row.joints(system, polygon).for_each(|(joint, d)| z[joint] += d * *value);
    }
    let released = run.pivots.basis().z.into_iter().map(|row| rows[row]);
    let scheme = schemes_of(released, &problem.laws, polygon);
    (z, scheme)
}

/// Random positive definite R, in whole numbers with ties or in reals.
fn random_problem(random: &mut ChaCha8Rng, m: usize, ties: bool) -> ContactProblem {
    let k = 3 * m;
    let mut number = |size: i32| random_number(random, ties, size);
    let a = DMatrix::from_fn(k, k, |_, _| number(2));
    let r = a.transpose() * &a + DMatrix::identity(k, k);
    let load: Vec<f64> = (0..k).map(|_| number(4)).collect();
    let f = [0.0, 0.25, 0.5, 1.0, 2.0, 5.0][random.random_range(0..6)];
    let facets = [4, 6, 8, 12, 16][random.random_range(0..5)];
    let turn = if random.random_bool(0.3) { 0.1 } else { 0.0 };
    let problem = plain(&coulomb_in_space(r), f, &load).with_polygon(Polygon::regular(facets, turn));
    with_random_bound_and_gap(problem, random)
}

#[test]
fn the_exact_check_proves_what_lemke_ends_with() {
    let mut random = ChaCha8Rng::seed_from_u64(31);
    let (mut proved, mut rounding) = (0, 0);
    for case in 0..120 {
        let problem = random_problem(&mut random, 1 + case % 6, case % 2 == 0);
        let (z, scheme) = lemke(&problem);
        let got = exact_check(&problem, &scheme, &mut |_| ControlFlow::Continue(()));
        let size = z.amax().max(1.0);
        match got.finding {
            Finding::Proved { .. } => {
                proved += 1;
                assert!((got.z.expect("solved") - &z).amax() <= 1e-9 * size, "case {case}");
            }
            // Directions in f64 break ties that are exact on paper.
            Finding::Refuted { violations } => {
                rounding += 1;
                assert!(violations.iter().all(|sign| sign.value.abs() <= 1e-13 * size), "case {case}: {violations:?}");
            }
            other => panic!("case {case}: {other:?}"),
        }
        // Any pair of it in another state is refuted, or shows the same displacements.
        let mut wrong = scheme.clone();
        wrong[0] = if wrong[0] == PairScheme::STICK { PairScheme::OPEN } else { PairScheme::STICK };
        let got = exact_check(&problem, &wrong, &mut |_| ControlFlow::Continue(()));
        if let (Finding::Proved { .. }, Some(other)) = (&got.finding, &got.z) {
            let others = all(&problem).answers;
            assert!(others.iter().any(|answer| (&answer.state.z - other).amax() <= 1e-9 * size), "case {case}");
        }
    }
    assert!(proved >= 110 && rounding <= 10, "{proved} {rounding}");
}

#[test]
fn enumeration_finds_what_lemke_ends_with() {
    let mut random = ChaCha8Rng::seed_from_u64(32);
    let mut several = 0;
    for case in 0..60 {
        let m = if case % 10 == 9 { 3 } else { 1 + case % 2 };
        let problem = random_problem(&mut random, m, case % 4 == 0);
        let (z, _) = lemke(&problem);
        let got = all(&problem);
        assert!(got.complete && got.undecided == 0, "case {case}");
        let size = z.amax().max(1.0);
        let near = |answer: &super::enumerate::EnumeratedAnswer| (&answer.state.z - &z).amax() < 1e-6 * size;
        assert!(got.answers.iter().any(near), "case {case}: {z} {got:?}");
        if !got.answers.iter().any(|answer| answer.continuum || answer.schemes.len() > 1) {
            assert!(got.answers.len() % 2 == 1, "case {case}: an even number of answers");
        }
        several += usize::from(got.answers.len() > 1);
    }
    assert!(several > 0);
}

/// n and t1 coupled as in the plane, t2 on its own.
fn klarbring_in_space() -> DMatrix<f64> {
    DMatrix::from_row_slice(3, 3, &[1.0, -1.0, 0.0, -1.0, 1.5, 0.0, 0.0, 0.0, 1.0])
}

#[test]
fn the_three_answers_of_the_plane_are_answers_in_space() {
    let system = coulomb_in_space(klarbring_in_space());
    let problem = plain(&system, 2.0, &[0.6, -1.0, 0.0]).with_polygon(Polygon::regular(4, 0.0));
    let got = all(&problem);
    for (z, x) in [([0.0, 0.0], [0.6, -1.0]), ([0.0, 0.4], [0.2, -0.4]), ([0.2, 0.8], [0.0, 0.0])] {
        let is = |answer: &super::enumerate::EnumeratedAnswer| {
            let state = &answer.state;
            let same = |found: &DVector<f64>, expected: [f64; 2]| {
                (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs() + found[2].abs() < 1e-14
            };
            same(&state.z, z) && same(&state.force, x)
        };
        assert!(got.answers.iter().any(is), "{z:?}: {got:?}");
    }
    assert_eq!((got.answers.len(), got.total), (3, 10));
}

#[test]
fn critical_friction_of_one_pair_is_that_of_the_plane() {
    // Along t1 it is R_ττ / |R_nτ| = 1.5; between two facets d the row of the corner is v, d·v = 1, |v| = 1/cos(π/K):
    // of λ_τ + f λ_n v over (t1, t2) the determinant is R_11 R_22 + f (R_n1 v_1 R_22): 1.5 − f v_1, v_1 = 1 of the
    // corners beside t1 where d_0 is along t1.
    for facets in [4, 8] {
        let found = critical_friction(
            &coulomb_in_space(klarbring_in_space()),
            Polygon::regular(facets, 0.0),
            &|f| vec![f; 1],
            (4000, 1),
            &mut |_| ControlFlow::Continue(()),
        );
        assert_eq!(found.coverage, Coverage::Exact);
        assert_eq!(found.examined, 2 + 2 * u64::from(facets));
        assert!((found.value.expect("coupled") - 1.5).abs() < 1e-12, "{found:?}");
    }
}
