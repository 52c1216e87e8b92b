//! Meshes of other programs through the whole program: the same numbers as from plates, constant stress in distorted
//! elements, edges of every kind, and files that are damaged.

mod damaged;
mod faulty;
mod mortar_sides;
mod program;
mod write;

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::Case;
use write::Drawn;

/// A scenario beside its meshes.
fn case(folder: &Path, value: Value) -> Case {
    Case::in_folder(value, folder)
}

/// The three files of a mesh, in a folder.
fn files(folder: &Path, drawn: &Drawn) -> [&'static str; 3] {
    let texts = [("m2.msh", drawn.msh2()), ("m4.msh", drawn.msh4()), ("m.inp", drawn.inp())];
    texts.map(|(name, text)| {
        fs::write(folder.join(name), text).expect("a file");
        name
    })
}

/// A block of `n` × `n` squares on [0, 2]², its edges in no order.
fn block(n: usize) -> Drawn {
    let node = |i: usize, j: usize| j * (n + 1) + i;
    let size = 2.0 / n as f64;
    let mut nodes = Vec::new();
    let mut areas = Vec::new();
    for j in 0..=n {
        nodes.extend((0..=n).map(|i| [size * i as f64, size * j as f64]));
    }
    for j in 0..n {
        areas.extend((0..n).map(|i| vec![node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]));
    }
    let mut foot: Vec<Vec<usize>> = (0..n).map(|i| vec![node(i, 0), node(i + 1, 0)]).collect();
    foot.reverse();
    foot[0].reverse();
    let side = (0..n).map(|j| vec![node(0, j + 1), node(0, j)]).collect();
    Drawn { nodes, edges: vec![("foot", foot), ("side", side)], areas: vec![("the body", areas)] }
}

/// The block stands on the ground and is pushed; from a plate and from a mesh of each format the same numbers come.
#[test]
fn a_block_from_a_mesh_is_the_block_from_a_plate() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = |key: &str, parts: Value, foot: &str, side: &str, body: &str| {
        json!({
            "parameters": { "f": 0.4, "H": 1.1, "s": 1.5, "t": 0.7 },
            "materials": { "c": { "E": 1000, "nu": 0.2, "density": 1, "expansion": 1e-5 } },
            key: parts,
            "contacts": [{ "id": "j", "edge": foot, "against": "ground", "friction": "f" }],
            "loads": {
                "w": { "items": [{ "gravity": { "acceleration": [0, -1], "on": [body] } }] },
                "warm": { "items": [{ "temperature": { "change": 10, "on": [body] } }] },
                "h": { "factor": "H", "items": [{ "point": { "at": side, "force": [1, 0] } }] } }
        })
    };
    let plate = json!([{ "id": "m", "origin": [0, 0], "size": ["2*s", "2*s"], "divisions": [4, 4], "thickness": "t",
                         "material": "c", "plane": "strain" }]);
    let plate = case(folder.path(), scenario("plates", plate, "m.bottom", "m.left", "m"));
    for file in files(folder.path(), &block(4)) {
        let mesh = json!([{ "id": "m", "file": file, "scale": "s", "materials": {
            "the body": { "material": "c", "thickness": "t", "plane": "strain" } } }]);
        let mesh = case(folder.path(), scenario("meshes", mesh, "m.foot", "m.side", "m.the body"));
        for set in [vec![], vec![("f", 0.1)], vec![("H", 0.4)]] {
            let (expected, found) = (plate.solve(&set), mesh.solve(&set));
            assert_eq!(found.outcome, expected.outcome, "{file} {set:?}");
            assert_eq!(found.pairs.len(), 5);
            for (a, b) in expected.pairs.iter().zip(&found.pairs) {
                assert_eq!((&a.id, a.state, a.position), (&b.id, b.state, b.position), "{file}");
                for (a, b) in [(a.x_n, b.x_n), (a.x_t, b.x_t), (a.z_n, b.z_n), (a.z_t, b.z_t)] {
                    assert!((a - b).abs() <= 1e-12, "{file} {set:?}: {a} {b}");
                }
            }
        }
    }
}

