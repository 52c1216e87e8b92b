//! Points of a sweep: what runs of their own find, wherever a shard begins; and where answers are proved to be unique.

use nalgebra::DMatrix;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::model::load::load_text;
use stickslip::path::sweep::Format;
use stickslip::solve::counted::Unbalanced;
use stickslip::watch::Quiet;

use super::common::lines::{self, report};
use super::sweep::Case;

/// What the random systems differ in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// R far from singular, normal and tangential joints hardly coupled.
    Usual,
    /// Integers: ties.
    Ties,
    /// Pairs without friction, R with a kernel along the normals, in integers.
    Loose,
    /// Much coupling and much friction: several answers.
    Several,
}

const KINDS: [Kind; 4] = [Kind::Usual, Kind::Ties, Kind::Loose, Kind::Several];

/// A random system under a steady load and one that grows with T on the first pairs alone; f is the friction of all pairs.
fn random(kind: Kind, m: usize, rng: &mut ChaCha8Rng, axes: &[&str]) -> Case {
    let n = 2 * m;
    let mut number =
        |whole: bool| if whole { f64::from(rng.random_range(-2..=2)) } else { rng.random_range(-1.0..1.0) };
    let whole = matches!(kind, Kind::Ties | Kind::Loose);
    let coupling = if kind == Kind::Several { 1.0 } else { 0.1 };
    let a = DMatrix::from_fn(n, n, |i, j| {
        let other = (i < m) != (j < m);
        number(whole) * if other && !whole { coupling } else { 1.0 }
    });
    let mut a = a;
    if kind == Kind::Several {
        // What presses a pair pushes it along as well.
        (0..m).for_each(|i| (0..n).for_each(|j| a[(m + i, j)] = 0.9 * a[(i, j)] + 0.3 * a[(m + i, j)]));
    }
    let mut r = match kind {
        Kind::Several => &a * a.transpose() / n as f64 + DMatrix::identity(n, n) * 0.05,
        Kind::Usual => &a * a.transpose() / n as f64 + DMatrix::identity(n, n),
        Kind::Ties | Kind::Loose => &a * a.transpose() + DMatrix::identity(n, n) * 4.0,
    };
    if kind == Kind::Ties {
        // The normals feel no tangential joint.
        (0..m).for_each(|i| (m..n).for_each(|j| (r[(i, j)], r[(j, i)]) = (0.0, 0.0)));
    }
    if kind == Kind::Loose {
        // Springs between the normals of neighbours: moved all alike they feel nothing.
        r = DMatrix::identity(n, n) * 2.0;
        for i in 0..m {
            r[(i, i)] = if i == 0 || i + 1 == m { 1.0 } else { 2.0 };
            if i + 1 < m {
                (r[(i, i + 1)], r[(i + 1, i)]) = (-1.0, -1.0);
            }
        }
    }
    let matrix: Vec<Vec<f64>> = r.row_iter().map(|row| row.iter().copied().collect()).collect();
    let steady: Vec<f64> =
        (0..n).map(|i| if i < m { 1.0 + number(whole).abs() } else { 0.3 * number(whole) }).collect();
    let grows: Vec<f64> = (0..n).map(|i| if i % m <= m / 3 { number(whole) } else { 0.0 }).collect();
    let (law, friction): (Vec<&str>, Vec<Value>) =
        (0..m).map(|_| if kind == Kind::Loose { ("frictionless", json!(0)) } else { ("coulomb", json!("f")) }).unzip();
    let text = json!({
        "format": "stickslip/1", "title": "random", "parameters": { "f": 0.2, "T": 0.0 },
        "contact_system": {
            "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "law": law, "friction": friction,
            "stiffness": matrix,
            "loads": { "w": { "vector": steady }, "p": { "factor": "T", "vector": grows } }
        }
    });
    let scenario = load_text("random", &text.to_string(), None).unwrap_or_else(|error| panic!("{kind:?}: {error}"));
    Case::of(scenario, axes)
}

/// Where it is said that there is one answer at most, going through all working schemes finds no second one.
#[test]
fn where_answers_are_proved_to_be_unique_there_is_no_second() {
    let mut rng = ChaCha8Rng::seed_from_u64(17);
    let (mut proved, mut several) = (0, 0);
    for number in 0..120 {
        let kind = KINDS[number % 4];
        let case = random(kind, 1 + number % 3, &mut rng, &["T=0"]);
        for f in [0.1, 0.6, 2.5, 10.0] {
            for t in [-4.0, -1.5, 0.4, 2.0, 5.0] {
                let mut values = case.values.clone();
                values.insert("f".to_owned(), f);
                values.insert("T".to_owned(), t);
                let unique = case.prepared.case(&case.scenario, &values).is_unique();
                let found = case.prepared.all_answers(&values, case.scenario.rules, &Quiet).expect("few pairs");
                several += usize::from(found.answers.len() > 1);
                proved += usize::from(unique);
                let loose = kind == Kind::Loose;
                assert!(
                    !unique || found.answers.len() <= 1 && (loose || found.continua.is_empty()),
                    "{kind:?} {number}"
                );
            }
        }
    }
    assert!(proved > 400 && several > 10, "{proved} {several}");
}

