//! Paths over a parameter that stands in the loads themselves, against the same loads by a factor and closed forms.

use stickslip::session::Session;

use super::common::lines::{read, report};
use super::find::number;

/// A block 2 × 1 on rough ground under its weight W (as a traction W/2 on its top), pushed at its top by H, with
/// `items` of the push given. It slides at H = f W, if it does not turn before: H h = W b/2, h = 1, b = 2.
fn block(parameters: &str, friction: &str, push: &str) -> Session {
    let text = format!(
        r#"{{ "format": "stickslip/1", "title": "block", "parameters": {{ {parameters} }},
        "materials": {{ "m": {{ "E": 20000, "nu": 0.2, "density": 0.5, "expansion": 1e-3 }} }},
        "plates": [ {{ "id": "b", "origin": [0, 0], "size": [2, 1], "divisions": [4, 2], "thickness": 1, "material": "m",
                      "plane": "stress" }} ],
        "contacts": [ {{ "id": "base", "edge": "b.bottom", "against": "ground", "friction": {friction} }} ],
        "loads": {{ "weight": {{ "items": [ {{ "gravity": {{ "acceleration": [0, -10] }} }} ] }}, "push": {push} }} }}"#
    );
    read(&text)
}

const POINT: &str = r#"{ "items": [ { "point": { "at": "b.top", "force": ["H", 0] } } ] }"#;

/// W = 0.5 · 10 · 2 = 10: it slides at H = 0.4 · 10 = 4; at f = 2 it turns about its right end at H = 10.
#[test]
fn the_limit_of_a_force_that_stands_in_an_item_is_that_of_a_factor() {
    for (friction, limit) in [("0.4", 4.0), ("2", 10.0)] {
        let found = report(&mut block("\"H\": 1", friction, POINT), "limit H").unwrap();
        assert!((number(&found["limit"]) - limit).abs() < 1e-9 * limit, "{found}");
        assert!((number(&found["safety"]) - limit).abs() < 1e-9 * limit, "{found}");
        assert_eq!(found["confirmed"], true, "{found}");
        let factor = r#"{ "factor": "H", "items": [ { "point": { "at": "b.top", "force": [1, 0] } } ] }"#;
        let by_factor = report(&mut block("\"H\": 1", friction, factor), "limit H").unwrap();
        assert!((number(&by_factor["limit"]) - limit).abs() < 1e-9 * limit, "{by_factor}");
        assert_eq!(found["collapse"]["mode"], by_factor["collapse"]["mode"]);
        assert_eq!(found["collapse"]["explanation"], by_factor["collapse"]["explanation"]);
        assert_eq!(found["collapse"]["verdict"], "certified", "{found}");
    }
}

/// An affine expression, through a formula, beside other loads in the same case: H = 3 (a − 1) + 0.5 and −0.5.
#[test]
fn affine_expressions_and_formulas_are_followed() {
    let push = r#"{ "factor": 2, "items": [ { "point": { "at": "b.top", "force": ["3*F + 0.5", 0] } },
                                            { "point": { "at": "b.top", "force": [-0.5, 0] } } ] }"#;
    let mut session = block("\"a\": 1.2, \"F\": { \"formula\": \"a - 1\" }", "0.4", push);
    // 2 · 3 (a − 1) = 4.
    let found = report(&mut session, "limit a").unwrap();
    assert!((number(&found["limit"]) - (1.0 + 2.0 / 3.0)).abs() < 1e-9, "{found}");
    let path = report(&mut session, "trace a to 1.5 of resultant base T, resultant base e, ux b[0,0]").unwrap();
    let values: Vec<f64> = path["along"]["values"].as_array().unwrap().iter().map(number).collect();
    assert_eq!((values[0], *values.last().unwrap()), (1.2, 1.5));
    for (k, a) in values.iter().enumerate() {
        let push = 6.0 * (a - 1.0);
        let quantity = |q: usize| number(&path["along"]["quantities"][q]["values"][k]);
        assert!((quantity(0) + push).abs() < 1e-9, "{path}");
        assert!((quantity(1) - push / 10.0).abs() < 1e-9, "{path}");
        // The displacements of the end of the path are those of a solve there.
        if k + 1 == values.len() {
            report(&mut session, "set a 1.5").unwrap();
            let solved = report(&mut session, "show ux b[0,0]").unwrap();
            assert!((quantity(2) - number(&solved[0]["value"])).abs() < 1e-12, "{solved} {path}");
        }
    }
}

