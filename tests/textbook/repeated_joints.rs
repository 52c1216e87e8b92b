//! Joints that repeat one another where blocks meet. Guides with two opposed pairs at one node: [`super::guides`].
//!
//! ```text
//!   ┌────┬────┐
//!   │ a  │ b  │   T corner: head joint a|b on two bed joints
//!   └────┴────┘
//! ```

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, OutcomeKind};
use stickslip::model::rules::{Covering, Rules};
use stickslip::path::limit::limit;

use crate::common::balance::{imbalance, incompatibility, nodal_imbalance};
use crate::common::laws::violation;
use crate::common::*;
use crate::guides::guide;

/// Two stiff blocks side by side on the ground: at the foot of their head joint three pairs meet, six joints on four
/// relative displacements.
pub fn corner(friction: f64) -> Case {
    let block = |id: &str, x: f64| {
        json!({ "id": id, "origin": [x, 0], "size": [1, 1], "divisions": [2, 2],
                "thickness": 1, "material": "m", "plane": "stress" })
    };
    Case::json(json!({
        "parameters": { "W": 1, "H": 0, "f": friction },
        "materials": { "m": { "E": 1e4, "nu": 0 } },
        "plates": [block("a", 0.0), block("b", 1.0)],
        "contacts": [
            { "id": "bed_a", "edge": "a.bottom", "against": "ground", "friction": "f" },
            { "id": "bed_b", "edge": "b.bottom", "against": "ground", "friction": "f" },
            { "id": "head", "edge": "b.left", "against": "a.right", "friction": "f" }
        ],
        "loads": {
            "weight": { "factor": "W", "items": [{ "traction": { "edge": "a.top", "value": [0, -1] } },
                                                 { "traction": { "edge": "b.top", "value": [0, -1] } }] },
            "push": { "factor": "H", "items": [{ "point": { "at": "a[0,1]", "force": [1, 0] } }] }
        }
    }))
}

fn sum(answer: &Answer, prefix: &str, read: impl Fn(&stickslip::answer::record::PairState) -> f64) -> f64 {
    answer.pairs.iter().filter(|pair| pair.id.starts_with(prefix)).map(read).sum()
}

#[test]
fn corner_of_two_blocks() {
    let case = corner(0.2);
    let answer = case.solve(&[]);
    is_answer(&answer);
    for bed in ["bed_a", "bed_b"] {
        near(bed, sum(&answer, bed, |pair| pair.x_n), 1.0, 1e-11, 1.0);
    }
    // ν = 0: every column stands alone, the head joint carries nothing and what an edge node bears is its share.
    for (pair, share) in answer.pairs.iter().zip([0.25, 0.5, 0.25, 0.25, 0.5, 0.25, 0.0, 0.0, 0.0]) {
        near(&pair.id, pair.x_n, share, 1e-11, 1.0);
    }
    // Pushed, both slide where H = f · 2 W.
    let answer = case.solve(&[("H", 0.4 * (1.0 - 1e-6))]);
    is_answer(&answer);
    near("beds", sum(&answer, "bed", |pair| pair.x_n), 2.0, 1e-11, 1.0);
    near("friction", sum(&answer, "bed", |pair| pair.x_t), -0.4 * (1.0 - 1e-6), 1e-11, 1.0);
    let answer = case.solve(&[("H", 0.4 * (1.0 + 1e-6))]);
    let ray = mechanism(&answer);
    for pair in ray.direction.pairs().iter().filter(|pair| pair.pair.starts_with("bed")) {
        near("z̄_τ", pair.z_t.scalar(), 1.0, 1e-6, 1.0);
    }
}

