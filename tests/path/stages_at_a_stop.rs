//! Load histories in space where joints repeat one another: a node that rubs on a floor and stands at a stop, rubs in a guide,
//! or hangs between two stops. Friction of the floor and the stop's force share what pushes against the stop; the motion and
//! what is lost do not depend on how.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::State;
use stickslip::path::stages::{History, HistoryEnd, StageResult, follow};

use crate::common::{Case, near, near_all};

fn followed(case: &Case) -> History {
    let values = case.scenario.parameter_values();
    follow(case.prepared.case(&case.scenario, &values).under(case.scenario.rules)).unwrap_or_else(|e| panic!("{e}"))
}

/// A node on springs k along x and y, on a floor with friction f, before a stop across y at a distance with friction of its own.
struct Slider {
    k: f64,
    weight: f64,
    friction: f64,
    gap: f64,
    at_stop: f64,
}

impl Slider {
    fn history(&self, turned: f64, stages: Value) -> History {
        let Slider { k, weight, friction, gap, at_stop } = *self;
        let [c, s] = [turned.cos(), turned.sin()];
        let along = |x: f64, y: f64| json!([x * c - y * s, x * s + y * c, 0.0]);
        followed(&Case::json(json!({
            "dimension": 3,
            "nodes": { "n": [0, 0, 0] },
            "springs": [
                { "at": "n", "direction": along(1.0, 0.0), "stiffness": k },
                { "at": "n", "direction": along(0.0, 1.0), "stiffness": k }
            ],
            "contacts": [
                { "id": "floor", "node": "n", "against": "ground", "normal": [0, 0, 1], "friction": friction },
                { "id": "stop", "node": "n", "against": "ground", "normal": along(0.0, -1.0), "friction": at_stop, "gap": gap }
            ],
            "loads": {
                "weight": { "items": [{ "point": { "at": "n", "force": [0, 0, -weight] } }] },
                "along": { "items": [{ "point": { "at": "n", "force": along(1.0, 0.0) } }] },
                "against": { "items": [{ "point": { "at": "n", "force": along(0.0, 1.0) } }] }
            },
            "stages": stages
        })))
    }
}

/// Displacements along and against the stop.
fn moved(stage: &StageResult, turned: f64) -> [f64; 2] {
    let all = stage.end.displacements.as_ref().expect("a structure");
    let u = &all[0];
    let [c, s] = [turned.cos(), turned.sin()];
    [u.ux * c + u.uy * s, u.uy * c - u.ux * s]
}

/// The most that floor and stop can hold along the stop where nothing moves: the stop's friction can press on the floor by w
/// and the floor's press on the stop by t, √(f² (W + w)² − t²) + √(f₂² (N + t)² − w²), found on finer and finer grids.
fn most_that_holds(floor: [f64; 2], stop: [f64; 2]) -> f64 {
    let [[f, weight], [g, pressed]] = [floor, stop];
    let held = |w: f64, t: f64| {
        let [a, b] = [(f * (weight + w)).powi(2) - t * t, (g * (pressed + t)).powi(2) - w * w];
        if a < 0.0 || b < 0.0 { 0.0 } else { a.sqrt() + b.sqrt() }
    };
    let (mut at, mut size) = ([0.0, 0.0], weight + pressed);
    for _ in 0..60 {
        let places = (-10..=10).flat_map(|i| (-10..=10).map(move |j| [f64::from(i), f64::from(j)]));
        let places = places.map(|[i, j]| [at[0] + size * i / 10.0, at[1] + size * j / 10.0]);
        at = places.max_by(|a, b| held(a[0], a[1]).total_cmp(&held(b[0], b[1]))).expect("places");
        size *= 0.6;
    }
    held(at[0], at[1])
}

/// Pushed against the stop by Y > f W + k g it slides there, and the stop takes Y − f W − k g. Pulled along it by X it holds
/// until all friction goes against X: of the floor f W, which then takes no part of Y, of the stop f₂ (Y − k g). Beyond
/// R = f W + f₂ (Y − k g) it slides by (X − R)/k, and back, if X > 2 R, to R/k as X leaves. With friction in both, forces that no
/// motion determines may hold it longer, up to S; then it jumps, and loses up to (S − R)²/(2 k) more.
#[test]
fn a_slider_at_a_stop_follows_what_pulls_it_along() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    for round in 0..12 {
        let slider = Slider {
            k: rng.random_range(0.5..4.0),
            weight: rng.random_range(5.0..20.0),
            friction: rng.random_range(0.05..0.5),
            gap: if round % 3 == 0 { 0.0 } else { rng.random_range(0.1..1.0) },
            at_stop: if round % 2 == 0 { 0.0 } else { rng.random_range(0.05..0.5) },
        };
        let turned = if round % 4 < 2 { 0.0 } else { rng.random_range(-3.0..3.0) };
        let Slider { k, weight, friction, gap, at_stop } = slider;
        let against = friction * weight + k * gap + rng.random_range(1.0..5.0);
        let pressed = against - k * gap;
        let most = friction * weight + at_stop * pressed;
        let along = most * rng.random_range(2.1..4.0);
        let history = slider.history(
            turned,
            json!([{ "weight": 1 }, { "weight": 1, "against": against }, { "weight": 1, "against": against, "along": along },
                   { "weight": 1, "against": against }]),
        );
        let what = format!("round {round}: k {k} W {weight} f {friction} g {gap} f2 {at_stop} Y {against} X {along}");
        assert_eq!(history.end, HistoryEnd::Complete, "{what}");
        let far = (along - most) / k;
        let size = far + gap;
        let longer = (most_that_holds([friction, weight], [at_stop, pressed]) - most).powi(2) / (2.0 * k);
        let ends = [[0.0, 0.0], [0.0, gap], [far, gap], [most / k, gap]];
        let lost = [0.0, friction * weight * gap, most * far, most * (far - most / k)];
        for (number, (stage, (end, lost))) in history.stages.iter().zip(ends.into_iter().zip(lost)).enumerate() {
            near_all(&what, &moved(stage, turned), &end, 1e-9 * size);
            let more = if lost == 0.0 || number < 2 { 0.0 } else { longer };
            assert!(stage.dissipated >= lost - 1e-8 * most * far, "{what}: {} and not {lost}", stage.dissipated);
            assert!(
                stage.dissipated <= lost + more + 1e-8 * most * far,
                "{what}: {} and not {lost} + {more}",
                stage.dissipated
            );
            assert!(stage.end.check.passed, "{what}: stage {number} {:?} {:?}", stage.end.check, stage.end.pairs);
            assert!(stage.energy.expect("a structure").residual <= 1e-8, "{what}: {:?}", stage.energy);
        }
        for stage in &history.stages[2..] {
            let [floor, stop] = &stage.end.pairs[..] else { panic!("two pairs") };
            near(&what, floor.x_n, weight, 1e-9, weight);
            near(&what, stop.x_n, pressed, 1e-8, weight);
            assert_eq!(floor.state, State::Slip, "{what}");
        }
    }
}
