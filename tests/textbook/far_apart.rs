//! Loads and stiffnesses that are far apart: small numbers beside large ones are not dropped, and what is claimed holds for
//! the data as they are.

use serde_json::{Value, json};
use stickslip::answer::record::{Answer, OutcomeKind, State, Verdict};
use stickslip::model::load::load_text;
use stickslip::model::rules::Rules;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

use crate::common::*;

/// Two nodes side by side, each in contact with the ground below it.
fn two_nodes(springs: Value, friction: [f64; 2], gap: [f64; 2], force: [[f64; 2]; 2]) -> Case {
    let contact = |id: &str, i: usize| {
        let node = ["m", "n"][i];
        json!({ "id": id, "node": node, "against": "ground", "normal": [0, 1], "friction": friction[i], "gap": gap[i] })
    };
    let load = |at: &str, force: [f64; 2]| json!({ "point": { "at": at, "force": force } });
    Case::json(json!({
        "nodes": { "m": [0, 0], "n": [1, 0] }, "springs": springs, "contacts": [contact("a", 0), contact("b", 1)],
        "loads": { "w": { "items": [load("m", force[0]), load("n", force[1])] } }
    }))
}

fn is_proved(answer: &Answer) -> bool {
    let verdict = answer.ray.as_ref().and_then(|ray| ray.verdict);
    matches!(verdict, Some(Verdict::Proved | Verdict::Certified))
}

/// The spring is not strained where n is pressed by 4 and pushed by 4 = f x_n: an answer on the limit of friction, beside a load
/// of 3e7 whose rounding is 4e-9.
#[test]
fn an_answer_on_the_limit_of_friction_beside_a_large_load() {
    let springs = json!([{ "between": ["m", "n"], "direction": [1, -2], "stiffness": 1 }]);
    let case = two_nodes(springs, [2.0, 1.0], [1.0, 1.0], [[0.0, -3e7], [4.0, -4.0]]);
    let answer = case.solve(&[]);
    is_answer(&answer);
    near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &[3e7, 4.0], 1e-9);
    near_all("x_t", &of_pairs(&answer, |pair| pair.x_t), &[0.0, -4.0], 1e-9);
}

/// The load on n acts along the spring, so that m carries it: x_n = 100 − 0.02, x_t = −100 − 0.04. n touches the ground without
/// any force, and by the rounding of the spring's direction no working scheme is an answer: then none is proved to be missing.
#[test]
fn an_answer_within_the_rounding_of_a_structure_is_not_proved_away() {
    let springs = json!([{ "between": ["m", "n"], "direction": [3, -3], "stiffness": 0.005 }]);
    let case = two_nodes(springs, [2.0, 2.0], [0.0, 0.0], [[0.04, 0.02], [100.0, -100.0]]);
    let answer = case.solve(&[]);
    is_answer(&answer);
    near_all("x_n", &of_pairs(&answer, |pair| pair.x_n), &[99.98, 0.0], 1e-9);
    near_all("x_t", &of_pairs(&answer, |pair| pair.x_t), &[-100.04, 0.0], 1e-9);
    assert!(answer.notes.iter().any(|note| note.contains("within the rounding of the data")), "{:?}", answer.notes);
    let all =
        case.prepared.all_answers(&case.scenario.parameter_values(), Rules::default(), &Quiet).expect("few pairs");
    assert!(!all.none() && all.exact == [false], "{:?}", all.exact);
}

/// The springs on n are 1e-17 of the one between the nodes, which f64 loses. On paper they hold n: it opens, far off. That there
/// is no answer cannot be proved from what is left of them.
#[test]
fn what_a_stiff_spring_swamps_is_no_proof() {
    let springs = json!([{ "between": ["n", "m"], "direction": [-3, 1], "stiffness": 5e8 },
                         { "at": "n", "direction": [-1, -1], "stiffness": 5e-8 },
                         { "at": "n", "direction": [2, 3], "stiffness": 1e-8 }]);
    let case = two_nodes(springs, [0.0, 0.5], [1e-8, 0.0], [[-5e9, -5e9], [100.0, -400.0]]);
    assert!(!is_proved(&case.solve(&[])));
    let all =
        case.prepared.all_answers(&case.scenario.parameter_values(), Rules::default(), &Quiet).expect("few pairs");
    assert!(!all.none());
}

/// m slides up along (−2, 3), across the spring: the load of 1e-8 does the work 5e-8 on it, the spring none, and friction, whose
/// angle is smaller, neither. No load on n, 3e12 or none, changes that.
#[test]
fn a_small_load_beside_a_large_one_is_not_dropped() {
    let springs = json!([{ "between": ["m", "n"], "direction": [-3, -2], "stiffness": 2e-8 }]);
    for far in [0.0, 1.0, 1e6, 3e12] {
        let loads = [[-1e-8, 1e-8], [-far, -2.0 * far]];
        let answer = two_nodes(springs.clone(), [0.25, 2.0], [0.0, 1.0], loads).solve(&[]);
        assert!(is_proved(&answer), "{far}: {:?}", answer.outcome);
    }
}

