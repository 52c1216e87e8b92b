//! Elastic block on a rough plane.
//!
//! ```text
//!   H ─▶┌───────┐ ▼ 1 (weight, total on the top edge)
//!       │       │
//!       │       │ 2
//!       │       │
//!       └─●─●─●─┘      five pairs, x = 0, ¼, ½, ¾, 1
//!           1
//! ```
//!
//! Sliding at H = f: Σ (f x_n + …) = H gives p = (H − f)/(5 d_τ). Overturning about the right corner at 2 H = ½:
//! the pairs have lever arms 1, ¾, ½, ¼, 0 and x_n = 0 there means λ_n = −p, so p = (2 H − ½)/2.5 = 0.8 (H − ¼).

use stickslip::answer::record::OutcomeKind;

use crate::common::*;

#[test]
fn overturns_at_a_quarter() {
    let case = Case::embedded("block");
    for h in [0.0, 0.1, 0.2, 0.24, 0.2499999, 0.25 * (1.0 - 1e-9)] {
        is_answer(&case.solve(&[("H", h)]));
    }
    for (h, tolerance) in [
        (0.25 * (1.0 + 1e-9), 1e-5),
        (0.25 * (1.0 + 1e-6), 1e-7),
        (0.2525, 1e-9),
        (0.26, 1e-9),
        (0.3, 1e-9),
        (0.5, 1e-9),
    ] {
        let answer = case.solve(&[("H", h)]);
        let ray = mechanism(&answer);
        if h < 0.4 {
            close("p", ray.p, 0.8 * (h - 0.25), tolerance);
            let z_n: Vec<f64> = ray.direction.pairs().iter().map(|d| d.z_n).collect();
            let z_t: Vec<f64> = ray.direction.pairs().iter().map(|d| d.z_t.scalar()).collect();
            near_all("z̄_n", &z_n, &[1.0, 0.75, 0.5, 0.25, 0.0], 1e-9);
            assert_eq!(z_t, [0.0; 5]);
        }
    }
}

#[test]
fn slides_at_f() {
    let case = Case::embedded("block");
    for h in [0.1, 0.19, 0.2 * (1.0 - 1e-9), 0.2] {
        let answer = case.solve(&[("f", 0.2), ("H", h)]);
        assert_eq!(answer.outcome, OutcomeKind::Normal, "H = {h}");
        is_answer(&answer);
    }
    for (h, tolerance) in
        [(0.2 * (1.0 + 1e-9), 1e-5), (0.2 * (1.0 + 1e-6), 1e-7), (0.202, 1e-9), (0.23, 1e-9), (0.263, 1e-9)]
    {
        let answer = case.solve(&[("f", 0.2), ("H", h)]);
        let ray = mechanism(&answer);
        close("p", ray.p, (h - 0.2) / 6.0, tolerance);
        for pair in ray.direction.pairs() {
            near("z̄_τ", pair.z_t.scalar(), 1.0, 1e-9, 1.0);
            assert_eq!(pair.z_n, 0.0);
        }
    }
    // From (H − 0.2)/6 = 0.8 (H − 0.25) on, H = 0.263, overturning asks for more.
    let answer = case.solve(&[("f", 0.2), ("H", 0.3)]);
    close("p", mechanism(&answer).p, 0.04, 1e-9);
}

#[test]
fn the_base_carries_weight_and_push() {
    let case = Case::embedded("block");
    for (f, h) in [(0.4, 0.0), (0.4, 0.1), (0.4, 0.2), (1.0, 0.24), (0.2, 0.19)] {
        let answer = case.solve(&[("f", f), ("H", h)]);
        is_answer(&answer);
        let normal: f64 = answer.pairs.iter().map(|p| p.x_n).sum();
        let shear: f64 = answer.pairs.iter().map(|p| p.x_t).sum();
        let moment: f64 = answer.pairs.iter().map(|p| p.x_n * (p.position.unwrap()[0] - 0.5)).sum();
        near("Σ x_n", normal, 1.0, 1e-9, 1.0);
        near("Σ x_τ", shear, -h, 1e-9, 1.0);
        near("Σ x_n x", moment, 2.0 * h, 1e-9, 1.0);
    }
}