fn bytes(case: &Case, shard: &str) -> Vec<u8> {
    let mut out = Vec::new();
    let done = case.sweep(shard, Format::Csv).run(0, &mut out, &Quiet).expect("a vector takes all");
    assert!(done.is_complete());
    out
}

#[test]
fn sweeps_are_the_same_on_any_threads_and_shards() {
    let mut rng = ChaCha8Rng::seed_from_u64(18);
    for (number, kind) in KINDS.into_iter().cycle().take(12).enumerate() {
        let axes: &[&str] =
            if number % 2 == 0 { &["f=0.05..0.6/3", "T=-1..3/37"] } else { &["T=-1..3/5", "f=0.05..0.6/29"] };
        let case = random(kind, 2 + number % 5, &mut rng, axes);
        let whole = bytes(&case, "1/1");
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            assert_eq!(pool.install(|| bytes(&case, "1/1")), whole);
        }
        for shards in [2, 5, 23] {
            let parts = (1..=shards).flat_map(|k| bytes(&case, &format!("{k}/{shards}")));
            assert!(parts.eq(whole.iter().copied()), "{kind:?} {number} in {shards}");
        }
        // A file that is continued anywhere.
        let sweep = case.sweep("1/1", Format::Csv);
        let lines: Vec<&[u8]> = whole.split_inclusive(|byte| *byte == b'\n').collect();
        for found in [1, 17, 40, 63] {
            let mut rest = Vec::new();
            sweep.run(found, &mut rest, &Quiet).expect("a vector takes all");
            assert_eq!(rest, lines[found..].concat());
        }
    }
}

/// Two blocks of quadrilaterals on one another, on a fixed base; the upper one held by springs.
const BLOCKS: &str = r#"{ "format": "stickslip/1", "title": "blocks", "parameters": { "f": 0.3, "T": 10 },
    "materials": { "m": { "E": 1e5, "nu": 0.3 } },
    "plates": [
        { "id": "a", "origin": [0, 0], "size": [6, 1], "divisions": [12, 2], "thickness": 0.1, "material": "m", "plane": "strain" },
        { "id": "b", "origin": [0, 1], "size": [6, 1], "divisions": [12, 2], "thickness": 0.1, "material": "m", "plane": "strain" } ],
    "supports": [ { "at": "a.bottom", "fixed": ["x", "y"] } ],
    "springs": [ { "at": "b.left", "direction": [1, 0], "stiffness": 3000 }, { "at": "b.top", "direction": [0, 1], "stiffness": 20 } ],
    "contacts": [ { "id": "j", "edge": "b.bottom", "against": "a.top", "friction": "f" } ],
    "loads": { "w": { "items": [ { "traction": { "edge": "b.top", "value": [0, -100] } } ] },
               "p": { "factor": "T", "items": [ { "traction": { "edge": "b.left", "value": [1, 0.7] } } ] } } }"#;

#[test]
fn of_a_structure_every_row_is_that_of_a_run_of_its_own_with_its_whole_check() {
    let scenario = || load_text("blocks", BLOCKS, None).unwrap_or_else(|error| panic!("{error}"));
    for axes in [&["f=0.02..0.4/3", "T=0..120/33"][..], &["T=40..80/2", "f=0.01..0.5/21"]] {
        let case = Case::of(scenario(), axes);
        let file = String::from_utf8(bytes(&case, "1/1")).expect("text");
        for (index, row) in file.lines().enumerate() {
            let row: Vec<&str> = row.split(',').collect();
            let point = case.grid.point(index);
            let mut values = case.values.clone();
            case.grid.axes.iter().zip(point).for_each(|(axis, value)| {
                values.insert(axis.name.clone(), value);
            });
            let solved = case.prepared.case(&case.scenario, &values).solve().expect("runs");
            assert!(solved.answer.check.passed && solved.answer.check.equilibrium.is_some());
            assert_eq!(row[2], json!(solved.answer.outcome).as_str().expect("a word"));
            assert_eq!(row[5], solved.answer.pivot_count.to_string());
            let largest = solved.answer.pairs.iter().map(|pair| pair.x_n.abs()).fold(0.0, f64::max);
            assert_eq!(row[15], json!(largest).to_string(), "{row:?}");
        }
    }
}