/// Springs along the axes do not couple anything: m slips by (6 − 0.5 · 10) / k, whatever the stiffness of the others.
#[test]
fn joints_that_do_not_couple_are_judged_by_their_own_terms() {
    for other in [1.0, 1e12, 1e20, 1e30] {
        let spring = |at: &str, direction: [u8; 2], k: f64| json!({ "at": at, "direction": direction, "stiffness": k });
        let springs = json!([
            spring("m", [1, 0], 1.0),
            spring("m", [0, 1], other),
            spring("n", [1, 0], other),
            spring("n", [0, 1], 1.0)
        ]);
        let answer = two_nodes(springs, [0.5, 0.5], [0.0, 0.0], [[6.0, -10.0], [1.5, -10.0]]).solve(&[]);
        is_answer(&answer);
        assert_eq!(states(&answer), [State::SlipPlus, State::Stick], "{other}");
        near_all("z_t", &of_pairs(&answer, |pair| pair.z_t), &[1.0, 0.0], 1e-12);
    }
}

/// K = w wᵀ with w = (0, 3·2⁻⁶, −2⁻⁵³, −3·2⁻⁶) over n of a and b, t of a and b: entries 2⁹⁷ apart, all exact. Without friction a
/// slides until x_t of it vanishes: z_t = −1.5·2⁻⁸² / 2⁻¹⁰⁶, and b carries 1.5·2⁻³⁵ + 3·2⁻⁵⁹ |z_t| both ways.
#[test]
fn entries_of_a_given_matrix_may_be_far_apart() {
    let two = |power: i32| 2f64.powi(power);
    let w = [0.0, 3.0 * two(-6), -two(-53), -3.0 * two(-6)];
    let rows: Vec<Vec<f64>> = w.iter().map(|a| w.iter().map(|b| a * b).collect()).collect();
    let answer = Case::json(json!({ "contact_system": {
        "pairs": ["a", "b"], "friction": [0, 2], "stiffness": rows,
        "loads": { "w": { "vector": [two(-83), 1.5 * two(-35), 1.5 * two(-82), -1.5 * two(-35)] } }
    } }))
    .solve(&[]);
    is_answer(&answer);
    let z_t = -1.5 * two(24);
    assert_eq!(of_pairs(&answer, |pair| pair.z_t), [z_t, 0.0]);
    let carried = 1.5 * two(-35) - 3.0 * two(-59) * z_t;
    assert_eq!(of_pairs(&answer, |pair| pair.x_n), [two(-83), carried]);
    assert_eq!(of_pairs(&answer, |pair| pair.x_t), [0.0, -carried]);
}

/// ζ costs nothing, K ζ = 0, opens c, slides b without friction, and the loads do the work 3·2⁷⁸ on it, all of it exact in f64:
/// there is no answer. Displacements of 3e23, beside which 2⁴² and less are rounding, are none.
#[test]
fn displacements_that_hide_the_loads_are_no_answer() {
    let rows = [
        [2883584.0, -2359296.0, 1.5 * 2f64.powi(60), 262144.0, -2359296.0, -1.375 * 2f64.powi(60)],
        [-2359296.0, 3145728.0, -1.5 * 2f64.powi(59), 524288.0, 2097152.0, 2f64.powi(58)],
        [
            1.5 * 2f64.powi(60),
            -1.5 * 2f64.powi(59),
            1.125 * 2f64.powi(100),
            1.5 * 2f64.powi(59),
            -1.5 * 2f64.powi(60),
            -1.125 * 2f64.powi(100),
        ],
        [262144.0, 524288.0, 1.5 * 2f64.powi(59), 7602176.0, -5242880.0, 1.25 * 2f64.powi(60)],
        [-2359296.0, 2097152.0, -1.5 * 2f64.powi(60), -5242880.0, 5767168.0, -2f64.powi(58)],
        [
            -1.375 * 2f64.powi(60),
            2f64.powi(58),
            -1.125 * 2f64.powi(100),
            1.25 * 2f64.powi(60),
            -2f64.powi(58),
            2f64.powi(101),
        ],
    ];
    let load = [
        1.5 * 2f64.powi(41),
        2f64.powi(39),
        -1.5 * 2f64.powi(79),
        1.5 * 2f64.powi(40),
        2f64.powi(39),
        1.5 * 2f64.powi(79),
    ];
    let motion = [0.0, 0.0, 5.0, 0.0, 3.0 * 2f64.powi(39), 3.0];
    let product = |row: &[f64; 6]| -> f64 { row.iter().zip(&motion).map(|(a, z)| a * z).sum() };
    assert!(rows.iter().all(|row| product(row) == 0.0));
    assert_eq!(-product(&load), 3.0 * 2f64.powi(78));
    let answer = Case::json(json!({ "contact_system": {
        "pairs": ["a", "b", "c"], "friction": [1, 0, 0], "gap": [0, -2f64.powi(21), 2f64.powi(-18)], "stiffness": rows,
        "loads": { "w": { "vector": load } }
    } }))
    .solve(&[]);
    assert_eq!(answer.outcome, OutcomeKind::Ray);
    assert!(is_proved(&answer), "{:?}", answer.ray);
}

