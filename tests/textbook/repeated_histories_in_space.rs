//! Load histories in space over joints that repeat one another.

use nalgebra::Rotation3;
use serde_json::{Value, json};
use stickslip::path::stages::{Begin, History, HistoryEnd, follow_factors};

use super::guides::{EA, EI, L};
use super::repeated_in_space::{SIDES, guided, turned, vector};
use crate::common::*;

/// Factors of press, push and pull.
fn history(case: &Case, stages: &[[f64; 3]]) -> History {
    let values = case.scenario.parameter_values();
    let targets: Vec<Vec<f64>> = stages.iter().map(|stage| stage.to_vec()).collect();
    follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &targets)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Two guides share the shoe of a pipe that is pressed with P = 1 on the low one, then pulled to and fro. Friction bound
/// r = f (P − k g₁). Pulled by T the tip slips by s = (T − r)/k_a; unloaded it stays, held by k_a s = T − r; pulled back by −T
/// it slips to −s, from k_a s − r on.
#[test]
fn two_guides_under_a_cyclic_pull() {
    let (k, k_a) = (3.0 * EI / L.powi(3), EA / L);
    let (pull, r) = (0.5, 0.3 * (1.0 - k * 0.01));
    let s = (pull - r) / k_a;
    for rotation in turned() {
        let case = guided(&rotation, &SIDES);
        let stages = [0.0, pull, 0.0, -pull, pull].map(|pull| [0.0, 1.0, pull]);
        let found = history(&case, &stages);
        assert_eq!(found.end, HistoryEnd::Complete);
        let slips = [0.0, s, s, -s, s];
        let friction = [0.0, -r, k_a * s, r, -r];
        for ((stage, slip), friction) in found.stages.iter().zip(slips).zip(friction) {
            let [low, up] = &stage.end.pairs[..] else { panic!() };
            near_all("slip", &low.slip(), &[slip, 0.0], 1e-8);
            near_all("slip", &up.slip(), &[slip, 0.0], 1e-8);
            near("friction", low.friction()[0] + up.friction()[0], friction, 1e-8, 1.0);
            near("x_n", low.x_n, 1.0 - k * 0.01, 1e-8, 1.0);
            near("z_n", up.z_n, 0.03, 1e-8, 0.03);
            assert!(stage.energy.expect("a structure").residual < 1e-7);
        }
        for (stage, way) in found.stages.iter().zip([0.0, s, 0.0, 2.0 * s, 2.0 * s]) {
            near("dissipated", stage.dissipated, r * way, 1e-7, r * s);
        }
        let begins = found.stages[3].moments.iter().find(|moment| !moment.changes.is_empty()).expect("a slip");
        // Events are crossed in steps of 1e-7 of a stage, in which T goes by 1/2.
        near("reversal", begins.factors[2], k_a * s - r, 1e-7, 1.0);
    }
}

/// What resists the shoe of [`slider`]: k along x and y, and f W.
const SPRING: f64 = 2.0;
const BOUND: f64 = 0.1 * 100.0;
/// What a guide leaves the shoe to the side.
const CLEARANCE: f64 = 1.0;

/// A shoe pressed by W = 100 on a floor of friction 0.1, held by springs along x and y, between as many guides at
/// y = ±[`CLEARANCE`] as asked for, with their friction.
fn slider(rotation: &Rotation3<f64>, guides: usize, friction: f64) -> Case {
    let v = |x: f64, y: f64, z: f64| vector(rotation, x, y, z);
    let load = |force: Value| json!({ "items": [{ "point": { "at": "n", "force": force } }] });
    let pair = |id: &str, normal: Value, friction: f64, gap: f64| {
        json!({ "id": id, "node": "n", "against": "ground", "normal": normal, "tangent": v(1.0, 0.0, 0.0),
                "friction": friction, "gap": gap })
    };
    let mut contacts = vec![
        pair("shoe", v(0.0, 0.0, 1.0), 0.1, 0.0),
        pair("left", v(0.0, -1.0, 0.0), friction, CLEARANCE),
        pair("right", v(0.0, 1.0, 0.0), friction, CLEARANCE),
    ];
    contacts.truncate(1 + guides);
    let spring = |direction: Value| json!({ "at": "n", "direction": direction, "stiffness": SPRING });
    Case::json(json!({
        "dimension": 3,
        "nodes": { "n": [0, 0, 0] },
        "springs": [spring(v(1.0, 0.0, 0.0)), spring(v(0.0, 1.0, 0.0))],
        "contacts": contacts,
        "loads": { "weight": load(v(0.0, 0.0, -100.0)), "along": load(v(1.0, 0.0, 0.0)), "aside": load(v(0.0, 1.0, 0.0)) }
    }))
}

