//! Pictures of structures in space.

use super::sample::{block, block_states, factors_under, tower, units};
use crate::model::structure::Structure;
use crate::view::plot::scene::{Magnification, Picture, Scene};
use crate::view::plot::{face_map, structure, zone};
use crate::view::projection::Viewpoint;
use crate::view::style::Style;
use crate::view::svg;

fn picture<'a>(structure: &'a Structure, view: &str) -> Picture<'a> {
    Picture {
        title: "space",
        structure,
        displacements: None,
        factors: &[],
        pairs: None,
        magnification: Magnification::Auto,
        viewpoint: Viewpoint::named(view).unwrap(),
        height: 20,
    }
}

/// The structure, its loads, its pairs in their states.
fn drawn(structure: &Structure, view: &str, style: &Style) -> String {
    let states = block_states(structure);
    let picture = Picture { pairs: Some(&states), ..picture(structure, view) };
    let mut out = Vec::new();
    let (factors, units) = (factors_under(structure, 0.0), units());
    structure::write(&mut out, &picture, Some((&factors, &units)), style).unwrap();
    if let Ok(folder) = std::env::var("LOOK") {
        let scene = Scene::new(&picture, Some(&factors));
        let figure =
            svg::structure::figure(&scene, &units, &svg::Caption { title: scene.title.clone(), about: String::new() });
        std::fs::write(format!("{folder}/{}-{view}.svg", structure.nodes.len()), figure).unwrap();
        if let [map] = &face_map::faces(structure, &states, zone::Quantity::Slip, &units).0[..] {
            std::fs::write(
                format!("{folder}/map-{}.svg", structure.nodes.len()),
                svg::face_map::figure(std::slice::from_ref(map), None, "about"),
            )
            .unwrap();
        }
    }
    String::from_utf8(out).unwrap()
}

#[test]
fn pictures_of_space() {
    let style = Style { width: 60, ..Style::default() };
    let mut all = String::new();
    for structure in [block([6, 4, 3], [3.0, 2.0, 1.5]), tower()] {
        for view in ["ISO", "XY", "XZ", "YZ"] {
            all.push_str(&drawn(&structure, view, &style));
            all.push('\n');
        }
    }
    insta::assert_snapshot!("space_60", all);
    let ascii = drawn(&block([6, 4, 3], [3.0, 2.0, 1.5]), "ISO", &Style { ascii: true, ..style });
    assert!(ascii.is_ascii());
    insta::assert_snapshot!("space_ascii", ascii);
}
