//! Schemes proved and refuted.

use nalgebra::DMatrix;

use super::*;
use crate::contact::full_lcp::tests::{beam_problem, coulomb, plain};

fn check(problem: &ContactProblem, scheme: &[PairScheme]) -> ExactCheck {
    exact_check(problem, scheme, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn three_answers_of_one_pair_are_proved_and_the_fourth_scheme_refuted() {
    let system = coulomb(DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.5]));
    let problem = plain(&system, 2.0, &[0.6, -1.0]);
    for scheme in [PairScheme::OPEN, PairScheme::STICK, PairScheme::SLIP_PLUS] {
        let got = check(&problem, &[scheme]);
        assert!(matches!(got.finding, Finding::Proved { .. }), "{got:?}");
    }
    let got = check(&problem, &[PairScheme::SLIP_MINUS]);
    let Finding::Refuted { violations } = got.finding else { panic!() };
    assert!(violations.iter().any(|v| v.name.ends_with("[c1]") && v.value < 0.0));
}

#[test]
fn sliding_beam_is_singular_and_inconsistent() {
    let got = check(&beam_problem(181.0), &[PairScheme::SLIP_PLUS; 6]);
    assert_eq!(got.finding, Finding::Singular { rank: 5, consistent: false });
    let mut scheme = [PairScheme::STICK; 6];
    scheme[..3].fill(PairScheme::SLIP_PLUS);
    let got = check(&beam_problem(100.0), &scheme);
    assert!(matches!(got.finding, Finding::Proved { .. }));
    scheme[2] = PairScheme::STICK;
    let got = check(&beam_problem(100.0), &scheme);
    let Finding::Refuted { violations } = got.finding else { panic!() };
    assert_eq!(violations[0].name, "x+[c3]");
    assert!((violations[0].value + 10.0).abs() < 1e-12);
}

#[test]
fn stops_when_told() {
    let problem = beam_problem(100.0);
    let got = exact_check(&problem, &[PairScheme::OPEN; 6], &mut |_| ControlFlow::Break(()));
    assert_eq!(got.finding, Finding::Interrupted);
}

/// `cargo test --release --lib exact_check -- --ignored --nocapture`
#[test]
#[ignore = "a measurement"]
fn sixty_pairs() {
    use rand::{Rng, SeedableRng};
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let k = 120;
    let a = DMatrix::from_fn(k, k, |_, _| random.random_range(-1.0..1.0));
    let system = coulomb(&a * a.transpose());
    let load: Vec<f64> = (0..k).map(|_| random.random_range(-1.0..1.0)).collect();
    let problem = plain(&system, 0.3, &load);
    let start = std::time::Instant::now();
    let got = check(&problem, &[PairScheme::OPEN; 60]);
    assert!(matches!(got.finding, Finding::Refuted { .. }));
    std::io::Write::write_all(
        &mut std::io::stderr(),
        format!("all of 60 pairs open: {:?}\n", start.elapsed()).as_bytes(),
    )
    .unwrap();
}
