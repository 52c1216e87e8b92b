//! The tour.

use super::*;
use crate::session::commands::screen::Tour;
use crate::session::{Format, Output};
use crate::tui::tour::{lines, steps};
use crate::view::style::Style;

/// A number that a step names, asked of the session that stands there.
fn number(rig: &mut Rig, quantity: &str) -> f64 {
    let mut out = Vec::new();
    let mut io = Output::new(&mut out, Style::default(), Format::JsonLines, &Quiet);
    rig.session.execute(&format!("show {quantity}"), &mut io).unwrap();
    let said: serde_json::Value = serde_json::from_slice(&out).unwrap();
    said["report"][0]["value"].as_f64().unwrap_or_else(|| panic!("{said}"))
}

fn states(rig: &Rig) -> String {
    let word = |state: PairMotion| match state {
        PairMotion::Open => 'o',
        PairMotion::Stick => '.',
        PairMotion::SlipPlus => '+',
        PairMotion::SlipMinus => '-',
        PairMotion::Closed => 'c',
        PairMotion::Slip => '~',
    };
    rig.state.shown.pairs().iter().map(|pair| word(pair.state)).collect()
}

/// Begins a tour somewhere else and goes through it; `at` looks at each step, counted from 1.
fn take(of: Tour, word: &str, mut at: impl FnMut(usize, &mut Rig)) {
    let mut rig = Rig::new("gap", 80, 24);
    rig.command(&format!("tour {word}"));
    for step in 1..=steps(of).len() {
        assert_eq!(rig.state.tour, Some((of, step - 1)));
        let (text, _) = lines(&rig.state, (of, step - 1), 80).unwrap();
        assert!(text.len() <= 6, "{word} {step} is cut: {text:#?}");
        insta::assert_snapshot!(format!("tour-{word}-{step}"), rig.screen());
        at(step, &mut rig);
        if !matches!(rig.state.overlay, Overlay::None) {
            rig.press(&["esc"]);
        }
        // whatever is varied in between
        rig.press(&["+"]);
        rig.press(&["enter"]);
    }
    assert_eq!(rig.state.tour, None);
}

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value}, expected {expected}");
}

#[test]
fn the_tour_of_the_pipe_tells_what_is_true() {
    take(Tour::Pipe, "pipe", |step, rig| match step {
        1 => {
            assert_eq!(states(rig), "......");
            near(number(rig, "nozzle_moment"), -0.10, 0.005);
        }
        2 => {
            assert_eq!(states(rig), "+oo+++");
            near(number(rig, "nozzle_moment"), -5.1, 0.05);
            near(number(rig, "expansion"), 0.044, 0.0005);
        }
        3 => {
            assert_eq!(states(rig), "+oo+++");
            near(number(rig, "nozzle_moment"), 8.4, 0.05);
            // at their bounds, towards the nozzle
            let (x_t, x_n) = (number(rig, "sum x_t *"), number(rig, "sum x_n *"));
            near(x_t, -0.3 * x_n, 1e-9);
        }
        4 => {
            assert_eq!(states(rig), ".oo+++");
            near(number(rig, "nozzle_moment"), 20.0, 0.05);
            rig.command("find f 0..1 where state c1 = stick");
            assert!(rig.screen().contains("0.4815"), "{}", rig.screen());
        }
        5 => {
            near(number(rig, "nozzle_moment"), 0.0, 1e-7);
            rig.command("find f 0..1 where nozzle_moment = 0");
            assert!(rig.screen().contains("0.1287187701"), "{}", rig.screen());
            rig.command("envelope nozzle_moment over f 0..1");
            assert!(rig.screen().contains("20.04"), "{}", rig.screen());
        }
        _ => {
            rig.command("stages");
            near(number(rig, "stage 3 z_t c6"), 0.0029, 5e-5);
            near(number(rig, "stage 3 x_n c1"), 0.0, 1e-12);
            rig.command("solve");
        }
    });
}

