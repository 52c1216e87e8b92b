//! What is condensed in doubled precision: only what f64 loses.

use std::sync::atomic::{AtomicBool, Ordering};

use super::builder::{Model, frictionless};
use crate::fem::MainSystem;
use crate::fem::measured_loss::BELIEVED;
use crate::model::load::load_text;
use crate::model::pair::joints;
use crate::model::scenario::Source;
use crate::model::structure::Structure;
use crate::watch::{Quiet, Watch};

/// Two plates on one another of elements 80 times as high as long, the upper one held by springs.
fn structure() -> Structure {
    let plate = |id: &str, y: f64| {
        format!(
            r#"{{"id":"{id}","origin":[0,{y}],"size":[1,4],"divisions":[100,3],"thickness":0.1,"material":"m","plane":"strain"}}"#
        )
    };
    let text = format!(
        r#"{{"format":"stickslip/1","title":"Plates","materials":{{"m":{{"E":1e5,"nu":0.3}}}},"plates":[{},{}],
"supports":[{{"at":"lower.bottom","fixed":["x","y"]}}],
"springs":[{{"at":"upper.left","direction":[1,0],"stiffness":100000}}],
"contacts":[{{"id":"joint","edge":"upper.bottom","against":"lower.top","friction":0.3}}],
"loads":{{"w":{{"items":[{{"traction":{{"edge":"upper.top","value":[0.3,-1]}}}}]}}}}}}"#,
        plate("lower", 0.0),
        plate("upper", 4.0)
    );
    let scenario = load_text("plates", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
    let Source::Structure(structure) = scenario.source else { panic!("a structure") };
    structure
}

/// R of every column from K in doubled precision, and the largest difference relative to √(R_ii R_jj).
fn worst_entry(structure: &Structure, system: &mut MainSystem) -> f64 {
    let plain = system.stiffness().clone();
    let exact = system.refinement(structure, &Quiet).unwrap().stiffness(&Quiet).unwrap().unwrap();
    let share = |i: usize, j: usize| (plain[(i, j)] - exact[(i, j)]).abs() / (exact[(i, i)] * exact[(j, j)]).sqrt();
    (0..plain.nrows()).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| share(i, j)).fold(0.0, f64::max)
}

/// Whether R is condensed in doubled precision, column by column.
#[derive(Default)]
struct Columns(AtomicBool);

impl Watch for Columns {
    fn progress(&self, what: &str, _: f64) {
        self.0.fetch_or(what.contains("in doubled precision"), Ordering::Relaxed);
    }
}

/// RF and displacements are in doubled precision. R of the f64 factor is kept; every entry of it is as right as every
/// row of R z is believed to be.
#[test]
fn the_stiffness_is_kept_where_it_is_right() {
    let (structure, columns) = (structure(), Columns::default());
    let mut system = MainSystem::new(&structure, &joints(&structure.pairs), &columns).unwrap();
    assert!(system.doubled.is_some() && !columns.0.into_inner());
    let worst = worst_entry(&structure, &mut system);
    assert!(worst <= BELIEVED, "{worst:e}");
}

/// A clamped bar of 400 elements, E I = 1, L = 1, with pairs at these nodes.
fn bar(at: &[usize]) -> (Structure, MainSystem) {
    let mut model = Model::default();
    let nodes: Vec<usize> = (0..=400).map(|i| model.node("n", f64::from(i) / 400.0, 0.0)).collect();
    for ends in nodes.windows(2) {
        model.frame(ends[0], ends[1], 1.0, 1.0);
    }
    model.support(nodes[0], "xyr");
    for &node in at {
        model.pair(nodes[node], None, [0.0, 1.0], frictionless());
    }
    let system = MainSystem::new(&model.0, &joints(&model.0.pairs), &Quiet).unwrap();
    (model.0, system)
}

/// A dislocation at the tip bends all of the bar, so that R = 3 needs doubled precision. Less than that is noticed.
#[test]
fn a_stiffness_that_is_off_is_noticed() {
    let (structure, mut system) = bar(&[400]);
    assert!((system.stiffness()[(0, 0)] / 3.0 - 1.0).abs() < 1e-13);
    assert!(system.correct_stiffness(&structure, &Quiet).unwrap());
    system.r[(0, 0)] *= 1.0 + 1e-12;
    // A correction takes more solutions than R has columns.
    assert!(!system.correct_stiffness(&structure, &Quiet).unwrap());
}

/// What is wrong in few directions is given back: R of forty pairs with a loss of two directions is R of every column from
/// K in doubled precision again. A loss in every direction is left to that.
#[test]
fn what_a_few_directions_lost_is_given_back() {
    let at: Vec<usize> = (1..=40).map(|k| 10 * k).collect();
    let (structure, mut system) = bar(&at);
    system.r = system.refinement(&structure, &Quiet).unwrap().stiffness(&Quiet).unwrap().unwrap();
    let sizes = system.r.diagonal().map(f64::sqrt);
    let direction = |k: f64| sizes.map_with_location(|i, _, size| size * (k * (i as f64 + 1.0)).sin());
    for (k, loss) in [(0.1, 1e-9), (0.7, -1e-8)] {
        let direction = direction(k);
        system.r += &direction * direction.transpose() * loss;
    }
    assert!(system.correct_stiffness(&structure, &Quiet).unwrap());
    let worst = worst_entry(&structure, &mut system);
    assert!(worst <= BELIEVED, "{worst:e}");

    for i in 0..40 {
        let alternates = if i % 2 == 0 { 1e-9 } else { -1e-9 };
        system.r[(i, i)] *= 1.0 + alternates;
    }
    assert!(!system.correct_stiffness(&structure, &Quiet).unwrap());
}
