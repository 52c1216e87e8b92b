//! Lemke's algorithm one pivot at a time, on a bare LCP in rationals: nothing is rounded, every tie is a true one.
//!
//! `cargo run --example drive_lemke`

use num_rational::BigRational;
use stickslip::lcp::driver::{Engine, Step};
use stickslip::lcp::exact::tableau::Tableau;
use stickslip::lcp::outcome::Outcome;
use stickslip::lcp::problem::{Lcp, Scale};
use stickslip::lcp::ratio_test::TieRule;

/// w = M z + q with M of Murty's exponential examples (lower triangular, 2 below the diagonal), here for three rows.
const M: [[i64; 3]; 3] = [[1, 0, 0], [2, 1, 0], [2, 2, 1]];
const Q: [i64; 3] = [-4, -6, -7];

fn main() {
    let number = |value: i64| BigRational::from_integer(value.into());
    let matrix: Vec<Vec<f64>> = M.iter().map(|row| row.iter().map(|entry| *entry as f64).collect()).collect();
    let lcp = Lcp {
        matrix: M.iter().map(|row| row.iter().copied().map(number).collect()).collect(),
        q: Q.into_iter().map(number).collect(),
        covering: vec![number(1); 3],
        scale: Scale::plain(&matrix),
    };
    let mut engine = Tableau::new(&lcp, TieRule::Lexicographic(vec![0, 1, 2]));
    let outcome = loop {
        match engine.step() {
            Step::Pivoted => {
                let pivot = engine.pivots().last().expect("one was made");
                println!(
                    "{:>2}: {:?} enters, {:?} leaves, p = {}",
                    pivot.step, pivot.entering, pivot.leaving, pivot.p_after
                );
            }
            Step::Ended(outcome) => break outcome,
        }
    };
    let point = engine.point();
    let list = |values: &[BigRational]| values.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    match outcome {
        Outcome::Normal { .. } | Outcome::Trivial => println!("z = ({}), w = ({})", list(&point.z), list(&point.w)),
        Outcome::Ray(ray) => println!("a ray along z = ({})", list(&ray.z)),
        other => println!("no answer: {other:?}"),
    }
}