/// The gap of m, closed by force, strains springs by 1e10: beside that a load of 4e-8 is rounding, and it is said that it has no
/// part in the answer.
#[test]
fn a_load_that_rounding_hides_is_told() {
    let springs = json!([{ "between": ["m", "n"], "direction": [-1, 2], "stiffness": 1000 },
                         { "between": ["n", "m"], "direction": [-1, 3], "stiffness": 500 },
                         { "between": ["m", "n"], "direction": [2, 3], "stiffness": 2000 }]);
    let answer = two_nodes(springs, [0.25, 0.25], [-1e-5, -1e7], [[4e-8, 1e-8], [1000.0, -4000.0]]).solve(&[]);
    assert!(
        answer.notes.iter().any(|note| note.contains("the load on a is smaller than the rounding")),
        "{:?}",
        answer.notes
    );
}

fn refused(stiffness: Value) -> Option<String> {
    let text = scenario_text(json!({ "contact_system": {
        "pairs": ["a"], "loads": { "w": { "vector": [1, -1] } }, "stiffness": stiffness } }));
    prepare(&load_text("test", &text, None).expect("read"), &Quiet).err().map(|error| error.to_string())
}

#[test]
fn what_two_joints_show_of_a_matrix_is_not_rounding() {
    for size in [1e-300, 1e-12, 1.0] {
        let text = refused(json!([[1, 0], [0, -size]])).expect("a negative diagonal entry");
        assert!(text.contains("diagonal entry for z_t of a") && text.contains("must be 0 or more"), "{text}");
    }
    // Of whole numbers nothing is rounded: 3·3 > 2·4.
    assert!(refused(json!([[2, 3], [3, 4]])).expect("3² > 2·4").contains("√(a b)"));
    assert!(refused(json!([[0, 1e-9], [1e-9, 1]])).is_some());
    // 1/3 and 2/3 in twelve digits: (0.666666666667)² is larger than a third of 1.33333333333 by its last digit.
    assert_eq!(refused(json!([[0.333333333333, 0.666666666667], [0.666666666667, 1.33333333333]])), None);
    assert!(refused(json!([[0.333333333333, 0.666666669], [0.666666669, 1.33333333333]])).is_some());
}

/// A bar on two feet whose spring is oblique, turned about the first foot by its loads: the second foot lifts off, and nothing
/// resists. The stored stiffness does by its rounding, so that its numbers have an answer 1e28 away: that is none of the structure.
#[test]
fn an_answer_that_rounding_makes_is_not_proved() {
    let (first, second) = ([0.1645, -0.01296], [2.946, 0.1447]);
    let (weight, push) = (10.0 * 0.01 * 1.0, [0.335 * 14.74, 0.335 * 17.41]);
    let arm = [0, 1].map(|i| second[i] - first[i]);
    let length = f64::hypot(arm[0], arm[1]);
    // Counter-clockwise about the first foot: the second one lifts off.
    assert!(arm[0] * push[1] - arm[1] * push[0] > 0.5 * arm[0] * weight * length);
    let case = Case::json(json!({
        "materials": { "m": { "E": 3e7, "nu": 0.2, "density": 1 } },
        "sections": { "s": { "area": 0.01, "inertia": 0.0001 } },
        "nodes": { "a": first, "b": second },
        "bars": [{ "id": "g", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 2 }],
        "springs": [{ "at": "a", "direction": [0.1124, -0.7651], "stiffness": 30000 }],
        "contacts": [
            { "id": "p0", "node": "a", "against": "ground", "normal": [0, 1], "friction": 1, "cohesion": 0.15 },
            { "id": "p1", "node": "b", "against": "ground", "normal": [0, 1], "friction": 0.2 }
        ],
        "loads": { "w": { "items": [
            { "gravity": { "acceleration": [0, -10] } },
            { "point": { "at": "b", "force": [push[0], push[1]] } },
            { "point": { "at": "a", "force": [-0.171, -0.94] } }
        ] } }
    }));
    assert!(!case.solve(&[]).is_answer());
    let all =
        case.prepared.all_answers(&case.scenario.parameter_values(), Rules::default(), &Quiet).expect("few pairs");
    for (solved, exact) in all.answers.iter().zip(&all.exact) {
        assert!(!exact && !solved.answer.is_answer(), "{:?}", solved.answer.pairs);
    }
}
