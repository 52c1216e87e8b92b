//! Hertz and Cattaneo–Mindlin: two equal blocks pressed together (P), then sheared (Q), as two stages.
//!
//! ```text
//!   a² = 4 P R / (π E*),  p0 = 2 P / (π a),  stick half-width c = a √(1 − Q / (f P))
//! ```

use std::f64::consts::{FRAC_2_PI, FRAC_2_SQRT_PI};
use std::fmt::Write;

use stickslip::answer::record::State;
use stickslip::model::load::load_text;
use stickslip::path::stages::{HistoryEnd, follow};
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

const ELEMENT: f64 = 0.05;

/// Distances from the contact, growing from one element to 30.
fn depths() -> Vec<f64> {
    let mut lines = vec![0.0];
    let (mut at, mut step) = (0.0, ELEMENT);
    while at + step < 30.0 {
        at += step;
        lines.push(at);
        if at > 0.5 {
            step *= 1.3;
        }
    }
    lines.push(30.0);
    lines
}

/// Lines along the contact, −30 … 30, fine within ±2.
fn along() -> Vec<f64> {
    let fine = 40;
    let mut half: Vec<f64> = (0..=fine).map(|k| ELEMENT * f64::from(k)).collect();
    let (mut at, mut step) = (2.0, ELEMENT);
    loop {
        step *= 1.4;
        at += step;
        if at + step > 30.0 {
            break;
        }
        half.push(at);
    }
    half.push(30.0);
    let mut lines: Vec<f64> = half[1..].iter().rev().map(|x| -x).collect();
    lines.extend(half);
    lines
}

fn list(values: impl Iterator<Item = f64>) -> String {
    let words: Vec<String> = values.map(|value| value.to_string()).collect();
    format!("[{}]", words.join(", "))
}

fn scenario(shear: f64) -> String {
    let (x, y) = (along(), depths());
    let mut text = String::new();
    let plate = |id: &str, bottom: f64, lines: String| {
        format!(
            r#"{{ "id": "{id}", "origin": [-30, {bottom}], "x": {}, "y": {lines}, "thickness": 1, "material": "m", "plane": "stress" }}"#,
            list(x.iter().map(|x| x + 30.0))
        )
    };
    let lower = list(y.iter().rev().map(|y| 30.0 - y));
    let upper = list(y.iter().copied());
    write!(
        text,
        r#"{{
  "format": "stickslip/1",
  "title": "Two blocks, pressed and sheared",
  "materials": {{ "m": {{ "E": 1000, "nu": 0.3 }} }},
  "plates": [{}, {}],
  "ties": [{{ "at": "upper.top", "fixed": ["x", "y"] }}],
  "supports": [{{ "at": "lower.bottom", "fixed": ["x", "y"] }}],
  "contacts": [{{ "id": "c", "edge": "upper.bottom", "against": "lower.top", "friction": 0.5, "gap": {} }}],
  "loads": {{
    "press": {{ "factor": 20, "items": [{{ "point": {{ "at": "upper.top", "force": [0, -1] }} }}] }},
    "shear": {{ "factor": {shear}, "items": [{{ "point": {{ "at": "upper.top", "force": [1, 0] }} }}] }}
  }},
  "stages": [{{ "press": 1 }}, {{ "press": 1, "shear": 1 }}]
}}"#,
        plate("lower", -30.0, lower),
        plate("upper", 0.0, upper),
        list(x.iter().map(|x| x * x / 100.0)),
    )
    .expect("a string takes all");
    text
}

#[test]
#[ignore = "a fine mesh: half a minute in debug"]
fn pressure_and_stick_zone_are_those_of_the_closed_forms() {
    // c = a √(1 − Q/fP) with a² = 8/π: 2/√π and √(2/π).
    for (shear, stick) in [(5.0, FRAC_2_SQRT_PI), (7.5, FRAC_2_PI.sqrt())] {
        let scenario = load_text("hertz", &scenario(shear), None).expect("sound");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let history = follow(prepared.case(&scenario, &scenario.parameter_values())).expect("a history");
        assert_eq!(history.end, HistoryEnd::Complete);
        let end = |stage: usize| &history.stages[stage].moments.last().expect("moments").pairs;
        let x = along();
        let pressed = end(0);
        let middle = x.iter().position(|x| *x == 0.0).expect("a line at 0");
        let p0 = pressed[middle].x_n / ELEMENT;
        assert!((p0 - 7.9788).abs() <= 0.003 * 7.9788, "p0 = {p0}");
        let half_width = |which: &dyn Fn(State) -> bool| {
            let held: Vec<f64> = end(1).iter().zip(&x).filter(|(pair, _)| which(pair.state)).map(|(_, x)| *x).collect();
            let (first, last) = (held.first().expect("some"), held.last().expect("some"));
            0.5 * (last - first) + 0.5 * ELEMENT
        };
        let a = half_width(&|state| state != State::Open);
        assert!((a - 1.5958).abs() <= ELEMENT, "a = {a}");
        let c = half_width(&|state| state == State::Stick);
        assert!((c - stick).abs() <= ELEMENT, "c = {c}");
        for stage in &history.stages {
            let energy = stage.energy.expect("a structure");
            assert!(energy.residual <= 1e-7, "{energy:?}");
            println!(
                "p0 {p0} a {a} c {c}: {} pivots, {} moments, dissipated {}, balance {}",
                stage.pivots,
                stage.moments.len(),
                stage.dissipated,
                energy.residual
            );
        }
    }
}
