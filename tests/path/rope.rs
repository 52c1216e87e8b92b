//! Ropes of many straight pieces round a drum, against their closed forms.
//!
//! With k = μ tan(α/2), α the turn at a pair, all pairs slip where the pull at one end is ((1 + k)/(1 − k))ⁿ times that at
//! the other: two pieces with the tensions T and T' press their pair by (T + T') sin(α/2) and draw it by (T' − T) cos(α/2).

use serde_json::{Value, json};

use stickslip::model::load::load_text;
use stickslip::path::end::PathEnd;
use stickslip::path::friction::trace;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

use super::common::lines::{read, report, text};

const ROUND: f64 = 2.0 * std::f64::consts::PI;

/// `count` pairs, each a turn of the rope on the unit circle, the end pieces along y; T1 pulls at the first and T2 at the
/// last, both 10.
fn rope(count: usize, turn: f64) -> Value {
    let on = |k: usize| format!("d{k}");
    let place = |k: f64| {
        let (sin, cos) = ((k + 0.5) * turn).sin_cos();
        json!([cos, sin])
    };
    let names: Vec<String> =
        std::iter::once("a".to_owned()).chain((0..count).map(on)).chain(["b".to_owned()]).collect();
    let nodes: serde_json::Map<String, Value> =
        std::iter::zip(&names, 0..).map(|(name, k)| (name.clone(), place(f64::from(k) - 1.0))).collect();
    let piece = |(k, ends): (usize, &[String])| json!({ "id": format!("r{k}"), "nodes": ends, "kind": "truss", "material": "m", "section": "s" });
    let pair = |k: usize| json!({ "id": format!("s{k}"), "node": on(k), "against": "ground", "normal": nodes[&on(k)], "friction": "mu" });
    let pull = |by: &str, node: &str, up: f64| json!({ "factor": by, "items": [{ "point": { "at": node, "force": [0, up] } }] });
    let spring = |node: &str| json!({ "at": node, "direction": [1, 0], "stiffness": 1e5 });
    json!({
        "format": "stickslip/1", "title": "rope", "parameters": { "mu": 0.15, "T1": 10, "T2": 10 },
        "materials": { "m": { "E": 1e5, "nu": 0.3 } }, "sections": { "s": { "area": 1 } },
        "bars": names.windows(2).enumerate().map(piece).collect::<Vec<Value>>(),
        "contacts": (0..count).map(pair).collect::<Vec<Value>>(),
        "springs": [spring("a"), spring("b")],
        "loads": { "hold": pull("T1", "a", -1.0), "pull": pull("T2", "b", 1.0) },
        "nodes": nodes,
    })
}

/// The limit, and a millionth on both sides of it: the motions of so many pieces are known to the last digits, so that
/// what room they have proves the collapse.
#[test]
fn a_long_rope_is_certified_just_beyond_its_limit() {
    let count = 84;
    let turn = 2.0 * ROUND / count as f64;
    let k = 0.15 * (0.5 * turn).tan();
    let limit = 10.0 * ((1.0 + k) / (1.0 - k)).powi(count as i32);
    let mut session = read(&rope(count, turn).to_string());
    let found = report(&mut session, "limit pull").expect("a limit");
    assert!((found["limit"].as_f64().expect("a limit") - limit).abs() < 1e-8 * limit, "{found} {limit}");
    assert_eq!((&found["confirmed"], &found["collapse"]["verdict"]), (&true.into(), &"certified".into()), "{found}");
    for (share, expected) in [(1.0 + 1e-6, "verdict certified"), (1.0 - 1e-6, "outcome answer")] {
        text(&mut session, &format!("set T2 {}", share * limit));
        text(&mut session, &format!("expect {expected}"));
    }
}

/// Pulled by 10 at both ends, pair after pair slips inwards up to the middle, where slips are zero but for their rounding:
/// such a slip ends no scheme, whatever its sign. The first pair tells where the path has come.
#[test]
fn a_slip_that_is_rounding_does_not_hold_up_a_path() {
    let count = 150;
    let turn = ROUND / count as f64;
    let scenario = load_text("rope", &rope(count, turn).to_string(), None).expect("a scenario");
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let values = scenario.parameter_values();
    let case = prepared.case(&scenario, &values);
    let solved = case.solve().expect("solvable");
    let path = trace(case, Some(&solved), "mu", 0.16).expect("a path");
    assert_eq!((&path.end, path.breakpoints.len()), (&PathEnd::Target, 0));
    for (mu, pairs) in &path.samples {
        let k = mu * (0.5 * turn).tan();
        let pressed = 10.0 * (1.0 + (1.0 - k) / (1.0 + k)) * (0.5 * turn).sin();
        assert!((pairs[0].x_n - pressed).abs() < 1e-9 * pressed, "{} {pressed}", pairs[0].x_n);
    }
}
