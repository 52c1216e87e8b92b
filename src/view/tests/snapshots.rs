//! Reports as they look: every report of the beam at three widths, with colour, in ASCII.

use std::io::{self, Write};

use unicode_width::UnicodeWidthStr;

use super::sample::{beam, beam_ray, beam_structure, cantilever, factors_under, plates, scenario, units};
use crate::answer::diagram::Internal;
use crate::answer::record::*;
use crate::view::plot::{diagram, scene, structure, trace, zone};
use crate::view::projection::Viewpoint;
use crate::view::style::Style;
use crate::view::*;

/// All reports of a state, one under the other.
fn everything(style: &Style) -> String {
    let units = units();
    let (before, now, ray) = (beam(0.3, 100.0), beam(0.3, 130.0), beam_ray());
    let scenario = scenario();
    let mut values = scenario.parameter_values();
    values.insert("F2".into(), 130.0);
    let mut out = Vec::new();
    let report = |name: &str, out: &mut Vec<u8>| writeln!(out, "\n= {name}");
    let mut all = || -> io::Result<()> {
        report("line", &mut out)?;
        writeln!(out, "{}", status::line(&now, None, &units, style))?;
        writeln!(out, "{}", status::line(&now, Some(&before), &units, style))?;
        writeln!(out, "{}", status::line(&ray, Some(&now), &units, style))?;
        report("status", &mut out)?;
        status::write(&mut out, &now, &scenario, &values, style)?;
        report("pairs", &mut out)?;
        pairs::write(&mut out, &now.pairs, &units, style)?;
        report("pivots", &mut out)?;
        pivots::write(&mut out, &now, None, Some(2), &units, style)?;
        report("displacements", &mut out)?;
        let nodes = now.displacements.as_deref().unwrap_or_default();
        displacements::write(&mut out, nodes, &units, style)?;
        report("members", &mut out)?;
        let forces = now.members.as_deref().unwrap_or_default();
        members::write(&mut out, forces, Some("AF"), &units, style)?;
        report("parameters", &mut out)?;
        parameters::write(&mut out, &scenario, &values, style)?;
        report("ray", &mut out)?;
        if let Some(ray) = &ray.ray {
            ray::write(&mut out, ray, &units, style)?;
        }
        report("check", &mut out)?;
        check::write(&mut out, &now, style)?;
        report("difference", &mut out)?;
        difference::write(&mut out, &before, &now, style)
    };
    all().expect("a vector takes everything");
    String::from_utf8(out).expect("UTF-8")
}

/// All pictures.
fn pictures(style: &Style) -> String {
    let units = units();
    let (first, last) = (beam(0.3, 100.0), beam(0.3, 130.0));
    let states: [(&str, &[PairState]); 2] = [("F2 = 100", &first.pairs), ("F2 = 130", &last.pairs)];
    let mut out = Vec::new();
    let mut all = || -> io::Result<()> {
        zone::write(&mut out, zone::Quantity::Slip, &states[1..], &units, 10, style)?;
        zone::write(&mut out, zone::Quantity::Slip, &states, &units, 10, style)?;
        zone::write(&mut out, zone::Quantity::Force, &states[1..], &units, 12, style)?;
        trace::write(&mut out, &last.pivots, Some(2), &units, 10, style)?;
        let bar = beam_structure();
        let forces = last.members.as_deref().unwrap_or_default();
        let drawn = diagram::Drawing { members: forces, bar: "AF", force: Internal::Axial, height: 8 };
        diagram::write(&mut out, &drawn, &units, style)?;
        let picture = scene::Picture {
            title: "beam",
            structure: &bar,
            displacements: last.displacements.as_deref(),
            factors: &[],
            pairs: Some(&last.pairs),
            magnification: scene::Magnification::Auto,
            viewpoint: Viewpoint::default(),
            height: 16,
        };
        structure::write(&mut out, &picture, None, style)?;
        let factors = factors_under(&bar, 130.0);
        structure::write(&mut out, &picture, Some((&factors, &units)), style)?;
        let (held, forces, moved) = cantilever();
        for force in [Internal::Shear, Internal::Moment] {
            let drawn = diagram::Drawing { members: &forces, bar: "AF", force, height: 9 };
            diagram::write(&mut out, &drawn, &units, style)?;
        }
        let picture = scene::Picture {
            title: "cantilever",
            structure: &held,
            displacements: Some(&moved),
            factors: &[1.0],
            pairs: None,
            magnification: scene::Magnification::Auto,
            viewpoint: Viewpoint::default(),
            height: 16,
        };
        let factors = factors_under(&held, 130.0);
        structure::write(&mut out, &picture, Some((&factors, &units)), style)?;
        let one = &last.pairs[5..];
        zone::write(&mut out, zone::Quantity::Pressure, &[("", one)], &units, 6, style)?;
        zone::write(&mut out, zone::Quantity::Gap, &states[1..], &units, 6, style)?;
        if let Some(ray) = beam_ray().ray {
            zone::mode(&mut out, &ray, &last.pairs, &units, 6, style)?;
        }
        let plates = plates();
        let moved: Vec<NodeDisplacement> = plates
            .nodes
            .iter()
            .map(|node| NodeDisplacement {
                node: node.id.clone(),
                ux: if node.id.starts_with("upper") { 1e-3 } else { 0.0 },
                uy: 0.0,
                rz: 0.0,
                ..NodeDisplacement::default()
            })
            .collect();
        let states: Vec<PairState> = (0..9)
            .map(|i| PairState {
                state: [State::Open, State::Stick, State::SlipPlus, State::SlipMinus][i % 4],
                ..last.pairs[0].clone()
            })
            .collect();
        let picture = scene::Picture {
            title: "plates",
            structure: &plates,
            displacements: Some(&moved),
            factors: &[],
            pairs: Some(&states),
            magnification: scene::Magnification::Auto,
            viewpoint: Viewpoint::default(),
            height: 20,
        };
        structure::write(&mut out, &picture, None, style)
    };
    all().expect("a vector takes everything");
    String::from_utf8(out).expect("UTF-8")
}

