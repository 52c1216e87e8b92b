//! Contact of edges that do not match with sides of any kind: three and six, four and eight nodes, straight and curved;
//! edges that overlap in part; the weights against integrals over the common refinement.

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use serde_json::{Value, json};
use stickslip::answer::record::Answer;
use stickslip::model::scenario::Source;

use super::write::Drawn;
use crate::common::{Case, balance, close, displacement, is_answer, mechanism, near, of_pairs};

const E: f64 = 1000.0;
const NU: f64 = 0.3;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Triangle3,
    Quad4,
    Triangle6,
    Quad8,
}

impl Kind {
    fn is_quadratic(self) -> bool {
        matches!(self, Kind::Triangle6 | Kind::Quad8)
    }
}

/// A body between two lines y(x), two elements high, on columns of elements.
struct Body<'a> {
    kind: Kind,
    columns: &'a [f64],
    bottom: &'a dyn Fn(f64) -> f64,
    top: &'a dyn Fn(f64) -> f64,
}

/// Two bodies as groups `u` and `l`, their edges as `u-bottom`, `u-top`, `l-bottom`, `l-top`; all turned by an angle.
fn drawn(upper: &Body<'_>, lower: &Body<'_>, turn: f64) -> Drawn {
    let (sine, cosine) = turn.sin_cos();
    let mut drawn = Drawn { nodes: Vec::new(), edges: Vec::new(), areas: Vec::new() };
    for (body, names) in [(upper, ["u", "u-bottom", "u-top"]), (lower, ["l", "l-bottom", "l-top"])] {
        let first = drawn.nodes.len();
        let half = 2 * (body.columns.len() - 1);
        // A grid of half the elements' size; what no element has stays unused.
        for i in 0..=half {
            let x = 0.5 * (body.columns[i / 2] + body.columns[i.div_ceil(2)]);
            let (low, high) = ((body.bottom)(x), (body.top)(x));
            drawn.nodes.extend((0..5).map(|j| {
                let y = low + (high - low) * f64::from(j) / 4.0;
                [cosine * x - sine * y, sine * x + cosine * y]
            }));
        }
        let at = |i: usize, j: usize| first + 5 * i + j;
        let mut areas = Vec::new();
        for (i, j) in (0..half).step_by(2).flat_map(|i| [0, 2].map(|j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 2, j), at(i + 2, j + 2), at(i, j + 2)];
            let [ab, bc, cd, da] = [at(i + 1, j), at(i + 2, j + 1), at(i + 1, j + 2), at(i, j + 1)];
            let ac = at(i + 1, j + 1);
            match body.kind {
                Kind::Quad4 => areas.push(vec![a, b, c, d]),
                Kind::Quad8 => areas.push(vec![a, b, c, d, ab, bc, cd, da]),
                Kind::Triangle3 => areas.extend([vec![a, b, c], vec![a, c, d]]),
                Kind::Triangle6 => areas.extend([vec![a, b, c, ab, bc, ac], vec![a, c, d, ac, cd, da]]),
            }
        }
        drawn.areas.push((names[0], areas));
        for (name, j) in [(names[1], 0), (names[2], 4)] {
            let line = |i: usize| match body.kind.is_quadratic() {
                true => vec![at(i, j), at(i + 2, j), at(i + 1, j)],
                false => vec![at(i, j), at(i + 2, j)],
            };
            drawn.edges.push((name, (0..half).step_by(2).map(line).collect()));
        }
    }
    drawn
}

fn case(folder: &Path, drawn: &Drawn, mut rest: Value) -> Case {
    std::fs::write(folder.join("m.msh"), drawn.msh2()).expect("a file");
    let of = json!({"material": "m", "thickness": 1, "plane": "stress"});
    rest["materials"] = json!({"m": {"E": E, "nu": NU}});
    rest["meshes"] = json!([{"id": "m", "file": "m.msh", "materials": {"u": of, "l": of}}]);
    super::case(folder, rest)
}

fn even(divisions: usize, length: f64) -> Vec<f64> {
    (0..=divisions).map(|i| length * i as f64 / divisions as f64).collect()
}

/// ∫ N ds at the nodes of an edge along x: halves of the sides, or their 1 : 4 : 1.
fn shares(columns: &[f64], is_quadratic: bool) -> Vec<f64> {
    let mut shares = vec![0.0; if is_quadratic { 2 * columns.len() - 1 } else { columns.len() }];
    for (k, ends) in columns.windows(2).enumerate() {
        let length = ends[1] - ends[0];
        if is_quadratic {
            [1.0, 4.0, 1.0].into_iter().enumerate().for_each(|(i, part)| shares[2 * k + i] += length * part / 6.0);
        } else {
            shares[k] += 0.5 * length;
            shares[k + 1] += 0.5 * length;
        }
    }
    shares
}