/// A rectangle 3 × 2 of four quads of eight nodes round two triangles of six, no side straight inside, middles of the
/// outer sides off their middle.
fn patch() -> Drawn {
    let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.8, 0.7], [2.1, 0.5], [1.9, 1.5], [0.9, 1.3]];
    let mut drawn = Drawn { nodes: corners.to_vec(), edges: Vec::new(), areas: Vec::new() };
    let mut middles: Vec<([usize; 2], usize)> = Vec::new();
    let mut middle = |nodes: &mut Vec<[f64; 2]>, a: usize, b: usize| {
        let key = [a.min(b), a.max(b)];
        if let Some((_, node)) = middles.iter().find(|(known, _)| *known == key) {
            return *node;
        }
        let ([ax, ay], [bx, by]) = (nodes[key[0]], nodes[key[1]]);
        let bulge = if key[1] < 4 { 0.0 } else { 0.012 + 0.002 * key[0] as f64 };
        let t = 0.48;
        nodes.push([ax + t * (bx - ax) - bulge * (by - ay), ay + t * (by - ay) + bulge * (bx - ax)]);
        middles.push((key, nodes.len() - 1));
        nodes.len() - 1
    };
    let areas: [&[usize]; 6] = [&[0, 1, 5, 4], &[1, 2, 6, 5], &[3, 7, 6, 2], &[3, 0, 4, 7], &[4, 5, 6], &[6, 7, 4]];
    let mut of = |nodes: &mut Vec<[f64; 2]>, corners: &[usize]| {
        let n = corners.len();
        let sides = (0..n).map(|k| middle(nodes, corners[k], corners[(k + 1) % n])).collect::<Vec<_>>();
        corners.iter().copied().chain(sides).collect::<Vec<usize>>()
    };
    let areas = areas.map(|corners| of(&mut drawn.nodes, corners));
    let (quads, triangles) = areas.split_at(4);
    for (name, [a, b]) in [("bottom", [0, 1]), ("right", [1, 2]), ("top", [2, 3]), ("left", [3, 0])] {
        let m = middle(&mut drawn.nodes, a, b);
        drawn.edges.push((name, vec![vec![a, b, m]]));
    }
    drawn.areas = vec![("quads", quads.to_vec()), ("triangles", triangles.to_vec())];
    drawn
}

/// σ = (3, −1, 0.5) on the outside; fixed at (0, 0) and, upwards, at (3, 0), the displacements are
/// u = ε_x x + γ y, v = ε_y y at every node, to 1e-10 of the largest.
#[test]
fn distorted_quadratic_elements_pass_the_patch_test() {
    let folder = tempfile::tempdir().expect("a folder");
    let (e, nu, t) = (200.0, 0.3, 0.5);
    let [sx, sy, sxy] = [3.0, -1.0, 0.5];
    let (ex, ey, shear) = ((sx - nu * sy) / e, (sy - nu * sx) / e, 2.0 * (1.0 + nu) * sxy / e);
    let drawn = patch();
    for file in files(folder.path(), &drawn) {
        let of = json!({ "material": "c", "thickness": t, "plane": "stress" });
        let pull = |edge: &str, x: f64, y: f64| json!({ "traction": { "edge": format!("m.{edge}"), "value": [t * x, t * y] } });
        let case = case(
            folder.path(),
            json!({
                "materials": { "c": { "E": e, "nu": nu } },
                "meshes": [{ "id": "m", "file": file, "materials": { "quads": of, "triangles": of } }],
                "supports": [{ "at": "m/1", "fixed": ["x", "y"] }, { "at": "m/2", "fixed": ["y"] }],
                "loads": { "p": { "items": [
                    pull("left", -sx, -sxy), pull("right", sx, sxy), pull("top", sxy, sy), pull("bottom", -sxy, -sy)
                ] } }
            }),
        );
        let answer = case.solve(&[]);
        let found = answer.displacements.expect("an answer");
        assert_eq!(found.len(), drawn.nodes.len());
        let largest = 3.0 * ex;
        for displacement in &found {
            let tag: usize = displacement.node.strip_prefix("m/").expect("m/TAG").parse().expect("a number");
            let [x, y] = drawn.nodes[tag - 1];
            let expected = [ex * x + shear * y, ey * y];
            for (a, b) in [(displacement.ux, expected[0]), (displacement.uy, expected[1])] {
                assert!((a - b).abs() < 1e-10 * largest, "{file} {}: {a} {b}", displacement.node);
            }
        }
    }
}

