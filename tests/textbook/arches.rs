//! Voussoir arches of nearly rigid blocks: limits against an equilibrium linear program computed elsewhere
//! (SciPy/HiGHS), certificates judged from geometry and loads alone.

use std::f64::consts::PI;

use serde_json::{Map, Value, json};
use stickslip::answer::record::{OutcomeKind, Verdict};
use stickslip::model::rules::Rules;
use stickslip::path::limit::limit;
use stickslip::session::{Format, Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

use crate::common::Case;

/// A semicircular arch of mean radius 1, cut by radial joints into equal blocks, each joint with two pairs at its ends;
/// the weight of a block, π / blocks, acts in the centroid of its centreline arc, and as much times H sideways.
fn arch(blocks: usize, thickness: f64, friction: f64) -> Case {
    let (inner, outer) = (1.0 - thickness / 2.0, 1.0 + thickness / 2.0);
    let angle = PI / blocks as f64;
    // Forces at the four corners with their centroid at radius sin(a/2)/(a/2) on the bisector.
    let radius = (angle / 2.0).tan() / (angle / 2.0);
    let outside = angle / 2.0 * (radius - inner) / (outer - inner);
    let inside = angle / 2.0 - outside;
    let (mut nodes, mut quads, mut contacts) = (Map::new(), Vec::new(), Vec::new());
    let (mut weight, mut quake) = (Vec::new(), Vec::new());
    for b in 0..blocks {
        let (from, to) = (angle * b as f64, angle * (b + 1) as f64);
        let corners = [("a", inner, from), ("b", outer, from), ("c", outer, to), ("d", inner, to)];
        for (letter, r, at) in corners {
            let id = format!("B{b}{letter}");
            let force = if r > 1.0 { outside } else { inside };
            nodes.insert(id.clone(), json!([r * at.cos(), r * at.sin()]));
            weight.push(json!({"point": {"at": id, "force": [0, -force]}}));
            quake.push(json!({"point": {"at": id, "force": [force, 0]}}));
        }
        let ids: Vec<String> = corners.iter().map(|(letter, ..)| format!("B{b}{letter}")).collect();
        quads
            .push(json!({"id": format!("B{b}"), "nodes": ids, "thickness": 1, "material": "stone", "plane": "stress"}));
    }
    for joint in 0..=blocks {
        let at = angle * joint as f64;
        for (side, own, other) in [("i", "a", "d"), ("o", "b", "c")] {
            let (node, against, normal) = match joint {
                0 => (format!("B0{own}"), "ground".to_owned(), json!([0, 1])),
                last if last == blocks => (format!("B{}{other}", blocks - 1), "ground".to_owned(), json!([0, 1])),
                _ => (format!("B{joint}{own}"), format!("B{}{other}", joint - 1), json!([-at.sin(), at.cos()])),
            };
            contacts.push(json!({"id": format!("j{joint}{side}"), "node": node, "against": against, "normal": normal,
                                 "friction": "f"}));
        }
    }
    Case::json(json!({
        "parameters": {"f": friction, "H": 0},
        "materials": {"stone": {"E": 1e6, "nu": 0.2}},
        "nodes": Value::Object(nodes), "quads": quads, "contacts": contacts,
        "loads": {"weight": {"items": weight}, "quake": {"factor": "H", "items": quake}},
    }))
}

fn limit_of(case: &Case) -> (f64, stickslip::answer::record::Ray, bool) {
    let values = case.scenario.parameter_values();
    let found = limit(case.prepared.case(&case.scenario, &values), None, "quake").expect("a path");
    (found.factor.expect("a limit"), found.collapse().cloned().expect("a collapse"), found.confirmed)
}

#[test]
fn limits_of_arches_are_those_of_an_independent_linear_program() {
    // Blocks, thickness / radius, friction, horizontal acceleration at the limit.
    for (blocks, thickness, friction, expected) in [
        (9, 0.15, 0.7, 0.145820055),
        (15, 0.15, 0.7, 0.150117944),
        (21, 0.15, 0.7, 0.148316546),
        (21, 0.15, 0.4, 0.052160648),
        (21, 0.15, 0.37, 0.020643268),
        (21, 0.2, 0.4, 0.097226935),
        (33, 0.15, 0.7, 0.146016213),
    ] {
        let case = arch(blocks, thickness, friction);
        let (factor, collapse, confirmed) = limit_of(&case);
        assert!((factor - expected).abs() < 1e-8, "{blocks} {thickness} {friction}: {factor} for {expected}");
        assert_eq!(collapse.verdict, Some(Verdict::Certified), "{blocks}: {}", collapse.explanation);
        assert!(confirmed);
    }
}

/// The least friction with which an odd number of rigid blocks stands under its weight, from statics. Half the arch, its
/// weight per radian 1, is pushed by a thrust h in the middle of the keystone, level by symmetry and at a height y. At the
/// joint at the angle a from there N = h cos a + a sin a and T = h sin a − a cos a; moments about the centre put N at the
/// radius (h y + 1 − cos a)/N, which must lie in the joint. T/N grows with h at every joint, so that the largest |T/N|
/// falls and then rises.
fn least_friction(blocks: usize, thickness: f64) -> f64 {
    let joints: Vec<f64> = (0..=blocks / 2).map(|k| (k as f64 + 0.5) * PI / blocks as f64).collect();
    let normal = |h: f64, a: f64| h * a.cos() + a * a.sin();
    let friction =
        |h: f64| joints.iter().map(|&a| ((h * a.sin() - a * a.cos()) / normal(h, a)).abs()).fold(0.0, f64::max);
    // Whether one h y suits every joint.
    let stands = |h: f64| {
        let moment = |radius: f64| joints.iter().map(move |&a| radius * normal(h, a) - (1.0 - a.cos()));
        let lower = moment(1.0 - thickness / 2.0).fold(f64::NEG_INFINITY, f64::max);
        lower <= moment(1.0 + thickness / 2.0).fold(f64::INFINITY, f64::min)
    };
    let grid = (1..=20_000).map(|i| f64::from(i) * 1e-4);
    let best = grid.filter(|&h| stands(h)).min_by(|a, b| friction(*a).total_cmp(&friction(*b))).expect("it stands");
    // A finer look around it; thrusts at which it does not stand are worse than any.
    let cost = |h: f64| if stands(h) { friction(h) } else { f64::INFINITY };
    let (mut best, mut step) = (best, 1e-4);
    while step > 1e-14 {
        step /= 10.0;
        best =
            (-10..=10).map(|i| best + f64::from(i) * step).min_by(|a, b| cost(*a).total_cmp(&cost(*b))).expect("some");
    }
    friction(best)
}

/// With t/R = 0.15 and 21 blocks the linear program finds 0.350458429 as well.
#[test]
fn the_least_friction_of_an_arch_is_that_of_statics() {
    for (blocks, thickness) in [(21, 0.15), (9, 0.2)] {
        let expected = least_friction(blocks, thickness);
        let mut session = Session::new(arch(blocks, thickness, 0.7).scenario, &Quiet).unwrap();
        let mut text = Vec::new();
        let mut io = Output::new(&mut text, Style::default(), Format::JsonLines, &Quiet);
        session.execute("find least f 0..1 where outcome answer", &mut io).unwrap();
        let found = &serde_json::from_slice::<Value>(&text).unwrap()["report"];
        let value = found["value"].as_f64().unwrap();
        assert!((value - expected).abs() < 2e-8, "{blocks}: {value}, not {expected}");
        assert_eq!(found["collapse"]["verdict"], "certified", "{found}");
    }
    assert!((least_friction(21, 0.15) - 0.350458429).abs() < 2e-8);
}

/// Displacements (u_x, u_y) of the nodes of a proof's motion, judged from the user's data: every block stays rigid, every
/// pair parts by at least f times its slip, and the loads do work.
#[test]
fn certificates_of_arches_hold_from_geometry_and_loads_alone() {
    for (blocks, push) in [(21, 0.15), (51, 0.1454), (99, 0.1448)] {
        let friction = 0.7;
        let case = arch(blocks, 0.15, friction);
        let solved = case.solved(&[("H", push)], Rules::default());
        assert_eq!(solved.answer.outcome, OutcomeKind::Ray);
        let report = solved.ray.as_ref().expect("a report");
        assert_eq!(report.verdict, Some(Verdict::Certified), "{blocks}");
        assert!(!report.certificate.as_ref().expect("a certificate").exact, "every margin has room");
        let u = &report.certificate_mode.as_ref().expect("a motion").displacements;
        let scenario = &case.scenario;
        let stickslip::model::scenario::Source::Structure(structure) = &scenario.source else { panic!() };
        let place = |n: usize| structure.nodes[n].position;
        for element in &structure.elements {
            // Rigid: no two corners change their distance.
            for (i, &a) in element.nodes.iter().enumerate() {
                for &b in &element.nodes[..i] {
                    let d = [place(a)[0] - place(b)[0], place(a)[1] - place(b)[1]];
                    let stretch = d[0] * (u[a][0] - u[b][0]) + d[1] * (u[a][1] - u[b][1]);
                    assert!(stretch.abs() < 1e-12, "{stretch:e}");
                }
            }
        }
        for pair in &structure.pairs {
            let d = [0, 1].map(|i| pair.weights.iter().map(|&(node, weight)| weight * u[node][i]).sum::<f64>());
            let [n_x, n_y, _] = pair.normal;
            let (opens, slips) = (n_x * d[0] + n_y * d[1], n_y * d[0] - n_x * d[1]);
            assert!(opens > friction * slips.abs(), "{}: {opens:e} {slips:e}", pair.id);
        }
        let mut work = 0.0;
        for case in &structure.load_cases {
            let factor = if case.name == "quake" { push } else { 1.0 };
            for load in &case.loads {
                let stickslip::model::structure::Load::Nodal { node, force, .. } = load else { panic!() };
                work += factor * (force[0] * u[*node][0] + force[1] * u[*node][1]);
            }
        }
        assert!(work > 0.0);
        let certificate = report.certificate.as_ref().expect("a certificate");
        assert!((work / certificate.power - 1.0).abs() < 1e-6, "{work} {}", certificate.power);
    }
}

/// A block in a slot: confined on both sides, so that no motion parts everywhere and the proof needs exact equations.
#[test]
fn a_confined_block_is_certified_by_exact_equations() {
    let case = |up: f64, slope: f64| {
        let (c, s) = (slope.cos(), slope.sin());
        let at = |x: f64, y: f64| json!([c * x - s * y, s * x + c * y]);
        let wall = |sign: f64| json!([sign * c, sign * s]);
        Case::json(json!({
            "parameters": {"P": up},
            "materials": {"m": {"E": 1000, "nu": 0.2}},
            "nodes": {"a": at(0.0, 0.0), "b": at(1.0, 0.0), "c": at(1.0, 2.0), "d": at(0.0, 2.0)},
            "quads": [{"id": "Q", "nodes": ["a", "b", "c", "d"], "thickness": 1, "material": "m", "plane": "stress"}],
            "contacts": [
                {"id": "la", "node": "a", "against": "ground", "normal": wall(1.0), "law": "frictionless"},
                {"id": "ld", "node": "d", "against": "ground", "normal": wall(1.0), "law": "frictionless"},
                {"id": "rb", "node": "b", "against": "ground", "normal": wall(-1.0), "law": "frictionless"},
                {"id": "rc", "node": "c", "against": "ground", "normal": wall(-1.0), "law": "frictionless"},
                {"id": "fa", "node": "a", "against": "ground", "normal": [-s, c], "law": "frictionless"},
            ],
            "loads": {"lift": {"factor": "P", "items": [{"point": {"at": "a", "force": [-s, c]}}]},
                      "squeeze": {"items": [{"point": {"at": "d", "force": [c, s]}},
                                            {"point": {"at": "c", "force": [-c, -s]}}]}},
        }))
    };
    for slope in [0.0, 0.3] {
        let lifted = case(1.0, slope).solved(&[], Rules::default());
        assert_eq!(lifted.answer.outcome, OutcomeKind::Ray, "{slope}");
        let report = lifted.ray.as_ref().expect("a report");
        assert_eq!(report.verdict, Some(Verdict::Certified), "{slope}");
        assert!(report.certificate.as_ref().expect("a certificate").exact, "no room between the walls");
        assert!(case(-1.0, slope).solved(&[], Rules::default()).answer.is_answer(), "{slope}");
    }
}
