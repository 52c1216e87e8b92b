//! Load histories: the Masing loop of a bar on supports, energy balance, agreement with one monotone loading.

use stickslip::model::load::load_text;
use stickslip::model::scenario::Scenario;
use stickslip::path::stages::{History, HistoryEnd, follow};
use stickslip::path::start::PathError;
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
    let history = follow(prepared.case(&scenario, &values)).expect("a history");
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
        let solved = prepared.case(&scenario, &scenario.parameter_values()).solve().expect("solvable");
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

/// A slider on a spring, k = 1000, f = 0.1, w = 1000 times its factor: |h − k z| ≤ f w at every moment.
#[test]
fn a_slider_follows_its_falling_weight() {
    let text = r#"{ "format": "stickslip/1", "title": "Slider", "nodes": { "m": [0, 0] },
      "springs": [{ "at": "m", "direction": [1, 0], "stiffness": 1000 }],
      "contacts": [{ "id": "s", "node": "m", "against": "ground", "normal": [0, 1], "friction": 0.1 }],
      "loads": { "w": { "factor": 1000, "items": [{ "point": { "at": "m", "force": [0, -1] } }] },
                 "h": { "items": [{ "point": { "at": "m", "force": [1, 0] } }] } },
      "stages": [{ "w": 1 }, { "w": 1, "h": 300 }, { "w": 1 }, { "w": 0.3 }, { "w": 1 }, { "w": 1, "h": -300 },
                 { "w": 2, "h": -300 }, { "w": 2 }, { "w": 0.5 }, { "w": 0.5 }, {}, { "w": 1, "h": 300 }] }"#;
    let scenario = load_text("slider", text, None).expect("sound");
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let history = follow(prepared.case(&scenario, &scenario.parameter_values())).expect("a history");
    assert_eq!(history.end, HistoryEnd::Complete);
    // (h − f w)/k on the way up, (h + f w)/k on the way down, and where neither is reached the slip before. Without
    // any weight the spring takes it home.
    let slips = [0.0, 0.2, 0.1, 0.03, 0.03, -0.2, -0.2, -0.2, -0.05, -0.05, 0.0, 0.2];
    let mut largest = 0.0_f64;
    for ((index, stage), slip) in history.stages.iter().enumerate().zip(slips) {
        let end = stage.moments.last().expect("an end");
        close(end.pairs[0].z_t, slip, 0.2);
        close(end.pairs[0].x_t, 1000.0 * slip - end.factors[1], 300.0);
        let energy = stage.energy.expect("a structure");
        largest = largest.max(energy.stored.abs());
        // A stage that does no work has no scale of its own.
        assert!(energy.residual <= 1e-14, "stage {index}: {energy:?}");
        assert!(stage.dissipated >= -1e-14 * largest, "stage {index}: {}", stage.dissipated);
    }
}