/// Every kind of load in which the parameter may stand: the path ends where a solve does.
#[test]
fn every_kind_of_load_is_linear_in_its_amounts() {
    for (name, item) in [
        ("traction", r#"{ "traction": { "edge": "b.top", "value": [["Q", 0], ["2*Q", "-Q"]] } }"#),
        ("pressure", r#"{ "pressure": { "edge": "b.left", "value": ["Q", "3 - Q"] } }"#),
        ("fluid", r#"{ "fluid": { "edge": "b.left", "level": 0.7, "weight": "4 - Q" } }"#),
        ("gravity", r#"{ "gravity": { "acceleration": ["Q", "-Q/2"] } }"#),
        ("temperature", r#"{ "temperature": { "change": "Q", "on": ["b"] } }"#),
    ] {
        let mut session = block("\"Q\": 0.25", "0.6", &format!("{{ \"items\": [ {item} ] }}"));
        let path = report(&mut session, "trace Q to 1 of x_n base[1], x_t base[3], z_t base[4], uy b[4,2]")
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        report(&mut session, "set Q 1").unwrap();
        let solved = report(&mut session, "show x_n base[1], x_t base[3], z_t base[4], uy b[4,2]").unwrap();
        for q in 0..4 {
            let along = path["along"]["quantities"][q]["values"].as_array().unwrap();
            let (end, there) = (number(along.last().unwrap()), number(&solved[q]["value"]));
            assert!((end - there).abs() < 1e-9 * (1e-3 + there.abs()), "{name} {q}: {end} {there}");
        }
    }
}

/// Every kind of load: the rates are the differences of two answers of one scheme, divided by that of the parameter; and
/// with a factor beside it, in the law as well, by the product rule.
#[test]
fn sensitivity_to_amounts_of_loads_is_the_slope_of_the_answers() {
    let d = 1e-4;
    for (name, friction, push) in [
        (
            "traction",
            "0.6",
            r#"{ "items": [ { "traction": { "edge": "b.top", "value": [["Q", 0], ["2*Q", "-Q"]] } } ] }"#,
        ),
        ("fluid", "0.6", r#"{ "items": [ { "fluid": { "edge": "b.left", "level": 0.7, "weight": "4 - Q" } } ] }"#),
        ("gravity", "0.6", r#"{ "items": [ { "gravity": { "acceleration": ["Q", "-Q/2"] } } ] }"#),
        ("temperature", "0.6", r#"{ "items": [ { "temperature": { "change": "Q", "on": ["b"] } } ] }"#),
        (
            "factor",
            "0.6",
            r#"{ "factor": "2*Q^2", "items": [ { "point": { "at": "b.top", "force": ["1 + Q", "-Q"] } } ] }"#,
        ),
        (
            "friction",
            "\"0.4 + Q\"",
            r#"{ "factor": 3, "items": [ { "point": { "at": "b.top", "force": ["Q", 0] } } ] }"#,
        ),
    ] {
        let mut session = block("\"Q\": 0.25", friction, push);
        let found = report(&mut session, "sensitivity Q").unwrap_or_else(|error| panic!("{name}: {error}"));
        let rates = found["parameters"].as_array().unwrap();
        assert_eq!(rates.len(), 1, "{found}");
        let mut at = |q: f64| {
            report(&mut session, &format!("set Q {q}")).unwrap();
            let pairs = (0..5).flat_map(|k| ["x_n", "x_t", "z_n", "z_t"].map(|word| format!("{word} base[{k}]")));
            let command = format!("show {}", pairs.collect::<Vec<_>>().join(", "));
            let shown = report(&mut session, &command).unwrap();
            shown.as_array().unwrap().iter().map(|one| number(&one["value"])).collect::<Vec<_>>()
        };
        // Of second order in d: central differences.
        let (after, before) = (at(0.25 + d), at(0.25 - d));
        let mut moves = 0.0;
        for (k, pair) in rates[0]["pairs"].as_array().unwrap().iter().enumerate() {
            for (q, word) in ["x_n", "x_t", "z_n", "z_t"].into_iter().enumerate() {
                let slope = (after[4 * k + q] - before[4 * k + q]) / (2.0 * d);
                let rate = number(&pair[word]);
                moves = f64::max(moves, rate.abs());
                assert!((rate - slope).abs() < 1e-6 * (1.0 + slope.abs()), "{name} {k} {word}: {rate} {slope}");
            }
        }
        assert!(moves > 0.1, "{name}: {found}");
    }
    let push = POINT.replace("\"H\"", "\"H^2\"");
    let error = report(&mut block("\"H\": 1", "0.4", &push), "sensitivity H").unwrap_err();
    assert!(error.contains("not a linear function of it: it stands in the loads (loads.push.items[0]"), "{error}");
}

#[test]
fn what_is_not_linear_is_refused_with_its_place() {
    for (parameters, push, part) in [
        (
            "\"H\": 1",
            POINT.replace("\"H\"", "\"H^2\""),
            "loads.push.items[0].point.force[0]: \"H^2\" is not a linear function of H",
        ),
        (
            "\"H\": 1, \"G\": { \"formula\": \"sin(H)\" }",
            POINT.replace("\"H\"", "\"G\""),
            "loads.push.items[0].point.force[0]: \"G\" is not a linear function of H",
        ),
        (
            "\"H\": 1",
            POINT.replace("{ \"items\"", "{ \"factor\": \"H\", \"items\""),
            "and in its factor: their product",
        ),
        (
            "\"H\": 1",
            r#"{ "items": [ { "fluid": { "edge": "b.left", "level": "H", "weight": 1 } } ] }"#.to_owned(),
            "it stands in the loads (loads.push.items[0].fluid.level)",
        ),
    ] {
        for command in ["trace H", "limit H"] {
            let error = report(&mut block(parameters, "0.4", &push), command).unwrap_err();
            assert!(error.contains(part) && error.contains("`sweep H A..B`"), "{error}");
        }
    }
    let error = report(&mut block("\"H\": 1", "\"H/5\"", POINT), "trace H").unwrap_err();
    assert!(error.contains("H cannot be followed"), "{error}");
}