fn at(width: usize, ascii: bool) -> Style {
    Style { width, color: false, ascii }
}

fn assert_narrow(text: &str, width: usize) {
    for line in text.lines() {
        assert!(line.width() <= width, "{} > {width}: {line}", line.width());
    }
}

/// Colours by their names, so that a snapshot shows them.
fn visible(text: &str) -> String {
    text.replace('\x1b', "␛")
}

#[test]
fn reports_at_three_widths() {
    for width in [80, 120, 50] {
        let text = everything(&at(width, false));
        assert_narrow(&text, width);
        insta::assert_snapshot!(format!("reports_{width}"), text);
    }
}

#[test]
fn pictures_at_three_widths() {
    for width in [80, 120, 50] {
        let text = pictures(&at(width, false));
        assert_narrow(&text, width);
        insta::assert_snapshot!(format!("pictures_{width}"), text);
    }
}

#[test]
fn ascii_is_ascii() {
    let (reports, pictures) = (everything(&at(80, true)), pictures(&at(80, true)));
    for text in [&reports, &pictures] {
        let strange = text.chars().find(|c| !(*c == '\n' || (' '..='~').contains(c)));
        assert_eq!(strange, None);
        assert_narrow(text, 80);
    }
    insta::assert_snapshot!("reports_ascii", reports);
    insta::assert_snapshot!("pictures_ascii", pictures);
}

#[test]
fn colour_changes_nothing_but_colour() {
    let plain = at(80, false);
    let painted = Style { color: true, ..plain };
    for (plain, painted) in [(everything(&plain), everything(&painted)), (pictures(&plain), pictures(&painted))] {
        let mut stripped = String::new();
        for (place, piece) in painted.split("\x1b[").enumerate() {
            let text = match (place, piece.split_once('m')) {
                (0, _) | (_, None) => piece,
                (_, Some((_, text))) => text,
            };
            stripped.push_str(text);
        }
        assert_eq!(stripped, plain);
    }
    insta::assert_snapshot!("reports_colour", visible(&everything(&painted)));
}

#[test]
fn the_line_is_as_documented() {
    let units = units();
    let style = Style::default();
    let (mut before, mut now) = (beam(0.3, 130.0), beam(0.3, 130.0));
    before.pairs[5].z_t = 0.0005;
    before.pairs[4].z_t = 0.0004;
    now.pairs[5].z_t = 0.005;
    assert_eq!(
        status::line(&now, Some(&before), &units, &style),
        "normal · 5 pivots · 2 stick 4 slip+ 0 open · max slip 0.005 m at c6 (was 0.0005)"
    );
    now.outcome = OutcomeKind::Breakdown;
    now.failure = Some("the dictionary lost its digits".into());
    assert_eq!(
        status::line(&now, Some(&before), &units, &style),
        "breakdown · 5 pivots · the dictionary lost its digits"
    );
    let stuck = beam(0.3, 20.0);
    assert_eq!(
        status::line(&stuck, Some(&before), &units, &style),
        "normal · 1 pivot · 6 stick 0 slip+ 0 open · no slip (was 0.0005)"
    );
}

#[test]
fn an_open_pair_says_what_holds_it() {
    let mut pair = beam(0.3, 20.0).pairs[0].clone();
    pair.state = State::Open;
    assert_eq!(pairs::state_words(&pair), "open");
    pair.held = Some(State::Stick);
    assert_eq!(pairs::state_words(&pair), "open (held)");
    pair.held = Some(State::SlipPlus);
    assert_eq!(pairs::state_words(&pair), "open (slip +)");
}

/// M(x) = −q (L − x)²/2 of the cantilever, q = 10, L = 4.
#[test]
fn moments_between_nodes_are_exact_under_a_line_load() {
    let (_, members, _) = cantilever();
    let series = diagram::series(&members, "AF", Internal::Moment);
    let points = series.expect("there is a bar AF").points;
    assert!(points.len() > 10);
    for (x, m) in points {
        let exact = -10.0 * (4.0 - x) * (4.0 - x) / 2.0;
        assert!((m - exact).abs() < 1e-12 * 80.0, "{m} at {x}");
    }
    assert_eq!(diagram::series(&members, "AG", Internal::Moment), None);
}