/// A cross: four blocks on fixed feet meet in one point; eight joints on six relative displacements.
#[test]
fn cross_of_four_blocks() {
    let block = |id: &str, x: f64, y: f64| {
        json!({ "id": id, "origin": [x, y], "size": [1, 1], "divisions": [1, 1],
                "thickness": 1, "material": "m", "plane": "stress" })
    };
    let joint =
        |id: &str, edge: &str, against: &str| json!({ "id": id, "edge": edge, "against": against, "friction": 0.5 });
    let case = Case::json(json!({
        "materials": { "m": { "E": 1e4, "nu": 0.0 } },
        "plates": [block("c", 0.0, 0.0), block("d", 1.0, 0.0), block("a", 0.0, 1.0), block("b", 1.0, 1.0)],
        "supports": [{ "at": "c.bottom", "fixed": ["x", "y"] }, { "at": "d.bottom", "fixed": ["x", "y"] }],
        "contacts": [joint("ac", "a.bottom", "c.top"), joint("bd", "b.bottom", "d.top"),
                     joint("ab", "b.left", "a.right"),
                     { "id": "cd", "edge": "d.left", "against": "c.right", "friction": 0.5, "skip": [0] }],
        "loads": { "w": { "items": [{ "traction": { "edge": "a.top", "value": [0, -2] } },
                                    { "traction": { "edge": "b.top", "value": [0, -1] } }] } }
    }));
    let answer = case.solve(&[]);
    is_answer(&answer);
    near("ac", sum(&answer, "ac", |pair| pair.x_n) - sum(&answer, "ab", |pair| pair.x_t), 2.0, 1e-11, 1.0);
    near("bd", sum(&answer, "bd", |pair| pair.x_n) + sum(&answer, "ab", |pair| pair.x_t), 1.0, 1e-11, 1.0);
    near("laws", violation(&case.scenario, &case.scenario.parameter_values(), &answer), 0.0, 1e-11, 1.0);
}

/// A frame of a few nodes, some with several pairs against the ground and against each other.
fn random(seed: u64, friction: f64, soft: Option<f64>) -> Value {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut number = |low: f64, high: f64| rng.random_range(low..high);
    let mut nodes = serde_json::Map::new();
    for (i, (x, y)) in [(0.0, 0.0), (1.0, 0.2), (2.0, 0.1), (1.0, 0.2), (0.2, 1.0)].into_iter().enumerate() {
        nodes.insert(format!("n{i}"), json!([x, y]));
    }
    let bar = |a: usize, b: usize| json!({ "id": format!("b{a}{b}"), "nodes": [format!("n{a}"), format!("n{b}")], "material": "m", "section": "s" });
    let mut contacts = Vec::new();
    let (mut springs, mut extra) = (Vec::new(), 0);
    let mut pair = |node: usize, against: Option<usize>, angle: f64, gap: f64| {
        let mut other = against.map_or("ground".to_owned(), |against| format!("n{against}"));
        if let Some(stiffness) = soft {
            // A spring in series: a node of its own between the two sides.
            let own = format!("s{extra}");
            extra += 1;
            nodes.insert(own.clone(), nodes[&format!("n{node}")].clone());
            for direction in [[1, 0], [0, 1]] {
                springs.push(match against {
                    None => json!({ "at": own, "direction": direction, "stiffness": stiffness }),
                    Some(_) => json!({ "between": [own, other], "direction": direction, "stiffness": stiffness }),
                });
            }
            other = own;
        }
        contacts.push(json!({ "id": format!("c{}", contacts.len()), "node": format!("n{node}"), "against": other,
                              "normal": [angle.cos(), angle.sin()], "friction": friction, "gap": gap }));
    };
    let angle = number(0.0, 6.3);
    // A guide, three pairs round a node, and a node that meets another one which meets the same ground.
    pair(2, None, angle, number(0.0, 0.02));
    pair(2, None, angle + std::f64::consts::PI, number(0.0, 0.02));
    for k in 0..3 {
        pair(4, None, 2.1 * k as f64 + number(-0.2, 0.2), number(0.0, 0.02));
    }
    let up = number(0.5, 2.5);
    pair(1, Some(3), up, 0.0);
    pair(1, None, up, number(0.0, 0.01));
    pair(3, None, up, 0.0);
    let load = |node: usize, number: &mut dyn FnMut(f64, f64) -> f64| json!({ "point": { "at": format!("n{node}"), "force": [number(-1.0, 1.0), number(-1.0, 1.0)] } });
    let items: Vec<Value> = (1..5).map(|node| load(node, &mut number)).collect();
    json!({
        "materials": { "m": { "E": 100.0, "nu": 0.2 } },
        "sections": { "s": { "area": 1.0, "inertia": 0.1 } },
        "nodes": nodes,
        "bars": [bar(0, 1), bar(1, 2), bar(0, 3), bar(0, 4)],
        "supports": [{ "at": "n0", "fixed": ["x", "y", "r"] }],
        "contacts": contacts, "springs": springs,
        "loads": { "w": { "items": items } }
    })
}

