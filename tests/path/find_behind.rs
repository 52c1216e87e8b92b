//! `find` and `envelope` where a number is only just met, where a path ends, and where there are several answers, against closed
//! forms.

use serde_json::json;
use stickslip::model::load::load_text;

use super::find::{beam, near, number, places, report, session};

/// At F2 = 50 k the k-th support from the pulled end begins to slip, up to 300: with equality a condition holds at what is equal,
/// too, over a whole interval or at a single value.
#[test]
fn at_most_and_at_least_hold_where_it_is_equal() {
    let mut session = beam();
    let cases = [
        ("count slip+ >= 3", [150.0, 300.0]),
        ("count slip+ > 2", [150.0, 300.0]),
        ("count slip+ <= 2", [0.0, 150.0]),
        ("z_t c6 <= 0", [0.0, 50.0]),
        ("z_t c6 >= 0", [0.0, 300.0]),
    ];
    for (condition, expected) in cases {
        let found = report(&mut session, &format!("find F2 0..400 where {condition}")).unwrap();
        let (_, holds) = places(&found);
        assert_eq!(holds.len(), 1, "{condition}: {found}");
        assert!(holds[0].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{condition}: {found}");
    }
    // The slip of c6, 1e-5 Σ (F2 − 50 k), is largest at the end of the range, 1e-5 (3 · 200 − 50 (1 + 2 + 3)) = 3e-3.
    let found = report(&mut session, "find F2 0..200 where z_t c6 >= 0.003").unwrap();
    let (_, holds) = places(&found);
    assert!(holds.len() == 1 && holds[0].iter().all(|end| (end - 200.0).abs() < 1e-9), "{found}");
    let found = report(&mut session, "find F2 0..200 where z_t c6 > 0.003").unwrap();
    assert!(places(&found).1.is_empty(), "{found}");
}

/// Answers for |F2| ≤ 300 only, at neither end and not at the present value: the slip 1e-5 ((F2 − 50) + (F2 − 100)) of c6 is
/// 1e-3 at 125.
#[test]
fn answers_inside_of_the_range_are_found_from_neither_end() {
    let mut session = beam();
    report(&mut session, "set F2 500").unwrap();
    let found = report(&mut session, "find F2 -2000..900 where z_t c6 >= 0.001").unwrap();
    let (places, holds) = places(&found);
    assert!((places[0] - 125.0).abs() < 1e-9 && (holds[0][1] - 300.0).abs() < 1e-9, "{found}");
    near(&found["covered"][0], -300.0, 1e-9);
    let error = report(&mut session, "find F2 310..900 where z_t c6 = 0.001").unwrap_err();
    assert!(error.contains("there is no answer to start from: at F2 = 310"), "{error}");
}

/// A bar of length and area 1 that is pulled by 1 opens by 1/E. The number is met to rounding where a cell is halved first, at
/// E = 2.05 between 2 and 2.1, and behind it the opening is on the other side, not equal.
#[test]
fn a_number_met_by_an_answer_of_its_own_ends_no_interval_too_early() {
    let text = r#"{ "format": "stickslip/1", "title": "bar", "parameters": { "E": 2 },
        "materials": { "m": { "E": "E", "nu": 0 } }, "sections": { "s": { "area": 1 } },
        "nodes": { "A": [0, 0], "B": [0, 1] },
        "bars": [ { "id": "b", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" } ],
        "supports": [ { "at": "B", "fixed": ["x", "y"] }, { "at": "A", "fixed": ["x"] } ],
        "contacts": [ { "id": "c", "node": "A", "against": "ground", "normal": [0, 1], "law": "frictionless" } ],
        "loads": { "pull": { "items": [ { "point": { "at": "A", "force": [0, 1] } } ] } } }"#;
    let mut session = session(load_text("bar", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let met = 1.0 / 2.05;
    for (sign, expected) in [("<", Some([2.05, 5.0])), (">", Some([1.0, 2.05])), ("=", None)] {
        let found = report(&mut session, &format!("find E 1..5 where z_n c {sign} {met}")).unwrap();
        let (places, holds) = places(&found);
        assert_eq!((places.len(), holds.len()), (1, usize::from(expected.is_some())), "{found}");
        assert!((places[0] - 2.05).abs() < 1e-8, "{found}");
        if let Some(ends) = expected {
            assert!(holds[0].iter().zip(ends).all(|(a, b)| (a - b).abs() < 1e-8), "{found}");
        }
    }
}

/// R = [2, c; c, 3] with c = 2.4 and f = 1.5, λ = R z + (1, T): sticking up to T = f, open from T = 3/c = 1.25 on, both
/// between. Upwards the block sticks up to 1.5 and jumps there. Open it is z_t = −(2 T − c)/(6 − c²), z_n = −(3 − c T)/(6 − c²).
#[test]
fn beyond_a_jump_the_next_answer_is_followed_and_others_are_named() {
    let text = r#"{ "format": "stickslip/1", "title": "block", "parameters": { "f": 1.5, "T": 0 },
        "contact_system": { "pairs": ["a"], "friction": ["f"], "stiffness": [[2, 2.4], [2.4, 3]],
            "loads": { "weight": { "vector": [1, 0] }, "push": { "factor": "T", "vector": [0, 1] } } } }"#;
    let mut session = session(load_text("block", text, None).unwrap_or_else(|problems| panic!("{problems}")));
    let found = report(&mut session, "find T -1..2 where state a = open").unwrap();
    let (at, holds) = places(&found);
    assert_eq!((at.len(), holds.len(), &found["exact"]), (1, 1, &true.into()), "{found}");
    assert!((holds[0][0] - 1.5).abs() < 1e-12 && holds[0][1] == 2.0, "{found}");
    assert_eq!(found["covered"], json!([-1.0, 2.0]));
    assert!(found["notes"].to_string().contains("from an answer of its own at T = 2 the rest"), "{found}");
    let opening = |t: f64| (2.4 * t - 3.0) / (6.0 - 2.4 * 2.4);
    let found = report(&mut session, &format!("find T 0..2 where z_n a = {}", opening(1.75))).unwrap();
    near(&found["places"][0]["value"], 1.75, 1e-12);
    let found = report(&mut session, "envelope z_n a over T -1..2").unwrap();
    near(&found["envelope"][0]["largest"]["value"], opening(2.0), 1e-12);
    // At T = 1.4 it is open whatever the friction, and sticks where f > 1.4, too.
    report(&mut session, "set T 1.4").unwrap();
    for command in ["find f 1..2 where state a = open", "envelope z_n a over f 1..2"] {
        let found = report(&mut session, command).unwrap();
        assert!(found["notes"].to_string().contains("there are several answers: at f = "), "{found}");
    }
    // Where there is no other one nothing is said.
    let found = report(&mut session, "find f 1..1.3 where state a = open").unwrap();
    assert!(!found["notes"].to_string().contains("several"), "{found}");
}

/// A weight W on springs and a slope of angle α, with a neighbour that is pressed on: it creeps until the springs hold what friction
/// does not, and from f = tan α on both rest, friction W sin α. Nowhere is friction on the other side, whatever rounding
/// leaves of the last slip.
#[test]
fn friction_does_not_turn_where_the_last_slip_ends() {
    for k in 0..24 {
        let (slope, weight) = (0.5676 - 0.01 * f64::from(k), 8.72 + 0.31 * f64::from(k));
        let text = format!(
            r#"{{ "format": "stickslip/1", "title": "slope", "parameters": {{ "f": 0.1 }}, "nodes": {{ "A": [2, 0], "B": [3, 0] }},
                "springs": [ {{ "at": "A", "direction": [0, 1], "stiffness": 1000 }},
                             {{ "at": "B", "direction": [0, 1], "stiffness": 1000 }},
                             {{ "between": ["A", "B"], "direction": [1, 0], "stiffness": 200 }} ],
                "contacts": [ {{ "id": "c", "node": "A", "against": "ground", "normal": [-{slope}, 1], "friction": "f" }},
                              {{ "id": "d", "node": "B", "against": "ground", "normal": [0, 1], "friction": "0.5*f+0.05",
                                 "gap": -0.01 }} ],
                "loads": {{ "w": {{ "items": [ {{ "point": {{ "at": "A", "force": [0, -{weight}] }} }},
                                               {{ "point": {{ "at": "B", "force": [0, -9.204] }} }} ] }} }} }}"#
        );
        let mut session = session(load_text("slope", &text, None).unwrap_or_else(|problems| panic!("{problems}")));
        let found = report(&mut session, "envelope x_t c over f 0..0.8").unwrap();
        let ends = ["least", "largest"].map(|end| number(&found["envelope"][0][end]["value"]));
        let friction = weight * slope / slope.hypot(1.0);
        let (size, other) = (ends[0].abs().max(ends[1].abs()), ends[0].abs().min(ends[1].abs()));
        assert!((size - friction).abs() < 1e-12 * weight && other < 1e-12 * weight, "{slope}: {found}");
    }
}