/// Two bodies pressed together with p, free at their sides: σ = −p across, u = (ν p x / E, −p (y + 1) / E) in the unturned
/// axes, in both bodies. Returns the largest error of a displacement as a share of p · width / E.
fn pressed(upper: &Body<'_>, lower: &Body<'_>, mortar_is_upper: bool, turn: f64) -> (f64, Answer) {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = drawn(upper, lower, turn);
    let p = 2.0;
    let (sine, cosine) = turn.sin_cos();
    let (edge, against) = if mortar_is_upper { ("m.u-bottom", "m.l-top") } else { ("m.l-top", "m.u-bottom") };
    let corner = drawn.areas[1].1[0][0] + 1;
    let case = case(
        folder.path(),
        &drawn,
        json!({
            "contacts": [{"id": "joint", "edge": edge, "against": against, "friction": 1, "method": "mortar"},
                         {"id": "base", "edge": "m.l-bottom", "against": "ground", "law": "bound", "bound": 0}],
            "springs": [{"at": format!("m/{corner}"), "direction": [cosine, sine], "stiffness": 1000}],
            "loads": {"press": {"items": [{"traction": {"edge": "m.u-top", "value": [p * sine, -p * cosine]}}]}}
        }),
    );
    let answer = case.solve(&[]);
    is_answer(&answer);
    let values = case.scenario.parameter_values();
    assert!(balance::imbalance(&case.scenario, &values, &answer) < 1e-10);
    assert!(balance::incompatibility(&case.scenario, &values, &answer) < 1e-10);
    let mut worst = 0.0_f64;
    for (k, &[x, y]) in drawn.nodes.iter().enumerate() {
        if !drawn.areas.iter().flat_map(|(_, all)| all).any(|nodes| nodes.contains(&k)) {
            continue;
        }
        let (along, across) = (cosine * x + sine * y, cosine * y - sine * x);
        let [ux, uy, _] = displacement(&answer, &format!("m/{}", k + 1));
        worst = worst.max((cosine * ux + sine * uy - NU * p * along / E).abs());
        worst = worst.max((cosine * uy - sine * ux + p * (across + 1.0) / E).abs());
    }
    (worst / (p / E * upper.columns.last().expect("columns")), answer)
}

/// A uniform stress passes through straight, inclined and bent joints between sides of every kind to 1e-10, whichever side
/// has the pairs; on a straight one the nodal forces are p ∫ N ds.
#[test]
fn the_patch_test_passes_between_sides_of_every_kind() {
    let (up, down, flat) = (|_: f64| 1.0, |_: f64| -1.0, |_: f64| 0.0);
    let slanted = |x: f64| 0.3 * x;
    let bent = |x: f64| if x < 1.0 { 0.2 * x } else { 0.4 - 0.2 * x };
    use Kind::{Quad4, Quad8, Triangle3, Triangle6};
    let uneven = [0.0, 0.1, 0.7, 1.1, 2.0];
    /// Name, kinds of the sides, their nodes, the shape of the joint and its turn.
    type Pairing<'a> = (&'a str, [Kind; 2], [Vec<f64>; 2], &'a dyn Fn(f64) -> f64, f64);
    let cases: [Pairing<'_>; 10] = [
        ("6 against 5 corners", [Quad8, Quad8], [even(5, 2.0), even(4, 2.0)], &flat, 0.0),
        ("3 to 2", [Triangle6, Quad8], [even(3, 2.0), even(2, 2.0)], &flat, 0.0),
        ("quadratic on linear", [Quad8, Quad4], [even(5, 2.0), even(4, 2.0)], &flat, 0.0),
        ("linear on quadratic", [Triangle3, Triangle6], [uneven.to_vec(), even(6, 2.0)], &flat, 0.0),
        ("7 to 1", [Triangle6, Quad4], [even(1, 2.0), even(7, 2.0)], &flat, 0.0),
        ("uneven", [Quad8, Triangle6], [uneven.to_vec(), even(3, 2.0)], &flat, 0.0),
        ("turned", [Quad8, Triangle6], [even(5, 2.0), even(4, 2.0)], &flat, 0.7),
        ("inclined", [Triangle6, Quad8], [even(5, 2.0), even(4, 2.0)], &slanted, 0.0),
        ("bent", [Quad8, Quad8], [even(6, 2.0), even(4, 2.0)], &bent, 0.0),
        ("bent and turned", [Triangle6, Quad8], [even(4, 2.0), even(6, 2.0)], &bent, -0.4),
    ];
    for (what, kinds, columns, line, turn) in cases {
        let upper = Body { kind: kinds[0], columns: &columns[0], bottom: line, top: &up };
        let lower = Body { kind: kinds[1], columns: &columns[1], bottom: &down, top: line };
        for mortar_is_upper in [true, false] {
            let (error, answer) = pressed(&upper, &lower, mortar_is_upper, turn);
            assert!(error < 1e-10, "{what}, mortar is upper: {mortar_is_upper}: {error:e}");
            if line(1.0) == 0.0 {
                let of = if mortar_is_upper { &upper } else { &lower };
                let expected = shares(of.columns, of.kind.is_quadratic());
                let joint = answer.pairs.iter().filter(|pair| pair.id.starts_with("joint"));
                assert_eq!(joint.clone().count(), expected.len(), "{what}");
                for (pair, share) in joint.zip(expected) {
                    close(&format!("{what}: {}", pair.id), pair.x_n, 2.0 * share, 1e-10);
                    near(&format!("{what}: {}", pair.id), pair.x_t, 0.0, 1e-10, 2.0);
                }
            }
        }
    }
}

