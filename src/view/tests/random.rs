//! Any numbers, any names, any width: no report gets wider than it may, none panics.

use proptest::prelude::*;
use unicode_width::UnicodeWidthStr;

use super::sample::{beam, beam_ray, beam_structure, factors_under, plates, scenario, units};
use crate::answer::diagram::Internal;
use crate::answer::record::*;
use crate::fem::Piece;
use crate::model::pair::LawKind;
use crate::view::plot::{diagram, structure, trace, zone};
use crate::view::style::Style;
use crate::view::*;

/// Numbers of every size, NaN and infinities.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1e3..1e3f64,
        2 => (-300..300i32, -9.99..9.99f64).prop_map(|(e, m)| m * 10f64.powi(e)),
        1 => prop::sample::select(vec![
            0.0, -0.0, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, f64::NAN, f64::INFINITY,
        ]),
    ]
}

/// No `f`, so that no name is taken for `inf`.
fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        "[a-eg-z][a-eg-z0-9]{0,8}",
        (0..999usize).prop_map(|i| format!("joint[{i}]")),
        Just("接触面の名前".to_owned()),
        Just("a\u{1b}[31m\n\tb".to_owned()),
        "[a-eg-z ]{0,120}",
    ]
}

fn state() -> impl Strategy<Value = State> {
    prop::sample::select(vec![State::Open, State::Stick, State::SlipPlus, State::SlipMinus, State::Closed])
}

fn pair() -> impl Strategy<Value = PairState> {
    let law = prop::sample::select(LawKind::WORDS.map(|(_, law)| law).to_vec());
    let position = prop::option::weighted(0.9, prop::array::uniform3(number()));
    let numbers = prop::array::uniform7(number());
    let held = prop::option::of(state());
    (name(), law, state(), held, numbers, position, 0..4usize).prop_map(
        |(id, law, state, held, [x_n, x_t, z_n, z_t, bound, plus, minus], position, joint)| PairState {
            id,
            law,
            state,
            held,
            x_n,
            x_t,
            z_n,
            z_t,
            bound,
            reserve_plus: plus,
            reserve_minus: minus,
            position,
            joint,
            space: None,
        },
    )
}

fn pivot() -> impl Strategy<Value = PivotRecord> {
    let ties = prop::collection::vec(name(), 0..4);
    (0..2000usize, name(), name(), number(), ties, name()).prop_map(|(step, entering, leaving, p, ties, sentence)| {
        PivotRecord { step, entering, leaving, p, ties, turned: None, sentence }
    })
}

fn style() -> impl Strategy<Value = Style> {
    (16..140usize, any::<bool>()).prop_map(|(width, ascii)| Style { width, color: false, ascii })
}

fn outcome() -> impl Strategy<Value = OutcomeKind> {
    prop::sample::select(vec![
        OutcomeKind::Trivial,
        OutcomeKind::Normal,
        OutcomeKind::Ray,
        OutcomeKind::PivotLimit,
        OutcomeKind::Breakdown,
        OutcomeKind::CheckFailed,
    ])
}

