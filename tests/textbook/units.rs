//! The same structure in N and mm and in MN and km: the same pivots (variables, order, ties) and states, all values
//! scaled. Nothing in the program may compare a number with a unit to a fixed threshold.

use crate::common::*;
use serde_json::Value;
use stickslip::model::embedded;
use stickslip::model::rules::Covering;

/// How a number changes: force^a · length^b.
fn scale(dimension: (i32, i32), units: (f64, f64)) -> f64 {
    units.0.powi(dimension.0) * units.1.powi(dimension.1)
}

/// Multiplies every number below `value`.
fn multiply(value: &mut Value, by: f64) {
    match value {
        Value::Number(number) => *value = Value::from(number.as_f64().unwrap() * by),
        Value::Array(entries) => entries.iter_mut().for_each(|entry| multiply(entry, by)),
        Value::Object(entries) => entries.values_mut().for_each(|entry| multiply(entry, by)),
        _ => {}
    }
}

/// The scenario in other units. `parameters` gives force and length exponents of each parameter; a load factor that is
/// a parameter carries the dimension of its case, the items under it then keep their numbers.
fn converted(name: &str, parameters: &[(&str, (i32, i32))], units: (f64, f64)) -> String {
    let mut json: Value = serde_json::from_str(embedded::text(name).unwrap()).unwrap();
    let by = |dimension| scale(dimension, units);
    for (name, parameter) in json["parameters"].as_object_mut().unwrap() {
        let dimension =
            parameters.iter().find(|(known, _)| known == name).unwrap_or_else(|| panic!("dimension of {name}")).1;
        for key in ["value", "min", "max", "step"] {
            multiply(&mut parameter[key], by(dimension));
        }
    }
    let each = |list: &mut Value, keys: &[(&str, (i32, i32))]| {
        let entries: Vec<&mut Value> = match list {
            Value::Array(entries) => entries.iter_mut().collect(),
            Value::Object(entries) => entries.values_mut().collect(),
            _ => Vec::new(),
        };
        for entry in entries {
            for (key, dimension) in keys {
                if let Some(number) = entry.get_mut(key) {
                    multiply(number, by(*dimension));
                }
            }
        }
    };
    let object = json.as_object_mut().unwrap();
    let mut part = |key: &str, keys: &[(&str, (i32, i32))]| {
        if let Some(list) = object.get_mut(key) {
            each(list, keys);
        }
    };
    part("materials", &[("E", (1, -2))]);
    part("sections", &[("area", (0, 2)), ("inertia", (0, 4))]);
    part("plates", &[("origin", (0, 1)), ("size", (0, 1)), ("thickness", (0, 1))]);
    part("springs", &[("stiffness", (1, -1))]);
    part("contacts", &[("gap", (0, 1)), ("cohesion", (1, 0))]);
    if let Some(nodes) = object.get_mut("nodes") {
        multiply(nodes, by((0, 1)));
    }
    for case in object["loads"].as_object_mut().unwrap().values_mut() {
        if case.get("factor").is_some_and(Value::is_string) {
            continue;
        }
        for item in case["items"].as_array_mut().unwrap() {
            for (kind, key, dimension) in
                [("point", "force", (1, 0)), ("traction", "value", (1, -1)), ("line", "value", (1, -1))]
            {
                if let Some(load) = item.get_mut(kind) {
                    multiply(&mut load[key], by(dimension));
                }
            }
        }
    }
    json.to_string()
}