/// Answers balance, fit their displacements and obey the laws, each judged from what is reported; without friction, where
/// the displacements are unique, stiff springs between the sides come as near to them as they are stiff.
#[test]
fn random_frames_with_repeated_joints() {
    let mut answers = 0;
    for seed in 0..60 {
        let friction = [0.0, 0.2, 0.5][(seed % 3) as usize];
        let case = Case::json(random(seed, friction, None));
        let values = case.scenario.parameter_values();
        let answer = case.solve(&[]);
        if answer.outcome == OutcomeKind::Ray {
            assert!(friction > 0.0, "seed {seed}: {:?}", answer.ray);
            continue;
        }
        is_answer(&answer);
        answers += 1;
        assert!(violation(&case.scenario, &values, &answer) < 1e-10, "seed {seed}");
        assert!(imbalance(&case.scenario, &values, &answer) < 1e-10, "seed {seed}");
        assert!(nodal_imbalance(&case.scenario, &values, &answer) < 1e-9, "seed {seed}");
        assert!(incompatibility(&case.scenario, &values, &answer) < 1e-10, "seed {seed}");
        if friction > 0.0 {
            continue;
        }
        let largest = answer.pairs.iter().fold(0.0, |a: f64, pair| a.max(pair.z_n.abs()));
        let off = |stiffness: f64| {
            let sprung = Case::json(random(seed, friction, Some(stiffness))).solve(&[]);
            is_answer(&sprung);
            let z = answer.pairs.iter().zip(&sprung.pairs).map(|(a, b)| (a.z_n - b.z_n).abs());
            z.fold(0.0, f64::max) / largest
        };
        let (soft, stiff) = (off(1e6), off(1e8));
        assert!(soft < 1e-3 && stiff < 1e-5, "seed {seed}: {soft} {stiff}");
    }
    assert!(answers >= 55, "{answers} answers");
}

/// A rigid sledge on two runners, pushed along the ground: one tangential joint repeats the other. What the run ends
/// with is reported as what it is: p as much more pressing force and cohesion in both pairs would hold it where
/// f (W + 2 p) + 2 p = H, and that is another p.
#[test]
fn the_p_of_a_ray_is_not_called_the_missing_force() {
    let (w, h, f) = (10.0, 5.05, 0.5);
    let runner =
        |id: &str, node: &str| json!({ "id": id, "node": node, "against": "ground", "normal": [0, 1], "friction": f });
    let case = Case::json(json!({
        "nodes": { "left": [0, 0], "right": [2, 0], "middle": [1, 0] },
        "rigid": [{ "id": "sledge", "nodes": ["left", "right", "middle"] }],
        "contacts": [runner("a", "left"), runner("b", "right")],
        "loads": { "all": { "items": [{ "point": { "at": "middle", "force": [h, -w] } }] } }
    }));
    for covering in [Covering::Cohesive, Covering::Ones, Covering::Weight] {
        let answer = case.solved(&[], Rules { covering, ..case.scenario.rules }).answer;
        let ray = mechanism(&answer);
        let missing = (h - f * w) / (2.0 * (f + 1.0));
        assert!(covering != Covering::Cohesive || (ray.p - missing).abs() > 0.1 * missing, "{ray:?}");
        let text = &ray.explanation;
        assert!(!text.contains("hold it") && !text.contains("extra"), "{text}");
        assert!(text.contains("not the force that is missing"), "{text}");
    }
}

