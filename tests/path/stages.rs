//! Load histories: the Masing loop of a bar on supports, energy balance, agreement with one monotone loading.

use stickslip::model::load::load_text;
use stickslip::model::scenario::Scenario;
use stickslip::path::stages::{History, HistoryEnd, follow};
use stickslip::solve::{Prepared, prepare};
use stickslip::watch::Quiet;

fn text(name: &str, stages: &str) -> String {
    let text = stickslip::model::embedded::text(name).expect("embedded");
    let end = text.rfind('}').expect("an object");
    format!("{},\n  \"stages\": {stages}\n}}\n", text[..end].trim_end())
}

fn run(name: &str, stages: &str, set: &[(&str, f64)]) -> (Scenario, Prepared, History) {
    let scenario = load_text(name, &text(name, stages), None).expect("a sound scenario");
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let mut values = scenario.parameter_values();
    for (name, value) in set {
        values.insert((*name).to_owned(), *value).expect("a parameter");
    }
    let history = follow(&prepared, &scenario, &values, &Quiet).expect("a history");
    (scenario, prepared, history)
}

fn close(found: f64, expected: f64, size: f64) {
    assert!((found - expected).abs() <= 1e-12 * size, "{found} is not {expected}");
}

/// r = 30, L/EA = 1e-5: the end slips 300e-5 at 150, and on the way back it remembers.
#[test]
fn a_bar_on_supports_draws_the_masing_loop() {
    let stages = r#"[{"weight": 1}, {"weight": 1, "pull": 1}, {"weight": 1, "pull": -1}, {"weight": 1, "pull": 1}]"#;
    let (.., history) = run("beam", stages, &[("F", 100.0), ("f", 0.3), ("F2", 150.0)]);
    assert_eq!(history.end, HistoryEnd::Complete);
    let end = |stage: usize, t: f64| {
        let pairs = history.pairs_at(stage, t).expect("within the stage");
        pairs[5].z_t * 1e5
    };
    let at = |from: f64, to: f64, force: f64| (force - from) / (to - from);
    close(end(1, 1.0), 300.0, 300.0);
    for (force, slip) in [(100.0, 300.0), (50.0, 260.0), (0.0, 180.0), (-150.0, -300.0)] {
        close(end(2, at(150.0, -150.0, force)), slip, 300.0);
    }
    close(end(3, at(-150.0, 150.0, 0.0)), -180.0, 300.0);
    close(end(3, 1.0), 300.0, 300.0);
    // Breakpoints on the way down lie 2 r apart.
    let factors: Vec<f64> = history.stages[2]
        .moments
        .iter()
        .filter(|moment| !moment.changes.is_empty())
        .map(|moment| moment.factors[1])
        .collect();
    for (found, expected) in factors.iter().zip([150.0, 90.0, 30.0, -30.0, -90.0]) {
        close(*found, expected, 150.0);
    }
    let mut loop_area = 0.0;
    for (index, stage) in history.stages.iter().enumerate() {
        let energy = stage.energy.expect("a structure");
        assert!(energy.residual <= 1e-11, "stage {index}: {energy:?}");
        assert!(stage.dissipated >= 0.0);
        if index >= 2 {
            loop_area += stage.dissipated;
        }
    }
    // Masing: what a closed loop dissipates is 4 times what the first loading did.
    close(loop_area, 4.0 * history.stages[1].dissipated, loop_area);
}

#[test]
fn one_loading_in_one_stage_or_many_is_the_one_shot_answer() {
    for (name, stages, set) in [
        ("beam", r#"[{"weight": 1}, {"weight": 1, "pull": 1}]"#, vec![]),
        (
            "beam",
            r#"[{"weight": 1}, {"weight": 1, "pull": 0.37}, {"weight": 1, "pull": 0.7}, {"weight": 1, "pull": 1}]"#,
            vec![],
        ),
        ("plates-hinged", r#"[{"weight": 1}, {"weight": 1, "lift": 1}]"#, vec![]),
        ("block", r#"[{"weight": 1}, {"weight": 1, "push": 1}]"#, vec![]),
    ] {
        let (scenario, prepared, history) = run(name, stages, &set);
        assert_eq!(history.end, HistoryEnd::Complete, "{name}");
        let solved = prepared.solve(&scenario, &scenario.parameter_values(), scenario.rules, &Quiet).expect("solvable");
        assert!(solved.answer.notes.iter().any(|note| note.contains("history")));
        let last = history.stages.last().expect("stages");
        for stage in &history.stages {
            let energy = stage.energy.expect("a structure");
            assert!(energy.residual <= 1e-9, "{name}: {energy:?}");
            assert!(stage.dissipated >= -1e-12 * energy.work.abs(), "{name}");
        }
        if name != "beam" {
            continue;
        }
        let found = &last.moments.last().expect("moments").pairs;
        for (a, b) in found.iter().zip(&solved.answer.pairs) {
            assert!((a.z_t - b.z_t).abs() <= 1e-9 * 1e-2, "{name} {a:?} {b:?}");
            assert!((a.x_t - b.x_t).abs() <= 1e-9 * 100.0, "{name} {a:?} {b:?}");
        }
    }
}

#[test]
fn loads_that_cannot_be_reached_end_the_history() {
    let stages = r#"[{"weight": 1}, {"weight": 1, "pull": 2}, {"weight": 1}]"#;
    let (.., history) = run("beam", stages, &[]);
    let HistoryEnd::Limit { stage, t, collapse } = &history.end else {
        panic!("{:?}", history.end);
    };
    // 6 f F = 300 of 500.
    assert_eq!(*stage, 1);
    close(*t, 0.6, 1.0);
    assert!(collapse.mode.contains("slip +"), "{}", collapse.mode);
    assert_eq!(history.stages.len(), 2);
}
