//! Balls contain the true values; zeros are found; too little precision is reported.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

fn rational(n: i64, d: i64) -> BigRational {
    BigRational::new(BigInt::from(n), BigInt::from(d))
}

fn holds(number: &BallModP, value: &BigRational) {
    // |value − midpoint| ≤ radius, in rationals.
    let power = |e: i64| {
        let two = BigInt::one() << e.unsigned_abs();
        if e >= 0 { BigRational::from_integer(two) } else { BigRational::new(BigInt::one(), two) }
    };
    let middle = BigRational::from_integer(number.mantissa.clone()) * power(number.exponent);
    if number.radius.m.is_infinite() {
        return;
    }
    let radius = <BigRational as Scalar>::from_f64(number.radius.m) * power(number.radius.e);
    assert!((value - middle).abs() <= radius, "{number:?} {value}");
    let expected = times(residue(value.numer()), inverted(residue(value.denom())));
    assert_eq!(number.residue, Some(expected));
}

#[test]
fn balls_hold_the_true_values() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for precision in [8, 20, 64, 200] {
        for _ in 0..200 {
            let mut exact = vec![];
            let mut balls = vec![];
            for _ in 0..4 {
                let x = rational(random.random_range(-1000..1000), random.random_range(1..500));
                balls.push(BallModP::new(&x, precision));
                exact.push(x);
            }
            for _ in 0..12 {
                let (i, j) = (random.random_range(0..exact.len()), random.random_range(0..exact.len()));
                let (x, b) = match random.random_range(0..4) {
                    0 => (&exact[i] + &exact[j], balls[i].add(&balls[j])),
                    1 => (&exact[i] - &exact[j], balls[i].sub(&balls[j])),
                    2 => (&exact[i] * &exact[j], balls[i].mul(&balls[j])),
                    _ if !Zero::is_zero(&exact[j]) => (&exact[i] / &exact[j], balls[i].div(&balls[j])),
                    _ => continue,
                };
                holds(&b, &x);
                if let Some(sign) = b.sign() {
                    assert_eq!(Some(sign), Scalar::sign(&x));
                }
                exact.push(x);
                balls.push(b);
            }
        }
    }
}

#[test]
fn zero_is_found_by_residue() {
    let third = BallModP::new(&rational(1, 3), 100);
    let sum = third.add(&third).add(&third).sub(&BallModP::one());
    assert_eq!(sum.sign(), Some(Ordering::Equal));
    let almost = third
        .add(&third)
        .add(&third)
        .sub(&BallModP::one())
        .add(&BallModP::new(&rational(1, 7), 100))
        .sub(&BallModP::new(&rational(1, 7), 100));
    assert!(Scalar::is_zero(&almost));
}

#[test]
fn too_little_precision_is_admitted() {
    let tiny = BigRational::new(BigInt::one(), BigInt::one() << 300u32);
    let third = BallModP::new(&rational(1, 3), 100);
    let nearly = third.add(&BallModP::new(&tiny, 100)).sub(&third);
    assert_eq!(nearly.sign(), None);
}