#[test]
fn the_tour_of_the_dam_tells_what_is_true() {
    // statics of the slice: W = 24 H (B + crest)/2, U = drain 9.81 z B/2, T = 9.81 z²/2
    take(Tour::Dam, "dam", |step, rig| {
        let e = |rig: &mut Rig| number(rig, "eccentricity");
        match step {
            1 => {
                assert_eq!(states(rig), ".......");
                near(number(rig, "normal"), 24.0 * 30.0 * 14.0, 1e-6);
                near(e(rig), -3.81, 0.005);
            }
            2 => {
                assert_eq!(states(rig), "+......");
                near(number(rig, "shear"), -3846.0, 0.5);
                near(e(rig), 0.67, 0.005);
            }
            3 => {
                assert!(states(rig).starts_with('o') && states(rig).matches('o').count() == 1);
                near(number(rig, "normal"), 10080.0 - 3532.0, 0.5);
                near(e(rig), 3.03, 0.005);
            }
            4 => near(number(rig, "safety water"), 1.58, 0.005),
            _ => {
                let ray = rig.state.shown.answer().unwrap().ray.clone().unwrap();
                assert!(ray.mode.contains("translation of the whole structure"), "{}", ray.mode);
                near(0.45 * (10080.0 - 0.6 * 9.81 * 28.0 * 12.0), 3646.0, 0.5);
            }
        }
        rig.command("summary");
    });
}

#[test]
fn the_tour_of_failing_lcps_tells_what_is_true() {
    take(Tour::Lcp, "lcp", |step, rig| {
        let answer = rig.state.shown.answer().unwrap();
        let z = |rig: &Rig| rig.state.shown.answer().unwrap().solution.clone().unwrap().z;
        match step {
            1 => assert_eq!(answer.outcome, OutcomeKind::Ray),
            2 => {
                assert_eq!(z(rig), [0.0]);
                rig.command("enumerate");
                assert!(rig.screen().contains("(20)") && rig.screen().contains("2 answers"), "{}", rig.screen());
            }
            3 => {
                assert_eq!(answer.outcome, OutcomeKind::PivotLimit);
                assert!(answer.pivots.iter().all(|pivot| pivot.p == 1.0));
                rig.command("ties");
            }
            4 => {
                assert_eq!(answer.pivot_count, 4);
                z(rig).into_iter().for_each(|z| near(z, 1.0 / 3.0, 1e-15));
                rig.command("compare");
            }
            _ => {
                assert_eq!(answer.pivot_count, 64);
                // each pivot but the first lets p down by 2
                let p: Vec<f64> = answer.pivots.iter().map(|pivot| pivot.p).collect();
                assert!(p.windows(2).all(|pair| pair[0] - pair[1] == 2.0), "{p:?}");
                rig.command("help ray");
                assert!(rig.screen().contains("murty6 has no ray now"), "{}", rig.screen());
            }
        }
    });
}

#[test]
fn the_tour_tells_what_is_true() {
    let mut rig = Rig::new("gap", 80, 24);
    rig.command("tour");
    let mut outcomes = Vec::new();
    for step in 1..=6 {
        assert_eq!(rig.state.tour, Some((Tour::Beam, step - 1)));
        insta::assert_snapshot!(format!("tour-{step}"), rig.screen());
        let answer = rig.state.shown.answer().unwrap();
        outcomes.push((answer.outcome, rig.state.shown.step(), rig.state.shown.moment.p));
        rig.press(&["enter"]);
    }
    assert_eq!(rig.state.tour, None);
    let near = |p: Option<f64>, value: f64| assert!((p.unwrap() - value).abs() < 1e-3, "{p:?}");
    assert_eq!(outcomes[0].0, OutcomeKind::Trivial);
    assert_eq!(outcomes[1].0, OutcomeKind::Normal);
    near(outcomes[2].2, 133.3333);
    assert_eq!(outcomes[2].1, Some(0));
    near(outcomes[3].2, 22.2222);
    assert!(matches!(outcomes[4].0, OutcomeKind::Normal));
    assert_eq!(outcomes[5].0, OutcomeKind::Ray);
    near(outcomes[5].2, 3.3333);
    rig.command("tour");
    rig.press(&["enter", "backspace"]);
    assert_eq!(rig.state.tour, Some((Tour::Beam, 0)));
    rig.press(&["esc"]);
    assert_eq!(rig.state.tour, None);
}
