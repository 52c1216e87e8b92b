//! Contact of a body of which only K and F are given, against the same body by elements and against closed forms.

use std::path::{Path, PathBuf};

use crate::common::{close, displacement, is_answer, mechanism, near, of_pairs};
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, State, Verdict};
use stickslip::model::load::load_text;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

const EA: f64 = 2.1e6;
const EI: f64 = 2.1e4;

/// A folder of its own for the files of one test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("stickslip-superelement-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// K of a chain of frame elements, 3 dofs a node, rows x, y, r.
fn chain(nodes: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let mut k = vec![vec![0.0; 3 * nodes.len()]; 3 * nodes.len()];
    for (first, ends) in nodes.windows(2).enumerate() {
        let (dx, dy) = (ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
        let l = dx.hypot(dy);
        let (c, s) = (dx / l, dy / l);
        let (a, b, d, e) = (EA / l, 12.0 * EI / l.powi(3), 6.0 * EI / (l * l), 2.0 * EI / l);
        let local = [
            [a, 0.0, 0.0, -a, 0.0, 0.0],
            [0.0, b, d, 0.0, -b, d],
            [0.0, d, 2.0 * e, 0.0, -d, e],
            [-a, 0.0, 0.0, a, 0.0, 0.0],
            [0.0, -b, -d, 0.0, b, -d],
            [0.0, d, e, 0.0, -d, 2.0 * e],
        ];
        let mut turn = [[0.0; 6]; 6];
        for o in [0, 3] {
            turn[o][o..o + 2].copy_from_slice(&[c, s]);
            turn[o + 1][o..o + 2].copy_from_slice(&[-s, c]);
            turn[o + 2][o + 2] = 1.0;
        }
        for i in 0..6 {
            for j in 0..6 {
                let sum = (0..6).flat_map(|p| (0..6).map(move |q| (p, q)));
                k[3 * first + i][3 * first + j] += sum.map(|(p, q)| turn[p][i] * local[p][q] * turn[q][j]).sum::<f64>();
            }
        }
    }
    // Sums in one order or the other differ in the last digit.
    let upper = k.clone();
    for (i, row) in k.iter_mut().enumerate() {
        (0..i).for_each(|j| row[j] = upper[j][i]);
    }
    k
}

fn dense(k: &[Vec<f64>]) -> String {
    let mut text = format!("%%MatrixMarket matrix array real general\n{0} {0}\n", k.len());
    (0..k.len()).for_each(|j| k.iter().for_each(|row| text += &format!("{:e}\n", row[j])));
    text
}

fn sparse(k: &[Vec<f64>]) -> String {
    let places = (0..k.len()).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let lines: Vec<String> =
        places.filter(|(i, j)| k[*i][*j] != 0.0).map(|(i, j)| format!("{} {} {:e}\n", i + 1, j + 1, k[i][j])).collect();
    format!("%%MatrixMarket matrix coordinate real symmetric\n{0} {0} {1}\n{2}", k.len(), lines.len(), lines.concat())
}

fn column(f: &[f64]) -> String {
    let numbers: String = f.iter().map(|f| format!("{f:e}\n")).collect();
    format!("%%MatrixMarket matrix array real general\n{} 1\n{numbers}", f.len())
}

fn solve(folder: &Path, mut scenario: Value) -> Answer {
    scenario["format"] = "stickslip/1".into();
    scenario["title"] = "test".into();
    let text = scenario.to_string();
    let scenario = load_text("test", &text, Some(&folder.join("test.json"))).unwrap_or_else(|e| panic!("{e}"));
    let prepared = prepare(&scenario, &Quiet).unwrap_or_else(|e| panic!("{e}"));
    let values = scenario.parameter_values();
    prepared.case(&scenario, &values).solve().unwrap_or_else(|e| panic!("{e}")).answer
}

fn refused(folder: &Path, mut scenario: Value) -> String {
    scenario["format"] = "stickslip/1".into();
    scenario["title"] = "test".into();
    match load_text("test", &scenario.to_string(), Some(&folder.join("test.json"))) {
        Err(problems) => problems.to_string(),
        Ok(scenario) => prepare(&scenario, &Quiet).expect_err("no such stiffness").to_string(),
    }
}

/// A bent frame and what stands beside it.
const PLACES: [[f64; 2]; 5] = [[0.0, 0.0], [0.3, 2.0], [2.0, 2.7], [3.1, 2.1], [4.0, 0.1]];

fn beside() -> Value {
    json!({
        "supports": [{"at": "n0", "fixed": ["x", "y"], "settlement": [0.0, -0.002], "case": "sink"}],
        "springs": [{"at": "n2", "direction": [0, 1], "stiffness": 300}, {"at": "n3", "rotation": 50}],
        "contacts": [
            {"id": "foot", "node": "n4", "against": "ground", "normal": [0, 1], "friction": 0.3},
            {"id": "stop", "node": "n1", "against": "ground", "normal": [1, 0.2], "friction": 0.2, "gap": 0.001}
        ]
    })
}

fn elements(rest: &Value) -> Value {
    let mut scenario = rest.clone();
    scenario["materials"] = json!({"m": {"E": 2.1e8, "nu": 0.3}});
    scenario["sections"] = json!({"s": {"area": EA / 2.1e8, "inertia": EI / 2.1e8}});
    scenario["nodes"] = (0..5).map(|k| (format!("n{k}"), json!(PLACES[k]))).collect::<serde_json::Map<_, _>>().into();
    scenario["bars"] = (0..4)
        .map(|k| json!({"id": format!("b{k}"), "nodes": [format!("n{k}"), format!("n{}", k + 1)], "material": "m", "section": "s"}))
        .collect();
    scenario
}

fn given(places: &[[f64; 2]], rest: &Value) -> Value {
    let mut scenario = rest.clone();
    let names = |k: usize| format!("n{k}");
    scenario["superelement"] = json!({
        "stiffness": {"file": "k.mtx"},
        "nodes": (0..places.len()).map(|k| (names(k), json!(places[k]))).collect::<serde_json::Map<_, _>>(),
        "dofs": (0..places.len()).flat_map(|k| ["x", "y", "r"].map(|c| json!([names(k), c]))).collect::<Vec<_>>(),
    });
    scenario
}

#[track_caller]
fn same(a: &Answer, b: &Answer) {
    is_answer(a);
    is_answer(b);
    let size = of_pairs(b, |pair| pair.x_n.abs().max(pair.x_t.abs())).into_iter().fold(0.0, f64::max);
    for (a, b) in a.pairs.iter().zip(&b.pairs) {
        assert_eq!((&a.id, a.state, a.position), (&b.id, b.state, b.position));
        near("x_n", a.x_n, b.x_n, 1e-10, size);
        near("x_t", a.x_t, b.x_t, 1e-10, size);
    }
    for k in 0..5 {
        let id = format!("n{k}");
        let (found, expected) = (displacement(a, &id), displacement(b, &id));
        (0..3).for_each(|c| near(&id, found[c], expected[c], 1e-10, 0.01));
    }
    let forces = |answer: &Answer| -> Vec<(String, [f64; 3])> {
        let reactions = answer.reactions.as_ref().expect("reactions");
        reactions.iter().map(|r| (r.node.clone(), [r.fx, r.fy, r.m])).collect()
    };
    for (a, b) in forces(a).iter().zip(&forces(b)) {
        assert_eq!(a.0, b.0);
        (0..3).for_each(|c| near("reaction", a.1[c], b.1[c], 1e-10, 20.0));
    }
}

/// Loads of the file and of the top, a settlement, springs, contacts: the same frame by elements and by K.
#[test]
fn a_frame_by_elements_and_by_its_stiffness() {
    let folder = folder("frame");
    let k = chain(&PLACES);
    let mut f = vec![0.0; 15];
    (f[6], f[7], f[11]) = (3.0, -10.0, 2.0);
    std::fs::write(folder.join("f.mtx"), column(&f)).unwrap();
    let mut rest = beside();
    rest["loads"] = json!({"sink": {"items": []}, "pull": {"factor": 2, "items": [{"point": {"at": "n3", "force": [4, 1], "moment": -1}}]}});
    let mut by_elements = elements(&rest);
    by_elements["loads"]["first"] = json!({"items": [
        {"point": {"at": "n2", "force": [3, -10]}}, {"point": {"at": "n3", "force": [0, 0], "moment": 2}}]});
    let expected = solve(&folder, by_elements);
    for text in [dense(&k), sparse(&k)] {
        std::fs::write(folder.join("k.mtx"), text).unwrap();
        let mut scenario = given(&PLACES, &rest);
        scenario["superelement"]["loads"] = json!({"first": {"file": "f.mtx"}});
        same(&solve(&folder, scenario), &expected);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// A free beam on two feet: K is singular, and its rigid motions are found. H slides at f W, and the answer below has
/// x_n by the lever rule: W at 1 of 4.
#[test]
fn a_free_body_slides_at_its_limit() {
    let folder = folder("free");
    let places = [[0.0, 0.0], [1.0, 0.0], [4.0, 0.0]];
    std::fs::write(folder.join("k.mtx"), sparse(&chain(&places))).unwrap();
    let with = |h: f64, law: Value| {
        given(
            &places,
            &json!({
                "contacts": [{"id": "a", "node": "n0", "against": "ground", "normal": [0, 1], "friction": law},
                             {"id": "b", "node": "n2", "against": "ground", "normal": [0, 1], "friction": law}],
                "loads": {"weight": {"items": [{"point": {"at": "n1", "force": [0, -8]}}]},
                          "push": {"items": [{"point": {"at": "n1", "force": [h, 0]}}]}}
            }),
        )
    };
    let held = solve(&folder, with(0.3 * 8.0 * (1.0 - 1e-9), json!(0.3)));
    is_answer(&held);
    close("a", held.pairs[0].x_n, 6.0, 1e-12);
    close("b", held.pairs[1].x_n, 2.0, 1e-12);
    let slides = solve(&folder, with(0.3 * 8.0 * (1.0 + 1e-9), json!(0.3)));
    let ray = mechanism(&slides);
    close("p", ray.p, 2.4e-9 / (2.0 * 1.3), 1e-5);
    std::fs::remove_dir_all(folder).unwrap();
}

/// What only contact holds is said of the superelement as of a body.
#[test]
fn a_free_superelement_is_told_as_one_body() {
    let folder = folder("loose");
    let places = [[0.0, 0.0], [4.0, 0.0]];
    std::fs::write(folder.join("k.mtx"), sparse(&chain(&places))).unwrap();
    let mut scenario = given(
        &places,
        &json!({"contacts": [{"id": "a", "node": "n0", "against": "ground", "normal": [0, 1]},
                             {"id": "b", "node": "n1", "against": "ground", "normal": [0, 1]}]}),
    );
    scenario["format"] = "stickslip/1".into();
    scenario["title"] = "test".into();
    let scenario = load_text("test", &scenario.to_string(), Some(&folder.join("test.json"))).expect("a scenario");
    let said = prepare(&scenario, &Quiet).expect("sound").loose_sentences().join("\n");
    assert!(said.contains("the superelement can") && said.contains("slide along x"), "{said}");
    std::fs::remove_dir_all(folder).unwrap();
}

/// The same beam, with what a transformation in f64 leaves of zeros between tension and bending, up to 4 ε |K|: no motion that
/// was free is held by it. Below f W it is held, above it slides, as above.
#[test]
fn rounding_between_displacements_that_do_not_couple_is_no_stiffness() {
    let folder = folder("rounded");
    let places = [[0.0, 0.0], [1.0, 0.0], [4.0, 0.0]];
    let mut k = chain(&places);
    let mut state = 0.613_f64;
    let all = (0..9).flat_map(|i| (0..i).map(move |j| (i, j)));
    for (i, j) in all.filter(|(i, j)| (j % 3 == 0) != (i % 3 == 0)) {
        state = (state * 997.0).fract();
        k[i][j] = EA * f64::EPSILON * (8.0 * state - 4.0);
        k[j][i] = k[i][j];
    }
    std::fs::write(folder.join("k.mtx"), dense(&k)).unwrap();
    let with = |h: f64| {
        given(
            &places,
            &json!({
                "contacts": [{"id": "a", "node": "n0", "against": "ground", "normal": [0, 1], "friction": 0.3},
                             {"id": "b", "node": "n2", "against": "ground", "normal": [0, 1], "friction": 0.3}],
                "loads": {"weight": {"items": [{"point": {"at": "n1", "force": [0, -8]}}]},
                          "push": {"items": [{"point": {"at": "n1", "force": [h, 0]}}]}}
            }),
        )
    };
    let held = solve(&folder, with(2.399));
    is_answer(&held);
    close("a", held.pairs[0].x_n, 6.0, 1e-9);
    assert!(held.notes.iter().any(|note| note.contains("are what rounding leaves of zero")), "{:?}", held.notes);
    let slides = solve(&folder, with(3.0));
    assert_eq!(mechanism(&slides).verdict, Some(Verdict::Certified));
    std::fs::remove_dir_all(folder).unwrap();
}

/// A condensation K_bb − K_bi K_ii⁻¹ K_ib leaves rounding in the rigid motions: they are taken as free and it is said.
#[test]
fn the_rounding_of_a_condensation_is_no_stiffness() {
    let folder = folder("condensed");
    let count = 13;
    let places: Vec<[f64; 2]> = (0..count).map(|k| [0.1 * f64::from(k), 0.3 * (0.7 * f64::from(k)).sin()]).collect();
    let mut k = chain(&places);
    // Eliminate all but the ends, row by row.
    let ends = [0, 1, 2, 36, 37, 38];
    for i in (0..3 * count as usize).filter(|i| !ends.contains(i)) {
        let row = k[i].clone();
        for j in (0..row.len()).filter(|j| *j != i) {
            let factor = k[j][i] / row[i];
            for (entry, a) in k[j].iter_mut().zip(&row) {
                *entry -= factor * a;
            }
        }
    }
    let small: Vec<Vec<f64>> =
        ends.iter().map(|&i| ends.iter().map(|&j| 0.5 * (k[i][j] + k[j][i])).collect()).collect();
    std::fs::write(folder.join("k.mtx"), dense(&small)).unwrap();
    let with = |h: f64| {
        given(
            &[places[0], places[12]],
            &json!({
                "contacts": [{"id": "a", "node": "n0", "against": "ground", "normal": [0, 1], "friction": 0.5},
                             {"id": "b", "node": "n1", "against": "ground", "normal": [0, 1], "friction": 0.5}],
                "loads": {"weight": {"items": [{"point": {"at": "n0", "force": [0, -3]}}, {"point": {"at": "n1", "force": [0, -5]}}]},
                          "push": {"items": [{"point": {"at": "n0", "force": [h, 0]}}, {"point": {"at": "n1", "force": [h, 0]}}]}}
            }),
        )
    };
    let held = solve(&folder, with(1.99));
    is_answer(&held);
    // The push turns the arch a little: its ends differ in height by less than 1e-3 of its length.
    close("Σ x_n", of_pairs(&held, |pair| pair.x_n).iter().sum(), 8.0, 1e-10);
    assert!(held.notes.iter().any(|note| note.contains("taken as free")), "{:?}", held.notes);
    mechanism(&solve(&folder, with(2.01)));
    std::fs::remove_dir_all(folder).unwrap();
}

/// Blocks of one dof in x only: nothing is known of y, so contacts along x work and others are refused.
#[test]
fn a_chain_that_knows_only_x() {
    let folder = folder("x-only");
    // Two springs of 100 in a row, free: [[1, −1, 0], [−1, 2, −1], [0, −1, 1]].
    let k: Vec<Vec<f64>> =
        [[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]].iter().map(|r| r.map(|k| 100.0 * k).to_vec()).collect();
    std::fs::write(folder.join("k.mtx"), sparse(&k)).unwrap();
    let with = |normal: Value| {
        json!({
            "superelement": {"stiffness": {"file": "k.mtx"}, "nodes": {"a": [0, 0], "b": [1, 0], "c": [2, 0]},
                             "dofs": [["a", "x"], ["b", "x"], ["c", "x"]]},
            "contacts": [{"id": "wall", "node": "a", "against": "ground", "normal": normal, "law": "frictionless"},
                         {"id": "far", "node": "c", "against": "ground", "normal": [-1, 0], "law": "frictionless", "gap": 0.01}],
            "loads": {"push": {"items": [{"point": {"at": "c", "force": [-2, 0]}}]}}
        })
    };
    let answer = solve(&folder, with(json!([1, 0])));
    is_answer(&answer);
    close("wall", answer.pairs[0].x_n, 2.0, 1e-12);
    assert_eq!(answer.pairs[1].state, State::Open);
    // c moves by 2 · 2/100 to the left.
    close("z_n far", answer.pairs[1].z_n, 0.05, 1e-12);
    let message = refused(&folder, with(json!([0.6, 0.8])));
    assert!(message.contains("no dof \"y\""), "{message}");
    std::fs::remove_dir_all(folder).unwrap();
}

/// What cannot be a stiffness, loads or dofs: one message each with file and place.
#[test]
fn invalid_superelements() {
    let folder = folder("invalid");
    let places = [[0.0, 0.0], [1.0, 0.0]];
    let good = chain(&places);
    let with = |name: &str, text: String, change: &dyn Fn(&mut Value)| {
        std::fs::write(folder.join("k.mtx"), &text).unwrap();
        let mut scenario = given(
            &places,
            &json!({
                "contacts": [{"id": "a", "node": "n0", "against": "ground", "normal": [0, 1]},
                             {"id": "b", "node": "n1", "against": "ground", "normal": [0, 1]}],
            }),
        );
        change(&mut scenario);
        let message = refused(&folder, scenario);
        println!("== {name}\n{message}");
        message
    };
    let nothing = |_: &mut Value| {};
    let changed = |i: usize, j: usize, value: f64, both: bool| {
        let mut k = good.clone();
        k[i][j] = value;
        if both {
            k[j][i] = value;
        }
        dense(&k)
    };
    for (name, text, part) in [
        ("not symmetric", changed(4, 1, 7.0, false), "row 5, column 2 is 7, row 2, column 5 is"),
        ("negative diagonal", changed(2, 2, -4.0, true), "row 3, column 3 is -4"),
        ("too large beside the diagonal", changed(3, 0, 1e9, true), "positive semidefinite"),
        (
            "indefinite",
            changed(3, 0, 0.9 * EA, true).replace(&format!("{:e}\n", good[0][0]), &format!("{:e}\n", 0.5 * EA)),
            "positive semidefinite",
        ),
        (
            "wrong size",
            dense(&good[..5].iter().map(|row| row[..5].to_vec()).collect::<Vec<_>>()),
            "k.mtx:2: the matrix is 5 × 5, expected 6 × 6",
        ),
        ("no matrix", "hello\n".into(), "k.mtx:1: this is not a Matrix Market file"),
    ] {
        let message = with(name, text, &nothing);
        assert!(message.contains(part) && message.contains("superelement.stiffness.file"), "{message}");
    }
    let change = |name: &str, change: &dyn Fn(&mut Value), part: &str| {
        let message = with(name, dense(&good), change);
        assert!(message.contains(part), "{message}");
    };
    change(
        "dof twice",
        &|s| s["superelement"]["dofs"][4] = json!(["n0", "y"]),
        "superelement.dofs[4]: \"y\" of \"n0\" is named twice: rows 2 and 5",
    );
    change("unknown node", &|s| s["superelement"]["dofs"][4] = json!(["n7", "y"]), "unknown node \"n7\"");
    change("bars beside", &|s| s["bars"] = json!([]), "`bars` cannot stand beside `superelement`");
    change(
        "no such file",
        &|s| s["superelement"]["stiffness"]["file"] = json!("none.mtx"),
        "cannot read the matrix \"none.mtx\"",
    );
    change(
        "support without dof",
        &|s| {
            s["superelement"]["nodes"]["n2"] = json!([5, 0]);
            s["supports"] = json!([{"at": "n2", "fixed": ["x"]}]);
        },
        "the node \"n2\" of the superelement has no dof \"x\"",
    );
    change(
        "idle node",
        &|s| s["superelement"]["nodes"]["n2"] = json!([5, 0]),
        "nothing is connected to the node \"n2\"",
    );
    std::fs::write(folder.join("f.mtx"), column(&[1.0; 5])).unwrap();
    change(
        "forces",
        &|s| s["superelement"]["loads"] = json!({"w": {"file": "f.mtx"}}),
        "f.mtx:2: the matrix is 5 × 1, expected 6 × 1",
    );
    std::fs::remove_dir_all(folder).unwrap();
}

/// The example scripts write what they say: a beam of two spans with P in each carries 0.3125 · P at its ends and 1.375
/// · P in the middle, from K as from R and RF; the pull of 1 stays where it acts.
#[test]
fn the_example_scripts() {
    let folder = folder("python");
    for script in ["superelement", "contact_system"] {
        let out = folder.join(format!("{script}.json"));
        let run =
            std::process::Command::new("python3").arg("-B").arg(format!("examples/{script}.py")).arg(&out).output();
        let Ok(run) = run else {
            println!("no python3 here");
            return;
        };
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        let text = std::fs::read_to_string(&out).unwrap();
        let answer = solve(&folder, serde_json::from_str(&text).unwrap());
        is_answer(&answer);
        for (pair, expected) in answer.pairs.iter().zip([31.25, 137.5, 31.25]) {
            close(&pair.id, pair.x_n, expected, 1e-12);
        }
        near("x_t", answer.pairs[0].x_t, -1.0, 1e-12, 1.0);
    }
    std::fs::remove_dir_all(folder).unwrap();
}