/// The shoe of [`slider`] by steps of its own: where nothing holds it aside it goes along what is left of the load beyond
/// friction, which is exact for springs alike in both directions; along a guide it goes by what friction on both leaves.
#[derive(Clone, Copy, Default)]
struct Shoe {
    at: [f64; 2],
    /// Since the stage began.
    dissipated: f64,
}

impl Shoe {
    /// Where it goes under this load without guides.
    fn freely(&self, load: [f64; 2]) -> [f64; 2] {
        let left = [0, 1].map(|i| load[i] - SPRING * self.at[i]);
        let size = left[0].hypot(left[1]);
        let share = (1.0 - BOUND / size).max(0.0) / SPRING;
        [0, 1].map(|i| self.at[i] + if size > BOUND { share * left[i] } else { 0.0 })
    }

    fn go(&mut self, to: [f64; 2], resistance: f64) {
        self.dissipated += resistance * (to[0] - self.at[0]).hypot(to[1] - self.at[1]);
        self.at = to;
    }

    /// A step between two loads; `walls` are the least and the largest y, `friction` theirs.
    fn step(&mut self, from: [f64; 2], to: [f64; 2], walls: [f64; 2], friction: f64) {
        let free = self.freely(to);
        if free[1] >= walls[0] && free[1] <= walls[1] {
            return self.go(free, BOUND);
        }
        let wall = if free[1] > 0.0 { walls[1] } else { walls[0] };
        if self.at[1] != wall {
            // As far as the wall under a part of the step.
            let (mut low, mut high) = (0.0, 1.0);
            let part = |share: f64| [0, 1].map(|i| from[i] + share * (to[i] - from[i]));
            for _ in 0..60 {
                let share = 0.5 * (low + high);
                let beyond = (self.freely(part(share))[1] - wall).abs() < (free[1] - wall).abs()
                    && self.freely(part(share))[1].abs() < wall.abs();
                if beyond { low = share } else { high = share }
            }
            let reached = self.freely(part(low));
            self.go([reached[0], wall], BOUND);
        }
        let resistance = BOUND + friction * (to[1] - SPRING * wall).abs();
        let left = to[0] - SPRING * self.at[0];
        let way = (left.abs() - resistance).max(0.0) / SPRING * left.signum();
        self.go([self.at[0] + way, wall], resistance);
    }

    /// Its places and dissipation after each stage, the loads of a stage applied in n steps.
    fn followed(stages: &[[f64; 2]], n: usize, walls: [f64; 2], friction: f64) -> Vec<[f64; 3]> {
        let (mut shoe, mut load) = (Shoe::default(), [0.0; 2]);
        let stage = |target: &[f64; 2]| {
            shoe.dissipated = 0.0;
            let part = |j: usize| [0, 1].map(|i| load[i] + (target[i] - load[i]) * j as f64 / n as f64);
            (1..=n).for_each(|j| shoe.step(part(j - 1), part(j), walls, friction));
            load = *target;
            [shoe.at[0], shoe.at[1], shoe.dissipated]
        };
        stages.iter().map(stage).collect()
    }
}

