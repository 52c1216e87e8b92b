//! The judge of a loop against loops that are none.

use num_rational::BigRational;
use num_traits::{One, Zero};

use super::judge::judged;
use super::{Place, Question, question};
use crate::model::embedded;
use crate::path::cycle::{Kind, followed};
use crate::path::load_parameter::factors_at;
use crate::path::stages::Begin;
use crate::solve::prepare;
use crate::solve::problem::contact_problem;
use crate::watch::Quiet;

/// Asks for the loop of a load of an embedded scenario between 0 and `to`.
fn with_loop(name: &str, set: &[(&str, f64)], (load, to): (&str, f64), test: &dyn Fn(&Question<'_>, Vec<Place>)) {
    let scenario = embedded::load(name).expect("embedded");
    let mut values = scenario.parameter_values();
    for (name, value) in set {
        values.insert((*name).to_owned(), *value).expect("a parameter");
    }
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    let case = prepared.case(&scenario, &values);
    let found = followed(case, load, [0.0, to], 32, &Begin::Unloaded).expect("a cycle");
    assert_ne!(found.kind, Kind::Undecided);
    let last = 2 * found.turns.len();
    let stages = &found.history.stages;
    let system = prepared.system().expect("a system");
    let problems = [0.0, to].map(|end| {
        contact_problem(system, &factors_at(case, load, end).expect("factors"), &values).without_load_noise()
    });
    let question = question(&problems, &stages[last - 2], [&stages[last - 1], &stages[last]], &Quiet);
    let question = question.unwrap_or_else(|refusal| panic!("{refusal:?}"));
    let (_, places, _) = question.closed().unwrap_or_else(|why| panic!("{name}: {why}"));
    test(&question, places);
}

/// 10⁻⁴⁰: far below every rounding.
fn little() -> BigRational {
    BigRational::new(1.into(), num_traits::pow(10.into(), 40))
}

fn with_force(question: &Question<'_>, place: &mut Place) {
    let rows = question.ends[0].stiffness.iter().enumerate();
    let force = rows.map(|(joint, row)| {
        let (from, change) = question.constant(place.half, joint);
        let own: BigRational = row.iter().zip(&place.z).map(|(r, z)| r * z).sum();
        own + from + change * &place.t
    });
    place.force = force.collect();
}

/// No displacement of any joint at any place may be altered, however little: what was on a bound no longer is, or slips
/// short of it.
#[test]
fn a_loop_altered_by_any_displacement_is_none() {
    for (name, set, load) in [
        ("beam", &[("f", 0.3), ("F", 100.0)][..], ("F2", 61.0)),
        ("beam", &[("f", 0.3), ("F", 100.0)], ("F2", 150.0)),
        ("ratchet", &[], ("heat", 50.0)),
    ] {
        with_loop(name, set, load, &|question, mut places| {
            for k in 0..places.len() {
                for joint in 0..places[k].z.len() {
                    let z = places[k].z[joint].clone();
                    for sign in [BigRational::one(), -BigRational::one()] {
                        places[k].z[joint] = &z + sign * little();
                        with_force(question, &mut places[k]);
                        let found = judged(question, &places);
                        assert!(found.is_err(), "{name}: joint {joint} at place {k} is free to move");
                    }
                    places[k].z[joint] = z;
                    with_force(question, &mut places[k]);
                }
            }
            assert!(judged(question, &places).is_ok());
        });
    }
}

/// Half a loop, a loop backwards, places in another order are none.
#[test]
fn a_way_that_is_none_is_refused() {
    with_loop("beam", &[("f", 0.3), ("F", 100.0)], ("F2", 61.0), &|question, mut places| {
        let copy = |place: &Place| Place {
            half: place.half,
            t: place.t.clone(),
            z: place.z.clone(),
            force: place.force.clone(),
        };
        assert!(places.iter().any(|place| place.t > BigRational::zero() && place.t < BigRational::one()));
        let there: Vec<Place> = places.iter().filter(|place| place.half == 0).map(copy).collect();
        assert!(judged(question, &there).is_err());
        assert!(judged(question, &[]).is_err());
        places.swap(1, 2);
        assert!(judged(question, &places).is_err());
        places.swap(1, 2);
        assert!(judged(question, &places).is_ok());
        places.reverse();
        assert!(judged(question, &places).is_err());
    });
}