/// Runs a report and looks at its lines.
fn narrow(style: &Style, report: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) {
    let mut out = Vec::new();
    report(&mut out).expect("a vector takes everything");
    let text = String::from_utf8(out).expect("UTF-8");
    for line in text.lines() {
        assert!(line.width() <= style.width, "{} > {}: {line}\nin\n{text}", line.width(), style.width);
        assert!(!line.contains('\x1b'), "an escape of the input: {line:?}");
        assert!(!style.ascii || line.is_ascii(), "not ASCII: {line}");
        assert!(!line.contains("NaN") && !line.contains("inf"), "{line}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn reports_keep_to_their_width(
        pairs_ in prop::collection::vec(pair(), 0..12),
        pivots_ in prop::collection::vec(pivot(), 0..8),
        outcome in outcome(),
        failure in prop::option::of(name()),
        f2 in number(),
        style in style(),
    ) {
        let units = units();
        let previous = beam(0.3, 130.0);
        let mut ray = beam_ray().ray;
        if let (Some(ray), Some(pair)) = (&mut ray, pairs_.first()) {
            ray.p = pair.x_n;
            ray.mode = pair.id.clone();
            ray.direction =
                Direction::Pairs(vec![PairDirection { pair: pair.id.clone(), z_n: pair.z_n, z_t: Slip::Plane(pair.z_t) }]);
        }
        let answer = Answer {
            outcome, failure, pairs: pairs_, pivot_count: pivots_.len(), pivots: pivots_, p: f2, marginal: f2 > 0.0,
            ray: ray.filter(|_| outcome == OutcomeKind::Ray),
            ..beam(0.3, 100.0)
        };
        let scenario = scenario();
        let mut values = scenario.parameter_values();
        values.insert("F2".into(), f2);
        let s = &style;
        narrow(s, |out| {
            use std::io::Write;
            writeln!(out, "{}", status::line(&answer, Some(&previous), &units, s))
        });
        narrow(s, |out| status::write(out, &answer, &scenario, &values, s));
        narrow(s, |out| pairs::write(out, &answer.pairs, &units, s));
        narrow(s, |out| pivots::write(out, &answer, None, Some(1), &units, s));
        narrow(s, |out| pivots::write(out, &answer, Some(3..=4), None, &units, s));
        narrow(s, |out| parameters::write(out, &scenario, &values, s));
        narrow(s, |out| check::write(out, &answer, s));
        narrow(s, |out| difference::write(out, &previous, &answer, s));
        let nodes: Vec<NodeDisplacement> = answer.pairs.iter().map(|p| NodeDisplacement {
            node: p.id.clone(), ux: p.z_n, uy: p.z_t, rz: p.x_n, ..NodeDisplacement::default()
        }).collect();
        narrow(s, |out| displacements::write(out, &nodes, &units, s));
        let supports: Vec<Reaction> = answer.pairs.iter().map(|p| Reaction {
            node: p.id.clone(), fx: p.z_n, fy: p.z_t, m: p.x_n, space: None,
        }).collect();
        narrow(s, |out| reactions::write(out, &supports, [0.0, 0.0, 1.5], &units, s));
        let forces: Vec<MemberForces> = answer.pairs.iter().map(|p| MemberForces {
            bar: p.id.clone(), element: 0,
            start: EndForces { n: p.x_n, q: p.x_t, m: p.z_n, space: None }, end: EndForces::default(), pieces: Vec::new(),
        }).collect();
        narrow(s, |out| members::write(out, &forces, None, &units, s));
        if let Some(ray) = &answer.ray {
            narrow(s, |out| ray::write(out, ray, &units, s));
            narrow(s, |out| zone::mode(out, ray, &answer.pairs, &units, 8, s));
        }
    }

    #[test]
    fn plots_take_any_numbers(
        first in prop::collection::vec(pair(), 0..30),
        second in prop::collection::vec(pair(), 0..3),
        pivots_ in prop::collection::vec(pivot(), 0..30),
        height in 0..40usize,
        style in style(),
    ) {
        use zone::Quantity::{Force, Gap, Pressure, Slip};
        let units = units();
        let s = &style;
        for quantity in [Slip, Force, Gap, Pressure] {
            let states: [(&str, &[PairState]); 2] = [("first", &first), ("last", &second)];
            narrow(s, |out| zone::write(out, quantity, &states[..1], &units, height, s));
            narrow(s, |out| zone::write(out, quantity, &states[1..], &units, height, s));
            narrow(s, |out| zone::write(out, quantity, &states, &units, height, s));
            narrow(s, |out| zone::write(out, quantity, &[], &units, height, s));
        }
        narrow(s, |out| trace::write(out, &pivots_, Some(1), &units, height, s));
    }

    #[test]
    fn structures_take_any_displacements(
        u in prop::collection::vec(prop::array::uniform3(number()), 90),
        places in prop::collection::vec(prop::array::uniform2(number()), 6),
        states in prop::collection::vec(pair(), 0..9),
        factor in prop::option::of(number()),
        height in 0..40usize,
        style in style(),
    ) {
        use crate::view::plot::scene::{Magnification, Picture};
        let mut moved = beam_structure();
        for (node, place) in moved.nodes.iter_mut().zip(&places) {
            // A checked structure has finite coordinates.
            let [x, y] = place.map(|x| if x.is_finite() { x } else { 0.0 });
            node.position = [x, y, 0.0];
        }
        let s = &style;
        for structure in [beam_structure(), plates(), moved] {
            let displacements: Vec<NodeDisplacement> = structure.nodes.iter().zip(&u).map(|(node, u)| {
                NodeDisplacement { node: node.id.clone(), ux: u[0], uy: u[1], rz: u[2], ..NodeDisplacement::default() }
            }).collect();
            let picture = Picture {
                title: "any", structure: &structure, displacements: Some(&displacements), factors: &[1.0],
                pairs: Some(&states), height,
                magnification: factor.map_or(Magnification::Auto, Magnification::Factor),
                viewpoint: crate::view::projection::Viewpoint::default(),
            };
            narrow(s, |out| structure::write(out, &picture, None, s));
            let factors = factors_under(&structure, u[0][0]);
            narrow(s, |out| structure::write(out, &picture, Some((&factors, &units())), s));
            let members: Vec<MemberForces> = (0..5).map(|element| MemberForces {
                bar: "AF".into(), element,
                start: EndForces { n: u[element][0], q: u[element][1], m: u[element][2], space: None },
                end: EndForces { n: u[element + 9][0], q: u[element + 9][1], m: u[element + 9][2], space: None },
                pieces: vec![Piece {
                    range: [element as f64, element as f64 + 1.0],
                    start: [u[element][0], u[element][1], u[element][2], 0.0, 0.0, 0.0],
                    q: [0, 1].map(|end| [u[element + 9][end], u[element + 9][end + 1], 0.0]),
                }],
            }).collect();
            for force in [Internal::Axial, Internal::Shear, Internal::Moment] {
                let drawn = diagram::Drawing { members: &members, bar: "AF", force, height };
                narrow(s, |out| diagram::write(out, &drawn, &units(), s));
            }
        }
    }
}

#[test]
fn an_empty_structure_draws_nothing() {
    let empty = crate::model::structure::Structure::default();
    let picture = crate::view::plot::scene::Picture {
        title: "empty",
        structure: &empty,
        displacements: Some(&[]),
        factors: &[],
        pairs: None,
        magnification: crate::view::plot::scene::Magnification::Auto,
        viewpoint: crate::view::projection::Viewpoint::default(),
        height: 10,
    };
    let style = Style::default();
    narrow(&style, |out| structure::write(out, &picture, None, &style));
}