/// The blocks of the corner pushed further and further: on the way every point is an answer, the end is H = f · 2 W.
#[test]
fn limit_of_the_corner() {
    let case = corner(0.2);
    let values = case.scenario.parameter_values();
    let solved = case.solved(&[], case.scenario.rules);
    let found = limit(case.prepared.case(&case.scenario, &values), Some(&solved), "push").expect("a path");
    close("limit", found.factor.expect("a limit"), 0.4, 1e-10);
    assert!(found.confirmed);
}

/// A running-bond wall of bricks 2 × 1, nodes a unit apart, every contact at every node where two bricks touch: where a head
/// joint stands on a brick, or hangs under one, six joints meet on four relative displacements. Weight W = 1 a unit of
/// area and its part `a` as a horizontal force, at the nodes.
fn wall(courses: usize, width: usize) -> Case {
    let (mut plates, mut contacts, mut weight, mut quake) = (vec![], vec![], vec![], vec![]);
    let mut bricks: Vec<Vec<(usize, usize)>> = Vec::new();
    for course in 0..courses {
        let mut row: Vec<(usize, usize)> = Vec::new();
        let mut x = 0;
        while x < width {
            let length = if course % 2 == 1 && (x == 0 || x + 1 == width) { 1 } else { 2 };
            let id = format!("k{course}_{}", row.len());
            plates.push(json!({ "id": id, "origin": [x, course], "size": [length, 1], "divisions": [length, 1],
                                "thickness": 1, "material": "m", "plane": "stress" }));
            for i in 0..=length {
                let share = if i == 0 || i == length { 0.25 } else { 0.5 };
                for j in 0..2 {
                    let at = format!("{id}[{i},{j}]");
                    weight.push(json!({ "point": { "at": at, "force": [0, -share] } }));
                    quake.push(json!({ "point": { "at": at, "force": [share, 0] } }));
                }
                if course == 0 {
                    let node = format!("{id}[{i},0]");
                    contacts.push(json!({ "id": format!("g{}", contacts.len()), "node": node, "against": "ground",
                                          "normal": [0, 1], "friction": "f" }));
                }
            }
            row.push((x, length));
            x += length;
        }
        for (left, pair) in row.windows(2).enumerate() {
            for j in 0..2 {
                contacts.push(
                    json!({ "id": format!("h{}", contacts.len()), "node": format!("k{course}_{}[0,{j}]", left + 1),
                    "against": format!("k{course}_{left}[{},{j}]", pair[0].1), "normal": [1, 0], "friction": "f" }),
                );
            }
        }
        for (below, (x, length)) in bricks.last().into_iter().flatten().enumerate() {
            for (above, (other, size)) in row.iter().enumerate() {
                let ends = (*x.max(other), (x + length).min(other + size));
                for at in ends.0..=if ends.0 < ends.1 { ends.1 } else { continue } {
                    contacts.push(json!({ "id": format!("b{}", contacts.len()),
                        "node": format!("k{course}_{above}[{},0]", at - other),
                        "against": format!("k{}_{below}[{},1]", course - 1, at - x), "normal": [0, 1], "friction": "f" }));
                }
            }
        }
        bricks.push(row);
    }
    Case::json(json!({
        "parameters": { "a": 0, "f": 0.6 },
        "materials": { "m": { "E": 1e5, "nu": 0.2 } },
        "plates": plates, "contacts": contacts,
        "loads": { "weight": { "items": weight }, "quake": { "factor": "a", "items": quake } }
    }))
}

/// Answers balance every brick and obey the laws; collapses are mechanisms; with more friction the wall stands more.
#[test]
fn running_bond_walls() {
    let case = wall(3, 6);
    for f in [0.2, 0.4, 0.7, 1.0] {
        let mut stood = true;
        for step in 0..7 {
            let set = [("a", 0.1 * step as f64), ("f", f)];
            let mut values = case.scenario.parameter_values();
            for (name, value) in set {
                values.insert(name.to_owned(), value).expect("a parameter");
            }
            let answer = case.solve(&set);
            let what = format!("a = {}, f = {f}", set[0].1);
            if answer.outcome == OutcomeKind::Ray {
                mechanism(&answer);
                stood = false;
                continue;
            }
            is_answer(&answer);
            assert!(stood, "{what}: a smaller push made it fall");
            assert!(violation(&case.scenario, &values, &answer) < 1e-10, "{what}");
            assert!(imbalance(&case.scenario, &values, &answer) < 1e-10, "{what}");
            assert!(incompatibility(&case.scenario, &values, &answer) < 1e-10, "{what}");
        }
        // On the ground it slides at a = f.
        assert_eq!(stood, f > 0.6, "f = {f}");
    }
}

