//! Histories whose last state before a limit, or at the end of a stage, rounding made another one of.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use serde_json::{Value, json};
use stickslip::answer::record::{OutcomeKind, Verdict};
use stickslip::path::cycle::{Kind, cycle};
use stickslip::path::stages::{Begin, History, HistoryEnd, StageResult, follow};

use super::judge::{Data, breach, converges, distances, goes_on};
use crate::common::{Case, near};

fn followed(case: &Case) -> History {
    let history = jumped(case);
    assert_eq!(breach(&Data::of(&case.prepared, &case.scenario.parameter_values()), &history), None);
    history
}

/// A history that may jump, where rates say nothing.
fn jumped(case: &Case) -> History {
    let values = case.scenario.parameter_values();
    follow(case.prepared.case(&case.scenario, &values)).unwrap_or_else(|e| panic!("{e}"))
}

fn read(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// The work of the loads is stored or dissipated all the way, but for this part of the largest energy.
fn goes_through_without_a_jump(text: &str, lost: f64) {
    let history = followed(&Case::json(read(text)));
    assert_eq!(history.end, HistoryEnd::Complete);
    for stage in &history.stages {
        assert!(stage.moments.iter().all(|moment| !moment.jump));
        assert!(stage.energy.expect("a structure").residual <= lost, "{:?}", stage.energy);
    }
}

/// A frame on three feet: the first one without friction, the second one with a spring askew, all of it lifted at one end.
/// Where its weight is taken off the first two feet hang, and the third slides. Nothing but the spring, the third foot and its
/// friction bears then, so that equilibrium says at which weight. The frame can turn without strain there: the rounding of its
/// stiffness, taken for one that resists, led on to the end of the stage, 1e13 away, where no contact force was left.
#[test]
fn what_only_rounding_resists_is_no_way_on() {
    let text = read(include_str!("lifted_frame.json"));
    let at = |name: &str| [0, 1].map(|i| text["nodes"][name][i].as_f64().expect("a coordinate"));
    let turned = |[x, y]: [f64; 2], force: [f64; 2]| Vector3::new(force[0], force[1], x * force[1] - y * force[0]);
    let bars = [["a0", "b0"], ["a1", "b1"], ["a2", "b2"], ["b0", "b1"], ["b1", "b2"]].map(|ends| ends.map(at));
    let area_density_gravity = 0.01 * 0.001 * 10.0;
    let weight: Vector3<f64> = bars
        .iter()
        .map(|[a, b]| {
            let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
            turned(middle, [0.0, -area_density_gravity * (a[0] - b[0]).hypot(a[1] - b[1])])
        })
        .sum();
    let lift = turned(at("b0"), [0.5 * 0.0002603, 0.5 * 0.001508]);
    let spring = turned(at("a1"), [-0.8355, 0.4227]);
    // The foot slides either way: of the two weights the one that presses it is the limit.
    let limits: Vec<f64> = [0.3, -0.3]
        .iter()
        .filter_map(|friction| {
            let foot = turned(at("a2"), [*friction, 1.0]);
            let found = Matrix3::from_columns(&[foot, spring, weight]).lu().solve(&-lift)?;
            (found[0] > 0.0 && (0.5..1.2).contains(&found[2])).then_some(found[2])
        })
        .collect();
    let limit = limits.into_iter().fold(0.0, f64::max);
    let history = followed(&Case::json(text));
    let HistoryEnd::Limit { stage: 2, collapse, .. } = &history.end else { panic!("{:?}", history.end) };
    assert_eq!(collapse.verdict, Some(Verdict::Certified));
    let reached = &history.stages[2].moments.last().expect("an end").factors;
    let of = |case: &str| history.cases.iter().position(|name| name == case).expect("a case");
    near("weight at the limit", reached[of("w")], limit, 1e-9, 1.0);
}

/// An arch that stands at the end of a stage, but for the last digits of the place, where a joint is about to open: what was found
/// there as a jump was no state, for no forces belonged to its displacements.
#[test]
fn the_end_of_a_stage_is_no_jump() {
    goes_through_without_a_jump(include_str!("arch_of_seven.json"), 1e-10);
}

/// An arch whose weight opens four joints, so that it could sway without strain, which its weight does not drive. What the numbers
/// made of the sway, a division by rounding, was 8 cm, of which half would have closed joints beyond contact: these were set
/// back, and the forces no longer belonged to the displacements. Structure and loads are symmetrical, and so is the answer.
#[test]
fn a_sway_that_nothing_drives_is_no_motion() {
    let text = read(include_str!("arch_of_four_hinges.json"));
    let history = followed(&Case::json(text));
    assert_eq!(history.end, HistoryEnd::Complete);
    for stage in &history.stages {
        assert!(stage.energy.expect("a structure").residual <= 1e-12, "{:?}", stage.energy);
        let pairs = &stage.moments.last().expect("an end").pairs;
        for (pair, mirror) in [(2, 8), (3, 9), (4, 6), (5, 7)] {
            near("an opening and its mirror image", pairs[pair].z_n, pairs[mirror].z_n, 1e-9, 0.01);
        }
    }
}

/// An arch that cools while the load on one of its stones is taken off: at the end of that stage two joints of either half meet
/// their limits at once. The rounding of their small forces, beside what the first half of the stage left, put one of them
/// 1e-12 of the stage before its end, where no rates led on. Small steps, each solved by R and RF alone, go to the end.
#[test]
fn limits_met_at_the_end_of_a_stage_but_for_rounding_are_met_there() {
    let text = include_str!("arch_that_cools.json");
    goes_through_without_a_jump(text, 1e-12);
    let case = Case::json(read(text));
    let data = Data::of(&case.prepared, &case.scenario.parameter_values());
    let distances = distances(&data, &followed(&case), 25).expect("steps");
    assert!(converges(&distances, 25), "{distances:?}");
}

/// The corners of these stones are given to ten digits: on three hinges the arch resists a motion by 1e-20 of its stiffness, and
/// presses against it by 1e-10. Read as they stand, such numbers have rates of 1e10 only; the arch is in neutral equilibrium there.
#[test]
fn what_the_last_digits_of_a_file_resist_is_neutral() {
    goes_through_without_a_jump(include_str!("arch_to_ten_digits.json"), 1e-9);
}

/// All joints of a symmetric arch take up its weight at once: the ties of the first rates cycled under the lexicographic rule.
/// In proportion to its weight nothing turns back, so that the way ends in the answer of the loads at once.
#[test]
fn an_arch_takes_up_its_weight() {
    let case = Case::json(read(include_str!("arch_of_five.json")));
    let history = followed(&case);
    assert_eq!(history.end, HistoryEnd::Complete);
    let at_once = case.solve(&[]);
    for (end, one) in history.stages[0].end.pairs.iter().zip(&at_once.pairs) {
        near(&end.id, end.x_n, one.x_n, 1e-9, 2e-4);
        near(&end.id, end.x_t, one.x_t, 1e-9, 2e-4);
    }
}

/// Two nodes on springs, the first on rough ground (f = 2) that a force lifts and pushes: at 0.3188 of the second stage it lets
/// go. Lemke's algorithm ends in a ray beyond; of all working schemes one is an answer, with the first node in the air and the
/// second at rest. Its numbers follow from the springs alone.
#[test]
fn a_jump_is_looked_for_among_all_schemes() {
    let spring = |at: &str, direction: [f64; 2], stiffness: f64| json!({ "at": at, "direction": direction, "stiffness": stiffness });
    let force = |case: [[f64; 2]; 2]| {
        let items = [("m0", case[0]), ("m1", case[1])];
        json!({ "items": items.map(|(at, force)| json!({ "point": { "at": at, "force": force } })) })
    };
    let (weight, push) = ([[0.0, -7.544], [0.0, -14.31]], [[31.6, 7.862], [0.0, 0.0]]);
    let contact = |node: &str, friction: f64| json!({ "id": format!("on-{node}"), "node": node, "against": "ground", "normal": [0, 1], "friction": friction });
    let case = Case::json(json!({
        "nodes": { "m0": [0, 0], "m1": [1, 0] },
        "springs": [
            spring("m0", [0.0, 1.0], 1e4), spring("m1", [0.0, 1.0], 1e4), spring("m0", [1.0, 0.0], 300.0),
            { "between": ["m0", "m1"], "direction": [1, -1], "stiffness": 1000 }
        ],
        "contacts": [contact("m0", 2.0), contact("m1", 0.4)],
        "loads": { "weight": force(weight), "push": force(push) },
        "stages": [{ "weight": 1 }, { "weight": 1, "push": 0.32 }]
    }));
    let history = jumped(&case);
    assert_eq!(history.end, HistoryEnd::Complete);
    let end = &history.stages[1];
    assert_eq!(end.moments.iter().filter(|moment| moment.jump).count(), 1);
    // The spring between the nodes resists x − y of the one less that of the other with 500 along x and −y.
    let [first, second] = [&end.end.pairs[0], &end.end.pairs[1]];
    let load = [0, 1].map(|i| weight[0][i] + 0.32 * push[0][i]);
    let along = |by: f64| 500.0 * by;
    let own = Matrix2::new(300.0 + along(1.0), -along(1.0), -along(1.0), 1e4 + along(1.0));
    let of_second = along(second.z_t);
    let moved = own.lu().solve(&Vector2::new(load[0] + of_second, load[1] - of_second)).expect("springs");
    near("open", first.z_n, moved[1], 1e-12, 1.0);
    near("slip", first.z_t, moved[0], 1e-12, 1.0);
    let pull = along(moved[0] - moved[1] - second.z_t);
    near("pressed", second.x_n, 14.31 + pull, 1e-10, 20.0);
    near("held", second.x_t.abs(), pull.abs(), 1e-10, 20.0);
    assert!(first.x_n == 0.0 && moved[1] > 0.0 && pull.abs() < 0.4 * (14.31 + pull), "{first:?} {second:?}");
}

/// A row of bearings without friction on a spring along it, pushed and let go: it moves by P / k at the spring, and comes back to
/// where it was. What is left of R z there is the rounding of P.
#[test]
fn a_load_that_is_let_off_leaves_the_rounding_of_what_it_was() {
    let nodes = ["n0", "n1", "n2", "n3"];
    let (push, spring) = (0.95 * 3.0, 100.0);
    let contact = |node: &&str| json!({ "id": format!("on-{node}"), "node": node, "against": "ground", "normal": [0, 1], "friction": 0.0 });
    let weight = |node: &&str| json!({ "point": { "at": node, "force": [0, -10] } });
    let case = Case::json(json!({
        "materials": { "steel": { "E": 200000, "nu": 0.3 } },
        "sections": { "beam": { "area": 0.02, "inertia": 0.0002 } },
        "nodes": { "n0": [0, 0], "n1": [1.1, 0], "n2": [2.2, 0], "n3": [3.3, 0] },
        "bars": [{ "id": "B", "polyline": nodes, "material": "steel", "section": "beam" }],
        "springs": [{ "at": "n0", "direction": [1, 0], "stiffness": spring }],
        "contacts": nodes.iter().map(contact).collect::<Vec<_>>(),
        "loads": {
            "w": { "items": nodes.iter().map(weight).collect::<Vec<_>>() },
            "p": { "items": [{ "point": { "at": "n3", "force": [3, 0] } }] }
        },
        "stages": [{ "w": 1 }, { "w": 1, "p": 0.95 }, { "w": 1 }]
    }));
    let history = followed(&case);
    assert_eq!(history.end, HistoryEnd::Complete);
    for (stage, expected) in history.stages.iter().zip([0.0, push / spring, 0.0]) {
        near("z_t", stage.end.pairs[0].z_t, expected, 1e-12, push / spring);
    }
}

/// A soft frame on four feet that a force pushes until all slip and an oblique one lifts off: it slides as a whole then, and nothing
/// resists that but the rounding of its stiffness. With 1e-7 more of the push that resisted as well, 1e10 away, and was taken for a
/// state to jump to, whose forces did not pass their check. Of all 216 schemes none leads on, by R and RF alone.
#[test]
fn what_only_rounding_resists_is_nothing_to_jump_to() {
    let case = Case::json(read(include_str!("frame_that_slides_off.json")));
    let history = followed(&case);
    let HistoryEnd::Limit { stage: 1, .. } = &history.end else { panic!("{:?}", history.end) };
    let stage = &history.stages[1];
    assert!(stage.end.check.passed && stage.end.outcome == OutcomeKind::Ray, "{:?}", stage.end.failure);
    assert!(stage.moments.iter().all(|moment| !moment.jump));
    let data = Data::of(&case.prepared, &case.scenario.parameter_values());
    let last = stage.moments.last().expect("an end");
    assert_eq!(goes_on(&data, last, &[1.0, -1.0], 1e3 * stage.max_slip()), Some(false));
    let mut before = last.clone();
    before.factors[1] += 2e-6;
    assert_eq!(goes_on(&data, &before, &[1.0, -1.0], 1e-3 * stage.max_slip()), Some(true));
}

/// A thin arch that a quake to and fro tips from one set of hinges to another: its feet slide apart by the same in each cycle, and
/// gaps that open and close in it are wider each time. Ten stages, followed one by one and judged from R and RF alone, slip in their
/// last cycle what `cycle` says that each further one does.
#[test]
fn gaps_that_widen_while_they_are_open_hide_no_ratchet() {
    let case = Case::json(read(include_str!("arch_that_rocks.json")));
    let history = jumped(&case);
    assert_eq!(history.end, HistoryEnd::Complete);
    let values = case.scenario.parameter_values();
    let data = Data::of(&case.prepared, &values);
    // From jump to jump.
    for stage in &history.stages {
        for way in stage.moments.chunk_by(|_, next| !next.jump) {
            let way = StageResult { moments: way.to_vec(), ..stage.clone() };
            assert_eq!(breach(&data, &History { stages: vec![way], ..history.clone() }), None);
        }
    }
    let found =
        cycle(case.prepared.case(&case.scenario, &values), "q", [-0.5, 1.0], 8, &Begin::Unloaded).expect("cycles");
    assert_eq!(found.kind, Kind::Ratchets, "{}", found.sentence);
    assert!(found.sentence.contains("while they are open, which no force feels"), "{}", found.sentence);
    let stages = &history.stages;
    let last = stages[9].slip.iter().zip(&stages[10].slip).map(|(there, back)| there + back);
    for (pair, slipped) in found.turns.last().expect("a cycle").pairs.iter().zip(last) {
        near(&pair.pair, pair.net, slipped, 1e-9, stages[10].max_slip_increment());
    }
    let wider = |pair: usize| stages[10].end.pairs[pair].z_n - stages[8].end.pairs[pair].z_n;
    let widest = (0..stages[10].end.pairs.len()).map(wider).fold(0.0, f64::max);
    near("gap", found.turns.last().expect("a cycle").gap_growth, widest, 1e-9, widest);
}

/// Two stones on rough ground, joined by a stiff spring, the first on a soft one: pulled until both slide. What resists the sliding is
/// 1e-9 of the stiffness between them, and exact. Beyond the friction of both the soft spring carries the pull, so that they slide by
/// as much as it exceeds that; back from there both hold until the pull has fallen by twice the friction of the first. Pulled
/// farther, to where rounding may be 1e-4 of the loads, they stop on the same way.
#[test]
fn little_resists_but_it_is_no_rounding() {
    let spring = |at: &str, direction: [f64; 2], stiffness: f64| json!({ "at": at, "direction": direction, "stiffness": stiffness });
    let point = |at: &str, force: [f64; 2]| json!({ "point": { "at": at, "force": force } });
    let contact = |node: &str, friction: f64| json!({ "id": format!("on-{node}"), "node": node, "against": "ground", "normal": [0, 1], "friction": friction });
    let of = |stiff: f64, farthest: f64| {
        Case::json(json!({
            "nodes": { "m0": [0, 0], "m1": [1, 0] },
            "springs": [
                spring("m0", [1.0, 0.0], 1.0), { "between": ["m0", "m1"], "direction": [1, 0], "stiffness": stiff },
                spring("m0", [0.0, 1.0], 1e3), spring("m1", [0.0, 1.0], 1e3)
            ],
            "contacts": [contact("m0", 0.5), contact("m1", 0.25)],
            "loads": {
                "weight": { "items": [point("m0", [0.0, -1.0]), point("m1", [0.0, -2.0])] },
                "pull": { "items": [point("m0", [1.0, 0.0])] }
            },
            "stages": [{ "weight": 1 }, { "weight": 1, "pull": farthest }, { "weight": 1, "pull": 0.95 }]
        }))
    };
    for stiff in [1e6, 1e9, 3e9] {
        let history = followed(&of(stiff, 1.05));
        assert_eq!(history.end, HistoryEnd::Complete);
        assert!(history.stages.iter().flat_map(|stage| &stage.moments).all(|moment| !moment.jump));
        for stage in &history.stages[1..] {
            let [first, second] = [0, 1].map(|pair| stage.end.pairs[pair].z_t);
            // The terms of the forces are `stiff` times the slips: so much of the pull is their rounding.
            near("first", first, 0.05, 1e-15 * stiff, 1.0);
            near("between", first - second, 0.5 / stiff, 1e-15, 1.0);
            assert!(stage.moments.len() <= 4, "{}", stage.moments.len());
        }
    }
    let history = followed(&of(1e9, 3.0));
    let HistoryEnd::Limit { stage: 1, t, .. } = &history.end else { panic!("{:?}", history.end) };
    let stage = &history.stages[1];
    near("slid", stage.end.pairs[0].z_t, 3.0 * t - 1.0, 1e-6, 1.0);
    // A force is summed from 2e9 z, and judged by twice that, beside a largest load of 2, to 1024 ε of it.
    near("until", stage.end.pairs[0].z_t, 1e-4 * 2.0 / (4e9 * 1024.0 * f64::EPSILON), 0.01, 1.0);
    assert!(stage.moments.len() <= 6 && stage.moments.iter().all(|moment| !moment.jump), "{}", stage.moments.len());
}