/// Along a parabola, which quadratic sides follow exactly, the traction of a uniform stress turns with the normal: its
/// density along the side is not a polynomial over the length, so it passes up to the order of the sides, not exactly.
#[test]
fn the_patch_test_converges_between_curved_sides() {
    let (up, down) = (|_: f64| 1.2, |_: f64| -1.0);
    let curved = |x: f64| 0.25 * x * (2.0 - x);
    for kinds in [[Kind::Quad8, Kind::Quad8], [Kind::Triangle6, Kind::Quad8]] {
        let mut errors = Vec::new();
        for n in [1, 2, 4] {
            let [above, below] = [even(3 * n, 2.0), even(2 * n, 2.0)];
            let upper = Body { kind: kinds[0], columns: &above, bottom: &curved, top: &up };
            let lower = Body { kind: kinds[1], columns: &below, bottom: &down, top: &curved };
            errors.push([true, false].map(|side| pressed(&upper, &lower, side, 0.0).0));
        }
        println!("{kinds:?}: {errors:?}");
        for side in [0, 1] {
            for k in [0, 1] {
                assert!(errors[k + 1][side] < errors[k][side] / 16.0, "{kinds:?}: {errors:?}");
            }
            assert!(errors[2][side] < 1e-6, "{kinds:?}: {errors:?}");
        }
    }
}

/// A block on quadratic sides slides at Σ f x_n = f W to 1e-9, the edges of one length or of different ones.
#[test]
fn the_friction_limit_is_exact_on_quadratic_sides() {
    let (up, down, flat) = (|_: f64| 1.0, |_: f64| -1.0, |_: f64| 0.0);
    let shifted: Vec<f64> = even(3, 2.0).iter().map(|x| x + 1.3).collect();
    for (above, below) in [(even(5, 2.0), even(4, 2.0)), (shifted, even(7, 5.0))] {
        let folder = tempfile::tempdir().expect("a folder");
        let upper = Body { kind: Kind::Quad8, columns: &above, bottom: &flat, top: &up };
        let lower = Body { kind: Kind::Triangle6, columns: &below, bottom: &down, top: &flat };
        let case = case(
            folder.path(),
            &drawn(&upper, &lower, 0.0),
            json!({
                "parameters": {"H": 0},
                "supports": [{"at": "m.l-bottom", "fixed": ["x", "y"]}],
                "contacts": [{"id": "joint", "edge": "m.u-bottom", "against": "m.l-top", "friction": 0.3}],
                "loads": {"weight": {"items": [{"traction": {"edge": "m.u-top", "value": [0, -3.5]}}]},
                          "push": {"factor": "H", "items": [{"point": {"at": "m.u-bottom", "force": [1, 0]}}]}}
            }),
        );
        let limit = 0.3 * 7.0;
        let held = case.solve(&[("H", limit * (1.0 - 1e-9))]);
        is_answer(&held);
        close("Σ x_n", of_pairs(&held, |pair| pair.x_n).iter().sum(), 7.0, 1e-12);
        mechanism(&case.solve(&[("H", limit * (1.0 + 1e-9))]));
    }
}

/// One side of an edge along x: its ends, and its nodes as indices into the edge.
struct Side {
    ends: [f64; 2],
    nodes: Vec<usize>,
}

