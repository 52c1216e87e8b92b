//! Load histories in space where joints repeat one another: a node that rubs on a floor and stands at a stop, rubs in a guide,
//! or hangs between two stops. Friction of the floor and the stop's force share what pushes against the stop; the motion and
//! what is lost do not depend on how.

use nalgebra::{Matrix3, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::State;
use stickslip::path::stages::{History, HistoryEnd, StageResult, follow};

use crate::common::{Case, lines, near, near_all};

fn followed(case: &Case) -> History {
    let values = case.scenario.parameter_values();
    follow(case.prepared.case(&case.scenario, &values).under(case.scenario.rules)).unwrap_or_else(|e| panic!("{e}"))
}

/// A node on springs k along x and y, on a floor with friction f, before a stop across y at a distance with friction of its own.
#[derive(Clone, Copy)]
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
    let rounds: Vec<(Slider, f64, f64, f64)> = (0..12)
        .map(|round| {
            let slider = Slider {
                k: rng.random_range(0.5..4.0),
                weight: rng.random_range(5.0..20.0),
                friction: rng.random_range(0.05..0.5),
                gap: if round % 3 == 0 { 0.0 } else { rng.random_range(0.1..1.0) },
                at_stop: if round % 2 == 0 { 0.0 } else { rng.random_range(0.05..0.5) },
            };
            let turned = if round % 4 < 2 { 0.0 } else { rng.random_range(-3.0..3.0) };
            let against = slider.friction * slider.weight + slider.k * slider.gap + rng.random_range(1.0..5.0);
            let most = slider.friction * slider.weight + slider.at_stop * (against - slider.k * slider.gap);
            (slider, turned, against, most * rng.random_range(2.1..4.0))
        })
        .collect();
    lines::side_by_side(&rounds, |(slider, turned, against, along)| {
        let (Slider { k, weight, friction, gap, at_stop }, turned, against, along) =
            (*slider, *turned, *against, *along);
        let pressed = against - k * gap;
        let most = friction * weight + at_stop * pressed;
        let history = slider.history(
            turned,
            json!([{ "weight": 1 }, { "weight": 1, "against": against }, { "weight": 1, "against": against, "along": along },
                   { "weight": 1, "against": against }]),
        );
        let what = format!("k {k} W {weight} f {friction} g {gap} f2 {at_stop} Y {against} X {along}");
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
    });
}