/// The LCP as exported: w = M z + q at the answer, with forces and displacements in the places that the names of the rows say.
#[test]
fn the_written_lcp_holds_at_the_answer() {
    for (case, set) in [(guide(0.3), [("P", 1.0), ("T", 0.5)]), (corner(0.2), [("W", 1.0), ("H", 0.3)])] {
        let answer = case.solve(&set);
        is_answer(&answer);
        let mut values = case.scenario.parameter_values();
        for (name, value) in set {
            values.insert(name.to_owned(), value).expect("a parameter");
        }
        let (lcp, names) = case.prepared.written_lcp(&values, Rules::default());
        let mut exchanged = 0;
        let (w, z): (Vec<f64>, Vec<f64>) = names
            .iter()
            .map(|name| {
                let pair = answer
                    .pairs
                    .iter()
                    .find(|pair| name[name.find('[').unwrap() + 1..name.len() - 1] == pair.id)
                    .expect("a pair");
                let (force, displacement) = match &name[1..3] {
                    "_n" => (pair.x_n, pair.z_n),
                    "+[" => (pair.reserve_plus, pair.z_t.max(0.0)),
                    _ => (pair.reserve_minus, (-pair.z_t).max(0.0)),
                };
                if name.starts_with('x') {
                    (force, displacement)
                } else {
                    exchanged += 1;
                    (displacement, force)
                }
            })
            .unzip();
        assert!(exchanged > 0, "{names:?}");
        for (i, row) in lcp.matrix.iter().enumerate() {
            let terms: f64 = row.iter().zip(&z).map(|(m, z)| (m * z).abs()).sum();
            let found: f64 = row.iter().zip(&z).map(|(m, z)| m * z).sum::<f64>() + lcp.q[i];
            near(&names[i], found, w[i], 1e-11, terms + lcp.q[i].abs() + w[i].abs());
        }
    }
}

/// A node pressed onto one face of a gap whose faces are all but parallel, and pushed along it by much less: both faces stick, the
/// displacements are zero, and what it is pushed by is carried along the faces, whatever they share. A check that took the push
/// for the measure of its own row would take the rounding of what presses for an error.
#[test]
fn a_small_push_between_faces_that_press() {
    for turn in [1e-2, 1e-3, 1e-5, 1e-8_f64] {
        for push in [-1e-3, 1e-6, -1e-9, 1e-9, -1e-12] {
            let case = Case::json(json!({
                "nodes": { "a": [0, 0] },
                "springs": [
                    { "at": "a", "direction": [1, 0], "stiffness": 10 }, { "at": "a", "direction": [0, 1], "stiffness": 10 }
                ],
                "contacts": [
                    { "id": "below", "node": "a", "against": "ground", "normal": [0, 1], "friction": 0.3 },
                    { "id": "above", "node": "a", "against": "ground", "normal": [-turn.sin(), -turn.cos()], "friction": 0.3 }
                ],
                "loads": { "all": { "items": [{ "point": { "at": "a", "force": [push, -1.0] } }] } }
            }));
            let answer = case.solve(&[]);
            assert!(answer.is_answer() && answer.check.passed, "{turn} {push}: {:?}", answer.failure);
            // t is n turned by −90°: (1, 0) below, (−cos, sin) above.
            let [below, above] = &answer.pairs[..] else { panic!("two pairs") };
            let along = below.x_t - above.x_n * turn.sin() - above.x_t * turn.cos();
            let across = below.x_n - above.x_n * turn.cos() + above.x_t * turn.sin();
            assert!((along + push).abs() <= 1e-15 && (across - 1.0).abs() <= 1e-14, "{turn} {push}: {along} {across}");
        }
    }
}