/// A shoe that rubs on its floor and on a stop or on two guides, pushed against one, along it, away from it and back: it is
/// where small steps of [`Shoe`] lead, with what these dissipate, each extrapolated from n and 2 n of them. Along the left
/// guide (y = 1) that is x = (30 − f W − f' (15 − k))/k. Friction there may hold the shoe wedged between guide and floor once
/// the push aside is gone, so that from there on more than one way obeys the laws: what is found then only has to be one.
#[test]
fn shoe_along_stop_and_guides() {
    let loads = [[0.0, 0.0], [0.0, 15.0], [30.0, 15.0], [30.0, -15.0], [0.0, 0.0]];
    let turned = turned();
    for (rotation, guides, friction) in [(&turned[0], 1, 0.0), (&turned[1], 2, 0.0), (&turned[0], 2, 0.1)] {
        let walls = [if guides == 2 { -CLEARANCE } else { f64::NEG_INFINITY }, CLEARANCE];
        let [coarse, fine] = [4_000, 8_000].map(|n| Shoe::followed(&loads, n, walls, friction));
        let along = (30.0 - BOUND - friction * (15.0 - SPRING * CLEARANCE)) / SPRING;
        near("closed form", fine[2][0], along, 1e-9, along);
        let case = slider(rotation, guides, friction);
        let found = history(&case, &loads.map(|[along, aside]| [1.0, along, aside]));
        assert_eq!(found.end, HistoryEnd::Complete);
        for (i, stage) in found.stages.iter().enumerate() {
            let what = format!("{guides} guides, friction {friction}, stage {}", i + 1);
            is_answer(&stage.end);
            if friction > 0.0 && i > 2 {
                continue;
            }
            let right = [0, 1, 2].map(|part| 2.0 * fine[i][part] - coarse[i][part]);
            near_all(&what, &stage.end.pairs[0].slip(), &right[..2], 1e-6);
            near(&format!("dissipated, {what}"), stage.dissipated, right[2], 1e-6, 100.0);
            assert!(stage.energy.expect("a structure").residual < 1e-9, "{what}: {:?}", stage.energy);
        }
    }
}

/// A pipe on three shoes in a row, fixed at one end, the middle one between guides: heated, shoe after shoe slips, the outermost
/// first. At last all do, and ℓ of pipe between two of them grows by ℓ (α ΔT − N/EA), N what friction of the shoes beyond adds
/// up to.
#[test]
fn heated_pipe_between_guides() {
    let (modulus, area, expansion, span, heat, f) = (2e8, 0.008, 1.2e-5, 8.0, 150.0, 0.3);
    let pair = |id: &str, node: &str, normal: [f64; 3], friction: f64, gap: f64| json!({ "id": id, "node": node, "against": "ground", "normal": normal, "friction": friction, "gap": gap });
    let up = [0.0, 0.0, 1.0];
    let case = Case::json(json!({
        "dimension": 3,
        "materials": { "m": { "E": modulus, "nu": 0.3, "expansion": expansion } },
        "sections": { "s": { "area": area, "inertia_y": 8e-5, "inertia_z": 8e-5, "torsion": 1.6e-4 } },
        "nodes": { "o": [0, 0, 0], "a": [span, 0, 0], "b": [2.0 * span, 0, 0], "c": [3.0 * span, 0, 0] },
        "bars": [{ "id": "pipe", "polyline": ["o", "a", "b", "c"], "material": "m", "section": "s" }],
        "supports": [{ "at": "o", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": [
            pair("shoe_a", "a", up, f, 0.0), pair("shoe_b", "b", up, f, 0.0), pair("shoe_c", "c", up, f, 0.0),
            pair("left", "b", [0.0, -1.0, 0.0], f, 0.003), pair("right", "b", [0.0, 1.0, 0.0], f, 0.003)
        ],
        "loads": {
            "weight": { "items": [{ "line": { "bar": "pipe", "value": [0, 0, -1.2] } }] },
            "heat": { "items": [{ "temperature": { "change": 1, "on": ["pipe"] } }] }
        }
    }));
    let values = case.scenario.parameter_values();
    let targets = [vec![1.0, 0.0], vec![1.0, heat]];
    let found = follow_factors(case.prepared.case(&case.scenario, &values), &Begin::Unloaded, &targets)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(found.end, HistoryEnd::Complete);
    let stage = &found.stages[1];
    is_answer(&stage.end);
    let shoes = &stage.end.pairs[..3];
    let mut grown = 0.0;
    for i in 0..3 {
        let held: f64 = shoes[i..].iter().map(|shoe| f * shoe.x_n).sum();
        grown += span * (expansion * heat - held / (modulus * area));
        let slip = shoes[i].slip();
        near(&shoes[i].id, slip[0].hypot(slip[1]), grown, 1e-9, grown);
    }
    assert!(shoes.iter().all(|shoe| shoe.x_n > 1.0), "the pipe lies on all of them");
    assert!(stage.energy.expect("a structure").residual < 1e-12);
}