/// The equilibrium that sweeps look at is that of the check: it sees a force that is off by a millionth.
#[test]
fn answers_out_of_balance_are_seen() {
    let case = Case::of(load_text("blocks", BLOCKS, None).expect("sound"), &["T=0"]);
    let here = case.prepared.case(&case.scenario, &case.values);
    let (answer, left) = here.solve_counted().expect("runs").into_answer();
    assert!(answer.is_answer());
    let left = left.expect("a structure");
    assert_eq!(Unbalanced::are_balanced(&[&left, &left]), [true, true]);
    let pressed = (0..answer.pairs.len()).find(|pair| answer.pairs[*pair].x_n > 1.0).expect("the weight");
    let off = left.with_force_off(pressed, 1e-6 * answer.pairs[pressed].x_n);
    assert_eq!(Unbalanced::are_balanced(&[&left, &off]), [true, false]);
}

/// A deck of weight G on two sliders with friction f and springs k: pulled by H in stage 2 it goes to u2 = (H − f G)/(2 k), left
/// alone in stage 3 it comes back as far as friction lets it, to u3 = f G/(2 k) (`scenarios/isolator.json`).
#[test]
fn columns_of_stages_are_read_from_the_history_at_each_point() {
    let (f, g, k) = (0.1, 2000.0, 1000.0);
    let out = |h: f64| ((h - f * g) / (2.0 * k)).max(0.0);
    let back = |h: f64| out(h).min(f * g / (2.0 * k));
    let mut session = lines::embedded("isolator");
    let sweep = "sweep H 0..1000 6 --columns 'stage 2 offset, stage 3 offset, stage 3 dissipated, z_t s1'";
    let found = report(&mut session, sweep).unwrap();
    let name = |name: &str| found["columns"].as_array().unwrap().iter().position(|one| one == name).unwrap();
    for (row, h) in found["rows"].as_array().unwrap().iter().zip([0.0, 200.0, 400.0, 600.0, 800.0, 1000.0]) {
        let near = |column: &str, right: f64| {
            let value = row[name(column)].as_f64().unwrap_or_else(|| panic!("{column}: {row}"));
            assert!((value - right).abs() <= 1e-12 * (1.0 + right.abs()), "{column} at {h}: {value} is not {right}");
        };
        near("stage 2 offset", out(h));
        near("stage 3 offset", back(h));
        near("stage 3 dissipated", f * g * (out(h) - back(h)));
        // At once it would come to where it is pulled.
        near("z_t s1", out(h));
        assert!(row[name("failure")].is_null(), "{row}");
    }
    // u3 = 0.05 at H = 2 k 0.05 + f G.
    let found = report(&mut session, "find H 0..600 where stage 3 offset = 0.05").unwrap();
    let at = found["places"][0]["value"].as_f64().unwrap();
    assert!((at - (2.0 * k * 0.05 + f * g)).abs() < 1e-6, "{found}");
    let found = report(&mut session, "envelope 'stage 3 offset' over H 0..1000").unwrap();
    let largest = found["envelope"][0]["largest"]["value"].as_f64().unwrap();
    assert!((largest - f * g / (2.0 * k)).abs() < 1e-12, "{found}");
    let error = report(&mut lines::embedded("beam"), "sweep f 0..1 --columns dissipated").unwrap_err();
    assert!(error.contains("dissipated is of the load history, and the scenario has no `stages`"), "{error}");
}

/// Nothing but friction f = 0.3 under a force of 1 holds the block: T = 0.4 pushes it away in stage 2, stage 3 is not reached.
#[test]
fn rows_say_where_the_history_ended_early() {
    let text = r#"{ "format": "stickslip/1", "title": "block", "parameters": { "T": 0.2 },
        "contact_system": { "pairs": ["c"], "law": ["coulomb"], "friction": [0.3], "stiffness": [[1, 0], [0, 0]],
            "loads": { "w": { "vector": [1, 0] }, "p": { "factor": "T", "vector": [0, 1] } } },
        "stages": [{ "w": 1 }, { "w": 1, "p": 1 }, { "w": 2 }] }"#;
    let mut session = lines::session(load_text("block", text, None).unwrap());
    let found = report(&mut session, "sweep T 0.2..0.4 2 --columns 'stage 1 x_n c, stage 3 x_n c'").unwrap();
    let name = |name: &str| found["columns"].as_array().unwrap().iter().position(|one| one == name).unwrap();
    let [holds, slides] = &found["rows"].as_array().unwrap()[..] else { panic!("{found}") };
    assert_eq!(
        [&holds[name("stage 1 x_n c")], &holds[name("stage 3 x_n c")]].map(Value::as_f64),
        [Some(1.0), Some(2.0)]
    );
    assert!(holds[name("failure")].is_null(), "{found}");
    assert_eq!([&slides[name("stage 1 x_n c")], &slides[name("stage 3 x_n c")]].map(Value::as_f64), [Some(1.0), None]);
    assert!(slides[name("failure")].as_str().is_some_and(|why| why.contains("stage 2")), "{found}");
}