fn sides(columns: &[f64], is_quadratic: bool) -> Vec<Side> {
    let of = |(k, ends): (usize, &[f64])| Side {
        ends: [ends[0], ends[1]],
        nodes: if is_quadratic { (2 * k..2 * k + 3).collect() } else { (k..k + 2).collect() },
    };
    columns.windows(2).enumerate().map(of).collect()
}

/// Lagrange polynomial i through `places` at t.
fn lagrange(places: &[f64], i: usize, t: f64) -> f64 {
    let others = (0..places.len()).filter(|k| *k != i);
    others.map(|k| (t - places[k]) / (places[i] - places[k])).product()
}

fn places(count: usize) -> Vec<f64> {
    (0..count).map(|k| k as f64 / (count - 1) as f64).collect()
}

/// Boole's rule, exact for polynomials of degree 5.
fn integral(a: f64, b: f64, of: &dyn Fn(f64) -> f64) -> f64 {
    let weights = [7.0, 32.0, 12.0, 32.0, 7.0];
    let sum: f64 = (0..5).map(|k| weights[k] * of(a + (b - a) * k as f64 / 4.0)).sum();
    sum * (b - a) / 90.0
}

/// The weights of every node of `own`, first those of `own`, then those of `other`, by integrals over the pieces between
/// all corners of both; `None` at nodes beyond `other`, but for the next one.
fn by_common_refinement(own: &[Side], other: &[Side], counts: [usize; 2]) -> Vec<Option<[Vec<f64>; 2]>> {
    let reach = [other[0].ends[0], other[other.len() - 1].ends[1]];
    let mut rows = vec![[vec![0.0; counts[0]], vec![0.0; counts[1]]]; counts[0]];
    let mut faces = vec![false; counts[0]];
    for side in own {
        let [a, b] = side.ends;
        let t = |x: f64| (x - a) / (b - a);
        let all = places(side.nodes.len());
        let (from, to) = (a.max(reach[0]), b.min(reach[1]));
        if from >= to {
            continue;
        }
        let near = 1e-9;
        let mut facing: Vec<(usize, f64)> = (0..all.len())
            .filter(|&k| (t(from) - near..=t(to) + near).contains(&all[k]))
            .map(|k| (side.nodes[k], all[k]))
            .collect();
        // An end of the other edge inside the side has the number of the node beyond.
        let before = (0..all.len()).rfind(|&k| all[k] < t(from) - near);
        let after = (0..all.len()).find(|&k| all[k] > t(to) + near);
        facing.extend(before.map(|k| (side.nodes[k], t(from))));
        facing.extend(after.map(|k| (side.nodes[k], t(to))));
        facing.sort_by(|a, b| a.1.total_cmp(&b.1));
        let over = |of: &dyn Fn(f64) -> f64| integral(from, to, &|x| of(t(x)));
        // No function whose integral is not positive: a uniform pressure would pull there.
        let through: Vec<f64> = facing.iter().map(|place| place.1).collect();
        if through.len() == 3 && (0..3).any(|i| over(&|t| lagrange(&through, i, t)) <= 1e-3 * (to - from)) {
            facing.remove(1);
        }
        let (numbers, through): (Vec<usize>, Vec<f64>) = facing.into_iter().unzip();
        let n = through.len();
        let mass = DMatrix::from_fn(n, n, |i, j| over(&|t| lagrange(&through, i, t) * lagrange(&through, j, t)));
        let sizes = DVector::from_fn(n, |i, _| over(&|t| lagrange(&through, i, t)));
        let inverse = mass.try_inverse().expect("independent functions");
        for i in 0..n {
            let node = numbers[i];
            faces[node] = true;
            let dual = |t: f64| (0..n).map(|j| sizes[i] * inverse[(i, j)] * lagrange(&through, j, t)).sum::<f64>();
            for (k, &own_node) in side.nodes.iter().enumerate() {
                rows[node][0][own_node] += over(&|t| dual(t) * lagrange(&all, k, t));
            }
            for piece in other {
                let [c, d] = [piece.ends[0].max(from), piece.ends[1].min(to)];
                if c >= d {
                    continue;
                }
                let there = places(piece.nodes.len());
                let s = |x: f64| (x - piece.ends[0]) / (piece.ends[1] - piece.ends[0]);
                for (l, &other_node) in piece.nodes.iter().enumerate() {
                    rows[node][1][other_node] += integral(c, d, &|x| dual(t(x)) * lagrange(&there, l, s(x)));
                }
            }
        }
    }
    let finished = rows.into_iter().zip(faces).map(|([own, other], faces)| {
        let size: f64 = own.iter().sum();
        faces.then(|| [own.iter().map(|w| w / size).collect(), other.iter().map(|w| -w / size).collect()])
    });
    finished.collect()
}