/// Eleven nodes on a slope of 0.1 with f = 0.5 and weight 2 each (friction 1, drift 0.2 a node), EA = 1000, s = 1, heated by
/// N = 50 and cooled. Heated, the nodes on either side of the neutral point move apart, cooled together; 6 friction forces
/// one way and 4 the other with the drift 2.2 in balance. Each cycle carries the bar down by
/// −2 s (ε − 8.8/EA), ε = N/EA.
#[test]
fn a_bar_on_a_slope_ratchets_down_at_each_cycle() {
    let nodes: Vec<String> = (0..11).map(|i| format!(r#""n{i}": [{i}, 0]"#)).collect();
    let bars: Vec<String> = (0..10)
        .map(|i| format!(r#"{{ "id": "b{i}", "nodes": ["n{i}", "n{}"], "material": "m", "section": "s" }}"#, i + 1))
        .collect();
    let contacts: Vec<String> = (0..11)
        .map(|i| {
            format!(r#"{{ "id": "c{i}", "node": "n{i}", "against": "ground", "normal": [0, 1], "friction": 0.5 }}"#)
        })
        .collect();
    let point = |at: usize, x: f64, y: f64| format!(r#"{{ "point": {{ "at": "n{at}", "force": [{x}, {y}] }} }}"#);
    let weight: Vec<String> = (0..11).map(|i| point(i, -0.2, -2.0)).collect();
    let cycle = r#", { "weight": 1, "heat": 1 }, { "weight": 1 }"#.repeat(4);
    let text = format!(
        r#"{{ "format": "stickslip/1", "title": "Ratchet", "materials": {{ "m": {{ "E": 1000, "nu": 0.3 }} }},
      "sections": {{ "s": {{ "area": 1, "inertia": 1 }} }}, "nodes": {{ {} }}, "bars": [ {} ], "contacts": [ {} ],
      "loads": {{ "weight": {{ "items": [ {} ] }},
                  "heat": {{ "factor": 50, "items": [ {}, {} ] }} }},
      "stages": [ {{ "weight": 1 }}{cycle} ] }}"#,
        nodes.join(", "),
        bars.join(", "),
        contacts.join(", "),
        weight.join(", "),
        point(10, 1.0, 0.0),
        point(0, -1.0, 0.0),
    );
    let scenario = load_text("ratchet", &text, None).expect("sound");
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let history = follow(prepared.case(&scenario, &scenario.parameter_values())).expect("a history");
    assert_eq!(history.end, HistoryEnd::Complete);
    let end = |stage: usize, pair: usize| history.stages[stage].moments.last().expect("an end").pairs[pair].z_t;
    let shift = -2.0 * (50.0 / 1000.0 - 8.8 / 1000.0);
    for cycle in 1..4 {
        for pair in 0..11 {
            close(end(2 * cycle + 1, pair) - end(2 * cycle - 1, pair), shift, 0.1);
            close(end(2 * cycle + 2, pair) - end(2 * cycle, pair), shift, 0.1);
        }
    }
}

/// A block of weight W on a floor with friction f, pushed by 2 f W towards a stop at a distance g, on a spring k along the way
/// (or none) and one across. Without a spring it slides away at f W, at constant load, to the stop: a jump over g that loses f W g. With
/// one it slides there, and beyond f W + k g floor and stop take what is more.
#[test]
fn a_block_that_slides_away_jumps_to_its_stop() {
    let block = |k: &str| {
        format!(
            r#"{{ "format": "stickslip/1", "title": "block", "nodes": {{ "b": [0, 0] }},
              "springs": [{{ "at": "b", "direction": [0, 1], "stiffness": 1000 }}{k}],
              "contacts": [
                {{ "id": "floor", "node": "b", "against": "ground", "normal": [0, 1], "friction": 0.5 }},
                {{ "id": "stop", "node": "b", "against": "ground", "normal": [-1, 0], "law": "frictionless", "gap": 0.1 }} ],
              "loads": {{ "weight": {{ "items": [{{ "point": {{ "at": "b", "force": [0, -10] }} }}] }},
                         "push": {{ "factor": 10, "items": [{{ "point": {{ "at": "b", "force": [1, 0] }} }}] }} }},
              "stages": [{{ "weight": 1 }}, {{ "weight": 1, "push": 1 }}] }}"#
        )
    };
    let [weight, friction, gap, push, k] = [10.0, 0.5, 0.1, 10.0, 20.0];
    for (with_spring, text) in
        [(false, block("")), (true, block(r#", { "at": "b", "direction": [1, 0], "stiffness": 20 }"#))]
    {
        let scenario = load_text("block", &text, None).expect("a sound scenario");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let history = follow(prepared.case(&scenario, &scenario.parameter_values())).expect("a history");
        assert_eq!(history.end, HistoryEnd::Complete);
        let stage = &history.stages[1];
        let slid = friction * weight / push;
        let jump = stage.moments.iter().position(|moment| moment.jump);
        assert_eq!(jump.is_some(), !with_spring);
        if let Some(jump) = jump {
            let [before, after] = [&stage.moments[jump - 1], &stage.moments[jump]];
            close(before.t, slid, 1.0);
            close(after.t, slid, 1.0);
            close(before.pairs[0].z_t, 0.0, gap);
            close(after.pairs[0].z_t, gap, gap);
        } else {
            // Half of the way at f W + k g/2.
            let half = history.pairs_at(1, slid + 0.5 * k * gap / push).expect("within the stage");
            close(half[0].z_t, 0.5 * gap, gap);
        }
        close(stage.dissipated, friction * weight * gap, 1.0);
        let taken = if with_spring { k * gap } else { 0.0 };
        // How floor and stop share the rest is not determined.
        let [floor, stop] = &stage.end.pairs[..] else { panic!("two pairs") };
        close(stop.x_n - floor.x_t, push - taken, push);
        close(stage.energy.expect("a structure").residual, 0.0, 1.0);
    }
}

/// A history that broke down in its third stage: the two before it stand, and all of it is no answer.
#[test]
fn what_was_followed_before_a_breakdown_stands() {
    let stages = r#"[{"weight": 1}, {"weight": 1, "pull": 1}]"#;
    let (scenario, _, whole) = run("beam", stages, &[("F", 100.0), ("f", 0.3), ("F2", 150.0)]);
    let error = PathError::Breakdown { name: "the place in stage 3".to_owned(), at: 0.5, why: "why".to_owned() };
    let broken = History { end: HistoryEnd::Broken(Box::new(error.clone())), ..whole.clone() };
    assert_eq!([0, 1, 2].map(|stage| broken.has_end_of(stage)), [true, true, false]);
    assert_eq!((whole.clone().unbroken(), broken.clone().unbroken()), (Ok(whole.clone()), Err(error.clone())));
    let told = |history: &History| {
        let result =
            stickslip::export::history::result(history, "beam", &scenario.parameter_values(), false).expect("stages");
        (result["outcome"].clone(), result["failure"].clone(), result["stages"].as_array().map(Vec::len))
    };
    assert_eq!(told(&whole), ("normal".into(), serde_json::Value::Null, Some(2)));
    assert_eq!(told(&broken), ("breakdown".into(), error.to_string().into(), Some(2)));
    assert_eq!(broken.outcome().map(|answer| answer.pairs.clone()), whole.answer().map(|answer| answer.pairs.clone()));
}

/// A block of 1000, f = 0.1, on a spring k = 1000: −300 draws it 0.2 to where f N = 100 and the spring hold; pressed by 2000 and
/// let go, the spring's 200 is all that friction can take. It stands exactly at its limit and does not move, at whatever angle
/// the numbers round.
#[test]
fn what_comes_to_its_limit_at_the_end_of_a_stage_has_not_slipped() {
    for degrees in 0..90 {
        let (sin, cos) = (f64::from(degrees) * 4.1).to_radians().sin_cos();
        let text = serde_json::json!({
            "format": "stickslip/1", "title": "isolator", "nodes": { "m": [0, 0] },
            "springs": [{ "at": "m", "direction": [cos, sin], "stiffness": 1000 }],
            "contacts": [{ "id": "s", "node": "m", "against": "ground", "normal": [-sin, cos], "friction": 0.1 }],
            "loads": { "w": { "factor": 1000, "items": [{ "point": { "at": "m", "force": [sin, -cos] } }] },
                       "h": { "items": [{ "point": { "at": "m", "force": [cos, sin] } }] } },
            "stages": [{ "w": 1 }, { "w": 1, "h": -300 }, { "w": 2, "h": -300 }, { "w": 2 }]
        });
        let scenario = load_text("isolator", &text.to_string(), None).expect("a sound scenario");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let values = scenario.parameter_values();
        let history = follow(prepared.case(&scenario, &values)).expect("a history");
        let last = &history.stages[3];
        let pair = &last.end.pairs[0];
        assert_eq!(pair.state.word(), "stick", "{degrees}");
        close(pair.x_t, -200.0, 200.0);
        close(pair.z_t, -0.2, 0.2);
        let changes = last.moments.iter().map(|moment| moment.changes.len()).sum::<usize>();
        assert_eq!(changes, 0, "{degrees}");
    }
}

/// A plate of side 1 and weight W on a floor, 1e-5 before a wall: unloaded it simply stands, though floor and wall repeat one
/// another in their common node. Heat makes it lean on the wall, a pull A away from it and a lift B at the middle of the left edge
/// turn it about, until only the ends of floor (force N, friction f N) and wall (M, f M downwards) hold it, with f = 1/2:
///   N − f M = W − α B,   M + α A = f N,   about the foot of the wall W/2 − α B + α A/2 + M = 0,
/// so that α = 7/10 W/(B + A/2).
#[test]
fn a_plate_short_of_a_wall_stands_unloaded_and_is_followed_from_there() {
    let [weight, pull, lift] = [10.0, 2.355, 7.279];
    let text = serde_json::json!({
        "format": "stickslip/1", "title": "plate",
        "materials": { "a": { "E": 1e6, "nu": 0.2, "density": 1, "expansion": 1e-5 } },
        "plates": [{ "id": "b", "origin": [0, 0], "size": [1, 1], "divisions": [2, 2], "thickness": 1, "material": "a",
                     "plane": "stress" }],
        "contacts": [
            { "id": "floor", "edge": "b.bottom", "against": "ground", "friction": 0.5 },
            { "id": "wall", "edge": "b.right", "against": "ground", "friction": 0.5, "gap": 1e-5 } ],
        "loads": { "w": { "items": [{ "gravity": { "acceleration": [0, -weight] } }] },
                   "p": { "items": [{ "point": { "at": "b.left", "force": [-pull, lift] } }] },
                   "heat": { "items": [{ "temperature": { "change": 30, "on": ["b"] } }] } },
        "stages": [{ "w": 1 }, { "w": 1, "p": 1, "heat": 0.5 }]
    });
    let scenario = load_text("plate", &text.to_string(), None).expect("a sound scenario");
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let history = follow(prepared.case(&scenario, &scenario.parameter_values())).expect("a history");
    let stood = &history.stages[0];
    for (i, pair) in stood.moments[0].pairs.iter().enumerate() {
        close(pair.z_n, if i < 3 { 0.0 } else { 1e-5 }, 1e-5);
        assert_eq!([pair.x_n, pair.x_t, pair.z_t], [0.0; 3]);
    }
    // The wall does not hold it under its weight alone: the floor carries all.
    close(stood.end.pairs[..3].iter().map(|pair| pair.x_n).sum(), weight, weight);
    let HistoryEnd::Limit { stage: 1, t, collapse } = &history.end else { panic!("{:?}", history.end) };
    close(*t, 0.7 * weight / (lift + 0.5 * pull), 1.0);
    assert!(collapse.verdict.is_some_and(stickslip::answer::record::Verdict::is_proof));
}
