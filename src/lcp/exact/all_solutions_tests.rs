//! Published LCPs, and agreement with going through all bases one by one.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use num_traits::Zero;

fn solutions(matrix: &[Vec<BigRational>], q: &[BigRational], observer: &mut dyn FnMut(Progress) -> bool) -> Solutions {
    let mut rows = WholeRows::default();
    for (row, q) in matrix.iter().zip(q) {
        rows.push_rational(&row.iter().chain([q]).cloned().collect::<Vec<_>>());
    }
    all_solutions(rows, observer)
}

fn integer(value: i64) -> BigRational {
    BigRational::from_integer(value.into())
}

fn of(matrix: &[&[i64]], q: &[i64]) -> Solutions {
    let matrix: Vec<Vec<BigRational>> = matrix.iter().map(|row| row.iter().map(|v| integer(*v)).collect()).collect();
    let q: Vec<BigRational> = q.iter().map(|v| integer(*v)).collect();
    let found = solutions(&matrix, &q, &mut |_| true);
    assert!(found.complete && found.unlisted == 0);
    found
}

fn points(list: &[&[i64]]) -> Vec<Vec<BigRational>> {
    list.iter().map(|z| z.iter().map(|v| integer(*v)).collect()).collect()
}

#[test]
fn one_row_has_none_one_or_two_solutions() {
    assert!(of(&[&[-1]], &[-1]).none());
    assert_eq!(of(&[&[1]], &[-2]).basic, points(&[&[2]]));
    assert_eq!(of(&[&[-1]], &[2]).basic, points(&[&[0], &[2]]));
    assert!(of(&[&[-1]], &[2]).continua.is_empty());
}

#[test]
fn a_segment_is_told_by_its_ends() {
    // w1 = w2 = z1 + z2 − 1 [Cottle, Pang, Stone 4.1.14].
    let found = of(&[&[1, 1], &[1, 1]], &[-1, -1]);
    let mut ends = found.basic.clone();
    ends.sort();
    assert_eq!(ends, points(&[&[0, 1], &[1, 0]]));
    assert_eq!(found.continua, [Continuum { corners: vec![0, 1], directions: vec![] }]);
}

#[test]
fn a_half_line_is_told_by_its_start_and_direction() {
    // w1 = z1 − z2 + 1, w2 = −z1 + z2 − 1 = −w1: solutions (0, 1) + t (1, 1).
    let found = of(&[&[1, -1], &[-1, 1]], &[1, -1]);
    assert_eq!(found.basic, points(&[&[0, 1]]));
    assert_eq!(found.continua, [Continuum { corners: vec![0], directions: points(&[&[1, 1]]) }]);
}

#[test]
fn a_singular_basis_without_feasible_point_leaves_no_doubt() {
    // M = 0, q = (1, 2): z = 0 only; every other basis is singular and inconsistent.
    let found = of(&[&[0, 0], &[0, 0]], &[1, 2]);
    assert_eq!(found.basic, points(&[&[0, 0]]));
    assert!(found.continua.is_empty());
}

#[test]
fn a_cone_of_solutions_is_one_piece() {
    let found = of(&[&[0, 0], &[0, 0]], &[0, 0]);
    assert_eq!(found.basic, points(&[&[0, 0]]));
    let [piece] = &found.continua[..] else { panic!("{found:?}") };
    assert_eq!(piece.directions.len(), 2);
}

#[test]
fn a_stopped_search_keeps_what_it_found() {
    let n = 12;
    let matrix: Vec<Vec<BigRational>> =
        (0..n).map(|i| (0..n).map(|j| integer(if i == j { -1 } else { 0 })).collect()).collect();
    let q = vec![integer(1); n];
    let found = solutions(&matrix, &q, &mut |progress| progress.found < 5);
    assert!(!found.complete);
    assert_eq!(found.basic.len(), 5);
    assert!(!found.none());
}

