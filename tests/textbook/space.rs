//! Structures in space: closed forms, patch tests, and problems of the plane written in space.

use serde_json::{Value, json};

use crate::common::*;
use stickslip::answer::record::{Answer, EndForces, OutcomeKind, State, Verdict};
use stickslip::model::load::load_text;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

/// A structure in space.
fn space(mut value: Value) -> Case {
    value["dimension"] = json!(3);
    Case::json(value)
}

/// Displacements of a node by component.
fn moved(answer: &Answer, node: &str) -> [f64; 6] {
    let all = answer.displacements.as_ref().expect("displacements");
    all.iter().find(|found| found.node == node).expect("a node").all()
}

/// One node on springs of stiffness 1, r = 2, F = (3, 4): |F| − r = 3 stretches them along F.
#[test]
fn a_node_on_two_springs() {
    let spring = |direction: [i32; 3]| json!({ "at": "A", "direction": direction, "stiffness": 1 });
    let case = space(json!({
        "nodes": { "A": [0, 0, 0] },
        "springs": [spring([1, 0, 0]), spring([0, 1, 0]), spring([0, 0, 1])],
        "contacts": [{ "id": "c", "node": "A", "against": "ground", "normal": [0, 0, 1], "law": "bound", "bound": 2 }],
        "loads": { "F": { "items": [{ "point": { "at": "A", "force": [3, 4, 0] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    near_all("u", &moved(&answer, "A"), &[1.8, 2.4, 0.0, 0.0, 0.0, 0.0], 1e-12);
    let pair = &answer.pairs[0];
    assert_eq!(pair.state, State::Slip);
    near_all("friction", &pair.friction(), &[-1.2, -1.6], 1e-12);
    close("direction", pair.direction().expect("a slip"), 0.8_f64.atan2(0.6).to_degrees(), 1e-12);
}

/// A cantilever along x with a force and a torque at its end: u_x = FL/EA, bending about both axes, θ = TL/GJ. Local y is
/// the global z, local z is −y.
#[test]
fn a_cantilever_bends_both_ways_and_twists() {
    let (e, nu, l) = (2.1e8, 0.3, 4.0_f64);
    let (area, iy, iz, j) = (0.01, 2e-5, 1e-4, 3e-5);
    let case = space(json!({
        "materials": { "m": { "E": e, "nu": nu } },
        "sections": { "s": { "area": area, "inertia_y": iy, "inertia_z": iz, "torsion": j } },
        "nodes": { "A": [0, 0, 0], "B": [l, 0, 0] },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "divisions": 3 }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "loads": { "F": { "items": [{ "point": { "at": "B", "force": [1, 2, 3], "moment": [4, 0, 0] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let g = e / (2.0 * (1.0 + nu));
    let expected = [
        l / (e * area),
        2.0 * l.powi(3) / (3.0 * e * iy),
        3.0 * l.powi(3) / (3.0 * e * iz),
        4.0 * l / (g * j),
        -3.0 * l * l / (2.0 * e * iz),
        2.0 * l * l / (2.0 * e * iy),
    ];
    for (found, expected) in moved(&answer, "B").into_iter().zip(expected) {
        close("tip", found, expected, 1e-10);
    }
    let start = answer.members.as_ref().expect("members")[0].start;
    let expected = EndForces { n: 1.0, q: -3.0, m: 3.0 * l, space: Some([2.0, -2.0 * l, 4.0]) };
    for ((name, found), (_, expected)) in start.named().into_iter().zip(expected.named()) {
        close(name, found, expected, 1e-10);
    }
    let reaction = &answer.reactions.as_ref().expect("reactions")[0];
    near_all("force", &reaction.force(), &[-1.0, -2.0, -3.0], 1e-10);
    // −(x × F + M): x × F = (0, −3L, 2L).
    near_all("moment", &reaction.moment(), &[-4.0, 3.0 * l, -2.0 * l], 1e-10);
}

/// Hinged at both ends on supports that hold nothing but its place, under its weight: M = qL²/8 in the middle, and no
/// mechanism, although nothing but the rotation of its own nodes keeps it from spinning.
#[test]
fn a_hinged_bar_between_columns_is_a_simple_beam() {
    let l = 4.0;
    let column =
        |id: &str, foot: &str, head: &str| json!({ "id": id, "nodes": [foot, head], "material": "m", "section": "s" });
    let clamp = |at: &str| json!({ "at": at, "fixed": ["x", "y", "z", "rx", "ry", "rz"] });
    let case = space(json!({
        "materials": { "m": { "E": 2.1e8, "nu": 0.3 } },
        "sections": { "s": { "area": 0.01, "inertia_y": 1e-4, "inertia_z": 1e-4, "torsion": 1e-4 } },
        "nodes": { "a": [0, 0, 0], "b": [0, 0, 3], "c": [0, l, 3], "d": [0, l, 0] },
        "bars": [column("ab", "a", "b"), column("cd", "d", "c"),
                 { "id": "bc", "nodes": ["b", "c"], "material": "m", "section": "s", "divisions": 4, "hinges": ["start", "end"] }],
        "supports": [clamp("a"), clamp("d")],
        "loads": { "q": { "items": [{ "line": { "bar": "bc", "value": [0, 0, -5] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let members = answer.members.as_ref().expect("members");
    let beam: Vec<_> = members.iter().filter(|member| member.bar == "bc").collect();
    close("middle", beam[1].end.m, 5.0 * l * l / 8.0, 1e-9);
    near("start", beam[0].start.m, 0.0, 1e-9, 10.0);
    close("column", members[0].start.n, -5.0 * l / 2.0, 1e-10);
}

/// A bar along x between ball joints, its places held as said; local y is the global z.
fn between_joints(divisions: usize, held: &[&str], load: Value) -> Value {
    json!({
        "materials": { "m": { "E": 2.0e8, "nu": 0.25 } },
        "sections": { "s": { "area": 0.01, "inertia_y": 2e-5, "inertia_z": 1e-4, "torsion": 3e-5 } },
        "nodes": { "a": [1, 2, 3], "b": [5, 2, 3] },
        "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": divisions,
                   "hinges": ["start", "end"] }],
        "supports": [{ "at": "a", "fixed": held }, { "at": "b", "fixed": ["x", "y", "z"] }],
        "loads": { "F": { "items": [load] } }
    })
}

/// Between ball joints a bar may spin about its line, which nothing feels: divided or not it is a simple beam,
/// v = FL³/48EI in the middle both ways, and M = FL/4; bent there by a couple M it turns by ML/12EI. So it is where the
/// joints are clamped.
#[test]
fn a_divided_bar_between_ball_joints_is_a_simple_beam() {
    let (e, iy, iz, l) = (2.0e8, 2e-5, 1e-4, 4.0_f64);
    let all = ["x", "y", "z", "rx", "ry", "rz"];
    for (divisions, held) in [(2, &all[..3]), (4, &all[..3]), (2, &all[..])] {
        let middle = format!("ab/{}", divisions / 2);
        let force = json!({ "point": { "at": middle, "force": [0, 2, 3], "moment": [0, 5, 7] } });
        let answer = space(between_joints(divisions, held, force)).solve(&[]);
        is_answer(&answer);
        let bent = [0.0, 2.0 / iy, 3.0 / iz].map(|force| force * l.powi(3) / (48.0 * e));
        let turned = [0.0, 5.0 / iz, 7.0 / iy].map(|moment| moment * l / (12.0 * e));
        near_all("middle", &moved(&answer, &middle), &[bent, turned].concat(), 1e-10);
    }
}

/// What is said of a structure in space that cannot be solved.
fn refused(value: Value) -> String {
    let scenario = load_text("test", &scenario_text(value), None).expect("a scenario");
    let Err(refused) = prepare(&scenario, &Quiet) else { panic!("to be refused") };
    refused.to_string()
}

/// A torque on it is taken where a joint is clamped, a hinge hands it on: θ = T (L/2)/GJ. Between ball joints nothing takes it.
#[test]
fn a_torque_between_ball_joints_has_nothing_to_hold_it() {
    let torque = || json!({ "point": { "at": "ab/1", "force": [0, 0, 0], "moment": [6, 0, 0] } });
    let answer = space(between_joints(2, &["x", "y", "z", "rx", "ry", "rz"], torque())).solve(&[]);
    is_answer(&answer);
    close("twist", moved(&answer, "ab/1")[3], 6.0 * 2.0 / (2.0e8 / 2.5 * 3e-5), 1e-10);
    near_all("moment", &answer.reactions.as_ref().expect("reactions")[0].moment(), &[-6.0, 0.0, 0.0], 1e-10);
    let mut loose = between_joints(2, &["x", "y", "z"], torque());
    loose["dimension"] = json!(3);
    let refused = refused(loose);
    assert!(refused.contains("node ab/1 is free to move by turning (rx)"), "{refused}");
}

/// A column through a floor between ball joints, its beam hinged to it: nothing feels it spin, while the beam's torque
/// holds the beam. Both are simple beams, the beam pushes its reaction into the column.
#[test]
fn a_column_between_ball_joints_carries_a_hinged_beam() {
    let case = space(json!({
        "materials": { "m": { "E": 2.0e8, "nu": 0.25 } },
        "sections": { "s": { "area": 0.01, "inertia_y": 2e-5, "inertia_z": 1e-4, "torsion": 3e-5 } },
        "nodes": { "foot": [0, 0, 0], "m": [0, 0, 2], "head": [0, 0, 5], "c": [4, 0, 2] },
        "bars": [
            { "id": "column", "polyline": ["foot", "m", "head"], "material": "m", "section": "s", "hinges": ["start", "end"] },
            { "id": "beam", "nodes": ["m", "c"], "material": "m", "section": "s", "hinges": ["start", "end"], "divisions": 2 }
        ],
        "supports": [{ "at": "foot", "fixed": ["x", "y", "z"] }, { "at": "head", "fixed": ["x", "y"] },
                     { "at": "c", "fixed": ["y", "z"] }],
        "loads": { "F": { "items": [{ "line": { "bar": "beam", "value": [0, 3, -5] } },
                                    { "point": { "at": "m", "force": [30, 0, 0] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let reaction = |node: &str| {
        let all = answer.reactions.as_ref().expect("reactions");
        all.iter().find(|found| found.node == node).expect("a reaction").force()
    };
    near_all("foot", &reaction("foot"), &[-30.0 * 3.0 / 5.0, -6.0 * 3.0 / 5.0, 10.0], 1e-10);
    near_all("head", &reaction("head"), &[-30.0 * 2.0 / 5.0, -6.0 * 2.0 / 5.0, 0.0], 1e-10);
    near_all("c", &reaction("c"), &[0.0, -6.0, 10.0], 1e-10);
}

/// Two cantilevers that meet in a hinge at right angles share a load: w = F L³/6EI. The hinge is held against turning about x
/// only: about y the torque of the second bar holds it, about z nothing, and nothing drives it, however much it is held.
#[test]
fn a_hinge_may_turn_as_nothing_resists() {
    let (e, i, l) = (2.0e8, 3e-5, 2.0_f64);
    let clamp = |at: &str| json!({ "at": at, "fixed": ["x", "y", "z", "rx", "ry", "rz"] });
    let bar = |id: &str, from: &str| json!({ "id": id, "nodes": [from, "n"], "material": "m", "section": "s", "hinges": ["end"] });
    let model = |held: &[&str], moment: [f64; 3]| {
        json!({
            "dimension": 3,
            "materials": { "m": { "E": e, "nu": 0.25 } },
            "sections": { "s": { "area": 0.01, "inertia_y": i, "inertia_z": i, "torsion": 2e-5 } },
            "nodes": { "a": [0, 0, 0], "b": [l, -l, 0], "n": [l, 0, 0] },
            "bars": [bar("an", "a"), bar("bn", "b")],
            "supports": [clamp("a"), clamp("b"), { "at": "n", "fixed": held }],
            "loads": { "F": { "items": [{ "point": { "at": "n", "force": [0, 0, -6], "moment": moment } }] } }
        })
    };
    for held in [&["rx"][..], &["ry"], &["rz"], &["rx", "rz"]] {
        let answer = space(model(held, [0.0; 3])).solve(&[]);
        is_answer(&answer);
        let right = [0.0, 0.0, -6.0 * l.powi(3) / (6.0 * e * i), 0.0, 0.0, 0.0];
        near_all(&held.join(" "), &moved(&answer, "n"), &right, 1e-10);
    }
    // A moment about y twists the second bar, one about z nothing takes.
    let answer = space(model(&["rx"], [0.0, 5.0, 0.0])).solve(&[]);
    close("twist", moved(&answer, "n")[4], 5.0 * l / (e / 2.5 * 2e-5), 1e-10);
    let refused = refused(model(&["rx"], [0.0, 0.0, 5.0]));
    assert!(refused.contains("node n is free to move by turning (rz)"), "{refused}");
}

/// A beam along (2, 1, 2) that only its places hold, as beams are drawn: no load feels that it can spin about its line,
/// w = FL³/48EI and M = FL/4. A torque does.
#[test]
fn a_beam_on_two_points_may_spin() {
    let (e, i, f, l) = (2.0e8, 3e-5, 7.0, 6.0_f64);
    let model = |moment: [f64; 3]| {
        json!({
            "dimension": 3,
            "materials": { "m": { "E": e, "nu": 0.25 } },
            "sections": { "s": { "area": 0.01, "inertia_y": i, "inertia_z": i, "torsion": 2e-5 } },
            "nodes": { "a": [0, 0, 0], "b": [4, 2, 4] },
            "bars": [{ "id": "ab", "nodes": ["a", "b"], "material": "m", "section": "s", "divisions": 2 }],
            "supports": [{ "at": "a", "fixed": ["x", "y", "z"] }, { "at": "b", "fixed": ["x", "y", "z"] }],
            "loads": { "F": { "items": [{ "point": { "at": "ab/1", "force": [f, -2.0 * f, 0], "moment": moment } }] } }
        })
    };
    let answer = space(model([0.0; 3])).solve(&[]);
    is_answer(&answer);
    let bent = f * 5.0_f64.sqrt() * l.powi(3) / (48.0 * e * i);
    let [x, y, z, ..] = moved(&answer, "ab/1");
    near_all("middle", &[x, y, z], &[bent / 5.0_f64.sqrt(), -2.0 * bent / 5.0_f64.sqrt(), 0.0], 1e-10);
    let member = &answer.members.as_ref().expect("members")[0];
    let [_, my, _] = member.end.space.expect("a bar in space");
    close("moment", my.hypot(member.end.m), f * 5.0_f64.sqrt() * l / 4.0, 1e-10);
    let refused = refused(model([2.0, 1.0, 2.0]));
    assert!(refused.contains("by turning about (0.667, 0.333, 0.667)"), "{refused}");
}

/// A beam on frictional supports in the plane, and the same in space: upright z in the place of y. Its numbers are those
/// of the plane.
#[test]
fn a_problem_of_the_plane_written_in_space() {
    let place = |is_space: bool, x: f64, y: f64| if is_space { json!([x, 0.0, y]) } else { json!([x, y]) };
    let of = |is_space: bool| {
        let v = |x: f64, y: f64| place(is_space, x, y);
        let section = match is_space {
            true => json!({ "area": 0.01, "inertia_y": 5e-5, "inertia_z": 1e-4, "torsion": 1e-5 }),
            false => json!({ "area": 0.01, "inertia": 1e-4 }),
        };
        let clamp = if is_space { json!(["x", "y", "z", "rx", "ry", "rz"]) } else { json!(["x", "y", "r"]) };
        let contact = |id: &str, node: &str| json!({ "id": id, "node": node, "against": "ground", "normal": v(0.0, 1.0), "friction": 0.3 });
        let mut value = json!({
            "materials": { "m": { "E": 2.1e8, "nu": 0.3 } },
            "sections": { "s": section },
            "nodes": { "a": v(0.0, 0.0), "b": v(2.0, 0.0), "c": v(4.0, 0.0) },
            "bars": [{ "id": "ac", "polyline": ["a", "b", "c"], "material": "m", "section": "s", "divisions": 2 }],
            "supports": [{ "at": "a", "fixed": clamp }],
            "contacts": [contact("p", "b"), contact("q", "c")],
            "loads": { "w": { "items": [{ "line": { "bar": "ac", "value": v(0.0, -20.0) } }] },
                       "h": { "items": [{ "point": { "at": "c", "force": v(30.0, 0.0) } }] } }
        });
        if is_space {
            value["dimension"] = json!(3);
        }
        Case::json(value).solve(&[])
    };
    let (plane, solid) = (of(false), of(true));
    is_answer(&plane);
    is_answer(&solid);
    for (one, other) in plane.pairs.iter().zip(&solid.pairs) {
        close("x_n", other.x_n, one.x_n, 1e-9);
        near("x_t", other.friction()[0], one.x_t, 1e-9, one.bound);
        near("z_t", other.slip()[0], one.z_t, 1e-9, 1e-4);
        assert_eq!(one.state == State::Stick, other.state == State::Stick, "{}", one.id);
    }
    for node in ["b", "c", "ac/1"] {
        let ([ux, uy, turn], found) = (displacement(&plane, node), moved(&solid, node));
        near_all(node, &[found[0], found[2], -found[4]], &[ux, uy, turn], 1e-12);
    }
    let members = |answer: &Answer| answer.members.clone().expect("members");
    for (one, other) in members(&plane).iter().zip(members(&solid)) {
        near_all(
            "start",
            &[other.start.n, other.start.q, other.start.m],
            &[one.start.n, one.start.q, one.start.m],
            1e-9,
        );
    }
}

fn block(friction: f64) -> Case {
    space(json!({
        "parameters": { "H": 0.1, "a": 0.0 },
        "materials": { "m": { "E": 1000, "nu": 0.2 } },
        "bricks": [{ "id": "b", "origin": [0, 0, 0], "size": [2, 2, 1], "divisions": [2, 2, 1], "material": "m" }],
        "contacts": [{ "id": "base", "face": "b.bottom", "against": "ground", "friction": friction }],
        "loads": { "weight": { "items": [{ "point": { "at": "b.top", "force": [0, 0, -1] } }] },
                   "push": { "factor": "H", "items": [{ "point": { "at": "b.bottom", "force": ["cos(a)", "sin(a)", 0] } }] } }
    }))
}

/// A block on a rough plane slides at f W whatever way it is pushed: it stands at 1 − 1e-6 of that, and its collapse is
/// certified at 1 + 1e-5.
#[test]
fn a_block_slides_at_the_same_force_every_way() {
    let (f, case) = (0.4, block(0.4));
    for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_4, 2.5] {
        let values = case.scenario.parameter_values();
        let at = |h: f64| {
            let mut values = values.clone();
            values.insert("a".to_owned(), angle);
            values.insert("H".to_owned(), h);
            case.at(&values).solve(&[("a", angle), ("H", h)])
        };
        let below = at(f * (1.0 - 1e-6));
        is_answer(&below);
        let total: f64 = of_pairs(&below, |pair| pair.x_n).iter().sum();
        close("weight", total, 1.0, 1e-10);
        let friction = |c: usize| -> f64 { below.pairs.iter().map(|pair| pair.friction()[c]).sum() };
        near_all("friction", &[friction(0), friction(1)], &[-f * angle.cos(), -f * angle.sin()], 1e-5);
        let beyond = at(f * (1.0 + 1e-5));
        assert_eq!(beyond.outcome, OutcomeKind::Ray, "{angle}");
        // Where the polygon held it, nothing is missing: p may be 0.
        let ray = beyond.ray.as_ref().expect("a ray");
        assert_eq!(ray.verdict, Some(Verdict::Certified), "{angle}");
    }
}

/// A brick pulled along x: σ = E ε exactly, with either element, and the sides draw in by ν ε.
#[test]
fn a_brick_pulled_evenly_is_strained_evenly() {
    for element in ["plain", "incompatible"] {
        let case = space(json!({
            "materials": { "m": { "E": 200, "nu": 0.3 } },
            "bricks": [{ "id": "b", "origin": [1, 1, 1], "size": [3, 2, 1], "divisions": [3, 2, 2], "material": "m", "element": element }],
            "supports": [{ "at": "b.left", "fixed": ["x"] }, { "at": "b.front", "fixed": ["y"] }, { "at": "b.bottom", "fixed": ["z"] }],
            "loads": { "pull": { "items": [{ "traction": { "face": "b.right", "value": [10, 0, 0] } }] } }
        }));
        let answer = case.solve(&[]);
        is_answer(&answer);
        let strain = 10.0 / 200.0;
        let [x, y, z, ..] = moved(&answer, "b[3,2,2]");
        near_all(element, &[x, y, z], &[3.0 * strain, -0.3 * 2.0 * strain, -0.3 * strain], 1e-12);
    }
}

/// Pressure on the side of a block is balanced by its supports, and water up to half of its height presses with γh²/2.
#[test]
fn pressure_and_water_on_faces() {
    let case = space(json!({
        "materials": { "m": { "E": 200, "nu": 0.3, "density": 2 } },
        "bricks": [{ "id": "b", "origin": [0, 0, 0], "size": [1, 2, 4], "divisions": [1, 2, 3], "material": "m" }],
        "supports": [{ "at": "b.bottom", "fixed": ["x", "y", "z"] }],
        "loads": { "p": { "items": [{ "pressure": { "face": "b.left", "value": 3 } }] },
                   "w": { "items": [{ "fluid": { "face": "b.front", "level": 2, "weight": 10 } }] },
                   "g": { "items": [{ "gravity": { "acceleration": [0, 0, -10] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    let sum = |c: usize| -> f64 { answer.reactions.iter().flatten().map(|reaction| reaction.force()[c]).sum() };
    close("pressure", sum(0), -3.0 * 8.0, 1e-11);
    close("water", sum(1), -10.0 * 2.0 * 2.0 / 2.0, 1e-11);
    close("weight", sum(2), 2.0 * 10.0 * 8.0, 1e-11);
}

/// A rigid body of three nodes on three springs, and one of two nodes, whose spin about its own line nothing feels.
#[test]
fn rigid_bodies_in_space() {
    let spring = |at: &str, k: f64| json!({ "at": at, "direction": [0, 0, 1], "stiffness": k });
    let case = space(json!({
        "nodes": { "a": [0, 0, 0], "b": [2, 0, 0], "c": [0, 2, 0], "d": [4, 0, 0], "e": [4, 3, 0] },
        "rigid": [{ "id": "plate", "nodes": ["a", "b", "c"] }, { "id": "line", "nodes": ["d", "e"] }],
        "supports": [{ "at": "a", "fixed": ["x", "y", "rz"] }, { "at": "d", "fixed": ["x", "y"] }, { "at": "e", "fixed": ["x"] }],
        "springs": [spring("a", 1.0), spring("b", 2.0), spring("c", 4.0), spring("d", 1.0), spring("e", 1.0)],
        "loads": { "F": { "items": [{ "point": { "at": "b", "force": [0, 0, -6] } }, { "point": { "at": "e", "force": [0, 0, -1] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    // All of the force goes into the spring below it.
    for (node, sag) in [("a", 0.0), ("b", -3.0), ("c", 0.0), ("d", 0.0), ("e", -1.0)] {
        near(node, moved(&answer, node)[2], sag, 1e-12, 1.0);
    }
    // u_z = −θ_y x over the first, θ_x y over the second.
    near_all("turned", &moved(&answer, "c")[3..], &[0.0, 1.5, 0.0], 1e-12);
    near_all("turned", &moved(&answer, "d")[3..], &[-1.0 / 3.0, 0.0, 0.0], 1e-12);
}

/// A hinge that is held against turning about x, and a clamped bar along a that meets it at the small angle δ to x: a moment
/// t1 x + t2 a in their plane twists the bar by t2, one across it drives the hinge. The axis about which it may turn, x × a,
/// is known to ε/δ.
#[test]
fn a_hinge_and_a_bar_at_a_small_angle_take_a_moment_in_their_plane() {
    let (delta, l, [t1, t2]) = (1e-5_f64, 2.0, [2.0, -1.5]);
    let (x, axis) = ([1.0, 0.0, 0.0], [delta.cos(), delta.sin() * 0.7_f64.cos(), delta.sin() * 0.7_f64.sin()]);
    let model = |moment: [f64; 3]| {
        json!({
            "dimension": 3,
            "materials": { "m": { "E": 2.0e8, "nu": 0.25 } },
            "sections": { "s": { "area": 0.01, "inertia_y": 3e-5, "inertia_z": 3e-5, "torsion": 2e-5 } },
            "nodes": { "a": axis.map(|c| -l * c), "n": [0, 0, 0] },
            "bars": [{ "id": "an", "nodes": ["a", "n"], "material": "m", "section": "s", "hinges": ["end"] }],
            "supports": [{ "at": "a", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }, { "at": "n", "fixed": ["rx"] }],
            "loads": { "M": { "items": [{ "point": { "at": "n", "force": [0, 0, 0], "moment": moment } }] } }
        })
    };
    let sum = |of: [f64; 3], along: [f64; 3]| (0..3).map(|c| of[c] * along[c]).sum::<f64>();
    let answer = space(model([0, 1, 2].map(|c| t1 * x[c] + t2 * axis[c]))).solve(&[]);
    is_answer(&answer);
    let all = answer.reactions.as_ref().expect("reactions");
    let moment = |node: &str| all.iter().find(|found| found.node == node).expect("a reaction").moment();
    near("bar", sum(moment("a"), axis), -t2, 1e-9, t2);
    near("hinge", moment("n")[0], -t1, 1e-9, t1);
    let refused = refused(model([0.0, -0.7_f64.sin(), 0.7_f64.cos()]));
    assert!(refused.contains("node n is free to move by turning about"), "{refused}");
}

/// A frame on three feet, one rough, turns about that by metres until a soft spring at n3 holds it. The spring's line passes
/// the middle of the nodes at some ε of its length: the turn about the vertical axis that leaves it as long as it is was then
/// taken 1/ε times as large as the others, and the rounding of that weighed on feet that are 10⁵ times as stiff. By statics,
/// about the vertical through n0: S (r₃ × d)_z = P x₁; the rest from moments about the horizontals.
#[test]
fn a_frame_that_turns_far_against_a_soft_spring() {
    let (k, push) = (0.05, 0.3);
    let (h, d) = ([-0.444, 0.602], [-0.444_f64, 0.602, -0.322]);
    let d = d.map(|entry| entry / (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt());
    for beside in [1e-5, 1e-3, 0.3] {
        let feet = [[-2.0, 0.1, 0.3], [1.0, 2.1, -0.2], [1.1, -1.9, 0.17]];
        // At 4/3 of its way from the middle of the feet a node is at that way from the middle of all four.
        let top = [0.1 / 3.0 + 0.9 * h[0] + beside * h[1], 0.1 + 0.9 * h[1] - beside * h[0], 1.3];
        let bar = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|node| format!("n{node}"));
            json!({ "id": format!("{a}{b}"), "nodes": [a, b], "kind": "frame", "material": "m", "section": "s" })
        };
        let contact = |foot: usize| {
            json!({ "id": format!("c{foot}"), "node": format!("n{foot}"), "against": "ground", "normal": [0, 0, 1],
                    "friction": if foot == 0 { 0.6 } else { 0.0 } })
        };
        let weight = |node: usize| json!({ "point": { "at": format!("n{node}"), "force": [0, 0, -1] } });
        let case = space(json!({
            "materials": { "m": { "E": 3e7, "nu": 0 } },
            "sections": { "s": { "area": 0.01, "inertia_y": 1e-4, "inertia_z": 1e-4, "torsion": 1e-4 } },
            "nodes": { "n0": feet[0], "n1": feet[1], "n2": feet[2], "n3": top },
            "bars": [bar(0, 1), bar(1, 2), bar(2, 0), bar(0, 3), bar(1, 3), bar(2, 3)],
            "contacts": [contact(0), contact(1), contact(2)],
            "springs": [{ "at": "n3", "direction": d, "stiffness": k }],
            "loads": {
                "w": { "items": [weight(0), weight(1), weight(2), weight(3)] },
                "p": { "items": [{ "point": { "at": "n1", "force": [0, push, 0] } }] }
            }
        }));
        let answer = case.solve(&[]);
        is_answer(&answer);
        let [r1, r2, r3] =
            [feet[1], feet[2], top].map(|place| std::array::from_fn::<_, 3, _>(|c| place[c] - feet[0][c]));
        let s = push * r1[0] / (r3[0] * d[1] - r3[1] * d[0]);
        // y₁ N₁ + y₂ N₂ = m_x, x₁ N₁ + x₂ N₂ = m_y: weights, the push at z₁ and the spring at n3.
        let mx = r1[1] + r2[1] + r3[1] + r1[2] * push + s * (r3[1] * d[2] - r3[2] * d[1]);
        let my = r1[0] + r2[0] + r3[0] + s * (r3[0] * d[2] - r3[2] * d[0]);
        let det = r1[1] * r2[0] - r2[1] * r1[0];
        let (n1, n2) = ((mx * r2[0] - r2[1] * my) / det, (r1[1] * my - r1[0] * mx) / det);
        let n0 = 4.0 + s * d[2] - n1 - n2;
        // A force is a sum of nine terms R_ij z_j of up to EA/L · slip, in which R_ij and the product are rounded.
        let rounding = 9.0 * f64::EPSILON * 1e5 * answer.pairs[2].slip_size();
        for (pair, right) in answer.pairs.iter().zip([n0, n1, n2]) {
            near("pressure", pair.x_n, right, rounding, 1.0);
        }
        for (found, right) in answer.pairs[0].friction().iter().zip([s * d[0], s * d[1] - push]) {
            near("friction", *found, right, rounding, 1.0);
        }
        let u = moved(&answer, "n3");
        near("spring", k * (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]), s, rounding, 1.0);
    }
}