/// Sliding at an angle against a guide: friction then has to turn at its bound without a slip before the node can slide along.
/// Judged by a march of its own: in each of many short steps K u = F + Σ r, the forces r of the contacts projected onto their
/// cones until nothing changes (De Saxcé's formulation, Gauss–Seidel), extrapolated from steps and half steps.
#[test]
fn a_slider_that_meets_a_guide_at_an_angle() {
    let springs = [
        ([-0.8080292439538632, -0.07781273227657076, -0.583981095251381], 1.75069607487281),
        ([-0.34911950458084984, 0.8616907913517405, 0.3682452329913218], 2.3598696782291957),
        ([-0.47455696437474154, -0.5014321078623364, 0.7234373012004319], 8.45403925717165),
    ];
    let across = [0.9873845647604357, -0.1583405231545136, 0.0];
    let (friction, gaps) = (0.2950372759699309, [0.3126307422075534, 0.3468114173514576]);
    let loads = [
        [0.0, 0.0, -12.822876831986264],
        [-3.7761295433000512, 1.389066384351226, 1.2602731520711707],
        [3.98194542610444, 11.83484312357875, 0.3765014502052982],
    ];
    let point = |force: [f64; 3]| json!({ "items": [{ "point": { "at": "n", "force": force } }] });
    let spring =
        |(direction, stiffness): &([f64; 3], f64)| json!({ "at": "n", "direction": direction, "stiffness": stiffness });
    let history = followed(&Case::json(json!({
        "dimension": 3,
        "nodes": { "n": [0, 0, 0] },
        "springs": springs.iter().map(spring).collect::<Vec<_>>(),
        "contacts": [
            { "id": "floor", "node": "n", "against": "ground", "normal": [0, 0, 1], "friction": friction },
            { "id": "near", "node": "n", "against": "ground", "normal": across, "law": "frictionless", "gap": gaps[0] },
            { "id": "far", "node": "n", "against": "ground", "normal": across.map(|n| -n), "law": "frictionless", "gap": gaps[1] }
        ],
        "loads": { "w": point(loads[0]), "a": point(loads[1]), "b": point(loads[2]) },
        "stages": [{ "w": 1 }, { "w": 1, "a": 1 }, { "w": 1, "b": 1 }, { "w": 1 }]
    })));
    assert_eq!(history.end, HistoryEnd::Complete);
    let k =
        springs.iter().fold(Matrix3::zeros(), |k, (d, s)| k + Vector3::from(*d) * Vector3::from(*d).transpose() * *s);
    let n = Vector3::from(across);
    let contacts = [(Vector3::z(), friction, 0.0), (n, 0.0, gaps[0]), (-n, 0.0, gaps[1])];
    let loads = loads.map(Vector3::from);
    let way = [loads[0], loads[0] + loads[1], loads[0] + loads[2], loads[0]];
    let [whole, half] = [200, 400].map(|steps| march(&k, &contacts, &way, steps));
    for (stage, (whole, half)) in history.stages.iter().zip(whole.iter().zip(&half)) {
        let u = &stage.end.displacements.as_ref().expect("a structure")[0];
        let expected = 2.0 * half - whole;
        // It slides some 2.5.
        near("u_x", u.ux, expected.x, 1e-4, 2.5);
        near("u_y", u.uy, expected.y, 1e-4, 2.5);
        assert!(stage.end.check.passed && stage.energy.expect("a structure").residual <= 1e-8, "{:?}", stage.end.check);
    }
}

/// u at the end of every stage, from no load; contacts: n, f and the gap.
fn march(
    k: &Matrix3<f64>,
    contacts: &[(Vector3<f64>, f64, f64)],
    way: &[Vector3<f64>],
    steps: usize,
) -> Vec<Vector3<f64>> {
    let flexibility = k.try_inverse().expect("regular");
    let rho = contacts.iter().map(|_| 1.0 / flexibility.symmetric_eigenvalues().max()).collect::<Vec<_>>();
    let (mut forces, mut u) = (vec![Vector3::zeros(); contacts.len()], Vector3::zeros());
    let mut from = Vector3::zeros();
    let mut ends = Vec::new();
    for to in way {
        for step in 1..=steps {
            let load = from + (to - from) * (step as f64 / steps as f64);
            let before = u;
            for _ in 0..400 {
                let mut change = 0.0_f64;
                for (i, (n, f, gap)) in contacts.iter().enumerate() {
                    u = flexibility * (load + forces.iter().sum::<Vector3<f64>>());
                    let slip = (u - before) - n * n.dot(&(u - before));
                    let open = n.dot(&u) + gap + f * slip.norm();
                    let tried = forces[i] - (n * open + slip) * rho[i];
                    let (pressed, along) = (n.dot(&tried), tried - n * n.dot(&tried));
                    let size = along.norm();
                    let next = if size <= f * pressed {
                        tried
                    } else if f * size <= -pressed {
                        Vector3::zeros()
                    } else {
                        let pressed = (pressed + f * size) / (1.0 + f * f);
                        n * pressed + along * if size > 0.0 { f * pressed / size } else { 0.0 }
                    };
                    change = change.max((next - forces[i]).amax());
                    forces[i] = next;
                }
                if change <= 1e-11 * load.amax() {
                    break;
                }
            }
            u = flexibility * (load + forces.iter().sum::<Vector3<f64>>());
        }
        from = *to;
        ends.push(u);
    }
    ends
}