/// A beam of eight-node elements on the mesh's own names: pressure p on a curved top gives the resultant of its chord,
/// fluid on it the weight of what stands above, both to rounding.
#[test]
fn pressure_and_fluid_on_a_curved_quadratic_edge_are_exact() {
    let folder = tempfile::tempdir().expect("a folder");
    // One element 4 × 1 whose top is the parabola y = 1 + x (4 − x)/8, middle at (2, 1.5).
    let nodes = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0], [2.0, 0.0], [4.0, 0.5], [2.0, 1.5], [0.0, 0.5]];
    let drawn = Drawn {
        nodes,
        edges: vec![("crown", vec![vec![2, 3, 6]]), ("foot", vec![vec![0, 1, 4]])],
        areas: vec![("a", vec![vec![0, 1, 2, 3, 4, 5, 6, 7]])],
    };
    for file in files(folder.path(), &drawn) {
        let (t, level, weight) = (0.5, 3.0, 10.0);
        let load = |item: Value| {
            let case = case(
                folder.path(),
                json!({
                    "materials": { "c": { "E": 100, "nu": 0.2 } },
                    "meshes": [{ "id": "m", "file": file, "materials": {
                        "a": { "material": "c", "thickness": t, "plane": "strain" } } }],
                    "supports": [{ "at": "m.foot", "fixed": ["x", "y"] }],
                    "loads": { "p": { "items": [item] } }
                }),
            );
            let answer = case.solve(&[]);
            let reactions = answer.reactions.expect("an answer");
            assert_eq!(reactions.len(), 3, "{file}");
            [reactions.iter().map(|r| r.fx).sum::<f64>(), reactions.iter().map(|r| r.fy).sum::<f64>()]
        };
        let near = |found: [f64; 2], expected: [f64; 2]| {
            let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(off < 1e-12 * expected[1].abs().max(1.0), "{file}: {found:?} {expected:?}");
        };
        near(load(json!({ "pressure": { "edge": "m.crown", "value": 7 } })), [0.0, 7.0 * t * 4.0]);
        // Water above the parabola: γ t ∫ (level − y) dx = γ t (2 · 4 − (4³/2 − 4³/3)/8) = γ t (8 − 4/3).
        let above = weight * t * (4.0 * (level - 1.0) - 4.0 / 3.0);
        near(load(json!({ "fluid": { "edge": "m.crown", "level": level, "weight": weight } })), [0.0, above]);
    }
}

/// Quadratic surfaces that match are joined node by node: under pressure p they carry p, shared 1 : 4 : 1.
#[test]
fn matching_quadratic_edges_are_in_contact_node_to_node() {
    let folder = tempfile::tempdir().expect("a folder");
    let square = |y: f64| {
        let place = |x: f64, dy: f64| [x, y + dy];
        vec![
            place(0.0, 0.0),
            place(1.0, 0.0),
            place(1.0, 1.0),
            place(0.0, 1.0),
            place(0.5, 0.0),
            place(1.0, 0.5),
            place(0.5, 1.0),
            place(0.0, 0.5),
        ]
    };
    let mut nodes = square(0.0);
    nodes.extend(square(1.0));
    let drawn = Drawn {
        nodes,
        edges: vec![
            ("ground", vec![vec![0, 1, 4]]),
            ("lower face", vec![vec![2, 3, 6]]),
            ("upper face", vec![vec![8, 9, 12]]),
            ("roof", vec![vec![10, 11, 14]]),
        ],
        areas: vec![("lower", vec![(0..8).collect()]), ("upper", vec![(8..16).collect()])],
    };
    for file in files(folder.path(), &drawn) {
        let of = json!({ "material": "c", "thickness": 1, "plane": "stress" });
        let case = case(
            folder.path(),
            json!({
                "materials": { "c": { "E": 100, "nu": 0 } },
                "meshes": [{ "id": "m", "file": file, "materials": { "lower": of, "upper": of } }],
                "supports": [{ "at": "m.ground", "fixed": ["x", "y"] }],
                "contacts": [{ "id": "j", "edge": "m.upper face", "against": "m.lower face", "friction": 0.5 }],
                "loads": { "p": { "items": [{ "pressure": { "edge": "m.roof", "value": 6 } }] } }
            }),
        );
        let answer = case.solve(&[]);
        for (pair, share) in answer.pairs.iter().zip([1.0, 4.0, 1.0]) {
            assert!((pair.x_n - share).abs() < 1e-12 && pair.x_t.abs() < 1e-12, "{file}: {pair:?}");
        }
        let xs: Vec<f64> = answer.pairs.iter().filter_map(|pair| Some(pair.position?[0])).collect();
        assert_eq!(xs, [0.0, 0.5, 1.0], "{file}");
    }
}