fn compare(name: &str, parameters: &[(&str, (i32, i32))], sets: &[&[(&str, f64)]]) {
    let original = Case::embedded(name);
    // From (m, kN): N and mm, MN and km, and an odd one that is not a power of ten.
    for units in [(1e3, 1e3), (1e-3, 1e-3), (1.0 / 7.3, 39.37), (1e6, 1.0), (1.0, 1e-6)] {
        let other = Case::text(&converted(name, parameters, units));
        for rules in all_rules() {
            for set in sets {
                // `weight` is refused without friction.
                if rules.covering == Covering::Weight && set.contains(&("f", 0.0)) {
                    continue;
                }
                let scaled: Vec<(&str, f64)> = set
                    .iter()
                    .map(|(name, value)| {
                        let dimension = parameters.iter().find(|(known, _)| known == name).unwrap().1;
                        (*name, value * scale(dimension, units))
                    })
                    .collect();
                let (a, b) = (original.solve_under(set, rules), other.solve_under(&scaled, rules));
                let what = format!("{name} {set:?} {units:?} {rules:?}");
                assert_eq!(a.outcome, b.outcome, "{what}");
                assert_eq!(a.marginal, b.marginal, "{what}");
                assert_eq!(a.pivots.len(), b.pivots.len(), "{what}");
                let force = scale((1, 0), units);
                let length = scale((0, 1), units);
                let top = a.pivots.first().map_or(0.0, |pivot| pivot.p);
                for (x, y) in a.pivots.iter().zip(&b.pivots) {
                    let step = format!("{what}, pivot {}", x.step);
                    assert_eq!(x.entering, y.entering, "{step}");
                    assert_eq!(x.leaving, y.leaving, "{step}");
                    assert_eq!(x.ties, y.ties, "{step}");
                    assert_eq!(x.turned, y.turned, "{step}");
                    near(&step, y.p, x.p * force, 1e-8, top * force);
                }
                assert_eq!(a.ray.as_ref().map(|ray| ray.class), b.ray.as_ref().map(|ray| ray.class), "{what}");
                assert_eq!(states(&a), states(&b), "{what}");
                let largest = |x: &[f64]| x.iter().fold(0f64, |a, b| a.max(b.abs()));
                let forces = |answer: &stickslip::answer::record::Answer| {
                    let mut all = of_pairs(answer, |p| p.x_n);
                    all.extend(of_pairs(answer, |p| p.x_t));
                    all.extend(of_pairs(answer, |p| p.bound));
                    all
                };
                let lengths = |answer: &stickslip::answer::record::Answer| {
                    let mut all = of_pairs(answer, |p| p.z_n);
                    all.extend(of_pairs(answer, |p| p.z_t));
                    if let Some(nodes) = &answer.displacements {
                        all.extend(nodes.iter().flat_map(|d| [d.ux, d.uy]));
                    }
                    all
                };
                for (what, x, y, by) in [
                    (format!("{what}: forces"), forces(&a), forces(&b), force),
                    (format!("{what}: displacements"), lengths(&a), lengths(&b), length),
                ] {
                    let size = largest(&x).max(1e-300);
                    for (x, y) in x.iter().zip(&y) {
                        near(&what, *y, x * by, 1e-9, size * by);
                    }
                }
            }
        }
    }
}

const FORCE: (i32, i32) = (1, 0);
const NONE: (i32, i32) = (0, 0);

#[test]
fn beams() {
    let parameters = [("f", NONE), ("F", FORCE), ("F2", FORCE)];
    compare(
        "beam",
        &parameters,
        &[&[], &[("F2", 40.0)], &[("F2", 200.0)], &[("F2", 300.3)], &[("F2", 400.0)], &[("f", 0.0)]],
    );
    compare("beam-limit", &parameters, &[&[]]);
    compare("beam-ray", &parameters, &[&[]]);
}

#[test]
fn frames() {
    let parameters = [("f", NONE), ("H", FORCE)];
    compare("frame", &parameters, &[&[], &[("f", 0.1)], &[("f", 0.6)]]);
    compare("frame-rotated", &parameters, &[&[], &[("f", 0.9)], &[("H", -60.0)]]);
}

#[test]
fn cantilever_with_gap() {
    let parameters = [("P", FORCE), ("g", (0, 1))];
    compare("gap", &parameters, &[&[], &[("g", 0.1)], &[("g", 0.0)]]);
}

#[test]
fn blocks() {
    let parameters = [("f", NONE), ("H", FORCE)];
    compare("block", &parameters, &[&[], &[("H", 0.3)], &[("f", 0.2), ("H", 0.23)], &[("H", 0.0)]]);
    let parameters = [("f", NONE), ("G", FORCE), ("F", FORCE)];
    compare("slope", &parameters, &[&[], &[("F", 0.45)], &[("F", -0.3)]]);
}

#[test]
fn plates() {
    let parameters = [("f", NONE), ("q", (1, -1)), ("T", (1, -1)), ("V", (1, -1))];
    compare("plates-free", &parameters, &[&[], &[("f", 0.3), ("T", 60.00006)], &[("f", 2.5), ("T", 404.0)]]);
    compare("plates-hinged", &parameters, &[&[], &[("f", 0.8)]]);
    compare("plates-slide", &parameters, &[&[]]);
}

#[test]
fn greco() {
    compare("greco", &[("f", NONE)], &[&[], &[("f", 0.2)], &[("f", 3.0)]]);
}