/// Random divisions, sides of two and three nodes, common lengths and overlaps in part: every weight to 1e-12.
#[test]
fn the_weights_are_those_of_the_common_refinement() {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(14);
    let (up, down, flat) = (|_: f64| 1.0, |_: f64| -1.0, |_: f64| 0.0);
    for trial in 0..60 {
        let mut columns = |from: f64, to: f64| -> Vec<f64> {
            let count = random.random_range(1..7);
            let mut sizes: Vec<f64> = (0..count).map(|_| random.random_range(0.3..1.0)).collect();
            let scale = (to - from) / sizes.iter().sum::<f64>();
            sizes.iter_mut().for_each(|size| *size *= scale);
            let mut at = from;
            let mut columns = vec![from];
            columns.extend(sizes.iter().map(|size| {
                at += size;
                at
            }));
            *columns.last_mut().expect("the end") = to;
            columns
        };
        let above = columns(0.0, 2.0);
        // Two thirds of the trials overlap in part, on one side or the other.
        let below = match trial % 3 {
            0 => columns(0.0, 2.0),
            1 => columns(-0.7, 1.43),
            _ => columns(0.31, 2.6),
        };
        let kinds = [[Kind::Quad4, Kind::Quad8][trial / 3 % 2], [Kind::Triangle6, Kind::Quad4][trial / 6 % 2]];
        let upper = Body { kind: kinds[0], columns: &above, bottom: &flat, top: &up };
        let lower = Body { kind: kinds[1], columns: &below, bottom: &down, top: &flat };
        let folder = tempfile::tempdir().expect("a folder");
        let case = case(
            folder.path(),
            &drawn(&upper, &lower, 0.0),
            json!({
                "supports": [{"at": "m.l-bottom", "fixed": ["x", "y"]}],
                // Where few nodes face the other edge the pairs alone do not hold the body.
                "springs": [{"at": "m.u-top", "direction": [1, 0], "stiffness": 1},
                            {"at": "m.u-top", "direction": [0, 1], "stiffness": 1}],
                "contacts": [{"id": "joint", "edge": "m.u-bottom", "against": "m.l-top", "method": "mortar"}],
                "loads": {"press": {"items": [{"traction": {"edge": "m.u-top", "value": [0, -1]}}]}}
            }),
        );
        let Source::Structure(structure) = &case.scenario.source else { panic!("a structure") };
        let quadratic = kinds.map(Kind::is_quadratic);
        let count = |columns: &[f64], is_quadratic: bool| shares(columns, is_quadratic).len();
        let counts = [count(&above, quadratic[0]), count(&below, quadratic[1])];
        let expected = by_common_refinement(&sides(&above, quadratic[0]), &sides(&below, quadratic[1]), counts);
        // The place of a node in its edge, by its x.
        let place = |x: f64, columns: &[f64], is_quadratic: bool| -> usize {
            let mut all: Vec<f64> = columns.to_vec();
            if is_quadratic {
                all.extend(columns.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])));
                all.sort_by(f64::total_cmp);
            }
            all.iter().position(|known| (known - x).abs() < 1e-9).expect("a node of the edge")
        };
        let here = expected.iter().flatten().count();
        assert_eq!(structure.pairs.len(), here, "trial {trial}: {above:?} on {below:?}");
        for pair in &structure.pairs {
            let x = structure.nodes[pair.node].position[0];
            let row = expected[place(x, &above, quadratic[0])].as_ref().expect("a pair faces the other edge");
            let mut found = [vec![0.0; counts[0]], vec![0.0; counts[1]]];
            for &(node, weight) in &pair.weights {
                let [x, ..] = structure.nodes[node].position;
                // Tags of the upper body come first: five for each half column.
                let tag: usize = structure.nodes[node].id[2..].parse().expect("a tag");
                let is_own = tag <= 5 * (2 * above.len() - 1);
                match is_own {
                    true => found[0][place(x, &above, quadratic[0])] += weight,
                    false => found[1][place(x, &below, quadratic[1])] += weight,
                }
            }
            for (found, expected) in found.iter().flatten().zip(row.iter().flatten()) {
                assert!((found - expected).abs() < 1e-12, "trial {trial}, {}: {found} {expected}", pair.id);
            }
        }
    }
}