/// A disc in a ring, their rings of nodes closed: pressed from outside by p on a frictionless joint the joint carries p.
#[test]
fn closed_rings_are_edges() {
    let folder = tempfile::tempdir().expect("a folder");
    const N: usize = 16;
    let circle = |r: f64, phase: usize| {
        (0..N).map(move |k| {
            let angle = std::f64::consts::TAU * ((k + phase) % N) as f64 / N as f64;
            [r * angle.cos(), r * angle.sin()]
        })
    };
    // Two rings of quads: 0.5 … 1 and 1 … 2, each with nodes of its own on the joint.
    let nodes: Vec<[f64; 2]> =
        [(0.5, 3), (1.0, 3), (1.0, 0), (2.0, 0)].into_iter().flat_map(|(r, p)| circle(r, p)).collect();
    let ring = |a: usize| {
        (0..N).map(move |k| vec![a * N + k, (a + 1) * N + k, (a + 1) * N + (k + 1) % N, a * N + (k + 1) % N])
    };
    let line = |a: usize| (0..N).map(move |k| vec![a * N + k, a * N + (k + 1) % N]).collect::<Vec<_>>();
    let drawn = Drawn {
        nodes,
        edges: vec![("hole", line(0)), ("shaft", line(1)), ("bore", line(2)), ("rim", line(3))],
        areas: vec![("inner", ring(0).collect()), ("outer", ring(2).collect())],
    };
    for file in files(folder.path(), &drawn) {
        let of = json!({ "material": "c", "thickness": 1, "plane": "stress" });
        let case = case(
            folder.path(),
            json!({
                "materials": { "c": { "E": 1000, "nu": 0.3 } },
                "meshes": [{ "id": "m", "file": file, "materials": { "inner": of, "outer": of } }],
                "supports": [{ "at": "m.hole", "fixed": ["x", "y"] }],
                "contacts": [{ "id": "j", "edge": "m.bore", "against": "m.shaft", "friction": 0.3 }],
                "loads": { "p": { "items": [{ "pressure": { "edge": "m.rim", "value": 5 } }] } }
            }),
        );
        let answer = case.solve(&[]);
        assert_eq!(answer.pairs.len(), N, "{file}");
        let first = answer.pairs[0].x_n;
        assert!(first > 0.0);
        for pair in &answer.pairs {
            // Every node alike, and no shear.
            assert!((pair.x_n - first).abs() < 1e-9 * first && pair.x_t.abs() < 1e-9 * first, "{file}: {pair:?}");
        }
    }
}

/// Two halves of a disc, cut along an arc; the nodes of one side differ by 1e-11, as Gmsh's do: they are partners, and the
/// forces follow the arc's normals.
#[test]
fn edges_match_within_the_noise_of_their_coordinates() {
    let folder = tempfile::tempdir().expect("a folder");
    const N: usize = 6;
    let arc = |r: f64, noise: f64| {
        (0..=N).map(move |k| {
            let angle = std::f64::consts::PI * (0.25 + 0.5 * k as f64 / N as f64);
            [r * angle.cos() + noise * (k as f64 - 2.0), r * angle.sin() - noise]
        })
    };
    let nodes: Vec<[f64; 2]> =
        [(1.0, 0.0), (2.0, 0.0), (2.0, 1e-11), (3.0, 0.0)].into_iter().flat_map(|(r, noise)| arc(r, noise)).collect();
    let strip = |a: usize| {
        (0..N).map(move |k| [(a, k), (a + 1, k), (a + 1, k + 1), (a, k + 1)].map(|(a, k)| a * (N + 1) + k).to_vec())
    };
    let line = |a: usize| (0..N).rev().map(move |k| vec![a * (N + 1) + k, a * (N + 1) + k + 1]).collect::<Vec<_>>();
    let drawn = Drawn {
        nodes,
        edges: vec![("base", line(0)), ("below", line(1)), ("above", line(2)), ("roof", line(3))],
        areas: vec![("arch", strip(0).collect()), ("fill", strip(2).collect())],
    };
    for file in files(folder.path(), &drawn) {
        let of = json!({ "material": "c", "thickness": 1, "plane": "stress" });
        let case = case(
            folder.path(),
            json!({
                "materials": { "c": { "E": 1000, "nu": 0.2 } },
                "meshes": [{ "id": "m", "file": file, "materials": { "arch": of, "fill": of } }],
                "supports": [{ "at": "m.base", "fixed": ["x", "y"] }],
                "contacts": [{ "id": "j", "edge": "m.above", "against": "m.below", "friction": 1 }],
                "loads": { "p": { "items": [{ "pressure": { "edge": "m.roof", "value": 5 } }] } }
            }),
        );
        let answer = case.solve(&[]);
        assert_eq!(answer.pairs.len(), N + 1, "{file}");
        let [mut x, mut y] = [0.0; 2];
        for (pair, expected) in answer.pairs.iter().zip(arc(2.0, 0.0).collect::<Vec<_>>().iter().rev()) {
            let position = pair.position.expect("a place");
            let off = (position[0] - expected[0]).hypot(position[1] - expected[1]);
            assert!(off < 1e-9, "{file}: from left to right, {position:?} {expected:?}");
            // n points up along the radius, t = (n_y, −n_x).
            let (n, t) = (pair.x_n / 2.0, pair.x_t / 2.0);
            x += n * expected[0] + t * expected[1];
            y += n * expected[1] - t * expected[0];
        }
        // All of the pressure on the roof goes through the joint: 5 times its chord, and nothing sideways.
        let chord = 2.0 * 3.0 * std::f64::consts::FRAC_1_SQRT_2;
        assert!((y - 5.0 * chord).abs() < 0.02 * 5.0 * chord && x.abs() < 1e-6, "{file}: {x} {y}");
    }
}