/// Solutions of the bases that have exactly one, by Gauss–Jordan in rationals; whether a singular basis has solutions.
fn by_bases(matrix: &[Vec<BigRational>], q: &[BigRational]) -> (Vec<Vec<BigRational>>, bool) {
    use num_traits::Signed;
    let n = q.len();
    let (mut solutions, mut singular) = (Vec::new(), false);
    for basis in 0..1usize << n {
        let on: Vec<usize> = (0..n).filter(|i| basis >> i & 1 == 1).collect();
        let mut a: Vec<Vec<BigRational>> =
            on.iter().map(|&i| on.iter().map(|&j| matrix[i][j].clone()).chain([-&q[i]]).collect()).collect();
        let k = on.len();
        let mut rank = 0;
        for c in 0..k {
            let Some(pivot) = (rank..k).find(|&r| !a[r][c].is_zero()) else { continue };
            a.swap(rank, pivot);
            let own: Vec<BigRational> = a[rank].iter().map(|v| v / &a[rank][c]).collect();
            for (r, row) in a.iter_mut().enumerate() {
                let factor = row[c].clone();
                if r != rank {
                    row.iter_mut().zip(&own).for_each(|(v, p)| *v -= &factor * p);
                }
            }
            a[rank] = own;
            rank += 1;
        }
        if rank < k {
            singular |= a[rank..].iter().all(|row| row[k].is_zero());
            continue;
        }
        let mut z = vec![BigRational::zero(); n];
        for (i, row) in on.iter().zip(&a) {
            z[*i] = row[k].clone();
        }
        let holds = !z.iter().any(Signed::is_negative)
            && (0..n).all(|i| {
                let w: BigRational = (0..n).map(|j| &matrix[i][j] * &z[j]).sum::<BigRational>() + &q[i];
                !w.is_negative()
            });
        if holds && !solutions.contains(&z) {
            solutions.push(z);
        }
    }
    (solutions, singular)
}

#[test]
fn finds_what_going_through_all_bases_finds() {
    let mut random = ChaCha8Rng::seed_from_u64(31);
    let (mut none, mut several, mut continua) = (0, 0, 0);
    for case in 0..600 {
        let n = 1 + case % 5;
        let range = [1, 2, 9][case % 3];
        let mut number = || integer(random.random_range(-range..=range));
        let matrix: Vec<Vec<BigRational>> = (0..n).map(|_| (0..n).map(|_| number()).collect()).collect();
        let q: Vec<BigRational> = (0..n).map(|_| number()).collect();
        let found = solutions(&matrix, &q, &mut |_| true);
        assert!(found.complete && found.unlisted == 0);
        let (expected, singular) = by_bases(&matrix, &q);
        for z in &expected {
            assert!(found.basic.contains(z), "case {case}: {matrix:?} {q:?} {z:?}");
        }
        // A corner lies on n independent planes of a complementary kind: it is the solution of a basis that has one, or
        // a corner of the solutions of singular bases.
        if !singular {
            assert_eq!(found.basic.len(), expected.len(), "case {case}: {matrix:?} {q:?}");
            assert!(found.continua.is_empty());
        }
        none += usize::from(found.none());
        several += usize::from(found.basic.len() > 1);
        continua += usize::from(!found.continua.is_empty());
    }
    assert!(none > 50 && several > 50 && continua > 20, "{none} {several} {continua}");
}

#[test]
fn continua_hold_throughout() {
    // Midpoints of the corners of a piece, and corners moved along its directions, are solutions.
    use num_traits::Signed;
    let mut random = ChaCha8Rng::seed_from_u64(32);
    let mut tried = 0;
    for _ in 0..400 {
        let n = 4;
        let mut number = |range: i64| integer(random.random_range(-range..=range));
        let matrix: Vec<Vec<BigRational>> = (0..n).map(|_| (0..n).map(|_| number(1)).collect()).collect();
        let q: Vec<BigRational> = (0..n).map(|_| number(1)).collect();
        let found = solutions(&matrix, &q, &mut |_| true);
        for piece in &found.continua {
            let mut inside = found.basic[piece.corners[0]].clone();
            let share = BigRational::new(1.into(), (piece.corners.len() as i64).into());
            for z in inside.iter_mut() {
                *z = BigRational::zero();
            }
            for corner in &piece.corners {
                inside.iter_mut().zip(&found.basic[*corner]).for_each(|(z, c)| *z += c * &share);
            }
            for direction in &piece.directions {
                inside.iter_mut().zip(direction).for_each(|(z, d)| *z += d * integer(3));
            }
            for i in 0..n {
                let w: BigRational = (0..n).map(|j| &matrix[i][j] * &inside[j]).sum::<BigRational>() + &q[i];
                assert!(!w.is_negative() && !inside[i].is_negative() && (w * &inside[i]).is_zero());
            }
            tried += 1;
        }
    }
    assert!(tried > 50, "{tried}");
}
