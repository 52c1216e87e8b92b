//! Closed forms of critical friction.

use super::*;
use crate::contact::full_lcp::tests::coulomb;

fn critical(system: &ContactSystem) -> CriticalFriction {
    let m = system.pair_count();
    critical_friction(system, Polygon::PLANE, &|f| vec![f; m], (4000, 1), &mut |_| ControlFlow::Continue(()))
}

/// Stiffness of the unit square element, E = 1, ν = 0, t = 1, top fixed, condensed to its bottom nodes (0,0) and
/// (1,0); joints n1, n2, τ1, τ2 (n = y, t = x). Closed form of the bilinear element with ν = 0: u-u entries
/// ∫ N_i,x N_j,x + ½ N_i,y N_j,y, v-v with the roles exchanged, u_i-v_j ½ ∫ N_i,y N_j,x.
pub(crate) fn unit_square() -> ContactSystem {
    // ∫ N_i,x N_j,x = ±1/3; ∫ N_1,y N_1,y = 1/3, ∫ N_1,y N_2,y = 1/6.
    let same = 1.0 / 3.0 + 0.5 / 3.0;
    // nn = 1/6 − ½ · 1/3.
    let (tt, nn) = (-1.0 / 3.0 + 0.5 / 6.0, 0.0);
    // N_1 = (1−x)(1−y), N_2 = x(1−y):  ∫ N_1,y N_1,x = 1/4, ∫ N_1,y N_2,x = −1/4, ∫ N_2,y N_1,x = 1/4,
    // ∫ N_2,y N_2,x = −1/4. Row: u_i (τ_i), column: v_j (n_j).
    let (t1n1, t1n2, t2n1, t2n2) = (0.125, -0.125, 0.125, -0.125);
    #[rustfmt::skip]
    let r = DMatrix::from_row_slice(4, 4, &[
        same, nn,   t1n1, t2n1,
        nn,   same, t1n2, t2n2,
        t1n1, t1n2, same, tt,
        t2n1, t2n2, tt,   same,
    ]);
    coulomb(r)
}

#[test]
fn one_pair_is_klarbrings_quotient() {
    let system = coulomb(DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.5]));
    let got = critical(&system);
    assert!((got.value.unwrap() - 1.5).abs() < 1e-12, "{got:?}");
    assert_eq!(got.scheme.unwrap(), [PairScheme::SLIP_PLUS]);
    assert_eq!(got.coverage, Coverage::Exact);
    assert!(got.complete);
}

#[test]
fn unit_square_element() {
    let got = critical(&unit_square());
    assert!((got.value.unwrap() - 1.0).abs() < 1e-9, "{got:?}");
}

#[test]
fn uncoupled_pairs_have_one_answer_for_every_friction() {
    let system = coulomb(DMatrix::identity(4, 4));
    let got = critical(&system);
    assert_eq!((got.value, got.examined, got.singular), (None, 16, 0));
}

#[test]
fn rounding_of_a_coupling_is_no_critical_friction() {
    let mut r = DMatrix::identity(4, 4);
    // Normal and tangential joints coupled by what condensation leaves of an exact zero.
    for (i, j) in [(0, 2), (1, 3), (0, 3)] {
        (r[(i, j)], r[(j, i)]) = (3e-17, 3e-17);
    }
    assert_eq!(critical(&coulomb(r)).value, None);
}

#[test]
fn large_problems_are_sampled() {
    // Ten copies of the one-pair problem, one of them with f_crit = 1.25.
    let m = 10;
    let system = coulomb(DMatrix::from_fn(2 * m, 2 * m, |i, j| match (i < m, j < m) {
        _ if i % m != j % m => 0.0,
        (true, true) => 1.0,
        (false, false) if i == m + 3 => 1.25,
        (false, false) => 1.5,
        _ => -1.0,
    }));
    let got = critical(&system);
    assert!((got.value.unwrap() - 1.25).abs() < 1e-9, "{got:?}");
    assert!(matches!(got.coverage, Coverage::Sampled { seed: 1, .. }));
    let stopped =
        critical_friction(&system, Polygon::PLANE, &|f| vec![f; m], (4000, 1), &mut |_| ControlFlow::Break(()));
    assert!(!stopped.complete);
}