/// Lines as bars: a cable along the top edge of the block, T2D2 in .inp; a portal of beams gives w L²/8 between hinges.
#[test]
fn groups_of_lines_are_bars() {
    let folder = tempfile::tempdir().expect("a folder");
    // A simply supported beam of four elements as lines, in no order; the middle has M = w L²/8.
    let text = "*NODE\n1, 0, 0\n2, 1, 0\n3, 2, 0\n4, 3, 0\n5, 4, 0\n*ELEMENT, TYPE=B21, ELSET=Beam\n\
                7, 3, 2\n5, 1, 2\n6, 3, 4\n8, 5, 4\n";
    fs::write(folder.path().join("b.inp"), text).expect("a file");
    let case = case(
        folder.path(),
        json!({
            "materials": { "c": { "E": 1000, "nu": 0.2 } },
            "sections": { "s": { "area": 1, "inertia": 1 } },
            "meshes": [{ "id": "m", "file": "b.inp", "materials": { "beam": { "material": "c", "section": "s" } } }],
            "supports": [{ "at": "m/1", "fixed": ["x", "y"] }, { "at": "m/5", "fixed": ["y"] }],
            "loads": { "w": { "items": [{ "line": { "bar": "m.Beam", "value": [0, -3] } }] } }
        }),
    );
    let answer = case.solve(&[]);
    let members = answer.members.expect("bars");
    assert_eq!(members.iter().map(|m| m.element).collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert!(members.iter().all(|m| m.bar == "m.Beam"));
    assert!((members[1].end.m - 3.0 * 16.0 / 8.0).abs() < 1e-10, "{}", members[1].end.m);

    // Two trusses that are not connected: a bar each, named by their numbers.
    let text = "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n4, 1, 1\n*ELEMENT, TYPE=T2D2, ELSET=Ties\n11, 1, 2\n12, 3, 4\n";
    fs::write(folder.path().join("t.inp"), text).expect("a file");
    let hold = |node: u8| json!({ "at": format!("m/{node}"), "fixed": ["x", "y"] });
    let roll = |node: u8| json!({ "at": format!("m/{node}"), "fixed": ["y"] });
    let case = self::case(
        folder.path(),
        json!({
            "materials": { "c": { "E": 1000, "nu": 0.2 } },
            "sections": { "s": { "area": 2 } },
            "meshes": [{ "id": "m", "file": "t.inp", "materials": { "TIES": { "material": "c", "section": "s" } } }],
            "supports": [hold(1), hold(3), roll(2), roll(4)],
            "loads": { "w": { "items": [{ "point": { "at": "m/4", "force": [6, 0] } }] } }
        }),
    );
    let answer = case.solve(&[]);
    let members = answer.members.expect("bars");
    assert_eq!(members.iter().map(|m| (m.bar.as_str(), m.start.n)).collect::<Vec<_>>(), [("m#11", 0.0), ("m#12", 6.0)]);
}
